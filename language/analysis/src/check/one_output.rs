//! Outputs, axes and compare zones with two purposes: two instructions at the same time, or pulses and their direction.

use super::Code;
use super::drives::{Drive, Lasts};
use super::skips::Skips;
use super::structure::{Nesting, Routine};
use rungc_catalogue::{Comparison, Lower, Param};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes, phrase};
use rustc_hash::FxHashMap;

/// Conditions under which an instruction runs: its routine, its state and the jumps over it.
type Conditions = (Routine, u32, u64);

/// What one instruction at a time can have.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Resource {
    /// An output that sends pulses.
    Output(Device),
    /// An axis of HM (hm-motion-controller §8.2.3: an instruction that finds it in use does not start).
    Axis(i64),
    /// The maker of HM's tables (§8.3.4: a second instruction is ignored).
    Tables,
    /// One of HM's zones for comparisons of high-speed counters (§8.3.14).
    Zone(i32),
}

/// The instructions that use one resource.
#[derive(Default)]
struct Users {
    /// The first under each drive.
    driven: FxHashMap<(Conditions, u64), usize>,
    /// The first under each of these conditions, and the first there that is always driven.
    first_under: FxHashMap<Conditions, (usize, Option<usize>)>,
    /// Two that are driven together.
    together: Option<(usize, usize)>,
}

impl Users {
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

/// Collects them by resource.
#[derive(Default)]
pub(super) struct Outputs {
    users: FxHashMap<Resource, Users>,
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
        let Some(resource) = Resource::of(code, i) else {
            return;
        };
        if let Resource::Output(sends) = resource
            && output(code, i, |param| param.directs_pulses) == Some(sends)
        {
            self.own_direction.push((i, sends));
        }
        let enclosing = nesting.of(i);
        let conditions = (enclosing.routine, enclosing.state, skips.mark(i));
        let users = self.users.entry(resource).or_default();
        users.add(i, drive, conditions);
    }

    /// Warns of resources that two instructions use under the same condition, or one under any, and of outputs that
    /// give pulses and their direction.
    pub(super) fn report(self, code: &Code, out: &mut Diagnostics) {
        for (i, output) in self.own_direction {
            let message = phrase!("`{output}` sends pulses and gives their direction", output);
            let diagnostic = codes::ONE_OUTPUT
                .at(code.span(i), message)
                .help("give the direction by an output that sends no pulses");
            out.push(diagnostic);
        }
        let together = |(resource, users): (_, Users)| Some((users.together?, resource));
        let mut found: Vec<_> = self.users.into_iter().filter_map(together).collect();
        found.sort();
        for (pair, resource) in found {
            out.push(resource.report(code, pair));
        }
    }
}

/// The output that an operand of this meaning names.
fn output(code: &Code, i: usize, is_meant: fn(&Param) -> bool) -> Option<Device> {
    let operand = code.params(i).iter().position(is_meant)?;
    let output = code.device(i, operand);
    output.filter(|output| output.class == DeviceClass::Y)
}

impl Resource {
    /// What instruction `i` uses.
    fn of(code: &Code, i: usize) -> Option<Resource> {
        let operand = |is_meant: fn(&Param) -> bool| {
            let operand = code.params(i).iter().position(is_meant)?;
            code.instr(i).operands.get(operand)?.kind.constant()
        };
        match code.lower(i)? {
            Lower::Exclusive(_) => return Some(Resource::Tables),
            Lower::HighSpeed(Comparison::Set | Comparison::Reset | Comparison::Zone) => {
                let zones = code.model().high_speed.crossing_zones.as_ref()?;
                let zone = code.instr(i).operands.last()?.kind.constant()?;
                let zone = i32::try_from(zone).ok()?;
                return zones.contains(&zone).then_some(Resource::Zone(zone));
            }
            _ => {}
        }
        if let Some(output) = output(code, i, |param| param.sends_pulses) {
            return Some(Resource::Output(output));
        }
        // Others set parameters of the axis, or insert pulses into its motion.
        let moves = code.inst(i).is_some_and(|inst| inst.stops_undriven);
        let axis = operand(|param| param.sends_pulses).filter(|_| moves);
        axis.map(Resource::Axis)
    }

    fn report(self, code: &Code, (first, second): (usize, usize)) -> Diagnostic {
        let (finding, message, label) = match self {
            Resource::Output(output) => (
                &codes::ONE_OUTPUT,
                phrase!(
                    "two instructions send pulses through `{output}` at the same time",
                    output
                ),
                "finds the output in use",
            ),
            Resource::Axis(axis) => (
                &codes::ONE_OUTPUT,
                phrase!("two instructions move axis {axis} at the same time", axis),
                "finds the axis in use",
            ),
            Resource::Tables => (
                &codes::ONE_OUTPUT,
                phrase!("two instructions make tables at the same time"),
                "is ignored while the other is driven",
            ),
            Resource::Zone(zone) => (
                &codes::ZONE_SHARED,
                phrase!(
                    "two comparisons use compare zone {zone} at the same time",
                    zone
                ),
                "finds the zone in use",
            ),
        };
        let help = match self {
            Resource::Zone(_) => "give each its own zone, 0 to 5",
            _ => "give them conditions that are never on at the same time",
        };
        finding
            .at(code.span(second), message)
            .label(label)
            .other(code.span(first), "driven at the same time as this one")
            .help(help)
    }
}
