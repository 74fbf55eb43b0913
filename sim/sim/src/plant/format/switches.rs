//! Switches along the way of an axis, and its encoder.

use super::Reader;
use super::raw::{RawAxis, RawEncoder, RawSwitch};
use super::values::TOO_OFTEN;
use crate::plant::marks::{Marks, Switch};
use toml::Spanned;

/// Scale of an axis's lengths.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    pub(super) per_unit: f64,
    pub(super) travel: Option<[f64; 2]>,
}

impl Reader<'_> {
    /// The switches and the encoder of an axis, which switches at most this many times in its unit of length.
    pub(super) fn switches(&mut self, raw: &RawAxis, scale: Scale, fastest: f64) -> Vec<Switch> {
        let mut switches = Vec::new();
        let home = self.home(raw, scale);
        let forward = (&raw.forward_limit, &raw.forward_limit_at);
        let reverse = (&raw.reverse_limit, &raw.reverse_limit_at);
        let forward = self.limit("forward_limit", forward, scale, 1.0);
        let reverse = self.limit("reverse_limit", reverse, scale, -1.0);
        switches.extend([home, forward, reverse].into_iter().flatten());
        switches.extend(self.zero_phase(raw, scale, fastest));
        for switch in &raw.switch {
            switches.extend(self.switch(switch, scale, fastest));
        }
        if let Some(encoder) = &raw.encoder {
            switches.extend(self.encoder(encoder, scale, fastest).into_iter().flatten());
        }
        switches
    }

    /// The home switch; by default, the first twentieth of the travel forward from 0.
    fn home(&mut self, raw: &RawAxis, scale: Scale) -> Option<Switch> {
        let input =
            self.switch_input("home", &raw.home, raw.home_at.as_ref().map(Spanned::span))?;
        let [from, to] = match (&raw.home_at, scale.travel) {
            (Some(at), _) => self.range(at, scale.per_unit)?,
            (None, Some([_, max])) if max > 0.0 => [0.0, max / 20.0],
            (None, _) => {
                let at = raw.home.as_ref().map_or(0, |home| home.span().start);
                let message = "give the range of the home switch with `home_at = [from, to]`, or a `travel` that extends past 0";
                self.report(at, message);
                return None;
            }
        };
        let marks = Marks::Range { from, to };
        Some(Switch { input, marks })
    }

    /// A limit switch at the end of the way in one direction; by default, on in the last hundredth of the travel.
    fn limit(
        &mut self,
        key: &str,
        (input, position): (&Option<Spanned<String>>, &Option<Spanned<f64>>),
        scale: Scale,
        direction: f64,
    ) -> Option<Switch> {
        let named = input.as_ref().map_or(0, |input| input.span().start);
        let input = self.switch_input(key, input, position.as_ref().map(Spanned::span))?;
        let border = match (position, scale.travel) {
            (Some(at), _) => self.length(at, scale.per_unit)?,
            (None, Some([min, max])) => {
                let end = if direction > 0.0 { max } else { min };
                end - direction * (max - min) / 100.0
            }
            (None, None) => {
                let message =
                    format!("give the position of this switch with `{key}_at`, or a `travel`");
                self.report(named, message);
                return None;
            }
        };
        let marks = if direction > 0.0 {
            Marks::Range {
                from: border,
                to: f64::INFINITY,
            }
        } else {
            Marks::Range {
                from: f64::NEG_INFINITY,
                to: border,
            }
        };
        Some(Switch { input, marks })
    }

    /// The input of a switch; `position` is the key that says where it is on, which needs an input.
    fn switch_input(
        &mut self,
        key: &str,
        input: &Option<Spanned<String>>,
        position: Option<std::ops::Range<usize>>,
    ) -> Option<u32> {
        match (input, position) {
            (Some(input), _) => self.input(input),
            (None, Some(position)) => {
                self.report(position.start, format!("this requires `{key}`"));
                None
            }
            (None, None) => None,
        }
    }

    /// The zero phase of a motor: on for a tenth of each turn.
    fn zero_phase(&mut self, raw: &RawAxis, scale: Scale, fastest: f64) -> Option<Switch> {
        let position = raw.zero_phase_every.as_ref().map(Spanned::span);
        let input = self.switch_input("zero_phase", &raw.zero_phase, position)?;
        let Some(every) = &raw.zero_phase_every else {
            let at = raw.zero_phase.as_ref().map_or(0, |name| name.span().start);
            let message = "`zero_phase_every` is missing, the distance per revolution";
            self.report(at, message);
            return None;
        };
        let every = self.period(every, scale.per_unit, fastest)?;
        let marks = Marks::Periodic {
            offset: 0.0,
            width: every / 10.0,
            every,
        };
        Some(Switch { input, marks })
    }

    fn switch(&mut self, raw: &RawSwitch, scale: Scale, fastest: f64) -> Option<Switch> {
        let input = self.input(&raw.input);
        let [from, to] = self.range(&raw.at, scale.per_unit)?;
        let marks = match &raw.every {
            None => Marks::Range { from, to },
            Some(every) => {
                let at = every.span().start;
                let every = self.period(every, scale.per_unit, fastest)?;
                if to - from >= every {
                    self.report(at, "`every` must be longer than the range that repeats");
                    return None;
                }
                Marks::Periodic {
                    offset: from,
                    width: to - from,
                    every,
                }
            }
        };
        Some(Switch {
            input: input?,
            marks,
        })
    }

    /// The two lines of an encoder: A leads when the axis goes forward, and a whole number of cycles ends with both
    /// off.
    fn encoder(&mut self, raw: &RawEncoder, scale: Scale, fastest: f64) -> [Option<Switch>; 2] {
        let inputs = [self.input(&raw.a), self.input(&raw.b)];
        let cycles = match &raw.cycles_per_unit {
            Some(value) => self.positive(value, "cycles_per_unit"),
            None => Some(scale.per_unit),
        };
        let Some(every) = cycles.map(|cycles| scale.per_unit / cycles) else {
            return [None; 2];
        };
        if every * fastest < 1.0 {
            let at = raw.cycles_per_unit.as_ref().map_or(0, |c| c.span().start);
            self.report(at, TOO_OFTEN);
            return [None; 2];
        }
        let line = |input: Option<u32>, offset: f64| {
            let marks = Marks::Periodic {
                offset,
                width: every / 2.0,
                every,
            };
            input.map(|input| Switch { input, marks })
        };
        [line(inputs[0], every / 4.0), line(inputs[1], every / 2.0)]
    }
}
