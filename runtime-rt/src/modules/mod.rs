//! Special modules: what their buffer memory holds, as data, and how they behave.
//!
//! [`KINDS`] is the table of modules: which words each has ([`Bfm`]), and which ranges its channels have ([`Range`]).
//! [`Module`] is one of them at work: analog signals come in and go out, FROM and TO read and write its words. The
//! virtual hardware of tests and simulation fits such modules, and a host whose converters are to look like a module
//! to the program can do the same.
//!
//! Sources: h1u-h2u-programming §6.3 to §6.6, and the user's guides of FX2N-4AD, FX2N-4DA, FX2N-2AD, FX2N-2DA,
//! FX0N-3A, FX2N-4AD-PT, FX2N-4AD-TC and the analog control edition of FX3U.

mod meaning;
mod tables;
mod unit;

pub use tables::KINDS;
pub use unit::Module;

/// What a channel measures or puts out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Quantity {
    /// Volts.
    Volts = 0,
    /// Milliamperes.
    Milliamperes = 1,
    /// Degrees Celsius.
    Celsius = 2,
}

impl Quantity {
    /// All of them, by their numbers.
    pub const ALL: [Quantity; 3] = [Quantity::Volts, Quantity::Milliamperes, Quantity::Celsius];

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Volts => "V",
            Quantity::Milliamperes => "mA",
            Quantity::Celsius => "°C",
        }
    }

    /// The quantity with a number.
    pub fn of(number: u8) -> Option<Quantity> {
        Quantity::ALL.get(usize::from(number)).copied()
    }
}

/// An analog signal.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Signal {
    /// What it is.
    pub quantity: Quantity,
    /// How much, in millionths of its unit: microvolts, nanoamperes, millionths of a degree.
    pub millionths: i32,
}

/// Millivolts or microamperes in a volt or milliampere, and millionths in one of them.
const THOUSAND: i32 = 1000;

/// A current input of 250 Ω makes 4 mA of a volt.
const MILLIAMPERES_PER_VOLT: i32 = 4;

impl Signal {
    /// How much of a quantity an input sees, in millionths: a current input that gets a voltage draws what its 250 Ω
    /// let through, a voltage input that gets a current sees more than it can measure. `None`: no such signal reaches
    /// it.
    pub fn seen_as(self, quantity: Quantity) -> Option<i32> {
        use Quantity::{Celsius, Milliamperes, Volts};
        match (self.quantity, quantity) {
            (from, to) if from == to => Some(self.millionths),
            (Volts, Milliamperes) => Some(self.millionths.saturating_mul(MILLIAMPERES_PER_VOLT)),
            (Milliamperes, Volts) => Some(match self.millionths.signum() {
                0 => 0,
                sign => sign * i32::MAX,
            }),
            (Celsius, _) | (_, Celsius) => None,
            (Volts | Milliamperes, _) => None,
        }
    }
}

/// A range that a channel can be set to: a straight line between analog and digital values, and its ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// What it measures or puts out.
    pub quantity: Quantity,
    /// The analog value, in mV, µA or 0.001 °C, that is 0 as a digital value.
    pub offset: i32,
    /// The analog value that is `span`.
    pub gain: i32,
    /// That digital value.
    pub span: i32,
    /// The least digital value.
    pub low: i32,
    /// The greatest digital value.
    pub high: i32,
}

/// Offset and gain of a channel, in mV, µA or 0.001 °C.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Curve {
    /// The analog value that is 0 as a digital value.
    pub offset: i32,
    /// The analog value that is the range's `span`.
    pub gain: i32,
}

/// A quotient, rounded to the nearest; what no i32 holds is held at its ends, and so is what is divided by 0.
fn quotient(dividend: i64, divisor: i64) -> i32 {
    let (dividend, divisor) = match divisor {
        ..0 => (-dividend, -divisor),
        0 => return 0,
        _ => (dividend, divisor),
    };
    let half = divisor / 2;
    let nearest = if dividend < 0 {
        (dividend - half) / divisor
    } else {
        (dividend + half) / divisor
    };
    nearest.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

impl Range {
    /// The curve that it has as it comes from the factory.
    pub const fn curve(&self) -> Curve {
        Curve {
            offset: self.offset,
            gain: self.gain,
        }
    }

    /// The digital value of an analog one in millionths, not yet held in the range.
    pub fn digital(&self, curve: Curve, millionths: i32) -> i32 {
        let above = i64::from(millionths) - i64::from(curve.offset) * i64::from(THOUSAND);
        let rise = i64::from(curve.gain) - i64::from(curve.offset);
        quotient(above * i64::from(self.span), rise * i64::from(THOUSAND))
    }

    /// The analog value, in millionths, of a digital one.
    pub fn analog(&self, curve: Curve, digital: i32) -> i32 {
        let rise = i64::from(curve.gain) - i64::from(curve.offset);
        let above = quotient(
            i64::from(digital) * rise * i64::from(THOUSAND),
            self.span.into(),
        );
        curve.offset.saturating_mul(THOUSAND).saturating_add(above)
    }

    /// Whether a digital value is one that the range has.
    pub fn holds(&self, digital: i32) -> bool {
        (self.low..=self.high).contains(&digital)
    }
}

/// What a program may do with a word of buffer memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Access {
    /// Read it.
    Read,
    /// Read and write it.
    ReadWrite,
    /// Read and write it; the module keeps it over power-off.
    Kept,
}

/// What a word of buffer memory is for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Role {
    /// The ranges of the inputs, a hexadecimal digit each, the lowest that of the first.
    InputRanges,
    /// How many samples make a mean.
    Samples,
    /// The mean of the last samples.
    Mean,
    /// The last sample.
    Present,
    /// The mean in tenths of a degree Fahrenheit.
    MeanFahrenheit,
    /// The last sample in tenths of a degree Fahrenheit.
    PresentFahrenheit,
    /// How long a conversion takes.
    Rate,
    /// 1 restores what the inputs were set to at the factory.
    InputReset,
    /// Whether ranges, offset and gain of the inputs may be changed.
    InputLock,
    /// Bits that give the offset or the gain to channels, two for each.
    InputTakeOver,
    /// Offset for the channels that take it over.
    InputOffset,
    /// Gain for the channels that take it over.
    InputGain,
    /// Bits that give offset and gain to channels, one for each.
    InputTakeOverBoth,
    /// Offset of a channel, once it takes it over.
    InputOffsets,
    /// Gain of a channel, once it takes it over.
    InputGains,
    /// Added to what a channel measures.
    Addition,
    /// The least value measured since the last reset.
    LeastPeak,
    /// The greatest value measured since the last reset.
    GreatestPeak,
    /// Bits that set the peaks of channels to the present value, one for each.
    PeakReset,
    /// Channels that have measured too little or too much, two bits for each; stays until 0 is written.
    RangeLatch,
    /// What is wrong with the inputs.
    InputError,
    /// The ranges of the outputs, a hexadecimal digit each.
    OutputRanges,
    /// What an output puts out.
    Output,
    /// What the outputs do in STOP, a hexadecimal digit each: 0 they hold, 1 they go to their offset.
    StopModes,
    /// Hexadecimal digits that give offset or gain to two channels.
    OutputTakeOver,
    /// Offset and gain of the outputs by turns, once they take them over.
    OutputCurves,
    /// Bits that give offset and gain to outputs, one for each.
    OutputTakeOverBoth,
    /// Offset of an output, once it takes it over.
    OutputOffsets,
    /// Gain of an output, once it takes it over.
    OutputGains,
    /// 1 restores what the outputs were set to at the factory.
    OutputReset,
    /// Whether ranges, offset and gain of the outputs may be changed.
    OutputLock,
    /// What is wrong with the outputs.
    OutputError,
    /// The version of the module's software.
    Version,
    /// Which module it is.
    Identification,
    /// A setting that the simulated module keeps and does not act on.
    Setting,
    /// The low byte of what was measured last.
    LowByte,
    /// The high bits of what was measured last.
    HighBits,
    /// What is to be put out.
    Data,
    /// Bits that choose a channel and start conversions.
    Control,
}

/// Words of buffer memory that follow each other and have one role, mostly one for each channel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bfm {
    /// The number of the first.
    pub first: u16,
    /// How many there are.
    pub count: u8,
    /// What they are for.
    pub role: Role,
    /// What a program may do with them.
    pub access: Access,
    /// What they hold as the module comes from the factory.
    pub default: i16,
}

impl Bfm {
    /// Which of its words has this number.
    pub fn word(&self, number: u16) -> Option<usize> {
        let at = usize::from(number.checked_sub(self.first)?);
        (at < usize::from(self.count)).then_some(at)
    }
}

/// How a program starts the conversions of a module that does not convert by itself.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Start {
    /// The module converts all open channels by turns.
    Itself,
    /// FX0N-3A: bit 0 chooses an input, the rise of bit 1 starts its conversion, the fall of bit 2 that of the output.
    Fx0n3a,
    /// FX2N-2AD: bit 0 chooses an input, the rise of bit 1 starts its conversion.
    Fx2n2ad,
    /// FX2N-2DA: the fall of bit 2 takes the low byte over, that of bit 1 starts the first output and that of bit 0
    /// the second.
    Fx2n2da,
}

/// A kind of module.
#[derive(Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Other names of modules that a program cannot tell from it.
    pub aliases: &'static [&'static str],
    /// Where it is described.
    pub source: &'static str,
    /// How many inputs it has: its first channels.
    pub inputs: u8,
    /// How many outputs it has: the channels after its inputs.
    pub outputs: u8,
    /// The ranges of its inputs, by their digits; `None` turns a channel off.
    pub input_ranges: &'static [Option<Range>],
    /// The ranges of its outputs.
    pub output_ranges: &'static [Option<Range>],
    /// The last number of its buffer memory.
    pub last: u16,
    /// Its buffer memory. What is not in it up to `last` is reserved: it reads as 0.
    pub bfms: &'static [Bfm],
    /// How long it takes to convert a channel, in microseconds, where the program does not choose it.
    pub conversion_us: u32,
    /// How many samples a mean has at most.
    pub most_samples: i16,
    /// How many it has if the program asks for fewer than 1 or more than that.
    pub usual_samples: i16,
    /// What is written to change ranges, offset and gain.
    pub unlocked: i16,
    /// What starts its conversions.
    pub start: Start,
}

/// Two modules are of the same kind if they are the same row of the table.
impl PartialEq for Kind {
    fn eq(&self, other: &Kind) -> bool {
        self.name == other.name
    }
}

impl Eq for Kind {}

impl Kind {
    /// The kind with a name or alias, in upper or lower case.
    pub fn find(name: &str) -> Option<&'static Kind> {
        KINDS.iter().find(|kind| {
            let mut names = core::iter::once(&kind.name).chain(kind.aliases);
            names.any(|own| own.eq_ignore_ascii_case(name))
        })
    }

    /// Its number in the table.
    pub fn index(&self) -> usize {
        KINDS.iter().position(|kind| kind == self).unwrap_or(0)
    }

    /// The row that has a word of its buffer memory.
    pub fn bfm(&self, number: u16) -> Option<&'static Bfm> {
        self.bfms.iter().find(|bfm| bfm.word(number).is_some())
    }

    /// The channels of a row's words, counted from 0: that of the first, and how many words each has.
    pub fn channels(&self, bfm: &Bfm) -> Option<(u8, u8)> {
        use Role::{
            Addition, GreatestPeak, InputGains, InputOffsets, LeastPeak, Mean, MeanFahrenheit,
            Output, OutputCurves, OutputGains, OutputOffsets, Present, PresentFahrenheit, Samples,
        };
        match bfm.role {
            Samples | Mean | Present | MeanFahrenheit | PresentFahrenheit | InputOffsets
            | InputGains | Addition | LeastPeak | GreatestPeak => Some((0, 1)),
            Output | OutputOffsets | OutputGains => Some((self.inputs, 1)),
            OutputCurves => Some((self.inputs, 2)),
            _ => None,
        }
    }

    /// The row with a role.
    pub fn with(&self, role: Role) -> Option<&'static Bfm> {
        self.bfms.iter().find(|bfm| bfm.role == role)
    }
}
