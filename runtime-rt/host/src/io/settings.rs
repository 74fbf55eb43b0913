//! Connections, and how their keys and values are read.

use super::topics::address;
use crate::duration;
use rungc_rt::Class;
use rungc_rt::comm::modbus::Limits;
use std::collections::BTreeMap;
use std::ops::Range;

/// Kind of remote end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Kind {
    /// Remote I/O over TCP.
    ModbusTcp,
    /// Remote I/O on a serial line.
    ModbusRtu,
    /// A broker.
    Mqtt,
    /// The pins of this machine (Linux).
    Gpio,
    /// Files of a folder, each with the values of a row.
    Files,
    /// Standard input and output.
    Console,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 6] = [
        Kind::ModbusTcp,
        Kind::ModbusRtu,
        Kind::Mqtt,
        Kind::Gpio,
        Kind::Files,
        Kind::Console,
    ];

    /// Returns true if rows that are read are asked for, one by one, in each cycle.
    pub(super) const fn asks(self) -> bool {
        matches!(self, Kind::ModbusTcp | Kind::ModbusRtu | Kind::Files)
    }

    /// The key that says where its other end is.
    pub const fn key(self) -> &'static str {
        match self {
            Kind::ModbusTcp => "modbus-tcp",
            Kind::ModbusRtu => "modbus-rtu",
            Kind::Mqtt => "mqtt",
            Kind::Gpio => "gpio",
            Kind::Files => "files",
            Kind::Console => "console",
        }
    }

    /// The keys of its options, beside those of every connection.
    pub const fn options(self) -> &'static [&'static str] {
        match self {
            Kind::ModbusTcp => &["unit"],
            Kind::ModbusRtu => &["unit", "baud", "format"],
            Kind::Mqtt => &[
                "client",
                "user",
                "password-file",
                "status",
                "ca",
                "certificate",
                "key",
            ],
            Kind::Gpio | Kind::Files | Kind::Console => &[],
        }
    }

    /// Examples of rows, for help messages.
    const fn example(self) -> &'static str {
        match self {
            Kind::ModbusTcp | Kind::ModbusRtu => {
                "write for example `X000-X007 = \"read inputs 0\"`, `Y000-Y007 = \"write coils 0\"`, \
                 `D100 = \"read input-registers 0\"` or `D200 = \"write registers 0\"`"
            }
            Kind::Mqtt => {
                "write for example `X000 = \"read plant/start\"` or `Y000-Y007 = \"write plant/{}\"`"
            }
            Kind::Gpio => {
                "write for example `X000 = \"read 17 pull-up active-low\"` or `Y000 = \"write 22\"`"
            }
            Kind::Files => {
                "write for example `X000-X007 = \"read switches\"` or `Y000-Y007 = \"write lamps\"`"
            }
            Kind::Console => "write for example `X000-X007 = \"read\"` or `Y000-Y007 = \"write\"`",
        }
    }
}

/// Keys of every connection.
const COMMON: [&str; 4] = ["every", "timeout", "fault", "loss"];

/// Value of inputs while the remote end cannot be reached, unless their row specifies one.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Loss {
    /// Off, and 0.
    #[default]
    Zero,
    /// The last value.
    Hold,
}

/// A table of a Modbus slave.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Table {
    /// Coils: 01 and 0F.
    Coils,
    /// Discrete inputs: 02.
    Inputs,
    /// Holding registers: 03 and 10.
    Registers,
    /// Input registers: 04.
    InputRegisters,
}

/// Target of a row at the remote end.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum End {
    /// A run of a Modbus slave's devices.
    Modbus {
        /// Their table.
        table: Table,
        /// The first address, as on the line.
        address: u16,
    },
    /// A topic, or a file of the folder.
    Name(String),
    /// A line of a GPIO chip.
    Line {
        /// Its offset.
        offset: u32,
        /// Words after it: `active-low`, `pull-up`, `pull-down`, `open-drain`.
        flags: Vec<String>,
    },
    /// A line of text each time.
    Text,
}

/// Positions of a row's values among those of its direction.
pub type Place = Range<usize>;

/// Devices of consecutive numbers, and what they are connected to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Row {
    /// Their class: X, Y, M, S (bits), D or R (words).
    pub class: Class,
    /// Number of the first.
    pub first: u32,
    /// Number of devices.
    pub count: u32,
    /// True if the devices take values from the remote end, false if they supply them.
    pub reads: bool,
    /// Target they are connected to.
    pub end: End,
    /// The value of each while the other end cannot be reached; that of the connection if there is none.
    pub loss: Option<i16>,
    /// Positions of their values among those the connection reads, or writes.
    pub place: Place,
}

impl Row {
    /// Returns true if its devices are bits.
    pub fn is_bits(&self) -> bool {
        is_bits(self.class)
    }

    /// The name of device number `index` of the row: `X010`.
    pub fn name(&self, index: u32) -> String {
        device_name(self.class, self.first + index)
    }

    /// Its devices as they are written: `X000-X007`.
    pub fn devices(&self) -> String {
        match self.count {
            1 => self.name(0),
            count => format!("{}-{}", self.name(0), self.name(count - 1)),
        }
    }
}

/// Terminals and registers, and the other end that they are connected to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Connection {
    /// Name in the description.
    pub name: String,
    /// Kind of the remote end.
    pub kind: Kind,
    /// Address of the remote end.
    pub end: String,
    /// Milliseconds from the start of one cycle to the start of the next.
    pub every_ms: u64,
    /// Milliseconds after which an answer is missing.
    pub timeout_ms: u64,
    /// The bit that is on while the other end cannot be reached.
    pub fault: Option<(Class, u32)>,
    /// Value of inputs while the connection is lost.
    pub loss: Loss,
    /// Other keys, which its driver reads.
    pub options: BTreeMap<String, String>,
    /// Its devices.
    pub rows: Vec<Row>,
}

/// Error in a description.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SettingError {
    /// The place of the key among the pairs; none: what is wrong is the whole.
    pub pair: Option<usize>,
    /// True if the key is wrong, not its value.
    pub of_key: bool,
    /// Description of the error.
    pub message: String,
    /// Suggested remedy; may be empty.
    pub help: String,
}

impl Connection {
    /// Place of the remote end in messages.
    pub(super) fn place(&self) -> &str {
        if self.kind != Kind::Console {
            return &self.end;
        }
        match (self.values(true), self.values(false)) {
            (_, 0) => "standard input",
            (0, _) => "standard output",
            _ => "standard input and output",
        }
    }

    /// Reads the keys and values of a connection; numbers and truth values as they are written.
    ///
    /// # Errors
    /// All that is wrong with them: at least one mistake.
    pub fn read(name: &str, pairs: &[(&str, &str)]) -> Result<Self, Vec<SettingError>> {
        let kinds = Kind::ALL.map(Kind::key);
        let mut found = pairs.iter().filter(|(key, _)| kinds.contains(key));
        let (Some(&(key, end)), None) = (found.next(), found.next()) else {
            return Err([SettingError {
                pair: None,
                of_key: false,
                message: format!("a connection has one of {}", listed(&kinds)),
                help: "write for example `modbus-tcp = \"192.168.1.20:502\"`".to_owned(),
            }]
            .into());
        };
        let kind = Kind::ALL.into_iter().find(|kind| kind.key() == key);
        let mut connection = Connection {
            name: name.to_owned(),
            kind: kind.unwrap_or(Kind::Console),
            end: end.to_owned(),
            every_ms: 20,
            timeout_ms: 500,
            fault: None,
            loss: Loss::Zero,
            options: BTreeMap::new(),
            rows: Vec::new(),
        };
        let mut errors = Vec::new();
        for (pair, &(key, value)) in pairs.iter().enumerate() {
            if let Err((message, help)) = connection.set(key, value) {
                errors.push(SettingError {
                    pair: Some(pair),
                    of_key: !connection.knows(key),
                    message,
                    help,
                });
            }
        }
        if errors.is_empty()
            && let Some(message) = connection.lacks_keys()
        {
            errors.push(SettingError {
                pair: None,
                of_key: false,
                message: message.to_owned(),
                help: String::new(),
            });
        }
        if errors.is_empty() && connection.rows.is_empty() {
            errors.push(SettingError {
                pair: None,
                of_key: false,
                message: "a connection without devices".to_owned(),
                help: connection.kind.example().to_owned(),
            });
        }
        match errors.is_empty() {
            true => Ok(connection),
            false => Err(errors),
        }
    }

    /// The rows of a direction.
    pub fn directed(&self, reads: bool) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.reads == reads)
    }

    /// The connection without the rows that are read; the others have their places.
    pub(super) fn written(&self) -> Connection {
        Connection {
            rows: self.directed(false).cloned().collect(),
            ..self.clone()
        }
    }

    /// Number of values that it reads, or writes.
    pub fn values(&self, reads: bool) -> usize {
        let ends = self.directed(reads).map(|row| row.place.end);
        ends.max().unwrap_or(0)
    }

    /// An option's number within a range; `usual` if it is not given.
    ///
    /// # Errors
    /// What it is to be.
    pub fn number(&self, option: &str, range: Range<u32>, usual: u32) -> Result<u32, String> {
        let Some(text) = self.options.get(option) else {
            return Ok(usual);
        };
        let number = text.parse().ok().filter(|number| range.contains(number));
        let (first, last) = (range.start, range.end.saturating_sub(1));
        number.ok_or_else(|| format!("`{option}` is {first} to {last}"))
    }

    /// The unit of a Modbus slave.
    ///
    /// # Errors
    /// What it is to be.
    pub fn unit(&self) -> Result<u8, String> {
        self.number("unit", 0..248, 1).map(|unit| unit as u8)
    }

    /// The rate of a serial line in bit/s.
    ///
    /// # Errors
    /// What it is to be.
    pub fn baud(&self) -> Result<u32, String> {
        self.number("baud", 300..1_000_001, 9600)
    }

    /// The format of a serial line of eight data bits, `8E1`: parity (`N`, `E` or `O`) and stop bits.
    ///
    /// # Errors
    /// What it is to be.
    pub fn format(&self) -> Result<(char, u8), String> {
        let text = self.options.get("format").map_or("8N1", String::as_str);
        match text.as_bytes() {
            &[b'8', parity @ (b'N' | b'E' | b'O'), stop @ (b'1' | b'2')] => {
                Ok((char::from(parity), stop - b'0'))
            }
            _ => Err(String::from(
                "`format` is for example \"8N1\", \"8E1\" or \"8N2\"",
            )),
        }
    }

    /// Error in the combination of the keys of a broker.
    fn lacks_keys(&self) -> Option<&'static str> {
        let has = |option: &str| self.options.contains_key(option);
        if has("password-file") && !has("user") {
            return Some("`password-file` needs `user`");
        }
        match (has("ca"), has("certificate"), has("key")) {
            (false, false, false) | (true, false, false) | (true, true, true) => None,
            (false, ..) => Some(
                "`certificate` and `key` need `ca`, the authority that the broker's certificate is from",
            ),
            _ => Some("`certificate` and `key` belong together"),
        }
    }

    /// Returns true if a broker is reached by TLS, as its keys specify.
    pub fn is_encrypted(&self) -> bool {
        self.options.contains_key("ca")
    }

    /// Changes the paths that it names, which are as seen from where it is described.
    pub fn seen_from(&mut self, seen: impl Fn(&str) -> String) {
        if self.kind == Kind::Files {
            self.end = seen(&self.end);
        }
        for key in ["password-file", "ca", "certificate", "key"] {
            if let Some(path) = self.options.get_mut(key) {
                *path = seen(path);
            }
        }
    }

    /// The first of its devices that a PLC does not have.
    pub fn missing(&self, has: impl Fn(Class, u32) -> bool) -> Option<String> {
        let rows = self
            .rows
            .iter()
            .map(|row| (row.class, row.first..row.first + row.count));
        let fault = self
            .fault
            .map(|(class, number)| (class, number..number + 1));
        rows.chain(fault).find_map(|(class, mut numbers)| {
            let missing = numbers.find(|&number| !has(class, number))?;
            Some(device_name(class, missing))
        })
    }

    /// Returns true for a key that the connection has.
    fn knows(&self, key: &str) -> bool {
        match key.starts_with(|c: char| c.is_ascii_uppercase()) {
            true => devices(key).is_some(),
            false => {
                let mut keys = COMMON.iter().chain(self.kind.options());
                key == self.kind.key() || keys.any(|known| *known == key)
            }
        }
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), (String, String)> {
        let wrong = |message: String| Err((message, String::new()));
        if key.starts_with(|c: char| c.is_ascii_uppercase()) {
            return self.add_row(key, value);
        }
        match key {
            "every" | "timeout" => {
                let ms = duration::parse_within(value, 1..=3_600_000);
                let ms = ms.map_err(|why| (why, String::new()))?;
                match key {
                    "every" => self.every_ms = ms,
                    _ => self.timeout_ms = ms,
                }
            }
            "fault" => match devices(value) {
                Some((class @ (Class::Y | Class::M | Class::S), first, 1)) => {
                    self.fault = Some((class, first));
                }
                _ => return wrong(format!("`{value}` is not a bit device Y, M or S")),
            },
            "loss" => match value {
                "zero" => self.loss = Loss::Zero,
                "hold" => self.loss = Loss::Hold,
                _ => return wrong(String::from("`loss` is \"zero\" or \"hold\"")),
            },
            _ if key == self.kind.key() => {
                self.check_end()
                    .map_err(|message| (message, String::new()))?;
            }
            _ if self.kind.options().contains(&key) => {
                self.options.insert(key.to_owned(), value.to_owned());
                let checked = match key {
                    _ if value.trim().is_empty() => Err(format!("`{key}` is empty")),
                    "unit" => self.unit().map(drop),
                    "baud" => self.baud().map(drop),
                    "format" => self.format().map(drop),
                    "status" => check_topic(value),
                    _ => Ok(()),
                };
                checked.map_err(|message| (message, String::new()))?;
            }
            _ => {
                let kind = self.kind.key();
                let keys = COMMON.iter().chain(self.kind.options());
                let keys: Vec<_> = keys.copied().collect();
                let help = format!("valid keys: {} and ranges of devices", listed(&keys));
                return Err((format!("a connection by {kind} has no key `{key}`"), help));
            }
        }
        Ok(())
    }

    /// Error in the address of the remote end.
    fn check_end(&self) -> Result<(), String> {
        let key = self.kind.key();
        match self.kind {
            _ if self.end.trim().is_empty() => Err(format!("`{key}` is empty")),
            Kind::ModbusTcp | Kind::Mqtt => match address(&self.end, 1)? {
                (host, _) if host.is_empty() => Err(format!("`{}` names no host", self.end)),
                _ => Ok(()),
            },
            Kind::Console if self.end != "true" => Err(format!("`{key}` is `true`")),
            Kind::ModbusRtu | Kind::Gpio | Kind::Files | Kind::Console => Ok(()),
        }
    }

    fn add_row(&mut self, key: &str, value: &str) -> Result<(), (String, String)> {
        let example = || self.kind.example().to_owned();
        let Some((class, first, count)) = devices(key) else {
            let help = "the devices are X, Y, M, S, D or R: `X000-X007`";
            let message = format!("`{key}` is not a range of devices");
            return Err((message, help.to_owned()));
        };
        let mut words: Vec<&str> = value.split_whitespace().collect();
        let loss = match words[..] {
            [.., "loss", number] => {
                let most = if is_bits(class) {
                    0..=1
                } else {
                    i16::MIN..=i16::MAX
                };
                let number = number.parse().ok().filter(|number| most.contains(number));
                let (from, to) = (most.start(), most.end());
                let message = || format!("the value after `loss` is {from} to {to}");
                words.truncate(words.len() - 2);
                Some(number.ok_or_else(|| (message(), String::new()))?)
            }
            _ => None,
        };
        let reads = match words.first() {
            Some(&"read") => true,
            Some(&"write") => false,
            _ => {
                return Err((
                    format!("`{value}` is neither `read` nor `write`"),
                    example(),
                ));
            }
        };
        if reads && class == Class::Y {
            let help = "outputs are written; read into X, M, S, D or R";
            return Err((format!("`{key}` cannot be read"), help.to_owned()));
        }
        if let (false, Some(_)) = (reads, loss) {
            let help = "what outputs do then is set at the other end";
            return Err((
                "`loss` is for devices that are read".to_owned(),
                help.to_owned(),
            ));
        }
        let end = end(self.kind, class, count, reads, &words[1..])
            .map_err(|message| (message, example()))?;
        let from = self.values(reads);
        self.rows.push(Row {
            class,
            first,
            count,
            reads,
            end,
            loss,
            place: from..from + count as usize,
        });
        Ok(())
    }
}

/// Parses the words of a row as a target at the remote end.
fn end(kind: Kind, class: Class, count: u32, reads: bool, words: &[&str]) -> Result<End, String> {
    let cannot = || {
        format!(
            "`{}` is not an end of a row by {}",
            words.join(" "),
            kind.key()
        )
    };
    match (kind, words) {
        (Kind::ModbusTcp | Kind::ModbusRtu, &[table, address]) => {
            let address = address.parse().map_err(|_| cannot())?;
            let table = match table {
                "coils" => Table::Coils,
                "inputs" if reads => Table::Inputs,
                "registers" => Table::Registers,
                "input-registers" if reads => Table::InputRegisters,
                _ => return Err(cannot()),
            };
            let of_bits = matches!(table, Table::Coils | Table::Inputs);
            if of_bits && !is_bits(class) {
                return Err("coils and inputs are bits, but the devices are words".to_owned());
            }
            // Sixteen bits are packed into a register.
            let items = if is_bits(class) && !of_bits {
                count.div_ceil(16)
            } else {
                count
            };
            let limits = Limits::STANDARD;
            let most = match (of_bits, reads) {
                (true, true) => limits.read_bits,
                (true, false) => limits.write_bits,
                (false, true) => limits.read_words,
                (false, false) => limits.write_words,
            };
            if items > most.into() {
                return Err(format!("a row has at most {most} of them; divide it"));
            }
            if u32::from(address) + items > 0x1_0000 {
                return Err("the last address is 65535".to_owned());
            }
            Ok(End::Modbus { table, address })
        }
        (Kind::Mqtt, &[topic]) => check_topic(topic).map(|()| End::Name(topic.to_owned())),
        (Kind::Files, &[name]) => Ok(End::Name(name.to_owned())),
        (Kind::Gpio, [offset, flags @ ..]) => {
            let known = |flag: &&str| match *flag {
                "active-low" | "pull-up" | "pull-down" => true,
                "open-drain" => !reads,
                _ => false,
            };
            let offset = offset.parse().map_err(|_| cannot())?;
            if !is_bits(class) || count != 1 || !flags.iter().all(known) {
                return Err("a line is one bit device, with the words `active-low`, `pull-up`, `pull-down` or (of outputs) `open-drain`".to_owned());
            }
            let flags = flags.iter().map(|flag| (*flag).to_owned()).collect();
            Ok(End::Line { offset, flags })
        }
        (Kind::Console, []) => Ok(End::Text),
        _ => Err(cannot()),
    }
}

/// Error in the name of a topic.
fn check_topic(topic: &str) -> Result<(), String> {
    match topic.contains(['+', '#']) || topic.starts_with('$') {
        true => Err(format!("`{topic}` is not the topic of one value")),
        false => Ok(()),
    }
}

/// The name of a device, as the PLC writes it.
pub(super) fn device_name(class: Class, number: u32) -> String {
    match class {
        Class::X | Class::Y => format!("{class:?}{number:03o}"),
        _ => format!("{class:?}{number}"),
    }
}

/// Reads `X000-X007` or `D100`: class, first number, count.
pub(super) fn devices(text: &str) -> Option<(Class, u32, u32)> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let ((class, first), (other, last)) = (device(first)?, device(last)?);
    let count = last.checked_sub(first)?.checked_add(1)?;
    (class == other && count <= MOST).then_some((class, first, count))
}

/// Devices of a row at most.
const MOST: u32 = 65_536;

fn device(text: &str) -> Option<(Class, u32)> {
    let class = match text.get(..1)? {
        "X" => Class::X,
        "Y" => Class::Y,
        "M" => Class::M,
        "S" => Class::S,
        "D" => Class::D,
        "R" => Class::R,
        _ => return None,
    };
    let digits = &text[1..];
    let radix = if matches!(class, Class::X | Class::Y) {
        8
    } else {
        10
    };
    let number = u32::from_str_radix(digits, radix).ok()?;
    (digits.starts_with(|c: char| c.is_ascii_digit()) && number < 1_000_000)
        .then_some((class, number))
}

fn is_bits(class: Class) -> bool {
    matches!(class, Class::X | Class::Y | Class::M | Class::S)
}

/// `a`, `b` or `c`, in back quotes.
fn listed(names: &[&str]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ").to_string()
}
