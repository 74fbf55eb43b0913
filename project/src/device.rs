//! Devices, indexed operands and ranges as the file writes them.

use rungc_syntax::{Device, DeviceClass, Index};

/// No device of any model has a higher number.
const LAST: u32 = 999_999;

/// The device that a text begins with, and what follows it.
fn split(text: &str) -> Option<(Device, &str)> {
    let letters = text.find(|c: char| !c.is_ascii_uppercase())?;
    let (letters, rest) = text.split_at(letters);
    let class = DeviceClass::from_prefix(letters)?;
    let digits = rest
        .find(|c: char| !c.is_ascii_digit())
        .unwrap_or(rest.len());
    let (digits, rest) = rest.split_at(digits);
    let radix = if class.is_octal() { 8 } else { 10 };
    let number = u32::from_str_radix(digits, radix).ok()?;
    (number <= LAST).then_some((Device { class, number }, rest))
}

/// Reads `D100`.
pub fn device(text: &str) -> Option<Device> {
    split(text)
        .filter(|(_, rest)| rest.is_empty())
        .map(|(device, _)| device)
}

/// Reads `D100Z0`; a bare letter of an index register is number 0.
pub fn indexed(text: &str) -> Option<(Device, Index)> {
    let (base, rest) = split(text)?;
    let index = match rest {
        "V" | "Z" => device(&format!("{rest}0"))?,
        _ => device(rest)?,
    };
    let Device { class, number } = index;
    matches!(class, DeviceClass::V | DeviceClass::Z).then_some((base, Index { class, number }))
}

/// Reads `D200-D511`, also written `D200..D511`, or `D200` for one device: class, first and last number.
pub fn range(text: &str) -> Option<(DeviceClass, u32, u32)> {
    let ends = text.split_once("..").or_else(|| text.split_once('-'));
    let (first, last) = ends.unwrap_or((text, text));
    let (first, last) = (device(first.trim())?, device(last.trim())?);
    (first.class == last.class && first.number <= last.number).then_some((
        first.class,
        first.number,
        last.number,
    ))
}

/// What is wrong with a text that is not read as a [`range`], where it is like one.
pub fn mistake(text: &str) -> Option<String> {
    let ends = text.split_once("..").or_else(|| text.split_once('-'));
    let (first, last) = ends.unwrap_or((text, text));
    let (first, last) = (first.trim(), last.trim());
    if let Some(why) = [first, last].into_iter().find_map(mistake_in_device) {
        return Some(why);
    }
    let (first, last) = (device(first)?, device(last)?);
    match first.class == last.class {
        true => (first.number > last.number)
            .then(|| format!("the first device is after the last: write `{last}..{first}`")),
        false => Some("both ends are devices of one class".to_owned()),
    }
}

/// What is wrong with a device, of which there are letters and digits.
fn mistake_in_device(text: &str) -> Option<String> {
    let letters = text.find(|c: char| !c.is_ascii_uppercase())?;
    let (letters, digits) = text.split_at(letters);
    if letters.is_empty() || !digits.bytes().all(|digit| digit.is_ascii_digit()) {
        return None;
    }
    let Some(class) = DeviceClass::from_prefix(letters) else {
        return Some(format!("there are no devices {letters}"));
    };
    let is_octal = |digit: u8| digit < b'8';
    match device(text) {
        Some(_) => None,
        None if class.is_octal() && !digits.bytes().all(is_octal) => {
            Some(format!("the numbers of {letters} are octal"))
        }
        None => Some("no model has that many".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operands_and_ranges() {
        assert_eq!(range("D200-D511"), Some((DeviceClass::D, 200, 511)));
        assert_eq!(range("X010 - X17"), Some((DeviceClass::X, 8, 15)));
        assert_eq!(range("D200..D511"), Some((DeviceClass::D, 200, 511)));
        assert_eq!(range("ER7"), Some((DeviceClass::ER, 7, 7)));
        for wrong in [
            "",
            "D",
            "D2-M3",
            "D3-D2",
            "D1-",
            "D1..",
            "D1..D2..D3",
            "Q1",
            "X8",
            "D1000000",
            "D0Z0",
        ] {
            assert_eq!(range(wrong), None, "{wrong}");
        }
        let (base, index) = indexed("D100Z").unwrap();
        assert_eq!(
            (base.to_string(), index.to_string()),
            ("D100".into(), "Z0".into())
        );
        assert_eq!(indexed("X10V3").unwrap().0.number, 8);
        for wrong in ["D100", "D100D1", "D100ZZ", "Z", "D100Z-1"] {
            assert!(indexed(wrong).is_none(), "{wrong}");
        }
    }
}
