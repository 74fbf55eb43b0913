//! Properties of programs, proved and violated.

mod common;

use common::{folder, rungc, shown, text};

/// A motor that runs forward and backward; `lock` is the contact before the second coil.
fn reverser(lock: &str) -> String {
    format!(
        "\
;! Y000 = forward contactor
;! Y001 = reverse contactor
LD X000
OR Y000
ANI X002
ANI Y001
OUT Y000
LD X001
OR Y001
ANI X002
{lock}
OUT Y001
END
"
    )
}

/// Lines without the time that each verdict took.
fn timeless(text: &str) -> String {
    let lines = text.lines().map(|line| match line.rsplit_once(" (") {
        Some((before, seconds)) if seconds.ends_with(" s)") => before,
        _ => line,
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn an_interlock_is_proved_and_its_lack_is_shown() {
    let (good, bad) = (reverser("ANI Y000"), reverser("ANI X003"));
    let folder = folder(&[("good.il", good.as_bytes()), ("bad.il", bad.as_bytes())]);
    let verify = |args: &[&str]| {
        let output = rungc(folder.path(), &[&["verify"], args].concat());
        let code = output.status.code();
        (code, timeless(&text(&output.stdout)), text(&output.stderr))
    };
    let (code, proved, _) = verify(&["good.il", "--never", "Y000 & Y001"]);
    assert_eq!(code, Some(0));
    insta::assert_snapshot!("proved", proved);
    let (code, violated, report) = verify(&["bad.il", "--never", "\"forward contactor\" & Y001"]);
    assert_eq!(code, Some(1));
    insta::assert_snapshot!("violated", violated);
    insta::assert_snapshot!("violated_report", report);
    let assumed = [
        "bad.il",
        "--never",
        "Y000 & Y001",
        "--assume",
        "!(X000 & X001)",
    ];
    let (code, still, _) = verify(&[&assumed[..], &["--reachable", "Y001"]].concat());
    assert_eq!(code, Some(1));
    insta::assert_snapshot!("violated_under_an_assumption", still);
}

#[test]
fn a_counterexample_is_a_test() {
    let folder = folder(&[("bad.il", reverser("ANI X003").as_bytes())]);
    let args = [
        "verify",
        "bad.il",
        "--never",
        "Y000 & Y001",
        "--write-test",
        "bad.plctest.toml",
    ];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1));
    let test = std::fs::read_to_string(folder.path().join("bad.plctest.toml")).unwrap();
    insta::assert_snapshot!("test_file", test);
    let output = rungc(folder.path(), &["test", "bad.plctest.toml"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

#[test]
fn what_is_not_decided_has_an_exit_code() {
    let program = "LD X000\nPID D0 D1 D100 D150\nLD> D150 K100\nOUT Y000\nEND\n";
    let folder = folder(&[("pid.il", program.as_bytes())]);
    let output = rungc(
        folder.path(),
        &["verify", "pid.il", "--never", "Y000", "--cleared"],
    );
    insta::assert_snapshot!("not_decided", timeless(&text(&output.stdout)));
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn mistakes_in_conditions_are_shown() {
    let folder = folder(&[("good.il", reverser("ANI Y000").as_bytes())]);
    insta::assert_snapshot!(
        "mistake",
        shown(
            folder.path(),
            &["verify", "good.il", "--never", "Y000 & Pump"]
        )
    );
    insta::assert_snapshot!("no_property", shown(folder.path(), &["verify", "good.il"]));
    let output = rungc(folder.path(), &["verify", "good.il", "--never", "Y000 &"]);
    assert_eq!(output.status.code(), Some(2));
}
