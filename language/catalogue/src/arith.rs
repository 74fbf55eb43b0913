//! Integer arithmetic and logic, FNC 20–29.

use super::row::*;
use super::{ArithOp, Inst, Lower, Param, Repeat, Rule, Spelling};

const TWO_VALUES: &[Param] = &[src("S1", VALUES), src("S2", VALUES), dst("D", RESULTS)];
const DOUBLE_RESULT: &[Param] = &[
    src("S1", VALUES),
    src("S2", VALUES),
    dst("D", RESULTS).len(2),
];
const DOUBLE_RESULT_NO_INDEX: &[Param] = &[
    src("S1", VALUES),
    src("S2", VALUES),
    dst("D", RESULTS.without(INDEX)).len(2),
];
/// V and Z only in the 16-bit form (JY992D48301 §5.3.3, §5.3.4; JY997D16601 §10.3, §10.4).
const DOUBLE_RESULT_FX: &[Param] = &[
    src("S1", VALUES),
    src("S2", VALUES),
    dst("D", RESULTS).len(2).rules(&[Rule::WideNot(INDEX)]),
];
const ONE_VALUE: &[Param] = &[both("D", RESULTS)];

const fn arith(name: &'static str, fnc: u16, title: &'static str, op: ArithOp) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.3")
        .fnc(fnc)
        .forms(ALL_FORMS)
        .steps(7, 13)
        .takes(TWO_VALUES)
        .errors(&[6706])
        .lower(Lower::Arith(op))
}

const fn one_value(name: &'static str, fnc: u16, title: &'static str, op: ArithOp) -> Inst {
    arith(name, fnc, title, op)
        .steps(3, 5)
        .takes(ONE_VALUE)
        .repeat(Repeat::Changes(0))
}

pub(super) const ROWS: &[Inst] = &[
    arith("ADD", 20, "Addition", ArithOp::Add)
        .neutral(0)
        .flags(&["M8020", "M8021", "M8022"])
        .lower_on(&[(HM, Lower::ArithSaturating(ArithOp::Add))])
        .text(
            "D = S1 + S2, signed. M8020 is on if the result is 0, M8022 if the sum is too large (carry), M8021 if it is too small \
             (borrow); the value wraps. On HM the value stays at the end of the range.",
        ),
    arith("SUB", 21, "Subtraction", ArithOp::Sub)
        .neutral_second(0)
        .flags(&["M8020", "M8021", "M8022"])
        .lower_on(&[(HM, Lower::ArithSaturating(ArithOp::Sub))])
        .text(
            "D = S1 - S2, signed. Flags as ADD: M8020 zero, M8021 borrow (too small), M8022 carry (too large); the value wraps. On \
             HM the value stays at the end of the range.",
        ),
    arith("MUL", 22, "Multiplication", ArithOp::Mul)
        .neutral(1)
        .takes(DOUBLE_RESULT)
        .variants(&[on(INOVANCE).takes(DOUBLE_RESULT_NO_INDEX), on(LIKE_FX).takes(DOUBLE_RESULT_FX)])
        .text(
            "D = S1 × S2, signed, in double width: the 16-bit form writes the pair D (low) and D+1, the 32-bit form the four \
             registers from D on. A group of bits takes as many low bits as it has.",
        ),
    arith("DIV", 23, "Division", ArithOp::Div)
        .neutral_second(1)
        .takes(DOUBLE_RESULT)
        .variants(&[on(INOVANCE).takes(DOUBLE_RESULT_NO_INDEX), on(LIKE_FX).takes(DOUBLE_RESULT_FX)])
        .errors(&[6706])
        .lower_on(&[(HM, Lower::ArithSaturating(ArithOp::Div))])
        .text(
            "Divides S1 by S2, signed, truncating: D is the quotient, the word (32-bit: the pair) after it the remainder with the \
             sign of S1. A group of bits takes only the quotient. Division by 0 is an error; on HM it gives the end of the range.",
        ),
    one_value("INC", 24, "Increment", ArithOp::Inc)
        .lower_on(&[(HM, Lower::ArithSaturating(ArithOp::Inc))])
        .text("Adds 1 to D at each execution, wrapping; no flags. On HM it stays at the largest value."),
    one_value("DEC", 25, "Decrement", ArithOp::Dec)
        .lower_on(&[(HM, Lower::ArithSaturating(ArithOp::Dec))])
        .text("Subtracts 1 from D at each execution, wrapping; no flags. On HM it stays at the smallest value."),
    arith("WAND", 26, "Word AND", ArithOp::And)
        .repeat(Repeat::Same)
        .spelling(Spelling::Wide("DAND"))
        .text("D = S1 AND S2, bit by bit. The 32-bit form is written DAND."),
    arith("WOR", 27, "Word OR", ArithOp::Or)
        .repeat(Repeat::Same)
        .spelling(Spelling::Wide("DOR"))
        .text("D = S1 OR S2, bit by bit. The 32-bit form is written DOR."),
    arith("WXOR", 28, "Word exclusive OR", ArithOp::Xor)
        .neutral(0)
        .spelling(Spelling::Wide("DXOR"))
        .text("D = S1 XOR S2, bit by bit. The 32-bit form is written DXOR."),
    one_value("NEG", 29, "Negation", ArithOp::Neg)
        .on(NOT_SMALL_FX)
        .text("D = -D, two's complement, at each execution; the smallest value is unchanged."),
];
