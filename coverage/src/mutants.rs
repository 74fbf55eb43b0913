//! Mutants: small changes of a program, as mistakes are. A test suite that fails with a mutant notices it; one that
//! passes has a gap at this place.
//!
//! Each mutant is lowered by itself and runs on the interpreter, only the cases that execute the changed instruction,
//! those first that have noticed most mutants so far, and only until one fails.

use crate::Covered;
use crate::goals::is_contact;
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_catalogue::{Basic, Drive, Lower};
use rungc_ir::Module;
use rungc_ir::layout::Wanted;
use rungc_ladder::build;
use rungc_lower::{LowerOptions, lower};
use rungc_rt::special::M_RUNNING;
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{Case, Suite, run_steps};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind, Program};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::thread;

/// A change of a program.
#[derive(Clone, PartialEq, Debug)]
pub struct Mutant {
    /// The instruction that is changed, or the first of those that are left out.
    pub instr: usize,
    /// The instructions in place of those from `instr` on, as many.
    changed: Vec<Instr>,
    /// What was done.
    pub change: Change,
}

/// What was done to make a mutant.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Change {
    /// A normally open contact became a normally closed one, or the other way round.
    Inverted,
    /// A contact was bridged, or left out of a parallel connection.
    Dropped,
    /// A constant is larger by 1.
    OneMore,
    /// A constant is smaller by 1.
    OneLess,
    /// A timer takes twice as long.
    TwiceAsLong,
    /// SET became OUT, or the other way round.
    SetOrOut,
    /// The network was left out.
    Removed,
}

/// What became of a mutant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// A case failed.
    Noticed,
    /// No case failed, although some executed the instruction.
    Survived,
    /// No case executes the instruction.
    NotExecuted,
    /// It is not a program.
    Invalid,
}

impl Mutant {
    /// What was done, in words: `ANI X001 instead of AND X001`.
    pub fn describe(&self, program: &Program) -> String {
        match self.change {
            Change::Removed => "the network was left out".to_string(),
            _ => {
                let (new, old) = (&self.changed[0], &program.instrs[self.instr]);
                match self.change {
                    Change::Dropped if new.operands.is_empty() => format!("{old} was left out"),
                    Change::Dropped => format!("{old} was bridged"),
                    _ => format!("{new} instead of {old}"),
                }
            }
        }
    }

    fn range(&self) -> Range<usize> {
        self.instr..self.instr + self.changed.len()
    }
}

/// All mutants of a program, in its order.
pub fn mutants(covered: &Covered) -> Vec<Mutant> {
    let program = &covered.program;
    let (resolved, _) = resolve(program, covered.model);
    let mut found = Vec::new();
    for at in 0..program.instrs.len() {
        of_instr(&resolved, at, &mut found);
    }
    for network in build::ladder(&resolved).networks {
        let range = network.instrs.start + network.labels..network.instrs.end;
        let plain = range.clone().all(|at| is_plain(&resolved, at));
        if plain && !range.is_empty() {
            found.push(Mutant {
                instr: range.start,
                changed: program.instrs[range.clone()].iter().map(nothing).collect(),
                change: Change::Removed,
            });
        }
    }
    found.sort_by_key(|mutant| mutant.instr);
    found
}

/// Whether an instruction is contact logic, or something that it drives and that is over after the scan.
fn is_plain(resolved: &Resolved, at: usize) -> bool {
    let resolution = &resolved.instrs[at];
    let driven = resolution
        .inst
        .is_some_and(|inst| inst.drive != Drive::Alone);
    match resolution.lower {
        Some(Lower::Basic(basic)) => match basic {
            Basic::Anb | Basic::Orb | Basic::Mps | Basic::Mrd | Basic::Mpp => true,
            Basic::Inv | Basic::Mep | Basic::Mef | Basic::Out | Basic::Set | Basic::Rst => true,
            Basic::Pls | Basic::Plf => true,
            _ => is_contact(basic),
        },
        Some(_) => driven,
        None => false,
    }
}

fn instr(mnemonic: &str, like: &Instr) -> Instr {
    Instr {
        mnemonic: mnemonic.into(),
        ..like.clone()
    }
}

/// An instruction that does nothing.
fn nothing(like: &Instr) -> Instr {
    Instr {
        mnemonic: "NOP".into(),
        operands: Default::default(),
        remarks: None,
        ..like.clone()
    }
}

fn of_instr(resolved: &Resolved, at: usize, found: &mut Vec<Mutant>) {
    let old = &resolved.program.instrs[at];
    let mut add = |change, new| {
        found.push(Mutant {
            instr: at,
            changed: vec![new],
            change,
        });
    };
    let class = old
        .operands
        .first()
        .and_then(|operand| operand.kind.device());
    let class = class.map(|device| device.class);
    if let Some(basic) = resolved.instrs[at].basic() {
        if let Some(inverted) = inverted(basic) {
            add(Change::Inverted, instr(inverted, old));
        }
        if is_contact(basic) {
            dropped(basic, old, &mut add);
        }
        match (basic, class) {
            (Basic::Set, Some(DeviceClass::Y | DeviceClass::M)) => {
                add(Change::SetOrOut, instr("OUT", old));
            }
            (Basic::Out, Some(DeviceClass::Y | DeviceClass::M)) => {
                add(Change::SetOrOut, instr("SET", old));
            }
            _ => {}
        }
        if let (Basic::Out, Some(DeviceClass::T)) = (basic, class)
            && let Some(longer) = with_constant(old, 1, |preset| preset.saturating_mul(2))
        {
            add(Change::TwiceAsLong, longer);
        }
    }
    if is_plain(resolved, at) {
        for operand in 0..old.operands.len() {
            for (change, by) in [(Change::OneMore, 1), (Change::OneLess, -1)] {
                if let Some(new) = with_constant(old, operand, |value| value.saturating_add(by)) {
                    add(change, new);
                }
            }
        }
    }
}

/// The contact with the other meaning.
fn inverted(basic: Basic) -> Option<&'static str> {
    Some(match basic {
        Basic::Ld => "LDI",
        Basic::Ldi => "LD",
        Basic::And => "ANI",
        Basic::Ani => "AND",
        Basic::Or => "ORI",
        Basic::Ori => "OR",
        Basic::Ldp => "LDF",
        Basic::Ldf => "LDP",
        Basic::Andp => "ANDF",
        Basic::Andf => "ANDP",
        Basic::Orp => "ORF",
        Basic::Orf => "ORP",
        _ => return None,
    })
}

/// A contact in series is bridged, one in parallel left out. M8000 is on in RUN.
fn dropped(basic: Basic, old: &Instr, add: &mut impl FnMut(Change, Instr)) {
    match basic {
        Basic::Ld | Basic::Ldi | Basic::Ldp | Basic::Ldf => {
            let always = Device {
                class: DeviceClass::M,
                number: M_RUNNING.number(),
            };
            let mut bridge = instr("LD", old);
            if let Some(operand) = bridge.operands.first_mut() {
                operand.kind = OperandKind::Device(always, None);
            }
            add(Change::Dropped, bridge);
        }
        _ => add(Change::Dropped, nothing(old)),
    }
}

/// The instruction with another constant, if the operand is one.
fn with_constant(old: &Instr, operand: usize, f: impl FnOnce(i64) -> i64) -> Option<Instr> {
    let value = match old.operands.get(operand)?.kind {
        OperandKind::Decimal(value, None) => value,
        _ => return None,
    };
    let mut new = old.clone();
    new.operands.get_mut(operand)?.kind = OperandKind::Decimal(f(value), None);
    Some(new)
}

/// How many mutants of a program survived, were noticed and so on, and where those are that tell of a gap.
pub fn text(covered: &Covered, mutants: &[Mutant], fates: &[Fate]) -> String {
    let count = |fate| fates.iter().filter(|f| **f == fate).count();
    let (noticed, survived) = (count(Fate::Noticed), count(Fate::Survived));
    let not_executed = count(Fate::NotExecuted);
    let all = noticed + survived + not_executed;
    let mut out = format!(
        "{}: {noticed} of {all} mutants noticed, {survived} survived, {not_executed} not executed\n",
        covered.name
    );
    covered.drawn(|_, ladder| {
        for (number, network) in (1..).zip(&ladder.networks) {
            let here: Vec<_> = mutants
                .iter()
                .zip(fates)
                .filter(|(mutant, _)| network.instrs.contains(&mutant.instr))
                .collect();
            write_network(&mut out, covered, number, &here);
        }
    });
    out
}

/// The gaps of a network: an instruction a line, with all that was done to it.
fn write_network(out: &mut String, covered: &Covered, number: usize, here: &[(&Mutant, &Fate)]) {
    let line = |at: usize| covered.line(at);
    if !here.is_empty() && here.iter().all(|(_, fate)| **fate == Fate::NotExecuted) {
        let first = line(here[0].0.instr);
        let count = here.len();
        *out +=
            &format!("  network {number}, line {first}: no case executes it ({count} mutants)\n");
        return;
    }
    let mut gaps: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for (mutant, fate) in here {
        let what = match fate {
            Fate::Noticed | Fate::Invalid => continue,
            Fate::Survived => mutant.describe(&covered.program),
            Fate::NotExecuted => format!("{} (not executed)", mutant.describe(&covered.program)),
        };
        gaps.entry(mutant.instr).or_default().push(what);
    }
    for (at, whats) in gaps {
        *out += &format!(
            "  network {number}, line {}: {}\n",
            line(at),
            whats.join("; ")
        );
    }
}

/// Runs mutants of a program; what became of each. `progress` is called for each, and says whether to continue.
pub fn run(
    suite: &Suite,
    covered: &Covered,
    mutants: &[Mutant],
    progress: &(dyn Fn() -> bool + Sync),
) -> Vec<Fate> {
    let cases = covered.cases.iter();
    // Cases with several PLCs would need the programs of the others, too.
    let cases: Vec<Judge> = cases
        .map(|(id, executed)| Judge {
            case: &suite.files()[id.file].cases[id.case],
            executed,
            noticed: AtomicU32::new(0),
        })
        .filter(|judge| judge.case.others.is_empty())
        .collect();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut program = covered.program.clone();
        let mut fates = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(mutant) = mutants.get(at).filter(|_| progress()) else {
                return fates;
            };
            program.instrs[mutant.range()].clone_from_slice(&mutant.changed);
            fates.push((at, fate(covered, mutant, &program, &cases)));
            let old = &covered.program.instrs[mutant.range()];
            program.instrs[mutant.range()].clone_from_slice(old);
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut fates: Vec<(usize, Fate)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let done = workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap_or_default());
        done.collect()
    });
    fates.sort_by_key(|(at, _)| *at);
    fates.into_iter().map(|(_, fate)| fate).collect()
}

/// A case, and how many mutants it has noticed.
struct Judge<'s> {
    case: &'s Case,
    executed: &'s [bool],
    noticed: AtomicU32,
}

fn fate(covered: &Covered, mutant: &Mutant, program: &Program, cases: &[Judge]) -> Fate {
    let mut judges: Vec<&Judge> = cases
        .iter()
        .filter(|judge| mutant.range().any(|at| judge.executed[at]))
        .collect();
    if judges.is_empty() {
        return Fate::NotExecuted;
    }
    let Some(module) = module(covered, program) else {
        return Fate::Invalid;
    };
    judges.sort_by_key(|judge| std::cmp::Reverse(judge.noticed.load(Ordering::Relaxed)));
    let modules = std::slice::from_ref(&module);
    let mut engine = Interpreter::new(modules);
    for judge in judges {
        if run_steps(&mut engine, judge.case, &[0], modules).is_err() {
            judge.noticed.fetch_add(1, Ordering::Relaxed);
            return Fate::Noticed;
        }
    }
    Fate::Survived
}

/// The module of a changed program. Its structure is that of the program, which was checked.
fn module(covered: &Covered, program: &Program) -> Option<Module> {
    let (resolved, diagnostics) = resolve(program, covered.model);
    if diagnostics.has_errors() {
        return None;
    }
    let options = LowerOptions {
        name: covered.options.name.clone(),
        wanted: Wanted {
            observe: covered.options.observe.clone(),
            observe_all: covered.options.observe_all,
            ports: covered.options.ports.clone(),
            without_qlink: false,
        },
        bounds: covered.options.bounds.clone(),
    };
    lower(&resolved, &options).0
}
