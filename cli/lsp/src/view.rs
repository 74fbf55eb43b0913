//! An open text with its index, as the answers to requests see it.

use crate::document::Document;
use gen_lsp_types::{Location, Position, Range};
use rungc::index::{Index, Place};
use rungc_syntax::{Device, SourceKind, Span};

/// An open text.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    pub(crate) document: &'a Document,
    /// The program in it, if it is one that can be read.
    pub(crate) index: Option<&'a Index>,
}

impl<'a> View<'a> {
    /// The program, if places in it are bytes of the text.
    pub(crate) fn text_index(&self) -> Option<&'a Index> {
        let is_text = |index: &&Index| index.project().source().kind.is_text();
        self.index.filter(is_text)
    }

    /// The range of a place in the program.
    pub(crate) fn range(&self, span: Span) -> Range {
        match self.index {
            Some(index) => self.document.now.range_in(index.project().source(), span),
            None => self.document.now.range(span),
        }
    }

    pub(crate) fn location(&self, span: Span) -> Location {
        Location {
            uri: self.document.uri.clone(),
            range: self.range(span),
        }
    }

    /// What stands at a position. In a table, it is the word at the position.
    pub(crate) fn place(&self, position: Position) -> Option<(&'a Index, Place)> {
        let index = self.index?;
        let program = index.project().source();
        let offset = self.document.now.offset(position);
        if program.kind.is_text() {
            return Some((index, index.at(offset)?));
        }
        if program.kind != SourceKind::Csv {
            return None;
        }
        let is_at = |span: &Span| {
            let range = self.range(*span);
            (range.start..=range.end).contains(&position)
        };
        let begins_before = |span: Span| program.source.line(span.start) <= position.line + 1;
        let next = program
            .instrs
            .partition_point(|instr| begins_before(instr.span));
        let instr = program.instrs.get(next.checked_sub(1)?)?;
        let operands = instr.operands.iter().map(|operand| operand.span);
        let span = operands.chain([instr.mnemonic_span]).find(is_at)?;
        Some((index, index.at(span.start)?))
    }

    /// The device that stands at a position.
    pub(crate) fn device(&self, position: Position) -> Option<(&'a Index, Device)> {
        let (index, place) = self.place(position)?;
        Some((index, index.device(place.what)?))
    }

    /// The bytes of the content between two positions.
    pub(crate) fn span(&self, range: Range) -> Span {
        let [start, end] = [range.start, range.end].map(|at| self.document.now.offset(at));
        Span::new(start, end.max(start))
    }

    /// The line of a position, up to it.
    pub(crate) fn line_before(&self, position: Position) -> &'a str {
        let now = &self.document.now;
        let end = now.lines.offset(&now.text, position);
        let start = now.lines.range(&now.text, position.line).start;
        now.text.get(start..end).unwrap_or_default()
    }
}
