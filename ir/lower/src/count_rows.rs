//! The table of counts at which one high-speed counter interrupts, a row after the other (h1u-h2u-programming §4.3.1,
//! §8.7).
//!
//! Relay, registers and rows are read at each count, so they may change at any time. A table that starts, when its
//! relay turns on or RUN begins, begins with its first row.

use super::Lowerer;
use super::interrupt::Request;
use super::operand::fixed;
use rungc_ir::node::{Access, Action, BinOp, CellId, Expr, ExprId, Place, SysValue};
use rungc_models::interrupts::{CountRows, Source};
use rungc_rt::{CmpOp, EdgeKind, Register};
use rungc_syntax::DeviceClass::{C, D};

impl Lowerer<'_> {
    /// Finds the table, if the program has routines for its rows and something switches it on.
    pub(super) fn find_rows(&mut self, requests: &[Request]) {
        let of_row = |request: &Request| matches!(request.source, Some(Source::Row { .. }));
        let table = self.model.interrupts.count_rows;
        let table = table.filter(|table| self.specials.has(table.enable));
        if let Some(table) = table.filter(|_| requests.iter().any(of_row)) {
            let row = self.cell("row".to_string(), "the row of M8084's table that waits");
            self.interrupts.rows = Some((table, row));
        }
    }

    /// A counter has counted: the row that waits looks at it, if it has counted up.
    pub(super) fn rows_at_count(&mut self, counter: u32, down: ExprId) {
        let Some((table, row)) = self.interrupts.rows else {
            return;
        };
        let works = self.add(Expr::Read(Access::bit(table.enable)));
        let chosen = self.register(table.counter);
        let number = self.add(Expr::I32(counter as i32));
        let is_chosen = self.add(Expr::Cmp(CmpOp::Eq, chosen, number));
        let works = self.and(works, is_chosen);
        let up = self.not(down);
        let works = self.and(works, up);
        self.when(works, |this| {
            let first = this.register(table.first);
            let waits = this.add(Expr::Cell(row));
            let index = this.add(Expr::Bin(BinOp::Add, waits, waits));
            let index = this.add(Expr::Bin(BinOp::Add, first, index));
            let index = this.settled(index);
            let place = Place {
                class: D,
                number: 0,
                index: Some(index),
            };
            let exists = this.add(Expr::InRange {
                place,
                count: 2,
                length: None,
            });
            let rows = this.register(table.rows);
            let left = this.add(Expr::Cmp(CmpOp::Lt, waits, rows));
            let looks = this.and(left, exists);
            this.when(looks, |this| {
                this.row_at_its_count(table, row, place, counter)
            });
        });
    }

    /// The row that waits requests its interrupt, if the count is its own, and makes way for the next.
    fn row_at_its_count(&mut self, table: &CountRows, row: CellId, place: Place, counter: u32) {
        let wanted = self.add(Expr::Read(Access::pair(place)));
        let count = self.add(Expr::Read(Access::pair(fixed(C, counter))));
        let reached = self.add(Expr::Cmp(CmpOp::Eq, count, wanted));
        self.when(reached, |this| {
            let waits = this.add(Expr::Cell(row));
            for pointer in table.pointers() {
                let Some(flag) = this.request_flag(Source::Row { pointer }) else {
                    continue;
                };
                let own = this.add(Expr::I32((pointer - table.pointer) as i32));
                let is_own = this.add(Expr::Cmp(CmpOp::Eq, waits, own));
                this.when(is_own, |this| this.set_flag_to(flag, true));
            }
            let one = this.add(Expr::I32(1));
            let next = this.add(Expr::Bin(BinOp::Add, waits, one));
            this.emit(Action::SetCell(row, next));
            let rows = this.register(table.rows);
            let most = this.add(Expr::I32(table.most as i32));
            let ended = [rows, most].map(|end| this.add(Expr::Cmp(CmpOp::Ge, waits, end)));
            let ended = this.or(ended[0], ended[1]);
            this.when(ended, |this| {
                this.first_row_waits(row);
                this.show_rows_done(table, true);
            });
            this.show_waiting_row(table, row);
        });
    }

    /// Emits the reset of a table that is not enabled to its first row, at the end of a scan.
    pub(super) fn begin_rows(&mut self) {
        let Some((table, row)) = self.interrupts.rows else {
            return;
        };
        let works = self.add(Expr::Read(Access::bit(table.enable)));
        let edge = self.new_edge();
        let went_off = self.edge(edge, EdgeKind::Falling, works);
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        let begins = self.or(went_off, first);
        self.when(begins, |this| {
            this.first_row_waits(row);
            this.show_waiting_row(table, row);
            this.show_rows_done(table, false);
        });
    }

    fn first_row_waits(&mut self, row: CellId) {
        let zero = self.add(Expr::I32(0));
        self.emit(Action::SetCell(row, zero));
    }

    fn show_waiting_row(&mut self, table: &CountRows, row: CellId) {
        if self.specials.has(table.row) {
            let row = self.add(Expr::Cell(row));
            let row = self.add(Expr::Narrow(row));
            self.emit(Action::Write(Access::word(table.row), row));
        }
    }

    fn show_rows_done(&mut self, table: &CountRows, on: bool) {
        if self.specials.has(table.done) {
            let on = self.bit_const(on);
            self.write_relay(table.done, on);
        }
    }

    /// The value of a special register, 0 if nothing writes it.
    fn register(&mut self, register: Register) -> ExprId {
        if !self.specials.has(register) {
            return self.add(Expr::I32(0));
        }
        let value = self.add(Expr::Read(Access::word(register)));
        self.add(Expr::Widen(value))
    }
}
