//! What is not modelled: calls of the runtime, which may write what they are handed and special devices.

use super::shared::{Seen, Signature};
use super::{Encoder, Key};
use crate::aig::Lit;
use rungc_ir::node::{Call, Fetch, Stmt};
use rungc_ir::reach::of_stmt;
use rungc_syntax::DeviceClass;

/// Special devices that an instruction of the runtime may write: all but those that the scan alone maintains, M8000 to
/// M8003 and M8011 to M8014.
const SPECIAL: [(DeviceClass, u32, u32); 3] = [
    (DeviceClass::M, 8004, 8010),
    (DeviceClass::M, 8015, u32::MAX),
    (DeviceClass::D, 8000, u32::MAX),
];

/// How operands in buffer memory are called.
const BUFFER: &str = "buffer memory of special modules";

/// What an operation error writes.
const ERRORS: [(DeviceClass, u32, u32); 4] = [
    (DeviceClass::M, 8004, 8006),
    (DeviceClass::M, 8067, 8069),
    (DeviceClass::D, 8004, 8006),
    (DeviceClass::D, 8067, 8069),
];

impl Encoder<'_> {
    fn named_in(&self, runs: &[(DeviceClass, u32, u32)]) -> Vec<Key> {
        let keys = runs.iter();
        keys.flat_map(|&(class, first, last)| self.named(class, first, last))
            .collect()
    }

    /// The special devices that the runtime may write. An index register is not one of them, even if a special
    /// register is another name for it.
    pub(super) fn specials(&self) -> Vec<Key> {
        let mut keys = self.named_in(&SPECIAL);
        keys.retain(|key| !matches!(key, Key::Word(DeviceClass::V | DeviceClass::Z, _)));
        keys
    }

    /// Everything that a call may write.
    pub(super) fn of_call(&self, call: &Call) -> Vec<Key> {
        let needs = call.function.needs();
        if needs.anywhere {
            return self.state.keys().copied().collect();
        }
        let mut keys = self.specials();
        if needs.pulses || needs.signals || needs.clears {
            keys.extend(self.named(DeviceClass::Y, 0, u32::MAX));
        }
        keys
    }

    /// What a statement writes of the devices that its operands name.
    pub(super) fn of_operands(&self, stmt: &Stmt) -> Vec<Key> {
        let mut runs = Vec::new();
        let (model, exprs) = (self.module.model, &self.module.exprs);
        of_stmt(model, stmt, &mut |used| {
            if used.writes {
                let reach = used.reach(model, exprs).into_iter();
                runs.extend(reach.map(|(first, last)| (used.place.class, first, last)));
            }
        });
        self.named_in(&runs)
    }

    pub(super) fn call(&mut self, stmt: &Stmt, call: &Call, guard: Lit) {
        let mut keys = self.of_operands(stmt);
        keys.extend(self.of_call(call));
        let name = match self.module.origin(call.step) {
            Some(origin) => origin.text.clone(),
            None => call.function.name().to_uppercase(),
        };
        let anywhere = call.function.needs().anywhere;
        let seen = self.seen(stmt, anywhere, call.step);
        self.apply(&keys, guard, &name, &seen);
        self.leave_tokens(Some(call), &seen, guard);
    }

    /// What a statement looks at, if programs are compared.
    fn seen(&mut self, stmt: &Stmt, anywhere: bool, step: u32) -> Seen {
        match self.is_compared() {
            true => self.looks(stmt, anywhere, step),
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
        let seen = self.seen(&Stmt::Fetch(*fetch), false, fetch.step);
        let mut keys = self.specials();
        keys.push(Key::Cell(fetch.value.0));
        self.apply(&keys, guard, BUFFER, &seen);
        let there = self.applied(1, BUFFER, Signature::Answer(seen.text.clone()), &seen.bits);
        self.assign(fetch.there, there, guard);
        self.leave_tokens(None, &seen, guard);
    }

    pub(super) fn send(&mut self, stmt: &Stmt, step: u32, guard: Lit) {
        let mut keys = self.of_operands(stmt);
        keys.extend(self.specials());
        let seen = self.seen(stmt, false, step);
        self.apply(&keys, guard, BUFFER, &seen);
        self.leave_tokens(None, &seen, guard);
    }

    /// An operation error found inline.
    pub(super) fn fault(&mut self, stmt: &Stmt, step: u32, guard: Lit) {
        let keys = self.named_in(&ERRORS);
        let seen = self.seen(stmt, false, step);
        self.apply(
            &keys,
            guard,
            "relays and registers of operation errors",
            &seen,
        );
    }
}
