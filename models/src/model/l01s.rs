//! Coolmay L01S (l01s-programming §3).

use super::{INDEX_ALIASES, Model, ModelId, Range, Timers, general, latched, timers};
use rungc_rt::{Ports, Pulses};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{C, D, I, M, N, P, R, S, T, V, X, Y, Z};

/// Coolmay L01S.
pub(super) const L01S: Model = Model {
    id: ModelId::L01s,
    name: "l01s",
    boards: None,
    title: "Coolmay L01S",
    cpus: &["L01S"],
    nearest: &[],
    ranges: RANGES,
    timers: TIMERS,
    fast_timers: None,
    latch_choices: &[],
    latch_key: None,
    keeps_contacts: true,
    end_pointer: Some(63),
    max_steps: 30000,
    z_pairs_with_v: true,
    error_relay: 8067,
    errors_last_a_scan: true,
    annunciators_are_states: false,
    value_error: 6706,
    pulses: Pulses::L01s,
    ports: Ports::L01s,
    pulse_outputs: &[(Y, 0, 3)],
    position_outputs: &[(Y, 0, 3)],
    notations: Classes::E.or(Classes::TEXT),
    bare_names: true,
    steps_per_operand: None,
    max_for: 5,
    max_call: 5,
    index_aliases: INDEX_ALIASES,
};

/// Devices. X and Y reach as far as expansion modules can number them; R is what the Modbus map gives.
const RANGES: &[Range] = &[
    general(X, 0o0, 0o377),
    general(Y, 0o0, 0o377),
    general(M, 0, 383),
    latched(M, 384, 7679),
    general(M, 8000, 8511),
    latched(S, 0, 4095),
    general(T, 0, 245),
    latched(T, 246, 255),
    general(T, 256, 319),
    general(C, 0, 15),
    latched(C, 16, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
    general(D, 0, 127),
    latched(D, 128, 7999),
    general(D, 8000, 8511),
    general(R, 0, 23999),
    general(V, 0, 7),
    general(Z, 0, 7),
    general(P, 0, 1280),
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
    general(I, 602, 699),
    general(I, 702, 799),
    general(I, 805, 899),
    general(N, 0, 7),
];

/// Timers.
const TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10).stepwise(),
    timers(246, 249, 1).accumulating(),
    timers(250, 255, 100).accumulating(),
    timers(256, 319, 1),
];
