//! Writers: the same program as an instruction list or as the editors' list export. What they write reads back to the
//! same program, save for the source text and places.

use crate::csv::{ExportHead, HEADERS, INFORMATION, NoteRow, StatementRow, encode};
use crate::il::{device, field, is_label, windows::is_heading};
use crate::text::clean;
use rungc_syntax::{Device, Diagnostics, Instr, Operand, OperandKind, Program, Source, SourceKind};
use std::fmt::Write as _;
use unicode_width::UnicodeWidthStr as _;

mod autoshop;
pub use autoshop::to_autoshop;

/// Characters that an instruction takes before the comment beside it.
const COMMENT_COLUMN: usize = 24;

/// The program as an instruction list: title, CPU and device comments as `;!` lines, then one instruction a line.
pub fn to_il(program: &Program) -> String {
    let mut out = properties(program);
    let steps = program.instrs.iter().filter_map(|instr| instr.step).max();
    let width = steps.map_or(0, |last| last.to_string().len());
    for instr in &program.instrs {
        il_line(&mut out, instr, width);
    }
    out + &closing(program)
}

/// The comment lines below the last instruction, as lines of a list.
pub fn closing(program: &Program) -> String {
    let mut out = String::new();
    comment_lines(&mut out, program.closing.as_deref());
    out
}

/// Title, CPU type and device comments of a program as `;!` lines.
pub fn properties(program: &Program) -> String {
    properties_without(program, |_| None)
}

/// As [`properties`], without the comments that are names of devices.
fn properties_without<'n>(
    program: &Program,
    name: impl Fn(&Device) -> Option<&'n String>,
) -> String {
    let mut out = String::new();
    let mut property = |key: &dyn std::fmt::Display, value: &str| {
        let _ = writeln!(out, ";! {key} = {value}");
    };
    if let Some(title) = &program.title {
        property(&"title", title);
    }
    if let Some(cpu) = &program.cpu {
        property(&"cpu", cpu);
    }
    for (device, comment) in &program.comments {
        if name(device) != Some(comment) {
            property(device, comment);
        }
    }
    out
}

fn il_line(out: &mut String, instr: &Instr, width: usize) {
    statements(out, instr);
    il_step(out, instr, width);
    let comment = instr.note().map(|note| format!("; {note}"));
    il_words(out, instr, comment.as_deref());
    out.push('\n');
}

/// The statements above an instruction.
fn statements(out: &mut String, instr: &Instr) {
    comment_lines(out, instr.statement());
}

fn comment_lines(out: &mut String, text: Option<&str>) {
    for line in text.into_iter().flat_map(str::lines) {
        let _ = writeln!(out, "; {line}");
    }
}

/// The step number before an instruction, in a list that numbers steps.
fn il_step(out: &mut String, instr: &Instr, width: usize) {
    match instr.step {
        Some(step) => _ = write!(out, "{step:>width$} "),
        None if width > 0 => _ = write!(out, "{:width$} ", ""),
        None => {}
    }
}

/// An instruction, and the comment beside it in its column.
fn il_words(out: &mut String, instr: &Instr, comment: Option<&str>) {
    let operands = instr.operands.iter().map(|operand| spelled(&operand.kind));
    let operands: Vec<_> = operands.collect();
    let mut words = vec![instr.mnemonic.as_str()];
    words.extend(operands.iter().map(String::as_str));
    il_written(out, &words, comment);
}

/// Text of the source in place of a pointer, as AutoShop writes it: a label `L1`, a jump to it, a call by name.
fn autoshop_words(instr: &Instr, source: &Source) -> Option<String> {
    let other = |span, pointer: Device| {
        let written = source.slice(span);
        (device(written) != Some(pointer)).then_some(written)
    };
    if is_label(&instr.mnemonic) {
        return other(instr.span, device(&instr.mnemonic)?).map(str::to_uppercase);
    }
    let [operand] = instr.operands.as_slice() else {
        return None;
    };
    let pointer = operand.kind.device()?;
    match instr.mnemonic.as_str() {
        "CJ" | "CJP" => Some(format!(
            "{} {}",
            instr.mnemonic,
            other(operand.span, pointer)?.to_uppercase()
        )),
        "CALL" | "CALLP" => Some(format!(
            "{} {}",
            instr.mnemonic,
            other(operand.span, pointer)?
        )),
        _ => None,
    }
}

/// These words, and the comment beside them in its column.
fn il_written(out: &mut String, words: &[&str], comment: Option<&str>) {
    let start = out.len();
    for (i, word) in words.iter().enumerate() {
        out.push_str(if i > 0 { " " } else { "" });
        out.push_str(word);
    }
    if let Some(comment) = comment {
        let pad = COMMENT_COLUMN.saturating_sub(out[start..].width());
        let _ = write!(out, "{:pad$} {comment}", "");
    }
}

/// An instruction list as [`to_il`] lays out its lines, and the lines that differ from the source.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct LaidOut {
    /// The whole text, with the line end of its first line throughout.
    pub text: String,
    /// The lines that differ.
    pub changes: Vec<Change>,
}

/// A line of a list that is laid out differently.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Change {
    /// Its number, from 1.
    pub line: usize,
    /// Text in the source.
    pub before: String,
    /// Formatted text: two lines where a label and an instruction share one, none for an empty line to be removed.
    pub after: String,
}

/// Lays out the source of a list that was read without errors: one instruction on a line, mnemonics and devices as the
/// editors write them, comments beside instructions in one column, one empty line where there are several. Comments
/// and the order of lines stay.
pub fn lay_out(program: &Program) -> LaidOut {
    let source = &program.source;
    let first = source.lines().next();
    let end = match first.is_some_and(|(_, line)| line.ends_with("\r\n")) {
        true => "\r\n",
        false => "\n",
    };
    let steps = program.instrs.iter().filter_map(|instr| instr.step).max();
    let width = steps.map_or(0, |last| last.to_string().len());
    let mut laid_out = LaidOut {
        text: String::with_capacity(source.text.len()),
        changes: Vec::new(),
    };
    let mut instrs = program.instrs.as_slice();
    // Empty lines that wait for a line after them.
    let mut empty = Vec::new();
    for (number, (start, whole)) in (1..).zip(source.lines()) {
        let before = whole.trim_end_matches(['\r', '\n']);
        let here = instrs.partition_point(|instr| instr.span.start < start + whole.len() as u32);
        let (of_line, others) = instrs.split_at(here);
        instrs = others;
        // Instructions that AutoShop omits between windows are not in the text.
        let implied = of_line.partition_point(|instr| instr.span.range().is_empty());
        let after = line(&of_line[implied..], start, before, width, source);
        if after.is_empty() {
            empty.push((number, before));
            continue;
        }
        let kept = usize::from(!laid_out.text.is_empty()).min(empty.len());
        for (i, (number, before)) in empty.drain(..).enumerate() {
            laid_out.text.push_str(if i < kept { end } else { "" });
            laid_out.note(number, before, "", i < kept);
        }
        for line in after.lines() {
            laid_out.text.push_str(line);
            laid_out.text.push_str(end);
        }
        laid_out.note(number, before, &after, whole.ends_with(end));
    }
    for (number, before) in empty {
        laid_out.note(number, before, "", false);
    }
    laid_out
}

impl LaidOut {
    /// Takes a line; `ended` if it is there afterwards and ended before as it ends now.
    fn note(&mut self, line: usize, before: &str, after: &str, ended: bool) {
        if before != after || !ended {
            self.changes.push(Change {
                line,
                before: before.to_owned(),
                after: after.to_owned(),
            });
        }
    }
}

/// One line of the source, which begins at `start` and holds these instructions.
fn line(instrs: &[Instr], start: u32, whole: &str, width: usize, source: &Source) -> String {
    let Some((last, labels)) = instrs.split_last() else {
        return whole.trim().to_owned();
    };
    if is_heading(whole) {
        return whole.trim().to_owned();
    }
    let rest = &whole[(last.span.end - start) as usize..];
    // A colon may follow a label.
    let separates = |c: char| c.is_whitespace() || matches!(c, ',' | '，' | ':' | '：' | '\0');
    let comment = rest.trim_start_matches(separates).trim_end();
    let mut out = String::new();
    for label in labels {
        il_step(&mut out, label, width);
        match autoshop_words(label, source) {
            Some(words) => il_written(&mut out, &[&words], None),
            None => il_words(&mut out, label, None),
        }
        out.push('\n');
    }
    il_step(&mut out, last, width);
    let comment = Some(comment).filter(|comment| !comment.is_empty());
    match autoshop_words(last, source) {
        Some(words) => il_written(&mut out, &[&words], comment),
        None => il_words(&mut out, last, comment),
    }
    out
}

/// An operand as a reader takes it: a quote within a text is written twice.
fn spelled(kind: &OperandKind) -> String {
    match kind {
        OperandKind::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        other => other.to_string(),
    }
}

/// The first text operand that holds a line break, which a list has no way to write; an export has.
pub fn broken_text(program: &Program) -> Option<&Operand> {
    let mut operands = program.instrs.iter().flat_map(|instr| &instr.operands);
    operands.find(|operand| match &operand.kind {
        OperandKind::Text(text) => text.contains(['\n', '\r']),
        _ => false,
    })
}

/// The program as a list export, as the editors write it: UTF-16LE with BOM, tabs, every field quoted, English headers.
/// Device comments go to a separate file: [`comments_to_csv`].
pub fn to_csv(program: &Program) -> Vec<u8> {
    let head = vec![
        vec![program.title.clone().unwrap_or_default()],
        vec![
            INFORMATION.to_owned(),
            program
                .cpu
                .as_ref()
                .map(|cpu| format!("FXCPU {cpu}"))
                .unwrap_or_default(),
        ],
        HEADERS.map(str::to_owned).to_vec(),
    ];
    let head = ExportHead {
        rows: head,
        ..ExportHead::default()
    };
    to_csv_with(program, &head)
}

/// As [`to_csv`], with the head of the export that the program was read from: an export comes out as the editor wrote
/// it.
pub fn to_csv_with(program: &Program, head: &ExportHead) -> Vec<u8> {
    let mut rows = head.rows.clone();
    let mut statements = head.statements.as_slice();
    let mut notes = head.notes.as_slice();
    for (number, instr) in program.instrs.iter().enumerate() {
        let own = statements.partition_point(|row| row.instr <= number);
        let (above, below) = statements.split_at(own);
        statements = below;
        let column = if is_label(&instr.mnemonic) { 5 } else { 1 };
        statement_rows(&mut rows, instr.statement(), above, column);
        let own = notes.partition_point(|note| note.instr <= number);
        let (beside, below) = notes.split_at(own);
        notes = below;
        csv_rows(&mut rows, instr, program, beside);
    }
    statement_rows(&mut rows, program.closing.as_deref(), statements, 1);
    encode(&rows)
}

/// The rows of a statement, as they were read unless the statement has changed.
fn statement_rows(
    rows: &mut Vec<Vec<String>>,
    statement: Option<&str>,
    read: &[StatementRow],
    column: usize,
) {
    let lines = || statement.into_iter().flat_map(str::lines);
    let as_read = read.iter().map(|row| clean(&row.text).unwrap_or_default());
    if as_read.eq(lines()) {
        rows.extend(read.iter().map(statement_row));
    } else {
        rows.extend(lines().map(|line| row(&[(column, line.to_owned())])));
    }
}

/// A row with these cells.
fn row(cells: &[(usize, String)]) -> Vec<String> {
    let mut row = vec![String::new(); HEADERS.len()];
    for (column, text) in cells {
        row[*column].clone_from(text);
    }
    row
}

/// The rows of one instruction: itself with its first operand, its further operands. Notes stand in the rows that they
/// were read from, unless they have changed.
fn csv_rows(rows: &mut Vec<Vec<String>>, instr: &Instr, source: &Program, read: &[NoteRow]) {
    let operands = instr.operands.iter().enumerate();
    let mut operands = operands.map(|(nth, operand)| match nth {
        0 if instr.mnemonic == "ASC" => characters(operand, source),
        _ => spelled(&operand.kind),
    });
    let start = rows.len();
    let step = instr.step.map(|step| step.to_string());
    rows.push(row(&[
        (0, step.unwrap_or_default()),
        (2, instr.mnemonic.to_string()),
        (3, operands.next().unwrap_or_default()),
    ]));
    rows.extend(operands.map(|operand| row(&[(3, operand)])));
    let note = instr.note().unwrap_or_default();
    let as_read: Vec<_> = read.iter().filter_map(|note| clean(&note.text)).collect();
    if as_read.join(" ") != note {
        rows[start][6] = note.to_owned();
        return;
    }
    for note in read {
        let at = start + note.row;
        let filled = rows.len().max(at + 1);
        rows.resize_with(filled, || row(&[]));
        rows[at][6].clone_from(&note.text);
    }
}

/// The characters of ASC as the editors write them: bare, unless they would be read otherwise.
fn characters(operand: &Operand, program: &Program) -> String {
    let is_quoted = program.source.slice(operand.span).starts_with('"');
    let OperandKind::Text(text) = &operand.kind else {
        return spelled(&operand.kind);
    };
    let read = field::operand(text, 0, true, &mut Diagnostics::new());
    let reads_back = !text.trim().is_empty() && read.is_some_and(|read| read.kind == operand.kind);
    match reads_back && !(is_quoted && program.kind == SourceKind::Csv) {
        true => text.to_string(),
        false => spelled(&operand.kind),
    }
}

/// The row of a statement as it was read.
fn statement_row(statement: &StatementRow) -> Vec<String> {
    let mut row = vec![String::new(); HEADERS.len()];
    row[0].clone_from(&statement.step);
    row[statement.column].clone_from(&statement.text);
    row
}

/// The program's device comments as the editors export them beside the list (`COMMENT.csv`).
pub fn comments_to_csv(program: &Program) -> Vec<u8> {
    let head = ["Device Name", "Comment"].map(str::to_owned).to_vec();
    let rows = program
        .comments
        .iter()
        .map(|(device, comment)| vec![device.to_string(), comment.clone()]);
    encode(&std::iter::once(head).chain(rows).collect::<Vec<_>>())
}
