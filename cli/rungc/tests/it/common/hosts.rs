//! A program in real time, as each host runs it: executables in C and in Rust, and `rungc serve`.

use super::{HANG, built_in_rust, rungc, text};
use rungc_runtime_sources::cache::Slot;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{self, Receiver};
use std::thread::{self, JoinHandle};
use std::time::Instant;

/// Shows in Y000 to Y003 how often it was started, in D200, which is latched. While X000 is on, D210 (latched) counts
/// scans, Y010 changes after ten scans, and Y011 after 500 ms. Y012 is on while latched devices are not saved, Y013
/// while the hour is another one than at the start.
pub const PROGRAM: &str = "\
LD M8002
INC D200
MOV D8015 D11
LD= D200 K1
OUT Y000
LD= D200 K2
OUT Y001
LD= D200 K3
OUT Y002
LD= D200 K4
OUT Y003
LD X000
INC D210
INC D10
LD>= D10 K10
ALT Y010
MOV K0 D10
LD X000
ANI T0
OUT T0 K5
LD T0
ALT Y011
LD M102
OUT Y012
LD<> D8015 D11
OUT Y013
LD<> D200 K1
CJ P1
LD M8000
RST C101
P1
LD M8000
OUT C101 K9
END
";

/// Its settings; what `rungc serve` prints of it.
pub const SETTINGS: &str = "\
[project]
program = 'starts.il'
model = 'fx3u'

[retain]
fault = 'M102'

[io.shown]
console = true
every = '5ms'
Y010 = 'write'
Y011 = 'write'
Y012 = 'write'
Y013 = 'write'
";

/// Host of the program.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Host {
    InC,
    InRust,
    Serve,
}

/// The executables in C and in Rust, built once in a folder that no other process uses.
pub fn executables() -> &'static [PathBuf; 2] {
    static BUILT: OnceLock<(Slot, [PathBuf; 2])> = OnceLock::new();
    let (_, built) = BUILT.get_or_init(|| {
        let slot = Slot::take(Path::new(env!("CARGO_TARGET_TMPDIR")), "hosts").unwrap();
        let at = slot.path();
        fs::write(at.join("starts.il"), PROGRAM).unwrap();
        fs::write(at.join("rungc.toml"), SETTINGS).unwrap();
        let build = ["build", "starts.il", "--force"];
        let in_c = ["--emit", "bin", "-o", "in-c"];
        let built = rungc(at, &[&build[..], &in_c].concat());
        assert!(built.status.success(), "{}", text(&built.stderr));
        let in_rust = built_in_rust(at, &build, "rust", "starts");
        let in_c = at.join("in-c");
        (slot, [in_c, in_rust])
    });
    built
}

impl Host {
    /// All of them.
    pub fn all() -> [Host; 3] {
        // Before they begin at the same time.
        executables();
        [Host::InC, Host::InRust, Host::Serve]
    }

    /// The exit code of a run that is ended.
    pub fn code(self) -> Option<i32> {
        Some(if self == Host::Serve { 130 } else { 0 })
    }

    /// Starts it in a folder with the program and its settings, and turns X000 on.
    pub fn start(self, folder: &Path, args: &[&str], environment: &[(&str, &str)]) -> Running {
        // A caller in the background ignores SIGINT, and a program that it started would, too.
        let mut command = Command::new("env");
        command.arg("--default-signal=INT");
        match self {
            Host::InC => command.arg(&executables()[0]),
            Host::InRust => command.arg(&executables()[1]),
            Host::Serve => {
                command
                    .arg(env!("CARGO_BIN_EXE_rungc"))
                    .args(["serve", "--set", "X000=1@20ms"])
            }
        };
        let mut child = command
            .args(args)
            .envs(environment.iter().copied())
            .current_dir(folder)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut typed = child.stdin.take().unwrap();
        if self != Host::Serve {
            typed.write_all(b"X0=1\n").unwrap();
        }
        let (sender, shown) = mpsc::channel();
        let printed = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || {
            for line in printed.lines().map_while(Result::ok) {
                let event = event(&line).map(|(terminal, on)| (Instant::now(), terminal, on));
                let _ = event.map(|event| sender.send(event));
            }
        });
        let mut errors = child.stderr.take().unwrap();
        let messages = thread::spawn(move || {
            let mut messages = Vec::new();
            errors.read_to_end(&mut messages).unwrap();
            text(&messages)
        });
        Running {
            child,
            _typed: typed,
            shown,
            messages: Some(messages),
        }
    }
}

/// The terminal that a line shows, and whether it is on: `0.010 s  Y010 on`, or `Y010=1`.
fn event(line: &str) -> Option<(String, bool)> {
    let mut words = line
        .split([' ', '='])
        .skip_while(|word| !word.starts_with('Y'));
    let terminal = words.next()?.to_string();
    let on = words
        .next()
        .is_some_and(|state| ["on", "1"].contains(&state));
    Some((terminal, on))
}

/// A run, which is killed with the test.
pub struct Running {
    child: Child,
    _typed: ChildStdin,
    shown: Receiver<(Instant, String, bool)>,
    messages: Option<JoinHandle<String>>,
}

impl Running {
    /// The next change of a terminal: when it was seen, which one, and whether it is on.
    pub fn next(&mut self) -> Option<(Instant, String, bool)> {
        self.shown.recv_timeout(HANG).ok()
    }

    /// Waits until a terminal is on or off.
    pub fn shows(&mut self, terminal: &str, on: bool) {
        let until = Instant::now() + HANG;
        while let Some((at, shown, state)) = self.next() {
            assert!(at < until, "{terminal} never turns");
            if shown == terminal && state == on {
                return;
            }
        }
        panic!("{terminal} never turns");
    }

    /// Waits until scans have been counted twice from now on.
    pub fn counts(&mut self) {
        while self.shown.try_recv().is_ok() {}
        self.shows("Y010", true);
        self.shows("Y010", false);
    }

    /// No file grows beyond this size from now on: what a full disk is.
    pub fn limit_files(&self, size: &str) {
        let pid = self.child.id().to_string();
        let limit = format!("--fsize={size}:unlimited");
        let prlimit = Command::new("prlimit")
            .args(["--pid", &pid, &limit])
            .status();
        assert!(prlimit.unwrap().success());
    }

    /// Ends it in order: its exit code, and what it has reported.
    pub fn end(mut self) -> (Option<i32>, String) {
        let pid = self.child.id().to_string();
        let kill = Command::new("kill").args(["-INT", &pid]).status().unwrap();
        assert!(kill.success());
        let code = self.child.wait().unwrap().code();
        let messages = self.messages.take().unwrap().join().unwrap();
        (code, messages)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
