//! A pulse generator: one pulse output as a pure state machine over time, in integers. Whoever has the time drives it:
//! the simulator each millisecond, a hardware timer at [`Generator::next_edge`].
//!
//! A speed is kept as its square, which a steady acceleration changes by the same amount at each pulse (v² = v₀² +
//! 2as). So ramps need no clock, the way down begins where as many pulses are left as it takes, and a train ends with
//! exactly the pulses that it was given.

use crate::stopwatch::Microseconds;

/// A whole pulse in the unit of its progress, millihertz times microseconds.
const FULL: u64 = 1_000_000_000;

/// A train of pulses. Speeds are in millihertz, up to 4 MHz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Train {
    /// Speed that it is to reach; 0: it waits.
    pub speed: u32,
    /// Square of the speed that ramps begin and end with, in mHz².
    pub lowest: u64,
    /// Increase of the square of the speed per pulse on the way up, in mHz²; 0: any speed at once.
    pub up: u64,
    /// Decrease per pulse on the way down.
    pub down: u64,
    /// Pulses; 0: without end.
    pub total: u32,
    /// True if positions count down.
    pub reverse: bool,
}

impl Train {
    /// A train at one speed.
    pub const fn steady(speed: u32, total: u32) -> Train {
        Train {
            speed,
            lowest: 0,
            up: 0,
            down: 0,
            total,
            reverse: false,
        }
    }

    /// The change of the square of a speed at each pulse, in mHz², by an acceleration from 0 to `hz` in `ms`: 2a.
    pub const fn slope(hz: u32, ms: u32) -> u64 {
        let ms = if ms == 0 { 1 } else { ms };
        hz as u64 * 2_000_000_000 / ms as u64
    }
}

/// One pulse output. All zero is one that is idle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Generator {
    /// Progress of the present pulse.
    phase: u64,
    /// Progress of a whole pulse.
    full: u64,
    /// Square of the speed.
    square: u64,
    lowest: u64,
    up: u64,
    down: u64,
    /// Progress per microsecond.
    rate: u32,
    speed: u32,
    total: u32,
    sent: u32,
    /// Reading of the clock at the last call.
    now_us: u32,
    /// On-time of a pulse.
    on: u32,
    busy: bool,
    reverse: bool,
    /// The train was stopped before its end.
    stopped: bool,
    /// A signal of a fixed width and period.
    modulates: bool,
    /// It has begun, and no pin shows it yet.
    fresh: bool,
}

impl Generator {
    /// An idle output.
    pub const fn new() -> Self {
        Generator {
            phase: 0,
            full: FULL,
            square: 0,
            lowest: 0,
            up: 0,
            down: 0,
            rate: 0,
            speed: 0,
            total: 0,
            sent: 0,
            now_us: 0,
            on: 0,
            busy: false,
            reverse: false,
            stopped: false,
            modulates: false,
            fresh: false,
        }
    }

    /// Begins a train at the time of the last [`Generator::advance`], instead of whatever it does.
    pub fn start(&mut self, train: Train) {
        *self = Generator {
            full: FULL,
            lowest: train.lowest.min(square(train.speed)),
            up: train.up,
            down: train.down,
            speed: train.speed,
            total: train.total,
            now_us: self.now_us,
            on: (FULL / 2) as u32,
            busy: true,
            reverse: train.reverse,
            fresh: true,
            ..Generator::new()
        };
        self.square = self.first_square();
        self.hold_back();
        self.rate = self.square.isqrt() as u32;
    }

    /// Sends pulses of a width and a period without end; a signal that is already sent continues with them. Both are in
    /// units of `unit_us`.
    pub fn modulate(&mut self, width: u32, period: u32, unit_us: u32) {
        if !self.modulates {
            *self = Generator {
                now_us: self.now_us,
                busy: true,
                modulates: true,
                rate: 1,
                fresh: true,
                ..Generator::new()
            };
        }
        self.full = (u64::from(period) * u64::from(unit_us)).max(1);
        self.phase = self.phase.min(self.full - 1);
        self.on = width.saturating_mul(unit_us);
    }

    /// Stops at once.
    pub fn halt(&mut self) {
        self.stopped |= self.busy;
        self.rest();
    }

    /// Comes down and stops.
    pub fn stop(&mut self) {
        if self.down == 0 || self.rate == 0 {
            return self.halt();
        }
        let above = self.square.saturating_sub(self.lowest);
        let needed = above.div_ceil(self.down).saturating_add(1);
        let end = u64::from(self.sent) + needed;
        if self.total == 0 || end < u64::from(self.total) {
            self.total = u32::try_from(end).unwrap_or(u32::MAX);
        }
        self.stopped = true;
    }

    /// Changes the speed of a train that is sent, by its ramps if it has any; at 0 it waits.
    pub fn set_speed(&mut self, speed: u32) {
        self.speed = speed;
        if speed > 0 {
            self.lowest = self.lowest.min(square(speed));
        }
        if self.busy && (self.up == 0 || self.square == 0) {
            self.square = self.first_square();
            self.hold_back();
            self.rate = self.square.isqrt() as u32;
        }
    }

    /// Square of the speed with which it leaves a standstill.
    fn first_square(&self) -> u64 {
        let wanted = square(self.speed);
        if self.up == 0 {
            wanted
        } else {
            wanted.min(self.lowest)
        }
    }

    /// Changes how many pulses a train has that is sent; the pulse that has begun is sent in any case.
    pub fn set_total(&mut self, total: u32) {
        if self.busy && !self.stopped && self.total != 0 {
            self.total = total.max(self.sent.saturating_add(1));
        }
    }

    /// Adds pulses to a train that has an end, and is not being stopped.
    pub fn extend(&mut self, pulses: u32) {
        if self.busy && self.total != 0 && !self.stopped {
            self.total = self.total.saturating_add(pulses);
        }
    }

    /// Pulses that have not ended of a train that has an end.
    pub fn remaining(&self) -> u32 {
        match self.busy {
            true => self.total.saturating_sub(self.sent),
            false => 0,
        }
    }

    /// Ends an endless train after this many more pulses.
    pub fn end_in(&mut self, pulses: u32) {
        if self.busy && self.total == 0 {
            self.total = self.sent.saturating_add(pulses.max(1));
            self.hold_back();
            self.rate = self.square.isqrt() as u32;
        }
    }

    /// Counts the pulses that have ended since the last call. Call it at least every half an hour; what time passes
    /// by these readings,
    /// [`Microseconds`] says.
    pub fn advance(&mut self, now_us: u32) -> u32 {
        if !self.busy {
            self.now_us = now_us;
            return 0;
        }
        let mut watch = Microseconds::at(self.now_us);
        let mut left = u64::from(watch.advance(now_us));
        self.now_us = watch.reading;
        let mut count: u32 = 0;
        while self.busy && self.rate > 0 {
            let gain = left.saturating_mul(self.rate.into());
            // At more than 1 MHz, several pulses may have ended already.
            let progress = gain.saturating_add(self.phase);
            let Some(past) = progress.checked_sub(self.full) else {
                self.phase = progress;
                break;
            };
            // A division of 64 bits takes a microcontroller hundreds of instructions, and mostly one pulse ends.
            let pulses = match past < self.full {
                true => 1,
                false => (1 + past / self.full).min(self.alike().into()),
            };
            let end = pulses * self.full;
            let used = quotient_up(end.saturating_sub(self.phase), self.rate);
            self.phase = used * u64::from(self.rate) + self.phase - end;
            left -= used;
            count = count.wrapping_add(pulses as u32);
            self.passed(pulses as u32);
        }
        count
    }

    /// Number of pulses that end by `now_us` if nothing changes.
    pub fn count_by(&self, now_us: u32) -> u32 {
        let mut copy = *self;
        copy.advance(now_us)
    }

    /// The same for a host that drives a pin: at most one edge of the signal passes, so that the pin has every pulse. A
    /// host that comes late sends the next edges sooner, but none before its time is half over; what it is later than
    /// that, the train is longer.
    pub fn step(&mut self, now_us: u32) -> u32 {
        if core::mem::take(&mut self.fresh) {
            self.now_us = now_us;
        }
        let passed = Microseconds::at(self.now_us).passed(now_us);
        let Some(wait) = self.next_edge().filter(|&wait| wait <= passed) else {
            return self.advance(now_us);
        };
        let count = self.advance(self.now_us.wrapping_add(wait));
        let late = passed - wait;
        let most = self.next_edge().map_or(0, |next| next / 2);
        self.now_us = now_us.wrapping_sub(late.min(most));
        count
    }

    /// Microseconds from `now_us` to when the output changes next; `None` if it does not.
    pub fn wait(&self, now_us: u32) -> Option<u32> {
        let passed = Microseconds::at(self.now_us).passed(now_us);
        Some(self.next_edge()?.saturating_sub(passed))
    }

    /// From now on the time is this.
    pub fn set_time(&mut self, now_us: u32) {
        self.now_us = now_us;
    }

    /// Number of pulses, the present one included, that are certain to have its speed.
    fn alike(&self) -> u32 {
        if self.modulates {
            return u32::MAX;
        }
        if self.square != square(self.speed) {
            return 1;
        }
        if self.total == 0 {
            return u32::MAX;
        }
        let remaining = self.total - self.sent;
        let above = self.square.saturating_sub(self.lowest);
        let way_down = above.div_ceil(self.down.max(1));
        if self.down == 0 {
            return remaining;
        }
        u64::from(remaining).saturating_sub(way_down).max(1) as u32
    }

    /// This many pulses have ended; gives the next one its speed.
    fn passed(&mut self, pulses: u32) {
        if self.modulates {
            return;
        }
        // A train without end wraps.
        self.sent = self.sent.wrapping_add(pulses);
        if self.total != 0 && self.sent >= self.total {
            return self.rest();
        }
        let (wanted, before) = (square(self.speed), self.square);
        self.square = match (self.square < wanted, self.up, self.down) {
            // Below the lowest speed it stands still.
            (false, _, 1..) if wanted == 0 && self.square <= self.lowest => 0,
            (true, up @ 1.., _) => wanted.min(self.square + up),
            (false, _, down @ 1..) => wanted.max(self.square.saturating_sub(down)),
            _ => wanted,
        };
        self.hold_back();
        if self.square != before {
            self.rate = self.square.isqrt() as u32;
        }
    }

    /// No pulse is faster than the way down from it allows.
    fn hold_back(&mut self) {
        if self.total == 0 || self.down == 0 {
            return;
        }
        let left = u64::from(self.total - self.sent).saturating_sub(1);
        let most = self.lowest.saturating_add(self.down.saturating_mul(left));
        self.square = self.square.min(most);
    }

    fn rest(&mut self) {
        self.busy = false;
        self.modulates = false;
        self.rate = 0;
        self.square = 0;
        self.phase = 0;
    }

    /// Returns true if a train is being sent.
    pub fn is_busy(&self) -> bool {
        self.busy
    }

    /// Returns true while it slows down towards its end, after all pulses or by [`Generator::stop`].
    pub fn is_ending(&self) -> bool {
        if !self.busy || self.total == 0 || self.down == 0 {
            return false;
        }
        let above = self.square.saturating_sub(self.lowest);
        u64::from(self.total - self.sent) <= above.div_ceil(self.down) + 1
    }

    /// Returns true while [`Generator::stop`] slows it down.
    pub fn is_stopping(&self) -> bool {
        self.busy && self.stopped
    }

    /// Returns true if the last train was sent to its end.
    pub fn is_complete(&self) -> bool {
        !self.busy && !self.stopped && self.total != 0 && self.sent >= self.total
    }

    /// Returns true if it is a signal of [`Generator::modulate`].
    pub fn modulates(&self) -> bool {
        self.modulates
    }

    /// Returns true if positions count down.
    pub fn is_reverse(&self) -> bool {
        self.reverse
    }

    /// The present speed in millihertz; 0 if idle.
    pub fn millihertz(&self) -> u32 {
        if self.modulates {
            let changes = self.on > 0 && u64::from(self.on) < self.full;
            if changes {
                (FULL / self.full) as u32
            } else {
                0
            }
        } else {
            self.rate
        }
    }

    /// Pulses of this train that have ended.
    pub fn sent(&self) -> u32 {
        self.sent
    }

    /// State of the output: on in the first half of each pulse.
    pub fn level(&self) -> bool {
        self.busy && self.rate > 0 && self.phase < self.on.into()
    }

    /// Microseconds from the last [`Generator::advance`] to when the output changes next; `None` if it does not.
    pub fn next_edge(&self) -> Option<u32> {
        if !self.busy || self.rate == 0 {
            return None;
        }
        let on = u64::from(self.on).min(self.full);
        let next = if self.phase < on { on } else { self.full };
        let wait = quotient_up(next.saturating_sub(self.phase), self.rate);
        Some(u32::try_from(wait).unwrap_or(u32::MAX))
    }
}

/// A quotient, rounded up, by a division of 32 bits where that is enough.
fn quotient_up(dividend: u64, divisor: u32) -> u64 {
    match u32::try_from(dividend) {
        Ok(dividend) => dividend.div_ceil(divisor).into(),
        Err(_) => dividend.div_ceil(divisor.into()),
    }
}

/// Square of a speed.
const fn square(speed: u32) -> u64 {
    speed as u64 * speed as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that look random (Knuth's multiplier).
    struct Numbers(u64);

    impl Numbers {
        fn below(&mut self, end: u64) -> u64 {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) % end
        }

        fn train(&mut self) -> Train {
            let slope = |this: &mut Self| match this.below(4) {
                0 => 0,
                _ => Train::slope(
                    10 + this.below(200_000) as u32,
                    50 + this.below(5000) as u32,
                ),
            };
            let (up, down) = (slope(self), slope(self));
            Train {
                speed: 1000 * (1 + self.below(200_000) as u32),
                lowest: up.max(down) / 4,
                up,
                down,
                total: 1 + self.below(5000) as u32,
                reverse: self.below(2) == 0,
            }
        }
    }

    /// Sends a train to its end in steps of random length; returns how many pulses it had.
    fn send(generator: &mut Generator, numbers: &mut Numbers, mut now: u32) -> u32 {
        let mut count = 0;
        while generator.is_busy() {
            now = now.wrapping_add(1 + numbers.below(20_000) as u32);
            count += generator.advance(now);
        }
        count
    }

    #[test]
    fn a_train_has_as_many_pulses_as_asked_for() {
        let mut numbers = Numbers(1);
        for _ in 0..2000 {
            let train = numbers.train();
            let now = numbers.below(1 << 32) as u32;
            let mut generator = Generator::new();
            generator.advance(now / 2);
            generator.advance(now);
            generator.start(train);
            assert_eq!(
                send(&mut generator, &mut numbers, now),
                train.total,
                "{train:?}"
            );
            assert!(generator.is_complete() && generator.millihertz() == 0);
        }
    }

    #[test]
    fn speeds_of_more_than_a_pulse_in_a_microsecond_are_kept() {
        let mut numbers = Numbers(5);
        for speed in [FULL as u32, FULL as u32 + 1, 2_500_000_000, u32::MAX] {
            let mut generator = Generator::new();
            generator.start(Train::steady(speed, 0));
            let (mut now, mut count) = (0, 0);
            while now < 10_000 {
                now += 1 + numbers.below(9) as u32;
                count += u64::from(generator.advance(now));
                assert!(generator.next_edge().is_some());
            }
            assert_eq!(count, u64::from(now) * u64::from(speed) / FULL, "{speed}");
        }
        // Ramps change the speed at each pulse.
        for _ in 0..200 {
            let train = Train {
                speed: numbers.below(u64::from(u32::MAX)) as u32,
                ..numbers.train()
            };
            let mut generator = Generator::new();
            generator.start(train);
            assert_eq!(send(&mut generator, &mut numbers, 0), train.total);
        }
    }

    #[test]
    fn no_step_of_speed_is_greater_than_its_ramp() {
        let mut numbers = Numbers(2);
        for _ in 0..500 {
            let train = numbers.train();
            let mut generator = Generator::new();
            generator.start(train);
            let mut last = generator.square;
            let mut now = 0;
            while generator.is_busy() {
                now += generator.next_edge().unwrap();
                if generator.advance(now) == 0 || !generator.is_busy() {
                    continue;
                }
                let next = generator.square;
                assert!(train.up == 0 || next <= last + train.up, "{train:?}");
                assert!(train.down == 0 || last <= next + train.down, "{train:?}");
                last = next;
            }
            assert!(train.down == 0 || last <= train.lowest.max(square(train.speed)));
        }
    }

    #[test]
    fn changes_and_stops_keep_the_count() {
        let mut numbers = Numbers(3);
        for _ in 0..1000 {
            let train = numbers.train();
            let mut generator = Generator::new();
            generator.start(train);
            let mut now = numbers.below(50_000) as u32;
            let mut count = generator.advance(now);
            let total = 1 + numbers.below(8000) as u32;
            let begun = generator.is_busy();
            generator.set_total(total);
            generator.set_speed(1000 * (1 + numbers.below(100_000) as u32));
            let expected = if begun { total.max(count + 1) } else { count };
            if numbers.below(3) == 0 {
                now += numbers.below(50_000) as u32;
                count += generator.advance(now);
                generator.stop();
                count += send(&mut generator, &mut numbers, now);
                assert!(count <= expected);
                assert_eq!(generator.sent(), count);
            } else {
                count += send(&mut generator, &mut numbers, now);
                assert_eq!(count, expected, "{train:?}");
            }
        }
    }

    #[test]
    fn a_steady_train_does_not_drift() {
        let mut generator = Generator::new();
        generator.start(Train::steady(99_999_000, 0));
        let mut count: u32 = 0;
        let mut now = 0;
        for _ in 0..1000 {
            now += 1_000_003;
            count += generator.advance(now);
        }
        // 99,999 pulses a second for 1000.003 seconds.
        assert_eq!(count, 99_999_299);
        generator.start(Train::steady(100_000_000, i32::MAX as u32));
        let mut sent: u32 = 0;
        while generator.is_busy() {
            now = now.wrapping_add(1_000_000_000);
            sent += generator.advance(now);
        }
        assert_eq!(sent, i32::MAX as u32);
    }

    /// At 100 kHz, 2³¹ pulses take six hours; ramps of 100 ms add 100 ms to that.
    #[test]
    fn two_to_the_31st_pulses_do_not_drift() {
        let slope = Train::slope(100_000, 100);
        let mut generator = Generator::new();
        generator.start(Train {
            lowest: slope / 4,
            up: slope,
            down: slope,
            ..Train::steady(100_000_000, 1 << 31)
        });
        let (mut now_us, mut sent) = (0u64, 0u64);
        let whole_us = (1u64 << 31) * 10 + 100_000;
        while generator.is_busy() {
            now_us += if whole_us.saturating_sub(now_us) < 2_000_000 {
                10
            } else {
                1_000_000
            };
            sent += u64::from(generator.advance(now_us as u32));
            assert!(now_us < whole_us + 2_000, "{sent} pulses");
        }
        assert_eq!(sent, 1 << 31);
        // A ramp from rest is late by a part of its first pulse.
        assert!(
            (whole_us..whole_us + 2_000).contains(&now_us),
            "{now_us} of {whole_us}"
        );
    }

    #[test]
    fn a_pin_has_every_pulse_however_late_it_is_driven() {
        let mut numbers = Numbers(4);
        for _ in 0..200 {
            let train = Train {
                total: 1 + numbers.below(500) as u32,
                ..numbers.train()
            };
            let mut generator = Generator::new();
            generator.start(train);
            let mut now = numbers.below(1 << 32) as u32;
            let (mut on, mut rises, mut count) = (false, 0, 0);
            while generator.is_busy() {
                count += generator.step(now);
                rises += u32::from(generator.level() && !on);
                on = generator.level();
                let late = numbers.below(300) as u32;
                now = now.wrapping_add(generator.wait(now).unwrap_or(0) + late);
            }
            assert_eq!((rises, count), (train.total, train.total), "{train:?}");
        }
    }

    #[test]
    fn edges_come_when_they_are_due() {
        let mut generator = Generator::new();
        generator.start(Train::steady(1_000_000, 2));
        let mut edges = std::vec::Vec::new();
        let mut now = 0;
        while let Some(wait) = generator.next_edge() {
            edges.push((now, generator.level()));
            now += wait;
            generator.advance(now);
        }
        assert_eq!(
            edges,
            [(0, true), (500, false), (1000, true), (1500, false)]
        );
        assert_eq!(now, 2000);
        generator.modulate(1, 4, 1000);
        assert_eq!((generator.millihertz(), generator.level()), (250_000, true));
        assert_eq!(generator.next_edge(), Some(1000));
    }
}
