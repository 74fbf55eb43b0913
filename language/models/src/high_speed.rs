//! High-speed counters C235 to C255: which inputs they count, and in which way; what else looks at fast inputs.

use rungc_rt::{CmpOp, Register, Relay};
use rungc_syntax::{Device, DeviceClass};
use std::ops::RangeInclusive;

/// The first counter that counts pulses of inputs; those below are counted by the program.
pub const FIRST: u32 = 235;

/// High-speed counters of a model, and what its instructions for high-speed inputs do.
#[derive(Clone, Debug)]
pub struct HighSpeed {
    /// Its counters.
    pub counters: &'static [Counter],
    /// Counters that the manual lists without inputs.
    pub idle: &'static [u32],
    /// Counters of two phases, each with the relay that makes it count all four edges of a cycle.
    pub four_fold: &'static [(u32, Relay)],
    /// Counters of one input may take turns.
    pub counters_take_turns: bool,
    /// A counter stays at 0 as long as its reset input is on. Else it is reset at the edge.
    pub held_by_reset: bool,
    /// Relays that change what reset inputs do.
    pub reset_relays: Option<ResetRelays>,
    /// Maximum number of comparisons at the count at a time, tables among them; `None`: any number.
    pub most_comparisons: Option<u32>,
    /// Relay that is on while comparisons are executed, and the register with their number.
    pub executed: Option<(Relay, Register)>,
    /// A comparison acts when the count crosses the value in either direction, also where the program changes one of
    /// them, and not only at a count that equals it: the zones in which such comparisons run.
    pub crossing_zones: Option<RangeInclusive<i32>>,
    /// The table of HSCT.
    pub patterns: TableMode,
    /// Input axes.
    pub axes: &'static [Axis],
    /// A counter may count at the input of SPD (h1u-h2u-programming §4.3.6).
    pub spd_takes_counters: bool,
    /// The relay of input X000, after which the others' follow, that makes SPD show pulses a minute.
    pub per_minute: Option<Relay>,
    /// Meters of pulses.
    pub meters: &'static [Meter],
    /// Registers that count the rising edges of inputs from X000 on.
    pub edge_counts: &'static [Register],
}

impl HighSpeed {
    /// The counter of this number.
    pub fn counter(&self, number: u32) -> Option<&'static Counter> {
        let mut counters = self.counters.iter();
        counters.find(|counter| counter.number == number)
    }

    /// The relay that makes a counter count four-fold.
    pub fn four_fold(&self, number: u32) -> Option<Relay> {
        let mut relays = self.four_fold.iter();
        relays.find(|relay| relay.0 == number).map(|relay| relay.1)
    }
}

/// Relays that change what reset inputs of counters do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ResetRelays {
    /// Only the edge of a reset input resets.
    pub edge: Relay,
    /// Reset inputs do nothing.
    pub off: Relay,
}

/// Units of hardware that fast inputs and outputs share.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FastUnits {
    /// Total number of units.
    pub total: u32,
    /// Those of a pulse output.
    pub output: u32,
    /// Those of SPD.
    pub density: u32,
    /// Those of an interrupt or the catching of pulses.
    pub edge: u32,
    /// Those of a counter of one input.
    pub one: u32,
    /// Those of a counter of two inputs.
    pub two: u32,
    /// Those of a counter of two phases.
    pub phases: u32,
}

impl FastUnits {
    /// Units of a high-speed counter.
    pub const fn counter(&self, kind: Kind) -> u32 {
        match kind {
            Kind::One => self.one,
            Kind::UpDown | Kind::Direction => self.two,
            Kind::Phases => self.phases,
        }
    }
}

/// Counting mode of a counter's inputs.
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
    /// Counting mode.
    pub kind: Kind,
    /// Inputs that count: one or two.
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

pub(crate) const fn counter(
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
const COUNTERS: &[Counter] = &{
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

/// C243 of L01S has no inputs (l01s-programming §6.1).
pub(crate) const IDLE_L01S: u32 = 243;

/// The other counters of L01S.
pub(crate) const COUNTERS_L01S: &[Counter] = &{
    let mut counters = [COUNTERS[0]; COUNTERS.len() - 1];
    let (mut from, mut to) = (0, 0);
    while from < COUNTERS.len() {
        if COUNTERS[from].number != IDLE_L01S {
            counters[to] = COUNTERS[from];
            to += 1;
        }
        from += 1;
    }
    counters
};

/// Common properties of the FX family's models: comparisons act at a count that equals the value, and an edge of a
/// reset input resets.
pub(crate) const FX: HighSpeed = HighSpeed {
    counters: COUNTERS,
    idle: &[],
    four_fold: &[],
    counters_take_turns: false,
    held_by_reset: false,
    reset_relays: None,
    most_comparisons: Some(6),
    executed: None,
    crossing_zones: None,
    patterns: PATTERNS,
    axes: &[],
    spd_takes_counters: false,
    per_minute: None,
    meters: &[],
    edge_counts: &[],
};

/// Four-fold counting of L01S and FX3 (l01s-programming, table of special relays).
pub(crate) const FOUR_FOLD: &[(u32, Relay)] = &[
    (251, Relay(8198)),
    (252, Relay(8198)),
    (253, Relay(8199)),
    (254, Relay(8198)),
    (255, Relay(8199)),
];

/// Mode of a table of rows that wait for counts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TableMode {
    /// The relay that HSZ names instead of bits; `None`: HSCT.
    pub relay: Option<Relay>,
    /// Words of a row: the count, a pair, and what it says, a word or a pair.
    pub words: u32,
    /// Its rows are those in place when the first scan that drives it ends.
    pub fixed: bool,
    /// A row is reached when this holds between the count and its own.
    pub reached: CmpOp,
    /// After the last row comes the first.
    pub repeats: bool,
    /// A mask says which bits of a row's pattern are written.
    pub masked: bool,
    /// Register of the row that waits.
    pub row: Option<Register>,
    /// Relay that is on when the last row was reached, …
    pub done: Option<Relay>,
    /// … for a scan; else until the table begins again or is not driven.
    pub done_for_a_scan: bool,
    /// Word of the waiting row that is shown, instead of done.
    pub shows: Option<Shown>,
}

/// Pairs of registers that show a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Shown {
    /// Register for the word.
    pub word: Register,
    /// The count that it waits for.
    pub count: Register,
}

/// HSZ with M8130: rows switch outputs (h1u-h2u-programming §4.3.6).
const OUTPUTS: TableMode = TableMode {
    relay: Some(Relay(8130)),
    words: 4,
    fixed: true,
    reached: CmpOp::Eq,
    repeats: true,
    masked: false,
    row: Some(Register(8130)),
    done: Some(Relay(8131)),
    done_for_a_scan: true,
    shows: None,
};

/// HSZ with M8132: rows give the frequency of PLSY (h1u-h2u-programming §4.3.6).
const FREQUENCIES: TableMode = TableMode {
    relay: Some(Relay(8132)),
    row: Some(Register(8131)),
    done: Some(Relay(8133)),
    done_for_a_scan: false,
    shows: Some(Shown {
        word: Register(8132),
        count: Register(8134),
    }),
    ..OUTPUTS
};

/// HSCT of the FX family.
pub(crate) const PATTERNS: TableMode = TableMode {
    relay: None,
    words: 3,
    row: Some(Register(8138)),
    done: Some(Relay(8138)),
    ..OUTPUTS
};

/// The table that HSZ works through if it names this relay.
pub fn zone_table(relay: Device) -> Option<&'static TableMode> {
    [&OUTPUTS, &FREQUENCIES].into_iter().find(|mode| {
        relay.class == DeviceClass::M && mode.relay.is_some_and(|own| own.number() == relay.number)
    })
}

/// Registers of an input axis, which show a count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Axis {
    /// The input that counts.
    pub input: u32,
    /// Pair for the count.
    pub count: Register,
    /// Pair for the upper half of the count as 64 bits.
    pub upper: Register,
    /// Pair for the count at the last interrupt of one of two inputs.
    pub captured: Register,
    /// Pair for the count when a comparison last requested an interrupt.
    pub compared: Register,
    /// Counting mode: 0 phases, 1 direction, 2 up, 3 down.
    pub mode: Register,
    /// Pulses of the last millisecond.
    pub per_ms: Register,
    /// These inputs.
    pub capture: [u32; 2],
}

/// Meter of an input's pulses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Meter {
    /// The input.
    pub input: u32,
    /// First of three pairs of registers: the ring counter at the rising edge, at the falling edge, the width or the
    /// period.
    pub registers: Register,
    /// Relays of which all must be on; none: it always measures.
    pub measures: &'static [Relay],
    /// While this relay is on it measures periods.
    pub period: Option<Relay>,
}
