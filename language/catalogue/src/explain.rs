//! Pages and tables that are made from the catalogue: `rungc explain ADD`, and the tables of the documentation.

mod example;
mod one_model;
mod special;
mod words;

pub use one_model::explain_on;
pub use special::special_table;
pub use words::meaning;

use super::{Classes, Drive, Forms, Inst, Lower, Param, When, all, find};
use crate::Form;
use crate::row::{SOURCE_BITS, WORDS};
use rungc_models::{Model, ModelId, ModelSet};
use special::{special_of, special_page};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::RangeInclusive;

/// The page of an instruction, in Markdown: operands, forms, steps, flags, errors, models, an example; or of a special
/// device (`M8029`). `None` if nothing is called so.
pub fn explain(name: &str) -> Option<String> {
    let name = name.to_ascii_uppercase();
    let Some(found) = find(&name) else {
        return special_page(&name);
    };
    let inst = found.inst;
    let model = inst.usual_model();
    let params = inst.params_of(&[], Model::get(model));
    let mut page = format!("# {}\n\n{}\n", title(inst), inst.text);
    for section in [
        format!(
            "\n## Operands\n{}",
            operands(params, &sharing(inst, params), None)
        ),
        by_first(inst, model),
        forms(inst, model),
        differences(inst, model),
        devices(inst, model),
        models(inst),
        example(inst, model),
        format!("\nSource: {}.\n", inst.source),
    ] {
        page.push_str(&section);
    }
    Some(page)
}

/// Name, title and number of an instruction.
fn title(inst: &Inst) -> String {
    let fnc = inst.fnc.map(|fnc| format!(" (FNC {fnc})"));
    format!("{}: {}{}", inst.name, inst.title, fnc.unwrap_or_default())
}

/// The models on which an instruction has these operands.
fn sharing(inst: &Inst, params: &'static [Param]) -> Vec<&'static Model> {
    ModelId::ALL
        .into_iter()
        .filter(|&id| inst.models.has(id))
        .map(Model::get)
        .filter(|model| std::ptr::eq(inst.params_of(&[], model), params))
        .collect()
}

/// The table of operands, with the classes that any of the models accepts; `only` is the model of a page about one.
fn operands(params: &[Param], models: &[&Model], only: Option<&Model>) -> String {
    if params.is_empty() {
        return "\nNone.\n".to_owned();
    }
    let mut text = "\n| name | accepts | meaning |\n|---|---|---|\n".to_owned();
    let mut differ = Classes::NONE;
    for param in params {
        let of = |model: &&Model| param.classes_on(model);
        let any = models.iter().map(of).fold(Classes::NONE, Classes::or);
        for model in models {
            differ = differ.or(any.without(param.classes_on(model)));
        }
        let classes: Vec<_> = any.names().collect();
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| {} | {} | {} |",
            param.name,
            classes.join(" "),
            meaning(param, params, only)
        );
    }
    if !differ.is_empty() {
        let names: Vec<_> = differ.names().collect();
        let _ = writeln!(text, "\nNot on every model: {}.", names.join(", "));
    }
    text
}

const FORMS: [Form; 4] = [
    Form {
        wide: false,
        pulse: false,
    },
    Form {
        wide: false,
        pulse: true,
    },
    Form {
        wide: true,
        pulse: false,
    },
    Form {
        wide: true,
        pulse: true,
    },
];

fn forms(inst: &Inst, model: ModelId) -> String {
    let mut text = "\n## Forms\n\n| written | width | steps |\n|---|---|---|\n".to_owned();
    for form in FORMS {
        if !inst.has_form_on(form, model) {
            continue;
        }
        let Some(spelling) = inst.spelling_of(form) else {
            continue;
        };
        let steps = inst.steps_of(form, &[], Model::get(model));
        let _ = writeln!(text, "| `{spelling}` | {} | {steps} |", width(form));
    }
    text + &driven(inst)
}

/// Place of an instruction in a rung, and in how many it may stand.
fn driven(inst: &Inst) -> String {
    let place = match inst.drive {
        Drive::Logic => "Part of the contact logic.",
        Drive::Contact => "Must be driven by a contact.",
        Drive::Alone => "Must not be driven by a contact.",
    };
    let mut text = format!("\n{place}\n");
    if inst.stops_undriven {
        text.push_str("It must stay driven until it has ended: it stops when its contacts open.\n");
    }
    if let Some(uses) = inst.max_uses {
        let _ = writeln!(text, "A program may use it at most {uses} times.");
    }
    text
}

/// Width of a form, and when it is executed.
fn width(form: Form) -> &'static str {
    match (form.wide, form.pulse) {
        (false, false) => "16 bits",
        (false, true) => "16 bits, once per rising edge",
        (true, false) => "32 bits",
        (true, true) => "32 bits, once per rising edge",
    }
}

/// The operands where they depend on what the first one is: `OUT T0 K30`.
fn by_first(inst: &Inst, model: ModelId) -> String {
    let mut text = String::new();
    for variant in inst.variants.iter().filter(|v| v.models.has(model)) {
        let (When::First(classes, first, last), Some(params)) = (variant.when, variant.params)
        else {
            continue;
        };
        let names: Vec<_> = classes.names().collect();
        let mut numbers = String::new();
        if first > 0 {
            let _ = write!(numbers, " from {first}");
        }
        if last < u32::MAX {
            let _ = write!(numbers, " up to {last}");
        }
        let _ = writeln!(
            text,
            "\nIf the first operand is {}{numbers}:",
            names.join(" ")
        );
        text.push_str(&operands(params, &[Model::get(model)], None));
    }
    text
}

/// The operands on models where they are others than those of the page.
fn differences(inst: &Inst, shown: ModelId) -> String {
    let mut seen = vec![inst.params_of(&[], Model::get(shown))];
    let mut text = String::new();
    for id in ModelId::ALL.into_iter().filter(|&id| inst.models.has(id)) {
        let params = inst.params_of(&[], Model::get(id));
        if seen.iter().any(|known| std::ptr::eq(*known, params)) {
            continue;
        }
        seen.push(params);
        let models = sharing(inst, params);
        let names: Vec<_> = models.iter().map(|model| model.name).collect();
        let _ = writeln!(text, "\nOperands on {}:", names.join(", "));
        text.push_str(&operands(params, &models, None));
    }
    text
}

/// Special devices and errors.
fn devices(inst: &Inst, model: ModelId) -> String {
    let mut text = String::new();
    if !inst.flags.is_empty() {
        text.push_str("\n## Special devices\n\n");
        for flag in inst.flags {
            let meaning = special_of(flag, model).map(|(row, number)| row.meaning(number));
            let meaning = meaning.unwrap_or_default();
            let _ = writeln!(text, "- {flag}{}: {meaning}", without(inst, flag));
        }
    }
    let errors = errors_by_model(inst);
    if !errors.is_empty() {
        text.push_str("\n## Errors\n\n");
        let having = ModelId::ALL.iter().filter(|&&id| inst.models.has(id));
        let all = having.count();
        for (code, models) in errors {
            let _ = write!(text, "- {code}: {}", error_title(code));
            if models.len() < all {
                let _ = write!(text, " (only on {})", models.join(", "));
            }
            text.push('\n');
        }
    }
    text
}

/// Errors that an instruction can cause, by the codes of H1U and H2U, and the models on which it does.
fn errors_by_model(inst: &Inst) -> BTreeMap<u16, Vec<&'static str>> {
    let mut found: BTreeMap<u16, Vec<&str>> = BTreeMap::new();
    for id in ModelId::ALL.into_iter().filter(|&id| inst.models.has(id)) {
        let model = Model::get(id);
        for code in errors(inst, model) {
            found.entry(code).or_default().push(model.name);
        }
    }
    found
}

/// A module that cannot be reached: the code of FX and L01S, since 6750 is also one of auto tuning.
const UNREACHED: u16 = 6708;

/// Codes of PID that not all models have: FX tunes by itself, FX3 looks at limits and alarms, too; L01S and HM compute
/// otherwise.
const OF_SOME_MODELS: [(RangeInclusive<u16>, ModelSet); 5] = [
    (6733..=6736, ModelSet::ALL.without(ModelSet::L01S)),
    (6740..=6740, ModelSet::FX.or(ModelSet::INOVANCE)),
    (6742..=6747, ModelSet::FX.or(ModelSet::INOVANCE)),
    (6748..=6749, ModelSet::FX3),
    (6750..=6751, ModelSet::FX),
];

/// Errors that an instruction can cause on a model, by the codes of H1U and H2U but for [`UNREACHED`]: those of its
/// row, and those of operands that an index register leads out of the device range or that are in a module.
fn errors(inst: &Inst, model: &Model) -> Vec<u16> {
    let mut codes = inst.errors.to_vec();
    codes.retain(|code| {
        let mut some = OF_SOME_MODELS.iter();
        some.all(|(codes, models)| !codes.contains(code) || models.has(model.id))
    });
    for param in inst.params_of(&[], model) {
        let classes = param.classes_on(model);
        if param.indexable && classes.meets(WORDS.or(SOURCE_BITS)) {
            codes.push(6706);
        }
        if classes.meets(Classes::BUFFER) {
            codes.push(UNREACHED);
        }
    }
    codes.sort_unstable();
    codes.dedup();
    codes
}

/// The models of an instruction that do not use one of its special devices, in parentheses.
fn without(inst: &Inst, flag: &str) -> String {
    let models = ModelId::ALL.into_iter().filter(|&id| inst.models.has(id));
    let without = models.filter(|&id| inst.flags_on(id).all(|used| used != flag));
    let names: Vec<_> = without.map(|id| Model::get(id).name).collect();
    match names.as_slice() {
        [] => String::new(),
        names => format!(" (not on {})", names.join(", ")),
    }
}

/// Titles of the PLC's error codes that instructions raise (h1u-h2u-programming §8.2).
fn error_title(code: u16) -> &'static str {
    match code {
        6376 | 6377 => "the port or its range is wrong",
        6605 | 6625..=6627 => "the step program is wrong",
        6607 => "FOR and NEXT do not pair",
        6608 | 6623 | 6624 => "MC and MCR do not pair",
        6701 => "the target of a jump or call is missing",
        6702 => "calls are nested too deep",
        6706 => "an operand lies outside the device range, or a value is outside what is allowed",
        6707 => "a value is outside what is allowed",
        6730..=6739 => "a PID parameter is wrong; the control stops",
        6740 => "the sampling time of PID is not longer than a scan; the control continues",
        6742..=6747 => "a value of PID is beyond 16 bits and held there; the control continues",
        6748 | 6749 => "limits or alarms of PID are wrong; the control continues",
        6750 => "auto tuning of PID has no result",
        6751 => "auto tuning of PID finds the wrong direction, and continues",
        UNREACHED => "the module cannot be reached; on H1U and H2U 6750",
        6760 => "too many comparisons of high-speed counters",
        6770 | 6771 => "the pulse output is in use or wrong; on FX and L01S 6764: it is in use",
        _ => "see the manual",
    }
}

fn models(inst: &Inst) -> String {
    let mut text = "\n## Models\n\n| model | |\n|---|---|\n".to_owned();
    for id in ModelId::ALL {
        let state = match support(inst, id) {
            Support::Works => "works".to_owned(),
            Support::Refused(reason) => format!("no: {reason}"),
            Support::Absent => "–".to_owned(),
        };
        let _ = writeln!(text, "| {} | {state} |", Model::get(id).name);
    }
    text
}

fn example(inst: &Inst, model: ModelId) -> String {
    format!(
        "\n## Example\n\n```\n{}\n```\n",
        inst.example_on(Model::get(model))
    )
}

enum Support {
    Works,
    Refused(&'static str),
    Absent,
}

fn support(inst: &Inst, model: ModelId) -> Support {
    match inst.lower_on_model(model) {
        _ if !inst.models.has(model) => Support::Absent,
        Lower::Todo(reason) => Support::Refused(reason),
        _ => Support::Works,
    }
}

/// Table of instructions and models, in Markdown: ✓ works, a number: it cannot be compiled, for the reason given below,
/// – the model has none.
pub fn support_table() -> String {
    let mut reasons: Vec<&str> = Vec::new();
    let mut text = "| instruction | FNC | |".to_owned();
    for id in ModelId::ALL {
        let _ = write!(text, " {} |", Model::get(id).name);
    }
    text.push_str("\n|---|---|---|");
    text.push_str(&":-:|".repeat(ModelId::ALL.len()));
    text.push('\n');
    for inst in all() {
        let fnc = inst.fnc.map_or(String::new(), |fnc| format!("{fnc:02}"));
        let _ = write!(text, "| `{}` | {fnc} | {} |", inst.name, inst.title);
        for id in ModelId::ALL {
            match support(inst, id) {
                Support::Works => text.push_str(" ✓ |"),
                Support::Absent => text.push_str(" – |"),
                Support::Refused(reason) => {
                    let known = reasons.iter().position(|one| *one == reason);
                    let number = known.unwrap_or_else(|| {
                        reasons.push(reason);
                        reasons.len() - 1
                    });
                    let _ = write!(text, " {} |", number + 1);
                }
            }
        }
        text.push('\n');
    }
    text.push('\n');
    for (number, reason) in reasons.iter().enumerate() {
        let _ = writeln!(text, "{}. No: {reason}.", number + 1);
    }
    text
}

impl Inst {
    /// Returns true if it has a form on a model.
    pub(crate) fn has_form_on(&self, form: Form, model: ModelId) -> bool {
        let forms = self.forms_on(model);
        let width = if form.wide { Forms::W32 } else { Forms::W16 };
        forms.has(width) && (!form.pulse || forms.has(Forms::PULSE))
    }

    /// The model that its page shows: H2U, or the first that has it.
    fn usual_model(&self) -> ModelId {
        [ModelId::H2u, ModelId::Fx3u]
            .into_iter()
            .chain(ModelId::ALL)
            .find(|&id| self.models.has(id))
            .unwrap_or(ModelId::Fx3u)
    }
}
