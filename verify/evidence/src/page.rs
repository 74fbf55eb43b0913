//! Evidence as a page: one file that needs nothing else.

use crate::matrix::{HEADS, Tone, row};
use crate::{Case, Evidence, Requirement, Run, Verified, words};
use rungc_ladder::html::{Escaped, STYLE};
use std::fmt::{self, Write};

/// Style in addition to that of pages with ladders.
const OWN: &str = include_str!("page.css");

/// The page.
pub fn page(evidence: &Evidence) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = write_page(&mut out, evidence);
    out
}

fn write_page(out: &mut String, evidence: &Evidence) -> fmt::Result {
    let subject = &evidence.subject;
    let title = Escaped(&subject.title);
    writeln!(
        out,
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Verification report: {title}</title>\n<style>\n{STYLE}{OWN}</style>\n</head>\n<body>\n\
         <header><h1>Verification report: {title}</h1>\n<p>{}, by rungc {}{}</p></header>\n<main>",
        Escaped(&subject.plc),
        Escaped(&evidence.rungc),
        match &evidence.date {
            Some(date) => format!(", {}", Escaped(date)),
            None => String::new(),
        }
    )?;
    write_matrix(out, evidence)?;
    write_missing(out, evidence)?;
    write_grounds(out, evidence)?;
    for (number, requirement) in (1..).zip(&evidence.requirements) {
        write_requirement(out, evidence, (number, requirement))?;
    }
    let mut others = evidence
        .properties
        .iter()
        .filter(|p| p.requirement.is_none());
    if let Some(first) = others.next() {
        writeln!(out, "<section>\n<h2>Properties without a requirement</h2>")?;
        for property in std::iter::once(first).chain(others) {
            write_property(out, property)?;
        }
        writeln!(out, "</section>")?;
    }
    write_tests(out, evidence)?;
    writeln!(out, "</main>\n</body>\n</html>")
}

/// A text whose parts in backticks are code.
struct Marked<'a>(&'a str);

impl fmt::Display for Marked<'_> {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let parts: Vec<&str> = self.0.split('`').collect();
        // A backtick without another one is itself.
        if parts.len().is_multiple_of(2) {
            return Escaped(self.0).fmt(f);
        }
        for (i, part) in parts.into_iter().enumerate() {
            match i % 2 {
                0 => Escaped(part).fmt(f)?,
                _ => write!(f, "<code>{}</code>", Escaped(part))?,
            }
        }
        Ok(())
    }
}

fn class(tone: Tone) -> &'static str {
    match tone {
        Tone::Good => "good",
        Tone::Bad => "bad",
        Tone::Open => "open",
    }
}

/// A table that scrolls where it is wider than the screen.
fn open_table(out: &mut String, label: &str, caption: &str, heads: &[&str]) -> fmt::Result {
    writeln!(
        out,
        "<div class=\"wide\" role=\"group\" aria-label=\"{label}\" tabindex=\"0\"><table>\n<caption>{caption}</caption>\n<thead><tr>"
    )?;
    for head in heads {
        write!(out, "<th scope=\"col\">{head}</th>")?;
    }
    writeln!(out, "</tr></thead>\n<tbody>")
}

fn close_table(out: &mut String) -> fmt::Result {
    writeln!(out, "</tbody>\n</table></div>")
}

fn write_matrix(out: &mut String, evidence: &Evidence) -> fmt::Result {
    writeln!(out, "<section>\n<h2>Requirements</h2>")?;
    if evidence.requirements.is_empty() {
        writeln!(
            out,
            "<p>The settings name no requirements: give properties in rungc.toml an <code>id</code>.</p>\n</section>"
        )?;
        return Ok(());
    }
    let heads = [&["Requirement", "Text"][..], &HEADS].concat();
    let caption = "“Proved” is short for: proved for this model under these assumptions.";
    open_table(out, "Requirements", caption, &heads)?;
    for (number, requirement) in (1..).zip(&evidence.requirements) {
        let id = Escaped(&requirement.id);
        write!(
            out,
            "<tr><th scope=\"row\"><a href=\"#r{number}\">{id}</a></th><td>{}</td>",
            Escaped(&requirement.text)
        )?;
        for cell in row(evidence, requirement) {
            let class = class(cell.tone);
            write!(out, "<td class=\"{class}\">{}</td>", Escaped(&cell.text))?;
        }
        writeln!(out, "</tr>")?;
    }
    close_table(out)?;
    writeln!(out, "</section>")
}

fn write_list(out: &mut String, lines: impl IntoIterator<Item = impl AsRef<str>>) -> fmt::Result {
    writeln!(out, "<ul>")?;
    for line in lines {
        writeln!(out, "<li>{}</li>", Marked(line.as_ref()))?;
    }
    writeln!(out, "</ul>")
}

fn write_missing(out: &mut String, evidence: &Evidence) -> fmt::Result {
    if evidence.missing.is_empty() {
        return Ok(());
    }
    writeln!(out, "<section class=\"missing\">\n<h2>What is missing</h2>")?;
    write_list(out, &evidence.missing)?;
    writeln!(out, "</section>")
}

/// Grounds of all verdicts: assumptions, program, settings.
fn write_grounds(out: &mut String, evidence: &Evidence) -> fmt::Result {
    writeln!(
        out,
        "<section>\n<h2>Assumptions</h2>\n<p>{}</p>",
        Escaped(words::SCOPE)
    )?;
    write_list(out, &evidence.assumptions)?;
    writeln!(out, "</section>\n<section>\n<h2>Program and settings</h2>")?;
    let subject = &evidence.subject;
    open_table(
        out,
        "Program and settings",
        "All that verdicts depend on.",
        &["Name", "Value"],
    )?;
    let mut line = |name: &str, value: &str| {
        writeln!(
            out,
            "<tr><th scope=\"row\">{name}</th><td>{}</td></tr>",
            Escaped(value)
        )
    };
    line("Program", &subject.file)?;
    line("SHA-256 of the program", &subject.sha256)?;
    line("PLC", &format!("{} ({})", subject.plc, subject.model))?;
    line("rungc", &evidence.rungc)?;
    for setting in &evidence.settings {
        line(setting.name, &setting.value)?;
    }
    close_table(out)?;
    let heads = ["File", "Part", "SHA-256"];
    open_table(out, "Files", "Files that were read.", &heads)?;
    for file in &subject.files {
        writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td><code>{}</code></td></tr>",
            Escaped(&file.file),
            file.role,
            file.sha256
        )?;
    }
    close_table(out)?;
    writeln!(out, "</section>")
}

fn write_requirement(
    out: &mut String,
    evidence: &Evidence,
    (number, requirement): (usize, &Requirement),
) -> fmt::Result {
    let id = Escaped(&requirement.id);
    writeln!(out, "<section id=\"r{number}\">\n<h2>{id}</h2>")?;
    for line in requirement.text.lines() {
        writeln!(out, "<p>{}</p>", Escaped(line))?;
    }
    if !requirement.source.is_empty() {
        let source = Escaped(&requirement.source);
        writeln!(out, "<p class=\"source\">Source: {source}</p>")?;
    }
    for line in words::lacks(evidence, requirement) {
        writeln!(out, "<p class=\"open\">{line}</p>")?;
    }
    let is_own = |p: &&Verified| p.requirement.as_deref() == Some(&requirement.id);
    for property in evidence.properties.iter().filter(is_own) {
        write_property(out, property)?;
    }
    if let Some(tests) = &evidence.tests {
        let cases = tests.cases.iter();
        let own = cases.filter(|case| case.requirements.contains(&requirement.id));
        let own: Vec<&Case> = own.collect();
        if !own.is_empty() {
            writeln!(out, "<h3>Tests</h3>")?;
            write_list(out, own.iter().map(ToString::to_string))?;
        }
    }
    writeln!(out, "</section>")
}

impl Verified {
    pub(crate) fn tone(&self) -> Tone {
        match self.holds {
            Some(true) => Tone::Good,
            Some(false) => Tone::Bad,
            None => Tone::Open,
        }
    }
}

fn write_property(out: &mut String, property: &Verified) -> fmt::Result {
    writeln!(
        out,
        "<h3><code>{}</code></h3>\n<p class=\"{}\">{}</p>",
        Escaped(&property.property),
        class(property.tone()),
        Marked(&words::verdict(property))
    )?;
    if let Some(method) = property.method() {
        writeln!(out, "<p>Method: {}.</p>", Escaped(&method))?;
    }
    if !property.gaps.is_empty() {
        writeln!(out, "<h4>Not modelled, any result possible</h4>")?;
        write_list(out, property.gaps.iter().map(ToString::to_string))?;
    }
    if !property.inputs.is_empty() {
        writeln!(out, "<h4>Devices that count as inputs</h4>")?;
        write_list(out, property.inputs.iter().map(ToString::to_string))?;
    }
    if !property.certificate.is_empty() {
        let heads = ["File", "Check", "SHA-256"];
        let caption = "Each formula must be unsatisfiable.";
        open_table(out, "Certificate", caption, &heads)?;
        for file in &property.certificate {
            writeln!(
                out,
                "<tr><th scope=\"row\">{}</th><td><code>{}</code></td><td><code>{}</code></td></tr>",
                Escaped(&file.file),
                Escaped(&file.check),
                file.sha256
            )?;
        }
        close_table(out)?;
    }
    match &property.run {
        Some(run) => write_run(out, run),
        None => Ok(()),
    }
}

fn write_run(out: &mut String, run: &Run) -> fmt::Result {
    let heads = ["Scans", "Begins", "Set"];
    let caption = "The run: scans in which nothing changes from outside are one row.";
    open_table(out, "Run", caption, &heads)?;
    for [scans, begins, set] in words::steps(run) {
        writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td></tr>",
            Escaped(&scans),
            Escaped(&begins),
            Escaped(&set)
        )?;
    }
    close_table(out)?;
    if let Some(diagram) = &run.diagram {
        let picture = diagram.svg();
        let label = "role=\"img\" aria-label=\"Timing diagram of the run in the table above\" ";
        let picture = picture.replacen("<svg ", &format!("<svg {label}"), 1);
        writeln!(
            out,
            "<figure class=\"diagram\" tabindex=\"0\">{picture}<figcaption>Timing diagram of the run</figcaption></figure>"
        )?;
    }
    for network in &run.networks {
        let picture = network.drawing.svg().to_string();
        let label = Escaped(&network.list).to_string();
        let label = format!("role=\"img\" aria-label=\"{label}\"");
        let picture = picture.replacen("role=\"img\"", &label, 1);
        writeln!(
            out,
            "<figure tabindex=\"0\">{picture}<figcaption>Network {} after the last scan; thick: power</figcaption></figure>",
            network.number
        )?;
    }
    Ok(())
}

fn write_tests(out: &mut String, evidence: &Evidence) -> fmt::Result {
    writeln!(out, "<section>\n<h2>Tests</h2>")?;
    let Some(tests) = &evidence.tests else {
        writeln!(out, "<p>Tests: not run.</p>\n</section>")?;
        return Ok(());
    };
    if let Some(coverage) = tests.coverage {
        let share = words::share(coverage);
        writeln!(out, "<p>Coverage of the program by all cases: {share}.</p>")?;
    }
    match tests.mutants {
        Some(mutants) => writeln!(
            out,
            "<p>Mutants of the program that a case notices: {}.</p>",
            words::share(mutants)
        )?,
        None => writeln!(out, "<p>Mutants: not run.</p>")?,
    }
    let heads = ["Case", "File", "Requirements", "Result"];
    open_table(out, "Test cases", "Cases on the interpreter.", &heads)?;
    for case in &tests.cases {
        let (class, result) = match &case.failure {
            None => ("good", "passed".to_string()),
            Some(failure) => ("bad", format!("failed: {failure}")),
        };
        writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td>{}:{}</td><td>{}</td><td class=\"{class}\">{}</td></tr>",
            Escaped(&case.name),
            Escaped(&case.file),
            case.line,
            Escaped(&case.requirements.join(", ")),
            Escaped(&result)
        )?;
    }
    close_table(out)?;
    writeln!(out, "</section>")
}
