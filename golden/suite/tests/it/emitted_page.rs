//! The page of the book on emitted code: its examples are what is emitted.

use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag};
use rungc_lower::compile::{CompileOptions, compile};
use std::path::Path;

/// Blocks of code of the page: their languages and texts, in order.
fn blocks(page: &str) -> Vec<(String, String)> {
    let mut blocks: Vec<(String, String)> = Vec::new();
    let mut open = false;
    for event in Parser::new(page) {
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(language))) => {
                blocks.push((language.to_string(), String::new()));
                open = true;
            }
            Event::Text(text) if open => {
                if let Some((_, block)) = blocks.last_mut() {
                    block.push_str(&text);
                }
            }
            Event::End(_) => open = false,
            _ => {}
        }
    }
    blocks
}

/// Emitted sources of a list in C and in Rust.
fn emitted(text: &str) -> [String; 2] {
    let read = rungc_frontend::read_text("caught.il", text);
    let options = CompileOptions {
        optimise: true,
        ..CompileOptions::default()
    };
    let module = compile(&read.program, &options).module;
    let module = module.unwrap_or_else(|| panic!("it does not compile:\n{text}"));
    let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
    let rust = rungc_codegen_rust::emit(&module, &rungc_codegen_rust::Options::default());
    let c: Vec<_> = c.into_iter().map(|file| file.contents).collect();
    let rust: Vec<_> = rust.into_iter().map(|file| file.contents).collect();
    [c.concat(), rust.concat()]
}

#[test]
fn examples_are_what_is_emitted() {
    let path = Path::new(env!("RUNGC_ROOT")).join("docs/src/emitted-code.md");
    let page = std::fs::read_to_string(path).unwrap();
    let mut program: Option<[String; 2]> = None;
    let mut compared = 0;
    for (language, text) in blocks(&page) {
        let source = match (&*language, &program) {
            ("il", _) => {
                program = Some(emitted(&text));
                continue;
            }
            ("c", Some([source, _])) | ("rust", Some([_, source])) => source,
            _ => panic!("a block of {language} without a program"),
        };
        assert!(source.contains(&text), "not emitted:\n{text}");
        compared += 1;
    }
    assert!(compared >= 5, "{compared} examples");
}
