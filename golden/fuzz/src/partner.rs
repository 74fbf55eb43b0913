//! Partners of a PLC on each kind of line: good frames, and complete ones with a wrong meaning.

mod masters;
mod slaves;

use crate::plc::Plc;
use crate::random::Random;
use crate::text::Bytes;
use rungc_models::ModelId;
use std::ops::Range;

/// A kind of line.
pub struct Partner {
    /// Its name, which is also that of its fuzz target.
    pub name: &'static str,
    /// The PLC.
    pub model: ModelId,
    /// Its port.
    pub port: u8,
    /// Its program.
    pub program: &'static str,
    /// The PLC asks: a frame of the partner answers the request that it is given.
    pub plc_asks: bool,
    /// A character has 7 bits.
    pub seven_bits: bool,
    /// Start of the last of several frames that the PLC has sent.
    pub last: fn(&[u8]) -> usize,
    /// A good frame, to the request of the PLC if it asks. What it writes is noted in the registers.
    pub good: fn(&[u8], &mut Random, &mut Registers) -> Good,
    /// A frame that is whole, but must write nothing.
    pub wrong: fn(&[u8], &mut Random) -> Bytes,
    /// A frame around a body; what a body is, the protocol says.
    pub seal: fn(&[u8]) -> Bytes,
    /// Registers that the PLC itself writes.
    pub own: Range<u32>,
}

/// A frame that a partner sends.
pub struct Good {
    /// The frame.
    pub frame: Bytes,
    /// Expected answer of the PLC; none if it is empty.
    pub answer: Bytes,
}

/// Expected contents of registers D.
pub struct Registers(pub Vec<u16>);

impl Registers {
    /// Those of a PLC as they are.
    pub fn of(plc: &Plc) -> Self {
        Registers((0..8000).map_while(|number| plc.d(number)).collect())
    }

    /// The PLC's registers are like these.
    ///
    /// # Panics
    /// They are not.
    pub fn check(&self, partner: &Partner, plc: &Plc) {
        for (number, (now, wanted)) in Registers::of(plc).0.iter().zip(&self.0).enumerate() {
            let own = partner.own.contains(&(number as u32));
            assert!(
                own || now == wanted,
                "{}: D{number} is {now}, not {wanted}",
                partner.name
            );
        }
    }

    /// Writes registers.
    fn set(&mut self, first: usize, words: &[u16]) {
        self.0[first..first + words.len()].copy_from_slice(words);
    }
}

/// Good frames of slaves read and write this number of registers, from D100 on.
const COUNT: usize = 50;

/// Writes one of the registers, or reads it; returns its number and value, and whether it is written.
fn register(random: &mut Random, registers: &mut Registers) -> (u16, u16, bool) {
    let number = 100 + random.below(COUNT);
    let write = random.below(2) == 0;
    if write {
        registers.set(number, &[random.word()]);
    }
    (number as u16, registers.0[number], write)
}

/// All kinds of lines.
pub fn all() -> impl Iterator<Item = &'static Partner> {
    slaves::SLAVES.iter().chain(masters::MASTERS)
}
