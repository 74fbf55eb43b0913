//! Floating point: FNC 49, 110–137 and 438–440, h1u-h2u-programming §4.3.10, hm-motion-controller §5.4.
//!
//! Values are IEEE singles. A source that is not a number is an operation error, and so is a function's argument
//! outside its domain.

use crate::cx::Cx;
use crate::fault::{Done, Fault};
use crate::special::{M_BORROW, M_CARRY, M_ZERO};
use core::cmp::Ordering;

/// Degrees per radian, and its inverse. The worked examples of DEG end in whole degrees only if it is one
/// multiplication of singles.
const DEGREES: f32 = 57.295_78;
const RADIANS: f32 = 0.017_453_292;

/// Operand `i`, which must be a finite number.
fn number(cx: &Cx, i: usize) -> Result<f32, Fault> {
    let value = cx.float(i, 0)?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Fault::DOMAIN)
    }
}

/// Operand `i`, which must lie in the domain of a function.
fn number_in(cx: &Cx, i: usize, domain: impl Fn(f32) -> bool) -> Result<f32, Fault> {
    let value = number(cx, i)?;
    if domain(value) {
        Ok(value)
    } else {
        Err(Fault::DOMAIN)
    }
}

/// Switches one of three bits from operand `i` on, the others off.
pub(super) fn one_of_three(cx: &mut Cx, i: usize, which: Ordering) -> Done {
    cx.check_bits(i, 3)?;
    cx.set_bit(i, 0, which == Ordering::Less)?;
    cx.set_bit(i, 1, which == Ordering::Equal)?;
    cx.set_bit(i, 2, which == Ordering::Greater)
}

/// Position of `value` relative to the zone from `low` to `high`.
pub(super) fn zone<T: PartialOrd>(value: T, low: T, high: T) -> Ordering {
    if value < low {
        Ordering::Less
    } else if value > high {
        Ordering::Greater
    } else {
        Ordering::Equal
    }
}

/// ECMP S1 S2 D (FNC 110): D, D+1 or D+2 is on as S1 is above, equal to or below S2.
pub fn ecmp(cx: &mut Cx) -> Done {
    let (a, b) = (number(cx, 0)?, number(cx, 1)?);
    one_of_three(cx, 2, zone(b, a, a))
}

/// EZCP S1 S2 S D (FNC 111): D, D+1 or D+2 is on as S is below, inside or above the zone from S1 to S2.
pub fn ezcp(cx: &mut Cx) -> Done {
    let (low, high, value) = (number(cx, 0)?, number(cx, 1)?, number(cx, 2)?);
    // An upper limit below the lower one counts as equal to it (FX3 programming manual §18.2).
    one_of_three(cx, 3, zone(value, low, high.max(low)))
}

/// EMOV S D (FNC 112): copies a float.
pub fn emov(cx: &mut Cx) -> Done {
    let bits = cx.float_bits(0)?;
    cx.set_dword(1, 0, bits)
}

/// 10 to the power `e`, as exact as a double can be.
fn power_of_ten(e: i32) -> f64 {
    let mut power = 1.0f64;
    for _ in 0..e.unsigned_abs().min(400) {
        power *= 10.0;
    }
    if e < 0 { 1.0 / power } else { power }
}

/// EBCD S D (FNC 118): D takes the first four decimal digits of S with its sign, D+1 the power of ten (JY992D88101
/// §5.10.3: 3.4567E-5 is 3456 and -8).
pub fn ebcd(cx: &mut Cx) -> Done {
    let value = f64::from(number(cx, 0)?);
    let (mut mantissa, mut exponent) = (0.0, 0);
    if value != 0.0 {
        // A single has seven decimal digits.
        exponent = libm::floor(libm::log10(libm::fabs(value))) as i32 - 6;
        let scaled = |e: i32| match e {
            e if e > 0 => libm::round(value / power_of_ten(e)),
            e => libm::round(value * power_of_ten(-e)),
        };
        mantissa = scaled(exponent);
        if libm::fabs(mantissa) >= 10_000_000.0 {
            exponent += 1;
            mantissa = scaled(exponent);
        }
        mantissa = libm::trunc(mantissa / 1000.0);
        exponent += 3;
    }
    cx.check_words(1, 2)?;
    cx.set_word(1, 0, mantissa as i16)?;
    cx.set_word(1, 1, exponent as i16)
}

/// EBIN S D (FNC 119): D takes the float of S times 10 to the power of S+1.
pub fn ebin(cx: &mut Cx) -> Done {
    let (mantissa, exponent) = (f64::from(cx.word(0, 0)?), i32::from(cx.word(0, 1)?));
    let value = if exponent < 0 {
        mantissa / power_of_ten(-exponent)
    } else {
        mantissa * power_of_ten(exponent)
    } as f32;
    if !value.is_finite() {
        return Err(Fault::DOMAIN);
    }
    cx.set_float(1, 0, value)
}

/// Handling of a result that is not representable as a float.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Fit {
    Exact,
    /// The largest float is stored.
    TooLarge,
    /// The smallest float is stored.
    TooSmall,
}

/// Writes the result of an operation whose exact value (or its nearest double) is `exact`, as near as a float comes.
fn store_result(cx: &mut Cx, i: usize, exact: f64) -> Result<Fit, Fault> {
    let size = libm::fabs(exact);
    let (value, fit) = if (size as f32).is_infinite() {
        (f32::MAX, Fit::TooLarge)
    } else if size != 0.0 && size < f64::from(f32::MIN_POSITIVE) {
        (f32::MIN_POSITIVE, Fit::TooSmall)
    } else {
        (size as f32, Fit::Exact)
    };
    cx.set_float(i, 0, libm::copysignf(value, exact as f32))?;
    Ok(fit)
}

/// Writes a result and its flags: M8020 for 0, M8021 for a value too small for a float, M8022 for one too large.
pub(super) fn write_result(cx: &mut Cx, i: usize, exact: f64) -> Done {
    let fit = store_result(cx, i, exact)?;
    cx.set_special(M_ZERO, exact == 0.0);
    cx.set_special(M_BORROW, fit == Fit::TooSmall);
    cx.set_special(M_CARRY, fit == Fit::TooLarge);
    Ok(())
}

/// Both operands as doubles: a double is wide enough that rounding its result to a single gives the single's correctly
/// rounded one.
fn pair(cx: &Cx) -> Result<(f64, f64), Fault> {
    Ok((number(cx, 0)?.into(), number(cx, 1)?.into()))
}

/// EADD S1 S2 D (FNC 120).
pub fn eadd(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    write_result(cx, 2, a + b)
}

/// ESUB S1 S2 D (FNC 121).
pub fn esub(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    write_result(cx, 2, a - b)
}

/// EMUL S1 S2 D (FNC 122).
pub fn emul(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    write_result(cx, 2, a * b)
}

/// EDIV S1 S2 D (FNC 123): a divisor of 0 is an error.
pub fn ediv(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    if b == 0.0 {
        return Err(Fault::VALUE);
    }
    write_result(cx, 2, a / b)
}

/// EADD of HM, which has no flags for it.
pub fn eadd_plain(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    store_result(cx, 2, a + b).map(drop)
}

/// ESUB of HM, which has no flags for it.
pub fn esub_plain(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    store_result(cx, 2, a - b).map(drop)
}

/// EMUL of HM, which has no flags for it.
pub fn emul_plain(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    store_result(cx, 2, a * b).map(drop)
}

/// EDIV of HM: dividing by 0 gives the largest float if S1 is above 0, else the smallest. No flags.
pub fn ediv_clamped(cx: &mut Cx) -> Done {
    let (a, b) = pair(cx)?;
    let largest = if a > 0.0 { f32::MAX } else { f32::MIN };
    store_result(cx, 2, if b == 0.0 { largest.into() } else { a / b }).map(drop)
}

/// Writes the value of a function of one float; one that is not a float is an error.
fn function(cx: &mut Cx, f: fn(f32) -> f32) -> Done {
    let value = f(number(cx, 0)?);
    if !value.is_finite() {
        return Err(Fault::DOMAIN);
    }
    cx.set_float(1, 0, value)
}

/// EXP S D (FNC 124): a result too large or too small for a float is an error.
pub fn exp(cx: &mut Cx) -> Done {
    let value = libm::expf(number(cx, 0)?);
    if !value.is_normal() {
        return Err(Fault::DOMAIN);
    }
    cx.set_float(1, 0, value)
}

/// LOGE S D (FNC 125): natural logarithm of a number above 0.
pub fn loge(cx: &mut Cx) -> Done {
    number_in(cx, 0, |v| v > 0.0)?;
    function(cx, libm::logf)
}

/// LOG10 S D (FNC 126): common logarithm of a number above 0.
pub fn log10(cx: &mut Cx) -> Done {
    number_in(cx, 0, |v| v > 0.0)?;
    function(cx, libm::log10f)
}

/// ESQR S D (FNC 127): square root of a number not below 0; M8020 is on if it is 0.
pub fn esqr(cx: &mut Cx) -> Done {
    let root = libm::sqrtf(number_in(cx, 0, |v| v >= 0.0)?);
    cx.set_float(1, 0, root)?;
    cx.set_special(M_ZERO, root == 0.0);
    Ok(())
}

/// ESQR of HM: beyond the range of floats the root is 0. No flag.
pub fn esqr_clamped(cx: &mut Cx) -> Done {
    let value = cx.float(0, 0)?;
    if value.is_finite() && value < 0.0 {
        return Err(Fault::DOMAIN);
    }
    let root = if value.is_finite() {
        libm::sqrtf(value)
    } else {
        0.0
    };
    cx.set_float(1, 0, root)
}

/// ENEG D (FNC 128): turns the sign.
pub fn eneg(cx: &mut Cx) -> Done {
    let bits = cx.float_bits(0)?;
    cx.set_dword(0, 0, bits ^ i32::MIN)
}

/// INT S D (FNC 129): the integer part; M8020 for 0, M8021 for a dropped fraction, M8022 for a value that D cannot hold
/// (its low bits are stored).
pub fn int(cx: &mut Cx) -> Done {
    let value = number(cx, 0)?;
    let whole = libm::truncf(value);
    let integer = whole as i64;
    let stored = if cx.wide() {
        i64::from(integer as i32)
    } else {
        i64::from(integer as i16)
    };
    cx.write(1, stored as i32)?;
    cx.set_special(M_ZERO, integer == 0);
    cx.set_special(M_BORROW, whole != value);
    cx.set_special(M_CARRY, stored != integer);
    Ok(())
}

/// INT of HM: a value that D cannot hold becomes the nearest that it can; no number becomes the smallest of 32 bits.
pub fn int_clamped(cx: &mut Cx) -> Done {
    let value = cx.float(0, 0)?;
    let integer = if value.is_finite() {
        value as i32
    } else {
        i32::MIN
    };
    let integer = if cx.wide() {
        integer
    } else {
        integer.clamp(i16::MIN.into(), i16::MAX.into())
    };
    cx.write(1, integer)
}

/// FLT S D (FNC 49): the float of an integer.
pub fn flt(cx: &mut Cx) -> Done {
    let value = cx.read(0)? as f32;
    cx.set_float(1, 0, value)
}

/// SIN S D (FNC 130), S in radians.
pub fn sin(cx: &mut Cx) -> Done {
    function(cx, libm::sinf)
}

/// COS S D (FNC 131), S in radians.
pub fn cos(cx: &mut Cx) -> Done {
    function(cx, libm::cosf)
}

/// TAN S D (FNC 132), S in radians.
pub fn tan(cx: &mut Cx) -> Done {
    function(cx, libm::tanf)
}

/// ASIN S D (FNC 133), S from -1 to 1.
pub fn asin(cx: &mut Cx) -> Done {
    number_in(cx, 0, |v| (-1.0..=1.0).contains(&v))?;
    function(cx, libm::asinf)
}

/// ACOS S D (FNC 134), S from -1 to 1.
pub fn acos(cx: &mut Cx) -> Done {
    number_in(cx, 0, |v| (-1.0..=1.0).contains(&v))?;
    function(cx, libm::acosf)
}

/// ATAN S D (FNC 135).
pub fn atan(cx: &mut Cx) -> Done {
    function(cx, libm::atanf)
}

/// RAD S D (FNC 136): degrees to radians.
pub fn rad(cx: &mut Cx) -> Done {
    function(cx, |v| v * RADIANS)
}

/// DEG S D (FNC 137): radians to degrees.
pub fn deg(cx: &mut Cx) -> Done {
    function(cx, |v| v * DEGREES)
}

/// SINH S D (FNC 438).
pub fn sinh(cx: &mut Cx) -> Done {
    function(cx, libm::sinhf)
}

/// COSH S D (FNC 439).
pub fn cosh(cx: &mut Cx) -> Done {
    function(cx, libm::coshf)
}

/// TANH S D (FNC 440).
pub fn tanh(cx: &mut Cx) -> Done {
    function(cx, libm::tanhf)
}

#[cfg(test)]
mod tests {
    use crate::double::{Double, reg};
    use crate::{Class, Fault, Operand, Plc, RtFn, d, k};
    use proptest::prelude::*;

    /// M8020, M8021, M8022 as characters.
    fn flags(plc: &Double) -> std::string::String {
        plc.m(8020, 3)
    }

    fn with(a: f32, b: f32) -> Double {
        let mut plc = Double::wide();
        plc.set_df(0, a);
        plc.set_df(2, b);
        plc
    }

    fn binary(function: RtFn, a: f32, b: f32) -> (f32, std::string::String) {
        let mut plc = with(a, b);
        plc.call(function, &[reg(0), reg(2), reg(4)]).unwrap();
        (plc.df(4), flags(&plc))
    }

    fn unary(function: RtFn, a: f32) -> Result<f32, Fault> {
        let mut plc = with(a, 0.0);
        plc.call(function, &[reg(0), reg(4)])?;
        Ok(plc.df(4))
    }

    #[test]
    fn arithmetic_and_its_flags() {
        assert_eq!(binary(RtFn::Eadd, 1.5, -4.0), (-2.5, "000".into()));
        assert_eq!(binary(RtFn::Esub, 1.5, 1.5), (0.0, "100".into()));
        assert_eq!(binary(RtFn::Eadd, -3e38, -3e38), (f32::MIN, "001".into()));
        assert_eq!(
            binary(RtFn::Emul, -1e-30, 1e-30),
            (-f32::MIN_POSITIVE, "010".into())
        );
        assert_eq!(binary(RtFn::Ediv, 1.0, 3.0), (1.0 / 3.0, "000".into()));
        assert_eq!(
            binary(RtFn::EdivClamped, 0.0, 0.0),
            (f32::MIN, "000".into())
        );
        assert_eq!(
            binary(RtFn::EdivClamped, 2.0, 0.0),
            (f32::MAX, "000".into())
        );
        let mut plc = with(1.0, 0.0);
        assert_eq!(
            plc.call(RtFn::Ediv, &[reg(0), reg(2), reg(4)]),
            Err(Fault::VALUE)
        );
        let mut plc = with(f32::NAN, 0.0);
        assert_eq!(
            plc.call(RtFn::Eadd, &[reg(0), reg(2), reg(4)]),
            Err(Fault::DOMAIN)
        );
        plc.call(RtFn::Eadd, &[k(7), Operand::float(0.5), reg(4)])
            .unwrap();
        assert_eq!(plc.df(4), 7.5);
    }

    #[test]
    fn hm_touches_no_flags() {
        for (function, value) in [
            (RtFn::EaddPlain, f32::MAX),
            (RtFn::EsubPlain, 0.0),
            (RtFn::EmulPlain, f32::MAX),
            (RtFn::EdivClamped, 1.0),
        ] {
            let mut plc = with(3e38, 3e38);
            plc.set_m(8020, "111");
            plc.call(function, &[reg(0), reg(2), reg(4)]).unwrap();
            assert_eq!((plc.df(4), flags(&plc)), (value, "111".into()));
        }
    }

    #[test]
    fn comparisons_switch_one_of_three_bits() {
        let m = d(Class::M, 0);
        for (a, bits) in [(3.0, "100"), (2.0, "010"), (1.0, "001")] {
            let mut plc = with(a, 2.0);
            plc.call(RtFn::Ecmp, &[reg(0), reg(2), m]).unwrap();
            assert_eq!(plc.m(0, 3), bits);
        }
        for (value, bits) in [(0.5, "100"), (1.0, "010"), (2.0, "010"), (2.5, "001")] {
            let mut plc = with(value, 2.0);
            plc.call(RtFn::Ezcp, &[k(1), reg(2), reg(0), m]).unwrap();
            assert_eq!(plc.m(0, 3), bits);
        }
    }

    #[test]
    fn worked_examples_end_in_whole_degrees() {
        assert_eq!(
            unary(RtFn::Deg, unary(RtFn::Asin, 0.707_106_77).unwrap()).map(f32::trunc),
            Ok(45.0)
        );
        assert_eq!(
            unary(RtFn::Deg, unary(RtFn::Atan, 1.732_050_8).unwrap()).map(f32::trunc),
            Ok(60.0)
        );
        assert_eq!(unary(RtFn::Deg, 3.141_592_5).map(f32::trunc), Ok(180.0));
        assert_eq!(unary(RtFn::Rad, 90.0), Ok(1.570_796_4));
    }

    #[test]
    fn domains() {
        for (function, outside) in [
            (RtFn::Asin, 1.001),
            (RtFn::Acos, -1.001),
            (RtFn::Loge, 0.0),
            (RtFn::Log10, -1.0),
            (RtFn::Esqr, -1.0),
            (RtFn::Exp, 88.8),
            (RtFn::Exp, -88.0),
            (RtFn::Cosh, 1000.0),
            (RtFn::Sin, f32::INFINITY),
        ] {
            assert_eq!(unary(function, outside), Err(Fault::DOMAIN), "{function:?}");
        }
        assert_eq!(unary(RtFn::Exp, 0.0), Ok(1.0));
        assert_eq!(unary(RtFn::Log10, 1000.0), Ok(3.0));
        assert_eq!(unary(RtFn::Esqr, 2.25), Ok(1.5));
        assert_eq!(unary(RtFn::Tanh, 20.0), Ok(1.0));
    }

    #[test]
    fn integer_parts() {
        let int = |wide: bool, function, value| {
            let mut plc = if wide { Double::wide() } else { Double::new() };
            plc.set_df(0, value);
            plc.call(function, &[reg(0), reg(4)]).unwrap();
            (plc.dd(4), flags(&plc))
        };
        assert_eq!(int(false, RtFn::Int, -0.5), (0, "110".into()));
        assert_eq!(int(false, RtFn::Int, 65_537.0), (1, "001".into()));
        assert_eq!(int(true, RtFn::Int, -1.9), (-1, "010".into()));
        assert_eq!(int(true, RtFn::Int, 3e9).1, "001");
        assert_eq!(int(false, RtFn::IntClamped, 40_000.0).0, 32_767);
        assert_eq!(int(true, RtFn::IntClamped, -3e9).0, i32::MIN);
        assert_eq!(int(true, RtFn::IntClamped, f32::NAN).0, i32::MIN);
    }

    #[test]
    fn decimal_floats() {
        let ebcd = |value| {
            let mut plc = with(value, 0.0);
            plc.call(RtFn::Ebcd, &[reg(0), reg(4)]).unwrap();
            let d = plc.d(4, 2);
            (d[0], d[1])
        };
        assert_eq!(ebcd(0.0), (0, 0));
        assert_eq!(ebcd(3.842), (3842, -3));
        assert_eq!(ebcd(-9999.9), (-9999, 0));
        assert_eq!(ebcd(3.4567e-5), (3456, -8));
        assert_eq!(ebcd(0.7), (7000, -4));
        assert_eq!(ebcd(f32::MAX), (3402, 35));
        assert_eq!(ebcd(f32::MIN_POSITIVE), (1175, -41));
        let mut plc = Double::wide().with_d(0, &[1175, -41]);
        plc.call(RtFn::Ebin, &[reg(0), reg(4)]).unwrap();
        assert_eq!(plc.df(4), 1.175e-38);
        plc.set_d(0, &[3500, 35]);
        assert_eq!(plc.call(RtFn::Ebin, &[reg(0), reg(4)]), Err(Fault::DOMAIN));
    }

    #[test]
    fn moves_keep_every_bit() {
        let mut plc = with(f32::from_bits(0x7fa0_0001), 1.0);
        plc.call(RtFn::Emov, &[reg(0), reg(4)]).unwrap();
        assert_eq!(plc.dd(4), 0x7fa0_0001);
        plc.call(RtFn::Eneg, &[reg(2)]).unwrap();
        assert_eq!(plc.df(2), -1.0);
        plc.call(RtFn::Emov, &[k(3), reg(4)]).unwrap();
        assert_eq!(plc.df(4), 3.0);
        assert_eq!(
            plc.bit(Class::M, 8067),
            Some(false),
            "functions report nothing themselves"
        );
    }

    proptest! {
        #[test]
        fn arithmetic_is_that_of_singles(a: f32, b: f32) {
            prop_assume!(a.is_finite() && b.is_finite());
            for (function, expected) in [
                (RtFn::Eadd, a + b),
                (RtFn::Esub, a - b),
                (RtFn::Emul, a * b),
                (RtFn::Ediv, a / b),
            ] {
                if expected.is_normal() && b != 0.0 {
                    prop_assert_eq!(binary(function, a, b), (expected, "000".into()));
                }
            }
        }

        #[test]
        fn int_undoes_flt(value: i16) {
            let mut plc = Double::new().with_d(0, &[value.into()]);
            plc.call(RtFn::Flt, &[reg(0), reg(2)]).unwrap();
            plc.call(RtFn::Int, &[reg(2), reg(4)]).unwrap();
            prop_assert_eq!(plc.d(4, 1)[0], value);
        }
    }
}
