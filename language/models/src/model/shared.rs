//! Common parts of the models' files: the notation of runs of devices, and runs that several models have.

use super::{FastTimers, Range, Timers};
use crate::runs::IndexAlias;
use rungc_rt::{Relay, TimerKind};
use rungc_syntax::DeviceClass::{self, C, I, N, T, V, X, Y, Z};

/// Joins runs to one table.
macro_rules! joined {
    ($of:ty: $($part:expr),* $(,)?) => {{
        const PARTS: &[&[$of]] = &[$($part),*];
        &$crate::model::shared::join::<$of, { $crate::model::shared::total(PARTS) }>(PARTS)
    }};
}
pub(super) use joined;

pub(super) const fn total<T>(parts: &[&[T]]) -> usize {
    let (mut sum, mut i) = (0, 0);
    while i < parts.len() {
        sum += parts[i].len();
        i += 1;
    }
    sum
}

pub(super) const fn join<T: Copy, const LEN: usize>(parts: &[&[T]]) -> [T; LEN] {
    let mut all = [parts[0][0]; LEN];
    let (mut filled, mut part) = (0, 0);
    while part < parts.len() {
        let mut i = 0;
        while i < parts[part].len() {
            all[filled] = parts[part][i];
            filled += 1;
            i += 1;
        }
        part += 1;
    }
    all
}

/// X and Y as far as expansion modules can number them.
pub(super) const TERMINALS: &[Range] = &[general(X, 0o0, 0o377), general(Y, 0o0, 0o377)];

/// T0 to T255.
pub(super) const TIMERS_256: &[Range] = &[general(T, 0, 245), latched(T, 246, 255)];

/// Counters of models that keep C16 on.
pub(super) const COUNTERS_FROM_16: &[Range] = &[
    general(C, 0, 15),
    latched(C, 16, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
];

/// Counters of models that keep C100 on.
pub(super) const COUNTERS_FROM_100: &[Range] = &[
    general(C, 0, 99),
    latched(C, 100, 199),
    general(C, 200, 219),
    latched(C, 220, 255),
];

/// V and Z.
pub(super) const INDEXES: &[Range] = &[general(V, 0, 7), general(Z, 0, 7)];

/// Interrupts of X000 to X005.
pub(super) const I_INPUTS: &[Range] = &[
    general(I, 0, 1),
    general(I, 100, 101),
    general(I, 200, 201),
    general(I, 300, 301),
    general(I, 400, 401),
    general(I, 500, 501),
];

/// Interrupts of X000 to X005, and of six comparisons of high-speed counters.
pub(super) const I_INPUTS_AND_COUNTERS: &[Range] = &[
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
];

/// Interrupts of three timers, of 10 ms and more.
pub(super) const I_TIMERS: &[Range] = &[
    general(I, 610, 699),
    general(I, 710, 799),
    general(I, 810, 899),
];

/// Nesting levels of MC.
pub(super) const NESTS: &[Range] = &[general(N, 0, 7)];

/// Timers T0 to T255 of the FX family.
pub(super) const FX_TIMERS: &[Timers] = &[
    timers(0, 191, 100),
    timers(192, 199, 100).free_running(),
    timers(200, 245, 10),
    timers(246, 249, 1).accumulating().free_running(),
    timers(250, 255, 100).accumulating(),
];

/// Devices of which the parameters of FX2N, FX3U and H2U choose the latched ones: those marked with ※1 and ※2
/// (h1u-h2u-programming §3.3 to §3.7), those of FX2N and FX3U likewise.
pub(super) const LATCH_CHOICES: &[(DeviceClass, u32, u32)] = &{
    use DeviceClass::{C, D, M, S};
    [(M, 0, 1023), (S, 0, 999), (C, 0, 255), (D, 0, 511)]
};

/// A run of devices that go back to 0 at power-off.
pub(super) const fn general(class: DeviceClass, first: u32, last: u32) -> Range {
    Range {
        class,
        first,
        last,
        latched: false,
    }
}

/// A run of devices that keep their values.
pub(super) const fn latched(class: DeviceClass, first: u32, last: u32) -> Range {
    Range {
        latched: true,
        ..general(class, first, last)
    }
}

/// A run of timers of this unit that start again whenever they are driven.
pub(super) const fn timers(first: u32, last: u32, unit_ms: u16) -> Timers {
    Timers {
        first,
        last,
        kind: TimerKind {
            unit_ms,
            accumulating: false,
            free_running: false,
            latches_preset: false,
            overruns: false,
            stepwise: false,
            shared: false,
        },
    }
}

impl Timers {
    pub(super) const fn accumulating(self) -> Self {
        self.with(TimerKind {
            accumulating: true,
            ..self.kind
        })
    }

    pub(super) const fn free_running(self) -> Self {
        self.with(TimerKind {
            free_running: true,
            ..self.kind
        })
    }

    pub(super) const fn latching_preset(self) -> Self {
        self.with(TimerKind {
            latches_preset: true,
            ..self.kind
        })
    }

    pub(super) const fn overrunning(self) -> Self {
        self.with(TimerKind {
            overruns: true,
            ..self.kind
        })
    }

    pub(super) const fn stepwise(self) -> Self {
        self.with(TimerKind {
            stepwise: true,
            ..self.kind
        })
    }

    const fn with(self, kind: TimerKind) -> Self {
        Timers { kind, ..self }
    }
}

/// M8028 of FX1S and FX3S: T32 to T62 count 10 ms (FX1S/FX1N/FX2N programming manual II §4.7, FX3 programming manual
/// §4.5).
pub(super) const M8028: &FastTimers = &FastTimers {
    relay: Relay(8028),
    numbers: 32..=62,
    unit_ms: 10,
};

/// D8028, D8029 and D8182–D8195: other names of Z0, V0, Z1, V1, … Z7, V7 (h1u-h2u-programming §3.8).
pub(super) const INDEX_ALIASES: &[IndexAlias] = &{
    use DeviceClass::{V, Z};
    [
        IndexAlias::new(8028, Z, 0),
        IndexAlias::new(8029, V, 0),
        IndexAlias::new(8182, Z, 1),
        IndexAlias::new(8183, V, 1),
        IndexAlias::new(8184, Z, 2),
        IndexAlias::new(8185, V, 2),
        IndexAlias::new(8186, Z, 3),
        IndexAlias::new(8187, V, 3),
        IndexAlias::new(8188, Z, 4),
        IndexAlias::new(8189, V, 4),
        IndexAlias::new(8190, Z, 5),
        IndexAlias::new(8191, V, 5),
        IndexAlias::new(8192, Z, 6),
        IndexAlias::new(8193, V, 6),
        IndexAlias::new(8194, Z, 7),
        IndexAlias::new(8195, V, 7),
    ]
};
