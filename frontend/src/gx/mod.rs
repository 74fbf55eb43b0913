//! Projects of GX Developer (a folder with `MAIN.wpg` and `COMMENT.wcd`) and GX Works2 (`.gxw`).

mod cpu;
mod gxw;
mod program;
pub(crate) mod table;
mod tokens;

pub(crate) use gxw::read as read_gxw;
pub(crate) use program::hex;
pub(crate) use tokens::steps;

use crate::encoding::decode_local;
use crate::text::clean;
use crate::{Read, ReadOptions};
use program::{Chain, bytes_error};
use rungc_syntax::{Device, Diagnostics, Program, SourceKind, Span, codes};

/// Length of the header that all files of a project begin with.
const HEADER: usize = 0x40;
/// How those files begin.
const MAGIC: [u8; 4] = [0x40, 0x00, 0x22, 0x01];
/// Where the program begins in `MAIN.wpg`.
const START: usize = 0x44;
/// Data behind this many bytes belongs to no program.
const MAX_DATA: usize = 32 << 20;
/// Where the header names the CPU: `04 02`, then its code.
const CPU: usize = 0x24;
/// How an OLE compound file begins.
const OLE: [u8; 8] = [0xD0, 0xCF, 0x11, 0xE0, 0xA1, 0xB1, 0x1A, 0xE1];
/// Length of one comment in `COMMENT.wcd`.
const SLOT: usize = 40;
/// Length of the head of the table of comments, and of each of its entries.
const ENTRY: usize = 10;

/// Whether this is a GX Works2 project, or another OLE file.
pub(crate) fn is_ole(bytes: &[u8]) -> bool {
    bytes.starts_with(&OLE)
}

/// Whether this is a file of a GX Developer project.
pub(crate) fn is_wpg(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
        || (bytes.get(CPU..CPU + 2) == Some(&[4, 2]) && bytes.get(CPU + 3) == Some(&2))
}

/// Reads `MAIN.wpg`.
pub(crate) fn read_wpg(name: &str, bytes: &[u8], options: &ReadOptions) -> Read {
    let cpu = cpu_code(bytes).map(cpu::name);
    let refused = |cpu: &String| cpu::refused(name, SourceKind::GxDeveloper, cpu);
    if let Some(refused) = cpu.as_ref().and_then(refused) {
        return refused;
    }
    let bytes = bytes.get(..MAX_DATA).unwrap_or(bytes);
    let chains = program::chains(bytes);
    let begins = program::body(bytes, START).is_some_and(|body| tokens::token(body).is_some());
    let start = if begins {
        Some(START)
    } else {
        (HEADER..bytes.len()).find(|&at| chains[at].is_program())
    };
    let mut read = match start {
        Some(start) => program::read(name, bytes, start, &chains, options),
        None => no_program(name, bytes),
    };
    read.program.kind = SourceKind::GxDeveloper;
    read.program.cpu = cpu;
    read
}

/// The number of the CPU type that the header names.
fn cpu_code(bytes: &[u8]) -> Option<u16> {
    match bytes.get(CPU..CPU + 4)? {
        [4, 2, low, high] => Some(u16::from_le_bytes([*low, *high])),
        _ => None,
    }
}

/// A project file in which no program can be found.
fn no_program(name: &str, bytes: &[u8]) -> Read {
    let shown = hex(bytes.get(HEADER..).unwrap_or(bytes));
    let mut listing = crate::listing::Listing::default();
    listing.next_line();
    let span = listing.word(&format!("?? {shown}"));
    let what = "no program can be found; the data";
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(bytes_error(
        &codes::DAMAGED,
        span,
        HEADER.min(bytes.len()),
        &shown,
        what,
    ));
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

/// Whether this is a table of device comments.
fn is_comments(bytes: &[u8]) -> bool {
    bytes.get(HEADER + 4..HEADER + 8) == Some(&[0, 0, 0x20, 0x08])
}

/// Adds the device comments of a `COMMENT.wcd` to a program.
pub(crate) fn add_comments(read: &mut Read, bytes: &[u8]) {
    let mut devices = Vec::new();
    let mut texts = Vec::new();
    let whole = comments(bytes, |device, text| {
        devices.push(device);
        texts.push(text);
    });
    let decoded = devices.into_iter().zip(decode_local(&texts));
    let comments = decoded.filter_map(|(device, text)| Some((device, clean(&text)?.into())));
    read.program.comments.extend(comments);
    if let Err(at) = whole {
        let shown = hex(bytes.get(at..).unwrap_or_default());
        let what = "the table of device comments cannot be read on";
        read.diagnostics.push(
            codes::DAMAGED
                .at(Span::default(), format!("{what} at offset 0x{at:04X}: {shown}"))
                .label("comments of this program's devices")
                .help("the program itself is not affected: remove the comment file to go on without comments"),
        );
    }
}

/// Gives each comment with its device; an offset where the table cannot be read on.
fn comments<'b>(bytes: &'b [u8], mut each: impl FnMut(Device, &'b [u8])) -> Result<(), usize> {
    let word = |at: usize| Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?));
    let dword = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    if !is_comments(bytes) {
        return Err(HEADER);
    }
    let length = dword(HEADER).ok_or(HEADER)? as usize;
    let count = word(HEADER + 8).ok_or(HEADER + 8)?;
    let mut slot = HEADER + length;
    for entry in 0..usize::from(count) {
        let at = HEADER + ENTRY * (entry + 1);
        let code = word(at).ok_or(at)?;
        let first = dword(at + 2).ok_or(at)?;
        let many = dword(at + 6).ok_or(at)?;
        let class = u8::try_from(code)
            .ok()
            .and_then(tokens::commented)
            .ok_or(at)?;
        for number in 0..many {
            let text = bytes
                .get(slot..slot.saturating_add(SLOT))
                .ok_or(slot.min(bytes.len()))?;
            let number = first.checked_add(number).ok_or(at)?;
            each(Device { class, number }, text);
            slot += SLOT;
        }
    }
    Ok(())
}
