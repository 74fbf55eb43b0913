//! Times of day, which are inline code where they are registers: TCMP, TZCP, TADD, TSUB, HTOS and STOH. A time is an
//! hour, a minute and a second.

use super::Lowerer;
use super::blocks::register;
use super::operand::{Guards, fixed};
use rungc_ir::node::{Access, Action, BinOp, Expr, ExprId};
use rungc_rt::special::{M_BORROW, M_CARRY, M_ZERO};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Device, Instr};

/// The hour, the minute and the second.
type Time = [ExprId; 3];

/// Seconds of a day.
const DAY: i32 = 86_400;

/// The most seconds that STOH takes: 32767 hours, and all but an hour.
const MOST_SECONDS: i32 = 32_767 * 3600 + 3599;

/// Returns true if such an instruction is inline code, judging by its operands.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the other functions of the runtime are called"
)]
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let times = match function {
        RtFn::Tcmp => 3..4,
        RtFn::Tzcp | RtFn::Tadd | RtFn::Tsub => 0..3,
        RtFn::Htos => 0..1,
        RtFn::Stoh => 1..2,
        _ => return false,
    };
    let operands = instr.operands.get(times);
    operands.is_some_and(|times| times.iter().all(|time| register(&time.kind).is_some()))
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "the other functions of the runtime are called"
    )]
    pub(super) fn inline_times(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        match function {
            RtFn::Tcmp => self.driven(Self::compare_times),
            RtFn::Tzcp => self.driven(Self::compare_time_zone),
            RtFn::Tadd => self.driven(|this| this.add_times(BinOp::Add)),
            RtFn::Tsub => self.driven(|this| this.add_times(BinOp::Sub)),
            RtFn::Htos => self.driven(Self::time_to_seconds),
            RtFn::Stoh => self.driven(Self::seconds_to_time),
            _ => return false,
        }
        true
    }

    /// TCMP: where the time at S lies relative to S1:S2:S3.
    fn compare_times(&mut self) {
        let mut guards = Guards::default();
        let set = [0, 1, 2].map(|i| self.source(i, &mut guards));
        let time = self.time(3, &mut guards);
        self.show_time(4, time, (set, set), guards);
    }

    /// TZCP: where the time at S lies relative to those at S1 and S2.
    fn compare_time_zone(&mut self) {
        let mut guards = Guards::default();
        let [low, high, time] = [0, 1, 2].map(|i| self.time(i, &mut guards));
        self.show_time(3, time, (low, high), guards);
    }

    /// The time at operand `i`.
    fn time(&mut self, i: usize, guards: &mut Guards) -> Time {
        let Some(first) = self.device_of(i) else {
            return [self.int(0, false); 3];
        };
        self.demand_block(first, 3, guards);
        [0, 1, 2].map(|k| self.word_at(first, k))
    }

    /// Three bits from operand `i` on: before the zone, in it, after it.
    fn show_time(&mut self, i: usize, time: Time, (low, high): (Time, Time), mut guards: Guards) {
        let Some(operand) = self.operand(i).cloned() else {
            return;
        };
        let wide = self.wide();
        let Some(target) = self.bit_target(&operand, 3, wide, &mut guards) else {
            return;
        };
        self.guarded(guards, |this| {
            let before = this.is_before(time, low);
            let before = this.settled(before);
            let beyond = this.is_before(high, time);
            let not_before = this.not(before);
            let after = this.and(not_before, beyond);
            let after = this.settled(after);
            let outside = this.or(before, after);
            let inside = this.not(outside);
            for (offset, bit) in (0..).zip([before, inside, after]) {
                this.store_bit(target, offset, bit);
            }
        });
    }

    /// Condition that one time is before another: the hour decides, then the minute, then the second.
    fn is_before(&mut self, a: Time, b: Time) -> ExprId {
        let mut parts = a.into_iter().zip(b).rev();
        let mut before = self.bit_const(false);
        if let Some((a, b)) = parts.next() {
            before = self.add(Expr::Cmp(CmpOp::Lt, a, b));
        }
        for (a, b) in parts {
            let less = self.add(Expr::Cmp(CmpOp::Lt, a, b));
            let equal = self.add(Expr::Cmp(CmpOp::Eq, a, b));
            let then = self.and(equal, before);
            before = self.or(less, then);
        }
        before
    }

    /// TADD and TSUB: within a day. M8020 is on at 0:00:00, M8022 if a day was taken off, M8021 if one was added.
    fn add_times(&mut self, op: BinOp) {
        let mut guards = Guards::default();
        let times = [0, 1].map(|i| self.time(i, &mut guards));
        let target = self.time_target(2, &mut guards);
        self.guarded(guards, |this| {
            let valid = times.map(|time| this.is_time(time, 23));
            let valid = this.and(valid[0], valid[1]);
            this.checked(valid, this.model.value_error, |this| {
                let [a, b] = times.map(|time| this.seconds_of(time));
                let total = this.add(Expr::Bin(op, a, b));
                let total = this.settled(total);
                let day = this.int(DAY, true);
                let (later, flag, limit, beyond) = if op == BinOp::Sub {
                    let later = this.add(Expr::Bin(BinOp::Add, total, day));
                    (later, M_BORROW, 0, CmpOp::Lt)
                } else {
                    (total, M_CARRY, DAY, CmpOp::Ge)
                };
                let seconds = this.add(Expr::Bin(BinOp::Rem, later, day));
                let seconds = this.settled(seconds);
                this.put_time(target, seconds);
                let zero = this.is_int(seconds, 0, true);
                this.set_flag(M_ZERO, zero);
                let limit = this.int(limit, true);
                let leaves = this.add(Expr::Cmp(beyond, total, limit));
                this.set_flag(flag, leaves);
            });
        });
    }

    /// HTOS: an error if D cannot hold the seconds.
    fn time_to_seconds(&mut self) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let time = self.time(0, &mut guards);
        let target = self.result(1, &mut guards);
        self.guarded(guards, |this| {
            let valid = this.is_time(time, i16::MAX);
            let seconds = this.seconds_of(time);
            if wide {
                return this.checked(valid, this.model.value_error, |this| {
                    this.store(target, seconds)
                });
            }
            let seconds = this.settled(seconds);
            let most = this.int(i16::MAX.into(), true);
            let fits = this.add(Expr::Cmp(CmpOp::Le, seconds, most));
            let valid = this.and(valid, fits);
            this.checked(valid, this.model.value_error, |this| {
                let seconds = this.add(Expr::Narrow(seconds));
                this.store(target, seconds);
            });
        });
    }

    /// STOH.
    fn seconds_to_time(&mut self) {
        let wide = self.wide();
        let mut guards = Guards::default();
        let seconds = self.source(0, &mut guards);
        let seconds = match wide {
            true => seconds,
            false => self.add(Expr::Widen(seconds)),
        };
        let target = self.time_target(1, &mut guards);
        self.guarded(guards, |this| {
            let seconds = this.settled(seconds);
            let (least, most) = (this.int(0, true), this.int(MOST_SECONDS, true));
            let not_below = this.add(Expr::Cmp(CmpOp::Ge, seconds, least));
            let not_above = this.add(Expr::Cmp(CmpOp::Le, seconds, most));
            let fits = this.and(not_below, not_above);
            this.checked(fits, this.model.value_error, |this| {
                this.put_time(target, seconds)
            });
        });
    }

    /// The registers at operand `i` that a time is written to; `None` if they do not exist, which the guards show.
    fn time_target(&mut self, i: usize, guards: &mut Guards) -> Option<Device> {
        let first = self.device_of(i)?;
        self.demand_block(first, 3, guards);
        self.exists(first.class, first.number, 3).then_some(first)
    }

    /// Condition that the parts of a time are what they can be, the hour at most `last_hour`.
    fn is_time(&mut self, time: Time, last_hour: i16) -> ExprId {
        let mut valid = self.bit_const(true);
        for (part, last) in time.into_iter().zip([last_hour, 59, 59]) {
            let (first, last) = (self.int(0, false), self.int(last.into(), false));
            let not_below = self.add(Expr::Cmp(CmpOp::Ge, part, first));
            let not_above = self.add(Expr::Cmp(CmpOp::Le, part, last));
            let inside = self.and(not_below, not_above);
            valid = self.and(valid, inside);
        }
        valid
    }

    /// The seconds since 0:00:00.
    fn seconds_of(&mut self, time: Time) -> ExprId {
        let [hour, minute, second] = time.map(|part| self.add(Expr::Widen(part)));
        let sixty = self.int(60, true);
        let minutes = self.add(Expr::Bin(BinOp::Mul, hour, sixty));
        let minutes = self.add(Expr::Bin(BinOp::Add, minutes, minute));
        let seconds = self.add(Expr::Bin(BinOp::Mul, minutes, sixty));
        self.add(Expr::Bin(BinOp::Add, seconds, second))
    }

    /// Writes the time of the day's settled `seconds`.
    fn put_time(&mut self, target: Option<Device>, seconds: ExprId) {
        let Some(first) = target else {
            return;
        };
        let (hour, sixty) = (self.int(3600, true), self.int(60, true));
        let minutes = self.add(Expr::Bin(BinOp::Div, seconds, sixty));
        let parts = [
            self.add(Expr::Bin(BinOp::Div, seconds, hour)),
            self.add(Expr::Bin(BinOp::Rem, minutes, sixty)),
            self.add(Expr::Bin(BinOp::Rem, seconds, sixty)),
        ];
        for (k, part) in (0..).zip(parts) {
            let (class, number) = self.model.canonical(first.class, first.number + k);
            let word = self.add(Expr::Narrow(part));
            self.emit(Action::Write(Access::word(fixed(class, number)), word));
        }
    }
}
