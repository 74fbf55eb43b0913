//! Diagnostics as SARIF 2.1.0, for code scanning services.

use super::Findings;
use super::visible::to_json;
use rungc::location::Location;
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Diagnostic, Fix, Severity, Span};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, is_separator};

/// A log in the making.
#[derive(Default)]
pub struct Log {
    used: BTreeSet<&'static str>,
    results: Vec<Value>,
    artifacts: Vec<Value>,
    /// Verdicts of each program, and what they rest on.
    verifications: Vec<Value>,
    /// True if anything was added.
    begun: bool,
}

impl Log {
    /// Adds the findings about a file, which is in the list of artifacts if there can be `many`.
    pub fn add(&mut self, findings: &Findings, many: bool) {
        self.begun = true;
        let evidence = findings.verification.as_ref();
        self.verifications
            .extend(evidence.map(|evidence| json!(evidence)));
        self.used
            .extend(findings.diagnostics.iter().map(|d| d.code));
        let items = findings.diagnostics.iter().map(|d| item(findings, d));
        self.results.extend(items);
        if many {
            let place = artifact(findings.path);
            self.artifacts.push(json!({ "location": place }));
        }
    }

    /// Returns true if nothing was added.
    pub fn is_empty(&self) -> bool {
        !self.begun
    }

    /// The log as pretty-printed text.
    pub fn render(self) -> io::Result<String> {
        let rules: Vec<Value> = codes::all()
            .into_iter()
            .filter(|code| self.used.contains(code.id))
            .map(rule)
            .collect();
        let properties = match self.verifications.is_empty() {
            true => None,
            false => Some(json!({ "verifications": self.verifications })),
        };
        log(rules, self.results, self.artifacts, properties)
    }
}

/// A log of results as pretty-printed text.
pub fn log(
    rules: Vec<Value>,
    results: Vec<Value>,
    artifacts: Vec<Value>,
    properties: Option<Value>,
) -> io::Result<String> {
    let driver = json!({
        "name": "rungc",
        "informationUri": env!("CARGO_PKG_REPOSITORY"),
        "version": env!("CARGO_PKG_VERSION"),
        "rules": rules,
    });
    let mut run = json!({
        "tool": { "driver": driver },
        "results": results,
        "columnKind": "unicodeCodePoints",
    });
    if !artifacts.is_empty() {
        run["artifacts"] = artifacts.into();
    }
    if let Some(properties) = properties {
        run["properties"] = properties;
    }
    let log = json!({
        "$schema": "https://json.schemastore.org/sarif-2.1.0.json",
        "version": "2.1.0",
        "runs": [run],
    });
    to_json(&log)
}

/// Meaning of a code, for readers of the log alone.
fn rule(code: &Code) -> Value {
    let mut help = code.text.to_string();
    for (title, list) in [("Wrong", code.wrong), ("Right", code.right)] {
        if !list.is_empty() {
            help = format!("{help}\n\n{title}:\n\n{}", list.trim_end());
        }
    }
    json!({
        "id": code.id,
        "name": code.name,
        "shortDescription": { "text": code.title },
        "fullDescription": { "text": code.text },
        "help": { "text": help },
    })
}

fn item(findings: &Findings, d: &Diagnostic) -> Value {
    let level = match d.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    let mut text = d.message.to_string();
    if let Some(help) = &d.help {
        text = format!("{text}\n\nHelp: {help}");
    }
    let related: Vec<Value> = d
        .others
        .iter()
        .map(|o| location(findings, o.span, Some(&o.text)))
        .collect();
    let mut item = json!({
        "ruleId": d.code,
        "level": level,
        "message": { "text": text },
        "locations": [location(findings, d.span, None)],
        "relatedLocations": related,
    });
    if let Some(fix) = findings.fix(d) {
        item["fixes"] = json!([change(findings, fix)]);
    }
    if !d.devices.is_empty() {
        let devices: Vec<_> = d.devices.iter().map(ToString::to_string).collect();
        item["properties"] = json!({ "devices": devices });
    }
    item
}

/// A fix as a change of the file.
fn change(findings: &Findings, fix: &Fix) -> Value {
    let replacements = fix.edits.iter().filter_map(|edit| {
        let region = findings.location(edit.span).as_ref().and_then(region)?;
        Some(json!({
            "deletedRegion": region,
            "insertedContent": { "text": edit.text.as_str() },
        }))
    });
    json!({
        "description": { "text": fix.title.as_str() },
        "artifactChanges": [{
            "artifactLocation": artifact(findings.path),
            "replacements": replacements.collect::<Vec<_>>(),
        }],
    })
}

fn artifact(path: &Path) -> Value {
    json!({ "uri": uri(path) })
}

fn location(findings: &Findings, span: Span, text: Option<&str>) -> Value {
    let found = findings.location(span);
    let file = found.as_ref().and_then(|found| found.file.as_deref());
    let file = file.map_or(findings.path, Path::new);
    let mut physical = json!({ "artifactLocation": artifact(file) });
    if let Some(region) = found.as_ref().and_then(region) {
        physical["region"] = region;
    }
    let mut location = json!({ "physicalLocation": physical });
    if let Some(logical) = found.as_ref().and_then(logical) {
        location["logicalLocations"] = json!([logical]);
    }
    if let Some(text) = text {
        location["message"] = json!({ "text": text });
    }
    location
}

/// The lines and columns of a location in a text.
fn region(location: &Location) -> Option<Value> {
    let mut region = json!({ "startLine": location.line? });
    let rest = [
        ("startColumn", location.column),
        ("endLine", location.end_line),
        ("endColumn", location.end_column),
    ];
    for (name, value) in rest {
        if let Some(value) = value {
            region[name] = value.into();
        }
    }
    Some(region)
}

/// The step of a location in a project or an export, as its editor shows it.
fn logical(location: &Location) -> Option<Value> {
    let program = location.program.as_ref()?;
    Some(match location.step {
        Some(step) => json!({
            "name": format!("step {step}"),
            "fullyQualifiedName": format!("{program}/step {step}"),
            "kind": "member",
        }),
        None => json!({
            "name": program,
            "fullyQualifiedName": program,
            "kind": "module",
        }),
    })
}

/// A path as a URI reference: its separators as they are on the web, and everything escaped that has a meaning there or
/// none. A name that is not UTF-8 keeps its bytes.
pub fn uri(path: &Path) -> String {
    let bytes = path.as_os_str().as_encoded_bytes().iter();
    bytes.fold(String::new(), |mut uri, &byte| {
        match char::from(byte) {
            c if is_separator(c) => uri.push('/'),
            c if c.is_ascii_alphanumeric() || "-._~".contains(c) => uri.push(c),
            _ => uri.push_str(&format!("%{byte:02X}")),
        }
        uri
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

    /// In GBK, as archives from Chinese Windows leave them.
    #[cfg(unix)]
    #[test]
    fn names_that_are_not_utf8_stay_apart() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        let names: [&[u8]; 2] = [b"\xB5\xE7/1.il", b"\xBB\xFA/1.il"];
        let uris = names.map(|name| uri(Path::new(OsStr::from_bytes(name))));
        assert_eq!(uris, ["%B5%E7/1.il", "%BB%FA/1.il"]);
        assert_eq!(uri(Path::new("a\\b.il")), "a%5Cb.il");
    }
}
