//! Reports for an assessor, and the same facts in documents for tools.

use crate::common::{folder, rungc, text};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn root() -> PathBuf {
    PathBuf::from(env!("RUNGC_ROOT"))
}

/// The example: a press with two buttons and a guard; `change` of its program.
fn press(change: (&str, &str)) -> TempDir {
    let example = root().join("examples/press");
    let read = |name: &str| fs::read_to_string(example.join(name)).unwrap();
    let program = read("press.il");
    let changed = program.replace(change.0, change.1);
    assert!(change.0.is_empty() || changed != program);
    folder(&[
        ("press.il", changed.as_bytes()),
        ("rungc.toml", read("rungc.toml").as_bytes()),
        ("press.plctest.toml", read("press.plctest.toml").as_bytes()),
    ])
}

/// The press with a setup mode, in which it moves with an open guard.
fn careless() -> TempDir {
    press((
        "LD M0\nAND X002\nOUT Y000",
        "LD X002\nOR X004 ; setup mode\nAND M0\nOUT Y000",
    ))
}

fn verify(folder: &Path, args: &[&str], code: i32) -> Output {
    let args = [&["verify", "--replay", "interp"], args].concat();
    let output = rungc(folder, &args);
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    output
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// A document in which each hash is `…`.
fn without_hashes(text: &str) -> String {
    let is_hash = |word: &&str| word.len() == 64 && word.bytes().all(|b| b.is_ascii_hexdigit());
    let words: BTreeSet<&str> = text.split('"').filter(is_hash).collect();
    let hidden = |text: String, word: &str| text.replace(word, "…");
    words.into_iter().fold(text.to_string(), hidden)
}

#[test]
fn a_report_shows_requirements_proofs_and_tests() {
    let folder = careless();
    let path = folder.path();
    let args = ["--mutants", "--certificate", "proof", "--report"];
    let output = verify(path, &[&args[..], &["r.json"]].concat(), 1);
    let notes = text(&output.stderr);
    assert!(
        notes.contains("Missing a property for requirement `R5`"),
        "{notes}"
    );
    let report = fs::read_to_string(path.join("r.json")).unwrap();
    insta::assert_snapshot!("report_json", without_hashes(&report));
    // Everything again gives the same bytes; a page replaces a page.
    for ending in ["json", "html", "pdf"] {
        let name = format!("r.{ending}");
        let written = || {
            let args = [&args[..], &[&name]].concat();
            verify(path, &args, 1);
            fs::read(path.join(&name)).unwrap()
        };
        assert_eq!(written(), written(), "{ending}");
    }
    // The hash of the program is that of its file.
    let subject = &json(&path.join("r.json"))["subject"];
    assert_eq!(subject["sha256"], subject["files"][0]["sha256"]);
}

#[test]
fn the_page_of_the_book_has_the_settings_of_the_example() {
    let read = |name: &str| fs::read_to_string(root().join(name)).unwrap();
    let page = read("docs/src/requirements.md");
    assert!(page.contains(&format!(
        "```toml rungc.toml\n{}```",
        read("examples/press/rungc.toml")
    )));
}

#[test]
fn what_a_report_needs_is_checked_before_work() {
    let folder = press(("", ""));
    let path = folder.path();
    let wrong = verify(path, &["--report", "r.txt"], 2);
    assert!(text(&wrong.stderr).contains("ends in .html, .pdf or .json"));
    fs::write(path.join("mine.html"), "<!DOCTYPE html>\n<p>mine</p>\n").unwrap();
    let wrong = verify(path, &["--report", "mine.html"], 2);
    assert!(text(&wrong.stderr).contains("--force"));
    let wrong = verify(
        path,
        &[
            "--report",
            "rungc.toml.json",
            "--mutants",
            "--same-as",
            "press.il",
        ],
        2,
    );
    assert!(text(&wrong.stderr).contains("--same-as"));
    assert!(!path.join("rungc.toml.json").exists());
    let dated = |seconds: &str| {
        Command::new(env!("CARGO_BIN_EXE_rungc"))
            .args(["verify", "--report", "r.json"])
            .env("SOURCE_DATE_EPOCH", seconds)
            .current_dir(path)
            .output()
            .unwrap()
    };
    assert_eq!(dated("1795474621").status.code(), Some(0));
    assert_eq!(json(&path.join("r.json"))["date"], "2026-11-23T22:57:01Z");
    assert_eq!(dated("soon").status.code(), Some(2));
    assert_eq!(dated("99999999999999").status.code(), Some(2));
}

#[test]
fn requirements_that_are_not_known_are_missing() {
    let folder = press(("", ""));
    let path = folder.path();
    let tests = "topic = \"t\"\n[[case]]\nname = \"own\"\nprogram = { file = \"press.il\" }\nrequirement = \"R9\"\nstep = [{ scans = 1 }]\n\
                 [[case]]\nname = \"other\"\nmodel = \"fx3u\"\nprogram = \"END\"\nrequirement = \"R1\"\nstep = [{ scans = 1 }]\n";
    fs::write(path.join("press.plctest.toml"), tests).unwrap();
    verify(path, &["--report", "r.json"], 0);
    let report = json(&path.join("r.json"));
    let missing = serde_json::to_string_pretty(&report["missing"]).unwrap();
    insta::assert_snapshot!("missing", missing);
    // Without a project, there is nothing to compare with, and no test ran.
    let plain = [
        "press.il",
        "--project",
        "none.toml",
        "--never",
        "Y000 & Y001",
    ];
    fs::write(path.join("none.toml"), "").unwrap();
    verify(path, &[&plain[..], &["--report", "p.json"]].concat(), 0);
    let report = json(&path.join("p.json"));
    assert_eq!(report["requirements"], Value::Array(Vec::new()));
    assert_eq!(report["properties"][0]["verdict"], "proved");
}

/// The members that the objects of a schema have.
fn members(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(map) => {
            for (key, value) in map {
                match (key.as_str(), value) {
                    // One of the members may have this name, too.
                    ("properties", Value::Object(properties)) => {
                        found.extend(properties.keys().cloned());
                        properties.values().for_each(|value| members(value, found));
                    }
                    _ => members(value, found),
                }
            }
        }
        Value::Array(values) => values.iter().for_each(|value| members(value, found)),
        _ => {}
    }
}

/// The members that a document has.
fn keys(document: &Value, found: &mut BTreeSet<String>) {
    match document {
        Value::Object(map) => {
            found.extend(map.keys().cloned());
            map.values().for_each(|value| keys(value, found));
        }
        Value::Array(values) => values.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn reports_follow_their_schema() {
    let folder = careless();
    let path = folder.path();
    verify(
        path,
        &[
            "--report",
            "bad.json",
            "--mutants",
            "--certificate",
            "proof",
        ],
        1,
    );
    let failing = fs::read_to_string(path.join("press.plctest.toml")).unwrap();
    let failing = failing.replace("expect = { Y000 = 1 }", "expect = { Y000 = 0 }");
    fs::write(path.join("press.plctest.toml"), failing).unwrap();
    Command::new(env!("CARGO_BIN_EXE_rungc"))
        .args(["verify", "--replay", "interp", "--report", "failing.json"])
        .env("SOURCE_DATE_EPOCH", "0")
        .current_dir(path)
        .output()
        .unwrap();
    let pid = "LD X000\nPID D0 D1 D100 D150\nLD> D150 K100\nAND M50\nOUT Y000\nEND\n";
    fs::write(path.join("pid.il"), pid).unwrap();
    let pid = ["pid.il", "--free", "M60", "--never", "Y000 & M60"];
    verify(
        path,
        &[&pid[..], &["--cleared", "--report", "pid.json"]].concat(),
        3,
    );
    let printed = verify(path, &["--format", "json"], 1).stdout;
    let printed: Value = serde_json::from_slice(&printed).unwrap();
    let part = serde_json::to_vec(&printed["verification"]).unwrap();
    fs::write(path.join("part.json"), part).unwrap();
    let names = ["bad.json", "failing.json", "pid.json", "part.json"];
    let (mut known, mut used) = (BTreeSet::new(), BTreeSet::new());
    let schema = root().join("docs/src/verification.schema.json");
    members(&json(&schema), &mut known);
    names
        .iter()
        .for_each(|name| keys(&json(&path.join(name)), &mut used));
    // Only long searches give these.
    used.extend(["clauses".to_string()]);
    assert_eq!(known, used);
    let python = std::env::var_os("RUNGC_PYTHON").unwrap_or_else(|| "python3".into());
    let checked = Command::new(python)
        .args(["-m", "check_jsonschema", "--schemafile"])
        .arg(schema)
        .args(names)
        .current_dir(path)
        .output();
    let checked = checked.map_or_else(|_| String::new(), |output| text(&output.stdout));
    let required = std::env::var_os("RUNGC_REQUIRE_PEERS").is_some();
    match checked.is_empty() {
        true => assert!(
            !required,
            "RUNGC_REQUIRE_PEERS is set, but there is no check-jsonschema"
        ),
        false => assert!(checked.contains("ok -- validation done"), "{checked}"),
    }
}

#[test]
fn tools_get_what_verdicts_rest_on() {
    let folder = careless();
    let path = folder.path();
    verify(path, &["--report", "r.json"], 1);
    let report = json(&path.join("r.json"));
    let printed = |format: &str| text(&verify(path, &["--format", format], 1).stdout);
    let sarif: Value = serde_json::from_str(&printed("sarif")).unwrap();
    let document: Value = serde_json::from_str(&printed("json")).unwrap();
    let of_sarif = &sarif["runs"][0]["properties"]["verifications"][0];
    for part in ["subject", "settings", "assumptions", "properties", "rungc"] {
        let of_json = &document["verification"][part];
        if part != "subject" {
            assert_eq!(of_json, &report[part], "{part}");
        }
        assert_eq!(of_json, &of_sarif[part], "{part}");
    }
    assert_eq!(of_sarif["subject"]["sha256"], report["subject"]["sha256"]);
    let junit = printed("junit");
    let hash = report["subject"]["sha256"].as_str().unwrap();
    for fact in [
        format!("<property name=\"sha256\" value=\"{hash}\"/>"),
        "<property name=\"requirement\" value=\"R2\"/>".to_string(),
        "<property name=\"run\" value=\"scan 1 (0 ms): X000 = 1".to_string(),
        "<property name=\"assumption\" value=\"latched devices begin with any value".to_string(),
    ] {
        assert!(junit.contains(&fact), "{fact}\n{junit}");
    }
}

#[test]
fn comparisons_have_the_evidence_of_properties() {
    let old =
        "LD X000\nOUT Y000\nLD X001\nOR M0\nOUT M0\nLD M0\nOUT Y001\nLD X002\nOUT Y002\nEND\n";
    let new = old
        .replace("OUT Y000", "ANI X003\nOUT Y000")
        .replace("M0", "M1");
    let folder = folder(&[("old.il", old.as_bytes()), ("new.il", new.as_bytes())]);
    let path = folder.path();
    let args = ["new.il", "--same-as", "old.il", "--certificate", "proof"];
    let more = ["--format", "json", "-o", "v.json", "--report", "r.json"];
    verify(path, &[&args[..], &more].concat(), 1);
    let [verdicts, report] = ["v.json", "r.json"].map(|name| json(&path.join(name)));
    let verification = &verdicts["verification"];
    assert_eq!(verification["properties"], report["properties"]);
    let found: Vec<_> = report["properties"].as_array().unwrap().iter().collect();
    let verdicts: Vec<&str> = found
        .iter()
        .map(|of| of["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts, ["differs", "the same", "the same"], "{report:#}");
    assert_eq!(found[0]["reason"], "Y000 = 1 in old.il");
    assert_eq!(found[0]["method"]["kind"], "run");
    assert_eq!(found[0]["run"]["end"][0]["value"], 0);
    assert_eq!(found[2]["method"]["kind"], "common");
    for of in &found[1..] {
        let files = of["certificate"].as_array().unwrap();
        assert!(
            files.iter().any(|file| file["file"] == "proof/memory.cnf"),
            "{of:#}"
        );
    }
    let files = report["subject"]["files"].as_array().unwrap().iter();
    let roles: Vec<_> = files.map(|file| (&file["role"], &file["file"])).collect();
    assert_eq!(
        roles,
        [
            (&"program".into(), &"new.il".into()),
            (&"older program".into(), &"old.il".into())
        ]
    );
    let assumptions = report["assumptions"].as_array().unwrap();
    let latched = |line: &&Value| {
        line.as_str()
            .unwrap()
            .contains("both begin with the same in latched devices")
    };
    assert_eq!(assumptions.iter().filter(latched).count(), 1);
    let output = rungc(
        path,
        &["diff", "--semantic", "--format", "json", "old.il", "new.il"],
    );
    let behaviour = &serde_json::from_slice::<Value>(&output.stdout).unwrap()["behaviour"];
    let devices: Vec<&Value> = behaviour["proofs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|of| &of["device"])
        .collect();
    assert_eq!(devices, ["Y001"], "{behaviour:#}");
    assert!(behaviour["assumptions"].as_array().unwrap().len() > 3);
}

/// The effort of the settings counts unless an option names another.
#[test]
fn the_effort_of_the_settings_limits_a_search() {
    let program = "LD X000\nOUT C0 K30000\nLD C0\nANI X000\nOUT Y000\nEND\n";
    let folder = folder(&[
        ("p.il", program.as_bytes()),
        (
            "rungc.toml",
            b"[project]\nprogram = \"p.il\"\n[verify]\neffort = 7\n",
        ),
    ]);
    for (args, effort) in [(&[][..], "7"), (&["--effort", "9"], "9")] {
        let args = [&["--never", "Y000"], args].concat();
        let shown = text(&verify(folder.path(), &args, 3).stdout);
        assert!(
            shown.contains(&format!("an effort of {effort} was not enough")),
            "{shown}"
        );
    }
}
