//! Effect of an instruction that runs again.

use super::Inst;

/// Effect of an instruction that runs again, in the next scan, while nothing else writes its operands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Repeat {
    /// None, even where the result replaces a source (WAND, LIMIT), which may then fail (HEX).
    Same,
    /// It changes operand `.0` again (INC, ALT, shifts).
    Changes(usize),
    /// It changes its result again where that overlaps with a source (ADD D0 K1 D0).
    Overlapping,
    /// The same in the 32-bit form; the 16-bit form leaves the word of a float that counts (INT).
    OverlappingWide,
    /// It changes its result again where that begins at a source. Elsewhere that depends on the order of the words
    /// (BK+), or the row does not say how far the source reaches: M8161 does (CRC), or whether it is a word (DECO).
    Replacing,
    /// It changes its result again where that overlaps with the source and begins elsewhere (BMOV D0 D1 K5).
    Shifting,
    /// It changes its result again where that is the source, and the digits taken overlap with those written: operands
    /// 1, 2 and 4 are the first digit taken, their number and the first digit written (SMOV).
    Digits,
}

/// Constants with which the result of an instruction equals its other operand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Neutral {
    /// Positions of the operand.
    pub operands: &'static [usize],
    /// Its value.
    pub value: i64,
}

impl Neutral {
    /// No such constant.
    const NONE: Neutral = Neutral {
        operands: &[],
        value: 0,
    };
}

/// [`Inst::repeat`] and [`Inst::neutral`] of most rows.
pub(super) const USUAL: (Repeat, Neutral) = (Repeat::Overlapping, Neutral::NONE);

impl Inst {
    pub(super) const fn repeat(self, repeat: Repeat) -> Self {
        Inst { repeat, ..self }
    }

    /// The constant `value` as either source leaves the other one as it is.
    pub(super) const fn neutral(self, value: i64) -> Self {
        self.neutral_at(&[0, 1], value)
    }

    /// The constant `value` as the second source leaves the first one as it is.
    pub(super) const fn neutral_second(self, value: i64) -> Self {
        self.neutral_at(&[1], value)
    }

    const fn neutral_at(self, operands: &'static [usize], value: i64) -> Self {
        let neutral = Neutral { operands, value };
        Inst { neutral, ..self }
    }
}
