//! Two programs compared, alone and by Git.

use crate::common::{MOTOR, folder, rungc, shown, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const OLD: &str = "\
;! title = Press
;! X000 = start button
; Motor
LD X0
OR M0
ANI X1
OUT M0
LD M0
OUT T0 K30
AND T0
OUT Y0
LD>= D0 K10
SET Y1
LD X3
OUT Y2
LD X4
OUT Y4 ; lamp
END
";

const NEW: &str = "\
;! title = Press 2
;! X000 = start
; Motor of the press
LD X3
OUT Y2
LD X0
OR M0
ANI X2
OUT M0
LD M0
OUT T0 K50
AND T0
OUT Y0
LD X4
OUT Y4 ; red lamp
P0
LD X5
OUT Y5
END
";

#[test]
fn networks_comments_and_settings_are_compared() {
    let folder = folder(&[("old.il", OLD.as_bytes()), ("new.il", NEW.as_bytes())]);
    let diff = |more: &[&str]| {
        shown(
            folder.path(),
            &[&["diff", "old.il", "new.il"], more].concat(),
        )
    };
    insta::assert_snapshot!("text", diff(&["--width", "72"]));
    insta::assert_snapshot!("markdown", diff(&["--format", "md", "--width", "60"]));
    insta::assert_snapshot!("json", diff(&["--format", "json"]));
}

#[test]
fn equal_programs_end_with_0() {
    let spaced = MOTOR.replace("OR M0", "  OR    M0");
    let folder = folder(&[("a.il", MOTOR.as_bytes()), ("b.il", spaced.as_bytes())]);
    let out = rungc(folder.path(), &["diff", "a.il", "b.il"]);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stdout));
    assert!(text(&out.stdout).contains("no differences"));
    // A list and the export made of it.
    let out = rungc(
        folder.path(),
        &["convert", "a.il", "--to", "csv", "-o", "c.csv"],
    );
    assert!(out.status.success());
    let out = rungc(folder.path(), &["diff", "a.il", "c.csv"]);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stdout));
}

/// A folder stands for the program that its settings name, or for the only one in it.
#[test]
fn folders_of_projects_are_compared() {
    let folder = folder(&[]);
    let place = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    place("old/rungc.toml", "[project]\nprogram = \"p.il\"\n");
    place("old/p.il", MOTOR);
    place("old/another.il", "LD X7\nOUT Y7\nEND\n");
    place("new/rungc.toml", "");
    place("new/p.il", MOTOR);
    place("many/a.il", MOTOR);
    place("many/b.il", MOTOR);
    let out = rungc(folder.path(), &["diff", "old", "new"]);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    let names = format!(
        "--- {}\n+++ {}\n",
        Path::new("old").join("p.il").display(),
        Path::new("new").join("p.il").display()
    );
    assert!(
        text(&out.stdout).starts_with(&names),
        "{}",
        text(&out.stdout)
    );
    let out = rungc(folder.path(), &["diff", "old", "many"]);
    assert_eq!(out.status.code(), Some(2));
    let said = text(&out.stderr);
    assert!(said.contains("`many` has several programs"), "{said}");
    let out = rungc(folder.path(), &["run", "new", "--for", "10ms"]);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    place("old/rungc.toml", "[project]\nprogram = \"absent.il\"\n");
    let out = rungc(folder.path(), &["diff", "old", "new"]);
    assert!(text(&out.stderr).contains("there is no `absent.il`"));
}

#[test]
fn networks_that_move_do_the_same_unless_their_order_matters() {
    let same = "Same behaviour: with the same inputs, all devices have the same values.";
    let networks = [
        "LDP X0\nOUT Y0\n",
        "LD X1\nOR M1\nOUT M1\nOUT T0 K5\nLD T0\nOUT Y1\n",
        "LDP X0\nINC D0\nLD= D0 K5\nSET Y2\n",
        "LD X2\nPLS M2\nLD M2\nMOV K1 D1\n",
    ];
    let program = |order: [usize; 4]| {
        let body: Vec<&str> = order.iter().map(|at| networks[*at]).collect();
        body.concat() + "END\n"
    };
    let old = program([0, 1, 2, 3]);
    for order in [[1, 0, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
        assert_eq!(
            behaviour(&old, &program(order)),
            (same.to_string(), Some(0)),
            "{order:?}"
        );
    }
    // Only values read in another order can differ.
    let old = "LD X0\nOUT M0\nLD M0\nOUT Y0\nLD X1\nOUT Y1\nEND\n";
    let new = "LD X1\nOUT Y1\nLD M0\nOUT Y0\nLD X0\nOUT M0\nEND\n";
    let (words, _) = behaviour(old, new);
    assert!(
        words.starts_with("Outputs that can differ: Y000."),
        "{words}"
    );
    // So is what is written twice.
    let old = "LD X0\nOUT Y0\nLD X1\nOUT Y1\nLD X2\nOUT Y0\nEND\n";
    let new = "LD X2\nOUT Y0\nLD X1\nOUT Y1\nLD X0\nOUT Y0\nEND\n";
    let (words, _) = behaviour(old, new);
    assert!(
        words.starts_with("Outputs that can differ: Y000."),
        "{words}"
    );
}

/// Instructions of the runtime share the flags that they use, not all special devices.
#[test]
fn a_changed_calculation_decides_about_what_reads_its_result() {
    let old = "LD X0\nDMOV K5 D100\nDFLT D100 D102\nDSIN D102 D0\nLD X1\nSUM D20 D21\nLD= D21 K3\nOUT Y0\n\
        LD X2\nPRUN K2X0 K2M0\nLD M0\nOUT Y1\nEND\n";
    let (words, code) = behaviour(old, &old.replace("DSIN", "DCOS"));
    let all_others = "All other devices have the same values, with the same inputs.";
    assert!(
        words.starts_with("No output can differ.\n") && words.ends_with(all_others),
        "{words}"
    );
    assert!(!words.contains("D21") && !words.contains("M0"), "{words}");
    assert_eq!(code, Some(1));
    // A flag that one sets and another reads counts, too.
    let old = "LD X0\nROR D0 K1\nLD X1\nRCR D1 K1\nLD= D1 K1\nOUT Y0\nEND\n";
    let (words, _) = behaviour(old, &old.replace("ROR D0 K1", "ROR D0 K2"));
    assert!(words.contains("D0 to D1"), "{words}");
}

/// The same list does otherwise after power-off if another register is latched.
#[test]
fn settings_decide_about_behaviour() {
    let list = "LD= D0 K5\nOUT Y0\nLD X0\nMOV K5 D0\nEND\n";
    let folder = tempfile::tempdir().unwrap();
    for (project, latched) in [("old", ""), ("new", "[latched]\nD = \"D0-D511\"\n")] {
        let at = folder.path().join(project);
        fs::create_dir(&at).unwrap();
        fs::write(at.join("p.il"), list).unwrap();
        let settings = format!("[project]\nprogram = \"p.il\"\nmodel = \"fx3u\"\n{latched}");
        fs::write(at.join("rungc.toml"), settings).unwrap();
    }
    let output = rungc(
        folder.path(),
        &["diff", "--semantic", "old/p.il", "new/p.il"],
    );
    let words = text(&output.stdout);
    assert!(
        words.contains("Outputs that can differ: Y000.\nOther devices that can differ: D0."),
        "{words}"
    );
    assert_eq!(output.status.code(), Some(1));
}

/// Outputs that no run makes differ are listed separately.
#[test]
fn outputs_that_are_proved_the_same_do_not_differ() {
    let old = "LD X0\nAND X1\nOUT Y3\nLD X2\nOUT Y4\nEND\n";
    let new = "LD X1\nAND X0\nOUT Y3\nLDI X2\nOUT Y4\nEND\n";
    let (words, code) = behaviour(old, new);
    let proved = "Outputs that are proved the same, with scans of at most 200 ms: Y003.";
    assert!(
        words.starts_with("Outputs that can differ: Y004.\n"),
        "{words}"
    );
    assert!(words.contains(proved), "{words}");
    assert_eq!(code, Some(1));
    let (words, code) = behaviour(old, &new.replace("LDI", "LD"));
    assert!(words.contains(proved), "{words}");
    assert_eq!(code, Some(0));
}

#[test]
fn jumps_decide_about_what_they_skip_alone() {
    let all_others = "All other devices have the same values, with the same inputs.";
    // Over changed code.
    let nested = "LD X0\nCJ P1\nLD X1\nOUT Y0\nLD X3\nOUT Y3\nP1\nLD X2\nOUT Y1\nEND\n";
    // Jumps that cross each other.
    let crossed = "LD X0\nCJ P1\nLD X1\nOUT Y0\nLD X4\nCJ P2\nLD X3\nOUT Y3\nP1\nLD X2\nOUT Y1\nP2\nLD X5\nOUT Y5\nEND\n";
    for old in [nested, crossed] {
        let (words, _) = behaviour(old, &old.replace("LD X1", "LDI X1"));
        assert_eq!(
            words,
            format!("Outputs that can differ: Y000.\n{all_others}")
        );
    }
    let (words, _) = behaviour(nested, &nested.replace("LD X0", "LDI X0"));
    assert!(words.contains("Y000, Y003.\n"), "{words}");
    // Nothing moves across a jump or a label.
    let new = "LD X1\nOUT Y0\nLD X0\nCJ P1\nLD X3\nOUT Y3\nP1\nLD X2\nOUT Y1\nEND\n";
    let (words, _) = behaviour(nested, new);
    assert!(
        words.starts_with("Outputs that can differ: Y000"),
        "{words}"
    );
    // Networks after crossed jumps are separate from them.
    let (words, _) = behaviour(crossed, &crossed.replace("LD X4", "LDI X4"));
    assert!(!words.contains("Y005"), "{words}");
}

/// The words of a comparison of behaviour, and the exit code.
fn behaviour(old: &str, new: &str) -> (String, Option<i32>) {
    let folder = folder(&[("old.il", old.as_bytes()), ("new.il", new.as_bytes())]);
    let out = rungc(folder.path(), &["diff", "old.il", "new.il", "--semantic"]);
    let words = text(&out.stdout);
    let words = words.lines().skip(3).take_while(|line| !line.is_empty());
    (words.collect::<Vec<_>>().join("\n"), out.status.code())
}

#[test]
fn what_programs_do_is_compared() {
    let same = "Same behaviour: with the same inputs, all devices have the same values.";
    let all_others = "All other devices have the same values, with the same inputs.";
    // Other networks, of which folding makes the same.
    let old = "LD X0\nMPS\nAND X1\nOUT Y0\nMPP\nOUT Y1\nEND\n";
    let new = "LD X0\nAND X1\nOUT Y0\nLD X0\nOUT Y1\nEND\n";
    assert_eq!(behaviour(old, new), (same.to_string(), Some(0)));
    // Y1 is apart from what changed; M1 and Y2 read it.
    let old =
        "LD X0\nOUT M0\nLDP X1\nOUT Y1\nLD M0\nOUT M1\nLD M1\nOUT T0 K5\nLD T0\nOUT Y2\nEND\n";
    let new = old.replace("LD X0", "LDI X0");
    let expected = format!(
        "Outputs that can differ: Y002.\nOther devices that can differ: M0 to M1, T0.\n{all_others}"
    );
    assert_eq!(behaviour(old, &new), (expected, Some(1)));
    // An index may lead anywhere.
    let old = "LD X2\nMOV K4X010 Z0\nLD X0\nMOV K1 D0Z0\nLD= D50 K1\nOUT Y0\nLD X1\nOUT Y1\nEND\n";
    let (words, code) = behaviour(old, &old.replace("K1 D0Z0", "K2 D0Z0"));
    assert!(
        words.starts_with("Outputs that can differ: Y000."),
        "{words}"
    );
    assert_eq!(code, Some(1));
    // A jump decides about what it skips.
    let old = "LD X0\nCJ P1\nLD X1\nOUT Y0\nP1\nLD X2\nOUT Y1\nEND\n";
    let (words, _) = behaviour(old, &old.replace("LD X0", "LD X5"));
    assert!(words.contains("Y000"), "{words}");
    // Programs that do not compile are not compared.
    let (words, code) = behaviour(old, "LD X0\nOUT Y7777\nEND\n");
    assert!(words.starts_with("Behaviour not decided: "), "{words}");
    assert_eq!(code, Some(1));
    let h2u = format!(";! cpu = FX2N\n{old}");
    let (words, _) = behaviour(old, &h2u);
    assert_eq!(
        words,
        "Behaviour not decided: the programs are for different models."
    );
}

#[test]
fn instructions_that_keep_a_comparison_from_saying_more_are_named() {
    let old = "\
LD X0
MOV K5 D0
LD X1
PID D0 D10 D100 D20
LD X2
RCR D50 K1
LD X3
FROM K0 K1 D60 K1
END
";
    let new = old
        .replace("K5", "K6")
        .replace("LD X3\n", "LD X4\nRAMP D70 D71 D72 K9\nLD X3\n")
        .replace("K0 K1 D60", "K0 K2 D60");
    let folder = folder(&[("old.il", old.as_bytes()), ("new.il", new.as_bytes())]);
    let diff = |format: &str| {
        let args = ["diff", "old.il", "new.il", "--semantic", "--format", format];
        let out = rungc(folder.path(), &args);
        assert_eq!(out.status.code(), Some(1));
        text(&out.stdout)
    };
    let human = diff("human");
    let named = human.lines().find(|line| line.starts_with("Instructions "));
    insta::assert_snapshot!("vague", named.unwrap_or(&human));
    for format in ["md", "html"] {
        assert!(diff(format).contains(named.unwrap_or(&human)), "{format}");
    }
    let object: serde_json::Value = serde_json::from_str(&diff("json")).unwrap();
    insta::assert_snapshot!("vague_json", object["behaviour"]["vague"]);
    // None where none is reached.
    let ramp = "LD X0\nOUT Y0\nLD X1\nRAMP D0 D1 D2 K9\nEND\n";
    let (words, _) = behaviour(ramp, &ramp.replace("LD X0", "LDI X0"));
    assert!(
        words.starts_with("Outputs that can differ: Y000."),
        "{words}"
    );
    assert!(!words.contains("RAMP"), "{words}");
}

#[test]
fn a_page_shows_hostile_texts_as_texts() {
    let old = OLD.replace("start button", "<script>alert(1)</script>");
    let folder = folder(&[("old.il", old.as_bytes()), ("new.il", NEW.as_bytes())]);
    let args = [
        "diff", "old.il", "new.il", "--format", "html", "-o", "d.html",
    ];
    assert_eq!(rungc(folder.path(), &args).status.code(), Some(1));
    let page = fs::read_to_string(folder.path().join("d.html")).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>"));
    assert!(!page.contains("<script"), "{page}");
    assert!(page.contains("&lt;script&gt;alert(1)"));
    assert_eq!(page.matches("<svg").count(), 2 * 3 + 1 + 2 + 1);
}

#[test]
fn what_cannot_be_compared_is_reported() {
    let folder = folder(&[
        ("a.il", MOTOR.as_bytes()),
        ("b.il", b"LD X0\nOUT !!\nEND\n"),
    ]);
    let messages = |args: &[&str]| {
        let out = rungc(folder.path(), args);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        assert!(out.stdout.is_empty(), "{args:?}");
        text(&out.stderr)
    };
    assert!(messages(&["diff", "a.il", "b.il"]).contains("b.il cannot be read whole"));
    assert!(messages(&["diff", "a.il", "c.il"]).contains("c.il"));
    assert!(messages(&["diff", "a.il", "a.il", "a.il"]).contains("two programs"));
    assert!(messages(&["diff", "a.il"]).contains("2 values"));
}

fn git(folder: &Path, args: &[&str]) -> Output {
    Command::new("git")
        .args(["-c", "user.name=Test", "-c", "user.email=test@example.org"])
        .args(args)
        .current_dir(folder)
        .env("PATH", path())
        .env("GIT_CONFIG_GLOBAL", "/dev/null")
        .env("GIT_PAGER", "cat")
        .output()
        .unwrap()
}

/// The search path, with rungc first.
fn path() -> std::ffi::OsString {
    let own = Path::new(env!("CARGO_BIN_EXE_rungc")).parent().unwrap();
    let usual = std::env::var_os("PATH").unwrap_or_default();
    let all = std::iter::once(own.to_owned()).chain(std::env::split_paths(&usual));
    std::env::join_paths(all).unwrap()
}

/// A line of the book's page on comparing.
fn documented(line: &str) -> String {
    let page = Path::new(env!("RUNGC_ROOT")).join("docs/src/diff.md");
    let page = fs::read_to_string(page).unwrap();
    assert!(page.lines().any(|other| other == line), "{line}");
    line.to_string()
}

#[test]
fn git_compares_projects_by_rungc() {
    if Command::new("git").arg("--version").output().is_err() {
        eprintln!("skipped: there is no git here");
        return;
    }
    let export = |list: &str| {
        let read = rungc_frontend::read_text("list.il", list);
        rungc_frontend::print::to_csv(&read.program)
    };
    let folder = folder(&[]);
    let at = folder.path();
    let ok = |args: &[&str]| {
        let out = git(at, args);
        assert!(out.status.success(), "{args:?}: {}", text(&out.stderr));
        text(&out.stdout)
    };
    ok(&["init", "-q"]);
    for line in [
        "git config --global diff.rungc.command \"rungc diff\"",
        "git config --global diff.rungc.textconv \"rungc convert --to il\"",
    ] {
        let line = documented(line);
        let quoted = line.split('"').nth(1).unwrap();
        let key = line.split(' ').nth(3).unwrap();
        ok(&["config", key, quoted]);
    }
    let attributes = [
        documented("*.gxw diff=rungc"),
        documented("MAIN.csv diff=rungc"),
    ];
    fs::write(at.join(".gitattributes"), attributes.join("\n")).unwrap();
    fs::write(at.join("MAIN.csv"), export(OLD)).unwrap();
    ok(&["add", "."]);
    ok(&["commit", "-q", "-m", "First"]);
    fs::write(at.join("MAIN.csv"), export(NEW)).unwrap();
    let out = ok(&["diff"]);
    assert!(out.starts_with("--- MAIN.csv\n+++ MAIN.csv\n"), "{out}");
    assert!(
        out.contains("2 networks changed, 1 added, 1 removed, 2 remarked"),
        "{out}"
    );
    assert!(out.contains("+  │  X000     X002 "), "{out}");
    // New and deleted files, and a program that cannot be read.
    ok(&["mv", "MAIN.csv", "new.gxw"]);
    ok(&["commit", "-q", "-a", "-m", "Rename"]);
    fs::write(at.join("MAIN.csv"), export(OLD)).unwrap();
    ok(&["add", "MAIN.csv"]);
    fs::write(at.join("new.gxw"), "LD X0\nOUT !!\nEND\n").unwrap();
    let out = ok(&["diff", "HEAD"]);
    assert!(out.contains("networks added"), "{out}");
    assert!(
        out.contains("new.gxw: new.gxw cannot be read whole"),
        "{out}"
    );
    // Log and blame compare texts.
    let out = ok(&["log", "-p", "--no-ext-diff", "-1", "--no-renames"]);
    assert!(
        out.contains("+OUT T0 K50") || out.contains("OUT T0 K50"),
        "{out}"
    );
}
