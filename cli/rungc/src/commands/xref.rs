//! `rungc xref`.

mod csv;
mod html;
mod xlsx;

use super::setting;
use super::subject::{self, OutputPaths, Subject, option_of};
use super::{
    Context, Failure, Outcome, Result, found_reading, print_bytes, print_text, read_with_names,
    stem,
};
use crate::args::{XrefArgs, XrefTo};
use crate::output::{self, write_file};
use crate::report::{Reporter, to_json};
use rungc::xref::Table;
use rungc::{Names, lists};
use rungc_analysis::resolve::resolve;
use rungc_ladder::build;
use rungc_lower::compile;
use std::path::Path;

/// Lists who uses which device.
pub fn run(args: &XrefArgs, cx: Context) -> Result {
    let mut outputs = OutputPaths::default();
    subject::each(&args.inputs, cx, |subject, reporter| {
        xref(args, subject, reporter, &mut outputs)
    })
}

fn xref(
    args: &XrefArgs,
    subject: &Subject,
    reporter: &mut Reporter,
    outputs: &mut OutputPaths,
) -> Result {
    // The program as written, without the additions of the settings.
    let read = read_with_names(subject, reporter)?;
    let program = &read.program;
    let findings = found_reading(subject, &read);
    reporter.add(&findings)?;
    let model = compile::model(program, &subject.options());
    let (resolved, _) = resolve(program, model);
    let names = Names::of(program);
    let ranges = setting::ranges(&option_of("--device", subject), &args.device, &names)?;
    let ladder = build::ladder(&resolved);
    let table = Table::new(&resolved, &ladder, &ranges);
    // What no instruction uses may be a free terminal, or a tag by its comment.
    let is_about_uses = !matches!(args.to, XrefTo::Io | XrefTo::Tags);
    if is_about_uses && table.devices.is_empty() && !args.device.is_empty() {
        let path = subject.file.display();
        let why = format!("{path}: no instruction names these devices");
        return Err(Failure::Because(why));
    }
    let name = findings.name(reporter.many());
    let is_workbook = output::file(&args.output).is_some_and(is_workbook);
    let (bytes, ending) = match args.to {
        XrefTo::Text => (table.text(args.unused).into_bytes(), "txt"),
        XrefTo::Csv => {
            let table = csv::table(&table)?;
            match is_workbook {
                true => (table, "xlsx"),
                false => (csv::without_formulas(&table)?, "csv"),
            }
        }
        XrefTo::Html => (html::page(&name, &table).into_bytes(), "html"),
        XrefTo::Json => (to_json(&table)?.into_bytes(), "json"),
        XrefTo::Io => {
            let list = lists::terminals(&resolved, &ladder, subject.variant, &ranges);
            let table = csv::records(list)?;
            match is_workbook {
                true => (table, "io.xlsx"),
                false => (csv::for_spreadsheets(&table)?, "io.csv"),
            }
        }
        XrefTo::Tags => {
            let table = csv::records(lists::tags(&resolved, &ranges))?;
            match is_workbook {
                true => (table, "tags.xlsx"),
                false => (csv::without_formulas(&table)?, "tags.csv"),
            }
        }
    };
    let bytes = match (is_workbook, args.to) {
        (false, _) => bytes,
        (true, XrefTo::Csv) => xlsx::workbook("cross reference", &bytes)?,
        (true, XrefTo::Io) => xlsx::workbook("terminals", &bytes)?,
        (true, XrefTo::Tags) => xlsx::workbook("tags", &bytes)?,
        (true, XrefTo::Text | XrefTo::Html | XrefTo::Json) => {
            let why = "a workbook (.xlsx) holds a table: add --to csv, --to io or --to tags";
            return Err(Failure::Because(format!("--output: {why}")));
        }
    };
    if output::file(&args.output).is_none() && args.to == XrefTo::Text {
        let heading = match reporter.many() {
            true => format!("; {name}\n"),
            false => String::new(),
        };
        print_text(&format!("{heading}{}", String::from_utf8_lossy(&bytes)))?;
    } else {
        let file = || format!("{}.{ending}", stem(subject, &read));
        match outputs.place(output::file(&args.output), reporter.many(), file, subject)? {
            Some(path) => write_file(&path, &bytes, args.force)?,
            None => print_bytes(&bytes)?,
        }
    }
    Ok(Outcome::of(&findings))
}

/// Returns true for the name of a workbook of Excel.
fn is_workbook(path: &Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("xlsx"))
}
