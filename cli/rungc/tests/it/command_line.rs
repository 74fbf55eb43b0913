//! The command line as its user sees it: what is printed where, what is written, and the exit code.

use crate::common;
use crate::common::{MOTOR, code, folder, rungc, shown, text};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Three errors and a double coil.
const BAD: &str = "LD X000\nOUT Y000\nLD X009\nMOVE D0 D1\nADD D0 K1\nOUT Y000\nEND\n";

/// Correct, with a double coil.
const DOUBLE: &str = "LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n";

/// A `MAIN.wpg` for FX3U: LD X000, OUT Y000, END.
fn wpg() -> Vec<u8> {
    let bodies: &[&[u8]] = &[&[0x00], &[0x9C, 0], &[0x20], &[0x9D, 0], &[0x34]];
    common::wpg(common::FX3U, bodies)
}

#[test]
fn check_for_people() {
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("bad.il", BAD.as_bytes()),
        ("MAIN.wpg", &wpg()),
    ]);
    insta::assert_snapshot!("check_good", shown(folder.path(), &["check", "motor.il"]));
    insta::assert_snapshot!("check_bad", shown(folder.path(), &["check", "bad.il"]));
    insta::assert_snapshot!(
        "check_project",
        shown(folder.path(), &["check", "MAIN.wpg"])
    );
    insta::assert_snapshot!(
        "check_limit",
        shown(folder.path(), &["check", "bad.il", "--limit", "1"])
    );
}

#[test]
fn check_for_tools() {
    let folder = folder(&[("bad.il", BAD.as_bytes()), ("motor.il", MOTOR.as_bytes())]);
    for format in ["json", "sarif"] {
        let args = ["check", "bad.il", "--format", format];
        insta::assert_snapshot!(format!("check_{format}"), shown(folder.path(), &args));
        for file in ["bad.il", "motor.il"] {
            let output = rungc(folder.path(), &["check", file, "--format", format]);
            let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
            assert!(read.is_object());
            assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
        }
    }
}

/// `--` before a negative value would not help.
#[test]
fn options_take_no_negative_values() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    for [command, option, value] in [
        ["run", "--for", "-1s"],
        ["run", "--for", "-0.5s"],
        ["explore", "--seed", "-1"],
    ] {
        let output = rungc(folder.path(), &[command, "motor.il", option, value]);
        let said = text(&output.stderr);
        let tip = format!("'{option}' takes no negative value");
        assert!(said.contains(&tip) && !said.contains("'-- "), "{said}");
        assert_eq!(output.status.code(), Some(2));
    }
    let output = rungc(folder.path(), &["check", "-1"]);
    assert!(
        text(&output.stderr).contains("'-- -1'"),
        "a file may have this name"
    );
}

/// A limit of the PLC keeps a program from being built, unless it is made a warning; what has no storage stays an
/// error.
#[test]
fn limits_can_be_warnings() {
    let list = "LD X0\nFMOV K0 D0 K513\nEND\n";
    let folder = folder(&[("long.il", list.as_bytes())]);
    let check = |args: &[&str]| rungc(folder.path(), &[&["check", "long.il"], args].concat());
    assert_eq!(check(&[]).status.code(), Some(1));
    let eased = check(&["--warn", "E0105"]);
    assert_eq!(eased.status.code(), Some(0));
    assert!(text(&eased.stderr).contains("warning[E0105]"));
    assert_eq!(
        check(&["-W", "limits", "--deny-warnings"]).status.code(),
        Some(1)
    );
    let built = [
        "build", "long.il", "--warn", "limits", "--emit", "c", "-o", "c",
    ];
    assert_eq!(rungc(folder.path(), &built).status.code(), Some(0));
    for (code, why) in [
        ("E0106", "no storage"),
        ("E0413", "nothing can be compiled"),
    ] {
        let refused = check(&["--warn", code]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            text(&refused.stderr).contains(why),
            "{}",
            text(&refused.stderr)
        );
    }
    std::fs::write(
        folder.path().join("rungc.toml"),
        "[check]\nwarn = [\"E0105\"]\n",
    )
    .unwrap();
    assert_eq!(check(&[]).status.code(), Some(0));
}

/// Results of a command and its reports do not mix on standard output.
#[test]
fn reports_for_tools_leave_standard_output_clean() {
    let folder = folder(&[("double.il", DOUBLE.as_bytes())]);
    let args = ["build", "double.il", "--emit", "c", "--format", "json"];
    let output = rungc(folder.path(), &args);
    let read: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(read["warnings"], 1);
    assert_eq!(output.status.code(), Some(0));
    for args in [
        &["build", "double.il", "--emit", "ir"][..],
        &["run", "double.il"],
        &["convert", "double.il", "--to", "il"],
    ] {
        let plain = rungc(folder.path(), args);
        let output = rungc(folder.path(), &[args, &["--format", "json"]].concat());
        assert_eq!(output.stdout, plain.stdout, "{args:?}");
        let read: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
        assert!(read["diagnostics"].is_array(), "{args:?}");
    }
}

#[test]
fn warnings_can_be_denied_or_allowed() {
    let folder = folder(&[("double.il", DOUBLE.as_bytes())]);
    let check = |args: &[&str]| code(folder.path(), &[&["check", "double.il"], args].concat());
    assert_eq!(check(&[]), 0);
    assert_eq!(check(&["--deny-warnings"]), 1);
    assert_eq!(check(&["--deny-warnings", "-A", "w0203"]), 0);
    assert_eq!(check(&["--deny-warnings", "-A", "double-coil"]), 0);
    assert_eq!(check(&["--deny-warnings", "-A", "W0201"]), 1);
    assert_eq!(check(&["-A", "W9999"]), 2);
    insta::assert_snapshot!(
        "allow_unknown",
        shown(folder.path(), &["check", "double.il", "-A", "W9999"])
    );
}

/// Tools get an object for input that is not a program, too, with exit code 2.
#[test]
fn unreadable_input_for_tools() {
    let folder = folder(&[("junk.bin", &[0, 159, 146, 150, 0, 1, 2, 3])]);
    for format in ["json", "sarif"] {
        let args = ["check", "missing.il", "--format", format];
        insta::assert_snapshot!(format!("unreadable_{format}"), shown(folder.path(), &args));
    }
    let args = ["build", "junk.bin", "--emit", "ir", "--format", "json"];
    let output = rungc(folder.path(), &args);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty(), "taken by the IR");
    let read: serde_json::Value = serde_json::from_slice(&output.stderr).unwrap();
    assert_eq!(read["errors"], 1);
    assert_eq!(read["diagnostics"][0]["code"], "E0010");
}

#[test]
fn what_an_export_cannot_hold_is_reported() {
    let list = format!(";! X000 = start button\n{MOTOR}");
    let folder = folder(&[("motor.il", list.as_bytes())]);
    let messages = |to| text(&rungc(folder.path(), &["convert", "motor.il", "--to", to]).stderr);
    assert!(messages("csv").contains("1 device comment omitted"));
    assert!(messages("il").is_empty());
    assert!(messages("comments").is_empty());
    let written = ["convert", "motor.il", "--to", "comments"];
    let written = rungc(folder.path(), &written).stdout;
    let text: String =
        char::decode_utf16(written.chunks(2).map(|c| u16::from_le_bytes([c[0], c[1]])))
            .map(|c| c.unwrap())
            .collect();
    assert!(text.ends_with("\"X000\"\t\"start button\"\r\n"), "{text}");
}

#[test]
fn drawn_ladder_reads_back() {
    // Blocks without need, an unknown instruction, notes, and a text with the characters of a drawing.
    let odd = "; Head\nP0\nLD X0\nLD X1\nANB\nOUT Y0 ; lamp\nLD X2\nMPS\nAND X3 ; inner\nOUT Y1\nMRD\nOUT Y2 ; note\nMPP\nSET M0\nLD X4\n$MOV \"|--( [\" D0\nLD X5\nFOO D0\nEND\n";
    let wide: String = (0..40).map(|n| format!("AND M{n}\n")).collect();
    let wide = format!("LD X0\n{wide}OUT Y0\nEND\n");
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("odd.il", odd.as_bytes()),
        ("wide.il", wide.as_bytes()),
    ]);
    let path = folder.path();
    let converted = |file: &str, to: &str| rungc(path, &["convert", file, "--to", to]).stdout;
    for name in ["motor.il", "odd.il", "wide.il"] {
        let drawn = converted(name, "ladder");
        fs::write(path.join("drawn.txt"), &drawn).unwrap();
        let again = text(&converted("drawn.txt", "il"));
        assert_eq!(again, text(&converted(name, "il")), "{}", text(&drawn));
    }
    insta::assert_snapshot!(
        "convert_ladder",
        shown(path, &["convert", "odd.il", "--to", "ladder"])
    );
    fs::write(path.join("broken.txt"), "|--[ X0 ]--+--( Y0 )--|\n|          +--[ X1 ]---\n|---| |---(Y1)--|\n|--[ X2 ]--[ X3 ]--|\n").unwrap();
    insta::assert_snapshot!(
        "drawn_ladder_with_mistakes",
        shown(path, &["check", "broken.txt"])
    );
}

/// Every list of the corpus beside the repository, where there is one.
#[test]
fn the_corpus_reads_back_from_drawn_ladder() {
    let corpus = Path::new(env!("RUNGC_ROOT")).join("../shared/corpus");
    let Ok(files) = rungc_frontend::programs(&corpus, usize::MAX) else {
        println!("skipped: there is no corpus here");
        return;
    };
    let folder = folder(&[]);
    let path = folder.path();
    for file in files {
        let name = file.display().to_string();
        let list = rungc(path, &["convert", &name, "--to", "il"]);
        let drawn = rungc(path, &["convert", &name, "--to", "ladder"]);
        fs::write(path.join("drawn.txt"), drawn.stdout).unwrap();
        let again = rungc(path, &["convert", "drawn.txt", "--to", "il"]);
        let plain = |bytes: &[u8]| -> String {
            let steps = |line: &str| {
                line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ')
                    .to_string()
            };
            text(bytes)
                .lines()
                .map(steps)
                .collect::<Vec<_>>()
                .join("\n")
        };
        assert_eq!(plain(&again.stdout), plain(&list.stdout), "{name}");
    }
}

#[test]
fn convert_there_and_back() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes()), ("MAIN.wpg", &wpg())]);
    let path = folder.path();
    let list = rungc(path, &["convert", "motor.il", "--to", "il"]).stdout;
    assert_eq!(
        code(
            path,
            &["convert", "motor.il", "--to", "csv", "-o", "out.csv"]
        ),
        0
    );
    assert_eq!(
        code(
            path,
            &["convert", "motor.il", "--to", "csv", "-o", "out.csv"]
        ),
        2
    );
    assert_eq!(
        code(
            path,
            &[
                "convert", "motor.il", "--to", "csv", "-o", "out.csv", "--force"
            ]
        ),
        0
    );
    let bytes = fs::read(path.join("out.csv")).unwrap();
    assert_eq!(bytes[..2], [0xFF, 0xFE], "UTF-16 with its mark");
    let back = rungc(path, &["convert", "out.csv", "--to", "il"]);
    let instructions = |bytes: &[u8]| -> Vec<String> {
        let text = text(bytes);
        let lines = text
            .lines()
            .map(|l| l.split(';').next().unwrap_or("").trim().to_owned());
        lines.filter(|l| !l.is_empty()).collect()
    };
    // An export has step numbers, whether or not the list has.
    let unnumbered = |line: String| {
        let (step, rest) = line.split_once(' ').unwrap();
        step.parse::<u32>()
            .map_or(line.clone(), |_| rest.to_owned())
    };
    let back = instructions(&back.stdout);
    let back: Vec<_> = back.into_iter().map(unnumbered).collect();
    assert_eq!(back, instructions(&list));
    insta::assert_snapshot!(
        "convert_il",
        shown(path, &["convert", "out.csv", "--to", "il"])
    );
    insta::assert_snapshot!(
        "convert_project",
        shown(path, &["convert", "MAIN.wpg", "--to", "il"])
    );
}

#[test]
fn explain_topics() {
    let folder = folder(&[]);
    for topic in [
        "E0106",
        "double-coil",
        "LD>=",
        "M8013",
        "6706",
        "6503",
        "nonsense",
        "MOVE",
        "fx1s",
    ] {
        let name = format!("explain_{}", topic.replace(">=", "_ge"));
        insta::assert_snapshot!(name, shown(folder.path(), &["explain", topic]));
    }
    let add = rungc(folder.path(), &["explain", "add"]);
    assert!(text(&add.stdout).contains("ADD"));
    assert_eq!(add.status.code(), Some(0));
    for (topic, model) in [
        ("M8013", "h2u"),
        ("M8052", "fx3u"),
        ("EADD", "fx1s"),
        ("PLSR", "h2u-xp"),
        ("6503", "fx2n"),
        ("E0106", "fx3u"),
        ("M8010", "fx3u"),
    ] {
        let name = match topic {
            "M8013" => "explain_special_on_model".to_owned(),
            _ => format!("explain_{topic}_on_{model}"),
        };
        let args = ["explain", topic, "--model", model];
        insta::assert_snapshot!(name, shown(folder.path(), &args));
    }
}

#[test]
fn unknown_topics_get_proposals() {
    let folder = folder(&[]);
    for (topic, near) in [
        ("6799", "6771, 6772, 6773"),
        ("106", "did you mean `E0106`?"),
        ("M8010", "M8009, M8011"),
        ("d100", "`D100` is a general device"),
        ("DMOVX", "`DMOV`"),
        ("h2u-mtx", "`h2u-mtp`"),
        ("fx3w", "`fx3"),
        ("dubble-coil", "`double-coil`"),
        ("E6706", "did you mean `6706`?"),
        ("w6105", "did you mean `6105`?"),
        ("Error 6707", "did you mean `6707`?"),
    ] {
        let found = rungc(folder.path(), &["explain", topic]);
        assert_eq!(found.status.code(), Some(2), "{topic}");
        let message = text(&found.stderr);
        assert!(message.contains(near), "{topic}: {message}");
    }
}

#[test]
fn wrong_usage() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    for args in [
        &[][..],
        &["frobnicate"],
        &["check"],
        &["check", "motor.il", "--model", "s7"],
        &["build", "motor.il"],
        &["build", "motor.il", "--emit", "pascal"],
        &["convert", "motor.il"],
        &["test"],
        &["test", "nowhere.plctest.toml"],
        &["explain"],
    ] {
        assert_eq!(code(folder.path(), args), 2, "{args:?}");
    }
    assert_eq!(code(folder.path(), &["--help"]), 0);
    assert_eq!(code(folder.path(), &["run", "--help"]), 0);
    assert_eq!(code(folder.path(), &["completions", "bash"]), 0);
    let args = ["check", "motor.il", "--model", "s7"];
    insta::assert_snapshot!("unknown_model", shown(folder.path(), &args));
}

#[test]
fn inputs_that_are_no_program() {
    let junk: Vec<u8> = (0..400_u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    let mut cut = wpg();
    cut.truncate(0x4A);
    let folder = folder(&[("empty.il", b""), ("junk.bin", &junk), ("cut.wpg", &cut)]);
    fs::create_dir(folder.path().join("nothing")).unwrap();
    for (name, file) in [
        ("missing", "missing.il"),
        ("directory", "nothing"),
        ("empty", "empty.il"),
        ("junk", "junk.bin"),
        ("cut", "cut.wpg"),
    ] {
        insta::assert_snapshot!(
            format!("input_{name}"),
            shown(folder.path(), &["check", file])
        );
        let build = code(folder.path(), &["build", file, "--emit", "ir"]);
        assert!(build == 1 || build == 2, "{file}");
    }
}

#[test]
fn build_writes_and_does_not_overwrite() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes()), ("bad.il", BAD.as_bytes())]);
    let path = folder.path();
    insta::assert_snapshot!(
        "build_ir",
        shown(path, &["build", "motor.il", "--emit", "ir"])
    );
    for (emit, file) in [("c", "motor.c"), ("rust", "Cargo.toml")] {
        let args = ["build", "motor.il", "--emit", emit, "-o", emit];
        insta::assert_snapshot!(format!("build_{emit}"), shown(path, &args));
        assert!(path.join(emit).join(file).is_file());
        insta::assert_snapshot!(format!("build_{emit}_again"), shown(path, &args));
        let forced = [&args[..], &["--force"]].concat();
        assert_eq!(code(path, &forced), 0);
    }
    assert_eq!(
        code(path, &["build", "bad.il", "--emit", "c", "-o", "none"]),
        1
    );
    assert!(
        !path.join("none").exists(),
        "a program with errors is not emitted"
    );
}

/// Emitted files have the permissions of the user's mask, like those of an editor.
#[cfg(unix)]
#[test]
fn files_have_the_permissions_of_new_files() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let mode = |file: &str| fs::metadata(path.join(file)).unwrap().permissions().mode() & 0o777;
    fs::write(path.join("usual"), "").unwrap();
    for args in [
        &["build", "motor.il", "--emit", "c", "-o", "c"][..],
        &["convert", "motor.il", "--to", "csv", "-o", "motor.csv"],
    ] {
        assert_eq!(code(path, args), 0);
    }
    assert_eq!(mode("c/motor.c"), mode("usual"));
    assert_eq!(mode("motor.csv"), mode("usual"));
}

#[test]
fn build_writes_into_a_folder_that_is_there() {
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let out = folder.path().join("out");
    fs::create_dir(&out).unwrap();
    let args = ["build", "../motor.il", "--emit", "rust", "-o", "."];
    assert_eq!(code(&out, &args), 0, "an empty folder");
    assert_eq!(code(&out, &args), 2, "not empty any more");
    fs::write(out.join("src/lib.rs"), "old").unwrap();
    fs::write(out.join("notes.txt"), "kept").unwrap();
    let forced = [&args[..], &["--force"]].concat();
    assert_eq!(code(&out, &forced), 0);
    assert!(fs::read_to_string(out.join("src/lib.rs")).unwrap().len() > 3);
    assert!(out.join("notes.txt").is_file());
    let left = fs::read_dir(&out).unwrap().flatten().map(|e| e.file_name());
    assert!(
        left.into_iter()
            .all(|name| !name.to_string_lossy().starts_with(".rungc"))
    );
}

/// The host's main program stands in `main.c`, beside what a `MAIN.csv` or `main.il` becomes.
#[test]
fn a_program_may_be_called_main() {
    let folder = folder(&[("main.il", MOTOR.as_bytes())]);
    let path = folder.path();
    assert_eq!(
        code(
            path,
            &["build", "main.il", "--emit", "c", "--main", "-o", "out"]
        ),
        0
    );
    assert!(path.join("out/main.c").is_file() && path.join("out/plc_main.c").is_file());
}

#[test]
fn build_makes_an_executable_that_scans() {
    for tool in ["cc", "make"] {
        if Command::new(tool).arg("--version").output().is_err() {
            println!("skipped: there is no {tool}");
            return;
        }
    }
    let folder = folder(&[("motor.il", MOTOR.as_bytes())]);
    let path = folder.path();
    let args = ["build", "motor.il", "--emit", "bin", "-o", "motor"];
    insta::assert_snapshot!("build_bin", shown(path, &args));
    assert_eq!(code(path, &args), 2, "it is there already");
    let mut running = Command::new(path.join("motor"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(200));
    // It scans until it is stopped, or ends when its input does; it does not crash.
    match running.try_wait().unwrap() {
        Some(status) => assert_eq!(status.code(), Some(0)),
        None => running.kill().unwrap(),
    }
    running.wait().unwrap();
}

#[test]
fn test_files_pass_and_fail() {
    let suite = |expected: u8| {
        format!(
            "model = \"h2u\"\ntopic = \"OUT\"\n\n[[case]]\nname = \"follows\"\nprogram = \"\"\"\nLD X000\nOUT Y000\nEND\n\"\"\"\n\
             [[case.step]]\nset = {{ X000 = 1 }}\nexpect = {{ Y000 = {expected} }}\n"
        )
    };
    let folder = folder(&[
        ("good.plctest.toml", suite(1).as_bytes()),
        ("bad.plctest.toml", suite(0).as_bytes()),
        ("odd.plctest.toml", b"model = \"h2u\"\ncolour = 3\n"),
    ]);
    for name in ["good", "bad", "odd"] {
        let file = format!("{name}.plctest.toml");
        insta::assert_snapshot!(
            format!("test_{name}"),
            shown(folder.path(), &["test", &file])
        );
    }
}

#[test]
fn colours_when_asked_for() {
    let folder = folder(&[("bad.il", BAD.as_bytes())]);
    let output = rungc(folder.path(), &["check", "bad.il", "--color", "always"]);
    assert!(text(&output.stderr).contains("\u{1b}["));
}

/// `check --fix` does what is certain and nothing else, keeps the file's form, and reports its changes.
#[test]
fn certain_fixes_are_applied() {
    let list = "\u{FEFF}; cam\u{e9}ra\r\nLD X0\r\nMOV 0x1F D0\r\nLDN X1\r\nOUTY0\r\nLD X2 OUT Y1\r\nLD X3\r\nINC D1\r\nMOV M0 D2\r\nMOV X\r\n";
    let folder = folder(&[("old.il", list.as_bytes()), ("MAIN.wpg", &wpg())]);
    let output = shown(folder.path(), &["check", "old.il", "--fix"]);
    insta::assert_snapshot!("check_fix", output);
    let fixed = std::fs::read_to_string(folder.path().join("old.il")).unwrap();
    assert_eq!(
        fixed,
        "\u{FEFF}; cam\u{e9}ra\r\nLD X0\r\nMOV H1F D0\r\nLDI X1\r\nOUT Y000\r\nLD X2\r\nOUT Y1\r\nLD X3\r\nINC D1\r\nMOV M0 D2\r\nMOV X\r\nEND\r\n"
    );
    let again = rungc(folder.path(), &["check", "old.il", "--fix"]);
    assert!(!text(&again.stderr).contains("Fixed"));
    let project = rungc(folder.path(), &["check", "MAIN.wpg", "--fix"]);
    assert!(text(&project.stderr).contains("change this one in its editor"));
    let piped = rungc(folder.path(), &["check", "-", "--fix"]);
    assert_eq!(piped.status.code(), Some(2));
    // Not UTF-8: left as it is.
    let gbk = b"; \xC6\xF4\xB6\xAF\xB0\xB4\xC5\xA5\r\nLD X0\r\nMOV 0x1F D0\r\n";
    std::fs::write(folder.path().join("gbk.il"), gbk).unwrap();
    let refused = rungc(folder.path(), &["check", "gbk.il", "--fix"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("not UTF-8"));
    assert_eq!(std::fs::read(folder.path().join("gbk.il")).unwrap(), gbk);
}

#[test]
fn lanes_are_for_emitted_c_of_programs_that_can_share_a_scan() {
    let pulses = "LD X000\nPLSY K1000 K500 Y000\nEND\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("pulses.il", pulses.as_bytes()),
    ]);
    let path = folder.path();
    let build = |file: &str, emit: &str| {
        let args = ["build", file, "--emit", emit, "--lanes", "64", "-o", "out"];
        let output = rungc(path, &args);
        let text = text(&output.stderr);
        (
            output.status.code(),
            text.lines().last().map(str::to_string),
        )
    };
    assert_eq!(build("motor.il", "c").0, Some(0));
    assert!(path.join("out/motor_lanes.h").is_file());
    for (file, emit, says) in [
        (
            "motor.il",
            "rust",
            "rungc: --lanes only applies to --emit c (`rungc book lanes`)",
        ),
        (
            "pulses.il",
            "c",
            "rungc: --lanes: pulses sends pulses, which only one instance at a time can do (`rungc book lanes`)",
        ),
    ] {
        assert_eq!(build(file, emit), (Some(2), Some(says.to_string())));
    }
}

/// `access` of rungc.toml counts where C is emitted; on the command line it goes with C alone.
#[test]
fn device_access_is_for_emitted_c() {
    let settings = "[build]\naccess = true\n";
    let folder = folder(&[
        ("motor.il", MOTOR.as_bytes()),
        ("rungc.toml", settings.as_bytes()),
    ]);
    let path = folder.path();
    assert_eq!(
        code(path, &["build", "motor.il", "--emit", "c", "-o", "c"]),
        0
    );
    assert!(path.join("c/motor_access.h").is_file());
    assert_eq!(
        code(path, &["build", "motor.il", "--emit", "rust", "-o", "rust"]),
        0
    );
    let args = ["build", "motor.il", "--emit", "rust", "--device-access"];
    insta::assert_snapshot!(
        text(&rungc(path, &args).stderr),
        @"rungc: --device-access only applies to --emit c and --emit lib; emitted Rust has the trait `Plc` for this"
    );
}

#[cfg(windows)]
#[test]
fn what_windows_lacks_is_rejected_by_name() {
    let io = b"[project]\nprogram = 'p.il'\n[io.pins]\ngpio = 'gpiochip0'\nX000 = 'read 17'\n";
    let folder = folder(&[("p.il", b"LD X000\nOUT Y000\nEND\n"), ("io.toml", io)]);
    let rejected = |args: &[&str]| {
        let args = [
            &["serve", "p.il", "--model", "h2u", "--fx", "127.0.0.1:0"],
            args,
        ]
        .concat();
        let output = rungc(folder.path(), &args);
        assert_eq!(output.status.code(), Some(2));
        let printed = text(&output.stderr);
        let line = printed.lines().find(|line| line.contains("only on"));
        line.expect(&printed).to_owned()
    };
    insta::assert_snapshot!(rejected(&["--priority", "50"]), @"rungc: --priority 50: real-time priorities (SCHED_FIFO) exist only on Linux; leave out this option");
    insta::assert_snapshot!(rejected(&["--serial", "COM1=pty"]), @"rungc: --serial: cannot open a pseudo-terminal: pseudo-terminals exist only on Linux and macOS; name a serial port or `tcp-listen:PORT`");
    insta::assert_snapshot!(rejected(&["--can", "can0"]), @"rungc: --can: cannot open can0: CAN interfaces (SocketCAN) exist only on Linux; an adapter is written `slcan:PORT`");
    insta::assert_snapshot!(rejected(&["--io", "io.toml"]), @"rungc: [io.pins]: `gpio` exists only on Linux");
}

/// A file of another kind is named for what it is.
#[test]
fn programs_and_test_files_are_not_confused() {
    let folder = folder(&[
        ("a.il", b"LD X0\nOUT Y0\nEND\n"),
        ("a.gxw", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1\xFF\xFF"),
        ("a.png", b"\x89PNG\r\n\x1a\n\0\xFF"),
        (
            "t.plctest.toml",
            b"topic = \"a\"\nmodel = \"fx3u\"\nprogram = { file = \"a.il\" }\n",
        ),
    ]);
    let said = |args: &[&str]| {
        let output = rungc(folder.path(), args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        text(&output.stderr)
    };
    let all = [
        &["test", "a.il"][..],
        &["test", "a.gxw"],
        &["test", "a.png"],
        &["run", "a.il", "--machine", "a.il"],
        &["check", "t.plctest.toml"],
    ];
    insta::assert_snapshot!(all.map(said).concat());
}
