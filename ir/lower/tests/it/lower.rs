//! Lowering, as the text of modules: one small program for each construct.

use rungc_ir::Module;
use rungc_ir::dump::dump;
use rungc_ir::node::{Action, Stmt};
use rungc_ir::passes::optimise;
use rungc_ir::validate::validate;
use rungc_ir::walk::statements;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;

/// Compiles a list that must have no errors.
fn module(options: &CompileOptions, text: &str) -> Module {
    let read = rungc_frontend::read_text("test.il", text);
    let compiled = compile(&read.program, options);
    let findings: Vec<_> = read
        .diagnostics
        .iter()
        .chain(compiled.diagnostics.iter())
        .collect();
    compiled
        .module
        .unwrap_or_else(|| panic!("{text}: {findings:#?}"))
}

fn on(model: ModelId) -> CompileOptions {
    CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    }
}

/// A module as lowered for H2U, and what is otherwise when it is optimised.
fn lowered(text: &str) -> String {
    both(&on(ModelId::H2u), text)
}

fn both(options: &CompileOptions, text: &str) -> String {
    let plain = module(options, text);
    validate(&plain).unwrap();
    let mut optimised = plain.clone();
    optimise(&mut optimised);
    validate(&optimised).unwrap();
    let simpler = dump(&optimised);
    let code = simpler
        .find("{\n")
        .and_then(|at| simpler[..at].rfind('\n'))
        .map_or("", |at| &simpler[at + 1..]);
    format!("{}--- optimised ---\n{code}", dump(&plain))
}

#[test]
fn motor() {
    insta::assert_snapshot!(lowered(
        "LD X0 ; start\nOR M0\nANI X1\nOUT M0 ; motor latch\nLD M0\nOUT T0 K30\nAND T0\nOUT Y0\nLDP X2\nADD D0 K1 D0\n\
         LD>= D0 K10\nSET Y1\nEND\n"
    ));
}

#[test]
fn branches() {
    insta::assert_snapshot!(lowered(
        "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nAND X2\nOUT Y1\nMPP\nANI X3\nOUT Y2\nOUT Y3\nLD X4\nOR X5\nLD X6\nANI X7\nORB\nLD M1\nOR M2\n\
         ANB\nINV\nOUT Y4\nEND\n"
    ));
}

#[test]
fn block_joined_after_a_coil() {
    insta::assert_snapshot!(lowered(
        "LD X0\nAND X1\nOUT Y0\nLD X10\nOR X11\nANB\nOUT Y1\nEND\n"
    ));
}

#[test]
fn pulses() {
    insta::assert_snapshot!(lowered(
        "LDP X0\nORF X1\nOUT M0\nLD X2\nPLS M1\nLD X3\nINCP D0\nDECP D1\nEND\n"
    ));
}

#[test]
fn run_flags() {
    insta::assert_snapshot!(lowered(
        "LD M8000\nOUT Y0\nLD M8002\nMOV K5 D0\nLDI M8013\nOUT Y1\nEND\n"
    ));
}

#[test]
fn counters() {
    insta::assert_snapshot!(lowered(
        "LD X0\nOUT C0 K5\nLD X1\nOUT C200 D10\nLD X2\nOUT M8201\nLD X3\nOUT C201 K-5\nLD X4\nRST C0\nRST C200\nRST D5\nRST T250\nEND\n"
    ));
}

#[test]
fn arithmetic() {
    insta::assert_snapshot!(lowered(
        "LD X0\nADD D0 D1 D2\nDSUB D0 D2 D4\nMUL D0 D1 D10\nDMUL D0 D2 D20\nDIV D0 K3 D30\nDIV D0 D1 K4M0\nWAND D0 HFF D1\nNEG D0\nLD M8022\nOUT Y0\nEND\n"
    ));
}

#[test]
fn saturating_arithmetic() {
    insta::assert_snapshot!(both(
        &on(ModelId::Hm),
        "LD X0\nADD D1000 D1001 D1002\nDINC D1004\nDIV D1000 D1001 D1010\nEND\n"
    ));
}

#[test]
fn compares() {
    insta::assert_snapshot!(lowered(
        "LD X0\nCMP D0 K5 M0\nDZCP K1 K10 D2 M10\nLDD>= D0 K100000\nAND< T0 K4\nOR<> C0 D5\nOUT Y0\nEND\n"
    ));
}

#[test]
fn addressing() {
    insta::assert_snapshot!(lowered(
        "LD X0\nMOV K4X0 D0\nMOV D0 K2Y10\nMOV D10Z0 D20V1\nDMOV D10Z1 D30\nMOV K100Z2 D40\nMOV T0 D50\nDMOV C200 D52\nDMOV K70000 Z3\n\
         MOV D8028 D60\nCML K1M0Z0 D61\nEND\n"
    ));
}

#[test]
fn master_control() {
    insta::assert_snapshot!(lowered(
        "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nLD X2\nMC N1 M101\nLD X3\nSET Y1\nMCR N1\nLD X4\nOUT T0 K5\nMCR N0\nLD X5\nOUT Y2\nEND\n"
    ));
}

#[test]
fn steps() {
    insta::assert_snapshot!(lowered(
        "LD M8002\nSET S0\nSTL S0\nOUT Y0\nLD X0\nSET S20\nSET S21\nSTL S20\nOUT Y1\nSTL S21\nOUT Y2\nSTL S20\nSTL S21\nLD X1\nOUT S0\n\
         RET\nLD X2\nOUT Y3\nEND\n"
    ));
}

#[test]
fn jumps_that_nest() {
    insta::assert_snapshot!(lowered(
        "LD X0\nCJ P1\nLD X1\nCJ P2\nLD X2\nOUT Y0\nP2\nLD X3\nOUT Y1\nP1\nLD X4\nCJ P63\nLD X5\nOUT Y2\nEND\n"
    ));
}

#[test]
fn jumps_that_cross() {
    insta::assert_snapshot!(lowered(
        "LD X0\nCJ P1\nLD X1\nCJ P2\nP1\nLD X2\nOUT Y0\nP2\nLD X3\nOUT Y1\nP3\nLD X4\nINC D0\nLD< D0 K5\nCJ P3\nEND\n"
    ));
}

#[test]
fn jump_out_of_a_loop() {
    insta::assert_snapshot!(lowered(
        "FOR K10\nLD X0\nCJ P1\nLD X1\nINC D0\nNEXT\nLD X2\nOUT Y0\nP1\nLD X3\nOUT Y1\nEND\n"
    ));
}

#[test]
fn subroutines() {
    insta::assert_snapshot!(lowered(
        "LD X0\nCALL P1\nLD X1\nCALLP P2\nFEND\nP1\nLD X2\nCJ P3\nLD X3\nOUT Y0\nSRET\nP3\nLD X4\nCALL P2\nSRET\nP2\nLD X5\nOUT Y1\nSRET\nEND\n"
    ));
}

#[test]
fn special_devices() {
    let observe = [8010, 8011, 8012, 8040, 8041]
        .map(|n| (rungc_syntax::DeviceClass::D, n))
        .into_iter()
        .chain([8000, 8011, 8046, 8067].map(|n| (rungc_syntax::DeviceClass::M, n)))
        .collect();
    let options = CompileOptions {
        observe,
        ..on(ModelId::H2u)
    };
    insta::assert_snapshot!(both(&options, "LD X0\nOUT M8047\nLD X1\nOUT M8031\nEND\n"));
}

#[test]
fn jump_with_an_index() {
    insta::assert_snapshot!(both(
        &on(ModelId::Hm),
        "LD X0\nCJ P10V0\nP10\nLD X1\nOUT Y0\nP11\nLD X2\nOUT Y1\nEND\n"
    ));
}

#[test]
fn buffer_memory() {
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nMOV U0\\G5 D0\nDMOV D10 U1\\G20\nEND\n"
    ));
}

#[test]
fn calls_of_the_runtime() {
    insta::assert_snapshot!(lowered(
        "LD X0\nMOV D9 Z0\nBMOV D0Z0 D10 K10\nFMOVP K0 D20Z0 K3\nLD X1\nRAMP D50 D51 D52 K10\nEND\n"
    ));
}

#[test]
fn conversions_and_floats_are_inline() {
    insta::assert_snapshot!(lowered(
        "LD X0\nSWAP D0\nXCH D1 D2\nALT M0\nBCD D3 D4\nBIN D4Z0 D5\nSUM D5 D6\nBON D6 M1 K3\nROR D7 K3\nROLP D8 K5\nSQR D9 D10\nEND\n"
    ));
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nFLT D0 D2\nDEADD D2 D14 D4\nDEDIV D4 D6 D8\nDECMP D8 K3 M0\nDINT D8 D10\nDENEG D12\nDEZCP D14 D16 D8 M4\nEND\n"
    ));
}

#[test]
fn operations_on_values() {
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nSEGD D0 K2Y0\nLIMIT K5 K90 D1 D2\nDLIMIT D4 D6 D8 D10\nBAND K-3 K3 D12 D13\nZONE K-3 K3 D14Z0 D15\nEND\n"
    ));
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nROR D0 D1\nBON D2 M0 D3\nXCH D4 D4\nGBIN D5 D6\nLD X1\nOUT M8160\nEND\n"
    ));
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nANS T0 K10 S900\nLD X1\nTADD D0 D3 D6\nSTOH D9 D10\nEND\n"
    ));
}

/// Returns true if a module calls the runtime.
fn has_call(module: &Module) -> bool {
    let mut found = false;
    for function in &module.functions {
        statements(&function.body, &mut |stmt| {
            found |= matches!(stmt, Stmt::Do(Action::Call(_)));
        });
    }
    found
}

/// Instructions that set flags in use, or have operands that inline code does not support, call the runtime.
#[test]
fn flags_and_operands_call_the_runtime() {
    let calls = |text: &str| has_call(&module(&on(ModelId::Fx3u), text));
    assert!(!calls("LD X0\nDEADD D0 D2 D4\nEND\n"));
    assert!(calls("LD X0\nDEADD D0 D2 D4\nLD M8022\nOUT Y0\nEND\n"));
    assert!(!calls("LD X0\nDEADD D0 D2 D4\nLD M8020\nOUT Y0\nEND\n"));
    assert!(!calls("LD X0\nROR D0 K4\nLD M8022\nOUT Y0\nEND\n"));
    assert!(calls("LD X0\nRCR D0 D1\nEND\n"));
    assert!(!calls("LD X0\nROR D0 D1\nEND\n"));
    assert!(calls("LD X0\nANS T0 D0 S900\nEND\n"));
    assert!(!calls("LD X0\nANS T0 K10 S900\nEND\n"));
    assert!(!calls("LD X0\nXCH D0 D1\nEND\n"));
    assert!(!calls("LD X0\nXCH D0 D0\nLD X1\nOUT M8160\nEND\n"));
}

#[test]
fn clock_and_errors_around_the_program() {
    insta::assert_snapshot!(lowered("LD X0\nOUT M8015\nLD X1\nMOV D8013 D0\nEND\n"));
    insta::assert_snapshot!(both(
        &on(ModelId::Hm),
        "LD M8006\nMOV D8006 D1000\nDMOV D8008 D1002\nEND\n"
    ));
}

#[test]
fn what_is_not_implemented_is_refused_by_name() {
    let refused = |text: &str| -> Vec<String> {
        let read = rungc_frontend::read_text("test.il", text);
        let compiled = compile(&read.program, &on(ModelId::Fx3u));
        assert!(compiled.module.is_none(), "{text}");
        let errors = compiled.diagnostics.iter();
        errors
            .filter(|d| d.severity == rungc_syntax::Severity::Error)
            .map(|d| format!("{} {}", d.code, d.message))
            .collect()
    };
    assert_eq!(
        refused("LD X10\nDTBL Y0 K1\nEND\n"),
        [
            "E0036 `TBL` cannot be compiled: its positioning table is a parameter of the project that rungc does not read"
        ]
    );
}

#[test]
fn models_that_can_compile_an_instruction_are_named() {
    let read = rungc_frontend::read_text("t.il", "LD X000\nIVRD H104 H1F D120 K2\nEND\n");
    let compiled = compile(&read.program, &on(ModelId::Fx3u));
    let refused = compiled.diagnostics.iter().find(|d| d.code == "E0036");
    let help = refused.and_then(|d| d.help.as_deref());
    assert_eq!(help, Some("it can be compiled for: fx3u-compatible"));
}

#[test]
fn devices_that_compatible_boards_may_lack_get_a_note() {
    let noted = |model, text: &str| {
        let read = rungc_frontend::read_text("t.il", text);
        let compiled = compile(&read.program, &on(model));
        let notes = compiled.diagnostics.iter().filter(|d| d.code == "N0022");
        notes.map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let message = |names: &str| {
        vec![format!(
            "{names}: not every FX3U-compatible board has such devices"
        )]
    };
    for (text, names) in [
        (
            "LD X000\nOUT M7669\nLD M7669\nOUT Y000\nLD X001\nMOV K1 D7400\nEND\n",
            "`M7669`, `D7400`",
        ),
        ("LD M3072\nOUT Y000\nEND\n", "`M3072`"),
        ("LD M8000\nFMOV K0 D6990 K20\nEND\n", "`D7000`"),
        ("LD M8000\nDMOV K0 D6999\nEND\n", "`D7000`"),
    ] {
        assert_eq!(
            noted(ModelId::Fx3uCompatible, text),
            message(names),
            "{text}"
        );
        assert!(noted(ModelId::Fx3u, text).is_empty(), "{text}");
    }
    let low = "LD M3071\nMOV K1 D6999\nLD M8000\nOUT Y000\nMOV D8000 D0\nEND\n";
    assert!(noted(ModelId::Fx3uCompatible, low).is_empty());
}

#[test]
fn comments_of_devices_are_written_by_the_compiler() {
    let device = rungc_syntax::Device {
        class: rungc_syntax::DeviceClass::D,
        number: 0,
    };
    let compiled = |comment: &str| {
        let text = "LD X0\nCOMRD D0 D10\nEND\n";
        let mut program = rungc_frontend::read_text("test.il", text).program;
        program.comments.insert(device, comment.to_string());
        compile(&program, &on(ModelId::Fx3u))
    };
    let module = compiled("Pump 1").module.unwrap();
    let dumped = dump(&module);
    let words: Vec<&str> = dumped
        .lines()
        .filter_map(|l| l.trim().strip_prefix("D1"))
        .collect();
    assert_eq!(
        words,
        [
            "0 := 30032",
            "1 := 28781",
            "2 := 12576",
            "3 := 8224",
            "4 := 8224",
            "5 := 8224",
            "6 := 8224",
            "7 := 8224",
            "8 := 0"
        ]
    );
    assert!(compiled("泵").module.is_none());
}

/// Emitted code shows no more of a comment than people read on a line.
#[test]
fn comments_longer_than_any_editors_are_cut() {
    let long = "word ".repeat(200);
    let text = format!(";! X000 = {long}\n;! Y000 = short\nLD X000 ; {long}\nOUT Y000\nEND\n");
    let module = module(&on(ModelId::H2u), &text);
    let comments: Vec<_> = module.comments.iter().map(|c| c.2.as_str()).collect();
    assert!(comments[0].ends_with("word…"), "{}", comments[0]);
    assert!(comments[0].chars().count() <= 401);
    assert_eq!(comments[1], "short");
    let note = module.networks[0].note.as_deref().unwrap();
    assert!(note.ends_with('…'), "{note}");
}

#[test]
fn short_blocks_are_inline() {
    insta::assert_snapshot!(lowered(
        "LD X0\nBMOV D0 D2 K4\nBMOV D20 D10 K3\nFMOV K0 D30 K3\nDFMOV K70000 D40 K2\nZRST M0 M3\nZRST T0 T1\nZRST C235 C235\nZRST D50 D51\nMEAN D0 D60 K4\nSFTLP X0 M10 K4 K1\nSFTR M20 M24 K4 K2\nDECO D70 M30 K2\nEND\n"
    ));
    let calls = |text: &str| has_call(&module(&on(ModelId::Fx3u), text));
    assert!(!calls("LD X0\nBMOV D0Z0 D10 K2\nEND\n"));
    assert!(!calls("LD X0\nBMOV D0 D10 D2\nEND\n"));
    assert!(calls("LD X0\nBMOV K4M0 D10 K2\nEND\n"));
    assert!(calls("LD X0\nWSFL D0Z0 D10Z1 K20 K17\nEND\n"));
    assert!(calls("LD X0\nZRST M8000 M8100\nEND\n"));
    assert!(!calls("LD X0\nDFMOV K1 D0 K9\nEND\n"));
    assert!(calls("LD X0\nZRST T0 T64\nEND\n"));
    // Devices that enter a shift one by one enter again where they overlap.
    assert!(calls("LD X0\nSFTL M0 M1 K20 K17\nEND\n"));
    assert!(!calls("LD X0\nBMOV D0 D10 K2\nLD X1\nOUT M8024\nEND\n"));
}

#[test]
fn long_runs_are_copied_and_filled_as_a_whole() {
    insta::assert_snapshot!(both(
        &on(ModelId::Fx3u),
        "LD X0\nBMOV D0 D10 K100\nBMOV D0 R0 K9\nFMOV D0 D0 K50\nZRST M0 M499\nZRST D300 D200\nZRST D200 D300\nSFTLP X0 M10 K400 K1\nSFTR M600 M0 K40 K20\nWSFLP D0 D1 K30 K3\nDECO D70 M100 K6\nEND\n"
    ));
}

#[test]
fn digits_and_times_are_inline() {
    insta::assert_snapshot!(lowered(
        "LD X0\nSMOV D0 K4 K2 D1 K3\nRCR D2 K1\nRCL D3 K4\nTCMP D4 K30 K0 D10 M0\nTZCP D4 D7 D10 M3\nDECO D20 D21 K4\nDECO M10 D22 K2\nEND\n"
    ));
    let calls = |text: &str| has_call(&module(&on(ModelId::Fx3u), text));
    assert!(calls("LD X0\nSMOV D0 K4 K2 D1 K3\nLD X1\nOUT M8168\nEND\n"));
    assert!(calls("LD X0\nRCR D2 D3\nEND\n"));
    assert!(calls("LD X0\nTZCP D4Z0 D7 D10 M3\nEND\n"));
}
