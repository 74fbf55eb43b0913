//! Instructions on floats that the runtime has functions for and that are inline code. The runtime is called only where
//! operands or flags ask for more than the code here does.

use super::Lowerer;
use super::operand::{Guards, Target};
use rungc_ir::node::{Access, Action, Branch, Expr, ExprId, FloatOp, Stmt, Ty, UnOp};
use rungc_rt::special::{M_BORROW, M_CARRY, M_ZERO};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{DeviceClass, Instr, OperandKind};

/// A value is not a float, or outside a function's domain.
const DOMAIN: u16 = rungc_rt::Fault::DOMAIN.0;

/// Returns true if an instruction that a runtime function implements is inline code, judging by its operands. Such an
/// instruction stores no flags that are not used.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let floats = |range: std::ops::Range<usize>| range.map(kind).all(|o| o.is_some_and(is_float));
    let register = |i| kind(i).is_some_and(is_register);
    match function {
        RtFn::Flt => register(1),
        RtFn::Int => floats(0..1),
        RtFn::Emov => floats(0..1) && register(1),
        RtFn::Eneg => register(0),
        RtFn::Esqr => floats(0..1) && register(1),
        RtFn::Ecmp => floats(0..2),
        RtFn::Ezcp => floats(0..3),
        RtFn::Eadd | RtFn::Esub | RtFn::Emul | RtFn::Ediv => floats(0..2) && register(2),
        RtFn::EaddPlain | RtFn::EsubPlain | RtFn::EmulPlain => floats(0..2) && register(2),
        _ => false,
    }
}

/// The 32 bits of a constant without an index.
pub(super) fn constant(operand: &OperandKind) -> Option<i32> {
    operand.constant().map(|value| value as i32)
}

/// Returns true if it is a register that holds floats in pairs.
fn is_register(operand: &OperandKind) -> bool {
    matches!(operand, OperandKind::Device(device, _) if matches!(device.class, DeviceClass::D | DeviceClass::R))
}

/// Returns true if it is a float that inline code reads.
fn is_float(operand: &OperandKind) -> bool {
    matches!(operand, OperandKind::Float(_)) || is_register(operand) || constant(operand).is_some()
}

impl Lowerer<'_> {
    /// Emits an instruction as inline code; false if the runtime has to be called.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    pub(super) fn inline_words(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) || self.calls_for_flags(function) {
            return false;
        }
        match function {
            RtFn::Flt => self.driven(Self::float_of_integer),
            RtFn::Int => self.driven(Self::integer_of_float),
            RtFn::Emov => self.driven(Self::move_float),
            RtFn::Eneg => self.driven(Self::negate_float),
            RtFn::Esqr => self.driven(Self::float_root),
            RtFn::Ecmp => self.driven(Self::compare_floats),
            RtFn::Ezcp => self.driven(Self::compare_float_zone),
            RtFn::Eadd | RtFn::EaddPlain => self.driven(|this| this.float_op(FloatOp::Add)),
            RtFn::Esub | RtFn::EsubPlain => self.driven(|this| this.float_op(FloatOp::Sub)),
            RtFn::Emul | RtFn::EmulPlain => self.driven(|this| this.float_op(FloatOp::Mul)),
            RtFn::Ediv => self.driven(|this| this.float_op(FloatOp::Div)),
            _ => return false,
        }
        true
    }

    /// Returns true if a flag is used that inline code does not set: float arithmetic has flags for results too small
    /// and too large.
    fn calls_for_flags(&self, function: RtFn) -> bool {
        matches!(function, RtFn::Eadd | RtFn::Esub | RtFn::Emul | RtFn::Ediv)
            && [M_BORROW, M_CARRY]
                .iter()
                .any(|&flag| self.specials.has(flag))
    }

    /// Emits the statements of `make`, executed where `cond` holds; elsewhere the instruction faults with `code`.
    pub(super) fn checked(&mut self, cond: ExprId, code: u16, make: impl FnOnce(&mut Self)) {
        let then = self.body(make);
        let step = self.step();
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise: vec![Stmt::Do(Action::Fault { code, step })],
        }));
    }

    /// Operand `i` as a float: a constant is converted.
    fn float_source(&mut self, i: usize, guards: &mut Guards) -> ExprId {
        match self.operand(i) {
            Some(&OperandKind::Float(value)) => self.add(Expr::F32(value)),
            Some(operand @ &OperandKind::Device(..)) => {
                match self.target(operand, 0, true, self.wide(), guards) {
                    Target::Pair(place) => self.add(Expr::Read(Access::float(place))),
                    Target::Word(_)
                    | Target::CounterWords(_)
                    | Target::Nibbles(..)
                    | Target::Sent(..)
                    | Target::None => self.add(Expr::F32(0.0)),
                }
            }
            operand => {
                let value = operand.and_then(constant).unwrap_or(0);
                self.add(Expr::F32(value as f32))
            }
        }
    }

    /// Operand `i` as the register of a float.
    fn float_target(&mut self, i: usize, guards: &mut Guards) -> Target {
        self.result_element(i, 0, true, guards)
    }

    fn store_float(&mut self, target: Target, value: ExprId) {
        if let Target::Pair(place) = target {
            self.emit(Action::Write(Access::float(place), value));
        }
    }

    /// Floats that are settled, and whether all of them are finite; constants are.
    fn finite<const N: usize>(&mut self, values: [ExprId; N]) -> ([ExprId; N], ExprId) {
        let values = values.map(|value| self.settled(value));
        let mut all = self.bit_const(true);
        for value in values {
            if !matches!(self.expr(value), Expr::F32(_)) {
                let finite = self.add(Expr::Un(UnOp::IsFinite, value));
                all = match self.known_bit(all) {
                    Some(true) => finite,
                    Some(false) | None => self.and(all, finite),
                };
            }
        }
        (values, all)
    }

    /// FLT.
    fn float_of_integer(&mut self) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.float_target(1, &mut guards);
        let value = if self.wide() {
            value
        } else {
            self.add(Expr::Widen(value))
        };
        let value = self.add(Expr::Un(UnOp::ToFloat, value));
        self.guarded(guards, |this| this.store_float(target, value));
    }

    /// INT: M8020 for 0, M8021 for a dropped fraction, M8022 for a value that D cannot hold.
    fn integer_of_float(&mut self) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let value = self.float_source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let ([value], finite) = this.finite([value]);
            this.checked(finite, DOMAIN, |this| {
                let whole = this.add(Expr::Un(UnOp::Truncate, value));
                let whole = this.flagged(whole, |this, whole| {
                    this.integer_flags(value, whole, wide);
                });
                let stored = if wide {
                    whole
                } else {
                    this.add(Expr::Narrow(whole))
                };
                this.store(target, stored);
            });
        });
    }

    fn integer_flags(&mut self, value: ExprId, whole: ExprId, wide: bool) {
        let is = |this: &mut Self, op, limit: f32| {
            let limit = this.add(Expr::F32(limit));
            this.add(Expr::Cmp(op, value, limit))
        };
        // The last floats below and above which the integer part does not fit.
        let (below, above) = match wide {
            true => (
                is(self, CmpOp::Lt, -2_147_483_648.0),
                is(self, CmpOp::Ge, 2_147_483_648.0),
            ),
            false => (
                is(self, CmpOp::Le, -32_769.0),
                is(self, CmpOp::Ge, 32_768.0),
            ),
        };
        let (small, smaller) = (is(self, CmpOp::Gt, -1.0), is(self, CmpOp::Lt, 1.0));
        // Floats from 2^24 on have no fraction.
        let (least, most) = (
            is(self, CmpOp::Gt, -16_777_216.0),
            is(self, CmpOp::Lt, 16_777_216.0),
        );
        let zero = self.and(small, smaller);
        let carry = self.or(below, above);
        let back = self.add(Expr::Un(UnOp::ToFloat, whole));
        let differs = self.add(Expr::Cmp(CmpOp::Ne, back, value));
        let fraction = self.and(least, most);
        let fraction = self.and(fraction, differs);
        self.set_flag(M_ZERO, zero);
        self.set_flag(M_BORROW, fraction);
        self.set_flag(M_CARRY, carry);
    }

    /// EMOV: the bits, whatever they mean.
    fn move_float(&mut self) {
        let mut guards = Guards::default();
        let operand = self.operand(0).cloned();
        let value = match &operand {
            Some(register @ OperandKind::Device(..)) => self.value(register, true, &mut guards),
            _ => self.float_source(0, &mut guards),
        };
        let target = self.float_target(1, &mut guards);
        self.guarded(guards, |this| match this.module.ty(value) {
            Ty::F32 => this.store_float(target, value),
            Ty::Bit | Ty::I16 | Ty::I32 => this.store(target, value),
        });
    }

    /// ENEG.
    fn negate_float(&mut self) {
        let mut guards = Guards::default();
        let value = self.float_source(0, &mut guards);
        let target = self.float_target(0, &mut guards);
        let value = self.add(Expr::Un(UnOp::Negate, value));
        self.guarded(guards, |this| this.store_float(target, value));
    }

    /// ESQR: M8020 is on if the root is 0.
    fn float_root(&mut self) {
        let mut guards = Guards::default();
        let value = self.float_source(0, &mut guards);
        let target = self.float_target(1, &mut guards);
        self.guarded(guards, |this| {
            let ([value], finite) = this.finite([value]);
            let zero = this.add(Expr::F32(0.0));
            let not_below = this.add(Expr::Cmp(CmpOp::Ge, value, zero));
            let fits = this.and(finite, not_below);
            this.checked(fits, DOMAIN, |this| {
                let root = this.add(Expr::Un(UnOp::SquareRoot, value));
                let root = this.flagged(root, |this, root| {
                    let none = this.add(Expr::Cmp(CmpOp::Eq, root, zero));
                    this.set_flag(M_ZERO, none);
                });
                this.store_float(target, root);
            });
        });
    }

    /// Three bits of which one is on, where all values are finite.
    fn float_bits(
        &mut self,
        operand: usize,
        mut guards: Guards,
        finite: impl FnOnce(&mut Self) -> ([ExprId; 3], ExprId),
    ) {
        let wide = self.wide();
        let Some(at) = self.operand(operand).cloned() else {
            return;
        };
        let Some(target) = self.bit_target(&at, 3, wide, &mut guards) else {
            return;
        };
        self.guarded(guards, |this| {
            let (bits, finite) = finite(this);
            this.checked(finite, DOMAIN, |this| {
                let bits = bits.map(|bit| this.settled(bit));
                for (offset, bit) in (0..).zip(bits) {
                    this.store_bit(target, offset, bit);
                }
            });
        });
    }

    /// ECMP.
    fn compare_floats(&mut self) {
        let mut guards = Guards::default();
        let values = [0, 1].map(|i| self.float_source(i, &mut guards));
        self.float_bits(2, guards, |this| {
            let ([a, b], finite) = this.finite(values);
            let bits = [CmpOp::Gt, CmpOp::Eq, CmpOp::Lt].map(|op| this.add(Expr::Cmp(op, a, b)));
            (bits, finite)
        });
    }

    /// EZCP.
    fn compare_float_zone(&mut self) {
        let mut guards = Guards::default();
        let values = [0, 1, 2].map(|i| self.float_source(i, &mut guards));
        self.float_bits(3, guards, |this| {
            let ([low, high, value], finite) = this.finite(values);
            let below = this.add(Expr::Cmp(CmpOp::Lt, value, low));
            // An upper limit below the lower one counts as equal to it.
            let above_low = this.add(Expr::Cmp(CmpOp::Gt, value, low));
            let above_high = this.add(Expr::Cmp(CmpOp::Gt, value, high));
            let above = this.and(above_low, above_high);
            let (not_below, not_above) = (this.not(below), this.not(above));
            let inside = this.and(not_below, not_above);
            ([below, inside, above], finite)
        });
    }

    /// EADD, ESUB, EMUL, EDIV: M8020 is on if the result is 0. Dividing by 0 is a separate error.
    fn float_op(&mut self, op: FloatOp) {
        let mut guards = Guards::default();
        let values = [0, 1].map(|i| self.float_source(i, &mut guards));
        let target = self.float_target(2, &mut guards);
        self.guarded(guards, |this| {
            let ([a, b], finite) = this.finite(values);
            this.checked(finite, DOMAIN, |this| {
                let operate = |this: &mut Self| {
                    let result = this.add(Expr::Float(op, a, b));
                    let result = this.flagged(result, |this, result| {
                        let zero = this.add(Expr::F32(0.0));
                        let none = this.add(Expr::Cmp(CmpOp::Eq, result, zero));
                        this.set_flag(M_ZERO, none);
                    });
                    this.store_float(target, result);
                };
                if op != FloatOp::Div {
                    return operate(this);
                }
                let zero = this.add(Expr::F32(0.0));
                let divides = this.add(Expr::Cmp(CmpOp::Ne, b, zero));
                this.checked(divides, this.model.value_error, operate);
            });
        });
    }
}
