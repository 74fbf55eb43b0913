//! Time that work takes. What counts is the processor's time, where the system reports it: other programs that run at
//! the same time do not add to it.

use std::time::{Duration, Instant};

/// Since when work is measured.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    start: Instant,
    processor: Option<Duration>,
}

impl Clock {
    /// From now on.
    pub fn start() -> Self {
        Clock {
            start: Instant::now(),
            processor: processor_time(),
        }
    }

    /// Time that this process has worked since.
    pub fn taken(&self) -> Duration {
        match (self.processor, processor_time()) {
            (Some(start), Some(now)) => now.saturating_sub(start),
            _ => self.start.elapsed(),
        }
    }
}

#[cfg(unix)]
fn processor_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    let seconds = u64::try_from(time.tv_sec).ok()?;
    let nanoseconds = u32::try_from(time.tv_nsec).ok()?;
    Some(Duration::new(seconds, nanoseconds))
}

#[cfg(not(unix))]
fn processor_time() -> Option<Duration> {
    None
}

/// Time that ended child processes have worked; `None` where the system does not report it. In steps of 10 ms.
pub fn of_others() -> Option<Duration> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // After the name, which may contain spaces: cutime and cstime are fields 16 and 17 of proc(5), the state is
    // field 3.
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(16 - 3);
    let mut ticks = || fields.next()?.parse::<u64>().ok();
    Some(Duration::from_millis(10 * (ticks()? + ticks()?)))
}
