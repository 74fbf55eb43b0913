//! Moves: FNC 13–16, h1u-h2u-programming §4.3.2, hm-motion-controller §5.4.

use super::digits::{from_nibbles, to_bcd};
use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::special::{M_BMOV_REVERSE, M_SMOV_HEX};

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

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Plc, RtFn, d, k, kn};

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
}
