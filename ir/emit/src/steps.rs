//! Ladders: neighbouring blocks of a step ladder as the cases of a choice, with a bit in a word for each.
//!
//! Each block begins with the same statements on a state and two memories: a state that a transition left goes off, and
//! the block runs if its state is on, or was. What differs is the rest. So the runtime finds the blocks that run, and
//! the rest of each is a case. It looks at the states once, before the first block; from there on it notes which of
//! them transitions switch on. States that were left go off there, too, unless blocks read whether later ones are on.
//! Blocks that change their neighbours' states in other ways are tested instead, one by one and in groups.

use crate::plan::{Node, Plan, statements};
use crate::temps::Home;
use rungc_ir::Module;
use rungc_ir::node::{Access, AccessKind, Action, Edge, EdgeId, Expr, ExprId, Steps, Stmt, TempId};
use rungc_ir::reach::{Footprint, beyond_operands, of_action, of_expr, written_by};
use rungc_ir::walk::operands;
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass::S;
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::{Range, RangeInclusive};

/// Number of memories of each block: whether its state was left, and whether it was on.
const MEMORIES: u32 = 2;
/// Maximum number of blocks with one test.
const TESTED: u32 = 8;
/// Number of states of a ladder: bits of a word, and bytes that are read together.
const STATES: RangeInclusive<u32> = 4..=32;

/// Neighbouring blocks that are cases.
pub struct Ladder {
    /// Number of the first state.
    pub first: u32,
    /// Number of states from it on, at most 32; some may have no block here.
    pub states: u32,
    /// True if a block reads states of later ones: then a state that was left goes off where its block begins.
    pub in_turn: bool,
    /// First of the memories of its blocks, which the bits replace.
    memory: u32,
    /// States of its blocks, in order.
    blocks: Vec<u32>,
}

impl Ladder {
    fn numbers(&self) -> Range<u32> {
        self.first..self.first + self.states
    }

    fn memories(&self) -> Range<u32> {
        self.memory..self.memory + MEMORIES * self.blocks.len() as u32
    }
}

/// Returns true if the groups in some blocks have tests, so that these need none.
pub fn are_tested_within(of: &Steps) -> bool {
    of.memories > MEMORIES * TESTED
}

/// The block of a state.
pub struct Case<'n, 'm> {
    /// Number of the state.
    pub state: u32,
    /// Number of the network in which it begins; none for the first one, which begins in front of all.
    pub network: Option<u32>,
    /// The temporary of whether the state is on, if the rest uses it.
    pub on: Option<TempId>,
    /// The rest.
    pub rest: &'n [Node<'m>],
}

/// A change of a ladder's bits.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Move {
    /// A state of this ladder, by its number, is switched on.
    Enter(usize, u32),
    /// The same in a block of this ladder, whose state is left.
    Transfer(usize, u32),
    /// The state of the block, which is in this ladder, is left.
    Leave(usize),
}

impl Move {
    /// Returns true if this block of a ladder enters a state of the same ladder whose block runs after it.
    pub fn is_later(self, block: Option<(usize, u32)>) -> bool {
        match self {
            Move::Enter(ladder, state) | Move::Transfer(ladder, state) => {
                block.is_some_and(|(of, from)| of == ladder && from < state)
            }
            Move::Leave(_) => false,
        }
    }
}

/// The ladders of a program, in order.
#[derive(Default)]
pub struct Ladders {
    all: Vec<Ladder>,
}

impl Ladders {
    /// Finds them.
    pub(crate) fn of(module: &Module, plan: &Plan) -> Self {
        let mut finder = Finder {
            module,
            plan,
            uses: Uses::default(),
            all: Vec::new(),
        };
        for function in &plan.functions {
            finder.note(&function.body);
        }
        for function in &plan.functions {
            finder.find(&function.body);
        }
        finder.all.sort_by_key(|ladder| ladder.memory);
        Ladders { all: finder.all }
    }

    /// Their number.
    pub fn count(&self) -> u32 {
        self.all.len() as u32
    }

    /// A ladder by its number.
    pub fn get(&self, number: usize) -> Option<&Ladder> {
        self.all.get(number)
    }

    /// The ladder of some blocks, and its number.
    pub fn find(&self, of: &Steps) -> Option<(usize, &Ladder)> {
        let memories = of.memory.0..of.memory.0 + of.memories;
        let mut all = self.all.iter().enumerate();
        all.find(|(_, ladder)| ladder.memories() == memories)
    }

    /// Number of memories of edges in addition to bits of ladders.
    pub fn edges(&self, module: &Module) -> u32 {
        module.edges - self.memories_before(module.edges)
    }

    /// The number of a memory among these.
    pub fn edge(&self, memory: EdgeId) -> u32 {
        memory.0 - self.memories_before(memory.0)
    }

    fn memories_before(&self, memory: u32) -> u32 {
        let before = self.all.iter().filter(|ladder| ladder.memory < memory);
        before.map(|ladder| ladder.memories().len() as u32).sum()
    }

    /// The ladder with the block of a state.
    fn of_state(&self, state: u32) -> Option<usize> {
        let has = |ladder: &Ladder| ladder.blocks.contains(&state);
        self.all.iter().position(has)
    }

    /// The ladder of a memory, and the state whose it is.
    fn of_memory(&self, memory: EdgeId) -> Option<(usize, u32)> {
        let mut all = self.all.iter().enumerate();
        let (n, ladder) = all.find(|(_, ladder)| ladder.memories().contains(&memory.0))?;
        let block = (memory.0 - ladder.memory) / MEMORIES;
        Some((n, ladder.blocks[block as usize]))
    }

    /// What the first of some nodes do to a ladder's bits, and their number.
    pub fn next_move(&self, module: &Module, nodes: &[Node]) -> Option<(Move, usize)> {
        let assigned = |at: usize| {
            let (memory, on) = assigned(module, nodes.get(at)?)?;
            Some((self.of_memory(memory)?, on))
        };
        if let Some(((ladder, _), true)) = assigned(0) {
            return Some((Move::Leave(ladder), 1));
        }
        let state = entered(module, nodes.first()?)?;
        let ladder = self.of_state(state)?;
        let mut count = 1;
        if assigned(count) == Some(((ladder, state), false)) {
            count += 1;
        }
        match assigned(count) {
            Some(((left, _), true)) if left == ladder => {
                Some((Move::Transfer(ladder, state), count + 1))
            }
            _ => Some((Move::Enter(ladder, state), count)),
        }
    }
}

/// Assignments of memories in all functions.
#[derive(Default)]
struct Uses {
    /// By memory: states that are switched on in front of each statement that switches it off.
    off: FxHashMap<u32, Vec<Option<u32>>>,
    /// By memory: number of statements that switch it on.
    on: FxHashMap<u32, u32>,
    /// By memory: number of others.
    other: FxHashMap<u32, u32>,
}

/// Finds ladders.
struct Finder<'a, 'm> {
    module: &'a Module,
    plan: &'a Plan<'m>,
    uses: Uses,
    all: Vec<Ladder>,
}

impl Finder<'_, '_> {
    fn note(&mut self, nodes: &[Node]) {
        let mut before = None;
        for node in nodes {
            if let Node::Stmt(Stmt::Do(Action::Edge(edge))) = node {
                let memory = edge.memory.0;
                match assigned(self.module, node) {
                    Some((_, on)) if self.plan.temp(edge.out).used == 0 => match on {
                        true => *self.uses.on.entry(memory).or_default() += 1,
                        false => self.uses.off.entry(memory).or_default().push(before),
                    },
                    _ => *self.uses.other.entry(memory).or_default() += 1,
                }
            }
            before = entered(self.module, node);
            node.bodies().for_each(|body| self.note(body));
        }
    }

    fn find(&mut self, nodes: &[Node]) {
        for node in nodes {
            if let Node::Steps { of, body } = node
                && let Some(ladder) = self.ladder(of, body)
            {
                self.all.push(ladder);
                continue;
            }
            node.bodies().for_each(|body| self.find(body));
        }
    }

    /// The ladder that some blocks are, if they are one.
    fn ladder(&self, of: &Steps, body: &[Node]) -> Option<Ladder> {
        let cases = cases(self.module, self.plan, of, body)?;
        let ladder = Ladder {
            first: of.first,
            states: of.states,
            in_turn: cases.iter().any(|case| self.reads_later(of, case)),
            memory: of.memory.0,
            blocks: cases.iter().map(|case| case.state).collect(),
        };
        let whole = cases.len() > 1 && STATES.contains(&of.states) && self.is_array(&ladder);
        let fit = |(n, case): (usize, &Case)| {
            let memory = ladder.memory + MEMORIES * n as u32;
            self.only_enters(&ladder, case.state, case.rest)
                && self.begins_and_leaves(memory, case)
                && self.only_begins(memory + 1)
        };
        (whole && cases.iter().enumerate().all(fit)).then_some(ladder)
    }

    /// Returns true if its states are stored one after the other, as bits.
    fn is_array(&self, ladder: &Ladder) -> bool {
        let layout = &self.module.layout;
        let area = layout.area(S, ladder.first);
        let whole =
            area.is_some_and(|area| area.array && ladder.numbers().end <= area.first + area.count);
        whole
            && ladder
                .numbers()
                .all(|state| layout.grid(S, state).is_none())
    }

    /// Returns true if statements of the block of a state change no states of the ladder but by switching them on, or
    /// one off whose block has begun.
    fn only_enters(&self, ladder: &Ladder, of: u32, nodes: &[Node]) -> bool {
        nodes.iter().all(|node| {
            let only = match node {
                Node::Stmt(Stmt::Do(action)) => self.only_enters_by(ladder, of, action),
                Node::Stmt(Stmt::Network(_)) | Node::If { .. } | Node::For { .. } => true,
                Node::Stmt(_)
                | Node::Repeat(_)
                | Node::Steps { .. }
                | Node::Parts { .. }
                | Node::Outlined(_) => false,
            };
            only && node.bodies().all(|body| self.only_enters(ladder, of, body))
        })
    }

    fn only_enters_by(&self, ladder: &Ladder, of: u32, action: &Action) -> bool {
        let module = self.module;
        if let Action::Write(access, value) = action
            && let Some(state) = state(*access)
            && (*module.expr(*value) == Expr::Bit(true)
                || *module.expr(*value) == Expr::Bit(false) && state <= of)
        {
            return true;
        }
        let is_one =
            |(first, last): (u32, u32)| first < ladder.numbers().end && ladder.first <= last;
        let mut changes = matches!(action, Action::Clear { .. });
        if let Action::Call(call) = action {
            let mut beyond = beyond_operands(module, call).into_iter();
            changes |= call.function.needs().anywhere
                || beyond.any(|(class, first, last)| class == S && is_one((first, last)));
        }
        written_by(module.model, action, &mut |used| {
            let runs = || used.reach(module.model, &module.exprs).into_iter();
            changes |= used.place.class == S && runs().any(is_one);
        });
        !changes
    }

    /// Returns true if a block reads states of later ones.
    fn reads_later(&self, of: &Steps, case: &Case) -> bool {
        let (module, last) = (self.module, of.first + of.states - 1);
        let mut later = false;
        let mut note = |used: Footprint| {
            let runs = used.reach(module.model, &module.exprs).into_iter();
            let mut runs = runs.filter(|_| used.place.class == S);
            later |= runs.any(|(first, end)| first <= last && case.state < end);
        };
        let mut roots = Vec::new();
        statements(case.rest, &mut |stmt| {
            if let Stmt::Do(action) = stmt {
                // A state that it writes as a whole is not read.
                let is_bit = |access: &Access| access.kind == AccessKind::Bit;
                if !matches!(action, Action::Write(access, _) if is_bit(access)) {
                    of_action(module.model, action, &mut note);
                }
            }
        });
        collect_roots(case.rest, &mut roots);
        let mut seen = FxHashSet::default();
        while let Some(expr) = roots.pop() {
            if !seen.insert(expr) {
                continue;
            }
            of_expr(module.model, module.expr(expr), &mut note);
            roots.extend(operands(module.expr(expr)));
        }
        later
    }

    /// Returns true if a memory of the block is used where it begins, where transitions enter its state, and where they
    /// leave it.
    fn begins_and_leaves(&self, memory: u32, case: &Case) -> bool {
        let mut leaves = 0;
        statements(case.rest, &mut |stmt| {
            leaves += u32::from(matches!(assigned_by(self.module, stmt),
                Some((of, true)) if of.0 == memory));
        });
        let mut enters = self.uses.off.get(&memory).into_iter().flatten();
        self.uses.other.get(&memory) == Some(&1)
            && self.uses.on.get(&memory).copied().unwrap_or(0) == leaves
            && enters.all(|&entered| entered == Some(case.state))
    }

    /// Returns true if a memory is used only where a block begins.
    fn only_begins(&self, memory: u32) -> bool {
        let Uses { off, on, other } = &self.uses;
        other.get(&memory) == Some(&1) && !off.contains_key(&memory) && !on.contains_key(&memory)
    }
}

/// The expressions that some nodes evaluate, with those of the bodies inside them.
fn collect_roots(nodes: &[Node], roots: &mut Vec<ExprId>) {
    for node in nodes {
        roots.extend(node.roots());
        node.bodies().for_each(|body| collect_roots(body, roots));
    }
}

/// The state that a node switches on.
fn entered(module: &Module, node: &Node) -> Option<u32> {
    let Node::Stmt(Stmt::Do(Action::Write(access, value))) = node else {
        return None;
    };
    state(*access).filter(|_| *module.expr(*value) == Expr::Bit(true))
}

/// The memory of an edge to which a node assigns a constant, and the constant.
fn assigned(module: &Module, node: &Node) -> Option<(EdgeId, bool)> {
    let Node::Stmt(stmt) = node else {
        return None;
    };
    assigned_by(module, stmt)
}

fn assigned_by(module: &Module, stmt: &Stmt) -> Option<(EdgeId, bool)> {
    let Stmt::Do(Action::Edge(edge)) = stmt else {
        return None;
    };
    let Expr::Bit(on) = *module.expr(edge.input) else {
        return None;
    };
    let plain = edge.kind == EdgeKind::Rising && edge.index.is_none();
    plain.then_some((edge.memory, on))
}

/// The cases of neighbouring blocks, if all of them begin alike and their states rise.
pub fn cases<'n, 'm>(
    module: &Module,
    plan: &Plan,
    of: &Steps,
    body: &'n [Node<'m>],
) -> Option<Vec<Case<'n, 'm>>> {
    let mut cases = Cases {
        module,
        plan,
        memory: of.memory.0,
        network: None,
        all: Vec::new(),
    };
    cases.add(body)?;
    let all = cases.all;
    let rise = all.is_sorted_by(|a, b| a.state < b.state);
    (rise && all.len() as u32 * MEMORIES == of.memories).then_some(all)
}

/// Collects cases.
struct Cases<'a, 'n, 'm, 'p> {
    module: &'a Module,
    plan: &'a Plan<'p>,
    /// The first memory of the next block.
    memory: u32,
    /// The network in which it begins.
    network: Option<u32>,
    all: Vec<Case<'n, 'm>>,
}

impl<'n, 'm> Cases<'_, 'n, 'm, '_> {
    /// Adds blocks, or groups of them; `None` if there is something else.
    fn add(&mut self, body: &'n [Node<'m>]) -> Option<()> {
        for node in body {
            if let Node::Stmt(Stmt::Network(number)) = node {
                self.network = Some(*number);
                continue;
            }
            let Node::Steps { of, body } = node else {
                return None;
            };
            if of.memories > MEMORIES {
                self.add(body)?;
                continue;
            }
            let alike = of.memory.0 == self.memory && of.memories == MEMORIES;
            let begins = begin(self.module, self.plan, of.first, of.memory, body);
            let (on, rest) = begins.filter(|_| alike)?;
            self.memory += MEMORIES;
            self.all.push(Case {
                state: of.first,
                network: self.network.take(),
                on,
                rest,
            });
        }
        Some(())
    }
}

/// What follows the statements with which a block begins, and the temporary of whether its state is on.
fn begin<'n, 'm>(
    module: &Module,
    plan: &Plan,
    state: u32,
    memory: EdgeId,
    body: &'n [Node<'m>],
) -> Option<(Option<TempId>, &'n [Node<'m>])> {
    let [
        left,
        Node::If {
            cond,
            then,
            otherwise: none,
        },
        begins @ ..,
    ] = body
    else {
        return None;
    };
    let (marked, off) = falling(left, memory)?;
    let goes_off = matches!(&then[..], [Node::Stmt(Stmt::Do(Action::Write(access, value)))]
        if is_state(*access, state) && *module.expr(*value) == Expr::Bit(false));
    let is_left =
        *module.expr(off) == Expr::Bit(false) && *module.expr(*cond) == Expr::Temp(marked);
    let (before, last) = begins.split_at(begins.len().checked_sub(1)?);
    let [
        Node::If {
            cond,
            then: rest,
            otherwise,
        },
    ] = last
    else {
        return None;
    };
    let (mut on, mut was_on) = (None, None);
    for node in before {
        if let Node::Stmt(Stmt::Do(Action::Let(temp, value))) = node
            && reads(module, *value, state)
        {
            on = Some(*temp);
        } else {
            was_on = Some(falling(node, EdgeId(memory.0 + 1))?);
        }
    }
    let (was_on, input) = was_on?;
    let is_on = |value: ExprId| {
        reads(module, value, state) || on.is_some_and(|on| *module.expr(value) == Expr::Temp(on))
    };
    let runs = matches!(*module.expr(*cond), Expr::Or(state, left)
        if is_on(state) && *module.expr(left) == Expr::Temp(was_on));
    let alone = [marked, was_on]
        .iter()
        .all(|&temp| plan.temp(temp).used == 1);
    let alike = goes_off && none.is_empty() && is_left && is_on(input) && runs && alone;
    // The condition and the memory use it, too.
    let used = on.filter(|&temp| {
        let beginning = [input, *cond].map(|value| uses(module, value, temp));
        plan.temp(temp).used > beginning.iter().map(|&is| u32::from(is)).sum()
    });
    let local = used.is_none_or(|temp| plan.temp(temp).home() == Home::Constant);
    (alike && local && before.len() <= 2 && otherwise.is_empty()).then(|| (used, &rest[..]))
}

/// The result and the input of the statement that finds a falling edge with this memory.
#[expect(clippy::wildcard_enum_match_arm, reason = "others find no edge")]
fn falling(node: &Node, with: EdgeId) -> Option<(TempId, ExprId)> {
    match node {
        Node::Stmt(Stmt::Do(Action::Edge(Edge {
            memory,
            index: None,
            kind: EdgeKind::Falling,
            input,
            out,
        }))) if *memory == with => Some((*out, *input)),
        _ => None,
    }
}

/// The state that an access is, with a fixed number.
fn state(access: Access) -> Option<u32> {
    let (class, number) = access.device()?;
    (access.kind == AccessKind::Bit && class == S).then_some(number)
}

fn is_state(access: Access, number: u32) -> bool {
    state(access) == Some(number)
}

/// Returns true if an expression reads a state.
fn reads(module: &Module, value: ExprId, state: u32) -> bool {
    matches!(*module.expr(value), Expr::Read(access) if is_state(access, state))
}

/// Returns true if an expression is a temporary, or joins it with another.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "others do not begin a block"
)]
fn uses(module: &Module, value: ExprId, temp: TempId) -> bool {
    match *module.expr(value) {
        Expr::Temp(read) => read == temp,
        Expr::Or(a, _) => *module.expr(a) == Expr::Temp(temp),
        _ => false,
    }
}
