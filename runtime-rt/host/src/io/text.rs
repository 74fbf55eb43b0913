//! Connections from a file, for hosts without a library for TOML.

use super::overlap::{Overlap, Part, overlap};
use super::settings::{Connection, SettingError};

/// Reads the tables `[io.NAME]` of `rungc.toml`, one key and its value in each line; other tables are skipped.
///
/// # Errors
/// The first mistake, with its line. What else TOML permits for connections, such as inline tables and dotted keys, is
/// one: nothing that `rungc` would connect is left out in silence.
pub fn parse(text: &str) -> Result<Vec<Connection>, String> {
    let mut tables: Vec<Lines<'_>> = Vec::new();
    let mut place = Place::Root;
    for (n, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if line.contains("\"\"\"") || line.contains("'''") {
            return Err(format!("line {n}: write a text in one line"));
        }
        if let Some(header) = line.strip_prefix('[') {
            place = Place::of(header).ok_or_else(|| format!("line {n}: {FORM}"))?;
            if let Place::Connection(name) = place {
                tables.push(Lines {
                    name,
                    at: n,
                    pairs: Vec::new(),
                });
            }
            continue;
        }
        match place {
            Place::Connection(_) => {
                let pair =
                    pair(line).ok_or_else(|| format!("line {n}: write `key = \"value\"`"))?;
                if let Some(table) = tables.last_mut() {
                    table.pairs.push((n, pair));
                }
            }
            Place::Io => return Err(format!("line {n}: {FORM}")),
            Place::Root if part(line.split(['=', '.']).next()) == "io" => {
                return Err(format!("line {n}: {FORM}"));
            }
            Place::Root | Place::Other => {}
        }
    }
    let connections: Result<Vec<_>, String> = tables.iter().map(Lines::read).collect();
    let connections = connections?;
    if connections.is_empty() {
        return Err("there is no table `[io.NAME]`".to_owned());
    }
    match overlap(&connections, None) {
        Some(overlap) => Err(tables[overlap.connection].contradicts(&overlap)),
        None => Ok(connections),
    }
}

/// How connections are written.
const FORM: &str =
    "write each connection as a separate table, `[io.NAME]`, with a key and its value in each line";

/// Table that a line belongs to.
#[derive(Clone, Copy)]
enum Place<'a> {
    /// None: the beginning of the file.
    Root,
    /// `[io]`, which has no keys itself.
    Io,
    /// `[io.NAME]`.
    Connection(&'a str),
    /// Another table.
    Other,
}

impl<'a> Place<'a> {
    /// The place after a header, of which this is the rest after its bracket; `None` if it is a connection in another
    /// form.
    fn of(header: &'a str) -> Option<Place<'a>> {
        let is_list = header.starts_with('[');
        let name = header.trim_start_matches('[').split(']').next();
        let mut parts = name.unwrap_or_default().split('.');
        if part(parts.next()) != "io" {
            return Some(Place::Other);
        }
        match (parts.next(), parts.next()) {
            _ if is_list => None,
            (None, _) => Some(Place::Io),
            (name @ Some(_), None) => Some(Place::Connection(part(name))),
            _ => None,
        }
    }
}

/// A part of a dotted key, without its quotes.
fn part(text: Option<&str>) -> &str {
    text.unwrap_or_default().trim().trim_matches(['"', '\''])
}

/// A table, with the numbers of its lines.
struct Lines<'a> {
    name: &'a str,
    at: usize,
    pairs: Vec<(usize, (&'a str, &'a str))>,
}

impl Lines<'_> {
    /// Message that a row contradicts an earlier one.
    fn contradicts(&self, overlap: &Overlap) -> String {
        let is_row = |key: &str| key.starts_with(|c: char| c.is_ascii_uppercase());
        let mut rows = self.pairs.iter().filter(|(_, (key, _))| is_row(key));
        let of_key = |wanted: &str| self.pairs.iter().find(|(_, (key, _))| *key == wanted);
        let pair = match overlap.part {
            Part::Row(row) => rows.nth(row),
            Part::Fault => of_key("fault"),
            Part::Status => of_key("status"),
        };
        let line = pair.map_or(self.at, |pair| pair.0);
        format!("line {line}: {}; {}", overlap.message, overlap.help)
    }

    fn read(&self) -> Result<Connection, String> {
        let pairs: Vec<_> = self.pairs.iter().map(|(_, pair)| *pair).collect();
        Connection::read(self.name, &pairs).map_err(|errors| {
            let Some(SettingError {
                pair,
                message,
                help,
                ..
            }) = errors.first()
            else {
                return String::new();
            };
            let line = pair.and_then(|pair| self.pairs.get(pair));
            let line = line.map_or(self.at, |line| line.0);
            match help.as_str() {
                "" => format!("line {line}: {message}"),
                help => format!("line {line}: {message}; {help}"),
            }
        })
    }
}

/// The key and the value of a line: a text in quotes without escapes, a number or a truth value.
fn pair(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once('=')?;
    let (key, value) = (key.trim(), value.trim());
    let key = key.trim_matches('"');
    let rest = |rest: &str| rest.trim().is_empty() || rest.trim().starts_with('#');
    let quote = value.chars().next().filter(|c| ['"', '\''].contains(c));
    let (value, after) = match quote {
        Some(quote) => value[1..].split_once(quote)?,
        None => value.split_at(value.find([' ', '#']).unwrap_or(value.len())),
    };
    let plain = |c: char| c.is_ascii_alphanumeric();
    let fits = (quote.is_some() && !value.contains('\\')) || value.chars().all(plain);
    let is_there = quote.is_some() || !value.is_empty();
    (fits && !key.is_empty() && is_there && rest(after)).then_some((key, value))
}
