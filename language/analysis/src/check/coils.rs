//! Coils, timers and counters that are driven at several places.

use super::Code;
use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use crate::accesses;
use rungc_catalogue::{Basic, Lower};
use rungc_rt::RtFn;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Warns of coils that the last of several places decides. The result of a coil of a relay that is read before the next
/// one counts, too: such a relay holds an intermediate result, as in code that GX Works2 makes of labels.
pub(super) fn check(code: &Code, skips: &Skips, nesting: &Nesting, out: &mut Diagnostics) {
    let mut driven: FxHashMap<Device, Vec<usize>> = FxHashMap::default();
    for i in 0..code.len {
        if let Some(device) = driven_coil(code, i).or_else(|| measuring_timer(code, i)) {
            driven.entry(device).or_default().push(i);
        }
    }
    driven.retain(|_, coils| coils.len() > 1);
    let reads = Reads::of(code, nesting, &driven);
    let mut found = Vec::new();
    for (device, mut coils) in driven {
        // Within a state, or outside of all, under the same jumps: these write in the same scan.
        let condition = |&i: &usize| {
            let state = match nesting.of(i).state {
                NONE => None,
                stl => code.device(stl as usize, 0),
            };
            (state, skips.mark(i))
        };
        coils.sort_by_key(condition);
        let lost = coils
            .chunk_by(|a, b| condition(a) == condition(b))
            .find_map(|same| {
                let lost = same
                    .windows(2)
                    .filter(|pair| !reads.any(device, pair[0], pair[1]));
                let lost: Vec<_> = lost.map(|pair| pair[0]).collect();
                same.last()
                    .copied()
                    .filter(|_| !lost.is_empty())
                    .map(|last| (lost, last))
            });
        if let Some((lost, last)) = lost {
            found.push(driven_twice(code, device, &lost, last));
        }
    }
    found.sort_by_key(|diagnostic| diagnostic.span);
    out.extend(found);
}

/// Instructions that read relays with several coils.
struct Reads {
    /// By relay: the places that read it, in order.
    places: BTreeMap<Device, Vec<usize>>,
    /// Relays that a routine reads.
    in_routines: Vec<Device>,
    /// The calls of the main program, in order.
    calls: Vec<usize>,
}

impl Reads {
    fn of(code: &Code, nesting: &Nesting, driven: &FxHashMap<Device, Vec<usize>>) -> Self {
        let relays = driven
            .keys()
            .filter(|device| device.class == DeviceClass::M);
        let mut reads = Reads {
            places: relays.map(|&device| (device, Vec::new())).collect(),
            in_routines: Vec::new(),
            calls: Vec::new(),
        };
        if reads.places.is_empty() {
            return reads;
        }
        for i in 0..code.len {
            let in_main = nesting.of(i).routine == Routine::Main;
            if in_main && code.basic(i) == Some(Basic::Call) {
                reads.calls.push(i);
            }
            for access in accesses::of(code.resolved, i).filter(accesses::Access::reads) {
                let Device { class, number } = access.first;
                let count = access.count.unwrap_or(u32::MAX);
                let last = number.saturating_add(count.saturating_sub(1));
                let last = Device {
                    class,
                    number: last,
                };
                for (device, places) in reads.places.range_mut(access.first..=last) {
                    places.push(i);
                    if !in_main {
                        reads.in_routines.push(*device);
                    }
                }
            }
        }
        reads.in_routines.sort_unstable();
        reads
    }

    /// Returns true if a relay is read after an instruction and before another one.
    fn any(&self, device: Device, after: usize, before: usize) -> bool {
        let Some(places) = self.places.get(&device) else {
            return false;
        };
        let between = |places: &[usize]| {
            let first = places.partition_point(|&place| place <= after);
            places.get(first).is_some_and(|&place| place < before)
        };
        between(places) || self.in_routines.binary_search(&device).is_ok() && between(&self.calls)
    }
}

/// The coil that an instruction writes in every scan. States are not meant: OUT S is a transition.
fn driven_coil(code: &Code, i: usize) -> Option<Device> {
    let operand = match code.basic(i)? {
        Basic::Out | Basic::Pls | Basic::Plf => 0,
        Basic::Mc => 1,
        _ => return None,
    };
    code.device(i, operand)
        .filter(|device| device.class != DeviceClass::S)
}

/// The timer with which STMR or ANS measures; no other instruction may drive it (h1u-h2u-programming §4.3.5, §4.3.7).
fn measuring_timer(code: &Code, i: usize) -> Option<Device> {
    let measures = matches!(code.lower(i)?, Lower::Call(RtFn::Stmr | RtFn::Ans));
    let timer = code.device(i, 0).filter(|_| measures)?;
    (timer.class == DeviceClass::T).then_some(timer)
}

fn driven_twice(code: &Code, device: Device, earlier: &[usize], last: usize) -> Diagnostic {
    let timer = matches!(device.class, DeviceClass::T | DeviceClass::C);
    let times = match earlier.len() {
        1 => "twice".to_owned(),
        n => format!("at {} places", n + 1),
    };
    let mut diagnostic = match timer {
        true => codes::TIMER_TWICE
            .at(code.span(last), format!("`{device}` is driven {times}"))
            .label("… and again here")
            .help("use a separate one in each place"),
        false => codes::DOUBLE_COIL
            .at(
                code.span(last),
                format!("coil `{device}` is driven {times}; only the last result counts"),
            )
            .label("… and again here: this one decides the state of the coil")
            .help("join the conditions with OR into one coil, or use SET and RST"),
    };
    for (n, &coil) in earlier.iter().enumerate() {
        let text = if n == 0 {
            "first driven here …"
        } else {
            "… driven here …"
        };
        diagnostic = diagnostic.other(code.span(coil), text);
    }
    diagnostic
}
