//! Keys of test files that stand in the wrong table.

use super::raw::{RawCase, RawFile, RawStep};
use crate::problem::Problem;
use serde::de::value::Error;
use serde::de::{Deserialize, Deserializer, Error as _, Visitor};

/// Problems in which a key that another table has is said to belong there.
pub(super) fn with_homes(mut problems: Vec<Problem>) -> Vec<Problem> {
    for problem in &mut problems {
        let near = |help: &String| help.starts_with("did you mean");
        let unknown = problem.message.strip_prefix("there is no key `");
        let Some((key, _)) = unknown.and_then(|rest| rest.split_once('`')) else {
            continue;
        };
        if let Some(home) = home(key).filter(|_| !problem.help.as_ref().is_some_and(near)) {
            problem.message = format!("`{key}` belongs {home}");
            problem.help = None;
        }
    }
    problems
}

/// Place of a key that test files have.
fn home(key: &str) -> Option<&'static str> {
    let tables = [
        (
            keys::<RawFile>(),
            "at the top of the file, before the first table",
        ),
        (keys::<RawCase>(), "in `[[case]]`"),
        (keys::<RawStep>(), "in `[[case.step]]`"),
    ];
    let with_key = tables.into_iter().find(|(keys, _)| keys.contains(&key));
    with_key.map(|(_, place)| place)
}

/// Keys of a table.
fn keys<'de, T: Deserialize<'de>>() -> &'static [&'static str] {
    let mut keys: &[&str] = &[];
    // Nothing is read: the reader is only asked for the names.
    _ = T::deserialize(Keys(&mut keys));
    keys
}

/// A reader that takes down the keys that a table may have.
struct Keys<'k>(&'k mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Keys<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("nothing to read"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        *self.0 = fields;
        self.deserialize_any(visitor)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct
        seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::home;

    #[test]
    fn keys_have_a_home() {
        assert_eq!(home("expect"), Some("in `[[case.step]]`"));
        assert_eq!(home("rejects"), Some("in `[[case]]`"));
        assert!(home("topic").is_some_and(|home| home.contains("top of the file")));
        assert_eq!(home("nothing"), None);
    }
}
