//! `[[modbus]]`: what a PLC asks as the master of a Modbus table (h1u-h2u-programming §5.7.4, `D8126` = 60h).
//!
//! The editor of H1U and H2U downloads the table as data whose form is not published. Here each row is a MODBUS2 at the
//! end of the main program, driven by its trigger, so rows take turns as these instructions do.

use crate::{Error, Named, Project};
use rungc_models::Model;
use rungc_rt::Ports;
use rungc_rt::comm::modbus::Limits;
use rungc_syntax::{Device, DeviceClass, Instr, Operand, OperandKind, Program, Span, codes};

/// What a row does with the devices of a slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Transfer {
    /// `read` or `write`.
    pub key: &'static str,
    /// What it reads or writes.
    pub what: &'static str,
    /// The function.
    pub function: u8,
    /// The largest number that one request may be about.
    pub most: u16,
}

/// All of them.
pub const TRANSFERS: [Transfer; 6] = {
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
        new("write", "coils", 0x0f, MOST.write_bits),
        new("write", "registers", 0x10, MOST.write_words),
    ]
};

/// A row of the table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Row {
    /// The port, 1 to 3.
    pub port: u8,
    /// The slave.
    pub station: u8,
    /// What it does.
    pub transfer: Transfer,
    /// The first address in the slave.
    pub address: u16,
    /// How many coils or registers.
    pub count: u16,
    /// Number of the first register D of the buffer.
    pub buffer: u32,
    /// It works while this device is on; always if there is none.
    pub trigger: Option<Device>,
    /// Where the row is.
    pub span: Span,
}

/// Always on in RUN.
const ALWAYS: Device = Device {
    class: DeviceClass::M,
    number: 8000,
};

impl Row {
    /// The row as instructions that are at `span` in the program.
    fn instrs(&self, span: Span) -> [Instr; 2] {
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
            hex(self.port.into()),
        ];
        let trigger = OperandKind::Device(self.trigger.unwrap_or(ALWAYS), None);
        [instr("LD", &[trigger]), instr("MODBUS2", &request)]
    }
}

impl Project {
    /// Gives a program the rows of the Modbus table.
    pub(crate) fn add_table(&self, program: &mut Program, model: &Model) -> Result<(), Error> {
        let Some(first) = self.modbus.first() else {
            return Ok(());
        };
        if model.ports != Ports::Inovance {
            let message = format!("{} has no Modbus table", model.title);
            let why = codes::PROJECT_VALUE.at(first.span, message);
            let help = "remove `[[modbus]]`, or choose the model h1u or h2u";
            return Err(self.mistake(why.help(help)));
        }
        let rows = self.modbus.iter();
        self.add_at_end(program, |span| {
            rows.flat_map(|row| row.instrs(span)).collect()
        });
        Ok(())
    }
}

/// The transfer that a row names.
pub(crate) fn transfer(key: &str, named: &Named) -> Option<Transfer> {
    TRANSFERS
        .into_iter()
        .find(|transfer| (transfer.key, transfer.what) == (key, &named.text))
}
