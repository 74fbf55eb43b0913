//! Timers and counters as logic: what [`rungc_rt::Timer`] and the counters do.

use super::{CounterPart, Encoder, Key, TimerPart};
use crate::aig::Lit;
use crate::bits::{Bits, constant, unsigned};
use crate::lag::{Expired, Lag};
use rungc_ir::node::{Action, Expr, Stmt};
use rungc_ir::reach::{Footprint, of_expr, of_stmt};
use rungc_ir::walk::statements;
use rungc_rt::TimerKind;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Number of bits in the units of a step: enough for the longest timer, and a unit more.
const UNITS: usize = 17;

/// Advance of a timer: whole units, and milliseconds beyond them.
pub struct Step {
    /// Whole units.
    pub units: Bits,
    /// Milliseconds beyond them.
    pub rest: Bits,
}

impl Encoder<'_> {
    /// The time since the scan before, in units of 1 ms, 10 ms or 100 ms as timers have them.
    pub fn elapsed_in(&self, unit_ms: u16) -> Step {
        let Some(time) = &self.time else {
            return Step {
                units: constant(0, 16),
                rest: Bits::new(),
            };
        };
        match unit_ms {
            ..=1 => Step {
                units: time.all.clone(),
                rest: Bits::new(),
            },
            2..=10 => Step {
                units: time.tens.clone(),
                rest: time.below_ten.clone(),
            },
            _ => Step {
                units: time.hundreds.clone(),
                rest: time.below_hundred.clone(),
            },
        }
    }

    /// As [`rungc_rt::Timer::run`].
    pub(super) fn timer(
        &mut self,
        number: u32,
        kind: TimerKind,
        drive: Lit,
        preset: &[Lit],
        guard: Lit,
    ) {
        let key = |part| Key::Timer(number, part);
        let idle = self.aig.and(guard, !drive);
        if !kind.accumulating {
            for part in [TimerPart::Value, TimerPart::Preset, TimerPart::Part] {
                let zero = constant(0, self.load(key(part)).len());
                self.store(key(part), &zero, idle);
            }
            self.store(key(TimerPart::Done), &[Lit::FALSE], idle);
        }
        self.store(key(TimerPart::Coil), &[Lit::FALSE], idle);
        self.store(key(TimerPart::Counted), &[Lit::FALSE], idle);
        let driven = self.aig.and(guard, drive);
        self.driven(number, kind, preset, driven);
    }

    /// Returns true if a timer may expire at any time.
    fn is_vague(&self, number: u32) -> bool {
        let exact = self.exact_timers.as_ref();
        exact.is_some_and(|exact| !exact.contains(&number))
    }

    /// A timer whose coil is on, and which may expire at any time but not at once.
    fn driven_vaguely(&mut self, number: u32, kind: TimerKind, preset: &[Lit], guard: Lit) {
        let key = |part| Key::Timer(number, part);
        let was_on = self.load(key(TimerPart::Coil))[0];
        let done = self.load(key(TimerPart::Done))[0];
        let expires = self.fresh(1, "when timers expire")[0];
        let runs = match crate::bits::known(preset) {
            Some(1..) if !kind.accumulating => was_on,
            _ => Lit::TRUE,
        };
        let expires = self.aig.and(expires, runs);
        let done = self.aig.or(done, expires);
        self.store(key(TimerPart::Coil), &[Lit::TRUE], guard);
        self.store(key(TimerPart::Done), &[done], guard);
    }

    /// Finds the timers whose values something looks at or writes.
    pub(super) fn find_timers(&mut self) {
        if !self.world.any_preset {
            return;
        }
        let (module, mut exact) = (self.module, BTreeSet::new());
        let mut note = |used: Footprint| {
            if used.place.class == DeviceClass::T {
                let runs = used.reach(module.model, &module.exprs).into_iter();
                exact.extend(runs.flat_map(|(first, last)| first..=last));
            }
        };
        for expr in &module.exprs {
            if expr.as_bit().is_none() {
                of_expr(module.model, expr, &mut note);
            }
        }
        for function in &module.functions {
            statements(&function.body, &mut |stmt| {
                let coil = matches!(
                    stmt,
                    Stmt::Do(
                        Action::Timer(_)
                            | Action::TimerGoesOn { .. }
                            | Action::TimerAt(_)
                            | Action::Reset { .. }
                    )
                );
                if !coil {
                    of_stmt(module.model, stmt, &mut note);
                }
            });
        }
        let observed = self.world.observed.iter().copied();
        exact.extend(
            observed
                .filter(|(class, _)| *class == DeviceClass::T)
                .map(|(_, n)| n),
        );
        self.exact_timers = Some(exact);
    }

    /// Relations between clocks and timers of the same unit that may hold: a clock begins with the coil of a timer, or
    /// a scan before.
    pub(super) fn lags(&self) -> Vec<Lag> {
        let timers = self.state.keys().filter_map(|key| match *key {
            Key::Timer(timer, TimerPart::Value) => {
                Some((timer, self.module.model.timer(timer)?.unit_ms))
            }
            _ => None,
        });
        let pairs = timers.flat_map(|timer| self.clocks.iter().map(move |clock| (timer, clock)));
        let alike = pairs.filter(|((_, timer_unit_ms), (_, unit_ms))| timer_unit_ms == unit_ms);
        let scan_ms = self.world.scan_ms;
        let lags = alike.flat_map(|((timer, unit_ms), &(clock, _))| {
            let expired = self.preset(timer).map(|preset| Expired { preset, scan_ms });
            let expirations = [Some(None), expired.map(Some)].into_iter().flatten();
            expirations.flat_map(move |expired| {
                [0, scan_ms].map(|most_ms| Lag {
                    clock,
                    timer,
                    unit_ms,
                    most_ms,
                    expired,
                })
            })
        });
        lags.collect()
    }

    /// The preset of a timer, if all its coils have the same constant.
    fn preset(&self, timer: u32) -> Option<i16> {
        let mut presets = BTreeSet::new();
        for function in &self.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Timer(coil)) = stmt
                    && coil.number == timer
                {
                    presets.insert(match self.module.expr(coil.preset) {
                        Expr::I16(preset) => Some(*preset),
                        _ => None,
                    });
                }
            });
        }
        match presets.len() {
            1 => presets.pop_first()?,
            _ => None,
        }
    }

    /// A timer whose coil is on.
    fn driven(&mut self, number: u32, kind: TimerKind, preset: &[Lit], guard: Lit) {
        if self.is_vague(number) {
            return self.driven_vaguely(number, kind, preset, guard);
        }
        let key = |part| Key::Timer(number, part);
        let was_on = self.load(key(TimerPart::Coil))[0];
        let done = self.load(key(TimerPart::Done))[0];
        let value = self.load(key(TimerPart::Value));
        let once_a_scan = kind.shared || kind.free_running;
        let mut moves = was_on;
        if once_a_scan {
            let counted = self.load(key(TimerPart::Counted))[0];
            moves = self.aig.and(moves, !counted);
        }
        let mut preset = preset.to_vec();
        if kind.latches_preset {
            let taken = self.load(key(TimerPart::Preset));
            preset = self.aig.select(was_on, &taken, &preset);
        }
        if kind.latches_preset || kind.free_running {
            self.store(key(TimerPart::Preset), &preset, guard);
        }
        self.store(key(TimerPart::Coil), &[Lit::TRUE], guard);
        if once_a_scan {
            self.store(key(TimerPart::Counted), &[Lit::TRUE], guard);
        }
        let (units, part) = self.advanced(number, kind, moves);
        let runs = match kind.overruns {
            true => guard,
            false => self.aig.and(guard, !done),
        };
        let limit = match kind.overruns {
            true => constant(i16::MAX.into(), 18),
            false => crate::bits::signed(&preset, 18),
        };
        let wide = crate::bits::signed(&value, 18);
        let room = self.aig.sub(&limit, &wide);
        let open = self.aig.less(&constant(0, 18), &room);
        let sum = self.aig.least(&unsigned(&units, 18), &room);
        let sum = self.aig.add(&wide, &sum);
        let new = self.aig.select(open, &sum[..16], &value);
        self.store(key(TimerPart::Value), &new, runs);
        self.store(key(TimerPart::Part), &part, runs);
        let reached = !self.aig.less(&new, &preset);
        let closed = self.aig.or(done, reached);
        let expires = self.aig.and(runs, closed);
        self.note_timer(number, guard, expires);
        self.store(key(TimerPart::Done), &[closed], runs);
    }

    /// By how many units a timer moves on, and the milliseconds since the last whole one then.
    fn advanced(&mut self, number: u32, kind: TimerKind, moves: Lit) -> (Bits, Bits) {
        let mut step = self.elapsed_in(kind.unit_ms);
        if kind.stepwise {
            let whole = self.aig.nonzero(&step.units);
            step.units = vec![whole];
            step.rest = step
                .rest
                .iter()
                .map(|&bit| self.aig.and(bit, !whole))
                .collect();
        }
        let units = self.capped(&step.units);
        let mut moved =
            |bits: &[Lit]| -> Bits { bits.iter().map(|&bit| self.aig.and(bit, moves)).collect() };
        let (units, rest) = (moved(&units), moved(&step.rest));
        let part = self.load(Key::Timer(number, TimerPart::Part));
        if part.is_empty() {
            return (units, part);
        }
        let width = part.len() + 1;
        let unit = constant(kind.unit_ms.into(), width);
        let sum = self
            .aig
            .add(&unsigned(&part, width), &unsigned(&rest, width));
        let carry = !self.aig.below(&sum, &unit);
        let less = self.aig.sub(&sum, &unit);
        let part = self.aig.select(carry, &less, &sum);
        let units = self.aig.add(&units, &unsigned(&[carry], UNITS));
        (units, part[..width - 1].to_vec())
    }

    /// A number of units, or, if there are more, as many as the longest timer has.
    fn capped(&mut self, units: &[Lit]) -> Bits {
        let (low, high) = units.split_at(units.len().min(UNITS - 2));
        let over = self.aig.nonzero(high);
        let low: Bits = low.iter().map(|&bit| self.aig.or(bit, over)).collect();
        unsigned(&low, UNITS)
    }

    /// As [`rungc_rt::Timer::go_on`].
    pub(super) fn timer_goes_on(&mut self, number: u32, kind: TimerKind, guard: Lit) {
        let on = self.load(Key::Timer(number, TimerPart::Coil))[0];
        let preset = self.load(Key::Timer(number, TimerPart::Preset));
        let goes_on = self.aig.and(guard, on);
        let done = self.load(Key::Timer(number, TimerPart::Done));
        self.driven(number, kind, &preset, goes_on);
        if kind.accumulating {
            self.store(Key::Timer(number, TimerPart::Done), &done, goes_on);
        }
    }

    /// RST of a timer or counter.
    pub(super) fn reset_timing(&mut self, keys: &[Key], guard: Lit) {
        for &key in keys {
            let kept = matches!(
                key,
                Key::Timer(_, TimerPart::Preset | TimerPart::Coil | TimerPart::Counted)
                    | Key::Counter(_, CounterPart::Coil)
            );
            if !kept {
                let zero = constant(0, self.load(key).len());
                self.store(key, &zero, guard);
            }
        }
    }

    /// As [`rungc_rt::Counter16::run`].
    pub(super) fn counter16(&mut self, number: u32, drive: Lit, preset: &[Lit], guard: Lit) {
        let key = |part| Key::Counter(number, part);
        let coil = self.load(key(CounterPart::Coil))[0];
        let done = self.load(key(CounterPart::Done))[0];
        let value = self.load(key(CounterPart::Value));
        let counts = self.aig.all([guard, drive, !coil, !done]);
        let one = constant(1, 16);
        let low = self.aig.less(preset, &one);
        let preset = self.aig.select(low, &one, preset);
        let most = self.aig.is(&value, i16::MAX.into());
        let next = self.aig.add(&value, &one);
        let next = self.aig.select(most, &value, &next);
        let next = self.aig.least(&next, &preset);
        let reached = !self.aig.less(&next, &preset);
        self.store(key(CounterPart::Value), &next, counts);
        self.store(key(CounterPart::Done), &[reached], counts);
        self.store(key(CounterPart::Coil), &[drive], guard);
    }

    /// As [`rungc_rt::Counter32::run`].
    pub(super) fn counter32(
        &mut self,
        number: u32,
        drive: Lit,
        (down, preset): (Lit, &[Lit]),
        guard: Lit,
    ) {
        let coil = self.load(Key::Counter(number, CounterPart::Coil))[0];
        let counts = self.aig.all([guard, drive, !coil]);
        self.count(number, down, preset, counts);
        self.store(Key::Counter(number, CounterPart::Coil), &[drive], guard);
    }

    /// As [`rungc_rt::Counter32::count`].
    pub(super) fn count(&mut self, number: u32, down: Lit, preset: &[Lit], guard: Lit) {
        let key = |part| Key::Counter(number, part);
        let done = self.load(key(CounterPart::Done))[0];
        let value = self.load(key(CounterPart::Value));
        let by = self.aig.select(down, &constant(-1, 32), &constant(1, 32));
        let next = self.aig.add(&value, &by);
        let reached = self.aig.equal(&next, preset);
        let left = self.aig.equal(&value, preset);
        let closes = self.aig.and(!down, reached);
        let opens = self.aig.and(down, left);
        let contact = self.aig.or(done, closes);
        let contact = self.aig.and(contact, !opens);
        self.store(key(CounterPart::Value), &next, guard);
        self.store(key(CounterPart::Done), &[contact], guard);
    }
}
