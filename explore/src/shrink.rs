//! Runs made as short as they can be, in scans, in changes of inputs, and in time.

use crate::run::{Moment, Runner, follow};
use crate::task::{Found, Input, Step, Task, What};

/// How many scans may be executed to shrink a run.
const BUDGET: u64 = 400_000;
/// A scan time that people expect, in milliseconds.
const USUAL_MS: u32 = 10;

/// What the beginning of a run costs, in scans.
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
        shrinking.merge();
        shrinking.wait_less();
        shrinking.scan_as_usual();
        shrinking.take_small_values();
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
        tidy(&mut run);
        let cost: u64 = run.iter().map(|step| u64::from(step.scans)).sum();
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
        tidy(&mut shown);
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

    /// What changes in two steps can change in one; and later changes can come earlier.
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
            before.scans = moved.scans;
            before.scan_ms = moved.scan_ms;
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
            let (mut low, mut high) = (1, scans);
            // The fewest that show it, if more than the fewest do, too.
            while low < high {
                let middle = low + (high - low) / 2;
                let mut run = self.run().to_vec();
                let Some(step) = run.get_mut(at) else { return };
                step.scans = middle;
                match self.attempt(run) {
                    true => high = middle,
                    false => low = middle + 1,
                }
            }
        }
    }

    /// Scans that last as long as people expect.
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
            step.scan_ms = usual;
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
                // The smallest that shows it, if all beyond it do, too.
                let (mut low, mut high) = (0, value.abs());
                while low < high {
                    let middle = low + (high - low) / 2;
                    let mut run = self.run().to_vec();
                    let of_step = run.get_mut(at).and_then(|step| step.set.get_mut(change));
                    let Some(smaller) = of_step else { break };
                    smaller.1 = middle * value.signum();
                    match self.attempt(run) {
                        true => high = middle,
                        false => low = middle + 1,
                    }
                }
            }
        }
    }
}

/// How long a run is: scans, changes, how unusual its scan times are, numbers.
fn measure(run: &[Step]) -> (u64, usize, u64, u64, usize) {
    let scans = run.iter().map(|step| u64::from(step.scans)).sum();
    let changes = run.iter().map(|step| step.set.len()).sum();
    let unusual = |step: &Step| u64::from(step.scan_ms.abs_diff(USUAL_MS));
    let values = run.iter().flat_map(|step| &step.set);
    let values = values.map(|(_, value)| u64::from(value.unsigned_abs()));
    (
        scans,
        changes,
        run.iter().map(unusual).sum(),
        values.sum(),
        run.len(),
    )
}

/// Leaves out what changes nothing, and joins scans that are alike.
fn tidy(run: &mut Vec<Step>) {
    let mut values: std::collections::BTreeMap<usize, i32> = std::collections::BTreeMap::new();
    for step in run.iter_mut() {
        step.set
            .retain(|&(input, value)| values.insert(input, value).unwrap_or(0) != value);
        step.set.sort_unstable();
    }
    run.retain(|step| step.scans > 0);
    run.dedup_by(|next, before| {
        let alike = next.set.is_empty() && next.scan_ms == before.scan_ms;
        if alike {
            before.scans += next.scans;
        }
        alike
    });
}
