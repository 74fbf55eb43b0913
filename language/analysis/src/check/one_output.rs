//! Outputs with two purposes: pulses of two instructions at the same time, or pulses and their direction.

use super::Code;
use super::drives::{Drive, Lasts};
use super::skips::Skips;
use super::structure::{Nesting, Routine};
use rungc_catalogue::Param;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes};
use rustc_hash::FxHashMap;

/// Conditions under which an instruction runs: its routine, its state and the jumps over it.
type Conditions = (Routine, u32, u64);

/// The instructions that send pulses through one output.
#[derive(Default)]
struct Senders {
    /// The first under each drive.
    driven: FxHashMap<(Conditions, u64), usize>,
    /// The first under each of these conditions, and the first there that is always driven.
    first_under: FxHashMap<Conditions, (usize, Option<usize>)>,
    /// Two that are driven together.
    together: Option<(usize, usize)>,
}

impl Senders {
    /// Takes instruction `i`.
    fn add(&mut self, i: usize, drive: Drive, conditions: Conditions) {
        let always = drive.lasts == Lasts::Always;
        let same = self.driven.get(&(conditions, drive.signature)).copied();
        let other = match self.first_under.get(&conditions) {
            Some(&(first, _)) if always => Some(first),
            Some(&(_, on)) => on,
            None => None,
        };
        if self.together.is_none() {
            self.together = same.or(other).map(|other| (other, i));
        }
        self.driven
            .entry((conditions, drive.signature))
            .or_insert(i);
        let (_, on) = self.first_under.entry(conditions).or_insert((i, None));
        if always {
            on.get_or_insert(i);
        }
    }
}

/// Collects them by output.
#[derive(Default)]
pub(super) struct Outputs {
    senders: FxHashMap<Device, Senders>,
    /// Instructions whose pulses and direction share an output.
    own_direction: Vec<(usize, Device)>,
}

impl Outputs {
    /// Takes instruction `i` and what drives it.
    pub(super) fn note(
        &mut self,
        code: &Code,
        i: usize,
        drive: Drive,
        nesting: &Nesting,
        skips: &Skips,
    ) {
        let output = |is_meant: fn(&Param) -> bool| {
            let operand = code.params(i).iter().position(is_meant);
            let output = operand.and_then(|operand| code.device(i, operand));
            output.filter(|output| output.class == DeviceClass::Y)
        };
        let Some(sends) = output(|param| param.sends_pulses) else {
            return;
        };
        if output(|param| param.directs_pulses) == Some(sends) {
            self.own_direction.push((i, sends));
        }
        let enclosing = nesting.of(i);
        let conditions = (enclosing.routine, enclosing.state, skips.mark(i));
        self.senders
            .entry(sends)
            .or_default()
            .add(i, drive, conditions);
    }

    /// Warns of outputs that two instructions drive under the same condition, or one under any, and of those that
    /// give pulses and their direction.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        for (i, output) in self.own_direction {
            let message = format!("`{output}` sends pulses and gives their direction");
            let diagnostic = codes::ONE_OUTPUT
                .at(code.span(i), message)
                .help("give the direction by an output that sends no pulses");
            out.push(diagnostic);
        }
        let together = |(output, senders): (_, Senders)| Some((senders.together?, output));
        let mut found: Vec<_> = self.senders.into_iter().filter_map(together).collect();
        found.sort();
        for ((first, second), output) in found {
            let message =
                format!("two instructions send pulses through `{output}` at the same time");
            let diagnostic = codes::ONE_OUTPUT
                .at(code.span(second), message)
                .label("finds the output in use")
                .other(code.span(first), "driven at the same time as this one")
                .help("give them conditions that are never on at the same time");
            out.push(diagnostic);
        }
    }
}
