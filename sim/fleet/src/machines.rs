//! Interpreters, for programs that do not run in lanes.

use crate::engine::{At, Engine, Failed, FleetError};
use rungc_ir::Module;
use rungc_rt::{Class, FIRST_COUNTER32, Plc, Program, Stop, VirtualHal};
use rungc_sim::Session;
use rungc_sim::threads::Threads;
use std::thread;

/// From how many PLCs on they are divided among threads.
const WORTH_THREADS: usize = 16;

/// PLCs, each an interpreter with its own virtual hardware.
pub struct Machines<'m> {
    plcs: Vec<Session<'m>>,
    now_ms: u32,
}

impl<'m> Machines<'m> {
    /// Switches `count` PLCs on, each with its own copy of the hardware.
    pub fn new(module: &'m Module, count: u32, hal: &VirtualHal) -> Self {
        let one = |_| Session::new(module, hal.clone());
        Machines {
            plcs: (0..count).map(one).collect(),
            now_ms: 0,
        }
    }

    fn one(&self, plc: u32) -> Option<&Session<'m>> {
        self.plcs.get(plc as usize)
    }
}

impl Engine for Machines<'_> {
    fn begin_scan(&mut self, now_ms: u32, scan_us: u32) {
        let before_ms = std::mem::replace(&mut self.now_ms, now_ms);
        let passed_ms = now_ms.wrapping_sub(before_ms);
        let scan = |plcs: &mut [Session]| {
            for plc in plcs {
                plc.pass(passed_ms.into());
                plc.scan_us(scan_us);
            }
        };
        let jobs = Threads::usual().count();
        if self.plcs.len() < WORTH_THREADS || jobs == 1 {
            return scan(&mut self.plcs);
        }
        let part = self.plcs.len().div_ceil(jobs);
        thread::scope(|scope| {
            for plcs in self.plcs.chunks_mut(part) {
                scope.spawn(move || scan(plcs));
            }
        });
    }

    fn end_scan(&mut self) -> Result<(), FleetError> {
        Ok(())
    }

    fn read(&mut self, plc: u32, at: At) -> Option<i32> {
        let machine = self.one(plc)?.machine();
        match at.class {
            Class::X | Class::Y | Class::M | Class::S => {
                machine.bit(at.class, at.number).map(i32::from)
            }
            _ if at.contact => machine.bit(at.class, at.number).map(i32::from),
            Class::C if at.number >= FIRST_COUNTER32 => machine.counter32(at.number),
            class => machine.word(class, at.number).map(i32::from),
        }
    }

    fn write(&mut self, plc: u32, at: At, value: i32) -> Option<()> {
        let (machine, hal) = self.plcs.get_mut(plc as usize)?.parts();
        let (class, number) = (at.class, at.number);
        match class {
            Class::X | Class::Y | Class::M | Class::S => {
                let before = machine.bit(class, number);
                machine.set_bit(class, number, value != 0)?;
                if class == Class::X && before != Some(value != 0) {
                    machine.input_edge(hal, number, value != 0);
                }
                Some(())
            }
            _ if at.contact => machine.set_bit(class, number, value != 0),
            Class::C if number >= FIRST_COUNTER32 => machine.set_counter32(number, value),
            class => machine.set_word(class, number, i16::try_from(value).ok()?),
        }
    }

    fn is_running(&mut self, plc: u32) -> bool {
        self.one(plc).is_some_and(|one| one.machine().sys().running)
    }

    fn set_running(&mut self, plc: u32, running: bool) -> bool {
        let one = self.plcs.get_mut(plc as usize);
        one.is_some_and(|one| {
            one.set_running(running);
            true
        })
    }

    fn failures(&mut self) -> Vec<Failed> {
        let of = |(plc, one): (usize, &Session)| {
            let plc = plc as u32;
            let errors = one.machine().errors().iter().map(move |error| Failed {
                plc,
                code: error.code,
                step: error.step,
                times: error.times,
                first_ms: Some(error.first_ms),
            });
            let last = one.machine().last_error();
            let stopped = (last.stop == Stop::Watchdog).then(|| Failed {
                plc,
                code: last.stop as u16,
                step: last.stop_step.into(),
                times: 1,
                first_ms: None,
            });
            errors.chain(stopped).collect::<Vec<_>>()
        };
        self.plcs.iter().enumerate().flat_map(of).collect()
    }

    fn what(&self) -> String {
        "on the interpreter".to_string()
    }
}
