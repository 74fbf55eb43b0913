//! A scan as conditions: looks on while it is executed, and follows each bit back to what it was when the scan began.
//!
//! Statements that are not executed count as well: what they would have done stands under the condition of their
//! branch.

use crate::explain::state;
use crate::graph::{Fact, FactKind, Graph, Id};
use crate::sites::{Address, Site, Sites};
use rungc_interp::{Machine, Observer};
use rungc_ir::node::{Action, Branch, EdgeId, FlagId, Stmt, TempId};
use rungc_ir::{Module, walk};
use rungc_lower::marks::{Mark, Marks};
use rungc_syntax::Device;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};

/// Deepest nesting of routines that are followed where they are not executed.
const MOST_CALLS: usize = 8;

/// An instruction that contacts drive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive {
    /// Condition of its drive.
    pub(crate) on: Id,
    /// Condition of its being executed.
    pub(crate) path: Id,
}

/// Conditions of a scan.
#[derive(Default)]
pub(crate) struct Trace {
    pub(crate) graph: Graph,
    /// Bit devices that the scan may have written.
    pub(crate) bits: FxHashMap<Device, Id>,
    /// Word devices that it may have written, and what they depend on.
    pub(crate) words: FxHashMap<Device, Id>,
    /// Instructions that contacts drive.
    pub(crate) drives: BTreeMap<usize, Drive>,
    /// By bit device: the instructions that wrote it in this scan, in order.
    pub(crate) wrote: FxHashMap<Device, Vec<usize>>,
    /// Instructions whose networks were executed.
    pub(crate) executed: FxHashSet<usize>,
    /// True if there are jumps that are not followed: backwards, or out of a routine.
    pub(crate) jumped: bool,
    temps: FxHashMap<TempId, Id>,
    /// Memories of edges after the scan.
    pub(crate) edges: FxHashMap<EdgeId, Id>,
    flags: FxHashMap<FlagId, Id>,
    /// Paths into the executed side of each branch.
    inner: FxHashMap<Address, Id>,
    /// Paths to the functions that are called.
    functions: FxHashMap<usize, Id>,
    pending: Vec<Pending>,
}

/// A write whose value shows once it is executed.
pub(super) struct Pending {
    pub(super) device: Device,
    pub(super) site: Where,
    pub(super) effect: Effect,
}

/// Kind of a write whose value shows once it is executed.
pub(super) enum Effect {
    /// The coil of a timer, with its drive; true if only RST switches it off.
    Timer(Id, bool),
    /// The coil of a counter, with its drive, and whether one more count reaches the preset.
    Counter(Id, bool),
    /// Any other, and what it depends on.
    Unknown(FactKind, Vec<Id>),
}

/// Place of a statement, and the condition under which it is executed.
#[derive(Clone, Copy)]
pub(super) struct Where {
    pub(super) instr: Option<usize>,
    pub(super) path: Id,
    /// True if it is executed in this scan.
    pub(super) live: bool,
}

/// Parts of a program that stay as they are in a scan.
pub(crate) struct Fixed {
    pub(crate) marks: Arc<Marks>,
    pub(crate) sites: Arc<Sites>,
    /// Devices that bits are followed for: those that the program reads as contacts, and those that are explained.
    pub(crate) named: BTreeSet<Device>,
}

/// Looks on at a scan.
pub(crate) struct Recorder {
    pub(crate) fixed: Arc<Fixed>,
    pub(crate) trace: Arc<Mutex<Trace>>,
}

impl Observer for Recorder {
    fn before(&mut self, machine: &Machine, stmt: &Stmt) {
        let mut trace = self.trace.lock().unwrap_or_else(PoisonError::into_inner);
        let mut scan = Scan {
            fixed: &self.fixed,
            trace: &mut trace,
            machine,
        };
        scan.settle();
        scan.before(stmt);
    }
}

/// A scan that is looked at.
pub(crate) struct Scan<'a> {
    pub(super) fixed: &'a Fixed,
    pub(super) trace: &'a mut Trace,
    pub(super) machine: &'a Machine<'a>,
}

impl<'a> Scan<'a> {
    pub(crate) fn new(fixed: &'a Fixed, trace: &'a mut Trace, machine: &'a Machine<'a>) -> Self {
        Scan {
            fixed,
            trace,
            machine,
        }
    }

    pub(super) fn graph(&mut self) -> &mut Graph {
        &mut self.trace.graph
    }

    pub(super) fn module(&self) -> &'a Module {
        self.machine.module()
    }

    /// State of a bit device as it is now.
    pub(super) fn state(&self, device: Device) -> bool {
        state(self.machine, device)
    }

    /// A bit device as the scan has left it so far.
    pub(super) fn bit(&mut self, device: Device) -> Id {
        match self.trace.bits.get(&device) {
            Some(&id) => id,
            None => {
                let value = self.state(device);
                self.graph().start(device, value)
            }
        }
    }

    /// Gives the writes that have been executed meanwhile their values.
    pub(crate) fn settle(&mut self) {
        for pending in std::mem::take(&mut self.trace.pending) {
            let Pending {
                device,
                site,
                effect,
            } = pending;
            let value = self.state(device);
            let node = self.effect(device, site, effect, value);
            self.write(device, node, site);
        }
    }

    /// The bit that a write gives a device, which is now, or is left, at `value`.
    fn effect(&mut self, device: Device, site: Where, effect: Effect, value: bool) -> Id {
        let is_on = matches!(effect, Effect::Counter(drive, _) if self.trace.graph.value(drive));
        let old = self.bit(device);
        let was = self.trace.graph.value(old);
        let mut fact = |kind, inputs, value| {
            let fact = Fact {
                kind,
                instr: site.instr,
                device: Some(device),
                inputs,
                live: site.live,
            };
            self.trace.graph.fact(fact, value)
        };
        match effect {
            Effect::Timer(drive, keeps) => {
                let elapsed = fact(FactKind::Elapsed, Vec::new(), value && !(keeps && was));
                let runs = self.graph().and(drive, elapsed);
                match keeps {
                    true => self.graph().or(old, runs),
                    false => runs,
                }
            }
            Effect::Counter(drive, next) => {
                let reaches = if is_on { value && !was } else { next };
                let counted = fact(FactKind::Counted, vec![drive], reaches);
                let counts = self.graph().and(drive, counted);
                self.graph().or(old, counts)
            }
            Effect::Unknown(kind, inputs) => fact(kind, inputs, value),
        }
    }

    /// Writes a bit device.
    pub(super) fn write(&mut self, device: Device, value: Id, site: Where) {
        let old = self.bit(device);
        let new = self.graph().choice(site.path, value, old);
        self.trace.bits.insert(device, new);
        if let (true, Some(instr)) = (site.live, site.instr) {
            self.trace.wrote.entry(device).or_default().push(instr);
        }
    }

    /// Writes a bit device whose value shows once the statement is executed.
    pub(super) fn later(&mut self, device: Device, site: Where, effect: Effect) {
        // Its state before the write is noted before that is executed.
        self.bit(device);
        if site.live {
            self.trace.pending.push(Pending {
                device,
                site,
                effect,
            });
            return;
        }
        // What is not executed might leave the device as it is.
        let value = match effect {
            Effect::Unknown(..) => {
                let old = self.bit(device);
                self.trace.graph.value(old)
            }
            Effect::Timer(..) | Effect::Counter(..) => false,
        };
        let node = self.effect(device, site, effect, value);
        self.write(device, node, site);
    }

    /// A statement is about to be executed.
    fn before(&mut self, stmt: &Stmt) {
        let yes = self.graph().constant(true);
        let Some(place) = self.fixed.sites.get(Address::of(stmt)) else {
            return;
        };
        let inner = place
            .branch
            .map(|(branch, _)| self.trace.inner.get(&branch));
        let path = match inner {
            Some(inner) => inner.copied().unwrap_or(yes),
            None => *self.trace.functions.get(&place.function).unwrap_or(&yes),
        };
        let site = Where {
            instr: place.instr,
            path,
            live: true,
        };
        match stmt {
            Stmt::If(branch) => {
                let cond = self.logic(branch.cond, site);
                let taken = self.trace.graph.value(cond);
                let not = self.graph().not(cond);
                let (enters, passes, passed) = match taken {
                    true => (cond, not, &branch.otherwise),
                    false => (not, cond, &branch.then),
                };
                let enters = self.graph().and(path, enters);
                self.trace.inner.insert(Address::of(stmt), enters);
                let passes = self.graph().and(path, passes);
                self.body(passed, passes, 0);
            }
            Stmt::CallSub(function) => {
                self.trace.functions.insert(*function as usize, path);
            }
            other => self.simple(other, site),
        }
    }

    /// Statements that are not executed in this scan.
    pub(crate) fn body(&mut self, body: &[Stmt], path: Id, calls: usize) {
        for stmt in body {
            let place = self.fixed.sites.get(Address::of(stmt));
            let site = Where {
                instr: place.and_then(|place: Site| place.instr),
                path,
                live: false,
            };
            match stmt {
                Stmt::If(Branch {
                    cond,
                    then,
                    otherwise,
                }) => {
                    let cond = self.logic(*cond, site);
                    let on = self.graph().and(path, cond);
                    self.body(then, on, calls);
                    let not = self.graph().not(cond);
                    let off = self.graph().and(path, not);
                    self.body(otherwise, off, calls);
                }
                Stmt::CallSub(function) if calls < MOST_CALLS => {
                    let module = self.module();
                    if let Some(function) = module.functions.get(*function as usize) {
                        self.body(&function.body, path, calls + 1);
                    }
                }
                other => {
                    self.simple(other, site);
                    for body in walk::bodies(other) {
                        self.body(body, path, calls);
                    }
                }
            }
        }
    }

    /// A statement without the bodies in it.
    fn simple(&mut self, stmt: &Stmt, site: Where) {
        match stmt {
            Stmt::Network(number) => self.mark(*number, site),
            Stmt::Do(action) => self.action(action, site),
            Stmt::Return | Stmt::Goto(_) => self.trace.jumped = true,
            Stmt::If(_)
            | Stmt::For { .. }
            | Stmt::Repeat(_)
            | Stmt::Steps(_)
            | Stmt::CallSub(_)
            | Stmt::Parts(_)
            | Stmt::Watch { .. } => {}
        }
    }

    fn mark(&mut self, number: u32, site: Where) {
        let Some(mark) = self.fixed.marks.places.get(number as usize).copied() else {
            return;
        };
        let instr = match mark {
            Mark::Network(instr) => instr as usize,
            Mark::Output { instr, drive } => {
                let on = self.logic(drive, site);
                let drive = Drive {
                    on,
                    path: site.path,
                };
                // A routine may be called again: what is executed counts.
                let drives = &mut self.trace.drives;
                if site.live || !drives.contains_key(&(instr as usize)) {
                    drives.insert(instr as usize, drive);
                }
                instr as usize
            }
        };
        if site.live {
            self.trace.executed.insert(instr);
        }
    }

    /// A temporary's bit.
    pub(super) fn temp(&self, temp: TempId) -> Option<Id> {
        self.trace.temps.get(&temp).copied()
    }

    /// Gives a temporary its bit, on the paths that come here.
    pub(super) fn set_temp(&mut self, temp: TempId, value: Id, site: Where) {
        let new = match self.temp(temp) {
            Some(old) => self.graph().choice(site.path, value, old),
            None => value,
        };
        self.trace.temps.insert(temp, new);
    }

    /// Contents of the memory of an edge.
    pub(super) fn memory(&mut self, memory: EdgeId, instr: Option<usize>) -> Id {
        match self.trace.edges.get(&memory) {
            Some(&id) => id,
            None => {
                let value = self.machine.edge_memory(memory);
                self.graph().memory(memory, instr, value)
            }
        }
    }

    pub(super) fn set_memory(&mut self, memory: EdgeId, value: Id, site: Where) {
        let old = self.memory(memory, site.instr);
        let new = self.graph().choice(site.path, value, old);
        self.trace.edges.insert(memory, new);
    }

    /// A flag as the scan has left it so far.
    pub(super) fn flag(&mut self, flag: FlagId, site: Where) -> Id {
        match self.trace.flags.get(&flag) {
            Some(&id) => id,
            None => {
                let value = self.machine.flag(flag);
                let fact = Fact {
                    kind: FactKind::Other,
                    instr: site.instr,
                    device: None,
                    inputs: Vec::new(),
                    live: true,
                };
                let id = self.graph().fact(fact, value);
                self.trace.flags.insert(flag, id);
                id
            }
        }
    }

    pub(super) fn set_flag(&mut self, flag: FlagId, value: Id, site: Where) {
        let old = self.flag(flag, site);
        let new = self.graph().choice(site.path, value, old);
        self.trace.flags.insert(flag, new);
    }

    /// Bits that a word device depends on, if the scan has written it.
    pub(super) fn word(&self, device: Device) -> Option<Id> {
        self.trace.words.get(&device).copied()
    }

    pub(super) fn set_word(&mut self, device: Device, mut inputs: Vec<Id>, site: Where) {
        inputs.extend(self.word(device));
        inputs.push(site.path);
        let fact = Fact {
            kind: FactKind::Written,
            instr: site.instr,
            device: Some(device),
            inputs,
            live: site.live,
        };
        let id = self.graph().fact(fact, false);
        self.trace.words.insert(device, id);
    }
}

/// Returns true if an action writes no devices of the program.
pub(super) fn is_silent(action: &Action) -> bool {
    matches!(
        action,
        Action::Fault { .. } | Action::RestartWatchdog | Action::Stop | Action::TimerGoesOn { .. }
    )
}
