//! Interrupt pointers: what requests each, and what keeps it from running.

use rungc_rt::{EdgeKind, Register, Relay};

/// The interrupts of a model.
#[derive(Clone, Debug)]
pub struct Interrupts {
    /// Meaning of a pointer I; see [`Interrupts::find`].
    pub pointers: fn(u32) -> Option<Interrupt>,
    /// Interrupts whose routines may be left in the middle.
    pub advanced: Option<AdvancedPointers>,
    /// A register chooses the edge that interrupts, so that a program may have both routines of an input.
    pub both_edges: bool,
    /// Registers that say which edges of inputs interrupt.
    pub captures: &'static [Capture],
    /// Relays that catch pulses.
    pub pulse_catch: Option<PulseCatch>,
    /// A table of counts whose rows interrupt.
    pub count_rows: Option<&'static CountRows>,
    /// In which order interrupts run that are requested together.
    pub precedence: Precedence,
}

impl Interrupts {
    /// Meaning of pointer I`number`; `None` if it is one that nothing here requests, or an advanced interrupt.
    pub fn find(&self, number: u32) -> Option<Interrupt> {
        (self.pointers)(number)
    }

    /// The advanced interrupt I`number`.
    pub fn find_advanced(&self, number: u32) -> Option<Advanced> {
        self.advanced?.find(number)
    }
}

/// Source of an interrupt.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub enum Source {
    /// An edge of an input terminal.
    Input {
        /// Terminal X, a plain number.
        number: u32,
        /// Kind of edge.
        kind: EdgeKind,
    },
    /// This many milliseconds of RUN have passed.
    Period {
        /// Period, at least 1.
        ms: u32,
    },
    /// A millisecond of RUN has passed, in which motion is interpolated (I500 of HM).
    Interpolation,
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
    Forbids(Relay),
    /// It may while this relay is on.
    Allows(Relay),
    /// It always may.
    Open,
}

/// An interrupt routine's own conditions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Interrupt {
    /// Source; `None`: only its request relay.
    pub source: Option<Source>,
    /// The relay that keeps the request, and may be set by the program (HM); it goes off when the routine begins.
    pub request: Option<Relay>,
    /// Condition for it to run. A request that is not kept in a relay is lost if not.
    pub gate: Gate,
}

/// An interrupt whose routine may be left in the middle, and entered there again (hm-motion-controller §5.5.8).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Advanced {
    /// The relay that forbids it while on.
    pub mask: Relay,
    /// The relay that is on from the first entry to the end of the routine.
    pub active: Relay,
    /// The relay that requests it; it goes off when the routine begins.
    pub request: Relay,
    /// The relay that requests the next entry of a routine that is active; it goes off then.
    pub again: Relay,
    /// Additional source of the next entry.
    pub source: Option<Source>,
}

/// The advanced interrupts of a model. The devices of the first are here; those of the others follow.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AdvancedPointers {
    /// Pointer of the first.
    pub pointer: u32,
    /// Number of pointers.
    pub count: u32,
    /// The first, which the system requests again each millisecond.
    pub first: Advanced,
}

impl AdvancedPointers {
    fn find(&self, number: u32) -> Option<Advanced> {
        let n = number.checked_sub(self.pointer)?;
        (n < self.count).then_some(Advanced {
            mask: self.first.mask.after(n),
            active: self.first.active.after(n),
            request: self.first.request.after(n),
            again: self.first.again.after(n),
            source: self.first.source.filter(|_| n == 0),
        })
    }
}

/// Edges of two inputs that interrupt, selected by a register (hm-motion-controller §5.5.6).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Capture {
    /// The register. Its low digit is 0 if the first input's falling edge interrupts, its high digit 1 if the second
    /// one's falling edge does, 2 if its rising edge does.
    pub register: Register,
    /// The inputs.
    pub inputs: [u32; 2],
    /// It is read at the end of the first scan, and when a counter that counts this input is reset.
    pub counted: u32,
}

impl Capture {
    /// The values of the register that the manual defines, from that of power-on to the one without interrupts.
    pub fn modes(&self) -> impl Iterator<Item = u16> + use<> {
        [0x00, 0x10, 0x20, 0x11, 0x21, 0x31].into_iter()
    }

    /// Mask and value of the register's bits for which an edge interrupts.
    pub fn demands(&self, input: u32, kind: EdgeKind) -> Option<(i32, i32)> {
        match (self.inputs.iter().position(|&own| own == input)?, kind) {
            (0, EdgeKind::Falling) => Some((0x0f, 0)),
            (1, EdgeKind::Falling) => Some((0xf0, 0x10)),
            (1, EdgeKind::Rising) => Some((0xf0, 0x20)),
            _ => None,
        }
    }
}

/// The relays that catch a rising edge of an input once EI was executed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PulseCatch {
    /// Relay of X000; those of the next inputs follow.
    pub first: Relay,
    /// Number of inputs.
    pub inputs: u32,
}

/// Pulse catch of six inputs (h1u-h2u-programming §3.8).
const PULSE_CATCH: PulseCatch = PulseCatch {
    first: Relay(8170),
    inputs: 6,
};

/// Pulse catch of L01S and FX3U.
pub(crate) const PULSE_CATCH_OF_8: PulseCatch = PulseCatch {
    inputs: 8,
    ..PULSE_CATCH
};

/// A table of counts of one high-speed counter: rows wait for theirs one after the other, and request an interrupt each
/// (h1u-h2u-programming §4.3.1, §8.7).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct CountRows {
    /// The relay while which is on the table is at work.
    pub enable: Relay,
    /// The counter's number.
    pub counter: Register,
    /// Number of rows, at most as many as pointers.
    pub rows: Register,
    /// The number of the first register D of the rows, which are pairs.
    pub first: Register,
    /// Shows the row that waits, from 0.
    pub row: Register,
    /// Turns on when the last row was reached, after which the first one waits again.
    pub done: Relay,
    /// Pointer of the first row.
    pub pointer: u32,
    /// Number of pointers.
    pub most: u32,
}

impl CountRows {
    /// Its pointers.
    pub fn pointers(&self) -> std::ops::Range<u32> {
        self.pointer..self.pointer + self.most
    }

    /// Meaning of pointer I`number`, if it is one of a row.
    pub(crate) fn find(&self, number: u32) -> Option<Interrupt> {
        self.pointers().contains(&number).then_some(Interrupt {
            source: Some(Source::Row { pointer: number }),
            request: None,
            gate: Gate::Allows(self.enable),
        })
    }
}

/// Kind of source, to decide the order of interrupts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// A count of a high-speed counter.
    Counter,
    /// An edge of an input.
    Input,
    /// A period of time.
    Timer,
    /// The end of a train of pulses.
    Pulses,
}

/// In which order interrupts run that are requested together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Precedence {
    /// The first kind runs first. Without kinds, and within one, the lower pointer runs first.
    pub kinds: &'static [Kind],
    /// Requests that DI keeps waiting run in the order in which they came; only among simultaneous ones does the kind
    /// decide. Otherwise it does of all.
    pub first_come: bool,
}

impl Precedence {
    /// Interrupts of the lower rank run first.
    pub fn rank(&self, source: Source) -> usize {
        let kind = match source {
            Source::Comparison { .. } | Source::Row { .. } => Kind::Counter,
            Source::Input { .. } => Kind::Input,
            Source::Period { .. } | Source::Interpolation => Kind::Timer,
            Source::PulsesEnd { .. } => Kind::Pulses,
        };
        let place = self.kinds.iter().position(|&known| known == kind);
        place.unwrap_or(self.kinds.len())
    }
}

/// Common properties of the FX family's models: of interrupts that are requested together the lower pointer runs first.
pub(crate) const FX: Interrupts = Interrupts {
    pointers: fx_pointer,
    advanced: None,
    both_edges: false,
    captures: &[],
    pulse_catch: Some(PULSE_CATCH),
    count_rows: None,
    precedence: Precedence {
        kinds: &[],
        first_come: true,
    },
};

/// The relay that forbids the interrupts of X000; those of X001 to X005, of the timers I6 to I8 and of counters follow.
const MASK: Relay = Relay(8050);

/// Pointers of the FX family (h1u-h2u-programming §4.3.1): inputs, timers, comparisons of counters.
pub(crate) fn fx_pointer(number: u32) -> Option<Interrupt> {
    let (group, rest) = (number / 100, number % 100);
    let (source, mask) = match (group, rest) {
        (0..=5, 0 | 1) => {
            let kind = edge(rest);
            (
                Source::Input {
                    number: group,
                    kind,
                },
                MASK.after(group),
            )
        }
        (6..=8, 1..) => (Source::Period { ms: rest }, MASK.after(group)),
        (0, 10 | 20 | 30 | 40 | 50 | 60) => (Source::Comparison { pointer: number }, MASK.after(9)),
        _ => return None,
    };
    Some(Interrupt {
        source: Some(source),
        request: None,
        gate: Gate::Forbids(mask),
    })
}

/// The last digit of an input's pointer.
pub(crate) fn edge(digit: u32) -> EdgeKind {
    if digit == 1 {
        EdgeKind::Rising
    } else {
        EdgeKind::Falling
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Model, ModelId};

    fn find(id: ModelId, number: u32) -> Option<Interrupt> {
        Model::get(id).interrupts.find(number)
    }

    #[test]
    fn registers_choose_edges() {
        use EdgeKind::{Falling, Rising};
        let [first, _] = Model::get(ModelId::Hm).interrupts.captures else {
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
        let gate = |relay| Gate::Forbids(Relay(relay));
        let h2u = |number| find(ModelId::H2u, number).map(|found| (found.source, found.gate));
        let input = |number, kind| Some(Source::Input { number, kind });
        let period = |ms| Some(Source::Period { ms });
        assert_eq!(h2u(101), Some((input(1, EdgeKind::Rising), gate(8051))));
        assert_eq!(h2u(500), Some((input(5, EdgeKind::Falling), gate(8055))));
        assert_eq!(h2u(899), Some((period(99), gate(8058))));
        let counter = Some(Source::Comparison { pointer: 10 });
        assert_eq!(h2u(10), Some((counter, gate(8059))));
        let pulses = Some(Source::PulsesEnd { output: 1 });
        assert_eq!(h2u(503), Some((pulses, Gate::Allows(Relay(8091)))));
        let row = Some(Source::Row { pointer: 530 });
        assert_eq!(h2u(530), Some((row, Gate::Allows(Relay(8084)))));
        assert_eq!((h2u(600), h2u(531)), (None, None));
        assert_eq!(find(ModelId::L01s, 507), None);
        let hm = |number| find(ModelId::Hm, number).map(|found| (found.source, found.request));
        assert_eq!(hm(1), Some((None, Some(Relay(8033)))));
        assert_eq!(
            hm(301),
            Some((input(7, EdgeKind::Rising), Some(Relay(8039))))
        );
        assert_eq!(hm(700), Some((period(100), Some(Relay(8041)))));
        assert_eq!(hm(10), Some((period(1), Some(Relay(8043)))));
        assert_eq!((hm(50), hm(900)), (Some((None, Some(Relay(8047)))), None));
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
            let precedence = Model::get(model).interrupts.precedence;
            sources.sort_by_key(|&source| precedence.rank(source));
            sources
        };
        let [counter, input, timer, pulses] = order(ModelId::H2u);
        assert_eq!(counter, Source::Comparison { pointer: 10 });
        assert_eq!(
            (timer, pulses),
            (Source::Period { ms: 5 }, Source::PulsesEnd { output: 0 })
        );
        assert_eq!(order(ModelId::L01s), [input, timer, counter, pulses]);
        // Only pointers decide.
        assert_eq!(order(ModelId::Fx3u), [pulses, timer, counter, input]);
    }
}
