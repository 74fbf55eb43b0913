//! Kewei HM motion controller (hm-motion-controller §5.1).

mod special;

use super::shared::{NESTS, TERMINALS, general, joined, latched, timers};
use super::{ErrorNumbers, Model, ModelId, Range, Timers};
use crate::high_speed::{Axis, Counter, HighSpeed, Kind, PATTERNS, TableMode, counter};
use crate::interrupts::{
    Advanced, AdvancedPointers, Capture, Gate, Interrupt, Interrupts, Precedence, Source, edge,
};
use crate::runs::IndexAlias;
use rungc_rt::axis_place::{ACCELERATION, HIGHEST, INPUT_COUNTS, UNIT};
use rungc_rt::modules::Place;
use rungc_rt::{CmpOp, ErrorRules, Ports, Pulses, Register, Relay};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, I, M, P, R, S, T, V, Z};

/// Kewei HM.
pub(super) const HM: Model = Model {
    id: ModelId::Hm,
    instructions: ModelId::Hm,
    name: "hm",
    boards: None,
    title: "Kewei HM",
    cpus: &["HM"],
    nearest: &[],
    ranges: RANGES,
    timers: TIMERS,
    fast_timers: None,
    latch_choices: &[],
    latch_key: Some((Register(8020), 2222)),
    keeps_contacts: false,
    doubtful: &[],
    end_pointer: None,
    max_steps: 12000,
    memory_steps: 12000,
    instruction_times: None,
    z_pairs_with_v: false,
    index_counts_words: true,
    error_relay: Relay(8006),
    errors_last_a_scan: false,
    rst_holds_in_interrupts: false,
    single_operation: None,
    error_rules: ErrorRules::NONE,
    annunciators_are_states: false,
    value_error: 6707,
    error_numbers: ErrorNumbers::No,
    pulses: Pulses::Hm,
    ports: Ports::Hm,
    module_places: &[Place::Hm],
    finds_boards: false,
    pulse_outputs: &[],
    position_outputs: &[],
    notations: Classes::NONE,
    bare_names: true,
    steps_per_operand: Some((2, 3)),
    two_digit_years: false,
    max_for: 5,
    max_call: 8,
    // hm-motion-controller §8.2.3.
    axis_defaults: &[(UNIT, 10), (HIGHEST, 1000), (ACCELERATION, 100)],
    reserved: RESERVED,
    index_aliases: INDEX_ALIASES,
    special: &[special::HM],
    cleared_in_stop: &[],
    high_speed: HighSpeed {
        counters: COUNTERS,
        idle: &[],
        four_fold: &[],
        // hm-motion-controller §8.2.2.
        counters_take_turns: true,
        held_by_reset: true,
        reset_relays: None,
        most_comparisons: None,
        executed: None,
        // hm-motion-controller §8.3.14.
        crossing_zones: Some(0..=5),
        patterns: MASKED_PATTERNS,
        axes: AXES,
        spd_takes_counters: false,
        per_minute: None,
        meters: &[],
        // hm-motion-controller §5.7.
        edge_counts: &Register(8160).run::<8>(),
    },
    fast_units: None,
    interrupts: Interrupts {
        pointers,
        advanced: Some(ADVANCED),
        // hm-programming §7.8.
        both_edges: true,
        captures: CAPTURES,
        pulse_catch: None,
        count_rows: None,
        // hm-motion-controller §5.5.4 speaks of priorities, but names none. Relays keep the requests, and not when they
        // came.
        precedence: Precedence {
            kinds: &[],
            first_come: false,
        },
    },
};

/// High-speed counters (hm-motion-controller §5.1.5).
const COUNTERS: &[Counter] = &{
    use Kind::{Direction, One, Phases};
    [
        counter(235, One, &[0o0], None, None),
        counter(237, One, &[0o2], None, None),
        counter(239, One, &[0o0], Some(0o10), None),
        counter(240, One, &[0o2], Some(0o11), None),
        counter(241, One, &[0o0], Some(0o10), Some(0o12)),
        counter(242, One, &[0o2], Some(0o11), Some(0o13)),
        counter(244, Direction, &[0o0, 0o1], None, None),
        counter(245, Direction, &[0o2, 0o3], None, None),
        counter(246, Direction, &[0o0, 0o1], Some(0o10), None),
        counter(247, Direction, &[0o2, 0o3], Some(0o11), None),
        counter(248, Direction, &[0o0, 0o1], Some(0o10), Some(0o12)),
        counter(249, Direction, &[0o2, 0o3], Some(0o11), Some(0o13)),
        counter(250, Phases, &[0o0, 0o1], None, None),
        counter(251, Phases, &[0o2, 0o3], None, None),
        counter(252, Phases, &[0o0, 0o1], Some(0o10), None),
        counter(253, Phases, &[0o2, 0o3], Some(0o11), None),
        counter(254, Phases, &[0o0, 0o1], Some(0o10), Some(0o12)),
        counter(255, Phases, &[0o2, 0o3], Some(0o11), Some(0o13)),
    ]
};

/// DHSCT (hm-motion-controller §8.3.17).
const MASKED_PATTERNS: TableMode = TableMode {
    fixed: false,
    reached: CmpOp::Ge,
    repeats: false,
    masked: true,
    row: None,
    done: None,
    ..PATTERNS
};

/// Input axes (hm-motion-controller §8.2.2).
const AXES: &[Axis] = &[
    Axis {
        input: 0,
        count: INPUT_COUNTS[0].1,
        upper: Register(202),
        captured: Register(206),
        compared: Register(208),
        mode: Register(210),
        per_ms: INPUT_COUNTS[0].0,
        capture: [4, 5],
    },
    Axis {
        input: 2,
        count: INPUT_COUNTS[1].1,
        upper: Register(252),
        captured: Register(256),
        compared: Register(258),
        mode: Register(260),
        per_ms: INPUT_COUNTS[1].0,
        capture: [6, 7],
    },
];

/// Registers of edges (hm-motion-controller §5.5.6).
const CAPTURES: &[Capture] = &[
    Capture {
        register: Register(211),
        inputs: [4, 5],
        counted: 0,
    },
    Capture {
        register: Register(261),
        inputs: [6, 7],
        counted: 2,
    },
];

/// I900 to I907 (hm-motion-controller §5.5.8).
const ADVANCED: AdvancedPointers = AdvancedPointers {
    pointer: 900,
    count: 8,
    first: Advanced {
        mask: Relay(8064),
        active: Relay(8072),
        request: Relay(8080),
        again: Relay(8088),
        source: Some(Source::Period { ms: 1 }),
    },
};

/// The interrupt of the interpolation, each millisecond; the manual names no relay that forbids it
/// (hm-motion-controller §5.1.9).
const INTERPOLATION: u32 = 500;

/// The other pointers (hm-motion-controller §5.5.5 to §5.5.7).
fn pointers(number: u32) -> Option<Interrupt> {
    const REQUEST: Relay = Relay(8032);
    const MASK: Relay = Relay(8048);
    let (group, rest) = (number / 100, number % 100);
    if number == INTERPOLATION {
        return Some(Interrupt {
            source: Some(Source::Interpolation),
            request: None,
            gate: Gate::Open,
        });
    }
    let (source, place) = match (group, rest) {
        // X004 and X006 interrupt with one edge, X005 and X007 with both; I001 and I201 have only their relay.
        (0..=3, 0 | 1) => {
            let input = Source::Input {
                number: 4 + group,
                kind: edge(rest),
            };
            let has_input = rest == 0 || group % 2 == 1;
            (has_input.then_some(input), 2 * group + rest)
        }
        (6..=8, _) => {
            let ms = if rest == 0 { 100 } else { rest };
            (Some(Source::Period { ms }), 2 + group)
        }
        // I010 is requested by the system each millisecond, I020 to I050 by the program.
        (0, 10 | 20 | 30 | 40 | 50) => {
            let n = rest / 10 - 1;
            let source = (n == 0).then_some(Source::Period { ms: 1 });
            (source, 11 + n)
        }
        _ => return None,
    };
    Some(Interrupt {
        source,
        request: Some(REQUEST.after(place)),
        gate: Gate::Forbids(MASK.after(place)),
    })
}

/// Devices.
const RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        latched(M, 0, 3071),
        general(M, 8000, 8255),
        latched(S, 0, 1023),
        latched(T, 0, 255),
        latched(C, 0, 199),
        latched(C, 200, 255),
        general(D, 0, 999),
        latched(D, 1000, 1999),
        general(D, 2000, 7999),
        general(D, 8000, 8255),
        latched(R, 0, 99),
        latched(V, 0, 7),
        latched(Z, 0, 7),
        general(P, 0, 127),
        general(I, 0, 1),
        general(I, 10, 10),
        general(I, 20, 20),
        general(I, 30, 30),
        general(I, 40, 40),
        general(I, 50, 50),
        general(I, 60, 60),
        general(I, 100, 101),
        general(I, 200, 201),
        general(I, 300, 301),
        general(I, 500, 500),
        general(I, 600, 699),
        general(I, 700, 799),
        general(I, 800, 899),
        general(I, 900, 907),
    ],
    NESTS,
};

/// Registers that the manual keeps for the system (hm-motion-controller §5.1), and those of output axes (§8.2.3). Those
/// of input axes (D213 to D249, D263 to D299) are not among them: its own examples take D220 and D230 for counts of a
/// master (§8.3.5, §8.4.1, §8.4.4).
const RESERVED: &[(u32, u32)] = &[
    (0, 79),
    (98, 199),
    (317, 317),
    (325, 325),
    (328, 349),
    (367, 367),
    (375, 375),
    (378, 399),
    (417, 417),
    (425, 425),
    (428, 449),
    (467, 467),
    (475, 475),
    (478, 499),
    (517, 517),
    (525, 525),
    (528, 549),
    (567, 567),
    (575, 575),
    (578, 599),
    (600, 999),
];

/// Timers. They continue counting past the preset.
const TIMERS: &[Timers] = &[
    timers(0, 199, 100).overrunning(),
    timers(200, 245, 10).overrunning(),
    timers(246, 249, 1).accumulating().overrunning(),
    timers(250, 255, 100).accumulating().overrunning(),
];

/// D8100–D8115: other names of V0–V7 and Z0–Z7 (hm-motion-controller §5.7.2).
const INDEX_ALIASES: &[IndexAlias] = &[
    IndexAlias::new(8100, V, 0),
    IndexAlias::new(8101, V, 1),
    IndexAlias::new(8102, V, 2),
    IndexAlias::new(8103, V, 3),
    IndexAlias::new(8104, V, 4),
    IndexAlias::new(8105, V, 5),
    IndexAlias::new(8106, V, 6),
    IndexAlias::new(8107, V, 7),
    IndexAlias::new(8108, Z, 0),
    IndexAlias::new(8109, Z, 1),
    IndexAlias::new(8110, Z, 2),
    IndexAlias::new(8111, Z, 3),
    IndexAlias::new(8112, Z, 4),
    IndexAlias::new(8113, Z, 5),
    IndexAlias::new(8114, Z, 6),
    IndexAlias::new(8115, Z, 7),
];
