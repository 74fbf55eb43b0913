//! Names and comments with characters that would act on the emitted crate, its documentation or its manifest.

use crate::common;
use rungc_codegen_rust::emit;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_syntax::text::acts;

/// Names of files as people have them: an ideographic space, a combining accent as macOS stores it, a no-break space;
/// and worse.
const NAMES: [&str; 6] = [
    "传送带　控制.il",
    "tre\u{301}mie.il",
    "a\u{a0}b.il",
    "a\u{1b}[31m\u{200b}b.il",
    "\"quoted\" \\ 'name'.il",
    "a\u{202e}\n[dependencies]\nb.il",
];

const COMMENTS: &str = "a \u{202e} b\u{2066} \u{1b}[31mred <b>[link] `code` */ \\u{9b} \u{2028} \"";

fn module(source: &str) -> Module {
    let text = format!(
        ";! X000 = {COMMENTS}\n;! Y000 = {COMMENTS}\n; {COMMENTS}\nLD X000 ; {COMMENTS}\nOUT Y000 ; {COMMENTS}\nEND\n"
    );
    let read = rungc_frontend::read_text(source, text.as_str());
    let compiled = compile(&read.program, &CompileOptions::default());
    let diagnostics = compiled.diagnostics;
    compiled
        .module
        .unwrap_or_else(|| panic!("{source}: {diagnostics:?}"))
}

#[test]
fn manifests_hold_any_name() {
    for name in NAMES {
        let files = emit(&module(name), &common::options());
        let manifest = files.iter().find(|file| file.path == "Cargo.toml").unwrap();
        let manifest: toml::Table = manifest.contents.parse().unwrap();
        let description = manifest["package"]["description"].as_str().unwrap();
        let shown = name.replace(acts, " ");
        assert_eq!(description, format!("PLC program {shown}"));
        assert!(manifest.contains_key("dependencies") && manifest.len() == 3);
    }
}

#[test]
fn nothing_that_acts_reaches_emitted_text() {
    for name in NAMES {
        for file in emit(&module(name), &common::options()) {
            let found = file.contents.find(|c| acts(c) && c != '\n');
            assert_eq!(found, None, "{}:\n{}", file.path, file.contents);
        }
    }
}

#[test]
fn hostile_comments_build_and_document_without_warnings() {
    let folder = tempfile::tempdir().unwrap();
    common::write(folder.path(), &emit(&module(NAMES[3]), &common::options()));
    common::cargo(folder.path(), &["check"]);
    common::cargo(folder.path(), &["doc", "--no-deps"]);
}
