//! Registers of HM that say which edges of inputs interrupt.

use super::Lowerer;
use super::interrupt::Request;
use rungc_ir::node::{Access, Action, BinOp, CellId, Expr, ExprId, SysValue};
use rungc_models::interrupts::{Capture, Source};
use rungc_rt::{CmpOp, EdgeKind};

impl Lowerer<'_> {
    /// Finds the registers of edges that the program's interrupts depend on. At 0, as at power-on, the first input
    /// interrupts and the second one does not: for the first one alone, a register that is not named has no effect.
    pub(super) fn find_captures(&mut self, requests: &[Request]) {
        for capture in self.model.interrupts.captures {
            let captured = |request: &Request| match request.source {
                Some(Source::Input { number, .. }) => capture.inputs.contains(&number),
                _ => false,
            };
            let second = |request: &Request| {
                let [_, second] = capture.inputs;
                matches!(request.source, Some(Source::Input { number, .. }) if number == second)
            };
            let matters = self.names(capture.register) || requests.iter().any(second);
            if matters && requests.iter().any(captured) {
                let name = format!("x{:03o}_edges", capture.inputs[0]);
                let cell = self.cell(name, "which edges interrupt");
                self.interrupts.captures.push((capture, cell));
            }
        }
    }

    /// A counter is reset: a register of edges is read.
    pub(super) fn read_captures(&mut self, counter: u32) {
        let Some(counter) = self.model.high_speed.counter(counter) else {
            return;
        };
        for i in 0..self.interrupts.captures.len() {
            let (capture, cell) = self.interrupts.captures[i];
            if counter.counts.contains(&capture.counted) {
                self.read_capture(capture, cell);
            }
        }
    }

    fn read_capture(&mut self, capture: &Capture, cell: CellId) {
        let edges = self.add(Expr::Read(Access::word(capture.register)));
        let edges = self.add(Expr::Widen(edges));
        self.emit(Action::SetCell(cell, edges));
    }

    /// Emits the reading of the edges' registers at the end of the first scan.
    pub(super) fn first_captures(&mut self) {
        let captures = std::mem::take(&mut self.interrupts.captures);
        if captures.is_empty() {
            return;
        }
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        self.when(first, |this| {
            for (capture, cell) in captures {
                this.read_capture(capture, cell);
            }
        });
    }

    /// Condition for an edge to interrupt; `None`: always.
    pub(super) fn captured(&mut self, input: u32, kind: EdgeKind) -> Option<ExprId> {
        let mut captures = self.interrupts.captures.iter();
        let &(capture, cell) = captures.find(|(capture, _)| capture.inputs.contains(&input))?;
        let Some((mask, value)) = capture.demands(input, kind) else {
            return Some(self.bit_const(false));
        };
        let edges = self.add(Expr::Cell(cell));
        let mask = self.add(Expr::I32(mask));
        let edges = self.add(Expr::Bin(BinOp::And, edges, mask));
        let value = self.add(Expr::I32(value));
        Some(self.add(Expr::Cmp(CmpOp::Eq, edges, value)))
    }
}
