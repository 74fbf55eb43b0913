//! The table of modules.

use super::Access::{Kept, Read, ReadWrite};
use super::Quantity::{Celsius, Milliamperes, Volts};
use super::{Access, Bfm, Kind, Quantity, Range, Role, Start};

const fn bfm(first: u16, count: u8, role: Role, access: Access, default: i16) -> Bfm {
    Bfm {
        first,
        count,
        role,
        access,
        default,
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

/// What an input of twelve bits can hold.
const INPUT: [i32; 2] = [-2048, 2047];

/// What an input of twelve bits without a sign can hold.
const UNSIGNED_INPUT: [i32; 2] = [0, 2047];

/// What an output takes.
const OUTPUT: [i32; 2] = [-2350, 2350];

/// What an output takes in its fine ranges.
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
        bfm(0, 1, Role::InputRanges, Kept, 0),
        bfm(1, channels, Role::Samples, ReadWrite, 8),
        bfm(5, channels, Role::Mean, Read, 0),
        bfm(9, channels, Role::Present, Read, 0),
        bfm(15, 1, Role::Rate, ReadWrite, 0),
        bfm(20, 1, Role::InputReset, Kept, 0),
        bfm(21, 1, Role::InputLock, Kept, 1),
        bfm(22, 1, Role::InputTakeOver, ReadWrite, 0),
        bfm(23, 1, Role::InputOffset, Kept, 0),
        bfm(24, 1, Role::InputGain, Kept, 5000),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(29, 1, Role::InputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
    ]
}

/// Buffer memory of H2U-4AM, H2U-6AM and H2U-6CM: inputs, then two outputs.
const fn mixed(channels: u8, ranges: i16, curve: [i16; 2], id: i16) -> [Bfm; 22] {
    [
        bfm(0, 1, Role::InputRanges, Kept, ranges),
        bfm(1, channels, Role::Samples, ReadWrite, 8),
        bfm(5, channels, Role::Mean, Read, 0),
        bfm(9, channels, Role::Present, Read, 0),
        bfm(15, 1, Role::Rate, ReadWrite, 0),
        bfm(20, 1, Role::InputReset, Kept, 0),
        bfm(21, 1, Role::InputLock, Kept, 1),
        bfm(22, 1, Role::InputTakeOver, ReadWrite, 0),
        bfm(23, 1, Role::InputOffset, ReadWrite, curve[0]),
        bfm(24, 1, Role::InputGain, ReadWrite, curve[1]),
        bfm(27, 1, Role::Version, Read, 100),
        bfm(29, 1, Role::InputError, Read, 0),
        bfm(30, 1, Role::Identification, Read, id),
        bfm(32, 1, Role::OutputRanges, Kept, 0),
        bfm(33, 2, Role::Output, ReadWrite, 0),
        bfm(37, 1, Role::StopModes, Kept, 0),
        bfm(40, 1, Role::OutputTakeOver, ReadWrite, 0),
        bfm(42, 4, Role::OutputCurves, ReadWrite, 0),
        bfm(52, 1, Role::OutputReset, Kept, 0),
        bfm(53, 1, Role::OutputLock, Kept, 1),
        bfm(61, 1, Role::OutputError, Read, 0),
        // The last word of the output half.
        bfm(64, 1, Role::Setting, ReadWrite, 0),
    ]
}

/// Buffer memory of H2U-4DA and FX2N-4DA.
const fn outputs(channels: u8, id: i16) -> [Bfm; 10] {
    [
        bfm(0, 1, Role::OutputRanges, Kept, 0),
        bfm(1, channels, Role::Output, ReadWrite, 0),
        bfm(5, 1, Role::StopModes, Kept, 0),
        bfm(8, channels.div_ceil(2), Role::OutputTakeOver, ReadWrite, 0),
        bfm(10, 2 * channels, Role::OutputCurves, ReadWrite, 0),
        bfm(20, 1, Role::OutputReset, Kept, 0),
        bfm(21, 1, Role::OutputLock, Kept, 1),
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

/// What most kinds have in common.
const COMMON: Kind = Kind {
    name: "",
    aliases: &[],
    source: "",
    inputs: 0,
    outputs: 0,
    input_ranges: &[],
    output_ranges: &[],
    last: 30,
    bfms: &[],
    conversion_us: 15_000,
    most_samples: 4096,
    usual_samples: 8,
    unlocked: 1,
    start: Start::Itself,
};

/// Ranges of FX3U-4AD.
const INPUTS_3U: [Option<Range>; 9] = {
    const fn volts(span: i32, end: i32) -> Option<Range> {
        range(Volts, [0, 5000], span, [-end, end])
    }
    const fn current(offset: i32, span: i32, ends: [i32; 2]) -> Option<Range> {
        range(Milliamperes, [offset, 20_000], span, ends)
    }
    [
        volts(16_000, 32_640),
        volts(2000, 4080),
        volts(5000, 10_200),
        current(4000, 16_000, [0, 16_400]),
        current(4000, 4000, [0, 4100]),
        current(0, 20_000, [3600, 20_400]),
        current(0, 16_000, [-16_320, 16_320]),
        current(0, 4000, [-4080, 4080]),
        current(0, 20_000, [-20_400, 20_400]),
    ]
};

/// Ranges of FX3U-4DA.
const OUTPUTS_3U: [Option<Range>; 5] = [
    range(Volts, [0, 5000], 16_000, [-32_640, 32_640]),
    range(Volts, [0, 5000], 5000, [-10_200, 10_200]),
    range(Milliamperes, [0, 20_000], 32_000, [0, 32_640]),
    range(Milliamperes, [4000, 20_000], 32_000, [0, 32_640]),
    range(Milliamperes, [0, 20_000], 20_000, [0, 20_400]),
];

/// The modules that can be simulated.
pub static KINDS: [Kind; 18] = [
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
    Kind {
        name: "FX2N-4AD",
        aliases: &["FX-4AD", "FX2NC-4AD"],
        source: "FX2N-4AD user's guide",
        inputs: 4,
        input_ranges: &FX2N_INPUTS,
        bfms: &inputs(4, 2010),
        ..COMMON
    },
    Kind {
        name: "FX2N-4DA",
        aliases: &["FX-4DA", "FX2NC-4DA"],
        source: "FX2N-4DA user's guide",
        outputs: 4,
        output_ranges: &FX2N_OUTPUTS,
        bfms: &outputs(4, 3020),
        ..COMMON
    },
    Kind {
        name: "FX2N-4AD-PT",
        source: "FX2N-4AD-PT user's guide",
        inputs: 4,
        input_ranges: &[degrees(-1000, 6000)],
        bfms: &temperatures(2040),
        ..COMMON
    },
    Kind {
        name: "FX2N-4AD-TC",
        source: "FX2N-4AD-TC user's guide",
        inputs: 4,
        input_ranges: &[degrees(-1000, 12_000), degrees(-1000, 6000)],
        bfms: &temperatures(2030),
        conversion_us: 240_000,
        most_samples: 256,
        ..COMMON
    },
    Kind {
        name: "FX2N-2AD",
        source: "FX2N-2AD user's guide",
        inputs: 2,
        input_ranges: &[
            range(Volts, [0, 10_000], 4000, [0, 4095]),
            range(Milliamperes, [4000, 20_000], 4000, [0, 4095]),
        ],
        last: 31,
        bfms: &[
            bfm(0, 1, Role::LowByte, Read, 0),
            bfm(1, 1, Role::HighBits, Read, 0),
            bfm(17, 1, Role::Control, ReadWrite, 0),
        ],
        start: Start::Fx2n2ad,
        ..COMMON
    },
    Kind {
        name: "FX2N-2DA",
        source: "FX2N-2DA user's guide",
        outputs: 2,
        output_ranges: &[
            range(Volts, [0, 10_000], 4000, [0, 4095]),
            range(Milliamperes, [4000, 20_000], 4000, [0, 4095]),
        ],
        last: 31,
        bfms: &[
            bfm(16, 1, Role::Data, ReadWrite, 0),
            bfm(17, 1, Role::Control, ReadWrite, 0),
        ],
        start: Start::Fx2n2da,
        ..COMMON
    },
    Kind {
        name: "FX0N-3A",
        source: "FX0N-3A user's guide",
        inputs: 2,
        outputs: 1,
        input_ranges: &[
            range(Volts, [0, 10_000], 250, [0, 255]),
            range(Milliamperes, [4000, 20_000], 250, [0, 255]),
        ],
        output_ranges: &[
            range(Volts, [0, 10_000], 250, [0, 255]),
            range(Milliamperes, [4000, 20_000], 250, [0, 255]),
        ],
        last: 31,
        bfms: &[
            bfm(0, 1, Role::LowByte, Read, 0),
            bfm(16, 1, Role::Data, ReadWrite, 0),
            bfm(17, 1, Role::Control, ReadWrite, 0),
        ],
        start: Start::Fx0n3a,
        ..COMMON
    },
    Kind {
        name: "FX3U-4AD",
        aliases: &["FX3UC-4AD"],
        source: "FX3S/FX3G/FX3U analog control edition, FX3U-4AD",
        inputs: 4,
        input_ranges: &INPUTS_3U,
        last: 6999,
        bfms: &[
            bfm(0, 1, Role::InputRanges, Kept, 0),
            bfm(2, 4, Role::Samples, Kept, 1),
            bfm(6, 4, Role::Setting, Kept, 0),
            bfm(10, 4, Role::Mean, Read, 0),
            bfm(19, 1, Role::InputLock, Kept, 2080),
            bfm(20, 1, Role::InputReset, ReadWrite, 0),
            bfm(21, 1, Role::InputTakeOverBoth, ReadWrite, 0),
            bfm(22, 1, Role::Setting, Kept, 0),
            bfm(28, 1, Role::RangeLatch, ReadWrite, 0),
            bfm(29, 1, Role::InputError, Read, 0),
            bfm(30, 1, Role::Identification, Read, 2080),
            bfm(41, 4, Role::InputOffsets, Kept, 0),
            bfm(51, 4, Role::InputGains, Kept, 5000),
            bfm(61, 4, Role::Addition, Kept, 0),
            bfm(101, 4, Role::LeastPeak, Read, 0),
            bfm(109, 1, Role::PeakReset, ReadWrite, 0),
            bfm(111, 4, Role::GreatestPeak, Read, 0),
            bfm(119, 1, Role::PeakReset, ReadWrite, 0),
        ],
        conversion_us: 500,
        most_samples: 4095,
        usual_samples: 1,
        unlocked: 2080,
        ..COMMON
    },
    Kind {
        name: "FX3U-4DA",
        source: "FX3S/FX3G/FX3U analog control edition, FX3U-4DA",
        outputs: 4,
        output_ranges: &OUTPUTS_3U,
        last: 3098,
        bfms: &[
            bfm(0, 1, Role::OutputRanges, Kept, 0),
            bfm(1, 4, Role::Output, ReadWrite, 0),
            bfm(5, 1, Role::StopModes, Kept, 0),
            bfm(9, 1, Role::OutputTakeOverBoth, ReadWrite, 0),
            bfm(10, 4, Role::OutputOffsets, Kept, 0),
            bfm(14, 4, Role::OutputGains, Kept, 5000),
            bfm(19, 1, Role::OutputLock, Kept, 3030),
            bfm(20, 1, Role::OutputReset, ReadWrite, 0),
            bfm(29, 1, Role::OutputError, Read, 0),
            bfm(30, 1, Role::Identification, Read, 3030),
        ],
        unlocked: 3030,
        ..COMMON
    },
];

/// The ranges of FX2N-4AD.
const FX2N_INPUTS: [Option<Range>; 4] = {
    let [volts, from4, from0, off, ..] = INPUTS;
    [volts, from4, from0, off]
};

/// The ranges of FX2N-4DA.
const FX2N_OUTPUTS: [Option<Range>; 3] = {
    let [volts, from4, from0, ..] = OUTPUTS;
    [volts, from4, from0]
};
