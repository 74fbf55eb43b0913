//! A compiled program as its host sees it: what emitted Rust and the interpreter implement.

use crate::fault::LastError;
use crate::hal::Hal;
use crate::plc::{Class, Plc};
use crate::retain::Retained;

/// A program and its devices. The host copies the input terminals to X ([`Plc::set_bit`]), calls [`Program::scan`], and
/// copies [`Program::output`] to the output terminals.
pub trait Program: Plc {
    /// One scan. `now_ms` is the time since power-on (wrapping), `scan_us` how long the last scan took. In STOP only
    /// the special relays that run from power-on (the clocks) are brought up to date.
    fn scan(&mut self, hal: &mut dyn Hal, now_ms: u32, scan_us: u32);

    /// Minimum scan time in milliseconds, from the start of a scan to the start of the next one, if the program asks
    /// for scans of constant length: M8039 and D8039, or D8059 on L01S. A scan that takes longer is followed at once by
    /// the next. The `scan_us` of the next scan includes the time in which it waited (h1u-h2u-programming §8.9).
    fn constant_scan_ms(&self) -> Option<u16> {
        None
    }

    /// Input terminal X `number` turns on or off. Only programs react to it that have interrupts, pulse catch,
    /// high-speed counters, or positioning that looks at inputs; others see their inputs as X shows them to a scan.
    /// Interrupts that it requests run in the next scan, or in [`Program::take_interrupts`].
    fn input_edge(&mut self, hal: &mut dyn Hal, number: u32, level: bool) {
        let _ = (hal, number, level);
    }

    /// Advances time: `now_ms` as for a scan, at least once a millisecond for timer interrupts to be exact. They run as
    /// those of inputs. Pulses that have ended by then are counted.
    fn tick(&mut self, hal: &mut dyn Hal, now_ms: u32) {
        let _ = (hal, now_ms);
    }

    /// Runs the interrupt routines that are requested, between two scans. In a scan they run in front of each network.
    fn take_interrupts(&mut self, hal: &mut dyn Hal) {
        let _ = hal;
    }

    /// Drives the pins of pulse outputs ([`Hal::set_output`]) at `now_us`, microseconds since power-on, wrapping, and
    /// returns after how many microseconds the next one changes; `None` if none does. Call it then, and after each
    /// scan, which may begin a train. An interrupt that comes while scans run calls [`crate::board::send_pulses`]
    /// instead. Without either pulses are counted, but no pins driven.
    fn pulse_timer(&mut self, hal: &mut dyn Hal, now_us: u32) -> Option<u32> {
        let _ = (hal, now_us);
        None
    }

    /// Pulses sent by output Y `number` since power-on; those in reverse count down.
    fn pulses_sent(&mut self, number: u32) -> i32 {
        self.axis(number).map_or(0, |axis| axis.sent)
    }

    /// The frequency at which output Y `number` sends pulses now, in millihertz.
    fn pulse_millihertz(&mut self, number: u32) -> u32 {
        crate::pulse_millihertz(self, number)
    }

    /// The RUN/STOP switch, which M8035 and M8036 can override in STOP. Going to STOP clears every device that is
    /// neither latched, special nor an input, unless M8033 is on; going to RUN makes the next scan the first one
    /// (M8002) and forgets all edges, the coils of timers and counters and the private memories of instructions
    /// included. Setting the mode that it is in changes nothing. A program is in RUN at power-on.
    fn set_running(&mut self, running: bool);

    /// Power off and on: everything but latched devices takes its power-on value, inputs, special devices, edges, the
    /// coils of latched timers and counters and private memories included; then RUN. On models with a latch key (HM)
    /// latched devices are kept only if the key register holds the key.
    fn power_cycle(&mut self);

    /// Values retained over power-off, for a host that saves them ([`crate::retain`]).
    fn retained(&self) -> Retained<'_> {
        Retained::NOTHING
    }

    /// Returns true if RST holds a latched timer or counter at 0, over power-off too: its reset state
    /// (h1u-h2u-programming §3.6). Always false for one whose reset state ends when the PLC is switched off.
    fn is_reset(&self, class: Class, number: u32) -> bool {
        let _ = (class, number);
        false
    }

    /// Gives a latched timer or counter the reset state that a host saved ([`Program::is_reset`]). Nothing changes for
    /// one whose reset state ends when the PLC is switched off.
    fn set_reset(&mut self, class: Class, number: u32, reset: bool) {
        let _ = (class, number, reset);
    }

    /// The last operation error, and why the PLC stopped. Going to RUN forgets both.
    fn last_error(&self) -> LastError {
        LastError::NONE
    }

    /// State of output terminal Y `number` after the scan: the image, or off under M8034 and in STOP without M8033. One
    /// that sends pulses is also on while its pulse is.
    fn output(&self, number: u32) -> bool;
}
