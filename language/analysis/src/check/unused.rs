//! Relays, states, timers and counters that are driven and never read, or read and never driven, and registers that are
//! compared or used as presets and never written.

use super::Code;
use super::overlaps::clears;
use super::ports::{Roles, may_be_written};
use crate::accesses::Access;
use crate::latches;
use rungc_catalogue::{Basic, Lower};
use rungc_models::Range;
use rungc_models::runs::is_special;
use rungc_rt::RtFn;
use rungc_syntax::codes::Code as Finding;
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, Span, codes, phrase};
use std::borrow::Cow;

/// The classes that are looked at, relays first. STL reads its state.
const CLASSES: [DeviceClass; 6] = [
    DeviceClass::M,
    DeviceClass::S,
    DeviceClass::T,
    DeviceClass::C,
    DeviceClass::D,
    DeviceClass::R,
];
/// The first annunciator: D8049 and M8048 show that one is on.
const ANNUNCIATORS: u32 = 900;
/// The states that IST sets as well as those it names, from S0 on.
const INITIAL: u32 = 3;
/// Places in [`Class::met`].
const COIL: usize = 0;
const CONTACT: usize = 1;

/// Accesses to the devices of one class.
#[derive(Default)]
struct Class {
    /// Differences of how many accesses read each device: the sum up to a device is its count.
    reads: Vec<i32>,
    /// The same for writes.
    writes: Vec<i32>,
    /// Devices met so far as coils, and as contacts.
    met: [Vec<bool>; 2],
    /// True if an access may read any of them.
    any_read: bool,
    /// True if an access may write any of them.
    any_written: bool,
}

/// Collects accesses to find devices of which one half is missing.
pub(super) struct Unused<'a, 'p> {
    code: &'a Code<'p>,
    classes: [Class; 6],
    /// The model's devices; a latched register keeps what was written at any time.
    ranges: Cow<'static, [Range]>,
    /// Coils, each once, in the order of the program.
    coils: Vec<(Device, Span)>,
    /// Contacts, each once, in the order of the program.
    contacts: Vec<(Device, Span)>,
    /// Registers that are compared or presets, each once, in the order of the program, with the last word's number.
    registers: Vec<(Device, Span, u32)>,
}

impl<'a, 'p> Unused<'a, 'p> {
    pub(super) fn new(code: &'a Code<'p>, roles: &Roles) -> Self {
        let mut classes: [Class; 6] = Default::default();
        for (class, known) in CLASSES.iter().zip(&mut classes) {
            let last = code.model().ranges_of(*class).map(|range| range.last).max();
            let len = last.map_or(0, |last| last as usize + 2);
            known.reads = vec![0; len];
            known.writes = vec![0; len];
            known.met = [vec![false; len], vec![false; len]];
        }
        // The meaning of an unreadable line is unknown.
        let unread = !code.resolved.program.unread.is_empty();
        for known in &mut classes {
            (known.any_read, known.any_written) = (unread, unread);
        }
        let parameters = code.resolved.program.parameters.as_ref();
        if let Some(parameters) = parameters {
            let outside = [
                (&parameters.read_externally, false),
                (&parameters.written_externally, true),
            ];
            for (runs, write) in outside {
                for run in runs {
                    if let Some(at) = CLASSES.iter().position(|class| *class == run.class) {
                        classes[at].add_run(run.first, run.count, write);
                    }
                }
            }
        }
        if may_be_written(code) {
            let registers = CLASSES.iter().zip(&mut classes);
            let registers = registers.filter(|(class, _)| is_register(**class));
            registers.for_each(|(_, known)| known.any_written = true);
        }
        let [relays, ..] = &mut classes;
        for area in roles.areas() {
            for (is_used, write) in [(area.is_sent, false), (area.is_received, true)] {
                if is_used {
                    relays.add_run(area.first, area.count, write);
                }
            }
        }
        Unused {
            code,
            classes,
            ranges: latches::ranges(code.resolved.program, code.model()),
            coils: Vec::new(),
            contacts: Vec::new(),
            registers: Vec::new(),
        }
    }

    /// Takes an access of instruction `i`.
    pub(super) fn note(&mut self, i: usize, access: &Access) {
        let Some(at) = CLASSES
            .iter()
            .position(|&class| class == access.first.class)
        else {
            return;
        };
        let basic = self.code.basic(i);
        if matches!(self.code.lower(i), Some(Lower::Call(RtFn::Ist)))
            && access.first.class == DeviceClass::S
        {
            self.classes[at].add_run(0, INITIAL, true);
        }
        // What only clears never switches anything on.
        if access.writes() && !clears(self.code, i) {
            self.classes[at].add(access, true);
        }
        if access.reads() {
            self.classes[at].add(access, false);
        }
        if access.first.class == DeviceClass::M
            && is_special(access.first.class, access.first.number)
        {
            self.note_special(access);
            return;
        }
        if is_register(access.first.class) {
            self.note_register(i, access, at);
            return;
        }
        let (list, what) = match basic {
            // The target of an index is unknown.
            Some(Basic::Out | Basic::Set | Basic::Pls | Basic::Plf) if access.count.is_some() => {
                (&mut self.coils, COIL)
            }
            Some(_) if access.reads() && access.count == Some(1) => (&mut self.contacts, CONTACT),
            _ => return,
        };
        let shown = access.first.class == DeviceClass::S && access.first.number >= ANNUNCIATORS;
        if shown && what == COIL {
            return;
        }
        if self.classes[at].meets(access, what) {
            list.push((access.first, access.span));
        }
    }

    /// Takes an access to a register, whose class is at `at`: as a preset or in a comparison, or to a bit of it.
    fn note_register(&mut self, i: usize, access: &Access, at: usize) {
        let compares = matches!(
            self.code.lower(i),
            Some(Lower::Compare(..) | Lower::Cmp | Lower::Zcp | Lower::HighSpeed(_))
        );
        let decides = compares || self.code.basic(i).is_some();
        let one = access.reads() && access.count == Some(access.each);
        if !decides || !one || !self.classes[at].meets(access, CONTACT) {
            return;
        }
        let Device { class, number } = access.first;
        let mut ranges = self.ranges.iter();
        let kept = ranges.any(|range| {
            range.class == class && range.latched && (range.first..=range.last).contains(&number)
        });
        if !kept && self.code.model().special(class, number).is_none() && !is_special(class, number)
        {
            let last = access.devices().end().number;
            self.registers.push((access.first, access.span, last));
        }
    }

    /// Takes an instruction that could not be read or understood: it may read and write what it names, or anything
    /// where it names nothing that could be read.
    pub(super) fn note_broken(&mut self, i: usize) {
        let instr = self.code.instr(i);
        let unknown = self.code.inst(i).is_none() || self.code.is_meant(i);
        if !unknown && !instr.is_broken() {
            return;
        }
        let anything = match unknown {
            true => instr.operands.is_empty(),
            false => self.code.lacks_a_device(i),
        };
        for (&class, known) in CLASSES.iter().zip(&mut self.classes) {
            known.any_read |= anything;
            known.any_written |= anything;
            for first in self.code.devices(i).filter(|device| device.class == class) {
                let access = Access::whole(first);
                known.add(&access, true);
                known.add(&access, false);
            }
        }
    }

    /// The table of counts looks at any counter.
    fn note_special(&mut self, access: &Access) {
        let table = self.code.model().interrupts.count_rows;
        if table.is_some_and(|table| access.first.number == table.enable.number()) {
            let counters = CLASSES.iter().zip(&mut self.classes);
            counters
                .filter(|(class, _)| **class == DeviceClass::C)
                .for_each(|(_, counters)| counters.any_read = true);
        }
    }

    /// Warns of what has only one half.
    pub(super) fn report(mut self, out: &mut Diagnostics) {
        for class in &mut self.classes {
            class.sum();
        }
        let lacks = |device: &Device, write: bool| {
            let at = CLASSES.iter().position(|class| class == &device.class);
            at.is_some_and(|at| self.classes[at].lacks(device.number, write))
                && self.code.model().has(device.class, device.number)
        };
        let unread = self.coils.iter().filter(|(device, _)| lacks(device, false));
        summary(&DRIVEN_ONLY, unread, out);
        let undriven = self
            .contacts
            .iter()
            .filter(|(device, _)| lacks(device, true));
        summary(&CONTACTS_ONLY, undriven, out);
        let unwritten = self.registers.iter().filter(|(first, _, last)| {
            let mut words = (first.number..=*last).map(|number| Device { number, ..*first });
            words.all(|word| lacks(&word, true))
        });
        let unwritten: Vec<_> = unwritten.map(|&(first, span, _)| (first, span)).collect();
        summary(&READ_ONLY, unwritten.iter(), out);
    }
}

fn is_register(class: DeviceClass) -> bool {
    matches!(class, DeviceClass::D | DeviceClass::R)
}

impl Class {
    /// Returns true if an access names a device that the model has for the first time as a coil, or as a contact.
    fn meets(&mut self, access: &Access, what: usize) -> bool {
        match self.met[what].get_mut(access.first.number as usize) {
            Some(met) => !std::mem::replace(met, true),
            None => false,
        }
    }

    fn add(&mut self, access: &Access, write: bool) {
        let Some(count) = access.count else {
            let any = if write {
                &mut self.any_written
            } else {
                &mut self.any_read
            };
            *any = true;
            return;
        };
        self.add_run(access.first.number, count, write);
    }

    fn add_run(&mut self, first: u32, count: u32, write: bool) {
        let counts = if write {
            &mut self.writes
        } else {
            &mut self.reads
        };
        let first = first as usize;
        let end = first
            .saturating_add(count as usize)
            .min(counts.len().saturating_sub(1));
        if first < end {
            counts[first] += 1;
            counts[end] -= 1;
        }
    }

    /// Turns the differences into counts.
    fn sum(&mut self) {
        for counts in [&mut self.reads, &mut self.writes] {
            let mut sum = 0;
            for count in counts {
                sum += *count;
                *count = sum;
            }
        }
    }

    fn lacks(&self, number: u32, write: bool) -> bool {
        let (counts, any) = match write {
            true => (&self.writes, self.any_written),
            false => (&self.reads, self.any_read),
        };
        !any && counts.get(number as usize) == Some(&0)
    }
}

/// Devices of which a program lacks a half, and what is said of them.
struct Half {
    code: &'static Finding,
    /// Of the first device and the number of further ones.
    message: fn(Device, usize) -> Phrase,
    /// At the place of the first device, or of this one.
    here: fn(Option<Device>) -> Phrase,
    /// What may do the other half.
    outside: Outside,
}

static DRIVEN_ONLY: Half = Half {
    code: &codes::NEVER_READ,
    message: |first, others| match others {
        0 => phrase!("`{first}` is driven and never read", first),
        1 => phrase!(
            "`{first}` and 1 other device are driven and never read",
            first
        ),
        n => phrase!(
            "`{first}` and {n} other devices are driven and never read",
            first,
            n
        ),
    },
    here: driven_here,
    outside: Outside::Reads,
};

static CONTACTS_ONLY: Half = Half {
    code: &codes::NEVER_WRITTEN,
    message: |first, others| match others {
        0 => phrase!("`{first}` is read, but nothing drives it", first),
        1 => phrase!(
            "`{first}` and 1 other device are read, but nothing drives them",
            first
        ),
        n => phrase!(
            "`{first}` and {n} other devices are read, but nothing drives them",
            first,
            n
        ),
    },
    here: read_here,
    outside: Outside::Writes,
};

static READ_ONLY: Half = Half {
    code: &codes::NEVER_WRITTEN,
    message: |first, others| match others {
        0 => phrase!("`{first}` is read, but nothing writes it", first),
        1 => phrase!(
            "`{first}` and 1 other device are read, but nothing writes them",
            first
        ),
        n => phrase!(
            "`{first}` and {n} other devices are read, but nothing writes them",
            first,
            n
        ),
    },
    here: read_here,
    outside: Outside::Writes,
};

fn driven_here(device: Option<Device>) -> Phrase {
    match device {
        None => phrase!("driven here"),
        Some(device) => phrase!("`{device}` driven here", device),
    }
}

fn read_here(device: Option<Device>) -> Phrase {
    match device {
        None => phrase!("read here"),
        Some(device) => phrase!("`{device}` read here", device),
    }
}

/// One diagnostic for all devices of a kind: a program with an operator panel may have many.
fn summary<'d>(
    half: &'static Half,
    found: impl Iterator<Item = &'d (Device, Span)>,
    out: &mut Diagnostics,
) {
    let found: Vec<_> = found.collect();
    let Some((&&(first, span), others)) = found.split_first() else {
        return;
    };
    let message = (half.message)(first, others.len());
    let mut diagnostic = half.code.at(span, message).label((half.here)(None));
    diagnostic = diagnostic.help(fine_if(half.outside, found.len()));
    if !others.is_empty() {
        diagnostic = diagnostic.devices(found.iter().map(|(device, _)| *device));
    }
    for (device, span) in others {
        diagnostic = diagnostic.other(*span, (half.here)(Some(*device)));
    }
    out.push(diagnostic);
}

/// What something outside the program may do with devices.
#[derive(Clone, Copy)]
pub(super) enum Outside {
    Reads,
    Writes,
    Resets,
}

/// The help for devices of which something outside the program may do the other half, as a key of `[hmi]` says.
pub(super) fn fine_if(outside: Outside, count: usize) -> Phrase {
    match (outside, count) {
        (Outside::Reads, 1) => phrase!(
            "this is fine if an operator panel or another program reads it; then name it in \
             `[hmi] reads` of rungc.toml"
        ),
        (Outside::Reads, _) => phrase!(
            "this is fine if an operator panel or another program reads them; then name them in \
             `[hmi] reads` of rungc.toml"
        ),
        (Outside::Writes, 1) => phrase!(
            "this is fine if an operator panel or another program writes it; then name it in \
             `[hmi] writes` of rungc.toml"
        ),
        (Outside::Writes, _) => phrase!(
            "this is fine if an operator panel or another program writes them; then name them in \
             `[hmi] writes` of rungc.toml"
        ),
        (Outside::Resets, 1) => phrase!(
            "this is fine if an operator panel or another program resets it; then name it in \
             `[hmi] writes` of rungc.toml"
        ),
        (Outside::Resets, _) => phrase!(
            "this is fine if an operator panel or another program resets them; then name them in \
             `[hmi] writes` of rungc.toml"
        ),
    }
}
