//! Decoders of frames alone, without ports and time: thousands of frames in the time that a line needs for one. The
//! first byte of an input chooses a variant; the rest is sent as it is, and once more as a frame of the protocol.

use super::Target;
use crate::plc::{Plc, module};
use crate::text::{ascii, enq, rtu, stx};
use rungc_models::ModelId;
use rungc_rt::comm::canlink::Head;
use rungc_rt::comm::computer_link::{self, Dialect, Remote};
use rungc_rt::comm::modbus::client::{Client, ClientRow, Link};
use rungc_rt::comm::modbus::{self, Buffer, Framing, Job, tcp};
use rungc_rt::comm::{CanFrame, Cut, Frame, Map, Memory, Served, fx_port, mc};
use rungc_rt::{Class, Ports};
use std::cell::RefCell;

/// Longer than any answer.
const LONGEST_REPLY: usize = 8192;

/// Decodes one frame on a PLC; the first argument is the variant.
type Decode = fn(u8, &[u8], &mut dyn Map, &mut Frame);

fn target(name: &'static str, decode: Decode, seeds: &[&[u8]]) -> Target {
    let module = module(ModelId::H2u, 0, "LD M8000\nOUT M0\nEND\n");
    let plc = RefCell::new(Plc::new(module, 0));
    Target {
        name,
        run: Box::new(move |input| {
            let Some((&variant, bytes)) = input.split_first() else {
                return;
            };
            let mut plc = plc.borrow_mut();
            let mut map = Served::new(plc.devices(), 24_120);
            let mut reply = [0; LONGEST_REPLY];
            decode(variant, bytes, &mut map, &mut Frame::new(&mut reply));
        }),
        seeds: seeds.iter().map(|seed| seed.to_vec()).collect(),
    }
}

/// The characters up to the end of a request, if there is one.
fn request(bytes: &[u8], cut: impl Fn(&[u8]) -> Cut) -> Option<&[u8]> {
    let ends = (1..=bytes.len()).map(|end| &bytes[..end]);
    ends.take_while(|part| cut(part) != Cut::Drop)
        .find(|part| cut(part) == Cut::Whole)
}

/// A Modbus slave of each profile, in both framings.
fn modbus_slave(variant: u8, bytes: &[u8], map: &mut dyn Map, reply: &mut Frame) {
    let families = [Ports::Inovance, Ports::L01s, Ports::Hm, Ports::Fx3];
    let framing = [Framing::Rtu, Framing::Ascii][usize::from(variant & 1)];
    let settings = modbus::Settings {
        framing,
        station: 1,
        profile: families[usize::from(variant >> 1 & 3)].modbus(24_120),
    };
    for frame in [bytes.to_vec(), sealed(framing, bytes)] {
        let _ = modbus::answer(&settings, &frame, map, reply);
    }
}

/// The answer to a master's request, whose function and count come first.
fn modbus_master(variant: u8, bytes: &[u8], map: &mut dyn Map, _: &mut Frame) {
    let [function, count, rest @ ..] = bytes else {
        return;
    };
    let job = Job {
        station: 1,
        function: *function,
        address: 0,
        count: (*count).into(),
        buffer: Buffer::words(Class::D, 100),
    };
    let framing = [Framing::Rtu, Framing::Ascii][usize::from(variant & 1)];
    for frame in [rest.to_vec(), sealed(framing, rest)] {
        let _ = modbus::accept(framing, &job, &frame, map);
    }
}

/// Answer of a server over TCP to a request, whose function and count come first: as it is, and as the answer to it.
fn modbus_client(_: u8, bytes: &[u8], map: &mut dyn Map, request: &mut Frame) {
    let [function, count, rest @ ..] = bytes else {
        return;
    };
    let rows = [ClientRow {
        trigger: Class::M,
        number: 8000,
        unit: 1,
        function: *function,
        address: 0,
        count: (*count).into(),
        buffer: 100,
    }];
    let mut client = Client::new(Ports::Inovance, 1);
    let _ = client.next(&rows, Link::Open, 0, map, request);
    let length = (rest.len() as u16).to_be_bytes();
    let whole = [&[0, 1, 0, 0][..], &length, rest].concat();
    for &byte in rest.iter().chain(&whole) {
        let _ = client.feed(&rows, byte, 0, map);
    }
}

fn sealed(framing: Framing, body: &[u8]) -> Vec<u8> {
    match framing {
        Framing::Rtu => rtu(body),
        Framing::Ascii => ascii(body),
    }
}

/// Servers over TCP.
fn over_tcp(variant: u8, bytes: &[u8], map: &mut dyn Map, reply: &mut Frame) {
    match variant & 1 {
        0 => {
            if let Some(request) = request(bytes, mc::cut) {
                let _ = mc::answer(request, map, reply);
            }
        }
        _ => {
            let profile = Ports::Inovance.modbus(24_120);
            let length = (bytes.len() as u16).to_be_bytes();
            let whole = [&[0, 1, 0, 0][..], &length, bytes].concat();
            for bytes in [bytes, &whole[..]] {
                if let Some(request) = request(bytes, tcp::cut) {
                    let _ = tcp::answer(profile, request, map, reply);
                }
            }
        }
    }
}

/// The programming port, in both address spaces.
fn programming_port(variant: u8, bytes: &[u8], map: &mut dyn Map, reply: &mut Frame) {
    let families = [Ports::Inovance, Ports::Fx3];
    let settings = families[usize::from(variant & 1)].programming_port();
    let mut memory = Memory::new();
    for frame in [bytes.to_vec(), stx(&String::from_utf8_lossy(bytes))] {
        if let Some(request) = request(&frame, fx_port::cut) {
            let _ = fx_port::answer(settings, &mut memory, request, map, reply);
        }
    }
}

/// Computer link with and without sum and CR LF, in both dialects.
fn computer_link(variant: u8, bytes: &[u8], map: &mut dyn Map, reply: &mut Frame) {
    let settings = computer_link::Settings {
        station: 0,
        sum: variant & 1 != 0,
        crlf: variant & 2 != 0,
        dialect: match variant & 4 {
            0 => Dialect::Fx(*b"9D"),
            _ => Dialect::Hm,
        },
    };
    let mut remote = Remote::new();
    let text = String::from_utf8_lossy(bytes);
    for frame in [bytes.to_vec(), enq(&text, settings.crlf)] {
        if let Some(request) = request(&frame, |part| computer_link::cut(settings, part)) {
            let _ = computer_link::answer(settings, &mut remote, request, map, reply);
        }
        let _ = computer_link::answer_late(settings, &mut remote, &frame, map, reply);
    }
}

/// A frame on CAN as an adapter writes it, and the parts of its identifier.
fn can(_: u8, bytes: &[u8], _: &mut dyn Map, text: &mut Frame) {
    let Some(frame) = CanFrame::parse(bytes) else {
        return;
    };
    frame.write(text);
    assert_eq!(CanFrame::parse(text.as_slice()), Some(frame));
    if let Some(head) = Head::of(frame.id) {
        assert_eq!(head.id(), frame.id);
    }
}

pub(super) fn targets() -> [Target; 7] {
    [
        target(
            "decode-can",
            can,
            &[b"\0t2002ABCD\r", b"\0T0810806481122334455667788\r"],
        ),
        target(
            "decode-modbus-slave",
            modbus_slave,
            &[&[0, 1, 3, 0, 0, 0, 1], &[1, 1, 16, 0, 0, 0, 1, 2, 0, 7]],
        ),
        target(
            "decode-modbus-master",
            modbus_master,
            &[
                &[0, 3, 1, 1, 3, 2, 0, 7],
                &[1, 12, 0, 1, 12, 6, 0, 0, 0, 1, 0, 1],
            ],
        ),
        target(
            "decode-modbus-client",
            modbus_client,
            &[
                &[0, 3, 1, 1, 3, 2, 0, 7],
                &[0, 1, 20, 1, 1, 3, 1, 2, 3],
                &[0, 16, 2, 1, 0x90, 3],
            ],
        ),
        target(
            "decode-tcp",
            over_tcp,
            &[
                &[0, 1, 0xff, 10, 0, 0, 0, 0, 0, 0x20, 0x44, 1, 0],
                &[1, 1, 3, 0, 0, 0, 1],
            ],
        ),
        target(
            "decode-programming-port",
            programming_port,
            &[b"\x000100002", b"\x01E00400002"],
        ),
        target(
            "decode-computer-link",
            computer_link,
            &[b"\x0300FFWR0D000001", b"\x0400FFBR0M000004"],
        ),
    ]
}
