//! What properties mean: conditions, time, outputs, and what is outside the program.

use super::{MODES, timeless};
use crate::common::{folder, rungc, text};

/// Each table is valid without its last line. `check` reports what the commands that prove and search report.
#[test]
fn properties_that_cannot_be_read_are_reported_by_check() {
    let folder = folder(&[("modes.il", MODES.as_bytes())]);
    let rows = [
        "[[property]]\nnever = \"Y000 &\"",
        "[[property]]\nalways = \"pump\"",
        "[[property]]\nreachable = \"D70\"",
        "[[property]]\nwhenever = \"X000\"\nthen = \"Y000 Y001\"",
        "[[property]]\nwhenever = \"X000\"\nthen = \"Y001\"\nwithin = \"soon\"",
        "[[property]]\nstays = \"(Y000\"",
        "[[property]]\nstays = \"Y000\"\nuntil = \"X000)\"",
        "[[property]]\nnever = \"Y777 & M0\"",
        "[[property]]\nnever = \"D9000 > 3\"",
        "[[property]]\nnever = \"D70 > 40000\"",
        "[[property]]\nalways = \"D70 < 32768\"",
        "[[property]]\nnever = \"X000 & !X000\"",
        "[[property]]\nalways = \"K1Y000 <= 15\"",
        "[[property]]\nthen = \"Y000\"\nwhenever = \"D70 > 5 & D70 < 2\"",
        "[[property]]\nwhenever = \"X000\"\nthen = \"Y000 | !Y000\"",
        "[verify]\nassume = [\"!\"]",
        "[verify]\nassume = [\"Y000 != Y000\"]",
        "[verify]\nfree = [\"D9000\"]",
        "[verify]\nscan = \"40s\"",
        "[verify]\ntimeout = \"long\"",
        "[hmi]\nwrites = \"M9000\"",
    ];
    for row in rows {
        let settings = format!("[project]\nprogram = \"modes.il\"\n{row}\n");
        std::fs::write(folder.path().join("rungc.toml"), &settings).unwrap();
        let output = rungc(folder.path(), &["check"]);
        let shown = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{row}: {shown}");
        let place = 2 + row.lines().count();
        let is_placed = shown.contains(&format!("[ rungc.toml:{place}:"));
        assert!(shown.contains("E0042") && is_placed, "{row}: {shown}");
    }
    let all = format!(
        "[project]\nprogram = \"modes.il\"\n{}\n",
        rows[..16].join("\n")
    );
    std::fs::write(folder.path().join("rungc.toml"), all).unwrap();
    let shown = text(&rungc(folder.path(), &["check"]).stderr);
    assert_eq!(shown.matches("error[E0042]").count(), 16, "{shown}");
    // A project's settings say nothing of other programs.
    std::fs::write(folder.path().join("other.il"), "LD X000\nOUT Y000\nEND\n").unwrap();
    assert_eq!(
        rungc(folder.path(), &["check", "other.il"]).status.code(),
        Some(0)
    );
}

/// The same verdict in proofs and searches: what comes with the first scan after the deadline is late, a trigger counts
/// when it begins, and groups of four digits are signed.
#[test]
fn a_property_means_the_same_to_all_commands() {
    let next_scan = "LD M0\nOUT Y000\nLD X000\nOUT M0\nEND\n";
    let same_scan = "LDP X000\nOUT Y000\nEND\n";
    let group = "LD M8000\nMOV K4X000 K4Y000\nEND\n";
    let counted = "LD M8000\nOUT C235 K9\nDHSCS K2 C235 Y000\nEND\n";
    let timed = "EI\nLD= D0 K2\nOUT Y000\nFEND\nI620\nLD X001\nINC D0\nIRET\nEND\n";
    let late = "whenever = \"X000\"\nthen = \"Y000\"\nwithin = \"1ms\"";
    let cases = [
        (next_scan, late, true),
        (next_scan, &late.replace("1ms", "3s"), false),
        (same_scan, &late.replace("\nwithin = \"1ms\"", ""), false),
        (same_scan, "always = \"X000 = Y000\"", true),
        (group, "never = \"K4Y000 = 40960\"", true),
        (group, "never = \"K4Y000 < -30000\"", true),
        (counted, "never = \"Y000\"", true),
        (timed, "never = \"Y000\"", true),
    ];
    for (program, property, is_violated) in cases {
        let settings = format!("[project]\nprogram = \"p.il\"\n[[property]]\n{property}\n");
        let files = [
            ("p.il", program.as_bytes()),
            ("rungc.toml", settings.as_bytes()),
        ];
        let folder = folder(&files);
        let verify = ["verify", "--replay", "interp"];
        let explore = [
            "explore",
            "--scans",
            "20000",
            "--write-test",
            "run.plctest.toml",
        ];
        for command in [&verify[..], &explore] {
            let output = rungc(folder.path(), command);
            let shown = text(&output.stderr);
            assert_eq!(
                output.status.code(),
                Some(is_violated.into()),
                "{property}: {shown}"
            );
        }
        // The written test sees the violation, too.
        if is_violated {
            let output = rungc(
                folder.path(),
                &["test", "run.plctest.toml", "--engine", "interp"],
            );
            assert_eq!(output.status.code(), Some(1), "{property}");
        }
    }
}

/// An output is its terminal, which M8034 switches off.
#[test]
fn outputs_are_terminals() {
    let plain = "LD X000\nOUT Y000\nEND\n";
    let switched = "LD X000\nOUT Y000\nLD X001\nOUT M8034\nEND\n";
    let folder = folder(&[("a.il", plain.as_bytes()), ("b.il", switched.as_bytes())]);
    let code = |args: &[&str]| rungc(folder.path(), args).status.code();
    let stays = ["--always", "Y000 = X000"];
    assert_eq!(code(&["verify", "a.il", stays[0], stays[1]]), Some(0));
    for command in ["verify", "explore"] {
        assert_eq!(
            code(&[command, "b.il", stays[0], stays[1]]),
            Some(1),
            "{command}"
        );
        let group = ["--never", "K1Y000 = 0 & X000"];
        assert_eq!(
            code(&[command, "b.il", group[0], group[1]]),
            Some(1),
            "{command}"
        );
    }
    assert_eq!(code(&["verify", "b.il", "--same-as", "a.il"]), Some(1));
    assert_eq!(code(&["verify", "b.il", "--same-as", "b.il"]), Some(0));
    let output = rungc(folder.path(), &["diff", "--semantic", "a.il", "b.il"]);
    let shown = text(&output.stdout);
    assert!(shown.contains("Outputs that can differ: Y000."), "{shown}");
}

/// A proof is taken back if the program itself ends all runs that keep what is assumed.
#[test]
fn what_a_program_contradicts_is_vacuous() {
    let timed = "LD M8000\nOUT T0 K20\nLD T0\nOUT Y000\nOUT Y001\nLD X000\nOUT Y002\nEND\n";
    let pacer =
        "LD M8002\nMOV K2000 D8039\nLD M8000\nOUT M8039\nLD X000\nOUT M0\nLD M0\nOUT Y000\nEND\n";
    let slow = "[project]\nprogram = \"pacer.il\"\n[[property]]\nalways = \"Y000 = M0\"\n";
    let files = [
        ("timed.il", timed.as_bytes()),
        ("pacer.il", pacer.as_bytes()),
        ("rungc.toml", slow.as_bytes()),
    ];
    let folder = folder(&files);
    let verify = |args: &[&str]| {
        let args = [&["verify", "--replay", "interp"], args].concat();
        let output = rungc(folder.path(), &args);
        (output.status.code(), text(&output.stdout))
    };
    let never = ["timed.il", "--never", "Y001"];
    assert_eq!(verify(&never).0, Some(1));
    let (code, shown) = verify(&[&never[..], &["--assume", "!Y000"]].concat());
    assert_eq!(code, Some(3), "{shown}");
    assert!(shown.starts_with("vacuous     never Y001"), "{shown}");
    assert!(
        shown.contains("the program contradicts the assumption `!Y000`"),
        "{shown}"
    );
    // Inputs can keep what is assumed of them, whatever the program does.
    let kept = [
        "timed.il",
        "--never",
        "Y002 & X000 & X001",
        "--assume",
        "!(X000 & X001)",
    ];
    assert_eq!(verify(&kept).0, Some(0));
    let kept = [
        "timed.il",
        "--never",
        "Y002 & X001",
        "--assume",
        "!Y002 | !X001",
    ];
    assert_eq!(verify(&kept).0, Some(0));
    // Scans that last longer than is assumed.
    let (code, shown) = verify(&["pacer.il"]);
    assert_eq!(code, Some(3), "{shown}");
    assert!(shown.contains("scans of at most 200 ms"), "{shown}");
    assert_eq!(verify(&["pacer.il", "--scan", "3s"]).0, Some(0));
    let (code, shown) = verify(&["timed.il", "--same-as", "timed.il", "--assume", "!Y000"]);
    assert_eq!(code, Some(3), "{shown}");
}

/// An index register that something else may write leads anywhere.
#[test]
fn index_registers_may_be_written_from_outside() {
    let unwritten = "LD X000\nOUT Y004\nLD X006\nMOV K1 K4Y000Z0\nEND\n";
    let written = unwritten.replace(
        "LD X006",
        "LD M8002\nMOV K0 Z0\nLD X001\nMOV K3 Z0\nLD X006",
    );
    let files = [
        ("unwritten.il", unwritten.as_bytes()),
        ("written.il", written.as_bytes()),
    ];
    let folder = folder(&files);
    let code = |args: &[&str]| rungc(folder.path(), args).status.code();
    let both = ["--never", "Y004 & Y005"];
    for command in ["verify", "explore"] {
        assert_eq!(
            code(&[command, "unwritten.il", both[0], both[1]]),
            Some(1),
            "{command}"
        );
        let freed = [command, "written.il", both[0], both[1], "--free", "Z0"];
        assert_eq!(code(&freed), Some(1), "{command}");
    }
    assert_eq!(code(&["verify", "written.il", both[0], both[1]]), Some(0));
}

#[test]
fn a_property_of_devices_that_are_not_there_is_rejected() {
    let folder = folder(&[("modes.il", MODES.as_bytes())]);
    for condition in [
        "Y777",
        "!M9000",
        "X000 & D9000 > 3",
        "T300.value = 5",
        "K4M1530 = 5",
    ] {
        for command in ["verify", "explore"] {
            let output = rungc(folder.path(), &[command, "modes.il", "--never", condition]);
            let shown = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{condition}: {shown}");
            assert!(
                shown.contains("does not exist on Mitsubishi FX1N"),
                "{shown}"
            );
        }
    }
}

#[test]
fn devices_that_each_scan_sets_are_not_free() {
    let folder = folder(&[("modes.il", MODES.as_bytes())]);
    for (free, refused) in [("M8013", true), ("M8000..M8005", true), ("M8034", false)] {
        let args = [
            "verify",
            "modes.il",
            "--never",
            "Y000 & M8000",
            "--free",
            free,
        ];
        let shown = text(&rungc(folder.path(), &args).stderr);
        let is_refused = shown.contains("cannot be set: each scan sets it");
        assert_eq!(is_refused, refused, "{free}: {shown}");
    }
}

/// Each new form of conditions, in `rungc.toml` and on the command line, by comments too.
#[test]
fn conditions_speak_of_bits_results_and_earlier_scans() {
    let program = ";! D0 = Speed\n;! Y000 = Pump\n;! Y001 = Valve\n;! X000 = Start\n\
                   LD M8000\nMOV K2X000 D0\nDMOV K0 D10\nLD D0.3\nOUT Y000\nLDP X000\nOUT Y001\nLD X001\nOUT M0\nEND\n";
    let folder = folder(&[("p.il", program.as_bytes())]);
    let code = |args: &[&str]| {
        let args = [&["verify", "p.il"], args].concat();
        rungc(folder.path(), &args).status.code()
    };
    for proved in [
        "Speed.3 = Pump",
        "Speed + 10 > 9",
        "Valve = rises(Start)",
        "!Valve | !was(Valve)",
        "Start before Valve",
        "!(Valve for 1ms)",
        "at most one of (Valve, falls(Start))",
        "M0 = X001 & (D0.f32 < 1e-30 | D1 != 0)",
    ] {
        assert_eq!(code(&["--always", proved]), Some(0), "{proved}");
    }
    for violated in [
        "Speed - was(Speed) < 100",
        "!(Pump for 2s)",
        "Valve before Pump",
        "exactly one of (Pump, Valve)",
        "Speed * Speed < 32768",
    ] {
        assert_eq!(code(&["--always", violated]), Some(1), "{violated}");
    }
    // Arithmetic of floats is not modelled: neither proved nor violated.
    let args = [
        "verify",
        "p.il",
        "--always",
        "D10.f32 + 1 > 0.5",
        "--timeout",
        "2s",
    ];
    let output = rungc(folder.path(), &args);
    insta::assert_snapshot!("floats_not_modelled", timeless(&text(&output.stdout)));
    assert_eq!(output.status.code(), Some(3));
}

#[test]
fn a_property_of_what_nothing_drives_has_a_warning() {
    let folder = folder(&[(
        "p.il",
        b"LD X000\nOR M5\nMOV K3 D0Z0\nOUT Y000\nLD Y005\nOUT Y001\nEND\n",
    )]);
    let warned = |condition: &str, more: &[&str]| {
        let args = [&["verify", "p.il", "--never", condition], more].concat();
        let shown = text(&rungc(folder.path(), &args).stderr);
        let line = shown.lines().find(|line| line.contains("W0802"));
        line.unwrap_or_default().to_string()
    };
    insta::assert_snapshot!(warned("Y005 & M500 & D7 > 1 & X077 & M8013 & M5", &[]), @"warning[W0802]: `never Y005 & M500 & D7 > 1 & X077 & M8013 & M5`: nothing drives `Y005`, `M500`");
    assert_eq!(warned("Y001 & M500", &["--free", "M500"]), "");
    assert_eq!(warned("Y000 & X005 & !M5", &[]), "");
}

/// A tool finds the verdicts where they are without a warning.
#[test]
fn a_warning_and_verdicts_are_one_report() {
    let folder = folder(&[("p.il", b"LD X000\nOUT Y000\nEND\n")]);
    let shown = |format: &str| {
        let args = [
            "verify",
            "p.il",
            "--never",
            "Y000 & M500",
            "--format",
            format,
        ];
        text(&rungc(folder.path(), &args).stdout)
    };
    let report: serde_json::Value = serde_json::from_str(&shown("json")).unwrap();
    let codes = report["diagnostics"].as_array().unwrap().iter();
    let codes: Vec<_> = codes.map(|found| found["code"].clone()).collect();
    assert_eq!(codes, ["W0802", "E0800"]);
    assert_eq!(report["warnings"], 1);
    assert_eq!(report["errors"], 1);
    assert_eq!(report["verification"]["report"], "rungc verify");
    let junit = shown("junit");
    assert_eq!(junit.matches("<testcase ").count(), 1, "{junit}");
}

/// An assessor who reads the results of tests finds the requirements that tests do not cover.
#[test]
fn tests_name_the_properties_that_they_leave_to_proofs() {
    let settings = "[project]\nprogram = \"p.il\"\n[test]\nfiles = [\"t.plctest.toml\"]\n\
                    [[property]]\nid = \"R1\"\ntext = \"Interlock\"\nnever = \"Y000 & Y001\"\n\
                    [[property]]\nreachable = \"Y000\"\n";
    let test = "topic = \"t\"\nmodel = \"fx3u\"\nprogram = { file = \"p.il\" }\n\
                [[case]]\nname = \"on\"\n[[case.step]]\nset = { X000 = 1 }\nexpect = { Y000 = 1 }\n";
    let folder = folder(&[
        ("p.il", b"LD X000\nOUT Y000\nLDI X000\nOUT Y001\nEND\n"),
        ("rungc.toml", settings.as_bytes()),
        ("t.plctest.toml", test.as_bytes()),
    ]);
    let shown = |format: &str| {
        let output = rungc(folder.path(), &["test", "--format", format]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let report: serde_json::Value = serde_json::from_str(&shown("json")).unwrap();
    insta::assert_snapshot!(report["untested"], @r#"[{"property":"never Y000 & Y001","requirement":"R1"},{"property":"reachable Y000"}]"#);
    let junit = shown("junit");
    let suite = junit.find("name=\"rungc.toml\"").unwrap();
    let suite = &junit[suite..];
    assert!(
        suite.contains("skipped=\"2\"") && suite.contains("value=\"R1\""),
        "{junit}"
    );
    assert_eq!(suite.matches("<skipped message=").count(), 2, "{junit}");
}

/// The same property twice, and a device that the program writes and something else, too (P11, P12).
#[test]
fn a_written_test_is_read_again_and_fails() {
    let program = "LD X000\nOUT M22\nLD M22\nOUT Y000\nEND\n";
    let settings = "[project]\nprogram = \"p.il\"\n[verify]\nfree = [\"M22\"]\n\
                    [[property]]\nnever = \"Y000 | M22\"\n[[property]]\nnever = \"Y000 | M22\"\n\
                    [[property]]\nwhenever = \"Y000 & was(Y000)\"\nthen = \"\"\"\n!M22 &\n !X000\"\"\"\nwithin = \"20ms\"\n";
    let folder = folder(&[
        ("p.il", program.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let args = ["verify", "--write-test", "t.plctest.toml"];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let test = std::fs::read_to_string(folder.path().join("t.plctest.toml")).unwrap();
    insta::assert_snapshot!("written_test", test);
    let output = rungc(folder.path(), &["test", "t.plctest.toml"]);
    let shown = text(&output.stdout) + &text(&output.stderr);
    assert!(shown.contains("0 passed, 3 failed"), "{shown}");
}

/// The first violation does not wait for a compiler.
#[test]
fn a_violation_is_shown_without_building_anything() {
    let folder = folder(&[("p.il", b"LD X000\nOUT Y000\nEND\n")]);
    let cache = folder.path().join("cache");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_rungc"))
        .current_dir(folder.path())
        .args(["verify", "p.il", "--never", "Y000"])
        .env("RUNGC_CACHE_DIR", &cache)
        .env("PATH", "")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(!cache.exists(), "nothing is built");
}
