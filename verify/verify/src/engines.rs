//! Runs on the other engines: emitted C and Rust must do what the interpreter does.

use crate::model::{CounterPart, Key, TimerPart};
use crate::replay::{Run, start};
use crate::search::Trace;
use rungc_interp::{Machine, rt_class};
use rungc_ir::Module;
use rungc_models::runs::is_counter32;
use rungc_rt::{Class, Plc};
use rungc_sim::engines::{Engine, EngineError};
use rungc_sim::protocol::{Answer, Request};
use rungc_syntax::DeviceClass;

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
    let mut now_ms = 0u32;
    for (n, scan) in trace.scans.iter().enumerate() {
        if scan.restart {
            engine.execute(Request::Run(false))?;
            engine.execute(Request::Scan { now_ms, scan_us: 0 })?;
            engine.execute(Request::Run(true))?;
        }
        for (&key, &value) in &scan.set {
            set(engine, key, value)?;
        }
        now_ms = now_ms.wrapping_add(scan.ms);
        engine.execute(Request::Scan {
            now_ms,
            scan_us: scan.scan_time * 100,
        })?;
        run.scan(scan);
        let asked = devices
            .iter()
            .filter_map(|&device| Some((device, question(device)?)));
        for ((class, number), request) in asked {
            let (here, there) = (value(&run.machine, request), engine.execute(request)?);
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
