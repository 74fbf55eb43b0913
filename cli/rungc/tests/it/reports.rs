//! Presentation of findings: places as their reader knows them, bounded drawings, and nothing that a terminal would act
//! on.

use crate::common::{code, folder, rungc, shown, text};
use serde_json::Value;

/// A `MAIN.wpg` for FX3U: LD X000, OUT T0 K30, OUT X001, an unknown instruction, END.
fn wpg() -> Vec<u8> {
    let mut bytes = vec![0x40, 0x00, 0x22, 0x01];
    bytes.resize(0x24, b' ');
    bytes.extend([0x04, 0x02, 0x08, 0x02]);
    bytes.resize(0x40, 0xFF);
    bytes.extend([0x04, 0x00, 0xFF, 0xFF]);
    bytes.extend([3, 0x00, 3, 4, 0x9C, 0, 4]);
    bytes.extend([3, 0x20, 3, 4, 0x9D, 0, 4]);
    bytes.extend([3, 0x00, 3, 4, 0x9C, 2, 4]);
    bytes.extend([3, 0x20, 3, 4, 0x9C, 1, 4]);
    bytes.extend([3, 0x34, 3]);
    bytes.extend([0x02; 64]);
    bytes
}

/// A list export with a wrong operand in its third instruction, and a row that is none.
const EXPORT: &str = "\"Press\"\r\n\"PLC Information:\"\t\"FXCPU FX3U/FX3UC\"\r\n\
    \"Step No.\"\t\"Line Statement\"\t\"Instruction\"\t\"I/O(Device)\"\t\"Blank\"\t\"PI Statement\"\t\"Note\"\r\n\
    \"0\"\t\"\"\t\"LD\"\t\"X000\"\r\n\
    \"1\"\t\"\"\t\"OUT\"\t\"T0\"\r\n\
    \"\"\t\"\"\t\"\"\t\"K30\"\r\n\
    \"4\"\t\"\"\t\"MOV\"\t\"K5\"\r\n\
    \"\"\t\"\"\t\"\"\t\"X1\"\r\n\
    \"9\"\t\"\"\t\"=\"\t\"Y0\"\r\n\
    \"10\"\t\"\"\t\"END\"\r\n";

#[test]
fn places_in_projects_and_exports_are_steps() {
    let folder = folder(&[("MAIN.wpg", &wpg()), ("press.csv", EXPORT.as_bytes())]);
    for (name, file) in [("project", "MAIN.wpg"), ("export", "press.csv")] {
        let plain = shown(folder.path(), &["check", file]);
        insta::assert_snapshot!(format!("places_{name}"), plain);
        for format in ["json", "sarif"] {
            let args = ["check", file, "--format", format];
            insta::assert_snapshot!(
                format!("places_{name}_{format}"),
                shown(folder.path(), &args)
            );
        }
    }
}

/// A line of a megabyte: each finding draws the part of it that it is about.
#[test]
fn long_lines_are_drawn_in_part() {
    let line = format!("LD X0{}\nEND\n", " X009".repeat(20_000));
    let folder = folder(&[("long.il", line.as_bytes())]);
    let output = rungc(folder.path(), &["check", "long.il", "--limit", "3"]);
    let messages = text(&output.stderr);
    assert!(messages.lines().all(|line| line.chars().count() < 200));
    insta::assert_snapshot!(messages);
    // Whatever the number of findings, the text grows with it alone.
    let all = rungc(folder.path(), &["check", "long.il", "--limit", "0"]);
    let (lines, most) = (text(&all.stderr).lines().count(), 13 * 20_010);
    assert!(lines > 20_000 && lines < most, "{lines}");
}

#[cfg(unix)]
/// Each of these characters makes a terminal do something, or shows the text in another order.
const HOSTILE: &str = "\u{1b}]0;x\u{7}\u{9b}2J\u{202e}\u{2066}";

#[cfg(unix)]
fn is_harmless(messages: &str) -> bool {
    let acts = |c: char| c.is_control() && c != '\n' && c != '\t';
    !messages
        .chars()
        .any(|c| acts(c) || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}'))
}

#[cfg(unix)]
/// A text without the escape sequences that set colours.
fn without_colours(messages: &str) -> String {
    let mut parts = messages.split("\u{1b}[");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (code, rest) = part.split_once('m').expect("a colour");
        assert!(
            code.chars().all(|c| c.is_ascii_digit() || c == ';'),
            "{code:?}"
        );
        plain.push_str(rest);
    }
    plain
}

/// Names of files with such characters exist on Unix only.
#[cfg(unix)]
#[test]
fn nothing_hostile_reaches_the_terminal() {
    let padding = "; a text holds few control characters\n".repeat(20);
    let program = format!(
        "{padding}LD X0 ; {HOSTILE}\nFOO{HOSTILE} D0\nMOV {HOSTILE} D0\n$MOV \"{HOSTILE}\" X0\nEND\n"
    );
    let name = "a\u{1b}[31mred\u{202e}.il";
    let tests = format!(
        "model = \"fx3u\"\ntopic = \"OUT\"\n\n[[case]]\nname = \"a{}\"\nsource = \"{0}\"\nnote = \"{0}\"\n\
         program = \"LD X0\\nOUT Y0\\nEND\\n\"\n[[case.step]]\nexpect = {{ Y000 = 1 }}\n",
        "\\u001b[2J\\u009b\\u202e"
    );
    let folder = folder(&[
        (name, program.as_bytes()),
        ("ok\u{1b}[2J.il", b"LD X0\nOUT Y0\nEND\n"),
        ("bad.plctest.toml", tests.as_bytes()),
    ]);
    for args in [
        &["check", name][..],
        &["check", "ok\u{1b}[2J.il"],
        &["check", "missing\u{1b}[2J\u{202e}.il"],
        &["build", "ok\u{1b}[2J.il", "--emit", "ir"],
        &["check", name, "--format", "json"],
        &["check", name, "--format", "sarif"],
        &["explain", HOSTILE],
        &["test", "bad.plctest.toml"],
    ] {
        let output = rungc(folder.path(), args);
        for messages in [&output.stdout, &output.stderr] {
            let messages = text(messages);
            assert!(is_harmless(&messages), "{args:?}: {messages:?}");
        }
    }
    let coloured = rungc(folder.path(), &["check", name, "--color", "always"]);
    let messages = text(&coloured.stderr);
    assert!(messages.contains("\u{1b}[31m"), "{messages}");
    assert!(is_harmless(&without_colours(&messages)), "{messages:?}");
    insta::assert_snapshot!(
        "hostile_text",
        text(&rungc(folder.path(), &["check", name]).stderr)
    );
}

/// What a name puts at the beginning of a line could be a command to a CI server.
#[cfg(unix)]
#[test]
fn names_stay_on_their_line() {
    let name = "a\n::error::x.il";
    let folder = folder(&[(name, b"\x01\x02")]);
    for args in [
        &["check", name][..],
        &["check", "."],
        &["view", name],
        &["check", "a.il", "--project", name],
        &["run", "a.il", "--set", name],
        &["explain", name],
        &[name],
    ] {
        let output = rungc(folder.path(), args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        let messages = text(&output.stdout) + &text(&output.stderr);
        let forged = messages.lines().any(|line| line.trim().starts_with("::"));
        assert!(
            !forged && messages.contains("line break"),
            "{args:?}: {messages}"
        );
    }
}

/// Documents for tools can be read whatever the file is called.
#[test]
fn documents_are_json_whatever_the_names() {
    let name = "a\u{9b}\u{202e}b.il";
    let folder = folder(&[(name, b"LD X0\nOUT Y0\nEND\n")]);
    for args in [
        &["check", name, "--format", "json"][..],
        &["check", name, "--format", "sarif"],
        &["stats", name, "--to", "json"],
        &["xref", name, "--to", "json"],
        &["diff", name, name, "--format", "json"],
        &["explore", "missing\u{9b}.il", "--format", "json"],
        &["verify", "missing\u{9b}.il", "--format", "json"],
    ] {
        let output = rungc(folder.path(), args);
        let document: Result<Value, _> = serde_json::from_slice(&output.stdout);
        assert!(document.is_ok(), "{args:?}: {}", text(&output.stdout));
    }
}

/// Devices that are driven and never read, and places of a coil: some in the human format, all for tools.
#[test]
fn lists_are_complete_for_tools() {
    let mut list = String::new();
    for m in 0..30 {
        list.push_str(&format!("LD X0\nOUT M{m}\nLD X1\nOUT Y0\n"));
    }
    list.push_str("END\n");
    let folder = folder(&[("many.il", list.as_bytes())]);
    insta::assert_snapshot!("many", shown(folder.path(), &["check", "many.il"]));
    let document = |format| -> Value {
        let args = ["check", "many.il", "--format", format];
        serde_json::from_slice(&rungc(folder.path(), &args).stdout).unwrap()
    };
    let json = document("json");
    let of = |code: &str| {
        let found = json["diagnostics"].as_array().unwrap();
        found.iter().find(|d| d["code"] == code).unwrap().clone()
    };
    let length = |value: &Value| value.as_array().map_or(0, Vec::len);
    assert_eq!(length(&of("W0201")["devices"]), 30);
    assert_eq!(length(&of("W0201")["related"]), 29);
    assert_eq!(length(&of("W0203")["related"]), 29);
    let sarif = document("sarif");
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    let unread = results.iter().find(|r| r["ruleId"] == "W0201").unwrap();
    assert_eq!(length(&unread["properties"]["devices"]), 30);
    assert_eq!(length(&unread["relatedLocations"]), 29);
}

/// A list has no way to write a line break in a text; an export has.
#[test]
fn a_text_that_a_list_cannot_hold_is_refused() {
    let export = EXPORT
        .replace("\"MOV\"\t\"K5\"", "\"$MOV\"\t\"\"\"a\tb\nc\"\"\"")
        .replace("\"X1\"", "\"D0\"")
        .replace("\"=\"\t\"Y0\"", "\"OUT\"\t\"Y0\"");
    let folder = folder(&[("text.csv", export.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["convert", "text.csv", "--to", "il"]));
    let args = ["convert", "text.csv", "--to", "csv", "-o", "again.csv"];
    assert_eq!(code(folder.path(), &args), 0);
    let again = std::fs::read(folder.path().join("again.csv")).unwrap();
    let units = again
        .chunks_exact(2)
        .map(|unit| u16::from_le_bytes([unit[0], unit[1]]));
    let again = String::from_utf16(&units.collect::<Vec<_>>()).unwrap();
    assert!(again.contains("\"\"\"a\tb\nc\"\"\""), "{again}");
}

/// A program with labels has one thing wrong with it.
#[test]
fn labels_are_one_error() {
    let list = "LD bStart\nANI bStop\nOUT qMotor_on\nLD X0\nOUT Y0\nEND\n";
    let folder = folder(&[("labels.il", list.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["check", "labels.il"]));
}

/// In documents for tools, which are UTF-8, names of files that are not stay apart; a test file with such a name, whose
/// paths would lead elsewhere, is rejected in each of them.
#[cfg(target_os = "linux")]
#[test]
fn names_that_are_not_utf8_are_escaped() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder(&[]);
    let names: [&[u8]; 2] = [b"\xB5\xE7.il", b"\xBB\xFA.il"];
    for name in names.map(OsStr::from_bytes) {
        std::fs::write(folder.path().join(name), "LD X0\nOUT X1\nEND\n").unwrap();
    }
    for format in ["json", "junit", "github"] {
        let output = rungc(folder.path(), &["check", ".", "--format", format]);
        let document = text(&output.stdout);
        for name in [r"\xB5\xE7.il", r"\xBB\xFA.il"] {
            let name = if format == "json" {
                name.replace('\\', r"\\")
            } else {
                name.to_owned()
            };
            assert!(document.contains(&name), "{format}: {document}");
        }
    }
    let below = folder.path().join(OsStr::from_bytes(b"\xB5"));
    std::fs::create_dir(&below).unwrap();
    let test = "topic = \"t\"\nmodel = \"fx3u\"\n[[case]]\nname = \"a\"\nprogram = \"a.il\"\n[[case.step]]\n";
    std::fs::write(below.join("t.plctest.toml"), test).unwrap();
    std::fs::write(below.join("a.il"), "LD X0\nOUT Y0\nEND\n").unwrap();
    for format in ["human", "json", "junit", "sarif", "github"] {
        let output = rungc(folder.path(), &["test", ".", "--format", format]);
        assert_eq!(output.status.code(), Some(2), "{format}");
        let messages = text(&output.stdout) + &text(&output.stderr);
        assert!(messages.contains("is not UTF-8; rename it"), "{messages}");
    }
    assert_eq!(std::fs::read_dir(&below).unwrap().count(), 2);
}
