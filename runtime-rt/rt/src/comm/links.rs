//! A port on a link that PLCs keep up by themselves, and on-demand transmission of a computer link.

use super::computer_link::on_demand::{self, Devices};
use super::link::Role;
use super::port::{FRAME, Session};
use super::slaves;
use super::wiring::{Ports, Protocol};
use super::{Frame, Memory, Served};

impl Session<'_> {
    /// Role of the port on a link.
    fn role(&self) -> Option<Role> {
        slaves::role(self.status.protocol, self.status.uinit[2])
    }

    /// Forgets what a slave keeps, when the protocol changes.
    pub(super) fn forget(&mut self) {
        let port = self.plc.port(self.own.wiring.number);
        if let Some(memory) = port.and_then(|port| port.memory) {
            *memory = Memory::new();
        }
    }

    /// Takes a frame of a link.
    pub(super) fn take_linked(&mut self, received: usize) {
        let Some(role) = self.role() else {
            return;
        };
        let buffer = self.copy_frame::<FRAME>();
        let mut map = Served::new(self.plc, 0);
        let frame = buffer.get(..received).unwrap_or_default();
        let taken = self
            .own
            .progress
            .link
            .receive(role, frame, self.now_us, &mut map);
        if let Err(fault) = taken {
            self.note(fault);
        }
    }

    /// Sends what the link has to send.
    pub(super) fn advance_link(&mut self) {
        let Some(role) = self.role() else {
            return;
        };
        if self.status.sending || self.status.open {
            return;
        }
        let mut bytes = [0; FRAME];
        let mut frame = Frame::new(&mut bytes);
        let mut map = Served::new(self.plc, 0);
        let polled = self
            .own
            .progress
            .link
            .poll(role, self.now_us, &mut map, &mut frame);
        let length = frame.len();
        if let Err(fault) = polled {
            self.note(fault);
        }
        self.send_now(&bytes[..length]);
    }

    /// The devices of on-demand transmission, if the port has them.
    fn on_demand(&self) -> Option<Devices> {
        let has = self.status.protocol == Protocol::ComputerLink
            && matches!(
                self.plc.ports(),
                Ports::Inovance | Ports::L01s | Ports::Fx | Ports::Fx3 | Ports::Fx3g
            );
        self.own.wiring.on_demand().filter(|_| has)
    }

    /// Sends what the program asks to be sent on demand.
    pub(super) fn advance_on_demand(&mut self) {
        let Some(devices) = self.on_demand() else {
            return;
        };
        if self.status.sending || self.status.open || !self.plc.sys().running {
            return;
        }
        let settings = self.slave().computer_link();
        let mut bytes = [0; FRAME];
        let mut frame = Frame::new(&mut bytes);
        let mut map = Served::new(self.plc, 0);
        on_demand::request(settings, devices, &mut map, &mut frame);
        let length = frame.len();
        self.send_now(&bytes[..length]);
    }

    /// A frame has been sent.
    pub(super) fn end_on_demand(&mut self) {
        if let Some(devices) = self.on_demand() {
            on_demand::sent(devices, &mut Served::new(self.plc, 0));
        }
    }

    /// Begins to send a frame that answers nothing.
    fn send_now(&mut self, frame: &[u8]) {
        if !frame.is_empty() {
            self.begin_sending(frame, 0);
            self.status.due_us = self.now_us;
        }
    }
}
