//! From a module to logic: a scan, executed with bits that stand for all values at once.
//!
//! [`Encoder`] walks the statements as the interpreter does. Every statement is executed under a guard, the condition
//! under which a scan reaches it, and what it writes is chosen between the new and the old value by that guard. What is
//! not modelled exactly becomes free ([`Encoder::fresh`]), with a note that the verdict quotes. The rules of
//! [`rungc_ir::node`] hold; `golden` compares each transition with the interpreter's.

mod between;
mod blocks;
mod calls;
mod eval;
mod exec;
mod gaps;
mod memory;
mod probes;
mod restart;
mod shared;
mod shown;
#[cfg(test)]
mod tests;
mod timing;

pub(crate) use between::HostCall;
pub use gaps::Gap;
pub(crate) use gaps::gaps_of;
pub use memory::device_of;
pub(crate) use memory::is_settable;
pub use probes::{Compared, Expiry, Probes, Rung, Written};
pub use restart::AFTER_STOP;
pub use shared::{Names, Shared};
use std::collections::{BTreeMap, BTreeSet};

use crate::aig::{Aig, Lit};
use crate::bits::{Bits, constant};
use crate::system::{Latch, System};
use rungc_ir::Module;
use rungc_ir::node::{Action, Arg, ExprId, FunctionKind, LabelId, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::special::{D_WATCHDOG_MS, M_KEEP_IN_STOP};
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

/// A part of a timer's memory ([`rungc_rt::Timer`]).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum TimerPart {
    /// The current value.
    Value,
    /// The preset that was taken over.
    Preset,
    /// The contact.
    Done,
    /// State of the coil at its last execution.
    Coil,
    /// True if the coil was executed in this scan.
    Counted,
    /// Milliseconds since the last whole unit.
    Part,
}

/// A part of a counter's memory ([`rungc_rt::Counter16`]).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum CounterPart {
    /// The current value.
    Value,
    /// The contact.
    Done,
    /// State of the coil at its last execution.
    Coil,
}

/// A piece of what lasts from scan to scan.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Key {
    /// X, Y, M or S.
    Bit(DeviceClass, u32),
    /// A word device other than timers and counters.
    Word(DeviceClass, u32),
    /// Of a timer.
    Timer(u32, TimerPart),
    /// Of a counter.
    Counter(u32, CounterPart),
    /// An edge memory.
    Edge(u32),
    /// Memory of a call of the runtime, by number: one bit that stands for all of it, if programs are compared.
    Slot(u16),
    /// The same of everything around the PLC that calls of the runtime ask and change.
    Outer,
    /// A private bit.
    Flag(u32),
    /// A private number.
    Cell(u32),
    /// An entry of a private table.
    Entry(u32, u32),
    /// A word of the buffer memory of a special module: the number of the module and the address.
    Buffer(u8, u32),
    /// True in the first scan.
    First,
    /// True if the PLC is in RUN.
    Running,
    /// Milliseconds since the first scan.
    Now,
    /// Milliseconds since the first scan, from 0 again after a minute.
    Minute,
    /// Memory of a property, by number.
    Monitor(u32),
}

/// Meaning of a free bit of a scan.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Input {
    /// A bit of a device that something other than the program sets before the scan.
    Device(Key, usize),
    /// A bit of memory that the PLC writes between two scans, by itself: no run sets it.
    Shown(Writer, Key, usize),
    /// A bit of the time since the scan before: its hundreds, tens and ones of milliseconds.
    Time(Digit, usize),
    /// A bit of the time that the scan before took (D8010).
    ScanTime(usize),
    /// It is on if the PLC went from RUN to STOP and back before the scan.
    Restart,
    /// A bit of a value that is not modelled: a number of [`Encoder::gaps`].
    Gap(usize),
}

/// A part of the PLC that writes memory between two scans.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Writer {
    /// Pulse outputs, which show what they do.
    Pulses,
    /// Interrupt routines, edges of inputs, and the passing of time.
    Events,
}

/// A part of a time in milliseconds.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Digit {
    /// Whole hundreds.
    Hundreds,
    /// Whole tens beyond them.
    Tens,
    /// The remainder.
    Ones,
}

/// Assumptions about the environment of the program.
#[derive(Clone, Debug)]
pub struct World {
    /// The most milliseconds from one scan to the next.
    pub scan_ms: u32,
    /// True if latched devices begin with 0, as on a new PLC.
    pub fresh: bool,
    /// Devices that something other than the program writes.
    pub free: BTreeSet<(DeviceClass, u32)>,
    /// Devices that nothing sets unless the program does: as far as it does not, they are off from power-on.
    pub unset: BTreeSet<(DeviceClass, u32)>,
    /// True if a running timer may expire at any time, as far as its value is not read: a proof then holds for every
    /// preset.
    pub any_preset: bool,
    /// Devices that properties look at, in addition to those of the program.
    pub observed: BTreeSet<(DeviceClass, u32)>,
}

impl Default for World {
    fn default() -> Self {
        World {
            scan_ms: 200,
            fresh: false,
            free: BTreeSet::new(),
            unset: BTreeSet::new(),
            any_preset: false,
            observed: BTreeSet::new(),
        }
    }
}

/// Maximum number of statements of a scan, loops unrolled, before the rest of it counts as not modelled.
const STATEMENTS: u32 = 400_000;

/// Largest size of a scan's logic before the rest of it counts as not modelled: far larger than any solver handles.
const NODES: usize = 4_000_000;

/// The time of a scan, as logic.
#[derive(Clone)]
struct Time {
    /// Milliseconds since the scan before, 0 in the first: whole hundreds, tens, and the whole.
    hundreds: Bits,
    tens: Bits,
    all: Bits,
    /// Remainders of tens and hundreds.
    below_hundred: Bits,
    below_ten: Bits,
}

/// Makes logic of a module.
#[derive(Clone)]
pub struct Encoder<'m> {
    module: &'m Module,
    world: World,
    /// The graph so far.
    pub aig: Aig,
    inputs: Vec<(Lit, Input)>,
    constraints: Vec<Lit>,
    replay_assumptions: Vec<Lit>,
    first_replay_assumptions: Vec<Lit>,
    /// Operations that are not modelled exactly, each once.
    pub gaps: Vec<Gap>,
    gap_numbers: FxHashMap<Gap, usize>,
    /// All memory, as it is before the scan.
    before: BTreeMap<Key, Bits>,
    /// All memory, as the scan has left it so far.
    state: BTreeMap<Key, Bits>,
    /// Memory that the program may write.
    written: BTreeSet<Key>,
    /// True while writes clear, which does not count as setting a value.
    clears: bool,
    /// Memory that may be written from outside the scan, between two scans.
    external: BTreeSet<Key>,
    /// The part of it that the PLC writes by itself, and serial partners do not.
    shown: BTreeMap<Key, Writer>,
    /// The part of it that edges of inputs write, other than to clear it.
    by_edges: BTreeSet<Key>,
    /// Flags that something outside the scan sets at any time.
    events: BTreeSet<u32>,
    /// Timers whose values something looks at or writes; `None`: all.
    exact_timers: Option<BTreeSet<u32>>,
    temps: TiVec<rungc_ir::node::TempId, Option<Bits>>,
    values: FxHashMap<ExprId, Bits>,
    /// Targets of jumps in the bodies being executed, the innermost last.
    jumps: Vec<FxHashMap<LabelId, Lit>>,
    /// Under which condition the rest of the scan is not modelled.
    lost: Lit,
    lost_gap: Option<usize>,
    time: Option<Time>,
    scan_time: Option<Bits>,
    /// On if the time since the scan before is what the program asks for, at least (M8039); `None` if it asks for none.
    pub constant_scan: Option<Lit>,
    /// Values of special modules in this scan, word by word.
    buffers: BTreeMap<Key, Bits>,
    network: Option<u32>,
    /// Step of the instruction that is being executed, if it is known.
    instruction: Option<u32>,
    statements: u32,
    watched: u64,
    watch_limit: u64,
    monitors: u32,
    extra_latches: Vec<(Key, Bits, Bits, Option<i64>)>,
    /// Clocks of properties: their memory, and their unit in milliseconds.
    clocks: Vec<([Key; 3], u16)>,
    /// It is on if the PLC was in STOP before the scan; `None`: that is the same as power-on.
    restart: Option<Lit>,
    /// Parts shared with another program.
    shared: Option<Shared>,
    /// Of a program that is compared: what each function that runs between two scans makes of memory.
    between: Vec<HostCall>,
    /// Probes for the search for events that can never happen.
    pub probes: Option<Probes>,
}

impl<'m> Encoder<'m> {
    /// Executes a scan of a module, from power-on or any scan before; if the program may tell RUN after STOP from
    /// power-on, also after that.
    pub fn scan(module: &'m Module, world: World) -> Self {
        Self::executed(module, world, None, None)
    }

    /// Executes a scan of a module and notes what can happen in it.
    pub(crate) fn scan_probed(module: &'m Module, world: World) -> Self {
        Self::executed(module, world, None, Some(Probes::default()))
    }

    /// Executes a scan of a module at the same time as another is executed.
    pub(crate) fn scan_sharing(module: &'m Module, world: World, shared: Shared) -> Self {
        Self::executed(module, world, Some(shared), None)
    }

    fn executed(
        module: &'m Module,
        world: World,
        shared: Option<Shared>,
        probes: Option<Probes>,
    ) -> Self {
        let pass = |open: &BTreeSet<Key>, restarts: bool| {
            let parts = (shared.clone(), probes.clone());
            Self::pass(module, world.clone(), parts, restarts.then_some(open))
        };
        let mut encoder = pass(&BTreeSet::new(), false);
        if !encoder.remembers_stop() {
            return encoder;
        }
        let mut open = None;
        loop {
            let keys = encoder.before.keys().copied();
            let found: BTreeSet<Key> = keys.filter(|&key| encoder.is_free(key)).collect();
            if open.as_ref() == Some(&found) {
                return encoder;
            }
            encoder = pass(&found, true);
            open = Some(found);
        }
    }

    /// Executes a scan; before it, the PLC may have been in STOP if `open`, the memory that something outside the
    /// program sets, is given.
    fn pass(
        module: &'m Module,
        mut world: World,
        (mut shared, probes): (Option<Shared>, Option<Probes>),
        open: Option<&BTreeSet<Key>>,
    ) -> Self {
        let free = world.free.into_iter();
        world.free = free
            .map(|(class, number)| module.model.canonical(class, number))
            .collect();
        let keeps = (DeviceClass::M, M_KEEP_IN_STOP.number());
        world.observed.extend(world.free.get(&keeps));
        let aig = shared
            .as_mut()
            .map(|shared| std::mem::take(&mut shared.aig));
        let gaps = shared
            .as_ref()
            .map_or_else(Vec::new, |shared| shared.gaps.clone());
        let mut encoder = Encoder {
            module,
            aig: aig.unwrap_or_default(),
            inputs: Vec::new(),
            constraints: Vec::new(),
            replay_assumptions: Vec::new(),
            first_replay_assumptions: Vec::new(),
            gap_numbers: gaps.iter().cloned().zip(0..).collect(),
            gaps,
            before: BTreeMap::new(),
            state: BTreeMap::new(),
            written: BTreeSet::new(),
            clears: false,
            external: BTreeSet::new(),
            shown: BTreeMap::new(),
            by_edges: BTreeSet::new(),
            events: BTreeSet::new(),
            exact_timers: None,
            temps: vec![None; module.temps.len()].into(),
            values: FxHashMap::default(),
            jumps: Vec::new(),
            lost: Lit::FALSE,
            lost_gap: None,
            time: None,
            scan_time: None,
            constant_scan: None,
            buffers: BTreeMap::new(),
            network: None,
            instruction: None,
            statements: 0,
            watched: 0,
            watch_limit: 0,
            monitors: 0,
            extra_latches: Vec::new(),
            clocks: Vec::new(),
            restart: None,
            world,
            shared,
            between: Vec::new(),
            probes,
        };
        encoder.find_memory();
        encoder.find_external();
        encoder.find_timers();
        if let Some(open) = open {
            encoder.begin_restart(open);
        }
        encoder.begin_time();
        encoder.execute();
        encoder
    }

    /// Executes the scan.
    fn execute(&mut self) {
        self.watch_limit = self.watch_steps();
        // A module's first functions are `Begin`, `Main`, `End`.
        for function in 0..3 {
            self.network = None;
            self.function(function, Lit::TRUE);
        }
        self.network = None;
        self.state.insert(Key::First, vec![Lit::FALSE]);
        self.lose();
        if self.is_compared() {
            self.run_between();
        }
        // What properties add is in no network.
        self.network = None;
    }

    /// The steps that a scan may repeat for certain before the watchdog ends it.
    fn watch_steps(&self) -> u64 {
        let register = Key::Word(DeviceClass::D, D_WATCHDOG_MS.number());
        let ms = match self.before.contains_key(&register) {
            true => 1,
            false => self.module.watchdog_ms(),
        };
        Module::scan_steps(ms).into()
    }

    /// Makes all memory arbitrary where the rest of a scan is not modelled.
    fn lose(&mut self) {
        let (lost, Some(gap)) = (self.lost, self.lost_gap) else {
            return;
        };
        let keys: Vec<Key> = self.state.keys().copied().collect();
        for key in keys {
            let fresh = self.fresh_of(self.state[&key].len(), gap);
            self.store(key, &fresh, lost);
        }
    }

    /// The functions of the module of a kind, by number.
    fn functions_of(&self, is_it: impl Fn(&FunctionKind) -> bool) -> Vec<usize> {
        let functions = self.module.functions.iter().enumerate();
        functions
            .filter(|(_, function)| is_it(&function.kind))
            .map(|(i, _)| i)
            .collect()
    }

    /// The program.
    pub fn module(&self) -> &'m Module {
        self.module
    }

    /// Supposes that something holds after every scan.
    pub fn suppose(&mut self, holds: Lit) {
        self.constraints.push(holds);
    }

    /// Bit that is on if the PLC is in RUN after the scan: the results of a program that stops are not evaluated.
    pub fn running(&self) -> Lit {
        self.state[&Key::Running][0]
    }

    /// A memory for a property, that begins as this, also when RUN begins: its bits before the scan.
    pub fn monitor(&mut self, width: usize, init: i64) -> (usize, Bits) {
        let bits = self.aig.inputs_of(width);
        let key = Key::Monitor(self.monitors);
        self.monitors += 1;
        let begins = constant(init, width);
        self.extra_latches
            .push((key, bits.clone(), begins.clone(), Some(init)));
        let bits = match self.restart {
            Some(restart) => self.aig.select(restart, &begins, &bits),
            None => bits,
        };
        (self.extra_latches.len() - 1, bits)
    }

    /// Notes a clock: the memory of its units, of milliseconds beyond, and of whether it runs.
    pub(crate) fn note_clock(&mut self, memory: [usize; 3], unit_ms: u16) {
        let keys = memory.map(|monitor| self.extra_latches[monitor].0);
        self.clocks.push((keys, unit_ms));
    }

    /// Sets the value of such a memory after the scan.
    pub fn remember(&mut self, monitor: usize, next: Bits) {
        self.extra_latches[monitor].2 = next;
    }

    /// Bit that is on if an output is on by a pulse. Pulses are not modelled.
    pub fn pulse(&mut self, output: u32) -> Lit {
        if !self.module.pulse_outputs.contains(&output) {
            return Lit::FALSE;
        }
        let mut sender = None;
        let sends = |arg: &Arg| {
            let place = match arg {
                Arg::Device { place, .. } => place,
                _ => return false,
            };
            (place.class, place.number) == (DeviceClass::Y, output)
        };
        for function in &self.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Call(call)) = stmt
                    && call.function.needs().pulses
                    && call.args.iter().any(sends)
                {
                    sender.get_or_insert(call.step);
                }
            });
        }
        let origin = sender.and_then(|step| self.module.origin(step));
        let what = match origin {
            Some(origin) => format!("pulses of {}", origin.text),
            None => format!("pulses at {}", DeviceClass::Y.number(output)),
        };
        self.instruction = origin.map(|origin| origin.step);
        let pulse = self.fresh(1, &what)[0];
        self.instruction = None;
        pulse
    }

    /// Milliseconds since the scan before, 0 in the first.
    pub fn elapsed(&self) -> Bits {
        self.time
            .as_ref()
            .map_or_else(Bits::new, |time| time.all.clone())
    }

    /// Returns true if the program could read a device but nothing in it writes it, or only clears it: a panel or
    /// another PLC may set it.
    fn is_unwritten(&self, key: Key) -> bool {
        use DeviceClass::{D, ER, M, R, S, V, Z};
        let asked = match key {
            Key::Bit(class, _) | Key::Word(class, _) => matches!(class, M | S | D | R | ER | V | Z),
            _ => true,
        };
        let written =
            self.written.contains(&key) || self.by_edges.contains(&key) || self.is_unset(key);
        asked && memory::is_settable(key) && !written
    }

    /// Returns true if it belongs to a device of [`World::unset`] that nothing sets, so that it is off.
    pub(crate) fn is_unset(&self, key: Key) -> bool {
        let is_unset = |device| self.world.unset.contains(&device);
        memory::device_of(key).is_some_and(is_unset)
            && !self.written.contains(&key)
            && !self.external.contains(&key)
            && !self.is_named_free(key)
    }

    /// The part of the PLC that alone sets a piece of memory before each scan, so that nothing else gives it a value.
    pub(crate) fn shown_by_plc(&self, key: Key) -> Option<Writer> {
        let writer = self.shown.get(&key).copied();
        writer.filter(|_| !self.is_named_free(key) && !self.is_unwritten(key))
    }

    /// Returns true if partners at serial ports set a device before each scan.
    pub(crate) fn is_received(&self, key: Key) -> bool {
        self.module.has_ports()
            && self.external.contains(&key)
            && !self.shown.contains_key(&key)
            && !matches!(key, Key::Bit(DeviceClass::X, _))
    }

    /// Returns true if something other than the program sets a device before each scan.
    pub fn is_free(&self, key: Key) -> bool {
        matches!(key, Key::Bit(DeviceClass::X, _))
            || self.external.contains(&key)
            || self.is_unwritten(key)
            || self.is_named_free(key)
    }

    /// Returns true if it belongs to a device of [`World::free`].
    pub(crate) fn is_named_free(&self, key: Key) -> bool {
        let is_free = |device| self.world.free.contains(&device);
        memory::is_settable(key) && memory::device_of(key).is_some_and(is_free)
    }

    /// The input terminals whose edges run something, in order.
    pub(crate) fn edges(&self) -> impl Iterator<Item = u32> {
        let functions = self.module.functions.iter();
        let inputs = functions.filter_map(|function| match function.kind {
            FunctionKind::InputEdge { input, .. } => Some(input),
            _ => None,
        });
        BTreeSet::from_iter(inputs).into_iter()
    }

    /// Memory that counts as an input beside terminals: unwritten memory, and that named by [`World::free`].
    pub fn opened(&self) -> impl Iterator<Item = Key> {
        let keys = self.before.keys().copied();
        keys.filter(|&key| self.is_unwritten(key) || self.is_named_free(key))
    }

    /// The devices that the program reads and nothing in it writes, which count as inputs.
    pub fn unwritten(&self) -> Vec<Key> {
        let keys = self.before.keys().copied();
        keys.filter(|&key| self.is_unwritten(key)).collect()
    }

    /// All memory: what it is, its bits before the scan, and those after it.
    pub fn memory(&self) -> impl Iterator<Item = (Key, &Bits, &Bits)> {
        let before = self.before.iter();
        before.map(|(&key, before)| (key, before, &self.state[&key]))
    }

    /// The bits of a piece of memory before the scan.
    pub fn before(&self, key: Key) -> Option<&Bits> {
        self.before.get(&key)
    }

    /// The bits of a piece of memory after the scan.
    pub fn after(&self, key: Key) -> Option<&Bits> {
        self.state.get(&key)
    }

    /// Conditions that hold in every scan.
    pub fn constraints(&self) -> &[Lit] {
        &self.constraints
    }

    /// Adds this program's part of a system of several programs: its memory, except that replaced by another's, and its
    /// inputs. An input of one of them is one for all.
    pub(crate) fn add_to(
        &self,
        system: &mut System,
        wanted: &dyn Fn(Key) -> bool,
        free: &dyn Fn(Key) -> bool,
    ) {
        for (key, before, after) in self.memory().filter(|(key, ..)| wanted(*key)) {
            let init = self.initial(key);
            for (bit, (&now, &next)) in before.iter().zip(after).enumerate() {
                if free(key) {
                    let input = match self.shown_by_plc(key) {
                        Some(writer) => Input::Shown(writer, key, bit),
                        None => Input::Device(key, bit),
                    };
                    system.inputs.push((now, input));
                    continue;
                }
                system.latches.push(Latch {
                    now,
                    next,
                    init: init.map(|init| init >> bit & 1 == 1),
                    key,
                    bit,
                });
            }
        }
        system.inputs.extend(&self.inputs);
        system.constraints.extend(&self.constraints);
        system.replay_assumptions.extend(&self.replay_assumptions);
        system
            .first_replay_assumptions
            .extend(&self.first_replay_assumptions);
    }

    /// The system with the question whether this can happen.
    pub fn system(&self, bad: Lit) -> System {
        let mut system = System {
            aig: self.aig.clone(),
            latches: Vec::new(),
            inputs: Vec::new(),
            constraints: Vec::new(),
            replay_assumptions: Vec::new(),
            first_replay_assumptions: Vec::new(),
            lags: self.lags(),
            bad,
        };
        self.add_to(&mut system, &|_| true, &|key| self.is_free(key));
        for (key, now, next, init) in &self.extra_latches {
            for (bit, (&now, &next)) in now.iter().zip(next).enumerate() {
                system.latches.push(Latch {
                    now,
                    next,
                    init: init.map(|init| init >> bit & 1 == 1),
                    key: *key,
                    bit,
                });
            }
        }
        system
    }
}

impl Digit {
    /// Its value in milliseconds.
    pub fn milliseconds(self) -> u32 {
        match self {
            Digit::Hundreds => 100,
            Digit::Tens => 10,
            Digit::Ones => 1,
        }
    }
}
