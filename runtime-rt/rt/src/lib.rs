//! Runtime of PLC instructions.
//!
//! `no_std`, no allocation; only a bug could panic. The interpreter, emitted Rust and (through the C ABI, feature
//! `capi`) emitted C
//! all call the same functions here, so an instruction has one meaning. An instruction sees the PLC through [`Plc`]
//! (its devices) and [`Hal`] (its hardware), and its operands through [`Cx`].
//!
//! The crate must not know the IR, source formats or other crates: it is built alone, on any target. Start reading at
//! `registry.rs`, which lists the functions, and at a function of [`fnc`].
#![no_std]
#![deny(missing_docs)]
#![deny(unsafe_code)]

#[cfg(test)]
extern crate std;

mod access;
mod axis;
pub mod axis_place;
pub mod blocks;
pub mod board;
#[cfg(feature = "capi")]
#[allow(unsafe_code, reason = "C hands over pointers")]
pub mod capi;
#[cfg(feature = "staticlib")]
#[allow(unsafe_code, reason = "abort() is the C library's")]
mod capi_panic;
#[cfg(feature = "capi")]
#[allow(
    unsafe_code,
    reason = "C hands over pointers, and the hardware is one for the process"
)]
pub mod capi_virtual;
mod char_queue;
pub mod comm;
mod compare;
mod cx;
#[cfg(test)]
mod double;
mod edge;
mod edge_queue;
mod fault;
pub mod fnc;
mod hal;
mod line_queues;
pub mod modules;
mod operand;
mod plc;
mod program;
pub mod pulse;
mod pulse_side;
mod registry;
pub mod retain;
mod runs;
pub mod special;
mod specials;
mod steps;
mod stopwatch;
mod timing;
mod virtual_hal;
mod virtual_line;
mod wiring;
pub mod word;

pub use access::Access;
pub use axis::{
    Axis, advance as advance_pulses, millihertz as pulse_millihertz, pass as pass_pulses,
    pulse_timer,
};
pub use comm::{Port, Ports, advance as advance_ports, advance_slave};
pub use compare::CmpOp;
pub use cx::{Cx, call, conclude, fetch, send};
pub use edge::{Edge, EdgeKind, any_active};
pub use fault::{
    Done, ErrorRules, Fault, LastError, Stop, log_error, relay_in_bcd, report, trip_watchdog,
};
pub use fnc::modules::Transfer;
pub use hal::{CanBus, Clock, Hal, NoHal, SerialPort};
pub use operand::{Operand, OperandKind, d, h, k, kn};
pub use plc::{Class, Plc, Site, State, StoredRun, Sys};
pub use program::Program;
pub use pulse_side::count_pulses;
pub use registry::{Needs, RtFn};
pub use runs::{FIRST_COUNTER32, FIRST_SPECIAL, Runs};
pub use special::{Register, Relay};
pub use specials::Specials;
pub use steps::Steps;
pub use stopwatch::{Divider, Microseconds, Milliseconds, Stopwatch};
pub use timing::{Counter16, Counter32, Timer, TimerKind};
pub use virtual_hal::VirtualHal;
pub use virtual_line::VirtualLine;
pub use wiring::{Clear, Home, Interrupt, Looks, Pulses, Ramps, StopInput, Wiring};
