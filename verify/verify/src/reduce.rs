//! Invariants of memory: bits that never change, and bits that are always equal or always opposite.
//!
//! Runs by chance sort bits into classes; one induction over all classes at once proves them, or a scan that breaks
//! one divides it (C. A. J. van Eijk, "Sequential equivalence checking based on structural similarities", 2000). A
//! question about a system whose classes are one bit each is simpler, and often answered by that.

use crate::aig::{Aig, Lit, Node};
use crate::effort::Limit;
use crate::proof::Fact;
use crate::random::{EVALUATED, Lanes, Random};
use crate::sat::{Answer, Solver};
use crate::system::{Latch, System};
use rustc_hash::FxHashMap;

/// Runs by chance before the induction, each of 64 lanes.
const RUNS: u32 = 8;
/// Scans of a run.
const SCANS: u32 = 60;

/// A system without the bits that others stand for.
pub(crate) struct Reduced {
    /// The system.
    pub system: System,
    /// Proved facts about the original system.
    pub facts: Vec<Fact>,
    /// The numbers of its latches in the system before.
    kept: Vec<usize>,
    /// Counterparts of the original system's nodes.
    nodes: Vec<Lit>,
}

impl Reduced {
    /// Counterpart of a literal of the original system.
    pub fn lit(&self, lit: Lit) -> Lit {
        self.nodes[lit.node()].invert_if(lit.is_inverted())
    }

    /// A statement about latches of the original system, before a scan and after it, as literals of this system.
    pub fn both(
        &mut self,
        original: &System,
        states: impl Fn(&mut Aig, &dyn Fn(usize) -> Lit) -> Lit,
    ) -> [Lit; 2] {
        let nodes = &self.nodes;
        let of = |lit: Lit| nodes[lit.node()].invert_if(lit.is_inverted());
        let aig = &mut self.system.aig;
        let now = states(aig, &|latch| of(original.latches[latch].now));
        let next = states(aig, &|latch| of(original.latches[latch].next));
        [now, next]
    }

    /// The part that the question depends on, and the numbers of its latches in the original system.
    pub fn sliced(&self) -> (System, Vec<usize>) {
        let wanted = self.system.cone(self.system.bad);
        let latches = self.system.latches.iter().zip(&self.kept);
        let kept = latches.filter(|(latch, _)| wanted[latch.now.node()]);
        let kept = kept.map(|(_, &number)| number).collect();
        (self.system.keep(&wanted, self.system.bad), kept)
    }
}

/// The class of each latch; latches that may begin with any value have none. Class 0 keeps what it begins with.
type Classes = Vec<Option<usize>>;

/// The same system, smaller; `None` if the limit is reached before anything is proved.
pub(crate) fn reduced(system: &System, limit: &Limit) -> Option<Reduced> {
    let steps = (RUNS * SCANS) as usize * system.aig.nodes().len() / EVALUATED;
    if !limit.affords(steps) {
        return None;
    }
    limit.charge(steps);
    let mut classes = random_runs(system);
    loop {
        limit.charge(system.aig.nodes().len());
        if limit.is_over() {
            return None;
        }
        let reduced = substituted(system, &classes);
        if holds(system, &reduced, &mut classes, limit)? {
            return Some(reduced);
        }
    }
}

/// Latches that have behaved in the same way in all runs by chance, as seen from what they begin with.
fn random_runs(system: &System) -> Classes {
    let known = |latch: &Latch| latch.init.map(|_| 0);
    let mut classes: Classes = system.latches.iter().map(known).collect();
    let mut random = Random::new();
    for run in 0..RUNS {
        let mut lanes = Lanes::new(system, &mut random);
        for scan in 0..SCANS {
            let ms = match scan {
                0 => 0,
                _ => [1, 10, 100, 30][random.below(4) as usize],
            };
            lanes.scan(ms, (run + scan) % 3 != 2, &mut random);
            let alive = lanes.alive;
            let held = lanes.latches().iter();
            split(system, &mut classes, held.map(|bits| bits & alive), alive);
        }
    }
    classes
}

/// Divides classes whose latches hold different values, bit by bit of a word; `mask` has the bits that count.
fn split(system: &System, classes: &mut Classes, values: impl Iterator<Item = u64>, mask: u64) {
    // Class 0 is what holds its first value, whether a latch does so or not.
    let mut parts: FxHashMap<(usize, u64), usize> = FxHashMap::default();
    parts.insert((0, 0), 0);
    for ((class, latch), value) in classes.iter_mut().zip(&system.latches).zip(values) {
        let (Some(class), Some(init)) = (class.as_mut(), latch.init) else {
            continue;
        };
        let turned = match init {
            true => !value & mask,
            false => value & mask,
        };
        let next = parts.len();
        *class = *parts.entry((*class, turned)).or_insert(next);
    }
}

/// The system in which the first latch of each class stands for all.
fn substituted(system: &System, classes: &Classes) -> Reduced {
    let mut aig = Aig::default();
    let mut nodes = vec![Lit::FALSE; system.aig.nodes().len()];
    let numbers = system.latch_numbers();
    let mut standing: FxHashMap<usize, Lit> = FxHashMap::default();
    standing.insert(0, Lit::FALSE);
    let mut kept = Vec::new();
    for (node, what) in system.aig.nodes().iter().enumerate() {
        let of = |lit: Lit| nodes[lit.node()].invert_if(lit.is_inverted());
        nodes[node] = match *what {
            Node::False => Lit::FALSE,
            Node::And(a, b) => {
                let (a, b) = (of(a), of(b));
                aig.and(a, b)
            }
            Node::Input(_) => {
                let number = numbers.get(&node).copied();
                let member = number.and_then(|n| Some((classes[n]?, system.latches[n].init?)));
                match member {
                    Some((class, init)) => {
                        let stands = standing.entry(class).or_insert_with(|| {
                            kept.extend(number);
                            aig.input().invert_if(init)
                        });
                        stands.invert_if(init)
                    }
                    None => {
                        kept.extend(number);
                        aig.input()
                    }
                }
            }
        };
    }
    let of = |lit: Lit| nodes[lit.node()].invert_if(lit.is_inverted());
    let all = |lits: &[Lit]| lits.iter().map(|&lit| of(lit)).collect();
    let latch = |&n: &usize| {
        let latch = &system.latches[n];
        Latch {
            now: of(latch.now),
            next: of(latch.next),
            ..latch.clone()
        }
    };
    Reduced {
        facts: facts(classes),
        system: System {
            latches: kept.iter().map(latch).collect(),
            inputs: system.inputs.iter().map(|&(l, i)| (of(l), i)).collect(),
            constraints: all(&system.constraints),
            replay_assumptions: all(&system.replay_assumptions),
            first_replay_assumptions: all(&system.first_replay_assumptions),
            lags: Vec::new(),
            bad: of(system.bad),
            aig,
        },
        kept,
        nodes,
    }
}

/// Facts expressed by classes.
fn facts(classes: &Classes) -> Vec<Fact> {
    let mut first: FxHashMap<usize, usize> = FxHashMap::default();
    let members = classes.iter().enumerate();
    members
        .filter_map(|(latch, class)| match (*class)? {
            0 => Some(Fact::Bit { latch, like: None }),
            class => match first.get(&class) {
                Some(&other) => Some(Fact::Bit {
                    latch,
                    like: Some(other),
                }),
                None => {
                    first.insert(class, latch);
                    None
                }
            },
        })
        .collect()
}

/// Checks that classes that hold before a scan hold after it; if not, they are divided. `None`: the limit is reached.
fn holds(system: &System, reduced: &Reduced, classes: &mut Classes, limit: &Limit) -> Option<bool> {
    let mut aig = reduced.system.aig.clone();
    let mut solver = Solver::new(limit);
    for &constraint in &reduced.system.constraints {
        let constraint = solver.lit(&aig, constraint);
        solver.clause(&[constraint]);
    }
    let mut all_hold = true;
    for n in 0..classes.len() {
        // The classes may be divided meanwhile, and so may be what stands for one.
        let (Some(class), Some(init)) = (classes[n], system.latches[n].init) else {
            continue;
        };
        let first = (class > 0).then(|| classes.iter().position(|c| *c == Some(class)));
        let next = reduced.lit(system.latches[n].next).invert_if(init);
        let other = match first.flatten() {
            Some(first) => {
                let latch = &system.latches[first];
                reduced.lit(latch.next).invert_if(latch.init == Some(true))
            }
            None => Lit::FALSE,
        };
        let differs = aig.xor(next, other);
        if differs == Lit::FALSE {
            continue;
        }
        let asked = solver.lit(&aig, differs);
        match solver.solve(&[asked]) {
            Answer::Unsat => {}
            Answer::Unknown => return None,
            Answer::Sat => {
                all_hold = false;
                limit.charge(reduced.system.aig.nodes().len());
                let after = after(system, reduced, &solver);
                split(system, classes, after.into_iter(), 1);
            }
        }
    }
    Some(all_hold)
}

/// Value of each latch after the scan that a solver has found.
fn after(system: &System, reduced: &Reduced, solver: &Solver) -> Vec<u64> {
    let nodes = reduced.system.aig.nodes();
    let mut values = vec![false; nodes.len()];
    let of = |values: &[bool], lit: Lit| values[lit.node()] != lit.is_inverted();
    for (node, what) in nodes.iter().enumerate() {
        values[node] = match *what {
            Node::False => false,
            Node::Input(_) => solver.value(reduced.system.aig.literal(node)),
            Node::And(a, b) => of(&values, a) && of(&values, b),
        };
    }
    let latches = system.latches.iter();
    latches
        .map(|latch| u64::from(of(&values, reduced.lit(latch.next))))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::reduced;
    use crate::aig::{Aig, Lit};
    use crate::effort::Limit;
    use crate::model::Key;
    use crate::system::{Latch, System};
    use rungc_syntax::DeviceClass;

    fn latch(number: u32, now: Lit, next: Lit, init: Option<bool>) -> Latch {
        Latch {
            now,
            next,
            init,
            key: Key::Bit(DeviceClass::M, number),
            bit: 0,
        }
    }

    /// M0 follows an input, M1 is its opposite, M2 needs both, M3 and M4 may begin with any value, and M5 is on after
    /// 20 scans.
    fn system() -> (System, Vec<Lit>) {
        let mut aig = Aig::default();
        let input = aig.input();
        let now: Vec<Lit> = (0..11).map(|_| aig.input()).collect();
        let both = aig.and(now[0], now[1]);
        let mut latches = vec![
            latch(0, now[0], input, Some(false)),
            latch(1, now[1], !input, Some(true)),
            latch(2, now[2], both, Some(false)),
            latch(3, now[3], now[3], None),
            latch(4, now[4], now[4], None),
        ];
        // A counter of five bits, which chance does not know.
        let mut carry = Lit::TRUE;
        for (bit, &held) in now.iter().enumerate().take(10).skip(5) {
            let next = aig.xor(held, carry);
            carry = aig.and(held, carry);
            latches.push(latch(bit as u32, held, next, Some(false)));
        }
        let ever = aig.or(now[10], carry);
        latches.push(latch(10, now[10], ever, Some(false)));
        let system = System {
            aig,
            latches,
            inputs: Vec::new(),
            constraints: Vec::new(),
            replay_assumptions: Vec::new(),
            first_replay_assumptions: Vec::new(),
            lags: Vec::new(),
            bad: Lit::FALSE,
        };
        (system, now)
    }

    #[test]
    fn only_what_always_holds_is_used() {
        let (system, now) = system();
        let reduced = reduced(&system, &Limit::none()).unwrap();
        let of = |n: usize| reduced.lit(now[n]);
        assert_eq!(of(0), !of(1));
        assert_eq!(of(2), Lit::FALSE);
        assert_ne!(of(3).node(), of(4).node());
        assert!((5..=10).all(|n| of(n).constant().is_none()));
        // M0, the two of any value, the counter, and what comes after it.
        assert_eq!(reduced.system.latches.len(), 9);
    }
}
