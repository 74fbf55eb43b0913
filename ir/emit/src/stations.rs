//! Loops over stations: rungs that a program repeats with other devices.

use crate::measure;
use crate::plan::{Node, Stations};
use crate::storage::{Kind, Storage};
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, ExprId, Stmt};
use rungc_syntax::DeviceClass;
use std::collections::{BTreeSet, HashSet};

/// Class and number.
pub type Device = (DeviceClass, u32);

/// Bits that a loop only reads, and that are the same in all of its iterations. They are read before it: compilers make
/// no vectors if these bits are after an array in memory to which the loop writes.
pub fn invariants(module: &Module, storage: &Storage, stations: &Stations) -> BTreeSet<Device> {
    let (mut roots, mut written) = (Vec::new(), HashSet::new());
    collect(&stations.body, &mut roots, &mut written);
    let mut found = BTreeSet::new();
    let mut below = Vec::new();
    for root in roots {
        measure::below(module, root, &mut below);
        found.extend(below.iter().filter_map(|&id| {
            let place = module.expr(id).as_bit()?;
            (place.index.is_none()).then_some((place.class, place.number))
        }));
    }
    found.retain(|device| {
        let field = storage.find(device.0, device.1);
        !written.contains(device) && field.is_some_and(|field| field.kind == Kind::Bit)
    });
    found
}

/// The expressions that nodes evaluate, and the bits that they write by name.
fn collect(nodes: &[Node], roots: &mut Vec<ExprId>, written: &mut HashSet<Device>) {
    for node in nodes {
        roots.extend(node.roots());
        if let Node::Stmt(Stmt::Do(Action::Write(access, _))) = node
            && access.kind == AccessKind::Bit
        {
            written.insert((access.place.class, access.place.number));
        }
        for body in node.bodies() {
            collect(body, roots, written);
        }
    }
}

/// The heading of a loop.
pub fn heading(stations: &Stations) -> String {
    let (count, (first, last)) = (stations.count, stations.steps);
    format!(
        "steps {first} to {last}: {count} times the same rungs, each time with the next devices"
    )
}
