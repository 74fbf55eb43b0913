//! Expressions as logic.

use super::shared::Signature;
use super::{CounterPart, Encoder, Input, Key, TimerPart};
use crate::aig::{Aig, Lit};
use crate::bits::{Bits, complement, constant, known, signed, unsigned};
use rungc_ir::node::{Access, AccessKind, BinOp, Expr, ExprId, FloatOp, Place, SysValue, Ty, UnOp};
use rungc_models::runs::is_counter32;
use rungc_rt::{CmpOp, word};
use rungc_syntax::DeviceClass;

/// Number of bits in a value of a type.
fn width(ty: Ty) -> usize {
    match ty {
        Ty::Bit => 1,
        Ty::I16 => 16,
        Ty::I32 | Ty::F32 => 32,
    }
}

/// The float that constant bits are.
fn float(bits: &[Lit]) -> Option<f32> {
    known(bits).map(|value| f32::from_bits(value as u32))
}

fn float_bits(value: f32) -> Bits {
    constant(value.to_bits().into(), 32)
}

impl Encoder<'_> {
    /// A bit expression's value.
    pub(super) fn on(&mut self, id: ExprId) -> Lit {
        self.eval(id)[0]
    }

    /// The values of a statement are those before it writes.
    pub(super) fn forget_values(&mut self) {
        self.values.clear();
    }

    pub(super) fn eval(&mut self, id: ExprId) -> Bits {
        if let Some(value) = self.values.get(&id) {
            return value.clone();
        }
        let expr = *self.module.expr(id);
        let value = self.value(id, &expr);
        self.values.insert(id, value.clone());
        value
    }

    fn value(&mut self, id: ExprId, expr: &Expr) -> Bits {
        match *expr {
            Expr::Bit(on) => vec![on.into()],
            Expr::I16(value) => constant(value.into(), 16),
            Expr::I32(value) => constant(value.into(), 32),
            Expr::F32(value) => float_bits(value),
            Expr::Temp(temp) => match &self.temps[temp] {
                Some(value) => value.clone(),
                None => constant(0, width(self.module.temps[temp])),
            },
            Expr::Read(access) => self.read(access),
            Expr::Sys(value) => self.sys(value),
            Expr::Flag(flag) => self.load(Key::Flag(flag.0)),
            Expr::Cell(cell) => self.load(Key::Cell(cell.0)),
            Expr::Entry(table, index) => self.entry(table.0, index),
            Expr::Stride(iteration, stride) => {
                let iteration = self.temps[iteration].clone();
                let iteration = iteration.unwrap_or_else(|| constant(0, 32));
                self.aig.mul(&iteration, &constant(stride.into(), 32))
            }
            Expr::Not(a) => vec![!self.on(a)],
            Expr::And(a, b) => self.joined(a, b, Aig::and),
            Expr::Or(a, b) => self.joined(a, b, Aig::or),
            Expr::Cmp(op, a, b) => vec![self.compare(op, a, b)],
            Expr::Bin(op, a, b) => {
                let (a, b) = (self.eval(a), self.eval(b));
                self.binary(op, &a, &b)
            }
            Expr::Un(op, a) => {
                let a = self.eval(a);
                self.unary(op, &a, width(self.module.ty(id)))
            }
            Expr::Float(op, a, b) => self.float(op, a, b),
            Expr::Complement(a) => complement(&self.eval(a)),
            Expr::Neg(a) => {
                let a = self.eval(a);
                self.aig.neg(&a)
            }
            Expr::Widen(a) => signed(&self.eval(a), 32),
            Expr::Narrow(a) => signed(&self.eval(a), 16),
            Expr::HighWord(a) => self.eval(a)[16..].to_vec(),
            Expr::BitToInt(a) => unsigned(&[self.on(a)], 16),
            Expr::Within { value, .. } => self.eval(value),
            Expr::InRange {
                place,
                count,
                length,
            } => vec![self.in_range(place, count, length)],
        }
    }

    fn joined(&mut self, a: ExprId, b: ExprId, join: fn(&mut Aig, Lit, Lit) -> Lit) -> Bits {
        let (a, b) = (self.on(a), self.on(b));
        vec![join(&mut self.aig, a, b)]
    }

    fn sys(&mut self, value: SysValue) -> Bits {
        match value {
            SysValue::Running => self.load(Key::Running),
            SysValue::FirstScan => self.load(Key::First),
            SysValue::NowMs => self.load(Key::Now),
            SysValue::MinuteMs => unsigned(&self.load(Key::Minute), 32),
            SysValue::SinceScanMs => unsigned(&self.elapsed(), 32),
            SysValue::Scan100us => {
                if self.scan_time.is_none() {
                    // No PLC allows scans of more than three seconds.
                    let bits = self.inputs_named(15, Input::ScanTime);
                    self.scan_time = Some(unsigned(&bits, 32));
                }
                self.scan_time.clone().unwrap_or_default()
            }
        }
    }

    fn entry(&mut self, table: u32, index: ExprId) -> Bits {
        let index = self.eval(index);
        let length = self.module.tables[rungc_ir::node::TableId(table)].length;
        let mut value = constant(0, 32);
        for i in 0..length {
            let here = self.aig.is(&index, i.into());
            let entry = self.load(Key::Entry(table, i));
            value = self.aig.select(here, &entry, &value);
        }
        value
    }

    fn compare(&mut self, op: CmpOp, a: ExprId, b: ExprId) -> Lit {
        let floats = self.module.ty(a) == Ty::F32;
        let sides = [a, b];
        let (a, b) = (self.eval(a), self.eval(b));
        if !floats {
            let holds = self.compare_bits(op, &a, &b);
            self.note_comparison(op, sides, holds);
            return holds;
        }
        match (float(&a), float(&b)) {
            (Some(a), Some(b)) => op.holds(a, b).into(),
            _ => {
                let signature = Signature::Float(format!("{op:?}"));
                self.applied(
                    1,
                    "comparisons of floats",
                    signature,
                    &[&a[..], &b[..]].concat(),
                )[0]
            }
        }
    }

    /// A comparison of two signed numbers of one width.
    pub(crate) fn compare_bits(&mut self, op: CmpOp, a: &[Lit], b: &[Lit]) -> Lit {
        match op {
            CmpOp::Eq => self.aig.equal(a, b),
            CmpOp::Ne => !self.aig.equal(a, b),
            CmpOp::Lt => self.aig.less(a, b),
            CmpOp::Le => !self.aig.less(b, a),
            CmpOp::Gt => self.aig.less(b, a),
            CmpOp::Ge => !self.aig.less(a, b),
        }
    }

    fn binary(&mut self, op: BinOp, a: &[Lit], b: &[Lit]) -> Bits {
        let aig = &mut self.aig;
        let width = a.len();
        match op {
            BinOp::Add => aig.add(a, b),
            BinOp::Sub => aig.sub(a, b),
            BinOp::Mul => aig.mul(a, b),
            BinOp::MulHigh => {
                let product = aig.mul(&signed(a, 2 * width), &signed(b, 2 * width));
                product[width..].to_vec()
            }
            BinOp::Div => aig.divide_signed(a, b).0,
            BinOp::Rem => aig.divide_signed(a, b).1,
            BinOp::And => aig.zip(a, b, Aig::and),
            BinOp::Or => aig.zip(a, b, Aig::or),
            BinOp::Xor => aig.zip(a, b, Aig::xor),
            BinOp::SatAdd => {
                let sum = aig.add(&signed(a, width + 1), &signed(b, width + 1));
                aig.saturate(&sum, width)
            }
            BinOp::SatSub => {
                let difference = aig.sub(&signed(a, width + 1), &signed(b, width + 1));
                aig.saturate(&difference, width)
            }
            BinOp::Min => {
                let less = aig.less(a, b);
                aig.select(less, a, b)
            }
            BinOp::Max => {
                let less = aig.less(a, b);
                aig.select(less, b, a)
            }
            BinOp::RotateLeft => aig.rotate_left(a, b),
        }
    }

    fn unary(&mut self, op: UnOp, a: &[Lit], width: usize) -> Bits {
        match op {
            UnOp::SwapBytes => a
                .chunks(16)
                .flat_map(|word| word[8..].iter().chain(&word[..8]).copied())
                .collect(),
            UnOp::CountOnes => self.aig.ones(a, width),
            UnOp::ToBcd => self.bcd_of(a),
            UnOp::FromBcd => self.number_of_bcd(a),
            UnOp::IsBcd => {
                let ten = constant(10, 4);
                let digits = a.chunks(4).map(|digit| self.aig.below(digit, &ten));
                let digits: Bits = digits.collect();
                vec![self.aig.all(digits)]
            }
            UnOp::HighestBit => {
                let zero = constant(0, 32);
                (0..).zip(a).fold(zero, |highest, (i, &bit)| {
                    self.aig.select(bit, &constant(i, 32), &highest)
                })
            }
            UnOp::Segments => {
                let none = constant(0, 16);
                (0..16).fold(none, |segments, digit: i16| {
                    let shown = self.aig.is(&a[..4], digit.into());
                    let pattern = constant(word::segments(digit).into(), 16);
                    self.aig.select(shown, &pattern, &segments)
                })
            }
            UnOp::Negate => {
                let mut bits = a.to_vec();
                bits[31] = !bits[31];
                bits
            }
            // A number is one unless its exponent is all ones.
            UnOp::IsFinite => {
                let special = self.aig.all(a[23..31].iter().copied());
                vec![!special]
            }
            UnOp::Root | UnOp::ToFloat | UnOp::Truncate | UnOp::SquareRoot => {
                match known(a).map(|a| a as i32) {
                    Some(a) => folded(op, a),
                    None => {
                        let signature = Signature::Float(format!("{op:?}"));
                        self.applied(width, "square roots and floats", signature, a)
                    }
                }
            }
        }
    }

    fn bcd_of(&mut self, a: &[Lit]) -> Bits {
        let mut rest = a.to_vec();
        let mut digits = Bits::new();
        while digits.len() < a.len() {
            let (quotient, digit) = self.aig.divide(&rest, &constant(10, 4));
            digits.extend(digit);
            rest = quotient;
        }
        digits
    }

    fn number_of_bcd(&mut self, a: &[Lit]) -> Bits {
        let mut value = constant(0, a.len());
        for digit in a.chunks(4).rev() {
            value = self.aig.mul(&value, &constant(10, a.len()));
            value = self.aig.add(&value, &unsigned(digit, a.len()));
        }
        value
    }

    fn float(&mut self, op: FloatOp, a: ExprId, b: ExprId) -> Bits {
        let (a, b) = (self.eval(a), self.eval(b));
        let (Some(a), Some(b)) = (float(&a), float(&b)) else {
            let signature = Signature::Float(format!("{op:?}"));
            return self.applied(32, "arithmetic of floats", signature, &[a, b].concat());
        };
        float_bits(match op {
            FloatOp::Add => word::float_add(a, b),
            FloatOp::Sub => word::float_sub(a, b),
            FloatOp::Mul => word::float_mul(a, b),
            FloatOp::Div => word::float_div(a, b),
        })
    }

    /// Bit that is on if `count` devices from a place on exist, in one run.
    fn in_range(&mut self, place: Place, count: u32, length: Option<ExprId>) -> Lit {
        let number = i64::from(place.number);
        let index = match (place.index, length) {
            (None, None) => {
                let model = self.module.model;
                return model.in_range(place.class, number, count).into();
            }
            (None, Some(_)) => constant(0, 40),
            (Some(index), _) => signed(&self.eval(index), 40),
        };
        // The index of the last device, less what is constant.
        let end = length.map(|length| {
            let length = signed(&self.eval(length), 40);
            let more = self.aig.sub(&length, &constant(count.max(1).into(), 40));
            self.aig.add(&index, &more)
        });
        let end = end.unwrap_or_else(|| index.clone());
        let mut found = Lit::FALSE;
        for (first, last) in self.module.model.runs(place.class) {
            let low = i64::from(first) - number;
            let high = i64::from(last) - number - i64::from(count.max(1)) + 1;
            let under = self.aig.less(&index, &constant(low, 40));
            let over = self.aig.less(&constant(high, 40), &end);
            let here = self.aig.and(!under, !over);
            found = self.aig.or(found, here);
        }
        found
    }

    pub(super) fn read(&mut self, Access { place, kind }: Access) -> Bits {
        let Some(index) = place.index else {
            return self.read_at(kind, place.class, place.number);
        };
        let index = self.eval(index);
        let access = Access { place, kind };
        let width = width(access.ty());
        let Some(candidates) = self.candidates(place, &index, access.extent()) else {
            return self.fresh_by_index(width);
        };
        let mut value = match candidates.are_all {
            true => constant(0, width),
            false => self.unnamed(width),
        };
        for (here, number) in candidates.numbers {
            let read = self.read_at(kind, place.class, number);
            value = self.aig.select(here, &read, &value);
        }
        value
    }

    /// Value read by an access without an index.
    pub(crate) fn read_at(&mut self, kind: AccessKind, class: DeviceClass, number: u32) -> Bits {
        match kind {
            AccessKind::Bit => vec![self.read_bit(class, number)],
            AccessKind::WordBit(bit) => vec![self.read_word(class, number)[usize::from(bit & 15)]],
            AccessKind::Word => self.read_word(class, number),
            AccessKind::Pair | AccessKind::Float => self.read_pair(class, number),
            AccessKind::Nibbles { digits, wide } => {
                let bits = (0..4 * u32::from(digits))
                    .map(|i| self.read_bit(class, number.saturating_add(i)))
                    .collect::<Bits>();
                unsigned(&bits, if wide { 32 } else { 16 })
            }
        }
    }

    fn exists(&self, class: DeviceClass, number: u32) -> bool {
        self.module.model.has(class, number)
    }

    /// The state of a bit device; one that the model does not have is off.
    fn read_bit(&mut self, class: DeviceClass, number: u32) -> Lit {
        if !self.exists(class, number) {
            return Lit::FALSE;
        }
        let key = match class {
            DeviceClass::T => Key::Timer(number, TimerPart::Done),
            DeviceClass::C => Key::Counter(number, CounterPart::Done),
            _ => Key::Bit(class, number),
        };
        self.load(key)[0]
    }

    /// The memory of a word, if the model has it.
    pub(super) fn word_key(&self, class: DeviceClass, number: u32) -> Option<Key> {
        let (class, number) = self.module.model.canonical(class, number);
        self.exists(class, number).then_some(match class {
            DeviceClass::T => Key::Timer(number, TimerPart::Value),
            DeviceClass::C => Key::Counter(number, CounterPart::Value),
            _ => Key::Word(class, number),
        })
    }

    pub(super) fn read_word(&mut self, class: DeviceClass, number: u32) -> Bits {
        match self.word_key(class, number) {
            Some(key) => signed(&self.load(key), 16),
            None => constant(0, 16),
        }
    }

    fn read_pair(&mut self, class: DeviceClass, number: u32) -> Bits {
        if is_counter32(class, number) && self.exists(class, number) {
            return self.load(Key::Counter(number, CounterPart::Value));
        }
        let high = Place::fixed(class, number).high_word(self.module.model);
        let mut bits = self.read_word(class, number);
        bits.extend(self.read_word(high.class, high.number));
        bits
    }
}

/// A function of a constant.
fn folded(op: UnOp, a: i32) -> Bits {
    let float = f32::from_bits(a as u32);
    match op {
        UnOp::ToFloat => float_bits(word::to_float(a)),
        UnOp::Truncate => constant(word::truncate(float).into(), 32),
        UnOp::SquareRoot => float_bits(word::square_root(float)),
        _ => constant(word::root(a.max(0)).into(), 32),
    }
}
