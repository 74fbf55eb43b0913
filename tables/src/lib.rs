//! Reads TOML into types that derive `Deserialize`, as `toml::from_str` does, with the same errors.
//!
//! The library's own deserializer takes a document apart by value, in 4 KB of machine code for each type. This one
//! looks at the parsed document. It reads enums whose variants have no values, and no dates.
//!
//! The crate must not know what the tables are about. Start reading at [`from_str`].

use serde::de::value::StrDeserializer;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, MapAccess, SeqAccess};
use serde::de::{Error as _, IntoDeserializer, Unexpected, Visitor};
use std::fmt;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// What is wrong in a document.
#[derive(Debug)]
pub struct Error {
    message: String,
    span: Option<Range<usize>>,
}

impl Error {
    /// What is wrong, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// The bytes of the document that it is about.
    pub fn span(&self) -> Option<Range<usize>> {
        self.span.clone()
    }

    /// The error is about this, unless it is already known to be about a part of it.
    fn about(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Error {}

impl serde::de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        let message = message.to_string();
        Error {
            message,
            span: None,
        }
    }
}

/// Reads a document; errors have their place in it.
pub fn from_str<T: DeserializeOwned>(text: &str) -> Result<T, Error> {
    let document = DeTable::parse(text).map_err(|error| Error {
        message: error.message().to_string(),
        span: error.span(),
    })?;
    let span = document.span();
    let node = Node {
        kind: Kind::Table(document.get_ref()),
        span,
    };
    T::deserialize(node)
}

/// A part of a document.
#[derive(Clone)]
struct Node<'de> {
    kind: Kind<'de>,
    span: Range<usize>,
}

#[derive(Clone, Copy)]
enum Kind<'de> {
    Value(&'de DeValue<'de>),
    Table(&'de DeTable<'de>),
    /// A key.
    Name(&'de str),
    /// Where a part begins or ends.
    Place(usize),
}

impl<'de> Node<'de> {
    fn value(value: &'de Spanned<DeValue<'de>>) -> Self {
        let kind = Kind::Value(value.get_ref());
        let span = value.span();
        Node { kind, span }
    }

    fn name(name: &'de str, span: Range<usize>) -> Self {
        let kind = Kind::Name(name);
        Node { kind, span }
    }

    fn visit<V: Visitor<'de>>(&self, visitor: V) -> Result<V::Value, Error> {
        let value = match self.kind {
            Kind::Value(value) => value,
            Kind::Table(table) => return visitor.visit_map(Fields::of(table)),
            Kind::Name(name) => return visitor.visit_borrowed_str(name),
            Kind::Place(place) => return visitor.visit_u64(place as u64),
        };
        match value {
            DeValue::String(text) => visitor.visit_borrowed_str(text),
            DeValue::Integer(number) => {
                match i64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(number) => visitor.visit_i64(number),
                    Err(_) => Err(Error::custom("integer number overflowed")),
                }
            }
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || number.as_str().ends_with(['f', 'n']) => {
                    visitor.visit_f64(value)
                }
                _ => Err(Error::custom("floating-point number overflowed")),
            },
            DeValue::Boolean(on) => visitor.visit_bool(*on),
            DeValue::Datetime(_) => Err(Error::invalid_type(Unexpected::Map, &visitor)),
            DeValue::Array(items) => visitor.visit_seq(Items(items.iter())),
            DeValue::Table(table) => visitor.visit_map(Fields::of(table)),
        }
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.visit(visitor).map_err(|error| error.about(&self.span))
    }

    // A field that is missing is `None`.
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        match fields {
            [start, end, value] if start.starts_with(SPANNED) => {
                visitor.visit_map(Fields::of_spanned([start, end, value], self))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let name: &str = match self.kind {
            Kind::Value(DeValue::String(text)) => text,
            Kind::Name(name) => name,
            _ => return Err(Error::custom("wanted string or table").about(&self.span)),
        };
        let name: StrDeserializer<Error> = name.into_deserializer();
        let read = visitor.visit_enum(name);
        read.map_err(|error| error.about(&self.span))
    }

    serde::forward_to_deserialize_any! {
        bool u8 u16 u32 u64 u128 i8 i16 i32 i64 i128 f32 f64 char str string seq bytes byte_buf map unit ignored_any
        unit_struct tuple_struct tuple identifier
    }
}

/// How the fields of a value with its place begin, which `toml::Spanned` asks for.
const SPANNED: &str = "$__serde_spanned_private_";

/// What is in an array.
struct Items<'de>(std::slice::Iter<'de, Spanned<DeValue<'de>>>);

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        let item = self.0.next();
        item.map(|item| seed.deserialize(Node::value(item)))
            .transpose()
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// The keys of a table with their values, the last one first.
struct Fields<'de> {
    rest: Vec<(Node<'de>, Node<'de>)>,
    value: Option<Node<'de>>,
}

impl<'de> Fields<'de> {
    fn of(table: &'de DeTable<'de>) -> Self {
        let field = |(key, value): (&'de Spanned<DeString<'de>>, &'de Spanned<DeValue<'de>>)| {
            (Node::name(key.get_ref(), key.span()), Node::value(value))
        };
        Fields {
            rest: table.iter().rev().map(field).collect(),
            value: None,
        }
    }

    /// Where a part begins and ends, and the part itself, by the names that are asked for.
    fn of_spanned(names: [&'de str; 3], node: Node<'de>) -> Self {
        let span = node.span.clone();
        let place = |place| Node {
            kind: Kind::Place(place),
            span: span.clone(),
        };
        let parts = [place(span.start), place(span.end), node];
        let names = names.map(|name| Node::name(name, span.clone()));
        Fields {
            rest: names.into_iter().zip(parts).rev().collect(),
            value: None,
        }
    }
}

impl<'de> MapAccess<'de> for Fields<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        let Some((key, value)) = self.rest.pop() else {
            return Ok(None);
        };
        self.value = Some(value);
        let span = key.span.clone();
        let key = seed.deserialize(key).map_err(|error| error.about(&span))?;
        Ok(Some(key))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let value = self.value.take();
        let value = value.ok_or_else(|| Error::custom("a value is asked for before its key"))?;
        let span = value.span.clone();
        seed.deserialize(value).map_err(|error| error.about(&span))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;
    use std::collections::BTreeMap;

    #[derive(Deserialize, Debug, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Document {
        name: Spanned<String>,
        kind: Option<Kind>,
        #[serde(default)]
        values: BTreeMap<Spanned<String>, Spanned<Scalar>>,
        #[serde(default)]
        part: Vec<Spanned<Part>>,
        pair: Option<[u16; 2]>,
    }

    #[derive(Deserialize, Debug, PartialEq)]
    #[serde(rename_all = "lowercase")]
    enum Kind {
        Large,
        Small,
    }

    #[derive(Deserialize, Debug, PartialEq)]
    #[serde(untagged)]
    enum Scalar {
        Integer(i64),
        Float(f64),
        Text(String),
    }

    #[derive(Deserialize, Debug, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Part {
        on: bool,
        count: Option<Spanned<u32>>,
        hz: Option<f64>,
    }

    /// Documents as they are read, and with mistakes of all kinds.
    const DOCUMENTS: &[&str] = &[
        "name = 'a'",
        "name = \"\\u00e4\\n\"\nkind = 'small'\npair = [1, 0xFF]",
        "name = 'a'\n[values]\nb = 1\n\"c d\" = -0b11_01\ne = 1.5e3\nf = \"text\"\ng = -inf\nh = 2E-1",
        "name = 'a'\npart = [{ on = true }, { on = false, count = 3, hz = 2.5 }]",
        "name = 'a'\n[[part]]\non = true\n[[part]]\non = true\nhz = 1e400",
        "",
        "name = 'a",
        "name = 1",
        "name = 'a'\nname = 'b'",
        "name = 'a'\nsize = 3",
        "name = 'a'\nkind = 'huge'",
        "name = 'a'\nkind = 3",
        "name = 'a'\npair = [1]",
        "name = 'a'\npair = [1, 65536]",
        "name = 'a'\npair = [1, -1]",
        "name = 'a'\npart = {}",
        "name = 'a'\n[[part]]\ncount = 3",
        "name = 'a'\n[[part]]\non = 'yes'",
        "name = 'a'\n[[part]]\non = true\ncount = 1.5",
        "name = 'a'\n[[part]]\non = true\ncount = 2024-01-01",
        "name = 'a'\n[[part]]\non = true\nhz = 3",
        "name = 'a'\n[[part]]\non = true\nhz = true",
        "name = 'a'\nvalues = 3",
        "name = 'a'\nvalues = { b = [] }",
        "name = 'a'\nvalues = { b = true }",
        "name = 1979-05-27T07:32:00Z",
    ];

    #[test]
    fn documents_and_mistakes_are_read_as_the_library_reads_them() {
        for text in DOCUMENTS {
            let own: Result<Document, _> = from_str(text);
            let own = own.map_err(|error| (error.message().to_string(), error.span()));
            let expected: Result<Document, _> = toml::from_str(text);
            let expected = expected.map_err(|error| (error.message().to_string(), error.span()));
            assert_eq!(own, expected, "{text}");
        }
    }

    #[test]
    fn larger_integers_are_errors() {
        let error = from_str::<Document>("name = 'a'\npair = [1, 9223372036854775808]");
        let error = error.unwrap_err();
        assert_eq!(error.to_string(), "integer number overflowed");
        assert_eq!(error.span(), Some(22..41));
    }
}
