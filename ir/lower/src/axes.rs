//! Parameters of HM's axes: registers that instructions fill, and their values when RUN begins.

use super::Lowerer;
use super::operand::{Guards, Target};
use rungc_ir::node::{Access, Action, Expr, SysValue};
use rungc_syntax::DeviceClass::D;
use rungc_syntax::OperandKind;

impl Lowerer<'_> {
    /// AXPO and similar instructions: the operands after the axis are these parameters of it.
    pub(super) fn axis_parameters(&mut self, parameters: &[u32]) {
        let axis = match self.operand(0) {
            Some(&OperandKind::Decimal(axis, _)) => u32::try_from(axis).ok(),
            Some(&OperandKind::Hex(axis, _)) => u32::try_from(axis).ok(),
            _ => None,
        };
        let Some(axis) = axis else {
            return;
        };
        let mut guards = Guards::default();
        let mut values = Vec::new();
        for (i, &parameter) in (1..).zip(parameters) {
            if let Some(operand) = self.operand(i) {
                let value = self.value(operand, false, &mut guards);
                values.extend(
                    self.model
                        .axis_register(axis, parameter)
                        .map(|register| (register, value)),
                );
            }
        }
        self.guarded(guards, |this| {
            for (register, value) in values {
                this.store(Target::Word(register.into()), value);
            }
        });
    }

    /// Emits the initial values of the parameters in use, assigned when RUN begins; the first scan may set others.
    pub(super) fn axis_defaults(&mut self) {
        let starts = self.model.axis_starts();
        let looked_at = starts.filter(|&(register, _)| {
            self.specials.flags.contains(&(D, register.number())) || self.looks_at(register)
        });
        let defaults: Vec<_> = looked_at.collect();
        if defaults.is_empty() {
            return;
        }
        let first = self.add(Expr::Sys(SysValue::FirstScan));
        self.when(first, |this| {
            for (register, value) in defaults {
                let value = this.add(Expr::I16(value));
                this.emit(Action::Write(Access::word(register), value));
            }
        });
    }
}
