//! `[io.NAME]`.

use super::{Reader, Value, span};
use crate::Project;
use crate::connections::Connected;
use rungc_host::io::{Connection, Part, overlap};
use rungc_models::runs::rt_class;
use rungc_syntax::{Span, codes};
use toml::de::{DeTable, DeValue};

/// The table of connections.
pub(super) const IO: &str = "io";

impl Reader {
    pub(super) fn io(&mut self, table: &DeTable<'_>, project: &mut Project) {
        for (key, value) in table {
            let (name, at) = (key.get_ref().as_ref(), span(key.span()));
            match value.get_ref().as_table() {
                Some(table) => project.io.extend(self.connection(name, at, table)),
                None => {
                    let help =
                        "write `[io.remote]` on its own line, and the keys of the connection below";
                    self.misconnected(at, "a connection is a table".to_owned(), help);
                }
            }
        }
    }

    /// Reports devices and places with two sources, once all tables are read.
    pub(super) fn overlapping(&mut self, project: &Project) {
        let fault = project.retain_fault;
        let fault = fault.and_then(|fault| Some((rt_class(fault.class)?, fault.first)));
        if let Some(overlap) = overlap(&project.connections(), fault) {
            let connected = &project.io[overlap.connection];
            let at = match overlap.part {
                Part::Row(row) => connected.rows.get(row).copied(),
                Part::Fault => Some(connected.fault),
                Part::Status => None,
            };
            let at = at.unwrap_or(connected.span);
            self.misconnected(at, overlap.message, overlap.help);
        }
    }

    fn connection(&mut self, name: &str, at: Span, table: &DeTable<'_>) -> Option<Connected> {
        let mut pairs = Vec::new();
        let mut places = Vec::new();
        for (key, value) in table {
            let word = key.get_ref().as_ref();
            let Some(text) = text(value) else {
                let message = format!("`{word}` must be a string or a number");
                self.misconnected(span(value.span()), message, "");
                continue;
            };
            pairs.push((word, text));
            places.push((span(key.span()), span(value.span())));
        }
        if pairs.len() < table.len() {
            return None;
        }
        let is_row = |word: &str| word.starts_with(|c: char| c.is_ascii_uppercase());
        match Connection::read(name, &pairs) {
            Ok(connection) => {
                let all = || pairs.iter().zip(&places);
                let rows = all().filter(|((word, _), _)| is_row(word));
                let mut faults = all().filter(|((word, _), _)| *word == "fault");
                Some(Connected {
                    connection,
                    span: at,
                    rows: rows.map(|(_, place)| place.0).collect(),
                    fault: faults.next().map_or(at, |(_, place)| place.1),
                })
            }
            Err(errors) => {
                for error in errors {
                    let place = error.pair.map(|pair| match error.of_key {
                        true => places[pair].0,
                        false => places[pair].1,
                    });
                    let at = place.unwrap_or(at);
                    self.misconnected(at, error.message, &error.help);
                }
                None
            }
        }
    }

    fn misconnected(&mut self, at: Span, message: String, help: &str) {
        let error = codes::IO_CONNECTION.at(at, message);
        self.found.push(match help {
            "" => error,
            help => error.help(help.to_owned()),
        });
    }
}

/// A text as it is, a number and a truth value as they are written.
fn text<'v>(value: &'v Value<'_>) -> Option<&'v str> {
    match value.get_ref() {
        DeValue::String(text) => Some(text),
        DeValue::Integer(number) if number.radix() == 10 => Some(number.as_str()),
        DeValue::Boolean(true) => Some("true"),
        DeValue::Boolean(false) => Some("false"),
        _ => None,
    }
}
