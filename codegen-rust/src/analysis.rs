//! What the generator must know before it writes a function: where temporaries live, what calls what, how long code will be.

use rungc_ir::Module;
use rungc_ir::node::{Expr, ExprId, LabelId, Stmt, TempId};
use rungc_ir::walk::{
    assigned, bodies, called_functions, callees, for_exprs, operands, statements,
};
use std::collections::HashMap;

/// A body, by where its statements lie in memory while the module is borrowed.
type BodyKey = *const Stmt;

/// A statement of a body.
pub type Position = (BodyKey, usize);

/// Key of a body.
pub fn key(body: &[Stmt]) -> BodyKey {
    body.as_ptr()
}

/// The expressions that a statement itself evaluates (not those of its bodies).
pub fn expressions(stmt: &Stmt) -> Vec<ExprId> {
    let mut found = Vec::new();
    for_exprs(stmt, &mut |&id| found.push(id));
    found
}

/// The expressions below `roots`, each once, operands first.
pub fn reachable(module: &Module, roots: &[ExprId]) -> Vec<ExprId> {
    let mut found: Vec<ExprId> = Vec::new();
    let mut seen = std::collections::HashSet::new();
    let mut open = roots.to_vec();
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            found.push(id);
            open.extend(operands(module.expr(id)));
        }
    }
    // Operands have lower handles.
    found.sort_unstable();
    found
}

/// The temporaries that a statement itself reads.
fn read(module: &Module, stmt: &Stmt) -> Vec<TempId> {
    reachable(module, &expressions(stmt))
        .into_iter()
        .filter_map(|id| match *module.expr(id) {
            Expr::Temp(temp) => Some(temp),
            _ => None,
        })
        .collect()
}

/// Whether expressions, written out, have a temporary exactly once.
pub fn reads_once(module: &Module, roots: &[ExprId], temp: TempId) -> bool {
    let mut times: HashMap<ExprId, u32> = HashMap::new();
    for root in roots {
        *times.entry(*root).or_default() += 1;
    }
    let mut reads = 0u32;
    // Parents first, so that each expression's count is complete when it is passed on.
    for id in reachable(module, roots).into_iter().rev() {
        let here = times.get(&id).copied().unwrap_or_default();
        if *module.expr(id) == Expr::Temp(temp) {
            reads = reads.saturating_add(here);
        }
        for operand in operands(module.expr(id)) {
            let count = times.entry(operand).or_default();
            *count = count.saturating_add(here);
        }
    }
    reads == 1
}

/// How often a temporary occurs.
#[derive(Clone, Copy, Default, Debug, PartialEq, Eq)]
pub struct Count {
    /// Statements that assign it.
    pub assigned: u32,
    /// Statements that read it.
    pub read: u32,
}

/// The temporaries of some statements, bodies included, in a fixed order.
pub fn count(module: &Module, stmts: &[Stmt]) -> std::collections::BTreeMap<TempId, Count> {
    let mut counts = std::collections::BTreeMap::new();
    statements(stmts, &mut |stmt| {
        if let Some(temp) = assigned(stmt) {
            counts.entry(temp).or_insert(Count::default()).assigned += 1;
        }
        for temp in read(module, stmt) {
            counts.entry(temp).or_insert(Count::default()).read += 1;
        }
    });
    counts
}

/// Where a temporary is declared.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Declared {
    /// By the statement that assigns it first.
    There {
        /// Whether another one assigns it later.
        again: bool,
    },
    /// In front of this statement, because it is assigned inside and read outside.
    Before(Position),
}

/// A temporary in its function.
#[derive(Clone, Debug)]
struct Life {
    /// The statements that enclose its first occurrence, from the outside in, that one included.
    path: Vec<Position>,
    /// How many of the bodies on the path hold all of its occurrences.
    common: usize,
    count: Count,
}

/// The temporaries of a function.
#[derive(Default)]
pub struct Temps {
    lives: HashMap<TempId, Life>,
}

impl Temps {
    /// Analyses a function's body.
    pub fn of(module: &Module, body: &[Stmt]) -> Self {
        let mut temps = Temps::default();
        temps.visit(module, body, &mut Vec::new());
        temps
    }

    fn visit(&mut self, module: &Module, body: &[Stmt], path: &mut Vec<Position>) {
        for (i, stmt) in body.iter().enumerate() {
            path.push((key(body), i));
            for temp in read(module, stmt) {
                self.occurs(temp, path).read += 1;
            }
            if let Some(temp) = assigned(stmt) {
                self.occurs(temp, path).assigned += 1;
            }
            for inner in bodies(stmt) {
                self.visit(module, inner, path);
            }
            path.pop();
        }
    }

    fn occurs(&mut self, temp: TempId, path: &[Position]) -> &mut Count {
        let life = self.lives.entry(temp).or_insert_with(|| Life {
            path: path.to_vec(),
            common: path.len(),
            count: Count::default(),
        });
        let same = life
            .path
            .iter()
            .zip(path)
            .take_while(|(a, b)| a.0 == b.0)
            .count();
        life.common = life.common.min(same);
        &mut life.count
    }

    /// Where a temporary is declared.
    pub fn declared(&self, temp: TempId) -> Option<Declared> {
        let life = self.lives.get(&temp)?;
        Some(if life.common == life.path.len() {
            Declared::There {
                again: life.count.assigned > 1,
            }
        } else {
            Declared::Before(*life.path.get(life.common.checked_sub(1)?)?)
        })
    }

    /// How often a temporary occurs in the whole function.
    pub fn count(&self, temp: TempId) -> Count {
        self.lives
            .get(&temp)
            .map_or(Count::default(), |life| life.count)
    }

    /// The temporaries to declare in front of a statement, in order.
    pub fn before(&self) -> HashMap<Position, Vec<TempId>> {
        let mut found: HashMap<Position, Vec<TempId>> = HashMap::new();
        for &temp in self.lives.keys() {
            if let Some(Declared::Before(position)) = self.declared(temp) {
                found.entry(position).or_default().push(temp);
            }
        }
        found.values_mut().for_each(|temps| temps.sort_unstable());
        found
    }
}

/// Whether control may leave the statements other than at their end.
pub fn escapes(stmts: &[Stmt]) -> bool {
    let mut labels: Vec<LabelId> = Vec::new();
    let mut gotos = Vec::new();
    let mut returns = false;
    statements(stmts, &mut |stmt| match stmt {
        Stmt::Return | Stmt::Watch { .. } => returns = true,
        Stmt::Goto(label) => gotos.push(*label),
        Stmt::Parts(parts) => labels.extend(parts.iter().filter_map(|part| part.label)),
        _ => {}
    });
    returns || gotos.iter().any(|label| !labels.contains(label))
}

/// Roughly how many lines a statement will be, its bodies included.
pub fn weight(module: &Module, stmt: &Stmt) -> usize {
    let own = match stmt {
        Stmt::Network(_) => 0,
        _ => 1 + reachable(module, &expressions(stmt)).len() / 12,
    };
    own + bodies(stmt)
        .map(|body| 1 + body.iter().map(|stmt| weight(module, stmt)).sum::<usize>())
        .sum::<usize>()
}

/// Whether statements call the runtime.
fn calls_runtime(stmts: &[Stmt]) -> bool {
    let mut found = false;
    statements(stmts, &mut |stmt| {
        found |= rungc_ir::walk::calls_runtime(stmt)
    });
    found
}

/// Which functions the scan reaches, and which of them hand the hardware on.
pub struct Calls {
    /// By function number: called from the scan.
    pub reached: Vec<bool>,
    /// By function number: takes `hal`.
    pub needs_hal: Vec<bool>,
}

impl Calls {
    /// Analyses a module.
    pub fn of(module: &Module) -> Self {
        let callees: Vec<_> = module.functions.iter().map(|f| callees(&f.body)).collect();
        let mut needs_hal: Vec<_> = module
            .functions
            .iter()
            .map(|f| calls_runtime(&f.body))
            .collect();
        // Calls do not recurse, so this ends after as many rounds as calls nest.
        loop {
            let before = needs_hal.clone();
            for (n, called) in callees.iter().enumerate() {
                needs_hal[n] |= called
                    .iter()
                    .any(|&m| before.get(m).copied().unwrap_or(false));
            }
            if before == needs_hal {
                break;
            }
        }
        Calls {
            reached: called_functions(module),
            needs_hal,
        }
    }

    /// Whether the statements hand the hardware on.
    pub fn stmts_need_hal(&self, stmts: &[Stmt]) -> bool {
        let hands_on = |n: usize| self.needs_hal.get(n).copied().unwrap_or(false);
        calls_runtime(stmts) || callees(stmts).into_iter().any(hands_on)
    }
}
