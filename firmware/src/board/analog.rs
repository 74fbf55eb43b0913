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
    /// Quantity that is measured or output.
    pub quantity: Quantity,
    /// The signals at count 0 and at the greatest count, in millionths of the unit.
    pub signal: [i32; 2],
    /// Number of the PLC's built-in analog input (D8030 of L01S, RD3A of boards) or output (WR3A of boards), with its
    /// raw counts.
    pub channel: Option<u8>,
    /// Start of an input's converter before its register is read; `None` if it converts by itself.
    pub start: Option<Start>,
}

/// Register write that starts a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// The address of a register.
    pub at: u32,
    /// The word that is written to it.
    pub write: u32,
    /// The bits of it that are on when the conversion is over.
    pub wait: u32,
}

/// Analog pins by their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Analog {
    /// Analog inputs.
    pub inputs: BTreeMap<String, AnalogPin>,
    /// Analog outputs.
    pub outputs: BTreeMap<String, AnalogPin>,
}

impl Analog {
    /// The pins that are built-in analog inputs of the PLC, with their channels.
    pub fn channels(&self) -> impl Iterator<Item = (u8, &AnalogPin)> {
        numbered(&self.inputs)
    }

    /// The pins that are built-in analog outputs of the PLC, with their channels.
    pub(crate) fn output_channels(&self) -> impl Iterator<Item = (u8, &AnalogPin)> {
        numbered(&self.outputs)
    }

    /// Returns true if there are any.
    pub(super) fn has_channels(&self) -> bool {
        self.channels().next().is_some()
    }
}

fn numbered(pins: &BTreeMap<String, AnalogPin>) -> impl Iterator<Item = (u8, &AnalogPin)> {
    pins.values().filter_map(|pin| Some((pin.channel?, pin)))
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
    start: Option<Start>,
    function: Option<u32>,
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
            inputs: self.analog_pins(format.inputs, false)?,
            outputs: self.analog_pins(format.outputs, true)?,
        };
        Ok(analog)
    }

    fn analog_pins(
        &self,
        pins: BTreeMap<Spanned, toml::Spanned<Pin>>,
        outputs: bool,
    ) -> Result<BTreeMap<String, AnalogPin>, BoardError> {
        let mut known = BTreeMap::new();
        let mut channels = Vec::new();
        for (name, pin) in pins {
            let analog = self.analog_pin(&pin, outputs)?;
            let own = pin.get_ref();
            if let Some(wired) = &own.pin {
                let (place, uncertain) = (pin.span().start, own.uncertain.clone());
                let mode = own.function.map_or(Mode::Analog, Mode::Sends);
                self.connect(place, name.get_ref(), wired, mode, uncertain)?;
            }
            if let Some(channel) = analog.channel {
                if channels.contains(&channel) {
                    let what = format!("channel {channel} is listed twice");
                    return Err(self.at(&name, what));
                }
                channels.push(channel);
            }
            known.insert(name.into_inner(), analog);
        }
        Ok(known)
    }

    fn analog_pin(
        &self,
        pin: &toml::Spanned<Pin>,
        is_output: bool,
    ) -> Result<AnalogPin, BoardError> {
        let own = pin.get_ref();
        if is_output && own.start.is_some() {
            let what = "`start` starts the conversion of an input; an output has none".to_string();
            return Err(self.at(pin, what));
        }
        if !is_output && own.function.is_some() {
            let what = "`function` is that of an output (PWM); an input has none".to_string();
            return Err(self.at(pin, what));
        }
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
            start: own.start,
        })
    }
}
