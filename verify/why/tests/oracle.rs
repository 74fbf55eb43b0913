//! What is blamed decides, and nothing else does: at random moments of random runs of the examples and of the
//! conformance cases, one scan with other devices than it began with.

use rungc_interp::rt_class;
use rungc_ir::Module;
use rungc_ir::node::FunctionKind;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_lower::marks::Marks;
use rungc_models::ModelId;
use rungc_models::runs::is_special;
use rungc_rt::{Plc as _, VirtualHal};
use rungc_sim::plctest::{self, CaseProgram};
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, Program};
use rungc_why::Explainer;
use std::path::{Path, PathBuf};

/// One in this many conformance cases takes part.
const SHARE: usize = 24;
/// Number of scans of a run.
const SCANS: usize = 10;
/// Sets that are tried of each device.
const MOST_SETS: usize = 4;

struct Subject {
    name: String,
    program: Program,
    module: Module,
    marks: Marks,
}

fn subject(name: String, program: Program, model: Option<ModelId>) -> Option<Subject> {
    let options = CompileOptions {
        model,
        observe_all: true,
        marks: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&program, &options);
    Some(Subject {
        name,
        module: compiled.module?,
        marks: compiled.marks?,
        program,
    })
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            match path.is_dir() {
                true if name != "target" => open.push(path),
                false if name.ends_with(ending) => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

fn examples() -> Vec<Subject> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("examples");
    let paths = files(&folder, ".il").into_iter();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        let name = path.display().to_string();
        let program = rungc_frontend::read_text(&name, &text).program;
        // Some are written for another model than the default.
        let models = [ModelId::Fx3u, ModelId::H2u, ModelId::Hm];
        models
            .into_iter()
            .find_map(|model| subject(name.clone(), program.clone(), Some(model)))
    };
    paths.filter_map(read).collect()
}

fn conformance() -> Vec<Subject> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("golden/conformance");
    let mut found = Vec::new();
    let mut number = 0;
    for path in files(&folder, ".plctest.toml") {
        let file = plctest::load(&path).unwrap();
        for case in &file.cases {
            number += 1;
            let CaseProgram::List(list) = &case.program else {
                continue;
            };
            if number % SHARE == 0 {
                let name = format!("{}: {}", path.display(), case.name);
                let program = rungc_frontend::read_text(&name, list).program;
                found.extend(subject(name, program, Some(case.model)));
            }
        }
    }
    found
}

/// Counts of what was tried.
#[derive(Default, Debug)]
struct Tried {
    programs: usize,
    moments: usize,
    sets: usize,
    others: usize,
}

fn target(device: Device) -> Target {
    Target::Bit(device.class, device.number)
}

fn state(session: &Session, device: Device) -> bool {
    let class = rt_class(device.class).unwrap();
    session.machine().bit(class, device.number) == Some(true)
}

/// Returns true if a scan begins with a device as it was forced.
fn can_be_forced(device: Device) -> bool {
    use DeviceClass::{M, S, X, Y};
    matches!(device.class, X | Y | M | S) && !is_special(device.class, device.number)
}

/// State of a device after one scan that begins with other devices the opposite of what they are.
fn after(session: &mut Session, flipped: &[Device], device: Device) -> bool {
    let moment = session.save();
    for &other in flipped {
        let on = !state(session, other);
        session
            .force(target(other), f64::from(u8::from(on)))
            .unwrap();
    }
    let scan_ms = session.scan_ms(None);
    session.scan(scan_ms);
    let on = state(session, device);
    session.restore(&moment);
    on
}

/// Devices that a run sets, and devices that are explained: those that an instruction other than a contact names.
fn devices(subject: &Subject) -> (Vec<Device>, Vec<Device>) {
    let is_contact = |mnemonic: &str| {
        let starts = ["LD", "AND", "OR", "ANI"];
        starts.iter().any(|start| mnemonic.starts_with(start))
    };
    let named = |contacts: bool| {
        let instrs = subject.program.instrs.iter();
        let instrs = instrs.filter(|instr| is_contact(&instr.mnemonic) == contacts);
        let operands = instrs.flat_map(|instr| instr.operands.iter());
        let mut all: Vec<Device> = operands
            .filter_map(|operand| operand.kind.device())
            .collect();
        all.sort();
        all.dedup();
        all.retain(|device| subject.module.model.has(device.class, device.number));
        all
    };
    let mut set = named(true);
    set.retain(|&device| can_be_forced(device) && device.class != DeviceClass::Y);
    let mut explained = named(false);
    explained.retain(|&device| {
        can_be_forced(device) || matches!(device.class, DeviceClass::T | DeviceClass::C)
    });
    (set, explained)
}

fn try_program(subject: &Subject, seed: u64, tried: &mut Tried, wrong: &mut Vec<String>) {
    let interrupted = subject.module.functions.iter().any(|function| {
        matches!(
            function.kind,
            FunctionKind::InputEdge { .. } | FunctionKind::Interrupt(_)
        )
    });
    let (inputs, explained) = devices(subject);
    if interrupted || explained.is_empty() {
        return;
    }
    tried.programs += 1;
    let mut rng = fastrand::Rng::with_seed(seed);
    let explainer = Explainer::new(&subject.program, &subject.module, &subject.marks);
    let mut session = Session::new(&subject.module, VirtualHal::new());
    for _ in 0..SCANS {
        if !inputs.is_empty() {
            let input = inputs[rng.usize(..inputs.len())];
            let _ = session.set(target(input), f64::from(u8::from(rng.bool())));
        }
        let device = explained[rng.usize(..explained.len())];
        try_device((subject, &explainer), &mut session, device, (tried, wrong));
        session.scan(10);
        session.pass(10 * rng.u64(1..20));
    }
}

fn try_device(
    (subject, explainer): (&Subject, &Explainer),
    session: &mut Session,
    device: Device,
    (tried, wrong): (&mut Tried, &mut Vec<String>),
) {
    let roots = explainer.roots(session, None, device);
    let usual = after(session, &[], device);
    let at = format!("{} {device} at {} ms", subject.name, session.now_ms());
    tried.moments += 1;
    let has_cause = !roots.sets.is_empty() || !roots.others.is_empty();
    if has_cause && roots.on != usual {
        wrong.push(format!(
            "{at}: the scan leaves it {usual}, not {}",
            roots.on
        ));
        return;
    }
    let sets = roots.sets.iter();
    let sets = sets.filter(|set| set.iter().all(|device| can_be_forced(*device)));
    for set in sets.take(MOST_SETS) {
        tried.sets += 1;
        if after(session, set, device) == usual {
            wrong.push(format!("{at}: {set:?} is blamed and changes nothing"));
        }
    }
    let others = roots.others.iter().copied();
    let others: Vec<Device> = others.filter(|device| can_be_forced(*device)).collect();
    if roots.is_whole && !others.is_empty() {
        tried.others += 1;
        if after(session, &others, device) != usual {
            wrong.push(format!("{at}: {others:?} are not blamed and change it"));
        }
    }
}

fn try_all(subjects: &[Subject], runs: u64) -> Tried {
    let began = std::time::Instant::now();
    let mut tried = Tried::default();
    let mut wrong = Vec::new();
    for (number, subject) in (0..).zip(subjects) {
        for run in 0..runs {
            try_program(subject, number * runs + run, &mut tried, &mut wrong);
        }
    }
    println!("{tried:?} in {:?}", began.elapsed());
    let count = wrong.len();
    wrong.truncate(20);
    assert!(wrong.is_empty(), "{count} wrong:\n{}", wrong.join("\n"));
    tried
}

#[test]
fn what_is_blamed_decides_in_the_examples() {
    let tried = try_all(&examples(), 3);
    assert!(tried.sets >= 200 && tried.others >= 300, "{tried:?}");
}

#[test]
fn what_is_blamed_decides_in_the_conformance_cases() {
    let tried = try_all(&conformance(), 1);
    assert!(tried.sets >= 80 && tried.others >= 60, "{tried:?}");
}
