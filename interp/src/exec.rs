//! What expressions and statements do, as [`rungc_ir::node`] specifies.

use crate::devices::rt_class;
use crate::logic::{Input, Join, Strided};
use crate::machine::Machine;
use rungc_ir::node::{Arg, Expr, ExprId, FloatOp, LabelId, Part, Place, Stmt, SysValue, UnOp};
use rungc_rt::{
    Class, Cx, EdgeKind, Fault, Hal, Operand, Plc, RtFn, Site, Stop, TimerKind, fetch, report,
    send, word,
};

/// Value of an expression or temporary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Value {
    Bit(bool),
    I16(i16),
    I32(i32),
    F32(f32),
}

/// How a body ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Flow {
    /// At its end.
    Next,
    /// By [`Stmt::Return`].
    Return,
    /// By a jump that none of its own [`Stmt::Parts`] takes.
    Goto(LabelId),
}

/// Where a driven instruction stands, in its 16-bit or 32-bit form.
fn site_of_form(step: u32, wide: bool) -> Site {
    Site {
        wide,
        ..Site::at(step)
    }
}

/// Sign-extends to 32 bits; the width of an `I16` is restored when the result is stored.
fn int(value: Value) -> i32 {
    match value {
        Value::I16(v) => v.into(),
        Value::I32(v) => v,
        Value::Bit(v) => v.into(),
        Value::F32(_) => 0,
    }
}

fn float(value: Value) -> f32 {
    match value {
        Value::F32(v) => v,
        _ => 0.0,
    }
}

/// A function of one value.
fn function(op: UnOp, value: Value) -> Value {
    match (op, value) {
        (UnOp::SwapBytes, Value::I16(v)) => Value::I16(word::swap16(v)),
        (UnOp::SwapBytes, v) => Value::I32(word::swap32(int(v))),
        (UnOp::CountOnes, Value::I16(v)) => Value::I16(word::ones16(v)),
        (UnOp::CountOnes, v) => Value::I32(word::ones32(int(v))),
        (UnOp::ToBcd, Value::I16(v)) => Value::I16(word::to_bcd16(v)),
        (UnOp::ToBcd, v) => Value::I32(word::to_bcd32(int(v))),
        (UnOp::FromBcd, Value::I16(v)) => Value::I16(word::from_bcd16(v)),
        (UnOp::FromBcd, v) => Value::I32(word::from_bcd32(int(v))),
        (UnOp::IsBcd, Value::I16(v)) => Value::Bit(word::is_bcd16(v)),
        (UnOp::IsBcd, v) => Value::Bit(word::is_bcd32(int(v))),
        (UnOp::Root, v) => Value::I32(word::root(int(v))),
        (UnOp::ToFloat, v) => Value::F32(word::to_float(int(v))),
        (UnOp::Truncate, v) => Value::I32(word::truncate(float(v))),
        (UnOp::IsFinite, v) => Value::Bit(word::is_finite(float(v))),
        (UnOp::Negate, v) => Value::F32(word::negate(float(v))),
    }
}

/// Expressions. A device that does not exist reads as 0 and swallows writes; a validated module reaches none.
impl<'m> Machine<'m> {
    pub(crate) fn eval(&self, id: ExprId) -> Value {
        match *self.module.expr(id) {
            Expr::Bit(v) => Value::Bit(v),
            Expr::I16(v) => Value::I16(v),
            Expr::I32(v) => Value::I32(v),
            Expr::F32(v) => Value::F32(v),
            Expr::Temp(temp) => self.temps[temp.0 as usize],
            Expr::ReadBit(place) => Value::Bit(self.read_bit(place)),
            Expr::ReadWordBit(place, bit) => {
                Value::Bit(self.read_word(place) as u16 >> (bit & 15) & 1 == 1)
            }
            Expr::ReadWord(place) => Value::I16(self.read_word(place)),
            Expr::ReadPair(place) => Value::I32(self.read_pair(place)),
            Expr::ReadFloat(place) => Value::F32(f32::from_bits(self.read_pair(place) as u32)),
            Expr::ReadNibbles {
                place,
                digits,
                wide,
            } => {
                let value = self.read_nibbles(place, digits);
                if wide || digits > 4 {
                    Value::I32(value)
                } else {
                    Value::I16(value as i16)
                }
            }
            Expr::Cell(cell) => Value::I32(self.cells[cell.0 as usize]),
            Expr::Stride(round, by) => {
                Value::I32(int(self.temps[round.0 as usize]).wrapping_mul(by as i32))
            }
            Expr::Entry(table, index) => {
                let index = int(self.eval(index));
                Value::I32(self.tables[table.0 as usize][index as usize])
            }
            Expr::Flag(flag) => Value::Bit(self.flags[flag.0 as usize]),
            Expr::Sys(SysValue::Running) => Value::Bit(self.sys.running),
            Expr::Sys(SysValue::FirstScan) => Value::Bit(self.sys.first_scan),
            Expr::Sys(SysValue::NowMs) => Value::I32(self.sys.now_ms as i32),
            Expr::Sys(SysValue::Scan100us) => Value::I32((self.sys.scan_us / 100) as i32),
            Expr::Not(_) | Expr::And(..) | Expr::Or(..) => Value::Bit(self.on(id)),
            Expr::Cmp(op, a, b) => Value::Bit(match (self.eval(a), self.eval(b)) {
                (Value::F32(a), Value::F32(b)) => op.holds(a, b),
                (a, b) => op.holds(int(a), int(b)),
            }),
            // A divisor of 0 is excluded by a condition around the statement, so its result is of no consequence.
            Expr::Bin(op, a, b) => match (self.eval(a), self.eval(b)) {
                (Value::I16(a), Value::I16(b)) => Value::I16(op.of_i16(a, b).unwrap_or(0)),
                (a, b) => Value::I32(op.of_i32(int(a), int(b)).unwrap_or(0)),
            },
            Expr::Un(op, a) => function(op, self.eval(a)),
            Expr::Float(op, a, b) => {
                let (a, b) = (float(self.eval(a)), float(self.eval(b)));
                Value::F32(match op {
                    FloatOp::Add => word::float_add(a, b),
                    FloatOp::Sub => word::float_sub(a, b),
                    FloatOp::Mul => word::float_mul(a, b),
                    FloatOp::Div => word::float_div(a, b),
                })
            }
            Expr::Complement(a) => match self.eval(a) {
                Value::I16(v) => Value::I16(!v),
                v => Value::I32(!int(v)),
            },
            Expr::Neg(a) => match self.eval(a) {
                Value::I16(v) => Value::I16(v.wrapping_neg()),
                v => Value::I32(int(v).wrapping_neg()),
            },
            Expr::Within { value, .. } => self.eval(value),
            Expr::Widen(a) => Value::I32(int(self.eval(a))),
            Expr::Narrow(a) => Value::I16(int(self.eval(a)) as i16),
            Expr::HighWord(a) => Value::I16((int(self.eval(a)) >> 16) as i16),
            Expr::BitToInt(a) => Value::I16(self.on(a).into()),
            Expr::InRange { place, count } => Value::Bit(self.in_range(place, count)),
        }
    }

    /// A `Bit` expression's value: what its list leaves when its items are executed. The results of the blocks that are open
    /// are bits of a number, that of the innermost is the lowest.
    pub(crate) fn on(&self, id: ExprId) -> bool {
        let mut blocks = 0u64;
        for item in self.logic.list(id) {
            let input = match item.input {
                Input::Bit(slot) => self.devices.bit_at(slot),
                Input::Strided(i) => self.strided(i),
                Input::Contact(class, n) => self.devices.bit(class, n).unwrap_or(false),
                Input::Temp(temp) => self.temps[temp.0 as usize] == Value::Bit(true),
                Input::Expr(id) => self.eval(id) == Value::Bit(true),
                Input::Block => {
                    let on = blocks & 1 == 1;
                    blocks >>= 1;
                    on
                }
            };
            let input = u64::from(input != item.inverted);
            blocks = match item.join {
                Join::Load => blocks << 1 | input,
                Join::And => blocks & (!1 | input),
                Join::Or => blocks | input,
            };
        }
        blocks & 1 == 1
    }

    /// A device in this round of the loop around.
    fn strided(&self, i: u32) -> bool {
        let Strided { first, round, by } = self.logic.strided[i as usize];
        let round = int(self.temps[round.0 as usize]) as u32;
        self.devices.bit_at(first.plus(round.wrapping_mul(by)))
    }

    /// The number of the device that a place names now; `None` if the index leads below 0.
    fn number(&self, place: Place) -> Option<u32> {
        match place.index {
            None => Some(place.number),
            Some(index) => {
                let number = i64::from(place.number) + i64::from(int(self.eval(index)));
                u32::try_from(number).ok()
            }
        }
    }

    fn device(&self, place: Place) -> Option<(Class, u32)> {
        Some((rt_class(place.class)?, self.number(place)?))
    }

    fn in_range(&self, place: Place, count: u32) -> bool {
        self.number(place)
            .is_some_and(|first| self.module.model.in_range(place.class, first.into(), count))
    }

    fn read_bit(&self, place: Place) -> bool {
        self.device(place)
            .and_then(|(class, n)| self.bit(class, n))
            .unwrap_or(false)
    }

    fn read_word(&self, place: Place) -> i16 {
        let Some((class, number)) = self.device(place) else {
            return 0;
        };
        if let (Class::C, Some(value)) = (class, self.counter32(number)) {
            return value as i16;
        }
        self.word(class, number).unwrap_or(0)
    }

    /// Where the high word of the pair at (class, number) is.
    fn high_word(&self, class: Class, number: u32) -> (Class, u32) {
        if class == Class::Z && self.module.model.z_pairs_with_v {
            (Class::V, number)
        } else {
            (class, number.saturating_add(1))
        }
    }

    fn read_pair(&self, place: Place) -> i32 {
        let Some((class, number)) = self.device(place) else {
            return 0;
        };
        if let (Class::C, Some(value)) = (class, self.counter32(number)) {
            return value;
        }
        let (high_class, high) = self.high_word(class, number);
        let low = self.word(class, number).unwrap_or(0);
        let high = self.word(high_class, high).unwrap_or(0);
        i32::from(high) << 16 | i32::from(low as u16)
    }

    fn read_nibbles(&self, place: Place, digits: u8) -> i32 {
        let Some((class, first)) = self.device(place) else {
            return 0;
        };
        (0..4 * u32::from(digits)).fold(0, |value, i| {
            let on = self.bit(class, first.saturating_add(i)).unwrap_or(false);
            value | i32::from(on) << i
        })
    }
}

/// Statements.
impl<'m> Machine<'m> {
    /// Executes a body.
    pub(crate) fn run(&mut self, body: &'m [Stmt], hal: &mut dyn Hal) -> Flow {
        for stmt in body {
            let flow = self.step(stmt, hal);
            if flow != Flow::Next {
                return flow;
            }
        }
        Flow::Next
    }

    fn step(&mut self, stmt: &'m Stmt, hal: &mut dyn Hal) -> Flow {
        match stmt {
            Stmt::If {
                cond,
                then,
                otherwise,
            } => {
                let body = if self.on(*cond) { then } else { otherwise };
                return self.run(body, hal);
            }
            Stmt::For { count, body } => {
                for _ in 0..int(self.eval(*count)).max(1) {
                    let flow = self.run(body, hal);
                    if flow != Flow::Next {
                        return flow;
                    }
                }
            }
            Stmt::Repeat {
                count, round, body, ..
            } => {
                for n in 0..*count {
                    self.temps[round.0 as usize] = Value::I32(n as i32);
                    let flow = self.run(body, hal);
                    if flow != Flow::Next {
                        return flow;
                    }
                }
            }
            Stmt::CallSub(n) => {
                let module = self.module;
                if let Some(function) = module.functions.get(*n as usize) {
                    self.run(&function.body, hal);
                }
            }
            Stmt::Return => return Flow::Return,
            Stmt::Parts(parts) => return self.run_parts(parts, hal),
            Stmt::Goto(label) => return Flow::Goto(*label),
            Stmt::Call {
                function,
                wide,
                args,
                drive,
                signal,
                slot,
                step,
            } => {
                let site = Site {
                    step: *step,
                    slot: *slot,
                    wide: *wide,
                    drive: drive.is_none_or(|drive| self.on(drive)),
                    signal: *signal,
                };
                self.call(*function, args, site, hal);
            }
            Stmt::Fetch {
                from,
                wide,
                value,
                there,
                step,
            } => {
                let (site, from) = (site_of_form(*step, *wide), self.operand(from));
                let fetched = fetch(site, from, self, hal);
                if let Some(fetched) = fetched {
                    self.cells[value.0 as usize] = fetched;
                }
                self.temps[there.0 as usize] = Value::Bit(fetched.is_some());
            }
            Stmt::Send {
                to,
                wide,
                value,
                step,
            } => {
                let (to, value) = (self.operand(to), int(self.eval(*value)));
                send(site_of_form(*step, *wide), to, value, self, hal);
            }
            Stmt::Fault { code, step } => report(self, Fault(*code), *step),
            Stmt::Watch { steps, at } => {
                if self.out_of_time(*steps, *at) {
                    return Flow::Return;
                }
            }
            Stmt::Stop => {
                self.last_error.stop = Stop::Program;
                rungc_rt::Program::set_running(self, false);
            }
            Stmt::Clear { latched } => self.devices.clear(*latched),
            _ => self.assign(stmt),
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

    /// Statements that only evaluate and store.
    fn assign(&mut self, stmt: &Stmt) {
        match *stmt {
            Stmt::Let(temp, value) => self.temps[temp.0 as usize] = self.eval(value),
            Stmt::Edge {
                edge,
                index,
                kind,
                input,
                out,
            } => {
                let now = self.on(input);
                let further = index.map_or(0, |index| int(self.eval(index)) as usize);
                let before = std::mem::replace(&mut self.edges[edge.0 as usize + further], now);
                self.temps[out.0 as usize] = Value::Bit(match kind {
                    EdgeKind::Rising => now && !before,
                    EdgeKind::Falling => before && !now,
                });
            }
            Stmt::SetCell(cell, value) => self.cells[cell.0 as usize] = int(self.eval(value)),
            Stmt::SetEntry(table, index, value) => {
                let index = int(self.eval(index));
                self.tables[table.0 as usize][index as usize] = int(self.eval(value));
            }
            Stmt::SetFlag(flag, value) => self.flags[flag.0 as usize] = self.on(value),
            Stmt::WriteBit(place, value) => {
                let on = self.on(value);
                self.write_bit(place, on);
            }
            Stmt::WriteWordBit(place, bit, value) => {
                let (mask, on) = (1i16 << (bit & 15), self.on(value));
                let word = self.read_word(place);
                self.write_word(place, if on { word | mask } else { word & !mask });
            }
            Stmt::WriteWord(place, value) => {
                let value = int(self.eval(value)) as i16;
                self.write_word(place, value);
            }
            Stmt::WritePair(place, value) => {
                let value = int(self.eval(value));
                self.write_pair(place, value);
            }
            Stmt::WriteFloat(place, value) => {
                if let Value::F32(value) = self.eval(value) {
                    self.write_pair(place, value.to_bits() as i32);
                }
            }
            Stmt::WriteNibbles {
                place,
                digits,
                value,
            } => {
                let value = int(self.eval(value));
                self.write_nibbles(place, digits, value);
            }
            Stmt::Reset(place) => {
                if let Some((class, number)) = self.device(place) {
                    let _ = self.reset(class, number);
                }
            }
            Stmt::TimerGoesOn { number, kind } => {
                if let Some(timer) = self.devices.timer(number) {
                    timer.go_on(kind, &self.sys);
                }
            }
            Stmt::Timer { .. }
            | Stmt::TimerAt { .. }
            | Stmt::Counter16 { .. }
            | Stmt::Counter16At { .. }
            | Stmt::Counter32 { .. }
            | Stmt::Count { .. } => self.coil(stmt),
            // Stmt::Network marks a place; all others are control flow, which `step` handles.
            _ => {}
        }
    }

    /// OUT T and OUT C.
    fn coil(&mut self, stmt: &Stmt) {
        match *stmt {
            Stmt::Timer {
                number,
                kind,
                drive,
                preset,
            } => self.timer(number, kind, drive, preset),
            Stmt::TimerAt {
                place,
                drive,
                preset,
            } => {
                if let Some((_, number)) = self.device(place)
                    && let Some(kind) = self.module.model.timer(number)
                {
                    let kind = TimerKind {
                        shared: true,
                        ..kind
                    };
                    self.timer(number, kind, drive, preset);
                }
            }
            Stmt::Counter16 {
                number,
                drive,
                preset,
            } => self.counter16(number, drive, preset),
            Stmt::Counter16At {
                place,
                drive,
                preset,
            } => {
                if let Some((_, number)) = self.device(place) {
                    self.counter16(number, drive, preset);
                }
            }
            Stmt::Counter32 {
                number,
                drive,
                down,
                preset,
            } => {
                let (drive, down, preset) = (self.on(drive), self.on(down), int(self.eval(preset)));
                if let Some(counter) = self.devices.counter32_mut(number) {
                    counter.run(drive, down, preset);
                }
            }
            Stmt::Count {
                number,
                down,
                preset,
            } => {
                let (down, preset) = (self.on(down), int(self.eval(preset)));
                if let Some(counter) = self.devices.counter32_mut(number) {
                    counter.count(down, preset);
                }
            }
            _ => {}
        }
    }

    fn timer(&mut self, number: u32, kind: TimerKind, drive: ExprId, preset: ExprId) {
        let (drive, preset) = (self.on(drive), int(self.eval(preset)) as i16);
        if let Some(timer) = self.devices.timer(number) {
            timer.run(kind, drive, preset, &self.sys);
        }
    }

    fn counter16(&mut self, number: u32, drive: ExprId, preset: ExprId) {
        let (drive, preset) = (self.on(drive), int(self.eval(preset)) as i16);
        if let Some(counter) = self.devices.counter16(number) {
            counter.run(drive, preset);
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

    fn call(&mut self, function: RtFn, args: &[Arg], site: Site, hal: &mut dyn Hal) {
        let mut ops = std::mem::take(&mut self.operands);
        ops.clear();
        ops.extend(args.iter().map(|arg| self.operand(arg)));
        let done = function.call(&mut Cx::new(self, hal, &ops, site));
        self.operands = ops;
        if let Err(fault) = done {
            report(self, fault, site.step);
        }
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
