//! `[[property]]` and `[verify]`.

use super::{Reader, Value, listed, span};
use crate::property::{Parameter, PropertyKind, Row, Use, UseSource};
use crate::{Named, Project};
use rungc_syntax::Span;
use toml::de::{DeTable, DeValue};

/// The table of which each entry is a property.
pub(super) const PROPERTY: &str = "property";

/// The keys that define the kind of a property, each with those that may stand beside it.
const KINDS: [(&str, &[&str]); 5] = [
    ("never", &[]),
    ("always", &[]),
    ("reachable", &[]),
    ("whenever", &["then", "within"]),
    ("stays", &["after", "until"]),
];

/// The keys of rows that stand for several properties.
const USES: [&str; 2] = ["use", "matrix"];

impl Reader {
    pub(super) fn properties(&mut self, at: Span, value: &Value<'_>, project: &mut Project) {
        for (at, table) in self.rows(PROPERTY, at, value) {
            if USES.iter().any(|key| table.contains_key(*key)) {
                let several = self.several(at, table);
                project.uses.extend(several);
                continue;
            }
            let row = self.property(at, table);
            project.properties.extend(row);
        }
    }

    /// A row that stands for several properties.
    fn several(&mut self, at: Span, table: &DeTable<'_>) -> Option<Use> {
        let name = self.get(table, "name").map(|name| name.text);
        let source = if table.contains_key("matrix") {
            self.known(PROPERTY, table, &["name", "matrix"]);
            UseSource::Matrix(self.get(table, "matrix")?)
        } else {
            UseSource::Function {
                function: self.get(table, "use")?,
                parameters: self.parameters(table),
            }
        };
        let span = at;
        Some(Use { name, source, span })
    }

    /// The keys of a row that are a function's own.
    fn parameters(&mut self, table: &DeTable<'_>) -> Vec<Parameter> {
        let mut found = Vec::new();
        for (key, value) in table {
            let word = key.get_ref().as_ref();
            if ["name", "use"].contains(&word) {
                continue;
            }
            let values = match value.get_ref() {
                DeValue::Array(_) => self.list(table, word),
                _ => self.duration(table, word).into_iter().collect(),
            };
            let key = Named {
                text: word.to_string(),
                span: span(key.span()),
            };
            found.push(Parameter { key, values });
        }
        found
    }

    fn property(&mut self, at: Span, table: &DeTable<'_>) -> Option<Row> {
        let kinds = KINDS.iter().filter(|(kind, _)| table.contains_key(*kind));
        let kinds: Vec<_> = kinds.collect();
        let [(kind, others)] = kinds[..] else {
            let names: Vec<_> = KINDS.iter().map(|(kind, _)| *kind).collect();
            let others = KINDS.iter().flat_map(|(_, others)| *others).copied();
            let keys: Vec<_> = names
                .iter()
                .copied()
                .chain(others)
                .chain(USES)
                .chain(["name"])
                .collect();
            if kinds.is_empty()
                && table
                    .keys()
                    .any(|key| !keys.contains(&key.get_ref().as_ref()))
            {
                self.known(PROPERTY, table, &keys);
                return None;
            }
            let all = [&names[..], &USES].concat();
            let message = format!("a property has one of {}", listed(&all));
            self.wrong(at, message, "add for example `never = \"Y000 & Y001\"`");
            return None;
        };
        let keys = [&["name", *kind], *others].concat();
        self.known(PROPERTY, table, &keys);
        let first = self.get(table, kind)?;
        let kind = match *kind {
            "never" => PropertyKind::Never(first),
            "always" => PropertyKind::Always(first),
            "reachable" => PropertyKind::Reachable(first),
            "whenever" => {
                if !table.contains_key("then") {
                    self.wrong(at, "`whenever` requires `then`", "add `then = \"…\"`");
                }
                PropertyKind::Whenever {
                    when: first,
                    then: self.get(table, "then")?,
                    within: self.duration(table, "within"),
                }
            }
            _ => PropertyKind::Stays {
                after: self.get(table, "after"),
                holds: first,
                until: self.get(table, "until"),
            },
        };
        Some(Row {
            name: self.get(table, "name").map(|name| name.text),
            kind,
            span: at,
        })
    }

    pub(super) fn verify(&mut self, table: &DeTable<'_>, project: &mut Project) {
        project.verify.assume = self.list(table, "assume");
        project.verify.scan = self.duration(table, "scan");
        project.verify.timeout = self.duration(table, "timeout");
        project.verify.free = self.devices(table, "free", "M100-M115");
    }
}
