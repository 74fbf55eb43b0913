//! Devices that a source names: a compiled program that lacks one of them is older than its source.

use crate::gx::program;
use crate::gx::tokens::{self, Bare, Token};
use rungc_syntax::{Device, DeviceClass, OperandKind};
use std::collections::{BTreeMap, BTreeSet};

/// The devices that structured text names, by themselves or through the devices of global labels.
pub(super) fn of_text(text: &str, labels: &BTreeMap<String, Device>) -> BTreeSet<Device> {
    let code = without_comments(text);
    let words = code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c.is_ascii());
    words
        .filter_map(|word| {
            let label = labels.get(&word.to_lowercase()).copied();
            label.or_else(|| device(word))
        })
        .collect()
}

/// The devices that the tokens of a ladder name, by themselves or through labels in ASCII.
pub(super) fn of_ladder(code: &[u8], labels: &BTreeMap<String, Device>) -> BTreeSet<Device> {
    let operand = |body| match tokens::token(body)? {
        Token::Operand(Bare::Kind(OperandKind::Device(device, _))) => Some(device),
        Token::Operand(Bare::Name(name)) => {
            let name = std::str::from_utf8(name).ok()?;
            labels.get(&name.to_lowercase()).copied()
        }
        _ => None,
    };
    let devices = program::bodies(code).filter_map(operand);
    devices.filter(is_stored).collect()
}

/// Returns true if a device stores a value; pointers and nesting levels are renumbered by the compiler.
fn is_stored(device: &Device) -> bool {
    !matches!(
        device.class,
        DeviceClass::P | DeviceClass::I | DeviceClass::N
    )
}

/// A device as structured text writes it: `X10`, `K4M100`, `TN0`.
pub(super) fn device(word: &str) -> Option<Device> {
    let word = word.to_ascii_uppercase();
    let word = match word.strip_prefix('K') {
        Some(group) => group.trim_start_matches(|c: char| c.is_ascii_digit()),
        None => &word,
    };
    let digits = word.find(|c: char| c.is_ascii_digit())?;
    let (letters, digits) = word.split_at(digits);
    let (class, radix) = match letters {
        "X" => (DeviceClass::X, 8),
        "Y" => (DeviceClass::Y, 8),
        "M" => (DeviceClass::M, 10),
        "S" => (DeviceClass::S, 10),
        "T" | "TS" | "TC" | "TN" => (DeviceClass::T, 10),
        "C" | "CS" | "CC" | "CN" => (DeviceClass::C, 10),
        "D" => (DeviceClass::D, 10),
        "R" => (DeviceClass::R, 10),
        _ => return None,
    };
    let number = u32::from_str_radix(digits, radix).ok()?;
    Some(Device { class, number })
}

/// Structured text without comments and texts, which become spaces.
fn without_comments(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let end = match c {
            '(' if rest.starts_with("(*") => "*)",
            '/' if rest.starts_with("//") => "\n",
            '"' => "\"",
            '\'' => "'",
            _ => {
                code.push(c);
                rest = &rest[c.len_utf8()..];
                continue;
            }
        };
        let begin = if end.len() == 2 || end == "\n" { 2 } else { 1 };
        let body = &rest[begin..];
        rest = body.find(end).map_or("", |at| &body[at + end.len()..]);
        code.push(' ');
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structured_text_names_devices() {
        let labels = [("Start".to_lowercase(), device("X7").unwrap())].into();
        let text = "MOV(M8002, K4M100, D10); (* Y5 (* *) TON(start, 'D99', tn3); // D77\n y17 := K100 + H20;";
        let names: Vec<_> = of_text(text, &labels)
            .iter()
            .map(ToString::to_string)
            .collect();
        assert_eq!(names, ["X007", "Y017", "M100", "M8002", "T3", "D10"]);
    }
}
