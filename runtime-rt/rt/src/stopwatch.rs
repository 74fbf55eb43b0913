//! Time as a program sees it, made of the readings of a clock that begins anywhere, wraps, and is sometimes misread.

/// Elapsed time by a wrapping clock of 32 bits, a second of which has `SECOND` units.
///
/// Time never goes back: a reading that is up to a second before the last one lets no time pass, and neither do those
/// after it until
/// the clock has caught up. A reading further before is that of a clock that was set: time continues from there. So
/// does a clock that was
/// not read for more than half its range; how long, it cannot tell.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Stopwatch<const SECOND: u32> {
    /// The latest reading that let time pass.
    pub reading: u32,
    /// Time since the first reading, wrapping.
    pub elapsed: u32,
}

/// A stopwatch by a clock of milliseconds.
pub type Milliseconds = Stopwatch<1000>;

/// A stopwatch by a clock of microseconds.
pub type Microseconds = Stopwatch<1_000_000>;

impl<const SECOND: u32> Stopwatch<SECOND> {
    /// A stopwatch that begins at this reading.
    pub const fn at(reading: u32) -> Self {
        Stopwatch {
            reading,
            elapsed: 0,
        }
    }

    /// Takes a reading; returns the time that has passed since the last one.
    pub fn advance(&mut self, reading: u32) -> u32 {
        let passed = match self.behind(reading) {
            None => reading.wrapping_sub(self.reading),
            Some(behind) if behind <= SECOND => return 0,
            Some(_) => 0,
        };
        self.reading = reading;
        self.elapsed = self.elapsed.wrapping_add(passed);
        passed
    }

    /// The time since the last reading, as [`Stopwatch::advance`] gives it.
    pub fn passed(&self, reading: u32) -> u32 {
        let mut copy = *self;
        copy.advance(reading)
    }

    /// Returns true if the clock was set, or not read for more than half its range.
    pub fn is_set(&self, reading: u32) -> bool {
        self.behind(reading).is_some_and(|behind| behind > SECOND)
    }

    /// The units by which a reading is before the last one; `None` if it is not.
    fn behind(&self, reading: u32) -> Option<u32> {
        let behind = self.reading.wrapping_sub(reading);
        (1..=u32::MAX / 2 + 1).contains(&behind).then_some(behind)
    }

    /// Lets a period end; returns true if one of this length (not 0) has. Periods that no one looked at are skipped.
    pub fn ends_period(&mut self, reading: u32, length: u32) -> bool {
        self.advance(reading);
        let ends = self.elapsed >= length;
        if ends {
            self.elapsed %= length;
        }
        ends
    }
}

/// A clock of milliseconds made of one of microseconds. 1000 times its reading is that of the other at the start of
/// the millisecond, both
/// wrapping, so that times by either can be compared.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Divider {
    /// The reading in milliseconds.
    pub ms: u32,
}

impl Divider {
    /// Readings in milliseconds that are the same in microseconds are so far apart.
    const TURN: u32 = 1 << 29;

    /// The clock at this reading in microseconds.
    pub const fn at(now_us: u32) -> Self {
        Divider { ms: now_us / 1000 }
    }

    /// Takes a reading in microseconds; returns true if another millisecond has begun, or the clock was set.
    pub fn advance(&mut self, now_us: u32) -> bool {
        let watch = Microseconds::at(self.ms.wrapping_mul(1000));
        if watch.is_set(now_us) {
            // The reading that is before this one, so that the program sees that it was set, too.
            let set = Self::at(now_us).ms;
            let ahead = self.ms.wrapping_sub(set) % Self::TURN;
            self.ms = self.ms.wrapping_sub(ahead);
            return true;
        }
        let passed = watch.passed(now_us) / 1000;
        self.ms = self.ms.wrapping_add(passed);
        passed > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Elapsed time after these readings.
    fn elapsed(readings: &[u32]) -> u32 {
        let mut watch = Milliseconds::at(readings[0]);
        for &reading in readings {
            watch.advance(reading);
        }
        watch.elapsed
    }

    #[test]
    fn time_passes_from_any_reading_and_over_the_end() {
        for begin in [0, 1, 1 << 31, u32::MAX - 1, u32::MAX] {
            let readings: std::vec::Vec<u32> =
                (0..5).map(|n| begin.wrapping_add(100 * n)).collect();
            assert_eq!(elapsed(&readings), 400, "from {begin}");
        }
    }

    #[test]
    fn a_reading_that_is_behind_has_no_effect() {
        assert_eq!(elapsed(&[1000, 1100, 1099, 1101, 1200]), 200);
        assert_eq!(elapsed(&[0, 5, u32::MAX, 10]), 10);
        assert_eq!(elapsed(&[5000, 6000, 5000, 6001]), 1001);
    }

    #[test]
    fn a_clock_that_was_set_continues_from_there() {
        assert_eq!(elapsed(&[10_000, 10_100, 100, 200]), 200);
        assert_eq!(
            elapsed(&[10_100, 1_u32 << 31 | 20_000, 1_u32 << 31 | 20_100]),
            100
        );
        // A pause of less than half the range counts.
        assert_eq!(elapsed(&[100, 1 << 31]), (1 << 31) - 100);
    }

    #[test]
    fn milliseconds_agree_with_the_clock_that_they_are_made_of() {
        for begin in [0, 999, 5000, 1 << 31, u32::MAX - 300_000] {
            let mut clock = Divider::at(begin);
            let mut watch = Milliseconds::at(clock.ms);
            for n in 0..8_000_u32 {
                let now_us = begin.wrapping_add(700 * n);
                // Now and then it is misread.
                clock.advance(now_us.wrapping_sub(if n % 7 == 3 { 1000 } else { 0 }));
                clock.advance(now_us);
                watch.advance(clock.ms);
                let part = now_us.wrapping_sub(clock.ms.wrapping_mul(1000));
                assert!(part < 1000, "{begin}: {part} us into the millisecond");
            }
            let expected = 700 * 7_999 / 1000;
            assert!(watch.elapsed.abs_diff(expected) <= 1, "{begin}");
        }
    }

    #[test]
    fn a_program_sees_that_a_clock_of_microseconds_was_set() {
        // It was set back by a minute; and it was not read for 40 minutes.
        for set_us in [100_000_u32.wrapping_sub(60_000_000), 2_500_000_000] {
            let mut clock = Divider::at(100_000);
            let mut watch = Milliseconds::at(clock.ms);
            assert!(clock.advance(set_us));
            assert_eq!(watch.advance(clock.ms), 0);
            assert!(clock.advance(set_us.wrapping_add(5000)));
            assert_eq!(watch.advance(clock.ms), 5);
            assert!(
                set_us
                    .wrapping_add(5000)
                    .wrapping_sub(clock.ms.wrapping_mul(1000))
                    < 1000
            );
        }
    }

    #[test]
    fn periods_end_once_however_long_nobody_looked() {
        let mut watch = Milliseconds::at(u32::MAX - 4);
        let ends: std::vec::Vec<u32> = (0..30_u32)
            .filter(|n| watch.ends_period(u32::MAX.wrapping_sub(4).wrapping_add(*n), 10))
            .collect();
        assert_eq!(ends, [10, 20]);
        assert!(watch.ends_period(100_000, 10) && !watch.ends_period(100_001, 10));
        assert!(!watch.ends_period(99_990, 10));
    }
}
