//! Features of a program shown by a run, by which a search recognises new behaviour.

use crate::run::Runner;
use crate::task::Task;
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, CellId, Expr, ExprId, FlagId, Stmt};
use rungc_ir::walk::statements;
use rungc_models::runs::{is_counter32, is_special};
use rungc_rt::{Class, Plc};
use rungc_sim::Target;
use rungc_sim::property::{Condition, Devices, Number};
use rungc_syntax::DeviceClass;
use rustc_hash::{FxHashMap, FxHashSet};

/// Something that a scan has shown.
pub type Feature = u64;

/// More devices of a program are not followed.
const MOST: usize = 4_000;
/// This many different states of all relays together count as new.
const STATES: usize = 3_000;

/// The kinds of features, in their top byte.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Kind {
    Branch,
    Bit,
    Change,
    Word,
    Near,
    Pair,
    Leaves,
    State,
}

fn feature(kind: Kind, index: usize, value: u32) -> Feature {
    (kind as u64) << 56 | (index as u64 & 0xff_ffff) << 32 | u64::from(value)
}

/// Values evaluated after a scan.
pub struct View<'t> {
    /// Flags of branches.
    pub branches: &'t [FlagId],
    /// Bits.
    pub bits: Vec<(Class, u32)>,
    /// Registers, and the values of timers and counters.
    pub words: Vec<(Class, u32)>,
    /// Indices of the bits that are outputs and states.
    outputs: Vec<usize>,
    /// By word: numbers that the program compares it with.
    near: Vec<Vec<i32>>,
    /// The parts of each property's conditions that are true or false by themselves.
    leaves: Vec<Vec<&'t Condition>>,
}

/// The last scan, to see what has changed.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub struct Last {
    branches: Vec<bool>,
    /// Each of [`View::bits`].
    pub bits: Vec<bool>,
    /// Each of [`View::words`].
    pub words: Vec<i32>,
    /// All bits together.
    state: u64,
    /// True if a bit has changed in this scan, or there was none before.
    changed: bool,
    /// True if an output or a state has changed.
    moved: bool,
}

/// The features that are known.
#[derive(Clone, Default)]
pub struct Seen {
    known: FxHashSet<Feature>,
    states: usize,
}

impl Seen {
    /// Adds a feature; whether it is new.
    pub fn add(&mut self, feature: Feature) -> bool {
        let is_state = feature >> 56 == Kind::State as u64;
        if is_state && self.states >= STATES {
            return false;
        }
        let new = self.known.insert(feature);
        self.states += usize::from(new && is_state);
        new
    }

    /// Returns true if it is new.
    pub fn lacks(&self, feature: Feature) -> bool {
        let is_state = feature >> 56 == Kind::State as u64;
        let is_full = is_state && self.states >= STATES;
        !is_full && !self.known.contains(&feature)
    }

    /// Number of features.
    pub fn len(&self) -> usize {
        self.known.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.known.is_empty()
    }
}

impl<'t> View<'t> {
    /// View for a search.
    pub fn new(task: &'t Task<'t>) -> Self {
        let module = task.module;
        let compared = compared(module, task);
        let (mut bits, mut words, mut near) = (Vec::new(), Vec::new(), Vec::new());
        for area in &module.layout.areas {
            let Some(class) = rt_class(area.class) else {
                continue;
            };
            use DeviceClass::{C, D, ER, M, R, S, T, V, Y, Z};
            let followed = (area.first..area.first + area.count)
                .filter(|&n| !is_special(area.class, n))
                .take(MOST);
            for n in followed {
                if matches!(area.class, Y | M | S | T | C) && bits.len() < MOST {
                    bits.push((class, n));
                }
                if matches!(area.class, D | R | ER | V | Z | T | C) && words.len() < MOST {
                    words.push((class, n));
                    let numbers = compared.get(&(area.class, n));
                    near.push(numbers.cloned().unwrap_or_default());
                }
            }
        }
        let properties = task.properties.iter();
        let leaves = properties.map(|property| {
            let mut found = Vec::new();
            let conditions = property.conditions();
            conditions.into_iter().for_each(|c| leaves(c, &mut found));
            found.truncate(24);
            found
        });
        let is_output = |i: &usize| matches!(bits[*i], (Class::Y | Class::S, _));
        View {
            branches: &task.notes.branches,
            outputs: (0..bits.len()).filter(is_output).collect(),
            leaves: leaves.collect(),
            bits,
            words,
            near,
        }
    }

    /// Number of branches taken.
    pub fn taken(&self, seen: &Seen) -> usize {
        let features = (0..self.branches.len()).map(|i| feature(Kind::Branch, i, 0));
        features
            .filter(|feature| seen.known.contains(feature))
            .count()
    }

    /// Before anything was looked at.
    pub fn nothing(&self) -> Last {
        Last {
            branches: vec![false; self.branches.len()],
            bits: vec![false; self.bits.len()],
            words: vec![0; self.words.len()],
            state: 0,
            changed: true,
            moved: true,
        }
    }

    /// Calls `f` with the features of the scan that has just ended.
    pub fn look(&self, runner: &Runner, last: &mut Last, f: &mut impl FnMut(Feature)) {
        let machine = runner.machine();
        for (i, &flag) in self.branches.iter().enumerate() {
            if machine.flag(flag) {
                self.branch(i, last, f);
            }
        }
        for (i, &(class, n)) in self.bits.iter().enumerate() {
            self.bit(i, machine.bit(class, n) == Some(true), last, f);
        }
        for (i, &device) in self.words.iter().enumerate() {
            self.word(i, value(machine, device), last, f);
        }
        self.end(machine, last, f);
    }

    /// A branch has been taken.
    pub fn branch(&self, i: usize, last: &mut Last, f: &mut impl FnMut(Feature)) {
        if !std::mem::replace(&mut last.branches[i], true) {
            f(feature(Kind::Branch, i, 0));
        }
    }

    /// Updates a bit.
    pub fn bit(&self, i: usize, on: bool, last: &mut Last, f: &mut impl FnMut(Feature)) {
        if std::mem::replace(&mut last.bits[i], on) != on {
            last.state ^= mixed(i as u64);
            last.changed = true;
            last.moved |= matches!(self.bits[i].0, Class::Y | Class::S);
            f(feature(Kind::Bit, i, on.into()));
        }
    }

    /// Updates a word.
    pub fn word(&self, i: usize, value: i32, last: &mut Last, f: &mut impl FnMut(Feature)) {
        if std::mem::replace(&mut last.words[i], value) != value {
            f(feature(Kind::Word, i, magnitude(value)));
            for (j, &number) in self.near[i].iter().enumerate() {
                let distance = magnitude(value.wrapping_sub(number));
                f(feature(Kind::Near, i << 6 | j, distance));
            }
        }
    }

    /// All has been looked at.
    pub fn end(&self, devices: &impl Devices, last: &mut Last, f: &mut impl FnMut(Feature)) {
        if std::mem::take(&mut last.changed) {
            f((Kind::State as u64) << 56 | last.state >> 8);
        }
        if std::mem::take(&mut last.moved) {
            self.pairs(last, f);
        }
        for (property, leaves) in self.leaves.iter().enumerate() {
            let held = leaves.iter().map(|leaf| leaf.holds(devices));
            let held = held.fold(0, |all, on| all << 1 | u32::from(on));
            f(feature(Kind::Leaves, property, held));
        }
    }

    /// Outputs that are on together, and what they follow.
    fn pairs(&self, last: &Last, f: &mut impl FnMut(Feature)) {
        const MOST_ON: usize = 24;
        let on = self.outputs.iter().copied().filter(|&i| last.bits[i]);
        let on: Vec<usize> = on.take(MOST_ON).collect();
        for (at, &a) in on.iter().enumerate() {
            f(feature(Kind::Change, a, on.len() as u32));
            for &b in &on[at + 1..] {
                f(feature(Kind::Pair, a, b as u32));
            }
        }
    }
}

/// A word of a machine.
pub fn value(machine: &Machine, (class, n): (Class, u32)) -> i32 {
    match class {
        Class::C if is_counter32(DeviceClass::C, n) => machine.counter32(n).unwrap_or(0),
        _ => machine.word(class, n).unwrap_or(0).into(),
    }
}

/// A number for a bit, whose sums differ for different bits: the finaliser of MurmurHash3.
fn mixed(i: u64) -> u64 {
    let mut mixed = i.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ mixed >> 33).wrapping_mul(0xff51_afd7_ed55_8ccd);
    mixed = (mixed ^ mixed >> 33).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    mixed ^ mixed >> 33
}

/// A number up to 32 as it is, others by their length.
fn magnitude(value: i32) -> u32 {
    const EXACT: u32 = 32;
    let size = value.unsigned_abs();
    let rank = match size {
        0..=EXACT => size,
        _ => EXACT + 33 - size.leading_zeros(),
    };
    rank << 1 | u32::from(value < 0)
}

/// The parts of a condition that do not join others.
fn leaves<'c>(condition: &'c Condition, found: &mut Vec<&'c Condition>) {
    match condition {
        Condition::On(_) | Condition::WordBit(..) => found.push(condition),
        // What a number was is in no feature.
        Condition::Compare(..) if !condition.has_memory() => found.push(condition),
        _ => condition
            .parts()
            .into_iter()
            .for_each(|part| leaves(part, found)),
    }
}

/// The numbers with which words are compared: by instructions, as presets, and by properties.
fn compared(module: &Module, task: &Task) -> FxHashMap<(DeviceClass, u32), Vec<i32>> {
    const MOST_NUMBERS: usize = 16;
    let mut found: FxHashMap<(DeviceClass, u32), Vec<i32>> = FxHashMap::default();
    let mut add = |device, number| {
        let numbers = found.entry(device).or_default();
        if numbers.len() < MOST_NUMBERS && !numbers.contains(&number) {
            numbers.push(number);
        }
    };
    let cells = Cells::of(module);
    for expr in &module.exprs {
        if let Expr::Cmp(_, a, b) = *expr {
            for (a, b) in [(a, b), (b, a)] {
                if let Some(device) = word(module, a) {
                    let numbers = cells
                        .behind(module, b)
                        .filter_map(|id| constant(module, id));
                    numbers.for_each(|number| add(device, number));
                }
            }
        }
    }
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            let (device, preset) = match stmt {
                Stmt::Do(Action::Timer(coil)) => ((DeviceClass::T, coil.number), coil.preset),
                Stmt::Do(Action::Counter16(coil)) => ((DeviceClass::C, coil.number), coil.preset),
                Stmt::Do(Action::Counter32(coil)) => ((DeviceClass::C, coil.number), coil.preset),
                Stmt::Do(Action::Count(count)) => ((DeviceClass::C, count.number), count.preset),
                _ => return,
            };
            let numbers = cells.behind(module, preset);
            let numbers = numbers.filter_map(|id| constant(module, id));
            numbers.for_each(|number| add(device, number));
        });
    }
    let conditions = task.properties.iter().flat_map(|p| p.conditions());
    for condition in conditions {
        let mut parts = Vec::new();
        leaves(condition, &mut parts);
        for part in parts {
            if let Condition::Compare(_, Number::Of(of), Number::Constant(number))
            | Condition::Compare(_, Number::Constant(number), Number::Of(of)) = *part
                && let Target::Word(class, n) | Target::Current(class, n) = of
            {
                add((class, n), number);
            }
        }
    }
    found
}

/// Expressions assigned to a program's private cells.
pub(crate) struct Cells(FxHashMap<CellId, Vec<ExprId>>);

impl Cells {
    pub(crate) fn of(module: &Module) -> Self {
        let mut cells: FxHashMap<CellId, Vec<ExprId>> = FxHashMap::default();
        for function in &module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::SetCell(cell, value)) = *stmt {
                    cells.entry(cell).or_default().push(value);
                }
            });
        }
        Cells(cells)
    }

    /// An expression, or if it is a cell, all that the cell is set to.
    pub(crate) fn behind(&self, module: &Module, id: ExprId) -> impl Iterator<Item = ExprId> {
        let set = match *module.expr(id) {
            Expr::Cell(cell) => self.0.get(&cell).map_or(&[][..], Vec::as_slice),
            _ => &[],
        };
        let own = set.is_empty().then_some(id);
        own.into_iter().chain(set.iter().copied())
    }
}

/// The word that an expression reads.
fn word(module: &Module, id: ExprId) -> Option<(DeviceClass, u32)> {
    let Expr::Read(access) = *module.expr(id) else {
        return None;
    };
    let plain = matches!(access.kind, AccessKind::Word | AccessKind::Pair);
    (plain && access.place.index.is_none()).then_some((access.place.class, access.place.number))
}

/// The number that an expression is.
pub fn constant(module: &Module, id: ExprId) -> Option<i32> {
    match *module.expr(id) {
        Expr::I16(value) => Some(value.into()),
        Expr::I32(value) => Some(value),
        _ => None,
    }
}
