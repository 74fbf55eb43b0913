//! Proofs for others to check: formulas that any SAT solver can confirm to be unsatisfiable.
//!
//! An induction over `k` scans is two of them: no run of `k` scans from power-on violates the property, and of `k`
//! scans in a row from any state the last is not the first to violate it. An invariant is three: all states to begin
//! with are inside, no scan leads out, and none from inside violates the property. What memory always holds is two: it
//! holds at first, and from a state in which all of it holds no scan leads to one in which some of it does not; the
//! other formulas suppose it. That two programs have memory in common is one: a scan that begins with the same memory
//! ends with the same.

use crate::aig::{Aig, Lit, Node};
use crate::pdr::Cube;
use crate::proof::{Formula, Method, Proof};
use crate::same::Compared;
use crate::system::System;
use crate::unroll::Unroller;
use rungc_syntax::{Device, DeviceClass};
use std::fmt::Write;

/// Formulas in the format DIMACS with the names of their files. If none of them can be satisfied, the claim holds.
pub type Certificate = Vec<(String, String)>;

/// Files by which others can confirm a proof.
pub fn certificate(proof: &Proof) -> Certificate {
    let formulas = formulas(proof).into_iter();
    let files = formulas.map(|(name, formula)| (format!("{name}.cnf"), dimacs(&formula)));
    files.collect()
}

/// Files by which others can confirm that outputs of two programs are equal: one formula for all memory that both have
/// in common, `memory.cnf`, and for each output that is not part of it a separate proof, `Y000-….cnf`.
pub fn of_comparison(compared: &Compared) -> Certificate {
    let mut files = vec![("memory.cnf".to_string(), dimacs(&compared.apart))];
    for output in &compared.outputs {
        if let Some(proof) = &output.proof {
            let device = Device {
                class: DeviceClass::Y,
                number: output.number,
            };
            let own = certificate(proof).into_iter();
            files.extend(own.map(|(name, text)| (format!("{device}-{name}"), text)));
        }
    }
    files
}

/// The formulas of a proof with their names.
pub(crate) fn formulas(proof: &Proof) -> Vec<(&'static str, Formula)> {
    let apart = proof.apart.iter().cloned();
    let mut formulas: Vec<_> = apart.map(|apart| ("memory", apart)).collect();
    if !proof.facts.is_empty() {
        let [begin, step] = facts(proof);
        formulas.extend([("bits-begin", begin), ("bits-step", step)]);
    }
    // The facts hold in every scan, as the constraints do.
    let mut system = proof.system.clone();
    for fact in &proof.facts {
        let now = |latch: usize| proof.system.latches[latch].now;
        let holds = fact.holds(&proof.system, &mut system.aig, &now);
        system.constraints.push(holds);
    }
    match &proof.method {
        Method::Induction(scans) => {
            let [begin, step] = induction(&system, *scans);
            formulas.extend([("begin", begin), ("step", step)]);
        }
        // No scan at all does it.
        Method::Invariant(cubes) if cubes.is_empty() => {
            let all = [&system.constraints[..], &[system.bad]].concat();
            let aig = system.aig;
            formulas.push(("end", Formula { aig, all }));
        }
        Method::Invariant(cubes) => {
            let [begin, step, end] = invariant(&system, cubes);
            formulas.extend([("begin", begin), ("step", step), ("end", end)]);
        }
    }
    formulas
}

/// Initial values of latches, where known.
fn first_state(system: &System) -> Vec<Lit> {
    let latches = system.latches.iter();
    let known = latches.filter_map(|latch| Some(latch.now.invert_if(!latch.init?)));
    known.collect()
}

/// That a fact does not hold at first, and that one does not hold after a scan though all did before.
fn facts(proof: &Proof) -> [Formula; 2] {
    let system = &proof.system;
    let mut aig = system.aig.clone();
    let mut all = |of: &dyn Fn(usize) -> Lit| {
        let facts = proof.facts.iter();
        let holds: Vec<Lit> = facts.map(|fact| fact.holds(system, &mut aig, of)).collect();
        (aig.all(holds.iter().copied()), holds)
    };
    let (now, holds) = all(&|latch| system.latches[latch].now);
    let (next, _) = all(&|latch| system.latches[latch].next);
    let mut begin = first_state(system);
    begin.push(!now);
    let mut step = [&system.constraints[..], &holds].concat();
    step.push(!next);
    [begin, step].map(|all| Formula {
        aig: aig.clone(),
        all,
    })
}

fn induction(system: &System, scans: usize) -> [Formula; 2] {
    let unrolled = |from_start: bool| {
        let mut unroller = Unroller::new(system, from_start);
        (0..scans).for_each(|_| unroller.extend());
        let mut holds: Vec<Lit> = Vec::new();
        for scan in 0..scans {
            holds.extend(system.constraints.iter().map(|&lit| unroller.at(scan, lit)));
        }
        let bad: Vec<Lit> = (0..scans)
            .map(|scan| unroller.at(scan, system.bad))
            .collect();
        (unroller.aig, holds, bad)
    };
    let (mut aig, mut all, bad) = unrolled(true);
    all.push(aig.any(bad));
    let begin = Formula { aig, all };
    let (aig, mut all, mut bad) = unrolled(false);
    let last = bad.pop();
    all.extend(bad.iter().map(|&lit| !lit));
    all.extend(last);
    [begin, Formula { aig, all }]
}

fn invariant(system: &System, cubes: &[Cube]) -> [Formula; 3] {
    let mut aig = system.aig.clone();
    let inside = |aig: &mut Aig, of: &dyn Fn(usize) -> Lit| {
        let mut clauses = Vec::new();
        for cube in cubes {
            let cube = cube.iter().map(|&(latch, on)| of(latch).invert_if(!on));
            clauses.push(!aig.all(cube.collect::<Vec<_>>()));
        }
        aig.all(clauses)
    };
    let now = inside(&mut aig, &|latch| system.latches[latch].now);
    let next = inside(&mut aig, &|latch| system.latches[latch].next);
    let mut begin = first_state(system);
    begin.push(!now);
    let mut inside = system.constraints.clone();
    inside.push(now);
    let with = |last: Lit| [&inside[..], &[last]].concat();
    [begin, with(!next), with(system.bad)].map(|all| Formula {
        aig: aig.clone(),
        all,
    })
}

/// All literals of a formula at once, as clauses.
fn dimacs(formula: &Formula) -> String {
    let Formula { aig, all } = formula;
    let mut wanted = vec![false; aig.nodes().len()];
    let mut open: Vec<usize> = all.iter().map(|lit| lit.node()).collect();
    while let Some(node) = open.pop() {
        if std::mem::replace(&mut wanted[node], true) {
            continue;
        }
        if let Node::And(a, b) = aig.nodes()[node] {
            open.extend([a.node(), b.node()]);
        }
    }
    let mut numbers = vec![0i64; wanted.len()];
    let mut most = 0;
    for (number, _) in numbers
        .iter_mut()
        .zip(&wanted)
        .filter(|(_, wanted)| **wanted)
    {
        most += 1;
        *number = most;
    }
    let of = |lit: Lit| match lit.is_inverted() {
        true => -numbers[lit.node()],
        false => numbers[lit.node()],
    };
    let (mut text, mut clauses) = (String::new(), 0);
    let mut clause = |lits: &[i64]| {
        for lit in lits {
            let _ = write!(text, "{lit} ");
        }
        text.push_str("0\n");
        clauses += 1;
    };
    for (node, what) in aig
        .nodes()
        .iter()
        .enumerate()
        .filter(|(node, _)| wanted[*node])
    {
        match *what {
            Node::False => clause(&[-numbers[node]]),
            Node::Input(_) => {}
            Node::And(a, b) => {
                let (both, a, b) = (numbers[node], of(a), of(b));
                clause(&[-both, a]);
                clause(&[-both, b]);
                clause(&[both, -a, -b]);
            }
        }
    }
    all.iter().for_each(|&lit| clause(&[of(lit)]));
    format!("c rungc\np cnf {most} {clauses}\n{text}")
}
