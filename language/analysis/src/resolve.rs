//! Gives every instruction of a program its catalogue row, form and step number, and holds its operands to the row.
//!
//! What an instruction is on its own is decided here; how instructions relate to each other is the business of
//! [`check`](crate::check).

mod lengths;
mod mnemonic;
mod operands;
mod rules;
mod steps;
pub(crate) mod suggest;
mod wrong;

use mnemonic::{Fit, Match};
use rungc_catalogue::{Basic, Drive, Form, Found, Inst, Join, Lower, Param};
use rungc_models::{Model, plc_errors};
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Diagnostics, Instr, Operand, OperandKind, Program, Severity,
};

/// Resolution of one instruction.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Its catalogue row; `None` if it is unknown or the model does not have it (which was reported). A form that the
    /// row does not have was reported too.
    pub inst: Option<&'static Inst>,
    /// True if `inst` is only a guess, by which the structure of the program is judged; the error in the instruction
    /// was reported.
    pub meant: bool,
    /// True if an error in its operands was reported.
    pub wrong: bool,
    /// Implementation on the model; `None` if there is no row.
    pub lower: Option<Lower>,
    /// Its form.
    pub form: Form,
    /// Parameters; none if there is no row.
    pub params: &'static [Param],
    /// Step number of its first word, as the source counts where it does.
    pub step: u32,
    /// The pointer, if it is a label.
    pub label: Option<Device>,
}

impl Resolution {
    /// Basic instruction, if it is one.
    pub fn basic(&self) -> Option<Basic> {
        self.inst?.basic()
    }

    /// Of an instruction of which nothing is known.
    fn unknown(step: u32) -> Self {
        Resolution {
            inst: None,
            meant: false,
            wrong: false,
            lower: None,
            form: Form::default(),
            params: &[],
            step,
            label: None,
        }
    }
}

/// A program whose instructions are known.
#[derive(Debug)]
pub struct Resolved<'p> {
    /// The program.
    pub program: &'p Program,
    /// The model it is for.
    pub model: &'static Model,
    /// One for each of `program.instrs`.
    pub instrs: Vec<Resolution>,
    /// Length in steps.
    pub steps: u32,
}

impl Resolved<'_> {
    /// Finds the LDs that begin a rung, rather than a block that ANB or ORB joins to the code before it: one flag for
    /// each instruction. A block that has driven something may still be joined, with what is to its left waiting.
    pub fn starts_of_rungs(&self) -> Vec<bool> {
        let mut starts = vec![false; self.instrs.len()];
        // The LD of each open block, and whether its result has just driven something.
        let mut blocks: Vec<(usize, bool)> = Vec::new();
        for (i, resolution) in self.instrs.iter().enumerate() {
            let Some(inst) = resolution.inst else {
                continue;
            };
            match resolution.lower {
                Some(
                    Lower::Basic(Basic::Ld | Basic::Ldi | Basic::Ldp | Basic::Ldf)
                    | Lower::Compare(Join::Ld, _),
                ) => {
                    starts[i] = true;
                    blocks.push((i, false));
                }
                Some(Lower::Basic(Basic::Anb | Basic::Orb)) => {
                    if let [.., (_, below), (joined, false)] = &mut blocks[..] {
                        *below = false;
                        starts[*joined] = false;
                        blocks.pop();
                    }
                }
                _ => match (inst.drive, blocks.last_mut()) {
                    (Drive::Alone, _) => blocks.clear(),
                    (Drive::Contact, Some((_, spent))) => *spent = true,
                    (Drive::Logic, Some((_, spent))) => *spent = false,
                    (_, None) => {}
                },
            }
        }
        starts
    }
}

/// Finds the row of each instruction of `program`, checks its form and operands, and counts steps.
pub fn resolve<'p>(program: &'p Program, model: &'static Model) -> (Resolved<'p>, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let mut finder = mnemonic::Finder::new(model);
    let operands = operands::Checker::new(model);
    let mut steps = steps::Counter::default();
    let lengths = lengths::Checker::new(program, model);
    let mut instrs = Vec::with_capacity(program.instrs.len());
    let mut unread = program.unread.iter().copied().peekable();
    for (i, instr) in program.instrs.iter().enumerate() {
        while unread.next_if(|&before| before as usize <= i).is_some() {
            steps.lose();
        }
        let last = i + 1 == program.instrs.len();
        let matched = finder.find(instr, last, &mut diagnostics);
        let Some(Match { found, fit, label }) = matched else {
            instrs.push(Resolution::unknown(steps.next(instr, None)));
            continue;
        };
        let Found { inst, form, .. } = found;
        let pointer = label.map(|label| pointer(instr, label));
        let written = pointer
            .as_ref()
            .map_or(&*instr.operands, std::slice::from_ref);
        let (params, length) = inst.params_and_steps(form, written, model);
        let before = diagnostics.len();
        let mut meant = fit == Fit::Meant;
        if fit == Fit::Good {
            if let Some(joined) = wrong::second_instruction(instr, params, &program.source) {
                diagnostics.push(joined);
                meant = true;
            } else if let Some(label) = label {
                operands.label(instr, label, &mut diagnostics);
            } else {
                operands.instr(instr, found, params, &mut diagnostics);
                let fraction = wrong::fraction(instr, found, params, &program.source, model);
                diagnostics.extend(fraction);
            }
        }
        let found_here = diagnostics.iter().skip(before);
        let wrong = found_here
            .clone()
            .any(|found| found.severity == Severity::Error);
        let known = !meant && !instr.is_broken();
        if fit == Fit::Good && known && diagnostics.len() == before {
            lengths.instr(i, found, written, &mut diagnostics);
        }
        instrs.push(Resolution {
            inst: Some(inst),
            meant,
            wrong,
            lower: Some(inst.lower_on_model(model.id)),
            form,
            params,
            step: steps.next(instr, known.then_some(length)),
            label,
        });
    }
    let length = steps.finish(program, model, &mut diagnostics);
    let resolved = Resolved {
        program,
        model,
        instrs,
        steps: length,
    };
    (resolved, numbered(diagnostics, model))
}

/// The pointer of a label as an operand, on which its length depends.
fn pointer(instr: &Instr, label: Device) -> Operand {
    Operand {
        span: instr.mnemonic_span,
        kind: OperandKind::Device(label, None),
    }
}

/// The pointer that an instruction defines, if it is a label.
fn label(instr: &Instr) -> Option<Device> {
    let (class, digits) = match instr.mnemonic.split_at_checked(1)? {
        ("P", digits) => (DeviceClass::P, digits),
        ("I", digits) => (DeviceClass::I, digits),
        _ => return None,
    };
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| plain)?;
    Some(Device { class, number })
}

/// Gives diagnostics the numbers of the model's own table of errors, where it has any.
pub fn numbered(diagnostics: Diagnostics, model: &Model) -> Diagnostics {
    let mut kept = Diagnostics::new();
    kept.extend(diagnostics.iter().cloned().map(|diagnostic| {
        Diagnostic {
            plc_error: diagnostic
                .plc_error
                .and_then(|number| plc_errors::of_check(diagnostic.code, number, model)),
            ..diagnostic
        }
    }));
    kept
}
