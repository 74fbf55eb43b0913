//! Reading the steps of a case.

use super::format::Reader;
use super::raw::{Map, RawCount, RawEncoder, RawPulses, RawStep, Scalar};
use super::rules::RawOverTime;
use super::serial::{RawMode, Switch, Way};
use super::values::integer;
use super::{Run, Setting, Step};
use crate::target::Target;
use crate::wire::Signal;
use rungc_rt::Clock;
use rungc_syntax::{DeviceClass, diag};
use toml::Spanned;

/// Maximum number of scans or milliseconds of a step: more than a day.
const LONGEST: u32 = 100_000_000;

impl Reader<'_> {
    /// The steps that a step stands for: those of the scenario that it names, and itself.
    pub(super) fn steps(&mut self, raw: Vec<Spanned<RawStep>>) -> Vec<Step> {
        let mut steps = Vec::new();
        for raw in raw {
            if let Some(name) = &raw.get_ref().scenario {
                let of_scenario = self.scenario(name);
                steps.extend(of_scenario);
            }
            let step = self.step(raw);
            steps.push(step);
        }
        steps
    }

    /// The steps of a scenario, with the values of the row at hand.
    fn scenario(&mut self, name: &Spanned<String>) -> Vec<Step> {
        let known = self.scenarios.iter();
        let mut known = known.take(self.scenarios_known);
        let Some(at) = known.position(|scenario| scenario.name.get_ref() == name.get_ref()) else {
            let names = self.scenarios.iter().take(self.scenarios_known);
            let near = diag::did_you_mean(name.get_ref(), names.map(|s| s.name.get_ref().as_str()));
            let near = near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
            let message = format!(
                "no scenario `{}` is defined before this{near}",
                name.get_ref()
            );
            self.report(name.span().start, message);
            return Vec::new();
        };
        // A scenario names only those before it, so this ends.
        let raw = self.scenarios[at].step.clone();
        let outer = std::mem::replace(&mut self.scenarios_known, at);
        let steps = self.steps(raw);
        self.scenarios_known = outer;
        steps
    }

    /// Length of a step, and the condition that ends it early.
    fn length(&mut self, raw: &RawStep) -> (Run, Vec<Setting>) {
        let until = self.expected(raw.until.clone());
        let given = [&raw.scans, &raw.run_ms, &raw.at_most_ms];
        let mut given = given.into_iter().flatten();
        if let (Some(_), Some(second)) = (given.next(), given.next()) {
            let message = match raw.at_most_ms {
                Some(_) => "use one of `scans`, `run_ms` and `at_most_ms` in a step",
                None => "use `scans` or `run_ms` in a step, not both",
            };
            self.report(second.span().start, message.to_string());
        }
        let mut count = |given: &Option<Spanned<RawCount>>| {
            let given = given.as_ref()?;
            let count = self.count(given).unwrap_or(1);
            if count > LONGEST {
                let message = format!("a step takes at most {LONGEST} scans or milliseconds");
                self.report(given.span().start, message);
            }
            Some(count)
        };
        let (scans, ms, at_most) = (
            count(&raw.scans),
            count(&raw.run_ms),
            count(&raw.at_most_ms),
        );
        if let (Some((name, _)), None) = (raw.until.first_key_value(), at_most) {
            let message = "`until` needs `at_most_ms`, the time after which the step fails";
            self.report(name.span().start, message.to_string());
        }
        if let (true, Some(at_most)) = (raw.until.is_empty(), &raw.at_most_ms) {
            let message = "`at_most_ms` needs `until`, what the step waits for";
            self.report(at_most.span().start, message.to_string());
        }
        let run = match (ms.or(at_most), scans) {
            (Some(ms), _) => Run::Ms(ms),
            (None, Some(scans)) => Run::Scans(scans),
            (None, None) => Run::Scans(raw.scenario.is_none().into()),
        };
        (run, until)
    }

    /// A whole number, perhaps of the row at hand.
    pub(super) fn count(&mut self, raw: &Spanned<RawCount>) -> Option<u32> {
        let name = match raw.get_ref() {
            RawCount::Number(count) => return Some(*count),
            RawCount::Name(name) => Scalar::Text(name.clone()),
        };
        let at = raw.span().start;
        let value = self.of_row(&name, at);
        let count = match value {
            Scalar::Integer(value) => value.try_into().ok(),
            Scalar::Float(_) | Scalar::Text(_) | Scalar::Near(_) => None,
        };
        if count.is_none() {
            self.report(
                at,
                "this value must be a whole number from 0 to 4294967295".to_string(),
            );
        }
        count
    }

    pub(super) fn step(&mut self, raw: Spanned<RawStep>) -> Step {
        let at = raw.span().start;
        let raw = raw.into_inner();
        let (run, until) = self.length(&raw);
        let scan_ms = match raw.scan_ms {
            Some(ms) => match self.count(&ms) {
                Some(count @ 1..=32_767) => count,
                Some(_) => {
                    self.report(ms.span().start, "`scan_ms` is 1 to 32767".to_string());
                    10
                }
                None => 10,
            },
            None => 10,
        };
        let mut rx = Vec::new();
        for (port, text) in raw.rx.into_iter().flatten() {
            let port = self.line_text(&port, Way::ToPlc, std::slice::from_ref(&text));
            rx.extend(port.map(|port| {
                let items = port.id.items(&text);
                (port, items)
            }));
        }
        let mut expect_tx = Vec::new();
        for (port, sent) in raw.expect_tx.into_iter().flatten() {
            if sent.texts().is_empty() {
                let message = "the list has no text, so that nothing matches".to_string();
                self.report(port.span().start, message);
            }
            let port = self.line_text(&port, Way::FromPlc, sent.texts());
            let texts = sent.texts().iter();
            expect_tx.extend(port.map(|port| {
                let sent = texts.map(|text| port.id.sent(text)).collect();
                (port, sent)
            }));
        }
        let cut = raw
            .cut
            .map(|cut| cut.iter().filter_map(|port| self.port(port)).collect());
        Step {
            line: self.line(at),
            power_cycle: raw.power_cycle,
            running: raw.mode.map_or(Vec::new(), |mode| self.mode(&mode)),
            rx,
            expect_tx,
            cut,
            power_fails: raw.power_fails,
            clock: raw.clock.and_then(|text| self.clock(&text)),
            bfm: self.buffer(raw.bfm),
            answers_after: self.delays(raw.answers_after),
            analog: self.analog(raw.analog),
            set: self.settings(raw.set),
            signals: self.signals(raw.pulses.unwrap_or_default(), raw.encoder),
            run,
            until,
            scan_ms,
            expect: self.expected(raw.expect),
            within: raw
                .within
                .into_iter()
                .filter_map(|w| self.within(w))
                .collect(),
            rules: self.rules(RawOverTime {
                never: raw.never,
                whenever: raw.whenever,
                ..RawOverTime::default()
            }),
            expect_bfm: self.buffer(raw.expect_bfm),
            expect_position: raw.expect_position.into_iter().collect(),
        }
    }

    /// Positions of the PLCs' RUN/STOP switches.
    fn mode(&mut self, mode: &Spanned<RawMode>) -> Vec<(usize, bool)> {
        match mode.get_ref() {
            RawMode::All(switch) => {
                let all = 0..=self.others.len();
                all.map(|plc| (plc, *switch == Switch::Run)).collect()
            }
            RawMode::Of(switches) => {
                let mut running = Vec::new();
                for (name, switch) in switches {
                    match self.others.iter().position(|other| other == name) {
                        Some(i) => running.push((i + 1, *switch == Switch::Run)),
                        None => {
                            let message = format!("the case has no PLC `{name}`");
                            self.report(mode.span().start, message);
                        }
                    }
                }
                running
            }
        }
    }

    /// Signals at input terminals.
    fn signals(&mut self, pulses: Map<RawPulses>, encoder: Option<RawEncoder>) -> Vec<Signal> {
        let mut signals = Vec::new();
        for (name, RawPulses { count, hz }) in pulses {
            if let Some(input) = self.terminal(&name)
                && self.frequency(&name, hz)
            {
                signals.push(Signal::Pulses { input, count, hz });
            }
        }
        if let Some(RawEncoder { a, b, count, hz }) = encoder
            && let (Some(first), Some(second)) = (self.terminal(&a), self.terminal(&b))
            && self.frequency(&a, hz)
        {
            if first == second {
                let message = "the phases of an encoder have two terminals".to_string();
                self.report(b.span().start, message);
            }
            signals.push(Signal::Encoder {
                a: first,
                b: second,
                count,
                hz,
            });
        }
        signals
    }

    fn terminal(&mut self, name: &Spanned<String>) -> Option<u32> {
        match self.target(name)? {
            (_, Target::Bit(DeviceClass::X, number)) => Some(number),
            _ => {
                let message = format!("`{}` is not an input terminal", name.get_ref());
                self.report(name.span().start, message);
                None
            }
        }
    }

    fn frequency(&mut self, name: &Spanned<String>, hz: f64) -> bool {
        let fits = (0.001..=1_000_000.0).contains(&hz);
        if !fits {
            let message = "`hz` is 0.001 to 1000000".to_string();
            self.report(name.span().start, message);
        }
        fits
    }

    /// A 16-bit value.
    fn word(&mut self, value: &Spanned<Scalar>) -> Option<i16> {
        let given = self.of_row(value.get_ref(), value.span().start);
        let word = integer(&given)
            .filter(|v| (-0x8000..=0xffff).contains(v))
            .map(|v| v as i16);
        if word.is_none() {
            let message = "this value must be a 16-bit integer".to_string();
            self.report(value.span().start, message);
        }
        word
    }

    fn buffer(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<(u16, u16, i16)> {
        raw.into_iter()
            .filter_map(|(name, value)| {
                let place = name.get_ref().split_once(':');
                let place = place.and_then(|(u, a)| Some((u.parse().ok()?, a.parse().ok()?)));
                let Some((unit, address)) = place else {
                    let message = "write a word of buffer memory as `MODULE:ADDRESS`".to_string();
                    self.report(name.span().start, message);
                    return None;
                };
                Some((unit, address, self.word(&value)?))
            })
            .collect()
    }

    fn analog(&mut self, raw: Map<Spanned<Scalar>>) -> Vec<(u8, i16)> {
        raw.into_iter()
            .filter_map(|(name, value)| {
                let channel = name.get_ref().strip_prefix("AD");
                let Some(channel) = channel.and_then(|n| n.parse().ok()) else {
                    let message = "write an analog input as `AD0`, `AD1`, …".to_string();
                    self.report(name.span().start, message);
                    return None;
                };
                Some((channel, self.word(&value)?))
            })
            .collect()
    }

    fn clock(&mut self, text: &Spanned<String>) -> Option<Clock> {
        let clock = clock(text.get_ref());
        if clock.is_none() {
            let message = "write a time as `2026-01-02T03:04:05`".to_string();
            self.report(text.span().start, message);
        }
        clock
    }
}

/// Reads `2026-01-02T03:04:05`.
fn clock(text: &str) -> Option<Clock> {
    let (date, time) = text.split_once('T')?;
    let mut date = date.splitn(3, '-');
    let (year, month, day) = (date.next()?, date.next()?, date.next()?);
    let mut time = time.splitn(3, ':');
    let (hour, minute, second) = (time.next()?, time.next()?, time.next()?);
    Clock::new(
        year.parse().ok()?,
        month.parse().ok()?,
        day.parse().ok()?,
        hour.parse().ok()?,
        minute.parse().ok()?,
        second.parse().ok()?,
    )
}
