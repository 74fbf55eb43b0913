//! Queues of words, which are inline code where they are registers and the program states how long they are: SFWR and
//! SFRD.

use super::Lowerer;
use super::blocks::register;
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, Action, BinOp, Expr, ExprId, Place};
use rungc_models::runs::is_special;
use rungc_rt::special::{M_CARRY, M_ZERO};
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Device, Instr};

/// The most words of a queue, with that which counts its entries.
const LONGEST: i32 = 2048;

/// Index of the operand of such an instruction that is the queue.
fn queue_of(function: RtFn) -> Option<usize> {
    match function == RtFn::Sfwr {
        true => Some(1),
        false => (function == RtFn::Sfrd).then_some(0),
    }
}

/// Returns true if such an instruction is inline code, judging by its operands.
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let queue = queue_of(function).and_then(kind).and_then(register);
    let length = kind(2).and_then(constant);
    let (Some(queue), Some(length @ 2..=LONGEST)) = (queue, length) else {
        return false;
    };
    !is_special(queue.class, queue.number)
        && !is_special(queue.class, queue.number + length as u32 - 1)
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    pub(super) fn inline_queue(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        match function == RtFn::Sfwr {
            true => self.driven(Self::append),
            false => self.driven(Self::take_oldest),
        }
        true
    }

    /// Gives `make` the number of entries of the queue at operand `i`, which faults if it is below 0.
    fn with_entries(
        &mut self,
        queue: Device,
        mut guards: Guards,
        make: impl FnOnce(&mut Self, ExprId),
    ) {
        let length = self.stated(2);
        self.demand_block(queue, length, &mut guards);
        let exists = self.exists(queue.class, queue.number, length);
        self.guarded(guards, |this| {
            if !exists {
                return;
            }
            let held = this.word_at(queue, 0);
            let held = this.settled(held);
            let none = this.int(0, false);
            let fits = this.add(Expr::Cmp(CmpOp::Ge, held, none));
            this.checked(fits, this.model.value_error, |this| make(this, held));
        });
    }

    /// The number of entries changes by one.
    fn count_entries(&mut self, queue: Device, held: ExprId, op: BinOp) {
        let one = self.int(1, false);
        let held = self.add(Expr::Bin(op, held, one));
        let place = fixed(queue.class, queue.number);
        self.emit(Action::Write(Access::word(place), held));
    }

    /// SFWR: a full queue stays as it is.
    fn append(&mut self) {
        let Some(queue) = self.device_of(1) else {
            return;
        };
        let places = self.stated(2) as i32 - 1;
        let mut guards = Guards::default();
        let value = self.source(0, &mut guards);
        self.with_entries(queue, guards, |this, held| {
            let value = this.settled(value);
            let all = this.int(places, false);
            let full = this.add(Expr::Cmp(CmpOp::Ge, held, all));
            let full = this.settled(full);
            this.set_flag(M_CARRY, full);
            let room = this.not(full);
            this.when(room, |this| {
                this.count_entries(queue, held, BinOp::Add);
                let index = this.add(Expr::Widen(held));
                let index = this.within(index, Some((0, places - 1)));
                let place = Place {
                    index: Some(index),
                    ..fixed(queue.class, queue.number + 1)
                };
                this.emit(Action::Write(Access::word(place), value));
            });
        });
    }

    /// SFRD: the entries after the oldest move down, the last word stays.
    fn take_oldest(&mut self) {
        let Some(queue) = self.device_of(0) else {
            return;
        };
        let length = self.stated(2);
        let mut guards = Guards::default();
        let target = self.result(1, &mut guards);
        let at = |places: u32| Device {
            number: queue.number + places,
            ..queue
        };
        self.with_entries(queue, guards, |this, held| {
            let empty = this.is_int(held, 0, false);
            let empty = this.settled(empty);
            this.set_flag(M_ZERO, empty);
            let some = this.not(empty);
            this.when(some, |this| {
                let oldest = this.word_at(queue, 1);
                let oldest = this.settled(oldest);
                this.copy_words(at(2), at(1), length - 2, false);
                this.count_entries(queue, held, BinOp::Sub);
                this.store(target, oldest);
            });
        });
    }
}
