//! A program as an editor sees it: what stands at a place of its text, and where its devices are used.
//!
//! Places are bytes of [`Program::source`](rungc_syntax::Program::source). An instruction that the settings add to the
//! program, such as a row of the Modbus table, has the place of its end.

mod facts;
mod hints;
mod outline;
mod proposals;
mod rename;

pub use facts::describe;
pub use hints::{Token, TokenKind};
pub use outline::{Outline, OutlineKind};
pub use proposals::{Proposals, Proposed, ProposedKind, Signature};
pub use rename::Renaming;

use crate::Project;
use rungc_analysis::resolve::{Resolution, resolve};
use rungc_analysis::xref::{CrossReference, Reach, Use, UseKind};
use rungc_catalogue::Role;
use rungc_frontend::print::lay_out;
use rungc_ladder::build;
use rungc_models::Model;
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind, Program, Span};
use std::ops::Range;

/// The index of a program.
#[derive(Debug)]
pub struct Index {
    project: Project,
    resolutions: Vec<Resolution>,
    /// In the order of the program.
    uses: Vec<Use>,
    /// Instructions of each network.
    networks: Vec<Range<usize>>,
}

/// Something in the text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Place {
    /// Its bytes.
    pub span: Span,
    /// What it is.
    pub what: What,
}

/// Kinds of places.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum What {
    /// The mnemonic of this instruction.
    Mnemonic(usize),
    /// An operand of this instruction, by its position.
    Operand(usize, usize),
    /// The device that a comment is about.
    Comment(Device),
}

/// A place that names a device, or devices that include it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Occurrence {
    /// The operand, the label, or the whole instruction.
    pub span: Span,
    /// The instruction; `None`: it is in the line of its comment.
    pub instr: Option<usize>,
    /// The operand, if it is one.
    pub operand: Option<usize>,
    /// Kind of use; `None` in the line of its comment.
    pub kind: Option<UseKind>,
    /// First device.
    pub first: Device,
    /// Number of devices from there on; `None` if that is only known when the program runs.
    pub count: Option<u32>,
}

impl Occurrence {
    /// Returns true if the program changes the device there, or is the place where a label stands.
    pub fn is_definition(&self) -> bool {
        use UseKind::{Change, Coil, Label, Set, Write};
        matches!(self.kind, Some(Coil | Set | Write | Change | Label))
    }

    /// Returns true if the device is changed there.
    pub fn is_write(&self) -> bool {
        self.is_definition() || self.kind == Some(UseKind::Reset)
    }
}

impl Index {
    /// Makes the index of a program.
    pub fn new(project: &Project) -> Self {
        let (resolved, _) = resolve(project.source(), project.model());
        let ladder = build::ladder(&resolved);
        Index {
            project: project.clone(),
            uses: CrossReference::new(&resolved).uses,
            networks: ladder.networks.into_iter().map(|one| one.instrs).collect(),
            resolutions: resolved.instrs,
        }
    }

    /// The project.
    pub fn project(&self) -> &Project {
        &self.project
    }

    fn program(&self) -> &Program {
        self.project.source()
    }

    fn model(&self) -> &'static Model {
        self.project.model()
    }

    /// The instructions that the text holds, with their positions: not those that settings add, nor those that a list
    /// of windows implies.
    fn written(&self) -> impl Iterator<Item = (usize, &Instr)> {
        let all = self.program().instrs.iter().enumerate();
        all.filter(move |(i, instr)| !instr.span.range().is_empty() && !self.is_added(*i))
    }

    /// Returns true if settings add an instruction to the program.
    fn is_added(&self, i: usize) -> bool {
        let instrs = &self.program().instrs;
        let (one, next) = (instrs.get(i), instrs.get(i + 1));
        one.zip(next)
            .is_some_and(|(one, next)| one.span == next.span && !one.span.range().is_empty())
    }

    /// What stands at a byte of the text, or ends there.
    pub fn at(&self, offset: u32) -> Option<Place> {
        let holds = |span: Span| (span.start..=span.end).contains(&offset);
        let comments = self.program().comment_spans.iter();
        let comment = comments
            .map(|(device, span)| Place {
                span: *span,
                what: What::Comment(*device),
            })
            .find(|place| holds(place.span));
        let in_instr = |(i, instr): (usize, &Instr)| {
            let operands = instr.operands.iter().enumerate();
            let operand =
                operands
                    .filter(|(_, operand)| holds(operand.span))
                    .map(|(n, operand)| Place {
                        span: operand.span,
                        what: What::Operand(i, n),
                    });
            let mnemonic = holds(instr.mnemonic_span).then_some(Place {
                span: instr.mnemonic_span,
                what: What::Mnemonic(i),
            });
            mnemonic.into_iter().chain(operand).last()
        };
        comment.or_else(|| self.written().filter_map(in_instr).last())
    }

    /// The instructions that begin between two bytes, or at the first.
    pub fn instrs_in(&self, span: Span) -> impl Iterator<Item = (usize, &Instr)> {
        let is_in = move |instr: &Instr| (span.start..=span.end).contains(&instr.span.start);
        self.written().filter(move |(_, instr)| is_in(instr))
    }

    /// The device that a place names, without its index.
    pub fn device(&self, what: What) -> Option<Device> {
        match what {
            What::Comment(device) => Some(device),
            What::Mnemonic(i) => self.resolutions.get(i)?.label,
            What::Operand(i, n) => named(&self.program().instrs.get(i)?.operands.get(n)?.kind),
        }
    }

    /// The places that name a device, or devices that include it, in the order of the text.
    pub fn occurrences(&self, device: Device) -> Vec<Occurrence> {
        let concerns = |one: &&Use| {
            let numbers = one.first.number..one.end();
            one.first.class == device.class && numbers.contains(&device.number)
        };
        let uses = self.uses.iter().filter(concerns);
        let mut all: Vec<_> = uses.flat_map(|one| self.places(one)).collect();
        let comment = self.program().comment_spans.get(&device);
        all.extend(comment.map(|span| Occurrence {
            span: *span,
            instr: None,
            operand: None,
            kind: None,
            first: device,
            count: Some(1),
        }));
        all.sort_by_key(|one| (one.span, one.operand));
        all.dedup_by_key(|one| (one.span, one.operand, one.instr));
        all
    }

    /// The operands of a use: those that name its first device and play its role.
    fn places(&self, one: &Use) -> Vec<Occurrence> {
        let instr = &self.program().instrs[one.instr];
        let occurrence = |span, operand| Occurrence {
            span,
            instr: Some(one.instr),
            operand,
            kind: Some(one.kind),
            first: one.first,
            count: match one.reach {
                Reach::Count(count) => Some(count.max(1)),
                Reach::Open | Reach::Indexed => None,
            },
        };
        if one.kind == UseKind::Label {
            return vec![occurrence(instr.mnemonic_span, None)];
        }
        let params = self.resolutions[one.instr].params;
        let names =
            |kind: &OperandKind| named(kind) == Some(one.first) || index(kind) == Some(one.first);
        let operands = instr.operands.iter().enumerate();
        let naming: Vec<_> = operands
            .filter(|(_, operand)| names(&operand.kind))
            .collect();
        let plays = |n: usize| {
            let role = params.get(n).map(|param| param.role);
            role.is_none_or(|role| role == self::role(one.kind))
        };
        let playing = naming.iter().filter(|(n, _)| plays(*n)).count();
        let places: Vec<_> = naming
            .iter()
            .filter(|(n, _)| playing == 0 || plays(*n))
            .map(|(n, operand)| occurrence(operand.span, Some(*n)))
            .collect();
        match places.is_empty() {
            true => vec![occurrence(instr.span, None)],
            false => places,
        }
    }

    /// The places where a device gets its value: labels, coils and what else writes it; or else its comment's line.
    pub fn definitions(&self, device: Device) -> Vec<Span> {
        let all = self.occurrences(device);
        let spans = |is_wanted: fn(&Occurrence) -> bool| -> Vec<Span> {
            let wanted = all.iter().filter(|one| is_wanted(one));
            wanted.map(|one| one.span).collect()
        };
        let defined = spans(Occurrence::is_definition);
        match defined.is_empty() {
            true => spans(|one| one.kind.is_none()),
            false => defined,
        }
    }

    /// The comment of a device, in one line.
    pub fn comment(&self, device: Device) -> Option<String> {
        let comment = self.program().comments.get(&device)?;
        Some(comment.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    /// An instruction list as `rungc fmt` lays it out.
    ///
    /// # Errors
    /// The line of the first error that keeps it from being read whole.
    pub fn laid_out(&self) -> Result<String, u32> {
        let source = &self.program().source;
        let read = rungc_frontend::read_text(&source.name, &source.text);
        let errors = read.diagnostics.iter();
        let mut errors = errors.filter(|found| found.severity == crate::Severity::Error);
        match errors.next() {
            Some(error) => Err(source.line(error.span.start)),
            None => Ok(lay_out(&read.program).text),
        }
    }

    /// The page of an instruction for the program's PLC, as `rungc explain` prints it.
    pub fn instruction(&self, i: usize) -> Option<String> {
        let mnemonic = &self.program().instrs.get(i)?.mnemonic;
        let plc = self.project.plc();
        rungc_catalogue::explain_on(mnemonic, plc).or_else(|| rungc_catalogue::explain(mnemonic))
    }
}

/// The role of an operand that a use makes of it.
fn role(kind: UseKind) -> Role {
    match kind {
        UseKind::Contact | UseKind::Read | UseKind::Jump | UseKind::Level | UseKind::Unclear => {
            Role::Read
        }
        UseKind::Coil | UseKind::Set | UseKind::Reset | UseKind::Write | UseKind::Label => {
            Role::Write
        }
        UseKind::Change => Role::ReadWrite,
    }
}

/// The device that an operand names, without its index.
fn named(kind: &OperandKind) -> Option<Device> {
    match *kind {
        OperandKind::Device(device, _)
        | OperandKind::Nibbles(_, device, _)
        | OperandKind::WordBit(device, ..) => Some(device),
        _ => None,
    }
}

/// The index register of an operand.
fn index(kind: &OperandKind) -> Option<Device> {
    let (OperandKind::Device(_, index)
    | OperandKind::Nibbles(_, _, index)
    | OperandKind::WordBit(_, _, index)
    | OperandKind::Decimal(_, index)
    | OperandKind::Hex(_, index)
    | OperandKind::Buffer { index, .. }) = kind
    else {
        return None;
    };
    index.map(|index| Device {
        class: index.class,
        number: index.number,
    })
}

/// A title of a class.
fn class_title(class: DeviceClass) -> &'static str {
    match class {
        DeviceClass::X => "input",
        DeviceClass::Y => "output",
        DeviceClass::M => "auxiliary relay",
        DeviceClass::S => "state",
        DeviceClass::T => "timer",
        DeviceClass::C => "counter",
        DeviceClass::D => "data register",
        DeviceClass::R => "extension register",
        DeviceClass::ER => "extension file register",
        DeviceClass::V | DeviceClass::Z => "index register",
        DeviceClass::P => "pointer",
        DeviceClass::I => "interrupt pointer",
        DeviceClass::N => "nesting level",
    }
}
