//! Sources of a module's parts: the instruction each comes from, for tools that report the executed parts of a program.
//!
//! A marked module has more [`Stmt::Network`]s than others: one after the drive of each output is known.

use super::Lowerer;
use rungc_ir::node::{EdgeId, ExprId, Network, Stmt};
use std::collections::BTreeSet;
use typed_index_collections::TiVec;

/// Sources of a module's parts. Instructions are positions in [`rungc_syntax::Program::instrs`].
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// By expression: the instruction that it was made for. Expressions of the scan itself are not in it.
    pub exprs: TiVec<ExprId, u32>,
    /// By network, as [`Stmt::Network`] numbers them.
    pub places: Vec<Mark>,
    /// By instruction: whether it is a contact or a comparison. Those after the last one are not in it.
    pub contacts: Vec<bool>,
    /// The memories of contacts that conduct for one scan, such as LDP. What they look at is not itself a contact.
    pub edges: BTreeSet<EdgeId>,
}

/// Meaning of a [`Stmt::Network`] in a marked module.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Mark {
    /// A network that begins with this instruction.
    Network(u32),
    /// A coil or another instruction that the logic drives.
    Output {
        /// The instruction.
        instr: u32,
        /// Condition of the drive.
        drive: ExprId,
    },
}

impl Lowerer<'_> {
    /// Notes that a network begins.
    pub(super) fn mark_network(&mut self) {
        if let Some(marks) = &mut self.marks {
            marks.places.push(Mark::Network(self.at as u32));
        }
    }

    /// Notes that the instruction at hand is a contact or a comparison.
    pub(super) fn mark_contact(&mut self) {
        if let Some(marks) = &mut self.marks {
            let length = marks.contacts.len().max(self.at + 1);
            marks.contacts.resize(length, false);
            marks.contacts[self.at] = true;
        }
    }

    /// Notes the memory of a contact that conducts for one scan.
    pub(super) fn mark_edge(&mut self, edge: EdgeId) {
        if let Some(marks) = &mut self.marks {
            marks.edges.insert(edge);
        }
    }

    /// Marks that the drive of the instruction at hand is known.
    pub(super) fn mark_output(&mut self, drive: ExprId) {
        let Some(marks) = &mut self.marks else {
            return;
        };
        let instr = self.at as u32;
        marks.places.push(Mark::Output { instr, drive });
        let network = Network {
            step: self.step(),
            span: self.instr().span,
            statement: None,
            note: None,
        };
        self.emit(Stmt::Network(self.module.networks.len() as u32));
        self.module.networks.push(network);
    }
}
