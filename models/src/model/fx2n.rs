//! Mitsubishi FX2N and FX2NC, and compatible boards (FX1S, FX1N, FX2N, FX2NC programming manual II, JY992D88101, §8). Latched ranges
//! are the factory settings.

use super::{
    INDEX_ALIASES, LATCH_CHOICES, Model, ModelId, Range, Timers, general, latched, timers,
};
use rungc_rt::{Ports, Pulses};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, I, M, N, P, S, T, V, X, Y, Z};

const FX2: &str =
    "it has fewer devices and instructions than fx2n, and what does not exist there is not refused";

/// Mitsubishi FX2N.
pub(super) const FX2N: Model = Model {
    id: ModelId::Fx2n,
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
    timers: TIMERS,
    fast_timers: None,
    latch_choices: LATCH_CHOICES,
    latch_key: None,
    keeps_contacts: true,
    end_pointer: Some(63),
    max_steps: 16000,
    z_pairs_with_v: true,
    error_relay: 8067,
    errors_last_a_scan: true,
    annunciators_are_states: false,
    value_error: 6706,
    pulses: Pulses::Fx2n,
    ports: Ports::Fx,
    pulse_outputs: &[(Y, 0, 1)],
    position_outputs: &[(Y, 0, 1)],
    notations: Classes::TEXT,
    bare_names: true,
    steps_per_operand: None,
    max_for: 5,
    max_call: 5,
    index_aliases: INDEX_ALIASES,
};

/// Boards that take programs for FX2N. No manual of theirs is public: makers advertise up to eight outputs that send pulses, and which
/// registers the ones behind Y001 would count in is unknown, so these keep no position.
pub(super) const FX2N_COMPATIBLE: Model = Model {
    id: ModelId::Fx2nCompatible,
    name: "fx2n-compatible",
    boards: None,
    title: "FX2N-compatible board",
    cpus: &[],
    nearest: &[],
    pulses: Pulses::Board2n,
    ports: Ports::Board,
    pulse_outputs: &[(Y, 0, 7)],
    ..FX2N
};

/// Devices of FX2N.
const RANGES: &[Range] = &[
    general(X, 0o0, 0o377),
    general(Y, 0o0, 0o377),
    general(M, 0, 499),
    latched(M, 500, 3071),
    general(M, 8000, 8255),
    general(S, 0, 499),
    latched(S, 500, 999),
    general(T, 0, 245),
    latched(T, 246, 255),
    general(C, 0, 99),
    latched(C, 100, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
    general(D, 0, 199),
    latched(D, 200, 7999),
    general(D, 8000, 8255),
    general(V, 0, 7),
    general(Z, 0, 7),
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
    general(I, 400, 401),
    general(I, 500, 501),
    general(I, 610, 699),
    general(I, 710, 799),
    general(I, 810, 899),
    general(N, 0, 7),
];

/// Timers of FX2N.
const TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10),
    timers(246, 249, 1).accumulating(),
    timers(250, 255, 100).accumulating(),
];
