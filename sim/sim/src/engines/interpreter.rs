//! The reference interpreter as an engine.

use super::{Engine, EngineError};
use crate::protocol::{Answer, Digest, Request};
use crate::target::Channel;
use rungc_interp::{MOST_RESTARTS, Machine, Observer, Saved};
use rungc_ir::Module;
use rungc_rt::modules::{KINDS, Signal};
use rungc_rt::{Class, Cx, FIRST_COUNTER32, Operand, Plc, Program, Site, VirtualHal};

/// The reference interpreter and virtual hardware.
pub struct Interpreter<'m> {
    modules: Vec<&'m Module>,
    /// The PLCs of the case.
    plcs: Vec<Station<'m>>,
    /// Those of the case before it.
    idle: Vec<Station<'m>>,
    /// Index of the selected machine.
    current: usize,
    /// Makes who looks on, for the program of a number.
    observers: Option<Observers<'m>>,
}

/// A PLC with its hardware.
struct Station<'m> {
    /// The number of its program.
    program: usize,
    machine: Machine<'m>,
    hal: VirtualHal,
    /// The machine at power-on, once its program was requested again: to come back to that takes a tenth of the time of
    /// making it.
    fresh: Option<Box<Saved>>,
}

/// Makes those who look on, by the number of the program.
pub type Observers<'m> = Box<dyn FnMut(usize) -> Box<dyn Observer> + 'm>;

impl<'m> Interpreter<'m> {
    /// An engine for these programs.
    pub fn new(modules: impl IntoIterator<Item = &'m Module>) -> Self {
        Interpreter {
            modules: modules.into_iter().collect(),
            plcs: Vec::new(),
            idle: Vec::new(),
            current: 0,
            observers: None,
        }
    }

    /// An engine for these programs, whose execution others look on.
    pub fn observed(
        modules: impl IntoIterator<Item = &'m Module>,
        observers: Observers<'m>,
    ) -> Self {
        Interpreter {
            observers: Some(observers),
            ..Interpreter::new(modules)
        }
    }
}

/// The access to a pair or 32-bit counter that an instruction has.
fn double<'a>(machine: &'a mut Machine<'_>, hal: &'a mut VirtualHal, op: &'a [Operand]) -> Cx<'a> {
    Cx::new(machine, hal, op, Site::at(0).wide())
}

/// Value of a pair or 32-bit counter.
fn value_of(machine: &mut Machine, hal: &mut VirtualHal, (class, n): (Class, u32)) -> Option<i32> {
    let ops = [operand(class, n)];
    double(machine, hal, &ops).dword(0, 0).ok()
}

/// Of all that devices hold: bits, words and 32-bit counters, and terminals of outputs.
fn digest(machine: &Machine, class: Class, first: u32, count: u32) -> Digest {
    let numbers = first..first.saturating_add(count);
    numbers.fold(Digest::new(), |digest, n| {
        let digest = digest
            .with(machine.bit(class, n))
            .with(machine.word(class, n));
        match class {
            Class::Y => digest.with(Some(machine.output(n))),
            Class::C if n >= FIRST_COUNTER32 => digest.with(machine.counter32(n)),
            _ => digest,
        }
    })
}

fn operand(class: Class, number: u32) -> Operand {
    Operand::device(class, i32::try_from(number).unwrap_or(i32::MAX))
}

/// Applies an event between two scans.
fn happen(machine: &mut Machine, hal: &mut VirtualHal, request: Request) {
    match request {
        Request::Edge(n, level) => machine.input_edge(hal, n, level),
        Request::Tick(now_ms) => machine.tick(hal, now_ms),
        _ => machine.take_interrupts(hal),
    }
}

/// A scan, which WDT must let end.
fn scan(
    machine: &mut Machine,
    hal: &mut VirtualHal,
    now_ms: u32,
    scan_us: u32,
) -> Result<Answer, EngineError> {
    hal.scan(machine, now_ms, scan_us);
    match machine.is_endless() {
        true => Err(EngineError::Endless(MOST_RESTARTS)),
        false => Ok(Answer::Ok),
    }
}

/// Answer to a request about outputs and their pulses; `None` for other requests.
fn sent(machine: &mut Machine, request: Request) -> Option<i64> {
    Some(match request {
        Request::Output(n) => machine.output(n).into(),
        Request::Pulses(n) => machine.pulses_sent(n).into(),
        Request::Frequency(n) => machine.pulse_millihertz(n).into(),
        Request::Pass {
            from_us,
            until_us,
            most,
        } => rungc_rt::pass_pulses(machine, from_us, until_us, most).into(),
        _ => return None,
    })
}

fn set_signal(hal: &mut VirtualHal, channel: Channel, millionths: i32) -> Answer {
    let quantity = channel.quantity;
    let signal = Signal {
        quantity,
        millionths,
    };
    Answer::done(hal.set_signal(channel.unit, channel.number, signal))
}

impl Interpreter<'_> {
    /// Adds a PLC with the program of this number.
    fn join(&mut self, number: usize) -> Result<Answer, EngineError> {
        let module = self.modules.get(number).copied();
        let module = module.ok_or(EngineError::NoProgram(number))?;
        let known = self.idle.iter().position(|plc| plc.program == number);
        let (mut machine, fresh) = match known.map(|at| self.idle.swap_remove(at)) {
            Some(Station {
                mut machine,
                fresh: Some(fresh),
                ..
            }) => {
                machine.restore(&fresh);
                (machine, Some(fresh))
            }
            again => {
                let machine = Machine::new(module);
                let fresh = again.map(|_| Box::new(machine.save()));
                (machine, fresh)
            }
        };
        if let Some(observers) = &mut self.observers {
            machine.observe(observers(number));
        }
        self.plcs.push(Station {
            program: number,
            machine,
            hal: VirtualHal::new(),
            fresh,
        });
        Ok(Answer::Ok)
    }
}

impl Engine for Interpreter<'_> {
    fn name(&self) -> &str {
        "interp"
    }

    fn execute(&mut self, request: Request) -> Result<Answer, EngineError> {
        match request {
            Request::Case(i) => {
                if i < self.modules.len() {
                    self.idle = std::mem::take(&mut self.plcs);
                    self.current = 0;
                }
                return self.join(i);
            }
            Request::Join(i) => return self.join(i),
            Request::Plc(i) => self.current = i,
            _ => {}
        }
        let plc = self.plcs.get_mut(self.current);
        let Station { machine, hal, .. } = plc.ok_or(EngineError::NoProgram(self.current))?;
        Ok(match request {
            Request::Case(_) | Request::Join(_) | Request::Plc(_) | Request::Exit => Answer::Ok,
            Request::SetBit(class, n, value) => Answer::done(machine.set_bit(class, n, value)),
            Request::SetWord(class, n, value) => Answer::done(machine.set_word(class, n, value)),
            Request::SetDouble(class, n, value) => {
                let ops = [operand(class, n)];
                let done = double(machine, hal, &ops).set_dword(0, 0, value);
                Answer::done(done.ok())
            }
            Request::Bit(class, n) => Answer::value(machine.bit(class, n)),
            Request::Word(class, n) => Answer::value(machine.word(class, n)),
            Request::Double(class, n) => Answer::value(value_of(machine, hal, (class, n))),
            Request::Digest(class, first, count) => {
                Answer::Value(digest(machine, class, first, count).value())
            }
            Request::Scan { now_ms, scan_us } => scan(machine, hal, now_ms, scan_us)?,
            Request::ConstantScan => Answer::value(Some(machine.constant_scan_ms().unwrap_or(0))),
            Request::Edge(..) | Request::Tick(_) | Request::Interrupts => {
                happen(machine, hal, request);
                Answer::Ok
            }
            Request::Output(_)
            | Request::Pulses(_)
            | Request::Pass { .. }
            | Request::Frequency(_) => Answer::value(sent(machine, request)),
            Request::Receive(port, character) => {
                Answer::done(hal.line(port).and_then(|line| line.feed(character)))
            }
            Request::Sent(port, now_us) => {
                Answer::value(hal.line(port).and_then(|line| line.take_packed(now_us)))
            }
            Request::Line(port) => Answer::value(hal.line(port).map(|line| line.format().packed())),
            Request::Run(running) => {
                machine.set_running(running);
                hal.set_running(running);
                Answer::Ok
            }
            Request::Power => {
                hal.restart();
                machine.power_cycle();
                Answer::Ok
            }
            Request::SetBfm(unit, address, value) => {
                Answer::done(hal.set_bfm(unit, address, value))
            }
            Request::Bfm(unit, address) => Answer::value(hal.bfm(unit, address)),
            Request::Fit(unit, kind) => {
                Answer::done(KINDS.get(kind).and_then(|kind| hal.fit(unit, kind)))
            }
            Request::DelayModule(unit, ms) => Answer::done(hal.delay_module(unit, ms)),
            Request::SetSignal {
                now_ms,
                channel,
                millionths,
            } => {
                hal.advance_to(now_ms);
                set_signal(hal, channel, millionths)
            }
            Request::Signal { now_ms, channel } => {
                hal.advance_to(now_ms);
                Answer::value(hal.signal(channel.unit, channel.number, channel.quantity))
            }
            Request::SetPowerFails(fails) => {
                hal.set_power_fails(fails);
                Answer::Ok
            }
            Request::SetClock(clock) => Answer::done(rungc_rt::Hal::set_clock(hal, clock)),
            Request::SetAnalog(channel, value) => Answer::done(hal.set_analog(channel, value)),
        })
    }
}
