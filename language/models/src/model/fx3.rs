//! Mitsubishi FX3S, FX3G and FX3U, and compatible boards (FX3S, FX3G, FX3GC, FX3U, FX3UC programming manual,
//! JY997D16601, §4.1). Latched ranges are the factory settings.

use super::fx2n::FX2N;
use super::shared::{
    COUNTERS_FROM_16, COUNTERS_FROM_100, FX_TIMERS, I_INPUTS, I_INPUTS_AND_COUNTERS, I_TIMERS,
    INDEXES, M8028, NESTS, TERMINALS, TIMERS_256, general, joined, latched, timers,
};
use super::{Model, ModelId, Range, Timers, mitsubishi};
use crate::high_speed::{self, FOUR_FOLD, HighSpeed, Meter};
use crate::interrupts::{self, Interrupts, PULSE_CATCH_OF_8};
use crate::special::{self, Special};
use crate::times::InstructionTimes;
use rungc_rt::modules::Place;
use rungc_rt::{Ports, Pulses, Register, Relay};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, ER, M, P, R, S, T, X, Y};
use std::ops::RangeInclusive;

/// Times in the hardware manuals of the FX3S, and of the FX3G in its standard mode.
const TIMES_FX3SG: InstructionTimes = InstructionTimes {
    basic: 210,
    longer: &[],
    applied: Some(500),
    source: "FX3S and FX3G hardware manuals, performance specifications",
};

/// Times in the hardware manual of the FX3U.
const TIMES_FX3U: InstructionTimes = InstructionTimes {
    basic: 65,
    longer: &[],
    applied: Some(642),
    source: "FX3U hardware manual, performance specifications",
};

/// Mitsubishi FX3S.
pub(super) const FX3S: Model = Model {
    id: ModelId::Fx3s,
    instructions: ModelId::Fx3s,
    name: "fx3s",
    title: "Mitsubishi FX3S",
    cpus: &["FX3S", "FX3SA"],
    ranges: FX3S_RANGES,
    timers: FX3S_TIMERS,
    fast_timers: Some(M8028),
    max_steps: 4000,
    memory_steps: 16000,
    instruction_times: Some(TIMES_FX3SG),
    ports: Ports::Fx3,
    module_places: &[Place::Bus, Place::Adapter, Place::Board3g],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 1)],
    position_outputs: &[(Y, 0, 1)],
    notations: Classes::E,
    special: &[
        mitsubishi::ALL,
        mitsubishi::PROGRAMMING_PORT,
        mitsubishi::FROM_FX1N,
        mitsubishi::FROM_FX2N,
        mitsubishi::FAST_TIMERS,
        mitsubishi::FX3,
        mitsubishi::ADAPTERS_3SG,
        mitsubishi::FX3SG,
        mitsubishi::SMALL,
        mitsubishi::FX3S,
    ],
    ..FX3G
};

/// Mitsubishi FX3G.
pub(super) const FX3G: Model = Model {
    id: ModelId::Fx3g,
    instructions: ModelId::Fx3g,
    name: "fx3g",
    boards: None,
    title: "Mitsubishi FX3G",
    cpus: &["FX3G", "FX3GA", "FX3GC", "FX3GE"],
    nearest: &[],
    ranges: FX3G_RANGES,
    timers: FX3G_TIMERS,
    latch_choices: &[],
    max_steps: 32000,
    memory_steps: 32000,
    instruction_times: Some(TIMES_FX3SG),
    pulses: Pulses::Fx3,
    ports: Ports::Fx3g,
    module_places: &[Place::Bus, Place::Adapter, Place::Board3g],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 2)],
    position_outputs: &[(Y, 0, 2)],
    notations: Classes::E.or(Classes::TEXT),
    special: &[
        mitsubishi::ALL,
        mitsubishi::PROGRAMMING_PORT,
        mitsubishi::FROM_FX1N,
        mitsubishi::FROM_FX2N,
        mitsubishi::NOT_FX3S,
        mitsubishi::FX3,
        mitsubishi::FX3GU,
        mitsubishi::ADAPTERS_3SG,
        mitsubishi::ADAPTERS_3G,
        mitsubishi::FX3SG,
        mitsubishi::SMALL,
        mitsubishi::FX3G,
    ],
    cleared_in_stop: &[special::MASKS, special::MODES, HOME],
    high_speed: HighSpeed {
        four_fold: FOUR_FOLD,
        executed: EXECUTED,
        meters: METERS,
        ..high_speed::FX
    },
    ..FX2N
};

/// Mitsubishi FX3U.
pub(super) const FX3U: Model = Model {
    id: ModelId::Fx3u,
    instructions: ModelId::Fx3u,
    name: "fx3u",
    boards: Some(ModelId::Fx3uCompatible),
    title: "Mitsubishi FX3U",
    cpus: &["FX3U", "FX3UC"],
    nearest: &[],
    ranges: FX3U_RANGES,
    timers: FX3U_TIMERS,
    max_steps: 64000,
    memory_steps: 64000,
    instruction_times: Some(TIMES_FX3U),
    pulses: Pulses::Fx3,
    ports: Ports::Fx3,
    module_places: &[Place::Bus, Place::Adapter],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 3)],
    position_outputs: &[(Y, 0, 3)],
    notations: Classes::E
        .or(Classes::TEXT)
        .or(Classes::WORD_BIT)
        .or(Classes::BUFFER),
    special: joined! {&'static [Special]: SPECIAL_3U, &[mitsubishi::ADAPTERS_3U]},
    cleared_in_stop: &[special::MASKS, special::MODES, HOME, DVIT],
    high_speed: HighSpeed {
        four_fold: FOUR_FOLD,
        executed: EXECUTED,
        // FX3 programming manual §14.4.
        most_comparisons: Some(32),
        ..high_speed::FX
    },
    interrupts: Interrupts {
        pulse_catch: Some(PULSE_CATCH_OF_8),
        ..interrupts::FX
    },
    ..FX2N
};

/// Boards that take programs for FX3U. No manual of theirs is public: makers advertise up to eight outputs that send
/// pulses, and which registers the outputs after Y003 would count in is unknown, so these keep no position.
pub(super) const FX3U_COMPATIBLE: Model = Model {
    id: ModelId::Fx3uCompatible,
    name: "fx3u-compatible",
    boards: None,
    title: "FX3U-compatible board",
    cpus: &[],
    nearest: &[],
    pulses: Pulses::Board3u,
    ports: Ports::Board3u,
    module_places: &[Place::Bus],
    finds_boards: false,
    pulse_outputs: &[(Y, 0, 7)],
    special: joined! {&'static [Special]: SPECIAL_3U, &[mitsubishi::NO_ADAPTERS]},
    // Published tests of such boards: they stop at programs with these.
    doubtful: &[(M, 3072, 7679), (D, 7000, 7999)],
    ..FX3U
};

/// Special devices of FX3U, but for those of analog adapters.
const SPECIAL_3U: &[&[Special]] = &[
    mitsubishi::ALL,
    mitsubishi::FROM_FX1N,
    mitsubishi::FROM_FX2N,
    mitsubishi::NOT_FX3S,
    mitsubishi::FX3,
    mitsubishi::FX3GU,
    mitsubishi::BIG,
    mitsubishi::FX3U,
];

/// Relays with which a program of FX3G and FX3U steers positioning.
const HOME: &[RangeInclusive<u16>] = &[
    8338..=8338,
    8341..=8342,
    8345..=8346,
    8349..=8349,
    8351..=8352,
    8355..=8356,
    8359..=8359,
    8361..=8362,
    8365..=8366,
    8369..=8369,
    8371..=8372,
    8375..=8376,
    8379..=8379,
    8464..=8467,
];

/// Relays with which a program of FX3U steers DVIT.
const DVIT: &[RangeInclusive<u16>] = &[
    8336..=8336,
    8347..=8347,
    8357..=8357,
    8367..=8367,
    8377..=8377,
    8460..=8463,
];

/// M8139 and D8139 (FX3 programming manual, chapter 37).
const EXECUTED: Option<(Relay, Register)> = Some((Relay(8139), Register(8139)));

/// Meters of pulses on FX3S and FX3G, active while M8075 is on.
const METERS: &[Meter] = &[
    meter(0, 8074, &[Relay(8075), Relay(8076)], 8080),
    meter(1, 8080, &[Relay(8075), Relay(8077)], 8081),
    meter(3, 8086, &[Relay(8075), Relay(8078)], 8082),
    meter(4, 8092, &[Relay(8075), Relay(8079)], 8083),
];

const fn meter(input: u32, registers: u16, measures: &'static [Relay], period: u16) -> Meter {
    Meter {
        input,
        registers: Register(registers),
        measures,
        period: Some(Relay(period)),
    }
}

/// Devices of FX3S. It has no counter interrupts and no R.
const FX3S_RANGES: &[Range] = joined! {Range:
    &[
        general(X, 0o0, 0o17),
        general(Y, 0o0, 0o15),
        general(M, 0, 383),
        latched(M, 384, 511),
        general(M, 512, 1535),
        general(M, 8000, 8511),
        latched(S, 0, 127),
        general(S, 128, 255),
        general(T, 0, 127),
        latched(T, 128, 137),
        general(C, 0, 15),
        latched(C, 16, 31),
        general(C, 200, 234),
        latched(C, 235, 255),
        general(D, 0, 127),
        latched(D, 128, 255),
        general(D, 256, 2999),
        general(D, 8000, 8511),
    ],
    INDEXES,
    &[general(P, 0, 255)],
    I_INPUTS,
    I_TIMERS,
    NESTS,
};

/// Devices of FX3G without the optional battery.
const FX3G_RANGES: &[Range] = joined! {Range:
    TERMINALS,
    &[
        general(M, 0, 383),
        latched(M, 384, 1535),
        general(M, 1536, 7679),
        general(M, 8000, 8511),
        latched(S, 0, 999),
        general(S, 1000, 4095),
    ],
    TIMERS_256,
    &[general(T, 256, 319)],
    COUNTERS_FROM_16,
    &[
        general(D, 0, 127),
        latched(D, 128, 1099),
        general(D, 1100, 7999),
        general(D, 8000, 8511),
        general(R, 0, 23999),
    ],
    INDEXES,
    &[general(P, 0, 2047)],
    I_INPUTS_AND_COUNTERS,
    I_TIMERS,
    NESTS,
};

/// Devices of FX3U.
const FX3U_RANGES: &[Range] = joined! {Range:
    &[
        // JY997D19401: X000 to X367, Y000 to Y367.
        general(X, 0o0, 0o367),
        general(Y, 0o0, 0o367),
        general(M, 0, 499),
        latched(M, 500, 7679),
        general(M, 8000, 8511),
        general(S, 0, 499),
        latched(S, 500, 4095),
    ],
    TIMERS_256,
    &[general(T, 256, 511)],
    COUNTERS_FROM_100,
    &[
        general(D, 0, 199),
        latched(D, 200, 7999),
        general(D, 8000, 8511),
        latched(R, 0, 32767),
        latched(ER, 0, 32767),
    ],
    INDEXES,
    &[general(P, 0, 4095)],
    I_INPUTS_AND_COUNTERS,
    I_TIMERS,
    NESTS,
};

/// Timers of FX3S.
const FX3S_TIMERS: &[Timers] = &[
    timers(0, 62, 100),
    timers(63, 127, 1),
    timers(128, 131, 1).accumulating(),
    timers(132, 137, 100).accumulating(),
];

/// Timers of FX3G.
const FX3G_TIMERS: &[Timers] = joined! {Timers: FX_TIMERS, &[timers(256, 319, 1)]};

/// Timers of FX3U.
const FX3U_TIMERS: &[Timers] = joined! {Timers: FX_TIMERS, &[timers(256, 511, 1)]};
