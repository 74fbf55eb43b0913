//! Estimate of how much has to happen until a device changes, by the conditions of the program.
//!
//! Each condition counts by itself: what two of them have in common counts twice, and what one of them undoes does not
//! count. An estimate leads a search; it proves nothing.

use crate::explain::{Explainer, state};
use crate::graph::{Fact, FactKind, Id, Node};
use crate::trace::Trace;
use rungc_interp::Machine;
use rungc_models::runs::is_special;
use rungc_syntax::Device;
use rustc_hash::FxHashMap;

/// The most that is counted.
pub(crate) const MOST: u32 = 60;

/// Rounds after which an estimate is good enough.
const ROUNDS: usize = 24;

/// What a bit costs to be off, and to be on.
type Costs = [u32; 2];

/// The conditions of a program, as far as a device depends on them.
pub(crate) struct Needs {
    trace: Trace,
    /// Devices that conditions name, with what a scan makes of them.
    devices: Vec<(Device, Option<Id>)>,
    index: FxHashMap<Device, usize>,
    is_lever: Vec<bool>,
    wanted: (usize, bool),
}

impl Needs {
    /// Of a device that is to be in a state. Levers are what can be changed at any time.
    pub(crate) fn new(
        explainer: &Explainer,
        (device, on): (Device, bool),
        levers: impl Iterator<Item = Device>,
    ) -> Self {
        let trace = explainer.conditions(device);
        let levers: Vec<Device> = levers.collect();
        let mut devices = vec![(device, trace.bits.get(&device).copied())];
        for node in trace.graph.nodes() {
            if let Node::Start(other) = node
                && *other != device
            {
                devices.push((*other, trace.bits.get(other).copied()));
            }
        }
        let numbered = devices.iter().enumerate();
        Needs {
            index: numbered.map(|(n, (device, _))| (*device, n)).collect(),
            is_lever: devices
                .iter()
                .map(|(device, _)| levers.contains(device))
                .collect(),
            wanted: (0, on),
            trace,
            devices,
        }
    }

    /// Number of steps that an estimate takes at most.
    pub(crate) fn price(&self) -> usize {
        ROUNDS * self.trace.graph.nodes().len() / 4
    }

    /// About how much has to happen from the present state on, at most [`MOST`].
    pub(crate) fn estimate(&self, machine: &Machine) -> u32 {
        let now: Vec<bool> = self
            .devices
            .iter()
            .map(|(device, _)| state(machine, *device))
            .collect();
        let mut known: Vec<Costs> = (0..now.len()).map(|n| self.at_first(n, now[n])).collect();
        let mut nodes: Vec<Costs> = Vec::new();
        for _ in 0..ROUNDS {
            self.follow(&known, &mut nodes);
            let mut changed = false;
            for (n, (_, made)) in self.devices.iter().enumerate() {
                let Some(made) = made else {
                    continue;
                };
                for value in [0, 1] {
                    let cost = MOST.min(1 + nodes[made.index()][value]);
                    if cost < known[n][value] {
                        known[n][value] = cost;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        let (wanted, on) = self.wanted;
        known[wanted][usize::from(on)]
    }

    /// What a device costs that no scan has to change.
    fn at_first(&self, n: usize, on: bool) -> Costs {
        let (device, _) = self.devices[n];
        let other = match self.is_lever[n] {
            true => 1,
            false if is_special(device.class, device.number) => 3,
            false => MOST,
        };
        match on {
            true => [other, 0],
            false => [0, other],
        }
    }

    /// What each condition costs if devices cost this.
    fn follow(&self, known: &[Costs], nodes: &mut Vec<Costs>) {
        nodes.clear();
        let both = |a: u32, b: u32| MOST.min(a + b);
        for (n, node) in self.trace.graph.nodes().iter().enumerate() {
            let costs = match node {
                Node::Const(true) => [MOST, 0],
                Node::Const(false) => [0, MOST],
                Node::Start(device) => known[self.index[device]],
                Node::Memory(..) => [1, 1],
                Node::Contact { of, .. } => nodes[of.index()],
                Node::Not(a) => {
                    let [off, on] = nodes[a.index()];
                    [on, off]
                }
                Node::And(a, b) => {
                    let (a, b) = (nodes[a.index()], nodes[b.index()]);
                    [a[0].min(b[0]), both(a[1], b[1])]
                }
                Node::Or(a, b) => {
                    let (a, b) = (nodes[a.index()], nodes[b.index()]);
                    [both(a[0], b[0]), a[1].min(b[1])]
                }
                Node::Fact(fact) => of_fact(fact, self.trace.graph.values()[n]),
            };
            nodes.push(costs);
        }
    }
}

/// What a bit costs that is not followed.
fn of_fact(fact: &Fact, value: bool) -> Costs {
    match fact.kind {
        FactKind::Constant if value => [MOST, 0],
        FactKind::Constant => [0, MOST],
        FactKind::Elapsed => [0, 2],
        FactKind::Counted => [0, 5],
        _ => [3, 3],
    }
}
