//! `--deep`: what can never happen in a program, though it is written as if it could.

mod causes;

use crate::commands::counted;
use crate::commands::properties::ExternalWrites;
use crate::commands::subject::Subject;
use crate::commands::verify::report::{assumptions, changes};
use causes::Contacts;
use rungc_catalogue::{Basic, Drive, Lower, Role};
use rungc_frontend::Read;
use rungc_ir::Module;
use rungc_ir::node::{AccessKind, Expr, ExprId};
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, Compiled, compile, open_indexes};
use rungc_models::Model;
use rungc_rt::CmpOp;
use rungc_sim::Target;
use rungc_sim::property::{Condition, Property};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Diagnostics, Instr, Label, OperandKind, Program,
};
use rungc_verify::deep::{Evidence, Finding, Kind, look, world};
use rungc_verify::replay::story;
use std::collections::BTreeSet;

/// Limit of the effort for a program.
const EFFORT: u64 = 20_000;

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
    let external = ExternalWrites::of(None, subject.own_project());
    let mut options = CompileOptions {
        optimise: false,
        ..subject.options()
    };
    let indexes = open_indexes(&read.program, &options, |device| {
        external.devices.contains_key(&device)
    });
    options.observe.extend(indexes);
    let Some(mut module) = compile(&read.program, &options).module else {
        return found;
    };
    simplify(&mut module);
    let place = Place {
        program: &read.program,
        steps: &checked.step_numbers,
        module: &module,
        contacts: causes::contacts(&read.program, &checked.step_numbers, &module),
    };
    // A client might set a step, too.
    let steps = place.steps_of_ladders().filter(|_| !external.has_clients);
    let steps = steps.map(|step| (step.class, step.number));
    let world = world(external.devices.keys().copied().collect(), steps.collect());
    let report = look(&module, world.clone(), EFFORT);
    let mut placed: Vec<Placed> = report
        .findings
        .iter()
        .filter_map(|finding| place.placed(finding))
        .collect();
    place.leave_out_intended(&mut placed);
    let mut seen = BTreeSet::new();
    placed.retain(|placed| seen.insert(placed.instr.span));
    for (first, others) in place.by_cause(&placed) {
        if found.assumptions.is_empty() && !matches!(first.finding.evidence, Evidence::Trace(_)) {
            found.assumptions = assumptions(&world, &[], &external);
        }
        found.diagnostics.push(place.diagnostic(first, &others));
    }
    found.open = report.open;
    found
}

/// Returns true if an instruction writes a device as its first operand, such as a coil.
fn writes(instr: &Instr, device: Device, model: &Model) -> bool {
    let Some(found) = rungc_catalogue::find(&instr.mnemonic) else {
        return false;
    };
    if found.inst.drive == Drive::Logic || found.inst.basic() == Some(Basic::Stl) {
        return false;
    }
    let params = found.inst.params_of(&instr.operands, model);
    let first = instr.operands.first().zip(params.first());
    first.is_some_and(|(operand, param)| {
        param.role != Role::Read && operand.kind.device() == Some(device)
    })
}

/// Returns true if an instruction only switches off what it writes.
fn clears(instr: &Instr) -> bool {
    let found = rungc_catalogue::find(&instr.mnemonic);
    found.is_some_and(|found| found.inst.basic() == Some(Basic::Rst) || found.inst.name == "ZRST")
}

/// Returns true if an instruction writes the result of its contacts, whatever it is.
fn is_coil(instr: &Instr) -> bool {
    let coils = [Basic::Out, Basic::Pls, Basic::Plf, Basic::Mc];
    basic(instr).is_some_and(|basic| coils.contains(&basic))
}

fn basic(instr: &Instr) -> Option<Basic> {
    rungc_catalogue::find(&instr.mnemonic).and_then(|found| found.inst.basic())
}

/// A finding with its place.
struct Placed<'a> {
    finding: &'a Finding,
    /// The device that it is about.
    device: Option<Device>,
    instr: &'a Instr,
    /// The network of the instruction, by number in the module.
    network: u32,
    /// True if there are coils in the network.
    has_coils: bool,
}

impl Placed<'_> {
    fn name(&self) -> String {
        self.device
            .map(|device| device.to_string())
            .unwrap_or_default()
    }

    fn code(&self) -> &'static Code {
        match self.finding.kind {
            Kind::NeverOn => &codes::NEVER_ON,
            Kind::NeverReached => &codes::STATE_UNREACHABLE,
            Kind::NeverLeft => &codes::STATE_ENDLESS,
            Kind::NeverExpires => &codes::TIMER_NEVER_EXPIRES,
            Kind::Oscillates => &codes::OUTPUT_OSCILLATES,
            Kind::NeverActs => &codes::RUNG_NEVER_ACTS,
            Kind::Constant { .. } => &codes::COMPARISON_CONSTANT,
        }
    }

    fn text(&self) -> String {
        let name = self.name();
        match self.finding.kind {
            Kind::NeverOn => format!("`{name}` can never be on"),
            Kind::NeverReached => format!("step `{name}` can never be reached"),
            Kind::NeverLeft => format!("once step `{name}` is on, it stays on"),
            Kind::NeverExpires => format!("`{name}` runs but can never expire"),
            Kind::Oscillates => {
                format!("`{name}` can change in every scan while no input does")
            }
            Kind::NeverActs if self.has_coils => {
                let mnemonic = &self.instr.mnemonic;
                format!("`{mnemonic}` can never be executed: its contacts never conduct")
            }
            Kind::NeverActs => {
                "this rung can never do anything: its contacts never conduct".to_string()
            }
            Kind::Constant { result, .. } => format!("this comparison is always {result}"),
        }
    }
}

/// Positions of findings in the source.
struct Place<'a> {
    program: &'a Program,
    /// The step of each instruction.
    steps: &'a [u32],
    module: &'a Module,
    /// The contacts of each network.
    contacts: Vec<Contacts>,
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

    /// The number of the network that an instruction is in.
    fn network_of(&self, instr: &Instr) -> u32 {
        let mut instrs = self.program.instrs.iter().zip(self.steps);
        let step = instrs.find(|(other, _)| std::ptr::eq(*other, instr));
        self.network_at(step.map_or(0, |(_, step)| *step))
    }

    /// The number of the network that a step is in.
    fn network_at(&self, step: u32) -> u32 {
        let networks = &self.module.networks;
        let begun = networks.partition_point(|network| network.step <= step);
        begun.saturating_sub(1) as u32
    }

    /// The steps of step ladders.
    fn steps_of_ladders(&self) -> impl Iterator<Item = Device> {
        let steps = self.program.instrs.iter();
        let steps = steps.filter(|instr| basic(instr) == Some(Basic::Stl));
        steps.filter_map(|instr| instr.operands.first()?.kind.device())
    }

    /// A finding with the instruction that it is about, if it is one to report.
    fn placed<'f>(&'f self, finding: &'f Finding) -> Option<Placed<'f>> {
        let device = finding
            .device
            .map(|(class, number)| Device { class, number });
        let model = self.module.model;
        let writes = |instr: &&Instr| device.is_some_and(|device| writes(instr, device, model));
        let is_driven = |instr: &&Instr| {
            let found = rungc_catalogue::find(&instr.mnemonic);
            found.is_some_and(|found| found.inst.drive == Drive::Contact)
        };
        let mut here = self.instrs(finding.network);
        let instr = match &finding.kind {
            Kind::NeverOn | Kind::NeverReached => {
                let all = here.chain(&self.program.instrs);
                let mut setting = all.filter(writes).filter(|instr| !clears(instr));
                let first = setting.next()?;
                let mut others = std::iter::once(first).chain(setting);
                let unintended = others.find(|instr| !self.is_meant(self.network_of(instr)));
                unintended.unwrap_or(first)
            }
            // As a relay, a step may stay on.
            Kind::NeverLeft => {
                let step = device?;
                self.steps_of_ladders().find(|other| *other == step)?;
                here.find(writes)?
            }
            Kind::NeverExpires | Kind::Oscillates => here.find(writes)?,
            Kind::NeverActs => here.filter(is_driven).find(|instr| !is_coil(instr))?,
            Kind::Constant { op, sides, .. } => {
                drop(here);
                self.comparison(finding.network, *op, sides)?
            }
        };
        let network = self.network_of(instr);
        Some(Placed {
            finding,
            device,
            instr,
            network,
            has_coils: self.instrs(network).any(is_coil),
        })
    }

    fn diagnostic(&self, placed: &Placed, others: &[&Placed]) -> Diagnostic {
        let finding = placed.finding;
        let mut diagnostic = placed.code().at(placed.instr.span, placed.text());
        diagnostic.help = Some(self.evidence(finding, &placed.name()).into());
        diagnostic.others = others
            .iter()
            .map(|other| Label {
                span: other.instr.span,
                text: match other.finding.kind {
                    Kind::Constant { .. } => other.text().into(),
                    _ => format!("{}, too", other.text()).into(),
                },
            })
            .collect();
        if finding.untouched.len() > SHOWN {
            let devices = finding.untouched.iter();
            diagnostic.devices = devices
                .map(|&(class, number)| Device { class, number })
                .collect();
        }
        diagnostic
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
        if !shown.is_empty() {
            text += &format!(", if only the program writes {}{more}", shown.join(", "));
        }
        let panel = finding.possible_with.iter();
        let panel: Vec<_> = panel
            .map(|(class, n)| format!("\"{}\"", class.number(*n)))
            .collect();
        let panel = match panel.as_slice() {
            [] => return text,
            [only] => only.clone(),
            several => format!("[{}]", several.join(", ")),
        };
        text + &format!("; what a panel writes belongs in rungc.toml: `[hmi] writes = {panel}`")
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
