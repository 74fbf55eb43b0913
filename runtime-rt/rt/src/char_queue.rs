//! A queue of characters between the interrupt of a UART and the main loop.

use crate::comm::{CharFault, Received};
use core::sync::atomic::{AtomicBool, AtomicU16, AtomicU32, Ordering};

/// Bits of a slot: a character's value, what is wrong with it, and when it came.
const FAULT: u32 = 8;
const TIME: u32 = 11;

/// The times that a slot can tell apart, in microseconds: about two seconds.
const TIMES: u32 = 1 << (32 - TIME);

/// Characters that one interrupt notes ([`CharQueue::note`]) and one main loop takes ([`CharQueue::take`]). It holds
/// `N - 1` of them in a word each, and needs no lock. The main loop must take each character within a second.
///
/// ```
/// use rungc_rt::board::CharQueue;
/// use rungc_rt::comm::Received;
///
/// static RECEIVED: CharQueue<64> = CharQueue::new();
/// // In the interrupt:
/// let character = Received { at_us: 1041, byte: 0x55, ..Received::new() };
/// RECEIVED.note(character);
/// // In `SerialPort::receive`:
/// assert_eq!(RECEIVED.take(1000), None);
/// assert_eq!(RECEIVED.take(2000), Some(character));
/// ```
#[derive(Debug)]
pub struct CharQueue<const N: usize> {
    pub(crate) slots: [AtomicU32; N],
    /// Index of the oldest character; written by the main loop.
    pub(crate) first: AtomicU16,
    /// Index for the next character; written by the interrupt.
    pub(crate) end: AtomicU16,
    /// A character found no room, and none came after it; the interrupt's.
    pub(crate) lost: AtomicBool,
}

impl<const N: usize> CharQueue<N> {
    /// An empty one.
    pub const fn new() -> Self {
        const {
            assert!(N > 1, "a queue has room for a character");
            assert!(N <= u16::MAX as usize / 4, "a queue counts by 16 bits");
        }
        CharQueue {
            slots: [const { AtomicU32::new(0) }; N],
            first: AtomicU16::new(0),
            end: AtomicU16::new(0),
            lost: AtomicBool::new(false),
        }
    }

    /// Notes a character, in the interrupt. One that finds no room is lost: `false` says so, and the next one has the
    /// fault [`CharFault::Overrun`].
    pub fn note(&self, character: Received) -> bool {
        let end = self.end.load(Ordering::Relaxed);
        let next = (end + 1) % N as u16;
        if next == self.first.load(Ordering::Acquire) {
            self.lost.store(true, Ordering::Relaxed);
            return false;
        }
        let fault = match character.fault {
            CharFault::None if self.lost.load(Ordering::Relaxed) => CharFault::Overrun,
            fault => fault,
        };
        self.lost.store(false, Ordering::Relaxed);
        let word = character.at_us << TIME | (fault as u32) << FAULT | u32::from(character.byte);
        self.slots[usize::from(end)].store(word, Ordering::Relaxed);
        self.end.store(next, Ordering::Release);
        true
    }

    /// Takes the oldest character that was in by `now_us`, in the main loop.
    pub fn take(&self, now_us: u32) -> Option<Received> {
        let first = self.first.load(Ordering::Relaxed);
        if first == self.end.load(Ordering::Acquire) {
            return None;
        }
        let word = self.slots[usize::from(first)].load(Ordering::Relaxed);
        let age_us = now_us.wrapping_sub(word >> TIME) % TIMES;
        if age_us >= TIMES / 2 {
            return None;
        }
        self.first.store((first + 1) % N as u16, Ordering::Release);
        Some(Received {
            at_us: now_us.wrapping_sub(age_us),
            byte: word as u8,
            fault: CharFault::of((word >> FAULT) as u8 & 7),
        })
    }
}

impl<const N: usize> Default for CharQueue<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn character(at_us: u32, byte: u8) -> Received {
        Received {
            at_us,
            byte,
            fault: CharFault::None,
        }
    }

    #[test]
    fn characters_come_in_order_at_their_times() {
        let queue = CharQueue::<4>::new();
        for begin in [0, 1_234_567, u32::MAX - 3] {
            for n in 0..3 {
                assert!(queue.note(character(begin.wrapping_add(n), n as u8)));
            }
            assert_eq!(queue.take(begin.wrapping_sub(1)), None);
            for n in 0..3 {
                let taken = queue.take(begin.wrapping_add(900_000));
                assert_eq!(taken, Some(character(begin.wrapping_add(n), n as u8)));
            }
            assert_eq!(queue.take(begin), None);
        }
    }

    #[test]
    fn the_character_after_lost_ones_is_marked() {
        let queue = CharQueue::<3>::new();
        let noted = [1, 2, 3, 4].map(|n| queue.note(character(n, 0x55)));
        assert_eq!(noted, [true, true, false, false]);
        assert_eq!(queue.take(10).map(|c| c.fault), Some(CharFault::None));
        assert!(queue.note(character(5, 0x55)));
        assert_eq!(queue.take(10).map(|c| c.fault), Some(CharFault::None));
        assert_eq!(queue.take(10).map(|c| c.fault), Some(CharFault::Overrun));
    }

    #[test]
    fn faults_keep_their_kind() {
        let queue = CharQueue::<2>::new();
        for number in 0..5 {
            let character = Received {
                at_us: 7,
                byte: 0xff,
                fault: CharFault::of(number),
            };
            assert!(queue.note(character));
            assert_eq!(queue.take(7), Some(character));
        }
    }
}
