//! The reference interpreter of the IR: the judge of the backends, which therefore knows none of them.
//!
//! A [`Machine`] holds the devices of a model and executes a module on them, statement by statement, as
//! [`rungc_ir::node`] specifies. It depends on the IR and on the runtime's instruction functions only: not on the
//! passage from instructions to the IR, not on a backend, and not on whoever runs it. Start reading at [`Machine`]
//! (`machine.rs`, the scan cycle), then `exec.rs` (statements), `eval.rs` (expressions), `logic.rs` (contact logic,
//! decoded when a program is loaded) and `devices.rs` (the memory).

#![deny(clippy::wildcard_enum_match_arm)]

mod devices;
mod errors;
mod eval;
mod exec;
mod logic;
mod machine;
mod saved;

pub use errors::OperationError;
pub use machine::{MOST_RESTARTS, Machine, Observer};
pub use rungc_models::runs::rt_class;
pub use saved::Saved;
