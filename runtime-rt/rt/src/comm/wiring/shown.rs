//! Special devices that serial ports write: those in which they show their state, and those of links between PLCs.

use super::{ModbusWiring, PortWiring};
use crate::comm::computer_link::M_GLOBAL;
use crate::comm::computer_link::on_demand::Devices;
use crate::comm::link::{nn, parallel};
use crate::comm::port::M_SET_UP_WRONGLY;
use crate::special::{M_FORCE_ENABLE, Register, Relay};

impl PortWiring {
    /// The devices of on-demand transmission by computer link.
    pub(in crate::comm) fn on_demand(&self) -> Option<Devices> {
        self.format.map(Devices::of_block)
    }

    /// Relays that the runtime may write for this port.
    pub fn shown_relays(&'static self) -> impl Iterator<Item = Relay> {
        let own = self.sets().flat_map(PortWiring::relays);
        let modbus = self.sets().filter_map(|set| set.modbus);
        let modbus = modbus.flat_map(ModbusWiring::relays);
        let on_demand = self.on_demand().into_iter();
        let on_demand = on_demand.flat_map(|devices| devices.first_relay.run::<2>());
        let links = nn::RELAYS.into_iter().flatten();
        own.chain(modbus)
            .chain(on_demand)
            .chain(links.map(relay))
            .chain([parallel::M_RUNNING, M_GLOBAL].map(relay))
            .chain([M_SET_UP_WRONGLY, M_FORCE_ENABLE])
    }

    /// Registers that the runtime may write for this port.
    pub fn shown_registers(&'static self) -> impl Iterator<Item = Register> {
        let own = self.sets().flat_map(PortWiring::registers);
        let uinit = self.uinit.into_iter().flat_map(Register::run::<3>);
        let on_demand = self.on_demand().into_iter();
        let on_demand = on_demand.map(|devices| devices.first_register.after(1));
        let links = nn::REGISTERS.into_iter().flatten();
        own.chain(uinit)
            .chain(on_demand)
            .chain(links.map(|number| Register(number as u16)))
    }
}

fn relay(number: u32) -> Relay {
    Relay(number as u16)
}
