//! The memory of a program: which there is, how it begins, and how it is read and written.

use super::shared::Signature;
use super::{CounterPart, Digit, Encoder, Input, Key, Time, TimerPart, Writer};
use crate::aig::Lit;
use crate::bits::{Bits, constant, signed, unsigned};
use rungc_ir::node::{Action, Expr, FunctionKind, Place, SetEntry, Stmt};
use rungc_ir::reach::{Footprint, of_expr, of_stmt};
use rungc_ir::walk::{called_functions, callees, statements};
use rungc_models::runs::is_counter32;
use rungc_rt::{Register, Relay};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeMap, BTreeSet};

/// An operand that may reach more devices than this is not modelled.
const REACH: u32 = 256;

/// Maximum number of devices that an index is followed to, if it leads to others, too.
const MOST: usize = 64;

/// Places that an index leads to.
pub(super) struct Candidates {
    /// The first device of each, with the condition under which the index leads there.
    pub numbers: Vec<(Lit, u32)>,
    /// True if there are no others: else it also leads to devices that the program does not name.
    pub are_all: bool,
}

/// The parts of a timer.
const TIMER: [TimerPart; 6] = [
    TimerPart::Value,
    TimerPart::Preset,
    TimerPart::Done,
    TimerPart::Coil,
    TimerPart::Counted,
    TimerPart::Part,
];

/// The parts of a counter.
const COUNTER: [CounterPart; 3] = [CounterPart::Value, CounterPart::Done, CounterPart::Coil];

/// Milliseconds of a minute.
const MINUTE_MS: i64 = 60_000;

/// The device that a piece of memory belongs to.
pub fn device_of(key: Key) -> Option<(DeviceClass, u32)> {
    match key {
        Key::Bit(class, number) | Key::Word(class, number) => Some((class, number)),
        Key::Timer(number, _) => Some((DeviceClass::T, number)),
        Key::Counter(number, _) => Some((DeviceClass::C, number)),
        Key::Edge(_)
        | Key::Slot(_)
        | Key::Outer
        | Key::Flag(_)
        | Key::Cell(_)
        | Key::Entry(..)
        | Key::Buffer(..)
        | Key::First
        | Key::Running
        | Key::Now
        | Key::Minute
        | Key::Monitor(_) => None,
    }
}

/// Returns true if something other than the program can write it: devices, and of timers and counters the values and
/// contacts.
pub(crate) fn is_settable(key: Key) -> bool {
    match key {
        Key::Timer(_, part) => matches!(part, TimerPart::Value | TimerPart::Done),
        Key::Counter(_, part) => matches!(part, CounterPart::Value | CounterPart::Done),
        Key::Bit(..) | Key::Word(..) => true,
        _ => false,
    }
}

/// Number of bits in a piece of memory.
fn width(key: Key, unit_ms: u16) -> usize {
    match key {
        Key::Bit(..) | Key::Edge(_) | Key::Flag(_) | Key::First | Key::Running => 1,
        Key::Slot(_) | Key::Outer => 1,
        Key::Word(..) | Key::Buffer(..) | Key::Minute => 16,
        Key::Timer(_, TimerPart::Value | TimerPart::Preset) => 16,
        Key::Timer(_, TimerPart::Part) => match unit_ms {
            ..=1 => 0,
            2..=10 => 4,
            _ => 8,
        },
        Key::Timer(..) | Key::Counter(_, CounterPart::Done | CounterPart::Coil) => 1,
        Key::Counter(number, CounterPart::Value) => match is_counter32(DeviceClass::C, number) {
            true => 32,
            false => 16,
        },
        Key::Cell(_) | Key::Entry(..) | Key::Now => 32,
        Key::Monitor(_) => 0,
    }
}

impl Encoder<'_> {
    /// The memory of a device.
    pub(super) fn keys(&self, class: DeviceClass, number: u32) -> Vec<Key> {
        use DeviceClass::{C, D, ER, I, M, N, P, R, S, T, V, X, Y, Z};
        let (class, number) = self.module.model.canonical(class, number);
        if !self.module.model.has(class, number) {
            return Vec::new();
        }
        match class {
            X | Y | M | S => vec![Key::Bit(class, number)],
            D | R | ER | V | Z => vec![Key::Word(class, number)],
            T => TIMER.map(|part| Key::Timer(number, part)).into(),
            C => COUNTER.map(|part| Key::Counter(number, part)).into(),
            P | I | N => Vec::new(),
        }
    }

    /// Gives every piece of memory that the program names its bits.
    pub(super) fn find_memory(&mut self) {
        let (module, model) = (self.module, self.module.model);
        let mut devices: BTreeSet<(DeviceClass, u32)> = self.world.observed.clone();
        let mut note = |used: Footprint| {
            let class = used.place.class;
            let runs = used.reach(model, &module.exprs);
            let size: u32 = runs.iter().map(|(first, last)| last - first + 1).sum();
            if size <= REACH {
                let all = runs.into_iter().flat_map(|(first, last)| first..=last);
                devices.extend(all.map(|number| (class, number)));
            }
        };
        for expr in &module.exprs {
            of_expr(model, expr, &mut note);
        }
        let called = called_functions(module);
        for (function, _) in module
            .functions
            .iter()
            .zip(called)
            .filter(|(_, called)| *called)
        {
            statements(&function.body, &mut |stmt| of_stmt(model, stmt, &mut note));
        }
        let devices = devices.into_iter();
        let devices = devices.map(|(class, number)| model.canonical(class, number));
        for (class, number) in BTreeSet::from_iter(devices) {
            for key in self.keys(class, number) {
                self.add_memory(key);
            }
        }
        let tables = module.tables.iter().zip(0..);
        let entries =
            tables.flat_map(|(table, t)| (0..table.length).map(move |i| Key::Entry(t, i)));
        let private = (0..module.edges).map(Key::Edge);
        let private = private.chain((0..module.flags.len() as u32).map(Key::Flag));
        let private = private.chain((0..module.cells.len() as u32).map(Key::Cell));
        for key in private.chain(entries).chain(self.tokens()).chain([
            Key::First,
            Key::Running,
            Key::Now,
            Key::Minute,
        ]) {
            self.add_memory(key);
        }
    }

    fn add_memory(&mut self, key: Key) {
        let unit_ms = match key {
            Key::Timer(number, _) => self
                .module
                .model
                .timer(number)
                .map_or(1, |kind| kind.unit_ms),
            _ => 1,
        };
        let shared = self
            .shared
            .as_ref()
            .and_then(|shared| shared.begins_as(key));
        let bits = shared.unwrap_or_else(|| self.aig.inputs_of(width(key, unit_ms)));
        if let Key::Timer(_, TimerPart::Part) = key
            && unit_ms > 1
        {
            let less = self.aig.below(&bits, &constant(unit_ms.into(), bits.len()));
            self.constraints.push(less);
            let zero = self.aig.is(&bits, 0);
            self.first_replay_assumptions.push(zero);
        }
        if key == Key::Minute {
            let less = self.aig.below(&bits, &constant(MINUTE_MS, bits.len()));
            self.constraints.push(less);
        }
        self.before.insert(key, bits.clone());
        // No coil has been executed in a scan that begins.
        let now = match key {
            Key::Timer(_, TimerPart::Counted) => vec![Lit::FALSE],
            _ => bits,
        };
        self.state.insert(key, now);
    }

    /// Value of a piece of memory before the first scan; `None`: any value.
    pub fn initial(&self, key: Key) -> Option<i64> {
        let model = self.module.model;
        let latched = |class, number| self.module.is_latched(class, number) && !self.world.fresh;
        match key {
            _ if self.is_unset(key) => Some(0),
            Key::Bit(class, number) if latched(class, number) => None,
            Key::Bit(DeviceClass::M, number) => {
                let relay = u16::try_from(number).ok().map(Relay);
                Some(
                    relay
                        .is_some_and(|relay| model.is_on_at_power_on(relay))
                        .into(),
                )
            }
            Key::Word(class, number) if latched(class, number) => None,
            Key::Word(DeviceClass::D, number) => {
                let register = u16::try_from(number).ok().map(Register);
                Some(register.map_or(0, |register| model.word_at_power_on(register).into()))
            }
            Key::Timer(number, TimerPart::Value | TimerPart::Preset | TimerPart::Part)
                if latched(DeviceClass::T, number) =>
            {
                None
            }
            Key::Timer(number, TimerPart::Done) if latched(DeviceClass::T, number) => {
                (!model.keeps_contacts).then_some(0)
            }
            Key::Counter(number, CounterPart::Value) if latched(DeviceClass::C, number) => None,
            Key::Counter(number, CounterPart::Done) if latched(DeviceClass::C, number) => {
                (!model.keeps_contacts).then_some(0)
            }
            Key::Now | Key::Minute => None,
            Key::First | Key::Running => Some(1),
            Key::Bit(..)
            | Key::Word(..)
            | Key::Timer(..)
            | Key::Counter(..)
            | Key::Edge(_)
            | Key::Slot(_)
            | Key::Outer
            | Key::Flag(_)
            | Key::Cell(_)
            | Key::Entry(..)
            | Key::Buffer(..)
            | Key::Monitor(_) => Some(0),
        }
    }

    /// Present value of a piece of memory; unknown if the program does not name it.
    pub(super) fn load(&mut self, key: Key) -> Bits {
        if let Key::Flag(flag) = key
            && self.events.contains(&flag)
        {
            return self.applied(1, "events between two scans", Signature::Event(key), &[]);
        }
        match self.state.get(&key) {
            Some(bits) => bits.clone(),
            None => self.unnamed(width(key, 1)),
        }
    }

    /// Value of something that the program does not name, so that only an index or a block reaches it: any value. A
    /// replay finds 0 there.
    pub(super) fn unnamed(&mut self, width: usize) -> Bits {
        let value = self.fresh(width, "devices that only an index or a block reaches");
        let zero = self.aig.is(&value, 0);
        self.replay_assumptions.push(zero);
        value
    }

    /// Writes a piece of memory under a condition.
    pub(super) fn store(&mut self, key: Key, value: &[Lit], guard: Lit) {
        if let Some(old) = self.state.get(&key) {
            let new = match guard.constant() {
                Some(true) => value.to_vec(),
                Some(false) => return,
                None => {
                    let old = old.clone();
                    self.aig.select(guard, value, &old)
                }
            };
            self.state.insert(key, new);
            if !self.clears {
                self.written.insert(key);
            }
        }
    }

    /// The memory that the program names, of the devices of a class from the one number to the other.
    pub(super) fn named(&self, class: DeviceClass, first: u32, last: u32) -> Vec<Key> {
        let mut keys: Vec<Key> = self
            .state
            .keys()
            .copied()
            .filter(|&key| {
                device_of(key)
                    .is_some_and(|(of, number)| of == class && (first..=last).contains(&number))
            })
            .collect();
        let aliases = self.module.model.aliases_within(class, first, last);
        let aliases = aliases.map(|alias| Key::Word(alias.class, alias.index));
        keys.extend(aliases.filter(|key| self.state.contains_key(key)));
        keys
    }

    /// Finds what changes between two scans: what input edges write, what interrupts write, since a host may take them
    /// then, and what ports and pulse outputs show.
    pub(super) fn find_external(&mut self) {
        self.find_events();
        let of_events = self.external.clone();
        let received = self.received();
        self.external.extend(&received);
        let mut shown: BTreeMap<Key, Writer> = BTreeMap::new();
        if self.module.sends_pulses() {
            let pulses = self.of_outputs();
            self.external.extend(&pulses);
            shown.extend(pulses.into_iter().map(|key| (key, Writer::Pulses)));
        }
        shown.extend(of_events.into_iter().map(|key| (key, Writer::Events)));
        // An instruction that refreshes inputs takes them from outside.
        let from_outside = |key: &Key| match key {
            Key::Bit(DeviceClass::X, _) => true,
            _ => is_settable(*key) && received.contains(key),
        };
        shown.retain(|key, _| !from_outside(key));
        self.shown = shown;
    }

    /// Finds what edges of inputs, interrupts and the passing of time write.
    fn find_events(&mut self) {
        let module = self.module;
        for (flag, i) in module.flags.iter().zip(0..) {
            if flag.period_ms.is_some() || flag.pulses_end.is_some() {
                self.events.insert(i);
            }
        }
        for (cell, i) in module.cells.iter().zip(0..) {
            if cell.follows_time {
                self.external.insert(Key::Cell(i));
            }
        }
        let is_edge = |kind: &FunctionKind| matches!(kind, FunctionKind::InputEdge { .. });
        self.written_from(self.functions_of(is_edge), &mut |this, stmt, keys| {
            if !this.is_clearing(stmt) {
                this.by_edges.extend(&keys);
            }
            this.external.extend(keys);
        });
        let takes = |kind: &FunctionKind| *kind == FunctionKind::TakeInterrupts;
        self.written_from(self.functions_of(takes), &mut |this, _, keys| {
            this.external.extend(keys);
        });
    }

    /// Reports the memory that each statement of these functions, and of those that they call, writes. What flags they
    /// set are events.
    fn written_from(
        &mut self,
        mut open: Vec<usize>,
        report: &mut dyn FnMut(&mut Self, &Stmt, Vec<Key>),
    ) {
        let module = self.module;
        let mut seen = BTreeSet::new();
        while let Some(i) = open.pop() {
            if seen.insert(i) {
                let body = &module.functions[i].body;
                open.extend(callees(body));
                statements(body, &mut |stmt| {
                    if let Stmt::Do(action) = stmt {
                        if let Action::SetFlag(flag, _) = action {
                            self.events.insert(flag.0);
                        }
                        let keys = self.written_between(action);
                        report(self, stmt, keys);
                    }
                });
            }
        }
    }

    /// Memory that partners at serial ports write, and operands of the instructions that take it.
    fn received(&self) -> BTreeSet<Key> {
        let module = self.module;
        let mut keys = BTreeSet::new();
        if !module.has_ports() {
            return keys;
        }
        keys.extend(self.of_ports());
        let called = called_functions(module);
        for (function, _) in module
            .functions
            .iter()
            .zip(called)
            .filter(|(_, called)| *called)
        {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(action @ Action::Call(call)) = stmt {
                    let needs = call.function.needs();
                    if needs.port || needs.names_port || needs.any_port || needs.can {
                        keys.extend(self.written_between(action));
                    }
                }
            });
        }
        keys
    }

    /// The memory written by an action that is executed between two scans, but for flags.
    fn written_between(&self, action: &Action) -> Vec<Key> {
        let mut keys = self.of_operands(action);
        match *action {
            Action::SetCell(cell, _) => keys.push(Key::Cell(cell.0)),
            Action::SetEntry(SetEntry { table, .. }) => {
                let length = self.module.tables[table].length;
                keys.extend((0..length).map(|i| Key::Entry(table.0, i)));
            }
            Action::Edge(ref edge) => keys.push(Key::Edge(edge.memory.0)),
            Action::Call(ref call) => keys.extend(self.of_call(call)),
            Action::Fetch(ref fetch) => {
                keys.push(Key::Cell(fetch.value.0));
                keys.extend(self.of_errors());
            }
            Action::Send(_) | Action::Fault { .. } => keys.extend(self.of_errors()),
            Action::Clear { latched } => keys.extend(self.cleared(latched)),
            _ => {}
        }
        keys
    }

    /// The memory that M8031 or M8032 clears.
    pub(super) fn cleared(&self, latched: bool) -> Vec<Key> {
        let keys = self.state.keys().copied();
        let is_it = |key: &Key| {
            device_of(*key).is_some_and(|(class, number)| {
                class != DeviceClass::X
                    && !rungc_models::runs::is_special(class, number)
                    && self.module.is_latched(class, number) == latched
            })
        };
        keys.filter(is_it).collect()
    }

    /// Adds the time of the scan to that of the minute.
    fn begin_minute(&mut self, raw: &[Lit]) {
        let before = self.state[&Key::Minute].clone();
        let start = self.aig.is(&before, 0);
        self.first_replay_assumptions.push(start);
        let width = before.len().max(raw.len()) + 1;
        let mut now = self
            .aig
            .add(&unsigned(&before, width), &unsigned(raw, width));
        let most = MINUTE_MS + i64::from(self.world.scan_ms.max(1));
        for minutes in (0..)
            .map(|k| MINUTE_MS << k)
            .take_while(|ms| *ms <= most)
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
        {
            let minutes = constant(minutes, width);
            let less = self.aig.below(&now, &minutes);
            let rest = self.aig.sub(&now, &minutes);
            now = self.aig.select(less, &now, &rest);
        }
        self.state.insert(Key::Minute, unsigned(&now, before.len()));
    }

    /// Makes the time of the scan.
    pub(super) fn begin_time(&mut self) {
        let most = self.world.scan_ms.max(1);
        let width_of = |most: u32| (u32::BITS - most.leading_zeros()).max(1) as usize;
        let mut digit =
            |digit: Digit, most: u32| self.inputs_named(width_of(most), |i| Input::Time(digit, i));
        let hundreds = digit(Digit::Hundreds, most / 100);
        let tens = digit(Digit::Tens, 9);
        let ones = digit(Digit::Ones, 9);
        for bits in [&tens, &ones] {
            let fits = self.aig.below(bits, &constant(10, 4));
            self.constraints.push(fits);
        }
        let width = width_of(most) + 8;
        let scaled = |this: &mut Self, bits: &[Lit], by: i64| {
            let wide = unsigned(bits, width);
            this.aig.mul(&wide, &constant(by, width))
        };
        let high = scaled(self, &hundreds, 100);
        let middle = scaled(self, &tens, 10);
        let below_hundred = self.aig.add(&middle, &unsigned(&ones, width));
        let raw = self.aig.add(&high, &below_hundred);
        let within = self.aig.below(&raw, &constant(i64::from(most) + 1, width));
        self.constraints.push(within);
        let first = self.state[&Key::First][0];
        // Tests of counterexamples have scans of at least a millisecond, the first one at 0.
        let some = self.aig.nonzero(&raw);
        let at_power_on = self.before[&Key::First][0];
        let positive = self.aig.mux(at_power_on, !some, some);
        self.replay_assumptions.push(positive);
        let shown = |this: &mut Self, bits: &[Lit]| -> Bits {
            bits.iter().map(|&bit| this.aig.and(bit, !first)).collect()
        };
        let before = self.state[&Key::Now].clone();
        let now = self.aig.add(&before, &unsigned(&raw, 32));
        let start = self.aig.is(&before, 0);
        self.first_replay_assumptions.push(start);
        self.state.insert(Key::Now, now);
        self.begin_minute(&raw);
        let many_tens = scaled(self, &hundreds, 10);
        let all_tens = self.aig.add(&many_tens, &unsigned(&tens, width));
        self.time = Some(Time {
            hundreds: shown(self, &hundreds),
            tens: shown(self, &all_tens),
            all: shown(self, &raw),
            below_hundred: unsigned(&shown(self, &below_hundred), 7),
            below_ten: shown(self, &ones),
        });
        self.keep_constant_scan(&raw, first);
    }

    /// Makes scans as long as the program asks for, but not the first one, before which there is none.
    fn keep_constant_scan(&mut self, elapsed: &[Lit], first: Lit) {
        let Some(devices) = self.module.model.constant_scan() else {
            return;
        };
        let relay = devices.relay.map(|relay| {
            let key = Key::Bit(DeviceClass::M, relay.number());
            self.before.get(&key).map_or(Lit::FALSE, |bits| bits[0])
        });
        let on = relay.unwrap_or(Lit::TRUE);
        let register = Key::Word(DeviceClass::D, devices.register.number());
        let Some(least) = self.before.get(&register).filter(|_| on != Lit::FALSE) else {
            return;
        };
        let width = elapsed.len().max(least.len()) + 1;
        let least = signed(least, width);
        let shorter = self.aig.less(&unsigned(elapsed, width), &least);
        let kept = !self.aig.all([shorter, on, !first]);
        self.constraints.push(kept);
        self.constant_scan = Some(kept);
    }

    /// Returns true if the program names a device, so that it is part of its memory.
    fn is_named(&self, class: DeviceClass, number: u32) -> bool {
        let (class, number) = self.module.model.canonical(class, number);
        let key = match class {
            DeviceClass::T => Key::Timer(number, TimerPart::Value),
            DeviceClass::C => Key::Counter(number, CounterPart::Value),
            DeviceClass::D | DeviceClass::R | DeviceClass::ER | DeviceClass::V | DeviceClass::Z => {
                Key::Word(class, number)
            }
            _ => Key::Bit(class, number),
        };
        self.state.contains_key(&key)
    }

    /// The numbers of a run of which one of the next `count` devices is named; all, if there are few.
    pub(super) fn relevant(
        &self,
        class: DeviceClass,
        (first, last): (u32, u32),
        count: u32,
    ) -> Vec<u32> {
        if last - first < REACH {
            return (first..=last).collect();
        }
        // The first named device from a number on: the numbers before it need not be looked at again.
        let mut named = first;
        let is_relevant = |number: &u32| {
            let end = number.saturating_add(count);
            named = named.max(*number);
            while named < end && !self.is_named(class, named) {
                named += 1;
            }
            named < end
        };
        (first..=last).filter(is_relevant).collect()
    }

    /// Places that an index leads to, of `count` devices each; `None` if too many of them are named.
    pub(super) fn candidates(
        &mut self,
        place: Place,
        index: &[Lit],
        count: u32,
    ) -> Option<Candidates> {
        if let Some(index) = crate::bits::known(index) {
            let number = u32::try_from(i64::from(place.number) + index);
            let numbers = number.map(|number| (Lit::TRUE, number));
            return Some(Candidates {
                numbers: numbers.into_iter().collect(),
                are_all: true,
            });
        }
        let used = Footprint {
            place,
            count: Some(1),
            in_array: false,
            writes: false,
        };
        let runs = used.reach(self.module.model, &self.module.exprs);
        let runs = match place.index.map(|index| self.module.expr(index)) {
            Some(Expr::Stride(..)) => return None,
            _ => runs,
        };
        let size: u32 = runs.iter().map(|(first, last)| last - first + 1).sum();
        let relevant = runs
            .into_iter()
            .flat_map(|run| self.relevant(place.class, run, count));
        let numbers: Vec<u32> = relevant.collect();
        let are_all = numbers.len() == size as usize;
        if !are_all && numbers.len() > MOST || size > REACH && are_all {
            return None;
        }
        let found = numbers.into_iter().map(|number| {
            let by = i64::from(number) - i64::from(place.number);
            (self.aig.is(index, by), number)
        });
        Some(Candidates {
            numbers: found.collect(),
            are_all,
        })
    }
}
