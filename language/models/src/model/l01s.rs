//! Coolmay L01S (l01s-programming §3).

mod special;

use super::fx2n::FX2N;
use super::shared::{
    COUNTERS_FROM_16, I_INPUTS_AND_COUNTERS, INDEXES, NESTS, TERMINALS, TIMERS_256, general,
    joined, latched, timers,
};
use super::{ErrorNumbers, Model, ModelId, Range, Timers};
use crate::high_speed::{self, COUNTERS_L01S, FOUR_FOLD, HighSpeed, IDLE_L01S, Meter};
use crate::interrupts::{self, Interrupts, Kind, PULSE_CATCH_OF_8, Precedence};
use crate::times::InstructionTimes;
use rungc_rt::modules::Place;
use rungc_rt::{Ports, Pulses, Register};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{D, I, M, P, R, S, T, Y};

/// With devices of low numbers.
const TIMES: InstructionTimes = InstructionTimes {
    basic: 240,
    longer: &[
        ("LDP", 560),
        ("LDF", 560),
        ("ANDP", 560),
        ("ANDF", 560),
        ("ORP", 560),
        ("ORF", 560),
        ("OUT T", 9600),
        // A 32-bit counter takes 14.3 us.
        ("OUT C", 12_800),
        ("MC", 5600),
        ("MCR", 5700),
        ("PLS", 9920),
        ("PLF", 10_160),
        ("STL", 560),
    ],
    applied: None,
    source: "l01s-programming §4.1",
};

/// Coolmay L01S.
pub(super) const L01S: Model = Model {
    id: ModelId::L01s,
    instructions: ModelId::L01s,
    name: "l01s",
    boards: None,
    title: "Coolmay L01S",
    cpus: &["L01S"],
    nearest: &[],
    ranges: RANGES,
    timers: TIMERS,
    latch_choices: &[],
    max_steps: 30000,
    memory_steps: 30000,
    instruction_times: Some(TIMES),
    rst_holds_in_interrupts: false,
    single_operation: None,
    error_numbers: ErrorNumbers::No,
    pulses: Pulses::L01s,
    ports: Ports::L01s,
    module_places: &[Place::Bus, Place::L01s],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 3)],
    position_outputs: &[(Y, 0, 3)],
    notations: Classes::E.or(Classes::TEXT),
    special: &[special::L01S, special::OF_INSTRUCTIONS],
    high_speed: HighSpeed {
        counters: COUNTERS_L01S,
        idle: &[IDLE_L01S],
        four_fold: FOUR_FOLD,
        // l01s-programming §6.3.
        held_by_reset: true,
        most_comparisons: None,
        meters: METERS,
        ..high_speed::FX
    },
    interrupts: Interrupts {
        pulse_catch: Some(PULSE_CATCH_OF_8),
        // l01s-programming §6.4, which names the kinds alone; of timers I6 comes first (§6.4.2).
        precedence: Precedence {
            kinds: &[Kind::Input, Kind::Timer, Kind::Counter],
            first_come: false,
        },
        ..interrupts::FX
    },
    ..FX2N
};

/// Meters of pulses; the manual names their registers only (l01s-programming, table of special registers).
const METERS: &[Meter] = &[
    meter(0, 8074),
    meter(1, 8080),
    meter(3, 8086),
    meter(4, 8092),
];

const fn meter(input: u32, registers: u16) -> Meter {
    Meter {
        input,
        registers: Register(registers),
        measures: &[],
        period: None,
    }
}

/// Devices. X and Y reach as far as expansion modules can number them; R is what the Modbus map gives.
const RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        general(M, 0, 383),
        latched(M, 384, 7679),
        general(M, 8000, 8511),
        latched(S, 0, 4095),
    ],
    TIMERS_256,
    &[general(T, 256, 319)],
    COUNTERS_FROM_16,
    &[
        general(D, 0, 127),
        latched(D, 128, 7999),
        general(D, 8000, 8511),
        general(R, 0, 23999),
    ],
    INDEXES,
    &[general(P, 0, 1280)],
    I_INPUTS_AND_COUNTERS,
    &[
        general(I, 602, 699),
        general(I, 702, 799),
        general(I, 805, 899),
    ],
    NESTS,
};

/// Timers.
const TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10).stepwise(),
    timers(246, 249, 1).accumulating().free_running(),
    timers(250, 255, 100).accumulating(),
    timers(256, 319, 1),
];
