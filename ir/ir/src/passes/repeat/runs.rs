//! Finding the iterations that are alike.

use super::super::grids::{Arrays, last_alike};
use super::Group;
use super::pair::{Kind, Named, Pair};
use super::shape::Shape;
use crate::node::{Body, Expr, Module, Stmt, TempId};
use crate::walk::{assigned, bodies, for_exprs, operands};
use std::collections::HashMap;
use typed_index_collections::TiVec;

/// Fewer iterations stay as they are written.
const LEAST_ITERATIONS: usize = 4;

/// Fewest operations that a loop has to save: below, a program is easier to read with each device by its name.
const LEAST_SAVED: u64 = 200;

/// Maximum number of statements of an iteration.
const LONGEST_ITERATION: usize = 100;

/// From which statement of a body to which each temporary is used.
fn spans(module: &Module, body: &Body) -> TiVec<TempId, Option<(usize, usize)>> {
    let mut spans = TiVec::from(vec![None; module.temps.len()]);
    if spans.is_empty() {
        return spans;
    }
    for (at, stmt) in body.iter().enumerate() {
        let mut note = |temp: TempId| {
            let span = spans[temp].get_or_insert((at, at));
            span.1 = at;
        };
        each_temp(module, stmt, &mut note);
    }
    spans
}

fn each_temp(module: &Module, stmt: &Stmt, note: &mut impl FnMut(TempId)) {
    if let Some(temp) = assigned(stmt) {
        note(temp);
    }
    let mut open = Vec::new();
    for_exprs(stmt, &mut |id| open.push(*id));
    while let Some(id) = open.pop() {
        if let Expr::Temp(temp) = module.expr(id) {
            note(*temp);
        }
        open.extend(operands(module.expr(id)));
    }
    for body in bodies(stmt) {
        for stmt in body {
            each_temp(module, stmt, note);
        }
    }
}

/// A statement that begins a network.
pub(super) struct Network {
    /// Its position.
    at: usize,
    /// Maximum number of statements of a loop from here on.
    alike: usize,
}

/// The networks of a body, in order.
pub(super) struct Networks(Vec<Network>);

impl Networks {
    pub(super) fn of(body: &Body, shapes: &[Option<Shape>]) -> Self {
        let mut networks = Vec::new();
        let mut alike = 0;
        for (at, shape) in shapes.iter().enumerate().rev() {
            alike = if shape.is_some() { alike + 1 } else { 0 };
            if matches!(body[at], Stmt::Network(_)) {
                networks.push(Network { at, alike });
            }
        }
        networks.reverse();
        Networks(networks)
    }

    /// The network that this statement starts and those after it; none if it starts none.
    pub(super) fn from(&self, at: usize) -> &[Network] {
        let found = self.0.binary_search_by_key(&at, |network| network.at);
        found.map_or(&[], |first| &self.0[first..])
    }
}

/// As many iterations of one length as are alike. It is sought once, and not again from each of its iterations that a
/// group might begin with.
struct Run {
    /// First statement.
    first: usize,
    iterations: usize,
    /// Devices and edges that its first iteration names.
    named: Vec<Named>,
    /// Number of first iterations that may not begin a group: the last of them assigns a temporary that others use,
    /// too.
    leaking: usize,
}

/// The runs of a body.
pub(super) struct Runs<'b> {
    body: &'b Body,
    shapes: Vec<Option<Shape>>,
    /// Statements between which each temporary is used.
    spans: TiVec<TempId, Option<(usize, usize)>>,
    pub(super) arrays: Arrays,
    /// By the length of an iteration and where, modulo this, iterations begin: the last that was looked for.
    found: HashMap<(usize, usize), Run>,
}

impl<'b> Runs<'b> {
    pub(super) fn of(module: &Module, body: &'b Body, shapes: Vec<Option<Shape>>) -> Self {
        Runs {
            body,
            shapes,
            spans: spans(module, body),
            arrays: Arrays::of(&module.layout),
            found: HashMap::new(),
        }
    }

    /// The group that begins with the first of these networks and saves the most, if it keeps to itself.
    pub(super) fn best(&mut self, module: &Module, networks: &[Network]) -> Option<Group> {
        let (&Network { at: first, alike }, next) = networks.split_first()?;
        let longest = LONGEST_ITERATION.min(alike / LEAST_ITERATIONS);
        let lengths = next.iter().map(|network| network.at - first);
        let mut best: Option<(u64, usize)> = None;
        // The shortest iterations that are alike. Several of them together save less.
        let mut shortest: Option<(usize, usize)> = None;
        for length in lengths.take_while(|&length| length <= longest) {
            let together = shortest.filter(|&(of, _)| length.is_multiple_of(of));
            if together.is_some_and(|(of, iterations)| iterations >= 2 * (length / of)) {
                continue;
            }
            let Some(iterations) = self.iterations(module, first, length) else {
                continue;
            };
            shortest.get_or_insert((length, iterations));
            let iteration = &self.shapes[first..first + length];
            let size: u64 = iteration.iter().flatten().map(|s| s.size).sum();
            let saved = (iterations as u64 - 1) * size;
            let enough = iterations >= LEAST_ITERATIONS && saved >= LEAST_SAVED;
            if enough && best.is_none_or(|(most, _)| saved > most) {
                best = Some((saved, length));
            }
        }
        let (_, length) = best?;
        let run = self.found.get(&(length, first % length))?;
        let skipped = (first - run.first) / length;
        let moved = |named: &Named| Named {
            number: named.number + skipped as u32 * named.stride,
            ..*named
        };
        (skipped >= run.leaking).then(|| Group {
            first,
            length,
            iterations: run.iterations - skipped,
            named: run.named.iter().map(moved).collect(),
        })
    }

    /// Number of iterations of this length that are alike from a statement on, if there are two.
    fn iterations(&mut self, module: &Module, first: usize, length: usize) -> Option<usize> {
        let key = (length, first % length);
        if let Some(run) = self.found.get(&key)
            && run.first <= first
            && first + length < run.first + run.iterations * length
        {
            return Some(run.iterations - (first - run.first) / length);
        }
        let run = self.run(module, first, length)?;
        let iterations = run.iterations;
        self.found.insert(key, run);
        Some(iterations)
    }

    fn run(&self, module: &Module, first: usize, length: usize) -> Option<Run> {
        let iteration = |n: usize| first + n * length..first + (n + 1) * length;
        let is_alike = |n: usize| self.shapes.get(iteration(n)) == Some(&self.shapes[iteration(0)]);
        let names = |n: usize| {
            let other = is_alike(n).then(|| self.body.get(iteration(n))).flatten()?;
            Pair::of(module, &self.body[iteration(0)], other)
        };
        let named = names(1)?;
        let is_next = |n: &usize| {
            let further = |named: &Named| Named {
                stride: *n as u32 * named.stride,
                ..*named
            };
            names(*n).is_some_and(|found| found.into_iter().eq(named.iter().map(further)))
        };
        let most = most_iterations(module, &named);
        let iterations = (2..most).take_while(is_next).count() + 2;
        let leaks = |&n: &usize| !self.keeps_to_itself(iteration(n));
        (iterations <= most).then(|| Run {
            first,
            iterations,
            leaking: (0..iterations).rev().find(leaks).map_or(0, |n| n + 1),
            named,
        })
    }

    /// Returns true if the temporaries that an iteration assigns are used in that iteration only.
    fn keeps_to_itself(&self, iteration: std::ops::Range<usize>) -> bool {
        let mut inside = true;
        for stmt in &self.body[iteration.clone()] {
            each_assigned(stmt, &mut |temp| {
                let span = self.spans.get(temp).copied().flatten();
                inside &= span
                    .is_none_or(|(from, to)| iteration.contains(&from) && iteration.contains(&to));
            });
        }
        inside
    }
}

/// Maximum number of iterations for which the advancing devices exist.
fn most_iterations(module: &Module, named: &[Named]) -> usize {
    let most = |named: &Named| {
        let last = match named.kind {
            Kind::Device(class) => last_alike(module.model, class, named.number),
            Kind::Edge => module.edges.checked_sub(1),
        };
        last.map_or(0, |last| (last - named.number) / named.stride + 1)
    };
    let moving = named.iter().filter(|named| named.stride > 0);
    moving.map(most).min().unwrap_or(0) as usize
}

fn each_assigned(stmt: &Stmt, f: &mut impl FnMut(TempId)) {
    if let Some(temp) = assigned(stmt) {
        f(temp);
    }
    bodies(stmt)
        .flatten()
        .for_each(|stmt| each_assigned(stmt, f));
}
