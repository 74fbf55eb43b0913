//! The special devices that functions use without naming them in operands: flags of results and modes.

use crate::registry::{Needs, RtFn};
use crate::special::{
    D_RANDOM, M_BLOCK_COMPARE, M_BMOV_REVERSE, M_BORROW, M_BYTE_MODE, M_CARRY, M_MEAN_SUM,
    M_SMOV_HEX, M_TEXT_OPEN, M_XCH_BYTES, M_ZERO, Register, Relay,
};

/// Special devices that a function uses beside its operands. What an operation error writes is not among them.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Specials {
    /// Relays that it reads.
    pub reads: &'static [Relay],
    /// Relays that it writes.
    pub writes: &'static [Relay],
    /// Registers that it reads and writes.
    pub registers: &'static [Register],
}

impl RtFn {
    /// The special devices that it uses, if these and its operands are all that it uses: it has no private memory, asks
    /// no hardware, and finds no devices but those that operands name.
    pub fn specials(self) -> Option<Specials> {
        // ANR looks for annunciators S, ZPUSH and ZPOP keep the index registers.
        let others = matches!(self, RtFn::Anr | RtFn::Zpush | RtFn::Zpop | RtFn::LogError);
        if self.needs() != Needs::default() || others {
            return None;
        }
        Some(Specials {
            reads: self.modes(),
            writes: self.flags(),
            registers: match self {
                RtFn::Rnd => const { &D_RANDOM.run::<2>() },
                _ => &[],
            },
        })
    }

    /// The relays that choose what it does.
    fn modes(self) -> &'static [Relay] {
        match self {
            RtFn::Smov => &[M_SMOV_HEX],
            RtFn::Bmov => &[M_BMOV_REVERSE],
            RtFn::Xch => &[M_XCH_BYTES],
            RtFn::Rcr | RtFn::Rcl => &[M_CARRY],
            RtFn::MeanSum => &[M_MEAN_SUM],
            RtFn::Asci | RtFn::Hex | RtFn::Ccd | RtFn::Crc | RtFn::Asc => &[M_BYTE_MODE],
            RtFn::Binda => &[M_TEXT_OPEN],
            _ => &[],
        }
    }

    /// The relays that say something of its result.
    fn flags(self) -> &'static [Relay] {
        match self {
            RtFn::Ror | RtFn::Rol | RtFn::Rcr | RtFn::Rcl | RtFn::Sfr | RtFn::Sfl => &[M_CARRY],
            RtFn::Sfwr | RtFn::SfwrHm | RtFn::SfrdHm => &[M_CARRY],
            RtFn::Sqr | RtFn::SqrClamped => &[M_ZERO, M_BORROW],
            RtFn::Eadd | RtFn::Esub | RtFn::Emul | RtFn::Ediv | RtFn::Eval | RtFn::Int => {
                &[M_ZERO, M_BORROW, M_CARRY]
            }
            RtFn::Esqr | RtFn::Sum | RtFn::Sfrd | RtFn::Pop => &[M_ZERO],
            RtFn::Tadd => &[M_ZERO, M_CARRY],
            RtFn::Tsub => &[M_ZERO, M_BORROW],
            RtFn::BkcmpEq
            | RtFn::BkcmpGt
            | RtFn::BkcmpLt
            | RtFn::BkcmpNe
            | RtFn::BkcmpLe
            | RtFn::BkcmpGe => &[M_BLOCK_COMPARE],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests;
