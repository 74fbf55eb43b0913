//! Analog adapters on the left of FX3's main units, and analog boards of FX1 and FX3. The program reaches them through
//! ten special relays and ten special registers each, which follow each other from a first number on.
//!
//! Terminals, quantities and sensors are those of the user's manual of FX3G, FX3U and FX3UC, analog control edition
//! (JY997D16701: page C-14 for FX3U-4AD-ADP, L-14 for FX3U-4AD-TC-ADP). No public page shows its tables of special
//! devices; the layout here is from memory, which the book lists among its questions for a real device.

use super::super::Access::{Read, ReadWrite};
use super::super::Quantity::{Milliamperes, Volts};
use super::super::{Bfm, EXCHANGE, Kind, Place, REGISTERS, Range, Role, Start};
use super::{COMMON, bfm, degrees, range};

/// Source of the kinds.
const SOURCE: &str = "FX3S/FX3G/FX3U analog control edition (JY997D16701)";

/// 0 to 10 V are 0 to 4000.
const VOLTS: Option<Range> = range(Volts, [0, 10_000], 4000, [0, 4080]);

/// 4 to 20 mA are 0 to this number.
const fn from_4ma(full: i32) -> Option<Range> {
    let most = full + full / 40;
    range(Milliamperes, [4000, 20_000], full, [0, most])
}

/// Outputs, which take no value beyond their range.
const fn outputs(full: i32) -> [Option<Range>; 2] {
    [
        range(Volts, [0, 10_000], 4000, [0, 4000]),
        range(Milliamperes, [4000, 20_000], full, [0, full]),
    ]
}

const fn relays(first: u16, count: u8, role: Role) -> Bfm {
    bfm(first, count, role, ReadWrite, 0)
}

/// Registers, from the module's first.
const fn shown(first: u16, count: u8, role: Role, default: i16) -> Bfm {
    bfm(REGISTERS + first, count, role, Read, default)
}

const fn set(first: u16, count: u8, role: Role, default: i16) -> Bfm {
    bfm(REGISTERS + first, count, role, ReadWrite, default)
}

/// The word that starts a conversion.
const START: Bfm = bfm(EXCHANGE, 1, Role::Exchange, ReadWrite, 0);

/// Measured values, samples per mean, errors and type of an adapter with inputs.
const fn inputs(channels: u8, code: i16) -> [Bfm; 5] {
    [
        shown(0, channels, Role::Mean, 0),
        set(4, channels, Role::Samples, 1),
        shown(8, 1, Role::AdapterError, 0),
        shown(9, 1, Role::Identification, code),
        START,
    ]
}

/// Those of an adapter for sensors of one type.
const fn sensors(code: i16) -> [Bfm; 6] {
    let [mean, samples, error, id, start] = inputs(4, code);
    let unit = relays(0, 1, Role::Fahrenheit);
    [unit, mean, samples, error, id, start]
}

/// Those of an adapter for sensors of two types.
const fn two_sensors(code: i16) -> [Bfm; 7] {
    let [unit, mean, samples, error, id, start] = sensors(code);
    let chosen = relays(1, 1, Role::SensorType);
    [unit, chosen, mean, samples, error, id, start]
}

/// Those of an adapter or board that measures voltage or current.
const fn signals(channels: u8, code: i16) -> [Bfm; 6] {
    let [mean, samples, error, id, start] = inputs(channels, code);
    let types = relays(0, channels, Role::InputTypes);
    [types, mean, samples, error, id, start]
}

/// Those of an adapter or board with outputs.
const fn driven(channels: u8, code: i16) -> [Bfm; 5] {
    [
        relays(0, channels, Role::OutputTypes),
        relays(4, channels, Role::StopMode),
        set(0, channels, Role::Output, 0),
        shown(8, 1, Role::AdapterError, 0),
        shown(9, 1, Role::Identification, code),
    ]
}

/// Common properties of adapters. A conversion takes 200 µs, and the PLC starts one in each scan.
const ADAPTER: Kind = Kind {
    source: SOURCE,
    place: Place::Adapter,
    last: EXCHANGE,
    conversion_us: 200,
    most_samples: 4095,
    usual_samples: 1,
    start: Start::Exchange,
    ..COMMON
};

const BOARD_3G: Kind = Kind {
    place: Place::Board3g,
    ..ADAPTER
};

/// FX1's boards convert single values, and report neither errors nor what they are.
const BOARD_1N: Kind = Kind {
    source: "user's manuals of FX1N-2AD-BD and FX1N-1DA-BD",
    place: Place::Board1n,
    ..ADAPTER
};

const fn temperatures(
    name: &'static str,
    input_ranges: &'static [Option<Range>],
    bfms: &'static [Bfm],
) -> Kind {
    Kind {
        name,
        inputs: 4,
        input_ranges,
        bfms,
        ..ADAPTER
    }
}

/// The kinds.
pub(super) const KINDS: [Kind; 11] = [
    Kind {
        name: "FX3U-4AD-ADP",
        inputs: 4,
        input_ranges: &[VOLTS, from_4ma(1600)],
        bfms: &signals(4, 1),
        ..ADAPTER
    },
    Kind {
        name: "FX3U-4DA-ADP",
        outputs: 4,
        output_ranges: &outputs(4000),
        bfms: &driven(4, 2),
        ..ADAPTER
    },
    Kind {
        name: "FX3U-3A-ADP",
        inputs: 2,
        outputs: 1,
        input_ranges: &[VOLTS, from_4ma(3200)],
        output_ranges: &outputs(4000),
        bfms: &[
            relays(0, 2, Role::InputTypes),
            relays(2, 1, Role::OutputTypes),
            relays(6, 1, Role::StopMode),
            relays(7, 3, Role::Unused),
            shown(0, 2, Role::Mean, 0),
            set(2, 1, Role::Output, 0),
            set(4, 2, Role::Samples, 1),
            shown(8, 1, Role::AdapterError, 0),
            shown(9, 1, Role::Identification, 50),
            START,
        ],
        ..ADAPTER
    },
    temperatures("FX3U-4AD-PT-ADP", &[degrees(-500, 2500)], &sensors(20)),
    temperatures("FX3U-4AD-PTW-ADP", &[degrees(-1000, 6000)], &sensors(21)),
    // Pt1000, Ni1000.
    temperatures(
        "FX3U-4AD-PNK-ADP",
        &[degrees(-500, 2500), degrees(-400, 1100)],
        &two_sensors(11),
    ),
    // Thermocouples K, J.
    temperatures(
        "FX3U-4AD-TC-ADP",
        &[degrees(-1000, 10_000), degrees(-1000, 6000)],
        &two_sensors(10),
    ),
    Kind {
        name: "FX3G-2AD-BD",
        inputs: 2,
        input_ranges: &[VOLTS, from_4ma(2000)],
        bfms: &signals(2, 3),
        ..BOARD_3G
    },
    Kind {
        name: "FX3G-1DA-BD",
        outputs: 1,
        output_ranges: &outputs(2000),
        bfms: &driven(1, 4),
        ..BOARD_3G
    },
    Kind {
        name: "FX1N-2AD-BD",
        inputs: 2,
        input_ranges: &[VOLTS, from_4ma(2000)],
        bfms: &[
            relays(0, 2, Role::InputTypes),
            shown(0, 2, Role::Mean, 0),
            START,
        ],
        ..BOARD_1N
    },
    Kind {
        name: "FX1N-1DA-BD",
        outputs: 1,
        output_ranges: &outputs(2000),
        bfms: &[relays(2, 1, Role::OutputTypes), set(2, 1, Role::Output, 0)],
        ..BOARD_1N
    },
];
