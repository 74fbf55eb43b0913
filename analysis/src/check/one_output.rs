//! Instructions that send pulses through one output at the same time.

use super::Code;
use super::drives::{Drive, Lasts};
use super::skips::Skips;
use super::structure::{Places, Routine};
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes};
use rustc_hash::FxHashMap;

/// The routine, the state and the jumps that decide whether an instruction runs.
type Place = (Routine, u32, u64);

/// The instructions that send pulses through one output.
#[derive(Default)]
struct Senders {
    /// The first under each drive.
    driven: FxHashMap<(Place, u64), usize>,
    /// The first in each place, and the first there that is always driven.
    placed: FxHashMap<Place, (usize, Option<usize>)>,
    /// Two that are driven together.
    together: Option<(usize, usize)>,
}

impl Senders {
    /// Takes instruction `i`.
    fn add(&mut self, i: usize, drive: Drive, place: Place) {
        let always = drive.lasts == Lasts::Always;
        let same = self.driven.get(&(place, drive.signature)).copied();
        let other = match self.placed.get(&place) {
            Some(&(first, _)) if always => Some(first),
            Some(&(_, on)) => on,
            None => None,
        };
        if self.together.is_none() {
            self.together = same.or(other).map(|other| (other, i));
        }
        self.driven.entry((place, drive.signature)).or_insert(i);
        let (_, on) = self.placed.entry(place).or_insert((i, None));
        if always {
            on.get_or_insert(i);
        }
    }
}

/// Collects them by output.
#[derive(Default)]
pub(super) struct Outputs(FxHashMap<Device, Senders>);

impl Outputs {
    /// Takes instruction `i` and what drives it.
    pub(super) fn note(
        &mut self,
        code: &Code,
        i: usize,
        drive: Drive,
        places: &Places,
        skips: &Skips,
    ) {
        let operand = code.params(i).iter().position(|param| param.sends_pulses);
        let output = operand.and_then(|operand| code.device(i, operand));
        let Some(output) = output.filter(|output| output.class == DeviceClass::Y) else {
            return;
        };
        let place = places.of(i);
        let place = (place.routine, place.state, skips.mark(i));
        self.0.entry(output).or_default().add(i, drive, place);
    }

    /// Warns of outputs that two instructions drive under the same condition, or one under any.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        let together = |(output, senders): (_, Senders)| Some((senders.together?, output));
        let mut found: Vec<_> = self.0.into_iter().filter_map(together).collect();
        found.sort_unstable();
        for ((first, second), output) in found {
            let message =
                format!("two instructions send pulses through `{output}` at the same time");
            let diagnostic = codes::ONE_OUTPUT
                .at(code.span(second), message)
                .label("finds the output taken")
                .other(code.span(first), "driven together with this one")
                .help("give them conditions of which one is on at a time");
            out.push(diagnostic);
        }
    }
}
