//! Moving values.

use super::row::*;
use super::{Inst, Lower};

pub(super) const ROWS: &[Inst] = &[
    row("MOV", "Move", "h1u-h2u-programming §4.3.2")
        .fnc(12)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", VALUES), dst("D", RESULTS)])
        .errors(&[6706])
        .lower(Lower::Move)
        .text(
            "Copies S to D. A short group of bits as S is filled up with zeros; a short group as D takes the low bits. T and C mean \
             the current value.",
        ),
    row("CML", "Move complement", "h1u-h2u-programming §4.3.2")
        .fnc(14)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", VALUES), dst("D", RESULTS)])
        .errors(&[6706])
        .lower(Lower::MoveNot)
        .text("Copies every bit of S inverted to D. A short group of bits as D takes the low bits."),
];
