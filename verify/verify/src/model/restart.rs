//! RUN after STOP. It begins as power-on does, with the exception of what STOP does not clear: special devices, the
//! private memory of the scan, and, with M8033, all devices. Programs without these are not asked: whatever happens
//! after STOP happens after power-on, too, where latched devices begin with any value.

use super::shared::Signature;
use super::{CounterPart, Encoder, Input, Key, TimerPart, device_of};
use crate::aig::Lit;
use crate::bits::{Bits, constant};
use rungc_ir::node::{Action, FlagId, SetEntry, Stmt};
use rungc_ir::walk::{callees, statements};
use rungc_models::runs::is_special;
use rungc_rt::special::M_KEEP_IN_STOP;
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Relay with which STOP clears nothing.
const KEEP: Key = Key::Bit(DeviceClass::M, M_KEEP_IN_STOP.number());

/// Name of what the PLC does in STOP.
pub const AFTER_STOP: &str = "special devices and times after STOP";

/// Returns true if a special relay is what it is in every scan, whatever it was before.
fn is_of_scan(key: Key) -> bool {
    matches!(key, Key::Bit(DeviceClass::M, 8000..=8003 | 8011..=8014))
}

impl Encoder<'_> {
    /// Returns true if RUN may begin otherwise after STOP than at power-on.
    pub(super) fn remembers_stop(&self) -> bool {
        // Two programs begin RUN together, and with what each of them has latched.
        if self.is_compared() {
            return true;
        }
        let keys = self.before.keys().copied();
        let mut changed = keys.filter(|&key| self.written.contains(&key) || self.is_free(key));
        changed.any(|key| match key {
            KEEP => true,
            Key::Cell(_) | Key::Entry(..) => true,
            Key::Flag(flag) => self.is_retained(flag),
            Key::Bit(class, number) | Key::Word(class, number) => {
                let written = self.written.contains(&key);
                let stays = is_special(class, number) && !is_of_scan(key);
                written && (stays || self.world.fresh && self.module.is_latched(class, number))
            }
            Key::Timer(number, _) => self.is_latched_anew(DeviceClass::T, number),
            Key::Counter(number, _) => self.is_latched_anew(DeviceClass::C, number),
            _ => false,
        })
    }

    /// Returns true if a latched device is supposed to begin with 0.
    fn is_latched_anew(&self, class: DeviceClass, number: u32) -> bool {
        self.world.fresh && self.module.is_latched(class, number)
    }

    fn is_retained(&self, flag: u32) -> bool {
        let flag = self.module.flags.get(FlagId(flag));
        flag.is_some_and(|flag| flag.retained)
    }

    /// Begins the scan after STOP, if the PLC was in it. Memory that something else sets is as that sets it.
    pub(super) fn begin_restart(&mut self, open: &BTreeSet<Key>) {
        let restart = self.inputs_named(1, |_| Input::Restart)[0];
        self.restart = Some(restart);
        self.first_replay_assumptions.push(!restart);
        let keeps = self.before.get(&KEEP).map_or(Lit::FALSE, |bits| bits[0]);
        let clears = self.aig.and(restart, !keeps);
        for key in self.cleared(false) {
            if !open.contains(&key) {
                self.become_at(clears, key, 0);
            }
        }
        let keys: Vec<Key> = self.state.keys().copied().collect();
        for key in keys {
            match key {
                Key::Edge(_)
                | Key::Timer(_, TimerPart::Coil | TimerPart::Counted)
                | Key::Counter(_, CounterPart::Coil) => self.become_at(restart, key, 0),
                Key::Flag(flag) if !self.is_retained(flag) => self.become_at(restart, key, 0),
                Key::Slot(slot) if slot <= self.module.run_states => {
                    self.become_at(restart, key, 0);
                }
                Key::First | Key::Running => self.become_at(restart, key, 1),
                _ => {}
            }
        }
        let mut changed = self.begin_writes();
        changed.extend([Key::Now, Key::Minute]);
        let answer = Signature::Answer(AFTER_STOP.to_string());
        let other = self.applied(1, AFTER_STOP, answer, &[])[0];
        self.replay_assumptions.push(!other);
        let other = self.aig.and(restart, other);
        for key in changed.difference(open) {
            if let Some(bits) = self.state.get(key).cloned() {
                let signature = Signature::Call(AFTER_STOP.to_string(), *key);
                let fresh = self.applied(bits.len(), AFTER_STOP, signature, &[]);
                let value = self.aig.select(other, &fresh, &bits);
                self.state.insert(*key, value);
            }
        }
    }

    /// Gives memory a value before the scan under a condition.
    fn become_at(&mut self, when: Lit, key: Key, value: i64) {
        if let Some(bits) = self.state.get(&key) {
            let value: Bits = constant(value, bits.len());
            let bits = self.aig.select(when, &value, &bits.clone());
            self.state.insert(key, bits);
        }
    }

    /// Memory that the PLC writes in STOP, too, before scans.
    fn begin_writes(&self) -> BTreeSet<Key> {
        let mut keys = BTreeSet::new();
        let mut open = vec![0];
        let mut seen = BTreeSet::new();
        while let Some(number) = open.pop() {
            let Some(function) = self
                .module
                .functions
                .get(number)
                .filter(|_| seen.insert(number))
            else {
                continue;
            };
            open.extend(callees(&function.body));
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(action) = stmt {
                    keys.extend(self.of_operands(action));
                    keys.extend(self.private_writes(action));
                }
            });
        }
        keys.retain(|&key| {
            !is_of_scan(key) && !matches!(device_of(key), Some((DeviceClass::X, _)))
        });
        keys
    }

    /// Memory without a device, or not named by operands, that an action writes.
    fn private_writes(&self, action: &Action) -> Vec<Key> {
        match *action {
            Action::SetFlag(flag, _) => vec![Key::Flag(flag.0)],
            Action::SetCell(cell, _) => vec![Key::Cell(cell.0)],
            Action::SetEntry(SetEntry { table, .. }) => {
                let length = self.module.tables[table].length;
                (0..length).map(|i| Key::Entry(table.0, i)).collect()
            }
            Action::Edge(ref edge) => vec![Key::Edge(edge.memory.0)],
            Action::Call(ref call) => self.of_call(call),
            Action::Fetch(_) | Action::Send(_) | Action::Fault { .. } => self.of_errors(),
            Action::Clear { latched } => self.cleared(latched),
            _ => Vec::new(),
        }
    }
}
