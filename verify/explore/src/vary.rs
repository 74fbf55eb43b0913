//! Continuation of a run: inputs that change, and the time for which they stay.

use crate::cover::constant;
use crate::run::{POWER, Runner};
use crate::task::{Step, Task};
use crate::trains::Trains;
use crate::wide::{LANES, Stride};
use fastrand::Rng;
use rungc_ir::node::{AccessKind, Action, Expr, ExprId, Stmt};
use rungc_ir::walk::statements;
use rungc_rt::{Class, Plc};
use rungc_syntax::DeviceClass;

/// Maximum number of scans of a step.
const LONGEST: u32 = 2_000;

/// One step in this many begins with power off and on.
const POWER_STAYS: u32 = 24;

/// A timer of the program.
struct Timer {
    number: u32,
    unit_ms: u32,
    preset: Preset,
}

/// End of a timer.
enum Preset {
    Constant(i32),
    Register(DeviceClass, u32),
}

/// Choice of the next step of a search.
pub struct Choices<'t> {
    task: &'t Task<'t>,
    timers: Vec<Timer>,
    trains: Trains<'t>,
}

impl<'t> Choices<'t> {
    /// Of a search.
    pub fn new(task: &'t Task<'t>) -> Self {
        let mut timers = Vec::new();
        for function in &task.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Timer(coil)) = stmt
                    && let Some(preset) = preset(task, coil.preset)
                {
                    timers.push(Timer {
                        number: coil.number,
                        unit_ms: coil.kind.unit_ms.into(),
                        preset,
                    });
                }
            });
        }
        let trains = Trains::new(task);
        Choices {
            task,
            timers,
            trains,
        }
    }

    /// The steps of a sweep, all lanes from the moment of this runner on, at most about this many scans together.
    pub fn sweep(&self, runner: &Runner, rng: &mut Rng, most_scans: u32) -> Vec<Stride> {
        let mut inputs = vec![runner.inputs().to_vec(); LANES];
        let mut strides = Vec::new();
        let count = 1 + rng.u32(..8) + rng.u32(..8);
        let mut scans = 0;
        while strides.len() < count as usize && scans < most_scans {
            let set = inputs.iter_mut().map(|now| {
                let set = self.changes(now, rng);
                set.iter().for_each(|&(input, value)| now[input] = value);
                set
            });
            let set = set.collect();
            let time = self.time(runner, rng, 4 * most_scans);
            scans += time.0;
            strides.push(Stride { set, time });
        }
        strides
    }

    /// A step, at most this many scans long.
    pub fn step(&self, runner: &Runner, rng: &mut Rng, most_scans: u32) -> Step {
        let mut set = self.changes(runner.inputs(), rng);
        if self.task.power_cycles && rng.u32(..POWER_STAYS) == 0 {
            set.push((POWER, runner.power_cycles() + 1));
        }
        let (scans, mut scan_ms) = self.time(runner, rng, most_scans);
        let most_ms = self.task.scan_ms;
        let pulses = self
            .trains
            .next(runner.machine(), rng, (&mut scan_ms, most_ms));
        Step {
            set,
            pulses,
            scans,
            scan_ms,
        }
    }

    /// Number of scans of a step, at most this many, and their duration.
    fn time(&self, runner: &Runner, rng: &mut Rng, most_scans: u32) -> (u32, u32) {
        let (scans, scan_ms) = match rng.u32(..100) {
            0..=24 => self.to_a_timer(runner, rng),
            25..=29 => (rng.u32(8..=40), self.scan_ms(rng)),
            30..=54 => (rng.u32(2..=4), self.scan_ms(rng)),
            _ => (1, self.scan_ms(rng)),
        };
        (scans.clamp(1, most_scans.clamp(1, LONGEST)), scan_ms)
    }

    /// Changes of inputs.
    fn changes(&self, now: &[i32], rng: &mut Rng) -> Vec<(usize, i32)> {
        let inputs = self.task.inputs.len();
        if inputs == 0 {
            return Vec::new();
        }
        let count = match rng.u32(..100) {
            0..=9 => 0,
            10..=69 => 1,
            70..=89 => 2,
            90..=95 => 3,
            _ => rng.usize(1..=inputs),
        };
        let mut set: Vec<(usize, i32)> = Vec::new();
        for _ in 0..count {
            let input = rng.usize(..inputs);
            if set.iter().any(|(other, _)| *other == input) {
                continue;
            }
            let before = now[input];
            set.push((input, self.value(input, before, rng)));
        }
        set.sort_unstable();
        set
    }

    /// New value of an input.
    fn value(&self, input: usize, before: i32, rng: &mut Rng) -> i32 {
        let input = &self.task.inputs[input];
        if input.is_bit() {
            return i32::from(before == 0);
        }
        let value = match rng.u32(..10) {
            0 => before.wrapping_add(1),
            1 => before.wrapping_sub(1),
            2 => i32::from(rng.i16(..)),
            3 => rng.i32(0..1_000),
            _ => rng.choice(&input.values).copied().unwrap_or(0),
        };
        value as i16 as i32
    }

    /// Duration of scans.
    fn scan_ms(&self, rng: &mut Rng) -> u32 {
        /// Usual duration, in milliseconds.
        const USUAL_MS: u32 = 10;
        let most = self.task.scan_ms;
        match rng.u32(..10) {
            0..=6 => USUAL_MS.min(most),
            7..=8 => most,
            _ => rng.u32(1..=most),
        }
    }

    /// About as long as a timer still takes: just before its end, at it, or just after it.
    fn to_a_timer(&self, runner: &Runner, rng: &mut Rng) -> (u32, u32) {
        let machine = runner.machine();
        let remaining = |timer: &Timer| {
            let value = machine.word(Class::T, timer.number)?;
            let preset = match timer.preset {
                Preset::Constant(preset) => preset,
                Preset::Register(class, n) => {
                    machine.word(rungc_interp::rt_class(class)?, n)?.into()
                }
            };
            let left = preset - i32::from(value);
            let begun = value > 0 && machine.bit(Class::T, timer.number) == Some(false);
            (left > 0).then_some((begun, left as u32 * timer.unit_ms))
        };
        let all: Vec<(bool, u32)> = self.timers.iter().filter_map(remaining).collect();
        let running: Vec<u32> = all.iter().filter(|(b, _)| *b).map(|(_, ms)| *ms).collect();
        let chosen = match running.is_empty() || rng.u32(..4) == 0 {
            true => rng.choice(&all).map(|(_, ms)| *ms),
            false => rng.choice(&running).copied(),
        };
        let Some(ms) = chosen else {
            return (1, self.scan_ms(rng));
        };
        // Few scans, none longer than allowed, and none so short that the wait takes too many.
        let most = self.task.scan_ms;
        let scan_ms = match rng.u32(..3) {
            0 => self.scan_ms(rng).max(ms.div_ceil(LONGEST / 4)).min(most),
            _ => most,
        };
        let scans = ms.div_ceil(scan_ms) + rng.u32(0..=2);
        (scans.saturating_sub(1), scan_ms)
    }
}

/// Preset of a timer, if it is known before it runs.
fn preset(task: &Task, id: ExprId) -> Option<Preset> {
    if let Some(preset) = constant(task.module, id) {
        return Some(Preset::Constant(preset));
    }
    match *task.module.expr(id) {
        Expr::Read(access) if access.kind == AccessKind::Word && access.place.index.is_none() => {
            Some(Preset::Register(access.place.class, access.place.number))
        }
        _ => None,
    }
}
