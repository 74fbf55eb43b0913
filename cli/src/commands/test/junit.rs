//! Results of tests as JUnit XML: a suite for each file; a case's class is its file and engine.

use super::report::{Results, kind, message};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use rungc_sim::plctest::{Failure, Outcome};
use std::io;
use std::time::Duration;

type Xml = Writer<Vec<u8>>;

/// The XML of a run.
pub fn junit(results: &Results) -> io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 4);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let all: Vec<&Outcome> = results.report.outcomes.iter().collect();
    let counts = Counts::of(&all);
    xml.create_element("testsuites")
        .with_attributes([
            ("name", "rungc test"),
            ("tests", &counts.tests),
            ("skipped", "0"),
            ("failures", &counts.failures),
            ("errors", &counts.errors),
            ("time", &seconds(results.elapsed)),
        ])
        .write_inner_content(|xml| {
            (0..results.suite.files().len()).try_for_each(|file| suite(xml, results, file))
        })?;
    xml.write_indent()?;
    String::from_utf8(xml.into_inner()).map_err(io::Error::other)
}

/// How many cases there are and what became of them, as attributes.
struct Counts {
    tests: String,
    failures: String,
    errors: String,
}

impl Counts {
    fn of(outcomes: &[&Outcome]) -> Self {
        let failures = outcomes.iter().filter_map(|o| o.failure.as_ref());
        let (errors, failures): (Vec<_>, Vec<_>) = failures.partition(|f| is_error(f));
        Counts {
            tests: outcomes.len().to_string(),
            failures: failures.len().to_string(),
            errors: errors.len().to_string(),
        }
    }
}

/// Whether the test could not run, as opposed to having failed.
fn is_error(failure: &Failure) -> bool {
    matches!(failure, Failure::Engine { .. })
}

/// The cases of a file, which has this number.
fn suite(xml: &mut Xml, results: &Results, number: usize) -> io::Result<()> {
    let name = clean(&results.suite.files()[number].name);
    let outcomes = results.report.outcomes.iter();
    let outcomes: Vec<_> = outcomes.filter(|o| o.id.file == number).collect();
    let counts = Counts::of(&outcomes);
    let time: Duration = outcomes.iter().map(|outcome| outcome.elapsed).sum();
    let element = xml.create_element("testsuite").with_attributes([
        ("name", &*name),
        ("tests", &counts.tests),
        ("skipped", "0"),
        ("errors", &counts.errors),
        ("failures", &counts.failures),
        ("time", &seconds(time)),
    ]);
    if outcomes.is_empty() {
        element.write_empty()?;
    } else {
        element.write_inner_content(|xml| {
            outcomes
                .iter()
                .try_for_each(|outcome| case(xml, results, outcome))
        })?;
    }
    Ok(())
}

fn case(xml: &mut Xml, results: &Results, outcome: &Outcome) -> io::Result<()> {
    let file = &results.suite.files()[outcome.id.file];
    let name = clean(&file.cases[outcome.id.case].name);
    let class = clean(&format!("{} [{}]", file.name, outcome.engine));
    let element = xml.create_element("testcase").with_attributes([
        ("name", &*name),
        ("classname", &class),
        ("time", &seconds(outcome.elapsed)),
    ]);
    let Some(failure) = &outcome.failure else {
        element.write_empty()?;
        return Ok(());
    };
    let tag = match is_error(failure) {
        true => "error",
        false => "failure",
    };
    element.write_inner_content(|xml| {
        xml.create_element(tag)
            .with_attributes([
                ("message", &*clean(&message(failure))),
                ("type", kind(failure)),
            ])
            .write_text_content(BytesText::new(&clean(&outcome.describe(results.suite))))?;
        Ok(())
    })?;
    Ok(())
}

fn seconds(time: Duration) -> String {
    format!("{:.3}", time.as_secs_f64())
}

/// A text without escape sequences and the characters that XML 1.0 cannot represent.
fn clean(text: &str) -> String {
    let text = anstream::adapter::strip_str(text).to_string();
    text.replace(
        |c| matches!(c, '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\u{fffe}' | '\u{ffff}'),
        "",
    )
}

#[cfg(test)]
mod tests {
    use super::clean;

    #[test]
    fn what_xml_cannot_hold_is_left_out() {
        assert_eq!(
            clean("\x1b[1mred\x1b[0m\tlamp\0\x08 <1>\n"),
            "red\tlamp <1>\n"
        );
    }
}
