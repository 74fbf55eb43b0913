//! State that a scan begins with, as far as a device depends on it.

use crate::explain::Explainer;
use crate::graph::{FactKind, Id, Node};
use crate::history::contacts;
use crate::sets::{Atom, View};
use crate::trace::Trace;
use rungc_models::runs::is_special;
use rungc_sim::Session;
use rungc_syntax::Device;
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// State that a scan begins with, as far as a device depends on it.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Roots {
    /// State of the device after the scan.
    pub on: bool,
    /// Smallest sets of devices of which the scan would have to begin with the opposite for the device to become the
    /// opposite of `on`; those for which that is certain.
    pub sets: Vec<Vec<Device>>,
    /// Other contacts of the program: the device stays as it is whatever they are, if `is_whole`.
    pub others: Vec<Device>,
    /// True if all that the device depends on is known.
    pub is_whole: bool,
}

impl Explainer<'_> {
    /// The devices that decide on a device in the next scan, which does not take place.
    pub fn roots(&self, session: &mut Session<'_>, scan_ms: Option<u64>, device: Device) -> Roots {
        let trace = self.look(session, scan_ms, device);
        let Some(&root) = trace.bits.get(&device) else {
            return Roots::default();
        };
        let view = View {
            graph: &trace.graph,
            own: device,
            deep: true,
        };
        let found = view.smallest(root);
        let devices = |set: &Vec<Atom>| -> Option<Vec<Device>> {
            set.iter()
                .map(|atom| match *atom {
                    Atom::Start(device) => Some(device),
                    Atom::Contact(..) | Atom::Memory(_) | Atom::Fact(_) => None,
                })
                .collect()
        };
        let wanted = Some(!trace.graph.value(root));
        let is_certain = |set: &&Vec<Atom>| {
            let is_unknown = |id: Id| self.may_differ(&trace, id, set);
            view.outcome(root, set, &is_unknown) == wanted
        };
        let sets = found.sets.iter().filter(is_certain);
        let blamed: BTreeSet<Device> = found
            .sets
            .iter()
            .flatten()
            .filter_map(|atom| match *atom {
                Atom::Start(device) => Some(device),
                Atom::Contact(..) | Atom::Memory(_) | Atom::Fact(_) => None,
            })
            .collect();
        let mut unclear = BTreeSet::from([device]);
        let special = self.unclear(&trace, root, &mut unclear);
        let others: BTreeSet<Device> = contacts(self.module()).collect();
        let stays = |device: &Device| !blamed.contains(device) && !unclear.contains(device);
        Roots {
            on: trace.graph.value(root),
            sets: sets.filter_map(devices).collect(),
            others: others.into_iter().filter(stays).collect(),
            is_whole: !found.more && !special && !trace.jumped,
        }
    }

    /// Returns true if a bit that is not followed may be another one in a scan that begins with other devices.
    fn may_differ(&self, trace: &Trace, id: Id, set: &[Atom]) -> bool {
        let fact = match trace.graph.node(id) {
            Node::Fact(fact) => fact,
            // Instructions write special devices that no operand names.
            Node::Start(device) => return is_special(device.class, device.number),
            _ => return false,
        };
        let mut inputs = BTreeSet::new();
        self.unclear(trace, id, &mut inputs);
        let is_changed = |device: &Device| set.contains(&Atom::Start(*device));
        !fact.live || inputs.iter().any(is_changed)
    }

    /// Finds the devices that bits which are not followed may depend on. Returns true if one of these is a special
    /// device, which may depend on anything.
    fn unclear(&self, trace: &Trace, root: Id, found: &mut BTreeSet<Device>) -> bool {
        let graph = &trace.graph;
        let mut special = false;
        let mut seen: FxHashSet<(Id, bool)> = FxHashSet::default();
        // Each with whether it is an input of a bit that is not followed.
        let mut open = vec![(root, false)];
        while let Some((id, is_input)) = open.pop() {
            if !seen.insert((id, is_input)) {
                continue;
            }
            match graph.node(id) {
                Node::Const(_) | Node::Memory(..) => {}
                Node::Start(device) => {
                    special |= is_special(device.class, device.number);
                    if is_input {
                        found.insert(*device);
                    }
                }
                Node::Contact { of, .. } => open.push((*of, is_input)),
                Node::Not(a) => open.push((*a, is_input)),
                Node::And(a, b) | Node::Or(a, b) => open.extend([(*a, is_input), (*b, is_input)]),
                Node::Fact(fact) => {
                    special |= fact.kind == FactKind::System;
                    open.extend(fact.inputs.iter().map(|&input| (input, true)));
                }
            }
        }
        special
    }
}
