//! A PLC that runs.

use crate::Error;
use crate::why::Source;
use rungc_interp::OperationError;
use rungc_rt::{Class, Plc as _};
use rungc_sim::record::Reading;
use rungc_sim::session::{self, Session};
use rungc_sim::{Target, check_lasts};
use rungc_syntax::FittedModule;
use std::time::Duration;

/// Value of a device.
#[derive(Clone, PartialEq, Debug)]
pub enum Value {
    /// A bit: X, Y, M, S.
    Bit(bool),
    /// A word, a pair of words, a group of bits, the current value of a timer or counter.
    Int(i64),
    /// A float: `D0.f32`.
    Float(f64),
    /// Characters: `D0.text`.
    Text(String),
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Value::Bit(value)
    }
}

impl From<i32> for Value {
    fn from(value: i32) -> Self {
        Value::Int(value.into())
    }
}

impl From<i64> for Value {
    fn from(value: i64) -> Self {
        Value::Int(value)
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Value::Float(value)
    }
}

impl Value {
    /// The value as a number: bits are 0 or 1.
    fn number(&self) -> Result<f64, Error> {
        match self {
            Value::Bit(on) => Ok(u8::from(*on).into()),
            Value::Int(value) => Ok(*value as f64),
            Value::Float(value) => Ok(*value),
            Value::Text(_) => Err(Error::Device("characters cannot be set here".to_string())),
        }
    }
}

/// A moment of a [`Plc`], to come back to.
#[derive(Clone)]
pub struct Snapshot {
    /// The program.
    id: u64,
    session: session::Moment,
    next_ms: u64,
}

/// A PLC that runs in virtual time, on the reference interpreter.
///
/// Devices are named as in test files and on the command line: `X000`, `D0`, `D0.i32`, `D0.f32`, `K4M0`, or by a
/// comment of the program. Inputs keep the state that they are set to.
pub struct Plc<'p> {
    session: Session<'p>,
    /// The program.
    source: Source<'p>,
    /// Its number.
    id: u64,
    /// Time at which the next scan begins.
    next_ms: u64,
}

impl<'p> Plc<'p> {
    /// A PLC at power-on, with a program and its number.
    pub(crate) fn new(source: Source<'p>, id: u64, modules: &[FittedModule]) -> Self {
        Plc {
            session: Session::new(source.module, session::hardware(modules)),
            source,
            id,
            next_ms: 0,
        }
    }

    /// Time since power-on.
    pub fn now(&self) -> Duration {
        Duration::from_millis(self.session.now_ms())
    }

    /// Lets time pass, with the scans that begin in it: one every 10 ms, or with the constant scan time that the
    /// program asks for. The last one ends before it returns.
    pub fn run_for(&mut self, time: Duration) {
        let end_ms = self.session.now_ms() + time.as_millis() as u64;
        while self.session.now_ms() < end_ms {
            let now_ms = self.session.now_ms();
            if self.next_ms <= now_ms {
                let scan_ms = self.session.scan_ms(None);
                self.session.scan(scan_ms);
                self.next_ms = now_ms + self.session.scan_ms(None);
            }
            self.session.pass(self.next_ms.min(end_ms) - now_ms);
        }
    }

    /// Time until the next scan begins; while one is due, until the one after it.
    pub fn until_next_scan(&self) -> Duration {
        let left_ms = self.next_ms.saturating_sub(self.session.now_ms());
        Duration::from_millis(match left_ms {
            0 => self.session.scan_ms(None),
            left_ms => left_ms,
        })
    }

    /// Executes the next scan, and lets its time pass.
    pub fn scan(&mut self) {
        let wait_ms = self.next_ms.saturating_sub(self.session.now_ms());
        let scan_ms = self.session.scan_ms(None);
        self.run_for(Duration::from_millis(wait_ms + scan_ms));
    }

    /// Value of a device.
    ///
    /// # Errors
    /// A name that no device has, or a device that the model does not have.
    pub fn get(&self, name: &str) -> Result<Value, Error> {
        let target = self.target(name)?;
        Ok(match self.session.reading(target) {
            Some(Reading::Bit(on)) => Value::Bit(on),
            Some(Reading::Integer(value, _)) => Value::Int(value),
            Some(Reading::Float(value)) => Value::Float(value),
            Some(Reading::Text(text)) => Value::Text(text),
            None => return Err(self.missing(target)),
        })
    }

    /// State of a bit.
    ///
    /// # Errors
    /// Those of [`get`](Self::get), and a device that is not a bit.
    pub fn bit(&self, name: &str) -> Result<bool, Error> {
        match self.get(name)? {
            Value::Bit(on) => Ok(on),
            _ => Err(Error::Device(format!("`{name}` is not a bit"))),
        }
    }

    /// Value of a word, a pair, a group of bits, a timer or a counter.
    ///
    /// # Errors
    /// Those of [`get`](Self::get), and a device that does not hold an integer.
    pub fn int(&self, name: &str) -> Result<i64, Error> {
        match self.get(name)? {
            Value::Int(value) => Ok(value),
            _ => Err(Error::Device(format!("`{name}` does not hold an integer"))),
        }
    }

    /// Value of a float, or a signal at a channel of a module.
    ///
    /// # Errors
    /// Those of [`get`](Self::get), and a device that does not hold a float.
    pub fn float(&self, name: &str) -> Result<f64, Error> {
        match self.get(name)? {
            Value::Float(value) => Ok(value),
            _ => Err(Error::Device(format!("`{name}` does not hold a float"))),
        }
    }

    /// Sets a device between two scans. An input that changes has an edge, which interrupts the program if it is set up
    /// so.
    ///
    /// # Errors
    /// A name that no device has, a value that does not fit, a device that each scan sets.
    pub fn set(&mut self, name: &str, value: impl Into<Value>) -> Result<(), Error> {
        let (target, value) = self.settable(name, value.into())?;
        let set = self.session.set(target, value);
        set.ok_or_else(|| self.missing(target))?;
        self.session.take_interrupts();
        Ok(())
    }

    /// Sets a device, and keeps its value whatever the program does, until it is released.
    ///
    /// # Errors
    /// Those of [`set`](Self::set), and a device of which another name is forced.
    pub fn force(&mut self, name: &str, value: impl Into<Value>) -> Result<(), Error> {
        let (target, value) = self.settable(name, value.into())?;
        self.session.force(target, value).map_err(Error::Device)?;
        self.session.take_interrupts();
        Ok(())
    }

    /// Releases a forced device.
    ///
    /// # Errors
    /// A name that no device has, a device that is not forced.
    pub fn release(&mut self, name: &str) -> Result<(), Error> {
        let target = self.target(name)?;
        self.session.release(target).map_err(Error::Device)
    }

    /// Returns true in RUN.
    pub fn is_running(&self) -> bool {
        self.session.machine().sys().running
    }

    /// Turns the RUN/STOP switch.
    pub fn set_running(&mut self, running: bool) {
        self.session.set_running(running);
    }

    /// Switches the power supply off and on. Latched devices, the clock and input terminals stay as they are; time
    /// begins at 0 again.
    pub fn power_cycle(&mut self) {
        self.session.power_cycle();
        self.next_ms = 0;
    }

    /// Operation errors since power-on, by instruction.
    pub fn errors(&self) -> &[OperationError] {
        self.session.machine().errors()
    }

    /// The present moment.
    pub fn save(&self) -> Snapshot {
        Snapshot {
            id: self.id,
            session: self.session.save(),
            next_ms: self.next_ms,
        }
    }

    /// Goes to a moment of this PLC, or of another one that runs the same program.
    ///
    /// # Errors
    /// A moment of another program.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        if self.id != snapshot.id {
            return Err(Error::OtherProgram);
        }
        self.session.restore(&snapshot.session);
        self.next_ms = snapshot.next_ms;
        Ok(())
    }

    /// Its session, for the crates below this one.
    pub fn session(&mut self) -> &mut Session<'p> {
        &mut self.session
    }

    /// Its program, and the session that runs it.
    pub(crate) fn explained(&mut self) -> (&Source<'p>, &mut Session<'p>) {
        (&self.source, &mut self.session)
    }

    /// The device of a name, as the methods above read it.
    ///
    /// # Errors
    /// A name that no device has.
    pub fn target(&self, name: &str) -> Result<Target, Error> {
        self.source.names.target(name).map_err(Error::Device)
    }

    /// A device, and a value that it keeps until the program reads it.
    ///
    /// # Errors
    /// A name that no device has, a value that does not fit, a device that each scan sets.
    pub fn settable(&self, name: &str, value: Value) -> Result<(Target, f64), Error> {
        let (target, value) = (self.target(name)?, value.number()?);
        crate::names::fits(target, value).map_err(Error::Device)?;
        let machine = self.session.machine();
        let lasts = check_lasts(machine.module().model, target, |relay| {
            machine.bit(Class::M, relay.number()) == Some(true)
        });
        lasts.map_err(Error::Device)?;
        Ok((target, value))
    }

    fn missing(&self, target: Target) -> Error {
        let model = self.session.machine().module().model.title;
        Error::Device(format!("`{target}` does not exist on {model}"))
    }
}
