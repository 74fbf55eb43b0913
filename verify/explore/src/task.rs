//! Task of a search: its goals, and the program.

use crate::notes::Notes;
use crate::trains::{Source, sources};
use rungc_ir::Module;
use rungc_ir::walk::{calls_runtime, statements};
use rungc_models::runs::is_special;
use rungc_rt::VirtualHal;
use rungc_sim::Target;
use rungc_sim::plant::Description;
use rungc_sim::property::{Condition, Property};
use rungc_syntax::DeviceClass;
use rungc_verify::model::{Encoder, Key, World};
use std::collections::{BTreeMap, BTreeSet};

/// Kind of finding other than violated properties.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Kind {
    /// Operation errors (M8067).
    Errors,
    /// Scans that do not end.
    Watchdog,
    /// Outputs that one coil switches on and another one off in the same scan.
    Doubled,
    /// Outputs that change in every scan while no input does.
    Oscillation,
    /// Axes that run into an end of their travel.
    Collisions,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 5] = [
        Kind::Errors,
        Kind::Watchdog,
        Kind::Doubled,
        Kind::Oscillation,
        Kind::Collisions,
    ];
}

/// Something that was searched for and has happened.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum What {
    /// The property of this number is violated, or what it searches for has happened.
    Property(usize),
    /// An instruction met an operation error.
    Error {
        /// The PLC's code: 6706.
        code: u16,
        /// The step of the instruction.
        step: u32,
    },
    /// A scan did not end.
    Watchdog {
        /// The step at which it was stopped.
        step: u32,
    },
    /// Output Y is switched on by one coil and off by a later one.
    Doubled(u32),
    /// Output Y changes in every scan.
    Oscillation(u32),
    /// An axis ran into an end of its travel, as the simulation says it.
    Collision(String),
}

impl What {
    /// Its kind; `None` for a property.
    pub fn kind(&self) -> Option<Kind> {
        Some(match self {
            What::Property(_) => return None,
            What::Error { .. } => Kind::Errors,
            What::Watchdog { .. } => Kind::Watchdog,
            What::Doubled(_) => Kind::Doubled,
            What::Oscillation(_) => Kind::Oscillation,
            What::Collision(_) => Kind::Collisions,
        })
    }
}

/// Scans of a run that are alike, as a step of a test file: inputs change, then the program runs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Step {
    /// Inputs that change before the first scan: numbers of [`Task::inputs`] or [`crate::run::POWER`], and their
    /// values.
    pub set: Vec<(usize, i32)>,
    /// Pulses that come in the time of the first scan: numbers of [`Task::sources`], in order, and how many.
    pub pulses: Vec<(usize, i32)>,
    /// Number of scans, at least 1.
    pub scans: u32,
    /// Milliseconds from each of them to the next, at least 1.
    pub scan_ms: u32,
}

/// A finding, with a run that shows it.
#[derive(Clone, PartialEq, Debug)]
pub struct Found {
    /// The finding.
    pub what: What,
    /// The run from power-on, which ends with the scan in which it happens.
    pub run: Vec<Step>,
}

/// An input that the search changes.
#[derive(Clone, PartialEq, Debug)]
pub struct Input {
    /// Target of the input.
    pub target: Target,
    /// For a word: values that the program distinguishes.
    pub values: Vec<i32>,
}

impl Input {
    /// Returns true if it is on or off.
    pub fn is_bit(&self) -> bool {
        matches!(self.target, Target::Bit(..))
    }
}

/// Task of a search.
pub struct Task<'a> {
    /// The program as it was compiled, without optimisation.
    pub module: &'a Module,
    /// A copy that notes what a scan has executed.
    pub noting: Module,
    /// Flags of the copy.
    pub notes: Notes,
    /// Conditions that must not occur, or are searched for.
    pub properties: &'a [Property],
    /// Conditions that the machine guarantees.
    pub assumed: &'a [Condition],
    /// Other kinds of findings.
    pub kinds: BTreeSet<Kind>,
    /// Inputs that the search changes.
    pub inputs: Vec<Input>,
    /// Sources of pulses.
    pub sources: Vec<Source>,
    /// True if the power supply goes off and comes back at times, so that latched devices begin with the values that a
    /// run has left in them.
    pub power_cycles: bool,
    /// The longest time from one scan to the next, in milliseconds.
    pub scan_ms: u32,
    /// The machine around the PLC.
    pub machine: Option<&'a Description>,
    /// The PLC's hardware.
    pub hal: Box<VirtualHal>,
}

impl<'a> Task<'a> {
    /// The search of a program, wired to a machine. Its inputs are those terminals X that it reads and the machine does
    /// not drive, `free` devices, and devices that it reads and nothing in it writes.
    pub fn new(
        module: &'a Module,
        (properties, assumed): (&'a [Property], &'a [Condition]),
        free: &[(DeviceClass, u32)],
        scan_ms: u32,
        (machine, hal): (Option<&'a Description>, Box<VirtualHal>),
    ) -> Self {
        let driven = |(class, n)| machine.is_some_and(|m| m.drives(class, n));
        let areas = module.layout.areas.iter();
        let terminals = areas.filter(|area| area.class == DeviceClass::X);
        let terminals = terminals.flat_map(|area| area.first..area.first + area.count);
        let terminals = terminals.map(|n| (DeviceClass::X, n));
        let targets = terminals
            .chain(free.iter().copied())
            .chain(unwritten(module, scan_ms))
            .filter(|&device| !driven(device))
            .filter_map(|(class, n)| target(class, n).map(|target| ((class, n), target)));
        let values = constants(module);
        let inputs = BTreeMap::from_iter(targets)
            .into_values()
            .map(|target| Input {
                values: match target {
                    Target::Bit(..) => Vec::new(),
                    _ => values.clone(),
                },
                target,
            });
        let inputs = inputs.collect();
        let (noting, notes) = Notes::of(module);
        Task {
            module,
            noting,
            notes,
            properties,
            assumed,
            kinds: Kind::ALL.into(),
            inputs,
            sources: sources(module, &driven),
            power_cycles: false,
            scan_ms,
            machine,
            hal,
        }
    }

    /// Returns true if the effect of the hardware depends on more than the time.
    pub(crate) fn uses_hal(&self) -> bool {
        let mut calls = self.machine.is_some() || self.module.takes_events();
        for function in &self.module.functions {
            statements(&function.body, &mut |stmt| calls |= calls_runtime(stmt));
        }
        calls
    }

    /// Returns true if findings of this kind are searched for.
    pub fn wants(&self, kind: Kind) -> bool {
        self.kinds.contains(&kind)
    }
}

/// The devices that the program reads and nothing in it writes.
fn unwritten(module: &Module, scan_ms: u32) -> Vec<(DeviceClass, u32)> {
    let world = World {
        scan_ms,
        ..World::default()
    };
    let keys = Encoder::scan(module, world).unwritten().into_iter();
    let devices = keys.filter_map(|key| match key {
        Key::Bit(class, n) | Key::Word(class, n) => Some((class, n)),
        _ => None,
    });
    devices
        .filter(|&(class, n)| !is_special(class, n))
        .collect()
}

/// Target that sets an input; `None` if it cannot be set.
fn target(class: DeviceClass, number: u32) -> Option<Target> {
    use DeviceClass::{C, D, ER, I, M, N, P, R, S, T, V, X, Y, Z};
    match class {
        X | Y | M | S => Some(Target::Bit(class, number)),
        D | R | ER | V | Z => Some(Target::Word(class, number)),
        T | C => Some(Target::Current(class, number)),
        P | I | N => None,
    }
}

/// Values of registers at which the program does something else: its constants and their neighbours.
fn constants(module: &Module) -> Vec<i32> {
    use rungc_ir::node::Expr;
    /// More would take long to try.
    const MOST: usize = 200;
    let named = module.exprs.iter().filter_map(|expr| match *expr {
        Expr::I16(value) => Some(value.into()),
        Expr::I32(value) => Some(value),
        _ => None,
    });
    let borders = [0, 1, -1, i16::MAX.into(), i16::MIN.into()];
    let near = named
        .take(MOST)
        .flat_map(|v: i32| [v, v.wrapping_add(1), v.wrapping_sub(1)]);
    BTreeSet::from_iter(borders.into_iter().chain(near))
        .into_iter()
        .collect()
}
