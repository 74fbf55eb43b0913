//! Options `--io` and `--log` of an executable.

use super::cycle::{Io, Terminals};
use super::log::Log;
use super::settings::{Connection, Kind};
use super::{opener, parse};
use rungc_rt::{Class, Plc};
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// The largest description, in bytes.
const LARGEST: u64 = 1 << 20;

/// Environment of a program that runs as an executable: its connections and its log.
#[derive(Default)]
pub struct Environment {
    described: Vec<Connection>,
    io: Io,
    log: Option<Log>,
}

impl Environment {
    /// Nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// `--io FILE`: reads the tables `[io.NAME]` of a file. Paths in it are as seen from its folder.
    ///
    /// # Errors
    /// What is wrong with the file, with its first line that is.
    pub fn describe(&mut self, path: &str) -> Result<(), String> {
        if !self.described.is_empty() {
            return Err(String::from("connections are described in one file"));
        }
        let size = fs::metadata(path).map_err(|error| error.to_string())?.len();
        if size > LARGEST {
            return Err(format!("{size} bytes are too many for a description"));
        }
        let text = fs::read_to_string(path).map_err(|error| error.to_string())?;
        let mut connections = parse(&text)?;
        let folder = Path::new(path).parent().unwrap_or(Path::new(""));
        for connection in &mut connections {
            connection.seen_from(|path| folder.join(path).display().to_string());
            opener(connection).map_err(|why| format!("[io.{}]: {why}", connection.name))?;
        }
        self.described = connections;
        Ok(())
    }

    /// `--log FILE`: begins or continues a log.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn log(&mut self, path: &str) -> Result<(), String> {
        if self.log.is_some() {
            return Err(String::from("there is one log"));
        }
        self.log = Some(Log::begin(path).map_err(|error| error.to_string())?);
        Ok(())
    }

    /// Returns true if a connection reads standard input, which leaves none for commands.
    pub fn takes_input(&self) -> bool {
        let reads = |connection: &Connection| {
            connection.kind == Kind::Console && connection.values(true) > 0
        };
        self.described.iter().any(reads)
    }

    /// Starts the connections, before the first scan.
    ///
    /// # Errors
    /// The PLC does not have a device that is named, or there are no threads to be had.
    pub fn begin(&mut self, plc: &dyn Plc) -> Result<(), String> {
        let has = |class: Class, number| match class {
            Class::D | Class::R => plc.word(class, number).is_some(),
            _ => plc.bit(class, number).is_some(),
        };
        for connection in &self.described {
            if let Some(device) = connection.missing(has) {
                return Err(format!("[io.{}]: {device} does not exist", connection.name));
            }
        }
        self.io = Io::start(self.described.clone(), opener)?;
        Ok(())
    }

    /// Before a scan.
    pub fn read_inputs(&mut self, plc: &mut dyn Terminals) {
        for line in self.io.take_into(plc) {
            self.report(&line);
        }
    }

    /// After a scan.
    pub fn write_outputs(&mut self, plc: &mut dyn Terminals) {
        if self.io.any() {
            self.io.give_from(plc);
        }
    }

    /// Prints a line to standard error, and adds it to the log. Neither being full or closed does any harm.
    pub fn report(&mut self, line: &str) {
        let _ = writeln!(io::stderr(), "{line}");
        self.log_line(line);
    }

    /// Adds a line to the log.
    pub fn log_line(&mut self, line: &str) {
        if let Some(log) = &mut self.log {
            log.add(line);
        }
    }

    /// The run is over: outputs are turned off, and the log is written.
    pub fn end(&mut self) {
        for line in std::mem::take(&mut self.io).end() {
            self.report(&line);
        }
        if let Some(log) = self.log.take() {
            log.end();
        }
    }
}
