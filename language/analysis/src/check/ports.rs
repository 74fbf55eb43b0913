//! The serial ports of a program: what each of them will be, as far as its registers are set to constants.
//!
//! Which registers choose what is data of the runtime ([`PortWiring`]), and so is what they choose: the state machine
//! of a port and this analysis ask the same functions.

mod areas;
mod choices;
mod facts;
mod findings;
mod first_scan;
mod roles;

use super::Code;
use crate::resolve::Resolved;
pub use choices::Choices;
pub(super) use facts::Facts;
pub(super) use findings::check;
pub(super) use roles::Roles;
use rungc_catalogue::Lower;
use rungc_rt::RtFn;
use rungc_rt::comm::{Choice, D_ADPRW_PORT, LineFormat, Parity, PortWiring, Protocol};
use rungc_syntax::Device;
use std::collections::BTreeSet;
use std::fmt;

/// Set-up of a serial port by a program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Setup {
    /// The port's number in the model's manual.
    pub port: u8,
    /// Protocol; `None` if it is chosen at run time.
    pub protocol: Option<Protocol>,
    /// Its own station, if the protocol has stations and the number is constant.
    pub station: Option<u16>,
    /// The format of characters on the line, if that is constant and the port has a line.
    pub format: Option<LineFormat>,
}

impl fmt::Display for Setup {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "COM{}: ", self.port)?;
        match self.protocol {
            None => f.write_str("protocol chosen at run time")?,
            Some(protocol) => f.write_str(protocol.name())?,
        }
        if let Some(station) = self.station {
            write!(f, ", station {station}")?;
        }
        if let Some(format) = &self.format {
            let parity = match format.parity {
                Parity::None => 'N',
                Parity::Odd => 'O',
                Parity::Even => 'E',
            };
            let (rate, data, stop) = (format.bits_per_second, format.data_bits, format.stop_bits);
            write!(f, ", {rate} {data}{parity}{stop}")?;
        }
        Ok(())
    }
}

impl Setup {
    /// Returns true if partners read and write devices by it.
    pub fn serves(&self) -> bool {
        use Protocol::{ComputerLink, ModbusAscii, ModbusRtu, ProgrammingPort};
        let slave = matches!(
            self.protocol,
            Some(ModbusRtu | ModbusAscii | ComputerLink | ProgrammingPort)
        );
        slave || self.protocol.is_none()
    }

    /// Returns true if partners, links or tables of requests may write devices that no instruction names.
    pub(super) fn exchanges(&self) -> bool {
        use Protocol::{Free, MasterAscii, MasterRtu, Off};
        !matches!(self.protocol, Some(Off | Free | MasterRtu | MasterAscii))
    }
}

/// The serial ports that a program uses or sets up, in the order of their numbers.
pub fn setups(resolved: &Resolved) -> Vec<Setup> {
    setups_of(&Code::new(resolved))
}

/// As [`setups`].
pub(super) fn setups_of(code: &Code) -> Vec<Setup> {
    let facts = code.facts();
    let used: BTreeSet<_> = (0..code.len)
        .flat_map(|i| port_of(code, i, facts))
        .collect();
    let wirings = code.model().ports.all().iter();
    let wirings = wirings.filter(|wiring| wiring.choice != Choice::Can);
    let wirings = wirings.filter(|wiring| used.contains(&wiring.number) || facts.touch(wiring));
    wirings.map(|wiring| setup(facts, wiring)).collect()
}

/// Returns true if something at a port, or a server that the PLC asks, may write any register.
pub(super) fn may_be_written(code: &Code) -> bool {
    let parameters = code.resolved.program.parameters.as_ref();
    parameters.is_some_and(|parameters| !parameters.requests.is_empty())
        || setups_of(code).iter().any(Setup::exchanges)
}

/// Set-up of a port according to the facts.
fn setup(facts: &facts::Facts, wiring: &'static PortWiring) -> Setup {
    let protocol = facts.protocol(wiring);
    let station = match protocol {
        Some(protocol) if has_station(protocol) => facts.station(wiring),
        _ => None,
    };
    let format = match protocol {
        Some(Protocol::Off) | None => None,
        Some(protocol) => facts.format(wiring, protocol),
    };
    Setup {
        port: wiring.number,
        protocol,
        station,
        format,
    }
}

/// Returns true if the port's register holds a station under a protocol.
fn has_station(protocol: Protocol) -> bool {
    matches!(
        protocol,
        Protocol::ModbusRtu | Protocol::ModbusAscii | Protocol::ComputerLink
    )
}

/// Use of a port by an instruction.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Use {
    /// Sends and receives characters of the program's own.
    Free,
    /// Asks slaves by Modbus.
    Master,
    /// Sets it up.
    SetUp,
}

/// Use of a port by an instruction, if any.
fn use_of(code: &Code, i: usize) -> Option<(RtFn, Use)> {
    let Some(Lower::Call(function)) = code.lower(i).filter(|_| !code.is_meant(i)) else {
        return None;
    };
    let needs = function.needs();
    let of = match function {
        RtFn::Rs | RtFn::Rs2 | RtFn::Usend | RtFn::Urcv => Use::Free,
        RtFn::Uinit => Use::SetUp,
        _ if needs.port || needs.names_port || needs.any_port => Use::Master,
        _ => return None,
    };
    Some((function, of))
}

/// The register that says which port an instruction of L01S works on: the one before the data of RD3A and WR3A.
fn port_register(code: &Code, i: usize) -> Option<Device> {
    let (function, _) = use_of(code, i)?;
    match function {
        RtFn::Adprw => Some(facts::d(D_ADPRW_PORT)),
        RtFn::Rd3aModbus | RtFn::Wr3aModbus => {
            let Device { class, number } = code.device(i, 2)?;
            let number = number.checked_sub(1)?;
            Some(Device { class, number })
        }
        _ => None,
    }
}

/// The port that an instruction uses, if that is certain.
fn port_of(code: &Code, i: usize, facts: &facts::Facts) -> Option<u8> {
    let (function, _) = use_of(code, i)?;
    let ports = code.model().ports;
    let needs = function.needs();
    if needs.port {
        return Some(ports.of_rs());
    }
    if let Some(register) = port_register(code, i) {
        return match facts.held(register) {
            facts::RegisterValue::Constant(port) => ports.named(port.into()),
            // Other registers than the special one may be written by an HMI.
            facts::RegisterValue::Default(port) if function == RtFn::Adprw => {
                ports.named(port.into())
            }
            facts::RegisterValue::Default(_) | facts::RegisterValue::Unknown => None,
        };
    }
    let operand = code.instr(i).operands.last()?.kind.constant()?;
    let named = i32::try_from(operand).ok().filter(|_| needs.names_port)?;
    ports.named(named)
}
