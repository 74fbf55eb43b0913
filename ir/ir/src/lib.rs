//! The typed IR, its layout, its passes and the validator that holds them to the rules of [`node`].
//!
//! The IR is the contract between lowering, the interpreter and both backends. It knows the PLC models, but no
//! instructions, no programs and no diagnostics. Start reading at [`node`], whose docs specify what every engine does.

#![deny(clippy::wildcard_enum_match_arm)]

pub mod compare;
pub mod dump;
pub mod layout;
pub mod node;
pub mod passes;
pub mod ranges;
pub mod reach;
mod resets;
mod retained;
pub mod validate;
pub mod walk;
pub mod worst;

pub use node::Module;
pub use resets::{ResetState, ResetStates, reset_name};
pub use retained::fnv1a;
