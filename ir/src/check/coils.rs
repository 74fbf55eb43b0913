//! Coils, timers and counters that are driven at several places.

use super::Code;
use super::pointers::Pointers;
use super::structure::{NONE, Places};
use crate::catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes};
use rustc_hash::FxHashMap;

/// How many other places one diagnostic shows.
pub(super) const MAX_PLACES: usize = 6;

/// Warns of coils that the last of several places decides.
pub(super) fn check(code: &Code, pointers: &Pointers, places: &Places, out: &mut Diagnostics) {
    let skipped_by = skipping_jumps(code, pointers);
    let mut driven: FxHashMap<Device, Vec<usize>> = FxHashMap::default();
    for i in 0..code.len {
        if let Some(device) = driven_coil(code, i) {
            driven.entry(device).or_default().push(i);
        }
    }
    let mut found = Vec::new();
    for (device, mut coils) in driven {
        // Within a state, or outside of all, under the same jumps: these write in the same scan.
        let condition = |&i: &usize| {
            let state = match places.of(i).state {
                NONE => None,
                stl => code.device(stl as usize, 0),
            };
            (state, skipped_by.as_ref().map_or(0, |jumps| jumps[i]))
        };
        coils.sort_by_key(condition);
        let same = coils
            .chunk_by(|a, b| condition(a) == condition(b))
            .find_map(|same| same.split_last().filter(|(_, earlier)| !earlier.is_empty()));
        if let Some((&last, earlier)) = same {
            found.push(driven_twice(code, device, earlier, last));
        }
    }
    found.sort_by_key(|diagnostic| diagnostic.span);
    out.extend(found);
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

/// For each instruction a mark of the forward jumps that skip it: instructions with different marks need not run in the same
/// scan. `None` if nothing jumps.
fn skipping_jumps(code: &Code, pointers: &Pointers) -> Option<Vec<u64>> {
    let mut marks = vec![0u64; code.len + 1];
    let mut any = false;
    for (_, pointer) in pointers.iter() {
        let Some(&label) = pointer.labels.first() else {
            continue;
        };
        for &jump in pointer.jumps.iter().filter(|&&jump| jump < label) {
            // A hash per jump, so that the marks of different sets of jumps differ.
            let mark = (jump as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            marks[jump] ^= mark;
            marks[label] ^= mark;
            any = true;
        }
    }
    any.then(|| {
        marks
            .into_iter()
            .scan(0, |mark, change| {
                *mark ^= change;
                Some(*mark)
            })
            .collect()
    })
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
            .help("use one of its own for each place"),
        false => codes::DOUBLE_COIL
            .at(
                code.span(last),
                format!("coil `{device}` is driven {times}; only the last result counts"),
            )
            .label("… and again here: this one decides what the coil does")
            .help("join the conditions with OR into one coil, or use SET and RST"),
    };
    for (n, &coil) in earlier.iter().take(MAX_PLACES).enumerate() {
        let text = if n == 0 {
            "first driven here …"
        } else {
            "… driven here …"
        };
        diagnostic = diagnostic.other(code.span(coil), text);
    }
    diagnostic
}
