//! Special relays and registers in use. What the scan or an instruction would write to the others is left out.

use super::call::extents;
use super::{LowerOptions, Lowerer, inline};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Drive, Lower, Role};
use rungc_ir::ranges::Reached;
use rungc_models::runs::FIRST_SPECIAL;
use rungc_models::special::SpecialDevice;
use rungc_rt::Register;
use rungc_syntax::{DeviceClass, OperandKind};

/// More than any model has.
const COUNT: usize = 1000;
/// M8000 to M8003: in RUN, not in RUN, first scan, not the first scan.
const RUN_FLAGS: std::ops::RangeInclusive<u32> = 8000..=8003;

/// The special devices that the program names (or reaches with an index), that a call may touch, or that are observed.
pub(super) struct Specials {
    relays: Vec<bool>,
    registers: Vec<bool>,
    /// Devices that the called functions use as flags.
    pub(super) flags: Vec<(DeviceClass, u32)>,
    /// Classes that called functions may access anywhere.
    pub(super) whole: Vec<DeviceClass>,
    /// True if the program writes one of M8000–M8003.
    pub(super) writes_run_flags: bool,
}

impl Specials {
    pub(super) fn of(resolved: &Resolved, options: &LowerOptions, reached: &Reached) -> Self {
        let mut specials = Specials {
            relays: vec![options.wanted.observe_all; COUNT],
            registers: vec![options.wanted.observe_all; COUNT],
            flags: Vec::new(),
            whole: Vec::new(),
            writes_run_flags: reached.writes_run_flags,
        };
        for &(class, number) in options.wanted.observe.iter().chain(&reached.special) {
            specials.mark(class, number, Some(1));
        }
        let mut contacts = [false; 4];
        for i in 0..resolved.instrs.len() {
            match run_flag_contact(resolved, i) {
                Some(flag) => contacts[flag] = true,
                None => specials.mark_instr(resolved, i),
            }
        }
        // As contacts they are constants or values of the scan driver, unless the program writes them.
        if specials.writes_run_flags {
            for (flag, read) in contacts.into_iter().enumerate() {
                specials.relays[flag] |= read;
            }
        }
        specials
    }

    /// Returns true if a special device is used.
    pub(super) fn has<D: SpecialDevice>(&self, device: D) -> bool {
        let set = match D::CLASS == DeviceClass::M {
            true => &self.relays,
            false => &self.registers,
        };
        let i = device.number().checked_sub(FIRST_SPECIAL);
        let mark = i.and_then(|i| set.get(i as usize));
        mark.copied().unwrap_or(false)
    }

    fn mark(&mut self, class: DeviceClass, number: u32, count: Option<u32>) {
        let set = if class == DeviceClass::M {
            &mut self.relays
        } else if class == DeviceClass::D {
            &mut self.registers
        } else {
            return;
        };
        let Some(first) = number.checked_sub(FIRST_SPECIAL) else {
            return;
        };
        let end = count.map_or(COUNT, |count| {
            (first as usize).saturating_add(count as usize)
        });
        for mark in set.iter_mut().take(end).skip(first as usize) {
            *mark = true;
        }
    }

    fn mark_instr(&mut self, resolved: &Resolved, i: usize) {
        let instr = &resolved.program.instrs[i];
        let resolution = &resolved.instrs[i];
        let (Some(inst), Some(lower)) = (resolution.inst, resolution.lower) else {
            return;
        };
        if matches!(lower, Lower::Call(function) if inline::has_flags(function, instr, resolution.form.wide))
        {
            for (class, number) in flags_of(inst.flags) {
                self.mark(class, number, Some(1));
                if !self.flags.contains(&(class, number)) {
                    self.flags.push((class, number));
                }
            }
        }
        let special = |operand: &OperandKind| {
            matches!(operand,
            OperandKind::Device(d, _) | OperandKind::Nibbles(_, d, _) | OperandKind::WordBit(d, ..)
            if matches!(d.class, DeviceClass::M | DeviceClass::D) && d.number >= FIRST_SPECIAL)
        };
        if !instr.operands.iter().any(|operand| special(&operand.kind)) {
            return;
        }
        let extents: Vec<_> = extents(resolution, &instr.operands).collect();
        let params = resolution.params;
        for (i, operand) in instr.operands.iter().enumerate() {
            let extent = extents[i];
            let (device, index) = match operand.kind {
                OperandKind::Device(device, index) | OperandKind::Nibbles(_, device, index) => {
                    (device, index)
                }
                OperandKind::WordBit(device, _, index) => (device, index),
                OperandKind::Decimal(..)
                | OperandKind::Hex(..)
                | OperandKind::Float(_)
                | OperandKind::Text(_)
                | OperandKind::Buffer { .. }
                | OperandKind::Unreadable(_) => continue,
            };
            // The range of an index is determined from the lowered code.
            if index.is_some() {
                continue;
            }
            self.mark(device.class, device.number, extent);
            let end = extent.map_or(u32::MAX, |count| device.number.saturating_add(count));
            let reads = params.get(i).is_some_and(|param| param.role == Role::Read);
            self.writes_run_flags |= !reads
                && device.class == DeviceClass::M
                && device.number >= FIRST_SPECIAL
                && RUN_FLAGS.clone().any(|n| (device.number..end).contains(&n));
        }
    }
}

impl Lowerer<'_> {
    /// Returns true if an instruction names an ordinary register, among others or with an index, or something observes
    /// it.
    pub(super) fn looks_at(&self, register: Register) -> bool {
        let observed = (DeviceClass::D, register.number());
        self.observed.contains(&observed) || self.names(register)
    }

    /// Returns true if an instruction names an ordinary register, among others or with an index.
    pub(super) fn names(&self, register: Register) -> bool {
        let named = self.named.get_or_init(|| self.named_registers());
        named.get(usize::from(register.0)).copied().unwrap_or(false)
    }

    /// The ordinary registers that instructions name.
    fn named_registers(&self) -> Vec<bool> {
        let mut named = vec![false; FIRST_SPECIAL as usize];
        for (instr, resolution) in self
            .resolved
            .program
            .instrs
            .iter()
            .zip(&self.resolved.instrs)
        {
            if resolution.inst.is_none() {
                continue;
            }
            let extents = extents(resolution, &instr.operands);
            for (operand, extent) in instr.operands.iter().zip(extents) {
                let (device, index) = match operand.kind {
                    OperandKind::Device(device, index) => (device, index),
                    OperandKind::WordBit(device, _, index) => (device, index),
                    OperandKind::Nibbles(..)
                    | OperandKind::Decimal(..)
                    | OperandKind::Hex(..)
                    | OperandKind::Float(_)
                    | OperandKind::Text(_)
                    | OperandKind::Buffer { .. }
                    | OperandKind::Unreadable(_) => continue,
                };
                if device.class != DeviceClass::D {
                    continue;
                }
                let (first, count) = match index {
                    Some(_) => (0, usize::MAX),
                    None => (
                        device.number as usize,
                        extent.map_or(usize::MAX, |n| n as usize),
                    ),
                };
                named
                    .iter_mut()
                    .skip(first)
                    .take(count)
                    .for_each(|mark| *mark = true);
            }
        }
        named
    }
}

/// Index of the run flag that an instruction reads as a contact.
fn run_flag_contact(resolved: &Resolved, i: usize) -> Option<usize> {
    let inst = resolved.instrs[i].inst?;
    match resolved.program.instrs[i].operands.first()?.kind {
        OperandKind::Device(device, None)
            if inst.drive == Drive::Logic
                && inst.basic().is_some()
                && device.class == DeviceClass::M
                && RUN_FLAGS.contains(&device.number) =>
        {
            Some((device.number - FIRST_SPECIAL) as usize)
        }
        OperandKind::Device(..)
        | OperandKind::WordBit(..)
        | OperandKind::Nibbles(..)
        | OperandKind::Decimal(..)
        | OperandKind::Hex(..)
        | OperandKind::Float(_)
        | OperandKind::Text(_)
        | OperandKind::Buffer { .. }
        | OperandKind::Unreadable(_) => None,
    }
}

/// The devices that a row's `flags` name.
fn flags_of(flags: &'static [&'static str]) -> impl Iterator<Item = (DeviceClass, u32)> {
    flags.iter().filter_map(|flag| {
        let (prefix, number) = flag.split_at_checked(1)?;
        Some((DeviceClass::from_prefix(prefix)?, number.parse().ok()?))
    })
}
