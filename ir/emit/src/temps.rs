//! The temporaries: where each lives, and what it is called.

use crate::measure::{self, Sizes};
use crate::plan::{Function, Node};
use rungc_ir::Module;
use rungc_ir::node::{Action, Edge, Expr, ExprId, Stmt, TempId, Ty};
use rungc_ir::walk::{assigned, for_exprs};
use rungc_rt::EdgeKind;
use rustc_hash::FxHashMap;
use std::fmt::{self, Display, Formatter};
use typed_index_collections::TiVec;

/// A temporary of the module.
#[derive(Clone, Copy, Default, Debug)]
pub struct Temp {
    /// Its name without numbers: `step`.
    prefix: &'static str,
    /// Step number of the network.
    step: Option<u32>,
    /// Number of the temporary among those of its name, from 0.
    ordinal: u32,
    /// Number of uses.
    pub used: u32,
    /// Scope of the variable.
    home: Home,
}

/// Scope of a temporary.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Home {
    /// A constant of its block: declared by the one statement that gives it its value, and read below that.
    #[default]
    Constant,
    /// A variable of this function of the plan, declared at its top, since no one statement can declare it.
    Variable(usize),
    /// A field of the struct: found in one function, used in another.
    Field,
}

impl Temp {
    /// Scope of the variable.
    pub fn home(&self) -> Home {
        self.home
    }

    /// Names it `on`: whether the state of the block of a ladder is on.
    pub(crate) fn name_on(&mut self) {
        (self.prefix, self.step, self.ordinal) = (ON, None, 0);
    }

    /// It is given its value in several blocks of this function, or used outside the one where it is.
    fn leave_block(&mut self, function: usize) {
        if self.home == Home::Constant {
            self.home = Home::Variable(function);
        }
    }
}

/// Name of whether the state of a block is on, where blocks are the cases of a choice.
pub const ON: &str = "on";

/// Its name: `step12`, `step12_2`, `on`.
impl Display for Temp {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.prefix)?;
        match (self.step, self.ordinal) {
            (Some(step), 0) => write!(f, "{step}"),
            (Some(step), n) => write!(f, "{step}_{}", n + 1),
            (None, _) if self.prefix == ON => Ok(()),
            (None, n) => write!(f, "_{}", n + 1),
        }
    }
}

/// Finds out about all temporaries.
pub(crate) fn temps(module: &Module, functions: &[Function], sizes: &Sizes) -> TiVec<TempId, Temp> {
    if module.temps.is_empty() {
        return TiVec::new();
    }
    let mut scopes = Scopes {
        module,
        sizes,
        temps: vec![Temp::default(); module.temps.len()].into(),
        first: vec![First::default(); module.temps.len()].into(),
        open: Vec::new(),
        blocks: 0,
        function: 0,
        step: None,
        names: FxHashMap::default(),
        seen: Vec::new(),
    };
    for (i, function) in functions.iter().enumerate() {
        scopes.function = i;
        scopes.step = None;
        scopes.block(&function.body);
    }
    scopes.temps
}

/// First occurrence of a temporary.
#[derive(Clone, Copy, Default)]
struct First {
    function: Option<usize>,
    /// Block of its one assignment.
    block: Option<u32>,
}

struct Scopes<'a> {
    module: &'a Module,
    sizes: &'a Sizes,
    temps: TiVec<TempId, Temp>,
    first: TiVec<TempId, First>,
    /// Blocks that are open, from the function's on.
    open: Vec<u32>,
    blocks: u32,
    function: usize,
    step: Option<u32>,
    names: FxHashMap<(&'static str, Option<u32>), u32>,
    /// A buffer of walks.
    seen: Vec<ExprId>,
}

impl Scopes<'_> {
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
                Node::Repeat(stations) => self.block(&stations.body),
                Node::Steps { body, .. } => self.block(body),
                Node::Parts { .. } | Node::Outlined(_) => {}
            }
        }
        self.open.pop();
    }

    fn stmt(&mut self, stmt: &Stmt) {
        if let Stmt::Network(network) = stmt {
            self.step = self.module.networks.get(*network as usize).map(|n| n.step);
        }
        for_exprs(stmt, &mut |&e| self.uses(e));
        if let Some(temp) = assigned(stmt) {
            self.assigns(temp, self.prefix(stmt, temp));
        }
    }

    /// The name without numbers of the temporary to which a statement gives its value.
    fn prefix(&self, stmt: &Stmt, temp: TempId) -> &'static str {
        if let Stmt::Do(Action::Edge(Edge { kind, input, .. })) = stmt {
            return match kind {
                EdgeKind::Rising => "rising",
                EdgeKind::Falling if *self.module.expr(*input) == Expr::Bit(false) => "taken",
                EdgeKind::Falling => "falling",
            };
        }
        match self.module.temps.get(temp) {
            _ if matches!(stmt, Stmt::Do(Action::Fetch(_))) => "fetched",
            Some(Ty::F32) => "real",
            Some(Ty::I16 | Ty::I32) => "value",
            Some(Ty::Bit) | None => "step",
        }
    }

    fn uses(&mut self, expr: ExprId) {
        let mut seen = std::mem::take(&mut self.seen);
        measure::temps(self.module, self.sizes, expr, &mut seen, |temp| {
            let known = &mut self.temps[temp];
            known.used += 1;
            let first = &mut self.first[temp];
            if *first.function.get_or_insert(self.function) != self.function {
                known.home = Home::Field;
            } else if !first.block.is_some_and(|block| self.open.contains(&block)) {
                known.leave_block(self.function);
            }
        });
        self.seen = seen;
    }

    fn assigns(&mut self, temp: TempId, prefix: &'static str) {
        let known = &mut self.temps[temp];
        let first = &mut self.first[temp];
        if *first.function.get_or_insert(self.function) != self.function {
            known.home = Home::Field;
        } else if first.block.is_some() {
            known.leave_block(self.function);
        } else {
            first.block = self.open.last().copied();
        }
        // A value at the start of the program belongs to no rung; a later one says more.
        if known.prefix.is_empty() || (known.step.is_none() && self.step.is_some()) {
            let ordinal = self.names.entry((prefix, self.step)).or_default();
            known.prefix = prefix;
            known.step = self.step;
            known.ordinal = *ordinal;
            *ordinal += 1;
        }
    }
}
