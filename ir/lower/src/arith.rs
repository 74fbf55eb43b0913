//! Moves, compares and integer arithmetic, which are inline code.

use super::Lowerer;
use super::operand::{Guards, Target};
use rungc_catalogue::ArithOp;
use rungc_ir::node::{Action, BinOp, Branch, Expr, ExprId, Stmt};
use rungc_rt::CmpOp;
use rungc_rt::special::{
    D_RING_COUNTER, M_BORROW, M_CARRY, M_LARGE_QUOTIENT, M_ZERO, M_ZERO_PRODUCT, Relay,
};
use rungc_syntax::{DeviceClass, OperandKind};

/// Division by zero.
const DIVISION: u16 = 6706;

impl Lowerer<'_> {
    /// Emits inline code where the drive is on; nothing if operands are missing.
    pub(super) fn inline(&mut self, make: impl FnOnce(&mut Self)) {
        self.driven(|this| {
            if this.instr().operands.len() >= this.resolution().params.len() {
                make(this);
            }
        });
    }

    pub(super) fn wide(&self) -> bool {
        self.resolution().form.wide
    }

    /// Operand `i` as a value of the instruction's width.
    pub(super) fn source(&mut self, i: usize, guards: &mut Guards) -> ExprId {
        let wide = self.wide();
        match self.operand(i) {
            Some(operand) => self.value(operand, wide, guards),
            None => self.int(0, wide),
        }
    }

    /// Operand `i` as the target of a result of the instruction's width.
    pub(super) fn result(&mut self, i: usize, guards: &mut Guards) -> Target {
        let wide = self.wide();
        self.result_element(i, 0, wide, guards)
    }

    pub(super) fn result_element(
        &mut self,
        i: usize,
        element: u32,
        wide: bool,
        guards: &mut Guards,
    ) -> Target {
        let wide_index = self.wide();
        match self.operand(i) {
            Some(operand) => self.target(operand, element, wide, wide_index, guards),
            None => Target::None,
        }
    }

    pub(super) fn move_value(&mut self, complement: bool) {
        let mut guards = Guards::default();
        let mut value = self.source(0, &mut guards);
        if complement {
            value = self.add(Expr::Complement(value));
        }
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| this.store(target, value));
    }

    /// HCMOV. The ring counter of tenths of milliseconds is one word.
    pub(super) fn move_count(&mut self) {
        let Some(&OperandKind::Device(counter, None)) = self.operand(0) else {
            return;
        };
        let mut guards = Guards::default();
        let clear = match self.operand(2).and_then(OperandKind::constant) {
            Some(n) => self.bit_const(n == 1),
            None => {
                let (n, one) = (self.source(2, &mut guards), self.int(1, true));
                self.add(Expr::Cmp(CmpOp::Eq, n, one))
            }
        };
        let from = OperandKind::Device(counter, None);
        let is_word = counter.class == DeviceClass::D && counter.number == D_RING_COUNTER.number();
        let mut value = self.value(&from, !is_word, &mut guards);
        if is_word {
            value = self.add(Expr::Widen(value));
        }
        let target = self.result(1, &mut guards);
        let cleared = self.target(&from, 0, !is_word, !is_word, &mut guards);
        self.guarded(guards, |this| {
            this.within_limits(None, |this, _| {
                this.store(target, value);
                this.when(clear, |this| {
                    let zero = this.int(0, !is_word);
                    this.store(cleared, zero);
                });
            });
        });
    }

    pub(super) fn compare(&mut self) {
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        self.three_bits(2, guards, |this| {
            let (a, b) = (this.settled(a), this.settled(b));
            [CmpOp::Gt, CmpOp::Eq, CmpOp::Lt].map(|op| this.add(Expr::Cmp(op, a, b)))
        });
    }

    pub(super) fn compare_zone(&mut self) {
        let mut guards = Guards::default();
        let low = self.source(0, &mut guards);
        let high = self.source(1, &mut guards);
        let value = self.source(2, &mut guards);
        self.three_bits(3, guards, |this| {
            let (low, high, value) = (this.settled(low), this.settled(high), this.settled(value));
            // An upper limit below the lower one counts as equal to it.
            let below = this.add(Expr::Cmp(CmpOp::Lt, value, low));
            let above_low = this.add(Expr::Cmp(CmpOp::Gt, value, low));
            let above_high = this.add(Expr::Cmp(CmpOp::Gt, value, high));
            let above = this.and(above_low, above_high);
            let (not_below, not_above) = (this.not(below), this.not(above));
            let inside = this.and(not_below, not_above);
            [below, inside, above]
        });
    }

    fn three_bits(
        &mut self,
        operand: usize,
        mut guards: Guards,
        make: impl FnOnce(&mut Self) -> [ExprId; 3],
    ) {
        let wide = self.wide();
        let Some(target) = self
            .operand(operand)
            .and_then(|operand| self.bit_target(operand, 3, wide, &mut guards))
        else {
            return;
        };
        self.guarded(guards, |this| {
            let bits = make(this);
            for (offset, bit) in bits.into_iter().enumerate() {
                this.store_bit(target, offset as u32, bit);
            }
        });
    }

    pub(super) fn arith(&mut self, op: ArithOp, saturate: bool) {
        match op {
            ArithOp::Add | ArithOp::Sub if saturate => {
                self.two_values(if op == ArithOp::Add {
                    BinOp::SatAdd
                } else {
                    BinOp::SatSub
                });
            }
            ArithOp::Add => self.with_flags(BinOp::Add),
            ArithOp::Sub => self.with_flags(BinOp::Sub),
            ArithOp::And => self.two_values(BinOp::And),
            ArithOp::Or => self.two_values(BinOp::Or),
            ArithOp::Xor => self.two_values(BinOp::Xor),
            ArithOp::Inc => self.step_by_one(if saturate { BinOp::SatAdd } else { BinOp::Add }),
            ArithOp::Dec => self.step_by_one(if saturate { BinOp::SatSub } else { BinOp::Sub }),
            ArithOp::Neg => self.negate(),
            ArithOp::Mul if self.wide() => self.multiply_wide(),
            ArithOp::Mul => self.multiply(),
            ArithOp::Div => self.divide(saturate),
        }
    }

    fn two_values(&mut self, op: BinOp) {
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        let target = self.result(2, &mut guards);
        let value = self.add(Expr::Bin(op, a, b));
        self.guarded(guards, |this| this.store(target, value));
    }

    fn step_by_one(&mut self, op: BinOp) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let one = self.int(1, self.wide());
        let target = self.result(0, &mut guards);
        let value = self.add(Expr::Bin(op, value, one));
        self.guarded(guards, |this| this.store(target, value));
    }

    fn negate(&mut self) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(0, &mut guards);
        let value = self.add(Expr::Neg(value));
        self.guarded(guards, |this| this.store(target, value));
    }

    /// ADD and SUB: the result wraps; the flags that something looks at are set by the true sum.
    fn with_flags(&mut self, op: BinOp) {
        if !self.looks_at_flags() {
            return self.two_values(op);
        }
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        let target = self.result(2, &mut guards);
        self.guarded(guards, |this| {
            let wide = this.wide();
            let (a, b) = (this.settled(a), this.settled(b));
            let value = this.add(Expr::Bin(op, a, b));
            let value = this.settled(value);
            let [zero, borrow, carry] = this.sum_flags(op, a, b, value, wide);
            this.store(target, value);
            this.set_flag(M_ZERO, zero);
            this.set_flag(M_BORROW, borrow);
            this.set_flag(M_CARRY, carry);
        });
    }

    /// Returns true if the zero, borrow or carry flag is used.
    pub(super) fn looks_at_flags(&self) -> bool {
        let flags = [M_ZERO, M_BORROW, M_CARRY];
        flags.iter().any(|&flag| self.specials.has(flag))
    }

    /// Conditions for the flags of a result: 0, too small, too large. A sum of two values of one sign (a difference of
    /// two of different signs) has left the range if its sign is another.
    fn sum_flags(
        &mut self,
        op: BinOp,
        a: ExprId,
        b: ExprId,
        value: ExprId,
        wide: bool,
    ) -> [ExprId; 3] {
        let zero = self.int(0, wide);
        let is_zero = self.add(Expr::Cmp(CmpOp::Eq, value, zero));
        let [a_neg, b_neg, neg] = [a, b, value].map(|x| self.add(Expr::Cmp(CmpOp::Lt, x, zero)));
        let [a_pos, b_pos, pos] = [a, b, value].map(|x| self.add(Expr::Cmp(CmpOp::Ge, x, zero)));
        let (down, up) = if op == BinOp::Add {
            (b_neg, b_pos)
        } else {
            (b_pos, b_neg)
        };
        let borrow = self.and(a_neg, down);
        let borrow = self.and(borrow, pos);
        let carry = self.and(a_pos, up);
        let carry = self.and(carry, neg);
        [is_zero, borrow, carry]
    }

    pub(super) fn set_flag(&mut self, flag: Relay, value: ExprId) {
        if self.specials.has(flag) {
            self.write_relay(flag, value);
        }
    }

    /// Sets a flag of MUL and DIV, if the model has it and something looks at it, by `value`, and returns the value to
    /// continue with.
    fn flag_of(
        &mut self,
        flag: Relay,
        value: ExprId,
        on: impl FnOnce(&mut Self, ExprId) -> ExprId,
    ) -> ExprId {
        if !self.model.special_works(flag) || !self.specials.has(flag) {
            return value;
        }
        let value = self.settled(value);
        let on = on(self, value);
        self.write_relay(flag, on);
        value
    }

    pub(super) fn is_int(&mut self, value: ExprId, int: i32, wide: bool) -> ExprId {
        let int = self.int(int, wide);
        self.add(Expr::Cmp(CmpOp::Eq, value, int))
    }

    fn multiply(&mut self) {
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        let target = self.result_element(2, 0, true, &mut guards);
        let (a, b) = (self.add(Expr::Widen(a)), self.add(Expr::Widen(b)));
        let product = self.add(Expr::Bin(BinOp::Mul, a, b));
        self.guarded(guards, |this| {
            let product = this.flag_of(M_ZERO_PRODUCT, product, |this, product| {
                this.is_int(product, 0, true)
            });
            this.store(target, product);
        });
    }

    fn multiply_wide(&mut self) {
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        let low_target = self.result_element(2, 0, true, &mut guards);
        if self.is_group(2) {
            let low = self.add(Expr::Bin(BinOp::Mul, a, b));
            return self.guarded(guards, |this| {
                let low = this.flag_of(M_ZERO_PRODUCT, low, |this, low| this.is_int(low, 0, true));
                this.store(low_target, low);
            });
        }
        let high_target = self.result_element(2, 1, true, &mut guards);
        self.guarded(guards, |this| {
            let (a, b) = (this.settled(a), this.settled(b));
            let low = this.add(Expr::Bin(BinOp::Mul, a, b));
            let high = this.add(Expr::Bin(BinOp::MulHigh, a, b));
            // A product is 0 only if a factor is.
            this.flag_of(M_ZERO_PRODUCT, low, |this, _| {
                let zero = [a, b].map(|factor| this.is_int(factor, 0, true));
                this.or(zero[0], zero[1])
            });
            this.store(low_target, low);
            this.store(high_target, high);
        });
    }

    fn is_group(&self, operand: usize) -> bool {
        matches!(self.operand(operand), Some(OperandKind::Nibbles(..)))
    }

    fn divide(&mut self, saturate: bool) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let a = self.source(0, &mut guards);
        let b = self.source(1, &mut guards);
        let quotient_target = self.result_element(2, 0, wide, &mut guards);
        let remainder_target = if self.is_group(2) {
            Target::None
        } else {
            self.result_element(2, 1, wide, &mut guards)
        };
        self.guarded(guards, |this| {
            let (a, b) = (this.settled(a), this.settled(b));
            let zero = this.int(0, wide);
            let cond = this.add(Expr::Cmp(CmpOp::Ne, b, zero));
            let then = this.body(|this| {
                this.quotient_in_range(a, b, [quotient_target, remainder_target]);
            });
            let otherwise = this.body(|this| {
                if saturate {
                    this.divide_by_zero(a, quotient_target, remainder_target, wide);
                } else {
                    this.division_error();
                }
            });
            this.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }));
        });
    }

    /// Stores quotient and remainder. On models with M8306, a quotient that is too large is an operation error (FX3
    /// programming manual §10.4).
    fn quotient_in_range(&mut self, a: ExprId, b: ExprId, targets: [Target; 2]) {
        let wide = self.wide();
        if !self.model.special_works(M_LARGE_QUOTIENT) {
            return self.store_quotient(a, b, targets);
        }
        if !self.may_leave_range() {
            let never = self.bit_const(false);
            self.set_flag(M_LARGE_QUOTIENT, never);
            return self.store_quotient(a, b, targets);
        }
        let least = if wide { i32::MIN } else { i16::MIN.into() };
        let (least, minus_one) = (self.is_int(a, least, wide), self.is_int(b, -1, wide));
        let cond = self.and(least, minus_one);
        self.set_flag(M_LARGE_QUOTIENT, cond);
        let then = self.body(Self::division_error);
        let otherwise = self.body(|this| this.store_quotient(a, b, targets));
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    /// Returns false if the constants of a division exclude a quotient that is too large.
    fn may_leave_range(&self) -> bool {
        let wide = self.wide();
        let excluded = |i: usize, limit: i64| {
            let constant = self.operand(i).and_then(OperandKind::constant);
            let value = constant.map(|value| match wide {
                true => i64::from(value as i32),
                false => i64::from(value as i16),
            });
            value.is_some_and(|value| value != limit)
        };
        let least = if wide {
            i32::MIN.into()
        } else {
            i16::MIN.into()
        };
        !excluded(0, least) && !excluded(1, -1)
    }

    fn store_quotient(
        &mut self,
        a: ExprId,
        b: ExprId,
        [quotient_target, remainder_target]: [Target; 2],
    ) {
        let wide = self.wide();
        let quotient = self.add(Expr::Bin(BinOp::Div, a, b));
        let quotient = self.flag_of(M_ZERO_PRODUCT, quotient, |this, quotient| {
            this.is_int(quotient, 0, wide)
        });
        let remainder = self.add(Expr::Bin(BinOp::Rem, a, b));
        self.store(quotient_target, quotient);
        self.store(remainder_target, remainder);
    }

    fn division_error(&mut self) {
        let step = self.step();
        self.emit(Action::Fault {
            code: DIVISION,
            step,
        });
    }

    /// The quotient is the end of the range on the dividend's side; nothing is left over.
    fn divide_by_zero(&mut self, a: ExprId, quotient: Target, remainder: Target, wide: bool) {
        let zero = self.int(0, wide);
        let cond = self.add(Expr::Cmp(CmpOp::Ge, a, zero));
        let (max, min) = if wide {
            (i32::MAX, i32::MIN)
        } else {
            (i32::from(i16::MAX), i32::from(i16::MIN))
        };
        let [then, otherwise] = [max, min].map(|end| {
            self.body(|this| {
                let end = this.int(end, wide);
                this.store(quotient, end);
            })
        });
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
        self.store(remainder, zero);
    }
}
