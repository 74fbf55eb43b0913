//! Where temporaries live, and what they are called.

use crate::plan::{Node, Plan};
use crate::walk;
use rungc_ir::Module;
use rungc_ir::node::{Expr, ExprId, Stmt, TempId, Ty};
use rungc_ir::walk::for_exprs;
use rungc_rt::EdgeKind;
use rustc_hash::FxHashMap;
use std::fmt::Write;

/// A temporary of the module.
#[derive(Clone, Copy, Default, Debug)]
pub struct Temp {
    /// Name without number: `step`.
    prefix: &'static str,
    /// Step number of the network.
    step: Option<u32>,
    /// Which of this name, from 0.
    ordinal: u32,
    /// How often it is used.
    pub used: u32,
    /// Lives in several C functions: a field of the struct.
    pub field: bool,
    /// Cannot be declared where it is given its value: declared at the top of this C function.
    pub at_top: Option<usize>,
}

impl Temp {
    /// Writes its name: `step12`, `step12_2`.
    pub fn name(&self, out: &mut String) {
        out.push_str(self.prefix);
        // Writing to a String does not fail.
        let _ = match (self.step, self.ordinal) {
            (Some(step), 0) => write!(out, "{step}"),
            (Some(step), n) => write!(out, "{step}_{}", n + 1),
            (None, n) => write!(out, "_{}", n + 1),
        };
    }

    /// Whether it may be declared, as a constant, by the statement that gives it its value.
    pub fn is_constant(&self) -> bool {
        !self.field && self.at_top.is_none()
    }
}

/// Finds out about all temporaries.
pub fn temps(module: &Module, plan: &Plan) -> Vec<Temp> {
    if module.temps.is_empty() {
        return Vec::new();
    }
    let mut scopes = Scopes {
        module,
        plan,
        temps: vec![Temp::default(); module.temps.len()],
        homes: vec![Home::default(); module.temps.len()],
        open: Vec::new(),
        blocks: 0,
        function: 0,
        step: None,
        names: FxHashMap::default(),
        seen: Vec::new(),
    };
    // Functions stand behind those they call, but the network a stretch begins in is its own first statement, so order is no matter.
    for (i, function) in plan.functions.iter().enumerate() {
        scopes.function = i;
        scopes.step = None;
        scopes.block(&function.body);
    }
    scopes.temps
}

#[derive(Clone, Copy, Default)]
struct Home {
    function: Option<usize>,
    /// Block of its one assignment.
    block: Option<u32>,
}

struct Scopes<'a, 'm> {
    module: &'m Module,
    plan: &'a Plan<'m>,
    temps: Vec<Temp>,
    homes: Vec<Home>,
    /// Blocks that are open, from the function's on.
    open: Vec<u32>,
    blocks: u32,
    function: usize,
    step: Option<u32>,
    names: FxHashMap<(&'static str, Option<u32>), u32>,
    /// Buffer of walks.
    seen: Vec<ExprId>,
}

impl Scopes<'_, '_> {
    fn block(&mut self, nodes: &[Node]) {
        self.blocks += 1;
        self.open.push(self.blocks);
        for node in nodes {
            match node {
                Node::Stmt(stmt) => self.stmt(stmt),
                Node::If {
                    cond,
                    then,
                    otherwise,
                } => {
                    self.uses(*cond);
                    self.block(then);
                    self.block(otherwise);
                }
                Node::For { count, body } => {
                    self.uses(*count);
                    self.block(body);
                }
                Node::Repeat { body, .. } => self.block(body),
                Node::Parts { .. } | Node::Stretch(_) => {}
            }
        }
        self.open.pop();
    }

    fn stmt(&mut self, stmt: &Stmt) {
        if let Stmt::Network(network) = stmt {
            self.step = self.module.networks.get(*network as usize).map(|n| n.step);
        }
        for_exprs(stmt, &mut |&e| self.uses(e));
        match stmt {
            Stmt::Let(temp, _) => {
                let prefix = match self.module.temps.get(temp.0 as usize) {
                    Some(Ty::F32) => "real",
                    Some(Ty::I16 | Ty::I32) => "value",
                    _ => "step",
                };
                self.assigns(*temp, prefix);
            }
            Stmt::Edge {
                kind, input, out, ..
            } => self.assigns(
                *out,
                match kind {
                    EdgeKind::Rising => "rising",
                    EdgeKind::Falling if *self.module.expr(*input) == Expr::Bit(false) => "taken",
                    EdgeKind::Falling => "falling",
                },
            ),
            Stmt::Fetch { there, .. } => self.assigns(*there, "fetched"),
            _ => {}
        }
    }

    fn uses(&mut self, expr: ExprId) {
        let mut seen = std::mem::take(&mut self.seen);
        walk::temps(self.module, &self.plan.sizes, expr, &mut seen, |temp| {
            let known = &mut self.temps[temp.0 as usize];
            known.used += 1;
            let home = &mut self.homes[temp.0 as usize];
            known.field |= *home.function.get_or_insert(self.function) != self.function;
            if !home.block.is_some_and(|block| self.open.contains(&block)) {
                known.at_top = Some(self.function);
            }
        });
        self.seen = seen;
    }

    fn assigns(&mut self, temp: TempId, prefix: &'static str) {
        let known = &mut self.temps[temp.0 as usize];
        let home = &mut self.homes[temp.0 as usize];
        known.field |= *home.function.get_or_insert(self.function) != self.function;
        if home.block.is_some() {
            known.at_top = Some(self.function);
        } else {
            home.block = self.open.last().copied();
        }
        // A value at the start of the program belongs to no rung; a later one tells more.
        if known.prefix.is_empty() || (known.step.is_none() && self.step.is_some()) {
            let ordinal = self.names.entry((prefix, self.step)).or_default();
            known.prefix = prefix;
            known.step = self.step;
            known.ordinal = *ordinal;
            *ordinal += 1;
        }
    }
}
