//! Making expressions and statements.

use super::Lowerer;
use super::parts::Item;
use rungc_ir::node::{Action, Body, Branch, Edge, EdgeId, Expr, ExprId, Stmt, TempId, Ty};
use rungc_ir::walk::operands;
use rungc_rt::EdgeKind;

/// Trees of contacts deeper than this are cut by a temporary, so that no rung is too deep for what reads the IR, or for
/// a compiler of the emitted code.
const MAX_DEPTH: u8 = 40;

impl Lowerer<'_> {
    /// Adds an expression.
    pub(super) fn add(&mut self, expr: Expr) -> ExprId {
        let of = |id: ExprId| self.depths.get(id).copied().unwrap_or(0);
        let depth = operands(&expr)
            .map(|id| of(id).saturating_add(1))
            .max()
            .unwrap_or(0);
        self.depths.push(depth);
        if let Some(marks) = &mut self.marks {
            marks.exprs.push(self.at as u32);
        }
        self.module.add(expr)
    }

    pub(super) fn expr(&self, id: ExprId) -> Expr {
        *self.module.expr(id)
    }

    pub(super) fn bit_const(&mut self, value: bool) -> ExprId {
        self.add(Expr::Bit(value))
    }

    /// Integer constant of either width.
    pub(super) fn int(&mut self, value: i32, wide: bool) -> ExprId {
        self.add(if wide {
            Expr::I32(value)
        } else {
            Expr::I16(value as i16)
        })
    }

    pub(super) fn not(&mut self, a: ExprId) -> ExprId {
        let a = self.shallow(a);
        self.add(Expr::Not(a))
    }

    pub(super) fn and(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let (a, b) = (self.shallow(a), self.shallow(b));
        self.add(Expr::And(a, b))
    }

    pub(super) fn or(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let (a, b) = (self.shallow(a), self.shallow(b));
        self.add(Expr::Or(a, b))
    }

    /// The expression, or a temporary with its value if its tree is too deep to grow.
    fn shallow(&mut self, a: ExprId) -> ExprId {
        if self.depths[a] >= MAX_DEPTH {
            self.settled(a)
        } else {
            a
        }
    }

    /// The expression's value as of now: itself if nothing can change it, else a temporary.
    pub(super) fn settled(&mut self, a: ExprId) -> ExprId {
        if matches!(
            self.expr(a),
            Expr::Temp(_) | Expr::Bit(_) | Expr::I16(_) | Expr::I32(_) | Expr::F32(_)
        ) {
            return a;
        }
        let temp = self.temp(self.module.ty(a));
        self.emit(Action::Let(temp, a));
        self.add(Expr::Temp(temp))
    }

    /// A bit that is known here.
    pub(super) fn known_bit(&self, a: ExprId) -> Option<bool> {
        if let Expr::Bit(on) = self.expr(a) {
            Some(on)
        } else {
            None
        }
    }

    pub(super) fn temp(&mut self, ty: Ty) -> TempId {
        self.module.temps.push_and_get_key(ty)
    }

    pub(super) fn new_edge(&mut self) -> EdgeId {
        self.module.edges += 1;
        EdgeId(self.module.edges - 1)
    }

    pub(super) fn emit(&mut self, stmt: impl Into<Stmt>) {
        self.out.push(Item::Code(stmt.into()));
    }

    /// Detects an edge here; the result.
    pub(super) fn edge(&mut self, edge: EdgeId, kind: EdgeKind, input: ExprId) -> ExprId {
        let out = self.temp(Ty::Bit);
        self.emit(Action::Edge(Edge {
            memory: edge,
            index: None,
            kind,
            input,
            out,
        }));
        self.add(Expr::Temp(out))
    }

    /// Body of the statements that `make` emits. It makes no jumps.
    pub(super) fn body(&mut self, make: impl FnOnce(&mut Self)) -> Body {
        let outer = std::mem::take(&mut self.out);
        make(self);
        let inner = std::mem::replace(&mut self.out, outer);
        inner.into_iter().filter_map(Item::into_stmt).collect()
    }

    /// Emits the statements of `make`, executed if `cond` is on.
    pub(super) fn when(&mut self, cond: ExprId, make: impl FnOnce(&mut Self)) {
        match self.known_bit(cond) {
            Some(true) => make(self),
            Some(false) => {}
            None => {
                let then = self.body(make);
                self.emit(Stmt::If(Branch {
                    cond,
                    then,
                    otherwise: Vec::new(),
                }));
            }
        }
    }
}
