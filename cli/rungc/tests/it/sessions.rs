//! Sessions between the vendor's editors and PLCs, which others have recorded and published (`clients/sessions/`),
//! replayed against the programming port of a running program.

use crate::common::running::Run;
use crate::common::{HANG, folder, soon};
use std::io::{Read, Write};
use std::net::TcpStream;

const ACK: &[u8] = &[0x06];
const NAK: &[u8] = &[0x15];

/// Forces M8037 on, which puts a PLC in STOP.
const STOP: &[u8] = b"\x027250F\x0317";

/// An answer of the port, whole.
fn answer(port: &mut TcpStream) -> Vec<u8> {
    let mut answer = vec![0];
    port.read_exact(&mut answer).unwrap();
    if answer == [0x02] {
        while !matches!(answer[..], [.., 0x03, _, _]) {
            let mut byte = [0];
            port.read_exact(&mut byte).unwrap();
            answer.extend(byte);
        }
    }
    answer
}

/// Returns true if an answer is STX, this many digits, ETX and the right sum.
fn is_data(answer: &[u8], length: usize) -> bool {
    let [0x02, digits @ .., 0x03, high, low] = answer else {
        return false;
    };
    let sum = digits.iter().fold(0x03u8, |sum, &c| sum.wrapping_add(c));
    answer.len() == length
        && digits.iter().all(u8::is_ascii_hexdigit)
        && format!("{sum:02X}").as_bytes() == [*high, *low]
}

/// Number of characters in the answer to a request to read: it ends with the number of bytes, before ETX and the sum.
fn length(request: &[u8]) -> usize {
    let [.., high, low, 0x03, _, _] = request else {
        panic!("{request:02x?}");
    };
    let digits = [*high, *low];
    let count = usize::from_str_radix(std::str::from_utf8(&digits).unwrap(), 16).unwrap();
    2 * count + 4
}

/// Sends what the editor has sent, and compares what comes back as the session says.
fn replay(session: &str, model: &str, in_stop: bool) {
    let folder = folder(&[("p.il", b"LD M8000\nOUT M0\nEND\n")]);
    let run = Run::new(folder.path(), model, &["--fx"], &[]);
    let mut port = TcpStream::connect(("127.0.0.1", run.port("programming port"))).unwrap();
    port.set_read_timeout(Some(HANG)).unwrap();
    if in_stop {
        port.write_all(STOP).unwrap();
        assert_eq!(answer(&mut port), ACK);
        // M8000 is off from the end of the scan on.
        soon("the PLC is in STOP", || {
            port.write_all(b"\x02001E001\x036A").unwrap();
            let read = answer(&mut port);
            assert!(is_data(&read, 6), "{read:02x?}");
            char::from(read[2]).to_digit(16).unwrap() & 1 == 0
        });
    }
    let mut answers = 0;
    let mut asked = Vec::new();
    for line in session.lines() {
        let line = line.split_once('#').map_or(line, |(before, _)| before);
        let (Some(kind), bytes) = (line.chars().next(), line.get(1..).unwrap_or_default()) else {
            continue;
        };
        let bytes: Vec<u8> = bytes
            .split_whitespace()
            .map(|byte| u8::from_str_radix(byte, 16).unwrap())
            .collect();
        if kind == '>' {
            port.write_all(&bytes).unwrap();
            asked = bytes;
            continue;
        }
        let answer = answer(&mut port);
        let right = match kind {
            '<' => answer == bytes,
            '~' => is_data(&answer, bytes.len()),
            '?' => is_data(&answer, length(&asked)),
            '!' => answer == NAK,
            _ => panic!("{line}"),
        };
        assert!(right, "{line}: the port answers {answer:02x?}");
        answers += 1;
    }
    assert!(answers > 5);
}

#[test]
fn an_editor_monitors_an_fx3u() {
    replay(
        include_str!("../clients/sessions/fx3u-monitor.txt"),
        "fx3u",
        false,
    );
}

#[test]
fn an_editor_wants_to_write_a_program_to_an_fx1s() {
    replay(
        include_str!("../clients/sessions/fx1s-write.txt"),
        "fx1s",
        true,
    );
}

#[test]
fn an_editor_wants_to_write_a_program_to_an_fx1n() {
    replay(
        include_str!("../clients/sessions/fx1n-write.txt"),
        "fx1n",
        true,
    );
}
