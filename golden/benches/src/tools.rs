//! The programs of others that are needed: compilers, linkers, QEMU.

use crate::problem::{Problem, Result};
use crate::table::Table;
use rungc_firmware::target::{CORTEX_M4F, Target};
use rungc_runtime_sources::cache;
use rungc_runtime_sources::library::{self, Optimise, Recipe};
use rungc_sim::engines::cortex_m;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// QEMU for a microcontroller.
pub const QEMU: &str = "qemu-system-arm";

/// Time limit of an image.
const QEMU_TIME: Duration = Duration::from_secs(120);

/// Returns true if a program is installed.
pub fn is_there(program: &str) -> bool {
    let mut command = Command::new(program);
    command.arg("--version").stdin(Stdio::null());
    command.output().is_ok_and(|output| output.status.success())
}

/// Says which program is missing, if one is.
pub fn need(programs: &[&str]) -> Result<()> {
    match programs.iter().find(|program| !is_there(program)) {
        Some(missing) => Err(Problem::Missing((*missing).to_string())),
        None => Ok(()),
    }
}

/// Title of [`table`].
pub const TABLE: &str = "Measured on";

/// The machine, and what there is of tools.
pub fn table() -> Table {
    let mut table = Table::new(TABLE, &["what", "version"]);
    table.row(["processor".into(), processor().into()]);
    for program in ["gcc", "clang", "rustc", CORTEX_M4F.cc, QEMU] {
        table.row([program.into(), version(program).into()]);
    }
    if cfg!(debug_assertions) {
        table.row([
            "rungc".into(),
            "a debug build: times of rungc itself mean nothing".into(),
        ]);
    }
    table
}

/// Name of the processor, where Linux reports it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut fields = text.lines().filter_map(|line| line.split_once(':'));
    let name = fields.find(|(field, _)| field.trim() == "model name");
    name.map_or("not known".to_string(), |(_, name)| name.trim().to_string())
}

/// First line of what a program says of its version.
fn version(program: &str) -> String {
    let text = run(Command::new(program).arg("--version"));
    match text {
        Ok(text) => text.lines().next().unwrap_or_default().to_string(),
        Err(_) => "not installed".to_string(),
    }
}

/// Runs a program; its standard output.
pub fn run(command: &mut Command) -> Result<String> {
    run_both(command).map(|(out, _)| out)
}

/// Runs a program; its standard output and standard error.
fn run_both(command: &mut Command) -> Result<(String, String)> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = match command.stdin(Stdio::null()).output() {
        Ok(output) => output,
        Err(_) => return Err(Problem::Missing(name)),
    };
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, error) = (text(&output.stdout), text(&output.stderr));
    match output.status.success() {
        true => Ok((out, error)),
        false => Err(Problem::Failed {
            command: format!("{command:?}"),
            output: format!("{out}{error}"),
        }),
    }
}

/// Runs an image on a Cortex-M4, where each instruction takes a nanosecond; what it prints by semihosting. One that
/// does not end is ended after two minutes.
pub fn qemu(image: &Path) -> Result<String> {
    let log = image.with_extension("log");
    let at = |error| Problem::File {
        path: log.clone(),
        error,
    };
    let file = std::fs::File::create(&log).map_err(at)?;
    let mut command = Command::new(QEMU);
    command
        .args([
            "-M",
            "netduinoplus2",
            "-nographic",
            "-icount",
            "shift=0,sleep=off",
        ])
        .args(["-semihosting-config", "enable=on,target=native", "-kernel"])
        .arg(image)
        .stdin(Stdio::null())
        .stderr(file.try_clone().map_err(at)?)
        .stdout(file);
    let mut qemu = command
        .spawn()
        .map_err(|_| Problem::Missing(QEMU.to_string()))?;
    let start = Instant::now();
    while qemu.try_wait().map_err(at)?.is_none() {
        if start.elapsed() > QEMU_TIME {
            qemu.kill().map_err(at)?;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let printed = std::fs::read_to_string(&log).map_err(at)?;
    match qemu.wait().map_err(at)?.success() {
        true => Ok(printed),
        false => Err(Problem::Failed {
            command: format!("{command:?}"),
            output: printed,
        }),
    }
}

/// Writes a file, with the folders it lies in.
pub fn write(path: &Path, text: &str) -> Result<()> {
    let at = |error| Problem::File {
        path: path.to_path_buf(),
        error,
    };
    path.parent()
        .map_or(Ok(()), std::fs::create_dir_all)
        .map_err(at)?;
    std::fs::write(path, text).map_err(at)
}

/// A folder for what is built, removed when it is dropped.
pub fn folder() -> Result<tempfile::TempDir> {
    tempfile::tempdir().map_err(|error| Problem::File {
        path: std::env::temp_dir(),
        error,
    })
}

/// A cargo that builds for this machine.
pub fn cargo() -> Command {
    without_toolchain(Command::new("cargo"))
}

/// A cargo that can build for a microcontroller.
pub fn embedded_cargo(target: &str) -> Result<Command> {
    cortex_m::cargo(target).ok_or_else(|| Problem::Missing(cortex_m::no_rust(target)))
}

/// The runtime as a static library, as `rungc build` makes it: for this machine, or for a microcontroller.
pub fn runtime(target: Option<&Target>) -> Result<PathBuf> {
    let cargo = match target {
        None => cargo(),
        Some(target) => embedded_cargo(target.triple)?,
    };
    let mut variables = cargo.get_envs();
    let rustc = variables.find_map(|(name, value)| value.filter(|_| name == "RUSTC"));
    let recipe = Recipe {
        cargo: &cargo,
        rustc: rustc.unwrap_or("rustc".as_ref()),
        target: target.and_then(Target::rustc_name),
        optimise: target.map_or(Optimise::Speed, Target::optimise),
        std: false,
        cargo_args: &[],
    };
    let cache = cache::folder().map_err(|error| Problem::File {
        path: "the cache".into(),
        error,
    })?;
    let announce = || eprintln!("building the runtime ...");
    library::build(&cache, &recipe, announce).map_err(|error| match error {
        library::Error::Cargo { cargo, .. } => Problem::Missing(cargo.display().to_string()),
        library::Error::Failed { output } => Problem::Failed {
            command: "cargo".to_string(),
            output,
        },
        library::Error::Io { path, error } => Problem::File { path, error },
    })
}

/// The runtime as an object that defines nothing but its C ABI, so that it can be linked beside a program in Rust.
pub fn runtime_object(folder: &Path) -> Result<PathBuf> {
    need(&["gcc", "objcopy"])?;
    let object = folder.join("runtime.o");
    run(Command::new("gcc")
        .args(["-r", "-nostdlib", "-Wl,--whole-archive"])
        .arg(runtime(None)?)
        .arg("-o")
        .arg(&object))?;
    run(Command::new("objcopy")
        .args(["--wildcard", "--keep-global-symbol=rungc_*"])
        .arg(&object))?;
    Ok(object)
}

/// Removes the settings of an outer cargo, which are not for the inner one.
fn without_toolchain(mut cargo: Command) -> Command {
    for variable in ["CARGO", "RUSTUP_TOOLCHAIN", "RUSTFLAGS", "LD_LIBRARY_PATH"] {
        cargo.env_remove(variable);
    }
    cargo
}
