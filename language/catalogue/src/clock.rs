//! Clock instructions, FNC 160–169.

use super::row::*;
use super::{Inst, Lower, Param, Repeat};
use rungc_models::ModelSet;
use rungc_rt::RtFn;

const TIME: Param = src("S", PLACES).len(3);
/// Words of a clock. H1U and H2U also take V and Z.
const fn clock_words(param: Param, count: u32) -> Param {
    param.len(count).also_on(INOVANCE, INDEX)
}
/// Two times and their sum or difference.
const SUM: &[Param] = &[
    clock_words(src("S1", PLACES), 3),
    clock_words(src("S2", PLACES), 3),
    clock_words(dst("D", PLACES), 3),
];

const fn clock(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.12")
        .fnc(fnc)
        .on(NOT_HM)
        .forms(W16_P)
        .errors(&[6706])
}

pub(super) const ROWS: &[Inst] = &[
    clock("TCMP", 160, "Compare times")
        .steps(11, 11)
        .takes(&[
            src("S1", VALUES).limits(0, 23),
            src("S2", VALUES).limits(0, 59),
            src("S3", VALUES).limits(0, 59),
            TIME,
            coil("D", RESULT_BITS).len(3),
        ])
        .call(RtFn::Tcmp)
        .text(
            "Compares the time S1:S2:S3 with the hour, minute and second at S: D is on if it is later, D+1 if it is equal, D+2 if it is \
             earlier.",
        ),
    clock("TZCP", 161, "Zone compare of times")
        .steps(9, 9)
        .takes(&[
            src("S1", PLACES).len(3),
            src("S2", PLACES).len(3),
            TIME,
            coil("D", RESULT_BITS).len(3),
        ])
        .call(RtFn::Tzcp)
        .text("Compares the time at S with the period S1 to S2: D is on before S1, D+1 from S1 to S2, D+2 after S2. Each is hour, minute, second."),
    clock("TADD", 162, "Add times")
        .steps(7, 7)
        .takes(SUM)
        .flags(&["M8020", "M8022"])
        .errors(&[6706, 6707])
        .call(RtFn::Tadd)
        .text("Adds two times (hour, minute, second). Past 24:00:00 a day is taken off and M8022 is on; M8020 is on at 0:00:00."),
    clock("TSUB", 163, "Subtract times")
        .steps(7, 7)
        .takes(SUM)
        .flags(&["M8020", "M8021"])
        .errors(&[6706, 6707])
        .call(RtFn::Tsub)
        .text("Subtracts the time S2 from S1. Below 0:00:00 a day is added and M8021 is on; M8020 is on at 0:00:00."),
    clock("HTOS", 164, "Hours to seconds")
        .source(FX3_MANUAL)
        .repeat(Repeat::Same)
        .on(FX3U_L01S)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", GROUPS.or(PLACES)).word().len(3), dst("D", RESULT_GROUPS.or(PLACES))])
        .errors(&[6706, 6707])
        .call(RtFn::Htos)
        .text("D = the time at S (hour, minute, second) in seconds."),
    clock("STOH", 165, "Seconds to hours")
        .source(FX3_MANUAL)
        .on(FX3U_L01S)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(&[src("S", GROUPS.or(PLACES)), dst("D", RESULT_GROUPS.or(PLACES)).word().len(3)])
        .errors(&[6706, 6707])
        .call(RtFn::Stoh)
        .text("Writes the seconds S as hour, minute and second to D, D+1 and D+2."),
    clock("TRD", 166, "Read the clock")
        .steps(3, 3)
        .takes(&[clock_words(dst("D", PLACES), 7)])
        .flags(&["D8013", "D8014", "D8015", "D8016", "D8017", "D8018", "D8019"])
        .call(RtFn::Trd)
        .lower_on(&[(ModelSet::TWO_DIGIT_YEARS, Lower::Call(RtFn::TrdShort))])
        .text("Writes year (on L01S and FX its last two digits, or four after 2000 was written to D8018), month, day, hour, minute, second and weekday (0 is Sunday) to D and on."),
    clock("TWR", 167, "Set the clock")
        .steps(3, 3)
        .takes(&[clock_words(src("S", PLACES), 7)])
        .flags(&["D8013", "D8014", "D8015", "D8016", "D8017", "D8018", "D8019"])
        .call(RtFn::Twr)
        .lower_on(&[(ModelSet::TWO_DIGIT_YEARS, Lower::Call(RtFn::TwrShort))])
        .text("Sets the clock from seven words as TRD writes them. If one of them cannot be, nothing happens."),
    clock("HOUR", 169, "Hour meter")
        .forms(W16_W32)
        .steps(7, 13)
        .takes(&[src("S", VALUES), dst("D1", DATA).changed().len(2), coil("D2", RESULT_BITS)])
        .call(RtFn::Hour)
        .text(
            "Adds up how long it is driven: D1 full hours (32-bit: a pair), followed by the seconds of the current hour. D2 is on from S \
             hours on.",
        ),
];
