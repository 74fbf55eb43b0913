//! Frames of each protocol as they are shown.

use super::{Decoder, Direction, LinkProtocol};
use crate::serve::{Place, Seen, Traffic};
use rungc_rt::Ports;
use rungc_rt::comm::Protocol;
use rungc_rt::comm::modbus::crc16;
use rungc_rt::comm::service::ServerProtocol;
use std::fmt::Write;

/// A frame of Modbus RTU.
fn rtu(body: &[u8]) -> Vec<u8> {
    [body, &crc16(body).to_le_bytes()].concat()
}

/// A line of a log: what a frame says, after an earlier one in the other direction.
fn line(link: LinkProtocol, direction: Direction, bytes: &[u8], before: Option<&[u8]>) -> String {
    let decoder = Decoder::new(Ports::Inovance, 24120);
    let decoded = decoder.decode(link, direction, bytes, before);
    let mut line = format!("{} {direction:?}: {}", link.name(), decoded.text);
    if let Some(error) = decoded.error {
        let _ = write!(line, " !! {error}");
    }
    if decoded.broadcast {
        line.push_str(" (to all)");
    }
    line
}

#[test]
fn frames_on_can_are_shown_as_candump_does() {
    let shown = |bytes| {
        line(
            LinkProtocol::Serial(Protocol::Can),
            Direction::In,
            bytes,
            None,
        )
    };
    assert_eq!(shown(b"t20021234\r"), "CAN In: 200#1234");
    assert_eq!(shown(b"T000002001FF\r"), "CAN In: 00000200#FF");
    assert_eq!(shown(b"S6\r"), "CAN In: S6<CR>");
}

#[test]
fn frames_as_they_are_shown() {
    use Direction::{In, Out};
    use Protocol::{ComputerLink, MasterRtu, ModbusAscii, ModbusRtu, NnMaster};
    let [slave, ascii, master, link, nn] =
        [ModbusRtu, ModbusAscii, MasterRtu, ComputerLink, NnMaster].map(LinkProtocol::Serial);
    let read_coils = rtu(&[1, 1, 0, 8, 0, 10]);
    let mut damaged = read_coils.clone();
    damaged[3] = 9;
    let many: Vec<u8> = (0..40).collect();
    let many = [&[1, 3, 40][..], &many].concat();
    let mc_1e = [1, 0xff, 10, 0, 100, 0, 0, 0, 0x20, 0x44, 2, 0];
    let shown = [
        line(slave, In, &read_coils, None),
        line(slave, Out, &rtu(&[1, 1, 2, 5, 2]), Some(&read_coils)),
        line(slave, In, &damaged, None),
        line(slave, In, &[1, 3], None),
        line(slave, In, &rtu(&[0, 6, 0, 5, 0, 9]), None),
        line(slave, In, &rtu(&[1, 15, 0, 0, 0, 3, 1, 5]), None),
        line(slave, In, &rtu(&[1, 0x2b, 14, 1, 0]), None),
        line(slave, Out, &rtu(&[1, 0xab, 1]), None),
        line(slave, Out, &rtu(&many), None),
        line(ascii, In, b":010300640001:", None),
        line(ascii, In, b":01030064000197\r\n", None),
        line(master, Out, &rtu(&[2, 3, 0x10, 1, 0, 1]), None),
        line(master, In, &rtu(&[2, 0x83, 4]), None),
        line(link, In, b"\x0505FFWR0D01000130\r\n", None),
        line(link, In, b"\x0505FFBW0M00100210", None),
        line(link, Out, b"\x1505FF06", None),
        line(
            LinkProtocol::Tcp(ServerProtocol::ProgrammingPort),
            In,
            b"\x02110C8023412\x033C",
            None,
        ),
        line(
            LinkProtocol::Tcp(ServerProtocol::ProgrammingPort),
            In,
            b"\x020\x0399",
            None,
        ),
        line(
            LinkProtocol::Tcp(ServerProtocol::ProgrammingPort),
            Out,
            b"\x15",
            None,
        ),
        line(LinkProtocol::Tcp(ServerProtocol::Mc), In, &mc_1e, None),
        line(
            LinkProtocol::Tcp(ServerProtocol::Mc),
            Out,
            &[0x81, 0x56],
            None,
        ),
        line(nn, Out, b"\x02P11100\x0307", None),
    ];
    insta::assert_snapshot!("frames", shown.join("\n"));
}

#[test]
fn frames_of_mc_protocol_in_ascii() {
    use Direction::{In, Out};
    let frames: [(Direction, &[u8]); 6] = [
        (In, b"01FF000A4420000000640200"),
        (Out, b"81001234FFFE"),
        (Out, b"8157"),
        (In, b"500000FF03FF000018000404010000D*0001000003"),
        (Out, b"D00000FF03FF0000100000000112340002"),
        (Out, b"D00000FF03FF000016C05600FF03FF0004010000"),
    ];
    let shown = frames.map(|(direction, bytes)| {
        line(
            LinkProtocol::Tcp(ServerProtocol::Mc),
            direction,
            bytes,
            None,
        )
    });
    insta::assert_snapshot!(shown.join("\n"), @r"
    MC protocol In: 1E command 01: reads D100-D101
    MC protocol Out: done
    MC protocol Out: rejected with code 57H !! rejected with code 57H
    MC protocol In: 3E command 0401, subcommand 0000: reads D100-D102
    MC protocol Out: done
    MC protocol Out: rejected with code C056H !! rejected with code C056H
    ");
}

#[test]
fn what_is_not_carried_out_is_not_written() {
    let place = Place {
        port: "COM1".to_string(),
        peer: "line".to_string(),
    };
    let mut traffic = Traffic::new(Decoder::new(Ports::Inovance, 24120));
    let mut frame = |direction, bytes: &[u8], protocol| {
        traffic.frame(Seen {
            place: &place,
            link: LinkProtocol::Serial(protocol),
            direction,
            bytes,
        });
    };
    let write = |register| rtu(&[1, 6, 0, register, 0, 1]);
    // Answered, rejected, for another station, for all.
    frame(Direction::In, &write(1), Protocol::ModbusRtu);
    frame(Direction::Out, &write(1), Protocol::ModbusRtu);
    frame(Direction::In, &write(2), Protocol::ModbusRtu);
    frame(Direction::Out, &rtu(&[1, 0x86, 2]), Protocol::ModbusRtu);
    frame(Direction::In, &write(3), Protocol::ModbusRtu);
    frame(
        Direction::In,
        &rtu(&[0, 6, 0, 4, 0, 1]),
        Protocol::ModbusRtu,
    );
    // A master that is not answered asks again.
    for _ in 0..2 {
        frame(Direction::Out, &write(5), Protocol::MasterRtu);
    }
    insta::assert_snapshot!("table", traffic.table().join("\n"));
}

/// A rejected request is one error, with the code of its answer, whether or not the request shows what is wrong.
#[test]
fn a_rejected_request_is_one_error() {
    let mut traffic = Traffic::new(Decoder::new(Ports::Inovance, 24120));
    let mut exchange = |server: ServerProtocol, request: &[u8], answer: &[u8]| {
        let place = Place {
            port: server.name().to_string(),
            peer: "127.0.0.1".to_string(),
        };
        let frames = [(Direction::In, request), (Direction::Out, answer)];
        for (direction, bytes) in frames.into_iter().filter(|(_, bytes)| !bytes.is_empty()) {
            traffic.frame(Seen {
                place: &place,
                link: LinkProtocol::Tcp(server),
                direction,
                bytes,
            });
        }
    };
    let read = |code: u8, count: u8| [1, 0xff, 10, 0, 0, 0, 0, 0, 0x20, code, count, 0];
    let server = ServerProtocol::Mc;
    // A device that is none, too many points, D0, a device that this PLC lacks; a command that is none.
    exchange(server, &read(0x41, 1), &[0x81, 0x56]);
    exchange(server, &read(0x44, 99), &[0x81, 0x57]);
    exchange(server, &read(0x44, 1), &[0x81, 0, 0, 0]);
    exchange(server, &read(0x52, 1), &[0x81, 0x58]);
    exchange(server, &[6], &[0x86, 0x50]);
    let server = ServerProtocol::ModbusTcp;
    let no_register = [0, 1, 0, 0, 0, 6, 1, 3, 0xea, 0x60, 0, 1];
    exchange(server, &no_register, &[0, 1, 0, 0, 0, 3, 1, 0x83, 2]);
    // Without an answer, and with one.
    exchange(server, b"GET / HTTP/1.1", b"");
    let server = ServerProtocol::ProgrammingPort;
    exchange(server, b"\x0239\x0333", b"\x15");
    exchange(server, b"\x020\x0399", b"\x15");
    insta::assert_snapshot!("rejected", traffic.table().join("\n"));
}

#[test]
fn any_bytes_are_shown() {
    let decoder = Decoder::new(Ports::L01s, 24120);
    let links = [
        LinkProtocol::Tcp(ServerProtocol::ModbusTcp),
        LinkProtocol::Tcp(ServerProtocol::Mc),
        LinkProtocol::Tcp(ServerProtocol::ProgrammingPort),
    ];
    let serial = [
        Protocol::ModbusRtu,
        Protocol::ModbusAscii,
        Protocol::ComputerLink,
    ];
    let links = links.into_iter().chain(serial.map(LinkProtocol::Serial));
    let mut state = 1u32;
    for link in links {
        for length in (0..64).chain([700, 9000]) {
            let next = |_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            };
            let bytes: Vec<u8> = (0..length).map(next).collect();
            for direction in [Direction::In, Direction::Out] {
                decoder.decode(link, direction, &bytes, Some(&bytes));
            }
        }
    }
}
