//! Analog pins of a board: `[analog.inputs]` and `[analog.outputs]`.

use super::pins::Mode;
use super::{BoardError, Reader, Spanned};
use rungc_rt::modules::Quantity;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A register that holds a converted value, or one that is converted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnalogPin {
    /// The register's address.
    pub at: u32,
    /// Its greatest count.
    pub full: u16,
    /// What is measured or put out.
    pub quantity: Quantity,
    /// The signals at count 0 and at the greatest count, in millionths of the unit.
    pub signal: [i32; 2],
    /// Which built-in analog input of the PLC it is (D8030 of L01S, RD3A of boards), by its raw counts.
    pub channel: Option<u8>,
}

/// Analog pins by their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Analog {
    /// What measures.
    pub inputs: BTreeMap<String, AnalogPin>,
    /// What puts out.
    pub outputs: BTreeMap<String, AnalogPin>,
}

impl Analog {
    /// The pins that are built-in analog inputs of the PLC, with their channels.
    pub fn channels(&self) -> impl Iterator<Item = (u8, &AnalogPin)> {
        let pins = self.inputs.values();
        pins.filter_map(|pin| Some((pin.channel?, pin)))
    }

    /// Whether there are any.
    pub(super) fn has_channels(&self) -> bool {
        self.channels().next().is_some()
    }
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub(super) struct Format {
    #[serde(default)]
    inputs: BTreeMap<Spanned, toml::Spanned<Pin>>,
    #[serde(default)]
    outputs: BTreeMap<Spanned, toml::Spanned<Pin>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Pin {
    at: u32,
    pin: Option<String>,
    uncertain: Option<String>,
    #[serde(default = "default_full")]
    full: u16,
    unit: Unit,
    signal: [f64; 2],
    channel: Option<u8>,
}

#[derive(Deserialize, Clone, Copy)]
enum Unit {
    V,
    #[serde(rename = "mA")]
    Milliamperes,
    C,
}

/// Twelve bits.
fn default_full() -> u16 {
    4095
}

impl Reader<'_> {
    pub(super) fn analog(&self, format: Format) -> Result<Analog, BoardError> {
        let analog = Analog {
            inputs: self.analog_pins(format.inputs)?,
            outputs: self.analog_pins(format.outputs)?,
        };
        Ok(analog)
    }

    fn analog_pins(
        &self,
        pins: BTreeMap<Spanned, toml::Spanned<Pin>>,
    ) -> Result<BTreeMap<String, AnalogPin>, BoardError> {
        let mut read_pins = BTreeMap::new();
        for (name, pin) in pins {
            let known = self.analog_pin(&pin)?;
            let own = pin.get_ref();
            if let Some(wired) = &own.pin {
                let (place, uncertain) = (pin.span().start, own.uncertain.clone());
                self.connect(place, name.get_ref(), wired, Mode::Analog, uncertain)?;
            }
            read_pins.insert(name.into_inner(), known);
        }
        Ok(read_pins)
    }

    fn analog_pin(&self, pin: &toml::Spanned<Pin>) -> Result<AnalogPin, BoardError> {
        let own = pin.get_ref();
        let [low, high] = own.signal.map(|value| (value * 1e6).round());
        let holds =
            |value: f64| (f64::from(i32::MIN) / 2.0..=f64::from(i32::MAX) / 2.0).contains(&value);
        if own.full == 0 || low >= high || !holds(low) || !holds(high) {
            let what = "an analog pin has `full`, its greatest count, and `signal = [LOW, HIGH]`, the signals at 0 and at `full`, \
                        from -1000 to 1000";
            return Err(self.at(pin, what.to_string()));
        }
        Ok(AnalogPin {
            at: own.at,
            full: own.full,
            quantity: match own.unit {
                Unit::V => Quantity::Volts,
                Unit::Milliamperes => Quantity::Milliamperes,
                Unit::C => Quantity::Celsius,
            },
            signal: [low as i32, high as i32],
            channel: own.channel,
        })
    }
}
