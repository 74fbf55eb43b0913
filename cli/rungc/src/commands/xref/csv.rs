//! A cross reference as a table in CSV.

use crate::commands::Failure;
use rungc::xref::Table;
use serde::Serialize;

/// A line of the file.
#[derive(Serialize)]
struct Record<'a> {
    first: &'a str,
    last: &'a str,
    comment: &'a str,
    network: usize,
    step: u32,
    r#use: &'a str,
    instruction: &'a str,
    reach: &'a str,
}

/// A line for each use, with headers.
pub fn table(table: &Table) -> Result<Vec<u8>, Failure> {
    let lines = table.devices.iter().flat_map(|entry| {
        entry.uses.iter().map(move |line| Record {
            first: &entry.area.first,
            last: &entry.area.last,
            comment: &entry.comment,
            network: line.network,
            step: line.step,
            r#use: line.kind,
            instruction: &line.instruction,
            reach: line.reach.unwrap_or_default(),
        })
    });
    records(lines)
}

/// Records, with headers.
pub fn records<T: Serialize>(records: impl IntoIterator<Item = T>) -> Result<Vec<u8>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Because(error.to_string());
    let mut out = ::csv::Writer::from_writer(Vec::new());
    for record in records {
        out.serialize(record).map_err(|error| failed(&error))?;
    }
    out.into_inner().map_err(|error| failed(&error))
}

/// A table that a spreadsheet may open: it takes a text such as `=A1-K1`, the designation of a contactor or something
/// worse, for a formula, unless an apostrophe stands before it. A workbook needs none.
pub fn without_formulas(table: &[u8]) -> Result<Vec<u8>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Because(error.to_string());
    let mut reader = ::csv::ReaderBuilder::new();
    let mut reader = reader.has_headers(false).from_reader(table);
    let mut out = ::csv::Writer::from_writer(Vec::new());
    for record in reader.records() {
        let record = record.map_err(|error| failed(&error))?;
        let texts = record.iter().map(|text| match is_formula(text) {
            true => format!("'{text}"),
            false => text.to_owned(),
        });
        out.write_record(texts).map_err(|error| failed(&error))?;
    }
    out.into_inner().map_err(|error| failed(&error))
}

/// Returns true for a text that a spreadsheet computes; a number is what it says.
fn is_formula(text: &str) -> bool {
    let begins = text.starts_with(['=', '+', '-', '@', '\t', '\r', '＝', '＋', '－', '＠']);
    begins && text.parse::<i64>().is_err()
}

/// A table as Excel opens it: without the mark in front, it takes the text for one of the local encoding.
pub fn for_spreadsheets(table: &[u8]) -> Result<Vec<u8>, Failure> {
    Ok([b"\xef\xbb\xbf", &without_formulas(table)?[..]].concat())
}
