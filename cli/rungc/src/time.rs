//! Times on the command line: `200ms`, `5s`, `2min`; a bare number is milliseconds.

/// Parses a time into milliseconds.
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
        "" | "ms" => 1.0,
        "s" => 1000.0,
        "min" | "m" => 60_000.0,
        "h" => 3_600_000.0,
        other => {
            return Err(format!(
                "`{other}` is not a unit of time: use ms, s, min or h"
            ));
        }
    };
    let value: f64 = number.parse().map_err(|_| wrong())?;
    let ms = value * factor;
    if (ms - ms.round()).abs() > 1e-6 {
        return Err(format!("`{text}` is not a whole number of milliseconds"));
    }
    // A year is far beyond what a scan-by-scan run can do.
    if ms > 31_536_000_000.0 {
        Err("that is longer than a year".to_string())
    } else {
        Ok(ms.round() as u64)
    }
}

/// Parses a time to wait for an answer: 10 ms to an hour.
pub fn parse_wait(text: &str) -> Result<u64, String> {
    let ms = parse(text)?;
    match (10..=3_600_000).contains(&ms) {
        true => Ok(ms),
        false => Err("a time to wait is 10ms to 1h".to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn units() {
        assert_eq!(parse("200ms"), Ok(200));
        assert_eq!(parse("5s"), Ok(5000));
        assert_eq!(parse("1.5s"), Ok(1500));
        assert_eq!(parse("2min"), Ok(120_000));
        assert_eq!(parse("7"), Ok(7));
        assert!(parse("5 days").is_err());
        assert!(parse("").is_err());
        assert!(parse("s").is_err());
        assert!(parse("-1s").unwrap_err().contains("not a time"));
        assert!(parse("1.4ms").unwrap_err().contains("whole number"));
        assert_eq!(parse("0.001s"), Ok(1));
        assert_eq!(parse("1.1s"), Ok(1100));
    }
}
