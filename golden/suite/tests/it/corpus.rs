//! Programs that people made with the vendor's editors: each is read, checked, emitted in both languages and run.
//!
//! They are beside this repository, not part of it; without them there is nothing to test.

use rungc_codegen_c::runtime_calls;
use rungc_frontend::Read;
use rungc_interp::Machine;
use rungc_ir::{Module, validate};
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Program, VirtualHal};
use rungc_syntax::{Severity, codes};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Scans that each program runs.
const SCANS: u32 = 100;

/// Projects that are wrong in themselves, and the code that says how.
const WRONG: [(&str, &str); 3] = [
    // DHSCS on C0, which is not a high-speed counter.
    ("/DHSCS/", "E0110"),
    // A subroutine that runs into END without SRET.
    ("/FEND/", "E0424"),
    // A project for a Q03UD.
    ("hyun-ks+PLC_test/", "E0018"),
];

/// The folder of this name beside the repository; `None`, with a message, where there is none.
fn folder(name: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("../shared").join(name);
    if !folder.is_dir() {
        println!("skipped: there is no folder {name} beside this repository");
        return None;
    }
    Some(folder)
}

/// All programs in a folder.
fn programs(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        if path.is_dir() {
            programs(&path, found);
        } else if ["wpg", "gxw", "csv"].iter().any(|e| ending == *e) {
            found.push(path);
        }
    }
}

/// A program and what became of it.
struct Sample {
    name: String,
    read: Read,
    module: Option<Module>,
    fate: String,
}

fn sample(index: usize, root: &Path, path: &Path) -> Sample {
    let name = path.strip_prefix(root).unwrap().display().to_string();
    let read = rungc_frontend::read(path).unwrap_or_else(|e| panic!("{name}: {e}"));
    let expected = WRONG.iter().find(|(part, _)| name.contains(part));
    let found: Vec<_> = read
        .diagnostics
        .iter()
        .map(|d| (d.code, &d.message))
        .collect();
    if read.diagnostics.has_errors() {
        let codes: Vec<_> = found.iter().map(|(code, _)| *code).collect();
        assert_eq!(
            Some(codes),
            expected.map(|(_, code)| vec![*code]),
            "{name}: {found:?}"
        );
        return Sample {
            fate: format!("is rejected: {}", found[0].1),
            name,
            read,
            module: None,
        };
    }
    assert!(!read.program.instrs.is_empty(), "{name} is empty");
    let options = CompileOptions {
        name: Some(format!("program{index}")),
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    let cpu = read.program.cpu.as_deref();
    let named = cpu.and_then(ModelId::from_cpu);
    assert_eq!(named, Some(compiled.model.id), "{name}: CPU {cpu:?}");
    for d in compiled.diagnostics.iter() {
        assert_ne!(d.code, codes::STEPS_DIFFER.id, "{name}: {}", d.message);
    }
    let errors: Vec<_> = compiled
        .diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .collect();
    let unfinished = errors
        .iter()
        .all(|d| d.message.contains("cannot be compiled"));
    let fate = match (expected, &compiled.module) {
        (None, Some(module)) => {
            validate::validate(module).unwrap_or_else(|e| panic!("{name}: {e}"));
            format!("{} steps", compiled.steps)
        }
        (None, None) if unfinished => format!("compiles later: {}", errors[0].message),
        (Some((_, code)), None) if errors.iter().all(|d| d.code == *code) => {
            format!("is wrong: {}", errors[0].message)
        }
        _ => {
            let messages: Vec<_> = errors.iter().map(|d| (d.code, &d.message)).collect();
            panic!("{name}: {messages:?}")
        }
    };
    Sample {
        name,
        read,
        module: compiled.module,
        fate,
    }
}

/// Both forms of one program hold the same instructions.
fn same_instructions(samples: &[Sample]) {
    let lists: BTreeMap<_, _> = samples
        .iter()
        .filter(|s| s.name.starts_with("fx2n-list"))
        .map(|s| {
            let instrs = s.read.program.instrs.iter().map(|instr| {
                let operands = instr.operands.iter().map(|o| o.kind.to_string());
                (instr.mnemonic.clone(), operands.collect::<Vec<_>>())
            });
            (s.name.clone(), instrs.collect::<Vec<_>>())
        })
        .collect();
    let project = lists.iter().find(|(name, _)| name.ends_with(".gxw"));
    let export = lists.iter().find(|(name, _)| name.ends_with(".csv"));
    let (Some((_, project)), Some((_, export))) = (project, export) else {
        panic!("the project or its export is missing: {:?}", lists.keys());
    };
    assert_eq!(project, export);
}

fn run(name: &str, module: &Module) {
    let mut machine = Machine::new(module);
    let mut hal = VirtualHal::new();
    for scan in 0..SCANS {
        let now = scan * 10;
        hal.advance_to(now);
        machine.scan(&mut hal, now, 10_000);
        assert!(
            !machine.watchdog_tripped(),
            "{name}: scan {scan} does not end"
        );
    }
}

/// Writes every program as a user would get it, and compiles all of them in one go.
fn build_c(folder: &str, modules: &[&Module]) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{folder}-c"));
    let mut sources = Vec::new();
    for module in modules {
        let options = rungc_codegen_c::Options::default();
        for file in rungc_codegen_c::emit(module, &options) {
            let path = folder.join(&module.name).join(&file.path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &file.contents).unwrap();
            if path.extension().is_some_and(|e| e == "c") {
                sources.push(path);
            }
        }
    }
    let compiler = Command::new("gcc").arg("--version").output();
    if compiler.is_err() {
        println!("not compiled: there is no gcc");
        return;
    }
    let flags = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror"];
    let output = Command::new("gcc")
        .args(flags)
        .args(["-O1", "-c"])
        .args(&sources)
        .current_dir(&folder)
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{printed}");
}

#[test]
fn every_program_is_read_emitted_and_run() {
    let Some(root) = folder("corpus") else { return };
    let samples = samples(&root);
    assert!(samples.len() >= 50, "only {} programs", samples.len());
    same_instructions(&samples);
    emit_and_run("corpus", &samples);
}

#[test]
fn every_other_project_is_read_emitted_and_run() {
    let Some(root) = folder("projects") else {
        return;
    };
    let samples = samples(&root);
    assert!(samples.len() >= 15, "only {} projects", samples.len());
    emit_and_run("projects", &samples);
}

/// The programs of a folder that compile, by their paths in it.
fn modules(root: &Path) -> Vec<(String, Module)> {
    let mut paths = Vec::new();
    programs(root, &mut paths);
    paths.sort();
    let modules = paths.iter().filter_map(|path| {
        let read = rungc_frontend::read(path).ok()?;
        let module = compile(&read.program, &CompileOptions::default()).module?;
        Some((
            path.strip_prefix(root).unwrap().display().to_string(),
            module,
        ))
    });
    modules.collect()
}

/// The functions of the runtime because of which the C of a program takes more than a C compiler; none if it does not.
fn library_calls(module: &Module) -> Vec<&'static str> {
    let calls = runtime_calls(module).into_iter();
    let calls: Vec<_> = calls
        .filter(|call| !call.in_c)
        .map(|call| call.name)
        .collect();
    let files = rungc_codegen_c::emit(module, &rungc_codegen_c::Options::default());
    let needs_cargo = files
        .iter()
        .any(|f| f.path.starts_with("rungc-rt/") || f.contents.contains("cargo"));
    assert_eq!(needs_cargo, !calls.is_empty(), "{}", module.source_name);
    calls
}

/// Least share of programs whose C needs no library, in per cent. Those that do have serial ports.
const LEAST_SHARE: usize = 95;

/// The C of nearly all programs needs a C compiler and nothing else.
#[test]
fn c_of_programs_needs_no_library() {
    let folders = ["corpus", "projects", "label-projects"];
    let modules: Vec<_> = folders
        .iter()
        .filter_map(|name| folder(name))
        .flat_map(|root| modules(&root))
        .collect();
    let with: Vec<_> = modules
        .iter()
        .map(|(name, module)| (name, library_calls(module)))
        .filter(|(_, calls)| !calls.is_empty())
        .collect();
    if modules.is_empty() {
        return;
    }
    let share = 100 * (modules.len() - with.len()) / modules.len();
    println!(
        "{share} % of {} need no library; these do: {with:#?}",
        modules.len()
    );
    assert!(share >= LEAST_SHARE, "{share} %, without {with:?}");
}

/// All programs in a folder, in the order of their paths.
fn samples(root: &Path) -> Vec<Sample> {
    let mut paths = Vec::new();
    programs(root, &mut paths);
    paths.sort();
    let samples = paths.iter().enumerate();
    samples.map(|(i, path)| sample(i, root, path)).collect()
}

fn emit_and_run(folder: &str, samples: &[Sample]) {
    for sample in samples {
        println!("{:<70} {}", sample.name, sample.fate);
        if let Some(module) = &sample.module {
            run(&sample.name, module);
            let options = rungc_codegen_rust::Options::default();
            let files = rungc_codegen_rust::emit(module, &options);
            assert!(
                files.iter().all(|f| !f.contents.is_empty()),
                "{}",
                sample.name
            );
        }
    }
    let modules: Vec<_> = samples.iter().filter_map(|s| s.module.as_ref()).collect();
    println!("{} of {} programs compile", modules.len(), samples.len());
    build_c(folder, &modules);
}
