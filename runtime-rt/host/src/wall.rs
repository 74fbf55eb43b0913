//! The time of day of the computer, for hosts whose real-time clock shows it.

use rungc_rt::{Clock, Hal, VirtualHal};
use std::time::{SystemTime, UNIX_EPOCH};

/// By how much the real-time clock may differ from the time of day before it follows, in milliseconds.
const TOLERANCE_MS: i64 = 2000;

/// Lets the real-time clock of virtual hardware follow the local time: as it passes, and when someone sets it. What the
/// program adds by setting its own clock remains.
#[derive(Debug)]
pub struct WallClock {
    /// The local time less that of the run, in milliseconds; none of a computer without local time.
    ahead_ms: Option<i64>,
}

impl WallClock {
    /// The clock shows the local time when the run begins.
    pub fn begin(hal: &mut VirtualHal) -> Self {
        let ahead_ms = system::local_ms();
        let begin = ahead_ms.and_then(|ms| {
            let epoch = Clock::new(1970, 1, 1, 0, 0, 0)?;
            Some(epoch.after(u64::try_from(ms).ok()?))
        });
        // Without one it keeps its own time.
        let _ = begin.and_then(|clock| hal.set_clock(clock));
        WallClock { ahead_ms }
    }

    /// Before a scan that begins `now_ms` milliseconds after the run: the clock follows the local time.
    pub fn follow(&mut self, hal: &mut VirtualHal, now_ms: u64) {
        self.follow_to(hal, local_ahead(now_ms));
    }

    fn follow_to(&mut self, hal: &mut VirtualHal, ahead_ms: Option<i64>) {
        let moved = |(before, ahead_ms): (i64, i64)| ahead_ms.saturating_sub(before);
        let moved = self.ahead_ms.zip(ahead_ms).map_or(0, moved);
        if moved.saturating_abs() >= TOLERANCE_MS {
            hal.move_clock(moved);
            self.ahead_ms = ahead_ms;
        }
    }

    /// The time of the run has stood still or passed slower on purpose, and the clock with it: it follows from here.
    pub fn stay(&mut self, now_ms: u64) {
        self.ahead_ms = local_ahead(now_ms);
    }
}

/// By how much the local time is ahead of that of the run.
fn local_ahead(now_ms: u64) -> Option<i64> {
    let now_ms = i64::try_from(now_ms).ok()?;
    Some(system::local_ms()?.saturating_sub(now_ms))
}

/// Milliseconds since 1970 (UTC).
fn utc_ms() -> Option<i64> {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).ok()?;
    i64::try_from(since.as_millis()).ok()
}

/// The standard library knows no local time; the C library that it uses does.
#[cfg(unix)]
#[allow(unsafe_code, reason = "a function of the C library")]
mod system {
    use core::ffi::{c_int, c_long};

    /// `struct tm` to its offset, as the C libraries of Linux, macOS and the BSDs have it, and room for more.
    #[repr(C)]
    #[derive(Default)]
    struct Local {
        fields: [c_int; 9],
        /// Seconds east of UTC.
        offset: c_long,
        more: [usize; 8],
    }

    unsafe extern "C" {
        fn localtime_r(time: *const c_long, local: *mut Local) -> *mut Local;
    }

    /// Milliseconds since 1970 by the zone that the system or `TZ` names.
    pub fn local_ms() -> Option<i64> {
        let utc_ms = super::utc_ms()?;
        let seconds = c_long::try_from(utc_ms / 1000).ok()?;
        let mut local = Local::default();
        // SAFETY: both are there, and `local` has room for what is written.
        let done = unsafe { localtime_r(&seconds, &mut local) };
        #[allow(clippy::useless_conversion, reason = "a long has 32 bits elsewhere")]
        let offset = i64::from(local.offset);
        (!done.is_null()).then(|| utc_ms + offset * 1000)
    }
}

/// On Windows, its kernel knows.
#[cfg(windows)]
#[allow(unsafe_code, reason = "a function of Windows")]
mod system {
    use core::ffi::c_int;

    /// Milliseconds from 1601, with which `FILETIME` begins, to 1970.
    const SINCE_1601_MS: i64 = 11_644_473_600_000;

    /// `FILETIME`s in a millisecond.
    const PER_MS: i64 = 10_000;

    unsafe extern "system" {
        /// Both are `FILETIME`: 64 bits in two words, the lower one first.
        fn FileTimeToLocalFileTime(utc: *const [u32; 2], local: *mut [u32; 2]) -> c_int;
    }

    /// Milliseconds since 1970 by the zone of the system.
    pub fn local_ms() -> Option<i64> {
        let utc = (super::utc_ms()? + SINCE_1601_MS) * PER_MS;
        let (utc, mut local) = ([utc as u32, (utc >> 32) as u32], [0; 2]);
        // SAFETY: both are there, with the size and alignment of a FILETIME.
        let done = unsafe { FileTimeToLocalFileTime(&utc, &mut local) } != 0;
        let local = i64::from(local[1]) << 32 | i64::from(local[0]);
        done.then(|| local / PER_MS - SINCE_1601_MS)
    }
}

/// Elsewhere the clock shows UTC.
#[cfg(not(any(unix, windows)))]
mod system {
    pub(super) use super::utc_ms as local_ms;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_follows_what_the_program_has_set() {
        let mut hal = VirtualHal::new();
        let mut wall = WallClock::begin(&mut hal);
        assert!(hal.clock().is_some_and(|clock| clock.year >= 2024));
        let ahead = wall.ahead_ms.unwrap();
        let noon = Clock::new(2026, 3, 1, 12, 0, 0).unwrap();
        hal.set_clock(noon).unwrap();
        for (moved_ms, shown) in [
            (1999, noon),
            (-1999, noon),
            (5 * 3_600_000, Clock::new(2026, 3, 1, 17, 0, 0).unwrap()),
            (-13 * 3_600_000, Clock::new(2026, 2, 28, 23, 0, 0).unwrap()),
            (0, noon),
        ] {
            wall.follow_to(&mut hal, Some(ahead + moved_ms));
            assert_eq!(hal.clock(), Some(shown), "{moved_ms} ms");
        }
        wall.follow_to(&mut hal, None);
        assert_eq!(hal.clock(), Some(noon));
    }
}
