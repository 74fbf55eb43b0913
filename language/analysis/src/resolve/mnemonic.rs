//! From mnemonics to rows and forms.

use super::suggest::{self, Open, any_of};
use rungc_catalogue::Form;
use rungc_catalogue::{Basic, Drive, Forms, Found, Inst};
use rungc_models::{Model, ModelId};
use rungc_syntax::{Device, Diagnostic, Diagnostics, Fix, Instr, codes, phrase};

/// Maximum number of unknown mnemonics that get a suggestion; searching one costs as much as resolving hundreds of good
/// instructions.
const MAX_SUGGESTIONS: u32 = 200;

/// Quality of the match between an instruction and its row.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Fit {
    Good,
    /// The model does not have the form, which was reported.
    NoSuchForm,
    /// The instruction is misspelt, or the model does not have it, which was reported; this is what it stands for in
    /// the structure of the program.
    Meant,
}

/// Match of an instruction.
#[derive(Clone, Copy)]
pub(super) struct Match {
    pub(super) found: Found,
    pub(super) fit: Fit,
    /// The pointer, if it is a label.
    pub(super) label: Option<Device>,
}

/// Finds rows and reports instructions that have none.
pub(super) struct Finder {
    model: &'static Model,
    suggestions: u32,
    open: Open,
}

impl Finder {
    pub(super) fn new(model: &'static Model) -> Self {
        Finder {
            model,
            suggestions: MAX_SUGGESTIONS,
            open: Open::default(),
        }
    }

    /// The row and form of an instruction. One that is unknown, or that the model does not have, is reported; where it
    /// can only have been meant to begin, end or name a part of the program, it is found as that. `last`: nothing
    /// follows it.
    pub(super) fn find(
        &mut self,
        instr: &Instr,
        last: bool,
        out: &mut Diagnostics,
    ) -> Option<Match> {
        let matched = self.look_up(instr, last, out)?;
        self.open.pass(matched.found.inst, matched.label);
        Some(matched)
    }

    fn look_up(&mut self, instr: &Instr, last: bool, out: &mut Diagnostics) -> Option<Match> {
        let mnemonic = instr.mnemonic.as_str();
        let label = super::label(instr);
        let Some(found) = rungc_catalogue::find(mnemonic).or_else(|| without_affixes(mnemonic))
        else {
            return self.unknown(instr, last, out);
        };
        let matched = |fit| Match { found, fit, label };
        if !found.inst.models.has(self.model.id) {
            out.push(self.not_on_model(instr, found.inst));
            return is_structural(found.inst).then(|| matched(Fit::Meant));
        }
        if !self.has_form(found.inst, found.form) || found.bare && !self.model.bare_names {
            out.push(self.no_such_form(instr, found.inst, found.form));
            return Some(matched(Fit::NoSuchForm));
        }
        Some(matched(Fit::Good))
    }

    fn has_form(&self, inst: &Inst, form: Form) -> bool {
        let forms = inst.forms_on(self.model.id);
        let width = if form.wide { Forms::W32 } else { Forms::W16 };
        forms.has(width) && (!form.pulse || forms.has(Forms::PULSE))
    }

    fn unknown(&mut self, instr: &Instr, last: bool, out: &mut Diagnostics) -> Option<Match> {
        let message = phrase!(
            "unknown instruction `{mnemonic}`",
            mnemonic = instr.mnemonic
        );
        let diagnostic = codes::UNKNOWN_INSTRUCTION
            .at(instr.mnemonic_span, message)
            .label("no model has this instruction");
        let meant = match self.suggestions {
            0 => None,
            _ => suggest::meant(instr, self.open, last, self.model),
        };
        self.suggestions = self.suggestions.saturating_sub(1);
        let Some(meant) = meant else {
            out.push(diagnostic);
            return None;
        };
        let diagnostic = diagnostic.help(meant.help);
        out.push(match meant.instead {
            None => diagnostic,
            Some((text, certain)) => {
                let title = phrase!("write `{text}`", text);
                let fix = match certain {
                    true => Fix::certain(title),
                    false => Fix::suggested(title),
                };
                diagnostic.fix(fix.replace(instr.mnemonic_span, text))
            }
        });
        let found = meant.found.filter(|found| is_structural(found.inst))?;
        Some(Match {
            found,
            fit: Fit::Meant,
            label: meant.label,
        })
    }

    fn not_on_model(&self, instr: &Instr, inst: &Inst) -> Diagnostic {
        let having: Vec<_> = ModelId::ALL
            .into_iter()
            .filter(|&id| inst.models.has(id))
            .map(|id| Model::get(id).name)
            .collect();
        let message = phrase!(
            "`{mnemonic}` is not available on {model}",
            mnemonic = instr.mnemonic,
            model = self.model.title
        );
        codes::NOT_ON_MODEL
            .at(instr.mnemonic_span, message)
            .label(inst.title)
            .help(match having.as_slice() {
                [] => phrase!("no supported model has it"),
                names => phrase!("available on: {names}", names = names.join(", ")),
            })
    }

    fn no_such_form(&self, instr: &Instr, inst: &Inst, form: Form) -> Diagnostic {
        let forms: Vec<_> = [(false, false), (false, true), (true, false), (true, true)]
            .into_iter()
            .map(|(wide, pulse)| Form { wide, pulse })
            .filter(|&form| self.has_form(inst, form))
            .filter_map(|form| inst.spelling_of(form))
            .collect();
        let missing = match form {
            Form { pulse: true, .. } if !inst.forms_on(self.model.id).has(Forms::PULSE) => {
                phrase!("pulse")
            }
            Form { wide: true, .. } if inst.forms_on(self.model.id).has(Forms::W32) => {
                phrase!("16-bit")
            }
            Form { wide: true, .. } => phrase!("32-bit"),
            Form { wide: false, .. } => phrase!("16-bit"),
        };
        let message = phrase!(
            "`{mnemonic}` does not exist: `{inst}` has no {missing} form",
            mnemonic = instr.mnemonic,
            inst = inst.name,
            missing
        );
        let diagnostic = codes::NO_SUCH_FORM
            .at(instr.mnemonic_span, message)
            .label(phrase!("no {missing} form", missing));
        let quoted: Vec<_> = forms.iter().map(|form| format!("`{form}`")).collect();
        let diagnostic = diagnostic.help(phrase!("write {forms}", forms = any_of(&quoted)));
        match forms.as_slice() {
            [only] => diagnostic.fix(
                Fix::suggested(phrase!("write `{only}`", only))
                    .replace(instr.mnemonic_span, only.as_str()),
            ),
            _ => diagnostic,
        }
    }
}

/// The row that a mnemonic would name if its prefix D or suffix P were taken away, with the form that these mean and
/// that the row does not have.
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
        let found = rungc_catalogue::find(rest?)?;
        let twice = wide && found.form.wide || pulse && found.form.pulse;
        let form = Form {
            wide: wide || found.form.wide,
            pulse: pulse || found.form.pulse,
        };
        let new = !twice && found.inst.spelling_of(form).is_none();
        new.then_some(Found { form, ..found })
    })
}

/// Returns true if an instruction begins, ends or names a part of the program, so that others are judged by it.
fn is_structural(inst: &Inst) -> bool {
    let named = matches!(inst.basic(), Some(Basic::Mc | Basic::Cj | Basic::Call));
    inst.drive == Drive::Alone || named
}
