//! Queues of words, which are inline code where they are registers and the program states how long they are: SFWR and
//! SFRD.

use super::Lowerer;
use super::indexed_blocks::{after, words};
use super::operand::Guards;
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
    let queue = queue_of(function).and_then(kind).and_then(words);
    let length = kind(2).and_then(constant);
    let (Some((queue, index)), Some(length @ 2..=LONGEST)) = (queue, length) else {
        return false;
    };
    index.is_some() || !is_special(queue.class, queue.number + length as u32 - 1)
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

    /// Gives `make` the queue at operand `i` and the number of its entries, which faults if it is below 0.
    fn with_entries(&mut self, i: usize, make: impl FnOnce(&mut Self, Place, ExprId)) {
        let mut guards = Guards::default();
        let queue = self.block_at(i, self.stated(2), &mut guards);
        self.guarded(guards, |this| {
            let Some(queue) = queue else {
                return;
            };
            let queue = this.settled_place(queue);
            let held = this.add(Expr::Read(Access::word(queue)));
            let held = this.settled(held);
            let none = this.int(0, false);
            let fits = this.add(Expr::Cmp(CmpOp::Ge, held, none));
            this.checked(fits, this.model.value_error, |this| make(this, queue, held));
        });
    }

    /// The number of entries changes by one.
    fn count_entries(&mut self, queue: Place, held: ExprId, op: BinOp) {
        let one = self.int(1, false);
        let held = self.add(Expr::Bin(op, held, one));
        self.emit(Action::Write(Access::word(queue), held));
    }

    /// The place of the next entry, of `places`, in a queue that holds this many.
    fn next_entry(&mut self, queue: Place, held: ExprId, places: i32) -> Place {
        let held = self.add(Expr::Widen(held));
        let held = self.within(held, Some((0, places - 1)));
        let index = match queue.index {
            None => held,
            Some(index) => {
                let index = self.add(Expr::Bin(BinOp::Add, index, held));
                self.within(index, None)
            }
        };
        Place {
            index: Some(index),
            ..after(queue, 1)
        }
    }

    /// SFWR: a full queue stays as it is.
    fn append(&mut self) {
        let places = self.stated(2) as i32 - 1;
        self.with_entries(1, |this, queue, held| {
            let mut guards = Guards::default();
            let value = this.source(0, &mut guards);
            this.guarded(guards, |this| {
                let value = this.settled(value);
                let all = this.int(places, false);
                let full = this.add(Expr::Cmp(CmpOp::Ge, held, all));
                let full = this.settled(full);
                this.set_flag(M_CARRY, full);
                let room = this.not(full);
                this.when(room, |this| {
                    this.count_entries(queue, held, BinOp::Add);
                    let place = this.next_entry(queue, held, places);
                    this.emit(Action::Write(Access::word(place), value));
                });
            });
        });
    }

    /// SFRD: the entries after the oldest move down, the last word stays.
    fn take_oldest(&mut self) {
        let length = self.stated(2);
        self.with_entries(0, |this, queue, held| {
            let mut guards = Guards::default();
            let target = this.result(1, &mut guards);
            this.guarded(guards, |this| {
                let empty = this.is_int(held, 0, false);
                let empty = this.settled(empty);
                this.set_flag(M_ZERO, empty);
                let some = this.not(empty);
                this.when(some, |this| {
                    let oldest = this.add(Expr::Read(Access::word(after(queue, 1))));
                    let oldest = this.settled(oldest);
                    this.copy_entries(queue, length - 2);
                    this.count_entries(queue, held, BinOp::Sub);
                    this.store(target, oldest);
                });
            });
        });
    }

    /// Moves the entries after the oldest down by one.
    fn copy_entries(&mut self, queue: Place, count: u32) {
        match (queue.index, [2, 1].map(|k| after(queue, k))) {
            (Some(_), [from, to]) => self.copy_block(from, to, count, None),
            (None, places) => {
                let [from, to] = places.map(|place| Device {
                    class: place.class,
                    number: place.number,
                });
                self.copy_words(from, to, count, false);
            }
        }
    }
}
