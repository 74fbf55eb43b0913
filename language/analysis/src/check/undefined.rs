//! Special devices that a program reads or writes and to which the model gives no meaning.

use super::Code;
use crate::accesses::Access;
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Device, Diagnostics, Span, codes};
use std::collections::BTreeMap;

/// A longer run of devices is cleared or copied as a whole; it does not mean one of them.
const MAX_RUN: u32 = 32;

/// Special devices without a meaning that a program names, each with its first place and true if it is written there.
#[derive(Default)]
pub(super) struct Undefined {
    used: BTreeMap<Device, (Span, bool)>,
}

impl Undefined {
    /// Takes an access.
    pub(super) fn note(&mut self, code: &Code, access: &Access) {
        let Some(count) = access.count.filter(|&count| count <= MAX_RUN) else {
            return;
        };
        let (class, first) = (access.first.class, access.first.number);
        let numbers = first..first.saturating_add(count);
        for number in numbers.filter(|&number| is_special(class, number)) {
            if code.model().has(class, number) && code.model().special(class, number).is_none() {
                let device = Device { class, number };
                let place = (access.span, access.writes());
                self.used.entry(device).or_insert(place);
            }
        }
    }

    /// Warns of them, in one diagnostic.
    pub(super) fn report(self, model: &'static Model, out: &mut Diagnostics) {
        let mut used: Vec<_> = self.used.into_iter().collect();
        used.sort_by_key(|&(device, (span, _))| (span, device));
        let Some((&(first, (span, written)), others)) = used.split_first() else {
            return;
        };
        let subject = match others.len() {
            0 => format!("`{first}` has"),
            n => format!("`{first}` and {n} more special devices have"),
        };
        let message = format!("{subject} no meaning on {}", model.title);
        let mut diagnostic = codes::UNDEFINED_SPECIAL
            .at(span, message)
            .label(what(written))
            .help(help(model, first));
        if !others.is_empty() {
            diagnostic = diagnostic.devices(used.iter().map(|&(device, _)| device));
        }
        for &(device, (span, written)) in others {
            diagnostic = diagnostic.other(span, format!("`{device}` {}", what(written)));
        }
        out.push(diagnostic);
    }
}

fn what(written: bool) -> &'static str {
    match written {
        true => "written here: nothing depends on it but the program",
        false => "read here: nothing but the program changes it",
    }
}

/// Models on which the device has a meaning.
fn help(model: &Model, device: Device) -> String {
    let others = ModelId::ALL.into_iter().map(Model::get).filter(|other| {
        let row = other.special(device.class, device.number);
        other.instructions != model.instructions && row.is_some_and(|_| device.number >= 8000)
    });
    let names: Vec<_> = others.map(|other| other.name).collect();
    match names.len() {
        0 => format!(
            "use an ordinary device instead of `{device}` if it is a flag or value of the program's own"
        ),
        _ => format!(
            "`{device}` has a meaning on {}: `rungc explain {device}`",
            names.join(", ")
        ),
    }
}
