//! Sources of the ladder's cells, and their values in a running program.

use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Lower, Shape as Kind};
use rungc_ir::ResetStates;
use rungc_ladder::layout::Cell;
use rungc_ladder::{InstrIndex, Shape};
use rungc_rt::{Class, CmpOp, Plc};
use rungc_sim::Target;
use rungc_sim::record::{Reading, Seen};
use rungc_syntax::{Device, DeviceClass, Index, OperandKind};
use std::fmt::Write as _;

/// Source named by an operand.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Source {
    /// A device, or those that an index leads to.
    Target(Target, Option<Index>),
    /// A bit of a word.
    WordBit(DeviceClass, u32, u8, Option<Index>),
    /// A constant.
    Constant(i64, Option<Index>),
}

impl Source {
    /// Source named by an operand, as a value of 32 bits if it is `wide`.
    fn of(operand: &OperandKind, kind: Kind, wide: bool) -> Option<Source> {
        let pair = match kind {
            Kind::Value => wide,
            Kind::Pair | Kind::Float => true,
            Kind::Bit | Kind::Word | Kind::Text | Kind::Pointer | Kind::Mixed => false,
        };
        Some(match *operand {
            OperandKind::Device(device, index) => {
                Source::Target(target(device, kind, pair)?, index)
            }
            OperandKind::WordBit(device, bit, index) => {
                Source::WordBit(device.class, device.number, bit, index)
            }
            OperandKind::Nibbles(digits @ 1..=8, device, index) => {
                Source::Target(Target::Nibbles(digits, device.class, device.number), index)
            }
            OperandKind::Decimal(value, index) => Source::Constant(value, index),
            OperandKind::Hex(value, index) => {
                let value = match pair {
                    true => i64::from(value as u32 as i32),
                    false => i64::from(value as u16 as i16),
                };
                Source::Constant(value, index)
            }
            OperandKind::Nibbles(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => return None,
        })
    }

    /// Its value; `None` if an index leads to a device that does not exist.
    fn read(self, seen: Seen) -> Option<Reading> {
        let offset = |index| offset(index, seen);
        match self {
            Source::Target(target, None) => Reading::of(seen, target),
            Source::Target(target, index) => {
                Reading::of(seen, shifted(target, offset(index).into())?)
            }
            Source::WordBit(class, number, bit, index) => {
                let word = shifted(Target::Word(class, number), offset(index).into())?;
                match Reading::of(seen, word)? {
                    Reading::Integer(value, _) => Some(Reading::Bit(value >> bit & 1 == 1)),
                    Reading::Bit(_) | Reading::Float(_) | Reading::Text(_) => None,
                }
            }
            Source::Constant(value, index) => {
                Some(Reading::Integer(value + i64::from(offset(index)), 32))
            }
        }
    }

    /// Returns true if it is a bit that is on.
    pub(crate) fn is_on(self, seen: Seen) -> bool {
        self.read(seen) == Some(Reading::Bit(true))
    }

    /// Returns true if it is a timer or counter that RST holds at 0, as far as its reset state has a memory.
    fn is_reset(self, seen: Seen, resets: &ResetStates) -> bool {
        let target = match self {
            Source::Target(target @ Target::Current(..), index) => {
                shifted(target, offset(index, seen).into())
            }
            _ => None,
        };
        let state = match target {
            Some(Target::Current(class, number)) => resets.get(class, number),
            _ => None,
        };
        state.is_some_and(|state| seen.machine.is_held(state))
    }

    /// Returns true if its value is worth showing: bits are seen in the ladder, and constants are written there.
    fn is_shown(self) -> bool {
        match self {
            Source::Target(Target::Bit(..), _) | Source::WordBit(..) | Source::Constant(..) => {
                false
            }
            Source::Target(..) => true,
        }
    }
}

/// A bit device, or a value in the shape that an instruction takes.
fn target(Device { class, number }: Device, kind: Kind, pair: bool) -> Option<Target> {
    use DeviceClass::{C, D, ER, M, R, S, T, V, X, Y, Z};
    Some(match class {
        X | Y | M | S => Target::Bit(class, number),
        T | C if kind == Kind::Bit => Target::Bit(class, number),
        T | C => Target::Current(class, number),
        D | R | ER if kind == Kind::Float => Target::Float(class, number),
        D | R | ER if pair => Target::Pair(class, number),
        D | R | ER | V | Z => Target::Word(class, number),
        _ => return None,
    })
}

/// The value of an index.
fn offset(index: Option<Index>, seen: Seen) -> i16 {
    let Some(index) = index else {
        return 0;
    };
    let class = match index.class {
        DeviceClass::V => Class::V,
        _ => Class::Z,
    };
    seen.machine.word(class, index.number).unwrap_or(0)
}

/// The device to which an index leads.
fn shifted(target: Target, offset: i64) -> Option<Target> {
    let add = |number: u32| u32::try_from(i64::from(number) + offset).ok();
    Some(match target {
        Target::Bit(class, n) => Target::Bit(class, add(n)?),
        Target::Word(class, n) => Target::Word(class, add(n)?),
        Target::Current(class, n) => Target::Current(class, add(n)?),
        Target::Pair(class, n) => Target::Pair(class, add(n)?),
        Target::Float(class, n) => Target::Float(class, add(n)?),
        Target::Text(class, n) => Target::Text(class, add(n)?),
        Target::Nibbles(digits, class, n) => Target::Nibbles(digits, class, add(n)?),
        Target::Pulses(n) => Target::Pulses(add(n)?),
        Target::Frequency(n) => Target::Frequency(add(n)?),
        Target::Channel(_) => return None,
    })
}

/// Effect of a cell on the power from its left.
#[derive(Clone, PartialEq, Debug)]
pub(crate) enum Probe {
    /// Lets it through while a device is on, or off.
    Contact { bit: Source, closed: bool },
    /// Lets it through in the scan in which a device has changed.
    Edge { bit: Source, rising: bool },
    /// Lets it through while a comparison holds.
    Compare(CmpOp, [Source; 2]),
    /// Inverts it.
    Invert,
    /// Lets it through in the scan in which it came, or in which it went.
    Pulse { rising: bool },
    /// Takes it: a coil, or a box that is about one bit, with the device whose state is shown.
    Coil(Source),
    /// Takes it: a box, which shows whether it is driven.
    Box,
    /// Lets nothing through: what it works with is not known.
    Unknown,
}

/// A cell: what it does, and the values that it shows.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Watched {
    pub(crate) probe: Probe,
    values: Vec<(String, Source)>,
}

impl Watched {
    /// Sources and probe of a program's cell.
    pub(crate) fn of(resolved: &Resolved, cell: Cell) -> Watched {
        let plain = |probe| Watched {
            probe,
            values: Vec::new(),
        };
        match cell {
            Cell::Contact(contact) if contact.shape == Shape::Compare => {
                let sources = sources(resolved, contact.instr);
                let values = [0, 1].map(|i| sources.get(i).and_then(|(_, source)| *source));
                let probe = match (resolved.instrs[contact.instr].lower, values) {
                    (Some(Lower::Compare(_, op)), [Some(a), Some(b)]) => Probe::Compare(op, [a, b]),
                    _ => Probe::Unknown,
                };
                Watched {
                    probe,
                    values: shown(sources),
                }
            }
            Cell::Contact(contact) => {
                let operand = resolved.program.instrs[contact.instr].operands.first();
                let bit = operand.and_then(|o| Source::of(&o.kind, Kind::Bit, false));
                plain(match (bit, contact.shape) {
                    (Some(bit), Shape::Open) => Probe::Contact { bit, closed: false },
                    (Some(bit), Shape::Closed) => Probe::Contact { bit, closed: true },
                    (Some(bit), Shape::Rising) => Probe::Edge { bit, rising: true },
                    (Some(bit), Shape::Falling) => Probe::Edge { bit, rising: false },
                    (_, Shape::Compare) | (None, _) => Probe::Unknown,
                })
            }
            Cell::Result(instr) => plain(match resolved.instrs[instr].basic() {
                Some(Basic::Inv) => Probe::Invert,
                Some(Basic::Mep) => Probe::Pulse { rising: true },
                Some(Basic::Mef) => Probe::Pulse { rising: false },
                _ => Probe::Unknown,
            }),
            Cell::Output(output) => {
                let sources = sources(resolved, output.instr);
                let operands = &resolved.program.instrs[output.instr].operands;
                let first = operands.first();
                let bit = first.and_then(|o| Source::of(&o.kind, Kind::Bit, false));
                // The coil of a timer or counter is on while it is driven, not while its contact is closed.
                let is_bit = match bit {
                    Some(Source::Target(Target::Bit(class, _), _)) => {
                        !matches!(class, DeviceClass::T | DeviceClass::C)
                    }
                    Some(Source::WordBit(..)) => true,
                    _ => false,
                };
                let mut values = shown(sources);
                if output.coil
                    && let Some(operand) = first
                    && let Some(value) = Source::of(&operand.kind, Kind::Value, false)
                    && value.is_shown()
                {
                    // A timer's or counter's coil shows how far it is.
                    values.retain(|(_, source)| *source != value);
                    values.insert(0, (operand.kind.to_string(), value));
                }
                let probe = match bit {
                    Some(bit) if is_bit && (output.coil || operands.len() == 1) => Probe::Coil(bit),
                    _ => Probe::Box,
                };
                Watched { probe, values }
            }
            Cell::FoldOut(_) | Cell::FoldIn(_) => plain(Probe::Unknown),
        }
    }

    /// The values as they are now: `D0=5 D2=7`; of a timer or counter that RST holds `C0=0 (reset)`.
    pub(crate) fn values(&self, seen: Seen, resets: &ResetStates) -> String {
        let mut text = String::new();
        for (name, source) in &self.values {
            let separator = if text.is_empty() { "" } else { " " };
            let value = source.read(seen);
            let value = value.map_or_else(|| "?".to_string(), |value| value.to_string());
            let reset = if source.is_reset(seen, resets) {
                " (reset)"
            } else {
                ""
            };
            let _ = write!(text, "{separator}{name}={value}{reset}");
        }
        text
    }

    /// Returns true if it shows values.
    pub(crate) fn has_values(&self) -> bool {
        !self.values.is_empty()
    }
}

/// The operands of an instruction, by their names, and what each is.
fn sources(resolved: &Resolved, instr: InstrIndex) -> Vec<(String, Option<Source>)> {
    let resolution = &resolved.instrs[instr];
    let operands = resolved.program.instrs[instr].operands.iter();
    let source = |(operand, param): (&rungc_syntax::Operand, &rungc_catalogue::Param)| {
        let source = match param.shape {
            Kind::Pointer | Kind::Text => None,
            shape => Source::of(&operand.kind, shape, resolution.form.wide),
        };
        (operand.kind.to_string(), source)
    };
    operands.zip(resolution.params).map(source).collect()
}

/// Sources that are worth showing, each once.
fn shown(sources: Vec<(String, Option<Source>)>) -> Vec<(String, Source)> {
    let mut shown: Vec<(String, Source)> = Vec::new();
    for (name, source) in sources {
        if let Some(source) = source.filter(|source| source.is_shown())
            && shown.iter().all(|(_, other)| *other != source)
        {
            shown.push((name, source));
        }
    }
    shown
}

/// Returns true if a comparison holds; it does not if an operand does not exist.
pub(crate) fn holds(op: CmpOp, values: [Source; 2], seen: Seen) -> bool {
    let number = |source: Source| match source.read(seen)? {
        Reading::Integer(value, _) => Some(value as f64),
        Reading::Float(value) => Some(value),
        Reading::Bit(_) | Reading::Text(_) => None,
    };
    let [a, b] = values.map(number);
    a.zip(b).is_some_and(|(a, b)| op.holds(a, b))
}
