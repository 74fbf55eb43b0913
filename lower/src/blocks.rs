//! Instructions on a few consecutive devices, which are inline code: each device by name. The runtime is called for longer blocks,
//! and for those that an index leads to.

use super::Lowerer;
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, BinOp, Expr, ExprId, Stmt};
use rungc_rt::RtFn;
use rungc_rt::special::{M_BMOV_REVERSE, M_MEAN_SUM};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind};

/// Words that are moved one by one at most.
const WORDS: u32 = 8;
/// Bits and resets that are written one by one at most.
const BITS: u32 = 16;

/// Whether an instruction on a block that a runtime function implements is inline code, judging by its operands.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let count = |i, most| {
        kind(i)
            .and_then(constant)
            .is_some_and(|n| (1..=most as i32).contains(&n))
    };
    let register = |i| kind(i).and_then(register).is_some();
    match function {
        RtFn::Bmov | RtFn::BmovForward => register(0) && register(1) && count(2, WORDS),
        RtFn::Fmov => register(1) && count(2, WORDS),
        RtFn::Mean | RtFn::MeanSum => register(0) && count(2, WORDS),
        RtFn::Deco => {
            let source = register(0) || kind(0).and_then(bits).is_some();
            source && kind(1).and_then(bits).is_some() && count(2, BITS.ilog2())
        }
        RtFn::Zrst => match (
            kind(0).and_then(OperandKind::device),
            kind(1).and_then(OperandKind::device),
        ) {
            (Some(first), Some(last)) => {
                first.class == last.class && last.number.saturating_sub(first.number) < BITS
            }
            _ => false,
        },
        RtFn::Sftl | RtFn::Sftr => {
            let bits = |i| kind(i).and_then(OperandKind::device).is_some();
            let length = kind(2).and_then(constant).unwrap_or(0);
            bits(0) && bits(1) && count(2, BITS) && count(3, length.max(0) as u32)
        }
        _ => false,
    }
}

/// A bit device X, Y, M or S without an index.
pub(super) fn bits(operand: &OperandKind) -> Option<Device> {
    use DeviceClass::{M, S, X, Y};
    operand
        .device()
        .filter(|device| matches!(device.class, X | Y | M | S))
}

/// A data register without an index.
pub(super) fn register(operand: &OperandKind) -> Option<Device> {
    operand
        .device()
        .filter(|device| matches!(device.class, DeviceClass::D | DeviceClass::R))
}

impl Lowerer<'_> {
    /// Emits an instruction on a block as inline code; false if the runtime has to be called.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    pub(super) fn inline_block(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        let looked_at = |flag| self.specials.has(flag);
        let expand: fn(&mut Self) = match function {
            RtFn::Bmov if looked_at(M_BMOV_REVERSE) => return false,
            RtFn::MeanSum if looked_at(M_MEAN_SUM) => return false,
            RtFn::Mean | RtFn::MeanSum if self.wide() => return false,
            RtFn::Bmov | RtFn::BmovForward => Self::move_block,
            RtFn::Fmov => Self::fill_block,
            RtFn::Mean | RtFn::MeanSum => Self::mean,
            RtFn::Deco => Self::decode,
            RtFn::Zrst => Self::reset_block,
            RtFn::Sftl => |this| this.shift_bits(false),
            RtFn::Sftr => |this| this.shift_bits(true),
            _ => return false,
        };
        self.driven(expand);
        true
    }

    /// Operand `i` as a count that the program states.
    pub(super) fn stated(&self, i: usize) -> u32 {
        self.operand(i).and_then(constant).map_or(0, |n| n as u32)
    }

    /// The device that operand `i` names.
    pub(super) fn device_of(&self, i: usize) -> Option<Device> {
        self.operand(i).and_then(OperandKind::device)
    }

    /// A condition that never holds where `count` devices from one on do not all exist.
    pub(super) fn demand_block(&mut self, device: Device, count: u32, guards: &mut Guards) {
        if !self.exists(device.class, device.number, count) {
            guards.demand(self.bit_const(false));
        }
    }

    /// BMOV. Blocks that overlap are moved from the end on that is not written first.
    fn move_block(&mut self) {
        let n = self.stated(2);
        let (Some(from), Some(to)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let mut guards = Guards::default();
        self.demand_block(from, n, &mut guards);
        self.demand_block(to, n, &mut guards);
        let backwards =
            from.class == to.class && (from.number + 1..from.number + n).contains(&to.number);
        self.guarded(guards, |this| {
            for k in 0..n {
                let k = if backwards { n - 1 - k } else { k };
                let value = this.word_at(from, k);
                let (class, number) = this.model.canonical(to.class, to.number + k);
                this.emit(Stmt::Write(Access::word(fixed(class, number)), value));
            }
        });
    }

    /// Word number `k` from a register on.
    pub(super) fn word_at(&mut self, register: Device, k: u32) -> ExprId {
        let (class, number) = self.model.canonical(register.class, register.number + k);
        self.add(Expr::Read(Access::word(fixed(class, number))))
    }

    /// FMOV.
    fn fill_block(&mut self) {
        let (n, wide) = (self.stated(2), self.wide());
        let Some(to) = self.device_of(1) else {
            return;
        };
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        self.demand_block(to, if wide { 2 * n } else { n }, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            for k in 0..n {
                let mut exists = Guards::default();
                let target = this.result_element(1, k, wide, &mut exists);
                this.store(target, value);
            }
        });
    }

    /// MEAN of words: its fraction is dropped.
    fn mean(&mut self) {
        let n = self.stated(2);
        let Some(from) = self.device_of(0) else {
            return;
        };
        let mut guards = Guards::default();
        self.demand_block(from, n, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let first = this.word_at(from, 0);
            let mut sum = this.add(Expr::Widen(first));
            for k in 1..n {
                let word = this.word_at(from, k);
                let word = this.add(Expr::Widen(word));
                sum = this.add(Expr::Bin(BinOp::Add, sum, word));
            }
            let n = this.add(Expr::I32(n as i32));
            let mean = this.add(Expr::Bin(BinOp::Div, sum, n));
            let mean = this.add(Expr::Narrow(mean));
            this.store(target, mean);
        });
    }

    /// DECO into bits: of 2ⁿ bits the one is on whose number the low n bits of S are.
    fn decode(&mut self) {
        let count = 1 << self.stated(2);
        let Some(first) = self.device_of(1) else {
            return;
        };
        let mut guards = Guards::default();
        let value = self.decoded(self.stated(2), &mut guards);
        self.demand_block(first, count, &mut guards);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            for k in 0..count {
                let on = this.is_int(value, k as i32, false);
                this.emit(Stmt::Write(
                    Access::bit(fixed(first.class, first.number + k)),
                    on,
                ));
            }
        });
    }

    /// ZRST: where D2 lies below D1, D1 alone.
    fn reset_block(&mut self) {
        let (Some(first), Some(last)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let last = last.number.max(first.number);
        let mut guards = Guards::default();
        self.demand_block(first, last - first.number + 1, &mut guards);
        self.guarded(guards, |this| {
            for number in first.number..=last {
                let (class, number) = this.model.canonical(first.class, number);
                let place = fixed(class, number);
                let reset = match class {
                    DeviceClass::T | DeviceClass::C => Stmt::Reset(place),
                    DeviceClass::Y | DeviceClass::M | DeviceClass::S | DeviceClass::X => {
                        let off = this.bit_const(false);
                        Stmt::Write(Access::bit(place), off)
                    }
                    DeviceClass::D
                    | DeviceClass::R
                    | DeviceClass::ER
                    | DeviceClass::V
                    | DeviceClass::Z
                    | DeviceClass::P
                    | DeviceClass::I
                    | DeviceClass::N => {
                        let zero = this.int(0, false);
                        Stmt::Write(Access::word(place), zero)
                    }
                };
                this.emit(reset);
            }
        });
    }

    /// SFTR and SFTL: n1 bits move on by n2 places, n2 others enter.
    fn shift_bits(&mut self, right: bool) {
        let (length, by) = (self.stated(2), self.stated(3));
        let (Some(from), Some(to)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let mut guards = Guards::default();
        self.demand_block(from, by, &mut guards);
        self.demand_block(to, length, &mut guards);
        let first = if right { length - by } else { 0 };
        self.guarded(guards, |this| {
            for k in 0..length - by {
                let (source, target) = match right {
                    true => (k + by, k),
                    false => (length - 1 - by - k, length - 1 - k),
                };
                this.copy_bit((to, source), (to, target));
            }
            for k in 0..by {
                this.copy_bit((from, k), (to, first + k));
            }
        });
    }

    /// Copies a bit from one block to another; each is named by its first device and a place.
    fn copy_bit(&mut self, from: (Device, u32), to: (Device, u32)) {
        let nth = |(device, k): (Device, u32)| Device {
            number: device.number + k,
            ..device
        };
        let mut exists = Guards::default();
        let state = self.bit(&OperandKind::Device(nth(from), None), &mut exists);
        let to = nth(to);
        self.emit(Stmt::Write(Access::bit(fixed(to.class, to.number)), state));
    }
}
