//! Real projects are checked without errors.

use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_frontend::read;
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Severity, codes};
use std::path::{Path, PathBuf};

/// Projects that the PLC rejects too: the end of the path, the code, and why.
const REFUSED: &[(&str, &str, &str)] = &[
    (
        "DHSCS/Resource/POU/Body/MAIN.wpg",
        "E0110",
        "DHSCS takes high-speed counters only, the example names C0",
    ),
    (
        "FEND/Resource/Pou/Body/MAIN.wpg",
        "E0424",
        "the subroutine of the example has no SRET",
    ),
];

fn projects(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("folder of the corpus") {
        let path = entry.expect("entry of the folder").path();
        let extension = path
            .extension()
            .and_then(|ext| ext.to_str())
            .unwrap_or("")
            .to_ascii_lowercase();
        if path.is_dir() {
            projects(&path, found);
        } else if matches!(extension.as_str(), "csv" | "wpg" | "gxw" | "il") {
            found.push(path);
        }
    }
}

#[test]
fn real_projects_have_no_errors() {
    let corpus = Path::new(env!("RUNGC_ROOT")).join("../shared/corpus");
    if !corpus.is_dir() {
        println!("skipped: there is no corpus beside the repository");
        return;
    }
    let mut paths = Vec::new();
    projects(&corpus, &mut paths);
    paths.sort();
    assert!(!paths.is_empty());
    let mut wrong = Vec::new();
    for path in &paths {
        let Ok(read) = read(path) else {
            wrong.push(format!("{} cannot be read", path.display()));
            continue;
        };
        let options = CompileOptions::default();
        let checked = compile::check(&read.program, &options);
        let compiled = compile::compile(&read.program, &options);
        if checked.diagnostics.has_errors() != compiled.diagnostics.has_errors() {
            wrong.push(format!("{}: check and build disagree", path.display()));
        }
        let id = read
            .program
            .cpu
            .as_deref()
            .and_then(ModelId::from_cpu)
            .unwrap_or(ModelId::Fx3u);
        let (resolved, mut diagnostics) = resolve(&read.program, Model::get(id));
        diagnostics.extend(check(&resolved).sorted());
        diagnostics.extend(read.diagnostics.sorted());
        for diagnostic in diagnostics.sorted() {
            let refused = |(end, code, _): &(&str, &str, &str)| {
                path.ends_with(end) && diagnostic.code == *code
            };
            // A missing feature of the compiler is not the project's fault.
            let lacking = diagnostic.code == codes::NOT_IMPLEMENTED.id;
            if diagnostic.severity == Severity::Error && !lacking && !REFUSED.iter().any(refused) {
                let line = read.program.source.line_col(diagnostic.span.start).0;
                wrong.push(format!(
                    "{}:{line}: {} {}",
                    path.display(),
                    diagnostic.code,
                    diagnostic.message
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
