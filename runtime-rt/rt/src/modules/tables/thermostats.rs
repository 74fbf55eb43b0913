//! Temperature modules of H2U that control what they measure (h1u-h2u-programming §6.6, items 11 to 14).

use super::super::Access::{Read, ReadWrite};
use super::super::{Bfm, Duty, Kind, Role, Term};
use super::{COMMON, RESISTORS, THERMOCOUPLES, every, temperatures};

/// A setting of control, of channels whose words are this far apart.
const fn set(stride: u16, first: u16, term: Term) -> Bfm {
    every(stride, first, Role::Thermostat(term), ReadWrite)
}

/// A word of control that the module writes.
const fn shown(stride: u16, first: u16, term: Term) -> Bfm {
    every(stride, first, Role::Thermostat(term), Read)
}

/// Rows after those of measuring.
const fn with<const N: usize, const ALL: usize>(id: i16, control: [Bfm; N]) -> [Bfm; ALL] {
    let measuring = temperatures(id);
    let mut all = [measuring[0]; ALL];
    let mut n = 0;
    while n < ALL {
        all[n] = if n < measuring.len() {
            measuring[n]
        } else {
            control[n - measuring.len()]
        };
        n += 1;
    }
    all
}

/// H2U-4PT-XP: the first word of each channel after BFM 100 is 100 further than that of the channel before.
const RESISTOR_CONTROL: [Bfm; 40] = [
    set(1, 51, Term::Start),
    set(1, 55, Term::Pause),
    shown(1, 71, Term::MainDigital),
    shown(1, 75, Term::MainRelay),
    shown(1, 81, Term::SecondDigital),
    shown(1, 85, Term::SecondRelay),
    set(1, 91, Term::Setpoint),
    set(100, 100, Term::Mode),
    set(100, 101, Term::Limits),
    set(100, 110, Term::Kp),
    set(100, 111, Term::Ti),
    set(100, 112, Term::Td),
    set(100, 113, Term::Ts),
    set(100, 114, Term::Filter),
    set(100, 116, Term::TuneOutput),
    shown(100, 117, Term::Target),
    set(100, 118, Term::PauseOutput),
    set(100, 121, Term::MainCycle),
    set(100, 122, Term::SecondCycle),
    set(100, 124, Term::MainHysteresis),
    set(100, 125, Term::SecondHysteresis),
    set(100, 126, Term::SecondGain),
    set(100, 130, Term::RampUnit),
    set(100, 131, Term::RampStep),
    set(100, 140, Term::UpperInput),
    set(100, 141, Term::LowerInput),
    set(100, 142, Term::Deviation),
    set(100, 143, Term::UpperMain),
    set(100, 144, Term::LowerMain),
    set(100, 145, Term::UpperSecond),
    set(100, 146, Term::LowerSecond),
    set(100, 148, Term::UpperSetpoint),
    set(100, 149, Term::LowerSetpoint),
    set(100, 150, Term::UpperInputChange),
    set(100, 152, Term::LowerInputChange),
    set(100, 153, Term::UpperOutputChange),
    set(100, 154, Term::LowerOutputChange),
    shown(100, 156, Term::State),
    shown(100, 157, Term::Alarm),
    shown(100, 158, Term::Warnings),
];

/// H2U-4TC-XP.
const THERMOCOUPLE_CONTROL: [Bfm; 14] = [
    set(1, 32, Term::Setpoint),
    set(3, 36, Term::Kp),
    set(3, 37, Term::Ti),
    set(3, 38, Term::Td),
    set(1, 51, Term::Start),
    set(1, 55, Term::Mode),
    every(1, 59, Role::Setting, ReadWrite),
    set(1, 63, Term::DeadTime),
    set(1, 67, Term::Ts),
    shown(1, 71, Term::MainDigital),
    shown(1, 75, Term::MainOutput),
    shown(1, 81, Term::SecondDigital),
    shown(1, 85, Term::SecondOutput),
    // Printed as read-only, but a setting.
    set(1, 95, Term::StopDifference),
];

const RESISTOR_WORDS: [Bfm; 10 + RESISTOR_CONTROL.len()] = with(2040, RESISTOR_CONTROL);
const THERMOCOUPLE_WORDS: [Bfm; 10 + THERMOCOUPLE_CONTROL.len()] = with(2030, THERMOCOUPLE_CONTROL);

/// The kinds.
pub(super) const KINDS: [Kind; 2] = [
    Kind {
        name: "H2U-4PT-XP",
        aliases: &["H2U-4PTR-XP"],
        source: "h1u-h2u-programming §6.6",
        inputs: 4,
        input_ranges: &RESISTORS,
        last: 499,
        bfms: &RESISTOR_WORDS,
        most_samples: 256,
        duty: Duty::Thermostat {
            relay: 100,
            digital: i16::MAX,
        },
        ..COMMON
    },
    Kind {
        name: "H2U-4TC-XP",
        aliases: &["H2U-4TCR-XP"],
        source: "h1u-h2u-programming §6.6",
        inputs: 4,
        input_ranges: &THERMOCOUPLES,
        last: 98,
        bfms: &THERMOCOUPLE_WORDS,
        conversion_us: 200_000,
        most_samples: 256,
        duty: Duty::Thermostat {
            relay: 10_000,
            digital: 10_000,
        },
        ..COMMON
    },
];
