//! Keys, displays and modules, FNC 70–79, 176, 177, 278 and 279.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_models::ModelSet;
use rungc_rt::RtFn;
use rungc_syntax::OperandKind;

const H1U: ModelSet = ModelSet::H1U;
const H2U: ModelSet = ModelSet::H2U;
const BOARDS: ModelSet = ModelSet::COMPATIBLE;
/// Models with modules on CAN.
const REMOTELY: ModelSet = H1U.or(H2U);
/// M8164 is FX2N's alone among the Mitsubishi models (FX3 programming manual, chapter 37).
const WITHOUT_M8164: ModelSet = FX.without(ModelSet::FX2N);
const INOVANCE_FX: ModelSet = INOVANCE.or(FX);
const BIG_FX: ModelSet = BIG.without(L01S);

/// Four devices for each of the n digit groups, operand 3.
fn four_per_group(constants: &[Option<i64>]) -> Option<u32> {
    constant(constants, 3)?.checked_mul(4)
}

/// A display of one group has eight outputs, of two groups twelve; n, operand 2, says which.
fn display_outputs(constants: &[Option<i64>]) -> Option<u32> {
    Some(if constant(constants, 2)? < 4 { 8 } else { 12 })
}

/// And this many words to show.
fn display_words(constants: &[Option<i64>]) -> Option<u32> {
    Some(if constant(constants, 2)? < 4 { 1 } else { 2 })
}

/// Local modules are 0 to 7, remote ones 100 and their station, 1 to 63 (h1u-h2u-programming §5.9.5, §6.1.4).
const MODULE: Param = count("m1", 0, 163).rules(&[Rule::Not(8, 100)]);
const ADDRESS: Param = count("m2", 0, 32767);
const NUMBER: Param = number("n");
const fn number(name: &'static str) -> Param {
    count(name, 1, 32767)
}
const FROM: &[Param] = &[MODULE, ADDRESS, dst("D", RESULTS).per(3), NUMBER];
const TO: &[Param] = &[MODULE, ADDRESS, src("S", WRITTEN).per(3), NUMBER];
/// Operands that H1U and H2U write to a module: constants appear in the worked examples, groups of inputs nowhere.
const WRITTEN: Classes = VALUES.without(Classes::KNX);
/// H1U has only remote modules.
const REMOTE: Param = count("m1", 101, 163);
const FROM_H1U: &[Param] = &[REMOTE, ADDRESS, dst("D", RESULTS).per(3), NUMBER];
const TO_H1U: &[Param] = &[REMOTE, ADDRESS, src("S", WRITTEN).per(3), NUMBER];
const MODULE_FX: Param = count("m1", 0, 7).also(DATA);
const FROM_FX: &[Param] = &[
    MODULE_FX,
    ADDRESS.also(DATA),
    dst("D", RESULTS.without(Classes::BUFFER)).per(3),
    NUMBER.also(DATA),
];
const TO_FX: &[Param] = &[
    MODULE_FX,
    ADDRESS.also(DATA),
    src("S", VALUES.without(Classes::BUFFER)).per(3),
    NUMBER.also(DATA),
];
/// Modbus access under the name of an analog module's instruction: the port precedes D, the data follow it.
const READ_MODBUS: &[Param] = &[
    src("m1", VALUES).limits(1, 247),
    src("m2", VALUES),
    both("D", DATA).open_ended(),
];

/// The FX0N-3A has two inputs and one output.
const RD3A_INOVANCE: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).limits(1, 2),
    dst("D", RESULTS),
];
const WR3A_INOVANCE: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).limits(1, 1),
    src("S", RESULTS),
];
/// FX0N-3A: inputs 1 and 2; FX2N-2AD: inputs 21 and 22 (FX3 programming manual §22.7).
const RD3A: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).among(&[(1, 2), (21, 22)]),
    dst("D", RESULTS),
];
/// FX0N-3A: output 1; FX2N-2DA: outputs 21 and 22 (FX3 programming manual §22.8).
const WR3A: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).among(&[(1, 1), (21, 22)]),
    src("S", WORDS).also_on(FX, CONSTANTS),
];
/// On compatible boards module 0 stands for the board, whose channels count from 0.
const RD3A_BOARD: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).among(&[(0, 7), (21, 22)]),
    dst("D", RESULTS),
];
const WR3A_BOARD: &[Param] = &[
    src("m1", VALUES).limits(0, 7),
    src("m2", VALUES).among(&[(0, 7), (21, 22)]),
    src("S", WORDS).also_on(FX, CONSTANTS),
];
/// A text constant fits in eight characters.
const SHORT_TEXT: Rule = Rule::Holds(
    |operands| match operands.first().map(|operand| &operand.kind) {
        Some(OperandKind::Text(text)) => text.len() <= 8,
        _ => true,
    },
    "at most 8 characters",
);

const fn io(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.8")
        .fnc(fnc)
        .on(BIG)
        .errors(&[6706])
}

pub(super) const ROWS: &[Inst] = &[
    io("TKY", 70, "Ten-key input")
        .forms(W16_W32)
        .steps(7, 13)
        .takes(&[bit("S", SOURCE_BITS).len(10), both("D1", RESULTS), coil("D2", RESULT_BITS).len(11).changed()])
        .call(RtFn::Tky)
        .text(
            "S … S+9 are the keys 0 to 9. A newly pressed one is appended to the decimal number in D1, which keeps its last 4 (32-bit: \
             8) digits. Its bit of D2 … D2+9 is on until another one does so, D2+10 while one is pressed.",
        ),
    io("HKY", 71, "Hexadecimal key input")
        .forms(W16_W32)
        .steps(9, 17)
        .takes(&[
            bit("S", Classes::X).len(4),
            coil("D1", Classes::Y).len(4),
            both("D2", PLACES.or(INDEX)),
            coil("D3", RESULT_BITS).len(8).changed(),
        ])
        .flags(&["M8029", "M8167"])
        .call(RtFn::Hky)
        .text(
            "Scans a matrix of 16 keys by four outputs and four inputs. Digits are appended to the number in D2; D3 … D3+5 show A to F, \
             D3+6 that one of them is pressed, D3+7 that a digit is. With M8167 on all 16 are hexadecimal digits.",
        ),
    io("DSW", 72, "Digital switch")
        .on(NOT_HM)
        .steps(9, 9)
        .takes(&[
            bit("S", Classes::X).len_of(four_per_group),
            coil("D1", Classes::Y).len(4),
            dst("D2", PLACES.or(INDEX)).per(3),
            count("n", 1, 2),
        ])
        .flags(&["M8029"])
        .call(RtFn::Dsw)
        .text(
            "Reads n groups of four decimal switches: outputs D1 … D1+3 select a digit, the lowest first, its bits come in at S (second \
             group: S+4). D2 and D2+1 are the numbers; M8029 is on after each reading.",
        ),
    io("SEGD", 73, "Seven-segment decoder")
        .forms(W16_P)
        .steps(5, 5)
        .takes(&[src("S", VALUES), both("D", RESULTS)])
        .lower(Lower::Values(ValueOp::Segments))
        .text("Writes the segments a to g of the digit in the low four bits of S to the low eight bits of D."),
    io("SEGL", 74, "Seven-segment display")
        .on(INOVANCE_FX)
        .steps(7, 7)
        .uses(2)
        .takes(&[
            src("S", VALUES).len_of(display_words),
            coil("D", Classes::Y).len_of(display_outputs),
            count("n", 0, 7),
        ])
        .flags(&["M8029"])
        .errors(&[6706, 6707])
        .call(RtFn::Segl)
        .text(
            "Shows S (n from 4 on: and S+1) on a display of four digits: data on D … D+3 (second group: D+10 …), strobes on D+4 … D+7. \
             n says the polarities. A refresh takes 12 scans, after which M8029 is on.",
        ),
    io("ARWS", 75, "Arrow switch")
        .on(BIG_FX)
        .steps(9, 9)
        .takes(&[
            bit("S", SOURCE_BITS).len(4),
            both("D1", PLACES.or(INDEX)),
            coil("D2", Classes::Y).len(8),
            count("n", 0, 3),
        ])
        .errors(&[6706, 6707])
        .call(RtFn::Arws)
        .text(
            "Edits the digits of D1 with four keys, down, up, right and left from S on, and shows it at D2 as SEGL does.",
        ),
    io("ASC", 76, "Text constant")
        .on(BIG_FX)
        .steps(11, 11)
        .takes(&[text("S", Classes::TEXT).rules(&[SHORT_TEXT]), text_out("D", PLACES).between(4, 8)])
        .flags(&["M8161"])
        .example("LD X000\nASC \"STOPPED\" D0")
        .call(RtFn::Asc)
        .text(
            "Writes the eight characters S to four words from D on, low byte first; with M8161 on to eight words. What is missing is \
             filled with spaces.",
        ),
    io("PR", 77, "Print text")
        .on(BIG_FX)
        .steps(5, 5)
        .takes(&[src("S", REGISTERS).between(4, 8), coil("D", Classes::Y).len(10)])
        .flags(&["M8027", "M8029"])
        .call(RtFn::Pr)
        .lower_on(&[(INOVANCE, Lower::Call(RtFn::PrSignalsOff))])
        .text(
            "Sends the eight (M8027 on: up to sixteen) characters at S one after the other on outputs D … D+7, with a strobe on D+10 \
             and a busy signal on D+11.",
        ),
    io("FROM", 78, "Read from a module")
        .repeat(Repeat::Same)
        .on(WITH_MODULES)
        .forms(ALL_FORMS)
        .steps(9, 17)
        .takes(FROM_FX)
        .variants(&[on(H1U).takes(FROM_H1U), on(H2U).takes(FROM)])
        .flags(&["M8164", "D8164", "M8299", "D8299"])
        .errors(&[6381, 6706, 6708])
        .call(RtFn::From)
        .lower_on(&[
            (L01S, Lower::Call(RtFn::FromHost)),
            (REMOTELY, Lower::Call(RtFn::FromRemote)),
            (WITHOUT_M8164, Lower::Call(RtFn::FromStated)),
        ])
        .text("Copies n words (32-bit: pairs) of the buffer memory of module m1 from address m2 on to D. With M8164 on, D8164 is n (FX2N, H1U, H2U). A remote module (100 and its station) that does not answer within D8299 ms (5 to 1000) switches M8299 on."),
    io("TO", 79, "Write to a module")
        .on(WITH_MODULES)
        .forms(ALL_FORMS)
        .steps(9, 17)
        .takes(TO_FX)
        .variants(&[on(H1U).takes(TO_H1U), on(H2U).takes(TO)])
        .flags(&["M8164", "D8164", "M8299", "D8299"])
        .errors(&[6381, 6706, 6708])
        .call(RtFn::To)
        .lower_on(&[
            (L01S, Lower::Call(RtFn::ToHost)),
            (REMOTELY, Lower::Call(RtFn::ToRemote)),
            (WITHOUT_M8164, Lower::Call(RtFn::ToStated)),
        ])
        .text("Copies n words (32-bit: pairs) from S on to the buffer memory of module m1 from address m2 on. With M8164 on, D8164 is n (FX2N, H1U, H2U). A remote module (100 and its station) that does not answer within D8299 ms (5 to 1000) switches M8299 on."),
    io("RD3A", 176, "Read an analog module")
        .repeat(Repeat::Same)
        .on(WITH_MODULES)
        .forms(W16_P)
        .steps(7, 7)
        .takes(RD3A)
        .variants(&[
            on(L01S).takes(READ_MODBUS),
            on(INOVANCE).takes(RD3A_INOVANCE),
            on(BOARDS).takes(RD3A_BOARD),
        ])
        .errors(&[6706, 6707, 6708])
        .call(RtFn::Rd3a)
        .lower_on(&[(L01S, Lower::Call(RtFn::Rd3aModbus)), (BOARDS, Lower::Call(RtFn::Rd3aBoard))])
        .text(
            "Reads input m2 of the analog module at position m1: 1 or 2 of an FX0N-3A, 21 or 22 of an FX2N-2AD. On compatible boards \
             module 0 is the board with its own inputs, counted from 0. On L01S it reads registers by Modbus.",
        ),
    io("WR3A", 177, "Write an analog module")
        .on(WITH_MODULES)
        .forms(W16_P)
        .steps(7, 7)
        .takes(WR3A)
        .variants(&[
            on(L01S).takes(READ_MODBUS),
            on(INOVANCE).takes(WR3A_INOVANCE),
            on(BOARDS).takes(WR3A_BOARD),
        ])
        .errors(&[6706, 6707, 6708])
        .call(RtFn::Wr3a)
        .lower_on(&[(L01S, Lower::Call(RtFn::Wr3aModbus)), (BOARDS, Lower::Call(RtFn::Wr3aBoard))])
        .text(
            "Writes S to output m2 of the analog module at position m1: 1 of an FX0N-3A, 21 or 22 of an FX2N-2DA. On compatible boards \
             module 0 is the board with its own outputs, counted from 0: the host finds S in buffer memory m2 of module 0. On L01S it writes \
             registers by Modbus.",
        ),
    io("VRRD", 85, "Read a potentiometer")
        .source("JY992D88101 §5.9.6")
        .repeat(Repeat::Same)
        .on(FX)
        .forms(W16_P)
        .steps(5, 5)
        .takes(&[src("S", CONSTANTS.or(DATA)).limits(0, 7), dst("D", RESULTS)])
        .errors(&[6706, 6708])
        .call(RtFn::Vrrd)
        .text("D = the position of potentiometer S, 0 to 255."),
    io("VRSC", 86, "Read a potentiometer as a switch")
        .source("JY992D88101 §5.9.7")
        .repeat(Repeat::Same)
        .on(FX)
        .forms(W16_P)
        .steps(5, 5)
        .takes(&[src("S", CONSTANTS.or(DATA)).limits(0, 7), dst("D", RESULTS)])
        .errors(&[6706, 6708])
        .call(RtFn::Vrsc)
        .text("D = the position of potentiometer S as a number from 0 to 10."),
    io("RBFM", 278, "Read from a module in parts")
        .source(FX3_MANUAL)
        .on(FX3U)
        .steps(11, 11)
        .takes(&[
            MODULE_FX,
            ADDRESS.also(DATA),
            dst("D", DATA).per(3),
            number("n1").also(DATA),
            src("n2", CONSTANTS.or(DATA)).limits(1, 32767),
        ])
        .flags(&["M8029", "M8328", "M8329"])
        .errors(&[6706, 6708])
        .call(RtFn::Rbfm)
        .text("Copies n1 words of the buffer memory of module m1 from address m2 on to D, n2 words in each scan."),
    io("WBFM", 279, "Write to a module in parts")
        .source(FX3_MANUAL)
        .on(FX3U)
        .steps(11, 11)
        .takes(&[
            MODULE_FX,
            ADDRESS.also(DATA),
            src("S", DATA).per(3),
            number("n1").also(DATA),
            src("n2", CONSTANTS.or(DATA)).limits(1, 32767),
        ])
        .flags(&["M8029", "M8328", "M8329"])
        .errors(&[6706, 6708])
        .call(RtFn::Wbfm)
        .text("Copies n1 words from S on to the buffer memory of module m1 from address m2 on, n2 words in each scan."),
];
