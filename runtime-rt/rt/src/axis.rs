//! Pulse outputs: what each is doing.

use crate::axis_place as place;
use crate::hal::Hal;
use crate::plc::{Class, Plc, Sys};
use crate::pulse::Generator;
use crate::special::{Register, Relay};
use crate::wiring::Wiring;
use crate::word::{pair, words};

/// A pulse output in a program's memory. All zero is one that is idle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Axis {
    /// Generator of its pulses.
    pub generator: Generator,
    /// Pulses sent on the output of this number since power-on; those sent in reverse count down.
    pub sent: i32,
    /// The output on which it sends; another one than its own if it is an axis that is bound to that.
    pub output: u16,
    /// The pair of registers D in which the pulses of this train are counted; 0: none.
    pub counter: u16,
    /// Private memory of the instruction that sends; 0: none.
    pub owner: u16,
    /// A train was sent to its end, and no instruction has queried it yet.
    pub ended: bool,
    /// A train was sent to its end, and pulses have not been counted since.
    pub completed: bool,
    /// The program has taken over what an interrupt sent on it, and not given it back yet.
    pub taken: bool,
    /// True if the pin is on.
    pub on: bool,
    /// True if the pin is inverted: on where a pulse is off.
    pub inverted: bool,
    /// Pulses that have ended, but are not counted in registers yet.
    pub uncounted: i32,
    /// A timer drives the pin, whose time is another than that of scans.
    pub timed: bool,
}

impl Axis {
    /// An idle output.
    pub const fn new() -> Self {
        Axis {
            generator: Generator::new(),
            sent: 0,
            output: 0,
            counter: 0,
            owner: 0,
            ended: false,
            completed: false,
            taken: false,
            on: false,
            inverted: false,
            uncounted: 0,
            timed: false,
        }
    }

    /// Returns true once after a train has been sent to its end.
    pub fn take_end(&mut self) -> bool {
        core::mem::take(&mut self.ended)
    }

    /// Lets time pass, for the pin if there is one to be driven. This is all that an interrupt does.
    fn pass(&mut self, now_us: u32, pin: bool) {
        let was_busy = self.generator.is_busy();
        let count = if pin {
            self.generator.step(now_us)
        } else {
            self.generator.advance(now_us)
        };
        let count = count as i32;
        self.completed |= was_busy && self.generator.is_complete();
        let count = if self.generator.is_reverse() {
            count.wrapping_neg()
        } else {
            count
        };
        self.uncounted = self.uncounted.wrapping_add(count);
        self.show();
    }

    /// A timer drives the pin; returns in how many microseconds it changes next.
    pub(crate) fn drive(&mut self, now_us: u32) -> Option<u32> {
        if !core::mem::replace(&mut self.timed, true) {
            self.generator.set_time(now_us);
        }
        self.pass(now_us, true);
        self.generator.wait(now_us)
    }

    /// The program's output takes over what an interrupt has sent.
    pub(crate) fn take_over(&mut self, sent: &mut Axis) {
        let count = core::mem::take(&mut sent.uncounted);
        self.uncounted = self.uncounted.wrapping_add(count);
        self.completed |= core::mem::take(&mut sent.completed);
        self.generator = sent.generator;
        self.on = sent.on;
        self.timed = sent.timed;
        sent.taken = true;
    }

    /// A copy for an interrupt to send, none of which has been sent yet.
    pub(crate) fn unsent(&self) -> Axis {
        Axis {
            uncounted: 0,
            completed: false,
            ..*self
        }
    }

    /// The pin is as the signal says.
    pub(crate) fn show(&mut self) {
        let sends = self.generator.is_busy();
        self.on = sends && self.generator.level() != self.inverted;
    }

    /// Its pulses end at once, and no instruction sends any more.
    pub(crate) fn halt(&mut self) {
        self.generator.halt();
        self.owner = 0;
        self.show();
    }
}

/// Value of a pair of registers D.
pub(crate) fn long(plc: &dyn Plc, low: Register) -> i32 {
    let word = |register: Register| register.value(plc) as i16;
    pair(word(low), word(low.after(1)))
}

/// Sets a pair of registers D, as far as the program looks at them.
pub(crate) fn set_long(plc: &mut dyn Plc, low: Register, value: i32) {
    for (register, word) in low.run::<2>().into_iter().zip(words(value)) {
        register.set(plc, word as u16);
    }
}

/// Returns true if one of these relays is on.
pub(crate) fn any_is_on(plc: &dyn Plc, relays: &[Option<Relay>]) -> bool {
    let mut relays = relays.iter().flatten();
    relays.any(|relay| relay.is_on(plc))
}

/// Sets these relays, as far as the program looks at them.
pub(crate) fn set_relays(plc: &mut dyn Plc, relays: &[Option<Relay>], on: bool) {
    for relay in relays.iter().flatten() {
        relay.set(plc, on);
    }
}

/// Counts the pulses that have ended by `now_us`, in microseconds since power-on, wrapping, on all outputs. Pulses end
/// when the PLC goes to STOP, and while a stop relay is on.
pub fn advance(plc: &mut dyn Plc, now_us: u32) {
    let Sys {
        running,
        first_scan,
        ..
    } = *plc.sys();
    for (output, wiring) in (0..).zip(plc.pulses().outputs()) {
        let stops = !running || first_scan || any_is_on(plc, &wiring.stop);
        let inverts = any_is_on(plc, &[wiring.inverts]);
        let Some(axis) = plc.axis(output) else {
            continue;
        };
        axis.inverted = inverts && axis.generator.modulates();
        if !axis.timed {
            axis.pass(now_us, false);
        }
        axis.ended |= core::mem::take(&mut axis.completed);
        if stops && !(axis.generator.modulates() && running) {
            axis.halt();
        }
        let busy = axis.generator.millihertz() > 0;
        set_relays(plc, &wiring.busy, busy);
        count(plc, output, wiring);
    }
}

/// Lets pulses pass as [`advance`] does, from `from_us` to `until_us` (microseconds since power-on, wrapping), but only
/// until an output has sent `most`; returns the time that is reached. A simulated machine with a switch that many
/// pulses away so changes an input at the very pulse.
pub fn pass(plc: &mut dyn Plc, from_us: u32, until_us: u32, most: u32) -> u32 {
    let (mut short, mut long) = (0, until_us.wrapping_sub(from_us));
    if most_sent(plc, until_us) >= most {
        while long - short > 1 {
            let middle = short + (long - short) / 2;
            match most_sent(plc, from_us.wrapping_add(middle)) >= most {
                true => long = middle,
                false => short = middle,
            }
        }
    }
    let reached = from_us.wrapping_add(long);
    advance(plc, reached);
    reached
}

/// The largest number of pulses that any of the outputs sends by `now_us`.
fn most_sent(plc: &mut dyn Plc, now_us: u32) -> u32 {
    let outputs = plc.pulses().outputs().len() as u32;
    let mut most = 0;
    for output in 0..outputs {
        // Several axes may be bound to an output.
        let sent = (0..outputs).filter_map(|n| {
            let axis = plc.axis(n)?;
            (u32::from(axis.output) == output).then(|| axis.generator.count_by(now_us))
        });
        most = sent.fold(0, u32::saturating_add).max(most);
    }
    most
}

/// Counts the pulses that have ended and are not counted yet.
pub(crate) fn count(plc: &mut dyn Plc, output: u32, wiring: &Wiring) {
    let Some(axis) = plc.axis(output) else {
        return;
    };
    let count = core::mem::take(&mut axis.uncounted);
    if wiring.axis.is_none() {
        axis.output = output as u16;
    }
    let (target, counter) = (axis.output.into(), axis.counter);
    if let Some(target) = plc.axis(target).filter(|_| count != 0) {
        target.sent = target.sent.wrapping_add(count);
    }
    if let Some(first) = wiring.axis {
        count_axis(plc, first, target, count);
    } else if counter != 0 {
        add(plc, Register(counter), count);
        if let Some(sum) = wiring.sum {
            add(plc, sum, count);
        }
    }
}

/// Adds to a pair of registers.
fn add(plc: &mut dyn Plc, low: Register, count: i32) {
    if count != 0 {
        let total = long(plc, low).wrapping_add(count);
        set_long(plc, low, total);
    }
}

/// Counts pulses of an axis whose registers begin with `first`, and of the output to which it is bound.
fn count_axis(plc: &mut dyn Plc, first: Register, output: u32, count: i32) {
    add(plc, first.after(place::POSITION), count);
    add(plc, place::PULSES.after(2 * output), count);
    let increment = first.after(place::INCREMENT);
    let _ = plc.set_word(Class::D, increment.number(), count as i16);
}

/// The frequency at which an output sends pulses, in millihertz: that of all axes that are bound to it.
pub fn millihertz<P: Plc + ?Sized>(plc: &mut P, output: u32) -> u32 {
    let mut sum: u32 = 0;
    for n in 0..plc.pulses().outputs().len() as u32 {
        if let Some(axis) = plc.axis(n).filter(|axis| u32::from(axis.output) == output) {
            sum = sum.saturating_add(axis.generator.millihertz());
        }
    }
    sum
}

/// The bit of an output; no model has 64.
fn bit_of(output: u16) -> u64 {
    1u64.checked_shl(output.into()).unwrap_or(0)
}

/// Drives the pins of all pulse outputs; see [`crate::Program::pulse_timer`]. It touches nothing of the PLC but
/// [`Plc::axis`].
pub fn pulse_timer(plc: &mut dyn Plc, hal: &mut dyn Hal, now_us: u32) -> Option<u32> {
    let outputs = plc.pulses().outputs().len() as u16;
    let mut next = None;
    // The outputs that exist, and those that are on, a bit each: several axes may be bound to one.
    let (mut present, mut shown) = (0u64, 0u64);
    for output in 0..outputs {
        let Some(axis) = plc.axis(output.into()) else {
            continue;
        };
        let edge = axis.drive(now_us);
        next = match (next, edge) {
            (Some(a), Some(b)) => Some(u32::min(a, b)),
            (a, b) => a.or(b),
        };
        present |= bit_of(output);
        if axis.on {
            shown |= bit_of(axis.output);
        }
    }
    for output in (0..outputs).filter(|&output| present & bit_of(output) != 0) {
        hal.set_output(output, shown & bit_of(output) != 0);
    }
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Hardware that keeps the changes of Y000.
    #[derive(Default)]
    struct Pins {
        on: bool,
        changes: std::vec::Vec<(u32, bool)>,
        now_us: u32,
    }

    impl Hal for Pins {
        fn set_output(&mut self, number: u16, value: bool) {
            if number == 0 && value != self.on {
                self.on = value;
                self.changes.push((self.now_us, value));
            }
        }
    }

    fn next(plc: &mut crate::double::Double, pins: &mut Pins) -> Option<u32> {
        let now_us = pins.now_us;
        pulse_timer(plc, pins, now_us)
    }

    #[test]
    fn pins_change_when_the_timer_expires() {
        use crate::double::Double;
        let mut plc = Double::new();
        plc.sys.first_scan = false;
        let mut pins = Pins::default();
        let axis = plc.axis(0).unwrap();
        axis.generator
            .start(crate::pulse::Train::steady(8_000_000, 3));
        axis.counter = 8140;
        while let Some(wait) = next(&mut plc, &mut pins) {
            pins.now_us += wait;
        }
        let edges = [
            (0, true),
            (63, false),
            (125, true),
            (188, false),
            (250, true),
            (313, false),
        ];
        assert_eq!(pins.changes, edges);
        // Registers follow when the scan counts.
        assert_eq!(plc.dd(8140), 0);
        advance(&mut plc, pins.now_us);
        assert_eq!(plc.dd(8140), 3);
    }
}
