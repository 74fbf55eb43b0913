//! `rungc run --modbus-tcp` and similar options, with clients of our own, pymodbus and pymcprotocol.

mod common;

use common::{folder, rungc, text};
use std::env;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const PROGRAM: &str = "LD M8000\nADD D0 D1 D2\nLD M0\nOUT Y000\nEND\n";

/// A run with servers, which ends with the test.
struct Run {
    child: Child,
    ports: Vec<u16>,
}

impl Run {
    /// Starts the program with these servers, each at a free port.
    fn with(folder: &Path, servers: &[&str]) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rungc"));
        command.args(["run", "p.il", "--model", "h2u"]);
        for server in servers {
            command.args([server, "0"]);
        }
        let command = command
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let errors = child.stderr.take().unwrap();
        let lines = BufReader::new(errors).lines().map(Result::unwrap);
        let addresses =
            lines.filter_map(|line| Some(line.rsplit_once(" at 127.0.0.1:")?.1.parse().unwrap()));
        let ports = addresses.take(servers.len()).collect();
        Run { child, ports }
    }

    /// What a server answers.
    fn ask(&self, server: usize, request: &[u8], length: usize) -> Vec<u8> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.ports[server])).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        stream.write_all(request).unwrap();
        let mut reply = vec![0; length];
        stream.read_exact(&mut reply).unwrap();
        reply
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn every_server_sees_what_another_has_written() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let run = Run::with(folder.path(), &["--modbus-tcp", "--mc", "--fx"]);
    let write = [0, 1, 0, 0, 0, 6, 1, 6, 0, 100, 0, 7];
    assert_eq!(run.ask(0, &write, 12), write);
    let read_d100 = [
        0x50, 0, 0, 0xff, 0xff, 3, 0, 12, 0, 16, 0, 1, 4, 0, 0, 100, 0, 0, 0xa8, 1, 0,
    ];
    assert_eq!(run.ask(1, &read_d100, 13)[11..], [7, 0]);
    assert_eq!(run.ask(2, b"\x05", 1), b"\x06");
}

#[test]
fn a_run_with_a_server_ends_when_it_is_told_to() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let args = [
        "run",
        "p.il",
        "--model",
        "h2u",
        "--modbus-tcp",
        "0",
        "--for",
        "200ms",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("Modbus TCP at 127.0.0.1:"));
}

#[test]
fn servers_that_cannot_be_opened() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let fails = |args: &[&str]| {
        let output = rungc(folder.path(), &[&["run", "p.il"], args].concat());
        assert_ne!(output.status.code(), Some(0));
        text(&output.stderr).to_string()
    };
    let message = fails(&["--modbus-tcp", &address]);
    assert!(
        message.contains(&format!("cannot serve Modbus TCP at {address}")),
        "{message}"
    );
    let message = fails(&["--mc", "plc:5001"]);
    assert!(
        message.contains("an address is written `127.0.0.1:5020`"),
        "{message}"
    );
    let message = fails(&["--modbus-tcp", "0", "--plot", "p.svg"]);
    assert!(message.contains("--plot: state with --for"), "{message}");
    assert!(!folder.path().join("p.svg").exists());
}

/// A Python that has the module; `RUNGC_PYTHON` names one.
fn python_with(module: &str) -> Option<PathBuf> {
    let python = env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let mut import = Command::new(&python);
    import.args(["-c", &format!("import {module}")]);
    let found = import
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    found.then(|| python.into())
}

/// Runs a client of `tests/clients`, if there is a Python with the module that it needs.
fn reads_and_writes(module: &str, server: &str, client: &str) {
    let Some(python) = python_with(module) else {
        eprintln!(
            "skipped: there is no {module} (pip install {module}; RUNGC_PYTHON names a Python that has it)"
        );
        return;
    };
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let run = Run::with(folder.path(), &[server]);
    let clients = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/clients");
    let output = Command::new(python)
        .arg(clients.join(client))
        .arg(run.ports[0].to_string())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}{}",
        text(&output.stdout),
        text(&output.stderr)
    );
}

#[test]
fn pymodbus_reads_and_writes() {
    reads_and_writes("pymodbus", "--modbus-tcp", "modbus_tcp.py");
}

#[test]
fn pymcprotocol_reads_and_writes() {
    reads_and_writes("pymcprotocol", "--mc", "mc.py");
}
