//! High-speed counters C235 to C255 as data: which inputs they count, and in which way.

use crate::{ModelId, ModelSet};
use rungc_rt::CmpOp;
use rungc_syntax::{Device, DeviceClass};

/// How the inputs of a counter count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// One input; a relay says in which direction (M8235 for C235).
    One,
    /// An input that counts up, and one that counts down.
    UpDown,
    /// An input that counts, and one that says in which direction: down while it is on.
    Direction,
    /// Phases A and B of an encoder.
    Phases,
}

/// A counter and its inputs, as values (X010 is 8).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Counter {
    /// Number.
    pub number: u32,
    /// How it counts.
    pub kind: Kind,
    /// What counts: one input, or two.
    pub counts: &'static [u32],
    /// Sets it to 0.
    pub reset: Option<u32>,
    /// It counts only while this is on.
    pub start: Option<u32>,
}

impl Counter {
    /// All of its inputs.
    pub fn inputs(&self) -> impl Iterator<Item = u32> + use<> {
        let others = [self.reset, self.start];
        self.counts
            .iter()
            .copied()
            .chain(others.into_iter().flatten())
    }
}

/// Relays that make counters of two phases count all four edges of a cycle.
struct FourFold {
    models: ModelSet,
    /// Counter and relay.
    relays: &'static [(u32, u32)],
}

const fn counter(
    number: u32,
    kind: Kind,
    counts: &'static [u32],
    reset: Option<u32>,
    start: Option<u32>,
) -> Counter {
    Counter {
        number,
        kind,
        counts,
        reset,
        start,
    }
}

/// The FX family's counters (h1u-h2u-programming §3.6).
const FX: &[Counter] = &{
    use Kind::{One, Phases, UpDown};
    [
        counter(235, One, &[0], None, None),
        counter(236, One, &[1], None, None),
        counter(237, One, &[2], None, None),
        counter(238, One, &[3], None, None),
        counter(239, One, &[4], None, None),
        counter(240, One, &[5], None, None),
        counter(241, One, &[0], Some(1), None),
        counter(242, One, &[2], Some(3), None),
        counter(243, One, &[4], Some(5), None),
        counter(244, One, &[0], Some(1), Some(6)),
        counter(245, One, &[2], Some(3), Some(7)),
        counter(246, UpDown, &[0, 1], None, None),
        counter(247, UpDown, &[0, 1], Some(2), None),
        counter(248, UpDown, &[3, 4], Some(5), None),
        counter(249, UpDown, &[0, 1], Some(2), Some(6)),
        counter(250, UpDown, &[3, 4], Some(5), Some(7)),
        counter(251, Phases, &[0, 1], None, None),
        counter(252, Phases, &[0, 1], Some(2), None),
        counter(253, Phases, &[3, 4], Some(5), None),
        counter(254, Phases, &[0, 1], Some(2), Some(6)),
        counter(255, Phases, &[3, 4], Some(5), Some(7)),
    ]
};

/// HM's counters (hm-motion-controller §5.1.5).
const HM: &[Counter] = &{
    use Kind::{Direction, One, Phases};
    [
        counter(235, One, &[0o0], None, None),
        counter(237, One, &[0o2], None, None),
        counter(239, One, &[0o0], Some(0o10), None),
        counter(240, One, &[0o2], Some(0o11), None),
        counter(241, One, &[0o0], Some(0o10), Some(0o12)),
        counter(242, One, &[0o2], Some(0o11), Some(0o13)),
        counter(244, Direction, &[0o0, 0o1], None, None),
        counter(245, Direction, &[0o2, 0o3], None, None),
        counter(246, Direction, &[0o0, 0o1], Some(0o10), None),
        counter(247, Direction, &[0o2, 0o3], Some(0o11), None),
        counter(248, Direction, &[0o0, 0o1], Some(0o10), Some(0o12)),
        counter(249, Direction, &[0o2, 0o3], Some(0o11), Some(0o13)),
        counter(250, Phases, &[0o0, 0o1], None, None),
        counter(251, Phases, &[0o2, 0o3], None, None),
        counter(252, Phases, &[0o0, 0o1], Some(0o10), None),
        counter(253, Phases, &[0o2, 0o3], Some(0o11), None),
        counter(254, Phases, &[0o0, 0o1], Some(0o10), Some(0o12)),
        counter(255, Phases, &[0o2, 0o3], Some(0o11), Some(0o13)),
    ]
};

/// Four-fold counting (h1u-h2u-programming §3.6; l01s-programming, table of special relays).
const FOUR_FOLD: &[FourFold] = &[
    FourFold {
        models: INOVANCE,
        relays: &[
            (251, 8195),
            (252, 8196),
            (253, 8197),
            (254, 8198),
            (255, 8199),
        ],
    },
    FourFold {
        models: ModelSet::L01S.or(ModelSet::FX3),
        relays: &[
            (251, 8198),
            (252, 8198),
            (253, 8199),
            (254, 8198),
            (255, 8199),
        ],
    },
];

const INOVANCE: ModelSet = ModelSet::INOVANCE;
/// Models on which a counter stays at 0 as long as its reset input is on (h1u-h2u-programming §3.6, l01s-programming §6.3). On the
/// others it is reset at the edge.
pub const HELD_BY_RESET: ModelSet = ModelSet::INOVANCE.or(ModelSet::L01S).or(ModelSet::HM);
/// Models with [`EDGE_RESET`] and [`NO_RESET`].
pub const RESET_RELAYS: ModelSet = INOVANCE;
/// Only the edge of a reset input resets.
pub const EDGE_RESET: u32 = 8166;
/// Reset inputs do nothing.
pub const NO_RESET: u32 = 8169;
/// Comparisons act when a reset input resets the counter, too.
pub const COMPARE_AT_RESET: u32 = 8025;

/// The relay of input X000, behind which the others' follow, that makes SPD show pulses a minute (h1u-h2u-programming §4.3.6).
pub fn per_minute(model: ModelId) -> Option<u32> {
    INOVANCE.has(model).then_some(8100)
}

/// How many comparisons at the count a model makes at a time, tables among them (h1u-h2u-programming §4.3.6; FX1S/FX1N/FX2N programming
/// manual II §5.6; FX3 programming manual §14.4); `None`: any number.
pub fn most_comparisons(model: ModelId) -> Option<u32> {
    match model {
        ModelId::Fx1s | ModelId::Fx1n => Some(4),
        ModelId::H1u
        | ModelId::H2u
        | ModelId::Fx2n
        | ModelId::Fx2nCompatible
        | ModelId::Fx3s
        | ModelId::Fx3g => Some(6),
        ModelId::Fx3u | ModelId::Fx3uCompatible => Some(32),
        ModelId::L01s | ModelId::Hm => None,
    }
}

/// Models on which a comparison acts when the count crosses the value in either direction, also where the program changes one of
/// them, and not only at a count that equals it (hm-motion-controller §8.3.14).
pub const CROSSING: ModelSet = ModelSet::HM;
/// The zones in which comparisons of those models run.
pub const ZONES: std::ops::RangeInclusive<i32> = 0..=5;

/// How a table of rows that wait for counts works.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TableMode {
    /// The relay that HSZ names instead of bits; `None`: HSCT.
    pub relay: Option<u32>,
    /// Words of a row: the count, a pair, and what it says, a word or a pair.
    pub words: u32,
    /// Its rows are those that stand when the first scan that drives it ends.
    pub fixed: bool,
    /// A row is reached when this holds between the count and its own.
    pub reached: CmpOp,
    /// Behind the last row comes the first.
    pub repeats: bool,
    /// A mask says which bits of a row's pattern are written.
    pub masked: bool,
    /// Register of the row that waits.
    pub row: Option<u32>,
    /// Relay that is on when the last row was reached, …
    pub done: Option<u32>,
    /// … for a scan; else until the table begins again or is not driven.
    pub done_for_a_scan: bool,
    /// What the row that waits says, shown instead of done.
    pub shows: Option<Shown>,
}

/// Pairs of registers that show a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shown {
    /// What it says.
    pub word: u32,
    /// The count that it waits for.
    pub count: u32,
}

/// HSZ with M8130: rows switch outputs (h1u-h2u-programming §4.3.6).
const OUTPUTS: TableMode = TableMode {
    relay: Some(8130),
    words: 4,
    fixed: true,
    reached: CmpOp::Eq,
    repeats: true,
    masked: false,
    row: Some(8130),
    done: Some(8131),
    done_for_a_scan: true,
    shows: None,
};

/// HSZ with M8132: rows give the frequency of PLSY (h1u-h2u-programming §4.3.6).
const FREQUENCIES: TableMode = TableMode {
    relay: Some(8132),
    row: Some(8131),
    done: Some(8133),
    done_for_a_scan: false,
    shows: Some(Shown {
        word: 8132,
        count: 8134,
    }),
    ..OUTPUTS
};

/// HSCT of the FX family.
const PATTERNS: TableMode = TableMode {
    relay: None,
    words: 3,
    row: Some(8138),
    done: Some(8138),
    ..OUTPUTS
};

/// DHSCT of HM (hm-motion-controller §8.3.17).
const MASKED_PATTERNS: TableMode = TableMode {
    fixed: false,
    reached: CmpOp::Ge,
    repeats: false,
    masked: true,
    row: None,
    done: None,
    ..PATTERNS
};

/// The table that HSZ works through if it names this relay.
pub fn zone_table(relay: Device) -> Option<&'static TableMode> {
    [&OUTPUTS, &FREQUENCIES]
        .into_iter()
        .find(|mode| relay.class == DeviceClass::M && mode.relay == Some(relay.number))
}

/// The table of HSCT.
pub fn pattern_table(model: ModelId) -> &'static TableMode {
    if model == ModelId::Hm {
        &MASKED_PATTERNS
    } else {
        &PATTERNS
    }
}

/// Registers of an input axis of HM, which show a count (hm-motion-controller §8.2.2).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Axis {
    /// The input that counts.
    pub input: u32,
    /// Pair for the count.
    pub count: u32,
    /// Pair for the upper half of the count as 64 bits.
    pub upper: u32,
    /// Pair for the count at the last interrupt of one of two inputs.
    pub captured: u32,
    /// These inputs.
    pub capture: [u32; 2],
}

/// HM's input axes.
const AXES: &[Axis] = &[
    Axis {
        input: 0,
        count: 200,
        upper: 202,
        captured: 206,
        capture: [4, 5],
    },
    Axis {
        input: 2,
        count: 250,
        upper: 252,
        captured: 256,
        capture: [6, 7],
    },
];

/// The input axes of a model.
pub fn axes(model: ModelId) -> &'static [Axis] {
    if model == ModelId::Hm { AXES } else { &[] }
}

/// What measures the pulses of an input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Meter {
    /// The input.
    pub input: u32,
    /// First of three pairs of registers: the ring counter at the rising edge, at the falling edge, the width or the period.
    pub registers: u32,
    /// Relays of which all must be on; none: it always measures.
    pub measures: &'static [u32],
    /// While this relay is on it measures periods.
    pub period: Option<u32>,
}

const fn meter(input: u32, registers: u32, measures: &'static [u32], period: Option<u32>) -> Meter {
    Meter {
        input,
        registers,
        measures,
        period,
    }
}

/// Those of FX3S and FX3G.
const FX3G_METERS: &[Meter] = &[
    meter(0, 8074, &[8075, 8076], Some(8080)),
    meter(1, 8080, &[8075, 8077], Some(8081)),
    meter(3, 8086, &[8075, 8078], Some(8082)),
    meter(4, 8092, &[8075, 8079], Some(8083)),
];

/// L01S's, of which the manual tells the registers only (l01s-programming, table of special registers).
const L01S_METERS: &[Meter] = &[
    meter(0, 8074, &[], None),
    meter(1, 8080, &[], None),
    meter(3, 8086, &[], None),
    meter(4, 8092, &[], None),
];

/// What measures pulses on a model.
pub fn meters(model: ModelId) -> &'static [Meter] {
    match model {
        ModelId::Fx3s | ModelId::Fx3g => FX3G_METERS,
        ModelId::L01s => L01S_METERS,
        _ => &[],
    }
}

/// Registers that count the rising edges of inputs from X000 on (hm-motion-controller §5.7).
pub fn edge_counts(model: ModelId) -> Option<std::ops::RangeInclusive<u32>> {
    (model == ModelId::Hm).then_some(8160..=8167)
}

/// The first counter that counts pulses of inputs; those below are counted by the program.
pub const FIRST: u32 = 235;

/// The high-speed counters of a model.
pub fn counters(model: ModelId) -> &'static [Counter] {
    if model == ModelId::Hm { HM } else { FX }
}

/// The relay that makes a counter count four-fold.
pub fn four_fold(model: ModelId, number: u32) -> Option<u32> {
    let row = FOUR_FOLD.iter().find(|row| row.models.has(model))?;
    let found = row.relays.iter().find(|relay| relay.0 == number)?;
    Some(found.1)
}
