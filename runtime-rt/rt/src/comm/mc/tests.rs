//! Frames as pymcprotocol 0.3 sends and understands them (3E), and of FX3's description (1E).

use super::*;
use crate::comm::watched::{Watched, bytes, hex, reply_of};
use crate::plc::Class;
use proptest::prelude::*;
use std::borrow::ToOwned;
use std::format;
use std::string::String;
use std::vec::Vec;

fn exchange(map: &mut Watched, request: &[u8]) -> (Vec<u8>, Result<(), LineFault>) {
    reply_of(|reply| answer(request, map, reply))
}

fn ask(map: &mut Watched, request: &str) -> String {
    let request = bytes(request);
    assert_eq!(cut(&request), Cut::Whole);
    assert_eq!(cut(&request[..request.len() - 1]), Cut::More);
    hex(&exchange(map, &request).0)
}

const DONE: &str = "D0 00 00 FF FF 03 00 02 00 00 00";

#[test]
fn batches_of_pymcprotocol() {
    let mut map = Watched::new();
    map.plc.set_d(100, &[0x1234, 2, -4323]);
    map.plc.set_m(103, "11");
    assert_eq!(
        ask(
            &mut map,
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 00 00 64 00 00 A8 03 00"
        ),
        "D0 00 00 FF FF 03 00 08 00 00 00 34 12 02 00 1D EF"
    );
    assert_eq!(
        ask(
            &mut map,
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 01 00 64 00 00 90 05 00"
        ),
        "D0 00 00 FF FF 03 00 05 00 00 00 00 01 10"
    );
    let request =
        "50 00 00 FF FF 03 00 12 00 04 00 01 14 00 00 E8 03 00 A8 03 00 13 00 12 00 FE FF";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.plc.d(1000, 3), [19, 18, -2]);
    let request = "50 00 00 FF FF 03 00 0E 00 04 00 01 14 01 00 10 00 00 9D 03 00 01 10";
    assert_eq!(ask(&mut map, request), DONE);
    let y = [16, 17, 18, 19].map(|n| map.bit(Class::Y, n));
    assert_eq!(y, [Some(false), Some(true), Some(true), Some(false)]);
}

#[test]
fn random_access_of_pymcprotocol() {
    let mut map = Watched::new();
    map.plc.set_d(0, &[0x1995]);
    map.set_word(Class::T, 0, 0x1202);
    map.plc.set_m(100, "0000110001000000");
    map.plc.set_dd(1500, 0x4c54_4f4e);
    for y in 0x68..0x88 {
        map.set_bit(Class::Y, y, y % 2 == 0);
    }
    let request = "50 00 00 FF FF 03 00 1C 00 04 00 03 04 00 00 03 02 00 00 00 A8 00 00 00 C2 64 00 00 90 DC 05 00 A8 68 00 00 9D";
    assert_eq!(
        ask(&mut map, request),
        "D0 00 00 FF FF 03 00 10 00 00 00 95 19 02 12 30 02 4E 4F 54 4C 55 55 55 55"
    );
    let request = "50 00 00 FF FF 03 00 1C 00 04 00 02 14 00 00 02 01 E8 03 00 A8 E8 03 EA 03 00 A8 D0 07 EC 03 00 A8 02 00 0A 00";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.plc.d(1000, 6), [1000, 0, 2000, 0, 2, 10]);
    map.plc.set_m(50, "100");
    let request = "50 00 00 FF FF 03 00 11 00 04 00 02 14 01 00 02 32 00 00 90 00 34 00 00 90 01";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.plc.m(50, 3), "001");
    // C200 as a double word.
    let request = "50 00 00 FF FF 03 00 10 00 04 00 02 14 00 00 00 01 C8 00 00 C5 70 11 01 00";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.counter32(200), Some(70000));
}

#[test]
fn control_of_pymcprotocol() {
    let mut map = Watched::new();
    let request = "50 00 00 FF FF 03 00 08 00 04 00 02 10 00 00 01 00";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.request, Some(false));
    let request = "50 00 00 FF FF 03 00 0A 00 04 00 01 10 00 00 01 00 00 00";
    assert_eq!(ask(&mut map, request), DONE);
    assert_eq!(map.request, Some(true));
    assert_eq!(
        ask(&mut map, "50 00 00 FF FF 03 00 06 00 04 00 01 01 00 00"),
        "D0 00 00 FF FF 03 00 14 00 00 00 52 55 4E 47 43 20 20 20 20 20 20 20 20 20 20 20 38 5E"
    );
    assert_eq!(
        ask(
            &mut map,
            "50 00 00 FF FF 03 00 0B 00 04 00 19 06 00 00 03 00 41 42 43"
        ),
        "D0 00 00 FF FF 03 00 07 00 00 00 03 00 41 42 43"
    );
    // Pause, which this PLC does not have.
    assert_eq!(
        ask(
            &mut map,
            "50 00 00 FF FF 03 00 08 00 04 00 03 10 00 00 01 00"
        ),
        "D0 00 00 FF FF 03 00 0B 00 59 C0 00 FF FF 03 00 03 10 00 00"
    );
}

/// Modes of remote RUN and STOP: those of the manual that clear nothing.
#[test]
fn modes_of_remote_run_and_stop() {
    let ask = |body: &str| {
        let mut map = Watched::new();
        let answer = ask_in_ascii(&mut map, &in_3e("5000", body));
        (answer[18..22].to_owned(), map.request)
    };
    for (body, request) in [
        ("00041001000000010000", Some(true)),
        ("00041001000000030000", Some(true)),
        ("0004100200000001", Some(false)),
        ("00041001000000000000", None),
        ("00041001000000050000", None),
        ("00041001000000010100", None),
        ("00041001000000010200", None),
        ("00041001000000010001", None),
        ("0004100200000000", None),
        ("0004100200000003", None),
    ] {
        let code = if request.is_some() { "0000" } else { "C05C" };
        assert_eq!(ask(body), (code.to_owned(), request), "{body}");
    }
}

#[test]
fn refusals_of_3e() {
    let mut map = Watched::new();
    for (request, code) in [
        // Network 2, PC 5, module 3E0, station 9.
        (
            "50 00 02 FF FF 03 00 0C 00 04 00 01 04 00 00 00 00 00 A8 01 00",
            0x4a00,
        ),
        (
            "50 00 00 05 FF 03 00 10 00 04 00 01 14 00 00 00 00 00 A8 02 00 01 00 02 00",
            0x4a00,
        ),
        ("50 00 00 FF E0 03 00 08 00 04 00 02 10 00 00 01 00", 0x4a00),
        (
            "50 00 00 FF FF 03 09 0C 00 04 00 01 04 00 00 00 00 00 A8 01 00",
            0x4a00,
        ),
        // D8511 is the last register.
        (
            "50 00 00 FF FF 03 00 10 00 04 00 01 14 00 00 3E 21 00 A8 03 00 01 00 02 00",
            0xc061,
        ),
        (
            "50 00 00 FF FF 03 00 12 00 04 00 01 14 00 00 3E 21 00 A8 03 00 01 00 02 00 03 00",
            0xc056,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 00 00 00 00 00 A8 C1 03",
            0xc051,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 00 00 00 00 00 A8 00 00",
            0xc051,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 01 00 00 00 00 A8 01 00",
            0xc05c,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 00 00 C8 00 00 C5 01 00",
            0xc056,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 01 04 00 00 00 00 00 92 01 00",
            0xc05b,
        ),
        (
            "50 00 00 FF FF 03 00 0D 00 04 00 01 04 00 00 00 00 00 A8 01 00 00",
            0xc061,
        ),
        (
            "50 00 00 FF FF 03 00 0C 00 04 00 02 14 01 00 01 32 00 00 90 02",
            0xc060,
        ),
    ] {
        let (reply, outcome) = exchange(&mut map, &bytes(request));
        assert_eq!(u16::from_le_bytes([reply[9], reply[10]]), code, "{request}");
        assert!(outcome.is_err());
    }
    assert_eq!((map.writes, map.strays), (0, 0));
    assert_eq!(map.request, None);
}

#[test]
fn frames_of_1e() {
    let mut map = Watched::new();
    map.plc.set_d(100, &[0x1234, 2]);
    map.plc.set_m(100, "00011");
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 64 00 00 00 20 44 02 00"),
        "81 00 34 12 02 00"
    );
    assert_eq!(
        ask(&mut map, "00 FF 0A 00 64 00 00 00 20 4D 05 00"),
        "80 00 00 01 10"
    );
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 60 00 00 00 20 4D 01 00"),
        "81 00 80 01"
    );
    assert_eq!(
        ask(&mut map, "02 FF 0A 00 08 00 00 00 20 59 03 00 11 00"),
        "82 00"
    );
    assert_eq!(map.bit(Class::Y, 9), Some(true));
    assert_eq!(
        ask(&mut map, "03 FF 0A 00 F4 01 00 00 20 44 01 00 34 12"),
        "83 00"
    );
    assert_eq!(map.plc.d(500, 1), [0x1234]);
    assert_eq!(
        ask(&mut map, "03 FF 0A 00 C8 00 00 00 4E 43 02 00 70 11 01 00"),
        "83 00"
    );
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 C8 00 00 00 4E 43 02 00"),
        "81 00 70 11 01 00"
    );
    assert_eq!(
        ask(
            &mut map,
            "04 FF 0A 00 02 00 64 00 00 00 20 4D 01 67 00 00 00 20 4D 00"
        ),
        "84 00"
    );
    assert_eq!(map.plc.m(100, 5), "10001");
    assert_eq!(
        ask(&mut map, "05 FF 0A 00 01 00 65 00 00 00 20 44 07 00"),
        "85 00"
    );
    assert_eq!(map.plc.d(101, 1), [7]);
    assert_eq!(ask(&mut map, "14 FF 0A 00"), "94 00");
    assert_eq!(map.request, Some(false));
    assert_eq!(ask(&mut map, "13 FF 0A 00"), "93 00");
    assert_eq!(map.request, Some(true));
    assert_eq!(ask(&mut map, "15 FF 0A 00"), "95 00 F3 00");
    assert_eq!(
        ask(&mut map, "16 FF 0A 00 03 41 42 43"),
        "96 00 03 41 42 43"
    );
}

#[test]
fn refusals_of_1e() {
    let mut map = Watched::new();
    assert_eq!(
        ask(&mut map, "01 00 0A 00 64 00 00 00 20 44 02 00"),
        "81 5B 10 00"
    );
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 64 00 00 00 20 41 02 00"),
        "81 56"
    );
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 64 00 00 01 20 44 02 00"),
        "81 58"
    );
    assert_eq!(
        ask(&mut map, "01 FF 0A 00 64 00 00 00 20 44 41 00"),
        "81 57"
    );
    assert_eq!(
        ask(&mut map, "00 FF 0A 00 64 00 00 00 20 44 01 00"),
        "80 58"
    );
    assert_eq!(
        ask(
            &mut map,
            "03 FF 0A 00 60 00 00 00 20 4D 0B 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00"
        ),
        "83 57"
    );
    assert_eq!(cut(b"\x86\xff"), Cut::Drop);
    assert_eq!(cut(b"\x50"), Cut::More);
    assert_eq!(cut(b"\x50\x01"), Cut::Drop);
    assert_eq!(cut(b"\x50\x00\x00\xff\xff\x03\x00\xff\xff"), Cut::Drop);
    assert_eq!(map.writes, 0);
}

/// Devices and counts of each kind that no command takes, by the end codes of FX3U-ENET-ADP (user's manual 9.3.2).
#[test]
fn reasons_of_1e() {
    let mut map = Watched::new();
    for (request, code) in [
        // A device that is none; W.
        ("01FF000A2042000000000100", "56"),
        ("00FF000A5720000000000100", "56"),
        // Beyond the end: D8511 is the last register, M8511 the last relay, Y377, C199, C255.
        ("01FF000A44200000213F0200", "57"),
        ("00FF000A4D200000213F0200", "57"),
        ("00FF000A5920000000FF0200", "57"),
        ("01FF000A4D20000021300200", "57"),
        ("01FF000A434E000000C70200", "57"),
        ("01FF000A434E000000FF0400", "57"),
        // Half of a 32-bit counter, and more than 32 of them.
        ("01FF000A434E000000C80100", "57"),
        ("03FF000A434E000000C8030000BC614E0000", "57"),
        ("01FF000A434E000000C84200", "57"),
        // The first device is not there.
        ("01FF000A4420000021400100", "58"),
        ("00FF000A4D20000021400100", "58"),
        ("01FF000A4D20000021400100", "58"),
        ("01FF000A434E000001000200", "58"),
        ("05FF000A01004420000021400001", "58"),
        ("04FF000A01004D200000214001", "58"),
        // 32-bit counters have no part in tests.
        ("05FF000A0100434E000000C80001", "58"),
        // Words in a command of bits.
        ("00FF000A4420000000000100", "58"),
        ("02FF000A434E00000000010010", "58"),
        ("04FF000A010044200000000001", "58"),
        // Words of bits that do not begin at a multiple of 16.
        ("01FF000A4D20000000050100", "58"),
        ("03FF000A59200000000801000001", "58"),
        ("05FF000A01004D20000000410001", "58"),
        ("01FF000A5453000000010100", "58"),
    ] {
        let reply = ask_in_ascii(&mut map, request);
        assert_eq!(reply[2..], *code, "{request}");
    }
    assert_eq!((map.writes, map.strays), (0, 0));
}

/// C200 to C231 at once, as the example of the manual has C220 to C251 (FX3U-ENET user's manual 9.3.4).
#[test]
fn counters_of_32_bits_have_two_points_each() {
    let mut map = Watched::new();
    for counter in 200..232 {
        map.set_counter32(counter, 0x00bc_614e);
    }
    let reply = ask(&mut map, "01 FF 0A 00 C8 00 00 00 4E 43 40 00");
    assert_eq!(reply, format!("81 00{}", " 4E 61 BC 00".repeat(32)));
    let data = " 40 01 B9 02".repeat(32);
    let write = format!("03 FF 0A 00 C8 00 00 00 4E 43 40 00{data}");
    assert_eq!(ask(&mut map, &write), "83 00");
    assert_eq!(map.counter32(231), Some(0x02b9_0140));
}

/// Every command that writes bits, with each value that is none in each place.
#[test]
fn bits_are_0_or_1() {
    let three = "50 00 00 FF FF 03 00";
    let right = [
        "02 FF 0A 00 32 00 00 00 20 4D 03 00 11 10".to_owned(),
        "04 FF 0A 00 01 00 32 00 00 00 20 4D 01".to_owned(),
        format!("{three} 0E 00 04 00 01 14 01 00 32 00 00 90 03 00 11 10"),
        format!("{three} 0C 00 04 00 02 14 01 00 01 32 00 00 90 01"),
    ];
    for request in right {
        let request = bytes(&request);
        let mut map = Watched::new();
        assert_eq!(exchange(&mut map, &request).1, Ok(()));
        for wrong in [0x02, 0x20, 0x12, 0x21, 0x80, 0xff] {
            let mut request = request.clone();
            *request.last_mut().unwrap() = wrong;
            let mut map = Watched::new();
            let (reply, outcome) = exchange(&mut map, &request);
            let is_1e = request[0] != 0x50;
            let code: &[u8] = if is_1e { &[0x54] } else { &[0x60, 0xc0] };
            assert!(reply[if is_1e { 1 } else { 9 }..].starts_with(code));
            assert_eq!((outcome, map.writes), (Err(LineFault::Data), 0));
        }
    }
    let mut map = Watched::new();
    // The zero after an odd number of bits.
    let filled = "02FF000A4D20000000320300111";
    assert_eq!(ask_in_ascii(&mut map, &format!("{filled}0")), "8200");
    assert_eq!(ask_in_ascii(&mut map, &format!("{filled}2")), "8254");
    assert_eq!(ask_in_ascii(&mut map, "04FF000A01004D200000003202"), "8454");
}

/// Commands of no frame, 4E among them: 50, and where the next request begins is unknown.
#[test]
fn unknown_commands() {
    let mut map = Watched::new();
    let known = |command| (0..=5).chain(0x13..=0x16).any(|known| known == command);
    let begins_another = |command| [0x30, 0x31, 0x35, 0x50].contains(&command);
    for command in (0..0x80).filter(|&command| !known(command) && !begins_another(command)) {
        assert_eq!(cut(&[command, 0xff, 10, 0]), Cut::Whole);
        let (reply, outcome) = exchange(&mut map, &[command]);
        assert_eq!(reply, [command | 0x80, 0x50]);
        assert_eq!(outcome, Err(LineFault::Form));
    }
    for command in (0..0x20).filter(|&command| !known(command)) {
        let request = format!("{command:02X}");
        let (reply, outcome) = exchange(&mut map, request.as_bytes());
        assert_eq!(reply, format!("{:02X}50", command | 0x80).into_bytes());
        assert_eq!(outcome, Err(LineFault::Form));
    }
    assert_eq!((map.writes, map.request), (0, None));
}

fn ask_in_ascii(map: &mut Watched, request: &str) -> String {
    let request = request.as_bytes();
    assert_eq!(cut(request), Cut::Whole);
    for length in 1..request.len() {
        assert_eq!(cut(&request[..length]), Cut::More);
    }
    String::from_utf8(exchange(map, request).0).unwrap()
}

/// Requests of fx3u-mcprotocol 1.0.0 and of the FX3U-ENET-ADP user's manual, chapter 7.
#[test]
fn frames_of_1e_in_ascii() {
    let mut map = Watched::new();
    map.plc.set_d(100, &[0x1234, -2]);
    map.plc.set_m(100, "01001101");
    for (request, reply) in [
        ("01FF000A4420000000640200", "81001234FFFE"),
        ("00FF000A4D20000000640800", "800001001101"),
        // A zero after an odd number of bits.
        ("00FF000A4D20000000640500", "8000010010"),
        ("02FF000A4D200000003203001110", "8200"),
        ("03FF000A4420000001F402001234ABCD", "8300"),
        // 32-bit counters, the high word first.
        ("03FF000A434E000000C8020000BC614E", "8300"),
        ("01FF000A434E000000C80200", "810000BC614E"),
        ("05FF000A020044200000000A12344D20000000400003", "8500"),
        ("04FF000A01004D200000000A01", "8400"),
        ("14FF000A", "9400"),
        ("15FF000A", "9500F300"),
        ("16FF000A05ABCDE", "960005ABCDE"),
        ("0100000A4420000000640200", "815B1000"),
        ("01FF000A4120000000640200", "8156"),
        ("01FF000A4420000000644100", "8157"),
        ("02FF000A4D200000003203001120", "8254"),
    ] {
        assert_eq!(ask_in_ascii(&mut map, request), reply, "{request}");
    }
    assert_eq!(map.plc.d(500, 2), [0x1234, 0xabcd_u16 as i16]);
    assert_eq!(map.plc.m(50, 3), "111");
    assert_eq!(map.counter32(200), Some(12_345_678));
    assert_eq!(map.plc.d(10, 1), [0x1234]);
    assert_eq!(map.plc.m(64, 2), "11");
    assert_eq!(map.request, Some(false));
}

/// Frame 3E in ASCII around a body, the timer first.
fn in_3e(head: &str, body: &str) -> String {
    format!("{head}00FF03FF00{:04X}{body}", body.len())
}

/// Requests of pymcprotocol 0.3 in ASCII.
#[test]
fn frames_of_3e_in_ascii() {
    let mut map = Watched::new();
    map.plc.set_d(100, &[0x1234, 2, -4323]);
    map.plc.set_m(103, "11");
    for (request, reply) in [
        ("000404010000D*0001000003", "000012340002EF1D"),
        ("000404010001M*0001000005", "000000011"),
        // Spaces instead of the asterisk and of leading zeros.
        ("000404010000D    1000001", "00001234"),
        ("000414010000D*00100000020013FFFE", "0000"),
        // Terminals in hexadecimal digits.
        ("000414010001Y*0000100003011", "0000"),
        ("0004140200000101D*001010000AD*00101200020001", "0000"),
        ("0004040300000101D*001010D*001012", "0000000A00020001"),
        ("00041402000102M*00005001M*00005201", "0000"),
        ("0004140200000001CN00020000BC614E", "0000"),
        ("0004061900000005ABCDE", "00000005ABCDE"),
        ("000401010000", "0000RUNGC           5E38"),
        ("0004100200000001", "0000"),
        // Refusals: digits, lengths, points, devices, values.
        ("00040401000XD*0001000003", "C05000FF03FF000401000X"),
        ("000404010000D*00010000 3", "C05000FF03FF0004010000"),
        ("000404010000D*000100000", "C06100FF03FF0004010000"),
        ("0004", "C06100FF03FF0000000000"),
        ("000404010001M*0001000E01", "C05100FF03FF0004010001"),
        ("000404010000W*0001000001", "C05B00FF03FF0004010000"),
        ("000414010001M*00010000012", "C06000FF03FF0014010001"),
        ("000410030000", "C05900FF03FF0010030000"),
    ] {
        let answer = ask_in_ascii(&mut map, &in_3e("5000", request));
        assert_eq!(answer, in_3e("D000", reply), "{request}");
    }
    assert_eq!(map.plc.d(1000, 2), [0x13, -2]);
    let y = [16, 17, 18].map(|n| map.bit(Class::Y, n));
    assert_eq!(y, [Some(false), Some(true), Some(true)]);
    assert_eq!(map.plc.m(50, 3), "101");
    assert_eq!(map.counter32(200), Some(12_345_678));
    assert_eq!(map.request, Some(false));
    for no_request in ["5001", "0G", "500000FF03FF00FFFF", "500000FF03FF000X18"] {
        assert_eq!(cut(no_request.as_bytes()), Cut::Drop, "{no_request}");
    }
}

/// Every command that writes, in ASCII, with a bad digit at each place: what is rejected writes nothing.
#[test]
fn a_bad_digit_anywhere_writes_nothing() {
    let three = |body| in_3e("5000", body);
    let frames = [
        three("001014010000D*0001000003111122223333"),
        three("001014010000M*0001000002FFFF0001"),
        three("001014010001M*0001000003101"),
        three("0010140200000201D*0001001111D*0001012222D*00010233334444"),
        three("00101402000102M*00010001M*00010101"),
        "02FF000A4D2000000064020011".into(),
        "03FF000A4420000000640300111122223333".into(),
        "03FF000A434E000000C804000000111100002222".into(),
        "04FF000A02004D2000000064014D200000006501".into(),
        "05FF000A020044200000006411114420000000652222".into(),
    ];
    for frame in frames {
        let frame = frame.as_bytes();
        let mut map = Watched::new();
        assert_eq!(exchange(&mut map, frame).1, Ok(()), "{frame:?}");
        assert!(map.writes > 0);
        for place in 0..frame.len() {
            let mut request = frame.to_vec();
            request[place] = b'G';
            let mut map = Watched::new();
            let (_, outcome) = exchange(&mut map, &request);
            let request = String::from_utf8(request).unwrap();
            assert!(outcome.is_ok() || map.writes == 0, "{request}");
        }
    }
}

/// Returns true if an answer reports success.
fn is_done(reply: &[u8]) -> bool {
    match reply {
        [0xd0, 0, _, _, _, _, _, _, _, code @ ..] => code.starts_with(&[0, 0]),
        [b'D', b'0', ..] => reply.get(18..22) == Some(b"0000"),
        [b'8' | b'9', _, code @ ..] if code.len() >= 2 => code.starts_with(b"00"),
        [_, code, ..] => *code == 0,
        _ => false,
    }
}

proptest! {
    /// Any bytes after a head that is right: no panic, and what is rejected writes nothing.
    #[test]
    fn any_bytes(
        command in proptest::sample::select(std::vec![
            [0x01u8, 0x04, 0, 0], [0x01, 0x04, 1, 0], [0x01, 0x14, 0, 0], [0x01, 0x14, 1, 0], [0x03, 0x04, 0, 0],
            [0x02, 0x14, 0, 0], [0x02, 0x14, 1, 0], [0x19, 0x06, 0, 0],
        ]),
        code in proptest::sample::select(std::vec![0x9cu8, 0x90, 0xa8, 0xc2, 0xc5, 0xc4]),
        number in 0u16..9000,
        data in proptest::collection::vec(any::<u8>(), 0..60),
        short in 0u8..20,
    ) {
        let [low, high] = number.to_le_bytes();
        let body = [&[4, 0][..], &command, &[low, high, 0, code, short, 0], &data].concat();
        let three = [&[0x50, 0, 0, 0xff, 0xff, 3, 0, body.len() as u8, 0][..], &body].concat();
        let one = [&[command[0] & 7, 0xff, 0, 0, low, high, 0, 0, 0x20, 0x44, short, 0][..], &data].concat();
        let digits = |bytes: &[u8]| hex(bytes).replace(' ', "").into_bytes();
        let [three_digits, one_digits] = [digits(&three), digits(&one)];
        for request in [three.as_slice(), &one, &data, &three_digits, &one_digits] {
            let mut map = Watched::new();
            cut(request);
            let (reply, outcome) = exchange(&mut map, request);
            prop_assert_eq!(outcome.is_ok(), is_done(&reply));
            if outcome.is_err() {
                prop_assert_eq!(map.writes, 0);
            }
            prop_assert_eq!(map.strays, 0);
        }
    }
}
