//! Timers where they do not measure well: in neighbouring states, and in routines.

use super::Code;
use super::structure::{NONE, Places, Routine};
use crate::catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;

/// Checks the places of timers.
pub(super) fn check(code: &Code, places: &Places, out: &mut Diagnostics) {
    in_routines(code, places, out);
    in_next_states(code, places, out);
}

/// The timer that an instruction drives.
fn timer(code: &Code, i: usize) -> Option<Device> {
    let device = code.device(i, 0)?;
    (code.basic(i) == Some(Basic::Out) && device.class == DeviceClass::T).then_some(device)
}

/// Ordinary timers in subroutines and interrupt routines (h1u-h2u-programming §3.5, §4.3.1).
fn in_routines(code: &Code, places: &Places, out: &mut Diagnostics) {
    let model = code.model();
    if !model.timers.iter().any(|timers| timers.kind.free_running) {
        return;
    }
    for i in 0..code.len {
        let subroutine = match places.of(i).routine {
            Routine::Sub(_) => true,
            Routine::Interrupt(_) => false,
            Routine::Main | Routine::Nothing => continue,
        };
        let Some(device) = timer(code, i) else {
            continue;
        };
        let Some(kind) = model.timer(device.number) else {
            continue;
        };
        let fine_grained = subroutine && kind.accumulating && kind.unit_ms == 1;
        if kind.free_running || fine_grained {
            continue;
        }
        let name = if subroutine {
            "a subroutine"
        } else {
            "an interrupt routine"
        };
        let diagnostic = codes::TIMER_IN_ROUTINE
            .at(
                code.span(i),
                format!("`{device}` measures wrongly in {name}"),
            )
            .label("is brought up to date only when the routine runs")
            .help("use T192 to T199 here");
        out.push(diagnostic);
    }
}

/// Timers that are driven in a state and in one that it leads to.
fn in_next_states(code: &Code, places: &Places, out: &mut Diagnostics) {
    let state_of = |i: usize| match places.of(i).state {
        NONE => None,
        stl => code.device(stl as usize, 0),
    };
    let mut transitions: FxHashMap<Device, BTreeSet<Device>> = FxHashMap::default();
    let mut driven: FxHashMap<(Device, Device), usize> = FxHashMap::default();
    let mut order = Vec::new();
    for i in 0..code.len {
        let Some(state) = state_of(i) else {
            continue;
        };
        if let Some(timer) = timer(code, i) {
            driven.entry((state, timer)).or_insert_with(|| {
                order.push((state, timer));
                i
            });
        }
        let target = code
            .device(i, 0)
            .filter(|device| device.class == DeviceClass::S);
        if let (Some(Basic::Out | Basic::Set), Some(target)) = (code.basic(i), target) {
            transitions.entry(state).or_default().insert(target);
        }
    }
    let mut told = FxHashSet::default();
    for (state, timer) in order {
        for &next in transitions.get(&state).into_iter().flatten() {
            let both = (driven.get(&(state, timer)), driven.get(&(next, timer)));
            let (Some(&first), Some(&second)) = both else {
                continue;
            };
            if next == state || !told.insert((first.min(second), first.max(second))) {
                continue;
            }
            let diagnostic = codes::TIMER_IN_NEXT_STATE
                .at(
                    code.span(second),
                    format!("`{timer}` is driven in `{state}` and in `{next}`, which follows it"),
                )
                .label("not cleared when this state begins")
                .other(code.span(first), "driven here too")
                .help("use another timer in one of the two states");
            out.push(diagnostic);
        }
    }
}
