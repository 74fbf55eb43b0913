//! Decimal, hexadecimal and packed-decimal digits.

/// Packs the decimal digits of `value` (below 100 000 000) four bits each, ones lowest.
pub fn to_bcd(mut value: u32) -> u32 {
    let mut bcd = 0;
    for shift in (0..32).step_by(4) {
        bcd |= (value % 10) << shift;
        value /= 10;
    }
    bcd
}

/// The number whose digits `bcd` packs, digits above 9 counting as what they are: H1A is 20.
pub fn from_nibbles(bcd: u32) -> u32 {
    (0..32).step_by(4).rev().fold(0u32, |value, shift| {
        value.wrapping_mul(10).wrapping_add(bcd >> shift & 15)
    })
}

/// Returns true if no digit of `bcd` is above 9.
pub fn is_bcd(bcd: u32) -> bool {
    (0..32).step_by(4).all(|shift| bcd >> shift & 15 <= 9)
}

/// Character of the hexadecimal digit in the low four bits.
pub fn hex_digit(digit: u16) -> u8 {
    match digit as u8 & 15 {
        digit @ 0..=9 => b'0' + digit,
        digit => b'A' + digit - 10,
    }
}

/// The hexadecimal digit that a character (in capitals) is.
pub fn hex_value(code: u8) -> Option<u16> {
    match code {
        b'0'..=b'9' => Some(u16::from(code - b'0')),
        b'A'..=b'F' => Some(u16::from(code - b'A') + 10),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bcd_and_back(value in 0u32..100_000_000) {
            prop_assert_eq!(from_nibbles(to_bcd(value)), value);
            prop_assert_eq!(std::format!("{:x}", to_bcd(value)), std::format!("{value}"));
        }

        #[test]
        fn only_decimal_digits_are_bcd(word: u32) {
            prop_assert_eq!(is_bcd(word), std::format!("{word:x}").chars().all(|c| c.is_ascii_digit()));
        }
    }
}
