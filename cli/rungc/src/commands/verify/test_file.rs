//! Counterexamples as a test file.

use super::report::Result;
use rungc_ir::Module;
use rungc_verify::prove::Verdict;
use rungc_verify::replay::{Change, Setting, story};
use std::fmt::Write;
use std::path::Path;

/// The test file of all runs that were found; `None` if there are none.
pub fn text(program: &Path, path: &Path, module: &Module, results: &[Result]) -> Option<String> {
    let mut text = String::new();
    let named = relative(program, path);
    let _ = writeln!(text, "topic = \"runs that rungc verify has found\"");
    let _ = writeln!(text, "model = {}", quoted(module.model.name));
    let _ = writeln!(text, "program = {{ file = {} }}", quoted(&named));
    let mut any = false;
    for result in results {
        let Verdict::Found(trace) = &result.decision.verdict else {
            continue;
        };
        any = true;
        let _ = writeln!(text, "\n[[case]]\nname = {}", quoted(result.requested));
        let story = story(module, result.property, trace);
        if let Some(first) = story.first().filter(|first| !first.start.is_empty()) {
            let _ = writeln!(text, "init = {}", table(&plain(&first.start)));
        }
        for change in &story {
            step(&mut text, change);
        }
    }
    any.then_some(text)
}

/// A step of a case.
pub fn step(text: &mut String, change: &Change) {
    let _ = writeln!(text, "[[case.step]]");
    if !change.set.is_empty() {
        let _ = writeln!(text, "set = {}", table(&plain(&change.set)));
    }
    if !change.buffers.is_empty() {
        let words = change.buffers.iter();
        let words =
            words.map(|(module, address, value)| format!("\"{module}:{address}\" = {value}"));
        let words: Vec<String> = words.collect();
        let _ = writeln!(text, "bfm = {{ {} }}", words.join(", "));
    }
    let _ = writeln!(text, "scans = {}", change.scans);
    let _ = writeln!(text, "scan_ms = {}", change.scan_ms);
    if !change.after.is_empty() {
        let _ = writeln!(text, "expect = {}", table(&plain(&change.after)));
    }
}

fn plain(values: &[Setting]) -> Vec<(String, i64)> {
    let values = values.iter();
    values
        .map(|(name, _, value)| (name.clone(), *value))
        .collect()
}

/// Devices and their values, as a table of TOML.
pub fn table(values: &[(String, impl std::fmt::Display)]) -> String {
    let values = values.iter();
    let values: Vec<String> = values
        .map(|(name, value)| match name.contains('.') {
            true => format!("{} = {value}", quoted(name)),
            false => format!("{name} = {value}"),
        })
        .collect();
    format!("{{ {} }}", values.join(", "))
}

/// A text as TOML has it.
pub fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// The program as seen from the test file's folder.
pub fn relative(program: &Path, test: &Path) -> String {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
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
