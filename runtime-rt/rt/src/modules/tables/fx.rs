//! Modules of FX.

use super::super::Access::{Read, ReadWrite, Retained};
use super::super::Quantity::{Milliamperes, Volts};
use super::super::{Kind, Range, Role, Start};
use super::{COMMON, INPUTS, OUTPUTS, bfm, degrees, inputs, outputs, range, temperatures};

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

/// The kinds.
pub(super) const KINDS: [Kind; 9] = [
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
            bfm(0, 1, Role::InputRanges, Retained, 0),
            bfm(2, 4, Role::Samples, Retained, 1),
            bfm(6, 4, Role::Setting, Retained, 0),
            bfm(10, 4, Role::Mean, Read, 0),
            bfm(19, 1, Role::InputLock, Retained, 2080),
            bfm(20, 1, Role::InputReset, ReadWrite, 0),
            bfm(21, 1, Role::InputTakeOverBoth, ReadWrite, 0),
            bfm(22, 1, Role::Setting, Retained, 0),
            bfm(28, 1, Role::RangeLatch, ReadWrite, 0),
            bfm(29, 1, Role::InputError, Read, 0),
            bfm(30, 1, Role::Identification, Read, 2080),
            bfm(41, 4, Role::InputOffsets, Retained, 0),
            bfm(51, 4, Role::InputGains, Retained, 5000),
            bfm(61, 4, Role::Addition, Retained, 0),
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
            bfm(0, 1, Role::OutputRanges, Retained, 0),
            bfm(1, 4, Role::Output, ReadWrite, 0),
            bfm(5, 1, Role::StopModes, Retained, 0),
            bfm(9, 1, Role::OutputTakeOverBoth, ReadWrite, 0),
            bfm(10, 4, Role::OutputOffsets, Retained, 0),
            bfm(14, 4, Role::OutputGains, Retained, 5000),
            bfm(19, 1, Role::OutputLock, Retained, 3030),
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
