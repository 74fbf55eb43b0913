//! `--deep`: what can never happen in a program, though it is written as if it could.

use crate::commands::counted;
use crate::commands::properties::ExternalWrites;
use crate::commands::subject::Subject;
use crate::commands::verify::report::{assumptions, changes};
use rungc_catalogue::{Basic, Drive, Lower};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Expr, ExprId};
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_rt::CmpOp;
use rungc_sim::Target;
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Instr, OperandKind, Program};
use rungc_verify::deep::{Evidence, Finding, Kind, look, world};
use rungc_verify::property::{Condition, Property};
use rungc_verify::replay::story;
use std::time::Duration;

/// Time limit for a program.
const TIME: Duration = Duration::from_secs(20);

/// Maximum number of devices that a finding names.
const SHOWN: usize = 6;

/// Findings in a program.
#[derive(Default)]
pub struct Found {
    pub diagnostics: Diagnostics,
    /// Number of open questions.
    pub open: usize,
    /// Assumptions of the proofs, if something is proved.
    pub assumptions: Vec<String>,
}

/// Searches a program that compiles.
pub fn findings(subject: &Subject, read: &Read, checked: &Compiled) -> Found {
    let mut found = Found::default();
    let options = CompileOptions {
        optimise: false,
        ..subject.options()
    };
    let Some(mut module) = compile(&read.program, &options).module else {
        return found;
    };
    simplify(&mut module);
    let external = ExternalWrites::of(None, subject.own_project());
    let world = world(external.devices.keys().copied().collect());
    let report = look(&module, world.clone(), TIME);
    let place = Place {
        program: &read.program,
        steps: &checked.step_numbers,
        module: &module,
    };
    let mut seen = Vec::new();
    for finding in &report.findings {
        if let Some(diagnostic) = place.diagnostic(finding)
            && !seen.contains(&diagnostic.span)
        {
            seen.push(diagnostic.span);
            found.diagnostics.push(diagnostic);
            if found.assumptions.is_empty() && !matches!(finding.evidence, Evidence::Trace(_)) {
                found.assumptions = assumptions(&world, &[], &external);
            }
        }
    }
    found.open = report.open;
    found
}

/// Returns true if an instruction writes a device as its first operand, such as a coil.
pub fn writes(instr: &Instr, device: Device) -> bool {
    let found = rungc_catalogue::find(&instr.mnemonic);
    let reads = found.is_some_and(|found| {
        found.inst.drive == Drive::Logic || found.inst.basic() == Some(Basic::Stl)
    });
    let first = instr
        .operands
        .first()
        .and_then(|operand| operand.kind.device());
    !reads && first == Some(device)
}

/// Positions of findings in the source.
struct Place<'a> {
    program: &'a Program,
    /// The step of each instruction.
    steps: &'a [u32],
    module: &'a Module,
}

impl Place<'_> {
    /// The instructions of a network.
    fn instrs(&self, network: u32) -> impl Iterator<Item = &Instr> {
        let networks = &self.module.networks;
        let step = |n: usize| networks.get(n).map(|network| network.step);
        let first = step(network as usize).unwrap_or(0);
        let end = step(network as usize + 1).unwrap_or(u32::MAX);
        let instrs = self.program.instrs.iter().zip(self.steps);
        instrs
            .filter(move |(_, step)| (first..end).contains(*step))
            .map(|(instr, _)| instr)
    }

    /// Returns true if a network depends on relays that are always on or off: then it was intended. A bit of a word may
    /// be one that a panel sets beside those that the program writes.
    fn is_meant(&self, network: u32) -> bool {
        self.instrs(network).any(|instr| {
            let word_bit = |kind: &OperandKind| matches!(kind, OperandKind::WordBit(..));
            if instr.operands.iter().any(|operand| word_bit(&operand.kind)) {
                return true;
            }
            let constant = |device: Device| {
                device.class == DeviceClass::M && (8000..8002).contains(&device.number)
            };
            instr
                .operands
                .iter()
                .filter_map(|operand| operand.kind.device())
                .any(constant)
        })
    }

    /// Returns true if a step ladder has this step.
    fn is_step(&self, device: Device) -> bool {
        self.program.instrs.iter().any(|instr| {
            let first = instr
                .operands
                .first()
                .and_then(|operand| operand.kind.device());
            let found = rungc_catalogue::find(&instr.mnemonic);
            let basic = found.and_then(|found| found.inst.basic());
            basic == Some(Basic::Stl) && first == Some(device)
        })
    }

    fn diagnostic(&self, finding: &Finding) -> Option<Diagnostic> {
        let device = finding
            .device
            .map(|(class, number)| Device { class, number });
        if self.is_meant(finding.network) && !matches!(finding.kind, Kind::Oscillates) {
            return None;
        }
        let writes = |instr: &&Instr| device.is_some_and(|device| writes(instr, device));
        let is_driven = |instr: &&Instr| {
            let found = rungc_catalogue::find(&instr.mnemonic);
            found.is_some_and(|found| found.inst.drive == Drive::Contact)
        };
        let name = device.map(|device| device.to_string()).unwrap_or_default();
        let (code, instr, text): (&Code, _, _) = match &finding.kind {
            Kind::NeverOn => (
                &codes::NEVER_ON,
                self.instrs(finding.network).find(writes)?,
                format!("`{name}` can never be on"),
            ),
            Kind::NeverReached => (
                &codes::STATE_UNREACHABLE,
                self.instrs(finding.network).find(writes)?,
                format!("step `{name}` can never be reached"),
            ),
            // As a relay, a step may stay on.
            Kind::NeverLeft if !self.is_step(device?) => return None,
            Kind::NeverLeft => (
                &codes::STATE_ENDLESS,
                self.instrs(finding.network).find(writes)?,
                format!("once step `{name}` is on, it stays on"),
            ),
            Kind::NeverExpires => (
                &codes::TIMER_NEVER_EXPIRES,
                self.instrs(finding.network).find(writes)?,
                format!("`{name}` runs but can never expire"),
            ),
            Kind::Oscillates => (
                &codes::OUTPUT_OSCILLATES,
                self.instrs(finding.network).find(writes)?,
                format!("`{name}` can change in every scan while no input does"),
            ),
            Kind::NeverActs => (
                &codes::RUNG_NEVER_ACTS,
                self.instrs(finding.network).find(is_driven)?,
                "this rung can never do anything: its contacts never conduct".to_string(),
            ),
            Kind::Constant { op, sides, result } => {
                let instr = self.comparison(finding.network, *op, sides)?;
                let always = if *result { "true" } else { "false" };
                (
                    &codes::COMPARISON_CONSTANT,
                    instr,
                    format!("this comparison is always {always}"),
                )
            }
        };
        let mut diagnostic = code.at(instr.span, text);
        diagnostic.help = Some(self.evidence(finding, &name).into());
        Some(diagnostic)
    }

    /// The contact of the source that compares these numbers, if it does nothing else.
    fn comparison(&self, network: u32, op: CmpOp, sides: &[ExprId; 2]) -> Option<&Instr> {
        let model = self.module.model.id;
        self.instrs(network).find(|instr| {
            let found = rungc_catalogue::find(&instr.mnemonic);
            let compares = found.is_some_and(
                |found| matches!(found.inst.lower_on_model(model), Lower::Compare(_, own) if own == op),
            );
            let operands = instr.operands.iter().zip(sides);
            compares
                && instr.operands.len() == 2
                && operands.clone().all(|(o, side)| self.is(&o.kind, *side))
        })
    }

    /// Returns true if an operand of the source is this value.
    fn is(&self, operand: &OperandKind, side: ExprId) -> bool {
        match *self.module.expr(side) {
            Expr::Widen(inner) => self.is(operand, inner),
            Expr::I16(value) => operand.constant() == Some(value.into()),
            Expr::I32(value) => operand.constant() == Some(value.into()),
            Expr::Read(access) => {
                let plain = matches!(access.kind, AccessKind::Word | AccessKind::Pair);
                let device = Device {
                    class: access.place.class,
                    number: access.place.number,
                };
                plain && access.place.index.is_none() && operand.device() == Some(device)
            }
            _ => false,
        }
    }

    /// Description of the evidence, with the devices that only the program may write.
    fn evidence(&self, finding: &Finding, name: &str) -> String {
        let mut text = self.grounds(finding, name);
        let names = finding.untouched.iter();
        let names: Vec<_> = names
            .map(|(class, n)| class.number(*n).to_string())
            .collect();
        let more = match names.len().checked_sub(SHOWN) {
            None | Some(0) => String::new(),
            Some(more) => format!(" and {more} more"),
        };
        let shown = &names[..names.len().min(SHOWN)];
        if let Some(first) = shown.first() {
            text += &format!(
                ", if only the program writes {}{more}; what a panel writes belongs in rungc.toml: \
                 `[hmi] writes = \"{first}\"`",
                shown.join(", ")
            );
        }
        text
    }

    fn grounds(&self, finding: &Finding, name: &str) -> String {
        match &finding.evidence {
            Evidence::Induction(1) => {
                "proved: no scan can do it, whatever the inputs are".to_string()
            }
            Evidence::Induction(scans) => {
                format!("proved by induction over {}", counted(*scans, "scan"))
            }
            Evidence::Invariant(clauses) => {
                format!(
                    "proved by an invariant of {}, which another run of the solver confirms",
                    counted(*clauses, "clause")
                )
            }
            Evidence::Trace(trace) => {
                let Ok(target) = Target::parse(name) else {
                    return String::new();
                };
                let property = Property::Never(Condition::On(target));
                let changes = changes(self.module, &story(self.module, &property, trace));
                format!("seen on the interpreter: {changes}")
            }
        }
    }
}
