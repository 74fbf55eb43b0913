//! Execution of statements, as [`rungc_ir::node`] specifies it.

use crate::eval::{Value, float, int};
use crate::machine::Machine;
use rungc_ir::node::{
    Access, AccessKind, Action, Arg, Block, Branch, Call, Count, Counter32Coil, Edge, EdgeId,
    ExprId, Fetch, IndexedCoil, LabelId, Part, Place, Repeat, Send, SetEntry, Steps, Stmt, TempId,
    TimerCoil,
};
use rungc_models::runs::rt_class;
use rungc_rt::{
    Class, Cx, EdgeKind, Fault, Hal, Operand, Plc, Site, Stop, TimerKind, conclude, fetch, report,
    send,
};
use rungc_syntax::DeviceClass;

/// Completion of a body.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Flow {
    /// At its end.
    Next,
    /// By [`Stmt::Return`].
    Return,
    /// By a jump that none of the [`Stmt::Parts`] in it takes.
    Goto(LabelId),
}

/// Site of a driven instruction, in its 16-bit or 32-bit form.
fn site_of_form(step: u32, wide: bool) -> Site {
    Site {
        wide,
        ..Site::at(step)
    }
}

/// The places from one on.
fn places(first: Place, count: u32) -> impl Iterator<Item = Place> {
    let numbers = first.number..first.number + count;
    numbers.map(move |number| Place { number, ..first })
}

/// Statements.
impl<'m> Machine<'m> {
    /// Executes a body.
    pub(crate) fn run(&mut self, body: &'m [Stmt], hal: &mut dyn Hal) -> Flow {
        if self.observer.is_some() {
            return self.run_observed(body, hal);
        }
        for stmt in body {
            let flow = self.step(stmt, hal);
            if flow != Flow::Next {
                return flow;
            }
        }
        Flow::Next
    }

    fn run_observed(&mut self, body: &'m [Stmt], hal: &mut dyn Hal) -> Flow {
        for stmt in body {
            if let Some(mut observer) = self.observer.take() {
                observer.intervene(self, stmt);
                observer.before(self, stmt);
                self.observer = Some(observer);
            }
            let flow = self.step(stmt, hal);
            if flow != Flow::Next {
                return flow;
            }
        }
        Flow::Next
    }

    /// Executes a statement. Anything longer than a line is in a separate method.
    fn step(&mut self, stmt: &'m Stmt, hal: &mut dyn Hal) -> Flow {
        match stmt {
            Stmt::Network(_) => {}
            Stmt::Do(action) => self.action(action, hal),
            Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }) => {
                let body = if self.on(*cond) { then } else { otherwise };
                return self.run(body, hal);
            }
            Stmt::For { count, body } => {
                let count = int(self.eval(*count)).max(1);
                return self.run_loop(count as u32, None, body, hal);
            }
            Stmt::Repeat(Repeat {
                count,
                iteration,
                body,
                ..
            }) => return self.run_loop(*count, Some(*iteration), body, hal),
            Stmt::Steps(steps) => {
                if self.any_active(steps) {
                    return self.run(&steps.body, hal);
                }
            }
            Stmt::CallSub(n) => self.call_sub(*n, hal),
            Stmt::Return => return Flow::Return,
            Stmt::Parts(parts) => return self.run_parts(parts, hal),
            Stmt::Goto(label) => return Flow::Goto(*label),
            Stmt::Watch { steps, at } => {
                if self.out_of_time(*steps, *at) {
                    return Flow::Return;
                }
            }
        }
        Flow::Next
    }

    /// Executes an action. Anything longer than a line is in a separate method.
    fn action(&mut self, action: &'m Action, hal: &mut dyn Hal) {
        match action {
            &Action::Let(temp, value) => self.temps[temp] = self.eval(value),
            Action::Edge(edge) => self.edge(edge),
            &Action::SetFlag(flag, value) => self.flags[flag] = self.on(value),
            &Action::SetCell(cell, value) => self.cells[cell] = int(self.eval(value)),
            &Action::SetEntry(SetEntry {
                table,
                index,
                value,
            }) => {
                let index = int(self.eval(index));
                self.tables[table][index as usize] = int(self.eval(value));
            }
            &Action::Write(access, value) => self.write(access, value),
            Action::Timer(coil) => self.timer(coil),
            Action::TimerAt(coil) => self.timer_at(coil),
            &Action::TimerGoesOn { number, kind } => {
                if let Some(timer) = self.devices.timer(number) {
                    timer.go_on(kind, &self.sys);
                }
            }
            Action::Counter16(coil) => self.counter16(coil.number, coil.drive, coil.preset),
            Action::Counter16At(coil) => {
                if let Some((_, number)) = self.device(coil.place) {
                    self.counter16(number, coil.drive, coil.preset);
                }
            }
            Action::Counter32(coil) => self.counter32(coil),
            Action::Count(count) => self.count(count),
            &Action::Reset { place, holds } => {
                if let Some((class, number)) = self.device(place) {
                    let _ = self.reset(class, number);
                    if holds {
                        self.devices.hold_counter(number);
                    }
                }
            }
            Action::Block(block) => self.block(block),
            Action::Call(call) => self.call(call, hal),
            Action::Fetch(fetch) => self.fetch(fetch, hal),
            Action::Send(send) => self.send(send, hal),
            Action::Fault { code, step } => report(self, Fault(*code), *step),
            Action::RestartWatchdog => self.wdt(),
            Action::Stop => {
                self.last_error.stop = Stop::Program;
                rungc_rt::Program::set_running(self, false);
            }
            Action::Clear { latched } => self.devices.clear(*latched),
        }
    }

    /// Copies or fills a run of devices.
    fn block(&mut self, block: &Block) {
        let (to, count) = block.written();
        let count = match block.length() {
            Some(length) => int(self.eval(length)).clamp(0, count as i32) as u32,
            None => count,
        };
        let Some(to) = self.settled(to) else {
            return;
        };
        let values: Vec<Value> = match *block {
            Block::Copy { from, .. } => {
                let from = self.settled(from);
                let read = from.map(|from| places(from, count).map(|p| self.device_value(p)));
                read.into_iter().flatten().collect()
            }
            Block::Fill { value, .. } => vec![self.eval(value); count as usize],
        };
        for (to, value) in places(to, count).zip(values) {
            if let Value::Bit(on) = value {
                self.write_bit(to, on);
            } else {
                self.write_word(to, int(value) as i16);
            }
        }
    }

    /// A place without an index, which is added; `None` if that makes its number negative.
    fn settled(&self, place: Place) -> Option<Place> {
        let number = self.device(place)?.1;
        Some(Place::fixed(place.class, number))
    }

    /// The state of a bit device, or the value of a word device.
    fn device_value(&self, place: Place) -> Value {
        use DeviceClass::{M, S, X, Y};
        if matches!(place.class, X | Y | M | S) {
            Value::Bit(self.read_bit(place))
        } else {
            Value::I16(self.read_word(place))
        }
    }

    /// Executes a body `count` times, with the number of the iteration in `iteration`.
    fn run_loop(
        &mut self,
        count: u32,
        iteration: Option<TempId>,
        body: &'m [Stmt],
        hal: &mut dyn Hal,
    ) -> Flow {
        for n in 0..count {
            if let Some(iteration) = iteration {
                self.temps[iteration] = Value::I32(n as i32);
            }
            let flow = self.run(body, hal);
            if flow != Flow::Next {
                return flow;
            }
        }
        Flow::Next
    }

    fn run_parts(&mut self, parts: &'m [Part], hal: &mut dyn Hal) -> Flow {
        let mut next = 0;
        while let Some(part) = parts.get(next) {
            next = match self.run(&part.body, hal) {
                Flow::Next => next + 1,
                Flow::Goto(label) => match parts.iter().position(|p| p.label == Some(label)) {
                    Some(target) => target,
                    None => return Flow::Goto(label),
                },
                flow => return flow,
            };
        }
        Flow::Next
    }

    fn call_sub(&mut self, function: u32, hal: &mut dyn Hal) {
        let module = self.module;
        if let Some(function) = module.functions.get(function as usize) {
            self.run(&function.body, hal);
        }
    }

    fn any_active(&self, steps: &Steps) -> bool {
        let memory = steps.memory.0 as usize;
        let memories = self.edges.raw.get(memory..memory + steps.memories as usize);
        memories.is_some_and(|memories| memories.contains(&true))
            || self.devices.any_state(steps.first, steps.states)
    }

    fn edge(&mut self, edge: &Edge) {
        let further = edge.index.map_or(0, |index| int(self.eval(index)) as u32);
        let now = self.on(edge.input);
        let memory = &mut self.edges[EdgeId(edge.memory.0 + further)];
        let before = std::mem::replace(memory, now);
        self.temps[edge.out] = Value::Bit(match edge.kind {
            EdgeKind::Rising => now && !before,
            EdgeKind::Falling => before && !now,
        });
    }

    /// OUT T with an index.
    fn timer_at(&mut self, coil: &IndexedCoil) {
        if let Some((_, number)) = self.device(coil.place)
            && let Some(kind) = self.module.model.timer(number)
        {
            self.timer(&TimerCoil {
                number,
                kind: TimerKind {
                    shared: true,
                    ..kind
                },
                drive: coil.drive,
                preset: coil.preset,
            });
        }
    }

    fn timer(&mut self, coil: &TimerCoil) {
        let (drive, preset) = (self.on(coil.drive), int(self.eval(coil.preset)) as i16);
        if let Some(timer) = self.devices.timer(coil.number) {
            timer.run(coil.kind, drive, preset, &self.sys);
        }
    }

    fn counter16(&mut self, number: u32, drive: ExprId, preset: ExprId) {
        let (drive, preset) = (self.on(drive), int(self.eval(preset)) as i16);
        if let Some(counter) = self.devices.counter16(number) {
            counter.run(drive, preset);
        }
    }

    fn counter32(&mut self, coil: &Counter32Coil) {
        let (drive, down) = (self.on(coil.drive), self.on(coil.down));
        let preset = int(self.eval(coil.preset));
        if let Some(counter) = self.devices.counter32_mut(coil.number) {
            counter.run(drive, down, preset);
        }
    }

    fn count(&mut self, count: &Count) {
        let (down, preset) = (self.on(count.down), int(self.eval(count.preset)));
        if let Some(counter) = self.devices.counter32_mut(count.number) {
            counter.count(down, preset);
        }
    }

    fn write(&mut self, Access { place, kind }: Access, value: ExprId) {
        match kind {
            AccessKind::Bit => self.write_bit(place, self.on(value)),
            AccessKind::WordBit(bit) => self.write_word_bit(place, bit, self.on(value)),
            AccessKind::Word => self.write_word(place, int(self.eval(value)) as i16),
            AccessKind::Pair => self.write_pair(place, int(self.eval(value))),
            AccessKind::Float => {
                self.write_pair(place, float(self.eval(value)).to_bits() as i32);
            }
            AccessKind::Nibbles { digits, .. } => {
                self.write_nibbles(place, digits, int(self.eval(value)));
            }
        }
    }

    fn write_bit(&mut self, place: Place, on: bool) {
        if let Some((class, number)) = self.device(place) {
            let _ = self.set_bit(class, number, on);
        }
    }

    fn write_word(&mut self, place: Place, value: i16) {
        let Some((class, number)) = self.device(place) else {
            return;
        };
        if class == Class::C && self.set_counter32(number, value.into()).is_some() {
            return;
        }
        let _ = self.set_word(class, number, value);
    }

    fn write_word_bit(&mut self, place: Place, bit: u8, on: bool) {
        let (mask, word) = (1i16 << (bit & 15), self.read_word(place));
        self.write_word(place, if on { word | mask } else { word & !mask });
    }

    fn write_pair(&mut self, place: Place, value: i32) {
        let Some((class, number)) = self.device(place) else {
            return;
        };
        if class == Class::C && self.set_counter32(number, value).is_some() {
            return;
        }
        let (high_class, high) = self.high_word(class, number);
        let _ = self.set_word(class, number, value as i16);
        let _ = self.set_word(high_class, high, (value >> 16) as i16);
    }

    fn write_nibbles(&mut self, place: Place, digits: u8, value: i32) {
        if let Some((class, first)) = self.device(place) {
            for i in 0..4 * u32::from(digits.min(8)) {
                let _ = self.set_bit(class, first.saturating_add(i), value >> i & 1 == 1);
            }
        }
    }

    fn call(&mut self, call: &Call, hal: &mut dyn Hal) {
        let site = Site {
            step: call.step,
            slot: call.slot,
            wide: call.wide,
            drive: call.drive.is_none_or(|drive| self.on(drive)),
            signal: call.signal,
            period_ms: call.period_ms,
        };
        let mut ops = std::mem::take(&mut self.operands);
        ops.clear();
        ops.extend(call.args.iter().map(|arg| self.operand(arg)));
        let done = call.function.call(&mut Cx::new(self, hal, &ops, site));
        self.operands = ops;
        conclude(done, site, self);
    }

    fn fetch(&mut self, operand: &Fetch, hal: &mut dyn Hal) {
        let (site, from) = (
            site_of_form(operand.step, operand.wide),
            self.operand(&operand.from),
        );
        let fetched = fetch(site, from, self, hal);
        if let Some(fetched) = fetched {
            self.cells[operand.value] = fetched;
        }
        self.temps[operand.there] = Value::Bit(fetched.is_some());
    }

    fn send(&mut self, operand: &Send, hal: &mut dyn Hal) {
        let (to, value) = (self.operand(&operand.to), int(self.eval(operand.value)));
        send(
            site_of_form(operand.step, operand.wide),
            to,
            value,
            self,
            hal,
        );
    }

    /// An operand with its index added.
    fn operand(&self, arg: &Arg) -> Operand {
        let indexed = |place: Place| {
            let index = place.index.map_or(0, |index| int(self.eval(index)));
            (place.number as i32).saturating_add(index)
        };
        // Classes without storage are operands of control flow only, never of a call.
        let class = |place: Place| rt_class(place.class).unwrap_or(Class::D);
        match *arg {
            Arg::Const { value, index, wide } => {
                let index = index.map_or(0, |index| int(self.eval(index)));
                let sum = value.wrapping_add(index);
                Operand::constant(match (wide, index) {
                    (_, 0) | (true, _) => sum,
                    (false, _) => (sum as i16).into(),
                })
            }
            Arg::Float(value) => Operand::float(value),
            Arg::Device { place, .. } => Operand::device(class(place), indexed(place)),
            Arg::Nibbles { place, digits, .. } => {
                Operand::nibbles(digits, class(place), indexed(place))
            }
            Arg::WordBit { place, bit, .. } => Operand::word_bit(class(place), indexed(place), bit),
            Arg::Text(index) => Operand::text(index as i32),
            Arg::Buffer {
                module,
                address,
                index,
            } => {
                let index = index.map_or(0, |index| int(self.eval(index)));
                Operand::buffer(module, (address as i32).wrapping_add(index))
            }
        }
    }
}
