//! What test cases execute of a program, and the changes of it that they do not notice.

mod common;

use common::{MOTOR, folder, rungc, shown, text};
use std::fs;
use std::path::Path;
use std::process::Command;

const TESTS: &str = r#"model = "fx3u"
topic = "motor"
program = "motor.il"
[[case]]
name = "runs"
[[case.step]]
set = { X000 = 1 }
expect = { M0 = 1 }
[[case.step]]
set = { X000 = 0 }
run_ms = 500
expect = { M0 = 1, Y000 = 1 }
[[case]]
name = "stops"
[[case.step]]
set = { X000 = 1 }
[[case.step]]
set = { X000 = 0, X001 = 1 }
expect = { M0 = 0, Y000 = 0 }
"#;

/// Steps, a zone of master control, branches, a jumped-over network and a subroutine that is not called.
const PLANT: &str = "\
LD M8002
SET S0
STL S0
OUT Y000
LD X000
SET S20
STL S20
OUT T0 K5
LD T0
OUT S0
RET
LD X001
MC N0 M100
LD X002
MPS
AND X003
OUT Y001
MPP
ANI X003
OUT Y002
MCR N0
LD X004
CJ P0
LDP X005
INCP D0
P0
LDI X006
CALL P1
FEND
P1
LD= D0 K3
SET Y003
SRET
END
";

const PLANT_TESTS: &str = r#"model = "fx3u"
topic = "plant"
program = "plant.il"
[[case]]
name = "idle"
[[case.step]]
set = { X004 = 1, X006 = 1 }
scans = 3
expect = { Y000 = 1 }
[[case]]
name = "moves"
[[case.step]]
set = { X006 = 1, X001 = 1, X002 = 1 }
scans = 2
expect = { Y002 = 1 }
[[case.step]]
set = { X000 = 1, X003 = 1 }
scans = 2
expect = { S20 = 1, Y001 = 1, Y002 = 0 }
"#;

fn desk() -> tempfile::TempDir {
    folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("motor.plctest.toml", TESTS.as_bytes()),
        ("plant.il", PLANT.as_bytes()),
        ("plant.plctest.toml", PLANT_TESTS.as_bytes()),
    ])
}

#[test]
fn what_cases_do_not_reach_is_listed() {
    let folder = desk();
    let path = folder.path();
    insta::assert_snapshot!(
        "coverage_text",
        shown(path, &["test", ".", "--coverage", "text"])
    );
    let failing = TESTS.replace("Y000 = 0", "Y000 = 1");
    fs::write(path.join("motor.plctest.toml"), failing).unwrap();
    let output = rungc(path, &["test", ".", "--coverage", "text"]);
    assert_eq!(output.status.code(), Some(1), "a case fails");
}

#[test]
fn gaps_are_found_by_changing_the_program() {
    let folder = desk();
    let path = folder.path();
    insta::assert_snapshot!("coverage_mutants", shown(path, &["test", ".", "--mutants"]));
    let written = rungc(path, &["test", ".", "--mutants", "-o", "gaps.txt"]);
    assert_eq!(written.status.code(), Some(1));
    let gaps = fs::read_to_string(path.join("gaps.txt")).unwrap();
    assert!(gaps.starts_with("motor.il: "), "{gaps}");
    // A suite that checks all that a small program does notices every change.
    fs::write(path.join("one.il"), "LD X000\nANI X001\nOUT Y000\nEND\n").unwrap();
    let rows = [(0, 0, 0), (0, 1, 0), (1, 0, 1), (1, 1, 0)];
    let rows: String = rows
        .iter()
        .map(|(a, b, y)| format!("{{ a = {a}, b = {b}, y = {y} }}, "))
        .collect();
    let one = format!(
        "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"one.il\"\n[[case]]\nname = \"all\"\nrows = [{rows}]\n[[case.step]]\nset = {{ X000 = \"$a\", X001 = \"$b\" }}\nexpect = {{ Y000 = \"$y\" }}\n\
        [[case]]\nname = \"falls\"\n[[case.step]]\nset = {{ X000 = 1 }}\n[[case.step]]\nset = {{ X000 = 0 }}\nexpect = {{ Y000 = 0 }}\n"
    );
    fs::write(path.join("one.plctest.toml"), one).unwrap();
    insta::assert_snapshot!(
        "coverage_no_gap",
        shown(path, &["test", "one.plctest.toml", "--mutants"])
    );
}

#[test]
fn what_cannot_be_done_is_said() {
    let folder = desk();
    let path = folder.path();
    let failing = TESTS.replace("Y000 = 0", "Y000 = 1");
    fs::write(path.join("failing.plctest.toml"), failing).unwrap();
    let list = "model = \"fx3u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\nprogram = \"LD X000\\nOUT Y000\\nEND\"\n[[case.step]]\nscans = 1\n";
    fs::write(path.join("list.plctest.toml"), list).unwrap();
    let calls = [
        &["test", ".", "--coverage", "html"][..],
        &["test", ".", "--coverage", "text", "--engine", "c"],
        &["test", "failing.plctest.toml", "--mutants"],
        &["test", "list.plctest.toml", "--coverage", "lcov"],
    ];
    let story: Vec<String> = calls.iter().map(|call| shown(path, call)).collect();
    insta::assert_snapshot!("coverage_refused", story.join("\n\n"));
}

#[test]
fn a_tracefile_is_read_by_genhtml() {
    let folder = desk();
    let path = folder.path();
    let output = rungc(
        path,
        &[
            "test",
            "motor.plctest.toml",
            "--coverage",
            "lcov",
            "-o",
            "c.info",
        ],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    insta::assert_snapshot!(
        "coverage_lcov",
        fs::read_to_string(path.join("c.info")).unwrap()
    );
    let call = Command::new("genhtml")
        .args(["--branch-coverage", "-o", "page", "c.info"])
        .current_dir(path)
        .output();
    let Ok(output) = call else {
        let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
        assert!(
            !required,
            "RUNGC_REQUIRE_PEERS is set, but there is no genhtml"
        );
        return eprintln!("skipped: there is no genhtml");
    };
    let said = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success(), "{said}");
    // Of 12 lines, the one of the step that X002 counts, and those after it, are executed, too.
    assert!(said.contains("(12 of 12 lines)"), "{said}");
    let page = fs::read_to_string(path.join("page/index.html")).unwrap();
    assert!(page.contains("Branches"), "{page}");
}

/// The commands of a workflow, in their order: what follows `run:`, on the line or, after `|`, in the lines below that
/// are indented further.
fn commands(workflow: &str) -> Vec<String> {
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut lines = workflow.lines().peekable();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        let Some(command) = line.trim_start().strip_prefix("run: ") else {
            continue;
        };
        if command != "|" {
            found.push(command.to_string());
            continue;
        }
        while let Some(more) = lines.next_if(|more| indent(more) > indent(line)) {
            found.push(more.trim().to_string());
        }
    }
    found
}

#[test]
fn the_commands_of_the_example_run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let workflow = fs::read_to_string(root.join("examples/ci/.github/workflows/plc.yml")).unwrap();
    let page = fs::read_to_string(root.join("docs/src/ci.md")).unwrap();
    assert!(
        page.contains(&format!("```yaml\n{workflow}```")),
        "docs/src/ci.md shows another"
    );
    let folder = tempfile::tempdir().unwrap();
    for name in [
        "rungc.toml",
        "hoist.il",
        "tests/hoist.plctest.toml",
        "tests/traces/hoist.stops_at_the_limit.trace",
    ] {
        let to = folder.path().join(name);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(root.join("examples/ci").join(name), to).unwrap();
    }
    let mut run = 0;
    for command in commands(&workflow) {
        if command == "cargo install --locked rungc" {
            continue;
        }
        for shard in ["1", "2"] {
            let command = command.replace("${{ matrix.shard }}", shard);
            let Some(args) = command.strip_prefix("rungc ") else {
                panic!("not a command of rungc: {command}");
            };
            let args: Vec<&str> = args.split(" > ").next().unwrap().split(' ').collect();
            let output = rungc(folder.path(), &args);
            let (out, err) = (text(&output.stdout), text(&output.stderr));
            assert_eq!(output.status.code(), Some(0), "{command}\n{out}{err}");
            run += 1;
        }
    }
    assert_eq!(run, 14);
    for (file, begins) in [
        ("tests.sarif", "{"),
        ("tests.xml", "<?xml"),
        ("coverage.info", "TN:"),
        ("coverage.html", "<!DOCTYPE html>"),
        ("mutants.txt", "hoist.il: 16 of 16 mutants noticed"),
    ] {
        let text = fs::read_to_string(folder.path().join(file)).unwrap();
        assert!(text.starts_with(begins), "{file}: {text}");
    }
}

/// SARIF logs and JUnit files of failed cases and violated properties, as tools read them that others wrote:
/// check-jsonschema with the schema of SARIF, and junitparser.
#[test]
fn results_are_read_by_others() {
    let folder = desk();
    let path = folder.path();
    let failing = TESTS.replace("Y000 = 0", "Y000 = 1") + "never = [{ Y000 = 0, M0 = 0 }]\n";
    fs::write(path.join("motor.plctest.toml"), failing).unwrap();
    for (format, file) in [("sarif", "t.sarif"), ("junit", "t.xml")] {
        let output = rungc(path, &["test", ".", "--format", format, "-o", file]);
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    fs::write(path.join("v.il"), "LD X000\nOUT Y000\nEND\n").unwrap();
    let asked = [
        "verify",
        "v.il",
        "--never",
        "Y000",
        "--always",
        "Y000 | !X000",
    ];
    for (format, file) in [("sarif", "v.sarif"), ("junit", "v.xml")] {
        let how = ["--replay", "interp", "--format", format, "-o", file];
        let output = rungc(path, &[&asked[..], &how].concat());
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    let python = std::env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let script = "import junitparser\nfor file in ['t.xml', 'v.xml']:\n    x = junitparser.JUnitXml.fromfile(file)\n    print(x.tests, x.failures, x.errors, [c.name for s in x for c in s if c.result])";
    let read = Command::new(&python)
        .args(["-c", script])
        .current_dir(path)
        .output();
    match read {
        Ok(read) if read.status.success() => {
            assert_eq!(
                text(&read.stdout),
                "4 1 0 ['stops']\n2 1 0 ['never Y000']\n"
            );
        }
        _ => missing("junitparser"),
    }
    // The schema of SARIF is not in a package: where it cannot be fetched, the test does not fail.
    let schema = Command::new(&python)
        .args([
            "-m",
            "check_jsonschema",
            "--schemafile",
            SARIF_SCHEMA,
            "t.sarif",
            "v.sarif",
        ])
        .current_dir(path)
        .output();
    let Ok(checked) = schema else {
        return eprintln!("skipped: there is no Python");
    };
    let said = text(&checked.stdout);
    assert!(!said.contains("Schema validation errors"), "{said}");
    if !checked.status.success() {
        eprintln!("skipped: check-jsonschema cannot fetch {SARIF_SCHEMA}");
    }
}

const SARIF_SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";

/// A peer is not there.
fn missing(what: &str) {
    let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
    assert!(
        !required,
        "RUNGC_REQUIRE_PEERS is set, but there is no {what}"
    );
    eprintln!("skipped: there is no {what}");
}
