//! Services of a computer for PLC programs: connections of terminals and registers, servers over TCP, latched devices
//! in a file, the time of day.
//!
//! Emitted programs for hosts use them, and so does rungc itself. Instructions are in [`rungc_rt`], which also runs
//! where there is no operating system.
//!
//! The crate must not know the IR, source formats or other crates than the runtime: it is built without a registry.
//! Start reading at [`io`].
#![deny(missing_docs)]
#![deny(unsafe_code)]

#[cfg(feature = "capi")]
#[allow(unsafe_code, reason = "C hands over pointers")]
pub mod capi;
pub mod duration;
pub mod io;
pub mod retain;
pub mod servers;
#[cfg(unix)]
pub mod signals;
pub mod wall;
