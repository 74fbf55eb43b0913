//! A port as a Modbus master: it sends the request of the instruction in work, and takes the answer.

use super::modbus::{self, Framing, Limits};
use super::port::{FRAME, Session};
use super::wiring::{Ports, Protocol};
use super::{Frame, LineFault, Served};

impl Session<'_> {
    /// RTU or ASCII.
    fn master_framing(&self) -> Framing {
        match self.status.protocol {
            Protocol::MasterAscii => Framing::Ascii,
            _ => Framing::Rtu,
        }
    }

    /// How much one request may be about.
    fn master_limits(&self) -> Limits {
        match (self.plc.ports(), self.status.protocol) {
            (Ports::L01s, Protocol::MasterAscii) => Limits::L01S_ASCII,
            _ => self.slave().profile().limits,
        }
    }

    /// Sends what is to be sent, and takes notice of time.
    pub(super) fn advance_master(&mut self) {
        if self.status.exchange.is_sending() && !self.status.sending {
            self.status.exchange.sent(self.now_us);
        }
        let receiving = self.status.open;
        if self.status.exchange.is_late(self.now_us, receiving) {
            self.note(LineFault::TimeOut);
        }
        let free = !self.status.sending && !receiving;
        let Some(job) = self.status.exchange.to_send().filter(|_| free) else {
            return;
        };
        let mut bytes = [0; FRAME];
        let mut frame = Frame::new(&mut bytes);
        let (framing, limits) = (self.master_framing(), self.master_limits());
        let map = Served::new(self.plc, 0);
        match modbus::request(framing, &limits, &job, &map, &mut frame) {
            Ok(()) => {
                let length = frame.len();
                self.status.exchange.sending();
                self.begin_sending(&bytes[..length], 0);
                self.status.due_us = self.now_us;
            }
            Err(fault) => {
                self.status.exchange.fail();
                self.note(fault);
            }
        }
    }

    /// A frame of this many characters has come.
    pub(super) fn take_answer(&mut self, received: usize) {
        let framing = self.master_framing();
        let Some(port) = self.plc.port(self.wiring.number) else {
            return;
        };
        let buffer = port.buffer;
        let mut map = Served::new(self.plc, 0);
        let taken = self
            .status
            .exchange
            .receive(framing, &buffer[..received], &mut map);
        if let Err(fault) = taken {
            self.note(fault);
        }
    }
}
