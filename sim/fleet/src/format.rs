//! `fleet.toml`: which programs run how often, and what each of their PLCs is connected to. Every mistake with its
//! place.

use crate::broker::{Broker, NUMBER, Rows};
use rungc_host::duration;
use rungc_host::io::{Connection, Kind, Row, SettingError};
use rungc_models::Model;
use rungc_models::runs::name_class;
use rungc_project::{Error, device};
use rungc_rt::comm::service::address;
use rungc_syntax::codes::FLEET_FILE;
use rungc_syntax::{DeviceClass, Diagnostic, Diagnostics, Phrase, Source, Span, diag, inputs};
use std::net::SocketAddr;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// PLCs of one program at most; a device number of `{n}` stays short.
const MOST: i64 = 1_000_000;

/// Units of a port at most: Modbus has no others.
const MOST_UNITS: i64 = 247;

/// The longest cycle, spread or repetition, in milliseconds.
const LONGEST_MS: u64 = 24 * 3_600_000;

const TABLES: [&str; 3] = ["fleet", "broker", "plc"];

const KEYS: [&str; 11] = [
    "program",
    "count",
    "first",
    "engine",
    "modbus-tcp",
    "units",
    "set",
    "spread",
    "repeat",
    "store",
    "topics",
];

type Value<'t> = Spanned<DeValue<'t>>;

/// A text of the file, and where it is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Position in the file.
    pub span: Span,
}

/// The engine of a group.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Choice {
    /// 64 at once if the program allows it and there are enough PLCs, else emitted C, else the interpreter.
    Auto,
    /// 64 at once.
    Lanes,
    /// Emitted C, one PLC after the other.
    C,
    /// The interpreter.
    Interp,
}

/// Topics of one PLC of a group.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Topics {
    /// Its rows, with `{n}` for the number of the PLC.
    rows: Vec<Row>,
    /// Positions of the rows.
    spans: Vec<Span>,
}

/// `[plc.NAME]`: a program and its PLCs.
#[derive(Clone, Debug)]
pub struct Plcs {
    /// Name in the file.
    pub name: Written,
    /// The program, as seen from the file.
    pub program: Written,
    /// Number of PLCs.
    pub count: u32,
    /// The number of the first.
    pub first: u32,
    /// Choice of the engine.
    pub engine: Choice,
    /// Position of the choice.
    pub engine_span: Span,
    /// The first address of Modbus TCP.
    pub modbus_tcp: Option<SocketAddr>,
    /// Position of the address.
    pub modbus_span: Span,
    /// Number of PLCs per port.
    pub units: Option<u32>,
    /// Settings: `X000=1@200ms`.
    pub set: Vec<Written>,
    /// Delay from a PLC to the next one in the settings, in milliseconds.
    pub spread_ms: u64,
    /// After how many milliseconds the settings begin again.
    pub repeat_ms: Option<u64>,
    /// Devices that are stored though the program may not name them: class, first and last number, and where each
    /// range is written.
    pub store: Vec<((DeviceClass, u32, u32), Span)>,
    /// Topics of a broker, to publish and to subscribe to.
    pub topics: Topics,
}

/// A file.
#[derive(Clone, Debug)]
pub struct Fleet {
    path: PathBuf,
    source: Source,
    /// Milliseconds from one scan to the next.
    pub cycle_ms: u64,
    /// The programs, in the order of their names.
    pub plcs: Vec<Plcs>,
    /// The broker, without rows.
    broker: Option<Connection>,
}

impl Fleet {
    /// Reads a file.
    ///
    /// # Errors
    /// What the system says, or all that is wrong with the file (E0870).
    pub fn load(path: &Path) -> Result<Fleet, Error> {
        let io = |error| Error::Io {
            path: path.to_owned(),
            error,
        };
        inputs::note(path);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let program = format!(
            "a fleet is a file with `[plc.NAME]` and `program = \"{name}\"` (`rungc book fleet`)"
        );
        let text = rungc_frontend::settings_file(path, &program).map_err(io)?;
        let other = |why| io(std::io::Error::other(why));
        Fleet::parse(path, &text).map_err(|error| {
            rungc_frontend::not_settings(path, &text, &program).map_or(error, other)
        })
    }

    /// Reads the text of a file. `path` is what it is called, and where its paths begin.
    ///
    /// # Errors
    /// All that is wrong with it (E0870).
    pub fn parse(path: &Path, text: &str) -> Result<Fleet, Error> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let mut fleet = Fleet {
            path: path.to_owned(),
            source: Source::new(name, text.strip_prefix('\u{feff}').unwrap_or(text)),
            cycle_ms: 10,
            plcs: Vec::new(),
            broker: None,
        };
        let mut reader = Reader::default();
        let text = fleet.source.text.clone();
        let (document, errors) = DeTable::parse_recoverable(&text);
        for error in errors {
            let at = span(error.span().unwrap_or(0..0));
            reader.report(at, error.message().trim().to_owned());
        }
        // Text after a line that is not TOML may belong to another table than it seems.
        if !reader.found.has_errors() {
            reader.document(document.get_ref(), &mut fleet);
        }
        match reader.found.has_errors() {
            true => Err(fleet.invalid(reader.found)),
            false => Ok(fleet),
        }
    }

    fn invalid(&self, diagnostics: Diagnostics) -> Error {
        Error::Invalid {
            path: self.path.clone(),
            text: Box::new(self.source.clone()),
            diagnostics,
        }
    }

    /// That something does not fit, for what only the caller can know.
    pub fn error(&self, why: Diagnostic) -> Error {
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(why);
        self.invalid(diagnostics)
    }

    /// The program of PLCs, as seen from the caller's folder.
    pub fn program(&self, plcs: &Plcs) -> PathBuf {
        self.at(&plcs.program.text)
    }

    fn at(&self, path: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// Connects the PLCs with the broker, if there is one.
    ///
    /// # Errors
    /// A connection that cannot be made at all; one that is lost is made again.
    pub fn connect(&self) -> Result<Option<Broker>, String> {
        let Some(broker) = &self.broker else {
            return Ok(None);
        };
        let mut broker = broker.clone();
        if let Some(file) = broker.options.get_mut("password-file") {
            *file = self.at(file).display().to_string();
        }
        let rows = self.plcs.iter().map(|plcs| Rows {
            rows: &plcs.topics.rows,
            first: plcs.first,
            count: plcs.count,
        });
        Broker::start(&broker, &rows.collect::<Vec<_>>()).map(Some)
    }
}

impl Plcs {
    /// The devices that its program has to store: those of its topics and those that are to be stored.
    ///
    /// # Errors
    /// One that the model does not have.
    pub fn observed(&self, model: &Model) -> Result<Vec<(DeviceClass, u32)>, Box<Diagnostic>> {
        let topics = self.topics.rows.iter().zip(&self.topics.spans);
        let topics = topics.map(|(row, span)| {
            let last = row.first + row.count - 1;
            ((name_class(row.class), row.first, last), *span)
        });
        let stored = self.store.iter().copied();
        let mut all = Vec::new();
        for ((class, first, last), span) in topics.chain(stored) {
            for number in first..=last {
                if !model.has(class, number) {
                    let device = class.number(number);
                    let message = format!("{device} does not exist on {}", model.title);
                    return Err(FLEET_FILE.at(span, message).into());
                }
                all.push((class, number));
            }
        }
        Ok(all)
    }
}

fn span(range: Range<usize>) -> Span {
    Span::new(range.start as u32, range.end as u32)
}

#[derive(Default)]
struct Reader {
    found: Diagnostics,
}

impl Reader {
    fn report(&mut self, at: Span, message: impl Into<Phrase>) {
        self.found.push(FLEET_FILE.at(at, message));
    }

    fn help(&mut self, at: Span, message: impl Into<Phrase>, help: impl Into<Phrase>) {
        let why = FLEET_FILE.at(at, message);
        self.found.push(match help.into() {
            help if help.is_empty() => why,
            help => why.help(help),
        });
    }

    /// A table or key that there is not.
    fn unknown(&mut self, at: Span, what: &str, name: &str, known: &[&str]) {
        let near = diag::did_you_mean(name, known.iter().copied());
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("valid names: {}", known.join(", ")),
        };
        self.help(at, format!("there is no {what} `{name}`"), help);
    }

    fn document(&mut self, document: &DeTable<'_>, fleet: &mut Fleet) {
        for (key, value) in document {
            let (name, at) = (key.get_ref().as_ref(), span(key.span()));
            if !TABLES.contains(&name) {
                self.unknown(at, "table", name, &TABLES);
                continue;
            }
            let Some(table) = value.get_ref().as_table() else {
                self.report(at, format!("`{name}` is a table: write `[{name}]`"));
                continue;
            };
            match name {
                "fleet" => self.fleet(table, fleet),
                "broker" => fleet.broker = self.broker(at, table),
                _ => self.all_plcs(table, fleet),
            }
        }
        if fleet.plcs.is_empty() && !self.found.has_errors() {
            let help =
                "write for example `[plc.press]` with `program = \"press.il\"` and `count = 100`";
            self.help(Span::default(), "the fleet has no PLC", help);
        }
        let topics = fleet.plcs.iter().find_map(|plcs| plcs.topics.spans.first());
        if let (None, Some(&at)) = (&fleet.broker, topics) {
            let help = "write for example `[broker]` with `mqtt = \"127.0.0.1:1883\"`";
            self.help(at, "topics without a broker", help);
        }
    }

    fn fleet(&mut self, table: &DeTable<'_>, fleet: &mut Fleet) {
        for (key, value) in table {
            match key.get_ref().as_ref() {
                "cycle" => fleet.cycle_ms = self.time(value, 1).unwrap_or(fleet.cycle_ms),
                name => self.unknown(span(key.span()), "key", name, &["cycle"]),
            }
        }
    }

    /// The connection without rows: what is wrong with it is found with a row that is right.
    fn broker(&mut self, at: Span, table: &DeTable<'_>) -> Option<Connection> {
        let (mut pairs, mut spans) = (Vec::new(), Vec::new());
        for (key, value) in table {
            let text = match value.get_ref() {
                DeValue::String(text) => text.to_string(),
                _ => {
                    self.report(span(value.span()), "this is a text: write it in quotes");
                    return None;
                }
            };
            pairs.push((key.get_ref().to_string(), text));
            spans.push(span(value.span()));
        }
        if !pairs.iter().any(|(key, _)| key == Kind::Mqtt.key()) {
            let help = "write for example `mqtt = \"127.0.0.1:1883\"`";
            self.help(at, "a broker has an address", help);
            return None;
        }
        if let Some(row) = pairs.iter().position(|(key, _)| is_row(key)) {
            let help = "write rows of devices into `[plc.NAME.topics]`";
            self.help(spans[row], "a broker has no devices", help);
            return None;
        }
        pairs.push(("M0".to_string(), "write row".to_string()));
        let mut connection = self.connection("broker", &pairs, &spans)?;
        connection.rows.clear();
        Some(connection)
    }

    fn connection(
        &mut self,
        name: &str,
        pairs: &[(String, String)],
        spans: &[Span],
    ) -> Option<Connection> {
        let texts: Vec<_> = pairs.iter().map(|(key, text)| (&**key, &**text)).collect();
        match Connection::read(name, &texts) {
            Ok(connection) => Some(connection),
            Err(invalid) => {
                for SettingError {
                    pair,
                    message,
                    help,
                    ..
                } in invalid
                {
                    let at = pair.and_then(|pair| spans.get(pair)).copied();
                    self.help(at.unwrap_or_default(), message, help);
                }
                None
            }
        }
    }

    fn all_plcs(&mut self, table: &DeTable<'_>, fleet: &mut Fleet) {
        for (key, value) in table {
            let at = span(key.span());
            let Some(table) = value.get_ref().as_table() else {
                let help = "write for example `[plc.press]`";
                self.help(at, "the PLCs of a program are a table with a name", help);
                continue;
            };
            let name = Written {
                text: key.get_ref().to_string(),
                span: at,
            };
            fleet.plcs.extend(self.plcs(name, table));
        }
    }

    fn plcs(&mut self, name: Written, table: &DeTable<'_>) -> Option<Plcs> {
        let at = name.span;
        let mut plcs = Plcs {
            program: Written {
                text: String::new(),
                span: at,
            },
            name,
            count: 1,
            first: 1,
            engine: Choice::Auto,
            engine_span: at,
            modbus_tcp: None,
            modbus_span: at,
            units: None,
            set: Vec::new(),
            spread_ms: 0,
            repeat_ms: None,
            store: Vec::new(),
            topics: Topics::default(),
        };
        for (key, value) in table {
            self.key(key.get_ref().as_ref(), span(key.span()), value, &mut plcs);
        }
        if plcs.program.text.is_empty() {
            let help = "write for example `program = \"press.il\"`";
            self.help(at, format!("`{}` has no program", plcs.name.text), help);
            return None;
        }
        if let (Some(_), None) = (plcs.units, plcs.modbus_tcp) {
            self.report(at, "`units` without `modbus-tcp`");
        }
        if plcs.count > 1 {
            let shared = plcs.topics.rows.iter().zip(&plcs.topics.spans);
            let shared = shared.filter(|(row, _)| !row.reads && !names_plc(row));
            let spans: Vec<Span> = shared.map(|(_, &span)| span).collect();
            for at in spans {
                let help = format!("name the PLC by `{NUMBER}` in the topic");
                self.help(at, "all PLCs would write to the same topic", help);
            }
        }
        Some(plcs)
    }

    fn key(&mut self, name: &str, at: Span, value: &Value<'_>, plcs: &mut Plcs) {
        let place = span(value.span());
        match name {
            "program" => plcs.program = self.text(value).unwrap_or(plcs.program.clone()),
            "count" => plcs.count = self.number(value, 1..=MOST).unwrap_or(1),
            "first" => plcs.first = self.number(value, 0..=MOST).unwrap_or(1),
            "units" => plcs.units = self.number(value, 1..=MOST_UNITS),
            "engine" => {
                plcs.engine_span = place;
                let text = self.text(value).map(|written| written.text);
                match text.as_deref() {
                    Some("auto") | None => {}
                    Some("lanes") => plcs.engine = Choice::Lanes,
                    Some("c") => plcs.engine = Choice::C,
                    Some("interp") => plcs.engine = Choice::Interp,
                    Some(other) => {
                        self.unknown(place, "engine", other, &["auto", "lanes", "c", "interp"])
                    }
                }
            }
            "modbus-tcp" => {
                plcs.modbus_span = place;
                let text = match value.get_ref() {
                    DeValue::Integer(port) => Some(port.as_str().to_string()),
                    _ => self.text(value).map(|written| written.text),
                };
                plcs.modbus_tcp = text.as_deref().and_then(address);
                if let (Some(text), None) = (text, plcs.modbus_tcp) {
                    let help = "write for example \"127.0.0.1:5020\"";
                    self.help(place, format!("`{text}` is not an address"), help);
                }
            }
            "set" => plcs.set = self.texts(value),
            "spread" => plcs.spread_ms = self.time(value, 0).unwrap_or(0),
            "repeat" => plcs.repeat_ms = self.time(value, 1),
            "store" => {
                for Written { text, span } in self.texts(value) {
                    match device::range(&text) {
                        Some(range) => plcs.store.push((range, span)),
                        None => {
                            let message = format!("`{text}` is not a range of devices");
                            self.help(span, message, "write for example \"D0-D99\"");
                        }
                    }
                }
            }
            "topics" => plcs.topics = self.topics(value),
            name => self.unknown(at, "key", name, &KEYS),
        }
    }

    fn topics(&mut self, value: &Value<'_>) -> Topics {
        let Some(table) = value.get_ref().as_table() else {
            self.report(span(value.span()), "`topics` is a table");
            return Topics::default();
        };
        let (mut pairs, mut spans) = (Vec::new(), Vec::new());
        for (key, value) in table {
            let (name, at) = (key.get_ref().to_string(), span(key.span()));
            if !is_row(&name) {
                let help = "write for example `X000-X007 = \"read hall/{n}/{}\"`";
                self.help(at, format!("`{name}` is not a range of devices"), help);
            } else if let Some(text) = self.text(value) {
                pairs.push((name, text.text));
                spans.push(at);
            }
        }
        if pairs.is_empty() {
            return Topics::default();
        }
        // The topic's place is that of its row.
        let own = spans.clone();
        pairs.push((Kind::Mqtt.key().to_string(), "broker".to_string()));
        let connection = self.connection("topics", &pairs, &own);
        let rows = connection.map_or_else(Vec::new, |connection| connection.rows);
        Topics { rows, spans }
    }

    fn text(&mut self, value: &Value<'_>) -> Option<Written> {
        let at = span(value.span());
        match value.get_ref() {
            DeValue::String(text) => Some(Written {
                text: text.to_string(),
                span: at,
            }),
            _ => {
                self.report(at, "this is a text: write it in quotes");
                None
            }
        }
    }

    fn texts(&mut self, value: &Value<'_>) -> Vec<Written> {
        match value.get_ref() {
            DeValue::Array(list) => list.iter().filter_map(|one| self.text(one)).collect(),
            _ => {
                self.report(span(value.span()), "this is a list: write it in brackets");
                Vec::new()
            }
        }
    }

    fn number(&mut self, value: &Value<'_>, range: RangeInclusive<i64>) -> Option<u32> {
        let number = match value.get_ref() {
            DeValue::Integer(number) => i64::from_str_radix(number.as_str(), number.radix()).ok(),
            _ => None,
        };
        let number = number.filter(|number| range.contains(number));
        if number.is_none() {
            let (first, last) = (range.start(), range.end());
            let message = format!("this is a whole number from {first} to {last}");
            self.report(span(value.span()), message);
        }
        number.and_then(|number| u32::try_from(number).ok())
    }

    fn time(&mut self, value: &Value<'_>, least: u64) -> Option<u64> {
        let at = span(value.span());
        let text = match value.get_ref() {
            DeValue::Integer(number) => number.to_string(),
            DeValue::Float(number) => number.to_string(),
            _ => self.text(value)?.text,
        };
        match duration::parse_within(&text, least..=LONGEST_MS) {
            Ok(ms) => Some(ms),
            Err(why) => {
                self.report(at, why);
                None
            }
        }
    }
}

/// Returns true if a key is that of a row: a range of devices begins with a capital letter.
fn is_row(key: &str) -> bool {
    key.starts_with(|c: char| c.is_ascii_uppercase())
}

/// Returns true if the topic of a row includes the number of the PLC.
fn names_plc(row: &Row) -> bool {
    matches!(&row.end, rungc_host::io::End::Name(topic) if topic.contains(NUMBER))
}
