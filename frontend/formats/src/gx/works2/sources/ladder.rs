//! Ladders whose operands may be labels: the instructions of a token stream, with names as they are written.

use crate::encoding::decode_text;
use crate::gx::program::{self, hex};
use crate::gx::tokens::{self, Bare, Prefixes, Token};
use crate::text::clean;
use encoding_rs::Encoding;
use std::fmt;

/// A line of a ladder's list.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum LadderLine {
    /// Statement above a rung. Those that begin with `;FB` frame the box of a block: type, instance and pins.
    Statement(String),
    /// Instruction.
    Instruction {
        /// Mnemonic; of a pointer, the pointer itself (`P0`).
        mnemonic: String,
        /// Operands: devices, constants and labels. In the box of a block, `_NAME` is its pin.
        operands: Vec<String>,
        /// Note; empty if there is none.
        note: String,
    },
    /// Instruction with an unknown code: its bytes in hexadecimal.
    Unknown(String),
}

impl fmt::Display for LadderLine {
    /// Writes a line of an instruction list.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LadderLine::Statement(text) => write!(f, "; {text}"),
            LadderLine::Unknown(bytes) => write!(f, "?? {bytes}"),
            LadderLine::Instruction {
                mnemonic,
                operands,
                note,
            } => {
                f.write_str(mnemonic)?;
                for operand in operands {
                    write!(f, " {operand}")?;
                }
                match note.as_str() {
                    "" => Ok(()),
                    note => write!(f, " ; {note}"),
                }
            }
        }
    }
}

/// Instructions that have been read.
struct Reader {
    encoding: &'static Encoding,
    lines: Vec<LadderLine>,
    prefixes: Prefixes,
    /// True after a label token, whose pointer follows.
    is_label: bool,
}

/// The lines of a ladder's tokens, and the offset of bytes that are not a token.
pub(super) fn lines(code: &[u8], encoding: &'static Encoding) -> (Vec<LadderLine>, Option<usize>) {
    let mut reader = Reader {
        encoding,
        lines: Vec::new(),
        prefixes: Prefixes::default(),
        is_label: false,
    };
    let mut at = 0;
    while at < code.len() {
        let Some(body) = program::body(code, at) else {
            let is_padding = code[at..].iter().all(|&byte| byte == 0);
            return (reader.lines, (!is_padding).then_some(at));
        };
        reader.token(body);
        at += body.len() + 2;
    }
    (reader.lines, None)
}

impl Reader {
    fn token(&mut self, body: &[u8]) {
        match tokens::token(body) {
            Some(Token::Statement(text)) => {
                let text = clean(&decode_text(text, self.encoding));
                let text = text.map(|text| LadderLine::Statement(text.into()));
                self.lines.extend(text);
            }
            Some(Token::Note(text)) => {
                let text = clean(&decode_text(text, self.encoding));
                if let (Some(text), Some(LadderLine::Instruction { note, .. })) =
                    (text, self.lines.last_mut())
                {
                    *note = text.into();
                }
            }
            Some(Token::Prefix(prefix)) => self.prefixes.add(prefix),
            Some(Token::Operand(operand)) => self.operand(operand, body),
            Some(Token::Label) => self.is_label = true,
            Some(Token::Instruction(code)) => self.instruction(code.mnemonic.to_owned()),
            None if tokens::is_instruction(body) => {
                self.lines.push(LadderLine::Unknown(hex(body)));
            }
            None => self.add(format!("?{}", hex(body).replace(' ', ""))),
        }
    }

    fn instruction(&mut self, mnemonic: String) {
        self.lines.push(LadderLine::Instruction {
            mnemonic,
            operands: Vec::new(),
            note: String::new(),
        });
    }

    fn operand(&mut self, operand: Bare<'_>, body: &[u8]) {
        let prefixes = std::mem::take(&mut self.prefixes);
        let text = match operand {
            Bare::Kind(kind) => prefixes.join(kind).map(|kind| kind.to_string()),
            Bare::Address(address) => prefixes.buffer(address).map(|kind| kind.to_string()),
            Bare::Text(text) => Some(format!("\"{}\"", decode_text(text, self.encoding))),
            Bare::Name(name) => {
                let name = decode_text(name, self.encoding);
                let name = clean(&name).unwrap_or_default();
                Some(prefixes.around(&name))
            }
        };
        let text = text.unwrap_or_else(|| format!("?{}", hex(body).replace(' ', "")));
        match std::mem::take(&mut self.is_label) {
            true => self.instruction(text),
            false => self.add(text),
        }
    }

    /// Adds an operand to the last instruction.
    fn add(&mut self, text: String) {
        match self.lines.last_mut() {
            Some(LadderLine::Instruction { operands, .. }) => operands.push(text),
            Some(LadderLine::Unknown(bytes)) => {
                bytes.push(' ');
                bytes.push_str(&text);
            }
            Some(LadderLine::Statement(_)) | None => self.lines.push(LadderLine::Unknown(text)),
        }
    }
}
