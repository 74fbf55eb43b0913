//! A board, described once by four small traits, and the [`Driver`] that does all wiring between it and a program.
//!
//! Times are microseconds by the board's clock, which may begin anywhere and wraps after 71 minutes
//! ([`Stopwatch`](crate::Stopwatch)). Inputs and outputs have plain numbers: 8 is X010.
//!
//! ```
//! use rungc_rt::board::{CounterInput, Driver, EdgeInterrupt, PulseOutput, Setup, Timebase};
//! use rungc_rt::{Hal, Program};
//!
//! /// Eight inputs, six outputs, and a time; nothing that interrupts, counts or wakes.
//! struct Desk {
//!     inputs: u8,
//!     outputs: [bool; 6],
//!     now_us: u32,
//! }
//!
//! impl Hal for Desk {
//!     fn input(&mut self, number: u16) -> Option<bool> {
//!         (number < 8).then_some(self.inputs >> number & 1 == 1)
//!     }
//!     fn set_output(&mut self, number: u16, value: bool) {
//!         if let Some(on) = self.outputs.get_mut(usize::from(number)) {
//!             *on = value;
//!         }
//!     }
//! }
//!
//! impl Timebase for Desk {
//!     fn now_us(&mut self) -> u32 {
//!         self.now_us
//!     }
//! }
//!
//! impl EdgeInterrupt for Desk {}
//! impl CounterInput for Desk {}
//! impl PulseOutput for Desk {}
//!
//! fn run(program: impl Program, desk: Desk) -> ! {
//!     let setup = Setup { inputs: 8, outputs: 6, scan_us: 5000 };
//!     let mut driver = Driver::new(program, desk, setup);
//!     loop {
//!         driver.poll();
//!     }
//! }
//! ```
//!
//! # Interrupts
//!
//! Edges of inputs and pulses are worth an interrupt. Each has one object in a `static` of the firmware: an
//! [`EdgeQueue`], which needs no lock, and [`SharedAxes`], protected by the lock that keeps the timer's interrupt out.
//!
//! ```
//! use rungc_rt::board::{EdgeQueue, InputEdge, SharedAxes, send_pulses};
//! use rungc_rt::{Axis, Hal};
//! use std::sync::Mutex; // on a microcontroller a `critical_section::Mutex` of a `RefCell`
//!
//! static EDGES: EdgeQueue<64> = EdgeQueue::new();
//! static PULSES: Mutex<SharedAxes<1>> = Mutex::new([None; 1]); // as many as the program's `PULSE_OUTPUTS`
//!
//! fn pin_interrupt(input: u32, level: bool) {
//!     EDGES.note(InputEdge { input, level });
//! }
//!
//! fn timer_interrupt(now_us: u32) {
//!     if let Ok(mut pulses) = PULSES.lock() {
//!         let wait = send_pulses(&mut *pulses, now_us, |output, on| { /* sets a pin */ });
//!         // The timer is to come again in `wait` microseconds.
//!     }
//! }
//!
//! struct Timer;
//!
//! impl Hal for Timer {
//!     fn with_pulses(&mut self, work: &mut dyn FnMut(&mut [Option<Axis>])) {
//!         if let Ok(mut pulses) = PULSES.lock() {
//!             work(&mut *pulses);
//!         }
//!     }
//! }
//! ```
//!
//! An edge of a pulse then is late by no more than the timer's interrupt is, and by one instruction that sends pulses,
//! or by the counting of all outputs each millisecond: some microseconds, however long a scan takes. An edge of an
//! input waits for the running scan to end, and for [`Driver::poll`]; none is lost as long as the queue has room for
//! those of a scan.

pub use crate::char_queue::CharQueue;
pub use crate::edge_queue::EdgeQueue;
use crate::hal::Hal;
pub use crate::line_queues::{BothQueues, TurnQueue};
use crate::plc::Class;
use crate::program::Program;
pub use crate::pulse_side::{SharedAxes, send_pulses};
use crate::stopwatch::{Divider, Microseconds};

/// Time source of a board.
pub trait Timebase {
    /// Microseconds by a clock that may begin anywhere, wrapping. Their resolution is that of pulses and scans.
    /// Characters of serial
    /// ports carry times by the same clock.
    fn now_us(&mut self) -> u32;
}

/// A change of an input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct InputEdge {
    /// The input X.
    pub input: u32,
    /// True for a rising edge.
    pub level: bool,
}

/// Inputs of which each edge interrupts the processor. The interrupt notes the edge in an [`EdgeQueue`]; the main loop
/// takes it from there.
pub trait EdgeInterrupt {
    /// The oldest edge that was noted and not taken yet.
    fn next_edge(&mut self) -> Option<InputEdge> {
        None
    }

    /// Returns true if the edges of this input are recorded by an interrupt. Its X then follows them and not
    /// [`Hal::input`], so that the phases of an encoder stay in order; the first scan alone takes it from the pin.
    fn notes_edges(&self, input: u32) -> bool {
        let _ = input;
        false
    }
}

/// Counts of a hardware counter.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Counted {
    /// A timer with an external clock has counted pulses.
    Pulses {
        /// The input X.
        input: u32,
        /// Pulses since the last call.
        count: u32,
    },
    /// A timer in encoder mode has counted quarters of a cycle.
    Quarters {
        /// The input X of phase A.
        a: u32,
        /// The input X of phase B.
        b: u32,
        /// State of the timer at the last call, wrapping. Its two lowest bits are the phases: 0 both off, 1 A on, 2
        /// both on, 3 B on.
        from: u32,
        /// Quarters since then; those in which B leads are negative.
        count: i32,
    },
}

/// Inputs that a hardware counter counts, for rates at which an interrupt for each edge is too slow. The program gets
/// them as that many edges, so its comparisons act at the count; but only as soon as the main loop asks.
pub trait CounterInput {
    /// Counts of this counter since the last call, possibly none. Counters are numbered from 0; `None` after the last
    /// one.
    fn counted(&mut self, counter: u32) -> Option<Counted> {
        let _ = counter;
        None
    }

    /// Returns true if a hardware counter uses this input. Its X then follows the counts and not [`Hal::input`].
    fn counts(&self, input: u32) -> bool {
        let _ = input;
        false
    }
}

/// Pins that pulses are sent on, and a timer that says when.
///
/// A board that has [`Hal::with_pulses`] sends them in the timer's interrupt, by [`send_pulses`], while scans run. Else
/// [`Hal::set_output`] sets the pins, in [`Driver::on_timer`].
pub trait PulseOutput: Hal {
    /// Arms the timer to fire in this many microseconds: 0 is as soon as it can, `None` not at all. A board without one
    /// leaves it as it is: its pulses are as exact as [`Driver::poll`] is called often.
    fn wake_in(&mut self, us: Option<u32>) {
        let _ = us;
    }
}

/// A whole board: whatever has all four traits.
pub trait Board: Timebase + EdgeInterrupt + CounterInput + PulseOutput {}

impl<T: Timebase + EdgeInterrupt + CounterInput + PulseOutput> Board for T {}

/// Settings of a program on a board.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Setup {
    /// Inputs X from 0 on that a scan reads with [`Hal::input`].
    pub inputs: u16,
    /// Outputs Y from 0 on that a scan sets with [`Hal::set_output`].
    pub outputs: u16,
    /// Scan period, start to start, in microseconds, below 2^31; 0: a scan at each [`Driver::poll`]. While the program
    /// asks for scans of constant length ([`Program::constant_scan_ms`]), that length is the period.
    pub scan_us: u32,
}

/// A program on a board.
#[derive(Clone, Debug)]
pub struct Driver<P, B> {
    /// The program and its devices.
    pub program: P,
    /// The board.
    pub board: B,
    setup: Setup,
    /// The board's clock in milliseconds; `None` before the first poll.
    clock: Option<Divider>,
    /// Start of the next scan.
    next_scan: u32,
    /// Duration of the last scan, in microseconds.
    scan_us: u32,
    /// An interrupt sends the pulses while scans run.
    shares_pulses: bool,
}

impl<P: Program, B: Board> Driver<P, B> {
    /// A program that is at its power-on, on a board. Nothing happens yet.
    pub fn new(program: P, board: B, setup: Setup) -> Self {
        Driver {
            program,
            board,
            setup,
            clock: None,
            next_scan: 0,
            scan_us: 0,
            shares_pulses: false,
        }
    }

    /// Milliseconds by the board's clock at the last [`Driver::poll`], wrapping; 0 before the first.
    pub fn now_ms(&self) -> u32 {
        self.clock.unwrap_or_default().ms
    }

    /// Does what is to be done by now. Call it in the main loop, as often as can be and at least once in half an hour:
    /// a millisecond, an edge or a count is as late as this is. Edges come first, each with the interrupt routine that
    /// it requests, then counts and milliseconds, then a scan if its time has come, then outputs and pulses.
    pub fn poll(&mut self) {
        let now_us = self.board.now_us();
        if self.clock.is_none() {
            self.next_scan = now_us;
            self.refresh_inputs(true);
            let shares = &mut self.shares_pulses;
            self.board
                .with_pulses(&mut |shared| *shares = !shared.is_empty());
        }
        let edges = self.take_edges();
        let counts = self.take_counts();
        let passed = self.pass(now_us);
        if passed {
            let now_ms = self.now_ms();
            self.program.tick(&mut self.board, now_ms);
        }
        self.program.take_interrupts(&mut self.board);
        let scans = has_come(self.next_scan, now_us);
        if scans {
            let begin = beginning(self.next_scan, self.setup.scan_us, now_us);
            self.next_scan = begin.wrapping_add(self.setup.scan_us);
            self.refresh_inputs(false);
            self.scan();
            self.wait_constant_time(begin);
        }
        if scans || edges || counts {
            self.write_outputs();
        }
        match self.shares_pulses {
            // A train begins in a scan or in an interrupt routine; the interrupt sees to it.
            true if scans || edges || counts || passed => self.board.wake_in(Some(0)),
            true => {}
            false => self.on_timer(),
        }
    }

    /// Drives the pins of pulse outputs whose time has come, and arms the timer for the next ones, on a board without
    /// [`Hal::with_pulses`]: call it at the time that [`PulseOutput::wake_in`] was given. [`Driver::poll`] does the
    /// same at its end. It waits for a running scan; one that comes late neither loses a pulse nor sends one too many.
    pub fn on_timer(&mut self) {
        let now_us = self.board.now_us();
        let wait = self.program.pulse_timer(&mut self.board, now_us);
        self.board.wake_in(wait);
    }

    /// Advances time; returns whether another millisecond has begun.
    fn pass(&mut self, now_us: u32) -> bool {
        let clock = self.clock.get_or_insert(Divider::at(now_us));
        let last_us = clock.ms.wrapping_mul(1000);
        if Microseconds::at(last_us).is_set(now_us) {
            self.next_scan = now_us;
        }
        clock.advance(now_us)
    }

    /// Takes the edges that interrupts noted; whether there were any.
    fn take_edges(&mut self) -> bool {
        let mut any = false;
        while let Some(InputEdge { input, level }) = self.board.next_edge() {
            any = true;
            self.change(input, level);
            self.program.take_interrupts(&mut self.board);
        }
        any
    }

    /// Takes what hardware counters have counted; whether that was anything.
    fn take_counts(&mut self) -> bool {
        let mut any = false;
        let mut counter = 0;
        while let Some(counted) = self.board.counted(counter) {
            counter += 1;
            match counted {
                Counted::Pulses { input, count } => {
                    any |= count > 0;
                    for _ in 0..count {
                        self.change(input, true);
                        self.change(input, false);
                    }
                }
                Counted::Quarters { a, b, from, count } => {
                    any |= count != 0;
                    self.turn([a, b], from, count);
                }
            }
        }
        any
    }

    /// An encoder turns by `count` quarters of a cycle. In each of them one phase changes.
    fn turn(&mut self, inputs: [u32; 2], from: u32, count: i32) {
        for (input, level) in inputs.into_iter().zip(phases(from)) {
            let _ = self.program.set_bit(Class::X, input, level);
        }
        let mut quarter = from;
        for _ in 0..count.unsigned_abs() {
            let before = phases(quarter);
            quarter = quarter.wrapping_add_signed(count.signum());
            let changes = before.into_iter().zip(phases(quarter));
            for (input, (before, level)) in inputs.into_iter().zip(changes) {
                if level != before {
                    self.change(input, level);
                }
            }
        }
    }

    /// An input changes.
    fn change(&mut self, input: u32, level: bool) {
        // A program that does not look at this X takes notice of its edges all the same.
        let _ = self.program.set_bit(Class::X, input, level);
        self.program.input_edge(&mut self.board, input, level);
    }

    /// Reads the pins of inputs; unless `all` are wanted, of those that neither interrupts nor counters follow.
    fn refresh_inputs(&mut self, all: bool) {
        for number in 0..self.setup.inputs {
            let input = u32::from(number);
            let followed = self.board.notes_edges(input) || self.board.counts(input);
            if (all || !followed)
                && let Some(level) = self.board.input(number)
            {
                let _ = self.program.set_bit(Class::X, input, level);
            }
        }
    }

    /// A scan.
    fn scan(&mut self) {
        let begin = Microseconds::at(self.board.now_us());
        let now_ms = self.now_ms();
        self.program.scan(&mut self.board, now_ms, self.scan_us);
        self.scan_us = begin.passed(self.board.now_us());
    }

    /// If the program asks for scans of constant length, the next one begins that long after the beginning of the last,
    /// or at once if that took longer.
    fn wait_constant_time(&mut self, begin: u32) {
        let Some(ms) = self.program.constant_scan_ms() else {
            return;
        };
        let constant_us = u32::from(ms) * 1000;
        if self.scan_us <= constant_us {
            self.next_scan = begin.wrapping_add(constant_us);
            self.scan_us = constant_us;
        } else {
            self.next_scan = self.board.now_us();
        }
    }

    /// Sets the pins of outputs, which a scan has changed, or a comparison at its count. The timer has those that send
    /// pulses.
    fn write_outputs(&mut self) {
        for number in 0..self.setup.outputs {
            if self.program.axis(number.into()).is_none() {
                let on = self.program.output(number.into());
                self.board.set_output(number, on);
            }
        }
    }
}

/// Phases A and B of an encoder in a quarter of its cycle.
fn phases(quarter: u32) -> [bool; 2] {
    [matches!(quarter % 4, 1 | 2), quarter % 4 >= 2]
}

/// Returns true if a moment has passed.
fn has_come(moment: u32, now_us: u32) -> bool {
    now_us.wrapping_sub(moment) <= u32::MAX / 2
}

/// Start of the scan due at this moment: the moment itself, even if it is a little late, or now if scans were missed.
fn beginning(moment: u32, period: u32, now_us: u32) -> u32 {
    if now_us.wrapping_sub(moment) < period {
        moment
    } else {
        now_us
    }
}
