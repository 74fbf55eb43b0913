//! Data processing: FNC 40–49, h1u-h2u-programming §4.3.5, hm-motion-controller §5.4.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::operand::OperandKind;
use crate::plc::Class;
use crate::special::M_MEAN_SUM;

/// ZRST D1 D2 (FNC 40): clears the devices D1…D2; if D2 lies below D1 only D1.
pub fn zrst(cx: &mut Cx) -> Done {
    let (first, last) = match cx.ops {
        [a, b, ..] if a.class == b.class && a.kind == OperandKind::Device => {
            (a.value, b.value.max(a.value))
        }
        _ => return Err(Fault::VALUE),
    };
    let count = last.saturating_sub(first).saturating_add(1);
    if cx.is_bit(0) {
        cx.check_bits(0, count)?;
        return (0..count).try_for_each(|n| cx.set_bit(0, n, false));
    }
    cx.check_resets(0, count)?;
    (0..count).try_for_each(|n| cx.reset(0, n))
}

/// DECO S D n (FNC 41): switches bit v of the 2ⁿ bits from D on alone on, v being the low n bits of S.
pub fn deco(cx: &mut Cx) -> Done {
    let most = if cx.is_bit(1) { 8 } else { 4 };
    let n = cx.count(2, 0..=most)?;
    if n == 0 {
        return Ok(());
    }
    let value = if cx.is_bit(0) {
        cx.bits(0, 0, n)?
    } else {
        cx.read_unsigned(0)?
    };
    let value = (value & ((1 << n) - 1)) as i32;
    if !cx.is_bit(1) {
        return cx.set_word(1, 0, (1u16 << value) as i16);
    }
    cx.check_bits(1, 1 << n)?;
    (0..1 << n).try_for_each(|bit| cx.set_bit(1, bit, bit == value))
}

/// ENCO S D n (FNC 42): the position of the highest bit that is on among the 2ⁿ from S on; that none is on is an error.
pub fn enco(cx: &mut Cx) -> Done {
    encode(cx, None)
}

/// ENCO of FX: where none is on, D becomes 0 beside the error (JY992D48301 §5.5.3).
pub fn enco_zero(cx: &mut Cx) -> Done {
    encode(cx, Some(0))
}

/// ENCO that writes `of_none` where no bit is on.
fn encode(cx: &mut Cx, of_none: Option<i16>) -> Done {
    let most = if cx.is_bit(0) { 8 } else { 4 };
    let n = cx.count(2, 0..=most)?;
    if n == 0 {
        return Ok(());
    }
    let highest = highest_of(cx, n)?;
    if let Some(value) = highest.or(of_none) {
        cx.set_word(1, 0, value)?;
    }
    highest.map(drop).ok_or(Fault::VALUE)
}

/// Position of the highest of the 2ⁿ bits of operand 0 that is on.
fn highest_of(cx: &Cx, n: i32) -> Result<Option<i16>, Fault> {
    let mut highest = None;
    let word = if cx.is_bit(0) {
        0
    } else {
        cx.read_unsigned(0)?
    };
    for bit in 0..1 << n {
        let on = if cx.is_bit(0) {
            cx.bit(0, bit)?
        } else {
            word >> bit & 1 == 1
        };
        if on {
            highest = Some(bit as i16);
        }
    }
    Ok(highest)
}

/// Sum of the `n` elements from operand 0 on; at most 64 or 16 bits each, so 64 bits hold it.
pub(super) fn sum_of(cx: &Cx, n: i32) -> Result<i64, Fault> {
    (0..n).try_fold(0i64, |sum, k| Ok(sum + i64::from(cx.elem(0, k)?)))
}

/// MEAN S D n (FNC 45): the mean of n elements, its fraction dropped.
pub fn mean(cx: &mut Cx) -> Done {
    let n = cx.count(2, 1..=64)?;
    let mean = sum_of(cx, n)? / i64::from(n);
    cx.write(1, mean as i32)
}

/// MEAN of H1U/H2U: with M8490 the 16-bit form also writes the sum to (D+2, D+1).
pub fn mean_sum(cx: &mut Cx) -> Done {
    if cx.wide() || !cx.special(M_MEAN_SUM) {
        return mean(cx);
    }
    let n = cx.count(2, 1..=64)?;
    let sum = sum_of(cx, n)?;
    cx.check_words(1, 3)?;
    cx.set_word(1, 0, (sum / i64::from(n)) as i16)?;
    cx.set_dword(1, 1, sum as i32)
}

/// First annunciator.
const ANNUNCIATOR_FIRST: u32 = 900;
/// Last annunciator.
const ANNUNCIATOR_LAST: u32 = 999;

/// ANS S m D (FNC 46): sets annunciator D once the drive has been on for m times 100 ms; timer S shows the time and
/// starts over with each drive. Memory: time driven in milliseconds; whether the last scan drove it.
pub fn ans(cx: &mut Cx) -> Done {
    let dt = cx.elapsed_ms();
    if !cx.drive() {
        if cx.state().0[1] != 0 {
            cx.state().0 = [0; 8];
            cx.reset(0, 0)?;
        }
        return Ok(());
    }
    let limit = cx.count(1, 1..=32767)?;
    cx.bit(2, 0)?;
    let state = cx.state();
    if state.0[1] != 0 {
        state.0[0] = state.0[0].saturating_add(dt);
    }
    state.0[1] = 1;
    let value = (state.0[0] / 100).min(limit);
    cx.set_word(0, 0, value as i16)?;
    if value >= limit {
        cx.set_bit(0, 0, true)?;
        cx.set_bit(2, 0, true)?;
    }
    Ok(())
}

/// ANR (FNC 47): resets the lowest annunciator that is on.
pub fn anr(cx: &mut Cx) -> Done {
    let on = |&n: &u32| cx.plc.bit(Class::S, n) == Some(true);
    if let Some(lowest) = (ANNUNCIATOR_FIRST..=ANNUNCIATOR_LAST).find(on) {
        let _ = cx.plc.set_bit(Class::S, lowest, false);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg, relay};
    use crate::{Class, Fault, Plc, RtFn, State, d, k};

    #[test]
    fn zrst_clears_a_run() {
        let mut plc = Double::new().with_d(0, &[1, 2, 3, 4]);
        plc.call(RtFn::Zrst, &[reg(1), reg(2)]).unwrap();
        assert_eq!(plc.d(0, 4), [1, 0, 0, 4]);
        plc.call(RtFn::Zrst, &[reg(3), reg(0)]).unwrap();
        assert_eq!(plc.d(0, 4), [1, 0, 0, 0]);
        plc.set_m(0, "1111");
        plc.call(RtFn::Zrst, &[relay(1), relay(2)]).unwrap();
        assert_eq!(plc.m(0, 4), "1001");
        plc.set_counter32(200, 9);
        plc.set_bit(Class::C, 200, true);
        plc.call(RtFn::Zrst, &[d(Class::C, 200), d(Class::C, 201)])
            .unwrap();
        assert_eq!(
            (plc.counter32(200), plc.bit(Class::C, 200)),
            (Some(0), Some(false))
        );
        plc.set_d(8511, &[7]);
        assert_eq!(
            plc.call(RtFn::Zrst, &[reg(8511), reg(8512)]),
            Err(Fault::DEVICE)
        );
        assert_eq!(plc.d(8511, 1), [7]);
        assert_eq!(plc.call(RtFn::Zrst, &[reg(0), relay(9)]), Err(Fault::VALUE));
    }

    #[test]
    fn deco_and_enco_are_inverse() {
        let mut plc = Double::new();
        for value in 0..16 {
            plc.set_d(0, &[value]);
            plc.call(RtFn::Deco, &[reg(0), relay(10), k(4)]).unwrap();
            plc.call(RtFn::Enco, &[relay(10), reg(1), k(4)]).unwrap();
            plc.call(RtFn::Deco, &[reg(0), reg(2), k(4)]).unwrap();
            plc.call(RtFn::Enco, &[reg(2), reg(3), k(4)]).unwrap();
            assert_eq!(
                plc.d(1, 3),
                [value as i16, (1 << value) as u16 as i16, value as i16]
            );
            assert_eq!(plc.m(10, 17).matches('1').count(), 1);
        }
    }

    #[test]
    fn deco_of_bits_and_bad_lengths() {
        let mut plc = Double::new();
        plc.set_m(0, "101");
        plc.call(RtFn::Deco, &[relay(0), relay(10), k(3)]).unwrap();
        assert_eq!(plc.m(10, 8), "00000100");
        plc.call(RtFn::Deco, &[relay(0), relay(10), k(0)]).unwrap();
        assert_eq!(plc.m(10, 8), "00000100");
        assert_eq!(
            plc.call(RtFn::Deco, &[relay(0), relay(10), k(9)]),
            Err(Fault::VALUE)
        );
        assert_eq!(
            plc.call(RtFn::Deco, &[relay(0), reg(0), k(5)]),
            Err(Fault::VALUE)
        );
        assert_eq!(
            plc.call(RtFn::Enco, &[relay(20), reg(0), k(3)]),
            Err(Fault::VALUE)
        );
    }

    #[test]
    fn means_drop_the_fraction_towards_zero() {
        let mut plc = Double::new().with_d(0, &[-5, -6, 30000, 30000, 30000, 30000]);
        plc.call(RtFn::Mean, &[reg(0), reg(10), k(2)]).unwrap();
        assert_eq!(plc.d(10, 1), [-5]);
        plc.set_bit(Class::M, 8490, true);
        plc.call(RtFn::MeanSum, &[reg(2), reg(10), k(4)]).unwrap();
        assert_eq!((plc.d(10, 1), plc.dd(11)), ([30000].to_vec(), 120_000));
        assert_eq!(
            plc.call(RtFn::Mean, &[reg(2), reg(10), k(65)]),
            Err(Fault::VALUE)
        );
        let mut plc = Double::wide().with_d(0, &[-1, 32767, -1, 32767]);
        plc.call(RtFn::MeanSum, &[reg(0), reg(10), k(2)]).unwrap();
        assert_eq!(plc.dd(10), i32::MAX);
    }

    #[test]
    fn ans_sets_after_its_time() {
        let ops = [d(Class::T, 0), k(3), d(Class::S, 900)];
        let mut plc = Double::new();
        plc.scan(100, true, RtFn::Ans, &ops).unwrap();
        for value in 1..=3 {
            assert_eq!(plc.bit(Class::S, 900), Some(false));
            plc.scan(100, true, RtFn::Ans, &ops).unwrap();
            assert_eq!(plc.word(Class::T, 0), Some(value));
        }
        assert_eq!(
            (plc.bit(Class::S, 900), plc.bit(Class::T, 0)),
            (Some(true), Some(true))
        );
        plc.scan(100, false, RtFn::Ans, &ops).unwrap();
        assert_eq!(
            (plc.bit(Class::S, 900), plc.bit(Class::T, 0)),
            (Some(true), Some(false))
        );
        assert_eq!(
            (plc.word(Class::T, 0), *plc.state(1)),
            (Some(0), State::default())
        );
    }

    #[test]
    fn annunciators_are_reset_from_the_lowest() {
        let mut plc = Double::new();
        let on = |plc: &Double| [899, 910, 950].map(|n| plc.bit(Class::S, n).unwrap());
        for n in [899, 910, 950] {
            plc.set_bit(Class::S, n, true);
        }
        plc.call(RtFn::Anr, &[]).unwrap();
        assert_eq!(on(&plc), [true, false, true]);
        plc.call(RtFn::Anr, &[]).unwrap();
        plc.call(RtFn::Anr, &[]).unwrap();
        assert_eq!(on(&plc), [true, false, false]);
    }
}
