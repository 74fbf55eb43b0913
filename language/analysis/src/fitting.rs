//! Instructions that fit what a project states of one whose code is not known.

use crate::resolve::resolve;
use rungc_catalogue::{Form, Inst};
use rungc_models::Model;
use rungc_syntax::{Instr, Operands, Program, Span};

/// Returns true if an instruction of this name accepts these operands on a model, and has this many steps with them.
pub fn fits(mnemonic: &str, steps: u32, operands: &Operands, model: &'static Model) -> bool {
    let program = Program {
        instrs: vec![Instr {
            mnemonic: mnemonic.into(),
            mnemonic_span: Span::default(),
            operands: operands.clone(),
            span: Span::default(),
            step: None,
            remarks: None,
        }],
        ..Program::default()
    };
    let (resolved, diagnostics) = resolve(&program, model);
    !diagnostics.has_errors() && resolved.steps == steps
}

/// The instructions of a model that fit all these uses of a code, as the list export spells them, in the order of the
/// catalogue. Of those with a pulse form only that is named if `pulse`, else only the other.
pub fn fitting(steps: u32, pulse: bool, uses: &[&Operands], model: &'static Model) -> Vec<String> {
    let forms = [false, true].map(|wide| Form { wide, pulse });
    let spellings =
        |inst: &'static Inst| forms.into_iter().filter_map(|form| inst.spelling_of(form));
    rungc_catalogue::all()
        .filter(|inst| inst.models.has(model.id))
        .flat_map(spellings)
        .filter(|name| {
            uses.iter()
                .all(|operands| fits(name, steps, operands, model))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_models::ModelId;

    #[test]
    fn steps_and_operands_narrow_the_choice() {
        let read = rungc_frontend::read_text("a", "DSZR X010 X000 Y000 Y004\nSRET\n");
        let [dszr, sret] = &read.program.instrs[..] else {
            panic!("{:?}", read.diagnostics);
        };
        let model = Model::get(ModelId::Fx3u);
        let found = fitting(9, false, &[&dszr.operands], model);
        assert!(found.iter().any(|name| name == "DSZR"), "{found:?}");
        assert!(found.iter().all(|name| name != "ZRN"), "{found:?}");
        let narrow = fitting(9, false, &[&dszr.operands, &sret.operands], model);
        assert!(narrow.is_empty(), "{narrow:?}");
        let bare = fitting(1, false, &[&sret.operands], model);
        assert!(bare.contains(&"SRET".to_owned()) && !bare.contains(&"WDTP".to_owned()));
        assert!(fitting(1, true, &[&sret.operands], model).contains(&"WDTP".to_owned()));
    }

    #[test]
    fn an_instruction_fits_with_its_own_steps_only() {
        let read = rungc_frontend::read_text("a", "MOV K1 D0\n");
        let operands = &read.program.instrs[0].operands;
        let model = Model::get(ModelId::Fx2n);
        assert!(fits("MOV", 5, operands, model));
        assert!(!fits("MOV", 9, operands, model) && fits("DMOV", 9, operands, model));
        assert!(!fits("MOVE", 5, operands, model));
    }
}
