//! The PLC models: which devices each has, which of them are latched, what its timers and counters are.

mod fx1;
mod fx2n;
mod fx3;
mod hm;
mod inovance;
mod l01s;
mod set;

use crate::special;
use rungc_syntax::Classes;
pub use set::ModelSet;

use rungc_rt::{Ports, Pulses, TimerKind};
use rungc_syntax::DeviceClass;

/// A PLC model.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
#[repr(u8)]
pub enum ModelId {
    /// Inovance H1U.
    H1u,
    /// Inovance H2U.
    H2u,
    /// Coolmay L01S.
    L01s,
    /// Kewei HM motion controller.
    Hm,
    /// Mitsubishi FX1S.
    Fx1s,
    /// Mitsubishi FX1N/FX1NC.
    Fx1n,
    /// Mitsubishi FX2N/FX2NC.
    Fx2n,
    /// Boards of other makers that take programs for FX2N.
    Fx2nCompatible,
    /// Mitsubishi FX3S.
    Fx3s,
    /// Mitsubishi FX3G/FX3GC/FX3GE.
    Fx3g,
    /// Mitsubishi FX3U/FX3UC.
    Fx3u,
    /// Boards of other makers that take programs for FX3U.
    Fx3uCompatible,
}

/// How well a model fits a CPU type.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fit {
    /// It is this model, or one that a program cannot tell from it.
    Same,
    /// None of the models is this CPU type, and this one resembles it most; the text says what is different there.
    Nearest(&'static str),
}

impl ModelId {
    /// All models, in the order of the enum.
    pub const ALL: [ModelId; 12] = {
        use ModelId::*;
        [
            H1u,
            H2u,
            L01s,
            Hm,
            Fx1s,
            Fx1n,
            Fx2n,
            Fx2nCompatible,
            Fx3s,
            Fx3g,
            Fx3u,
            Fx3uCompatible,
        ]
    };

    /// The model with this name on the command line, e.g. `h2u`, or with this CPU type, e.g. `fx3uc`. Case does not matter.
    pub fn from_name(name: &str) -> Option<Self> {
        let is = |known: &str| known.eq_ignore_ascii_case(name);
        Self::ALL.into_iter().find(|&id| {
            let model = Model::get(id);
            is(model.name) || model.cpus.iter().any(|cpu| is(cpu))
        })
    }

    /// The model that a project's CPU type means, e.g. `FX3U/FX3UC`, and how well it fits. Projects for the makers' own models are
    /// made for the Mitsubishi model they descend from.
    pub fn for_cpu(cpu: &str) -> Option<(Self, Fit)> {
        let names = || cpu.split('/').map(str::trim);
        let nearest = |name: &str| {
            Self::ALL.into_iter().find_map(|id| {
                let mut like = Model::get(id).nearest.iter();
                let (_, different) = like.find(|(known, _)| known.eq_ignore_ascii_case(name))?;
                Some((id, Fit::Nearest(different)))
            })
        };
        let same = names().find_map(Self::from_name).map(|id| (id, Fit::Same));
        same.or_else(|| names().find_map(nearest))
    }

    /// The names of all models: `h1u, h2u, …`.
    pub fn names() -> String {
        Self::ALL.map(|id| Model::get(id).name).join(", ")
    }

    /// The model of [`ModelId::for_cpu`].
    pub fn from_cpu(cpu: &str) -> Option<Self> {
        Self::for_cpu(cpu).map(|(id, _)| id)
    }
}

/// A run of devices of one class.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// The class.
    pub class: DeviceClass,
    /// First number (a value: X010 is 8).
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Whether it keeps its value over RUN/STOP and power-off.
    pub latched: bool,
}

/// A run of timers of one kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Timers {
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// How they behave.
    pub kind: TimerKind,
}

/// Timers that count shorter units while a relay is on.
#[derive(Clone, Debug)]
pub struct FastTimers {
    /// The special relay.
    pub relay: u32,
    /// Their numbers.
    pub numbers: std::ops::RangeInclusive<u32>,
    /// Their unit while it is on, in milliseconds.
    pub unit_ms: u16,
}

/// All that is known of a model.
#[derive(Debug)]
pub struct Model {
    /// Which.
    pub id: ModelId,
    /// Name on the command line: `h2u`.
    pub name: &'static str,
    /// Boards of other makers that take its programs; they take some values that it does not.
    pub boards: Option<ModelId>,
    /// Name for people: `Inovance H2U`.
    pub title: &'static str,
    /// CPU types of projects that are for it, in upper case: `FX3U`, `FX3UC`. A program cannot tell one from the other.
    pub cpus: &'static [&'static str],
    /// CPU types that are not among the models, in upper case, and resemble this one most ([`Fit::Nearest`]), each with what is different
    /// there.
    pub nearest: &'static [(&'static str, &'static str)],
    /// Its devices: general and special ranges of every class, P, I and N included. Sorted by class and first number, disjoint.
    pub ranges: &'static [Range],
    /// Its timers, sorted, disjoint; they cover the ranges of class T.
    pub timers: &'static [Timers],
    /// Those of them whose unit a relay changes.
    pub fast_timers: Option<&'static FastTimers>,
    /// Devices of which the project's parameters choose the latched ones: class, first and last number. What `ranges` says of them
    /// is the factory setting.
    pub latch_choices: &'static [(DeviceClass, u32, u32)],
    /// Latched devices are kept over power-off only while this special register holds this value (HM); `None`: always.
    pub latch_key: Option<(u32, i16)>,
    /// Whether latched timers and counters keep their contacts over power-off, not only their values.
    pub keeps_contacts: bool,
    /// The pointer that is END: CJ to it ends the scan, and it is no label.
    pub end_pointer: Option<u32>,
    /// Program capacity in steps.
    pub max_steps: u32,
    /// Whether a 32-bit access to Zn takes Vn as its high word; HM takes Zn+1.
    pub z_pairs_with_v: bool,
    /// Relay that shows an operation error: M8067, or M8006 (HM); see [`rungc_rt::report`].
    pub error_relay: u32,
    /// Whether that relay goes off at the beginning of each scan (FX and L01S: only M8068 keeps an error) rather than with RUN.
    pub errors_last_a_scan: bool,
    /// Whether M8046 shows active annunciators as well as states.
    pub annunciators_are_states: bool,
    /// Code of an operation error in an operand's value: 6707 on H1U/H2U (h1u-h2u-programming §8.2); FX and its likes know only 6706, for
    /// devices and values.
    pub value_error: u16,
    /// Notations of operands that it knows, of those that are neither devices nor integers: E, TEXT, WORD_BIT, BUFFER.
    pub notations: Classes,
    /// Whether its programs name instructions that have only a 32-bit form without the D: `ECMP` for `DECMP`.
    pub bare_names: bool,
    /// Steps of an applied instruction: 1 and so many for each operand of the 16-bit and of the 32-bit form; `None`: as the
    /// catalogue's rows say.
    pub steps_per_operand: Option<(u8, u8)>,
    /// How deep FOR may nest.
    pub max_for: u32,
    /// How deep CALL may nest.
    pub max_call: u32,
    /// What its serial ports are.
    pub ports: Ports,
    /// What its pulse outputs are.
    pub pulses: Pulses,
    /// Their numbers, as far as instructions name them by output.
    pub pulse_outputs: &'static [(DeviceClass, u32, u32)],
    /// Those of them that keep a position, for positioning.
    pub position_outputs: &'static [(DeviceClass, u32, u32)],
    /// Special data registers that are other names of index registers: (number, class, index number), e.g. D8028 is Z0.
    pub index_aliases: &'static [(u32, DeviceClass, u32)],
}

/// Shows model and version.
const D_TYPE: u32 = 8001;

impl Model {
    /// Code of model and version, which D8001 shows; 0 on a model that does not show any.
    pub fn type_code(&self) -> u16 {
        let shown = self.special_words().find(|word| word.0 == D_TYPE);
        shown.map_or(0, |word| word.1 as u16)
    }

    /// The data of a model.
    pub fn get(id: ModelId) -> &'static Model {
        match id {
            ModelId::H1u => &inovance::H1U,
            ModelId::H2u => &inovance::H2U,
            ModelId::L01s => &l01s::L01S,
            ModelId::Hm => &hm::HM,
            ModelId::Fx1s => &fx1::FX1S,
            ModelId::Fx1n => &fx1::FX1N,
            ModelId::Fx2n => &fx2n::FX2N,
            ModelId::Fx2nCompatible => &fx2n::FX2N_COMPATIBLE,
            ModelId::Fx3s => &fx3::FX3S,
            ModelId::Fx3g => &fx3::FX3G,
            ModelId::Fx3u => &fx3::FX3U,
            ModelId::Fx3uCompatible => &fx3::FX3U_COMPATIBLE,
        }
    }

    /// Special registers that start with a value other than 0: (number, value), e.g. D8000 = 200.
    pub fn special_words(&self) -> impl Iterator<Item = (u32, i16)> + use<> {
        special::all(self.id)
            .filter(|row| row.class == DeviceClass::D && row.default != 0)
            .flat_map(|row| (row.first..=row.last).map(|number| (number, row.default)))
    }

    /// Special relays that are on at power-on.
    pub fn special_bits(&self) -> impl Iterator<Item = u32> + use<> {
        special::all(self.id)
            .filter(|row| row.class == DeviceClass::M && row.default != 0)
            .flat_map(|row| row.first..=row.last)
    }

    /// Whether a special relay does on this model what its number does on most of them: M8034 is an interrupt request on HM.
    pub fn special_relay_works(&self, number: u32) -> bool {
        special::find(self.id, DeviceClass::M, number)
            .is_some_and(special::Special::is_kept_by_scan)
    }

    /// The range that holds a device.
    pub fn range(&self, class: DeviceClass, number: u32) -> Option<&'static Range> {
        self.ranges
            .iter()
            .find(|r| r.class == class && (r.first..=r.last).contains(&number))
    }

    /// Whether the project's parameters choose if a device is latched.
    pub fn can_choose_latch(&self, class: DeviceClass, number: u32) -> bool {
        let mut choices = self.latch_choices.iter();
        choices.any(|&(of, first, last)| of == class && (first..=last).contains(&number))
    }

    /// Whether the model has a device.
    pub fn has(&self, class: DeviceClass, number: u32) -> bool {
        self.range(class, number).is_some()
    }

    /// The ranges of a class, in order.
    pub fn ranges_of(&self, class: DeviceClass) -> impl Iterator<Item = &'static Range> + use<> {
        self.ranges.iter().filter(move |r| r.class == class)
    }

    /// Notations of operands and devices of operands that it does not have at all.
    pub fn missing(&self) -> Classes {
        const NOTATIONS: Classes = Classes::E
            .or(Classes::TEXT)
            .or(Classes::WORD_BIT)
            .or(Classes::BUFFER);
        let mut missing = NOTATIONS.without(self.notations);
        for class in [DeviceClass::R, DeviceClass::ER] {
            if self.ranges_of(class).next().is_none() {
                missing = missing.or(Classes::of_device(class));
            }
        }
        missing
    }

    /// Kind of a timer.
    pub fn timer(&self, number: u32) -> Option<TimerKind> {
        self.timers
            .iter()
            .find(|t| (t.first..=t.last).contains(&number))
            .map(|t| t.kind)
    }
}

/// Devices of which the parameters of FX2N, FX3U and H2U choose the latched ones: those marked with ※1 and ※2
/// (h1u-h2u-programming §3.3 to §3.7), those of FX2N and FX3U likewise.
const LATCH_CHOICES: &[(DeviceClass, u32, u32)] = &{
    use DeviceClass::{C, D, M, S};
    [(M, 0, 1023), (S, 0, 999), (C, 0, 255), (D, 0, 511)]
};

/// A run of devices that go back to 0 at power-off.
const fn general(class: DeviceClass, first: u32, last: u32) -> Range {
    Range {
        class,
        first,
        last,
        latched: false,
    }
}

/// A run of devices that keep their values.
const fn latched(class: DeviceClass, first: u32, last: u32) -> Range {
    Range {
        latched: true,
        ..general(class, first, last)
    }
}

/// A run of timers of this unit that start again whenever they are driven.
const fn timers(first: u32, last: u32, unit_ms: u16) -> Timers {
    Timers {
        first,
        last,
        kind: TimerKind {
            unit_ms,
            accumulating: false,
            free_running: false,
            latches_preset: false,
            overruns: false,
            stepwise: false,
            shared: false,
        },
    }
}

impl Timers {
    const fn accumulating(self) -> Self {
        self.with(TimerKind {
            accumulating: true,
            ..self.kind
        })
    }

    const fn free_running(self) -> Self {
        self.with(TimerKind {
            free_running: true,
            ..self.kind
        })
    }

    const fn latching_preset(self) -> Self {
        self.with(TimerKind {
            latches_preset: true,
            ..self.kind
        })
    }

    const fn overrunning(self) -> Self {
        self.with(TimerKind {
            overruns: true,
            ..self.kind
        })
    }

    const fn stepwise(self) -> Self {
        self.with(TimerKind {
            stepwise: true,
            ..self.kind
        })
    }

    const fn with(self, kind: TimerKind) -> Self {
        Timers { kind, ..self }
    }
}

/// M8028 of FX1S and FX3S: T32 to T62 count 10 ms (FX1S/FX1N/FX2N programming manual II §4.7, FX3 programming manual §4.5).
const M8028: &FastTimers = &FastTimers {
    relay: 8028,
    numbers: 32..=62,
    unit_ms: 10,
};

/// D8028, D8029 and D8182–D8195: other names of Z0, V0, Z1, V1, … Z7, V7 (h1u-h2u-programming §3.8).
const INDEX_ALIASES: &[(u32, DeviceClass, u32)] = &{
    use DeviceClass::{V, Z};
    [
        (8028, Z, 0),
        (8029, V, 0),
        (8182, Z, 1),
        (8183, V, 1),
        (8184, Z, 2),
        (8185, V, 2),
        (8186, Z, 3),
        (8187, V, 3),
        (8188, Z, 4),
        (8189, V, 4),
        (8190, Z, 5),
        (8191, V, 5),
        (8192, Z, 6),
        (8193, V, 6),
        (8194, Z, 7),
        (8195, V, 7),
    ]
};

#[cfg(test)]
mod tests {
    use super::{Fit, Model, ModelId, ModelSet};
    use rungc_syntax::DeviceClass;

    #[test]
    fn ranges_are_sorted_and_disjoint() {
        for id in ModelId::ALL {
            let model = Model::get(id);
            assert_eq!(model.id, id);
            for range in model.ranges {
                assert!(range.first <= range.last, "{} {range:?}", model.name);
            }
            for pair in model.ranges.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                let sorted = a.class < b.class || a.class == b.class && a.last < b.first;
                assert!(sorted, "{}: {a:?} before {b:?}", model.name);
            }
        }
    }

    #[test]
    fn timers_cover_class_t() {
        for id in ModelId::ALL {
            let model = Model::get(id);
            for range in model.ranges_of(DeviceClass::T) {
                for number in range.first..=range.last {
                    let timer = model.timer(number);
                    assert!(timer.is_some(), "{} T{number}", model.name);
                    let accumulating = timer.is_some_and(|kind| kind.accumulating);
                    let latched = range.latched && model.latch_key.is_none();
                    assert!(accumulating || !latched, "{} T{number}", model.name);
                }
            }
        }
    }

    #[test]
    fn models_are_found_by_name_and_cpu() {
        assert_eq!(ModelId::from_name("h2u"), Some(ModelId::H2u));
        assert_eq!(ModelId::from_name("fx3uc"), Some(ModelId::Fx3u));
        assert_eq!(ModelId::from_name("FX3GE"), Some(ModelId::Fx3g));
        assert_eq!(ModelId::from_name("fx0n"), None);
        let cpu = ModelId::for_cpu;
        assert_eq!(cpu("FX3U/FX3UC"), Some((ModelId::Fx3u, Fit::Same)));
        assert_eq!(cpu("FX2N/FX2NC"), Some((ModelId::Fx2n, Fit::Same)));
        assert_eq!(cpu("FX1N/FX1NC"), Some((ModelId::Fx1n, Fit::Same)));
        assert_eq!(cpu("fx1s"), Some((ModelId::Fx1s, Fit::Same)));
        let nearest = |name| match cpu(name) {
            Some((id, Fit::Nearest(_))) => Some(id),
            _ => None,
        };
        assert_eq!(nearest("FX0/FX0S"), Some(ModelId::Fx1s));
        assert_eq!(nearest("FX2/FX2C"), Some(ModelId::Fx2n));
        assert_eq!(ModelId::from_cpu("Q02"), None);
    }

    #[test]
    fn no_name_means_two_models() {
        let mut seen = std::collections::BTreeSet::new();
        for id in ModelId::ALL {
            let model = Model::get(id);
            let upper = model.name.to_ascii_uppercase();
            let others = model.cpus.iter().filter(|cpu| **cpu != upper);
            let nearest = model.nearest.iter().map(|(name, _)| name);
            let names = others.chain(nearest).map(|name| (*name).to_owned());
            for name in names.chain([upper.clone()]) {
                assert_eq!(name, name.to_ascii_uppercase());
                assert!(seen.insert(name.clone()), "{name} is {} too", model.name);
            }
        }
    }

    #[test]
    fn sets_hold_what_they_were_made_of() {
        for (i, id) in ModelId::ALL.into_iter().enumerate() {
            assert_eq!(id as usize, i);
            assert!(ModelSet::ALL.has(id) && !ModelSet::NONE.has(id));
            assert!(!ModelSet::ALL.without(ModelSet::of(&[id])).has(id));
            assert!(ModelSet::NONE.or(ModelSet::of(&[id])).has(id));
        }
    }
}
