//! Axis motion and advanced interrupts of HM (hm-motion-controller §5.5 and §8).

use super::high_speed::AXIS;
use super::row::*;
use super::{Basic, Drive, Inst, Lower, Param, Rule, Spelling};
use rungc_rt::RtFn;
use rungc_syntax::Operand;

const fn any(name: &'static str) -> Param {
    src(name, CONSTANTS.or(DATA)).word()
}

/// A constant word from 1 to the greatest one.
const POSITIVE: &[Rule] = &[Rule::WorksWith(1, i16::MAX as i64)];

/// A constant operand as a word.
fn word(operands: &[Operand], i: usize) -> Option<i16> {
    operands.get(i)?.kind.constant().map(|value| value as i16)
}

const START_SPEED: &[Rule] = &[
    Rule::WorksWith(0, i16::MAX as i64),
    Rule::WorksIf(
        |operands| match (word(operands, 1), word(operands, 2)) {
            (Some(highest), Some(start)) => highest <= 0 || start <= highest,
            _ => true,
        },
        "the start speed D3 is at most the highest speed D2",
    ),
];
/// Without pulses, JOG needs a speed.
const JOG_SPEED: Rule = Rule::WorksIf(
    |operands| match (word(operands, 1), word(operands, 2)) {
        (Some(0), Some(speed)) => speed > 0,
        _ => true,
    },
    "the number of pulses D2 is not 0 or the speed D3 is above 0",
);
const JOG_INPUTS: Rule = Rule::WorksIf(
    |operands| (word(operands, 3), word(operands, 4)) != (Some(0), Some(0)),
    "D4 or D5 names an input",
);
/// Outputs send at most 600 pulses in a millisecond (hm-motion-controller §8.3.6).
const INSERTED: Rule = Rule::WorksIf(
    |operands| word(operands, 1).is_none_or(|count| (-600..=600).contains(&count)),
    "D2 lies from -600 to 600",
);

/// A table or a 32-bit register with an even number.
const fn table(name: &'static str) -> Param {
    both(name, DATA).rules(&[Rule::Aligned(2)])
}

const fn motion(name: &'static str, title: &'static str) -> Inst {
    row(name, title, "hm-motion-controller §8").on(HM)
}

const fn wide(name: &'static str, title: &'static str) -> Inst {
    motion(name, title).forms(W32).spelling(Spelling::Plain)
}

const fn process(name: &'static str, title: &'static str, basic: Basic) -> Inst {
    row(name, title, "hm-motion-controller §5.5")
        .on(HM)
        .lower(Lower::Basic(basic))
}

/// An operand of which nothing is known.
const fn whatever(name: &'static str) -> Param {
    mixed(name, VALUES.or(BITS)).optional()
}

/// Row for an instruction that the list of §8.1 names and no section describes.
const fn named_only(name: &'static str, title: &'static str) -> Inst {
    const OPERANDS: &[Param] = &[
        whatever("1"),
        whatever("2"),
        whatever("3"),
        whatever("4"),
        whatever("5"),
    ];
    row(name, title, "hm-motion-controller §8.1")
        .on(HM)
        .spelling(Spelling::Plain)
        .takes(OPERANDS)
        .todo("the manual names it and does not describe it")
        .text("The manual names this instruction in its list and describes neither its operands nor what it does.")
}

pub(super) const ROWS: &[Inst] = &[
    process("PROC", "Start of a process section", Basic::Proc)
        .drive(Drive::Alone)
        .example("FEND\nI900\nPROC\nLD M0\nPEND\nPRET")
        .text("Where the next request of an advanced interrupt enters it while the PEND that follows is not driven."),
    process("PEND", "End of a process section", Basic::Pend)
        .example("FEND\nI900\nPROC\nLD M0\nPEND\nPRET")
        .text("Ends this run of an advanced interrupt. While driven, the next request continues after it."),
    process("PRET", "End of an advanced interrupt", Basic::Pret)
        .drive(Drive::Alone)
        .example("FEND\nI900\nPROC\nLD M0\nPEND\nPRET")
        .text("Ends an advanced interrupt."),
    named_only("DPTO", "Output at several speeds").forms(W32),
    named_only("CAP", "High-speed read"),
    motion("AXPO", "Bind an axis to an output")
        .takes(&[AXIS, count("D2", 0, 8), any("D3").limits(0, 1)])
        .lower(Lower::Axis(&[0, 1]))
        .text("Binds virtual axis D1 to output D2; D3 enables its direction output."),
    motion("AXPU", "Units of an axis")
        .takes(&[AXIS, any("D2"), any("D3"), any("D4")])
        .lower(Lower::Axis(&[2, 3, 4]))
        .text("Sets the axis's units of time (ms), pulses and length."),
    motion("AXSP", "Speeds of an axis")
        .takes(&[AXIS, any("D2").rules(POSITIVE), any("D3").rules(START_SPEED)])
        .lower(Lower::Axis(&[5, 6]))
        .text("Sets the axis's highest speed D2 and start speed D3."),
    motion("AXAS", "Acceleration of an axis")
        .takes(&[AXIS, any("D2")])
        .lower(Lower::Axis(&[7]))
        .text("Sets the axis's highest acceleration."),
    motion("AXEI", "Inputs of an axis")
        .takes(&[AXIS, any("D2"), any("D3"), any("D4"), any("D5")])
        .lower(Lower::Axis(&[8, 9, 10, 11]))
        .text("Says by masks which inputs are DOG, zero, left and right limit of the axis."),
    motion("AXOSP", "Homing speeds of an axis")
        .takes(&[AXIS, any("D2"), any("D3").rules(POSITIVE)])
        .lower(Lower::Axis(&[12, 13]))
        .text("Sets the axis's homing speed D2 and creep speed D3."),
    motion("AXOX", "Homing mode of an axis")
        .takes(&[AXIS, any("D2"), any("D3"), any("D4")])
        .lower(Lower::Axis(&[14, 16, 15]))
        .text("Sets the axis's event word and how many zero signals and pulses homing counts."),
    motion("HOME", "Return to the origin")
        .takes(&[AXIS])
        .call(RtFn::AxisHome)
        .stops_undriven()
        .text("Runs the axis to its origin, as AXEI, AXOSP and AXOX say."),
    motion("JOG", "Jog")
        .takes(&[
            AXIS,
            any("D2"),
            any("D3").rules(&[JOG_SPEED]),
            any("D4").inputs(),
            any("D5").inputs().rules(&[JOG_INPUTS]),
        ])
        .call(RtFn::AxisJog)
        .stops_undriven()
        .text("Jogs the axis by D2 pulses, then on and on at speed D3, while an input of mask D4 (forward) or D5 (backward) is on."),
    wide("PSOUT", "Position by pulses")
        .takes(&[AXIS, src("D2", CONSTANTS.or(DATA))])
        .call(RtFn::AxisPsout)
        .stops_undriven()
        .text("Moves the axis by D2 pulses within its highest speed and acceleration."),
    wide("PTAB", "Point table")
        .takes(&[
            both("D1", DATA).word().len(11),
            table("D2").open_ended(),
            any("D3").rules(POSITIVE),
        ])
        .lower(Lower::Exclusive(RtFn::Ptab))
        .stops_undriven()
        .text("Appends a segment as the eleven words at D1 say to the point table at D2, one point for each interval D3."),
    wide("PTOUT", "Follow a point table")
        .takes(&[
            AXIS,
            table("D2").open_ended(),
            table("D3"),
            src("D4", CONSTANTS.or(DATA)).rules(COUNTED),
            any("D5").limits(0, 1),
        ])
        .call(RtFn::AxisPtout)
        .stops_undriven()
        .text("Moves the axis along the point table at D2 as register D3 goes through its range D4; D5 = 1 starts again at its end."),
    motion("IPL", "Insert pulses")
        .takes(&[AXIS, any("D2").rules(&[INSERTED])])
        .call(RtFn::AxisIpl)
        .text("Inserts D2 pulses into what the axis sends, in the next millisecond, each time it is executed with its drive on."),
    motion("GEAR", "Electronic gear")
        .takes(&[AXIS, table("D2").word().len(2), any("D3").limits(0, 1), any("D4"), any("D5")])
        .call(RtFn::AxisGear)
        .stops_undriven()
        .text("The axis follows register D2 by the ratio D4/D5; D3 says whether its value or its change counts."),
    wide("CAM", "Electronic cam")
        .takes(&[
            AXIS,
            table("D2").open_ended(),
            table("D3"),
            src("D4", CONSTANTS.or(DATA)).rules(COUNTED),
            // The manual says 28 words, and lists parameters up to the thirty-first.
            both("D5", DATA).word().len(31),
        ])
        .call(RtFn::AxisCam)
        .stops_undriven()
        .text("The axis follows register D3 along the cam table at D2; the 31 words at D5 say when it engages and disengages."),
    wide("PCTAB", "Cam table")
        .takes(&[both("D1", DATA).word().len(16), table("D2").open_ended()])
        .lower(Lower::Exclusive(RtFn::Pctab))
        .stops_undriven()
        .text("Builds the cam table at D2 of a flying cut as the sixteen words at D1 say."),
    wide("PBTAB", "Return of a cam table")
        .takes(&[both("D1", DATA).word().len(12), table("D2").open_ended()])
        .lower(Lower::Exclusive(RtFn::Pbtab))
        .stops_undriven()
        .text("Appends the way back to the cam table at D2 as the twelve words at D1 say."),
];
