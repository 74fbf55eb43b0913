//! Pages about an instruction on one model: `rungc explain ADD --model fx3u`.

use super::special::special_of;
use super::words::run_on;
use super::{FORMS, Support, driven, example, operands, support, title, width};
use crate::{Forms, Inst, Variant, When, find};
use rungc_models::runs::is_special;
use rungc_models::special::Status;
use rungc_models::{Model, ModelId, ModelSet, Plc, plc_errors};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// The page of an instruction on one PLC: its operands, forms and restrictions there, or that the PLC does not have it.
/// `None` if no instruction is called so.
pub fn explain_on(name: &str, plc: Plc) -> Option<String> {
    let name = name.to_ascii_uppercase();
    let found = find(&name)?;
    let (inst, model) = (found.inst, Model::get(plc.model));
    let mut page = format!("# {} on {}\n", title(inst), plc.title());
    if let Some(missing) = missing(inst, plc) {
        page += &missing;
        return Some(page);
    }
    let _ = writeln!(page, "\n{}", text_on(inst.text, model));
    if let Support::Refused(reason) = support(inst, plc.model) {
        let _ = writeln!(page, "\nIt cannot be compiled: {reason}.");
    }
    if !inst.has_form_on(found.form, plc.model) {
        let _ = writeln!(page, "\n{} does not have the form `{name}`.", plc.title());
    }
    let params = inst.params_of(&[], model);
    for section in [
        format!("\n## Operands\n{}", operands(params, &[model], Some(model))),
        outputs(inst, plc),
        by_first(inst, model),
        forms(inst, model),
        devices(inst, model),
        errors(inst, model),
        example(inst, plc.model),
        format!("\nSource: {}.\n", inst.source),
    ] {
        page += &section;
    }
    Some(page)
}

/// Outputs that send pulses on a variant, which may have fewer than its family.
fn outputs(inst: &Inst, plc: Plc) -> String {
    let params = inst.params_of(&[], Model::get(plc.model));
    let sends = params.iter().any(|param| param.sends_pulses);
    let Some(variant) = plc
        .variant
        .filter(|variant| sends && variant.pulse_outputs > 0)
    else {
        return String::new();
    };
    let last = DeviceClass::Y.number(variant.pulse_outputs - 1);
    format!("\nPulses leave {} at Y000 to {last}.\n", variant.title)
}

/// Says that a PLC does not have an instruction, and which models do; `None` if it has it.
fn missing(inst: &Inst, plc: Plc) -> Option<String> {
    let name = inst.name;
    let lacks = |plc: Plc| {
        plc.variant
            .is_some_and(|v| v.lacks.concat().contains(&name))
    };
    if inst.models.has(plc.model) && !lacks(plc) {
        return None;
    }
    let models = ModelId::ALL.into_iter().filter(|&id| inst.models.has(id));
    let models: Vec<_> = models.map(|id| Model::get(id).name).collect();
    let mut text = format!("\n{} does not have {name}.", plc.title());
    if let [first, ..] = models.as_slice() {
        let listed = models.join(", ");
        let _ = write!(
            text,
            " These models have it: {listed}.\n\n`rungc explain {name} --model {first}` shows it."
        );
    }
    Some(text + "\n")
}

/// A text without the sentences that hold on other models only: they begin with these models, or name special devices
/// without a meaning on this one.
fn text_on(text: &str, model: &Model) -> String {
    let holds = |sentence: &&str| {
        let models = subject(sentence);
        let of_others = models != ModelSet::NONE && !models.has(model.id);
        !of_others && specials(sentence).all(|name| special_of(name, model.id).is_some())
    };
    let kept: String = text.split_inclusive(". ").filter(holds).collect();
    kept.trim_end().to_owned()
}

/// Names of special devices in a text.
fn specials(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter(|word| {
        let (prefix, digits) = word.split_at(word.len().min(1));
        let number = digits.parse();
        DeviceClass::from_prefix(prefix)
            .zip(number.ok())
            .is_some_and(|(class, number)| is_special(class, number))
    })
}

/// The models with which a sentence begins: `On H1U and H2U …`, `HM: …`.
fn subject(sentence: &str) -> ModelSet {
    let words = sentence.split_whitespace().skip_while(|word| *word == "On");
    let mut models = ModelSet::NONE;
    for word in words {
        match models_called(word.trim_end_matches([',', ':'])) {
            Some(named) => models = models.or(named),
            None if word == "and" => {}
            None => break,
        }
    }
    models
}

fn models_called(word: &str) -> Option<ModelSet> {
    Some(match word {
        "H1U" => ModelSet::H1U,
        "H2U" => ModelSet::H2U,
        "L01S" => ModelSet::L01S,
        "HM" => ModelSet::HM,
        "FX1S" => ModelSet::FX1S,
        "FX2N" => ModelSet::FX2N,
        "FX3S" => ModelSet::FX3S,
        "FX3G" => ModelSet::FX3G,
        "FX3U" => ModelSet::FX3U,
        "FX3" => ModelSet::FX3,
        "FX" => ModelSet::FX,
        "compatible" | "FX3U-compatible" => ModelSet::COMPATIBLE,
        _ => return None,
    })
}

/// The forms of a model, with their steps.
fn forms(inst: &Inst, model: &Model) -> String {
    let mut text = "\n## Forms\n\n| written | width | steps |\n|---|---|---|\n".to_owned();
    for form in FORMS
        .into_iter()
        .filter(|&form| inst.has_form_on(form, model.id))
    {
        let Some(spelling) = inst.spelling_of(form) else {
            continue;
        };
        let steps = inst.steps_of(form, &[], model);
        let _ = writeln!(text, "| `{spelling}` | {} | {steps} |", width(form));
    }
    let others: Vec<_> = variants(inst, model)
        .filter(|variant| variant.params.is_none())
        .filter_map(|variant| Some((operand(variant, model)?, variant.steps?)))
        .collect();
    if !others.is_empty() {
        text += "\nOther numbers of steps, of which the first that fits counts:\n\n";
        for (operand, (narrow, wide)) in others {
            let _ = match narrow == wide || !inst.forms_on(model.id).has(Forms::W32) {
                true => writeln!(text, "- {operand}: {narrow}"),
                false => writeln!(text, "- {operand}: {narrow}, in the 32-bit form {wide}"),
            };
        }
    }
    text + &driven(inst)
}

fn variants(inst: &Inst, model: &Model) -> impl Iterator<Item = &'static Variant> {
    let id = model.id;
    inst.variants
        .iter()
        .filter(move |variant| variant.models.has(id))
}

/// Operands to which a variant applies on a model; `None` if the model has none, or it applies to all.
fn operand(variant: &Variant, model: &Model) -> Option<String> {
    let (classes, first, last) = match variant.when {
        When::Always => return None,
        When::Indexed => return Some("with an index register".to_owned()),
        When::First(classes, first, last) => (classes, first, last),
    };
    let classes = classes.without(model.missing());
    let names: Vec<_> = classes
        .names()
        .filter_map(|name| match DeviceClass::from_prefix(name) {
            Some(class) if first > 0 || last < u32::MAX => run_on(model, class, first, last),
            _ => Some(name.to_owned()),
        })
        .collect();
    (!names.is_empty()).then(|| names.join(", "))
}

/// The operands where they depend on what the first one is: `OUT T0 K30`.
fn by_first(inst: &Inst, model: &Model) -> String {
    let mut text = String::new();
    let mut seen = Vec::new();
    for variant in variants(inst, model) {
        let (Some(first), Some(params)) = (operand(variant, model), variant.params) else {
            continue;
        };
        // Later variants for the same operands never hold.
        if seen.contains(&first) {
            continue;
        }
        seen.push(first.clone());
        let steps = variant.steps.map(|(steps, _)| format!(" ({steps} steps)"));
        let steps = steps.unwrap_or_default();
        let _ = writeln!(text, "\nIf the first operand is {first}{steps}:");
        text += &operands(params, &[model], Some(model));
    }
    text
}

/// Special devices of the model that the instruction reads or writes.
fn devices(inst: &Inst, model: &Model) -> String {
    let mut text = String::new();
    for flag in inst.flags_on(model.id) {
        let Some((row, number)) = special_of(flag, model.id) else {
            continue;
        };
        let names = match row.status {
            Status::Instructions(names) => names,
            _ => "",
        };
        let mut names = names
            .split(", ")
            .filter(|name| find(name).is_some())
            .peekable();
        if names.peek().is_none() || names.any(|name| name == inst.name) {
            let _ = writeln!(text, "- {flag}: {}", row.meaning(number));
        }
    }
    section("Special devices", &text)
}

/// Errors of the model that the instruction can cause.
fn errors(inst: &Inst, model: &Model) -> String {
    let mut text = String::new();
    let codes = super::errors(inst, model).into_iter();
    let mut codes: Vec<u16> = codes.filter_map(|code| code_on(code, model)).collect();
    codes.sort_unstable();
    codes.dedup();
    for code in codes {
        if let Some(error) = plc_errors::find(code, model.id) {
            let _ = writeln!(text, "- {code}: {}", error.title);
        }
    }
    section("Errors", &text)
}

/// The code of a model for what H1U and H2U give this code.
fn code_on(code: u16, model: &Model) -> Option<u16> {
    let like_h = ModelSet::INOVANCE.has(model.id);
    match code {
        6707 => Some(model.value_error),
        super::UNREACHED if like_h => Some(6750),
        6770 if !like_h => Some(6764),
        6771 if !like_h => None,
        _ => Some(code),
    }
}

fn section(title: &str, lines: &str) -> String {
    match lines.is_empty() {
        true => String::new(),
        false => format!("\n## {title}\n\n{lines}"),
    }
}
