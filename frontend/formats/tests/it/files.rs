//! Files as people have them: of other kinds, without their heads, for other families, cut off.

use crate::fixture::{self, Stream, gxw, wpg};
use encoding_rs::Encoding;
use rungc_frontend::{print, read, read_bytes, recognise};
use rungc_syntax::{Program, SourceKind};

fn texts(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

/// Texts of other kinds, some of which contain lines of a program.
const TEXTS: [(&str, &str); 19] = [
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
            .map(|d| (d.code, d.message.clone()))
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

/// Steps may end with a sign; dumps are not lists. Zeros behind a text fill its block, and steps may be full-width.
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

/// A table with this head above one instruction, as the editors write it.
fn export(cpu: &str) -> Vec<u8> {
    let rows = format!(
        "\"MAIN\"\r\n\"PLC Information:\"\t\"{cpu}\"\r\n\"Step No.\"\t\"Line Statement\"\t\"Instruction\"\t\"I/O(Device)\"\t\"Blank\"\t\"PI Statement\"\t\"Note\"\r\n\
         \"0\"\t\"\"\t\"LD\"\t\"X10\"\t\"\"\t\"\"\t\"\"\r\n\"1\"\t\"\"\t\"END\"\t\"\"\t\"\"\t\"\"\t\"\"\r\n"
    );
    let units = std::iter::once(0xFEFF).chain(rows.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

#[test]
fn an_export_for_another_family_is_refused() {
    for cpu in [
        "QCPU (Q mode) Q03UDV",
        "QCPU (A mode) Q02(H)-A",
        "QnACPU Q2A",
        "LCPU L26-BT",
        "LCPU L02S",
        "RCPU R04",
        "R08EN",
        "ACPU A2N",
        "A1FX",
        "FX5CPU FX5U",
        "FX5UCPU",
        "FX5UJ",
        "Q06UDV",
        "NCCPU",
        "MOTION CPU",
        "L26-BT",
        "A2USH-S1",
        "iQ-F",
        "MELSEC iQ-L L04H",
        "SIMATIC S7-200",
        "S7-200",
        "XG5000",
    ] {
        let read = read_bytes("MAIN.csv", &export(cpu)).unwrap();
        let codes: Vec<_> = read.diagnostics.iter().map(|d| d.code).collect();
        assert_eq!(codes, ["E0018"], "{cpu}");
        assert!(
            read.diagnostics.iter().all(|d| d.message.contains(cpu)),
            "{cpu}"
        );
    }
    for cpu in [
        "FXCPU FX3U/FX3UC",
        "FXCPU FX1S",
        "FX2N/FX2NC",
        "",
        "H2U",
        "L02S",
        "HM",
        "H1U",
        "A1SJH",
        "F1",
        "AM600",
        "Remote I/O",
        "FX1S-30MR",
        "fxcpu fx1s",
        "FXCPU FX0/FX0S",
    ] {
        let read = read_bytes("MAIN.csv", &export(cpu)).unwrap();
        assert!(!read.diagnostics.has_errors(), "{cpu}");
        assert_eq!(texts(&read.program), ["LD X010", "END"], "{cpu}");
        // What the row names is the CPU, so that the compiler finds its model or says that it has none.
        let named = cpu
            .trim_start_matches("FXCPU ")
            .trim_start_matches("fxcpu ");
        assert_eq!(read.program.cpu.as_deref().unwrap_or_default(), named);
    }
    for cpu in ["Q03UDV", "FX5U", "RCPU R04", "L26-BT", "S7-200"] {
        let list = format!(";! cpu = {cpu}\nLD X0\nOUT Y0\nEND\n");
        let project = format!(
            "<project xmlns=\"http://www.plcopen.org/xml/tc6_0201\"><fileHeader contentDescription=\"CPU type {cpu}\"/>\
             <types><pous><pou pouType=\"program\"/></pous></types></project>"
        );
        for text in [list, project] {
            let read = read_bytes("a", text.as_bytes()).unwrap();
            let codes: Vec<_> = read.diagnostics.iter().map(|d| d.code).collect();
            assert_eq!(codes, ["E0018"], "{text}");
        }
    }
}

/// The row of the CPU is known with and without a row of headings, in any columns, and with its label in one field.
#[test]
fn a_cpu_is_known_without_headings() {
    let lists = [
        "\"0\",\"\",\"LD\",\"X10\",\"\",\"\",\"\"\n\"1\",\"\",\"END\",\"\",\"\",\"\",\"\"\n",
        "\"LD\",\"X10\"\n\"END\",\"\"\n",
        "\"0\",\"LD\",\"X10\"\n\"1\",\"END\",\"\"\n",
    ];
    let rows = [
        "\"PLC Information:\",\"CPU\"",
        "\"PLC Information: CPU\"",
        "\"PLC Information: CPU\",\"\"",
    ];
    let heads = lists.iter().flat_map(|list| rows.map(|row| (row, list)));
    for (row, list) in heads {
        for title in ["\"MAIN\"\n", ""] {
            let text = |cpu: &str| format!("{title}{row}\n{list}").replace("CPU", cpu);
            for (cpu, name) in [("FXCPU FX1S", "FX1S"), ("FX3G", "FX3G")] {
                let read = read_bytes("MAIN.csv", text(cpu).as_bytes()).unwrap();
                assert_eq!(texts(&read.program), ["LD X010", "END"], "{}", text(cpu));
                assert_eq!(read.program.cpu.as_deref(), Some(name), "{}", text(cpu));
                assert_eq!(read.program.source.slice(read.program.cpu_span), name);
            }
            for cpu in ["QCPU (Q mode) Q03UDV", "Q03UDV", "L26-BT"] {
                let read = read_bytes("MAIN.csv", text(cpu).as_bytes()).unwrap();
                let found: Vec<_> = read.diagnostics.iter().collect();
                assert_eq!(found.len(), 1, "{}", text(cpu));
                assert_eq!(found[0].code, "E0018");
                // The text that the file has, in its row.
                let source = &read.program.source;
                assert_eq!(source.slice(found[0].span), cpu);
                let line = 1 + title.lines().count() as u32;
                assert_eq!(source.line_col(found[0].span.start).0, line);
            }
        }
    }
}

/// The instructions show the columns of an export that has lost its head.
#[test]
fn exports_without_headings_are_read() {
    let rows = [
        ["0", "LD", "X000"],
        ["1", "OUT", "T0"],
        ["", "", "K30"],
        ["4", "ADD", "D0"],
        ["", "", "K1"],
        ["", "", "D0"],
        ["11", "END", ""],
    ];
    let program = ["LD X000", "OUT T0 K30", "ADD D0 K1 D0", "END"];
    let table =
        |delimiter: &str, quote: &str, columns: &dyn Fn([&str; 3]) -> Vec<String>| -> String {
            let row = |row: [&str; 3]| {
                let fields = columns(row)
                    .iter()
                    .map(|field| format!("{quote}{field}{quote}"))
                    .collect::<Vec<_>>();
                fields.join(delimiter) + "\r\n"
            };
            rows.iter().map(|fields| row(*fields)).collect()
        };
    let own = |fields: &[&str]| {
        fields
            .iter()
            .map(|field| (*field).to_owned())
            .collect::<Vec<_>>()
    };
    for (delimiter, quote) in [("\t", "\""), (",", "\""), (";", "\""), (",", ""), (";", "")] {
        for (name, columns) in [
            (
                "three",
                &(|[step, word, operand]: [&str; 3]| own(&[step, word, operand]))
                    as &dyn Fn([&str; 3]) -> Vec<String>,
            ),
            ("four", &|[step, word, operand]| {
                own(&[step, "", word, operand])
            }),
            ("note", &|[step, word, operand]| {
                own(&[step, word, operand, "beside"])
            }),
            ("all", &|[step, word, operand]| {
                own(&[step, "", word, operand, "", "", ""])
            }),
        ] {
            let text = table(delimiter, quote, columns);
            let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
            assert_eq!(texts(&read.program), program, "{name}: {text}");
            assert!(!read.diagnostics.has_errors(), "{name}: {text}");
            assert_eq!(read.program.instrs[3].step, Some(11), "{name}: {text}");
        }
    }
}

/// A text that begins with a quote takes in no rows, whether another quote follows or none; line ends in texts are fine.
#[test]
fn unclosed_quotes_take_in_no_rows() {
    let headings = "Step No.,Line Statement,Instruction,I/O(Device),Blank,PI Statement,Note\n";
    let lists = [
        ",,LD,X0,,,\n,,OUT,Y0,,,\"5 inch\n,,LD,X1,,,\n,,OUT,Y1,,,6\" pipe\n,,END,,,,\n",
        "0,,LD,X0,,,\n1,,OUT,Y0,,,\"5 inch\n2,,LD,X1,,,\n3,,OUT,Y1,,,6\" pipe\n4,,END,,,,\n",
        "0,,LD,X0,,,\n1,,OUT,Y0,,,\"5 inch\n2,,LD,X1,,,\n3,,OUT,Y1,,,\n4,,END,,,,\n",
        "\"0\",\"\",\"LD\",\"X0\",\"\",\"\",\"\"\n\"1\",\"\",\"OUT\",\"Y0\",\"\",\"\",\"5 inch\n\"2\",\"\",\"LD\",\"X1\",\"\",\"\",\"\"\n\"3\",\"\",\"OUT\",\"Y1\",\"\",\"\",\"\"\n\"4\",\"\",\"END\",\"\",\"\",\"\",\"\"\n",
        "0,,LD,X0\n1,,OUT,Y0,,,\"5 inch\n2,,LD,X1\n3,,OUT,Y1\n4,,END\n",
        "0,,LD,X0,,,\n,\"5 inch,,,,,\n1,,OUT,Y0,,,\n2,,LD,X1,,,\n3,,OUT,Y1,,,\n4,,END,,,,\n",
        "0,,LD,X0,,,\n1,,OUT,\"Y0,,,\n2,,LD,X1,,,\n3,,OUT,Y1,,,\n4,,END,,,,\n",
    ];
    let program = ["LD X000", "OUT Y000", "LD X001", "OUT Y001", "END"];
    for (list, end) in lists.iter().flat_map(|list| [(list, "\n"), (list, "\r\n")]) {
        for (separator, head) in [(",", headings), ("\t", headings), (",", ""), (";", "")] {
            // Without headings and step numbers, nothing shows a table.
            if head.is_empty() && list.starts_with(',') {
                continue;
            }
            let text = format!("{head}{list}").replace(',', separator);
            let bytes = text.replace('\n', end);
            let read = read_bytes("MAIN.csv", bytes.as_bytes()).unwrap();
            if !text.contains("\"Y0") {
                assert_eq!(texts(&read.program), program, "{text}");
            }
            let found = read.diagnostics.iter().find(|d| d.code == "E0014");
            let source = &read.program.source;
            let row = found.map(|found| source.line_col(found.span.start).0);
            let quote = text.find("\"5").or(text.find("\"Y0")).unwrap();
            let expected = 1 + text[..quote].matches('\n').count() as u32;
            assert_eq!(row, Some(expected), "{text}");
        }
    }
    let notes = "0,\"two\nlines, of text\",LD,X0,,,\"note\n, in ,,\nlines\"\n1,,OUT,Y0,,,\"\n\"\n2,,END,,,,\n";
    let text = format!("{headings}{notes}");
    let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
    assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
    assert_eq!(read.diagnostics.iter().count(), 0, "{text}");
}

/// Headings are known by their shape, whatever their language: a row with words for steps, instructions and devices.
#[test]
fn headings_in_any_language_are_known() {
    let headings = [
        "步號|行間聲明|指令|I/O(元件)|空白欄|PI聲明|註解",
        "Schritt|Zeilenkommentar|Anweisung|E/A(Operand)|Leer|PI-Kommentar|Notiz",
        "스텝 번호|행간 스테이트먼트|명령|I/O(디바이스)|공란|PI 스테이트먼트|노트",
        "Paso|Comentario|Instrucción|E/S|Vacío|Puntero|Nota",
        "Шаг|Комментарий|Команда|Операнд||Указатель|Примечание",
    ];
    let rows = [
        "0|first part|||||",
        "0||LD|X000|||",
        "1||OUT|T0|||note",
        "|||K30|||",
        "4||END||||",
    ];
    for headings in headings {
        let head = ["MAIN", "SPS-Information:|FXCPU FX3G", headings];
        for (separator, quote) in [
            ("\t", "\""),
            (",", "\""),
            (";", "\""),
            ("\t", ""),
            (";", ""),
        ] {
            let row = |row: &&str| {
                let fields = row.split('|').map(|field| format!("{quote}{field}{quote}"));
                fields.collect::<Vec<_>>().join(separator) + "\r\n"
            };
            let text: String = head.iter().chain(&rows).map(row).collect();
            let units = std::iter::once(0xFEFF).chain(text.encode_utf16());
            let bytes: Vec<u8> = units.flat_map(u16::to_le_bytes).collect();
            let read = read_bytes("MAIN.csv", &bytes).unwrap();
            assert_eq!(read.diagnostics.iter().count(), 0, "{text}");
            let program = &read.program;
            assert_eq!(texts(program), ["LD X000", "OUT T0 K30", "END"], "{text}");
            let named = (program.title.as_deref(), program.cpu.as_deref());
            assert_eq!(named, (Some("MAIN"), Some("FX3G")), "{text}");
            assert_eq!(program.instrs[0].statement(), Some("first part"));
            assert_eq!(program.instrs[2].step, Some(4));
            if (separator, quote) == ("\t", "\"") {
                let head = read.export_head.as_ref().unwrap();
                assert_eq!(print::to_csv_with(program, head), bytes, "{text}");
            }
        }
    }
}

/// Cells that hold several operands, or a whole instruction, as people write who edit a table by hand.
#[test]
fn cells_may_hold_several_words() {
    let program = [
        "LD X000",
        "MOV K1 D0",
        "OUT T0 K30",
        "$MOV \"a b\" D0",
        "LDD>= D0 D2",
        "ASC \"AB\" D0",
        "P0",
        "END",
    ];
    for rows in [
        "0||LD X000|||||\n1||MOV K1 D0\n6||OUT T0 K30\n9||$MOV 'a b' D0\n14||LDD >= D0,D2\n23||ASC AB D0\n34||P0\n35||END\n",
        "0||LD|X000||||\n1||MOV|K1 D0\n6||OUT T0|K30\n9||$MOV|'a b' D0\n14||LD D>=|D0, D2\n23||ASC|AB\n|||D0\n34||P0\n35||END\n",
        "0||LD|X000||||\n1||MOV|K1\n|||D0\n6||OUT|T0 K30\n9||$MOV 'a b'|D0\n14||LDD>= D0\n|||D2\n23||ASC|AB\n|||D0\n34||P0\n35||END\n",
    ] {
        let cell = |cell: &str| format!("\"{}\"", cell.replace('\'', "\"\""));
        let row = |row: &str| row.split('|').map(cell).collect::<Vec<_>>().join("\t") + "\r\n";
        let text: String = rows.lines().map(row).collect();
        let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
        assert_eq!(read.diagnostics.iter().count(), 0, "{text}");
        assert_eq!(texts(&read.program), program, "{text}");
        for operand in read.program.instrs.iter().flat_map(|instr| &instr.operands) {
            let written = read.program.source.slice(operand.span).trim_matches('"');
            assert!(
                !written.is_empty() && operand.kind.to_string().contains(written),
                "{written}"
            );
        }
    }
    for cell in ["MOV K1 D8X", "motor on", "LD X000 ; start"] {
        let text = format!("0,,LD,X000,,,\n1,,{cell},,,,\n2,,END,,,,\n");
        let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
        assert_eq!(read.diagnostics.iter().count(), 1, "{cell}");
    }
}

/// A row that is only damaged is not taken for headings.
#[test]
fn a_damaged_first_row_is_reported() {
    for row in ["O,,LD,X000", "a,,LDX,X000", "a,,LD,b"] {
        let text = format!("{row},,,\n1,,OUT,Y000,,,\n2,,END,,,,\n");
        let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
        assert!(read.diagnostics.has_errors(), "{text}");
    }
}

/// An export without headings may begin with a statement, with or without its step number, below a title or not.
#[test]
fn statements_begin_exports_without_headings() {
    for (separator, quote) in [("\t", "\""), (",", "\""), (",", ""), (";", ""), ("\t", "")] {
        for first in ["|start motor", "0|start motor", "MAIN|\n|start motor"] {
            let rows = format!("{first}||\n0||LD|X000\n1||OUT|Y000\n2||END|\n");
            let row = |row: &str| {
                let fields = row.split('|').map(|field| format!("{quote}{field}{quote}"));
                fields.collect::<Vec<_>>().join(separator) + "\n"
            };
            let text: String = rows.lines().map(row).collect();
            let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
            assert_eq!(read.diagnostics.iter().count(), 0, "{text}");
            assert_eq!(texts(&read.program), ["LD X000", "OUT Y000", "END"]);
            let statement = read.program.instrs[0].statement();
            assert_eq!(statement, Some("start motor"), "{text}");
        }
    }
}

/// An export as the editors write it: UTF-16, tabs, quotes, English headings.
fn export_of(rows: &[[&str; 7]]) -> Vec<u8> {
    let head = [
        "Step No.",
        "Line Statement",
        "Instruction",
        "I/O(Device)",
        "Blank",
        "PI Statement",
        "Note",
    ];
    let row = |fields: &[&str; 7]| {
        let fields = fields.map(|field| format!("\"{}\"", field.replace('"', "\"\"")));
        fields.join("\t") + "\r\n"
    };
    let rows: String = std::iter::once(&head).chain(rows).map(row).collect();
    let text = format!("\"MAIN\"\r\n\"PLC Information:\"\t\"FXCPU FX3U/FX3UC\"\r\n{rows}");
    let units = std::iter::once(0xFEFF).chain(text.encode_utf16());
    units.flat_map(u16::to_le_bytes).collect()
}

/// Checks that an export comes out byte for byte.
fn check_comes_out(rows: &[[&str; 7]]) {
    let bytes = export_of(rows);
    let read = read_bytes("MAIN.csv", &bytes).unwrap();
    assert!(!read.diagnostics.has_errors(), "{:?}", read.diagnostics);
    let written = print::to_csv_with(&read.program, read.export_head.as_ref().unwrap());
    let shown = |bytes: &[u8]| {
        Encoding::for_label(b"utf-16le")
            .unwrap()
            .decode(bytes)
            .0
            .into_owned()
    };
    assert_eq!(shown(&written), shown(&bytes));
}

#[test]
fn rows_of_statements_are_kept() {
    check_comes_out(&[
        ["0", "first part", "", "", "", "", ""],
        ["", "second line", "", "", "", "", ""],
        ["0", "", "LD", "X000", "", "", ""],
        ["1", "", "OUT", "Y000", "", "", "a note"],
        ["2", "above a label", "", "", "", "", ""],
        ["2", "", "", "", "", "of the pointer", ""],
        ["2", "", "P0", "", "", "", ""],
        ["3", "", "END", "", "", "", ""],
        ["4", "below all", "", "", "", "", ""],
    ]);
}

#[test]
fn notes_stay_in_their_rows() {
    check_comes_out(&[
        ["0", "", "LD", "X000", "", "", "start"],
        ["1", "", "MOV", "K1", "", "", "from"],
        ["", "", "", "D0", "", "", "to"],
        ["6", "", "OUT", "T0", "", "", ""],
        ["", "", "", "K30", "", "", "3 s"],
        ["", "", "", "", "", "", "more"],
        ["9", "", "END", "", "", "", ""],
    ]);
}

/// ASC takes its characters without quotes; those that were written with them keep them.
#[test]
fn characters_of_asc_keep_their_form() {
    check_comes_out(&[
        ["0", "", "LD", "X000", "", "", ""],
        ["1", "", "ASC", "ABCDEFGH", "", "", ""],
        ["", "", "", "D0", "", "", ""],
        ["12", "", "ASC", "A B  C", "", "", ""],
        ["", "", "", "D10", "", "", ""],
        ["23", "", "ASC", "\"quoted\"", "", "", ""],
        ["", "", "", "D20", "", "", ""],
        ["34", "", "ASC", "\" a\"", "", "", ""],
        ["", "", "", "D30", "", "", ""],
        ["45", "", "$MOV", "\"text\"", "", "", ""],
        ["", "", "", "D40", "", "", ""],
        ["52", "", "DEMOV", "E3.4+38", "", "", ""],
        ["", "", "", "D50", "", "", ""],
        ["61", "", "END", "", "", "", ""],
    ]);
    for text in [
        "ABC",
        "a b",
        " lead",
        "\"\"x",
        "ＦＵＬＬ",
        "",
        "K1 D0",
        "a;b",
        "a,b",
        "\t",
    ] {
        let list = format!("LD X000\nASC \"{text}\" D0\nEND\n");
        let program = rungc_frontend::read_text("a.il", &list).program;
        let back = read_bytes("MAIN.csv", &print::to_csv(&program)).unwrap();
        let operands = |program: &Program| -> Vec<_> {
            let operands = program.instrs[1].operands.iter();
            operands.map(|operand| operand.kind.clone()).collect()
        };
        assert_eq!(operands(&back.program), operands(&program), "{text}");
    }
}

/// Comments below the last instruction stay in all forms that hold statements.
#[test]
fn comments_below_the_program_are_kept() {
    let text = "LD X000\nOUT Y000\nEND\n; the end\n\n; of all\n";
    let program = rungc_frontend::read_text("a.il", text).program;
    let written = [
        print::to_il(&program).into_bytes(),
        print::to_csv(&program),
        print::to_autoshop(&program).unwrap().into_bytes(),
    ];
    for bytes in written {
        let back = read_bytes("a", &bytes).unwrap();
        assert_eq!(back.diagnostics.iter().count(), 0);
        assert_eq!(back.program.closing.as_deref(), Some("the end\nof all"));
        assert_eq!(texts(&back.program), texts(&program));
    }
    let drawn = read_bytes("a", b"|--[ X000 ]--( Y000 )--|\n; below\n").unwrap();
    assert_eq!(drawn.program.closing.as_deref(), Some("below"));
}

/// Between routines, NOP has no window; what is written above it stays.
#[test]
fn autoshop_has_no_place_for_nop_between_routines() {
    let list = "LD X0\nCALL P0\nNOP\nFEND\nNOP\nP0\nLD X1\nSRET\nOUT Y1\nSRET\n; feeder\nNOP\nNOP\nI001\nOUT Y0\nIRET\nNOP\nEND\n";
    let program = rungc_frontend::read_text("a.il", list).program;
    let written = print::to_autoshop(&program).unwrap();
    assert!(written.contains("; feeder"), "{written}");
    let back = rungc_frontend::read_text("a.txt", &written);
    assert!(!back.diagnostics.has_errors(), "{written}");
    let words = |program: &Program| texts(program).join(" ").replace(" NOP", "");
    assert_eq!(words(&back.program), words(&program));
    let alone = rungc_frontend::read_text("a.il", "LD X0\nOUT Y0\nFEND\nNOP\nEND\n").program;
    assert!(print::to_autoshop(&alone).is_ok());
    for (list, outside) in [
        (list, 4),
        ("LD X0\nNOP\nOUT Y0\nEND\nNOP\n", 1),
        ("NOP\nLD X0\nOUT Y0\nFEND\nP0\nNOP\nSRET\nEND\n", 0),
    ] {
        let program = rungc_frontend::read_text("a.il", list).program;
        assert_eq!(print::nops_outside_windows(&program), outside, "{list}");
        let back = rungc_frontend::read_text("a.txt", &print::to_autoshop(&program).unwrap());
        let nops = |program: &Program| texts(program).iter().filter(|text| *text == "NOP").count();
        assert_eq!(nops(&program) - nops(&back.program), outside, "{list}");
    }
}

/// Comments stay that stand on instructions which windows imply or have no place for.
#[test]
fn autoshop_keeps_the_comments_of_what_it_leaves_out() {
    let list = "LD X0\nOUT Y0\n; a\nFEND ; b\n; c\nNOP ; d\nP0\nLD X1\nOUT Y1\n; e\nSRET ; f\n; g\nNOP ; h\n; i\nEND ; j\n; k\nNOP ; l\n; m\n";
    let program = rungc_frontend::read_text("a.il", list).program;
    let written = print::to_autoshop(&program).unwrap();
    let comments = written.lines().filter_map(|line| line.split_once("; "));
    let comments: String = comments.map(|(_, comment)| comment).collect();
    assert_eq!(comments, "abcdefghijklm", "{written}");
}
