//! Inovance H1U and H2U (h1u-h2u-programming §3).

mod special;

use super::fx2n::FX2N;
use super::shared::{
    COUNTERS_FROM_16, COUNTERS_FROM_100, I_INPUTS_AND_COUNTERS, INDEXES, LATCH_CHOICES, NESTS,
    TERMINALS, TIMERS_256, general, joined, latched, timers,
};
use super::{ErrorNumbers, Model, ModelId, Range, Timers};
use crate::high_speed::{self, FastUnits, HighSpeed, ResetRelays};
use crate::interrupts::{
    self, CountRows, Gate, Interrupt, Interrupts, Kind, Precedence, Source, fx_pointer,
};
use rungc_rt::modules::Place;
use rungc_rt::{ErrorRules, Ports, Pulses, Register, Relay};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{D, I, M, P, S, Y};
use std::ops::RangeInclusive;

/// Inovance H1U.
pub(super) const H1U: Model = Model {
    id: ModelId::H1u,
    instructions: ModelId::H1u,
    name: "h1u",
    title: "Inovance H1U",
    cpus: &["H1U"],
    ranges: H1U_RANGES,
    latch_choices: &[],
    max_steps: 8000,
    memory_steps: 8000,
    instruction_times: None,
    pulse_outputs: &[(Y, 0, 2)],
    position_outputs: &[(Y, 0, 2)],
    finds_boards: false,
    special: &[special::BOTH, special::H1U],
    ..H2U
};

/// Inovance H2U.
pub(super) const H2U: Model = Model {
    id: ModelId::H2u,
    instructions: ModelId::H2u,
    name: "h2u",
    boards: None,
    title: "Inovance H2U",
    cpus: &["H2U"],
    nearest: &[],
    ranges: H2U_RANGES,
    timers: TIMERS,
    latch_choices: LATCH_CHOICES,
    max_steps: 24000,
    memory_steps: 24000,
    instruction_times: None,
    errors_last_a_scan: false,
    rst_holds_in_interrupts: false,
    single_operation: None,
    error_rules: ErrorRules {
        sums_up_ports: true,
        logs: true,
    },
    annunciators_are_states: true,
    value_error: 6707,
    // Those of contact logic are reserved (h1u-h2u-programming §8.7).
    error_numbers: ErrorNumbers::AllButLogic,
    pulses: Pulses::Inovance,
    ports: Ports::Inovance,
    module_places: &[Place::Bus, Place::Remote, Place::Slot],
    finds_boards: true,
    pulse_outputs: &[(Y, 0, 7)],
    position_outputs: &[(Y, 0, 7)],
    notations: Classes::E.or(Classes::TEXT),
    bare_names: false,
    two_digit_years: false,
    max_for: 6,
    special: &[special::BOTH, special::H2U],
    cleared_in_stop: &[HOME],
    high_speed: HighSpeed {
        four_fold: &[
            (251, Relay(8195)),
            (252, Relay(8196)),
            (253, Relay(8197)),
            (254, Relay(8198)),
            (255, Relay(8199)),
        ],
        // h1u-h2u-programming §3.6.
        held_by_reset: true,
        reset_relays: Some(ResetRelays {
            edge: Relay(8166),
            off: Relay(8169),
        }),
        // h1u-h2u-programming §4.3.6.
        spd_takes_counters: true,
        per_minute: Some(Relay(8100)),
        ..high_speed::FX
    },
    // h1u-h2u-programming §3.10.
    fast_units: Some(FastUnits {
        total: 56,
        output: 7,
        density: 4,
        edge: 1,
        one: 6,
        two: 13,
        phases: 17,
    }),
    interrupts: Interrupts {
        pointers,
        count_rows: Some(&COUNT_ROWS),
        // h1u-h2u-programming §4.3.1.
        precedence: Precedence {
            kinds: &[Kind::Counter, Kind::Input, Kind::Timer, Kind::Pulses],
            first_come: true,
        },
        ..interrupts::FX
    },
    ..FX2N
};

/// Relays with which a program steers DSZR and clear signals (h1u-h2u-programming §4.3.11).
const HOME: &[RangeInclusive<u16>] = &[
    8441..=8442,
    8445..=8446,
    8449..=8449,
    8451..=8452,
    8455..=8456,
    8459..=8459,
    8461..=8462,
    8465..=8466,
    8469..=8469,
    8484..=8486,
];

/// A table of counts and the interrupts of its rows, I507 to I530 (h1u-h2u-programming §4.3.1, §8.7).
const COUNT_ROWS: CountRows = CountRows {
    enable: Relay(8084),
    counter: Register(8084),
    rows: Register(8085),
    first: Register(8086),
    row: Register(8131),
    done: Relay(8133),
    pointer: 507,
    most: 24,
};

/// In addition to the pointers of FX, those of the ends of pulse trains, I502 to I506 for Y000 to Y004
/// (h1u-h2u-programming §4.3.6), and of the rows of a table of counts.
fn pointers(number: u32) -> Option<Interrupt> {
    let (502..=506) = number else {
        return fx_pointer(number).or_else(|| COUNT_ROWS.find(number));
    };
    let output = number - 502;
    Some(Interrupt {
        source: Some(Source::PulsesEnd { output }),
        request: None,
        gate: Gate::Allows(Relay(8090).after(output)),
    })
}

/// Special registers of both. The format words and the station numbers of the serial ports are latched
/// (h1u-h2u-programming §5.1).
const D_SPECIAL: &[Range] = &[
    general(D, 8000, 8109),
    latched(D, 8110, 8111),
    general(D, 8112, 8119),
    latched(D, 8120, 8121),
    general(D, 8122, 8259),
    latched(D, 8260, 8261),
    general(D, 8262, 8269),
    latched(D, 8270, 8271),
    general(D, 8272, 8489),
    latched(D, 8490, 8511),
];

/// Devices of H1U. Its latched ranges are fixed.
const H1U_RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        general(M, 0, 383),
        latched(M, 384, 3071),
        general(M, 8000, 8511),
        latched(S, 0, 999),
    ],
    TIMERS_256,
    COUNTERS_FROM_16,
    &[
        general(D, 0, 127),
        latched(D, 128, 7999),
    ],
    D_SPECIAL,
    INDEXES,
    &[general(P, 0, 131)],
    I_INPUTS_AND_COUNTERS,
    // Its three outputs' (h1u-h2u-programming §4.3.1).
    &[general(I, 502, 504)],
    I_ROWS_AND_TIMERS,
    NESTS,
};

/// Devices of H2U. Which are latched are the factory settings.
const H2U_RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        general(M, 0, 499),
        latched(M, 500, 3071),
        general(M, 8000, 8511),
        general(S, 0, 499),
        latched(S, 500, 999),
    ],
    TIMERS_256,
    COUNTERS_FROM_100,
    &[
        general(D, 0, 199),
        latched(D, 200, 7999),
    ],
    D_SPECIAL,
    INDEXES,
    &[general(P, 0, 131)],
    I_INPUTS_AND_COUNTERS,
    &[general(I, 502, 506)],
    I_ROWS_AND_TIMERS,
    NESTS,
};

/// Interrupts of both: rows of a table of counts, timers.
const I_ROWS_AND_TIMERS: &[Range] = &[
    general(I, 507, 530),
    general(I, 601, 699),
    general(I, 701, 799),
    general(I, 801, 899),
];

/// Timers of both. They take the preset over when timing starts.
const TIMERS: &[Timers] = &[
    timers(0, 191, 100).latching_preset(),
    timers(192, 199, 100).free_running().latching_preset(),
    timers(200, 245, 10).latching_preset(),
    timers(246, 249, 1)
        .accumulating()
        .free_running()
        .latching_preset(),
    timers(250, 255, 100).accumulating().latching_preset(),
];
