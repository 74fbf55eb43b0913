//! Search for events that can never happen in a program although it provides for them.
//!
//! Runs by chance show most of what can happen. What they have not shown is tried to be proved
//! impossible, each by itself; only what is proved is reported. An output that changes in every scan is shown by
//! a run that the interpreter has confirmed.

mod dependence;
#[cfg(test)]
mod tests;

use crate::aig::Lit;
use crate::effort::Limit;
use crate::model::{Encoder, Key, Probes, World};
use crate::pdr;
use crate::prove::FOREVER_MS;
use crate::random::{EVALUATED, Lanes, Random};
use crate::replay::{Run, plain};
use crate::search::{Bounded, Induction, Step, Trace};
use crate::system::System;
use dependence::dependent;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Action, Expr, ExprId, Stmt};
use rungc_ir::walk::{operands, statements};
use rungc_models::runs::is_special;
use rungc_rt::{Class, CmpOp, Plc};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Kind of finding.
#[derive(Clone, PartialEq, Debug)]
pub enum Kind {
    /// A relay or an output is never switched on.
    NeverOn,
    /// A step is never reached.
    NeverReached,
    /// A step that can be reached is never left.
    NeverLeft,
    /// The scan comes to a rung, but what is in it is never executed.
    NeverActs,
    /// A comparison has the same result always.
    Constant {
        /// Relation that holds between the numbers.
        op: CmpOp,
        /// The numbers.
        sides: [ExprId; 2],
        /// The result.
        result: bool,
    },
    /// A timer never expires.
    NeverExpires,
    /// An output changes in every scan though no input does.
    Oscillates,
}

/// Evidence for a finding.
#[derive(Clone, PartialEq, Debug)]
pub enum Evidence {
    /// If it has not happened in this many scans in a row, it does not in the next one.
    Induction(usize),
    /// No run reaches one of this many sets of states, of which one includes all in which it happens.
    Invariant(usize),
    /// This run shows it.
    Trace(Trace),
}

/// A finding.
#[derive(Clone, PartialEq, Debug)]
pub struct Finding {
    /// Kind of finding.
    pub kind: Kind,
    /// The device that it is about.
    pub device: Option<(DeviceClass, u32)>,
    /// The network, by number in the module.
    pub network: u32,
    /// Evidence for it.
    pub evidence: Evidence,
    /// Devices that nothing but the program may write for the proof to hold, without outputs and relays that every scan
    /// writes anew; of what a run shows, none. Those that a comparison names come first.
    pub untouched: Vec<(DeviceClass, u32)>,
    /// Some of these devices: if something else writes them, it can happen. If that could not be decided in time, those
    /// that the comparison names.
    pub possible_with: Vec<(DeviceClass, u32)>,
}

impl Finding {
    /// An output that changes in every scan, as a run shows.
    fn oscillates(output: u32, network: u32, trace: Trace) -> Self {
        Finding {
            kind: Kind::Oscillates,
            device: Some((DeviceClass::Y, output)),
            network,
            evidence: Evidence::Trace(trace),
            untouched: Vec::new(),
            possible_with: Vec::new(),
        }
    }
}

/// All that was found.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Report {
    /// In the order of the networks.
    pub findings: Vec<Finding>,
    /// Number of questions not answered in time.
    pub open: usize,
}

/// Something that may be impossible.
struct Candidate {
    kind: Kind,
    device: Option<(DeviceClass, u32)>,
    network: u32,
    /// It is on in a scan that shows that it is possible.
    happens: Lit,
    /// It must have been on in some run: that the network is reached, for example.
    before: Lit,
    happened: bool,
    began: bool,
}

impl Candidate {
    fn new(
        kind: Kind,
        device: Option<(DeviceClass, u32)>,
        network: u32,
        happens: Lit,
        before: Lit,
    ) -> Self {
        Self {
            kind,
            device,
            network,
            happens,
            before,
            happened: false,
            began: before == Lit::TRUE,
        }
    }
}

/// Number of random runs from the beginning, and the scans of each.
const RUNS: usize = 24;
/// Scans with changing inputs, and then with the same.
const PHASE: usize = 8;
/// Limit of the effort for one proof.
const PROOF: u64 = 1500;
/// Maximum number of scans that induction assumes.
const INDUCTION: usize = 3;
/// Number of successive changes that make an output one that oscillates.
const CHANGES: usize = 6;

/// Assumptions about the environment of the program, whose devices in `free` may be written from outside, while nothing
/// else sets those in `unset`: none about the time of a scan.
pub fn world(free: BTreeSet<(DeviceClass, u32)>, unset: BTreeSet<(DeviceClass, u32)>) -> World {
    World {
        scan_ms: FOREVER_MS,
        free,
        unset,
        ..World::default()
    }
}

/// Looks for what can never happen in a world, within this effort.
pub fn look(module: &Module, world: World, effort: u64) -> Report {
    let limit = Limit::new(effort, None);
    let encoder = Encoder::scan_probed(module, world);
    let system = encoder.system(Lit::FALSE);
    let mut candidates = candidates(&encoder);
    let mut report = Report::default();
    simulate(
        module,
        &encoder,
        &system,
        (&mut candidates, &mut report),
        &limit.share(4),
    );
    let mut proved = Vec::new();
    for candidate in candidates.iter().filter(|c| !c.happened && c.began) {
        if limit.is_over() {
            report.open += 1;
            continue;
        }
        let about = system.about(candidate.happens);
        match never(&about, &limit.part(PROOF)) {
            Answer::Proved(evidence) => {
                let finding = Finding {
                    kind: candidate.kind.clone(),
                    device: candidate.device,
                    network: candidate.network,
                    evidence,
                    untouched: Vec::new(),
                    possible_with: Vec::new(),
                };
                proved.push((finding, about));
            }
            Answer::Possible => {}
            Answer::Open => report.open += 1,
        }
    }
    for (finding, about) in proved {
        let named = compared(module, &finding.kind);
        let finding = dependent(finding, &named, (&about, &encoder), &limit);
        report.findings.push(finding);
    }
    report.findings.sort_by_key(|finding| finding.network);
    report
}

/// Devices that a comparison names.
fn compared(module: &Module, kind: &Kind) -> BTreeSet<(DeviceClass, u32)> {
    let mut open = match kind {
        Kind::Constant { sides, .. } => sides.to_vec(),
        _ => Vec::new(),
    };
    let mut found = BTreeSet::new();
    while let Some(side) = open.pop() {
        let expr = module.expr(side);
        open.extend(operands(expr));
        if let Expr::Read(access) = expr
            && access.place.index.is_none()
        {
            let (class, number) = (access.place.class, access.place.number);
            let pair = access.kind == AccessKind::Pair;
            found.extend((number..=number + u32::from(pair)).map(|number| (class, number)));
        }
    }
    found
}

/// Events that a program provides for.
fn candidates(encoder: &Encoder) -> Vec<Candidate> {
    let Some(probes) = &encoder.probes else {
        return Vec::new();
    };
    let reached = |network: u32| {
        let rung = probes.rungs.get(&network);
        rung.map_or(Lit::TRUE, |rung| rung.reached)
    };
    let mut found = bits(encoder, probes, &reached);
    found.extend(probes.timers.iter().map(|(&number, timer)| {
        let device = Some((DeviceClass::T, number));
        let (expires, driven) = (timer.expires, timer.driven);
        Candidate::new(Kind::NeverExpires, device, timer.network, expires, driven)
    }));
    found.extend(probes.rungs.iter().filter_map(|(&network, rung)| {
        let acts = rung.acts.filter(|acts| *acts != rung.reached)?;
        let kind = Kind::NeverActs;
        Some(Candidate::new(kind, None, network, acts, rung.reached))
    }));
    for compared in &probes.comparisons {
        // Constants always compare the same.
        if compared.holds.constant().is_some() {
            continue;
        }
        let (op, sides, network) = (compared.op, compared.sides, compared.network);
        found.extend([true, false].map(|result| {
            let kind = Kind::Constant { op, sides, result };
            let otherwise = compared.holds.invert_if(result);
            Candidate::new(kind, None, network, otherwise, reached(network))
        }));
    }
    found
}

/// Relays and outputs that may never be on, states that may never be reached or left.
fn bits(encoder: &Encoder, probes: &Probes, reached: &impl Fn(u32) -> Lit) -> Vec<Candidate> {
    let mut found = Vec::new();
    for (&(class, number), written) in &probes.bits {
        let key = Key::Bit(class, number);
        let begins_off = encoder.initial(key) == Some(0) && !encoder.is_free(key);
        if !begins_off || is_special(class, number) {
            continue;
        }
        let kind = match class {
            DeviceClass::S => Kind::NeverReached,
            _ => Kind::NeverOn,
        };
        let (device, network) = (Some((class, number)), written.network);
        let (on, before) = (written.on, reached(network));
        found.push(Candidate::new(kind, device, network, on, before));
        if class == DeviceClass::S {
            let off = written.off;
            found.push(Candidate::new(Kind::NeverLeft, device, network, off, on));
        }
    }
    found
}

/// Timers with presets that are set up while the program runs: before that they expire at once, which does no harm.
fn timers_that_are_set_up(module: &Module) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            if let Stmt::Do(Action::Timer(coil)) = stmt
                && !matches!(module.expr(coil.preset), Expr::I16(_) | Expr::I32(_))
            {
                found.insert(coil.number);
            }
        });
    }
    found
}

/// Notes what happens in runs by chance, and finds outputs that oscillate.
fn simulate(
    module: &Module,
    encoder: &Encoder,
    system: &System,
    (candidates, report): (&mut [Candidate], &mut Report),
    limit: &Limit,
) {
    let mut random = Random::new();
    let written = encoder.probes.iter().flat_map(|probes| &probes.bits);
    let set_up = timers_that_are_set_up(module);
    let mut outputs: Vec<(u32, u32, Lit)> = written
        .filter(|((class, _), _)| *class == DeviceClass::Y)
        .filter_map(|(&(class, number), written)| {
            let after = encoder.after(Key::Bit(class, number))?[0];
            let latches = system.about(after).latches;
            let depends = latches.iter().any(|latch| match latch.key {
                Key::Timer(number, _) => set_up.contains(&number),
                _ => false,
            });
            (!depends).then_some((number, written.network, after))
        })
        .collect();
    for run in 0..RUNS {
        let mut lanes = Lanes::new(system, &mut random);
        // Some runs wait for all timers; in the others scans are short.
        let waits = run % 2 == 1;
        for phase in 0..4 {
            let mut shown: Vec<Vec<u64>> = Vec::new();
            for scan in 0..2 * PHASE {
                let quiet = scan >= PHASE;
                let ms = match (run + phase + scan, scan) {
                    (0, _) => 0,
                    _ if waits && random.below(3) == 0 => FOREVER_MS,
                    _ => [1, 10, 100, 30][random.below(4) as usize],
                };
                let ms = if phase + scan == 0 { 0 } else { ms };
                limit.charge(system.aig.nodes().len() / EVALUATED);
                lanes.scan(
                    if quiet && !waits { ms.min(1) } else { ms },
                    !quiet,
                    &mut random,
                );
                for candidate in candidates.iter_mut() {
                    candidate.happened |= lanes.value(candidate.happens) != 0;
                    candidate.began |= lanes.value(candidate.before) != 0;
                }
                if quiet {
                    shown.push(outputs.iter().map(|(.., lit)| lanes.value(*lit)).collect());
                }
            }
            if waits {
                continue;
            }
            let last = &shown[shown.len() - CHANGES - 1..];
            outputs = std::mem::take(&mut outputs)
                .into_iter()
                .enumerate()
                .filter(|&(i, (number, network, _))| {
                    let changes = last
                        .windows(2)
                        .fold(lanes.alive, |all, pair| all & (pair[0][i] ^ pair[1][i]));
                    let finding = (changes != 0)
                        .then(|| oscillation(module, number, lanes.trace(changes.trailing_zeros())))
                        .flatten();
                    let new = finding.is_none();
                    let seen = finding.map(|trace| Finding::oscillates(number, network, trace));
                    report.findings.extend(seen);
                    new
                })
                .map(|(_, output)| output)
                .collect();
        }
        if limit.is_over() {
            break;
        }
    }
}

/// The run, if the output changes in each of its last scans on the interpreter, too, though its inputs do not.
fn oscillation(module: &Module, number: u32, trace: Trace) -> Option<Trace> {
    let happens = |trace: &Trace| {
        let mut run = Run::new(module, trace);
        let (mut before, mut changes) = (None, 0);
        for (n, scan) in trace.scans.iter().enumerate() {
            if run.is_early(scan) {
                return None;
            }
            run.scan(scan)?;
            let on = run.machine().bit(Class::Y, number)?;
            let same_inputs = n > 0 && trace.scans[n - 1].set == scan.set;
            let changed = same_inputs && before == Some(!on);
            changes = if changed { changes + 1 } else { 0 };
            before = Some(on);
            if changes == CHANGES {
                return Some(n + 1);
            }
        }
        None
    };
    happens(&trace)?;
    Some(plain(&happens, FOREVER_MS, trace, &Limit::new(PROOF, None)))
}

/// An answer to whether something never happens.
enum Answer {
    Proved(Evidence),
    Possible,
    Open,
}

fn never(system: &System, limit: &Limit) -> Answer {
    by_induction(system, limit).unwrap_or_else(|| by_invariant(system, limit))
}

/// The answer of a few scans, if there is one.
fn by_induction(system: &System, limit: &Limit) -> Option<Answer> {
    let mut bounded = Bounded::new(system, false, limit);
    let mut induction = Induction::new(system, limit);
    for scans in 1..=INDUCTION {
        match bounded.step() {
            Step::Holds if induction.step() => {
                return Some(Answer::Proved(Evidence::Induction(scans)));
            }
            Step::Holds => {}
            Step::Violated(_) => return Some(Answer::Possible),
            Step::Impossible | Step::TimeUp => return Some(Answer::Open),
        }
    }
    None
}

fn by_invariant(system: &System, limit: &Limit) -> Answer {
    match pdr::search(system, limit) {
        pdr::Found::Invariant(cubes) => {
            let checked = pdr::check(system, &cubes, &Limit::new(PROOF, None));
            match checked {
                true => Answer::Proved(Evidence::Invariant(cubes.len())),
                false => Answer::Open,
            }
        }
        pdr::Found::Violated => Answer::Possible,
        pdr::Found::TimeUp => Answer::Open,
    }
}
