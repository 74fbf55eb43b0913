//! CaDiCaL, a C++ library that simplifies clauses between questions.

use super::{Answer, SatLit};
use ::cadical::{Callbacks, Solver};
use web_time::Instant;

/// The solver.
pub(super) struct Engine {
    solver: Solver<Deadline>,
    assumed: Vec<SatLit>,
}

/// Time at which the solver gives up.
struct Deadline(Instant);

impl Callbacks for Deadline {
    fn terminate(&mut self) -> bool {
        Instant::now() > self.0
    }
}

impl super::Engine for Engine {
    fn new(deadline: Instant) -> Self {
        let mut solver = Solver::new();
        solver.set_callbacks(Some(Deadline(deadline)));
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
