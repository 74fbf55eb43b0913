//! Actions at edges of input terminals, outside the scan.

use super::Lowerer;
use super::operand::fixed;
use rungc_ir::node::{
    Access, Action, BinOp, Body, Branch, Cell, CellId, Expr, ExprId, Flag, FlagId, Function,
    FunctionKind, Stmt, SysValue,
};
use rungc_rt::EdgeKind;
use rungc_syntax::DeviceClass::X;
use std::collections::BTreeMap;

/// Code of edges, and the levels that it asks for.
#[derive(Default)]
pub(super) struct Edges {
    /// By terminal and whether it rises.
    bodies: BTreeMap<(u32, bool), Body>,
    /// Flags that follow a terminal.
    levels: BTreeMap<u32, FlagId>,
    /// A cell that follows the time.
    clock: Option<CellId>,
}

impl Lowerer<'_> {
    /// A new flag.
    pub(super) fn flag(
        &mut self,
        name: String,
        meaning: &'static str,
        period_ms: Option<u32>,
    ) -> FlagId {
        self.module.flags.push_and_get_key(Flag {
            name,
            meaning,
            period_ms,
            pulses_end: None,
            retained: false,
        })
    }

    /// A new cell.
    pub(super) fn cell(&mut self, name: String, meaning: &'static str) -> CellId {
        self.module.cells.push_and_get_key(Cell {
            name,
            meaning,
            follows_time: false,
        })
    }

    /// The time outside the scan, to a millisecond.
    pub(super) fn clock(&mut self) -> CellId {
        if let Some(clock) = self.edges.clock {
            return clock;
        }
        let clock = self.cell("clock_ms".to_string(), "the time, between scans too");
        self.module.cells[clock].follows_time = true;
        self.edges.clock = Some(clock);
        clock
    }

    /// The time outside the scan does not lag that of the scan.
    pub(super) fn begin_clock(&mut self) {
        if let Some(clock) = self.edges.clock {
            let now = self.add(Expr::Sys(SysValue::NowMs));
            self.emit(Action::SetCell(clock, now));
        }
    }

    /// Sets or resets a flag.
    pub(super) fn set_flag_to(&mut self, flag: FlagId, on: bool) {
        let on = self.bit_const(on);
        self.emit(Action::SetFlag(flag, on));
    }

    /// The state of a terminal outside the scan, where the device X may be older.
    pub(super) fn level(&mut self, input: u32) -> ExprId {
        let flag = match self.edges.levels.get(&input) {
            Some(&flag) => flag,
            None => {
                let name = format!("x{input:03o}_on");
                let flag = self.flag(name, "state of the input terminal", None);
                self.edges.levels.insert(input, flag);
                flag
            }
        };
        self.add(Expr::Flag(flag))
    }

    /// Adds the statements of `make` to the actions at an edge, after those added before.
    pub(super) fn on_edge(&mut self, input: u32, kind: EdgeKind, make: impl FnOnce(&mut Self)) {
        let body = self.body(make);
        let key = (input, kind == EdgeKind::Rising);
        self.edges.bodies.entry(key).or_default().extend(body);
    }

    /// Registers count the rising edges of inputs, if something looks at them.
    pub(super) fn edge_counts(&mut self) {
        for (input, &register) in (0..).zip(self.model.high_speed.edge_counts) {
            if !self.keeps(register) {
                continue;
            }
            self.on_edge(input, EdgeKind::Rising, |this| {
                let count = this.add(Expr::Read(Access::word(register)));
                let one = this.int(1, false);
                let count = this.add(Expr::Bin(BinOp::Add, count, one));
                this.emit(Action::Write(Access::word(register), count));
            });
        }
    }

    /// Flags that follow terminals begin as X shows them to the first scan.
    pub(super) fn first_levels(&mut self) {
        if self.edges.levels.is_empty() {
            return;
        }
        let levels = self.edges.levels.clone();
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        self.when(first, |this| {
            for (input, flag) in levels {
                let on = this.add(Expr::Read(Access::bit(fixed(X, input))));
                this.emit(Action::SetFlag(flag, on));
            }
        });
    }

    /// Makes the functions of all edges that mean something. They do nothing in STOP.
    pub(super) fn edge_functions(&mut self) {
        let Edges {
            mut bodies, levels, ..
        } = std::mem::take(&mut self.edges);
        for (&input, &flag) in &levels {
            for on in [false, true] {
                let state = self.bit_const(on);
                let body = bodies.entry((input, on)).or_default();
                body.insert(0, Stmt::Do(Action::SetFlag(flag, state)));
            }
        }
        for ((input, rises), then) in bodies {
            let cond = self.add(Expr::Sys(SysValue::Running));
            let body = vec![Stmt::If(Branch {
                cond,
                then,
                otherwise: Vec::new(),
            })];
            let kind = if rises {
                EdgeKind::Rising
            } else {
                EdgeKind::Falling
            };
            self.module.functions.push(Function {
                kind: FunctionKind::InputEdge { input, kind },
                body,
            });
        }
    }
}
