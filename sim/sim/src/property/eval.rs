//! Values of conditions after a scan.

use super::{Calc, CalcOp, Condition, Devices, Number, NumberKind, read};
use rungc_rt::{CmpOp, word};

/// Memory of conditions from scan to scan: a cell for each place in them that needs one, in the order of evaluation;
/// `None` before the first scan.
#[derive(Clone, Default, Debug)]
pub(super) struct Memory(Vec<Option<i64>>);

impl Memory {
    /// Before the first scan.
    pub(super) fn of<'c>(conditions: impl IntoIterator<Item = &'c Condition>) -> Self {
        let cells = conditions.into_iter().map(Condition::cells);
        Memory(vec![None; cells.sum()])
    }
}

/// Evaluation of conditions after one scan. Every condition is evaluated once, always in the same order.
pub(super) struct Pass<'p, D> {
    devices: &'p D,
    /// Milliseconds from the beginning of the scan before to that of this one.
    elapsed_ms: u32,
    cells: &'p mut [Option<i64>],
    /// The next cell.
    next: usize,
}

impl<'p, D: Devices> Pass<'p, D> {
    /// After a scan that began this much later than the one before.
    pub(super) fn new(devices: &'p D, elapsed_ms: u32, memory: &'p mut Memory) -> Self {
        Pass {
            devices,
            elapsed_ms,
            cells: &mut memory.0,
            next: 0,
        }
    }

    /// Number of the next cell.
    fn cell(&mut self) -> usize {
        self.next += 1;
        self.next - 1
    }

    /// Replaces the content of a cell; what was in it.
    fn remember(&mut self, cell: usize, value: Option<i64>) -> Option<i64> {
        let slot = self.cells.get_mut(cell)?;
        std::mem::replace(slot, value)
    }

    /// Returns true if a condition holds.
    pub(super) fn holds(&mut self, condition: &Condition) -> bool {
        match condition {
            Condition::Constant(on) => *on,
            Condition::On(target) => read(self.devices, *target) != 0,
            Condition::WordBit(word, bit) => read(self.devices, *word) >> bit & 1 == 1,
            Condition::Not(a) => !self.holds(a),
            Condition::And(a, b) => {
                // Both, as either may have memory.
                let (a, b) = (self.holds(a), self.holds(b));
                a && b
            }
            Condition::Or(a, b) => {
                let (a, b) = (self.holds(a), self.holds(b));
                a || b
            }
            Condition::Same(a, b) => self.holds(a) == self.holds(b),
            Condition::Compare(op, a, b) => self.compare(*op, a, b),
            Condition::Count { least, most, of } => {
                let held = of.iter().map(|a| u32::from(self.holds(a)));
                let held: u32 = held.sum();
                (*least..=*most).contains(&held)
            }
            Condition::Was(a) => self.now_and_before(a).1,
            Condition::Rises(a) => self.now_and_before(a) == (true, false),
            Condition::Falls(a) => self.now_and_before(a) == (false, true),
            Condition::For(a, ms) => self.lasts(a, *ms),
            Condition::Before(a, b) => self.in_order(a, b),
        }
    }

    /// Returns whether a condition holds, and whether it held after the scan before.
    fn now_and_before(&mut self, a: &Condition) -> (bool, bool) {
        let cell = self.cell();
        let now = self.holds(a);
        (now, self.remember(cell, Some(now.into())) == Some(1))
    }

    fn lasts(&mut self, a: &Condition, ms: u32) -> bool {
        let cell = self.cell();
        let holds = self.holds(a);
        let before = self.cells.get(cell).copied().flatten();
        let elapsed = i64::from(self.elapsed_ms);
        let lasted = before.map_or(0, |before| before.saturating_add(elapsed));
        self.remember(cell, holds.then_some(lasted));
        holds && lasted >= i64::from(ms)
    }

    fn in_order(&mut self, a: &Condition, b: &Condition) -> bool {
        let (seen, last) = (self.cell(), self.cell());
        let (first, second) = (self.holds(a), self.holds(b));
        let was_on = self.remember(last, Some(second.into())) == Some(1);
        let was_seen = self.cells.get(seen).copied().flatten() == Some(1);
        let is_seen = was_seen || first;
        self.remember(seen, Some((is_seen && !second).into()));
        !second || was_on || is_seen
    }

    fn compare(&mut self, op: CmpOp, a: &Number, b: &Number) -> bool {
        let is_float = [a, b].map(Number::kind).contains(&NumberKind::Float);
        let (a, b) = (self.value(a), self.value(b));
        match is_float {
            true => op.holds(float(a), float(b)),
            false => op.holds(a, b),
        }
    }

    /// Value of an integer, or the bits of a float.
    fn value(&mut self, number: &Number) -> i64 {
        match number {
            Number::Constant(value) => (*value).into(),
            Number::Float(value) => value.to_bits().into(),
            Number::Of(target) => read(self.devices, *target).into(),
            Number::Was(of) => {
                let cell = self.cell();
                let now = self.value(of);
                self.remember(cell, Some(now)).unwrap_or(now)
            }
            Number::Calc(calc) => {
                let (a, b) = (self.value(&calc.a), self.value(&calc.b));
                result(calc, a, b)
            }
        }
    }
}

/// The float that bits are.
fn float(bits: i64) -> f32 {
    f32::from_bits(bits as u32)
}

fn result(calc: &Calc, a: i64, b: i64) -> i64 {
    if calc.kind == NumberKind::Float {
        let (a, b) = (float(a), float(b));
        let result = match calc.op {
            CalcOp::Add => word::float_add(a, b),
            CalcOp::Sub => word::float_sub(a, b),
            CalcOp::Mul => word::float_mul(a, b),
            CalcOp::Div | CalcOp::Rem => word::float_div(a, b),
        };
        return result.to_bits().into();
    }
    let result = match calc.op {
        CalcOp::Add => a + b,
        CalcOp::Sub => a - b,
        CalcOp::Mul => a * b,
        CalcOp::Div => a.checked_div(b).unwrap_or(0),
        CalcOp::Rem => a.checked_rem(b).unwrap_or(0),
    };
    match calc.kind {
        NumberKind::Word => (result as i16).into(),
        _ => (result as i32).into(),
    }
}

impl Condition {
    /// Returns true if it holds after a first scan that leaves the devices so.
    pub fn holds(&self, devices: &impl Devices) -> bool {
        Pass::new(devices, 0, &mut Memory::of([self])).holds(self)
    }
}
