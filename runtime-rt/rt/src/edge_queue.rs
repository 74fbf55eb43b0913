//! A queue of edges between an interrupt and the main loop.

use crate::board::InputEdge;
use core::sync::atomic::{AtomicU16, AtomicUsize, Ordering};

/// Edges that one interrupt notes ([`EdgeQueue::note`]) and one main loop takes ([`EdgeQueue::take`]). It holds `N - 1`
/// of them, needs no lock, and no more of the processor than that it loads and stores words.
///
/// ```
/// use rungc_rt::board::{EdgeQueue, InputEdge};
///
/// static EDGES: EdgeQueue<64> = EdgeQueue::new();
/// // In the interrupt:
/// EDGES.note(InputEdge { input: 3, level: true });
/// // In `EdgeInterrupt::next_edge`:
/// assert_eq!(EDGES.take(), Some(InputEdge { input: 3, level: true }));
/// ```
#[derive(Debug)]
pub struct EdgeQueue<const N: usize> {
    /// An input's number, and in the lowest bit whether it turned on.
    slots: [AtomicU16; N],
    /// Index of the oldest edge; written by the main loop.
    first: AtomicUsize,
    /// Index for the next character; written by the interrupt.
    end: AtomicUsize,
    /// Edges lost because the queue was full, wrapping; written by the interrupt.
    lost: AtomicUsize,
}

impl<const N: usize> EdgeQueue<N> {
    /// An empty one.
    pub const fn new() -> Self {
        const { assert!(N > 1, "a queue has room for an edge") }
        EdgeQueue {
            slots: [const { AtomicU16::new(0) }; N],
            first: AtomicUsize::new(0),
            end: AtomicUsize::new(0),
            lost: AtomicUsize::new(0),
        }
    }

    /// Notes an edge, in the interrupt; of an input below 32768. One that finds no room is lost, and `false` says so.
    pub fn note(&self, edge: InputEdge) -> bool {
        let end = self.end.load(Ordering::Relaxed);
        let next = (end + 1) % N;
        if next == self.first.load(Ordering::Acquire) {
            let lost = self.lost.load(Ordering::Relaxed);
            self.lost.store(lost.wrapping_add(1), Ordering::Relaxed);
            return false;
        }
        let word = (edge.input as u16) << 1 | u16::from(edge.level);
        self.slots[end].store(word, Ordering::Relaxed);
        self.end.store(next, Ordering::Release);
        true
    }

    /// Takes the oldest edge, in the main loop.
    pub fn take(&self) -> Option<InputEdge> {
        let first = self.first.load(Ordering::Relaxed);
        if first == self.end.load(Ordering::Acquire) {
            return None;
        }
        let word = self.slots[first].load(Ordering::Relaxed);
        self.first.store((first + 1) % N, Ordering::Release);
        Some(InputEdge {
            input: u32::from(word >> 1),
            level: word & 1 == 1,
        })
    }

    /// Number of edges lost since power-on, wrapping.
    pub fn lost(&self) -> usize {
        self.lost.load(Ordering::Relaxed)
    }
}

impl<const N: usize> Default for EdgeQueue<N> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(n: u32) -> InputEdge {
        InputEdge {
            input: n,
            level: n.is_multiple_of(2),
        }
    }

    #[test]
    fn a_full_queue_loses_the_newest() {
        let queue = EdgeQueue::<4>::new();
        for round in 0..10 {
            let taken = [1, 2, 3, 4].map(|n| queue.note(edge(round + n)));
            assert_eq!(taken, [true, true, true, false]);
            for n in 1..4 {
                assert_eq!(queue.take(), Some(edge(round + n)));
            }
            assert_eq!(queue.take(), None);
        }
        assert_eq!(queue.lost(), 10);
    }

    #[test]
    fn edges_come_in_order_and_once() {
        const EDGES: u32 = 20_000;
        static QUEUE: EdgeQueue<16> = EdgeQueue::new();
        std::thread::scope(|scope| {
            scope.spawn(|| {
                for n in 0..EDGES {
                    while !QUEUE.note(edge(n)) {
                        std::thread::yield_now();
                    }
                }
            });
            for n in 0..EDGES {
                let next = || {
                    QUEUE.take().or_else(|| {
                        std::thread::yield_now();
                        None
                    })
                };
                let taken = std::iter::from_fn(|| Some(next())).flatten().next();
                assert_eq!(taken, Some(edge(n)));
            }
        });
    }
}
