//! Looks at a program as a whole: contact logic, structure, labels, interrupts, and what hurts in practice.
//!
//! Each file is one concept and walks the program once, so that checking stays linear in its length. `structure` finds
//! where each instruction is (routine, loop, state); what jumps, calls and warns builds on that.

mod blocks;
mod calls;
mod coils;
pub mod devices;
mod doubtful;
mod drives;
mod every_scan;
mod fast_inputs;
mod fast_units;
mod groups;
mod idle_counters;
mod indexed_counters;
mod inert;
mod jumped_over;
mod labels;
mod modules;
mod never_requested;
mod once;
mod one_output;
mod operation_errors;
mod overlaps;
mod pairs;
mod parallel;
mod pointers;
pub mod ports;
mod reserved;
mod resets;
mod set_and_out;
mod set_and_word;
mod short_drives;
mod skips;
mod states;
mod structure;
mod timers;
mod undefined;
pub mod unimplemented;
mod unreachable;
mod unused;
pub mod variants;
mod writes;

use crate::accesses::{self, Access};
use crate::resolve::{Resolved, numbered};
use rungc_catalogue::{Basic, Drive, Inst, Join, Lower, Param, Role};
use rungc_models::Model;
use rungc_rt::RtFn;
use rungc_syntax::{
    Classes, Device, DeviceClass, Diagnostics, Fix, Instr, OperandKind, Span, codes,
};

use std::cell::OnceCell;
use std::iter::{Copied, Peekable};
use std::slice::Iter;

/// Checks the structure of a program, and warns of what is legal but hurts.
pub fn check(resolved: &Resolved) -> Diagnostics {
    let mut out = Diagnostics::new();
    let code = Code::new(resolved);
    code.end(&mut out);
    blocks::check(&code, &mut out);
    let pointers = pointers::Pointers::new(&code);
    let nesting = structure::check(&code, &pointers, &mut out);
    labels::check(&code, &pointers, &nesting, &mut out);
    fast_inputs::check(&code, &pointers, &mut out);
    never_requested::check(&code, &pointers, &mut out);
    once::check(&code, &mut out);
    ports::check(&code, &mut out);
    unimplemented::check(&code, &mut out);
    unreachable::check(&code, &nesting, &mut out);
    let skips = skips::Skips::new(&code, &pointers);
    let calls = calls::Calls::new(&code, &pointers, &nesting, &skips);
    let places = coils::Where {
        skips: &skips,
        nesting: &nesting,
        calls: &calls,
    };
    coils::check(&code, places, &mut out);
    set_and_out::check(&code, &nesting, &skips, &mut out);
    set_and_word::check(&code, places, &mut out);
    timers::check(&code, &nesting, &calls, &mut out);
    states::check(&code, &nesting, &mut out);
    driven(&code, &pointers, &nesting, &skips, &mut out);
    accessed(&code, &mut out);
    numbered(out, resolved.model)
}

/// Checks of instructions together with their drives.
fn driven(
    code: &Code,
    pointers: &pointers::Pointers,
    nesting: &structure::Nesting,
    skips: &skips::Skips,
    out: &mut Diagnostics,
) {
    let pulses = short_drives::pulses(code, nesting, skips);
    let mut drives = drives::Drives::with_pulses(pulses);
    let mut every_scan = every_scan::EveryScan::default();
    let mut outputs = one_output::Outputs::default();
    let mut jumped_over = jumped_over::JumpedOver::default();
    for i in 0..code.len {
        if let Some(drive) = drives.next(code, i) {
            every_scan.note(code, i, drive, nesting, skips);
            outputs.note(code, i, drive, nesting, skips);
            short_drives::check(code, i, drive, (nesting, skips), out);
            jumped_over.note(code, i, drive, (pointers, nesting), out);
        }
    }
    every_scan.report(code, out);
    outputs.report(code, out);
}

/// Checks of the devices and the buffer memory that instructions read and write.
fn accessed(code: &Code, out: &mut Diagnostics) {
    let roles = ports::Roles::new(code);
    let mut unused = unused::Unused::new(code, &roles);
    let mut pairs = pairs::Pairs::default();
    let (mut overlaps, mut resets) = (overlaps::Overlaps::default(), resets::Resets::new(code));
    let modules = modules::Modules::new(code);
    let mut inert = inert::Inert::new(code, &modules, &roles);
    let mut doubtful = doubtful::Doubtful::default();
    let mut undefined = undefined::Undefined::default();
    let mut reserved = reserved::Reserved::default();
    let mut idle_counters = idle_counters::IdleCounters::default();
    for i in 0..code.len {
        unused.note_broken(i);
        for access in code.accesses(i) {
            unused.note(i, &access);
            resets.note(code, i, &access);
        }
        // What is wrong with its operands was reported as an error.
        if code.resolved.instrs[i].wrong {
            continue;
        }
        modules.check(code, i, out);
        operation_errors::check(code, i, out);
        groups::check(code, i, out);
        indexed_counters::check(code, i, out);
        writes::check(code, i, &roles, out);
        for access in code.accesses(i) {
            pairs.note(&access);
            overlaps.note(code, i, &access);
            inert.note(code, i, &access);
            doubtful.note(code, &access);
            undefined.note(code, i, &access);
            reserved.note(code, i, &access);
            idle_counters.note(code, i, &access);
        }
    }
    unused.report(out);
    pairs.report(out);
    overlaps.report(code, out);
    if code.is_understood() {
        resets.report(code.model(), out);
    }
    inert.report(out);
    doubtful.report(code, out);
    undefined.report(code.model(), out);
    reserved.report(code, out);
    idle_counters.report(code, out);
}

/// The part of a program that is run: up to and with its first END.
struct Code<'a> {
    resolved: &'a Resolved<'a>,
    /// Number of these instructions.
    len: usize,
    /// True if BMOV may go backwards.
    reverses: OnceCell<bool>,
    /// What the program writes to the devices of its ports.
    facts: OnceCell<ports::Facts>,
}

impl<'a> Code<'a> {
    fn new(resolved: &'a Resolved<'a>) -> Self {
        let end = resolved
            .instrs
            .iter()
            .position(|instr| instr.basic() == Some(Basic::End));
        let len = end.map_or(resolved.instrs.len(), |end| end + 1);
        Code {
            resolved,
            len,
            reverses: OnceCell::new(),
            facts: OnceCell::new(),
        }
    }

    /// What the program writes to the devices of its ports.
    fn facts(&self) -> &ports::Facts {
        self.facts.get_or_init(|| ports::Facts::new(self))
    }

    fn model(&self) -> &'static Model {
        self.resolved.model
    }

    fn inst(&self, i: usize) -> Option<&'static Inst> {
        self.resolved.instrs[i].inst
    }

    fn instr(&self, i: usize) -> &'a Instr {
        &self.resolved.program.instrs[i]
    }

    fn span(&self, i: usize) -> Span {
        self.instr(i).span
    }

    fn wide(&self, i: usize) -> bool {
        self.resolved.instrs[i].form.wide
    }

    /// For each instruction that could not be read, how many precede it.
    fn unread(&self) -> Peekable<Copied<Iter<'a, u32>>> {
        self.resolved.program.unread.iter().copied().peekable()
    }

    /// The accesses of an instruction.
    fn accesses(&self, i: usize) -> impl Iterator<Item = Access> {
        accesses::of(self.resolved, i).map(move |access| Access {
            role: self.role(i, access.span, access.role),
            ..access
        })
    }

    /// Use of an operand, given by its place, that its row uses in this way. BMOV goes either way, but forwards where
    /// nothing switches M8024 on.
    fn role(&self, i: usize, operand: Span, usual: Role) -> Role {
        let two_way = matches!(self.lower(i), Some(Lower::Call(RtFn::Bmov)));
        if !two_way || usual != Role::ReadWrite {
            return usual;
        }
        if *self.reverses.get_or_init(|| self.may_reverse()) {
            return usual;
        }
        let source = self.instr(i).operands.first().map(|source| source.span);
        match source == Some(operand) {
            true => Role::Read,
            false => Role::Write,
        }
    }

    /// Returns true if something may switch M8024 on.
    fn may_reverse(&self) -> bool {
        const M8024: Device = Device {
            class: DeviceClass::M,
            number: 8024,
        };
        let parameters = self.resolved.program.parameters.as_ref();
        let outside = parameters.map_or(&[][..], |known| &known.written_externally);
        let mut outside = outside.iter().filter(|run| run.class == M8024.class);
        let mut inside = (0..self.len).flat_map(|i| accesses::of(self.resolved, i));
        !self.is_understood()
            || outside.any(|run| (run.first..run.first + run.count).contains(&M8024.number))
            || inside.any(|access| access.writes() && access.devices().contains(&M8024))
    }

    /// The basic instruction that this is, if it is one.
    fn basic(&self, i: usize) -> Option<Basic> {
        self.resolved.instrs[i].basic()
    }

    /// Implementation on the model.
    fn lower(&self, i: usize) -> Option<Lower> {
        self.resolved.instrs[i].lower
    }

    /// The pointer that an instruction defines.
    fn label(&self, i: usize) -> Option<Device> {
        self.resolved.instrs[i].label
    }

    /// The device that operand `n` names without an index register.
    fn device(&self, i: usize, n: usize) -> Option<Device> {
        match self.instr(i).operands.get(n)?.kind {
            OperandKind::Device(device, None) => Some(device),
            _ => None,
        }
    }

    /// Parameters of an instruction.
    fn params(&self, i: usize) -> &'static [Param] {
        self.resolved.instrs[i].params
    }

    /// Returns true if the identity of an instruction was only guessed, for the structure of the program.
    fn is_meant(&self, i: usize) -> bool {
        self.resolved.instrs[i].meant
    }

    /// Returns true if every instruction could be read and is known.
    fn is_understood(&self) -> bool {
        let known = |i: usize| self.inst(i).is_some() && !self.is_meant(i);
        self.resolved.program.is_complete() && (0..self.len).all(known)
    }

    /// The devices that the operands of an instruction name or were meant to name.
    fn devices(&self, i: usize) -> impl Iterator<Item = Device> {
        let operands = self.instr(i).operands.iter();
        operands.filter_map(|operand| match operand.kind {
            OperandKind::Device(device, _)
            | OperandKind::WordBit(device, ..)
            | OperandKind::Nibbles(_, device, _) => Some(device),
            OperandKind::Unreadable(meant) => meant,
            _ => None,
        })
    }

    /// Returns true if the beginning or end of a part of the program may be among the unread code: in a project an
    /// unknown code may be any instruction, while a line of a list without a mnemonic is none.
    fn may_lack_structure(&self) -> bool {
        let program = self.resolved.program;
        !program.kind.is_list() && !program.unread.is_empty()
    }

    /// Returns true if an operand that could not be read may be any device.
    fn lacks_a_device(&self, i: usize) -> bool {
        /// Classes that name no device.
        const CONSTANTS: Classes = Classes::K.or(Classes::H).or(Classes::E).or(Classes::TEXT);
        let operands = self.instr(i).operands.iter().zip(self.params(i));
        operands.clone().any(|(operand, param)| {
            let unknown = matches!(operand.kind, OperandKind::Unreadable(None));
            unknown && param.classes.without(CONSTANTS) != Classes::NONE
        })
    }

    /// Part of an instruction in the contact logic.
    fn part(&self, i: usize) -> Part {
        let Some(inst) = self.inst(i).filter(|_| !self.is_meant(i)) else {
            return Part::Unknown;
        };
        match self.lower(i) {
            Some(Lower::Basic(Basic::Nop)) => Part::Nothing,
            Some(
                Lower::Basic(Basic::Ld | Basic::Ldi | Basic::Ldp | Basic::Ldf)
                | Lower::Compare(Join::Ld, _),
            ) => Part::Start,
            Some(Lower::Basic(Basic::Anb)) => Part::JoinSeries,
            Some(Lower::Basic(Basic::Orb)) => Part::JoinParallel,
            Some(Lower::Basic(Basic::Mps)) => Part::Push,
            Some(Lower::Basic(Basic::Mrd)) => Part::Read,
            Some(Lower::Basic(Basic::Mpp)) => Part::Pop,
            _ => match inst.drive {
                Drive::Logic => Part::Continue,
                Drive::Contact => Part::Output,
                Drive::Alone => Part::Alone,
            },
        }
    }

    /// Returns true if the last operand of an instruction is END, on the same line.
    fn names_end(&self, i: usize) -> bool {
        let last = self.instr(i).operands.last();
        last.is_some_and(|operand| {
            let text = self.resolved.program.source.slice(operand.span);
            matches!(operand.kind, OperandKind::Unreadable(_)) && text.eq_ignore_ascii_case("END")
        })
    }

    /// Checks that there is an END, and nothing after it.
    fn end(&self, out: &mut Diagnostics) {
        let instrs = &self.resolved.program.instrs;
        let unread = self.resolved.program.unread.last();
        if unread.is_some_and(|&before| before as usize >= instrs.len()) {
            // The unreadable part may have been END.
            return;
        }
        let Some(last) = self.len.checked_sub(1) else {
            let empty = codes::NO_END.at(Span::default(), "the program is empty");
            out.push(empty.help("a program contains at least END"));
            return;
        };
        if self.names_end(last) {
            // It follows another instruction on its line, which is reported.
            return;
        }
        if self.basic(last) != Some(Basic::End) {
            let diagnostic = codes::NO_END.at(self.span(last), "the program does not end with END");
            out.push(
                diagnostic
                    .label("the last instruction")
                    .help("add END after it")
                    .fix(self.append_end()),
            );
            return;
        }
        let after = (self.len..instrs.len()).find(|&i| self.part(i) != Part::Nothing);
        if let Some(first) = after
            && self.basic(first) != Some(Basic::End)
        {
            let diagnostic =
                codes::AFTER_END.at(self.span(first), "instructions after END never run");
            out.push(
                diagnostic
                    .label("this and everything after it never runs")
                    .other(self.span(last), "the scan ends here"),
            );
        }
    }
}

impl Code<'_> {
    /// Adds the line END to the text.
    fn append_end(&self) -> Fix {
        let text = &self.resolved.program.source.text;
        let end = text.len() as u32;
        let line = match text.ends_with('\n') {
            true => "END\n",
            false => "\nEND\n",
        };
        Fix::certain("add END").replace(Span::new(end, end), line)
    }
}

/// Part of an instruction in the contact logic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Part {
    /// NOP.
    Nothing,
    /// Begins a block: LD and related instructions.
    Start,
    /// Continues the block: AND, OR, INV and related instructions.
    Continue,
    /// ANB.
    JoinSeries,
    /// ORB.
    JoinParallel,
    /// MPS.
    Push,
    /// MRD.
    Read,
    /// MPP.
    Pop,
    /// Is driven by the result.
    Output,
    /// Stands without contacts.
    Alone,
    /// Could not be resolved, which was reported.
    Unknown,
}
