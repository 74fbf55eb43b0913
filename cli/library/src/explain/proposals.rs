//! Proposals for topics without a page.

use rungc_models::plc_errors;
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId, Plc, VARIANTS};
use rungc_syntax::{DeviceClass, codes, diag};

/// How far from an unknown number proposals are looked for, and how many are given.
const AROUND: u16 = 50;
const MOST: usize = 3;

/// The message for a topic that is not known. `others` are names of pages that the caller has beside these.
pub fn unknown(topic: &str, plc: Option<Plc>, others: &[&str]) -> String {
    let upper = topic.to_uppercase();
    if let Ok(number) = upper.parse::<u16>() {
        let near = own_code(number).unwrap_or_else(|| near_error(number, plc));
        return format!("no PLC has error {number}{near}");
    }
    if let Some((class, number)) = device(&upper) {
        let name = class.number(number);
        return match is_special(class, number) {
            true => format!(
                "{name} has no meaning on any model{}",
                near_special(class, number, plc)
            ),
            false => format!(
                "`{name}` is a general device; special relays begin at M8000, special registers at D8000"
            ),
        };
    }
    let near = lettered_error(&upper, plc).or_else(|| near_name(topic, &upper, others));
    let hint = near.map(|near| format!("; did you mean `{near}`?"));
    format!(
        "`{topic}` is not a diagnostic code, PLC error code, instruction, special device, model, safety \
        function or page of the book{}",
        hint.unwrap_or_default()
    )
}

/// Class and number of a device that a topic names: of any class but pointers, which are instructions, too.
pub(super) fn device(topic: &str) -> Option<(DeviceClass, u32)> {
    let (prefix, digits) = topic.split_at(topic.find(|c: char| c.is_ascii_digit())?);
    let class = DeviceClass::from_prefix(prefix)?;
    let radix = if class.is_octal() { 8 } else { 10 };
    let number = u32::from_str_radix(digits, radix).ok()?;
    Some((class, number))
}

/// The special devices nearest to one without a meaning, as the end of a message.
pub(super) fn near_special(class: DeviceClass, number: u32, plc: Option<Plc>) -> String {
    let known = |&other: &u32| models(plc).any(|id| Model::get(id).special(class, other).is_some());
    let from = number.saturating_sub(AROUND.into());
    let before = (from..number).rev().find(known);
    let after = (number + 1..=number.saturating_add(AROUND.into())).find(known);
    let names: Vec<_> = before
        .into_iter()
        .chain(after)
        .map(|near| class.number(near).to_string())
        .collect();
    nearest(&names)
}

/// The diagnostic code with a number, as the end of a message.
fn own_code(number: u16) -> Option<String> {
    let with_number = |id: &&str| id[1..].parse() == Ok(number);
    let id = codes::all()
        .into_iter()
        .map(|code| code.id)
        .find(with_number)?;
    Some(format!("; did you mean `{id}`?"))
}

/// The PLC error that a topic names with letters in front: `E6706`.
fn lettered_error(upper: &str, plc: Option<Plc>) -> Option<String> {
    let digits = upper.trim_start_matches(|c: char| c.is_ascii_alphabetic() || " -:".contains(c));
    let number = digits.parse().ok().filter(|_| !digits.starts_with('0'))?;
    let is_known = models(plc).any(|id| plc_errors::find(number, id).is_some());
    is_known.then(|| digits.to_owned())
}

/// The error codes nearest to one that does not exist, as the end of a message.
fn near_error(number: u16, plc: Option<Plc>) -> String {
    let known = |&code: &u16| models(plc).any(|id| plc_errors::find(code, id).is_some());
    let range = number.saturating_sub(AROUND)..=number.saturating_add(AROUND);
    let mut codes: Vec<u16> = range.filter(known).collect();
    codes.sort_by_key(|code| code.abs_diff(number));
    codes.truncate(MOST);
    codes.sort_unstable();
    let names: Vec<_> = codes.iter().map(u16::to_string).collect();
    nearest(&names)
}

/// The model of a PLC, or all.
fn models(plc: Option<Plc>) -> impl Iterator<Item = ModelId> {
    let fits = move |id: &ModelId| plc.is_none_or(|plc| plc.model == *id);
    ModelId::ALL.into_iter().filter(fits)
}

fn nearest(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => format!("; the nearest is {one}"),
        many => format!("; the nearest are {}", many.join(", ")),
    }
}

/// The name nearest to a misspelt one.
fn near_name(topic: &str, upper: &str, others: &[&str]) -> Option<String> {
    let codes = codes::all().into_iter().map(|code| code.id.to_owned());
    let spellings = rungc_catalogue::all().flat_map(|inst| inst.spellings());
    let spellings = spellings.map(|(spelling, _)| spelling);
    let in_upper: Vec<String> = codes.chain(spellings).collect();
    let lower = topic.to_lowercase();
    let titles = codes::all().into_iter().map(|code| code.name);
    let variants = VARIANTS.iter().map(|variant| variant.name);
    let models = ModelId::ALL.map(|id| Model::get(id).name);
    let others = others.iter().copied();
    let in_upper = diag::did_you_mean(upper, in_upper.iter().map(String::as_str));
    let in_lower = diag::did_you_mean(&lower, titles.chain(variants).chain(models).chain(others));
    let far = |near: &str| diag::distance(&lower, &near.to_lowercase(), upper.len());
    let found = in_upper.into_iter().chain(in_lower);
    found.min_by_key(|near| far(near)).map(str::to_owned)
}
