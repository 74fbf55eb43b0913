//! Executing compiled programs: the reference interpreter of the IR, and the runner of PLC test files.
//!
//! [`Machine`] is the executable specification of [`rungc_ir::node`]. [`plctest`] runs test files on any [`engines::Engine`]: the
//! interpreter, or the executables that the emitted C and Rust of a batch of programs are built to.

mod devices;
pub mod engines;
pub mod errors;
mod exec;
mod logic;
pub mod machine;
pub mod plant;
pub mod plctest;
mod problem;
pub mod protocol;
pub mod record;
pub mod wire;

pub use devices::rt_class;
pub use machine::Machine;
