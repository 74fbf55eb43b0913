//! Timers and counters: what OUT T and OUT C do.

/// How a timer behaves.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct TimerKind {
    /// Length of its unit in milliseconds: 1, 10 or 100.
    pub unit_ms: u16,
    /// Keeps its value while not driven; only RST clears it.
    pub accumulating: bool,
    /// Goes on timing in scans that jump over its coil (T192–T199).
    pub free_running: bool,
    /// Takes the preset over when timing starts instead of reading it all the time (H1U/H2U).
    pub latches_preset: bool,
    /// Goes on counting up to 32767 after the preset is reached (HM).
    pub overruns: bool,
    /// Advances by at most one unit a scan, so scans longer than its unit make it slow (10 ms timers of L01S).
    pub stepwise: bool,
}

/// A timer, zero at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Timer {
    /// Time since the last whole unit, in milliseconds.
    pub part_ms: u32,
    /// When it was last executed or went on, for a free-running timer.
    pub last_ms: u32,
    /// Current value in units.
    pub value: i16,
    /// Preset taken over at the start of timing, or else the last one.
    pub preset: i16,
    /// Whether its coil was on at the last execution.
    pub coil: bool,
    /// Its contact.
    pub done: bool,
}

impl Timer {
    /// As at power-on.
    pub const fn new() -> Self {
        Timer {
            part_ms: 0,
            last_ms: 0,
            value: 0,
            preset: 0,
            coil: false,
            done: false,
        }
    }

    /// RST: value 0, contact off. The memory of the coil stays as it is.
    pub fn reset(&mut self) {
        *self = Timer {
            last_ms: self.last_ms,
            preset: self.preset,
            coil: self.coil,
            ..Self::new()
        };
    }

    /// Executes the coil; returns the contact.
    ///
    /// In the scan in which the coil comes on the value is left as it is; in each later scan the time since the previous scan is
    /// added, so that a timer first driven at time t reaches K units in the first scan at t + K units or later.
    pub fn run(
        &mut self,
        kind: TimerKind,
        drive: bool,
        preset: i16,
        now_ms: u32,
        dt_ms: u32,
    ) -> bool {
        if !drive {
            if !kind.accumulating {
                *self = Timer::default();
            }
            self.coil = false;
            return self.done;
        }
        let elapsed = if !self.coil {
            0
        } else if kind.free_running {
            now_ms.wrapping_sub(self.last_ms)
        } else {
            dt_ms
        };
        let unit = u32::from(kind.unit_ms.max(1));
        let elapsed = if kind.stepwise {
            elapsed.min(unit)
        } else {
            elapsed
        };
        if !self.coil || !kind.latches_preset {
            self.preset = preset;
        }
        self.coil = true;
        self.last_ms = now_ms;
        let preset = if kind.latches_preset {
            self.preset
        } else {
            preset
        };
        if !self.done || kind.overruns {
            let limit = if kind.overruns {
                i16::MAX
            } else {
                preset.max(0)
            };
            self.part_ms = self.part_ms.saturating_add(elapsed);
            let value = i64::from(self.value) + i64::from(self.part_ms / unit);
            self.part_ms %= unit;
            self.value = value.min(i64::from(limit.max(self.value))) as i16;
            self.done |= self.value >= preset;
        }
        self.done
    }

    /// What END does for a free-running timer: with its coil on, it goes on timing in a scan that did not execute it.
    pub fn go_on(&mut self, kind: TimerKind, now_ms: u32) {
        if self.coil {
            self.run(kind, true, self.preset, now_ms, 0);
        }
    }
}

/// A 16-bit up counter, zero at power-on.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
#[repr(C)]
pub struct Counter16 {
    /// Current value.
    pub value: i16,
    /// Whether its coil was on at the last execution.
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

    /// Executes the coil: counts an off-to-on change; returns the contact. A preset of 0 acts as 1; a value written at or above
    /// the preset closes the contact at the next count and becomes the preset.
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
    /// Whether its coil was on at the last execution.
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

    /// Executes the coil: counts an off-to-on change in the direction of its special relay, wrapping; returns the contact, which
    /// closes when the value reaches the preset upwards and opens when it leaves it downwards.
    pub fn run(&mut self, drive: bool, down: bool, preset: i32) -> bool {
        if drive && !self.coil {
            self.count(down, preset);
        }
        self.coil = drive;
        self.done
    }

    /// Counts once, up or down, wrapping. The contact closes when the value reaches the preset upwards and opens when it leaves it
    /// downwards.
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
