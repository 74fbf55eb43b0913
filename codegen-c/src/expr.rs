//! Expressions as C.

use crate::code::{Code, Mark};
use crate::text;
use crate::writer::Writer;
use rungc_emit::{bounds, logic};
use rungc_ir::node::{BinOp, Expr, ExprId, Place, SysValue, Ty};
use rungc_rt::CmpOp;
use smallvec::SmallVec;
use std::fmt::Write;

/// Operands of a chain; most are short.
type Operands = SmallVec<[ExprId; 8]>;

/// An operand of a chain that has been written.
struct Operand {
    e: ExprId,
    /// Start and end.
    from: Mark,
    to: Mark,
    /// True if it calls functions.
    calls: bool,
}

/// Context of an expression: decides on parentheses and casts.
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
    /// The same where an `int` will do as well.
    fn loosely(self) -> Self {
        if self == Around::Exact {
            Around::Loose
        } else {
            self
        }
    }

    /// Returns true if an expression made with `op` needs parentheses here. More than C asks for: compilers warn where
    /// readers may err.
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

/// The infix operator of a bitwise operation.
fn bitwise(op: BinOp) -> Option<&'static str> {
    match op {
        BinOp::And => Some("&"),
        BinOp::Or => Some("|"),
        BinOp::Xor => Some("^"),
        BinOp::Add
        | BinOp::Sub
        | BinOp::Mul
        | BinOp::MulHigh
        | BinOp::Div
        | BinOp::Rem
        | BinOp::SatAdd
        | BinOp::SatSub
        | BinOp::Min
        | BinOp::Max
        | BinOp::RotateLeft => None,
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
        BinOp::MulHigh
        | BinOp::And
        | BinOp::Or
        | BinOp::Xor
        | BinOp::SatAdd
        | BinOp::SatSub
        | BinOp::Min
        | BinOp::Max
        | BinOp::RotateLeft => None,
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
        BinOp::Min => "plc_min",
        BinOp::Max => "plc_max",
        BinOp::And => "plc_and",
        BinOp::Or => "plc_or",
        BinOp::Xor => "plc_xor",
        BinOp::RotateLeft => "plc_rotate",
    }
}

/// Joins the operands of a chain of which some call functions, or of which one operand is left.
fn join_calls(out: &mut Code, operands: &[Code], op: &str, around: Around) {
    // Of several calls only those are made that matter, and clang would suspect a slip.
    let op = if op == "&" { "&&" } else { "||" };
    let enclose = operands.len() > 1 && around.needs_parentheses(op);
    if enclose {
        out.open("(");
    }
    for (i, operand) in operands.iter().enumerate() {
        if i > 0 {
            out.operator(op);
        }
        out.append(operand);
    }
    if enclose {
        out.close(")");
    }
}

/// Writes an integer constant; the smallest ones have no literal in C.
pub fn integer(out: &mut String, value: i32) {
    match value {
        i32::MIN => out.push_str("INT32_MIN"),
        value => text::push_number(out, value),
    }
}

/// Writes a member of the struct.
fn member(out: &mut String, name: &str) {
    out.push_str("plc->");
    out.push_str(name);
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
    pub fn expr(&mut self, out: &mut Code, id: ExprId, around: Around) {
        if let Some(named) = self.named.get(&id) {
            self.calls += u64::from(named.calls);
            out.append(&named.code);
            return;
        }
        let module = self.module;
        match module.expr(id) {
            Expr::Bit(on) => out.push_str(if *on { "true" } else { "false" }),
            Expr::I16(value) => integer(out.text(), (*value).into()),
            Expr::I32(value) => integer(out.text(), *value),
            Expr::F32(value) => {
                self.calls += u64::from(!value.is_finite());
                float(out.text(), *value);
            }
            Expr::Temp(temp) => self.temp(out.text(), *temp),
            Expr::Read(access) => self.read(out, access, around),
            Expr::Cell(cell) => member(out.text(), &module.cells[*cell].name),
            Expr::Entry(table, index) => {
                let _ = write!(out.text(), "plc->{}[", module.tables[*table].name);
                self.expr(out, *index, Around::Exact);
                out.push_str("]");
            }
            Expr::Stride(_, by) => {
                let _ = write!(out.text(), "{by} * (int32_t){}", self.iteration);
            }
            Expr::Flag(flag) => member(out.text(), &module.flags[*flag].name),
            Expr::Sys(value) => self.sys(out, *value),
            Expr::Not(a) => self.not(out, *a, around),
            Expr::And(..) => self.chain(out, id, "&", around),
            Expr::Or(..) => self.chain(out, id, "|", around),
            Expr::Cmp(op, a, b) => self.compare(out, *op, *a, *b, around),
            Expr::Bin(op, a, b) => self.binary(out, id, *op, (*a, *b), around),
            Expr::Un(op, a) => {
                let function = op.name(module.ty(*a));
                self.call(out, &format!("plc_{function}"), *a);
            }
            Expr::Float(op, a, b) => self.call_of_two(out, "plc_", op.name(), (*a, *b)),
            Expr::Complement(a) => {
                self.int16_of(out, id, around, |w, out| {
                    out.push_str("~");
                    w.expr(out, *a, Around::Unary);
                });
            }
            Expr::Neg(a) => self.neg(out, *a),
            Expr::Widen(a) => self.expr(out, *a, around.loosely()),
            Expr::Within { value, .. } => self.expr(out, *value, around),
            Expr::Narrow(a) => self.narrow(out, *a, around),
            Expr::HighWord(a) => self.call(out, "plc_high", *a),
            Expr::BitToInt(a) => self.bit_to_int(out, *a, around),
            Expr::InRange {
                place,
                count,
                length,
            } => self.in_range(out, place, *count, *length),
        }
    }

    fn sys(&mut self, out: &mut Code, value: SysValue) {
        out.push_str(match value {
            SysValue::Running => "plc->sys.running",
            SysValue::FirstScan => "plc->sys.first_scan",
            SysValue::NowMs => self.called("plc_int32(plc->sys.now_ms)"),
            SysValue::MinuteMs => self.called("(int32_t)plc->sys.minute_ms"),
            SysValue::SinceScanMs => self.called("plc_int32(plc->sys.dt_ms)"),
            SysValue::Scan100us => self.called("plc_int32(plc->sys.scan_us / 100u)"),
        });
    }

    fn neg(&mut self, out: &mut Code, a: ExprId) {
        let function = match self.module.ty(a) {
            Ty::I16 => "plc_sub16(",
            Ty::I32 | Ty::Bit | Ty::F32 => "plc_sub32(",
        };
        self.call_in(out).open(function);
        out.push_str("0");
        out.comma();
        self.expr(out, a, Around::Exact);
        out.close(")");
    }

    fn call_of_two(
        &mut self,
        out: &mut Code,
        family: &str,
        function: &str,
        (a, b): (ExprId, ExprId),
    ) {
        self.call_in(out).push_str(family);
        out.push_str(function);
        out.open("(");
        self.expr(out, a, Around::Exact);
        out.comma();
        self.expr(out, b, Around::Exact);
        out.close(")");
    }

    /// Counts a call of a function, and returns the output to write it to.
    pub(crate) fn call_in<'o>(&mut self, out: &'o mut Code) -> &'o mut Code {
        self.calls += 1;
        out
    }

    /// The text of a call.
    fn called(&mut self, text: &'static str) -> &'static str {
        self.calls += 1;
        text
    }

    fn call(&mut self, out: &mut Code, function: &str, argument: ExprId) {
        self.call_in(out).push_str(function);
        out.open("(");
        self.expr(out, argument, Around::Exact);
        out.close(")");
    }

    /// Writes an operation on `int` as what `id` is: with a cast if it is an `I16` and its type is looked at.
    fn int16_of(
        &mut self,
        out: &mut Code,
        id: ExprId,
        around: Around,
        write: impl FnOnce(&mut Self, &mut Code),
    ) {
        if around != Around::Exact || self.module.ty(id) != Ty::I16 {
            return write(self, out);
        }
        out.push_str("(int16_t)");
        write(self, out);
    }

    fn not(&mut self, out: &mut Code, a: ExprId, around: Around) {
        match self.opposite(a) {
            Some((op, l, r)) => self.compare(out, op, l, r, around),
            None if self.numbers || self.is_number(a) => {
                self.in_parentheses(out, around != Around::Exact, |w, out| {
                    w.expr(out, a, Around::Operand("^"));
                    out.push_str(" ^ 1");
                })
            }
            None => {
                out.push_str("!");
                self.expr(out, a, Around::Unary);
            }
        }
    }

    /// Returns true if a `Bit` is written as an integer: one from an array of columns, or made of such.
    fn is_number(&self, e: ExprId) -> bool {
        let known = |e: ExprId| {
            let is_named = self.named.contains_key(&e);
            let Some(place) = self.module.expr(e).as_bit() else {
                return is_named.then_some(false);
            };
            Some(!is_named && self.fields.is_numeric_bit(place.class, place.number))
        };
        !self.module.layout.grids.is_empty() && logic::is_number(self.module, e, &known)
    }

    /// The comparison that stands for the opposite of an expression, if one does.
    fn opposite(&self, a: ExprId) -> Option<(CmpOp, ExprId, ExprId)> {
        let is_named = self.named.contains_key(&a);
        logic::opposite(self.module, a).filter(|_| !is_named)
    }

    /// Writes a value for an element of an array of columns.
    pub(crate) fn grid_value(&mut self, out: &mut Code, value: ExprId) {
        let expr = self.module.expr(value);
        let small = expr.as_bit().is_some()
            || matches!(
                expr,
                Expr::And(..) | Expr::Or(..) | Expr::Not(_) | Expr::Bit(_)
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

    fn compare(&mut self, out: &mut Code, op: CmpOp, a: ExprId, b: ExprId, around: Around) {
        let (op, a, b) = logic::comparison(self.module, op, a, b);
        let op = op.symbol();
        self.in_parentheses(out, around.needs_parentheses(op), |w, out| {
            w.expr(out, a, Around::Operand(op));
            out.operator(op);
            w.expr(out, b, Around::Operand(op));
        });
    }

    fn in_parentheses(
        &mut self,
        out: &mut Code,
        yes: bool,
        write: impl FnOnce(&mut Self, &mut Code),
    ) {
        if yes {
            out.open("(");
        }
        write(self, out);
        if yes {
            out.close(")");
        }
    }

    /// A chain of one operator on bits, written side by side.
    fn chain(&mut self, out: &mut Code, id: ExprId, op: &'static str, around: Around) {
        let mut operands = Operands::new();
        let mut todo = Operands::from_slice(&[id]);
        while let Some(e) = todo.pop() {
            let is_named = e != id && self.named.contains_key(&e);
            match (op, *self.module.expr(e)) {
                ("&", Expr::And(a, b)) | ("|", Expr::Or(a, b)) if !is_named => {
                    todo.extend([b, a]);
                }
                _ => operands.push(e),
            }
        }
        // gcc takes `!a & (b | c)` for a slip; the other way around it is as good.
        if self.is_not(operands[0]) && !self.is_not(operands[1]) && self.is_compound(operands[1]) {
            operands.swap(0, 1);
        }
        let outside = self.numbers;
        self.numbers |= self.is_number(id);
        let enclose = around.needs_parentheses(op);
        let start = out.mark();
        if enclose {
            out.open("(");
        }
        let mut written: SmallVec<[Operand; 8]> = SmallVec::new();
        for e in operands {
            // The same question need not be checked twice.
            let same = |other: &Operand| other.calls && logic::same(self.module, other.e, e);
            if written.iter().any(same) {
                continue;
            }
            if !written.is_empty() {
                out.operator(op);
            }
            let (from, calls) = (out.mark(), self.calls);
            self.expr(out, e, Around::Operand(op));
            let calls = self.calls > calls;
            let to = out.mark();
            written.push(Operand { e, from, to, calls });
        }
        self.numbers = outside;
        if written.iter().filter(|operand| operand.calls).count() > 1 || written.len() == 1 {
            let operands = written.into_iter().rev().map(|operand| {
                out.back_to(operand.to);
                out.take(operand.from)
            });
            let mut operands: Vec<Code> = operands.collect();
            operands.reverse();
            out.back_to(start);
            join_calls(out, &operands, op, around);
        } else if enclose {
            out.close(")");
        }
    }

    fn is_not(&self, e: ExprId) -> bool {
        matches!(self.module.expr(e), Expr::Not(_)) && !self.named.contains_key(&e)
    }

    pub(crate) fn is_compound(&self, e: ExprId) -> bool {
        matches!(self.module.expr(e), Expr::And(..) | Expr::Or(..)) && !self.named.contains_key(&e)
    }

    fn binary(
        &mut self,
        out: &mut Code,
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
                out.operator(op);
                w.expr(out, b, Around::Operand(op));
            });
            return;
        }
        // Operands that are known to be small enough cannot overflow in plain C arithmetic.
        let plain = arithmetic(op).filter(|_| !narrow && bounds::is_exact(self.module, op, a, b));
        if let Some(op) = plain {
            self.in_parentheses(out, around.needs_parentheses(op), |w, out| {
                // A word is an int, which may have 16 bits.
                if matches!(w.module.expr(a), Expr::Widen(_) | Expr::I32(_)) {
                    out.push_str("(int32_t)");
                    w.expr(out, a, Around::Unary);
                } else {
                    w.expr(out, a, Around::Operand(op));
                }
                out.operator(op);
                w.expr(out, b, Around::Operand(op));
            });
            return;
        }
        self.call_of_two(out, function(op), if narrow { "16" } else { "32" }, (a, b));
    }

    /// The low word. That of a sum of words is their 16-bit sum.
    fn narrow(&mut self, out: &mut Code, a: ExprId, around: Around) {
        if !self.named.contains_key(&a) {
            if let Expr::Widen(inner) = *self.module.expr(a) {
                return self.expr(out, inner, around);
            }
            if let Expr::Bin(op @ (BinOp::Add | BinOp::Sub | BinOp::Mul), l, r) =
                *self.module.expr(a)
                && let (Some(l), Some(r)) = (self.word_of(l), self.word_of(r))
            {
                return self.call_of_two(out, function(op), "16", (l, r));
            }
        }
        self.call(out, "plc_low", a);
    }

    /// The word that a widened expression is made of; a small constant stands for itself.
    fn word_of(&self, e: ExprId) -> Option<ExprId> {
        let expr = *self.module.expr(e);
        if let Expr::Widen(inner) = expr {
            return Some(inner);
        }
        matches!(expr, Expr::I32(value) if i16::try_from(value).is_ok()).then_some(e)
    }

    fn bit_to_int(&mut self, out: &mut Code, a: ExprId, around: Around) {
        let expr = self.module.expr(a);
        let plain = expr.as_bit().is_some()
            || matches!(expr, Expr::Temp(_) | Expr::Bit(_))
            || self.named.contains_key(&a);
        if plain || around != Around::Exact {
            return self.expr(out, a, around.loosely());
        }
        out.push_str("(int16_t)");
        self.expr(out, a, Around::Unary);
    }

    /// The number of an indexed device, as an `int32_t`.
    pub fn number(&mut self, out: &mut Code, place: &Place) {
        let base = i64::from(place.number);
        let Some(index) = place.index else {
            let _ = write!(out.text(), "{base}");
            return;
        };
        let (low, high) = bounds::of(self.module, index, 2);
        if base == 0 {
            self.expr(out, index, Around::Exact);
        } else if bounds::fits((low + base, high + base)) {
            let _ = write!(out.text(), "{base} + ");
            self.expr(out, index, Around::Operand("+"));
        } else {
            self.call_in(out).open("plc_add32(");
            out.push_str(&base.to_string());
            out.comma();
            self.expr(out, index, Around::Exact);
            out.close(")");
        }
    }

    fn in_range(&mut self, out: &mut Code, place: &Place, count: u32, length: Option<ExprId>) {
        if place.index.is_none() && length.is_none() {
            let there = self
                .module
                .model
                .in_range(place.class, place.number.into(), count);
            out.push_str(if there { "true" } else { "false" });
            return;
        }
        self.helpers.has(place.class);
        let class = place.class.prefix();
        let _ = write!(self.call_in(out).text(), "{}_has_{class}", self.module.name);
        out.open("(");
        self.number(out, place);
        match length {
            None => out.argument(count),
            Some(length) => {
                out.comma();
                self.expr(out, length, Around::Exact);
            }
        }
        out.close(")");
    }
}
