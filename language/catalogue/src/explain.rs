//! Pages and tables that are made from the catalogue: `rungc explain ADD`, and the tables of the documentation.

use super::{
    Classes, Drive, Extent, Forms, Inst, Limits, Lower, Param, Role, Rule, Shape, When, all, find,
};
use crate::Form;
use rungc_models::special::{self, Access, Status};
use rungc_models::{Model, ModelId};
use rungc_syntax::DeviceClass;
use std::fmt::Write;

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
    let fnc = inst
        .fnc
        .map_or(String::new(), |fnc| format!(" (FNC {fnc})"));
    let mut page = format!("# {}: {}{fnc}\n\n{}\n", inst.name, inst.title, inst.text);
    for section in [
        format!(
            "\n## Operands\n{}",
            operands(params, &sharing(inst, params))
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

/// Meanings of a special device on each model that has it.
fn special_page(name: &str) -> Option<String> {
    let rows: Vec<_> = ModelId::ALL
        .into_iter()
        .filter_map(|id| Some((Model::get(id).name, special_of(name, id)?)))
        .collect();
    let (_, first) = rows.first()?;
    let number: u32 = name.get(1..)?.parse().ok()?;
    let mut page = format!(
        "# {}\n\n| model | access | at power-on | meaning | |\n|---|---|--:|---|---|\n",
        first.class.number(number)
    );
    for (model, row) in &rows {
        let _ = writeln!(page, "| {model} | {}", special_cells(row));
    }
    Some(page)
}

/// The cells of a table's row that describe a special device.
fn special_cells(row: &special::Special) -> String {
    let access = match row.access {
        Access::Read => "read".to_owned(),
        Access::ReadWrite => "read, write".to_owned(),
        Access::ReadUnless(role) => {
            format!("read; write while COM{} is {}", role.port, role.title)
        }
    };
    let status = match row.status {
        Status::Scan => "works".to_owned(),
        Status::Instructions(names) => format!("works with {names}"),
        Status::Modules(_) | Status::Module(_) => {
            "works with modules that rungc.toml lists".to_owned()
        }
        Status::Inert(reason) => format!("not simulated: {}", reason.text),
    };
    let (default, meaning) = (row.default, row.meaning);
    format!("{access} | {default} | {meaning} | {status} |")
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

/// The table of operands, with the classes that any of the models accepts.
fn operands(params: &[Param], models: &[&Model]) -> String {
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
            meaning(param, params)
        );
    }
    if !differ.is_empty() {
        let names: Vec<_> = differ.names().collect();
        let _ = writeln!(text, "\nNot on every model: {}.", names.join(", "));
    }
    text
}

/// Meaning of an operand, its use, and its rules.
fn meaning(param: &Param, params: &[Param]) -> String {
    let thing = match param.shape {
        Shape::Bit => "bit",
        Shape::Value => "16 or 32 bits",
        Shape::Word => "16 bits",
        Shape::Pair => "32 bits",
        Shape::Float => "float",
        Shape::Text => "text",
        Shape::Pointer => "pointer",
        Shape::Mixed => "bit or word",
    };
    let role = match param.role {
        Role::Read => "source",
        Role::Write => "destination",
        Role::ReadWrite => "source and destination",
    };
    let name = |i: usize| params.get(i).map_or("", |param| param.name);
    let mut text = format!("{thing}, {role}");
    match param.extent {
        Extent::One => {}
        Extent::Count(count) => text += &format!("; {count} devices starting with it"),
        Extent::Between { least, most } => {
            text +=
                &format!("; {least} to {most} devices starting with it, depending on its settings")
        }
        Extent::Operand { i, extra: 0 } => {
            text += &format!("; {} devices starting with it", name(i))
        }
        Extent::Operand { i, extra } => {
            text += &format!("; {} + {extra} devices starting with it", name(i))
        }
        Extent::Through(i) => text += &format!("; up to {}", name(i)),
        Extent::Of(_) => text += "; more devices starting with it, depending on the operands",
        Extent::Bits(_) => {
            text += "; more bits starting with it, depending on the operands, or one word"
        }
    }
    if param.limits != Limits::None {
        text += &format!("; {}", param.limits.in_words(""));
    }
    for rule in param.rules {
        text += &match *rule {
            Rule::WideLimits(min, max) => format!("; in the 32-bit form, {min} to {max}"),
            Rule::Not(min, max) => format!("; not {min} to {max}"),
            Rule::WorksWith(min, i64::MAX) => format!("; fails below {min}"),
            Rule::WorksWith(min, max) => format!("; fails outside {min} to {max}"),
            Rule::WorksAbove(bound) => format!("; fails unless above {bound}"),
            Rule::WordWorksTo(i, max) => format!("; fails above {max} if {} is a word", name(i)),
            Rule::WorksFrom(i) => format!("; fails below {}", name(i)),
            Rule::MultipleOf(of) => format!("; a multiple of {of}"),
            Rule::AtMost(i) => format!("; at most {}", name(i)),
            Rule::AtLeast(i) => format!("; at least {}", name(i)),
            Rule::Below(i) => format!("; below {}", name(i)),
            Rule::EndsInZero => "; its number ends in 0".to_owned(),
            Rule::Aligned(of) => format!("; its number is a multiple of {of}"),
            Rule::WholeGroup => "; a group has K4, in the 32-bit form K8".to_owned(),
            Rule::GroupAligned(of) => format!("; a group starts at a multiple of {of}"),
            Rule::WideAligned(of) => {
                format!("; in the 32-bit form, a group starts at a multiple of {of}")
            }
            Rule::SameDigits(i) => format!("; a group has as many digits as {}", name(i)),
            Rule::GroupLike(i) => format!("; a group if and only if {} is one", name(i)),
            Rule::WordsWith(i) => format!("; a group has K4 unless {} is one", name(i)),
            Rule::GroupAtMost(i, max) => format!("; at most {max} if {} is a group", name(i)),
            Rule::NotBefore(i) => format!("; not before {}", name(i)),
            Rule::ClassLike(i) => format!("; of the same class as {}", name(i)),
            Rule::Holds(_, demand) | Rule::Suits(_, demand) => format!("; {demand}"),
            Rule::WideCounter => "; in the 32-bit form, C200 and up".to_owned(),
            Rule::WideNot(classes) => {
                let names: Vec<_> = classes.names().collect();
                format!("; in the 32-bit form, not {}", names.join(" "))
            }
        };
    }
    if param.sends_pulses {
        text += "; it sends pulses";
    }
    for &(class, first, last) in param.numbers {
        text += &format!("; {}–{}", class.number(first), class.number(last));
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
        let width = match form {
            Form {
                wide: false,
                pulse: false,
            } => "16 bits",
            Form {
                wide: false,
                pulse: true,
            } => "16 bits, once per rising edge",
            Form {
                wide: true,
                pulse: false,
            } => "32 bits",
            Form {
                wide: true,
                pulse: true,
            } => "32 bits, once per rising edge",
        };
        let steps = inst.steps_of(form, &[], Model::get(model));
        let _ = writeln!(text, "| `{spelling}` | {width} | {steps} |");
    }
    text.push_str(match inst.drive {
        Drive::Logic => "\nPart of the contact logic.\n",
        Drive::Contact => "\nMust be driven by a contact.\n",
        Drive::Alone => "\nMust not be driven by a contact.\n",
    });
    if inst.stops_undriven {
        text.push_str("It must stay driven until it has ended: it stops when its contacts open.\n");
    }
    if let Some(uses) = inst.max_uses {
        let _ = writeln!(text, "A program may use it at most {uses} times.");
    }
    text
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
        text.push_str(&operands(params, &[Model::get(model)]));
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
        text.push_str(&operands(params, &models));
    }
    text
}

/// Special devices and errors.
fn devices(inst: &Inst, model: ModelId) -> String {
    let mut text = String::new();
    if !inst.flags.is_empty() {
        text.push_str("\n## Special devices\n\n");
        for flag in inst.flags {
            let meaning = special_of(flag, model).map_or("", |row| row.meaning);
            let _ = writeln!(text, "- {flag}{}: {meaning}", without(inst, flag));
        }
    }
    if !inst.errors.is_empty() {
        text.push_str("\n## Errors\n\n");
        for code in inst.errors {
            let _ = writeln!(text, "- {code}: {}", error_title(*code));
        }
    }
    text
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

fn special_of(name: &str, model: ModelId) -> Option<&'static special::Special> {
    let class = DeviceClass::from_prefix(name.get(..1)?)?;
    Model::get(model).special(class, name.get(1..)?.parse().ok()?)
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
        6705 => "an operand is not a suitable device",
        6706 => "an operand lies outside the device range, or a value is outside what is allowed",
        6707 => "a value is outside what is allowed",
        6709 => "the module cannot be reached",
        6730..=6739 => "a PID parameter is wrong; the control stops",
        6740..=6749 => "a PID parameter is wrong; the control continues",
        6760 => "too many comparisons of high-speed counters",
        6770 | 6771 => "the pulse output is in use or wrong",
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

/// The special relays and registers of a model, in Markdown.
pub fn special_table(model: ModelId) -> String {
    let mut text =
        "| device | access | at power-on | meaning | |\n|---|---|--:|---|---|\n".to_owned();
    let mut rows: Vec<_> = Model::get(model).specials().collect();
    rows.sort_by_key(|row| (row.class, row.first));
    for row in rows {
        let first = row.class.number(row.first);
        let device = match row.first == row.last {
            true => first.to_string(),
            false => format!("{first}–{}", row.class.number(row.last)),
        };
        let _ = writeln!(text, "| {device} | {}", special_cells(row));
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

    /// A small program that shows it on a model.
    pub fn example_on(&self, model: &Model) -> String {
        if let Some(example) = self.example {
            return example.to_owned();
        }
        let form = FORMS
            .into_iter()
            .find(|&form| self.has_form_on(form, model.id));
        let spelling = form.and_then(|form| self.spelling_of(form));
        let mut line = spelling.unwrap_or_else(|| self.name.to_owned());
        let mut next = Next::default();
        for param in self.params_of(&[], model) {
            line.push(' ');
            line.push_str(&next.operand(param, model));
        }
        match self.drive {
            Drive::Contact => format!("LD X000\n{line}"),
            Drive::Alone => line,
            Drive::Logic if self.name.starts_with("LD") => format!("{line}\nOUT Y000"),
            Drive::Logic => format!("LD X000\n{line}\nOUT Y000"),
        }
    }
}

/// The next devices that an example takes, so that its operands do not overlap.
#[derive(Default)]
struct Next {
    registers: u32,
    relays: u32,
}

impl Next {
    /// An operand that a parameter accepts.
    fn operand(&mut self, param: &Param, model: &Model) -> String {
        if let Some(&(class, first, _)) =
            param.numbers_on(model).iter().find(|(class, first, _)| {
                model.has(*class, *first) && *first != 0 || *class == DeviceClass::Y
            })
        {
            return class.number(first).to_string();
        }
        let classes = param.classes_on(model);
        if param.limits != Limits::None && classes.meets(Classes::K) {
            return constant(param);
        }
        let first_data = if model.has(DeviceClass::R, 99) && !model.has(DeviceClass::R, 100) {
            1000
        } else {
            0
        };
        const ORDER: [(Classes, &str); 10] = [
            (Classes::D, "D"),
            (Classes::M, "M"),
            (Classes::X, "X000"),
            (Classes::Y, "Y000"),
            (Classes::S, "S20"),
            (Classes::C, "C0"),
            (Classes::T, "T0"),
            (Classes::R, "R0"),
            (Classes::KNX, "K4X000"),
            (Classes::KNM, "K4M0"),
        ];
        let found = ORDER.iter().find(|(class, _)| classes.meets(*class));
        match found {
            Some((_, "D")) => {
                let number = first_data + self.registers;
                let roomy = model.has(DeviceClass::D, 300);
                self.registers += if roomy { 100 } else { 50 };
                format!("D{number}")
            }
            Some((_, "M")) => {
                let number = self.relays;
                self.relays += 160;
                format!("M{number}")
            }
            Some((_, device)) => (*device).to_owned(),
            None if classes.meets(Classes::P) => "P0".to_owned(),
            None if classes.meets(Classes::N) => "N0".to_owned(),
            None if classes.meets(Classes::TEXT) => "\"ABC\"".to_owned(),
            None => constant(param),
        }
    }
}

/// A constant that a parameter accepts: 4 where it may be.
fn constant(param: &Param) -> String {
    let ruled = param.rules.iter().find_map(|rule| match *rule {
        Rule::MultipleOf(of) => Some(of),
        Rule::AtMost(_) | Rule::Below(_) => Some(1),
        _ => None,
    });
    let wanted = param.limits.nearest(ruled.unwrap_or(4));
    format!("K{wanted}")
}
