//! Widths and periods of pulses, as exactly as a host reports the time: to a millisecond.

use super::Lowerer;
use rungc_ir::node::{Access, Action, BinOp, Branch, CellId, Expr, ExprId, FlagId, Stmt};
use rungc_models::high_speed::Meter;
use rungc_rt::{EdgeKind, Relay};

/// Units of the ring counter and of widths in a millisecond.
const RING: i32 = 6000;
const WIDTH: i32 = 100;

/// A meter at work.
struct Measured {
    meter: &'static Meter,
    /// The time.
    clock: CellId,
    /// Time at which its input rose.
    rose: CellId,
    /// It has risen while it was measured.
    known: FlagId,
}

impl Lowerer<'_> {
    /// Measures the pulses of inputs, if something looks at what comes out.
    pub(super) fn pulse_widths(&mut self) {
        for meter in self.model.high_speed.meters {
            let mut registers = meter.registers.run::<6>().into_iter();
            if !registers.any(|register| self.keeps(register)) {
                continue;
            }
            let name = format!("x{:03o}", meter.input);
            let measured = Measured {
                meter,
                clock: self.clock(),
                rose: self.cell(format!("{name}_pulse_at"), "when the input rose, in ms"),
                known: self.flag(format!("{name}_measured"), "a pulse has begun", None),
            };
            for kind in [EdgeKind::Rising, EdgeKind::Falling] {
                self.on_edge(meter.input, kind, |this| {
                    let then = this.body(|this| this.measure_edge(&measured, kind));
                    let otherwise = this.body(|this| this.set_flag_to(measured.known, false));
                    let cond = this.all_on(meter.measures);
                    this.emit(Stmt::If(Branch {
                        cond,
                        then,
                        otherwise,
                    }));
                });
            }
        }
    }

    /// Condition that all of these relays are on.
    fn all_on(&mut self, relays: &[Relay]) -> ExprId {
        let mut all = self.bit_const(true);
        for &relay in relays {
            let on = self.relay_or_off(relay);
            all = self.and(all, on);
        }
        all
    }

    /// State of a relay, which is off if nothing looks at it.
    fn relay_or_off(&mut self, relay: Relay) -> ExprId {
        if self.specials.has(relay) {
            self.add(Expr::Read(Access::bit(relay)))
        } else {
            self.bit_const(false)
        }
    }

    fn measure_edge(&mut self, measured: &Measured, kind: EdgeKind) {
        let meter = measured.meter;
        let rises = kind == EdgeKind::Rising;
        let now = self.add(Expr::Cell(measured.clock));
        let units = self.add(Expr::I32(RING));
        let ring = self.add(Expr::Bin(BinOp::Mul, now, units));
        let edge = meter.registers.after(if rises { 0 } else { 2 });
        self.emit(Action::Write(Access::pair(edge), ring));
        let known = self.add(Expr::Flag(measured.known));
        let period = match meter.period {
            Some(relay) => self.relay_or_off(relay),
            None => self.bit_const(false),
        };
        let ends = if rises { period } else { self.not(period) };
        let ends = self.and(known, ends);
        self.when(ends, |this| {
            let rose = this.add(Expr::Cell(measured.rose));
            let passed = this.add(Expr::Bin(BinOp::Sub, now, rose));
            let units = this.add(Expr::I32(WIDTH));
            let length = this.add(Expr::Bin(BinOp::Mul, passed, units));
            this.emit(Action::Write(
                Access::pair(meter.registers.after(4)),
                length,
            ));
        });
        if rises {
            self.emit(Action::SetCell(measured.rose, now));
            self.set_flag_to(measured.known, true);
        }
    }
}
