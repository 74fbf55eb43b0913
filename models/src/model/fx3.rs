//! Mitsubishi FX3S, FX3G and FX3U, and compatible boards (FX3S, FX3G, FX3GC, FX3U, FX3UC programming manual, JY997D16601, §4.1).
//! Latched ranges are the factory settings.

use super::{
    INDEX_ALIASES, LATCH_CHOICES, M8028, Model, ModelId, Range, Timers, general, latched, timers,
};
use rungc_rt::{Ports, Pulses};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, ER, I, M, N, P, R, S, T, V, X, Y, Z};

/// Mitsubishi FX3S.
pub(super) const FX3S: Model = Model {
    id: ModelId::Fx3s,
    name: "fx3s",
    title: "Mitsubishi FX3S",
    cpus: &["FX3S", "FX3SA"],
    nearest: &[],
    ranges: FX3S_RANGES,
    timers: FX3S_TIMERS,
    fast_timers: Some(M8028),
    max_steps: 4000,
    pulse_outputs: &[(Y, 0, 1)],
    position_outputs: &[(Y, 0, 1)],
    notations: Classes::E,
    ..FX3G
};

/// Mitsubishi FX3G.
pub(super) const FX3G: Model = Model {
    id: ModelId::Fx3g,
    name: "fx3g",
    boards: None,
    title: "Mitsubishi FX3G",
    cpus: &["FX3G", "FX3GA", "FX3GC", "FX3GE"],
    nearest: &[],
    ranges: FX3G_RANGES,
    timers: FX3G_TIMERS,
    fast_timers: None,
    latch_choices: &[],
    latch_key: None,
    keeps_contacts: true,
    end_pointer: Some(63),
    max_steps: 32000,
    z_pairs_with_v: true,
    error_relay: 8067,
    errors_last_a_scan: true,
    annunciators_are_states: false,
    value_error: 6706,
    pulses: Pulses::Fx3,
    ports: Ports::Fx,
    pulse_outputs: &[(Y, 0, 2)],
    position_outputs: &[(Y, 0, 2)],
    notations: Classes::E.or(Classes::TEXT),
    bare_names: true,
    steps_per_operand: None,
    max_for: 5,
    max_call: 5,
    index_aliases: INDEX_ALIASES,
};

/// Mitsubishi FX3U.
pub(super) const FX3U: Model = Model {
    id: ModelId::Fx3u,
    name: "fx3u",
    boards: Some(ModelId::Fx3uCompatible),
    title: "Mitsubishi FX3U",
    cpus: &["FX3U", "FX3UC"],
    nearest: &[],
    ranges: FX3U_RANGES,
    timers: FX3U_TIMERS,
    fast_timers: None,
    latch_choices: LATCH_CHOICES,
    latch_key: None,
    keeps_contacts: true,
    end_pointer: Some(63),
    max_steps: 64000,
    z_pairs_with_v: true,
    error_relay: 8067,
    errors_last_a_scan: true,
    annunciators_are_states: false,
    value_error: 6706,
    pulses: Pulses::Fx3,
    ports: Ports::Fx,
    pulse_outputs: &[(Y, 0, 3)],
    position_outputs: &[(Y, 0, 3)],
    notations: Classes::E
        .or(Classes::TEXT)
        .or(Classes::WORD_BIT)
        .or(Classes::BUFFER),
    bare_names: true,
    steps_per_operand: None,
    max_for: 5,
    max_call: 5,
    index_aliases: INDEX_ALIASES,
};

/// Boards that take programs for FX3U. No manual of theirs is public: makers advertise up to eight outputs that send pulses, and which
/// registers the ones behind Y003 would count in is unknown, so these keep no position.
pub(super) const FX3U_COMPATIBLE: Model = Model {
    id: ModelId::Fx3uCompatible,
    name: "fx3u-compatible",
    boards: None,
    title: "FX3U-compatible board",
    cpus: &[],
    nearest: &[],
    pulses: Pulses::Board3u,
    ports: Ports::Board,
    pulse_outputs: &[(Y, 0, 7)],
    ..FX3U
};

/// Devices of FX3S. It has no counter interrupts and no R.
const FX3S_RANGES: &[Range] = &[
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
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 255),
    general(I, 0, 1),
    general(I, 100, 101),
    general(I, 200, 201),
    general(I, 300, 301),
    general(I, 400, 401),
    general(I, 500, 501),
    general(I, 610, 699),
    general(I, 710, 799),
    general(I, 810, 899),
    general(N, 0, 7),
];

/// Devices of FX3G without the optional battery.
const FX3G_RANGES: &[Range] = &[
    general(X, 0o0, 0o377),
    general(Y, 0o0, 0o377),
    general(M, 0, 383),
    latched(M, 384, 1535),
    general(M, 1536, 7679),
    general(M, 8000, 8511),
    latched(S, 0, 999),
    general(S, 1000, 4095),
    general(T, 0, 245),
    latched(T, 246, 255),
    general(T, 256, 319),
    general(C, 0, 15),
    latched(C, 16, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
    general(D, 0, 127),
    latched(D, 128, 1099),
    general(D, 1100, 7999),
    general(D, 8000, 8511),
    general(R, 0, 23999),
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 2047),
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
    general(I, 400, 401),
    general(I, 500, 501),
    general(I, 610, 699),
    general(I, 710, 799),
    general(I, 810, 899),
    general(N, 0, 7),
];

/// Devices of FX3U.
const FX3U_RANGES: &[Range] = &[
    general(X, 0o0, 0o377),
    general(Y, 0o0, 0o377),
    general(M, 0, 499),
    latched(M, 500, 7679),
    general(M, 8000, 8511),
    general(S, 0, 499),
    latched(S, 500, 4095),
    general(T, 0, 245),
    latched(T, 246, 255),
    general(T, 256, 511),
    general(C, 0, 99),
    latched(C, 100, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
    general(D, 0, 199),
    latched(D, 200, 7999),
    general(D, 8000, 8511),
    latched(R, 0, 32767),
    latched(ER, 0, 32767),
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 4095),
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
    general(I, 400, 401),
    general(I, 500, 501),
    general(I, 610, 699),
    general(I, 710, 799),
    general(I, 810, 899),
    general(N, 0, 7),
];

/// Timers of FX3S.
const FX3S_TIMERS: &[Timers] = &[
    timers(0, 62, 100),
    timers(63, 127, 1),
    timers(128, 131, 1).accumulating(),
    timers(132, 137, 100).accumulating(),
];

/// Timers of FX3G.
const FX3G_TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10),
    timers(246, 249, 1).accumulating(),
    timers(250, 255, 100).accumulating(),
    timers(256, 319, 1),
];

/// Timers of FX3U.
const FX3U_TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10),
    timers(246, 249, 1).accumulating(),
    timers(250, 255, 100).accumulating(),
    timers(256, 511, 1),
];
