//! Basic instructions and the step ladder.

use super::row::*;
use super::{Basic, Classes, Drive, Inst, Lower, Param, Role, Shape, Variant};
use rungc_models::ModelSet;
use rungc_syntax::DeviceClass;

/// A relay that is not special.
const ORDINARY_M: &[(DeviceClass, u32, u32)] = &[(DeviceClass::M, 0, 7999)];
const M: Classes = Classes::M;
const S: Classes = Classes::S;
const T: Classes = Classes::T;
const C: Classes = Classes::C;
const BIT_OF_WORD: Classes = Classes::WORD_BIT;
/// The models that count steps as FX2N does.
const LIKE_FX2N: ModelSet = INOVANCE.or(ModelSet::FX1).or(ModelSet::FX2N);

/// Beyond the last of a class: what does not exist is reported as such, and its other operands are taken for what they
/// are meant to be.
const ANY: u32 = u32::MAX;

/// Devices that the basic instructions of FX3U do not index: states, special relays, 32-bit counters, bits of words and
/// words (FX3 programming manual §5.7, §7.13). Other models index in applied instructions only.
const DIRECT: &[(DeviceClass, u32, u32)] = &[
    (DeviceClass::S, 0, ANY),
    (DeviceClass::M, 8000, ANY),
    (DeviceClass::C, 200, ANY),
    (DeviceClass::D, 0, ANY),
    (DeviceClass::R, 0, ANY),
    (DeviceClass::V, 0, ANY),
    (DeviceClass::Z, 0, ANY),
];

/// An index register takes the long operand, as bits of words and relays from M3584 on do. Coils of timers and counters
/// have a preset, too.
const INDEXED: Variant = indexed(FX3U).steps(3, 3);

const CONTACT: &[Param] = &[bit("S", CONTACTS).plain()];
/// FX3U: contacts of bits of words, and index registers.
const CONTACT_3U: &[Param] = &[bit("S", CONTACTS.or(BIT_OF_WORD)).unindexed(DIRECT)];

const fn basic(name: &'static str, title: &'static str, basic: Basic) -> Inst {
    row(name, title, "h1u-h2u-programming §4.2").lower(Lower::Basic(basic))
}

const fn contact(name: &'static str, title: &'static str, which: Basic) -> Inst {
    const VARIANTS: &[Variant] = &[
        on(FX3U).takes(CONTACT_3U),
        INDEXED,
        first(FX3U, BIT_OF_WORD).steps(3, 3),
        first_in(LIKE_FX3, M, 3584, 7679).steps(3, 3),
        first_in(NOT_HM, M, 1536, 3583).steps(2, 2),
        first_in(LIKE_FX3, M, 8256, 8511).steps(2, 2),
        first_in(LIKE_FX3, S, 1024, 4095).steps(2, 2),
        on(HM).steps(2, 2),
    ];
    basic(name, title, which)
        .takes(CONTACT)
        .variants(VARIANTS)
        .drive(Drive::Logic)
}

const fn edge(name: &'static str, title: &'static str, which: Basic) -> Inst {
    const VARIANTS: &[Variant] = &[
        on(FX3U).takes(CONTACT_3U),
        INDEXED,
        first(FX3U, BIT_OF_WORD).steps(3, 3),
        first_in(LIKE_FX3, M, 3584, 7679).steps(3, 3),
    ];
    basic(name, title, which)
        .steps(2, 2)
        .takes(CONTACT)
        .variants(VARIANTS)
        .drive(Drive::Logic)
}

const fn logic(name: &'static str, title: &'static str, which: Basic) -> Inst {
    basic(name, title, which).drive(Drive::Logic)
}

const PULSED: &[Param] = &[coil("D", Classes::Y.or(M)).plain().numbers(ORDINARY_M)];
const PULSED_3U: &[Param] = &[coil("D", Classes::Y.or(M)).numbers(ORDINARY_M)];

const fn pulse(name: &'static str, title: &'static str, which: Basic) -> Inst {
    const VARIANTS: &[Variant] = &[
        on(FX3U).takes(PULSED_3U),
        INDEXED,
        first_in(LIKE_FX3, M, 3584, 7679).steps(3, 3),
    ];
    basic(name, title, which)
        .steps(2, 2)
        .takes(PULSED)
        .variants(VARIANTS)
}

/// Steps of coils and of SET and RST on bits.
const BIT_STEPS: [Variant; 7] = [
    INDEXED,
    first(FX3U, BIT_OF_WORD).steps(3, 3),
    first_in(LIKE_FX3, M, 3584, 7679).steps(3, 3),
    first_in(NOT_HM, M, 1536, 7999).steps(2, 2),
    first_in(NOT_HM, M, 8000, 8511).steps(2, 2),
    first(NOT_HM, S).steps(2, 2),
    first(HM, COILS).steps(2, 2),
];

const fn preset(classes: Classes) -> Param {
    src("preset", classes).shape(Shape::Word).limits(0, 32767)
}

const fn preset_32(classes: Classes) -> Param {
    src("preset", classes).shape(Shape::Pair)
}

const KD: Classes = Classes::K.or(Classes::D);
const KDR: Classes = KD.or(Classes::R);
const KHDR: Classes = KDR.or(Classes::H);

/// Coils of FX3U: bits of words, and index registers.
const COIL_3U: &[Param] = &[coil("D", COILS.or(BIT_OF_WORD)).unindexed(DIRECT)];

const OUT: &[Variant] = &[
    first(LIKE_FX2N, T)
        .steps(3, 3)
        .takes(&[coil("D", T).plain(), preset(KD).plain()]),
    first(FX3U, T)
        .steps(3, 3)
        .takes(&[coil("D", T), preset(KDR)]),
    first(LIKE_FX3, T)
        .steps(3, 3)
        .takes(&[coil("D", T).plain(), preset(KDR).plain()]),
    first(HM, T)
        .steps(5, 5)
        .takes(&[coil("D", T).plain(), preset(KHDR).plain()]),
    first_in(LIKE_FX2N, C, 0, 199)
        .steps(3, 3)
        .takes(&[coil("D", C).plain(), preset(KD).plain()]),
    first_in(FX3U, C, 0, 199)
        .steps(3, 3)
        .takes(&[coil("D", C), preset(KDR)]),
    first_in(LIKE_FX3, C, 0, 199)
        .steps(3, 3)
        .takes(&[coil("D", C).plain(), preset(KDR).plain()]),
    first_in(HM, C, 0, 199)
        .steps(5, 5)
        .takes(&[coil("D", C).plain(), preset(KHDR).plain()]),
    first_in(LIKE_FX2N, C, 200, ANY)
        .steps(5, 5)
        .takes(&[coil("D", C).plain(), preset_32(KD).plain()]),
    first_in(FX3U, C, 200, ANY)
        .steps(5, 5)
        .takes(&[coil("D", C).unindexed(DIRECT), preset_32(KDR)]),
    first_in(LIKE_FX3, C, 200, ANY)
        .steps(5, 5)
        .takes(&[coil("D", C).plain(), preset_32(KDR).plain()]),
    first_in(HM, C, 200, ANY)
        .steps(7, 7)
        .takes(&[coil("D", C).plain(), preset_32(KHDR).plain()]),
    on(FX3U).takes(COIL_3U),
    BIT_STEPS[0],
    BIT_STEPS[1],
    BIT_STEPS[2],
    BIT_STEPS[3],
    BIT_STEPS[4],
    BIT_STEPS[5],
    BIT_STEPS[6],
];

const SET: &[Variant] = &[
    on(FX3U).takes(COIL_3U),
    BIT_STEPS[0],
    BIT_STEPS[1],
    BIT_STEPS[2],
    BIT_STEPS[3],
    BIT_STEPS[4],
    BIT_STEPS[5],
    BIT_STEPS[6],
];

const RESETTABLE: Classes = COILS.or(REGISTERS).or(INDEX);

const fn reset(classes: Classes) -> Param {
    Param {
        role: Role::Write,
        ..bit("D", classes).shape(Shape::Mixed)
    }
}

const RST: &[Variant] = &[
    on(FX3U).takes(&[reset(RESETTABLE.or(BIT_OF_WORD)).unindexed(DIRECT)]),
    INDEXED,
    first(NOT_HM, T.or(C)).steps(2, 2),
    first(HM, REGISTERS).steps(3, 3),
    first(ModelSet::ALL, DATA.or(INDEX)).steps(3, 3),
    BIT_STEPS[0],
    BIT_STEPS[1],
    BIT_STEPS[2],
    BIT_STEPS[3],
    BIT_STEPS[4],
    BIT_STEPS[5],
    BIT_STEPS[6],
];

pub(super) const ROWS: &[Inst] = &[
    contact("LD", "Load a contact", Basic::Ld).example("LD X000\nOUT Y000")
        .text("Begins a block of contacts with the state of S."),
    contact("LDI", "Load an inverted contact", Basic::Ldi).example("LDI X000\nOUT Y000")
        .text("Begins a block of contacts with the inverted state of S."),
    edge("LDP", "Load a rising edge", Basic::Ldp)
        .fnc(90)
        .example("LDP X000\nSET Y000")
        .text("Begins a block of contacts; on for the one scan in which S has come on."),
    edge("LDF", "Load a falling edge", Basic::Ldf)
        .fnc(91)
        .example("LDF X000\nRST Y000")
        .text("Begins a block of contacts; on for the one scan in which S has gone off."),
    contact("AND", "Series contact", Basic::And).example("LD X000\nAND X001\nOUT Y000")
        .text("The result and S."),
    contact("ANI", "Inverted series contact", Basic::Ani).example("LD X000\nANI X001\nOUT Y000")
        .text("The result and not S."),
    edge("ANDP", "Series rising edge", Basic::Andp).fnc(92).example("LD X000\nANDP X001\nSET Y000")
        .text("The result, in the one scan in which S has come on."),
    edge("ANDF", "Series falling edge", Basic::Andf).fnc(93).example("LD X000\nANDF X001\nSET Y000")
        .text("The result, in the one scan in which S has gone off."),
    contact("OR", "Parallel contact", Basic::Or).example("LD X000\nOR Y000\nANI X001\nOUT Y000")
        .text("The block's result or S."),
    contact("ORI", "Inverted parallel contact", Basic::Ori).example("LD X000\nORI X001\nOUT Y000")
        .text("The block's result or not S."),
    edge("ORP", "Parallel rising edge", Basic::Orp).fnc(94).example("LD X000\nORP X001\nOUT M0")
        .text("The block's result, or on in the one scan in which S has come on."),
    edge("ORF", "Parallel falling edge", Basic::Orf).fnc(95).example("LD X000\nORF X001\nOUT M0")
        .text("The block's result, or on in the one scan in which S has gone off."),
    logic("ANB", "Blocks in series", Basic::Anb).example("LD X000\nOR X001\nLD X002\nOR X003\nANB\nOUT Y000")
        .text("The last block and the one before it become one: both."),
    logic("ORB", "Blocks in parallel", Basic::Orb).example("LD X000\nAND X001\nLD X002\nAND X003\nORB\nOUT Y000")
        .text("The last block and the one before it become one: either."),
    logic("MPS", "Push the result", Basic::Mps).example("LD X000\nMPS\nAND X001\nOUT Y000\nMPP\nAND X002\nOUT Y001")
        .text("Puts the result on the branch stack, for branches that follow."),
    logic("MRD", "Read the pushed result", Basic::Mrd).example("LD X000\nMPS\nAND X001\nOUT Y000\nMRD\nAND X002\nOUT Y001\nMPP\nAND X003\nOUT Y002")
        .text("The result that was pushed last, which stays on the stack."),
    logic("MPP", "Pop the pushed result", Basic::Mpp).example("LD X000\nMPS\nAND X001\nOUT Y000\nMPP\nAND X002\nOUT Y001")
        .text("The result that was pushed last, which leaves the stack."),
    logic("INV", "Invert", Basic::Inv).fnc(98).example("LD X000\nAND X001\nINV\nOUT Y000")
        .text("Inverts the result so far."),
    logic("MEP", "Rising edge of the result", Basic::Mep)
        .source(FX3_MANUAL)
        .on(LIKE_FX3)
        .example("LD X000\nAND X001\nMEP\nSET M0")
        .text("On for the one scan in which the result so far has come on."),
    logic("MEF", "Falling edge of the result", Basic::Mef)
        .source(FX3_MANUAL)
        .on(LIKE_FX3)
        .example("LD X000\nAND X001\nMEF\nSET M0")
        .text("On for the one scan in which the result so far has gone off."),
    basic("OUT", "Coil", Basic::Out)
        .aliases(&["TMR", "CNT", "DCNT"])
        .takes(&[coil("D", COILS).plain()])
        .variants(OUT)
        .example("LD X000\nOUT Y000\nOUT T0 K30\nLD X001\nOUT C0 K10")
        .text(
            "Writes the result to Y, M or S in each scan. A timer runs while driven and closes its contact after the preset; a \
             counter counts each time that the drive comes on. OUT S inside a step is a transition.",
        ),
    basic("SET", "Set", Basic::Set)
        .takes(&[coil("D", COILS).plain()])
        .variants(SET)
        .text("Switches D on while driven; it stays on. SET S inside a step is a transition."),
    basic("RST", "Reset", Basic::Rst)
        .takes(&[reset(RESETTABLE).plain()])
        .variants(RST)
        .text("Switches D off while driven, sets a register to 0, and a timer or counter to 0 with its contact open."),
    pulse("PLS", "Pulse on a rising edge", Basic::Pls).text("D is on for one scan after the drive has come on."),
    pulse("PLF", "Pulse on a falling edge", Basic::Plf).text("D is on for one scan after the drive has gone off."),
    basic("MC", "Master control", Basic::Mc)
        .steps(3, 3)
        .takes(&[pointer("N", Classes::N), coil("D", Classes::Y.or(M)).plain().numbers(ORDINARY_M)])
        .variants(&[on(HM).steps(5, 5)])
        .errors(&[6608, 6623, 6624])
        .example("LD X000\nMC N0 M100\nLD X001\nOUT Y000\nMCR N0")
        .text("Up to the MCR of the same level coils are off and instructions not executed while it is not driven; D shows the drive."),
    basic("MCR", "Master control reset", Basic::Mcr)
        .steps(2, 2)
        .takes(&[pointer("N", Classes::N)])
        .variants(&[on(HM).steps(3, 3)])
        .drive(Drive::Alone)
        .example("LD X000\nMC N0 M100\nLD X001\nOUT Y000\nMCR N0")
        .text("Ends the zone that the MC of this level began, and the deeper ones."),
    logic("NOP", "No operation", Basic::Nop).example("NOP\nLD X000\nOUT Y000")
        .text("Does nothing."),
    basic("END", "End of the program", Basic::End)
        .drive(Drive::Alone)
        .example("LD X000\nOUT Y000\nEND")
        .text("Ends the scan; what follows is not executed."),
    basic("STL", "Step", Basic::Stl)
        .takes(&[bit("S", S).plain()])
        .variants(&[first_in(LIKE_FX3, S, 1024, 4095).steps(2, 2), on(HM).steps(2, 2)])
        .drive(Drive::Alone)
        .flags(&["M8040", "M8046", "M8047"])
        .errors(&[6605, 6625, 6626, 6627])
        .example("LD M8002\nSET S0\nSTL S0\nOUT Y000\nLD X000\nSET S20\nSTL S20\nOUT Y001\nLD X001\nSET S0\nRET")
        .text("Begins the instructions of step S, which run while the step is active, up to the next STL or RET."),
    basic("RET", "End of the steps", Basic::Ret)
        .drive(Drive::Alone)
        .errors(&[6627])
        .example("LD M8002\nSET S0\nSTL S0\nOUT Y000\nLD X000\nSET S20\nSTL S20\nOUT Y001\nLD X001\nSET S0\nRET")
        .text("Ends a series of steps."),
];
