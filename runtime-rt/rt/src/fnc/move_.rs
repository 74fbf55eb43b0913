//! Moves and conversions between binary and BCD: FNC 12–19 and 147, h1u-h2u-programming §4.3.2, hm-motion-controller
//! §5.4.

use super::digits::{from_bcd, from_nibbles, to_bcd};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::special::{M_BMOV_REVERSE, M_SMOV_HEX, M_XCH_BYTES};

/// Largest value that the form's BCD holds: 4 digits, or 8.
fn bcd_limit(cx: &Cx) -> i32 {
    if cx.wide() { 99_999_999 } else { 9999 }
}

/// SMOV S m1 m2 D n (FNC 13): m2 digits of S downwards from digit m1 replace those of D downwards from digit n; digits
/// count from 1 at the low end. Decimal digits of the values, or with M8168 their groups of four bits.
pub fn smov(cx: &mut Cx) -> Done {
    let (m1, m2) = (cx.count(1, 1..=4)?, cx.count(2, 1..=4)?);
    let n = cx.count(4, 1..=4)?;
    if m2 > m1 || m2 > n {
        return Err(Fault::VALUE);
    }
    let hex = cx.special(M_SMOV_HEX);
    let digits = |value: i32| match hex {
        true => Ok(u32::from(value as u16)),
        false if (0..=9999).contains(&value) => Ok(to_bcd(value as u32)),
        false => Err(Fault::VALUE),
    };
    let (source, old) = (digits(cx.read(0)?)?, digits(cx.read(3)?)?);
    let mask = (1u32 << (4 * m2)) - 1;
    let moved = source >> (4 * (m1 - m2)) & mask;
    let place = 4 * (n - m2);
    let new = old & !(mask << place) | moved << place;
    cx.write(3, if hex { new } else { from_nibbles(new) } as i32)
}

/// Copies `n` words from operand `from` to operand `to`, also if they overlap.
fn copy(cx: &mut Cx, from: usize, to: usize, n: i32) -> Done {
    cx.check_words(from, n)?;
    cx.check_words(to, n)?;
    let backwards = cx.begins_behind(from, to);
    for k in 0..n {
        let k = if backwards { n - 1 - k } else { k };
        let value = cx.word(from, k)?;
        cx.set_word(to, k, value)?;
    }
    Ok(())
}

/// BMOV S D n (FNC 15): copies n words from S to D, or with M8024 from D to S.
pub fn bmov(cx: &mut Cx) -> Done {
    let n = cx.count(2, 1..=512)?;
    if cx.special(M_BMOV_REVERSE) {
        copy(cx, 1, 0, n)
    } else {
        copy(cx, 0, 1, n)
    }
}

/// BMOV of HM: always from S to D.
pub fn bmov_forward(cx: &mut Cx) -> Done {
    let n = cx.count(2, 1..=512)?;
    copy(cx, 0, 1, n)
}

/// FMOV S D n (FNC 16): writes S to n words, or n pairs, from D on.
pub fn fmov(cx: &mut Cx) -> Done {
    let n = cx.count(2, 1..=512)?;
    let value = cx.read(0)?;
    cx.check_elems(1, n)?;
    (0..n).try_for_each(|k| cx.set_elem(1, k, value))
}

/// The bytes of each word of a value exchanged.
fn swapped(cx: &Cx, value: i32) -> i32 {
    let value = cx.unsigned(value);
    ((value & 0x00ff_00ff) << 8 | value >> 8 & 0x00ff_00ff) as i32
}

/// Exchanges operands 0 and 1.
fn exchange(cx: &mut Cx) -> Done {
    let (a, b) = (cx.read(0)?, cx.read(1)?);
    cx.write(0, b)?;
    cx.write(1, a)
}

/// XCH D1 D2 (FNC 17): exchanges D1 and D2; with M8160 and D1 the same as D2 the bytes of each word instead.
pub fn xch(cx: &mut Cx) -> Done {
    if cx.special(M_XCH_BYTES) && cx.same(0, 1) {
        swap(cx)
    } else {
        exchange(cx)
    }
}

/// XCH of HM, which has no byte mode.
pub fn xch_words(cx: &mut Cx) -> Done {
    exchange(cx)
}

/// SWAP S (FNC 147): exchanges the bytes of each word.
pub fn swap(cx: &mut Cx) -> Done {
    let value = swapped(cx, cx.read(0)?);
    cx.write(0, value)
}

/// BCD S D (FNC 18): packs the decimal digits of S; a value without that many digits is an error.
pub fn bcd(cx: &mut Cx) -> Done {
    let value = cx.count(0, 0..=bcd_limit(cx))?;
    cx.write(1, to_bcd(value as u32) as i32)
}

/// BCD of HM: a value too large or below 0 becomes the largest or 0.
pub fn bcd_clamped(cx: &mut Cx) -> Done {
    let value = cx.read(0)?.clamp(0, bcd_limit(cx));
    cx.write(1, to_bcd(value as u32) as i32)
}

/// BIN S D (FNC 19): the number whose decimal digits S packs; a digit above 9 is an error.
pub fn bin(cx: &mut Cx) -> Done {
    let value = from_bcd(cx.read_unsigned(0)?).ok_or(Fault::VALUE)?;
    cx.write(1, value as i32)
}

/// BIN of HM: digits above 9 give a wrong result, no error.
pub fn bin_unchecked(cx: &mut Cx) -> Done {
    let value = from_nibbles(cx.read_unsigned(0)?);
    cx.write(1, value as i32)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Plc, RtFn, d, k, kn};
    use proptest::prelude::*;

    #[test]
    fn smov_moves_decimal_and_hexadecimal_digits() {
        let ops = [reg(0), k(3), k(2), reg(1), k(4)];
        let mut plc = Double::new().with_d(0, &[9876, 1234]);
        plc.call(RtFn::Smov, &ops).unwrap();
        assert_eq!(plc.d(1, 1), [8734]);
        plc.set_d(0, &[0x9abc, 0x1234]);
        plc.set_bit(Class::M, 8168, true);
        plc.call(RtFn::Smov, &ops).unwrap();
        assert_eq!(plc.d(1, 1), [0xab34_u16 as i16]);
    }

    #[test]
    fn smov_refuses_what_has_no_four_digits() {
        let mut plc = Double::new().with_d(0, &[-1, 1234]);
        assert_eq!(
            plc.call(RtFn::Smov, &[reg(0), k(3), k(2), reg(1), k(4)]),
            Err(Fault::VALUE)
        );
        assert_eq!(
            plc.call(RtFn::Smov, &[reg(1), k(1), k(2), reg(1), k(4)]),
            Err(Fault::VALUE)
        );
        assert_eq!(
            plc.call(RtFn::Smov, &[reg(1), k(3), k(3), reg(1), k(2)]),
            Err(Fault::VALUE)
        );
        assert_eq!(plc.d(1, 1), [1234]);
    }

    #[test]
    fn bmov_copies_overlapping_blocks_both_ways() {
        let mut plc = Double::new().with_d(0, &[1, 2, 3, 4]);
        plc.call(RtFn::Bmov, &[reg(0), reg(1), k(3)]).unwrap();
        assert_eq!(plc.d(0, 4), [1, 1, 2, 3]);
        plc.call(RtFn::Bmov, &[reg(1), reg(0), k(3)]).unwrap();
        assert_eq!(plc.d(0, 4), [1, 2, 3, 3]);
        plc.set_bit(Class::M, 8024, true);
        plc.call(RtFn::Bmov, &[reg(0), reg(10), k(4)]).unwrap();
        assert_eq!(plc.d(0, 4), [0; 4]);
    }

    #[test]
    fn bmov_of_groups_steps_by_the_group() {
        let mut plc = Double::new();
        plc.set_m(0, "10010110");
        plc.call(RtFn::Bmov, &[kn(1, Class::M, 0), kn(1, Class::M, 20), k(2)])
            .unwrap();
        assert_eq!(plc.m(20, 9), "100101100");
    }

    #[test]
    fn a_block_that_leaves_the_range_changes_nothing() {
        let mut plc = Double::new().with_d(0, &[5; 8]);
        assert_eq!(
            plc.call(RtFn::Bmov, &[reg(0), reg(8510), k(3)]),
            Err(Fault::DEVICE)
        );
        assert_eq!(
            plc.call(RtFn::Fmov, &[k(1), reg(8510), k(3)]),
            Err(Fault::DEVICE)
        );
        assert_eq!(plc.d(8510, 2), [0, 0]);
        assert_eq!(
            plc.call(RtFn::Bmov, &[reg(0), reg(10), k(513)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn fmov_fills_pairs_in_the_wide_form() {
        let mut plc = Double::wide();
        plc.call(RtFn::Fmov, &[k(70_000), reg(0), k(2)]).unwrap();
        assert_eq!((plc.dd(0), plc.dd(2), plc.dd(4)), (70_000, 70_000, 0));
        plc.call(RtFn::Fmov, &[k(-7), d(Class::C, 200), k(2)])
            .unwrap();
        assert_eq!(plc.counter32(201), Some(-7));
        assert_eq!(plc.counter32(202), Some(0));
    }

    #[test]
    fn xch_exchanges_words_or_bytes() {
        let mut plc = Double::new().with_d(0, &[0x1234, 0x5678]);
        plc.call(RtFn::Xch, &[reg(0), reg(1)]).unwrap();
        assert_eq!(plc.d(0, 2), [0x5678, 0x1234]);
        plc.set_bit(Class::M, 8160, true);
        plc.call(RtFn::Xch, &[reg(0), reg(0)]).unwrap();
        plc.call(RtFn::XchWords, &[reg(1), reg(1)]).unwrap();
        assert_eq!(plc.d(0, 2), [0x7856, 0x1234]);
    }

    #[test]
    fn bcd_of_too_large_a_number() {
        let mut plc = Double::new().with_d(0, &[10_000, 55]);
        assert_eq!(plc.call(RtFn::Bcd, &[reg(0), reg(1)]), Err(Fault::VALUE));
        assert_eq!(plc.d(1, 1), [55]);
        plc.call(RtFn::BcdClamped, &[reg(0), reg(1)]).unwrap();
        assert_eq!(plc.d(1, 1), [0x9999_u16 as i16]);
        plc.call(RtFn::BcdClamped, &[k(-1), reg(1)]).unwrap();
        assert_eq!(plc.d(1, 1), [0]);
    }

    #[test]
    fn bin_of_a_hexadecimal_digit() {
        let mut plc = Double::new().with_d(0, &[0x1a, 55]);
        assert_eq!(plc.call(RtFn::Bin, &[reg(0), reg(1)]), Err(Fault::VALUE));
        assert_eq!(plc.d(1, 1), [55]);
        plc.call(RtFn::BinUnchecked, &[reg(0), reg(1)]).unwrap();
        assert_eq!(plc.d(1, 1), [20]);
    }

    proptest! {
        #[test]
        fn bin_undoes_bcd(value in 0i32..=9999, long in 0i32..=99_999_999) {
            let mut plc = Double::new().with_d(0, &[value]);
            plc.call(RtFn::Bcd, &[reg(0), reg(2)]).unwrap();
            plc.call(RtFn::Bin, &[reg(2), reg(4)]).unwrap();
            prop_assert_eq!(i32::from(plc.d(4, 1)[0]), value);
            let mut plc = Double::wide();
            plc.set_dd(0, long);
            plc.call(RtFn::Bcd, &[reg(0), reg(2)]).unwrap();
            plc.call(RtFn::Bin, &[reg(2), reg(4)]).unwrap();
            prop_assert_eq!(plc.dd(4), long);
        }

        #[test]
        fn swap_exchanges_the_bytes_of_each_word(value: i32) {
            let mut plc = Double::wide();
            plc.set_dd(0, value);
            plc.call(RtFn::Swap, &[reg(0)]).unwrap();
            let [a, b, c, d] = value.to_le_bytes();
            prop_assert_eq!(plc.dd(0).to_le_bytes(), [b, a, d, c]);
        }
    }
}
