//! Expressions whose value is known when a program is compiled.

use crate::ast::{Expr, ExprKind, Op};
use crate::device;
use crate::labels::{Labels, Stored};
use crate::literal::{self, Const, Literal};
use crate::types::Ty;

/// The value of a constant, of a label that is one, and of arithmetic of these.
pub(crate) fn constant(labels: &Labels, expr: &Expr) -> Option<Literal> {
    match &expr.kind {
        ExprKind::Number(text) => literal::number(text),
        ExprKind::Typed(text) => literal::typed(text),
        ExprKind::Name(name) => match labels.get(name) {
            Some(label) => match label.stored {
                Stored::Constant(value) => Some((value, label.of.plain()?)),
                _ => None,
            },
            None if name.eq_ignore_ascii_case("TRUE") => Some((Const::Bool(true), Ty::Bool)),
            None if name.eq_ignore_ascii_case("FALSE") => Some((Const::Bool(false), Ty::Bool)),
            None => device::constant(name),
        },
        ExprKind::Member(of, fraction) => device::float(of.name()?, fraction),
        ExprKind::Neg(of) => match constant(labels, of)? {
            (Const::Int(value), ty) => Some((Const::Int(value.checked_neg()?), ty)),
            (Const::Real(value), ty) => Some((Const::Real(-value), ty)),
            _ => None,
        },
        ExprKind::Not(of) => match constant(labels, of)? {
            (Const::Bool(value), ty) => Some((Const::Bool(!value), ty)),
            _ => None,
        },
        ExprKind::Binary(op, left, right) => {
            let (left, right) = (constant(labels, left)?, constant(labels, right)?);
            let ty = left.1.common(right.1)?;
            let value = match (left.0, right.0) {
                (Const::Int(a), Const::Int(b)) => Const::Int(whole(*op, a, b)?),
                (Const::Real(a), Const::Real(b)) => Const::Real(real(*op, a, b)?),
                (Const::Int(a), Const::Real(b)) => Const::Real(real(*op, a as f64, b)?),
                (Const::Real(a), Const::Int(b)) => Const::Real(real(*op, a, b as f64)?),
                _ => return None,
            };
            Some((value, ty))
        }
        _ => None,
    }
}

fn whole(op: Op, a: i64, b: i64) -> Option<i64> {
    match op {
        Op::Add => a.checked_add(b),
        Op::Sub => a.checked_sub(b),
        Op::Mul => a.checked_mul(b),
        Op::Div => a.checked_div(b),
        Op::Mod => a.checked_rem(b),
        _ => None,
    }
}

fn real(op: Op, a: f64, b: f64) -> Option<f64> {
    let value = match op {
        Op::Add => a + b,
        Op::Sub => a - b,
        Op::Mul => a * b,
        Op::Div => a / b,
        _ => return None,
    };
    value.is_finite().then_some(value)
}

/// Returns true for a constant that is written in hexadecimal digits, or computed with one: GX Works2 keeps them.
pub(crate) fn is_hexadecimal(labels: &Labels, expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Name(name) => match labels.get(name) {
            Some(label) => label.is_hex,
            None => device::constant(name).is_some() && name.starts_with(['H', 'h']),
        },
        ExprKind::Number(text) => text.starts_with("16#"),
        ExprKind::Typed(text) => text.contains("#16#"),
        ExprKind::Binary(_, left, right) => {
            is_hexadecimal(labels, left) || is_hexadecimal(labels, right)
        }
        _ => false,
    }
}
