//! Going back in a run: moments to which it can return, from which it is executed again to the requested scan.
//!
//! What comes from outside between two scans, such as a device that the page sets or a frame, is not repeated: the
//! scan after it begins with a separate moment.

use super::Setting;
use super::live::Control;
use rungc_sim::session;
use std::collections::VecDeque;
use std::iter::Peekable;
use std::slice::Iter;

/// Maximum number of scans executed again, if there was no input from outside.
const EVERY: u64 = 100;
/// Number of stored moments, of about 0.2 MB each.
const MOMENTS: usize = 128;

/// A run before a scan.
#[derive(Clone)]
pub struct Moment<'a> {
    /// The PLC with what is around it.
    pub session: session::Moment,
    /// Pending settings.
    pub pending: Peekable<Iter<'a, Setting>>,
    /// State of the page's control.
    pub control: Control,
}

/// The moments of a run, the oldest first.
#[derive(Default)]
pub struct History<'a> {
    moments: VecDeque<Moment<'a>>,
    disturbed: bool,
}

impl<'a> History<'a> {
    /// Something has come from outside since the last scan.
    pub fn disturb(&mut self) {
        self.disturbed = true;
    }

    /// Returns true if the moment before a scan is to be stored, after which there are this many scans less one.
    pub fn is_due(&self, scans: u64) -> bool {
        let last = self.moments.back().map(|moment| moment.control.scans);
        self.disturbed || last.is_none_or(|last| scans >= last + EVERY)
    }

    /// Keeps a moment.
    pub fn keep(&mut self, moment: Moment<'a>) {
        self.disturbed = false;
        if self.moments.len() == MOMENTS {
            self.moments.pop_front();
        }
        self.moments.push_back(moment);
    }

    /// Length of the undo history, in scans.
    pub fn reach(&self, scans: u64) -> u64 {
        let first = self.moments.front();
        first.map_or(0, |first| scans.saturating_sub(first.control.scans + 1))
    }

    /// The last moment before scan `scan`; later ones are forgotten, because they will not come to pass.
    pub fn before(&mut self, scan: u64) -> Option<Moment<'a>> {
        let later = |moment: &Moment| moment.control.scans >= scan;
        while self.moments.back().is_some_and(later) {
            self.moments.pop_back();
        }
        self.moments.back().cloned()
    }
}
