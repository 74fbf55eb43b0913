//! Serial lines: whatever a partner sends, the next good frame is understood.
//!
//! The input is a list of pieces. The first byte of a piece says how long it is (bits 0 to 4, plus 1), whether it gets
//! what makes a frame of it (bit 5), and how long the line is silent after it (bits 6 and 7).

use super::Target;
use crate::partner::{Partner, Registers};
use crate::plc::{Plc, module};
use crate::random::Random;

/// Silence after a piece, in microseconds.
const PAUSES_US: [u64; 4] = [0, 2500, 8000, 60_000];

/// Silence after which a port has given up whatever was begun, in microseconds.
const GIVEN_UP_US: u64 = 1_200_000;

/// Time-out for a PLC's answer or request, in microseconds.
const PATIENCE_US: u64 = 2_000_000;

/// Takes what a piece is off the input.
fn piece(input: &mut &[u8]) -> Option<(bool, Vec<u8>, u64)> {
    let (&head, rest) = input.split_first()?;
    let (bytes, rest) = rest.split_at(rest.len().min(usize::from(head & 31) + 1));
    *input = rest;
    Some((
        head & 32 != 0,
        bytes.to_vec(),
        PAUSES_US[usize::from(head >> 6)],
    ))
}

fn run(partner: &Partner, plc: &mut Plc, mut input: &[u8]) {
    while let Some((sealed, bytes, pause_us)) = piece(&mut input) {
        let bytes = if sealed {
            (partner.seal)(&bytes)
        } else {
            bytes
        };
        plc.feed(&bytes);
        plc.wait(pause_us);
    }
    plc.wait(GIVEN_UP_US);
    plc.sent();
    let request = if partner.plc_asks {
        plc.answer(PATIENCE_US)
    } else {
        Vec::new()
    };
    let request = &request[(partner.last)(&request)..];
    let mut registers = Registers::of(plc);
    let good = (partner.good)(request, &mut Random::new(1), &mut registers);
    plc.feed(&good.frame);
    if good.answer.is_empty() {
        plc.wait(30_000);
    } else {
        assert_eq!(plc.answer(PATIENCE_US), good.answer, "{:02x?}", good.frame);
    }
    registers.check(partner, plc);
}

pub(super) fn target(partner: &'static Partner) -> Target {
    let module = module(partner.model, partner.port, partner.program);
    let mut random = Random::new(2);
    let mut registers = Registers(vec![0; 8000]);
    let mut seeds = Vec::new();
    for n in 0..8 {
        let good = (partner.good)(&[], &mut random, &mut registers).frame;
        let frame = if n < 4 {
            good
        } else {
            (partner.wrong)(&[], &mut random)
        };
        let pieces = frame
            .chunks(32)
            .map(|part| [&[part.len() as u8 - 1], part].concat());
        seeds.push(pieces.collect::<Vec<_>>().concat());
    }
    Target {
        name: partner.name,
        run: Box::new(move |input| {
            // Long inputs would only be slow.
            let input = &input[..input.len().min(2000)];
            run(partner, &mut Plc::new(module, partner.port), input);
        }),
        seeds,
    }
}
