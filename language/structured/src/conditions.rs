//! Conditions: from expressions to contacts, in the order in which GX Works2 puts them.

use crate::ast::{Arg, Expr, ExprKind, Op};
use crate::emit::{Compiler, Made, OFF, ON, both, fail};
use crate::literal::Const;
use crate::places::{self, Place};
use crate::types::Ty;
use crate::values::is_edge;
use crate::{convert, functions};
use rungc_syntax::{Device, Operand, OperandKind, Span, codes, phrase};
use std::rc::Rc;

/// Operator between two conditions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Join {
    And,
    Or,
}

/// A condition. Operands that have to be computed are computed already.
#[derive(Clone, Debug)]
pub(crate) enum Cond {
    Contact {
        operand: Operand,
        is_closed: bool,
        /// True for a name, false for a bit of one or a value in between.
        is_name: bool,
    },
    Compare {
        op: Op,
        is_wide: bool,
        operands: [Operand; 2],
    },
    Joined(Join, Rc<Cond>, Rc<Cond>),
}

impl Cond {
    pub(crate) fn is_single(&self) -> bool {
        !matches!(self, Cond::Joined(..))
    }

    /// An open contact of a value in between.
    pub(crate) fn contact(operand: Operand) -> Cond {
        Cond::Contact {
            operand,
            is_closed: false,
            is_name: false,
        }
    }

    /// Both conditions.
    pub(crate) fn both(a: Cond, b: Cond) -> Cond {
        Cond::joined(Join::And, a, b)
    }

    pub(crate) fn joined(join: Join, a: Cond, b: Cond) -> Cond {
        Cond::Joined(join, Rc::new(a), Rc::new(b))
    }

    /// The opposite, by De Morgan.
    pub(crate) fn opposite(&self) -> Cond {
        match self {
            Cond::Contact {
                operand,
                is_closed,
                is_name,
            } => Cond::Contact {
                operand: operand.clone(),
                is_closed: !is_closed,
                is_name: *is_name,
            },
            Cond::Compare {
                op,
                is_wide,
                operands,
            } => Cond::Compare {
                op: opposite(*op),
                is_wide: *is_wide,
                operands: operands.clone(),
            },
            Cond::Joined(join, a, b) => {
                let join = match join {
                    Join::And => Join::Or,
                    Join::Or => Join::And,
                };
                Cond::joined(join, a.opposite(), b.opposite())
            }
        }
    }
}

const fn opposite(op: Op) -> Op {
    match op {
        Op::Eq => Op::Ne,
        Op::Ne => Op::Eq,
        Op::Lt => Op::Ge,
        Op::Ge => Op::Lt,
        Op::Gt => Op::Le,
        Op::Le => Op::Gt,
        op => op,
    }
}

impl Compiler<'_> {
    /// The contacts of an expression; what has to be computed for them is computed.
    pub(crate) fn condition(&mut self, expr: &Expr) -> Made<Cond> {
        self.expect(expr, Ty::Bool)?;
        self.contacts(expr)
    }

    fn contacts(&mut self, expr: &Expr) -> Made<Cond> {
        let contact = |kind, is_name| Cond::Contact {
            operand: Operand {
                span: expr.span,
                kind,
            },
            is_closed: false,
            is_name,
        };
        if let Some((value, _)) = self.constant(expr)? {
            let is_on = matches!(value, Const::Bool(true) | Const::Int(1));
            return Ok(contact(if is_on { ON } else { OFF }, true));
        }
        match &expr.kind {
            ExprKind::Not(of) => {
                let is_equality = self.is_equality(of);
                Ok(self.contacts(of)?.opposite_of_equality(is_equality))
            }
            ExprKind::Binary(op @ (Op::And | Op::Or), left, right) => {
                let join = if *op == Op::And { Join::And } else { Join::Or };
                let (a, b) = both(self.contacts(left), self.contacts(right))?;
                Ok(Cond::joined(join, a, b))
            }
            ExprKind::Binary(op @ (Op::Eq | Op::Ne | Op::Xor), left, right)
                if self.are_bits(left, right)? =>
            {
                let (a, b) = both(self.side(left), self.side(right))?;
                let equal = Cond::joined(
                    Join::Or,
                    Cond::joined(Join::And, a.clone(), b.clone()),
                    Cond::joined(Join::And, a.opposite(), b.opposite()),
                );
                let unlike = || {
                    Cond::joined(
                        Join::Or,
                        Cond::joined(Join::And, a.clone(), b.opposite()),
                        Cond::joined(Join::And, a.opposite(), b.clone()),
                    )
                };
                Ok(if *op == Op::Eq { equal } else { unlike() })
            }
            ExprKind::Binary(op, left, right) if op.compares() => self.comparison(*op, left, right),
            ExprKind::Call(of, args) => self.called(of.name().unwrap_or_default(), args, expr),
            _ => match self.place(expr)? {
                Some(place) if place.is_variable() => self.bit_of(&place, expr.span),
                Some(place) => Ok(contact(place.operand, place.is_name)),
                None => {
                    fail(codes::ST_UNSUPPORTED.at(expr.span, "this condition is not compiled yet"))
                }
            },
        }
    }

    /// A call as a condition.
    fn called(&mut self, name: &str, args: &[Arg], expr: &Expr) -> Made<Cond> {
        if let Some(function) = self.functions.get(&name.to_uppercase()).cloned() {
            let kind = self.result(&function, args, expr, None)?;
            let result = Operand {
                span: expr.span,
                kind,
            };
            self.load(&Cond::contact(result));
            return self.in_bit(expr.span);
        }
        if let Some((from, Ty::Bool, _)) = convert::find(name) {
            let value = self.kept_operand(&args[0].value, from)?;
            let zero = self.here(OperandKind::Decimal(0, None));
            return self.compared(Op::Ne, &value, &zero, from);
        }
        let Some(arg) = args.first().filter(|_| is_edge(name)) else {
            return fail(functions::unknown(name, expr));
        };
        let inner = self.condition(&arg.value)?;
        self.load(&inner);
        self.push(name.to_ascii_uppercase(), []);
        self.in_bit(expr.span)
    }

    /// An element of an array of bits by a variable index: the lowest of sixteen bits that begin there.
    pub(crate) fn bit_of(&mut self, place: &Place, span: Span) -> Made<Cond> {
        let group = self.group_of(place, span)?;
        self.reached(place, span)?;
        let temporary = self.temporary(1)?;
        let bit = self.here(OperandKind::Device(temporary, None));
        let one = self.here(OperandKind::Hex(1, None));
        let zero = self.here(OperandKind::Decimal(0, None));
        self.always("WAND", [Operand { span, kind: group }, one, bit.clone()]);
        Ok(Cond::Compare {
            op: Op::Ne,
            is_wide: false,
            operands: [bit, zero],
        })
    }

    /// Sixteen bits that begin with an element of an array of bits.
    pub(crate) fn group_of(&self, place: &Place, span: Span) -> Made<OperandKind> {
        let last = place
            .operand
            .device()
            .map(|first| (first.class, first.number));
        let last = last
            .map(|(class, number)| (class, number.saturating_add(place.reach).saturating_add(15)));
        let group = places::group(place).filter(|_| place.ty == Ty::Bool);
        match (group, last) {
            (Some(group), Some((class, last))) if self.model.has(class, last) => Ok(group),
            (Some(_), Some((class, _))) => {
                let what = phrase!(
                    "fewer than 15 devices {prefix} follow this array of bits",
                    prefix = class.prefix()
                );
                let error = codes::ST_NO_DEVICE.at(span, what);
                fail(
                    error.help("a variable index takes 16 bits: begin the array at a lower device"),
                )
            }
            _ => {
                let what =
                    phrase!("a bit or contact with a variable index is compiled for BOOL alone");
                fail(codes::ST_UNSUPPORTED.at(span, what))
            }
        }
    }

    /// A side of `=` or `<>`: a compound one goes through a bit.
    fn side(&mut self, expr: &Expr) -> Made<Cond> {
        let cond = self.contacts(expr)?;
        if cond.is_single() {
            return Ok(cond);
        }
        self.load(&cond);
        self.in_bit(expr.span)
    }

    fn are_bits(&self, left: &Expr, right: &Expr) -> Made<bool> {
        let (a, b) = both(self.ty(left), self.ty(right))?;
        Ok(a.is_bit() && b.is_bit() && (a == Ty::Bool || b == Ty::Bool))
    }

    fn comparison(&mut self, op: Op, left: &Expr, right: &Expr) -> Made<Cond> {
        let (a, b) = both(self.ty(left), self.ty(right))?;
        let ty = a.common(b).unwrap_or(a);
        if ty.is_text() {
            return self.compared_texts(op, left, right);
        }
        let ty = if ty == Ty::Integer { Ty::Int } else { ty };
        let ty = if ty == Ty::Fraction { Ty::Real } else { ty };
        let (a, b) = both(self.kept_operand(left, ty), self.kept_operand(right, ty))?;
        self.compared(op, &a, &b, ty)
    }

    /// The comparison of two values.
    pub(crate) fn compared(&mut self, op: Op, a: &Operand, b: &Operand, ty: Ty) -> Made<Cond> {
        if ty == Ty::Real {
            return self.compared_reals(op, a, b);
        }
        let orders = !matches!(op, Op::Eq | Op::Ne);
        if orders && ty.is_unsigned() {
            return Ok(self.unsigned(op, a, b, ty.is_wide()));
        }
        Ok(Cond::Compare {
            op,
            is_wide: ty.is_wide(),
            operands: [a.clone(), b.clone()],
        })
    }

    /// Comparison of REAL values: DECMP sets the first of three bits for larger, the second for equal, the third for
    /// smaller.
    fn compared_reals(&mut self, op: Op, a: &Operand, b: &Operand) -> Made<Cond> {
        let first = self.temporary_bits(3)?;
        let bits = self.here(OperandKind::Device(first, None));
        self.always("DECMP", [a.clone(), b.clone(), bits]);
        let (at, is_closed) = match op {
            Op::Gt => (0, false),
            Op::Le => (0, true),
            Op::Eq => (1, false),
            Op::Ne => (1, true),
            Op::Lt => (2, false),
            _ => (2, true),
        };
        let number = first.number + at;
        let bit = self.here(OperandKind::Device(Device { number, ..first }, None));
        let cond = Cond::contact(bit);
        Ok(if is_closed { cond.opposite() } else { cond })
    }

    /// Order of values without a sign, by instructions that compare values with a sign: as it stands where the signs
    /// are alike, else the other way round.
    fn unsigned(&self, op: Op, a: &Operand, b: &Operand, is_wide: bool) -> Cond {
        // The bits of a constant above the largest signed number are those of a negative one.
        let zero = || self.here(OperandKind::Decimal(0, None));
        let compare = |op, a: &Operand, b: Operand| Cond::Compare {
            op,
            is_wide,
            operands: [a.clone(), b],
        };
        let signs = |of_a, of_b| {
            Cond::joined(
                Join::And,
                compare(of_a, a, zero()),
                compare(of_b, b, zero()),
            )
        };
        let alike = Cond::joined(Join::Or, signs(Op::Lt, Op::Lt), signs(Op::Ge, Op::Ge));
        let unlike = Cond::joined(Join::Or, signs(Op::Lt, Op::Ge), signs(Op::Ge, Op::Lt));
        let turned = match op {
            Op::Lt => Op::Gt,
            Op::Le => Op::Ge,
            Op::Gt => Op::Lt,
            _ => Op::Le,
        };
        Cond::joined(
            Join::Or,
            Cond::joined(Join::And, alike, compare(op, a, b.clone())),
            Cond::joined(Join::And, unlike, compare(turned, a, b.clone())),
        )
    }

    /// Stores the rung that was begun in a temporary bit, and gives its contact.
    pub(crate) fn in_bit(&mut self, span: Span) -> Made<Cond> {
        let bit = self.temporary(0)?;
        let kind = OperandKind::Device(bit, None);
        let coil = self.here(kind.clone());
        self.push("OUT", [coil]);
        Ok(Cond::Contact {
            operand: Operand { span, kind },
            is_closed: false,
            is_name: false,
        })
    }

    /// Begins a rung with a condition.
    pub(crate) fn load(&mut self, cond: &Cond) {
        self.is_powered = false;
        self.begin(cond);
    }

    fn begin(&mut self, cond: &Cond) {
        match cond {
            Cond::Joined(join, a, b) => {
                let (first, second) = ordered(*join, a, b);
                self.begin(first);
                self.join(*join, second);
            }
            single => self.single("LD", single),
        }
    }

    fn join(&mut self, join: Join, cond: &Cond) {
        let (name, block) = match join {
            Join::And => ("AND", "ANB"),
            Join::Or => ("OR", "ORB"),
        };
        match cond {
            Cond::Joined(inner, a, b) if *inner == join => {
                let (first, second) = ordered(*inner, a, b);
                self.join(join, first);
                self.join(join, second);
            }
            Cond::Joined(..) => {
                self.begin(cond);
                self.push(block, []);
            }
            single => self.single(name, single),
        }
    }

    fn single(&mut self, name: &str, cond: &Cond) {
        match cond {
            Cond::Contact {
                operand, is_closed, ..
            } => {
                let name = match (name, is_closed) {
                    ("AND", true) => "ANI",
                    ("LD", true) => "LDI",
                    ("OR", true) => "ORI",
                    (name, _) => name,
                };
                self.push(name, [operand.clone()]);
            }
            Cond::Compare {
                op,
                is_wide,
                operands,
            } => {
                let wide = if *is_wide { "D" } else { "" };
                let sign = op.sign();
                self.push(format!("{name}{wide}{sign}"), operands.iter().cloned());
            }
            Cond::Joined(..) => {}
        }
    }
}

/// The operands of AND or OR in the order of their contacts.
fn ordered<'c>(join: Join, a: &'c Cond, b: &'c Cond) -> (&'c Cond, &'c Cond) {
    let is_plain = matches!(
        a,
        Cond::Contact {
            is_closed: false,
            is_name: true,
            ..
        }
    );
    let is_block = matches!(b, Cond::Joined(inner, ..) if *inner != join);
    let is_comparison = matches!(b, Cond::Compare { .. });
    match is_plain && is_comparison || a.is_single() && is_block {
        true => (b, a),
        false => (a, b),
    }
}
