//! Properties over the scans of a run.

use super::eval::{Memory, Pass};
use super::{Condition, Devices, Property};

/// Wait for a condition that must follow another.
///
/// What is true after a scan is true until the next one ends. The condition must therefore hold after a scan that
/// begins at the deadline or before: if it comes with a later scan, the deadline has passed without it.
#[derive(Clone, Copy, Default, Debug)]
pub struct Deadline {
    /// True if the trigger held after the last scan.
    held: bool,
    /// Milliseconds since the trigger began to hold, if the other condition has not followed.
    waited_ms: Option<u64>,
}

impl Deadline {
    /// Judges a scan that began `elapsed_ms` after the one before. Returns true if the condition is late: it did not
    /// hold at any moment of the `within_ms` since the trigger began to hold. Without time, it must hold after the
    /// same scan.
    pub fn is_missed(
        &mut self,
        (when, then): (bool, bool),
        within_ms: u32,
        elapsed_ms: u32,
    ) -> bool {
        let held = std::mem::replace(&mut self.held, when);
        let begins = when && !held;
        let waited = match self.waited_ms {
            Some(ms) => Some(ms + u64::from(elapsed_ms)),
            None => begins.then_some(0),
        };
        self.waited_ms = waited.filter(|_| !then);
        let limit = u64::from(within_ms);
        waited.is_some_and(|ms| ms > limit || ms == limit && !then)
    }

    /// Milliseconds since the trigger began to hold, if the other condition has not followed.
    pub fn waited_ms(&self) -> Option<u64> {
        self.waited_ms
    }
}

/// Follows conditions over the scans of a machine.
#[derive(Clone, Debug)]
pub struct Monitor<'c> {
    conditions: &'c [Condition],
    memory: Memory,
}

impl<'c> Monitor<'c> {
    /// Before the first scan.
    pub fn new(conditions: &'c [Condition]) -> Self {
        Monitor {
            conditions,
            memory: Memory::of(conditions),
        }
    }

    /// Returns true if all of them hold after the scan that has just ended, which began `elapsed_ms` after the one
    /// before. To be called after each scan.
    pub fn all_hold(&mut self, devices: &impl Devices, elapsed_ms: u32) -> bool {
        let mut pass = Pass::new(devices, elapsed_ms, &mut self.memory);
        let mut all = true;
        for condition in self.conditions {
            all &= pass.holds(condition);
        }
        all
    }
}

/// Follows a property over the scans of a machine.
#[derive(Clone)]
pub struct Watcher<'p> {
    property: &'p Property,
    memory: Memory,
    deadline: Deadline,
    /// True if the condition of `stays` must hold and has not ended.
    stays: bool,
}

impl<'p> Watcher<'p> {
    /// Before the first scan.
    pub fn new(property: &'p Property) -> Self {
        Watcher {
            property,
            memory: Memory::of(property.conditions()),
            deadline: Deadline::default(),
            stays: false,
        }
    }

    /// Returns true if the event has happened in the scan that has just ended, which began `elapsed_ms` after the one
    /// before. To be called after each scan.
    pub fn happened(&mut self, devices: &impl Devices, elapsed_ms: u32) -> bool {
        let mut pass = Pass::new(devices, elapsed_ms, &mut self.memory);
        match self.property {
            Property::Never(condition) | Property::Reachable(condition) => pass.holds(condition),
            Property::Always(condition) => !pass.holds(condition),
            Property::Whenever {
                when,
                then,
                within_ms,
            } => {
                let state = (pass.holds(when), pass.holds(then));
                self.deadline.is_missed(state, *within_ms, elapsed_ms)
            }
            Property::Stays {
                after,
                holds,
                until,
            } => {
                let begins = after.as_ref().map(|after| pass.holds(after));
                let (holds, until) = (pass.holds(holds), pass.holds(until));
                let must_hold = (self.stays || begins.unwrap_or(holds)) && !until;
                self.stays = must_hold;
                must_hold && !holds
            }
        }
    }
}
