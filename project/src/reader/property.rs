//! `[[property]]` and `[verify]`.

use super::{Reader, Value, listed, span};
use crate::property::{Parameter, PropertyKind, Requirement, Row, Use, UseSource};
use crate::{Named, Project};
use rungc_syntax::{Span, text};
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
/// The keys of every property: its name, and those of the requirement that it belongs to.
const COMMON: [&str; 4] = ["name", "id", "text", "source"];

impl Reader {
    pub(super) fn properties(&mut self, at: Span, value: &Value<'_>, project: &mut Project) {
        for (at, table) in self.rows(PROPERTY, at, value) {
            let id = self.requirement(at, table, &mut project.requirements);
            if is_requirement(table) {
                self.known(PROPERTY, table, &COMMON);
                continue;
            }
            if USES.iter().any(|key| table.contains_key(*key)) {
                if let Some(several) = self.several(at, table) {
                    project.uses.push(Use {
                        requirement: id,
                        ..several
                    });
                }
                continue;
            }
            if let Some(row) = self.property(at, table) {
                project.properties.push(Row {
                    requirement: id,
                    ..row
                });
            }
        }
    }

    /// A row that stands for several properties.
    fn several(&mut self, at: Span, table: &DeTable<'_>) -> Option<Use> {
        let name = self.get(table, "name").map(|name| name.text);
        let source = if table.contains_key("matrix") {
            self.known(PROPERTY, table, &[&COMMON[..], &["matrix"]].concat());
            UseSource::Matrix(self.get(table, "matrix")?)
        } else {
            UseSource::Function {
                function: self.get(table, "use")?,
                parameters: self.parameters(table),
            }
        };
        let span = at;
        Some(Use {
            name,
            requirement: None,
            source,
            span,
        })
    }

    /// The keys of a row that are a function's own.
    fn parameters(&mut self, table: &DeTable<'_>) -> Vec<Parameter> {
        let mut found = Vec::new();
        for (key, value) in table {
            let word = key.get_ref().as_ref();
            if word == "use" || COMMON.contains(&word) {
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

    /// Takes notice of the requirement of a row; its identifier. Rows with the same one describe one requirement.
    fn requirement(
        &mut self,
        at: Span,
        table: &DeTable<'_>,
        known: &mut Vec<Requirement>,
    ) -> Option<String> {
        let given = ["text", "source"].map(|key| (key, self.get(table, key)));
        let Some(id) = self.get(table, "id") else {
            let named = given.into_iter().find_map(|(_, named)| named);
            if let Some(named) = named.filter(|_| !table.contains_key("id")) {
                let message =
                    "`text` and `source` describe a requirement, and this row has no `id`";
                self.wrong(named.span, message, "add `id = \"R1\"`");
            }
            return None;
        };
        if id.text.trim().is_empty() || id.text.contains(text::acts) {
            let message = "`id` must be one line of text";
            self.wrong(id.span, message, "write for example `id = \"R1\"`");
            return None;
        }
        let index = known.iter().position(|other| other.id == id.text);
        let index = index.unwrap_or_else(|| {
            known.push(Requirement {
                id: id.text.clone(),
                text: String::new(),
                source: String::new(),
                span: at,
            });
            known.len() - 1
        });
        for (key, named) in given {
            let Some(named) = named else { continue };
            let field = match key {
                "text" => &mut known[index].text,
                _ => &mut known[index].source,
            };
            if field.is_empty() {
                *field = named.text;
            } else if *field != named.text {
                let message = format!(
                    "`{key}` of the requirement `{}` is different above",
                    id.text
                );
                let help = "write it once, in the first row with this `id`";
                self.wrong(named.span, message, help);
            }
        }
        Some(id.text)
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
                .chain(COMMON)
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
        let keys = [&COMMON[..], &[*kind], *others].concat();
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
            requirement: None,
            kind,
            span: at,
        })
    }

    pub(super) fn verify(&mut self, table: &DeTable<'_>, project: &mut Project) {
        project.verify.assume = self.list(table, "assume");
        project.verify.scan = self.duration(table, "scan");
        if table.contains_key("effort") {
            let efforts = 1..=u32::MAX;
            project.verify.effort = self.number(table, Span::default(), "effort", efforts, None);
        }
        project.verify.timeout = self.duration(table, "timeout");
        project.verify.free = self.devices(table, "free", "M100-M115");
    }
}

/// Returns true for a row that says what is required, and not how a program shows it: tests do, or nothing yet.
fn is_requirement(table: &DeTable<'_>) -> bool {
    let mut keys = table.keys().map(|key| key.get_ref().as_ref());
    table.contains_key("id") && keys.all(|key| COMMON.contains(&key))
}
