//! Extension modules of L01S (l01s-programming §9).

use super::super::Access::{Read, ReadWrite};
use super::super::Quantity::{Milliamperes, Volts};
use super::super::{AxisWord, Bfm, Duty, Kind, Place, Range, Role};
use super::{Access, COMMON, bfm, degrees, range};

/// A full reading.
const FULL: i32 = 32_000;

/// Input types 0 and 1 by voltage, and 16 later, by current at the other terminal.
const INPUTS: [Option<Range>; 18] = {
    let mut ranges = [None; 18];
    ranges[0] = range(Volts, [0, 10_000], FULL, [-FULL, FULL]);
    ranges[1] = range(Volts, [2000, 10_000], FULL, [0, FULL]);
    ranges[16] = range(Milliamperes, [0, 20_000], FULL, [0, FULL]);
    ranges[17] = range(Milliamperes, [4000, 20_000], FULL, [0, FULL]);
    ranges
};

/// Output types.
const OUTPUTS: [Option<Range>; 3] = [
    range(Volts, [0, 10_000], FULL, [0, FULL]),
    range(Milliamperes, [4000, 20_000], FULL, [0, FULL]),
    range(Milliamperes, [0, 20_000], FULL, [0, FULL]),
];

/// Thermocouples: K, E, T, S, J.
const THERMOCOUPLES: [Option<Range>; 12] = {
    let mut ranges = [None; 12];
    ranges[0] = degrees(-2400, 13_700);
    ranges[5] = degrees(-1100, 7300);
    ranges[7] = degrees(-2400, 4000);
    ranges[9] = degrees(-500, 16_900);
    ranges[11] = degrees(-1200, 12_000);
    ranges
};

const fn inputs(id: i16) -> [Bfm; 5] {
    [
        bfm(0, 1, Role::Identification, Read, id),
        bfm(1, 1, Role::Version, Read, 100),
        bfm(2, 4, Role::Present, Read, 0),
        bfm(19, 4, Role::InputTypes, ReadWrite, 0),
        bfm(41, 1, Role::Setting, ReadWrite, 0),
    ]
}

/// Common properties of all analog modules. The manual does not state the conversion time.
const ANALOG: Kind = Kind {
    source: "l01s-programming §9.3",
    place: Place::L01s,
    last: 41,
    conversion_us: 1000,
    ..COMMON
};

const fn axis(first: u16, count: u8, word: AxisWord, access: Access, default: i16) -> Bfm {
    bfm(first, count, Role::Axis(word), access, default)
}

/// A digital module. Its buffer memory is only its type.
const fn digital(name: &'static str, bfms: &'static [Bfm], points: [u8; 2]) -> Kind {
    Kind {
        name,
        source: "l01s-programming §9.1, §9.2",
        place: Place::L01s,
        points,
        last: 0,
        bfms,
        ..COMMON
    }
}

const fn id(id: i16) -> [Bfm; 1] {
    [bfm(0, 1, Role::Identification, Read, id)]
}

/// The kinds.
pub(super) const KINDS: [Kind; 11] = [
    Kind {
        name: "L02S-4AD",
        inputs: 4,
        input_ranges: &INPUTS,
        bfms: &inputs(1),
        ..ANALOG
    },
    Kind {
        name: "L02S-4DA",
        outputs: 4,
        output_ranges: &OUTPUTS,
        bfms: &[
            bfm(0, 1, Role::Identification, Read, 3),
            bfm(1, 1, Role::Version, Read, 100),
            bfm(2, 4, Role::Output, ReadWrite, 0),
            bfm(19, 4, Role::OutputTypes, ReadWrite, 0),
            bfm(41, 1, Role::Setting, ReadWrite, 0),
        ],
        ..ANALOG
    },
    Kind {
        name: "L02S-4AD2DA",
        inputs: 4,
        outputs: 2,
        input_ranges: &INPUTS,
        output_ranges: &OUTPUTS,
        bfms: &[
            bfm(0, 1, Role::Identification, Read, 6),
            bfm(1, 1, Role::Version, Read, 100),
            bfm(2, 4, Role::Present, Read, 0),
            bfm(6, 2, Role::Output, ReadWrite, 0),
            bfm(19, 4, Role::InputTypes, ReadWrite, 0),
            bfm(23, 2, Role::OutputTypes, ReadWrite, 0),
            bfm(41, 1, Role::Setting, ReadWrite, 0),
        ],
        ..ANALOG
    },
    Kind {
        name: "L02S-4RTD",
        aliases: &["L02S-4PT"],
        inputs: 4,
        input_ranges: &[degrees(-2000, 8000)],
        bfms: &inputs(7),
        ..ANALOG
    },
    Kind {
        name: "L02S-4TC",
        inputs: 4,
        input_ranges: &THERMOCOUPLES,
        bfms: &inputs(8),
        ..ANALOG
    },
    Kind {
        name: "L02S-4NTC",
        inputs: 4,
        input_ranges: &[degrees(-300, 2100)],
        bfms: &inputs(9),
        ..ANALOG
    },
    Kind {
        name: "L02S-4AXIS",
        source: "l01s-programming §9.4",
        place: Place::L01s,
        points: [8, 8],
        duty: Duty::Positioner,
        last: 51,
        bfms: &[
            bfm(0, 1, Role::Identification, Read, 50),
            bfm(1, 1, Role::Version, Read, 0x4514),
            axis(2, 4, AxisWord::Ramp, ReadWrite, 100),
            axis(6, 1, AxisWord::Control, ReadWrite, 0),
            axis(7, 1, AxisWord::Mode, ReadWrite, 0),
            axis(8, 16, AxisWord::Move, ReadWrite, 0),
            axis(24, 2, AxisWord::FastHoming, ReadWrite, 0),
            axis(26, 1, AxisWord::SlowHoming, ReadWrite, 0),
            axis(27, 1, AxisWord::Options, ReadWrite, 0),
            // Backlash.
            bfm(33, 4, Role::Setting, ReadWrite, 0),
            axis(37, 4, AxisWord::LowestSpeed, ReadWrite, 100),
            axis(41, 1, AxisWord::HomingMode, ReadWrite, 0),
            axis(42, 1, AxisWord::Busy, Read, 0),
            axis(43, 1, AxisWord::Done, Read, 0),
            axis(44, 8, AxisWord::Position, ReadWrite, 0),
        ],
        ..COMMON
    },
    digital("L02S-8ET", &id(4), [8, 8]),
    digital("L02S-16ET", &id(5), [16, 16]),
    digital("L02S-16EX", &id(12), [16, 0]),
    digital("L02S-16EYT", &id(15), [0, 16]),
];
