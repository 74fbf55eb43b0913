//! The description of a board, in TOML: docs/src/boards.md.

mod analog;
mod control;
mod pins;
mod retain;
mod serial;

pub use analog::{Analog, AnalogPin, Start};
pub use control::Control;
pub use pins::{Chip, NamedPin};
pub use retain::{Retain, RetainMemory};
pub use serial::{Serial, Uart};
use std::collections::BTreeMap;

use crate::target::{self, Target};
use pins::{InputFormat, Output, Wiring};
use rungc_syntax::codes::BOARD_FILE;
use rungc_syntax::{DeviceClass, Diagnostic, Source, toml_words};
use serde::Deserialize;
use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// A board.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// Name of the board.
    pub name: String,
    /// Notes: the source of its pins, and warnings.
    pub notes: String,
    /// Chip, if its pins have names.
    pub chip: Option<Chip>,
    /// The pins that the description names, by what they are wired to, in its order.
    pub pins: Vec<NamedPin>,
    /// Its processor.
    pub target: &'static Target,
    /// Flash, for programs and constants.
    pub flash: Region,
    /// RAM, for data and the stack.
    pub ram: Region,
    /// The minimum number of bytes of RAM left for the stack.
    pub stack: u32,
    /// The clock that SysTick counts, in Hz.
    pub clock_hz: u32,
    /// From one tick to the next, in microseconds: the resolution of time.
    pub tick_us: u32,
    /// Scan period, start to start, in microseconds; 0: a scan at each tick.
    pub scan_us: u32,
    /// True if changes of outputs are printed for a debugger or a simulator.
    pub console: bool,
    /// Register writes before anything else, in this order.
    pub setup: Vec<Setup>,
    /// Pins of inputs X, by plain numbers.
    pub inputs: BTreeMap<u32, InputPin>,
    /// Pins of outputs Y.
    pub outputs: BTreeMap<u32, OutputPin>,
    /// The switch, the lamps and the watchdog.
    pub control: Control,
    /// Analog pins.
    pub analog: Analog,
    /// Serial ports of the PLC, and the UARTs that they are.
    pub serial: Vec<Serial>,
    /// Memory for latched devices, which survives power-off.
    pub retain: Option<Retain>,
    /// C functions of the user that stand for fields of `rungc_hal` and `rungc_board`, and `init`; by the fields'
    /// names.
    pub functions: BTreeMap<String, String>,
    /// C sources and headers with these functions: as named, and where they are.
    pub sources: Vec<(String, PathBuf)>,
    /// Handlers of the device's interrupts among these functions, by numbers.
    pub interrupts: BTreeMap<u32, String>,
}

/// A run of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// First address.
    pub origin: u32,
    /// Length in bytes.
    #[serde(deserialize_with = "bytes")]
    pub length: u32,
}

/// A step of what is done before anything else.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setup {
    /// A register keeps what it holds, without the bits of `clear`, with those of `set`.
    Change {
        /// Its address.
        at: u32,
        /// Bits that go off.
        clear: u32,
        /// Bits to set.
        set: u32,
    },
    /// A word is written.
    Write {
        /// The register's address.
        at: u32,
        /// The word.
        word: u32,
    },
    /// Waits until all of these bits are on, or all of them off.
    Wait {
        /// The register's address.
        at: u32,
        /// The bits.
        bits: u32,
        /// True if they have to be on.
        on: bool,
    },
}

impl Setup {
    const fn set(at: u32, set: u32) -> Self {
        Setup::Change { at, clear: 0, set }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SetupFormat {
    at: toml::Spanned<u32>,
    clear: Option<u32>,
    set: Option<u32>,
    write: Option<u32>,
    wait: Option<u32>,
    wait_off: Option<u32>,
}

/// A bit of a register that an input follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InputPin {
    /// The register's address.
    pub at: u32,
    /// The bit.
    pub bit: u32,
    /// The input is on while the bit is off.
    pub inverted: bool,
}

/// Access to the pin of an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputPin {
    /// A bit of a register, which keeps its other bits.
    Bit {
        /// The register's address.
        at: u32,
        /// The bit.
        bit: u32,
        /// The bit is off while the output is on.
        inverted: bool,
    },
    /// Words written to registers that set and reset pins.
    Words {
        /// Address and word that switch it on.
        on: (u32, u32),
        /// Address and word that switch it off.
        off: (u32, u32),
    },
}

/// Error in a description, with its place.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// It cannot be read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The underlying I/O error.
        error: std::io::Error,
    },
    /// Neither a known board has this name nor a file.
    #[error(
        "`{name}` is not a board that rungc knows, and there is no such file: `rungc boards` lists those it knows"
    )]
    Unknown {
        /// The name.
        name: String,
    },
    /// It is not as it should be.
    #[error("{}", line(file, error))]
    Wrong {
        /// The description.
        file: Box<Source>,
        /// What is wrong (E0882).
        error: Box<Diagnostic>,
    },
}

/// An error in one line, with its place.
fn line(source: &Source, error: &Diagnostic) -> String {
    let (line, column) = source.line_col(error.span.start);
    let text = format!("{}:{line}:{column}: {}", source.name, error.message);
    match &error.help {
        Some(help) => format!("{text}; {help}"),
        None => text,
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Format {
    name: String,
    #[serde(default)]
    notes: String,
    target: toml::Spanned<String>,
    chip: Option<Chip>,
    uncertain: Option<String>,
    #[serde(default)]
    console: Option<Console>,
    memory: Memory,
    clock: Clock,
    #[serde(default)]
    setup: Vec<SetupFormat>,
    #[serde(default)]
    inputs: BTreeMap<toml::Spanned<String>, InputFormat>,
    #[serde(default)]
    outputs: BTreeMap<toml::Spanned<String>, toml::Spanned<Output>>,
    #[serde(default)]
    run: control::Run,
    watchdog: Option<control::Watchdog>,
    #[serde(default)]
    analog: analog::Format,
    #[serde(default)]
    serial: Vec<serial::Format>,
    retain: Option<retain::Format>,
    #[serde(default)]
    functions: BTreeMap<toml::Spanned<String>, toml::Spanned<String>>,
    #[serde(default)]
    sources: Vec<toml::Spanned<String>>,
    #[serde(default)]
    interrupts: BTreeMap<toml::Spanned<String>, toml::Spanned<String>>,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "lowercase")]
enum Console {
    Semihosting,
    None,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Memory {
    flash: Region,
    ram: Region,
    #[serde(default = "default_stack", deserialize_with = "bytes")]
    stack: u32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Clock {
    hz: toml::Spanned<u32>,
    #[serde(default = "default_tick_us")]
    tick_us: u32,
    #[serde(default = "default_scan_us")]
    scan_us: u32,
}

fn default_stack() -> u32 {
    1024
}

fn default_tick_us() -> u32 {
    1000
}

fn default_scan_us() -> u32 {
    10_000
}

/// A number of bytes: `131072` or `"128K"`.
fn bytes<'de, D: serde::Deserializer<'de>>(reader: D) -> Result<u32, D::Error> {
    #[derive(Deserialize)]
    #[serde(
        untagged,
        expecting = "a number of bytes: 131072 or \"128K\" or \"1M\""
    )]
    enum Size {
        Number(u32),
        Text(String),
    }
    let read = |text: &str| {
        let text = text.trim();
        let (digits, factor) = match text.char_indices().last() {
            Some((at, 'K')) => (&text[..at], 1024),
            Some((at, 'M')) => (&text[..at], 1024 * 1024),
            _ => (text, 1),
        };
        let number: u32 = digits.trim().parse().ok()?;
        number.checked_mul(factor)
    };
    match Size::deserialize(reader)? {
        Size::Number(number) => Ok(number),
        Size::Text(text) => read(&text).ok_or_else(|| {
            serde::de::Error::custom(format!(
                "`{text}` is not a size: write for example 131072, \"128K\" or \"1M\""
            ))
        }),
    }
}

/// Fields of `rungc_hal` and `rungc_board` that a function may stand for, and what the function is.
pub(crate) const FUNCTIONS: [(&str, &str); 23] = [
    ("init", "void NAME(void)"),
    (
        "input",
        "bool NAME(void *context, uint16_t number, bool *on)",
    ),
    (
        "set_output",
        "void NAME(void *context, uint16_t number, bool on)",
    ),
    ("clock", "bool NAME(void *context, rungc_clock *clock)"),
    (
        "set_clock",
        "bool NAME(void *context, const rungc_clock *clock)",
    ),
    (
        "read_bfm",
        "bool NAME(void *context, uint16_t unit, uint16_t address, int16_t *value)",
    ),
    (
        "write_bfm",
        "bool NAME(void *context, uint16_t unit, uint16_t address, int16_t value)",
    ),
    (
        "module_answers",
        "bool NAME(void *context, uint16_t unit, uint16_t most_ms)",
    ),
    (
        "analog",
        "bool NAME(void *context, uint8_t channel, int16_t *value)",
    ),
    ("power_fails", "bool NAME(void *context)"),
    ("battery", "bool NAME(void *context, uint16_t *tenths)"),
    ("hold_pulses", "void NAME(void *context, bool hold)"),
    (
        "set_line",
        "void NAME(void *context, uint8_t port, const rungc_line_format *format)",
    ),
    (
        "receive",
        "bool NAME(void *context, uint8_t port, uint32_t now_us, rungc_received *received)",
    ),
    (
        "send",
        "bool NAME(void *context, uint8_t port, uint8_t byte, uint32_t now_us)",
    ),
    (
        "unsent",
        "uint16_t NAME(void *context, uint8_t port, uint32_t now_us)",
    ),
    (
        "can_receive",
        "bool NAME(void *context, rungc_can_frame *frame)",
    ),
    (
        "can_send",
        "bool NAME(void *context, const rungc_can_frame *frame)",
    ),
    ("can_is_sending", "bool NAME(void *context)"),
    ("now_us", "uint32_t NAME(void *context)"),
    ("next_edge", "bool NAME(void *context, rungc_edge *edge)"),
    (
        "counted",
        "bool NAME(void *context, unsigned counter, rungc_count *count)",
    ),
    ("wake_in", "void NAME(void *context, uint32_t us)"),
];

/// Files that every image has; the user's sources are written beside them.
const IMAGE_FILES: [&str; 2] = ["main.c", "startup.c"];

/// Returns true if a character of a file name has no special meaning to `make` and to the shell.
fn is_plain(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '+' | '.')
}

/// Reads a description whose sources are in `folder`.
pub fn parse(source: &Source, folder: &Path) -> Result<Board, BoardError> {
    let reader = Reader {
        source,
        wiring: RefCell::default(),
    };
    let format: Format = toml::from_str(&source.text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start);
        let (message, help) = toml_words::message_at(&source.text, at, error.message());
        reader.wrong_with(at, message, help)
    })?;
    reader.board(format, folder)
}

struct Reader<'s> {
    source: &'s Source,
    /// The pins that the description has named so far.
    wiring: RefCell<Wiring>,
}

type Spanned = toml::Spanned<String>;

impl Reader<'_> {
    fn wrong(&self, at: usize, message: String) -> BoardError {
        self.wrong_with(at, message, None)
    }

    fn wrong_with(&self, at: usize, message: String, help: Option<String>) -> BoardError {
        let span = toml_words::token(&self.source.text, at);
        let mut error = BOARD_FILE.at(span, message);
        error.help = help.map(Into::into);
        BoardError::Wrong {
            file: Box::new(self.source.clone()),
            error: Box::new(error),
        }
    }

    fn at<T>(&self, item: &toml::Spanned<T>, message: String) -> BoardError {
        self.wrong(item.span().start, message)
    }

    fn board(self, format: Format, folder: &Path) -> Result<Board, BoardError> {
        let target = self.target(&format.target)?;
        let (clock_hz, tick_us) = self.clock(&format.clock)?;
        let wiring = Wiring {
            chip: format.chip,
            uncertain: format.uncertain,
            ..Wiring::default()
        };
        self.wiring.replace(wiring);
        let inputs = self.terminals(format.inputs, DeviceClass::X, |place, name, pin| {
            self.input(place, name, pin)
        })?;
        let outputs = self.terminals(format.outputs, DeviceClass::Y, |_, name, pin| {
            self.output(pin.span().start, name, pin.get_ref())
        })?;
        let retain = format.retain.map(|format| self.retain(format));
        let mut board = Board {
            name: format.name,
            notes: format.notes,
            chip: format.chip,
            pins: Vec::new(),
            target,
            flash: format.memory.flash,
            ram: format.memory.ram,
            stack: format.memory.stack,
            clock_hz,
            tick_us,
            scan_us: format.clock.scan_us,
            console: matches!(format.console, Some(Console::Semihosting)),
            setup: self.setup(&format.setup)?,
            inputs,
            outputs,
            control: self.control(format.run, format.watchdog)?,
            analog: self.analog(format.analog)?,
            serial: self.serial(format.serial, clock_hz)?,
            retain: retain.transpose()?,
            functions: self.functions(format.functions)?,
            sources: self.sources(&format.sources, folder)?,
            interrupts: self.interrupts(format.interrupts)?,
        };
        self.consistent(&board)?;
        let wiring = self.wiring.into_inner();
        board.setup.extend(wiring.setup());
        board.pins = wiring.named;
        Ok(board)
    }

    fn setup(&self, steps: &[SetupFormat]) -> Result<Vec<Setup>, BoardError> {
        let read = |step: &SetupFormat| {
            let at = *step.at.get_ref();
            let bits = step.wait.or(step.wait_off);
            let on = step.wait.is_some();
            match (step.clear, step.set, step.write, bits) {
                (None, None, Some(word), None) => Ok(Setup::Write { at, word }),
                (None, None, None, Some(bits)) if !(on && step.wait_off.is_some()) => {
                    Ok(Setup::Wait { at, bits, on })
                }
                (clear, set, None, None) => Ok(Setup::Change {
                    at,
                    clear: clear.unwrap_or(0),
                    set: set.unwrap_or(0),
                }),
                _ => Err(self.at(
                    &step.at,
                    "a step of `[[setup]]` has `clear` and `set`, or `write`, or `wait`, or `wait_off`"
                        .to_string(),
                )),
            }
        };
        steps.iter().map(read).collect()
    }

    fn target(&self, name: &Spanned) -> Result<&'static Target, BoardError> {
        let known: Vec<_> = target::ALL
            .iter()
            .filter(|target| target.is_bare())
            .map(|target| target.triple)
            .collect();
        match target::find(name.get_ref()) {
            Some(target) if target.is_bare() => Ok(target),
            _ => Err(self.at(
                name,
                format!("unknown target; available: {}", known.join(", ")),
            )),
        }
    }

    /// The clock's rate, and the tick, which SysTick has to reach with 24 bits.
    fn clock(&self, clock: &Clock) -> Result<(u32, u32), BoardError> {
        let hz = *clock.hz.get_ref();
        let counts = u64::from(hz) * u64::from(clock.tick_us) / 1_000_000;
        if !(2..=1 << 24).contains(&counts) {
            return Err(self.at(
                &clock.hz,
                format!(
                    "a tick of {} µs is {counts} counts of this clock; SysTick has 2 to 16 777 216",
                    clock.tick_us
                ),
            ));
        }
        Ok((hz, clock.tick_us))
    }

    /// Pins by their terminals, each of which occurs once, however it is written.
    fn terminals<T, P>(
        &self,
        pins: BTreeMap<Spanned, T>,
        class: DeviceClass,
        read: impl Fn(usize, &str, T) -> Result<P, BoardError>,
    ) -> Result<BTreeMap<u32, P>, BoardError> {
        let mut known = BTreeMap::new();
        for (name, pin) in pins {
            let number = self.terminal(&name, class)?;
            let terminal = class.number(number).to_string();
            let pin = read(name.span().start, &terminal, pin)?;
            if known.insert(number, pin).is_some() {
                let what = format!("{} is listed twice", class.number(number));
                return Err(self.at(&name, what));
            }
        }
        Ok(known)
    }

    fn terminal(&self, name: &Spanned, class: DeviceClass) -> Result<u32, BoardError> {
        let upper = name.get_ref().to_uppercase();
        let digits = upper.strip_prefix(class.prefix());
        digits
            .and_then(|digits| u32::from_str_radix(digits, 8).ok())
            .ok_or_else(|| {
                let what = format!(
                    "`{}` is not a terminal: write {}",
                    name.get_ref(),
                    class.number(8)
                );
                self.at(name, what)
            })
    }

    fn functions(
        &self,
        functions: BTreeMap<Spanned, Spanned>,
    ) -> Result<BTreeMap<String, String>, BoardError> {
        let mut known = BTreeMap::new();
        for (field, function) in functions {
            let name = field.get_ref().clone();
            if !FUNCTIONS.iter().any(|(known, _)| *known == name) {
                let all: Vec<_> = FUNCTIONS.iter().map(|(name, _)| *name).collect();
                let what = format!("unknown function; available: {}", all.join(", "));
                return Err(self.at(&field, what));
            }
            known.insert(name, self.identifier(function)?);
        }
        Ok(known)
    }

    fn interrupts(
        &self,
        interrupts: BTreeMap<Spanned, Spanned>,
    ) -> Result<BTreeMap<u32, String>, BoardError> {
        let mut known = BTreeMap::new();
        for (number, handler) in interrupts {
            let at: Option<u32> = number.get_ref().parse().ok().filter(|n| *n < 480);
            let at = at.ok_or_else(|| {
                self.at(
                    &number,
                    "a device's interrupt has a number from 0 to 479".to_string(),
                )
            })?;
            known.insert(at, self.identifier(handler)?);
        }
        Ok(known)
    }

    fn identifier(&self, name: Spanned) -> Result<String, BoardError> {
        let text = name.get_ref();
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let good = text.chars().all(word) && !text.starts_with(|c: char| c.is_ascii_digit());
        match good && !text.is_empty() {
            true => Ok(name.into_inner()),
            false => Err(self.at(&name, format!("`{text}` is not the name of a C function"))),
        }
    }

    fn sources(
        &self,
        sources: &[Spanned],
        folder: &Path,
    ) -> Result<Vec<(String, PathBuf)>, BoardError> {
        let mut known = Vec::new();
        for source in sources {
            let name = source.get_ref();
            let path = folder.join(name);
            let kind = Path::new(name).extension().and_then(|e| e.to_str());
            let file = Path::new(name).file_name().and_then(|f| f.to_str());
            let file = file.filter(|_| matches!(kind, Some("c" | "h")));
            let Some(file) = file else {
                let what = format!("`{name}`: sources are files *.c and *.h");
                return Err(self.at(source, what));
            };
            if !path.is_file() {
                return Err(self.at(source, format!("file {} not found", path.display())));
            }
            if !file.chars().all(is_plain) {
                let what = format!(
                    "`{name}`: `make` cannot build a file of this name; use the letters A to Z, digits, `_`, `-`, `+` and `.`"
                );
                return Err(self.at(source, what));
            }
            if IMAGE_FILES.contains(&file) {
                let what = format!("`{name}`: the image already has a file `{file}`");
                return Err(self.at(source, what));
            }
            if known.iter().any(|(other, _)| other == file) {
                let what = format!("`{name}`: there is another source `{file}`");
                return Err(self.at(source, what));
            }
            known.push((file.to_string(), path));
        }
        Ok(known)
    }

    /// Checks the consistency of the description as a whole.
    fn consistent(&self, board: &Board) -> Result<(), BoardError> {
        let both = [
            ("input", !board.inputs.is_empty(), "[inputs]"),
            ("set_output", !board.outputs.is_empty(), "[outputs]"),
            ("set_line", !board.serial.is_empty(), "[[serial]]"),
            ("analog", board.analog.has_channels(), "[analog.inputs]"),
        ];
        for (function, described, table) in both {
            if described && board.functions.contains_key(function) {
                let what = format!(
                    "both {table} and the function `{function}` are given: use only one of them"
                );
                return Err(self.wrong(0, what));
            }
        }
        let code = board.sources.iter().any(|(name, _)| name.ends_with(".c"));
        let named = !board.functions.is_empty() || !board.interrupts.is_empty();
        if named && !code {
            let what = "functions are named, but `sources` is missing";
            return Err(self.wrong(0, what.to_string()));
        }
        let ports = board.serial.iter();
        let mut uarts = ports.flat_map(|serial| &serial.interrupts);
        if let Some(number) = uarts.find(|number| board.interrupts.contains_key(number)) {
            let what = format!("interrupt {number} has a handler, and a serial port takes it");
            return Err(self.wrong(0, what));
        }
        for (region, name) in [(board.flash, "flash"), (board.ram, "ram")] {
            if region.origin.checked_add(region.length).is_none() || region.length == 0 {
                let what = format!("`{name}` is empty or extends past the address range");
                return Err(self.wrong(0, what));
            }
        }
        self.free_slots(board)
    }
}
