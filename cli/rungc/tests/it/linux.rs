//! A run as a PLC on Linux: RUN and STOP by signal, standstills, files that cannot be written, hostile input.

use crate::common::{folder, soon, text};
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
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
    /// Its reports so far.
    messages: Arc<Mutex<String>>,
    reader: Option<JoinHandle<()>>,
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
        let mut child = pipes.stderr(Stdio::piped()).spawn().unwrap();
        let errors = BufReader::new(child.stderr.take().unwrap());
        let messages = Arc::new(Mutex::new(String::new()));
        let written = Arc::clone(&messages);
        let reader = thread::spawn(move || {
            for line in errors.lines().map_while(Result::ok) {
                *written.lock().unwrap() += &(line + "\n");
            }
        });
        Serving {
            child,
            folder,
            messages,
            reader: Some(reader),
        }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn shows(&self, name: &str, value: &str) {
        soon(&format!("{name} is {value}"), || {
            let shown = fs::read_to_string(self.path().join(name));
            shown.is_ok_and(|shown| shown.trim() == value)
        });
    }

    fn scans(&self) -> i16 {
        let mut scans = None;
        soon("scans are counted", || {
            let text = fs::read_to_string(self.path().join("scans")).unwrap_or_default();
            scans = text.trim().parse().ok();
            scans.is_some()
        });
        scans.unwrap()
    }

    fn go_on(&self) {
        let before = self.scans();
        soon("scans continue", || self.scans() != before);
    }

    fn signal(&self, name: &str) {
        let pid = self.child.id().to_string();
        let status = Command::new("kill")
            .args([&format!("-{name}"), &pid])
            .status();
        assert!(status.unwrap().success());
    }

    /// Waits until it has reported something that contains this text.
    fn says(&self, text: &str) {
        soon(text, || self.messages.lock().unwrap().contains(text));
    }

    /// Ctrl-C; the exit code, and what it has reported.
    fn end(mut self) -> (Option<i32>, String) {
        self.signal("INT");
        self.reader.take().unwrap().join().unwrap();
        let code = self.child.wait().unwrap().code();
        (code, self.messages.lock().unwrap().clone())
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
    let (code, messages) = serving.end();
    assert_eq!(code, Some(130), "{messages}");
    assert!(
        messages.contains("rungc: STOP at ") && messages.contains("rungc: RUN at "),
        "{messages}"
    );
    assert!(
        messages.contains(" us late on average, 99.9 % of them at most "),
        "{messages}"
    );
}

#[test]
fn a_standstill_is_not_caught_up() {
    let serving = Serving::start(&[]);
    serving.go_on();
    serving.signal("STOP");
    thread::sleep(Duration::from_millis(2500));
    serving.signal("CONT");
    let begin = Instant::now();
    let before = serving.scans();
    thread::sleep(Duration::from_millis(500));
    // 250 scans at once would be what was missed, beside one every 10 ms.
    let scans = serving.scans() - before;
    let passed = begin.elapsed();
    let most = passed.as_millis() / 10 + 100;
    assert!((scans as u128) < most, "{scans} scans in {passed:?}");
    let (_, messages) = serving.end();
    assert!(
        messages.contains("rungc: the run stood still for "),
        "{messages}"
    );
}

#[test]
fn what_is_plugged_in_later_is_found() {
    let serving = Serving::start(&[]);
    serving.go_on();
    fs::create_dir(serving.path().join("plugged")).unwrap();
    fs::write(serving.path().join("plugged/none"), "1").unwrap();
    serving.says("rungc: io lost: connected to ");
    let (_, messages) = serving.end();
    let said_of_it = messages
        .lines()
        .filter(|line| line.starts_with("rungc: io lost: "));
    let said_of_it: Vec<_> = said_of_it.collect();
    assert_eq!(said_of_it.len(), 2, "{messages}");
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
    let (code, messages) = serving.end();
    assert_eq!(code, Some(130), "{messages}");
    assert_eq!(
        messages.matches("latched devices are not saved").count(),
        1,
        "{messages}"
    );
    assert!(
        messages.contains("latched devices are saved again"),
        "{messages}"
    );
}

#[test]
fn the_console_takes_anything() {
    let program = folder(&[
        ("p.il", PROGRAM.as_bytes()),
        ("io.toml", b"[io.console]\nconsole = true\nX000-X007 = 'read'\nD10 = 'read loss -3'\nY000 = 'write'\n"),
    ]);
    let mut run = Command::new(env!("CARGO_BIN_EXE_rungc"));
    run.args([
        "run", "p.il", "--io", "io.toml", "--watch", "D10", "--for", "1h",
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
    let mut lines = BufReader::new(run.stdout.take().unwrap()).lines();
    let mut rows: Vec<i32> = Vec::new();
    let mut shows = |output: &str, value: i32| {
        let mut is_shown = false;
        while !is_shown || rows.last() != Some(&value) {
            let line = lines.next().unwrap().unwrap();
            is_shown |= line == output;
            let row = line.split_once(" s ");
            rows.extend(row.and_then(|(_, row)| row.trim().parse::<i32>().ok()));
        }
    };
    // 65535 as a register shows it; -3 when the input has ended, which turns X000 off.
    shows("Y000=1", -1);
    drop(input);
    shows("Y000=0", -3);
    let pid = run.id().to_string();
    let interrupted = Command::new("kill").args(["-TERM", &pid]).status();
    assert!(interrupted.unwrap().success());
    let output = run.wait_with_output().unwrap();
    let messages = text(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{messages}");
    assert!(rows.ends_with(&[-1, -3]), "{rows:?}");
    assert!(messages.contains("standard input has ended"), "{messages}");
    // What is left out is reported once.
    let reports = |report: &str| messages.matches(report).count();
    let long = format!("io console: `{}…` is left out: ", "X".repeat(40));
    for report in [
        &*long,
        "io console: `X0=2` is left out: the value is 0 or 1",
        "io console: `D10=99999999999` is left out: ",
        "io console: connected to standard input and output",
    ] {
        assert_eq!(reports(report), 1, "{report}: {messages}");
    }
}

#[test]
fn a_priority_is_taken_where_it_is_allowed() {
    let serving = Serving::start(&["--priority", "10"]);
    serving.go_on();
    let pid = serving.child.id();
    // Field 41 of the process's state is its policy (proc(5)); 1 is SCHED_FIFO.
    let stat = fs::read_to_string(format!("/proc/{pid}/stat"));
    let (_, messages) = serving.end();
    let refused = messages.contains("--priority 10: ") && messages.contains("CAP_SYS_NICE");
    if let Ok(stat) = stat {
        let fields = stat.rsplit_once(')').unwrap().1.split_whitespace();
        let policy = fields.clone().nth(41 - 3);
        assert_eq!(policy == Some("1"), !refused, "{stat}{messages}");
    }
}
