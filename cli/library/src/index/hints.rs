//! Kinds of words in a text, and comments of the devices in it.

use super::Index;
use rungc_catalogue::Shape;
use rungc_syntax::{DeviceClass, Instr, OperandKind, SourceKind, Span};

/// A word of the text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Token {
    /// Its bytes, on one line.
    pub span: Span,
    /// Its kind.
    pub kind: TokenKind,
}

/// Kinds of words.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum TokenKind {
    /// A mnemonic.
    Mnemonic,
    /// A label, or an operand that is one.
    Label,
    /// A device, or what holds one.
    Device(DeviceClass),
    /// A constant.
    Number,
    /// Characters.
    Text,
    /// A comment, or a property of the program.
    Comment,
}

impl Index {
    /// The words of the lines between two bytes, in the order of the text; none where the program is not a text.
    pub fn tokens(&self, span: Span) -> Vec<Token> {
        let program = self.program();
        let mut tokens = Vec::new();
        if !program.kind.is_text() {
            return tokens;
        }
        let is_drawn = program.kind == SourceKind::Ladder;
        for (i, instr) in self.instrs_in(span) {
            self.instr_tokens(i, instr, is_drawn, &mut tokens);
        }
        tokens.sort_by_key(|token| (token.span, token.kind != TokenKind::Label));
        self.comments(span, &mut tokens);
        tokens.sort_by_key(|token| token.span);
        // Symbols of a drawing stand for several instructions.
        let mut end = 0;
        tokens.retain(|token| {
            let is_free = token.span.start >= end && !token.span.range().is_empty();
            end = if is_free { token.span.end } else { end };
            is_free
        });
        tokens
    }

    fn instr_tokens(&self, i: usize, instr: &Instr, is_drawn: bool, tokens: &mut Vec<Token>) {
        let resolution = self.resolutions[i];
        let mnemonic = match resolution.label {
            Some(_) => TokenKind::Label,
            None => TokenKind::Mnemonic,
        };
        // The mnemonic of a contact that is drawn is its symbol.
        if !is_drawn || resolution.label.is_some() {
            tokens.push(Token {
                span: instr.mnemonic_span,
                kind: mnemonic,
            });
        }
        for (n, operand) in instr.operands.iter().enumerate() {
            let is_pointer = resolution
                .params
                .get(n)
                .is_some_and(|param| param.shape == Shape::Pointer);
            let kind = match operand.kind {
                OperandKind::Device(..) if is_pointer => TokenKind::Label,
                OperandKind::Device(device, _)
                | OperandKind::WordBit(device, ..)
                | OperandKind::Nibbles(_, device, _) => TokenKind::Device(device.class),
                OperandKind::Decimal(..) | OperandKind::Hex(..) | OperandKind::Float(_) => {
                    TokenKind::Number
                }
                OperandKind::Buffer { .. } => TokenKind::Device(DeviceClass::D),
                OperandKind::Text(_) => TokenKind::Text,
                OperandKind::Unreadable(_) => continue,
            };
            tokens.push(Token {
                span: operand.span,
                kind,
            });
        }
    }

    /// Adds the comments: what follows the last word of a line from a semicolon or two slashes on.
    fn comments(&self, span: Span, tokens: &mut Vec<Token>) {
        let source = &self.program().source;
        let words = std::mem::take(tokens);
        for (start, line) in source.lines() {
            let end = start + line.trim_end_matches(['\r', '\n']).len() as u32;
            if end < span.start || start > span.end {
                continue;
            }
            let next = words.partition_point(|token| token.span.start < end);
            let last = next.checked_sub(1).map_or(0, |last| words[last].span.end);
            let from = last.clamp(start, end);
            let rest = source.slice(Span::new(from, end));
            let begin = rest.find([';', '；']);
            let slashes = rest.find("//");
            let begin = begin.into_iter().chain(slashes).min();
            tokens.extend(begin.map(|begin| Token {
                span: Span::new(from + begin as u32, end),
                kind: TokenKind::Comment,
            }));
        }
        tokens.extend(words);
    }

    /// The comments of the devices that an instruction names, each once.
    pub fn comments_at(&self, i: usize) -> Vec<String> {
        let operands = self.program().instrs.get(i);
        let operands = operands.into_iter().flat_map(|instr| &instr.operands);
        let devices = operands.filter_map(|operand| super::named(&operand.kind));
        let label = self.resolutions.get(i).and_then(|one| one.label);
        let mut comments: Vec<_> = label
            .into_iter()
            .chain(devices)
            .filter_map(|device| self.comment(device))
            .collect();
        comments.dedup();
        comments
    }
}
