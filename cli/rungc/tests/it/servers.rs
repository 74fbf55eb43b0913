//! `rungc run --modbus-tcp` and similar options, with clients of our own.

use crate::common::running::{Run, keeps_the_weekday_of_a_client};
use crate::common::{HANG, folder, rungc, text};
use std::io::{Read, Write};
use std::net::TcpStream;

const PROGRAM: &str = "LD M8000\nADD D0 D1 D2\nLD M0\nOUT Y000\nEND\n";

/// Answer of a server at this port.
fn ask(port: u16, request: &[u8], length: usize) -> Vec<u8> {
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    stream.write_all(request).unwrap();
    let mut reply = vec![0; length];
    stream.read_exact(&mut reply).unwrap();
    reply
}

#[test]
fn every_server_sees_what_another_has_written() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &["--modbus-tcp", "--mc", "--fx"], &[]);
    let [modbus, mc, fx] =
        ["Modbus TCP", "MC protocol", "programming port"].map(|server| run.port(server));
    let write = [0, 1, 0, 0, 0, 6, 1, 6, 0, 100, 0, 7];
    assert_eq!(ask(modbus, &write, 12), write);
    let read_d100 = [
        0x50, 0, 0, 0xff, 0xff, 3, 0, 12, 0, 16, 0, 1, 4, 0, 0, 100, 0, 0, 0xa8, 1, 0,
    ];
    assert_eq!(ask(mc, &read_d100, 13)[11..], [7, 0]);
    assert_eq!(ask(fx, b"\x05", 1), b"\x06");
}

#[test]
fn a_client_sets_the_clock() {
    let folder = folder(&[("p.il", PROGRAM.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &["--mc"], &[]);
    keeps_the_weekday_of_a_client(&format!("127.0.0.1:{}", run.port("MC protocol")));
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
        message.contains(&format!(
            "--modbus-tcp: cannot serve Modbus TCP at {address}: "
        )) && message.contains("choose another, or 0 for a free one"),
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
