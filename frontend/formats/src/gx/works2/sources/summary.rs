//! What sources add to a compiled program: names of devices, and notes about what the project holds.

use super::{Body, PouKind, Sources};
use crate::gx::damaged_rest;
use crate::text::clean;
use rungc_syntax::{Device, Diagnostic, Span, codes};
use std::collections::BTreeMap;

/// Maximum number of unreadable parts that have a message each.
const SHOWN: usize = 8;

impl Sources {
    /// Gives devices without a comment the names of their labels. Of several labels of one device, the first counts.
    pub(in crate::gx::works2) fn name_devices(&self, comments: &mut BTreeMap<Device, String>) {
        for one in self.devices() {
            if let Some(name) = clean(&one.name) {
                comments.entry(one.device).or_insert(name.into());
            }
        }
    }

    /// A note of what the project holds, and a warning for each part that cannot be read.
    pub(in crate::gx::works2) fn notes(&self) -> Vec<Diagnostic> {
        let is_structured = self.is_structured();
        let unread = self.unread.iter();
        let unread = unread.filter(|unread| is_structured || !unread.is_source);
        let unread = unread.take(SHOWN);
        let unread = unread.map(|unread| damaged_rest(&unread.what, &unread.bytes, unread.at));
        let summary = is_structured.then(|| {
            codes::SOURCES
                .at(Span::default(), format!("the project holds {}", self.held()))
                .label("the compiled program starts here")
                .help("`rungc convert --to st -o FOLDER` writes its sources as text, `--to labels` its labels")
        });
        summary.into_iter().chain(unread).collect()
    }

    /// Numbers of POUs, with their languages, and of labels.
    fn held(&self) -> String {
        let kinds = [
            ("program", |kind| kind == PouKind::Program),
            ("function block", |kind| {
                matches!(kind, PouKind::Block { .. })
            }),
            ("function", |kind| kind == PouKind::Function),
        ] as [(&str, fn(PouKind) -> bool); 3];
        let kinds = kinds.map(|(name, is)| {
            let number = self.pous.iter().filter(|pou| is(pou.kind)).count();
            some(number, name)
        });
        let mut languages: BTreeMap<&str, usize> = BTreeMap::new();
        for pou in &self.pous {
            *languages.entry(pou.body.language()).or_insert(0) += 1;
        }
        let languages = languages
            .iter()
            .map(|(name, number)| format!("{number} {name}"));
        let languages: Vec<_> = languages.collect();
        let labels = some(self.labels().count(), "label");
        let structures = some(self.structures.len(), "structure");
        let parts: Vec<_> = kinds
            .into_iter()
            .chain([structures, labels])
            .flatten()
            .collect();
        let has_chart = self.pous.iter().any(|pou| pou.body == Body::Chart);
        let chart = if has_chart {
            "; SFC is not decoded"
        } else {
            ""
        };
        format!(
            "{} (sources: {}{chart})",
            parts.join(", "),
            languages.join(", ")
        )
    }
}

/// A number of things, unless there are none.
fn some(number: usize, what: &str) -> Option<String> {
    match number {
        0 => None,
        1 => Some(format!("1 {what}")),
        number => Some(format!("{number} {what}s")),
    }
}
