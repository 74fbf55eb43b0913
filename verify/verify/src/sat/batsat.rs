//! BatSat: MiniSat's algorithm in Rust, quick in thousands of small questions.

use super::{Answer, SatLit};
use ::batsat::{BasicSolver, Lit, SolverInterface, Var, lbool};
use web_time::Instant;

/// The solver.
pub(super) struct Engine(BasicSolver);

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
    fn new(deadline: Instant) -> Self {
        let mut solver = BasicSolver::default();
        solver.cb_mut().set_stop(move || Instant::now() > deadline);
        Engine(solver)
    }

    fn clause(&mut self, lits: &[SatLit]) {
        let mut clause = self.known(lits);
        // Consistency is checked when the formula is solved.
        self.0.add_clause_reuse(&mut clause);
    }

    fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        let assumed = self.known(assumed);
        match self.0.solve_limited(&assumed) {
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
