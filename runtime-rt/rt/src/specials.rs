//! The special devices that functions use without naming them in operands: flags of results and modes.

use crate::registry::{Needs, RtFn};
use crate::special::{
    D_RANDOM, M_BLOCK_COMPARE, M_BMOV_REVERSE, M_BORROW, M_BYTE_MODE, M_CARRY, M_MEAN_SUM,
    M_SMOV_HEX, M_TEXT_OPEN, M_ZERO, Register, Relay,
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
    /// The special devices that it uses, if these and its operands are all that it uses: it asks no hardware, finds no
    /// devices but those that operands name, and has no private memory, but for that in which PID keeps the last scan.
    pub fn specials(self) -> Option<Specials> {
        // ANR looks for annunciators S, ZPUSH and ZPOP keep the index registers.
        let others = matches!(self, RtFn::Anr | RtFn::Zpush | RtFn::Zpop | RtFn::LogError);
        let keeps_scan = matches!(
            self,
            RtFn::Pid | RtFn::PidTuning | RtFn::PidChecked | RtFn::PidHm
        );
        let at_most = Needs {
            state: keeps_scan,
            ..Needs::default()
        };
        if self.needs() != at_most || others {
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

    /// The operands that it writes, by number, if it is known to write no others; `None`: perhaps any of them.
    /// Terminals at which pulses are sent are not written.
    pub fn written_operands(self) -> Option<&'static [usize]> {
        match self {
            RtFn::Plsy | RtFn::Plsr | RtFn::Pwm | RtFn::StopPulses | RtFn::Zrn => Some(&[]),
            RtFn::Plsv => Some(&[2]),
            RtFn::Drvi | RtFn::Drva | RtFn::Dvit | RtFn::Dszr => Some(&[3]),
            RtFn::AxisPlsy | RtFn::AxisPlsr | RtFn::AxisDrvi | RtFn::AxisDrva | RtFn::AxisDvit => {
                Some(&[])
            }
            RtFn::AxisPlsv | RtFn::AxisPsout | RtFn::AxisJog | RtFn::AxisHome => Some(&[]),
            RtFn::To | RtFn::ToStated | RtFn::ToHost | RtFn::ToRemote | RtFn::Wbfm => Some(&[]),
            RtFn::From | RtFn::FromStated | RtFn::FromHost | RtFn::FromRemote | RtFn::Rbfm => {
                Some(&[2])
            }
            RtFn::Segl | RtFn::Pr | RtFn::PrSignalsOff => Some(&[1]),
            RtFn::Mtr | RtFn::Dsw | RtFn::Tky => Some(&[1, 2]),
            RtFn::Hky => Some(&[1, 2, 3]),
            RtFn::Pid | RtFn::PidTuning | RtFn::PidChecked | RtFn::PidHm => Some(&[2, 3]),
            RtFn::Smov => Some(&[3]),
            RtFn::BmovForward | RtFn::Fmov | RtFn::Mean => Some(&[1]),
            RtFn::Deco | RtFn::Enco | RtFn::EncoZero => Some(&[1]),
            RtFn::Absd | RtFn::Ramp | RtFn::Ser | RtFn::Tadd | RtFn::Tsub => Some(&[2]),
            RtFn::Twr | RtFn::TwrShort => Some(&[]),
            RtFn::Flt | RtFn::Int => Some(&[1]),
            RtFn::Eadd | RtFn::Esub | RtFn::Emul | RtFn::Ediv => Some(&[2]),
            RtFn::Sftr | RtFn::Sftl | RtFn::Wsfr | RtFn::Wsfl | RtFn::Sfwr | RtFn::SfwrHm => {
                Some(&[1])
            }
            _ => None,
        }
    }

    /// The relays that choose what it does.
    fn modes(self) -> &'static [Relay] {
        match self {
            RtFn::Smov => &[M_SMOV_HEX],
            RtFn::Bmov => &[M_BMOV_REVERSE],
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
            RtFn::Rcr | RtFn::Rcl | RtFn::Sfr | RtFn::Sfl => &[M_CARRY],
            RtFn::Sfwr | RtFn::SfwrHm | RtFn::SfrdHm => &[M_CARRY],
            RtFn::Eadd | RtFn::Esub | RtFn::Emul | RtFn::Ediv | RtFn::Eval | RtFn::Int => {
                &[M_ZERO, M_BORROW, M_CARRY]
            }
            RtFn::Esqr | RtFn::Sfrd | RtFn::Pop => &[M_ZERO],
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
