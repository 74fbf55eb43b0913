//! Storms: many frames on one line, a tenth of them bad. No good frame may be lost, nothing else may be written, and no
//! call that advances the ports may take long.

pub mod tcp;

use crate::partner::{Partner, Registers};
use crate::plc::{Plc, module};
use crate::random::Random;
use crate::text::Bytes;
use rungc_rt::comm::CAN_PORT;
use std::fmt;

/// Time-out for a PLC's answer or a master's request, in microseconds: an answer without an end is abandoned after a
/// second.
const PATIENCE_US: u64 = 2_000_000;

/// Time for which a partner waits after a bad frame for its rejection: a frame of a computer link contains its own
/// waiting time, up to 150 ms.
const REFUSAL_US: u64 = 200_000;

/// Outcome of a storm.
#[derive(Clone, Copy, Debug)]
pub struct Outcome {
    /// Frames sent.
    pub frames: usize,
    /// Bad ones among them.
    pub bad: usize,
    /// The longest that a call has taken which advanced the ports, in nanoseconds of the processor's time.
    pub longest_ns: u64,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Outcome {
            frames,
            bad,
            longest_ns,
        } = self;
        write!(
            f,
            "{frames} frames, {bad} of them bad; the longest call took {} µs",
            longest_ns / 1000
        )
    }
}

/// A frame that is not one, in pieces with a pause after each.
fn bad(
    partner: &Partner,
    request: &[u8],
    random: &mut Random,
    registers: &Registers,
) -> Vec<(Bytes, u64)> {
    let mut untouched = Registers(registers.0.clone());
    let mut frame = (partner.good)(request, random, &mut untouched).frame;
    let bits = if partner.seven_bits { 7 } else { 8 };
    match random.below(6) {
        // Cut.
        0 => frame.truncate(1 + random.below(frame.len() - 1)),
        // One bit is wrong. Frames of CAN carry no sum: the adapter has checked it.
        1 if partner.port != CAN_PORT => {
            let at = random.below(frame.len());
            frame[at] ^= 1 << random.below(bits);
        }
        // A piece is lost from its middle.
        2 if partner.port != CAN_PORT => {
            let at = 1 + random.below(frame.len() - 2);
            frame.remove(at);
        }
        // A flood.
        3 => {
            let length = 1 + random.below(600);
            frame = random.bytes(length);
            frame
                .iter_mut()
                .for_each(|byte| *byte &= if bits == 7 { 0x7f } else { 0xff });
        }
        // One character after the other, and never the end.
        4 => {
            let length = 1 + random.below(frame.len().min(12) - 1);
            let pieces = frame[..length].iter();
            return pieces
                .map(|&byte| (vec![byte], 1000 * (5 + random.below(60) as u64)))
                .collect();
        }
        _ => frame = (partner.wrong)(request, random),
    }
    vec![(frame, 5000)]
}

/// Sends this number of frames.
///
/// # Panics
/// A good frame was not answered as it should be, or something was written that no good frame has written.
pub fn run(partner: &Partner, frames: usize, seed: u64) -> Outcome {
    let mut plc = Plc::new(
        module(partner.model, partner.port, partner.program),
        partner.port,
    );
    plc.longest_ns = 0;
    let mut random = Random::new(seed);
    let mut wanted = Registers::of(&plc);
    let bits = plc.bits();
    let mut outcome = Outcome {
        frames,
        bad: 0,
        longest_ns: 0,
    };
    for n in 0..frames {
        let sent = if partner.plc_asks {
            plc.answer(PATIENCE_US)
        } else {
            Bytes::new()
        };
        assert_eq!(
            sent.is_empty(),
            !partner.plc_asks,
            "{}: frame {n}",
            partner.name
        );
        let request = &sent[(partner.last)(&sent)..];
        if random.below(10) == 0 {
            outcome.bad += 1;
            for (piece, pause_us) in bad(partner, request, &mut random, &wanted) {
                plc.feed(&piece);
                plc.wait(pause_us);
            }
            if !partner.plc_asks {
                plc.answer(REFUSAL_US);
            }
            plc.sent();
            continue;
        }
        let good = (partner.good)(request, &mut random, &mut wanted);
        plc.feed(&good.frame);
        if good.answer.is_empty() {
            // Until the next scan has seen it.
            let pause_us = if partner.port == CAN_PORT {
                12_000
            } else {
                3000
            };
            plc.wait(if partner.plc_asks { 4000 } else { pause_us });
        } else {
            let answer = plc.answer(PATIENCE_US);
            assert_eq!(
                answer, good.answer,
                "{}: frame {n}: {:02x?}",
                partner.name, good.frame
            );
        }
        if n % 1000 == 0 || n + 1 == frames {
            check(partner, n, &plc, &wanted, &bits);
        }
    }
    check(partner, frames, &plc, &wanted, &bits);
    outcome.longest_ns = plc.longest_ns;
    outcome
}

/// All devices hold what good frames have written, and otherwise what they held before.
fn check(partner: &Partner, n: usize, plc: &Plc, wanted: &Registers, bits: &[bool]) {
    wanted.check(partner, plc);
    assert_eq!(plc.bits(), bits, "{}: after frame {n}", partner.name);
}
