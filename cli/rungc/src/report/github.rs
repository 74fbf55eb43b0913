//! Workflow commands of GitHub Actions, which mark places in the files of a change.

use super::Findings;
use anstream::adapter::strip_str;
use rungc::location::{Location, named};
use rungc_syntax::Severity;
use rungc_syntax::text::acts;
use std::path::Path;

/// An annotation for each finding about a program.
pub fn findings(findings: &Findings) -> String {
    let annotations = findings.diagnostics.iter().map(|d| {
        let place = findings.location(d.span).unwrap_or_default();
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
            &place,
            d.code,
            &format!("{step}{}{help}", d.message),
        )
    });
    annotations.collect()
}

/// A command that marks a place in a file, or the file.
pub fn annotation(level: &str, file: &Path, place: &Location, title: &str, text: &str) -> String {
    let file = place.file.clone().unwrap_or_else(|| named(file));
    let file = file.replace(std::path::MAIN_SEPARATOR, "/");
    format!(
        "::{level} file={}{},title={}::{}\n",
        property(&file),
        region(place),
        property(title),
        data(text),
    )
}

/// The properties of a place: lines, and the columns of a place in one line. GitHub does not accept columns of
/// different lines.
fn region(place: &Location) -> String {
    let one_line = place.end_line.is_none_or(|end| Some(end) == place.line);
    let lines = [("line", place.line), ("endLine", place.end_line)];
    let columns = [("col", place.column), ("endColumn", place.end_column)];
    let columns = columns.into_iter().filter(|_| one_line);
    let known = lines.into_iter().chain(columns);
    let known = known.filter_map(|(name, value)| Some(format!(",{name}={}", value?)));
    known.collect()
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
    use super::{annotation, data, property};
    use rungc::location::Location;
    use std::path::Path;

    #[test]
    fn columns_are_those_of_one_line() {
        let place = |lines: [Option<u32>; 2], columns: [Option<u32>; 2]| {
            let place = Location {
                line: lines[0],
                end_line: lines[1],
                column: columns[0],
                end_column: columns[1],
                ..Location::default()
            };
            annotation("error", Path::new("a.il"), &place, "E0101", "text")
        };
        insta::assert_snapshot!(
            [
                place([Some(2), Some(2)], [Some(5), Some(8)]),
                place([Some(2), Some(3)], [Some(5), Some(1)]),
                place([Some(2), Some(2)], [None; 2]),
                place([Some(2), None], [None; 2]),
                place([None; 2], [None; 2]),
            ]
            .concat(),
            @r"
        ::error file=a.il,line=2,endLine=2,col=5,endColumn=8,title=E0101::text
        ::error file=a.il,line=2,endLine=3,title=E0101::text
        ::error file=a.il,line=2,endLine=2,title=E0101::text
        ::error file=a.il,line=2,title=E0101::text
        ::error file=a.il,title=E0101::text
        "
        );
    }

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
