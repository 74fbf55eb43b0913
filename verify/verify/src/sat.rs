//! Graphs as clauses for a SAT solver: BatSat, or CaDiCaL with the feature `cadical`.

#[cfg(any(test, not(feature = "cadical")))]
mod batsat;
#[cfg(feature = "cadical")]
mod cadical;

use crate::aig::{Aig, Lit, Node};
use crate::effort::Limit;
use std::ops::Not;

#[cfg(not(feature = "cadical"))]
use batsat::Engine as Chosen;
#[cfg(feature = "cadical")]
use cadical::Engine as Chosen;

/// The answer of a solver.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Answer {
    /// There are values for which all holds.
    Sat,
    /// There are none.
    Unsat,
    /// The limit is reached.
    Unknown,
}

/// A variable of a solver, perhaps inverted: the number of the variable, from 1, and its sign, as in DIMACS.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct SatLit(i32);

impl Not for SatLit {
    type Output = SatLit;

    fn not(self) -> SatLit {
        SatLit(-self.0)
    }
}

/// Engine that decides clauses.
trait Engine: Sized {
    /// An engine that gives up at this limit, and counts its steps.
    fn new(limit: Limit) -> Self;

    /// Adds a clause.
    fn clause(&mut self, lits: &[SatLit]);

    /// Decides whether all clauses can hold together with these.
    fn solve(&mut self, assumed: &[SatLit]) -> Answer;

    /// After [`Answer::Sat`], before another clause: whether a variable is on; what does not matter is off.
    fn is_on(&self, lit: SatLit) -> bool;

    /// After [`Answer::Unsat`], before another clause: which of the assumptions cannot hold together.
    fn core(&mut self) -> Vec<SatLit>;
}

/// A solver, and the clauses of the nodes of one graph that were requested.
pub struct Solver {
    engine: Chosen,
    limit: Limit,
    /// The variable of each node.
    variables: Vec<Option<SatLit>>,
    last: i32,
}

impl Solver {
    /// A solver that gives up at this limit, and counts its steps.
    pub fn new(limit: &Limit) -> Self {
        Solver {
            engine: Chosen::new(limit.clone()),
            limit: limit.clone(),
            variables: Vec::new(),
            last: 0,
        }
    }

    /// A new variable.
    pub fn variable(&mut self) -> SatLit {
        self.last += 1;
        SatLit(self.last)
    }

    /// Adds a clause.
    pub fn clause(&mut self, lits: &[SatLit]) {
        self.limit.charge(lits.len());
        self.engine.clause(lits);
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
        self.known(lit).unwrap_or(SatLit(1))
    }

    fn known(&self, lit: Lit) -> Option<SatLit> {
        let variable = (*self.variables.get(lit.node())?)?;
        Some(if lit.is_inverted() {
            !variable
        } else {
            variable
        })
    }

    /// Decides whether all that was added can hold together with these.
    pub fn solve(&mut self, assumed: &[SatLit]) -> Answer {
        self.engine.solve(assumed)
    }

    /// After [`Answer::Sat`], before another clause: whether a variable is on; what does not matter is off.
    pub fn is_on(&self, lit: SatLit) -> bool {
        self.engine.is_on(lit)
    }

    /// After [`Answer::Sat`], before another clause: whether a literal of the graph is on; off if no clause has it.
    pub fn value(&self, lit: Lit) -> bool {
        match self.known(lit) {
            Some(variable) => self.is_on(variable),
            None => lit.is_inverted(),
        }
    }

    /// After [`Answer::Unsat`], before another clause: which of the assumptions cannot hold together.
    pub fn core(&mut self) -> Vec<SatLit> {
        self.engine.core()
    }
}

#[cfg(test)]
mod tests {
    use super::{Answer, Solver};
    use crate::aig::Aig;
    use crate::effort::Limit;

    #[test]
    fn assumptions_that_contradict_each_other_are_named() {
        let mut aig = Aig::default();
        let lits = aig.inputs_of(3);
        let both = aig.and(lits[0], lits[1]);
        let mut solver = Solver::new(&Limit::none());
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

    /// Small formulas by chance, some of which can be satisfied.
    #[cfg(feature = "cadical")]
    #[test]
    fn both_solvers_give_the_same_answers() {
        use super::{Engine, SatLit};
        let mut random = 1u64;
        let mut lit = || {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let variable = (random >> 33) as i32 % 20 + 1;
            SatLit(if random >> 63 == 1 {
                variable
            } else {
                -variable
            })
        };
        let mut answers = [0; 2];
        for _ in 0..200 {
            let mut one = super::batsat::Engine::new(Limit::none());
            let mut other = super::cadical::Engine::new(Limit::none());
            let mut clauses = Vec::new();
            // Asked again and again with more clauses, as searches do.
            for _ in 0..5 {
                for _ in 0..16 {
                    let clause = [lit(), lit(), lit()];
                    one.clause(&clause);
                    other.clause(&clause);
                    clauses.push(clause);
                }
                let assumed = [lit(), lit(), lit()];
                let answer = one.solve(&assumed);
                assert_eq!(other.solve(&assumed), answer);
                if answer == Answer::Sat {
                    answers[0] += 1;
                    let holds = |lit: &SatLit| other.is_on(*lit);
                    assert!(assumed.iter().all(holds));
                    assert!(clauses.iter().all(|clause| clause.iter().any(holds)));
                } else {
                    answers[1] += 1;
                    let core = other.core();
                    assert!(core.iter().all(|lit| assumed.contains(lit)));
                    assert_eq!(one.solve(&core), Answer::Unsat);
                }
            }
        }
        assert!(answers.iter().all(|&count| count > 100), "{answers:?}");
    }
}
