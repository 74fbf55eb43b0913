//! Diagnostics as SARIF 2.1.0, for code scanning services.

use super::Findings;
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Diagnostic, Severity, Span};
use serde_sarif::sarif::{
    ArtifactLocation, Location, Message, MultiformatMessageString, PhysicalLocation, Region,
    ReportingDescriptor, Result as Item, ResultLevel, Run, Sarif, Tool, ToolComponent, Version,
};
use std::collections::BTreeSet;
use std::io;

/// The log as pretty-printed text.
pub fn render(findings: &Findings) -> io::Result<String> {
    let used: BTreeSet<&str> = findings.diagnostics.iter().map(|d| d.code).collect();
    let rules: Vec<ReportingDescriptor> = codes::all()
        .into_iter()
        .filter(|code| used.contains(code.id))
        .map(rule)
        .collect();
    let driver = ToolComponent::builder()
        .name("rungc")
        .version(env!("CARGO_PKG_VERSION"))
        .rules(rules)
        .build();
    let results: Vec<Item> = findings
        .diagnostics
        .iter()
        .map(|d| item(findings, d))
        .collect();
    let run = Run::builder()
        .tool(Tool::builder().driver(driver).build())
        .results(results)
        .build();
    let log = Sarif::builder()
        .schema("https://json.schemastore.org/sarif-2.1.0.json")
        .version(Version::V2_1_0.to_string())
        .runs(vec![run])
        .build();
    Ok(serde_json::to_string_pretty(&log)?)
}

/// What a code means, for those who see only the log.
fn rule(code: &Code) -> ReportingDescriptor {
    let text = |text: &str| MultiformatMessageString::builder().text(text).build();
    let mut help = code.text.to_string();
    for (title, list) in [("Wrong", code.wrong), ("Right", code.right)] {
        if !list.is_empty() {
            help = format!("{help}\n\n{title}:\n\n{}", list.trim_end());
        }
    }
    ReportingDescriptor::builder()
        .id(code.id)
        .name(code.name)
        .short_description(text(code.title))
        .full_description(text(code.text))
        .help(text(&help))
        .build()
}

fn item(findings: &Findings, d: &Diagnostic) -> Item {
    let level = match d.severity {
        Severity::Error => ResultLevel::Error,
        Severity::Warning => ResultLevel::Warning,
    };
    let mut text = d.message.clone();
    if let Some(help) = &d.help {
        text = format!("{text}\n\nHelp: {help}");
    }
    let related: Vec<Location> = d
        .others
        .iter()
        .map(|o| location(findings, o.span, Some(&o.text)))
        .collect();
    Item::builder()
        .rule_id(d.code)
        .level(level)
        .message(message(&text))
        .locations(vec![location(findings, d.span, None)])
        .related_locations(related)
        .build()
}

fn message(text: &str) -> Message {
    Message::builder().text(text).build()
}

fn location(findings: &Findings, span: Span, text: Option<&str>) -> Location {
    let (line, column) = findings.program.source.line_col(span.start);
    let (end_line, end_column) = findings.program.source.line_col(span.end);
    let region = Region::builder()
        .start_line(i64::from(line))
        .start_column(i64::from(column))
        .end_line(i64::from(end_line))
        .end_column(i64::from(end_column))
        .build();
    let uri = findings.path.to_string_lossy().replace('\\', "/");
    let artifact = ArtifactLocation::builder().uri(uri).build();
    let physical = PhysicalLocation::builder()
        .artifact_location(artifact)
        .region(region)
        .build();
    match text {
        Some(text) => Location::builder()
            .physical_location(physical)
            .message(message(text))
            .build(),
        None => Location::builder().physical_location(physical).build(),
    }
}
