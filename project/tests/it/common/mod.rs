//! Files and their mistakes.

use rungc_project::{Error, Project};
use std::fmt::Write;
use std::path::Path;

/// Reads a file.
pub fn parse(text: &str) -> Result<Project, Error> {
    Project::parse(Path::new("plant/rungc.toml"), text)
}

/// The mistakes of a file: code, place, message, quoted text, help.
pub fn mistakes(text: &str) -> String {
    let Err(Error::Invalid {
        text, diagnostics, ..
    }) = parse(text)
    else {
        panic!("no mistake is found in {text}");
    };
    let mut shown = String::new();
    for d in diagnostics.sorted() {
        let (line, column) = text.line_col(d.span.start);
        let quoted = text.slice(d.span);
        writeln!(shown, "{} {line}:{column} {} `{quoted}`", d.code, d.message).unwrap();
        if let Some(help) = d.help {
            writeln!(shown, "    help: {help}").unwrap();
        }
    }
    shown
}
