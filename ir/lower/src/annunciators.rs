//! ANS, which is inline code where the program states its time: its timer is one as any other.

use super::Lowerer;
use super::operand::{Guards, fixed};
use super::words::constant;
use rungc_ir::node::{Access, Action, Expr, TimerCoil};
use rungc_rt::{RtFn, TimerKind};
use rungc_syntax::{DeviceClass, Instr, OperandKind};

/// Returns true if such an instruction is inline code, judging by its operands.
pub(super) fn is_inline(function: RtFn, instr: &Instr) -> bool {
    let kind = |i: usize| instr.operands.get(i).map(|operand| &operand.kind);
    let device = |i, class| {
        let device = kind(i).and_then(OperandKind::device);
        device.is_some_and(|device| device.class == class)
    };
    let time = kind(1).and_then(constant);
    function == RtFn::Ans
        && device(0, DeviceClass::T)
        && device(2, DeviceClass::S)
        && time.is_some_and(|time| (1..=i32::from(i16::MAX)).contains(&time))
}

impl Lowerer<'_> {
    /// Emits such an instruction as inline code; false if the runtime has to be called.
    pub(super) fn inline_annunciator(&mut self, function: RtFn) -> bool {
        if !is_inline(function, self.instr()) {
            return false;
        }
        let (Some(timer), Some(annunciator)) = (self.device_of(0), self.device_of(2)) else {
            return false;
        };
        let Some(kind) = self.model.timer(timer.number) else {
            return false;
        };
        // Whatever the timer is as such, ANS counts tenths of seconds up to its time.
        let kind = TimerKind {
            unit_ms: 100,
            accumulating: false,
            free_running: false,
            latches_preset: false,
            overruns: false,
            stepwise: false,
            ..kind
        };
        let mut guards = Guards::default();
        self.demand_block(annunciator, 1, &mut guards);
        let drive = self.drive();
        let preset = self.int(self.stated(1) as i32, false);
        self.guarded_while(guards, Some(drive), |this| {
            let number = timer.number;
            this.emit(Action::Timer(TimerCoil {
                number,
                kind,
                drive,
                preset,
            }));
            let place = fixed(timer.class, number);
            this.reset_if_held(place);
            let over = this.add(Expr::Read(Access::bit(place)));
            this.when(over, |this| {
                let on = this.bit_const(true);
                let annunciator = fixed(annunciator.class, annunciator.number);
                this.emit(Action::Write(Access::bit(annunciator), on));
            });
        });
        true
    }
}
