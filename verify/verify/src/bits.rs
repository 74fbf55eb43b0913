//! Numbers as bits: two's complement, the lowest bit first, any width.

use crate::aig::{Aig, Lit};

/// A number, or with one bit a state.
pub type Bits = Vec<Lit>;

/// The constant with this many bits.
pub fn constant(value: i64, width: usize) -> Bits {
    (0..width)
        .map(|bit| Lit::from(value >> bit.min(63) & 1 == 1))
        .collect()
}

/// The value of a number whose bits are all constants, sign-extended.
pub fn known(bits: &[Lit]) -> Option<i64> {
    let top = bits.last()?.constant()?;
    let mut value = if top { -1i64 } else { 0 };
    for (i, bit) in bits.iter().enumerate() {
        value = value & !(1 << i) | i64::from(bit.constant()?) << i;
    }
    Some(value)
}

/// With another width, sign-extended or cut.
pub fn signed(bits: &[Lit], width: usize) -> Bits {
    let top = bits.last().copied().unwrap_or(Lit::FALSE);
    resized(bits, width, top)
}

/// With another width, zero-extended or cut.
pub fn unsigned(bits: &[Lit], width: usize) -> Bits {
    resized(bits, width, Lit::FALSE)
}

fn resized(bits: &[Lit], width: usize, fill: Lit) -> Bits {
    let more = std::iter::repeat(fill);
    bits.iter().copied().chain(more).take(width).collect()
}

/// Every bit inverted.
pub fn complement(bits: &[Lit]) -> Bits {
    bits.iter().map(|&bit| !bit).collect()
}

impl Aig {
    /// A number of free bits.
    pub fn inputs_of(&mut self, width: usize) -> Bits {
        (0..width).map(|_| self.input()).collect()
    }

    /// `then` where `cond` is on, else `otherwise`, of one width.
    pub fn select(&mut self, cond: Lit, then: &[Lit], otherwise: &[Lit]) -> Bits {
        let pairs = then.iter().zip(otherwise);
        pairs.map(|(&a, &b)| self.mux(cond, a, b)).collect()
    }

    /// Bit by bit.
    pub fn zip(&mut self, a: &[Lit], b: &[Lit], op: fn(&mut Aig, Lit, Lit) -> Lit) -> Bits {
        a.iter().zip(b).map(|(&a, &b)| op(self, a, b)).collect()
    }

    /// The sum with a carry in, and the carry out.
    fn sum(&mut self, a: &[Lit], b: &[Lit], mut carry: Lit) -> (Bits, Lit) {
        let mut sum = Bits::with_capacity(a.len());
        for (&a, &b) in a.iter().zip(b) {
            let half = self.xor(a, b);
            sum.push(self.xor(half, carry));
            carry = self.mux(half, carry, a);
        }
        (sum, carry)
    }

    /// Sum, wrapping.
    pub fn add(&mut self, a: &[Lit], b: &[Lit]) -> Bits {
        self.sum(a, b, Lit::FALSE).0
    }

    /// Difference, wrapping.
    pub fn sub(&mut self, a: &[Lit], b: &[Lit]) -> Bits {
        self.sum(a, &complement(b), Lit::TRUE).0
    }

    /// Negation, wrapping.
    pub fn neg(&mut self, a: &[Lit]) -> Bits {
        let zero = constant(0, a.len());
        self.sub(&zero, a)
    }

    /// Bit that is on if both are equal.
    pub fn equal(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        let same = self.zip(a, b, Aig::same);
        self.all(same)
    }

    /// Bit that is on if a number has this value.
    pub fn is(&mut self, a: &[Lit], value: i64) -> Lit {
        self.equal(a, &constant(value, a.len()))
    }

    /// Bit that is on if any bit is on.
    pub fn nonzero(&mut self, a: &[Lit]) -> Lit {
        self.any(a.iter().copied())
    }

    /// Bit that is on if `a < b`, unsigned.
    pub fn below(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        !self.sum(a, &complement(b), Lit::TRUE).1
    }

    /// Bit that is on if `a < b`, signed.
    pub fn less(&mut self, a: &[Lit], b: &[Lit]) -> Lit {
        let flipped = |bits: &[Lit]| {
            let mut bits = bits.to_vec();
            if let Some(top) = bits.last_mut() {
                *top = !*top;
            }
            bits
        };
        self.below(&flipped(a), &flipped(b))
    }

    /// The lesser, signed.
    pub fn least(&mut self, a: &[Lit], b: &[Lit]) -> Bits {
        let less = self.less(a, b);
        self.select(less, a, b)
    }

    /// The product's low bits, as many as `a` has.
    pub(crate) fn mul(&mut self, a: &[Lit], b: &[Lit]) -> Bits {
        let width = a.len();
        let mut product = constant(0, width);
        for (i, &bit) in b.iter().enumerate().take(width) {
            if bit == Lit::FALSE {
                continue;
            }
            let part: Bits = a[..width - i].iter().map(|&a| self.and(a, bit)).collect();
            let (sum, _) = self.sum(&product[i..], &part, Lit::FALSE);
            product.splice(i.., sum);
        }
        product
    }

    /// Quotient and remainder, unsigned; with a divisor of 0 whatever the circuit makes.
    pub fn divide(&mut self, a: &[Lit], b: &[Lit]) -> (Bits, Bits) {
        let width = b.len() + 1;
        let divisor = unsigned(b, width);
        let mut rest = constant(0, width);
        let mut quotient = constant(0, a.len());
        for (i, &bit) in a.iter().enumerate().rev() {
            rest.insert(0, bit);
            rest.truncate(width);
            let fits = !self.below(&rest, &divisor);
            let less = self.sub(&rest, &divisor);
            rest = self.select(fits, &less, &rest);
            quotient[i] = fits;
        }
        rest.truncate(b.len());
        (quotient, rest)
    }

    /// Without the sign.
    fn magnitude(&mut self, a: &[Lit]) -> (Bits, Lit) {
        let sign = a.last().copied().unwrap_or(Lit::FALSE);
        let neg = self.neg(a);
        (self.select(sign, &neg, a), sign)
    }

    /// Quotient and remainder, signed, truncated towards 0, wrapping.
    pub(crate) fn divide_signed(&mut self, a: &[Lit], b: &[Lit]) -> (Bits, Bits) {
        let ((ma, sa), (mb, sb)) = (self.magnitude(a), self.magnitude(b));
        let (quotient, rest) = self.divide(&ma, &mb);
        let differ = self.xor(sa, sb);
        let (neg_quotient, neg_rest) = (self.neg(&quotient), self.neg(&rest));
        (
            self.select(differ, &neg_quotient, &quotient),
            self.select(sa, &neg_rest, &rest),
        )
    }

    /// A sum of one more bit, held at the ends of the range of `width` bits.
    pub fn saturate(&mut self, wide: &[Lit], width: usize) -> Bits {
        let (low, high) = (-(1i64 << (width - 1)), (1i64 << (width - 1)) - 1);
        let ends = [low, high].map(|end| constant(end, wide.len()));
        let under = self.less(wide, &ends[0]);
        let over = self.less(&ends[1], wide);
        let held = self.select(under, &ends[0], wide);
        let held = self.select(over, &ends[1], &held);
        signed(&held, width)
    }

    /// Rotated left by as many places as the low bits of `by` say.
    pub fn rotate_left(&mut self, a: &[Lit], by: &[Lit]) -> Bits {
        let mut value = a.to_vec();
        let stages = a.len().trailing_zeros() as usize;
        for (stage, &bit) in by.iter().enumerate().take(stages) {
            let mut turned = value.clone();
            turned.rotate_right(1 << stage);
            value = self.select(bit, &turned, &value);
        }
        value
    }

    /// Number of bits that are on, in this width.
    pub fn ones(&mut self, a: &[Lit], width: usize) -> Bits {
        let zero = constant(0, width);
        a.iter().fold(zero, |count, &bit| {
            self.add(&count, &unsigned(&[bit], width))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{constant, known, signed};
    use crate::aig::Aig;

    /// Constants fold, so that circuits can be compared with arithmetic.
    #[test]
    fn circuits_compute() {
        let values = [0i64, 1, -1, 2, 7, -8, 100, 32767, -32768, 12345, -999];
        let wrap = |v: i64| Some(i64::from(v as i16));
        let mut aig = Aig::default();
        for a in values {
            for b in values {
                let (x, y) = (constant(a, 16), constant(b, 16));
                assert_eq!(known(&aig.add(&x, &y)), wrap(a + b));
                assert_eq!(known(&aig.sub(&x, &y)), wrap(a - b));
                assert_eq!(known(&aig.mul(&x, &y)), wrap(a * b));
                assert_eq!(aig.less(&x, &y).constant(), Some(a < b));
                let unsigned = (a as u16) < b as u16;
                assert_eq!(aig.below(&x, &y).constant(), Some(unsigned));
                assert_eq!(aig.equal(&x, &y).constant(), Some(a == b));
                assert_eq!(known(&aig.least(&x, &y)), Some(a.min(b)));
                if b != 0 {
                    let (quotient, rest) = aig.divide_signed(&x, &y);
                    assert_eq!(known(&quotient), wrap(a / b), "{a} / {b}");
                    assert_eq!(known(&rest), wrap(a % b), "{a} % {b}");
                }
                let sum = aig.add(&signed(&x, 17), &signed(&y, 17));
                let held = (a as i16).saturating_add(b as i16);
                assert_eq!(known(&aig.saturate(&sum, 16)), Some(held.into()));
                let turned = (a as i16).rotate_left(b as u32 % 16);
                assert_eq!(known(&aig.rotate_left(&x, &y)), Some(turned.into()));
            }
            let ones = i64::from((a as i16).count_ones());
            assert_eq!(known(&aig.ones(&constant(a, 16), 16)), Some(ones));
        }
    }
}
