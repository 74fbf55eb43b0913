//! Temporaries: their assignment is put off until they are used, so that a single use can take the expression itself;
//! and a value that another temporary already has is not computed again.

use super::effects::{Reads, Writes};
use super::fold::Arena;
use crate::node::{AccessKind, Expr, ExprId, TempId};
use crate::walk::operands;
use typed_index_collections::TiVec;

/// Expressions deeper than this are not put into others.
const MAX_DEPTH: u8 = 24;
/// Maximum number of assignments that are deferred at a time.
const MAX_PENDING: usize = 16;
/// Maximum number of values that are remembered at a time.
const MAX_AVAILABLE: usize = 8;

/// Numbers of uses and assignments of temporaries, counted over the module; more than one is many.
pub(super) struct Counts {
    pub(super) uses: TiVec<TempId, u32>,
    pub(super) assignments: TiVec<TempId, u32>,
}

/// An assignment that was put off.
#[derive(Debug)]
struct Pending {
    temp: TempId,
    value: ExprId,
    reads: Reads,
    /// Uses that are still to come.
    left: u32,
}

/// A value that a temporary has.
#[derive(Clone, Debug)]
pub(super) struct Available {
    temp: ExprId,
    value: ExprId,
    reads: Reads,
}

/// The temporaries at hand.
pub(super) struct Temps {
    counts: Counts,
    /// Values that would be the same if they were computed again here.
    available: Vec<Available>,
    /// Constants and copies, by temporary.
    known: TiVec<TempId, Option<ExprId>>,
    pending: Vec<Pending>,
}

impl Temps {
    pub(super) fn new(counts: Counts) -> Self {
        Temps {
            known: vec![None; counts.uses.len()].into(),
            available: Vec::new(),
            counts,
            pending: Vec::new(),
        }
    }

    /// Returns true if a temporary is assigned in one place only.
    pub(super) fn is_fixed(&self, temp: TempId) -> bool {
        self.counts.assignments[temp] == 1
    }

    /// Replacement of a temporary at its use.
    pub(super) fn value(&mut self, temp: TempId) -> Option<ExprId> {
        if let Some(known) = self.known[temp] {
            return Some(known);
        }
        let i = self.pending.iter().position(|p| p.temp == temp)?;
        let value = self.pending[i].value;
        self.pending[i].left = self.pending[i].left.saturating_sub(1);
        if self.pending[i].left == 0 {
            self.pending.remove(i);
        }
        Some(value)
    }

    /// Takes note of an assignment; what has to be assigned here and now.
    pub(super) fn assign(
        &mut self,
        arena: &mut Arena,
        temp: TempId,
        value: ExprId,
    ) -> Vec<(TempId, ExprId)> {
        let uses = self.counts.uses[temp];
        if uses == 0 {
            return Vec::new();
        }
        if !self.is_fixed(temp) || !self.uses_only_fixed(arena, value) {
            return vec![(temp, value)];
        }
        let copy = arena.temp(value).is_some();
        if copy || arena.is_constant(value) {
            self.known[temp] = Some(value);
            return Vec::new();
        }
        let movable = uses == 1 || is_leaf(arena, value);
        if !movable || arena.depth(value) > MAX_DEPTH {
            return self.assign_once(arena, temp, value);
        }
        self.pending.push(Pending {
            temp,
            value,
            reads: Reads::of(&arena.exprs, arena.model, value),
            left: uses,
        });
        let excess = self.pending.len().saturating_sub(MAX_PENDING);
        self.pending
            .drain(..excess)
            .map(|p| (p.temp, p.value))
            .collect()
    }

    /// Assigns a value here and now, unless another temporary has it.
    fn assign_once(
        &mut self,
        arena: &mut Arena,
        temp: TempId,
        value: ExprId,
    ) -> Vec<(TempId, ExprId)> {
        let before = self
            .available
            .iter()
            .find(|available| arena.same(available.value, value, u8::MAX));
        if let Some(before) = before {
            self.known[temp] = Some(before.temp);
            return Vec::new();
        }
        if self.available.len() == MAX_AVAILABLE {
            self.available.remove(0);
        }
        self.available.push(Available {
            temp: arena.add(Expr::Temp(temp)),
            value,
            reads: Reads::of(&arena.exprs, arena.model, value),
        });
        vec![(temp, value)]
    }

    /// The values that are known here.
    pub(super) fn available(&self) -> Vec<Available> {
        self.available.clone()
    }

    /// Continues with what was known before.
    pub(super) fn set_available(&mut self, available: Vec<Available>) {
        self.available = available;
    }

    /// Returns true if every temporary in an expression has one value only.
    fn uses_only_fixed(&self, arena: &Arena, value: ExprId) -> bool {
        if let Expr::Temp(temp) = arena.get(value) {
            return self.is_fixed(temp);
        }
        operands(&arena.get(value)).all(|operand| self.uses_only_fixed(arena, operand))
    }

    /// Assignments required before a write.
    pub(super) fn before(&mut self, writes: Writes) -> Vec<(TempId, ExprId)> {
        self.available
            .retain(|available| !available.reads.disturbed_by(writes));
        self.take(|pending| pending.reads.disturbed_by(writes))
    }

    /// Assignments required before a write because their temporaries are used after it, and perhaps in it.
    pub(super) fn shared_before(&mut self, writes: Writes) -> Vec<(TempId, ExprId)> {
        self.take(|pending| pending.left > 1 && pending.reads.disturbed_by(writes))
    }

    /// Assignments required before a condition: of temporaries also used elsewhere.
    pub(super) fn before_condition(&mut self) -> Vec<(TempId, ExprId)> {
        self.take(|pending| pending.left > 1)
    }

    /// Everything that was put off.
    pub(super) fn all(&mut self) -> Vec<(TempId, ExprId)> {
        self.take(|_| true)
    }

    fn take(&mut self, which: impl Fn(&Pending) -> bool) -> Vec<(TempId, ExprId)> {
        if self.pending.is_empty() {
            return Vec::new();
        }
        self.pending
            .extract_if(.., |pending| which(pending))
            .map(|p| (p.temp, p.value))
            .collect()
    }
}

/// Returns true if an expression costs no more than a temporary: a bit or word that is named directly, perhaps
/// inverted.
fn is_leaf(arena: &Arena, value: ExprId) -> bool {
    let expr = arena.get(value);
    if let Expr::Not(inner) = expr {
        let bit = arena.get(inner).as_bit();
        return bit.is_some_and(|place| place.index.is_none());
    }
    if let Expr::Read(access) = expr {
        let one = matches!(access.kind, AccessKind::Bit | AccessKind::Word);
        return one && access.device().is_some();
    }
    matches!(expr, Expr::Sys(_))
}
