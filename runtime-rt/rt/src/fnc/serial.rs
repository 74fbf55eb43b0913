//! Characters and check codes for serial data: FNC 81–84 and 188, h1u-h2u-programming §4.3.9, hm-motion-controller
//! §5.4; the instructions of free protocols: RS, RS2, UINIT, USEND, URCV, which leave what they want in the
//! [`Port`](crate::Port).

use super::digits::{hex_digit, hex_value};
use crate::comm::modbus::{CRC_START, crc_step};
use crate::comm::{Protocol, Transfer, free};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::{Operand, OperandKind};
use crate::plc::{Class, Plc};
use crate::special::{M_BYTE_MODE, Register};

/// PRUN S D (FNC 81): copies a group of bits, counting both in octal rows: bits 8 and 9 of each ten of M are left out.
pub fn prun(cx: &mut Cx) -> Done {
    let (s, d) = match cx.ops {
        [s, d, ..] if s.kind == OperandKind::Nibbles && d.kind == OperandKind::Nibbles => (*s, *d),
        _ => return Err(Fault::VALUE),
    };
    let most = if cx.wide() { 8 } else { 4 };
    let count = 4 * i32::from(s.digits.min(d.digits).min(most));
    for n in 0..count {
        let place = octal_place(d, n)?;
        cx.plc.bit(d.class, place).ok_or(Fault::DEVICE)?;
    }
    let mut bits = 0u32;
    for n in 0..count {
        let on = cx
            .plc
            .bit(s.class, octal_place(s, n)?)
            .ok_or(Fault::DEVICE)?;
        bits |= u32::from(on) << n;
    }
    for n in 0..count {
        let place = octal_place(d, n)?;
        cx.plc
            .set_bit(d.class, place, bits >> n & 1 == 1)
            .ok_or(Fault::DEVICE)?;
    }
    Ok(())
}

/// Number of bit `n` of a group in octal rows.
fn octal_place(group: Operand, n: i32) -> Result<u32, Fault> {
    let offset = match group.class {
        Class::X | Class::Y => n,
        _ => n / 8 * 10 + n % 8,
    };
    let place = group.value.checked_add(offset).ok_or(Fault::DEVICE)?;
    u32::try_from(place).map_err(|_| Fault::DEVICE)
}

/// Writes the lowest n hexadecimal digits of S as characters to D, the highest first.
fn write_digits(cx: &mut Cx, byte_mode: bool) -> Done {
    let n = cx.count(2, 1..=256)?;
    cx.check_bytes(1, n, byte_mode)?;
    for character in 0..n {
        let digit = n - 1 - character;
        // A constant is one word: the digits above it are 0.
        let word = if cx.is_constant(0) && digit >= 4 {
            0
        } else {
            cx.word(0, digit / 4)?
        };
        let code = hex_digit(word as u16 >> (4 * (digit % 4)));
        cx.set_byte(1, character, byte_mode, code)?;
    }
    Ok(())
}

/// ASCI S D n (FNC 82): the lowest n hexadecimal digits of S as characters, the highest first; two a word, or one with
/// M8161.
pub fn asci(cx: &mut Cx) -> Done {
    let byte_mode = cx.special(M_BYTE_MODE);
    write_digits(cx, byte_mode)
}

/// ASCI of HM: always one character a word.
pub fn asci_bytes(cx: &mut Cx) -> Done {
    write_digits(cx, true)
}

/// Packs the n characters of S as hexadecimal digits into D, four a word, the last character lowest.
fn read_digits(cx: &mut Cx, byte_mode: bool, value: fn(u8) -> Option<u16>) -> Done {
    let n = cx.count(2, 1..=256)?;
    let digit = |cx: &Cx, n: i32| value(cx.byte(0, n, byte_mode)?).ok_or(Fault::VALUE);
    (0..n).try_for_each(|n| digit(cx, n).map(drop))?;
    let words = (n + 3) / 4;
    cx.check_words(1, words)?;
    for word in 0..words {
        let mut packed = 0;
        for nibble in 0..4.min(n - 4 * word) {
            packed |= digit(cx, n - 1 - 4 * word - nibble)? << (4 * nibble);
        }
        cx.set_word(1, word, packed as i16)?;
    }
    Ok(())
}

/// HEX S D n (FNC 83): the hexadecimal digits that n characters are; two a word, or one with M8161. Another character
/// is an error.
pub fn hex(cx: &mut Cx) -> Done {
    let byte_mode = cx.special(M_BYTE_MODE);
    read_digits(cx, byte_mode, hex_value)
}

/// HEX of HM: always one character a word; others than digits give a wrong result, no error.
pub fn hex_bytes(cx: &mut Cx) -> Done {
    read_digits(cx, true, |code| {
        Some(hex_value(code).unwrap_or(u16::from(code) & 15))
    })
}

/// CCD S D n (FNC 84): D takes the sum of n bytes, D+1 their exclusive or; two bytes a word, or one with M8161.
pub fn ccd(cx: &mut Cx) -> Done {
    let byte_mode = cx.special(M_BYTE_MODE);
    let n = cx.count(2, 1..=256)?;
    let (mut sum, mut parity) = (0u16, 0);
    for k in 0..n {
        let byte = cx.byte(0, k, byte_mode)?;
        sum = sum.wrapping_add(byte.into());
        parity ^= byte;
    }
    cx.check_words(1, 2)?;
    cx.set_word(1, 0, sum as i16)?;
    cx.set_word(1, 1, parity.into())
}

/// CRC S D n (FNC 188): the CRC-16 (polynomial HA001, first value HFFFF) of n bytes, two a word, goes to D; with M8161
/// one a word, and the two bytes of the result to D and D+1. A group of bits has four digits (FX3 programming manual
/// §24.4).
pub fn crc(cx: &mut Cx) -> Done {
    if [0, 1].iter().any(|&i| cx.is_short_group(i)) {
        return Err(Fault::DEVICE);
    }
    let byte_mode = cx.special(M_BYTE_MODE);
    let n = cx.count(2, 1..=256)?;
    let crc = (0..n).try_fold(CRC_START, |crc, k| {
        Ok(crc_step(crc, cx.byte(0, k, byte_mode)?))
    })?;
    if !byte_mode {
        return cx.set_word(1, 0, crc as i16);
    }
    cx.check_words(1, 2)?;
    cx.set_word(1, 0, (crc & 255) as i16)?;
    cx.set_word(1, 1, (crc >> 8) as i16)
}

/// RS S m D n (FNC 80): sends m bytes from S on at the program's request and receives n to D, on the port of RS. Where
/// that is a Modbus master, RS is MODBUS (h1u-h2u-programming §5.7.1).
pub fn rs(cx: &mut Cx) -> Done {
    let number = cx.plc.ports().of_rs();
    let port = cx.plc.port(number);
    match port.is_some_and(|port| port.status.protocol.is_master()) {
        true => super::modbus::modbus(cx),
        false => transfer(cx, number),
    }
}

/// RS2 S m D n n1 (FNC 87): the same on port n1.
pub fn rs2(cx: &mut Cx) -> Done {
    match cx.named_port(4)? {
        Some(number) => transfer(cx, number),
        None => Ok(()),
    }
}

/// Returns true if a word always contains two characters: RS2 of FX3 has no mode of eight bits (FX data communication
/// manual, part F, §8.2.3).
fn packs(cx: &Cx, number: u8) -> bool {
    let wiring = cx.plc.ports().get(number);
    wiring.is_some_and(|wiring| wiring.chosen(cx.plc).envelope.is_some()) && cx.plc.ports().is_fx3()
}

/// Sends and receives by a free protocol on a port, as long as it is driven.
fn transfer(cx: &mut Cx, number: u8) -> Done {
    let owner = cx.site.step + 1;
    let Some(port) = cx.plc.port(number) else {
        return Ok(());
    };
    let status = *port.status;
    let owned_by = match port.progress {
        Some(progress) => &mut progress.free.owner,
        None => &mut 0,
    };
    if !cx.site.drive {
        if *owned_by == owner {
            *owned_by = 0;
        }
        return Ok(());
    }
    if *owned_by != 0 && *owned_by != owner {
        return Ok(());
    }
    if status.protocol != Protocol::Free {
        if status.bound || !cx.plc.sys().first_scan {
            cx.note_other_protocol(number);
        }
        return Ok(());
    }
    let one_a_word = cx.special(M_BYTE_MODE) && !packs(cx, number);
    let longest = cx.plc.ports().longest_transfer();
    let send = cx.count(1, 0..=longest)?;
    let receive = cx.count(3, 0..=longest)?;
    cx.check_bytes(0, send, one_a_word)?;
    cx.check_bytes(2, receive, one_a_word)?;
    let (source, target) = match cx.ops {
        [source, _, target, ..] => (*source, *target),
        _ => return Err(Fault::DEVICE),
    };
    if let Some(progress) = cx.plc.port(number).and_then(|port| port.progress) {
        progress.free.owner = owner;
        progress.free.transfer = Transfer {
            source: source.value as u32,
            target: target.value as u32,
            send: send as u16,
            receive: receive as u16,
            source_class: source.class as u8,
            target_class: target.class as u8,
            one_a_word,
        };
    }
    Ok(())
}

/// UINIT S1 S2 D1 D2 (hm-motion-controller §6.2): starts port D2 with protocol S1 and format S2; D1 is the first
/// register of its work area.
pub fn uinit(cx: &mut Cx) -> Done {
    let [protocol, format, area] = [cx.word(0, 0)?, cx.word(1, 0)?, cx.word(2, 0)?];
    let number = cx.named_port(3)?;
    let Some(port) = number.and_then(|number| cx.plc.port(number)) else {
        return Ok(());
    };
    port.status.uinit = [protocol as u16, format as u16, area as u16];
    port.status.protocol = Protocol::Off;
    if let Some(wiring) = number.and_then(|number| cx.plc.ports().get(number)) {
        let shown = wiring.uinit.map(Register::run::<3>).into_iter().flatten();
        for (register, word) in shown.zip([protocol, format, area]) {
            register.set(cx.plc, word as u16);
        }
    }
    const FREE: u16 = 5;
    if protocol as u16 >> 8 == FREE {
        free::check_area(cx.plc, area as u16 as u32);
    }
    Ok(())
}

/// USEND S1 S2 D (hm-motion-controller §6.5.2): sends the low bytes of S2 registers from number S1 on by port D.
pub fn usend(cx: &mut Cx) -> Done {
    work_area(cx, free::usend)
}

/// URCV S1 S2 D (hm-motion-controller §6.5.2): waits for S2 bytes on port D, one to each register from number S1 on.
pub fn urcv(cx: &mut Cx) -> Done {
    work_area(cx, free::urcv)
}

/// Leaves a request of a free protocol in the work area of the port.
fn work_area(cx: &mut Cx, request: fn(&mut dyn Plc, u32, u16, u16)) -> Done {
    let first = cx.read(0)?;
    let count = cx.count(1, 1..=255)?;
    let number = cx.named_port(2)?;
    let Some(port) = number.and_then(|number| cx.plc.port(number)) else {
        return Ok(());
    };
    let area = port.status.uinit[2].into();
    let first = u16::try_from(first).unwrap_or(u16::MAX);
    request(cx.plc, area, first, count as u16);
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Operand, Plc, RtFn, k, kn};
    use proptest::prelude::*;

    fn byte_mode(plc: &mut Double, on: bool) {
        plc.set_bit(Class::M, 8161, on);
    }

    #[test]
    fn prun_counts_in_octal() {
        let mut plc = Double::new();
        for n in [0, 7, 8, 14] {
            plc.set_bit(Class::X, n, true);
        }
        plc.set_m(8, "11");
        plc.call(RtFn::Prun, &[kn(4, Class::X, 0), kn(4, Class::M, 0)])
            .unwrap();
        assert_eq!(plc.m(0, 18), "100000011110000010");
        plc.call(RtFn::Prun, &[kn(4, Class::M, 0), kn(4, Class::Y, 0)])
            .unwrap();
        let outputs: std::vec::Vec<u32> = (0..32)
            .filter(|&n| plc.bit(Class::Y, n) == Some(true))
            .collect();
        assert_eq!(outputs, [0, 7, 8, 14]);
        assert_eq!(plc.call(RtFn::Prun, &[reg(0), reg(1)]), Err(Fault::VALUE));
    }

    #[test]
    fn digits_become_characters() {
        let mut plc = Double::new()
            .with_d(0, &[0x0abc, 0x1234])
            .with_d(10, &[-1; 4]);
        plc.call(RtFn::Asci, &[reg(0), reg(10), k(5)]).unwrap();
        assert_eq!(plc.d(10, 4), [0x3034, 0x4241, 0xff43_u16 as i16, -1]);
        byte_mode(&mut plc, true);
        plc.call(RtFn::Asci, &[reg(0), reg(10), k(2)]).unwrap();
        assert_eq!(plc.d(10, 2), [0x42, 0x43]);
        byte_mode(&mut plc, false);
        plc.call(RtFn::AsciBytes, &[Operand::constant(0xf), reg(10), k(6)])
            .unwrap();
        assert_eq!(plc.d(10, 6), [0x30, 0x30, 0x30, 0x30, 0x30, 0x46]);
    }

    #[test]
    fn other_characters_are_errors() {
        let mut plc = Double::new().with_d(0, &[0x4730, 0x3231, 7]);
        assert_eq!(
            plc.call(RtFn::Hex, &[reg(0), reg(2), k(4)]),
            Err(Fault::VALUE)
        );
        assert_eq!(plc.d(2, 1), [7]);
        plc.call(RtFn::HexBytes, &[reg(0), reg(2), k(2)]).unwrap();
        assert_eq!(plc.d(2, 1), [1]);
    }

    #[test]
    fn check_codes() {
        let mut plc = Double::new().with_d(0, &[0x0301, 0x0000, 0x0100, 0x84, 0x0a]);
        plc.call(RtFn::Ccd, &[reg(0), reg(10), k(3)]).unwrap();
        assert_eq!(plc.d(10, 2), [4, 2]);
        // 01 03 00 00 00 01 has the CRC 84 0A.
        plc.call(RtFn::Crc, &[reg(0), reg(10), k(6)]).unwrap();
        assert_eq!(plc.d(10, 1), [0x0a84]);
        plc.set_d(0, &[1, 3, 0, 0, 0, 1]);
        byte_mode(&mut plc, true);
        plc.call(RtFn::Crc, &[reg(0), reg(10), k(6)]).unwrap();
        assert_eq!(plc.d(10, 2), [0x84, 0x0a]);
    }

    proptest! {
        #[test]
        fn hex_undoes_asci(words in prop::array::uniform3(any::<i16>()), n in 1i32..=12, bytes: bool) {
            let mut plc = Double::new().with_d(0, &words.map(i32::from));
            byte_mode(&mut plc, bytes);
            plc.call(RtFn::Asci, &[reg(0), reg(10), k(n)]).unwrap();
            plc.call(RtFn::Hex, &[reg(10), reg(30), k(n)]).unwrap();
            for digit in 0..12u32 {
                let of = |first: u32| plc.d(first + digit / 4, 1)[0] as u16 >> (digit % 4 * 4) & 15;
                prop_assert_eq!(of(30), if (digit as i32) < n { of(0) } else { 0 });
            }
        }
    }
}
