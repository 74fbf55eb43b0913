//! Variants and base units of models, as data: what each has less than its model.
//!
//! A model here is a family: H2U is what any H2U has. A program for a certain PLC of the family is held to what that
//! one has.

use crate::{Fit, Model, ModelId};
use rungc_rt::Register;
use rungc_syntax::DeviceClass::{self, C, D, I, M};
use rungc_syntax::diag::did_you_mean;
use rungc_syntax::family::other_family;

/// A PLC of a family: a variant, or a base unit with a number of terminals.
#[derive(Debug, PartialEq, Eq)]
pub struct Variant {
    /// Name on the command line: `h2u-mtq`.
    pub name: &'static str,
    /// Full name: `Inovance H2U-MTQ`.
    pub title: &'static str,
    /// Its family.
    pub model: ModelId,
    /// Number of inputs of the base unit, from X000 on; `None`: it is sold with several numbers.
    pub inputs: Option<u32>,
    /// Number of outputs of the base unit, from Y000 on.
    pub outputs: Option<u32>,
    /// Number of outputs that send pulses, from Y000 on.
    pub pulse_outputs: u32,
    /// Number of outputs, from Y000 on, that cannot give the direction of pulses.
    pub no_direction: u32,
    /// Instructions of its family that it does not have.
    pub lacks: &'static [&'static [&'static str]],
    /// Devices of its family that it does not have: class, first and last number.
    pub lacks_devices: &'static [(DeviceClass, u32, u32)],
    /// Special registers that start with another value than those of its family.
    pub defaults: &'static [(Register, i16)],
    /// Source of the data.
    pub source: &'static str,
}

/// The PLC that a program is for: a model, and which one of its family, if that is known.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Plc {
    /// The family.
    pub model: ModelId,
    /// The PLC of that family.
    pub variant: Option<&'static Variant>,
}

impl Plc {
    /// The model or variant with this name on the command line. Case does not matter.
    pub fn find(name: &str) -> Option<Plc> {
        let variant = Variant::find(name);
        let model = variant.map_or_else(|| ModelId::from_name(name), |v| Some(v.model))?;
        Some(Plc { model, variant })
    }

    /// The PLC that the CPU type of a program means, as [`ModelId::for_cpu`] finds its model.
    pub fn for_cpu(cpu: &str) -> Option<(Plc, Fit)> {
        let variant = Variant::of_unit(cpu.trim());
        let variant = variant.map(|v| (v.model, Some(v), Fit::Same));
        let found = variant.or_else(|| ModelId::for_cpu(cpu).map(|(id, fit)| (id, None, fit)));
        found.map(|(model, variant, fit)| (Plc { model, variant }, fit))
    }

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self.variant {
            Some(variant) => variant.name,
            None => Model::get(self.model).name,
        }
    }

    /// Full name: `Inovance H2U-MTQ`.
    pub fn title(self) -> &'static str {
        match self.variant {
            Some(variant) => variant.title,
            None => Model::get(self.model).title,
        }
    }

    /// The model or variant with this name.
    ///
    /// # Errors
    /// What is wrong with the name, and what to do.
    pub fn named(name: &str) -> Result<Plc, UnknownPlc> {
        Plc::find(name)
            .or_else(|| Plc::of_each(name))
            .ok_or_else(|| UnknownPlc::of(name))
    }

    /// The model that each name of a text stands for, as editors write CPU types: `FX3U/FX3UC`.
    fn of_each(names: &str) -> Option<Plc> {
        let mut all = parts(names).map(Plc::find);
        let first = all.next()??;
        all.all(|other| other == Some(first)).then_some(first)
    }

    /// Any PLC of a model.
    pub const fn any(model: ModelId) -> Plc {
        Plc {
            model,
            variant: None,
        }
    }
}

/// The names in a text that may hold several.
fn parts(names: &str) -> impl Iterator<Item = &str> + Clone {
    let is_separator = |c: char| c == '/' || c == ',' || c.is_whitespace();
    names.split(is_separator).filter(|name| !name.is_empty())
}

/// A name that no PLC has.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UnknownPlc {
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: String,
}

impl UnknownPlc {
    fn of(name: &str) -> Self {
        if let Some(family) = other_family(name) {
            return UnknownPlc {
                message: format!("`{name}` is a CPU of {family}, which is not supported"),
                help: "rungc compiles programs of the FX family, up to FX3".to_string(),
            };
        }
        let known: Vec<_> = parts(name).filter_map(Plc::find).map(Plc::name).collect();
        if known.len() > 1 && known.len() == parts(name).count() {
            return UnknownPlc {
                message: format!("`{name}` names {} models", known.len()),
                help: format!("name one: `{}`", known.join("` or `")),
            };
        }
        let names = ModelId::ALL.map(|id| Model::get(id).name).into_iter();
        let names = names.chain(VARIANTS.each_ref().map(|variant| variant.name));
        let lower = name.to_lowercase();
        let near = did_you_mean(&lower, names).filter(|near| near.len() > 1);
        let help = match (ModelId::from_cpu(name), near) {
            (Some(nearest), _) => format!("the nearest model is `{}`", Model::get(nearest).name),
            (None, Some(near)) => format!("did you mean `{near}`?"),
            (None, None) => format!(
                "models: {}; variants: {}",
                ModelId::names(),
                Variant::names()
            ),
        };
        UnknownPlc {
            message: format!("unknown model `{name}`"),
            help,
        }
    }
}

/// Instructions missing from H2U-MTQ and H2U-MTP (h1u-h2u-programming §8.6).
const NO_FLOATS: &[&str] = &[
    "CANTX", "CANRX", "RS2", "MODBUS2", "ECMP", "EZCP", "EMOV", "EBCD", "EBIN", "EADD", "ESUB",
    "EMUL", "EDIV", "EXP", "LOGE", "LOG10", "ESQR", "SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN",
    "RAD", "DEG", "SINH", "COSH", "TANH", "DSZR", "ABS",
];

/// Instructions missing from H2U-MTP in addition: everything at high-speed inputs (§8.5).
const NO_FAST_INPUTS: &[&str] = &["SPD", "HSCS", "HSCR", "HSZ"];

/// Interrupts of a table of counts, and the speed per minute of SPD, which the XP generation does not have (§8.1,
/// §8.7).
const NOT_ON_XP: &[(DeviceClass, u32, u32)] = &[
    (I, 507, 530),
    (M, 8005, 8005),
    (M, 8084, 8084),
    (M, 8100, 8105),
    (D, 8005, 8005),
    (D, 8084, 8086),
];

/// High-speed counters, interrupts of inputs, pulse catch, and the special devices of these and of SPD (§3.6, §3.9,
/// §4.3.6, §8.2).
const FAST_INPUTS: &[(DeviceClass, u32, u32)] = &[
    (C, 235, 255),
    (I, 0, 501),
    (I, 507, 530),
    (M, 8025, 8025),
    (M, 8050, 8055),
    (M, 8059, 8059),
    (M, 8084, 8084),
    (M, 8100, 8105),
    (M, 8130, 8133),
    (M, 8166, 8166),
    (M, 8169, 8177),
    (M, 8195, 8199),
    (M, 8235, 8255),
    (D, 8084, 8086),
    (D, 8130, 8134),
];

/// Outputs of ZRN's clear signals on MTP: Y010 to Y017 for Y000 to Y007 (§8.5.2).
const CLEARS_OF_MTP: &[(Register, i16)] = &[
    (Register(8156), 8),
    (Register(8157), 9),
    (Register(8158), 10),
    (Register(8159), 11),
    (Register(8160), 12),
    (Register(8161), 13),
    (Register(8196), 14),
    (Register(8197), 15),
];

/// The XP generation of H2U.
const H2U_XP: Variant = Variant {
    name: "h2u-xp",
    title: "Inovance H2U-XP",
    model: ModelId::H2u,
    inputs: None,
    outputs: None,
    pulse_outputs: 3,
    no_direction: 0,
    lacks: &[],
    lacks_devices: NOT_ON_XP,
    defaults: &[],
    source: "h1u-h2u-programming §8.1, §8.4",
};

/// A base unit of H2U.
const fn h2u(name: &'static str, title: &'static str, inputs: u32, outputs: u32) -> Variant {
    Variant {
        name,
        title,
        inputs: Some(inputs),
        outputs: Some(outputs),
        lacks_devices: &[],
        source: "h1u-h2u-programming §3.1, §3.2, §8.4",
        ..H2U_XP
    }
}

/// The same, which sends pulses at Y000 and Y001 only (§4.3.11).
const fn two_pulse_outputs(unit: Variant) -> Variant {
    Variant {
        pulse_outputs: 2,
        source: "h1u-h2u-programming §3.1, §3.2, §4.3.6, §4.3.11",
        ..unit
    }
}

/// A base unit of H1U.
const fn h1u(name: &'static str, title: &'static str, inputs: u32, outputs: u32) -> Variant {
    Variant {
        model: ModelId::H1u,
        ..h2u(name, title, inputs, outputs)
    }
}

/// A base unit of L01S with transistor outputs. Those with eight pulse outputs send on what their family has, Y000 to
/// Y003: l01s-programming §7 describes no others.
const fn l01s(name: &'static str, title: &'static str, inputs: u32, outputs: u32) -> Variant {
    Variant {
        model: ModelId::L01s,
        pulse_outputs: 4,
        source: "l01s-programming §1.3; pulse outputs §7.2",
        ..h2u(name, title, inputs, outputs)
    }
}

/// The same, of which the table of base units says that it has no analog inputs and outputs.
const fn digital(unit: Variant) -> Variant {
    Variant {
        lacks_devices: &[(D, 8030, 8045), (D, 8050, 8057)],
        ..unit
    }
}

/// The same with relays but at Y000 and Y001.
const fn relays(name: &'static str, title: &'static str, unit: Variant) -> Variant {
    Variant {
        name,
        title,
        pulse_outputs: 2,
        ..unit
    }
}

const L01S_16MT: Variant = l01s("l01s-16mt", "Coolmay L01S-16MT", 8, 8);
const L01S_24MT: Variant = digital(l01s("l01s-24mt", "Coolmay L01S-24MT", 14, 10));

/// All of them.
pub static VARIANTS: [Variant; 19] = [
    Variant {
        name: "h1u-xp",
        title: "Inovance H1U-XP",
        model: ModelId::H1u,
        ..H2U_XP
    },
    h1u("h1u-0806", "Inovance H1U-0806", 8, 6),
    h1u("h1u-1614", "Inovance H1U-1614", 16, 14),
    H2U_XP,
    Variant {
        name: "h2u-mtq",
        title: "Inovance H2U-MTQ",
        pulse_outputs: 5,
        lacks: &[NO_FLOATS],
        lacks_devices: &[],
        source: "h1u-h2u-programming §8.4, §8.6",
        ..H2U_XP
    },
    Variant {
        name: "h2u-mtp",
        title: "Inovance H2U-MTP",
        pulse_outputs: 8,
        no_direction: 8,
        lacks: &[NO_FLOATS, NO_FAST_INPUTS],
        lacks_devices: FAST_INPUTS,
        defaults: CLEARS_OF_MTP,
        source: "h1u-h2u-programming §8.5, §8.6",
        ..H2U_XP
    },
    h2u("h2u-1616", "Inovance H2U-1616", 16, 16),
    two_pulse_outputs(h2u("h2u-2416", "Inovance H2U-2416", 24, 16)),
    two_pulse_outputs(h2u("h2u-3624", "Inovance H2U-3624", 36, 24)),
    h2u("h2u-3232", "Inovance H2U-3232", 32, 32),
    h2u("h2u-6464", "Inovance H2U-6464", 64, 64),
    L01S_16MT,
    relays("l01s-16mrt", "Coolmay L01S-16MRT", L01S_16MT),
    L01S_24MT,
    relays("l01s-24mrt", "Coolmay L01S-24MRT", L01S_24MT),
    l01s("l01s-32mt", "Coolmay L01S-32MT", 16, 16),
    digital(l01s("l01s-40mt", "Coolmay L01S-40MT", 24, 16)),
    l01s("l01s-48mt", "Coolmay L01S-48MT", 24, 24),
    l01s("l01s-64mt", "Coolmay L01S-64MT", 32, 32),
];

impl Variant {
    /// The variant with this name on the command line. Case does not matter.
    pub fn find(name: &str) -> Option<&'static Variant> {
        let mut variants = VARIANTS.iter();
        variants.find(|variant| variant.name.eq_ignore_ascii_case(name))
    }

    /// The variant that a base unit is, whose name may also say whether it has relays or transistors: `H2U-3232MT`.
    fn of_unit(name: &str) -> Option<&'static Variant> {
        Variant::find(name).or_else(|| {
            let end = name.len().checked_sub(2)?;
            let outputs = name.get(end..)?;
            let is_known = ["MR", "MT"].iter().any(|o| o.eq_ignore_ascii_case(outputs));
            Variant::find(&name[..end]).filter(|_| is_known)
        })
    }

    /// The names of all of them: `h1u-xp, h1u-0806, …`.
    pub fn names() -> String {
        VARIANTS.each_ref().map(|variant| variant.name).join(", ")
    }

    /// Returns true if it has an instruction of its family.
    pub fn has_instruction(&self, name: &str) -> bool {
        !self.lacks.iter().any(|group| group.contains(&name))
    }

    /// Returns true if it has a device of its family.
    pub fn has(&self, class: DeviceClass, number: u32) -> bool {
        let mut lacking = self.lacks_devices.iter();
        !lacking.any(|&(of, first, last)| of == class && (first..=last).contains(&number))
    }
}

#[cfg(test)]
mod tests {
    use super::{Plc, VARIANTS, Variant};
    use crate::{Model, ModelId};

    #[test]
    fn base_units_are_their_variants() {
        for (cpu, name) in [
            ("H2U-3232MT", "h2u-3232"),
            ("h1u-1614mr", "h1u-1614"),
            ("L01S-16MT", "l01s-16mt"),
        ] {
            let found = Plc::for_cpu(cpu).and_then(|(plc, _)| plc.variant);
            assert_eq!(found.map(|variant| variant.name), Some(name), "{cpu}");
        }
    }

    #[test]
    fn several_names_are_one_model_or_none() {
        for (names, model) in [
            ("FX3U/FX3UC", "fx3u"),
            ("fx2n, FX2NC", "fx2n"),
            ("FX3U FX3UC", "fx3u"),
        ] {
            assert_eq!(Plc::named(names).unwrap().name(), model);
        }
        let wrong = Plc::named("FX3U/FX2N").unwrap_err();
        let said = format!("{}; {}", wrong.message, wrong.help);
        assert_eq!(
            said,
            "`FX3U/FX2N` names 2 models; name one: `fx3u` or `fx2n`"
        );
        let wrong = Plc::named("FX3U/FX9").unwrap_err();
        assert_eq!(wrong.help, "the nearest model is `fx3u`");
    }

    #[test]
    fn variants_lack_what_their_families_have() {
        for variant in &VARIANTS {
            assert_eq!(ModelId::from_name(variant.name), None);
            assert_eq!(Variant::find(&variant.name.to_uppercase()), Some(variant));
            let model = Model::get(variant.model);
            for &(class, first, last) in variant.lacks_devices {
                let mut numbers = first..=last;
                assert!(
                    numbers.any(|n| model.has(class, n)),
                    "{} {class:?}{first}",
                    variant.name
                );
            }
        }
    }
}
