//! The examples that have a machine around them run whole on every engine.

use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plctest::{self, Suite, TestFile};
use std::path::{Path, PathBuf};

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

#[test]
fn all_engines_move_the_machines_alike() {
    let suite = Suite::compile(load_all());
    assert!(!suite.is_empty());
    assert!(suite.cases().all(|(_, case)| case.machine.is_some()));
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("machines");
    for kind in EngineKind::ALL {
        let mut engine =
            build(kind, suite.modules(), &target).unwrap_or_else(|error| panic!("{error}"));
        let report = plctest::run(&suite, &mut *engine, &mut |_| ());
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
