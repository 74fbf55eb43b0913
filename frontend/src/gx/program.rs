//! A token stream becomes a program.

use super::tokens::{self, Token};
use crate::Read;
use crate::encoding::decode_local;
use crate::listing::Listing;
use crate::text::{append, clean};
use rungc_syntax::{
    Diagnostic, Diagnostics, Instr, Operand, OperandKind, Operands, Program, Span, codes,
};
use smol_str::{SmolStr, ToSmolStr};
use std::fmt::Write as _;

/// How many bytes of an unknown or damaged place a message shows.
const SHOWN: usize = 16;

/// The body of the token at `at`, if a token stands there.
pub(super) fn body(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let len = usize::from(*bytes.get(at)?);
    let token = bytes.get(at..at.checked_add(len)?)?;
    match token {
        [_, body @ .., last] if usize::from(*last) == len => Some(body),
        _ => None,
    }
}

/// The tokens that follow each other from one offset on.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Chain {
    /// Whether it ends in `END`.
    pub complete: bool,
    /// How many of its tokens are known, without NOP.
    pub known: u32,
}

impl Chain {
    /// Whether it is part of a program for sure: no other data has three known tokens in a row.
    pub fn is_program(self) -> bool {
        self.complete || self.known >= 3
    }
}

/// For each offset, the chain of tokens that begins there.
pub(super) fn chains(bytes: &[u8]) -> Vec<Chain> {
    let mut chains = vec![Chain::default(); bytes.len() + 1];
    for at in (0..bytes.len()).rev() {
        let Some(body) = body(bytes, at) else {
            continue;
        };
        let known = u32::from(!body.is_empty() && tokens::token(body).is_some());
        chains[at] = match chains.get(at + body.len() + 2) {
            _ if body == tokens::END => Chain {
                complete: true,
                known,
            },
            Some(rest) => Chain {
                known: rest.known + known,
                ..*rest
            },
            None => Chain {
                complete: false,
                known,
            },
        };
    }
    chains
}

/// Reads the program that begins at `start`, up to its `END`.
pub(super) fn read(name: &str, bytes: &[u8], start: usize, chains: &[Chain]) -> Read {
    let mut reader = Reader::default();
    let mut at = start;
    loop {
        let Some(body) = body(bytes, at) else {
            match reader.damage(bytes, at, chains) {
                Some(next) => at = next,
                None => break,
            }
            continue;
        };
        reader.token(body, at);
        if body == tokens::END {
            break;
        }
        at += body.len() + 2;
    }
    reader.finish(name)
}

/// Text of a token that waits for its code page.
enum Raw<'b> {
    Statement(usize, &'b [u8]),
    Note(usize, &'b [u8]),
}

#[derive(Default)]
struct Reader<'b> {
    program: Program,
    diagnostics: Diagnostics,
    listing: Listing,
    /// Statements and notes with the number of their instruction.
    texts: Vec<Raw<'b>>,
    /// Whether operands belong to the last instruction; otherwise they are passed over.
    open: bool,
    /// Whether a label waits for its pointer.
    label: bool,
    digits: Option<u8>,
    bit: Option<u8>,
    index: Option<u32>,
}

impl<'b> Reader<'b> {
    fn token(&mut self, body: &'b [u8], at: usize) {
        let Some(token) = tokens::token(body) else {
            return self.unknown(body, at);
        };
        if self.label && !matches!(token, Token::Operand(_)) {
            self.unread();
            self.report(&codes::DAMAGED, at, body, "a label without its pointer");
        }
        match token {
            Token::Instruction(mnemonic) => {
                self.listing.next_line();
                self.instruction(mnemonic);
            }
            Token::Label => {
                self.listing.next_line();
                self.open = false;
                self.label = true;
            }
            Token::Index(number) => self.index = Some(number),
            Token::Digits(digits) => self.digits = Some(digits),
            Token::Bit(bit) => self.bit = Some(bit),
            Token::Statement(text) => self
                .texts
                .push(Raw::Statement(self.program.instrs.len(), text)),
            Token::Note(text) => {
                if let Some(last) = self.program.instrs.len().checked_sub(1) {
                    self.texts.push(Raw::Note(last, text));
                }
            }
            Token::Operand(kind) => {
                let (digits, bit, index) = (self.digits.take(), self.bit.take(), self.index.take());
                match tokens::with_prefixes(kind, digits, bit, index) {
                    Some(kind) => self.operand(kind, body, at),
                    None => {
                        self.give_up();
                        self.report(
                            &codes::DAMAGED,
                            at,
                            body,
                            "an operand that its prefix does not go with",
                        );
                    }
                }
            }
        }
    }

    fn instruction(&mut self, mnemonic: SmolStr) {
        let span = self.listing.word(&mnemonic);
        self.open = true;
        self.program.instrs.push(Instr {
            mnemonic,
            mnemonic_span: span,
            operands: Operands::new(),
            span,
            step: None,
            remarks: None,
        });
    }

    fn operand(&mut self, kind: OperandKind, body: &[u8], at: usize) {
        if std::mem::take(&mut self.label) {
            match kind {
                OperandKind::Device(device, None) => self.instruction(device.to_smolstr()),
                _ => {
                    self.unread();
                    self.report(&codes::DAMAGED, at, body, "a label whose pointer is none");
                }
            }
            self.open = false;
            return;
        }
        let span = self.listing.word(&kind.to_string());
        if let (true, Some(instr)) = (self.open, self.program.instrs.last_mut()) {
            instr.span = instr.span.to(span);
            instr.operands.push(Operand { span, kind });
        }
    }

    /// Takes back the open instruction: one of its operands cannot be read.
    fn give_up(&mut self) {
        if std::mem::take(&mut self.open) {
            self.program.instrs.pop();
            self.unread();
        }
    }

    /// Remembers that an instruction is missing here; its operands are passed over.
    fn unread(&mut self) {
        self.open = false;
        self.label = false;
        self.program.unread.push(self.program.instrs.len() as u32);
    }

    fn unknown(&mut self, body: &[u8], at: usize) {
        match body.first() {
            Some(0x90..) => {
                self.give_up();
                self.report(&codes::UNKNOWN_BYTES, at, body, "an unknown operand");
            }
            _ => {
                self.listing.next_line();
                self.unread();
                self.report(&codes::UNKNOWN_BYTES, at, body, "an unknown instruction");
            }
        }
        self.label = false;
        (self.digits, self.bit, self.index) = (None, None, None);
    }

    /// Reports that no token stands at `at`; gives the next offset where tokens go on.
    fn damage(&mut self, bytes: &[u8], at: usize, chains: &[Chain]) -> Option<usize> {
        if bytes.get(at + 1).is_some_and(|&code| code >= 0x90) {
            self.give_up();
        }
        self.unread();
        let rest = bytes.get(at..).unwrap_or_default();
        self.listing.next_line();
        let next =
            (at + 1..bytes.len()).find(|&next| chains[next].complete || chains[next].known >= 2);
        let cut = rest.iter().skip(1).all(|&b| b == 0)
            || rest
                .first()
                .is_some_and(|&len| usize::from(len) > rest.len());
        match next {
            Some(next) => self.report(
                &codes::DAMAGED,
                at,
                &bytes[at..next],
                "bytes that are no part of a program",
            ),
            None if cut => self.report(
                &codes::TRUNCATED,
                at,
                rest,
                "the end of the file before the end of the program",
            ),
            None => self.report(
                &codes::DAMAGED,
                at,
                rest,
                "the end of all that can be read, without `END`",
            ),
        }
        next
    }

    /// Adds an error about bytes of the file, which it writes into the listing.
    fn report(&mut self, code: &'static codes::Code, at: usize, bytes: &[u8], what: &str) {
        let shown = hex(bytes);
        let span = self.listing.word(&format!("?? {shown}"));
        self.diagnostics
            .push(bytes_error(code, span, at, &shown, what));
    }

    fn finish(mut self, name: &str) -> Read {
        let raw: Vec<&[u8]> = self
            .texts
            .iter()
            .map(|raw| match raw {
                Raw::Statement(_, text) | Raw::Note(_, text) => *text,
            })
            .collect();
        for (raw, text) in self.texts.iter().zip(decode_local(&raw)) {
            let (Raw::Statement(at, _) | Raw::Note(at, _)) = *raw;
            let (Some(instr), Some(text)) = (self.program.instrs.get_mut(at), clean(&text)) else {
                continue;
            };
            match raw {
                Raw::Statement(..) => append(&mut instr.remarks_mut().statement, text),
                Raw::Note(..) => instr.remarks_mut().note = Some(text),
            }
        }
        self.program.source = self.listing.finish(name);
        Read {
            program: self.program,
            diagnostics: self.diagnostics,
        }
    }
}

/// An error that names the offset and the bytes.
pub(super) fn bytes_error(
    code: &codes::Code,
    span: Span,
    at: usize,
    shown: &str,
    what: &str,
) -> Diagnostic {
    code.at(span, format!("{what} at offset 0x{at:04X}: {shown}"))
        .label("read from these bytes")
        .help("open the project in its editor and export the list as CSV, which is read as well")
}

/// Bytes as people read them.
pub(super) fn hex(bytes: &[u8]) -> String {
    let mut text = String::new();
    for (at, byte) in bytes.iter().take(SHOWN).enumerate() {
        let _ = write!(text, "{}{byte:02X}", if at > 0 { " " } else { "" });
    }
    if bytes.len() > SHOWN {
        text.push_str(" …");
    }
    text
}
