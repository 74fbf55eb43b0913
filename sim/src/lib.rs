//! Executing compiled programs: the reference interpreter of the IR, and the runner of PLC test files.
//!
//! [`Machine`] is the executable specification of [`rungc_ir::node`]; it knows no output language.

mod devices;
mod exec;
pub mod machine;

pub use machine::Machine;
