//! Files as people have them: of other kinds, without their heads, for other families, cut off.

use crate::exports::export;
use crate::fixture::{self, Stream, gxw, wpg};
use rungc_frontend::{read, read_bytes, recognise};
use rungc_syntax::{Program, SourceKind};

/// The instructions as texts.
pub fn texts(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

/// Texts of other kinds, some of which contain lines of a program.
const TEXTS: [(&str, &str); 22] = [
    (
        "references.csv",
        "\"Device\",\"Instruction\",\"Step\"\r\n\"X000\",\"LD\",\"0\"\r\n\"\",\"AND\",\"7\"\r\n",
    ),
    (
        "references.txt",
        "デバイス\t命令\tステップ\r\nX000\tLD\t0\r\n\tAND\t7\r\nY000\tOUT\t1\r\n",
    ),
    ("headless.csv", "X000,LD,0\r\nX000,AND,7\r\nY000,OUT,1\r\n"),
    (
        "lfs.gxw",
        "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n",
    ),
    (
        "a.hex",
        ":020000040800F2\n:10000000000002201D0100082501000829010008AA\n:00000001FF\n",
    ),
    (
        "a.s19",
        "S00F000068656C6C6F202020202000003C\nS11F00007C0802A6900100049421FFF07C6C1B787C8C23783C6000003863000026\n",
    ),
    (
        "conflict.il",
        "LD X0\n<<<<<<< HEAD\nOUT Y0\n=======\nOUT Y1\n>>>>>>> other\nEND\n",
    ),
    (
        "a.patch",
        "--- a/x.il\n+++ b/x.il\n@@ -1,2 +1,2 @@\n-LD X0\n+LD X1\n OUT Y0\n",
    ),
    (
        "git.patch",
        "From 12 Mon Sep 17\nSubject: x\n\ndiff --git a/x.il b/x.il\n",
    ),
    ("README.md", "# Press\n\nThe program of the press.\n"),
    ("list.md", "Program:\n\n```\nLD X0\nOUT Y0\nEND\n```\n"),
    ("a.ini", "; settings\n[main]\nspeed=3\n"),
    ("a.yml", "---\nname: ci\non: push\n"),
    ("b.yml", "name: ci\njobs:\n  - build\n  - test\n"),
    (
        "a.eml",
        "From: a@example.org\nTo: b@example.org\nSubject: program\n\nHello\n",
    ),
    (
        "Cargo.toml",
        "[package]\nname = \"own\"\nversion = \"0.1.0\"\n",
    ),
    ("Makefile", "# make\nCFLAGS ?= -std=c99\nall: libn.a\n"),
    (
        "CMakeLists.txt",
        "# Libraries\ncmake_minimum_required(VERSION 3.16)\n",
    ),
    ("unit.rs", "//! A unit.\n\nuse super::Kind;\n"),
    (
        "junit.xml",
        "<?xml version=\"1.0\"?>\n<testsuites name=\"rungc\"></testsuites>\n",
    ),
    ("run.txt", "      time Y000\n   0.000 s    ·\n"),
    (
        "xref.csv",
        "first,last,comment,network,step,use,instruction,reach\nX000,X000,,1,0,contact,LD X000,\n",
    ),
];

#[test]
fn cut_off_programs_say_where() {
    let whole = wpg(0x0208, &[b"\x34"]);
    for length in [1, 10, 64] {
        let read = read_bytes("MAIN.wpg", &whole[..length]).unwrap();
        let found: Vec<_> = read
            .diagnostics
            .iter()
            .map(|d| d.message.as_str())
            .collect();
        let bytes = if length == 1 {
            "1 byte"
        } else {
            &format!("{length} bytes")
        };
        assert_eq!(
            found,
            [format!(
                "the project is cut off after {bytes}, before its program"
            )]
        );
    }
}

/// Tables of comments by any separator, with any columns; what is not a device is named.
#[test]
fn device_comments_are_found_by_their_columns() {
    let folder = tempfile::tempdir().unwrap();
    let tables = [
        "Device;Comment\r\nX000;start\r\nX8;bad\r\nY001;motor, left\r\n",
        "Device\tLabel\tComment\r\nX000\ta\tstart\r\nX8\tb\tbad\r\nY001\tc\tmotor, left\r\n",
        "\"Comment\",\"Device Name\"\r\n\"start\",\"X000\"\r\n\"bad\",\"X8\"\r\n\"motor, left\",\"Y001\"\r\n",
        "X000,start\r\nX8,bad\r\nY001,\"motor, left\"\r\nM0,\"a\tb\"\r\n",
        "X000,,start\r\nX8,,bad\r\nY001,,\"motor, left\"\r\n",
        "X000\t\t\tstart\r\nX8\t\t\tbad\r\nY001\t\t\tmotor, left\r\n",
        "\"Device\", \"Comment\"\r\n\"X000\", \"start\"\r\n\"X8\", \"bad\"\r\n\"Y001\", \"motor, left\"\r\n",
        "sep=|\r\nX000|start\r\nX8|bad\r\nY001|motor, left\r\n",
    ];
    std::fs::write(folder.path().join("MAIN.csv"), export("FXCPU FX3S")).unwrap();
    for table in tables {
        std::fs::write(folder.path().join("COMMENT.csv"), table).unwrap();
        let read = read(&folder.path().join("MAIN.csv")).unwrap();
        let mut comments = read.program.comments.iter();
        let comment = comments
            .next()
            .map(|(device, text)| format!("{device} {text}"));
        assert_eq!(comment.as_deref(), Some("X000 start"), "{table}");
        let comment = comments
            .next()
            .map(|(device, text)| format!("{device} {text}"));
        assert_eq!(comment.as_deref(), Some("Y001 motor, left"), "{table}");
        let found: Vec<_> = read
            .diagnostics
            .iter()
            .map(|d| (d.code, d.message.to_string()))
            .collect();
        let row = if table.starts_with('X') { "2" } else { "3" };
        assert_eq!(
            found,
            [(
                "W0525",
                "row 3 of `COMMENT.csv`: `X8` is not a device, so its comment is left out"
            )]
            .map(|(code, message)| (code, message.replace('3', row)))
        );
    }
    let list = read_bytes("a.il", b";! X8 = bad\nLD X0\nOUT Y0\nEND\n").unwrap();
    let codes: Vec<_> = list.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!((codes, list.program.comments.len()), (vec!["E0003"], 0));
}

/// Rows of a table of comments that cannot be used as they are, with the row of each.
#[test]
fn doubtful_rows_of_comments_are_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("MAIN.csv"), export("FXCPU FX3S")).unwrap();
    let of_table = |table: &[u8]| {
        std::fs::write(folder.path().join("COMMENT.csv"), table).unwrap();
        let read = read(&folder.path().join("MAIN.csv")).unwrap();
        let comments = read.program.comments.iter();
        let comments: Vec<_> = comments.map(|(d, text)| format!("{d} {text}")).collect();
        let messages = read.diagnostics.iter().map(|d| {
            assert_eq!(d.code, "W0525");
            format!("\n{}\n  / {}", d.message, d.help.as_deref().unwrap())
        });
        format!("{}{}", comments.join(", "), messages.collect::<String>())
    };
    let tables = [
        "X0,\"5 inch\nX1,6\" pipe\nY0,motor\n",
        "Device,Comment\nX0,\"5 inch\nX1,pipe\nY0,motor\n",
        "Device,Comment\nX0,start\nX1,stop\nX0,start\nX1,halt\n",
        "Device,Comment\nB0,a\nD0.1,b\nX0-X7,c\nX18,d\nM0,e\n",
        "<html><body>X0 start</body></html>\n",
        "The comments are in the other file.\n",
        "\0\u{1}\u{2}\u{3}\u{4}\u{5}\u{6}",
        "Device,Comment\nX0,\n",
        "",
    ];
    let mut found: Vec<_> = tables
        .iter()
        .map(|table| of_table(table.as_bytes()))
        .collect();
    let damaged = "Device,Comment\nX0,启动按钮\nX1,停止\n".replace('动', "\0");
    let bytes: Vec<u8> = damaged
        .bytes()
        .map(|b| if b == 0 { 0xE5 } else { b })
        .collect();
    found.push(of_table(&bytes));
    insta::assert_snapshot!(found.join("\n---\n"));
}

/// Answers of assistants and pages of forges have lists as tables.
#[test]
fn tables_in_markdown_are_named() {
    for table in [
        "| LD | X000 |\n| OUT | Y000 |\n| END | |\n",
        "| Step | Instruction | Device |\n|---|---|---|\n| 0 | LDI | X000 |\n| 1 | OUT | Y000 |\n| 2 | END | |\n",
        "|0|ld|X0|\n|1|out|Y0|\n",
    ] {
        let found = recognise("a.txt", table.as_bytes()).map(|found| found.what);
        assert_eq!(found, Some("a table (Markdown)"), "{table}");
    }
    let drawn = "|  X000     +-----+ |\n|--] [------| MOV |-|\n|  X001              |\n";
    assert_eq!(recognise("a.txt", drawn.as_bytes()), None);
}

/// Steps may end with a sign; dumps are not lists. Zeros after a text fill its block, and steps may be full-width.
#[test]
fn lists_are_told_from_dumps() {
    let program = ["LD X000", "OUT Y000", "END"];
    for sign in ["", ":", ".", ")"] {
        let list = format!("0000{sign} LD X000\n0001{sign} OUT Y000\n0002{sign} END\n");
        assert_eq!(recognise("a.txt", list.as_bytes()), None, "{list}");
        let read = read_bytes("a.txt", list.as_bytes()).unwrap();
        assert_eq!(texts(&read.program), program, "{list}");
        assert!(read.diagnostics.is_empty(), "{list}");
    }
    for dump in [
        "00000000: 0200 0800 1c20 0000 0000 0000 0000 0000  .... ..........\n00000010: 4c44 0a  LD.\n",
        "00000000  02 00 08 00 1c 20 00 00  00 00 00 00 00 00 00 00  |..... ..........|\n00000010\n",
        "0000000 02 00 08 00\n0000004\n",
        "AgAIABwgAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA\nAgAIABwgAA==\n",
        "02000800022000000000000000000000000000000000000000000000\n0200\n",
        "\u{FEFF}",
    ] {
        let bytes = match dump {
            "\u{FEFF}" => &b"\xFF\xFE\0\0L\0\0\0D\0\0\0"[..],
            dump => dump.as_bytes(),
        };
        assert!(recognise("a.txt", bytes).is_some(), "{dump}");
    }
    let list = "LD X000\nOUT Y000\nEND\n";
    for padding in [2, 3, 500] {
        let zeros = vec![0; padding];
        let wide = [0xFEFF].into_iter().chain(list.encode_utf16());
        let wide: Vec<u8> = wide.flat_map(u16::to_le_bytes).collect();
        for bytes in [list.as_bytes(), &wide, &wide[2..]] {
            let read = read_bytes("a.txt", &[bytes, &zeros].concat()).unwrap();
            assert_eq!(texts(&read.program), program, "{padding}");
            assert!(read.diagnostics.is_empty(), "{padding}");
        }
    }
    let table = export("FX3U");
    let (table, _, _) = encoding_rs::UTF_16LE.decode(&table);
    let read = read_bytes("a.csv", table.replace("\"0\"", "\"０\"").as_bytes()).unwrap();
    assert!(read.diagnostics.is_empty(), "{:?}", read.diagnostics);
    assert_eq!(read.program.instrs[0].step, Some(0));
}

/// Lists stay lists, whatever their comments and ends look like.
#[test]
fn lists_with_other_signs_are_read() {
    for text in [
        "LD X0\nOUT Y0\nEND\n\u{1a}",
        "; [main]\n; speed=3\nLD X0\nOUT Y0\nEND\n",
        "; From: a\n; Subject: b\nLD X0\nOUT Y0\nEND\n",
        "0\tLD\tX0\n1\tOUT\tY0\n2\tEND\n",
        "S2 K1\nLD X0\nOUT Y0\nEND\n",
        "P0:\nLD X0\nOUT Y0\nEND\n",
        "0\tP0:\n1\t\tLD\tX0\n2\t\tOUT\tY0\n3\t\tEND\n",
        "0\tsret\n1\t\tld\tx0\n2\t\tout\ty0\n3\t\tend\n",
    ] {
        let read = read_bytes("a.il", text.as_bytes()).unwrap();
        let texts = texts(&read.program);
        assert!(
            texts.ends_with(&["LD X000".into(), "OUT Y000".into(), "END".into()]),
            "{texts:?}"
        );
        assert_eq!(read.program.kind, SourceKind::Il, "{text}");
    }
}

/// Bytes below the end of a text in the way of DOS are left out; instructions among them are errors.
#[test]
fn texts_end_at_ctrl_z() {
    let list = "LD X0\r\nOUT Y0\r\nEND\r\n\x1A";
    let table = "0,,LD,X0,,,\r\n1,,OUT,Y0,,,\r\n2,,END,,,,\r\n\x1A";
    let rests: [&[u8]; 4] = [
        b"\0\x03\x90motor\r\n\xFE\0",
        b"s left over\r\n",
        b"\x1A\x1A",
        b"\xB5\xE7",
    ];
    for text in [list, table] {
        for rest in rests {
            let read = read_bytes("a.txt", &[text.as_bytes(), rest].concat()).unwrap();
            assert!(read.diagnostics.is_empty(), "{:?}", read.diagnostics);
            assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
        }
    }
    for (rest, message) in [
        (
            &b"LD X1\r\nEND\r\n"[..],
            "the text continues after Ctrl-Z (1Ah), the end of a text in DOS",
        ),
        (
            b"\r\nOUT Y1\r\n\0\0\x02\x01\0\x08",
            "this text continues after Ctrl-Z (1Ah)",
        ),
    ] {
        let read = read_bytes("a.txt", &[list.as_bytes(), rest].concat()).unwrap();
        let found: Vec<_> = read.diagnostics.iter().collect();
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].message, message);
        assert!(found[0].span.start as usize >= list.trim_end().len() - 3);
    }
}

/// Each kind of file is named for what it is, with what to do.
#[test]
fn files_that_are_no_programs_are_named() {
    let ole = |text: &str| {
        let stream = Stream {
            name: text,
            content: b"",
        };
        fixture::compound(&[stream])
    };
    let files: Vec<(&str, Vec<u8>)> = vec![
        ("zeros.gxw", vec![0; 4096]),
        ("tape", [&[b'x'; 257][..], b"ustar\x0000"].concat()),
        ("a.gx3", b"\x01\0\x02binary".to_vec()),
        ("zip.gx3", b"PK\x03\x04....data.xml".to_vec()),
        ("a.hcp", b"\x05\0\0\x07".to_vec()),
        ("a.zip", b"PK\x03\x04....MAIN.wpg".to_vec()),
        ("a.docx", b"PK\x03\x04....word/document.xml".to_vec()),
        ("a.xlsx", b"PK\x03\x04....xl/workbook.xml".to_vec()),
        ("a.doc", ole("WordDocument")),
        ("a.png", b"\x89PNG\r\n\x1a\n\0\0\0".to_vec()),
        ("a.jpg", b"\xFF\xD8\xFF\xE0\0".to_vec()),
        ("a.pdf", b"%PDF-1.7\n".to_vec()),
        ("a.COW", b"\0\x01START".to_vec()),
        ("a.DMW", b"\0\x01\x02\0".to_vec()),
        (
            "Gppw.gpj",
            b"[Pass]\r\nName=\r\n[Version]\r\nVer=8\r\n".to_vec(),
        ),
        (
            "COMMENT.csv",
            b"\"Device Name\",\"Comment\"\r\n\"X000\",\"start\"\r\n\"Y000\",\"motor\"\r\n".to_vec(),
        ),
        (
            "t.plctest.toml",
            b"topic = \"a\"\nmodel = \"fx3u\"\nsource = \"\"\"\nLD X0\nEND\n\"\"\"\n".to_vec(),
        ),
        (
            "rungc.toml",
            b"# settings\n[project]\nprogram = \"a.il\"\n".to_vec(),
        ),
        ("m.toml", b"[[axis]]\nname = \"x\"\n".to_vec()),
        ("f.toml", b"[fleet]\n".to_vec()),
        (
            "a.c",
            b"/* motor */\n#include <stdio.h>\nint main(void) { return 0; }\n".to_vec(),
        ),
        ("a.rs", b"fn main() {}\n".to_vec()),
        ("a.py", b"import sys\n".to_vec()),
        ("a.json", b"{\n \"a\": 1\n}\n".to_vec()),
        ("a.html", b"<!DOCTYPE html>\n<html></html>\n".to_vec()),
        ("a.svg", b"<svg xmlns=\"\"></svg>\n".to_vec()),
        ("a.vcd", b"$date today $end\n".to_vec()),
        ("a.elf", b"\x7FELF\x01\x01\0\0".to_vec()),
        ("any.zip", b"PK\x03\x04....content.xml".to_vec()),
        ("erased.bin", vec![0xFF; 8000]),
        ("a.gxw", Vec::new()),
        ("COMMENT.wcd", wpg(0x0208, &[b"\x34"])),
        ("param.wpa", wpg(0x0208, &[b"\x34"])),
    ];
    let texts = TEXTS.map(|(name, text)| (name, text.as_bytes().to_vec()));
    let files = files.into_iter().chain(texts);
    let said = files.map(|(name, bytes)| match read_bytes(name, &bytes) {
        Err(error) => error.to_string(),
        Ok(read) => panic!("{name}: {:?}", read.diagnostics.iter().next()),
    });
    insta::assert_snapshot!(said.collect::<Vec<_>>().join("\n"));
}

#[test]
fn programs_are_not_taken_for_something_else() {
    for text in [
        "LD X0\nOUT Y0\nEND\n",
        "; import this\n; def it\nLD X0\nEND\n",
        "; #include nothing\n0 LD X000\n1 END\n",
        "LD= D0 K1\nOUT Y0\nEND\n",
        "MAIN\nLD X0\nEND\n",
    ] {
        assert_eq!(
            rungc_frontend::recognise("a.txt", text.as_bytes()),
            None,
            "{text}"
        );
        assert!(rungc_frontend::is_program(text.as_bytes()), "{text}");
    }
    assert!(!rungc_frontend::is_program(
        b"topic = \"a\"\nsource = \"\"\"\nLD X0\n\"\"\"\n"
    ));
}

#[test]
fn a_project_is_opened_by_the_file_that_people_click() {
    let folder = tempfile::tempdir().unwrap();
    let body = folder.path().join("Resource/POU/Body");
    std::fs::create_dir_all(&body).unwrap();
    let program = wpg(0x0208, &[b"\x34", b"\x34"]);
    std::fs::write(body.join("MAIN.wpg"), program).unwrap();
    std::fs::write(folder.path().join("Gppw.gpj"), "[Pass]\r\nName=\r\n").unwrap();
    let whole = read(folder.path()).unwrap();
    let clicked = read(&folder.path().join("Gppw.gpj")).unwrap();
    assert_eq!(texts(&clicked.program), texts(&whole.program));
    assert_eq!(clicked.program.source.name, whole.program.source.name);
    assert!(!texts(&clicked.program).is_empty());
}

/// A project that was cut off while it was copied.
#[test]
fn a_cut_off_project_says_so() {
    let whole = gxw(&[]);
    let read = read_bytes("a.gxw", &whole[..600]).unwrap();
    let first = read.diagnostics.iter().next().unwrap();
    insta::assert_snapshot!(first.message);
}

/// A folder that cannot be searched is named as a file that cannot be read is.
#[test]
fn a_folder_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing");
    let error = rungc_frontend::programs(&missing, 1).unwrap_err();
    let start = format!("cannot read `{}`: ", missing.display());
    assert!(error.to_string().starts_with(&start), "{error}");
}
