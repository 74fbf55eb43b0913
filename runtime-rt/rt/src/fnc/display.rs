//! Displays and printers: FNC 73–77, h1u-h2u-programming §4.3.8. What its lost figures showed is as in the FX family.

use super::digits::to_bcd;
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::OperandKind;
use crate::special::{M_BYTE_MODE, M_COMPLETE, M_PR_LONG};

/// A number that four digits can show.
fn shown(cx: &Cx, i: usize, offset: i32) -> Result<u32, Fault> {
    match cx.word(i, offset)? {
        value @ 0..=9999 => Ok(to_bcd(value as u32)),
        _ => Err(Fault::VALUE),
    }
}

/// One of the twelve scans of a display's refresh: a digit's data, lowest first, on four outputs from operand `i` on
/// (second group: from the eighth on), and in the second of its three scans its strobe, on the four outputs between.
/// `mode` is SEGL's n modulo 4: from 2 on data is inverted; odd ones invert the strobes against the data.
fn refresh(cx: &mut Cx, i: usize, scan: i32, mode: i32, groups: &[u32]) -> Done {
    let digit = scan / 3;
    let strobe = if scan % 3 == 1 { 1u32 << digit } else { 0 };
    let invert_data = mode & 2 != 0;
    let invert_strobe = invert_data != (mode & 1 != 0);
    for (offset, bcd) in [0, 8].into_iter().zip(groups) {
        let data = bcd >> (4 * digit) & 15;
        cx.set_bits(i, offset, 4, if invert_data { !data } else { data })?;
    }
    cx.set_bits(i, 4, 4, if invert_strobe { !strobe } else { strobe })
}

/// SEGL S D n (FNC 74): shows S, for n from 4 on also S+1, on displays of four digits; a refresh takes 12 scans, and
/// M8029 is on in the last. Memory: the scan; whether the last scan drove it.
pub fn segl(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(1);
    let n = cx.count(2, 0..=7)?;
    let outputs = if n < 4 { 8 } else { 12 };
    if !cx.drive() {
        cx.state().0[0] = 0;
        return if driven {
            cx.set_bits(1, 0, outputs, 0)
        } else {
            Ok(())
        };
    }
    let mut groups = [shown(cx, 0, 0)?, 0];
    if let ([_, second], true) = (&mut groups, n >= 4) {
        *second = shown(cx, 0, 1)?;
    }
    cx.check_bits(1, outputs)?;
    let scan = cx.state().0[0].rem_euclid(12);
    cx.state().0[0] = (scan + 1) % 12;
    refresh(
        cx,
        1,
        scan,
        n % 4,
        groups.get(..if n < 4 { 1 } else { 2 }).unwrap_or(&[]),
    )?;
    cx.set_special(M_COMPLETE, scan == 11);
    Ok(())
}

/// ARWS S D1 D2 n (FNC 75): edits the four digits of D1 with the keys S (down), S+1 (up), S+2 (to the lower digit), S+3
/// (to the higher), first the thousands, and shows it at D2 as SEGL does. Memory: the scan; the digit; the keys of the
/// last scan; whether it was driven.
pub fn arws(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(3);
    if !cx.drive() {
        return if driven {
            cx.set_bits(2, 0, 8, 0)
        } else {
            Ok(())
        };
    }
    if !driven {
        let state = cx.state();
        (state.0[0], state.0[1], state.0[2]) = (0, 3, 0);
    }
    let mode = cx.count(3, 0..=3)?;
    let keys = cx.bits(0, 0, 4)?;
    let mut bcd = shown(cx, 1, 0)?;
    cx.check_bits(2, 8)?;
    let [scan, digit, before, ..] = cx.state().0;
    let scan = scan.rem_euclid(12);
    let fresh = keys & !(before as u32);
    let place = 4 * (digit & 3);
    let old = bcd >> place & 15;
    let new = match fresh & 3 {
        1 => (old + 9) % 10,
        2 => (old + 1) % 10,
        _ => old,
    };
    bcd = bcd & !(15 << place) | new << place;
    let digit = match fresh >> 2 & 3 {
        1 => digit + 3,
        2 => digit + 1,
        _ => digit,
    };
    if new != old {
        cx.set_word(1, 0, super::digits::from_nibbles(bcd) as i16)?;
    }
    let state = cx.state();
    (state.0[0], state.0[1], state.0[2]) = ((scan + 1) % 12, digit % 4, keys as i32);
    refresh(cx, 2, scan, mode, &[bcd])
}

/// ASC S D (FNC 76): the first eight characters of the text, filled with spaces, go to four words from D on; with M8161
/// to eight.
pub fn asc(cx: &mut Cx) -> Done {
    let byte_mode = cx.special(M_BYTE_MODE);
    let index = match cx.ops.first() {
        Some(op) if op.kind == OperandKind::Text => op.value as u32,
        _ => return Err(Fault::VALUE),
    };
    cx.check_bytes(1, 8, byte_mode)?;
    for place in 0..8 {
        let code = cx
            .plc
            .text(index)
            .get(place as usize)
            .copied()
            .unwrap_or(b' ');
        cx.set_byte(1, place, byte_mode, code)?;
    }
    Ok(())
}

/// PR S D (FNC 77): sends the characters of S, two a word, on the outputs D…D+7, three scans each, with a strobe on the
/// ninth output in the middle one and the tenth on as long as it works. Eight characters, or with M8027 up to a 0, at
/// most 16; then M8029 signals the end. Memory: scans since it began; whether the last scan drove it.
pub fn pr(cx: &mut Cx) -> Done {
    print(cx, false)
}

/// PR S D (FNC 77) of H1U and H2U: as [`pr`], but M8029 signals the end of the text when the drive goes off. Memory in
/// addition: whether the text ended with M8027 on.
pub fn pr_signals_off(cx: &mut Cx) -> Done {
    print(cx, true)
}

fn print(cx: &mut Cx, signals_off: bool) -> Done {
    let driven = cx.was_driven(1);
    if !cx.drive() {
        let state = cx.state();
        let ended = state.0[2] != 0;
        (state.0[0], state.0[2]) = (0, 0);
        if driven {
            cx.set_bits(1, 0, 10, 0)?;
        }
        if ended {
            cx.set_special(M_COMPLETE, true);
        }
        return Ok(());
    }
    let long = cx.special(M_PR_LONG);
    let scan = cx.state().0[0];
    let (character, part) = (scan / 3, scan % 3);
    let code = if character < if long { 16 } else { 8 } {
        cx.byte(0, character, false)?
    } else {
        0
    };
    cx.check_bits(1, 10)?;
    if code == 0 {
        cx.set_bits(1, 8, 2, 0)?;
        if long && signals_off {
            cx.state().0[2] = 1;
        } else if long {
            cx.set_special(M_COMPLETE, true);
        }
        return Ok(());
    }
    cx.state().0[0] = scan + 1;
    if long {
        cx.set_special(M_COMPLETE, false);
    }
    let strobe = u32::from(part == 1);
    cx.set_bits(1, 0, 10, u32::from(code) | strobe << 8 | 1 << 9)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Operand, Plc, RtFn, d, k};
    use std::string::String;
    use std::vec::Vec;

    fn outputs(plc: &Double) -> u32 {
        (0..16)
            .map(|n| u32::from(plc.bit(Class::Y, n).unwrap()) << n)
            .sum()
    }

    #[test]
    fn segl_strobes_every_digit() {
        let mut plc = Double::new().with_d(0, &[2468, 9753]);
        let mut latched = [[0; 4]; 2];
        for scan in 0..12 {
            plc.scan(10, true, RtFn::Segl, &[reg(0), d(Class::Y, 0), k(4)])
                .unwrap();
            let y = outputs(&plc);
            for digit in 0..4 {
                if y >> (4 + digit) & 1 == 1 {
                    latched[0][3 - digit] = y & 15;
                    latched[1][3 - digit] = y >> 8 & 15;
                }
            }
            assert_eq!(plc.bit(Class::M, 8029), Some(scan == 11));
        }
        assert_eq!(latched, [[2, 4, 6, 8], [9, 7, 5, 3]]);
        plc.scan(10, false, RtFn::Segl, &[reg(0), d(Class::Y, 0), k(4)])
            .unwrap();
        assert_eq!(outputs(&plc), 0);
        assert_eq!(
            plc.scan(10, true, RtFn::Segl, &[k(10_000), d(Class::Y, 0), k(0)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn segl_inverts_as_n_says() {
        for (n, first, second) in [
            (0, 0x08, 0x18),
            (1, 0xf8, 0xe8),
            (2, 0xf7, 0xe7),
            (3, 0x07, 0x17),
        ] {
            let mut plc = Double::new();
            plc.scan(10, true, RtFn::Segl, &[k(8), d(Class::Y, 0), k(n)])
                .unwrap();
            assert_eq!(outputs(&plc), first);
            plc.scan(10, true, RtFn::Segl, &[k(8), d(Class::Y, 0), k(n)])
                .unwrap();
            assert_eq!(outputs(&plc), second);
        }
    }

    #[test]
    fn arws_edits_digits() {
        let mut plc = Double::new().with_d(0, &[50]);
        for (key, number) in [
            (0, 9050),
            (1, 50),
            (2, 50),
            (1, 150),
            (2, 150),
            (2, 150),
            (0, 159),
            (3, 159),
            (1, 169),
            (3, 169),
            (3, 169),
            (3, 169),
            (0, 168),
        ] {
            for on in [true, true, false] {
                plc.set_bit(Class::X, key, on);
                plc.scan(
                    10,
                    true,
                    RtFn::Arws,
                    &[d(Class::X, 0), reg(0), d(Class::Y, 0), k(0)],
                )
                .unwrap();
            }
            assert_eq!(plc.d(0, 1), [number]);
        }
    }

    #[test]
    fn asc_fills_with_spaces() {
        let mut plc = Double::new();
        plc.texts.push(b"AB".to_vec());
        plc.call(RtFn::Asc, &[Operand::text(0), reg(0)]).unwrap();
        assert_eq!(plc.d(0, 5), [0x4241, 0x2020, 0x2020, 0x2020, 0]);
        plc.set_m(8161, "1");
        plc.call(RtFn::Asc, &[Operand::text(0), reg(0)]).unwrap();
        assert_eq!(
            plc.d(0, 9),
            [0x41, 0x42, 0x20, 0x20, 0x20, 0x20, 0x20, 0x20, 0]
        );
    }

    #[test]
    fn pr_sends_with_strobe_and_busy() {
        let sent = |plc: &mut Double| -> Vec<String> {
            let mut text = String::new();
            let mut busy = 0;
            for _ in 0..60 {
                plc.scan(10, true, RtFn::Pr, &[reg(0), d(Class::Y, 0)])
                    .unwrap();
                let y = outputs(plc);
                if y >> 8 & 1 == 1 {
                    text.push(char::from(y as u8));
                }
                busy += y >> 9 & 1;
            }
            std::vec![text, std::format!("{busy}")]
        };
        let mut plc = Double::new().with_d(0, &[0x4241, 0x4443, 0x4645, 0x4847, 0x4a49, 0]);
        assert_eq!(sent(&mut plc), ["ABCDEFGH", "24"]);
        plc.scan(10, false, RtFn::Pr, &[reg(0), d(Class::Y, 0)])
            .unwrap();
        plc.set_m(8027, "1");
        assert_eq!(sent(&mut plc), ["ABCDEFGHIJ", "30"]);
        assert_eq!(plc.bit(Class::M, 8029), Some(true));
    }
}
