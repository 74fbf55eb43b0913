//! Presentation of diagnostics: a snapshot of each code's wrong example, and of programs that show details. The right
//! example of a code has no error and not that code.

use crate::rendered::{findings, render, shown};
use rungc_frontend::read_text;
use rungc_lower::compile::CompileOptions;
use rungc_models::ModelId;
use rungc_syntax::diag::apply;
use rungc_syntax::{Severity, codes};
use std::fmt::Write;

/// The model that the examples of a code are for.
fn model_of(code: &codes::Code) -> ModelId {
    code.model.map_or(ModelId::Fx3u, |name| {
        ModelId::from_name(name).expect("a model")
    })
}

#[test]
fn wrong_examples_show_their_code() {
    let mut pages = String::new();
    for code in codes::all()
        .into_iter()
        .filter(|code| !code.wrong.is_empty())
    {
        let (source, diagnostics) = findings(model_of(code), code.wrong);
        let rendered = render(&source, &diagnostics);
        assert!(
            diagnostics
                .iter()
                .any(|diagnostic| diagnostic.code == code.id),
            "{} is not shown:\n{rendered}",
            code.id
        );
        write!(
            pages,
            "--- {} {}\n{}\n{rendered}\n",
            code.id, code.name, code.wrong
        )
        .expect("a string");
    }
    insta::assert_snapshot!(pages);
}

#[test]
fn right_examples_are_right() {
    for code in codes::all()
        .into_iter()
        .filter(|code| !code.right.is_empty())
    {
        let (source, diagnostics) = findings(model_of(code), code.right);
        let wrong = diagnostics
            .iter()
            .any(|diagnostic| diagnostic.severity == Severity::Error || diagnostic.code == code.id);
        assert!(!wrong, "{}:\n{}", code.id, render(&source, &diagnostics));
    }
}

#[test]
fn devices_and_operands() {
    let text = "\
LD X400
OUT Y400
LD D0
OUT X1
LD X0
MOV K5 K10
MOV M5 D0
MOV D0V9 D1
MOV R0 D0
MOV D0
ADD
MOV D0 D1 D2
BMOV D0 D7990 K20
DMOV K8M3060 D0
OUT T0
OUT Y0 K1
OUT C0 K32768
OUT T1 K-5
OUT C1 K-1
OUT C200 K32768
SET T0
MC N8 M100
MCR N8
CJ K1
ROL K2M0 K17
END
";
    insta::assert_snapshot!(shown(ModelId::H2u, text));
}

#[test]
fn mnemonics() {
    let text = "\
LD X0
OTU Y0
MOVPP D0 D1
ABSD D0 C0 M0 K1
PIDP D0 D1 D100 D200
EADD D0 D2 D4
DHSCS K1 C235 Y0
FROM K0 K0 D0 K1
XYZZY D0
END
";
    insta::assert_snapshot!(shown(ModelId::Fx2n, text));
}

#[test]
fn labels_out_of_range() {
    let text = "EI\nLD X0\nCJ P128\nP128\nFEND\nI900\nIRET\nP200\nSRET\nEND\n";
    insta::assert_snapshot!(shown(ModelId::H2u, text));
}

#[test]
fn rungs() {
    let text = "\
LD X0
AND X1
OUT Y0
LD X2
OR X3
ANB
OUT Y1
LD X0
LD X1
ORB
LD X2
LD X3
ANB
OUT Y2
ANB
OUT Y3
LD X4
MPS
AND X5
OUT Y4
LD X6
OUT Y5
MPP
OUT Y6
LD X7
END
";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

/// Certain findings about a branch or a label have a fix, and the program is right after it.
#[test]
fn certain_fixes_make_branches_and_labels_right() {
    let mut pages = String::new();
    for text in [
        "LD X0\nMPS\nAND X1\nOUT Y0\nMRD\nAND X2\nOUT Y1\nMRD\nOUT Y2\nLD X3\nOUT Y3\nEND\n",
        "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nAND X2\nOUT Y1\nMPP\nAND X3\nOUT Y2\nMPP\nOUT Y3\nEND\n",
        "LD X0\nCJ P63\nLD X1\nOUT Y0\nP63\nEND\n",
    ] {
        let (source, diagnostics) = findings(ModelId::Fx3u, text);
        let fixes = diagnostics.iter().filter_map(|d| d.fix.as_ref());
        let certain: Vec<_> = fixes.filter(|fix| fix.certain).collect();
        let (fixed, _) = apply(text, &certain);
        let (again, left) = findings(ModelId::Fx3u, &fixed);
        let errors = left.iter().any(|d| d.severity == Severity::Error);
        assert!(!errors, "{fixed}{}", render(&again, &left));
        write!(
            pages,
            "{text}---\n{}---\n{fixed}\n",
            render(&source, &diagnostics)
        )
        .expect("a string");
    }
    insta::assert_snapshot!(pages);
}

/// An MPP without MPS in another rung says nothing about the branch before.
#[test]
fn a_return_in_another_rung_has_no_fix() {
    let text = "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nOUT Y1\nLD X2\nMPP\nOUT Y2\nEND\n";
    let (_, diagnostics) = findings(ModelId::Fx3u, text);
    let [only] = &diagnostics[..] else {
        panic!("one finding: {diagnostics:?}");
    };
    assert_eq!((only.code, &only.fix), (codes::NO_BRANCH.id, &None));
}

#[test]
fn an_unknown_instruction_causes_nothing_else() {
    let text = "LDX X0\nMPS\nAND X1\nOUT Y0\nMPP\nFOO Y1\nLD X1\nBAR\nANB\nOUT Y2\nEND\n";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

#[test]
fn structures_that_cross_are_reported_once() {
    let text = "\
LD X0
MC N0 M100
FOR K2
STL S0
MCR N0
NEXT
RET
FOR K3
FEND
NEXT
P1
SRET
END
";
    insta::assert_snapshot!(shown(ModelId::H2u, text));
}

#[test]
fn routines_may_go_on_behind_a_return() {
    let text = "\
LD X0
CALL P1
FEND
P1
LD X1
CJ P2
LD X2
OUT Y0
SRET
P2
LD X3
OUT Y1
SRET
END
";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

#[test]
fn a_missing_label_is_shown_where_it_is_named() {
    let places = |text: &str| -> Vec<_> {
        let (source, diagnostics) = findings(ModelId::H2u, text);
        let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error);
        errors
            .map(|d| (d.code, source.slice(d.span).to_owned()))
            .collect()
    };
    let call = "LD X0\nCALL P3\nEND\n";
    assert_eq!(places(call), [("E0430", "P3".to_owned())]);
    let jump = "LD X0\nCJ P1 P2\nP1\nEND\n";
    assert_eq!(places(jump), [("E0302", "P2".to_owned())]);
}

#[test]
fn calls_in_a_circle() {
    let text = "\
LD X0
CALL P1
FEND
P1
LD X1
CALL P2
SRET
P2
LD X1
CALL P1
SRET
END
";
    insta::assert_snapshot!(shown(ModelId::H2u, text));
}

#[test]
fn coils_in_states_and_under_jumps() {
    let text = "\
LD M8002
SET S0
STL S0
OUT Y0
LD X0
SET S20
STL S20
OUT Y0
LD X1
OUT Y1
LD X2
OUT Y1
RET
LD X10
CJ P1
LD X11
OUT Y2
P1
LDI X10
CJ P2
LD X12
OUT Y2
P2
LD X13
OUT Y3
LD X14
OUT Y3
LD X15
OUT Y3
END
";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

#[test]
fn relays_with_one_half() {
    let text = "\
LD M1
OUT M2
LD T5
OR C7
OUT M3
LD M10
MOV K1M20 D0
MOV D0 K2M40
LD M41
OUT M21
LD X0
RST M50
LD M50
OUT Y0
END
";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

#[test]
fn an_index_register_may_reach_any_relay() {
    let text = "LD X0\nMOV K1M0Z0 D0\nOUT M5\nEND\n";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

/// System registers of HM below the special ones, which are ordinary registers where a program writes them.
#[test]
fn inert_devices_below_the_special_ones() {
    let text =
        "LD M8000\nMOV D204 D0\nMOV D7200 D1\nMOV K5 D7300\nMOV D7300 D2\nMOV D8044 D3\nEND\n";
    insta::assert_snapshot!(shown(ModelId::Hm, text));
}

#[test]
fn inert_devices() {
    let text = "\
LD M8002
MOV K3 D8406
MOV K200 D8000
SET M8391
MOV K50 D8393
LD M8005
OR M8063
OUT Y0
RST M8162
LD M8151
OR M8152
OR M8153
OR M8159
OUT Y1
LD M8000
MOV K1 D8393
MOV K0 D8100
ZRST D8074 D8080
RST M8028
END
";
    insta::assert_snapshot!(shown(ModelId::Fx3u, text));
}

/// Diagnostics about the CPU type that a source names.
fn about_cpu(cpu: &str) -> String {
    let text = format!(";! cpu = {cpu}\nLD X0\nOUT Y0\nEND\n");
    let read = read_text("program", &text);
    let checked = rungc_lower::compile::check(&read.program, &CompileOptions::default());
    let found = render(&read.program.source, &checked.diagnostics.sorted());
    format!("{cpu}: {}\n{found}", checked.model.name)
}

#[test]
fn errors_of_a_chosen_model_name_the_cpu_of_the_source() {
    let notes = |cpu: &str, list: &str, model| {
        let read = read_text("program", &format!("{cpu}{list}"));
        let options = CompileOptions {
            model: Some(model),
            ..CompileOptions::default()
        };
        let found = rungc_lower::compile::check(&read.program, &options).diagnostics;
        let notes = found.iter().filter(|d| d.code == codes::OTHER_CPU.id);
        notes.map(|d| d.message.to_string()).collect::<Vec<_>>()
    };
    let cpu = ";! cpu = FX3U\n";
    let wrong = "LD X0\nDEADD D0 D2 D4\nOUT Y0\nEND\n";
    let said = "`--model` or rungc.toml says fx1s, but the program names CPU type FX3U";
    assert_eq!(notes(cpu, wrong, ModelId::Fx1s), [said]);
    for (cpu, list, model) in [
        (cpu, wrong, ModelId::Fx3u),
        (cpu, "LD X0\nOUT Y0\nEND\n", ModelId::Fx1s),
        ("", wrong, ModelId::Fx1s),
        (cpu, "LD X9\nOUT Y0\nEND\n", ModelId::Fx3u),
    ] {
        assert!(notes(cpu, list, model).is_empty(), "{cpu} {model:?}");
    }
}

#[test]
fn cpu_types_name_models() {
    let cpus = [
        "FX1S",
        "FX1NC",
        "FX2N/FX2NC",
        "fx3ge",
        "FX0/FX0S",
        "FX0N",
        "FX2/FX2C",
        "Q02UCPU",
    ];
    insta::assert_snapshot!(cpus.map(about_cpu).join("\n"));
}

#[test]
fn values_that_only_compatible_boards_take() {
    let text = "\
LD X0
RD3A K0 K0 D0
RD3A K0 K2 D0
RD3A K0 K3 D0
RD3A K7 K21 D0
RD3A K7 K22 D0
RD3A K7 K23 D0
WR3A K0 K0 D0
WR3A K0 K1 D0
WR3A K0 K2 D0
WR3A K0 K22 D0
IVRD H104 K0 D2 K10
IVRD H104 K0 D7990 K10
IVRD H101 K0 D7990 K100
IVWR H206 K0 D2 K2
IVWR H206 K0 D2 K3
IVRD H104 K0 D2 K2001
PLSY K100 K5 Y4
PLSY K100 K5 Y10
DRVI K100 K100 Y4 Y5
END
";
    insta::assert_snapshot!("values_on_fx3u", shown(ModelId::Fx3u, text));
    insta::assert_snapshot!(
        "values_on_fx3u_compatible",
        shown(ModelId::Fx3uCompatible, text)
    );
}

#[test]
fn rs_as_modbus_master() {
    let text = "\
LD X0
RS D0 K10 D100 K20
RS H0103 K100 K1 D10
RS H0103 K4000 D5 D10
RS D0 K4000 K1 D10
RS D0 K257 D100 K20
RS H0103 K100 K1 K2
END
";
    insta::assert_snapshot!("rs_on_h2u", shown(ModelId::H2u, text));
    insta::assert_snapshot!("rs_on_fx3u", shown(ModelId::Fx3u, text));
}

#[test]
fn instructions_that_a_manual_names_only() {
    let text = "LD X0\nDPTO D0 D10 K0\nLD X1\nCAP C235 D20\nEND\n";
    insta::assert_snapshot!(shown(ModelId::Hm, text));
}
