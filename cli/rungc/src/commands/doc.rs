//! `rungc doc`.

use super::subject;
use super::{Context, Failure, Outcome, Result, findings, read};
use crate::args::DocArgs;
use crate::output::write_file;
use crate::report::{Reporter, to_json};
use rungc_lower::compile;

/// Writes the documentation of a machine.
pub fn run(args: &DocArgs, cx: Context) -> Result {
    let path = &args.output;
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let is_data = ending == "json";
    if !is_data && ending != "html" {
        return Err(Failure::Because(format!(
            "--output {}: the documentation is a page (.html), which a browser prints or saves as PDF, or data (.json)",
            path.display()
        )));
    }
    let subject = subject::one(&args.input, cx)?;
    let mut reporter = Reporter::new(&subject.reporting, cx, false);
    let read = read(&subject, &mut reporter)?;
    let compiled = compile::check(&read.program, &subject.options());
    let findings = findings(&subject, &read, &compiled);
    let settings = subject.project.as_deref().cloned();
    let project = rungc::Project::from_read(
        subject.file.clone(),
        read.clone(),
        (settings, subject.plc()),
        subject.reporting.levels(),
    );
    let text = match is_data {
        true => to_json(&project.document())?,
        false => project.documentation(findings.language(cx)),
    };
    write_file(path, text.as_bytes(), args.force)?;
    reporter.add(&findings)?;
    cx.note(&format!("       Wrote {}", path.display()));
    reporter.finish()?;
    Ok(Outcome::of(&findings))
}
