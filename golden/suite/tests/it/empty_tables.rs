//! Emitted C of programs that lack one thing or another: no table in it is empty, which C does not know.

use rungc_codegen_c::{Options, emit};
use rungc_golden::module;
use rungc_models::ModelId;
use std::path::Path;
use std::process::Command;

/// Programs, each of which leaves some table without an entry: one without anything; without inputs, outputs, errors,
/// texts, latched
/// devices or instructions; with a port that speaks no protocol, that speaks one, that is named only; with pulses and
/// nothing else.
const PROGRAMS: [(ModelId, &str); 13] = [
    (ModelId::Fx2n, "END\n"),
    (ModelId::H2u, "END\n"),
    (ModelId::Hm, "END\n"),
    (ModelId::Fx2n, "LD X0\nOUT Y0\nEND\n"),
    (ModelId::Fx2n, "LD X0\nOUT M0\nEND\n"),
    (ModelId::Fx2n, "LD M0\nOUT Y0\nEND\n"),
    (ModelId::Fx2n, "LD M8000\nOUT C235 K5\nEND\n"),
    (ModelId::H2u, "LD M8002\nMOV H81 D8120\nEND\n"),
    (ModelId::H1u, "LD M8002\nMOV H81 D8120\nEND\n"),
    (ModelId::H2u, "LD M8002\nMOV H81 D8120\nMOV H2 D8126\nEND\n"),
    (ModelId::H2u, "LD M8000\nMOV D8126 D0\nEND\n"),
    (ModelId::H2u, "LD M8000\nPLSY K1000 K0 Y0\nEND\n"),
    (ModelId::Fx3u, "LD M8000\nRS D0 K0 D100 K10\nEND\n"),
];

/// Checks the sources in a folder with a compiler.
fn compile(folder: &Path, compiler: &str) -> Result<(), String> {
    let line = format!(
        "set -e; for file in *.c; do {compiler} -std=c99 -Wall -Wextra -Wconversion -pedantic -Werror -fsyntax-only \"$file\"; done"
    );
    let done = Command::new("sh")
        .args(["-c", &line])
        .current_dir(folder)
        .output()
        .map_err(|error| error.to_string())?;
    match done.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&done.stderr).into_owned()),
    }
}

#[test]
fn programs_that_lack_something_compile() {
    for (model, text) in PROGRAMS {
        let module = module(text, model);
        let all = [
            Options::default(),
            Options {
                main: true,
                ..Options::default()
            },
            Options {
                main: true,
                servers: true,
                ..Options::default()
            },
            Options {
                board: true,
                access: true,
                retain: true,
                ..Options::default()
            },
        ];
        for options in all {
            let folder = tempfile::tempdir().expect("a temporary folder");
            for file in emit(&module, &options) {
                let path = folder.path().join(&file.path);
                if file.path.starts_with("rungc-rt/") {
                    continue;
                }
                assert!(
                    !file.contents.contains("[] = {}") && !file.contents.contains("[] = {\n}"),
                    "{text}: {} has an empty table",
                    file.path
                );
                std::fs::create_dir_all(path.parent().expect("a folder")).expect("writing");
                std::fs::write(path, file.contents).expect("writing");
            }
            for compiler in ["gcc", "clang"] {
                compile(folder.path(), compiler)
                    .unwrap_or_else(|error| panic!("{compiler}, {options:?}:\n{text}{error}"));
            }
        }
    }
}
