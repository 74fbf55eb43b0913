//! Statements as logic.

use super::{Encoder, Key, NODES, STATEMENTS};
use crate::aig::Lit;
use crate::bits::{Bits, constant, known, signed};
use rungc_ir::node::{
    Access, AccessKind, Action, Block, Body, Branch, Edge, EdgeId, Expr, ExprId, IndexedCoil, Part,
    Place, Repeat, SetEntry, Stmt, TempId,
};
use rungc_models::runs::is_counter32;
use rungc_rt::special::M_KEEP_IN_STOP;
use rungc_rt::{EdgeKind, TimerKind};
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;

/// Limit for unrolling a loop whose count is not constant, and for following a jump back.
const ROUNDS: u32 = 300;

impl Encoder<'_> {
    /// Executes a function under a condition.
    pub(super) fn function(&mut self, number: usize, guard: Lit) {
        let module = self.module;
        if let Some(function) = module.functions.get(number) {
            let jumps = std::mem::take(&mut self.jumps);
            self.run(&function.body, guard);
            self.jumps = jumps;
        }
    }

    /// Executes a body; under which condition its end is reached.
    fn run(&mut self, body: &Body, mut guard: Lit) -> Lit {
        for (n, stmt) in body.iter().enumerate() {
            if guard == Lit::FALSE {
                self.note_dead(&body[n..]);
                break;
            }
            self.statements += 1;
            if self.statements > STATEMENTS {
                return self.give_up(guard, "loops of very many steps");
            }
            if self.aig.nodes().len() > NODES {
                return self.give_up(guard, "the rest of a scan whose logic is too large");
            }
            self.forget_values();
            guard = self.step(stmt, guard);
        }
        guard
    }

    /// The rest of the scan is not modelled where this condition holds.
    fn give_up(&mut self, guard: Lit, what: &str) -> Lit {
        let gap = self.gap(what);
        self.lost_gap.get_or_insert(gap);
        self.lost = self.aig.or(self.lost, guard);
        Lit::FALSE
    }

    /// Gives a temporary its value.
    pub(super) fn assign(&mut self, temp: TempId, value: Bits, guard: Lit) {
        let value = match self.temps[temp].take() {
            Some(old) => self.aig.select(guard, &value, &old),
            None => value,
        };
        self.temps[temp] = Some(value);
    }

    /// Returns true if a statement writes nothing but zeros.
    pub(super) fn is_clearing(&self, stmt: &Stmt) -> bool {
        let zero = |id: ExprId| {
            matches!(
                self.module.expr(id),
                Expr::Bit(false) | Expr::I16(0) | Expr::I32(0)
            )
        };
        match stmt {
            Stmt::Do(Action::Write(_, value) | Action::Block(Block::Fill { value, .. })) => {
                zero(*value)
            }
            Stmt::Do(Action::Reset { .. } | Action::Clear { .. }) => true,
            _ => false,
        }
    }

    /// Executes a statement; under which condition the next one is reached.
    fn step(&mut self, stmt: &Stmt, guard: Lit) -> Lit {
        // Memory that is off in every scan cannot be set to something else.
        self.clears = guard != Lit::TRUE && self.is_clearing(stmt);
        if let Stmt::Network(network) = stmt {
            self.network = Some(*network);
        }
        self.note_stmt(stmt, guard);
        match stmt {
            Stmt::Network(_) => guard,
            Stmt::Do(action) => {
                self.action(action, guard);
                guard
            }
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => {
                let cond = self.on(*cond);
                let yes = self.aig.and(guard, cond);
                let no = self.aig.and(guard, !cond);
                let (then, otherwise) = (self.run(then, yes), self.run(otherwise, no));
                if (then, otherwise) == (yes, no) {
                    return guard;
                }
                self.aig.or(then, otherwise)
            }
            Stmt::For { count, body } => {
                let count = self.eval(*count);
                self.repeat(&count, None, body, guard)
            }
            Stmt::Repeat(Repeat {
                count,
                iteration,
                body,
                ..
            }) => self.repeat(
                &constant((*count).into(), 33),
                Some(*iteration),
                body,
                guard,
            ),
            // What it leaves out has no effect.
            Stmt::Steps(steps) => self.run(&steps.body, guard),
            Stmt::CallSub(function) => {
                self.function(*function as usize, guard);
                guard
            }
            Stmt::Parts(parts) => self.parts(parts, guard),
            Stmt::Goto(label) => {
                let known = self
                    .jumps
                    .iter_mut()
                    .rev()
                    .find(|jumps| jumps.contains_key(label));
                if let Some(target) = known.and_then(|jumps| jumps.get_mut(label)) {
                    *target = self.aig.or(*target, guard);
                }
                Lit::FALSE
            }
            Stmt::Watch { steps, .. } => self.watch(*steps, guard),
            // The caller continues.
            Stmt::Return => Lit::FALSE,
        }
    }

    /// Executes an action.
    fn action(&mut self, action: &Action, guard: Lit) {
        match action {
            &Action::Let(temp, value) => {
                let value = self.eval(value);
                self.assign(temp, value, guard);
            }
            Action::Edge(edge) => self.edge(edge, guard),
            &Action::SetFlag(flag, value) => {
                let value = self.eval(value);
                self.store(Key::Flag(flag.0), &value, guard);
            }
            &Action::SetCell(cell, value) => {
                let value = self.eval(value);
                self.store(Key::Cell(cell.0), &value, guard);
            }
            &Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => {
                let (index, value) = (self.eval(index), self.eval(value));
                for i in 0..self.module.tables[table].length {
                    let here = self.aig.is(&index, i.into());
                    let here = self.aig.and(guard, here);
                    self.store(Key::Entry(table.0, i), &value, here);
                }
            }
            &Action::Write(access, value) => self.write(access, value, guard),
            Action::Block(block) => self.block(block, guard),
            Action::Timer(coil) => {
                let (drive, preset) = (self.on(coil.drive), self.eval(coil.preset));
                self.timer(coil.number, coil.kind, drive, &preset, guard);
            }
            Action::TimerAt(coil) => self.coil_at(coil, guard),
            &Action::TimerGoesOn { number, kind } => self.timer_goes_on(number, kind, guard),
            Action::Counter16(coil) => {
                let (drive, preset) = (self.on(coil.drive), self.eval(coil.preset));
                self.counter16(coil.number, drive, &preset, guard);
            }
            Action::Counter16At(coil) => self.coil_at(coil, guard),
            Action::Counter32(coil) => {
                let (drive, down) = (self.on(coil.drive), self.on(coil.down));
                let preset = self.eval(coil.preset);
                self.counter32(coil.number, drive, (down, &preset), guard);
            }
            Action::Count(count) => {
                let (down, preset) = (self.on(count.down), self.eval(count.preset));
                self.count(count.number, down, &preset, guard);
            }
            &Action::Reset { place, holds } => self.reset(place, holds, guard),
            Action::Call(call) => self.call(action, call, guard),
            Action::Fetch(fetch) => self.fetch(fetch, guard),
            Action::Send(send) => self.send(action, send.step, guard),
            &Action::Fault { step, .. } => self.fault(action, step, guard),
            // That WDT keeps the watchdog from ending a scan is not known here.
            Action::RestartWatchdog => {}
            Action::Stop => self.stop(guard),
            &Action::Clear { latched } => self.clear(latched, guard),
        }
    }

    /// The watchdog may end a scan that has repeated very many steps.
    fn watch(&mut self, steps: u32, guard: Lit) -> Lit {
        self.watched += u64::from(steps);
        if self.watched <= self.watch_limit {
            return guard;
        }
        let fresh = self.fresh(1, "when the watchdog ends a scan")[0];
        let trips = self.aig.and(guard, fresh);
        self.store(Key::Running, &[Lit::FALSE], trips);
        self.aig.and(guard, !fresh)
    }

    fn repeat(&mut self, count: &[Lit], number: Option<TempId>, body: &Body, guard: Lit) -> Lit {
        let most = known(count).map_or(ROUNDS, |count| count.clamp(1, i64::from(u32::MAX)) as u32);
        let (mut inside, mut after) = (guard, Lit::FALSE);
        for round in 0..most {
            if round > 0 {
                // A count of less than 1 is 1.
                let more = self.aig.less(&constant(round.into(), count.len()), count);
                let ends = self.aig.and(inside, !more);
                after = self.aig.or(after, ends);
                inside = self.aig.and(inside, more);
            }
            if inside == Lit::FALSE {
                return after;
            }
            if let Some(number) = number {
                self.temps[number] = Some(constant(round.into(), 32));
            }
            inside = self.run(body, inside);
        }
        if known(count).is_some() {
            return self.aig.or(after, inside);
        }
        let more = self.aig.less(&constant(most.into(), count.len()), count);
        let lost = self.aig.and(inside, more);
        self.give_up(lost, "loops of very many steps");
        let ends = self.aig.and(inside, !more);
        self.aig.or(after, ends)
    }

    fn parts(&mut self, parts: &[Part], guard: Lit) -> Lit {
        let labels = parts.iter().filter_map(|part| part.label);
        let jumps: FxHashMap<_, _> = labels.map(|label| (label, Lit::FALSE)).collect();
        self.jumps.push(jumps);
        let (mut falls, mut round) = (guard, 0);
        let mut leaves = Lit::FALSE;
        loop {
            for part in parts {
                let waiting = part
                    .label
                    .and_then(|label| self.jumps.last_mut()?.get_mut(&label));
                let jumped =
                    waiting.map_or(Lit::FALSE, |target| std::mem::replace(target, Lit::FALSE));
                falls = self.aig.or(falls, jumped);
                if falls != Lit::FALSE {
                    falls = self.run(&part.body, falls);
                }
            }
            leaves = self.aig.or(leaves, falls);
            falls = Lit::FALSE;
            round += 1;
            let waiting = self
                .jumps
                .last()
                .into_iter()
                .flat_map(|jumps| jumps.values());
            let waiting: Vec<Lit> = waiting.copied().collect();
            let again = self.aig.any(waiting);
            if again == Lit::FALSE {
                break;
            }
            if round == ROUNDS {
                self.give_up(again, "jumps back that are taken very often");
                break;
            }
        }
        self.jumps.pop();
        leaves
    }

    fn edge(&mut self, edge: &Edge, guard: Lit) {
        let further = edge
            .index
            .map_or(0, |index| known(&self.eval(index)).unwrap_or(0));
        let memory = Key::Edge(EdgeId(edge.memory.0 + further as u32).0);
        let now = self.on(edge.input);
        let before = self.load(memory)[0];
        let out = match edge.kind {
            EdgeKind::Rising => self.aig.and(now, !before),
            EdgeKind::Falling => self.aig.and(before, !now),
        };
        self.store(memory, &[now], guard);
        self.assign(edge.out, vec![out], guard);
    }

    fn write(&mut self, Access { place, kind }: Access, value: ExprId, guard: Lit) {
        let value = self.eval(value);
        let Some(index) = place.index else {
            return self.write_at(kind, (place.class, place.number), &value, guard);
        };
        let index = self.eval(index);
        match self.candidates(place, &index, Access { place, kind }.extent()) {
            Some(candidates) => {
                for (here, number) in candidates.numbers {
                    let here = self.aig.and(guard, here);
                    self.write_at(kind, (place.class, number), &value, here);
                }
            }
            None => self.write_anywhere(&Action::Write(Access { place, kind }, ExprId(0)), guard),
        }
    }

    /// A write that an index may lead to many devices.
    pub(super) fn write_anywhere(&mut self, action: &Action, guard: Lit) {
        for key in self.of_operands(action) {
            if let Some(width) = self.state.get(&key).map(Vec::len) {
                let value = self.fresh_by_index(width);
                self.store(key, &value, guard);
            }
        }
    }

    pub(super) fn write_at(
        &mut self,
        kind: AccessKind,
        (class, number): (DeviceClass, u32),
        value: &[Lit],
        guard: Lit,
    ) {
        match kind {
            AccessKind::Bit => self.write_bit(class, number, value[0], guard),
            AccessKind::WordBit(bit) => {
                let mut word = self.read_word(class, number);
                word[usize::from(bit & 15)] = value[0];
                self.write_word(class, number, &word, guard);
            }
            AccessKind::Word => self.write_word(class, number, value, guard),
            AccessKind::Pair | AccessKind::Float if is_counter32(class, number) => {
                if let Some(key) = self.word_key(class, number) {
                    self.store(key, value, guard);
                }
            }
            AccessKind::Pair | AccessKind::Float => {
                let high = Place::fixed(class, number).high_word(self.module.model);
                self.write_word(class, number, &value[..16], guard);
                self.write_word(high.class, high.number, &value[16..], guard);
            }
            AccessKind::Nibbles { digits, .. } => {
                let bits = value.iter().take(4 * usize::from(digits));
                for (number, &bit) in (number..).zip(bits) {
                    self.write_bit(class, number, bit, guard);
                }
            }
        }
    }

    fn write_bit(&mut self, class: DeviceClass, number: u32, on: Lit, guard: Lit) {
        let key = match class {
            DeviceClass::T => Key::Timer(number, super::TimerPart::Done),
            DeviceClass::C => Key::Counter(number, super::CounterPart::Done),
            DeviceClass::Y | DeviceClass::M | DeviceClass::S => {
                self.note_bit((class, number), on, guard);
                Key::Bit(class, number)
            }
            _ => Key::Bit(class, number),
        };
        self.store(key, &[on], guard);
    }

    fn write_word(&mut self, class: DeviceClass, number: u32, value: &[Lit], guard: Lit) {
        if let Some(key) = self.word_key(class, number) {
            let width = if is_counter32(class, number) { 32 } else { 16 };
            self.store(key, &signed(value, width), guard);
        }
    }

    /// OUT T or OUT C with an index.
    fn coil_at(&mut self, coil: &IndexedCoil, guard: Lit) {
        let (drive, preset) = (self.on(coil.drive), self.eval(coil.preset));
        let Some(index) = coil.place.index else {
            return;
        };
        let index = self.eval(index);
        let Some(candidates) = self.candidates(coil.place, &index, 1) else {
            return self.write_anywhere(&Action::TimerAt(*coil), guard);
        };
        for (here, number) in candidates.numbers {
            let here = self.aig.and(guard, here);
            if coil.place.class == DeviceClass::C {
                if !is_counter32(DeviceClass::C, number) {
                    self.counter16(number, drive, &preset, here);
                }
            } else if let Some(kind) = self.module.model.timer(number) {
                let kind = TimerKind {
                    shared: true,
                    ..kind
                };
                self.timer(number, kind, drive, &preset, here);
            }
        }
    }

    fn reset(&mut self, place: Place, holds: bool, guard: Lit) {
        let Some(index) = place.index else {
            let keys = self.keys(place.class, place.number);
            self.reset_timing(&keys, guard);
            if holds {
                self.clears = false;
                let coil = Key::Counter(place.number, super::CounterPart::Coil);
                self.store(coil, &[Lit::TRUE], guard);
            }
            return;
        };
        let index = self.eval(index);
        let Some(candidates) = self.candidates(place, &index, 1) else {
            return self.write_anywhere(&Action::Reset { place, holds }, guard);
        };
        for (here, number) in candidates.numbers {
            let here = self.aig.and(guard, here);
            let keys = self.keys(place.class, number);
            self.reset_timing(&keys, here);
        }
    }

    fn clear(&mut self, latched: bool, guard: Lit) {
        for key in self.cleared(latched) {
            let zero = constant(0, self.load(key).len());
            self.store(key, &zero, guard);
        }
    }

    /// The PLC stops after this scan. STOP clears the devices that are not latched, unless M8033 is on.
    fn stop(&mut self, guard: Lit) {
        self.store(Key::Running, &[Lit::FALSE], guard);
        let keeps = Key::Bit(DeviceClass::M, M_KEEP_IN_STOP.number());
        let keeps = self.state.get(&keeps).map_or(Lit::FALSE, |bits| bits[0]);
        let stopped = self.aig.and(guard, !keeps);
        self.clears = true;
        self.clear(false, stopped);
    }
}
