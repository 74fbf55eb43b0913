//! What a device depends on, by the networks of the program, and what of it a person can change.

use crate::causes::whole;
use crate::explain::{Explainer, is_bit};
use rungc_analysis::xref::{Reach, Use, UseKind};
use rungc_catalogue::Basic;
use rungc_models::runs::is_special;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass};
use std::collections::{BTreeMap, BTreeSet};

/// Number of levers that are tried.
const MOST_LEVERS: usize = 16;

/// Number of values of a register that are tried.
const MOST_VALUES: usize = 6;

/// Level of the networks that decide which others are executed: it is not followed which.
const CONTROL: u32 = 2;

/// Something that a person can change: an input, or a device that nothing in the program writes.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct Lever {
    pub(crate) device: Device,
    /// Values that are tried; of a bit, both.
    pub(crate) values: Vec<i64>,
    /// Number of networks between it and the device that is asked for.
    pub(crate) level: u32,
}

impl Lever {
    pub(crate) fn target(&self) -> Target {
        target(self.device)
    }
}

/// A device as a session names it: of timers and counters the contact.
pub(crate) fn target(device: Device) -> Target {
    match is_bit(device) {
        true => Target::Bit(device.class, device.number),
        false => Target::Word(device.class, device.number),
    }
}

/// What a device depends on.
#[derive(Default, Debug)]
pub(crate) struct Cone {
    /// Devices, each with the number of networks between it and the device that is asked for.
    pub(crate) levels: BTreeMap<Device, u32>,
    /// The nearest levers.
    pub(crate) levers: Vec<Lever>,
    /// Number of levers that are farther away.
    pub(crate) left_out: usize,
}

/// Devices of a use, as far as the program alone says.
fn devices(one: &Use) -> impl Iterator<Item = Device> {
    let class = one.first.class;
    (one.first.number..one.end()).map(move |number| Device { class, number })
}

/// Returns true if an instruction depends on the devices of a use.
fn is_read(one: &Use) -> bool {
    matches!(
        one.kind,
        UseKind::Contact | UseKind::Read | UseKind::Change | UseKind::Unclear
    )
}

impl Explainer<'_> {
    /// What a device depends on, devices that are blamed first. `panel` says of a device if something outside writes it
    /// beside the program.
    pub(crate) fn cone(
        &self,
        session: &Session,
        (device, blamed): (Device, &[Device]),
        panel: &dyn Fn(Device) -> bool,
    ) -> Cone {
        let levels = self.levels(device);
        let mut by_level: Vec<(u32, Device)> = levels
            .iter()
            .map(|(&device, &level)| match blamed.contains(&device) {
                true => (0, device),
                false => (level, device),
            })
            .collect();
        by_level.sort();
        let driven: BTreeSet<u32> = session
            .plant()
            .map(|plant| plant.inputs().into_iter().map(|(input, _)| input).collect())
            .unwrap_or_default();
        let is_lever = |device: Device| {
            let Device { class, number } = device;
            let is_forced = |(target, _): (Target, f64)| target == self::target(device);
            let outside = match class {
                DeviceClass::X => !driven.contains(&number),
                DeviceClass::T | DeviceClass::C => false,
                _ => panel(device) || self.writes(device).is_empty() && !is_special(class, number),
            };
            outside && !session.forced().iter().any(is_forced)
        };
        let mut found = by_level.into_iter().filter(|&(_, device)| is_lever(device));
        let levers = found
            .by_ref()
            .take(MOST_LEVERS)
            .map(|(level, device)| Lever {
                device,
                values: self.values(session, device),
                level,
            });
        Cone {
            levers: levers.collect(),
            left_out: found.count(),
            levels,
        }
    }

    /// The devices that a device depends on, with the number of networks between.
    fn levels(&self, device: Device) -> BTreeMap<Device, u32> {
        let networks = &self.words.ladder.networks;
        let network_of = |instr: usize| networks.iter().position(|one| one.instrs.contains(&instr));
        let instrs = &self.words.resolved.instrs;
        let mut by_network: BTreeMap<usize, Vec<&Use>> = BTreeMap::new();
        let mut control = BTreeSet::new();
        for one in &self.uses {
            let Some(network) = network_of(one.instr) else {
                continue;
            };
            by_network.entry(network).or_default().push(one);
            let is_state = instrs[one.instr].basic() == Some(Basic::Stl);
            if is_state || matches!(one.kind, UseKind::Jump | UseKind::Level) {
                control.insert(network);
            }
        }
        let mut levels = BTreeMap::from([(device, 0)]);
        let mut seen = BTreeSet::new();
        let mut open = vec![device];
        for level in 1.. {
            let mut networks: BTreeSet<usize> = BTreeSet::new();
            for &device in &open {
                let writes = self.writes(device).into_iter();
                networks.extend(writes.filter_map(|one| network_of(one.instr)));
            }
            if level == CONTROL {
                networks.extend(&control);
            }
            networks.retain(|network| seen.insert(*network));
            open.clear();
            let uses = networks
                .iter()
                .filter_map(|network| by_network.get(network));
            for device in uses
                .flatten()
                .filter(|one| is_read(one))
                .flat_map(|one| devices(one))
            {
                levels.entry(device).or_insert_with(|| {
                    open.push(device);
                    level
                });
            }
            if open.is_empty() && level >= CONTROL {
                break;
            }
        }
        levels
    }

    /// Values of a register that comparisons with constants tell apart, the nearest to its value first.
    fn values(&self, session: &Session, device: Device) -> Vec<i64> {
        if is_bit(device) {
            return vec![0, 1];
        }
        let of_device =
            |one: &&Use| devices(one).any(|other| other == device) || one.reach == Reach::Open;
        let instrs: BTreeSet<usize> = self
            .uses
            .iter()
            .filter(of_device)
            .map(|one| one.instr)
            .collect();
        let operands = instrs
            .iter()
            .flat_map(|&instr| &self.words.resolved.program.instrs[instr].operands);
        let constants = operands.filter_map(|operand| operand.kind.constant());
        let near = constants.flat_map(|value| [value, value + 1, value - 1]);
        let now = whole(session, target(device)).unwrap_or(0);
        let fits = |value: &i64| i16::try_from(*value).is_ok() && *value != now;
        let mut values: Vec<i64> = BTreeSet::from_iter(near).into_iter().filter(fits).collect();
        values.sort_by_key(|value| (value.abs_diff(now), *value));
        values.truncate(MOST_VALUES);
        values
    }
}
