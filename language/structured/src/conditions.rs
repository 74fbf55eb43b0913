//! Conditions: from expressions to contacts, in the order in which GX Works2 puts them.

use crate::ast::{Expr, ExprKind, Op};
use crate::emit::{Compiler, Made, OFF, ON, both, fail};
use crate::literal::Const;
use crate::types::Ty;
use crate::values::is_edge;
use rungc_syntax::{Operand, OperandKind, Span, codes};
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

    fn joined(join: Join, a: Cond, b: Cond) -> Cond {
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
            ExprKind::Call(of, args) if of.name().is_some_and(is_edge) => {
                let inner = self.condition(&args[0].value)?;
                let name = of.name().unwrap_or_default().to_ascii_uppercase();
                self.load(&inner);
                self.push(name, []);
                self.in_bit(expr.span)
            }
            _ => match self.place(expr)? {
                Some(place) => Ok(contact(place.operand, place.is_name)),
                None => {
                    fail(codes::ST_UNSUPPORTED.at(expr.span, "this condition is not compiled yet"))
                }
            },
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
        let span = left.span.to(right.span);
        let ty = a.common(b).unwrap_or(a);
        let ty = if ty == Ty::Integer { Ty::Int } else { ty };
        if matches!(ty, Ty::Real | Ty::Fraction) {
            let what = "comparing REAL values is not compiled yet";
            let error = codes::ST_UNSUPPORTED.at(span, what);
            return fail(error.help("call the instruction: `DECMP(EN, a, b, M0)`"));
        }
        let orders = !matches!(op, Op::Eq | Op::Ne);
        if orders && ty == Ty::Word {
            let what = "the order of WORD values is not compiled yet";
            let error = codes::ST_UNSUPPORTED.at(span, what);
            return fail(error.help("compare INT values: `WORD_TO_INT(…)`"));
        }
        let (a, b) = both(self.operand(left, ty), self.operand(right, ty))?;
        if orders && ty == Ty::Dword {
            return Ok(self.unsigned(op, &a, &b));
        }
        let is_wide = ty.is_wide();
        Ok(Cond::Compare {
            op,
            is_wide,
            operands: [a, b],
        })
    }

    /// Order of values without a sign, by instructions that compare values with a sign: as it stands where the signs
    /// are alike, else the other way round.
    fn unsigned(&self, op: Op, a: &Operand, b: &Operand) -> Cond {
        let zero = || self.here(OperandKind::Decimal(0, None));
        let compare = |op, a: &Operand, b: Operand| Cond::Compare {
            op,
            is_wide: true,
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
