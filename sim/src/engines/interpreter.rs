//! The reference interpreter as an engine.

use super::{Engine, EngineError};
use crate::protocol::{Answer, Request};
use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_rt::{Class, Cx, Operand, Plc, Program, Site, VirtualHal};

/// The reference interpreter and virtual hardware.
pub struct Interpreter<'m> {
    modules: &'m [Module],
    machine: Option<Machine<'m>>,
    hal: VirtualHal,
}

impl<'m> Interpreter<'m> {
    /// An engine for these programs.
    pub fn new(modules: &'m [Module]) -> Self {
        Interpreter {
            modules,
            machine: None,
            hal: VirtualHal::new(),
        }
    }
}

/// The access to a pair or 32-bit counter that an instruction has.
fn double<'a>(machine: &'a mut Machine<'_>, hal: &'a mut VirtualHal, op: &'a [Operand]) -> Cx<'a> {
    Cx::new(machine, hal, op, Site::at(0).wide())
}

fn operand(class: Class, number: u32) -> Operand {
    Operand::device(class, i32::try_from(number).unwrap_or(i32::MAX))
}

impl Engine for Interpreter<'_> {
    fn name(&self) -> &str {
        "interp"
    }

    fn ask(&mut self, request: Request) -> Result<Answer, EngineError> {
        if let Request::Case(i) = request {
            let module = self.modules.get(i).ok_or(EngineError::NoProgram(i))?;
            self.machine = Some(Machine::new(module));
            self.hal = VirtualHal::new();
            return Ok(Answer::Ok);
        }
        let hal = &mut self.hal;
        let machine = self.machine.as_mut().ok_or(EngineError::NoProgram(0))?;
        Ok(match request {
            Request::Case(_) | Request::Exit => Answer::Ok,
            Request::SetBit(class, n, value) => Answer::done(machine.set_bit(class, n, value)),
            Request::SetWord(class, n, value) => Answer::done(machine.set_word(class, n, value)),
            Request::SetDouble(class, n, value) => {
                let ops = [operand(class, n)];
                let done = double(machine, hal, &ops).set_dword(0, 0, value);
                Answer::done(done.ok())
            }
            Request::Bit(class, n) => Answer::value(machine.bit(class, n)),
            Request::Word(class, n) => Answer::value(machine.word(class, n)),
            Request::Double(class, n) => {
                let ops = [operand(class, n)];
                Answer::value(double(machine, hal, &ops).dword(0, 0).ok())
            }
            Request::Scan { now_ms, scan_us } => {
                hal.advance_to(now_ms);
                machine.scan(hal, now_ms, scan_us);
                Answer::Ok
            }
            Request::Edge(n, level) => {
                machine.input_edge(hal, n, level);
                Answer::Ok
            }
            Request::Tick(now_ms) => {
                machine.tick(hal, now_ms);
                Answer::Ok
            }
            Request::Interrupts => {
                machine.take_interrupts(hal);
                Answer::Ok
            }
            Request::Output(n) => Answer::value(Some(machine.output(n))),
            Request::Pulses(n) => Answer::value(Some(machine.pulses_sent(n))),
            Request::Frequency(n) => Answer::value(Some(machine.pulse_millihertz(n))),
            Request::Run(running) => {
                machine.set_running(running);
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
            Request::SetClock(clock) => Answer::done(rungc_rt::Hal::set_clock(hal, clock)),
            Request::SetAnalog(channel, value) => Answer::done(hal.set_analog(channel, value)),
        })
    }
}
