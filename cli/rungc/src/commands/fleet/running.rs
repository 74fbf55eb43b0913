//! The cycle of a fleet, and its summary at the end.

use super::failures::{self, About};
use super::memory;
use crate::args::FleetArgs;
use crate::commands::run::pace::{self, Pace};
use crate::commands::{
    Failure, Outcome, Result, counted, eprint_line, grouped, interruption, print_text,
};
use rungc_fleet::{Broker, Group};
use std::time::{Duration, Instant};

/// Scan times that are kept apart, in microseconds: those of a thousandth of the longest are one.
const STEP_US: u64 = 10;

/// Number of such steps; longer times count as the last.
const STEPS: usize = 100_000;

/// A fleet at work.
pub struct Fleets<'m> {
    groups: Vec<Group<'m>>,
    /// Properties of each group.
    about: Vec<About<'m>>,
    broker: Option<Broker>,
    cycle_ms: u64,
    now_ms: u64,
    times: Times,
}

/// Durations of the scans of all PLCs.
struct Times {
    /// By steps.
    counts: Vec<u32>,
    scans: u64,
    sum_us: u64,
    longest_us: u64,
    /// Scans that had not ended when the next one was due.
    missed: u64,
}

impl<'m> Fleets<'m> {
    /// PLCs that have just been switched on.
    pub fn new(groups: Vec<(Group<'m>, About<'m>)>, broker: Option<Broker>, cycle_ms: u64) -> Self {
        let (groups, about) = groups.into_iter().unzip();
        Fleets {
            groups,
            about,
            broker,
            cycle_ms,
            now_ms: 0,
            times: Times {
                counts: vec![0; STEPS],
                scans: 0,
                sum_us: 0,
                longest_us: 0,
                missed: 0,
            },
        }
    }

    /// Runs it to the end, and says how it was.
    pub fn run(mut self, args: &FleetArgs) -> Result {
        interruption::note();
        if let Some(priority) = args.priority {
            pace::raise(priority)?;
        }
        let plcs: u64 = self.groups.iter().map(|group| u64::from(group.count)).sum();
        let plcs = counted(plcs as usize, "PLC");
        eprint_line(&format!(
            "rungc: {plcs}, a scan of all every {} ms",
            self.cycle_ms
        ));
        let mut pace = Pace::new();
        let cycled = self.cycle(args, &mut pace);
        if let Some(broker) = self.broker.take() {
            broker.end().iter().for_each(report);
        }
        let outcome = cycled?;
        self.summary(args, &pace)?;
        Ok(outcome)
    }

    fn cycle(&mut self, args: &FleetArgs, pace: &mut Pace) -> Result {
        let cycle = Duration::from_millis(self.cycle_ms);
        let end_ms = args.duration.unwrap_or(u64::MAX);
        let mut begin = Instant::now();
        loop {
            let started = Instant::now();
            self.scan()?;
            self.times.add(started.elapsed());
            if interruption::is_requested() {
                eprint_line(&format!("rungc: interrupted at {} ms", self.now_ms));
                return Ok(Outcome::Interrupted);
            }
            let next_ms = self.now_ms + self.cycle_ms;
            if next_ms > end_ms {
                return Ok(Outcome::Success);
            }
            if !args.in_virtual_time {
                let due = Duration::from_millis(next_ms);
                self.times.missed += u64::from(begin.elapsed() > due);
                begin = self.rest(begin, due, cycle, pace);
            }
            self.now_ms = next_ms;
        }
    }

    /// Waits for the next scan. Returns when the run began.
    fn rest(&self, begin: Instant, due: Duration, cycle: Duration, pace: &mut Pace) -> Instant {
        /// Time within which an interruption is noticed.
        const NOTICED: Duration = Duration::from_millis(100);
        if cycle > NOTICED {
            while !interruption::is_requested() && begin.elapsed() + NOTICED < due {
                std::thread::sleep(NOTICED);
            }
            if interruption::is_requested() {
                return begin;
            }
        }
        pace.wait(begin, due)
    }

    /// A scan of all PLCs, with what happens before and after it.
    fn scan(&mut self) -> std::result::Result<(), Failure> {
        if let Some(broker) = &mut self.broker {
            broker.take(&mut self.groups).iter().for_each(report);
        }
        let scan_us = u32::try_from(1000 * self.cycle_ms).unwrap_or(u32::MAX);
        for group in &mut self.groups {
            let messages = group.begin_scan(self.now_ms, scan_us);
            messages.iter().for_each(report);
        }
        for group in &mut self.groups {
            let ended = group.end_scan();
            ended.map_err(|error| Failure::Because(error.to_string()))?;
        }
        if let Some(broker) = &mut self.broker {
            broker.give(&mut self.groups, self.now_ms);
        }
        Ok(())
    }

    fn summary(&mut self, args: &FleetArgs, pace: &Pace) -> std::result::Result<(), Failure> {
        let Times {
            scans,
            sum_us,
            longest_us,
            missed,
            ..
        } = self.times;
        let mean_us = sum_us.checked_div(scans).unwrap_or(0);
        let usual_us = self.times.usual_us();
        let mut text = format!(
            "{} of all PLCs, {} missed\n\
             a scan of all took {} ms on average, 99.9 % of them at most {} ms, the longest {} ms\n",
            counted(scans as usize, "scan"),
            grouped(missed as usize),
            milliseconds(mean_us),
            milliseconds(usual_us),
            milliseconds(longest_us),
        );
        if let (Some(late), false) = (pace.summary(), args.in_virtual_time) {
            text.push_str(&format!("{late}\n"));
        }
        let mut plcs = 0;
        for (group, about) in self.groups.iter_mut().zip(&self.about) {
            text.push_str(&of_group(group, about));
            plcs += u64::from(group.count);
        }
        let children: Vec<u32> = self.groups.iter().flat_map(Group::children).collect();
        if let Some(peak) = memory::peak(&children) {
            let all = peak as f64 / 1e6;
            let each = peak.checked_div(plcs).unwrap_or(0) as f64 / 1e3;
            text.push_str(&format!(
                "memory: {all:.1} MB of all processes, {each:.1} KB a PLC\n"
            ));
        }
        Ok(print_text(&text)?)
    }
}

/// The lines about a group.
fn of_group(group: &mut Group<'_>, about: &About<'_>) -> String {
    let what = group.what();
    let count = counted(group.count as usize, "PLC");
    let why = about.why.as_ref().map(|why| format!(": {why}"));
    let why = why.unwrap_or_default();
    let requests = group.requests().map(|[requests, rejected]| {
        let requests = counted(requests as usize, "request");
        format!("; {requests}, {rejected} rejected")
    });
    let requests = requests.unwrap_or_default();
    let name = group.name.clone();
    let mut text = format!("{name}: {count}, {what}{why}{requests}\n");
    for line in failures::lines(&group.failures(), about) {
        text.push_str(&format!("{name}: {line}\n"));
    }
    let stopped = group.stopped();
    if stopped > 0 {
        let stopped = counted(stopped as usize, "PLC");
        text.push_str(&format!("{name}: {stopped} in STOP at the end\n"));
    }
    text
}

impl Times {
    fn add(&mut self, took: Duration) {
        let us = took.as_micros() as u64;
        let step = (us / STEP_US).min(STEPS as u64 - 1);
        self.counts[step as usize] += 1;
        self.scans += 1;
        self.sum_us += us;
        self.longest_us = self.longest_us.max(us);
    }

    /// Upper bound of 99.9 % of the scans.
    fn usual_us(&self) -> u64 {
        let mut within = 0;
        let step = self.counts.iter().position(|&count| {
            within += u64::from(count);
            within * 1000 >= self.scans * 999
        });
        let step = step.map_or(0, |step| step as u64 + 1);
        (step * STEP_US).min(self.longest_us)
    }
}

fn milliseconds(us: u64) -> String {
    format!("{:.2}", us as f64 / 1e3)
}

fn report(line: &String) {
    eprint_line(&format!("rungc: {line}"));
}
