//! The line to a PLC that commands read.

use super::run::lines::wire::{self, Wire};
use super::{Failure, eprint_line, interruption};
use crate::args::{LineArgs, McFrame, PlcArgs};
use rungc_monitor::{Patience, Plc, fx, mc};
use rungc_project::serve::LineEnd;
use rungc_rt::comm::{LineFormat, Parity};
use std::io::{self, ErrorKind};
use std::time::Duration;

/// A serial port or a connection that has been opened.
pub struct Line {
    wire: Wire,
    name: String,
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

/// The PLC that a command names.
pub fn plc(args: &PlcArgs) -> Result<Plc<Line>, Failure> {
    match (&args.port, &args.mc) {
        (Some(end), _) => at_port(end, &args.line).map(Plc::Port),
        (None, Some(end)) => {
            let frame = match args.mc_frame {
                McFrame::E1 => mc::Frame::E1,
                McFrame::E3 => mc::Frame::E3,
            };
            let line = open(end)?;
            Ok(Plc::Mc(mc::Plc::new(line, patience(&args.line), frame)))
        }
        (None, None) => {
            let why = "name the PLC: `--port PORT` for its programming port, or `--mc HOST:PORT`";
            Err(Failure::Because(why.to_string()))
        }
    }
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
    if let Err(error) = line.wire.set_format(format) {
        // A pseudo-terminal has no parity, and needs none.
        let (name, rate) = (&line.name, args.baud);
        eprint_line(&format!(
            "rungc: {name} cannot be set to {rate} bit/s, 7 data bits, even parity: {error}"
        ));
    }
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
