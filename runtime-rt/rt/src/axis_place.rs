//! The fifty registers of an axis of HM (hm-motion-controller §8.2.3): their places among them.

use crate::special::Register;

/// Output to which it is bound.
pub const OUTPUT: u32 = 0;
/// 1: it has an output for the direction.
pub const DIRECTION: u32 = 1;
/// Unit of time in milliseconds.
pub const UNIT: u32 = 2;
/// Highest speed in pulses a unit.
pub const HIGHEST: u32 = 5;
/// Speed that ramps begin and end with.
pub const FIRST: u32 = 6;
/// Acceleration in pulses a unit, a unit.
pub const ACCELERATION: u32 = 7;
/// Inputs of the DOG, as bits.
pub const DOG: u32 = 8;
/// Inputs of the zero signal, as bits.
pub const ZERO: u32 = 9;
/// Inputs of the left limit switch, as bits.
pub const LEFT: u32 = 10;
/// Those of the right one.
pub const RIGHT: u32 = 11;
/// Speed of a return.
pub const RETURN: u32 = 12;
/// Its speed over the DOG.
pub const CREEP: u32 = 13;
/// Modes of the signals, as bits: which are evaluated, and how.
pub const EVENTS: u32 = 14;
/// Pulses after the DOG.
pub const BEHIND: u32 = 15;
/// Zero signals after it.
pub const ZEROS: u32 = 16;
/// Pair: position.
pub const POSITION: u32 = 18;
/// State.
pub const STATE: u32 = 20;
/// Code of an error.
pub const ERROR: u32 = 21;
/// Pulses of the last period.
pub const INCREMENT: u32 = 22;
/// Inputs of the emergency stop, as bits.
pub const EMERGENCY: u32 = 23;
/// Inputs of the interrupt, as bits.
pub const INTERRUPT: u32 = 24;
/// Those whose bits name inputs.
pub const INPUTS: [u32; 6] = [DOG, ZERO, LEFT, RIGHT, EMERGENCY, INTERRUPT];
/// Pair: position at the interrupt.
pub const INTERRUPT_POSITION: u32 = 26;
/// Number of these words.
pub const COUNT: u32 = 28;
/// Pair: the pulses of Y000; those of the other outputs follow.
pub const PULSES: Register = Register(80);
/// Number of outputs counted this way.
pub const OUTPUTS: u32 = 9;
/// Pulses of the last millisecond of each input axis, and the pair with its count (hm-motion-controller §8.2.2).
pub const INPUT_COUNTS: [(Register, Register); 2] = [
    (Register(212), Register(200)),
    (Register(262), Register(250)),
];
