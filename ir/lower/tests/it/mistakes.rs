//! Programs with one mistake each, as people make them: one mistake is one error, at its place, and the help states
//! what to write.

use crate::rendered::{findings, shown};
use rungc_lower::compile::CompileOptions;
use rungc_models::ModelId;
use rungc_syntax::{Program, Severity, SourceKind};
use std::fmt::Write;

/// Diagnostics of each program, after its text.
fn pages(model: ModelId, programs: &[&str]) -> String {
    let mut pages = String::new();
    for program in programs {
        let shown = shown(model, program);
        write!(pages, "--- {}\n{shown}\n", program.replace('\n', " / ")).expect("a string");
    }
    pages
}

/// Each of these programs has one finding in all, an error.
fn one_error_each(model: ModelId, programs: &[&str]) {
    for program in programs {
        let (_, found) = findings(model, program);
        let errors = found.iter().filter(|d| d.severity == Severity::Error);
        assert!(
            found.len() == 1 && errors.count() == 1,
            "{program}\n{}",
            shown(model, program)
        );
    }
}

/// A typing error in what begins, ends or names a part of the program.
const STRUCTURE: &[&str] = &[
    "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMCR NO\nEND\n",
    "LD X0\nMC N0 M100\nLD X1\nOUT Y0\nMRC N0\nEND\n",
    "LD X0\nMC NO M100\nLD X1\nOUT Y0\nMCR N0\nEND\n",
    "FOR 3\nLD X0\nOUT Y0\nNEXT\nEND\n",
    "FRO K3\nLD X0\nOUT Y0\nNEXT\nEND\n",
    "FOR K3\nLD X0\nOUT Y0\nNEXT K\nEND\n",
    "FOR K3\nLD X0\nOUT Y0\nNEXT K3\nEND\n",
    "FOR K3\nLD X0\nOUT Y0\nNXT\nEND\n",
    "FORK3\nLD X0\nOUT Y0\nNEXT\nEND\n",
    "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRE\nEND\n",
    "LD X0\nCALL P1\nFEND\nP1\nLD X1\nOUT Y0\nRTE\nEND\n",
    "EI\nFEND\nI001\nLD X1\nOUT Y0\nIRT\nEND\n",
    "LD M8002\nSET S0\nSTL S0\nLD X0\nOUT Y0\nRTE\nEND\n",
    "LD M8002\nSET S0\nSTL SO\nLD X0\nOUT Y0\nRET\nEND\n",
    "LD M8002\nSET S0\nSLT S0\nLD X0\nOUT Y0\nRET\nEND\n",
    "LD M8002\nSET S0\nSTLS0\nOUT Y0\nRET\nEND\n",
    "LD X0\nOUT Y0\nEDN\n",
    "LD X0\nOUT Y0\nEN\n",
    "LD X0\nCALL P1\nFEN\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCALL P1\nFEND\nP 1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCALL P1\nFEND\nPI\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCALL PI\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCALL P\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCALLP1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCLAL P1\nFEND\nP1\nLD X1\nOUT Y0\nSRET\nEND\n",
    "LD X0\nCJ PO\nLD X1\nOUT Y0\nP0\nEND\n",
    "LD X0\nJMP P0\nLD X1\nOUT Y0\nP0\nEND\n",
];

#[test]
fn a_typing_error_in_the_structure_is_one_error() {
    one_error_each(ModelId::Fx3u, STRUCTURE);
    insta::assert_snapshot!(pages(ModelId::Fx3u, STRUCTURE));
}

/// A broken operand: its devices count as used, and its rung as complete.
const OPERANDS: &[&str] = &[
    "LD X0\nOUT T0 30\nLD T0\nOUT Y0\nEND\n",
    "LD X0\nOUT TO K30\nLD T0\nOUT Y0\nEND\n",
    "LD X0\nOUT MO\nLD M0\nOUT Y0\nEND\n",
    "LD X0\nOUTM0\nLD M0\nOUT Y0\nEND\n",
    "LD X0\nOTU M0\nLD M0\nOUT Y0\nEND\n",
    "LD X0\nOUT M\nLD M0\nOUT Y0\nEND\n",
    "LD MO\nOUT Y0\nLD X0\nOUT M0\nEND\n",
    "LD X0\nMOV 0x1F D0\nEND\n",
    "LD X0\nDEADD D0 1.5 D2\nEND\n",
    "LD X0\nMOV 1.5 D0\nEND\n",
    "LD X0\nADDP D0 -0.5 D2\nEND\n",
    "LD X0\nWAND D0 1.5 D2\nEND\n",
    "LD X0\nMOV 4X000 D0\nEND\n",
    "LD X0\nMOV K 1 D0\nEND\n",
    "LD X0 ; start\nOUT Y0 # lamp\nEND\n",
    "LD X0\nMOV K5 M0\nEND\n",
    "LD X0\nOUT D0\nEND\n",
    "LD X0\nOUT T0 K40000\nLD T0\nOUT Y0\nEND\n",
    "LD X0\nOUT C256 K3\nLD X1\nOUT Y0\nEND\n",
    "LD X0\nPLSY K100 K0 Y005\nEND\n",
    "LD X0\nZRST D0 M10\nEND\n",
    "LD X0\nMOV bSpeed D0\nEND\n",
];

#[test]
fn a_broken_operand_is_one_error() {
    one_error_each(ModelId::Fx3u, OPERANDS);
    insta::assert_snapshot!(pages(ModelId::Fx3u, OPERANDS));
}

/// Operands that one check finds wrong and another could find wrong once more.
#[test]
fn an_error_in_an_operand_is_reported_once() {
    let rungs = [
        "OUT Y9999",
        "OUT X9",
        "OUT K5Y9",
        "OUT Y888Z0",
        "OUT Y 9999",
        "MOV K1 D99999999999",
        "ZRST Y9 Y17",
        "ZRST D0 Q5",
        "ZRST D0 M99999",
        "MOV P9999 D0",
        "MOV I9999 D0",
        "CALL P9999",
        "CJ P9999",
        "OUT D99999 K5",
        "OUT P5 K5",
        "BMOVP D0 D10 K99999",
        "MC C300 M0\nLD X1\nOUT Y1\nMCR N0",
    ];
    let programs = rungs.map(|rung| format!("LD X0\n{rung}\nEND\n"));
    one_error_each(ModelId::Fx3u, &programs.each_ref().map(String::as_str));
    // A program in one line.
    let lines = [
        "LD X0 OUT Y0 END",
        "0 LD X0 1 AND X1 2 OUT Y0 3 END",
        "LD X0, OUT Y0, END\n",
        "LD X0; OUT Y0; END",
        "LD X0 // OUT Y0 // END\n",
    ];
    one_error_each(ModelId::Fx3u, &lines);
    for line in lines {
        assert!(
            pages(ModelId::Fx3u, &[line]).contains("each instruction on its own line"),
            "{line}"
        );
    }
}

/// Names of instructions that do not exist.
const NAMES: &[&str] = &[
    "LD X0\nMPS\nAND X1\nOUT Y0\nMP\nOUT Y1\nEND\n",
    "LDN X0\nOUT Y0\nEND\n",
    "LDD X0\nOUT Y0\nEND\n",
    "LDD D0 K5\nOUT Y0\nEND\n",
    "LD X0\nOUTN Y0\nEND\n",
    "LD X0\nOUTY0\nEND\n",
    "LD X0\nMOVK1D0\nEND\n",
    "LD X0\nPMOV K1 D0\nEND\n",
    "LD X0\nMOVD K1 D0\nEND\n",
    "LD X0\nMOVE K1 D0\nEND\n",
    "LD X0 OUT Y0\nEND\n",
    "0 LD X0 1 AND X1 2 OUT Y0\nEND\n",
    "LD \u{425}000\nOUT Y0\nEND\n",
    "LD X0\n\u{41e}UT Y0\nEND\n",
    "LD X0\n(* motor *)\nOUT Y0\nEND\n",
];

#[test]
fn an_unknown_name_is_one_error() {
    one_error_each(ModelId::Fx3u, NAMES);
    insta::assert_snapshot!(pages(ModelId::Fx3u, NAMES));
}

#[test]
fn classes_that_the_model_does_not_have() {
    let programs = ["LD X0\nMOV K3 R0\nEND\n"];
    one_error_each(ModelId::Fx2n, &programs);
    insta::assert_snapshot!(pages(ModelId::Fx2n, &programs));
}

/// Blocks and branches that do not close: the help states what to add or take away.
const LOGIC: &[&str] = &[
    "LD X0\nMPP\nOUT Y0\nEND\n",
    "LD X0\nMPS\nAND X1\nOUT Y0\nEND\n",
    "LD X0\nANB\nOUT Y0\nEND\n",
    "LD X0\nFOR K2\nLD X1\nOUT Y0\nNEXT\nEND\n",
    "LD X0\nOUT Y0\nLD X1\nCJ P1\nP1\nP1\nEND\n",
];

#[test]
fn logic_that_does_not_close() {
    insta::assert_snapshot!(pages(ModelId::Fx3u, LOGIC));
}

/// Programs in other languages are reported once, not line by line.
const LANGUAGES: &[&str] = &[
    "LD %IX0.0\nANDN %IX0.1\nST %QX0.0\n",
    "PROGRAM Motor\nVAR\n  Run : BOOL;\nEND_VAR\nLD Run\nST Lamp\nEND_PROGRAM\n",
    "IF X0 THEN\n  Y0 := TRUE;\nEND_IF;\n",
    "Y0 := X0 AND NOT X1;\n",
    "<?xml version=\"1.0\"?>\n<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\">\n</project>\n",
];

#[test]
fn another_language_is_one_error() {
    one_error_each(ModelId::Fx3u, LANGUAGES);
    insta::assert_snapshot!(pages(ModelId::Fx3u, LANGUAGES));
}

/// An unknown code of a project may be the NEXT that seems to be missing; a line of a list that is not an instruction
/// is not.
#[test]
fn an_unknown_code_may_be_any_instruction() {
    let list = "FOR K3\nLD X0\nOUT Y0\n= Y1\nLD X1\nOUT Y1\nEND\n";
    let mut program = rungc_frontend::read_text("program", list).program;
    let errors = |program: &Program| {
        let checked = rungc_lower::compile::check(program, &CompileOptions::default());
        let codes = checked.diagnostics.iter().map(|d| d.code);
        codes.collect::<Vec<_>>()
    };
    assert_eq!(errors(&program), ["E0412"]);
    program.kind = SourceKind::GxWorks2;
    assert!(errors(&program).is_empty());
}

#[test]
fn comparisons_of_other_languages_keep_their_sense() {
    let rows = [
        ("LDI= D0 K1", "LD<>"),
        ("LDDI> D0 K1", "LDD<="),
        ("LD!= D0 K1", "LD<>"),
        ("LD== D0 K1", "LD="),
        ("LD X0\nANI= D0 K1", "AND<>"),
        ("LD X0\nANDN< D0 K1", "AND>="),
        ("LD X0\nORI> D0 K2", "OR<="),
        ("LD X0\nORI<> D0 K2", "OR="),
    ];
    for (lines, right) in rows {
        let (_, found) = findings(ModelId::Fx3u, &format!("{lines}\nOUT Y0\nEND\n"));
        let [error] = found.as_slice() else {
            panic!("{lines}: {found:?}");
        };
        let help = error.help.as_deref().expect("a help");
        assert!(help.ends_with(&format!("`{right}`")), "{lines}: {help}");
        let fix = error.fix.as_ref().expect("a fix");
        assert_eq!(fix.edits[0].text, right, "{lines}");
    }
}

#[test]
fn numbers_get_what_their_operand_names() {
    let rows = [
        ("OUT T0 5", Some("K5")),
        ("CALL 1", Some("P1")),
        ("CJ 5", Some("P5")),
        ("MC 0 M0", Some("N0")),
        ("STL 20", Some("S20")),
        ("IST X20 20 S27", Some("S20")),
        ("SET 5", None),
        ("OUT 19", None),
        ("AND 7", None),
        // Names of instructions, where a jump or call awaits a label.
        ("CALL SUB", None),
        ("CJ NEXT", None),
    ];
    for (line, fix) in rows {
        let (_, found) = findings(ModelId::Fx3u, &format!("LD X0\n{line}\nEND\n"));
        let error = found.iter().find(|d| matches!(d.code, "E0002" | "E0017"));
        let error = error.unwrap_or_else(|| panic!("{line}: {found:?}"));
        let text = error.fix.as_ref().map(|fix| &*fix.edits[0].text);
        assert_eq!(text, fix, "{line}");
        let help = error.help.as_deref().expect("a help");
        let constant = help.contains("constant") || fix.is_none() && help.contains("`K");
        assert!(!constant, "{line}: {help}");
    }
}

/// `OUT T0 K50` in two lines, as editors copy lists.
#[test]
fn operands_on_a_line_without_their_instruction() {
    let divided = shown(ModelId::Fx3u, "LD X0\nOUT T0\nK50\nLD T0\nOUT Y0\nEND\n");
    let help = "`K50` is an operand: write it on the line of its instruction";
    assert!(divided.contains(help), "{divided}");
}
