//! Coils, SET, RST, pulses, master control.

use super::Lowerer;
use super::operand::{BitTarget, Guards, fixed};
use rungc_catalogue::Basic;
use rungc_ir::node::{
    Access, Action, Branch, Counter16Coil, Counter32Coil, Expr, ExprId, IndexedCoil, Stmt,
    TimerCoil,
};
use rungc_models::high_speed;
use rungc_models::runs::FIRST_COUNTER32;
use rungc_rt::special::M_COUNTER_DIRECTION;
use rungc_rt::{CmpOp, EdgeKind, Relay, TimerKind};
use rungc_syntax::{Device, DeviceClass, Index, OperandKind};

impl Lowerer<'_> {
    pub(super) fn coil(&mut self) {
        use DeviceClass::{C, T};
        match self.operand(0) {
            Some(&OperandKind::Device(device, None)) if device.class == T => self.timer(device),
            Some(&OperandKind::Device(device, None)) if device.class == C => self.counter(device),
            Some(&OperandKind::Device(device, Some(index))) if matches!(device.class, T | C) => {
                self.indexed_coil(device, index);
            }
            Some(&OperandKind::Device(device, None)) if self.is_transition(device) => {
                self.transition(device.number);
            }
            Some(operand) => {
                let drive = self.drive();
                self.write_bits(operand, drive);
            }
            None => {}
        }
    }

    /// Writes the bit that an operand names.
    pub(super) fn write_bits(&mut self, operand: &OperandKind, value: ExprId) {
        let mut guards = Guards::default();
        if let Some(target) = self.bit_target(operand, 1, false, &mut guards) {
            self.guarded(guards, |this| this.store_bit(target, 0, value));
        }
    }

    fn timer(&mut self, device: Device) {
        let number = device.number;
        let Some(kind) = self.model.timer(number) else {
            return;
        };
        if kind.free_running && self.flow.skips() {
            self.free_running.insert(number, kind);
        }
        let place = fixed(DeviceClass::T, number);
        let drive = self.drive();
        let fast = self.model.fast_timers;
        let fast = fast.filter(|fast| fast.numbers.contains(&number));
        let fast = fast.filter(|fast| self.specials.has(fast.relay));
        self.with_preset(false, Guards::default(), |this, preset| {
            let Some(fast) = fast else {
                this.emit(Action::Timer(TimerCoil {
                    number,
                    kind,
                    drive,
                    preset,
                }));
                return this.reset_if_held(place);
            };
            let (drive, preset) = (this.settled(drive), this.settled(preset));
            let timer = |unit_ms| {
                Stmt::Do(Action::Timer(TimerCoil {
                    number,
                    kind: TimerKind { unit_ms, ..kind },
                    drive,
                    preset,
                }))
            };
            let cond = this.add(Expr::Read(Access::bit(fast.relay)));
            this.emit(Stmt::If(Branch {
                cond,
                then: vec![timer(fast.unit_ms)],
                otherwise: vec![timer(kind.unit_ms)],
            }));
            this.reset_if_held(place);
        });
    }

    fn counter(&mut self, device: Device) {
        let number = device.number;
        if number >= high_speed::FIRST {
            return self.high_speed_coil(device);
        }
        let place = fixed(DeviceClass::C, number);
        let drive = self.drive();
        if number < FIRST_COUNTER32 {
            return self.with_preset(false, Guards::default(), |this, preset| {
                this.emit(Action::Counter16(Counter16Coil {
                    number,
                    drive,
                    preset,
                }));
                this.reset_if_held(place);
            });
        }
        let direction = M_COUNTER_DIRECTION.after(number);
        let down = if self.specials.has(direction) {
            self.add(Expr::Read(Access::bit(direction)))
        } else {
            self.bit_const(false)
        };
        self.with_preset(true, Guards::default(), |this, preset| {
            this.emit(Action::Counter32(Counter32Coil {
                number,
                drive,
                down,
                preset,
            }));
            this.reset_if_held(place);
        });
    }

    /// OUT T and OUT C0–C199 with an index: a timer that the index leads to is of the kind that its number has.
    fn indexed_coil(&mut self, device: Device, index: Index) {
        let timer = device.class == DeviceClass::T;
        if timer && self.flow.skips() {
            self.keep_free_running();
        }
        let drive = self.drive();
        let mut guards = Guards::default();
        let place = self.place(device, Some(index), 1, false, &mut guards);
        if let (false, Some(index)) = (timer, place.index) {
            // A 32-bit counter does not count as a 16-bit one.
            let index = if let Expr::Within { value, .. } = self.expr(index) {
                value
            } else {
                index
            };
            let room = self.add(Expr::I32(FIRST_COUNTER32 as i32 - device.number as i32));
            guards.demand(self.add(Expr::Cmp(CmpOp::Lt, index, room)));
        }
        self.with_preset(false, guards, |this, preset| {
            this.emit(match timer {
                true => Stmt::Do(Action::TimerAt(IndexedCoil {
                    place,
                    drive,
                    preset,
                })),
                false => Stmt::Do(Action::Counter16At(IndexedCoil {
                    place,
                    drive,
                    preset,
                })),
            });
            this.reset_if_held(place);
        });
    }

    /// Any of the timers that continue in scans that do not execute their coils may be driven.
    fn keep_free_running(&mut self) {
        for timers in self.model.timers.iter().filter(|t| t.kind.free_running) {
            let numbers = timers.first..=timers.last;
            self.free_running
                .extend(numbers.map(|number| (number, timers.kind)));
        }
    }

    /// Emits a coil with its preset, the second operand; nothing but a fault where `guards` do not hold.
    pub(super) fn with_preset(
        &mut self,
        wide: bool,
        mut guards: Guards,
        make: impl FnOnce(&mut Self, ExprId),
    ) {
        let Some(operand) = self.operand(1) else {
            return;
        };
        let preset = self.value(operand, wide, &mut guards);
        self.guarded(guards, |this| make(this, preset));
    }

    pub(super) fn set_or_reset(&mut self, on: bool) {
        let Some(operand) = self.operand(0) else {
            return;
        };
        match *operand {
            OperandKind::Device(device, None) if on && self.is_transition(device) => {
                return self.transition(device.number);
            }
            OperandKind::Device(device, index)
                if matches!(device.class, DeviceClass::T | DeviceClass::C) =>
            {
                return self.reset_device(device, index);
            }
            OperandKind::Device(..)
            | OperandKind::WordBit(..)
            | OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => {}
        }
        self.driven(|this| match *operand {
            OperandKind::Device(device, _) if is_word(device.class) => {
                let mut guards = Guards::default();
                let target = this.target(operand, 0, false, false, &mut guards);
                let zero = this.int(0, false);
                this.guarded(guards, |this| this.store(target, zero));
            }
            OperandKind::Device(..)
            | OperandKind::WordBit(..)
            | OperandKind::Nibbles(..)
            | OperandKind::Decimal(..)
            | OperandKind::Hex(..)
            | OperandKind::Float(_)
            | OperandKind::Text(_)
            | OperandKind::Buffer { .. }
            | OperandKind::Unreadable(_) => {
                let value = this.bit_const(on);
                this.write_bits(operand, value);
                if let &OperandKind::Device(device, None) = operand {
                    if on {
                        this.keep_state(device);
                    }
                    this.relay_changed(device);
                }
            }
        });
    }

    pub(super) fn pulse(&mut self, basic: Basic) {
        let Some(operand) = self.operand(0) else {
            return;
        };
        let kind = if basic == Basic::Pls {
            EdgeKind::Rising
        } else {
            EdgeKind::Falling
        };
        let drive = self.drive();
        let edge = self.new_edge();
        let pulse = self.edge(edge, kind, drive);
        self.write_bits(operand, pulse);
    }

    pub(super) fn master_control(&mut self) {
        let Some(&OperandKind::Device(level, _)) = self.operand(0) else {
            return;
        };
        let drive = self.drive();
        let drive = self.settled(drive);
        if let Some(relay) = self.operand(1) {
            self.write_bits(relay, drive);
        }
        self.logic.zones.push((level.number, self.logic.bus));
        self.logic.bus = Some(drive);
        self.logic.stack.clear();
    }

    pub(super) fn master_control_reset(&mut self) {
        let Some(&OperandKind::Device(level, _)) = self.operand(0) else {
            return;
        };
        while let Some(&(inner, outer)) = self.logic.zones.last() {
            if inner < level.number {
                break;
            }
            self.logic.bus = outer;
            self.logic.zones.pop();
        }
    }

    /// Switches a relay.
    pub(super) fn write_relay(&mut self, relay: Relay, value: ExprId) {
        self.write_device(DeviceClass::M, relay.number(), value);
    }

    /// The bit target of a device, for what lowering writes by itself.
    pub(super) fn write_device(&mut self, class: DeviceClass, number: u32, value: ExprId) {
        self.store_bit(BitTarget::Device(fixed(class, number)), 0, value);
    }
}

/// Returns true if a class holds words (T and C are both).
fn is_word(class: DeviceClass) -> bool {
    use DeviceClass::{D, ER, R, V, Z};
    matches!(class, D | R | ER | V | Z)
}
