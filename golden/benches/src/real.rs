//! Programs that people wrote for machines, from a folder: instructions and bytes that a scan takes. No one wrote them
//! in C by hand, so figures are compared with earlier ones.

use crate::embedded::{self, Level};
use crate::ladder::Device;
use crate::problem::{Problem, Result};
use crate::subject::{Code, INPUTS, Source, calls_runtime};
use crate::table::{Cell, Table};
use rungc_codegen_c::lanes;
use rungc_ir::Module;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_models::runs::is_special;
use rungc_syntax::{DeviceClass, Program};
use std::path::{Path, PathBuf};

/// Number of programs that are measured: the largest ones.
const PROGRAMS: usize = 8;

/// Depth of the folders that are searched.
const DEPTH: usize = 16;

/// A program of a project.
struct Project {
    name: String,
    program: Program,
    /// Its length in steps.
    steps: u32,
    inputs: Vec<Device>,
    devices: Vec<Device>,
}

impl Source for Project {
    fn module(&self, name: &str) -> Result<Module> {
        let module = compiled(&self.program, name).module;
        module.ok_or_else(|| Problem::Wrong(format!("{} does not compile", self.name)))
    }

    fn label(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        self.name.chars().map(plain).collect()
    }

    /// All inputs that it has, again and again.
    fn inputs(&self) -> Vec<Device> {
        let none = [(DeviceClass::X, u32::MAX)];
        let inputs: &[Device] = if self.inputs.is_empty() {
            &none
        } else {
            &self.inputs
        };
        inputs.iter().copied().cycle().take(INPUTS).collect()
    }

    fn devices(&self) -> Vec<Device> {
        self.devices.clone()
    }
}

fn compiled(program: &Program, name: &str) -> Compiled {
    let options = CompileOptions {
        name: Some(name.to_string()),
        optimise: true,
        ..CompileOptions::default()
    };
    compile(program, &options)
}

impl Project {
    fn instructions(&self) -> Vec<String> {
        let instrs = self.program.instrs.iter();
        instrs.map(ToString::to_string).collect()
    }

    /// A program that compiles; an error is the reason why it cannot be measured.
    fn read(path: &Path, name: String) -> Option<std::result::Result<Self, String>> {
        let program = rungc_frontend::read(path).ok()?.program;
        let Compiled { module, steps, .. } = compiled(&program, "program");
        let module = module?;
        if let Some(reason) = lanes::reaches_out(&module).or_else(|| asks_hardware(&module)) {
            return Some(Err(format!("{name}: {steps} steps, {reason}")));
        }
        let c = rungc_codegen_c::Members::new(&module);
        let rust = rungc_codegen_rust::Members::new(&module);
        let areas = module.layout.areas.iter();
        let all = areas.flat_map(|area| (0..area.count).map(|i| (area.class, area.first + i)));
        let (inputs, devices) = all
            .filter(|&(class, number)| is_compared(class) && !is_special(class, number))
            .filter(|&(class, number)| c.of(class, number).is_some())
            .filter(|&(class, number)| rust.of(class, number).is_some())
            .partition(|(class, _)| *class == DeviceClass::X);
        Some(Ok(Project {
            name,
            program,
            steps,
            inputs,
            devices,
        }))
    }
}

/// The reason why a program needs more of a board than scans, as the end of "the program …".
fn asks_hardware(module: &Module) -> Option<&'static str> {
    let mut asks = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            asks |= match stmt {
                Stmt::Do(Action::Call(call)) => call.function.needs().hal,
                Stmt::Do(Action::Fetch(_) | Action::Send(_)) => true,
                _ => false,
            };
        });
    }
    asks.then_some("asks hardware: special modules, the clock, terminals within a scan")
}

fn is_compared(class: DeviceClass) -> bool {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    matches!(class, X | Y | M | S | T | C | D | R)
}

/// The largest programs of folders, and why larger ones are not among them.
fn largest(folders: &[PathBuf]) -> Result<(Vec<Project>, Vec<String>)> {
    let (mut projects, mut refused) = (Vec::new(), Vec::new());
    for folder in folders {
        let at = |error| Problem::File {
            path: folder.clone(),
            error,
        };
        for path in rungc_frontend::programs(folder, DEPTH).map_err(at)? {
            let name = path.strip_prefix(folder).unwrap_or(&path);
            match Project::read(&path, name.display().to_string()) {
                Some(Ok(project)) => projects.push(project),
                Some(Err(reason)) => refused.push(reason),
                None => {}
            }
        }
    }
    projects.sort_by_key(|project| std::cmp::Reverse(project.steps));
    // A project and the list that was exported from it.
    projects.dedup_by_key(|project| (project.steps, project.instructions()));
    projects.truncate(PROGRAMS);
    Ok((projects, refused))
}

/// The table of the largest programs of some folders.
///
/// # Errors
/// A folder cannot be read; the compilers or QEMU fail; C and Rust differ.
pub fn table(folders: &[PathBuf], codes: &[Code]) -> Result<Table> {
    let mut table = Table::new(
        "Instructions of a scan of real programs on a Cortex-M4 (QEMU, `-icount shift=0`)",
        &[
            "program",
            "steps",
            "calls",
            "code",
            "options",
            "instructions",
            "per step",
            "flash",
            "RAM",
        ],
    );
    let (projects, refused) = largest(folders)?;
    for reason in refused {
        eprintln!("not measured: {reason}");
    }
    for project in projects {
        eprintln!("{}, {} steps ...", project.name, project.steps);
        let calls = if calls_runtime(&project)? {
            "yes"
        } else {
            "no"
        };
        for level in [Level::Size, Level::Speed] {
            for measured in embedded::measure_emitted(&project, codes, level)? {
                let mut row: Vec<Cell> = vec![
                    project.name.as_str().into(),
                    Cell::count(project.steps.into()),
                    calls.into(),
                    measured.code.title().into(),
                    level.option().into(),
                ];
                match measured.figures {
                    Err(problem) => row.push(problem.to_string().into()),
                    Ok(figures) => {
                        let count = figures.instructions.unwrap_or_default();
                        row.extend([
                            Cell::number(count, 0),
                            Cell::number(count / f64::from(project.steps), 3),
                            Cell::count(figures.flash),
                            Cell::count(figures.ram),
                        ]);
                    }
                }
                table.row(row);
            }
        }
    }
    Ok(table)
}
