//! Order in which a scan runs subroutines, and the subroutines that every scan runs.

use super::Code;
use super::drives::{Drive, Drives, Lasts};
use super::pointers::Pointers;
use super::skips::{ALL, Skips, plus};
use super::structure::{NONE, Nesting, Routine};
use crate::accesses::{self, Access};
use rungc_catalogue::Basic;
use rungc_models::runs::is_special;
use rungc_syntax::{Device, DeviceClass};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// Place in a scan: the calls that lead to an instruction, outermost first, and the instruction.
pub(super) type Order = Vec<u32>;

/// Calls nest less deep on all models.
const MAX_DEPTH: usize = 16;

/// A call of a subroutine.
struct Site {
    at: usize,
    /// The label called.
    label: u32,
    routine: Routine,
    when: When,
    /// Share of the runs of the routine that execute it, if nothing but jumps decides on that.
    share: Option<u64>,
}

/// Condition of a call.
#[derive(Clone, Copy, PartialEq, Eq)]
enum When {
    /// In every scan, once.
    Always,
    /// While this device has this state.
    While(Device, bool),
    /// Another one.
    Other,
}

/// Places in a scan at which subroutines run, by their labels.
pub(super) struct Calls {
    /// The last call, under whatever condition.
    last: FxHashMap<u32, Order>,
    /// A call that every scan executes.
    certain: FxHashMap<u32, Order>,
    /// Routines that may be called elsewhere, too.
    elsewhere: FxHashSet<u32>,
    /// True if a call with an index register may call any.
    any: bool,
}

impl Calls {
    pub(super) fn new(code: &Code, pointers: &Pointers, nesting: &Nesting, skips: &Skips) -> Self {
        let sites = sites(code, pointers, nesting, skips);
        let mut calls = Calls {
            last: FxHashMap::default(),
            certain: FxHashMap::default(),
            elsewhere: FxHashSet::default(),
            any: pointers.any_may_be_called(),
        };
        let complements = complements(code, nesting, &sites).into_iter();
        // The first of two, as it is the one that may be executed.
        let mut chosen: Vec<_> = complements.map(|[first, _]| first).collect();
        chosen.extend(branches(&sites));
        for _ in 0..MAX_DEPTH {
            let mut changed = false;
            for site in &sites {
                changed |= calls.take(site);
            }
            for &first in &chosen {
                let Site {
                    at, label, routine, ..
                } = sites[first];
                let order = order(&calls.certain, routine, at);
                changed |= order.is_some_and(|order| later(&mut calls.certain, label, order));
            }
            if !changed {
                break;
            }
        }
        calls
    }

    /// Takes a call, as far as the routine that contains it is known; returns true if that is news.
    fn take(&mut self, site: &Site) -> bool {
        let outside = match site.routine {
            Routine::Main => false,
            Routine::Sub(label) => self.elsewhere.contains(&label),
            Routine::Interrupt(_) => true,
            Routine::Nothing => return false,
        };
        let mut changed = outside && self.elsewhere.insert(site.label);
        if let Some(order) = order(&self.last, site.routine, site.at) {
            changed |= later(&mut self.last, site.label, order);
        }
        if site.when == When::Always
            && let Some(order) = order(&self.certain, site.routine, site.at)
        {
            changed |= later(&mut self.certain, site.label, order);
        }
        changed
    }

    /// Returns true if every scan runs a routine.
    pub(super) fn in_every_scan(&self, routine: Routine) -> bool {
        match routine {
            Routine::Main => true,
            Routine::Sub(label) => self.certain.contains_key(&label),
            Routine::Interrupt(_) | Routine::Nothing => false,
        }
    }

    /// Place of an instruction in a scan that runs it: the last one, if it is known.
    pub(super) fn last(&self, routine: Routine, at: usize) -> Option<Order> {
        if let Routine::Sub(label) = routine
            && (self.any || self.elsewhere.contains(&label))
        {
            return None;
        }
        order(&self.last, routine, at)
    }

    /// Place of an instruction in every scan, if its routine runs in each.
    pub(super) fn certain(&self, routine: Routine, at: usize) -> Option<Order> {
        order(&self.certain, routine, at)
    }
}

/// Place of an instruction by the places of routines.
fn order(routines: &FxHashMap<u32, Order>, routine: Routine, at: usize) -> Option<Order> {
    let mut order = match routine {
        Routine::Main => Order::new(),
        Routine::Sub(label) => routines.get(&label)?.clone(),
        Routine::Interrupt(_) | Routine::Nothing => return None,
    };
    order.push(at as u32);
    (order.len() <= MAX_DEPTH).then_some(order)
}

/// Sets the place of a routine, unless it has a later one.
fn later(routines: &mut FxHashMap<u32, Order>, label: u32, order: Order) -> bool {
    match routines.get_mut(&label) {
        Some(known) if *known >= order => false,
        Some(known) => {
            *known = order;
            true
        }
        None => {
            routines.insert(label, order);
            true
        }
    }
}

/// All calls of a program.
fn sites(code: &Code, pointers: &Pointers, nesting: &Nesting, skips: &Skips) -> Vec<Site> {
    let mut drives = Drives::default();
    let mut jumps = Jumps::default();
    let mut sites = Vec::new();
    for i in 0..code.len {
        jumps.open.remove(&i);
        let Some(drive) = drives.next(code, i) else {
            continue;
        };
        if code.basic(i) == Some(Basic::Cj) {
            jumps.note(code, pointers, i, drive);
        }
        if code.basic(i) != Some(Basic::Call) {
            continue;
        }
        let place = nesting.of(i);
        let inside = (place.inner_loop, place.state) != (NONE, NONE);
        let once = !code.resolved.instrs[i].form.pulse && !inside;
        let when = match (drive.lasts, drive.contact, jumps.only()) {
            _ if !once => When::Other,
            (Lasts::Always, ..) if skips.mark(i) == 0 => When::Always,
            (_, Some((device, closed)), _) if skips.mark(i) == 0 => When::While(device, closed),
            (Lasts::Always, _, Some((device, closed))) => When::While(device, !closed),
            _ => When::Other,
        };
        let share = Some(skips.share(i)).filter(|_| once && drive.lasts == Lasts::Always);
        let called = code.device(i, 0).and_then(|device| pointers.get(device));
        let labels = called.iter().flat_map(|pointer| &pointer.labels);
        sites.extend(labels.map(|&label| Site {
            at: i,
            label: label as u32,
            routine: place.routine,
            when,
            share,
        }));
    }
    sites
}

/// Forward jumps over the code at hand, by the place of their label, with the contact that drives each alone.
#[derive(Default)]
struct Jumps {
    open: BTreeMap<usize, Vec<Option<(Device, bool)>>>,
}

impl Jumps {
    fn note(&mut self, code: &Code, pointers: &Pointers, i: usize, drive: Drive) {
        let pulse = code.resolved.instrs[i].form.pulse;
        let to = code.device(i, 0).and_then(|device| pointers.get(device));
        let label = to.and_then(|pointer| pointer.labels.first());
        if let Some(&label) = label.filter(|&&label| label > i) {
            let contact = drive.contact.filter(|_| !pulse);
            self.open.entry(label).or_default().push(contact);
        }
    }

    /// The contact of the jump, if there is only one.
    fn only(&self) -> Option<(Device, bool)> {
        let mut open = self.open.values().flatten();
        let first = open.next().copied().flatten();
        first.filter(|_| open.next().is_none())
    }
}

/// The first of the calls of each routine, if jumps choose between them so that each run executes one.
fn branches(sites: &[Site]) -> Vec<usize> {
    let mut sums: BTreeMap<(u32, Routine), (usize, u64)> = BTreeMap::new();
    for (n, site) in sites.iter().enumerate() {
        if let Some(share) = site.share {
            let (_, sum) = sums.entry((site.label, site.routine)).or_insert((n, 0));
            *sum = plus(*sum, share);
        }
    }
    let complete = sums.into_values().filter(|&(_, sum)| sum == ALL);
    complete.map(|(first, _)| first).collect()
}

/// Pairs of calls of one routine of which every scan executes one: under a contact and under its inverse, which keeps
/// its state between them.
fn complements(code: &Code, nesting: &Nesting, sites: &[Site]) -> Vec<[usize; 2]> {
    let mut met: FxHashMap<(u32, Routine, Device, bool), usize> = FxHashMap::default();
    let mut pairs = Vec::new();
    for (n, site) in sites.iter().enumerate() {
        // A contact that only instructions change, and the refresh of inputs.
        let plain = |device: &Device| {
            let class = matches!(
                device.class,
                DeviceClass::X | DeviceClass::Y | DeviceClass::M
            );
            class && !is_special(device.class, device.number)
        };
        if let When::While(device, closed) = site.when
            && plain(&device)
        {
            let key = |closed| (site.label, site.routine, device, closed);
            pairs.extend(met.get(&key(!closed)).map(|&first| (device, [first, n])));
            met.entry(key(closed)).or_insert(n);
        }
    }
    let devices = pairs.iter().map(|&(device, _)| (device, Vec::new()));
    let mut writes: BTreeMap<Device, Vec<usize>> = devices.collect();
    note_writes(code, &mut writes);
    let stays = |device: &Device, [first, second]: [usize; 2]| {
        let (routine, between) = (sites[first].routine, sites[first].at..sites[second].at);
        let writes = writes.get(device).map(Vec::as_slice).unwrap_or_default();
        let next = writes.partition_point(|&place| place < between.start);
        let here = writes
            .get(next)
            .is_none_or(|place| !between.contains(place));
        let main = [Routine::Main, routine];
        here && writes
            .iter()
            .all(|&place| main.contains(&nesting.of(place).routine))
    };
    pairs.retain(|(device, pair)| stays(device, *pair));
    pairs.into_iter().map(|(_, pair)| pair).collect()
}

/// Adds the places that write devices of a map.
fn note_writes(code: &Code, writes: &mut BTreeMap<Device, Vec<usize>>) {
    if writes.is_empty() {
        return;
    }
    for i in 0..code.len {
        for access in accesses::of(code.resolved, i).filter(Access::writes) {
            for (_, places) in writes.range_mut(access.devices()) {
                places.push(i);
            }
        }
    }
}
