//! Programs that are explained.

use rungc_interp::rt_class;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_lower::marks::Marks;
use rungc_models::ModelId;
use rungc_models::runs::is_special;
use rungc_rt::Plc as _;
use rungc_sim::plctest::{self, CaseProgram};
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, Program};
use std::path::{Path, PathBuf};

/// One in this many conformance cases takes part.
const SHARE: usize = 24;

/// A program.
pub struct Subject {
    pub name: String,
    pub program: Program,
    pub module: Module,
    pub marks: Marks,
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

pub fn examples() -> Vec<Subject> {
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

pub fn conformance() -> Vec<Subject> {
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

pub fn target(device: Device) -> Target {
    Target::Bit(device.class, device.number)
}

pub fn state(session: &Session, device: Device) -> bool {
    let class = rt_class(device.class).unwrap();
    session.machine().bit(class, device.number) == Some(true)
}

/// Returns true if a scan begins with a device as it was forced.
pub fn can_be_forced(device: Device) -> bool {
    use DeviceClass::{M, S, X, Y};
    matches!(device.class, X | Y | M | S) && !is_special(device.class, device.number)
}

/// Devices that a run sets, and devices that are explained: those that an instruction other than a contact names.
pub fn devices(subject: &Subject) -> (Vec<Device>, Vec<Device>) {
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
