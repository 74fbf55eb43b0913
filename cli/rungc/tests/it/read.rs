//! `rungc read`: against a running program's programming port, and against PLCs that say no, are slow or answer
//! nonsense.

use crate::common::running::Run;
use crate::common::{HANG, MOTOR, folder, rungc, soon, text};
use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::Command;
use std::thread;
use std::time::Instant;

/// The instructions of a list, without steps, comments and properties.
fn instructions(list: &str) -> Vec<String> {
    let lines = list
        .lines()
        .map(|line| line.split(';').next().unwrap().trim());
    let lines = lines.map(|line| line.trim_start_matches(|c: char| c.is_ascii_digit()).trim());
    lines
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect()
}

/// A program longer than many frames.
fn long() -> String {
    let rung = |n: usize| format!("LD M{n}\nMOV K{n} D{n}\nOUT Y{:03o}\n", n % 128);
    (0..700).map(rung).collect::<String>() + "END\n"
}

#[test]
fn a_running_program_is_read_back_over_tcp() {
    for (list, model, cpu) in [
        (MOTOR, "h2u", "FX2N/FX2NC"),
        (&long(), "fx3u", "FX3U/FX3UC"),
    ] {
        let folder = folder(&[("p.il", list.as_bytes())]);
        let run = Run::new(folder.path(), model, &["--fx"], &[]);
        let port = format!("tcp:127.0.0.1:{}", run.port("programming port"));
        let output = rungc(folder.path(), &["read", "--port", &port, "-o", "out.il"]);
        let messages = text(&output.stderr);
        assert!(output.status.success(), "{messages}");
        assert!(messages.contains(&format!("Read {cpu}")), "{messages}");
        let back = fs::read_to_string(folder.path().join("out.il")).unwrap();
        assert_eq!(instructions(&back), instructions(list));
        assert!(back.starts_with(&format!(";! cpu = {cpu}\n")), "{back}");
    }
}

#[test]
fn a_running_program_is_read_back_over_a_serial_line() {
    let folder = folder(&[("p.il", MOTOR.as_bytes())]);
    let run = Run::new(folder.path(), "h2u", &[], &["COM0"]);
    let args = [
        "read",
        "--port",
        run.line("COM0"),
        "--to",
        "image",
        "-o",
        "out.bin",
        "--timeout",
        "60000",
    ];
    let output = rungc(folder.path(), &args);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let convert = ["convert", "p.il", "--to", "image", "-o", "same.bin"];
    assert!(rungc(folder.path(), &convert).status.success());
    let bytes = |name| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("out.bin"), bytes("same.bin"));
}

/// A PLC whose answers a test chooses.
struct Fake {
    memory: Vec<u8>,
    /// The answer to a request instead of the usual one, by the number of the request from 0 on.
    instead: fn(usize, &str) -> Option<Vec<u8>>,
}

fn framed(text: &str) -> Vec<u8> {
    let sum = text.bytes().fold(3_u8, u8::wrapping_add);
    format!("\x02{text}\x03{sum:02X}").into_bytes()
}

const NAK: &[u8] = b"\x15";

impl Fake {
    /// Answer of an FX2N to a text.
    fn answer(&self, request: &str) -> Vec<u8> {
        let number = |digits: &str| usize::from_str_radix(digits, 16).unwrap();
        match request {
            "" => b"\x06".to_vec(),
            "00E0202" => framed("245E"),
            read if read.starts_with("E01") => {
                let (from, count) = (number(&read[3..7]) - 0x8000, number(&read[7..]));
                let byte = |at| self.memory.get(at).copied().unwrap_or(0xFF);
                framed(
                    &(from..from + count)
                        .map(|at| format!("{:02X}", byte(at)))
                        .collect::<String>(),
                )
            }
            _ => NAK.to_vec(),
        }
    }

    fn serve(&self, mut client: TcpStream) {
        let mut requests = 0;
        let mut request = Vec::new();
        let mut byte = [0];
        while client.read_exact(&mut byte).is_ok() {
            request.push(byte[0]);
            let text = match request.as_slice() {
                [0x05] => String::new(),
                [0x02, text @ .., 0x03, _, _] => String::from_utf8(text.to_vec()).unwrap(),
                _ => continue,
            };
            assert!(
                !text.starts_with(['1', '7', '8', 'B']),
                "{text} would change something"
            );
            assert!(
                !["E1", "E6", "E7", "E8", "F7"]
                    .iter()
                    .any(|change| text.starts_with(change))
            );
            request.clear();
            let answer = (self.instead)(requests, &text).unwrap_or_else(|| self.answer(&text));
            requests += 1;
            if client.write_all(&answer).is_err() {
                return;
            }
        }
    }

    /// Messages of `rungc read` about this PLC, its success, and the file that it has written.
    fn read(self, folder: &Path, more: &[&str]) -> (String, bool, Option<String>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().to_string();
        let plc = thread::spawn(move || self.serve(listener.accept().unwrap().0));
        let target = format!("tcp:{port}");
        let args = [
            &[
                "read",
                "--port",
                &target,
                "-o",
                "out.il",
                "--timeout",
                "3000",
            ],
            more,
        ]
        .concat();
        let output = rungc(folder, &args);
        plc.join().unwrap();
        let messages = text(&output.stderr).replace(&port, "PLC");
        let written = fs::read_to_string(folder.join("out.il")).ok();
        (messages, output.status.success(), written)
    }
}

/// The image of a list.
fn image(list: &str) -> Vec<u8> {
    let folder = folder(&[("a.il", list.as_bytes())]);
    let convert = ["convert", "a.il", "--to", "image", "-o", "a.bin"];
    assert!(rungc(folder.path(), &convert).status.success());
    fs::read(folder.path().join("a.bin")).unwrap()
}

/// Messages of `rungc read` about a PLC that answers some requests differently; it has written nothing.
fn rejected(memory: Vec<u8>, more: &[&str], instead: fn(usize, &str) -> Option<Vec<u8>>) -> String {
    let folder = folder(&[]);
    let (messages, success, written) = Fake { memory, instead }.read(folder.path(), more);
    assert!(!success && written.is_none(), "{messages}");
    let files = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(files, 0, "nothing half-written: {messages}");
    messages
}

#[test]
fn noise_damage_and_silence_are_overcome_by_asking_again() {
    let folder = folder(&[]);
    let plc = Fake {
        memory: image(&long()),
        instead: |nth, _| match nth {
            0 => Some(b"\x00\x7f\x06".to_vec()),
            2 => Some(b"\x02245E\x0300".to_vec()),
            7 => Some(Vec::new()),
            9 => Some(b"\x02FF".to_vec()),
            _ => None,
        },
    };
    let (messages, success, written) = plc.read(folder.path(), &[]);
    assert!(success, "{messages}");
    assert_eq!(instructions(&written.unwrap()), instructions(&long()));
}

#[test]
fn a_protected_plc_is_named_and_not_read() {
    let mut keyword = image("END\n");
    keyword[8..16].copy_from_slice(b"12345678");
    insta::assert_snapshot!("read_keyword", rejected(keyword, &[], |_, _| None));
    let nak = rejected(image("END\n"), &[], |_, text| {
        text.starts_with("E01").then(|| NAK.to_vec())
    });
    insta::assert_snapshot!("read_nak", nak);
}

#[test]
fn a_plc_that_does_not_answer_is_given_up() {
    let begin = Instant::now();
    let silent = rejected(image("END\n"), &["--retries", "1"], |_, _| Some(Vec::new()));
    insta::assert_snapshot!("read_silent", silent);
    assert!(begin.elapsed() < HANG);
    let stranger = rejected(image("END\n"), &[], |_, _| Some(NAK.to_vec()));
    insta::assert_snapshot!("read_stranger", stranger);
    let flood = rejected(image("END\n"), &["--retries", "0"], |_, text| {
        text.starts_with("E01")
            .then(|| [&b"\x02"[..], &[b'0'; 4000]].concat())
    });
    insta::assert_snapshot!("read_flood", flood);
    let short = rejected(image("END\n"), &[], |_, text| {
        text.starts_with("E01").then(|| framed("00"))
    });
    insta::assert_snapshot!("read_short", short);
}

/// Whatever `--timeout` says, and nothing is written.
#[cfg(unix)]
#[test]
fn an_interrupted_read_ends_at_once() {
    let folder = folder(&[]);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp:{}", listener.local_addr().unwrap());
    let patient = ["--timeout", "600000", "-o", "out.il"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["read", "--port", &port])
        .args(patient)
        .current_dir(folder.path())
        .spawn()
        .unwrap();
    let mut line = listener.accept().unwrap().0;
    let mut asked = [0];
    line.read_exact(&mut asked).unwrap();
    let pid = child.id().to_string();
    let ended = Command::new("kill").args(["-TERM", &pid]).status();
    assert!(ended.unwrap().success());
    soon("it ends", || child.try_wait().unwrap().is_some());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_is_not_understood_is_saved_only_as_an_image() {
    let mut unknown = image("LD X000\nOUT Y000\nEND\n");
    unknown[0x5C..0x5E].copy_from_slice(&[0xFF, 0x0F]);
    insta::assert_snapshot!("read_unknown", rejected(unknown.clone(), &[], |_, _| None));
    let folder = folder(&[]);
    let plc = Fake {
        memory: unknown.clone(),
        instead: |_, _| None,
    };
    let args = ["--to", "image", "--force", "-o"];
    let path = folder.path().join("all.bin");
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = format!("tcp:{}", listener.local_addr().unwrap());
    let served = thread::spawn(move || plc.serve(listener.accept().unwrap().0));
    let output = rungc(
        folder.path(),
        &[
            &["read", "--port", &port][..],
            &args,
            &[path.to_str().unwrap()],
        ]
        .concat(),
    );
    served.join().unwrap();
    assert_eq!(fs::read(path).unwrap(), unknown, "{}", text(&output.stderr));
    let empty = image("END\n")[..0x5C].to_vec();
    insta::assert_snapshot!("read_empty", rejected(empty, &[], |_, _| None));
}

#[test]
fn what_is_asked_of_the_command_line_is_checked_first() {
    let folder = folder(&[("there.il", b"")]);
    for (args, why) in [
        (
            &["read", "--port", "tcp:127.0.0.1:1", "-o", "there.il"][..],
            "already exists",
        ),
        (
            &["read", "--port", "tcp:127.0.0.1:1"],
            "cannot open tcp:127.0.0.1:1",
        ),
        (
            &["read", "--port", "/dev/no-such-port"],
            "cannot open /dev/no-such-port",
        ),
        (
            &["read", "--port", "pty"],
            "the other end is at a serial port",
        ),
        (&["read"], "--port <PORT>"),
        (&["read", "--port", "x", "--baud", "1"], "--baud"),
    ] {
        let output = rungc(folder.path(), args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(
            text(&output.stderr).contains(why),
            "{args:?}: {}",
            text(&output.stderr)
        );
    }
}
