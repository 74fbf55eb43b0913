//! Searches runs of a program for what must not happen: violated properties, operation errors, watchdog stops, outputs
//! that two coils drive differently, and outputs that never come to rest.
//!
//! [`search()`] begins with the program at power-on and continues from the moments that it has reached: it changes
//! inputs, waits for timers ([`vary`]), and keeps the moments that show something new ([`cover`]), to continue from
//! them later. What it finds, [`shrink`] makes as short as it can. A [`run::Runner`] executes steps of a run as test
//! files do, on the interpreter, with a copy of the program that notes branches and coils ([`notes`]). This crate must
//! not know commands. Start reading at [`search()`].

#![deny(missing_docs)]

pub mod cover;
pub mod lanes;
pub mod notes;
pub mod run;
pub mod search;
pub mod shrink;
pub mod task;
pub mod trains;
pub mod unvaried;
pub(crate) mod vary;
pub mod wide;

pub use search::{Limits, Report, search};
pub use shrink::shrink;
pub use task::{Found, Kind, Step, Task, What};
