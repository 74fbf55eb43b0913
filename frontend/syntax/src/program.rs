//! The program as its author wrote it: instructions, operands, comments. No instruction is understood yet.

use crate::{DeviceClass, Source, Span};
use smallvec::SmallVec;
use smol_str::SmolStr;
use std::collections::BTreeMap;
use std::fmt;
use std::net::SocketAddr;

/// A whole program from one source.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// Source for diagnostics to quote.
    pub source: Source,
    /// Kind of the source file.
    pub kind: SourceKind,
    /// Title of the project, where the source has one.
    pub title: Option<String>,
    /// Name of the program in the project, where programs have names, e.g. `MAIN`.
    pub pou: Option<String>,
    /// CPU type named in the source, as written there, e.g. `FX2N/FX2NC`.
    pub cpu: Option<String>,
    /// Place of the CPU type in the source; the beginning where a project states it.
    pub cpu_span: Span,
    /// The instructions in order. One of which an operand could not be read is among them, with
    /// [`OperandKind::Unreadable`] in its place; lines that do not even name an instruction are not here. The reader
    /// reported both.
    pub instrs: Vec<Instr>,
    /// For each line that does not name an instruction, how many of `instrs` precede it; ascending.
    pub unread: Vec<u32>,
    /// Comment lines below the last instruction.
    pub closing: Option<SmolStr>,
    /// Comments on devices, where the source has them.
    pub comments: BTreeMap<Device, String>,
    /// Where an instruction list names the device of each of them.
    pub comment_spans: BTreeMap<Device, Span>,
    /// PLC parameters of the project, if the source has them.
    pub parameters: Option<Parameters>,
    /// Devices of variables that keep their values over power-off, as the source declares.
    pub retained: Vec<DeviceRun>,
}

/// PLC parameters of a project, as set in the editors.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters {
    /// Devices that keep their values over power-off, of those for which this can be chosen; `None` if none is stated.
    pub latched: Option<Vec<DeviceRun>>,
    /// Memory capacity in steps: what program, comments and file registers share.
    pub capacity: Option<u32>,
    /// Blocks of 500 steps of that memory that hold comments.
    pub comment_blocks: u32,
    /// Blocks of 500 steps of that memory that hold file registers, 500 registers each.
    pub file_register_blocks: u32,
    /// Program files that the PLC runs, in order; empty if none is stated.
    pub programs: Vec<String>,
    /// Special modules that are fitted to it; empty if none is stated.
    pub modules: Vec<FittedModule>,
    /// Requests of the PLC to servers over TCP; empty if none are stated.
    pub requests: Vec<NetworkRequest>,
    /// Devices that something outside the program reads, as the settings say.
    pub read_externally: Vec<DeviceRun>,
    /// Devices that something outside the program writes.
    pub written_externally: Vec<DeviceRun>,
    /// True if a keyword protects the program from being read.
    pub protected: bool,
}

impl Parameters {
    /// Number of steps that remain for the program.
    pub fn program_steps(&self) -> Option<u32> {
        let blocks = self
            .comment_blocks
            .saturating_add(self.file_register_blocks);
        Some(self.capacity?.saturating_sub(blocks.saturating_mul(500)))
    }
}

/// A special module that is fitted to a PLC.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FittedModule {
    /// Its number in FROM and TO.
    pub unit: u16,
    /// Its kind, as the table of modules names it.
    pub kind: &'static str,
    /// Response time in a simulation, in milliseconds. H1U and H2U wait for remote modules.
    pub delay_ms: u16,
    /// Channels, counted from 0, and the analog pins of a board that they are.
    pub pins: Vec<(u8, String)>,
}

/// A row of the table of what a PLC asks of Modbus TCP servers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NetworkRequest {
    /// The server.
    pub server: SocketAddr,
    /// The addressed unit.
    pub unit: u8,
    /// The function.
    pub function: u8,
    /// The first address in the server.
    pub address: u16,
    /// Number of coils or registers.
    pub count: u16,
    /// Number of the first register D of the buffer.
    pub buffer: u32,
    /// The row works while this device is on.
    pub trigger: Device,
}

/// Devices of one class that follow each other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct DeviceRun {
    /// The class.
    pub class: DeviceClass,
    /// First number (a value: X010 is 8).
    pub first: u32,
    /// Number of devices; 0 is none.
    pub count: u32,
}

impl fmt::Display for DeviceRun {
    /// `M0 to M499`; the count is at least 1.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let last = self.first.saturating_add(self.count.saturating_sub(1));
        let name = |number| self.class.number(number);
        write!(f, "{} to {}", name(self.first), name(last))
    }
}

impl Program {
    /// Returns true if all of it could be read. If not, its reader has reported an error.
    pub fn is_complete(&self) -> bool {
        self.unread.is_empty() && !self.instrs.iter().any(Instr::is_broken)
    }
}

/// The kind of file a program was read from.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum SourceKind {
    /// Instruction list as text.
    #[default]
    Il,
    /// Ladder drawn in characters.
    Ladder,
    /// Structured text: its instructions come when it is compiled for a model.
    StructuredText,
    /// The editors' list export.
    Csv,
    /// GX Developer project (`MAIN.wpg`).
    GxDeveloper,
    /// GX Works2 project (`.gxw`).
    GxWorks2,
    /// Program memory of a PLC.
    Image,
    /// PLCopen XML.
    Plcopen,
}

impl SourceKind {
    /// Display name.
    pub const fn title(self) -> &'static str {
        match self {
            SourceKind::Il => "instruction list",
            SourceKind::Ladder => "drawn ladder",
            SourceKind::StructuredText => "structured text",
            SourceKind::Csv => "list export",
            SourceKind::GxDeveloper => "GX Developer",
            SourceKind::GxWorks2 => "GX Works2",
            SourceKind::Image => "program memory",
            SourceKind::Plcopen => "PLCopen XML",
        }
    }

    /// Returns true for a text that a user writes: its places are lines and columns.
    pub const fn is_text(self) -> bool {
        match self {
            SourceKind::Il | SourceKind::Ladder | SourceKind::StructuredText => true,
            SourceKind::Csv
            | SourceKind::GxDeveloper
            | SourceKind::GxWorks2
            | SourceKind::Image
            | SourceKind::Plcopen => false,
        }
    }

    /// Returns true for an instruction list, with a line for each instruction: fixes can change it.
    pub const fn is_list(self) -> bool {
        match self {
            SourceKind::Il => true,
            SourceKind::Ladder
            | SourceKind::StructuredText
            | SourceKind::Csv
            | SourceKind::GxDeveloper
            | SourceKind::GxWorks2
            | SourceKind::Image
            | SourceKind::Plcopen => false,
        }
    }

    /// Returns true for a table whose rows places can name.
    pub const fn has_rows(self) -> bool {
        match self {
            SourceKind::Csv => true,
            SourceKind::Il
            | SourceKind::Ladder
            | SourceKind::StructuredText
            | SourceKind::GxDeveloper
            | SourceKind::GxWorks2
            | SourceKind::Image
            | SourceKind::Plcopen => false,
        }
    }

    /// Returns true for a project of an editor or the memory of a PLC, which hold instructions by their codes and
    /// lengths; others are lists of mnemonics.
    pub const fn is_project(self) -> bool {
        match self {
            SourceKind::Il
            | SourceKind::Ladder
            | SourceKind::StructuredText
            | SourceKind::Csv
            | SourceKind::Plcopen => false,
            SourceKind::GxDeveloper | SourceKind::GxWorks2 | SourceKind::Image => true,
        }
    }
}

/// One instruction, or a label (`P0`, `I001`), whose mnemonic is then the pointer itself without operands.
#[derive(Clone, Debug, PartialEq)]
pub struct Instr {
    /// Mnemonic in upper case as written, with `D` prefix and `P` suffix, e.g. `DADDP`, `LD>=`, `P12`.
    pub mnemonic: SmolStr,
    /// Position of the mnemonic.
    pub mnemonic_span: Span,
    /// The operands in order.
    pub operands: Operands,
    /// The whole instruction, from mnemonic to last operand.
    pub span: Span,
    /// The step number that the source states.
    pub step: Option<u32>,
    /// Comments on it; most instructions have none. See [`Instr::statement`] and [`Instr::note`].
    pub remarks: Option<Box<Remarks>>,
}

/// Comments of users on an instruction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Remarks {
    /// Line statement (heading) above the instruction.
    pub statement: Option<SmolStr>,
    /// Comment or note beside the instruction.
    pub note: Option<SmolStr>,
}

impl Remarks {
    /// These, if they say anything.
    pub fn new(statement: Option<SmolStr>, note: Option<SmolStr>) -> Option<Box<Remarks>> {
        (statement.is_some() || note.is_some()).then(|| Box::new(Remarks { statement, note }))
    }
}

impl Instr {
    /// Line statement (heading) above the instruction.
    pub fn statement(&self) -> Option<&str> {
        self.remarks.as_ref()?.statement.as_deref()
    }

    /// Comment or note beside the instruction.
    pub fn note(&self) -> Option<&str> {
        self.remarks.as_ref()?.note.as_deref()
    }

    /// Its remarks, to add something.
    pub fn remarks_mut(&mut self) -> &mut Remarks {
        self.remarks.get_or_insert_default()
    }
}

/// The operands of an instruction. Most have one, which needs no separate allocation.
pub type Operands = SmallVec<[Operand; 1]>;

/// One operand.
#[derive(Clone, Debug, PartialEq)]
pub struct Operand {
    /// Position.
    pub span: Span,
    /// Kind and value.
    pub kind: OperandKind,
}

/// A device by class and number; the number is a value (X010 is 8).
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub struct Device {
    /// Its class.
    pub class: DeviceClass,
    /// Its number.
    pub number: u32,
}

impl fmt::Display for Device {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.class.number(self.number).fmt(f)
    }
}

/// An index register after an operand: `D0Z3`, `K4M0V` (a bare letter is number 0).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Index {
    /// `V` or `Z`.
    pub class: DeviceClass,
    /// Number of the register.
    pub number: u32,
}

impl fmt::Display for Index {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.class.number(self.number).fmt(f)
    }
}

/// Kind and value of an operand.
#[derive(Clone, Debug, PartialEq)]
pub enum OperandKind {
    /// `X000`, `D10`, `D0Z3`, `P4`, `I001`, `N0`.
    Device(Device, Option<Index>),
    /// Bit of a word: `D0.F`.
    WordBit(Device, u8, Option<Index>),
    /// Group of `4 * digits` bits from a bit device: `K4M0`, `K2X010Z1`. The digit count is as written, 0 to 255.
    Nibbles(u8, Device, Option<Index>),
    /// Decimal constant `K100`, with index `K100Z0`.
    Decimal(i64, Option<Index>),
    /// Hexadecimal constant `H1F`, with index.
    Hex(u64, Option<Index>),
    /// Floating constant `E1.5`, `E1.5+3`.
    Float(f32),
    /// Characters: `"ABC"`, or the bare characters of ASC.
    Text(SmolStr),
    /// Buffer memory of a module: `U0\G5`.
    Buffer {
        /// Module number.
        module: u32,
        /// Address in its buffer memory.
        address: u32,
        /// Index of the address.
        index: Option<Index>,
    },
    /// Text that is not an operand, which the reader reported; the device that it was probably meant to name (`MO` for
    /// `M0`).
    Unreadable(Option<Device>),
}

impl OperandKind {
    /// A floating constant; `None` outside what the PLCs accept: 0, and ±1.0×2^-126 to below ±1.0×2^128
    /// (l01s-programming §2.1).
    pub fn float(value: f32) -> Option<Self> {
        (value == 0.0 || value.is_normal()).then_some(OperandKind::Float(value))
    }

    /// The value of a constant without an index.
    pub fn constant(&self) -> Option<i64> {
        match *self {
            OperandKind::Decimal(value, None) => Some(value),
            OperandKind::Hex(value, None) => i64::try_from(value).ok(),
            _ => None,
        }
    }

    /// A device without an index.
    pub fn device(&self) -> Option<Device> {
        match *self {
            OperandKind::Device(device, None) => Some(device),
            _ => None,
        }
    }
}

impl fmt::Display for OperandKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let index = match self {
            OperandKind::Device(device, index) => {
                write!(f, "{device}")?;
                index
            }
            OperandKind::WordBit(device, bit, index) => {
                write!(f, "{device}.{bit:X}")?;
                index
            }
            OperandKind::Nibbles(digits, device, index) => {
                write!(f, "K{digits}{device}")?;
                index
            }
            OperandKind::Decimal(value, index) => {
                write!(f, "K{value}")?;
                index
            }
            OperandKind::Hex(value, index) => {
                write!(f, "H{value:X}")?;
                index
            }
            OperandKind::Float(value) => return write_float(f, *value),
            OperandKind::Text(text) => return write!(f, "\"{text}\""),
            OperandKind::Buffer {
                module,
                address,
                index,
            } => {
                write!(f, "U{module}\\G{address}")?;
                index
            }
            OperandKind::Unreadable(Some(device)) => return write!(f, "{device}?"),
            OperandKind::Unreadable(None) => return f.write_str("?"),
        };
        index.map_or(Ok(()), |index| write!(f, "{index}"))
    }
}

/// Writes a floating constant as the editors do: `E1.5`, with an exponent `E3.4+38` (FX3 programming manual §5.2.3).
fn write_float(f: &mut fmt::Formatter<'_>, value: f32) -> fmt::Result {
    let shortest = format!("{value:?}");
    let Some((mantissa, exponent)) = shortest.split_once('e') else {
        return write!(f, "E{shortest}");
    };
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let plus = if exponent.starts_with('-') { "" } else { "+" };
    write!(f, "E{mantissa}{point}{plus}{exponent}")
}

impl Instr {
    /// Returns true if an operand could not be read.
    pub fn is_broken(&self) -> bool {
        let mut operands = self.operands.iter();
        operands.any(|operand| matches!(operand.kind, OperandKind::Unreadable(_)))
    }
}

impl fmt::Display for Instr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.mnemonic)?;
        self.operands
            .iter()
            .try_for_each(|operand| write!(f, " {}", operand.kind))
    }
}
