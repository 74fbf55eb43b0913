//! Runs that were found as a test file.

use super::report::Result;
use crate::commands::Context;
use rungc_ir::Module;
use rungc_verify::prove::Verdict;
use rungc_verify::written::{Names, case, outcomes, quoted};
use std::path::{Path, PathBuf};

/// The test file of all runs that were found; `None` if there are none. A run that its case does not show is left out,
/// with a note.
pub fn text(
    program: &Path,
    path: &Path,
    module: &Module,
    results: &[Result],
    cx: Context,
) -> Option<String> {
    let head = |program: &str| {
        format!(
            "topic = \"runs that rungc verify has found\"\nmodel = {}\nprogram = {{ file = {} }}\n",
            quoted(module.model.name),
            quoted(program)
        )
    };
    // The test's folder may not be there yet.
    let tried = head(&absolute(program).to_string_lossy());
    let mut names = Names::default();
    let mut text = String::new();
    for result in results {
        let Verdict::Found(trace) = &result.decision.verdict else {
            continue;
        };
        let case = case(
            &names.name(result.requested),
            module,
            result.property,
            trace,
        );
        match shows(path, &format!("{tried}{case}"), result) {
            Ok(()) => text.push_str(&case),
            Err(why) => cx.note(&format!(
                "     No test of `{}`: as a test, the run shows something else ({why})",
                result.requested
            )),
        }
    }
    (!text.is_empty()).then(|| head(&relative(program, path)) + &text)
}

/// Returns an error if the test of a run does not show on the interpreter what the run shows.
fn shows(path: &Path, text: &str, result: &Result) -> std::result::Result<(), String> {
    let outcomes = outcomes(&path.to_string_lossy(), text)?;
    match (&outcomes[..], result.property.is_wanted()) {
        ([None], true) | ([Some(_)], false) => Ok(()),
        ([Some(why)], true) => Err(why.clone()),
        _ => Err("it passes".to_string()),
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// The program as seen from the test file's folder.
pub fn relative(program: &Path, test: &Path) -> String {
    let (program, test) = (absolute(program), absolute(test));
    let folder = test.parent().unwrap_or(Path::new(""));
    for (up, ancestor) in folder.ancestors().enumerate() {
        if let Ok(below) = program.strip_prefix(ancestor) {
            let mut parts = vec!["..".to_string(); up];
            parts.extend(below.iter().map(|part| part.to_string_lossy().into_owned()));
            return parts.join("/");
        }
    }
    program.to_string_lossy().into_owned()
}
