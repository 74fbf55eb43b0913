//! `convert --to plcopen`: what is written is a project by the schema, and reads back to the same list.

mod common;

use common::{MOTOR, code, folder, rungc, shown, text};
use rungc_frontend::{Names, ReadOptions, read_bytes_with};
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::Program;
use std::collections::BTreeSet;
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
    let list = format!(";! title = Press\n;! cpu = FX2N/FX2NC\n;! X000 = start\n; Run-up\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let path = folder.path();
    let written = rungc(path, &["convert", "motor.il", "--to", "plcopen"]);
    assert_eq!(text(&written.stderr), "");
    insta::assert_snapshot!("plcopen_motor", text(&written.stdout));
    fs::write(path.join("motor.xml"), &written.stdout).unwrap();
    let back = text(&rungc(path, &["convert", "motor.xml", "--to", "il"]).stdout);
    let expected = ";! title = Press\n;! cpu = FX2N/FX2NC\n;! X000 = start\n; Run-up\n";
    assert!(back.starts_with(expected), "{back}");
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

/// Balls that are sorted by size (h1u-h2u-programming §4.2.3), but that X03, not Y03, lets a flow begin: while S0 waits
/// for it, no state drives Y03.
const BALLS: &str = "\
LD M8002\nSET S0\nLD X01\nAND X03\nANI Y01\nOUT Y07\nSTL S0\nLD X26\nAND Y07\nSET S21\n\
STL S21\nOUT Y00\nOUT T0 K20\nLD T0\nAND X02\nSET S22\nLD T0\nANI X02\nSET S25\nSTL S22\n\
SET Y01\nOUT T1 K10\nLD T1\nSET S23\nSTL S25\nSET Y01\nOUT T1 K10\nLD T1\nSET S26\n\
STL S23\nOUT Y02\nLD X03\nSET S24\nSTL S26\nOUT Y02\nLD X03\nSET S27\nSTL S24\nLDI X04\n\
OUT Y03\nSTL S27\nLDI X05\nOUT Y03\nSTL S24\nLD X04\nSET S30\nSTL S27\nLD X05\nSET S30\n\
STL S30\nOUT Y00\nLD X02\nSET S31\nSTL S31\nRST Y01\nOUT T2 K10\nLD T2\nSET S32\nSTL S32\n\
OUT Y02\nLD X03\nSET S33\nSTL S33\nLDI X01\nOUT Y04\nLD X01\nOUT S0\nRET\nEND\n";

/// A pedestrians' crossing (h1u-h2u-programming §4.2.3).
const CROSSING: &str = "\
LD M8002\nSET S0\nSTL S0\nOUT Y03\nOUT Y05\nLD X00\nOR X01\nSET S21\nSET S30\nSTL S21\n\
OUT Y03\nOUT T0 K300\nLD T0\nSET S22\nSTL S30\nOUT Y05\nLD T2\nSET S31\nSTL S22\nOUT Y02\n\
OUT T1 K100\nLD T1\nSET S23\nSTL S31\nOUT Y06\nOUT T3 K150\nLD T3\nSET S32\nSTL S23\n\
OUT Y01\nOUT T2 K50\nSTL S32\nOUT T4 K5\nLD T4\nSET S33\nSTL S33\nOUT Y06\nOUT C0 K5\n\
OUT T5 K5\nLD C0\nAND T5\nSET S34\nLDI C0\nAND T5\nOUT S32\nSTL S34\nOUT Y05\nRST C0\n\
OUT T6 K50\nSTL S23\nSTL S34\nLD T6\nOUT S0\nRET\nEND\n";

/// Writes a step ladder as a chart, and gives both as programs.
fn as_chart(path: &Path, list: &str) -> [Program; 2] {
    fs::write(path.join("steps.il"), list).unwrap();
    let args = [
        "--to",
        "plcopen",
        "--body",
        "sfc",
        "-o",
        "chart.xml",
        "--force",
    ];
    let output = rungc(path, &[&["convert", "steps.il"], &args[..]].concat());
    assert!(output.status.success(), "{list}\n{}", text(&output.stderr));
    follows_schema(&path.join("chart.xml"));
    let options = ReadOptions {
        names: Names::parse("*,M500-M899\n").unwrap(),
        ..ReadOptions::default()
    };
    let chart = fs::read(path.join("chart.xml")).unwrap();
    let chart = read_bytes_with("chart.xml", &chart, &options).unwrap();
    assert!(chart.diagnostics.is_empty(), "{list}");
    let states = chart.program.instrs.iter();
    assert!(states.clone().all(|instr| instr.mnemonic != "STL"));
    let steps = read_bytes_with("steps.il", list.as_bytes(), &options).unwrap();
    [steps.program, chart.program]
}

/// The active states and outputs of two programs after each group of inputs has been on for `scans` scans of 30 ms;
/// `None` where they have not settled.
fn settled(
    programs: &[Program; 2],
    inputs: &[&[u32]],
    scans: u32,
) -> Vec<[Option<Vec<String>>; 2]> {
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        observe_all: true,
        ..CompileOptions::default()
    };
    let modules = programs.each_ref().map(|program| {
        let compiled = compile(program, &options);
        assert!(!compiled.diagnostics.has_errors());
        compiled.module.unwrap()
    });
    let mut machines = modules.each_ref().map(Machine::new);
    let mut found = Vec::new();
    for (nth, input) in (0..).zip(inputs) {
        found.push(machines.each_mut().map(|machine| {
            let mut last = Vec::new();
            for scan in 0..scans {
                for number in 0..0o50 {
                    machine.set_bit(Class::X, number, input.contains(&number));
                }
                machine.scan(&mut NoHal, (nth * scans + scan) * 30, 10_000);
                if scan + 5 >= scans {
                    let machine = &*machine;
                    let on = |class, name: &str, count: u32| {
                        let on = (0..count).filter(|n| machine.bit(class, *n) == Some(true));
                        on.map(|n| format!("{name}{n}")).collect::<Vec<_>>()
                    };
                    last.push([on(Class::S, "S", 100), on(Class::Y, "Y", 16)].concat());
                }
            }
            last.dedup();
            (last.len() == 1).then(|| last.remove(0))
        }));
    }
    found
}

#[test]
fn the_flows_of_the_manual_behave_alike_as_charts() {
    let folder = folder(&[]);
    let balls: &[&[u32]] = &[
        &[1, 3, 22],
        &[5],
        &[2],
        &[3],
        &[1],
        &[1, 2, 3, 22],
        &[4],
        &[2],
        &[3],
        &[1],
    ];
    let crossing: &[&[u32]] = &[&[], &[0], &[], &[], &[1], &[]];
    // Each group stays longer than the slowest timer runs.
    for (list, inputs, least) in [(BALLS, balls, 6), (CROSSING, crossing, 3)] {
        let programs = as_chart(folder.path(), list);
        let mut states = BTreeSet::new();
        for [steps, chart] in settled(&programs, inputs, 1100) {
            assert!(steps.is_some());
            assert_eq!(steps, chart);
            states.extend(steps);
        }
        assert!(states.len() >= least, "{states:?}");
    }
}

/// The first of the inputs that only actions read: one that led on, too, would find another step active in a chart.
const ACTION: u32 = 0o40;

/// A flow of states with choices, and with parallel branches that meet.
fn flow(rng: &mut impl FnMut(u32) -> u32) -> String {
    let mut list = "LD M8002\nSET S0\n".to_owned();
    let states = [0, 20, 21, 22, 23, 24, 25];
    for (nth, state) in states.into_iter().enumerate() {
        list += &format!("STL S{state}\nOUT Y{:o}\n", rng(5));
        list += &format!("LD X{:o}\nINV\nOUT Y{:o}\n", ACTION + rng(4), 5 + rng(2));
        list += &format!(
            "LDI X{:o}\nMPS\nOR X0\nOUT Y7\nMPP\nSET Y{:o}\n",
            ACTION + rng(4),
            8 + rng(2)
        )
        .replace("OR X0\n", "ANI X0\n");
        list += &format!("LD X{:o}\nRST Y{:o}\n", ACTION + rng(4), 8 + rng(2));
        let first = rng(8);
        for (way, input) in [(0, first), (1, 8 + first)]
            .into_iter()
            .take(1 + rng(2) as usize)
        {
            let to = states[(nth + 1 + rng(5) as usize + way) % states.len()];
            if to == state {
                continue;
            }
            list += &format!("LD X{input:o}\nAND X{input:o}\nOR X{:o}\n", first + 16);
            if way == 1 {
                list += &format!("ANI X{:o}\n", first + 16);
            }
            list += &format!("{} S{to}\n", if rng(2) == 0 { "SET" } else { "OUT" });
        }
        if state == 22 {
            list += "LD X30\nSET S30\nSET S31\n";
        }
    }
    list += "STL S30\nOUT Y12\nLD X31\nSET S32\nSTL S31\nOUT Y13\nSTL S32\nOUT Y14\nSTL S31\nSTL S32\nLD X32\nSET S0\nRET\nEND\n";
    list
}

#[test]
fn random_flows_behave_alike_as_charts() {
    let folder = folder(&[]);
    let mut seed = 1_u64;
    let mut rng = |below: u32| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as u32 % below
    };
    let mut compared = 0;
    for _ in 0..25 {
        let list = flow(&mut rng);
        let programs = as_chart(folder.path(), &list);
        // Before each input there is none: a state that ends has not seen it before.
        let inputs = (0..80).map(|nth| match (nth % 2, rng(5)) {
            (0, _) => Vec::new(),
            (_, 0) => vec![ACTION + rng(4)],
            _ => vec![rng(27)],
        });
        let inputs: Vec<_> = inputs.collect();
        let inputs: Vec<_> = inputs.iter().map(Vec::as_slice).collect();
        // Flows that an input leads in a circle drift apart.
        let found = settled(&programs, &inputs, 30);
        for [steps, chart] in found
            .into_iter()
            .take_while(|found| found.iter().all(Option::is_some))
        {
            assert_eq!(steps, chart, "{list}");
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}

#[test]
fn what_a_chart_cannot_say_names_the_state() {
    let cases = [
        "LD X000\nOUT Y000\nEND\n",
        "LD X000\nSET S0\nSTL S0\nOUT Y000\nRET\nEND\n",
        "LD M8002\nSET S0\nLD X000\nZRST S0 S20\nSTL S0\nOUT Y000\nRET\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nSET S20\nSTL S20\nOUT Y000\nRET\nLD S20\nOUT Y001\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nRST S0\nRET\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nLD X000\nCJ P0\nRET\nP0\nEND\n",
        "LD M8002\nSET S0\nSTL S0\nOUT Y000\nLD X000\nSET S20\nSTL S20\nSET Y000\nLD X001\nOUT S0\nRET\nEND\n",
    ];
    let said = cases.map(|list| {
        let folder = folder(&[("steps.il", list.as_bytes())]);
        let args = ["convert", "steps.il", "--to", "plcopen", "--body", "sfc"];
        assert_eq!(code(folder.path(), &args), 1, "{list}");
        shown(folder.path(), &args)
    });
    insta::assert_snapshot!("plcopen_chart_refused", said.join("\n"));
}

#[test]
fn a_step_ladder_becomes_a_chart() {
    let list = "; Ready\nLD X007\nOUT Y007\nLD M8002\nSET S0\nSTL S0 ; waits\nLD X000\nAND>= D0 K5\nSET S20\nSET S21\nLDP X001\nSET S22\n\
                STL S20\nOUT T0 K10\nSTL S21\nLDI X002\nMPS\nAND X003\nOUT Y001\nMPP\nMOV K5 D1\nSTL S20\nSTL S21\nLD T0\nOUT S0\n\
                STL S22\nLD X004\nOUT S0\nRET\nLD D1.0\nOUT Y006\nEND\n";
    let folder = folder(&[("steps.il", list.as_bytes())]);
    let path = folder.path();
    let args = ["convert", "steps.il", "--to", "plcopen", "--body", "sfc"];
    insta::assert_snapshot!("plcopen_chart", shown(path, &args));
    let names = "*,M500-M599\n";
    fs::write(path.join("free.csv"), names).unwrap();
    assert_eq!(code(path, &[&args[..], &["-o", "chart.xml"]].concat()), 0);
    follows_schema(&path.join("chart.xml"));
    let back = ["convert", "chart.xml", "--names", "free.csv", "--to", "il"];
    insta::assert_snapshot!("plcopen_chart_back", shown(path, &back));
}
