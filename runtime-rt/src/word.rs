//! Words, pairs and groups of bits.

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
}
