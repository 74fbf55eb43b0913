//! Results of tests as workflow commands of GitHub Actions, which mark places in the files of a change.

use super::report::{Results, human, kind, message};
use anstream::adapter::strip_str;
use rungc_sim::plctest::Outcome;

/// An annotation for each case that failed, then what people read in the log.
pub fn github(results: &Results) -> String {
    let failed = results.report.failures();
    let mut text: String = failed.map(|outcome| annotation(results, outcome)).collect();
    text.push_str(&human(results));
    text
}

fn annotation(results: &Results, outcome: &Outcome) -> String {
    let file = &results.suite.files()[outcome.id.file];
    let name = &file.cases[outcome.id.case].name;
    let failure = outcome.failure.as_ref();
    let title = format!("{name} [{}]: {}", outcome.engine, failure.map_or("", kind));
    format!(
        "::error file={},line={},title={}::{}\n",
        property(&file.name.replace('\\', "/")),
        outcome.line(results.suite),
        property(&title),
        data(&failure.map_or(String::new(), message)),
    )
}

/// The text of a command, as the runner reads it.
fn data(text: &str) -> String {
    let text = strip_str(text).to_string();
    text.replace('%', "%25")
        .replace('\r', "%0D")
        .replace('\n', "%0A")
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
    }
}
