//! Mitsubishi FX2N and FX2NC, and compatible boards (FX1S, FX1N, FX2N, FX2NC programming manual II, JY992D88101, §8).
//! Latched ranges are the factory settings.

use super::shared::{
    COUNTERS_FROM_100, FX_TIMERS, I_INPUTS_AND_COUNTERS, I_TIMERS, INDEX_ALIASES, INDEXES,
    LATCH_CHOICES, NESTS, TERMINALS, TIMERS_256, general, joined, latched,
};
use super::{ErrorNumbers, Model, ModelId, Range, mitsubishi};
use crate::times::InstructionTimes;
use crate::{high_speed, interrupts, special};
use rungc_rt::modules::Place;
use rungc_rt::{ErrorRules, Ports, Pulses, special::M_OPERATION_ERROR};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{D, M, P, S, Y};

const FX2: &str = "it has fewer devices and instructions than fx2n, and what does not exist there is not reported";

/// Times in the hardware manual.
const TIMES: InstructionTimes = InstructionTimes {
    basic: 80,
    longer: &[],
    applied: Some(1520),
    source: "FX2N hardware manual, performance specifications",
};

/// Mitsubishi FX2N. What it shares with the others of the FX family, they take from it.
pub(super) const FX2N: Model = Model {
    id: ModelId::Fx2n,
    instructions: ModelId::Fx2n,
    name: "fx2n",
    boards: Some(ModelId::Fx2nCompatible),
    title: "Mitsubishi FX2N",
    cpus: &["FX2N", "FX2NC"],
    nearest: &[
        ("FX", FX2),
        ("FX1", FX2),
        ("FX2", FX2),
        ("FX2C", FX2),
        ("FXU", FX2),
    ],
    ranges: RANGES,
    timers: FX_TIMERS,
    fast_timers: None,
    latch_choices: LATCH_CHOICES,
    latch_key: None,
    keeps_contacts: true,
    doubtful: &[],
    end_pointer: Some(63),
    max_steps: 16000,
    memory_steps: 16000,
    instruction_times: Some(TIMES),
    z_pairs_with_v: true,
    index_counts_words: false,
    error_relay: M_OPERATION_ERROR,
    errors_last_a_scan: true,
    rst_holds_in_interrupts: true,
    single_operation: Some((2800, 3071)),
    error_rules: ErrorRules::NONE,
    annunciators_are_states: false,
    value_error: 6706,
    error_numbers: ErrorNumbers::All,
    pulses: Pulses::Fx2n,
    ports: Ports::Fx,
    module_places: &[Place::Bus],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 1)],
    position_outputs: &[(Y, 0, 1)],
    notations: Classes::TEXT,
    bare_names: true,
    steps_per_operand: None,
    two_digit_years: true,
    max_for: 5,
    max_call: 5,
    axis_defaults: &[],
    reserved: &[],
    index_aliases: INDEX_ALIASES,
    special: &[
        mitsubishi::ALL,
        mitsubishi::PROGRAMMING_PORT,
        mitsubishi::FROM_FX1N,
        mitsubishi::FROM_FX2N,
        mitsubishi::NOT_FX3S,
        mitsubishi::D8145,
        mitsubishi::BIG,
        mitsubishi::FX2N,
    ],
    cleared_in_stop: &[special::MASKS, special::MODES],
    high_speed: high_speed::FX,
    fast_units: None,
    interrupts: interrupts::FX,
};

/// Boards that take programs for FX2N. No manual of theirs is public: makers advertise up to eight outputs that send
/// pulses, and which registers the outputs after Y001 would count in is unknown, so these keep no position.
pub(super) const FX2N_COMPATIBLE: Model = Model {
    id: ModelId::Fx2nCompatible,
    name: "fx2n-compatible",
    boards: None,
    title: "FX2N-compatible board",
    cpus: &[],
    nearest: &[],
    pulses: Pulses::Board2n,
    ports: Ports::Board2n,
    module_places: &[Place::Bus],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 7)],
    ..FX2N
};

/// Devices of FX2N.
const RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        general(M, 0, 499),
        latched(M, 500, 3071),
        general(M, 8000, 8255),
        general(S, 0, 499),
        latched(S, 500, 999),
    ],
    TIMERS_256,
    COUNTERS_FROM_100,
    &[general(D, 0, 199), latched(D, 200, 7999), general(D, 8000, 8255)],
    INDEXES,
    &[general(P, 0, 127)],
    I_INPUTS_AND_COUNTERS,
    I_TIMERS,
    NESTS,
};
