//! Machines are built of equal stations, and their programs repeat the same rungs with other devices. This pass finds such rungs, where
//! each device is as far from the one before as in the iteration before, and makes a loop of them ([`Stmt::Repeat`]) that C and Rust
//! compilers vectorise. The iterations run in the program's order, so nothing has to be proved but that they are alike.

use super::grids::{self, Arrays, last_alike, meets_other_grid, spread};
use crate::node::{Body, Expr, ExprId, Module, Place, Stmt, TempId, Ty};
use crate::walk::{assigned, bodies, for_exprs, operands, operands_mut};
use rungc_models::runs::is_counter32;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHasher;
use std::collections::HashMap;
use std::hash::{Hash, Hasher};

/// Fewer iterations stay as they are written.
const LEAST_ITERATIONS: usize = 4;
/// How many operations a loop has to save: below, a program is easier to read with each device by its name.
const LEAST_SAVED: u64 = 200;
/// How many statements an iteration may have.
const LONGEST_ITERATION: usize = 100;

/// How many operations a statement of an iteration may be.
const LARGEST_STATEMENT: u64 = 500;

/// Makes loops of repeated rungs.
pub(super) fn run(module: &mut Module) {
    let named = module.layout.clone();
    for n in 0..module.functions.len() {
        let body = std::mem::take(&mut module.functions[n].body);
        module.functions[n].body = roll(module, body);
    }
    grids::trim(module, &named);
}

fn roll(module: &mut Module, body: Body) -> Body {
    let shapes: Vec<Option<Shape>> = body.iter().map(|stmt| shape(module, stmt)).collect();
    let networks = Networks::of(&body, &shapes);
    let mut runs = Runs::of(module, &body, shapes);
    let mut out = Body::with_capacity(body.len());
    let mut at = 0;
    while at < body.len() {
        let found = runs
            .best(module, networks.from(at))
            .filter(|group| group.fits(module, &runs.arrays))
            .filter(|group| group.store(module));
        match found {
            Some(group) => {
                out.push(group.repeat(module, &body));
                at += group.length * group.iterations;
            }
            None => {
                out.push(body[at].clone());
                at += 1;
            }
        }
    }
    out
}

/// What statements have in common that differ in their devices only.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Shape {
    hash: u64,
    /// How many operations they are.
    size: u64,
}

/// The shape of a statement that a loop may have; `None` for any other.
fn shape(module: &Module, stmt: &Stmt) -> Option<Shape> {
    let mut hasher = FxHasher::default();
    let mut size = 0;
    add_stmt(module, stmt, &mut hasher, &mut size)?;
    Some(Shape {
        hash: hasher.finish(),
        size,
    })
}

fn add_stmt(module: &Module, stmt: &Stmt, hasher: &mut FxHasher, size: &mut u64) -> Option<()> {
    std::mem::discriminant(stmt).hash(hasher);
    *size += 1;
    match stmt {
        Stmt::Network(_) => *size -= 1,
        Stmt::Let(_, value) => add_expr(module, *value, hasher, size)?,
        Stmt::Edge { input, .. } => add_expr(module, *input, hasher, size)?,
        Stmt::WriteBit(place, value) | Stmt::WriteWord(place, value) => {
            add_place(*place, hasher)?;
            add_expr(module, *value, hasher, size)?;
        }
        Stmt::Timer { drive, preset, .. } | Stmt::Counter16 { drive, preset, .. } => {
            add_expr(module, *drive, hasher, size)?;
            add_expr(module, *preset, hasher, size)?;
        }
        Stmt::Reset(place) => add_place(*place, hasher)?,
        Stmt::If {
            cond,
            then,
            otherwise,
        } => {
            add_expr(module, *cond, hasher, size)?;
            for body in [then, otherwise] {
                body.len().hash(hasher);
                for stmt in body {
                    add_stmt(module, stmt, hasher, size)?;
                }
            }
        }
        _ => return None,
    }
    Some(())
}

fn add_expr(module: &Module, id: ExprId, hasher: &mut FxHasher, size: &mut u64) -> Option<()> {
    let expr = module.expr(id);
    std::mem::discriminant(expr).hash(hasher);
    *size += 1;
    if *size > LARGEST_STATEMENT {
        return None;
    }
    match expr {
        Expr::ReadBit(place) | Expr::ReadWord(place) => add_place(*place, hasher),
        Expr::Bit(_)
        | Expr::I16(_)
        | Expr::I32(_)
        | Expr::Temp(_)
        | Expr::Sys(_)
        | Expr::Flag(_)
        | Expr::Not(_)
        | Expr::And(..)
        | Expr::Or(..)
        | Expr::Cmp(..)
        | Expr::Bin(..)
        | Expr::Complement(_)
        | Expr::Neg(_)
        | Expr::Widen(_)
        | Expr::Narrow(_)
        | Expr::HighWord(_)
        | Expr::BitToInt(_) => {
            operands(expr).try_for_each(|operand| add_expr(module, operand, hasher, size))
        }
        Expr::F32(_)
        | Expr::Un(..)
        | Expr::Float(..)
        | Expr::ReadWordBit(..)
        | Expr::ReadPair(_)
        | Expr::ReadFloat(_)
        | Expr::ReadNibbles { .. }
        | Expr::Cell(_)
        | Expr::Entry(..)
        | Expr::Stride(..)
        | Expr::Within { .. }
        | Expr::InRange { .. } => None,
    }
}

fn add_place(place: Place, hasher: &mut FxHasher) -> Option<()> {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    place.class.hash(hasher);
    let may = match place.class {
        X | Y | M | S | T | D | R => true,
        C => !is_counter32(place.class, place.number),
        _ => false,
    };
    (place.index.is_none() && may).then_some(())
}

/// From which statement of a body to which each temporary is used.
fn spans(module: &Module, body: &Body) -> Vec<Option<(usize, usize)>> {
    let mut spans = vec![None; module.temps.len()];
    if spans.is_empty() {
        return spans;
    }
    for (at, stmt) in body.iter().enumerate() {
        let mut note = |temp: TempId| {
            let span = spans[temp.0 as usize].get_or_insert((at, at));
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
struct Network {
    /// Which.
    at: usize,
    /// How many statements from it on a loop may have.
    alike: usize,
}

/// The networks of a body, in order.
struct Networks(Vec<Network>);

impl Networks {
    fn of(body: &Body, shapes: &[Option<Shape>]) -> Self {
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
    fn from(&self, at: usize) -> &[Network] {
        let found = self.0.binary_search_by_key(&at, |network| network.at);
        found.map_or(&[], |first| &self.0[first..])
    }
}

/// Rungs that are repeated.
struct Group {
    /// First statement.
    first: usize,
    /// Statements of an iteration.
    length: usize,
    iterations: usize,
    /// What the first iteration names, in order, and how far from each that of the next iteration is.
    devices: Vec<Names>,
}

/// What iterations name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Device(DeviceClass),
    /// The memory of an edge.
    Edge,
}

/// What an iteration names, its number, and that of the next iteration or how much further that is.
type Names = (Kind, u32, u32);

/// As many iterations of one length as are alike. It is sought once, and not again from each of its iterations that a group might begin with.
struct Run {
    /// First statement.
    first: usize,
    iterations: usize,
    /// What its first iteration names.
    devices: Vec<Names>,
    /// How many of the first iterations may not begin a group: the last of them gives a temporary a value that others use, too.
    leaking: usize,
}

/// The runs of a body.
struct Runs<'b> {
    body: &'b Body,
    shapes: Vec<Option<Shape>>,
    /// Where each temporary is used.
    spans: Vec<Option<(usize, usize)>>,
    arrays: Arrays,
    /// By the length of an iteration and where, modulo this, iterations begin: the last that was looked for.
    found: HashMap<(usize, usize), Run>,
}

impl<'b> Runs<'b> {
    fn of(module: &Module, body: &'b Body, shapes: Vec<Option<Shape>>) -> Self {
        Runs {
            body,
            shapes,
            spans: spans(module, body),
            arrays: Arrays::of(&module.layout),
            found: HashMap::new(),
        }
    }

    /// The group that begins with the first of these networks and saves the most, if it keeps to itself.
    fn best(&mut self, module: &Module, networks: &[Network]) -> Option<Group> {
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
        let devices = run.devices.iter();
        (skipped >= run.leaking).then(|| Group {
            first,
            length,
            iterations: run.iterations - skipped,
            devices: devices
                .map(|&(kind, number, stride)| (kind, number + skipped as u32 * stride, stride))
                .collect(),
        })
    }

    /// How many iterations of this length are alike from a statement on, if there are two.
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
        let mut devices = names(1)?;
        for (_, number, next) in &mut devices {
            *next = next.checked_sub(*number)?;
        }
        let is_next = |n: &usize| {
            let moved =
                |&(kind, number, stride): &Names| (kind, number, number + *n as u32 * stride);
            names(*n).is_some_and(|found| found.into_iter().eq(devices.iter().map(moved)))
        };
        let most = most_iterations(module, &devices);
        let iterations = (2..most).take_while(is_next).count() + 2;
        let leaks = |&n: &usize| !self.keeps_to_itself(iteration(n));
        (iterations <= most).then(|| Run {
            first,
            iterations,
            leaking: (0..iterations).rev().find(leaks).map_or(0, |n| n + 1),
            devices,
        })
    }

    /// Whether what an iteration gives to temporaries is used in that iteration only.
    fn keeps_to_itself(&self, iteration: std::ops::Range<usize>) -> bool {
        let mut inside = true;
        for stmt in &self.body[iteration.clone()] {
            each_assigned(stmt, &mut |temp| {
                let span = self.spans.get(temp.0 as usize).copied().flatten();
                inside &= span
                    .is_none_or(|(from, to)| iteration.contains(&from) && iteration.contains(&to));
            });
        }
        inside
    }
}

/// How many iterations the devices that move on leave room for.
fn most_iterations(module: &Module, devices: &[Names]) -> usize {
    let most = |&(kind, number, stride): &Names| {
        let last = match kind {
            Kind::Device(class) => last_alike(module.model, class, number),
            Kind::Edge => module.edges.checked_sub(1),
        };
        last.map_or(0, |last| (last - number) / stride + 1)
    };
    let moving = devices.iter().filter(|names| names.2 > 0);
    moving.map(most).min().unwrap_or(0) as usize
}

impl Group {
    /// Whether nothing is known that keeps [`Group::store`] from making its arrays, which takes longer to find out.
    fn fits(&self, module: &Module, arrays: &Arrays) -> bool {
        let reached = self.iterations as u32 - 1;
        let mut devices: Vec<_> = self
            .moving()
            .map(|(class, first, stride)| (class, first, first + reached * stride, stride))
            .collect();
        devices.sort_unstable();
        // Per distance of what goes before in the same class: where that ends.
        let mut ends: Vec<(DeviceClass, u32, u32)> = Vec::new();
        devices.into_iter().all(|(class, first, last, stride)| {
            ends.retain(|end| end.0 == class);
            let apart = ends
                .iter()
                .all(|&(_, other, end)| other == stride || end + 1 < first);
            match ends.iter_mut().find(|end| end.1 == stride) {
                Some(end) => end.2 = end.2.max(last),
                None => ends.push((class, stride, last)),
            }
            apart
                && !arrays.meet(class, first, last)
                && !meets_other_grid(&module.layout, (class, first, last), stride)
        })
    }

    /// The devices that are others in each iteration, and how far apart.
    fn moving(&self) -> impl Iterator<Item = (DeviceClass, u32, u32)> {
        self.devices
            .iter()
            .filter_map(|&(kind, number, stride)| match kind {
                Kind::Device(class) => (stride > 0).then_some((class, number, stride)),
                Kind::Edge => None,
            })
    }

    /// Makes the areas that the iterations go through; false if the devices are needed otherwise.
    fn store(&self, module: &mut Module) -> bool {
        let mut layout = module.layout.clone();
        let reached = self.iterations as u32 - 1;
        let stored = self.moving().all(|(class, number, stride)| {
            let devices = (class, number, number + reached * stride);
            spread(&mut layout, module, devices, stride)
        });
        if stored {
            module.layout = layout;
        }
        stored
    }

    /// The loop.
    fn repeat(&self, module: &mut Module, body: &Body) -> Stmt {
        let iteration = TempId(module.temps.len() as u32);
        module.temps.push(Ty::I32);
        let mut maker = Maker {
            module,
            iteration,
            strides: self.devices.iter().map(|device| device.2),
        };
        let statements = &body[self.first..self.first + self.length];
        let inner = maker.body(statements);
        let all = &body[self.first..self.first + self.iterations * self.length];
        let mut steps = all.iter().filter_map(|stmt| match stmt {
            Stmt::Network(network) => Some(maker.module.networks.get(*network as usize)?.step),
            _ => None,
        });
        let first = steps.next().unwrap_or_default();
        let last = steps.next_back().unwrap_or(first);
        Stmt::Repeat {
            count: self.iterations as u32,
            iteration,
            body: inner,
            steps: (first, last),
        }
    }
}

fn each_assigned(stmt: &Stmt, f: &mut impl FnMut(TempId)) {
    if let Some(temp) = assigned(stmt) {
        f(temp);
    }
    bodies(stmt)
        .flatten()
        .for_each(|stmt| each_assigned(stmt, f));
}

/// Two iterations side by side.
struct Pair<'m> {
    module: &'m Module,
    /// Temporaries of the first iteration, and what they are in the other.
    temps: HashMap<TempId, TempId>,
    /// What both name.
    devices: Vec<Names>,
}

impl<'m> Pair<'m> {
    /// What two iterations name, in order; `None` if the iterations differ otherwise.
    fn of(module: &'m Module, one: &[Stmt], other: &[Stmt]) -> Option<Vec<Names>> {
        let mut pair = Pair {
            module,
            temps: HashMap::new(),
            devices: Vec::new(),
        };
        pair.body(one, other)?;
        Some(pair.devices)
    }

    fn body(&mut self, one: &[Stmt], other: &[Stmt]) -> Option<()> {
        if one.len() != other.len() {
            return None;
        }
        let mut both = one.iter().zip(other);
        both.try_for_each(|(one, other)| self.stmt(one, other))
    }

    fn stmt(&mut self, one: &Stmt, other: &Stmt) -> Option<()> {
        match (one, other) {
            (Stmt::Network(_), Stmt::Network(_)) => Some(()),
            (&Stmt::Let(temp, value), &Stmt::Let(with, other)) => {
                self.expr(value, other)?;
                self.temps.insert(temp, with);
                Some(())
            }
            (
                &Stmt::Edge {
                    edge,
                    kind,
                    input,
                    out,
                    ..
                },
                &Stmt::Edge {
                    edge: with_edge,
                    kind: with_kind,
                    input: with_input,
                    out: with_out,
                    ..
                },
            ) => {
                (kind == with_kind).then_some(())?;
                self.devices.push((Kind::Edge, edge.0, with_edge.0));
                self.expr(input, with_input)?;
                self.temps.insert(out, with_out);
                Some(())
            }
            (&Stmt::WriteBit(place, value), &Stmt::WriteBit(to, other))
            | (&Stmt::WriteWord(place, value), &Stmt::WriteWord(to, other)) => {
                self.place(place, to)?;
                self.expr(value, other)
            }
            // A shared timer is driven in several places, which repeated rungs seldom do.
            (&Stmt::Timer { kind, .. }, &Stmt::Timer { kind: other, .. })
                if kind != other || kind.shared =>
            {
                None
            }
            (Stmt::Timer { .. }, Stmt::Timer { .. })
            | (Stmt::Counter16 { .. }, Stmt::Counter16 { .. }) => {
                let (one, other) = (coil(one)?, coil(other)?);
                self.place(one.0, other.0)?;
                self.expr(one.1, other.1)?;
                self.expr(one.2, other.2)
            }
            (&Stmt::Reset(place), &Stmt::Reset(with)) => self.place(place, with),
            (
                Stmt::If {
                    cond,
                    then,
                    otherwise,
                },
                Stmt::If {
                    cond: other_cond,
                    then: other_then,
                    otherwise: other_otherwise,
                },
            ) => {
                self.expr(*cond, *other_cond)?;
                self.body(then, other_then)?;
                self.body(otherwise, other_otherwise)
            }
            _ => None,
        }
    }

    fn expr(&mut self, one: ExprId, other: ExprId) -> Option<()> {
        match (*self.module.expr(one), *self.module.expr(other)) {
            (Expr::ReadBit(place), Expr::ReadBit(with))
            | (Expr::ReadWord(place), Expr::ReadWord(with)) => self.place(place, with),
            (Expr::Temp(temp), Expr::Temp(with)) => {
                (self.temps.get(&temp).copied().unwrap_or(temp) == with).then_some(())
            }
            (one, other) => {
                // They are alike if they are the same with the same operands, and these are alike.
                let mut like_other = one;
                for (operand, others) in operands_mut(&mut like_other).zip(operands(&other)) {
                    *operand = others;
                }
                let mut both = operands(&one).zip(operands(&other));
                (like_other == other).then_some(())?;
                both.try_for_each(|(a, b)| self.expr(a, b))
            }
        }
    }

    fn place(&mut self, one: Place, other: Place) -> Option<()> {
        let same = one.class == other.class && one.index.is_none() && other.index.is_none();
        let kind = Kind::Device(one.class);
        self.devices.push((kind, one.number, other.number));
        same.then_some(())
    }
}

/// The device of a coil of a timer or counter, its drive and its preset.
fn coil(stmt: &Stmt) -> Option<(Place, ExprId, ExprId)> {
    let (class, number, drive, preset) = match *stmt {
        Stmt::Timer {
            number,
            drive,
            preset,
            ..
        } => (DeviceClass::T, number, drive, preset),
        Stmt::Counter16 {
            number,
            drive,
            preset,
        } => (DeviceClass::C, number, drive, preset),
        _ => return None,
    };
    let place = Place {
        class,
        number,
        index: None,
    };
    Some((place, drive, preset))
}

/// The drive of a statement that only sets and resets bits, and what it does to each.
fn sets(module: &Module, stmt: &Stmt) -> Option<(ExprId, Vec<(Place, bool)>)> {
    let Stmt::If {
        cond,
        then,
        otherwise,
    } = stmt
    else {
        return None;
    };
    let writes = then.iter().map(|stmt| match *stmt {
        Stmt::WriteBit(place, value) => match *module.expr(value) {
            Expr::Bit(on) => Some((place, on)),
            _ => None,
        },
        _ => None,
    });
    let writes: Vec<_> = writes.collect::<Option<_>>()?;
    (otherwise.is_empty() && !writes.is_empty()).then_some((*cond, writes))
}

/// Makes the body of a loop of a first iteration.
struct Maker<'m, S> {
    module: &'m mut Module,
    iteration: TempId,
    /// How far the devices are from those of the next iteration, in the order in which the iteration names them.
    strides: S,
}

impl<S: Iterator<Item = u32>> Maker<'_, S> {
    fn body(&mut self, body: &[Stmt]) -> Body {
        let mut out = Body::with_capacity(body.len());
        for stmt in body {
            match sets(self.module, stmt) {
                Some((cond, writes)) => self.sets(cond, writes, &mut out),
                None => out.push(self.stmt(stmt)),
            }
        }
        out
    }

    /// SET and RST as assignments, `M0 := M0 | drive`: compilers do not vectorise what is done on a condition.
    fn sets(&mut self, cond: ExprId, writes: Vec<(Place, bool)>, out: &mut Body) {
        let mut drive = self.expr(cond);
        if writes.len() > 1 {
            let temp = TempId(self.module.temps.len() as u32);
            self.module.temps.push(Ty::Bit);
            out.push(Stmt::Let(temp, drive));
            drive = self.module.add(Expr::Temp(temp));
        }
        for (place, on) in writes {
            let place = self.place(place);
            let before = self.module.add(Expr::ReadBit(place));
            let after = match on {
                true => Expr::Or(before, drive),
                false => {
                    let others = self.module.add(Expr::Not(drive));
                    Expr::And(before, others)
                }
            };
            out.push(Stmt::WriteBit(place, self.module.add(after)));
        }
    }

    fn stmt(&mut self, stmt: &Stmt) -> Stmt {
        match stmt {
            Stmt::Let(temp, value) => Stmt::Let(*temp, self.expr(*value)),
            &Stmt::Edge {
                edge,
                kind,
                input,
                out,
                ..
            } => Stmt::Edge {
                edge,
                index: self.index(),
                kind,
                input: self.expr(input),
                out,
            },
            Stmt::WriteBit(place, value) => {
                let place = self.place(*place);
                Stmt::WriteBit(place, self.expr(*value))
            }
            Stmt::WriteWord(place, value) => {
                let place = self.place(*place);
                Stmt::WriteWord(place, self.expr(*value))
            }
            Stmt::Timer { .. } | Stmt::Counter16 { .. } => self.coil(stmt),
            Stmt::Reset(place) => Stmt::Reset(self.place(*place)),
            Stmt::If {
                cond,
                then,
                otherwise,
            } => Stmt::If {
                cond: self.expr(*cond),
                then: self.body(then),
                otherwise: self.body(otherwise),
            },
            other => other.clone(),
        }
    }

    fn expr(&mut self, id: ExprId) -> ExprId {
        let mut expr = *self.module.expr(id);
        if let Expr::ReadBit(place) | Expr::ReadWord(place) = &mut expr {
            *place = self.place(*place);
        } else if operands(&expr).next().is_none() {
            return id;
        } else {
            operands_mut(&mut expr).for_each(|operand| *operand = self.expr(*operand));
        }
        self.module.add(expr)
    }

    /// A coil of a timer or counter. All iterations have one kind of timers, so its number decides it.
    fn coil(&mut self, stmt: &Stmt) -> Stmt {
        let Some((place, drive, preset)) = coil(stmt) else {
            return stmt.clone();
        };
        let place = self.place(place);
        let (drive, preset) = (self.expr(drive), self.expr(preset));
        match (stmt, place.index) {
            (Stmt::Timer { .. }, Some(_)) => Stmt::TimerAt {
                place,
                drive,
                preset,
            },
            (&Stmt::Timer { number, kind, .. }, None) => Stmt::Timer {
                number,
                kind,
                drive,
                preset,
            },
            (_, Some(_)) => Stmt::Counter16At {
                place,
                drive,
                preset,
            },
            (_, None) => Stmt::Counter16 {
                number: place.number,
                drive,
                preset,
            },
        }
    }

    fn place(&mut self, place: Place) -> Place {
        let index = self.index();
        Place { index, ..place }
    }

    /// What leads from the next thing named in the first iteration to that of the present one, if it is another.
    fn index(&mut self) -> Option<ExprId> {
        let stride = self.strides.next().unwrap_or_default();
        (stride > 0).then(|| self.module.add(Expr::Stride(self.iteration, stride)))
    }
}
