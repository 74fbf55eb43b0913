//! Two programs in one graph, which are executed at the same time in the same world.
//!
//! The second program's logic is made where the first one's is: equal logic is the same node. What both begin a scan
//! with is the same bits where it is supposed to be equal, and so are times and free devices. What is not modelled is
//! a function of all that it looks at, applied in both programs: if that is the same in both, bit by bit, the results
//! are. What a call of the runtime remembers, and the world that it asks, is a bit each that only such functions use.

use super::{Encoder, Gap, Input, Key};
use crate::aig::{Aig, Lit};
use crate::bits::Bits;
use rungc_ir::node::{Action, Arg, Call, Place, Stmt};
use rungc_ir::reach::beyond_operands;
use rungc_ir::walk::statements;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Operation that is not modelled and may be shared.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Signature {
    /// An operation on floats.
    Float(String),
    /// An event that sets a flag between two scans.
    Event(Key),
    /// A call of the runtime, or an access of buffer memory, and what of it.
    Call(String, Key),
    /// The same, of a value that no memory holds.
    Answer(String),
}

/// Inputs of an operation that is not modelled.
#[derive(Default)]
pub(super) struct Seen {
    /// Description of the operation.
    pub text: String,
    /// All bits that it may depend on.
    pub bits: Vec<Lit>,
    /// Its step, which errors store.
    step: u32,
}

impl Seen {
    /// Signature of the operation's effect on a piece of memory.
    pub fn of(&self, key: Key) -> Signature {
        let stores_step = matches!(
            key,
            Key::Word(DeviceClass::D, 8004..=8006 | 8065..=8069 | 8312..=8315)
        );
        Signature::Call(
            match stores_step {
                true => format!("{} at {}", self.text, self.step),
                false => self.text.clone(),
            },
            key,
        )
    }
}

/// Parts that a program shares with the one executed before it.
#[derive(Clone, Default)]
pub struct Shared {
    /// The graph of the other program.
    pub aig: Aig,
    /// Operations not modelled in it.
    pub gaps: Vec<Gap>,
    /// Names of the program's memory in the other one; `None` for the one executed first.
    names: Option<Names>,
    /// Bits of memory with which both begin a scan, by the names in the other program.
    begins: FxHashMap<Key, Bits>,
    /// Bits that are free in both.
    inputs: FxHashMap<Input, Lit>,
    /// Results of what is not modelled.
    results: FxHashMap<(Signature, Vec<Lit>), Bits>,
}

/// Bit of numbers without a counterpart.
const NOWHERE: u32 = 1 << 31;

/// Names of one program's memory in another. Devices have the same names in both.
#[derive(Clone, Default)]
pub struct Names(pub FxHashMap<Key, Key>);

impl Names {
    /// Name of a memory there. Numbers without a counterpart have other meanings there.
    pub fn name(&self, key: Key) -> Key {
        match (self.0.get(&key), key) {
            (Some(&other), _) => other,
            (None, Key::Edge(n)) => Key::Edge(n | NOWHERE),
            (None, Key::Flag(n)) => Key::Flag(n | NOWHERE),
            (None, Key::Cell(n)) => Key::Cell(n | NOWHERE),
            (None, Key::Entry(t, n)) => Key::Entry(t | NOWHERE, n),
            (None, Key::Slot(n)) => Key::Slot(n | 1 << 15),
            (None, key) => key,
        }
    }
}

impl Shared {
    /// The bits with which a memory of this program begins a scan, if the other program begins with them, too.
    pub(super) fn begins_as(&self, key: Key) -> Option<Bits> {
        self.begins.get(&self.name(key)).cloned()
    }

    fn name(&self, key: Key) -> Key {
        self.names.as_ref().map_or(key, |names| names.name(key))
    }
}

impl Encoder<'_> {
    /// Parts that another program shares with this one if it begins its scans with these memories as they are here, by
    /// their names here. This program's graph goes into it.
    pub fn share(&mut self, begins: impl Fn(Key) -> bool, names: &Names) -> Shared {
        let before = self.before.iter().filter(|(key, _)| begins(**key));
        let begins = before.map(|(&key, bits)| (key, bits.clone())).collect();
        let inputs = self.inputs.iter();
        let inputs = inputs.filter(|(_, input)| !matches!(input, Input::Gap(_)));
        Shared {
            begins,
            inputs: inputs.map(|&(lit, input)| (input, lit)).collect(),
            results: self
                .shared
                .as_ref()
                .map_or_else(FxHashMap::default, |shared| shared.results.clone()),
            aig: self.aig.clone(),
            gaps: self.gaps.clone(),
            names: Some(names.clone()),
        }
    }

    /// Free bits with names, which another program may have already.
    pub(super) fn inputs_named(&mut self, width: usize, named: impl Fn(usize) -> Input) -> Bits {
        let mut bits = Bits::new();
        for i in 0..width {
            let input = named(i);
            let known = self
                .shared
                .as_ref()
                .and_then(|shared| shared.inputs.get(&input).copied());
            let bit = known.unwrap_or_else(|| self.aig.input());
            self.inputs.push((bit, input));
            bits.push(bit);
        }
        bits
    }

    /// The memory that stands for what calls remember and ask, in programs that are compared.
    pub(super) fn tokens(&self) -> Vec<Key> {
        if !self.is_compared() {
            return Vec::new();
        }
        let mut slots = Vec::new();
        for function in &self.module.functions {
            statements(&function.body, &mut |stmt| {
                if let Stmt::Do(Action::Call(call)) = stmt
                    && call.slot > 0
                {
                    slots.push(Key::Slot(call.slot));
                }
            });
        }
        slots.push(Key::Outer);
        slots.sort();
        slots.dedup();
        slots
    }

    /// Returns true if the program is executed beside another.
    pub(super) fn is_compared(&self) -> bool {
        self.shared.is_some()
    }

    /// Name of a memory in the program beside which this one is executed.
    fn shared_name(&self, key: Key) -> Key {
        self.shared.as_ref().map_or(key, |shared| shared.name(key))
    }

    /// Name of a flag that an event sets in the program beside which this one is executed: of none of its flags if it
    /// may be another event.
    fn event_name(&self, key: Key) -> Key {
        let other = self.shared.as_ref().filter(|shared| shared.names.is_some());
        match (other, key) {
            (Some(shared), Key::Flag(n)) if shared.begins_as(key).is_none() => {
                Key::Flag(n | NOWHERE)
            }
            _ => self.shared_name(key),
        }
    }

    /// The result of something that is not modelled: free, but the same as in the other program if that applies it to
    /// the same.
    pub(super) fn applied(
        &mut self,
        width: usize,
        what: &str,
        signature: Signature,
        to: &[Lit],
    ) -> Bits {
        // Events belong to no network, even where one looks at what they do.
        let gap = match signature {
            Signature::Event(_) => self.gap_apart(what),
            _ => self.gap(what),
        };
        if !self.is_compared() {
            return self.fresh_of(width, gap);
        }
        let signature = match signature {
            Signature::Event(key) => Signature::Event(self.event_name(key)),
            Signature::Call(text, key) => Signature::Call(text, self.shared_name(key)),
            other => other,
        };
        let application = (signature, to.to_vec());
        let known = |shared: &Shared| shared.results.get(&application).cloned();
        if let Some(bits) = self.shared.as_ref().and_then(known) {
            // The input belongs to both programs, and is in the list of the first.
            return bits;
        }
        let bits = self.fresh_of(width, gap);
        if let Some(shared) = &mut self.shared {
            shared.results.insert(application, bits.clone());
        }
        bits
    }

    /// Everything that a call looks at: what it is, as a text, and bits.
    pub(super) fn looks(&mut self, action: &Action, anywhere: bool, step: u32) -> Seen {
        let mut text = String::new();
        let mut bits = Vec::new();
        let mut keys = self.at_operands(action);
        keys.extend(self.specials());
        if let Action::Call(call) = action {
            keys.extend(self.named_in(&beyond_operands(self.module, call)));
        }
        if anywhere {
            keys.extend(self.state.keys().copied());
        }
        match action {
            Action::Call(call) => {
                text.push_str(&format!(
                    "{:?} {} {} {}",
                    call.function, call.wide, call.signal, call.period_ms
                ));
                if let Some(drive) = call.drive {
                    bits.push(self.on(drive));
                }
                if call.slot > 0 {
                    keys.push(Key::Slot(call.slot));
                }
                for arg in &call.args {
                    self.look_at(arg, &mut text, &mut bits);
                }
            }
            Action::Fetch(fetch) => {
                text.push_str(&format!("fetch {}", fetch.wide));
                self.look_at(&fetch.from, &mut text, &mut bits);
            }
            Action::Send(send) => {
                text.push_str(&format!("send {}", send.wide));
                bits.extend(self.eval(send.value));
                self.look_at(&send.to, &mut text, &mut bits);
            }
            Action::Fault { code, .. } => text.push_str(&format!("error {code}")),
            _ => {}
        }
        keys.extend([Key::Outer, Key::Now, Key::Minute, Key::First]);
        for key in BTreeSet::from_iter(keys) {
            text.push_str(&format!(" {:?}", self.shared_name(key)));
            bits.extend(self.state.get(&key).into_iter().flatten());
        }
        bits.extend(self.elapsed());
        Seen { text, bits, step }
    }

    /// An operand with the value of its index; what texts say counts, not their numbers.
    fn look_at(&mut self, arg: &Arg, text: &mut String, bits: &mut Vec<Lit>) {
        let mut plain = *arg;
        let index = match &mut plain {
            Arg::Const { index, .. }
            | Arg::Buffer { index, .. }
            | Arg::Device {
                place: Place { index, .. },
                ..
            }
            | Arg::Nibbles {
                place: Place { index, .. },
                ..
            }
            | Arg::WordBit {
                place: Place { index, .. },
                ..
            } => index.take(),
            Arg::Float(_) => None,
            Arg::Text(number) => {
                let texts = &self.module.texts;
                text.push_str(texts.get(*number as usize).map_or("", String::as_str));
                *number = 0;
                None
            }
        };
        text.push_str(&format!(" {plain:?} {}", index.is_some()));
        if let Some(index) = index {
            bits.extend(self.eval(index));
        }
    }

    /// Sets the memory that represents the state and requests of a call.
    pub(super) fn leave_tokens(&mut self, call: Option<&Call>, seen: &Seen, guard: Lit) {
        if !self.is_compared() {
            return;
        }
        let slot = call
            .filter(|call| call.slot > 0)
            .map(|call| Key::Slot(call.slot));
        let asks = call.is_none_or(|call| {
            let needs = call.function.needs();
            let port = needs.port || needs.names_port || needs.any_port || needs.can;
            needs.hal || needs.pulses || needs.signals || needs.clears || needs.anywhere || port
        });
        for key in slot.into_iter().chain(asks.then_some(Key::Outer)) {
            let bits = self.applied(
                1,
                "what calls of the runtime remember",
                seen.of(key),
                &seen.bits,
            );
            self.store(key, &bits, guard);
        }
    }
}
