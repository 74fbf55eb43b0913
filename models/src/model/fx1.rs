//! Mitsubishi FX1S and FX1N (FX1S, FX1N, FX2N, FX2NC programming manual II, JY992D88101, §8.1 and §8.2). What they keep without power,
//! in EEPROM or by a capacitor, is fixed.

use super::{INDEX_ALIASES, M8028, Model, ModelId, Range, Timers, general, latched, timers};
use rungc_rt::{Ports, Pulses};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, I, M, N, P, S, T, V, X, Y, Z};

/// Mitsubishi FX1S.
pub(super) const FX1S: Model = Model {
    id: ModelId::Fx1s,
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
    ..FX1N
};

const FX0: &str = "FX0 and FX0S keep M496–M511, C14, C15, D30 and D31 without power, and fx1s keeps M384–M511, C16–C31 and D128–D255";

/// Mitsubishi FX1N.
pub(super) const FX1N: Model = Model {
    id: ModelId::Fx1n,
    name: "fx1n",
    boards: None,
    title: "Mitsubishi FX1N",
    cpus: &["FX1N", "FX1NC"],
    nearest: &[],
    ranges: FX1N_RANGES,
    timers: FX1N_TIMERS,
    fast_timers: None,
    latch_choices: &[],
    latch_key: None,
    keeps_contacts: true,
    end_pointer: Some(63),
    max_steps: 8000,
    z_pairs_with_v: true,
    error_relay: 8067,
    errors_last_a_scan: true,
    annunciators_are_states: false,
    value_error: 6706,
    pulses: Pulses::Fx1,
    ports: Ports::Fx,
    pulse_outputs: &[(Y, 0, 1)],
    position_outputs: &[(Y, 0, 1)],
    notations: Classes::NONE,
    bare_names: true,
    steps_per_operand: None,
    max_for: 5,
    max_call: 5,
    index_aliases: INDEX_ALIASES,
};

/// Devices of FX1S. D1000 to D2499 are file registers. It has neither timer nor counter interrupts.
const FX1S_RANGES: &[Range] = &[
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
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 63),
    general(I, 0, 1),
    general(I, 100, 101),
    general(I, 200, 201),
    general(I, 300, 301),
    general(I, 400, 401),
    general(I, 500, 501),
    general(N, 0, 7),
];

/// Devices of FX1N. It has neither timer nor counter interrupts.
const FX1N_RANGES: &[Range] = &[
    general(X, 0o0, 0o177),
    general(Y, 0o0, 0o177),
    general(M, 0, 383),
    latched(M, 384, 1535),
    general(M, 8000, 8255),
    latched(S, 0, 999),
    general(T, 0, 245),
    latched(T, 246, 255),
    general(C, 0, 15),
    latched(C, 16, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
    general(D, 0, 127),
    latched(D, 128, 7999),
    general(D, 8000, 8255),
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 127),
    general(I, 0, 1),
    general(I, 100, 101),
    general(I, 200, 201),
    general(I, 300, 301),
    general(I, 400, 401),
    general(I, 500, 501),
    general(N, 0, 7),
];

/// Timers of FX1S.
const FX1S_TIMERS: &[Timers] = &[timers(0, 62, 100), timers(63, 63, 1)];

/// Timers of FX1N.
const FX1N_TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10),
    timers(246, 249, 1).accumulating(),
    timers(250, 255, 100).accumulating(),
];
