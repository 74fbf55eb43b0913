//! Test files as TOML has them.

use super::Basis;
use super::modules;
use super::program::RawProgram;
use super::serial::{Protocol, RawMode, RawSent};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use toml::Spanned;

/// Values by names, each with its place.
pub(super) type Map<T> = BTreeMap<Spanned<String>, T>;

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawFile {
    pub(super) model: Option<Spanned<String>>,
    pub(super) topic: String,
    pub(super) note: Option<String>,
    pub(super) program: Option<Spanned<RawProgram>>,
    pub(super) machine: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) modules: modules::Raw,
    pub(super) index: Option<Spanned<IgnoredAny>>,
    #[serde(default)]
    pub(super) scenario: Vec<RawScenario>,
    pub(super) never: Option<Spanned<RawRules>>,
    pub(super) always: Option<Spanned<RawRules>>,
    pub(super) reachable: Option<Spanned<RawRules>>,
    #[serde(default)]
    pub(super) whenever: Vec<Spanned<RawWhenever>>,
    #[serde(default)]
    pub(super) stays: Vec<Spanned<RawStays>>,
    pub(super) case: Vec<Spanned<RawCase>>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawCase {
    pub(super) name: Spanned<String>,
    pub(super) model: Option<Spanned<String>>,
    pub(super) requirement: Option<Spanned<RawNames>>,
    #[serde(default)]
    pub(super) source: String,
    pub(super) basis: Option<Basis>,
    #[serde(default)]
    pub(super) note: String,
    pub(super) program: Option<Spanned<RawProgram>>,
    pub(super) machine: Option<Spanned<String>>,
    #[serde(default)]
    pub(super) modules: modules::Raw,
    pub(super) index: Option<Spanned<IgnoredAny>>,
    #[serde(default)]
    pub(super) init: Map<Spanned<Scalar>>,
    #[serde(default)]
    pub(super) step: Vec<Spanned<RawStep>>,
    #[serde(default)]
    pub(super) plc: Vec<RawPlc>,
    #[serde(default)]
    pub(super) wire: Vec<Vec<Spanned<String>>>,
    #[serde(default)]
    pub(super) serve: Map<Protocol>,
    #[serde(default)]
    pub(super) rows: Vec<RawRow>,
    pub(super) never: Option<Spanned<RawRules>>,
    pub(super) always: Option<Spanned<RawRules>>,
    pub(super) reachable: Option<Spanned<RawRules>>,
    #[serde(default)]
    pub(super) whenever: Vec<Spanned<RawWhenever>>,
    #[serde(default)]
    pub(super) stays: Vec<Spanned<RawStays>>,
    #[serde(default)]
    pub(super) trace: Vec<Spanned<String>>,
    pub(super) rejects: Option<RawRejects>,
}

/// A condition: a text as properties have it, or devices and their values.
#[derive(Clone)]
pub(super) enum RawCondition {
    Text(String),
    Table(Map<Spanned<Scalar>>),
}

/// One condition, or several.
#[derive(Clone)]
pub(super) enum RawRules {
    One(RawCondition),
    Several(Vec<Spanned<RawCondition>>),
}

impl RawRules {
    /// The conditions with their places.
    pub(super) fn all(rules: Spanned<RawRules>) -> Vec<Spanned<RawCondition>> {
        let span = rules.span();
        match rules.into_inner() {
            RawRules::One(only) => vec![Spanned::new(span, only)],
            RawRules::Several(several) => several,
        }
    }
}

/// Something that continues until something else happens.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawStays {
    pub(super) after: Option<Spanned<String>>,
    pub(super) holds: Spanned<String>,
    pub(super) until: Option<Spanned<String>>,
}

/// A name, or several.
#[derive(Clone, Deserialize)]
#[serde(
    untagged,
    expecting = "expected an identifier in quotes, or a list of them"
)]
pub(super) enum RawNames {
    One(String),
    Several(Vec<String>),
}

/// Values of the names with a `$` in one of several cases.
pub(super) type RawRow = Spanned<Map<Spanned<Scalar>>>;

/// Steps that cases run by a name.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawScenario {
    pub(super) name: Spanned<String>,
    pub(super) step: Vec<Spanned<RawStep>>,
}

/// One thing follows another.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawWhenever {
    pub(super) when: Spanned<RawCondition>,
    pub(super) then: Spanned<RawCondition>,
    pub(super) within_ms: Option<Spanned<RawCount>>,
    pub(super) within: Option<Spanned<String>>,
}

/// Condition within a time of a step.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawWithin {
    pub(super) ms: Spanned<RawCount>,
    pub(super) expect: Map<Spanned<Scalar>>,
}

/// A whole number, or one of a row.
#[derive(Clone, Deserialize)]
#[serde(untagged, expecting = "expected a whole number from 0 to 4294967295")]
pub(super) enum RawCount {
    Number(u32),
    Name(String),
}

/// A PLC beside that of the case.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawPlc {
    pub(super) name: Spanned<String>,
    pub(super) model: Option<Spanned<String>>,
    pub(super) program: String,
    #[serde(default)]
    pub(super) init: Map<Spanned<Scalar>>,
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawRejects {
    pub(super) code: u16,
    pub(super) line: Option<u32>,
}

#[derive(Clone, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct RawStep {
    pub(super) set: Map<Spanned<Scalar>>,
    #[serde(rename = "do")]
    pub(super) scenario: Option<Spanned<String>>,
    pub(super) scans: Option<Spanned<RawCount>>,
    pub(super) run_ms: Option<Spanned<RawCount>>,
    pub(super) until: Map<Spanned<Scalar>>,
    pub(super) at_most_ms: Option<Spanned<RawCount>>,
    pub(super) scan_ms: Option<Spanned<RawCount>>,
    pub(super) within: Vec<Spanned<RawWithin>>,
    pub(super) never: Option<Spanned<RawRules>>,
    pub(super) whenever: Vec<Spanned<RawWhenever>>,
    pub(super) expect: Map<Spanned<Scalar>>,
    pub(super) pulses: Option<Map<RawPulses>>,
    pub(super) encoder: Option<RawEncoder>,
    pub(super) rx: Option<Map<String>>,
    pub(super) expect_tx: Option<Map<RawSent>>,
    pub(super) cut: Option<Vec<Spanned<String>>>,
    pub(super) clock: Option<Spanned<String>>,
    pub(super) mode: Option<Spanned<RawMode>>,
    pub(super) power_fails: Option<bool>,
    pub(super) power_cycle: bool,
    pub(super) bfm: Map<Spanned<Scalar>>,
    pub(super) expect_bfm: Map<Spanned<Scalar>>,
    pub(super) answers_after: modules::RawDelays,
    pub(super) expect_position: BTreeMap<String, f64>,
    pub(super) analog: Map<Spanned<Scalar>>,
}

/// Pulses at an input.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawPulses {
    pub(super) count: u32,
    pub(super) hz: f64,
}

/// An encoder's cycles.
#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawEncoder {
    pub(super) a: Spanned<String>,
    pub(super) b: Spanned<String>,
    pub(super) count: i32,
    pub(super) hz: f64,
}

/// A value of a device.
#[derive(Clone)]
pub(super) enum Scalar {
    Integer(i64),
    Float(f64),
    Text(String),
    Near(Near),
}

/// A number that need not be exact.
#[derive(Clone, Copy)]
pub(super) struct Near {
    /// The number in the middle.
    pub(super) value: f64,
    /// Tolerance, in the same unit.
    pub(super) tolerance: f64,
}

impl<'de> Deserialize<'de> for Scalar {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ScalarVisitor)
    }
}

impl<'de> Deserialize<'de> for RawCondition {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ConditionVisitor)
    }
}

struct ConditionVisitor;

impl<'de> Visitor<'de> for ConditionVisitor {
    type Value = RawCondition;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a condition: `\"Y000 & Y001\"`, or `{ Y000 = 1, Y001 = 1 }`")
    }

    fn visit_str<E>(self, text: &str) -> Result<RawCondition, E> {
        Ok(RawCondition::Text(text.to_string()))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawCondition, A::Error> {
        let table = Map::deserialize(MapAccessDeserializer::new(map))?;
        Ok(RawCondition::Table(table))
    }
}

impl<'de> Deserialize<'de> for RawRules {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(RulesVisitor)
    }
}

struct RulesVisitor;

impl<'de> Visitor<'de> for RulesVisitor {
    type Value = RawRules;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        ConditionVisitor.expecting(f)?;
        f.write_str(", or a list of such")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<RawRules, E> {
        ConditionVisitor.visit_str(text).map(RawRules::One)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawRules, A::Error> {
        ConditionVisitor.visit_map(map).map(RawRules::One)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<RawRules, A::Error> {
        let mut several = Vec::new();
        while let Some(condition) = seq.next_element()? {
            several.push(condition);
        }
        Ok(RawRules::Several(several))
    }
}

struct ScalarVisitor;

/// Words after the dot of a name that TOML takes for a table, if the name is not in quotes.
const VIEWS: [&str; 6] = ["value", "i32", "f32", "str", "pulses", "hz"];

impl<'de> Visitor<'de> for ScalarVisitor {
    type Value = Scalar;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, a text in quotes, or `{ value = 5, tolerance = 1 }`")
    }

    fn visit_i64<E>(self, value: i64) -> Result<Scalar, E> {
        Ok(Scalar::Integer(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Scalar, E> {
        Ok(Scalar::Float(value))
    }

    fn visit_str<E>(self, text: &str) -> Result<Scalar, E> {
        Ok(Scalar::Text(text.to_string()))
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Scalar, E> {
        let bit = u8::from(value);
        Err(E::custom(format!("write {bit}, not {value}")))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, _: A) -> Result<Scalar, A::Error> {
        let message = "a list is not a value: give each device its own";
        Err(A::Error::custom(message))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Scalar, A::Error> {
        let (mut value, mut tolerance) = (None, None);
        while let Some(key) = map.next_key::<String>()? {
            let view = VIEWS.iter().find(|view| **view == key);
            match (key.as_str(), view) {
                ("value", _) => value = Some(map.next_value()?),
                ("tolerance", _) => tolerance = Some(map.next_value()?),
                (_, Some(view)) => {
                    let message =
                        format!("write a name with a dot in quotes, such as `\"D0.{view}\"`");
                    return Err(A::Error::custom(message));
                }
                _ => return Err(A::Error::unknown_field(&key, &["value", "tolerance"])),
            }
        }
        match (value, tolerance) {
            (Some(value), Some(tolerance)) if tolerance >= 0.0 => {
                Ok(Scalar::Near(Near { value, tolerance }))
            }
            (Some(_), Some(_)) => Err(A::Error::custom("`tolerance` is 0 or more")),
            (Some(_), None) => {
                let message = "write a name with a dot in quotes, such as `\"T0.value\"`; or is `tolerance` missing?";
                Err(A::Error::custom(message))
            }
            (None, _) => Err(A::Error::missing_field("value")),
        }
    }
}
