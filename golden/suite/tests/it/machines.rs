//! Programs run whole on every engine, most with a machine around them: the examples, and one with as many pulses as
//! there can be.

use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plant;
use rungc_sim::plctest::{self, Suite, TestFile};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

fn folder() -> PathBuf {
    Path::new(env!("RUNGC_ROOT")).join("examples/programs")
}

fn load_all() -> Vec<TestFile> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.to_string_lossy().ends_with(".plctest.toml"));
    paths.sort();
    let load = |path: &PathBuf| plctest::load(path).unwrap_or_else(|e| panic!("{e}"));
    paths.iter().map(load).collect()
}

/// Four outputs send 100,000 pulses a second, and two of them move encoders whose cycles are counted.
fn fast() -> TestFile {
    let test = r#"
model = "l01s"
topic = "pulses and encoders"
[[case]]
name = "a_second_at_100_khz"
program = """
LD M8000
DPLSY K100000 K0 Y000
DPLSY K100000 K0 Y001
DPLSY K100000 K0 Y002
DPLSY K100000 K0 Y003
OUT C251 K2000000
OUT C253 K2000000
END
"""
[[case.step]]
run_ms = 1000
expect = { "Y000.pulses" = 100000, "Y003.pulses" = 100000, "C251.value" = 100000, "C253.value" = 100000 }
expect_position = { Y000 = 100000, Y001 = 100000 }
"#;
    let machine = r#"
[[axis]]
output = "Y000"
encoder = { a = "X000", b = "X001" }
[[axis]]
output = "Y001"
encoder = { a = "X003", b = "X004" }
"#;
    let mut file = plctest::parse("fast.plctest.toml", test).unwrap_or_else(|e| panic!("{e}"));
    let machine = plant::parse("fast.toml", machine).unwrap_or_else(|e| panic!("{e}"));
    file.cases[0].machine = Some(Arc::new(machine));
    file
}

/// Programs that look for their origin, and one that continues from an interrupt input: model, name, program.
const SEARCHES: [(&str, &str, &str); 4] = [
    ("fx3u", "zrn", "LD M8000\nDZRN K20000 K500 X005 Y000\nEND\n"),
    (
        "h2u",
        "dszr",
        "LD M8002\nDMOV K20000 D8446\nMOV K500 D8445\nLD M8000\nDSZR X005 X004 Y000 Y004\nEND\n",
    ),
    (
        "fx3u",
        "dvit",
        "LD M8002\nSET M8336\nMOV HFFF5 D8336\nLD M8000\nDDVIT K-5000 K20000 Y000 Y004\nEND\n",
    ),
    // Its registers name X005 for the DOG and X004 for the zero signal.
    (
        "hm",
        "home",
        "LD M8002\nAXPO K0 K0 K1\nAXPU K0 K10 K0 K0\nAXSP K0 K500 K0\nAXAS K0 K50\nAXEI K0 K32 K16 K0 K0\n\
         AXOSP K0 K200 K5\nAXOX K0 H2003 K1 K0\nLD M8000\nHOME K0\nEND\n",
    ),
];

/// Position at which each of them comes to rest.
const RESTS: [f64; 4] = [-1.0, -91.0, -4000.0, -91.0];

/// Each with scans of several lengths: it comes to rest at the same place, though a scan may be longer than its switch
/// is on.
fn searches() -> TestFile {
    let machine = r#"
[[axis]]
output = "Y000"
start = 30000
home = "X005"
home_at = [0, 1000]
zero_phase = "X004"
zero_phase_every = 100
"#;
    let mut test = String::from("model = \"fx3u\"\ntopic = \"scan time\"\n");
    for ((model, name, program), rest) in SEARCHES.into_iter().zip(RESTS) {
        for scan_ms in [1, 10, 130, 1000] {
            test.push_str(&format!(
                "[[case]]\nname = \"{name}_{scan_ms}_ms\"\nmodel = \"{model}\"\nprogram = '''\n{program}'''\n\
                 [[case.step]]\nscan_ms = {scan_ms}\nrun_ms = 10000\n\
                 expect = {{ \"Y000.hz\" = 0 }}\nexpect_position = {{ Y000 = {rest} }}\n"
            ));
        }
    }
    let mut file = plctest::parse("searches.plctest.toml", &test).unwrap_or_else(|e| panic!("{e}"));
    let machine = plant::parse("searches.toml", machine).unwrap_or_else(|e| panic!("{e}"));
    let machine = Arc::new(machine);
    for case in &mut file.cases {
        case.machine = Some(machine.clone());
    }
    file
}

#[test]
fn all_engines_move_the_machines_alike() {
    let mut files = load_all();
    assert!(!files.is_empty());
    for file in &files {
        let beside = Path::new(&file.name.replace("plctest", "machine")).exists();
        assert!(
            file.cases
                .iter()
                .all(|case| case.machine.is_some() == beside),
            "{}",
            file.name
        );
    }
    files.push(fast());
    files.push(searches());
    let suite = Suite::compile(files, &[]);
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("machines");
    for kind in EngineKind::ALL {
        let mut engine =
            build(kind, suite.modules(), &target).unwrap_or_else(|error| panic!("{error}"));
        let begin = Instant::now();
        let report = plctest::run(&suite, &mut *engine, &mut |_| ControlFlow::Continue(()));
        println!("{}: {:?}", kind.name(), begin.elapsed());
        let failures: Vec<_> = report.failures().map(|f| f.describe(&suite)).collect();
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    }
}

/// The first case of a test file is about the example beside it, in whatever language that is.
#[test]
fn the_tests_are_about_the_examples() {
    for file in load_all() {
        let program = ["il", "st"]
            .map(|extension| file.name.replace("plctest.toml", extension))
            .into_iter()
            .find_map(|path| std::fs::read_to_string(path).ok());
        assert_eq!(
            Some(file.cases[0].program.text()),
            program.as_deref(),
            "{}",
            file.name
        );
    }
}
