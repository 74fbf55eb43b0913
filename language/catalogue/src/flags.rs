//! Special devices of instructions, model by model.

use crate::Inst;
use rungc_models::{ModelId, ModelSet};

/// Special devices that rows name and that their instructions do not use on some models.
struct Unused {
    /// Names of the instructions; none: all of them.
    names: &'static [&'static str],
    flags: &'static [&'static str],
    models: ModelSet,
}

const L01S: ModelSet = ModelSet::L01S;
const HM: ModelSet = ModelSet::HM;
const NOT_INOVANCE: ModelSet = ModelSet::ALL.without(ModelSet::INOVANCE);

static UNUSED: &[Unused] = &[
    // hm-motion-controller §5.7 gives M8022 to arithmetic, and registers to axes.
    unused(&[], &["M8020", "M8021", "M8024", "M8025", "M8029"], HM),
    unused(&["SPD"], SPEEDS, NOT_INOVANCE),
    unused(&["MEAN"], &["M8490"], NOT_INOVANCE),
    unused(
        &["FROM", "TO"],
        &["M8164", "D8164"],
        ModelSet::FX.without(ModelSet::FX2N),
    ),
    unused(&["FROM", "TO"], &["M8299", "D8299"], NOT_INOVANCE),
    // A page that gives them to these models is not at hand (docs/src/choices.md).
    unused(&["HSZ"], TABLES, ModelSet::FX3S.or(ModelSet::FX3G).or(HM)),
    unused(&["HSCS", "HSCR", "HSZ"], &["M8025"], ModelSet::FX1),
    unused(&["HSCT"], &["M8138", "D8138"], HM),
    // D8040 to D8049 are analog inputs there, or nothing.
    unused(&["ANS", "ANR"], &["D8049"], L01S),
    unused(&["RS2"], SECOND_PORTS, NOT_INOVANCE),
];

/// Pulses a minute (h1u-h2u-programming §8.7).
const SPEEDS: &[&str] = &["M8100", "M8101", "M8102", "M8103", "M8104", "M8105"];
/// HSZ by tables.
const TABLES: &[&str] = &["M8130", "M8131", "M8132", "M8133", "D8130", "D8131"];
/// COM2 and COM3 of H1U and H2U.
const SECOND_PORTS: &[&str] = &["M8262", "M8263", "M8272", "M8273"];

const fn unused(
    names: &'static [&'static str],
    flags: &'static [&'static str],
    models: ModelSet,
) -> Unused {
    Unused {
        names,
        flags,
        models,
    }
}

impl Inst {
    /// Special devices that it reads or writes on a model.
    pub fn flags_on(&self, model: ModelId) -> impl Iterator<Item = &'static str> + use<'_> {
        self.flags.iter().copied().filter(move |flag| {
            !UNUSED.iter().any(|unused| {
                (unused.names.is_empty() || unused.names.contains(&self.name))
                    && unused.flags.contains(flag)
                    && unused.models.has(model)
            })
        })
    }
}
