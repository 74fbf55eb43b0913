//! The catalogue of instructions and devices per model, the typed IR, structure checks, lowering and passes.
//!
//! The way through: [`resolve`] finds each instruction's catalogue row and step number, [`check`] looks at the program as a
//! whole, [`lower`] makes a [`Module`], [`passes`] simplify it, [`validate`] holds it to the rules of [`node`].
//! No output language and no file format is known here.

pub mod axes;
pub mod catalogue;
pub mod check;
pub mod compile;
pub mod dump;
pub mod fitting;
pub mod high_speed;
pub mod interrupts;
mod latches;
pub mod layout;
pub mod lower;
pub mod model;
pub mod node;
pub mod passes;
pub mod plc_errors;
pub mod ranges;
pub mod reach;
pub mod resolve;
pub mod runs;
pub mod special;
pub mod validate;
pub mod walk;
pub mod worst;

pub use model::{Model, ModelId, ModelSet};
pub use node::Module;
