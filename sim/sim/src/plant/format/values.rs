//! Terminals, lengths, speeds and times, each within its limits.

use super::{Reader, Terminal};
use crate::target::Target;
use rungc_syntax::DeviceClass;
use toml::Spanned;

/// The longest time of a cylinder or delay, in milliseconds: an hour.
const LONGEST_MS: u32 = 3_600_000;

/// The greatest speed of an axis and of what it makes of it at an input: a million a second.
pub(super) const FASTEST: f64 = 1_000_000.0;

/// The shortest length after which something comes again.
const SHORTEST: f64 = 1e-6;

/// The greatest length, in pulses or units: beyond the 32 bits that a PLC counts.
const LONGEST: f64 = 1e10;

pub(super) const TOO_OFTEN: &str =
    "this occurs more than 10 times per pulse, or a million times per second";

impl Reader<'_> {
    /// A terminal of this class, by its name.
    pub(super) fn terminal(&mut self, name: &Spanned<String>, class: DeviceClass) -> Option<u32> {
        match Target::parse(&name.get_ref().to_uppercase()) {
            Ok(Target::Bit(found, number)) if found == class => Some(number),
            Err(message) => {
                self.report(name.span().start, message);
                None
            }
            _ => {
                let (what, example) = match class {
                    DeviceClass::X => ("input", "X000"),
                    _ => ("output", "Y000"),
                };
                let message = format!(
                    "`{}` is not an {what}; write for example `{example}`",
                    name.get_ref()
                );
                self.report(name.span().start, message);
                None
            }
        }
    }

    pub(super) fn output(&mut self, name: &Spanned<String>) -> Option<u32> {
        let number = self.terminal(name, DeviceClass::Y)?;
        self.terminals.push(Terminal {
            class: DeviceClass::Y,
            number,
            at: name.span().start,
        });
        Some(number)
    }

    /// An input, which nothing else drives.
    pub(super) fn input(&mut self, name: &Spanned<String>) -> Option<u32> {
        let (class, at) = (DeviceClass::X, name.span().start);
        let number = self.terminal(name, class)?;
        let other = self
            .terminals
            .iter()
            .find(|t| (t.class, t.number) == (class, number));
        if let Some(other) = other {
            let line = self.source.line_col(other.at as u32).0;
            let message = format!("`{}` is already driven in line {line}", name.get_ref());
            self.report(at, message);
            return None;
        }
        self.terminals.push(Terminal { class, number, at });
        Some(number)
    }

    /// A length in pulses, of one that is given in units.
    pub(super) fn length(&mut self, value: &Spanned<f64>, per_unit: f64) -> Option<f64> {
        let length = value.get_ref() * per_unit;
        if length.abs() <= LONGEST {
            return Some(length);
        }
        self.report(value.span().start, "this length is too large");
        None
    }

    pub(super) fn range(&mut self, value: &Spanned<Vec<f64>>, per_unit: f64) -> Option<[f64; 2]> {
        let at = value.span().start;
        let &[from, to] = value.get_ref().as_slice() else {
            self.report(at, "write this as [from, to]");
            return None;
        };
        let [from, to] = [from, to].map(|value| value * per_unit);
        if !(from.abs() <= LONGEST && to.abs() <= LONGEST) {
            self.report(at, "this length is too large");
            return None;
        }
        if from >= to {
            self.report(at, "write [from, to], the smaller number first");
            return None;
        }
        Some([from, to])
    }

    pub(super) fn positive(&mut self, value: &Spanned<f64>, key: &str) -> Option<f64> {
        let fits = (1e-6..=FASTEST).contains(value.get_ref());
        if !fits {
            let message = format!("`{key}` is 0.000001 to {FASTEST}");
            self.report(value.span().start, message);
        }
        fits.then_some(*value.get_ref())
    }

    /// A length after which something comes again.
    pub(super) fn period(
        &mut self,
        value: &Spanned<f64>,
        per_unit: f64,
        fastest: f64,
    ) -> Option<f64> {
        let every = value.get_ref() * per_unit;
        let fits = every * fastest >= 1.0 && (SHORTEST..=LONGEST).contains(&every);
        if !fits {
            let message = match every > 0.0 {
                true if every > LONGEST => "this length is too large",
                true => TOO_OFTEN,
                false => "this length must be above 0",
            };
            self.report(value.span().start, message);
        }
        fits.then_some(every)
    }

    pub(super) fn time(&mut self, value: &Spanned<u32>, least: u32) -> Option<u32> {
        let fits = (least..=LONGEST_MS).contains(value.get_ref());
        if !fits {
            let message = format!("this time must be {least} to {LONGEST_MS} ms");
            self.report(value.span().start, message);
        }
        fits.then_some(*value.get_ref())
    }
}
