//! `rungc convert`.

use super::{Context, Outcome, Result, conclude, counted, read, tell, write_file};
use crate::args::{ConvertArgs, ConvertTo};
use crate::report::Findings;
use rungc_frontend::print;
use std::io::{self, Write};

/// Rewrites a program. Nothing is written if the input could not be read whole.
pub fn run(args: &ConvertArgs, cx: Context) -> Result {
    let read = read(&args.input, cx)?;
    let findings = Findings::new(
        &args.input.file,
        &read.program,
        read.diagnostics.clone(),
        &args.input.reporting,
    );
    if findings.failed() {
        return conclude(&findings, &args.input.reporting, cx, String::new);
    }
    crate::report::print(&findings, &args.input.reporting, cx.color, cx.taken)?;
    let bytes = match args.to {
        ConvertTo::Il => print::to_il(&read.program).into_bytes(),
        ConvertTo::Csv => print::to_csv(&read.program),
    };
    let comments = read.program.comments.len();
    if args.to == ConvertTo::Csv && comments > 0 {
        let what = counted(comments, "device comment");
        tell(&format!(
            "rungc: {what} left out, which a list export has no place for; `--to il` keeps them"
        ));
    }
    match &args.output {
        Some(path) => write_file(path, &bytes, args.force)?,
        None => io::stdout().write_all(&bytes)?,
    }
    Ok(Outcome::Success)
}
