//! `convert --to plcopen`: what is written is a project by the schema, and reads back to the same list.

mod common;

use common::{MOTOR, code, folder, rungc, shown, text};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The instructions of a program, without comments and steps.
fn instructions(folder: &Path, file: &str, more: &[&str]) -> Vec<String> {
    let output = rungc(folder, &[&["convert", file, "--to", "il"], more].concat());
    let list = text(&output.stdout);
    assert!(!list.is_empty(), "{file}: {}", text(&output.stderr));
    let lines = list.lines().map(|line| {
        let line = line.split(';').next().unwrap_or_default();
        line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ')
            .trim()
    });
    lines
        .filter(|line| !line.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The programs of the documentation, with the models that they are for.
fn examples() -> Vec<(PathBuf, &'static [&'static str])> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/programs");
    let found = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let lists = found.filter(|path| path.extension().is_some_and(|e| e == "il"));
    lists
        .map(|path| {
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let model: &[_] = match name.as_str() {
                "cam" | "shear" => &["--model", "hm"],
                _ => &[],
            };
            (path, model)
        })
        .collect()
}

#[test]
fn examples_read_back_to_the_same_lists() {
    let folder = folder(&[]);
    let path = folder.path();
    let examples = examples();
    assert!(examples.len() > 5);
    for (program, model) in examples {
        let file = program.to_str().unwrap();
        for body in ["ld", "il"] {
            let args = [
                "--to", "plcopen", "--body", body, "-o", "plc.xml", "--force",
            ];
            let output = rungc(path, &[&["convert", file], &args[..], model].concat());
            let said = text(&output.stderr);
            assert!(
                output.status.success() && !said.contains("N0741"),
                "{file} as {body}: {said}"
            );
            let back = instructions(path, "plc.xml", model);
            assert_eq!(back, instructions(path, file, model), "{file} as {body}");
            follows_schema(&path.join("plc.xml"));
        }
    }
}

/// Checks a project by the schema of TC6, which may not be distributed with rungc: `RUNGC_TC6_SCHEMA` names its file.
fn follows_schema(project: &Path) {
    let Some(schema) = env::var_os("RUNGC_TC6_SCHEMA") else {
        eprintln!("skipped: RUNGC_TC6_SCHEMA does not name tc6_xml_v201.xsd");
        return;
    };
    let checked = Command::new("xmllint")
        .args(["--noout", "--schema"])
        .arg(schema)
        .arg(project)
        .output()
        .expect("xmllint (libxml2-utils) checks schemas");
    assert!(checked.status.success(), "{}", text(&checked.stderr));
}

#[test]
fn a_program_becomes_a_ladder() {
    let list = format!(";! title = Press\n;! X000 = start\n; Run-up\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let written = rungc(folder.path(), &["convert", "motor.il", "--to", "plcopen"]);
    assert_eq!(text(&written.stderr), "");
    insta::assert_snapshot!("plcopen_motor", text(&written.stdout));
}

#[test]
fn a_program_becomes_a_list_of_the_standard() {
    let list = "; Doors\n; of the lift\nLD X000\nOR M0\nANI X001\nMPS\nAND X003\nOUT Y000\nOUT T0 K30\nMRD\nLDI X004\nAND X005\n\
                OR M7\nANB\nSET Y001\nMPP\nINV\nMOV K5 D0\nADD D0 H10 D1\nAND T0\nPLS M1\nLDP T0\nAND>= D0 K10\nORF X002\n\
                CJ P1\nLDD= D0 D2\nMEP\n$MOV \"a, b\" D20\nP1\n; States\nSTL S0\nOUT Y002\nLD X002\nRST C0\nRET\nFEND\nI001\nIRET\nEND\n";
    let folder = folder(&[("doors.il", list.as_bytes())]);
    let path = folder.path();
    let args = ["convert", "doors.il", "--to", "plcopen", "--body", "il"];
    insta::assert_snapshot!("plcopen_list", shown(path, &args));
    let written = rungc(path, &[&args[..], &["-o", "plc.xml"]].concat());
    assert!(written.status.success());
    assert_eq!(
        instructions(path, "plc.xml", &[]),
        instructions(path, "doors.il", &[])
    );
    follows_schema(&path.join("plc.xml"));
    let back = text(&rungc(path, &["convert", "plc.xml", "--to", "il"]).stdout);
    assert!(
        back.starts_with("; Doors\n; of the lift\nLD X000\n"),
        "{back}"
    );
    assert_eq!(
        code(path, &["convert", "doors.il", "--to", "il", "--body", "il"]),
        2
    );
}

#[test]
fn what_other_editors_do_not_know_is_said() {
    let odd = "LD X000\nMPS\nAND D0.3\nINV\nOUT M0\nMRD\nANDD>= D0 K4M0\nOUT C0 K5\nMPP\nMEP\nOUT T0 D5\nLD T0\nRST T0\nSET D0.1\n\
               LDP M8013\nCJ P1\n$MOV \"a<b>\" D20\nP1\nLD X001\nBMOV D0Z0 D50 K3\nFEND\nI001\nIRET\nEND\n";
    let folder = folder(&[
        ("odd.il", odd.as_bytes()),
        ("form.il", b"LD X000\nLD X001\nANB\nOUT Y000\nEND\n"),
        ("broken.il", b"LD X000\nOUT Y000\nORB\nOUT Y001\nEND\n"),
    ]);
    let path = folder.path();
    let convert = |file: &'static str| {
        [
            "convert", file, "--to", "plcopen", "-o", "plc.xml", "--force",
        ]
    };
    insta::assert_snapshot!("plcopen_odd", shown(path, &convert("odd.il")));
    assert_eq!(
        instructions(path, "plc.xml", &[]),
        instructions(path, "odd.il", &[])
    );
    assert_eq!(
        code(path, &[&convert("odd.il")[..], &["--body", "il"]].concat()),
        0
    );
    assert_eq!(
        instructions(path, "plc.xml", &[]),
        instructions(path, "odd.il", &[])
    );
    follows_schema(&path.join("plc.xml"));
    insta::assert_snapshot!("plcopen_form", shown(path, &convert("form.il")));
    assert_eq!(
        instructions(path, "plc.xml", &[]),
        ["LD X000", "AND X001", "OUT Y000", "END"]
    );
    fs::remove_file(path.join("plc.xml")).unwrap();
    insta::assert_snapshot!("plcopen_undrawn", shown(path, &convert("broken.il")));
    assert!(!path.join("plc.xml").exists());
    assert_eq!(code(path, &["explain", "E0740"]), 0);
}
