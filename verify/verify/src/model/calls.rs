//! Operations that are not modelled: calls of the runtime, which may write their operands and special devices.

use super::shared::{Seen, Signature};
use super::{Encoder, Input, Key};
use crate::aig::Lit;
use crate::bits::{Bits, known, signed};
use rungc_ir::node::{Action, Arg, Call, Fetch};
use rungc_ir::reach::{beyond_operands, of_action, written_by};
use rungc_models::runs::is_special;
use rungc_rt::{RtFn, Transfer};
use rungc_syntax::DeviceClass;
use std::collections::BTreeMap;

/// Name of operands in buffer memory.
const BUFFER: &str = "buffer memory of special modules";

/// Maximum number of words of a FROM that are known to be those of the module.
const MOVED: i32 = 256;

/// Description of what a PLC does by itself before or after the program.
fn own_work(function: RtFn) -> String {
    let what = match function {
        RtFn::ClockRefresh | RtFn::ClockRefreshShort => "registers of the clock",
        RtFn::PowerSupply => "relays and registers of the power supply",
        RtFn::AnalogInputs | RtFn::Potentiometers => "analog inputs",
        RtFn::ExchangeModule | RtFn::ExchangeBoard | RtFn::ExchangeAdapter => {
            "words that special modules exchange"
        }
        other => other.name(),
    };
    what.to_string()
}

impl Encoder<'_> {
    /// The memory of these runs of devices.
    pub(super) fn named_in(&self, runs: &[(DeviceClass, u32, u32)]) -> Vec<Key> {
        let keys = runs.iter();
        keys.flat_map(|&(class, first, last)| self.named(class, first, last))
            .collect()
    }

    /// Everything that a call may write.
    pub(super) fn of_call(&self, call: &Call) -> Vec<Key> {
        let needs = call.function.needs();
        if needs.anywhere {
            return self.state.keys().copied().collect();
        }
        let mut keys = self.shown_by(call.function);
        keys.extend(self.named_in(&beyond_operands(self.module, call)));
        // A panel may choose the output of a clear signal.
        let chooses = |&(class, number): &(DeviceClass, u32)| {
            class == DeviceClass::D && is_special(class, number)
        };
        if needs.clears && self.world.free.iter().any(chooses) {
            keys.extend(self.named(DeviceClass::Y, 0, u32::MAX));
        }
        keys
    }

    /// Devices that an action writes through its operands.
    pub(super) fn of_operands(&self, action: &Action) -> Vec<Key> {
        let mut runs = Vec::new();
        let (model, exprs) = (self.module.model, &self.module.exprs);
        written_by(model, action, &mut |used| {
            let reach = used.reach(model, exprs).into_iter();
            runs.extend(reach.map(|(first, last)| (used.place.class, first, last)));
        });
        self.named_in(&runs)
    }

    /// Devices that an action reads or writes through its operands.
    pub(super) fn at_operands(&self, action: &Action) -> Vec<Key> {
        let mut runs = Vec::new();
        let (model, exprs) = (self.module.model, &self.module.exprs);
        of_action(model, action, &mut |used| {
            let reach = used.reach(model, exprs).into_iter();
            runs.extend(reach.map(|(first, last)| (used.place.class, first, last)));
        });
        self.named_in(&runs)
    }

    pub(super) fn call(&mut self, action: &Action, call: &Call, guard: Lit) {
        let mut keys = self.of_operands(action);
        keys.extend(self.of_call(call));
        self.begin_instruction(call.step);
        let name = match (self.instruction, self.module.origin(call.step)) {
            (Some(_), Some(origin)) => origin.text.clone(),
            (Some(_), None) => call.function.name().to_uppercase(),
            (None, _) => own_work(call.function),
        };
        let anywhere = call.function.needs().anywhere;
        let seen = self.seen(action, anywhere, call.step);
        let moved = self.moved(call);
        keys.retain(|key| !moved.contains_key(key));
        self.apply(&keys, guard, &name, &seen);
        if !moved.is_empty() {
            let signature = Signature::Answer(format!("{} moves other words", seen.text));
            let other = self.applied(1, &name, signature, &seen.bits)[0];
            self.replay_assumptions.push(!other);
            for (key, held) in moved {
                let any = self.applied(held.len(), &name, seen.of(key), &seen.bits);
                let value = self.aig.select(other, &any, &held);
                self.store(key, &value, guard);
            }
        }
        self.leave_tokens(Some(call), &seen, guard);
        self.instruction = None;
    }

    /// An instruction of the program, or of what the PLC does before and after it.
    fn begin_instruction(&mut self, step: u32) {
        self.instruction = self.network.is_some().then_some(step);
    }

    /// Values that FROM moves from a module to registers, or one word of it to a group of bits, in the usual case: its
    /// other operands are constants, the module exists, and nothing changes the count. Otherwise, the targets may get
    /// any value.
    fn moved(&mut self, call: &Call) -> BTreeMap<Key, Bits> {
        let mut moved = BTreeMap::new();
        let number = |arg: &Arg| match *arg {
            Arg::Const {
                value, index: None, ..
            } => Some(value),
            _ => None,
        };
        let (Some(Transfer::FromModule), [unit, address, to, count]) =
            (call.function.transfer(), &call.args[..])
        else {
            return moved;
        };
        let (Some(unit), Some(address), Some(count)) =
            (number(unit), number(address), number(count))
        else {
            return moved;
        };
        let Ok(module) = u8::try_from(unit) else {
            return moved;
        };
        let words = if call.wide {
            count.saturating_mul(2)
        } else {
            count
        };
        let place = match *to {
            Arg::Device { place, .. } if place.index.is_none() => place,
            Arg::Nibbles { place, digits, .. } if place.index.is_none() && words == 1 => {
                let held = self.held(module, address.into()).unwrap_or_default();
                let bits = held.into_iter().take(4 * usize::from(digits));
                let bits = bits.zip(place.number..);
                let bits = bits.map(|(bit, number)| (Key::Bit(place.class, number), vec![bit]));
                return bits
                    .filter(|(key, _)| self.state.contains_key(key))
                    .collect();
            }
            _ => return moved,
        };
        for (n, register) in (0..words.min(MOVED)).zip(place.number..) {
            let key = Key::Word(place.class, register);
            if self.state.contains_key(&key)
                && let Some(held) = self.held(module, i64::from(address) + i64::from(n))
            {
                moved.insert(key, held);
            }
        }
        moved
    }

    /// Value of a module at an address in this scan: any value.
    fn held(&mut self, module: u8, address: i64) -> Option<Bits> {
        // Addresses have 16 bits.
        let key = Key::Buffer(module, u16::try_from(address).ok()?.into());
        let held = self.buffers.get(&key).cloned();
        let held = held.unwrap_or_else(|| self.inputs_named(16, |bit| Input::Device(key, bit)));
        self.buffers.insert(key, held.clone());
        Some(held)
    }

    /// Inputs of an action, if programs are compared.
    fn seen(&mut self, action: &Action, anywhere: bool, step: u32) -> Seen {
        match self.is_compared() {
            true => self.looks(action, anywhere, step),
            false => Seen::default(),
        }
    }

    /// Makes pieces of memory what something that is not modelled makes of what it looks at.
    fn apply(&mut self, keys: &[Key], guard: Lit, what: &str, seen: &Seen) {
        for &key in keys {
            if let Some(bits) = self.state.get(&key) {
                let value = self.applied(bits.len(), what, seen.of(key), &seen.bits);
                self.store(key, &value, guard);
            }
        }
    }

    pub(super) fn fetch(&mut self, fetch: &Fetch, guard: Lit) {
        self.begin_instruction(fetch.step);
        let seen = self.seen(&Action::Fetch(*fetch), false, fetch.step);
        let answer = |this: &mut Self, what: &str| {
            let signature = Signature::Answer(format!("{} {what}", seen.text));
            this.applied(1, BUFFER, signature, &seen.bits)[0]
        };
        // There may be no module, and its memory may change while a scan is under way: a replay shows neither.
        let (fails, changes) = (answer(self, "fails"), answer(self, "changes"));
        let faulty = self.aig.and(guard, fails);
        self.apply(&self.of_errors(), faulty, BUFFER, &seen);
        let cell = Key::Cell(fetch.value.0);
        let any = self.applied(32, BUFFER, seen.of(cell), &seen.bits);
        let value = match self.buffer(fetch) {
            Some(held) => {
                self.replay_assumptions.extend([!fails, !changes]);
                self.aig.select(changes, &any, &held)
            }
            None => any,
        };
        let reads = self.aig.and(guard, !fails);
        self.store(cell, &value, reads);
        self.assign(fetch.there, vec![!fails], guard);
        self.leave_tokens(None, &seen, guard);
        self.instruction = None;
    }

    /// Value of a module that a fetch reads, if it is known; in each scan it may be any value.
    fn buffer(&mut self, fetch: &Fetch) -> Option<Bits> {
        let Arg::Buffer {
            module,
            address,
            index,
        } = fetch.from
        else {
            return None;
        };
        let index = match index {
            Some(index) => known(&self.eval(index))?,
            None => 0,
        };
        let words = if fetch.wide { 2 } else { 1 };
        let mut bits = Bits::new();
        for word in 0..words {
            bits.extend(self.held(module, i64::from(address) + index + word)?);
        }
        Some(signed(&bits, 32))
    }

    pub(super) fn send(&mut self, action: &Action, step: u32, guard: Lit) {
        let mut keys = self.of_operands(action);
        keys.extend(self.of_errors());
        self.begin_instruction(step);
        let seen = self.seen(action, false, step);
        self.apply(&keys, guard, BUFFER, &seen);
        self.leave_tokens(None, &seen, guard);
        self.instruction = None;
    }

    /// An operation error found inline.
    pub(super) fn fault(&mut self, action: &Action, step: u32, guard: Lit) {
        let keys = self.of_errors();
        self.begin_instruction(step);
        let seen = self.seen(action, false, step);
        self.apply(
            &keys,
            guard,
            "relays and registers of operation errors",
            &seen,
        );
        self.instruction = None;
    }
}
