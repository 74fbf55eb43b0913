//! `rungc check --fix`: changes instruction lists as diagnostics propose, where that is certainly what was meant.

use super::in_place::InPlace;
use super::subject::{self, Subject};
use super::{Context, Failure, findings};
use rungc_frontend::{Read, read_text};
use rungc_lower::compile;
use rungc_syntax::diag::{self, Fix};
use rungc_syntax::{Diagnostic, Severity};

/// A fix may uncover another one; no line needs more rounds than this.
const ROUNDS: usize = 8;

/// Changes the file of a program, as a whole or not at all, and reports the changes. The check reports what cannot be
/// read.
pub fn fix(subject: &Subject, cx: Context) -> Result<(), Failure> {
    let path = subject.file.display();
    if subject.is_stdin() {
        let why = "--fix cannot change standard input; name the file";
        return Err(Failure::Because(why.to_string()));
    }
    let Ok(read) = subject::source(subject) else {
        return Ok(());
    };
    if !read.program.kind.is_list() {
        cx.note(&format!(
            "     Skipped {path}: --fix changes instruction lists; change this one in its editor"
        ));
        return Ok(());
    }
    let file = InPlace::open(subject, &read, "--fix")?;
    let fixed = Fixed::of(subject, read);
    if fixed.changes.is_empty() {
        return Ok(());
    }
    file.write(&fixed.text)?;
    for change in &fixed.changes {
        cx.note(&format!("       Fixed {path}:{change}"));
    }
    Ok(())
}

/// A text with its fixes applied.
struct Fixed {
    text: String,
    /// Line, what was done, and the code of what was wrong.
    changes: Vec<String>,
}

impl Fixed {
    /// Applies fixes until nothing certain is left to do. Fixes that make more errors than there were are undone.
    fn of(subject: &Subject, mut read: Read) -> Fixed {
        let mut changes: Vec<String> = Vec::new();
        // The text before the last round, with how many errors it has and how many changes led to it.
        let mut before = (read.program.source.text.clone(), usize::MAX, 0);
        for _ in 0..ROUNDS {
            let found = found(subject, &read);
            let now = found
                .iter()
                .filter(|d| d.severity == Severity::Error)
                .count();
            if now > before.1 {
                changes.truncate(before.2);
                let text = before.0;
                return Fixed { text, changes };
            }
            let fixes: Vec<(&Diagnostic, Fix)> = found
                .iter()
                .filter_map(|d| Some((d, certain(d, &read)?)))
                .collect();
            let list: Vec<_> = fixes.iter().map(|(_, fix)| fix).collect();
            let source = &read.program.source;
            let (text, applied) = diag::apply(&source.text, &list);
            if !applied.contains(&true) {
                break;
            }
            let done = fixes.iter().zip(applied).filter(|(_, applied)| *applied);
            let done = done.map(|((d, fix), _)| {
                let line = source.line_col(d.span.start).0;
                format!("{line}: {} ({})", fix.title, d.code)
            });
            let done: Vec<_> = done.collect();
            before = (source.text.clone(), now, changes.len());
            read = read_text(&source.name.clone(), &text);
            changes.extend(done);
        }
        Fixed {
            text: read.program.source.text,
            changes,
        }
    }
}

/// Diagnostics of a program.
fn found(subject: &Subject, read: &Read) -> Vec<Diagnostic> {
    let checked = compile::check(&read.program, &subject.options());
    findings(subject, read, &checked).diagnostics
}

/// The fix of a diagnostic that may be applied unseen, with the line ends of the text.
fn certain(diagnostic: &Diagnostic, read: &Read) -> Option<Fix> {
    let fix = diagnostic.fix.clone().filter(|fix| fix.certain)?;
    Some(fix.with_line_ends_of(&read.program.source.text))
}
