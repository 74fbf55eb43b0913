//! Runs made as short as they can be, in scans, in changes of inputs, and in time.

use crate::run::{Moment, Runner, follow};
use crate::task::{Found, Input, Step, Task, What};
use crate::trains::{MOST_A_MS, are_possible, cost, left_off};
use std::collections::BTreeMap;

/// Maximum number of scans executed to shrink a run.
const BUDGET: u64 = 400_000;
/// A scan time that people expect, in milliseconds.
const USUAL_MS: u32 = 10;

/// Cost of the beginning of a run, in scans.
const BEGINNING: u64 = 20;
/// And a scan that does not end.
const ENDLESS: u64 = 10_000;

/// A run that gets shorter.
struct Shrinking<'t> {
    task: &'t Task<'t>,
    runner: Runner<'t>,
    /// Power-on.
    start: Moment<'t>,
    found: Found,
    left: u64,
}

/// The shortest run that was found to show the same; never a longer one. The run must show it.
pub fn shrink(task: &Task, found: Found) -> Found {
    let Ok(runner) = Runner::new(task) else {
        return found;
    };
    let mut shrinking = Shrinking {
        task,
        start: runner.save(),
        runner,
        found,
        left: BUDGET,
    };
    loop {
        let before = shrinking.found.run.clone();
        shrinking.leave_steps_out();
        shrinking.leave_changes_out();
        shrinking.leave_pulses_out();
        shrinking.merge();
        shrinking.wait_less();
        shrinking.scan_as_usual();
        shrinking.take_small_values();
        shrinking.take_few_pulses();
        if shrinking.found.run == before || shrinking.left == 0 {
            return shrinking.found;
        }
    }
}

impl Shrinking<'_> {
    fn run(&self) -> &[Step] {
        &self.found.run
    }

    /// Takes another run if it shows the same and is no longer.
    fn attempt(&mut self, mut run: Vec<Step>) -> bool {
        tidy(self.task, &mut run);
        if !run.iter().all(|step| are_possible(self.task, step)) {
            return false;
        }
        let costs = run
            .iter()
            .map(|step| u64::from(step.scans) + cost(&step.pulses));
        let cost: u64 = costs.sum();
        if run == self.found.run || self.left == 0 {
            return false;
        }
        self.left = self.left.saturating_sub(match self.found.what {
            What::Watchdog { .. } => cost + ENDLESS,
            _ => cost + BEGINNING,
        });
        self.runner.restore(&self.start);
        let Some(mut shown) = follow(&mut self.runner, &self.found.what, &run) else {
            return false;
        };
        tidy(self.task, &mut shown);
        let shorter = measure(&shown) < measure(&self.found.run);
        if shorter {
            self.found.run = shown;
        }
        shorter
    }

    /// Steps that do not matter, many at a time, then one at a time.
    fn leave_steps_out(&mut self) {
        let mut size = self.run().len().div_ceil(2);
        while size > 0 {
            let mut at = 0;
            while at < self.run().len() {
                let mut run = self.run().to_vec();
                run.drain(at..(at + size).min(run.len()));
                if run.is_empty() || !self.attempt(run) {
                    at += size;
                }
            }
            size /= 2;
        }
    }

    /// Changes of inputs that do not matter; also an input's turning on together with its turning off.
    fn leave_changes_out(&mut self) {
        let mut at = 0;
        while at < self.run().len() {
            let mut change = 0;
            while change < self.run().get(at).map_or(0, |step| step.set.len()) {
                let input = self.run()[at].set[change].0;
                let mut run = self.run().to_vec();
                run[at].set.remove(change);
                let mut both = run.clone();
                let later = both[at + 1..].iter_mut();
                let mut later =
                    later.filter(|step| step.set.iter().any(|(other, _)| *other == input));
                if let Some(next) = later.next() {
                    next.set.retain(|(other, _)| *other != input);
                }
                if !self.attempt(both) && !self.attempt(run) {
                    change += 1;
                }
            }
            at += 1;
        }
    }

    /// Pulses that do not matter.
    fn leave_pulses_out(&mut self) {
        for at in 0..self.run().len() {
            let mut train = 0;
            while train < self.run().get(at).map_or(0, |step| step.pulses.len()) {
                let mut run = self.run().to_vec();
                run[at].pulses.remove(train);
                if !self.attempt(run) {
                    train += 1;
                }
            }
        }
    }

    /// Merges steps, and moves later changes to earlier steps.
    fn merge(&mut self) {
        let mut at = 1;
        while at < self.run().len() {
            let mut run = self.run().to_vec();
            let moved = run.remove(at);
            let before = &mut run[at - 1];
            before
                .set
                .retain(|(input, _)| moved.set.iter().all(|(other, _)| other != input));
            before.set.extend(moved.set);
            for (source, count) in moved.pulses {
                let mut earlier = before.pulses.iter_mut();
                match earlier.find(|(other, _)| *other == source) {
                    Some((_, earlier)) => *earlier = earlier.saturating_add(count),
                    None => before.pulses.push((source, count)),
                }
            }
            before.pulses.retain(|(_, count)| *count != 0);
            before.pulses.sort_unstable();
            before.scans = moved.scans;
            // Its pulses take their time.
            before.scan_ms = match before.pulses.is_empty() {
                true => moved.scan_ms,
                false => before.scan_ms.max(moved.scan_ms),
            };
            if !self.attempt(run) {
                at += 1;
            }
        }
    }

    /// Fewer scans.
    fn wait_less(&mut self) {
        for at in 0..self.run().len() {
            let Some(scans) = self.run().get(at).map(|step| step.scans) else {
                return;
            };
            smallest(1, scans, |fewer| {
                let mut run = self.run().to_vec();
                let Some(step) = run.get_mut(at) else {
                    return false;
                };
                step.scans = fewer;
                self.attempt(run)
            });
        }
    }

    /// Scans that last as long as people expect, or as their pulses take.
    fn scan_as_usual(&mut self) {
        let usual = USUAL_MS.min(self.task.scan_ms);
        let all = self.run().iter().cloned();
        let all = all.map(|step| Step {
            scan_ms: usual,
            ..step
        });
        if self.attempt(all.collect()) {
            return;
        }
        for at in 0..self.run().len() {
            let mut run = self.run().to_vec();
            let Some(step) = run.get_mut(at) else { return };
            let counts = step.pulses.iter().map(|(_, count)| count.unsigned_abs());
            let needed = counts.max().unwrap_or(0).div_ceil(MOST_A_MS);
            step.scan_ms = usual.max(needed);
            self.attempt(run);
        }
    }

    /// Numbers that are as small as they can be.
    fn take_small_values(&mut self) {
        for at in 0..self.run().len() {
            for change in 0..self.run().get(at).map_or(0, |step| step.set.len()) {
                let Some(&(input, value)) =
                    self.run().get(at).and_then(|step| step.set.get(change))
                else {
                    continue;
                };
                if self.task.inputs.get(input).is_none_or(Input::is_bit) {
                    continue;
                }
                smallest(0, value.unsigned_abs(), |value_now| {
                    let mut run = self.run().to_vec();
                    let of_step = run.get_mut(at).and_then(|step| step.set.get_mut(change));
                    let Some(smaller) = of_step else { return false };
                    smaller.1 = value_now as i32 * value.signum();
                    self.attempt(run)
                });
            }
        }
    }

    /// As few pulses as show it.
    fn take_few_pulses(&mut self) {
        for at in 0..self.run().len() {
            for train in 0..self.run().get(at).map_or(0, |step| step.pulses.len()) {
                let of_step = self.run().get(at).and_then(|step| step.pulses.get(train));
                let Some(&(_, count)) = of_step else { continue };
                smallest(1, count.unsigned_abs(), |fewer| {
                    let mut run = self.run().to_vec();
                    let of_step = run.get_mut(at).and_then(|step| step.pulses.get_mut(train));
                    let Some(pulses) = of_step else { return false };
                    pulses.1 = fewer as i32 * count.signum();
                    self.attempt(run)
                });
            }
        }
    }
}

/// Tries numbers to come to the smallest that `holds`, if all beyond it up to `high` do, too.
fn smallest(mut low: u32, mut high: u32, mut holds: impl FnMut(u32) -> bool) {
    while low < high {
        let middle = low + (high - low) / 2;
        match holds(middle) {
            true => high = middle,
            false => low = middle + 1,
        }
    }
}

/// Complexity of a run: scans, changes and trains of pulses, deviation of its scan times from the usual one, numbers.
fn measure(run: &[Step]) -> (u64, usize, u64, u64, usize) {
    let scans = run.iter().map(|step| u64::from(step.scans)).sum();
    let changes = run.iter().map(|step| step.set.len() + step.pulses.len());
    let unusual = |step: &Step| u64::from(step.scan_ms.abs_diff(USUAL_MS));
    let values = run
        .iter()
        .flat_map(|step| step.set.iter().chain(&step.pulses));
    let values = values.map(|(_, value)| u64::from(value.unsigned_abs()));
    (
        scans,
        changes.sum(),
        run.iter().map(unusual).sum(),
        values.sum(),
        run.len(),
    )
}

/// Leaves out what changes nothing, and joins scans that are alike.
fn tidy(task: &Task, run: &mut Vec<Step>) {
    let mut values: BTreeMap<usize, i32> = BTreeMap::new();
    for step in run.iter_mut() {
        step.set
            .retain(|&(input, value)| values.insert(input, value).unwrap_or(0) != value);
        step.set.sort_unstable();
        values.extend(left_off(task, &step.pulses).map(|input| (input, 0)));
    }
    run.retain(|step| step.scans > 0);
    run.dedup_by(|next, before| {
        let nothing = next.set.is_empty() && next.pulses.is_empty();
        let alike = nothing && next.scan_ms == before.scan_ms;
        if alike {
            before.scans += next.scans;
        }
        alike
    });
}
