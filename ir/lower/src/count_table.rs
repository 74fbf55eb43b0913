//! Tables of high-speed counters: a row waits for its count, does what it says, and makes way for the next.

use super::Lowerer;
use super::high_speed::{Compare, Counted, Effect};
use super::operand::{BitTarget, Guards};
use rungc_ir::node::{
    Access, AccessKind, Action, BinOp, Branch, CellId, Expr, ExprId, FlagId, Place, SetEntry, Stmt,
    Table, TableId, Ty,
};
use rungc_models::high_speed::TableMode;
use rungc_rt::{CmpOp, Register};
use rungc_syntax::DeviceClass::Y;
use rungc_syntax::OperandKind;

/// Maximum number of rows of a table.
const MOST_ROWS: u32 = 128;

/// Bits of a pattern.
const WORD: u32 = 16;

/// A table at work.
#[derive(Clone)]
pub(super) struct Rows {
    mode: &'static TableMode,
    /// First device of its rows.
    first: Place,
    /// Number of rows; `None` if it is known only at run time.
    count: Option<u32>,
    /// It works through its rows.
    armed: FlagId,
    /// It is driven, and takes its rows over when the scan ends; `None` if it takes them over in each scan.
    begins: Option<FlagId>,
    /// The row that waits, from 0.
    row: CellId,
    /// Number of rows.
    rows: CellId,
    /// Counts that the rows wait for.
    counts: TableId,
    /// Words that they output.
    words: TableId,
    /// Bits that it writes.
    target: Option<(BitTarget, Width)>,
}

/// Bits that a pattern writes.
#[derive(Clone, Copy)]
enum Width {
    /// This many, starting with the first.
    Bits(u32),
    /// Those of a word that are on in a mask: the operand's value, and where it is kept for the counts.
    Mask { cell: CellId, value: ExprId },
}

impl Lowerer<'_> {
    /// A new table.
    fn new_table(&mut self, name: String, meaning: &'static str, length: u32) -> TableId {
        self.module.tables.push_and_get_key(Table {
            name,
            meaning,
            length,
        })
    }

    /// HSZ with a relay that chooses a table, HSCT: while driven, the rows wait for their counts.
    pub(super) fn count_table(&mut self, mode: &'static TableMode, counted: Counted) -> Option<()> {
        let (first, rows) = match (self.operand(0)?, self.operand(1)?) {
            (&OperandKind::Device(first, None), rows) => (first, rows.clone()),
            _ => return None,
        };
        let count = constant(&rows);
        let drive = self.drive();
        let mut guards = Guards::default();
        let words = mode.words * count.unwrap_or(1);
        let first = self.place(first, None, words, false, &mut guards);
        let rows = self.value(&rows, true, &mut guards);
        let rows = self.rows_that_exist(rows, count, first, mode, &mut guards);
        let n = self.high_speed.compares.len() + 1;
        let length = count.unwrap_or(MOST_ROWS);
        let mut table = Rows {
            mode,
            first,
            count,
            armed: self.flag(
                format!("table{n}_on"),
                "a table at the count is at work",
                None,
            ),
            begins: None,
            row: self.cell(format!("table{n}_row"), "the row that waits for its count"),
            rows: self.cell(format!("table{n}_rows"), "how many rows the table has"),
            counts: self.new_table(
                format!("table{n}_counts"),
                "counts at which the rows act",
                length,
            ),
            words: self.new_table(format!("table{n}_words"), "words of the rows", length),
            target: None,
        };
        if mode.fixed {
            let meaning = "a table is driven and begins when the scan ends";
            table.begins = Some(self.flag(format!("table{n}_begins"), meaning, None));
        }
        if mode.relay.is_none() {
            table.target = Some(self.pattern(mode, n, &mut guards)?);
        }
        let compare = Compare {
            counted,
            armed: table.armed,
            values: Vec::new(),
            reached: None,
            effect: Effect::Rows(table.clone()),
            at: self.at,
        };
        let then = self.body(|this| {
            this.guarded_or(
                guards,
                |this| this.drive_table(&table, rows, &compare),
                |this| this.stop_table(&table),
            );
        });
        let otherwise = self.body(|this| this.stop_table(&table));
        self.emit(Stmt::If(Branch {
            cond: drive,
            then,
            otherwise,
        }));
        if table.begins.is_some() {
            self.high_speed.tables.push(table);
        }
        self.high_speed.compares.push(compare);
        Some(())
    }

    /// The number of rows, which is one that a table may have, of a table that exists.
    fn rows_that_exist(
        &mut self,
        rows: ExprId,
        count: Option<u32>,
        first: Place,
        mode: &TableMode,
        guards: &mut Guards,
    ) -> ExprId {
        if count.is_some() {
            return rows;
        }
        let rows = self.settled(rows);
        let one = self.add(Expr::I32(1));
        let most = self.add(Expr::I32(MOST_ROWS as i32));
        for (op, end) in [(CmpOp::Ge, one), (CmpOp::Le, most)] {
            let holds = self.add(Expr::Cmp(op, rows, end));
            guards.demand(holds);
        }
        let words = self.add(Expr::I32(mode.words as i32));
        let words = self.add(Expr::Bin(BinOp::Mul, rows, words));
        let last = self.add(Expr::Bin(BinOp::Sub, words, one));
        let place = Place {
            index: Some(last),
            ..first
        };
        let exists = self.add(Expr::InRange {
            place,
            count: 1,
            length: None,
        });
        guards.demand(exists);
        rows
    }

    /// HSCT: which bits a row's pattern goes to.
    fn pattern(
        &mut self,
        mode: &TableMode,
        n: usize,
        guards: &mut Guards,
    ) -> Option<(BitTarget, Width)> {
        let (target, width) = (self.operand(3)?, self.operand(4)?);
        let (bits, width) = if mode.masked {
            let cell = self.cell(format!("table{n}_mask"), "which bits the table writes");
            let value = self.value(width, true, guards);
            (WORD, Width::Mask { cell, value })
        } else {
            let bits = constant(width)?.min(WORD);
            (bits, Width::Bits(bits))
        };
        let target = self.bit_target(target, bits, false, guards)?;
        Some((target, width))
    }

    /// While a table is driven.
    fn drive_table(&mut self, table: &Rows, rows: ExprId, compare: &Compare) {
        let armed = self.add(Expr::Flag(table.armed));
        let starts = self.not(armed);
        if let Some((_, Width::Mask { cell, value })) = table.target {
            self.emit(Action::SetCell(cell, value));
        }
        let Some(begins) = table.begins else {
            self.emit(Action::SetCell(table.rows, rows));
            self.when(starts, |this| this.first_row(table));
            self.take_rows(table);
            return self.act(compare);
        };
        self.when(starts, |this| {
            this.one_more(|this| {
                this.emit(Action::SetCell(table.rows, rows));
                this.set_flag_to(begins, true);
            });
        });
    }

    /// From the first row on.
    fn first_row(&mut self, table: &Rows) {
        let zero = self.add(Expr::I32(0));
        self.emit(Action::SetCell(table.row, zero));
        self.set_flag_to(table.armed, true);
        self.show_row(table);
    }

    /// A table that is not driven waits for nothing and shows its first row.
    fn stop_table(&mut self, table: &Rows) {
        self.disarm(table.armed);
        if let Some(begins) = table.begins {
            self.set_flag_to(begins, false);
        }
        let zero = self.add(Expr::I32(0));
        self.emit(Action::SetCell(table.row, zero));
        if !table.mode.done_for_a_scan {
            self.show_done(table, false);
        }
        self.show_number(table);
        if let Some(shown) = table.mode.shows {
            for register in [shown.word, shown.count] {
                self.show_pair(register, zero);
            }
        }
    }

    /// Emits the end of the scan for tables: those driven in it begin, and the relays of those that have ended go off.
    pub(super) fn begin_tables(&mut self) {
        for table in std::mem::take(&mut self.high_speed.tables) {
            if table.mode.done_for_a_scan {
                self.show_done(&table, false);
            }
            let Some(begins) = table.begins else {
                continue;
            };
            let driven = self.add(Expr::Flag(begins));
            self.when(driven, |this| {
                this.set_flag_to(begins, false);
                this.take_rows(&table);
                this.first_row(&table);
            });
        }
    }

    /// The rows as they are now are those of the table.
    fn take_rows(&mut self, table: &Rows) {
        if let Some(count) = table.count {
            for row in 0..count {
                let at = self.add(Expr::I32(row as i32));
                let first = Place {
                    number: table.first.number + row * table.mode.words,
                    ..table.first
                };
                self.take_row(table, at, first);
            }
            return;
        }
        let zero = self.add(Expr::I32(0));
        let row = self.temp(Ty::I32);
        self.emit(Action::Let(row, zero));
        let at = self.add(Expr::Temp(row));
        let count = self.add(Expr::Cell(table.rows));
        let count = self.add(Expr::Narrow(count));
        let body = self.body(|this| {
            let words = this.add(Expr::I32(table.mode.words as i32));
            let index = Some(this.add(Expr::Bin(BinOp::Mul, at, words)));
            this.take_row(
                table,
                at,
                Place {
                    index,
                    ..table.first
                },
            );
            let one = this.add(Expr::I32(1));
            let next = this.add(Expr::Bin(BinOp::Add, at, one));
            this.emit(Action::Let(row, next));
        });
        self.emit(Stmt::For { count, body });
    }

    fn take_row(&mut self, table: &Rows, at: ExprId, first: Place) {
        let count = self.add(Expr::Read(Access::pair(first)));
        self.emit(Action::SetEntry(SetEntry {
            table: table.counts,
            index: at,
            value: count,
        }));
        let said = Place {
            number: first.number + 2,
            ..first
        };
        let word = if table.mode.words == 3 {
            let word = self.add(Expr::Read(Access::word(said)));
            self.add(Expr::Widen(word))
        } else {
            self.add(Expr::Read(Access::pair(said)))
        };
        self.emit(Action::SetEntry(SetEntry {
            table: table.words,
            index: at,
            value: word,
        }));
    }

    /// The row that waits, at a count.
    pub(super) fn row_at_count(&mut self, table: &Rows, count: ExprId) {
        let row = self.add(Expr::Cell(table.row));
        let rows = self.add(Expr::Cell(table.rows));
        let mut waits = self.add(Expr::Flag(table.armed));
        if !table.mode.repeats {
            let left = self.add(Expr::Cmp(CmpOp::Lt, row, rows));
            waits = self.and(waits, left);
        }
        self.when(waits, |this| {
            let wanted = this.add(Expr::Entry(table.counts, row));
            let reached = this.add(Expr::Cmp(table.mode.reached, count, wanted));
            this.when(reached, |this| {
                this.act_row(table, row);
                this.next_row(table, row, rows);
            });
        });
    }

    /// Does what a row says.
    fn act_row(&mut self, table: &Rows, row: ExprId) {
        if table.mode.shows.is_some() {
            return;
        }
        let word = self.add(Expr::Entry(table.words, row));
        let word = self.settled(word);
        match table.target {
            Some((target, Width::Bits(bits))) => self.write_pattern(target, bits, word),
            Some((target, Width::Mask { cell, .. })) => self.write_masked(target, cell, word),
            None => self.write_output(word),
        }
    }

    /// The next row waits; after the last one, the first.
    fn next_row(&mut self, table: &Rows, row: ExprId, rows: ExprId) {
        let one = self.add(Expr::I32(1));
        let next = self.add(Expr::Bin(BinOp::Add, row, one));
        self.emit(Action::SetCell(table.row, next));
        if table.mode.repeats {
            let ended = self.add(Expr::Cmp(CmpOp::Ge, row, rows));
            self.when(ended, |this| {
                let zero = this.add(Expr::I32(0));
                this.emit(Action::SetCell(table.row, zero));
                this.show_done(table, true);
            });
        }
        self.show_row(table);
    }

    /// Special registers show the row that waits.
    fn show_row(&mut self, table: &Rows) {
        self.show_number(table);
        if let Some(shown) = table.mode.shows {
            let row = self.add(Expr::Cell(table.row));
            let word = self.add(Expr::Entry(table.words, row));
            let count = self.add(Expr::Entry(table.counts, row));
            self.show_pair(shown.word, word);
            self.show_pair(shown.count, count);
        }
    }

    /// Emits whether the last row was reached.
    fn show_done(&mut self, table: &Rows, on: bool) {
        if let Some(relay) = table.mode.done.filter(|&relay| self.specials.has(relay)) {
            let on = self.bit_const(on);
            self.write_relay(relay, on);
        }
    }

    fn show_number(&mut self, table: &Rows) {
        if let Some(register) = table.mode.row.filter(|&row| self.specials.has(row)) {
            let row = self.add(Expr::Cell(table.row));
            let row = self.add(Expr::Narrow(row));
            self.emit(Action::Write(Access::word(register), row));
        }
    }

    fn show_pair(&mut self, register: Register, value: ExprId) {
        if register
            .run::<2>()
            .iter()
            .any(|&word| self.specials.has(word))
        {
            self.emit(Action::Write(Access::pair(register), value));
        }
    }

    /// The low word names an output, with its octal digits as hexadecimal ones, the high word is not 0 if it turns on.
    fn write_output(&mut self, word: ExprId) {
        let mask = self.add(Expr::I32(0x7));
        let mut number = self.add(Expr::Bin(BinOp::And, word, mask));
        for (digit, divisor) in [(0x70, 2), (0x700, 4)] {
            let mask = self.add(Expr::I32(digit));
            let part = self.add(Expr::Bin(BinOp::And, word, mask));
            let divisor = self.add(Expr::I32(divisor));
            let part = self.add(Expr::Bin(BinOp::Div, part, divisor));
            number = self.add(Expr::Bin(BinOp::Or, number, part));
        }
        let number = self.settled(number);
        let place = Place {
            class: Y,
            number: 0,
            index: Some(number),
        };
        let exists = self.add(Expr::InRange {
            place,
            count: 1,
            length: None,
        });
        self.when(exists, |this| {
            let state = this.add(Expr::HighWord(word));
            let zero = this.int(0, false);
            let on = this.add(Expr::Cmp(CmpOp::Ne, state, zero));
            this.emit(Action::Write(Access::bit(place), on));
        });
    }

    /// Writes the first bits of a word.
    fn write_pattern(&mut self, target: BitTarget, bits: u32, word: ExprId) {
        let zero = self.add(Expr::I32(0));
        for bit in 0..bits {
            let mask = self.add(Expr::I32(1 << bit));
            let state = self.add(Expr::Bin(BinOp::And, word, mask));
            let on = self.add(Expr::Cmp(CmpOp::Ne, state, zero));
            self.store_bit(target, bit, on);
        }
    }

    /// Writes the bits of a word that are on in a mask.
    fn write_masked(&mut self, target: BitTarget, mask: CellId, word: ExprId) {
        let BitTarget::Device(place) = target else {
            return;
        };
        let mask = self.add(Expr::Cell(mask));
        let bits = AccessKind::Nibbles {
            digits: 4,
            wide: true,
        };
        let before = self.add(Expr::Read(bits.at(place)));
        let others = self.add(Expr::Complement(mask));
        let kept = self.add(Expr::Bin(BinOp::And, before, others));
        let written = self.add(Expr::Bin(BinOp::And, word, mask));
        let value = self.add(Expr::Bin(BinOp::Or, kept, written));
        self.emit(Action::Write(bits.at(place), value));
    }
}

/// A constant that is at least 0.
fn constant(operand: &OperandKind) -> Option<u32> {
    u32::try_from(operand.constant()?).ok()
}
