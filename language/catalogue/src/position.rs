//! Positioning, FNC 150–159.

use super::high_speed::AXIS;
use super::row::*;
use super::{Classes, Inst, Lower, Param, Rule, Variant};
use rungc_models::ModelSet;
use rungc_rt::RtFn;
use rungc_syntax::DeviceClass;

/// An output that sends pulses and keeps a position, by itself and with a direction.
const POSITION_OUTPUT: Param = position_output("D");
const PULSE_OUTPUT: Param = position_output("D1");
const fn position_output(name: &'static str) -> Param {
    coil(name, Classes::Y).plain().positions()
}
const DIRECTION: Param = coil("D2", COILS).directs();
const DISTANCE: Param = src("S1", VALUES);
const SPEED: Param = src("S2", VALUES).rules(NOT_NEGATIVE);
const MOVE: &[Param] = &[DISTANCE, SPEED, PULSE_OUTPUT, DIRECTION];
/// A speed of at least 10 Hz; in 32 bits, up to the model's highest.
const fn speed(name: &'static str, wide: &'static [Rule]) -> Param {
    src(name, VALUES).limits(10, 32767).rules(wide)
}
const INOVANCE_HZ: &[Rule] = &[Rule::WideLimits(10, 100_000)];
const L01S_HZ: &[Rule] = &[Rule::WideLimits(10, 200_000)];
const MOVE_INOVANCE: &[Param] = &[DISTANCE, speed("S2", INOVANCE_HZ), PULSE_OUTPUT, DIRECTION];
const MOVE_L01S: &[Param] = &[DISTANCE, speed("S2", L01S_HZ), PULSE_OUTPUT, DIRECTION];
const MOVE_HM: &[Param] = &[
    src("D1", CONSTANTS.or(DATA)).limits(-16_000_000, 16_000_000),
    src("D2", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
    AXIS,
];
const MOVE_VARIANTS: &[Variant] = &[
    on(HM).forms(W32).takes(MOVE_HM),
    on(INOVANCE).takes(MOVE_INOVANCE),
    on(L01S).takes(MOVE_L01S),
];
const SPEED_HM: &[Param] = &[src("D1", CONSTANTS.or(DATA)), AXIS];
const RETURN: &[Param] = &[
    src("S1", VALUES),
    src("S2", VALUES),
    bit("S3", BITS),
    POSITION_OUTPUT,
];
const RETURN_INOVANCE: &[Param] = &[
    speed("S1", INOVANCE_HZ),
    speed("S2", &[]),
    bit("S3", BITS),
    POSITION_OUTPUT,
];
const RETURN_L01S: &[Param] = &[
    speed("S1", L01S_HZ),
    src("S2", VALUES),
    bit("S3", BITS),
    POSITION_OUTPUT,
];
const FREE: &[Param] = &[src("S", VALUES), PULSE_OUTPUT, DIRECTION];
const FREE_INOVANCE: &[Param] = &[
    src("S", VALUES)
        .limits(-32768, 32767)
        .rules(&[Rule::WideLimits(-100_000, 100_000), Rule::Not(0, 0)]),
    PULSE_OUTPUT,
    DIRECTION,
];
const FREE_L01S: &[Param] = &[
    src("S", VALUES)
        .limits(-32768, 32767)
        .rules(&[Rule::WideLimits(-200_000, 200_000), Rule::Not(0, 0)]),
    PULSE_OUTPUT,
    DIRECTION,
];
const SEARCH: &[Param] = &[
    bit("S1", BITS),
    bit("S2", Classes::X),
    PULSE_OUTPUT,
    coil("D2", Classes::Y.or(Classes::M)).directs(),
];
/// The types of H1U and H2U with more than three outputs have no DSZR.
const SEARCH_INOVANCE: &[Param] = &[
    bit("S1", BITS).numbers(SEARCH_RELAYS),
    bit("S2", Classes::X),
    PULSE_OUTPUT.numbers(&[(DeviceClass::Y, 0, 2)]),
    coil("D2", Classes::Y.or(Classes::M)).numbers(SEARCH_RELAYS),
];
const SEARCH_RELAYS: &[(DeviceClass, u32, u32)] = &[(DeviceClass::M, 0, 1023)];

const fn position(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.11")
        .fnc(fnc)
        .forms(W16_W32)
        .steps(9, 17)
        .flags(&["M8029"])
        .errors(&[6706, 6707])
}

pub(super) const ROWS: &[Inst] = &[
    position("DSZR", 150, "Zero return with DOG search")
        .forms(W16_W32)
        .on(NOT_HM_FX1.without(ModelSet::FX2N))
        .takes(SEARCH)
        .variants(&[on(LIKE_FX3).forms(W16), on(INOVANCE).takes(SEARCH_INOVANCE)])
        .call(RtFn::Dszr)
        .stops_undriven()
        .text("Runs the axis of output D1 to its origin by the signals DOG S1 and zero S2, searching the DOG if it starts past it."),
    position("DVIT", 151, "Interrupt positioning")
        .source(FX3_MANUAL)
        .on(FX3U.or(HM))
        .takes(MOVE)
        .variants(&[on(HM).forms(W32).takes(MOVE_HM)])
        .call(RtFn::Dvit)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisDvit))])
        .text("Runs at S2 Hz until the interrupt input of the axis, then sends S1 pulses more."),
    position("TBL", 152, "Positioning by a table")
        .source(FX3_MANUAL)
        .forms(W32)
        .steps(17, 17)
        .on(FX3GU)
        .takes(&[POSITION_OUTPUT, count("n", 1, 100)])
        .todo("its positioning table is a parameter of the project that rungc does not read")
        .stops_undriven()
        .text("Does what row n of the positioning table in the parameters says for output D."),
    position("ABS", 155, "Read an absolute position")
        .forms(W32)
        .steps(13, 13)
        .on(NOT_HM.without(L01S))
        .takes(&[bit("S", BITS).len(3), coil("D1", COILS).len(3), dst("D2", RESULTS)])
        .errors(&[6706])
        .call(RtFn::Abs)
        .text("Reads the absolute position of a servo amplifier by three inputs and three outputs into the pair D2."),
    position("ZRN", 156, "Zero return")
        .on(NOT_HM)
        .takes(RETURN)
        .variants(&[on(INOVANCE).takes(RETURN_INOVANCE), on(L01S).takes(RETURN_L01S)])
        .call(RtFn::Zrn)
        .stops_undriven()
        .text("Runs output D back at S1 Hz until the DOG signal S3, then at S2 Hz until it is off: the origin."),
    position("PLSV", 157, "Variable-speed pulses")
        .steps(7, 13)
        .takes(FREE)
        .variants(&[
            on(HM).forms(W32).takes(SPEED_HM),
            on(INOVANCE).takes(FREE_INOVANCE),
            on(L01S).takes(FREE_L01S),
        ])
        .call(RtFn::Plsv)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisPlsv))])
        .text("Sends pulses of |S| Hz on D1 while driven, the sign of S on D2; S may change. HM: an axis instead of D1 and D2."),
    position("DRVI", 158, "Relative positioning")
        .takes(MOVE)
        .variants(MOVE_VARIANTS)
        .call(RtFn::Drvi)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisDrvi))])
        .text("Moves by S1 pulses at S2 Hz with ramps: pulses on D1, direction on D2. HM: an axis instead of D1 and D2."),
    position("DRVA", 159, "Absolute positioning")
        .takes(MOVE)
        .variants(MOVE_VARIANTS)
        .call(RtFn::Drva)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisDrva))])
        .text("Moves to position S1 at S2 Hz with ramps: pulses on D1, direction on D2. HM: an axis instead of D1 and D2."),
];
