//! Instructions on digits and bits of one word, which are inline code where the program states how many: SMOV, RCR and
//! RCL, DECO of words, ENCO.

use super::Lowerer;
use super::blocks::{bits, register};
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, AccessKind, BinOp, Branch, Expr, ExprId, Stmt, UnOp};
use rungc_rt::special::{M_CARRY, M_SMOV_HEX};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Device, Instr, OperandKind};

/// The most bits of a word that DECO decodes: a power of 2.
const DECODED: i32 = 4;

/// Of how many bits ENCO finds the highest, as powers of 2: of a word, of bit devices.
const ENCODED_OF_WORD: i32 = 4;
const ENCODED_OF_BITS: i32 = 5;

/// Returns true if such an instruction is inline code, judging by its operands.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let stated = |i, most| {
        let constant = kind(i).and_then(constant);
        constant.filter(|n| (1..=most).contains(n))
    };
    match function {
        RtFn::Smov => match (stated(1, 4), stated(2, 4), stated(4, 4)) {
            (Some(from), Some(count), Some(to)) => count <= from && count <= to,
            _ => false,
        },
        RtFn::Rcr | RtFn::Rcl => stated(1, 16).is_some(),
        RtFn::Deco => {
            let source = kind(0).is_some_and(|operand| register(operand).is_some())
                || kind(0).and_then(bits).is_some();
            let target = kind(1).and_then(register).is_some();
            source && target && stated(2, DECODED).is_some()
        }
        RtFn::Enco | RtFn::EncoZero => {
            let word = kind(0).is_some_and(is_whole) && stated(2, ENCODED_OF_WORD).is_some();
            let bits = kind(0).and_then(bits).is_some() && stated(2, ENCODED_OF_BITS).is_some();
            word || bits
        }
        _ => false,
    }
}

/// Returns true for a register or a constant.
fn is_whole(operand: &OperandKind) -> bool {
    register(operand).is_some() || constant(operand).is_some()
}

/// Returns true if an instruction that is inline code reads the flag of its row, so that others have to set it.
pub(super) fn reads_flag(function: RtFn) -> bool {
    matches!(function, RtFn::Rcr | RtFn::Rcl)
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    pub(super) fn inline_digits(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        match function {
            // With M8168 the digits are those of four bits.
            RtFn::Smov if self.specials.has(M_SMOV_HEX) => return false,
            RtFn::Smov => self.driven(Self::move_digits),
            RtFn::Rcr => self.driven(|this| this.rotate_with_carry(true)),
            RtFn::Rcl => self.driven(|this| this.rotate_with_carry(false)),
            RtFn::Deco => self.driven(Self::decode_word),
            RtFn::Enco => self.driven(|this| this.encode(false)),
            RtFn::EncoZero => self.driven(|this| this.encode(true)),
            _ => return false,
        }
        true
    }

    /// SMOV: both values are taken apart into digits; one that has more than four faults.
    fn move_digits(&mut self) {
        let [from, count, to] = [1, 2, 4].map(|i| self.stated(i) as i32);
        let mut guards = Guards::default();
        let values = [0, 3].map(|i| self.source(i, &mut guards));
        let target = self.result(3, &mut guards);
        let mask = ((1 << (4 * count)) - 1) << (4 * (to - count));
        self.guarded(guards, |this| {
            let [source, old] = values.map(|value| this.settled(value));
            let fits = [source, old].map(|value| this.has_four_digits(value));
            let fits = this.and(fits[0], fits[1]);
            this.checked(fits, this.model.value_error, |this| {
                let [source, old] =
                    [source, old].map(|value| this.add(Expr::Un(UnOp::ToBcd, value)));
                let moved = this.rotated(source, 4 * (to - from), false);
                let moved = this.masked(moved, mask, false);
                let kept = this.masked(old, !mask, false);
                let digits = this.add(Expr::Bin(BinOp::Or, kept, moved));
                let value = this.add(Expr::Un(UnOp::FromBcd, digits));
                this.store(target, value);
            });
        });
    }

    /// Condition that a word is a number of at most four decimal digits.
    fn has_four_digits(&mut self, value: ExprId) -> ExprId {
        let (least, most) = (self.int(0, false), self.int(9999, false));
        let not_below = self.add(Expr::Cmp(CmpOp::Ge, value, least));
        let not_above = self.add(Expr::Cmp(CmpOp::Le, value, most));
        self.and(not_below, not_above)
    }

    /// The bits of a value rotated left by `places`, right if these are negative.
    fn rotated(&mut self, value: ExprId, places: i32, wide: bool) -> ExprId {
        let width = if wide { 32 } else { 16 };
        match places.rem_euclid(width) {
            0 => value,
            places => {
                let places = self.int(places, wide);
                self.add(Expr::Bin(BinOp::RotateLeft, value, places))
            }
        }
    }

    fn masked(&mut self, value: ExprId, mask: i32, wide: bool) -> ExprId {
        let mask = self.int(mask, wide);
        self.add(Expr::Bin(BinOp::And, value, mask))
    }

    /// RCR and RCL: the carry flag is above the highest bit of the value, and all of them rotate.
    fn rotate_with_carry(&mut self, right: bool) {
        let wide = self.wide();
        let width = if wide { 32 } else { 16 };
        let places = self.stated(1) as i32;
        let places = if right { places } else { width + 1 - places };
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        let target = self.result(0, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            let carry = this.add(Expr::Read(Access::bit(M_CARRY)));
            let carry = this.add(Expr::BitToInt(carry));
            let carry = if wide {
                this.add(Expr::Widen(carry))
            } else {
                carry
            };
            // Position of the carry flag; the value is below and above it.
            let seam = width - places;
            let mut rotated = this.rotated(carry, seam, wide);
            if seam > 0 {
                let low = this.rotated(value, -places, wide);
                let low = this.masked(low, ((1i64 << seam) - 1) as i32, wide);
                rotated = this.add(Expr::Bin(BinOp::Or, rotated, low));
            }
            if places > 1 {
                let high = this.rotated(value, seam + 1, wide);
                let high = this.masked(high, (-1i64 << (seam + 1)) as i32, wide);
                rotated = this.add(Expr::Bin(BinOp::Or, rotated, high));
            }
            let rotated = this.settled(rotated);
            let last = this.masked(value, (1i64 << (places - 1)) as i32, wide);
            let zero = this.int(0, wide);
            let last = this.add(Expr::Cmp(CmpOp::Ne, last, zero));
            this.store(target, rotated);
            this.set_flag(M_CARRY, last);
        });
    }

    /// DECO into a word: of its bits the one is on whose number the low n bits of S are.
    fn decode_word(&mut self) {
        let count = self.stated(2);
        let mut guards = Guards::default();
        let value = self.decoded(count, &mut guards);
        let target = self.result(1, &mut guards);
        let one = self.int(1, false);
        let bit = self.add(Expr::Bin(BinOp::RotateLeft, one, value));
        self.guarded(guards, |this| this.store(target, bit));
    }

    /// ENCO: the highest bit that is on goes to D; that none is on is an error.
    fn encode(&mut self, zero_of_none: bool) {
        let count = 1 << self.stated(2);
        let mut guards = Guards::default();
        let value = self.bits_as_number(count, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            let none = this.is_int(value, 0, true);
            if zero_of_none {
                let zero = this.int(0, false);
                let then = this.body(|this| this.store(target, zero));
                this.emit(Stmt::If(Branch {
                    cond: none,
                    then,
                    otherwise: Vec::new(),
                }));
            }
            let some = this.not(none);
            this.checked(some, this.model.value_error, |this| {
                let highest = this.add(Expr::Un(UnOp::HighestBit, value));
                let highest = this.add(Expr::Narrow(highest));
                this.store(target, highest);
            });
        });
    }

    /// The `count` bits of operand 0, up to 32, as an `I32`.
    fn bits_as_number(&mut self, count: u32, guards: &mut Guards) -> ExprId {
        let first = self.operand(0).and_then(bits);
        match first {
            Some(first) if count >= 4 => {
                self.demand_block(first, count, guards);
                let digits = (count / 4) as u8;
                let place = fixed(first.class, first.number);
                let kind = AccessKind::Nibbles { digits, wide: true };
                self.add(Expr::Read(kind.at(place)))
            }
            Some(_) => {
                let number = self.decoded(count, guards);
                self.add(Expr::Widen(number))
            }
            None => {
                let value = self.source(0, guards);
                let value = self.add(Expr::Widen(value));
                self.masked(value, (1 << count) - 1, true)
            }
        }
    }

    /// The number that the low `count` bits of operand 0 are: of a word, or of bit devices.
    pub(super) fn decoded(&mut self, count: u32, guards: &mut Guards) -> ExprId {
        let first = self.operand(0).and_then(bits);
        let Some(first) = first else {
            let value = self.source(0, guards);
            return self.masked(value, (1 << count) - 1, false);
        };
        self.demand_block(first, count, guards);
        let mut number = self.int(0, false);
        for k in 0..count {
            let device = Device {
                number: first.number + k,
                ..first
            };
            let mut exists = Guards::default();
            let bit = self.bit(&OperandKind::Device(device, None), &mut exists);
            let bit = self.add(Expr::BitToInt(bit));
            let bit = self.rotated(bit, k as i32, false);
            number = match k {
                0 => bit,
                _ => self.add(Expr::Bin(BinOp::Or, number, bit)),
            };
        }
        number
    }
}
