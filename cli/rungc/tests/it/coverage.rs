//! Coverage of a program by test cases, and its changes that they do not detect.

use crate::common::{MOTOR, folder, rungc, shown, text};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
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

/// A contact that only repeats another one can be left out: no test can notice that, and none has to (P19). What does
/// change an output remains a gap.
#[test]
fn equivalent_mutants_are_not_survivors() {
    let folder = desk();
    let path = folder.path();
    let twice = "LD X000\nOUT M0\nLD X000\nAND M0\nOUT Y000\nEND\n";
    fs::write(path.join("twice.il"), twice).unwrap();
    let tests = |steps: &str| {
        format!(
            "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"twice.il\"\n[[case]]\nname = \"all\"\n\
             [[case.step]]\nset = {{ X000 = 1 }}\nscans = 2\nexpect = {{ Y000 = 1 }}\n{steps}"
        )
    };
    let judged = |steps: &str| {
        fs::write(path.join("twice.plctest.toml"), tests(steps)).unwrap();
        let shown = shown(path, &["test", "twice.plctest.toml", "--mutants"]);
        shown
            .lines()
            .find(|line| line.starts_with("twice.il: "))
            .unwrap()
            .to_string()
    };
    let all = judged("[[case.step]]\nset = { X000 = 0 }\nexpect = { Y000 = 0 }\n");
    let proved = "more never change an output (proved)";
    assert!(
        all.contains(", 0 survived,") && all.contains(proved),
        "{all}"
    );
    let part = judged("");
    assert!(
        !part.contains(", 0 survived,") && part.contains(proved),
        "{part}"
    );
}

/// Cases beside other PLCs judge, too.
#[test]
fn cases_with_several_plcs_notice_mutants() {
    let two = "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"one.il\"\n[[case]]\nname = \"two\"\n\
        [[case.plc]]\nname = \"B\"\nprogram = \"LD X000\\nOUT Y000\\nEND\"\n\
        [[case.step]]\nset = { X000 = 1, \"B:X000\" = 1 }\nexpect = { Y000 = 1, \"B:Y000\" = 1 }\n\
        [[case.step]]\nset = { X001 = 1 }\nexpect = { Y000 = 0, \"B:Y000\" = 1 }\n\
        [[case.step]]\nset = { X001 = 0, X000 = 0 }\nexpect = { Y000 = 0 }\n";
    let folder = folder(&[
        ("one.il", b"LD X000\nANI X001\nOUT Y000\nEND\n"),
        ("two.plctest.toml", two.as_bytes()),
    ]);
    let run = |options: &[&str]| {
        let args = [&["test", ".", "--mutants"], options].concat();
        text(&rungc(folder.path(), &args).stdout)
    };
    let messages = run(&[]);
    assert!(
        messages.contains("one.il: 6 of 6 mutants noticed"),
        "{messages}"
    );
    // Two machines share the mutants.
    let noticed = |part: &str| -> usize {
        let messages = run(&["--shard", part]);
        let line = messages
            .lines()
            .find_map(|line| line.strip_prefix("one.il: "));
        let count = line.and_then(|line| line.split(' ').next()?.parse().ok());
        count.unwrap_or_else(|| panic!("{messages}"))
    };
    assert_eq!(noticed("1/2") + noticed("2/2"), 6);
}

/// A contact that alone drives what acts on a change decides.
#[test]
fn single_contacts_of_pulses_decide() {
    let tests = "model = \"fx3u\"\ntopic = \"t\"\nprogram = \"pulses.il\"\n[[case]]\nname = \"all\"\n\
        [[case.step]]\nset = { X000 = 1, X001 = 1 }\nexpect = { D0 = 1 }\n\
        [[case.step]]\nset = { X000 = 0, X001 = 0 }\n";
    let folder = folder(&[
        (
            "pulses.il",
            b"LD X000\nMOVP K1 D0\nLD X001\nPLS M0\nLD M0\nOUT Y000\nEND\n",
        ),
        ("pulses.plctest.toml", tests.as_bytes()),
    ]);
    let output = rungc(folder.path(), &["test", ".", "--coverage", "text"]);
    let messages = text(&output.stdout);
    assert!(!messages.contains("never"), "{messages}");
}

#[test]
fn what_cannot_be_done_is_reported() {
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
    let messages = text(&output.stdout) + &text(&output.stderr);
    assert!(output.status.success(), "{messages}");
    // Of 12 lines, the one of the step that X002 counts, and those after it, are executed, too.
    assert!(messages.contains("(12 of 12 lines)"), "{messages}");
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

/// Files that commands write are among those that a step of the workflow uploads.
fn uploads_all<'a>(workflow: &str, written: impl Iterator<Item = &'a str>) {
    let (_, uploaded) = workflow.rsplit_once("path: |").unwrap();
    for file in written {
        assert!(uploaded.lines().any(|line| line.trim() == file), "{file}");
    }
}

#[test]
fn the_cache_of_the_example_is_kept() {
    let root = PathBuf::from(env!("RUNGC_ROOT"));
    let workflow = fs::read_to_string(root.join("examples/ci/.github/workflows/plc.yml")).unwrap();
    let cache = "RUNGC_CACHE_DIR: ${{ github.workspace }}/";
    let (_, folder) = workflow.split_once(cache).unwrap();
    let folder = folder.lines().next().unwrap();
    for (name, job) in [("test", "  test:\n"), ("coverage", "  coverage:\n")] {
        let (_, steps) = workflow.split_once(job).unwrap();
        let steps = steps.split("\n\n").next().unwrap();
        assert!(steps.contains(&format!("path: {folder}\n")), "{name}");
        assert!(steps.contains("path: ~/.cargo/bin/rungc\n"), "{name}");
    }
    for line in workflow.lines().filter(|line| line.contains("uses: ")) {
        let (_, pinned) = line.split_once('@').unwrap();
        let (commit, version) = pinned.split_once(" # v").unwrap();
        assert!(commit.len() == 40 && version.contains('.'), "{line}");
    }
}

#[test]
fn the_commands_of_the_example_run() {
    let root = PathBuf::from(env!("RUNGC_ROOT"));
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
        if command.starts_with("cargo install ") {
            let source = format!("--git {}", env!("CARGO_PKG_REPOSITORY"));
            assert!(command.contains(&source), "{command}");
            assert!(command.ends_with(env!("CARGO_PKG_NAME")), "{command}");
            continue;
        }
        let written = ["-o ", "> "].into_iter();
        let written = written.filter_map(|by| Some(command.split_once(by)?.1));
        uploads_all(&workflow, written);
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
    assert_eq!(run, 18);
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

/// JUnit files of failed cases and violated properties, as junitparser reads them, and SARIF logs of these and of
/// findings of `check`, as the validator of SARIF's makers judges them.
#[test]
fn results_are_read_by_others() {
    let folder = desk();
    let path = folder.path();
    let failing = TESTS.replace("Y000 = 0", "Y000 = 1") + "never = [{ Y000 = 0, M0 = 0 }]\n";
    fs::write(path.join("motor.plctest.toml"), failing).unwrap();
    fs::write(path.join("v.il"), "LD X000\nOUT Y000\nEND\n").unwrap();
    // A wrong operand, an unknown instruction, a relay that nothing reads, and what is never on.
    let wrong = "LD X009\nFOO\nMOV K1 X0\nLD M8001\nOUT M5\nEND\n";
    fs::write(path.join("wrong 电.il"), wrong).unwrap();
    fs::write(path.join("never.il"), "LD X000\nANI X000\nOUT Y000\nEND\n").unwrap();
    let verify = [
        "verify",
        "v.il",
        "--never",
        "Y000",
        "--always",
        "Y000 | !X000",
    ];
    let verify = [&verify[..], &["--replay", "interp"]].concat();
    for (args, format, file) in [
        (&["test", "."][..], "sarif", "t.sarif"),
        (&["test", "."], "junit", "t.xml"),
        (&verify, "sarif", "v.sarif"),
        (&verify, "junit", "v.xml"),
    ] {
        let output = rungc(path, &[args, &["--format", format, "-o", file]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    }
    for (args, file) in [
        (&["check", "wrong 电.il", "never.il", "v.il"][..], "c.sarif"),
        (&["check", "--deep", "never.il"], "d.sarif"),
    ] {
        let output = rungc(path, &[args, &["--format", "sarif"]].concat());
        fs::write(path.join(file), output.stdout).unwrap();
    }
    let script = "import junitparser\nfor file in ['t.xml', 'v.xml']:\n    x = junitparser.JUnitXml.fromfile(file)\n    print(x.tests, x.failures, x.errors, [c.name for s in x for c in s if c.result])";
    let read = Command::new(python())
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
    let logs = ["t.sarif", "v.sarif", "c.sarif", "d.sarif"];
    let (Some(messages), Some(checked)) = (validated(path, &logs), schema(path, &logs)) else {
        return missing("validator of SARIF");
    };
    assert!(
        !messages.contains(": error") && !messages.contains(": warning"),
        "{messages}"
    );
    assert!(checked.contains("ok -- validation done"), "{checked}");
    // They notice what is wrong.
    let log = fs::read_to_string(path.join("t.sarif")).unwrap();
    let broken = log.replace("\"ruleId\"", "\"rul\"");
    fs::write(path.join("broken.sarif"), broken).unwrap();
    let messages = validated(path, &["broken.sarif"]).unwrap_or_default();
    assert!(messages.contains(": error"), "{messages}");
    // The one says nothing of a log whose words it does not know; the other does.
    let broken = log.replace("\"error\"", "\"fatal\"");
    fs::write(path.join("broken.sarif"), broken).unwrap();
    let checked = schema(path, &["broken.sarif"]).unwrap_or_default();
    assert!(checked.contains("'fatal' is not one of"), "{checked}");
}

/// Path of the SARIF validator by its makers, with the schema, if it is installed.
fn multitool() -> Option<PathBuf> {
    let modules = std::env::var_os("RUNGC_SARIF")?;
    Some(Path::new(&modules).join("@microsoft/sarif-multitool-linux"))
}

/// Output of the validator about logs.
fn validated(folder: &Path, logs: &[&str]) -> Option<String> {
    let output = Command::new(multitool()?.join("Sarif.Multitool"))
        .arg("validate")
        .args(logs)
        // It needs no tables of languages.
        .env("DOTNET_SYSTEM_GLOBALIZATION_INVARIANT", "1")
        .env("HOME", folder)
        .current_dir(folder)
        .output();
    let output = output.ok()?;
    let messages = text(&output.stdout) + &text(&output.stderr);
    assert!(messages.contains("files scanned"), "{messages}");
    Some(messages)
}

/// Output of check-jsonschema about logs by that schema.
fn schema(folder: &Path, logs: &[&str]) -> Option<String> {
    let schema = multitool()?.join("sarif-2.1.0.json");
    let output = Command::new(python())
        .args(["-m", "check_jsonschema", "--schemafile"])
        .arg(schema)
        .args(logs)
        .current_dir(folder)
        .output();
    Some(text(&output.ok()?.stdout))
}

fn python() -> OsString {
    std::env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into())
}

/// A peer is not there.
fn missing(what: &str) {
    let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
    assert!(
        !required,
        "RUNGC_REQUIRE_PEERS is set, but there is no {what}"
    );
    eprintln!("skipped: there is no {what}");
}
