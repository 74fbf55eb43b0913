//! Ports against a virtual line: whole exchanges, and any characters at all.

use super::modbus::crc16;
use super::{CharFault, Ports, Received};
use crate::double::{Double, reg};
use crate::{Class, Plc, RtFn, k};
use proptest::prelude::*;
use std::vec::Vec;

/// Duration of a character at 9600 bit/s and 10 bits, in microseconds.
const CHARACTER_US: u32 = 1042;

/// An H2U in RUN whose COM1 has these registers.
fn plc(protocol: i32, format: i32) -> Double {
    let mut plc = Double::new().with_d(8126, &[protocol]);
    plc.set_d(8120, &[format, 1]);
    plc.set_d(8129, &[10]);
    plc.sys.first_scan = false;
    plc.advance_ports(0);
    plc
}

/// Characters come to COM1 back to back from this time on, without faults.
fn feed(plc: &mut Double, from_us: u32, bytes: &[u8]) -> u32 {
    let mut at_us = from_us;
    for &byte in bytes {
        at_us += CHARACTER_US;
        let character = Received {
            at_us,
            byte,
            fault: CharFault::None,
        };
        plc.hal.line(1).unwrap().feed(character).unwrap();
    }
    at_us
}

/// Characters sent by COM1 until this time.
fn sent(plc: &mut Double, now_us: u32) -> Vec<u8> {
    let line = plc.hal.line(1).unwrap();
    std::iter::from_fn(|| line.take(now_us).map(|character| character.byte)).collect()
}

/// Advances time to this moment in milliseconds.
fn pass(plc: &mut Double, from_us: u32, to_us: u32) {
    for ms in from_us / 1000..=to_us / 1000 {
        plc.advance_ports(ms * 1000);
    }
}

/// A request of a computer link that never ends fills the port; the one after it is answered.
#[test]
fn a_frame_without_an_end_hides_no_other() {
    let mut plc = plc(6, 0x2086);
    let mut flood = b"\x0501FFWW0C20099".to_vec();
    flood.resize(super::FRAME, b'0');
    let end_us = feed(&mut plc, 0, &flood);
    let begin_us = end_us + 5000;
    pass(&mut plc, 0, begin_us);
    let end_us = feed(&mut plc, begin_us, b"\x0501FFWW0D0100011234FB");
    pass(&mut plc, begin_us, end_us + 20_000);
    assert_eq!(sent(&mut plc, end_us + 20_000), b"\x0601FF");
    assert_eq!(plc.d(100, 1), [0x1234]);
}

#[test]
fn a_slave_answers_after_silence_and_takes_the_next_frame() {
    let mut plc = plc(2, 0x81);
    plc.set_d(100, &[0x5100]);
    let request = [1, 3, 0, 0x64, 0, 1, 0xc5, 0xd5];
    let end_us = feed(&mut plc, 0, &request);
    pass(&mut plc, 0, end_us + 3000);
    assert_eq!(sent(&mut plc, 100_000), []);
    pass(&mut plc, end_us + 3000, end_us + 5000);
    assert_eq!(sent(&mut plc, 100_000), [1, 3, 2, 0x51, 0, 0x85, 0xd4]);
    pass(&mut plc, end_us + 5000, 50_000);
    let end_us = feed(&mut plc, 50_000, &request);
    pass(&mut plc, 50_000, end_us + 20_000);
    assert_eq!(sent(&mut plc, 100_000).len(), 7);
}

/// A programmer asks for 115,200 bit/s: the answer comes at the old rate; a character that is wrong brings that back.
#[test]
fn a_programmer_chooses_the_rate() {
    let mut plc = plc(1, 0);
    let rate = |plc: &mut Double| plc.hal.line(1).unwrap().format().bits_per_second;
    let end_us = feed(&mut plc, 0, b"\x02A5\x0379");
    pass(&mut plc, 0, end_us + 500);
    assert_eq!(rate(&mut plc), 9600);
    pass(&mut plc, end_us, end_us + 5000);
    assert_eq!(sent(&mut plc, end_us + 5000), [6]);
    assert_eq!(rate(&mut plc), 115_200);
    let refused_us = feed(&mut plc, end_us + 6000, b"\x02A4\x0378");
    pass(&mut plc, end_us + 5000, refused_us + 5000);
    assert_eq!(sent(&mut plc, refused_us + 5000), [0x15]);
    assert_eq!(rate(&mut plc), 115_200);
    let wrong = Received {
        at_us: refused_us + 6000,
        byte: 0x55,
        fault: CharFault::Framing,
    };
    plc.hal.line(1).unwrap().feed(wrong).unwrap();
    pass(&mut plc, refused_us + 5000, refused_us + 9000);
    assert_eq!(rate(&mut plc), 9600);
}

#[test]
fn what_comes_while_a_half_duplex_port_sends_is_not_received() {
    let mut plc = plc(2, 0x81);
    let request = [1, 3, 0, 0x64, 0, 1, 0xc5, 0xd5];
    let end_us = feed(&mut plc, 0, &request);
    pass(&mut plc, 0, end_us + 4000);
    feed(&mut plc, end_us + 4000, &request[..5]);
    pass(&mut plc, end_us + 4000, 100_000);
    assert_eq!(sent(&mut plc, 200_000).len(), 7);
    assert_eq!(plc.bit(Class::M, 8063), Some(false));
}

#[test]
fn the_protocol_is_bound_until_stop() {
    let mut plc = plc(2, 0x81);
    plc.set_d(8126, &[3]);
    pass(&mut plc, 0, 5000);
    let end_us = feed(&mut plc, 5000, b":010300640001");
    pass(&mut plc, 5000, end_us + 5000);
    // Characters without a sum are a bad frame of RTU.
    assert_eq!(plc.d(8063, 1), [6343]);
    plc.sys.set_running(false);
    plc.advance_ports(end_us + 6000);
    let status = plc.port(1).unwrap().status;
    assert_eq!(
        (status.protocol, status.bound),
        (super::Protocol::ModbusAscii, false)
    );
}

/// RS D10 K4 D50 K4, driven.
fn rs(plc: &mut Double) {
    plc.site.drive = true;
    plc.call(RtFn::Rs, &[reg(10), k(4), reg(50), k(4)]).unwrap();
}

#[test]
fn rs_sends_marks_around_its_data_and_waits_for_them() {
    let mut plc = plc(0x10, 0x781);
    plc.set_d(8124, &[2, 3]);
    plc.set_d(10, &[0x4241, 0x4443]);
    rs(&mut plc);
    plc.set_bit(Class::M, 8122, true);
    pass(&mut plc, 0, 3000);
    assert_eq!(plc.bit(Class::M, 8122), Some(true));
    pass(&mut plc, 3000, 20_000);
    assert_eq!(sent(&mut plc, 20_000), b"\x02ABCD\x03");
    assert_eq!(
        (plc.bit(Class::M, 8122), plc.d(8122, 1)[0]),
        (Some(false), 0)
    );
    let end_us = feed(&mut plc, 20_000, b"x\x02ab\x03");
    pass(&mut plc, 20_000, end_us + 1000);
    assert_eq!(plc.bit(Class::M, 8123), Some(true));
    assert_eq!((plc.d(50, 2), plc.d(8123, 1)[0]), (std::vec![0x6261, 0], 2));
    // Characters received before the program reacts are lost.
    let end_us = feed(&mut plc, end_us + 1000, b"\x02cd\x03");
    pass(&mut plc, end_us, end_us + 1000);
    assert_eq!(plc.d(50, 1), [0x6261]);
}

#[test]
fn rs_shows_an_answer_that_does_not_go_on() {
    let mut plc = plc(0x10, 0x481);
    rs(&mut plc);
    let end_us = feed(&mut plc, 0, b"ab");
    pass(&mut plc, 0, end_us + 99_000);
    assert_eq!(plc.bit(Class::M, 8124), Some(true));
    pass(&mut plc, end_us + 99_000, end_us + 102_000);
    let flags = [8123, 8124, 8129].map(|relay| plc.bit(Class::M, relay).unwrap());
    assert_eq!((flags, plc.d(8123, 1)[0]), ([false, false, true], 2));
}

#[test]
fn rs_under_another_protocol_is_an_error_of_the_port() {
    let mut plc = plc(2, 0x81);
    rs(&mut plc);
    assert_eq!(
        (plc.bit(Class::M, 8063), plc.d(8063, 1)[0]),
        (Some(true), 6349)
    );
}

fn any_character() -> impl Strategy<Value = (u8, u8, u32)> {
    (any::<u8>(), 0..20u8, 0..40u32)
}

/// A partner that sends for ever, without a gap, holds a master up for no longer than the time-out and the longest
/// frame.
#[test]
fn an_answer_that_never_ends_is_given_up() {
    const TIME_OUT_US: u32 = 100_000;
    const TIMED_OUT: i16 = 6345;
    let mut plc = plc(0x20, 0x81);
    let ops = [k(0x0103), k(0), k(1), reg(200)];
    plc.call(RtFn::Modbus, &ops).unwrap();
    let request_us = 8 * CHARACTER_US;
    let [mut now_us, mut fed_us] = [0, request_us + 5000];
    while plc.word(Class::D, 8063) != Some(TIMED_OUT) {
        now_us += 1000;
        while fed_us + CHARACTER_US <= now_us {
            fed_us = feed(&mut plc, fed_us, &[0x55]);
        }
        plc.advance_ports(now_us);
        assert!(now_us < 1_000_000, "it is still waiting");
    }
    let longest_us = TIME_OUT_US + 256 * CHARACTER_US;
    let waited_us = now_us - request_us;
    assert!(waited_us > TIME_OUT_US, "{waited_us}");
    assert!(waited_us <= longest_us + 2000, "{waited_us}");
    // The next request goes out as soon as the line is silent.
    sent(&mut plc, now_us);
    plc.call(RtFn::Modbus, &ops).unwrap();
    plc.call(RtFn::Modbus, &ops).unwrap();
    pass(&mut plc, now_us, now_us + 20_000);
    assert_eq!(sent(&mut plc, now_us + 20_000)[..2], [1, 3]);
}

/// A request to station 0, 1 or 2, with or without a right sum.
fn any_request() -> impl Strategy<Value = Vec<u8>> {
    let head = (0..3u8, 0..=17u8, 0..4u8, any::<u8>(), 0..2u8, 0..=130u8);
    let data = prop::collection::vec(any::<u8>(), 0..250);
    (head, data, any::<bool>(), 0..8u8).prop_map(|(head, data, fits, damage)| {
        let (to, function, high, low, many, count) = head;
        let mut frame = std::vec![to, function, high, low, many, count];
        let bytes = match function {
            0x0f => (usize::from(many) << 8 | usize::from(count)).div_ceil(8),
            0x10 => 2 * usize::from(count),
            _ => 0,
        };
        if bytes > 0 {
            frame.push(bytes as u8);
        }
        let all = data.iter().cycle().copied();
        frame.extend(all.take(if fits { bytes } else { data.len() }));
        frame.truncate(254);
        frame.extend((crc16(&frame) ^ u16::from(damage == 0)).to_le_bytes());
        frame
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// A slave that is all that its port may be does what the port of a whole program does.
    #[test]
    fn a_slave_alone_is_a_slave(
        requests in prop::collection::vec((any_request(), 0..12u8), 1..6),
        format in prop::sample::select(std::vec![0x81, 0x8f, 0xc1, 0x87]),
        protocol in prop::sample::select(std::vec![2, 2, 2, 3, 0x20]),
    ) {
        let [mut whole, mut alone] = [(); 2].map(|()| {
            let mut plc = plc(0, format);
            plc.sys.first_scan = true;
            plc.set_d(8126, &[protocol]);
            plc
        });
        let mut now_us = 0;
        for (request, fault) in requests {
            for (at, byte) in request.into_iter().enumerate() {
                now_us += CHARACTER_US;
                let fault = if at == 3 { CharFault::of(fault) } else { CharFault::None };
                let character = Received { at_us: now_us, byte, fault };
                for plc in [&mut whole, &mut alone] {
                    plc.hal.line(1).unwrap().feed(character);
                }
            }
            for _ in 0..80 {
                whole.advance_ports(now_us);
                alone.advance_slave(now_us);
                for plc in [&mut whole, &mut alone] {
                    plc.sys.first_scan = false;
                }
                now_us += 4000;
            }
            prop_assert_eq!(sent(&mut whole, now_us), sent(&mut alone, now_us));
            let formats = [&mut whole, &mut alone].map(|plc| plc.hal.line(1).unwrap().format());
            if protocol == 2 {
                prop_assert_eq!(formats[0], formats[1]);
                prop_assert_eq!(whole.d(8063, 1), alone.d(8063, 1));
            }
        }
        prop_assert_eq!(whole.d(0, 1300), alone.d(0, 1300));
        for relay in 0..1300 {
            prop_assert_eq!(whole.bit(Class::M, relay), alone.bit(Class::M, relay));
        }
    }
}

proptest! {
    /// Whatever comes, with whatever faults and gaps, a port neither panics nor writes where its protocol may not.
    #[test]
    fn no_characters_do_harm(
        family in prop::sample::select(std::vec![
            Ports::Inovance,
            Ports::L01s,
            Ports::Hm,
            Ports::Fx,
            Ports::Fx3,
            Ports::Fx3g,
            Ports::Board3u,
        ]),
        protocol in 0..0x90i32,
        format: i16,
        marks: [u8; 2],
        characters in prop::collection::vec(any_character(), 0..700),
    ) {
        let mut plc = plc(protocol, format.into());
        plc.family = family;
        plc.set_d(8124, &marks.map(i32::from));
        let mut now_us = 0;
        for (byte, fault, gap_ms) in characters {
            rs(&mut plc);
            now_us += CHARACTER_US + if gap_ms < 5 { gap_ms * 1000 } else { 0 };
            let character = Received { at_us: now_us, byte, fault: CharFault::of(fault) };
            for port in 0..4 {
                plc.hal.line(port).unwrap().feed(character);
            }
            plc.advance_ports(now_us);
        }
        let free = [0x00, 0x10].contains(&protocol) && family == Ports::Inovance && format >> 14 & 1 == 0;
        if free {
            prop_assert_eq!(plc.d(52, 10), std::vec![0; 10]);
        }
    }
}
