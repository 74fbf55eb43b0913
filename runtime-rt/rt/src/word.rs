//! Words, pairs and groups of bits; what emitted code does with words and floats inline.

use crate::fnc::digits::{from_nibbles, is_bcd, to_bcd};

/// The 32-bit value of a pair.
pub const fn pair(low: i16, high: i16) -> i32 {
    (high as i32) << 16 | low as u16 as i32
}

/// Low and high word of a 32-bit value.
pub const fn words(value: i32) -> [i16; 2] {
    [value as i16, (value >> 16) as i16]
}

/// The float whose bits a pair holds.
pub const fn float(low: i16, high: i16) -> f32 {
    f32::from_bits(pair(low, high) as u32)
}

/// Low and high word of a float's bits.
pub const fn float_words(value: f32) -> [i16; 2] {
    words(value.to_bits() as i32)
}

/// High 32 bits of the 64-bit product.
pub const fn mul_high(a: i32, b: i32) -> i32 {
    ((a as i64 * b as i64) >> 32) as i32
}

/// Bit 0–15 of a word.
pub const fn bit(word: i16, bit: u8) -> bool {
    word as u16 >> (bit & 15) & 1 == 1
}

/// The word with bit 0–15 set to `value`.
#[must_use]
pub const fn with_bit(word: i16, bit: u8, value: bool) -> i16 {
    let mask = 1u16 << (bit & 15);
    let cleared = word as u16 & !mask;
    (if value { cleared | mask } else { cleared }) as i16
}

/// Up to 32 bits as an integer, the first one lowest.
pub fn pack(bits: &[bool]) -> i32 {
    let value = bits
        .iter()
        .rev()
        .fold(0u32, |value, &bit| value << 1 | u32::from(bit));
    value as i32
}

/// The low `N` bits of an integer, the lowest first.
pub fn unpack<const N: usize>(value: i32) -> [bool; N] {
    core::array::from_fn(|bit| value >> (bit & 31) & 1 == 1)
}

/// Sets the bits to the low bits of an integer, the first one to the lowest.
pub fn unpack_to(value: i32, bits: &mut [bool]) {
    for (n, bit) in bits.iter_mut().enumerate() {
        *bit = value >> (n & 31) & 1 == 1;
    }
}

/// The bytes of a word exchanged (SWAP).
pub const fn swap16(value: i16) -> i16 {
    value.swap_bytes()
}

/// The bytes of each word of a pair exchanged (DSWAP).
pub const fn swap32(value: i32) -> i32 {
    let bytes = value as u32;
    ((bytes & 0x00ff_00ff) << 8 | bytes >> 8 & 0x00ff_00ff) as i32
}

/// Number of bits that are on (SUM).
pub const fn ones16(value: i16) -> i16 {
    value.count_ones() as i16
}

/// Number of bits that are on (DSUM).
pub const fn ones32(value: i32) -> i32 {
    value.count_ones() as i32
}

/// The decimal digits of 0 to 9999, four bits each (BCD).
pub fn to_bcd16(value: i16) -> i16 {
    to_bcd(value as u16 as u32) as i16
}

/// The decimal digits of 0 to 99 999 999, four bits each (DBCD).
pub fn to_bcd32(value: i32) -> i32 {
    to_bcd(value as u32) as i32
}

/// The number of four decimal digits of four bits each; a digit above 9 counts as what it is (BIN).
pub fn from_bcd16(value: i16) -> i16 {
    from_nibbles(value as u16 as u32) as i16
}

/// The number of eight decimal digits of four bits each; a digit above 9 counts as what it is (DBIN).
pub fn from_bcd32(value: i32) -> i32 {
    from_nibbles(value as u32) as i32
}

/// Returns true if no digit of four bits is above 9.
pub fn is_bcd16(value: i16) -> bool {
    is_bcd(value as u16 as u32)
}

/// Returns true if no digit of four bits is above 9.
pub fn is_bcd32(value: i32) -> bool {
    is_bcd(value as u32)
}

/// The integer square root of a number; 0 for one below 0 (SQR).
pub const fn root(value: i32) -> i32 {
    if value < 0 {
        0
    } else {
        (value as u32).isqrt() as i32
    }
}

/// Number of the highest bit that is on, counted from 0; 0 if none is (ENCO).
pub const fn highest_bit(value: i32) -> i32 {
    (31 - (value | 1).leading_zeros()) as i32
}

/// Segments a (bit 0) to g (bit 6) of the hexadecimal digits.
const SEGMENTS: [i16; 16] = [
    0x3f, 0x06, 0x5b, 0x4f, 0x66, 0x6d, 0x7d, 0x27, 0x7f, 0x6f, 0x77, 0x7c, 0x39, 0x5e, 0x79, 0x71,
];

/// The segments of a display that show the low four bits as a digit, segment a in bit 0 (SEGD,
/// h1u-h2u-programming §4.3.8).
pub const fn segments(digit: i16) -> i16 {
    SEGMENTS[(digit & 15) as usize]
}

/// The square root of a float that is not below 0, correctly rounded (ESQR).
pub fn square_root(value: f32) -> f32 {
    libm::sqrtf(value)
}

/// The nearest float (FLT).
pub const fn to_float(value: i32) -> f32 {
    value as f32
}

/// The low 32 bits of the integer part, which is held at the ends of 64 bits; 0 for no number (INT).
pub const fn truncate(value: f32) -> i32 {
    value as i64 as i32
}

/// Returns true if the value is finite and not NaN.
pub const fn is_finite(value: f32) -> bool {
    value.is_finite()
}

/// The other sign, also of a value that is not a number (ENEG).
pub const fn negate(value: f32) -> f32 {
    f32::from_bits(value.to_bits() ^ 0x8000_0000)
}

/// A rounded result as floating point instructions store it: the largest float of its sign where it is too large, the
/// smallest normal one where it is too small but not exactly 0.
fn stored(rounded: f32, is_zero: bool) -> f32 {
    if rounded.is_infinite() {
        f32::MAX.copysign(rounded)
    } else if !is_zero && rounded.abs() < f32::MIN_POSITIVE {
        f32::MIN_POSITIVE.copysign(rounded)
    } else {
        rounded
    }
}

/// Sum of two finite floats (EADD).
pub fn float_add(a: f32, b: f32) -> f32 {
    stored(a + b, a + b == 0.0)
}

/// Difference of two finite floats (ESUB).
pub fn float_sub(a: f32, b: f32) -> f32 {
    stored(a - b, a - b == 0.0)
}

/// Product of two finite floats (EMUL).
pub fn float_mul(a: f32, b: f32) -> f32 {
    stored(a * b, a == 0.0 || b == 0.0)
}

/// Quotient of two finite floats (EDIV); the divisor is not 0.
pub fn float_div(a: f32, b: f32) -> f32 {
    stored(a / b, a == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_a_value_make_the_value() {
        for value in [0, 1, -1, 70_000, -70_000, i32::MIN, i32::MAX] {
            let [low, high] = words(value);
            assert_eq!(pair(low, high), value);
        }
    }

    #[test]
    fn bits_are_numbered_from_the_lowest() {
        assert!(bit(0b100, 2));
        assert_eq!(with_bit(0, 15, true), i16::MIN);
        assert_eq!(with_bit(-1, 0, false), -2);
        assert_eq!(pack(&[true, false, true, true]), 0b1101);
        assert_eq!(unpack(0b1101), [true, false, true, true]);
        assert_eq!(pack(&unpack::<32>(-5)), -5);
        let mut bits = [true; 5];
        unpack_to(0b1101, &mut bits[1..]);
        assert_eq!(bits, [true, true, false, true, true]);
    }

    #[test]
    fn floats_stay_within_their_range() {
        assert_eq!(float_mul(f32::MAX, -2.0), f32::MIN);
        assert_eq!(float_mul(f32::MIN_POSITIVE, -0.25), -f32::MIN_POSITIVE);
        assert_eq!(float_mul(0.0, 5.0), 0.0);
        assert_eq!(float_div(f32::MIN_POSITIVE, 1e30), f32::MIN_POSITIVE);
        assert_eq!(float_add(f32::MAX, f32::MAX), f32::MAX);
        assert_eq!(float_sub(1.5, 1.5), 0.0);
        assert_eq!(truncate(-3.9), -3);
        assert_eq!(truncate(1e20), -1);
        assert_eq!(truncate(2_147_483_648.0), i32::MIN);
    }

    proptest::proptest! {
        /// Inline code and the runtime's functions give the same bits.
        #[test]
        fn operators_agree_with_the_instructions(a: f32, b: f32) {
            use crate::double::{Double, reg};
            use crate::RtFn;
            proptest::prop_assume!(a.is_finite() && b.is_finite());
            let bits = |value: f32| value.to_bits() as i32;
            for (function, inline) in [
                (RtFn::Eadd, float_add as fn(f32, f32) -> f32),
                (RtFn::Esub, float_sub),
                (RtFn::Emul, float_mul),
                (RtFn::Ediv, float_div),
            ] {
                if function == RtFn::Ediv && b == 0.0 {
                    continue;
                }
                let mut plc = Double::wide();
                plc.set_dd(0, bits(a));
                plc.set_dd(2, bits(b));
                plc.call(function, &[reg(0), reg(2), reg(4)]).unwrap();
                proptest::prop_assert_eq!(plc.dd(4), bits(inline(a, b)), "{:?} {} {}", function, a, b);
            }
        }
    }
}
