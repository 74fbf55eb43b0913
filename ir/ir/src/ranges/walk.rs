//! Executes a module with intervals in the place of values, until nothing more can become of it.

use super::eval::Eval;
use super::interval::Interval;
use super::state::{Known, Mask, State, join};
use crate::node::{
    Access, AccessKind, Action, Body, Branch, Expr, ExprId, Function, LabelId, Part, Place, Stmt,
    TempId, Ty,
};
use crate::reach::{self, of_access};
use crate::walk::{assigned, bodies, for_exprs, operands, statements};
use rungc_models::runs::FIRST_SPECIAL;
use rungc_syntax::DeviceClass;
use rustc_hash::{FxHashMap, FxHashSet};

/// From which sweep or iteration on states that grow are widened, and from which on to the ends of all words.
const WIDENED: usize = 6;
const WIDENED_WHOLLY: usize = 16;
/// Number of sweeps that narrow the results.
const NARROWED: usize = 4;
/// Maximum number of statements, over all iterations of a loop, for which they are executed one by one.
const UNROLLED: usize = 20_000;

/// Knowledge at the beginning and end of functions, and between scans.
#[derive(Clone, PartialEq)]
struct Facts {
    entries: Vec<Option<State>>,
    exits: Vec<Option<State>>,
    between: State,
}

/// The walk.
pub(super) struct Walk<'m> {
    eval: Eval<'m>,
    thresholds: Vec<i32>,
    /// Tracked words that each function may write, including those of its callees.
    writes: Vec<Mask>,
    /// Temporaries of which something is known at times.
    tracked: FxHashSet<TempId>,
    /// Statements that write tracked words, constrain them or go elsewhere, by address.
    matters: FxHashSet<*const Stmt>,
    /// Statements that have a [`Expr::Within`], by address.
    indexes: FxHashSet<*const Stmt>,
    /// Results of the last sweep, and of this one.
    known: Facts,
    next: Facts,
    /// Knowledge where the current function is left early, and where jumps lead.
    returns: Option<State>,
    labels: Vec<(LabelId, Option<State>)>,
    /// Number of statements that the iterations of the next loop may have.
    unrolled: usize,
    /// Bounds of each [`Expr::Within`] where it is evaluated, collected in the last sweep.
    found: Option<FxHashMap<ExprId, Interval>>,
}

impl<'m> Walk<'m> {
    /// Bounds of each [`Expr::Within`] of the module; those without an interval are never evaluated.
    pub(super) fn run(eval: Eval<'m>) -> FxHashMap<ExprId, Interval> {
        let functions = eval.module.functions.len();
        let facts = Facts {
            entries: vec![None; functions],
            exits: vec![None; functions],
            between: State::power_on(&eval.words),
        };
        let mut walk = Walk {
            thresholds: eval.thresholds(),
            writes: Vec::new(),
            tracked: FxHashSet::default(),
            matters: FxHashSet::default(),
            indexes: FxHashSet::default(),
            known: facts.clone(),
            next: facts.clone(),
            returns: None,
            labels: Vec::new(),
            unrolled: UNROLLED,
            found: None,
            eval,
        };
        walk.writes = walk.written();
        walk.tracked = walk.tracked_temporaries();
        for function in &walk.eval.module.functions {
            walk.sort(&function.body);
        }
        walk.grow();
        for _ in 0..NARROWED {
            walk.next = facts.clone();
            walk.sweep();
            walk.known = walk.next.clone();
        }
        walk.found = Some(FxHashMap::default());
        walk.sweep();
        walk.found.unwrap_or_default()
    }

    /// Executes all functions until what is known holds for all that can happen.
    fn grow(&mut self) {
        for sweep in 0.. {
            self.next = self.known.clone();
            self.sweep();
            if self.next == self.known {
                return;
            }
            if sweep >= WIDENED {
                let thresholds = match sweep {
                    WIDENED_WHOLLY.. => &[],
                    _ => self.thresholds.as_slice(),
                };
                let (known, next) = (&self.known, &mut self.next);
                next.between.widen(&known.between, thresholds);
                let before = known.entries.iter().chain(&known.exits);
                let after = next.entries.iter_mut().chain(&mut next.exits);
                for (before, after) in before.zip(after) {
                    if let (Some(before), Some(after)) = (before, after) {
                        after.widen(before, thresholds);
                    }
                }
            }
            std::mem::swap(&mut self.known, &mut self.next);
        }
    }

    /// Tracked words that functions may write.
    fn written(&self) -> Vec<Mask> {
        let functions = &self.eval.module.functions;
        let mut writes: Vec<Mask> = vec![0; functions.len()];
        loop {
            let before = writes.clone();
            for (i, function) in functions.iter().enumerate() {
                statements(&function.body, &mut |stmt| {
                    writes[i] |= if let Stmt::CallSub(n) = stmt {
                        before.get(*n as usize).copied().unwrap_or(0)
                    } else {
                        self.writes_of(stmt, None)
                    };
                });
            }
            if writes == before {
                return writes;
            }
        }
    }

    /// Temporaries that are assigned integers, or conditions over tracked words or over each other.
    fn tracked_temporaries(&self) -> FxHashSet<TempId> {
        let mut tracked = FxHashSet::default();
        for function in &self.eval.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Let(temp, value)) = *stmt {
                    let integer = matches!(self.eval.module.ty(value), Ty::I16 | Ty::I32);
                    if integer || self.eval.reads(value) != (0, 0) {
                        tracked.insert(temp);
                    }
                }
            });
        }
        tracked
    }

    /// Sorts statements by what is to be done with them; whether any of these matters, and whether any has an index.
    fn sort(&mut self, body: &Body) -> (bool, bool) {
        let mut any = (false, false);
        for stmt in body {
            let (mut matters, mut indexes) = (self.matters(stmt), false);
            for_exprs(stmt, &mut |id| indexes |= self.has_within(*id));
            for inner in bodies(stmt) {
                let inner = self.sort(inner);
                matters |= inner.0;
                indexes |= inner.1;
            }
            if matters {
                self.matters.insert(stmt);
            }
            if indexes {
                self.indexes.insert(stmt);
            }
            any = (any.0 | matters, any.1 | indexes);
        }
        any
    }

    /// Returns true if a statement itself changes the knowledge.
    fn matters(&self, stmt: &Stmt) -> bool {
        let leaves = matches!(stmt, Stmt::CallSub(_) | Stmt::Return | Stmt::Goto(_));
        let tracked = assigned(stmt).is_some_and(|temp| self.tracked.contains(&temp));
        leaves || tracked || self.writes_of(stmt, None) != 0
    }

    fn has_within(&self, id: ExprId) -> bool {
        let expr = self.eval.module.expr(id);
        matches!(expr, Expr::Within { .. }) || operands(expr).any(|id| self.has_within(id))
    }

    /// Tracked words that a statement itself may write, here or anywhere.
    fn writes_of(&self, stmt: &Stmt, state: Option<&State>) -> Mask {
        let all = (1 as Mask)
            .checked_shl(self.eval.words.len() as u32)
            .map_or(Mask::MAX, |bit| bit - 1);
        if let Stmt::Do(Action::Clear { .. }) = stmt {
            return all;
        }
        let mut written = 0;
        reach::of_stmt(self.eval.module.model, stmt, &mut |used| {
            if used.writes {
                written |= self.devices(used.place, used.count, state);
            }
        });
        written
    }

    /// The tracked words among those from a place on.
    fn devices(&self, place: Place, count: Option<u32>, state: Option<&State>) -> Mask {
        use DeviceClass::{D, R, V, Z};
        if !matches!(place.class, D | R | V | Z) {
            return 0;
        }
        let words = &self.eval.words;
        if place.index.is_none() && count == Some(1) {
            return words.slot(place).map_or(0, |slot| 1 << slot);
        }
        let (first, last) = match (place.index, state) {
            (None, _) => (place.number, place.number),
            (Some(_), None) => (0, u32::MAX),
            (Some(index), Some(state)) => {
                let index = self.eval.value(state, index);
                let to = |end: i32| {
                    let number = i64::from(place.number) + i64::from(end);
                    u32::try_from(number.max(0)).unwrap_or(u32::MAX)
                };
                (to(index.low), to(index.high))
            }
        };
        let end = match count {
            Some(count) => last.saturating_add(count.max(1) - 1),
            None => u32::MAX,
        };
        // A run of ordinary registers does not continue into special ones.
        let end = if place.class == D && last < FIRST_SPECIAL {
            end.min(FIRST_SPECIAL - 1)
        } else {
            end
        };
        words.within(place.class, first, end)
    }

    /// Executes all functions once.
    fn sweep(&mut self) {
        let functions: &'m [Function] = &self.eval.module.functions;
        let mut between = self.known.between.clone();
        between.may_become(self.eval.words.shared, Interval::WORD);
        // `Begin`, `Main` and `End` follow each other. Nothing else is done in a scan, and in STOP `Begin` alone.
        let begin = self.function(0, Some(between.clone()));
        let main = self.function(1, begin.clone());
        let end = self.function(2, main);
        let mut ends = vec![begin, end];
        for (i, function) in functions.iter().enumerate().skip(3) {
            let by_host = function.kind.runs_between_scans();
            let called = self.known.entries[i].clone();
            let entry = match by_host {
                true => join(called, Some(between.clone())),
                false => called,
            };
            let exit = self.function(i, entry);
            if by_host {
                ends.push(exit);
            }
        }
        for end in ends.into_iter().flatten() {
            self.next.between.join(&end.words_only());
        }
    }

    /// Executes a function; what is known where it ends.
    fn function(&mut self, i: usize, entry: Option<State>) -> Option<State> {
        self.returns = None;
        let body = &self.eval.module.functions[i].body;
        let end = self.body(body, entry);
        let exit = join(end, self.returns.take()).map(|exit| exit.words_only());
        self.next.exits[i] = join(self.next.exits[i].take(), exit.clone());
        exit
    }

    /// Executes statements and returns what is known after them; `None` if nothing there is executed.
    fn body(&mut self, body: &'m [Stmt], mut state: Option<State>) -> Option<State> {
        let mut at = 0;
        while let Some(stmt) = body.get(at) {
            let before = state?;
            if let Stmt::If(Branch { cond, .. }) = *stmt
                && self.is_due(stmt)
            {
                let together = self.with_one_condition(cond, &body[at..]);
                let group = &body[at..at + together];
                state = self.branches(cond, group, before);
                at += together;
            } else {
                state = self.stmt(stmt, before);
                at += 1;
            }
        }
        state
    }

    /// Returns true if a statement has to be processed in this sweep.
    fn is_due(&self, stmt: &Stmt) -> bool {
        let stmt: *const Stmt = stmt;
        let asked = self.found.is_some() && self.indexes.contains(&stmt);
        asked || self.matters.contains(&stmt)
    }

    /// Number of these statements, the first of which has a condition, that may be executed as if they shared one
    /// condition.
    fn with_one_condition(&self, cond: ExprId, body: &[Stmt]) -> usize {
        let Expr::Temp(temp) = *self.eval.module.expr(cond) else {
            return 1;
        };
        let same = |stmt: &&Stmt| {
            let is_it = |cond: ExprId| *self.eval.module.expr(cond) == Expr::Temp(temp);
            !self.is_due(stmt) || matches!(**stmt, Stmt::If(Branch { cond, .. }) if is_it(cond))
        };
        let mut count = 0;
        for stmt in body.iter().take_while(same) {
            count += 1;
            let mut reassigned = false;
            statements(std::slice::from_ref(stmt), &mut |stmt| {
                reassigned |= assigned(stmt) == Some(temp);
            });
            if reassigned {
                break;
            }
        }
        count.max(1)
    }

    /// Statements with one condition.
    fn branches(&mut self, cond: ExprId, group: &'m [Stmt], state: State) -> Option<State> {
        for stmt in group {
            self.note(stmt, &state);
        }
        let mut ends = [true, false].map(|on| {
            let mut state = self.eval.when(state.clone(), cond, on);
            for stmt in group {
                if let Stmt::If(Branch {
                    then, otherwise, ..
                }) = stmt
                    && self.is_due(stmt)
                {
                    state = self.body(if on { then } else { otherwise }, state);
                }
            }
            state
        });
        join(ends[0].take(), ends[1].take())
    }

    fn stmt(&mut self, stmt: &'m Stmt, mut state: State) -> Option<State> {
        if !self.is_due(stmt) {
            return Some(state);
        }
        self.note(stmt, &state);
        match *stmt {
            Stmt::Do(Action::Let(temp, value)) => {
                let known = self.known(&state, temp, value);
                state.set_temp(temp, known);
            }
            Stmt::Do(Action::Write(access, value)) => {
                let value = self.eval.value(&state, value);
                self.write(&mut state, access, value);
            }
            Stmt::If(_) => return Some(state),
            Stmt::For { count, ref body } => return self.repeat(count, body, state),
            // What it leaves out has no effect.
            Stmt::Steps(ref steps) => return self.body(&steps.body, Some(state)),
            Stmt::CallSub(n) => return self.call(n as usize, state),
            Stmt::Return => {
                self.returns = join(self.returns.take(), Some(state));
                return None;
            }
            Stmt::Goto(label) => {
                let mut labels = self.labels.iter_mut().rev();
                if let Some((_, known)) = labels.find(|known| known.0 == label) {
                    *known = join(known.take(), Some(state.words_only()));
                }
                return None;
            }
            Stmt::Parts(ref parts) => return self.parts(parts, &state),
            Stmt::Do(Action::Clear { .. }) => {
                let all = self.writes_of(stmt, None);
                state.may_become(all, Interval::of(0));
            }
            Stmt::Network(_) | Stmt::Do(_) | Stmt::Repeat(_) | Stmt::Watch { .. } => {
                if let Some(temp) = assigned(stmt) {
                    state.set_temp(temp, None);
                }
                let written = self.writes_of(stmt, Some(&state));
                state.may_become(written, Interval::WORD);
            }
        }
        Some(state)
    }

    /// Knowledge of a temporary that is assigned a value.
    fn known(&self, state: &State, temp: TempId, value: ExprId) -> Option<Known> {
        match self.eval.module.ty(value) {
            Ty::Bit => {
                let (words, temps) = self.eval.reads(value);
                let of_itself = temps & super::state::temp_bit(temp) != 0;
                let tells = (words, temps) != (0, 0) && !of_itself;
                tells.then_some(Known::Condition(value, words, temps))
            }
            Ty::F32 => None,
            Ty::I16 | Ty::I32 => Some(Known::Value(self.eval.value(state, value))),
        }
    }

    fn write(&self, state: &mut State, access: Access, value: Interval) {
        let place = access.place;
        match access.kind {
            AccessKind::Word => self.write_word(state, place, value),
            AccessKind::Pair if place.index.is_none() => {
                let (low, high) = words_of(value);
                self.write_word(state, place, low);
                self.write_word(state, self.eval.words.high_word(place), high);
            }
            AccessKind::Bit
            | AccessKind::WordBit(_)
            | AccessKind::Pair
            | AccessKind::Float
            | AccessKind::Nibbles { .. } => {
                let mut written = 0;
                of_access(self.eval.module.model, access, true, &mut |used| {
                    written |= self.devices(used.place, used.count, Some(state));
                });
                state.may_become(written, Interval::WORD);
            }
        }
    }

    fn write_word(&self, state: &mut State, place: Place, value: Interval) {
        match self.eval.words.slot(place) {
            Some(slot) => state.set(slot, value),
            None => {
                let written = self.devices(place, Some(1), Some(state));
                state.may_become(written, value);
            }
        }
    }

    /// A subroutine leaves the words that it does not write as they are.
    fn call(&mut self, n: usize, mut state: State) -> Option<State> {
        let entry = &mut self.next.entries[n];
        *entry = join(entry.take(), Some(state.words_only()));
        let exit = self.known.exits[n].as_ref()?;
        state.take(self.writes[n], exit);
        Some(state)
    }

    /// A loop: iteration by iteration if there are few, otherwise with what holds at the start of every iteration.
    fn repeat(&mut self, count: ExprId, body: &'m Body, state: State) -> Option<State> {
        let count = self.eval.value(&state, count);
        let (least, most) = (count.low.max(1), count.high.max(1));
        let mut size = 1;
        statements(body, &mut |_| size += 1);
        let room = self.unrolled / most as usize;
        if size > room {
            return self.any_iteration(body, state);
        }
        let outside = std::mem::replace(&mut self.unrolled, room);
        let (mut now, mut end) = (Some(state), None);
        for iteration in 1..=most {
            let next = self.body(body, now.clone());
            let settled = next == now;
            if iteration >= least || settled {
                end = join(end, next.clone());
            }
            if next.is_none() || settled {
                break;
            }
            now = next;
        }
        self.unrolled = outside;
        end
    }

    fn any_iteration(&mut self, body: &'m Body, mut entry: State) -> Option<State> {
        for iteration in 0.. {
            let end = self.body(body, Some(entry.clone()))?;
            let mut next = entry.clone();
            next.join(&end);
            if next == entry {
                return Some(end);
            }
            match iteration {
                0..WIDENED => {}
                WIDENED_WHOLLY.. => next.widen(&entry, &[]),
                _ => next.widen(&entry, &self.thresholds),
            }
            entry = next;
        }
        None
    }

    fn parts(&mut self, parts: &'m [Part], state: &State) -> Option<State> {
        let outside = self.labels.len();
        let labels = parts.iter().filter_map(|part| part.label);
        self.labels.extend(labels.map(|label| (label, None)));
        let mut end = None;
        for iteration in 0.. {
            let before = self.labels[outside..].to_vec();
            let mut flow = Some(state.clone());
            for part in parts {
                let mut labels = self.labels[outside..].iter();
                let jumped = labels.find(|known| Some(known.0) == part.label);
                let jumped = jumped.and_then(|known| known.1.clone());
                flow = self.body(&part.body, join(flow, jumped));
            }
            end = flow;
            let mut grown = false;
            for ((_, after), (_, before)) in self.labels[outside..].iter_mut().zip(&before) {
                grown |= after != before;
                if let (Some(after), Some(before), WIDENED..) = (after, before, iteration) {
                    let wholly = iteration >= WIDENED_WHOLLY;
                    after.widen(before, if wholly { &[] } else { &self.thresholds });
                }
            }
            if !grown {
                break;
            }
        }
        self.labels.truncate(outside);
        end
    }

    /// Takes note of where indexes lie when a statement evaluates them.
    fn note(&mut self, stmt: &Stmt, state: &State) {
        let Some(found) = &mut self.found else {
            return;
        };
        let mut open = Vec::new();
        for_exprs(stmt, &mut |id| open.push(*id));
        while let Some(id) = open.pop() {
            let expr = self.eval.module.expr(id);
            open.extend(operands(expr));
            if let Expr::Within { value, .. } = *expr {
                let value = self.eval.value(state, value);
                let known = found.entry(id).or_insert(value);
                *known = known.join(value);
            }
        }
    }
}

/// The low and the high word of a 32-bit value.
fn words_of(value: Interval) -> (Interval, Interval) {
    let sign = Interval {
        low: value.low >> 16,
        high: value.high >> 16,
    };
    match value.meet(Interval::WORD) {
        Some(same) if same == value => (value, sign),
        _ => (Interval::WORD, sign),
    }
}
