//! Mitsubishi FX1S and FX1N (FX1S, FX1N, FX2N, FX2NC programming manual II, JY992D88101, §8.1 and §8.2). What they keep
//! without power, in EEPROM or by a capacitor, is fixed.

use super::fx2n::FX2N;
use super::shared::{
    COUNTERS_FROM_16, FX_TIMERS, I_INPUTS, INDEXES, M8028, NESTS, TIMERS_256, general, joined,
    latched, timers,
};
use super::{Model, ModelId, Range, Timers, mitsubishi};
use crate::high_speed::{self, HighSpeed};
use crate::times::InstructionTimes;
use rungc_rt::Pulses;
use rungc_rt::modules::Place;
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, M, P, S, T, X, Y};

/// Times in the hardware manuals of FX1S and FX1N.
const TIMES: InstructionTimes = InstructionTimes {
    basic: 550,
    longer: &[],
    applied: Some(3700),
    source: "FX1S and FX1N hardware manuals, performance specifications",
};

/// Mitsubishi FX1S.
pub(super) const FX1S: Model = Model {
    id: ModelId::Fx1s,
    instructions: ModelId::Fx1s,
    name: "fx1s",
    title: "Mitsubishi FX1S",
    cpus: &["FX1S"],
    // FX0, FX0S, FX0N, FX, FX2C, FX2N programming manual II (JY992D48301) §4: FX0N has the M, S and timers of FX1S.
    nearest: &[
        ("FX0", FX0),
        (
            "FX0N",
            "FX0N has terminals up to X177 and Y177, FROM and TO; `--model fx1n` has these, but other timers from T32 on",
        ),
        ("FX0S", FX0),
    ],
    ranges: FX1S_RANGES,
    timers: FX1S_TIMERS,
    fast_timers: Some(M8028),
    max_steps: 2000,
    memory_steps: 2000,
    instruction_times: Some(TIMES),
    special: &[
        mitsubishi::ALL,
        mitsubishi::PROGRAMMING_PORT,
        mitsubishi::FAST_TIMERS,
        mitsubishi::D8145,
        mitsubishi::FX1,
        mitsubishi::SMALL,
        mitsubishi::FX1S,
    ],
    ..FX1N
};

const FX0: &str = "FX0 and FX0S keep M496–M511, C14, C15, D30 and D31 without power, and fx1s keeps M384–M511, C16–C31 and D128–D255";

/// Mitsubishi FX1N.
pub(super) const FX1N: Model = Model {
    id: ModelId::Fx1n,
    instructions: ModelId::Fx1n,
    name: "fx1n",
    boards: None,
    title: "Mitsubishi FX1N",
    cpus: &["FX1N", "FX1NC"],
    nearest: &[],
    ranges: FX1N_RANGES,
    timers: FX_TIMERS,
    latch_choices: &[],
    max_steps: 8000,
    memory_steps: 8000,
    instruction_times: Some(TIMES),
    pulses: Pulses::Fx1,
    notations: Classes::NONE,
    module_places: &[Place::Bus, Place::Board1n],
    special: &[
        mitsubishi::ALL,
        mitsubishi::PROGRAMMING_PORT,
        mitsubishi::FROM_FX1N,
        mitsubishi::D8145,
        mitsubishi::FX1,
        mitsubishi::SMALL,
        mitsubishi::FX1N,
    ],
    high_speed: HighSpeed {
        // FX1S/FX1N/FX2N programming manual II §5.6.
        most_comparisons: Some(4),
        ..high_speed::FX
    },
    ..FX2N
};

/// Devices of FX1S. D1000 to D2499 are file registers. It has neither timer nor counter interrupts.
const FX1S_RANGES: &[Range] = joined! {Range:
    &[
        general(X, 0o0, 0o17),
        general(Y, 0o0, 0o15),
        general(M, 0, 383),
        latched(M, 384, 511),
        general(M, 8000, 8255),
        latched(S, 0, 127),
        general(T, 0, 63),
        general(C, 0, 15),
        latched(C, 16, 31),
        latched(C, 235, 255),
        general(D, 0, 127),
        latched(D, 128, 255),
        latched(D, 1000, 2499),
        general(D, 8000, 8255),
    ],
    INDEXES,
    &[general(P, 0, 63)],
    I_INPUTS,
    NESTS,
};

/// Devices of FX1N. It has neither timer nor counter interrupts.
const FX1N_RANGES: &[Range] = joined! {Range:
    &[
        general(X, 0o0, 0o177),
        general(Y, 0o0, 0o177),
        general(M, 0, 383),
        latched(M, 384, 1535),
        general(M, 8000, 8255),
        latched(S, 0, 999),
    ],
    TIMERS_256,
    COUNTERS_FROM_16,
    &[general(D, 0, 127), latched(D, 128, 7999), general(D, 8000, 8255)],
    INDEXES,
    &[general(P, 0, 127)],
    I_INPUTS,
    NESTS,
};

/// Timers of FX1S.
const FX1S_TIMERS: &[Timers] = &[timers(0, 62, 100), timers(63, 63, 1)];
