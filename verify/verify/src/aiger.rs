//! Systems in the binary format of AIGER (version 1.9), which other model checkers read.

use crate::aig::{Lit, Node};
use crate::system::System;
use rustc_hash::{FxHashMap, FxHashSet};

/// The system as a file with one output, which is on after a scan that violates the property. Constraints are folded
/// into it: the output counts only while all of them have held. What may begin with any value takes it from an input in
/// the first scan, after all other inputs: not every model checker reads latches without an initial value as it should
/// (`berkeley-abc` proves with them what is false).
pub fn binary(system: &System) -> Vec<u8> {
    let mut system = system.clone();
    let holds = system.constraints.clone();
    let holds = system.aig.all(holds);
    let kept = system.aig.input();
    let still = system.aig.and(kept, holds);
    let bad = system.aig.and(still, system.bad);
    let own = system.aig.nodes().len();
    let has_begun = system.aig.input();
    // What stands for the values of latches that begin with any.
    let mut chosen: FxHashMap<usize, Lit> = FxHashMap::default();
    let mut latches: Vec<(Lit, Lit, bool)> = Vec::new();
    for latch in &system.latches {
        let (now, init) = latch.init.map_or_else(
            || {
                let [stored, first] = [system.aig.input(), system.aig.input()];
                let value = system.aig.mux(has_begun, stored, first);
                chosen.insert(latch.now.node(), value);
                (stored, false)
            },
            |init| (latch.now, init),
        );
        latches.push((now, latch.next, init));
    }
    latches.push((kept, still, true));
    latches.push((has_begun, Lit::TRUE, false));
    let nodes = system.aig.nodes();
    let mut numbers = vec![0u32; nodes.len()];
    let states: FxHashSet<usize> = latches.iter().map(|(now, ..)| now.node()).collect();
    let mut next = 0;
    let mut number = |node: usize| {
        next += 1;
        numbers[node] = next;
    };
    let mut inputs = 0;
    for (node, what) in nodes.iter().enumerate() {
        if let Node::Input(_) = what
            && !states.contains(&node)
            && !chosen.contains_key(&node)
        {
            number(node);
            inputs += 1;
        }
    }
    latches.iter().for_each(|(now, ..)| number(now.node()));
    let (before, after) = nodes.split_at(own);
    let after = after.iter().enumerate().map(|(n, node)| (own + n, node));
    let ands: Vec<(usize, Lit, Lit)> = after
        .chain(before.iter().enumerate())
        .filter_map(|(node, what)| match *what {
            Node::And(a, b) => Some((node, a, b)),
            Node::False | Node::Input(_) => None,
        })
        .collect();
    ands.iter().for_each(|(node, ..)| number(*node));
    let code = |lit: Lit| {
        let inverted = lit.is_inverted();
        let lit = chosen
            .get(&lit.node())
            .map_or(lit, |value| value.invert_if(inverted));
        2 * numbers[lit.node()] + u32::from(lit.is_inverted())
    };
    let most = inputs + latches.len() + ands.len();
    let mut text = format!("aig {most} {inputs} {} 1 {}\n", latches.len(), ands.len());
    for &(_, next, init) in &latches {
        text.push_str(&format!("{} {}\n", code(next), u32::from(init)));
    }
    text.push_str(&format!("{}\n", code(bad)));
    let mut bytes = text.into_bytes();
    for (node, a, b) in ands {
        let (a, b) = (code(a), code(b));
        let (high, low) = (a.max(b), a.min(b));
        delta(&mut bytes, 2 * numbers[node] - high);
        delta(&mut bytes, high - low);
    }
    bytes.extend(b"c\nrungc\n");
    bytes
}

/// A difference, seven bits a byte, the lowest first.
fn delta(bytes: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}
