//! The values of expressions, as [`rungc_ir::node`] specifies them.

use crate::logic::{Input, Join, Strided};
use crate::machine::Machine;
use rungc_ir::node::{Access, AccessKind, Expr, ExprId, FloatOp, Place, SysValue, Ty, UnOp};
use rungc_models::runs::rt_class;
use rungc_rt::{Class, Plc, word};

/// Value of an expression or temporary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Value {
    Bit(bool),
    I16(i16),
    I32(i32),
    F32(f32),
}

impl Value {
    /// Value of a temporary of this type before its first assignment.
    pub(crate) fn zero(ty: Ty) -> Self {
        match ty {
            Ty::Bit => Value::Bit(false),
            Ty::I16 => Value::I16(0),
            Ty::I32 => Value::I32(0),
            Ty::F32 => Value::F32(0.0),
        }
    }

    /// A function of an integer, in the integer's type.
    fn map_int(self, f: impl Fn(i32) -> i32) -> Self {
        if let Value::I16(v) = self {
            Value::I16(f(v.into()) as i16)
        } else {
            Value::I32(f(int(self)))
        }
    }
}

/// Sign-extends to 32 bits; the width of an `I16` is restored when the result is stored.
pub(crate) fn int(value: Value) -> i32 {
    match value {
        Value::I16(v) => v.into(),
        Value::I32(v) => v,
        Value::Bit(v) => v.into(),
        Value::F32(_) => 0,
    }
}

pub(crate) fn float(value: Value) -> f32 {
    match value {
        Value::F32(v) => v,
        Value::Bit(_) | Value::I16(_) | Value::I32(_) => 0.0,
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
        (UnOp::HighestBit, v) => Value::I32(word::highest_bit(int(v))),
        (UnOp::Segments, v) => Value::I16(word::segments(int(v) as i16)),
        (UnOp::ToFloat, v) => Value::F32(word::to_float(int(v))),
        (UnOp::Truncate, v) => Value::I32(word::truncate(float(v))),
        (UnOp::IsFinite, v) => Value::Bit(word::is_finite(float(v))),
        (UnOp::SquareRoot, v) => Value::F32(word::square_root(float(v))),
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
            Expr::Temp(temp) => self.temps[temp],
            Expr::Read(access) => self.read(access),
            Expr::Cell(cell) => Value::I32(self.cells[cell]),
            Expr::Stride(iteration, stride) => {
                Value::I32(int(self.temps[iteration]).wrapping_mul(stride as i32))
            }
            Expr::Entry(table, index) => {
                let index = int(self.eval(index));
                Value::I32(self.tables[table][index as usize])
            }
            Expr::Flag(flag) => Value::Bit(self.flags[flag]),
            Expr::Sys(SysValue::Running) => Value::Bit(self.sys.running),
            Expr::Sys(SysValue::FirstScan) => Value::Bit(self.sys.first_scan),
            Expr::Sys(SysValue::NowMs) => Value::I32(self.sys.now_ms as i32),
            Expr::Sys(SysValue::MinuteMs) => Value::I32(self.sys.minute_ms.into()),
            Expr::Sys(SysValue::SinceScanMs) => Value::I32(self.sys.dt_ms as i32),
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
            Expr::Complement(a) => self.eval(a).map_int(|v| !v),
            Expr::Neg(a) => self.eval(a).map_int(i32::wrapping_neg),
            Expr::Within { value, .. } => self.eval(value),
            Expr::Widen(a) => Value::I32(int(self.eval(a))),
            Expr::Narrow(a) => Value::I16(int(self.eval(a)) as i16),
            Expr::HighWord(a) => Value::I16((int(self.eval(a)) >> 16) as i16),
            Expr::BitToInt(a) => Value::I16(self.on(a).into()),
            Expr::InRange {
                place,
                count,
                length,
            } => Value::Bit(
                self.in_range(place, length.map_or(count, |id| int(self.eval(id)) as u32)),
            ),
        }
    }

    /// A `Bit` expression's value: what its list leaves when its items are executed. The results of the blocks that are
    /// open are bits of a number, that of the innermost is the lowest.
    pub(crate) fn on(&self, id: ExprId) -> bool {
        let mut blocks = 0u64;
        for item in self.logic.list(id) {
            let input = match item.input {
                Input::Bit(slot) => self.devices.bit_at(slot),
                Input::Strided(i) => self.strided(i),
                Input::Contact(class, n) => self.devices.bit(class, n).unwrap_or(false),
                Input::Temp(temp) => self.temps[temp] == Value::Bit(true),
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

    /// The device of the current iteration of the enclosing loop.
    fn strided(&self, i: u32) -> bool {
        let Strided {
            first,
            iteration,
            stride,
        } = self.logic.strided[i as usize];
        let iteration = int(self.temps[iteration]) as u32;
        self.devices
            .bit_at(first.plus(iteration.wrapping_mul(stride)))
    }

    /// The number of the device that a place names now; `None` if the index makes it negative.
    fn number(&self, place: Place) -> Option<u32> {
        match place.index {
            None => Some(place.number),
            Some(index) => {
                let number = i64::from(place.number) + i64::from(int(self.eval(index)));
                u32::try_from(number).ok()
            }
        }
    }

    pub(crate) fn device(&self, place: Place) -> Option<(Class, u32)> {
        Some((rt_class(place.class)?, self.number(place)?))
    }

    fn in_range(&self, place: Place, count: u32) -> bool {
        self.number(place)
            .is_some_and(|first| self.module.model.in_range(place.class, first.into(), count))
    }

    fn read(&self, Access { place, kind }: Access) -> Value {
        match kind {
            AccessKind::Bit => Value::Bit(self.read_bit(place)),
            AccessKind::WordBit(bit) => {
                Value::Bit(self.read_word(place) as u16 >> (bit & 15) & 1 == 1)
            }
            AccessKind::Word => Value::I16(self.read_word(place)),
            AccessKind::Pair => Value::I32(self.read_pair(place)),
            AccessKind::Float => Value::F32(f32::from_bits(self.read_pair(place) as u32)),
            AccessKind::Nibbles { digits, wide: true } => {
                Value::I32(self.read_nibbles(place, digits))
            }
            AccessKind::Nibbles {
                digits,
                wide: false,
            } => Value::I16(self.read_nibbles(place, digits) as i16),
        }
    }

    pub(crate) fn read_bit(&self, place: Place) -> bool {
        self.device(place)
            .and_then(|(class, n)| self.bit(class, n))
            .unwrap_or(false)
    }

    pub(crate) fn read_word(&self, place: Place) -> i16 {
        let Some((class, number)) = self.device(place) else {
            return 0;
        };
        if let (Class::C, Some(value)) = (class, self.counter32(number)) {
            return value as i16;
        }
        self.word(class, number).unwrap_or(0)
    }

    /// Device with the high word of the pair at (class, number).
    pub(crate) fn high_word(&self, class: Class, number: u32) -> (Class, u32) {
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
