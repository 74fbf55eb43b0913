//! Pins by the names of the data sheets (`pin = "PB13"`): their registers, and how they are set up.

use super::{BoardError, InputPin, OutputPin, Reader, Setup};
use serde::Deserialize;

/// A family of microcontrollers, by the registers of its pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Chip {
    /// STM32F1, and parts with the same registers (RM0008 §9).
    Stm32f1,
    /// STM32F0, and parts with the same registers (RM0360 §8).
    Stm32f0,
    /// RP2040 (data sheet §2.3.1 SIO, §2.19 GPIO). Its flash begins with a second stage of the boot ROM, which an image
    /// for it has, too.
    Rp2040,
}

/// A pin of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pin {
    chip: Chip,
    /// A is 0.
    port: u32,
    bit: u32,
}

/// Pull resistor, which defines the state of an open input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Pull {
    Up,
    Down,
}

/// Mode of a pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mode {
    /// An input.
    Input(Option<Pull>),
    /// An output, which begins in this state.
    Output(bool),
    /// An output of a peripheral, by the number of its function.
    Sends(u32),
    /// An input of a peripheral, by the number of its function.
    Receives(u32),
    /// Connected to a converter.
    Analog,
}

/// A pin, and what it is wired to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedPin {
    /// Connection of the pin: a terminal, a port, a switch.
    pub terminal: String,
    /// Its name in the data sheet.
    pub pin: String,
    /// Reason why it may be another one.
    pub uncertain: Option<String>,
}

/// The pins that a description names, with what sets them up.
#[derive(Default)]
pub(super) struct Wiring {
    pub chip: Option<Chip>,
    /// Uncertainty about all pins.
    pub uncertain: Option<String>,
    pub named: Vec<NamedPin>,
    pub uses: Vec<(Pin, Mode)>,
}

/// An input in a description.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InputFormat {
    at: Option<u32>,
    bit: Option<u32>,
    pin: Option<String>,
    pull: Option<Pull>,
    uncertain: Option<String>,
    #[serde(default)]
    inverted: bool,
}

/// An output in a description.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Output {
    at: Option<u32>,
    off_at: Option<u32>,
    bit: Option<u32>,
    pin: Option<String>,
    uncertain: Option<String>,
    #[serde(default)]
    inverted: bool,
    on: Option<u32>,
    off: Option<u32>,
}

impl Chip {
    fn pin(self, name: &str) -> Option<Pin> {
        if self == Chip::Rp2040 {
            let digits = name.strip_prefix("GP")?;
            let bit: u32 = digits.parse().ok().filter(|bit| *bit < 30)?;
            let canonical = bit.to_string() == digits;
            let (chip, port) = (self, 0);
            return canonical.then_some(Pin { chip, port, bit });
        }
        let letter = name.strip_prefix('P')?.chars().next()?;
        let mut ports = match self {
            Chip::Stm32f1 => 'A'..='G',
            Chip::Stm32f0 | Chip::Rp2040 => 'A'..='F',
        };
        let port = ports.position(|port| port == letter)? as u32;
        let digits = name.get(2..)?;
        let bit: u32 = digits.parse().ok().filter(|bit| *bit < 16)?;
        let canonical = bit.to_string() == digits;
        canonical.then_some(Pin {
            chip: self,
            port,
            bit,
        })
    }
}

/// Registers of an RP2040: pins as the cores see them, what a pin is used for, its driver and pulls, and which parts
/// are reset.
const SIO: u32 = 0xD000_0000;
const IO_BANK0: u32 = 0x4001_4000;
const PADS_BANK0: u32 = 0x4001_C000;
const RESETS: u32 = 0x4000_C000;

impl Chip {
    /// Example of a pin's name.
    fn example(self) -> &'static str {
        match self {
            Chip::Stm32f1 | Chip::Stm32f0 => "PB13",
            Chip::Rp2040 => "GP13",
        }
    }
}

impl Pin {
    /// The first register of its port.
    fn base(self) -> u32 {
        match self.chip {
            Chip::Stm32f1 => 0x4001_0800 + 0x400 * self.port,
            Chip::Stm32f0 => 0x4800_0000 + 0x400 * self.port,
            Chip::Rp2040 => SIO,
        }
    }

    fn input(self, inverted: bool) -> InputPin {
        let at = match self.chip {
            Chip::Stm32f1 => self.base() + 0x08,
            Chip::Stm32f0 => self.base() + 0x10,
            Chip::Rp2040 => SIO + 0x04,
        };
        InputPin {
            at,
            bit: self.bit,
            inverted,
        }
    }

    /// The words that drive it high and low.
    fn levels(self) -> [(u32, u32); 2] {
        let bit = 1 << self.bit;
        let at = match self.chip {
            Chip::Stm32f1 => self.base() + 0x10,
            Chip::Stm32f0 => self.base() + 0x18,
            // GPIO_OUT_SET and GPIO_OUT_CLR.
            Chip::Rp2040 => return [(SIO + 0x14, bit), (SIO + 0x18, bit)],
        };
        [(at, bit), (at, bit << 16)]
    }

    fn output(self, inverted: bool) -> OutputPin {
        let [high, low] = self.levels();
        match inverted {
            false => OutputPin::Words { on: high, off: low },
            true => OutputPin::Words { on: low, off: high },
        }
    }

    /// Register writes that enable the clock of its registers.
    fn clock(self) -> Vec<Setup> {
        match self.chip {
            // RCC_APB2ENR: IOPAEN and following.
            Chip::Stm32f1 => vec![Setup::set(0x4002_1018, 1 << (2 + self.port))],
            // RCC_AHBENR: IOPAEN and following.
            Chip::Stm32f0 => vec![Setup::set(0x4002_1014, 1 << (17 + self.port))],
            Chip::Rp2040 => {
                let bits = 1 << 5 | 1 << 8; // IO_BANK0, PADS_BANK0
                let (at, set) = (RESETS, 0);
                let leave = Setup::Change {
                    at,
                    clear: bits,
                    set,
                };
                let (at, on) = (RESETS + 8, true);
                vec![leave, Setup::Wait { at, bits, on }]
            }
        }
    }

    /// Register writes that set it up, once its registers have their clock. An output has its state before it drives
    /// the pin.
    fn set_up(self, mode: Mode) -> Vec<Setup> {
        let mut steps = Vec::new();
        if let Mode::Output(high) = mode {
            let (at, word) = self.levels()[usize::from(!high)];
            steps.push(Setup::Write { at, word });
        }
        match self.chip {
            Chip::Stm32f1 => self.set_up_f1(mode, &mut steps),
            Chip::Stm32f0 => self.set_up_f0(mode, &mut steps),
            Chip::Rp2040 => self.set_up_rp2040(mode, &mut steps),
        }
        steps
    }

    /// GPIO_OE_SET and GPIO_OE_CLR; the pad (drive of 4 mA, input, Schmitt trigger, pulls; off for converters), then
    /// GPIOx_CTRL's function.
    fn set_up_rp2040(self, mode: Mode, steps: &mut Vec<Setup>) {
        let (pad, function) = match mode {
            Mode::Input(pull) => match pull {
                None => (0x42, 5),
                Some(Pull::Up) => (0x4A, 5),
                Some(Pull::Down) => (0x46, 5),
            },
            Mode::Output(_) => (0x52, 5),
            Mode::Sends(function) => (0x52, function),
            Mode::Receives(function) => (0x4A, function),
            Mode::Analog => (0x80, 31),
        };
        let drives = matches!(mode, Mode::Output(_));
        let enable = if drives { SIO + 0x24 } else { SIO + 0x28 };
        let words = [
            (enable, 1 << self.bit),
            (PADS_BANK0 + 4 + 4 * self.bit, pad),
            (IO_BANK0 + 4 + 8 * self.bit, function),
        ];
        steps.extend(words.map(|(at, word)| Setup::Write { at, word }));
    }

    /// GPIOx_CRL and GPIOx_CRH have four bits for each pin; GPIOx_ODR chooses up or down.
    fn set_up_f1(self, mode: Mode, steps: &mut Vec<Setup>) {
        let four = match mode {
            Mode::Analog => 0x0,
            Mode::Output(_) => 0x2,
            Mode::Input(None) | Mode::Receives(_) => 0x4,
            Mode::Input(Some(_)) => 0x8,
            Mode::Sends(_) => 0xA,
        };
        if let Mode::Input(Some(pull)) = mode {
            let (at, word) = self.levels()[usize::from(pull == Pull::Down)];
            steps.push(Setup::Write { at, word });
        }
        let at = self.base() + 4 * (self.bit / 8);
        let shift = 4 * (self.bit % 8);
        steps.push(Setup::Change {
            at,
            clear: 0xF << shift,
            set: four << shift,
        });
    }

    /// GPIOx_PUPDR, GPIOx_AFRL and GPIOx_AFRH, then GPIOx_MODER.
    fn set_up_f0(self, mode: Mode, steps: &mut Vec<Setup>) {
        let two = |at, value: u32| Setup::Change {
            at,
            clear: 3 << (2 * self.bit),
            set: value << (2 * self.bit),
        };
        let pull = match mode {
            Mode::Input(Some(Pull::Up)) => 1,
            Mode::Input(Some(Pull::Down)) => 2,
            _ => 0,
        };
        steps.push(two(self.base() + 0x0C, pull));
        if let Mode::Sends(function) | Mode::Receives(function) = mode {
            let shift = 4 * (self.bit % 8);
            steps.push(Setup::Change {
                at: self.base() + 0x20 + 4 * (self.bit / 8),
                clear: 0xF << shift,
                set: function << shift,
            });
        }
        let kind = match mode {
            Mode::Input(_) => 0,
            Mode::Output(_) => 1,
            Mode::Sends(_) | Mode::Receives(_) => 2,
            Mode::Analog => 3,
        };
        steps.push(two(self.base(), kind));
    }
}

impl Wiring {
    /// Register writes that set up the pins of the description: clocks first.
    pub fn setup(&self) -> Vec<Setup> {
        let mut steps: Vec<Setup> = Vec::new();
        for (pin, _) in &self.uses {
            for clock in pin.clock() {
                if !steps.contains(&clock) {
                    steps.push(clock);
                }
            }
        }
        steps.extend(self.uses.iter().flat_map(|(pin, mode)| pin.set_up(*mode)));
        steps
    }
}

impl Reader<'_> {
    /// Notes what a pin is wired to, and how it is set up.
    fn pin(
        &self,
        place: usize,
        terminal: &str,
        name: &str,
        mode: Mode,
        uncertain: Option<String>,
    ) -> Result<Pin, BoardError> {
        let mut wiring = self.wiring.borrow_mut();
        let Some(chip) = wiring.chip else {
            let what = "a pin has a name only where `chip` says whose it is; write `at` and `bit`";
            return Err(self.wrong(place, what.to_string()));
        };
        let Some(pin) = chip.pin(name) else {
            let example = chip.example();
            let what = format!("`{name}` is not a pin: write for example {example}");
            return Err(self.wrong(place, what));
        };
        if wiring.uses.iter().any(|(other, _)| *other == pin) {
            let what = format!("{name} is used twice");
            return Err(self.wrong(place, what));
        }
        let uncertain = uncertain.or_else(|| wiring.uncertain.clone());
        wiring.named.push(NamedPin {
            terminal: terminal.to_string(),
            pin: name.to_string(),
            uncertain,
        });
        wiring.uses.push((pin, mode));
        Ok(pin)
    }

    /// An input, at a place of the description.
    pub(super) fn input(
        &self,
        place: usize,
        terminal: &str,
        format: InputFormat,
    ) -> Result<InputPin, BoardError> {
        match (format.pin, format.at, format.bit) {
            (Some(name), None, None) => {
                let mode = Mode::Input(format.pull);
                let pin = self.pin(place, terminal, &name, mode, format.uncertain)?;
                Ok(pin.input(format.inverted))
            }
            (None, Some(at), Some(bit @ 0..32)) if format.pull.is_none() => Ok(InputPin {
                at,
                bit,
                inverted: format.inverted,
            }),
            (None, Some(_), Some(_)) if format.pull.is_none() => {
                Err(self.wrong(place, "a register has the bits 0 to 31".to_string()))
            }
            _ => {
                let what = "an input has either `pin` (optionally `pull`), or `at` and `bit`";
                Err(self.wrong(place, what.to_string()))
            }
        }
    }

    /// An output, at a place of the description.
    pub(super) fn output(
        &self,
        place: usize,
        terminal: &str,
        format: &Output,
    ) -> Result<OutputPin, BoardError> {
        let Output {
            at,
            off_at,
            bit,
            ref pin,
            inverted,
            on,
            off,
            ..
        } = *format;
        match (pin, at, bit, on, off) {
            (Some(name), None, None, None, None) if off_at.is_none() => {
                let mode = Mode::Output(inverted);
                let uncertain = format.uncertain.clone();
                let pin = self.pin(place, terminal, name, mode, uncertain)?;
                Ok(pin.output(inverted))
            }
            (None, Some(at), Some(bit @ 0..32), None, None) if off_at.is_none() => {
                Ok(OutputPin::Bit { at, bit, inverted })
            }
            (None, Some(at), None, Some(on), Some(off)) if !inverted => Ok(OutputPin::Words {
                on: (at, on),
                off: (off_at.unwrap_or(at), off),
            }),
            _ => Err(self.wrong(
                place,
                "an output has either `pin`, or `at` and `bit` (0 to 31), all optionally `inverted`, or `at`, `on` and `off` (optionally `off_at`)"
                    .to_string(),
            )),
        }
    }

    /// A pin that a peripheral or a converter uses.
    pub(super) fn connect(
        &self,
        place: usize,
        terminal: &str,
        name: &str,
        mode: Mode,
        uncertain: Option<String>,
    ) -> Result<(), BoardError> {
        self.pin(place, terminal, name, mode, uncertain).map(|_| ())
    }
}
