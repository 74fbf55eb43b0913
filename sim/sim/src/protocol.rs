//! Requests of a test to an engine, and their text form for executables.
//!
//! A batch executable holds many compiled programs. It reads one request a line and answers each with one line: `ok`,
//! `none` (no such device, module or channel), or a decimal value. It flushes its output when its input is exhausted or
//! a value was requested.

use crate::target::Channel;
use rungc_rt::comm::Received;
use rungc_rt::{Class, Clock};
use std::fmt;

/// One request.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Request {
    /// Program number `.0` of the batch, freshly powered on, with hardware that has nothing set.
    Case(usize),
    /// Program number `.0` of the batch in another PLC of the case, freshly powered on, with separate hardware. The
    /// first PLC is that of [`Request::Case`].
    Join(usize),
    /// Selects this PLC of the case, 0 for the first, for the following requests.
    Plc(usize),
    /// Sets a bit device.
    SetBit(Class, u32, bool),
    /// Sets a word device.
    SetWord(Class, u32, i16),
    /// Sets a pair, or a 32-bit counter.
    SetDouble(Class, u32, i32),
    /// Asks for a bit device.
    Bit(Class, u32),
    /// Asks for a word device.
    Word(Class, u32),
    /// Asks for a pair, or for a 32-bit counter.
    Double(Class, u32),
    /// Asks for a [`Digest`] of all that devices hold: of this class, from this number on, this many.
    Digest(Class, u32, u32),
    /// One scan.
    Scan {
        /// Milliseconds since power-on.
        now_ms: u32,
        /// Duration of the scan before, in microseconds.
        scan_us: u32,
    },
    /// Asks how many milliseconds a scan is to last at least; 0 if the program does not ask for scans of constant
    /// length.
    ConstantScan,
    /// An input terminal turns on or off.
    Edge(u32, bool),
    /// This many milliseconds have passed since power-on.
    Tick(u32),
    /// Runs the interrupts that are requested.
    Interrupts,
    /// Asks for the state of an output terminal.
    Output(u32),
    /// Asks how many pulses an output has sent since power-on; those in reverse count down.
    Pulses(u32),
    /// Lets pulses pass, at most until an output has sent a number of them; asks for the time that is reached, in
    /// microseconds since power-on, wrapping.
    Pass {
        /// Microseconds since power-on, wrapping, that have been reached.
        from_us: u32,
        /// Time to reach.
        until_us: u32,
        /// Maximum number of pulses that an output sends, up to `i32::MAX`.
        most: u32,
    },
    /// Asks for the frequency at which an output sends pulses, in millihertz.
    Frequency(u32),
    /// A character comes to a serial port; it was in at its time, after those before it.
    Receive(u8, Received),
    /// Takes the oldest character that a serial port has sent by a time, in microseconds since power-on: the time at
    /// which it was out, shifted left by 8, plus the character. There is none: [`Answer::Missing`].
    Sent(u8, u32),
    /// Asks for the format of characters on the line of a serial port: bits per second, 8 bits of data bits, 4 of
    /// parity (none, odd, even), 4 of stop bits.
    Line(u8),
    /// The RUN/STOP switch.
    Run(bool),
    /// Power off and on; virtual time begins at 0 again.
    Power,
    /// Sets a word of a module's buffer memory.
    SetBfm(u16, u16, i16),
    /// Asks for a word of a module's buffer memory.
    Bfm(u16, u16),
    /// Fits the module with this number: the kind by its number in the table of [`rungc_rt::modules::KINDS`].
    Fit(u16, usize),
    /// A module answers after this many milliseconds from now on.
    DelayModule(u16, u16),
    /// An analog signal reaches an input of a module.
    SetSignal {
        /// Milliseconds since power-on.
        now_ms: u32,
        /// The channel.
        channel: Channel,
        /// Value in millionths.
        millionths: i32,
    },
    /// Asks for the signal at a channel of a module, in millionths.
    Signal {
        /// Milliseconds since power-on.
        now_ms: u32,
        /// The channel.
        channel: Channel,
    },
    /// The power supply fails from now on, or is back.
    SetPowerFails(bool),
    /// Sets the real-time clock.
    SetClock(Clock),
    /// Sets the raw value of an analog input.
    SetAnalog(u8, i16),
    /// Ends the executable.
    Exit,
}

/// The answer to a request.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Answer {
    /// Done.
    Ok,
    /// There is no such device, module or channel.
    Missing,
    /// The requested value.
    Value(i64),
}

impl Answer {
    /// Reads an executable's answer.
    pub fn parse(line: &str) -> Option<Answer> {
        match line.trim_end() {
            "ok" => Some(Answer::Ok),
            "none" => Some(Answer::Missing),
            number => number.parse().ok().map(Answer::Value),
        }
    }

    /// `Ok` if something was found, else `Missing`.
    pub(crate) fn done(found: Option<()>) -> Answer {
        found.map_or(Answer::Missing, |()| Answer::Ok)
    }

    /// The value if something was found, else `Missing`.
    pub(crate) fn value(found: Option<impl Into<i64>>) -> Answer {
        found.map_or(Answer::Missing, |v| Answer::Value(v.into()))
    }
}

/// One number that stands for many: whoever compares devices of two engines asks for it first, and for the devices only
/// where it differs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Digest(u32);

impl Digest {
    /// Mark for a missing value; no bit, word or terminal has it.
    const NONE: u32 = 0x8000_0001;

    /// Of nothing.
    pub const fn new() -> Self {
        Digest(0x811C_9DC5)
    }

    /// Adds a value, or that there is none, as FNV-1a adds a byte.
    #[must_use]
    pub fn with(self, value: Option<impl Into<i64>>) -> Self {
        let value = value.map_or(Self::NONE, |value| value.into() as u32);
        Digest((self.0 ^ value).wrapping_mul(0x0100_0193))
    }

    /// As the answer to a request.
    pub fn value(self) -> i64 {
        self.0.into()
    }
}

impl Default for Digest {
    fn default() -> Self {
        Digest::new()
    }
}

/// The letters of a class.
pub(crate) fn letters(class: Class) -> &'static str {
    match class {
        Class::X => "X",
        Class::Y => "Y",
        Class::M => "M",
        Class::S => "S",
        Class::T => "T",
        Class::C => "C",
        Class::D => "D",
        Class::R => "R",
        Class::V => "V",
        Class::Z => "Z",
        Class::ER => "ER",
    }
}

impl fmt::Display for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Request::Case(i) => write!(f, "case {i}"),
            Request::Join(i) => write!(f, "join {i}"),
            Request::Plc(i) => write!(f, "plc {i}"),
            Request::SetBit(c, n, v) => write!(f, "bit {} {n} {}", letters(c), u8::from(v)),
            Request::SetWord(c, n, v) => write!(f, "word {} {n} {v}", letters(c)),
            Request::SetDouble(c, n, v) => write!(f, "dword {} {n} {v}", letters(c)),
            Request::Bit(c, n) => write!(f, "getbit {} {n}", letters(c)),
            Request::Word(c, n) => write!(f, "getword {} {n}", letters(c)),
            Request::Double(c, n) => write!(f, "getdword {} {n}", letters(c)),
            Request::Digest(c, n, count) => write!(f, "digest {} {n} {count}", letters(c)),
            Request::Scan { now_ms, scan_us } => write!(f, "scan {now_ms} {scan_us}"),
            Request::ConstantScan => write!(f, "constant"),
            Request::Edge(n, level) => write!(f, "edge {n} {}", u8::from(level)),
            Request::Tick(now_ms) => write!(f, "tick {now_ms}"),
            Request::Interrupts => write!(f, "interrupts"),
            Request::Output(n) => write!(f, "out {n}"),
            Request::Pulses(n) => write!(f, "pulses {n}"),
            Request::Pass {
                from_us,
                until_us,
                most,
            } => write!(f, "pass {} {} {most}", from_us as i32, until_us as i32),
            Request::Frequency(n) => write!(f, "frequency {n}"),
            Request::Receive(port, c) => {
                write!(f, "receive {port} {} {} {}", c.at_us, c.byte, c.fault as u8)
            }
            Request::Sent(port, now_us) => write!(f, "sent {port} {now_us}"),
            Request::Line(port) => write!(f, "line {port}"),
            Request::Run(run) => write!(f, "run {}", u8::from(run)),
            Request::Power => write!(f, "power"),
            Request::SetBfm(unit, address, v) => write!(f, "bfm {unit} {address} {v}"),
            Request::Bfm(unit, address) => write!(f, "getbfm {unit} {address}"),
            Request::Fit(unit, kind) => write!(f, "fit {unit} {kind}"),
            Request::DelayModule(unit, ms) => write!(f, "delay {unit} {ms}"),
            Request::SetSignal {
                now_ms,
                channel,
                millionths,
            } => write!(
                f,
                "signal {now_ms} {} {} {} {millionths}",
                channel.unit, channel.number, channel.quantity as u8
            ),
            Request::Signal { now_ms, channel } => write!(
                f,
                "getsignal {now_ms} {} {} {}",
                channel.unit, channel.number, channel.quantity as u8
            ),
            Request::SetPowerFails(fails) => write!(f, "supply {}", u8::from(fails)),
            Request::SetClock(c) => write!(
                f,
                "clock {} {} {} {} {} {}",
                c.year, c.month, c.day, c.hour, c.minute, c.second
            ),
            Request::SetAnalog(channel, v) => write!(f, "analog {channel} {v}"),
            Request::Exit => write!(f, "exit"),
        }
    }
}
