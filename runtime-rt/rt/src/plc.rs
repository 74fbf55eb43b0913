//! The devices of a PLC as instructions see them.

use crate::axis::Axis;
use crate::comm::codec::Codec;
use crate::comm::modbus::{self, Profile};
use crate::comm::{PortMut, PortWiring, Ports};
use crate::stopwatch::Milliseconds;
use crate::wiring::Pulses;

/// Device class. The numbers are part of the C ABI.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Class {
    /// Input relay.
    X = 0,
    /// Output relay.
    Y = 1,
    /// Auxiliary relay; from 8000 special.
    M = 2,
    /// Step relay.
    S = 3,
    /// Timer: contact as a bit, current value as a word.
    T = 4,
    /// Counter: contact as a bit, current value as a word, or 32 bits from C200.
    C = 5,
    /// Data register; from 8000 special.
    D = 6,
    /// Extension register.
    R = 7,
    /// Index register V.
    V = 8,
    /// Index register Z.
    Z = 9,
    /// Extension file register.
    ER = 10,
}

/// Private memory of one instruction in the program (RAMP's progress, HKY's scan position, …), zero at power-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct State(pub [i32; 8]);

impl State {
    /// As at power-on.
    pub const fn new() -> Self {
        State([0; 8])
    }
}

/// Time and mode, from the scan driver for instructions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Sys {
    /// Time from the first scan to this one in milliseconds, wrapping; constant within a scan.
    pub now_ms: u32,
    /// Milliseconds from the start of the previous scan to the start of this one; 0 in the first.
    pub dt_ms: u32,
    /// Duration of the last scan in microseconds, at most [`Sys::MOST_SCAN_US`] (D8010 shows it in 0.1 ms).
    pub scan_us: u32,
    /// The host's clock, read at scans and ticks.
    pub clock: Milliseconds,
    /// True in the first scan after RUN began (M8002).
    pub first_scan: bool,
    /// True if the PLC is in RUN.
    pub running: bool,
    /// Another odd number in each scan, wrapping; 0 before the first one after power-on. What is done once in each scan remembers it.
    pub scan: u16,
    /// Milliseconds since the first scan, from 0 again after a minute (M8011 to M8014).
    pub minute_ms: u16,
}

impl Sys {
    /// The longest duration of a scan that D8010 shows, in microseconds.
    pub const MOST_SCAN_US: u32 = 100 * i16::MAX as u32;

    /// Milliseconds of a minute.
    const MINUTE_MS: u32 = 60_000;

    /// At power-on: in RUN, before the first scan.
    pub const fn power_on() -> Self {
        Sys {
            now_ms: 0,
            dt_ms: 0,
            scan_us: 0,
            clock: Milliseconds::at(0),
            first_scan: true,
            running: true,
            scan: 0,
            minute_ms: 0,
        }
    }

    /// A scan begins, in RUN or in STOP, at this reading of the host's clock.
    pub fn begin_scan(&mut self, now_ms: u32, scan_us: u32) {
        self.tick(now_ms);
        let passed = self.clock.elapsed.wrapping_sub(self.now_ms);
        self.dt_ms = if self.first_scan { 0 } else { passed };
        self.now_ms = self.clock.elapsed;
        self.scan_us = scan_us.min(Self::MOST_SCAN_US);
        self.scan = self.scan.wrapping_add(2) | 1;
        let minute_ms = u32::from(self.minute_ms).saturating_add(passed);
        self.minute_ms = match minute_ms < Self::MINUTE_MS {
            true => minute_ms,
            false => minute_ms % Self::MINUTE_MS,
        } as u16;
    }

    /// Time has passed between two scans, to this reading of the host's clock.
    pub fn tick(&mut self, now_ms: u32) {
        if self.scan == 0 {
            self.clock = Milliseconds::at(now_ms);
        }
        self.clock.advance(now_ms);
    }

    /// The time by the host's clock, in microseconds, wrapping: for pulses, and for ports, whose characters carry it.
    pub fn now_us(&self) -> u32 {
        self.clock.reading.wrapping_mul(1000)
    }

    /// The scan is over.
    pub fn end_scan(&mut self) {
        self.first_scan = false;
    }

    /// Takes the RUN/STOP switch's position; returns whether it was changed.
    pub fn set_running(&mut self, running: bool) -> bool {
        let changed = self.running != running;
        if changed {
            self.running = running;
            self.first_scan = running;
        }
        changed
    }
}

/// The position of a call in the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Site {
    /// Step number, reported in D8069 if the instruction faults.
    pub step: u32,
    /// Number of its [`State`]; 0 for instructions without.
    pub slot: u16,
    /// 32-bit form.
    pub wide: bool,
    /// True if the drive contact is on. Only instructions that [`crate::Needs::always`] run are called with `false`.
    pub drive: bool,
    /// An input has changed that the instruction looks at, perhaps between two scans: it is driven as it was last ([`crate::Needs::signals`]).
    pub signal: bool,
    /// Period in milliseconds of the timer interrupt whose routine executes the instruction, if it takes its time from
    /// that ([`crate::Needs::sampled`]); else 0.
    pub period_ms: u16,
}

impl Site {
    /// A driven 16-bit call at this step.
    pub const fn at(step: u32) -> Self {
        Site {
            step,
            slot: 0,
            wide: false,
            drive: true,
            signal: false,
            period_ms: 0,
        }
    }

    /// The same in the 32-bit form.
    #[must_use]
    pub const fn wide(mut self) -> Self {
        self.wide = true;
        self
    }

    /// The same with private memory number `slot`.
    #[must_use]
    pub const fn slot(mut self, slot: u16) -> Self {
        self.slot = slot;
        self
    }

    /// The same with the drive contact's state.
    #[must_use]
    pub const fn driven(mut self, drive: bool) -> Self {
        self.drive = drive;
        self
    }

    /// The same because of an input.
    #[must_use]
    pub const fn signal(mut self) -> Self {
        self.signal = true;
        self
    }

    /// The same in the routine of a timer interrupt with this period.
    #[must_use]
    pub const fn each_ms(mut self, period_ms: u16) -> Self {
        self.period_ms = period_ms;
        self
    }
}

/// Devices of consecutive numbers that a program stores in one piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredRun {
    /// Number of devices; at least 1.
    pub count: u32,
    /// Area for [`Plc::bit_in`] and the like; 0: no particular area.
    pub area: u8,
}

/// The devices of a PLC.
///
/// `None` means that the model has no such device: the instruction faults with 6706. A special M or D that the model has but the
/// program never looks at may be left out by an implementation: it reads as 0 and swallows writes.
pub trait Plc {
    /// State of a bit device; for T and C the contact.
    fn bit(&self, class: Class, number: u32) -> Option<bool>;
    /// Sets a bit device.
    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()>;
    /// State of the coil of a timer or counter at its last execution; implementations that serve no coils give the contact.
    fn coil(&self, class: Class, number: u32) -> Option<bool> {
        self.bit(class, number)
    }
    /// Value of a 16-bit word device; for T and C0–C199 the current value.
    fn word(&self, class: Class, number: u32) -> Option<i16>;
    /// Sets a word device.
    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()>;
    /// As [`Plc::bit`], of a device that is perhaps stored in this area ([`crate::Operand::area`]): that is looked at first.
    fn bit_in(&self, area: u8, class: Class, number: u32) -> Option<bool> {
        let _ = area;
        self.bit(class, number)
    }
    /// As [`Plc::set_bit`], likewise.
    fn set_bit_in(&mut self, area: u8, class: Class, number: u32, value: bool) -> Option<()> {
        let _ = area;
        self.set_bit(class, number, value)
    }
    /// As [`Plc::word`], likewise.
    fn word_in(&self, area: u8, class: Class, number: u32) -> Option<i16> {
        let _ = area;
        self.word(class, number)
    }
    /// As [`Plc::set_word`], likewise.
    fn set_word_in(&mut self, area: u8, class: Class, number: u32, value: i16) -> Option<()> {
        let _ = area;
        self.set_word(class, number, value)
    }
    /// Reads words side by side, as [`Plc::word_in`] reads each; `None` if one of them does not exist.
    fn words_in(&self, area: u8, class: Class, first: u32, words: &mut [i16]) -> Option<()> {
        let mut all = (first..).zip(words);
        all.try_for_each(|(number, word)| {
            self.word_in(area, class, number).map(|value| *word = value)
        })
    }
    /// Writes words side by side, as [`Plc::set_word_in`] writes each.
    fn set_words_in(&mut self, area: u8, class: Class, first: u32, words: &[i16]) -> Option<()> {
        let mut all = (first..).zip(words);
        all.try_for_each(|(number, word)| self.set_word_in(area, class, number, *word))
    }
    /// Current value of a 32-bit counter (C200 and up).
    fn counter32(&self, number: u32) -> Option<i32>;
    /// Sets the current value of a 32-bit counter.
    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()>;
    /// The devices from this one on that are stored in one piece, so that partners on a line may ask for them; `None` if this one is not
    /// stored. Of a device that the model does not have, it may say anything.
    fn stored_run(&self, class: Class, number: u32) -> Option<StoredRun> {
        let _ = (class, number);
        Some(StoredRun {
            count: u32::MAX,
            area: 0,
        })
    }
    /// Private memory of an instruction.
    fn state(&mut self, slot: u16) -> &mut State;
    /// Time and mode.
    fn sys(&self) -> &Sys;
    /// Pulse output Y`output`, if the program uses it.
    fn axis(&mut self, output: u32) -> Option<&mut Axis> {
        let _ = output;
        None
    }
    /// The serial port that the model's manual numbers so, if the program has it.
    fn port(&mut self, number: u8) -> Option<PortMut<'_>> {
        let _ = number;
        None
    }
    /// Protocol implementations of its serial ports; under a missing protocol a port does nothing.
    fn codecs(&self) -> &'static [&'static Codec] {
        &[]
    }
    /// The special devices of its serial ports, by their index in the order of the ports' numbers; `None` after the last one. There may be
    /// ports among them that it does not have.
    fn port_wiring(&self, index: usize) -> Option<&'static PortWiring> {
        let _ = index;
        None
    }
    /// Devices served by Modbus, and the limits of a frame.
    fn modbus(&self) -> &'static Profile {
        &modbus::NOTHING
    }
    /// The serial ports that the model has.
    fn ports(&self) -> Ports {
        Ports::Without
    }
    /// Code of model and version, which D8001 shows and partners on a line ask for.
    fn type_code(&self) -> u16 {
        0
    }
    /// A byte of the program memory by its offset from 8000h, where partners may read the program; a compiled program has no such memory.
    fn program_byte(&self, offset: u32) -> Option<u8> {
        let _ = offset;
        None
    }
    /// The pulse outputs that the model has.
    fn pulses(&self) -> Pulses {
        Pulses::Without
    }
    /// Characters of a text operand.
    fn text(&self, index: u32) -> &[u8] {
        let _ = index;
        &[]
    }
    /// Returns true if a 32-bit access to Zn takes Vn as its high word (FX, H1U/H2U) rather than Zn+1 (HM).
    fn z_pairs_with_v(&self) -> bool {
        true
    }
    /// Relay that shows an operation error: M8067 (FX, H1U/H2U, L01S) or M8006 (HM); see [`crate::report`].
    fn error_relay(&self) -> u32 {
        8067
    }
    /// Code of [`crate::Fault::VALUE`]: 6707 (H1U/H2U) or 6706, which on FX and L01S stands for devices and values.
    fn value_error(&self) -> u16 {
        crate::Fault::DEVICE.0
    }
    /// Code of [`crate::Fault::MODULE`]. The table of codes that separates values from devices has 6750
    /// (h1u-h2u-programming §8.7); on FX and L01S it is the error of FROM and TO, 6708.
    fn module_error(&self) -> u16 {
        match self.value_error() == crate::Fault::VALUE.0 {
            true => 6750,
            false => 6708,
        }
    }
    /// Consequences of errors on the model, as far as the program looks at them.
    fn error_rules(&self) -> crate::ErrorRules {
        crate::ErrorRules::NONE
    }
    /// An operation error has happened to the instruction at this step ([`crate::LastError`]).
    fn note_error(&mut self, code: u16, step: u32) {
        let _ = (code, step);
    }
    /// Resets a timer or counter: value 0, contact off (what RST and ZRST do).
    fn reset(&mut self, class: Class, number: u32) -> Option<()>;
}
