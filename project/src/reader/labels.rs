//! `[labels]`.

use super::{Reader, Value, span};
use crate::{Label, Named, Project, device};
use rungc_syntax::{Device, Span};
use std::collections::HashMap;
use toml::de::{DeTable, DeValue};

impl Reader {
    pub(super) fn labels(&mut self, table: &DeTable<'_>, project: &mut Project) {
        self.labels_below("", table, &mut project.labels);
        let mut devices = HashMap::new();
        let mut names = HashMap::new();
        for label in &project.labels {
            let (device, span) = (label.device, label.span);
            if let Some(other) = devices.insert(device, &label.name) {
                let message = format!("{device} has a label, `{other}`");
                self.wrong(span, message, "a device has one label");
            }
            if let Some(other) = names.insert(label.name.to_lowercase(), device) {
                let message = format!("`{}` is the label of {other}, too", label.name);
                self.wrong(span, message, "labels differ in more than case");
            }
        }
    }

    /// The labels of a table, and of those in it: a label `Axis1.Ready` without quotes is two keys.
    fn labels_below(&mut self, above: &str, table: &DeTable<'_>, labels: &mut Vec<Label>) {
        for (key, value) in table {
            let name = format!("{above}{}", key.get_ref());
            if let DeValue::Table(below) = value.get_ref() {
                self.labels_below(&format!("{name}."), below, labels);
            } else if is_device(&name) || name.trim().is_empty() || name.contains(char::is_control)
            {
                let message = format!("`{}` is not a label", name.escape_debug());
                let help = "a label is a text of one line, and not a device";
                self.wrong(span(key.span()), message, help);
            } else if let Some((device, span)) = self.labelled(&name, value) {
                labels.push(Label { name, device, span });
            }
        }
    }

    /// The device of a label, with its place.
    fn labelled(&mut self, name: &str, value: &Value<'_>) -> Option<(Device, Span)> {
        let Named { text, span } = self.text(name, value)?;
        let found = device::device(&text.to_uppercase());
        if found.is_none() {
            let message = format!("`{text}` is not a device");
            self.wrong(span, message, "write for example `X000` or `D100`");
        }
        found.map(|device| (device, span))
    }
}

/// Returns true if a name reads as a device, so that it cannot name another one.
fn is_device(name: &str) -> bool {
    device::device(&name.to_uppercase()).is_some()
}
