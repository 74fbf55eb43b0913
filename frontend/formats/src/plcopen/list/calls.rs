//! Functions and blocks that a list calls: `FX_` functions, which are instructions, and TON.

use super::blocks;
use super::source::Line;
use super::{Accumulator, Branched, Fault, KEPT, List};
use crate::plcopen::logic::{Contact, Logic, Part};
use crate::plcopen::variables;
use smol_str::format_smolstr;

/// The name and the parameters of a call: `Delay(IN := Start, PT := T#5s)`.
fn parameters(written: &str) -> (&str, Vec<(String, &str)>) {
    let (name, rest) = written.split_once('(').unwrap_or((written, ""));
    let inside = rest.rsplit_once(')').map_or(rest, |(inside, _)| inside);
    let named = inside.split(',').filter_map(|part| part.split_once(":="));
    let named = named.map(|(name, value)| (name.trim().to_ascii_uppercase(), value.trim()));
    (name.trim(), named.collect())
}

/// Operands between commas; those in texts do not count.
fn operands(written: &str) -> Vec<&str> {
    let mut in_text = false;
    let between = |c: char| {
        in_text ^= c == '"';
        c == ',' && !in_text
    };
    let all = written.split(between).map(str::trim);
    all.filter(|operand| !operand.is_empty()).collect()
}

impl List<'_, '_, '_> {
    /// Finds the timers that the list calls.
    pub(super) fn find_blocks(&mut self, lines: &[Line]) {
        let codes = lines.iter().filter_map(|line| match line {
            Line::Code(code) => code.trim().split_once(char::is_whitespace),
            Line::Comment(_) => None,
        });
        let calls = codes.filter(|(operator, _)| operator.eq_ignore_ascii_case("CAL"));
        for (_, call) in calls {
            let (name, given) = parameters(call);
            let preset = given.iter().find(|(name, _)| name == "PT");
            let (Some((_, preset)), true) = (preset, self.is_timer(name)) else {
                continue;
            };
            let found = blocks::on_delay(self.reader, self.body, name, preset);
            let found = found.and_then(|(instance, _)| {
                let instances = &mut self.reader.instances;
                match instances.insert(name.to_uppercase(), instance) {
                    None => Ok(()),
                    Some(_) => {
                        let what = format!("`{name}` is called twice");
                        let help = "give each block its own instance";
                        Err(Fault::at(self.body, what, help))
                    }
                }
            });
            if let Err(fault) = found {
                self.reader.report(fault);
            }
        }
    }

    fn is_timer(&self, name: &str) -> bool {
        use variables::Kind;
        let kind = self.reader.variables.kind(name);
        matches!(kind, Some(Kind::Block(kind)) if kind == "TON")
    }

    /// Calls a timer: `CAL Delay(IN := Start, PT := T#5s)`, or without IN after `ST Delay.IN`.
    pub(super) fn call(&mut self, written: &str, code: &str) -> Result<(), Fault> {
        let (name, given) = parameters(written);
        if !self.is_timer(name) {
            return Err(self.foreign(code));
        }
        let stored = self.inputs.remove(&name.to_uppercase());
        let value = |wanted: &str| given.iter().find(|(name, _)| name == wanted);
        let input = match (value("IN"), stored) {
            (Some((_, input)), _) => {
                let element = self.element();
                super::bit(self.reader, self.body, element, true, input)?
            }
            (None, Some(stored)) => stored,
            (None, None) => return Err(self.foreign(code)),
        };
        let Some((_, preset)) = value("PT") else {
            return Err(self.foreign(code));
        };
        let (instance, count) = blocks::on_delay(self.reader, self.body, name, preset)?;
        if let Some(timer) = instance.bit("Q") {
            let line = format_smolstr!("OUT {timer} K{count}");
            self.reader.output(input, line);
        }
        Ok(())
    }

    /// An instruction that only rungc knows: `FX_LDP(p1 := X000)` gives a bit, `FX_ZRST D0, D9` is driven by the result
    /// and keeps it.
    pub(super) fn function(
        &mut self,
        mnemonic: &str,
        written: &str,
        code: &str,
    ) -> Result<(), Fault> {
        if let ("MEP" | "MEF", "") = (mnemonic, written) {
            self.result = Accumulator::Flow(self.flow(code)?.changed(mnemonic));
            return Ok(());
        }
        if !written.starts_with('(') {
            let enable = self.flow(code)?;
            blocks::drive(self.reader, enable, mnemonic, &operands(written));
            return Ok(());
        }
        if self.deferred.is_empty() {
            self.remark();
        }
        let Some(sense) = blocks::contact(mnemonic) else {
            return Err(self.foreign(code));
        };
        let (_, given) = parameters(written);
        let mut words = Vec::new();
        for (nth, (name, value)) in (1..).zip(&given) {
            if *name != format!("P{nth}") {
                return Err(self.foreign(code));
            }
            let is_part =
                value.contains('.') && self.is_timer(value.split('.').next().unwrap_or_default());
            words.push(match is_part {
                true => self.reader.bit(self.body, value)?.to_string(),
                false => (*value).to_owned(),
            });
        }
        if words.is_empty() {
            return Err(self.foreign(code));
        }
        self.result = Accumulator::Flow(Logic::Contact(Contact {
            element: self.element(),
            sense,
            operands: words.join(" ").into(),
        }));
        Ok(())
    }

    /// Keeps the result where it is stored in a variable for branches, or in the input of a timer.
    pub(super) fn keep(&mut self, to: &str, negated: bool, logic: &Logic) -> bool {
        if negated {
            return false;
        }
        if to.starts_with(KEPT) {
            let kept = Branched {
                logic: logic.clone(),
                parts: self.reader.parts.len(),
                is_read: true,
            };
            self.kept.insert(to.to_owned(), kept);
            return true;
        }
        let input = to
            .rsplit_once('.')
            .filter(|(_, part)| part.eq_ignore_ascii_case("IN"));
        let timer = input
            .map(|(timer, _)| timer)
            .filter(|timer| self.is_timer(timer));
        if let Some(timer) = timer {
            self.inputs.insert(timer.to_uppercase(), logic.clone());
        }
        timer.is_some()
    }

    /// Takes up a result that was kept for branches, if the operand is one: only outputs of its network may be between.
    pub(super) fn continues(&mut self, operand: &str) -> Result<bool, Fault> {
        let Some(kept) = self.kept.get(operand) else {
            return Ok(false);
        };
        if !kept.is_read {
            self.result = Accumulator::Unread;
            return Ok(true);
        }
        let first = kept.logic.first();
        let since = &self.reader.parts[kept.parts..];
        let follows =
            |part: &Part| matches!(part, Part::Output(output) if output.logic.first() == first);
        if !since.iter().all(follows) {
            let what = format!("`{operand}` keeps a result of another network");
            let help = "use a variable with another name";
            return Err(Fault::at(self.body, what, help));
        }
        self.result = Accumulator::Flow(kept.logic.clone());
        Ok(true)
    }
}
