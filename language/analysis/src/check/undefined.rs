//! Special devices that a program reads or writes and to which the model gives no meaning.

use super::Code;
use super::overlaps::clears;
use crate::accesses::Access;
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, Span, codes, phrase};
use std::collections::BTreeMap;

/// A longer run of devices is cleared or copied as a whole; it does not mean one of them.
const MAX_RUN: u32 = 32;

/// Mode of conversions on PLCs before FX2N. GX Works2 clears it on all models, where structured text and blocks make a
/// REAL of an integer.
const CONVERSION: Device = Device {
    class: DeviceClass::M,
    number: 8023,
};

/// Special devices without a meaning that a program names, each with its first use.
#[derive(Default)]
pub(super) struct Undefined {
    used: BTreeMap<Device, Use>,
}

/// Use of such a device.
#[derive(Clone, Copy)]
struct Use {
    span: Span,
    /// True if it is written.
    written: bool,
    /// The device before it, which has a meaning, if both are a 32-bit value.
    upper_of: Option<Device>,
}

impl Undefined {
    /// Takes an access.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        if access.first == CONVERSION && clears(code, i) {
            return;
        }
        let Some(count) = access.least.filter(|&count| count <= MAX_RUN) else {
            return;
        };
        let (class, first) = (access.first.class, access.first.number);
        // A group or a run that begins elsewhere is meant as a whole.
        let is_run = count > access.each || access.each > 2;
        let count = if is_run { 1 } else { count };
        let numbers = first..first.saturating_add(count);
        let lacks = |number| {
            code.model().has(class, number) && code.model().special(class, number).is_none()
        };
        for number in numbers.filter(|&number| is_special(class, number) && lacks(number)) {
            let is_upper = access.each == 2 && (number - first) % 2 == 1;
            let device = |number| Device { class, number };
            let lower = is_upper.then(|| device(number - 1));
            // Both words of a value are one mistake.
            if lower.is_some_and(|lower| lacks(lower.number)) {
                continue;
            }
            let place = Use {
                span: access.span,
                written: access.writes(),
                upper_of: lower,
            };
            self.used.entry(device(number)).or_insert(place);
        }
    }

    /// Warns of them, in one diagnostic.
    pub(super) fn report(self, model: &'static Model, out: &mut Diagnostics) {
        let mut used: Vec<_> = self.used.into_iter().collect();
        used.sort_by_key(|&(device, place)| (place.span, device));
        let Some((&(first, place), others)) = used.split_first() else {
            return;
        };
        let model_name = model.title;
        let message = match others.len() {
            0 => phrase!(
                "`{first}` has no meaning on {model_name}",
                first,
                model_name
            ),
            n => phrase!(
                "`{first}` and {n} more special devices have no meaning on {model_name}",
                first,
                n,
                model_name
            ),
        };
        let help = match place.upper_of {
            None => help(model, first),
            Some(lower) => {
                phrase!(
                    "`{lower}` holds 16 bits: use the 16-bit form of the instruction",
                    lower
                )
            }
        };
        let mut diagnostic = codes::UNDEFINED_SPECIAL
            .at(place.span, message)
            .label(place.what())
            .help(help);
        if !others.is_empty() {
            diagnostic = diagnostic.devices(used.iter().map(|&(device, _)| device));
        }
        for &(device, place) in others {
            diagnostic = diagnostic.other(
                place.span,
                format!("`{device}` {what}", what = place.what()),
            );
        }
        out.push(diagnostic);
    }
}

impl Use {
    fn what(self) -> Phrase {
        match (self.upper_of, self.written) {
            (Some(lower), true) => {
                phrase!("written with `{lower}` as a 32-bit value", lower)
            }
            (Some(lower), false) => phrase!("read with `{lower}` as a 32-bit value", lower),
            (None, true) => "written here: nothing depends on it but the program".into(),
            (None, false) => "read here: nothing but the program changes it".into(),
        }
    }
}

/// Models on which the device has a meaning.
fn help(model: &Model, device: Device) -> Phrase {
    let others = ModelId::ALL.into_iter().map(Model::get).filter(|other| {
        let row = other.special(device.class, device.number);
        other.instructions != model.instructions && row.is_some_and(|_| device.number >= 8000)
    });
    let names: Vec<_> = others.map(|other| other.name).collect();
    match names.len() {
        0 => phrase!(
            "use an ordinary device instead of `{device}` if it is a flag or value of the program's own",
            device
        ),
        _ => phrase!(
            "`{device}` has a meaning on {names}: `rungc explain {device}`",
            device,
            names = names.join(", ")
        ),
    }
}
