//! Pulse outputs that an interrupt drives while a scan runs, and what it shares with the program.
//!
//! The program has an [`Axis`] for each of its outputs, and so has the interrupt, which alone lets time pass for its
//! own. Whenever the program counts pulses, or runs an instruction that sends some, the interrupt waits: the program
//! takes over what has been sent by then, and leaves what is to be sent. So an edge waits for one such instruction at
//! most, a few microseconds, and never for a scan; and no pulse is lost or sent twice.

use crate::axis::Axis;
use crate::hal::Hal;
use crate::plc::Plc;

/// Pulse outputs shared between an interrupt and the program, from Y000 on; emitted programs give their number in
/// `PULSE_OUTPUTS`. All are `None` at power-on. It is in a `static` protected by a lock, see [`crate::board`].
pub type SharedAxes<const N: usize> = [Option<Axis>; N];

/// Delay before the interrupt retries while the program holds its outputs, in microseconds.
const RETRY_US: u32 = 5;

/// Drives the pins of pulse outputs whose time has come, in the interrupt of a timer; returns in how many microseconds
/// the next one changes, for the timer to be armed; `None` if none does. What `set_output` is called for are the
/// outputs that the program sends pulses on.
pub fn send_pulses(
    shared: &mut [Option<Axis>],
    now_us: u32,
    mut set_output: impl FnMut(u16, bool),
) -> Option<u32> {
    let axes = shared.iter_mut().flatten();
    let next = axes.filter_map(|axis| match axis.taken {
        true => Some(RETRY_US),
        false => axis.drive(now_us),
    });
    let next = next.min();
    for (output, slot) in (0..).zip(&*shared) {
        if slot.is_some() {
            let shows = |axis: &Axis| axis.output == output && axis.on;
            set_output(output, shared.iter().flatten().any(shows));
        }
    }
    next
}

/// The program takes over what the interrupt has sent. Until [`give`], that one waits.
pub(crate) fn take(plc: &mut dyn Plc, hal: &mut dyn Hal) {
    hal.with_pulses(&mut |shared| {
        for (output, slot) in (0..).zip(shared) {
            if let (Some(shared), Some(axis)) = (slot, plc.axis(output)) {
                axis.take_over(shared);
            }
        }
    });
}

/// The interrupt continues with what the program wants to send.
pub(crate) fn give(plc: &mut dyn Plc, hal: &mut dyn Hal) {
    hal.with_pulses(&mut |shared| {
        for (output, slot) in (0..).zip(shared) {
            *slot = plc.axis(output).map(|axis| axis.unsent());
        }
    });
}

/// Counts the pulses that have ended by `now_us`, in microseconds since power-on, wrapping, on all outputs: as
/// [`crate::advance_pulses`], also those that an interrupt has sent.
pub fn count_pulses(plc: &mut dyn Plc, hal: &mut dyn Hal, now_us: u32) {
    take(plc, hal);
    crate::axis::advance(plc, now_us);
    give(plc, hal);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double::Double;
    use crate::pulse::Train;

    /// Hardware with an interrupt that has Y000 and Y001.
    #[derive(Default)]
    struct Timer {
        shared: SharedAxes<2>,
        rises: u32,
        on: bool,
    }

    impl Hal for Timer {
        fn with_pulses(&mut self, work: &mut dyn FnMut(&mut [Option<Axis>])) {
            work(&mut self.shared);
        }
    }

    impl Timer {
        fn interrupt(&mut self, now_us: u32) -> Option<u32> {
            let (rises, on) = (&mut self.rises, &mut self.on);
            send_pulses(&mut self.shared, now_us, |output, level| {
                assert!(output < 2);
                if output == 0 {
                    *rises += u32::from(level && !*on);
                    *on = level;
                }
            })
        }
    }

    #[test]
    fn pulses_go_on_while_the_program_is_busy() {
        let mut plc = Double::new();
        plc.sys.first_scan = false;
        let mut timer = Timer::default();
        assert_eq!(timer.interrupt(0), None);
        take(&mut plc, &mut timer);
        let axis = plc.axis(0).unwrap();
        axis.generator.start(Train::steady(10_000_000, 100));
        axis.counter = 8140;
        give(&mut plc, &mut timer);
        let mut now_us = 0;
        while now_us < 5000 {
            now_us += timer.interrupt(now_us).unwrap();
        }
        // The program has noticed nothing so far.
        assert_eq!((plc.dd(8140), timer.rises), (0, 50));
        count_pulses(&mut plc, &mut timer, now_us);
        assert_eq!(plc.dd(8140), 49);
        // More than it sends, from where it is.
        take(&mut plc, &mut timer);
        assert_eq!(timer.interrupt(now_us), Some(RETRY_US));
        plc.axis(0).unwrap().generator.set_total(200);
        give(&mut plc, &mut timer);
        while let Some(wait) = timer.interrupt(now_us) {
            now_us += wait;
        }
        count_pulses(&mut plc, &mut timer, now_us);
        assert_eq!((plc.dd(8140), timer.rises), (200, 200));
        let axis = plc.axis(0).unwrap();
        assert!(axis.take_end() && !axis.take_end());
        count_pulses(&mut plc, &mut timer, now_us + 1000);
        assert!(!plc.axis(0).unwrap().take_end() && plc.dd(8140) == 200);
    }
}
