//! Reads TOML into types that derive `Deserialize`, as `toml::from_str` does, with the same errors.
//!
//! The library's own deserializer takes a document apart by value, in 4 KB of machine code for each type. This one
//! looks at the parsed document, and gives a type what it asks for or an error: little is compiled for each type. It
//! reads enums whose variants have no values, structures from tables only, and no dates.
//!
//! The crate must not know what the tables are about. Start reading at [`from_str`].

mod spanned;

pub use spanned::Spanned;

use serde::de::value::StrDeserializer;
use serde::de::{DeserializeOwned, DeserializeSeed, Deserializer, MapAccess, SeqAccess};
use serde::de::{Error as _, Expected, IntoDeserializer, Unexpected, Visitor};
use std::fmt;
use std::ops::Range;
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
    fn about(mut self, node: Node<'_>) -> Self {
        self.span.get_or_insert_with(|| node.span());
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
    T::deserialize(Node::Document(&document))
}

/// A part of a document.
#[derive(Clone, Copy)]
enum Node<'de> {
    Document(&'de toml::Spanned<DeTable<'de>>),
    Value(&'de toml::Spanned<DeValue<'de>>),
    /// A key.
    Name(&'de toml::Spanned<DeString<'de>>),
    /// Where a part begins or ends.
    Place(usize),
}

/// What a part of a document is.
enum Content<'de> {
    Text(&'de str),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date,
    Items(Items<'de>),
    Fields(Fields<'de>),
}

impl<'de> Node<'de> {
    fn span(self) -> Range<usize> {
        match self {
            Node::Document(table) => table.span(),
            Node::Value(value) => value.span(),
            Node::Name(name) => name.span(),
            Node::Place(place) => place..place,
        }
    }

    fn content(self) -> Result<Content<'de>, Error> {
        let value = match self {
            Node::Document(table) => return Ok(Content::Fields(Fields::of(table.get_ref()))),
            Node::Name(name) => return Ok(Content::Text(name.get_ref())),
            Node::Place(place) => return Ok(Content::Integer(place as i64)),
            Node::Value(value) => value.get_ref(),
        };
        Ok(match value {
            DeValue::String(text) => Content::Text(text),
            DeValue::Integer(number) => {
                match i64::from_str_radix(number.as_str(), number.radix()) {
                    Ok(number) => Content::Integer(number),
                    Err(_) => return Err(Error::custom("integer number overflowed").about(self)),
                }
            }
            DeValue::Float(number) => match number.as_str().parse::<f64>() {
                Ok(value) if value.is_finite() || number.as_str().ends_with(['f', 'n']) => {
                    Content::Float(value)
                }
                _ => return Err(Error::custom("floating-point number overflowed").about(self)),
            },
            DeValue::Boolean(on) => Content::Boolean(*on),
            DeValue::Datetime(_) => Content::Date,
            DeValue::Array(items) => Content::Items(Items(items.iter())),
            DeValue::Table(table) => Content::Fields(Fields::of(table)),
        })
    }

    /// Something else is expected.
    #[cold]
    fn misfit(self, expected: &dyn Expected) -> Error {
        let content = match self.content() {
            Ok(content) => content,
            Err(error) => return error,
        };
        let unexpected = match content {
            Content::Text(text) => Unexpected::Str(text),
            Content::Integer(number) => Unexpected::Signed(number),
            Content::Float(number) => Unexpected::Float(number),
            Content::Boolean(on) => Unexpected::Bool(on),
            Content::Items(_) => Unexpected::Seq,
            Content::Date | Content::Fields(_) => Unexpected::Map,
        };
        Error::invalid_type(unexpected, expected).about(self)
    }

    fn text(self) -> Option<&'de str> {
        match self {
            Node::Name(name) => Some(name.get_ref()),
            Node::Value(value) => value.get_ref().as_str(),
            Node::Document(_) | Node::Place(_) => None,
        }
    }

    fn integer(self) -> Option<i64> {
        match self.content() {
            Ok(Content::Integer(number)) => Some(number),
            _ => None,
        }
    }

    fn fields(self) -> Option<Fields<'de>> {
        match self.content() {
            Ok(Content::Fields(fields)) => Some(fields),
            _ => None,
        }
    }

    fn items(self) -> Option<Items<'de>> {
        match self.content() {
            Ok(Content::Items(items)) => Some(items),
            _ => None,
        }
    }

    fn visit_integer<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.integer() {
            Some(number) => visitor
                .visit_i64(number)
                .map_err(|error: Error| error.about(self)),
            None => Err(self.misfit(&visitor)),
        }
    }

    fn visit_text<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.text() {
            Some(text) => visitor
                .visit_borrowed_str(text)
                .map_err(|error: Error| error.about(self)),
            None => Err(self.misfit(&visitor)),
        }
    }

    fn visit_fields<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.fields() {
            Some(fields) => visitor.visit_map(fields).map_err(|error| error.about(self)),
            None => Err(self.misfit(&visitor)),
        }
    }

    fn visit_items<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.items() {
            Some(items) => visitor.visit_seq(items).map_err(|error| error.about(self)),
            None => Err(self.misfit(&visitor)),
        }
    }
}

/// Methods of a deserializer that give the content of one kind.
macro_rules! give {
    ($($method:ident: $visit:ident,)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.$visit(visitor)
        }
    )*};
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        let visited = match self.content()? {
            Content::Text(text) => visitor.visit_borrowed_str(text),
            Content::Integer(number) => visitor.visit_i64(number),
            Content::Float(number) => visitor.visit_f64(number),
            Content::Boolean(on) => visitor.visit_bool(on),
            Content::Date => return Err(self.misfit(&visitor)),
            Content::Items(items) => visitor.visit_seq(items),
            Content::Fields(fields) => visitor.visit_map(fields),
        };
        visited.map_err(|error: Error| error.about(self))
    }

    give! {
        deserialize_u8: visit_integer,
        deserialize_u16: visit_integer,
        deserialize_u32: visit_integer,
        deserialize_u64: visit_integer,
        deserialize_i8: visit_integer,
        deserialize_i16: visit_integer,
        deserialize_i32: visit_integer,
        deserialize_i64: visit_integer,
        deserialize_char: visit_text,
        deserialize_str: visit_text,
        deserialize_string: visit_text,
        deserialize_identifier: visit_text,
        deserialize_seq: visit_items,
        deserialize_map: visit_fields,
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_unit()
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

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.visit_items(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        match name {
            spanned::NAME => visitor.visit_seq(Parts::of(self)),
            _ => self.visit_items(visitor),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.visit_fields(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let Some(name) = self.text() else {
            return Err(Error::custom("wanted string or table").about(self));
        };
        let name: StrDeserializer<Error> = name.into_deserializer();
        visitor.visit_enum(name).map_err(|error| error.about(self))
    }

    serde::forward_to_deserialize_any! { bool u128 i128 f32 f64 bytes byte_buf unit unit_struct }
}

/// What is in an array.
struct Items<'de>(std::slice::Iter<'de, toml::Spanned<DeValue<'de>>>);

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        match self.0.next() {
            Some(item) => seed.deserialize(Node::Value(item)).map(Some),
            None => Ok(None),
        }
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.0.len())
    }
}

/// Where a value begins and ends, and the value itself, the last of them first.
struct Parts<'de> {
    rest: Vec<Node<'de>>,
    value: Node<'de>,
}

impl<'de> Parts<'de> {
    fn of(value: Node<'de>) -> Self {
        let span = value.span();
        let rest = vec![value, Node::Place(span.end), Node::Place(span.start)];
        Parts { rest, value }
    }
}

impl<'de> SeqAccess<'de> for Parts<'de> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        match self.rest.pop() {
            Some(part) => seed
                .deserialize(part)
                .map(Some)
                .map_err(|error| error.about(self.value)),
            None => Ok(None),
        }
    }
}

/// The keys of a table with their values, the last one first.
struct Fields<'de> {
    rest: Vec<(Node<'de>, Node<'de>)>,
    value: Option<Node<'de>>,
}

impl<'de> Fields<'de> {
    fn of(table: &'de DeTable<'de>) -> Self {
        let fields = table.iter().rev();
        Fields {
            rest: fields
                .map(|(key, value)| (Node::Name(key), Node::Value(value)))
                .collect(),
            value: None,
        }
    }

    /// The next key; its value is the next one to be asked for.
    fn key(&mut self) -> Option<Node<'de>> {
        let (key, value) = self.rest.pop()?;
        self.value = Some(value);
        Some(key)
    }

    fn value(&mut self) -> Result<Node<'de>, Error> {
        let value = self.value.take();
        value.ok_or_else(|| Error::custom("a value is asked for before its key"))
    }
}

impl<'de> MapAccess<'de> for Fields<'de> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        match self.key() {
            Some(key) => seed
                .deserialize(key)
                .map(Some)
                .map_err(|error| error.about(key)),
            None => Ok(None),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let value = self.value()?;
        seed.deserialize(value).map_err(|error| error.about(value))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.rest.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Types with one kind of values with places.
    macro_rules! types {
        ($name:ident, $spanned:path) => {
            mod $name {
                use serde::Deserialize;
                use std::collections::BTreeMap;
                use $spanned;

                #[derive(Deserialize, Debug, PartialEq)]
                #[serde(deny_unknown_fields)]
                pub struct Document {
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
            }
        };
    }

    types!(own, crate::Spanned);
    types!(expected, toml::Spanned);

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
            let own: Result<own::Document, _> = from_str(text);
            let own = own.map_err(|error| (error.message().to_string(), error.span()));
            let expected: Result<expected::Document, _> = toml::from_str(text);
            let expected = expected.map_err(|error| (error.message().to_string(), error.span()));
            assert_eq!(format!("{own:?}"), format!("{expected:?}"), "{text}");
        }
    }

    #[test]
    fn structures_are_read_from_tables_only() {
        let error = from_str::<own::Document>("name = 'a'\npart = [[true]]");
        let error = error.unwrap_err();
        assert_eq!(
            error.to_string(),
            "invalid type: sequence, expected struct Part"
        );
        assert_eq!(error.span(), Some(19..25));
    }

    #[test]
    fn larger_integers_are_errors() {
        let error = from_str::<own::Document>("name = 'a'\npair = [1, 9223372036854775808]");
        let error = error.unwrap_err();
        assert_eq!(error.to_string(), "integer number overflowed");
        assert_eq!(error.span(), Some(22..41));
    }
}
