//! Rotating, shifting and queues, FNC 30–39 and 212–214.

use super::row::*;
use super::{Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_models::ModelSet;
use rungc_rt::RtFn;

const H1U: ModelSet = ModelSet::H1U;

const ROTATED: Param = both("D", RESULTS).rules(&[Rule::WholeGroup]);
const ROTATE: &[Param] = &[
    ROTATED,
    count("n", 0, 16)
        .also_on(LIKE_FX3, DATA)
        .rules(&[Rule::WideLimits(0, 32)]),
];
const ROTATE_HM: &[Param] = &[
    ROTATED,
    count("n", 1, 16)
        .also(DATA)
        .checked()
        .rules(&[Rule::WideLimits(1, 32)]),
];
const ROTATE_INOVANCE: &[Param] = &[
    ROTATED,
    count("n", 1, 16)
        .checked()
        .rules(&[Rule::WideLimits(1, 32)]),
];
const ROTATE_CARRY_HM: &[Param] = &[
    ROTATED,
    count("n", 1, 15)
        .also(DATA)
        .checked()
        .rules(&[Rule::WideLimits(1, 31)]),
];

const fn shift_bits(n1: Param, n2: Param) -> [Param; 4] {
    [
        bit("S", SOURCE_BITS).per(3),
        coil("D", COILS).per(2).changed(),
        n1,
        n2,
    ]
}

const SHIFT_BITS: &[Param] = &shift_bits(
    count("n1", 1, 1024),
    count("n2", 0, 1024)
        .also_on(LIKE_FX3, DATA)
        .rules(&[Rule::AtMost(2)]),
);
const SHIFT_BITS_H1U: &[Param] = &shift_bits(
    count("n1", 1, 256).checked(),
    count("n2", 0, 256).rules(&[Rule::AtMost(2)]),
);
const SHIFT_BITS_HM: &[Param] = &shift_bits(
    count("n1", 1, 1024),
    count("n2", 1, 1024).rules(&[Rule::Below(2)]),
);

const fn shift_words(max: i64) -> [Param; 4] {
    [
        src("S", WORDS.without(INDEX)).per(3),
        both("D", RESULTS.without(INDEX))
            .per(2)
            .rules(&[Rule::SameDigits(0)]),
        count("n1", 1, max).checked(),
        count("n2", 0, max)
            .also_on(LIKE_FX3, DATA)
            .rules(&[Rule::AtMost(2)]),
    ]
}

const SHIFT_WORDS: &[Param] = &shift_words(2048);
const SHIFT_WORDS_FX: &[Param] = &shift_words(512);

const SHIFT_WORDS_HM: &[Param] = &[
    src("S", GROUPS.or(REGISTERS)).per(3),
    both("D", RESULT_GROUPS.or(REGISTERS))
        .per(2)
        .rules(&[Rule::SameDigits(0), Rule::WordsWith(0)]),
    count("n1", 1, 512)
        .checked()
        .rules(&[Rule::GroupAtMost(1, 64)]),
    count("n2", 1, 512).checked().rules(&[Rule::AtMost(2)]),
];

const fn enqueue(max: i64, rules: &'static [Rule]) -> [Param; 3] {
    [
        src("S", WORDS).also_on(LIKE_FX, CONSTANTS),
        both("D", RESULTS).per(2).rules(rules),
        count("n", 2, max).checked(),
    ]
}

const fn dequeue(max: i64, rules: &'static [Rule]) -> [Param; 3] {
    [
        both("S", RESULTS).per(2),
        dst("D", RESULTS).rules(rules),
        count("n", 2, max).checked(),
    ]
}

const ENQUEUE: &[Param] = &enqueue(2048, &[Rule::SameDigits(0)]);
const ENQUEUE_HM: &[Param] = &[
    src("S", GROUPS.or(REGISTERS)),
    both("D", RESULT_GROUPS.or(REGISTERS))
        .per_and(2, 1)
        .rules(&[Rule::SameDigits(0), Rule::GroupLike(0)]),
    count("n", 2, 512)
        .checked()
        .rules(&[Rule::GroupAtMost(1, 64)]),
];
const ENQUEUE_FX: &[Param] = &enqueue(512, &[]);
const DEQUEUE: &[Param] = &dequeue(2048, &[Rule::SameDigits(0)]);
const DEQUEUE_HM: &[Param] = &[
    both("S", GROUPS.or(REGISTERS)).per_and(2, 1),
    dst("D", RESULT_GROUPS.or(REGISTERS)).rules(&[Rule::SameDigits(0), Rule::GroupLike(0)]),
    count("n", 2, 512)
        .checked()
        .rules(&[Rule::GroupAtMost(0, 64)]),
];
const DEQUEUE_FX: &[Param] = &dequeue(512, &[]);

const fn rotate(name: &'static str, fnc: u16, title: &'static str, lower: Lower) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.4")
        .fnc(fnc)
        .on(NOT_FX1)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .takes(ROTATE)
        .flags(&["M8022"])
        .errors(&[6706, 6707])
        .lower(lower)
}

const fn shift(name: &'static str, fnc: u16, title: &'static str, function: RtFn) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.4")
        .fnc(fnc)
        .forms(W16_P)
        .steps(9, 9)
        .errors(&[6706, 6707])
        .call(function)
}

const fn queue(name: &'static str, fnc: u16, title: &'static str, function: RtFn) -> Inst {
    shift(name, fnc, title, function).steps(7, 7)
}

pub(super) const ROWS: &[Inst] = &[
    rotate("ROR", 30, "Rotate right", Lower::Values(ValueOp::RotateRight))
        .repeat(Repeat::Changes(0))
        .variants(&[on(HM).takes(ROTATE_HM), on(INOVANCE).takes(ROTATE_INOVANCE)])
        .text("Rotates D right by n bits. The bit that left last is also in M8022."),
    rotate("ROL", 31, "Rotate left", Lower::Values(ValueOp::RotateLeft))
        .repeat(Repeat::Changes(0))
        .variants(&[on(HM).takes(ROTATE_HM), on(INOVANCE).takes(ROTATE_INOVANCE)])
        .text("Rotates D left by n bits. The bit that left last is also in M8022."),
    rotate("RCR", 32, "Rotate right with carry", Lower::Call(RtFn::Rcr))
        .repeat(Repeat::Changes(0))
        .on(NOT_SMALL_FX)
        .variants(&[on(HM).takes(ROTATE_CARRY_HM), on(INOVANCE).takes(ROTATE_INOVANCE)])
        .text("Rotates the ring of D and M8022 right by n bits: bit 0 goes to M8022, M8022 to the top."),
    rotate("RCL", 33, "Rotate left with carry", Lower::Call(RtFn::Rcl))
        .repeat(Repeat::Changes(0))
        .on(NOT_SMALL_FX)
        .variants(&[on(HM).takes(ROTATE_CARRY_HM), on(INOVANCE).takes(ROTATE_INOVANCE)])
        .text("Rotates the ring of D and M8022 left by n bits: the top bit goes to M8022, M8022 to bit 0."),
    shift("SFTR", 34, "Shift bits right", RtFn::Sftr)
        .repeat(Repeat::Changes(1))
        .takes(SHIFT_BITS)
        .variants(&[on(H1U).takes(SHIFT_BITS_H1U), on(HM).takes(SHIFT_BITS_HM)])
        .text("Moves the n1 bits from D on by n2 places to lower numbers; the n2 bits from S on enter at the top."),
    shift("SFTL", 35, "Shift bits left", RtFn::Sftl)
        .repeat(Repeat::Changes(1))
        .takes(SHIFT_BITS)
        .variants(&[on(H1U).takes(SHIFT_BITS_H1U), on(HM).takes(SHIFT_BITS_HM)])
        .text("Moves the n1 bits from D on by n2 places to higher numbers; the n2 bits from S on enter at D."),
    shift("WSFR", 36, "Shift words right", RtFn::Wsfr)
        .repeat(Repeat::Changes(1))
        .on(NOT_FX1)
        .takes(SHIFT_WORDS)
        .variants(&[on(HM).takes(SHIFT_WORDS_HM), on(LIKE_FX).takes(SHIFT_WORDS_FX)])
        .text(
            "Moves the n1 words from D on by n2 places to lower numbers; the n2 words from S on enter at the top. Groups of bits are \
             words of their length.",
        ),
    shift("WSFL", 37, "Shift words left", RtFn::Wsfl)
        .repeat(Repeat::Changes(1))
        .on(NOT_FX1)
        .takes(SHIFT_WORDS)
        .variants(&[on(HM).takes(SHIFT_WORDS_HM), on(LIKE_FX).takes(SHIFT_WORDS_FX)])
        .text(
            "Moves the n1 words from D on by n2 places to higher numbers; the n2 words from S on enter at D. Groups of bits are words \
             of their length.",
        ),
    queue("SFWR", 38, "Append to a queue", RtFn::Sfwr)
        .repeat(Repeat::Changes(1))
        .takes(ENQUEUE)
        .variants(&[on(HM).takes(ENQUEUE_HM), on(LIKE_FX).takes(ENQUEUE_FX)])
        .flags(&["M8022"])
        .lower_on(&[(HM, Lower::Call(RtFn::SfwrHm))])
        .text(
            "D counts the entries of the queue D+1 … D+n-1; S is appended. If it is full, nothing happens and M8022 turns on. HM \
             enters at the front.",
        ),
    queue("SFRD", 39, "Take from a queue", RtFn::Sfrd)
        .repeat(Repeat::Changes(0))
        .takes(DEQUEUE)
        .variants(&[on(HM).takes(DEQUEUE_HM), on(LIKE_FX).takes(DEQUEUE_FX)])
        .flags(&["M8020"])
        .lower_on(&[(HM, Lower::Call(RtFn::SfrdHm))])
        .text("Copies S+1, the oldest entry of the queue that S counts, to D and moves the others down. If it is empty, M8020 turns on."),
    queue("POP", 212, "Take the newest entry", RtFn::Pop)
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .on(FX3U_L01S)
        .takes(DEQUEUE_FX)
        .flags(&["M8020"])
        .text("Copies the entry that SFWR wrote last to D and takes it off the queue that S counts."),
    queue("SFR", 213, "Shift a word right", RtFn::Sfr)
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .steps(5, 5)
        .on(FX3U_L01S)
        .takes(&[both("D", RESULTS), count("n", 0, 15).also(WORDS)])
        .flags(&["M8022"])
        .text("Shifts D right by n bits, filling with zeros. The bit that left last is in M8022."),
    queue("SFL", 214, "Shift a word left", RtFn::Sfl)
        .source(FX3_MANUAL)
        .repeat(Repeat::Changes(0))
        .steps(5, 5)
        .on(FX3U_L01S)
        .takes(&[both("D", RESULTS), count("n", 0, 15).also(WORDS)])
        .flags(&["M8022"])
        .text("Shifts D left by n bits, filling with zeros. The bit that left last is in M8022."),
];
