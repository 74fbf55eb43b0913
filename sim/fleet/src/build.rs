//! Builds the executables that run the PLCs of a program in emitted C.

use crate::engine::FleetError;
use rungc_codegen_c::{Members, Options, emit, lanes};
use rungc_ir::Module;
use rungc_ir::node::{Action, Call, Stmt};
use rungc_ir::walk::{calls_runtime, statements};
use rungc_syntax::DeviceClass;
use std::path::{Path, PathBuf};
use std::process::Command;

/// `main` of both kinds of executables, with the name of the program as `NAME`.
const CHILDREN: &str = include_str!("children.c");

/// Runs 64 PLCs at once.
const LANES: &str = include_str!("lanes.c");

/// Runs one PLC after the other.
const SINGLES: &str = include_str!("singles.c");

/// Number of devices that are read together.
pub(crate) const CHUNK: u32 = 64;

/// Leaves out what the program does not call of the runtime library, with what that would need in turn.
const UNUSED: &str = match cfg!(target_os = "macos") {
    true => "-Wl,-dead_strip",
    false => "-Wl,--gc-sections",
};

/// Lines of the compiler's output that an error quotes.
const QUOTED_LINES: usize = 20;

/// Form in which emitted C runs the PLCs of a group.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Form {
    /// 64 at once: programs that [`lanes::refusal`] has nothing against.
    Lanes,
    /// One after the other: programs that [`refusal`] has nothing against.
    Singles {
        /// The runtime library for this machine, of a program that [`needs_runtime`].
        runtime: Option<PathBuf>,
    },
}

/// Reason why a program cannot run in emitted C here, as the end of "the program …"; `None` if there is none.
pub fn refusal(module: &Module) -> Option<&'static str> {
    let reaches_out = lanes::reaches_out(module);
    reaches_out.or_else(|| {
        let asks = any(module, |stmt| match stmt {
            Stmt::Do(Action::Call(Call { function, .. })) => function.needs().hal,
            other => calls_runtime(other),
        });
        asks.then_some("asks hardware: special modules, the clock, terminals within a scan")
    })
}

/// Returns true if a program calls the runtime library.
pub fn needs_runtime(module: &Module) -> bool {
    any(module, calls_runtime)
}

fn any(module: &Module, is_so: impl Fn(&Stmt) -> bool) -> bool {
    let mut found = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| found |= is_so(stmt));
    }
    found
}

/// Builds the executable of a program in a folder.
///
/// # Errors
/// A file that cannot be written, a C compiler (`cc`) that is not there or rejects what was emitted.
pub(crate) fn build(module: &Module, folder: &Path, form: &Form) -> Result<PathBuf, FleetError> {
    let at = |what: &Path| {
        let what = what.display().to_string();
        move |error| FleetError::Io { what, error }
    };
    std::fs::create_dir_all(folder).map_err(at(folder))?;
    let options = Options {
        access: true,
        lanes: *form == Form::Lanes,
        ..Options::default()
    };
    let engine = match form {
        Form::Lanes => LANES.replace("BITS\n", &bits(module)),
        Form::Singles { .. } => SINGLES.to_string(),
    };
    let main = CHILDREN
        .replace("ENGINE\n", &engine)
        .replace("NAME", &module.name);
    let mut command = Command::new("cc");
    command.args(["-std=c99", "-O2", "-ffunction-sections", "-fdata-sections"]);
    if module.may_fail() {
        command.arg("-DPLC_ON_ERROR");
    }
    command.args(["-o", "plcs", "plcs.c"]);
    let written = folder.join("plcs.c");
    std::fs::write(&written, main).map_err(at(&written))?;
    let files = emit(module, &options);
    // The sources of the runtime are for those who build it themselves.
    let own = files.iter().filter(|file| !file.path.contains('/'));
    for file in own {
        let path = folder.join(&file.path);
        std::fs::write(&path, &file.contents).map_err(at(&path))?;
        if file.path.ends_with(".c") {
            command.arg(&file.path);
        }
    }
    if let Form::Singles {
        runtime: Some(library),
    } = form
    {
        command.arg(library).arg(UNUSED);
    }
    let output = command
        .current_dir(folder)
        .output()
        .map_err(at(Path::new("cc")))?;
    if output.status.success() {
        return Ok(folder.join("plcs"));
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let quoted: Vec<&str> = text.lines().take(QUOTED_LINES).collect();
    Err(FleetError::Compiler {
        command: format!("cc in {}", folder.display()),
        output: quoted.join("\n"),
    })
}

/// The cases that find the lanes of each bit.
fn bits(module: &Module) -> String {
    let members = Members::new(module);
    let mut cases = String::new();
    for class in [
        DeviceClass::X,
        DeviceClass::Y,
        DeviceClass::M,
        DeviceClass::S,
    ] {
        let areas = module
            .layout
            .areas
            .iter()
            .filter(|area| area.class == class);
        let numbers = areas.flat_map(|area| area.first..area.first + area.count);
        let stored = numbers.filter_map(|number| Some((number, members.of(class, number)?)));
        let lines: Vec<String> = stored
            .map(|(number, member)| {
                format!("        case {number}: found = &all->{member}; break;\n")
            })
            .collect();
        if !lines.is_empty() {
            let (name, lines) = (class.prefix(), lines.concat());
            cases.push_str(&format!(
                "    case PLC_CLASS_{name}:\n        switch (number) {{\n{lines}        default: break;\n        }}\n        break;\n"
            ));
        }
    }
    cases
}
