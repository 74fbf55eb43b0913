//! The special devices that functions use without naming them in operands: flags of results and modes.

use crate::comm::can::M_LATE;
use crate::registry::{Needs, RtFn};
use crate::special::{
    D_ANALOG_INPUTS, D_ANALOG_OUTPUTS, D_INPUT_FILTER, D_RANDOM, M_BLOCK_COMPARE, M_BMOV_REVERSE,
    M_BORROW, M_BYTE_MODE, M_CARRY, M_COMPLETE, M_MEAN_SUM, M_SMOV_HEX, M_START_PULSE,
    M_STL_MONITOR, M_TEXT_OPEN, M_TRANSFER_OFF, M_TRANSFER_START, M_ZERO, Register, Relay,
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
        let needs = self.needs();
        let at_most = Needs {
            state: keeps_scan,
            sampled: needs.sampled,
            ..Needs::default()
        };
        if needs != at_most || others {
            return None;
        }
        Some(Specials {
            reads: self.modes(),
            writes: self.flags(),
            registers: self.registers(),
        })
    }

    /// Relays and registers that it may write in addition to its operands, the devices that belong to its pulse output
    /// ([`crate::Wiring::shown_relays`]) or its serial port, and those of operation errors; `None`: perhaps any.
    pub fn shown(self) -> Option<(&'static [Relay], &'static [Register])> {
        let needs = self.needs();
        let asks_hardware = needs.hal && self.transfer().is_none();
        let is_known = match self {
            RtFn::Ref | RtFn::RefHm | RtFn::Reff | RtFn::Vrrd | RtFn::Vrsc => true,
            RtFn::Potentiometers => true,
            RtFn::Oscilloscope | RtFn::LogError | RtFn::Zpush | RtFn::Zpop => false,
            _ => !(asks_hardware || needs.any_port || needs.can || needs.anywhere),
        };
        is_known.then(|| (self.flags(), self.registers()))
    }

    /// Registers that it reads and writes.
    fn registers(self) -> &'static [Register] {
        match self {
            RtFn::Rnd => const { &D_RANDOM.run::<2>() },
            RtFn::Reff => &[D_INPUT_FILTER],
            RtFn::Potentiometers => const { &D_ANALOG_INPUTS.run::<2>() },
            RtFn::FromHost => const { &D_ANALOG_INPUTS.run::<8>() },
            RtFn::ToHost => const { &D_ANALOG_OUTPUTS.run::<8>() },
            _ => &[],
        }
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
            RtFn::Incd | RtFn::Ramp | RtFn::Sort | RtFn::Mtr | RtFn::Hky | RtFn::Dsw => {
                &[M_COMPLETE]
            }
            RtFn::Segl | RtFn::Pr | RtFn::PrSignalsOff | RtFn::Abs | RtFn::Saver => &[M_COMPLETE],
            RtFn::Rbfm | RtFn::Wbfm => &[M_COMPLETE],
            RtFn::FromRemote | RtFn::ToRemote => &[M_LATE],
            RtFn::Ist => &[
                M_STL_MONITOR,
                M_TRANSFER_OFF,
                M_TRANSFER_START,
                M_START_PULSE,
            ],
            _ if self.needs().pulses => &[M_COMPLETE],
            _ if self.needs().port || self.needs().names_port => &[M_COMPLETE],
            _ => &[],
        }
    }
}

#[cfg(test)]
mod tests;
