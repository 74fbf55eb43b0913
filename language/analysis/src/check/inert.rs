//! Special devices that a program relies on and that do nothing in compiled programs.

use super::Code;
use super::modules::Modules;
use super::ports::Roles;
use crate::accesses::Access;
use rungc_catalogue::{Basic, Lower};
use rungc_models::Model;
use rungc_models::runs::is_special;
use rungc_models::special::{self, Missed, Reason, Special, Status};
use rungc_rt::modules::{KINDS, Kind, Place};
use rungc_syntax::{Device, Diagnostic, Diagnostics, Phrase, Span, codes, phrase};
use std::collections::{BTreeMap, BTreeSet};

/// A longer run of devices is cleared or copied as a whole; it does not set up one of them.
const MAX_RUN: u32 = 32;
/// More devices than this that are inert for one reason share a diagnostic.
const MAX_SINGLE: usize = 3;
/// Maximum number of devices that a message names.
const MAX_NAMED: usize = 6;

/// The inert devices that a program names.
pub(super) struct Inert<'a> {
    used: BTreeMap<Device, Used>,
    /// Numbers and places of the PLC's special modules.
    fitted: Vec<(u16, Place)>,
    model: &'static Model,
    /// Roles of the serial ports.
    roles: &'a Roles<'a>,
}

/// Use of an inert device by a program.
struct Used {
    row: &'static Special,
    reason: Reason,
    places: Vec<(Span, bool)>,
    /// True if something changes it; RST and its value at power-on do not.
    changed: bool,
}

impl<'a> Inert<'a> {
    pub(super) fn new(code: &Code, modules: &Modules, roles: &'a Roles<'a>) -> Self {
        Inert {
            model: code.model(),
            used: BTreeMap::new(),
            fitted: modules.places().collect(),
            roles,
        }
    }

    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        let Some(count) = access.least.filter(|&count| count <= MAX_RUN) else {
            return;
        };
        let first = access.first.number;
        let mut before = None;
        for number in first..first.saturating_add(count) {
            let device = Device {
                number,
                ..access.first
            };
            let Some(row) = code.model().special(device.class, number) else {
                continue;
            };
            let inert = row.status.inert(&self.fitted);
            let reason = inert.or_else(|| self.in_role(row, access));
            // Both words of a value are one finding.
            let is_upper = access.each == 2 && (number - first) % 2 == 1;
            let is_same = is_upper && before == reason;
            before = reason;
            let Some(reason) = reason.filter(|_| !is_same) else {
                continue;
            };
            let used = self.used.entry(device).or_insert_with(|| Used {
                row,
                reason,
                places: Vec::new(),
                changed: false,
            });
            used.places.push((access.span, access.writes()));
            used.changed |= access.writes() && !leaves_default(code, i, row);
        }
    }

    /// Reason why a device that is written is inert in the role that its port has.
    fn in_role(&self, row: &Special, access: &Access) -> Option<Reason> {
        let special::Access::ReadUnless(role) = row.access else {
            return None;
        };
        let is_written = access.writes() && self.roles.contain(role) == Some(true);
        role.inert.filter(|_| is_written)
    }

    /// Warns of those whose work the program misses.
    pub(super) fn report(self, out: &mut Diagnostics) {
        let model = self.model;
        let missed = self.used.into_iter();
        let missed = missed.filter(|(device, used)| used.is_missed(*device));
        let mut by_reason: Vec<(Reason, Vec<(Device, Used)>)> = Vec::new();
        for (device, used) in missed {
            match by_reason
                .iter_mut()
                .find(|(reason, _)| *reason == used.reason)
            {
                Some((_, same)) => same.push((device, used)),
                None => by_reason.push((used.reason, vec![(device, used)])),
            }
        }
        for (reason, mut same) in by_reason {
            same.sort_by_key(|(_, used)| used.places.first().map(|&(span, _)| span));
            if same.len() > MAX_SINGLE {
                out.extend(report(model, reason, &same));
            } else {
                out.extend(same.chunks(1).filter_map(|one| report(model, reason, one)));
            }
        }
    }
}

impl Used {
    /// Returns true if the program depends on the device's function. One below the special devices (HM's axes and
    /// modules) that the program writes is an ordinary register.
    fn is_missed(&self, device: Device) -> bool {
        let is_written = self.places.iter().any(|(_, written)| *written);
        let is_read = self.places.iter().any(|(_, written)| !written);
        if is_written && !is_special(device.class, device.number) {
            return false;
        }
        match self.reason.missed {
            Missed::Never => false,
            Missed::ByWriters => self.changed,
            Missed::ByAll => self.changed || is_read,
        }
    }
}

/// Returns true if an instruction that writes a special device writes its value at power-on.
fn leaves_default(code: &Code, i: usize, row: &Special) -> bool {
    let Some(inst) = code.inst(i) else {
        return false;
    };
    let source = || code.instr(i).operands.first()?.kind.constant();
    match code.lower(i) {
        Some(Lower::Basic(Basic::Rst)) => row.default == 0,
        Some(Lower::Move) => source() == Some(row.default.into()),
        _ => inst.name == "ZRST" && row.default == 0,
    }
}

fn report(model: &Model, reason: Reason, devices: &[(Device, Used)]) -> Option<Diagnostic> {
    let (named, first) = devices.first()?;
    let &(span, _) = first.places.first()?;
    let names: Vec<_> = devices
        .iter()
        .map(|(device, _)| format!("`{device}`"))
        .collect();
    let why = reason.text;
    let message = match (names.as_slice(), first.changed) {
        ([one], true) => phrase!("{one} has no effect in a compiled program: {why}", one, why),
        ([one], false) => phrase!("{one} never changes in a compiled program: {why}", one, why),
        (many, _) => phrase!(
            "{all} have no effect in a compiled program: {why}",
            all = listed(many),
            why
        ),
    };
    let mut diagnostic = codes::INERT_DEVICE
        .at(span, message)
        .label(first.row.meaning(named.number));
    if devices.len() > MAX_NAMED {
        diagnostic = diagnostic.devices(devices.iter().map(|(device, _)| *device));
    }
    for (n, (device, used)) in devices.iter().enumerate() {
        for (m, &(span, written)) in used.places.iter().enumerate() {
            diagnostic = match (n, m) {
                (0, 0) => diagnostic,
                (_, 0) => diagnostic.other(
                    span,
                    format!(
                        "`{device}`: {number}",
                        number = used.row.meaning(device.number)
                    ),
                ),
                _ if written => {
                    diagnostic.other(span, phrase!("`{device}` is written here", device))
                }
                _ => diagnostic.other(span, phrase!("`{device}` is read here", device)),
            };
        }
    }
    Some(diagnostic.help(help(model, devices)))
}

/// The modules of the settings that make the devices work, if there are any; else it is up to the host.
fn help(model: &Model, devices: &[(Device, Used)]) -> Phrase {
    let mut names = BTreeSet::new();
    for (_, used) in devices {
        let fits = |kind: &&Kind| match used.row.status {
            Status::Modules(place) => kind.place == place,
            Status::Module(unit) => {
                model.module_places.contains(&kind.place) && kind.place.named().contains(&unit)
            }
            _ => false,
        };
        names.extend(KINDS.iter().filter(fits).map(|kind| kind.name));
    }
    let names: Vec<_> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.as_slice() {
        [] => phrase!("the host that runs the program must do what it does on the PLC"),
        [one] => phrase!("add a `[[module]]` with the kind {one} to rungc.toml", one),
        many => phrase!(
            "add a `[[module]]` with its kind to rungc.toml: one of {many}",
            many = listed(many)
        ),
    }
}

/// Names in a row: all of them, if there are not too many.
fn listed(names: &[String]) -> Phrase {
    match names {
        [most @ .., last] if names.len() <= MAX_NAMED => {
            phrase!("{most} and {last}", most = most.join(", "), last)
        }
        _ => {
            let (named, rest) = names.split_at(MAX_NAMED - 1);
            phrase!(
                "{named} and {rest} more",
                named = named.join(", "),
                rest = rest.len()
            )
        }
    }
}
