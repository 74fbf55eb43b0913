//! Reader of instruction lists as text.
//!
//! A list is read line by line with a [chumsky](https://docs.rs/chumsky) grammar. Each line is a start anew, and within
//! a line each operand is: one mistake never hides the next. Full-width text is read as half-width; places always refer
//! to the original.
//!
//! An instruction of which one operand cannot be read stays, with that operand marked as unreadable; where it is clear
//! which device it was meant to name (`X008`), it names that one. So the instructions around it are judged by what the
//! author meant.
//!
//! Comment lines above an instruction become its statement, a comment beside it its note. Lines that begin with `;!`
//! state properties of the program: `;! cpu = FX3U/FX3UC`, `;! title = Press`, `;! X000 = start button`.

mod fault;
pub(crate) mod field;
mod fold;
mod grammar;
mod jumps;
pub(crate) mod windows;

use crate::Read;
use crate::gx::cpu;
use crate::text::{Lines, clean};
use fault::{Faults, Wanted};
use fold::Folded;
use rungc_syntax::{
    Device, Diagnostics, Instr, Operands, Program, Remarks, Source, SourceKind, Span, codes,
};
use smol_str::{SmolStr, ToSmolStr};
use windows::Windows;

/// Reads an instruction list. `name` is the file's name for diagnostics.
pub fn read_text(name: &str, text: &str) -> Read {
    if let Some((program, diagnostic)) = crate::foreign::detect(name, text) {
        let mut diagnostics = Diagnostics::new();
        diagnostics.push(diagnostic);
        return Read {
            program,
            diagnostics,
            ..Read::default()
        };
    }
    let mut reader = Reader::default();
    let source = Source::new(name, text);
    reader.program.instrs.reserve(source.line_count() as usize);
    let grammar = grammar::line();
    let mut windows = Windows::of(&source);
    for (start, whole) in source.lines() {
        let line = whole.trim_end_matches(['\r', '\n']);
        if reader.window_line(&mut windows, line, start) {
            continue;
        }
        if let Some(folded) = jumps::fold(line) {
            reader.folded_line(line, &folded, start);
        } else if line.is_ascii() {
            let found = grammar::parse(&grammar, line, &mut reader.faults);
            reader.take(line, line, found, |span| {
                Span::new(span.start + start, span.end + start)
            });
        } else {
            reader.wide_line(line, start);
        }
    }
    reader.end_windows(&windows, text.len() as u32);
    reader.one_line(&source);
    reader.program.closing = reader.statement.take();
    reader.program.source = source;
    reader.program.kind = SourceKind::Il;
    Read {
        program: reader.program,
        diagnostics: reader.diagnostics,
        ..Read::default()
    }
}

#[derive(Default)]
pub(crate) struct Reader {
    pub(crate) program: Program,
    pub(crate) diagnostics: Diagnostics,
    folded: Folded,
    /// Errors in the current line.
    faults: Faults,
    /// Comment lines that wait for the instruction below them.
    pub(crate) statement: Lines,
}

impl Reader {
    /// Reads a full-width line, which begins at `start`.
    pub(crate) fn wide_line(&mut self, line: &str, start: u32) {
        let mut folded = std::mem::take(&mut self.folded);
        folded.fold_line(line, &mut self.faults);
        self.folded_line(line, &folded, start);
        self.folded = folded;
    }

    /// Reports a program that is one line, its instructions separated by what starts a comment.
    fn one_line(&mut self, source: &Source) {
        let mut lines = source.lines().filter(|(_, line)| !line.trim().is_empty());
        let (Some((start, line)), None) = (lines.next(), lines.next()) else {
            return;
        };
        let [instr] = &self.program.instrs[..] else {
            return;
        };
        let end = (instr.span.end - start) as usize;
        let rest = line.get(end..).unwrap_or_default().trim();
        let parts = rest.split([';', '/']).map(str::trim);
        let mut parts = parts.filter(|part| !part.is_empty()).peekable();
        let is_instr = |part: &str| part.split_whitespace().next().is_some_and(is_basic);
        if rest.starts_with([';', '/']) && parts.peek().is_some() && parts.all(is_instr) {
            let from = instr.span.end + (line[end..].len() - line[end..].trim_start().len()) as u32;
            let to = from + rest.len() as u32;
            self.diagnostics.push(
                codes::ONE_PER_LINE
                    .at(Span::new(from, to), "the rest of the program is a comment")
                    .label("`;` and `//` start a comment")
                    .help("write each instruction on its own line"),
            );
            self.program.unread.push(1);
        }
    }

    /// Reads a line in another form, which begins at `start`.
    fn folded_line(&mut self, line: &str, folded: &Folded, start: u32) {
        let found = grammar::parse(&grammar::line(), &folded.text, &mut self.faults);
        self.take(line, &folded.text, found, |span| {
            let (first, last) = folded.original(span.start, span.end);
            Span::new(first + start, last + start)
        });
    }

    /// Takes what the grammar found on a line; `place` leads from the folded line to the source.
    fn take(
        &mut self,
        original: &str,
        folded: &str,
        line: Option<grammar::Line>,
        place: impl Fn(Span) -> Span,
    ) {
        let before = self.program.instrs.len();
        let faulty = !self.faults.is_empty();
        let instr = line.as_ref().and_then(|line| line.instr.as_ref());
        for fault in self.faults.drain() {
            let wanted = instr.and_then(|instr| Wanted::at(instr, fault.span));
            let diagnostic = fault.diagnostic(folded, &place, wanted);
            self.diagnostics.push(diagnostic);
        }
        if let Some(line) = line {
            self.content(line, original, &place);
        }
        if faulty && self.program.instrs.len() == before {
            self.program.unread.push(before as u32);
        }
    }

    /// Takes what a line holds.
    fn content(&mut self, line: grammar::Line, original: &str, place: &impl Fn(Span) -> Span) {
        let begin = place(Span::default()).start;
        let comment = line.comment.and_then(|at| {
            let at = place(Span::new(at, at)).start - begin;
            original.get(at as usize..)
        });
        let mut step = line.step;
        let alone = line.label.is_none() && line.instr.is_none();
        if let Some((device, span)) = line.label {
            let span = place(span);
            self.push(device.to_smolstr(), span, Operands::new(), step.take());
        }
        let note = comment.and_then(clean);
        if let Some(body) = line.instr {
            let mut operands = body.operands;
            for operand in &mut operands {
                operand.span = place(operand.span);
                let written = operand.span.start - begin..operand.span.end - begin;
                field::keep_text(
                    operand,
                    &original[written.start as usize..written.end as usize],
                );
            }
            self.push(
                body.mnemonic.into(),
                place(body.mnemonic_span),
                operands,
                step,
            );
        }
        if !alone {
            if let (Some(last), Some(_)) = (self.program.instrs.last_mut(), &note) {
                last.remarks_mut().note = note;
            }
        } else if let Some(text) = note {
            let property = comment.and_then(|c| c.strip_prefix('!'));
            let end = begin + original.len() as u32;
            if !property.is_some_and(|property| self.property(property, end)) {
                self.statement.push(&text);
            }
        }
    }

    fn push(
        &mut self,
        mnemonic: SmolStr,
        mnemonic_span: Span,
        operands: Operands,
        step: Option<u32>,
    ) {
        let span = operands
            .last()
            .map_or(mnemonic_span, |last| mnemonic_span.to(last.span));
        self.program.instrs.push(Instr {
            mnemonic,
            mnemonic_span,
            operands,
            span,
            step,
            remarks: Remarks::new(self.statement.take(), None),
        });
    }

    /// Takes a property of the program, whose text ends at `end`; returns whether it is one.
    fn property(&mut self, text: &str, end: u32) -> bool {
        let Some((key, written)) = text.split_once('=') else {
            return false;
        };
        let (key, value) = (key.trim(), clean(written).map(String::from));
        if key.eq_ignore_ascii_case("cpu") {
            let start = end - written.trim_start().len() as u32;
            let span = Span::new(start, start + written.trim().len() as u32);
            if let Some(cpu) = value.as_deref().filter(|cpu| cpu::is_other_family(cpu)) {
                self.diagnostics.push(cpu::rejection(span, "list", cpu));
            } else {
                self.program.cpu_span = span;
                self.program.cpu = value;
            }
        } else if key.eq_ignore_ascii_case("title") {
            self.program.title = value;
        } else if let (Some((device, faults)), Some(value)) = (named(key), value) {
            let start = end - text.trim_start().len() as u32;
            if faults.is_empty() {
                let span = Span::new(start, start + key.len() as u32);
                self.program.comments.insert(device, value);
                self.program.comment_spans.insert(device, span);
            }
            for fault in faults.into_iter() {
                let place = |span: Span| Span::new(start + span.start, start + span.end);
                self.diagnostics.push(fault.diagnostic(key, place, None));
            }
        } else {
            return false;
        }
        true
    }
}

/// The number that a text is, in half-width or full-width digits.
pub(crate) fn number(text: &str) -> Option<u32> {
    match text.is_ascii() {
        true => text.parse().ok(),
        false => Folded::of(text).text.parse().ok(),
    }
}

/// The device that a text names by itself, e.g. `X010`.
pub(crate) fn device(text: &str) -> Option<Device> {
    let (device, faults) = named(text)?;
    faults.is_empty().then_some(device)
}

/// The device that a text names by itself, and what is wrong with its number: the device is a stand-in then.
fn named(text: &str) -> Option<(Device, Vec<fault::Fault>)> {
    let mut faults = Faults::default();
    let folded = Folded::of(text).text;
    let device = grammar::parse(&grammar::device_field(), &folded, &mut faults)?;
    Some((device, faults.drain().collect()))
}

/// Instructions that every program has some of.
const BASIC: [&str; 24] = [
    "LD", "LDI", "LDP", "LDF", "AND", "ANI", "ANDP", "ANDF", "OR", "ORI", "ORP", "ORF", "ANB",
    "ORB", "MPS", "OUT", "SET", "RST", "STL", "RET", "MOV", "NOP", "FEND", "END",
];

/// Returns true for one of the instructions that every program has some of.
pub(crate) fn is_basic(word: &str) -> bool {
    BASIC.iter().any(|basic| basic.eq_ignore_ascii_case(word))
}

/// Returns true if a mnemonic is a label: a pointer P or I.
pub(crate) fn is_label(mnemonic: &str) -> bool {
    let digits = mnemonic.strip_prefix(['P', 'I']).unwrap_or("");
    !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit())
}
