//! Programs with a machine around them run whole on every engine: the examples, and one with as many pulses as there can be.

use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plant;
use rungc_sim::plctest::{self, Suite, TestFile};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
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

#[test]
fn all_engines_move_the_machines_alike() {
    let mut files = load_all();
    assert!(!files.is_empty());
    files.push(fast());
    let suite = Suite::compile(files);
    assert!(suite.cases().all(|(_, case)| case.machine.is_some()));
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("machines");
    for kind in EngineKind::ALL {
        let mut engine =
            build(kind, suite.modules(), &target).unwrap_or_else(|error| panic!("{error}"));
        let begin = Instant::now();
        let report = plctest::run(&suite, &mut *engine, &mut |_| ());
        println!("{}: {:?}", kind.name(), begin.elapsed());
        let failures: Vec<_> = report.failures().map(|f| f.describe(&suite)).collect();
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    }
}

/// The first case of a test file is about the example beside it.
#[test]
fn the_tests_are_about_the_examples() {
    for file in load_all() {
        let path = file.name.replace(".plctest.toml", ".il");
        let program = std::fs::read_to_string(&path).unwrap();
        assert_eq!(file.cases[0].program.trim(), program.trim(), "{path}");
    }
}
