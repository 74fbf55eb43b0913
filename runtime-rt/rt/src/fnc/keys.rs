//! Keys and switches: FNC 52 and 70–72, h1u-h2u-programming §4.3.6 and §4.3.8. What its lost figures showed is as in
//! the FX family.

use crate::cx::Cx;
use crate::fault::Done;
use crate::special::{M_COMPLETE, M_HKY_HEX};

/// Milliseconds for which MTR selects a column: longer than the filter of the inputs.
pub const MTR_MS: i32 = 20;
/// Milliseconds for which DSW selects a column.
const DSW_MS: i32 = 100;

/// Appends a decimal digit to the number at operand `i`, which keeps its last 4 digits, or 8 in the 32-bit form.
fn append(cx: &mut Cx, i: usize, digit: i32) -> Done {
    let most = if cx.wide() { 100_000_000 } else { 10_000 };
    let number = i64::from(cx.read(i)?.max(0)) % i64::from(most / 10) * 10 + i64::from(digit);
    cx.write(i, number as i32)
}

/// Finds the key that counts: the one held before while it is held, else the lowest that was not pressed before. Words
/// 0 and 1 of the memory keep the key plus one, and what was pressed. Returns the key held and whether it is new.
fn key_of(cx: &mut Cx, pressed: u32) -> Option<(i32, bool)> {
    let state = cx.state();
    let before = state.0[1] as u32;
    state.0[1] = pressed as i32;
    let held = state.0[0] - 1;
    if (0..16).contains(&held) && pressed >> held & 1 == 1 {
        return Some((held, false));
    }
    let fresh = pressed & !before;
    let key = if fresh == 0 {
        None
    } else {
        Some(fresh.trailing_zeros() as i32)
    };
    state.0[0] = key.map_or(0, |key| key + 1);
    key.map(|key| (key, true))
}

/// TKY S D1 D2 (FNC 70): S…S+9 are the keys 0 to 9. A newly pressed one is appended to D1 and switches its bit of
/// D2…D2+9 on, until another one does (FX1S/FX1N/FX2N programming manual II §5.8.1); D2+10 signals that one is pressed.
/// Memory: see `key_of`; whether the last scan drove it.
pub fn tky(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(2);
    if !cx.drive() {
        if driven {
            cx.state().0 = [0; 8];
            cx.set_bits(2, 0, 11, 0)?;
        }
        return Ok(());
    }
    let pressed = cx.bits(0, 0, 10)?;
    cx.read(1)?;
    cx.check_bits(2, 11)?;
    if let Some((digit, true)) = key_of(cx, pressed) {
        append(cx, 1, digit)?;
        cx.set_bits(2, 0, 10, 1 << digit)?;
    }
    cx.set_bit(2, 10, pressed != 0)
}

/// HKY S D1 D2 D3 (FNC 71): scans 16 keys, those of row r in column c being number 4c+r, by the outputs D1…D1+3 (two
/// scans each) and the inputs S…S+3. 0 to 9 are appended to D2; A to F switch D3…D3+5 on, until another one does; D3+6
/// and D3+7 signal that one of A to F, or of 0 to 9, is pressed. With M8167 all are hexadecimal digits. M8029 signals
/// that all keys have been read.
///
/// Memory: see `key_of`; the scan of the eight; the keys read so far; whether the last scan drove it.
pub fn hky(cx: &mut Cx) -> Done {
    let driven = cx.was_driven(4);
    if !cx.drive() {
        if driven {
            cx.state().0 = [0; 8];
            cx.set_bits(1, 0, 4, 0)?;
            cx.set_bits(3, 0, 8, 0)?;
        }
        return Ok(());
    }
    let row = cx.bits(0, 0, 4)?;
    cx.read(2)?;
    cx.check_bits(1, 4)?;
    cx.check_bits(3, 8)?;
    let [_, _, scan, mut read, ..] = cx.state().0;
    let column = (scan / 2) & 3;
    if scan % 2 == 1 {
        read = read & !(15 << (4 * column)) | (row as i32) << (4 * column);
    }
    let all_read = scan == 7;
    let state = cx.state();
    state.0[2] = (scan + 1) % 8;
    state.0[3] = read;
    cx.set_bits(1, 0, 4, 1 << column)?;
    cx.set_special(M_COMPLETE, all_read);
    if all_read {
        take_hexadecimal_key(cx, read as u32)
    } else {
        Ok(())
    }
}

/// Executes HKY once all keys have been read.
fn take_hexadecimal_key(cx: &mut Cx, pressed: u32) -> Done {
    let key = key_of(cx, pressed);
    match key {
        Some((digit, true)) if cx.special(M_HKY_HEX) => {
            let number = cx.read_unsigned(2)? << 4 | digit as u32;
            cx.write(2, number as i32)?;
        }
        Some((digit @ 0..=9, true)) => append(cx, 2, digit)?,
        Some((letter, true)) => cx.set_bits(3, 0, 6, 1 << (letter - 10))?,
        _ => {}
    }
    cx.set_bit(3, 6, pressed >> 10 != 0)?;
    cx.set_bit(3, 7, pressed & 0x3ff != 0)
}

/// DSW S D1 D2 n (FNC 72): reads n groups of four decimal switches. The outputs D1…D1+3 select a digit for 100 ms each,
/// ones first; its bits come in at S…S+3, those of the second group at S+4…S+7. The numbers go to D2 and D2+1, and
/// M8029 is on for a scan.
///
/// Memory: the digit; milliseconds of it; the numbers so far; whether the last scan drove it.
pub fn dsw(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    let driven = cx.was_driven(4);
    if !cx.drive() {
        if driven {
            cx.state().0 = [0; 8];
            cx.set_bits(1, 0, 4, 0)?;
        }
        return Ok(());
    }
    let groups = cx.count(3, 1..=2)?;
    let inputs = cx.bits(0, 0, 4 * groups)? as i32;
    cx.check_bits(1, 4)?;
    cx.check_words(2, groups)?;
    let [digit, ms, first, second, ..] = cx.state().0;
    let ms = if driven { ms.saturating_add(dt) } else { 0 };
    let over = ms >= DSW_MS;
    let digit = digit & 3;
    let (mut sums, mut next) = ([first, second], (digit, ms));
    if over {
        let weight = [1, 10, 100, 1000].get(digit as usize).copied().unwrap_or(0);
        sums = [
            first + (inputs & 15) * weight,
            second + (inputs >> 4) * weight,
        ];
        next = ((digit + 1) % 4, 0);
    }
    let complete = over && digit == 3;
    cx.set_special(M_COMPLETE, complete);
    if complete {
        for (group, sum) in (0..groups).zip(sums) {
            cx.set_word(2, group, sum as i16)?;
        }
        sums = [0; 2];
    }
    let state = cx.state();
    (state.0[0], state.0[1]) = next;
    [state.0[2], state.0[3]] = sums;
    cx.set_bits(1, 0, 4, 1 << next.0)
}

/// MTR S D1 D2 n (FNC 52): reads n columns of eight switches. The outputs D1… select a column for 20 ms each; the
/// inputs S…S+7 go to the bits from D2 on, each column ten devices (of Y: eight) after the one before. M8029 is on for
/// a scan once all are read.
///
/// Memory: the column; milliseconds of it; whether the last scan drove it.
pub fn mtr(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    let driven = cx.was_driven(2);
    if !cx.drive() {
        if driven {
            cx.state().0 = [0; 8];
            let columns = cx.count(3, 2..=8)?;
            cx.set_bits(1, 0, columns, 0)?;
        }
        return Ok(());
    }
    let columns = cx.count(3, 2..=8)?;
    let inputs = cx.bits(0, 0, 8)?;
    let stride = if cx.is_octal(2) { 8 } else { 10 };
    cx.check_bits(1, columns)?;
    cx.bit(2, stride * (columns - 1) + 7)?;
    let [column, ms, ..] = cx.state().0;
    let ms = if driven { ms.saturating_add(dt) } else { 0 };
    let column = column % columns;
    let over = ms >= MTR_MS;
    let next = if over {
        ((column + 1) % columns, 0)
    } else {
        (column, ms)
    };
    if over {
        cx.set_bits(2, stride * column, 8, inputs)?;
    }
    let state = cx.state();
    (state.0[0], state.0[1]) = next;
    cx.set_special(M_COMPLETE, over && next.0 == 0);
    cx.set_bits(1, 0, columns, 1 << next.0)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, relay};
    use crate::{Class, Operand, Plc, RtFn, d, k};

    fn input(n: i32) -> Operand {
        d(Class::X, n)
    }

    fn output(n: i32) -> Operand {
        d(Class::Y, n)
    }

    fn press(plc: &mut Double, n: u32, on: bool) {
        plc.set_bit(Class::X, n, on);
    }

    #[test]
    fn tky_takes_keys_in_the_order_of_pressing() {
        let ops = [input(0), d(Class::D, 0), relay(0)];
        let mut plc = Double::new();
        for (key, on, number, bits) in [
            (2, true, 2, "00100000001"),
            (7, true, 2, "00100000001"),
            (2, false, 2, "00100000001"),
            (7, false, 2, "00100000000"),
            (0, true, 20, "10000000001"),
            (0, false, 20, "10000000000"),
            (9, true, 209, "00000000011"),
        ] {
            press(&mut plc, key, on);
            plc.scan(10, true, RtFn::Tky, &ops).unwrap();
            assert_eq!(
                (plc.d(0, 1), plc.m(0, 11).as_str()),
                ([number].to_vec(), bits)
            );
        }
        plc.scan(10, false, RtFn::Tky, &ops).unwrap();
        assert_eq!(
            (plc.d(0, 1), plc.m(0, 11).as_str()),
            ([209].to_vec(), "00000000000")
        );
    }

    #[test]
    fn numbers_keep_their_last_digits() {
        let mut plc = Double::new().with_d(0, &[9876]);
        press(&mut plc, 5, true);
        plc.scan(10, true, RtFn::Tky, &[input(0), d(Class::D, 0), relay(0)])
            .unwrap();
        assert_eq!(plc.d(0, 1), [8765]);
        let mut plc = Double::wide();
        plc.set_dd(0, 87_654_321);
        press(&mut plc, 0, true);
        plc.scan(10, true, RtFn::Tky, &[input(0), d(Class::D, 0), relay(0)])
            .unwrap();
        assert_eq!(plc.dd(0), 76_543_210);
    }

    /// Eight scans of HKY with a key of the matrix pressed, or none.
    fn hky(plc: &mut Double, key: Option<u32>) {
        for scan in 1..=8 {
            plc.scan(
                10,
                true,
                RtFn::Hky,
                &[input(0), output(0), d(Class::D, 0), relay(0)],
            )
            .unwrap();
            for row in 0..4 {
                let on = key
                    .is_some_and(|key| key % 4 == row && plc.bit(Class::Y, key / 4) == Some(true));
                press(plc, row, on);
            }
            assert_eq!(plc.bit(Class::M, 8029), Some(scan == 8));
        }
    }

    #[test]
    fn hky_reads_the_matrix() {
        let mut plc = Double::new();
        hky(&mut plc, Some(9));
        hky(&mut plc, None);
        hky(&mut plc, Some(4));
        assert_eq!(
            (plc.d(0, 1), plc.m(0, 8).as_str()),
            ([94].to_vec(), "00000001")
        );
        hky(&mut plc, None);
        hky(&mut plc, Some(11));
        assert_eq!(
            (plc.d(0, 1), plc.m(0, 8).as_str()),
            ([94].to_vec(), "01000010")
        );
        hky(&mut plc, None);
        assert_eq!(plc.m(0, 8), "01000000");
        plc.set_m(8167, "1");
        hky(&mut plc, Some(15));
        assert_eq!(plc.d(0, 1), [94 << 4 | 15]);
    }

    #[test]
    fn dsw_reads_both_groups() {
        let ops = [input(0), output(0), d(Class::D, 0), k(2)];
        let mut plc = Double::new();
        for scan in 0..=41 {
            plc.scan(10, true, RtFn::Dsw, &ops).unwrap();
            for digit in 0..4u32 {
                if plc.bit(Class::Y, digit) == Some(true) {
                    let inputs = (digit + 1) | (9 - digit) << 4;
                    (0..8).for_each(|n| press(&mut plc, n, inputs >> n & 1 == 1));
                }
            }
            if plc.bit(Class::M, 8029) == Some(true) {
                assert!(scan == 40, "{scan}");
            }
        }
        assert_eq!(plc.d(0, 2), [4321, 6789]);
    }

    #[test]
    fn mtr_reads_columns() {
        let ops = [input(0), output(0), relay(30), k(2)];
        let mut plc = Double::new();
        let mut complete = 0;
        for _ in 0..10 {
            plc.scan(10, true, RtFn::Mtr, &ops).unwrap();
            let second = plc.bit(Class::Y, 1) == Some(true);
            (0..8).for_each(|n| press(&mut plc, n, (n == 0) != second));
            complete += u32::from(plc.bit(Class::M, 8029) == Some(true));
        }
        assert_eq!(
            (plc.m(30, 8).as_str(), plc.m(40, 8).as_str()),
            ("10000000", "01111111")
        );
        assert_eq!(complete, 2);
    }
}
