//! `rungc run --serial`: a serial port of the PLC as a pseudo-terminal, with a client of our own and with mbpoll.
#![cfg(unix)]

mod common;

use common::{folder, rungc, text};
use serial2::SerialPort;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

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

/// A run with COM1 at a pseudo-terminal, which ends with the test.
struct Run {
    child: Child,
    path: String,
}

impl Run {
    fn of(folder: &Path) -> Run {
        let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["run", "p.il", "--model", "h2u", "--serial", "COM1=pty"])
            .current_dir(folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let errors = child.stderr.take().unwrap();
        let mut lines = BufReader::new(errors).lines().map(Result::unwrap);
        let path = lines.find_map(|line| Some(line.strip_prefix("rungc: COM1 at ")?.to_owned()));
        // The first scans set up the line.
        std::thread::sleep(Duration::from_millis(500));
        Run {
            child,
            path: path.unwrap(),
        }
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a request until it is answered in time: on a loaded machine a request may arrive with a pause in it, which cuts the frame.
fn ask(port: &SerialPort, request: &[u8], length: usize) -> Vec<u8> {
    for _ in 0..5 {
        port.write_all(request).unwrap();
        let mut reply = vec![0; length];
        if port.read_exact(&mut reply).is_ok() {
            return reply;
        }
        port.discard_buffers().unwrap();
    }
    panic!("no answer to {request:02x?}");
}

#[test]
fn a_client_on_a_pseudo_terminal_reads_and_writes() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let run = Run::of(folder.path());
    let mut port = SerialPort::open(&run.path, 9600).unwrap();
    port.set_read_timeout(Duration::from_secs(4)).unwrap();
    let write_d0 = [1, 6, 0, 0, 0, 5, 0x49, 0xc9];
    assert_eq!(ask(&port, &write_d0, 8), write_d0);
    let read_d2 = [1, 3, 0, 2, 0, 1, 0x25, 0xca];
    assert_eq!(ask(&port, &read_d2, 7)[..5], [1, 3, 2, 0, 5]);
}

#[test]
fn mbpoll_reads_and_writes() {
    if Command::new("mbpoll").arg("-V").output().is_err() {
        eprintln!("skipped: there is no mbpoll (apt-get install mbpoll)");
        return;
    }
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let run = Run::of(folder.path());
    let poll = |args: &[&str]| {
        let line = [
            "-m", "rtu", "-b", "9600", "-P", "none", "-a", "1", "-o", "5", "-r", "1", "-1",
        ];
        let mut command = Command::new("mbpoll");
        let output = command.args(line).args(args).output().unwrap();
        let shown = text(&output.stdout).to_string();
        assert!(output.status.success(), "{shown}{}", text(&output.stderr));
        shown
    };
    poll(&["-t", "4", &run.path, "20", "22"]);
    let shown = poll(&["-t", "4", "-c", "3", &run.path]);
    assert!(shown.contains("[3]: \t42"), "{shown}");
}

#[test]
fn lines_that_cannot_be_opened() {
    let folder = folder(&[("p.il", SLAVE.as_bytes())]);
    let fails = |line: &str| {
        let output = rungc(
            folder.path(),
            &["run", "p.il", "--model", "h2u", "--serial", line],
        );
        assert_ne!(output.status.code(), Some(0));
        text(&output.stderr).to_string()
    };
    let message = fails("COM1");
    assert!(
        message.contains("a line is written `COM1=/dev/ttyUSB0`"),
        "{message}"
    );
    let message = fails("COM7=pty");
    assert!(
        message.contains("has no port COM7; its ports are COM0, COM1"),
        "{message}"
    );
    let message = fails("COM1=no-such-tty");
    assert!(
        message.contains("--serial: cannot open no-such-tty"),
        "{message}"
    );
}
