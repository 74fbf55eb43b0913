//! The editors' export of device comments: a table of devices and texts.

use super::layout::{HEAD_ROWS, delimiters, is_instruction_heading, plain, table};
use super::rows::{self, Row, Rows, unspaced};
use crate::il;
use crate::text::clean;
use csv::StringRecord;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Span, codes};
use std::collections::BTreeMap;

/// Names of the columns of devices, with `false`, and of comments, with `true`, spelled as in [`NAMES`].
const COMMENT_NAMES: [(&str, bool); 13] = [
    ("devicename", false),
    ("device", false),
    ("デバイス名", false),
    ("デバイス", false),
    ("软元件名", false),
    ("软元件", false),
    ("軟元件名", false),
    ("comment", true),
    ("devicecomment", true),
    ("コメント", true),
    ("注释", true),
    ("註解", true),
    ("注解", true),
];

/// Separators of fields.
const DELIMITERS: [u8; 3] = [b'\t', b',', b';'];

/// The rows of an export of device comments, by the separator that gives the most devices, and the columns of devices
/// and comments.
fn comment_rows(text: &str) -> (Vec<Row>, [usize; 2]) {
    let text = &*unspaced(text);
    let of = |delimiter| {
        let records = table(text, delimiter).into_records();
        let head: Vec<StringRecord> = records.flatten().take(HEAD_ROWS).collect();
        let columns = named_columns(&head).unwrap_or_else(|| [0, first_text(text, delimiter)]);
        let is_comment = |record: &StringRecord| {
            let comment = record.get(columns[1]);
            record.get(columns[0]).and_then(il::device).is_some() && comment.is_some()
        };
        let is_row = |line: &str| rows::alone(line, delimiter).is_some_and(|row| is_comment(&row));
        let rows: Vec<Row> = Rows::new(text, delimiter, is_row).collect();
        let devices = rows.iter().filter(|row| is_comment(&row.record)).count();
        (devices, rows, columns)
    };
    let tables: Vec<_> = delimiters(text).map(of).collect();
    // The first of equals.
    let best = tables
        .into_iter()
        .rev()
        .max_by_key(|(devices, ..)| *devices);
    best.map_or_else(Default::default, |(_, rows, columns)| (rows, columns))
}

/// The columns of devices and comments that a row of names shows.
fn named_columns(rows: &[StringRecord]) -> Option<[usize; 2]> {
    let named = |row: &StringRecord| {
        let find = |comment| {
            row.iter().position(|field| {
                let name = plain(field);
                COMMENT_NAMES.contains(&(name.as_str(), comment))
            })
        };
        Some([find(false)?, find(true)?])
    };
    rows.iter().take(HEAD_ROWS).find_map(named)
}

/// The first column with texts beside the devices of a table without names.
fn first_text(text: &str, delimiter: u8) -> usize {
    let rows = table(text, delimiter).into_records().flatten();
    let of_devices = rows.filter(|row| row.get(0).and_then(il::device).is_some());
    let texts = of_devices.filter_map(|row| {
        let mut columns = row.iter().enumerate().skip(1);
        columns.find_map(|(at, cell)| clean(cell).map(|_| at))
    });
    texts.min().unwrap_or(1)
}

/// Returns true for the lines of a cross-reference: names or rows of devices, and after them instructions that use
/// them, where lists have instructions first.
pub(crate) fn is_cross_reference(lines: &[&str]) -> bool {
    let is_comment = |line: &&&str| line.starts_with(';') || line.starts_with("//");
    let lines: Vec<&str> = lines
        .iter()
        .filter(|line| !is_comment(line))
        .copied()
        .collect();
    let rows = |delimiter| lines.iter().map(move |line| rows::alone(line, delimiter));
    let is_named = |row: &StringRecord| {
        let find = |is: &dyn Fn(&str) -> bool| row.iter().position(|cell| is(&plain(cell)));
        let of_device =
            |name: &str| name == "devicelabel" || COMMENT_NAMES.contains(&(name, false));
        let device = find(&of_device);
        let instruction = find(&|name| name == "laddersymbol" || is_instruction_heading(name));
        device.is_some() && device < instruction
    };
    let is_use = |row: &StringRecord| {
        let device = row.get(0).and_then(il::device);
        let word = row.get(1).unwrap_or_default().trim();
        device.is_some() && il::is_basic(word) && !word.contains(|c: char| c.is_ascii_lowercase())
    };
    DELIMITERS.into_iter().any(|delimiter| {
        let mut head = rows(delimiter).take(HEAD_ROWS).flatten();
        // Below a head of one row or two.
        let begins = rows(delimiter).take(3).flatten().any(|row| is_use(&row));
        let uses = || rows(delimiter).flatten().filter(is_use).count();
        head.any(|row| is_named(&row)) || begins && uses() + 2 >= lines.len()
    })
}

/// Returns true for an export of device comments: rows of a device and a text. Lists hold labels, before `;` even.
pub(crate) fn is_comments(text: &str) -> bool {
    let (rows, columns) = comment_rows(text);
    let is_device = |row: &&Row| {
        let comment = row.record.get(columns[1]).is_some();
        let device = row.record.get(columns[0]).and_then(il::device);
        comment
            && device.is_some_and(|device| !matches!(device.class, DeviceClass::P | DeviceClass::I))
    };
    let devices = rows.iter().filter(is_device).count();
    let is_rail = |row: &Row| {
        row.record
            .get(0)
            .is_some_and(|cell| cell.trim_start().starts_with(['|', '│', '├']))
    };
    // Below a head of one row or two, which is not a rung of a drawing.
    devices > 0 && devices + 2 >= rows.len() && !rows.iter().any(is_rail)
}

/// Reads an export of device comments, and warns of rows that it cannot use. Rows without a comment, and those above
/// the first device, are headings.
pub(crate) fn comments(text: &str) -> (BTreeMap<Device, String>, Vec<Diagnostic>) {
    let (rows, [device_column, comment_column]) = comment_rows(text);
    let mut comments: BTreeMap<Device, String> = BTreeMap::new();
    let is_empty = rows.iter().all(|row| row.record.iter().all(str::is_empty));
    let mut is_table = is_empty;
    let mut is_damaged = false;
    let mut unread = Vec::new();
    for row in rows {
        let mut warn = |what: String, help: &'static str| {
            let message = format!("row {} of `COMMENT.csv`: {what}", row.line);
            let warning = codes::DAMAGED_PART.at(Span::default(), message);
            unread.push(warning.help(help));
        };
        if row.is_unclosed {
            let what = "a text begins with a quote and takes in the next rows";
            warn(what.to_owned(), rows::HELP);
        }
        let device = row.record.get(device_column).unwrap_or_default().trim();
        if !is_damaged && row.record.iter().any(|field| field.contains('\u{FFFD}')) {
            is_damaged = true;
            let what = "some bytes of this text cannot be read";
            let help = "type the comment again, and save the table as UTF-8";
            warn(what.to_owned(), help);
        }
        let read = il::device(device);
        is_table |= read.is_some();
        let Some(comment) = row.record.get(comment_column).and_then(clean) else {
            continue;
        };
        match read {
            Some(device) => {
                let earlier = comments.insert(device, comment.to_string());
                if earlier.is_some_and(|earlier| earlier != comment) {
                    let what = format!("this comment on {device} replaces that of a row above");
                    warn(what, "a device has one comment: delete the other row");
                }
            }
            None if device.contains(|c: char| c.is_ascii_digit()) => {
                let what = format!("`{device}` is not a device, so its comment is left out");
                warn(what, help_for(device));
            }
            None => {}
        }
    }
    if !is_table && unread.is_empty() {
        unread.push(not_comments());
    }
    (comments, unread)
}

/// A warning that `COMMENT.csv` is not a table of comments.
pub(crate) fn not_comments() -> Diagnostic {
    let message = "`COMMENT.csv` names no devices, so no comments are read from it";
    let warning = codes::DAMAGED_PART.at(Span::default(), message);
    warning.help(
        "it is a table of device comments, as editors export it; rename it if it is something else",
    )
}

/// Advice about a name in the column of devices that is not one.
fn help_for(name: &str) -> &'static str {
    let digits = name.strip_prefix(['X', 'Y', 'x', 'y']).unwrap_or_default();
    match !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit()) {
        true => "correct it in the table of comments; X and Y count in octal",
        false => "a row of the table names one device, such as X010 or D5",
    }
}
