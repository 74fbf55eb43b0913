//! The functions that C calls, except those of the registry.

use super::hal::{Board, Lines};
use super::stored::Stored;
use super::{Map, Request};
use crate::axis::{advance, millihertz, pass, pulse_timer};
use crate::comm::codec::{self, Codec};
use crate::comm::modbus::{self, Profile};
use crate::comm::{
    Port, PortWiring, Ports, Progress, Status, advance as advance_ports, advance_slave,
};
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

/// Counts the pulses that are sent from `from_us` to `until_us`, in microseconds since power-on, wrapping, but only until an output has sent
/// `most`; returns the time that is reached. For simulators, whose machines change an input at the very pulse.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_pass_pulses(map: &mut Map, from_us: u32, until_us: u32, most: u32) -> u32 {
    pass(map, from_us, until_us, most)
}

/// Brings the serial ports to `now_us`, microseconds since power-on, wrapping.
#[unsafe(no_mangle)]
pub extern "C" fn rungc_advance_ports(map: &mut Map, now_us: u32) -> Request {
    let mut hal = Lines::new(map.hal);
    Request::of(advance_ports(map, &mut hal, now_us))
}

/// Exports constants, so that a linker takes only those that a program's layout names.
macro_rules! export_constants {
    ($names:ident: $type:ident; $($symbol:literal = $constant:expr;)*) => {
        $(const _: () = {
            #[allow(unsafe_code, reason = "each name occurs once, and no other symbol begins like it")]
            #[unsafe(export_name = $symbol)]
            static EXPORTED: $type = $constant;
        };)*

        /// Their names for a linker.
        #[cfg(test)]
        const $names: &[&str] = &[$($symbol),*];
    };
}

export_constants! {
    CODECS: Codec;
    "rungc_codec_free" = codec::FREE;
    "rungc_codec_programming_port" = codec::PROGRAMMING_PORT;
    "rungc_codec_modbus_rtu" = codec::MODBUS_RTU;
    "rungc_codec_qlink" = codec::QLINK;
    "rungc_codec_modbus_ascii" = codec::MODBUS_ASCII;
    "rungc_codec_master_rtu" = codec::MASTER_RTU;
    "rungc_codec_master_ascii" = codec::MASTER_ASCII;
    "rungc_codec_computer_link" = codec::COMPUTER_LINK;
    "rungc_codec_link" = codec::LINK;
    "rungc_codec_can" = codec::CAN;
    "rungc_codec_canlink" = codec::CANLINK;
}

export_constants! {
    PROFILES: Profile;
    "rungc_modbus_h1u" = modbus::H1U;
    "rungc_modbus_h2u" = modbus::H2U;
    "rungc_modbus_l01s" = modbus::L01S;
    "rungc_modbus_hm" = modbus::HM;
    "rungc_modbus_fx3u" = modbus::FX3U;
}

export_constants! {
    WIRINGS: PortWiring;
    "rungc_port_inovance_0" = Ports::Inovance.all()[0];
    "rungc_port_inovance_1" = Ports::Inovance.all()[1];
    "rungc_port_inovance_2" = Ports::Inovance.all()[2];
    "rungc_port_inovance_3" = Ports::Inovance.all()[3];
    "rungc_port_inovance_4" = Ports::Inovance.all()[4];
    "rungc_port_l01s_1" = Ports::L01s.all()[0];
    "rungc_port_l01s_2" = Ports::L01s.all()[1];
    "rungc_port_l01s_3" = Ports::L01s.all()[2];
    "rungc_port_hm_0" = Ports::Hm.all()[0];
    "rungc_port_hm_1" = Ports::Hm.all()[1];
    "rungc_port_fx_0" = Ports::Fx.all()[0];
    "rungc_port_fx_1" = Ports::Fx.all()[1];
    "rungc_port_fx3_0" = Ports::Fx3.all()[0];
    "rungc_port_fx3_1" = Ports::Fx3.all()[1];
    "rungc_port_fx3_2" = Ports::Fx3.all()[2];
    "rungc_port_fx3g_0" = Ports::Fx3g.all()[0];
    "rungc_port_fx3g_1" = Ports::Fx3g.all()[1];
    "rungc_port_fx3g_2" = Ports::Fx3g.all()[2];
    "rungc_port_board2n_0" = Ports::Board2n.all()[0];
    "rungc_port_board2n_1" = Ports::Board2n.all()[1];
    "rungc_port_board3u_0" = Ports::Board3u.all()[0];
    "rungc_port_board3u_1" = Ports::Board3u.all()[1];
    "rungc_port_board3u_2" = Ports::Board3u.all()[2];
}

/// Exports what brings a port up to date that is nothing but a slave by Modbus RTU.
macro_rules! export_slaves {
    ($($symbol:literal = $family:ident $number:literal;)*) => {
        $(const _: () = {
            #[allow(unsafe_code, reason = "each name occurs once, and no other symbol begins like it")]
            #[unsafe(export_name = $symbol)]
            extern "C" fn exported(map: &mut Map, now_us: u32) {
                let mut hal = Lines::new(map.hal);
                advance_slave::<{ Ports::$family as u8 }, $number>(&mut Stored(map), &mut hal, now_us);
            }
        };)*

        /// Their names for a linker.
        #[cfg(test)]
        const SLAVES: &[&str] = &[$($symbol),*];
    };
}

export_slaves! {
    "rungc_advance_slave_inovance_0" = Inovance 0;
    "rungc_advance_slave_inovance_1" = Inovance 1;
    "rungc_advance_slave_inovance_2" = Inovance 2;
    "rungc_advance_slave_inovance_3" = Inovance 3;
    "rungc_advance_slave_l01s_2" = L01s 2;
    "rungc_advance_slave_l01s_3" = L01s 3;
    "rungc_advance_slave_hm_0" = Hm 0;
    "rungc_advance_slave_hm_1" = Hm 1;
}

/// A program holds ports as words of 32 bits.
const _: () = assert!(
    align_of::<Port>() <= 4
        && size_of::<Status>().is_multiple_of(4)
        && size_of::<Progress>().is_multiple_of(4)
);

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codecs_profiles_and_ports_are_exported_by_their_names() {
        let names = codec::ALL.iter().map(|codec| codec.name());
        let exported = CODECS.iter().map(|name| &name["rungc_codec_".len()..]);
        assert!(exported.eq(names));
        let names = modbus::ALL.iter().map(|profile| profile.name);
        let exported = PROFILES.iter().map(|name| &name["rungc_modbus_".len()..]);
        assert!(exported.eq(names));
        let ports = Ports::families().iter().flat_map(|&family| {
            let numbers = family.all().iter().map(|wiring| wiring.number);
            numbers.map(move |number| std::format!("rungc_port_{}_{number}", family.name()))
        });
        assert!(ports.eq(WIRINGS.iter().copied()));
        let slaves = Ports::families().iter().flat_map(|&family| {
            let ports = family.all().iter().filter(|port| port.may_be_slave_alone());
            ports.map(move |port| {
                std::format!("rungc_advance_slave_{}_{}", family.name(), port.number)
            })
        });
        assert!(slaves.eq(SLAVES.iter().copied()));
    }
}
