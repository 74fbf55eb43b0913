//! Extension modules of HM (hm-motion-controller §7). The program reaches them through registers from D7200 on, in the
//! order of these words: input values, input types, output types, output values.

use super::super::Access::{Read, ReadWrite};
use super::super::Quantity::{Milliamperes, Volts};
use super::super::{Bfm, Kind, Place, Range, Role};
use super::{COMMON, bfm, degrees, range};

/// Ranges of inputs: 5 volts, 6 current.
const INPUTS: [Option<Range>; 7] = signals(20_000);

/// Ranges of outputs.
const OUTPUTS: [Option<Range>; 7] = signals(4000);

const fn signals(full: i32) -> [Option<Range>; 7] {
    let mut ranges = [None; 7];
    ranges[5] = range(Volts, [0, 10_000], full, [0, full]);
    ranges[6] = range(Milliamperes, [0, 20_000], full, [0, full]);
    ranges
}

/// Common properties of all. A conversion takes 80 ms.
const EXTENSION: Kind = Kind {
    source: "hm-motion-controller §7.2",
    place: Place::Hm,
    last: 15,
    conversion_us: 80_000,
    ..COMMON
};

const fn digital(name: &'static str, aliases: &'static [&'static str], points: [u8; 2]) -> Kind {
    Kind {
        name,
        aliases,
        source: "hm-motion-controller §7.3",
        points,
        ..EXTENSION
    }
}

const INPUT_VALUES: Bfm = bfm(0, 4, Role::Present, Read, 0);
const INPUT_TYPES: Bfm = bfm(4, 4, Role::InputTypes, ReadWrite, 0);

/// The kinds.
pub(super) const KINDS: [Kind; 10] = [
    Kind {
        name: "EX1-4AD",
        inputs: 4,
        input_ranges: &INPUTS,
        bfms: &[INPUT_VALUES, INPUT_TYPES],
        ..EXTENSION
    },
    Kind {
        name: "EX1-4PT",
        inputs: 4,
        input_ranges: &[degrees(-300, 5000)],
        bfms: &[INPUT_VALUES],
        ..EXTENSION
    },
    Kind {
        name: "EX1-4TC",
        inputs: 4,
        input_ranges: &[
            degrees(0, 13_500),
            degrees(0, 6000),
            degrees(0, 16_000),
            degrees(600, 18_000),
        ],
        bfms: &[INPUT_VALUES, INPUT_TYPES],
        conversion_us: 100_000,
        ..EXTENSION
    },
    Kind {
        name: "EX1-2AD/2DA",
        aliases: &["EX1-2AD2DA"],
        inputs: 2,
        outputs: 2,
        input_ranges: &INPUTS,
        output_ranges: &OUTPUTS,
        bfms: &[
            bfm(0, 2, Role::Present, Read, 0),
            bfm(2, 2, Role::InputTypes, ReadWrite, 0),
            bfm(4, 2, Role::OutputTypes, ReadWrite, 0),
            bfm(6, 2, Role::Output, ReadWrite, 0),
        ],
        ..EXTENSION
    },
    Kind {
        name: "EX1-4DA",
        outputs: 4,
        output_ranges: &OUTPUTS,
        bfms: &[
            bfm(0, 4, Role::OutputTypes, ReadWrite, 0),
            bfm(4, 4, Role::Output, ReadWrite, 0),
        ],
        ..EXTENSION
    },
    digital("EX1-08M", &[], [8, 0]),
    digital("EX1-08R", &["EX1-08T"], [0, 8]),
    digital("EX1-16M", &[], [16, 0]),
    digital("EX1-16R", &["EX1-16T"], [0, 16]),
    digital("EX1-16M16R", &["EX1-16M16T"], [16, 16]),
];
