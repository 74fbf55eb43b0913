//! The frames that the manuals print, with their sums recomputed where the print is wrong.

use super::master::{Job, Schedule};
use super::on_demand::Devices;
use super::*;
use crate::comm::watched::{Watched, reply_of};
use crate::double::Double;
use crate::special::Register;
use proptest::prelude::*;
use std::string::String;
use std::vec::Vec;

/// Station 5 of the manual's examples, format 4 with sum.
const FORMAT4: Settings = Settings {
    station: 5,
    sum: true,
    crlf: true,
    dialect: Dialect::Fx(*b"9D"),
};
const FORMAT1: Settings = Settings {
    crlf: false,
    ..FORMAT4
};
const PLAIN: Settings = Settings {
    sum: false,
    ..FORMAT1
};
const HM: Settings = Settings {
    station: 10,
    sum: true,
    crlf: false,
    dialect: Dialect::Hm,
};

fn exchange(
    settings: Settings,
    slave: &mut Remote,
    map: &mut Watched,
    request: &[u8],
) -> (Vec<u8>, Result<(), LineFault>) {
    reply_of(|reply| answer(settings, slave, request, map, reply))
}

/// The reply to a request whose control characters, sum and terminator are added: text, with the sum held to be right.
fn ask(settings: Settings, map: &mut Watched, text: &str) -> String {
    let request = frame(settings, text);
    assert_eq!(cut(settings, &request), Cut::Whole, "{text}");
    let (reply, _) = exchange(settings, &mut Remote::new(), map, &request);
    text_of(settings, &reply)
}

fn frame(settings: Settings, text: &str) -> Vec<u8> {
    let mut request = [&[ENQ], text.as_bytes()].concat();
    if settings.sum {
        let sum = request[1..].iter().fold(0u8, |sum, c| sum.wrapping_add(*c));
        request.extend(std::format!("{sum:02X}").bytes());
    }
    if settings.crlf {
        request.extend(b"\r\n");
    }
    request
}

fn text_of(settings: Settings, reply: &[u8]) -> String {
    let text = match reply {
        [text @ .., b'\r', b'\n'] if settings.crlf => text,
        text => text,
    };
    let text = match text {
        [STX, text @ .., ETX, high, low] if settings.sum => {
            let sum = text.iter().fold(ETX, |sum, c| sum.wrapping_add(*c));
            assert_eq!(hex_digits(&[*high, *low]), Some(sum.into()));
            text
        }
        [STX, text @ .., ETX] => text,
        [ACK, text @ ..] => return std::format!("ACK {}", String::from_utf8_lossy(text)),
        [NAK, text @ ..] => return std::format!("NAK {}", String::from_utf8_lossy(text)),
        text => text,
    };
    String::from_utf8(text.to_vec()).unwrap()
}

#[test]
fn worked_examples_of_h1u_h2u() {
    let mut map = Watched::new();
    for input in [0o41, 0o42, 0o44] {
        map.set_bit(Class::X, input, true);
    }
    let mut slave = Remote::new();
    let (reply, _) = exchange(FORMAT4, &mut slave, &mut map, b"\x0505FFBRAX00400547\r\n");
    assert_eq!(reply, b"\x0205FF01101\x03E7\r\n");
    assert_eq!(wait_ms(b"\x0505FFBRAX00400547\r\n"), 100);
    let (reply, _) = exchange(
        FORMAT4,
        &mut slave,
        &mut map,
        b"\x0505FFBW0M090305011012B\r\n",
    );
    assert_eq!(reply, b"\x0605FF\r\n");
    assert_eq!(map.plc.m(903, 5), "01101");
    let (reply, _) = exchange(
        FORMAT4,
        &mut slave,
        &mut map,
        b"\x0505FFWW0M0640022347AB960A\r\n",
    );
    assert_eq!(reply, b"\x0605FF\r\n");
    assert_eq!(map.plc.m(640, 16), "1110001011000100");
    map.set_bit(Class::S, 100, true);
    let (reply, _) = exchange(
        FORMAT4,
        &mut slave,
        &mut map,
        b"\x0505FFBT003M05001S01000Y00011EC\r\n",
    );
    assert_eq!(reply, b"\x0605FF\r\n");
    assert_eq!(map.plc.m(500, 1), "1");
    assert_eq!(map.bit(Class::S, 100), Some(false));
    assert_eq!(map.bit(Class::Y, 1), Some(true));
    let (reply, _) = exchange(
        FORMAT4,
        &mut slave,
        &mut map,
        b"\x0505FFTT00812345678D5\r\n",
    );
    assert_eq!(reply, b"\x0205FF0812345678\x0300\r\n");
}

#[test]
fn commands() {
    let mut map = Watched::of(Double::new().with_d(100, &[0x1234]));
    assert_eq!(ask(FORMAT4, &mut map, "05FFWR0D010001"), "05FF1234");
    assert_eq!(ask(PLAIN, &mut map, "05FFWR0D010001"), "05FF1234");
    assert_eq!(
        ask(FORMAT1, &mut map, "05FFWT003D05001234Y0100BCA9CN1000064"),
        "ACK 05FF"
    );
    assert_eq!(map.plc.d(500, 1), [0x1234]);
    assert_eq!(map.word(Class::C, 100), Some(100));
    assert_eq!(ask(FORMAT1, &mut map, "05FFWR0Y010001"), "05FFBCA9");
    assert_eq!(
        ask(FORMAT1, &mut map, "05FFWW0CN201020001117000000002"),
        "ACK 05FF"
    );
    assert_eq!(map.counter32(201), Some(0x11170));
    assert_eq!(
        ask(FORMAT1, &mut map, "05FFWR0CN20102"),
        "05FF0001117000000002"
    );
    assert_eq!(ask(FORMAT1, &mut map, "05FFPC0"), "05FF9D");
    assert_eq!(ask(FORMAT1, &mut map, "05FFTT005ABCDE"), "05FF05ABCDE");
    assert_eq!(ask(FORMAT4, &mut map, "05FFTT005ABCD"), "NAK 05FF03");
}

#[test]
fn global_flag() {
    let mut map = Watched::new();
    assert_eq!(ask(FORMAT4, &mut map, "FFFFGW01"), "");
    assert_eq!(map.bit(Class::M, M_GLOBAL), Some(true));
    assert_eq!(ask(FORMAT4, &mut map, "FFFFGW00"), "");
    assert_eq!(map.bit(Class::M, M_GLOBAL), Some(false));
    assert_eq!(ask(FORMAT4, &mut map, "FFFFWR0D010001"), "");
}

#[test]
fn remote_run_and_stop() {
    let mut map = Watched::new();
    let mut slave = Remote::new();
    let mut ask = |map: &mut Watched, text: &str| {
        let request = frame(FORMAT4, text);
        let (reply, outcome) = exchange(FORMAT4, &mut slave, map, &request);
        assert_eq!(outcome, Ok(()));
        text_of(FORMAT4, &reply)
    };
    assert_eq!(ask(&mut map, "05FFRR0"), "NAK 05FF18");
    assert_eq!(ask(&mut map, "05FFRS0"), "NAK 05FF18");
    map.plc.sys.running = false;
    assert_eq!(ask(&mut map, "05FFRR0"), "ACK 05FF");
    assert_eq!(map.request, Some(true));
    assert_eq!(ask(&mut map, "05FFRS0"), "ACK 05FF");
    assert_eq!(map.request, Some(false));
    assert_eq!(ask(&mut map, "05FFRS0"), "NAK 05FF18");
}

#[test]
fn refusals() {
    let mut map = Watched::new();
    for (text, reply) in [
        ("05FFWR0D010000", "NAK 05FF06"),
        ("05FFWR0D010041", "NAK 05FF06"),
        ("05FFWR0D900001", "NAK 05FF06"),
        ("05FFWR0D01G001", "NAK 05FF06"),
        ("05FFWR0X009001", "NAK 05FF06"),
        ("05FFWR0CN19902", "NAK 05FF06"),
        ("05FFBR0D010001", "NAK 05FF06"),
        ("0500WR0D010001", "NAK 05FF10"),
        ("05FFZZ0D010001", "NAK 05FF06"),
        ("05FFWW0D01000112G4", "NAK 05FF07"),
        ("05FFWW0D0100020001", "NAK 05FF03"),
        ("05FFBW0M0100022", "NAK 05FF06"),
        ("05FFWT001CN2000064", "NAK 05FF06"),
        ("05FFWR", "NAK 05FF03"),
        ("06FFZZ0", ""),
    ] {
        assert_eq!(ask(FORMAT4, &mut map, text), reply, "{text}");
    }
    let (reply, outcome) = exchange(
        FORMAT4,
        &mut Remote::new(),
        &mut map,
        b"\x0505FFBR0M09030500\r\n",
    );
    assert_eq!(
        (reply.as_slice(), outcome),
        (&b"\x1505FF02\r\n"[..], Err(LineFault::Sum))
    );
    assert_eq!(map.writes, 0);
}

#[test]
fn cuts() {
    assert_eq!(cut(FORMAT1, b"\x06"), Cut::Drop);
    assert_eq!(cut(FORMAT1, b"\x0505FFWR0D010001"), Cut::More);
    assert_eq!(cut(FORMAT1, b"\x0505FFWR0D01000130"), Cut::Whole);
    assert_eq!(cut(PLAIN, b"\x0505FFWR0D010001"), Cut::Whole);
    assert_eq!(cut(FORMAT1, b"\x0505FF\x05"), Cut::Restart);
    assert_eq!(cut(FORMAT4, b"\x0505FFWR0D01000130"), Cut::More);
    assert_eq!(cut(FORMAT4, b"\x04"), Cut::Drop);
}

#[test]
fn worked_example_of_on_demand() {
    let mut map = Watched::of(Double::new().with_d(5, &[0x501, 0x602, 0x703]));
    let devices = Devices::of_block(Register(8120));
    let on_demand = |map: &mut Watched, first, count| {
        map.plc.set_d(8127, &[first, count]);
        let (frame, _) = reply_of(|frame| {
            on_demand::request(FORMAT4, devices, map, frame);
            Ok(())
        });
        frame
    };
    assert_eq!(on_demand(&mut map, 5, 0), b"");
    assert_eq!(on_demand(&mut map, 5, 3), b"\x0205FE050106020703\x034B\r\n");
    assert_eq!(map.plc.d(8128, 1), [0]);
    assert_eq!(map.plc.m(8127, 2), "10");
    on_demand::sent(devices, &mut map);
    map.set_bit(Class::M, 8129, true);
    assert_eq!(on_demand(&mut map, 5, 3), b"\x0205FE010203\x0319\r\n");
    on_demand::sent(devices, &mut map);
    assert_eq!(on_demand(&mut map, 7990, 11), b"");
    assert_eq!(map.plc.m(8127, 2), "01");
    assert_eq!(on_demand(&mut map, 0, 65), b"");
    assert_eq!(on_demand(&mut map, -1, -1), b"");
}

#[test]
fn worked_examples_of_hm() {
    let mut map = Watched::of(Double::new().with_d(7223, &[0x101, 0x909, 0xffff, 0x6565, 0x6d6d]));
    let request = b"\x050AFFWR0D7223054D";
    assert_eq!(cut(HM, request), Cut::Whole);
    let (reply, _) = exchange(HM, &mut Remote::new(), &mut map, request);
    assert_eq!(reply, b"\x020AFF01010909FFFF65656D6D\x0376");
    assert_eq!(ask(HM, &mut map, "0AFFWW0D15000200FFAB96"), "ACK 0AFF");
    assert_eq!(map.plc.d(1500, 2), [0xff, 0xab96_u16 as i16]);
    assert_eq!(ask(HM, &mut map, "0AFFWR0D800001"), "NAK 0AFF06");
    assert_eq!(ask(HM, &mut map, "0AFFPC0"), "NAK 0AFF06");
}

/// The work area of the manual's example, with this many tasks of each kind, and two bytes each.
fn work_area(tasks: [i32; 4]) -> Watched {
    let mut map = Watched::new();
    for ((kind, first), tasks) in [(0, 7100), (3, 7500), (6, 7700), (9, 7800)]
        .iter()
        .zip(tasks)
    {
        map.plc.set_d(1000 + kind, &[*first, tasks, 2]);
        map.plc.set_d(*first as u32, &[1, 0, 2, 0]);
    }
    map.plc.set_d(1012, &[-1, -1, -1, -1]);
    map
}

#[test]
fn a_master_reads_and_writes() {
    let mut map = work_area([1, 1, 0, 0]);
    map.plc.set_d(7501, &[255]);
    let mut schedule = Schedule::new();
    let job = schedule.next(1000, &map).unwrap();
    let (request, _) = reply_of(|frame| {
        master::request(job, &map, frame);
        Ok(())
    });
    assert_eq!(request, b"\x0501FFWR0D71010134");
    assert_eq!(master::cut(job, b"\x0201FF007B\x03C"), Cut::More);
    assert_eq!(master::cut(job, b"\x0201FF007B\x03C9"), Cut::Whole);
    assert_eq!(
        master::accept(job, b"\x0201FF007B\x03C8", &mut map),
        Err(LineFault::Sum)
    );
    assert_eq!(master::accept(job, b"\x0201FF007B\x03C9", &mut map), Ok(()));
    assert_eq!(map.plc.d(7101, 1), [123]);
    master::note(1000, job, true, &mut map);
    assert_eq!(map.plc.d(1012, 1), [-3]);
    assert_eq!(map.plc.d(1016, 2), [1, 0]);
    let job = schedule.next(1000, &map).unwrap();
    assert_eq!(
        job,
        Job {
            station: 1,
            write: true,
            first: 7501,
            count: 1
        }
    );
    let (request, _) = reply_of(|frame| {
        master::request(job, &map, frame);
        Ok(())
    });
    assert_eq!(&request[..request.len() - 2], b"\x0501FFWW0D75010100FF");
    assert_eq!(master::accept(job, b"\x0601FF", &mut map), Ok(()));
    assert!(master::accept(job, b"\x1501FF06", &mut map).is_err());
    master::note(1000, job, false, &mut map);
    assert_eq!(map.plc.d(1012, 1), [-1]);
}

/// Two frames of three are of level 0, unless only one level has tasks.
#[test]
fn levels_share_the_line() {
    let firsts = |tasks| {
        let map = work_area(tasks);
        let mut schedule = Schedule::new();
        let jobs: Vec<u16> = (0..6)
            .filter_map(|_| schedule.next(1000, &map))
            .map(|job| job.first)
            .collect();
        jobs
    };
    assert_eq!(firsts([1, 0, 1, 0]), [7101, 7101, 7701, 7101, 7101, 7701]);
    assert_eq!(firsts([2, 1, 0, 0]), [7101, 7103, 7501, 7101, 7103, 7501]);
    assert_eq!(firsts([0, 0, 1, 1]), [7701, 7801, 7701, 7801, 7701, 7801]);
    assert_eq!(firsts([0; 4]), []);
}

proptest! {
    /// Any bytes: no panic, and what is rejected writes nothing.
    #[test]
    fn any_bytes(mut request in proptest::collection::vec(any::<u8>(), 1..300)) {
        request[0] = ENQ;
        for settings in [FORMAT4, FORMAT1, PLAIN, HM] {
            let mut map = Watched::new();
            cut(settings, &request);
            let (reply, _) = exchange(settings, &mut Remote::new(), &mut map, &request);
            if reply.first() != Some(&ACK) {
                prop_assert_eq!(map.writes, 0);
            }
        }
    }

    /// Commands with right frames.
    #[test]
    fn any_command(text in "05FF(BR|WR|BW|WW|BT|WT|GW|TT)0[XYMSTCD][0-9NS][0-9]{3}[0-9A-F]{0,40}") {
        for settings in [FORMAT4, FORMAT1] {
            let mut map = Watched::new();
            let request = frame(settings, &text);
            let (reply, outcome) = exchange(settings, &mut Remote::new(), &mut map, &request);
            if reply.first() == Some(&NAK) {
                prop_assert!(outcome.is_err());
                prop_assert_eq!(map.writes, 0);
            }
            prop_assert_eq!(map.strays, 0);
        }
    }

    /// Any work area and any answer.
    #[test]
    fn any_answer(
        area in proptest::collection::vec(any::<i16>(), 20),
        reply in proptest::collection::vec(any::<u8>(), 0..300),
    ) {
        let mut map = Watched::new();
        let area: Vec<i32> = area.into_iter().map(i32::from).collect();
        map.plc.set_d(1000, &area);
        let mut schedule = Schedule::new();
        for _ in 0..4 {
            if let Some(job) = schedule.next(1000, &map) {
                let (request, _) = reply_of(|frame| {
                    master::request(job, &map, frame);
                    Ok(())
                });
                prop_assert!(request.len() <= LONGEST);
                master::cut(job, &reply);
                prop_assert!(master::accept(job, &reply, &mut map).is_err());
                prop_assert_eq!((map.writes, map.strays), (0, 0));
            }
        }
    }
}
