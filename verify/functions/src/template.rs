//! Conditions with placeholders: `{output} & !{left}[ | {stop}]`.

use std::borrow::Cow;

/// Values of placeholders: conditions, in the language of conditions.
pub(crate) trait Values {
    /// The value of a placeholder; `None` if its parameter is not given.
    fn value(&self, name: &str) -> Option<Cow<'_, str>>;
}

/// A template with its placeholders filled; `None` if one outside `[…]` has no value.
pub(crate) fn fill(template: &str, values: &impl Values) -> Option<String> {
    let mut out = String::new();
    let mut rest = template;
    while let Some(at) = rest.find(['{', '[']) {
        out.push_str(&rest[..at]);
        let is_optional = rest[at..].starts_with('[');
        let close = if is_optional { ']' } else { '}' };
        let length = rest[at..].find(close)?;
        let inner = &rest[at + 1..at + length];
        rest = &rest[at + length + 1..];
        if is_optional {
            out.push_str(&fill(inner, values).unwrap_or_default());
            continue;
        }
        let value = values.value(inner)?;
        let is_enclosed = out.ends_with('(') && rest.starts_with(')');
        match out.strip_suffix('!') {
            _ if is_enclosed => out.push_str(value.trim()),
            Some(before) => out = format!("{before}{}", inverted(&value)),
            None => out.push_str(&term(&value)),
        }
    }
    Some(out + rest)
}

/// Names of the placeholders of a template.
pub(crate) fn placeholders(template: &str) -> impl Iterator<Item = &str> {
    let parts = template.split('{').skip(1);
    parts.filter_map(|part| part.split_once('}').map(|(name, _)| name))
}

/// Returns true for an operand by itself: a device, or a name in quotes.
fn is_operand(text: &str) -> bool {
    match text
        .strip_prefix('"')
        .and_then(|text| text.strip_suffix('"'))
    {
        Some(inner) => !inner.contains('"'),
        None => !text.contains(|c: char| c.is_whitespace() || "&|!()=<>\"".contains(c)),
    }
}

/// A condition as a part of another.
fn term(text: &str) -> Cow<'_, str> {
    let text = text.trim();
    match is_operand(text.strip_prefix('!').unwrap_or(text)) {
        true => text.into(),
        false => format!("({text})").into(),
    }
}

/// The inverse of a condition.
fn inverted(text: &str) -> Cow<'_, str> {
    let text = text.trim();
    match text.strip_prefix('!') {
        Some(rest) if is_operand(rest) => rest.into(),
        _ => format!("!{}", term(text)).into(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Values, fill, placeholders};
    use std::borrow::Cow;

    struct Pairs(&'static [(&'static str, &'static str)]);

    impl Values for Pairs {
        fn value(&self, name: &str) -> Option<Cow<'_, str>> {
            let found = self.0.iter().find(|(key, _)| *key == name);
            found.map(|(_, value)| (*value).into())
        }
    }

    #[test]
    fn placeholders_are_filled() {
        let values = Pairs(&[
            ("a", "X000"),
            ("b", "!X001"),
            ("c", "X2 | X3"),
            ("d", "\"left button\""),
            ("e", "!(X4 & X5)"),
        ]);
        let is = |template, expected: &str| {
            assert_eq!(fill(template, &values).as_deref(), Some(expected));
        };
        is("{a} & !{a}", "X000 & !X000");
        is("{b} & !{b}", "!X001 & X001");
        is("{c} & !{c}", "(X2 | X3) & !(X2 | X3)");
        is("!{d} & {d}", "!\"left button\" & \"left button\"");
        is("!{e}", "!(!(X4 & X5))");
        is("rises({c}) & rises({a})", "rises(X2 | X3) & rises(X000)");
        is("(!{a} for {b})", "(!X000 for !X001)");
        is("{a}[ | {b}][ | {z}]", "X000 | !X001");
        assert_eq!(fill("{a} & {z}", &values), None);
        let names: Vec<_> = placeholders("{a}[ | {b}] within {c}").collect();
        assert_eq!(names, ["a", "b", "c"]);
    }
}
