//! Holds the lengths that the codes of a project state to those of the instructions that they were read as.

use rungc_catalogue::Found;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Diagnostics, Operand, OperandKind, Program, codes, phrase};

/// Compares lengths; in sources that are lists there is nothing to compare.
pub(super) struct Checker<'p> {
    program: &'p Program,
    /// The model that the project was made for, by whose lengths it goes whatever it is compiled for.
    model: &'static Model,
    /// The model that it is compiled for, which may have instructions that the other has not.
    target: &'static Model,
}

impl<'p> Checker<'p> {
    pub(super) fn new(program: &'p Program, target: &'static Model) -> Self {
        let named = program.cpu.as_deref().and_then(ModelId::for_cpu);
        Checker {
            program,
            model: named.map_or(target, |(id, _)| Model::get(id)),
            target,
        }
    }

    /// Reports an instruction, the one at `at`, whose code states another length than it has with its operands.
    pub(super) fn instr(
        &self,
        at: usize,
        found: Found,
        operands: &[Operand],
        out: &mut Diagnostics,
    ) {
        let Some(stated) = self.stated(at) else {
            return;
        };
        let model = match found.inst.models.has(self.model.id) {
            true => self.model,
            false => self.target,
        };
        let length = found.inst.steps_of(found.form, operands, model);
        // A text is part of the instruction: two steps for every two characters, those of a register included in its
        // length.
        let text = operands
            .iter()
            .any(|operand| matches!(operand.kind, OperandKind::Text(_)));
        let grown = text && stated > length && (stated - length).is_multiple_of(2);
        if stated == length || grown {
            return;
        }
        let instr = &self.program.instrs[at];
        let message = phrase!(
            "the project states {stated} steps for `{mnemonic}`, which has {length} with these operands on {model}",
            stated,
            mnemonic = instr.mnemonic,
            length,
            model = model.name
        );
        out.push(
            codes::CODE_MISFIT
                .at(instr.span, message)
                .label("this may be another instruction")
                .help("compare this step with the editor, or export the list from it and compile that"),
        );
    }

    /// The length that the code of an instruction states: up to the step of the next one.
    fn stated(&self, at: usize) -> Option<u32> {
        let Program {
            kind,
            instrs,
            unread,
            ..
        } = self.program;
        if !kind.is_project() || unread.binary_search(&(at as u32 + 1)).is_ok() {
            return None;
        }
        instrs.get(at + 1)?.step?.checked_sub(instrs[at].step?)
    }
}
