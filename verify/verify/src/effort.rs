//! Limits of searches: steps, which count the same on every machine and under any load, and perhaps a time.

use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;
use web_time::Instant;

/// Steps of an effort of 1, and about the number that an ordinary computer does in a millisecond.
pub const STEPS: u64 = 10_000;

/// What searches have done together, and when the time is up.
#[derive(Debug)]
struct Meter {
    steps: Cell<u64>,
    until: Option<Instant>,
    is_late: Cell<bool>,
}

/// Limit of a search. Parts of it count their steps together, and none outlasts the whole.
#[derive(Clone, Debug)]
pub struct Limit {
    meter: Rc<Meter>,
    /// Number of steps after which the search ends.
    end: u64,
}

impl Limit {
    /// A limit in units of [`STEPS`], and perhaps a time from now.
    pub fn new(effort: u64, time: Option<Duration>) -> Self {
        Limit {
            meter: Rc::new(Meter {
                steps: Cell::new(0),
                until: time.and_then(|time| Instant::now().checked_add(time)),
                is_late: Cell::new(false),
            }),
            end: effort.saturating_mul(STEPS),
        }
    }

    /// No limit.
    pub fn none() -> Self {
        Self::new(u64::MAX, None)
    }

    /// Counts steps.
    pub fn charge(&self, steps: usize) {
        let done = self.meter.steps.get().saturating_add(steps as u64);
        self.meter.steps.set(done);
    }

    /// Returns true if this many steps may follow. What takes them at once would be in vain otherwise.
    pub fn affords(&self, steps: usize) -> bool {
        self.meter.steps.get().saturating_add(steps as u64) <= self.end
    }

    /// Returns true if the search ends: that many steps are done, or the time is up.
    pub fn is_over(&self) -> bool {
        if self.meter.steps.get() >= self.end || self.meter.is_late.get() {
            return true;
        }
        let is_late = self.meter.until.is_some_and(|until| Instant::now() > until);
        self.meter.is_late.set(is_late);
        is_late
    }

    /// Returns true if the time was up: on another machine, the search may come further.
    pub fn is_late(&self) -> bool {
        self.meter.is_late.get()
    }

    /// A part that ends after this effort from now.
    #[must_use]
    pub fn part(&self, effort: u64) -> Self {
        let steps = effort.saturating_mul(STEPS);
        Limit {
            meter: Rc::clone(&self.meter),
            end: self.end.min(self.meter.steps.get().saturating_add(steps)),
        }
    }

    /// A part of what is left: 4 is a quarter.
    #[must_use]
    pub fn share(&self, parts: u64) -> Self {
        let left = self.end.saturating_sub(self.meter.steps.get());
        self.part(left / STEPS / parts.max(1))
    }

    /// The effort.
    pub fn effort(&self) -> u64 {
        self.end / STEPS
    }
}

#[cfg(test)]
mod tests {
    use super::{Limit, STEPS};

    #[test]
    fn parts_count_together_and_none_outlasts_the_whole() {
        let whole = Limit::new(10, None);
        let (part, longer) = (whole.part(4), whole.part(40));
        part.charge(4 * STEPS as usize);
        assert!(part.is_over() && !whole.is_over() && !longer.is_over());
        assert_eq!((whole.effort(), part.effort()), (10, 4));
        let half = whole.share(2);
        whole.charge(3 * STEPS as usize);
        assert!(half.is_over() && !whole.is_over());
        whole.charge(3 * STEPS as usize);
        assert!(whole.is_over() && longer.is_over() && !whole.is_late());
        let last = Limit::new(10, None);
        assert!(last.affords(10 * STEPS as usize) && !last.affords(10 * STEPS as usize + 1));
        assert!(Limit::new(1, Some(std::time::Duration::ZERO)).part(1).end == STEPS);
        assert!(!Limit::none().is_over());
    }
}
