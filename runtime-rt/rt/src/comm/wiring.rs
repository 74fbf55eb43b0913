//! The special devices of serial ports, by family of models, and the protocol that they choose.

mod fx;
mod rules;
mod shown;
mod tables;

use super::LineFault;
use super::can::{self, CAN_PORT};
use super::codec::Codec;
use super::line::LineFormat;
use crate::fault::show_error;
use crate::plc::Plc;
use crate::special::{M_PORT_ERROR, M_PROGRAMMING_PORT_ERROR, Register, Relay};
pub(crate) use fx::ModbusWiring;
pub use rules::Rules;

/// Protocol of a port. The numbers are part of the C ABI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Protocol {
    /// Nothing: what comes in is dropped.
    #[default]
    Off = 0,
    /// The program's own, by RS, RS2, USEND, URCV.
    Free = 1,
    /// The programming port's, which HMIs use.
    ProgrammingPort = 2,
    /// Slave by Modbus RTU, QLink.
    ModbusRtu = 3,
    /// Slave by Modbus ASCII.
    ModbusAscii = 4,
    /// Master by Modbus RTU, for instructions.
    MasterRtu = 5,
    /// Master by Modbus ASCII, for instructions.
    MasterAscii = 6,
    /// Master by Modbus RTU, for a table.
    MasterTable = 7,
    /// Slave of a computer link.
    ComputerLink = 8,
    /// Master of a computer link (HM).
    ComputerLinkMaster = 9,
    /// Master of a parallel link.
    ParallelMaster = 10,
    /// Slave of a parallel link.
    ParallelSlave = 11,
    /// Master of an N:N link.
    NnMaster = 12,
    /// Slave of an N:N link.
    NnSlave = 13,
    /// Master of an enhanced N:N link.
    EnhancedMaster = 14,
    /// Slave of an enhanced N:N link.
    EnhancedSlave = 15,
    /// Frames of CAN, by CANTX and CANRX.
    Can = 16,
}

impl Protocol {
    /// Protocol of a protocol number (D8126 and similar registers) on H1U and H2U (h1u-h2u-programming §5.1).
    #[inline(always)]
    pub fn from_number(number: u16) -> Self {
        match number {
            0x00 | 0x10 => Protocol::Free,
            0x01 | 0x81 => Protocol::ProgrammingPort,
            0x02 => Protocol::ModbusRtu,
            0x03 => Protocol::ModbusAscii,
            0x04 => Protocol::NnSlave,
            0x40 => Protocol::NnMaster,
            0x14 => Protocol::EnhancedSlave,
            0x41 => Protocol::EnhancedMaster,
            0x05 => Protocol::ParallelSlave,
            0x50 => Protocol::ParallelMaster,
            0x06 => Protocol::ComputerLink,
            0x20 => Protocol::MasterRtu,
            0x30 => Protocol::MasterAscii,
            0x60 => Protocol::MasterTable,
            _ => Protocol::Off,
        }
    }

    /// Display name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Protocol::Off => "off",
            Protocol::Free => "free protocol",
            Protocol::ProgrammingPort => "programming port",
            Protocol::ModbusRtu => "Modbus slave RTU",
            Protocol::ModbusAscii => "Modbus slave ASCII",
            Protocol::MasterRtu => "Modbus master RTU",
            Protocol::MasterAscii => "Modbus master ASCII",
            Protocol::MasterTable => "Modbus master RTU, table",
            Protocol::ComputerLink => "computer link",
            Protocol::ComputerLinkMaster => "master of a computer link",
            Protocol::ParallelMaster => "master of a parallel link",
            Protocol::ParallelSlave => "slave of a parallel link",
            Protocol::NnMaster => "master of an N:N link",
            Protocol::NnSlave => "slave of an N:N link",
            Protocol::EnhancedMaster => "master of an enhanced N:N link",
            Protocol::EnhancedSlave => "slave of an enhanced N:N link",
            Protocol::Can => "CAN",
        }
    }

    /// Returns true if instructions of the program send Modbus requests.
    pub const fn is_master(self) -> bool {
        matches!(
            self,
            Protocol::MasterRtu | Protocol::MasterAscii | Protocol::MasterTable
        )
    }

    /// Returns true if its frames are Modbus.
    pub const fn is_modbus(self) -> bool {
        matches!(
            self,
            Protocol::ModbusRtu
                | Protocol::ModbusAscii
                | Protocol::MasterRtu
                | Protocol::MasterAscii
                | Protocol::MasterTable
        )
    }
}

/// Selection of a port's protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The programming port of H1U and H2U, whose register may make it a Modbus slave in RUN.
    Com0,
    /// The protocol register of a port of H1U and H2U; the end of the first scan in RUN binds.
    Number,
    /// The same port, with the relays of parallel links before it.
    Com1,
    /// A programming port that is nothing else.
    ProgrammingPort,
    /// The CAN card: H2U finds it, a program of H1U says that it is there by D8199 = 7 (h1u-h2u-programming §5.9.1).
    Can,
    /// Port 2 of L01S: M8196, M8125 and the format word.
    L01sPort2,
    /// Port 3 of L01S: M8192 and D8401.
    L01sPort3,
    /// UINIT (HM).
    Uinit,
    /// The format word: computer link by bit 14, else RS; before it, N:N links by D8176 and D8177, parallel links by
    /// M8070 and M8071 (FX).
    Format,
    /// The registers of RS2 and ADPRW (FX3).
    Channel,
    /// The programming port of FX3G: RS2 if D8370 has a format.
    Channel0,
    /// The format word of compatible boards: Modbus master by bit 15, slave by bit 14, else RS.
    Board,
}

/// The special devices of one port.
#[derive(Clone, Copy, Debug)]
pub struct PortWiring {
    /// Its number in the model's manual.
    pub number: u8,
    /// Selection of its protocol.
    pub choice: Choice,
    /// Rules of that selection.
    pub rules: &'static Rules,
    /// Register: format word.
    pub format: Option<Register>,
    /// Register: own station number.
    pub station: Option<Register>,
    /// Register: protocol number or mode.
    pub protocol: Option<Register>,
    /// Register: characters left to send.
    pub left: Option<Register>,
    /// Register: characters received.
    pub received: Option<Register>,
    /// Register: character before the data of RS.
    pub start: Option<Register>,
    /// Register: character after the data of RS.
    pub end: Option<Register>,
    /// Register: time-out.
    pub time_out: Option<Register>,
    /// Unit of the time-out, in microseconds.
    pub time_out_unit_us: u32,
    /// The first of the three registers that show what UINIT has set up.
    pub uinit: Option<Register>,
    /// Relay: RS waits to send.
    pub waits: Option<Relay>,
    /// Relay: RS is to send; a master's instruction is in work.
    pub sends: Option<Relay>,
    /// Relay: RS has received; a master's exchange has failed.
    pub done: Option<Relay>,
    /// Relay: RS is receiving.
    pub receives: Option<Relay>,
    /// Relay: time-out.
    pub late: Option<Relay>,
    /// Relay: the answer to RD3A or WR3A has come (L01S).
    pub answered: Option<Relay>,
    /// Register: scans between two requests of RD3A and WR3A (L01S).
    pub gap: Option<Register>,
    /// Registers of what RS2 puts around data.
    pub envelope: Option<Envelope>,
    /// Registers and relays of Modbus on FX3.
    pub modbus: Option<ModbusWiring>,
    /// Devices that show an error.
    pub error: Option<ErrorPlace>,
    /// Base of the error codes: 6200, 6300, or 3800.
    pub codes: u16,
    /// The lowest code of an error of Modbus; 0: errors of Modbus have no separate codes.
    pub modbus_errors: u16,
    /// It has one pair of wires whatever the format word says.
    pub one_pair: bool,
    /// The special devices that the port has instead where these name a format: those of RS2 and ADPRW rather than RS
    /// (FX3).
    pub instead: Option<&'static PortWiring>,
}

/// Registers of what RS2 puts around data, two characters to a register, the low byte first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Envelope {
    /// The first of two registers: characters before the data.
    pub headers: Register,
    /// The first of two registers: characters after it.
    pub terminators: Register,
    /// The sum that has come.
    pub received_sum: Option<Register>,
    /// The sum of what has come.
    pub computed_sum: Register,
    /// The sum of what has been sent.
    pub sent_sum: Register,
}

/// The relay that shows an error of communication until the program resets it, and the register of the same number with
/// the code of the last error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorPlace(pub Relay);

/// Errors of a programming port, and of any other port.
const PROGRAMMING_PORT_ERROR: ErrorPlace = ErrorPlace(M_PROGRAMMING_PORT_ERROR);
const SERIAL_ERROR: ErrorPlace = ErrorPlace(M_PORT_ERROR);

/// Lowest codes of the errors of programming ports and of other ports (h1u-h2u-programming §8.1).
const PROGRAMMING_PORT_CODES: u16 = 6200;
const SERIAL_CODES: u16 = 6300;

/// Code of a port that is not there.
const NO_PORT: u16 = SERIAL_CODES + 77;

/// Register with the type of the extension card.
const D_CARD: Register = Register(8199);

/// Master and slave of a parallel link, on COM1 (h1u-h2u-programming §5.4).
pub(super) const M_PARALLEL_MASTER: Relay = Relay(8070);
pub(super) const M_PARALLEL_SLAVE: Relay = Relay(8071);
/// Ports 2 and 3 of L01S are set up by their registers rather than programming ports (l01s-programming §9).
const M_PORT_2_SET_UP: Relay = Relay(8196);
const M_PORT_3_SET_UP: Relay = Relay(8192);
/// Port of ADPRW of L01S: 0 for port 2, 1 for port 3 (l01s-programming §8.1.2).
pub const D_ADPRW_PORT: Register = Register(8397);

/// Port 2 of L01S speaks Modbus.
const M_PORT_2_MODBUS: Relay = Relay(8125);

/// The serial ports that a family of models has. The numbers are part of the C ABI.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Ports {
    /// None.
    #[default]
    Without = 0,
    /// H1U, H2U: COM0 to COM3.
    Inovance = 1,
    /// L01S: ports 1 to 3.
    L01s = 2,
    /// HM: COM0 and COM1.
    Hm = 3,
    /// FX1S, FX1N, FX2N: the programming port, and the communication board.
    Fx = 4,
    /// Boards that are compatible with FX3U.
    Board3u = 5,
    /// FX3S, FX3U: the programming port, and two channels.
    Fx3 = 6,
    /// FX3G: the same, and RS2 on the programming port.
    Fx3g = 7,
    /// Boards that are compatible with FX2N.
    Board2n = 8,
}

impl Ports {
    /// All families that have ports.
    pub const fn families() -> &'static [Self] {
        &[
            Ports::Inovance,
            Ports::L01s,
            Ports::Hm,
            Ports::Fx,
            Ports::Fx3,
            Ports::Fx3g,
            Ports::Board2n,
            Ports::Board3u,
        ]
    }

    /// Its name in emitted C, in small letters.
    pub const fn name(self) -> &'static str {
        match self {
            Ports::Without => "without",
            Ports::Inovance => "inovance",
            Ports::L01s => "l01s",
            Ports::Hm => "hm",
            Ports::Fx => "fx",
            Ports::Fx3 => "fx3",
            Ports::Fx3g => "fx3g",
            Ports::Board2n => "board2n",
            Ports::Board3u => "board3u",
        }
    }

    /// The ports in the order of their numbers.
    pub const fn all(self) -> &'static [PortWiring] {
        match self {
            Ports::Without => &[],
            Ports::Inovance => &tables::INOVANCE,
            Ports::L01s => &tables::L01S,
            Ports::Hm => &tables::HM,
            Ports::Fx => &tables::FX,
            Ports::Fx3 => &tables::FX3,
            Ports::Fx3g => &tables::FX3G,
            Ports::Board2n => &tables::BOARD_2N,
            Ports::Board3u => &tables::BOARD_3U,
        }
    }

    /// Returns true for FX3 and boards that run its programs.
    pub const fn is_fx3(self) -> bool {
        matches!(self, Ports::Fx3 | Ports::Fx3g | Ports::Board3u)
    }

    /// The longest transfer of RS and RS2, in bytes: 256 (h1u-h2u-programming §4.3.9), 4096 on FX (JY992D48301 §5.9.1).
    pub const fn longest_transfer(self) -> i32 {
        match self {
            Ports::Inovance | Ports::L01s => 256,
            _ => 4096,
        }
    }

    /// The port on which RS works.
    pub const fn of_rs(self) -> u8 {
        match self {
            Ports::L01s => 2,
            _ => 1,
        }
    }

    /// The port for programmers and HMIs, the first one; `None` if the model has none.
    pub fn of_programmer(self) -> Option<u8> {
        self.all().first().map(|port| port.number)
    }

    /// The port that an operand of an instruction names: n1 of RS2 and MODBUS2, D2 of UINIT and similar instructions.
    pub fn named(self, operand: i32) -> Option<u8> {
        let number = match (self, operand) {
            (Ports::Inovance | Ports::Fx | Ports::Fx3 | Ports::Board2n | Ports::Board3u, 0) => {
                return None;
            }
            (Ports::Inovance, operand) if operand == i32::from(CAN_PORT) => return None,
            (Ports::L01s, 0..=1) => 2 + operand,
            _ => operand,
        };
        let number = u8::try_from(number).ok()?;
        self.get(number).map(|port| port.number)
    }

    /// The port of a number.
    pub fn get(self, number: u8) -> Option<&'static PortWiring> {
        self.all().iter().find(|port| port.number == number)
    }
}

/// Returns true if a relay is on; off if there is none.
pub(crate) fn is_on(plc: &(impl Plc + ?Sized), relay: Option<Relay>) -> bool {
    relay.is_some_and(|relay| relay.is_on(plc))
}

/// Sets a relay, if there is one.
pub(crate) fn set(plc: &mut (impl Plc + ?Sized), relay: Option<Relay>, on: bool) {
    if let Some(relay) = relay {
        relay.set(plc, on);
    }
}

/// Value of a register; 0 where there is none.
pub(crate) fn value(plc: &(impl Plc + ?Sized), register: Option<Register>) -> u16 {
    register.map_or(0, |register| register.value(plc))
}

/// Sets a register, if there is one.
pub(crate) fn set_value(plc: &mut (impl Plc + ?Sized), register: Option<Register>, value: u16) {
    if let Some(register) = register {
        register.set(plc, value);
    }
}

impl ErrorPlace {
    /// Shows an error, until the program clears it.
    fn show(self, plc: &mut (impl Plc + ?Sized), code: u16) {
        show_error(plc, self.0, code);
    }
}

impl PortWiring {
    /// The special devices that a port of a program has now.
    pub(crate) fn of(plc: &dyn Plc, number: u8) -> Option<&'static Self> {
        let mut all = (0..).map_while(|index| plc.port_wiring(index));
        let wiring = all.find(|wiring| wiring.number == number)?;
        Some(wiring.chosen(plc))
    }

    /// The special devices that the port has now: those that its registers choose.
    pub(crate) fn chosen(&'static self, plc: &dyn Plc) -> &'static PortWiring {
        let instead = self.instead.filter(|other| value(plc, other.format) != 0);
        instead.unwrap_or(self)
    }

    /// The register of the own station number: that of computer links is another one than that of Modbus on channel 2
    /// of FX3.
    pub(crate) fn station_of(&self, protocol: Protocol) -> Option<Register> {
        match (self.choice, protocol) {
            (Choice::Channel, Protocol::ComputerLink) => self.protocol,
            _ => self.station,
        }
    }

    /// Returns true for the CAN card.
    pub const fn is_can(&self) -> bool {
        matches!(self.choice, Choice::Can)
    }

    /// All sets of special devices that the port may have.
    pub fn sets(&'static self) -> impl Iterator<Item = &'static PortWiring> {
        core::iter::once(self).chain(self.instead)
    }

    /// Returns true if the end of the first scan in RUN binds the choice; elsewhere the registers choose at any time.
    pub const fn binds(&self) -> bool {
        matches!(self.choice, Choice::Com0 | Choice::Com1 | Choice::Number)
    }

    /// Protocol that the registers choose now; `uinit` is the setup by UINIT.
    pub fn protocol(&self, plc: &dyn Plc, uinit: [u16; 3]) -> Protocol {
        (self.rules.protocol)(self, plc, uinit)
    }

    /// The format of characters on the line under a protocol.
    pub fn line(&self, plc: &dyn Plc, protocol: Protocol, uinit: [u16; 3]) -> LineFormat {
        match Codec::of(protocol) {
            Some(codec) => codec.handler.line(self, plc, protocol, uinit),
            None => self.own_line(plc, uinit, false),
        }
    }

    /// The format of characters that the registers choose, for the free protocol or others.
    pub(super) fn own_line(&self, plc: &dyn Plc, uinit: [u16; 3], free: bool) -> LineFormat {
        (self.rules.line)(self, plc, uinit, free)
    }

    /// The line of a link between PLCs. The rate of the format word replaces the usual one where it is not 0
    /// (h1u-h2u-communication §3.4).
    pub(super) fn linked(&self, plc: &dyn Plc, protocol: Protocol) -> LineFormat {
        let word = value(plc, self.format);
        let rate = match protocol {
            Protocol::ParallelMaster | Protocol::ParallelSlave => 19_200,
            _ => 38_400,
        };
        let enhanced = matches!(protocol, Protocol::EnhancedMaster | Protocol::EnhancedSlave);
        let rate = match word >> 4 & 15 {
            1.. if !enhanced => LineFormat::from_word(word).bits_per_second,
            _ => rate,
        };
        LineFormat::seven_even(rate, true)
    }

    /// The time-out in microseconds; one that is not set is 100 ms.
    pub(crate) fn time_out_us(&self, plc: &dyn Plc) -> u32 {
        match value(plc, self.time_out) {
            0 => 100_000,
            time => u32::from(time) * self.time_out_unit_us,
        }
    }

    /// Time-out of a Modbus master for an answer, in microseconds. Compatible boards and FX3 count milliseconds here,
    /// but tens of them for RS and RS2; on FX3, 0 is 3 s.
    pub(crate) fn answer_time_out_us(&self, plc: &dyn Plc) -> u32 {
        match (self.choice, value(plc, self.time_out)) {
            (Choice::Channel, 0) => 3_000_000,
            (Choice::Board | Choice::Channel, ms @ 1..) => u32::from(ms) * 1000,
            _ => self.time_out_us(plc),
        }
    }

    /// Number of scans between two requests of RD3A and WR3A.
    pub(crate) fn gap_scans(&self, plc: &dyn Plc) -> u16 {
        value(plc, self.gap)
    }

    /// Shows that the port runs another protocol than an instruction needs.
    pub(crate) fn note_other_protocol(&self, plc: &mut dyn Plc, protocol: Protocol) {
        let fault = LineFault::Protocol;
        match protocol {
            Protocol::ProgrammingPort => note_programming_port(plc, fault),
            _ if protocol.is_modbus() => self.note_of_modbus(plc, protocol.is_master(), fault),
            _ => self.note_usual(plc, fault),
        }
    }

    /// Shows an error of the port in the PLC's relay and register, where it stays until the program clears it.
    #[inline(always)]
    pub(super) fn note_general(&self, plc: &mut (impl Plc + ?Sized), fault: LineFault) {
        self.show(plc, self.codes + fault.of_all());
    }

    /// Shows an error with the codes of Modbus, if the port has them.
    #[inline(always)]
    pub(super) fn note_usual(&self, plc: &mut (impl Plc + ?Sized), fault: LineFault) {
        let code = match fault.of_modbus() {
            Some(kind) if self.modbus_errors != 0 => self.modbus_errors + kind,
            _ => self.codes + fault.of_all(),
        };
        self.show(plc, code);
    }

    /// Shows an error of Modbus, of a master or a slave.
    pub(super) fn note_of_modbus(&self, plc: &mut dyn Plc, master: bool, fault: LineFault) {
        (self.rules.note_modbus)(self, plc, master, fault);
    }

    /// Shows an error of a link between PLCs.
    pub(super) fn note_of_link(&self, plc: &mut dyn Plc, protocol: Protocol, fault: LineFault) {
        match protocol {
            Protocol::ParallelMaster | Protocol::ParallelSlave => {
                self.show(plc, self.codes + fault.of_parallel());
            }
            _ => self.note_general(plc, fault),
        }
    }

    #[inline(always)]
    fn show(&self, plc: &mut (impl Plc + ?Sized), code: u16) {
        if let Some(place) = self.error {
            place.show(plc, code);
        }
    }

    /// Registers of the port, which are stored where a program uses it.
    pub fn registers(&self) -> impl Iterator<Item = Register> {
        let registers = [
            self.format,
            self.station,
            self.protocol,
            self.left,
            self.received,
            self.start,
            self.end,
            self.time_out,
            self.gap,
            self.error.map(|error| Register(error.0.0)),
        ];
        let envelope = self.envelope.map(|of| {
            let [a, b] = of.headers.run();
            let [c, d] = of.terminators.run();
            let sums = [of.received_sum, Some(of.computed_sum), Some(of.sent_sum)];
            [a, b, c, d].map(Some).into_iter().chain(sums).flatten()
        });
        let modbus = self.modbus.map(ModbusWiring::registers);
        let all = registers.into_iter().flatten();
        let all = all.chain(envelope.into_iter().flatten());
        all.chain(modbus.into_iter().flatten()).chain(self.others())
    }

    /// Registers that set up links of FX on this port, and those of the CAN card.
    fn others(&self) -> impl Iterator<Item = Register> {
        let others: &[Register] = match self.choice {
            Choice::Format => &fx::LINKS,
            Choice::Can => &can::REGISTERS,
            _ => &[],
        };
        others.iter().copied()
    }

    /// Registers that choose what the port speaks.
    pub fn setup_registers(&self) -> impl Iterator<Item = Register> {
        let registers = [self.format, self.protocol];
        let links: &[Register] = match self.choice {
            Choice::Format => &fx::LINKS,
            _ => &[],
        };
        registers.into_iter().flatten().chain(links.iter().copied())
    }

    /// Relays that choose what the port speaks.
    pub fn setup_relays(&self) -> impl Iterator<Item = Relay> {
        let relays: &[Relay] = match self.choice {
            Choice::Com1 | Choice::Format => &[M_PARALLEL_MASTER, M_PARALLEL_SLAVE],
            Choice::L01sPort2 => &[M_PORT_2_SET_UP, M_PORT_2_MODBUS],
            Choice::L01sPort3 => &[M_PORT_3_SET_UP],
            _ => &[],
        };
        relays.iter().copied()
    }

    /// Relays of the port, which are stored where a program uses it.
    pub fn relays(&self) -> impl Iterator<Item = Relay> {
        let relays = [
            self.waits,
            self.sends,
            self.done,
            self.receives,
            self.late,
            self.answered,
            self.error.map(|error| error.0),
            self.modbus.map(ModbusWiring::tried),
        ];
        let of_can: &[Relay] = match self.choice {
            Choice::Can => &can::RELAYS,
            _ => &[],
        };
        let all = relays.into_iter().flatten().chain(of_can.iter().copied());
        all.chain(self.setup_relays())
    }
}

/// Shows that an instruction names a port that is not there.
pub(crate) fn note_missing(plc: &mut dyn Plc) {
    SERIAL_ERROR.show(plc, NO_PORT);
}

/// Computer link by bit 14 of the format word, else the protocol of a number.
#[inline(always)]
fn by_number(wiring: &PortWiring, plc: &(impl Plc + ?Sized)) -> Protocol {
    let protocol = Protocol::from_number(value(plc, wiring.protocol));
    match protocol {
        Protocol::NnMaster
        | Protocol::NnSlave
        | Protocol::ParallelMaster
        | Protocol::ParallelSlave => protocol,
        _ if value(plc, wiring.format) & 1 << 14 != 0 => Protocol::ComputerLink,
        _ => protocol,
    }
}

/// Shows an error of a programming port.
pub(super) fn note_programming_port(plc: &mut dyn Plc, fault: LineFault) {
    PROGRAMMING_PORT_ERROR.show(plc, PROGRAMMING_PORT_CODES + fault.of_all());
}

impl LineFault {
    /// The last digits of the code of an error, in protocols that have no others.
    fn of_all(self) -> u16 {
        match self {
            LineFault::Character => 1,
            LineFault::Unknown => 2,
            LineFault::Sum => 3,
            LineFault::Command => 5,
            LineFault::TimeOut => 6,
            _ => 4,
        }
    }

    /// The same on a parallel link.
    fn of_parallel(self) -> u16 {
        match self {
            LineFault::Character | LineFault::Unknown => 12,
            LineFault::Sum => 13,
            LineFault::TimeOut => 15,
            _ => 14,
        }
    }

    /// The last digit of the code of a Modbus error, which is the number of the fault; `None` for what all protocols
    /// share.
    #[inline]
    fn of_modbus(self) -> Option<u16> {
        match self {
            LineFault::Character | LineFault::Unknown => None,
            _ => Some(self as u16),
        }
    }
}
