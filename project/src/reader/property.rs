//! `[[property]]` and `[verify]`.

use super::{Reader, Value, listed};
use crate::Project;
use crate::property::{PropertyKind, Row};
use rungc_syntax::Span;
use toml::de::DeTable;

/// The table of which each entry is a property.
pub(super) const PROPERTY: &str = "property";

/// The keys that define the kind of a property, each with those that may stand beside it.
const KINDS: [(&str, &[&str]); 5] = [
    ("never", &[]),
    ("always", &[]),
    ("reachable", &[]),
    ("whenever", &["then", "within"]),
    ("stays", &["until"]),
];

impl Reader {
    pub(super) fn properties(&mut self, at: Span, value: &Value<'_>, project: &mut Project) {
        for (at, table) in self.rows(PROPERTY, at, value) {
            let row = self.property(at, table);
            project.properties.extend(row);
        }
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
            let message = format!("a property has one of {}", listed(&names));
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
