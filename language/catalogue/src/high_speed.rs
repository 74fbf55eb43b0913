//! High-speed inputs and outputs, FNC 50–59, 189 and 280.

use super::row::*;
use super::{Classes, Comparison, Inst, Lower, Param, Rule, Variant};
use rungc_models::{ModelSet, high_speed};
use rungc_rt::RtFn;
use rungc_syntax::{DeviceClass, Operand, OperandKind};

/// Counters that count apart from the scan.
const FAST: &[(DeviceClass, u32, u32)] = &[(DeviceClass::C, 235, 255)];
/// They and the ring counters.
const COUNTS: &[(DeviceClass, u32, u32)] = &[
    (DeviceClass::C, 235, 255),
    (DeviceClass::D, 8099, 8099),
    (DeviceClass::D, 8398, 8398),
];
/// Interrupt pointers of counters.
const COUNTER_INTERRUPTS: &[(DeviceClass, u32, u32)] = &[
    (DeviceClass::I, 10, 10),
    (DeviceClass::I, 20, 20),
    (DeviceClass::I, 30, 30),
    (DeviceClass::I, 40, 40),
    (DeviceClass::I, 50, 50),
    (DeviceClass::I, 60, 60),
];
const FAST_COUNTER: Param = src("S2", Classes::C).numbers(FAST);
/// An output that sends pulses.
const PULSE_OUTPUT: Param = coil("D", Classes::Y).plain().pulses();

/// The greatest number of pulses, and any speed where no manual gives the limits; a run uses the model's highest at
/// most.
const NUMBER: i64 = i32::MAX as i64;

/// Boards that take programs for FX2N and FX3U; how fast their outputs are is their makers' choice.
const BOARDS: ModelSet = ModelSet::COMPATIBLE;
const FX2N: ModelSet = ModelSet::FX2N.without(BOARDS);
const FX3U_ITSELF: ModelSet = FX3U.without(BOARDS);
/// FX1S, FX1N, FX3S and FX3G.
const SMALL_FX: ModelSet = ModelSet::FX1.or(FX3.without(FX3U));

/// S1 of PLSY and PLSR, in Hz (FX1S/FX1N/FX2N programming manual II §5.6.8 and §5.6.10, FX3 programming manual §13.8
/// and §13.10): 20 kHz on FX2N, 100 kHz on the others, 200 kHz on an FX3U with a high-speed output adapter.
const fn speed(lowest: i64, highest: i64, wide: &'static [Rule]) -> Param {
    src("S1", VALUES).limits(lowest, highest).rules(wide)
}
const fn plsr(s1: Param, fewest: i64) -> [Param; 4] {
    [
        s1,
        src("S2", VALUES).limits(fewest, NUMBER),
        src("S3", VALUES).limits(0, NUMBER),
        PULSE_OUTPUT,
    ]
}
const fn plsy(s1: Param) -> [Param; 3] {
    [s1, src("S2", VALUES).limits(0, NUMBER), PULSE_OUTPUT]
}
const ANY_SPEED: Param = speed(0, NUMBER, &[]);
const PLSR: &[Param] = &plsr(ANY_SPEED, 0);
/// Models that cannot send fewer than 110 pulses with ramps.
const PLSR_110: &[Param] = &plsr(ANY_SPEED, 110);
/// Models that say how long ramps may take.
const PLSR_INOVANCE: &[Param] = &[
    src("S1", VALUES).limits(0, NUMBER),
    src("S2", VALUES).limits(110, NUMBER),
    src("S3", VALUES).limits(50, 5000),
    PULSE_OUTPUT,
];
const FROM_10_HZ: &[Rule] = &[Rule::WideLimits(10, 100_000)];
const PLSR_FX1: &[Param] = &plsr(speed(10, 32767, FROM_10_HZ), 110);
const PLSR_FX2N: &[Param] = &plsr(speed(10, 20_000, &[]), 110);
const PLSR_FX3SG: &[Param] = &plsr(speed(10, 32767, FROM_10_HZ), 0);
/// l01s-programming §7.2.
const L01S_HZ: Param = speed(10, 32767, &[Rule::WideLimits(10, 200_000)]);
const PLSR_L01S: &[Param] = &plsr(L01S_HZ, 0);
const PLSY_L01S: &[Param] = &plsy(L01S_HZ);
const PLSR_FX3U: &[Param] = &plsr(speed(10, 32767, &[Rule::WideLimits(10, 200_000)]), 0);

const PLSY_SMALL_FX: &[Param] = &plsy(speed(1, 32767, &[Rule::WideLimits(1, 100_000)]));
const PLSY_FX2N: &[Param] = &plsy(speed(2, 20_000, &[]));
const PLSY_FX3U: &[Param] = &plsy(speed(1, 32767, &[Rule::WideLimits(1, 200_000)]));
const PLSY: &[Param] = &plsy(ANY_SPEED);
const PLSY_INOVANCE: &[Param] = &[
    src("S1", VALUES)
        .limits(0, 32767)
        .rules(&[Rule::WideLimits(1, 100_000)]),
    src("S2", VALUES).limits(0, NUMBER),
    PULSE_OUTPUT,
];

const SET: &[Param] = &[
    src("S1", VALUES),
    FAST_COUNTER,
    coil("D", COILS.or(Classes::I)).numbers(COUNTER_INTERRUPTS),
];
const RESET: &[Param] = &[src("S1", VALUES), FAST_COUNTER, coil("D", COILS)];
/// FX resets the counter itself too.
const RESET_FX: &[Param] = &[
    src("S1", VALUES),
    FAST_COUNTER,
    mixed_out("D", COILS.or(Classes::C)).rules(&[ITSELF]),
];
/// A counter resets none but itself.
const ITSELF: Rule = Rule::Holds(
    |operands| match operands {
        [_, counter, reset] => Classes::of(&reset.kind) != Classes::C || reset.kind == counter.kind,
        _ => true,
    },
    "a counter is that of S2",
);
/// Returns true if a rule holds for the operands of HSZ, or HSZ names no relay that selects a table.
fn table_holds(operands: &[Operand], rule: fn(&OperandKind, &OperandKind) -> bool) -> bool {
    match operands {
        [first, rows, _, mode] => {
            let OperandKind::Device(relay, None) = mode.kind else {
                return true;
            };
            high_speed::zone_table(relay).is_none() || rule(&first.kind, &rows.kind)
        }
        _ => true,
    }
}
/// With M8130 or M8132 as D, S1 is where a table begins …
const TABLE: Rule = Rule::Holds(
    |operands| {
        table_holds(operands, |first, _| {
            let OperandKind::Device(first, None) = first else {
                return false;
            };
            matches!(first.class, DeviceClass::D | DeviceClass::R)
        })
    },
    "a table starts at a data register",
);
/// … and S2 the number of its rows.
const ROWS_OF_TABLE: Rule = Rule::Holds(
    |operands| {
        table_holds(operands, |_, rows| match *rows {
            OperandKind::Decimal(rows, None) => (1..=128).contains(&rows),
            OperandKind::Hex(rows, None) => (1..=128).contains(&rows),
            OperandKind::Decimal(..) | OperandKind::Hex(..) => true,
            _ => false,
        })
    },
    "a table has 1 to 128 rows, and their number is a constant",
);
const ZONE: &[Param] = &[
    src("S1", VALUES.without(Classes::V)).rules(&[TABLE]),
    src("S2", VALUES.without(Classes::V)).rules(&[Rule::AtLeast(0), ROWS_OF_TABLE]),
    src("S", Classes::C).numbers(FAST),
    coil("D", COILS).len(3),
];
/// HM names the compare zone, 0 to 5, as the last operand, and counts in registers too.
const HM_COUNTER: Param = src("D2", DATA.or(Classes::C));
const HM_VALUE: Param = src("D1", CONSTANTS.or(DATA));
const HM_ZONE: Param = src("zone", CONSTANTS.or(DATA)).word().limits(0, 5);
const HM_BIT: &[Param] = &[HM_VALUE, HM_COUNTER, coil("D3", COILS), HM_ZONE];
/// The three bits of a zone lie among sixteen that belong together.
const AMONG_SIXTEEN: Rule = Rule::Holds(
    |operands| {
        operands.iter().all(|operand| match operand.kind {
            OperandKind::Device(bit, None) if COILS.meets(Classes::of(&operand.kind)) => {
                bit.number % 16 < 14
            }
            _ => true,
        })
    },
    "the three bits lie within sixteen of which the first has a number that is a multiple of 16",
);
const HM_ZONE_COMPARE: &[Param] = &[
    HM_VALUE.rules(&[Rule::Below(1)]),
    src("D2", CONSTANTS.or(DATA)),
    src("D3", DATA.or(Classes::C)),
    coil("D4", COILS).len(3).rules(&[AMONG_SIXTEEN]),
    HM_ZONE,
];
const HM_TABLE: &[Param] = &[
    src("D1", DATA)
        .word()
        .len_of(|constants| constant(constants, 1)?.checked_mul(3)),
    src("D2", CONSTANTS.or(DATA)).word().limits(1, 128),
    src("D3", DATA.or(Classes::C)),
    coil("D4", COILS).len(16).rules(&[Rule::Aligned(16)]),
    src("D5", CONSTANTS.or(DATA)).word(),
];
const HM_FORMS: Variant = on(HM).forms(W32);
/// HM names the axis instead of an output.
pub(super) const AXIS: Param = src("axis", CONSTANTS).word().limits(0, 5).plain().pulses();
const HM_PULSES: &[Param] = &[
    src("D1", CONSTANTS.or(DATA)).rules(NOT_NEGATIVE),
    src("D2", CONSTANTS.or(DATA)).limits(-16_000_000, 16_000_000),
    AXIS,
];
const HM_RAMP: &[Param] = &[
    src("D1", CONSTANTS.or(DATA)).rules(COUNTED),
    src("D2", CONSTANTS.or(DATA)).limits(-16_000_000, 16_000_000),
    src("D3", CONSTANTS.or(DATA)).limits(50, 5000),
    AXIS,
];

/// The terminals that HM refreshes: X000, X010, Y000, Y010.
const HM_TERMINALS: &[(DeviceClass, u32, u32)] = &[
    (DeviceClass::X, 0o0, 0o0),
    (DeviceClass::X, 0o10, 0o10),
    (DeviceClass::Y, 0o0, 0o0),
    (DeviceClass::Y, 0o10, 0o10),
];

const fn refresh(numbers: &'static [(DeviceClass, u32, u32)], n: Param) -> [Param; 2] {
    [
        coil("D", Classes::X.or(Classes::Y))
            .per(1)
            .changed()
            .plain()
            .numbers(numbers)
            .rules(&[Rule::EndsInZero]),
        n,
    ]
}

const REFRESH: &[Param] = &refresh(&[], count("n", 8, 256).rules(&[Rule::MultipleOf(8)]));
const REFRESH_HM: &[Param] = &refresh(HM_TERMINALS, count("n", 8, 8));

const fn fast(name: &'static str, fnc: u16, title: &'static str) -> Inst {
    row(name, title, "h1u-h2u-programming §4.3.6").fnc(fnc)
}

const fn compare(
    name: &'static str,
    fnc: u16,
    title: &'static str,
    comparison: Comparison,
) -> Inst {
    fast(name, fnc, title)
        .forms(W32)
        .steps(13, 13)
        .flags(&["M8025"])
        .errors(&[6760])
        .lower(Lower::HighSpeed(comparison))
}

pub(super) const ROWS: &[Inst] = &[
    fast("REF", 50, "Refresh inputs or outputs")
        .forms(W16_P)
        .steps(5, 5)
        .takes(REFRESH)
        .variants(&[on(HM).takes(REFRESH_HM)])
        .call(RtFn::Ref)
        .lower_on(&[(HM, Lower::Call(RtFn::RefHm))])
        .text("Reads n inputs starting at D, or writes n outputs, immediately instead of at the start or end of the scan."),
    fast("REFF", 51, "Refresh with input filter")
        .forms(W16_P)
        .steps(3, 3)
        .on(BIG)
        .takes(&[count("n", 0, 60).also_on(FX3U, DATA)])
        .flags(&["D8020"])
        .call(RtFn::Reff)
        .text("Sets the filter time of the first inputs to n ms, in D8020."),
    fast("MTR", 52, "Input matrix")
        .steps(9, 9)
        .on(NOT_HM.without(L01S))
        .takes(&[
            bit("S", Classes::X).len(8).plain().rules(&[Rule::EndsInZero]),
            coil("D1", Classes::Y).per(3).plain().rules(&[Rule::EndsInZero]),
            coil("D2", COILS)
                .len_of(|constants| constant(constants, 3)?.checked_mul(10))
                .plain()
                .rules(&[Rule::EndsInZero]),
            count("n", 2, 8),
        ])
        .flags(&["M8029"])
        .call(RtFn::Mtr)
        .text(
            "Reads a matrix of 8 × n keys: output D1+k selects row k, whose eight bits come in at S and go to D2 and ten times k. M8029 \
             is on after each reading.",
        ),
    compare("HSCS", 53, "Set by high-speed counter", Comparison::Set)
        .takes(SET)
        .variants(&[on(HM).takes(HM_BIT)])
        .text("Switches D on, or runs an interrupt routine, at the moment when counter S2 reaches S1."),
    compare("HSCR", 54, "Reset by high-speed counter", Comparison::Reset)
        .takes(RESET)
        .variants(&[on(HM).takes(HM_BIT), on(LIKE_FX).takes(RESET_FX)])
        .text("Switches D off at the moment when counter S2 reaches S1."),
    compare("HSZ", 55, "Zone compare by high-speed counter", Comparison::Zone)
        .on(NOT_FX1)
        .steps(17, 17)
        .takes(ZONE)
        .variants(&[on(HM).takes(HM_ZONE_COMPARE)])
        .flags(&["M8025", "M8130", "M8131", "M8132", "M8133", "D8130", "D8131"])
        .text(
            "At each count D is on below S1, D+1 from S1 to S2, D+2 above S2. With M8130 as D a table of S2 rows at S1 switches \
             outputs, with M8132 it sets the frequency of PLSY.",
        ),
    fast("SPD", 56, "Pulse density")
        .steps(7, 13)
        .on(NOT_HM)
        .variants(&[on(INOVANCE.or(ModelSet::FX1).or(ModelSet::FX2N)).forms(W16),
            on(LIKE_FX3).takes(&[
            bit("S1", Classes::X).plain().numbers(&[(DeviceClass::X, 0, 7)]),
            src("S2", VALUES).limits(1, 32767),
            dst("D", REGISTERS.or(INDEX)).len(3),
        ])])
        .forms(W16_W32)
        .takes(&[
            bit("S1", Classes::X).plain().numbers(&[(DeviceClass::X, 0, 5)]),
            src("S2", VALUES).limits(1, 32767),
            dst("D", REGISTERS.or(INDEX)).len(3),
        ])
        .flags(&["M8100", "M8101", "M8102", "M8103", "M8104", "M8105"])
        .errors(&[6706])
        .lower(Lower::Density)
        .text("Counts pulses of S1 in windows of S2 ms: D the last full window, D+1 the running one, D+2 what is left of it."),
    fast("PLSY", 57, "Pulse output")
        .forms(W16_W32)
        .steps(7, 13)
        .takes(PLSY)
        .variants(&[
            HM_FORMS,
            on(HM).takes(HM_PULSES),
            on(INOVANCE).takes(PLSY_INOVANCE),
            on(L01S).takes(PLSY_L01S),
            on(SMALL_FX).takes(PLSY_SMALL_FX),
            on(FX2N).takes(PLSY_FX2N),
            on(FX3U_ITSELF).takes(PLSY_FX3U),
        ])
        .flags(&["M8029"])
        .errors(&[6706, 6707, 6770, 6771])
        .call(RtFn::Plsy)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisPlsy))])
        .text("Sends S2 pulses of S1 Hz on output D; S2 = 0: without end. HM: D1 the frequency, D2 the number, and an axis."),
    fast("PWM", 58, "Pulse width modulation")
        .steps(7, 7)
        .on(NOT_HM)
        .takes(&[
            src("S1", VALUES).limits(0, 32767).rules(&[Rule::AtMost(1)]),
            src("S2", VALUES).limits(1, 32767),
            PULSE_OUTPUT,
        ])
        .errors(&[6706, 6707])
        .call(RtFn::Pwm)
        .stops_undriven()
        .text("Sends pulses S1 ms wide with a period of S2 ms on output D as long as it is driven."),
    fast("PLSR", 59, "Pulse output with ramps")
        .forms(W16_W32)
        .steps(9, 17)
        .takes(PLSR)
        .variants(&[
            HM_FORMS,
            on(HM).takes(HM_RAMP),
            on(ModelSet::FX1).takes(PLSR_FX1),
            on(FX2N).takes(PLSR_FX2N),
            on(SMALL_FX).takes(PLSR_FX3SG),
            on(FX3U_ITSELF).takes(PLSR_FX3U),
            on(ModelSet::FX2N).takes(PLSR_110),
            on(INOVANCE).takes(PLSR_INOVANCE),
            on(L01S).takes(PLSR_L01S),
        ])
        .flags(&["M8029"])
        .errors(&[6706, 6707, 6770])
        .call(RtFn::Plsr)
        .stops_undriven()
        .lower_on(&[(HM, Lower::Call(RtFn::AxisPlsr))])
        .text("Sends S2 pulses on output D with ramps of S3 ms up to S1 Hz and down. HM: an axis instead of D."),
    fast("HCMOV", 189, "Read a high-speed counter")
        .source(FX3_MANUAL)
        .forms(W32)
        .steps(13, 13)
        .on(FX3U)
        .takes(&[
            src("S", Classes::C.or(Classes::D)).plain().numbers(COUNTS),
            dst("D", DATA),
            count("n", 0, 1).checked(),
        ])
        .lower(Lower::MoveCount)
        .text("D = the present value of counter S; with n = 1 the counter is then set to 0."),
    fast("HSCT", 280, "Table compare by high-speed counter")
        .source(FX3_MANUAL)
        .forms(W32)
        .steps(21, 21)
        .on(FX3U_L01S.or(HM))
        .takes(&[
            src("S1", DATA).word().len_of(|constants| constant(constants, 1)?.checked_mul(3)),
            count("m", 1, 128),
            src("S2", Classes::C).numbers(FAST),
            coil("D", COILS).per(4),
            count("n", 1, 16),
        ])
        .variants(&[on(HM).takes(HM_TABLE)])
        .flags(&["M8138", "D8138"])
        .lower(Lower::HighSpeed(Comparison::Table))
        .text(
            "Works through a table of rows of a 32-bit value and a pattern: when the counter reaches a row's value its pattern goes to the \
             outputs, and the next row is waited for.",
        ),
    row("DHMOV", "Read a high-speed counter now", "hm-motion-controller §5.6")
        .forms(W32)
        .spelling(super::Spelling::Plain)
        .on(HM)
        .takes(&[src("D1", DATA.or(Classes::C)), dst("D2", DATA.or(Classes::C))])
        .lower(Lower::Move)
        .text("Brings the counter or pulse count D1 up to date and copies it to D2."),
];
