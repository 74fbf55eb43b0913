//! From mnemonics to rows and forms.

use super::Form;
use crate::catalogue::{self, Forms, Found, Inst};
use crate::model::{Model, ModelId, ModelSet};
use rungc_syntax::{Diagnostic, Diagnostics, Instr, codes, diag};
use std::sync::OnceLock;

/// How many unknown mnemonics get a suggestion; searching one costs as much as resolving hundreds of good instructions.
const MAX_SUGGESTIONS: u32 = 200;

/// Whether the model has the form of an instruction that it has.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fit {
    Good,
    /// Which was reported.
    NoSuchForm,
}

/// Finds rows and reports instructions that have none.
pub(super) struct Finder {
    model: &'static Model,
    suggestions: u32,
}

impl Finder {
    pub(super) fn new(model: &'static Model) -> Self {
        let suggestions = MAX_SUGGESTIONS;
        Finder { model, suggestions }
    }

    /// The row and form of an instruction, if the model has the instruction; a form that it does not have is reported and marked.
    pub(super) fn find(&mut self, instr: &Instr, out: &mut Diagnostics) -> Option<(Found, Fit)> {
        let mnemonic = instr.mnemonic.as_str();
        let Some(found) = catalogue::find(mnemonic).or_else(|| without_affixes(mnemonic)) else {
            out.push(self.unknown(instr));
            return None;
        };
        if !found.inst.models.has(self.model.id) {
            out.push(self.not_on_model(instr, found.inst));
            return None;
        }
        if !self.has_form(found.inst, found.form) || found.bare && !self.model.bare_names {
            out.push(self.no_such_form(instr, found.inst, found.form));
            return Some((found, Fit::NoSuchForm));
        }
        Some((found, Fit::Good))
    }

    fn has_form(&self, inst: &Inst, form: Form) -> bool {
        let forms = inst.forms_on(self.model.id);
        let width = if form.wide { Forms::W32 } else { Forms::W16 };
        forms.has(width) && (!form.pulse || forms.has(Forms::PULSE))
    }

    fn unknown(&mut self, instr: &Instr) -> Diagnostic {
        let mnemonic = instr.mnemonic.as_str();
        let message = format!("unknown instruction `{mnemonic}`");
        let diagnostic = codes::UNKNOWN_INSTRUCTION
            .at(instr.mnemonic_span, message)
            .label("no model has this instruction");
        match self.similar(mnemonic) {
            Some(similar) => diagnostic.help(format!("did you mean `{similar}`?")),
            None => diagnostic,
        }
    }

    /// A spelling that the model has and that is close to a misspelt one.
    fn similar(&mut self, mnemonic: &str) -> Option<&'static str> {
        static SPELLINGS: OnceLock<Vec<(String, ModelSet)>> = OnceLock::new();
        /// No mnemonic is longer than this by more than a typing error.
        const LONGEST: usize = 14;
        self.suggestions = self.suggestions.checked_sub(1)?;
        let spellings = SPELLINGS.get_or_init(|| {
            catalogue::all()
                .flat_map(|inst| {
                    inst.spellings()
                        .into_iter()
                        .map(|(name, _)| (name, inst.models))
                })
                .collect()
        });
        let on_model = spellings
            .iter()
            .filter(|(_, models)| models.has(self.model.id))
            .map(|(name, _)| name.as_str());
        if mnemonic.len() > LONGEST {
            return None;
        }
        diag::did_you_mean(mnemonic, on_model)
    }

    fn not_on_model(&self, instr: &Instr, inst: &Inst) -> Diagnostic {
        let having: Vec<_> = ModelId::ALL
            .into_iter()
            .filter(|&id| inst.models.has(id))
            .map(|id| Model::get(id).name)
            .collect();
        let message = format!("{} does not have `{}`", self.model.name, instr.mnemonic);
        codes::NOT_ON_MODEL
            .at(instr.mnemonic_span, message)
            .label(inst.title)
            .help(match having.as_slice() {
                [] => "no model that is supported has it".to_owned(),
                names => format!("these models have it: {}", names.join(", ")),
            })
    }

    fn no_such_form(&self, instr: &Instr, inst: &Inst, form: Form) -> Diagnostic {
        let forms: Vec<_> = [(false, false), (false, true), (true, false), (true, true)]
            .into_iter()
            .map(|(wide, pulse)| Form { wide, pulse })
            .filter(|&form| self.has_form(inst, form))
            .filter_map(|form| Some(format!("`{}`", inst.spelling_of(form)?)))
            .collect();
        let missing = match form {
            Form { pulse: true, .. } if !inst.forms_on(self.model.id).has(Forms::PULSE) => "pulse",
            Form { wide: true, .. } if inst.forms_on(self.model.id).has(Forms::W32) => "16-bit",
            Form { wide: true, .. } => "32-bit",
            Form { wide: false, .. } => "16-bit",
        };
        let message = format!(
            "`{}` does not exist: `{}` has no {missing} form",
            instr.mnemonic, inst.name
        );
        codes::NO_SUCH_FORM
            .at(instr.mnemonic_span, message)
            .label(format!("no {missing} form"))
            .help(format!("write {}", forms.join(" or ")))
    }
}

/// The row that a mnemonic would name if its prefix D or suffix P were taken away, with the form that these mean and that the row
/// does not have.
fn without_affixes(mnemonic: &str) -> Option<Found> {
    let without_prefix = mnemonic.strip_prefix('D');
    let shorter = [
        (without_prefix, true, false),
        (mnemonic.strip_suffix('P'), false, true),
        (
            without_prefix.and_then(|rest| rest.strip_suffix('P')),
            true,
            true,
        ),
    ];
    shorter.into_iter().find_map(|(rest, wide, pulse)| {
        let found = catalogue::find(rest?)?;
        let twice = wide && found.form.wide || pulse && found.form.pulse;
        let form = Form {
            wide: wide || found.form.wide,
            pulse: pulse || found.form.pulse,
        };
        let new = !twice && found.inst.spelling_of(form).is_none();
        new.then_some(Found { form, ..found })
    })
}
