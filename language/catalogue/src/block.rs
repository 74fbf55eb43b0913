//! Blocks, limits, scaling and tables of FX3U, FNC 182–214 and 256–269.

use super::row::*;
use super::{Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_rt::RtFn;

const BLOCK: &[Param] = &[
    src("S1", REGISTERS).per(3),
    src("S2", REGISTERS.or(CONSTANTS)).per(3),
    dst("D", REGISTERS).per(3),
    src("n", CONSTANTS.or(DATA)).rules(COUNTED),
];
const COMPARE_BLOCK: &[Param] = &[
    src("S1", REGISTERS.or(CONSTANTS)).per(3),
    src("S2", REGISTERS).per(3),
    coil("D", RESULT_BITS).per(3),
    src("n", CONSTANTS.or(DATA)).rules(COUNTED),
];
const THREE: &[Param] = &three(&[]);
/// The upper end is not below the lower one.
const RANGE: &[Param] = &three(&[Rule::WorksFrom(0)]);
const fn three(rules: &'static [Rule]) -> [Param; 4] {
    [
        src("S1", VALUES.without(INDEX)),
        src("S2", VALUES.without(INDEX)).rules(rules),
        src("S3", VALUES.without(INDEX)),
        dst("D", RESULT_GROUPS.or(PLACES)),
    ]
}
/// The number of points is in the table itself.
const SCALE: &[Param] = &[
    src("S1", VALUES),
    src("S2", DATA).open_ended(),
    dst("D", RESULT_GROUPS.or(PLACES)),
];
const TABLE: &[Param] = &[
    both("S", REGISTERS),
    both("D", REGISTERS).open_ended(),
    src("n", CONSTANTS.or(DATA)).rules(COUNTED),
];

const fn block(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "public knowledge of FX3U")
        .fnc(fnc)
        .on(FX3U_L01S)
        .forms(ALL_FORMS)
        .steps(9, 17)
        .errors(&[6706, 6707])
}

const fn compare(name: &'static str, fnc: u16, function: RtFn) -> Inst {
    block(name, fnc, "Compare blocks")
        .call(function)
        .takes(COMPARE_BLOCK)
        .flags(&["M8090"])
        .text("Compares n values from S1 on, or the constant S1, with those from S2 on into the bits from D on. M8090 is on if all hold.")
}

pub(super) const ROWS: &[Inst] = &[
    block("CRC", 188, "CRC-16")
        .repeat(Repeat::Replacing)
        .forms(W16_P)
        .steps(7, 7)
        .on(FX3U)
        .takes(&[
            src("S", GROUPS.or(PLACES)).per(2),
            dst("D", RESULT_GROUPS.or(PLACES)),
            src("n", CONSTANTS.or(DATA)).limits(1, 256),
        ])
        .flags(&["M8161"])
        .call(RtFn::Crc)
        .text("D = the CRC-16 of Modbus over n bytes from S on, two to a word, low byte first; with M8161 on one to a word."),
    block("BK+", 192, "Add blocks")
        .repeat(Repeat::Replacing)
        .neutral(0)
        .call(RtFn::BkAdd).takes(BLOCK).text("Adds the n values from S2 on, or the constant S2, to those from S1 on into D on."),
    block("BK-", 193, "Subtract blocks")
        .repeat(Repeat::Replacing)
        .neutral_second(0)
        .takes(BLOCK)
        .call(RtFn::BkSub)
        .text("Subtracts the n values from S2 on, or the constant S2, from those from S1 on into D on."),
    compare("BKCMP=", 194, RtFn::BkcmpEq),
    compare("BKCMP>", 195, RtFn::BkcmpGt),
    compare("BKCMP<", 196, RtFn::BkcmpLt),
    compare("BKCMP<>", 197, RtFn::BkcmpNe),
    compare("BKCMP<=", 198, RtFn::BkcmpLe),
    compare("BKCMP>=", 199, RtFn::BkcmpGe),
    block("FDEL", 210, "Delete from a table")
        .repeat(Repeat::Changes(1))
        .forms(W16_P)
        .steps(7, 7)
        .takes(TABLE)
        .call(RtFn::Fdel)
        .text("Removes entry n from the table at D, whose first word is its length, and writes it to S; the entries after it move up."),
    block("FINS", 211, "Insert into a table")
        .repeat(Repeat::Changes(1))
        .forms(W16_P)
        .steps(7, 7)
        .takes(&[
            src("S", CONSTANTS.or(REGISTERS)),
            both("D", REGISTERS).open_ended(),
            src("n", CONSTANTS.or(DATA)).rules(COUNTED),
        ])
        .call(RtFn::Fins)
        .text("Inserts S into the table at D, whose first word is its length, as entry n; the entries after it move down."),
    block("LIMIT", 256, "Limit")
        .repeat(Repeat::Same)
        .takes(RANGE)
        .lower(Lower::Values(ValueOp::Limit))
        .text("D = S3, held between S1 and S2. S1 above S2 is an error."),
    block("BAND", 257, "Dead band")
        .takes(RANGE)
        .lower(Lower::Values(ValueOp::Band))
        .text("D = 0 while S3 lies between S1 and S2, else how far it lies outside."),
    block("ZONE", 258, "Zone offset")
        .takes(THREE)
        .lower(Lower::Values(ValueOp::Zone))
        .text("D = S3 + S1 if S3 is negative, S3 + S2 if it is positive, 0 if it is 0."),
    block("SCL", 259, "Scaling")
        .steps(7, 13)
        .takes(SCALE)
        .call(RtFn::Scl)
        .text("D = S1 on the line through the points of the table at S2: their number, then X and Y of each."),
    block("SCL2", 269, "Scaling, X and Y apart")
        .steps(7, 13)
        .takes(SCALE)
        .call(RtFn::Scl2)
        .text("D = S1 on the line through the points of the table at S2: their number, then all X, then all Y."),
];
