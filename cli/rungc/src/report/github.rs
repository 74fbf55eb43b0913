//! Workflow commands of GitHub Actions, which mark places in the files of a change.

use super::Findings;
use super::location::Location;
use anstream::adapter::strip_str;
use rungc_syntax::Severity;
use rungc_syntax::text::acts;
use std::path::Path;

/// An annotation for each finding about a program.
pub fn findings(findings: &Findings) -> String {
    let annotations = findings.diagnostics.iter().map(|d| {
        let place = Location::of(findings, d.span).unwrap_or_default();
        let level = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "notice",
        };
        let step = match place.step.filter(|_| place.line.is_none()) {
            Some(step) => format!("step {step}: "),
            None => String::new(),
        };
        let help = match &d.help {
            Some(help) => format!("\nHelp: {help}"),
            None => String::new(),
        };
        annotation(
            level,
            findings.path,
            place.line,
            d.code,
            &format!("{step}{}{help}", d.message),
        )
    });
    annotations.collect()
}

/// A command that marks a line of a file, or the file.
pub fn annotation(level: &str, file: &Path, line: Option<u32>, title: &str, text: &str) -> String {
    let file = file.to_string_lossy().replace('\\', "/");
    let line = line.map_or(String::new(), |line| format!(",line={line}"));
    format!(
        "::{level} file={}{line},title={}::{}\n",
        property(&file),
        property(title),
        data(text),
    )
}

/// The text of a command, as the runner reads it.
fn data(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in strip_str(text).to_string().chars() {
        match c {
            '%' => escaped.push_str("%25"),
            '\r' => escaped.push_str("%0D"),
            '\n' => escaped.push_str("%0A"),
            c if acts(c) => escaped.extend(c.escape_unicode()),
            c => escaped.push(c),
        }
    }
    escaped
}

/// A property of a command, which ends at a comma or colon.
fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::{data, property};

    #[test]
    fn what_ends_a_command_or_property_is_escaped() {
        assert_eq!(
            data("50 %: a, b\r\n::error::"),
            "50 %25: a, b%0D%0A::error::"
        );
        assert_eq!(property("a,b:c%\n"), "a%2Cb%3Ac%25%0A");
        assert_eq!(data("a\u{202e}b\u{9b}2J\t"), "a\\u{202e}b\\u{9b}2J\\u{9}");
    }
}
