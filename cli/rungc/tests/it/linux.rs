//! A run as a PLC on Linux: RUN and STOP by signal, standstills, files that cannot be written, hostile input.

use crate::common::{folder, text};
use std::fs;
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Y000 follows X000; D0 counts scans, D200 (latched) too.
const PROGRAM: &str = "\
LD X000
OUT Y000
LD M8000
INC D0
INC D200
LD M100
OUT Y001
END
";

const SETTINGS: &str = "\
[project]
program = 'p.il'
model = 'fx3u'

[retain]
file = 'disk/latched'
fault = 'M102'

[io.files]
files = '.'
every = '5ms'
fault = 'M100'
X000 = 'read switch'
Y000 = 'write lamp'
D0 = 'write scans'
M102 = 'write unsaved'

[io.lost]
files = 'plugged'
fault = 'M101'
X010 = 'read none'
";

/// A run of `rungc serve`, which ends with the test.
struct Serving {
    child: Child,
    folder: TempDir,
}

impl Serving {
    fn start(args: &[&str]) -> Serving {
        let folder = folder(&[
            ("p.il", PROGRAM.as_bytes()),
            ("rungc.toml", SETTINGS.as_bytes()),
            ("switch", b"1"),
        ]);
        fs::create_dir(folder.path().join("disk")).unwrap();
        let mut serve = Command::new(env!("CARGO_BIN_EXE_rungc"));
        serve.arg("serve").args(args).current_dir(folder.path());
        let pipes = serve.stdin(Stdio::piped()).stdout(Stdio::null());
        let child = pipes.stderr(Stdio::piped()).spawn().unwrap();
        Serving { child, folder }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn shows(&self, name: &str, value: &str) {
        let until = Instant::now() + Duration::from_secs(30);
        let shown = || fs::read_to_string(self.path().join(name)).unwrap_or_default();
        while shown().trim() != value {
            assert!(Instant::now() < until, "{name} is {}, not {value}", shown());
            thread::sleep(Duration::from_millis(10));
        }
    }

    fn scans(&self) -> i16 {
        let until = Instant::now() + Duration::from_secs(30);
        loop {
            let text = fs::read_to_string(self.path().join("scans")).unwrap_or_default();
            match text.trim().parse() {
                Ok(scans) => return scans,
                Err(_) => assert!(Instant::now() < until, "scans continue"),
            }
        }
    }

    fn go_on(&self) {
        let before = self.scans();
        let until = Instant::now() + Duration::from_secs(30);
        while self.scans() == before {
            assert!(Instant::now() < until, "scans continue");
        }
    }

    fn signal(&self, name: &str) {
        let pid = self.child.id().to_string();
        let status = Command::new("kill")
            .args([&format!("-{name}"), &pid])
            .status();
        assert!(status.unwrap().success());
    }

    /// Ctrl-C; the exit code, and what it has reported.
    fn end(mut self) -> (Option<i32>, String) {
        self.signal("INT");
        let mut said = Vec::new();
        self.child
            .stderr
            .take()
            .unwrap()
            .read_to_end(&mut said)
            .unwrap();
        let code = self.child.wait().unwrap().code();
        (code, text(&said).to_string())
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn signals_turn_the_switch() {
    let serving = Serving::start(&[]);
    serving.shows("lamp", "1");
    serving.signal("USR1");
    serving.shows("lamp", "0");
    serving.signal("USR2");
    serving.shows("lamp", "1");
    serving.go_on();
    let (code, said) = serving.end();
    assert_eq!(code, Some(130), "{said}");
    assert!(
        said.contains("rungc: STOP at ") && said.contains("rungc: RUN at "),
        "{said}"
    );
    assert!(
        said.contains(" us late on average, 99.9 % of them at most "),
        "{said}"
    );
}

#[test]
fn a_standstill_is_not_caught_up() {
    let serving = Serving::start(&[]);
    serving.go_on();
    serving.signal("STOP");
    thread::sleep(Duration::from_millis(2500));
    serving.signal("CONT");
    let before = serving.scans();
    thread::sleep(Duration::from_millis(500));
    // 250 scans at once would be what was missed.
    let scans = serving.scans() - before;
    assert!(scans < 150, "{scans} scans in half a second");
    let (_, said) = serving.end();
    assert!(said.contains("rungc: the run stood still for "), "{said}");
}

#[test]
fn what_is_plugged_in_later_is_found() {
    let serving = Serving::start(&[]);
    serving.go_on();
    fs::create_dir(serving.path().join("plugged")).unwrap();
    fs::write(serving.path().join("plugged/none"), "1").unwrap();
    thread::sleep(Duration::from_millis(2500));
    let (_, said) = serving.end();
    let said_of_it = said
        .lines()
        .filter(|line| line.starts_with("rungc: io lost: "));
    let said_of_it: Vec<_> = said_of_it.collect();
    assert_eq!(said_of_it.len(), 2, "{said}");
    assert!(said_of_it[0].ends_with("plugged: there is no such folder"));
    assert!(said_of_it[1].starts_with("rungc: io lost: connected to "));
}

#[test]
fn a_disk_that_vanishes_does_not_stop_the_plc() {
    let serving = Serving::start(&[]);
    serving.go_on();
    fs::remove_dir_all(serving.path().join("disk")).unwrap();
    serving.shows("unsaved", "1");
    serving.go_on();
    fs::create_dir(serving.path().join("disk")).unwrap();
    serving.shows("unsaved", "0");
    assert!(serving.path().join("disk/latched").exists());
    let (code, said) = serving.end();
    assert_eq!(code, Some(130), "{said}");
    assert_eq!(
        said.matches("latched devices are not saved").count(),
        1,
        "{said}"
    );
    assert!(said.contains("latched devices are saved again"), "{said}");
}

#[test]
fn the_console_takes_anything() {
    let program = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("io.toml", b"[io.console]\nconsole = true\nX000-X007 = 'read'\nD10 = 'read loss -3'\nY000 = 'write'\n"),
    ]);
    let mut run = Command::new(env!("CARGO_BIN_EXE_rungc"));
    run.args([
        "run", "p.il", "--io", "io.toml", "--watch", "D10", "--for", "4s",
    ]);
    let pipes = run.current_dir(program.path()).stdin(Stdio::piped());
    let mut run = pipes
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = run.stdin.take().unwrap();
    let mut hostile = vec![b'X'; 100_000];
    hostile.extend(
        b"\n\0\xff=\xfe\nX0=\n=1\nX777=1\nX0=2\nX0=-1\nD10=99999999999\nD10=65535\nx0 = 1\n",
    );
    input.write_all(&hostile).unwrap();
    input.flush().unwrap();
    thread::sleep(Duration::from_millis(1500));
    drop(input);
    let output = run.wait_with_output().unwrap();
    let (shown, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(shown.contains("Y000=1\n"), "{shown}");
    // 65535 as a register shows it; -3 when the input has ended, which turns X000 off.
    let rows: Vec<_> = shown
        .lines()
        .filter_map(|line| line.split_once(" s ")?.1.trim().parse().ok())
        .collect();
    assert!(rows.ends_with(&[-1, -3]), "{shown}");
    assert!(shown.contains("Y000=0\n"), "{shown}");
    assert!(said.contains("standard input has ended"), "{said}");
}

#[test]
fn a_priority_is_taken_where_it_is_allowed() {
    let serving = Serving::start(&["--priority", "10"]);
    serving.go_on();
    let pid = serving.child.id();
    // Field 41 of the process's state is its policy (proc(5)); 1 is SCHED_FIFO.
    let stat = fs::read_to_string(format!("/proc/{pid}/stat"));
    let (_, said) = serving.end();
    let refused = said.contains("--priority 10: ") && said.contains("CAP_SYS_NICE");
    if let Ok(stat) = stat {
        let fields = stat.rsplit_once(')').unwrap().1.split_whitespace();
        let policy = fields.clone().nth(41 - 3);
        assert_eq!(policy == Some("1"), !refused, "{stat}{said}");
    }
}
