//! Looks at expressions and the statements they stand in.

use rungc_ir::Module;
use rungc_ir::node::{Arg, Expr, ExprId, Function, FunctionKind, Place, Stmt, TempId};

/// Calls `f` with each operand of an expression.
pub fn operands(expr: &Expr, mut f: impl FnMut(ExprId)) {
    let mut place = |p: &Place| p.index.into_iter().for_each(&mut f);
    match expr {
        Expr::Bit(_)
        | Expr::I16(_)
        | Expr::I32(_)
        | Expr::F32(_)
        | Expr::Temp(_)
        | Expr::Sys(_) => {}
        Expr::ReadBit(p)
        | Expr::ReadWordBit(p, _)
        | Expr::ReadWord(p)
        | Expr::ReadPair(p)
        | Expr::ReadFloat(p)
        | Expr::ReadNibbles { place: p, .. }
        | Expr::InRange { place: p, .. } => place(p),
        Expr::And(a, b) | Expr::Or(a, b) | Expr::Cmp(_, a, b) | Expr::Bin(_, a, b) => {
            f(*a);
            f(*b);
        }
        Expr::Not(a)
        | Expr::Complement(a)
        | Expr::Neg(a)
        | Expr::Widen(a)
        | Expr::Narrow(a)
        | Expr::HighWord(a)
        | Expr::BitToInt(a) => f(*a),
    }
}

/// Calls `f` with each expression of a statement itself, without the bodies in it.
pub fn stmt_exprs(stmt: &Stmt, mut f: impl FnMut(ExprId)) {
    match stmt {
        Stmt::Network(_)
        | Stmt::CallSub(_)
        | Stmt::Return
        | Stmt::Parts(_)
        | Stmt::Goto(_)
        | Stmt::Fault { .. }
        | Stmt::Stop
        | Stmt::Clear { .. } => {}
        Stmt::Let(_, e) | Stmt::Edge { input: e, .. } => f(*e),
        Stmt::If { cond, .. } => f(*cond),
        Stmt::For { count, .. } => f(*count),
        Stmt::WriteBit(p, e)
        | Stmt::WriteWordBit(p, _, e)
        | Stmt::WriteWord(p, e)
        | Stmt::WritePair(p, e)
        | Stmt::WriteFloat(p, e)
        | Stmt::WriteNibbles {
            place: p, value: e, ..
        } => {
            p.index.into_iter().for_each(&mut f);
            f(*e);
        }
        Stmt::Reset(p) => p.index.into_iter().for_each(f),
        Stmt::Timer { drive, preset, .. } | Stmt::Counter16 { drive, preset, .. } => {
            f(*drive);
            f(*preset);
        }
        Stmt::Counter32 {
            drive,
            down,
            preset,
            ..
        } => {
            f(*drive);
            f(*down);
            f(*preset);
        }
        Stmt::Call { args, drive, .. } => {
            for arg in args {
                match arg {
                    Arg::Const { index, .. } => index.iter().for_each(|&i| f(i)),
                    Arg::Device { place, .. }
                    | Arg::Nibbles { place, .. }
                    | Arg::WordBit { place, .. } => {
                        place.index.into_iter().for_each(&mut f);
                    }
                    Arg::Float(_) | Arg::Text(_) => {}
                }
            }
            drive.iter().for_each(|&d| f(d));
        }
    }
}

/// Size and depth of every expression as it is written out.
pub struct Sizes {
    size: Vec<u32>,
    depth: Vec<u32>,
}

/// From which size on a shared operand may make the written expression much larger than what is stored.
const LARGE: u32 = 256;

impl Sizes {
    /// Measures them all.
    pub fn new(module: &Module) -> Self {
        let mut sizes = Sizes {
            size: Vec::with_capacity(module.exprs.len()),
            depth: Vec::with_capacity(module.exprs.len()),
        };
        for expr in &module.exprs {
            let (mut size, mut depth) = (1u32, 0);
            operands(expr, |e| {
                size = size.saturating_add(sizes.size[e.0 as usize]);
                // Chains of one operator are written side by side.
                let same = std::mem::discriminant(expr) == std::mem::discriminant(module.expr(e));
                let chain = same && matches!(expr, Expr::And(..) | Expr::Or(..));
                depth = depth.max(sizes.depth[e.0 as usize] + u32::from(!chain));
            });
            sizes.size.push(size);
            sizes.depth.push(depth);
        }
        sizes
    }

    /// How many operations it is.
    pub fn size(&self, e: ExprId) -> u64 {
        self.size[e.0 as usize].into()
    }

    /// How deep it nests.
    pub fn depth(&self, e: ExprId) -> u32 {
        self.depth[e.0 as usize]
    }

    /// Whether it is large enough that sharing inside matters.
    pub fn is_large(&self, e: ExprId) -> bool {
        self.size[e.0 as usize] > LARGE
    }
}

/// All expressions below `expr`, itself included, each once, in ascending order, into `found`.
pub fn below(module: &Module, expr: ExprId, found: &mut Vec<ExprId>) {
    found.clear();
    let mut seen = std::collections::HashSet::new();
    let mut todo = vec![expr];
    while let Some(e) = todo.pop() {
        if seen.insert(e) {
            found.push(e);
            operands(module.expr(e), |o| todo.push(o));
        }
    }
    found.sort_unstable();
}

/// Calls `f` with each temporary that an expression uses: once for each use, but in a large expression once for each node.
pub fn temps(
    module: &Module,
    sizes: &Sizes,
    expr: ExprId,
    buffer: &mut Vec<ExprId>,
    mut f: impl FnMut(TempId),
) {
    if sizes.is_large(expr) {
        below(module, expr, buffer);
        for &e in buffer.iter() {
            if let Expr::Temp(temp) = *module.expr(e) {
                f(temp);
            }
        }
        return;
    }
    buffer.clear();
    buffer.push(expr);
    while let Some(e) = buffer.pop() {
        if let Expr::Temp(temp) = *module.expr(e) {
            f(temp);
        }
        operands(module.expr(e), |o| buffer.push(o));
    }
}

/// Which functions the scan cycle calls. Subroutines that nothing calls are left out of the emitted code.
pub fn called_functions(module: &Module) -> Vec<bool> {
    let cyclic = |f: &Function| {
        matches!(
            f.kind,
            FunctionKind::Begin | FunctionKind::Main | FunctionKind::End
        )
    };
    let mut called = vec![false; module.functions.len()];
    let mut todo: Vec<usize> = (0..called.len())
        .filter(|&i| cyclic(&module.functions[i]))
        .collect();
    while let Some(i) = todo.pop() {
        if let Some(known) = called.get_mut(i).filter(|known| !**known) {
            *known = true;
            calls(&module.functions[i].body, &mut todo);
        }
    }
    called
}

fn calls(body: &[Stmt], found: &mut Vec<usize>) {
    for stmt in body {
        match stmt {
            Stmt::CallSub(function) => found.push(*function as usize),
            Stmt::If {
                then, otherwise, ..
            } => {
                calls(then, found);
                calls(otherwise, found);
            }
            Stmt::For { body, .. } => calls(body, found),
            Stmt::Parts(parts) => parts.iter().for_each(|part| calls(&part.body, found)),
            _ => {}
        }
    }
}
