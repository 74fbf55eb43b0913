//! Comparisons of times of day, which are inline code: TCMP and TZCP. A time is an hour, a minute and a second.

use super::Lowerer;
use super::blocks::register;
use super::operand::Guards;
use rungc_ir::node::{Expr, ExprId};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::Instr;

/// The hour, the minute and the second.
type Time = [ExprId; 3];

/// Returns true if such an instruction is inline code, judging by its operands.
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let times = if function == RtFn::Tcmp {
        3..4
    } else if function == RtFn::Tzcp {
        0..3
    } else {
        return false;
    };
    let operands = instr.operands.get(times);
    operands.is_some_and(|times| times.iter().all(|time| register(&time.kind).is_some()))
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    pub(super) fn inline_times(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        if function == RtFn::Tcmp {
            self.driven(Self::compare_times);
        } else {
            self.driven(Self::compare_time_zone);
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
}
