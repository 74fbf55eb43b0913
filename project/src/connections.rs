//! `[io.NAME]`: what the terminals and registers of a running program are connected to.

use crate::{Error, Project, Range};
use rungc_host::io::Connection;
use rungc_models::Model;
use rungc_models::runs::name_class;
use rungc_syntax::{DeviceRun, Program, Span, codes, inputs};
use std::path::Path;

/// A connection, with the places of what it says.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Connected {
    /// The connection.
    pub connection: Connection,
    /// Position of its name.
    pub span: Span,
    /// Positions of the devices in its rows.
    pub rows: Vec<Span>,
    /// Position of its fault device.
    pub fault: Span,
}

fn run(of: rungc_rt::Class, first: u32, count: u32) -> DeviceRun {
    DeviceRun {
        class: name_class(of),
        first,
        count,
    }
}

/// Help where a device cannot take a value.
const ANOTHER_DEVICE: &str = "choose a device that nothing else writes, such as `M100`";

/// The first of some devices that each scan sets, so that a value from elsewhere is lost.
fn set_by_scan(devices: &DeviceRun, model: &Model) -> Option<String> {
    let mut numbers = devices.first..devices.first + devices.count;
    let set = numbers.find(|&number| model.is_set_by_scan(devices.class, number))?;
    let device = devices.class.number(set);
    Some(format!("the PLC itself sets {device} in each scan"))
}

impl Project {
    /// Connections of `[io]`, with paths as seen from the caller's folder.
    pub fn connections(&self) -> Vec<Connection> {
        let connected = self.io.iter().map(|row| {
            let mut connection = row.connection.clone();
            let seen = |path: &str| {
                let path = self.at(Path::new(path));
                inputs::note(&path);
                path.display().to_string()
            };
            connection.seen_from(seen);
            connection
        });
        connected.collect()
    }

    /// Shows a program what is read and written outside it: by connections, by clients and panels, and by the fault
    /// device of `[retain]`.
    pub(crate) fn add_external(&self, program: &mut Program) {
        let rows = self.io.iter().flat_map(|row| &row.connection.rows);
        let rows = rows.filter(|row| !row.reads);
        let read = rows.map(|row| run(row.class, row.first, row.count));
        let panels = self.hmi_reads.iter().map(Range::run);
        let read: Vec<DeviceRun> = read.chain(self.served()).chain(panels).collect();
        let written = self.written_externally().into_iter();
        let written: Vec<DeviceRun> = written.map(|(_, run)| run).collect();
        if !read.is_empty() || !written.is_empty() {
            let parameters = program.parameters.get_or_insert_default();
            parameters.read_externally = read;
            parameters.written_externally = written;
        }
    }

    /// Devices named by `[serve]`.
    fn served(&self) -> impl Iterator<Item = DeviceRun> {
        self.serve.devices.iter().map(Range::run)
    }

    /// Devices that are written from outside the program while it runs, with the table of the settings that states it:
    /// those that connections read, fault devices, and those named by `[serve]` and `[hmi]`.
    pub fn written_externally(&self) -> Vec<(&'static str, DeviceRun)> {
        let mut written = Vec::new();
        for Connected { connection, .. } in &self.io {
            let rows = connection.rows.iter().filter(|row| row.reads);
            let rows = rows.map(|row| run(row.class, row.first, row.count));
            let fault = connection.fault.iter();
            let fault = fault.map(|&(class, number)| run(class, number, 1));
            written.extend(rows.chain(fault).map(|run| ("[io]", run)));
        }
        written.extend(self.served().map(|run| ("[serve]", run)));
        written.extend(self.hmi.iter().map(|range| ("[hmi]", range.run())));
        written.extend(
            self.retain_fault
                .iter()
                .map(|fault| ("[retain]", fault.run())),
        );
        written
    }

    /// A device of `[io]` that the model does not have is a mistake, and so is one that takes its value from `[io]` or
    /// `[retain]` although each scan gives it another: M8000.
    ///
    /// # Errors
    /// The first one.
    pub fn check_io(&self, model: &Model) -> Result<(), Error> {
        for Connected {
            connection,
            rows,
            fault,
            ..
        } in &self.io
        {
            let ranges = connection.rows.iter().zip(rows);
            let ranges =
                ranges.map(|(row, span)| (run(row.class, row.first, row.count), row.reads, span));
            let faults = connection.fault.iter();
            let faults = faults.map(|&(class, number)| (run(class, number, 1), true, fault));
            for (devices, is_set, &span) in ranges.chain(faults) {
                let of = devices.class;
                let mut numbers = devices.first..devices.first + devices.count;
                if let Some(missing) = numbers.find(|&number| !model.has(of, number)) {
                    let device = of.number(missing);
                    let message = format!("{device} does not exist on {}", model.title);
                    return Err(self.error(codes::IO_CONNECTION.at(span, message)));
                }
                if let Some(why) = set_by_scan(&devices, model).filter(|_| is_set) {
                    let error = codes::IO_CONNECTION.at(span, why);
                    return Err(self.error(error.help(ANOTHER_DEVICE)));
                }
            }
        }
        let Some(fault) = &self.retain_fault else {
            return Ok(());
        };
        self.exists(fault, model)?;
        match set_by_scan(&fault.run(), model) {
            Some(why) => {
                let error = codes::PROJECT_VALUE.at(fault.span, why);
                Err(self.error(error.help(ANOTHER_DEVICE)))
            }
            None => Ok(()),
        }
    }
}
