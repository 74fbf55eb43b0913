//! `rungc fmt`.

use super::in_place::InPlace;
use super::subject::{self, Subject};
use super::{
    Context, Failure, Outcome, Result, conclude, counted, eprint_line, found_reading, print_text,
    read_as_written,
};
use crate::args::FmtArgs;
use crate::report::Reporter;
use rungc_frontend::print::{LaidOut, lay_out};
use rungc_syntax::SourceKind;
use std::fmt::Write;

/// Lays out instruction lists. Nothing is written of one that cannot be read whole.
pub fn run(args: &FmtArgs, cx: Context) -> Result {
    subject::each(&args.inputs, cx, |subject, reporter| {
        format(args, subject, reporter, cx)
    })
}

fn format(args: &FmtArgs, subject: &Subject, reporter: &mut Reporter, cx: Context) -> Result {
    let path = subject.file.display();
    let read = read_as_written(subject, reporter)?;
    let program = &read.program;
    if program.kind != SourceKind::Il {
        if reporter.many() {
            cx.detail(|| format!("     Skipped {path}: not an instruction list"));
            return Ok(Outcome::Success);
        }
        let why = format!(
            "fmt: {path} is not an instruction list; `rungc convert --to il` makes one of it"
        );
        return Err(Failure::Because(why));
    }
    let findings = found_reading(subject, &read);
    if findings.failed() {
        return conclude(&findings, reporter, cx, String::new);
    }
    reporter.add(&findings)?;
    let laid_out = lay_out(program);
    let is_changed = !laid_out.changes.is_empty();
    let file = (is_changed && !subject.is_stdin()).then(|| InPlace::open(subject, &read, "fmt"));
    let file = file.transpose()?;
    match (args.check, file) {
        (true, _) => return compare(&laid_out, subject),
        (false, None) if subject.is_stdin() => print_text(&laid_out.text)?,
        (false, None) => {}
        (false, Some(file)) => {
            file.write(&laid_out.text)?;
            let lines = counted(laid_out.changes.len(), "line");
            cx.note(&format!("   Formatted {path}: {lines}"));
        }
    }
    Ok(Outcome::Success)
}

/// Lists the lines that are laid out differently.
fn compare(laid_out: &LaidOut, subject: &Subject) -> Result {
    let path = subject.file.display();
    let mut listing = String::new();
    for change in &laid_out.changes {
        let _ = writeln!(listing, "{path}:{}", change.line);
        if change.before == change.after && !change.after.is_empty() {
            let _ = writeln!(listing, " {} (another line end)", change.after);
            continue;
        }
        let _ = writeln!(listing, "-{}", change.before);
        for line in change.after.lines() {
            let _ = writeln!(listing, "+{line}");
        }
    }
    if laid_out.changes.is_empty() {
        return Ok(Outcome::Success);
    }
    print_text(&listing)?;
    let lines = counted(laid_out.changes.len(), "line");
    eprint_line(&format!("rungc: {path}: `rungc fmt` changes {lines}"));
    Ok(Outcome::Failed)
}
