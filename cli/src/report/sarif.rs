//! Diagnostics as SARIF 2.1.0, for code scanning services.

use super::Findings;
use super::place::Place;
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Diagnostic, Fix, Severity, Span};
use serde_sarif::sarif::{
    Artifact, ArtifactChange, ArtifactContent, ArtifactLocation, Fix as SarifFix, Location,
    LogicalLocation, Message, MultiformatMessageString, PhysicalLocation, PropertyBag, Region,
    Replacement, ReportingDescriptor, Result as Item, ResultColumnKind, ResultLevel, Run, Sarif,
    Tool, ToolComponent, Version,
};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

/// A log in the making.
#[derive(Default)]
pub struct Log {
    used: BTreeSet<&'static str>,
    results: Vec<Item>,
    artifacts: Vec<Artifact>,
    /// Whether anything was added.
    begun: bool,
}

impl Log {
    /// Adds what was found about a file, which stands in the list of artifacts if there can be `many`.
    pub fn add(&mut self, findings: &Findings, many: bool) {
        self.begun = true;
        self.used
            .extend(findings.diagnostics.iter().map(|d| d.code));
        let items = findings.diagnostics.iter().map(|d| item(findings, d));
        self.results.extend(items);
        if many {
            let place = artifact(findings.path);
            self.artifacts
                .push(Artifact::builder().location(place).build());
        }
    }

    /// Whether nothing was added.
    pub fn is_empty(&self) -> bool {
        !self.begun
    }

    /// The log as pretty-printed text.
    pub fn render(self) -> io::Result<String> {
        let rules: Vec<ReportingDescriptor> = codes::all()
            .into_iter()
            .filter(|code| self.used.contains(code.id))
            .map(rule)
            .collect();
        let driver = ToolComponent::builder()
            .name("rungc")
            .version(env!("CARGO_PKG_VERSION"))
            .rules(rules)
            .build();
        let mut run = Run::builder()
            .tool(Tool::builder().driver(driver).build())
            .results(self.results)
            .column_kind(serde_json::to_value(ResultColumnKind::UnicodeCodePoints)?)
            .build();
        run.artifacts = Some(self.artifacts).filter(|artifacts| !artifacts.is_empty());
        let log = Sarif::builder()
            .schema("https://json.schemastore.org/sarif-2.1.0.json")
            .version(Version::V2_1_0.to_string())
            .runs(vec![run])
            .build();
        Ok(serde_json::to_string_pretty(&log)?)
    }
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
        Severity::Note => ResultLevel::Note,
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
    let mut item = Item::builder()
        .rule_id(d.code)
        .level(level)
        .message(message(&text))
        .locations(vec![location(findings, d.span, None)])
        .related_locations(related)
        .build();
    item.fixes = findings.fix(d).map(|fix| vec![change(findings, fix)]);
    if !d.devices.is_empty() {
        let devices: Vec<_> = d.devices.iter().map(ToString::to_string).collect();
        let bag = std::iter::once(("devices".to_owned(), devices.into()));
        let bag = PropertyBag::builder().additional_properties(bag.collect::<BTreeMap<_, _>>());
        item.properties = Some(bag.build());
    }
    item
}

/// A fix as a change of the file.
fn change(findings: &Findings, fix: &Fix) -> SarifFix {
    let replacements = fix.edits.iter().filter_map(|edit| {
        let region = Place::of(findings, edit.span).as_ref().and_then(region)?;
        let content = ArtifactContent::builder().text(edit.text.as_str()).build();
        let replacement = Replacement::builder().deleted_region(region);
        Some(replacement.inserted_content(content).build())
    });
    let change = ArtifactChange::builder()
        .artifact_location(artifact(findings.path))
        .replacements(replacements.collect::<Vec<_>>())
        .build();
    SarifFix::builder()
        .description(message(&fix.title))
        .artifact_changes(vec![change])
        .build()
}

fn message(text: &str) -> Message {
    Message::builder().text(text).build()
}

fn artifact(path: &Path) -> ArtifactLocation {
    ArtifactLocation::builder().uri(uri(path)).build()
}

fn location(findings: &Findings, span: Span, text: Option<&str>) -> Location {
    let place = Place::of(findings, span);
    let file = PhysicalLocation::builder().artifact_location(artifact(findings.path));
    let region = place.as_ref().and_then(region);
    let physical = match region {
        Some(region) => file.region(region).build(),
        None => file.build(),
    };
    let mut location = Location::builder().physical_location(physical).build();
    location.logical_locations = place
        .as_ref()
        .and_then(logical)
        .map(|logical| vec![logical]);
    location.message = text.map(message);
    location
}

/// The lines and columns of a place in a text.
fn region(place: &Place) -> Option<Region> {
    let mut region = Region::builder().build();
    region.start_line = Some(i64::from(place.line?));
    region.start_column = place.column.map(i64::from);
    region.end_line = place.end_line.map(i64::from);
    region.end_column = place.end_column.map(i64::from);
    Some(region)
}

/// The step of a place in a project or an export, as its editor shows it.
fn logical(place: &Place) -> Option<LogicalLocation> {
    let program = place.program.as_ref()?;
    let mut logical = LogicalLocation::builder().build();
    let (name, whole) = match place.step {
        Some(step) => (format!("step {step}"), format!("{program}/step {step}")),
        None => (program.clone(), program.clone()),
    };
    logical.name = Some(name);
    logical.fully_qualified_name = Some(whole);
    logical.kind = Some(
        if place.step.is_some() {
            "member"
        } else {
            "module"
        }
        .to_owned(),
    );
    Some(logical)
}

/// A path as a URI reference: its separators as they are on the web, and everything escaped that has a meaning there or none.
fn uri(path: &Path) -> String {
    let path = path.to_string_lossy().replace('\\', "/");
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte);
    path.bytes().fold(String::new(), |uri, byte| match byte {
        _ if plain(byte) => format!("{uri}{}", char::from(byte)),
        _ => format!("{uri}%{byte:02X}"),
    })
}

#[cfg(test)]
mod tests {
    use super::uri;
    use std::path::Path;

    #[test]
    fn paths_are_escaped() {
        assert_eq!(uri(Path::new("a b/电.il")), "a%20b/%E7%94%B5.il");
        assert_eq!(uri(Path::new("/plc/MAIN.wpg")), "/plc/MAIN.wpg");
    }
}
