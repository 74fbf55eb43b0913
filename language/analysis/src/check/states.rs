//! States of step ladders: each occurs once, and does not lead to more others than the PLC follows.

use super::structure::{NONE, Nesting};
use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostics, codes, phrase};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// At most this many circuits may begin at one branch (h1u-h2u-programming §4.2.2).
const MAX_BRANCH: usize = 8;
/// At most this many circuits may branch off in the states that one initial state leads to (h1u-h2u-programming
/// §4.2.2).
const MAX_BRANCHES: usize = 16;
/// Initial states (h1u-h2u-programming §3.4).
const LAST_INITIAL: u32 = 9;

/// Checks the states of a program.
pub(super) fn check(code: &Code, nesting: &Nesting, out: &mut Diagnostics) {
    stands_twice(code, out);
    branches(code, nesting, out);
}

/// States that have two sections which do something. STL in a row, and a section that holds transitions alone, join
/// branches: so the manual writes them (h1u-h2u-programming §4.2.3, the sorting of balls).
fn stands_twice(code: &Code, out: &mut Diagnostics) {
    let stl = |i: usize| code.basic(i) == Some(Basic::Stl);
    let mut first: FxHashMap<Device, usize> = FxHashMap::default();
    for i in (0..code.len).filter(|&i| stl(i)) {
        let joins = i.checked_sub(1).is_some_and(stl) || i + 1 < code.len && stl(i + 1);
        let Some(state) = code.device(i, 0).filter(|_| !joins && acts(code, i)) else {
            continue;
        };
        let Some(&before) = first.get(&state) else {
            first.insert(state, i);
            continue;
        };
        let diagnostic = codes::STATE_TWICE
            .at(
                code.span(i),
                phrase!("the state `{state}` occurs twice", state),
            )
            .label("starts again here")
            .other(code.span(before), "first starts here")
            .help("give one of the two another number, or merge both into one section");
        out.push(diagnostic);
    }
}

/// Returns true if the section that begins with the STL at `stl` drives more than transitions.
fn acts(code: &Code, stl: usize) -> bool {
    let ends = |i: &usize| {
        matches!(
            code.basic(*i),
            Some(Basic::Stl | Basic::Ret | Basic::Fend | Basic::End)
        )
    };
    let section = (stl + 1..code.len).take_while(|i| !ends(i));
    let transition = |i: usize| {
        let state = code.device(i, 0).map(|device| device.class) == Some(DeviceClass::S);
        state && matches!(code.basic(i), Some(Basic::Set | Basic::Out))
    };
    let mut driven = section.filter(|&i| code.part(i) == Part::Output);
    driven.any(|i| !transition(i))
}

/// The states to which SET leads from each state, with the first transition; OUT only jumps to a state that others lead
/// to.
fn branches(code: &Code, nesting: &Nesting, out: &mut Diagnostics) {
    let mut leads: BTreeMap<Device, BTreeMap<Device, usize>> = BTreeMap::new();
    for i in 0..code.len {
        let from = match nesting.of(i).state {
            NONE => continue,
            stl => code.device(stl as usize, 0),
        };
        let to = code.device(i, 0).filter(|to| to.class == DeviceClass::S);
        if let (Some(Basic::Set), Some(from), Some(to)) = (code.basic(i), from, to) {
            leads.entry(from).or_default().entry(to).or_insert(i);
        }
    }
    for (from, to) in &leads {
        let mut transitions: Vec<_> = to.values().copied().collect();
        transitions.sort();
        if let (Some(&beyond), Some(&first)) = (transitions.get(MAX_BRANCH), transitions.first()) {
            let message = phrase!(
                "`{from}` branches into {transitions} states, the PLC follows {MAX_BRANCH}",
                from,
                transitions = transitions.len(),
                MAX_BRANCH
            );
            let diagnostic = codes::STATE_BRANCHES
                .at(code.span(beyond), message)
                .label("one branch too many")
                .other(code.span(first), "the first branch");
            out.push(diagnostic);
        }
    }
    for initial in leads.keys().filter(|state| state.number <= LAST_INITIAL) {
        let (count, last) = flow_branches(&leads, *initial);
        if count > MAX_BRANCHES {
            let message = phrase!(
                "{count} circuits branch off in the flow of `{initial}`, but the PLC supports {MAX_BRANCHES}",
                count,
                initial,
                MAX_BRANCHES
            );
            let diagnostic = codes::STATE_BRANCHES
                .at(code.span(last), message)
                .label("the last of these branches")
                .help("split the flow into several initial states");
            out.push(diagnostic);
        }
    }
}

/// Number of circuits that branch off in the flow of an initial state, and the last transition to one.
fn flow_branches(
    leads: &BTreeMap<Device, BTreeMap<Device, usize>>,
    initial: Device,
) -> (usize, usize) {
    let (mut count, mut last) = (0, 0);
    let mut seen = BTreeSet::from([initial]);
    let mut open = vec![initial];
    while let Some(state) = open.pop() {
        let Some(to) = leads.get(&state) else {
            continue;
        };
        if to.len() > 1 {
            count += to.len();
            last = to.values().copied().max().unwrap_or(last).max(last);
        }
        let next = to.keys().filter(|state| state.number > LAST_INITIAL);
        open.extend(next.filter(|state| seen.insert(**state)));
    }
    (count, last)
}
