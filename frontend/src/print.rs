//! Writers: the same program as an instruction list or as the editors' list export. What they write reads back to the
//! same program, save for the source text and places.

use crate::csv::{HEADERS, encode};
use crate::il::is_label;
use rungc_syntax::{Instr, Operand, OperandKind, Program};
use std::fmt::Write as _;

/// The program as an instruction list: title, CPU and device comments as `;!` lines, then one instruction a line.
pub fn to_il(program: &Program) -> String {
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
        property(device, comment);
    }
    let steps = program.instrs.iter().filter_map(|instr| instr.step).max();
    let width = steps.map_or(0, |last| last.to_string().len());
    for instr in &program.instrs {
        il_line(&mut out, instr, width);
    }
    out
}

fn il_line(out: &mut String, instr: &Instr, width: usize) {
    for line in instr.statement().into_iter().flat_map(str::lines) {
        let _ = writeln!(out, "; {line}");
    }
    match instr.step {
        Some(step) => _ = write!(out, "{step:>width$} "),
        None if width > 0 => _ = write!(out, "{:width$} ", ""),
        None => {}
    }
    let start = out.len();
    out.push_str(&instr.mnemonic);
    for operand in &instr.operands {
        let _ = write!(out, " {}", spelled(&operand.kind));
    }
    if let Some(note) = instr.note() {
        let pad = 24_usize.saturating_sub(out.len() - start);
        let _ = write!(out, "{:pad$} ; {note}", "");
    }
    out.push('\n');
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
    let mut rows: Vec<Vec<String>> = vec![
        vec![program.title.clone().unwrap_or_default()],
        vec![
            "PLC Information:".to_owned(),
            program
                .cpu
                .as_ref()
                .map(|cpu| format!("FXCPU {cpu}"))
                .unwrap_or_default(),
        ],
        HEADERS.map(str::to_owned).to_vec(),
    ];
    for instr in &program.instrs {
        csv_rows(&mut rows, instr);
    }
    encode(&rows)
}

/// The rows of one instruction: its statements, itself with its first operand, its further operands.
fn csv_rows(rows: &mut Vec<Vec<String>>, instr: &Instr) {
    let row = |columns: &[(usize, String)]| {
        let mut row = vec![String::new(); HEADERS.len()];
        for (column, text) in columns {
            row[*column].clone_from(text);
        }
        row
    };
    for line in instr.statement().into_iter().flat_map(str::lines) {
        let pointer = is_label(&instr.mnemonic);
        rows.push(row(&[(if pointer { 5 } else { 1 }, line.to_owned())]));
    }
    let mut operands = instr.operands.iter().map(|operand| spelled(&operand.kind));
    rows.push(row(&[
        (
            0,
            instr.step.map(|step| step.to_string()).unwrap_or_default(),
        ),
        (2, instr.mnemonic.to_string()),
        (3, operands.next().unwrap_or_default()),
        (6, instr.note().unwrap_or_default().to_owned()),
    ]));
    rows.extend(operands.map(|operand| row(&[(3, operand)])));
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
