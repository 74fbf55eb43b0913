//! From TOML to [`Project`], every mistake with its place.

mod canlink;
mod check;
mod io;
mod labels;
mod modbus;
mod module;
mod plcopen;
mod property;
mod serve;

use crate::{Bound, Named, Project, Range as DeviceRange, device};
use canlink::CANLINK;
use encoding_rs::Encoding;
use io::IO;
use modbus::MODBUS;
use module::MODULE;
use property::PROPERTY;
use rungc_models::Plc;
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, Span, codes, diag};
use std::ops::{Range, RangeInclusive};
use std::path::PathBuf;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The tables, and their keys where these are fixed.
const TABLES: [(&str, &[&str]); 19] = [
    (
        "project",
        &["program", "model", "name", "encoding", "compiled"],
    ),
    ("check", &["allow", "warn", "deny"]),
    ("report", &["lang"]),
    ("build", &["target", "board", "emit", "output", "access"]),
    ("test", &["files", "engine"]),
    ("tokens", &[]),
    ("index", &[]),
    ("latched", &[]),
    ("labels", &[]),
    ("retain", &["file", "fault"]),
    ("plcopen", &["names", "free"]),
    ("serve", &[]),
    ("hmi", &["reads", "writes"]),
    (IO, &[]),
    ("verify", &["assume", "free", "scan", "effort", "timeout"]),
    (MODBUS, &[]),
    (CANLINK, canlink::KEYS),
    (MODULE, &[]),
    (PROPERTY, &[]),
];

/// Classes with devices that can be latched.
const LATCHABLE: [DeviceClass; 6] = {
    use DeviceClass::*;
    [M, S, T, C, D, R]
};

/// Classes with devices that ports serve.
const SERVED: [DeviceClass; 8] = {
    use DeviceClass::*;
    [X, Y, M, S, T, C, D, R]
};

/// The body of an instruction is no longer, in bytes.
const MAX_BODY: usize = 64;

type Value<'t> = Spanned<DeValue<'t>>;

/// Reads the text of a file: what it says, and what is wrong with it.
pub fn read(text: &str) -> (Project, Diagnostics) {
    let mut reader = Reader {
        found: Diagnostics::new(),
    };
    let (document, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        let range = error.span().unwrap_or(0..0);
        let message = error.message().trim().to_string();
        reader
            .found
            .push(codes::PROJECT_SYNTAX.at(span(range), message));
    }
    let mut project = Project::default();
    // Text after a line that is not TOML may belong to another table than it seems.
    if !reader.found.has_errors() {
        reader.document(document.get_ref(), &mut project);
    }
    (project, reader.found)
}

fn span(range: Range<usize>) -> Span {
    Span::new(range.start as u32, range.end as u32)
}

/// `a`, `b` and `c`, in back quotes.
fn listed(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => String::new(),
    }
}

/// The most similar of the names, else all of them. One letter is similar to any other.
fn hint(word: &str, names: &[&str]) -> String {
    let near = diag::did_you_mean(word, names.iter().copied());
    match near.filter(|near| near.len() > 1) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("valid names: {}", listed(names)),
    }
}

/// The most similar of the keys of all tables, with its table; else the tables.
fn key_meant(word: &str) -> String {
    let keys = || TABLES.iter().flat_map(|(_, keys)| keys.iter().copied());
    let near = diag::did_you_mean(word, keys()).filter(|near| near.len() > 1);
    let home = near.and_then(|near| TABLES.iter().find(|(_, keys)| keys.contains(&near)));
    match (near, home) {
        (Some(near), Some((table, _))) => format!("did you mean `{near}` in `[{table}]`?"),
        _ => {
            let tables: Vec<_> = TABLES.iter().map(|(table, _)| *table).collect();
            format!("keys stand in a table: {}", listed(&tables))
        }
    }
}

struct Reader {
    found: Diagnostics,
}

impl Reader {
    fn document(&mut self, document: &DeTable<'_>, project: &mut Project) {
        for (key, value) in document {
            let (name, at) = (key.get_ref().as_ref(), span(key.span()));
            let Some((_, keys)) = TABLES.iter().find(|(table, _)| *table == name) else {
                let tables: Vec<_> = TABLES.iter().map(|(table, _)| *table).collect();
                let what = if value.get_ref().is_table() {
                    "table"
                } else {
                    "key"
                };
                let message = format!("unknown {what} `{name}`");
                let unknown = codes::PROJECT_KEY.at(at, message).label("unknown");
                let home = TABLES.iter().find(|(_, keys)| keys.contains(&name));
                let help = home.map(|(table, _)| format!("it belongs in `[{table}]`"));
                let meant = || match value.get_ref().is_table() {
                    true => hint(name, &tables),
                    false => key_meant(name),
                };
                let help = help.unwrap_or_else(meant);
                self.found.push(unknown.help(help));
                continue;
            };
            match name {
                MODBUS => {
                    self.modbus(at, value, project);
                    continue;
                }
                MODULE => {
                    self.modules(at, value, project);
                    continue;
                }
                PROPERTY => {
                    self.properties(at, value, project);
                    continue;
                }
                _ => {}
            }
            let Some(table) = value.get_ref().as_table() else {
                let message = format!("`{name}` is a table");
                self.wrong(
                    at,
                    message,
                    &format!("write `[{name}]` on its own line, and its keys below"),
                );
                continue;
            };
            if !keys.is_empty() {
                self.known(name, table, keys);
            }
            match name {
                "project" => self.project(table, project),
                "check" => self.check(table, project),
                "report" => self.report(table, project),
                "build" => self.build(table, project),
                "test" => self.test(table, project),
                "tokens" => self.tokens(table, project),
                "index" => self.index(table, project),
                "retain" => {
                    project.retain = self.path(table, "file");
                    project.retain_fault = self.fault(table);
                }
                "serve" => self.serve(table, project),
                "hmi" => self.hmi(table, project),
                IO => self.io(table, project),
                "verify" => self.verify(table, project),
                "plcopen" => self.plcopen(table, project),
                "labels" => self.labels(table, project),
                CANLINK => self.canlink(at, table, project),
                _ => self.latched(table, project),
            }
        }
        self.together(document, project);
        self.overlapping(project);
    }

    /// Reports keys that mean nothing without another.
    fn together(&mut self, document: &DeTable<'_>, project: &Project) {
        let place = |table: &str, key: &str| {
            let table = document.get(table)?.get_ref().as_table()?;
            Some(span(table.get(key)?.span()))
        };
        let output = place("build", "output");
        for (key, at) in [("name", place("project", "name")), ("output", output)] {
            if let (Some(at), None) = (at, &project.program) {
                let message =
                    format!("`{key}` applies to the project's program, but there is none");
                self.wrong(at, message, "add `program = \"…\"` to `[project]`");
            }
        }
        let modbus = project.modbus.first().map(|row| row.span);
        let canlink = project.canlink.as_ref().map(|station| station.span);
        let labels = project.labels.first().map(|label| label.span);
        for (table, at) in [
            ("[[modbus]]", modbus),
            ("[canlink]", canlink),
            ("[labels]", labels),
        ] {
            if let (Some(at), None) = (at, &project.program) {
                let message =
                    format!("`{table}` applies to the project's program, but there is none");
                self.wrong(at, message, "add `program = \"…\"` to `[project]`");
            }
        }
        if let (Some(at), None) = (output, &project.build.emit) {
            let message = "`output` requires `emit`";
            self.wrong(at, message, "add `emit = \"…\"`");
        }
    }

    fn wrong(&mut self, at: Span, message: impl Into<Phrase>, help: &str) {
        let mistake = codes::PROJECT_VALUE.at(at, message);
        self.found.push(match help {
            "" => mistake,
            help => mistake.help(help.to_string()),
        });
    }

    /// Reports keys that a table does not have.
    fn known(&mut self, name: &str, table: &DeTable<'_>, keys: &[&str]) {
        for key in table.keys() {
            let word = key.get_ref().as_ref();
            if !keys.contains(&word) {
                let message = format!("`[{name}]` has no key `{word}`");
                let unknown = codes::PROJECT_KEY.at(span(key.span()), message);
                self.found
                    .push(unknown.label("unknown").help(hint(word, keys)));
            }
        }
    }

    /// A text.
    fn text(&mut self, key: &str, value: &Value<'_>) -> Option<Named> {
        self.string(value, format!("`{key}` must be a string"))
    }

    /// A text; what is wrong otherwise.
    fn string(&mut self, value: &Value<'_>, wrong: String) -> Option<Named> {
        let at = span(value.span());
        match value.get_ref().as_str() {
            Some("") => self.wrong(at, "this string is empty", ""),
            Some(text) => {
                return Some(Named {
                    text: text.to_string(),
                    span: at,
                });
            }
            None => self.wrong(at, wrong, "put it in quotes"),
        }
        None
    }

    /// A duration: a text, or a number of milliseconds.
    fn duration(&mut self, table: &DeTable<'_>, key: &str) -> Option<Named> {
        let value = table.get(key)?;
        let text = match value.get_ref() {
            DeValue::Integer(number) => number.to_string(),
            DeValue::Float(number) => number.to_string(),
            _ => return self.text(key, value),
        };
        let span = span(value.span());
        Some(Named { text, span })
    }

    fn get(&mut self, table: &DeTable<'_>, key: &str) -> Option<Named> {
        let value = table.get(key)?;
        self.text(key, value)
    }

    /// Value of a boolean setting; `false` if it is missing.
    fn flag(&mut self, table: &DeTable<'_>, key: &str) -> bool {
        let Some(value) = table.get(key) else {
            return false;
        };
        value.get_ref().as_bool().unwrap_or_else(|| {
            let message = format!("`{key}` must be true or false");
            self.wrong(span(value.span()), message, "");
            false
        })
    }

    fn path(&mut self, table: &DeTable<'_>, key: &str) -> Option<PathBuf> {
        self.get(table, key).map(|named| PathBuf::from(named.text))
    }

    /// `fault = "M100"`: a bit that shows that something does not work.
    fn fault(&mut self, table: &DeTable<'_>) -> Option<DeviceRange> {
        let Named { text, span } = self.get(table, "fault")?;
        match device::device(&text) {
            Some(
                device @ Device {
                    class: DeviceClass::Y | DeviceClass::M | DeviceClass::S,
                    ..
                },
            ) => Some(DeviceRange::one(device, span)),
            _ => {
                let message = format!("`{text}` is not a bit device Y, M or S");
                self.wrong(span, message, "write for example `fault = \"M100\"`");
                None
            }
        }
    }

    /// A list of texts.
    fn list(&mut self, table: &DeTable<'_>, key: &str) -> Vec<Named> {
        let Some(value) = table.get(key) else {
            return Vec::new();
        };
        let Some(values) = value.get_ref().as_array() else {
            let help = format!("write `{key} = [\"…\"]`");
            self.wrong(span(value.span()), format!("`{key}` must be a list"), &help);
            return Vec::new();
        };
        let wrong = |value| (value, format!("`{key}` must be a list of strings"));
        let values = values.iter().map(wrong);
        values
            .filter_map(|(value, wrong)| self.string(value, wrong))
            .collect()
    }

    /// `program = "Main.st"`, or the list of its files.
    fn program(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let is_list = |value: &Value| value.get_ref().is_array();
        let is_list = table.get("program").is_some_and(is_list);
        let files = match is_list {
            true => self.list(table, "program"),
            false => self.get(table, "program").into_iter().collect(),
        };
        if let Some(first) = files.first() {
            project.program = Some(PathBuf::from(&first.text));
            project.program_span = first.span;
        }
        if files.len() < 2 {
            return;
        }
        let is_text = |file: &&Named| !file.text.to_ascii_lowercase().ends_with(".st");
        if let Some(other) = files.iter().find(is_text) {
            let message = format!("`{}` is not a file in structured text", other.text);
            let help = "only files that end in `.st` are one program; name others one at a time";
            self.wrong(other.span, message, help);
        }
        let parts = files.into_iter().map(|file| PathBuf::from(file.text));
        project.parts = parts.collect();
    }

    fn project(&mut self, table: &DeTable<'_>, project: &mut Project) {
        self.program(table, project);
        if let Some(name) = self.get(table, "model") {
            match Plc::named(&name.text) {
                Ok(plc) => (project.model, project.variant) = (Some(plc.model), plc.variant),
                Err(unknown) => self.wrong(name.span, unknown.message, &unknown.help),
            }
        }
        project.name = self.get(table, "name").map(|name| name.text);
        project.compiled = self.get(table, "compiled").and_then(|state| {
            let is_state =
                |text: &str| text.len() == 16 && text.bytes().all(|b| b.is_ascii_hexdigit());
            let found = is_state(&state.text).then(|| state.text.to_lowercase());
            if found.is_none() {
                let message = format!("`{}` is not the state of a project", state.text);
                self.wrong(
                    state.span,
                    message,
                    "copy the 16 digits that note N0012 shows",
                );
            }
            found
        });
        project.encoding = self.get(table, "encoding").and_then(|name| {
            let encoding = Encoding::for_label(name.text.as_bytes());
            if encoding.is_none() {
                let message = format!("unknown encoding `{}`", name.text);
                let help =
                    "for example `gbk`, `shift_jis`, `windows-1252`, `windows-1251` or `utf-8`";
                self.wrong(name.span, message, help);
            }
            encoding
        });
    }

    fn build(&mut self, table: &DeTable<'_>, project: &mut Project) {
        project.build.target = self.get(table, "target");
        project.build.board = self.path(table, "board");
        project.build.emit = self.get(table, "emit");
        project.build.output = self.path(table, "output");
        project.build.access = self.flag(table, "access");
    }

    fn test(&mut self, table: &DeTable<'_>, project: &mut Project) {
        project.test.files = self.list(table, "files");
        project.test.engine = self.get(table, "engine");
    }

    fn tokens(&mut self, table: &DeTable<'_>, project: &mut Project) {
        for (key, value) in table {
            let word = key.get_ref().as_ref();
            let Some(body) = bytes(word) else {
                let message = format!("`{word}` is not the body of an instruction");
                let help = "write its bytes as pairs of hexadecimal digits: `\"56 09 02\"`";
                self.wrong(span(key.span()), message, help);
                continue;
            };
            let Some(name) = self.text(word, value) else {
                continue;
            };
            let mnemonic = name.text.to_uppercase();
            if rungc_catalogue::find(&mnemonic).is_none() {
                let names: Vec<_> = rungc_catalogue::all().map(|row| row.name).collect();
                let near = diag::did_you_mean(&mnemonic, names);
                let help = near.map_or(String::new(), |near| format!("did you mean `{near}`?"));
                let message = format!("no model has the instruction `{}`", name.text);
                self.wrong(name.span, message, &help);
            } else if project.learned.get(&body).is_some() {
                self.wrong(span(key.span()), "these bytes are listed twice", "");
            } else if let Err(error) = project.learned.insert(&body, &mnemonic) {
                self.wrong(name.span, error.to_string(), "remove this line");
            }
        }
    }

    fn index(&mut self, table: &DeTable<'_>, project: &mut Project) {
        for (key, value) in table {
            let word = key.get_ref().as_ref();
            let Some((base, index)) = device::indexed(&word.to_uppercase()) else {
                let message = format!("`{word}` is not a device with an index register");
                let help = "write for example `\"D100Z0\" = \"D100-D163\"`";
                self.wrong(span(key.span()), message, help);
                continue;
            };
            let Some(named) = self.text(word, value) else {
                continue;
            };
            let Some((first, last)) = self.range(&named, base.class) else {
                continue;
            };
            let twice = |bound: &Bound| {
                (bound.class, bound.number, bound.index) == (base.class, base.number, index)
            };
            if project.index.iter().any(twice) {
                self.wrong(span(key.span()), format!("`{word}` is listed twice"), "");
                continue;
            }
            project.index.push(Bound {
                class: base.class,
                number: base.number,
                index,
                first,
                last,
                span: named.span,
            });
        }
    }

    /// A range of devices of a class.
    fn range(&mut self, named: &Named, class: DeviceClass) -> Option<(u32, u32)> {
        match device::range(&named.text.to_uppercase()) {
            Some((found, first, last)) if found == class => Some((first, last)),
            _ => {
                let letters = class.prefix();
                let message = format!("`{}` is not a range of {letters} devices", named.text);
                let (first, last) = (class.number(64), class.number(127));
                let help = as_list(&named.text)
                    .unwrap_or_else(|| format!("write for example `{first}-{last}`"));
                self.wrong(named.span, message, &help);
                None
            }
        }
    }

    /// The entries of a table of which there are several.
    fn rows<'v, 't>(
        &mut self,
        name: &str,
        at: Span,
        value: &'v Value<'t>,
    ) -> Vec<(Span, &'v DeTable<'t>)> {
        let Some(rows) = value.get_ref().as_array() else {
            let help = format!("write `[[{name}]]` on its own line, and the keys of the row below");
            self.wrong(at, format!("each row of `{name}` is a table"), &help);
            return Vec::new();
        };
        let mut tables = Vec::new();
        for row in rows {
            let at = span(row.span());
            match row.get_ref().as_table() {
                Some(table) => tables.push((at, table)),
                None => self.wrong(at, format!("a row of `{name}` is a table"), ""),
            }
        }
        tables
    }

    /// A number of a row; the usual one if the row does not say it.
    fn number(
        &mut self,
        table: &DeTable<'_>,
        row: Span,
        key: &str,
        range: RangeInclusive<u32>,
        usual: Option<u32>,
    ) -> Option<u32> {
        let Some(value) = table.get(key) else {
            if usual.is_none() {
                self.wrong(row, format!("a row has `{key}`"), "");
            }
            return usual;
        };
        let digits = value.get_ref().as_integer();
        let number = digits.and_then(|n| u32::from_str_radix(n.as_str(), n.radix()).ok());
        let number = number.filter(|number| range.contains(number));
        if number.is_none() {
            let message = format!("`{key}` is {} to {}", range.start(), range.end());
            self.wrong(span(value.span()), message, "");
        }
        number
    }

    /// A device of a row, if it names one; `None` for one of another class.
    fn row_device(
        &mut self,
        table: &DeTable<'_>,
        key: &str,
        classes: &[DeviceClass],
    ) -> Option<Option<Device>> {
        let Some(named) = self.get(table, key) else {
            return Some(None);
        };
        let found = device::device(&named.text.to_uppercase());
        let fits = found.filter(|device| classes.contains(&device.class));
        if fits.is_none() {
            let letters: Vec<_> = classes.iter().map(|class| class.prefix()).collect();
            let message = format!("`{}` is not a device {}", named.text, letters.join(", "));
            self.wrong(named.span, message, "");
        }
        fits.map(Some)
    }

    fn latched(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let letters: Vec<_> = LATCHABLE.iter().map(|class| class.prefix()).collect();
        self.known("latched", table, &letters);
        for class in LATCHABLE {
            project.latched.extend(self.ranges(table, class));
        }
    }

    /// `writes = "D70-D79"` and `reads = "M0-M15"`, or lists of such ranges.
    fn hmi(&mut self, table: &DeTable<'_>, project: &mut Project) {
        let keys = [
            ("reads", "M0-M15", &mut project.hmi_reads),
            ("writes", "D70-D79", &mut project.hmi),
        ];
        for (key, example, ranges) in keys {
            for range in self.devices(table, key, example) {
                if SERVED.contains(&range.class) {
                    ranges.push(range);
                    continue;
                }
                let letters: Vec<_> = SERVED.iter().map(|class| class.prefix()).collect();
                let message = format!("a panel {key} devices {}", letters.join(", "));
                self.wrong(range.span, message, "");
            }
        }
    }

    /// Ranges of devices of any class: one, or a list of them.
    fn devices(&mut self, table: &DeTable<'_>, key: &str, example: &str) -> Vec<DeviceRange> {
        let mut ranges = Vec::new();
        for named in self.one_or_more(table, key) {
            match device::range(&named.text.to_uppercase()) {
                Some((class, first, last)) => ranges.push(DeviceRange {
                    class,
                    first,
                    last,
                    span: named.span,
                }),
                None => {
                    let message = format!("`{}` names no devices", named.text);
                    let help = as_list(&named.text)
                        .unwrap_or_else(|| format!("write for example `{example}`"));
                    self.wrong(named.span, message, &help);
                }
            }
        }
        ranges
    }

    /// A text, or a list of them.
    fn one_or_more(&mut self, table: &DeTable<'_>, key: &str) -> Vec<Named> {
        match table.get(key) {
            Some(value) if value.get_ref().is_array() => self.list(table, key),
            Some(value) => self.text(key, value).into_iter().collect(),
            None => Vec::new(),
        }
    }

    /// Ranges of devices of a class: one, or a list of them.
    fn ranges(&mut self, table: &DeTable<'_>, class: DeviceClass) -> Vec<DeviceRange> {
        let named = self.one_or_more(table, class.prefix()).into_iter();
        let ranges = named.filter_map(|named| {
            let (first, last) = self.range(&named, class)?;
            Some(DeviceRange {
                class,
                first,
                last,
                span: named.span,
            })
        });
        ranges.collect()
    }
}

/// The help for several ranges in one text, which a list has to separate.
fn as_list(text: &str) -> Option<String> {
    let parts: Vec<_> = text.split(',').map(str::trim).collect();
    let ranges = parts
        .iter()
        .all(|part| device::range(&part.to_uppercase()).is_some());
    (parts.len() > 1 && ranges).then(|| format!("write a list: `[\"{}\"]`", parts.join("\", \"")))
}

/// Bytes as pairs of hexadecimal digits, with or without spaces between them.
fn bytes(text: &str) -> Option<Vec<u8>> {
    let digits: Vec<u32> = text
        .split_whitespace()
        .flat_map(str::chars)
        .map(|c| c.to_digit(16))
        .collect::<Option<_>>()?;
    let fits = digits.len().is_multiple_of(2) && (1..=MAX_BODY).contains(&(digits.len() / 2));
    fits.then(|| {
        digits
            .chunks(2)
            .map(|pair| (pair[0] << 4 | pair[1]) as u8)
            .collect()
    })
}
