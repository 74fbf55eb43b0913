//! Dependence of a proof on devices that something other than the program could write: which of them it needs, and
//! which have to be released for the event to happen.

use super::{Answer, Evidence, Finding, by_induction, never};
use crate::effort::Limit;
use crate::model::{Encoder, device_of, is_settable};
use crate::system::System;
use rungc_models::runs::is_special;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

type Device = (DeviceClass, u32);

/// Limit of the effort for what one proof depends on.
const ALL: u64 = 1000;
/// Limit of the effort for one attempt to prove it with fewer assumptions.
const ATTEMPT: u64 = 200;

/// A finding with the devices that its proof depends on. Those that it names are tried first: there may be hundreds of
/// others, and not the time for all.
pub(super) fn dependent(
    finding: Finding,
    named: &BTreeSet<Device>,
    (system, encoder): (&System, &Encoder),
    limit: &Limit,
) -> Finding {
    let keys = system.latches.iter().map(|latch| latch.key);
    let devices = keys.filter(|key| is_settable(*key)).filter_map(device_of);
    let others =
        devices.filter(|&device| Some(device) != finding.device && !is_special(device.0, device.1));
    let all: Vec<Device> = BTreeSet::from_iter(others).into_iter().collect();
    if all.is_empty() {
        return finding;
    }
    let mut proof = Proof {
        system,
        limit: limit.part(ALL),
        evidence: finding.evidence,
    };
    // A panel that writes what every scan writes anew changes little.
    let (fleeting, lasting): (Vec<_>, Vec<_>) = all.iter().partition(|device| {
        let written = encoder
            .probes
            .iter()
            .flat_map(|probes| probes.bits.get(device));
        device.0 == DeviceClass::Y || written.into_iter().any(|written| written.always)
    });
    let named: Vec<Device> = all
        .iter()
        .copied()
        .filter(|device| named.contains(device))
        .collect();
    let possible_with_one = proof.alone(&named);
    let mut released = BTreeSet::new();
    let mut needed = match proof.release(&mut released, &all) {
        true => Vec::new(),
        false => {
            proof.needed(&mut released, &fleeting);
            proof.needed(&mut released, &lasting)
        }
    };
    needed.sort_by_key(|device| !named.contains(device));
    let mut possible_with = match possible_with_one {
        Some(device) => vec![device],
        None => proof.possible_with(&needed, &lasting),
    };
    if possible_with.is_empty() {
        possible_with = needed
            .iter()
            .copied()
            .filter(|device| named.contains(device))
            .collect();
    }
    Finding {
        possible_with,
        evidence: proof.evidence,
        untouched: needed,
        ..finding
    }
}

/// A proof, and the limit for what it depends on.
struct Proof<'s> {
    system: &'s System,
    limit: Limit,
    evidence: Evidence,
}

impl Proof<'_> {
    /// The answer if something else writes these devices.
    fn without(&self, released: &BTreeSet<Device>) -> Answer {
        if self.limit.is_over() {
            return Answer::Open;
        }
        let is_released =
            |key| is_settable(key) && device_of(key).is_some_and(|of| released.contains(&of));
        self.limit.charge(self.system.aig.nodes().len());
        let system = self.system.releasing(is_released);
        let attempt = self.limit.part(ATTEMPT);
        match self.evidence {
            // An invariant would take longer than the proof has.
            Evidence::Induction(_) => by_induction(&system, &attempt).unwrap_or(Answer::Open),
            _ => never(&system, &attempt),
        }
    }

    /// Releases devices, in addition to those that are, if the proof holds without them; returns true if it does.
    fn release(&mut self, released: &mut BTreeSet<Device>, more: &[Device]) -> bool {
        let all: BTreeSet<Device> = released.iter().chain(more).copied().collect();
        let Answer::Proved(evidence) = self.without(&all) else {
            return false;
        };
        self.evidence = evidence;
        *released = all;
        true
    }

    /// Releases as many of these devices as possible; returns the others, which the proof needs.
    fn needed(&mut self, released: &mut BTreeSet<Device>, of: &[Device]) -> Vec<Device> {
        if of.is_empty() || self.release(released, of) {
            return Vec::new();
        }
        if let [_] = of {
            return of.to_vec();
        }
        let (first, second) = of.split_at(of.len() / 2);
        let mut needed = self.needed(released, first);
        needed.extend(self.needed(released, second));
        needed
    }

    /// Returns true if it can happen where something else writes these devices.
    fn breaks(&self, released: &BTreeSet<Device>) -> bool {
        matches!(self.without(released), Answer::Possible)
    }

    /// The first of these devices with which it can happen if something else writes that one alone.
    fn alone(&self, of: &[Device]) -> Option<Device> {
        let mut of = of.iter().copied();
        of.find(|&device| self.breaks(&BTreeSet::from([device])))
    }

    /// Devices, as few as possible, with which it can happen if something else writes them: one of those that the proof
    /// needs if one is enough.
    fn possible_with(&self, needed: &[Device], of: &[Device]) -> Vec<Device> {
        if let Some(device) = self.alone(needed) {
            return vec![device];
        }
        let breaks = |released: &BTreeSet<Device>| self.breaks(released);
        let mut all: BTreeSet<Device> = of.iter().copied().collect();
        if needed.is_empty() || !breaks(&all) {
            return Vec::new();
        }
        let mut open = vec![of];
        while let Some(part) = open.pop() {
            let mut rest = all.clone();
            rest.retain(|device| !part.contains(device));
            if breaks(&rest) {
                all = rest;
            } else if part.len() > 1 {
                let (first, second) = part.split_at(part.len() / 2);
                open.extend([second, first]);
            }
        }
        all.into_iter().collect()
    }
}
