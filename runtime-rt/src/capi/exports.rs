//! The functions that C calls, except those of the registry.

use super::hal::Board;
use super::{Map, Request};
use crate::axis::{advance, millihertz, pulse_timer};
use crate::comm::{Port, advance as advance_ports};
use crate::cx::{fetch, send};
use crate::hal::Hal;
use crate::operand::Operand;
use crate::plc::{Class, Plc, Site};

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
