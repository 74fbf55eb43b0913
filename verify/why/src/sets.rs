//! Smallest sets of contacts that keep a bit as it is: if all of one set were different, the bit would be.

use crate::graph::{FactKind, Graph, Id, Node};
use rungc_ir::node::EdgeId;
use rungc_syntax::Device;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::VecDeque;

/// Number of sets that are found at most.
const MOST_SETS: usize = 16;
/// Limit of a search, in nodes that are evaluated.
const MOST_WORK: usize = 1_000_000;
/// Size of a set at most.
const LARGEST: usize = 12;

/// Something that could be different.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Debug)]
pub(crate) enum Atom {
    /// A contact, by the device and the state that it shows.
    Contact(Device, Id),
    /// A device when the scan began.
    Start(Device),
    /// The memory of an edge.
    Memory(EdgeId),
    /// A bit that is not followed further.
    Fact(Id),
}

/// Depth to which a condition is followed.
#[derive(Clone, Copy)]
pub(crate) struct View<'g> {
    pub(crate) graph: &'g Graph,
    /// The device that is explained: its own state before does not count as a cause.
    pub(crate) own: Device,
    /// Looks through contacts, back to the beginning of the scan.
    pub(crate) deep: bool,
}

/// Result of a search.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub(crate) struct Sets {
    /// The sets, the smallest first, those with something unclear last; none includes another.
    pub(crate) sets: Vec<Vec<Atom>>,
    /// True if there may be others.
    pub(crate) more: bool,
}

/// Role of a node in a view. `N` is a node.
#[derive(Clone, Copy)]
enum Face<N> {
    /// It stays as it is.
    Firm(bool),
    /// It may be different.
    Atom(Atom, bool),
    /// As another node.
    Same(N),
    Not(N),
    And(N, N),
    Or(N, N),
}

impl<N: Copy> Face<N> {
    fn map<M>(self, f: impl Fn(N) -> M) -> Face<M> {
        match self {
            Face::Firm(value) => Face::Firm(value),
            Face::Atom(atom, value) => Face::Atom(atom, value),
            Face::Same(a) => Face::Same(f(a)),
            Face::Not(a) => Face::Not(f(a)),
            Face::And(a, b) => Face::And(f(a), f(b)),
            Face::Or(a, b) => Face::Or(f(a), f(b)),
        }
    }
}

/// A condition as a list of its nodes, operands first; the last one is the condition.
struct Cone {
    ids: Vec<Id>,
    faces: Vec<Face<usize>>,
}

impl View<'_> {
    fn face(&self, id: Id) -> Face<Id> {
        let value = self.graph.value(id);
        match *self.graph.node(id) {
            Node::Const(_) => Face::Firm(value),
            Node::Start(device) if device == self.own => Face::Firm(value),
            Node::Start(device) => Face::Atom(Atom::Start(device), value),
            Node::Memory(memory, _) => Face::Atom(Atom::Memory(memory), value),
            Node::Contact { device, of, .. } => match self.graph.node(of) {
                _ if self.deep => Face::Same(of),
                Node::Start(own) if *own == self.own => Face::Firm(value),
                _ if device == self.own => Face::Same(of),
                _ => Face::Atom(Atom::Contact(device, of), value),
            },
            Node::Not(a) => Face::Not(a),
            Node::And(a, b) => Face::And(a, b),
            Node::Or(a, b) => Face::Or(a, b),
            Node::Fact(ref fact) => match (fact.kind, value) {
                (FactKind::Constant, _) | (FactKind::Elapsed, true) => Face::Firm(value),
                _ => Face::Atom(Atom::Fact(id), value),
            },
        }
    }

    fn cone(&self, root: Id) -> Cone {
        let mut seen = FxHashSet::default();
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            if !seen.insert(id) {
                continue;
            }
            match self.face(id) {
                Face::Firm(_) | Face::Atom(..) => {}
                Face::Same(a) | Face::Not(a) => open.push(a),
                Face::And(a, b) | Face::Or(a, b) => open.extend([a, b]),
            }
        }
        let mut ids: Vec<Id> = seen.into_iter().collect();
        ids.sort_unstable();
        let places = ids.iter().zip(0..).map(|(id, at)| (*id, at));
        let places: FxHashMap<Id, usize> = places.collect();
        let faces = ids.iter().map(|&id| self.face(id).map(|id| places[&id]));
        Cone {
            faces: faces.collect(),
            ids,
        }
    }

    /// The atoms of a condition, each once.
    pub(crate) fn atoms(&self, root: Id) -> Vec<(Atom, Id)> {
        let Cone { ids, faces } = self.cone(root);
        let mut seen = FxHashSet::default();
        let atoms = ids.into_iter().zip(faces);
        let atoms = atoms.filter_map(|(id, face)| match face {
            Face::Atom(atom, _) => seen.insert(atom).then_some((atom, id)),
            _ => None,
        });
        atoms.collect()
    }

    /// The smallest sets of atoms that would change a condition.
    ///
    /// Each step adds one atom to a set: where all operands have to change, one that the first of them needs, where one
    /// operand suffices, those of each. So every set that changes the condition is reached from a part of it.
    pub(crate) fn smallest(&self, root: Id) -> Sets {
        let cone = self.cone(root);
        let wanted = !self.graph.value(root);
        let mut found = Sets::default();
        let mut seen: FxHashSet<Vec<Atom>> = FxHashSet::default();
        let mut open = VecDeque::from([Vec::new()]);
        let mut work = 0;
        while let Some(set) = open.pop_front() {
            if found.sets.iter().any(|other| includes(&set, other)) {
                continue;
            }
            work += cone.faces.len();
            if work > MOST_WORK || found.sets.len() == MOST_SETS {
                found.more = true;
                break;
            }
            let values = cone.values(&set);
            if values.last() == Some(&wanted) {
                found.sets.push(set);
                continue;
            }
            if set.len() == LARGEST {
                found.more = true;
                continue;
            }
            for atom in cone.choices(&values, &set) {
                let mut next = set.clone();
                let at = next.partition_point(|other| *other < atom);
                next.insert(at, atom);
                if seen.insert(next.clone()) {
                    open.push_back(next);
                }
            }
        }
        let is_unclear = |set: &Vec<Atom>| set.iter().any(|atom| self.is_unclear(*atom));
        found.sets.sort_by_key(is_unclear);
        found
    }

    /// Value of a condition with some atoms being different, if others that are unknown do not matter.
    pub(crate) fn outcome(
        &self,
        root: Id,
        flipped: &[Atom],
        is_unknown: &dyn Fn(Id) -> bool,
    ) -> Option<bool> {
        let Cone { ids, faces } = self.cone(root);
        let mut values: Vec<Option<bool>> = Vec::with_capacity(faces.len());
        for (id, face) in ids.into_iter().zip(faces) {
            let both = |a: usize, b: usize, decides: bool| match (values[a], values[b]) {
                (Some(a), _) if a == decides => Some(decides),
                (_, Some(b)) if b == decides => Some(decides),
                (Some(_), Some(_)) => Some(!decides),
                _ => None,
            };
            let value = match face {
                Face::Firm(value) => Some(value),
                Face::Atom(..) if is_unknown(id) => None,
                Face::Atom(atom, value) => Some(value != flipped.contains(&atom)),
                Face::Same(a) => values[a],
                Face::Not(a) => values[a].map(|value| !value),
                Face::And(a, b) => both(a, b, false),
                Face::Or(a, b) => both(a, b, true),
            };
            values.push(value);
        }
        values.pop().flatten()
    }

    /// Returns true if the way to change it is unknown.
    fn is_unclear(&self, atom: Atom) -> bool {
        let Atom::Fact(id) = atom else {
            return matches!(atom, Atom::Memory(_));
        };
        match self.graph.node(id) {
            Node::Fact(fact) => matches!(fact.kind, FactKind::Written | FactKind::Other),
            _ => false,
        }
    }

    /// Returns true if the device's own contact keeps it on: it would be off if that were open.
    pub(crate) fn holds_itself(&self, root: Id) -> bool {
        let mut cone = self.cone(root);
        for (id, face) in cone.ids.iter().zip(&mut cone.faces) {
            if let (Face::Firm(value), Node::Contact { .. }) = (&mut *face, self.graph.node(*id)) {
                *value = !*value;
            }
        }
        self.graph.value(root) && cone.values(&[]).last() == Some(&false)
    }
}

impl Cone {
    /// Values of the nodes, with some atoms being different.
    fn values(&self, flipped: &[Atom]) -> Vec<bool> {
        let mut values = Vec::with_capacity(self.faces.len());
        for face in &self.faces {
            values.push(match *face {
                Face::Firm(value) => value,
                Face::Atom(atom, value) => value != flipped.contains(&atom),
                Face::Same(a) => values[a],
                Face::Not(a) => !values[a],
                Face::And(a, b) => values[a] && values[b],
                Face::Or(a, b) => values[a] || values[b],
            });
        }
        values
    }

    /// Atoms of which one has to change for the condition to change.
    fn choices(&self, values: &[bool], taken: &[Atom]) -> Vec<Atom> {
        let mut found = Vec::new();
        let mut seen = FxHashSet::default();
        let mut open = vec![self.faces.len() - 1];
        while let Some(at) = open.pop() {
            if !seen.insert(at) {
                continue;
            }
            let either = |a: usize, b: usize, all: bool| match (all, values[a] == values[at]) {
                // All operands have to change: the first that has not.
                (true, true) => vec![a],
                (true, false) => vec![b],
                (false, _) => vec![b, a],
            };
            match self.faces[at] {
                Face::Firm(_) => {}
                Face::Atom(atom, _) => {
                    if !taken.contains(&atom) && !found.contains(&atom) {
                        found.push(atom);
                    }
                }
                Face::Same(a) | Face::Not(a) => open.push(a),
                Face::And(a, b) => open.extend(either(a, b, !values[at])),
                Face::Or(a, b) => open.extend(either(a, b, values[at])),
            }
        }
        found
    }
}

/// Returns true if a set has all members of another.
fn includes(set: &[Atom], other: &[Atom]) -> bool {
    other.iter().all(|atom| set.contains(atom))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_syntax::DeviceClass;

    const OWN: Device = x(7);

    const fn x(number: u32) -> Device {
        Device {
            class: DeviceClass::X,
            number,
        }
    }

    /// All sets that change a condition and include no other, by trying.
    fn tried(view: &View, root: Id) -> Vec<Vec<Atom>> {
        let atoms: Vec<Atom> = view.atoms(root).into_iter().map(|(atom, _)| atom).collect();
        let mut found: Vec<Vec<Atom>> = Vec::new();
        let mut masks: Vec<u32> = (1..1 << atoms.len()).collect();
        masks.sort_by_key(|mask: &u32| mask.count_ones());
        for mask in masks {
            let chosen = (0..atoms.len()).filter(|i| mask >> i & 1 == 1);
            let mut set: Vec<Atom> = chosen.map(|i| atoms[i]).collect();
            set.sort_unstable();
            let values = view.cone(root).values(&set);
            let changes = values.last() != Some(&view.graph.value(root));
            if changes && !found.iter().any(|other| includes(&set, other)) {
                found.push(set);
            }
        }
        found.sort();
        found
    }

    #[test]
    fn all_smallest_sets_are_found() {
        let mut rng = fastrand::Rng::with_seed(1);
        for _ in 0..2000 {
            let mut graph = Graph::default();
            let mut nodes: Vec<Id> = (0..5).map(|n| graph.start(x(n), rng.bool())).collect();
            for _ in 0..12 {
                let [a, b, c] = [(); 3].map(|()| nodes[rng.usize(..nodes.len())]);
                nodes.push(match rng.u8(..4) {
                    0 => graph.not(a),
                    1 => graph.and(a, b),
                    2 => graph.or(a, b),
                    _ => graph.choice(a, b, c),
                });
            }
            let view = View {
                graph: &graph,
                own: OWN,
                deep: true,
            };
            let root = nodes[nodes.len() - 1];
            let mut found = view.smallest(root);
            assert!(!found.more);
            found.sets.sort();
            assert_eq!(found.sets, tried(&view, root));
        }
    }
}
