//! Advanced interrupts of HM: routines that are left in the middle and continue there.

use super::Lowerer;
use super::interrupt::{Request, What};
use super::parts::Item;
use rungc_ir::node::{Access, Action, CellId, Expr, Stmt};
use rungc_models::interrupts::{Advanced, Gate};
use rungc_rt::{CmpOp, Relay};

/// Places where routines continue are labels with numbers above this, which no pointer has.
pub(super) const FIRST_PLACE: u32 = 0x1_0000;

/// A routine that may be left in the middle.
pub(super) struct Section {
    /// Its function.
    function: u32,
    interrupt: Advanced,
    /// Position at which it continues: 0 is its start.
    at: CellId,
    /// Number of other positions.
    places: u32,
}

impl Lowerer<'_> {
    /// An advanced interrupt's routine.
    pub(super) fn section(&mut self, number: u32, function: u32, interrupt: Advanced) -> Request {
        let at = self.cell(format!("i{number}_at"), "where the routine continues");
        self.interrupts.sections.push(Section {
            function,
            interrupt,
            at,
            places: 0,
        });
        Request {
            source: interrupt.source,
            what: What::Process {
                pointer: number,
                function,
                interrupt,
                at,
            },
        }
    }

    /// PROC: the next entry continues here.
    pub(super) fn process_begins(&mut self) {
        if let Some((place, at)) = self.new_place() {
            self.emit_place(at, place);
            self.out.push(Item::Label(place));
        }
    }

    /// PEND: the routine is left; while driven, the next entry continues after it.
    pub(super) fn process_ends(&mut self) {
        let drive = self.drive();
        let Some((place, at)) = self.new_place() else {
            return;
        };
        self.when(drive, |this| this.emit_place(at, place));
        self.emit(Stmt::Return);
        self.out.push(Item::Label(place));
        self.logic.stack.clear();
    }

    /// PRET, or what ends an advanced interrupt's routine instead.
    pub(super) fn end_interrupt(&mut self) {
        let function = self.flow.function();
        let mut sections = self.interrupts.sections.iter();
        if let Some(section) = sections.find(|section| section.function == function) {
            let active = section.interrupt.active;
            let off = self.bit_const(false);
            self.write_relay(active, off);
        }
        self.return_here();
    }

    /// One more place at which the current routine continues, and where that is stored. The checks ensure that it is
    /// not in a loop.
    fn new_place(&mut self) -> Option<(u32, CellId)> {
        let function = self.flow.function();
        let mut sections = self.interrupts.sections.iter_mut();
        let section = sections.find(|section| section.function == function)?;
        section.places += 1;
        Some((FIRST_PLACE + section.places, section.at))
    }

    fn emit_place(&mut self, at: CellId, place: u32) {
        let place = self.add(Expr::I32((place - FIRST_PLACE) as i32));
        self.emit(Action::SetCell(at, place));
    }

    /// The current routine starts with jumps to the places where it continues, the last one first, so that they nest.
    pub(super) fn enter_places(&mut self) {
        let function = self.flow.function();
        let mut sections = self.interrupts.sections.iter();
        let Some(section) = sections.find(|section| section.function == function) else {
            return;
        };
        let (at, places) = (section.at, section.places);
        let body = std::mem::take(&mut self.out);
        for n in (1..=places).rev() {
            let at = self.add(Expr::Cell(at));
            let place = self.add(Expr::I32(n as i32));
            let cond = self.add(Expr::Cmp(CmpOp::Eq, at, place));
            self.push_jump(cond, FIRST_PLACE + n);
        }
        self.out.extend(body);
    }

    /// Runs an advanced interrupt's routine from its start, or continues it. An earlier request for that is forgotten
    /// at its start.
    pub(super) fn serve_process(&mut self, what: &What) {
        let What::Process {
            function,
            interrupt,
            at,
            ..
        } = *what
        else {
            return;
        };
        let allowed = self.allowed(Gate::Forbids(interrupt.mask));
        let relay = |this: &mut Self, relay: Relay| this.add(Expr::Read(Access::bit(relay)));
        let (request, active) = (interrupt.request, interrupt.active);
        let asked = relay(self, request);
        let is_active = relay(self, active);
        let idle = self.not(is_active);
        let begins = self.and(asked, idle);
        let begins = self.and(begins, allowed);
        self.when(begins, |this| {
            let (off, on) = (this.bit_const(false), this.bit_const(true));
            this.write_relay(request, off);
            this.write_relay(interrupt.again, off);
            this.write_relay(active, on);
            let begin = this.add(Expr::I32(0));
            this.emit(Action::SetCell(at, begin));
            this.emit(Stmt::CallSub(function));
        });
        let again = relay(self, interrupt.again);
        let goes_on = self.and(again, is_active);
        let goes_on = self.and(goes_on, allowed);
        self.when(goes_on, |this| {
            let off = this.bit_const(false);
            this.write_relay(interrupt.again, off);
            this.emit(Stmt::CallSub(function));
        });
    }
}
