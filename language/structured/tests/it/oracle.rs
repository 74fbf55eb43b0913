//! Comparison with lists that GX Works2 compiled: statement by statement, up to the numbers of temporaries and jumps.

use rungc_frontend::Read;
use rungc_frontend::sources::Sources;
use rungc_models::{Model, ModelId};
use rungc_structured::{Known, Trial, trial};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind, Severity};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::collections::BTreeSet;
use std::path::Path;

/// Statements of a unit, how many were compiled, and how many have the vendor's instructions.
#[derive(Default)]
struct Tally {
    statements: usize,
    compiled: usize,
    equal: usize,
    /// Equal but for an `LD M8000` that is shared with the statement before.
    nearly: usize,
}

/// Compares all units in structured text of the projects below the folders that `RUNGC_ST_PROJECTS` names.
#[test]
#[ignore = "measures projects of GX Works2: name their folders in RUNGC_ST_PROJECTS, with a colon between"]
fn statements_compared_with_the_vendor() {
    let folders = std::env::var("RUNGC_ST_PROJECTS").expect("RUNGC_ST_PROJECTS names folders");
    let mut total = Tally::default();
    for folder in folders.split(':') {
        let found = rungc_frontend::programs(Path::new(folder), 9).expect("a folder");
        for path in found
            .iter()
            .filter(|path| path.extension().is_some_and(|ending| ending == "gxw"))
        {
            project(path, &mut total);
        }
    }
    println!("{}", total.line("all"));
    assert!(total.statements > 0, "no statements were found");
}

impl Tally {
    fn line(&self, name: &str) -> String {
        let Tally {
            statements,
            compiled,
            equal,
            nearly,
        } = self;
        format!(
            "{name}: {statements} statements, {compiled} compiled, {equal} equal, {nearly} nearly"
        )
    }
}

fn project(path: &Path, total: &mut Tally) {
    let Ok(read) = rungc_frontend::read(path) else {
        return;
    };
    let Some(sources) = read.sources.as_deref() else {
        return;
    };
    let model = read.program.cpu.as_deref().and_then(ModelId::from_cpu);
    let model = Model::get(model.unwrap_or(ModelId::Fx3u));
    let files = sources.to_st();
    let texts = || files.iter().filter(|file| file.path.ends_with(".st"));
    let text = |contents: &[u8]| String::from_utf8_lossy(contents).into_owned();
    let labels = texts().filter(|file| file.path.starts_with("labels/"));
    let structures = texts().filter(|file| file.path.starts_with("structures/"));
    let globals: String = structures
        .chain(labels)
        .map(|file| text(&file.contents))
        .collect();
    let units = texts().filter(|file| !file.path.contains('/'));
    let units: Vec<_> = units
        .map(|file| (file.path.trim_end_matches(".st"), text(&file.contents)))
        .collect();
    let (programs, blocks): (Vec<_>, Vec<_>) = units
        .into_iter()
        .partition(|(_, unit)| unit.starts_with("PROGRAM"));
    let blocks: String = blocks.into_iter().map(|(_, block)| block).collect();
    for (name, program) in programs {
        let whole = format!("{globals}{blocks}{program}");
        let tried = trial(&whole, model, &known(sources, name));
        let tally = compare(&tried, &read, sources);
        println!("{}", tally.line(&format!("{} {name}", path.display())));
        if std::env::var_os("RUNGC_ST_SHOWN").is_some() {
            show(&tried, &whole, &read, sources);
        }
        total.statements += tally.statements;
        total.compiled += tally.compiled;
        total.equal += tally.equal;
        total.nearly += tally.nearly;
    }
}

/// Devices that the vendor chose for labels of a unit, and for global ones, and those of members of structures, which
/// no text states.
fn known(sources: &Sources, unit: &str) -> Known {
    let devices = sources.devices();
    let local = format!("{unit}.");
    let name = |name: &str| {
        let name = name.strip_prefix(&local).unwrap_or(name);
        name.split('[').next().unwrap_or(name).to_uppercase()
    };
    let mut known = Known::new();
    for one in devices
        .iter()
        .filter(|one| one.is_chosen || one.name.contains('.'))
    {
        known.entry(name(&one.name)).or_insert(one.device);
    }
    known
}

/// Devices that labels have, so that they are not temporaries.
fn declared(sources: &Sources) -> BTreeSet<Device> {
    sources.devices().iter().map(|one| one.device).collect()
}

/// An instruction without the numbers of temporaries and jumps.
fn plain(instr: &Instr, declared: &BTreeSet<Device>) -> String {
    let is_temporary = |device: &Device| {
        let number = device.number;
        let reserved = match device.class {
            DeviceClass::M => (512..7680).contains(&number),
            DeviceClass::D => (512..8000).contains(&number),
            _ => false,
        };
        reserved && !declared.contains(device)
    };
    let operand = |kind: &OperandKind| match kind {
        OperandKind::Device(device, _) if device.class == DeviceClass::P => "P".to_owned(),
        OperandKind::Device(device, None) if is_temporary(device) => {
            format!("{}#", device.class.prefix())
        }
        kind => kind.to_string(),
    };
    let is_label = instr.operands.is_empty()
        && instr.mnemonic.starts_with('P')
        && instr.mnemonic[1..].parse::<u32>().is_ok();
    let mut line = if is_label {
        "P".to_owned()
    } else {
        instr.mnemonic.to_string()
    };
    for one in &instr.operands {
        line.push(' ');
        line.push_str(&operand(&one.kind));
    }
    line
}

/// For each instruction of a trial, true if the vendor's list has it there.
fn matched(tried: &Trial, read: &Read, sources: &Sources) -> Vec<bool> {
    let declared = declared(sources);
    let ours: Vec<_> = tried
        .instrs
        .iter()
        .map(|instr| plain(instr, &declared))
        .collect();
    let theirs: Vec<_> = read
        .program
        .instrs
        .iter()
        .map(|instr| plain(instr, &declared))
        .collect();
    let mut matched = vec![false; ours.len()];
    for op in capture_diff_slices(Algorithm::Myers, &ours, &theirs) {
        if let DiffOp::Equal { old_index, len, .. } = op {
            matched[old_index..old_index + len].fill(true);
        }
    }
    matched
}

fn compare(tried: &Trial, read: &Read, sources: &Sources) -> Tally {
    let matched = matched(tried, read, sources);
    let mut tally = Tally {
        statements: tried.statements.len(),
        ..Tally::default()
    };
    for statement in tried
        .statements
        .iter()
        .filter(|statement| statement.is_compiled)
    {
        let own = tried
            .instrs
            .iter()
            .zip(&matched)
            .filter(|(instr, _)| instr.span == statement.span);
        let missing: Vec<_> = own
            .filter(|(_, matched)| !**matched)
            .map(|(instr, _)| instr)
            .collect();
        let is_power = |instr: &&Instr| {
            instr.mnemonic == "LD" && instr.operands[0].kind.to_string() == "M8000"
        };
        tally.compiled += 1;
        if missing.is_empty() {
            tally.equal += 1;
        } else if missing.iter().all(is_power) {
            tally.nearly += 1;
        }
    }
    tally
}

/// Prints errors, and the statements that differ.
fn show(tried: &Trial, text: &str, read: &Read, sources: &Sources) {
    for found in tried
        .diagnostics
        .iter()
        .filter(|found| found.severity == Severity::Error)
    {
        let quoted = text.get(found.span.range()).unwrap_or_default();
        println!("  {} {}: {quoted}", found.code, found.message);
    }
    let matched = matched(tried, read, sources);
    let declared = declared(sources);
    for statement in tried
        .statements
        .iter()
        .filter(|statement| statement.is_compiled)
    {
        let own = tried
            .instrs
            .iter()
            .zip(&matched)
            .filter(|(instr, _)| instr.span == statement.span);
        let own: Vec<_> = own.collect();
        if own.iter().any(|(_, matched)| !**matched) {
            println!("  {}", text.get(statement.span.range()).unwrap_or_default());
            for (instr, matched) in own {
                println!(
                    "    {} {}",
                    if *matched { "=" } else { "-" },
                    plain(instr, &declared)
                );
            }
        }
    }
}
