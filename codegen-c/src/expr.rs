//! Expressions as C.

use crate::fields::PrintStorage;
use crate::text;
use crate::writer::Writer;
use rungc_emit::logic;
use rungc_ir::node::{BinOp, Expr, ExprId, Place, SysValue, Ty};
use rungc_models::runs::is_counter32;
use rungc_rt::CmpOp;
use rungc_syntax::DeviceClass;
use smallvec::SmallVec;
use std::fmt::Write;
use std::ops::Range;

/// Operands of a chain; most are short.
type Operands = SmallVec<[ExprId; 8]>;

/// An operand of a chain that has been written.
struct Operand {
    e: ExprId,
    /// Where it is in the text.
    text: Range<usize>,
    /// Whether it calls functions.
    calls: bool,
}

/// What stands around an expression: decides on parentheses and casts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Around {
    /// The whole right-hand side or an argument: an `I16` must have the type `int16_t`.
    Exact,
    /// The whole of something where an `int` will do: a condition, an index.
    Loose,
    /// An operand of this operator.
    Operand(&'static str),
    /// Operand of a prefix operator or a cast.
    Unary,
}

impl Around {
    /// Whether an expression made with `op` needs parentheses here. More than C asks for: compilers warn where readers may err.
    fn needs_parentheses(self, op: &str) -> bool {
        match self {
            Around::Exact | Around::Loose => false,
            Around::Unary => true,
            Around::Operand(outer) => {
                let chain = op == outer && matches!(op, "&" | "|" | "^");
                let arithmetic = matches!(op, "+" | "-" | "*" | "/" | "%");
                let comparison = matches!(outer, "==" | "!=" | "<" | "<=" | ">" | ">=");
                !(chain || arithmetic && comparison)
            }
        }
    }
}

/// Bounds of an integer expression that are plain to see.
type Bounds = (i64, i64);

const I16: Bounds = (i16::MIN as i64, i16::MAX as i64);
const I32: Bounds = (i32::MIN as i64, i32::MAX as i64);

/// The infix operator of a bitwise operation.
fn bitwise(op: BinOp) -> Option<&'static str> {
    match op {
        BinOp::And => Some("&"),
        BinOp::Or => Some("|"),
        BinOp::Xor => Some("^"),
        _ => None,
    }
}

/// The infix operator of arithmetic.
fn arithmetic(op: BinOp) -> Option<&'static str> {
    match op {
        BinOp::Add => Some("+"),
        BinOp::Sub => Some("-"),
        BinOp::Mul => Some("*"),
        BinOp::Div => Some("/"),
        BinOp::Rem => Some("%"),
        _ => None,
    }
}

/// Name of the function of rungc.h that does it, without the width.
fn function(op: BinOp) -> &'static str {
    match op {
        BinOp::Add => "plc_add",
        BinOp::Sub => "plc_sub",
        BinOp::Mul => "plc_mul",
        BinOp::MulHigh => "plc_mul_high",
        BinOp::Div => "plc_div",
        BinOp::Rem => "plc_rem",
        BinOp::SatAdd => "plc_sat_add",
        BinOp::SatSub => "plc_sat_sub",
        BinOp::And => "plc_and",
        BinOp::Or => "plc_or",
        BinOp::Xor => "plc_xor",
        BinOp::RotateLeft => "plc_rotate",
    }
}

/// A chain of which some operands call functions, or of which one operand is left.
fn among_calls(texts: &[&str], op: &str, around: Around) -> String {
    // Of several calls only those are made that matter, and clang would suspect a slip.
    let op = if op == "&" { "&&" } else { "||" };
    let chain = texts.join(&format!(" {op} "));
    match texts.len() > 1 && around.needs_parentheses(op) {
        true => format!("({chain})"),
        false => chain,
    }
}

/// Writes an integer constant; the smallest ones have no literal of their own in C.
pub fn integer(out: &mut String, value: i32) {
    match value {
        i32::MIN => out.push_str("INT32_MIN"),
        value => text::push_number(out, value),
    }
}

/// Writes a float constant.
pub fn float(out: &mut String, value: f32) {
    if value.is_finite() {
        let _ = write!(out, "{value:?}f");
    } else {
        out.push_str("plc_float(");
        integer(out, value.to_bits() as i32);
        out.push(')');
    }
}

impl Writer<'_, '_> {
    /// Writes an expression.
    pub fn expr(&mut self, out: &mut String, id: ExprId, around: Around) {
        if let Some(named) = self.named.get(&id) {
            self.calls += u64::from(named.calls);
            out.push_str(&named.text);
            return;
        }
        let module = self.module;
        match module.expr(id) {
            Expr::Bit(on) => out.push_str(if *on { "true" } else { "false" }),
            Expr::I16(value) => integer(out, (*value).into()),
            Expr::I32(value) => integer(out, *value),
            Expr::F32(value) => {
                self.calls += u64::from(!value.is_finite());
                float(out, *value);
            }
            Expr::Temp(temp) => self.temp(out, *temp),
            Expr::ReadBit(_)
            | Expr::ReadWordBit(..)
            | Expr::ReadWord(_)
            | Expr::ReadPair(_)
            | Expr::ReadFloat(_)
            | Expr::ReadNibbles { .. } => self.read(out, id, around),
            Expr::Cell(cell) => {
                out.push_str("plc->");
                out.push_str(&module.cells[*cell].name);
            }
            Expr::Entry(table, index) => {
                let _ = write!(out, "plc->{}[", module.tables[*table].name);
                self.expr(out, *index, Around::Exact);
                out.push(']');
            }
            Expr::Stride(_, by) => {
                let _ = write!(out, "{by} * (int32_t){}", self.round);
            }
            Expr::Flag(flag) => {
                out.push_str("plc->");
                out.push_str(&module.flags[*flag].name);
            }
            Expr::Sys(value) => out.push_str(match value {
                SysValue::Running => "plc->sys.running",
                SysValue::FirstScan => "plc->sys.first_scan",
                SysValue::NowMs => self.called("plc_int32(plc->sys.now_ms)"),
                SysValue::Scan100us => self.called("plc_int32(plc->sys.scan_us / 100u)"),
            }),
            Expr::Not(a) => self.not(out, *a, around),
            Expr::And(..) => self.chain(out, id, "&", around),
            Expr::Or(..) => self.chain(out, id, "|", around),
            Expr::Cmp(op, a, b) => self.compare(out, *op, *a, *b, around),
            Expr::Bin(op, a, b) => self.binary(out, id, *op, (*a, *b), around),
            Expr::Un(op, a) => {
                let function = op.name(module.ty(*a));
                self.call(out, &format!("plc_{function}"), *a);
            }
            Expr::Float(op, a, b) => {
                let _ = write!(self.call_in(out), "plc_{}(", op.name());
                self.expr(out, *a, Around::Exact);
                out.push_str(", ");
                self.expr(out, *b, Around::Exact);
                out.push(')');
            }
            Expr::Complement(a) => {
                self.int16_of(out, id, around, |w, out| {
                    out.push('~');
                    w.expr(out, *a, Around::Unary);
                });
            }
            Expr::Neg(a) => {
                let function = if self.module.ty(*a) == Ty::I16 {
                    "plc_sub16(0, "
                } else {
                    "plc_sub32(0, "
                };
                self.call_in(out).push_str(function);
                self.expr(out, *a, Around::Exact);
                out.push(')');
            }
            Expr::Widen(a) => self.expr(
                out,
                *a,
                if around == Around::Exact {
                    Around::Loose
                } else {
                    around
                },
            ),
            Expr::Within { value, .. } => self.expr(out, *value, around),
            Expr::Narrow(a) => self.narrow(out, *a, around),
            Expr::HighWord(a) => self.call(out, "plc_high", *a),
            Expr::BitToInt(a) => self.bit_to_int(out, *a, around),
            Expr::InRange { place, count } => self.in_range(out, place, *count),
        }
    }

    /// Where a call of a function is written: it is counted.
    fn call_in<'o>(&mut self, out: &'o mut String) -> &'o mut String {
        self.calls += 1;
        out
    }

    /// The text of a call.
    fn called(&mut self, text: &'static str) -> &'static str {
        self.calls += 1;
        text
    }

    fn call(&mut self, out: &mut String, function: &str, argument: ExprId) {
        self.call_in(out).push_str(function);
        out.push('(');
        self.expr(out, argument, Around::Exact);
        out.push(')');
    }

    /// Writes an operation on `int` as what `id` is: with a cast if it is an `I16` and its type is looked at.
    fn int16_of(
        &mut self,
        out: &mut String,
        id: ExprId,
        around: Around,
        write: impl FnOnce(&mut Self, &mut String),
    ) {
        if around != Around::Exact || self.module.ty(id) != Ty::I16 {
            return write(self, out);
        }
        out.push_str("(int16_t)");
        write(self, out);
    }

    fn not(&mut self, out: &mut String, a: ExprId, around: Around) {
        match self.opposite(a) {
            Some((op, l, r)) => self.compare(out, op, l, r, around),
            None if self.numbers || self.is_number(a) => {
                self.in_parentheses(out, around != Around::Exact, |w, out| {
                    w.expr(out, a, Around::Operand("^"));
                    out.push_str(" ^ 1");
                })
            }
            None => {
                out.push('!');
                self.expr(out, a, Around::Unary);
            }
        }
    }

    /// Whether a `Bit` is written as an integer: one from an array of columns, or made of such.
    fn is_number(&self, e: ExprId) -> bool {
        let known = |e: ExprId| match *self.module.expr(e) {
            _ if self.named.contains_key(&e) => Some(false),
            Expr::ReadBit(place) => Some(self.fields.is_level(place.class, place.number)),
            _ => None,
        };
        !self.module.layout.grids.is_empty() && logic::is_number(self.module, e, &known)
    }

    /// The comparison that stands for the opposite of an expression, if one does.
    fn opposite(&self, a: ExprId) -> Option<(CmpOp, ExprId, ExprId)> {
        let is_named = self.named.contains_key(&a);
        logic::opposite(self.module, a).filter(|_| !is_named)
    }

    /// Writes a value for an element of an array of columns.
    pub fn grid_value(&mut self, out: &mut String, value: ExprId) {
        let small = matches!(
            self.module.expr(value),
            Expr::ReadBit(_) | Expr::And(..) | Expr::Or(..) | Expr::Not(_) | Expr::Bit(_)
        );
        if !small {
            out.push_str("(uint8_t)");
        }
        self.expr(
            out,
            value,
            if small { Around::Exact } else { Around::Unary },
        );
    }

    fn compare(&mut self, out: &mut String, op: CmpOp, a: ExprId, b: ExprId, around: Around) {
        let (op, a, b) = logic::comparison(self.module, op, a, b);
        let op = op.symbol();
        self.in_parentheses(out, around.needs_parentheses(op), |w, out| {
            w.expr(out, a, Around::Operand(op));
            let _ = write!(out, " {op} ");
            w.expr(out, b, Around::Operand(op));
        });
    }

    fn in_parentheses(
        &mut self,
        out: &mut String,
        yes: bool,
        write: impl FnOnce(&mut Self, &mut String),
    ) {
        if yes {
            out.push('(');
        }
        write(self, out);
        if yes {
            out.push(')');
        }
    }

    /// A chain of one operator on bits, written side by side.
    fn chain(&mut self, out: &mut String, id: ExprId, op: &'static str, around: Around) {
        let mut operands = Operands::new();
        let mut todo = Operands::from_slice(&[id]);
        while let Some(e) = todo.pop() {
            match *self.module.expr(e) {
                Expr::And(a, b) if op == "&" && (e == id || !self.named.contains_key(&e)) => {
                    todo.extend([b, a])
                }
                Expr::Or(a, b) if op == "|" && (e == id || !self.named.contains_key(&e)) => {
                    todo.extend([b, a])
                }
                _ => operands.push(e),
            }
        }
        // gcc takes `!a & (b | c)` for a slip; the other way round it is as good.
        if self.is_not(operands[0]) && !self.is_not(operands[1]) && self.is_compound(operands[1]) {
            operands.swap(0, 1);
        }
        let outside = self.numbers;
        self.numbers |= self.is_number(id);
        let enclose = around.needs_parentheses(op);
        let start = out.len();
        if enclose {
            out.push('(');
        }
        let mut written: SmallVec<[Operand; 8]> = SmallVec::new();
        for e in operands {
            // The same question need not be asked twice.
            let same = |other: &Operand| other.calls && logic::same(self.module, other.e, e);
            if written.iter().any(same) {
                continue;
            }
            if !written.is_empty() {
                out.push_str(if op == "&" { " & " } else { " | " });
            }
            let (from, calls) = (out.len(), self.calls);
            self.expr(out, e, Around::Operand(op));
            let calls = self.calls > calls;
            let text = from..out.len();
            written.push(Operand { e, text, calls });
        }
        self.numbers = outside;
        if enclose {
            out.push(')');
        }
        if written.iter().filter(|operand| operand.calls).count() > 1 || written.len() == 1 {
            let texts: Vec<&str> = written
                .into_iter()
                .map(|operand| &out[operand.text])
                .collect();
            let text = among_calls(&texts, op, around);
            out.truncate(start);
            out.push_str(&text);
        }
    }

    fn is_not(&self, e: ExprId) -> bool {
        matches!(self.module.expr(e), Expr::Not(_)) && !self.named.contains_key(&e)
    }

    fn is_compound(&self, e: ExprId) -> bool {
        matches!(self.module.expr(e), Expr::And(..) | Expr::Or(..)) && !self.named.contains_key(&e)
    }

    fn binary(
        &mut self,
        out: &mut String,
        id: ExprId,
        op: BinOp,
        (a, b): (ExprId, ExprId),
        around: Around,
    ) {
        let narrow = self.module.ty(id) == Ty::I16;
        if let Some(op) = bitwise(op) {
            let cast = around == Around::Exact && narrow;
            if cast {
                out.push_str("(int16_t)");
            }
            self.in_parentheses(out, cast || around.needs_parentheses(op), |w, out| {
                w.expr(out, a, Around::Operand(op));
                let _ = write!(out, " {op} ");
                w.expr(out, b, Around::Operand(op));
            });
            return;
        }
        // Operands that are known to be small enough cannot overflow in plain C arithmetic.
        let plain = arithmetic(op).filter(|op| !narrow && self.exact_bounds(op, a, b).is_some());
        if let Some(op) = plain {
            self.in_parentheses(out, around.needs_parentheses(op), |w, out| {
                // A word is an int, which may have 16 bits.
                if matches!(w.module.expr(a), Expr::Widen(_) | Expr::I32(_)) {
                    out.push_str("(int32_t)");
                    w.expr(out, a, Around::Unary);
                } else {
                    w.expr(out, a, Around::Operand(op));
                }
                let _ = write!(out, " {op} ");
                w.expr(out, b, Around::Operand(op));
            });
            return;
        }
        self.arithmetic_call(out, op, if narrow { "16(" } else { "32(" }, a, b);
    }

    fn arithmetic_call(&mut self, out: &mut String, op: BinOp, width: &str, a: ExprId, b: ExprId) {
        self.call_in(out).push_str(function(op));
        out.push_str(width);
        self.expr(out, a, Around::Exact);
        out.push_str(", ");
        self.expr(out, b, Around::Exact);
        out.push(')');
    }

    /// The low word. That of a sum of words is their 16-bit sum.
    fn narrow(&mut self, out: &mut String, a: ExprId, around: Around) {
        let unwiden = |e: ExprId| match *self.module.expr(e) {
            Expr::Widen(inner) => Some(inner),
            _ => None,
        };
        if !self.named.contains_key(&a) {
            if let Some(inner) = unwiden(a) {
                return self.expr(out, inner, around);
            }
            if let Expr::Bin(op @ (BinOp::Add | BinOp::Sub | BinOp::Mul), l, r) =
                *self.module.expr(a)
                && let (Some(l), Some(r)) = (self.word_of(l), self.word_of(r))
            {
                return self.arithmetic_call(out, op, "16(", l, r);
            }
        }
        self.call(out, "plc_low", a);
    }

    /// The word that a widened expression is made of; a small constant stands for itself.
    fn word_of(&self, e: ExprId) -> Option<ExprId> {
        match *self.module.expr(e) {
            Expr::Widen(inner) => Some(inner),
            Expr::I32(value) if i16::try_from(value).is_ok() => Some(e),
            _ => None,
        }
    }

    fn bit_to_int(&mut self, out: &mut String, a: ExprId, around: Around) {
        let plain = matches!(
            self.module.expr(a),
            Expr::ReadBit(_) | Expr::Temp(_) | Expr::Bit(_)
        ) || self.named.contains_key(&a);
        if plain || around != Around::Exact {
            return self.expr(
                out,
                a,
                if around == Around::Exact {
                    Around::Loose
                } else {
                    around
                },
            );
        }
        out.push_str("(int16_t)");
        self.expr(out, a, Around::Unary);
    }

    /// Bounds of the result of an operator, if they lie within 32 bits for all operands.
    fn exact_bounds(&self, op: &str, a: ExprId, b: ExprId) -> Option<Bounds> {
        let ((a0, a1), (b0, b1)) = (self.bounds(a, 3), self.bounds(b, 3));
        let (low, high) = match op {
            "+" => (a0 + b0, a1 + b1),
            "-" => (a0 - b1, a1 - b0),
            "*" => {
                let ends = [a0 * b0, a0 * b1, a1 * b0, a1 * b1];
                (*ends.iter().min()?, *ends.iter().max()?)
            }
            _ if b0 > 0 => (a0.min(0), a1.max(0)),
            // The divisor is not 0; only MIN / -1 does not fit.
            _ if a0 > I32.0 || b0 > -1 || b1 < -1 => (a0.min(-a1), a1.max(-a0)),
            _ => return None,
        };
        (low >= I32.0 && high <= I32.1).then_some((low, high))
    }

    /// Bounds of an integer expression, looking at most `depth` operators deep.
    fn bounds(&self, e: ExprId, depth: u32) -> Bounds {
        match *self.module.expr(e) {
            Expr::I16(value) => (value.into(), value.into()),
            Expr::I32(value) => (value.into(), value.into()),
            Expr::Widen(a) => self.bounds(a, depth),
            Expr::Within { value, low, high } => {
                let (least, most) = self.bounds(value, depth);
                (least.max(low.into()), most.min(high.into()))
            }
            Expr::BitToInt(_) => (0, 1),
            Expr::ReadNibbles { digits, .. } if digits < 4 => (0, (1 << (4 * digits)) - 1),
            Expr::Bin(BinOp::And, _, mask) if matches!(*self.module.expr(mask), Expr::I32(0..)) => {
                (0, self.bounds(mask, 0).1)
            }
            Expr::Bin(op, a, b) if depth > 0 && self.module.ty(e) == Ty::I32 => arithmetic(op)
                .and_then(|op| {
                    let ((a0, a1), (b0, b1)) =
                        (self.bounds(a, depth - 1), self.bounds(b, depth - 1));
                    match op {
                        "+" => Some((a0 + b0, a1 + b1)),
                        "-" => Some((a0 - b1, a1 - b0)),
                        _ => None,
                    }
                })
                .filter(|&(low, high)| low >= I32.0 && high <= I32.1)
                .unwrap_or(I32),
            _ if self.module.ty(e) == Ty::I16 => I16,
            _ => I32,
        }
    }

    /// The number of an indexed device, as an `int32_t`.
    pub fn number(&mut self, out: &mut String, place: &Place, plus: i32) {
        let base = i64::from(place.number) + i64::from(plus);
        let Some(index) = place.index else {
            let _ = write!(out, "{base}");
            return;
        };
        let (low, high) = self.bounds(index, 2);
        if base == 0 {
            self.expr(out, index, Around::Exact);
        } else if low + base >= I32.0 && high + base <= I32.1 {
            let _ = write!(out, "{base} + ");
            self.expr(out, index, Around::Operand("+"));
        } else {
            let _ = write!(self.call_in(out), "plc_add32({base}, ");
            self.expr(out, index, Around::Exact);
            out.push(')');
        }
    }

    fn in_range(&mut self, out: &mut String, place: &Place, count: u32) {
        if place.index.is_none() {
            let there = self
                .module
                .model
                .in_range(place.class, place.number.into(), count);
            out.push_str(if there { "true" } else { "false" });
            return;
        }
        self.helpers.has(place.class);
        let _ = write!(
            self.call_in(out),
            "{}_has_{}(",
            self.module.name,
            place.class.prefix()
        );
        self.number(out, place, 0);
        let _ = write!(out, ", {count})");
    }

    /// Reads of devices.
    fn read(&mut self, out: &mut String, id: ExprId, around: Around) {
        match *self.module.expr(id) {
            Expr::ReadBit(place) => self.read_bit(out, &place),
            Expr::ReadWordBit(place, bit) => {
                self.call_in(out).push_str("plc_bit(");
                self.word(out, &place, 0);
                let _ = write!(out, ", {bit}u)");
            }
            Expr::ReadWord(place) => self.word(out, &place, 0),
            Expr::ReadPair(place) => self.pair(out, &place),
            Expr::ReadFloat(place) => {
                self.call_in(out).push_str("plc_float(");
                self.pair(out, &place);
                out.push(')');
            }
            Expr::ReadNibbles {
                place,
                digits,
                wide,
            } => {
                let narrow = !wide && digits <= 4;
                if narrow && (digits == 4 || around == Around::Exact) {
                    self.call_in(out).push_str("plc_low(");
                    self.nibbles(out, &place, digits);
                    out.push(')');
                } else {
                    self.nibbles(out, &place, digits);
                }
            }
            _ => {}
        }
    }

    fn read_bit(&mut self, out: &mut String, place: &Place) {
        if self.invariant_of_rounds(out, place) {
            return;
        }
        let of_round = self.access_round(out, place);
        if place.index.is_some() && !of_round {
            return self.indexed_call(out, "bit", place, 0);
        }
        if !of_round && !self.fields.access(out, place.class, place.number) {
            out.push_str("false");
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".done");
        }
    }

    /// Writes the expression of a device of the present round of a loop; false for any other.
    pub fn access_round(&self, out: &mut String, place: &Place) -> bool {
        match place.index.map(|index| self.module.expr(index)) {
            Some(&Expr::Stride(_, by)) => {
                self.fields
                    .access_round(out, (place.class, place.number), by, &self.round)
            }
            _ => false,
        }
    }

    /// Reads the word `plus` places after `place`.
    pub fn word(&mut self, out: &mut String, place: &Place, plus: i32) {
        let of_round = plus == 0 && self.access_round(out, place);
        if place.index.is_some() && !of_round {
            return self.indexed_call(out, "word", place, plus);
        }
        let number = place.number.saturating_add_signed(plus);
        if !of_round && !self.fields.access(out, place.class, number) {
            out.push('0');
        } else if matches!(place.class, DeviceClass::T | DeviceClass::C) {
            out.push_str(".value");
        }
    }

    /// Where the high word of a pair is.
    pub fn high_word(&self, place: &Place) -> (Place, i32) {
        if place.class == DeviceClass::Z && self.module.model.z_pairs_with_v {
            (
                Place {
                    class: DeviceClass::V,
                    ..*place
                },
                0,
            )
        } else {
            (*place, 1)
        }
    }

    fn pair(&mut self, out: &mut String, place: &Place) {
        if place.index.is_some() && place.class == DeviceClass::C {
            return self.indexed_call(out, "long", place, 0);
        }
        if is_counter32(place.class, place.number) {
            return self.word(out, place, 0);
        }
        let (high, plus) = self.high_word(place);
        self.call_in(out).push_str("plc_join(");
        self.word(out, &high, plus);
        out.push_str(", ");
        self.word(out, place, 0);
        out.push(')');
    }

    fn nibbles(&mut self, out: &mut String, place: &Place, digits: u8) {
        let count = 4 * u32::from(digits);
        if place.index.is_some() {
            self.helpers.bits(place.class);
            let _ = write!(
                self.call_in(out),
                "{}_bits_{}(plc, ",
                self.module.name,
                place.class.prefix()
            );
            self.number(out, place, 0);
            let _ = write!(out, ", {count}u)");
        } else if self
            .fields
            .array(place.class, place.number, count)
            .is_some()
        {
            self.call_in(out).push_str("plc_bits(&");
            self.fields.access(out, place.class, place.number);
            let _ = write!(out, ", {count}u)");
        } else {
            // Relays that are no array: their states side by side.
            self.call_in(out).push_str("plc_bits((const bool[]){");
            for bit in 0..count {
                out.push_str(if bit > 0 { ", " } else { "" });
                self.read_bit(
                    out,
                    &Place {
                        number: place.number + bit,
                        ..*place
                    },
                );
            }
            let _ = write!(out, "}}, {count}u)");
        }
    }

    /// A read through the program's function for indexed access.
    fn indexed_call(&mut self, out: &mut String, what: &'static str, place: &Place, plus: i32) {
        self.helpers.get(what, place.class);
        let _ = write!(
            self.call_in(out),
            "{}_{what}_{}(plc, ",
            self.module.name,
            place.class.prefix()
        );
        self.number(out, place, plus);
        out.push(')');
    }
}
