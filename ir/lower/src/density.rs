//! SPD: pulses of an input in windows of time. Edges count them and end windows that are over, so that each pulse falls
//! into its own window, to a millisecond; the instruction shows them in the scan.

use super::Lowerer;
use super::operand::{Guards, Target};
use rungc_ir::node::{Access, Action, BinOp, Branch, CellId, Expr, ExprId, FlagId, Stmt, SysValue};
use rungc_rt::{CmpOp, EdgeKind, Relay};
use rungc_syntax::{Device, OperandKind};

/// Ten minutes in milliseconds: pulses per minute are displayed times ten.
const TEN_MINUTES: i32 = 600_000;

/// State of an SPD.
#[derive(Clone, Copy)]
struct Window {
    /// It is driven.
    on: FlagId,
    /// Length, at least 1 while it is on.
    length: CellId,
    /// Start of the window.
    began: CellId,
    /// Pulses in it.
    count: CellId,
    /// Pulses in the one before.
    last: CellId,
}

impl Lowerer<'_> {
    pub(super) fn density(&mut self) {
        let Some(&OperandKind::Device(input, None)) = self.operand(0) else {
            return;
        };
        let window = self.window();
        let clock = self.clock();
        self.on_edge(input.number, EdgeKind::Rising, |this| {
            let on = this.add(Expr::Flag(window.on));
            this.when(on, |this| {
                let now = this.add(Expr::Cell(clock));
                this.end_window(window, now);
                let one = this.add(Expr::I32(1));
                let count = this.add(Expr::Cell(window.count));
                let count = this.add(Expr::Bin(BinOp::Add, count, one));
                this.emit(Action::SetCell(window.count, count));
            });
        });
        let drive = self.drive();
        let then = self.body(|this| this.measure(input, window));
        let otherwise = self.body(|this| this.set_flag_to(window.on, false));
        self.emit(Stmt::If(Branch {
            cond: drive,
            then,
            otherwise,
        }));
    }

    fn window(&mut self) -> Window {
        self.densities += 1;
        let n = self.densities;
        Window {
            on: self.flag(format!("spd{n}_on"), "it counts pulses", None),
            length: self.cell(format!("spd{n}_length"), "length of a window, in ms"),
            began: self.cell(format!("spd{n}_began"), "when the window began"),
            count: self.cell(format!("spd{n}_count"), "pulses in the window"),
            last: self.cell(format!("spd{n}_last"), "pulses in the window before"),
        }
    }

    /// Counts from now on, if it did not already, and shows what it counted.
    fn measure(&mut self, input: Device, window: Window) {
        let Some(length) = self.operand(1) else {
            return;
        };
        let wide = self.resolution().form.wide;
        let mut guards = Guards::default();
        let length = self.value(length, wide, &mut guards);
        let length = if wide {
            length
        } else {
            self.add(Expr::Widen(length))
        };
        let zero = self.add(Expr::I32(0));
        let valid = self.add(Expr::Cmp(CmpOp::Gt, length, zero));
        guards.demand(valid);
        let now = self.add(Expr::Sys(SysValue::NowMs));
        let shown = self.shown(input, wide, &mut guards);
        let run = |this: &mut Self| {
            this.emit(Action::SetCell(window.length, length));
            let on = this.add(Expr::Flag(window.on));
            let begins = this.not(on);
            this.when(begins, |this| {
                this.emit(Action::SetCell(window.began, now));
                this.emit(Action::SetCell(window.count, zero));
                this.set_flag_to(window.on, true);
            });
            this.end_window(window, now);
            this.show(window, now, shown);
        };
        self.guarded_or(guards, run, |this| this.set_flag_to(window.on, false));
    }

    /// If the window is over, another starts, perhaps after some without pulses.
    fn end_window(&mut self, window: Window, now: ExprId) {
        let began = self.add(Expr::Cell(window.began));
        let length = self.add(Expr::Cell(window.length));
        let passed = self.add(Expr::Bin(BinOp::Sub, now, began));
        let over = self.add(Expr::Cmp(CmpOp::Ge, passed, length));
        self.when(over, |this| {
            let windows = this.add(Expr::Bin(BinOp::Div, passed, length));
            let windows = this.settled(windows);
            let (zero, one) = (this.add(Expr::I32(0)), this.add(Expr::I32(1)));
            let single = this.add(Expr::Cmp(CmpOp::Eq, windows, one));
            let count = this.add(Expr::Cell(window.count));
            let then = vec![Stmt::Do(Action::SetCell(window.last, count))];
            let otherwise = vec![Stmt::Do(Action::SetCell(window.last, zero))];
            this.emit(Stmt::If(Branch {
                cond: single,
                then,
                otherwise,
            }));
            this.emit(Action::SetCell(window.count, zero));
            let time = this.add(Expr::Bin(BinOp::Mul, windows, length));
            let next = this.add(Expr::Bin(BinOp::Add, began, time));
            this.emit(Action::SetCell(window.began, next));
        });
    }

    /// Targets for the last window's pulses, the running window's, and its remaining time.
    fn shown(&mut self, input: Device, wide: bool, guards: &mut Guards) -> Shown {
        let none = Shown {
            parts: [Target::None; 3],
            per_minute: None,
        };
        let Some(&OperandKind::Device(first, index)) = self.operand(2) else {
            return none;
        };
        let operand = OperandKind::Device(first, index);
        let parts = [0, 1, 2].map(|i| self.target(&operand, i, wide, wide, guards));
        let relay = self.model.high_speed.per_minute;
        let relay = relay.map(|relay| relay.after(input.number));
        let per_minute = relay.filter(|&relay| self.specials.has(relay));
        let second = Device {
            number: first.number + 1,
            ..first
        };
        let operand = OperandKind::Device(second, index);
        Shown {
            parts,
            per_minute: per_minute
                .map(|relay| (relay, self.target(&operand, 0, true, wide, guards))),
        }
    }

    fn show(&mut self, window: Window, now: ExprId, shown: Shown) {
        let [last, running, left] = shown.parts;
        let pulses = self.add(Expr::Cell(window.last));
        self.store_number(last, pulses);
        let windows = |this: &mut Self| {
            let count = this.add(Expr::Cell(window.count));
            this.store_number(running, count);
            let began = this.add(Expr::Cell(window.began));
            let length = this.add(Expr::Cell(window.length));
            let passed = this.add(Expr::Bin(BinOp::Sub, now, began));
            let rest = this.add(Expr::Bin(BinOp::Sub, length, passed));
            this.store_number(left, rest);
        };
        let Some((relay, target)) = shown.per_minute else {
            return windows(self);
        };
        let cond = self.add(Expr::Read(Access::bit(relay)));
        let then = self.body(|this| {
            let value = this.per_minute(window);
            this.store_number(target, value);
        });
        let otherwise = self.body(windows);
        self.emit(Stmt::If(Branch {
            cond,
            then,
            otherwise,
        }));
    }

    /// Ten times the pulses a minute: the quotient and the rest by themselves, so that nothing overflows.
    fn per_minute(&mut self, window: Window) -> ExprId {
        let pulses = self.add(Expr::Cell(window.last));
        let length = self.add(Expr::Cell(window.length));
        let minutes = self.add(Expr::I32(TEN_MINUTES));
        let whole = self.add(Expr::Bin(BinOp::Div, minutes, length));
        let whole = self.add(Expr::Bin(BinOp::Mul, pulses, whole));
        let rest = self.add(Expr::Bin(BinOp::Rem, minutes, length));
        let rest = self.add(Expr::Bin(BinOp::Mul, pulses, rest));
        let rest = self.add(Expr::Bin(BinOp::Div, rest, length));
        self.add(Expr::Bin(BinOp::Add, whole, rest))
    }

    /// Writes an `I32`, or its low word where the target holds one word.
    fn store_number(&mut self, target: Target, value: ExprId) {
        let value = match target {
            Target::Word(_) => self.add(Expr::Narrow(value)),
            Target::Pair(_)
            | Target::CounterWords(_)
            | Target::Nibbles(..)
            | Target::Sent(..)
            | Target::None => value,
        };
        self.store(target, value);
    }
}

/// Targets of the counts of an SPD.
struct Shown {
    parts: [Target; 3],
    /// The relay that makes it show the pulses a minute, and where.
    per_minute: Option<(Relay, Target)>,
}
