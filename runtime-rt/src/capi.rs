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

use crate::axis::{Axis, advance, millihertz, pulse_timer};
use crate::comm::{LineFormat, Port, Ports, Received, advance as advance_ports};
use crate::cx::{Cx, fetch, send};
use crate::fault::{Done, report};
use crate::hal::{Clock, Hal, SerialPort};
use crate::operand::Operand;
use crate::plc::{Class, Plc, Site, State, Sys};
use crate::runs::FIRST_COUNTER32;
use crate::timing::{Counter16, Counter32, Timer};
use crate::wiring::Pulses;
use core::ffi::c_void;

/// What an area of devices is made of.
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

/// Devices that stand side by side in the program's struct.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Area {
    /// Their class.
    pub class: Class,
    /// What each is.
    pub kind: Kind,
    /// First number.
    pub first: u32,
    /// How many.
    pub count: u32,
    /// How many numbers it is from a device to the next one in memory: 1, or more in an array of this many columns, each as long as the
    /// longest has to be.
    pub columns: u32,
    /// How many of the columns are stored: the first ones.
    pub kept: u32,
    /// Where they begin in the struct, in bytes.
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
    /// How many.
    pub length: usize,
}

/// What a program's struct looks like. All pointers are valid for their counts, for as long as the program runs.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Layout {
    /// Areas, sorted by class and first number.
    pub areas: *const Area,
    /// How many.
    pub area_count: usize,
    /// What the model has, sorted likewise.
    pub ranges: *const Range,
    /// How many.
    pub range_count: usize,
    /// Index registers with a second name.
    pub aliases: *const Alias,
    /// How many.
    pub alias_count: usize,
    /// Texts.
    pub texts: *const Text,
    /// How many.
    pub text_count: usize,
    /// Where the struct holds its `plc_sys`.
    pub sys: usize,
    /// Where the struct holds its `plc_error`; 0 if it has none.
    pub error: usize,
    /// Where the struct holds its private memories.
    pub states: usize,
    /// How many; slots are numbered from 1.
    pub state_count: u16,
    /// Whether a 32-bit access to Zn takes Vn as its high word.
    pub z_pairs_with_v: bool,
    /// Relay that shows an operation error.
    pub error_relay: u16,
    /// Code of an error in an operand's value.
    pub value_error: u16,
    /// Where the struct holds its pulse outputs.
    pub axes: usize,
    /// Their numbers Y, in order.
    pub outputs: *const u8,
    /// How many.
    pub output_count: usize,
    /// The pulse outputs that the model has.
    pub pulses: Pulses,
    /// Where the struct holds its serial ports.
    pub ports: usize,
    /// Their numbers, in order.
    pub port_numbers: *const u8,
    /// How many.
    pub port_count: usize,
    /// The serial ports that the model has.
    pub port_family: Ports,
    /// Code of model and version, for partners on a line.
    pub type_code: u16,
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
    /// Raw value of a built-in analog input; false if there is none.
    pub analog: Option<extern "C" fn(context: *mut c_void, channel: u8, value: *mut i16) -> bool>,
    /// Reads an input terminal now; false if there is none.
    pub input: Option<extern "C" fn(context: *mut c_void, number: u16, on: *mut bool) -> bool>,
    /// Sets an output terminal now.
    pub set_output: Option<extern "C" fn(context: *mut c_void, number: u16, on: bool)>,
    /// Keeps the interrupt from coming that calls the program's `pulse_timer`, or lets it come again.
    pub hold_pulses: Option<extern "C" fn(context: *mut c_void, hold: bool)>,
    /// Sets how characters stand on the line of a serial port, before anything else and when it changes.
    pub set_line: Option<extern "C" fn(context: *mut c_void, port: u8, format: *const LineFormat)>,
    /// Takes the oldest character that was in by `now_us`, microseconds since power-on, wrapping; false if there is none.
    pub receive: Option<
        extern "C" fn(context: *mut c_void, port: u8, now_us: u32, received: *mut Received) -> bool,
    >,
    /// Takes a character to be sent after those before it; false if there is no room for it now.
    pub send: Option<extern "C" fn(context: *mut c_void, port: u8, byte: u8, now_us: u32) -> bool>,
    /// How many characters of those are not out by `now_us`, to the end of their stop bits.
    pub unsent: Option<extern "C" fn(context: *mut c_void, port: u8, now_us: u32) -> u16>,
}

/// A program's devices: its struct, what it looks like, and the hardware.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Map {
    /// What the struct looks like.
    pub layout: *const Layout,
    /// The struct. Nothing else may use it during a call.
    pub plc: *mut c_void,
    /// The hardware; `NULL`: nothing fitted.
    pub hal: *const HalTable,
    /// Taken by instructions without private memory.
    pub none: State,
}

/// Where a device is.
enum Found {
    /// Stored there.
    At(Kind, *mut u8),
    /// The model has it; the program does not look at it.
    Elsewhere,
    /// The model has no such device.
    Nowhere,
}

/// The elements that a pointer of a [`Layout`] stands for.
fn elements<'a, T>(first: *const T, count: usize) -> &'a [T] {
    if first.is_null() {
        return &[];
    }
    // SAFETY: a Layout's pointers are valid for their counts and as long as the program runs, and nothing writes to them.
    unsafe { core::slice::from_raw_parts(first, count) }
}

impl Map {
    fn layout(&self) -> &Layout {
        // SAFETY: whoever makes a Map gives it a valid layout that outlives it.
        unsafe { &*self.layout }
    }

    fn find(&self, class: Class, number: u32) -> Found {
        let layout = self.layout();
        let areas = elements(layout.areas, layout.area_count);
        let after = areas.partition_point(|a| (a.class, a.first) <= (class, number));
        let area = after.checked_sub(1).and_then(|i| areas.get(i));
        let holds = |a: &&Area| {
            let n = number - a.first;
            a.class == class && n < a.count && n % a.columns.max(1) < a.kept
        };
        if let Some(area) = area.filter(holds) {
            let size = match area.kind {
                Kind::Bits => size_of::<bool>(),
                Kind::Words => size_of::<i16>(),
                Kind::Timers => size_of::<Timer>(),
                Kind::Counters16 => size_of::<Counter16>(),
                Kind::Counters32 => size_of::<Counter32>(),
            };
            let (n, columns) = (number - area.first, area.columns.max(1));
            let place = n % columns * area.count.div_ceil(columns) + n / columns;
            let offset = area.offset + place as usize * size;
            // SAFETY: an area's elements lie inside the program's struct, which `plc` points to.
            return Found::At(area.kind, unsafe { self.plc.cast::<u8>().add(offset) });
        }
        if class == Class::D {
            let aliases = elements(layout.aliases, layout.alias_count);
            if let Some(alias) = aliases
                .iter()
                .find(|a| a.number == number && a.class != Class::D)
            {
                return self.find(alias.class, alias.index);
            }
        }
        let ranges = elements(layout.ranges, layout.range_count);
        let after = ranges.partition_point(|r| (r.class, r.first) <= (class, number));
        let range = after.checked_sub(1).and_then(|i| ranges.get(i));
        match range.filter(|r| r.class == class && number <= r.last) {
            Some(_) => Found::Elsewhere,
            None => Found::Nowhere,
        }
    }

    /// Does something with one device as an instruction would.
    fn with_operand<R>(&mut self, class: Class, number: u32, what: impl FnOnce(&mut Cx) -> R) -> R {
        let mut hal = Board::new(self.hal);
        let ops = [Operand::device(
            class,
            i32::try_from(number).unwrap_or(i32::MAX),
        )];
        what(&mut Cx::new(self, &mut hal, &ops, Site::at(0).wide()))
    }

    /// Runs an instruction and reports its fault.
    fn call(&mut self, function: fn(&mut Cx) -> Done, site: Site, ops: &[Operand]) {
        let mut hal = Board::new(self.hal);
        let done = function(&mut Cx::new(self, &mut hal, ops, site));
        if let Err(fault) = done {
            report(self, fault, site.step);
        }
    }
}

/// Reads an element of the program's struct.
fn read<T: Copy>(at: *mut u8) -> T {
    // SAFETY: `find` gives a pointer to an element of the kind that the caller reads, aligned as the C compiler placed it.
    unsafe { at.cast::<T>().read() }
}

/// Changes an element of the program's struct.
fn change<T>(at: *mut u8, change: impl FnOnce(&mut T)) -> Option<()> {
    // SAFETY: as for `read`; nothing else uses the struct during a call.
    change(unsafe { &mut *at.cast::<T>() });
    Some(())
}

impl Plc for Map {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        match self.find(class, number) {
            Found::At(Kind::Bits, at) => Some(read(at)),
            Found::At(Kind::Timers, at) => Some(read::<Timer>(at).done),
            Found::At(Kind::Counters16, at) => Some(read::<Counter16>(at).done),
            Found::At(Kind::Counters32, at) => Some(read::<Counter32>(at).done),
            Found::Elsewhere if is_bit(class) => Some(false),
            _ => None,
        }
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Bits, at) => change(at, |bit| *bit = value),
            Found::At(Kind::Timers, at) => change(at, |timer: &mut Timer| timer.done = value),
            Found::At(Kind::Counters16, at) => {
                change(at, |counter: &mut Counter16| counter.done = value)
            }
            Found::At(Kind::Counters32, at) => {
                change(at, |counter: &mut Counter32| counter.done = value)
            }
            Found::Elsewhere if is_bit(class) => Some(()),
            _ => None,
        }
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        match self.find(class, number) {
            Found::At(Kind::Words, at) => Some(read(at)),
            Found::At(Kind::Timers, at) => Some(read::<Timer>(at).value),
            Found::At(Kind::Counters16, at) => Some(read::<Counter16>(at).value),
            Found::Elsewhere if is_word(class, number) => Some(0),
            _ => None,
        }
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Words, at) => change(at, |word| *word = value),
            Found::At(Kind::Timers, at) => change(at, |timer: &mut Timer| timer.value = value),
            Found::At(Kind::Counters16, at) => {
                change(at, |counter: &mut Counter16| counter.value = value)
            }
            Found::Elsewhere if is_word(class, number) => Some(()),
            _ => None,
        }
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        match self.find(Class::C, number) {
            Found::At(Kind::Counters32, at) => Some(read::<Counter32>(at).value),
            Found::Elsewhere if number >= FIRST_COUNTER32 => Some(0),
            _ => None,
        }
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        match self.find(Class::C, number) {
            Found::At(Kind::Counters32, at) => {
                change(at, |counter: &mut Counter32| counter.value = value)
            }
            Found::Elsewhere if number >= FIRST_COUNTER32 => Some(()),
            _ => None,
        }
    }

    fn stores(&self, class: Class, number: u32) -> bool {
        matches!(self.find(class, number), Found::At(..))
    }

    fn state(&mut self, slot: u16) -> &mut State {
        let layout = *self.layout();
        if slot == 0 || slot > layout.state_count {
            return &mut self.none;
        }
        let offset = layout.states + usize::from(slot - 1) * size_of::<State>();
        // SAFETY: the struct holds `state_count` memories there, and nothing else uses it during a call.
        unsafe { &mut *self.plc.cast::<u8>().add(offset).cast::<State>() }
    }

    fn sys(&self) -> &Sys {
        // SAFETY: the struct holds its `plc_sys` there, which is the same type.
        unsafe { &*self.plc.cast::<u8>().add(self.layout().sys).cast::<Sys>() }
    }

    fn axis(&mut self, output: u32) -> Option<&mut Axis> {
        let layout = *self.layout();
        let outputs = elements(layout.outputs, layout.output_count);
        let i = outputs.iter().position(|&n| u32::from(n) == output)?;
        let offset = layout.axes + i * size_of::<Axis>();
        // SAFETY: the struct holds `output_count` outputs there, and nothing else uses it during a call.
        Some(unsafe { &mut *self.plc.cast::<u8>().add(offset).cast::<Axis>() })
    }

    fn port(&mut self, number: u8) -> Option<&mut Port> {
        let layout = *self.layout();
        let numbers = elements(layout.port_numbers, layout.port_count);
        let i = numbers.iter().position(|&n| n == number)?;
        let offset = layout.ports + i * size_of::<Port>();
        // SAFETY: the struct holds `port_count` ports there, aligned as words, and nothing else uses it during a call.
        Some(unsafe { &mut *self.plc.cast::<u8>().add(offset).cast::<Port>() })
    }

    fn ports(&self) -> Ports {
        self.layout().port_family
    }

    fn type_code(&self) -> u16 {
        self.layout().type_code
    }

    fn pulses(&self) -> Pulses {
        self.layout().pulses
    }

    fn text(&self, index: u32) -> &[u8] {
        let layout = self.layout();
        let texts = elements(layout.texts, layout.text_count);
        texts
            .get(index as usize)
            .map_or(&[], |text| elements(text.bytes, text.length))
    }

    fn z_pairs_with_v(&self) -> bool {
        self.layout().z_pairs_with_v
    }

    fn error_relay(&self) -> u32 {
        self.layout().error_relay.into()
    }

    fn value_error(&self) -> u16 {
        self.layout().value_error
    }

    fn note_error(&mut self, code: u16, step: u32) {
        let offset = self.layout().error;
        if offset > 0 {
            // SAFETY: the struct holds its `plc_error` there, which begins with the code and the step.
            let at = unsafe { self.plc.cast::<u8>().add(offset) };
            let _ = change(at, |error: &mut [u16; 2]| *error = [code, step as u16]);
        }
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        match self.find(class, number) {
            Found::At(Kind::Timers, at) => change(at, Timer::reset),
            Found::At(Kind::Counters16, at) => change(at, Counter16::reset),
            Found::At(Kind::Counters32, at) => change(at, Counter32::reset),
            Found::Elsewhere if matches!(class, Class::T | Class::C) => Some(()),
            _ => None,
        }
    }
}

/// Whether devices of a class have a state.
fn is_bit(class: Class) -> bool {
    matches!(
        class,
        Class::X | Class::Y | Class::M | Class::S | Class::T | Class::C
    )
}

/// Whether a device has a 16-bit value.
fn is_word(class: Class, number: u32) -> bool {
    match class {
        Class::C => number < FIRST_COUNTER32,
        Class::X | Class::Y | Class::M | Class::S => false,
        _ => true,
    }
}

/// The host's hardware.
struct Board {
    table: *const HalTable,
    line: Line,
}

/// One of its serial ports.
struct Line {
    table: *const HalTable,
    number: u8,
}

impl Line {
    fn table(&self) -> Option<&HalTable> {
        // SAFETY: NULL, or the host's table, which outlives the call.
        unsafe { self.table.as_ref() }
    }
}

impl SerialPort for Line {
    fn set_format(&mut self, format: LineFormat) {
        if let Some((table, set)) = self.table().and_then(|t| t.set_line.map(|f| (t, f))) {
            set(table.context, self.number, &format);
        }
    }

    fn receive(&mut self, now_us: u32) -> Option<Received> {
        let table = self.table()?;
        let mut received = Received::new();
        (table.receive?)(table.context, self.number, now_us, &mut received).then_some(received)
    }

    fn send(&mut self, byte: u8, now_us: u32) -> bool {
        let table = self.table().and_then(|t| t.send.map(|f| (t, f)));
        table.is_some_and(|(table, send)| send(table.context, self.number, byte, now_us))
    }

    fn unsent(&mut self, now_us: u32) -> u16 {
        let table = self.table().and_then(|t| t.unsent.map(|f| (t, f)));
        table.map_or(0, |(table, unsent)| {
            unsent(table.context, self.number, now_us)
        })
    }
}

impl Board {
    fn new(table: *const HalTable) -> Self {
        Board {
            table,
            line: Line { table, number: 0 },
        }
    }

    fn table(&self) -> Option<&HalTable> {
        // SAFETY: NULL, or the host's table, which outlives the call.
        unsafe { self.table.as_ref() }
    }
}

impl Hal for Board {
    fn clock(&mut self) -> Option<Clock> {
        let table = self.table()?;
        let mut clock = Clock::default();
        (table.clock?)(table.context, &mut clock).then_some(clock)
    }

    fn set_clock(&mut self, clock: Clock) -> Option<()> {
        let table = self.table()?;
        (table.set_clock?)(table.context, &clock).then_some(())
    }

    fn read_bfm(&mut self, unit: u16, address: u16) -> Option<i16> {
        let table = self.table()?;
        let mut value = 0;
        (table.read_bfm?)(table.context, unit, address, &mut value).then_some(value)
    }

    fn write_bfm(&mut self, unit: u16, address: u16, value: i16) -> Option<()> {
        let table = self.table()?;
        (table.write_bfm?)(table.context, unit, address, value).then_some(())
    }

    fn analog(&mut self, channel: u8) -> Option<i16> {
        let table = self.table()?;
        let mut value = 0;
        (table.analog?)(table.context, channel, &mut value).then_some(value)
    }

    fn input(&mut self, number: u16) -> Option<bool> {
        let table = self.table()?;
        let mut on = false;
        (table.input?)(table.context, number, &mut on).then_some(on)
    }

    fn set_output(&mut self, number: u16, value: bool) {
        if let Some((table, set_output)) = self.table().and_then(|t| t.set_output.map(|f| (t, f))) {
            set_output(table.context, number, value);
        }
    }

    fn serial_port(&mut self, number: u8) -> Option<&mut dyn SerialPort> {
        self.table()?.set_line?;
        self.line.number = number;
        Some(&mut self.line)
    }

    fn hold_pulses(&mut self, hold: bool) {
        if let Some((table, hold_pulses)) = self.table().and_then(|t| t.hold_pulses.map(|f| (t, f)))
        {
            hold_pulses(table.context, hold);
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

/// The value of an operand, of the width of the form; false after a fault, which is shown in the program's special devices.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_fetch(map: &mut Map, site: Site, from: Operand, value: &mut i32) -> bool {
    let mut hal = Board::new(map.hal);
    let fetched = fetch(site, from, map, &mut hal);
    fetched.map(|fetched| *value = fetched).is_some()
}

/// Writes a value of the width of the form to an operand, as an instruction does.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_send(map: &mut Map, site: Site, to: Operand, value: i32) {
    let mut hal = Board::new(map.hal);
    send(site, to, value, map, &mut hal);
}

/// State of a bit device, for hosts that find devices by number; false if the model has none of that number.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_get_bit(map: &Map, class: Class, number: u32, on: &mut bool) -> bool {
    map.bit(class, number).map(|bit| *on = bit).is_some()
}

/// Sets a bit device.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_set_bit(map: &mut Map, class: Class, number: u32, on: bool) -> bool {
    map.set_bit(class, number, on).is_some()
}

/// Value of a 16-bit word device.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_get_word(map: &Map, class: Class, number: u32, value: &mut i16) -> bool {
    map.word(class, number).map(|word| *value = word).is_some()
}

/// Sets a 16-bit word device.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_set_word(map: &mut Map, class: Class, number: u32, value: i16) -> bool {
    map.set_word(class, number, value).is_some()
}

/// The 32-bit value of a counter from C200 on or of a pair of words, as 32-bit instructions see it.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_get_long(
    map: &mut Map,
    class: Class,
    number: u32,
    value: &mut i32,
) -> bool {
    let found = map.with_operand(class, number, |cx| cx.dword(0, 0));
    found.map(|long| *value = long).is_ok()
}

/// Counts the pulses that have been sent by `now_us`, in microseconds since power-on, wrapping.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_advance_pulses(map: &mut Map, now_us: u32) {
    let mut hal = Board::new(map.hal);
    hal.hold_pulses(true);
    advance(map, now_us);
    hal.hold_pulses(false);
}

/// What a partner on a line has asked of the RUN/STOP switch.
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

/// Brings the serial ports to `now_us`, microseconds since power-on, wrapping.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_advance_ports(map: &mut Map, now_us: u32) -> Request {
    let mut hal = Board::new(map.hal);
    match advance_ports(map, &mut hal, now_us) {
        None => Request::None,
        Some(true) => Request::Run,
        Some(false) => Request::Stop,
    }
}

/// A program holds ports as words of 32 bits.
const _: () = assert!(align_of::<Port>() <= 4 && size_of::<Port>().is_multiple_of(4));

/// Drives the pins of all pulse outputs at `now_us`; returns after how many microseconds the next one changes, `UINT32_MAX` if none does.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_pulse_timer(map: &mut Map, now_us: u32) -> u32 {
    let mut hal = Board::new(map.hal);
    pulse_timer(map, &mut hal, now_us).unwrap_or(u32::MAX)
}

/// Pulses that output Y `number` has sent since power-on; those in reverse count down.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_pulses_sent(map: &mut Map, number: u32) -> i32 {
    map.axis(number).map_or(0, |axis| axis.sent)
}

/// The frequency at which output Y `number` sends pulses now, in millihertz.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_pulse_millihertz(map: &mut Map, number: u32) -> u32 {
    millihertz(map, number)
}

/// Sets the 32-bit value of a counter from C200 on or of a pair of words.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_set_long(map: &mut Map, class: Class, number: u32, value: i32) -> bool {
    map.with_operand(class, number, |cx| cx.set_dword(0, 0, value))
        .is_ok()
}
