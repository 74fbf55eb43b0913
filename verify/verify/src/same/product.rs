//! Two programs as one system.

use crate::aig::Lit;
use crate::bits::Bits;
use crate::effort::Limit;
use crate::model::{Encoder, Gap, HostCall, Key, Names, Shared, World, Writer, device_of};
use crate::proof::Formula;
use crate::property::{self, OUTPUTS_OFF};
use crate::sat::{Answer, Solver};
use crate::system::System;
use rungc_ir::Module;
use rungc_ir::node::FlagId;
use rungc_models::runs::is_special;
use rungc_sim::property::Condition;
use rungc_syntax::DeviceClass;
use rustc_hash::FxHashSet;
use std::collections::{BTreeMap, BTreeSet};

/// Two programs that are executed at the same time with the same inputs.
///
/// Memory that is not [`apart`](Self::apart) has the same value in both before every scan: it had it at first, and from
/// equal memory a scan makes equal memory, and so does each function between two scans, which was shown of all of it
/// together.
pub(super) struct Product<'m> {
    old: Encoder<'m>,
    new: Encoder<'m>,
    /// Memory of the old program that may differ.
    apart: BTreeSet<Key>,
    /// Memory set from outside the programs, by the old program's names.
    free: BTreeSet<Key>,
    /// The part of it that one of the programs writes between two scans, and nothing else.
    shown: BTreeSet<Key>,
    /// Free bits for the pulses of outputs in the old and the new program, which are not known to send the same.
    pulses: BTreeMap<u32, [Lit; 2]>,
    /// What is not modelled in either and supposed to be the same function in both.
    pub functions: BTreeSet<Gap>,
}

/// Value of a memory after a function between two scans: as before if the program lacks the function.
fn made_of<'e>(encoder: &'e Encoder, function: Option<&'e HostCall>, key: Key) -> Option<&'e Bits> {
    let made = function.and_then(|function| function.made.as_ref()?.get(&key));
    made.or_else(|| encoder.before(key))
}

impl<'m> Product<'m> {
    /// Executes both, and finds out what stays equal.
    pub fn new(
        modules: [&'m Module; 2],
        names: &Names,
        world: &World,
        assumed: &[Condition],
        limit: &Limit,
    ) -> Self {
        let [old_module, new_module] = modules;
        let (world, named) = common_world(modules, world);
        let mut old = Encoder::scan_sharing(old_module, world.clone(), Shared::default());
        suppose(&mut old, assumed);
        let mut apart = BTreeSet::new();
        loop {
            let shared = old.share(|key| !apart.contains(&key), names);
            let mut new = Encoder::scan_sharing(new_module, world.clone(), shared);
            suppose(&mut new, assumed);
            let mut free: BTreeSet<Key> = named[0]
                .iter()
                .copied()
                .filter(|&key| old.is_free(key))
                .collect();
            let of_new = named[1].iter().copied().filter(|&key| new.is_free(key));
            free.extend(of_new.map(|key| names.name(key)));
            let is_shown = |of: &Encoder, key: &Key| of.shown_by_plc(*key).is_some();
            let mut shown: BTreeSet<Key> = named[0].clone();
            shown.retain(|key| is_shown(&old, key));
            let of_new = named[1].iter().filter(|key| is_shown(&new, key));
            shown.extend(of_new.map(|key| names.name(*key)));
            let mut product = Product {
                old: old.clone(),
                new,
                apart: apart.clone(),
                free,
                shown,
                pulses: BTreeMap::new(),
                functions: BTreeSet::new(),
            };
            let differing = product.differing(names, limit);
            if differing.is_empty() {
                product.functions = product.new.gaps.iter().cloned().collect();
                product.find_pulses();
                return product;
            }
            apart.extend(differing);
        }
    }

    /// Finds the outputs that may send other pulses.
    fn find_pulses(&mut self) {
        if self.same_environment() {
            return;
        }
        let modules = [self.old.module(), self.new.module()];
        let numbers = modules.into_iter().flat_map(|module| &module.pulse_outputs);
        for &number in BTreeSet::from_iter(numbers) {
            let what = format!("pulses at {}", DeviceClass::Y.number(number));
            if let [old, new] = self.new.fresh(2, &what)[..] {
                self.pulses.insert(number, [old, new]);
            }
        }
    }

    /// Memory that begins a scan equal, and may not end it so or not stay so until the next one.
    fn differing(&self, names: &Names, limit: &Limit) -> Vec<Key> {
        let mut solver = None;
        let mut differing = self.environment_apart(names);
        let mut aig = self.new.aig.clone();
        for (name, old, new) in self.pairs(names) {
            if old == new {
                continue;
            }
            let same = old.len() == new.len() && {
                let equal = aig.equal(old, new);
                let solver = solver.get_or_insert_with(|| {
                    let mut solver = Solver::new(limit);
                    for &holds in self.old.constraints().iter().chain(self.new.constraints()) {
                        let holds = solver.lit(&aig, holds);
                        solver.clause(&[holds]);
                    }
                    solver
                });
                let differs = solver.lit(&aig, !equal);
                solver.solve(&[differs]) == Answer::Unsat
            };
            if !same {
                differing.push(name);
            }
        }
        // Equal logic may begin differently.
        let shared = self.new.memory().map(|(key, ..)| (key, names.name(key)));
        let begins = shared.filter(|(key, name)| {
            self.old.after(*name).is_some()
                && self.is_checked(*name)
                && self.old.initial(*name) != self.new.initial(*key)
        });
        differing.extend(begins.map(|(_, name)| name));
        differing
    }

    /// Memory of both programs that is checked to be equal, by its name in the old one, with what each makes of it: in
    /// a scan, and in each function between two scans.
    fn pairs(&self, names: &Names) -> Vec<(Key, &Bits, &Bits)> {
        let mut pairs = Vec::new();
        let new_keys = self.new.memory().map(|(key, ..)| (names.name(key), key));
        let new_keys: BTreeMap<Key, Key> = new_keys.collect();
        for (&name, &key) in &new_keys {
            if let Some((old, new)) = self.old.after(name).zip(self.new.after(key))
                && self.is_checked(name)
            {
                pairs.push((name, old, new));
            }
        }
        let [of_old, of_new] = [&self.old, &self.new].map(|encoder| encoder.between());
        let kinds = of_old.iter().chain(of_new).map(|one| &one.kind);
        for (n, kind) in kinds.enumerate() {
            let [old, new] = [of_old, of_new].map(|all| all.iter().find(|one| one.kind == *kind));
            // Functions of both are in both lists.
            if n >= of_old.len() && old.is_some() {
                continue;
            }
            for (&name, &key) in new_keys.iter().filter(|(name, _)| self.is_checked(**name)) {
                let old = made_of(&self.old, old, name);
                let new = made_of(&self.new, new, key);
                pairs.extend(old.zip(new).map(|(old, new)| (name, old, new)));
            }
        }
        pairs
    }

    /// Memory that something between two scans writes which is not known to be the same in both: pulse outputs, if
    /// programs use them differently, periods of time, and functions that are not modelled.
    fn environment_apart(&self, names: &Names) -> Vec<Key> {
        let [old_module, new_module] = [self.old.module(), self.new.module()];
        let in_old = |key: &Key| self.old.after(*key).is_some() && self.is_checked(*key);
        let mut between = [&self.old, &self.new]
            .into_iter()
            .flat_map(|of| of.between());
        let of_new = self.new.written_between_scans();
        let written = of_new.map(|key| names.name(key));
        let written = written.chain(self.old.written_between_scans());
        if between.any(|one| one.made.is_none()) {
            return written.filter(in_old).collect();
        }
        let same_pulses = self.is_equal(Key::Outer);
        let by_pulses = |key: &Key| {
            let mut of = [&self.old, &self.new].into_iter();
            of.any(|of| of.shown_by_plc(*key) == Some(Writer::Pulses))
        };
        let mut apart: Vec<Key> = match same_pulses {
            true => Vec::new(),
            false => written.filter(by_pulses).filter(in_old).collect(),
        };
        for (flag, at) in new_module.flags.iter().zip(0..) {
            let name = names.name(Key::Flag(at));
            let Key::Flag(other) = name else { continue };
            let Some(other) = old_module.flags.get(FlagId(other)) else {
                continue;
            };
            let same = flag.period_ms == other.period_ms
                && flag.pulses_end == other.pulses_end
                && (flag.pulses_end.is_none() || same_pulses);
            if !same && in_old(&name) {
                apart.push(name);
            }
        }
        apart
    }

    /// Formula of the induction over all memory: a scan that begins with equal values ends with a difference, or what
    /// runs between two scans makes one of them.
    pub fn apart(&self, names: &Names) -> Formula {
        let mut aig = self.new.aig.clone();
        let mut all = [self.old.constraints(), self.new.constraints()].concat();
        let mut differs = Vec::new();
        for (_, old, new) in self.pairs(names) {
            differs.push(!aig.equal(old, new));
        }
        all.push(aig.any(differs));
        Formula { aig, all }
    }

    /// Returns true if a memory, by its name in the old program, is checked to be equal: also one that has any value
    /// before a scan, if what runs between scans writes it.
    fn is_checked(&self, name: Key) -> bool {
        self.is_shared(name) || self.shown.contains(&name) && !self.apart.contains(&name)
    }

    /// Returns true if a memory, by its name in the old program, is checked to be equal and follows from that before.
    fn is_shared(&self, name: Key) -> bool {
        !self.apart.contains(&name) && !self.free.contains(&name)
    }

    /// Returns true if a memory of both, by its name in the old program, is proved to be equal after every scan.
    pub(crate) fn is_equal(&self, name: Key) -> bool {
        let after = |encoder: &Encoder| encoder.after(name).cloned();
        self.is_shared(name) && after(&self.old).is_some() && after(&self.new).is_some()
    }

    /// Returns true if an output is proved to be equal at its terminal, where pulses show and which M8034 switches off.
    pub(crate) fn is_equal_output(&self, name: Key) -> bool {
        if matches!(name, Key::Bit(_, number) if self.pulses.contains_key(&number)) {
            return false;
        }
        let has_off = self.old.after(OUTPUTS_OFF).is_some();
        self.is_equal(name) && (!has_off || self.is_equal(OUTPUTS_OFF))
    }

    /// The programs' outputs.
    pub fn outputs(&self) -> Vec<u32> {
        let keys = self.old.memory().map(|(key, ..)| key);
        keys.filter_map(|key| match key {
            Key::Bit(DeviceClass::Y, number) => Some(number),
            _ => None,
        })
        .collect()
    }

    /// Returns true if both query and change their environment in the same way: modules, ports, pulse outputs.
    pub fn same_environment(&self) -> bool {
        self.is_equal(Key::Outer)
    }

    /// Devices of both programs that only one of them latches.
    pub fn latched_apart(&self) -> Vec<(DeviceClass, u32)> {
        let [old, new] = [&self.old, &self.new].map(Encoder::module);
        let keys = self.old.memory().map(|(key, ..)| key);
        let devices = keys.filter(|key| self.new.before(*key).is_some());
        let devices = devices.filter_map(device_of);
        let apart = devices.filter(|&(class, number)| {
            old.is_latched(class, number) != new.is_latched(class, number)
        });
        BTreeSet::from_iter(apart).into_iter().collect()
    }

    /// The newer of the encoders, which knows the gaps of both.
    pub fn encoder(&self) -> &Encoder<'m> {
        &self.new
    }

    /// The system with the question whether a memory of both can differ while both are in RUN, or one of them stop.
    pub fn system(&self, key: Key, names: &Names) -> System {
        let (system, questions) = self.whole(&[key], names);
        questions
            .first()
            .map_or(system.clone(), |&bad| system.about(bad))
    }

    /// All of both programs, and that question of each of some memories.
    pub fn whole(&self, keys: &[Key], names: &Names) -> (System, Vec<Lit>) {
        let mut aig = self.new.aig.clone();
        let stops = aig.xor(self.old.running(), self.new.running());
        let run = aig.and(self.old.running(), self.new.running());
        let questions = keys.iter().map(|&key| {
            let both = [(&self.old, 0), (&self.new, 1)];
            let [old, new] = both.map(|(encoder, side)| {
                let after = |key| encoder.after(key).cloned().unwrap_or_default();
                let value = after(key);
                let Key::Bit(DeviceClass::Y, number) = key else {
                    return value;
                };
                let pulse = self
                    .pulses
                    .get(&number)
                    .map_or(Lit::FALSE, |both| both[side]);
                let off = after(OUTPUTS_OFF).first().copied().unwrap_or(Lit::FALSE);
                let terminal = value.iter().map(|&image| {
                    let on = aig.or(image, pulse);
                    aig.and(on, !off)
                });
                terminal.collect()
            });
            let equal = aig.equal(&old, &new);
            let differs = aig.and(run, !equal);
            aig.or(differs, stops)
        });
        let questions = questions.collect();
        let mut system = System {
            aig,
            latches: Vec::new(),
            inputs: Vec::new(),
            constraints: Vec::new(),
            replay_assumptions: Vec::new(),
            first_replay_assumptions: Vec::new(),
            lags: Vec::new(),
            bad: Lit::FALSE,
        };
        let in_old = |name: Key| self.old.after(name).is_some();
        self.old
            .add_to(&mut system, &|_| true, &|key| self.free.contains(&key));
        let own = |key: Key| !in_old(names.name(key)) || self.apart.contains(&names.name(key));
        self.new.add_to(&mut system, &own, &|key| {
            self.free.contains(&names.name(key))
        });
        self.begin_equal(&mut system, names);
        let mut seen = FxHashSet::default();
        system.inputs.retain(|(lit, _)| seen.insert(*lit));
        for conditions in [
            &mut system.constraints,
            &mut system.replay_assumptions,
            &mut system.first_replay_assumptions,
        ] {
            let mut seen = FxHashSet::default();
            conditions.retain(|lit| seen.insert(*lit));
        }
        (system, questions)
    }

    /// Makes memory with arbitrary initial values begin equal in both.
    fn begin_equal(&self, system: &mut System, names: &Names) {
        let Some(first) = self.old.before(Key::First).map(|bits| bits[0]) else {
            return;
        };
        let pairs = self.new.memory().filter_map(|(key, now, _)| {
            let name = names.name(key);
            let any = self.new.initial(key).is_none() && self.old.initial(name).is_none();
            let other = self
                .old
                .before(name)
                .filter(|_| any && self.apart.contains(&name))?;
            Some((other.clone(), now.clone()))
        });
        for (old, new) in pairs.collect::<Vec<(Bits, Bits)>>() {
            let equal = system.aig.equal(&old, &new);
            let holds: Lit = system.aig.or(!first, equal);
            system.constraints.push(holds);
        }
    }
}

fn suppose(encoder: &mut Encoder, assumed: &[Condition]) {
    for condition in assumed {
        let holds = property::condition(condition, encoder);
        encoder.suppose(holds);
    }
}

/// The world of both programs, in which each has the special devices and outputs of the other, and what each names.
fn common_world(modules: [&Module; 2], world: &World) -> (World, [BTreeSet<Key>; 2]) {
    let named = modules.map(|module| {
        let encoder = Encoder::scan_sharing(module, world.clone(), Shared::default());
        encoder
            .memory()
            .map(|(key, ..)| key)
            .collect::<BTreeSet<_>>()
    });
    let mut world = world.clone();
    let devices = named.iter().flatten().filter_map(|&key| device_of(key));
    let common =
        devices.filter(|&(class, number)| class == DeviceClass::Y || is_special(class, number));
    world.observed.extend(common);
    (world, named)
}
