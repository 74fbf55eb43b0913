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

/// The number whose decimal digits `bcd` packs; `None` if it has a digit above 9.
pub fn from_bcd(bcd: u32) -> Option<u32> {
    (0..32)
        .step_by(4)
        .all(|shift| bcd >> shift & 15 <= 9)
        .then(|| from_nibbles(bcd))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bcd_and_back(value in 0u32..100_000_000) {
            prop_assert_eq!(from_bcd(to_bcd(value)), Some(value));
            prop_assert_eq!(std::format!("{:x}", to_bcd(value)), std::format!("{value}"));
        }

        #[test]
        fn only_decimal_digits_are_bcd(word: u32) {
            prop_assert_eq!(from_bcd(word).is_some(), std::format!("{word:x}").chars().all(|c| c.is_ascii_digit()));
        }
    }
}
