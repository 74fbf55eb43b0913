//! Rows, forms, operands and steps of programs.

use rungc_frontend::read_text;
use rungc_ir::model::{Model, ModelId};
use rungc_ir::resolve::resolve;

/// The step numbers of a program on a model, and its length.
fn steps(model: ModelId, text: &str) -> (Vec<u32>, u32) {
    let read = read_text("test", text);
    let (resolved, diagnostics) = resolve(&read.program, Model::get(model));
    assert!(!diagnostics.has_errors(), "{diagnostics:?}");
    let steps = resolved.instrs.iter().map(|instr| instr.step).collect();
    (steps, resolved.steps)
}

#[test]
fn steps_are_counted_by_form_and_device() {
    let text =
        "LD X0\nOR M0\nANI X1\nOUT M0\nOUT T0 K30\nLDP X2\nADD D0 K1 D0\nDADD D0 K1 D0\nEND\n";
    let expected = vec![0, 1, 2, 3, 4, 7, 9, 16, 29];
    assert_eq!(steps(ModelId::Fx3u, text), (expected, 30));
}

#[test]
fn numbers_of_the_source_are_kept() {
    let read = read_text("test", "0 LD X0\n1 OUT Y0\n9 LD X1\n10 OUT Y1\n11 END\n");
    let (resolved, diagnostics) = resolve(&read.program, Model::get(ModelId::Fx3u));
    let steps: Vec<_> = resolved.instrs.iter().map(|instr| instr.step).collect();
    assert_eq!(steps, [0, 1, 9, 10, 11]);
    assert_eq!(resolved.steps, 5);
    let codes: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| diagnostic.code)
        .collect();
    assert_eq!(codes, ["W0501"]);
}

#[test]
fn bits_of_words_are_bits_of_data_registers() {
    for (list, code) in [
        ("LD D0.F\nOUT D5.0\nEND\n", None),
        ("LD M0.1\nOUT Y0\nEND\n", Some("E0101")),
        ("LD R0.1\nOUT Y0\nEND\n", Some("E0101")),
        ("LD D0.1Z0\nOUT Y0\nEND\n", Some("E0103")),
    ] {
        let read = read_text("test", list);
        let (_, diagnostics) = resolve(&read.program, Model::get(ModelId::Fx3u));
        let found = diagnostics.iter().map(|diagnostic| diagnostic.code).next();
        assert_eq!(found, code, "{list}");
    }
}

#[test]
fn labels_are_known() {
    let read = read_text("test", "LD X0\nCJ P1\nP1\nEND\n");
    let (resolved, _) = resolve(&read.program, Model::get(ModelId::H2u));
    let labels: Vec<_> = resolved
        .instrs
        .iter()
        .map(|instr| instr.label.map(|label| label.number))
        .collect();
    assert_eq!(labels, [None, None, Some(1), None]);
}
