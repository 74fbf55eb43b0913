//! The bits that are stored in lanes, and what code of one instance meets of them.

use crate::fields::{PrintField, PrintStorage};
use rungc_emit::plan::{Node, Plan};
use rungc_emit::storage::{Field, Kind, Storage};
use rungc_ir::Module;
use rungc_ir::node::{Action, Edge, EdgeId, Expr, ExprId, FlagId, Place, Steps, Stmt};
use rungc_ir::reach::{Footprint, of_expr, of_stmt};
use rungc_ir::walk::operands;
use rungc_models::runs::FIRST_SPECIAL;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Use of the fields in lanes by code of one instance.
#[derive(Default)]
pub(super) struct Met {
    /// Stored bit devices, timers and counters.
    pub devices: BTreeSet<(DeviceClass, u32)>,
    /// Those of them that it may write.
    pub written: BTreeSet<(DeviceClass, u32)>,
    /// Timers and counters whose values are written other than by their coils and by RST.
    pub forced: BTreeSet<(DeviceClass, u32)>,
    pub edges: BTreeSet<EdgeId>,
    pub flags: BTreeSet<FlagId>,
}

/// Finds out what nodes meet.
pub(super) struct Meeting<'a, 'm> {
    pub module: &'m Module,
    pub plan: &'a Plan<'m>,
    pub fields: &'a Storage<'m>,
    pub met: Met,
}

impl Meeting<'_, '_> {
    /// Adds the uses of one node, with all that it calls.
    pub fn node(&mut self, node: &Node) {
        for root in node.roots() {
            self.expr(root);
        }
        match node {
            Node::Stmt(stmt) => self.stmt(stmt),
            Node::Outlined(function) => self.function(*function),
            Node::Parts { parts, .. } => parts.iter().for_each(|&(_, part)| self.function(part)),
            Node::Steps { of, .. } => self.steps(of),
            Node::If { .. } | Node::For { .. } | Node::Repeat(_) => {}
        }
        for body in node.bodies() {
            body.iter().for_each(|node| self.node(node));
        }
    }

    /// Adds the uses of a function of the plan.
    pub fn function(&mut self, function: usize) {
        let plan = self.plan;
        plan.functions[function]
            .body
            .iter()
            .for_each(|node| self.node(node));
    }

    /// Adds the uses of an expression.
    pub fn expr(&mut self, id: ExprId) {
        let module = self.module;
        let expr = module.expr(id);
        if let Expr::Flag(flag) = *expr {
            self.met.flags.insert(flag);
        }
        let mut found = Vec::new();
        of_expr(module.model, expr, &mut |used| found.push(used));
        found
            .into_iter()
            .for_each(|used| self.footprint(used, false));
        for operand in operands(expr) {
            self.expr(operand);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        let module = self.module;
        // The effect of a coil and RST on a timer or counter is known where its own coil is printed.
        let coil = matches!(
            stmt,
            Stmt::Do(
                Action::Timer(_)
                    | Action::TimerAt(_)
                    | Action::TimerGoesOn { .. }
                    | Action::Counter16(_)
                    | Action::Counter32(_)
                    | Action::Counter16At(_)
                    | Action::Reset { .. }
            )
        );
        let mut found = Vec::new();
        of_stmt(module.model, stmt, &mut |used| found.push(used));
        found
            .into_iter()
            .for_each(|used| self.footprint(used, !coil));
        let mut fixed = |class, number| {
            self.device(class, number, true);
        };
        match *stmt {
            Stmt::Do(Action::Timer(coil)) => fixed(DeviceClass::T, coil.number),
            Stmt::Do(Action::TimerGoesOn { number, .. }) => fixed(DeviceClass::T, number),
            Stmt::Do(Action::Counter16(coil)) => fixed(DeviceClass::C, coil.number),
            Stmt::Do(Action::Counter32(coil)) => fixed(DeviceClass::C, coil.number),
            Stmt::Do(Action::Edge(Edge { memory, index, .. })) => {
                self.edges(memory, index.is_some())
            }
            Stmt::Do(Action::SetFlag(flag, _)) => {
                self.met.flags.insert(flag);
            }
            Stmt::CallSub(root) => {
                let called = (0..self.plan.functions.len()).filter(|&f| {
                    let function = &self.plan.functions[f];
                    function.root == root as usize && function.is_whole()
                });
                called
                    .collect::<Vec<_>>()
                    .into_iter()
                    .for_each(|f| self.function(f));
            }
            // The special devices that show an error, and all that is cleared.
            Stmt::Do(Action::Fault { .. }) => self.all(FIRST_SPECIAL),
            Stmt::Do(Action::Clear { .. }) => self.all(0),
            Stmt::Network(_)
            | Stmt::Do(_)
            | Stmt::If(_)
            | Stmt::For { .. }
            | Stmt::Repeat(_)
            | Stmt::Steps(_)
            | Stmt::Return
            | Stmt::Parts(_)
            | Stmt::Goto(_)
            | Stmt::Watch { .. } => {}
        }
    }

    fn steps(&mut self, steps: &Steps) {
        let memories = steps.memory.0..steps.memory.0 + steps.memories;
        self.met.edges.extend(memories.map(EdgeId));
        for number in steps.first..steps.first + steps.states {
            self.device(DeviceClass::S, number, false);
        }
    }

    /// All edges that an index leads to are those of a loop's iterations; which ones is not worth knowing.
    fn edges(&mut self, memory: EdgeId, indexed: bool) {
        match indexed {
            true => self.met.edges.extend((0..self.module.edges).map(EdgeId)),
            false => {
                self.met.edges.insert(memory);
            }
        }
    }

    fn all(&mut self, first: u32) {
        let devices: Vec<_> = sliced(self.fields).flat_map(numbers).collect();
        for (class, number) in devices {
            if number >= first {
                self.device(class, number, true);
            }
        }
    }

    fn footprint(&mut self, used: Footprint, forces: bool) {
        let Place { class, .. } = used.place;
        let reached = used.reach(self.module.model, &self.module.exprs);
        for (first, last) in reached {
            for number in first..=last {
                self.device(class, number, used.writes);
                if used.writes && forces && matches!(class, DeviceClass::T | DeviceClass::C) {
                    self.met.forced.insert((class, number));
                }
            }
        }
    }

    fn device(&mut self, class: DeviceClass, number: u32, writes: bool) {
        let stored = self.fields.find(class, number);
        if stored.is_some_and(|field| is_sliced(field.kind)) {
            self.met.devices.insert((class, number));
            if writes {
                self.met.written.insert((class, number));
            }
        }
    }
}

/// Returns true if a device has a bit that is stored in lanes.
fn is_sliced(kind: Kind) -> bool {
    kind != Kind::Word
}

/// The fields that have lanes.
pub(super) fn sliced<'a>(fields: &'a Storage) -> impl Iterator<Item = &'a Field> {
    fields.fields().iter().filter(|field| is_sliced(field.kind))
}

/// The devices of a field.
pub(super) fn numbers(field: &Field) -> impl Iterator<Item = (DeviceClass, u32)> {
    let class = field.class;
    field
        .numbers()
        .map(move |number| (class, number))
        .collect::<Vec<_>>()
        .into_iter()
}

/// The lanes of a device: `all->M0`, `all->T[3]`; of a timer or counter its contact.
pub(super) fn lanes(fields: &Storage, class: DeviceClass, number: u32) -> Option<String> {
    let mut name = String::new();
    fields
        .access(&mut name, class, number)
        .then(|| in_lanes(&name))
}

/// The lanes that stand for a member of the usual struct.
pub(super) fn in_lanes(member: &str) -> String {
    member.replacen("plc->", "all->", 1)
}

/// The lanes that say where the coil of a timer or counter was on.
pub(super) fn coil(fields: &Storage, class: DeviceClass, number: u32) -> Option<String> {
    let field = fields.find(class, number)?;
    let mut name = String::from("all->");
    field.name(&mut name);
    Some(format!("{name}_coil{}", field.subscript(number)))
}

/// The lines that copy what code of one instance meets from its lanes.
pub(super) fn copies_in(module: &Module, fields: &Storage, met: &Met) -> Vec<String> {
    let mut lines = Vec::new();
    for &(class, number) in &met.devices {
        let mut name = String::new();
        if !matches!(class, DeviceClass::T | DeviceClass::C)
            && fields.access(&mut name, class, number)
        {
            lines.push(format!("{name} = plc_in_lane({}, l);", in_lanes(&name)));
        }
    }
    for name in private(module, met) {
        lines.push(format!("plc->{name} = plc_in_lane(all->{name}, l);"));
    }
    lines
}

/// The lines that copy it back.
pub(super) fn copies_out(module: &Module, fields: &Storage, met: &Met) -> Vec<String> {
    let mut lines = Vec::new();
    for &(class, number) in &met.written {
        let mut name = String::new();
        if !fields.access(&mut name, class, number) {
            continue;
        }
        let lanes = in_lanes(&name);
        if matches!(class, DeviceClass::T | DeviceClass::C) {
            lines.push(format!("plc_put_lane(&{lanes}, l, {name}.done);"));
            let coil = coil(fields, class, number).unwrap_or_default();
            let on = if class == DeviceClass::T {
                " != 0u"
            } else {
                ""
            };
            lines.push(format!("plc_put_lane(&{coil}, l, {name}.coil{on});"));
        } else {
            lines.push(format!("plc_put_lane(&{lanes}, l, {name});"));
        }
    }
    for name in private(module, met) {
        lines.push(format!("plc_put_lane(&all->{name}, l, plc->{name});"));
    }
    lines
}

/// The edge memories and flags, by their names.
fn private(module: &Module, met: &Met) -> Vec<String> {
    let edges = met.edges.iter().map(|edge| {
        let mut name = String::new();
        // Writing to a String does not fail.
        let _ = write!(name, "edge[{}]", edge.0);
        name
    });
    let flags = met
        .flags
        .iter()
        .map(|&flag| module.flags[flag].name.clone());
    edges.chain(flags).collect()
}
