//! Inputs at which instructions look that send pulses: what their edges do, between two scans.

use super::Lowerer;
use super::call::output_of;
use super::operand::fixed;
use rungc_catalogue::{Lower, Role};
use rungc_ir::node::{Access, Action, Arg, Call, Expr, ExprId, Function, FunctionKind, Stmt};
use rungc_rt::axis_place::INPUTS;
use rungc_rt::{CmpOp, EdgeKind, Relay, RtFn, StopInput, Wiring};
use rungc_syntax::DeviceClass::{D, X, Y};
use rungc_syntax::{Device, OperandKind};
use std::collections::BTreeSet;

/// An instruction that looks at inputs.
struct Looker {
    /// Position of the instruction.
    at: usize,
    function: RtFn,
    /// Its private memory.
    slot: u16,
}

/// The instructions that look at inputs, and these inputs.
#[derive(Default)]
pub(super) struct Signals {
    lookers: Vec<Looker>,
    inputs: BTreeSet<u32>,
    /// A relay of the program may give a signal.
    relays: bool,
    /// The function that calls the instructions.
    function: Option<u32>,
}

/// Inputs X000 to X005 may stop pulses (h1u-h2u-programming §8.1, M8141).
const STOP_INPUTS: std::ops::Range<u32> = 0..6;

impl Lowerer<'_> {
    /// The instruction at hand looks at inputs. One that needs the buffer memory of a module does so in the scan alone,
    /// which has it.
    pub(super) fn find_signals(&mut self, function: RtFn, slot: u16) {
        let operands = &self.instr().operands;
        let mut inputs = Vec::new();
        for (operand, param) in operands.iter().zip(self.resolution().params) {
            let kind = &operand.kind;
            match *kind {
                OperandKind::Device(Device { class: X, number }, None)
                    if param.role == Role::Read && number < Wiring::FAST_INPUTS =>
                {
                    inputs.push(number);
                }
                _ if param.sends_pulses => {
                    if let Some(wiring) = self.wiring_of(kind) {
                        let mask = match wiring.axis {
                            None => u16::MAX,
                            Some(_) => self.mask_of_axis(kind),
                        };
                        let own = self.inputs_of_output(wiring, function);
                        inputs.extend(own.filter(|input| mask >> input & 1 == 1));
                    }
                }
                _ if param.names_inputs => {
                    let mask = mask_of(kind);
                    inputs.extend((0..u16::BITS).filter(|input| mask >> input & 1 == 1));
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
        }
        let buffer = |kind: &OperandKind| matches!(kind, OperandKind::Buffer { .. });
        if inputs.is_empty() || operands.iter().any(|operand| buffer(&operand.kind)) {
            return;
        }
        let devices = inputs.iter().map(|&input| (X, input));
        self.specials.flags.extend(devices);
        self.signals.inputs.extend(inputs);
        let at = self.at;
        self.signals.lookers.push(Looker { at, function, slot });
    }

    /// The inputs that the registers of an axis may name, as bits: what its instructions say, or all if the program may
    /// write others.
    fn mask_of_axis(&self, axis: &OperandKind) -> u16 {
        let Some(number) = output_of(axis) else {
            return u16::MAX;
        };
        let mut registers = INPUTS
            .into_iter()
            .filter_map(|place| self.model.axis_register(number, place));
        if registers.any(|register| self.looks_at(register)) {
            return u16::MAX;
        }
        let instrs = self.resolved.program.instrs.iter();
        let named = instrs
            .zip(&self.resolved.instrs)
            .filter_map(|(instr, resolution)| {
                let (axis, operands) = instr.operands.split_first()?;
                let Lower::Axis(places) = resolution.lower? else {
                    return None;
                };
                let own = output_of(&axis.kind) == Some(number);
                own.then(|| places.iter().zip(operands))
            });
        let named = named.flatten();
        named
            .filter(|(place, _)| INPUTS.contains(place))
            .fold(0, |mask, (_, operand)| mask | mask_of(&operand.kind))
    }

    fn inputs_of_output(
        &mut self,
        wiring: &Wiring,
        function: RtFn,
    ) -> impl Iterator<Item = u32> + use<> {
        let looks = function.needs().looks();
        let has = |relay: Option<Relay>| relay.is_some_and(|relay| self.specials.has(relay));
        let chosen = has(wiring.interrupt.chooses);
        self.signals.relays |= looks.interrupt && chosen && has(wiring.interrupt.relay);
        wiring.inputs(looks, chosen)
    }

    /// The edges of the inputs call the instructions, which see the device X as it is then.
    pub(super) fn signal_edges(&mut self) {
        let lookers = std::mem::take(&mut self.signals.lookers);
        if lookers.is_empty() {
            return;
        }
        let body = self.body(|this| {
            for looker in &lookers {
                this.call_at_signal(looker);
            }
        });
        let function = self.module.functions.len() as u32;
        self.module.functions.push(Function {
            kind: FunctionKind::Signals,
            body,
        });
        self.signals.function = Some(function);
        for input in self.signals.inputs.clone() {
            for kind in [EdgeKind::Rising, EdgeKind::Falling] {
                self.on_edge(input, kind, |this| {
                    let on = this.bit_const(kind == EdgeKind::Rising);
                    this.emit(Action::Write(Access::bit(fixed(X, input)), on));
                    this.emit(Stmt::CallSub(function));
                });
            }
        }
    }

    fn call_at_signal(&mut self, looker: &Looker) {
        self.at = looker.at;
        let wide = self.resolution().form.wide;
        let guards = self.bounds_hold();
        self.guarded(guards, |this| {
            let (args, step) = (this.args(), this.step());
            this.emit(Action::Call(Call {
                function: looker.function,
                wide,
                args,
                drive: None,
                signal: true,
                period_ms: 0,
                slot: looker.slot,
                step,
            }));
        });
    }

    /// After an interrupt routine, which may have switched on a relay that gives a signal.
    pub(super) fn signals_of_relays(&mut self) {
        if let Some(function) = self.signals.function.filter(|_| self.signals.relays) {
            self.emit(Stmt::CallSub(function));
        }
    }

    /// Inputs that stop pulses. The types with more outputs than those for which there are such inputs have none.
    pub(super) fn stop_inputs(&mut self) {
        let wiring = self.model.pulses.outputs();
        let sends = self.module.pulse_outputs.iter();
        let outputs: Option<Vec<(u32, StopInput)>> = sends
            .map(|&output| {
                let stop = wiring.get(output as usize)?.stop_input?;
                Some((output, stop))
            })
            .collect();
        for (output, stop) in outputs.unwrap_or_default() {
            if !self.specials.has(stop.enable) {
                continue;
            }
            self.specials.flags.push((D, stop.register.number()));
            for input in STOP_INPUTS {
                self.on_edge(input, EdgeKind::Rising, |this| {
                    let stops = this.is_stop_input(stop, input);
                    this.when(stops, |this| this.stop_pulses(output));
                });
            }
        }
    }

    /// Condition that this input stops pulses now.
    fn is_stop_input(&mut self, stop: StopInput, input: u32) -> ExprId {
        let enabled = self.add(Expr::Read(Access::bit(stop.enable)));
        let chosen = self.add(Expr::Read(Access::word(stop.register)));
        let number = self.int(input as i32, false);
        let chosen = self.add(Expr::Cmp(CmpOp::Eq, chosen, number));
        self.and(enabled, chosen)
    }

    fn stop_pulses(&mut self, output: u32) {
        self.emit(Action::Call(Call {
            function: RtFn::StopPulses,
            wide: false,
            args: vec![Arg::Device {
                place: fixed(Y, output),
                extent: Some(1),
            }],
            drive: None,
            signal: false,
            period_ms: 0,
            slot: 0,
            step: 0,
        }));
    }
}

/// The inputs that the bits of an operand name: all that there are, if only a run knows.
fn mask_of(kind: &OperandKind) -> u16 {
    kind.constant().map_or(u16::MAX, |mask| mask as u16)
}
