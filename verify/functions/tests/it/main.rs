//! Tests of functions and matrices.

mod functions;
mod library;
mod matrix;
mod proofs;

use rungc_functions::{Expanded, properties};
use rungc_project::Project;
use rungc_project::property::PropertyKind;
use rungc_syntax::Diagnostics;
use std::path::Path;

/// The properties of a text of rungc.toml in a folder.
fn read(folder: &Path, text: &str) -> Result<Vec<Expanded>, Diagnostics> {
    properties(&Project::parse(&folder.join("rungc.toml"), text).expect("a project"))
}

/// Properties as lines: name, then the property.
fn lines(properties: &[Expanded]) -> String {
    let line = |expanded: &Expanded| {
        let row = &expanded.row;
        let name = row.name.as_deref().unwrap_or_default();
        format!("{name}: {}\n", property(&row.kind))
    };
    properties.iter().map(line).collect()
}

fn property(kind: &PropertyKind) -> String {
    match kind {
        PropertyKind::Never(only) => format!("never {}", only.text),
        PropertyKind::Always(only) => format!("always {}", only.text),
        PropertyKind::Reachable(only) => format!("reachable {}", only.text),
        PropertyKind::Whenever { when, then, within } => {
            let within = within.as_ref().map_or("", |within| &within.text);
            format!("whenever {} then {} within {within}", when.text, then.text)
        }
        PropertyKind::Stays {
            after,
            holds,
            until,
        } => {
            let [after, until] =
                [after, until].map(|part| part.as_ref().map_or("", |part| &part.text));
            format!("stays {} after {after} until {until}", holds.text)
        }
    }
}

/// Mistakes, each with the text that it is about.
fn mistakes(folder: &Path, text: &str) -> String {
    let mistakes = match read(folder, text) {
        Ok(properties) => return format!("no mistake:\n{}", lines(&properties)),
        Err(mistakes) => mistakes.sorted(),
    };
    let line = |mistake: &rungc_syntax::Diagnostic| {
        let help = mistake.help.as_deref().unwrap_or("-");
        let at = &text[mistake.span.range()];
        format!("{at}: {} ({help})\n", mistake.message)
    };
    mistakes.iter().map(line).collect()
}
