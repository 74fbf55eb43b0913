//! The line to a PLC that commands read.

use super::run::lines::wire::{self, Wire};
use super::{Failure, eprint_line, interruption};
use crate::args::{LineArgs, McFrame, ModbusEnd, PlcArgs, RtuFormat};
use rungc_host::io::silence;
use rungc_models::Model;
use rungc_monitor::{Patience, Plc, fx, mc, modbus};
use rungc_project::serve::LineEnd;
use rungc_rt::comm::{LineFormat, Parity};
use std::io::{self, ErrorKind};
use std::time::Duration;

/// A serial port or a connection that has been opened.
pub struct Line {
    wire: Wire,
    name: String,
}

impl Line {
    /// Sets the format of characters, or says that the line does not take it.
    fn set_format(&mut self, format: LineFormat) {
        if let Err(error) = self.wire.set_format(format) {
            // A pseudo-terminal has no parity, and needs none.
            let name = &self.name;
            let (rate, bits) = (format.bits_per_second, format.data_bits);
            eprint_line(&format!(
                "rungc: {name} cannot be set to {rate} bit/s, {bits} data bits: {error}"
            ));
        }
    }
}

impl rungc_monitor::Line for Line {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn send(&mut self, bytes: &[u8], patience: Duration) -> io::Result<()> {
        self.wire.send(bytes, patience)
    }

    /// An interruption ends the command here, however long an answer may take.
    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if interruption::is_requested() {
            return Err(io::Error::new(ErrorKind::Interrupted, "interrupted"));
        }
        self.wire.receive(buffer)
    }
}

/// The PLC that a command names, which runs a program for this model.
pub fn plc(args: &PlcArgs, model: &Model) -> Result<Plc<Line>, Failure> {
    match (&args.port, &args.mc, &args.modbus) {
        (Some(end), ..) => at_port(end, &args.line).map(Plc::Port),
        (_, Some(end), _) => {
            let frame = match args.mc_frame {
                McFrame::E1 => mc::Frame::E1,
                McFrame::E3 => mc::Frame::E3,
            };
            let line = open(end)?;
            Ok(Plc::Mc(mc::Plc::new(line, patience(&args.line), frame)))
        }
        (.., Some(end)) => slave(end, args, model).map(Plc::Modbus),
        (None, None, None) => {
            let why = "name the PLC: `--port PORT` for its programming port, `--mc HOST:PORT` or `--modbus ADDRESS`";
            Err(Failure::Because(why.to_string()))
        }
    }
}

/// The Modbus slave at an address.
fn slave(end: &ModbusEnd, args: &PlcArgs, model: &Model) -> Result<modbus::Plc<Line>, Failure> {
    let (line, framing) = match end {
        ModbusEnd::Tcp(end) => (open(end)?, modbus::Framing::Tcp),
        ModbusEnd::Rtu(end) => {
            let mut line = open(end)?;
            let (parity, stop_bits) = match args.line_format {
                RtuFormat::None1 => (Parity::None, 1),
                RtuFormat::None2 => (Parity::None, 2),
                RtuFormat::Even => (Parity::Even, 1),
                RtuFormat::Odd => (Parity::Odd, 1),
            };
            let format = LineFormat {
                bits_per_second: args.line.baud,
                parity,
                stop_bits,
                ..LineFormat::new()
            };
            line.set_format(format);
            (line, modbus::Framing::Rtu(silence(args.line.baud)))
        }
    };
    let profile = model.ports.modbus(model.type_code());
    let form = (framing, args.unit);
    Ok(modbus::Plc::new(line, patience(&args.line), form, profile))
}

/// The PLC whose programming port is at the other end of a line.
pub fn at_port(end: &LineEnd, args: &LineArgs) -> Result<fx::Plc<Line>, Failure> {
    let mut line = open(end)?;
    let format = LineFormat {
        bits_per_second: args.baud,
        data_bits: 7,
        parity: Parity::Even,
        ..LineFormat::new()
    };
    line.set_format(format);
    Ok(fx::Plc::connect(line, patience(args))?)
}

fn patience(args: &LineArgs) -> Patience {
    Patience {
        timeout: Duration::from_millis(args.timeout),
        retries: args.retries,
    }
}

fn open(end: &LineEnd) -> Result<Line, Failure> {
    let wire = wire::open(end).map_err(|error| Failure::Because(wire::cannot_open(end, &error)))?;
    let name = end.to_string();
    Ok(Line { wire, name })
}
