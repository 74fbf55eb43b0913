//! Proofs, and what they rest on: enough to be confirmed by others ([`crate::certificate`]).

use crate::aig::{Aig, Lit};
use crate::effort::Limit;
use crate::lag::{self, Ending, Lag};
use crate::pdr::Cube;
use crate::reduce::reduced;
use crate::system::System;
use std::fmt;

/// Method by which a system is proved never to violate its property.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Method {
    /// No run of this many scans from power-on does it, and after one scan fewer without it the next one does not.
    Induction(usize),
    /// No reachable state is in one of these cubes, which include all from which a scan could do it.
    Invariant(Vec<Cube>),
}

/// Invariant of memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fact {
    /// A latch keeps its initial value, or changes whenever another one does.
    Bit {
        /// The latch, by its number in the system.
        latch: usize,
        /// The other one.
        like: Option<usize>,
    },
    /// A clock is not ahead of a timer by more than this.
    Lag(Lag),
    /// A latch that ends a clock has this value where its timer has expired.
    Ends(Ending),
}

impl Fact {
    /// The fact in terms of what latches hold: before a scan, or after it.
    pub fn holds(self, system: &System, aig: &mut Aig, of: &dyn Fn(usize) -> Lit) -> Lit {
        let changed = |latch: usize| of(latch).invert_if(system.latches[latch].init == Some(true));
        match self {
            Fact::Bit {
                latch,
                like: Some(other),
            } => aig.same(changed(latch), changed(other)),
            Fact::Bit { latch, like: None } => !changed(latch),
            Fact::Lag(lag) => lag.holds(system, aig, of),
            Fact::Ends(ending) => ending.holds(system, aig, of),
        }
    }
}

/// Literals of a graph that cannot be on all at once, as is claimed.
#[derive(Clone, Debug)]
pub struct Formula {
    /// The graph.
    pub aig: Aig,
    /// The literals.
    pub all: Vec<Lit>,
}

/// A proof of a question about a system.
#[derive(Clone)]
pub struct Proof {
    /// The system as the question poses it.
    pub system: System,
    /// Invariants of its memory, by an induction over all of them at once. The rest of the proof assumes them.
    pub facts: Vec<Fact>,
    /// Of two programs: that memory which both have in common ends a scan differently.
    pub apart: Option<Formula>,
    /// Method of the proof.
    pub method: Method,
}

impl fmt::Debug for Proof {
    /// Without the system, which would fill pages.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Proof")
            .field("latches", &self.system.latches.len())
            .field("facts", &self.facts.len())
            .field("method", &self.method)
            .finish_non_exhaustive()
    }
}

/// A question as a system in which an answer can be searched.
#[derive(Clone, Debug)]
pub struct Posed {
    /// The system, perhaps simplified.
    pub system: System,
    /// Origin of the simplification.
    from: Option<Origin>,
    /// Of two programs: what of their memory is supposed never to differ, as a formula.
    apart: Option<Formula>,
}

/// A system before it was simplified.
#[derive(Clone, Debug)]
struct Origin {
    system: System,
    facts: Vec<Fact>,
    /// The numbers in it of the latches that are left.
    kept: Vec<usize>,
}

impl From<System> for Posed {
    fn from(system: System) -> Self {
        Posed {
            system,
            from: None,
            apart: None,
        }
    }
}

impl Posed {
    /// Rests on this formula, too.
    #[must_use]
    pub(crate) fn resting_on(mut self, apart: Formula) -> Self {
        self.apart = Some(apart);
        self
    }

    /// Without the bits that others stand for, if these are found within the limit.
    #[must_use]
    pub fn simplified(self, limit: &Limit) -> Self {
        // Once is enough.
        if self.from.is_some() {
            return self;
        }
        let Some(mut reduced) = reduced(&self.system, limit) else {
            return self;
        };
        let lags = lag::suppose(&self.system, &mut reduced, limit);
        let (system, kept) = reduced.sliced();
        Posed {
            system,
            from: Some(Origin {
                facts: [reduced.facts, lags].concat(),
                kept,
                system: self.system,
            }),
            apart: self.apart,
        }
    }

    /// A proof of the question from one about the system that was searched.
    pub fn proof(&self, method: Method) -> Proof {
        let Some(origin) = &self.from else {
            return Proof {
                system: self.system.clone(),
                facts: Vec::new(),
                apart: self.apart.clone(),
                method,
            };
        };
        let in_origin = |cube: Cube| cube.into_iter().map(|(latch, on)| (origin.kept[latch], on));
        Proof {
            system: origin.system.clone(),
            facts: origin.facts.clone(),
            apart: self.apart.clone(),
            method: match method {
                Method::Induction(scans) => Method::Induction(scans),
                Method::Invariant(cubes) => {
                    let cubes = cubes.into_iter().map(|cube| in_origin(cube).collect());
                    Method::Invariant(cubes.collect())
                }
            },
        }
    }
}
