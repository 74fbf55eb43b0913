//! Reader of ladder drawn in characters, as `rungc view` draws it and as people write it in forums and documents:
//!
//! ```text
//! |--[ X000 ]--+--[/ X001 ]--( M0 )--|
//! |--[ M0 ]----+                     |
//! ```
//!
//! [`grid`] finds wires and symbols, [`circuit`] what they connect, and this module turns that into instructions. The
//! rails may be left out: `--[ X000 ]--( M0 )--`. Lines without a rail or wire at their start are lines of an
//! instruction list: comments, properties, labels, and networks that have no picture.

mod circuit;
mod grid;
mod master;
mod nets;

use crate::Read;
use crate::il::{Reader, field, is_label};
use circuit::Step;
use grid::{Block, Kind, Symbol};
use master::Master;
use rungc_syntax::{Instr, Operands, Remarks, Source, SourceKind, Span, codes};
use smol_str::SmolStr;

/// Number of lines examined to detect the format of a text.
const HEAD: usize = 500;

/// Returns true if a text is drawn ladder: one of its first lines, comments apart, begins with a rail or with a wire to
/// a symbol, after a number and a label perhaps.
pub(crate) fn detect(text: &str) -> bool {
    let lines = text
        .lines()
        .filter(|line| !line.trim_start().starts_with(';'));
    lines.take(HEAD).any(grid::is_drawn)
}

/// Reads drawn ladder. `name` is the file's name for diagnostics.
pub(crate) fn read(name: &str, text: &str) -> Read {
    let source = Source::new(name, text);
    let mut reader = Drawing::default();
    let mut lines = source.lines().peekable();
    while let Some((start, whole)) = lines.next() {
        let line = whole.trim_end_matches(['\r', '\n']);
        if let Some(bar) = master::find(line) {
            reader.master(bar, start);
            continue;
        }
        let below = lines.peek().is_some_and(|(_, below)| grid::is_drawn(below));
        if grid::is_drawn(line) || below && grid::is_names(line) {
            reader.block.push(line, start);
            continue;
        }
        reader.finish_block();
        reader.list.wide_line(line, start);
    }
    drop(lines);
    reader.finish_block();
    let mut program = reader.list.program;
    program.closing = reader.list.statement.take();
    program.source = source;
    program.kind = SourceKind::Ladder;
    Read {
        program,
        diagnostics: reader.list.diagnostics,
        ..Read::default()
    }
}

#[derive(Default)]
struct Drawing {
    /// Takes the lines between drawings, and has the program.
    list: Reader,
    /// Drawn lines that follow each other.
    block: Block,
    /// Index of the first instruction of the previous block.
    began: usize,
}

impl Drawing {
    fn finish_block(&mut self) {
        if self.block.is_empty() {
            return;
        }
        self.began = self.list.program.instrs.len();
        let block = std::mem::take(&mut self.block);
        let drawn = block.read();
        let mut faults = Vec::new();
        let steps = circuit::steps(&drawn, &mut faults);
        let faulty = !faults.is_empty();
        for (span, kind, message) in faults {
            self.list.diagnostics.push(kind.at(span, message));
        }
        for step in steps {
            match step {
                Step::Plain(mnemonic, span) => {
                    self.push(mnemonic.into(), span, Operands::new(), span)
                }
                Step::Contact(entry, symbol) => self.contact(entry, &drawn.symbols[symbol]),
                Step::Symbol(symbol) => self.boxed(&drawn.symbols[symbol]),
                Step::Label(label) => {
                    let (text, span) = &drawn.labels[label];
                    self.push(text.clone(), *span, Operands::new(), *span);
                }
            }
        }
        if faulty {
            let before = self.list.program.instrs.len() as u32;
            self.list.program.unread.push(before);
        }
    }

    /// The contact of a master control in the rail: the network above it has the MC.
    fn master(&mut self, bar: Master, start: u32) {
        self.finish_block();
        let mut above = self.list.program.instrs[self.began..].iter();
        let is_there = above.any(|instr| {
            let operands: Vec<String> = instr
                .operands
                .iter()
                .map(|operand| operand.kind.to_string())
                .collect();
            instr.mnemonic == "MC" && operands == [bar.nesting.as_str(), &bar.device]
        });
        if !is_there {
            let span = Span::new(start + bar.at as u32, start + bar.end as u32);
            let message = format!("no `MC {} {}` above this", bar.nesting, bar.device);
            let fault = codes::LADDER_SYMBOL.at(span, message);
            let label = "the network above switches no such part of the rail";
            self.list.diagnostics.push(fault.label(label));
            let before = self.list.program.instrs.len() as u32;
            self.list.program.unread.push(before);
        }
    }

    fn push(&mut self, mnemonic: SmolStr, mnemonic_span: Span, operands: Operands, span: Span) {
        self.list.program.instrs.push(Instr {
            mnemonic,
            mnemonic_span,
            operands,
            span,
            step: None,
            remarks: Remarks::new(self.list.statement.take(), None),
        });
    }

    /// A contact or comparison, which the wires make LD, AND or OR.
    fn contact(&mut self, entry: &'static str, symbol: &Symbol) {
        let mnemonic = match &symbol.kind {
            Kind::Open => entry.to_string(),
            Kind::Closed => format!(
                "{}I",
                entry
                    .strip_suffix('D')
                    .filter(|_| entry == "AND")
                    .map_or(entry, |_| "AN")
            ),
            Kind::Rising => format!("{entry}P"),
            Kind::Falling => format!("{entry}F"),
            Kind::Compare(operator) => format!("{entry}{operator}"),
            Kind::Result(name) => (*name).to_string(),
            Kind::Output | Kind::Coil => return self.boxed(symbol),
        };
        let operands = self.operands(&mnemonic, symbol);
        self.push(mnemonic.into(), symbol.span, operands, symbol.span);
    }

    /// Operands written in a symbol after its mnemonic.
    fn operands(&mut self, mnemonic: &str, symbol: &Symbol) -> Operands {
        let mut operands = Operands::new();
        for (text, start) in &symbol.words {
            let characters = mnemonic == "ASC" && operands.is_empty();
            let read = field::operand(text, *start, characters, &mut self.list.diagnostics);
            operands.extend(read);
        }
        operands
    }

    /// A coil, or a box with an instruction in it.
    fn boxed(&mut self, symbol: &Symbol) {
        let mut symbol = symbol.clone();
        let (mnemonic, span) = match &symbol.kind {
            Kind::Coil => (Some("OUT".into()), symbol.span),
            Kind::Result(name) => (Some((*name).into()), symbol.span),
            _ => {
                let (text, start) = symbol.words.remove(0);
                let span = Span::new(start, start + text.len() as u32);
                (
                    field::mnemonic(&text, start, &mut self.list.diagnostics),
                    span,
                )
            }
        };
        let Some(mnemonic) = mnemonic else {
            let before = self.list.program.instrs.len() as u32;
            self.list.program.unread.push(before);
            return;
        };
        let operands = self.operands(&mnemonic, &symbol);
        if is_label(&mnemonic) && !operands.is_empty() {
            let fault = codes::LADDER_SYMBOL.at(symbol.span, format!("`{mnemonic}` is a label"));
            self.list
                .diagnostics
                .push(fault.label("a label is to the left of the rail"));
        }
        self.push(mnemonic, span, operands, symbol.span);
        if let (Some(note), Some(last)) = (symbol.note, self.list.program.instrs.last_mut()) {
            last.remarks_mut().note = Some(note);
        }
    }
}
