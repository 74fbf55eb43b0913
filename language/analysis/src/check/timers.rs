//! Timers where they do not measure well: in neighbouring states, and in routines.

use super::Code;
use super::calls::Calls;
use super::structure::{NONE, Nesting, Routine};
use rungc_catalogue::Basic;
use rungc_models::{Model, Timers};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Phrase, codes, phrase};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeSet;

/// Checks the places of timers.
pub(super) fn check(code: &Code, nesting: &Nesting, calls: &Calls, out: &mut Diagnostics) {
    in_routines(code, nesting, calls, out);
    in_next_states(code, nesting, out);
}

/// The timer that an instruction drives.
fn timer(code: &Code, i: usize) -> Option<Device> {
    let device = code.device(i, 0)?;
    (code.basic(i) == Some(Basic::Out) && device.class == DeviceClass::T).then_some(device)
}

/// Ordinary timers in subroutines and interrupt routines (h1u-h2u-programming §3.5, §4.3.1).
fn in_routines(code: &Code, nesting: &Nesting, calls: &Calls, out: &mut Diagnostics) {
    let model = code.model();
    for i in 0..code.len {
        let routine = nesting.of(i).routine;
        let subroutine = match routine {
            Routine::Sub(_) if calls.in_every_scan(routine) => continue,
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
        if kind.free_running {
            continue;
        }
        let name = if subroutine {
            phrase!("a subroutine")
        } else {
            phrase!("an interrupt routine")
        };
        let message = phrase!(
            "`{device}` is updated only in scans that run {name}",
            device,
            name
        );
        let diagnostic = codes::TIMER_IN_ROUTINE
            .at(code.span(i), message)
            .label("measures incorrectly if not every scan does")
            .help(instead(model, kind.unit_ms, kind.accumulating, subroutine));
        out.push(diagnostic);
    }
}

/// What to do instead of driving a timer that counts units of this many milliseconds in a routine, and may keep its
/// value.
fn instead(model: &Model, unit_ms: u16, accumulating: bool, subroutine: bool) -> Phrase {
    let named = |timers: &Timers| {
        let [first, last] = [timers.first, timers.last].map(|n| DeviceClass::T.number(n));
        phrase!("{first} to {last}", first, last)
    };
    let free = |accumulating| {
        let mut timers = model.timers.iter().filter(|t| t.kind.free_running);
        timers.find(|timers| timers.kind.accumulating == accumulating)
    };
    let (plain, fine) = (free(false), free(true));
    let Some(free) = plain.map(named) else {
        return match subroutine {
            true => phrase!("drive it in the main program, or call the subroutine in every scan"),
            false => phrase!("drive it in the main program"),
        };
    };
    if let (true, Some(fine)) = (accumulating, fine) {
        return phrase!(
            "{fine} continue by themselves and keep their value until RST, too, but count 1 ms: convert a preset given in \
             {unit_ms} ms units",
            fine = named(fine),
            unit_ms
        );
    }
    if unit_ms == 100 {
        return phrase!(
            "{free} continue by themselves in scans that do not run their coils",
            free
        );
    }
    let fine = fine.map(|timers| {
        phrase!(
            "; {timers} do so too: they count 1 ms and keep their value until RST",
            timers = named(timers)
        )
    });
    phrase!(
        "{free} continue by themselves, but count 100 ms: convert a preset given in {unit_ms} ms units{fine}",
        free,
        unit_ms,
        fine = fine.unwrap_or_default()
    )
}

/// Timers that are driven in a state and in one that it leads to.
fn in_next_states(code: &Code, nesting: &Nesting, out: &mut Diagnostics) {
    let state_of = |i: usize| match nesting.of(i).state {
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
    let mut reported = FxHashSet::default();
    for (state, timer) in order {
        for &next in transitions.get(&state).into_iter().flatten() {
            let both = (driven.get(&(state, timer)), driven.get(&(next, timer)));
            let (Some(&first), Some(&second)) = both else {
                continue;
            };
            if next == state || !reported.insert((first.min(second), first.max(second))) {
                continue;
            }
            let diagnostic = codes::TIMER_IN_NEXT_STATE
                .at(
                    code.span(second),
                    phrase!(
                        "`{timer}` is driven in `{state}` and in `{next}`, which follows it",
                        timer,
                        state,
                        next
                    ),
                )
                .label("not cleared when this state starts")
                .other(code.span(first), "driven here too")
                .help("use another timer in one of the two states");
            out.push(diagnostic);
        }
    }
}
