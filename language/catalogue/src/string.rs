//! Text instructions, FNC 182 and 200–209, and decimal text, FNC 260 and 261.

use super::row::*;
use super::{Classes, Inst, Lower, Repeat};
use rungc_rt::RtFn;

const TEXTS: Classes = GROUPS.or(PLACES).or(Classes::TEXT);
const TEXT_RESULTS: Classes = RESULT_GROUPS.or(PLACES);

const fn string(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "public knowledge of FX3U")
        .fnc(fnc)
        .on(FX3U_L01S)
        .forms(W16_P)
        .steps(7, 7)
        .errors(&[6706])
}

pub(super) const ROWS: &[Inst] = &[
    string("COMRD", 182, "Read a device's comment")
        .repeat(Repeat::Same)
        .steps(5, 5)
        .on(FX3U)
        .takes(&[
            mixed("S", BITS.or(REGISTERS)).plain(),
            text_out("D", REGISTERS).len(9),
        ])
        .flags(&["M8091"])
        .lower(Lower::Comment)
        .text("Writes the comment of device S, 16 characters filled up with spaces, to D. Comments are those of the project."),
    string("STR", 200, "Integer to text")
        .forms(ALL_FORMS)
        .steps(7, 13)
        .takes(&[
            src("S1", REGISTERS).word().len(2),
            src("S2", VALUES),
            text_out("D", REGISTERS).len(7),
        ])
        .call(RtFn::Str)
        .text("Writes S2 as decimal text to D: S1 characters in all, S1+1 of them decimals. A zero byte ends it."),
    string("VAL", 201, "Text to integer")
        .repeat(Repeat::Same)
        .forms(ALL_FORMS)
        .steps(7, 13)
        .takes(&[
            text("S", REGISTERS).len(7),
            dst("D1", REGISTERS).word().len(2),
            dst("D2", RESULT_GROUPS.or(PLACES)),
        ])
        .call(RtFn::Val)
        .text("Reads the decimal text at S: D2 is its number without the point, D1 how many characters it has, D1+1 how many decimals."),
    string("$+", 202, "Join texts")
        .takes(&[
            text("S1", TEXTS).open_ended(),
            text("S2", TEXTS).open_ended(),
            text_out("D", TEXT_RESULTS).open_ended(),
        ])
        .call(RtFn::StrAdd)
        .text("Writes the text S1 followed by the text S2 to D. A zero byte ends a text."),
    string("LEN", 203, "Length of a text")
        .steps(5, 5)
        .takes(&[text("S", GROUPS.or(PLACES)).open_ended(), dst("D", TEXT_RESULTS)])
        .call(RtFn::Len)
        .text("D = how many bytes the text at S has before its zero byte."),
    string("RIGHT", 204, "End of a text")
        .repeat(Repeat::Same)
        .takes(&[
            text("S", GROUPS.or(PLACES)).open_ended(),
            text_out("D", TEXT_RESULTS).open_ended(),
            src("n", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
        ])
        .call(RtFn::Right)
        .text("Writes the last n characters of the text at S to D."),
    string("LEFT", 205, "Beginning of a text")
        .repeat(Repeat::Same)
        .takes(&[
            text("S", GROUPS.or(PLACES)).open_ended(),
            text_out("D", TEXT_RESULTS).open_ended(),
            src("n", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
        ])
        .call(RtFn::Left)
        .text("Writes the first n characters of the text at S to D."),
    string("MIDR", 206, "Middle of a text")
        .takes(&[
            text("S1", GROUPS.or(PLACES)).open_ended(),
            text_out("D", TEXT_RESULTS).open_ended(),
            src("S2", GROUPS.or(PLACES)).len(2),
        ])
        .call(RtFn::Midr)
        .text("Writes the S2+1 characters of the text at S1 from character S2 on, counted from 1, to D; -1 means up to its end."),
    string("MIDW", 207, "Replace in a text")
        .takes(&[
            text("S1", GROUPS.or(PLACES)).open_ended(),
            text_out("D", TEXT_RESULTS).open_ended().changed(),
            src("S2", GROUPS.or(PLACES)).len(2),
        ])
        .call(RtFn::Midw)
        .text("Overwrites S2+1 characters of the text at D from character S2 on, counted from 1, with the start of the text at S1."),
    string("INSTR", 208, "Search in a text")
        .repeat(Repeat::Same)
        .steps(9, 9)
        .takes(&[
            text("S1", REGISTERS.or(Classes::TEXT)).open_ended(),
            text("S2", REGISTERS).open_ended(),
            dst("D", REGISTERS),
            src("n", CONSTANTS.or(DATA)).rules(COUNTED),
        ])
        .call(RtFn::Instr)
        .text("D = the position of the text S1 in the text at S2, searched from character n, counted from 1; 0 if not found."),
    string("$MOV", 209, "Move a text")
        .repeat(Repeat::Shifting)
        .steps(5, 5)
        .takes(&[text("S", TEXTS).open_ended(), text_out("D", TEXT_RESULTS).open_ended()])
        .call(RtFn::StrMov)
        .text("Copies the text S with its zero byte to D."),
    string("DABIN", 260, "Decimal text to integer")
        .repeat(Repeat::Same)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[text("S", REGISTERS).len(6), dst("D", RESULT_GROUPS.or(PLACES).or(INDEX))])
        .call(RtFn::Dabin)
        .text("Reads the sign and five (32-bit: ten) digits at S, spaces counting as 0."),
    string("BINDA", 261, "Integer to decimal text")
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", VALUES), text_out("D", REGISTERS).len(7)])
        .flags(&["M8091"])
        .call(RtFn::Binda)
        .text("Writes S as a sign and five (32-bit: ten) digits, leading zeros as spaces, to D. With M8091 off a zero word follows."),
];
