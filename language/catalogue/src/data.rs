//! Data processing, FNC 40–49 and 140–144.

use super::row::*;
use super::{Classes, Inst, Lower, Param, Repeat, Rule, ValueOp};
use rungc_models::ModelSet;
use rungc_models::runs::is_counter32;
use rungc_rt::RtFn;
use rungc_syntax::{DeviceClass, OperandKind};

/// FX1S, FX1N, FX3S and HM have no annunciators.
const WITH_ANNUNCIATORS: ModelSet = NOT_HM_FX1.without(ModelSet::FX3S);
const RESETTABLE: Classes = COILS.or(PLACES);
const VALUE_OR_BITS: Classes = BITS.or(PLACES).or(INDEX);

/// A range cannot contain both 16-bit and 32-bit counters.
const COUNTERS_ALIKE: Rule = Rule::Holds(
    |operands| {
        let mut wide = operands.iter().filter_map(|operand| match operand.kind {
            OperandKind::Device(device, _) if device.class == DeviceClass::C => {
                Some(is_counter32(device.class, device.number))
            }
            _ => None,
        });
        wide.next()
            .is_none_or(|first| wide.all(|other| other == first))
    },
    "both counters have 16 bits, or both 32: divide the range",
);

/// The number n of DECO and ENCO, 0 to 8 on FX (JY992D48301 §5.5.2, §5.5.3; JY997D16601 §12.2, §12.3).
const CODED_BITS: Param = count("n", 0, 8).also_on(LIKE_FX3, DATA);

/// A word has sixteen bits, so the number that says which is at most 4 bits long.
macro_rules! at_most_4_of_a_word {
    ($word:literal) => {
        Rule::Holds(
            |operands| {
                let coded = operands
                    .get($word)
                    .map(|operand| Classes::of(&operand.kind));
                let word = coded.is_some_and(|classes| !COILS.or(Classes::X).meets(classes));
                let n = operands.get(2).and_then(|operand| operand.kind.constant());
                !word || n.is_none_or(|n| n <= 4)
            },
            "at most 4 where a word holds the bits",
        )
    };
}

/// Other numbers of words are an error each time (h1u-h2u-programming, FNC 45).
const MEAN_OF: &[Rule] = &[Rule::WorksWith(1, 64)];
const MEAN: &[Param] = &[
    src("S", WORDS).per(2),
    dst("D", RESULTS),
    src("n", CONSTANTS)
        .word()
        .also_on(LIKE_FX3, DATA)
        .rules(MEAN_OF),
];
/// With M8490 on, the sum follows the mean.
const MEAN_INOVANCE: &[Param] = &[
    src("S", WORDS).per(2),
    dst("D", RESULTS).len(3),
    src("n", CONSTANTS).word().rules(MEAN_OF),
];
const MEAN_HM: &[Param] = &[src("S", WORDS).per(2), dst("D", RESULTS), count("n", 1, 64)];
const ROOT: &[Param] = &[
    src("S", CONSTANTS.or(DATA_PLACES)).rules(NOT_NEGATIVE),
    dst("D", DATA_PLACES),
];
/// On HM the root of a negative number is 0.
const ROOT_HM: &[Param] = &[src("S", CONSTANTS.or(DATA_PLACES)), dst("D", DATA_PLACES)];
const TO_FLOAT: &[Param] = &[src("S", DATA_PLACES), real_out("D", DATA_PLACES)];
const TO_FLOAT_HM: &[Param] = &[src("S", CONSTANTS.or(DATA)), real_out("D", DATA)];

/// The constant n, operand 2.
fn n_bits(constants: &[Option<i64>]) -> Option<u32> {
    Some(constant(constants, 2)?.max(1))
}

/// Two to the power of the constant n, operand 2.
fn bits_of_n(constants: &[Option<i64>]) -> Option<u32> {
    1u32.checked_shl(constant(constants, 2)?)
}

/// Words that hold n bytes, operand 2.
fn words_of_n_bytes(constants: &[Option<i64>]) -> Option<u32> {
    Some(constant(constants, 2)?.div_ceil(2))
}

const fn data(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.5")
        .fnc(fnc)
        .forms(ALL_FORMS)
        .steps(5, 9)
        .errors(&[6706])
}

pub(super) const ROWS: &[Inst] = &[
    data("ZRST", 40, "Reset a range")
        .forms(W16_P)
        .takes(&[
            mixed_out("D1", RESETTABLE).through(1),
            mixed_out("D2", RESETTABLE).rules(&[Rule::ClassLike(0), COUNTERS_ALIKE]),
        ])
        .variants(&[
            on(INOVANCE).takes(&[
                mixed_out("D1", RESETTABLE).through(1),
                mixed_out("D2", RESETTABLE).rules(&[Rule::ClassLike(0), COUNTERS_ALIKE, Rule::NotBefore(0)]),
            ]),
            on(HM).takes(&[
            mixed_out("D1", RESETTABLE).through(1),
            mixed_out("D2", RESETTABLE).rules(&[Rule::ClassLike(0), Rule::NotBefore(0)]),
        ])])
        .errors(&[6706, 6707])
        .call(RtFn::Zrst)
        .text("Switches D1 … D2 off, or sets them to 0; timers and counters also open their contacts. Both are of one class."),
    data("DECO", 41, "Decode")
        .repeat(Repeat::Replacing)
        .forms(W16_P)
        .steps(7, 7)
        .on(NOT_HM)
        .takes(&[
            mixed("S", VALUE_OR_BITS).bits_of(n_bits),
            mixed_out("D", COILS.or(PLACES)).bits_of(bits_of_n),
            src("n", CONSTANTS)
                .word()
                .rules(&[Rule::WorksWith(0, 8), Rule::WordWorksTo(1, 4)]),
        ])
        .variants(&[on(LIKE_FX).takes(&[
            mixed("S", VALUE_OR_BITS.or(CONSTANTS)).bits_of(n_bits),
            mixed_out("D", COILS.or(PLACES)).bits_of(bits_of_n),
            CODED_BITS.rules(&[at_most_4_of_a_word!(1)]),
        ])])
        .errors(&[6706, 6707])
        .call(RtFn::Deco)
        .text(
            "Takes the low n bits of S (of bits: the n bits from S on) as a number and switches the bit of that number on, counted \
             from D (of a word: in D), and the other bits of the 2^n off. n is 1 to 8, with a word as D to 4; 0 does nothing.",
        ),
    data("ENCO", 42, "Encode")
        .repeat(Repeat::Replacing)
        .forms(W16_P)
        .steps(7, 7)
        .on(NOT_HM)
        .takes(&[
            mixed("S", VALUE_OR_BITS).bits_of(bits_of_n),
            dst("D", PLACES.or(INDEX)),
            src("n", CONSTANTS)
                .word()
                .rules(&[Rule::WorksWith(0, 8), Rule::WordWorksTo(0, 4)]),
        ])
        .variants(&[on(LIKE_FX).takes(&[
            mixed("S", VALUE_OR_BITS).bits_of(bits_of_n),
            dst("D", PLACES.or(INDEX)),
            CODED_BITS.rules(&[at_most_4_of_a_word!(0)]),
        ])])
        .errors(&[6706, 6707])
        .call(RtFn::Enco)
        .lower_on(&[(LIKE_FX, Lower::Call(RtFn::EncoZero))])
        .text(
            "Writes to D which is the highest of the 2^n bits from S on (of a word: in S) that is on, counted from 0. None on is an \
             error; on FX and L01S, D is 0 then. n is 1 to 8, with a word as S to 4; 0 does nothing.",
        ),
    data("SUM", 43, "Count bits")
        .on(NOT_HM_FX1)
        .takes(&[src("S", VALUES), dst("D", RESULTS)])
        .flags(&["M8020"])
        .lower(Lower::Values(ValueOp::CountOnes))
        .text("D = how many bits of S are on. M8020 is on if none is."),
    data("BON", 44, "Test a bit")
        .repeat(Repeat::Same)
        .on(NOT_HM_FX1)
        .steps(7, 13)
        .takes(&[
            src("S", VALUES),
            coil("D", RESULT_BITS),
            count("n", 0, 15)
                .also_on(LIKE_FX3, DATA)
                .rules(&[Rule::WideLimits(0, 31)]),
        ])
        .lower(Lower::Values(ValueOp::TestBit))
        .text("D = bit n of S, counted from 0."),
    data("MEAN", 45, "Mean")
        .on(NOT_FX1)
        .steps(7, 13)
        .takes(MEAN)
        .variants(&[on(INOVANCE).takes(MEAN_INOVANCE), on(HM).takes(MEAN_HM)])
        .flags(&["M8490"])
        .errors(&[6706, 6707])
        .call(RtFn::Mean)
        .lower_on(&[(INOVANCE, Lower::Call(RtFn::MeanSum))])
        .text(
            "D = the mean of n words (32-bit: pairs) from S on, without its fraction; n is 1 to 64. H1U and H2U with M8490 on also \
             write the sum to D+1 and D+2 in the 16-bit form.",
        ),
    data("ANS", 46, "Set an annunciator")
        .forms(W16)
        .steps(7, 7)
        .on(WITH_ANNUNCIATORS)
        .takes(&[
            dst("S", Classes::T).word().changed().plain().numbers(&[(DeviceClass::T, 0, 199)]),
            count("m", 1, 32767).also_on(LIKE_FX3, DATA),
            coil("D", Classes::S).plain().numbers(&[(DeviceClass::S, 900, 999)]),
        ])
        .flags(&["M8048", "M8049", "D8049"])
        .call(RtFn::Ans)
        .text("Switches annunciator D on when it has been driven for m × 100 ms; D stays on. Timer S measures and is 0 otherwise."),
    data("ANR", 47, "Reset an annunciator")
        .forms(W16_P)
        .steps(1, 1)
        .on(WITH_ANNUNCIATORS)
        .flags(&["M8048", "D8049"])
        .call(RtFn::Anr)
        .text("Switches the lowest annunciator of S900–S999 that is on off; at each execution one."),
    data("SQR", 48, "Square root")
        .on(NOT_SMALL_FX)
        .takes(ROOT)
        .variants(&[on(HM).takes(ROOT_HM)])
        .flags(&["M8020", "M8021"])
        .errors(&[6706, 6707])
        .lower(Lower::Values(ValueOp::Root { clamps: false }))
        .lower_on(&[(HM, Lower::Values(ValueOp::Root { clamps: true }))])
        .text(
            "D = the square root of S without its fraction. M8021 is on if there was one, M8020 if D is 0. A negative S is an error; \
             on HM it gives 0.",
        ),
    data("FLT", 49, "Integer to float")
        .on(NOT_FX1)
        .takes(TO_FLOAT)
        .variants(&[on(HM).takes(TO_FLOAT_HM)])
        .call(RtFn::Flt)
        .text("Writes S as a float to the pair D."),
    data("WSUM", 140, "Sum of a block")
        .source(FX3_MANUAL)
        .steps(7, 13)
        .on(FX3U_L01S)
        .takes(&[
            src("S", PLACES).per(2),
            dst("D", PLACES).len(2),
            src("n", CONSTANTS.or(DATA)).rules(COUNTED),
        ])
        .errors(&[6706, 6707])
        .call(RtFn::Wsum)
        .text("D = the sum of n words (32-bit: pairs) from S on, in double width."),
    data("WTOB", 141, "Words to bytes")
        .source(FX3_MANUAL)
        .forms(W16_P)
        .steps(7, 7)
        .on(FX3U_L01S)
        .takes(&[
            src("S", REGISTERS).len_of(words_of_n_bytes),
            dst("D", REGISTERS).per(2),
            src("n", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
        ])
        .errors(&[6706, 6707])
        .call(RtFn::Wtob)
        .text("Writes the n bytes from S on, low byte first, one to each word from D on."),
    data("BTOW", 142, "Bytes to words")
        .source(FX3_MANUAL)
        .forms(W16_P)
        .steps(7, 7)
        .on(FX3U_L01S)
        .takes(&[
            src("S", REGISTERS).per(2),
            dst("D", REGISTERS).len_of(words_of_n_bytes),
            src("n", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
        ])
        .errors(&[6706, 6707])
        .call(RtFn::Btow)
        .text("Packs the low bytes of n words from S on two to a word from D on, low byte first."),
    data("UNI", 143, "Unite nibbles")
        .source(FX3_MANUAL)
        .repeat(Repeat::Same)
        .forms(W16_P)
        .steps(7, 7)
        .on(FX3U_L01S)
        .takes(&[src("S", REGISTERS).per(2), dst("D", REGISTERS), count("n", 0, 4).also(DATA)])
        .errors(&[6706, 6707])
        .call(RtFn::Uni)
        .text("Packs the low four bits of n words from S on into D, the first lowest; the other bits of D are 0."),
    data("DIS", 144, "Separate nibbles")
        .source(FX3_MANUAL)
        .forms(W16_P)
        .steps(7, 7)
        .on(FX3U_L01S)
        .takes(&[src("S", REGISTERS), dst("D", REGISTERS).per(2), count("n", 0, 4).also(DATA)])
        .errors(&[6706, 6707])
        .call(RtFn::Dis)
        .text("Writes the lowest n groups of four bits of S one to each word from D on."),
];
