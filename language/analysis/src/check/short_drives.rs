//! Motions whose contacts are closed for one scan, so that they stop in the next.

use super::Code;
use super::drives::{Drive, Lasts, level};
use super::overlaps::clears;
use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use crate::accesses::{self, Access};
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes, phrase};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// Warns of instruction `i` if an edge drives it that has to drive it until it has ended.
pub(super) fn check(
    code: &Code,
    i: usize,
    drive: Drive,
    (nesting, skips): (&Nesting, &Skips),
    out: &mut Diagnostics,
) {
    let stops = code.inst(i).is_some_and(|inst| inst.stops_undriven);
    let enclosing = nesting.of(i);
    // A routine, a loop or skipped code need not meet the open contacts in the next scan.
    let each_scan =
        (enclosing.routine, enclosing.inner_loop) == (Routine::Main, NONE) && skips.mark(i) == 0;
    if !stops || drive.lasts != Lasts::Once || !each_scan || code.is_meant(i) {
        return;
    }
    let mnemonic = &code.instr(i).mnemonic;
    let message = phrase!(
        "`{mnemonic}` is driven for one scan, but stops when its contacts open",
        mnemonic
    );
    let diagnostic = codes::SHORT_DRIVE
        .at(code.span(i), message)
        .label("starts, and stops in the next scan")
        .help("let the edge SET a relay that drives it, and RST the relay when it has ended");
    out.push(diagnostic);
}

/// For each instruction, true if a master control is open there.
fn in_zones(code: &Code) -> Vec<bool> {
    let mut open = 0;
    let inside = |i| {
        match code.basic(i) {
            Some(Basic::Mc) => open = level(code, i) + 1,
            Some(Basic::Mcr) => open = open.min(level(code, i)),
            Some(Basic::Fend | Basic::End | Basic::Sret | Basic::Iret | Basic::Pret) => open = 0,
            _ => {}
        }
        open > 0
    };
    (0..code.len).map(inside).collect()
}

/// The relays that are on for one scan each time: nothing but one PLS or PLF switches them on, in each scan.
pub(super) fn pulses(code: &Code, nesting: &Nesting, skips: &Skips) -> FxHashSet<Device> {
    let mut found = BTreeSet::new();
    let outside = code.resolved.program.parameters.as_ref();
    let outside = outside.map_or(&[][..], |known| &known.written_externally);
    if !code.is_understood() || outside.iter().any(|run| run.class == DeviceClass::M) {
        return FxHashSet::default();
    }
    let in_zone = in_zones(code);
    let is_pulse = |i: usize| {
        let enclosing = nesting.of(i);
        matches!(code.basic(i), Some(Basic::Pls | Basic::Plf))
            && enclosing.routine == Routine::Main
            && (enclosing.inner_loop, enclosing.state) == (NONE, NONE)
            && !in_zone[i]
            && skips.mark(i) == 0
    };
    for i in (0..code.len).filter(|&i| is_pulse(i)) {
        let relay = code
            .device(i, 0)
            .filter(|relay| relay.class == DeviceClass::M);
        found.extend(relay);
    }
    let mut seen = FxHashSet::default();
    for i in 0..code.len {
        if found.is_empty() || clears(code, i) {
            continue;
        }
        for access in accesses::of(code.resolved, i).filter(Access::writes) {
            let written: Vec<Device> = found.range(access.devices()).copied().collect();
            for relay in written {
                if !is_pulse(i) || !seen.insert(relay) {
                    found.remove(&relay);
                }
            }
            if access.count.is_none() {
                found.retain(|relay| relay.class != access.first.class);
            }
        }
    }
    found.into_iter().collect()
}
