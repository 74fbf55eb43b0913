//! Protocols that the serial ports of a program may speak, as far as its set-up is known.

use super::Lowerer;
use rungc_analysis::check::ports::Choices;
use rungc_ir::layout::Wanted;
use rungc_rt::Ports;
use rungc_rt::RtFn;
use rungc_rt::comm::codec::Codec;
use rungc_rt::comm::{Choice, PortWiring, Protocol, Protocols};
use rungc_syntax::Device;

impl Lowerer<'_> {
    /// Finds what each port may speak.
    pub(super) fn find_protocols(&mut self, wanted: &Wanted) {
        if self.module.has_ports() {
            let model = self.model;
            let outside = |device: Device| wanted.observes(model, device.class, device.number);
            let choices = Choices::new(self.resolved, &outside);
            let ports = self.module.ports.iter();
            let protocols = ports.map(|&number| match model.ports.get(number) {
                Some(wiring) => self.protocols(wiring, &choices, wanted),
                None => Protocols::NONE,
            });
            self.module.port_protocols = protocols.collect();
        }
        self.module.slave_alone = self.slave_alone();
    }

    /// The only port, if it is nothing but a slave by Modbus RTU that no instruction uses.
    fn slave_alone(&self) -> Option<u8> {
        let [number] = self.module.ports[..] else {
            return None;
        };
        let known = self.model.ports.get(number)?.may_be_slave_alone();
        let mut codecs = self.module.codecs().map(Codec::protocols);
        let is_slave = codecs.next() == Some(Protocols::of(&[Protocol::ModbusRtu]));
        let alone = codecs.next().is_none() && self.port_functions.is_empty();
        (known && is_slave && alone && !self.errors_have_consequences()).then_some(number)
    }

    /// Protocols that a port may speak.
    fn protocols(&self, wiring: &PortWiring, choices: &Choices, wanted: &Wanted) -> Protocols {
        let mut protocols = match self.model.ports {
            Ports::Inovance | Ports::L01s | Ports::Hm => self.chosen(wiring, choices),
            // More devices choose on FX and on boards.
            Ports::Without | Ports::Fx | Ports::Fx3 | Ports::Fx3g => Protocols::ALL,
            Ports::Board2n | Ports::Board3u => Protocols::ALL,
        };
        if protocols.contains(Protocol::ModbusRtu) && !wanted.without_qlink {
            protocols = protocols.or(Protocols::QLINK);
        }
        protocols.without(self.unused())
    }

    /// Protocols that the values of its registers and relays can select for a port.
    fn chosen(&self, wiring: &PortWiring, choices: &Choices) -> Protocols {
        if wiring.choice == Choice::Can {
            let canlink = match self.port_functions.contains(&RtFn::Cannet) {
                true => Protocols::CANLINK,
                false => Protocols::NONE,
            };
            return Protocols::of(&[Protocol::Can]).or(canlink);
        }
        choices.protocols(wiring)
    }

    /// Protocols in which a port does nothing without instructions that the program does not have.
    fn unused(&self) -> Protocols {
        let calls = |functions: &[RtFn]| {
            let called = &self.port_functions;
            called.iter().any(|function| functions.contains(function))
        };
        // After UINIT the bits of HM's control word send and receive without further instructions.
        let free = [RtFn::Rs, RtFn::Rs2, RtFn::Usend, RtFn::Urcv, RtFn::Uinit];
        let mut unused = Protocols::NONE;
        if !calls(&free) {
            unused = unused.or(Protocols::of(&[Protocol::Free]));
        }
        let other = [RtFn::Rs2, RtFn::Usend, RtFn::Urcv, RtFn::Uinit];
        if self
            .port_functions
            .iter()
            .all(|function| other.contains(function))
        {
            unused = unused.or(Protocols::of(&[
                Protocol::MasterRtu,
                Protocol::MasterAscii,
                Protocol::MasterTable,
            ]));
        }
        unused
    }
}
