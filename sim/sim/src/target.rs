//! Names in `set`, `init` and `expect`: `M0`, `D0.i32`, `K4M0`, `T0.value`, `Y000.pulses`.

use rungc_models::runs::is_counter32;
use rungc_rt::modules::{self, Quantity};
use rungc_syntax::DeviceClass;
use std::fmt;
use std::ops::RangeInclusive;

/// A channel of a special module, `0:CH1.mA`, or one of its terminals, `101:X5`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Channel {
    /// The module's number.
    pub unit: u16,
    /// The channel's, from 1; a terminal's, with 1 for X0 and Y0.
    pub number: u8,
    /// In what it is measured, or which terminals are meant.
    pub quantity: Quantity,
}

/// The letters of terminals.
const TERMINALS: [(&str, Quantity); 2] = [
    ("X", Quantity::InputTerminal),
    ("Y", Quantity::OutputTerminal),
];

/// The number of a module as names and test files have it.
pub fn unit(name: &str) -> Option<u16> {
    modules::named(name).or_else(|| name.parse().ok())
}

/// The units of channels as names end in them, and the quantities.
const UNITS: [(&str, Quantity); 3] = [
    ("V", Quantity::Volts),
    ("mA", Quantity::Milliamperes),
    ("C", Quantity::Celsius),
];

impl Channel {
    /// Reads a name, if it begins like that of a channel; the error describes the problem.
    fn parse(name: &str) -> Option<Result<Channel, String>> {
        let (unit, channel) = name.split_once(':')?;
        let unit = self::unit(unit)?;
        let wrong = || {
            format!(
                "`{name}`: write a channel of a module as `0:CH1.V`, `0:CH1.mA` or `0:CH1.C`, and a terminal as `101:X5`"
            )
        };
        let channel = || {
            let Some((channel, view)) = channel.split_once('.') else {
                return Channel::terminal(unit, channel);
            };
            let letters = channel.get(..2)?;
            let number = channel.get(2..)?.parse().ok()?;
            let named = UNITS
                .iter()
                .find(|(name, _)| name.eq_ignore_ascii_case(view));
            let (_, quantity) = named?;
            let found = letters.eq_ignore_ascii_case("CH") && number > 0;
            found.then_some(Channel {
                unit,
                number,
                quantity: *quantity,
            })
        };
        Some(channel().ok_or_else(wrong))
    }

    /// Message for an input that the PLC does not have.
    pub fn missing(self) -> String {
        format!("the PLC has no input `{self}`: no such module is fitted")
    }

    /// A terminal by its letter and its octal number.
    fn terminal(unit: u16, name: &str) -> Option<Channel> {
        let (letter, number) = name.split_at_checked(1)?;
        let mut known = TERMINALS.iter();
        let (_, quantity) = known.find(|(own, _)| own.eq_ignore_ascii_case(letter))?;
        let number = u8::from_str_radix(number, 8).ok()?;
        Some(Channel {
            unit,
            number: number.checked_add(1)?,
            quantity: *quantity,
        })
    }
}

impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match modules::name(self.unit) {
            Some(name) => write!(f, "{name}:")?,
            None => write!(f, "{}:", self.unit)?,
        }
        let named = |(_, quantity): &&(&str, Quantity)| *quantity == self.quantity;
        if let Some((letter, _)) = TERMINALS.iter().find(named) {
            return write!(f, "{letter}{:o}", self.number.saturating_sub(1));
        }
        let unit = UNITS.iter().find(named).map_or("", |(unit, _)| unit);
        write!(f, "CH{}.{unit}", self.number)
    }
}

/// Target of a name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Target {
    /// A bit device; a timer's or counter's contact.
    Bit(DeviceClass, u32),
    /// A 16-bit word.
    Word(DeviceClass, u32),
    /// The current value of a timer or counter; 32 bits from C200.
    Current(DeviceClass, u32),
    /// A pair of words as a signed integer.
    Pair(DeviceClass, u32),
    /// A pair of words as a float.
    Float(DeviceClass, u32),
    /// Characters, two a word, low byte first.
    Text(DeviceClass, u32),
    /// A group of `4 * .0` bits.
    Nibbles(u8, DeviceClass, u32),
    /// Pulses that an output has emitted since power-on.
    Pulses(u32),
    /// The frequency that an output emits now.
    Frequency(u32),
    /// The analog signal at a channel of a special module.
    Channel(Channel),
}

/// No device of any model has a higher number.
const LAST: u32 = 999_999;

const BITS: [DeviceClass; 4] = [
    DeviceClass::X,
    DeviceClass::Y,
    DeviceClass::M,
    DeviceClass::S,
];
const CONTACTS: [DeviceClass; 2] = [DeviceClass::T, DeviceClass::C];
const WORDS: [DeviceClass; 5] = [
    DeviceClass::D,
    DeviceClass::R,
    DeviceClass::ER,
    DeviceClass::V,
    DeviceClass::Z,
];

impl Target {
    /// Reads a name; the error describes the problem.
    pub fn parse(name: &str) -> Result<Target, String> {
        if let Some(channel) = Channel::parse(name) {
            return channel.map(Target::Channel);
        }
        let (device, view) = match name.split_once('.') {
            Some((device, view)) => (device, Some(view)),
            None => (name, None),
        };
        if let Some((digits, device)) = group(device) {
            let (class, number) = device_of(device, name)?;
            return match (view, BITS.contains(&class), digits) {
                (None, true, 1..=8) => Ok(Target::Nibbles(digits, class, number)),
                (None, true, _) => Err(format!("`{name}`: a group has 1 to 8 digits")),
                (None, false, _) => Err(format!("`{name}`: a group starts at an X, Y, M or S")),
                (Some(_), ..) => Err(format!("`{name}`: nothing may follow a group")),
            };
        }
        let (class, number) = device_of(device, name)?;
        let is_word = WORDS.contains(&class);
        match view {
            None if BITS.contains(&class) || CONTACTS.contains(&class) => {
                Ok(Target::Bit(class, number))
            }
            None if is_word => Ok(Target::Word(class, number)),
            Some("value") if CONTACTS.contains(&class) => Ok(Target::Current(class, number)),
            Some("i32") if is_word => Ok(Target::Pair(class, number)),
            Some("f32") if is_word => Ok(Target::Float(class, number)),
            Some("str") if is_word => Ok(Target::Text(class, number)),
            Some("pulses") if class == DeviceClass::Y => Ok(Target::Pulses(number)),
            Some("hz") if class == DeviceClass::Y => Ok(Target::Frequency(number)),
            Some(view) => {
                let letters = class.prefix();
                let wrong = format!("`{name}`: `.{view}` does not apply to {letters}");
                Err(match views(class) {
                    "" => wrong,
                    views => format!("{wrong}, which accepts {views}"),
                })
            }
            None => Err(format!("`{name}` has no value")),
        }
    }

    /// The integers it can hold, signed or unsigned; `None` if it holds no integer.
    pub fn integers(self) -> Option<RangeInclusive<i64>> {
        const WORD: RangeInclusive<i64> = -0x8000..=0xffff;
        const DOUBLE: RangeInclusive<i64> = -0x8000_0000..=0xffff_ffff;
        match self {
            Target::Bit(..) => Some(0..=1),
            Target::Current(class, number) if is_counter32(class, number) => Some(DOUBLE),
            Target::Word(..) | Target::Current(..) | Target::Nibbles(4, ..) => Some(WORD),
            Target::Pair(..) | Target::Nibbles(8, ..) | Target::Pulses(_) => Some(DOUBLE),
            Target::Nibbles(digits, ..) => Some(0..=(1 << (4 * u32::from(digits))) - 1),
            Target::Float(..) | Target::Text(..) | Target::Frequency(_) | Target::Channel(_) => {
                None
            }
        }
    }

    /// Returns true if a pair of words can hold this float, rounded, but not to 0.
    pub fn is_float(value: f64) -> bool {
        let held = value as f32;
        held.is_finite() && (held != 0.0 || value == 0.0)
    }

    /// The devices it covers, as (class, first, count); a text covers `text_len` bytes, a channel of a module none.
    pub fn devices(self, text_len: usize) -> (DeviceClass, u32, u32) {
        match self {
            Target::Bit(class, n) | Target::Word(class, n) | Target::Current(class, n) => {
                (class, n, 1)
            }
            Target::Pair(class, n) | Target::Float(class, n) => (class, n, 2),
            Target::Text(class, n) => (class, n, text_len.div_ceil(2) as u32),
            Target::Nibbles(digits, class, n) => (class, n, 4 * u32::from(digits)),
            Target::Pulses(n) | Target::Frequency(n) => (DeviceClass::Y, n, 1),
            Target::Channel(_) => (DeviceClass::D, 0, 0),
        }
    }
}

/// The views of a class, for messages.
fn views(class: DeviceClass) -> &'static str {
    match class {
        DeviceClass::Y => "`.pulses` and `.hz`",
        _ if WORDS.contains(&class) => "`.i32`, `.f32` and `.str`",
        _ if CONTACTS.contains(&class) => "`.value`",
        _ => "",
    }
}

/// Correction of `D0:f`, the notation of other tools.
fn view_after_colon(name: &str, device: &str, view: &str) -> String {
    let meant = match view.chars().next().map(|c| c.to_ascii_lowercase()) {
        Some('f' | 'r' | 'e') => "f32",
        Some('s' | 't' | 'c') => "str",
        _ => "i32",
    };
    format!("`{name}`: write `{device}.{meant}`; put a dot before the type")
}

/// Splits `K4M0` into 4 and `M0`.
fn group(device: &str) -> Option<(u8, &str)> {
    let rest = device.strip_prefix('K')?;
    let at = rest.find(|c: char| !c.is_ascii_digit())?;
    let (digits, device) = rest.split_at(at);
    Some((digits.parse().ok()?, device))
}

fn device_of(device: &str, name: &str) -> Result<(DeviceClass, u32), String> {
    let at = device
        .find(|c: char| c.is_ascii_digit())
        .unwrap_or(device.len());
    if let Some((device, view)) = device.split_once([':', '/'])
        && device_of(device, name).is_ok()
    {
        return Err(view_after_colon(name, device, view));
    }
    let (letters, number) = device.split_at(at);
    let class = DeviceClass::from_prefix(letters).ok_or_else(|| {
        format!("`{name}` is not a device name; examples: `M0`, `X010`, `D0.i32`")
    })?;
    let radix = if class.is_octal() { 8 } else { 10 };
    let number = u32::from_str_radix(number, radix).map_err(|_| {
        let kind = if radix == 8 { "an octal" } else { "a decimal" };
        format!("`{name}`: `{letters}` is followed by {kind} number")
    })?;
    if number > LAST {
        return Err(format!("`{name}`: no model has that many devices"));
    }
    Ok((class, number))
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Target::Bit(class, n) | Target::Word(class, n) => write!(f, "{}", class.number(n)),
            Target::Current(class, n) => write!(f, "{}.value", class.number(n)),
            Target::Pair(class, n) => write!(f, "{}.i32", class.number(n)),
            Target::Float(class, n) => write!(f, "{}.f32", class.number(n)),
            Target::Text(class, n) => write!(f, "{}.str", class.number(n)),
            Target::Nibbles(digits, class, n) => write!(f, "K{digits}{}", class.number(n)),
            Target::Pulses(n) => write!(f, "{}.pulses", DeviceClass::Y.number(n)),
            Target::Frequency(n) => write!(f, "{}.hz", DeviceClass::Y.number(n)),
            Target::Channel(channel) => channel.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Channel, Target};
    use rungc_rt::modules::{BOARD, Quantity};
    use rungc_syntax::DeviceClass::{C, D, M, X, Y};

    #[test]
    fn names_are_read() {
        for (name, target) in [
            ("X010", Target::Bit(X, 8)),
            ("C200.value", Target::Current(C, 200)),
            ("D8013", Target::Word(D, 8013)),
            ("D0.f32", Target::Float(D, 0)),
            ("K4M16", Target::Nibbles(4, M, 16)),
            ("Y003.hz", Target::Frequency(3)),
            (
                "101:CH4.mA",
                Target::Channel(Channel {
                    unit: 101,
                    number: 4,
                    quantity: Quantity::Milliamperes,
                }),
            ),
            (
                "board:CH1.V",
                Target::Channel(Channel {
                    unit: BOARD,
                    number: 1,
                    quantity: Quantity::Volts,
                }),
            ),
            (
                "101:X17",
                Target::Channel(Channel {
                    unit: 101,
                    number: 16,
                    quantity: Quantity::InputTerminal,
                }),
            ),
            ("Y000", Target::Bit(Y, 0)),
        ] {
            assert_eq!(Target::parse(name), Ok(target));
            assert_eq!(target.to_string(), name);
        }
    }

    #[test]
    fn views_are_suggested() {
        let why = |name| Target::parse(name).unwrap_err();
        insta::assert_snapshot!(why("D0:f"), @"`D0:f`: write `D0.f32`; put a dot before the type");
        insta::assert_snapshot!(why("D0:I"), @"`D0:I`: write `D0.i32`; put a dot before the type");
        insta::assert_snapshot!(why("D0.f"), @"`D0.f`: `.f` does not apply to D, which accepts `.i32`, `.f32` and `.str`");
        insta::assert_snapshot!(why("Y0.f32"), @"`Y0.f32`: `.f32` does not apply to Y, which accepts `.pulses` and `.hz`");
        insta::assert_snapshot!(why("M0.i32"), @"`M0.i32`: `.i32` does not apply to M");
    }

    #[test]
    fn wrong_names_are_errors() {
        for name in [
            "",
            "Q0",
            "X008",
            "D",
            "D0.i16",
            "K9M0",
            "K4D0",
            "M0.i32",
            "P0",
            "D0.value",
            "K4M0.i32",
            "D-1",
            "T0.hz",
            "D4294967295.i32",
            "D0:f",
            "D0/",
            "0:CH1",
            "0:CH0.V",
            "0:X8",
            "0:Z1",
            "0:CH1.A",
            "0:D1.V",
        ] {
            assert!(Target::parse(name).is_err(), "{name}");
        }
    }
}
