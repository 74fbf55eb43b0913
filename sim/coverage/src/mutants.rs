//! Mutants: small changes of a program, as mistakes are. A test suite that fails with a mutant notices it; one that
//! passes has a gap at this place.
//!
//! Each mutant is lowered by itself and runs on the interpreter: only the cases that can notice it, those first that
//! have noticed most mutants so far, and only until one fails. A case cannot notice another contact where the contact
//! never decides: no result of logic would be another one.

use crate::Covered;
use crate::goals::is_contact;
use crate::observe::{DECIDED_OFF, DECIDED_ON, EXECUTED, OFF, ON};
use rungc_analysis::resolve::{Resolved, resolve};
use rungc_catalogue::{Basic, Drive, Lower};
use rungc_ir::Module;
use rungc_ir::layout::Wanted;
use rungc_ladder::build;
use rungc_lower::compile::CompileOptions;
use rungc_lower::{LowerOptions, lower};
use rungc_models::Model;
use rungc_rt::special::M_RUNNING;
use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{Case, Suite, run_steps};
use rungc_sim::threads::Threads;
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind, Program};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU32, Ordering};

/// A change of a program.
#[derive(Clone, PartialEq, Debug)]
pub struct Mutant {
    /// The instruction that is changed, or the first of those that are left out.
    pub instr: usize,
    /// The instructions in place of those from `instr` on, as many.
    changed: Vec<Instr>,
    /// The first instruction of its network.
    network: usize,
    /// Observations of the instruction, any of which a case needs to detect it.
    needs: u8,
    /// Its change.
    pub change: Change,
}

/// Change that makes a mutant.
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

/// Outcome of a mutant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// A case failed.
    Noticed,
    /// No case failed, although some executed the instruction.
    Survived,
    /// As [`Fate::Survived`], but no run changes an output, as the caller has proved.
    Equivalent,
    /// No case executes the instruction.
    NotExecuted,
    /// It is not a program.
    Invalid,
}

impl Mutant {
    /// Description of the change: `ANI X001 instead of AND X001`.
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

    /// The changed program.
    pub fn applied(&self, program: &Program) -> Program {
        let mut program = program.clone();
        program.instrs[self.range()].clone_from_slice(&self.changed);
        program
    }

    fn range(&self) -> Range<usize> {
        self.instr..self.instr + self.changed.len()
    }

    /// Returns true if a case executes the changed instruction.
    fn is_executed(&self, seen: &[u8]) -> bool {
        // A contact whose state the compiler knows is not looked at; what it belongs to is.
        let mut looked_at = self.range().chain([self.network]);
        looked_at.any(|at| seen[at] & EXECUTED != 0)
    }

    /// Returns true if a case that executes it may detect it.
    fn may_be_noticed(&self, seen: &[u8]) -> bool {
        let seen = seen[self.instr];
        let is_seen = seen & (ON | OFF) != 0;
        !is_seen || seen & self.needs != 0
    }
}

/// All mutants of a program that cases test, in its order.
pub fn mutants(covered: &Covered) -> Vec<Mutant> {
    of_program(&covered.program, covered.model)
}

/// All mutants of a program for a PLC, in its order.
pub fn of_program(program: &Program, model: &'static Model) -> Vec<Mutant> {
    let (resolved, _) = resolve(program, model);
    let mut found = Vec::new();
    for network in build::ladder(&resolved).networks {
        let range = network.instrs.start + network.labels..network.instrs.end;
        let plain = range.clone().all(|at| is_plain(&resolved, at));
        let mut of_network = Vec::new();
        if plain && !range.is_empty() {
            of_network.push(Mutant {
                instr: range.start,
                changed: program.instrs[range.clone()].iter().map(nothing).collect(),
                network: range.start,
                needs: EXECUTED,
                change: Change::Removed,
            });
        }
        let first = range.start;
        range.for_each(|at| of_instr(&resolved, at, first, &mut of_network));
        of_network.sort_by_key(|mutant| (mutant.instr, mutant.change == Change::Removed));
        found.append(&mut of_network);
    }
    found
}

/// Returns true if an instruction is contact logic, or driven by it and without effect beyond the scan.
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

fn of_instr(resolved: &Resolved, at: usize, first: usize, found: &mut Vec<Mutant>) {
    let old = &resolved.program.instrs[at];
    let looks = match resolved.instrs[at].lower {
        Some(Lower::Compare(..)) => true,
        Some(Lower::Basic(basic)) => is_contact(basic),
        _ => false,
    };
    let usual = match looks {
        true => DECIDED_ON | DECIDED_OFF,
        false => EXECUTED,
    };
    let mut add = |change, new, needs| {
        found.push(Mutant {
            instr: at,
            changed: vec![new],
            // Only a contact is executed with its network.
            network: if looks { first } else { at },
            needs,
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
            add(Change::Inverted, instr(inverted, old), usual);
        }
        if is_contact(basic) {
            dropped(basic, old, &mut add);
        }
        match (basic, class) {
            (Basic::Set, Some(DeviceClass::Y | DeviceClass::M)) => {
                add(Change::SetOrOut, instr("OUT", old), usual);
            }
            (Basic::Out, Some(DeviceClass::Y | DeviceClass::M)) => {
                add(Change::SetOrOut, instr("SET", old), usual);
            }
            _ => {}
        }
        if let (Basic::Out, Some(DeviceClass::T)) = (basic, class)
            && let Some(longer) = with_constant(old, 1, |preset| preset.saturating_mul(2))
        {
            add(Change::TwiceAsLong, longer, usual);
        }
    }
    if is_plain(resolved, at) {
        for operand in 0..old.operands.len() {
            for (change, by) in [(Change::OneMore, 1), (Change::OneLess, -1)] {
                if let Some(new) = with_constant(old, operand, |value| value.saturating_add(by)) {
                    add(change, new, usual);
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

/// A contact in series is bridged, one in parallel left out, which matters where it does not conduct, or does. M8000 is
/// on in RUN.
fn dropped(basic: Basic, old: &Instr, add: &mut impl FnMut(Change, Instr, u8)) {
    let needs = match basic {
        Basic::Ldi | Basic::Ani | Basic::Or | Basic::Orp | Basic::Orf => DECIDED_ON,
        _ => DECIDED_OFF,
    };
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
            add(Change::Dropped, bridge, needs);
        }
        _ => add(Change::Dropped, nothing(old), needs),
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

/// Report on the mutants of a program: the numbers that survived, were detected and so on, and the positions of those
/// that indicate a gap.
pub fn text(covered: &Covered, mutants: &[Mutant], fates: &[Fate]) -> String {
    let count = |fate| fates.iter().filter(|f| **f == fate).count();
    let (noticed, survived) = (count(Fate::Noticed), count(Fate::Survived));
    let not_executed = count(Fate::NotExecuted);
    let all = noticed + survived + not_executed;
    let equivalent = match count(Fate::Equivalent) {
        0 => String::new(),
        count => format!("; {count} more never change an output (proved)"),
    };
    let mut out = format!(
        "{}: {noticed} of {all} mutants noticed, {survived} survived, {not_executed} not executed{equivalent}\n",
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
            Fate::Noticed | Fate::Invalid | Fate::Equivalent => continue,
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
    progress: &dyn Fn() -> bool,
) -> Vec<Fate> {
    let court = Court::new(suite, covered);
    let judge = |program: &mut Program, mutant: &Mutant| {
        program.instrs[mutant.range()].clone_from_slice(&mutant.changed);
        let fate = court.fate(mutant, program);
        let old = &covered.program.instrs[mutant.range()];
        program.instrs[mutant.range()].clone_from_slice(old);
        fate
    };
    let mut fates = Vec::with_capacity(mutants.len());
    let start = || covered.program.clone();
    Threads::usual().each(mutants, start, judge, |fate| {
        fates.push(fate);
        match progress() {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    });
    fates
}

/// A case, and how many mutants it has noticed.
struct Judge<'s> {
    case: &'s Case,
    /// Observations of each instruction.
    seen: &'s [u8],
    /// Index of the case's way to compile the program.
    way: usize,
    /// The programs of the other PLCs.
    others: Vec<&'s Module>,
    noticed: AtomicU32,
}

/// All that judge mutants of a program.
struct Court<'s> {
    covered: &'s Covered,
    judges: Vec<Judge<'s>>,
    /// Cases may need other serial ports.
    ways: Vec<LowerOptions>,
}

impl<'s> Court<'s> {
    fn new(suite: &'s Suite, covered: &'s Covered) -> Self {
        let (mut judges, mut ways) = (Vec::new(), Vec::new());
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        for (id, seen) in &covered.cases {
            let Some((own, others)) = suite.modules_of(*id).split_first() else {
                continue;
            };
            let way = *known.entry(*own).or_insert_with(|| {
                ways.push(way(suite.source(*id).1));
                ways.len() - 1
            });
            let others = others.iter().map(|&other| &suite.modules()[other]);
            judges.push(Judge {
                case: &suite.files()[id.file].cases[id.case],
                seen,
                way,
                others: others.collect(),
                noticed: AtomicU32::new(0),
            });
        }
        Court {
            covered,
            judges,
            ways,
        }
    }

    fn fate(&self, mutant: &Mutant, program: &Program) -> Fate {
        let judges = self.judges.iter();
        let executed: Vec<_> = judges
            .filter(|judge| mutant.is_executed(judge.seen))
            .collect();
        if executed.is_empty() {
            return Fate::NotExecuted;
        }
        let (resolved, diagnostics) = resolve(program, self.covered.model);
        if diagnostics.has_errors() {
            return Fate::Invalid;
        }
        let mut modules = vec![None; self.ways.len()];
        for judge in &executed {
            if modules[judge.way].is_none() {
                let (Some(module), _) = lower(&resolved, &self.ways[judge.way]) else {
                    return Fate::Invalid;
                };
                modules[judge.way] = Some(module);
            }
        }
        let may = executed
            .into_iter()
            .filter(|judge| mutant.may_be_noticed(judge.seen));
        let mut may: Vec<(u32, &Judge)> = may
            .map(|judge| (judge.noticed.load(Ordering::Relaxed), judge))
            .collect();
        may.sort_by_key(|(noticed, _)| std::cmp::Reverse(*noticed));
        let mut engines: Vec<Option<Interpreter>> = modules.iter().map(|_| None).collect();
        for (_, judge) in may {
            let Some(module) = &modules[judge.way] else {
                continue;
            };
            if judge.is_noticed(module, &mut engines[judge.way]) {
                judge.noticed.fetch_add(1, Ordering::Relaxed);
                return Fate::Noticed;
            }
        }
        Fate::Survived
    }
}

impl Judge<'_> {
    /// Returns true if the case fails with the program of its PLC changed. `engine` is kept for cases that have no
    /// other PLC.
    fn is_noticed<'m>(&self, module: &'m Module, engine: &mut Option<Interpreter<'m>>) -> bool {
        if self.others.is_empty() {
            let engine = engine.get_or_insert_with(|| Interpreter::new([module]));
            return run_steps(engine, self.case, &[(0, module)]).is_err();
        }
        let all: Vec<&Module> = [module].into_iter().chain(self.others.clone()).collect();
        let plcs: Vec<(usize, &Module)> = (0..).zip(all.iter().copied()).collect();
        run_steps(&mut Interpreter::new(all), self.case, &plcs).is_err()
    }
}

/// Options for lowering a changed program. Its structure is that of the program, which was checked.
fn way(options: CompileOptions) -> LowerOptions {
    LowerOptions {
        name: options.name,
        wanted: Wanted {
            observe: options.observe,
            observe_all: options.observe_all,
            ports: options.ports,
            without_qlink: false,
        },
        bounds: options.bounds,
        variant: options.variant,
    }
}
