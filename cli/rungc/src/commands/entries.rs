//! Entries in the tables of a rungc.toml; all else in it stays as it is.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

type Value<'t> = Spanned<DeValue<'t>>;

/// An entry: `"61 01 00" = "WDT"`.
pub fn entry(key: &str, value: &str) -> String {
    let quoted = |text: &str| toml::Value::from(text).to_string();
    format!("{} = {}\n", quoted(key), quoted(value))
}

/// Settings with entries after those of a table, which may not be there yet.
///
/// # Errors
/// Text that is not TOML, and a table that is written in a form to which lines cannot be added.
pub fn with_entries(text: &str, table: &str, entries: &str) -> Result<String, String> {
    let settings = DeTable::parse(text).map_err(|error| error.to_string())?;
    let appended = || {
        let between = match text {
            "" => "",
            text if text.ends_with('\n') => "\n",
            _ => "\n\n",
        };
        format!("{text}{between}[{table}]\n{entries}")
    };
    let Some(found) = settings.get_ref().get(table) else {
        return Ok(appended());
    };
    let refused =
        || format!("write `{table}` as a table `[{table}]`, which entries can be added to");
    let DeValue::Table(known) = found.get_ref() else {
        return Err(refused());
    };
    // Tables with a header such as `[labels.Axis1]`.
    let is_apart =
        |value: &Value| value.get_ref().is_table() && text[value.span()].starts_with('[');
    let own = known.iter().filter(|(_, value)| !is_apart(value));
    if !text[found.span()].starts_with('[') {
        let are_apart = !known.is_empty() && own.count() == 0;
        return are_apart.then(appended).ok_or_else(refused);
    }
    let ends = own.map(|(_, value)| value.span().end);
    let end = ends.max().unwrap_or(0).max(found.span().end);
    Ok(match text[end..].find('\n') {
        Some(line) => {
            let (before, after) = text.split_at(end + line + 1);
            format!("{before}{entries}{after}")
        }
        None => format!("{text}\n{entries}"),
    })
}

#[cfg(test)]
mod tests {
    use super::{entry, with_entries};

    #[test]
    fn entries_go_to_their_table_and_not_to_those_below_it() {
        let added = |before: &str| with_entries(before, "labels", &entry("a", "M0"));
        let line = "\"a\" = \"M0\"\n";
        let below = "[labels.Axis1]\nReady = \"M1\"\n";
        for (before, expected) in [
            ("", format!("[labels]\n{line}")),
            (below, format!("{below}\n[labels]\n{line}")),
            (
                &*format!("[labels]\nb = \"M2\"\n\n{below}"),
                format!("[labels]\nb = \"M2\"\n{line}\n{below}"),
            ),
            ("[labels]\n\n[io]\n", format!("[labels]\n{line}\n[io]\n")),
        ] {
            assert_eq!(added(before), Ok(expected), "{before}");
        }
        added("labels = {}\n").unwrap_err();
        added("[labels").unwrap_err();
    }
}
