//! Kewei HM motion controller (hm-motion-controller §5.1).

use super::{Model, ModelId, Range, Timers, general, latched, timers};
use rungc_rt::{Ports, Pulses};
use rungc_syntax::Classes;
use rungc_syntax::DeviceClass::{self, C, D, I, M, N, P, R, S, T, V, X, Y, Z};

/// Kewei HM.
pub(super) const HM: Model = Model {
    id: ModelId::Hm,
    name: "hm",
    boards: None,
    title: "Kewei HM",
    cpus: &["HM"],
    nearest: &[],
    ranges: RANGES,
    timers: TIMERS,
    fast_timers: None,
    latch_choices: &[],
    latch_key: Some((8020, 2222)),
    keeps_contacts: false,
    end_pointer: None,
    max_steps: 12000,
    z_pairs_with_v: false,
    error_relay: 8006,
    errors_last_a_scan: false,
    annunciators_are_states: false,
    value_error: 6707,
    pulses: Pulses::Hm,
    ports: Ports::Hm,
    pulse_outputs: &[],
    position_outputs: &[],
    notations: Classes::NONE,
    bare_names: true,
    steps_per_operand: Some((2, 3)),
    max_for: 5,
    max_call: 8,
    index_aliases: INDEX_ALIASES,
};

/// Devices.
const RANGES: &[Range] = &[
    general(X, 0o0, 0o377),
    general(Y, 0o0, 0o377),
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
    general(N, 0, 7),
];

/// Timers. They go on counting after the preset.
const TIMERS: &[Timers] = &[
    timers(0, 199, 100).overrunning(),
    timers(200, 245, 10).overrunning(),
    timers(246, 249, 1).accumulating().overrunning(),
    timers(250, 255, 100).accumulating().overrunning(),
];

/// D8100–D8115: other names of V0–V7 and Z0–Z7 (hm-motion-controller §5.7.2).
const INDEX_ALIASES: &[(u32, DeviceClass, u32)] = &[
    (8100, V, 0),
    (8101, V, 1),
    (8102, V, 2),
    (8103, V, 3),
    (8104, V, 4),
    (8105, V, 5),
    (8106, V, 6),
    (8107, V, 7),
    (8108, Z, 0),
    (8109, Z, 1),
    (8110, Z, 2),
    (8111, Z, 3),
    (8112, Z, 4),
    (8113, Z, 5),
    (8114, Z, 6),
    (8115, Z, 7),
];
