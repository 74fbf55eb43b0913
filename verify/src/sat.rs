//! Graphs as clauses for a SAT solver.

use crate::aig::{Aig, Lit, Node};
use batsat::{BasicSolver, Lit as SatLit, SolverInterface, Var, lbool};
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
        solver.cb_mut().set_stop(move || Instant::now() > deadline);
        Solver {
            solver,
            variables: Vec::new(),
            next: 0,
        }
    }

    /// A new variable.
    pub fn variable(&mut self) -> SatLit {
        self.next += 1;
        positive(self.next - 1)
    }

    /// Adds a clause.
    pub fn clause(&mut self, lits: &[SatLit]) {
        let mut clause = self.known_to_solver(lits);
        // Whether all can still hold is asked when it is solved.
        self.solver.add_clause_reuse(&mut clause);
    }

    /// The same literals, whose variables the solver has from now on.
    fn known_to_solver(&mut self, lits: &[SatLit]) -> Vec<SatLit> {
        for lit in lits {
            self.solver.var_of_int(lit.var().idx());
        }
        lits.to_vec()
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
        self.known(lit).unwrap_or_else(|| positive(0))
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
        let assumed = self.known_to_solver(assumed);
        match self.solver.solve_limited(&assumed) {
            found if found == lbool::TRUE => Answer::Sat,
            found if found == lbool::FALSE => Answer::Unsat,
            _ => Answer::Unknown,
        }
    }

    /// After [`Answer::Sat`]: whether a variable is on; what does not matter is off.
    pub fn is_on(&self, lit: SatLit) -> bool {
        self.solver.value_lit(lit) == lbool::TRUE
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
        self.solver.unsat_core().iter().map(|&lit| !lit).collect()
    }
}

/// The literal that holds if a variable is on.
fn positive(variable: u32) -> SatLit {
    SatLit::new(Var::unsafe_from_idx(variable), true)
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
