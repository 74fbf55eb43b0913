//! A slave on a bad line: every good frame is answered, whatever came before it, and nothing else writes.

use super::crc16;
use crate::comm::{CharFault, Received};
use crate::double::Double;
use crate::{Class, Plc};
use std::vec::Vec;

/// Duration of a character at 115,200 bit/s and 10 bits, in microseconds.
const CHARACTER_US: u32 = 87;

/// Frames of a run.
const FRAMES: usize = 4000;

/// Registers D that good frames read and write; nothing else changes.
const FIRST: u16 = 100;
const COUNT: u16 = 50;

fn sealed(body: &[u8]) -> Vec<u8> {
    [body, &crc16(body).to_le_bytes()].concat()
}

/// Expected handling of a frame on the line.
enum Frame {
    /// It is answered like this.
    Good(Vec<u8>),
    /// It is not answered, or rejected.
    Bad,
}

struct Line {
    plc: Double,
    /// Of a xorshift generator.
    state: u32,
    now_us: u32,
    /// Expected contents of D100 and the following registers.
    words: Vec<i16>,
}

impl Line {
    fn random(&mut self) -> u32 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 17;
        self.state ^= self.state << 5;
        self.state
    }

    fn below(&mut self, end: u32) -> u32 {
        self.random() % end
    }

    /// A good request, and its answer.
    fn good(&mut self) -> (Vec<u8>, Frame) {
        let offset = self.below(COUNT.into()) as u16;
        let [high, low] = (FIRST + offset).to_be_bytes();
        if self.below(2) == 0 {
            let value = self.random() as u16;
            self.words[usize::from(offset)] = value as i16;
            let [a, b] = value.to_be_bytes();
            let write = sealed(&[1, 6, high, low, a, b]);
            return (write.clone(), Frame::Good(write));
        }
        let [a, b] = (self.words[usize::from(offset)] as u16).to_be_bytes();
        let answer = sealed(&[1, 3, 2, a, b]);
        (sealed(&[1, 3, high, low, 0, 1]), Frame::Good(answer))
    }

    /// A request that is cut, flipped, too long, for somebody else, or nothing at all.
    fn bad(&mut self) -> Vec<u8> {
        let value = self.random() as u8;
        let [high, low] = (FIRST + self.below(COUNT.into()) as u16).to_be_bytes();
        let mut frame = sealed(&[1, 6, high, low, value, value]);
        match self.below(6) {
            0 => frame.truncate(1 + self.below(7) as usize),
            1 => {
                let bit = self.below(64);
                frame[bit as usize / 8] ^= 1 << (bit % 8);
            }
            2 => frame.extend_from_within(..),
            3 => frame = sealed(&[2, 6, high, low, value, value]),
            4 => frame = sealed(&[1, 6, 0x7f, low, value, value]),
            _ => {
                let length = 1 + self.below(700);
                frame = (0..length).map(|_| self.random() as u8).collect();
            }
        }
        frame
    }

    /// Sends a frame, and returns what comes back before the next one.
    fn exchange(&mut self, frame: &[u8]) -> Vec<u8> {
        for (n, &byte) in frame.iter().enumerate() {
            self.now_us += CHARACTER_US;
            if n % 16 == 15 {
                self.plc.advance_ports(self.now_us);
            }
            let character = Received {
                at_us: self.now_us,
                byte,
                fault: CharFault::None,
            };
            self.plc.hal.line(1).unwrap().feed(character).unwrap();
        }
        for _ in 0..4 {
            self.now_us += 2000;
            self.plc.advance_ports(self.now_us);
        }
        let (line, now_us) = (self.plc.hal.line(1).unwrap(), self.now_us);
        std::iter::from_fn(|| line.take(now_us).map(|character| character.byte)).collect()
    }
}

#[test]
fn good_frames_among_bad_ones_are_all_answered() {
    let mut plc = Double::new().with_d(8126, &[2]);
    plc.set_d(8120, &[0xc1, 1]);
    plc.sys.first_scan = false;
    plc.advance_ports(0);
    let mut line = Line {
        plc,
        state: 0x9e37_79b9,
        now_us: 0,
        words: std::vec![0; COUNT.into()],
    };
    for n in 0..FRAMES {
        let (frame, wanted) = match n % 10 {
            9 => (line.bad(), Frame::Bad),
            _ => line.good(),
        };
        let answer = line.exchange(&frame);
        match wanted {
            Frame::Good(wanted) => assert_eq!(answer, wanted, "frame {n}: {frame:x?}"),
            Frame::Bad => assert!(answer.is_empty() || answer[1] & 0x80 != 0, "{frame:x?}"),
        }
    }
    assert_eq!(line.plc.d(FIRST.into(), COUNT.into()), line.words);
    let others = (0..8000).filter(|n| !(100..150).contains(n));
    let mut others = others.map(|n| line.plc.word(Class::D, n));
    assert!(others.all(|word| word == Some(0)));
}
