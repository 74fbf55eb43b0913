//! From machine code to instructions.

use super::devices::{at_point, operand};
use super::table::{self, BARE, COILS, CONTACTS, EDGES, PULSES};
use crate::Read;
use crate::gx::hex;
use crate::listing::Listing;
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Diagnostics, Instr, Operand, OperandKind, Operands, Program,
    Span, codes,
};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};

/// Maximum number of steps that are read: the largest program memory of the family has 64,000.
const MOST_STEPS: usize = 0xFFFF;
/// Erased memory.
const ERASED: u16 = 0xFFFF;

/// One instruction as its words say.
struct Decoded {
    mnemonic: SmolStr,
    operands: Vec<OperandKind>,
    /// True if its word follows only from a rule.
    derived: bool,
}

/// The words that follow each other from one step on.
struct Words<'b> {
    bytes: &'b [u8],
    /// The step of the next word.
    at: usize,
}

impl Words<'_> {
    fn get(&self, step: usize) -> Option<u16> {
        let bytes = self.bytes.get(2 * step..2 * step + 2)?;
        Some(u16::from_le_bytes([bytes[0], bytes[1]]))
    }

    fn next(&mut self) -> Option<u16> {
        let word = self.get(self.at)?;
        self.at += 1;
        Some(word)
    }

    /// The next word as a number with the top bit set, e.g. 8005h for S5.
    fn number(&mut self, most: u16) -> Option<u32> {
        let number = self.next()?.checked_sub(0x8000)?;
        (number <= most).then_some(number.into())
    }

    /// The next word as a point with the nibble that widens it.
    fn far_point(&mut self) -> Option<Device> {
        at_point(self.next()?.checked_sub(0x8000)?)
    }

    fn operand(&mut self, wide: bool) -> Option<OperandKind> {
        let mut words = [0; 4];
        let words = &mut words[..if wide { 4 } else { 2 }];
        for word in words.iter_mut() {
            *word = self.next()?;
        }
        operand(words)
    }
}

/// Reads machine code from its first word on, up to `END`.
pub(super) fn read(name: &str, bytes: &[u8], listing: Listing) -> Read {
    let mut reader = Reader {
        words: Words { bytes, at: 0 },
        listing,
        program: Program::default(),
        diagnostics: Diagnostics::new(),
        derived: Vec::new(),
    };
    reader.run();
    reader.diagnostics.extend(derived_note(&reader.derived));
    reader.program.source = reader.listing.finish(name);
    Read {
        program: reader.program,
        diagnostics: reader.diagnostics,
        ..Read::default()
    }
}

struct Reader<'b> {
    words: Words<'b>,
    listing: Listing,
    program: Program,
    diagnostics: Diagnostics,
    /// Instructions that only the rule explains, each once, with the place of the first.
    derived: Vec<(SmolStr, Span)>,
}

impl Reader<'_> {
    fn run(&mut self) {
        loop {
            let step = self.words.at;
            match self.words.get(step) {
                None => return self.cut("the memory ends"),
                Some(ERASED) => return self.cut("the memory is erased"),
                Some(_) if step >= MOST_STEPS => {
                    return self.cut("the largest program memory ends");
                }
                Some(_) => {}
            }
            match decode(&mut self.words) {
                Some(decoded) => {
                    let end = decoded.mnemonic == "END";
                    self.push(step, decoded);
                    if end {
                        return;
                    }
                }
                None => self.unknown(step),
            }
        }
    }

    fn margin(&mut self, step: usize) {
        self.listing.next_line();
        self.listing.margin(&step.to_string());
    }

    fn push(&mut self, step: usize, decoded: Decoded) {
        self.margin(step);
        let mnemonic_span = self.listing.word(&decoded.mnemonic);
        let operands: Operands = decoded
            .operands
            .into_iter()
            .map(|kind| Operand {
                span: self.listing.word(&kind.to_string()),
                kind,
            })
            .collect();
        let last = operands.last().map_or(mnemonic_span, |last| last.span);
        let known = |(name, _): &(SmolStr, Span)| *name == decoded.mnemonic;
        if decoded.derived && !self.derived.iter().any(known) {
            self.derived.push((decoded.mnemonic.clone(), mnemonic_span));
        }
        self.program.instrs.push(Instr {
            mnemonic: decoded.mnemonic,
            mnemonic_span,
            operands,
            span: mnemonic_span.to(last),
            step: Some(step as u32),
            remarks: None,
        });
    }

    /// Reports the word at a step, and passes over it and the operands that follow it.
    fn unknown(&mut self, step: usize) {
        self.words.at = step + 1;
        while self.words.get(self.words.at).is_some_and(is_operand) {
            self.words.at += 1;
        }
        let bytes = self.words.bytes;
        let bytes = &bytes[2 * step..bytes.len().min(2 * self.words.at)];
        let shown = hex(bytes);
        self.margin(step);
        let span = self.listing.word(&format!("?? {shown}"));
        let message = format!("unknown machine code at step {step}: {shown}");
        self.diagnostics.push(
            codes::UNKNOWN_MACHINE_CODE
                .at(span, message)
                .label("no known image shows what these bytes mean")
                .help(
                    "read the PLC with its editor, and give rungc the project or its list export",
                ),
        );
        self.missing();
    }

    /// Reports that the program ends without `END`.
    fn cut(&mut self, why: &str) {
        let step = self.words.at;
        self.margin(step);
        let span = self.listing.word("??");
        let message = format!("{why} at step {step}, before the program's `END`");
        self.diagnostics.push(
            codes::TRUNCATED
                .at(span, message)
                .label("an `END` is missing")
                .help("read the PLC again, from 8000h to the `END` of its program"),
        );
        self.missing();
    }

    fn missing(&mut self) {
        self.program.unread.push(self.program.instrs.len() as u32);
    }
}

/// Returns true if a word belongs to the operands of the preceding instruction: no instruction has such a word.
fn is_operand(word: u16) -> bool {
    (0x8000..0xB000).contains(&word)
}

/// The next instruction; nothing if one of its words means nothing.
fn decode(words: &mut Words) -> Option<Decoded> {
    use DeviceClass::{C, D, M, N, P, S, T, V, Y, Z};
    let word = words.next()?;
    if let Some((_, mnemonic)) = BARE.iter().find(|(code, _)| *code == word) {
        return Some(decoded(mnemonic, []));
    }
    let near = || at_point(word & 0xFFF);
    let device = |class, number: u32| OperandKind::Device(Device { class, number }, None);
    let far = |words: &mut Words, of: &[DeviceClass]| {
        let device = words.far_point()?;
        let fits = of.is_empty() || of.contains(&device.class);
        fits.then_some(OperandKind::Device(device, None))
    };
    Some(match word {
        0x2000..=0x7FFF => {
            let mnemonic = CONTACTS[usize::from(word >> 12) - 2];
            decoded(mnemonic, [OperandKind::Device(near()?, None)])
        }
        0xC000..=0xEFFF => {
            let device = near().filter(|d| {
                matches!(
                    d,
                    Device { class: Y, .. }
                        | Device {
                            class: M,
                            number: 0..8000
                        }
                )
            })?;
            let mnemonic = COILS[usize::from(word >> 12) - 0xC];
            decoded(mnemonic, [OperandKind::Device(device, None)])
        }
        0x01C2..=0x01C7 => decoded(CONTACTS[usize::from(word - 0x01C2)], [far(words, &[])?]),
        0x01CA..=0x01CF => decoded(EDGES[usize::from(word - 0x01CA)], [far(words, &[])?]),
        0x0002..=0x0004 => decoded(COILS[usize::from(word - 0x0002)], [far(words, &[Y, M])?]),
        0x0005..=0x0007 => {
            let state = device(S, words.number(0x3FF)?);
            decoded(COILS[usize::from(word - 0x0005)], [state])
        }
        0x0008..=0x0009 => decoded(PULSES[usize::from(word - 0x0008)], [far(words, &[Y, M])?]),
        0x000A => {
            let level = device(N, words.number(0xFF)?);
            decoded("MC", [level, far(words, &[Y, M])?])
        }
        0x000B => decoded("MCR", [device(N, words.number(0xFF)?)]),
        0x000C => decoded("RST", [far(words, &[T, C])?]),
        0x000D => {
            let register = words.operand(false)?;
            register
                .device()
                .filter(|d| matches!(d.class, D | V | Z | T | C))?;
            decoded("RST", [register])
        }
        0x0600..=0x07FF => {
            let timer = device(T, u32::from(word - 0x0600));
            decoded("OUT", [timer, words.operand(false)?])
        }
        0x0E00..=0x0EFF => {
            let number = u32::from(word - 0x0E00);
            decoded("OUT", [device(C, number), words.operand(number >= 200)?])
        }
        0xB000..=0xB0FF => {
            let number = u32::from(word - 0xB000);
            decoded(&Device { class: P, number }.to_smolstr(), [])
        }
        0xF000..=0xF3FF => decoded("STL", [device(S, u32::from(word - 0xF000))]),
        _ => return applied(table::applied(word)?, words),
    })
}

fn applied(row: &table::Applied, words: &mut Words) -> Option<Decoded> {
    let operands: Option<Vec<_>> = (0..row.operands).map(|_| words.operand(row.wide)).collect();
    let pulse = if row.pulse { "P" } else { "" };
    Some(Decoded {
        mnemonic: format_smolstr!("{}{pulse}", row.mnemonic),
        operands: operands?,
        derived: !row.seen,
    })
}

fn decoded<const N: usize>(mnemonic: &str, operands: [OperandKind; N]) -> Decoded {
    Decoded {
        mnemonic: mnemonic.into(),
        operands: operands.into(),
        derived: false,
    }
}

/// The note that names the instructions that only the rule explains, if any.
fn derived_note(derived: &[(SmolStr, Span)]) -> Option<Diagnostic> {
    let (_, first) = derived.first()?;
    let list: Vec<_> = derived
        .iter()
        .map(|(name, _)| format!("`{name}`"))
        .collect();
    let message = format!(
        "read by the rule of their numbers, which no image has shown for them yet: {}",
        list.join(", ")
    );
    Some(
        codes::DERIVED_CODES
            .at(*first, message)
            .label("the first of them")
            .help("compare with the editor's list of the PLC"),
    )
}
