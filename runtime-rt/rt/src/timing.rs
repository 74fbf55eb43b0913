//! Timers and counters: what OUT T and OUT C do.

use crate::plc::Sys;

/// Type of a timer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct TimerKind {
    /// Length of its unit in milliseconds: 1, 10 or 100, and not above 256.
    pub unit_ms: u16,
    /// Keeps its value while not driven; only RST clears it.
    pub accumulating: bool,
    /// Continues timing in scans that jump over its coil (T192–T199, T246–T249).
    pub free_running: bool,
    /// Takes the preset over when timing starts instead of reading it all the time (H1U/H2U).
    pub latches_preset: bool,
    /// Continues counting up to 32767 after the preset is reached (HM).
    pub overruns: bool,
    /// Advances by at most one unit a scan, so scans longer than its unit make it slow (10 ms timers of L01S).
    pub stepwise: bool,
    /// Its coil may be executed more than once in a scan (in a loop, in a routine, in several places), which counts the
    /// time of the scan only once.
    pub shared: bool,
}

/// A timer, zero at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Timer {
    /// Current value in units.
    pub value: i16,
    /// Preset taken over at the start of timing or, for a free-running timer, the last one.
    pub preset: i16,
    /// 0 if its coil was off at the last execution; else the scan ([`Sys::scan`]) in which it was executed or
    /// continued, for a shared or free-running timer, and 1 for others.
    pub coil: u16,
    /// Time since the last whole unit, in milliseconds.
    pub part_ms: u8,
    /// Its contact.
    pub done: bool,
}

impl Timer {
    /// As at power-on.
    pub const fn new() -> Self {
        Timer {
            value: 0,
            preset: 0,
            coil: 0,
            part_ms: 0,
            done: false,
        }
    }

    /// RST: value 0, contact off. The memory of the coil stays as it is.
    pub fn reset(&mut self) {
        *self = Timer {
            preset: self.preset,
            coil: self.coil,
            ..Self::new()
        };
    }

    /// Executes the coil; returns the contact.
    ///
    /// In the scan in which the coil comes on the value is left as it is; in each later scan the time since the
    /// previous scan is added, so that a timer first driven at time t reaches K units in the first scan at t + K units
    /// or later. A timer counts the pulses of a clock (h1u-h2u-programming §3.5), so a coil that is executed again in
    /// the same scan adds nothing: that is what [`TimerKind::shared`] is for.
    #[inline]
    pub fn run(&mut self, kind: TimerKind, drive: bool, preset: i16, sys: &Sys) -> bool {
        if !drive {
            if !kind.accumulating {
                *self = Timer::new();
            }
            self.coil = 0;
            return self.done;
        }
        let unit = u32::from(kind.unit_ms.max(1));
        let once_a_scan = kind.shared || kind.free_running;
        let was_on = self.coil != 0;
        let mut elapsed = 0;
        if was_on && !(once_a_scan && self.coil == sys.scan) {
            elapsed = sys.dt_ms;
        }
        if kind.stepwise {
            elapsed = elapsed.min(unit);
        }
        let preset = if kind.latches_preset && was_on {
            self.preset
        } else {
            preset
        };
        if kind.latches_preset || kind.free_running {
            self.preset = preset;
        }
        self.coil = if once_a_scan { sys.scan } else { 1 };
        if !self.done || kind.overruns {
            let mut part = elapsed.wrapping_add(u32::from(self.part_ms));
            if part >= unit {
                let limit = if kind.overruns { i16::MAX } else { preset };
                let room = i32::from(limit) - i32::from(self.value);
                if room > 0 {
                    let units = (part / unit).min(room as u32);
                    self.value = self.value.wrapping_add(units as i16);
                }
                part %= unit;
            }
            self.part_ms = part as u8;
            self.done |= self.value >= preset;
        }
        self.done
    }

    /// Updates a free-running timer at END: with its coil on, it continues timing in a scan that did not execute it.
    /// The contact of an accumulating one closes when its coil is executed next (FX0–FX2N programming manual 4.9.4).
    pub fn go_on(&mut self, kind: TimerKind, sys: &Sys) {
        if self.coil != 0 {
            let done = self.done;
            self.run(kind, true, self.preset, sys);
            self.done &= done || !kind.accumulating;
        }
    }
}

/// A 16-bit up counter, zero at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Counter16 {
    /// Current value.
    pub value: i16,
    /// True if its coil was on at the last execution.
    pub coil: bool,
    /// Its contact.
    pub done: bool,
}

impl Counter16 {
    /// As at power-on.
    pub const fn new() -> Self {
        Counter16 {
            value: 0,
            coil: false,
            done: false,
        }
    }

    /// RST: value 0, contact off. The memory of the coil stays as it is.
    pub fn reset(&mut self) {
        *self = Counter16 {
            coil: self.coil,
            ..Self::new()
        };
    }

    /// RST that holds the counter at 0 until the next execution of its coil is over: that one does not count.
    pub fn hold(&mut self) {
        self.reset();
        self.coil = true;
    }

    /// Executes the coil: counts an off-to-on change; returns the contact. A preset of 0 acts as 1; a value written at
    /// or above the preset closes the contact at the next count and becomes the preset.
    pub fn run(&mut self, drive: bool, preset: i16) -> bool {
        if drive && !self.coil && !self.done {
            let preset = preset.max(1);
            self.value = self.value.saturating_add(1).min(preset);
            self.done = self.value >= preset;
        }
        self.coil = drive;
        self.done
    }
}

/// A 32-bit up/down counter, zero at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Counter32 {
    /// Current value.
    pub value: i32,
    /// True if its coil was on at the last execution.
    pub coil: bool,
    /// Its contact.
    pub done: bool,
}

impl Counter32 {
    /// As at power-on.
    pub const fn new() -> Self {
        Counter32 {
            value: 0,
            coil: false,
            done: false,
        }
    }

    /// RST: value 0, contact off. The memory of the coil stays as it is.
    pub fn reset(&mut self) {
        *self = Counter32 {
            coil: self.coil,
            ..Self::new()
        };
    }

    /// RST that holds the counter at 0 until the next execution of its coil is over: that one does not count.
    pub fn hold(&mut self) {
        self.reset();
        self.coil = true;
    }

    /// Executes the coil: counts an off-to-on change in the direction of its special relay, wrapping; returns the
    /// contact, which closes when the value reaches the preset upwards and opens when it leaves it downwards.
    pub fn run(&mut self, drive: bool, down: bool, preset: i32) -> bool {
        if drive && !self.coil {
            self.count(down, preset);
        }
        self.coil = drive;
        self.done
    }

    /// Counts once, up or down, wrapping. The contact closes when the value reaches the preset upwards and opens when
    /// it leaves it downwards.
    pub fn count(&mut self, down: bool, preset: i32) {
        let before = self.value;
        self.value = before.wrapping_add(if down { -1 } else { 1 });
        if !down && self.value == preset {
            self.done = true;
        } else if down && before == preset {
            self.done = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Timer, TimerKind};
    use crate::plc::Sys;

    const KIND: TimerKind = TimerKind {
        unit_ms: 10,
        accumulating: false,
        free_running: false,
        latches_preset: false,
        overruns: false,
        stepwise: false,
        shared: true,
    };

    /// Runs a coil so often in each of some scans of 10 ms; the value then.
    fn value(kind: TimerKind, scans: u32, times: u32) -> i16 {
        let (mut timer, mut sys) = (Timer::new(), Sys::power_on());
        for scan in 0..scans {
            sys.begin_scan(10 * scan, 0);
            for _ in 0..times {
                timer.run(kind, true, i16::MAX, &sys);
            }
            sys.end_scan();
        }
        timer.value
    }

    #[test]
    fn a_shared_timer_counts_time_not_executions() {
        assert_eq!([1, 2, 7].map(|times| value(KIND, 20, times)), [19; 3]);
        let alone = TimerKind {
            shared: false,
            ..KIND
        };
        assert_eq!(value(alone, 20, 1), 19);
    }

    #[test]
    fn no_scan_is_taken_for_an_earlier_one() {
        // More scans than numbers of scans.
        assert_eq!(value(KIND, 40_000, 2), i16::MAX);
        let (mut timer, mut sys) = (Timer::new(), Sys::power_on());
        for scan in 0..=u32::from(u16::MAX) {
            sys.begin_scan(10 * scan, 0);
            assert_ne!(sys.scan, 0, "0 is a coil that is off");
            sys.end_scan();
        }
        timer.run(KIND, true, 5, &sys);
        assert!(timer.coil != 0);
        timer.run(KIND, false, 5, &sys);
        assert_eq!(timer, Timer::new());
    }

    #[test]
    fn a_free_running_timer_goes_on_once_in_a_scan() {
        let kind = TimerKind {
            free_running: true,
            shared: false,
            ..KIND
        };
        let (mut timer, mut sys) = (Timer::new(), Sys::power_on());
        for scan in 0..10 {
            sys.begin_scan(10 * scan, 0);
            // Its coil is executed in every other scan only.
            if scan % 2 == 0 {
                timer.run(kind, true, 100, &sys);
            }
            timer.go_on(kind, &sys);
            sys.end_scan();
        }
        assert_eq!(timer.value, 9);
    }
}
