//! Expressions and actions as conditions.

use crate::graph::{Fact, FactKind, Id};
use crate::trace::{Effect, Scan, Where, is_silent};
use rungc_interp::rt_class;
use rungc_ir::node::{
    Access, AccessKind, Action, Block, Edge, Expr, ExprId, Place, SysValue, TimerCoil, Ty,
};
use rungc_ir::{reach, walk};
use rungc_rt::{EdgeKind, Plc as _};
use rungc_syntax::{Device, DeviceClass};

/// The device of a place without an index.
fn fixed(place: Place) -> Option<Device> {
    let Place { class, number, .. } = place;
    place.index.is_none().then_some(Device { class, number })
}

impl Scan<'_> {
    /// The instruction that an expression was made for.
    fn source(&self, id: ExprId) -> Option<usize> {
        self.fixed.marks.exprs.get(id).map(|&instr| instr as usize)
    }

    fn is_contact(&self, id: ExprId) -> bool {
        let instr = self.fixed.marks.exprs.get(id);
        instr.is_some_and(|&instr| self.fixed.marks.contacts.get(instr as usize) == Some(&true))
    }

    fn fact(&mut self, kind: FactKind, site: Where, inputs: Vec<Id>, value: bool) -> Id {
        let fact = Fact {
            kind,
            instr: site.instr,
            device: None,
            inputs,
            live: site.live,
        };
        self.graph().fact(fact, value)
    }

    /// A bit expression as a condition.
    pub(super) fn logic(&mut self, id: ExprId, site: Where) -> Id {
        let module = self.module();
        let instr = self.source(id).or(site.instr);
        match *module.expr(id) {
            Expr::Bit(value) if self.is_contact(id) => {
                let site = Where { instr, ..site };
                self.fact(FactKind::Constant, site, Vec::new(), value)
            }
            Expr::Bit(value) => self.graph().constant(value),
            Expr::Not(a) => {
                let a = self.logic(a, site);
                self.graph().not(a)
            }
            Expr::And(a, b) => {
                let [a, b] = [a, b].map(|part| self.logic(part, site));
                self.graph().and(a, b)
            }
            Expr::Or(a, b) => {
                let [a, b] = [a, b].map(|part| self.logic(part, site));
                self.graph().or(a, b)
            }
            Expr::Temp(temp) => match self.temp(temp) {
                Some(known) => known,
                None => self.opaque(id, FactKind::Other, site),
            },
            Expr::Read(Access {
                place,
                kind: AccessKind::Bit,
            }) => match fixed(place) {
                Some(device) => {
                    let of = self.bit(device);
                    let instr = self.source(id);
                    self.graph().contact(instr, device, of)
                }
                None => self.opaque(id, FactKind::Indexed, site),
            },
            Expr::Read(_) => self.opaque(id, FactKind::WordBit, site),
            Expr::Flag(flag) => self.flag(flag, site),
            Expr::Cmp(..) if self.is_contact(id) => self.opaque(id, FactKind::Comparison, site),
            Expr::Sys(SysValue::Running | SysValue::FirstScan) => {
                self.opaque(id, FactKind::System, site)
            }
            _ => self.opaque(id, FactKind::Other, site),
        }
    }

    /// A bit that is not followed further.
    fn opaque(&mut self, id: ExprId, kind: FactKind, site: Where) -> Id {
        let mut inputs = Vec::new();
        self.inputs(id, site, &mut inputs);
        let value = (site.live || self.is_safe(id)) && self.machine.is_on(id);
        let instr = self.source(id).or(site.instr);
        self.fact(kind, Where { instr, ..site }, inputs, value)
    }

    /// Returns true if an expression can be evaluated where the program does not: it needs nothing that conditions
    /// around it ensure.
    fn is_safe(&self, id: ExprId) -> bool {
        let module = self.module();
        match module.expr(id) {
            Expr::Entry(..) | Expr::Stride(..) | Expr::Temp(_) => false,
            Expr::Read(access) => access.place.index.is_none(),
            Expr::InRange { .. } => false,
            other => walk::operands(other).all(|part| self.is_safe(part)),
        }
    }

    /// Bits that the value of an expression may depend on.
    fn inputs(&mut self, id: ExprId, site: Where, found: &mut Vec<Id>) {
        let module = self.module();
        match *module.expr(id) {
            Expr::Temp(temp) => found.extend(self.temp(temp)),
            Expr::Flag(flag) => found.push(self.flag(flag, site)),
            Expr::Read(access) => {
                let mut footprints = Vec::new();
                reach::of_expr(module.model, module.expr(id), &mut |used| {
                    footprints.push(used)
                });
                for used in footprints {
                    self.found_in(&used, found);
                }
                if let Some(index) = access.place.index {
                    self.inputs(index, site, found);
                }
            }
            ref other => {
                let parts: Vec<_> = walk::operands(other).collect();
                for part in parts {
                    self.inputs(part, site, found);
                }
            }
        }
    }

    /// The devices of a footprint that are followed.
    fn devices_of(&self, used: &reach::Footprint) -> Vec<Device> {
        let module = self.module();
        let class = used.place.class;
        let runs = used.reach(module.model, &module.exprs);
        let mut devices = Vec::new();
        for (first, last) in runs {
            let [first, last] = [first, last].map(|number| Device { class, number });
            devices.extend(self.fixed.named.range(first..=last));
        }
        devices
    }

    /// Bits that the devices of a footprint depend on so far.
    fn found_in(&mut self, used: &reach::Footprint, found: &mut Vec<Id>) {
        for device in self.devices_of(used) {
            found.push(self.bit(device));
        }
        let module = self.module();
        let class = used.place.class;
        let runs = used.reach(module.model, &module.exprs);
        let within = |device: &Device| {
            let mut runs = runs.iter();
            device.class == class && runs.any(|(a, b)| (*a..=*b).contains(&device.number))
        };
        let words = self.trace.words.iter();
        found.extend(
            words
                .filter(|(device, _)| within(device))
                .map(|(_, &id)| id),
        );
    }

    /// An action.
    pub(super) fn action(&mut self, action: &Action, site: Where) {
        match *action {
            Action::Let(temp, value) => {
                let module = self.module();
                let mut bit = match module.temps[temp] {
                    Ty::Bit => self.logic(value, site),
                    Ty::I16 | Ty::I32 | Ty::F32 => self.opaque(value, FactKind::Other, site),
                };
                if let Some(relay) = self.fixed.sites.master(site.instr)
                    && module.temps[temp] == Ty::Bit
                {
                    bit = self.graph().contact(site.instr, relay, bit);
                }
                self.set_temp(temp, bit, site);
            }
            Action::Edge(edge) => self.edge(&edge, site),
            Action::SetFlag(flag, value) => {
                let value = self.logic(value, site);
                self.set_flag(flag, value, site);
            }
            Action::Write(access, value) => self.assignment(access, value, action, site),
            Action::Block(Block::Fill {
                to,
                count,
                length: None,
                value,
            }) if fixed(to).is_some() && self.module().ty(value) == Ty::Bit => {
                let value = self.logic(value, site);
                for number in to.number..to.number.saturating_add(count) {
                    self.write_named(
                        Device {
                            number,
                            class: to.class,
                        },
                        value,
                        site,
                    );
                }
            }
            Action::Timer(TimerCoil {
                number,
                kind,
                drive,
                preset,
            }) => {
                let class = DeviceClass::T;
                let drive = self.logic(drive, site);
                let mut inputs = vec![drive];
                self.inputs(preset, site, &mut inputs);
                self.set_word(Device { class, number }, inputs, site);
                let effect = Effect::Timer(drive, kind.accumulating);
                self.later(Device { class, number }, site, effect);
            }
            Action::Counter16(coil) => {
                let next = self.is_next(coil.number, coil.preset, site);
                self.counter(coil.number, coil.drive, next, site);
            }
            Action::Counter32(coil) => {
                let device = Device {
                    class: DeviceClass::C,
                    number: coil.number,
                };
                let drive = self.logic(coil.drive, site);
                let mut inputs = vec![drive];
                self.inputs(coil.down, site, &mut inputs);
                self.set_word(device, inputs.clone(), site);
                self.later(device, site, Effect::Unknown(FactKind::Counted, inputs));
            }
            Action::Reset { place, .. } if fixed(place).is_some() => {
                let off = self.graph().constant(false);
                if let Some(device) = fixed(place) {
                    self.set_word(device, Vec::new(), site);
                    self.write_named(device, off, site);
                }
            }
            ref other if is_silent(other) => {}
            ref other => self.unknown(other, site),
        }
    }

    /// OUT of a 16-bit counter.
    fn counter(&mut self, number: u32, drive: ExprId, next: bool, site: Where) {
        let device = Device {
            class: DeviceClass::C,
            number,
        };
        let drive = self.logic(drive, site);
        self.set_word(device, vec![drive], site);
        self.later(device, site, Effect::Counter(drive, next));
    }

    /// Returns true if a counter reaches its preset when its drive comes on.
    fn is_next(&self, number: u32, preset: ExprId, site: Where) -> bool {
        let Some(class) = rt_class(DeviceClass::C) else {
            return false;
        };
        let coil = self.machine.coil(class, number);
        let count = self.machine.word(class, number).unwrap_or(0);
        let is_known = site.live || self.is_safe(preset);
        let preset = is_known.then(|| self.machine.integer(preset));
        coil == Some(false) && preset.is_some_and(|preset| i32::from(count) + 1 >= preset)
    }

    fn edge(&mut self, edge: &Edge, site: Where) {
        let input = self.logic(edge.input, site);
        let was = self.memory(edge.memory, site.instr);
        let changed = match edge.kind {
            EdgeKind::Rising => {
                let before = self.graph().not(was);
                self.graph().and(input, before)
            }
            EdgeKind::Falling => {
                let now = self.graph().not(input);
                self.graph().and(now, was)
            }
        };
        self.set_memory(edge.memory, input, site);
        self.set_temp(edge.out, changed, site);
    }

    /// A value that is written to a device.
    fn assignment(&mut self, access: Access, value: ExprId, action: &Action, site: Where) {
        match (fixed(access.place), access.kind) {
            (Some(device), AccessKind::Bit) if site.instr.is_some() => {
                let value = self.logic(value, site);
                self.write_named(device, value, site);
            }
            _ => self.unknown(action, site),
        }
    }

    fn write_named(&mut self, device: Device, value: Id, site: Where) {
        if self.fixed.named.contains(&device) {
            self.write(device, value, site);
        }
    }

    /// Anything else that writes devices: what it writes is not followed.
    fn unknown(&mut self, action: &Action, site: Where) {
        let module = self.module();
        let mut inputs = Vec::new();
        let mut values = Vec::new();
        let stmt = rungc_ir::node::Stmt::Do(action.clone());
        walk::for_exprs(&stmt, &mut |&id| values.push(id));
        for id in values {
            self.inputs(id, site, &mut inputs);
        }
        let mut read = Vec::new();
        reach::of_action(module.model, action, &mut |used| read.push(used));
        for used in &read {
            self.found_in(used, &mut inputs);
        }
        let kind = match site.instr {
            Some(_) => FactKind::Written,
            None => FactKind::System,
        };
        let mut written = Vec::new();
        reach::written_by(module.model, action, &mut |used| written.push(used));
        for used in &written {
            for device in self.devices_of(used) {
                self.later(device, site, Effect::Unknown(kind, inputs.clone()));
            }
            if let Some(device) = fixed(used.place) {
                self.set_word(device, inputs.clone(), site);
            }
        }
        let mut beyond = Vec::new();
        if let Action::Call(call) = action {
            beyond = reach::beyond_operands(module, call);
        }
        if matches!(action, Action::Clear { .. }) && site.live {
            beyond = [DeviceClass::Y, DeviceClass::M, DeviceClass::S]
                .into_iter()
                .flat_map(|class| {
                    let runs = module.model.runs(class).into_iter();
                    runs.map(move |(first, last)| (class, first, last))
                })
                .collect();
        }
        for (class, first, last) in beyond {
            let [first, last] = [first, last].map(|number| Device { class, number });
            let devices: Vec<_> = self.fixed.named.range(first..=last).copied().collect();
            for device in devices {
                self.later(device, site, Effect::Unknown(kind, inputs.clone()));
            }
        }
    }
}
