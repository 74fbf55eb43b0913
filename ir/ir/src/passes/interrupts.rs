//! Calls of `TakeInterrupts` that can wait for a later one.
//!
//! `Main` calls it at the start of each network. Where the statements up to the next call neither notice what the
//! routines do nor change what these look at, the routines may as well run there. Of neighbouring calls only the last
//! one stays then: in front of what would notice, and after [`LONGEST_WAIT`] steps at the latest, so that a routine
//! whose request comes from an interrupt handler while the scan runs does not wait long. Relays that catch pulses wait
//! any time: they keep what they caught.

use crate::node::{
    Action, Body, Branch, Edge, Expr, ExprId, FunctionKind, Module, Part, SetEntry, Steps, Stmt,
};
use crate::reach::{self, Footprint};
use crate::walk::{callees, calls_runtime, for_exprs, operands, statements};
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashSet;

/// Maximum number of steps of the program by which a routine runs later.
const LONGEST_WAIT: u32 = 100;

/// Leaves out calls that can wait.
pub(super) fn run(module: &mut Module) {
    let position = |kind| module.functions.iter().position(|f| f.kind == kind);
    let (Some(take), Some(main)) = (
        position(FunctionKind::TakeInterrupts),
        position(FunctionKind::Main),
    ) else {
        return;
    };
    let take = take as u32;
    let end = position(FunctionKind::End).map(|end| &module.functions[end].body);
    let at_end = end.is_some_and(|end| end.first() == Some(&Stmt::CallSub(take)));
    let mut body = std::mem::take(&mut module.functions[main].body);
    let deferral = Deferral::of(module, take);
    deferral.body(&mut body, 0, at_end.then_some(module.steps));
    module.functions[main].body = body;
}

/// What a function and those that it calls use.
#[derive(Default)]
struct Uses {
    devices: Vec<Used>,
    /// An index register, by any of its names.
    index: bool,
    private: FxHashSet<Private>,
    /// Something else, too: the runtime may use any special device, an error is shown in some.
    others: bool,
}

/// Devices from `first` to `last`.
struct Used {
    class: DeviceClass,
    first: u32,
    last: u32,
    writes: bool,
}

/// A flag, a cell, a table or an edge memory, by its number.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Private {
    Flag(usize),
    Cell(usize),
    Table(usize),
    Edge(u32),
}

impl Uses {
    fn add(&mut self, module: &Module, stmt: &Stmt) {
        let mut note = |used: Footprint| {
            let class = used.place.class;
            let runs = used.reach(module.model, &module.exprs);
            for (first, last) in runs {
                self.index |= matches!(class, DeviceClass::V | DeviceClass::Z)
                    || module.model.has_alias(class, first, last);
                self.devices.push(Used {
                    class,
                    first,
                    last,
                    writes: used.writes,
                });
            }
        };
        reach::of_stmt(module.model, stmt, &mut note);
        let mut open: Vec<ExprId> = Vec::new();
        for_exprs(stmt, &mut |&id| open.push(id));
        while let Some(id) = open.pop() {
            let expr = module.expr(id);
            reach::of_expr(module.model, expr, &mut note);
            open.extend(operands(expr));
            self.private.extend(private(expr));
        }
        self.add_private(module, stmt);
    }

    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "others use private memory in expressions only"
    )]
    fn add_private(&mut self, module: &Module, stmt: &Stmt) {
        match stmt {
            Stmt::Do(Action::SetFlag(flag, _)) => {
                self.private.insert(Private::Flag(usize::from(*flag)));
            }
            Stmt::Do(Action::SetCell(cell, _)) => {
                self.private.insert(Private::Cell(usize::from(*cell)));
            }
            Stmt::Do(Action::SetEntry(SetEntry { table, .. })) => {
                self.private.insert(Private::Table(usize::from(*table)));
            }
            // An index leads to some memory.
            Stmt::Do(Action::Edge(Edge { index: Some(_), .. })) => {
                self.private.extend((0..module.edges).map(Private::Edge));
            }
            Stmt::Do(Action::Edge(Edge { memory, .. })) => {
                self.private.insert(Private::Edge(memory.0));
            }
            Stmt::Steps(Steps {
                memory, memories, ..
            }) => {
                let memories = memory.0..memory.0 + memories;
                self.private.extend(memories.map(Private::Edge));
            }
            Stmt::Do(
                Action::Fault { .. }
                | Action::Stop
                | Action::RestartWatchdog
                | Action::Clear { .. },
            )
            | Stmt::Watch { .. } => self.others = true,
            stmt => self.others |= calls_runtime(stmt),
        }
    }

    /// Returns true if it matters which of two comes first.
    fn meet(&self, other: &Uses) -> bool {
        let overlap = |one: &Used, with: &Used| {
            (one.writes || with.writes)
                && one.class == with.class
                && one.first <= with.last
                && with.first <= one.last
        };
        let mut devices = self.devices.iter();
        self.index && other.index
            || devices.any(|one| other.devices.iter().any(|with| overlap(one, with)))
            || !self.private.is_disjoint(&other.private)
    }
}

/// Private memory that an expression itself reads.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "others read devices or nothing"
)]
fn private(expr: &Expr) -> Option<Private> {
    match expr {
        Expr::Flag(flag) => Some(Private::Flag(usize::from(*flag))),
        Expr::Cell(cell) => Some(Private::Cell(usize::from(*cell))),
        Expr::Entry(table, _) => Some(Private::Table(usize::from(*table))),
        _ => None,
    }
}

/// The decision which calls stay.
struct Deferral<'m> {
    module: &'m Module,
    /// The function that takes interrupts, and what it uses.
    take: u32,
    uses: Uses,
    /// It only sets relays that catch pulses.
    only_catches: bool,
    /// By the number of a function: it may not run before an interrupt is taken.
    notices: Vec<bool>,
}

impl<'m> Deferral<'m> {
    fn of(module: &'m Module, take: u32) -> Self {
        let mut reached = FxHashSet::default();
        let mut uses = Uses::default();
        each_called(module, take, &mut reached, &mut |stmt| {
            uses.add(module, stmt);
        });
        let mut deferral = Deferral {
            module,
            take,
            only_catches: reached.len() == 1 && !uses.others,
            uses,
            notices: Vec::new(),
        };
        let functions = 0..module.functions.len() as u32;
        deferral.notices = functions
            .map(|function| {
                let mut notices = false;
                each_called(module, function, &mut FxHashSet::default(), &mut |stmt| {
                    notices |= deferral.notices(stmt);
                });
                notices
            })
            .collect();
        deferral
    }

    /// Returns true if a statement itself may not be executed before an interrupt is taken.
    fn notices(&self, stmt: &Stmt) -> bool {
        let mut uses = Uses::default();
        uses.add(self.module, stmt);
        // The scan may end at a watchdog. Of special devices, calls do not use those that catch pulses.
        let anywhere = matches!(stmt, Stmt::Watch { .. } | Stmt::Do(Action::Clear { .. }))
            || uses.others && !self.only_catches
            || matches!(stmt, Stmt::Do(Action::Call(call)) if call.function.needs().anywhere);
        anywhere || uses.meet(&self.uses)
    }

    /// Leaves calls out. `step` is that of the network at the start, `after` that of the call which follows the body
    /// before anything that notices. Returns the same for the start of the body.
    fn body(&self, body: &mut Body, mut step: u32, mut after: Option<u32>) -> Option<u32> {
        let mut steps = Vec::with_capacity(body.len());
        for stmt in body.iter() {
            if let Stmt::Network(network) = stmt {
                let network = self.module.networks.get(*network as usize);
                step = network.map_or(step, |network| network.step);
            }
            steps.push(step);
        }
        for at in (0..body.len()).rev() {
            let step = steps[at];
            if body[at] == Stmt::CallSub(self.take) {
                let waits = |next: u32| self.only_catches || next <= step + LONGEST_WAIT;
                match after.filter(|&next| waits(next)) {
                    Some(_) => drop(body.remove(at)),
                    None => after = Some(step),
                }
            } else {
                after = self.stmt(&mut body[at], step, after);
            }
        }
        after
    }

    fn stmt(&self, stmt: &mut Stmt, step: u32, after: Option<u32>) -> Option<u32> {
        let notices = self.notices(stmt);
        let before = match stmt {
            Stmt::If(Branch {
                then, otherwise, ..
            }) => {
                let then = self.body(then, step, after);
                let otherwise = self.body(otherwise, step, after);
                then.zip(otherwise).map(|(one, other)| one.max(other))
            }
            Stmt::Steps(Steps { body, .. }) => {
                let inside = self.body(body, step, after);
                inside.zip(after).map(|(one, other)| one.max(other))
            }
            Stmt::Parts(parts) => {
                let mut next = after;
                for Part { body, .. } in parts.iter_mut().rev() {
                    next = self.body(body, step, next);
                }
                next
            }
            Stmt::For { body, .. } => {
                self.body(body, step, None);
                None
            }
            Stmt::CallSub(function) => after.filter(|_| !self.notices[*function as usize]),
            Stmt::Return | Stmt::Goto(_) | Stmt::Repeat(_) | Stmt::Watch { .. } => None,
            Stmt::Network(_) | Stmt::Do(_) => after,
        };
        before.filter(|_| !notices)
    }
}

/// Calls `visit` with the statements of a function and of those that it calls.
fn each_called(
    module: &Module,
    function: u32,
    reached: &mut FxHashSet<u32>,
    visit: &mut dyn FnMut(&Stmt),
) {
    let mut open = vec![function];
    while let Some(function) = open.pop() {
        if let Some(called) = module.functions.get(function as usize)
            && reached.insert(function)
        {
            statements(&called.body, visit);
            open.extend(
                callees(&called.body)
                    .into_iter()
                    .map(|callee| callee as u32),
            );
        }
    }
}
