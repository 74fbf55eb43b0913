//! Drums and matrices, which are inline code where the program states how many bits they have: ABSD and MTR.

use super::Lowerer;
use super::blocks::{bits, register};
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{
    Access, AccessKind, Action, BinOp, Branch, CellId, Expr, ExprId, Place, Stmt, SysValue,
};
use rungc_rt::special::M_COMPLETE;
use rungc_rt::{CmpOp, RtFn};
use rungc_syntax::{Device, DeviceClass, Instr};

/// The most bits of a drum.
const BITS: i32 = 16;
/// The most columns of a matrix of switches.
const COLUMNS: i32 = 8;
/// Time for which a column of switches is selected before it is read.
const COLUMN_MS: i32 = rungc_rt::fnc::keys::MTR_MS;

/// Returns true if such an instruction is inline code, judging by its operands.
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let is_bits = |i| kind(i).and_then(bits).is_some();
    let stated = |most| {
        kind(3)
            .and_then(constant)
            .is_some_and(|n| (1..=most).contains(&n))
    };
    match function == RtFn::Absd {
        true => kind(0).and_then(register).is_some() && is_bits(2) && stated(BITS),
        false => function == RtFn::Mtr && (0..3).all(is_bits) && stated(COLUMNS),
    }
}

/// Memory of an MTR.
#[derive(Clone, Copy)]
struct Matrix {
    /// The column that is selected.
    column: CellId,
    /// For how long.
    ms: CellId,
    /// True if the last scan drove it.
    driven: CellId,
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    pub(super) fn inline_drum(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        match function == RtFn::Absd {
            true => self.driven(Self::absolute_drum),
            false => self.read_matrix(),
        }
        true
    }

    /// ABSD: each bit is on while the counter lies in its range; one in falling order is the range round the end.
    fn absolute_drum(&mut self) {
        let (Some(table), Some(first)) = (self.device_of(0), self.device_of(2)) else {
            return;
        };
        let (count, wide) = (self.stated(3), self.wide());
        let words = if wide { 4 } else { 2 } * count;
        let mut guards = Guards::default();
        let value = self.source(1, &mut guards);
        self.demand_block(table, words, &mut guards);
        self.demand_block(first, count, &mut guards);
        let exist = self.exists(table.class, table.number, words)
            && self.exists(first.class, first.number, count);
        self.guarded(guards, |this| {
            if !exist {
                return;
            }
            let value = this.settled(value);
            for k in 0..count {
                let [on, off] = [2 * k, 2 * k + 1].map(|k| this.element_at(table, k, wide));
                let inside = this.is_inside(value, on, off);
                let place = fixed(first.class, first.number + k);
                this.emit(Action::Write(Access::bit(place), inside));
            }
        });
    }

    /// Element `k` of a table of registers: a word or a pair.
    fn element_at(&mut self, table: Device, k: u32, wide: bool) -> ExprId {
        let element = match wide {
            false => self.word_at(table, k),
            true => {
                let place = fixed(table.class, table.number + 2 * k);
                self.add(Expr::Read(Access::pair(place)))
            }
        };
        self.settled(element)
    }

    /// Condition that a value lies from `on` up to, but without, `off`.
    fn is_inside(&mut self, value: ExprId, on: ExprId, off: ExprId) -> ExprId {
        let reached = self.add(Expr::Cmp(CmpOp::Ge, value, on));
        let before = self.add(Expr::Cmp(CmpOp::Lt, value, off));
        let falling = self.add(Expr::Cmp(CmpOp::Gt, on, off));
        let [reached, before] = [reached, before].map(|bit| self.settled(bit));
        let both = self.and(reached, before);
        let either = self.or(reached, before);
        let round = self.and(falling, either);
        self.or(both, round)
    }

    /// MTR: in each scan, driven or not.
    fn read_matrix(&mut self) {
        let devices = [0, 1, 2].map(|i| self.device_of(i));
        let [Some(inputs), Some(outputs), Some(switches)] = devices else {
            return;
        };
        let columns = self.stated(3);
        let matrix = self.matrix();
        let stride = if switches.class == DeviceClass::Y {
            8
        } else {
            10
        };
        let there = [
            (inputs, 8),
            (outputs, columns),
            (switches, stride * (columns - 1) + 8),
        ];
        let exist = there
            .iter()
            .all(|&(first, count)| self.exists(first.class, first.number, count));
        let drive = self.drive();
        let drive = self.settled(drive);
        let was_driven = self.add(Expr::Cell(matrix.driven));
        let was_driven = self.is_int(was_driven, 1, true);
        let was_driven = self.settled(was_driven);
        let then = self.body(|this| {
            let mut guards = Guards::default();
            if !exist {
                guards.demand(this.bit_const(false));
            }
            this.guarded(guards, |this| {
                if exist {
                    this.scan_matrix(matrix, was_driven, (inputs, switches), (columns, stride));
                    this.select_column(matrix, outputs, columns);
                }
            });
        });
        let otherwise = self.body(|this| {
            this.when(was_driven, |this| {
                let none = this.int(0, true);
                for cell in [matrix.column, matrix.ms] {
                    this.emit(Action::SetCell(cell, none));
                }
                let off = this.bit_const(false);
                for k in 0..columns {
                    let place = fixed(outputs.class, outputs.number + k);
                    this.emit(Action::Write(Access::bit(place), off));
                }
            });
        });
        self.emit(Stmt::If(Branch {
            cond: drive,
            then,
            otherwise,
        }));
        let driven = self.add(Expr::BitToInt(drive));
        let driven = self.add(Expr::Widen(driven));
        self.emit(Action::SetCell(matrix.driven, driven));
    }

    /// Creates the memory of another MTR.
    fn matrix(&mut self) -> Matrix {
        self.matrices += 1;
        let n = self.matrices;
        let mut cell = |what: &str, meaning| self.cell(format!("mtr{n}_{what}"), meaning);
        Matrix {
            column: cell("column", "the column of switches that MTR selects"),
            ms: cell("ms", "how long it has selected it, in milliseconds"),
            driven: cell("driven", "whether the last scan drove it"),
        }
    }

    /// Emits the scan of the switches: when a column has been selected long enough its switches are read, and the next
    /// is selected.
    fn scan_matrix(
        &mut self,
        matrix: Matrix,
        was_driven: ExprId,
        (inputs, switches): (Device, Device),
        (columns, stride): (u32, u32),
    ) {
        let passed = self.add(Expr::Sys(SysValue::SinceScanMs));
        let none = self.int(0, true);
        let started = self.not(was_driven);
        self.when(started, |this| this.emit(Action::SetCell(matrix.ms, none)));
        self.when(was_driven, |this| {
            let ms = this.add(Expr::Cell(matrix.ms));
            let ms = this.add(Expr::Bin(BinOp::SatAdd, ms, passed));
            this.emit(Action::SetCell(matrix.ms, ms));
        });
        let ms = self.add(Expr::Cell(matrix.ms));
        let long = self.int(COLUMN_MS, true);
        let over = self.add(Expr::Cmp(CmpOp::Ge, ms, long));
        let over = self.settled(over);
        self.when(over, |this| {
            let group = AccessKind::Nibbles {
                digits: 2,
                wide: false,
            };
            let states = this.add(Expr::Read(group.at(fixed(inputs.class, inputs.number))));
            let states = this.settled(states);
            for k in 0..columns {
                let here = this.is_column(matrix, k);
                let place: Place = fixed(switches.class, switches.number + stride * k);
                this.when(here, |this| {
                    this.emit(Action::Write(group.at(place), states))
                });
            }
            let one = this.int(1, true);
            let column = this.add(Expr::Cell(matrix.column));
            let next = this.add(Expr::Bin(BinOp::Add, column, one));
            this.emit(Action::SetCell(matrix.column, next));
            let beyond = this.is_column(matrix, columns);
            this.when(beyond, |this| {
                this.emit(Action::SetCell(matrix.column, none))
            });
            this.emit(Action::SetCell(matrix.ms, none));
        });
        let first = self.is_column(matrix, 0);
        let complete = self.and(over, first);
        self.set_flag(M_COMPLETE, complete);
    }

    /// The output of the column whose turn it is is on, the others are off.
    fn select_column(&mut self, matrix: Matrix, outputs: Device, columns: u32) {
        for k in 0..columns {
            let here = self.is_column(matrix, k);
            let place = fixed(outputs.class, outputs.number + k);
            self.emit(Action::Write(Access::bit(place), here));
        }
    }

    /// Condition that column `k` is selected.
    fn is_column(&mut self, matrix: Matrix, k: u32) -> ExprId {
        let column = self.add(Expr::Cell(matrix.column));
        self.is_int(column, k as i32, true)
    }
}
