//! Cross references, counts, and lists laid out.

use crate::common::clients::{python, succeeds};
use crate::common::{MOTOR, code, folder, rungc, shown, text};
use std::fs;

const USES: &str = "\
;! D10 = speed\n;! X000 = start\nLD X0\nDMOV K5 D10\nDMOV D11 D20\nMOV K2M0 D0Z1\nBMOV D100 D200 D0\nLDI T0\nOUT T0 D5\nOUT Y0\nLD M8013\n\
MC N0 M50\nLD X1\nSET S20\nCALL P1\nMCR N0\nLD X2\nRST C0\nFEND\nP1\nLD M3\nINC D10\nSRET\nEND\n";

#[test]
fn uses_are_listed_by_device() {
    let folder = folder(&[("uses.il", USES.as_bytes())]);
    insta::assert_snapshot!(shown(folder.path(), &["xref", "uses.il", "--unused"]));
}

#[test]
fn a_cross_reference_is_a_table_a_page_or_json() {
    let folder = folder(&[("uses.il", USES.as_bytes())]);
    let only = ["--device", "d10..d11", "--device", "M8013"];
    let written = |to: &str| {
        shown(
            folder.path(),
            &[&["xref", "uses.il", "--to", to], &only[..]].concat(),
        )
    };
    insta::assert_snapshot!("xref_csv", written("csv"));
    insta::assert_snapshot!("xref_json", written("json"));
    let page = written("html");
    for part in [
        "<!DOCTYPE html>",
        "speed",
        "DMOV D11 D20",
        "Areas that overlap",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("http"), "the page needs the network");
}

#[test]
fn terminals_and_tags_are_tables() {
    let program = format!(
        "{}{USES}",
        ";! X003 = Not-Halt 1\n;! Y001 = lamp, green\n;! D20 = speed\n;! D30 = 1. Rezept\n;! C200 = pieces\n;! M8013 = clock\n"
    );
    let folder = folder(&[("uses.il", program.as_bytes())]);
    let written = |args: &[&str]| shown(folder.path(), &[&["xref", "uses.il"], args].concat());
    let bytes = |args: &[&str]| {
        let all = [&["xref", "uses.il", "--to", "io"], args].concat();
        rungc(folder.path(), &all).stdout
    };
    assert!(
        bytes(&[]).starts_with(b"\xef\xbb\xbf"),
        "Excel reads it as UTF-8"
    );
    insta::assert_snapshot!("xref_io", written(&["--to", "io"]).replace('\u{feff}', ""));
    insta::assert_snapshot!("xref_tags", written(&["--to", "tags"]));
    // Each model has its own addresses.
    let one = ["--to", "tags", "--model", "h2u", "--device", "X000"];
    insta::assert_snapshot!("xref_tags_h2u", written(&one));
    assert!(bytes(&["--device", "X007"]).ends_with(b"\nX007,,,\n"));
    // A heading, and 24 inputs and 16 outputs.
    let all = text(&bytes(&["--model", "h2u-2416"]));
    assert_eq!(all.lines().count(), 1 + 24 + 16);
}

/// What openpyxl reads, if it is there; and the bytes, which are the same each time.
#[test]
fn tables_are_workbooks_too() {
    let program = format!(";! X001 = 007\n;! Y001 = 灯 <1>\n{USES}");
    let folder = folder(&[("uses.il", program.as_bytes())]);
    for (to, sheet, first) in [
        (
            "io",
            "terminals",
            serde_json::json!(["X001", "007", "contact", "4"]),
        ),
        ("tags", "tags", serde_json::json!("X000")),
        ("csv", "cross reference", serde_json::json!("X000")),
    ] {
        let file = format!("{to}.xlsx");
        let write = |file: &str| {
            let args = ["xref", "uses.il", "--to", to, "-o", file];
            assert_eq!(code(folder.path(), &args), 0, "{to}");
            fs::read(folder.path().join(file)).unwrap()
        };
        let bytes = write(&file);
        assert_eq!(bytes, write("again.xlsx"), "{to}");
        fs::remove_file(folder.path().join("again.xlsx")).unwrap();
        let Some(mut client) = python("openpyxl", "workbook.py") else {
            continue;
        };
        client.arg(folder.path().join(&file));
        let read: serde_json::Value = serde_json::from_str(&succeeds(client)).unwrap();
        assert_eq!(
            (&read[0], &read[1]),
            (&sheet.into(), &"A2".into()),
            "{read}"
        );
        let rows = read[3].as_array().unwrap();
        let is_it =
            |row: &serde_json::Value| *row == first || row.as_array().unwrap().contains(&first);
        assert!(rows.iter().any(is_it), "{to}: {read}");
    }
    // A workbook is edited by people.
    let again = ["xref", "uses.il", "--to", "io", "-o", "io.xlsx"];
    assert_eq!(code(folder.path(), &again), 2);
}

/// A comment such as the designation of a contactor, or something worse, is a text in a spreadsheet.
#[test]
fn no_comment_is_a_formula_in_a_table() {
    let comments = [
        "=A1-K1",
        "+24 V",
        "-Q1",
        "@SUM(A1)",
        "＝1",
        "=cmd|'/c calc'!A0",
        "-5",
        "a=b",
    ];
    let lines = comments.iter().enumerate();
    let lines: String = lines
        .map(|(n, text)| format!(";! X{n:03o} = {text}\nLD X{n:03o}\nOUT M{n}\n"))
        .collect();
    let folder = folder(&[("uses.il", format!("{lines}END\n").as_bytes())]);
    for to in ["io", "tags", "csv"] {
        let out = rungc(folder.path(), &["xref", "uses.il", "--to", to]).stdout;
        let mut reader =
            csv::Reader::from_reader(out.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&out));
        let cells: Vec<String> = reader
            .records()
            .flat_map(|row| row.unwrap().iter().map(str::to_owned).collect::<Vec<_>>())
            .collect();
        let begins = |cell: &&String| cell.starts_with(['=', '+', '@', '＝']) || *cell == "-Q1";
        assert_eq!(cells.iter().find(begins), None, "{to}");
        assert!(
            cells.iter().any(|cell| cell == "'=A1-K1"),
            "{to}: {cells:?}"
        );
        if to == "io" {
            let plain = ["-5", "a=b"].map(|text| cells.iter().any(|cell| cell == text));
            assert_eq!(plain, [true; 2], "{cells:?}");
        }
    }
}

#[test]
fn what_a_cross_reference_cannot_do_is_reported() {
    let files: [(&str, &[u8]); 2] = [("a.il", USES.as_bytes()), ("b.il", MOTOR.as_bytes())];
    let folder = folder(&files);
    let messages = |args: &[&str]| {
        let out = rungc(folder.path(), args);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        text(&out.stderr)
    };
    assert!(
        messages(&["xref", "a.il", "--device", "D7000"])
            .contains("no instruction names these devices")
    );
    assert!(messages(&["xref", "a.il", "--device", "Q7"]).contains("devices are written"));
    assert!(messages(&["xref", "a.il", "b.il", "--to", "csv"]).contains("name one"));
    assert_eq!(
        code(
            folder.path(),
            &["xref", "a.il", "b.il", "--to", "csv", "-o", "tables"]
        ),
        0
    );
    assert!(folder.path().join("tables/b.csv").exists());
}

/// A name or comment of a hostile project acts in no page.
#[test]
fn comments_do_not_act_in_a_page() {
    let list = ";! X000 = <script>alert(1)</script>\nLD X0\nOUT Y0\nEND\n";
    let folder = folder(&[("a.il", list.as_bytes())]);
    let page = shown(folder.path(), &["xref", "a.il", "--to", "html"]);
    assert!(page.contains("&lt;script&gt;alert(1)"), "{page}");
}

#[test]
fn a_program_is_counted() {
    let folder = folder(&[("uses.il", USES.as_bytes())]);
    for model in ["fx3u", "l01s", "h2u"] {
        let args = ["stats", "uses.il", "--model", model];
        insta::assert_snapshot!(format!("stats_{model}"), shown(folder.path(), &args));
    }
    let json = shown(folder.path(), &["stats", "uses.il", "--json"]);
    insta::assert_snapshot!("stats_json", json);
}

#[test]
fn lists_are_laid_out_in_place_or_checked() {
    let ragged = "; motor\n\n\nld x0;start\n  OUT   Y0 // lamp\nend";
    let folder = folder(&[
        ("a.il", ragged.as_bytes()),
        ("b.il", b"LD X0\nOUT Y0\nEND\n"),
    ]);
    let path = folder.path();
    let on_disk = || std::fs::read_to_string(path.join("a.il")).unwrap();
    insta::assert_snapshot!("fmt_check", shown(path, &["fmt", "a.il", "--check"]));
    assert_eq!(code(path, &["fmt", ".", "--check"]), 1);
    assert_eq!(on_disk(), ragged);
    assert_eq!(code(path, &["fmt", "."]), 0);
    assert_eq!(
        on_disk(),
        "; motor\n\nLD X000                  ;start\nOUT Y000                 // lamp\nEND\n"
    );
    assert_eq!(code(path, &["fmt", ".", "--check"]), 0);
}

/// Unreadable files are left unchanged.
#[test]
fn a_broken_list_is_not_laid_out() {
    let folder = folder(&[
        ("a.il", b"ld x9\nout y0\nend"),
        ("b.il", "LD X0 ; Geschwindigkeit \u{fc}\n".as_bytes()),
    ]);
    let path = folder.path();
    assert_eq!(code(path, &["fmt", "a.il"]), 1);
    assert_eq!(
        std::fs::read(path.join("a.il")).unwrap(),
        b"ld x9\nout y0\nend"
    );
    let latin = b"ld x0 ; Geschwindigkeit \xfc\xfc\n";
    std::fs::write(path.join("b.il"), latin).unwrap();
    let out = rungc(path, &["fmt", "b.il"]);
    assert!(
        text(&out.stderr).contains("is not UTF-8"),
        "{}",
        text(&out.stderr)
    );
    assert_eq!(std::fs::read(path.join("b.il")).unwrap(), latin);
}
