//! The PLC models as data: which devices each has and which of them are latched, its timers and counters, its special
//! relays and registers, what requests its interrupts, its high-speed counters and axes, and the error codes it
//! reports.
//!
//! This crate knows neither instructions nor programs nor the IR. Start reading at [`Model`]; a file in `model/`
//! describes each family of models, and is the only place that knows in what they differ.

pub mod high_speed;
pub mod interrupts;
mod model;
pub mod plc_errors;
pub mod runs;
pub mod special;
pub mod times;
mod variants;

pub use model::*;
pub use variants::{Plc, UnknownPlc, VARIANTS, Variant};
