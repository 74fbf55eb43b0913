//! Gives every instruction of a program its catalogue row, form and step number, and holds its operands to the row.
//!
//! What an instruction is on its own is decided here; how instructions stand to each other is the business of
//! [`check`](crate::check).

mod mnemonic;
mod operands;
mod rules;
mod steps;

pub(crate) use operands::constant_value;

use crate::catalogue::{Found, Inst, Param};
use crate::model::{Model, ModelSet};
use mnemonic::Fit;
use rungc_syntax::{Device, DeviceClass, Diagnostic, Diagnostics, Instr, Program};

/// Which form of an instruction is written.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Form {
    /// 32-bit (prefix D).
    pub wide: bool,
    /// Pulse (suffix P): once per off-to-on change of the drive.
    pub pulse: bool,
}

/// What is known of one instruction.
#[derive(Clone, Copy, Debug)]
pub struct Resolution {
    /// Its catalogue row; `None` if it is unknown or the model does not have it (which was reported). A form that the row does not
    /// have was reported too.
    pub inst: Option<&'static Inst>,
    /// Its form.
    pub form: Form,
    /// What its operands are; none if there is no row.
    pub params: &'static [Param],
    /// Step number of its first word, as the source counts where it does.
    pub step: u32,
    /// The pointer, if it is a label.
    pub label: Option<Device>,
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

/// Finds the row of each instruction of `program`, checks its form and operands, and counts steps.
pub fn resolve<'p>(program: &'p Program, model: &'static Model) -> (Resolved<'p>, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let mut finder = mnemonic::Finder::new(model);
    let operands = operands::Checker::new(model);
    let mut steps = steps::Counter::default();
    let mut instrs = Vec::with_capacity(program.instrs.len());
    for instr in &program.instrs {
        let label = label(instr);
        let found = finder.find(instr, &mut diagnostics);
        let (params, length) = match found {
            Some((Found { inst, form, .. }, _)) => {
                let (params, length) = inst.params_and_steps(form, &instr.operands, model);
                (params, Some(length))
            }
            None => (&[][..], None),
        };
        match (found, label) {
            (Some((_, Fit::Good)), Some(label)) => operands.label(instr, label, &mut diagnostics),
            (Some((found, Fit::Good)), None) => {
                operands.instr(instr, found, params, &mut diagnostics)
            }
            _ => {}
        }
        let found = found.map(|(found, _)| found);
        instrs.push(Resolution {
            inst: found.map(|found| found.inst),
            form: found.map(|found| found.form).unwrap_or_default(),
            params,
            step: steps.next(instr, length),
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

/// Takes the PLC's error numbers away where the model's manual does not have them.
pub(crate) fn numbered(diagnostics: Diagnostics, model: &Model) -> Diagnostics {
    /// Models whose manuals number the errors of a program.
    const NUMBERED: ModelSet = ModelSet::INOVANCE.or(ModelSet::FX);
    /// Models that reserve the numbers of contact logic (h1u-h2u-programming §8.7).
    const LOGIC_RESERVED: ModelSet = ModelSet::INOVANCE;
    let known = |code: u16| {
        let logic = matches!(code, 6601..=6604 | 6609..=6617);
        NUMBERED.has(model.id) && !(logic && LOGIC_RESERVED.has(model.id))
    };
    let mut kept = Diagnostics::new();
    kept.extend(diagnostics.iter().cloned().map(|diagnostic| Diagnostic {
        plc_error: diagnostic.plc_error.filter(|&code| known(code)),
        ..diagnostic
    }));
    kept
}
