//! Operators of expressions, and what they make of constants.

use super::Ty;

/// Two-operand integer operators. Both operands and the result have the same type, `I16` or `I32`, and wrap.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum BinOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// `I32` only: the high 32 bits of the signed 64-bit product.
    MulHigh,
    /// Quotient, truncated towards zero; MIN / -1 wraps. The divisor must be known not to be 0.
    Div,
    /// Remainder with the sign of the dividend. The divisor must be known not to be 0.
    Rem,
    /// Bitwise and.
    And,
    /// Bitwise or.
    Or,
    /// Bitwise exclusive or.
    Xor,
    /// Sum, held at the ends of the type's range.
    SatAdd,
    /// Difference, held at the ends of the type's range.
    SatSub,
    /// The lesser one.
    Min,
    /// The greater one.
    Max,
    /// The bits of the first operand, those that leave at the high end entering at the low end, by as many places as
    /// the second one says, modulo the type's width.
    RotateLeft,
}

impl BinOp {
    /// The result of two `I16`; `None` where the divisor is 0, and of the operator that there is for `I32` only.
    pub fn of_i16(self, a: i16, b: i16) -> Option<i16> {
        match self {
            BinOp::MulHigh => None,
            BinOp::RotateLeft => Some(a.rotate_left(b as u32 % 16)),
            BinOp::SatAdd => Some(a.saturating_add(b)),
            BinOp::SatSub => Some(a.saturating_sub(b)),
            BinOp::Add
            | BinOp::Sub
            | BinOp::Mul
            | BinOp::Div
            | BinOp::Rem
            | BinOp::Min
            | BinOp::Max
            | BinOp::And
            | BinOp::Or
            | BinOp::Xor => self.of_i32(a.into(), b.into()).map(|wide| wide as i16),
        }
    }

    /// The result of two `I32`; `None` where the divisor is 0.
    pub fn of_i32(self, a: i32, b: i32) -> Option<i32> {
        Some(match self {
            BinOp::Add => a.wrapping_add(b),
            BinOp::Sub => a.wrapping_sub(b),
            BinOp::Mul => a.wrapping_mul(b),
            BinOp::MulHigh => ((i64::from(a) * i64::from(b)) >> 32) as i32,
            BinOp::Div | BinOp::Rem if b == 0 => return None,
            BinOp::Div => a.wrapping_div(b),
            BinOp::Rem => a.wrapping_rem(b),
            BinOp::And => a & b,
            BinOp::Or => a | b,
            BinOp::Xor => a ^ b,
            BinOp::SatAdd => a.saturating_add(b),
            BinOp::SatSub => a.saturating_sub(b),
            BinOp::Min => a.min(b),
            BinOp::Max => a.max(b),
            BinOp::RotateLeft => a.rotate_left(b as u32 % 32),
        })
    }
}

/// One-operand functions on words and floats; [`rungc_rt::word`] has them under their names.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum UnOp {
    /// The two bytes of each 16 bits of an integer exchanged.
    SwapBytes,
    /// Number of bits of an integer that are on, in its type.
    CountOnes,
    /// The decimal digits of an integer, four bits each; it must be known to be from 0 to 9999 (`I16`) or 99 999 999
    /// (`I32`).
    ToBcd,
    /// The number whose decimal digits an integer holds, four bits each; a digit above 9 counts as what it is.
    FromBcd,
    /// `Bit`: whether no four bits of an integer are above 9.
    IsBcd,
    /// `I32`: the integer square root of an `I32`, which must be known to be at least 0.
    Root,
    /// `I32`: which is the highest bit that is on of an `I32`, counted from 0; one must be known to be on.
    HighestBit,
    /// The segments of a display that show the low four bits of an `I16` as a digit, segment a in bit 0 to g in bit 6.
    Segments,
    /// `I32` to the nearest `F32`.
    ToFloat,
    /// `F32` to the low 32 bits of its integer part (`I32`), which is held at the ends of 64 bits.
    Truncate,
    /// `Bit`: whether an `F32` is a number and not infinite.
    IsFinite,
    /// An `F32` with the other sign.
    Negate,
    /// The square root of an `F32`, correctly rounded, which must be known to be finite and at least 0.
    SquareRoot,
}

impl UnOp {
    /// The name of the function of a value of type `ty`.
    pub const fn name(self, ty: Ty) -> &'static str {
        let narrow = matches!(ty, Ty::I16);
        match self {
            UnOp::SwapBytes if narrow => "swap16",
            UnOp::SwapBytes => "swap32",
            UnOp::CountOnes if narrow => "ones16",
            UnOp::CountOnes => "ones32",
            UnOp::ToBcd if narrow => "to_bcd16",
            UnOp::ToBcd => "to_bcd32",
            UnOp::FromBcd if narrow => "from_bcd16",
            UnOp::FromBcd => "from_bcd32",
            UnOp::IsBcd if narrow => "is_bcd16",
            UnOp::IsBcd => "is_bcd32",
            UnOp::Root => "root",
            UnOp::HighestBit => "highest_bit",
            UnOp::Segments => "segments",
            UnOp::ToFloat => "to_float",
            UnOp::Truncate => "truncate",
            UnOp::IsFinite => "is_finite",
            UnOp::Negate => "negate",
            UnOp::SquareRoot => "square_root",
        }
    }

    /// Returns true if it accepts a value of type `ty`.
    pub const fn takes(self, ty: Ty) -> bool {
        match self {
            UnOp::SwapBytes | UnOp::CountOnes | UnOp::ToBcd | UnOp::FromBcd | UnOp::IsBcd => {
                matches!(ty, Ty::I16 | Ty::I32)
            }
            UnOp::Segments => matches!(ty, Ty::I16),
            UnOp::Root | UnOp::HighestBit | UnOp::ToFloat => matches!(ty, Ty::I32),
            UnOp::Truncate | UnOp::IsFinite | UnOp::Negate | UnOp::SquareRoot => {
                matches!(ty, Ty::F32)
            }
        }
    }
}

/// Two-operand operators of `F32`. A result too large for an `F32` is the largest of its sign, one that is not 0 but
/// too small for a normal one is the smallest normal one of its sign: [`rungc_rt::word`] has them as `float_add` and so
/// on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum FloatOp {
    /// Sum.
    Add,
    /// Difference.
    Sub,
    /// Product.
    Mul,
    /// Quotient. The divisor must be known not to be 0.
    Div,
}

impl FloatOp {
    /// The name of the function.
    pub const fn name(self) -> &'static str {
        match self {
            FloatOp::Add => "float_add",
            FloatOp::Sub => "float_sub",
            FloatOp::Mul => "float_mul",
            FloatOp::Div => "float_div",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::BinOp;

    #[test]
    fn results_of_16_bits_wrap_at_16_bits() {
        let of = |op: BinOp, a, b| op.of_i16(a, b);
        assert_eq!(of(BinOp::Add, i16::MAX, 1), Some(i16::MIN));
        assert_eq!(of(BinOp::Mul, i16::MIN, i16::MIN), Some(0));
        assert_eq!(of(BinOp::Div, i16::MIN, -1), Some(i16::MIN));
        assert_eq!(of(BinOp::Rem, i16::MIN, -1), Some(0));
        assert_eq!(of(BinOp::Xor, -1, i16::MAX), Some(i16::MIN));
        assert_eq!(of(BinOp::SatAdd, i16::MAX, 1), Some(i16::MAX));
        assert_eq!(of(BinOp::SatSub, i16::MIN, 1), Some(i16::MIN));
    }

    #[test]
    fn nothing_is_divided_by_0() {
        for op in [BinOp::Div, BinOp::Rem] {
            assert_eq!(op.of_i16(5, 0), None);
            assert_eq!(op.of_i32(5, 0), None);
        }
        assert_eq!(BinOp::Div.of_i32(i32::MIN, -1), Some(i32::MIN));
    }
}
