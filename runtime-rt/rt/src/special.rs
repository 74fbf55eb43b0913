//! Special relays and registers: their types, and the names of those that the runtime, the compiler or emitted code
//! touch.
//!
//! Every such number is here and nowhere else. The tables of the models say what a number means on which model; they
//! know many more of them.

use crate::plc::{Class, Plc};

/// A special relay M, by its number.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct Relay(pub u16);

/// A special register D, by its number; in tables of positioning also an ordinary one. Of a pair it is the lower word.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
pub struct Register(pub u16);

macro_rules! numbered {
    ($($of:ident)*) => {$(
        impl $of {
            /// Its number.
            pub const fn number(self) -> u32 {
                self.0 as u32
            }

            /// The one `count` numbers after it.
            #[must_use]
            pub const fn after(self, count: u32) -> Self {
                $of(self.0 + count as u16)
            }

            /// It and those that follow it, `N` in all.
            pub const fn run<const N: usize>(self) -> [Self; N] {
                let mut all = [self; N];
                let mut i = 0;
                while i < N {
                    all[i] = self.after(i as u32);
                    i += 1;
                }
                all
            }
        }
    )*};
}
numbered!(Relay Register);

impl Relay {
    /// Returns true if it is on; a relay that the program does not use is off.
    pub(crate) fn is_on(self, plc: &(impl Plc + ?Sized)) -> bool {
        plc.bit(Class::M, self.number()) == Some(true)
    }

    /// Sets it, if the program uses it.
    pub(crate) fn set(self, plc: &mut (impl Plc + ?Sized), on: bool) {
        let _ = plc.set_bit(Class::M, self.number(), on);
    }
}

impl Register {
    /// Its value; 0 of one that the program does not use.
    pub(crate) fn value(self, plc: &(impl Plc + ?Sized)) -> u16 {
        plc.word(Class::D, self.number()).unwrap_or(0) as u16
    }

    /// Sets it, if the program uses it.
    pub(crate) fn set(self, plc: &mut (impl Plc + ?Sized), value: u16) {
        let _ = plc.set_word(Class::D, self.number(), value as i16);
    }
}

// Devices that the scan maintains.

/// On in RUN; M8001 is its opposite.
pub const M_RUNNING: Relay = Relay(8000);
/// Off in RUN.
pub const M_STOPPED: Relay = Relay(8001);
/// On in the first scan of RUN.
pub const M_FIRST_SCAN: Relay = Relay(8002);
/// The same, for programs that set links between PLCs up.
pub const M_LINK_SET_UP: Relay = Relay(8038);
/// The same, for programs that set Modbus up (FX3).
pub const M_MODBUS_SET_UP: Relay = Relay(8411);
/// Off in the first scan of RUN.
pub const M_LATER_SCANS: Relay = Relay(8003);
/// Clock of 10 ms; those of 100 ms, 1 s and 1 min follow.
pub const M_CLOCK_10_MS: Relay = Relay(8011);
/// Clears the devices that are not latched.
pub const M_CLEAR_GENERAL: Relay = Relay(8031);
/// Clears the latched devices.
pub const M_CLEAR_LATCHED: Relay = Relay(8032);
/// Keeps memory and outputs in STOP.
pub const M_KEEP_IN_STOP: Relay = Relay(8033);
/// Switches all outputs off.
pub const M_OUTPUTS_OFF: Relay = Relay(8034);
/// With [`M_FORCED_RUN`], puts the PLC in RUN.
pub const M_FORCE_ENABLE: Relay = Relay(8035);
/// See [`M_FORCE_ENABLE`].
pub const M_FORCED_RUN: Relay = Relay(8036);
/// Puts the PLC in STOP.
pub const M_FORCED_STOP: Relay = Relay(8037);
/// Scans last at least [`D_CONSTANT_SCAN`].
pub const M_CONSTANT_SCAN: Relay = Relay(8039);
/// Shortest time of a scan in milliseconds, with [`M_CONSTANT_SCAN`].
pub const D_CONSTANT_SCAN: Register = Register(8039);
/// The same on L01S, where no relay enables it.
pub const D_SHORTEST_SCAN: Register = Register(8059);
/// The voltage of the battery, [`D_BATTERY`], is below [`D_BATTERY_LOW`].
pub const M_BATTERY_LOW: Relay = Relay(8005);
/// It has been since power-on.
pub const M_BATTERY_HAS_BEEN_LOW: Relay = Relay(8006);
/// Voltage of the battery, in tenths of a volt.
pub const D_BATTERY: Register = Register(8005);
/// The voltage below which the battery is low.
pub const D_BATTERY_LOW: Register = Register(8006);
/// The power supply fails, for more than 5 ms.
pub const M_POWER_FAILS: Relay = Relay(8007);
/// The same, and goes off when the PLC stops because of it.
pub const M_POWER_FAILURE: Relay = Relay(8008);
/// Number of times [`M_POWER_FAILS`] came on.
pub const D_POWER_FAILURES: Register = Register(8007);
/// For how many milliseconds of failing power the PLC runs.
pub const D_POWER_FAILURE_MS: Register = Register(8008);
/// Puts HM in RUN and STOP under remote control ([`D_REMOTE`]); otherwise shows which it is in.
pub const M_REMOTE_RUN: Relay = Relay(8004);
/// On: the switch of HM decides on RUN and STOP, even with [`D_REMOTE`].
pub const M_LOCAL_CONTROL: Relay = Relay(8005);
/// HM is under remote control while it holds [`REMOTE_KEY`] (hm-motion-controller §5.7).
pub const D_REMOTE: Register = Register(8004);
/// See [`D_REMOTE`].
pub const REMOTE_KEY: i16 = 0xFAC0_u16 as i16;
/// Longest time that a scan may take, in milliseconds.
pub const D_WATCHDOG_MS: Register = Register(8000);
/// Type and version of the PLC.
pub const D_TYPE: Register = Register(8001);
/// The same on FX3.
pub const D_TYPE_AGAIN: Register = Register(8101);
/// Units of 50 µs since power-on (HM).
pub const D_SHORT_TICK: Register = Register(8007);
/// Pair: milliseconds since power-on (HM).
pub const D_TICK: Register = Register(8008);
/// Time of this scan, in units of 0.1 ms.
pub const D_SCAN_TIME: Register = Register(8010);
/// The shortest.
pub const D_LEAST_SCAN_TIME: Register = Register(8011);
/// The longest.
pub const D_MOST_SCAN_TIME: Register = Register(8012);
/// [`D_RING_COUNTER`] counts.
pub const M_RING_COUNTER: Relay = Relay(8099);
/// Tenths of milliseconds, up to 32767 and from 0 again.
pub const D_RING_COUNTER: Register = Register(8099);
/// [`D_SLOW_RING_COUNTER`] counts; L01S has only the registers.
pub const M_SLOW_RING_COUNTER: Relay = Relay(8398);
/// Pair: milliseconds, up to 2147483647 and from 0 again.
pub const D_SLOW_RING_COUNTER: Register = Register(8398);

// Errors.

/// Relay for any error.
pub const M_ANY_ERROR: Relay = Relay(8004);
/// Number of the error relay that is on, in BCD.
pub const D_ANY_ERROR: Register = Register(8004);
/// The watchdog has stopped the PLC.
pub const M_WATCHDOG: Relay = Relay(8061);
/// Code of what stopped the PLC.
pub const D_WATCHDOG: Register = Register(8061);
/// That code for the watchdog (h1u-h2u-programming §8.1, error codes of D8061).
pub const WATCHDOG_CODE: u16 = 6105;
/// Relay of operation errors, but on HM.
pub const M_OPERATION_ERROR: Relay = Relay(8067);
/// Code of the last operation error.
pub const D_OPERATION_ERROR: Register = Register(8067);
/// The first operation error, latched.
pub const M_FIRST_ERROR: Relay = Relay(8068);
/// Step of the first operation error.
pub const D_FIRST_ERROR_STEP: Register = Register(8068);
/// Step of the last operation error.
pub const D_ERROR_STEP: Register = Register(8069);
/// Error of a programming port.
pub const M_PROGRAMMING_PORT_ERROR: Relay = Relay(8062);
/// Error of another serial port.
pub const M_PORT_ERROR: Relay = Relay(8063);
/// Hours at which the ten logged errors came (H1U, H2U), the oldest first.
pub const D_LOGGED_HOURS: Register = Register(8490);
/// Codes of the ten logged errors.
pub const D_LOGGED_CODES: Register = Register(8500);
/// Pair: seconds for which the PLC has run (H1U, H2U).
pub const D_RUN_TIME: Register = Register(8510);

// Flags of instructions.

/// Zero flag.
pub const M_ZERO: Relay = Relay(8020);
/// Borrow flag.
pub const M_BORROW: Relay = Relay(8021);
/// Carry flag.
pub const M_CARRY: Relay = Relay(8022);
/// A product or a quotient is 0 (FX3G, FX3U).
pub const M_ZERO_PRODUCT: Relay = Relay(8304);
/// A quotient is too large (FX3G, FX3U).
pub const M_LARGE_QUOTIENT: Relay = Relay(8306);
/// BMOV's direction.
pub const M_BMOV_REVERSE: Relay = Relay(8024);
/// RAMP holds its end value.
pub const M_RAMP_HOLD: Relay = Relay(8026);
/// PR sends up to 16 characters.
pub const M_PR_LONG: Relay = Relay(8027);
/// Execution complete.
pub const M_COMPLETE: Relay = Relay(8029);
/// All comparisons of BKCMP hold.
pub const M_BLOCK_COMPARE: Relay = Relay(8090);
/// COMRD and BINDA leave out the character after the text.
pub const M_TEXT_OPEN: Relay = Relay(8091);
/// XCH of a device with itself exchanges its bytes.
pub const M_XCH_BYTES: Relay = Relay(8160);
/// One character a word (ASC, ASCI, HEX, CCD, CRC).
pub const M_BYTE_MODE: Relay = Relay(8161);
/// FROM and TO move as many elements as D8164 says.
pub const M_TRANSFER_COUNT: Relay = Relay(8164);
/// Number of elements that FROM and TO move with M8164.
pub const D_TRANSFER_COUNT: Register = Register(8164);
/// SORT2 sorts in descending order.
pub const M_DESCENDING: Relay = Relay(8165);
/// All keys of HKY are hexadecimal digits.
pub const M_HKY_HEX: Relay = Relay(8167);
/// SMOV moves hexadecimal digits.
pub const M_SMOV_HEX: Relay = Relay(8168);
/// MEAN of H1U/H2U also stores the sum.
pub const M_MEAN_SUM: Relay = Relay(8490);
/// Pair: what RND continues with.
pub const D_RANDOM: Register = Register(8310);

// The real-time clock.

/// Stops the real-time clock; its fall sets the clock from D8013–D8019.
pub const M_CLOCK_STOP: Relay = Relay(8015);
/// Freezes D8013–D8019 while the clock continues.
pub const M_CLOCK_HOLD: Relay = Relay(8016);
/// Its rise rounds the clock to a minute.
pub const M_CLOCK_ADJUST: Relay = Relay(8017);
/// There is a real-time clock.
pub const M_CLOCK_FITTED: Relay = Relay(8018);
/// The clock was to be set to no moment.
pub const M_CLOCK_ERROR: Relay = Relay(8019);
/// Seconds of the clock; D8014–D8018 are minutes, hours, day, month, year.
pub const D_SECOND: Register = Register(8013);
/// Weekday of the clock, Sunday = 0.
pub const D_WEEKDAY: Register = Register(8019);

// States and annunciators.

/// Transfers of states are forbidden.
pub const M_TRANSFER_OFF: Relay = Relay(8040);
/// Transfer from the automatic initial state is allowed (IST).
pub const M_TRANSFER_START: Relay = Relay(8041);
/// A start button was pressed (IST).
pub const M_START_PULSE: Relay = Relay(8042);
/// A change of mode resets no outputs (IST).
pub const M_NO_OUTPUT_RESET: Relay = Relay(8045);
/// A state is on.
pub const M_STATE_ON: Relay = Relay(8046);
/// The monitor of states works.
pub const M_STL_MONITOR: Relay = Relay(8047);
/// Numbers of the lowest states that are on, eight registers.
pub const D_STATES_ON: Register = Register(8040);
/// An annunciator is on.
pub const M_ANNUNCIATOR_ON: Relay = Relay(8048);
/// The monitor of annunciators works.
pub const M_ANNUNCIATOR_MONITOR: Relay = Relay(8049);
/// Number of the lowest annunciator that is on.
pub const D_ANNUNCIATOR_ON: Register = Register(8049);

// Inputs, outputs and high-speed counters.

/// Filter of X0–X7 in milliseconds.
pub const D_INPUT_FILTER: Register = Register(8020);
/// Comparisons act when a reset input resets the counter, too.
pub const M_COMPARE_AT_RESET: Relay = Relay(8025);
/// Number 0 of the relays of counters, of which those of C200 and the following exist: the direction of a counter, or
/// what shows it.
pub const M_COUNTER_DIRECTION: Relay = Relay(8000);
/// Values of the built-in analog inputs of L01S, sixteen registers, or of the two potentiometers of FX3G.
pub const D_ANALOG_INPUTS: Register = Register(8030);
/// Bits that switch the analog inputs of L01S on.
pub const D_ANALOG_ENABLE: Register = Register(8114);
/// Values of the built-in analog outputs of L01S.
pub const D_ANALOG_OUTPUTS: Register = Register(8050);
/// Registers exchanged with the analog boards of H1U and H2U: twenty.
pub const D_BOARD: Register = Register(8220);
/// The type of the board that is fitted.
pub const D_BOARD_TYPE: Register = Register(8199);
/// Number of extension modules of L01S.
pub const D_MODULE_COUNT: Register = Register(8108);
/// Their types, two in each of sixteen registers.
pub const D_MODULE_TYPES: Register = Register(8260);
/// Words of the extension modules of HM, seven registers for each of six modules.
pub const D_EXTENSIONS: Register = Register(7100);
/// Number of extension modules.
pub const D_EXTENSION_COUNT: Register = Register(7142);
/// Times between exchanges of digital, of analog modules, and what they were.
pub const D_EXTENSION_TIMES: Register = Register(7143);
/// 1: there are more terminals or words than allowed.
pub const D_EXTENSION_ERROR: Register = Register(7147);
/// First register of the words of analog extension modules.
pub const D_EXTENSION_DATA: Register = Register(7200);
/// Stand for inputs that have no terminal (HM), from X014 on: four relays.
pub const M_VIRTUAL_INPUTS: Relay = Relay(8160);
/// Stand for the inputs of motion instructions from X000 on (HM).
pub const M_MOTION_INPUTS: Relay = Relay(8096);
/// User of output Y000 of HM; the other outputs follow.
pub const D_OUTPUT_USE: Register = Register(8180);

// The oscilloscope of HM (hm-motion-controller §5.6).

/// 0: a hand starts it, 1 and 2: a register that reaches the threshold from below, from above.
pub const D_SCOPE_MODE: Register = Register(8030);
/// Trigger source: not 0, or the number of a register.
pub const D_SCOPE_TRIGGER: Register = Register(8031);
/// The threshold.
pub const D_SCOPE_THRESHOLD: Register = Register(8032);
/// Time between two samples.
pub const D_SCOPE_PERIOD: Register = Register(8033);
/// Number of samples to take.
pub const D_SCOPE_SAMPLES: Register = Register(8034);
/// First register of the record.
pub const D_SCOPE_FIRST: Register = Register(8035);
/// First register of the area in which the record must lie.
pub const D_SCOPE_AREA_FIRST: Register = Register(8036);
/// Last register of that area.
pub const D_SCOPE_AREA_LAST: Register = Register(8037);
/// State of the oscilloscope and its trigger.
pub const D_SCOPE_STATE: Register = Register(8038);
/// Samples so far.
pub const D_SCOPE_TAKEN: Register = Register(8039);
/// Words and first register of each of two channels.
pub const D_SCOPE_CHANNELS: Register = Register(8040);
