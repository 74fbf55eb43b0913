//! Counters and accumulating timers that act once, and outputs that stay on, because nothing resets them.

use super::Code;
use super::unused::{Outside, fine_if};
use crate::accesses::Access;
use rungc_catalogue::{Basic, Drive};
use rungc_models::Model;
use rungc_syntax::codes::Code as Finding;
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, Span, codes, phrase};
use rustc_hash::FxHashMap;

/// Relays that clear whole areas: M8031 and M8032.
const CLEAR_ALL: [u32; 2] = [8031, 8032];
/// The first counter that counts both ways, and so may come back without a reset.
const FIRST_BOTH_WAYS: u32 = 200;

/// Classes of devices that stay on until something resets them.
const CLASSES: [DeviceClass; 3] = [DeviceClass::C, DeviceClass::T, DeviceClass::Y];

/// No model has more counters, timers or outputs.
const MAX_DEVICES: u32 = 512;

/// Uses of a counter, a timer or an output.
#[derive(Default)]
struct Known {
    /// Position at which it is first switched on, counts or measures.
    driven: Option<Span>,
    /// True if its contact is used.
    looked_at: bool,
    /// True if something else writes it.
    cleared: bool,
}

/// Collects accesses to counters, timers and outputs.
#[derive(Default)]
pub(super) struct Resets {
    known: FxHashMap<Device, Known>,
    /// Classes of which an access may clear any device, or all.
    any: Vec<DeviceClass>,
}

impl Resets {
    /// What something outside the program writes may be reset there.
    pub(super) fn new(code: &Code) -> Self {
        let mut resets = Resets::default();
        let parameters = code.resolved.program.parameters.as_ref();
        let outside = parameters.map(|parameters| parameters.written_externally.as_slice());
        for run in outside.unwrap_or_default() {
            for number in run.first..run.first.saturating_add(run.count.min(MAX_DEVICES)) {
                let class = run.class;
                resets
                    .known
                    .entry(Device { class, number })
                    .or_default()
                    .cleared = true;
            }
        }
        resets
    }

    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, code: &Code, i: usize, access: &Access) {
        let class = access.first.class;
        if class == DeviceClass::M && access.writes() && CLEAR_ALL.contains(&access.first.number) {
            self.any.extend(CLASSES);
        }
        if !CLASSES.contains(&class) {
            return;
        }
        let Some(count) = access.count else {
            if access.writes() {
                self.any.push(class);
            }
            return;
        };
        let drives = match code.basic(i) {
            Some(Basic::Out) => class != DeviceClass::Y,
            Some(Basic::Set) => class == DeviceClass::Y,
            _ => false,
        };
        // A comparison looks at the count, which a reset need not follow.
        let logic = code.inst(i).is_some_and(|inst| inst.drive == Drive::Logic);
        let contact = logic && code.basic(i).is_some();
        let first = access.first.number;
        for number in first..first.saturating_add(count.min(MAX_DEVICES)) {
            let known = self.known.entry(Device { class, number }).or_default();
            known.looked_at |= contact;
            if drives {
                known.driven.get_or_insert(access.span);
            } else {
                known.cleared |= access.writes();
            }
        }
    }

    /// Warns of those that nothing resets.
    pub(super) fn report(self, model: &Model, out: &mut Diagnostics) {
        let (any, known) = (&self.any, &self.known);
        let never = |class: DeviceClass| {
            let stuck = known.iter().filter(move |(device, known)| {
                device.class == class && !any.contains(&class) && !known.cleared
            });
            let stuck = stuck.filter_map(|(device, known)| Some((known.driven?, *device, known)));
            let mut stuck: Vec<_> = stuck.collect();
            stuck.sort_by_key(|&(span, device, _)| (span, device));
            stuck
        };
        let counters = never(DeviceClass::C)
            .into_iter()
            .filter(|(_, device, known)| known.looked_at && device.number < FIRST_BOTH_WAYS);
        summary(&COUNTERS, counters, out);
        let accumulates = |timer| model.timer(timer).is_some_and(|kind| kind.accumulating);
        let timers = never(DeviceClass::T)
            .into_iter()
            .filter(|(_, device, known)| known.looked_at && accumulates(device.number));
        summary(&TIMERS, timers, out);
        summary(&OUTPUTS, never(DeviceClass::Y), out);
    }
}

/// Devices that nothing resets, and what is said of them.
struct Stuck {
    code: &'static Finding,
    /// Of the first device.
    message: fn(Device) -> Phrase,
    /// At the place of the first device, or of this one.
    here: fn(Option<Device>) -> Phrase,
}

static COUNTERS: Stuck = Stuck {
    code: &codes::NEVER_RESET,
    message: |first| {
        phrase!(
            "`{first}` reaches its preset once and is never reset",
            first
        )
    },
    here: |device| match device {
        None => phrase!("counts here"),
        Some(device) => phrase!("`{device}` counts here", device),
    },
};

static TIMERS: Stuck = Stuck {
    code: &codes::NEVER_RESET,
    message: |first| {
        phrase!(
            "`{first}` reaches its preset once and is never reset",
            first
        )
    },
    here: |device| match device {
        None => phrase!("measures here"),
        Some(device) => phrase!("`{device}` measures here", device),
    },
};

static OUTPUTS: Stuck = Stuck {
    code: &codes::NEVER_SWITCHED_OFF,
    message: |first| phrase!("`{first}` is set and never reset", first),
    here: |device| match device {
        None => phrase!("set here"),
        Some(device) => phrase!("`{device}` set here", device),
    },
};

/// One diagnostic for all devices of a kind.
fn summary<'a>(
    stuck: &'static Stuck,
    found: impl IntoIterator<Item = (Span, Device, &'a Known)>,
    out: &mut Diagnostics,
) {
    let mut found = found.into_iter();
    let Some((span, first, _)) = found.next() else {
        return;
    };
    let others: Vec<_> = found.collect();
    let message = (stuck.message)(first);
    let message = match others.len() {
        0 => message,
        n => phrase!("{message}, and {n} more", message, n),
    };
    let mut diagnostic = stuck
        .code
        .at(span, message)
        .label((stuck.here)(None))
        .help(fine_if(Outside::Resets, others.len() + 1));
    if !others.is_empty() {
        let all = std::iter::once(first).chain(others.iter().map(|&(_, device, _)| device));
        diagnostic = diagnostic.devices(all);
    }
    for (span, device, _) in others {
        diagnostic = diagnostic.other(span, (stuck.here)(Some(device)));
    }
    out.push(diagnostic);
}
