//! Pages about codes of diagnostics, error codes of a PLC, instructions, special devices and models, as
//! `rungc explain` prints them.

mod proposals;

pub use proposals::unknown;

use crate::language::{self, Language, message};
use rungc_models::plc_errors::{self, PlcError, of_check};
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId, ModelSet, Plc, VARIANTS, Variant};
use rungc_syntax::DeviceClass;
use rungc_syntax::codes::{self, Code};
use std::fmt::Write;

/// The page of a topic: a code of diagnostics or its name, an error code of the PLC, an instruction, a special device,
/// a model or a variant of one. With a PLC, what it has of that; else what all models have. Only codes have pages in
/// other languages than English.
pub fn page(topic: &str, plc: Option<Plc>, language: Language) -> Option<String> {
    let lower = topic.trim().to_lowercase();
    let topic = topic.trim().to_uppercase();
    let instruction = || match plc {
        Some(plc) => rungc_catalogue::explain_on(&topic, plc),
        None => None,
    };
    codes::find(&lower)
        .map(|code| code_page(code, plc, language))
        .or_else(|| plc_error_page(topic.parse().ok()?, plc.map(|plc| plc.model)))
        .or_else(|| special_page(&topic, plc?))
        .or_else(|| Variant::find(&topic).map(variant_page))
        .or_else(|| ModelId::from_name(&topic).map(model_page))
        .or_else(instruction)
        .or_else(|| rungc_catalogue::explain(&topic))
}

fn code_page(code: &'static Code, plc: Option<Plc>, language: Language) -> String {
    let (title, text) = (
        language::title(language, code),
        language::text(language, code),
    );
    let arguments = [
        ("code", code.id.into()),
        ("name", code.name.into()),
        ("title", title.as_ref().into()),
    ];
    let mut page = format!("{}\n\n{text}\n", message(language, "page", &arguments));
    if let Some(number) = number_of_plc(code, plc, language) {
        let _ = write!(page, "\n{number}\n");
    }
    let indented = |il: &str| {
        il.trim()
            .lines()
            .map(|line| format!("    {}\n", line.trim_end()))
            .collect::<String>()
    };
    for (id, il) in [("wrong", code.wrong), ("right", code.right)] {
        if !il.is_empty() {
            let title = message(language, id, &[]);
            let (id, model) = match code.model {
                Some(model) => ("example-of-model", model),
                None => ("example", ""),
            };
            let arguments = [("title", (&title).into()), ("model", model.into())];
            let heading = message(language, id, &arguments);
            let _ = write!(page, "\n{heading}\n\n{}", indented(il));
        }
    }
    page
}

/// Sentence with the number under which a PLC, or PLCs of two families, report what a code is about.
fn number_of_plc(code: &Code, plc: Option<Plc>, language: Language) -> Option<String> {
    let stated = code.plc_error?;
    let on = |id| of_check(code.id, stated, Model::get(id));
    let (id, number, other) = match plc {
        Some(plc) => ("plc-error", on(plc.model)?, None),
        None => match (on(ModelId::H2u), on(ModelId::Fx3u)) {
            (Some(here), Some(there)) if here != there => ("plc-errors", here, Some(there)),
            (None, Some(there)) => ("plc-error-of-fx", there, None),
            (Some(_), _) | (None, None) => ("plc-error", stated, None),
        },
    };
    let other = other.map(|number| number.to_string()).unwrap_or_default();
    let number = number.to_string();
    let arguments = [("number", (&number).into()), ("other", (&other).into())];
    Some(message(language, id, &arguments))
}

/// The page of an error code of the PLC: its meaning on one or all models, and which diagnostics prevent it.
fn plc_error_page(number: u16, model: Option<ModelId>) -> Option<String> {
    let mut errors: Vec<&PlcError> = plc_errors::all_of(number).collect();
    let elsewhere = model.is_some_and(|id| !errors.iter().any(|error| error.models.has(id)));
    if let Some(id) = model.filter(|_| !elsewhere) {
        errors.retain(|error| error.models.has(id));
    }
    let codes: Vec<&Code> = codes::all()
        .into_iter()
        .filter(|code| reports(code, number, model))
        .collect();
    let mut page = String::new();
    if let Some(id) = model.filter(|_| elsewhere) {
        let title = Model::get(id).title;
        let _ = writeln!(page, "{title} has no error {number}.");
    }
    for error in &errors {
        if !page.is_empty() {
            page.push('\n');
        }
        page.push_str(&meaning(error, model.filter(|_| !elsewhere)));
    }
    if errors.is_empty() {
        if codes.is_empty() {
            return None;
        }
        let _ = writeln!(page, "PLC error {number}\n\n{NEVER_RAISED}");
    }
    if !codes.is_empty() {
        page.push_str("\nrungc reports it before the program runs as:\n\n");
        for code in codes {
            let _ = writeln!(page, "    {} ({}): {}", code.id, code.name, code.title);
        }
    }
    Some(page)
}

/// Returns true if a model, or any model, has this number for what a check finds.
fn reports(code: &Code, number: u16, model: Option<ModelId>) -> bool {
    let Some(stated) = code.plc_error else {
        return false;
    };
    let on = |id: ModelId| of_check(code.id, stated, Model::get(id)) == Some(number);
    match model {
        Some(id) => on(id),
        None => ModelId::ALL.into_iter().any(on),
    }
}

/// Codes of parameters, syntax and circuit.
const OF_CHECKS: std::ops::Range<u16> = 6400..6700;
const NEVER_RAISED: &str = "The PLC reports it when a program is checked or written to it, \
                            so compiled programs never raise it.";

/// Meaning of an error code, with the model asked for or all models that share it.
fn meaning(error: &PlcError, model: Option<ModelId>) -> String {
    let of = ModelId::ALL.into_iter().filter(|&id| match model {
        Some(asked) => id == asked,
        None => error.models.has(id),
    });
    let all = error.models == ModelSet::ALL && model.is_none();
    let names: Vec<_> = of.map(|id| Model::get(id).name).collect();
    let on = match all {
        true => String::new(),
        false => format!(" on {}", names.join(", ")),
    };
    let mut text = format!("PLC error {}{on}: {}\n", error.code, error.title);
    if !error.meaning.is_empty() {
        let (meaning, remedy) = (error.meaning, error.remedy);
        let _ = write!(text, "\n{meaning}\n\nWhat to do: {remedy}\n");
    }
    if OF_CHECKS.contains(&error.code) {
        let _ = write!(text, "\n{NEVER_RAISED}\n");
    }
    text
}

/// Devices of a model, and where the book has more.
fn model_page(id: ModelId) -> String {
    let model = Model::get(id);
    let (name, steps) = (model.name, model.max_steps);
    let mut page = format!(
        "{name}: {}\n\nAt most {steps} steps, and these devices:\n\n",
        model.title
    );
    for range in model.ranges {
        let (first, last) = (
            range.class.number(range.first),
            range.class.number(range.last),
        );
        let special = is_special(range.class, range.first);
        let kind = match (special, range.latched) {
            (true, _) => ", special",
            (false, true) => ", latched",
            (false, false) => "",
        };
        let _ = match range.first == range.last {
            true => writeln!(page, "    {first}{kind}"),
            false => writeln!(page, "    {first} to {last}{kind}"),
        };
    }
    let variants: Vec<_> = VARIANTS
        .iter()
        .filter(|variant| variant.model == id)
        .map(|v| v.name)
        .collect();
    if !variants.is_empty() {
        let _ = writeln!(
            page,
            "\nPLCs of this model that have less: {}",
            variants.join(", ")
        );
    }
    let _ = writeln!(
        page,
        "\nInstructions: `rungc book instructions/support`. Special devices: `rungc book special-devices/{name}`."
    );
    page
}

/// Features missing from a variant or base unit.
fn variant_page(variant: &Variant) -> String {
    let family = Model::get(variant.model);
    let mut page = format!(
        "{}: a PLC of the family {} ({})\n",
        variant.title, family.title, family.name
    );
    let terminals = [
        (DeviceClass::X, variant.inputs),
        (DeviceClass::Y, variant.outputs),
    ];
    for (class, count) in terminals {
        if let Some(count) = count {
            let (first, last) = (class.number(0), class.number(count - 1));
            let _ = write!(page, "\n{first} to {last}");
        }
    }
    let last = DeviceClass::Y.number(variant.pulse_outputs - 1);
    let _ = writeln!(page, "\nPulse outputs: Y000 to {last}");
    if variant.no_direction > 0 {
        let first = DeviceClass::Y.number(variant.no_direction);
        let _ = writeln!(page, "Outputs of their direction: from {first} on");
    }
    let lacks = variant.lacks.concat().join(" ");
    if !lacks.is_empty() {
        let _ = writeln!(
            page,
            "\nIt does not have these instructions of its family:\n    {lacks}"
        );
    }
    if !variant.lacks_devices.is_empty() {
        page += "\nIt does not have these devices:\n";
        for &(class, first, last) in variant.lacks_devices {
            let (begin, end) = (class.number(first), class.number(last));
            let _ = match first == last {
                true => writeln!(page, "    {begin}"),
                false => writeln!(page, "    {begin} to {end}"),
            };
        }
    }
    let _ = writeln!(page, "\nSource: {}", variant.source);
    page
}

/// Meaning of a special device on one PLC, or that it has none.
fn special_page(topic: &str, plc: Plc) -> Option<String> {
    let (class, number) = proposals::device(topic)?;
    let (model, title) = (Model::get(plc.model), plc.title());
    let device = class.number(number);
    let lacks = plc.variant.is_some_and(|variant| {
        let mut lacks = variant.lacks_devices.iter();
        lacks.any(|&(of, first, last)| of == class && (first..=last).contains(&number))
    });
    if let Some(special) = model.special(class, number).filter(|_| !lacks) {
        return Some(format!(
            "{device} on {title}: {}",
            crate::index::describe(special, number)
        ));
    }
    if !is_special(class, number) {
        return None;
    }
    let missing = match model.has(class, number) && !lacks {
        true => format!("{device} has no meaning on {title}; `rungc check` warns of it (W0302)"),
        false => format!("{device} does not exist on {title}"),
    };
    Some(match rungc_catalogue::explain(topic) {
        Some(others) => format!("{missing}. Other models:\n\n{others}"),
        None => format!(
            "{missing}{}",
            proposals::near_special(class, number, Some(plc))
        ),
    })
}
