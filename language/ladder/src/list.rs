//! From networks back to instructions.

use crate::network::{Branch, InstrIndex, Item, Join, NetworkBody, Node, Part};
use crate::{Ladder, Network};

/// An instruction of the list that a ladder stands for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Listed {
    /// A contact or comparison, as LD, AND or OR.
    Contact(Entry, InstrIndex),
    /// Any other instruction that has a picture, and each of a network that is a list.
    Other(InstrIndex),
    /// ANB.
    Anb,
    /// ORB.
    Orb,
    /// MPS.
    Mps,
    /// MRD.
    Mrd,
    /// MPP.
    Mpp,
}

/// Operation by which a contact joins the logic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Entry {
    /// It starts a block.
    Ld,
    /// It follows in series.
    And,
    /// It lies parallel.
    Or,
}

/// The instructions of a ladder, in order.
pub fn instructions(ladder: &Ladder) -> Vec<Listed> {
    let mut list = Vec::new();
    for network in &ladder.networks {
        of_network(network, &mut list);
    }
    list
}

fn of_network(network: &Network, list: &mut Vec<Listed>) {
    let body = network.instrs.start + network.labels;
    list.extend((network.instrs.start..body).map(Listed::Other));
    match &network.body {
        NetworkBody::Rung(node) => {
            let first = list.len();
            of_node(node, Entry::Ld, list);
            for &nop in &network.nops {
                list.insert(first + (nop - body), Listed::Other(nop));
            }
        }
        NetworkBody::List { .. } => list.extend((body..network.instrs.end).map(Listed::Other)),
    }
}

fn of_node(node: &Node, entry: Entry, list: &mut Vec<Listed>) {
    of_series(&node.series, entry, list);
    for item in &node.items {
        match item {
            Item::Output(output) => list.push(Listed::Other(output.instr)),
            Item::Continue(node) => of_node(node, Entry::And, list),
            Item::Stack(branches) => {
                for (i, branch) in branches.iter().enumerate() {
                    list.push(match i {
                        0 => Listed::Mps,
                        _ if i + 1 == branches.len() => Listed::Mpp,
                        _ => Listed::Mrd,
                    });
                    of_node(branch, Entry::And, list);
                }
            }
        }
    }
}

/// Parts in series, of which the first contact has this entry.
fn of_series(series: &[Part], mut entry: Entry, list: &mut Vec<Listed>) {
    for part in series {
        match part {
            Part::Contact(contact) => list.push(Listed::Contact(entry, contact.instr)),
            Part::Result(instr) => list.push(Listed::Other(*instr)),
            Part::Parallel(branches) => {
                branches.iter().for_each(|branch| of_branch(branch, list));
                if entry == Entry::And {
                    list.push(Listed::Anb);
                }
            }
            Part::Group(parts) => {
                of_series(parts, Entry::Ld, list);
                list.push(Listed::Anb);
            }
        }
        entry = Entry::And;
    }
}

fn of_branch(branch: &Branch, list: &mut Vec<Listed>) {
    match branch.join {
        Join::First => of_series(&branch.series, Entry::Ld, list),
        Join::Or => of_series(&branch.series, Entry::Or, list),
        Join::Block => {
            of_series(&branch.series, Entry::Ld, list);
            list.push(Listed::Orb);
        }
    }
}
