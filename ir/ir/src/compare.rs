//! Comparison of two modules: the devices that can have different values, given the same inputs at the same times.
//!
//! Each module becomes a sequence of atoms: its statements, with the conditions and loops around them as separate
//! values. An atom is a text, what it reads and what it writes. Private memory has names made of what is stored in
//! it, not of its number, so that the same statement has the same text in both modules. The sequences are aligned,
//! and atoms that moved are found. What an atom writes that only one module has can differ, and so can what moved
//! atoms read or write in another order, and what an atom writes that reads such a thing; everything else is
//! computed by the same statements from the same values: what writes a value that is read is the same in both
//! modules, and comes last before it in both. The answer is on the safe side: what it calls the same is the same,
//! what it calls different may be the same nevertheless.
//!
//! Left out are the watchdog, how long a scan takes, and the steps that errors name where the program does not read
//! them.

mod atoms;
mod order;

use crate::node::Module;
use atoms::{Atom, ERRORS, Names, Sequence, Uses};
use rungc_rt::special::{D_FIRST_ERROR_STEP, M_OUTPUTS_OFF};
use rungc_syntax::{DeviceClass, DeviceRun};
use rustc_hash::{FxHashMap, FxHashSet};

/// Result of comparing the behaviour of two modules.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Behaviour {
    /// All devices have the same values.
    Same,
    /// Something can differ.
    CanDiffer {
        /// Devices that can have different values, in order; all others have the same.
        devices: Vec<DeviceRun>,
        /// True if modules, pulse outputs or serial ports can be used differently, too.
        hardware: bool,
        /// Steps of instructions that are assumed to use all special devices, as nothing says which ones they use, and
        /// that read what can differ or are not the same. Others read and write less, so that more devices may be the
        /// same. First those that only the old module has, then those of the new one, both in order.
        vague: [Vec<u32>; 2],
    },
    /// Not compared, as the end of "not decided: …".
    Undecided(&'static str),
}

impl Behaviour {
    /// The result in sentences. `proved` is one about outputs that something else proves to be the same.
    pub fn in_words(&self, proved: Option<String>) -> Vec<String> {
        let (devices, hardware) = match self {
            Behaviour::Same => {
                let same =
                    "Same behaviour: with the same inputs, all devices have the same values.";
                return vec![same.to_string()];
            }
            Behaviour::Undecided(why) => return vec![format!("Behaviour not decided: {why}.")],
            Behaviour::CanDiffer {
                devices, hardware, ..
            } => (devices, hardware),
        };
        let (outputs, others): (Vec<&DeviceRun>, Vec<_>) =
            devices.iter().partition(|run| run.class == DeviceClass::Y);
        let mut words = vec![match outputs.is_empty() {
            true => "No output can differ.".to_string(),
            false => format!("Outputs that can differ: {}.", list(&outputs)),
        }];
        if !others.is_empty() {
            words.push(format!("Other devices that can differ: {}.", list(&others)));
        }
        words.extend(proved);
        if *hardware {
            let what = "Modules, pulse outputs or serial ports can be used differently.";
            words.push(what.to_string());
        }
        words.push("All other devices have the same values, with the same inputs.".to_string());
        words
    }
}

/// Runs of devices by their names.
pub fn list(runs: &[&DeviceRun]) -> String {
    let names = runs.iter().map(|run| match run.count {
        1 => run.class.number(run.first).to_string(),
        _ => run.to_string(),
    });
    names.collect::<Vec<_>>().join(", ")
}

/// Compares what two modules do. Both are simplified ([`crate::passes::simplify`]), without loops over repeated rungs.
pub fn behaviour(old: &Module, new: &Module) -> Behaviour {
    if old.model.name != new.model.name {
        return Behaviour::Undecided("the programs are for different models");
    }
    if old.ports != new.ports || old.port_protocols != new.port_protocols {
        return Behaviour::Undecided("their serial ports are used differently");
    }
    let steps = [old, new].map(reads_steps).contains(&true);
    let mut names = Names::default();
    let sequences = Sequence::of_both([old, new], &mut names, steps);
    let mut taint = Taint::default();
    let pairs = order::pairs(&sequences);
    let kept = [0, 1].map(|side| {
        pairs
            .iter()
            .map(|pair| pair.at[side])
            .collect::<FxHashSet<_>>()
    });
    for (sequence, kept) in sequences.iter().zip(&kept) {
        for (at, atom) in sequence.atoms.iter().enumerate() {
            if !kept.contains(&at) {
                taint.write(atom);
            }
        }
    }
    let disorder = order::disorder(&sequences, &pairs);
    taint.names.extend(disorder.names);
    disorder.runs.into_iter().for_each(|run| taint.add(run));
    taint.initial(old, new);
    let ports = old.has_ports();
    loop {
        let before = taint.size();
        for atom in sequences.iter().flat_map(|sequence| &sequence.atoms) {
            if taint.reaches(atom) {
                taint.write(atom);
            }
        }
        // Earlier errors decide whether an error is the first one.
        if ERRORS.into_iter().any(|run| taint.meets(run)) {
            ERRORS.into_iter().for_each(|run| taint.add(run));
        }
        // Outputs are terminals, which M8034 switches off.
        if taint.meets((DeviceClass::M, OUTPUTS_OFF, OUTPUTS_OFF)) {
            taint.add((DeviceClass::Y, 0, u32::MAX));
        }
        // The set-up of a port, and so its writes, is in special devices.
        taint.all |= ports && taint.has_special();
        if taint.size() == before {
            break;
        }
    }
    let devices = taint.stored([old, new]);
    let hardware = taint.all || taint.names.contains(&names.hardware());
    match devices.is_empty() && !hardware {
        true => Behaviour::Same,
        false => Behaviour::CanDiffer {
            devices,
            hardware,
            vague: [0, 1].map(|side| {
                let atoms = sequences[side].atoms.iter().enumerate();
                let steps = atoms.filter(|(at, atom)| {
                    let alone = !kept[side].contains(at);
                    alone || side == 1 && taint.reaches(atom)
                });
                let mut steps: Vec<u32> = steps.filter_map(|(_, atom)| atom.vague).collect();
                steps.sort();
                steps.dedup();
                steps
            }),
        },
    }
}

/// Returns true if a program reads at which step an error occurred.
fn reads_steps(module: &Module) -> bool {
    let first = D_FIRST_ERROR_STEP.number();
    let stored = |number| module.layout.area(DeviceClass::D, number).is_some();
    stored(first) || stored(first + 1)
}

/// Relay that switches the output terminals off.
const OUTPUTS_OFF: u32 = M_OUTPUTS_OFF.number();

/// Numbers of devices are below this.
const NUMBERS: usize = 1 << 16;

/// Devices and names that can differ.
#[derive(Default)]
struct Taint {
    devices: FxHashMap<DeviceClass, Vec<bool>>,
    /// Number of devices in `devices`.
    count: usize,
    names: FxHashSet<u32>,
    /// Everything.
    all: bool,
}

impl Taint {
    fn size(&self) -> (usize, usize, bool) {
        (self.count, self.names.len(), self.all)
    }

    fn reaches(&self, atom: &Atom) -> bool {
        let Uses { runs, names, all } = &atom.reads;
        let any = self.count + self.names.len() > 0;
        self.all
            || *all && any
            || names.iter().any(|name| self.names.contains(name))
            || runs.iter().any(|run| self.meets(*run))
    }

    fn meets(&self, (class, first, last): (DeviceClass, u32, u32)) -> bool {
        let Some(devices) = self.devices.get(&class) else {
            return false;
        };
        let end = (last as usize + 1).min(NUMBERS);
        devices[(first as usize).min(end)..end].contains(&true)
    }

    fn write(&mut self, atom: &Atom) {
        let Uses { runs, names, all } = &atom.writes;
        self.all |= all;
        self.names.extend(names);
        runs.iter().for_each(|run| self.add(*run));
    }

    fn add(&mut self, (class, first, last): (DeviceClass, u32, u32)) {
        let devices = self
            .devices
            .entry(class)
            .or_insert_with(|| vec![false; NUMBERS]);
        let end = (last as usize + 1).min(NUMBERS);
        for device in &mut devices[(first as usize).min(end)..end] {
            self.count += usize::from(!std::mem::replace(device, true));
        }
    }

    /// Devices that begin with different values, or keep them differently.
    fn initial(&mut self, old: &Module, new: &Module) {
        for (one, other) in [(old, new), (new, old)] {
            for word in &one.initial_words {
                let stored = other.layout.area(DeviceClass::D, word.0.number()).is_some();
                if stored && !other.initial_words.contains(word) {
                    self.add((DeviceClass::D, word.0.number(), word.0.number()));
                }
            }
        }
        for module in [old, new] {
            for area in &module.layout.areas {
                for number in area.first..area.first + area.count {
                    if old.is_latched(area.class, number) != new.is_latched(area.class, number) {
                        self.add((area.class, number, number));
                    }
                }
            }
        }
    }

    fn has_special(&self) -> bool {
        use rungc_models::runs::FIRST_SPECIAL;
        let last = NUMBERS as u32 - 1;
        [DeviceClass::M, DeviceClass::D]
            .into_iter()
            .any(|class| self.meets((class, FIRST_SPECIAL, last)))
    }

    /// The devices that can differ, of those that one of the modules stores.
    fn stored(&self, modules: [&Module; 2]) -> Vec<DeviceRun> {
        let mut found: Vec<(DeviceClass, u32)> = Vec::new();
        for area in modules.iter().flat_map(|module| &module.layout.areas) {
            let numbers = area.first..area.first + area.count;
            let differ =
                numbers.filter(|number| self.all || self.meets((area.class, *number, *number)));
            found.extend(differ.map(|number| (area.class, number)));
        }
        found.retain(|(class, _)| *class != DeviceClass::X);
        found.sort();
        found.dedup();
        let mut runs: Vec<DeviceRun> = Vec::new();
        for (class, number) in found {
            match runs.last_mut() {
                Some(run) if run.class == class && run.first + run.count == number => {
                    run.count += 1
                }
                _ => runs.push(DeviceRun {
                    class,
                    first: number,
                    count: 1,
                }),
            }
        }
        runs
    }
}
