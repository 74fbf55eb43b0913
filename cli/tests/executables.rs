//! Serial ports of executables: `NAME --serial COM1=pty`, in C, and `--serial COM1=/dev/pts/1`, in Rust, with mbpoll as their master.
#![cfg(unix)]

mod common;

use common::{folder, rungc, text};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// COM1 is a Modbus slave, RTU, station 1, 9600 bit/s, 8 data bits, no parity, 1 stop bit.
const SLAVE: &str = "\
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
LD M8000
ADD D0 D1 D2
END
";

/// A program that ends with the test.
struct Running(Child);

impl Running {
    /// Starts a program; what it says about COM1 after these words, once it has opened the line.
    fn start(command: &mut Command, words: &str) -> (Running, String) {
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = child.stderr.take().unwrap();
        let mut lines = BufReader::new(errors).lines().map_while(Result::ok);
        let said = lines.find_map(|line| Some(line.split_once(words)?.1.to_owned()));
        std::thread::spawn(move || lines.count());
        (Running(child), said.expect("the program opens its line"))
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Whether programs are there that the test needs.
fn has(programs: &[&str]) -> bool {
    let missing = |program: &&&str| Command::new(program).arg("-V").output().is_err();
    match programs.iter().find(missing) {
        Some(program) => {
            eprintln!("skipped: there is no {program} (apt-get install {program})");
            false
        }
        None => true,
    }
}

/// Writes two registers and reads three. On a loaded machine a request may arrive with a pause in it, which cuts the frame.
fn answers(path: &str) {
    let poll = |args: &[&str]| {
        let line = [
            "-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-o", "3", "-r", "1", "-1", "-t",
            "4",
        ];
        let mut last = None;
        for _ in 0..10 {
            let output = Command::new("mbpoll")
                .args(line)
                .args(args)
                .output()
                .unwrap();
            if output.status.success() {
                return text(&output.stdout).to_string();
            }
            last = Some(output);
        }
        panic!(
            "{}",
            last.map_or(String::new(), |o| text(&o.stderr).to_string())
        );
    };
    poll(&[path, "20", "22"]);
    std::thread::sleep(std::time::Duration::from_millis(200));
    let shown = poll(&["-c", "3", path]);
    assert!(shown.contains("[1]: \t20"), "{shown}");
    assert!(shown.contains("[3]: \t42"), "{shown}");
}

fn built(folder: &Path, args: &[&str]) {
    let args = [&["build", "slave.il", "--model", "h2u"], args].concat();
    let output = rungc(folder, &args);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn an_executable_in_c_answers_on_a_pseudo_terminal() {
    if !has(&["mbpoll"]) {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    built(folder.path(), &["--emit", "bin", "-o", "slave"]);
    let program = folder.path().join("slave");
    let (_running, path) = Running::start(
        Command::new(&program).args(["--serial", "COM1=pty"]),
        "COM1 at ",
    );
    answers(&path);
    for (args, said) in [
        (
            &["--serial", "COM7=pty"][..],
            "the program has no port COM7",
        ),
        (&["--serial", "tty"], "a line is written COM1=/dev/ttyUSB0"),
        (&["--serial", "COM1=no-such-tty"], "No such file"),
        (&["--modem"], "usage: "),
    ] {
        let output = Command::new(&program).args(args).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(text(&output.stderr).contains(said), "{args:?}");
    }
}

/// The emitted package, built as it is.
fn rust_program(folder: &Path) -> PathBuf {
    built(folder, &["--emit", "rust", "--main", "-o", "slave"]);
    let output = Command::new("cargo")
        .args(["build", "--quiet", "--offline"])
        .env("CARGO_PROFILE_DEV_DEBUG", "false")
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .current_dir(folder.join("slave"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    folder.join("target/debug/slave")
}

#[test]
fn an_executable_in_rust_answers_on_a_terminal() {
    if !has(&["mbpoll", "socat", "stty"]) {
        return;
    }
    let folder = folder(&[("slave.il", SLAVE.as_bytes())]);
    let program = rust_program(folder.path());
    let [ours, theirs] = ["ours", "theirs"].map(|name| folder.path().join(name));
    let end = |path: &Path| format!("pty,raw,echo=0,link={}", path.display());
    let mut socat = Command::new("socat");
    socat.args(["-d", "-d"]).args([end(&ours), end(&theirs)]);
    let (_cable, _) = Running::start(&mut socat, "starting data transfer loop");
    let line = format!("COM1={}", ours.display());
    let (_running, _) =
        Running::start(Command::new(&program).args(["--serial", &line]), "COM1 at ");
    answers(&theirs.display().to_string());
    let output = Command::new(&program)
        .args(["--serial", "COM7=x"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("the program has no port COM7"));
}
