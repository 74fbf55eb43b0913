//! Numbers of the special relays and registers that instructions touch; the catalogue tells the rest of their story.

/// Keeps memory and outputs in STOP.
pub const M_KEEP_IN_STOP: u32 = 8033;
/// Switches all outputs off.
pub const M_OUTPUTS_OFF: u32 = 8034;
/// Longest time that a scan may take, in milliseconds.
pub const D_WATCHDOG_MS: u32 = 8000;
/// The watchdog has stopped the PLC.
pub const M_WATCHDOG: u32 = 8061;
/// Code of what stopped the PLC.
pub const D_WATCHDOG: u32 = 8061;
/// That code for the watchdog (h1u-h2u-programming §8.1, error codes of D8061).
pub const WATCHDOG_CODE: i16 = 6105;
/// Relay of operation errors, but on HM.
pub const M_OPERATION_ERROR: u32 = 8067;
/// Relay for any error.
pub const M_ANY_ERROR: u32 = 8004;
/// Number of the error relay that is on, in BCD.
pub const D_ANY_ERROR: u32 = 8004;
/// What D8004 shows of M8067, an operation error.
pub const OPERATION_ERROR_BCD: i16 = 0x8067_u16 as i16;
/// What D8004 shows of M8061, which the watchdog switches on.
pub const WATCHDOG_BCD: i16 = 0x8061_u16 as i16;
/// Zero flag.
pub const M_ZERO: u32 = 8020;
/// Borrow flag.
pub const M_BORROW: u32 = 8021;
/// Carry flag.
pub const M_CARRY: u32 = 8022;
/// BMOV's direction.
pub const M_BMOV_REVERSE: u32 = 8024;
/// Execution complete.
pub const M_COMPLETE: u32 = 8029;
/// XCH of a device with itself exchanges its bytes.
pub const M_XCH_BYTES: u32 = 8160;
/// SMOV moves hexadecimal digits.
pub const M_SMOV_HEX: u32 = 8168;
/// MEAN of H1U/H2U also stores the sum.
pub const M_MEAN_SUM: u32 = 8490;
/// Stops the real-time clock; its fall sets the clock from D8013–D8019.
pub const M_CLOCK_STOP: u32 = 8015;
/// Holds D8013–D8019 while the clock goes on.
pub const M_CLOCK_HOLD: u32 = 8016;
/// Its rise rounds the clock to a minute.
pub const M_CLOCK_ADJUST: u32 = 8017;
/// The clock was to be set to no moment.
pub const M_CLOCK_ERROR: u32 = 8019;
/// Seconds of the clock; D8014–D8018 are minutes, hours, day, month, year.
pub const D_SECOND: u32 = 8013;
/// Weekday of the clock, Sunday = 0.
pub const D_WEEKDAY: u32 = 8019;
/// One character a word (ASC, ASCI, HEX, CCD, CRC).
pub const M_BYTE_MODE: u32 = 8161;
/// RAMP holds its end value.
pub const M_RAMP_HOLD: u32 = 8026;
/// Transfers of states are forbidden.
pub const M_TRANSFER_OFF: u32 = 8040;
/// Transfer from the automatic initial state is allowed (IST).
pub const M_TRANSFER_START: u32 = 8041;
/// A start button was pressed (IST).
pub const M_START_PULSE: u32 = 8042;
/// A change of mode resets no outputs (IST).
pub const M_NO_OUTPUT_RESET: u32 = 8045;
/// The monitor of states works.
pub const M_STL_MONITOR: u32 = 8047;
/// Filter of X0–X7 in milliseconds.
pub const D_INPUT_FILTER: u32 = 8020;
/// PR sends up to 16 characters.
pub const M_PR_LONG: u32 = 8027;
/// FROM and TO move as many elements as D8164 says.
pub const M_TRANSFER_COUNT: u32 = 8164;
/// How many elements FROM and TO move with M8164.
pub const D_TRANSFER_COUNT: u32 = 8164;
/// All keys of HKY are hexadecimal digits.
pub const M_HKY_HEX: u32 = 8167;
/// What uses output Y000 of HM; the other outputs follow.
pub const D_OUTPUT_USE: u32 = 8180;
