//! `[[modbus]]`: what a PLC asks as the master of a Modbus table (h1u-h2u-programming §5.7.4, `D8126` = 60h).
//!
//! The editor of H1U and H2U downloads the table as data whose form is not published. Here each row is a MODBUS2 at the
//! end of the main program, driven by its trigger, so rows take turns as these instructions do.
//!
//! A row with `host` is one of the table of the Ethernet card H2U-ENET-BD (§6.7.2): it asks a server by Modbus TCP. No
//! instruction does that; hosts do it between two scans.

use crate::{Error, Named, Project};
use rungc_models::Model;
use rungc_rt::Ports;
use rungc_rt::comm::modbus::Limits;
use rungc_syntax::{
    Device, DeviceClass, Instr, NetworkRequest, Operand, OperandKind, Program, Span, codes,
};
use std::net::{IpAddr, SocketAddr};

/// Transfer between a row and the devices of a slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Transfer {
    /// `read` or `write`.
    pub key: &'static str,
    /// Kind of devices to read or write.
    pub what: &'static str,
    /// The function.
    pub function: u8,
    /// The largest number that one request may be about.
    pub most: u16,
}

impl Transfer {
    /// Number of the PLC's registers for this many coils or registers of the other side.
    fn words(&self, count: u16) -> u32 {
        match self.what {
            "coils" | "inputs" => count.div_ceil(16).into(),
            _ => count.into(),
        }
    }
}

/// Functions that write one coil, and several.
const WRITE_COIL: u8 = 0x05;
const WRITE_COILS: u8 = 0x0f;

/// All of them.
pub(crate) const TRANSFERS: [Transfer; 6] = {
    const fn new(key: &'static str, what: &'static str, function: u8, most: u16) -> Transfer {
        Transfer {
            key,
            what,
            function,
            most,
        }
    }
    const MOST: Limits = Limits::H2U;
    [
        new("read", "coils", 0x01, MOST.read_bits),
        new("read", "inputs", 0x02, MOST.read_bits),
        new("read", "registers", 0x03, MOST.read_words),
        new("read", "input-registers", 0x04, MOST.read_words),
        new("write", "coils", WRITE_COILS, MOST.write_bits),
        new("write", "registers", 0x10, MOST.write_words),
    ]
};

/// Connection to the slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Line {
    /// At a serial port, 1 to 3.
    Port(u8),
    /// A server over TCP.
    Host(SocketAddr),
}

/// The port of Modbus TCP servers.
const TCP_PORT: u16 = 502;

/// Reads the address of a server: `192.168.1.5:502`, or `192.168.1.5`, whose port is 502.
///
/// # Errors
/// How it is to be written.
pub(crate) fn server(text: &str) -> Result<SocketAddr, String> {
    let usual = || text.parse().map(|ip: IpAddr| (ip, TCP_PORT).into());
    let address = text.parse().or_else(|_| usual());
    let fits = |address: &SocketAddr| address.port() > 0 && !address.ip().is_unspecified();
    address
        .ok()
        .filter(fits)
        .ok_or_else(|| "a server is written `192.168.1.5` or `192.168.1.5:502`".into())
}

/// A row of the table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Row {
    /// Connection to the slave.
    pub line: Line,
    /// The slave, or the unit of a server.
    pub station: u8,
    /// Transfer.
    pub transfer: Transfer,
    /// The first address in the slave.
    pub address: u16,
    /// Number of coils or registers.
    pub count: u16,
    /// Number of the first register D of the buffer.
    pub buffer: u32,
    /// It works while this device is on; always if there is none.
    pub trigger: Option<Device>,
    /// Position of the row.
    pub span: Span,
}

/// Always on in RUN.
const ALWAYS: Device = Device {
    class: DeviceClass::M,
    number: 8000,
};

impl Row {
    /// Request of the row to a server over TCP, if it is one.
    fn request(&self) -> Option<NetworkRequest> {
        let Line::Host(server) = self.line else {
            return None;
        };
        let function = match (self.transfer.function, self.count) {
            // The table of the card has functions 05 and 0F, and one name for both.
            (WRITE_COILS, 1) => WRITE_COIL,
            (function, _) => function,
        };
        Some(NetworkRequest {
            server,
            unit: self.station,
            function,
            address: self.address,
            count: self.count,
            buffer: self.buffer,
            trigger: self.trigger.unwrap_or(ALWAYS),
        })
    }

    /// The row as instructions that are at `span` in the program; none for a server over TCP.
    fn instrs(&self, span: Span) -> Option<[Instr; 2]> {
        let Line::Port(port) = self.line else {
            return None;
        };
        let instr = |mnemonic: &str, operands: &[OperandKind]| Instr {
            mnemonic: mnemonic.into(),
            mnemonic_span: span,
            operands: operands
                .iter()
                .map(|kind| Operand {
                    span,
                    kind: kind.clone(),
                })
                .collect(),
            span,
            step: None,
            remarks: None,
        };
        let hex = |value: u16| OperandKind::Hex(value.into(), None);
        let buffer = Device {
            class: DeviceClass::D,
            number: self.buffer,
        };
        let head = u16::from_be_bytes([self.station, self.transfer.function]);
        let request = [
            hex(head),
            hex(self.address),
            hex(self.count),
            OperandKind::Device(buffer, None),
            hex(port.into()),
        ];
        let trigger = OperandKind::Device(self.trigger.unwrap_or(ALWAYS), None);
        Some([instr("LD", &[trigger]), instr("MODBUS2", &request)])
    }
}

impl Project {
    /// Returns true if its program sends requests to servers over TCP.
    pub fn has_server_requests(&self) -> bool {
        let mut rows = self.modbus.iter();
        rows.any(|row| matches!(row.line, Line::Host(_)))
    }

    /// Gives a program the rows of the Modbus table.
    pub(crate) fn add_table(&self, program: &mut Program, model: &Model) -> Result<(), Error> {
        self.check_requests(model)?;
        let requests: Vec<_> = self.modbus.iter().filter_map(Row::request).collect();
        if !requests.is_empty() {
            program.parameters.get_or_insert_default().requests = requests;
        }
        let serial = |row: &&Row| matches!(row.line, Line::Port(_));
        let Some(first) = self.modbus.iter().find(serial) else {
            return Ok(());
        };
        if model.ports != Ports::Inovance {
            let message = format!("{} has no Modbus table", model.title);
            let why = codes::PROJECT_VALUE.at(first.span, message);
            let help = "choose the model h1u or h2u, or name a Modbus TCP server: `host = \"192.168.1.5\"`";
            return Err(self.error(why.help(help)));
        }
        let rows = self.modbus.iter();
        self.add_at_end(program, |span| {
            rows.filter_map(|row| row.instrs(span)).flatten().collect()
        });
        Ok(())
    }
}

impl Project {
    /// Checks the devices in requests to servers against the model; instructions are checked later.
    fn check_requests(&self, model: &Model) -> Result<(), Error> {
        for row in &self.modbus {
            let Some(request) = row.request() else {
                continue;
            };
            let words = row.transfer.words(row.count);
            let last = Device {
                class: DeviceClass::D,
                number: row.buffer.saturating_add(words - 1),
            };
            let named = [request.trigger, last].into_iter();
            let mut missing = named.filter(|device| !model.has(device.class, device.number));
            if let Some(device) = missing.next() {
                let message = format!("{device} does not exist on {}", model.title);
                return Err(self.error(codes::PROJECT_VALUE.at(row.span, message)));
            }
        }
        Ok(())
    }
}

/// The transfer that a row names.
pub(crate) fn transfer(key: &str, named: &Named) -> Option<Transfer> {
    TRANSFERS
        .into_iter()
        .find(|transfer| (transfer.key, transfer.what) == (key, &named.text))
}
