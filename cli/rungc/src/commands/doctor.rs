//! `rungc doctor`: the tools that rungc calls, and what a missing one prevents.

mod tools;

use super::{Context, Outcome, Result, Verbosity, print_text};
use crate::args::{DoctorArgs, DoctorFormat};
use crate::report::to_json;
use rungc_firmware::build::Tools;
use rungc_firmware::target;
use rungc_io::ports;
use rungc_runtime_sources::cache;
use serde::Serialize;
use std::ffi::OsStr;
use std::fmt::{self, Write};
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver};
use std::thread;
use std::time::{Duration, Instant};
use tools::Tool;

/// The report.
#[derive(Serialize)]
struct Report {
    /// Version of rungc.
    rungc: &'static str,
    /// Operating system and processor.
    system: String,
    tools: Vec<Found>,
    targets: Vec<Built>,
    serial_ports: Vec<Port>,
    settings: Vec<Setting>,
    /// Prints what is missing for each target.
    #[serde(skip)]
    verbose: bool,
}

/// A tool, and what runs here under its name.
#[derive(Serialize)]
struct Found {
    #[serde(flatten)]
    tool: &'static Tool,
    /// The command that was tried.
    command: String,
    #[serde(flatten)]
    state: State,
}

/// Result of a check.
#[derive(Serialize)]
#[serde(tag = "state", content = "detail", rename_all = "lowercase")]
enum State {
    /// It works: version or place.
    Ok(String),
    /// There is nothing of that name.
    Missing,
    /// It is there and does not work: the reason, and what to do.
    Failed(String),
}

/// A machine that `--target` names: what is missing to build for it; `None` if nothing is.
#[derive(Serialize)]
struct Built {
    triple: &'static str,
    title: &'static str,
    missing_for_c: Option<String>,
    missing_for_rust: Option<String>,
}

/// A serial port, and whether this user may open it.
#[derive(Serialize)]
struct Port {
    path: String,
    #[serde(flatten)]
    state: State,
}

/// A property of the machine, and what depends on it.
#[derive(Serialize)]
struct Setting {
    name: &'static str,
    needed_for: &'static str,
    #[serde(flatten)]
    state: State,
}

/// Looks at the machine and reports what is there.
pub fn run(args: &DoctorArgs, cx: Context) -> Result {
    let report = report(cx.verbosity == Verbosity::Verbose);
    print_text(&match args.format {
        DoctorFormat::Human => report.to_string(),
        DoctorFormat::Json => to_json(&report)?,
    })?;
    Ok(Outcome::Success)
}

fn report(verbose: bool) -> Report {
    let tools = tools::ALL.iter().map(|tool| {
        let command = (tool.command)();
        Found {
            tool,
            state: version(&command),
            command: command.to_string_lossy().into_owned(),
        }
    });
    let targets = target::ALL.iter().map(|target| {
        let tools = Tools::new(target, &[]);
        let missing = |checked: std::result::Result<_, _>| checked.err().map(reason);
        Built {
            triple: target.triple,
            title: target.title,
            missing_for_c: missing(tools.check_c()),
            missing_for_rust: missing(tools.check_rust()),
        }
    });
    let ports = ports::available().into_iter().map(|path| Port {
        state: access(&path),
        path: path.display().to_string(),
    });
    Report {
        rungc: env!("CARGO_PKG_VERSION"),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        tools: tools.collect(),
        targets: targets.collect(),
        serial_ports: ports.collect(),
        settings: settings(),
        verbose,
    }
}

fn settings() -> Vec<Setting> {
    let usual = [
        Setting {
            name: "cache folder",
            needed_for: "compiling the runtime library once, instead of for each executable",
            state: cache(),
        },
        Setting {
            name: "characters",
            needed_for: "ladders and timing diagrams in the terminal, which are drawn in UTF-8",
            state: characters(),
        },
    ];
    let search = no_search_path().map(|why| Setting {
        name: "search path",
        needed_for: "finding the tools above, and the parts that a C compiler consists of",
        state: State::Failed(why.to_owned()),
    });
    search.into_iter().chain(usual).collect()
}

/// What is wrong with the variable PATH, if it names no folder.
fn no_search_path() -> Option<&'static str> {
    match std::env::var_os("PATH") {
        None => Some("PATH is not set: the system looks for programs in its default folders alone"),
        Some(folders) if folders.is_empty() => Some("PATH is empty: no program is found"),
        Some(_) => None,
    }
}

fn reason(error: rungc_firmware::build::BuildError) -> String {
    error.to_string()
}

/// Time that a program has to say its version.
const PATIENCE: Duration = Duration::from_secs(5);

/// More than a program says of its version.
const LONGEST: u64 = 1 << 16;

/// The first line that a program prints about its version.
fn version(command: &OsStr) -> State {
    let child = Command::new(command)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = match child {
        Err(error) if error.kind() == ErrorKind::NotFound => return State::Missing,
        Err(error) => return State::Failed(error.to_string()),
        Ok(child) => child,
    };
    let (out, errors) = (text_of(child.stdout.take()), text_of(child.stderr.take()));
    let deadline = Instant::now() + PATIENCE;
    let status = loop {
        match child.try_wait() {
            Err(error) => return State::Failed(error.to_string()),
            Ok(Some(status)) => break status,
            Ok(None) if Instant::now() < deadline => thread::sleep(Duration::from_millis(5)),
            Ok(None) => {
                let _ = child.kill();
                let _ = child.wait();
                let seconds = PATIENCE.as_secs();
                return State::Failed(format!("no answer to --version within {seconds} s"));
            }
        }
    };
    // What a program has started may keep its output open.
    let text = |of: &Receiver<String>| of.recv_timeout(PATIENCE).unwrap_or_default();
    match status.success() {
        true => State::Ok(
            text(&out)
                .lines()
                .next()
                .unwrap_or_default()
                .trim()
                .to_owned(),
        ),
        false => {
            let text = text(&errors);
            let line = text.lines().find(|line| !line.trim().is_empty());
            State::Failed(format!("{status}: {}", line.unwrap_or_default()))
        }
    }
}

/// The text that comes out of a pipe.
fn text_of(pipe: Option<impl Read + Send + 'static>) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut bytes = Vec::new();
        // What cannot be read any more is not there.
        let _ = pipe.map(|pipe| pipe.take(LONGEST).read_to_end(&mut bytes));
        let _ = sender.send(String::from_utf8_lossy(&bytes).into_owned());
    });
    receiver
}

/// Writes a file to the cache, and removes it.
fn cache() -> State {
    let tried = cache::folder().and_then(|folder| {
        tempfile::tempfile_in(&folder)?;
        Ok(folder)
    });
    match tried {
        Ok(folder) => State::Ok(folder.display().to_string()),
        Err(error) => State::Failed(format!("{error}; {} names another folder", cache::VARIABLE)),
    }
}

/// Character encoding of the locale, by the variables that POSIX gives it.
#[cfg(unix)]
fn characters() -> State {
    let set = |name: &&str| std::env::var(name).is_ok_and(|value| !value.is_empty());
    let Some(name) = ["LC_ALL", "LC_CTYPE", "LANG"]
        .into_iter()
        .find(|name| set(name))
    else {
        return State::Failed("no locale is set: `export LANG=C.UTF-8`".to_owned());
    };
    let value = std::env::var(name).unwrap_or_default();
    let bare = value.to_ascii_lowercase().replace('-', "");
    match bare.contains("utf8") {
        true => State::Ok(format!("{name}={value}")),
        false => State::Failed(format!(
            "{name}={value} is not UTF-8: `export {name}=C.UTF-8`"
        )),
    }
}

/// Consoles of Windows take any character.
#[cfg(not(unix))]
fn characters() -> State {
    State::Ok("Unicode console".to_owned())
}

/// Access to a serial port. It is not opened: that would reset some boards.
#[cfg(unix)]
fn access(path: &Path) -> State {
    use rustix::fs::Access;
    match rustix::fs::access(path, Access::READ_OK | Access::WRITE_OK) {
        Ok(()) => State::Ok("may be opened".to_owned()),
        Err(error) => State::Failed(format!("{error}; {}", ports::GROUPS)),
    }
}

/// Access to a serial port, which Windows gives to every user.
#[cfg(not(unix))]
fn access(_path: &Path) -> State {
    State::Ok("may be opened".to_owned())
}

/// Width of the column of names.
const NAMES: usize = 16;

/// Writes a line: name, result, detail.
fn line(f: &mut fmt::Formatter<'_>, name: &str, state: &State) -> fmt::Result {
    match state {
        State::Ok(detail) => writeln!(f, "  {name:<NAMES$} ok       {detail}"),
        State::Missing => writeln!(f, "  {name:<NAMES$} missing"),
        State::Failed(why) => writeln!(f, "  {name:<NAMES$} failed   {why}"),
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Report { rungc, system, .. } = self;
        writeln!(f, "rungc {rungc} on {system}\n\nTools")?;
        for Found { tool, state, .. } in &self.tools {
            line(f, tool.name, state)?;
            if !matches!(state, State::Ok(_)) {
                writeln!(f, "      needed for {}", tool.needed_for)?;
                writeln!(f, "      install: {}", tool.install.here())?;
            }
        }
        writeln!(f, "\nMachines to build for (--target)")?;
        for built in &self.targets {
            let languages = [
                ("C", &built.missing_for_c),
                ("Rust", &built.missing_for_rust),
            ];
            let mut found = String::new();
            for (language, missing) in languages {
                let state = missing.as_ref().map_or("ok", |_| "missing");
                write!(found, "  {language} {state:<7}")?;
            }
            writeln!(f, "  {:<31}{found}  {}", built.triple, built.title)?;
            let missing = [&built.missing_for_c, &built.missing_for_rust];
            for reason in missing.into_iter().flatten().filter(|_| self.verbose) {
                writeln!(f, "      {reason}")?;
            }
        }
        writeln!(f, "\nSerial ports")?;
        if self.serial_ports.is_empty() {
            writeln!(f, "  none")?;
        }
        for port in &self.serial_ports {
            line(f, &port.path, &port.state)?;
        }
        writeln!(f, "\nThis machine")?;
        for setting in &self.settings {
            line(f, setting.name, &setting.state)?;
            if !matches!(setting.state, State::Ok(_)) {
                writeln!(f, "      needed for {}", setting.needed_for)?;
            }
        }
        writeln!(
            f,
            "\nAll other commands need no tool: `rungc book install`."
        )
    }
}
