//! Known values of index registers, and of the words they are made from, at a point of the program.

use super::interval::Interval;
use crate::node::{AccessKind, Action, Expr, ExprId, Module, Place, Stmt, TempId};
use crate::walk::{operands, statements};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_syntax::DeviceClass;
use rustc_hash::{FxHashMap, FxHashSet};

/// A set of tracked words.
pub(super) type Mask = u128;

/// Maximum number of words that are tracked.
const MOST_WORDS: usize = Mask::BITS as usize;
/// Maximum number of temporaries that are remembered at a time.
const MOST_TEMPS: usize = 32;
/// Maximum number of rounds that look for the words from which those found are made.
const MOST_ROUNDS: usize = 6;

/// The words that are tracked: index registers that no host writes, and the registers that they get their values from.
pub(super) struct Words {
    model: &'static Model,
    slots: FxHashMap<(DeviceClass, u32), usize>,
    /// Words that a host may write between two scans.
    pub(super) shared: Mask,
}

fn is_index(class: DeviceClass) -> bool {
    matches!(class, DeviceClass::V | DeviceClass::Z)
}

impl Words {
    /// The words of a module that are worth it. `observed` index registers are not, since a host may write them.
    pub(super) fn of(module: &Module, observed: impl Fn(DeviceClass, u32) -> bool) -> Self {
        let mut words = Words {
            model: module.model,
            slots: FxHashMap::default(),
            shared: 0,
        };
        for class in [DeviceClass::V, DeviceClass::Z] {
            for (first, last) in module.model.runs(class) {
                for number in (first..=last).filter(|&number| !observed(class, number)) {
                    words.slots.insert((class, number), words.slots.len());
                }
            }
        }
        words.add_sources(module);
        words
    }

    /// The registers that tracked words and temporaries get their values from.
    fn add_sources(&mut self, module: &Module) {
        let mut temps = FxHashSet::default();
        for _ in 0..MOST_ROUNDS {
            let before = (self.slots.len(), temps.len());
            for function in &module.functions {
                statements(&function.body, &mut |stmt| {
                    if let Stmt::Do(Action::Write(access, value)) = *stmt
                        && matches!(access.kind, AccessKind::Word | AccessKind::Pair)
                        && self.slot(access.place).is_some()
                    {
                        self.add_read(module, value, &mut temps);
                    } else if let Stmt::Do(Action::Let(temp, value)) = *stmt
                        && temps.contains(&temp)
                    {
                        self.add_read(module, value, &mut temps);
                    }
                });
            }
            if before == (self.slots.len(), temps.len()) {
                return;
            }
        }
    }

    fn add_read(&mut self, module: &Module, value: ExprId, temps: &mut FxHashSet<TempId>) {
        if let Expr::Read(access) = *module.expr(value)
            && matches!(access.kind, AccessKind::Word | AccessKind::Pair)
        {
            self.add_register(access.place);
        } else if let Expr::Temp(temp) = *module.expr(value) {
            temps.insert(temp);
        }
        for operand in operands(module.expr(value)) {
            self.add_read(module, operand, temps);
        }
    }

    fn add_register(&mut self, place: Place) {
        let ordinary = matches!(place.class, DeviceClass::D | DeviceClass::R)
            && !is_special(place.class, place.number);
        let next = self.slots.len();
        if ordinary && place.index.is_none() && next < MOST_WORDS {
            let slot = *self
                .slots
                .entry((place.class, place.number))
                .or_insert(next);
            self.shared |= 1 << slot;
        }
    }

    /// Number of words.
    pub(super) fn len(&self) -> usize {
        self.slots.len()
    }

    /// Index of the tracked word that a place names, if it names one.
    pub(super) fn slot(&self, place: Place) -> Option<usize> {
        match place.index {
            None => self.slot_of(place.class, place.number),
            Some(_) => None,
        }
    }

    /// Index of the tracked word that a device is.
    pub(super) fn slot_of(&self, class: DeviceClass, number: u32) -> Option<usize> {
        let may = matches!(class, DeviceClass::D | DeviceClass::R) || is_index(class);
        if !may {
            return None;
        }
        self.slots
            .get(&self.model.canonical(class, number))
            .copied()
    }

    /// The high word of the pair at a place.
    pub(super) fn high_word(&self, place: Place) -> Place {
        place.high_word(self.model)
    }

    /// The tracked words among the devices `first` to `last` of a class.
    pub(super) fn within(&self, class: DeviceClass, first: u32, last: u32) -> Mask {
        let mut mask = 0;
        for (&(of, number), slot) in &self.slots {
            if of == class && (first..=last).contains(&number) {
                mask |= 1 << slot;
            }
        }
        for alias in self.model.aliases_within(class, first, last) {
            if let Some(slot) = self.slots.get(&(alias.class, alias.index)) {
                mask |= 1 << slot;
            }
        }
        mask
    }
}

/// Knowledge of a temporary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Known {
    /// Bounds of its value.
    Value(Interval),
    /// Condition that it holds, and the tracked words and (some bits for) the temporaries that this depends on.
    Condition(ExprId, Mask, u64),
}

/// Knowledge at a point.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct State {
    pub(super) words: Vec<Interval>,
    temps: Vec<(TempId, Known)>,
}

/// A bit for a temporary, which it may share with others.
pub(super) fn temp_bit(temp: TempId) -> u64 {
    1 << (temp.0 % 64)
}

impl State {
    /// All tracked words are 0, as at power-on.
    pub(super) fn power_on(words: &Words) -> Self {
        State {
            words: vec![Interval::of(0); words.len()],
            temps: Vec::new(),
        }
    }

    /// Without what is known of temporaries.
    pub(super) fn words_only(&self) -> Self {
        State {
            words: self.words.clone(),
            temps: Vec::new(),
        }
    }

    pub(super) fn temp(&self, temp: TempId) -> Option<Known> {
        let known = self.temps.iter().find(|known| known.0 == temp);
        known.map(|known| known.1)
    }

    /// A temporary has another value now, of which this is known.
    pub(super) fn set_temp(&mut self, temp: TempId, known: Option<Known>) {
        let bit = temp_bit(temp);
        self.temps.retain(|&(other, known)| {
            let depends = matches!(known, Known::Condition(_, _, temps) if temps & bit != 0);
            other != temp && !depends
        });
        if let Some(known) = known {
            if self.temps.len() == MOST_TEMPS {
                self.temps.remove(0);
            }
            self.temps.push((temp, known));
        }
    }

    /// Limits what is known of a temporary's value.
    pub(super) fn limit_temp(&mut self, temp: TempId, limit: Interval) {
        match self.temps.iter_mut().find(|known| known.0 == temp) {
            Some((_, known)) => *known = Known::Value(limit),
            None => self.set_temp(temp, Some(Known::Value(limit))),
        }
    }

    /// A word is written.
    pub(super) fn set(&mut self, slot: usize, value: Interval) {
        self.words[slot] = value;
        self.forget(1 << slot);
    }

    /// Conditions over these words may be others now.
    fn forget(&mut self, written: Mask) {
        self.temps.retain(
            |(_, known)| !matches!(known, Known::Condition(_, words, _) if words & written != 0),
        );
    }

    /// Words may have changed to these values, which may be what they were.
    pub(super) fn may_become(&mut self, mask: Mask, value: Interval) {
        for (slot, word) in self.words.iter_mut().enumerate() {
            if mask >> slot & 1 == 1 {
                *word = word.join(value);
            }
        }
        self.forget(mask);
    }

    /// Words are those of another state now.
    pub(super) fn take(&mut self, mask: Mask, other: &State) {
        for (slot, word) in self.words.iter_mut().enumerate() {
            if mask >> slot & 1 == 1 {
                *word = other.words[slot];
            }
        }
        self.forget(mask);
    }

    /// Merges the knowledge of either state.
    pub(super) fn join(&mut self, other: &State) {
        for (word, others) in self.words.iter_mut().zip(&other.words) {
            *word = word.join(*others);
        }
        self.temps
            .retain_mut(|(temp, known)| match other.temp(*temp) {
                Some(others) if others == *known => true,
                Some(Known::Value(value)) => match known {
                    Known::Value(own) => {
                        *own = own.join(value);
                        true
                    }
                    Known::Condition(..) => false,
                },
                _ => false,
            });
    }

    /// Moves ends that are further out than those of `before` on to the next threshold, or to the end of all words if
    /// there is none, so that a state grows a few times at most. Temporaries that change are forgotten.
    pub(super) fn widen(&mut self, before: &State, thresholds: &[i32]) {
        self.temps
            .retain(|&(temp, known)| before.temp(temp) == Some(known));
        for (word, old) in self.words.iter_mut().zip(&before.words) {
            if word.low < old.low {
                let below = thresholds.partition_point(|&t| t <= word.low);
                let next = below.checked_sub(1).map(|i| thresholds[i]);
                word.low = next.unwrap_or(Interval::WORD.low);
            }
            if word.high > old.high {
                let next = thresholds.get(thresholds.partition_point(|&t| t < word.high));
                word.high = next.copied().unwrap_or(Interval::WORD.high);
            }
        }
    }
}

/// Merges two possible states.
pub(super) fn join(one: Option<State>, other: Option<State>) -> Option<State> {
    match (one, other) {
        (Some(mut one), Some(other)) => {
            one.join(&other);
            Some(one)
        }
        (one, other) => one.or(other),
    }
}
