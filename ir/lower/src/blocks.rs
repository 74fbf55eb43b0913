//! Instructions on consecutive devices, which are inline code: of a few, each device by name; longer runs are copied or
//! filled as a whole. Those that an index leads to are in `indexed_blocks`.

use super::Lowerer;
use super::indexed_blocks;
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, Action, BinOp, Expr, ExprId, Place, Stmt};
use rungc_models::runs::is_special;
use rungc_rt::RtFn;
use rungc_rt::special::{M_BMOV_REVERSE, M_MEAN_SUM};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind};

/// Words that are moved, and bits that are shifted, one by one at most.
const WORDS: u32 = 8;
/// Bits that are written one by one at most.
const BITS: u32 = 16;
/// Timers or counters that are reset one by one at most.
const RESETS: u32 = 64;
/// The most that BMOV and FMOV move.
pub(super) const MOVED: u32 = 512;
/// The most bits and the most words that are shifted.
pub(super) const SHIFTED_BITS: u32 = 1024;
pub(super) const SHIFTED_WORDS: u32 = 2048;
/// Of how many bits DECO takes a number.
const DECODED: u32 = 8;

/// Returns true if an instruction on a block that a runtime function implements is inline code, judging by its
/// operands.
pub(super) fn is_inline(function: RtFn, instr: &Instr, wide: bool) -> bool {
    is_plain(function, instr) || indexed_blocks::is_inline(function, instr, wide)
}

/// Returns true if the devices of such an instruction have no index, and the program states their number.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
fn is_plain(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let count = |i, most| {
        kind(i)
            .and_then(constant)
            .is_some_and(|n| (1..=most as i32).contains(&n))
    };
    let stated = |i| kind(i).and_then(constant).unwrap_or(0).max(0) as u32;
    let register = |i| kind(i).and_then(register).is_some();
    match function {
        RtFn::Bmov | RtFn::BmovForward => register(0) && register(1) && count(2, MOVED),
        RtFn::Fmov => register(1) && count(2, MOVED),
        RtFn::Mean | RtFn::MeanSum => register(0) && count(2, WORDS),
        RtFn::Deco => {
            let source = register(0) || kind(0).and_then(bits).is_some();
            source && kind(1).and_then(bits).is_some() && count(2, DECODED)
        }
        RtFn::Zrst => match (
            kind(0).and_then(OperandKind::device),
            kind(1).and_then(OperandKind::device),
        ) {
            (Some(first), Some(last)) => {
                let length = last.number.saturating_sub(first.number) + 1;
                first.class == last.class && length <= resets(first.class)
            }
            _ => false,
        },
        RtFn::Sftl | RtFn::Sftr => {
            let bits = |i| kind(i).and_then(bits).is_some();
            bits(0) && bits(1) && count(2, SHIFTED_BITS) && count(3, stated(2))
        }
        RtFn::Wsfl | RtFn::Wsfr => {
            register(0) && register(1) && count(2, SHIFTED_WORDS) && count(3, stated(2))
        }
        _ => false,
    }
}

/// Number of devices of a class that ZRST resets inline.
fn resets(class: DeviceClass) -> u32 {
    use DeviceClass::{C, D, ER, I, M, N, P, R, S, T, V, X, Y, Z};
    match class {
        X | Y | M | S | D | R => u32::MAX,
        T | C => RESETS,
        V | Z | ER | P | I | N => BITS,
    }
}

/// Maximum number of devices of a class that are reset one by one.
fn resets_singly(class: DeviceClass) -> u32 {
    match resets(class) {
        u32::MAX => BITS,
        most => most,
    }
}

/// Returns true if no device of a run is special.
fn ordinary(first: Device, count: u32) -> bool {
    !is_special(first.class, first.number) && !is_special(first.class, first.number + count - 1)
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
        if !is_plain(function, self.instr()) {
            return self.inline_indexed_block(function);
        }
        let looked_at = |flag| self.specials.has(flag);
        let expand: fn(&mut Self) = match function {
            RtFn::MeanSum if looked_at(M_MEAN_SUM) => return false,
            RtFn::Mean | RtFn::MeanSum if self.wide() => return false,
            RtFn::Bmov if looked_at(M_BMOV_REVERSE) => return self.inline_indexed_block(function),
            _ if self.is_odd(function) => return false,
            RtFn::Bmov | RtFn::BmovForward => Self::move_block,
            RtFn::Fmov => Self::fill_block,
            RtFn::Mean | RtFn::MeanSum => Self::mean,
            RtFn::Deco => Self::decode,
            RtFn::Zrst => Self::reset_block,
            RtFn::Sftl => |this| this.shift_bits(false),
            RtFn::Sftr => |this| this.shift_bits(true),
            RtFn::Wsfl => |this| this.shift_words(false),
            RtFn::Wsfr => |this| this.shift_words(true),
            _ => return false,
        };
        self.driven(expand);
        true
    }

    /// Emits an instruction on blocks of which one has an index or a length in a register, if that is inline code.
    fn inline_indexed_block(&mut self, function: RtFn) -> bool {
        let inline = indexed_blocks::is_inline(function, self.instr(), self.wide());
        if inline {
            self.indexed_block(function);
        }
        inline
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

    /// BMOV.
    fn move_block(&mut self) {
        let n = self.stated(2);
        let (Some(from), Some(to)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let backwards =
            from.class == to.class && (from.number + 1..from.number + n).contains(&to.number);
        self.with_blocks([(from, n), (to, n)], |this| {
            this.copy_words(from, to, n, backwards);
        });
    }

    /// Emits the statements of `make`, executed if both runs of devices exist; else the instruction faults.
    fn with_blocks(&mut self, runs: [(Device, u32); 2], make: impl FnOnce(&mut Self)) {
        let exist = runs
            .iter()
            .all(|&(first, count)| self.exists(first.class, first.number, count));
        let mut guards = Guards::default();
        if !exist {
            guards.demand(self.bit_const(false));
        }
        self.guarded(guards, |this| {
            if exist {
                make(this);
            }
        });
    }

    /// Copies words, a few of them one by one, `backwards` from the last one on.
    pub(super) fn copy_words(&mut self, from: Device, to: Device, count: u32, backwards: bool) {
        if count > WORDS {
            return self.copy_run(from, to, count);
        }
        for k in 0..count {
            let k = if backwards { count - 1 - k } else { k };
            let value = self.word_at(from, k);
            self.put_word(to, k, value);
        }
    }

    /// Writes word number `k` from a register on.
    fn put_word(&mut self, register: Device, k: u32, value: ExprId) {
        let (class, number) = self.model.canonical(register.class, register.number + k);
        self.emit(Action::Write(Access::word(fixed(class, number)), value));
    }

    fn copy_run(&mut self, from: Device, to: Device, count: u32) {
        let [from, to] = [from, to].map(|first| fixed(first.class, first.number));
        self.copy_block(from, to, count, None);
    }

    fn fill_run(&mut self, to: Device, count: u32, value: ExprId) {
        let to = fixed(to.class, to.number);
        self.fill_block_with(to, count, None, value);
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
        let words = if wide { 2 * n } else { n };
        self.demand_block(to, words, &mut guards);
        let exists = self.exists(to.class, to.number, words);
        self.guarded(guards, |this| {
            if n > WORDS {
                match wide {
                    _ if !exists => {}
                    true => this.fill_pairs_from(fixed(to.class, to.number), n, value),
                    false => this.fill_run(to, n, value),
                }
                return;
            }
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
        let exists = self.exists(first.class, first.number, count);
        self.guarded(guards, |this| {
            let value = this.settled(value);
            if count > BITS {
                if exists {
                    this.decode_into_run(first, count, value);
                }
                return;
            }
            for k in 0..count {
                let on = this.is_int(value, k as i32, false);
                this.emit(Action::Write(
                    Access::bit(fixed(first.class, first.number + k)),
                    on,
                ));
            }
        });
    }

    /// Switches all of some bits off but the one of this number.
    fn decode_into_run(&mut self, first: Device, count: u32, value: ExprId) {
        let off = self.bit_const(false);
        self.fill_run(first, count, off);
        let index = self.add(Expr::Widen(value));
        let index = self.within(index, Some((0, count as i32 - 1)));
        let place = Place {
            index: Some(index),
            ..fixed(first.class, first.number)
        };
        let on = self.bit_const(true);
        self.emit(Action::Write(Access::bit(place), on));
    }

    /// Returns true if an instruction has a long run that is not copied or filled as a whole: some of its devices are
    /// special, or those that enter a shift overlap so that one by one they enter more than once.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    fn is_odd(&self, function: RtFn) -> bool {
        let (Some(second), n) = (self.device_of(1), self.stated(2)) else {
            return false;
        };
        // The first operand of some may be a constant.
        let first = self.device_of(0).unwrap_or(second);
        let runs = match function {
            RtFn::Bmov | RtFn::BmovForward => [(first, n), (second, n)],
            RtFn::Fmov => [(second, if self.wide() { 2 * n } else { n }); 2],
            RtFn::Deco => [(second, 1 << n); 2],
            RtFn::Zrst => {
                let count = second.number.saturating_sub(first.number) + 1;
                [(first, count); 2]
            }
            RtFn::Sftl | RtFn::Sftr | RtFn::Wsfl | RtFn::Wsfr => {
                let by = self.stated(3);
                let right = matches!(function, RtFn::Sftr | RtFn::Wsfr);
                let enter = second.number + if right { n - by } else { 0 };
                let again = first.number + 1..first.number + by;
                if by > WORDS && first.class == second.class && again.contains(&enter) {
                    return true;
                }
                [(first, by), (second, n)]
            }
            _ => return false,
        };
        let is_long = |(_, count): &(Device, u32)| *count > WORDS;
        let mut long = runs.into_iter().filter(is_long);
        long.any(|(first, count)| !ordinary(first, count))
    }

    /// ZRST: where D2 lies below D1, D1 alone.
    fn reset_block(&mut self) {
        let (Some(first), Some(last)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let last = last.number.max(first.number);
        let mut guards = Guards::default();
        let count = last - first.number + 1;
        self.demand_block(first, count, &mut guards);
        let exists = self.exists(first.class, first.number, count);
        self.guarded(guards, |this| {
            if count > resets_singly(first.class) {
                let off = match bits(&OperandKind::Device(first, None)) {
                    Some(_) => this.bit_const(false),
                    None => this.int(0, false),
                };
                if exists {
                    this.fill_run(first, count, off);
                }
                return;
            }
            for number in first.number..=last {
                let (class, number) = this.model.canonical(first.class, number);
                let place = fixed(class, number);
                let reset = match class {
                    DeviceClass::T | DeviceClass::C => Stmt::Do(Action::Reset {
                        place,
                        holds: false,
                    }),
                    DeviceClass::Y | DeviceClass::M | DeviceClass::S | DeviceClass::X => {
                        let off = this.bit_const(false);
                        Stmt::Do(Action::Write(Access::bit(place), off))
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
                        Stmt::Do(Action::Write(Access::word(place), zero))
                    }
                };
                this.emit(reset);
            }
        });
    }

    /// SFTR and SFTL: n1 bits move on by n2 places, n2 others enter.
    fn shift_bits(&mut self, right: bool) {
        self.shift(right, |this, from, to, count, backwards| {
            if count > WORDS {
                return this.copy_run(from, to, count);
            }
            for k in 0..count {
                let k = if backwards { count - 1 - k } else { k };
                this.copy_bit((from, k), (to, k));
            }
        });
    }

    /// WSFR and WSFL: the same of words.
    fn shift_words(&mut self, right: bool) {
        self.shift(right, |this, from, to, count, backwards| {
            this.copy_words(from, to, count, backwards);
        });
    }

    /// Copies the devices that stay, then those that enter; the argument of `copy` says whether to begin with the last
    /// one.
    fn shift(&mut self, right: bool, copy: impl Fn(&mut Self, Device, Device, u32, bool)) {
        let (length, by) = (self.stated(2), self.stated(3));
        let (Some(from), Some(to)) = (self.device_of(0), self.device_of(1)) else {
            return;
        };
        let at = |places: u32| Device {
            number: to.number + places,
            ..to
        };
        self.with_blocks([(from, by), (to, length)], |this| match right {
            true => {
                copy(this, at(by), to, length - by, false);
                copy(this, from, at(length - by), by, false);
            }
            false => {
                copy(this, to, at(by), length - by, true);
                copy(this, from, to, by, false);
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
        self.emit(Action::Write(
            Access::bit(fixed(to.class, to.number)),
            state,
        ));
    }
}
