//! Special modules: what their buffer memory holds, as data, and how they behave.
//!
//! [`KINDS`] is the table of modules: which words each has ([`Bfm`]), and which ranges its channels have ([`Range`]).
//! [`Module`] is one of them at work: analog signals come in and go out, FROM and TO read and write its words. The
//! virtual hardware of tests and simulation fits such modules, and a host whose converters are to look like a module
//! to the program can do the same.
//!
//! Sources: h1u-h2u-programming §6.2 to §6.7, hm-motion-controller §7, l01s-programming §9, and the user's guides of
//! FX2N-4AD, FX2N-4DA, FX2N-2AD, FX2N-2DA, FX0N-3A, FX2N-4AD-PT, FX2N-4AD-TC and the analog control edition of FX3U.

mod board;
mod curves;
mod meaning;
mod points;
mod positioner;
mod roles;
mod tables;
mod thermostat;
mod unit;

pub use roles::{AxisWord, Role, Term};
pub use tables::KINDS;
pub use unit::Module;

/// The number under which the hardware keeps the analog board in the main unit's slot (D8220 to D8239), the first of
/// [`NAMES`].
pub const BOARD: u16 = 200;

/// Names of modules that FROM and TO do not reach, whose numbers follow each other from [`BOARD`] on.
pub const NAMES: [&str; 6] = [
    "board", "board2", "adapter1", "adapter2", "adapter3", "adapter4",
];

/// Numbers of the boards in the slots of the main unit.
pub const BOARDS: [u16; 2] = [BOARD, BOARD + 1];

/// Numbers of the analog adapters on the left of FX3.
pub const ADAPTERS: [u16; 4] = [BOARD + 2, BOARD + 3, BOARD + 4, BOARD + 5];

/// The number of a module by its name, in upper or lower case.
pub fn named(name: &str) -> Option<u16> {
    let found = (BOARD..).zip(NAMES);
    let mut found = found.filter(|(_, own)| own.eq_ignore_ascii_case(name));
    found.next().map(|(unit, _)| unit)
}

/// The name of a module that has one.
pub fn name(unit: u16) -> Option<&'static str> {
    let at = unit.checked_sub(BOARD)?;
    NAMES.get(usize::from(at)).copied()
}

/// The first word of the registers of an analog adapter or board, after those of its relays.
pub const REGISTERS: u16 = 10;

/// The word that starts a conversion in an analog adapter or board, after its registers.
pub const EXCHANGE: u16 = 2 * REGISTERS;

/// Quantity that a channel measures or outputs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(u8)]
pub enum Quantity {
    /// Volts.
    Volts = 0,
    /// Milliamperes.
    Milliamperes = 1,
    /// Degrees Celsius.
    Celsius = 2,
    /// An input terminal: 1 if it is on. Its channels count the X of the module, the first being X0.
    InputTerminal = 3,
    /// An output terminal: 1 if it is on. Its channels count the Y of the module, the first being Y0.
    OutputTerminal = 4,
}

impl Quantity {
    /// All of them, by their numbers.
    pub const ALL: [Quantity; 5] = [
        Quantity::Volts,
        Quantity::Milliamperes,
        Quantity::Celsius,
        Quantity::InputTerminal,
        Quantity::OutputTerminal,
    ];

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Volts => "V",
            Quantity::Milliamperes => "mA",
            Quantity::Celsius => "°C",
            Quantity::InputTerminal | Quantity::OutputTerminal => "",
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
    /// Quantity of the signal.
    pub quantity: Quantity,
    /// Value in millionths of its unit: microvolts, nanoamperes, millionths of a degree.
    pub millionths: i32,
}

/// Millivolts or microamperes in a volt or milliampere, and millionths in one of them.
const THOUSAND: i32 = 1000;

/// A current input of 250 Ω makes 4 mA of a volt.
const MILLIAMPERES_PER_VOLT: i32 = 4;

impl Signal {
    /// Value of a quantity as an input measures it, in millionths: a current input that gets a voltage draws the
    /// current through its 250 Ω, a voltage input that gets a current sees more than it can measure. `None`: no such
    /// signal reaches it.
    pub fn seen_as(self, quantity: Quantity) -> Option<i32> {
        use Quantity::{Milliamperes, Volts};
        match (self.quantity, quantity) {
            (from, to) if from == to => Some(self.millionths),
            (Volts, Milliamperes) => Some(self.millionths.saturating_mul(MILLIAMPERES_PER_VOLT)),
            (Milliamperes, Volts) => Some(match self.millionths.signum() {
                0 => 0,
                sign => sign * i32::MAX,
            }),
            _ => None,
        }
    }
}

/// A range that a channel can be set to: a straight line between analog and digital values, and its ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// Quantity that it measures or outputs.
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

    /// Returns true if a digital value is within the range.
    pub fn holds(&self, digital: i32) -> bool {
        (self.low..=self.high).contains(&digital)
    }
}

/// Access of a program to a word of buffer memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Access {
    /// Read it.
    Read,
    /// Read and write it.
    ReadWrite,
    /// Read and write it; the module keeps it over power-off.
    Retained,
}

/// Words of buffer memory at equal distances that have one role, mostly one for each channel.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Bfm {
    /// The number of the first.
    pub first: u16,
    /// Number of words.
    pub count: u8,
    /// Distance between their numbers.
    pub stride: u16,
    /// Meaning of the words.
    pub role: Role,
    /// Access allowed to a program.
    pub access: Access,
    /// Factory setting.
    pub default: i16,
}

impl Bfm {
    /// Index of the word with this number.
    pub fn word(&self, number: u16) -> Option<usize> {
        let at = number.checked_sub(self.first)?;
        let word = usize::from(at / self.stride);
        (at % self.stride == 0 && word < usize::from(self.count)).then_some(word)
    }

    /// The numbers of its words.
    pub fn numbers(&self) -> impl Iterator<Item = u16> + use<> {
        let (first, stride) = (self.first, self.stride);
        (0..u16::from(self.count)).map(move |word| first + word * stride)
    }
}

/// Start of conversions in a module that does not convert by itself.
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
    /// The PLC starts a conversion of all channels when it exchanges words with the module, once a scan.
    Exchange,
}

impl Start {
    /// Returns true if the program starts the conversions.
    pub fn is_programmed(self) -> bool {
        matches!(self, Start::Fx0n3a | Start::Fx2n2ad | Start::Fx2n2da)
    }
}

/// PLCs that a kind of module belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// FROM and TO reach it, on any model that has them.
    Bus,
    /// It is on the CAN bus of H1U and H2U: its number is 100 and its station.
    Remote,
    /// The slot of the main unit of H1U and H2U.
    Slot,
    /// The bus of HM, whose modules have registers and no buffer memory.
    Hm,
    /// The bus of L01S.
    L01s,
    /// The left side of FX3's main units, where FX3U-4AD-ADP and other adapters are.
    Adapter,
    /// The slots for boards of FX3S and FX3G.
    Board3g,
    /// The slot for a board of FX1S and FX1N.
    Board1n,
}

impl Place {
    /// Numbers of the modules at this place, if these have [`NAMES`]; else it is empty.
    pub fn named(self) -> &'static [u16] {
        match self {
            Place::Slot | Place::Board1n => &[BOARD],
            Place::Board3g => &BOARDS,
            Place::Adapter => &ADAPTERS,
            Place::Bus | Place::Remote | Place::Hm | Place::L01s => &[],
        }
    }
}

/// Function of a module in addition to converting.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Duty {
    /// Nothing.
    None,
    /// It controls temperatures. Its outputs are 0 to these with a relay and with a digital output.
    Thermostat {
        /// Full output of a relay.
        relay: i16,
        /// Full digital output.
        digital: i16,
    },
    /// It moves four axes.
    Positioner,
    /// It is an analog board, with this answer to the PLC.
    Board {
        /// Value of D8230 while it works.
        answer: i16,
        /// The greatest filter constant; beyond it, a board that has an earlier one keeps that one.
        most_filter: i16,
        /// True if each input has a terminal for voltage and one for current. Else the table of ranges has one for each
        /// input.
        has_both: bool,
    },
}

/// A kind of module.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its name.
    pub name: &'static str,
    /// Other names of modules that a program cannot tell from it.
    pub aliases: &'static [&'static str],
    /// Source of the description.
    pub source: &'static str,
    /// Number of inputs: its first channels.
    pub inputs: u8,
    /// Number of outputs: the channels after its inputs.
    pub outputs: u8,
    /// The ranges of its inputs, by their digits; `None` turns a channel off.
    pub input_ranges: &'static [Option<Range>],
    /// The ranges of its outputs.
    pub output_ranges: &'static [Option<Range>],
    /// The last number of its buffer memory.
    pub last: u16,
    /// Numbers of input terminals and output terminals.
    pub points: [u8; 2],
    /// PLCs it belongs to.
    pub place: Place,
    /// Function in addition to converting.
    pub duty: Duty,
    /// Its buffer memory. What is not in it up to `last` is reserved: it reads as 0.
    pub bfms: &'static [Bfm],
    /// Conversion time of a channel, in microseconds, unless the program chooses it.
    pub conversion_us: u32,
    /// Maximum number of samples of a mean.
    pub most_samples: i16,
    /// Samples of a mean if the program asks for fewer than 1 or more than that.
    pub usual_samples: i16,
    /// Value that unlocks changes of ranges, offset and gain.
    pub unlocked: i16,
    /// Start of its conversions.
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
            Addition, GreatestPeak, InputGains, InputOffsets, InputTypes, LeastPeak, Mean,
            MeanFahrenheit, Output, OutputCurves, OutputGains, OutputOffsets, OutputShown,
            OutputTypes, Present, PresentFahrenheit, Samples, StopMode, Thermostat, Unused,
        };
        match bfm.role {
            Samples | Mean | Present | MeanFahrenheit | PresentFahrenheit | InputOffsets
            | InputGains | InputTypes | Addition | LeastPeak | GreatestPeak => Some((0, 1)),
            Thermostat(_) => Some((0, 1)),
            Unused => Some((0, 1)),
            Output | OutputOffsets | OutputGains | OutputTypes | OutputShown | StopMode => {
                Some((self.inputs, 1))
            }
            OutputCurves => Some((self.inputs, 2)),
            _ => None,
        }
    }

    /// The row with a role.
    pub fn with(&self, role: Role) -> Option<&'static Bfm> {
        self.bfms.iter().find(|bfm| bfm.role == role)
    }
}
