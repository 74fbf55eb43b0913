//! Coils, timers and counters that are driven at several places.

use super::Code;
use super::skips::Skips;
use super::structure::{NONE, Nesting};
use rungc_catalogue::{Basic, Lower};
use rungc_rt::RtFn;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes};
use rustc_hash::FxHashMap;

/// Warns of coils that the last of several places decides.
pub(super) fn check(code: &Code, skips: &Skips, nesting: &Nesting, out: &mut Diagnostics) {
    let mut driven: FxHashMap<Device, Vec<usize>> = FxHashMap::default();
    for i in 0..code.len {
        if let Some(device) = driven_coil(code, i).or_else(|| measuring_timer(code, i)) {
            driven.entry(device).or_default().push(i);
        }
    }
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
