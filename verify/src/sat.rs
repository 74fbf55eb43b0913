//! Graphs as clauses for a SAT solver.

use crate::aig::{Aig, Lit, Node};
use rustsat::solvers::{Solve, SolveIncremental, SolverResult};
use rustsat::types::{Clause, Lit as SatLit, TernaryVal};
use rustsat_batsat::BasicSolver;
use std::time::Instant;

/// The answer of a solver.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Answer {
    /// There are values for which all holds.
    Sat,
    /// There are none.
    Unsat,
    /// The time is up.
    Unknown,
}

/// A solver, and the clauses of the nodes of one graph that were asked for.
pub struct Solver {
    solver: BasicSolver,
    /// The variable of each node.
    variables: Vec<Option<SatLit>>,
    next: u32,
}

impl Solver {
    /// A solver that gives up at this time.
    pub fn new(deadline: Instant) -> Self {
        let mut solver = BasicSolver::default();
        let callbacks = solver.batsat_mut().cb_mut();
        callbacks.set_stop(move || Instant::now() > deadline);
        Solver {
            solver,
            variables: Vec::new(),
            next: 0,
        }
    }

    /// A new variable.
    pub fn variable(&mut self) -> SatLit {
        self.next += 1;
        SatLit::positive(self.next - 1)
    }

    /// Adds a clause.
    pub fn clause(&mut self, lits: &[SatLit]) {
        let clause: Clause = lits.iter().copied().collect();
        // BatSat takes every clause; running out of memory ends the process anyway.
        let _ = self.solver.add_clause(clause);
    }

    /// The variable of a literal of the graph, with the clauses that define it.
    pub fn lit(&mut self, aig: &Aig, lit: Lit) -> SatLit {
        self.variables.resize(aig.nodes().len(), None);
        let mut open = vec![lit.node()];
        while let Some(&node) = open.last() {
            if self.variables[node].is_some() {
                open.pop();
                continue;
            }
            let Node::And(a, b) = aig.nodes()[node] else {
                let variable = self.variable();
                if aig.nodes()[node] == Node::False {
                    self.clause(&[!variable]);
                }
                self.variables[node] = Some(variable);
                continue;
            };
            match (self.known(a), self.known(b)) {
                (Some(a), Some(b)) => {
                    let both = self.variable();
                    self.clause(&[!both, a]);
                    self.clause(&[!both, b]);
                    self.clause(&[both, !a, !b]);
                    self.variables[node] = Some(both);
                }
                (a_known, b_known) => {
                    open.extend(a_known.is_none().then_some(a.node()));
                    open.extend(b_known.is_none().then_some(b.node()));
                }
            }
        }
        self.known(lit).unwrap_or_else(|| SatLit::positive(0))
    }

    fn known(&self, lit: Lit) -> Option<SatLit> {
        let variable = (*self.variables.get(lit.node())?)?;
        Some(if lit.is_inverted() {
            !variable
        } else {
            variable
        })
    }

    /// Whether all that was added can hold together with these.
    pub fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        match self.solver.solve_assumps(assumed) {
            Ok(SolverResult::Sat) => Answer::Sat,
            Ok(SolverResult::Unsat) => Answer::Unsat,
            Ok(SolverResult::Interrupted) | Err(_) => Answer::Unknown,
        }
    }

    /// After [`Answer::Sat`]: whether a variable is on; what does not matter is off.
    pub fn is_on(&self, lit: SatLit) -> bool {
        matches!(self.solver.lit_val(lit), Ok(TernaryVal::True))
    }

    /// After [`Answer::Sat`]: whether a literal of the graph is on; one that no clause names is off.
    pub fn value(&self, lit: Lit) -> bool {
        match self.known(lit) {
            Some(variable) => self.is_on(variable),
            None => lit.is_inverted(),
        }
    }

    /// After [`Answer::Unsat`]: which of the assumptions cannot hold together.
    pub fn core(&mut self) -> Vec<SatLit> {
        // The library gives the clause that follows: the inversions of the assumptions.
        let core = self.solver.core().unwrap_or_default();
        core.into_iter().map(|lit| !lit).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Answer, Solver};
    use crate::aig::Aig;
    use std::time::{Duration, Instant};

    #[test]
    fn assumptions_that_contradict_each_other_are_named() {
        let mut aig = Aig::default();
        let lits = aig.inputs_of(3);
        let both = aig.and(lits[0], lits[1]);
        let mut solver = Solver::new(Instant::now() + Duration::from_secs(10));
        let both = solver.lit(&aig, both);
        let inputs = [0, 1, 2].map(|i| solver.lit(&aig, lits[i]));
        assert_eq!(solver.solve(&[both, inputs[2]]), Answer::Sat);
        assert!(solver.value(lits[0]) && !solver.value(!lits[0]));
        assert_eq!(solver.solve(&[both, inputs[2], !inputs[1]]), Answer::Unsat);
        let mut core = solver.core();
        core.sort();
        let mut expected = vec![both, !inputs[1]];
        expected.sort();
        assert_eq!(core, expected);
    }
}
