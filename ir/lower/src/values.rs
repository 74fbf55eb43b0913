//! Operations on values, which are inline code whatever their operands are.

use super::Lowerer;
use super::operand::{Guards, Target};
use super::words::constant;
use rungc_catalogue::ValueOp;
use rungc_ir::node::{Access, BinOp, Branch, Expr, ExprId, Stmt, UnOp};
use rungc_rt::special::{M_BORROW, M_CARRY, M_XCH_BYTES, M_ZERO};
use rungc_rt::{CmpOp, Fault};

/// The bounds of a range are the wrong way round.
const WRONG_BOUNDS: u16 = Fault::DEVICE.0;

impl Lowerer<'_> {
    /// Emits an operation, executed where its operands are within the model's limits.
    pub(super) fn values(&mut self, op: ValueOp) {
        self.within_limits(None, |this, _| this.operate(op));
    }

    fn operate(&mut self, op: ValueOp) {
        match op {
            ValueOp::Segments => self.show_digit(),
            ValueOp::Limit => self.between(|_, _, held| held),
            ValueOp::Band => {
                self.between(|this, value, held| this.add(Expr::Bin(BinOp::Sub, value, held)))
            }
            ValueOp::Zone => self.move_from_zero(),
            ValueOp::SwapBytes => self.swap_bytes(),
            ValueOp::Exchange { bytes } => self.exchange(bytes),
            ValueOp::Alternate => self.alternate(),
            ValueOp::ToBcd { clamps } => self.pack_digits(clamps),
            ValueOp::FromBcd { checks } => self.unpack_digits(checks),
            ValueOp::CountOnes => self.count_ones(),
            ValueOp::TestBit => self.test_bit(),
            ValueOp::RotateRight => self.rotate(true),
            ValueOp::RotateLeft => self.rotate(false),
            ValueOp::Root { clamps } => self.square_root(clamps),
            ValueOp::ToGray => self.gray(),
            ValueOp::FromGray => self.binary_of_gray(),
        }
    }

    /// SEGD: the segments go to the low byte of D, the high one stays.
    fn show_digit(&mut self) {
        let mut guards = Guards::default();
        let digit = self.source(0, &mut guards);
        let old = self.source(1, &mut guards);
        let target = self.result(1, &mut guards);
        let segments = self.add(Expr::Un(UnOp::Segments, digit));
        let high = self.int(-256, false);
        let kept = self.add(Expr::Bin(BinOp::And, old, high));
        let value = self.add(Expr::Bin(BinOp::Or, kept, segments));
        self.guarded(guards, |this| this.store(target, value));
    }

    /// LIMIT and BAND: what `make` makes of S3, and of S3 held between S1 and S2.
    fn between(&mut self, make: impl FnOnce(&mut Self, ExprId, ExprId) -> ExprId) {
        let mut guards = Guards::default();
        let values = [0, 1, 2].map(|i| self.source(i, &mut guards));
        let target = self.result(3, &mut guards);
        self.guarded(guards, |this| {
            let [low, high, value] = values.map(|value| this.settled(value));
            let fits = this.add(Expr::Cmp(CmpOp::Le, low, high));
            this.checked(fits, WRONG_BOUNDS, |this| {
                let held = this.add(Expr::Bin(BinOp::Max, value, low));
                let held = this.add(Expr::Bin(BinOp::Min, held, high));
                let result = make(this, value, held);
                this.store(target, result);
            });
        });
    }

    /// ZONE: 0 stays 0.
    fn move_from_zero(&mut self) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let [below, above, value] = [0, 1, 2].map(|i| self.source(i, &mut guards));
        let target = self.result(3, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            let zero = this.int(0, wide);
            let [negative, positive] =
                [CmpOp::Lt, CmpOp::Gt].map(|op| this.add(Expr::Cmp(op, value, zero)));
            let moved = |this: &mut Self, by| {
                let moved = this.add(Expr::Bin(BinOp::Add, value, by));
                this.body(|this| this.store(target, moved))
            };
            let (down, up) = (moved(this, below), moved(this, above));
            let stays = this.body(|this| this.store(target, zero));
            let from_zero = Stmt::If(Branch {
                cond: positive,
                then: up,
                otherwise: stays,
            });
            this.emit(Stmt::If(Branch {
                cond: negative,
                then: down,
                otherwise: vec![from_zero],
            }));
        });
    }

    /// SWAP.
    fn swap_bytes(&mut self) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(0, &mut guards);
        let value = self.add(Expr::Un(UnOp::SwapBytes, value));
        self.guarded(guards, |this| this.store(target, value));
    }

    /// XCH: both values are read before one is written.
    fn exchange(&mut self, bytes: bool) {
        let same = self.operand(0) == self.operand(1);
        if bytes && same && self.specials.has(M_XCH_BYTES) {
            let cond = self.add(Expr::Read(Access::bit(M_XCH_BYTES)));
            let then = self.body(Self::swap_bytes);
            let otherwise = self.body(|this| this.exchange(false));
            return self.emit(Stmt::If(Branch {
                cond,
                then,
                otherwise,
            }));
        }
        let mut guards = Guards::default();
        let values = [0, 1].map(|i| self.source(i, &mut guards));
        let targets = [0, 1].map(|i| self.result(i, &mut guards));
        self.guarded(guards, |this| {
            if same {
                return;
            }
            let [a, b] = values.map(|value| this.settled(value));
            this.store(targets[0], b);
            this.store(targets[1], a);
        });
    }

    /// ALT.
    fn alternate(&mut self) {
        let mut guards = Guards::default();
        let Some(operand) = self.operand(0) else {
            return;
        };
        let operand = operand.clone();
        let state = self.bit(&operand, &mut guards);
        let wide = self.wide();
        let Some(target) = self.bit_target(&operand, 1, wide, &mut guards) else {
            return;
        };
        let inverted = self.not(state);
        self.guarded(guards, |this| this.store_bit(target, 0, inverted));
    }

    /// Condition that a value lies between two numbers.
    pub(super) fn lies_in(&mut self, value: ExprId, (least, most): (i32, i32)) -> ExprId {
        let wide = self.wide();
        let [least, most] = [least, most].map(|end| self.int(end, wide));
        let not_below = self.add(Expr::Cmp(CmpOp::Ge, value, least));
        let not_above = self.add(Expr::Cmp(CmpOp::Le, value, most));
        self.and(not_below, not_above)
    }

    /// A value held between two numbers.
    fn clamped(&mut self, value: ExprId, (least, most): (i32, i32)) -> ExprId {
        let wide = self.wide();
        let [least, most] = [least, most].map(|end| self.int(end, wide));
        let value = self.add(Expr::Bin(BinOp::Max, value, least));
        self.add(Expr::Bin(BinOp::Min, value, most))
    }

    /// BCD: a value that has more digits than the form faults, or is held at the largest and at 0.
    fn pack_digits(&mut self, clamps: bool) {
        let shown = (0, if self.wide() { 99_999_999 } else { 9999 });
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            if clamps {
                let value = this.clamped(value, shown);
                let digits = this.add(Expr::Un(UnOp::ToBcd, value));
                return this.store(target, digits);
            }
            let value = this.settled(value);
            let fits = this.lies_in(value, shown);
            this.checked(fits, this.model.value_error, |this| {
                let digits = this.add(Expr::Un(UnOp::ToBcd, value));
                this.store(target, digits);
            });
        });
    }

    /// BIN: where it is checked, a digit above 9 faults.
    fn unpack_digits(&mut self, checked: bool) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            let number = this.add(Expr::Un(UnOp::FromBcd, value));
            if !checked {
                return this.store(target, number);
            }
            let fits = this.add(Expr::Un(UnOp::IsBcd, value));
            this.checked(fits, this.model.value_error, |this| {
                this.store(target, number);
            });
        });
    }

    /// SUM, and M8020 if there are none.
    fn count_ones(&mut self) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let ones = this.add(Expr::Un(UnOp::CountOnes, value));
            let ones = this.flagged(ones, |this, ones| {
                let none = this.is_int(ones, 0, wide);
                this.set_flag(M_ZERO, none);
            });
            this.store(target, ones);
        });
    }

    /// The value, and what `set` does with it if something looks at a flag of arithmetic.
    pub(super) fn flagged(&mut self, value: ExprId, set: impl FnOnce(&mut Self, ExprId)) -> ExprId {
        if !self.looks_at_flags() {
            return value;
        }
        let value = self.settled(value);
        set(self, value);
        value
    }

    /// BON: a bit that the value does not have is an error.
    fn test_bit(&mut self) {
        let wide = self.wide();
        let last = if wide { 31 } else { 15 };
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let bit = self.source(2, &mut guards);
        let Some(operand) = self.operand(1).cloned() else {
            return;
        };
        let Some(target) = self.bit_target(&operand, 1, wide, &mut guards) else {
            return;
        };
        let stated = self.operand(2).and_then(constant);
        self.guarded(guards, |this| {
            let zero = this.int(0, wide);
            if let Some(bit @ 0..=31) = stated.filter(|&bit| bit <= last) {
                let mask = this.int((1u32 << bit) as i32, wide);
                let masked = this.add(Expr::Bin(BinOp::And, value, mask));
                let on = this.add(Expr::Cmp(CmpOp::Ne, masked, zero));
                return this.store_bit(target, 0, on);
            }
            let bit = this.settled(bit);
            let fits = this.lies_in(bit, (0, last));
            this.checked(fits, this.model.value_error, |this| {
                let right = this.add(Expr::Bin(BinOp::Sub, zero, bit));
                let lowest = this.add(Expr::Bin(BinOp::RotateLeft, value, right));
                let one = this.int(1, wide);
                let masked = this.add(Expr::Bin(BinOp::And, lowest, one));
                let on = this.add(Expr::Cmp(CmpOp::Ne, masked, zero));
                this.store_bit(target, 0, on);
            });
        });
    }

    /// ROR and ROL: the bit that passed the end last is in the carry flag, too. By 0 places, nothing changes.
    fn rotate(&mut self, right: bool) {
        let wide = self.wide();
        let width = if wide { 32 } else { 16 };
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let places = self.source(1, &mut guards);
        let target = self.result(0, &mut guards);
        if let Some(places) = self
            .operand(1)
            .and_then(constant)
            .filter(|n| (1..=width).contains(n))
        {
            let left = if right { width - places } else { places } % width;
            let left = self.int(left, wide);
            return self.guarded(guards, |this| this.rotate_left(value, left, right, target));
        }
        self.guarded(guards, |this| {
            let places = this.settled(places);
            let fits = this.lies_in(places, (0, width));
            this.checked(fits, this.model.value_error, |this| {
                let zero = this.int(0, wide);
                let some = this.add(Expr::Cmp(CmpOp::Ne, places, zero));
                this.when(some, |this| {
                    let left = match right {
                        true => this.add(Expr::Bin(BinOp::Sub, zero, places)),
                        false => places,
                    };
                    this.rotate_left(value, left, right, target);
                });
            });
        });
    }

    /// Rotates left by a number of places that is not 0; to the `right` if that is how the program has it.
    fn rotate_left(&mut self, value: ExprId, left: ExprId, right: bool, target: Target) {
        let wide = self.wide();
        let rotated = self.add(Expr::Bin(BinOp::RotateLeft, value, left));
        let rotated = self.flagged(rotated, |this, rotated| {
            let zero = this.int(0, wide);
            let last = if right {
                this.add(Expr::Cmp(CmpOp::Lt, rotated, zero))
            } else {
                let one = this.int(1, wide);
                let lowest = this.add(Expr::Bin(BinOp::And, rotated, one));
                this.add(Expr::Cmp(CmpOp::Ne, lowest, zero))
            };
            this.set_flag(M_CARRY, last);
        });
        self.store(target, rotated);
    }

    /// SQR: a negative value faults, or counts as 0. M8020 for 0, M8021 for a dropped fraction.
    fn square_root(&mut self, clamps: bool) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            if clamps {
                let zero = this.int(0, this.wide());
                let value = this.add(Expr::Bin(BinOp::Max, value, zero));
                let value = this.settled(value);
                return this.store_root(value, target);
            }
            let value = this.settled(value);
            let fits = this.is_not_negative(value);
            this.checked(fits, this.model.value_error, |this| {
                this.store_root(value, target);
            });
        });
    }

    fn is_not_negative(&mut self, value: ExprId) -> ExprId {
        let zero = self.int(0, self.wide());
        self.add(Expr::Cmp(CmpOp::Ge, value, zero))
    }

    /// The root of a value that is not negative.
    fn store_root(&mut self, value: ExprId, target: Target) {
        let wide = self.wide();
        let value = match wide {
            true => value,
            false => self.add(Expr::Widen(value)),
        };
        let root = self.add(Expr::Un(UnOp::Root, value));
        let root = self.flagged(root, |this, root| {
            let none = this.is_int(root, 0, true);
            let square = this.add(Expr::Bin(BinOp::Mul, root, root));
            let dropped = this.add(Expr::Cmp(CmpOp::Ne, square, value));
            this.set_flag(M_ZERO, none);
            this.set_flag(M_BORROW, dropped);
        });
        let root = match wide {
            true => root,
            false => self.add(Expr::Narrow(root)),
        };
        self.store(target, root);
    }

    /// A value that is not negative and what `make` makes of it; a negative one is an error.
    fn of_positive(&mut self, make: impl FnOnce(&mut Self, ExprId) -> ExprId) {
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            let fits = this.is_not_negative(value);
            this.checked(fits, this.model.value_error, |this| {
                let result = make(this, value);
                this.store(target, result);
            });
        });
    }

    /// The exclusive or of a value that is not negative and the same shifted right.
    fn mixed_with_shifted(&mut self, value: ExprId, places: u32) -> ExprId {
        let divisor = self.int(1 << places, self.wide());
        let shifted = self.add(Expr::Bin(BinOp::Div, value, divisor));
        self.add(Expr::Bin(BinOp::Xor, value, shifted))
    }

    /// GRY.
    fn gray(&mut self) {
        self.of_positive(|this, value| this.mixed_with_shifted(value, 1));
    }

    /// GBIN.
    fn binary_of_gray(&mut self) {
        self.of_positive(|this, value| {
            let places: &[u32] = if this.wide() {
                &[1, 2, 4, 8, 16]
            } else {
                &[1, 2, 4, 8]
            };
            places.iter().fold(value, |value, &places| {
                let mixed = this.mixed_with_shifted(value, places);
                this.settled(mixed)
            })
        });
    }
}
