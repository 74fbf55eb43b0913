//! Runs on the other engines: emitted C and Rust must do what the interpreter does.

use crate::model::{CounterPart, Key, TimerPart};
use crate::replay::{Run, STOP_MS, in_order, start, until_next_ms};
use crate::search::{Scan, Trace};
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, Plc};
use rungc_sim::engines::{Engine, EngineError};
use rungc_sim::protocol::{Answer, Request};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Difference between an engine and the interpreter.
#[derive(thiserror::Error, Debug)]
pub enum Mismatch {
    /// A device has another value.
    #[error("after scan {scan}, {device} is {there} there and {here} on the interpreter")]
    Value {
        /// After which scan, from 1.
        scan: usize,
        /// The device.
        device: String,
        /// Its value on the engine.
        there: i64,
        /// Its value on the interpreter.
        here: i64,
    },
    /// The engine failed.
    #[error(transparent)]
    Engine(#[from] EngineError),
}

/// Runs a trace on program `number` of an engine, which is this module, and on the interpreter, and compares the
/// devices after every scan.
///
/// # Errors
///
/// The first difference.
pub fn compare(
    engine: &mut dyn Engine,
    (number, module): (usize, &Module),
    devices: &[(DeviceClass, u32)],
    trace: &Trace,
) -> Result<(), Mismatch> {
    engine.execute(Request::Case(number))?;
    let mut run = Run::new(module, trace);
    for (key, value) in start(module, trace) {
        set(engine, key, value)?;
    }
    let mut there = There {
        engine,
        takes_events: module.takes_events(),
        now_ms: 0,
        inputs: BTreeMap::new(),
    };
    for (n, scan) in trace.scans.iter().enumerate() {
        there.scan(scan, n == 0)?;
        run.scan(scan);
        let engine = &mut *there.engine;
        let asked = devices
            .iter()
            .filter_map(|&device| Some((device, question(device)?)));
        for ((class, number), request) in asked {
            let (here, there) = (value(run.machine(), request), engine.execute(request)?);
            if let (Some(here), Answer::Value(there)) = (here, there)
                && here != there
            {
                return Err(Mismatch::Value {
                    scan: n + 1,
                    device: class.number(number).to_string(),
                    there,
                    here,
                });
            }
        }
    }
    Ok(())
}

/// A program on another engine.
struct There<'e> {
    engine: &'e mut dyn Engine,
    takes_events: bool,
    now_ms: u32,
    /// States of input terminals.
    inputs: BTreeMap<u32, bool>,
}

impl There<'_> {
    /// Executes a scan as [`Run::scan`] does.
    fn scan(&mut self, scan: &Scan, is_first: bool) -> Result<(), EngineError> {
        self.pass(until_next_ms(scan))?;
        if scan.restart {
            self.engine.execute(Request::Run(false))?;
            self.execute(STOP_MS * 1000)?;
            self.pass(STOP_MS)?;
            self.engine.execute(Request::Run(true))?;
        }
        for (key, value) in in_order(&scan.set) {
            if let Key::Bit(DeviceClass::X, number) = key {
                let (on, before) = (value != 0, self.inputs.insert(number, value != 0));
                if self.takes_events && !is_first && before.unwrap_or(false) != on {
                    self.engine.execute(Request::Edge(number, on))?;
                }
            }
            set(self.engine, key, value)?;
        }
        self.execute(scan.scan_time * 100)
    }

    fn execute(&mut self, scan_us: u32) -> Result<(), EngineError> {
        let now_ms = self.now_ms;
        self.engine.execute(Request::Scan { now_ms, scan_us })?;
        Ok(())
    }

    /// Lets time pass, as test files do.
    fn pass(&mut self, ms: u32) -> Result<(), EngineError> {
        if !self.takes_events {
            self.now_ms = self.now_ms.wrapping_add(ms);
            return Ok(());
        }
        for _ in 0..ms {
            self.now_ms = self.now_ms.wrapping_add(1);
            self.engine.execute(Request::Tick(self.now_ms))?;
            self.engine.execute(Request::Interrupts)?;
        }
        Ok(())
    }
}

/// Gives a piece of memory its value, as on the interpreter.
fn set(engine: &mut dyn Engine, key: Key, value: i64) -> Result<(), EngineError> {
    let bit = |class, number| Request::SetBit(class, number, value != 0);
    let request = match key {
        Key::Buffer(module, address) => {
            Some(Request::SetBfm(module.into(), address as u16, value as i16))
        }
        Key::Bit(class, number) => rt_class(class).map(|class| bit(class, number)),
        Key::Timer(number, TimerPart::Done) => Some(bit(Class::T, number)),
        Key::Counter(number, CounterPart::Done) => Some(bit(Class::C, number)),
        Key::Word(class, number) => {
            rt_class(class).map(|class| Request::SetWord(class, number, value as i16))
        }
        Key::Timer(number, TimerPart::Value) => {
            Some(Request::SetWord(Class::T, number, value as i16))
        }
        Key::Counter(number, CounterPart::Value) => {
            Some(match is_counter32(DeviceClass::C, number) {
                true => Request::SetDouble(Class::C, number, value as i32),
                false => Request::SetWord(Class::C, number, value as i16),
            })
        }
        _ => None,
    };
    request.map_or(Ok(()), |request| engine.execute(request).map(|_| ()))
}

/// Request for a device's value.
fn question((class, number): (DeviceClass, u32)) -> Option<Request> {
    use DeviceClass::{C, D, ER, M, R, S, T, V, X, Y, Z};
    let of = rt_class(class)?;
    Some(match class {
        X | Y | M | S | T => Request::Bit(of, number),
        C if is_counter32(class, number) => Request::Double(of, number),
        C => Request::Bit(of, number),
        D | R | ER | V | Z => Request::Word(of, number),
        _ => return None,
    })
}

/// The answer of the interpreter.
fn value(machine: &Machine, request: Request) -> Option<i64> {
    match request {
        Request::Bit(class, number) => machine.bit(class, number).map(i64::from),
        Request::Word(class, number) => machine.word(class, number).map(i64::from),
        Request::Double(_, number) => machine.counter32(number).map(i64::from),
        _ => None,
    }
}
