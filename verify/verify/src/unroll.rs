//! Scans one after another, as one graph.

use crate::aig::{Aig, Lit, Node};
use crate::model::Input;
use crate::system::{Latch, System};

/// Scans of a system, from its beginning or from any state.
pub struct Unroller<'s> {
    system: &'s System,
    /// The graph of all scans so far.
    pub aig: Aig,
    /// Literal of each node of the system, scan by scan.
    scans: Vec<Vec<Lit>>,
    from_start: bool,
}

impl<'s> Unroller<'s> {
    /// From power-on if `from_start`, else from any state.
    pub fn new(system: &'s System, from_start: bool) -> Self {
        Unroller {
            system,
            aig: Aig::default(),
            scans: Vec::new(),
            from_start,
        }
    }

    /// Number of scans.
    pub fn len(&self) -> usize {
        self.scans.len()
    }

    /// Returns true if there is none yet.
    pub fn is_empty(&self) -> bool {
        self.scans.is_empty()
    }

    /// Literal of the system in a scan.
    pub fn at(&self, scan: usize, lit: Lit) -> Lit {
        self.scans[scan][lit.node()].invert_if(lit.is_inverted())
    }

    /// Adds a scan.
    pub fn extend(&mut self) {
        self.extend_with(|_| None, |_| None);
    }

    /// Adds a scan. Some of what is free is known: memory at the beginning, and inputs.
    pub fn extend_with(
        &mut self,
        start: impl Fn(&Latch) -> Option<bool>,
        known: impl Fn(Input) -> Option<bool>,
    ) {
        let nodes = self.system.aig.nodes();
        let mut values: Vec<Option<Lit>> = vec![None; nodes.len()];
        for latch in &self.system.latches {
            let value = match (self.scans.last(), latch.init) {
                (Some(before), _) => before[latch.next.node()].invert_if(latch.next.is_inverted()),
                (None, Some(init)) if self.from_start => init.into(),
                (None, _) => match start(latch) {
                    Some(on) => on.into(),
                    None => self.aig.input(),
                },
            };
            values[latch.now.node()] = Some(value);
        }
        for &(lit, input) in &self.system.inputs {
            let value = match known(input) {
                Some(on) => on.into(),
                None => self.aig.input(),
            };
            values[lit.node()] = Some(value);
        }
        let mut scan = Vec::with_capacity(nodes.len());
        for (node, value) in nodes.iter().zip(values) {
            let of = |lit: Lit, scan: &[Lit]| scan[lit.node()].invert_if(lit.is_inverted());
            scan.push(match (*node, value) {
                (Node::False, _) => Lit::FALSE,
                (Node::Input(_), Some(value)) => value,
                // Unnamed inputs may have any value.
                (Node::Input(_), None) => self.aig.input(),
                (Node::And(a, b), _) => {
                    let (a, b) = (of(a, &scan), of(b, &scan));
                    self.aig.and(a, b)
                }
            });
        }
        self.scans.push(scan);
    }
}
