//! Contact logic: from LD to the instruction that consumes the result.

use super::operand::Guards;
use super::{Lowerer, basic_of};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Drive, Join};
use rungc_ir::node::{Action, EdgeId, Expr, ExprId, Ty};
use rungc_rt::{CmpOp, EdgeKind};
use rungc_syntax::{DeviceClass, OperandKind};
use std::collections::BTreeMap;

/// The logic at hand.
pub(super) struct Logic {
    /// Results of the blocks that are open; the last is the one that contacts join.
    pub(super) stack: Vec<ExprId>,
    /// Bits pushed by MPS.
    branches: Vec<ExprId>,
    /// State of the bus that coils hang on, a temporary: of the innermost master control, or of the step. `None` is
    /// always on.
    pub(super) bus: Option<ExprId>,
    /// The zones of master control that are open: level and the bus around each.
    pub(super) zones: Vec<(u32, Option<ExprId>)>,
    /// Memories of edges that several contacts share: the relay, true for rising edges, true below the relay's coil.
    shared_edges: BTreeMap<(u32, bool, bool), EdgeId>,
    /// True for each LD that begins a rung, rather than a block that ANB or ORB joins to the code before it.
    pub(super) starts_rung: Vec<bool>,
}

impl Logic {
    pub(super) fn of(resolved: &Resolved) -> Self {
        Logic {
            stack: Vec::new(),
            branches: Vec::new(),
            bus: None,
            zones: Vec::new(),
            shared_edges: BTreeMap::new(),
            starts_rung: resolved.starts_of_rungs(),
        }
    }

    /// Forgets everything, at the start of a function.
    pub(super) fn clear(&mut self) {
        self.stack.clear();
        self.branches.clear();
        self.bus = None;
        self.zones.clear();
    }
}

impl Lowerer<'_> {
    /// Returns true if nothing after the current instruction uses the result it consumes.
    fn result_is_dead(&self) -> bool {
        let mut i = self.at + 1;
        while basic_of(self.resolved, i) == Some(Basic::Nop) {
            i += 1;
        }
        let Some(inst) = self.resolved.instrs.get(i).and_then(|r| r.inst) else {
            return true;
        };
        match inst.basic() {
            Some(Basic::Mrd | Basic::Mpp) => true,
            _ => inst.drive == Drive::Alone || self.logic.starts_rung[i],
        }
    }

    /// Drive of the instruction at hand: the bus and the result. What is used again later is evaluated now.
    pub(super) fn drive(&mut self) -> ExprId {
        let keep_top = !self.result_is_dead();
        let count = self.logic.stack.len();
        for i in 0..count {
            if i + 1 < count || keep_top {
                self.logic.stack[i] = self.settled(self.logic.stack[i]);
            }
        }
        let on_bus = |this: &mut Self| this.bit_const(true);
        let drive = match (self.logic.bus, self.logic.stack.last().copied()) {
            (None, None) => on_bus(self),
            (None, Some(result)) => result,
            (Some(bus), None) => bus,
            (Some(bus), Some(result)) if matches!(self.expr(result), Expr::Bit(true)) => bus,
            (Some(bus), Some(result)) => self.and(bus, result),
        };
        self.mark_output(drive);
        drive
    }

    /// As [`Lowerer::drive`], on for one scan if the instruction is written in its pulse form.
    pub(super) fn drive_of_form(&mut self) -> ExprId {
        let drive = self.drive();
        if self.resolution().form.pulse {
            let edge = self.new_edge();
            self.edge(edge, EdgeKind::Rising, drive)
        } else {
            drive
        }
    }

    /// Emits the statements of `make`, executed while the current instruction is driven.
    pub(super) fn driven(&mut self, make: impl FnOnce(&mut Self)) {
        let drive = self.drive_of_form();
        self.when(drive, make);
    }

    fn join(&mut self, join: Join, contact: ExprId) {
        let joined = match (join, self.logic.stack.pop()) {
            (Join::Ld, below) => {
                self.logic.stack.extend(below);
                contact
            }
            (_, None) => contact,
            (Join::And, Some(a)) if matches!(self.expr(a), Expr::Bit(true)) => contact,
            (Join::And, Some(a)) => self.and(a, contact),
            (Join::Or, Some(a)) => self.or(a, contact),
        };
        self.logic.stack.push(joined);
    }

    /// State of the bit that the first operand names, as a contact: off, with a fault, where an index leads out of
    /// range.
    fn contact_state(&mut self) -> ExprId {
        let Some(operand) = self.operand(0) else {
            return self.bit_const(false);
        };
        let mut guards = Guards::default();
        let state = self.bit(operand, &mut guards);
        self.guarded_value(guards, state)
    }

    pub(super) fn contact(&mut self, join: Join, inverted: bool) {
        self.mark_contact();
        let state = self.contact_state();
        let contact = match (inverted, self.known_bit(state)) {
            (true, Some(on)) => self.bit_const(!on),
            (true, None) => self.not(state),
            (false, _) => state,
        };
        self.join(join, contact);
    }

    pub(super) fn edge_contact(&mut self, join: Join, kind: EdgeKind) {
        self.mark_contact();
        let state = self.contact_state();
        let edge = self.memory_of_edge(kind);
        self.mark_edge(edge);
        let contact = self.edge(edge, kind, state);
        self.join(join, contact);
    }

    /// The memory of the contact at hand: a shared one if its relay acts on the first contact alone.
    fn memory_of_edge(&mut self, kind: EdgeKind) -> EdgeId {
        let Some(relay) = self.single_operation(self.at) else {
            return self.new_edge();
        };
        let mut before = 0..self.at;
        let below = before.any(|i| {
            self.single_operation(i) == Some(relay)
                && basic_of(self.resolved, i) == Some(Basic::Out)
        });
        let key = (relay, kind == EdgeKind::Rising, below);
        if let Some(&edge) = self.logic.shared_edges.get(&key) {
            return edge;
        }
        let edge = self.new_edge();
        self.logic.shared_edges.insert(key, edge);
        edge
    }

    /// The relay of [`rungc_models::Model::single_operation`] that an instruction names.
    fn single_operation(&self, i: usize) -> Option<u32> {
        let (first, last) = self.model.single_operation?;
        let operand = self.resolved.program.instrs[i].operands.first()?;
        let OperandKind::Device(device, None) = operand.kind else {
            return None;
        };
        let holds = device.class == DeviceClass::M && (first..=last).contains(&device.number);
        holds.then_some(device.number)
    }

    pub(super) fn compare_contact(&mut self, join: Join, op: CmpOp) {
        let (Some(a), Some(b)) = (self.operand(0), self.operand(1)) else {
            return;
        };
        self.mark_contact();
        let wide = self.resolution().form.wide;
        let mut guards = Guards::default();
        let a = self.value(a, wide, &mut guards);
        let b = self.value(b, wide, &mut guards);
        let holds = self.add(Expr::Cmp(op, a, b));
        let contact = self.guarded_value(guards, holds);
        self.join(join, contact);
    }

    /// ANB, ORB.
    pub(super) fn join_blocks(&mut self, join: Join) {
        if let Some(last) = self.logic.stack.pop() {
            self.join(join, last);
        }
    }

    /// The result at hand; the bus, if there is none.
    fn take_result(&mut self) -> ExprId {
        match self.logic.stack.pop() {
            Some(result) => result,
            None => self.bit_const(true),
        }
    }

    /// MPS.
    pub(super) fn push_result(&mut self) {
        let result = self.take_result();
        let result = self.settled(result);
        self.logic.stack.push(result);
        self.logic.branches.push(result);
    }

    /// MPP.
    pub(super) fn pop_result(&mut self) {
        self.read_result();
        self.logic.branches.pop();
    }

    /// MRD.
    pub(super) fn read_result(&mut self) {
        if let Some(&pushed) = self.logic.branches.last() {
            self.logic.stack.pop();
            self.logic.stack.push(pushed);
        }
    }

    /// INV.
    pub(super) fn invert_result(&mut self) {
        let result = self.take_result();
        let inverted = self.not(result);
        self.logic.stack.push(inverted);
    }

    /// MEP, MEF.
    pub(super) fn edge_of_result(&mut self, kind: EdgeKind) {
        let result = self.take_result();
        let edge = self.new_edge();
        let changed = self.edge(edge, kind, result);
        self.logic.stack.push(changed);
    }

    /// A value whose operands exist under `guards`: else 0 or off, with a fault.
    pub(super) fn guarded_value(&mut self, guards: Guards, value: ExprId) -> ExprId {
        if guards.is_empty() {
            return value;
        }
        let ty = self.module.ty(value);
        let temp = self.temp(ty);
        let zero = match ty {
            Ty::Bit => Expr::Bit(false),
            Ty::I16 => Expr::I16(0),
            Ty::I32 => Expr::I32(0),
            Ty::F32 => Expr::F32(0.0),
        };
        let zero = self.add(zero);
        self.guarded_or(
            guards,
            |this| this.emit(Action::Let(temp, value)),
            |this| this.emit(Action::Let(temp, zero)),
        );
        self.add(Expr::Temp(temp))
    }
}
