//! Finds the row of a mnemonic.

use super::{
    Forms, Inst, Spelling, arith, basic, block, clock, compare, data, external_io, float, flow,
    handy, high_speed, motion_hm, move_, position, rotate, serial, string,
};
use crate::Form;
use rustc_hash::FxHashMap;
use std::sync::OnceLock;

/// A family of instructions, as the manuals group them.
#[derive(Clone, Copy, Debug)]
pub struct Family {
    /// Short name in lower case, for file names: `high-speed`.
    pub name: &'static str,
    /// Title of its page.
    pub title: &'static str,
    /// Its rows, in the manuals' order.
    pub rows: &'static [Inst],
}

/// The families, each a file of this folder.
static FAMILIES: [Family; 17] = [
    Family {
        name: "basic",
        title: "Contacts, coils and the step ladder",
        rows: basic::ROWS,
    },
    Family {
        name: "flow",
        title: "Program flow",
        rows: flow::ROWS,
    },
    Family {
        name: "compare",
        title: "Comparisons",
        rows: compare::ROWS,
    },
    Family {
        name: "move",
        title: "Moving values",
        rows: move_::ROWS,
    },
    Family {
        name: "arithmetic",
        title: "Integer arithmetic and logic",
        rows: arith::ROWS,
    },
    Family {
        name: "rotate",
        title: "Rotating, shifting and queues",
        rows: rotate::ROWS,
    },
    Family {
        name: "data",
        title: "Data processing",
        rows: data::ROWS,
    },
    Family {
        name: "high-speed",
        title: "High-speed inputs and outputs",
        rows: high_speed::ROWS,
    },
    Family {
        name: "handy",
        title: "Handy instructions",
        rows: handy::ROWS,
    },
    Family {
        name: "external-io",
        title: "Keys, displays and modules",
        rows: external_io::ROWS,
    },
    Family {
        name: "serial",
        title: "Communication and memory cassettes",
        rows: serial::ROWS,
    },
    Family {
        name: "float",
        title: "Floating point",
        rows: float::ROWS,
    },
    Family {
        name: "position",
        title: "Positioning",
        rows: position::ROWS,
    },
    Family {
        name: "clock",
        title: "Clock",
        rows: clock::ROWS,
    },
    Family {
        name: "block",
        title: "Blocks, limits, scaling and tables",
        rows: block::ROWS,
    },
    Family {
        name: "string",
        title: "Text",
        rows: string::ROWS,
    },
    Family {
        name: "motion-hm",
        title: "Axis motion and advanced interrupts of HM",
        rows: motion_hm::ROWS,
    },
];

/// All families, in the manuals' order.
pub fn families() -> &'static [Family] {
    &FAMILIES
}

/// A row and the form that its spelling names.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// The row.
    pub inst: &'static Inst,
    /// The form.
    pub form: Form,
    /// Written without the D of its only width: `ECMP` for `DECMP`; some models' editors write so
    /// ([`Model::bare_names`]).
    ///
    /// [`Model::bare_names`]: rungc_models::Model::bare_names
    pub bare: bool,
}

/// All rows, in the order of the manual's families.
pub fn all() -> impl Iterator<Item = &'static Inst> {
    FAMILIES.iter().flat_map(|family| family.rows)
}

/// Finds an instruction by any of its spellings, in upper case: `DADDP`, `LDD>=`, `ECMP`. A label (`P12`, `I001`) is
/// found as the row `P` or `I`.
pub fn find(mnemonic: &str) -> Option<Found> {
    static SPELLINGS: OnceLock<FxHashMap<String, Found>> = OnceLock::new();
    let spellings = SPELLINGS.get_or_init(|| {
        let mut spellings = FxHashMap::default();
        for inst in all() {
            for (spelling, form) in inst.spellings() {
                let bare = form.wide && inst.is_bare(&spelling);
                let found = Found { inst, form, bare };
                spellings.entry(spelling).or_insert(found);
            }
        }
        spellings
    });
    let is_label = match mnemonic.as_bytes() {
        [b'P' | b'I', digits @ ..] => !digits.is_empty() && digits.iter().all(u8::is_ascii_digit),
        _ => false,
    };
    let key = if is_label { &mnemonic[..1] } else { mnemonic };
    spellings.get(key).copied()
}

impl Inst {
    /// Every way to write it, with the form that is meant; the first of a form is the usual one.
    pub fn spellings(&self) -> Vec<(String, Form)> {
        let mut spellings = Vec::new();
        for wide in [false, true] {
            if !self.forms.has(if wide { Forms::W32 } else { Forms::W16 }) {
                continue;
            }
            for pulse in [false, true] {
                if pulse && !self.forms.has(Forms::PULSE) {
                    continue;
                }
                let form = Form { wide, pulse };
                for stem in self.stems(wide) {
                    let suffix = if pulse { "P" } else { "" };
                    spellings.push((stem + suffix, form));
                }
            }
        }
        spellings
    }

    /// The usual spelling of a form.
    pub fn spelling_of(&self, form: Form) -> Option<String> {
        self.spellings()
            .into_iter()
            .find(|(_, of)| *of == form)
            .map(|(spelling, _)| spelling)
    }

    /// The spellings of one width without the suffix of the pulse form.
    fn stems(&self, wide: bool) -> Vec<String> {
        let names = std::iter::once(&self.name).chain(self.aliases);
        if !wide {
            return names.map(|name| (*name).to_owned()).collect();
        }
        let mut stems = Vec::new();
        if let Spelling::Wide(name) = self.spelling {
            stems.push(name.to_owned());
        }
        for name in names {
            match self.spelling {
                Spelling::Compare => {
                    let at = name.find(['=', '<', '>']).unwrap_or(name.len());
                    stems.push(format!("{}D{}", &name[..at], &name[at..]));
                }
                Spelling::Prefix | Spelling::Wide(_) => stems.push(format!("D{name}")),
                Spelling::Plain => {}
            }
            if self.has_only_wide_form() {
                stems.push((*name).to_owned());
            }
        }
        stems
    }

    /// Returns true if this spelling of the 32-bit form has no D in front although the instruction's list name would
    /// have one.
    fn is_bare(&self, spelling: &str) -> bool {
        let with_pulse = |name: &str| spelling == name || spelling.strip_suffix('P') == Some(name);
        self.has_only_wide_form()
            && self.spelling != Spelling::Plain
            && (with_pulse(self.name) || self.aliases.iter().any(|name| with_pulse(name)))
    }

    /// Returns true if it has no 16-bit form, so that its name without D means the 32-bit form too (`ECMP` is `DECMP`).
    fn has_only_wide_form(&self) -> bool {
        !self.forms.has(Forms::W16)
    }
}
