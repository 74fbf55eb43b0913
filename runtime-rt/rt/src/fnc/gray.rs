//! Gray code: FNC 170 and 171, h1u-h2u-programming §4.3.13.

use crate::cx::Cx;
use crate::fault::Done;

/// GRY S D (FNC 170): Gray code of S, which must not be negative.
pub fn gry(cx: &mut Cx) -> Done {
    let value = cx.count(0, 0..=i32::MAX)?;
    cx.write(1, value ^ value >> 1)
}

/// GBIN S D (FNC 171): the number whose Gray code is S, which must not be negative.
pub fn gbin(cx: &mut Cx) -> Done {
    let mut value = cx.count(0, 0..=i32::MAX)?;
    for shift in [1, 2, 4, 8, 16] {
        value ^= value >> shift;
    }
    cx.write(1, value)
}

#[cfg(test)]
mod tests {
    use crate::double::Double;
    use crate::{Class, Fault, RtFn, d, k};
    use proptest::prelude::*;

    #[test]
    fn negative_numbers_have_no_gray_code() {
        let mut plc = Double::new();
        assert_eq!(
            plc.call(RtFn::Gry, &[k(-1), d(Class::D, 0)]),
            Err(Fault::VALUE)
        );
        assert_eq!(
            plc.call(RtFn::Gbin, &[k(-1), d(Class::D, 0)]),
            Err(Fault::VALUE)
        );
    }

    proptest! {
        #[test]
        fn gbin_undoes_gry_and_neighbours_differ_in_a_bit(value in 0..i32::MAX) {
            let mut plc = Double::wide();
            let mut gray = |value| {
                plc.call(RtFn::Gry, &[k(value), d(Class::D, 0)]).unwrap();
                plc.call(RtFn::Gbin, &[d(Class::D, 0), d(Class::D, 2)]).unwrap();
                assert_eq!(plc.dd(2), value);
                plc.dd(0)
            };
            prop_assert_eq!((gray(value) ^ gray(value + 1)).count_ones(), 1);
        }
    }
}
