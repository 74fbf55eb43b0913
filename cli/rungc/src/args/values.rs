//! Values of arguments: how each is written, and what is said of one that is not.

use rungc::Language;
use rungc_firmware::target::{self, Target};
use rungc_frontend::Encoding;
use rungc_models::{ModelId, Plc};
use rungc_syntax::{Severity, codes, diag};
use std::ops::RangeInclusive;

/// The identifier of a warning, given by its code or name.
pub(super) fn warning(name: &str) -> Result<&'static str, String> {
    if codes::find(name).is_some_and(|code| code.severity == Severity::Error) {
        return Err("it is an error already".to_string());
    }
    let id = omissible(name)?;
    match codes::find(id).map(|code| code.severity) {
        Some(Severity::Warning) => Ok(id),
        _ => Err("a note cannot be an error".to_string()),
    }
}

/// The identifier of an error that can be made a warning, given by its code or name.
pub(super) fn limit(name: &str) -> Result<&'static str, String> {
    let limits = || {
        codes::eased()
            .map(|code| code.id)
            .collect::<Vec<_>>()
            .join(", ")
    };
    let code = codes::find(name)
        .ok_or_else(|| format!("unknown error; these can be warnings: {}", limits()))?;
    match code.severity {
        Severity::Note | Severity::Warning => Err("it is not an error".to_string()),
        Severity::Error => match code.can_be_eased() {
            Ok(()) => Ok(code.id),
            Err(why) => Err(format!("it cannot be a warning: {why}")),
        },
    }
}

/// The identifier of a warning or note, given by its code or name.
pub(super) fn omissible(name: &str) -> Result<&'static str, String> {
    let code = codes::find(name).ok_or_else(|| {
        let omissible = codes::all()
            .into_iter()
            .filter(|c| c.severity != Severity::Error);
        let names = omissible.flat_map(|c| [c.id, c.name]);
        let near = diag::did_you_mean(&name.to_lowercase(), names);
        let hint = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        format!("unknown warning{hint}")
    })?;
    match code.severity {
        Severity::Note | Severity::Warning => Ok(code.id),
        Severity::Error => Err("errors cannot be suppressed".to_string()),
    }
}

/// A language of reports, by its name.
pub(super) fn language(name: &str) -> Result<Language, String> {
    Language::named(name)
}

pub(super) fn networks(text: &str) -> Result<RangeInclusive<usize>, String> {
    let ends = text.split_once("..").or_else(|| text.split_once('-'));
    let (first, last) = ends.unwrap_or((text, text));
    match (first.trim().parse(), last.trim().parse()) {
        (Ok(first), Ok(last)) if (1..=last).contains(&first) => Ok(first..=last),
        _ => Err("networks are written `12` or `12..20`, counted from 1".to_string()),
    }
}

pub(super) fn code(text: &str) -> Result<&'static str, String> {
    codes::find(&text.to_lowercase())
        .map(|code| code.id)
        .ok_or_else(|| format!("`{text}` is not a diagnostic code"))
}

pub(super) fn encoding(name: &str) -> Result<&'static Encoding, String> {
    let names =
        "utf-8, utf-16le, windows-1252, windows-1250, windows-1251, gbk, big5, shift_jis, euc-kr";
    Encoding::for_label_no_replacement(name.as_bytes())
        .ok_or_else(|| format!("unknown encoding; some of those available: {names}"))
}

pub(super) fn target(name: &str) -> Result<&'static Target, String> {
    target::find(name).ok_or_else(|| {
        let names: Vec<_> = target::ALL.iter().map(|target| target.triple).collect();
        format!("unknown target; available: {}", names.join(", "))
    })
}

pub(super) fn plc(name: &str) -> Result<Plc, String> {
    Plc::named(name).map_err(|unknown| format!("{}; {}", unknown.message, unknown.help))
}

pub(super) fn model(name: &str) -> Result<ModelId, String> {
    plc(name).map(|plc| plc.model)
}
