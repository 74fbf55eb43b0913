//! Queues in both directions between the interrupt of a UART and the main loop.

use crate::board::CharQueue;
use crate::comm::Received;
use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU16, AtomicU32, Ordering};

/// Bytes to be sent that one word of a [`TurnQueue`] holds.
const BYTES: usize = 4;

/// Queues of a line on which a port listens and sends at once, as free protocols do: `RECEIVE - 1` characters that have
/// come, and `SEND - 1` to be sent. The interrupt notes and pops; the main loop takes, and pushes while no interrupt
/// comes.
#[derive(Debug)]
pub struct BothQueues<const RECEIVE: usize, const SEND: usize> {
    received: CharQueue<RECEIVE>,
    to_send: [AtomicU8; SEND],
    /// The next byte to be sent.
    first: AtomicU16,
    /// Index for the next byte.
    end: AtomicU16,
}

impl<const RECEIVE: usize, const SEND: usize> BothQueues<RECEIVE, SEND> {
    /// Empty ones.
    #[expect(
        clippy::new_without_default,
        reason = "for statics, which need a constant function"
    )]
    pub const fn new() -> Self {
        const { assert!(SEND > 1 && SEND <= u16::MAX as usize, "a queue has room") }
        BothQueues {
            received: CharQueue::new(),
            to_send: [const { AtomicU8::new(0) }; SEND],
            first: AtomicU16::new(0),
            end: AtomicU16::new(0),
        }
    }

    /// Notes a character that has come, as [`CharQueue::note`] does.
    pub fn note(&self, character: Received) {
        self.received.note(character);
    }

    /// Takes the oldest character that was in by `now_us`, as [`CharQueue::take`] does.
    pub fn take(&self, now_us: u32) -> Option<Received> {
        self.received.take(now_us)
    }

    /// Appends a byte to be sent; false if there is no room.
    pub fn push(&self, byte: u8) -> bool {
        let end = self.end.load(Ordering::Relaxed);
        let next = (end + 1) % SEND as u16;
        if next == self.first.load(Ordering::Relaxed) {
            return false;
        }
        self.to_send[usize::from(end)].store(byte, Ordering::Relaxed);
        self.end.store(next, Ordering::Relaxed);
        true
    }

    /// The next byte to be sent, which is then no longer here.
    pub fn pop(&self) -> Option<u8> {
        if self.waiting() == 0 {
            return None;
        }
        let first = self.first.load(Ordering::Relaxed);
        let byte = self.to_send[usize::from(first)].load(Ordering::Relaxed);
        self.first
            .store((first + 1) % SEND as u16, Ordering::Relaxed);
        Some(byte)
    }

    /// Number of bytes waiting to be sent.
    pub fn waiting(&self) -> u16 {
        let [first, end] = [&self.first, &self.end].map(|at| at.load(Ordering::Relaxed));
        (end + SEND as u16 - first) % SEND as u16
    }

    /// The last bit of what was to be sent is out.
    pub fn listen(&self) {}
}

/// The queue of a line on which a port listens and sends by turns, in one memory of `N` words: `N - 1` characters that
/// have come, or 4 × `N` - 1 bytes to be sent. What comes while it sends is dropped, and so is what has not been taken
/// when it begins to send: no protocol with frames listens then.
///
/// The interrupt notes and pops; the main loop takes, and pushes while no interrupt comes.
///
/// ```
/// use rungc_rt::board::TurnQueue;
/// use rungc_rt::comm::Received;
///
/// static LINE: TurnQueue<64> = TurnQueue::new();
/// assert!(LINE.push(0x55));
/// LINE.note(Received::new()); // not received
/// assert_eq!(LINE.pop(), Some(0x55));
/// LINE.listen();
/// LINE.note(Received::new());
/// assert_eq!(LINE.take(0), Some(Received::new()));
/// ```
#[derive(Debug)]
pub struct TurnQueue<const N: usize> {
    /// While it sends, its places count bytes.
    words: CharQueue<N>,
    sends: AtomicBool,
}

impl<const N: usize> TurnQueue<N> {
    /// Capacity of the words in bytes, plus one.
    const ROOM: u16 = (BYTES * N) as u16;

    /// An empty one.
    #[expect(
        clippy::new_without_default,
        reason = "for statics, which need a constant function"
    )]
    pub const fn new() -> Self {
        TurnQueue {
            words: CharQueue::new(),
            sends: AtomicBool::new(false),
        }
    }

    /// Notes a character that has come, as [`CharQueue::note`] does, unless it sends.
    pub fn note(&self, character: Received) {
        if !self.sends.load(Ordering::Relaxed) {
            self.words.note(character);
        }
    }

    /// Takes the oldest character that was in by `now_us`, as [`CharQueue::take`] does; none while it sends.
    pub fn take(&self, now_us: u32) -> Option<Received> {
        match self.sends.load(Ordering::Relaxed) {
            true => None,
            false => self.words.take(now_us),
        }
    }

    /// Appends a byte to be sent; false if there is no room.
    pub fn push(&self, byte: u8) -> bool {
        if !self.sends.load(Ordering::Relaxed) {
            self.turn(true);
        }
        let end = self.words.end.load(Ordering::Relaxed);
        let next = (end + 1) % Self::ROOM;
        if next == self.words.first.load(Ordering::Relaxed) {
            return false;
        }
        let (word, mut bytes) = self.word(end);
        bytes[usize::from(end) % BYTES] = byte;
        word.store(u32::from_le_bytes(bytes), Ordering::Relaxed);
        self.words.end.store(next, Ordering::Relaxed);
        true
    }

    /// The next byte to be sent, which is then no longer here.
    pub fn pop(&self) -> Option<u8> {
        if self.waiting() == 0 {
            return None;
        }
        let first = self.words.first.load(Ordering::Relaxed);
        let (_, bytes) = self.word(first);
        let next = (first + 1) % Self::ROOM;
        self.words.first.store(next, Ordering::Relaxed);
        Some(bytes[usize::from(first) % BYTES])
    }

    /// Number of bytes waiting to be sent.
    pub fn waiting(&self) -> u16 {
        if !self.sends.load(Ordering::Relaxed) {
            return 0;
        }
        let [first, end] =
            [&self.words.first, &self.words.end].map(|at| at.load(Ordering::Relaxed));
        (end + Self::ROOM - first) % Self::ROOM
    }

    /// The last bit of what was to be sent is out.
    pub fn listen(&self) {
        if self.sends.load(Ordering::Relaxed) && self.waiting() == 0 {
            self.turn(false);
        }
    }

    /// The word with a byte to be sent, and its bytes.
    fn word(&self, at: u16) -> (&AtomicU32, [u8; BYTES]) {
        let word = &self.words.slots[usize::from(at) / BYTES];
        (word, word.load(Ordering::Relaxed).to_le_bytes())
    }

    /// Begins to send, or to listen, with nothing.
    fn turn(&self, sends: bool) {
        self.words.first.store(0, Ordering::Relaxed);
        self.words.end.store(0, Ordering::Relaxed);
        self.words.lost.store(false, Ordering::Relaxed);
        self.sends.store(sends, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A character that comes at this time, its number modulo 256.
    fn character(n: u32) -> Received {
        Received {
            at_us: n,
            byte: n as u8,
            ..Received::new()
        }
    }

    #[test]
    fn a_whole_frame_waits_in_the_memory_of_few_characters() {
        let line = TurnQueue::<4>::new();
        for round in 0..3_u8 {
            (0..3).for_each(|n| line.note(character(n)));
            assert_eq!(line.take(10), Some(character(0)));
            // The others are lost when an answer begins.
            for n in 0..15 {
                assert!(line.push(n + round));
            }
            assert!(!line.push(99));
            assert_eq!((line.waiting(), line.take(10)), (15, None));
            line.note(character(5));
            for n in 0..15 {
                assert_eq!(line.pop(), Some(n + round));
                line.listen();
            }
            assert_eq!((line.pop(), line.waiting()), (None, 0));
            assert_eq!(line.take(10), None);
        }
        line.note(character(7));
        line.listen();
        assert_eq!(line.take(10), Some(character(7)), "it still listens");
    }

    #[test]
    fn bytes_may_follow_while_others_are_sent() {
        let line = TurnQueue::<2>::new();
        for n in 0..100 {
            assert!(line.push(n) && line.push(n + 100));
            assert_eq!([line.pop(), line.pop()], [Some(n), Some(n + 100)]);
        }
        line.listen();
        line.note(character(1));
        assert_eq!(line.take(1), Some(character(1)));
    }

    #[test]
    fn a_free_protocol_listens_while_it_sends() {
        let line = BothQueues::<4, 3>::new();
        for n in 0..10_u8 {
            assert!(line.push(n) && line.push(n + 100) && !line.push(0));
            line.note(character(n.into()));
            assert_eq!(line.waiting(), 2);
            assert_eq!(
                [line.pop(), line.pop(), line.pop()],
                [Some(n), Some(n + 100), None]
            );
            line.listen();
            assert_eq!(line.take(20), Some(character(n.into())));
        }
    }
}
