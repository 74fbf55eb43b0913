//! Tables as workbooks of Excel and LibreOffice.

use crate::commands::Failure;
use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, Workbook, XlsxError};

/// Columns of numbers; all others are texts, which a spreadsheet leaves as they are.
const NUMBERS: [&str; 4] = ["network", "step", "modbus_address", "mc_number"];

/// A workbook with one sheet: a table in CSV with headers, ready to print. The same table gives the same bytes.
pub fn workbook(sheet: &str, table: &[u8]) -> Result<Vec<u8>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::Because(error.to_string());
    let mut reader = ::csv::Reader::from_reader(table);
    let heads = reader.headers().map_err(|error| failed(&error))?.clone();
    let rows = reader.records().collect::<Result<Vec<_>, _>>();
    let rows = rows.map_err(|error| failed(&error))?;
    let heads: Vec<&str> = heads.iter().collect();
    filled(sheet, &heads, &rows).map_err(|error| failed(&error))
}

fn filled(sheet: &str, heads: &[&str], rows: &[::csv::StringRecord]) -> Result<Vec<u8>, XlsxError> {
    let mut book = Workbook::new();
    // The time of writing would make each file another one.
    let created = ExcelDateTime::from_ymd(2000, 1, 1)?;
    book.set_properties(&DocProperties::new().set_creation_datetime(&created));
    let page = book.add_worksheet().set_name(sheet)?;
    let head = Format::new().set_bold();
    for (column, text) in (0..).zip(heads) {
        page.write_with_format(0, column, *text, &head)?;
    }
    for (row, record) in (1..).zip(rows) {
        for (column, (text, head)) in (0..).zip(record.iter().zip(heads)) {
            match text.parse::<u32>() {
                Ok(number) if NUMBERS.contains(head) => page.write(row, column, number)?,
                _ => page.write_string(row, column, text)?,
            };
        }
    }
    let last = u32::try_from(rows.len()).unwrap_or(u32::MAX);
    if let Some(right) = u16::try_from(heads.len())
        .ok()
        .and_then(|count| count.checked_sub(1))
    {
        page.autofilter(0, 0, last, right)?;
    }
    page.set_freeze_panes(1, 0)?;
    page.set_repeat_rows(0, 0)?;
    page.set_landscape()
        .set_paper_size(9)
        .set_print_fit_to_pages(1, 0);
    page.autofit();
    book.save_to_buffer()
}
