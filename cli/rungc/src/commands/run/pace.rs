//! Runs in real time: when scans begin, how late, and with which priority.

use crate::commands::{Failure, eprint_line};
use std::time::{Duration, Instant};

/// A run that is later than this has stood still (a suspended machine, a debugger). It does not catch up.
const STANDSTILL: Duration = Duration::from_secs(1);

/// Steps of lateness by which scans are counted, in microseconds.
const STEPS_US: [u64; 13] = [
    50, 100, 200, 300, 500, 1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 1_000_000,
];

/// Start times of the scans of a run in real time.
pub struct Pace {
    clock: clock::Clock,
    /// Number of scans that began with each step of lateness.
    counts: [u64; STEPS_US.len()],
    sum_us: u64,
    latest_us: u64,
}

impl Pace {
    /// None yet.
    pub fn new() -> Self {
        Pace {
            clock: clock::Clock::new(),
            counts: [0; STEPS_US.len()],
            sum_us: 0,
            latest_us: 0,
        }
    }

    /// Waits for the scan that is due `next` after the run began. Returns when the run began, which is later if it has
    /// stood still.
    pub fn wait(&mut self, begin: Instant, next: Duration) -> Instant {
        let due = begin + next;
        self.clock.sleep_until(due);
        let late = due.elapsed();
        if late > STANDSTILL {
            let seconds = late.as_secs_f64();
            eprint_line(&format!("rungc: the run stood still for {seconds:.1} s"));
            return begin + late;
        }
        let late_us = late.as_micros() as u64;
        let step = STEPS_US.iter().position(|&step| late_us <= step);
        self.counts[step.unwrap_or(STEPS_US.len() - 1)] += 1;
        self.sum_us += late_us;
        self.latest_us = self.latest_us.max(late_us);
        begin
    }

    /// Lateness of the scans; `None` if none has waited.
    pub fn summary(&self) -> Option<String> {
        let scans: u64 = self.counts.iter().sum();
        let mean = self.sum_us.checked_div(scans)?;
        let latest = self.latest_us;
        let mut within = 0;
        let usual = STEPS_US.iter().zip(self.counts).find(|(_, count)| {
            within += count;
            within * 1000 >= scans * 999
        });
        let usual = usual.map_or(latest, |(step, _)| (*step).min(latest));
        Some(format!(
            "{scans} scans began {mean} us late on average, 99.9 % of them at most {usual} us, the latest {latest} us"
        ))
    }
}

/// Lets this process run before all others, and keeps its memory from being paged out. What the system does not allow
/// is reported.
///
/// # Errors
/// The system has no such priorities.
#[cfg(target_os = "linux")]
pub fn raise(priority: u8) -> Result<(), Failure> {
    if let Err(why) = clock::raise(priority) {
        eprint_line(&format!(
            "rungc: --priority {priority}: {why}; it needs the capability CAP_SYS_NICE, or `LimitRTPRIO=` of systemd"
        ));
    }
    if let Err(why) = clock::lock_memory() {
        eprint_line(&format!(
            "rungc: --priority {priority}: memory is not locked: {why}; it needs CAP_IPC_LOCK, or `LimitMEMLOCK=infinity` of systemd"
        ));
    }
    Ok(())
}

/// Rejects what only Linux has.
///
/// # Errors
/// Always.
#[cfg(not(target_os = "linux"))]
pub fn raise(priority: u8) -> Result<(), Failure> {
    let why = "real-time priorities (SCHED_FIFO) exist only on Linux; leave out this option";
    Err(Failure::Because(format!("--priority {priority}: {why}")))
}

/// Waiting for absolute times, which a late wake-up does not add up over.
#[cfg(target_os = "linux")]
mod clock {
    use rustix::io::Errno;
    use rustix::mm::{MlockAllFlags, mlockall};
    use rustix::thread::{ClockId, clock_nanosleep_absolute};
    use rustix::time::{Timespec, clock_gettime};
    use std::time::Instant;
    use thread_priority::unix::{
        RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
        thread_native_id,
    };
    use thread_priority::{ThreadPriority, ThreadPriorityValue};

    /// The monotonic clock: setting the time of day does not change it.
    pub struct Clock {
        /// The same moment by the standard library and by the system.
        base: (Instant, Timespec),
    }

    impl Clock {
        pub fn new() -> Self {
            Clock {
                base: (Instant::now(), clock_gettime(ClockId::Monotonic)),
            }
        }

        pub fn sleep_until(&self, due: Instant) {
            let (instant, time) = self.base;
            let Ok(until) = Timespec::try_from(due.saturating_duration_since(instant)) else {
                return;
            };
            let until = time + until;
            while clock_nanosleep_absolute(ClockId::Monotonic, &until) == Err(Errno::INTR) {}
        }
    }

    /// SCHED_FIFO for this thread.
    pub fn raise(priority: u8) -> Result<(), String> {
        let value = ThreadPriorityValue::try_from(priority)?;
        let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
        let priority = ThreadPriority::Crossplatform(value);
        let set = set_thread_priority_and_policy(thread_native_id(), priority, policy);
        set.map_err(|error| error.to_string())
    }

    /// Locks the memory of the process; also what it will have, unless that is limited: then it could get none.
    pub fn lock_memory() -> Result<(), String> {
        let limit = rustix::process::getrlimit(rustix::process::Resource::Memlock);
        let flags = match limit.current {
            None => MlockAllFlags::CURRENT | MlockAllFlags::FUTURE,
            Some(_) => MlockAllFlags::CURRENT,
        };
        mlockall(flags).map_err(|error| error.to_string())
    }
}

/// Other systems.
#[cfg(not(target_os = "linux"))]
mod clock {
    use std::time::Instant;

    pub struct Clock;

    impl Clock {
        pub fn new() -> Self {
            Clock
        }

        pub fn sleep_until(&self, due: Instant) {
            std::thread::sleep(due.saturating_duration_since(Instant::now()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lateness_is_summed_up() {
        let mut pace = Pace::new();
        assert_eq!(pace.summary(), None);
        let begin = Instant::now();
        for n in 1..=10 {
            assert_eq!(pace.wait(begin, Duration::from_millis(n)), begin);
        }
        assert!(begin.elapsed() >= Duration::from_millis(10));
        let summary = pace.summary().unwrap();
        assert!(summary.starts_with("10 scans began "), "{summary}");
    }

    #[test]
    fn a_standstill_is_not_caught_up() {
        let begin = Instant::now() - Duration::from_secs(5);
        let mut pace = Pace::new();
        let begun = pace.wait(begin, Duration::from_millis(10));
        assert!(begun.elapsed() < Duration::from_secs(1));
        assert_eq!(pace.summary(), None);
    }
}
