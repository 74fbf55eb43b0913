//! The table of modules.

use super::Access::{Read, ReadWrite, Retained};
use super::Quantity::{Celsius, Milliamperes, Volts};
use super::{Access, Bfm, Duty, Kind, Place, Quantity, Range, Role, Start};

mod adapters;
mod digital;
mod fx;
mod hm;
mod l01s;
mod thermostats;

const fn bfm(first: u16, count: u8, role: Role, access: Access, default: i16) -> Bfm {
    Bfm {
        first,
        count,
        stride: 1,
        role,
        access,
        default,
    }
}

/// Words at equal distances, one for each of four channels.
const fn every(stride: u16, first: u16, role: Role, access: Access) -> Bfm {
    Bfm {
        stride,
        ..bfm(first, 4, role, access, 0)
    }
}

const fn range(quantity: Quantity, curve: [i32; 2], span: i32, ends: [i32; 2]) -> Option<Range> {
    Some(Range {
        quantity,
        offset: curve[0],
        gain: curve[1],
        span,
        low: ends[0],
        high: ends[1],
    })
}

/// ±10 V: 5 V are 1000 times `by`.
const fn ten_volts(by: i32, ends: [i32; 2]) -> Option<Range> {
    range(Volts, [0, 5000], 1000 * by, [by * ends[0], by * ends[1]])
}

/// 4–20 mA: 20 mA are 1000 times `by`.
const fn from_4ma(by: i32, ends: [i32; 2]) -> Option<Range> {
    let curve = [4000, 20_000];
    range(Milliamperes, curve, 1000 * by, [by * ends[0], by * ends[1]])
}

/// 0–20 mA, or ±20 mA: 20 mA are 1000 times `by`.
const fn from_0ma(by: i32, ends: [i32; 2]) -> Option<Range> {
    let curve = [0, 20_000];
    range(Milliamperes, curve, 1000 * by, [by * ends[0], by * ends[1]])
}

/// Tenths of a degree.
const fn degrees(low: i32, high: i32) -> Option<Range> {
    range(Celsius, [0, 100_000], 1000, [low, high])
}

/// Limits of an input of twelve bits.
const INPUT: [i32; 2] = [-2048, 2047];

/// Limits of an input of twelve bits without a sign.
const UNSIGNED_INPUT: [i32; 2] = [0, 2047];

/// Limits of an output.
const OUTPUT: [i32; 2] = [-2350, 2350];

/// Limits of an output in its fine ranges.
const FINE_OUTPUT: [i32; 2] = [5 * OUTPUT[0], 5 * OUTPUT[1]];

/// Ranges of H2U-4AD, and of FX2N-4AD, which has the first four.
const INPUTS: [Option<Range>; 7] = [
    ten_volts(1, INPUT),
    from_4ma(1, INPUT),
    from_0ma(1, INPUT),
    None,
    ten_volts(5, INPUT),
    from_4ma(10, INPUT),
    from_0ma(10, INPUT),
];

/// Ranges of H2U-4AM, whose inputs measure nothing below 0.
const INPUTS_4AM: [Option<Range>; 7] = [
    ten_volts(1, UNSIGNED_INPUT),
    from_4ma(1, UNSIGNED_INPUT),
    from_0ma(1, UNSIGNED_INPUT),
    None,
    ten_volts(5, UNSIGNED_INPUT),
    from_4ma(10, UNSIGNED_INPUT),
    from_0ma(10, UNSIGNED_INPUT),
];

/// Ranges of H2U-6AM, which measures current only.
const INPUTS_6AM: [Option<Range>; 7] = {
    let [_, from4, from0, off, _, from4_fine, from0_fine] = INPUTS_4AM;
    [None, from4, from0, off, None, from4_fine, from0_fine]
};

/// Ranges of H2U-6CM, which measures voltage only.
const INPUTS_6CM: [Option<Range>; 5] = {
    let [volts, _, _, off, volts_fine, _, _] = INPUTS_4AM;
    [volts, None, None, off, volts_fine]
};

/// Ranges of outputs of H2U, and of FX2N-4DA, which has the first three.
const OUTPUTS: [Option<Range>; 7] = [
    ten_volts(1, OUTPUT),
    from_4ma(1, OUTPUT),
    from_0ma(1, OUTPUT),
    None,
    ten_volts(5, OUTPUT),
    range(Milliamperes, [4000, 20_000], 10_000, FINE_OUTPUT),
    range(Milliamperes, [0, 20_000], 10_000, FINE_OUTPUT),
];

/// Sensors of H2U-4PT: Pt100, Cu50.
const RESISTORS: [Option<Range>; 6] = [
    degrees(-1000, 6000),
    None,
    None,
    None,
    None,
    degrees(-500, 1500),
];

/// Thermocouples of H2U-4TC: K, J, E, B, N, R, S, T.
const THERMOCOUPLES: [Option<Range>; 8] = [
    degrees(-2000, 13_000),
    degrees(-1000, 8500),
    degrees(-1000, 8000),
    degrees(2000, 18_000),
    degrees(-1000, 12_000),
    degrees(-100, 17_000),
    degrees(-100, 17_000),
    degrees(-2000, 4000),
];

/// Buffer memory of H2U-4AD and FX2N-4AD.
const fn inputs(channels: u8, id: i16) -> [Bfm; 13] {
    [
        bfm(0, 1, Role::InputRanges, Retained, 0),
        bfm(1, channels, Role::Samples, ReadWrite, 8),
        bfm(5, channels, Role::Mean, Read, 0),
        bfm(9, channels, Role::Present, Read, 0),
        bfm(15, 1, Role::Rate, ReadWrite, 0),
        bfm(20, 1, Role::InputReset, Retained, 0),
        bfm(21, 1, Role::InputLock, Retained, 1),
        bfm(22, 1, Role::InputTakeOver, ReadWrite, 0),
        bfm(23, 1, Role::InputOffset, Retained, 0),
        bfm(24, 1, Role::InputGain, Retained, 5000),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(29, 1, Role::InputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
    ]
}

/// Buffer memory of H2U-4AM, H2U-6AM and H2U-6CM: inputs, then two outputs.
const fn mixed(channels: u8, ranges: i16, curve: [i16; 2], id: i16) -> [Bfm; 22] {
    [
        bfm(0, 1, Role::InputRanges, Retained, ranges),
        bfm(1, channels, Role::Samples, ReadWrite, 8),
        bfm(5, channels, Role::Mean, Read, 0),
        bfm(9, channels, Role::Present, Read, 0),
        bfm(15, 1, Role::Rate, ReadWrite, 0),
        bfm(20, 1, Role::InputReset, Retained, 0),
        bfm(21, 1, Role::InputLock, Retained, 1),
        bfm(22, 1, Role::InputTakeOver, ReadWrite, 0),
        bfm(23, 1, Role::InputOffset, ReadWrite, curve[0]),
        bfm(24, 1, Role::InputGain, ReadWrite, curve[1]),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(29, 1, Role::InputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
        bfm(32, 1, Role::OutputRanges, Retained, 0),
        bfm(33, 2, Role::Output, ReadWrite, 0),
        bfm(37, 1, Role::StopModes, Retained, 0),
        bfm(40, 1, Role::OutputTakeOver, ReadWrite, 0),
        bfm(42, 4, Role::OutputCurves, ReadWrite, 0),
        bfm(52, 1, Role::OutputReset, Retained, 0),
        bfm(53, 1, Role::OutputLock, Retained, 1),
        bfm(61, 1, Role::OutputError, Read, 0),
        // The last word of the output half.
        bfm(64, 1, Role::Setting, ReadWrite, 0),
    ]
}

/// Buffer memory of H2U-4DA and FX2N-4DA.
const fn outputs(channels: u8, id: i16) -> [Bfm; 10] {
    [
        bfm(0, 1, Role::OutputRanges, Retained, 0),
        bfm(1, channels, Role::Output, ReadWrite, 0),
        bfm(5, 1, Role::StopModes, Retained, 0),
        bfm(8, channels.div_ceil(2), Role::OutputTakeOver, ReadWrite, 0),
        bfm(10, 2 * channels, Role::OutputCurves, ReadWrite, 0),
        bfm(20, 1, Role::OutputReset, Retained, 0),
        bfm(21, 1, Role::OutputLock, Retained, 1),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(29, 1, Role::OutputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
    ]
}

/// Buffer memory of H2U-4PT and H2U-4TC, and of FX2N-4AD-PT and FX2N-4AD-TC.
const fn temperatures(id: i16) -> [Bfm; 10] {
    [
        bfm(0, 1, Role::InputRanges, ReadWrite, 0),
        bfm(1, 4, Role::Samples, ReadWrite, 8),
        bfm(5, 4, Role::Mean, Read, 0),
        bfm(9, 4, Role::Present, Read, 0),
        bfm(13, 4, Role::MeanFahrenheit, Read, 0),
        bfm(17, 4, Role::PresentFahrenheit, Read, 0),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(28, 1, Role::RangeLatch, ReadWrite, 0),
        bfm(29, 1, Role::InputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
    ]
}

/// Common properties of most kinds.
const COMMON: Kind = Kind {
    name: "",
    aliases: &[],
    source: "",
    inputs: 0,
    outputs: 0,
    input_ranges: &[],
    output_ranges: &[],
    points: [0, 0],
    place: Place::Bus,
    duty: Duty::None,
    last: 30,
    bfms: &[],
    conversion_us: 15_000,
    most_samples: 4096,
    usual_samples: 8,
    unlocked: 1,
    start: Start::Itself,
};

/// The modules that can be simulated.
pub static KINDS: [Kind; COUNT] = {
    let groups: [&[Kind]; 7] = [
        &H2U,
        &thermostats::KINDS,
        &digital::KINDS,
        &fx::KINDS,
        &hm::KINDS,
        &l01s::KINDS,
        &adapters::KINDS,
    ];
    let mut all = [COMMON; COUNT];
    let (mut group, mut at) = (0, 0);
    while group < groups.len() {
        let mut n = 0;
        while n < groups[group].len() {
            all[at] = groups[group][n];
            (n, at) = (n + 1, at + 1);
        }
        group += 1;
    }
    all
};

/// Number of kinds.
const COUNT: usize = H2U.len()
    + thermostats::KINDS.len()
    + digital::KINDS.len()
    + fx::KINDS.len()
    + hm::KINDS.len()
    + l01s::KINDS.len()
    + adapters::KINDS.len();

/// Analog and temperature modules of H2U.
const H2U: [Kind; 9] = [
    Kind {
        name: "H2U-4AD",
        aliases: &["H2U-4ADR"],
        source: "h1u-h2u-programming §6.3",
        inputs: 4,
        input_ranges: &INPUTS,
        bfms: &inputs(4, 2010),
        ..COMMON
    },
    Kind {
        name: "H2U-2AD",
        source: "h1u-h2u-programming §6.3",
        inputs: 2,
        input_ranges: &INPUTS,
        bfms: &inputs(2, 2011),
        ..COMMON
    },
    Kind {
        name: "H2U-4DA",
        aliases: &["H2U-4DAR"],
        source: "h1u-h2u-programming §6.4",
        outputs: 4,
        output_ranges: &OUTPUTS,
        bfms: &outputs(4, 3020),
        ..COMMON
    },
    Kind {
        name: "H2U-2DA",
        source: "h1u-h2u-programming §6.4",
        outputs: 2,
        output_ranges: &OUTPUTS,
        bfms: &outputs(2, 3021),
        ..COMMON
    },
    Kind {
        name: "H2U-4AM",
        source: "h1u-h2u-programming §6.5.1",
        inputs: 2,
        outputs: 2,
        input_ranges: &INPUTS_4AM,
        output_ranges: &OUTPUTS,
        last: 64,
        bfms: &mixed(2, 0, [0, 5000], 4051),
        ..COMMON
    },
    Kind {
        name: "H2U-6AM",
        source: "h1u-h2u-programming §6.5.2",
        inputs: 4,
        outputs: 2,
        input_ranges: &INPUTS_6AM,
        output_ranges: &OUTPUTS,
        last: 64,
        bfms: &mixed(4, 0x1111, [4000, 20_000], 4050),
        ..COMMON
    },
    Kind {
        name: "H2U-6CM",
        source: "h1u-h2u-programming §6.5.3",
        inputs: 4,
        outputs: 2,
        input_ranges: &INPUTS_6CM,
        output_ranges: &OUTPUTS,
        last: 64,
        // The manual prints the defaults of the current inputs here; a voltage input begins at 0 and 5 V.
        bfms: &mixed(4, 0, [0, 5000], 4052),
        ..COMMON
    },
    Kind {
        name: "H2U-4PT",
        aliases: &["H2U-4PTR"],
        source: "h1u-h2u-programming §6.6",
        inputs: 4,
        input_ranges: &RESISTORS,
        bfms: &temperatures(2040),
        most_samples: 256,
        ..COMMON
    },
    Kind {
        name: "H2U-4TC",
        aliases: &["H2U-4TCR"],
        source: "h1u-h2u-programming §6.6",
        inputs: 4,
        input_ranges: &THERMOCOUPLES,
        bfms: &temperatures(2030),
        conversion_us: 200_000,
        most_samples: 256,
        ..COMMON
    },
];
