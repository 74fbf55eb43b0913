//! Moving values.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_rt::RtFn;

/// Block moves from M8024's side: either end is read or written.
const BLOCK: &[Param] = &[
    both("S", WORDS.without(INDEX)).per(2),
    both("D", RESULTS.without(INDEX))
        .per(2)
        .rules(&[Rule::SameDigits(0)]),
    count("n", 1, 512).also(DATA),
];
/// The same where n is a constant.
const BLOCK_CONSTANT: &[Param] = &[
    both("S", WORDS.without(INDEX)).per(2),
    both("D", RESULTS.without(INDEX))
        .per(2)
        .rules(&[Rule::SameDigits(0)]),
    count("n", 1, 512),
];
const BLOCK_HM: &[Param] = &[
    src("S", GROUPS.or(REGISTERS)).per(2),
    dst("D", RESULT_GROUPS.or(REGISTERS))
        .per(2)
        .rules(&[Rule::SameDigits(0)]),
    count("n", 1, 32767),
];
const FILL_HM: &[Param] = &[
    src("S", VALUES),
    dst("D", RESULTS).per(2),
    count("n", 1, 256),
];
const CONVERT: &[Param] = &[src("S", WORDS), dst("D", RESULTS)];

const fn convert(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.2")
        .fnc(fnc)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(CONVERT)
}

const GRAY: &[Param] = &[src("S", VALUES).rules(NOT_NEGATIVE), dst("D", RESULTS)];

pub(super) const ROWS: &[Inst] = &[
    row("MOV", "Move", "h1u-h2u-programming §4.3.2")
        .repeat(Repeat::Shifting)
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
        .on(NOT_FX1)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", VALUES), dst("D", RESULTS)])
        .errors(&[6706])
        .lower(Lower::MoveNot)
        .text("Copies every bit of S inverted to D. A short group of bits as D takes the low bits."),
    row("SMOV", "Move digits", "h1u-h2u-programming §4.3.2")
        .repeat(Repeat::Digits)
        .fnc(13)
        .forms(W16_P)
        .steps(11, 11)
        .on(NOT_HM_FX1)
        .takes(&[
            src("S", WORDS),
            count("m1", 1, 4),
            count("m2", 1, 4).rules(&[Rule::AtMost(1)]),
            both("D", RESULTS),
            count("n", 1, 4).rules(&[Rule::AtLeast(2)]),
        ])
        .flags(&["M8168"])
        .errors(&[6706, 6707])
        .call(RtFn::Smov)
        .text(
            "Takes m2 decimal digits of S, from digit m1 downwards, and puts them into D from digit n downwards; the other digits \
             of D stay. With M8168 on the digits are the hexadecimal ones. Digit 1 is the lowest.",
        ),
    row("BMOV", "Move a block", "h1u-h2u-programming §4.3.2")
        .repeat(Repeat::Shifting)
        .fnc(15)
        .forms(W16_P)
        .steps(7, 7)
        .takes(BLOCK)
        .variants(&[on(INOVANCE).takes(BLOCK_CONSTANT), on(HM).takes(BLOCK_HM)])
        .flags(&["M8024"])
        .errors(&[6706])
        .call(RtFn::Bmov)
        .lower_on(&[(HM, Lower::Call(RtFn::BmovForward))])
        .text(
            "Copies n words from S on to D on, also where the two overlap. With M8024 on it copies from D to S (not on HM). Groups of \
             bits count as words of their length; both have the same number of digits.",
        ),
    row("FMOV", "Fill a block", "h1u-h2u-programming §4.3.2")
        .repeat(Repeat::Same)
        .fnc(16)
        .on(NOT_FX1)
        .forms(ALL_FORMS)
        .steps(7, 13)
        .takes(&[
            src("S", VALUES),
            dst("D", RESULTS.without(INDEX)).per(2),
            count("n", 1, 512).also_on(LIKE_FX3, DATA),
        ])
        .variants(&[on(HM).takes(FILL_HM)])
        .errors(&[6706])
        .call(RtFn::Fmov)
        .text("Writes the value S to n words (32-bit: pairs) from D on."),
    row("XCH", "Exchange", "h1u-h2u-programming §4.3.2")
        .repeat(Repeat::Changes(0))
        .fnc(17)
        .on(NOT_SMALL_FX)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[both("D1", RESULTS), both("D2", RESULTS)])
        .flags(&["M8160"])
        .errors(&[6706])
        .lower(Lower::Values(ValueOp::Exchange { bytes: true }))
        .lower_on(&[(HM, Lower::Values(ValueOp::Exchange { bytes: false }))])
        .text(
            "Exchanges D1 and D2 at each execution. With M8160 on and twice the same device it exchanges the bytes of each word \
             instead (not on HM).",
        ),
    convert("BCD", 18, "Binary to BCD")
        .errors(&[6706, 6707])
        .lower(Lower::Values(ValueOp::ToBcd { clamps: false }))
        .lower_on(&[(HM, Lower::Values(ValueOp::ToBcd { clamps: true }))])
        .text(
            "Writes the decimal digits of S to D, four bits each. Values outside 0 to 9999 (32-bit: 99999999) are an error; on HM they \
             stay at the end of the range.",
        ),
    convert("BIN", 19, "BCD to binary")
        .errors(&[6706, 6707])
        .lower(Lower::Values(ValueOp::FromBcd { checks: true }))
        .lower_on(&[(HM, Lower::Values(ValueOp::FromBcd { checks: false }))])
        .text("Reads the four-bit digits of S as a decimal number. A digit above 9 is an error; HM does not check."),
    row("SWAP", "Exchange bytes", "h1u-h2u-programming §4.3.10")
        .repeat(Repeat::Changes(0))
        .fnc(147)
        .on(NOT_SMALL_FX)
        .forms(ALL_FORMS)
        .steps(3, 5)
        .takes(&[both("S", RESULTS)])
        .lower(Lower::Values(ValueOp::SwapBytes))
        .text("Exchanges the bytes of S at each execution; the 32-bit form does so in each of the two words."),
    row("PRUN", "Octal move", "h1u-h2u-programming §4.3.9")
        .fnc(81)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .on(NOT_HM)
        .takes(&[
            src("S", Classes::KNX.or(Classes::KNM)).rules(&[Rule::EndsInZero]),
            dst("D", Classes::KNY.or(Classes::KNM)).rules(&[Rule::EndsInZero]),
        ])
        .call(RtFn::Prun)
        .text(
            "Copies a group of bits counting both in rows of eight: with K4X000 and K4M0, X000–X007 go to M0–M7 and X010–X017 to \
             M10–M17.",
        ),
    row("GRY", "Binary to Gray code", "h1u-h2u-programming §4.3.13")
        .fnc(170)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .on(NOT_HM_FX1)
        .takes(GRAY)
        .errors(&[6706, 6707])
        .lower(Lower::Values(ValueOp::ToGray))
        .text("D = S in Gray code. A negative S is an error."),
    row("GBIN", "Gray code to binary", "h1u-h2u-programming §4.3.13")
        .fnc(171)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .on(NOT_HM_FX1)
        .takes(GRAY)
        .errors(&[6706, 6707])
        .lower(Lower::Values(ValueOp::FromGray))
        .text("D = the number whose Gray code is S. A negative S is an error."),
];
