//! CaDiCaL, a C++ library that simplifies clauses between questions.

use super::{Answer, SatLit};
use crate::effort::Limit;
use ::cadical::{Callbacks, Solver};

/// The solver.
pub(super) struct Engine {
    solver: Solver<Counter>,
    assumed: Vec<SatLit>,
}

/// Counts the steps of a solver: a number each time that it asks whether to continue.
struct Counter(Limit);

/// Steps from one such question to the next.
const ASKED: usize = 1000;

impl Callbacks for Counter {
    fn terminate(&mut self) -> bool {
        self.0.charge(ASKED);
        self.0.is_over()
    }
}

impl super::Engine for Engine {
    fn new(limit: Limit) -> Self {
        let mut solver = Solver::new();
        solver.set_callbacks(Some(Counter(limit)));
        Engine {
            solver,
            assumed: Vec::new(),
        }
    }

    fn clause(&mut self, lits: &[SatLit]) {
        self.solver.add_clause(lits.iter().map(|lit| lit.0));
    }

    fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        self.assumed = assumed.to_vec();
        match self.solver.solve_with(assumed.iter().map(|lit| lit.0)) {
            Some(true) => Answer::Sat,
            Some(false) => Answer::Unsat,
            None => Answer::Unknown,
        }
    }

    fn is_on(&self, lit: SatLit) -> bool {
        self.solver.value(lit.0) == Some(true)
    }

    fn core(&mut self) -> Vec<SatLit> {
        let assumed = self.assumed.iter().copied();
        assumed.filter(|lit| self.solver.failed(lit.0)).collect()
    }
}
