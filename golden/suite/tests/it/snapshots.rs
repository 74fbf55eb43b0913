//! Output for the examples: IR, C and Rust.

use rungc_ir::{Module, dump};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use std::path::Path;

fn module(name: &str, model: ModelId) -> Module {
    let folder = Path::new(env!("RUNGC_ROOT")).join("examples/programs");
    let read = rungc_frontend::read(&folder.join(format!("{name}.il"))).unwrap();
    let options = CompileOptions {
        model: Some(model),
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let messages: Vec<_> = read
        .diagnostics
        .iter()
        .chain(compiled.diagnostics.iter())
        .map(|d| &d.message)
        .collect();
    assert!(messages.is_empty(), "{messages:?}");
    compiled.module.unwrap()
}

/// The files that differ from program to program, one below the other.
fn joined(files: impl Iterator<Item = (String, String)>) -> String {
    files
        .map(|(path, text)| format!("==== {path}\n{text}\n"))
        .collect()
}

/// The text with words in place of the stamps that it demands of shared headers, each of which must be the stamp of the
/// header that comes with it: they change with every function of the runtime.
fn without_stamps(text: &str, files: &[(String, String)]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    for line in &mut lines {
        if let Some(condition) = line.strip_prefix("#if ")
            && let Some((name, stamp)) = condition.split_once("_STAMP != ")
        {
            let definition = format!("#define {name}_STAMP {stamp}\n");
            let defined = files.iter().any(|(_, text)| text.contains(&definition));
            assert!(defined, "no header says {definition}");
            *line = format!("#if {name}_STAMP != [its stamp]");
        }
    }
    lines.join("\n") + "\n"
}

fn check(name: &str, model: ModelId) {
    let module = module(name, model);
    insta::assert_snapshot!(format!("{name}_ir"), dump::dump(&module));
    let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
    let c: Vec<_> = c.into_iter().map(|f| (f.path, f.contents)).collect();
    let own = |path: &str| {
        path.ends_with(".c") && !path.starts_with("rungc_") || path == format!("{name}.h")
    };
    let own = c.iter().filter(|(path, _)| own(path));
    let own = own.map(|(path, text)| (path.clone(), without_stamps(text, &c)));
    insta::assert_snapshot!(format!("{name}_c"), joined(own));
    let rust = rungc_codegen_rust::emit(&module, &rungc_codegen_rust::Options::default());
    let rust = rust.into_iter().map(|f| (f.path, f.contents));
    let sources = rust.filter(|(path, _)| path.starts_with("src/"));
    insta::assert_snapshot!(format!("{name}_rust"), joined(sources));
}

#[test]
fn motor() {
    check("motor", ModelId::Fx2n);
}

#[test]
fn traffic_light() {
    check("traffic_light", ModelId::Fx3u);
}

/// Rungs that are repeated become a loop.
#[test]
fn clamps() {
    check("clamps", ModelId::Fx3u);
}

/// The same with timers and counters.
#[test]
fn sections() {
    check("sections", ModelId::H2u);
}

/// Timers and counters that an index leads to.
#[test]
fn fillers() {
    check("fillers", ModelId::Fx3u);
}

#[test]
fn conveyor() {
    check("conveyor", ModelId::H2u);
}

#[test]
fn packer() {
    check("packer", ModelId::H2u);
}

#[test]
fn cutter() {
    check("cutter", ModelId::H2u);
}

/// A program reacts to an input between two scans.
#[test]
fn labels() {
    check("labels", ModelId::Fx3u);
}

#[test]
fn jumps() {
    check("jumps", ModelId::Fx3u);
}
