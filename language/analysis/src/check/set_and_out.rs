//! Coils that OUT and SET or RST both write.

use super::skips::Skips;
use super::structure::{NONE, Nesting, Routine};
use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, codes, phrase};
use rustc_hash::FxHashMap;

/// Positions at which a coil is written and its contact read.
#[derive(Default)]
struct Uses {
    out: Vec<usize>,
    set: Vec<usize>,
    rst: Vec<usize>,
    contacts: Vec<usize>,
}

/// Condition under which an instruction runs: its routine, its state and the jumps that skip it.
pub(super) type Condition = (Routine, Option<Device>, u64);

/// Warns of coils that SET or RST write in vain, since an OUT writes them in every scan.
pub(super) fn check(code: &Code, nesting: &Nesting, skips: &Skips, out: &mut Diagnostics) {
    let mut coils: FxHashMap<Device, Uses> = FxHashMap::default();
    for i in 0..code.len {
        let Some(device) = code
            .device(i, 0)
            .filter(|device| matches!(device.class, DeviceClass::Y | DeviceClass::M))
        else {
            continue;
        };
        let (basic, part) = (code.basic(i), code.part(i));
        if basic.is_none() {
            continue;
        }
        let uses = coils.entry(device).or_default();
        match basic {
            Some(Basic::Out) => uses.out.push(i),
            Some(Basic::Set) => uses.set.push(i),
            Some(Basic::Rst) => uses.rst.push(i),
            _ if matches!(part, Part::Start | Part::Continue) => uses.contacts.push(i),
            _ => {}
        }
    }
    let both = |uses: &Uses| !uses.out.is_empty() && uses.set.len() + uses.rst.len() > 0;
    coils.retain(|_, uses| both(uses));
    if coils.is_empty() {
        return;
    }
    let rungs = begins_of_rungs(code);
    let condition = |i: usize| condition(code, nesting, skips, i);
    let mut found: Vec<_> = coils
        .iter()
        .filter_map(|(&device, uses)| in_vain(code, device, uses, &rungs, condition))
        .collect();
    found.sort_by_key(|diagnostic| diagnostic.span);
    out.extend(found);
}

/// Condition under which instruction `i` runs.
pub(super) fn condition(code: &Code, nesting: &Nesting, skips: &Skips, i: usize) -> Condition {
    let enclosing = nesting.of(i);
    let state = match enclosing.state {
        NONE => None,
        stl => code.device(stl as usize, 0),
    };
    (enclosing.routine, state, skips.mark(i))
}

fn in_vain(
    code: &Code,
    device: Device,
    uses: &Uses,
    rungs: &[u32],
    condition: impl Fn(usize) -> Condition,
) -> Option<Diagnostic> {
    let each_scan = (Routine::Main, None, 0);
    let read_between = |from: usize, to: usize| {
        let next = uses.contacts.partition_point(|&i| i < from);
        uses.contacts.get(next).is_some_and(|&i| i < to)
    };
    let mut outs: FxHashMap<Condition, Vec<usize>> = FxHashMap::default();
    for &out in &uses.out {
        // A coil that holds itself takes over what SET and RST did.
        if !read_between(rungs[out] as usize, out) {
            outs.entry(condition(out)).or_default().push(out);
        }
    }
    let overwriting = |i: usize| {
        let conditions = [each_scan, condition(i)];
        let outs = conditions.into_iter().filter_map(|when| outs.get(&when));
        outs.map(Vec::as_slice).collect::<Vec<_>>()
    };
    // A relay that contacts follow until the next OUT holds an intermediate result, as in code that GX Works2 makes of
    // labels, unless contacts see it before anything switches it on.
    let first_on = uses.set.iter().chain(&uses.out).min();
    let routine = |i: usize| condition(i).0;
    let carried = first_on.is_some_and(|&first| {
        let mut before = uses.contacts.iter().take_while(|&&i| i < first);
        before.any(|&i| routine(i) == routine(first))
    });
    let counts = |set: usize, outs: &[usize]| {
        let next = outs.get(outs.partition_point(|&out| out < set));
        match next {
            Some(&next) => !carried && read_between(set, next),
            None => read_between(set, usize::MAX) || read_between(0, outs[0]),
        }
    };
    let set_in_vain = |&set: &usize| {
        let outs = overwriting(set).into_iter().next()?;
        let lasts = device.class == DeviceClass::M && counts(set, outs);
        outs.first().filter(|_| !lasts).map(|&out| (out, set))
    };
    // A RST that follows the OUT switches the coil off for the rest of the scan, and one that contacts follow until
    // then: both may be meant.
    let reset_last = uses.rst.last() > uses.out.last();
    let reset_in_vain = |&rst: &usize| {
        let next = |outs: &[usize]| outs.get(outs.partition_point(|&out| out < rst)).copied();
        let out = overwriting(rst).into_iter().filter_map(next).min()?;
        (!reset_last && !read_between(rst, out)).then_some((out, rst))
    };
    let (out, set) = (uses.set.iter().find_map(set_in_vain))
        .or_else(|| uses.rst.iter().find_map(reset_in_vain))?;
    let mnemonic = &code.instr(set).mnemonic;
    let message = phrase!(
        "`{mnemonic} {device}` does not last: `OUT {device}` writes the coil in every scan",
        mnemonic,
        device
    );
    let mut diagnostic = codes::OUT_AND_SET
        .at(code.span(set), message)
        .label("what this writes …")
        .other(code.span(out), "… is lost here");
    let rest = uses.set.iter().chain(&uses.rst).chain(&uses.out);
    let mut rest: Vec<_> = rest.filter(|&&i| i != set && i != out).collect();
    rest.sort();
    for &i in rest {
        diagnostic = diagnostic.other(code.span(i), "written here too");
    }
    Some(diagnostic.help("use only SET and RST, or one OUT with all conditions"))
}

/// For each instruction where its rung begins: at an LD that nothing joins to the code before it.
pub(super) fn begins_of_rungs(code: &Code) -> Vec<u32> {
    let mut begin = 0;
    let rungs = (0..code.len).map(|i| {
        let before = i
            .checked_sub(1)
            .map_or(Part::Alone, |before| code.part(before));
        let ended = matches!(before, Part::Output | Part::Alone);
        if code.part(i) == Part::Start && ended {
            begin = i as u32;
        }
        begin
    });
    rungs.collect()
}
