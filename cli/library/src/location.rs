//! Locations of findings as their reader knows them: lines and columns of a text, steps of a project or an export.

use rungc_syntax::{Program, Span};
use serde::Serialize;
use std::path::Path;

/// Location of a finding.
#[derive(Clone, PartialEq, Eq, Debug, Default, Serialize)]
pub struct Location {
    /// Bytes of the text, or of the listing that stands for another source.
    #[serde(skip)]
    pub span: Span,
    /// The file, where the program is made of several.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// First line, 1-based, where the source is a text: an instruction list, or a list export.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<u32>,
    /// Column in characters, 1-based, in an instruction list.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<u32>,
    /// Last line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_line: Option<u32>,
    /// Column past the last character.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end_column: Option<u32>,
    /// Name of the program within a project or export, e.g. `MAIN`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub program: Option<String>,
    /// Step number of the instruction: as the source states it, or in a project as it is counted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<u32>,
    /// Step number of the last instruction before, where the location is not an instruction that could be read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_step: Option<u32>,
    /// The instruction, where the source is not an instruction list in which it can be looked up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instruction: Option<String>,
}

impl Location {
    /// Location of a span in a program, whose instructions have these step numbers if they have been counted.
    pub fn of(program: &Program, step_numbers: &[u32], span: Span) -> Location {
        let at = instr_at(program, span.start);
        if program.kind.is_text() {
            let (line, column) = program.source.line_col(span.start);
            let (end_line, end_column) = program.source.line_col(span.end);
            let part = program.source.part(span.start);
            return Location {
                span,
                file: part.map(|part| part.path.clone()),
                line: Some(line),
                column: Some(column),
                end_line: Some(end_line),
                end_column: Some(end_column),
                step: at.and_then(|at| program.instrs[at].step),
                ..Location::default()
            };
        }
        let step = |at: usize| {
            let counted = || step_numbers.get(at).copied();
            program.instrs.get(at)?.step.or_else(counted)
        };
        let before = program
            .instrs
            .partition_point(|instr| instr.span.end < span.start);
        let before = before.checked_sub(1).filter(|_| at.is_none());
        let row = |offset| program.kind.has_rows().then(|| program.source.line(offset));
        Location {
            span,
            line: row(span.start),
            end_line: row(span.end),
            program: Some(name_within(program)),
            step: at.and_then(step),
            after_step: before.and_then(step),
            instruction: at.map(|at| program.instrs[at].to_string()),
            ..Location::default()
        }
    }

    /// The location as the head of a drawing: `motor.il:3:4`, `Packer.gxw · MAIN · step 37`.
    pub fn headed(&self, name: &str) -> String {
        let name = self.file.as_deref().unwrap_or(name);
        if let (Some(line), Some(column)) = (self.line, self.column) {
            return format!("{name}:{line}:{column}");
        }
        let stem = Path::new(name).file_stem().unwrap_or_default();
        let mut head = name.to_owned();
        if let Some(program) = self
            .program
            .as_ref()
            .filter(|program| stem != program.as_str())
        {
            head = format!("{head} · {program}");
        }
        match (self.step, self.after_step, self.line) {
            (Some(step), ..) => format!("{head} · step {step}"),
            (None, Some(step), _) => format!("{head} · after step {step}"),
            (None, None, Some(line)) => format!("{head} · row {line}"),
            (None, None, None) => head,
        }
    }
}

/// Name of a file in documents for tools, which are UTF-8: other bytes are escaped (`\xB5`), so that names stay apart.
pub fn named(path: &Path) -> String {
    let chunks = path.as_os_str().as_encoded_bytes().utf8_chunks();
    chunks.fold(String::new(), |mut name, chunk| {
        name.push_str(chunk.valid());
        for byte in chunk.invalid() {
            name.push_str(&format!("\\x{byte:02X}"));
        }
        name
    })
}

/// Serializes a path as [`named`] does; serde itself rejects other bytes.
///
/// # Errors
/// Those of the serializer.
pub fn as_named<S: serde::Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&named(path))
}

/// The instruction that holds an offset, or on whose line it lies.
pub fn instr_at(program: &Program, offset: u32) -> Option<usize> {
    let next = program
        .instrs
        .partition_point(|instr| instr.span.start <= offset);
    let at = next.checked_sub(1)?;
    let end = program.instrs[at].span.end;
    let source = &program.source;
    (offset <= end || source.is_one_line(offset, end)).then_some(at)
}

/// Name of the program in the editor of a project or an export.
fn name_within(program: &Program) -> String {
    let file = || Path::new(&program.source.name).file_stem();
    let export = || {
        let stem = file().filter(|_| program.kind.has_rows())?;
        Some(stem.to_string_lossy().into_owned())
    };
    let named = program.pou.clone().or_else(export);
    named.unwrap_or_else(|| "MAIN".to_owned())
}
