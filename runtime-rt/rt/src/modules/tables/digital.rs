//! Remote digital modules and analog boards of H1U and H2U.

use super::super::Access::{Read, ReadWrite, Retained};
use super::super::Quantity::{Milliamperes, Volts};
use super::super::{Bfm, Duty, Kind, Place, Range, Role};
use super::{COMMON, bfm, range};

/// A remote digital module.
const REMOTE: Kind = Kind {
    source: "h1u-h2u-programming §6.2",
    place: Place::Remote,
    last: 5,
    ..COMMON
};

/// The time after which the outputs go off when the bus is silent.
const SILENCE: Bfm = bfm(5, 1, Role::Silence, Retained, 500);

/// 0 to 10 V or 0 to 20 mA as 0 to 10000.
const VOLTS: Option<Range> = range(Volts, [0, 10_000], 10_000, [0, 10_000]);
const CURRENT: Option<Range> = range(Milliamperes, [0, 20_000], 10_000, [0, 10_000]);

/// A board: what it is sent (D8220 …), then its answer (D8230 …), inputs before outputs.
const fn exchanged(inputs: u8) -> [Bfm; 5] {
    [
        bfm(0, 1, Role::Command, ReadWrite, 0),
        bfm(1, 2, Role::Output, ReadWrite, 0),
        bfm(10, 1, Role::Answer, Read, 0),
        bfm(11, inputs, Role::Present, Read, 0),
        bfm(11 + inputs as u16, 2, Role::OutputShown, Read, 0),
    ]
}

/// An analog board.
const BOARD: Kind = Kind {
    source: "h1u-h2u-programming §6.7.1",
    place: Place::Slot,
    outputs: 2,
    output_ranges: &[VOLTS, CURRENT],
    last: 19,
    conversion_us: 1000,
    ..COMMON
};

/// The kinds.
pub(super) const KINDS: [Kind; 6] = [
    Kind {
        name: "H2U-1600ENDR",
        aliases: &["H2U-1600ENNR"],
        points: [16, 0],
        bfms: &[bfm(0, 1, Role::InputPoints, Read, 0)],
        ..REMOTE
    },
    Kind {
        name: "H2U-0016ERDR",
        aliases: &["H2U-0016ERNR", "H2U-0016ETDR"],
        points: [0, 16],
        bfms: &[bfm(0, 1, Role::OutputPoints, ReadWrite, 0), SILENCE],
        ..REMOTE
    },
    Kind {
        name: "H2U-0808ERDR",
        aliases: &["H2U-0808ERNR"],
        points: [8, 8],
        bfms: &[
            bfm(0, 1, Role::InputPoints, Read, 0),
            bfm(1, 1, Role::OutputPoints, ReadWrite, 0),
            SILENCE,
        ],
        ..REMOTE
    },
    Kind {
        name: "H2U-6A-BD",
        inputs: 4,
        input_ranges: &[VOLTS, VOLTS, CURRENT, CURRENT],
        bfms: &exchanged(4),
        duty: Duty::Board {
            answer: 0x6a42,
            most_filter: i16::MAX,
            has_both: false,
        },
        ..BOARD
    },
    Kind {
        name: "H2U-6B-BD",
        inputs: 4,
        input_ranges: &[CURRENT, CURRENT, CURRENT, CURRENT],
        bfms: &exchanged(4),
        duty: Duty::Board {
            answer: 0x6b42,
            most_filter: i16::MAX,
            has_both: false,
        },
        ..BOARD
    },
    Kind {
        name: "H1U-4A-BD",
        source: "h1u-h2u-programming §6.7.4",
        inputs: 2,
        input_ranges: &[VOLTS, CURRENT],
        output_ranges: &[VOLTS],
        bfms: &exchanged(2),
        duty: Duty::Board {
            answer: 0x4a22,
            most_filter: 256,
            has_both: true,
        },
        ..BOARD
    },
];
