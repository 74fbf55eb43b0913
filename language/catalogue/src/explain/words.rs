//! Words for operands.

use crate::{Classes, Extent, Limits, Param, Role, Rule, Shape};
use rungc_models::Model;
use rungc_syntax::DeviceClass;
use std::fmt::Write;

/// Meaning of an operand, its use, and its rules, on one model or on all.
pub fn meaning(param: &Param, params: &[Param], model: Option<&Model>) -> String {
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
    let mut text = format!("{thing}, {role}") + &extent_words(param, params);
    if param.limits != Limits::None {
        text += &format!("; {}", param.limits.in_words(""));
    }
    for rule in param.rules {
        text += "; ";
        text += &rule_words(rule, params, model);
    }
    if param.sends_pulses {
        text += "; it sends pulses";
    }
    let Some(model) = model else {
        for &(class, first, last) in param.numbers {
            let _ = write!(text, "; {}–{}", class.number(first), class.number(last));
        }
        return text;
    };
    for &(class, first, last) in param.numbers_on(model) {
        if let Some(run) = run_on(model, class, first, last) {
            let _ = write!(text, "; {run}");
        }
    }
    text + &without_index(param, model)
        + if param.optional {
            "; may be omitted"
        } else {
            ""
        }
}

/// Number of devices that an operand takes.
fn extent_words(param: &Param, params: &[Param]) -> String {
    let name = |i: usize| params.get(i).map_or("", |param| param.name);
    match param.extent {
        Extent::One => String::new(),
        Extent::Count(count) => format!("; {count} devices starting with it"),
        Extent::Between { least, most } => {
            format!("; {least} to {most} devices starting with it, depending on its settings")
        }
        Extent::Operand { i, extra: 0 } => {
            format!("; {} devices starting with it", name(i))
        }
        Extent::Operand { i, extra } => {
            format!("; {} + {extra} devices starting with it", name(i))
        }
        Extent::Through(i) => format!("; up to {}", name(i)),
        Extent::Of(_) => "; more devices starting with it, depending on the operands".to_owned(),
        Extent::Bits(_) => {
            "; more bits starting with it, depending on the operands, or one word".to_owned()
        }
    }
}

/// A rule for an operand.
fn rule_words(rule: &Rule, params: &[Param], model: Option<&Model>) -> String {
    let name = |i: usize| params.get(i).map_or("", |param| param.name);
    match *rule {
        Rule::WideLimits(min, max) => format!("in the 32-bit form, {min} to {max}"),
        Rule::Not(min, max) => format!("not {min} to {max}"),
        Rule::WorksWith(min, i64::MAX) => format!("fails below {min}"),
        Rule::WorksWith(min, max) => format!("fails outside {min} to {max}"),
        Rule::WorksAbove(bound) => format!("fails unless above {bound}"),
        Rule::WordWorksTo(i, max) => format!("fails above {max} if {} is a word", name(i)),
        Rule::WorksFrom(i) => format!("fails below {}", name(i)),
        Rule::WorksIf(_, when) => format!("fails unless {when}"),
        Rule::MultipleOf(of) => format!("a multiple of {of}"),
        Rule::AtMost(i) => format!("at most {}", name(i)),
        Rule::AtLeast(i) => format!("at least {}", name(i)),
        Rule::Below(i) => format!("below {}", name(i)),
        Rule::EndsInZero => "its number ends in 0".to_owned(),
        Rule::Aligned(of) => format!("its number is a multiple of {of}"),
        Rule::WholeGroup => "a group has K4, in the 32-bit form K8".to_owned(),
        Rule::GroupAligned(of) => format!("a group starts at a multiple of {of}"),
        Rule::WideAligned(of) => {
            format!("in the 32-bit form, a group starts at a multiple of {of}")
        }
        Rule::SameDigits(i) => format!("a group has as many digits as {}", name(i)),
        Rule::GroupLike(i) => format!("a group if and only if {} is one", name(i)),
        Rule::WordsWith(i) => format!("a group has K4 unless {} is one", name(i)),
        Rule::GroupAtMost(i, max) => format!("at most {max} if {} is a group", name(i)),
        Rule::NotBefore(i) => format!("not before {}", name(i)),
        Rule::ClassLike(i) => format!("of the same class as {}", name(i)),
        Rule::Holds(_, demand) | Rule::Suits(_, demand) => demand.to_string(),
        Rule::WideCounter => {
            match model.and_then(|model| run_on(model, DeviceClass::C, 200, u32::MAX)) {
                Some(counters) => format!("in the 32-bit form, {counters}"),
                None => "in the 32-bit form, C200 and up".to_owned(),
            }
        }
        Rule::WideNot(classes) => {
            let names: Vec<_> = classes.names().collect();
            format!("in the 32-bit form, not {}", names.join(" "))
        }
    }
}

/// Devices of a class from one number to another that a model has, `M0–M511`; `None` if it has none of them.
pub(super) fn run_on(model: &Model, class: DeviceClass, first: u32, last: u32) -> Option<String> {
    let ranges = || model.ranges_of(class);
    let begin = ranges().find(|range| range.last >= first)?.first.max(first);
    let end = ranges().filter(|range| range.first <= last).last()?;
    let end = end.last.min(last);
    (begin <= end).then(|| match begin == end {
        true => class.number(begin).to_string(),
        false => format!("{}–{}", class.number(begin), class.number(end)),
    })
}

/// Index registers that an operand does not take.
fn without_index(param: &Param, model: &Model) -> String {
    let plain = Classes::P.or(Classes::I).or(Classes::N).or(Classes::TEXT);
    let classes = param.classes_on(model).without(plain);
    if !param.indexable {
        let word = if classes.is_empty() {
            ""
        } else {
            "; no index register"
        };
        return word.to_owned();
    }
    let mut names = Vec::new();
    for &(class, first, _) in param.unindexed {
        if classes.meets(Classes::of_device(class)) {
            names.push(match first {
                0 => class.prefix().to_owned(),
                _ => format!("{} and up", class.number(first)),
            });
        } else if class == DeviceClass::D && classes.meets(Classes::WORD_BIT) {
            names.push("bits of words".to_owned());
        }
    }
    match names.is_empty() {
        true => String::new(),
        false => format!("; no index register with {}", names.join(", ")),
    }
}
