//! BatSat: MiniSat's algorithm in Rust, quick in thousands of small questions.

use super::{Answer, SatLit};
use crate::effort::Limit;
use ::batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface, SolverOpts, Var, lbool};
use std::cell::Cell;

/// The solver.
pub(super) struct Engine(Solver<Counter>);

/// Counts the steps of a solver while it searches: after each decision and each conflict as many as there were literals
/// propagated on average before.
struct Counter {
    limit: Limit,
    rate: u64,
    /// Decisions and conflicts so far.
    rounds: Cell<u64>,
}

/// Literals that a decision propagates, as long as nothing is known.
const USUAL: u64 = 50;

/// Steps of a conflict for each literal of the clause that is learnt.
const LEARNT: u64 = 20;

impl Counter {
    fn round(&self) {
        self.rounds.set(self.rounds.get() + 1);
        self.limit.charge(self.rate as usize);
    }
}

impl Callbacks for Counter {
    fn on_new_clause(&mut self, clause: &[Lit], kind: ClauseKind) {
        if kind == ClauseKind::Learnt {
            self.round();
            self.limit.charge(clause.len() * LEARNT as usize);
        }
    }

    fn stop(&self) -> bool {
        self.round();
        self.limit.is_over()
    }
}

impl Engine {
    /// The literals in the library's terms; the solver has their variables from now on.
    fn known(&mut self, lits: &[SatLit]) -> Vec<Lit> {
        let known = lits.iter().map(|&lit| {
            let theirs = theirs(lit);
            self.0.var_of_int(theirs.var().idx());
            theirs
        });
        known.collect()
    }
}

impl super::Engine for Engine {
    fn new(limit: Limit) -> Self {
        let counter = Counter {
            limit,
            rate: USUAL,
            rounds: Cell::new(0),
        };
        Engine(Solver::new(SolverOpts::default(), counter))
    }

    fn clause(&mut self, lits: &[SatLit]) {
        let mut clause = self.known(lits);
        // Consistency is checked when the formula is solved.
        self.0.add_clause_reuse(&mut clause);
    }

    fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        let assumed = self.known(assumed);
        let before = (self.0.num_propagations(), self.0.cb().rounds.get());
        let found = self.0.solve_limited(&assumed);
        let propagated = self.0.num_propagations() - before.0;
        let counter = self.0.cb();
        let counted = (counter.rounds.get() - before.1) * counter.rate;
        counter
            .limit
            .charge(propagated.saturating_sub(counted) as usize);
        let rate = self.0.num_propagations() / counter.rounds.get().max(1);
        self.0.cb_mut().rate = rate.max(1);
        match found {
            found if found == lbool::TRUE => Answer::Sat,
            found if found == lbool::FALSE => Answer::Unsat,
            _ => Answer::Unknown,
        }
    }

    fn is_on(&self, lit: SatLit) -> bool {
        self.0.value_lit(theirs(lit)) == lbool::TRUE
    }

    fn core(&mut self) -> Vec<SatLit> {
        // The library gives the clause that follows: the inversions of the assumptions.
        self.0.unsat_core().iter().map(|&lit| ours(!lit)).collect()
    }
}

fn theirs(lit: SatLit) -> Lit {
    Lit::new(Var::unsafe_from_idx(lit.0.unsigned_abs() - 1), lit.0 > 0)
}

fn ours(lit: Lit) -> SatLit {
    let variable = lit.var().idx() as i32 + 1;
    SatLit(if lit.sign() { variable } else { -variable })
}
