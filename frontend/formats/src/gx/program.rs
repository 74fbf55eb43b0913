//! A token stream becomes a program.

use super::table::Evidence;
use super::tokens::{self, Bare, Prefixes, Token};
use crate::encoding::decode_text;
use crate::learned::{self, LearnedCodes, Reading, Unproven};
use crate::listing::Listing;
use crate::text::{Lines, clean};
use crate::{Read, ReadOptions};
use encoding_rs::Encoding;
use rungc_syntax::{
    Diagnostic, Diagnostics, Instr, Operand, OperandKind, Operands, Program, Span, codes,
};
use smol_str::{SmolStr, ToSmolStr};
use std::fmt::Write as _;

/// Number of bytes of an unknown or damaged place in a message.
const SHOWN: usize = 16;

/// The body of the token at `at`, if there is one.
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
    /// True if it ends in `END`.
    pub complete: bool,
    /// Number of its known tokens, without NOP.
    pub known: u32,
}

impl Chain {
    /// Returns true if it is certain to be part of a program: no other data has three known tokens in a row.
    pub(crate) fn is_program(self) -> bool {
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

/// A piece of a program's bytes.
enum Piece<'b> {
    /// A token with this body.
    Token(&'b [u8]),
    /// Bytes without a token.
    Damage(&'b [u8], Damage),
}

/// Kind of damage.
enum Damage {
    /// Tokens continue after it.
    Hole,
    /// The file ends within a token.
    Cut,
    /// No token follows, and none was `END`.
    Rest,
}

/// The pieces of the program that begins at `at`, up to its `END`, with their offsets.
struct Pieces<'b> {
    bytes: &'b [u8],
    chains: &'b [Chain],
    /// Offset of the next piece; `None` after the last.
    at: Option<usize>,
}

impl<'b> Iterator for Pieces<'b> {
    type Item = (usize, Piece<'b>);

    fn next(&mut self) -> Option<Self::Item> {
        let at = self.at?;
        if let Some(body) = body(self.bytes, at) {
            self.at = (body != tokens::END).then(|| at + body.len() + 2);
            return Some((at, Piece::Token(body)));
        }
        let next = (at + 1..self.bytes.len())
            .find(|&next| self.chains[next].complete || self.chains[next].known >= 2);
        self.at = next;
        let rest = self.bytes.get(at..next.unwrap_or(self.bytes.len()));
        let rest = rest.unwrap_or_default();
        let cut = rest.iter().skip(1).all(|&b| b == 0)
            || rest
                .first()
                .is_some_and(|&len| usize::from(len) > rest.len());
        let damage = match next {
            Some(_) => Damage::Hole,
            None if cut => Damage::Cut,
            None => Damage::Rest,
        };
        Some((at, Piece::Damage(rest, damage)))
    }
}

/// The text that a piece holds, in the project's code page.
fn text<'b>(piece: &Piece<'b>) -> Option<&'b [u8]> {
    let Piece::Token(body) = piece else {
        return None;
    };
    match tokens::token(body)? {
        Token::Statement(text)
        | Token::Note(text)
        | Token::Operand(Bare::Text(text) | Bare::Name(text)) => Some(text),
        _ => None,
    }
}

/// The bodies of the tokens of `code`; where there is none, the next one is looked for.
pub(super) fn bodies(code: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut at = 0;
    std::iter::from_fn(move || {
        while at < code.len() {
            if let Some(body) = body(code, at) {
                at += body.len() + 2;
                return Some(body);
            }
            at += 1;
        }
        None
    })
}

/// A program in the bytes of a file.
pub(super) struct Code<'b> {
    bytes: &'b [u8],
    start: usize,
    chains: &'b [Chain],
}

impl<'b> Code<'b> {
    /// The program that begins at `start`, up to its `END`.
    pub fn new(bytes: &'b [u8], start: usize, chains: &'b [Chain]) -> Self {
        Code {
            bytes,
            start,
            chains,
        }
    }

    fn pieces(&self) -> Pieces<'b> {
        Pieces {
            bytes: self.bytes,
            chains: self.chains,
            at: Some(self.start),
        }
    }

    /// Its texts, in the project's code page.
    pub fn texts(&self) -> Vec<&'b [u8]> {
        self.pieces()
            .filter_map(|(_, piece)| text(&piece))
            .collect()
    }

    /// Reads it; its texts are in this encoding.
    pub fn read(&self, name: &str, encoding: &'static Encoding, options: &ReadOptions) -> Read {
        let texts = self.texts().into_iter();
        let texts = texts.map(|text| decode_text(text, encoding)).collect();
        let mut reader = Reader::new(&options.learned, texts);
        for (at, piece) in self.pieces() {
            match piece {
                Piece::Token(body) => reader.token(body, at),
                Piece::Damage(rest, damage) => reader.damage(rest, at, &damage),
            }
        }
        reader.finish(name)
    }
}

/// Owner of an operand or a note.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Current {
    /// Nothing yet.
    None,
    /// The last instruction.
    Instr,
    /// A label of this many steps that waits for its pointer.
    Label(u32),
    /// A label that has it.
    Labelled,
    /// An instruction whose code is not known: the last of those that are not.
    Unknown,
    /// An instruction that could not be read, which was reported.
    Unread,
}

struct Reader<'l> {
    learned: &'l LearnedCodes,
    /// Texts of tokens, in their order.
    texts: std::vec::IntoIter<String>,
    program: Program,
    diagnostics: Diagnostics,
    listing: Listing,
    unproven: Vec<Unproven>,
    /// Labels that operands name, with the place of the first.
    names: Option<(Span, Vec<String>)>,
    /// Statements that wait for the instruction below them.
    statement: Lines,
    current: Current,
    prefixes: Prefixes,
    /// The step of the next instruction; nothing after bytes that could not be read.
    step: Option<u32>,
}

impl<'l> Reader<'l> {
    fn new(learned: &'l LearnedCodes, texts: Vec<String>) -> Self {
        Reader {
            learned,
            texts: texts.into_iter(),
            program: Program::default(),
            diagnostics: Diagnostics::new(),
            listing: Listing::default(),
            unproven: Vec::new(),
            names: None,
            statement: Lines::default(),
            current: Current::None,
            prefixes: Prefixes::default(),
            step: Some(0),
        }
    }

    fn token(&mut self, body: &[u8], at: usize) {
        let token = tokens::token(body);
        if !matches!(token, Some(Token::Operand(_) | Token::Prefix(_))) {
            self.end_of_operands(body, at);
        }
        match token {
            Some(Token::Statement(_)) => {
                let text = self.text();
                if let Some(text) = clean(&text) {
                    self.statement.push(&text);
                }
            }
            Some(Token::Note(_)) => {
                let text = self.text();
                let instr = self.program.instrs.last_mut();
                let noted = matches!(self.current, Current::Instr | Current::Labelled);
                if let (Some(instr), Some(text), true) = (instr, clean(&text), noted) {
                    instr.remarks_mut().note = Some(text);
                }
            }
            Some(Token::Prefix(prefix)) => self.prefixes.add(prefix),
            Some(Token::Operand(operand)) => self.operand(operand, body, at),
            Some(Token::Label) => {
                self.next_instruction();
                self.current = Current::Label(tokens::steps(body));
            }
            Some(Token::Instruction(code)) => {
                let mnemonic = SmolStr::new_static(code.mnemonic);
                match code.evidence {
                    Evidence::Seen | Evidence::Published => self.instruction(mnemonic),
                    Evidence::Derived => self.derived(body, at, mnemonic),
                    Evidence::Guess => self.unknown(body, at, Reading::Guess(mnemonic)),
                }
                self.advance(tokens::steps(body));
            }
            None if tokens::is_instruction(body) => {
                self.unknown(body, at, Reading::Unknown);
                self.advance(tokens::steps(body));
            }
            None => {
                self.prefixes = Prefixes::default();
                let open = self.program.instrs.last();
                let open = open.filter(|_| self.current == Current::Instr);
                let what = open.map_or("an unknown operand".to_owned(), |instr| {
                    format!("an unknown operand of `{}`", instr.mnemonic)
                });
                let span = self.report(&codes::UNKNOWN_BYTES, at, body, &what);
                self.add_operand(span, OperandKind::Unreadable(None));
            }
        }
    }

    /// The text of the token that is being read.
    fn text(&mut self) -> String {
        self.texts.next().unwrap_or_default()
    }

    /// Counts the steps of an instruction.
    fn advance(&mut self, steps: u32) {
        self.step = self.step.and_then(|step| step.checked_add(steps));
    }

    /// No operand follows: whatever waits for one is an error.
    fn end_of_operands(&mut self, body: &[u8], at: usize) {
        if !self.prefixes.is_empty() {
            self.broken_operand(&codes::DAMAGED, at, body, "no operand after a prefix");
        }
        if let Current::Label(steps) = self.current {
            self.unread();
            self.advance(steps);
            self.report(&codes::DAMAGED, at, body, "a label without its pointer");
        }
    }

    /// Ends the instruction before and begins the next line of the listing.
    fn next_instruction(&mut self) {
        self.close_unknown();
        self.listing.next_line();
    }

    fn instruction(&mut self, mnemonic: SmolStr) {
        self.next_instruction();
        self.push(mnemonic);
    }

    /// Adds an instruction, on the line of the listing that has begun.
    fn push(&mut self, mnemonic: SmolStr) {
        let span = self.listing.word(&mnemonic);
        self.current = Current::Instr;
        self.program.instrs.push(Instr {
            mnemonic,
            mnemonic_span: span,
            operands: Operands::new(),
            span,
            step: self.step,
            remarks: rungc_syntax::Remarks::new(self.statement.take(), None),
        });
    }

    /// An instruction whose code was derived: read, and reported.
    fn derived(&mut self, body: &[u8], at: usize, mnemonic: SmolStr) {
        if let Some(learned) = self.learned.get(body) {
            return self.instruction(learned.clone());
        }
        self.instruction(mnemonic.clone());
        self.unproven(body, at, Reading::Derived(mnemonic), Span::default());
    }

    /// An instruction whose code is not known, unless it was learned.
    fn unknown(&mut self, body: &[u8], at: usize, reading: Reading) {
        if let Some(learned) = self.learned.get(body) {
            return self.instruction(learned.clone());
        }
        self.next_instruction();
        let span = self.listing.word(&format!("?? {}", hex(body)));
        self.unread();
        self.current = Current::Unknown;
        self.unproven(body, at, reading, span);
    }

    fn unproven(&mut self, body: &[u8], offset: usize, reading: Reading, span: Span) {
        let read = usize::from(matches!(reading, Reading::Derived(_)));
        self.unproven.push(Unproven {
            code: body.to_vec(),
            reading,
            at: self.program.instrs.len() - read,
            step: self.step,
            offset,
            operands: Operands::new(),
            span,
        });
    }

    /// Reports the instruction whose code is not known, now that its operands are read.
    fn close_unknown(&mut self) {
        if self.current == Current::Unknown
            && let Some(unproven) = self.unproven.last()
        {
            self.diagnostics.push(unproven.error());
            self.current = Current::Unread;
        }
    }

    fn operand(&mut self, operand: Bare<'_>, body: &[u8], at: usize) {
        let prefixes = std::mem::take(&mut self.prefixes);
        let kind = match operand {
            Bare::Kind(kind) => prefixes.join(kind),
            Bare::Address(address) => prefixes.buffer(address),
            Bare::Text(_) => {
                let text = OperandKind::Text(self.text().into());
                prefixes.is_empty().then_some(text)
            }
            Bare::Name(_) => {
                let name = self.text();
                return self.name(name);
            }
        };
        match kind {
            Some(kind) => self.whole_operand(kind, body, at),
            None => {
                let what = "an operand that does not match its prefixes";
                self.broken_operand(&codes::DAMAGED, at, body, what);
            }
        }
    }

    fn whole_operand(&mut self, kind: OperandKind, body: &[u8], at: usize) {
        match self.current {
            Current::Instr | Current::Unknown => {
                let span = self.listing.word(&kind.to_string());
                self.add_operand(span, kind);
            }
            Current::Label(steps) => {
                if let OperandKind::Device(device, None) = kind {
                    self.push(device.to_smolstr());
                    self.current = Current::Labelled;
                } else {
                    self.unread();
                    self.report(
                        &codes::DAMAGED,
                        at,
                        body,
                        "a label whose pointer is not a pointer",
                    );
                }
                self.advance(steps);
            }
            Current::Unread => _ = self.listing.word(&kind.to_string()),
            Current::None | Current::Labelled => {
                self.report(
                    &codes::DAMAGED,
                    at,
                    body,
                    "an operand without an instruction",
                );
            }
        }
    }

    /// Gives the open instruction an operand, which the listing has.
    fn add_operand(&mut self, span: Span, kind: OperandKind) {
        let (whole, operands) = match self.current {
            Current::Instr => match self.program.instrs.last_mut() {
                Some(instr) => (&mut instr.span, &mut instr.operands),
                None => return,
            },
            Current::Unknown => match self.unproven.last_mut() {
                Some(unproven) => (&mut unproven.span, &mut unproven.operands),
                None => return,
            },
            Current::Label(_) => return self.give_up_label(),
            Current::None | Current::Labelled | Current::Unread => return,
        };
        *whole = whole.to(span);
        operands.push(Operand { span, kind });
    }

    /// The operand is a label: which device it means is not in the source.
    fn name(&mut self, name: String) {
        let span = self.listing.word(&name);
        self.add_operand(span, OperandKind::Unreadable(None));
        let (_, names) = self.names.get_or_insert((span, Vec::new()));
        if !names.contains(&name) {
            names.push(name);
        }
    }

    /// An operand cannot be read: its instruction keeps it as such.
    fn broken_operand(&mut self, code: &'static codes::Code, at: usize, body: &[u8], what: &str) {
        self.prefixes = Prefixes::default();
        if self.current == Current::Unread && code.id == codes::DAMAGED.id {
            // It was reported that the instruction cannot be read.
            self.listing.word(&format!("?? {}", hex(body)));
            return;
        }
        let span = self.report(code, at, body, what);
        self.add_operand(span, OperandKind::Unreadable(None));
    }

    /// Takes back a label whose pointer cannot be read.
    fn give_up_label(&mut self) {
        if let Current::Label(steps) = self.current {
            self.unread();
            self.advance(steps);
        }
    }

    /// Remembers that an instruction is missing here.
    fn unread(&mut self) {
        self.current = Current::Unread;
        self.program.unread.push(self.program.instrs.len() as u32);
    }

    /// Reports bytes without a token.
    fn damage(&mut self, rest: &[u8], at: usize, damage: &Damage) {
        self.prefixes = Prefixes::default();
        // It begins within the operands of an instruction.
        let of_instruction = rest.get(1).is_some_and(|&code| code >= 0x90);
        let (code, what) = match damage {
            Damage::Hole => (&codes::DAMAGED, "bytes that are not part of a program"),
            Damage::Cut => (
                &codes::TRUNCATED,
                "the end of the file before the end of the program",
            ),
            Damage::Rest => (
                &codes::DAMAGED,
                "the end of the readable data, without `END`",
            ),
        };
        if of_instruction && self.current == Current::Instr {
            let span = self.report(code, at, rest, what);
            self.add_operand(span, OperandKind::Unreadable(None));
        } else {
            if of_instruction {
                self.give_up_label();
            }
            self.next_instruction();
            self.report(code, at, rest, what);
        }
        self.unread();
        self.step = None;
    }

    /// Adds an error about bytes of the file, which it writes into the listing.
    fn report(&mut self, code: &'static codes::Code, at: usize, bytes: &[u8], what: &str) -> Span {
        let shown = hex(bytes);
        let span = self.listing.word(&format!("?? {shown}"));
        self.diagnostics
            .push(bytes_error(code, span, at, &shown, what));
        span
    }

    fn finish(mut self, name: &str) -> Read {
        self.close_unknown();
        for unproven in self.unproven.iter_mut().filter(|u| u.is_read()) {
            if let Some(instr) = self.program.instrs.get(unproven.at) {
                unproven.span = instr.span;
                unproven.operands.clone_from(&instr.operands);
            }
        }
        self.diagnostics.extend(learned::note(&self.unproven));
        self.diagnostics.extend(self.names.map(labels_error));
        self.program.source = self.listing.finish(name);
        Read {
            program: self.program,
            diagnostics: self.diagnostics,
            unproven: self.unproven,
            ..Read::default()
        }
    }
}

/// One error for all labels that operands name.
fn labels_error((span, names): (Span, Vec<String>)) -> Diagnostic {
    /// Maximum number of labels that a message names.
    const NAMED: usize = 8;
    let mut list: Vec<_> = names.iter().take(NAMED).map(|n| format!("`{n}`")).collect();
    if names.len() > NAMED {
        list.push(format!("and {} more", names.len() - NAMED));
    }
    codes::LABEL_OPERAND
        .at(
            span,
            format!("operands are labels, not devices: {}", list.join(", ")),
        )
        .label("only the compiled program says which device this is")
        .help("convert the program in the editor (Rebuild All) and save the project: rungc then reads its compiled program")
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
        .help("open the project in its editor and export the list as CSV, which rungc also reads")
}

/// Bytes as people read them.
pub(crate) fn hex(bytes: &[u8]) -> String {
    let mut text = String::new();
    for (at, byte) in bytes.iter().take(SHOWN).enumerate() {
        let _ = write!(text, "{}{byte:02X}", if at > 0 { " " } else { "" });
    }
    if bytes.len() > SHOWN {
        text.push_str(" …");
    }
    text
}
