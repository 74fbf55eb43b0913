//! A port as a Modbus master: it sends the request of the instruction in work, and takes the answer.

use super::modbus::{self, Framing, Limits};
use super::port::{Session, has_come};
use super::wiring::{Ports, Protocol};
use super::{Frame, LineFault, Served};

impl Session<'_> {
    /// Limits of one request.
    fn master_limits(&self) -> Limits {
        match (self.plc.ports(), self.status.protocol) {
            (Ports::L01s, Protocol::MasterAscii) => Limits::L01S_ASCII,
            (Ports::Fx3, _) => Limits::FX3,
            _ => self.plc.modbus().limits,
        }
    }

    /// Sends what is to be sent, and takes notice of time.
    pub(super) fn advance_master<const LENGTH: usize>(&mut self, framing: Framing) {
        self.forget_errors();
        if self.own.progress.exchange.is_sending() && !self.status.sending {
            self.own.progress.exchange.sent(self.now_us);
        }
        let waiting = self.own.progress.exchange.is_waiting();
        let receiving = self.status.open && (!waiting || self.answer_may_end(LENGTH));
        let tries = self.own.progress.exchange.tries();
        if self.own.progress.exchange.is_late(self.now_us, receiving) {
            self.note_exchange(LineFault::TimeOut, None);
        }
        if waiting && !self.own.progress.exchange.is_waiting() {
            self.drop_frame();
        }
        if self.own.progress.exchange.tries() != tries {
            self.show_tries();
        }
        let free = !self.status.sending && !receiving;
        let Some(job) = self.own.progress.exchange.to_send().filter(|_| free) else {
            return;
        };
        let mut bytes = [0; LENGTH];
        let mut frame = Frame::new(&mut bytes);
        let limits = self.master_limits();
        let map = Served::new(self.plc, 0);
        match modbus::request(framing, &limits, &job, &map, &mut frame) {
            Ok(()) => {
                let length = frame.len();
                self.own.progress.exchange.sending();
                self.begin_sending(&bytes[..length], 0);
                let modbus = self.own.wiring.modbus;
                let silence_us = modbus.map_or(0, |modbus| modbus.silence_us(self.plc));
                let due_us = self.status.last_us.wrapping_add(silence_us);
                let waits = silence_us > 0 && !has_come(self.now_us, due_us);
                self.status.due_us = if waits { due_us } else { self.now_us };
            }
            Err(fault) => {
                self.own.progress.exchange.fail();
                self.note_exchange(fault, None);
            }
        }
    }

    /// Returns true if an answer that has begun may still complete in time: each next character has a whole time-out,
    /// and the beginning has that plus the duration of the longest frame, of `longest` characters.
    fn answer_may_end(&self, longest: usize) -> bool {
        let exchange = &self.own.progress.exchange;
        let quiet_us = self.now_us.wrapping_sub(self.status.last_us);
        let frame_us = self.status.format.character_us() * longest as u32;
        let limit_us = exchange.time_out_us().saturating_add(frame_us);
        quiet_us < exchange.time_out_us() && exchange.waited_us(self.now_us) < limit_us
    }

    /// Shows how often the request has been sent again (FX3).
    fn show_tries(&mut self) {
        if let Some(modbus) = self.own.wiring.modbus {
            modbus.tried().set(self.plc, true);
            let tries = self.own.progress.exchange.tries();
            modbus.tries().set(self.plc, tries.into());
        }
    }

    /// The beginning of RUN clears errors (FX3).
    fn forget_errors(&mut self) {
        let begins = self.plc.sys().running && self.plc.sys().first_scan;
        if let Some(modbus) = self.own.wiring.modbus
            && begins
            && self.own.progress.exchange.is_free()
        {
            modbus.clear(self.plc);
        }
    }

    /// Shows why an exchange has failed; `refusal` is the function and the code of an answer that rejects it.
    fn note_exchange(&mut self, fault: LineFault, refusal: Option<[u8; 2]>) {
        /// The answer rejects the request (FX3).
        const REFUSED: u16 = 212;
        let Some(modbus) = self.own.wiring.modbus else {
            return self.note(fault);
        };
        if !modbus.failed_since_run().is_on(self.plc) {
            let step = self.own.progress.exchange.owner().wrapping_sub(1);
            modbus.failed_step().set(self.plc, step as u16);
        }
        match refusal.map(u16::from_be_bytes) {
            Some(details) => self.own.wiring.note_modbus(self.plc, REFUSED, details),
            None => self.note(fault),
        }
    }

    /// A frame of this many characters has come.
    pub(super) fn take_answer<const LENGTH: usize>(&mut self, framing: Framing, received: usize) {
        let buffer = self.copy_frame::<LENGTH>();
        let frame = buffer.get(..received).unwrap_or_default();
        let refusal = modbus::refusal(framing, self.own.progress.exchange.job(), frame);
        let mut map = Served::new(self.plc, 0);
        let taken = self.own.progress.exchange.receive(framing, frame, &mut map);
        if let Err(fault) = taken {
            self.note_exchange(fault, refusal);
        }
    }
}
