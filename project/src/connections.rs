//! `[io.NAME]`: what the terminals and registers of a running program are connected to.

use crate::{Error, Project};
use rungc_models::Model;
use rungc_models::runs::name_class;
use rungc_rt::io::{Connection, Kind};
use rungc_syntax::{Span, codes};
use std::path::Path;

/// A connection, with the places of what it says.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Connected {
    /// The connection.
    pub connection: Connection,
    /// Where its name is.
    pub span: Span,
    /// Where the devices of its rows are.
    pub rows: Vec<Span>,
    /// Where its fault device is.
    pub fault: Span,
}

impl Project {
    /// What `[io]` connects, with paths as seen from the caller's folder.
    pub fn connections(&self) -> Vec<Connection> {
        let connected = self.io.iter().map(|row| {
            let mut connection = row.connection.clone();
            let seen = |path: &str| self.at(Path::new(path)).display().to_string();
            if connection.kind == Kind::Files {
                connection.end = seen(&connection.end);
            }
            if let Some(file) = connection.options.get_mut("password-file") {
                *file = seen(file);
            }
            connection
        });
        connected.collect()
    }

    /// A device of `[io]` that the model does not have is a mistake.
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
            let ranges = ranges.map(|(row, span)| (row.class, row.first, row.count, span));
            let faults = connection.fault.iter();
            let faults = faults.map(|&(class, number)| (class, number, 1, fault));
            for (of, first, count, &span) in ranges.chain(faults) {
                let of = name_class(of);
                let mut numbers = first..first + count;
                if let Some(missing) = numbers.find(|&number| !model.has(of, number)) {
                    let device = of.number(missing);
                    let message = format!("{device} does not exist on {}", model.title);
                    return Err(self.mistake(codes::IO_CONNECTION.at(span, message)));
                }
            }
        }
        Ok(())
    }
}
