//! Types of expressions, and the instructions that compute numbers.

use crate::ast::{Arg, Expr, ExprKind, Op};
use crate::convert::{self, Steps};
use crate::emit::{Compiler, Made, both, fail, relay};
use crate::fold;
use crate::functions;
use crate::labels::value_in;
use crate::literal::{Const, Literal};
use crate::texts;
use crate::types::{Fit, Ty};
use rungc_syntax::{Device, Operand, OperandKind, Span, codes, phrase};

impl Compiler<'_> {
    /// The type of an expression.
    pub(crate) fn ty(&self, expr: &Expr) -> Made<Ty> {
        if let Some((_, ty)) = self.constant(expr)? {
            return Ok(ty);
        }
        if let Some(text) = self.literal_text(expr)? {
            return Ok(Ty::Text(text.chars().count() as u16));
        }
        match &expr.kind {
            ExprKind::Number(text) | ExprKind::Typed(text) => not_a_value(text, expr.span),
            ExprKind::Unread | ExprKind::Initial(_) => Err(Vec::new()),
            ExprKind::Call(of, args) => self.type_of_call(of, args, expr),
            ExprKind::Not(of) => opposite(self.ty(of)?, of.span),
            ExprKind::Neg(of) => negative(self.ty(of)?, expr.span),
            ExprKind::Binary(op, left, right) => self.type_of_binary(*op, left, right),
            _ => Ok(self.place(expr)?.map_or(Ty::Raw16, |place| place.ty)),
        }
    }

    fn type_of_binary(&self, op: Op, left: &Expr, right: &Expr) -> Made<Ty> {
        let types = both(self.ty(left), self.ty(right))?;
        self.type_of_pair(op, types, (left, right))
    }

    /// The type of an operation with operands of these types.
    fn type_of_pair(&self, op: Op, (a, b): (Ty, Ty), (left, right): (&Expr, &Expr)) -> Made<Ty> {
        let span = left.span.to(right.span);
        if op == Op::Power {
            return fail(codes::ST_UNSUPPORTED.at(span, "`**` is not compiled yet"));
        }
        let logic = matches!(op, Op::And | Op::Or | Op::Xor);
        if (logic || matches!(op, Op::Eq | Op::Ne))
            && a.is_bit()
            && b.is_bit()
            && (a == Ty::Bool || b == Ty::Bool || logic)
        {
            return Ok(Ty::Bool);
        }
        let misfit = || {
            let error = codes::ST_TYPE.at(
                span,
                phrase!("`{sign}` joins {a} and {b}", a, b, sign = op.sign()),
            );
            let error = error
                .other(left.span, phrase!("this is {given}", given = a))
                .other(right.span, phrase!("this is {given}", given = b));
            let converts = a.conversion(b).or_else(|| b.conversion(a));
            fail(match converts {
                Some(function) => {
                    error.help(phrase!("convert one side: `{function}(…)`", function))
                }
                None => error,
            })
        };
        let Some(ty) = a.common(b).filter(|ty| *ty != Ty::Bool) else {
            return misfit();
        };
        if ty.is_text() && !matches!(op, Op::Eq | Op::Ne) {
            let what = phrase!("`{sign}` does not take texts", sign = op.sign());
            let error = codes::ST_TYPE.at(span, what);
            return fail(
                error.help("texts are compared by `=` and `<>`, and joined by `CONCAT(a, b)`"),
            );
        }
        if (logic || op == Op::Mod) && !ty.is_whole() {
            return misfit();
        }
        if matches!(op, Op::Div | Op::Mod)
            && let Some((Const::Int(0), _)) = fold::constant(&self.labels, right)
        {
            let error = codes::ST_ZERO.at(span, "this divides by 0");
            return fail(error.other(right.span, "the constant 0"));
        }
        Ok(if op.compares() { Ty::Bool } else { ty })
    }

    /// The only argument of a call.
    pub(crate) fn only<'e>(&self, name: &str, args: &'e [Arg], expr: &Expr) -> Made<&'e Expr> {
        match args {
            [arg] => Ok(&arg.value),
            _ => {
                let what = phrase!(
                    "`{name}` takes one argument, and {given} are given",
                    name,
                    given = args.len()
                );
                fail(codes::ST_ARGUMENTS.at(expr.span, what))
            }
        }
    }

    fn type_of_call(&self, of: &Expr, args: &[Arg], expr: &Expr) -> Made<Ty> {
        let name = of.name().unwrap_or_default();
        if let Some(function) = self.functions.get(&name.to_uppercase()) {
            return self.type_of_result(function, expr);
        }
        if let Some((from, to, _)) = convert::find(name) {
            let arg = self.only(name, args, expr)?;
            let ty = self.ty(arg)?;
            if ty.fit(from) != Fit::Fits {
                let what = phrase!("`{name}` takes {from}, and this is {ty}", name, from, ty);
                return fail(codes::ST_TYPE.at(arg.span, what));
            }
            return Ok(to);
        }
        if is_edge(name) {
            self.expect(self.only(name, args, expr)?, Ty::Bool)?;
            return Ok(Ty::Bool);
        }
        if let Some(function) = functions::find(name) {
            return self.type_of_function(function, args, expr);
        }
        if let Some(function) = texts::find(name) {
            return self.type_of_text(function, args, expr);
        }
        fail(functions::unknown(name, of))
    }

    /// The value of a constant expression.
    pub(crate) fn constant(&self, expr: &Expr) -> Made<Option<Literal>> {
        Ok(fold::constant(&self.labels, expr))
    }

    /// Holds an expression to a type.
    pub(crate) fn expect(&self, expr: &Expr, ty: Ty) -> Made<()> {
        if let Some(literal) = self.constant(expr)? {
            return value_in(literal, ty, expr.span)
                .map(drop)
                .map_err(|error| vec![*error]);
        }
        let of = self.ty(expr)?;
        let help = |error: rungc_syntax::Diagnostic| match of.conversion(ty) {
            _ if ty == Ty::Bool => error.help("compare it with something, such as `<> 0`"),
            _ if of.is_text() && ty.is_text() => match ty {
                Ty::Text(most) => error.help(phrase!("cut it: `LEFT(…, {most})`", most)),
                _ => error,
            },
            Some(function) => error.help(phrase!("write `{function}(…)`", function)),
            None => error,
        };
        let what = phrase!(
            "this is {given}, where {expected} is expected",
            given = of,
            expected = ty
        );
        match of.fit(ty) {
            Fit::Fits => Ok(()),
            Fit::Loses => fail(help(codes::ST_LOSES.at(expr.span, what))),
            Fit::Converts | Fit::Unlike => fail(help(codes::ST_TYPE.at(expr.span, what))),
        }
    }

    /// An operand with the value of an expression, which is computed before if it has to be.
    pub(crate) fn operand(&mut self, expr: &Expr, ty: Ty) -> Made<Operand> {
        self.expect(expr, ty)?;
        let span = expr.span;
        if let Some(literal) = self.constant(expr)? {
            if ty == Ty::Real {
                // Models without it take no constants of floats elsewhere either.
                self.need("DEMOV", span)?;
            }
            let value = value_in(literal, ty, span).map_err(|error| vec![*error])?;
            let kind = match value {
                Const::Int(value) if ty != Ty::Real && fold::is_hexadecimal(&self.labels, expr) => {
                    u64::try_from(value)
                        .ok()
                        .map(|value| OperandKind::Hex(value, None))
                }
                value => constant_operand(value, ty),
            };
            return kind.map(|kind| Operand { span, kind }).ok_or_else(|| {
                vec![codes::ST_LITERAL.at(span, "the PLC has no such floating-point number")]
            });
        }
        if let Some(text) = self.literal_text(expr)? {
            return self.text_operand(&text, span);
        }
        if let Some(place) = self.place(expr)? {
            return self.reached(&place, span);
        }
        let kind = self.compute(expr, ty, None)?;
        Ok(Operand { span, kind })
    }

    /// As [`Self::operand`], one that keeps its value while others are computed.
    pub(crate) fn kept_operand(&mut self, expr: &Expr, ty: Ty) -> Made<Operand> {
        self.expect(expr, ty)?;
        match self.place(expr)? {
            Some(place) if place.is_variable() => self.kept(&place, expr.span),
            _ => self.operand(expr, ty),
        }
    }

    /// Computes an expression under a rung that is always on, into a target or a temporary; gives the device that
    /// holds it.
    pub(crate) fn compute(
        &mut self,
        expr: &Expr,
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        if self.constant(expr)?.is_some() {
            let result = self.operand(expr, ty)?.kind;
            return self.moved(result, ty, target);
        }
        match &expr.kind {
            ExprKind::Binary(op, left, right) => self.binary(*op, (left, right), ty, target),
            ExprKind::Neg(of) => {
                let operand = self.operand(of, ty)?;
                let zero = match ty {
                    Ty::Real => OperandKind::Float(0.0),
                    _ => OperandKind::Decimal(0, None),
                };
                let zero = self.here(zero);
                self.direct("SUB", ty, [zero, operand], target)
            }
            ExprKind::Call(of, args) => {
                let name = of.name().unwrap_or_default();
                if let Some(function) = self.functions.get(&name.to_uppercase()).cloned() {
                    return self.result(&function, args, expr, target);
                }
                if let Some(conversion) = convert::find(name) {
                    return self.converted(conversion, &args[0].value, target);
                }
                if let Some(function) = functions::find(name) {
                    return self.function(function, args, ty, target);
                }
                match texts::find(name) {
                    Some(function) => {
                        let ty = self.ty(expr)?;
                        self.text_function((function, ty), args, expr, target)
                    }
                    None => fail(functions::unknown(name, of)),
                }
            }
            _ => {
                let result = self.operand(expr, ty)?.kind;
                self.moved(result, ty, target)
            }
        }
    }

    /// An operation that writes its result straight into the target.
    pub(crate) fn direct(
        &mut self,
        name: &str,
        ty: Ty,
        operands: [Operand; 2],
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let result = match target {
            Some(target) => target.clone(),
            None => {
                let temporary = self.temporary(ty.words())?;
                self.here(OperandKind::Device(temporary, None))
            }
        };
        let kind = result.kind.clone();
        let [first, second] = operands;
        self.always(&Self::sized(name, ty), [first, second, result]);
        Ok(kind)
    }

    /// Copies a result into the target, if there is one.
    pub(crate) fn moved(
        &mut self,
        result: OperandKind,
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let Some(target) = target else {
            return Ok(result);
        };
        let source = self.here(result);
        self.always(&Self::sized("MOV", ty), [source, target.clone()]);
        Ok(target.kind.clone())
    }

    fn binary(
        &mut self,
        op: Op,
        (left, right): (&Expr, &Expr),
        ty: Ty,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        let first = match changes_index(right) {
            true => self.kept_operand(left, ty),
            false => self.operand(left, ty),
        };
        let (a, b) = both(first, self.operand(right, ty))?;
        if matches!(op, Op::Div | Op::Mod) && ty.is_unsigned() {
            return self.unsigned_quotient(op, [a, b], ty, target);
        }
        let direct = match op {
            Op::Add => Some("ADD"),
            Op::Sub => Some("SUB"),
            Op::Mul if ty == Ty::Real => Some("MUL"),
            Op::Div if ty == Ty::Real => Some("DIV"),
            Op::And => Some("WAND"),
            Op::Or => Some("WOR"),
            Op::Xor => Some("WXOR"),
            _ => None,
        };
        if let Some(name) = direct {
            return self.direct(name, ty, [a, b], target);
        }
        let words = ty.words();
        let temporary = self.temporary(2 * words)?;
        let result = self.here(OperandKind::Device(temporary, None));
        let name = if op == Op::Mul { "MUL" } else { "DIV" };
        self.always(&Self::sized(name, ty), [a, b, result]);
        let number = match op {
            Op::Mod => temporary.number + words,
            _ => temporary.number,
        };
        let result = OperandKind::Device(
            Device {
                number,
                ..temporary
            },
            None,
        );
        self.moved(result, ty, target)
    }

    /// Converts a value into a target or a temporary; gives the device that holds it.
    fn converted(
        &mut self,
        (from, to, steps): convert::Conversion,
        arg: &Expr,
        target: Option<&Operand>,
    ) -> Made<OperandKind> {
        if steps == Steps::FromBit {
            return self.bit_value(arg, to, target);
        }
        let source = self.operand(arg, from)?;
        if steps == Steps::Low && !matches!(source.kind, OperandKind::Device(..)) {
            let what = phrase!("a constant or a group of bits is not converted to 16 bits");
            let error = codes::ST_UNSUPPORTED.at(arg.span, what);
            return fail(error.help("assign it to a label first"));
        }
        // A multiplication and the two halves of a double word need a separate place.
        let own = matches!(steps, Steps::Sign | Steps::Zero);
        let result = match target.filter(|_| !own) {
            Some(target) => target.clone(),
            None => {
                let temporary = self.temporary(to.words())?;
                self.here(OperandKind::Device(temporary, None))
            }
        };
        let kind = result.kind.clone();
        match steps {
            Steps::Same | Steps::Low => self.always(&Self::sized("MOV", to), [source, result]),
            Steps::Sign => {
                let one = self.here(OperandKind::Decimal(1, None));
                self.always("MUL", [one, source, result]);
            }
            Steps::Zero => {
                let mut upper = result.clone();
                if let OperandKind::Device(device, _) = &mut upper.kind {
                    device.number += 1;
                }
                self.always("MOV", [source, result]);
                self.push("RST", [upper]);
            }
            Steps::Float(name) => self.always(name, [source, result]),
            Steps::ToFloat(name) => {
                let whole = self.here(relay(8023));
                self.always("RST", [whole]);
                self.push(name, [source, result]);
            }
            Steps::FromBit | Steps::ToBit => {}
        }
        match target.filter(|_| own) {
            Some(target) => self.moved(kind, to, Some(target)),
            None => Ok(kind),
        }
    }
}

fn not_a_value(text: &str, span: Span) -> Made<Ty> {
    fail(codes::ST_LITERAL.at(span, phrase!("`{text}` is not a value", text)))
}

/// The type of the opposite of a condition.
fn opposite(ty: Ty, span: Span) -> Made<Ty> {
    match ty {
        ty if ty.is_bit() => Ok(Ty::Bool),
        _ => {
            let what = phrase!("NOT takes a BOOL, and this is {ty}", ty);
            fail(codes::ST_TYPE.at(span, what))
        }
    }
}

/// The type of a number with the other sign.
fn negative(ty: Ty, span: Span) -> Made<Ty> {
    match ty {
        Ty::Bool | Ty::Word | Ty::Dword | Ty::Text(_) => {
            fail(codes::ST_TYPE.at(span, phrase!("{ty} has no negative values", ty)))
        }
        ty => Ok(ty),
    }
}

/// Returns true if the computation of an expression may change Z0, or call a function.
pub(crate) fn changes_index(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Index(of, indexes) => {
            let is_constant = |index: &Expr| matches!(index.kind, ExprKind::Number(_));
            !indexes.iter().all(is_constant) || changes_index(of)
        }
        ExprKind::Member(of, _) | ExprKind::Not(of) | ExprKind::Neg(of) => changes_index(of),
        ExprKind::Binary(_, left, right) => changes_index(left) || changes_index(right),
        ExprKind::Call(of, args) => {
            let name = of.name().unwrap_or_default();
            let is_known = convert::find(name).is_some()
                || functions::find(name).is_some()
                || texts::find(name).is_some();
            !is_known || args.iter().any(|arg| changes_index(&arg.value))
        }
        _ => false,
    }
}

/// Instructions that detect an edge of a condition.
pub(crate) fn is_edge(name: &str) -> bool {
    name.eq_ignore_ascii_case("MEP") || name.eq_ignore_ascii_case("MEF")
}

/// A constant as an operand.
pub(crate) fn constant_operand(value: Const, ty: Ty) -> Option<OperandKind> {
    Some(match value {
        Const::Real(value) => OperandKind::float(value as f32)?,
        Const::Int(value) if ty == Ty::Real => OperandKind::float(value as f32)?,
        // Above the largest signed number, the same bits.
        Const::Int(value) if !ty.is_wide() && value > i64::from(i16::MAX) => {
            OperandKind::Hex(value as u64, None)
        }
        Const::Int(value) if value > i64::from(i32::MAX) => OperandKind::Hex(value as u64, None),
        Const::Int(value) => OperandKind::Decimal(value, None),
        Const::Bool(value) => OperandKind::Decimal(value.into(), None),
    })
}
