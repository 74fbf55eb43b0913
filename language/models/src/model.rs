//! The PLC models: which devices each has, which of them are latched, what its timers and counters are, and all else in
//! which it differs from the others.
//!
//! A model is a file here, with the tables of its special devices, and a line in [`models!`].

mod fx1;
mod fx2n;
mod fx3;
mod hm;
mod inovance;
mod l01s;
mod mitsubishi;
mod set;
mod shared;

use crate::high_speed::{FastUnits, HighSpeed};
use crate::interrupts::Interrupts;
use crate::runs::IndexAlias;
use crate::special::Special;
use crate::times::InstructionTimes;
use rungc_rt::modules::Place;
use rungc_rt::{ErrorRules, Ports, Pulses, Register, Relay, TimerKind};
use rungc_syntax::{Classes, DeviceClass};
pub use set::ModelSet;
use std::ops::RangeInclusive;

/// Makes [`ModelId`] and [`Model::get`] from a list of models, each with the constant that describes it.
macro_rules! models {
    ($($(#[$doc:meta])* $id:ident = $model:path,)*) => {
        /// A PLC model.
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Hash)]
        #[repr(u8)]
        pub enum ModelId {
            $($(#[$doc])* $id,)*
        }

        impl ModelId {
            /// All models, in the order of the enum.
            pub const ALL: [ModelId; [$(stringify!($id)),*].len()] = [$(ModelId::$id),*];
        }

        impl Model {
            /// The data of a model.
            pub const fn get(id: ModelId) -> &'static Model {
                // A constant would be copied into each crate that asks.
                static MODELS: [Model; ModelId::ALL.len()] = [$($model),*];
                &MODELS[id as usize]
            }
        }
    };
}

models! {
    /// Inovance H1U.
    H1u = inovance::H1U,
    /// Inovance H2U.
    H2u = inovance::H2U,
    /// Coolmay L01S.
    L01s = l01s::L01S,
    /// Kewei HM motion controller.
    Hm = hm::HM,
    /// Mitsubishi FX1S.
    Fx1s = fx1::FX1S,
    /// Mitsubishi FX1N/FX1NC.
    Fx1n = fx1::FX1N,
    /// Mitsubishi FX2N/FX2NC.
    Fx2n = fx2n::FX2N,
    /// Boards of other makers that take programs for FX2N.
    Fx2nCompatible = fx2n::FX2N_COMPATIBLE,
    /// Mitsubishi FX3S.
    Fx3s = fx3::FX3S,
    /// Mitsubishi FX3G/FX3GC/FX3GE.
    Fx3g = fx3::FX3G,
    /// Mitsubishi FX3U/FX3UC.
    Fx3u = fx3::FX3U,
    /// Boards of other makers that take programs for FX3U.
    Fx3uCompatible = fx3::FX3U_COMPATIBLE,
}

/// Similarity of a model and a CPU type.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fit {
    /// It is this model, or one that a program cannot distinguish from it.
    Same,
    /// None of the models is this CPU type, and this one resembles it most; the text says what is different there.
    Nearest(&'static str),
}

impl ModelId {
    /// The model with this name on the command line, e.g. `h2u`, or with this CPU type, e.g. `fx3uc`. Case does not
    /// matter.
    pub fn from_name(name: &str) -> Option<Self> {
        let is = |known: &str| known.eq_ignore_ascii_case(name);
        Self::ALL.into_iter().find(|&id| {
            let model = Model::get(id);
            is(model.name) || model.cpus.iter().any(|cpu| is(cpu))
        })
    }

    /// The model that a project's CPU type means, e.g. `FX3U/FX3UC`, or a base unit, e.g. `FX1S-30MR`, and how well it
    /// fits. Projects for the makers' own models are made for the Mitsubishi model they descend from.
    pub fn for_cpu(cpu: &str) -> Option<(Self, Fit)> {
        // The number of terminals follows the name of a base unit.
        let family = |name: &str| {
            let (family, unit) = name.split_once('-')?;
            unit.starts_with(|c: char| c.is_ascii_digit())
                .then_some(family.len())
        };
        let names = || {
            let names = cpu.split('/').map(str::trim);
            names.flat_map(|name| [Some(name), family(name).map(|end| &name[..end])])
        };
        let names = || names().flatten();
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
    /// True if it retains its value over RUN/STOP and power-off.
    pub latched: bool,
}

/// A run of timers of one kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Timers {
    /// First number.
    pub first: u32,
    /// Last number, inclusive.
    pub last: u32,
    /// Their type.
    pub kind: TimerKind,
}

/// Timers that count shorter units while a relay is on.
#[derive(Clone, Debug)]
pub struct FastTimers {
    /// The special relay.
    pub relay: Relay,
    /// Their numbers.
    pub numbers: RangeInclusive<u32>,
    /// Their unit while it is on, in milliseconds.
    pub unit_ms: u16,
}

/// Program errors that a model's manual numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ErrorNumbers {
    /// None.
    No,
    /// All that FX numbers.
    All,
    /// The numbers of contact logic are reserved.
    AllButLogic,
}

/// All that is known of a model.
#[derive(Debug)]
pub struct Model {
    /// Identifier.
    pub id: ModelId,
    /// The model whose instructions it has, with their forms and operands: itself, or the one whose programs it takes.
    /// Rows of the catalogue that name this model hold for it, too.
    pub instructions: ModelId,
    /// Name on the command line: `h2u`.
    pub name: &'static str,
    /// Boards of other makers that take its programs; they take some values that it does not.
    pub boards: Option<ModelId>,
    /// Full name: `Inovance H2U`.
    pub title: &'static str,
    /// CPU types of projects that are for it, in upper case: `FX3U`, `FX3UC`. A program cannot distinguish them.
    pub cpus: &'static [&'static str],
    /// CPU types that are not among the models, in upper case, and resemble this one most ([`Fit::Nearest`]), each with
    /// what is different there.
    pub nearest: &'static [(&'static str, &'static str)],
    /// Its devices: general and special ranges of every class, P, I and N included. Sorted by class and first number,
    /// disjoint.
    pub ranges: &'static [Range],
    /// Its timers, sorted, disjoint; they cover the ranges of class T.
    pub timers: &'static [Timers],
    /// Those of them whose unit a relay changes.
    pub fast_timers: Option<&'static FastTimers>,
    /// Devices of which the project's parameters choose the latched ones: class, first and last number. What `ranges`
    /// says of them is the factory setting.
    pub latch_choices: &'static [(DeviceClass, u32, u32)],
    /// Latched devices are retained over power-off only while this special register holds this value (HM); `None`:
    /// always.
    pub latch_key: Option<(Register, i16)>,
    /// True if latched timers and counters retain their contacts over power-off, not only their values.
    pub keeps_contacts: bool,
    /// Devices, first to last, that some of the PLCs for which it stands are known not to have.
    pub doubtful: &'static [(DeviceClass, u32, u32)],
    /// The pointer that is END: CJ to it ends the scan, and it is not a label.
    pub end_pointer: Option<u32>,
    /// Program capacity in steps.
    pub max_steps: u32,
    /// Memory capacity in steps, which a program shares with comments and file registers: more than the program can
    /// have on FX3S (FX3S hardware manual, performance specifications).
    pub memory_steps: u32,
    /// Execution times of instructions on the real PLC; `None` if none are published.
    pub instruction_times: Option<InstructionTimes>,
    /// True if a 32-bit access to Zn takes Vn as its high word; HM takes Zn+1.
    pub z_pairs_with_v: bool,
    /// True if an index counts 16-bit words also where the device has 32 bits: C200 with the index 1 is the high word
    /// of C200, not C201 (hm-motion-controller §5.1.8).
    pub index_counts_words: bool,
    /// Relay that shows an operation error: M8067, or M8006 (HM); see [`rungc_rt::report`].
    pub error_relay: Relay,
    /// True if that relay goes off at the beginning of each scan (FX and L01S: only M8068 keeps an error) rather than
    /// with RUN.
    pub errors_last_a_scan: bool,
    /// True if RST of a timer or counter in an interrupt routine holds it at 0 until it is executed with its drive off
    /// (FX3 programming manual 7.13). The other manuals do not mention this, and their examples count on.
    pub rst_holds_in_interrupts: bool,
    /// Auxiliary relays, first to last, at whose edges only the first contact acts that is executed: in the program
    /// above their coil and below it, each (FX3 programming manual 7.5; FX programming manual 2.8, single operation
    /// flags). They let a step ladder advance by one state for each press.
    pub single_operation: Option<(u32, u32)>,
    /// Consequences of errors: on H1U and H2U (h1u-h2u-programming §8.1, §8.2.2), M8004 shows those of ports, too, and
    /// the log all; on FX (FX3 programming manual 37.2.14), M8063 does not count.
    pub error_rules: ErrorRules,
    /// True if M8046 shows active annunciators as well as states.
    pub annunciators_are_states: bool,
    /// Code of an operation error in an operand's value: 6707 on H1U/H2U (h1u-h2u-programming §8.2); FX and its likes
    /// know only 6706, for devices and values.
    pub value_error: u16,
    /// Errors found before a run that have a number.
    pub error_numbers: ErrorNumbers,
    /// Notations of operands that it knows, of those that are neither devices nor integers: E, TEXT, WORD_BIT, BUFFER.
    pub notations: Classes,
    /// True if its programs name instructions that have only a 32-bit form without the D: `ECMP` for `DECMP`.
    pub bare_names: bool,
    /// Steps of an applied instruction: 1 plus this many for each operand of the 16-bit and of the 32-bit form; `None`:
    /// as the catalogue's rows say.
    pub steps_per_operand: Option<(u8, u8)>,
    /// True if its clock shows and accepts years of two digits.
    pub two_digit_years: bool,
    /// Maximum nesting of FOR.
    pub max_for: u32,
    /// Maximum nesting of CALL.
    pub max_call: u32,
    /// Serial ports.
    pub ports: Ports,
    /// Locations of special modules.
    pub module_places: &'static [Place],
    /// True if it detects the board in its slot.
    pub finds_boards: bool,
    /// Pulse outputs.
    pub pulses: Pulses,
    /// Their numbers, as far as instructions name them by output.
    pub pulse_outputs: &'static [(DeviceClass, u32, u32)],
    /// Those of them that keep a position, for positioning.
    pub position_outputs: &'static [(DeviceClass, u32, u32)],
    /// Parameters of axes that start with a value other than 0, in addition to the output, which is at first an axis'
    /// own ([`rungc_rt::axis_place`]).
    pub axis_defaults: &'static [(u32, i16)],
    /// Data registers below the special ones that its system keeps for itself, from the first to the last of each run,
    /// sorted.
    pub reserved: &'static [(u32, u32)],
    /// Special data registers that are other names of index registers.
    pub index_aliases: &'static [IndexAlias],
    /// Its special devices; see [`Model::special`]. Each table is sorted by class and number, and none holds what
    /// another holds.
    pub special: &'static [&'static [Special]],
    /// Relays that go off when it goes from RUN to STOP, by their numbers; see [`Model::cleared_in_stop`].
    pub cleared_in_stop: &'static [&'static [RangeInclusive<u16>]],
    /// Its high-speed counters, and what instructions for high-speed inputs do.
    pub high_speed: HighSpeed,
    /// The hardware that fast inputs and outputs share; `None`: there is enough for all.
    pub fast_units: Option<FastUnits>,
    /// Its interrupts.
    pub interrupts: Interrupts,
}

impl Model {
    /// The range that holds a device.
    pub fn range(&self, class: DeviceClass, number: u32) -> Option<&'static Range> {
        self.ranges
            .iter()
            .find(|r| r.class == class && (r.first..=r.last).contains(&number))
    }

    /// Returns true if the project's parameters determine whether a device is latched.
    pub fn can_choose_latch(&self, class: DeviceClass, number: u32) -> bool {
        let mut choices = self.latch_choices.iter();
        choices.any(|&(of, first, last)| of == class && (first..=last).contains(&number))
    }

    /// Returns true if the model has a device.
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

    /// The register of an output axis' parameter ([`rungc_rt::axis_place`]); `None` if it has no such axis.
    pub fn axis_register(&self, axis: u32, parameter: u32) -> Option<Register> {
        let wiring = self.pulses.outputs().get(axis as usize)?;
        Some(wiring.axis?.after(parameter))
    }

    /// Parameters of axes that begin with a value other than 0, with their values.
    pub fn axis_starts(&self) -> impl Iterator<Item = (Register, i16)> + use<> {
        let axes = self.pulses.outputs().iter().zip(0..);
        let axes = axes.filter_map(|(wiring, number)| Some((wiring.axis?, number)));
        let defaults = self.axis_defaults;
        axes.flat_map(move |(first, number)| {
            let output = std::iter::once((rungc_rt::axis_place::OUTPUT, number));
            let values = output.chain(defaults.iter().copied());
            values.map(move |(parameter, value)| (first.after(parameter), value))
        })
        .filter(|&(_, value)| value != 0)
    }

    /// Kind of a timer.
    pub fn timer(&self, number: u32) -> Option<TimerKind> {
        self.timers
            .iter()
            .find(|t| (t.first..=t.last).contains(&number))
            .map(|t| t.kind)
    }
}

#[cfg(test)]
mod tests {
    use super::{Fit, Model, ModelId, ModelSet};
    use rungc_rt::Register;
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
        for (unit, model) in [
            ("FX1S-30MR-001", ModelId::Fx1s),
            ("FX2N-48MR", ModelId::Fx2n),
            ("FX2NC-32MT", ModelId::Fx2n),
            ("FX3G-40MT/ESS", ModelId::Fx3g),
            ("FX3U-64MR/ES", ModelId::Fx3u),
            ("fx3uc-32mt-lt", ModelId::Fx3u),
            ("H2U-3232MT", ModelId::H2u),
        ] {
            assert_eq!(cpu(unit), Some((model, Fit::Same)), "{unit}");
        }
        assert_eq!(nearest("FX0N-24MR"), Some(ModelId::Fx1s));
        assert_eq!(ModelId::from_cpu("FX3U-X"), None);
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
    fn axes_begin_with_their_own_outputs() {
        let starts = |id| Model::get(id).axis_starts().collect::<Vec<_>>();
        let hm = starts(ModelId::Hm);
        assert!(hm.contains(&(Register(550), 5)) && hm.contains(&(Register(302), 10)));
        assert!(!hm.iter().any(|&(register, _)| register == Register(300)));
        assert_eq!(starts(ModelId::H2u), []);
    }

    #[test]
    fn sets_follow_what_models_descend_from() {
        use ModelId::{Fx2n, Fx2nCompatible, Fx3u, Fx3uCompatible};
        assert_eq!(ModelSet::FX3U, ModelSet::of(&[Fx3u, Fx3uCompatible]));
        let boards = ModelSet::of(&[Fx2nCompatible, Fx3uCompatible]);
        assert_eq!(ModelSet::COMPATIBLE, boards);
        assert_eq!(
            ModelSet::FX2N.without(ModelSet::COMPATIBLE),
            ModelSet::of(&[Fx2n])
        );
        for id in ModelId::ALL {
            let origin = Model::get(Model::get(id).instructions);
            assert_eq!(origin.instructions, origin.id);
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
