//! Connections from a file, for hosts without a library for TOML.

use super::settings::{Connection, SettingError, overlap};

/// Reads the tables `[io.NAME]` of `rungc.toml`, one key and its value in each line; other tables are skipped.
/// What `rungc` itself reads as TOML, such as inline tables, is rejected here.
///
/// # Errors
/// The first mistake, with its line.
pub fn parse(text: &str) -> Result<Vec<Connection>, String> {
    let mut tables: Vec<Lines<'_>> = Vec::new();
    let mut inside = false;
    for (n, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        if let Some(header) = line.strip_prefix('[') {
            let name = header.split(']').next().unwrap_or_default().trim();
            let name = name.strip_prefix("io.").map(str::trim);
            inside = name.is_some();
            if let Some(name) = name {
                tables.push(Lines {
                    name,
                    at: n,
                    pairs: Vec::new(),
                });
            }
        } else if inside && !line.is_empty() && !line.starts_with('#') {
            let pair = pair(line).ok_or_else(|| format!("line {n}: write `key = \"value\"`"))?;
            if let Some(table) = tables.last_mut() {
                table.pairs.push((n, pair));
            }
        }
    }
    let connections: Result<Vec<_>, String> = tables.iter().map(Lines::read).collect();
    let connections = connections?;
    if connections.is_empty() {
        return Err("there is no table `[io.NAME]`".to_owned());
    }
    match overlap(&connections) {
        Some((device, n, _)) => Err(format!(
            "line {}: `{device}` takes its value from two places",
            tables[n].at
        )),
        None => Ok(connections),
    }
}

/// A table, with the numbers of its lines.
struct Lines<'a> {
    name: &'a str,
    at: usize,
    pairs: Vec<(usize, (&'a str, &'a str))>,
}

impl Lines<'_> {
    fn read(&self) -> Result<Connection, String> {
        let pairs: Vec<_> = self.pairs.iter().map(|(_, pair)| *pair).collect();
        Connection::read(self.name, &pairs).map_err(|errors| {
            let Some(SettingError {
                pair,
                message,
                help,
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
    (fits && !key.is_empty() && !value.is_empty() && rest(after)).then_some((key, value))
}
