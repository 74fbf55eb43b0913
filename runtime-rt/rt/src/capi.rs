//! The C ABI: what emitted C calls. The only module with `unsafe` in this crate.
//!
//! A program describes its struct of devices once, in a constant [`Layout`] of offsets; a [`Map`] binds it to one such struct. Each
//! function of the [registry](crate::RtFn) is exported as `rungc_` and its name, so that a linker takes only those that are used.
//! The header `rungc_rt.h` is made from this file.
//!
//! The static library, for the host or with `--target thumbv7em-none-eabihf` (or any other) for a microcontroller:
//!
//! ```text
//! CARGO_PROFILE_RELEASE_PANIC=abort cargo rustc -p rungc-rt --release --crate-type staticlib --features staticlib
//! ```
//!
//! The Makefile beside emitted C that needs it does the same with the sources that are emitted along.

mod clients;
mod exports;
mod hal;
mod map;
mod modules;
mod servers;
mod stored;

use crate::comm::codec::Codec;
use crate::comm::modbus::Profile;
use crate::comm::{CanFrame, LineFormat, PortMut, PortWiring, Ports, Progress, Received, Status};
use crate::cx::Cx;
use crate::fault::Done;
use crate::hal::Clock;
use crate::operand::Operand;
use crate::plc::{Class, Site, State};
use crate::wiring::Pulses;
use core::ffi::c_void;

/// Storage type of an area of devices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Kind {
    /// `bool`.
    Bits = 0,
    /// `int16_t`.
    Words = 1,
    /// `plc_timer`.
    Timers = 2,
    /// `plc_counter16`.
    Counters16 = 3,
    /// `plc_counter32`.
    Counters32 = 4,
}

/// Devices that are side by side in the program's struct.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Area {
    /// Their class.
    pub class: Class,
    /// Type of each device.
    pub kind: Kind,
    /// First number.
    pub first: u32,
    /// Number of devices.
    pub count: u32,
    /// Distance between consecutive devices in memory, in numbers: 1, or more in an array of this many columns, each as
    /// long as the longest has to be.
    pub columns: u32,
    /// Number of columns stored: the first ones.
    pub stored_columns: u32,
    /// Offset in the struct, in bytes.
    pub offset: usize,
}

/// Numbers that the model has, stored or not.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Range {
    /// Class.
    pub class: Class,
    /// First number.
    pub first: u32,
    /// Last number.
    pub last: u32,
}

/// A special register that is another name of an index register.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Alias {
    /// Number of the register D.
    pub number: u32,
    /// Class of the index register.
    pub class: Class,
    /// Its number.
    pub index: u32,
}

/// A text of the program.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Text {
    /// Its characters.
    pub bytes: *const u8,
    /// Number of characters.
    pub length: usize,
}

/// Layout of a program's struct. All pointers are valid for their counts, for as long as the program runs.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Layout {
    /// Areas, sorted by class and first number.
    pub areas: *const Area,
    /// Number of areas.
    pub area_count: usize,
    /// Ranges of devices that the model has, sorted likewise.
    pub ranges: *const Range,
    /// Number of ranges.
    pub range_count: usize,
    /// Index registers with a second name.
    pub aliases: *const Alias,
    /// Number of aliases.
    pub alias_count: usize,
    /// Texts.
    pub texts: *const Text,
    /// Number of texts.
    pub text_count: usize,
    /// Offset of its `plc_sys`.
    pub sys: usize,
    /// Offset of its `plc_error`; 0 if it has none.
    pub error: usize,
    /// Offset of its `plc_on_error *`; 0 if it has none.
    pub on_error: usize,
    /// Offset of its private memories.
    pub states: usize,
    /// Number of private memories; slots are numbered from 1.
    pub state_count: u16,
    /// True if a 32-bit access to Zn takes Vn as its high word.
    pub z_pairs_with_v: bool,
    /// Relay that shows an operation error.
    pub error_relay: u16,
    /// Code of an error in an operand's value.
    pub value_error: u16,
    /// True if M8004 and D8004 show errors of ports.
    pub sums_up_ports: bool,
    /// True if errors enter the log.
    pub logs_errors: bool,
    /// Offset of its pulse outputs.
    pub axes: usize,
    /// Their numbers Y, in order.
    pub outputs: *const u8,
    /// Number of pulse outputs.
    pub output_count: usize,
    /// The pulse outputs that the model has.
    pub pulses: Pulses,
    /// Its serial ports, in the order of their numbers.
    pub ports: *const PortPlace,
    /// Number of serial ports.
    pub port_count: usize,
    /// Devices served by Modbus, and the limits of a frame; NULL if no port speaks it.
    pub modbus: *const Profile,
    /// Implementations of the ports' protocols.
    pub codecs: *const *const Codec,
    /// Number of protocols.
    pub codec_count: usize,
    /// The serial ports that the model has.
    pub port_family: Ports,
    /// Code of model and version, for partners on a line.
    pub type_code: u16,
}

/// Location of a serial port in a program's struct.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PortPlace {
    /// Its special devices.
    pub wiring: *const PortWiring,
    /// Offset in the struct.
    pub offset: usize,
    /// Characters of the longest frame.
    pub length: u16,
    /// Its number in the model's manual.
    pub number: u8,
    /// True if there is memory for the progress of its protocols.
    pub has_progress: bool,
    /// True if there is memory for the state of its protocols.
    pub keeps: bool,
}

impl PortPlace {
    /// The port of a program's struct.
    ///
    /// # Safety
    /// The struct holds a port there, aligned as words, and nothing else uses it for as long.
    unsafe fn port<'a>(&self, plc: *mut c_void) -> PortMut<'a> {
        let length = usize::from(self.length);
        // SAFETY: see above; a port is as `Port` is laid out.
        unsafe {
            let status = plc.cast::<u8>().add(self.offset);
            let progress = status.add(size_of::<Status>());
            let buffer = match self.has_progress {
                true => progress.add(size_of::<Progress>()),
                false => progress,
            };
            PortMut {
                status: &mut *status.cast(),
                progress: self.has_progress.then(|| &mut *progress.cast()),
                buffer: core::slice::from_raw_parts_mut(buffer, length),
                memory: self.keeps.then(|| &mut *buffer.add(length).cast()),
            }
        }
    }
}

/// The hardware that instructions ask, as functions; one that is `NULL` means "not fitted". `context` is handed to each.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct HalTable {
    /// The host's own.
    pub context: *mut c_void,
    /// Reads the real-time clock; false if there is none.
    pub clock: Option<extern "C" fn(context: *mut c_void, clock: *mut Clock) -> bool>,
    /// Sets the real-time clock; false if that failed.
    pub set_clock: Option<extern "C" fn(context: *mut c_void, clock: *const Clock) -> bool>,
    /// Reads a word of the buffer memory of a module; false if there is none.
    pub read_bfm: Option<
        extern "C" fn(context: *mut c_void, unit: u16, address: u16, value: *mut i16) -> bool,
    >,
    /// Writes a word of the buffer memory of a module; false if there is none.
    pub write_bfm:
        Option<extern "C" fn(context: *mut c_void, unit: u16, address: u16, value: i16) -> bool>,
    /// Waits until a remote module (101 to 163) answers, for this many milliseconds at most; false if it has not.
    /// `NULL`: only its buffer memory shows whether it is there.
    pub module_answers:
        Option<extern "C" fn(context: *mut c_void, unit: u16, most_ms: u16) -> bool>,
    /// Raw value of a built-in analog input; false if there is none.
    pub analog: Option<extern "C" fn(context: *mut c_void, channel: u8, value: *mut i16) -> bool>,
    /// Reads an input terminal now; false if there is none.
    pub input: Option<extern "C" fn(context: *mut c_void, number: u16, on: *mut bool) -> bool>,
    /// Sets an output terminal now.
    pub set_output: Option<extern "C" fn(context: *mut c_void, number: u16, on: bool)>,
    /// Keeps the interrupt from coming that calls the program's `pulse_timer`, or lets it come again.
    pub hold_pulses: Option<extern "C" fn(context: *mut c_void, hold: bool)>,
    /// Sets the format of characters on the line of a serial port, before anything else and when it changes.
    pub set_line: Option<extern "C" fn(context: *mut c_void, port: u8, format: *const LineFormat)>,
    /// Takes the oldest character that was in by `now_us`, microseconds since power-on, wrapping; false if there is none.
    pub receive: Option<
        extern "C" fn(context: *mut c_void, port: u8, now_us: u32, received: *mut Received) -> bool,
    >,
    /// Takes a character to be sent after those before it; false if there is no room for it now.
    pub send: Option<extern "C" fn(context: *mut c_void, port: u8, byte: u8, now_us: u32) -> bool>,
    /// Number of those characters that are not out by `now_us`, to the end of their stop bits.
    pub unsent: Option<extern "C" fn(context: *mut c_void, port: u8, now_us: u32) -> u16>,
    /// Takes the oldest frame that has come by CAN; false if there is none.
    pub can_receive: Option<extern "C" fn(context: *mut c_void, frame: *mut CanFrame) -> bool>,
    /// Takes a frame to be sent by CAN after those before it; false if there is no room for it now.
    pub can_send: Option<extern "C" fn(context: *mut c_void, frame: *const CanFrame) -> bool>,
    /// Returns true while frames taken by `can_send` are not on the bus yet; `NULL`: never.
    pub can_is_sending: Option<extern "C" fn(context: *mut c_void) -> bool>,
    /// Returns true if the power supply fails now; `NULL`: it is not monitored.
    pub power_fails: Option<extern "C" fn(context: *mut c_void) -> bool>,
    /// Voltage of the battery in tenths of a volt; false if nothing measures it.
    pub battery: Option<extern "C" fn(context: *mut c_void, tenths: *mut u16) -> bool>,
}

/// Callback of a host for operation errors: `plc_on_error`.
pub(crate) type OnError = extern "C" fn(plc: *const c_void, code: u16, step: u16);

/// A program's devices: its struct, what it looks like, and the hardware.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Map {
    /// Layout of the struct.
    pub layout: *const Layout,
    /// The struct. Nothing else may use it during a call.
    pub plc: *mut c_void,
    /// The hardware; `NULL`: nothing fitted.
    pub hal: *const HalTable,
    /// Taken by instructions without private memory.
    pub none: State,
}

/// Request of a partner on a line to operate the RUN/STOP switch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Request {
    /// Nothing.
    None = 0,
    /// RUN.
    Run = 1,
    /// STOP.
    Stop = 2,
}

impl Request {
    fn of(running: Option<bool>) -> Self {
        match running {
            None => Request::None,
            Some(true) => Request::Run,
            Some(false) => Request::Stop,
        }
    }
}

/// Runs an instruction: what the exported functions are made of.
pub(crate) fn run(map: &mut Map, function: fn(&mut Cx) -> Done, site: Site, ops: &[Operand]) {
    map.call(function, site, ops);
}

/// Exports a function of the registry.
macro_rules! export {
    ($module:ident::$function:ident($($operand:ident),*)) => {
        const _: () = {
            #[allow(unsafe_code, reason = "the name of each function occurs once in the registry, and no other symbol begins like it")]
            #[unsafe(export_name = concat!("rungc_", stringify!($function)))]
            extern "C" fn exported(
                map: &mut $crate::capi::Map,
                site: $crate::Site
                $(, $operand: $crate::Operand)*
            ) {
                $crate::capi::run(map, $crate::fnc::$module::$function, site, &[$($operand),*]);
            }
        };
    };
}
pub(crate) use export;
