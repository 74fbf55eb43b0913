//! Devices as variables of an editor.

use crate::run::Run;
use rungc::{Plc, Program, Value};
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::CrossReference;
use rungc_models::runs::is_special;
use rungc_sim::Target;
use rungc_sim::record::Reading;
use rungc_syntax::text::one_line;
use rungc_syntax::{Device, DeviceClass};
use serde_json::{Value as Json, json};
use std::collections::BTreeSet;

/// Titles of the scopes; their references are positions from 1.
const TITLES: [&str; 8] = [
    "Inputs",
    "Outputs",
    "Relays",
    "States",
    "Timers",
    "Counters",
    "Registers",
    "Special devices",
];

/// The devices that a program uses, in scopes.
pub struct Scopes(Vec<Vec<Variable>>);

/// A device with its comment.
struct Variable {
    device: Device,
    comment: Option<String>,
}

/// Position of the scope of a device; `None` if it has no value.
fn scope_of(device: Device) -> Option<usize> {
    use DeviceClass::{C, D, M, R, S, T, V, X, Y, Z};
    Some(match device.class {
        M | D if is_special(device.class, device.number) => 7,
        X => 0,
        Y => 1,
        M => 2,
        S => 3,
        T => 4,
        C => 5,
        D | R | V | Z => 6,
        _ => return None,
    })
}

impl Scopes {
    /// The devices of a program.
    pub fn of(program: &Program) -> Self {
        let project = program.project();
        let source = project.source();
        let (resolved, _) = resolve(source, project.model());
        let mut scopes: Vec<Vec<Variable>> = TITLES.iter().map(|_| Vec::new()).collect();
        let mut seen = BTreeSet::new();
        for row in CrossReference::new(&resolved).rows {
            let class = row.first.class;
            let Some(_) = scope_of(row.first) else {
                continue;
            };
            for number in row.first.number..=row.last.number {
                let device = Device { class, number };
                let exists = project.model().has(class, number);
                if let Some(scope) = scope_of(device).filter(|_| exists && seen.insert(device)) {
                    let comment = source
                        .comments
                        .get(&device)
                        .map(|comment| one_line(comment).to_string());
                    scopes[scope].push(Variable { device, comment });
                }
            }
        }
        Scopes(scopes)
    }

    /// The scopes, as the protocol describes them; those without devices are left out.
    pub fn list(&self) -> Json {
        let all = TITLES.iter().zip(&self.0).zip(1..);
        let all = all.filter(|((_, variables), _)| !variables.is_empty());
        all.map(|((title, variables), reference)| {
            json!({
                "name": title,
                "variablesReference": reference,
                "namedVariables": variables.len(),
                "expensive": variables.len() > 500,
            })
        })
        .collect()
    }

    /// The variables of a scope, from `start` on, `count` of them; all if it is 0.
    ///
    /// # Errors
    /// There is no such scope.
    pub fn variables(
        &self,
        plc: &mut Plc,
        reference: i64,
        (start, count): (i64, i64),
    ) -> Result<Json, String> {
        let start = usize::try_from(start).unwrap_or(0);
        let count = usize::try_from(count).ok().filter(|&count| count > 0);
        let all = self.scope(reference)?.iter().skip(start);
        let all = all.take(count.unwrap_or(usize::MAX));
        Ok(all.map(|variable| variable.json(plc)).collect())
    }

    fn scope(&self, reference: i64) -> Result<&[Variable], String> {
        let index = usize::try_from(reference).ok();
        let scope = index.and_then(|index| self.0.get(index.checked_sub(1)?));
        scope
            .map(Vec::as_slice)
            .ok_or_else(|| format!("there are no variables with the reference {reference}"))
    }

    /// Checks that there is a scope.
    ///
    /// # Errors
    /// There is none.
    pub fn check(&self, reference: i64) -> Result<(), String> {
        self.scope(reference).map(|_| ())
    }
}

impl Variable {
    fn json(&self, plc: &mut Plc) -> Json {
        let name = self.device.to_string();
        let (value, kind) = described(plc, &name).unwrap_or_else(|why| (why, "device"));
        let title = match &self.comment {
            Some(comment) => format!("{name} {comment}"),
            None => name.clone(),
        };
        json!({
            "name": title,
            "value": value,
            "type": kind,
            "evaluateName": name,
            "variablesReference": 0,
        })
    }
}

/// The device in the name of a variable, or the name itself.
pub fn device_in<'n>(plc: &Plc, name: &'n str) -> &'n str {
    let first = name.split_whitespace().next().unwrap_or(name);
    match plc.get(name) {
        Err(_) if plc.get(first).is_ok() => first,
        _ => name,
    }
}

/// Value of a device, and its type.
///
/// # Errors
/// There is no such device.
pub fn described(plc: &mut Plc, name: &str) -> Result<(String, &'static str), String> {
    let target = plc.target(name).map_err(|error| error.to_string())?;
    // The error names the model.
    plc.get(name).map_err(|error| error.to_string())?;
    let session = plc.session();
    let reading = session.reading(target);
    let is_forced = session.forced().iter().any(|(forced, _)| forced == target);
    let mark = if is_forced { ", forced" } else { "" };
    let text = reading.as_ref().map_or_else(String::new, shown);
    Ok(match (target, reading) {
        (Target::Current(class, number), _) => {
            let contact = session.reading(Target::Bit(class, number));
            let contact = contact.as_ref().map_or_else(String::new, shown);
            let kind = if class == DeviceClass::T {
                "timer"
            } else {
                "counter"
            };
            (format!("{text}, contact {contact}{mark}"), kind)
        }
        (_, Some(Reading::Bit(_))) => (format!("{text}{mark}"), "bit"),
        (_, Some(Reading::Float(_))) => (format!("{text}{mark}"), "float"),
        (_, Some(Reading::Text(_))) => (text, "text"),
        (_, Some(Reading::Integer(_, 32))) => (format!("{text}{mark}"), "32 bits"),
        _ => (format!("{text}{mark}"), "16 bits"),
    })
}

fn shown(reading: &Reading) -> String {
    match reading {
        Reading::Bit(true) => "on".to_owned(),
        Reading::Bit(false) => "off".to_owned(),
        reading => reading.to_string(),
    }
}

/// Reads a value as a user writes it: `on`, `off`, `true`, `false`, `12`, `-3.5`, `H1F`, `K100`. What follows a comma
/// is left out, as the values of [`described`] have it.
///
/// # Errors
/// It is none.
pub fn value(text: &str) -> Result<Value, String> {
    let written = text.split(',').next().unwrap_or_default().trim();
    let lower = written.to_lowercase();
    let wrong = || format!("`{written}` is not a value: write on, off, or a number");
    let number = match lower.as_str() {
        "on" | "true" => return Ok(Value::Bit(true)),
        "off" | "false" => return Ok(Value::Bit(false)),
        lower => match (lower.strip_prefix('h'), lower.strip_prefix("0x")) {
            (Some(digits), _) | (_, Some(digits)) => {
                i64::from_str_radix(digits, 16).map_err(|_| wrong())? as f64
            }
            _ => {
                let decimal = lower.strip_prefix('k').unwrap_or(lower);
                decimal.parse::<f64>().map_err(|_| wrong())?
            }
        },
    };
    match number.is_finite() {
        true => Ok(Value::Float(number)),
        false => Err(wrong()),
    }
}

/// Sets a device; its new value, as the protocol describes it.
///
/// # Errors
/// No such device, or a value that does not fit it.
pub fn set(run: &mut Run, name: &str, text: &str) -> Result<Json, String> {
    let name = device_in(run.plc(), name).to_owned();
    run.set(&name, value(text)?)?;
    let (value, kind) = described(run.plc_mut(), &name)?;
    Ok(json!({ "value": value, "type": kind, "variablesReference": 0 }))
}

#[cfg(test)]
mod tests {
    use super::value;
    use rungc::Value;

    #[test]
    fn values_are_read_as_users_write_them() {
        assert_eq!(value(" ON "), Ok(Value::Bit(true)));
        assert_eq!(value("12, contact off"), Ok(Value::Float(12.0)));
        assert_eq!(value("H1f"), Ok(Value::Float(31.0)));
        assert_eq!(value("K-5"), Ok(Value::Float(-5.0)));
        for wrong in ["", "inf", "NaN", "one", "h", "1e999"] {
            assert!(value(wrong).is_err(), "{wrong}");
        }
    }
}
