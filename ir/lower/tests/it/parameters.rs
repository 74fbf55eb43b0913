//! Effects of a project's PLC parameters: the latched devices, and the maximum length of a program.

use rungc_frontend::read_text;
use rungc_lower::compile::{CompileOptions, Compiled, compile};
use rungc_models::ModelId;
use rungc_syntax::{DeviceClass, DeviceRun, FittedModule, Parameters, Program};

const PROGRAM: &str = "LD X0\nOUT M400\nOUT M499\nOUT M500\nOUT M600\nLD M400\nOR M499\nOR M500\nOR M600\nMOV D6 Z0\nMOV D5Z0 D300\n\
    FMOV K0 D190 K20\nEND\n";

fn program(parameters: Parameters) -> Program {
    let mut program = read_text("press.il", PROGRAM).program;
    program.parameters = Some(parameters);
    program
}

fn compiled(parameters: Parameters, model: ModelId) -> Compiled {
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    compile(&program(parameters), &options)
}

fn latched(runs: &[(DeviceClass, u32, u32)]) -> Parameters {
    let run = |&(class, first, count)| DeviceRun {
        class,
        first,
        count,
    };
    Parameters {
        latched: Some(runs.iter().map(run).collect()),
        ..Parameters::default()
    }
}

/// Stored devices of a class that are latched.
fn kept(compiled: &Compiled, class: DeviceClass) -> Vec<(u32, u32)> {
    let areas = &compiled.module.as_ref().unwrap().layout.areas;
    let kept = areas
        .iter()
        .filter(|area| area.class == class && area.latched);
    kept.map(|area| (area.first, area.first + area.count - 1))
        .collect()
}

#[test]
fn latched_devices_are_those_of_the_project() {
    let usual = compiled(Parameters::default(), ModelId::Fx2n);
    assert_eq!(kept(&usual, DeviceClass::M), [(500, 500), (600, 600)]);
    assert_eq!(kept(&usual, DeviceClass::D), [(200, 7999)]);
    let chosen = latched(&[(DeviceClass::M, 450, 100), (DeviceClass::D, 100, 10)]);
    let chosen = compiled(chosen, ModelId::Fx2n);
    assert_eq!(kept(&chosen, DeviceClass::M), [(499, 499), (500, 500)]);
    assert_eq!(kept(&chosen, DeviceClass::D), [(100, 109), (512, 7999)]);
    let none = compiled(latched(&[]), ModelId::Fx2n);
    assert_eq!(kept(&none, DeviceClass::M), []);
}

/// The findings of a compilation, as text.
fn findings(parameters: Parameters, model: ModelId) -> String {
    let found = compiled(parameters, model).diagnostics;
    let line = |d: &rungc_syntax::Diagnostic| {
        let help = d.help.as_deref().unwrap_or("");
        format!("{} {}\n  / {}\n  / {help}\n", d.code, d.message, d.label)
    };
    found
        .iter()
        .filter(|d| d.code.starts_with("W05"))
        .map(line)
        .collect()
}

#[test]
fn parameters_that_a_model_does_not_allow() {
    let wide = latched(&[(DeviceClass::M, 0, 4000), (DeviceClass::T, 0, 10)]);
    let large = Parameters {
        capacity: Some(64_000),
        ..Parameters::default()
    };
    let all = [
        findings(wide.clone(), ModelId::Fx2n),
        findings(wide, ModelId::Fx1n),
        findings(large, ModelId::Fx2n),
    ];
    insta::assert_snapshot!(all.join("---\n"));
}

#[test]
fn a_program_longer_than_the_memory_that_the_project_sets() {
    let small = Parameters {
        capacity: Some(1000),
        file_register_blocks: 2,
        ..Parameters::default()
    };
    insta::assert_snapshot!(findings(small, ModelId::Fx3u));
}

#[test]
fn what_a_panel_writes_may_be_reset_there() {
    let run = |class, first| DeviceRun {
        class,
        first,
        count: 1,
    };
    let findings = |written: &[DeviceRun]| {
        let text = "LD X0\nOUT C0 K10\nOUT C1 K10\nSET Y3\nLD C0\nOR C1\nOUT Y0\nEND\n";
        let mut program = read_text("press.il", text).program;
        program.parameters = Some(Parameters {
            written_externally: written.to_vec(),
            ..Parameters::default()
        });
        let found = compile(&program, &CompileOptions::default()).diagnostics;
        found.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let [c0, c1, y3] = [
        (DeviceClass::C, 0),
        (DeviceClass::C, 1),
        (DeviceClass::Y, 3),
    ]
    .map(|(class, first)| run(class, first));
    assert_eq!(findings(&[]).len(), 2);
    let some = findings(&[c0, y3]);
    assert_eq!(some, ["`C1` reaches its preset once and is never reset"]);
    assert_eq!(findings(&[c0, c1, y3]), [""; 0]);
}

#[test]
fn what_a_panel_writes_may_be_a_preset() {
    let findings = |parameters: Parameters| {
        let text = "LD X0\nOUT T0 D10\nLD> D12 K5\nOR T0\nOUT Y0\nEND\n";
        let mut program = read_text("press.il", text).program;
        program.parameters = Some(parameters);
        let found = compile(&program, &CompileOptions::default()).diagnostics;
        found.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let run = |first, count| DeviceRun {
        class: DeviceClass::D,
        first,
        count,
    };
    let written = |runs: &[DeviceRun]| Parameters {
        written_externally: runs.to_vec(),
        ..Parameters::default()
    };
    let latched = |runs: &[DeviceRun]| Parameters {
        latched: Some(runs.to_vec()),
        ..Parameters::default()
    };
    let both = "`D10` and 1 other device are read, but nothing writes them";
    assert_eq!(findings(Parameters::default()), [both]);
    assert_eq!(findings(written(&[run(11, 1)])), [both]);
    let one = ["`D12` is read, but nothing writes it"];
    assert_eq!(findings(written(&[run(0, 11)])), one);
    assert_eq!(findings(latched(&[run(0, 11)])), one);
    assert_eq!(findings(written(&[run(10, 3)])), [""; 0]);
    assert_eq!(findings(latched(&[run(10, 3)])), [""; 0]);
}

#[test]
fn transfers_from_and_to_a_module_stay_within_what_it_has() {
    let findings = |lines: &str| {
        let text = format!("{}\nEND\n", lines.replace(" / ", "\n"));
        let mut program = read_text("press.il", &text).program;
        let module = FittedModule {
            unit: 0,
            kind: "FX2N-4AD",
            delay_ms: 0,
            pins: Vec::new(),
        };
        program.parameters = Some(Parameters {
            modules: vec![module],
            ..Parameters::default()
        });
        let options = CompileOptions {
            model: Some(ModelId::Fx3u),
            ..CompileOptions::default()
        };
        let found = compile(&program, &options).diagnostics;
        let found = found.iter().filter(|d| d.code.starts_with("W066"));
        found.map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let beyond = "FX2N-4AD (module 0) has no BFM 31";
    let measured = "BFM 5 of FX2N-4AD (module 0) can only be read: mean value";
    for (lines, expected) in [
        ("LD X0 / BMOV U0\\G29 D0 K3", beyond),
        ("LD X0 / BMOV D0 U0\\G1 K5", measured),
        ("LD X0 / FMOV K0 U0\\G1 K5", measured),
        ("LD X0 / DMOV U0\\G30 D0", beyond),
        ("LD X1 / OUT M8024 / LD X0 / BMOV U0\\G5 D0 K2", measured),
    ] {
        assert_eq!(findings(lines), [expected], "{lines}");
    }
    for lines in [
        "LD X0 / BMOV U0\\G5 D0 K8",
        "LD X0 / BMOV U0\\G29 D0 D50",
        "LD X0 / BMOV D0 U0\\G1 K4",
        "LD X0 / FMOV K0 U0\\G1 K4",
    ] {
        assert_eq!(findings(lines), [""; 0], "{lines}");
    }
}
