//! Proofs for others to check: formulas that any SAT solver can confirm to be unsatisfiable.
//!
//! An induction over `k` scans is two of them: no run of `k` scans from power-on violates the property, and of `k`
//! scans in a row from any state the last is not the first to violate it. An invariant is three: all states to begin
//! with are inside, no scan leads out, and none from inside violates the property.

use crate::aig::{Aig, Lit, Node};
use crate::pdr::{self, Cube, Found};
use crate::property::Property;
use crate::prove::{FOREVER_MS, INDUCTION, Options, system};
use crate::search::{Bounded, Induction, Step};
use crate::system::System;
use crate::unroll::Unroller;
use rungc_ir::Module;
use std::fmt::Write;
use std::time::Instant;

/// Formulas in the format DIMACS with the names of their files. If none of them can be satisfied, the property holds.
pub type Certificate = Vec<(&'static str, String)>;

/// Proves a property so that others can check it; `None` if it is not proved in time.
pub fn certificate(module: &Module, property: &Property, options: &Options) -> Option<Certificate> {
    let deadline = Instant::now() + options.time;
    let (_, plain) = system(module, property, options);
    if let Some(found) = induction(&plain, deadline) {
        return Some(found);
    }
    let worlds = [(true, options.world.scan_ms), (false, FOREVER_MS)];
    worlds.into_iter().find_map(|(any_preset, scan_ms)| {
        let mut other = options.clone();
        other.world.any_preset = any_preset;
        other.world.scan_ms = scan_ms;
        let (_, system) = system(module, property, &other);
        let until = Instant::now() + deadline.saturating_duration_since(Instant::now()) / 2;
        match pdr::search(&system, until) {
            Found::Invariant(cubes) => Some(invariant(&system, &cubes)),
            Found::Violated | Found::TimeUp => None,
        }
    })
}

fn induction(system: &System, deadline: Instant) -> Option<Certificate> {
    let mut bounded = Bounded::new(system, false, deadline);
    let mut induction = Induction::new(system, deadline);
    let holds = |_: &usize| bounded.step() == Step::Holds;
    let scans = (1..=INDUCTION)
        .take_while(holds)
        .find(|_| induction.step())?;
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
        (unroller, holds, bad)
    };
    let (mut begin, mut in_begin, bad) = unrolled(true);
    in_begin.push(begin.aig.any(bad));
    let (step, mut in_step, bad) = unrolled(false);
    let (last, before) = bad.split_last()?;
    in_step.extend(before.iter().map(|&lit| !lit));
    in_step.push(*last);
    Some(vec![
        ("begin.cnf", dimacs(&begin.aig, &in_begin)),
        ("step.cnf", dimacs(&step.aig, &in_step)),
    ])
}

fn invariant(system: &System, cubes: &[Cube]) -> Certificate {
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
    let begins = system.latches.iter();
    let mut begin: Vec<Lit> = begins
        .filter_map(|latch| Some(latch.now.invert_if(!latch.init?)))
        .collect();
    begin.push(!now);
    let mut inside = system.constraints.clone();
    inside.push(now);
    let with = |last: Lit| [&inside[..], &[last]].concat();
    vec![
        ("begin.cnf", dimacs(&aig, &begin)),
        ("step.cnf", dimacs(&aig, &with(!next))),
        ("end.cnf", dimacs(&aig, &with(system.bad))),
    ]
}

/// All of these literals at once, as clauses.
fn dimacs(aig: &Aig, all: &[Lit]) -> String {
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
    format!("p cnf {most} {clauses}\n{text}")
}
