//! Warnings about instructions in zones of master control, about operands at the end of their range, and errors that
//! leave no warning beside them.

use crate::warnings::{judge, judge_on};
use rungc_frontend::read_text;
use rungc_lower::compile::{CompileOptions, check};
use rungc_models::ModelId;

/// The diagnostics of a program, as code and help, in the order of the program.
fn found(model: ModelId, lines: &str) -> Vec<(&'static str, String)> {
    let text = format!("{}\nEND\n", lines.replace(" / ", "\n"));
    let options = CompileOptions {
        model: Some(model),
        ..CompileOptions::default()
    };
    let diagnostics = check(&read_text("program", &text).program, &options).diagnostics;
    let help = |help: Option<rungc_syntax::Phrase>| help.unwrap_or_default().to_string();
    let sorted = diagnostics.sorted().into_iter();
    sorted.map(|found| (found.code, help(found.help))).collect()
}

/// What drives an instruction in a zone is the zone's condition as well as its own contacts.
#[test]
fn zones_drive_what_is_in_them() {
    judge(
        "every-scan",
        &[
            "LD X0 / MC N0 M100 / LD X1 / INC D0 / MCR N0",
            "LD X0 / MC N0 M100 / LD M5 / OUT Y0 / MCR N0 / LD X1 / INC D0",
        ],
        &[
            "LDP X0 / MC N0 M100 / LD X1 / INC D0 / MCR N0",
            "LD X0 / MC N0 M100 / LDP X1 / MC N1 M101 / LD X2 / INC D0 / MCR N1 / MCR N0",
        ],
    );
    judge(
        "jumped-over",
        &["LD X0 / MC N0 M100 / LD X1 / OUT Y1 / MCR N0 / LD M8000 / CJ P1 / LD X5 / OUT Y5 / P1"],
        &["LD X0 / MC N0 M100 / LD M8000 / CJ P1 / LD X5 / OUT Y5 / P1 / MCR N0"],
    );
    judge(
        "endless-jump",
        &[
            "LD X0 / MC N0 M100 / P0 / LD X1 / OUT Y1 / LD M8000 / CJ P0 / MCR N0",
            "P0 / LD X0 / MC N0 M100 / LD X1 / OUT Y1 / MCR N0 / LD M8000 / CJ P0",
        ],
        &["P0 / LD X0 / MC N0 M100 / LD X1 / OUT Y1 / LD M8000 / CJ P0 / MCR N0"],
    );
    let two = |second: &str| {
        format!(
            "LD X10 / MC N0 M100 / LD M8000 / PLSY K1000 K0 Y0 / MCR N0 / {second} / MC N0 M101 / LD M8000 \
             / PLSR K1000 K500 K100 Y0 / MCR N0"
        )
    };
    judge("one-output", &[&two("LD X10")], &[&two("LDI X10")]);
}

/// A word holds all bits of DECO and ENCO, and texts may take half as many words.
#[test]
fn the_last_registers_of_a_range() {
    for (line, codes) in [
        ("DECO D0 D7999 K3", &[][..]),
        ("DECO D7999 D0 K4", &[]),
        ("ENCO D7999 D0 K4", &[]),
        ("DECO D0 D511 K3", &[]),
        ("ASC \"ABCD\" D7996", &[]),
        ("PR D7996 Y20", &[]),
        ("PID D0 D1 D7975 D3", &[]),
        ("DECO D0 M7673 K3", &["E0108"]),
        ("ENCO M7673 D0 K3", &["E0108"]),
        ("ASC \"ABCD\" D7997", &["E0108"]),
    ] {
        let given = found(ModelId::Fx3u, &format!("LD X0 / {line}"));
        let given: Vec<_> = given.into_iter().map(|(code, _)| code).collect();
        assert_eq!(given, codes, "{line}");
    }
}

#[test]
fn an_error_in_operands_is_the_only_report() {
    for (model, line, code) in [
        (ModelId::Hm, "ZRST D10 D0", "E0111"),
        (ModelId::H2u, "ZRST D10 D0", "E0111"),
        (ModelId::Fx3u, "ABSD K4M12 C0 M100 K1", "E0110"),
        (ModelId::Fx3u, "DMOV K1 D8511", "E0108"),
    ] {
        let codes: Vec<_> = found(model, &format!("LD X0 / {line}"))
            .into_iter()
            .map(|(code, _)| code)
            .collect();
        assert_eq!(codes, [code], "{line}");
    }
}

#[test]
fn special_devices_that_programs_write_or_read_with_others() {
    let carry = "LDP X0 / SET M8022 / RCRP D0 K1";
    let late = "LD M8002 / MOV H81 D8120 / LD M8000 / RS D100 K8 D200 K20 / LD M8129 / RST M8129";
    for model in [ModelId::Fx3u, ModelId::Fx2n, ModelId::H2u] {
        judge_on(
            model,
            "writes-read-only",
            &["LD X0 / SET M8021"],
            &[carry, late],
        );
    }
    judge(
        "inert-device",
        &["LD X0 / DMOV D8312 D0", "LD X0 / MOV D8313 D0"],
        &[],
    );
    judge(
        "undefined-special",
        &[
            "LD X0 / MOV K1M8010 D0",
            "LD M8010 / OUT Y0",
            "LD X0 / DMOV D8099 D0",
        ],
        &["LD X0 / MOV K4M8000 D0", "LD X0 / BMOV D8099 D0 K3"],
    );
}

/// The program's init routine, and one of two protocols by a switch.
#[test]
fn set_up_of_ports_in_the_first_scan() {
    let late = "port-set-late";
    let routine = "FEND / P0 / LD M8000 / MOV H2 D8126 / MOV K1 D8121 / SRET";
    let [by, nested, unsure, state] = [
        format!("LD M8002 / CALL P0 / {routine}"),
        format!("LD M8000 / CALL P1 / {routine} / P1 / LD M8002 / CALL P0 / SRET"),
        format!("LD X0 / CALL P0 / {routine}"),
        format!("LD X0 / MC N0 M9 / LD M8002 / CALL P0 / MCR N0 / {routine}"),
    ];
    judge_on(
        ModelId::H2u,
        late,
        &[
            &unsure,
            &state,
            "LD X0 / MOV H2 D8126 / LD X1 / MOV H20 D8126",
            "LDI X0 / MOV H2 D8126",
        ],
        &[
            &by,
            &nested,
            "LD M8002 / MC N0 M9 / LD M8000 / MOV H2 D8126 / MCR N0",
            "LD X0 / MOV H2 D8126 / LDI X0 / MOV H20 D8126",
        ],
    );
    // The main program overwrites what the routine has set, as the routine comes first in the scan.
    let both = format!("LD M8002 / CALL P0 / LD M8002 / MOV H20 D8126 / {routine}");
    judge_on(ModelId::H2u, "port-set-twice", &[&both], &[&by]);
}

#[test]
fn timers_to_use_in_routines_keep_their_value_if_the_other_did() {
    let help = |timer: &str| {
        let all = found(
            ModelId::Fx3u,
            &format!(
                "LD X0 / CALL P0 / LD {timer} / OUT Y0 / RST {timer} / FEND / P0 / LD X1 / OUT {timer} K10 / SRET"
            ),
        );
        all.into_iter()
            .find(|(code, _)| *code == "W0213")
            .map(|(_, help)| help)
    };
    insta::assert_snapshot!(
        ["T0", "T200", "T250"]
            .map(|timer| help(timer).unwrap_or_default())
            .join("\n")
    );
}
