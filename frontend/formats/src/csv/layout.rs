//! Layout of a list export: its separator, its columns, and the rows above the list.

use super::rows::{self, unspaced};
use crate::gx::cpu;
use crate::il;
use crate::table::stated;
use csv::{ReaderBuilder, StringRecord};

/// The columns in the editors' order, by their English names.
pub(crate) const HEADERS: [&str; 7] = [
    "Step No.",
    "Line Statement",
    "Instruction",
    "I/O(Device)",
    "Blank",
    "PI Statement",
    "Note",
];

/// The columns' names in the editors' languages, without spaces and punctuation, in the order of [`HEADERS`].
const NAMES: [&[&str]; 7] = [
    &[
        "stepno",
        "step",
        "ステップ番号",
        "ステップno",
        "步号",
        "步序号",
    ],
    &["linestatement", "行間ステートメント", "行间声明"],
    &["instruction", "命令", "指令"],
    &["iodevice", "ioデバイス", "io软元件"],
    &["blank", "空欄", "空白栏"],
    &["pistatement", "piステートメント", "pi声明"],
    &["note", "ノート", "注解", "注释"],
];

/// Maximum number of rows above the list.
pub(super) const HEAD_ROWS: usize = 12;

/// Number of rows that show the columns of an export whose headings are of an unknown language, or lost.
const ROWS: usize = 400;

/// A column that a table does not have.
const NONE: usize = usize::MAX;

/// Layout of a text as a table.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    pub(super) delimiter: u8,
    /// For each of [`HEADERS`], its column.
    pub(super) columns: [usize; 7],
    /// Number of rows above the list.
    pub(super) above: usize,
    /// True if the last of them holds the headings.
    pub(super) has_headings: bool,
}

impl Layout {
    /// Returns true for a line that is a row of the list by itself.
    pub(super) fn is_row(&self, line: &str) -> bool {
        let [step, _, instruction, ..] = self.columns;
        let Some(row) = rows::alone(line, self.delimiter) else {
            return false;
        };
        let used = self.columns.iter().filter(|column| **column != NONE);
        let is_whole = used.max().is_some_and(|last| row.len() > *last);
        let (step, word) = (cell(&row, step), cell(&row, instruction));
        // Any other text may be a line of a note.
        let is_mnemonic = !word.contains(|c: char| c.is_ascii_lowercase() || c.is_whitespace());
        let is_numbered = step.is_empty() || il::number(step).is_some();
        is_numbered && (il::is_basic(word) || is_whole && is_mnemonic)
    }
}

/// Detects a list export and its layout.
pub(crate) fn detect(text: &str) -> Option<Layout> {
    let text = &*unspaced(text);
    delimiters(text)
        .find_map(|delimiter| with_header(text, delimiter))
        .or_else(|| by_shape(text))
}

/// The separators that a table may have; first the one that its line `sep=;` states.
pub(super) fn delimiters(text: &str) -> impl Iterator<Item = u8> + use<> {
    let (stated, _) = stated(text);
    stated.into_iter().chain([b'\t', b',', b';'])
}

/// The layout of an export without headings in a known language: quoted fields, or step numbers before instructions.
/// The instructions show their column; the one after it holds devices.
fn by_shape(text: &str) -> Option<Layout> {
    let lines = || {
        text.lines()
            .filter(|line| !line.trim().is_empty())
            .take(HEAD_ROWS)
    };
    let quoted = |separator| lines().any(|line| line.starts_with('"') && line.contains(separator));
    // A text with comments is a list as text, unless it separates fields as others begin comments.
    let commented = lines().any(|line| line.starts_with(';') || line.starts_with("//"));
    let numbered = |separator| {
        let number = |line: &str| line.split_once(separator)?.0.trim().parse::<u32>().ok();
        let may_be_table = separator == ';' || !commented;
        may_be_table && lines().any(|line| number(line).is_some())
    };
    let (delimiter, certain) = if let (Some(stated), _) = stated(text) {
        (stated, true)
    } else if quoted("\"\t\"") {
        (b'\t', true)
    } else if quoted("\",\"") || numbered(',') {
        (b',', true)
    } else if quoted("\";\"") || numbered(';') {
        (b';', true)
    } else if numbered('\t') {
        (b'\t', false)
    } else {
        return None;
    };
    let rows: Vec<StringRecord> = table(text, delimiter)
        .into_records()
        .flatten()
        .take(ROWS)
        .collect();
    let width = rows.iter().map(StringRecord::len).max()?;
    let basic = |column: usize| {
        rows.iter()
            .filter(move |row| il::is_basic(cell(row, column)))
    };
    // The first of equals: a statement may be a word that is an instruction, too.
    let instruction = (0..width)
        .rev()
        .max_by_key(|&column| basic(column).count())?;
    let columns = columns(instruction, width).filter(|_| basic(instruction).next().is_some())?;
    let (above, has_headings) = above(&rows, columns);
    let layout = Layout {
        delimiter,
        columns,
        above,
        has_headings,
    };
    // Lists as text have tabs between their words, too.
    let is_table = certain || has_headings || has_statements(&rows, columns);
    is_table.then_some(layout)
}

/// A cell of a row; empty if the row has no such column.
fn cell(row: &StringRecord, column: usize) -> &str {
    row.get(column).unwrap_or_default().trim()
}

/// Returns true if some row holds a statement alone: not a word that could be a label or an instruction.
fn has_statements(rows: &[StringRecord], [_, statement, instruction, ..]: [usize; 7]) -> bool {
    let is_small = |text: &str| text.contains(|c: char| c.is_ascii_lowercase());
    let small_code = rows.iter().any(|row| is_small(cell(row, instruction)));
    rows.iter().any(|row| {
        let text = cell(row, statement);
        let is_word = text.is_ascii() && !text.contains(' ');
        let is_code = is_word && (small_code || !is_small(text));
        !text.is_empty() && !is_code && cell(row, instruction).is_empty()
    })
}

/// Number of rows above the list, which have words in place of step numbers; true if the last of them has headings for
/// the instructions and their devices.
fn above(rows: &[StringRecord], columns: [usize; 7]) -> (usize, bool) {
    let [step, _, instruction, device, ..] = columns;
    let is_number = |row: &StringRecord| il::number(cell(row, step)).is_some();
    let is_instruction = |row: &StringRecord| {
        let word = cell(row, instruction);
        let numbered = is_number(row) && !word.is_empty();
        numbered || il::is_basic(word) || il::device(cell(row, device)).is_some()
    };
    let head = rows.iter().take(HEAD_ROWS);
    let head = head.take_while(|row| !is_instruction(row)).count();
    let names_cpu = |row: &StringRecord| cpu::is_label(cell(row, 0)) && cpu::of_head(row).is_some();
    let is_above =
        |row: &StringRecord| !cell(row, step).is_empty() && !is_number(row) || names_cpu(row);
    let Some(last) = rows[..head].iter().rposition(is_above) else {
        return (0, false);
    };
    let heading = |column| !cell(&rows[last], column).is_empty();
    let has_headings = heading(instruction) && heading(device) && !names_cpu(&rows[last]);
    (last + 1, has_headings)
}

/// The columns around that of the instructions: before it steps, and statements if there is room; after it devices, and
/// either all that editors write or notes alone.
fn columns(instruction: usize, width: usize) -> Option<[usize; 7]> {
    let (step, statement) = match instruction {
        0 => (NONE, NONE),
        1 => (0, NONE),
        2 => (0, 1),
        _ => return None,
    };
    let device = instruction + 1;
    let after = match width.saturating_sub(device + 1) {
        0 => [NONE; 3],
        1 => [NONE, NONE, device + 1],
        2 => [device + 1, NONE, device + 2],
        _ => [device + 1, device + 2, device + 3],
    };
    let [blank, pointer, note] = after;
    Some([step, statement, instruction, device, blank, pointer, note])
}

fn with_header(text: &str, delimiter: u8) -> Option<Layout> {
    let mut reader = table(text, delimiter);
    let mut record = StringRecord::new();
    for row in 0..HEAD_ROWS {
        if !reader.read_record(&mut record).ok()? {
            return None;
        }
        let mut columns = [NONE; 7];
        for (at, field) in record.iter().enumerate() {
            let field = plain(field);
            if let Some(column) = NAMES
                .iter()
                .position(|names| names.contains(&field.as_str()))
            {
                columns[column] = at;
            }
        }
        // The instruction and its device are what makes it a list.
        if columns[2] != NONE && columns[3] != NONE {
            return Some(Layout {
                delimiter,
                columns,
                above: row + 1,
                has_headings: true,
            });
        }
    }
    None
}

/// Returns true for a name of the column of instructions, spelled as in [`NAMES`].
pub(super) fn is_instruction_heading(name: &str) -> bool {
    NAMES[2].contains(&name)
}

/// The name of a column without spaces and punctuation, in lower case.
pub(super) fn plain(name: &str) -> String {
    let letters = name.chars().filter(|c| c.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

pub(crate) fn table(text: &str, delimiter: u8) -> csv::Reader<&[u8]> {
    ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes())
}
