//! Coils, timers and counters that are driven at several places.

use super::calls::{Calls, Order};
use super::drives::{Drives, Lasts};
use super::overlaps::clears;
use super::parallel::Ladders;
use super::set_and_out::{Condition, begins_of_rungs, condition};
use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use super::{Code, Part};
use crate::accesses::{self, Access};
use rungc_catalogue::{Basic, Lower, Role};
use rungc_rt::{Needs, RtFn};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, OperandKind, codes, phrase};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// A coil: a device, or a bit of a word.
pub(super) type Coil = (Device, Option<u8>);

/// The place of each instruction in the program.
#[derive(Clone, Copy)]
pub(super) struct Where<'a> {
    pub(super) skips: &'a Skips,
    pub(super) nesting: &'a Nesting,
    pub(super) calls: &'a Calls,
}

/// Warns of coils that the last of several places decides. The result of a coil of a relay that is read before the next
/// one counts, too, unless the relay is read before its first coil: only a relay that is written before it is read in a
/// scan holds intermediate results, as in code that GX Works2 makes of labels.
pub(super) fn check(code: &Code, places: Where, out: &mut Diagnostics) {
    let mut driven: BTreeMap<Coil, Vec<Place>> = BTreeMap::new();
    for i in 0..code.len {
        let timer = || Some((measuring_timer(code, i)?, None));
        // What never runs drives nothing.
        let runs = places.nesting.of(i).routine != Routine::Nothing;
        if let Some(coil) = driven_coil(code, i).or_else(timer).filter(|_| runs) {
            let place = Place::new(code, places, i);
            driven.entry(coil).or_default().push(place);
        }
    }
    if driven.is_empty() {
        return;
    }
    let mut found = sent(code, places, &driven);
    add_words(code, places, &mut driven);
    driven.retain(|_, coils| coils.len() > 1);
    let reads = Reads::of(code, places.nesting, &driven);
    let together = Ladders::new(code, places.nesting).pairs(&driven, &reads);
    for (coil, places) in driven {
        let places = Places::new(places);
        if let Some((lost, last)) = places.lost(coil.0, &reads) {
            let words = lost.iter().chain([&last]).any(|place| place.is_word);
            let lost: Vec<_> = lost.iter().map(|place| place.at).collect();
            found.push(driven_twice(code, (coil, words), &lost, last.at));
        } else if let Some(&pair) = together.get(&coil) {
            found.push(driven_together(code, coil.0, pair));
        }
    }
    found.sort_by_key(|diagnostic| diagnostic.span);
    out.extend(found);
}

/// Reports the instructions that send pulses through a coil's output.
fn sent(code: &Code, places: Where, driven: &BTreeMap<Coil, Vec<Place>>) -> Vec<Diagnostic> {
    let found = (0..code.len).filter_map(|i| {
        let runs = places.nesting.of(i).routine != Routine::Nothing;
        let output = pulse_output(code, i).filter(|_| runs && code.part(i) == Part::Output)?;
        pulses(code, places, i, driven.get(&(output, None))?)
    });
    found.collect()
}

/// Adds the instructions that write coils as parts of words or as results.
pub(super) fn add_words(code: &Code, places: Where, driven: &mut BTreeMap<Coil, Vec<Place>>) {
    let mut drives = Drives::default();
    for i in 0..code.len {
        let drive = drives.next(code, i);
        let Some(drive) = drive.filter(|_| places.nesting.of(i).routine != Routine::Nothing) else {
            continue;
        };
        if code.basic(i).is_some() {
            continue;
        }
        let each_time = drive.lasts == Lasts::Always && !code.resolved.instrs[i].form.pulse;
        // A value that is cleared first may be put together afterwards.
        let is_lost = !clears(code, i);
        for access in results(code, i) {
            let decides = each_time && access.role == Role::Write && replaces(code, i);
            if access.count.is_none_or(|count| count > MAX_RUN) || !is_lost && !decides {
                continue;
            }
            let (first, last) = access.devices().into_inner();
            for (&(device, _), coils) in driven.range_mut((first, None)..=(last, Some(u8::MAX))) {
                let at = coils.partition_point(|place| place.at < i);
                let place = Place {
                    is_word: true,
                    is_lost,
                    decides: decides && !takes(code, i, device),
                    ..Place::new(code, places, i)
                };
                coils.insert(at, place);
            }
        }
    }
}

/// Returns true if a device is also a source of an instruction, whose result may keep it.
fn takes(code: &Code, i: usize, device: Device) -> bool {
    let mut sources = code.accesses(i).filter(Access::reads);
    sources.any(|source| source.devices().contains(&device))
}

/// A longer run of devices is not about one of them.
const MAX_RUN: u32 = 64;

/// Devices into which an instruction writes results: relays, outputs and registers. Timers and counters are not driven
/// by what is written to them, and outputs of pulses are reported otherwise.
fn results(code: &Code, i: usize) -> impl Iterator<Item = Access> {
    let pulses = pulse_output(code, i);
    code.accesses(i).filter_map(move |access| {
        let Device { class, .. } = access.first;
        match (class, access.role) {
            (_, Role::Read) => None,
            (DeviceClass::Y, _) if pulses == Some(access.first) => None,
            (DeviceClass::Y | DeviceClass::M, Role::Write) => Some(access),
            (DeviceClass::Y | DeviceClass::M, Role::ReadWrite) => Some(inner(access)),
            // A register may be put together from words and bits.
            (DeviceClass::D, Role::Write) => Some(access).filter(|_| moves(code, i)),
            _ => None,
        }
    })
}

/// Without the ends of a run that is shifted: a coil may feed it.
fn inner(access: Access) -> Access {
    match access.count {
        Some(count @ 3..) if access.each == 1 => Access {
            first: Device {
                number: access.first.number + 1,
                ..access.first
            },
            count: Some(count - 2),
            ..access
        },
        _ => access,
    }
}

/// Returns true if an instruction moves or computes a value.
fn moves(code: &Code, i: usize) -> bool {
    matches!(
        code.lower(i),
        Some(Lower::Move | Lower::MoveNot | Lower::Cmp | Lower::Zcp | Lower::Arith(_))
    )
}

/// Returns true if an instruction writes its results whenever it runs: it depends on its operands alone.
fn replaces(code: &Code, i: usize) -> bool {
    match code.lower(i) {
        Some(Lower::Call(function)) => function.needs() == Needs::default(),
        Some(Lower::Values(_)) => true,
        _ => moves(code, i),
    }
}

/// The output through which an instruction sends pulses.
fn pulse_output(code: &Code, i: usize) -> Option<Device> {
    let operand = code.params(i).iter().position(|param| param.sends_pulses)?;
    code.device(i, operand)
        .filter(|output| output.class == DeviceClass::Y)
}

/// Reports a coil that writes the output of pulses while an instruction sends them.
fn pulses(code: &Code, places: Where, i: usize, coils: &[Place]) -> Option<Diagnostic> {
    let own = condition(code, places.nesting, places.skips, i);
    let meets = |coil: &&Place| coil.certain.is_some() || coil.condition == own;
    let coil = coils.iter().filter(|coil| !coil.is_word).find(meets)?.at;
    let (mnemonic, output) = (&code.instr(i).mnemonic, code.device(coil, 0)?);
    let message = phrase!(
        "coil `{output}` is also the output of `{mnemonic}`",
        output,
        mnemonic
    );
    let diagnostic = codes::DOUBLE_COIL
        .at(code.span(coil), message)
        .label("writes the output in every scan …")
        .other(code.span(i), "… while this sends pulses through it");
    Some(diagnostic.help(phrase!(
        "leave the output to `{mnemonic}`, or give the coil another one",
        mnemonic
    )))
}

/// A place that drives a coil.
pub(super) struct Place {
    pub(super) at: usize,
    pub(super) condition: Condition,
    /// Its last place in a scan that runs it, if that is known.
    last: Option<Order>,
    /// Its place in every scan, if each runs it.
    certain: Option<Order>,
    /// True if it writes more than the coil.
    pub(super) is_word: bool,
    /// True if it matters that its result is lost.
    pub(super) is_lost: bool,
    /// True if it writes the coil whenever it runs.
    pub(super) decides: bool,
}

impl Place {
    pub(super) fn new(code: &Code, places: Where, at: usize) -> Self {
        let Where {
            skips,
            nesting,
            calls,
        } = places;
        let (routine, state) = (nesting.of(at).routine, nesting.of(at).state);
        let each_scan = state == NONE && skips.mark(at) == 0;
        Place {
            at,
            condition: condition(code, nesting, skips, at),
            last: calls.last(routine, at),
            certain: calls.certain(routine, at).filter(|_| each_scan),
            is_word: false,
            is_lost: true,
            decides: true,
        }
    }
}

/// The places that drive one coil.
pub(super) struct Places {
    all: Vec<Place>,
    /// Those under one condition, in order: they run in the same scans.
    alike: FxHashMap<Condition, Vec<usize>>,
    /// Those that every scan runs, in order.
    certain: Vec<usize>,
}

impl Places {
    pub(super) fn new(all: Vec<Place>) -> Self {
        let mut alike: FxHashMap<_, Vec<usize>> = FxHashMap::default();
        let deciding = all.iter().enumerate().filter(|(_, place)| place.decides);
        for (n, place) in deciding.clone() {
            alike.entry(place.condition).or_default().push(n);
        }
        let certain = deciding.filter(|(_, place)| place.certain.is_some());
        let mut certain: Vec<_> = certain.map(|(n, _)| n).collect();
        certain.sort_by(|&a, &b| all[a].certain.cmp(&all[b].certain));
        Places {
            all,
            alike,
            certain,
        }
    }

    /// The places whose results are lost, with the one that decides.
    pub(super) fn lost(&self, device: Device, reads: &Reads) -> Option<(Vec<&Place>, &Place)> {
        let mut by_last: BTreeMap<usize, Vec<&Place>> = BTreeMap::new();
        for (n, place) in self
            .all
            .iter()
            .enumerate()
            .filter(|(_, place)| place.is_lost)
        {
            let alike = self.alike.get(&place.condition).map(Vec::as_slice);
            let alike = alike.unwrap_or_default();
            let alike = &alike[alike.partition_point(|&other| other <= n)..];
            let certain = self.after(place);
            let next = [alike.first(), certain.first()];
            let mut next = next.into_iter().flatten().map(|&other| &self.all[other]);
            let both_words = |next: &Place| place.is_word && next.is_word;
            let overwrites = |next: &Place| !both_words(next) && !reads.any(device, place, next);
            if !next.any(overwrites) {
                continue;
            }
            let last = match (alike.last(), certain.last()) {
                (Some(&a), Some(&c)) if self.all[a].last > self.all[c].certain => a,
                (_, Some(&last)) | (Some(&last), None) => last,
                (None, None) => continue,
            };
            by_last.entry(last).or_default().push(place);
        }
        let (last, lost) = by_last.pop_first()?;
        Some((lost, &self.all[last]))
    }

    /// The places that every scan runs after a place.
    fn after(&self, place: &Place) -> &[usize] {
        let Some(last) = &place.last else {
            return &[];
        };
        let before = |&other: &usize| self.all[other].certain.as_ref() <= Some(last);
        &self.certain[self.certain.partition_point(before)..]
    }
}

/// Instructions that read devices with several coils.
pub(super) struct Reads {
    /// By device: the places that read it, in order.
    places: BTreeMap<Device, Vec<usize>>,
    /// By output: the places that send it to its terminal, in order.
    refreshes: BTreeMap<Device, Vec<usize>>,
    /// Devices that a routine reads.
    in_routines: Vec<Device>,
    /// Devices whose state the program carries from scan to scan.
    carried: BTreeSet<Device>,
    /// The calls, in order.
    calls: Vec<usize>,
    /// Where the rung of each instruction begins.
    rungs: Vec<u32>,
}

impl Reads {
    pub(super) fn of(code: &Code, nesting: &Nesting, driven: &BTreeMap<Coil, Vec<Place>>) -> Self {
        let devices = driven.keys().map(|&(device, _)| device);
        let devices =
            devices.filter(|device| !matches!(device.class, DeviceClass::T | DeviceClass::C));
        let mut reads = Reads {
            places: devices.map(|device| (device, Vec::new())).collect(),
            refreshes: BTreeMap::new(),
            in_routines: Vec::new(),
            carried: BTreeSet::new(),
            calls: Vec::new(),
            rungs: begins_of_rungs(code),
        };
        let mut uses: BTreeMap<Device, FirstUse> = BTreeMap::new();
        for i in 0..code.len {
            let routine = nesting.of(i).routine;
            if code.basic(i) == Some(Basic::Call) {
                reads.calls.push(i);
            }
            let refreshes = matches!(code.lower(i), Some(Lower::Call(RtFn::Ref | RtFn::RefHm)));
            for access in accesses::of(code.resolved, i).filter(Access::reads) {
                let is_contact = access.count == Some(1);
                for (device, places) in reads.places.range_mut(access.devices()) {
                    let is_output = device.class == DeviceClass::Y;
                    if refreshes {
                        reads.refreshes.entry(*device).or_default().push(i);
                    } else {
                        places.push(i);
                    }
                    if is_contact {
                        uses.entry(*device).or_default().read(routine);
                    }
                    if routine != Routine::Main && is_output == refreshes {
                        reads.in_routines.push(*device);
                    }
                }
            }
            if clears(code, i) {
                continue;
            }
            for access in accesses::of(code.resolved, i).filter(Access::writes) {
                for (device, _) in reads.places.range(access.devices()) {
                    uses.entry(*device).or_default().written(routine);
                }
            }
        }
        uses.retain(|device, uses| device.class == DeviceClass::M && uses.is_carried());
        reads.carried = uses.into_keys().collect();
        reads.in_routines.sort_unstable();
        reads
    }

    /// Returns true if a device is read after a coil and before the next one, so that the result of the first counts.
    pub(super) fn any(&self, device: Device, coil: &Place, next: &Place) -> bool {
        let Some(places) = self.places.get(&device) else {
            return false;
        };
        let between = |places: &[usize], after: usize, before: usize| {
            let first = places.partition_point(|&place| place <= after);
            places.get(first).is_some_and(|&place| place < before)
        };
        // A coil that holds itself continues what the first one did.
        let rung = self.rungs[next.at] as usize;
        if coil.at < rung && (places.binary_search(&rung).is_ok() || between(places, rung, next.at))
        {
            return true;
        }
        // The next scan sees only the last result.
        if self.carried.contains(&device) {
            return false;
        }
        let places = match device.class {
            // Outputs leave the PLC at the end of the scan, unless REF sends them before.
            DeviceClass::Y => match self.refreshes.get(&device) {
                Some(refreshes) => refreshes,
                None => return false,
            },
            _ => places,
        };
        let in_routines = self.in_routines.binary_search(&device).is_ok();
        if coil.condition.0 == next.condition.0 {
            return between(places, coil.at, next.at)
                || in_routines && between(&self.calls, coil.at, next.at);
        }
        let main = |order: &Option<Order>| order.as_ref()?.first().map(|&at| at as usize);
        let (Some(after), Some(before)) = (main(&coil.last), main(&next.certain)) else {
            return true;
        };
        in_routines || between(places, after, before)
    }
}

/// The first uses of a relay, in the order of the program.
#[derive(Default)]
struct FirstUse {
    /// Routine of the last contact before anything writes the relay.
    read: Option<Routine>,
    /// Routine of the first instruction that writes it, otherwise than by switching it off.
    written: Option<Routine>,
    /// True if another routine writes it, too.
    is_shared: bool,
}

impl FirstUse {
    fn read(&mut self, routine: Routine) {
        if self.written.is_none() {
            self.read = Some(routine);
        }
    }

    fn written(&mut self, routine: Routine) {
        let first = *self.written.get_or_insert(routine);
        self.is_shared |= first != routine;
    }

    /// Returns true if contacts see what an earlier scan has written.
    fn is_carried(&self) -> bool {
        self.read.is_some() && self.read == self.written && !self.is_shared
    }
}

/// The coil that an instruction writes in every scan. States are not meant: OUT S is a transition.
fn driven_coil(code: &Code, i: usize) -> Option<Coil> {
    let operand = match code.basic(i)? {
        Basic::Out | Basic::Pls | Basic::Plf => 0,
        Basic::Mc => 1,
        _ => return None,
    };
    match code.instr(i).operands.get(operand)?.kind {
        OperandKind::Device(device, None) if device.class != DeviceClass::S => Some((device, None)),
        OperandKind::WordBit(device, bit, None) => Some((device, Some(bit))),
        _ => None,
    }
}

/// The timer with which STMR or ANS measures; no other instruction may drive it (h1u-h2u-programming §4.3.5, §4.3.7).
fn measuring_timer(code: &Code, i: usize) -> Option<Device> {
    let measures = matches!(code.lower(i)?, Lower::Call(RtFn::Stmr | RtFn::Ans));
    let timer = code.device(i, 0).filter(|_| measures)?;
    (timer.class == DeviceClass::T).then_some(timer)
}

fn driven_twice(
    code: &Code,
    ((device, bit), words): (Coil, bool),
    earlier: &[usize],
    last: usize,
) -> Diagnostic {
    let name = match bit {
        Some(bit) => OperandKind::WordBit(device, bit, None).to_string(),
        None => device.to_string(),
    };
    let times = match earlier.len() {
        1 => phrase!("twice"),
        n => phrase!("at {n} places", n = n + 1),
    };
    let timer = matches!(device.class, DeviceClass::T | DeviceClass::C);
    let (finding, what, label, help) = match (timer, words) {
        (true, _) => (
            &codes::TIMER_TWICE,
            phrase!("`{name}` is driven {times}", name, times),
            "… and again here",
            "use a separate one in each place",
        ),
        (false, false) => (
            &codes::DOUBLE_COIL,
            phrase!(
                "coil `{name}` is driven {times}; only the last result counts",
                name,
                times
            ),
            "… and again here: this one decides the state of the coil",
            "join the conditions with OR into one coil, or use SET and RST",
        ),
        (false, true) => (
            &codes::DOUBLE_COIL,
            phrase!(
                "`{name}` is written {times}; only the last result counts",
                name,
                times
            ),
            "… and again here: this one decides its state",
            "write it in one place, or use another device",
        ),
    };
    let help = match code.basic(last) {
        Some(Basic::Mc) => "give each zone a separate relay",
        _ => help,
    };
    let mut diagnostic = finding.at(code.span(last), what).label(label).help(help);
    for (n, &coil) in earlier.iter().enumerate() {
        let text = match n {
            0 if words && !timer => phrase!("first written here …"),
            0 => phrase!("first driven here …"),
            _ if words && !timer => phrase!("… written here …"),
            _ => phrase!("… driven here …"),
        };
        diagnostic = diagnostic.other(code.span(coil), text);
    }
    diagnostic
}

fn driven_together(code: &Code, device: Device, [first, second]: [usize; 2]) -> Diagnostic {
    let (finding, what, label, help) = match device.class {
        DeviceClass::T | DeviceClass::C => (
            &codes::TIMER_TWICE,
            phrase!(
                "`{device}` is driven in branches that run at the same time",
                device
            ),
            "… and in this one",
            "use a separate one in each branch",
        ),
        _ => (
            &codes::DOUBLE_COIL,
            phrase!(
                "coil `{device}` is driven in branches that run at the same time",
                device
            ),
            "… and in this one, which decides while both run",
            "drive it after RET, with the contacts of both states",
        ),
    };
    finding
        .at(code.span(second), what)
        .label(label)
        .other(code.span(first), "driven in one branch …")
        .help(help)
}
