//! Going back in a run: moments to which it can return, from which it is executed again to the requested scan.
//!
//! What comes from outside between two scans, such as a device that a page sets or a frame, is not repeated: unless the
//! caller repeats it, the scan after it begins with a separate moment.

use std::collections::VecDeque;

/// Maximum number of scans executed again, if there was no input from outside.
const EVERY: u64 = 100;
/// Number of stored moments, of about 0.2 MB each.
const MOMENTS: usize = 128;

/// The moments of a run before some of its scans, the oldest first.
pub struct History<M> {
    moments: VecDeque<(u64, M)>,
    disturbed: bool,
}

impl<M> Default for History<M> {
    fn default() -> Self {
        History {
            moments: VecDeque::new(),
            disturbed: false,
        }
    }
}

impl<M: Clone> History<M> {
    /// Something has come from outside since the last scan.
    pub fn disturb(&mut self) {
        self.disturbed = true;
    }

    /// Returns true if the moment after this number of scans is to be stored.
    pub fn is_due(&self, scans: u64) -> bool {
        let last = self.moments.back().map(|(last, _)| *last);
        self.disturbed || last.is_none_or(|last| scans >= last + EVERY)
    }

    /// Keeps the moment after this number of scans.
    pub fn keep(&mut self, scans: u64, moment: M) {
        self.disturbed = false;
        if self.moments.len() == MOMENTS {
            self.moments.pop_front();
        }
        self.moments.push_back((scans, moment));
    }

    /// Number of scans before the oldest moment; `None` if there is none.
    pub fn first(&self) -> Option<u64> {
        self.moments.front().map(|(first, _)| *first)
    }

    /// Length of the undo history, in scans.
    pub fn reach(&self, scans: u64) -> u64 {
        self.first()
            .map_or(0, |first| scans.saturating_sub(first + 1))
    }

    /// The last moment after fewer than `scan` scans, and their number; later ones are forgotten, because they will not
    /// come to pass.
    pub fn before(&mut self, scan: u64) -> Option<(u64, M)> {
        let later = |(scans, _): &(u64, M)| *scans >= scan;
        while self.moments.back().is_some_and(later) {
            self.moments.pop_back();
        }
        self.moments.back().cloned()
    }
}
