//! The results of a run: the values of devices as they are read ([`Reading`]), and recordings of them over time
//! ([`Vcd`]).

pub mod plot;
mod reading;
mod vcd;

pub use reading::{Reading, Seen, TEXT_LENGTH, Values, decimal, hertz};
pub use vcd::{Signal, Vcd};
