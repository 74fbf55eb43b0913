//! Durations as users write them, on the command line and in settings: `200ms`, `1.5s`, `2min`, `1h`; a bare number is
//! milliseconds.

use std::ops::RangeInclusive;

/// A year, in milliseconds: the longest duration.
pub const LONGEST_MS: u64 = 31_536_000_000;

/// Units and their milliseconds, longest first.
const UNITS: [(&str, u64); 4] = [("h", 3_600_000), ("min", 60_000), ("s", 1000), ("ms", 1)];

/// Parses a duration into milliseconds.
///
/// # Errors
/// What is wrong with it, and how durations are written.
pub fn parse(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let digits = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let wrong = || format!("`{text}` is not a time: write for example 200ms or 5s");
    if number.is_empty() {
        return Err(wrong());
    }
    let factor = match unit.trim() {
        "" => 1,
        // Minutes in earlier versions.
        "m" => 60_000,
        unit => {
            let known = UNITS.iter().find(|(name, _)| *name == unit);
            let factor = known.map(|(_, factor)| *factor);
            factor.ok_or_else(|| format!("`{unit}` is not a unit of time: use ms, s, min or h"))?
        }
    };
    let value: f64 = number.parse().map_err(|_| wrong())?;
    let ms = value * factor as f64;
    if (ms - ms.round()).abs() > 1e-6 {
        return Err(format!("`{text}` is not a whole number of milliseconds"));
    }
    if ms > LONGEST_MS as f64 {
        return Err("that is longer than a year".to_string());
    }
    Ok(ms.round() as u64)
}

/// Parses a duration in a range of milliseconds.
///
/// # Errors
/// As those of [`parse`], or the range.
pub fn parse_within(text: &str, range: RangeInclusive<u64>) -> Result<u64, String> {
    let ms = parse(text)?;
    match range.contains(&ms) {
        true => Ok(ms),
        false => {
            let (first, last) = (shortest(*range.start()), shortest(*range.end()));
            Err(format!("`{}` is not from {first} to {last}", text.trim()))
        }
    }
}

/// A duration in the longest unit of which it is a whole number.
pub fn shortest(ms: u64) -> String {
    let whole = UNITS
        .iter()
        .find(|(_, factor)| ms > 0 && ms.is_multiple_of(*factor));
    let (unit, factor) = whole.unwrap_or(&("ms", 1));
    format!("{}{unit}", ms / factor)
}

#[cfg(test)]
mod tests {
    use super::{parse, parse_within, shortest};

    #[test]
    fn units() {
        assert_eq!(parse("200ms"), Ok(200));
        assert_eq!(parse("5s"), Ok(5000));
        assert_eq!(parse("1.5s"), Ok(1500));
        assert_eq!(parse("2min"), Ok(120_000));
        assert_eq!(parse(" 1 h "), Ok(3_600_000));
        assert_eq!(parse("7"), Ok(7));
        assert!(parse("5 days").is_err());
        assert!(parse("").is_err());
        assert!(parse("s").is_err());
        assert!(parse("-1s").is_err_and(|why| why.contains("not a time")));
        assert!(parse("1.4ms").is_err_and(|why| why.contains("whole number")));
        assert_eq!(parse("0.001s"), Ok(1));
        assert_eq!(parse("1.1s"), Ok(1100));
        assert!(parse("9000h").is_err());
    }

    #[test]
    fn ranges_are_named_in_their_longest_units() {
        assert_eq!(parse_within("10ms", 10..=3_600_000), Ok(10));
        let why = "`2h` is not from 10ms to 1h";
        assert_eq!(parse_within("2h", 10..=3_600_000), Err(why.to_string()));
        assert_eq!(shortest(0), "0ms");
        assert_eq!(shortest(90_000), "90s");
    }
}
