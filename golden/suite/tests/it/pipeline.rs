//! The whole way from text to execution withstands any input: nothing panics, nothing hangs, and what compiles is
//! sound.
//!
//! Random lines of valid mnemonics with operands of every kind, and conformance programs with random damage, are read,
//! compiled for the models and, where a module comes of it, validated, printed, emitted in both languages and run.
//! Lines that the compiler finds fault with are taken out until the rest compiles, so that the later stages see strange
//! programs as well.
//!
//! The environment variables `RUNGC_RANDOM_PROGRAMS` and `RUNGC_RANDOM_SEED` make it longer, or another one.

use rungc_catalogue::{Inst, Param};
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_ir::{Module, dump, validate};
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, Plc, Program, VirtualHal};
use rungc_sim::plctest;
use rungc_syntax::{Classes, DeviceClass, Severity, codes};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::mpsc;
use std::time::Duration;

/// Scans that each module runs.
const SCANS: u32 = 20;

/// Number of times that faulty lines are removed from a program.
const REPAIRS: u32 = 6;

/// Time limit for one program: far longer than any needs.
const PATIENCE: Duration = Duration::from_secs(300);

fn setting(name: &str, default: u64) -> u64 {
    let text = std::env::var(format!("RUNGC_RANDOM_{name}"));
    text.ok().and_then(|t| t.parse().ok()).unwrap_or(default)
}

/// Lines of structure, drawn more often than their share of the catalogue.
const STRUCTURE: [&str; 38] = [
    "LD X0",
    "LDI M1",
    "LDP X2",
    "LD T0",
    "LD>= D0 K5",
    "AND M2",
    "ANI C0",
    "OR M3",
    "ORF X1",
    "ANB",
    "ORB",
    "MPS",
    "MRD",
    "MPP",
    "INV",
    "OUT Y0",
    "OUT T0 K5",
    "OUT C0 D3",
    "OUT C200 K-9",
    "SET M5",
    "RST C0",
    "PLS M9",
    "MC N0 M60",
    "MCR N0",
    "STL S0",
    "STL S20",
    "SET S20",
    "OUT S0",
    "RET",
    "CJ P0",
    "CALL P1",
    "P0",
    "P1",
    "SRET",
    "FOR K3",
    "NEXT",
    "FEND",
    "END",
];

/// Numbers of devices, pointers and constants that are more likely to be wrong than others.
const BORDERS: [u64; 24] = [
    0, 1, 7, 8, 15, 62, 63, 64, 127, 128, 199, 200, 234, 235, 255, 256, 511, 3071, 7999, 8000,
    8255, 32767, 65535, 4294967295,
];

fn number(rng: &mut Rng) -> u64 {
    match rng.below(10) {
        0 => rng.pick(&BORDERS).unwrap_or(0),
        1 => rng.bits() >> rng.below(64),
        2 => u64::from(rng.below(10_000)),
        3 => 8000 + u64::from(rng.below(512)),
        _ => u64::from(rng.below(32)),
    }
}

/// An operand of these classes, or, not always in vain, of any.
fn operand(rng: &mut Rng, classes: Classes) -> String {
    let all: Vec<_> = (0..32).map(|bit| Classes(1 << bit)).collect();
    let fitting: Vec<_> = all.iter().copied().filter(|c| c.meets(classes)).collect();
    let class = rng.pick(&fitting).unwrap_or(Classes::K);
    let device = DeviceClass::ALL
        .into_iter()
        .find(|&c| Classes::of_device(c) == class);
    let mut text = match device {
        Some(device) if rng.percent(90) => format!("{device:?}{}", octal(rng, device)),
        _ if class == Classes::K && rng.percent(90) => {
            let bits = if rng.percent(70) { 16 } else { 40 };
            format!("K{}", rng.value(bits))
        }
        _ => anything(rng),
    };
    if rng.percent(12) {
        text.push_str(
            rng.pick(&[
                "Z0", "Z1", "V", "V7", "Z", "Z8", "V99999", ".F", ".9", "Z0Z1",
            ])
            .unwrap_or(""),
        );
    }
    text
}

/// A number that may be read as a device of the class: X and Y count in octal.
fn octal(rng: &mut Rng, device: DeviceClass) -> String {
    let number = number(rng);
    match device {
        DeviceClass::X | DeviceClass::Y => format!("{number:o}"),
        _ => number.to_string(),
    }
}

/// An operand without regard to the requirements.
fn anything(rng: &mut Rng) -> String {
    let n = number(rng);
    let letter = rng
        .pick(&[
            "X", "Y", "M", "S", "T", "C", "D", "R", "ER", "V", "Z", "P", "I", "N",
        ])
        .unwrap_or("D");
    match rng.below(12) {
        0 => format!("K{}", rng.bits() as i64 >> rng.below(64)),
        1 => format!("H{n:X}"),
        2 => format!("E{}", f32::from_bits(rng.bits() as u32)),
        3 => format!("E{}.5", n),
        4 => format!("K{}{letter}{n}", rng.below(10)),
        5 => format!("{letter}{n}.{:X}", rng.below(17)),
        6 => format!("U{}\\G{n}", rng.below(9)),
        7 => "\"AB é\"".to_owned(),
        8 => rng
            .pick(&[
                "K", "H", "E", "-", "@", "D", "K4", "é", "Ｄ０", "M8000", "D8010",
            ])
            .unwrap_or("")
            .to_owned(),
        _ => format!("{letter}{n}"),
    }
}

fn instruction(rng: &mut Rng, spellings: &[(String, &'static Inst)], model: ModelId) -> String {
    let (spelling, inst) = &spellings[rng.below(spellings.len() as u32) as usize];
    let mut line = spelling.clone();
    let params: &[Param] = inst.params_of(&[], Model::get(model));
    for param in params {
        if rng.percent(2) || (param.optional && rng.percent(50)) {
            break;
        }
        line.push(' ');
        line.push_str(&operand(rng, param.classes));
    }
    if rng.percent(3) {
        line.push(' ');
        line.push_str(&anything(rng));
    }
    line
}

/// A heap of lines.
fn soup(seed: u64, spellings: &[(String, &'static Inst)], model: ModelId) -> String {
    let mut rng = Rng::new(seed);
    let mut lines = Vec::new();
    for _ in 0..4 + rng.below(24) {
        match rng.below(10) {
            0..=3 => {
                lines.push(format!("LD M{}", rng.below(8)));
                lines.push(instruction(&mut rng, spellings, model));
            }
            4 => lines.push(instruction(&mut rng, spellings, model)),
            5 if rng.percent(20) => lines.push(format!(
                "{}{}",
                rng.pick(&["P", "I"]).unwrap_or("P"),
                number(&mut rng)
            )),
            _ => lines.push(rng.pick(&STRUCTURE).unwrap_or("NOP").to_owned()),
        }
    }
    if rng.percent(90) {
        lines.push("END".to_owned());
    }
    lines.join("\n") + "\n"
}

/// A program with some lines moved, lost, repeated or changed.
fn damaged(seed: u64, text: &str, spellings: &[(String, &'static Inst)], model: ModelId) -> String {
    let mut rng = Rng::new(seed);
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..=rng.below(4) {
        let at = rng.below(lines.len() as u32) as usize;
        let other = rng.below(lines.len() as u32) as usize;
        if lines.is_empty() {
            break;
        }
        match rng.below(6) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[other].clone()),
            2 => lines.swap(at, other),
            3 => lines.insert(at, instruction(&mut rng, spellings, model)),
            4 => lines.insert(at, rng.pick(&STRUCTURE).unwrap_or("NOP").to_owned()),
            _ => {
                let mut words: Vec<String> = lines[at].split(' ').map(str::to_owned).collect();
                let word = rng.below(words.len() as u32) as usize;
                words[word] = anything(&mut rng);
                lines[at] = words.join(" ");
            }
        }
    }
    lines.join("\n") + "\n"
}

/// Reads and compiles; every finding lies in the text.
fn compiled(text: &str, model: ModelId, optimise: bool) -> (Compiled, Vec<u32>) {
    let read = rungc_frontend::read_text("random.il", text);
    let options = CompileOptions {
        model: Some(model),
        name: Some("random".to_owned()),
        optimise,
        // Programs past the limits of the PLC compile, and run, as well.
        warn: codes::eased().map(|code| code.id).collect(),
        ..CompileOptions::default()
    };
    let mut compiled = compile(&read.program, &options);
    let mut faulty = Vec::new();
    for finding in read.diagnostics.iter().chain(compiled.diagnostics.iter()) {
        let places = std::iter::once(finding.span).chain(finding.others.iter().map(|o| o.span));
        for place in places {
            assert!(
                text.get(place.range()).is_some(),
                "{finding:?} lies outside the text"
            );
        }
        if finding.severity == Severity::Error {
            faulty.push(read.program.source.line_col(finding.span.start).0);
        }
    }
    // Unreadable parts have been reported by the reader.
    let refused = compiled.diagnostics.has_errors() || !read.program.is_complete();
    assert_eq!(refused, compiled.module.is_none());
    if read.diagnostics.has_errors() {
        compiled.module = None;
    }
    faulty.sort_unstable();
    faulty.dedup();
    (compiled, faulty)
}

fn without(text: &str, faulty: &[u32]) -> String {
    let lines = (1..).zip(text.lines());
    lines
        .filter(|(number, _)| !faulty.contains(number))
        .map(|(_, line)| format!("{line}\n"))
        .collect()
}

fn run(module: &Module, seed: u64) {
    let mut rng = Rng::new(seed);
    let mut machine = Machine::new(module);
    let mut hal = VirtualHal::new();
    for scan in 0..SCANS {
        for area in &module.layout.areas {
            for number in area.first..area.first + area.count.min(32) {
                let class = match area.class {
                    DeviceClass::X => Class::X,
                    DeviceClass::M => Class::M,
                    DeviceClass::D => Class::D,
                    DeviceClass::Z => Class::Z,
                    _ => continue,
                };
                if number < 8000 && rng.percent(30) {
                    let _ = machine.set_bit(class, number, rng.percent(50));
                    let _ = machine.set_word(class, number, rng.value(16) as i16);
                }
            }
        }
        hal.advance_to(scan * 10);
        machine.scan(&mut hal, scan * 10, 10_000);
        if machine.watchdog_tripped() {
            return;
        }
    }
}

/// The whole way of one program on one model; whether anything compiled.
fn whole_way(text: &str, model: ModelId, seed: u64) -> bool {
    let mut text = text.to_owned();
    for _ in 0..REPAIRS {
        let (compiled, faulty) = compiled(&text, model, seed.is_multiple_of(2));
        if let Some(module) = compiled.module {
            validate::validate(&module).unwrap_or_else(|e| panic!("invalid module: {e}"));
            assert!(!dump::dump(&module).is_empty());
            let c = rungc_codegen_c::emit(&module, &rungc_codegen_c::Options::default());
            assert!(!c.is_empty());
            let rust = rungc_codegen_rust::emit(&module, &rungc_codegen_rust::Options::default());
            assert!(!rust.is_empty());
            run(&module, seed);
            return true;
        }
        let rest = without(&text, &faulty);
        if faulty.is_empty() || rest == text {
            // The error is not on a line: END is missing, for example.
            text = rest + "END\n";
        } else {
            text = rest;
        }
    }
    false
}

/// One program to try.
struct Trial {
    name: String,
    text: String,
    models: Vec<ModelId>,
    seed: u64,
}

/// Runs the trials in a thread that is watched; says how many (program, model) pairs compiled.
fn survive(trials: Vec<Trial>) {
    let count = trials.len();
    let (tell, hear) = mpsc::channel();
    std::thread::spawn(move || {
        for trial in trials {
            let begun = (trial.name.clone(), trial.text.clone());
            if tell.send(Err(begun)).is_err() {
                return;
            }
            let result = catch_unwind(AssertUnwindSafe(|| {
                let models = trial.models.iter();
                models
                    .filter(|&&model| whole_way(&trial.text, model, trial.seed))
                    .count()
            }));
            if tell.send(Ok(result.ok())).is_err() {
                return;
            }
        }
    });
    let mut current = (String::new(), String::new());
    let (mut modules, mut panicked) = (0, Vec::new());
    loop {
        match hear.recv_timeout(PATIENCE) {
            Ok(Err(begun)) => current = begun,
            Ok(Ok(Some(compiled))) => modules += compiled,
            Ok(Ok(None)) => panicked.push(current.clone()),
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
            Err(mpsc::RecvTimeoutError::Timeout) => {
                panic!("{} does not end:\n{}", current.0, current.1)
            }
        }
    }
    println!("{count} programs, {modules} modules");
    let shown: Vec<_> = panicked
        .iter()
        .take(5)
        .map(|(name, text)| format!("{name}:\n{text}"))
        .collect();
    assert!(
        panicked.is_empty(),
        "{} programs panic:\n{}",
        panicked.len(),
        shown.join("\n")
    );
    assert!(
        modules * 4 >= count,
        "only {modules} modules of {count} programs"
    );
}

fn spellings() -> Vec<(String, &'static Inst)> {
    rungc_catalogue::all()
        .flat_map(|inst| {
            inst.spellings()
                .into_iter()
                .map(move |(spelling, _)| (spelling, inst))
        })
        .collect()
}

#[test]
fn random_lines() {
    let spellings = spellings();
    let first = setting("SEED", 1);
    let trials = (first..first + setting("PROGRAMS", 80)).map(|seed| {
        let model = ModelId::ALL[(seed % ModelId::ALL.len() as u64) as usize];
        Trial {
            name: format!("soup {seed}"),
            text: soup(seed, &spellings, model),
            models: ModelId::ALL.to_vec(),
            seed,
        }
    });
    survive(trials.collect());
}

/// Long rungs: no stage may need more stack for a longer one.
#[test]
fn long_rungs() {
    const LENGTH: usize = 5000;
    let repeated = |lines: &str| format!("LD X0\n{}OUT Y0\nEND\n", lines.repeat(LENGTH));
    let trials = [
        "OR M1\n",
        "AND M1\nOR M2\n",
        "INV\n",
        "ANI M1\nINV\n",
        "LD M1\nANI M2\nORB\n",
        "ANDP M1\nMEP\n",
        "OR>= D0 K5\n",
        "OUT M1\n",
        "AND M1\nOUT T0 K5\n",
        "INC D0\nMOV D0 D1\n",
        "MPS\nAND M1\nOUT M2\nMPP\n",
    ];
    let trials = trials.iter().zip(0..).map(|(lines, seed)| Trial {
        name: lines.replace('\n', "; "),
        text: repeated(lines),
        models: vec![ModelId::Fx3u],
        seed,
    });
    survive(trials.collect());
}

/// Loops that would take years are cut short by the watchdog, whether they do anything or not.
#[test]
fn endless_loops() {
    let texts = [
        "FOR K32767\nFOR K32767\nFOR K32767\nNEXT\nNEXT\nNEXT\nEND\n",
        "FOR K32767\nFOR K32767\nLD M8000\nINC D0\nNEXT\nNEXT\nEND\n",
        "P0\nLD M8000\nCJ P0\nEND\n",
    ];
    let trials = texts.iter().zip(0..).map(|(text, seed)| Trial {
        name: "endless loop".to_owned(),
        text: (*text).to_owned(),
        models: vec![ModelId::H2u],
        seed,
    });
    survive(trials.collect());
}

#[test]
fn damaged_programs() {
    let spellings = spellings();
    let folder = Path::new(env!("RUNGC_ROOT")).join("golden/conformance");
    let parts = ["h1u-h2u", "hm", "l01s"].map(|part| std::fs::read_dir(folder.join(part)).unwrap());
    let mut paths: Vec<_> = parts
        .into_iter()
        .flatten()
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    let files = paths
        .iter()
        .map(|path| plctest::load(path).unwrap_or_else(|e| panic!("{e}")));
    let cases: Vec<_> = files.flat_map(|file| file.cases).collect();
    let first = setting("SEED", 1);
    let trials = (first..first + setting("PROGRAMS", 200)).map(|seed| {
        let case = &cases[Rng::new(seed).below(cases.len() as u32) as usize];
        Trial {
            name: format!("{} {seed}", case.name),
            text: damaged(seed, case.program.text(), &spellings, case.model),
            models: vec![case.model],
            seed,
        }
    });
    survive(trials.collect());
}

/// Codes of instructions that are read from projects have a row and a form in the catalogue.
#[test]
fn instructions_of_the_editors_are_known() {
    let table = concat!(env!("RUNGC_ROOT"), "/frontend/formats/src/gx/tokens.tsv");
    let table = std::fs::read_to_string(table).unwrap();
    let mnemonics = table
        .lines()
        .skip(1)
        .filter_map(|row| row.split('\t').nth(1));
    let unknown: Vec<&str> = mnemonics
        .filter(|mnemonic| rungc_catalogue::find(mnemonic).is_none())
        .collect();
    assert_eq!(unknown, [""; 0]);
}
