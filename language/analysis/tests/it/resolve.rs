//! Rows, forms, operands and steps of programs.

use rungc_analysis::resolve::resolve;
use rungc_frontend::read_text;
use rungc_models::{Model, ModelId};
use rungc_syntax::{SourceKind, codes};

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

/// An index takes a long operand in each basic instruction that can have one; what has it without an index keeps it.
#[test]
fn an_index_takes_steps() {
    let contacts = ["LD", "LDI", "AND", "ANI", "OR", "ORI"];
    let edges = ["LDP", "LDF", "ANDP", "ANDF", "ORP", "ORF"];
    let coils = ["OUT", "SET", "RST"];
    let pulses = ["PLS", "PLF"];
    let all = contacts.map(|name| (name, "X000", 1)).into_iter();
    let all = all.chain(contacts.map(|name| (name, "T5", 1)));
    let all = all.chain(contacts.map(|name| (name, "M1600", 2)));
    let all = all.chain(edges.map(|name| (name, "M0", 2)));
    let all = all.chain(coils.map(|name| (name, "Y000", 1)));
    let all = all.chain(coils.map(|name| (name, "M4000", 3)));
    let all = all.chain(pulses.map(|name| (name, "M0", 2)));
    for (name, device, plain) in all.chain([("RST", "T0", 2), ("RST", "C0", 2)]) {
        for (index, length) in [("", plain), ("Z1", 3), ("V7", 3)] {
            let text = format!("LD X000\n{name} {device}{index}\nNOP\n");
            let read = read_text("test", &text);
            let (resolved, _) = resolve(&read.program, Model::get(ModelId::Fx3u));
            let steps = resolved.instrs[2].step - resolved.instrs[1].step;
            assert_eq!(steps, length, "{name} {device}{index}");
        }
    }
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

/// A project on FX2N whose codes state these steps, from instruction to instruction.
fn misfits(text: &str, cpu: &str, target: ModelId) -> Vec<String> {
    let mut read = read_text("test", text);
    read.program.kind = SourceKind::GxWorks2;
    read.program.cpu = Some(cpu.to_owned());
    let (_, diagnostics) = resolve(&read.program, Model::get(target));
    let misfits = diagnostics
        .iter()
        .filter(|d| d.code == codes::CODE_MISFIT.id);
    assert!(diagnostics.iter().all(|d| d.code != codes::STEPS_DIFFER.id));
    misfits.map(|d| d.message.to_string()).collect()
}

#[test]
fn lengths_of_projects_are_those_of_their_cpu() {
    let right = "0 LD X0\n1 MOV K1 D0\n6 DMOV K1 D0\n15 END\n";
    for target in ModelId::ALL {
        assert_eq!(misfits(right, "FX2N/FX2NC", target), [""; 0], "{target:?}");
    }
    let wrong = "0 LD X0\n1 MOV K1 D0\n10 DMOV K1 D0\n15 END\n";
    let found = misfits(wrong, "FX2N/FX2NC", ModelId::Hm);
    let [mov, dmov] = &found[..] else {
        panic!("{found:?}");
    };
    assert!(
        mov.contains("states 9 steps for `MOV`, which has 5"),
        "{mov}"
    );
    assert!(
        dmov.contains("states 5 steps for `DMOV`, which has 9"),
        "{dmov}"
    );
}

#[test]
fn a_text_makes_an_instruction_longer() {
    let long = "0 LD X0\n1 $MOV \"ABCDEF\" D0\n10 END\n";
    assert_eq!(misfits(long, "FX3U/FX3UC", ModelId::Fx3u), [""; 0]);
    let odd = "0 LD X0\n1 $MOV \"ABCDEF\" D0\n9 END\n";
    assert_eq!(misfits(odd, "FX3U/FX3UC", ModelId::Fx3u).len(), 1);
}

#[test]
fn instructions_that_are_not_read_hide_no_length() {
    let mut read = read_text("test", "0 LD X0\n10 OUT Y0\n11 END\n");
    read.program.kind = SourceKind::GxDeveloper;
    read.program.unread = vec![1];
    let (_, diagnostics) = resolve(&read.program, Model::get(ModelId::Fx3u));
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
}

/// The examples on the pages pass the checks, on every model that has the instruction.
#[test]
fn examples_resolve_without_errors() {
    let mut wrong = Vec::new();
    for inst in rungc_catalogue::all() {
        for id in ModelId::ALL.into_iter().filter(|&id| inst.models.has(id)) {
            let model = Model::get(id);
            let mut text = inst.example_on(model);
            text.push_str("\nEND\n");
            let read = read_text("example", &text);
            let (_, found) = resolve(&read.program, model);
            let errors: Vec<_> = read
                .diagnostics
                .iter()
                .chain(found.iter())
                .filter(|diagnostic| diagnostic.severity == rungc_syntax::Severity::Error)
                .map(|diagnostic| diagnostic.message.to_string())
                .collect();
            if !errors.is_empty() {
                wrong.push(format!("{} on {}: {text}{errors:?}", inst.name, model.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Where an instruction takes whole numbers, a message names the one for floats and how the constant is written.
#[test]
fn floats_that_messages_propose_are_accepted() {
    for text in [
        "1.5", "-5.5", "+1.5", ".5", "5.", "1.5e3", "-1.5E-3", "1.5e+30",
    ] {
        let read = read_text("test", &format!("LD X0\nDMOV {text} D0\nEND\n"));
        let (_, found) = resolve(&read.program, Model::get(ModelId::Fx3u));
        let found = found.sorted();
        let help = found[0].help.as_deref().unwrap_or_default();
        let quoted: Vec<_> = help.split('`').skip(1).step_by(2).collect();
        let [mnemonic, constant] = quoted[..] else {
            panic!("{text}: {help}");
        };
        let read = read_text("test", &format!("LD X0\n{mnemonic} {constant} D0\nEND\n"));
        let (_, after) = resolve(&read.program, Model::get(ModelId::Fx3u));
        assert!(
            !after.has_errors() && !read.diagnostics.has_errors(),
            "{text}: {help}"
        );
    }
}

/// The time for a word grows with its length alone.
#[test]
fn a_long_word_is_reported_at_once() {
    for word in ["A".repeat(500_000), "OUTY".repeat(125_000)] {
        let read = read_text("test", &format!("{word}\nLD X0\nOUT Y0\nEND\n"));
        let (_, diagnostics) = resolve(&read.program, Model::get(ModelId::Fx3u));
        let mut found = diagnostics.iter();
        assert!(found.any(|d| d.code == "E0033" && d.message.len() < 200));
    }
}
