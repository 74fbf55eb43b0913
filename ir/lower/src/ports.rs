//! The serial ports that a program uses or sets up, or that a host opens.

use super::Lowerer;
use rungc_rt::comm::{CAN_PORT, PortWiring, canlink};
use rungc_rt::{Needs, RtFn};
use rungc_syntax::{Device, DeviceClass, OperandKind};

/// Relays of the errors of programming ports and of other ports, and registers of their codes.
const ERRORS: [u32; 2] = [8062, 8063];

impl Lowerer<'_> {
    /// The ports that an instruction uses: that of RS, those that a register may name, or the one that its last operand
    /// names; all if that is not a constant.
    pub(super) fn use_ports(&mut self, needs: Needs, function: RtFn) {
        self.port_functions.push(function);
        if function == RtFn::Uinit && self.takes_work_area() {
            self.specials.whole.push(DeviceClass::D);
        }
        let ports = self.model.ports;
        let named = self
            .instr()
            .operands
            .last()
            .and_then(|operand| operand.kind.constant());
        let named = named.and_then(|number| i32::try_from(number).ok());
        let masters = ports.all().iter().filter(|wiring| wiring.sends.is_some());
        let masters = masters.map(|wiring| wiring.number);
        let all = ports.all().iter().map(|wiring| wiring.number);
        let all = all.filter(|&number| number != CAN_PORT);
        match named {
            _ if needs.can => self.module.ports.push(CAN_PORT),
            _ if needs.port => self.module.ports.push(ports.of_rs()),
            _ if needs.any_port => self.module.ports.extend(masters),
            Some(named) => self.module.ports.extend(ports.named(named)),
            None => self.module.ports.extend(all),
        }
    }

    /// Returns true if UINIT sets up a protocol with a work area, whose registers name others: free protocol, or master
    /// of a computer link (hm-motion-controller §6.2).
    fn takes_work_area(&self) -> bool {
        const LINK_MASTER: i64 = 2;
        const FREE: i64 = 5;
        let protocol = self.operand(0).and_then(OperandKind::constant);
        protocol.is_none_or(|word| matches!(word >> 8, LINK_MASTER | FREE))
    }

    /// Adds the ports that a host opens and that the program sets up; their special devices are stored.
    pub(super) fn find_ports(&mut self, opened: &[u8]) {
        for wiring in self.model.ports.all() {
            let used = self.module.ports.contains(&wiring.number);
            if !used && (opened.contains(&wiring.number) || self.sets_up(wiring)) {
                self.module.ports.push(wiring.number);
            }
        }
        self.module.ports.sort();
        self.module.ports.dedup();
        if !self.module.has_ports() {
            return;
        }
        let flags = &mut self.specials.flags;
        for number in &self.module.ports {
            let Some(wiring) = self.model.ports.get(*number) else {
                continue;
            };
            for set in wiring.sets() {
                flags.extend(set.registers().map(|n| (DeviceClass::D, n.number())));
                flags.extend(set.relays().map(|n| (DeviceClass::M, n.number())));
            }
        }
        if self.port_functions.contains(&RtFn::Cannet) {
            flags.extend(canlink::REGISTERS.map(|n| (DeviceClass::D, n.number())));
            flags.extend(canlink::RELAYS.map(|n| (DeviceClass::M, n.number())));
        }
        flags.extend(ERRORS.map(|n| (DeviceClass::D, n)));
        flags.extend(ERRORS.map(|n| (DeviceClass::M, n)));
        let model = self.model;
        flags.retain(|&(class, number)| model.has(class, number));
    }

    /// Returns true if the program names a device that selects the protocol of the port.
    fn sets_up(&self, wiring: &'static PortWiring) -> bool {
        let chooses = |device: Device| {
            wiring.sets().any(|set| {
                device.class == DeviceClass::D
                    && set.setup_registers().any(|n| n.number() == device.number)
                    || device.class == DeviceClass::M
                        && set.setup_relays().any(|n| n.number() == device.number)
            })
        };
        let operands = self.resolved.program.instrs.iter();
        let mut operands = operands.flat_map(|instr| &instr.operands);
        operands.any(|operand| match operand.kind {
            OperandKind::Device(device, None) => chooses(device),
            OperandKind::Device(..)
            | OperandKind::WordBit(..)
            | OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => false,
        })
    }
}
