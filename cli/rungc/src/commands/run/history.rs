//! Going back in a run: moments to which it can return, from which it is executed again to the scan that is asked for.
//!
//! What comes from outside between two scans, such as a device that the page sets or a frame, is not repeated: the
//! scan after it begins with a separate moment.

use super::Setting;
use super::live::Control;
use rungc_interp::Saved;
use rungc_rt::VirtualHal;
use rungc_sim::plant::Plant;
use std::collections::VecDeque;
use std::iter::Peekable;
use std::slice::Iter;

/// How many scans are executed again at most, if nothing has come from outside.
const EVERY: u64 = 100;
/// How many moments are kept; one takes about 0.2 MB.
const MOMENTS: usize = 128;

/// A run before a scan.
#[derive(Clone)]
pub struct Moment<'a> {
    /// When.
    pub now_ms: u64,
    /// The PLC.
    pub machine: Saved,
    /// Its hardware.
    pub hal: VirtualHal,
    /// The machine that it is wired to.
    pub plant: Option<Plant>,
    /// What is still to be set.
    pub pending: Peekable<Iter<'a, Setting>>,
    /// How far the page had come, and what it had forced.
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

    /// Whether the moment before a scan is to be kept, after which there are this many scans less one.
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

    /// How many scans of these the run can go back.
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
