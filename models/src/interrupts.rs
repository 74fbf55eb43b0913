//! Interrupt pointers as data: what requests each, and what keeps it from running.

use crate::{ModelId, ModelSet};
use rungc_rt::EdgeKind;

/// What requests an interrupt.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Source {
    /// An edge of an input terminal.
    Input {
        /// Terminal X, a plain number.
        number: u32,
        /// Which change.
        kind: EdgeKind,
    },
    /// So many milliseconds of RUN have passed.
    Period {
        /// Period, at least 1.
        ms: u32,
    },
    /// A comparison of a high-speed counter (HSCS with this pointer).
    Comparison {
        /// Pointer I.
        pointer: u32,
    },
    /// A row of [`CountRows`].
    Row {
        /// Pointer I.
        pointer: u32,
    },
    /// A train of pulses has been sent to its end.
    PulsesEnd {
        /// Output Y.
        output: u32,
    },
}

/// The relay that decides whether an interrupt routine may run.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Gate {
    /// It may not while this relay is on.
    Forbids(u32),
    /// It may while this relay is on.
    Allows(u32),
}

/// An interrupt routine's own conditions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Interrupt {
    /// What requests it; `None`: only its request relay.
    pub source: Option<Source>,
    /// The relay that keeps the request, and may be set by the program (HM); it goes off when the routine begins.
    pub request: Option<u32>,
    /// Whether it may run. A request that is not kept in a relay is lost if not.
    pub gate: Gate,
}

/// An advanced interrupt of HM: its routine may be left in the middle, and entered there again (hm-motion-controller §5.5.8).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Advanced {
    /// The relay that forbids it while on.
    pub mask: u32,
    /// The relay that is on from the first entry to the end of the routine.
    pub active: u32,
    /// The relay that requests it; it goes off when the routine begins.
    pub request: u32,
    /// The relay that requests the next entry of a routine that is active; it goes off then.
    pub again: u32,
    /// What else requests the next entry.
    pub source: Option<Source>,
}

/// What the edges of two inputs interrupt, as a register says (hm-motion-controller §5.5.6).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Capture {
    /// The register. Its low digit is 0 if the first input's falling edge interrupts, its high digit 1 if the second one's falling
    /// edge does, 2 if its rising edge does.
    pub register: u32,
    /// The inputs.
    pub inputs: [u32; 2],
    /// It is read at the end of the first scan, and when a counter that counts this input is reset.
    pub counted: u32,
}

impl Capture {
    /// Which bits of the register must have which value for an edge to interrupt.
    pub fn demands(&self, input: u32, kind: EdgeKind) -> Option<(i32, i32)> {
        match (self.inputs.iter().position(|&own| own == input)?, kind) {
            (0, EdgeKind::Falling) => Some((0x0f, 0)),
            (1, EdgeKind::Falling) => Some((0xf0, 0x10)),
            (1, EdgeKind::Rising) => Some((0xf0, 0x20)),
            _ => None,
        }
    }
}

/// HM's registers of edges.
const CAPTURES: &[Capture] = &[
    Capture {
        register: 211,
        inputs: [4, 5],
        counted: 0,
    },
    Capture {
        register: 261,
        inputs: [6, 7],
        counted: 2,
    },
];

/// The registers that say which edges of inputs interrupt.
pub fn captures(model: ModelId) -> &'static [Capture] {
    if HM.has(model) { CAPTURES } else { &[] }
}

/// Pointer of the first advanced interrupt.
const ADVANCED: u32 = 900;

/// The advanced interrupt I`number` of a model.
pub fn find_advanced(model: ModelId, number: u32) -> Option<Advanced> {
    let n = number.checked_sub(ADVANCED)?;
    (HM.has(model) && n < 8).then_some(Advanced {
        mask: 8064 + n,
        active: 8072 + n,
        request: 8080 + n,
        again: 8088 + n,
        // The system requests it each millisecond.
        source: (n == 0).then_some(Source::Period { ms: 1 }),
    })
}

/// The relays that catch a rising edge of an input once EI was executed.
pub struct PulseCatch {
    models: ModelSet,
    /// Relay of X000; those of the next inputs follow.
    pub first: u32,
    /// How many inputs.
    pub inputs: u32,
}

const HM: ModelSet = ModelSet::HM;
const INOVANCE: ModelSet = ModelSet::INOVANCE;
/// The relays that forbid interrupts on all models but HM.
pub const MASKS: std::ops::RangeInclusive<u32> = 8050..=8059;

/// Pulse catch (h1u-h2u-programming §3.8).
const PULSE_CATCH: &[PulseCatch] = &[
    PulseCatch {
        models: INOVANCE.or(ModelSet::FX).without(ModelSet::FX3U),
        first: 8170,
        inputs: 6,
    },
    PulseCatch {
        models: ModelSet::L01S.or(ModelSet::FX3U),
        first: 8170,
        inputs: 8,
    },
];

/// The pulse catch relays of a model.
pub fn pulse_catch(model: ModelId) -> Option<&'static PulseCatch> {
    PULSE_CATCH.iter().find(|row| row.models.has(model))
}

/// A table of counts of one high-speed counter: rows wait for theirs one after the other, and request an interrupt each
/// (h1u-h2u-programming §4.3.1, §8.7).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CountRows {
    /// The relay while which is on the table is at work.
    pub enable: u32,
    /// Register: the counter's number.
    pub counter: u32,
    /// Register: how many rows there are, at most as many as pointers.
    pub rows: u32,
    /// Register: the number of the first register D of the rows, which are pairs.
    pub first: u32,
    /// Register that shows the row that waits, from 0.
    pub row: u32,
    /// Relay that goes on when the last row was reached, behind which the first one waits again.
    pub done: u32,
    /// Pointer of the first row.
    pub pointer: u32,
    /// How many pointers there are.
    pub most: u32,
}

impl CountRows {
    /// Its pointers.
    pub fn pointers(&self) -> std::ops::Range<u32> {
        self.pointer..self.pointer + self.most
    }
}

/// H1U's and H2U's.
const COUNT_ROWS: &CountRows = &CountRows {
    enable: 8084,
    counter: 8084,
    rows: 8085,
    first: 8086,
    row: 8131,
    done: 8133,
    pointer: 507,
    most: 24,
};

/// The table of counts of a model.
pub fn count_rows(model: ModelId) -> Option<&'static CountRows> {
    INOVANCE.has(model).then_some(COUNT_ROWS)
}

/// What requests interrupts, to tell which comes first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Counter,
    Input,
    Timer,
    Pulses,
}

/// In which order interrupts run that are requested together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Precedence {
    models: ModelSet,
    /// The first kind runs first. Without kinds, and within one, the lower pointer runs first.
    kinds: &'static [Kind],
    /// Requests that DI keeps waiting run in the order in which they came; only of those that came at once the kind tells. Else it
    /// does of all.
    pub first_come: bool,
}

impl Precedence {
    /// Interrupts of the lower rank run first.
    pub fn rank(&self, source: Source) -> usize {
        let kind = match source {
            Source::Comparison { .. } | Source::Row { .. } => Kind::Counter,
            Source::Input { .. } => Kind::Input,
            Source::Period { .. } => Kind::Timer,
            Source::PulsesEnd { .. } => Kind::Pulses,
        };
        let place = self.kinds.iter().position(|&known| known == kind);
        place.unwrap_or(self.kinds.len())
    }
}

const PRECEDENCES: &[Precedence] = &[
    // h1u-h2u-programming §4.3.1.
    Precedence {
        models: INOVANCE,
        kinds: &[Kind::Counter, Kind::Input, Kind::Timer, Kind::Pulses],
        first_come: true,
    },
    // l01s-programming §6.4, which names the kinds alone; of timers I6 comes first (§6.4.2).
    Precedence {
        models: ModelSet::L01S,
        kinds: &[Kind::Input, Kind::Timer, Kind::Counter],
        first_come: false,
    },
    // hm-motion-controller §5.5.4 speaks of priorities, but names none. Relays keep the requests, and not when they came.
    Precedence {
        models: HM,
        kinds: &[],
        first_come: false,
    },
];

/// The FX family: the lower pointer runs first of those that come at once.
const FX: Precedence = Precedence {
    models: ModelSet::FX,
    kinds: &[],
    first_come: true,
};

/// In which order a model's interrupts run.
pub fn precedence(model: ModelId) -> &'static Precedence {
    let mut table = PRECEDENCES.iter();
    table.find(|row| row.models.has(model)).unwrap_or(&FX)
}

/// What pointer I`number` stands for on a model; `None` if it is one that nothing here requests, or an advanced interrupt.
pub fn find(model: ModelId, number: u32) -> Option<Interrupt> {
    if HM.has(model) {
        return find_hm(number);
    }
    let (group, rest) = (number / 100, number % 100);
    let source = match (group, rest) {
        (0..=5, 0 | 1) => Source::Input {
            number: group,
            kind: edge(rest),
        },
        (6..=8, 1..) => Source::Period { ms: rest },
        (0, 10 | 20 | 30 | 40 | 50 | 60) => {
            return Some(Interrupt {
                source: Some(Source::Comparison { pointer: number }),
                request: None,
                gate: Gate::Forbids(*MASKS.end()),
            });
        }
        // I502 to I506: Y000 to Y004 (h1u-h2u-programming §4.3.6).
        (5, 2..=6) if INOVANCE.has(model) => {
            let output = rest - 2;
            return Some(Interrupt {
                source: Some(Source::PulsesEnd { output }),
                request: None,
                gate: Gate::Allows(8090 + output),
            });
        }
        _ => return row_interrupt(model, number),
    };
    Some(Interrupt {
        source: Some(source),
        request: None,
        gate: Gate::Forbids(MASKS.start() + group),
    })
}

/// I507 to I530: the rows of a table of counts.
fn row_interrupt(model: ModelId, number: u32) -> Option<Interrupt> {
    let table = count_rows(model)?;
    table.pointers().contains(&number).then_some(Interrupt {
        source: Some(Source::Row { pointer: number }),
        request: None,
        gate: Gate::Allows(table.enable),
    })
}

/// HM's pointers (hm-motion-controller §5.5.5 to §5.5.7).
fn find_hm(number: u32) -> Option<Interrupt> {
    let (group, rest) = (number / 100, number % 100);
    let (source, request, mask) = match (group, rest) {
        // X004 and X006 interrupt with one edge, X005 and X007 with both; I001 and I201 have only their relay.
        (0..=3, 0 | 1) => {
            let input = Source::Input {
                number: 4 + group,
                kind: edge(rest),
            };
            let has_input = rest == 0 || group % 2 == 1;
            let n = 2 * group + rest;
            (has_input.then_some(input), 8032 + n, 8048 + n)
        }
        (6..=8, _) => {
            let ms = if rest == 0 { 100 } else { rest };
            let n = group - 6;
            (Some(Source::Period { ms }), 8040 + n, 8056 + n)
        }
        // I010 is requested by the system each millisecond, I020 to I050 by the program.
        (0, 10 | 20 | 30 | 40 | 50) => {
            let n = rest / 10 - 1;
            let source = (n == 0).then_some(Source::Period { ms: 1 });
            (source, 8043 + n, 8059 + n)
        }
        _ => return None,
    };
    Some(Interrupt {
        source,
        request: Some(request),
        gate: Gate::Forbids(mask),
    })
}

/// The last digit of an input's pointer.
fn edge(digit: u32) -> EdgeKind {
    if digit == 1 {
        EdgeKind::Rising
    } else {
        EdgeKind::Falling
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_choose_edges() {
        use EdgeKind::{Falling, Rising};
        let [first, _] = captures(ModelId::Hm) else {
            panic!("HM has two");
        };
        let interrupts = |mode: i32| {
            [(4, Falling), (4, Rising), (5, Falling), (5, Rising)].map(|(input, kind)| {
                let demands = first.demands(input, kind);
                demands.is_some_and(|(mask, value)| mode & mask == value)
            })
        };
        assert_eq!(interrupts(0x00), [true, false, false, false]);
        assert_eq!(interrupts(0x10), [true, false, true, false]);
        assert_eq!(interrupts(0x20), [true, false, false, true]);
        assert_eq!(interrupts(0x11), [false, false, true, false]);
        assert_eq!(interrupts(0x21), [false, false, false, true]);
        assert_eq!(interrupts(0x31), [false; 4]);
    }

    #[test]
    fn pointers_name_inputs_and_periods() {
        let gate = Gate::Forbids;
        let h2u = |number| find(ModelId::H2u, number).map(|found| (found.source, found.gate));
        let input = |number, kind| Some(Source::Input { number, kind });
        let period = |ms| Some(Source::Period { ms });
        assert_eq!(h2u(101), Some((input(1, EdgeKind::Rising), gate(8051))));
        assert_eq!(h2u(500), Some((input(5, EdgeKind::Falling), gate(8055))));
        assert_eq!(h2u(899), Some((period(99), gate(8058))));
        let counter = Some(Source::Comparison { pointer: 10 });
        assert_eq!(h2u(10), Some((counter, gate(8059))));
        let pulses = Some(Source::PulsesEnd { output: 1 });
        assert_eq!(h2u(503), Some((pulses, Gate::Allows(8091))));
        let row = Some(Source::Row { pointer: 530 });
        assert_eq!(h2u(530), Some((row, Gate::Allows(8084))));
        assert_eq!((h2u(600), h2u(531)), (None, None));
        assert_eq!(find(ModelId::L01s, 507), None);
        let hm = |number| find(ModelId::Hm, number).map(|found| (found.source, found.request));
        assert_eq!(hm(1), Some((None, Some(8033))));
        assert_eq!(hm(301), Some((input(7, EdgeKind::Rising), Some(8039))));
        assert_eq!(hm(700), Some((period(100), Some(8041))));
        assert_eq!(hm(10), Some((period(1), Some(8043))));
        assert_eq!((hm(50), hm(900)), (Some((None, Some(8047))), None));
    }

    #[test]
    fn each_model_has_its_order() {
        let order = |model| {
            let mut sources = [
                Source::PulsesEnd { output: 0 },
                Source::Period { ms: 5 },
                Source::Comparison { pointer: 10 },
                Source::Input {
                    number: 0,
                    kind: EdgeKind::Rising,
                },
            ];
            sources.sort_by_key(|&source| precedence(model).rank(source));
            sources
        };
        let [counter, input, timer, pulses] = order(ModelId::H2u);
        assert_eq!(counter, Source::Comparison { pointer: 10 });
        assert_eq!(
            (timer, pulses),
            (Source::Period { ms: 5 }, Source::PulsesEnd { output: 0 })
        );
        assert_eq!(order(ModelId::L01s), [input, timer, counter, pulses]);
        // Pointers alone tell.
        assert_eq!(order(ModelId::Fx3u), [pulses, timer, counter, input]);
    }
}
