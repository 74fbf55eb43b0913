//! Contact comparisons, CMP and ZCP.

use super::row::*;
use super::{CmpOp, Drive, Inst, Join, Lower, Param, Spelling};

const TWO_VALUES: &[Param] = &[src("S1", VALUES), src("S2", VALUES)];

const fn contact(name: &'static str, fnc: u16, join: Join, op: CmpOp) -> Inst {
    row(name, "Contact comparison", "h1u-h2u-programming §4.3.14")
        .fnc(fnc)
        .spelling(Spelling::Compare)
        .forms(W16_W32)
        .steps(5, 9)
        .takes(TWO_VALUES)
        .drive(Drive::Logic)
        .lower(Lower::Compare(join, op))
        .text(
            "A contact that is closed while the comparison of S1 with S2 holds. Both are signed; the 32-bit form compares pairs. \
             Counters of 32 bits need it.",
        )
}

pub(super) const ROWS: &[Inst] = &[
    contact("LD=", 224, Join::Ld, CmpOp::Eq),
    contact("LD>", 225, Join::Ld, CmpOp::Gt),
    contact("LD<", 226, Join::Ld, CmpOp::Lt),
    contact("LD<>", 228, Join::Ld, CmpOp::Ne),
    contact("LD<=", 229, Join::Ld, CmpOp::Le),
    contact("LD>=", 230, Join::Ld, CmpOp::Ge),
    contact("AND=", 232, Join::And, CmpOp::Eq),
    contact("AND>", 233, Join::And, CmpOp::Gt),
    contact("AND<", 234, Join::And, CmpOp::Lt),
    contact("AND<>", 236, Join::And, CmpOp::Ne),
    contact("AND<=", 237, Join::And, CmpOp::Le),
    contact("AND>=", 238, Join::And, CmpOp::Ge),
    contact("OR=", 240, Join::Or, CmpOp::Eq),
    contact("OR>", 241, Join::Or, CmpOp::Gt),
    contact("OR<", 242, Join::Or, CmpOp::Lt),
    contact("OR<>", 244, Join::Or, CmpOp::Ne),
    contact("OR<=", 245, Join::Or, CmpOp::Le),
    contact("OR>=", 246, Join::Or, CmpOp::Ge),
    row("CMP", "Compare", "h1u-h2u-programming §4.3.2")
        .fnc(10)
        .forms(ALL_FORMS)
        .steps(7, 13)
        .takes(&[src("S1", VALUES), src("S2", VALUES), coil("D", RESULT_BITS).len(3)])
        .errors(&[6706])
        .lower(Lower::Cmp)
        .text(
            "Compares S1 with S2, signed, and sets one of three bits: D if S1 > S2, D+1 if they are equal, D+2 if S1 < S2; the \
             other two go off. They keep their state while the instruction is not driven.",
        ),
    row("ZCP", "Zone compare", "h1u-h2u-programming §4.3.2")
        .fnc(11)
        .forms(ALL_FORMS)
        .steps(9, 17)
        .takes(&[src("S1", VALUES), src("S2", VALUES), src("S", VALUES), coil("D", RESULT_BITS).len(3)])
        .errors(&[6706])
        .lower(Lower::Zcp)
        .text(
            "Compares S with the zone S1 to S2, signed: D is on if it is below S1, D+1 if it lies between S1 and S2 (both included), D+2 if it is \
             above S2. If S2 is smaller than S1 it counts as equal to S1.",
        ),
];
