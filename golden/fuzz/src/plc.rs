//! A program in the interpreter with a partner on one of its serial ports.

use rungc_interp::Machine;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::comm::Received;
use rungc_rt::{Class, Plc as _, Program as _, VirtualHal};
use rustix::time::{ClockId, clock_gettime};

/// A scan begins every so often; ports are advanced every millisecond.
const SCAN_US: u64 = 10_000;

/// Compiles a program with all devices of the model and a port, for good.
pub fn module(model: ModelId, port: u8, text: &str) -> &'static Module {
    let read = rungc_frontend::read_text("program.il", text);
    let options = CompileOptions {
        model: Some(model),
        observe_all: true,
        ports: vec![port],
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let module = compiled
        .module
        .unwrap_or_else(|| panic!("{text}: {:?}", compiled.diagnostics));
    Box::leak(Box::new(module))
}

/// A running program and one of its ports.
pub struct Plc {
    machine: Machine<'static>,
    hal: Box<VirtualHal>,
    port: u8,
    /// Microseconds since power-on.
    now_us: u64,
    next_us: u64,
    /// The longest that a call has taken which advanced the ports, in nanoseconds of the processor's time.
    pub longest_ns: u64,
}

/// Processor time of this thread, in nanoseconds.
pub(crate) fn used_ns() -> u64 {
    let used = clock_gettime(ClockId::ThreadCPUTime);
    used.tv_sec as u64 * 1_000_000_000 + used.tv_nsec as u64
}

impl Plc {
    /// Powers on, and runs the scans that set up the port.
    pub fn new(module: &'static Module, port: u8) -> Self {
        let mut plc = Plc {
            machine: Machine::new(module),
            hal: Box::new(VirtualHal::new()),
            port,
            now_us: 0,
            next_us: 0,
            longest_ns: 0,
        };
        plc.wait(4 * SCAN_US);
        plc.sent();
        plc
    }

    /// Time passes.
    pub fn wait(&mut self, us: u64) {
        self.now_us += us;
        while self.next_us <= self.now_us {
            let now_ms = (self.next_us / 1000) as u32;
            self.hal.advance_to(now_ms);
            let before = used_ns();
            if self.next_us.is_multiple_of(SCAN_US) {
                self.machine.scan(&mut *self.hal, now_ms, SCAN_US as u32);
            } else {
                self.machine.tick(&mut *self.hal, now_ms);
            }
            self.longest_ns = self.longest_ns.max(used_ns() - before);
            self.next_us += 1000;
        }
    }

    /// Duration of a character.
    fn character_us(&mut self) -> u64 {
        let line = self.hal.line(self.port);
        line.map_or(1000, |line| line.format().character_us().into())
    }

    /// The partner sends bytes back to back.
    pub fn feed(&mut self, bytes: &[u8]) {
        let character_us = self.character_us();
        for &byte in bytes {
            self.wait(character_us);
            let character = Received {
                at_us: self.now_us as u32,
                byte,
                ..Received::new()
            };
            let line = self.hal.line(self.port).expect("the port is there");
            line.feed(character)
                .expect("the PLC takes characters in time");
        }
    }

    /// Characters sent by the PLC so far.
    pub fn sent(&mut self) -> Vec<u8> {
        let now_us = self.now_us as u32;
        let line = self.hal.line(self.port).expect("the port is there");
        std::iter::from_fn(|| line.take(now_us))
            .map(|character| character.byte)
            .collect()
    }

    /// Waits until the PLC has sent something and then nothing for a while, at most `us`.
    pub fn answer(&mut self, us: u64) -> Vec<u8> {
        let quiet_us = (4 * self.character_us()).max(2500);
        let (end_us, mut last_us) = (self.now_us + us, self.now_us);
        let mut answer = Vec::new();
        while self.now_us < end_us && (answer.is_empty() || self.now_us - last_us < quiet_us) {
            self.wait(1000);
            let sent = self.sent();
            if !sent.is_empty() {
                last_us = self.now_us;
            }
            answer.extend(sent);
        }
        answer
    }

    /// Register D; `None` if the model does not have it.
    pub fn d(&self, number: u32) -> Option<u16> {
        self.machine.word(Class::D, number).map(|word| word as u16)
    }

    /// All relays, states and outputs below special devices.
    pub fn bits(&self) -> Vec<bool> {
        let classes = [(Class::M, 1024), (Class::S, 1000), (Class::Y, 128)];
        let bits = classes
            .into_iter()
            .flat_map(|(class, count)| (0..count).map(move |n| (class, n)));
        bits.filter_map(|(class, n)| self.machine.bit(class, n))
            .collect()
    }

    /// The program's devices, for a server.
    pub fn devices(&mut self) -> &mut Machine<'static> {
        &mut self.machine
    }
}
