//! The little of JSON that payloads hold: a number, a truth value, or a flat object or array of them.

/// A value of a payload.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Number(i64),
    /// Anything else, which fits no device.
    Other,
}

/// A value alone.
pub(super) fn value(text: &str) -> Option<Value> {
    let mut rest = Rest(text.as_bytes());
    let value = rest.value(0)?;
    rest.skip();
    rest.0.is_empty().then_some(value)
}

/// The items of an object, with their names, or of an array; `None` if the text is neither.
pub(super) fn items(text: &str) -> Option<Vec<(Option<String>, Value)>> {
    let mut rest = Rest(text.as_bytes());
    let items = match rest.next() {
        Some(b'{') => rest.items(b'}', 0),
        Some(b'[') => rest.items(b']', 0),
        _ => None,
    };
    rest.skip();
    items.filter(|_| rest.0.is_empty())
}

/// Objects and arrays in each other, at most.
const DEEPEST: u32 = 16;

/// Remaining input.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    /// Skips white space.
    fn skip(&mut self) {
        self.0 = self.0.trim_ascii_start();
    }

    /// The next character that is not white space.
    fn next(&mut self) -> Option<u8> {
        self.skip();
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    fn peek(&mut self) -> Option<u8> {
        self.skip();
        self.0.first().copied()
    }

    fn value(&mut self, depth: u32) -> Option<Value> {
        match self.peek()? {
            b'"' => self.string().map(|_| Value::Other),
            open @ (b'{' | b'[') if depth < DEEPEST => {
                self.next()?;
                let close = if open == b'{' { b'}' } else { b']' };
                self.items(close, depth + 1).map(|_| Value::Other)
            }
            _ => self.plain(),
        }
    }

    /// A number or a word.
    fn plain(&mut self) -> Option<Value> {
        let is_part = |c: &u8| c.is_ascii_alphanumeric() || b"+-.".contains(c);
        let length = self.0.iter().take_while(|c| is_part(c)).count();
        let (word, rest) = self.0.split_at(length);
        self.0 = rest;
        let word = str::from_utf8(word).ok().filter(|word| !word.is_empty())?;
        match word {
            "true" => Some(Value::Bool(true)),
            "false" => Some(Value::Bool(false)),
            "null" => Some(Value::Other),
            _ if word.starts_with('+') => None,
            _ => match word.parse() {
                Ok(number) => Some(Value::Number(number)),
                Err(_) => word.parse::<f64>().ok().map(|_| Value::Other),
            },
        }
    }

    /// A text; escapes stay as they are, since no device's name has one.
    fn string(&mut self) -> Option<String> {
        self.next().filter(|&c| c == b'"')?;
        let mut escaped = false;
        let end = self.0.iter().position(|&c| {
            let ends = c == b'"' && !escaped;
            escaped = c == b'\\' && !escaped;
            ends
        })?;
        let text = String::from_utf8_lossy(&self.0[..end]).into_owned();
        self.0 = &self.0[end + 1..];
        Some(text)
    }

    /// Items up to the closing bracket; those of an object have names.
    fn items(&mut self, close: u8, depth: u32) -> Option<Vec<(Option<String>, Value)>> {
        let mut items = Vec::new();
        if self.peek()? == close {
            self.next()?;
            return Some(items);
        }
        loop {
            let mut name = None;
            if close == b'}' {
                name = Some(self.string()?);
                self.next().filter(|&c| c == b':')?;
            }
            items.push((name, self.value(depth)?));
            match self.next()? {
                b',' => {}
                c if c == close => return Some(items),
                _ => return None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_items() {
        assert_eq!(value(" -5 "), Some(Value::Number(-5)));
        assert_eq!(value("true"), Some(Value::Bool(true)));
        assert_eq!(value("1.5"), Some(Value::Other));
        for wrong in ["", "+1", "1 2", "yes", "\"a", "{", "[1", "{\"a\":}", "[1,]"] {
            assert_eq!(value(wrong), None, "{wrong}");
            assert_eq!(items(wrong), None, "{wrong}");
        }
        let found = items(" { \"D0\" : 7 , \"x\\\"}\":{\"a\":[1]}, \"D1\":false } ").unwrap();
        let names: Vec<_> = found
            .iter()
            .map(|(name, value)| (name.as_deref(), *value))
            .collect();
        let expected = [
            (Some("D0"), Value::Number(7)),
            (Some("x\\\"}"), Value::Other),
            (Some("D1"), Value::Bool(false)),
        ];
        assert_eq!(names, expected);
        assert_eq!(
            items("[1, null]"),
            Some(vec![(None, Value::Number(1)), (None, Value::Other)])
        );
        assert_eq!(items("{}"), Some(Vec::new()));
        assert_eq!(items("[] x"), None);
        assert_eq!(items(&"[".repeat(100_000)), None);
    }
}
