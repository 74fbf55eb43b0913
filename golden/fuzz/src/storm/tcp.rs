//! Storms on servers over TCP: one connection sends good frames, others bad ones, and some stop in the middle of a
//! frame.

use super::Outcome;
use crate::plc::{Plc, module, used_ns};
use crate::random::Random;
use crate::text::{ACK, Bytes, stx, words};
use rungc_host::servers::Dialogue;
use rungc_models::ModelId;
use rungc_rt::Ports;
use rungc_rt::comm::Served;
use rungc_rt::comm::service::{ServerProtocol, Service};

/// Registers that good frames read and write, from D100 on.
const COUNT: usize = 50;

/// A server.
pub struct Server {
    /// Its name.
    pub name: &'static str,
    protocol: ServerProtocol,
    /// Writes or reads a register: the frame, and its answer.
    good: fn(u16, u16, bool) -> (Bytes, Bytes),
}

/// All servers.
pub const SERVERS: [Server; 4] = [
    Server {
        name: "modbus-tcp",
        protocol: ServerProtocol::ModbusTcp,
        good: |number, value, write| {
            let ([high, low], [a, b]) = (number.to_be_bytes(), value.to_be_bytes());
            if write {
                let frame = vec![a, b, 0, 0, 0, 6, 1, 6, high, low, a, b];
                return (frame.clone(), frame);
            }
            (
                vec![a, b, 0, 0, 0, 6, 1, 3, high, low, 0, 1],
                vec![a, b, 0, 0, 0, 5, 1, 3, 2, a, b],
            )
        },
    },
    Server {
        name: "mc-1e",
        protocol: ServerProtocol::Mc,
        good: |number, value, write| {
            let ([low, high], [a, b]) = (number.to_le_bytes(), value.to_le_bytes());
            let head = [
                2 * u8::from(write) + 1,
                0xff,
                10,
                0,
                low,
                high,
                0,
                0,
                0x20,
                0x44,
                1,
                0,
            ];
            if write {
                return ([&head[..], &[a, b]].concat(), vec![0x83, 0]);
            }
            (head.to_vec(), vec![0x81, 0, a, b])
        },
    },
    Server {
        name: "mc-3e",
        protocol: ServerProtocol::Mc,
        good: |number, value, write| {
            let ([low, high], [a, b]) = (number.to_le_bytes(), value.to_le_bytes());
            let (command, length) = if write { (0x14, 14) } else { (0x04, 12) };
            let mut frame = vec![
                0x50, 0, 0, 0xff, 0xff, 3, 0, length, 0, 16, 0, 1, command, 0, 0,
            ];
            frame.extend([low, high, 0, 0xa8, 1, 0]);
            let mut answer = vec![0xd0, 0, 0, 0xff, 0xff, 3, 0, 2, 0, 0, 0];
            if write {
                frame.extend([a, b]);
            } else {
                answer[7] = 4;
                answer.extend([a, b]);
            }
            (frame, answer)
        },
    },
    Server {
        name: "fx-over-tcp",
        protocol: ServerProtocol::ProgrammingPort,
        good: |number, value, write| {
            let (address, digits) = (0x1000 + 2 * number, words(&[value.swap_bytes()]));
            if write {
                return (stx(&format!("1{address:04X}02{digits}")), vec![ACK]);
            }
            (stx(&format!("0{address:04X}02")), stx(&digits))
        },
    },
];

/// Invalid request: cut, of another length, noise, or for a device that does not exist.
fn bad(server: &Server, random: &mut Random) -> Bytes {
    let number = if random.below(4) == 0 { 0x7000 } else { 100 };
    let mut frame = (server.good)(number, random.word(), true).0;
    match random.below(4) {
        0 => frame.truncate(1 + random.below(frame.len() - 1)),
        1 if number == 0x7000 => {}
        2 => {
            let at = 1 + random.below(3);
            frame[at] ^= 0x55;
            frame.truncate(frame.len() - 1);
        }
        _ => {
            let length = 1 + random.below(600);
            frame = random.bytes(length);
        }
    }
    frame
}

/// Sends this number of frames.
///
/// # Panics
/// A good frame was not answered as it should be, or something was written that no good frame has written.
pub fn run(server: &Server, frames: usize, seed: u64) -> Outcome {
    let mut plc = Plc::new(module(ModelId::H2u, 0, "LD M8000\nOUT M0\nEND\n"), 0);
    let mut random = Random::new(seed);
    let mut wanted = [0; COUNT];
    let service = Service::new(server.protocol, Ports::Inovance, 24_120);
    let mut good = Dialogue::new(service);
    // Connections that stopped in the middle of a frame, and stay open.
    let mut idle = Vec::new();
    let mut outcome = Outcome {
        frames,
        bad: 0,
        longest_ns: 0,
    };
    for n in 0..frames {
        let before = used_ns();
        let mut map = Served::new(plc.devices(), 24_120);
        if random.below(10) == 0 {
            outcome.bad += 1;
            let mut dialogue = Dialogue::new(service);
            dialogue.receive(&bad(server, &mut random), &mut map);
            idle.push(dialogue);
            if idle.len() > 16 {
                idle.remove(0);
            }
        } else {
            let (at, write) = (random.below(COUNT), random.below(2) == 0);
            if write {
                wanted[at] = random.word();
            }
            let (frame, answer) = (server.good)(100 + at as u16, wanted[at], write);
            // The network cuts it where it likes.
            let (first, second) = frame.split_at(random.below(frame.len()));
            let mut reply = good.receive(first, &mut map).reply;
            reply.extend(good.receive(second, &mut map).reply);
            assert_eq!(reply, answer, "{}: frame {n}: {frame:02x?}", server.name);
        }
        outcome.longest_ns = outcome.longest_ns.max(used_ns() - before);
    }
    for number in 0..8000 {
        let own = (number as usize)
            .checked_sub(100)
            .and_then(|at| wanted.get(at));
        assert_eq!(
            plc.d(number),
            Some(own.copied().unwrap_or(0)),
            "{}: D{number}",
            server.name
        );
    }
    outcome
}
