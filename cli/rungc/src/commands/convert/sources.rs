//! `--to st`, `labels` and `labels-csv`: the sources of a GX Works2 project, which need no compiled program.

use super::deliver;
use crate::args::{ConvertArgs, ConvertTo};
use crate::commands::subject::{OutputPaths, Subject};
use crate::commands::{
    Context, Failure, Outcome, Result, conclude, eprint_line, read_as_written, stem,
};
use crate::output::{file, write_folder};
use crate::report::{Findings, Reporter};
use rungc_emit::OutFile;
use rungc_frontend::Read;
use rungc_frontend::sources::{Body, SourceFile, Sources};
use rungc_syntax::SourceKind;

/// Writes the sources of a project. Nothing is written of those that cannot be read whole.
pub fn convert(
    args: &ConvertArgs,
    subject: &Subject,
    reporter: &mut Reporter,
    outputs: &mut OutputPaths,
    cx: Context,
) -> Result {
    let read = read_as_written(subject, reporter)?;
    let refuse = |why: &str| Failure::Because(format!("{}: {why}", subject.file.display()));
    let Some(sources) = structured(&read) else {
        let found = read.diagnostics.clone();
        let findings = Findings::new(&subject.file, &read.program, found, &subject.reporting);
        if findings.failed() {
            return conclude(&findings, reporter, cx, String::new);
        }
        return Err(refuse(match read.program.kind {
            SourceKind::GxWorks2 => {
                "the project holds a ladder of devices alone, without labels; `--to il` and `--to ladder` write it"
            }
            _ => "only projects of GX Works2 hold labels and sources in other languages",
        }));
    };
    if let Some(unread) = sources.unread.first() {
        let (what, at) = (&unread.what, unread.at);
        let why = format!("{what} cannot be read past offset 0x{at:04X}; nothing is written");
        return Err(refuse(&why));
    }
    name_omitted(sources);
    let name = || match args.to {
        ConvertTo::Labels => format!("{}.{}", stem(subject, &read), args.to.ending()),
        _ => stem(subject, &read),
    };
    let path = outputs.place(file(&args.output), reporter.many(), name, subject)?;
    let files = match args.to {
        ConvertTo::Labels => {
            return deliver(args, path.as_deref(), sources.to_labels().as_bytes());
        }
        ConvertTo::LabelsCsv => sources.to_label_tables(&stem(subject, &read)),
        _ => sources.to_st(),
    };
    let Some(path) = path else {
        return Err(refuse("this form is a folder of files; name one with `-o`"));
    };
    let made = |file: SourceFile| OutFile {
        path: file.path,
        contents: file.contents,
    };
    let files: Vec<_> = files.into_iter().map(made).collect();
    write_folder(&path, &files, args.force)?;
    Ok(Outcome::Success)
}

/// The sources of a project that holds more than a ladder of devices.
fn structured(read: &Read) -> Option<&Sources> {
    read.sources
        .as_deref()
        .filter(|sources| sources.is_structured())
}

/// Names POUs in languages that are not decoded.
fn name_omitted(sources: &Sources) {
    for pou in &sources.pous {
        if matches!(pou.body, Body::Chart | Body::Other(_)) {
            let (name, language) = (&pou.name, pou.body.language());
            eprint_line(&format!(
                "rungc: `{name}` is {language}, which is not decoded: only its labels are written"
            ));
        }
    }
}
