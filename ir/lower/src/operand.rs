//! Operands: what they read, where they write, and under which conditions what they name exists.

use super::Lowerer;
use super::call::extents;
use super::counter_words::CounterWords;
use rungc_ir::node::{
    Access, AccessKind, Action, Arg, BinOp, Branch, CellId, Expr, ExprId, Fetch, Place, Send, Stmt,
    SysValue, Ty,
};
use rungc_models::runs::{FIRST_COUNTER32, is_counter32, words_of_bits};
use rungc_rt::CmpOp;
use rungc_syntax::{Device, DeviceClass, Index, OperandKind, Span, codes};

/// A device lies outside the model's range.
pub(super) const OUT_OF_RANGE: u16 = 6706;

/// Conditions under which an instruction's operands exist; where one does not hold the instruction faults.
#[derive(Default)]
pub(super) struct Guards {
    demanded: Vec<ExprId>,
    /// Conditions that operands were fetched; the fault of one that was not is already reported.
    fetched: Vec<ExprId>,
}

impl Guards {
    pub(super) fn is_empty(&self) -> bool {
        self.demanded.is_empty() && self.fetched.is_empty()
    }

    /// The conditions that are not yet tested.
    pub(super) fn conditions(self) -> impl Iterator<Item = ExprId> {
        self.demanded.into_iter()
    }

    /// One more condition.
    pub(super) fn demand(&mut self, cond: ExprId) {
        self.demanded.push(cond);
    }
}

/// Target of a result.
#[derive(Clone, Copy)]
pub(super) enum Target {
    /// A word; takes the low word of a 32-bit value.
    Word(Place),
    /// A pair or a 32-bit counter.
    Pair(Place),
    /// 32 bits from any word of the 32-bit counters.
    CounterWords(CounterWords),
    /// A group of bits.
    Nibbles(Place, u8),
    /// Operand that only the runtime writes; 32 bits of it.
    Sent(Arg, bool),
    /// Nowhere: the operand was reported.
    None,
}

/// A bit that is written.
#[derive(Clone, Copy)]
pub(super) enum BitTarget {
    /// A bit device.
    Device(Place),
    /// Bit of a word.
    OfWord(Place, u8),
}

impl Lowerer<'_> {
    /// Executes the statements of `make` where `guards` hold; else the instruction faults.
    pub(super) fn guarded(&mut self, guards: Guards, make: impl FnOnce(&mut Self)) {
        self.guarded_or(guards, make, |_| {});
    }

    /// As [`Lowerer::guarded`], for what is executed driven or not: it faults only while it is driven.
    pub(super) fn guarded_while(
        &mut self,
        guards: Guards,
        drive: Option<ExprId>,
        make: impl FnOnce(&mut Self),
    ) {
        let Some(drive) = drive.filter(|_| !guards.is_empty()) else {
            return self.guarded(guards, make);
        };
        let holds = guards.demanded.into_iter().reduce(|a, b| self.and(a, b));
        let cond = holds.unwrap_or_else(|| self.bit_const(true));
        let then = self.body(make);
        let (code, step) = (OUT_OF_RANGE, self.step());
        let otherwise =
            self.body(|this| this.when(drive, |this| this.emit(Action::Fault { code, step })));
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    /// As [`Lowerer::guarded`]; `instead` emits what else is done on a fault.
    pub(super) fn guarded_or(
        &mut self,
        guards: Guards,
        make: impl FnOnce(&mut Self),
        instead: impl Fn(&mut Self),
    ) {
        let Guards { demanded, fetched } = guards;
        let all =
            |this: &mut Self, conds: Vec<ExprId>| conds.into_iter().reduce(|a, b| this.and(a, b));
        let exists = all(self, demanded);
        let make = |this: &mut Self| {
            let Some(cond) = exists else {
                return make(this);
            };
            let then = this.body(make);
            let step = this.step();
            let otherwise = this.body(|this| {
                this.emit(Action::Fault {
                    code: OUT_OF_RANGE,
                    step,
                });
                instead(this);
            });
            this.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }));
        };
        let Some(cond) = all(self, fetched) else {
            return make(self);
        };
        let then = self.body(make);
        let otherwise = self.body(&instead);
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    /// Value of an index register as an `I32`.
    pub(super) fn index(&mut self, index: Index, wide: bool) -> ExprId {
        let place = fixed(index.class, index.number);
        // FX takes the pair (Vn, Zn), named by its Z, in 32-bit instructions; HM's addresses are 16-bit everywhere.
        if wide && self.model.z_pairs_with_v && index.class == DeviceClass::Z {
            self.add(Expr::Read(Access::pair(place)))
        } else {
            let word = self.add(Expr::Read(Access::word(place)));
            self.add(Expr::Widen(word))
        }
    }

    /// An index where it leads to a device, or where it is asked whether it does. What else it can be is determined
    /// when all is lowered.
    pub(super) fn within(&mut self, value: ExprId, bound: Option<(i32, i32)>) -> ExprId {
        let (low, high) = bound.unwrap_or((i32::MIN, i32::MAX));
        self.add(Expr::Within { value, low, high })
    }

    /// The condition that an index leads to `count` devices, within its bound if it has one.
    pub(super) fn demand_device(
        &mut self,
        place: Place,
        index: ExprId,
        count: u32,
        bound: Option<(i32, i32)>,
        guards: &mut Guards,
    ) {
        let Some((low, high)) = bound else {
            let index = Some(self.within(index, None));
            let place = Place { index, ..place };
            return guards.demand(self.add(Expr::InRange {
                place,
                count,
                length: None,
            }));
        };
        for (op, end) in [(CmpOp::Ge, low), (CmpOp::Le, high)] {
            let end = self.add(Expr::I32(end));
            guards.demand(self.add(Expr::Cmp(op, index, end)));
        }
    }

    /// The condition that an index leads to a device before number `end`, and the bound that includes it.
    fn demand_below(
        &mut self,
        place: Place,
        index: ExprId,
        end: u32,
        bound: Option<(i32, i32)>,
        guards: &mut Guards,
    ) -> (i32, i32) {
        let (low, high) = bound.unwrap_or((i32::MIN, i32::MAX));
        let last = end as i32 - 1 - place.number as i32;
        if high > last {
            let last = self.int(last, true);
            guards.demand(self.add(Expr::Cmp(CmpOp::Le, index, last)));
        }
        (low, high.min(last))
    }

    /// The operand of the instruction at hand to which a place with this index belongs: its device, and where it is. A
    /// result of several words continues after its operand.
    pub(super) fn indexed_operand(&self, place: Place, written: Index) -> Option<(Device, Span)> {
        let operands = self.instr().operands.iter();
        let found = operands.filter_map(|operand| match indexed(&operand.kind)? {
            (device, index) if index == written => Some((device, operand.span)),
            _ => None,
        });
        found
            .filter(|(device, _)| device.class == place.class && device.number <= place.number)
            .max_by_key(|(device, _)| device.number)
    }

    /// Between which values an index must lie so that it leads to `count` devices of those that its operand reaches, if
    /// these are given.
    pub(super) fn bound(&self, place: Place, written: Index, count: u32) -> Option<(i32, i32)> {
        if self.bounds.is_empty() {
            return None;
        }
        let (base, _) = self.indexed_operand(place, written)?;
        let mut bounds = self.bounds.iter();
        let bound = bounds.find(|bound| bound.device == base && bound.index == written)?;
        let from_place = |number: u32| number as i32 - place.number as i32;
        let low = from_place(bound.first);
        // A block that does not fit in leads nowhere.
        Some((
            low,
            (from_place(bound.last) - (count as i32 - 1)).max(low - 1),
        ))
    }

    /// The conditions that operands of a call lie within their bounds. The runtime checks the others.
    pub(super) fn bounds_hold(&mut self) -> Guards {
        let mut guards = Guards::default();
        if self.bounds.is_empty() {
            return guards;
        }
        let operands = &self.instr().operands;
        let extents: Vec<_> = extents(self.resolution(), operands).collect();
        for (operand, extent) in operands.iter().zip(extents) {
            let (device, written, extent) = match operand.kind {
                OperandKind::Device(device, Some(index))
                | OperandKind::Nibbles(_, device, Some(index)) => (device, index, extent),
                OperandKind::WordBit(device, bit, Some(index)) => {
                    let words = extent.map(|bits| words_of_bits(bit & 15, bits));
                    (device, index, words)
                }
                OperandKind::Device(..)
                | OperandKind::WordBit(..)
                | OperandKind::Nibbles(..)
                | OperandKind::Decimal(..)
                | OperandKind::Hex(..)
                | OperandKind::Float(_)
                | OperandKind::Text(_)
                | OperandKind::Buffer { .. }
                | OperandKind::Unreadable(_) => continue,
            };
            let (place, count) = (fixed(device.class, device.number), extent.unwrap_or(1));
            if let Some(bound) = self.bound(place, written, count) {
                let index = self.index(written, self.wide());
                self.demand_device(place, index, count, Some(bound), &mut guards);
            }
        }
        guards
    }

    /// Value of an index register after a constant, of the constant's width.
    pub(super) fn constant_index(&mut self, index: Index, wide: bool) -> ExprId {
        let place = fixed(index.class, index.number);
        if !wide {
            return self.add(Expr::Read(Access::word(place)));
        }
        match (index.class, self.model.z_pairs_with_v) {
            (DeviceClass::V, true) => self.index(index, wide),
            _ => self.add(Expr::Read(Access::pair(place))),
        }
    }

    /// A device of which `count` from it on are accessed, and its conditions.
    pub(super) fn place(
        &mut self,
        device: Device,
        index: Option<Index>,
        count: u32,
        wide: bool,
        guards: &mut Guards,
    ) -> Place {
        self.place_below(device, index, count, wide, None, guards)
    }

    /// As [`Lowerer::place`]; the index must not lead to device number `end` or a later one.
    fn place_below(
        &mut self,
        device: Device,
        index: Option<Index>,
        count: u32,
        wide: bool,
        end: Option<u32>,
        guards: &mut Guards,
    ) -> Place {
        let written = index;
        let index = index.map(|index| self.index(index, wide));
        let place = Place {
            index,
            ..self.named(device, index.is_none() && count == 1)
        };
        if let Some((index, written)) = index.zip(written) {
            let bound = self.bound(place, written, count);
            self.demand_device(place, index, count, bound, guards);
            let bound = match end {
                Some(end) => Some(self.demand_below(place, index, end, bound, guards)),
                None => bound,
            };
            let index = self.within(index, bound);
            self.note_index(index, place, written);
            let index = Some(index);
            return Place { index, ..place };
        }
        if !self.exists(place.class, place.number, count) {
            guards.demand(self.bit_const(false));
        }
        place
    }

    /// Returns true if `count` devices from `number` on lie in one run of the model.
    pub(super) fn exists(&self, class: DeviceClass, number: u32, count: u32) -> bool {
        let end = u64::from(number) + u64::from(count.max(1)) - 1;
        self.runs[class as usize]
            .iter()
            .any(|&(first, last)| first <= number && end <= u64::from(last))
    }

    /// The place of a device, without its index. If only this one is accessed, a register that is another name of an
    /// index register has that one's.
    fn named(&self, device: Device, alone: bool) -> Place {
        let (class, number) = match alone {
            true => self.model.canonical(device.class, device.number),
            false => (device.class, device.number),
        };
        fixed(class, number)
    }

    /// State of a bit operand.
    pub(super) fn bit(&mut self, operand: &OperandKind, guards: &mut Guards) -> ExprId {
        match *operand {
            OperandKind::Device(device, None) if device.class == DeviceClass::M => {
                match self.run_flag(device.number) {
                    Some(state) => state,
                    None => {
                        let place = self.place(device, None, 1, false, guards);
                        self.add(Expr::Read(Access::bit(place)))
                    }
                }
            }
            OperandKind::Device(device, index) => {
                let place = self.place(device, index, 1, false, guards);
                self.add(Expr::Read(Access::bit(place)))
            }
            OperandKind::WordBit(device, bit, index) => {
                let place = self.place(device, index, 1, false, guards);
                self.add(Expr::Read(Access::word_bit(place, bit & 15)))
            }
            OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => {
                self.unreadable(operand);
                self.bit_const(false)
            }
        }
    }

    /// M8000–M8003 are known from the scan driver, unless the program writes them.
    fn run_flag(&mut self, number: u32) -> Option<ExprId> {
        if self.specials.writes_run_flags {
            return None;
        }
        let first = Expr::Sys(SysValue::FirstScan);
        let expr = match number {
            8000 => Expr::Bit(true),
            8001 => Expr::Bit(false),
            8002 => first,
            8003 => {
                let first = self.add(first);
                Expr::Not(first)
            }
            _ => return None,
        };
        Some(self.add(expr))
    }

    /// Integer value of an operand: `I32` if `wide`, else `I16`.
    pub(super) fn value(
        &mut self,
        operand: &OperandKind,
        wide: bool,
        guards: &mut Guards,
    ) -> ExprId {
        match *operand {
            OperandKind::Decimal(value, index) => self.constant(value as i32, index, wide),
            OperandKind::Hex(value, index) => self.constant(value as u32 as i32, index, wide),
            OperandKind::Float(value) => self.int(value.to_bits() as i32, wide),
            OperandKind::Device(device, index) => self.word(device, index, wide, guards),
            OperandKind::Nibbles(digits, device, index) => {
                let digits = digits.clamp(1, if wide { 8 } else { 4 });
                let bits = 4 * u32::from(digits);
                let place = self.place(device, index, bits, wide, guards);
                let kind = AccessKind::Nibbles { digits, wide };
                self.add(Expr::Read(kind.at(place)))
            }
            OperandKind::Buffer { .. } => self.fetch(operand, wide, guards),
            OperandKind::WordBit(..) | OperandKind::Text(_) | OperandKind::Unreadable(_) => {
                self.unreadable(operand);
                self.int(0, wide)
            }
        }
    }

    /// Value of an operand in buffer memory, read here into a cell.
    fn fetch(&mut self, operand: &OperandKind, wide: bool, guards: &mut Guards) -> ExprId {
        let Some(from) = self.buffer(operand, 0, wide) else {
            return self.int(0, wide);
        };
        let value = self.fetch_cell(operand);
        let there = self.temp(Ty::Bit);
        let step = self.step();
        self.emit(Action::Fetch(Fetch {
            from,
            wide,
            value,
            there,
            step,
        }));
        guards.fetched.push(self.add(Expr::Temp(there)));
        let value = self.add(Expr::Cell(value));
        match wide {
            true => value,
            false => self.add(Expr::Narrow(value)),
        }
    }

    /// The cell that an operand of the instruction at hand is fetched to; instructions share theirs.
    fn fetch_cell(&mut self, operand: &OperandKind) -> CellId {
        let mut operands = self.instr().operands.iter();
        let position = operands.position(|o| o.kind == *operand);
        let name = format!("operand{}", position.map_or(0, |i| i + 1));
        let mut cells = self.module.cells.iter_enumerated();
        match cells.find(|(_, cell)| cell.name == name) {
            Some((known, _)) => known,
            None => self.cell(name, "an operand from buffer memory"),
        }
    }

    /// An operand in buffer memory, `offset` words further on, as an argument of the runtime.
    pub(super) fn buffer(&mut self, operand: &OperandKind, offset: u32, wide: bool) -> Option<Arg> {
        let OperandKind::Buffer {
            module,
            address,
            index,
        } = *operand
        else {
            return None;
        };
        let index = index.map(|index| self.index(index, wide));
        Some(Arg::Buffer {
            module: u8::try_from(module).ok()?,
            address: address.checked_add(offset)?,
            index,
        })
    }

    fn constant(&mut self, value: i32, index: Option<Index>, wide: bool) -> ExprId {
        let constant = self.int(value, wide);
        match index {
            Some(index) => {
                let index = self.constant_index(index, wide);
                self.add(Expr::Bin(BinOp::Add, constant, index))
            }
            None => constant,
        }
    }

    fn word(
        &mut self,
        device: Device,
        index: Option<Index>,
        wide: bool,
        guards: &mut Guards,
    ) -> ExprId {
        match self.word_target(device, index, wide, wide, guards) {
            Target::Pair(place) if wide => self.add(Expr::Read(Access::pair(place))),
            Target::Pair(place) => {
                let value = self.add(Expr::Read(Access::pair(place)));
                self.add(Expr::Narrow(value))
            }
            Target::Word(place) => self.add(Expr::Read(Access::word(place))),
            Target::CounterWords(words) => self.read_counter_words(words),
            Target::Nibbles(..) | Target::Sent(..) | Target::None => self.int(0, wide),
        }
    }

    /// A word device as a target of 16 or 32 bits; `wide_index` gives the index's width.
    fn word_target(
        &mut self,
        device: Device,
        index: Option<Index>,
        wide: bool,
        wide_index: bool,
        guards: &mut Guards,
    ) -> Target {
        if let Some(index) = index.filter(|_| self.counts_words(device, index)) {
            return Target::CounterWords(self.counter_words(device, index, guards));
        }
        if is_counter32(device.class, device.number) {
            return Target::Pair(self.place(device, index, 1, wide_index, guards));
        }
        if !wide {
            let end = (device.class == DeviceClass::C).then_some(FIRST_COUNTER32);
            return Target::Word(self.place_below(device, index, 1, wide_index, end, guards));
        }
        // The high word of Z may be its V.
        let z_with_v = device.class == DeviceClass::Z && self.model.z_pairs_with_v;
        let count = if z_with_v && index.is_none() { 1 } else { 2 };
        Target::Pair(self.place(device, index, count, wide_index, guards))
    }

    /// Device that is element `element` of a result at `device`.
    fn element(&self, device: Device, element: u32, wide: bool) -> Device {
        if device.class == DeviceClass::Z && self.model.z_pairs_with_v && !wide {
            // Zn and Vn follow each other: D8028 and D8029, D8182 and D8183.
            return Device {
                class: [DeviceClass::Z, DeviceClass::V][element as usize % 2],
                number: device.number.saturating_add(element / 2),
            };
        }
        let counter32 = is_counter32(device.class, device.number);
        let width = if wide && !counter32 { 2 } else { 1 };
        Device {
            number: device.number.saturating_add(element * width),
            ..device
        }
    }

    /// Element `element` of a result that begins at an operand: elements are as wide as the result, `wide_index` is the
    /// instruction's form.
    pub(super) fn target(
        &mut self,
        operand: &OperandKind,
        element: u32,
        wide: bool,
        wide_index: bool,
        guards: &mut Guards,
    ) -> Target {
        match *operand {
            OperandKind::Device(device, index) => {
                let device = self.element(device, element, wide);
                self.word_target(device, index, wide, wide_index, guards)
            }
            OperandKind::Nibbles(digits, device, index) => {
                let digits = digits.clamp(1, if wide { 8 } else { 4 });
                let bits = 4 * u32::from(digits);
                Target::Nibbles(self.place(device, index, bits, wide_index, guards), digits)
            }
            OperandKind::Buffer { .. } => {
                let words = if wide { 2 } else { 1 };
                match self.buffer(operand, element * words, wide_index) {
                    Some(to) => Target::Sent(to, wide),
                    None => Target::None,
                }
            }
            OperandKind::WordBit(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Unreadable(_) => {
                self.unreadable(operand);
                Target::None
            }
        }
    }

    /// Writes an integer of the target's width.
    pub(super) fn store(&mut self, target: Target, value: ExprId) {
        let stmt = match target {
            Target::Word(place) => Stmt::Do(Action::Write(Access::word(place), value)),
            Target::Pair(place) => Stmt::Do(Action::Write(Access::pair(place), value)),
            Target::CounterWords(words) => return self.write_counter_words(words, value),
            Target::Nibbles(place, digits) => {
                let wide = self.module.ty(value) == Ty::I32;
                let kind = AccessKind::Nibbles { digits, wide };
                Stmt::Do(Action::Write(kind.at(place), value))
            }
            Target::Sent(to, wide) => {
                let step = self.step();
                Stmt::Do(Action::Send(Send {
                    to,
                    wide,
                    value,
                    step,
                }))
            }
            Target::None => return,
        };
        self.emit(stmt);
    }

    /// A bit operand of which `count` from it on are written.
    pub(super) fn bit_target(
        &mut self,
        operand: &OperandKind,
        count: u32,
        wide: bool,
        guards: &mut Guards,
    ) -> Option<BitTarget> {
        match *operand {
            OperandKind::Device(device, index) => {
                let place = self.place(device, index, count, wide, guards);
                Some(BitTarget::Device(place))
            }
            OperandKind::WordBit(device, bit, index) => {
                let words = words_of_bits(bit & 15, count);
                let place = self.place(device, index, words, wide, guards);
                Some(BitTarget::OfWord(place, bit & 15))
            }
            OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => {
                self.unreadable(operand);
                None
            }
        }
    }

    /// Writes the bit `offset` bits after the target.
    pub(super) fn store_bit(&mut self, target: BitTarget, offset: u32, value: ExprId) {
        self.emit(match target {
            BitTarget::Device(place) => Stmt::Do(Action::Write(
                Access::bit(Place {
                    number: place.number + offset,
                    ..place
                }),
                value,
            )),
            BitTarget::OfWord(place, bit) => {
                let bit = u32::from(bit) + offset;
                let number = place.number + bit / 16;
                Stmt::Do(Action::Write(
                    Access::word_bit(Place { number, ..place }, (bit % 16) as u8),
                    value,
                ))
            }
        });
    }

    /// Reports an operand that is written in the program but that nothing can access inline.
    fn unreadable(&mut self, operand: &OperandKind) {
        let instr = self.instr();
        let span = instr
            .operands
            .iter()
            .find(|o| o.kind == *operand)
            .map_or(instr.span, |o| o.span);
        let name = &instr.mnemonic;
        self.report(codes::NOT_IMPLEMENTED.at(
            span,
            format!("`{name}` cannot be compiled with `{operand}`, an operand of this kind"),
        ));
    }
}

/// The device and the index of an operand that has one.
pub(super) fn indexed(operand: &OperandKind) -> Option<(Device, Index)> {
    match *operand {
        OperandKind::Device(device, index)
        | OperandKind::Nibbles(_, device, index)
        | OperandKind::WordBit(device, _, index) => Some((device, index?)),
        OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

/// A place without an index.
pub(super) const fn fixed(class: DeviceClass, number: u32) -> Place {
    Place {
        class,
        number,
        index: None,
    }
}
