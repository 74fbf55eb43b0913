//! Handy instructions, FNC 60–69 and 149, and those that save the index registers.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_models::ModelSet;
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;

const INOVANCE_FX: ModelSet = INOVANCE.or(FX);

/// Rows times columns: operands 1 and 2.
fn table(constants: &[Option<i64>]) -> Option<u32> {
    constant(constants, 1)?.checked_mul(constant(constants, 2)?)
}

/// Twice n, operand 3.
fn pairs_of_n(constants: &[Option<i64>]) -> Option<u32> {
    constant(constants, 3)?.checked_mul(2)
}

const SEARCH: &[Param] = &[
    src("S1", WORDS).per(3),
    src("S2", VALUES),
    dst("D", RESULTS).len(5),
    src("n", CONSTANTS.or(DATA))
        .limits(1, 256)
        .rules(&[Rule::WideLimits(1, 128)]),
];

const fn absolute_drum(
    rules: &'static [Rule],
    counters: &'static [(DeviceClass, u32, u32)],
) -> [Param; 4] {
    [
        src("S1", GROUPS.or(PLACES)).len_of(pairs_of_n).rules(rules),
        src("S2", Classes::C)
            .numbers(counters)
            .rules(&[Rule::WideCounter]),
        coil("D", RESULT_BITS).per(3),
        count("n", 1, 64),
    ]
}

/// h1u-h2u-programming, FNC 62: no C255.
const ABSOLUTE_DRUM: &[Param] = &absolute_drum(
    &[Rule::WholeGroup, Rule::WideAligned(8)],
    &[(DeviceClass::C, 0, 254)],
);
/// JY992D88101 §5.7.3: groups of 8, in either form.
const ABSOLUTE_DRUM_FX: &[Param] = &absolute_drum(&[Rule::WholeGroup, Rule::GroupAligned(8)], &[]);

const fn handy(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.7")
        .fnc(fnc)
        .on(NOT_HM)
        .steps(9, 17)
        .errors(&[6706])
}

pub(super) const ROWS: &[Inst] = &[
    handy("IST", 60, "Initial state")
        .steps(7, 7)
        .uses(1)
        .takes(&[
            bit("S", Classes::X.or(Classes::Y).or(Classes::M)).len(8).plain(),
            coil("D1", Classes::S).plain().numbers(&[(DeviceClass::S, 20, 899)]),
            coil("D2", Classes::S).plain().numbers(&[(DeviceClass::S, 20, 899)]),
        ])
        .flags(&["M8040", "M8041", "M8042", "M8043", "M8044", "M8045", "M8047"])
        .example("LD M8000\nIST X010 S20 S40")
        .call(RtFn::Ist)
        .text(
            "Runs a step program by eight mode inputs from S on: manual, origin return, single step, one cycle, continuous, origin \
             start, automatic start, stop. Manual operation begins at S0, origin return at S1, automatic operation at S2; D1 to D2 \
             are the steps of automatic operation.",
        ),
    handy("SER", 61, "Search")
        .on(NOT_HM_FX1)
        .forms(ALL_FORMS)
        .takes(SEARCH)
        .errors(&[6706, 6707])
        .call(RtFn::Ser)
        .text(
            "Compares the n values from S1 on with S2 and writes: D how many are equal, D+1 and D+2 where the first and the last of \
             them stand, D+3 and D+4 where the smallest and the largest value stand (the last of several), counted from 0.",
        ),
    handy("ABSD", 62, "Absolute drum")
        .forms(W16_W32)
        .on(INOVANCE_FX)
        .takes(ABSOLUTE_DRUM)
        .variants(&[on(FX).takes(ABSOLUTE_DRUM_FX)])
        .call(RtFn::Absd)
        .text(
            "Bit D+i is on while counter S2 is from the value S1+2i up to below S1+2i+1; a pair in falling order means the range round \
             the end.",
        ),
    handy("INCD", 63, "Incremental drum")
        .on(INOVANCE_FX)
        .takes(&[
            src("S1", GROUPS.or(PLACES)).per(3).rules(&[Rule::WholeGroup]),
            both("S2", Classes::C).len(2).numbers(&[(DeviceClass::C, 0, 198)]),
            coil("D", RESULT_BITS).per(3),
            count("n", 1, 64),
        ])
        .flags(&["M8029"])
        .call(RtFn::Incd)
        .text(
            "One of the n bits from D on is on; when counter S2 reaches the value for it, S2 starts again, S2+1 counts on and the next \
             bit takes over. M8029 is on for a scan after the last.",
        ),
    handy("TTMR", 64, "Teaching timer")
        .on(BIG)
        .steps(5, 5)
        .takes(&[dst("D", DATA).len(2), count("n", 0, 2).also_on(LIKE_FX3, DATA)])
        .call(RtFn::Ttmr)
        .text("Measures how long it is driven: D in s × 10^n, which stays, D+1 in 100 ms, which goes back to 0."),
    handy("STMR", 65, "Special timer")
        .on(BIG)
        .steps(7, 7)
        .takes(&[
            dst("S", Classes::T).word().changed().plain().numbers(&[(DeviceClass::T, 0, 199)]),
            count("m", 1, 32767).also_on(LIKE_FX3, DATA),
            coil("D", RESULT_BITS).len(4),
        ])
        .call(RtFn::Stmr)
        .text(
            "Four delays of m × 100 ms by timer S: D goes off that long after the drive, D+1 is on that long after it, D+2 is on that \
             long from its beginning, D+3 turns on and off that long after it.",
        ),
    handy("ALT", 66, "Alternate")
        .repeat(Repeat::Changes(0))
        .forms(W16_P)
        .on(ModelSet::ALL)
        .variants(&[on(HM).forms(W16).takes(&[coil("D", COILS).changed().plain()])])
        .steps(3, 3)
        .takes(&[coil("D", RESULT_BITS).changed()])
        .lower(Lower::Values(ValueOp::Alternate))
        .text("Inverts D at each execution."),
    handy("RAMP", 67, "Ramp")
        .takes(&[
            src("S1", DATA),
            src("S2", DATA),
            dst("D", DATA).len(2).changed(),
            count("n", 1, 32767).also_on(LIKE_FX3, DATA),
        ])
        .flags(&["M8026", "M8029"])
        .call(RtFn::Ramp)
        .text(
            "Moves D from S1 to S2 within n scans; D+1 counts them. M8029 is on at the end. It then starts again; with M8026 on it \
             stays there.",
        ),
    handy("ROTC", 68, "Rotary table")
        .on(BIG.without(L01S))
        .uses(1)
        .takes(&[
            both("S", DATA).len(3),
            count("m1", 2, 32767),
            count("m2", 0, 32767).rules(&[Rule::AtMost(1)]),
            coil("D", RESULT_BITS).len(8).changed(),
        ])
        .call(RtFn::Rotc)
        .text(
            "Turns a table of m1 positions, m2 of them slow ones. S counts, S+1 is the window, S+2 the wanted piece. D, D+1 and D+2 are \
             the phases and the zero position; D+3 … D+7 fast and slow forward, stop, slow and fast backward.",
        ),
    handy("SORT", 69, "Sort a table")
        .on(BIG)
        .steps(11, 11)
        .takes(&[
            src("S", DATA).len_of(table),
            count("m1", 1, 32),
            count("m2", 1, 6),
            dst("D", DATA).len_of(table),
            src("n", CONSTANTS.or(DATA)).limits(1, 6).rules(&[Rule::AtMost(2)]),
        ])
        .flags(&["M8029"])
        .errors(&[6706, 6707])
        .call(RtFn::Sort)
        .text(
            "Sorts the m1 rows of the table at S, which has m2 columns stored one after the other, by column n and writes it to D. It takes \
             m1 scans; M8029 is on at the end.",
        ),
    handy("SORT2", 149, "Sort a table by rows")
        .source(FX3_MANUAL)
        .forms(W16_W32)
        .steps(11, 21)
        .on(FX3U_L01S)
        .takes(&[
            src("S", DATA).len_of(table),
            src("m1", CONSTANTS.or(DATA)).limits(1, 32),
            count("m2", 1, 6),
            dst("D", DATA).len_of(table),
            src("n", CONSTANTS.or(DATA)).limits(1, 6).rules(&[Rule::AtMost(2)]),
        ])
        .flags(&["M8029", "M8165"])
        .call(RtFn::Sort2)
        .text(
            "Sorts the m1 rows of the table at S, which are stored one after the other with m2 columns each, by column n and writes it to D; \
             descending with M8165 on. It takes m1 scans; M8029 is on at the end.",
        ),
    handy("ZPUSH", 102, "Save the index registers")
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .forms(W16_P)
        .steps(3, 3)
        .on(FX3U_L01S)
        .takes(&[both("D", DATA).open_ended()])
        .call(RtFn::Zpush)
        .text("Saves V0–V7 and Z0–Z7 in the stack at D: D counts its levels, 16 words each."),
    handy("ZPOP", 103, "Restore the index registers")
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .forms(W16_P)
        .steps(3, 3)
        .on(FX3U_L01S)
        .takes(&[both("D", DATA).open_ended()])
        .call(RtFn::Zpop)
        .text("Takes V0–V7 and Z0–Z7 back from the stack at D that ZPUSH filled."),
    handy("RND", 184, "Random number")
        .source(FX3_MANUAL)
        .forms(W16_P)
        .steps(3, 3)
        .on(FX3U_L01S)
        .takes(&[dst("D", RESULT_GROUPS.or(PLACES)).also_on(L01S, INDEX)])
        .flags(&["D8310", "D8311"])
        .call(RtFn::Rnd)
        .text("D = a pseudo-random number from 0 to 32767, from the state in D8311 and D8310."),
    handy("DUTY", 186, "Timing pulse")
        .source(FX3_MANUAL)
        .steps(7, 7)
        .on(FX3U)
        .takes(&[
            src("n1", CONSTANTS.or(REGISTERS)).limits(0, 32767),
            src("n2", CONSTANTS.or(REGISTERS)).limits(0, 32767),
            coil("D", Classes::M).plain().numbers(&[(DeviceClass::M, 8330, 8334)]),
        ])
        .flags(&[
            "M8330", "M8331", "M8332", "M8333", "M8334", "D8330", "D8331", "D8332", "D8333", "D8334",
        ])
        .call(RtFn::Duty)
        .text("D, one of M8330–M8334, is on for n1 scans and off for n2 scans, in turn."),
];
