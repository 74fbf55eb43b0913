//! Calls of the runtime.

use super::Lowerer;
use super::operand::fixed;
use rungc_analysis::resolve::Resolution;
use rungc_catalogue::{Extent, Form, Lower, Param, Rule, Shape};
use rungc_ir::node::{Action, Arg, Branch, Call, CellId, Expr, ExprId, Place, Stmt, SysValue};
use rungc_ir::reach::axis_directions;
use rungc_models::runs::{is_counter32, words_of_bits};
use rungc_rt::{Clear, CmpOp, EdgeKind, Looks, RtFn, Wiring};
use rungc_syntax::{Device, DeviceClass, Index, Operand, OperandKind, codes, phrase};
use std::borrow::Cow;

/// Classes of which registers may name a device at run time.
const ANYWHERE: [DeviceClass; 7] = [
    DeviceClass::X,
    DeviceClass::Y,
    DeviceClass::M,
    DeviceClass::S,
    DeviceClass::T,
    DeviceClass::C,
    DeviceClass::D,
];

impl Lowerer<'_> {
    pub(super) fn call(&mut self, function: RtFn) {
        if self.inlined(function) {
            return;
        }
        let needs = function.needs();
        let form = self.resolution().form;
        let step = self.step();
        let slot = self.slot(needs.state);
        if needs.pulses {
            self.use_outputs(needs.looks());
            self.use_counts_of_inputs();
        }
        if needs.anywhere {
            self.specials.whole.extend(ANYWHERE);
        }
        if needs.port || needs.names_port || needs.any_port || needs.can {
            self.use_ports(needs, function);
        }
        if needs.signals {
            self.find_signals(function, slot);
        }
        let drive = self.drive();
        let drive = if form.pulse {
            let edge = self.new_edge();
            self.edge(edge, EdgeKind::Rising, drive)
        } else {
            drive
        };
        let call = |this: &mut Self, drive| {
            let guards = this.bounds_hold();
            this.guarded_while(guards, drive, |this| {
                this.within_limits(drive, |this, drive| {
                    let args = this.args();
                    this.emit(Action::Call(Call {
                        function,
                        wide: form.wide,
                        args,
                        drive,
                        signal: false,
                        period_ms: 0,
                        slot,
                        step,
                    }));
                });
            });
        };
        if needs.always {
            call(self, Some(drive));
        } else {
            self.when(drive, |this| call(this, None));
        }
    }

    /// If a program has several instructions of which one runs at a time, a cell says which.
    pub(super) fn find_exclusive(&mut self) {
        let instrs = self.resolved.instrs.iter();
        let exclusive = instrs.filter(|instr| matches!(instr.lower, Some(Lower::Exclusive(_))));
        if exclusive.count() > 1 {
            let meaning = "which of the instructions runs that run one at a time";
            let runs = self.cell("runs_alone".to_string(), meaning);
            self.exclusive = Some((runs, 0));
        }
    }

    /// None runs when RUN begins.
    pub(super) fn forget_exclusive(&mut self) {
        if let Some((runs, _)) = self.exclusive {
            let first = self.add(Expr::Sys(SysValue::FirstScan));
            let none = self.add(Expr::I32(0));
            self.when(first, |this| this.emit(Action::SetCell(runs, none)));
        }
    }

    /// Calls a function that does nothing while another of its kind is driven.
    pub(super) fn exclusive_call(&mut self, function: RtFn) {
        let slot = self.slot(function.needs().state);
        let mut drive = self.drive();
        if let Some((runs, before)) = &mut self.exclusive {
            *before += 1;
            let (runs, own) = (*runs, *before);
            drive = self.alone(drive, runs, own);
        }
        let wide = self.wide();
        let guards = self.bounds_hold();
        self.guarded_while(guards, Some(drive), |this| {
            let args = this.args();
            let step = this.step();
            this.emit(Action::Call(Call {
                function,
                wide,
                args,
                drive: Some(drive),
                signal: false,
                period_ms: 0,
                slot,
                step,
            }));
        });
    }

    /// Condition that an instruction is driven and no other runs; it then runs until it is not driven any more.
    fn alone(&mut self, drive: ExprId, runs: CellId, own: i32) -> ExprId {
        let drive = self.settled(drive);
        let (none, own) = (self.add(Expr::I32(0)), self.add(Expr::I32(own)));
        let running = self.add(Expr::Cell(runs));
        let free = self.add(Expr::Cmp(CmpOp::Eq, running, none));
        let mine = self.add(Expr::Cmp(CmpOp::Eq, running, own));
        let may = self.or(free, mine);
        let driven = self.and(drive, may);
        let driven = self.settled(driven);
        let off = self.not(drive);
        let ends = self.and(off, mine);
        self.emit(Stmt::If(Branch {
            cond: driven,
            then: vec![Stmt::Do(Action::SetCell(runs, own))],
            otherwise: vec![Stmt::If(Branch {
                cond: ends,
                then: vec![Stmt::Do(Action::SetCell(runs, none))],
                otherwise: Vec::new(),
            })],
        }));
        driven
    }

    /// The program sends pulses at the outputs that the instruction names; what it also reads is stored.
    fn use_outputs(&mut self, looks: Looks) {
        let operands = &self.instr().operands;
        for (operand, param) in operands.iter().zip(self.resolution().params) {
            let kind = &operand.kind;
            let Some(number) = output_of(kind).filter(|_| param.sends_pulses) else {
                continue;
            };
            let wiring = self.wiring_of(kind);
            if wiring.is_some_and(|wiring| wiring.axis.is_some()) {
                self.use_axes();
            } else if let Err(place) = self.module.pulse_outputs.binary_search(&number) {
                self.module.pulse_outputs.insert(place, number);
            }
            let registers = wiring.into_iter().flat_map(|w| w.registers(looks));
            let registers = registers.map(|register| (DeviceClass::D, register.number()));
            self.specials.flags.extend(registers);
            if let Some(wiring) = wiring.filter(|_| looks.clears) {
                let clears = [wiring.zrn_clear, wiring.home.and_then(|home| home.clear)];
                for clear in clears.into_iter().flatten() {
                    self.use_clear_signal(clear);
                }
            }
        }
    }

    /// The special devices of the output that an operand names.
    pub(super) fn wiring_of(&self, kind: &OperandKind) -> Option<&'static Wiring> {
        let number = output_of(kind)?;
        self.model.pulses.outputs().get(number as usize)
    }

    /// An axis may be bound to any output, and has an output for its direction.
    fn use_axes(&mut self) {
        let outputs = 0..self.model.pulses.outputs().len() as u32;
        let directions = axis_directions(self.model).map(|output| (DeviceClass::Y, output));
        self.specials.flags.extend(directions);
        self.module.pulse_outputs = outputs.collect();
    }

    /// The output of a clear signal is stored: all outputs, if the program may choose another one.
    fn use_clear_signal(&mut self, clear: Clear) {
        if clear.register.is_some_and(|own| self.specials.has(own)) {
            self.specials.whole.push(DeviceClass::Y);
        }
        let chosen = clear.register.filter(|_| clear.chooses.is_none());
        let chosen = chosen.map(|register| self.model.word_at_power_on(register));
        let chosen = chosen.filter(|&output| output != 0);
        let output = chosen.map_or(clear.output, |output| output as u32);
        self.specials.flags.push((DeviceClass::Y, output));
    }

    /// Number of a new private memory, or 0 for a function without.
    fn slot(&mut self, needed: bool) -> u16 {
        if !needed {
            return 0;
        }
        match self.module.states.checked_add(1) {
            Some(slot) => self.module.states = slot,
            None => {
                let span = self.instr().span;
                let message = "more than 65535 instructions that keep a state";
                self.report(codes::NOT_IMPLEMENTED.at(span, message));
            }
        }
        self.module.states
    }

    pub(super) fn args(&mut self) -> Vec<Arg> {
        let resolution = self.resolution();
        let wide = resolution.form.wide;
        let operands = in_words(resolution.params, &self.instr().operands);
        let extents = extents(resolution, &operands);
        let mut args: Vec<Arg> = operands
            .iter()
            .zip(extents)
            .map(|(operand, extent)| self.arg(operand, extent, wide))
            .collect();
        let twin = resolution.inst.and_then(|inst| inst.twin);
        if let (Some(class), Some(&Arg::Device { place, extent })) = (twin, args.first()) {
            let place = Place { class, ..place };
            args.push(Arg::Device { place, extent });
        }
        args
    }

    fn arg(&mut self, operand: &Operand, extent: Option<u32>, wide: bool) -> Arg {
        match operand.kind {
            OperandKind::Decimal(value, index) => self.constant_arg(value as i32, index, wide),
            OperandKind::Hex(value, index) => self.constant_arg(value as u32 as i32, index, wide),
            OperandKind::Float(value) => Arg::Float(value),
            OperandKind::Device(device, index) if self.counts_words(device, index) => {
                self.report_counter_words(operand);
                self.constant_arg(0, None, wide)
            }
            OperandKind::Device(device, index) => Arg::Device {
                place: self.arg_place(device, index, extent, wide),
                extent,
            },
            OperandKind::Nibbles(digits, device, index) => Arg::Nibbles {
                place: self.arg_place(device, index, extent, wide),
                digits,
                extent,
            },
            OperandKind::WordBit(device, bit, index) => Arg::WordBit {
                place: self.arg_place(
                    device,
                    index,
                    extent.map(|bits| words_of_bits(bit & 15, bits)),
                    wide,
                ),
                bit: bit & 15,
                extent,
            },
            OperandKind::Text(ref text) => {
                self.module.texts.push(text.to_string());
                Arg::Text(self.module.texts.len() as u32 - 1)
            }
            // The checks have rejected unreadable operands.
            OperandKind::Unreadable(_) => self.constant_arg(0, None, wide),
            // As well as other modules and addresses.
            OperandKind::Buffer { .. } => match self.buffer(&operand.kind, 0, wide) {
                Some(buffer) => buffer,
                None => self.constant_arg(0, None, wide),
            },
        }
    }

    /// The runtime finds 32-bit counters by their number alone.
    fn report_counter_words(&mut self, operand: &Operand) {
        let name = &self.instr().mnemonic;
        let message = phrase!(
            "`{name}` cannot be compiled with `{kind}`",
            name,
            kind = operand.kind
        );
        let diagnostic = codes::NOT_IMPLEMENTED.at(operand.span, message);
        let label = "an index counts the words of 32-bit counters here";
        let help = "copy the counter first, with `DMOV` and the index";
        self.report(diagnostic.label(label).help(help));
    }

    fn constant_arg(&mut self, value: i32, index: Option<Index>, wide: bool) -> Arg {
        let index = index.map(|index| self.constant_index(index, wide));
        // The index is an `I32` wherever it is added to a number.
        let index = index.map(|id| {
            if wide {
                id
            } else {
                self.add(rungc_ir::node::Expr::Widen(id))
            }
        });
        Arg::Const { value, index, wide }
    }

    /// The runtime checks the range, and finds registers by any name.
    fn arg_place(
        &mut self,
        device: Device,
        index: Option<Index>,
        extent: Option<u32>,
        wide: bool,
    ) -> Place {
        let place = fixed(device.class, device.number);
        let index = index.map(|written| {
            let bound = self.bound(place, written, extent.unwrap_or(1));
            let index = self.index(written, wide);
            let index = self.within(index, bound);
            self.note_index(index, place, written);
            index
        });
        Place { index, ..place }
    }
}

/// The number of the output or axis that an operand names.
pub(super) fn output_of(kind: &OperandKind) -> Option<u32> {
    match *kind {
        OperandKind::Device(Device { number, .. }, _) => Some(number),
        OperandKind::Decimal(axis, _) => u32::try_from(axis).ok(),
        OperandKind::Hex(axis, _) => u32::try_from(axis).ok(),
        OperandKind::WordBit(..)
        | OperandKind::Nibbles(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

/// The operands, with groups that [`Rule::WordsWith`] makes words.
fn in_words<'o>(params: &[Param], operands: &'o [Operand]) -> Cow<'o, [Operand]> {
    let mut words = Cow::Borrowed(operands);
    let kind = |i: usize| operands.get(i).map(|operand| &operand.kind);
    for (i, param) in params.iter().enumerate() {
        let word = |other: usize| !matches!(kind(other), Some(OperandKind::Nibbles(..)));
        let widens = |rule: &Rule| matches!(*rule, Rule::WordsWith(other) if word(other));
        if let Some(OperandKind::Nibbles(digits @ ..4, device, index)) = kind(i)
            && param.rules.iter().any(widens)
        {
            let digits = (*digits).max(4);
            words.to_mut()[i].kind = OperandKind::Nibbles(digits, *device, *index);
        }
    }
    words
}

/// Number of devices (bits of a group) that each operand occupies from the named one on; `None`: to the end of its
/// class.
pub(super) fn extents<'o>(
    resolution: &Resolution,
    operands: &'o [Operand],
) -> impl Iterator<Item = Option<u32>> + use<'o> {
    let (params, form) = (resolution.params, resolution.form);
    let constants: Vec<Option<i64>> = operands.iter().map(|o| o.kind.constant()).collect();
    operands.iter().enumerate().map(move |(i, operand)| {
        let param = params.get(i)?;
        if let Extent::Through(last) = param.extent {
            return through(&operand.kind, &operands.get(last)?.kind);
        }
        let elements = elements(param.extent_of(&operand.kind), &constants)?;
        Some(elements.saturating_mul(unit(param, &operand.kind, form)))
    })
}

/// Number of devices from the first to the last.
fn through(first: &OperandKind, last: &OperandKind) -> Option<u32> {
    match (first, last) {
        (OperandKind::Device(first, None), OperandKind::Device(last, None)) => {
            Some(last.number.saturating_sub(first.number).saturating_add(1))
        }
        _ => None,
    }
}

fn elements(extent: Extent, constants: &[Option<i64>]) -> Option<u32> {
    match extent {
        Extent::One => Some(1),
        Extent::Count(count) => Some(count),
        Extent::Between { most, .. } => Some(most),
        Extent::Operand { i, extra } => {
            let count = constants.get(i).copied()??;
            u32::try_from(count.saturating_add(i64::from(extra)).max(1)).ok()
        }
        Extent::Of(count) | Extent::Bits(count) => count(constants),
        Extent::Through(_) => None,
    }
}

/// Devices (bits of a group) per element.
fn unit(param: &Param, operand: &OperandKind, form: Form) -> u32 {
    match *operand {
        OperandKind::Nibbles(digits, ..) => 4 * u32::from(digits),
        OperandKind::Device(device, _) if is_counter32(device.class, device.number) => 1,
        OperandKind::Device(..)
        | OperandKind::WordBit(..)
        | OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => match param.shape {
            Shape::Value if form.wide => 2,
            Shape::Pair | Shape::Float => 2,
            Shape::Bit
            | Shape::Value
            | Shape::Word
            | Shape::Text
            | Shape::Pointer
            | Shape::Mixed => 1,
        },
    }
}
