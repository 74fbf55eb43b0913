//! Test files whose programs are separate files.

use rungc_models::ModelId;
use rungc_sim::engines::{EngineKind, build};
use rungc_sim::plctest::{self, Suite};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use tempfile::TempDir;

const LIST: &str = "LD X000\nOUT Y000\nEND\n";

/// The same as a list export without its head.
const EXPORT: &str =
    "\"0\",\"\",\"LD\",\"X000\"\n\"1\",\"\",\"OUT\",\"Y000\"\n\"2\",\"\",\"END\",\"\"\n";

const CASES: &str = r#"
topic = "OUT"
program = { file = "plc/FILE" }

[[case]]
name = "follows"
[[case.step]]
set = { X000 = 1 }
expect = { Y000 = 1 }

[[case]]
name = "separate"
model = "hm"
program = "LD M8000\nOUT Y001\nEND\n"
[[case.step]]
expect = { Y001 = 1 }
"#;

fn folder(name: &str, program: &str, settings: Option<&str>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |path: &str| folder.path().join(path);
    fs::create_dir(at("plc")).unwrap();
    fs::write(at("plc").join(name), program).unwrap();
    fs::write(at("t.plctest.toml"), CASES.replace("FILE", name)).unwrap();
    if let Some(settings) = settings {
        fs::write(at("plc/rungc.toml"), settings).unwrap();
    }
    folder
}

fn models(folder: &Path) -> Vec<ModelId> {
    let file = plctest::load(&folder.join("t.plctest.toml")).unwrap();
    file.cases.iter().map(|case| case.model).collect()
}

fn failures(folder: &Path) -> Vec<String> {
    let file = plctest::load(&folder.join("t.plctest.toml")).unwrap();
    let suite = Suite::compile(vec![file], &[]);
    let mut engine = build(EngineKind::Interp, suite.modules(), folder).unwrap();
    let report = plctest::run(&suite, engine.as_mut(), &mut |_| ControlFlow::Continue(()));
    report.failures().map(|f| f.describe(&suite)).collect()
}

#[test]
fn any_format_is_tested() {
    for (name, program) in [("a.il", LIST), ("a.csv", EXPORT)] {
        let folder = folder(name, program, None);
        assert_eq!(failures(folder.path()), [""; 0], "{name}");
    }
}

#[test]
fn the_model_is_the_projects_or_the_programs() {
    let plain = folder("a.il", LIST, None);
    assert_eq!(models(plain.path()), [ModelId::Fx3u, ModelId::Hm]);
    let named = folder("a.il", &format!(";! cpu = FX2N\n{LIST}"), None);
    assert_eq!(models(named.path()), [ModelId::Fx2n, ModelId::Hm]);
    let settings = "[project]\nmodel = 'h1u'\n";
    let chosen = folder("a.il", &format!(";! cpu = FX2N\n{LIST}"), Some(settings));
    assert_eq!(models(chosen.path()), [ModelId::H1u, ModelId::Hm]);
    assert_eq!(failures(chosen.path()), [""; 0]);
}

/// D200 to D511 are latched on FX3U, and among those for which that can be chosen.
#[test]
fn settings_say_what_is_latched() {
    let counts = "LD X000\nMOV K7 D200\nMOV K8 D300\nEND\n";
    let cases = r#"
topic = "latched"
program = { file = "plc/a.il" }
[[case]]
name = "kept"
[[case.step]]
set = { X000 = 1 }
[[case.step]]
power_cycle = true
set = { X000 = 0 }
expect = { D200 = 7, D300 = 0 }
"#;
    let folder = folder("a.il", counts, Some("[latched]\nD = 'D200-D299'\n"));
    fs::write(folder.path().join("t.plctest.toml"), cases).unwrap();
    assert_eq!(failures(folder.path()), [""; 0]);
    fs::write(folder.path().join("plc/rungc.toml"), "").unwrap();
    assert!(failures(folder.path())[0].contains("D300 is 8, expected 0"));
}

/// An access beyond the bound of an index is the PLC's error, in tests as in what is built.
#[test]
fn settings_bound_indexes() {
    let list = "LD X000\nMOV K9 Z0\nLD X000\nMOV K7 D100Z0\nEND\n";
    let cases = r#"
topic = "bound"
program = { file = "plc/a.il" }
[[case]]
name = "beyond"
[[case.step]]
set = { X000 = 1 }
expect = { D109 = 0 }
"#;
    let settings = "[project]\nprogram = 'a.il'\n[index]\n'D100Z0' = 'D100-D104'\n";
    let folder = folder("a.il", list, Some(settings));
    fs::write(folder.path().join("t.plctest.toml"), cases).unwrap();
    assert_eq!(failures(folder.path()), [""; 0]);
    fs::write(folder.path().join("plc/rungc.toml"), "").unwrap();
    assert!(failures(folder.path())[0].contains("D109 is 7, expected 0"));
}

#[test]
fn mistakes_have_their_place() {
    let wrong = folder("a.il", LIST, Some("[project]\nmodel = 'h9u'\n"));
    let why = plctest::load(&wrong.path().join("t.plctest.toml"))
        .unwrap_err()
        .to_string();
    assert!(why.contains("t.plctest.toml:3:11: "), "{why}");
    assert!(
        why.ends_with("rungc.toml:2:9: unknown model `h9u`"),
        "{why}"
    );
    // Errors in the program concern the case.
    let broken = folder("a.il", "LD X000\nOUTT Y000\nEND\n", None);
    let failed = failures(broken.path());
    assert_eq!(failed.len(), 1);
    assert!(
        failed[0].contains("does not compile: line 2: unknown instruction"),
        "{}",
        failed[0]
    );
}

/// Bounds of indexes belong to a project's program; the error about a test file with bounds says that, not that the key
/// is unknown.
#[test]
fn bounds_of_indexes_are_refused_in_test_files() {
    let folder = folder("a.il", LIST, None);
    let path = folder.path().join("t.plctest.toml");
    let why = "`[index]` belongs in rungc.toml and applies to its program: test that with `program = { file = \"…\" }`";
    let cases = CASES.replace("FILE", "a.il");
    for (text, place) in [
        (
            format!("{cases}\n[case.index]\n\"D0Z0\" = \"D0-D9\"\n"),
            "18:",
        ),
        (cases.replace("topic", "index = {}\ntopic"), "2:"),
    ] {
        fs::write(&path, text).unwrap();
        let problems = plctest::load(&path).unwrap_err().to_string();
        let (_, problem) = problems.split_once(".toml:").unwrap();
        assert!(problem.starts_with(place), "{problem}");
        assert!(problem.ends_with(why), "{problem}");
    }
}
