//! Reader of instruction lists as text.
//!
//! A list is read line by line with a [chumsky](https://docs.rs/chumsky) grammar. Each line is a start anew, and within a line
//! each operand is: one mistake never hides the next. Full-width text is read as half-width; places always refer to the original.

mod fault;
mod fold;
mod grammar;

use crate::Read;
use chumsky::Parser;
use fold::Folded;
use rungc_syntax::{Device, Diagnostics, Instr, Program, Source, SourceKind, Span};
use smol_str::{SmolStr, ToSmolStr};

/// Reads an instruction list. `name` is the file's name for diagnostics.
pub fn read_text(name: &str, text: &str) -> Read {
    let mut reader = Reader::default();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        reader.line(line.trim_end_matches(['\r', '\n']), start);
        start += line.len() as u32;
    }
    reader.program.source = Source::new(name, text);
    reader.program.kind = SourceKind::Il;
    Read {
        program: reader.program,
        diagnostics: reader.diagnostics,
    }
}

#[derive(Default)]
struct Reader {
    program: Program,
    diagnostics: Diagnostics,
    folded: Folded,
    /// Comment lines that wait for the instruction below them.
    statement: Vec<SmolStr>,
}

impl Reader {
    fn line(&mut self, line: &str, start: u32) {
        if line.is_ascii() {
            self.parse(line, line, |span| {
                Span::new(span.start + start, span.end + start)
            });
            return;
        }
        let mut folded = std::mem::take(&mut self.folded);
        folded.fold(line);
        self.parse(line, &folded.text, |span| {
            let (first, last) = folded.original(span.start, span.end);
            Span::new(first + start, last + start)
        });
        self.folded = folded;
    }

    /// Reads one line; `place` leads from the folded line to the source.
    fn parse(&mut self, original: &str, folded: &str, place: impl Fn(Span) -> Span) {
        let (line, faults) = grammar::line().parse(folded).into_output_errors();
        for fault in faults {
            let range = fault.span.start..fault.span.end;
            let span = place(Span::new(range.start as u32, range.end as u32));
            let text = folded.get(range).unwrap_or("");
            self.diagnostics.push(fault.kind.diagnostic(span, text));
        }
        let Some(line) = line else { return };
        let begin = place(Span::default()).start;
        let comment = line.comment.and_then(|at| {
            let at = place(Span::new(at, at)).start - begin;
            let text = original.get(at as usize..)?.trim();
            (!text.is_empty()).then(|| SmolStr::new(text))
        });
        let mut step = line.step;
        let before = self.program.instrs.len();
        if let Some((device, span)) = line.label {
            self.label(device, place(span), step.take());
        }
        if let Some(body) = line.instr {
            self.instr(body, step, &place);
        }
        match (self.program.instrs.len() > before, comment) {
            (true, note) => {
                if let Some(last) = self.program.instrs.last_mut() {
                    last.note = note;
                }
            }
            (false, Some(text)) => self.statement.push(text),
            (false, None) => {}
        }
    }

    fn label(&mut self, device: Device, span: Span, step: Option<u32>) {
        let statement = self.take_statement();
        self.program.instrs.push(Instr {
            mnemonic: device.to_smolstr(),
            mnemonic_span: span,
            operands: Vec::new(),
            span,
            step,
            statement,
            note: None,
        });
    }

    fn instr(&mut self, body: grammar::Body, step: Option<u32>, place: impl Fn(Span) -> Span) {
        let Some(mut operands) = body.operands else {
            return;
        };
        let mnemonic_span = place(body.mnemonic_span);
        for operand in &mut operands {
            operand.span = place(operand.span);
        }
        let span = operands
            .last()
            .map_or(mnemonic_span, |last| mnemonic_span.to(last.span));
        let statement = self.take_statement();
        self.program.instrs.push(Instr {
            mnemonic: body.mnemonic,
            mnemonic_span,
            operands,
            span,
            step,
            statement,
            note: None,
        });
    }

    fn take_statement(&mut self) -> Option<SmolStr> {
        match self.statement.len() {
            0 => None,
            1 => self.statement.pop(),
            _ => Some(std::mem::take(&mut self.statement).join("\n").into()),
        }
    }
}
