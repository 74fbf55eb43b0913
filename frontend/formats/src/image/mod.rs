//! Program memory of FX PLCs: the image that the programming port transfers, and the `.PMW` file of FXGP/WIN, which
//! holds one.
//!
//! The vendor does not publish this format. What is read was worked out from recordings of transfers, from published
//! images and from independent firmware; `applied.tsv` gives the evidence for each applied instruction. A word whose
//! meaning none of them shows is an error that gives its step and bytes, and is not written either.
//!
//! An image begins at 8000h with 92 bytes of parameters; the program follows from 805Ch on, two bytes a step, low byte
//! first.

mod decode;
mod devices;
mod encode;
mod table;

use crate::encoding::decode_text;
use crate::listing::Listing;
use crate::text::clean;
use crate::{Read, ReadOptions};
use rungc_syntax::{
    DeviceClass, DeviceRun, Diagnostic, Diagnostics, Parameters, Program, SourceKind, codes,
};

/// Bytes of parameters before the program.
pub const PARAMETERS: usize = 0x5C;
/// The bytes of `END`, with which a program ends. They stand at an even offset only there: all words of operands have
/// their top bit set.
pub const END: [u8; 2] = encode::END_BYTES;

/// Length of the header of a `.PMW` file.
const PMW_HEADER: usize = 0x100;
/// Position and length of the title.
const TITLE: std::ops::Range<usize> = 0x08..0x28;
/// Position of the keyword that all models of the family have: eight hexadecimal digits, or spaces if there is none.
const KEYWORD: std::ops::Range<usize> = 0x08..0x10;
/// Position of the rest of the keyword on later models; zeros if there is none.
const LONG_KEYWORD: std::ops::Range<usize> = 0x44..0x50;
/// Blocks of comments, then of file registers, 500 steps each. Their places follow from the order of the editors'
/// parameters.
const BLOCKS: usize = 0x04;
/// Bytes of such a block.
const BLOCK: usize = 1000;
/// Offset of the latched ranges.
const LATCHED: usize = 0x30;
/// The largest memory in units of 1000 steps.
const MOST_CAPACITY: u16 = 64;

/// The latched ranges in their order, first and last of each: class, first device that can be chosen, its code, how
/// many can, distance of codes.
const RANGES: [(DeviceClass, u32, u16, u16, u16); 5] = [
    (DeviceClass::M, 0, 0x800, 1536, 1),
    (DeviceClass::S, 0, 0x000, 1024, 1),
    (DeviceClass::C, 0, 0xE00, 200, 1),
    (DeviceClass::C, 200, 0xEC8, 56, 1),
    (DeviceClass::D, 0, 0x000, 512, 2),
];
/// Default of these ranges: M500–M1023, S500–S999, C100–C199, C220–C255, D200–D511.
const DEFAULT_RANGES: [(u32, u32); 5] =
    [(500, 1023), (500, 999), (100, 199), (220, 255), (200, 511)];

/// A word of the parameters.
fn word(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..at + 2)?;
    Some(u16::from_le_bytes([bytes[0], bytes[1]]))
}

/// The devices that the two words of a range name; nothing if a code is not one of its class.
fn range(bytes: &[u8], nth: usize) -> Option<DeviceRun> {
    let (class, base, code, count, width) = RANGES[nth];
    let number = |at| {
        let offset = word(bytes, LATCHED + 4 * nth + at)?.checked_sub(code)?;
        let fits = offset % width == 0 && offset / width < count;
        fits.then_some(base + u32::from(offset / width))
    };
    let (first, last) = (number(0)?, number(2)?);
    Some(DeviceRun {
        class,
        first,
        count: (last + 1).saturating_sub(first),
    })
}

/// Decodes parameters; `None` if the bytes are not parameters.
fn parameters(bytes: &[u8]) -> Option<Parameters> {
    let bytes = bytes.get(..PARAMETERS)?;
    let capacity = word(bytes, 0).filter(|k| (1..=MOST_CAPACITY).contains(k))?;
    let latched: Option<Vec<_>> = (0..RANGES.len()).map(|nth| range(bytes, nth)).collect();
    Some(Parameters {
        latched: Some(latched?),
        capacity: Some(1000 * u32::from(capacity)),
        comment_blocks: word(bytes, BLOCKS)?.into(),
        file_register_blocks: word(bytes, BLOCKS + 2)?.into(),
        programs: Vec::new(),
        modules: Vec::new(),
        requests: Vec::new(),
        read_externally: Vec::new(),
        written_externally: Vec::new(),
        protected: is_protected(bytes),
    })
}

/// Offset of the program in an image with these parameters.
pub fn program_start(parameters: &[u8]) -> usize {
    let blocks = |at| usize::from(word(parameters, at).unwrap_or(0));
    PARAMETERS + BLOCK * (blocks(BLOCKS) + blocks(BLOCKS + 2))
}

/// Capacity of the memory with these parameters in steps; the largest if they do not state it.
pub fn capacity(parameters: &[u8]) -> usize {
    let stated = word(parameters, 0).filter(|k| (1..=MOST_CAPACITY).contains(k));
    1000 * usize::from(stated.unwrap_or(MOST_CAPACITY))
}

/// Returns true if parameters of a PLC hold a keyword.
pub fn is_protected(parameters: &[u8]) -> bool {
    let keyword = parameters.get(KEYWORD).unwrap_or_default();
    let long = parameters.get(LONG_KEYWORD).unwrap_or_default();
    let digits = |bytes: &[u8]| bytes.iter().all(|b| matches!(b, b'0'..=b'9' | b'A'..=b'F'));
    (!keyword.is_empty() && digits(keyword)) || long.iter().any(|b| *b != 0)
}

/// The image in a file: the file itself, or what follows the header of a `.PMW`.
fn image(bytes: &[u8]) -> Option<&[u8]> {
    let is_image = |bytes: &&[u8]| parameters(bytes).is_some();
    let pmw = bytes.get(PMW_HEADER..);
    [Some(bytes), pmw].into_iter().flatten().find(is_image)
}

/// Returns true if a file is an image, or holds one.
pub(crate) fn is_image(bytes: &[u8]) -> bool {
    image(bytes).is_some()
}

/// Reads an image, or a file that holds one; if `options.image` says that it is one, also with parameters of unknown
/// form.
pub(crate) fn read(name: &str, bytes: &[u8], options: &ReadOptions) -> Read {
    let image = image(bytes).unwrap_or(bytes);
    let Some(head) = image.get(..PARAMETERS) else {
        return refused(name, |at| {
            codes::NOT_AN_IMAGE
                .at(at, "this is not the program memory of an FX PLC")
                .label("shorter than the parameters that precede a program")
                .help("an image begins with 92 bytes of parameters; the program follows them")
        });
    };
    let parameters = parameters(image);
    if is_protected(head) {
        let mut read = refused(name, |at| {
            codes::PROTECTED_PROJECT
                .at(
                    at,
                    "the image is protected by a keyword, and its program is not read",
                )
                .label("this program")
                .help("if it is yours, delete the keyword in the editor and read the PLC again")
        });
        read.program.parameters = parameters;
        return read;
    }
    let code = image.get(program_start(head)..).unwrap_or_default();
    let mut read = decode::read(name, code, Listing::default());
    let title = &head[TITLE];
    let encoding = options.encoding_of(&[title], None);
    read.program.title = clean(&decode_text(title, encoding)).map(Into::into);
    read.program.kind = SourceKind::Image;
    read.program.parameters = parameters;
    read
}

/// An image of which nothing is read.
fn refused(name: &str, why: impl FnOnce(rungc_syntax::Span) -> Diagnostic) -> Read {
    let mut read = crate::gx::without_program(name, "?? program memory", why);
    read.program.kind = SourceKind::Image;
    read
}

/// The program as an image: its parameters and its machine code up to `END`.
///
/// What an image cannot hold, device comments and statements, is left out. The check word at 8002h is 0, since no
/// source says how it is computed; PLCs of the family get the same from their editor before it adds the word.
///
/// # Errors
/// The instructions whose machine code is not known, and a program without `END`.
pub fn write(program: &Program) -> Result<Vec<u8>, Diagnostics> {
    let words = encode::words(program)?;
    let mut bytes = header(program, words.len());
    bytes.extend(words.into_iter().flat_map(u16::to_le_bytes));
    Ok(bytes)
}

/// The parameters of a program of this many steps.
fn header(program: &Program, steps: usize) -> Vec<u8> {
    const CAPACITIES: [u32; 5] = [2000, 4000, 8000, 16_000, 64_000];
    let mut bytes = vec![0; PARAMETERS];
    let mut put = |at: usize, word: u16| bytes[at..at + 2].copy_from_slice(&word.to_le_bytes());
    let stated = program.parameters.as_ref().and_then(|p| p.capacity);
    let enough = |capacity: &u32| *capacity as usize >= steps;
    let smallest = CAPACITIES
        .into_iter()
        .skip(2)
        .find(enough)
        .unwrap_or(64_000);
    put(0, (stated.filter(enough).unwrap_or(smallest) / 1000) as u16);
    let latched = program
        .parameters
        .as_ref()
        .and_then(|p| p.latched.as_deref());
    for (nth, (class, base, code, count, width)) in RANGES.into_iter().enumerate() {
        let numbers = base..base + u32::from(count);
        let chosen = latched.into_iter().flatten().find(|run| {
            run.class == class
                && run.count > 0
                && numbers.contains(&run.first)
                && numbers.contains(&(run.first + run.count - 1))
        });
        let default = DEFAULT_RANGES[nth];
        let (first, last) = chosen.map_or(default, |run| (run.first, run.first + run.count - 1));
        for (at, number) in [(0, first), (2, last)] {
            put(
                LATCHED + 4 * nth + at,
                code + (number - base) as u16 * width,
            );
        }
    }
    bytes[TITLE.start..LATCHED].fill(b' ');
    let title = program.title.as_deref().filter(|title| title.is_ascii());
    for (byte, c) in bytes[TITLE]
        .iter_mut()
        .zip(title.unwrap_or_default().bytes())
    {
        *byte = c;
    }
    if is_protected(&bytes) {
        bytes[TITLE].fill(b' ');
    }
    bytes
}
