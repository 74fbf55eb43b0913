//! Indexed 32-bit counters on models whose index counts 16-bit words (hm-motion-controller §5.1.8): an odd index leads
//! to the high word of a counter and the low word of the next.

use super::Lowerer;
use super::operand::{Guards, fixed};
use rungc_ir::node::{Access, Action, BinOp, Expr, ExprId, Place};
use rungc_models::runs::{FIRST_COUNTER32, is_counter32};
use rungc_rt::CmpOp;
use rungc_syntax::{Device, Index};

/// Last 32-bit counter.
const LAST: u32 = 255;
const LOW_WORD: i32 = 0xFFFF;

/// 32 bits that begin at any word of the 32-bit counters.
#[derive(Clone, Copy)]
pub(super) struct CounterWords {
    /// Counter with the low word, and the one with the high word; the same for an even index.
    places: [Place; 2],
    /// 1 if the bits begin at a high word, else 0.
    odd: ExprId,
}

impl Lowerer<'_> {
    /// Returns true if an operand's index counts the words of 32-bit counters.
    pub(super) fn counts_words(&self, device: Device, index: Option<Index>) -> bool {
        let by_words = self.model.index_counts_words && self.wide();
        by_words && index.is_some() && is_counter32(device.class, device.number)
    }

    /// The words that a counter with an index names, and the condition that all of them are of 32-bit counters.
    pub(super) fn counter_words(
        &mut self,
        device: Device,
        written: Index,
        guards: &mut Guards,
    ) -> CounterWords {
        let place = fixed(device.class, device.number);
        let from_device = |number: u32| number as i32 - device.number as i32;
        let (low, high) = self
            .bound(place, written, 1)
            .unwrap_or((from_device(FIRST_COUNTER32), from_device(LAST)));
        let index = self.index(written, true);
        for (op, end) in [(CmpOp::Ge, 2 * low), (CmpOp::Le, 2 * high)] {
            let end = self.add(Expr::I32(end));
            guards.demand(self.add(Expr::Cmp(op, index, end)));
        }
        let [one, two] = [1, 2].map(|n| self.add(Expr::I32(n)));
        let odd = self.add(Expr::Bin(BinOp::And, index, one));
        let even = self.add(Expr::Bin(BinOp::Sub, index, odd));
        let first = self.add(Expr::Bin(BinOp::Div, even, two));
        let second = self.add(Expr::Bin(BinOp::Add, first, odd));
        let places = [first, second].map(|counter| {
            let counter = self.within(counter, Some((low, high)));
            self.note_index(counter, place, written);
            let index = Some(counter);
            Place { index, ..place }
        });
        CounterWords { places, odd }
    }

    /// The 32 bits.
    pub(super) fn read_counter_words(&mut self, words: CounterWords) -> ExprId {
        let [low, high] = words.places.map(|place| {
            let counter = self.add(Expr::Read(Access::pair(place)));
            self.turned(counter, words.odd)
        });
        let [low_word, high_word] = [LOW_WORD, !LOW_WORD].map(|mask| self.int(mask, true));
        let low = self.add(Expr::Bin(BinOp::And, low, low_word));
        let high = self.add(Expr::Bin(BinOp::And, high, high_word));
        self.add(Expr::Bin(BinOp::Or, low, high))
    }

    /// Writes them; the other word of each counter stays.
    pub(super) fn write_counter_words(&mut self, words: CounterWords, value: ExprId) {
        let odd = self.settled(words.odd);
        let value = self.turned(value, odd);
        let value = self.settled(value);
        let all = self.int(-1, true);
        // Of the first counter the low word stays for an odd index, of the second one the high word.
        for (place, own) in words.places.into_iter().zip([LOW_WORD, !LOW_WORD]) {
            let own = self.int(own, true);
            let stays = self.add(Expr::Bin(BinOp::Mul, own, odd));
            let written = self.add(Expr::Bin(BinOp::Xor, stays, all));
            let before = self.add(Expr::Read(Access::pair(place)));
            let before = self.add(Expr::Bin(BinOp::And, before, stays));
            let value = self.add(Expr::Bin(BinOp::And, value, written));
            let value = self.add(Expr::Bin(BinOp::Or, before, value));
            self.emit(Action::Write(Access::pair(place), value));
        }
    }

    /// A value with its words exchanged if `odd` is 1.
    fn turned(&mut self, value: ExprId, odd: ExprId) -> ExprId {
        let bits = self.int(16, true);
        let places = self.add(Expr::Bin(BinOp::Mul, odd, bits));
        self.add(Expr::Bin(BinOp::RotateLeft, value, places))
    }
}
