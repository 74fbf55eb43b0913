//! Limits of operands that are known at run time, where the runtime's function accepts more than the model.

use super::Lowerer;
use super::operand::{Guards, OUT_OF_RANGE};
use rungc_catalogue::{Limits, Param, Rule};
use rungc_ir::node::{Action, BinOp, Branch, Expr, ExprId, Stmt};
use rungc_rt::CmpOp;
use rungc_syntax::{Index, OperandKind};

impl Lowerer<'_> {
    /// Emits what `make` does if the operands are within the model's limits; else the instruction faults. What is
    /// executed driven or not, if `drive` is given, is not held to them while it is not driven.
    pub(super) fn within_limits(
        &mut self,
        drive: Option<ExprId>,
        make: impl FnOnce(&mut Self, Option<ExprId>),
    ) {
        let checks = self.limit_checks();
        if checks.is_empty() {
            return make(self, drive);
        }
        let drive = drive.map(|drive| self.settled(drive));
        let (conds, codes): (Vec<_>, Vec<_>) = checks.into_iter().unzip();
        let step = self.step();
        let mut stmts = self.body(|this| make(this, drive));
        for (cond, code) in conds.into_iter().zip(codes).rev() {
            let cond = match drive {
                Some(drive) => {
                    let off = self.not(drive);
                    self.or(off, cond)
                }
                None => cond,
            };
            stmts = vec![Stmt::If(Branch {
                cond,
                then: stmts,
                otherwise: vec![Stmt::Do(Action::Fault { code, step })],
            })];
        }
        for stmt in stmts {
            self.emit(stmt);
        }
    }

    /// Conditions that operands are within the model's limits, with the codes of their faults.
    fn limit_checks(&mut self) -> Vec<(ExprId, u16)> {
        let params = self.resolution().params;
        let operands = self
            .instr()
            .operands
            .iter()
            .map(|operand| operand.kind.clone());
        let mut checks = Vec::new();
        for (n, (kind, param)) in operands.zip(params).enumerate() {
            let limits = self.constant_limits(param).filter(|_| param.checked);
            match kind {
                OperandKind::Decimal(value, Some(index)) => {
                    checks.extend(self.constant_checks(value, index, limits));
                }
                OperandKind::Hex(value, Some(index)) => {
                    checks.extend(self.constant_checks(value as i64, index, limits));
                }
                OperandKind::Device(device, index) => {
                    let numbers = param.numbers_on(self.model).iter();
                    let of_class = numbers.filter(|numbers| numbers.0 == device.class);
                    let range = of_class
                        .map(|&(_, first, last)| (i64::from(first), i64::from(last)))
                        .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
                    if let (Some(index), Some(range)) = (index, range) {
                        let conds =
                            self.index_conditions(device.number as i32, index, range, false);
                        checks.extend(conds.map(|cond| (cond, OUT_OF_RANGE)));
                    }
                    if let Some((least, most)) = limits {
                        let mut guards = Guards::default();
                        let value = self.source(n, &mut guards);
                        checks.extend(guards.conditions().map(|cond| (cond, OUT_OF_RANGE)));
                        let fits = self.lies_in(value, (least as i32, most as i32));
                        checks.push((fits, self.model.value_error));
                    }
                }
                OperandKind::Decimal(_, None)
                | OperandKind::Hex(_, None)
                | OperandKind::WordBit(..)
                | OperandKind::Nibbles(..)
                | OperandKind::Float(_)
                | OperandKind::Text(_)
                | OperandKind::Buffer { .. }
                | OperandKind::Unreadable(_) => {}
            }
        }
        checks
    }

    /// Conditions that a constant with an index is within limits, if it has some.
    fn constant_checks(
        &mut self,
        value: i64,
        index: Index,
        limits: Option<(i64, i64)>,
    ) -> Vec<(ExprId, u16)> {
        let code = self.model.value_error;
        let conds = limits.map(|range| self.index_conditions(value as i32, index, range, true));
        conds
            .into_iter()
            .flatten()
            .map(|cond| (cond, code))
            .collect()
    }

    /// Limits of a constant in the form at hand.
    fn constant_limits(&self, param: &Param) -> Option<(i64, i64)> {
        let wide = self.wide();
        let of_wide_form = param.rules.iter().find_map(|rule| {
            let Rule::WideLimits(min, max) = *rule else {
                return None;
            };
            wide.then_some((min, max))
        });
        match param.limits {
            Limits::Between(range) => Some(of_wide_form.unwrap_or(range)),
            Limits::None | Limits::Among(_) => of_wide_form,
        }
    }

    /// Conditions that a constant or a number of a device is in a range after its index is added.
    fn index_conditions(
        &mut self,
        base: i32,
        index: Index,
        (low, high): (i64, i64),
        constant: bool,
    ) -> [ExprId; 2] {
        let wide = self.wide();
        let index = match constant {
            true => {
                let index = self.constant_index(index, wide);
                if wide {
                    index
                } else {
                    self.add(Expr::Widen(index))
                }
            }
            false => self.index(index, wide),
        };
        let base = self.add(Expr::I32(base));
        let value = self.add(Expr::Bin(BinOp::Add, base, index));
        let value = self.settled(value);
        [(CmpOp::Ge, low), (CmpOp::Le, high)].map(|(op, end)| {
            let end = self.add(Expr::I32(end as i32));
            self.add(Expr::Cmp(op, value, end))
        })
    }
}
