//! rungc.toml: what its settings do, how its mistakes are reported, and how it comes to be.

use crate::common;
use crate::common::{MOTOR, code, folder, rungc, shown, text};
use std::fs;
use std::path::Path;

/// Correct, with a double coil.
const DOUBLE: &str = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";

/// A list for a model that is named in it.
const FX2N: &str = ";! cpu = FX2N\nLD X000\nOUT Y000\nEND\n";

/// A case that holds on an engine.
const CASE: &str = "model = \"fx3u\"\ntopic = \"OUT\"\n\n[[case]]\nname = \"follows\"\nprogram = \"LD X000\\nOUT Y000\\nEND\\n\"\n\
     [[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n";

fn messages(folder: &Path, args: &[&str]) -> String {
    text(&rungc(folder, args).stderr)
}

#[test]
fn commands_take_the_program_of_the_project() {
    let settings = "[project]\nprogram = 'plc/motor.il'\nmodel = 'h2u'\n";
    let folder = folder(&[("rungc.toml", settings.as_bytes())]);
    let path = folder.path();
    let inner = path.join("plc/deep");
    fs::create_dir_all(&inner).unwrap();
    fs::write(path.join("plc/motor.il"), MOTOR).unwrap();
    insta::assert_snapshot!("project_check", shown(path, &["check"]));
    assert!(messages(&inner, &["check"]).contains("Checked motor.il (H2U"));
    assert!(messages(path, &["check", "--model", "fx3u"]).contains("(FX3U"));
    assert!(messages(path, &["check", "-v"]).contains("Settings"));
    assert_eq!(messages(path, &["check", "-q"]), "");
    for args in [
        &["run", "--for", "100ms"][..],
        &["convert", "--to", "il"],
        &["build", "--emit", "ir"],
    ] {
        assert_eq!(code(path, args), 0, "{args:?}");
    }
    let elsewhere = common::folder(&[]);
    let given = path.join("rungc.toml");
    let args = ["check", "--project", given.to_str().unwrap()];
    assert!(messages(elsewhere.path(), &args).contains("Checked motor.il (H2U"));
}

#[test]
fn no_program_and_no_project() {
    let none = folder(&[]);
    insta::assert_snapshot!("project_none", shown(none.path(), &["check"]));
    let silent = folder(&[("rungc.toml", b"[check]\nallow = ['W0203']\n")]);
    insta::assert_snapshot!("project_silent", shown(silent.path(), &["check"]));
    insta::assert_snapshot!("project_no_tests", shown(silent.path(), &["test"]));
    insta::assert_snapshot!(
        "project_missing",
        shown(none.path(), &["check", "--project", "nowhere.toml"])
    );
}

#[test]
fn rules_about_codes() {
    let folder = folder(&[("double.il", DOUBLE.as_bytes())]);
    let path = folder.path();
    let check = |settings: &str, args: &[&str]| {
        fs::write(path.join("rungc.toml"), settings).unwrap();
        let output = rungc(path, &[&["check", "double.il"], args].concat());
        let warned = text(&output.stderr).contains("[W0203]");
        (output.status.code().unwrap(), warned)
    };
    let (allow, deny) = (
        "[check]\nallow = ['double-coil']\n",
        "[check]\ndeny = ['W0203']\n",
    );
    assert_eq!(check("", &[]), (0, true));
    assert_eq!(check(allow, &[]), (0, false));
    assert_eq!(check(allow, &["--deny-warnings"]), (0, false));
    assert_eq!(check(allow, &["-D", "W0203"]), (1, true));
    assert_eq!(check(deny, &[]), (1, true));
    assert_eq!(check(deny, &["-A", "W0203"]), (0, false));
    assert_eq!(check("", &["--deny", "double-coil"]), (1, true));
    for (option, reason) in [
        ("-D", "is an error already"),
        ("-A", "cannot be suppressed"),
    ] {
        let output = rungc(path, &["check", "double.il", option, "E0106"]);
        assert!(text(&output.stderr).contains(reason), "{option}");
    }
}

#[test]
fn mistakes_are_drawn() {
    let settings = "[project]\nprogram = 'double.il'\nmodel = 'fx4u'\n\n[chek]\nallow = []\n";
    let folder = folder(&[
        ("rungc.toml", settings.as_bytes()),
        ("double.il", DOUBLE.as_bytes()),
    ]);
    let path = folder.path();
    insta::assert_snapshot!("project_mistakes", shown(path, &["check"]));
    let args = ["check", "--format", "json"];
    insta::assert_snapshot!("project_mistakes_json", shown(path, &args));
    for settings in [
        "[build]\nemit = 'cc'\n",
        "[build]\ntarget = 'hosts'\n",
        "[test]\nengine = 'interpreter'\n",
    ] {
        fs::write(path.join("rungc.toml"), settings).unwrap();
        for command in [&["check", "double.il"][..], &["test", "none.plctest.toml"]] {
            let output = rungc(path, command);
            assert_eq!(output.status.code(), Some(2), "{settings}");
            assert!(text(&output.stderr).contains("error[E0042]"), "{settings}");
        }
    }
}

/// Properties in settings that name no program apply to none: `check` says so once, `verify` rejects it.
#[test]
fn properties_that_apply_to_no_program() {
    let settings = "[[property]]\nnever = 'Y000 & Y001'\n";
    let folder = folder(&[
        ("a.il", b"LD X000\nOUT Y000\nEND\n"),
        ("b.il", b"LD X001\nOUT Y001\nEND\n"),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let path = folder.path();
    let note = "Properties of rungc.toml apply to no program";
    let count = |args: &[&str]| {
        let output = rungc(path, args);
        assert_eq!(output.status.code(), Some(0), "{args:?}");
        text(&output.stderr).matches(note).count()
    };
    assert_eq!(count(&["check", "a.il"]), 1);
    assert_eq!(count(&["check", "."]), 1);
    assert_eq!(count(&["check", "a.il", "--quiet"]), 0);
    fs::write(
        path.join("rungc.toml"),
        format!("[project]\nprogram = 'a.il'\n{settings}"),
    )
    .unwrap();
    assert_eq!(count(&["check", "."]), 0);
}

/// A relay with one half in the program has its other half outside: at a connection, in what is served, as a fault.
#[test]
fn halves_outside_the_program() {
    let program =
        "LD M11\nAND M12\nAND M13\nOUT Y000\nLD M14\nOUT M10\nOUT M15\nLD M21\nOUT M20\nEND\n";
    let project = "[project]\nprogram = 'p.il'\nmodel = 'fx3u'\n";
    let outside = "\
[retain]
file = 'latched'
fault = 'M13'

[serve]
modbus-tcp = 0
M = 'M14-M15'

[io.panel]
files = '.'
fault = 'M12'
M10 = 'write lamp'
M11 = 'read switch'
";
    let folder = folder(&[("p.il", program.as_bytes())]);
    let path = folder.path();
    let check = |settings: &str| {
        fs::write(path.join("rungc.toml"), settings).unwrap();
        shown(path, &["check"])
    };
    insta::assert_snapshot!("project_halves", check(project));
    insta::assert_snapshot!(
        "project_halves_outside",
        check(&format!("{project}{outside}"))
    );
}

#[test]
fn what_is_latched() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    fs::write(
        path.join("rungc.toml"),
        "[latched]\nD = ['D200-D299', 'D400']\n",
    )
    .unwrap();
    let verbose = messages(path, &["check", "motor.il", "-v"]);
    assert!(verbose.contains("D200 to D299"), "{verbose}");
    fs::write(path.join("rungc.toml"), "[latched]\nD = 'D10-D20'\n").unwrap();
    let args = ["check", "motor.il", "--model", "fx3g"];
    insta::assert_snapshot!("project_latched", shown(path, &args));
}

#[test]
fn what_build_makes() {
    let settings = "[project]\nprogram = 'motor.il'\nname = 'press'\n\n[build]\nemit = 'c'\noutput = 'firmware/plc'\n";
    let folder = folder(&[
        ("rungc.toml", settings.as_bytes()),
        ("motor.il", MOTOR.as_bytes()),
        ("double.il", DOUBLE.as_bytes()),
    ]);
    let path = folder.path();
    assert_eq!(code(path, &["build"]), 0);
    assert!(path.join("firmware/plc/press.c").is_file());
    // Another form goes where it always goes, another program has its own name.
    assert_eq!(code(path, &["build", "--emit", "rust"]), 0);
    assert!(path.join("press-rust/Cargo.toml").is_file());
    assert_eq!(code(path, &["build", "double.il"]), 0);
    assert!(path.join("double-c/double.c").is_file());
    assert_eq!(code(path, &["build", "-o", "here", "--name", "mine"]), 0);
    assert!(path.join("here/mine.c").is_file());
}

/// Results and reports do not mix, also where the settings choose the output.
#[test]
fn what_build_prints() {
    let settings = "[project]\nprogram = 'motor.il'\n[build]\nemit = 'ir'\n";
    let folder = folder(&[
        ("rungc.toml", settings.as_bytes()),
        ("motor.il", MOTOR.as_bytes()),
    ]);
    let plain = rungc(folder.path(), &["build"]);
    let output = rungc(folder.path(), &["build", "--format", "json"]);
    assert!(!plain.stdout.is_empty());
    assert_eq!(output.stdout, plain.stdout);
    let read: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(read["errors"], 0);
}

#[test]
fn what_test_runs() {
    let folder = folder(&[
        (
            "rungc.toml",
            b"[test]\nfiles = ['tests']\nengine = 'interp'\n",
        ),
        ("other.plctest.toml", b"no test file\n"),
    ]);
    let path = folder.path();
    fs::create_dir(path.join("tests")).unwrap();
    fs::write(path.join("tests/out.plctest.toml"), CASE).unwrap();
    insta::assert_snapshot!("project_test", shown(path, &["test"]));
    insta::assert_snapshot!("project_test_inside", shown(&path.join("tests"), &["test"]));
}

#[test]
fn init_writes_settings_that_are_valid() {
    let folder = folder(&[("old.il", FX2N.as_bytes())]);
    let path = folder.path();
    insta::assert_snapshot!("init", shown(path, &["init"]));
    insta::assert_snapshot!(
        "init_file",
        fs::read_to_string(path.join("rungc.toml")).unwrap()
    );
    assert!(messages(path, &["check", "-v"]).contains("Checked old.il (FX2N"));
    insta::assert_snapshot!("init_again", shown(path, &["init"]));
    // Each setting that is a comment is one that can be made, but for those that need what is not there.
    let written = fs::read_to_string(path.join("rungc.toml")).unwrap();
    let is_setting =
        |line: &str| line.starts_with("# [") || line.starts_with("# ") && line.contains(" = ");
    let all = written.lines().map(|line| match is_setting(line) {
        true => line.trim_start_matches("# "),
        false => line,
    });
    fs::write(path.join("rungc.toml"), all.collect::<Vec<_>>().join("\n")).unwrap();
    insta::assert_snapshot!("init_all", shown(path, &["check"]));
}

#[test]
fn init_in_folders() {
    let folder = folder(&[("a.il", FX2N.as_bytes()), ("b.il", FX2N.as_bytes())]);
    let path = folder.path();
    assert_eq!(code(path, &["init"]), 0, "of two programs none is chosen");
    assert!(
        fs::read_to_string(path.join("rungc.toml"))
            .unwrap()
            .contains("# program")
    );
    fs::create_dir(path.join("deep")).unwrap();
    // A name that TOML has to escape; Windows permits no quotation marks.
    let name = if cfg!(windows) {
        "deep/'c'.il"
    } else {
        "deep/\"c\".il"
    };
    fs::write(path.join(name), FX2N).unwrap();
    assert_eq!(code(path, &["init", "deep"]), 0);
    assert_eq!(code(&path.join("deep"), &["check"]), 0);
    assert_eq!(code(path, &["init", "nowhere/x.il"]), 2);
    fs::remove_file(path.join("rungc.toml")).unwrap();
    assert_eq!(code(path, &["init", "b.il"]), 0);
    assert!(messages(path, &["check"]).contains("Checked b.il"));
}

#[test]
fn transfers_are_held_to_the_modules() {
    let program = "LD M8000\nFROM K0 K5 D0 K4\nFROM K0 K30 D10 K1\nFROM K0 K30 D12 K2\n\
        TO K0 K5 D20 K1\nTO K1 K1 K0 K1\n\
        FROM K0 K13 D14 K1\n\
        MOV U0\\G30 D15\nMOV D16 U0\\G9\n\
        DMOV U0\\G30 D18\nMOV U3\\G0 D17\nTOP K0 K20 K1 K1\nFROM D30 K0 D31 K1\nFROM K0 D30 D32 K1\nEND\n";
    let settings =
        "[project]\nprogram = 'a.il'\nmodel = 'fx3u'\n[[module]]\nat = 0\nkind = 'FX2N-4AD'\n";
    let folder = folder(&[
        ("rungc.toml", settings.as_bytes()),
        ("a.il", program.as_bytes()),
    ]);
    insta::assert_snapshot!("project_modules", shown(folder.path(), &["check"]));
    let without = common::folder(&[("a.il", program.as_bytes())]);
    let messages = messages(without.path(), &["check", "a.il"]);
    assert!(!messages.contains("module"), "{messages}");
}

#[test]
fn programs_are_held_to_a_variant() {
    let program = "LD X020\nDEADD D0 D2 D4\nPLSY K1000 K0 Y3\nPLSY K1000 K0 Y5\nLD X020\nOUT Y020\n\
        SPD X5 K100 D10\nOUT C251 K5\nLD C251\nOUT M0\nEI\nFEND\nI301\nLD M8000\nINC D6\nIRET\nEND\n";
    let settings = "[project]\nprogram = 'a.il'\nmodel = 'h2u-mtq'\n";
    let folder = folder(&[
        ("rungc.toml", settings.as_bytes()),
        ("a.il", program.as_bytes()),
    ]);
    let path = folder.path();
    insta::assert_snapshot!("project_variant", shown(path, &["check"]));
    for variant in ["h2u-mtp", "H2U-1616"] {
        let name = format!("project_{}", variant.to_lowercase());
        insta::assert_snapshot!(name, shown(path, &["check", "--model", variant]));
    }
    assert!(messages(path, &["check", "--model", "h2u"]).contains("0 errors"));
    assert_eq!(code(path, &["check", "--model", "h2u-xx"]), 2);
    insta::assert_snapshot!(
        "project_explain_variant",
        shown(path, &["explain", "h2u-mtp"])
    );
    insta::assert_snapshot!(
        "project_explain_base_unit",
        shown(path, &["explain", "H1U-0806"])
    );
}

/// Files that the settings name and that are not there are marked in the settings.
#[test]
fn absent_files_are_marked_where_they_are_named() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    for (settings, command, place) in [
        ("[project]\nprogram = 'n.il'\n", "check", "rungc.toml:2:11"),
        ("[project]\nprogram = 'n.il'\n", "run", "rungc.toml:2:11"),
        ("[test]\nfiles = [\n  'nope']\n", "test", "rungc.toml:3:3"),
    ] {
        fs::write(path.join("rungc.toml"), settings).unwrap();
        let output = rungc(path, &[command]);
        assert_eq!(output.status.code(), Some(2), "{settings}");
        let messages = text(&output.stderr);
        assert!(messages.contains(place), "{messages}");
        assert!(messages.contains("there is no `"), "{messages}");
    }
    fs::write(path.join("rungc.toml"), b"\xff\xfe[\0p\0").unwrap();
    assert!(messages(path, &["check", "motor.il"]).contains("it is UTF-16; save it as UTF-8"));
}
