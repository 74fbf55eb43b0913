//! A program in the interpreter with a partner on one of its serial ports.

use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::comm::Received;
use rungc_rt::{Class, Plc as _, VirtualHal};
use rungc_sim::Session;
use rustix::time::{ClockId, clock_gettime};

/// Duration of a scan; ports are advanced every millisecond.
const SCAN_MS: u64 = 10;

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
    session: Session<'static>,
    port: u8,
    /// Microseconds since power-on.
    now_us: u64,
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
            session: Session::new(module, VirtualHal::new()),
            port,
            now_us: 0,
            longest_ns: 0,
        };
        plc.wait(4000 * SCAN_MS);
        plc.sent();
        plc
    }

    /// Time passes.
    pub fn wait(&mut self, us: u64) {
        self.now_us += us;
        while self.session.now_ms() < self.now_us / 1000 {
            let before = used_ns();
            if self.session.now_ms().is_multiple_of(SCAN_MS) {
                self.session.scan(SCAN_MS);
            }
            self.session.pass(1);
            self.longest_ns = self.longest_ns.max(used_ns() - before);
        }
    }

    /// Duration of a character.
    fn character_us(&mut self) -> u64 {
        let line = self.session.parts().1.line(self.port);
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
            let (_, hal) = self.session.parts();
            let line = hal.line(self.port).expect("the port is there");
            line.feed(character)
                .expect("the PLC takes characters in time");
        }
    }

    /// Characters sent by the PLC so far.
    pub fn sent(&mut self) -> Vec<u8> {
        let now_us = self.now_us as u32;
        let (_, hal) = self.session.parts();
        let line = hal.line(self.port).expect("the port is there");
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
        self.session
            .machine()
            .word(Class::D, number)
            .map(|word| word as u16)
    }

    /// All relays, states and outputs below special devices.
    pub fn bits(&self) -> Vec<bool> {
        let classes = [(Class::M, 1024), (Class::S, 1000), (Class::Y, 128)];
        let bits = classes
            .into_iter()
            .flat_map(|(class, count)| (0..count).map(move |n| (class, n)));
        bits.filter_map(|(class, n)| self.session.machine().bit(class, n))
            .collect()
    }

    /// The program's devices, for a server.
    pub fn devices(&mut self) -> &mut rungc_interp::Machine<'static> {
        self.session.machine_mut()
    }
}
