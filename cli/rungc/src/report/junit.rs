//! JUnit XML: suites of cases that passed, failed or could not be decided.

use super::Findings;
use super::visible::visible_xml;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};
use rungc::location::named;
use rungc_evidence::{Evidence, Verified};
use rungc_syntax::Severity;
use std::io;
use std::time::Duration;

type Xml = Writer<Vec<u8>>;

/// The cases of one file.
pub struct Suite {
    /// The file.
    pub name: String,
    /// Names and values of what all cases rest on.
    pub properties: Properties,
    pub cases: Vec<Case>,
}

/// Names and values.
pub type Properties = Vec<(&'static str, String)>;

/// One case.
pub struct Case {
    pub name: String,
    /// Group of the case, beside the file: servers group cases by it.
    pub class: String,
    /// Duration.
    pub time: Duration,
    /// Names and values of what it rests on.
    pub properties: Properties,
    /// Reason why it did not pass.
    pub problem: Option<Problem>,
}

/// Result of a case that did not pass.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Result {
    /// A bad verdict.
    Failed,
    /// No verdict.
    Error,
    /// Something else gives the verdict.
    Skipped,
}

/// Reason why a case did not pass.
pub struct Problem {
    /// Result.
    pub result: Result,
    /// The kind of problem, in a word.
    pub kind: &'static str,
    /// One line.
    pub message: String,
    /// All of it.
    pub text: String,
}

/// The errors of a program as cases that failed; without errors, one case that passed.
pub fn of_errors(findings: &Findings) -> Suite {
    let path = named(findings.path);
    let errors = findings.diagnostics.iter();
    let errors = errors.filter(|d| d.severity == Severity::Error);
    let case = |name: String, problem| Case {
        name,
        class: path.clone(),
        time: Duration::ZERO,
        properties: Properties::new(),
        problem,
    };
    let mut cases: Vec<Case> = errors
        .map(|d| {
            let place = findings.location(d.span).unwrap_or_default();
            let problem = Problem {
                result: Result::Failed,
                kind: d.code,
                message: d.message.to_string(),
                text: format!("{}: {}", place.headed(&path), d.message),
            };
            case(format!("{} {}", place.headed(&path), d.code), Some(problem))
        })
        .collect();
    if cases.is_empty() {
        cases.push(case("no errors".to_string(), None));
    }
    Suite {
        name: path,
        properties: Properties::new(),
        cases,
    }
}

/// Grounds of all verdicts about a program.
pub fn grounds(evidence: &Evidence) -> Properties {
    let subject = &evidence.subject;
    let mut properties = vec![
        ("rungc", evidence.rungc.clone()),
        ("model", subject.model.clone()),
        ("sha256", subject.sha256.clone()),
    ];
    let settings = evidence.settings.iter();
    properties.extend(settings.map(|setting| ("setting", setting.to_string())));
    let assumptions = evidence.assumptions.iter();
    properties.extend(assumptions.map(|line| ("assumption", line.clone())));
    properties
}

/// Grounds of a verdict.
pub fn properties(verified: &Verified) -> Properties {
    let mut properties = vec![("verdict", verified.verdict.to_string())];
    let requirement = verified.requirement.iter();
    properties.extend(requirement.map(|id| ("requirement", id.clone())));
    properties.extend(verified.method().map(|method| ("method", method)));
    let gaps = verified.gaps.iter();
    properties.extend(gaps.map(|gap| ("not modelled", gap.to_string())));
    let inputs = verified.inputs.iter();
    properties.extend(inputs.map(|inputs| ("inputs", inputs.to_string())));
    let run = verified.run.iter();
    properties.extend(run.map(|run| ("run", run.to_string())));
    properties
}

/// The XML of what `name` has run.
pub fn render(name: &str, suites: &[Suite]) -> io::Result<String> {
    let cases = suites.iter().flat_map(|suite| &suite.cases);
    render_timed(name, suites, cases.map(|case| case.time).sum())
}

/// The XML of a run that took this long.
pub fn render_timed(name: &str, suites: &[Suite], elapsed: Duration) -> io::Result<String> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 4);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let counts = Counts::of(suites.iter().flat_map(|suite| &suite.cases));
    xml.create_element("testsuites")
        .with_attributes([
            ("name", name),
            ("tests", &counts.tests),
            ("skipped", &counts.skipped),
            ("failures", &counts.failures),
            ("errors", &counts.errors),
            ("time", &seconds(elapsed)),
        ])
        .write_inner_content(|xml| suites.iter().try_for_each(|one| suite(xml, one)))?;
    xml.write_indent()?;
    let document = String::from_utf8(xml.into_inner()).map_err(io::Error::other)?;
    Ok(visible_xml(&document).into_owned())
}

/// Numbers of cases by result, as attributes.
struct Counts {
    tests: String,
    failures: String,
    errors: String,
    skipped: String,
}

impl Counts {
    fn of<'a>(cases: impl Iterator<Item = &'a Case>) -> Self {
        let (mut tests, mut failures, mut errors, mut skipped) = (0, 0, 0, 0);
        for case in cases {
            tests += 1;
            match case.problem.as_ref().map(|problem| problem.result) {
                Some(Result::Failed) => failures += 1,
                Some(Result::Error) => errors += 1,
                Some(Result::Skipped) => skipped += 1,
                None => {}
            }
        }
        Counts {
            tests: tests.to_string(),
            failures: failures.to_string(),
            errors: errors.to_string(),
            skipped: skipped.to_string(),
        }
    }
}

fn suite(xml: &mut Xml, suite: &Suite) -> io::Result<()> {
    let counts = Counts::of(suite.cases.iter());
    let time: Duration = suite.cases.iter().map(|case| case.time).sum();
    let element = xml.create_element("testsuite").with_attributes([
        ("name", &*clean(&suite.name)),
        ("tests", &counts.tests),
        ("skipped", &counts.skipped),
        ("errors", &counts.errors),
        ("failures", &counts.failures),
        ("time", &seconds(time)),
    ]);
    if suite.cases.is_empty() {
        element.write_empty()?;
    } else {
        element.write_inner_content(|xml| {
            write_properties(xml, &suite.properties)?;
            suite.cases.iter().try_for_each(|one| case(xml, one))
        })?;
    }
    Ok(())
}

fn write_properties(xml: &mut Xml, properties: &Properties) -> io::Result<()> {
    if properties.is_empty() {
        return Ok(());
    }
    xml.create_element("properties")
        .write_inner_content(|xml| {
            for (name, value) in properties {
                let property = xml.create_element("property");
                let property = property.with_attribute(("name", *name));
                property
                    .with_attribute(("value", &*clean(value)))
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}

fn case(xml: &mut Xml, case: &Case) -> io::Result<()> {
    let element = xml.create_element("testcase").with_attributes([
        ("name", &*clean(&case.name)),
        ("classname", &clean(&case.class)),
        ("time", &seconds(case.time)),
    ]);
    if case.problem.is_none() && case.properties.is_empty() {
        element.write_empty()?;
        return Ok(());
    }
    element.write_inner_content(|xml| {
        write_properties(xml, &case.properties)?;
        let Some(problem) = &case.problem else {
            return Ok(());
        };
        let tag = match problem.result {
            Result::Failed => "failure",
            Result::Error => "error",
            Result::Skipped => {
                let skipped = xml.create_element("skipped");
                let message = clean(&problem.message);
                skipped
                    .with_attribute(("message", &*message))
                    .write_empty()?;
                return Ok(());
            }
        };
        xml.create_element(tag)
            .with_attributes([
                ("message", &*clean(&problem.message)),
                ("type", problem.kind),
            ])
            .write_text_content(BytesText::new(&clean(&problem.text)))?;
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
