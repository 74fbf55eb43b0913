//! Running compiled programs: test files, the engines that execute them, the machine around a PLC, and the results of a
//! run.
//!
//! [`plctest`] reads test files and runs them on any [`engines::Engine`]: the [interpreter](rungc_interp), or the
//! executables that the emitted C and Rust of a batch of programs are built to. [`plant`] simulates the machine
//! that a PLC is wired to, and [`record`] writes recordings and plots. A [`Session`] is a PLC that runs in the
//! interpreter, with all that is around it. None of it knows an instruction or an output language; `engines` alone
//! calls the backends. The modules build on one another in this order: [`Target`] and [`names`], [`property`], [`wire`]
//! and the mistakes in files ([`LoadError`]); `plant` and `record`; [`session`] and [`serve`]; [`protocol`] and
//! `engines`; `plctest`. Start reading at [`Session`] and [`plctest::run`].

pub mod engines;
pub mod names;
pub mod plant;
pub mod plctest;
mod problem;
pub mod property;
pub mod protocol;
pub mod record;
pub mod serve;
pub mod session;
mod setting;
mod target;
pub mod threads;
pub mod wire;

pub use problem::{LoadError, Problem};
pub use session::Session;
pub use setting::{check_lasts, set};
pub use target::{Channel, Target};
