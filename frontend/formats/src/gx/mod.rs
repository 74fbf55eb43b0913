//! Projects of GX Developer (a folder with `MAIN.wpg` and `COMMENT.wcd`) and GX Works2 (`.gxw`).

mod comments;
pub(crate) mod cpu;
mod fields;
mod parameters;
mod program;
pub(crate) mod table;
mod tokens;
mod works2;

pub use works2::sources;

pub(crate) use program::hex;
pub(crate) use tokens::steps;
pub(crate) use works2::read as read_gxw;

use crate::encoding::decode_text;
use crate::listing::Listing;
use crate::text::clean;
use crate::{Read, ReadOptions};
use comments::Comments;
use encoding_rs::Encoding;
use program::{Code, bytes_error};
use rungc_syntax::diag::counted;
use rungc_syntax::{Diagnostic, Diagnostics, Program, SourceKind, Span, codes};

/// Length of the header that all files of a project begin with.
const HEADER: usize = 0x40;
/// Signature of those files.
const MAGIC: [u8; 4] = [0x40, 0x00, 0x22, 0x01];
/// Offset of the program in `MAIN.wpg`.
const START: usize = 0x44;
/// Number of bytes searched for a program; none is larger.
const MAX_DATA: usize = 32 << 20;
/// Offset of the CPU in the header: `04 02`, then its code.
const CPU: usize = 0x24;
/// Signature of an OLE compound file.
const OLE: [u8; 8] = [0xD0, 0xCF, 0x11, 0xE0, 0xA1, 0xB1, 0x1A, 0xE1];

/// Returns true for a GX Works2 project, or another OLE file.
pub(crate) fn is_ole(bytes: &[u8]) -> bool {
    bytes.starts_with(&OLE)
}

/// Returns true for a `MAIN.wpg` by its name, which is too short to show what it is.
pub(crate) fn is_cut_wpg(name: &str, bytes: &[u8]) -> bool {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending);
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("wpg")) && bytes.len() <= START
}

/// Returns true for a file of a GX Developer project.
pub(crate) fn is_wpg(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
        || (bytes.get(CPU..CPU + 2) == Some(&[4, 2]) && bytes.get(CPU + 3) == Some(&2))
}

/// The files that lie beside `MAIN.wpg` in a GX Developer project.
#[derive(Default)]
pub(crate) struct Beside {
    /// `COMMENT.wcd`.
    pub comments: Option<Vec<u8>>,
    /// `param.wpa`.
    pub parameters: Option<Vec<u8>>,
}

/// Reads `MAIN.wpg`.
pub(crate) fn read_wpg(name: &str, bytes: &[u8], beside: &Beside, options: &ReadOptions) -> Read {
    let cpu = cpu_code(bytes).map(cpu::name);
    let refused = |cpu: &String| cpu::refused(name, SourceKind::GxDeveloper, cpu);
    if let Some(refused) = cpu.as_ref().and_then(refused) {
        return refused;
    }
    let parameters = beside.parameters.as_deref().map(parameters::read);
    if parameters.as_ref().is_some_and(|(set, _)| set.protected) {
        return protected(name, SourceKind::GxDeveloper, cpu);
    }
    let bytes = bytes.get(..MAX_DATA).unwrap_or(bytes);
    let chains = program::chains(bytes);
    let begins = program::body(bytes, START).is_some_and(|body| tokens::token(body).is_some());
    let start = if begins {
        Some(START)
    } else {
        (HEADER..bytes.len()).find(|&at| chains[at].is_program())
    };
    let table = beside.comments.as_deref().map(comments::of_developer);
    let code = start.map(|start| Code::new(bytes, start, &chains));
    let mut texts = code.as_ref().map_or_else(Vec::new, Code::texts);
    texts.extend(table.iter().flat_map(Comments::texts));
    let encoding = options.encoding_of(&texts, None);
    let mut read = match code {
        Some(code) => code.read(name, encoding, options),
        None => no_program(name, bytes),
    };
    read.program.kind = SourceKind::GxDeveloper;
    read.program.cpu = cpu;
    if let (Some(bytes), Some(table)) = (&beside.comments, &table) {
        add_comments(&mut read, bytes, table, encoding);
    }
    if let (Some(bytes), Some((parameters, damaged))) = (&beside.parameters, parameters) {
        read.program.parameters = Some(parameters);
        let damaged = damaged.map(|at| damaged_part("the PLC parameters", bytes, at));
        read.diagnostics.extend(damaged);
    }
    read
}

/// The number of the CPU type that the header names.
fn cpu_code(bytes: &[u8]) -> Option<u16> {
    match bytes.get(CPU..CPU + 4)? {
        [4, 2, low, high] => Some(u16::from_le_bytes([*low, *high])),
        _ => None,
    }
}

/// A project with a keyword, which is respected.
fn protected(name: &str, kind: SourceKind, cpu: Option<String>) -> Read {
    let mut read = without_program(name, "?? protected", |span| {
        let message = "the project is protected by a keyword, and its program is not read";
        codes::PROTECTED_PROJECT
            .at(span, message)
            .label("this program")
            .help("if it is yours, delete the keyword in the editor and save the project again")
    });
    read.program.kind = kind;
    read.program.cpu = cpu;
    read
}

/// A project whose program is not read; `line` says what stands for it.
pub(crate) fn without_program(
    name: &str,
    line: &str,
    why: impl FnOnce(Span) -> Diagnostic,
) -> Read {
    let mut listing = Listing::default();
    listing.next_line();
    let span = listing.word(line);
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(why(span));
    Read {
        program: Program {
            source: listing.finish(name),
            unread: vec![0],
            ..Program::default()
        },
        diagnostics,
        ..Read::default()
    }
}

/// A project file in which no program can be found.
fn no_program(name: &str, bytes: &[u8]) -> Read {
    if bytes.len() <= START {
        return without_program(name, "?? cut off", |span| {
            let bytes = counted(bytes.len(), "byte");
            codes::DAMAGED
                .at(
                    span,
                    format!("the project is cut off after {bytes}, before its program"),
                )
                .label("the file ends here")
                .help("copy the project again")
        });
    }
    let shown = hex(bytes.get(HEADER..).unwrap_or(bytes));
    without_program(name, &format!("?? {shown}"), |span| {
        let what = "no program found; the data";
        bytes_error(&codes::DAMAGED, span, HEADER.min(bytes.len()), &shown, what)
    })
}

/// The warning that a part of the project beside its program cannot be read on at an offset.
fn damaged_part(what: &str, bytes: &[u8], at: usize) -> Diagnostic {
    damaged_rest(what, bytes.get(at..).unwrap_or_default(), at)
}

/// The same of a part whose bytes from the offset on are `rest`.
fn damaged_rest(what: &str, rest: &[u8], at: usize) -> Diagnostic {
    let there = match rest {
        [] => ", where the data ends".to_owned(),
        rest => format!(": {}", hex(rest)),
    };
    codes::DAMAGED_PART
        .at(
            Span::default(),
            format!("{what} cannot be read past offset 0x{at:04X}{there}"),
        )
        .label("the program itself is not affected")
        .help("open the project in its editor and save it again")
}

/// Adds the device comments of a `COMMENT.wcd` to a program.
fn add_comments(
    read: &mut Read,
    bytes: &[u8],
    table: &Comments<&[u8]>,
    encoding: &'static Encoding,
) {
    let comments = table.read.iter();
    let decoded = comments
        .filter_map(|(device, text)| Some((*device, clean(&decode_text(text, encoding))?.into())));
    read.program.comments.extend(decoded);
    let damaged = table.damaged;
    let damaged = damaged.map(|at| damaged_part("the table of device comments", bytes, at));
    read.diagnostics.extend(damaged);
}
