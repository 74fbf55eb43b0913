//! The virtual hardware for C hosts that test: for a few PLCs of the process, which must use it from one thread.

use crate::capi::HalTable;
use crate::comm::{CharFault, LineFormat, Received};
use crate::hal::{Clock, Hal, SerialPort};
use crate::modules::{KINDS, Quantity, Signal};
use crate::virtual_hal::VirtualHal;
use core::cell::UnsafeCell;
use core::ffi::c_void;
use core::ptr::null_mut;

/// PLCs that a case may have.
const PLCS: usize = 4;

/// The hardware of all PLCs, and which of them is meant.
struct Hardware {
    plcs: [VirtualHal; PLCS],
    current: usize,
}

/// The hardware of a process with one thread.
struct OneThread(UnsafeCell<Hardware>);

// SAFETY: the header says that these functions may be called from one thread only.
unsafe impl Sync for OneThread {}

static HARDWARE: OneThread = OneThread(UnsafeCell::new(Hardware {
    plcs: [const { VirtualHal::new() }; PLCS],
    current: 0,
}));

/// Does something with the hardware.
fn with<R>(what: impl FnOnce(&mut VirtualHal) -> R) -> R {
    // SAFETY: there is one thread, and `what` never calls back into this file.
    let hardware = unsafe { &mut *HARDWARE.0.get() };
    what(&mut hardware.plcs[hardware.current])
}

/// Stores what was found where C asked for it.
fn give<T>(value: Option<T>, to: *mut T) -> bool {
    match value {
        Some(value) if !to.is_null() => {
            // SAFETY: C gave a pointer to a variable of this type.
            unsafe { to.write(value) };
            true
        }
        _ => false,
    }
}

extern "C" fn clock(_: *mut c_void, clock: *mut Clock) -> bool {
    give(with(Hal::clock), clock)
}

extern "C" fn set_clock(_: *mut c_void, clock: *const Clock) -> bool {
    // SAFETY: C gave a pointer to a clock, or NULL.
    let clock = unsafe { clock.as_ref() };
    clock
        .and_then(|&clock| with(|hal| hal.set_clock(clock)))
        .is_some()
}

extern "C" fn read_bfm(_: *mut c_void, unit: u16, address: u16, value: *mut i16) -> bool {
    give(with(|hal| hal.read_bfm(unit, address)), value)
}

extern "C" fn write_bfm(_: *mut c_void, unit: u16, address: u16, value: i16) -> bool {
    with(|hal| hal.write_bfm(unit, address, value)).is_some()
}

extern "C" fn analog(_: *mut c_void, channel: u8, value: *mut i16) -> bool {
    give(with(|hal| hal.analog(channel)), value)
}

extern "C" fn set_line(_: *mut c_void, port: u8, format: *const LineFormat) {
    // SAFETY: the runtime gives a pointer to a format.
    if let Some(&format) = unsafe { format.as_ref() } {
        with(|hal| hal.line(port).map(|line| line.set_format(format)));
    }
}

extern "C" fn receive(_: *mut c_void, port: u8, now_us: u32, received: *mut Received) -> bool {
    give(with(|hal| hal.line(port)?.receive(now_us)), received)
}

extern "C" fn send(_: *mut c_void, port: u8, byte: u8, now_us: u32) -> bool {
    with(|hal| hal.line(port).is_some_and(|line| line.send(byte, now_us)))
}

extern "C" fn unsent(_: *mut c_void, port: u8, now_us: u32) -> u16 {
    with(|hal| hal.line(port).map_or(0, |line| line.unsent(now_us)))
}

extern "C" fn module_answers(_: *mut c_void, unit: u16, most_ms: u16) -> bool {
    with(|hal| hal.module_answers(unit, most_ms))
}

extern "C" fn power_fails(_: *mut c_void) -> bool {
    with(|hal| hal.power_fails()) == Some(true)
}

/// The virtual hardware as instructions see it, for `Map::hal`.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_hal() -> HalTable {
    HalTable {
        context: null_mut(),
        clock: Some(clock),
        set_clock: Some(set_clock),
        read_bfm: Some(read_bfm),
        write_bfm: Some(write_bfm),
        module_answers: Some(module_answers),
        analog: Some(analog),
        input: None,
        set_output: None,
        hold_pulses: None,
        set_line: Some(set_line),
        receive: Some(receive),
        send: Some(send),
        unsent: Some(unsent),
        can_receive: None,
        can_send: None,
        can_is_sending: None,
        power_fails: Some(power_fails),
        battery: None,
    }
}

/// Virtual hardware as new: without modules, at virtual time 0.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_reset() {
    with(|hal| *hal = VirtualHal::new());
}

/// Selects the PLC, 0 for the first, that the following calls are for; false if there are not so many.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_select(plc: u32) -> bool {
    let plc = usize::try_from(plc).unwrap_or(PLCS);
    if plc < PLCS {
        // SAFETY: there is one thread, and nothing refers to the hardware.
        unsafe { (*HARDWARE.0.get()).current = plc };
    }
    plc < PLCS
}

/// A character comes to a serial port; `fault` is a number of rungc_char_fault. False if too many are on their way.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_receive(port: u8, at_us: u32, byte: u8, fault: u8) -> bool {
    let character = Received {
        at_us,
        byte,
        fault: CharFault::of(fault),
    };
    with(|hal| hal.line(port)?.feed(character)).is_some()
}

/// Takes the oldest character that a serial port has sent by `now_us`: its time, shifted left by 8, plus the character.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_sent(port: u8, now_us: u32, sent: *mut i64) -> bool {
    give(with(|hal| hal.line(port)?.take_packed(now_us)), sent)
}

/// The format of characters on the line of a serial port.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_line(port: u8, format: *mut i64) -> bool {
    give(
        with(|hal| hal.line(port).map(|line| line.format().packed())),
        format,
    )
}

/// Virtual time begins at 0 again, as after power off and on.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_restart() {
    with(VirtualHal::restart);
}

/// Virtual time is now `now_ms`; before each scan.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_advance(now_ms: u32) {
    with(|hal| hal.advance_to(now_ms));
}

/// Sets a word of buffer memory, fitting the module if need be; false if the table is full.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_bfm(unit: u16, address: u16, value: i16) -> bool {
    with(|hal| hal.set_bfm(unit, address, value)).is_some()
}

/// A word of buffer memory; false if there is no such module.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_get_bfm(unit: u16, address: u16, value: *mut i16) -> bool {
    give(with(|hal| hal.bfm(unit, address)), value)
}

/// Fits a special module, by its number in the table of kinds; false if there is no such kind or no place for it.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_fit(unit: u16, kind: u16) -> bool {
    let kind = KINDS.get(usize::from(kind));
    kind.and_then(|kind| with(|hal| hal.fit(unit, kind)))
        .is_some()
}

/// A module answers after this many milliseconds from now on; false if too many are slow.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_delay_module(unit: u16, ms: u16) -> bool {
    with(|hal| hal.delay_module(unit, ms)).is_some()
}

/// The RUN/STOP switch, as modules see it.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_running(running: bool) {
    with(|hal| hal.set_running(running));
}

/// Connects a signal to an input of a module, in millionths of a volt (quantity 0), of a milliampere (1) or of a degree
/// Celsius (2). False if there is no such input.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_signal(
    unit: u16,
    channel: u8,
    quantity: u8,
    millionths: i32,
) -> bool {
    let signal = Quantity::of(quantity).map(|quantity| Signal {
        quantity,
        millionths,
    });
    signal
        .and_then(|signal| with(|hal| hal.set_signal(unit, channel, signal)))
        .is_some()
}

/// Signal at a channel of a module, in millionths of that unit; false if there is no such channel.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_get_signal(
    unit: u16,
    channel: u8,
    quantity: u8,
    millionths: *mut i32,
) -> bool {
    let quantity = Quantity::of(quantity);
    let found = quantity.and_then(|quantity| with(|hal| hal.signal(unit, channel, quantity)));
    give(found, millionths)
}

/// Sets the raw value of an analog input; false if there is no such channel.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_analog(channel: u8, value: i16) -> bool {
    with(|hal| hal.set_analog(channel, value)).is_some()
}

/// The power supply fails from now on, or is back.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_power_fails(fails: bool) {
    with(|hal| hal.set_power_fails(fails));
}

/// Sets the real-time clock; false if there is no such moment.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_virtual_set_clock(
    year: u16,
    month: u8,
    day: u8,
    hour: u8,
    minute: u8,
    second: u8,
) -> bool {
    Clock::new(year, month, day, hour, minute, second)
        .and_then(|clock| with(|hal| hal.set_clock(clock)))
        .is_some()
}
