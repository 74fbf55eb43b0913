//! Diagnostics of the readers for erroneous sources: one snapshot a family, as `code line:col message / label / help`.

use crate::fixture::{Stream, gxw, wcd, wpg};
use rungc_frontend::{Read, ReadOptions, read_bytes, read_bytes_with, read_text};

/// The findings in order of place, as text.
fn findings(read: &Read) -> String {
    let source = &read.program.source;
    let line = |d: rungc_syntax::Diagnostic| {
        let (line, column) = source.line_col(d.span.start);
        let at = source.slice(d.span);
        let help = d.help.as_deref().unwrap_or("");
        format!(
            "{} {line}:{column} `{at}`\n  {}\n  / {}\n  / {help}\n",
            d.code, d.message, d.label
        )
    };
    let all: String = read
        .diagnostics
        .clone()
        .sorted()
        .into_iter()
        .map(line)
        .collect();
    let instrs: Vec<_> = read
        .program
        .instrs
        .iter()
        .map(ToString::to_string)
        .collect();
    let unread = &read.program.unread;
    format!("{all}---\n{}\nunread: {unread:?}", instrs.join("\n"))
}

/// Bytes that do not fit the encoding of the rest, and texts that end in a character.
#[test]
fn damaged_texts_are_marked() {
    let mut found = Vec::new();
    let list = "LD X0 ; 启动按钮\nOUT Y0 ; 电机正转\nEND ; 结束";
    let mut lost = list.as_bytes().to_vec();
    lost.remove(list.find('转').unwrap() + 2);
    let wide = list.encode_utf16().flat_map(u16::to_le_bytes);
    let wide: Vec<u8> = [0xFF, 0xFE].into_iter().chain(wide).collect();
    for bytes in [
        &lost[..],
        &list.as_bytes()[..list.len() - 1],
        &wide[..wide.len() - 1],
    ] {
        found.push(findings(&read_bytes("a.il", bytes).unwrap()));
    }
    insta::assert_snapshot!(found.join("\n"));
}

#[test]
fn lines_that_are_no_instructions() {
    let text = "LD X0\n= Y0\n电机 LD X0\n0LD X0\n12 ; step alone\n99999999999 AND X1\nLD% X0\n(X0)\nOUT Y0\nEND\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

#[test]
fn comments_of_other_languages() {
    let text = "# by hash\nLD X0 # open\nOUT Y0 (* coil *)\n12 # step alone\nEND\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

/// Windows of AutoShop: names that are missing, headings that name nothing. A pointer is none, whatever follows it.
#[test]
fn windows_without_their_names() {
    let text = "LD X0\nCALL 加科\nCALL 泵\nCALL PO\nCALL P0Z0\nCALL P9 P8\nCALL \u{420}1\nCALL motor\nSBR 加料\nSBR\nSBR 加料\nSBR two words\nINT 急停\nINT D0\nINT_02\nMAIN\nLD X1\nEND\n";
    insta::assert_snapshot!(findings(&read_text("a.txt", text)));
}

/// Without any window, only what can be nothing else is the name of one.
#[test]
fn calls_of_names_without_windows() {
    let text = "LD X0\nCALL 加料\nCALL SBR_001\nCALL P0Z0\nCALL bSpeed\nCALL\nEND\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

#[test]
fn operands_that_are_none() {
    let text = "MOV 10 D0\nMOV Q5 D0\nMOV KX D0\nMOV H-5 D0\nMOV EX D0\nMOV U0G5 D0\nLD MO\nLD Xl\nLD X\nMOV K D0\nMOV D0Q D1\nMOV RE5 D0\nMOV ％ D0\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

#[test]
fn operands_with_impossible_numbers() {
    let text = "LD X008\nOUT Y19\nMOV K2147483648 D0\nMOV H123456789 D0\nDEMOV E1E99 D0\nDEMOV E1E-46 D0\nDEMOV E-1.1-38 D0\nMOV D4294967296 D0\nMOV K9M0 D0\nMOV K4D0 D1\nLD D0.G\nLD D0.10\nMOV D0Z99999999999 D1\nMOV U0\\G99999999999 D0\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

/// Texts between back quotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// A message that proposes an operand proposes one that is read.
#[test]
fn operands_that_messages_propose_are_accepted() {
    let codes = |operand: &str| {
        let read = read_text("a.il", &format!("MOV {operand} D0\nEND\n"));
        let found = read.diagnostics.clone().sorted();
        found
            .into_iter()
            .map(|d| d.code.to_string())
            .collect::<Vec<_>>()
    };
    let numbers = [
        "5",
        "10",
        "19",
        "0",
        "99999",
        "4294967295",
        "99999999999",
        "1.5",
        ".5",
        "1e3",
        "1.5e3",
        "FF",
        "12345678F",
    ];
    let around = [
        "", "+", "-", "0x", "16#", "$", "&H", "#", "4X", "9M", "4M", "K+", "H-", "E+", "XO", "DL",
        "ZRI", "RE", "XI", "DO",
    ];
    let (mut wrong, mut proposed) = (0, 0);
    for before in around {
        for number in numbers {
            for after in ["", "h", "O", "l"] {
                let operand = format!("{before}{number}{after}");
                let read = read_text("a.il", &format!("MOV {operand} D0\nEND\n"));
                for found in read.diagnostics.clone().sorted() {
                    if found.code != "E0002" {
                        continue;
                    }
                    wrong += 1;
                    for proposal in quoted(found.help.as_deref().unwrap_or_default()) {
                        proposed += 1;
                        assert!(codes(proposal).is_empty(), "{operand}: {proposal}");
                    }
                    for edit in found.fix.iter().flat_map(|fix| &fix.edits) {
                        assert!(codes(&edit.text).is_empty(), "{operand}: {}", edit.text);
                    }
                }
            }
        }
    }
    assert!(wrong > 200 && proposed > 200, "{wrong} {proposed}");
    for (operand, help) in [
        ("-5", "write `K-5` for a decimal constant"),
        ("+5", "write `K5` for a decimal constant"),
        ("4294967295", "write `H4294967295`"),
        (
            "5",
            "write `K5` for a decimal constant, `H5` for a hexadecimal one",
        ),
    ] {
        let read = read_text("a.il", &format!("MOV {operand} D0\nEND\n"));
        let found = read.diagnostics.clone().sorted();
        let given = found[0].help.as_deref().unwrap_or_default();
        let is_big = found[0].code != "E0002" && operand.len() > 8;
        assert!(is_big || given == help, "{operand}: {given}");
    }
}

#[test]
fn one_bad_line_hides_nothing() {
    let text = "LD X0 Q1 X9 \"open\nＯＵＴ　Ｙ００８　；灯\nMOV K99999999999 H123456789 K0M0\n\"text\" first\nEND\n";
    insta::assert_snapshot!(findings(&read_text("a.il", text)));
}

#[test]
fn rows_that_fit_no_list() {
    let text = "\"P\"\r\n\"PLC Information:\"\t\"FXCPU FX3U/FX3UC\"\r\n\
        \"Step No.\"\t\"Line Statement\"\t\"Instruction\"\t\"I/O(Device)\"\t\"Blank\"\t\"PI Statement\"\t\"Note\"\r\n\
        \"\"\t\"\"\t\"\"\t\"K5\"\r\n\
        \"zero\"\t\"\"\t\"LD\"\t\"X009\"\r\n\
        \"1\"\t\"heading\"\t\"OUT\"\t\"T0\"\t\"\"\t\"\"\t\"lamp\"\r\n\
        \"\"\t\"\"\t\"\"\t\"30\"\r\n\
        \"4\"\t\"\"\t\"=\"\t\"Y0\"\r\n\
        \"\"\t\"\"\t\"\"\t\"Y1\"\r\n\
        \"5\"\t\"\"\t\"END\"\r\n";
    let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
    insta::assert_snapshot!(format!(
        "{}\n---\n{}",
        findings(&read),
        read.program.source.text
    ));
}

#[test]
fn text_with_bytes_of_no_encoding() {
    let read = read_bytes(
        "a.il",
        b"LD X000 ; start\nOUT Y000 ; lamp \xFF\xFF here\nEND\n",
    )
    .unwrap();
    insta::assert_snapshot!(findings(&read));
}

/// LD X000, an unknown applied instruction on D0, MOV with an unknown operand, OUT Y010, END.
const STRANGE: &[&[u8]] = &[
    &[0x00],
    &[0x9C, 0x00],
    &[0x48, 0x05, 0x77],
    &[0xA8, 0x00],
    &[0x4C, 0x05, 0x00],
    &[0xB0, 0x01],
    &[0xA8, 0x01],
    &[0xF0, 0x63],
    &[0x20],
    &[0x9D, 0x08],
    &[0x34],
];

#[test]
fn codes_that_are_unknown() {
    let read = read_bytes("MAIN.wpg", &wpg(0x0208, STRANGE)).unwrap();
    insta::assert_snapshot!(format!(
        "{}\n---\n{}",
        findings(&read),
        read.program.source.text
    ));
}

/// WDT and ANR by codes that were derived, ANR twice; IVMC by one that is a guess; an unknown one with every kind of
/// operand.
const UNPROVEN: &[&[u8]] = &[
    &[0x61, 0x01, 0x00],
    &[0x00],
    &[0x9C, 0x00],
    &[0x53, 0x01, 0x21],
    &[0x53, 0x01, 0x21],
    &[0x5F, 0x0B, 0x25],
    &[0xE8, 0x00],
    &[0x63, 0x09, 0x77],
    &[0xF1, 4],
    &[0xF0, 1],
    &[0x90, 0x64],
    &[0xEE, b'A', b'B'],
    &[0xF8, 0x00],
    &[0xAB, 0x0A],
    &[0x34],
];

#[test]
fn codes_that_nothing_proves() {
    let read = read_bytes("MAIN.wpg", &wpg(0x0208, UNPROVEN)).unwrap();
    insta::assert_snapshot!(format!(
        "{}\n---\n{}",
        findings(&read),
        read.program.source.text
    ));
}

#[test]
fn codes_that_were_learned() {
    let mut options = ReadOptions::default();
    for (code, mnemonic) in [
        (&[0x63, 0x09, 0x77], "PULSE"),
        (&[0x53, 0x01, 0x21], "ANR"),
        (&[0x61, 0x01, 0x00], "WDT"),
        (&[0x5F, 0x0B, 0x25], "IVMC"),
    ] {
        options.learned.insert(code, mnemonic).unwrap();
    }
    let read = read_bytes_with("MAIN.wpg", &wpg(0x0208, UNPROVEN), &options).unwrap();
    insta::assert_snapshot!(findings(&read));
}

#[test]
fn operands_that_are_labels() {
    let bodies: &[&[u8]] = &[
        &[0x00],
        b"\xDFstart",
        &[0x4C, 0x05, 0x00],
        &[0xE8, 0x05],
        b"\xDFspeed",
        &[0x00],
        b"\xDFstart",
        &[0x20],
        &[0x9D, 0x00],
        &[0x34],
    ];
    let read = read_bytes("MAIN.wpg", &wpg(0x0208, bodies)).unwrap();
    insta::assert_snapshot!(findings(&read));
}

#[test]
fn projects_of_other_families() {
    let read = read_bytes("MAIN.wpg", &wpg(0x010A, STRANGE)).unwrap();
    insta::assert_snapshot!(findings(&read));
}

#[test]
fn a_project_that_ends_too_early() {
    let whole = wpg(
        0x0208,
        &[&[0x00], &[0x9C, 0x00], &[0x20], &[0x9D, 0x00], &[0x34]],
    );
    insta::assert_snapshot!(
        "cut_within_a_token",
        findings(&read_bytes("MAIN.wpg", &whole[..0x44 + 13]).unwrap())
    );
    insta::assert_snapshot!(
        "cut_before_the_program",
        findings(&read_bytes("MAIN.wpg", &whole[..0x30]).unwrap())
    );
}

#[test]
fn a_project_that_is_damaged() {
    let mut bytes = wpg(
        0x0208,
        &[
            &[0x00],
            &[0x9C, 0x00],
            &[0x20],
            &[0x9D, 0x00],
            &[0x01],
            &[0x9C, 0x01],
            &[0x20],
            &[0x9D, 0x01],
            &[0x34],
        ],
    );
    bytes[0x44 + 7] = 0x55;
    insta::assert_snapshot!(
        "damage_in_the_middle",
        findings(&read_bytes("MAIN.wpg", &bytes).unwrap())
    );
    let prefix = wpg(
        0x0208,
        &[
            &[0x00],
            &[0xF1, 4],
            &[0xE8, 0x05],
            &[0x3C],
            &[0x20],
            &[0x9D, 0x01],
            &[0x3C],
            &[0xE8, 1],
            &[0x34],
        ],
    );
    let operands = wpg(
        0x0208,
        &[
            &[0x9C, 0x00],
            &[0x3C],
            &[0xD0, 0x01],
            &[0x9C, 0x00],
            &[0x4C, 0x05, 0x00],
            &[0xF0, 1],
            &[0xF0, 2],
            &[0xA8, 0x00],
            &[0xAB, 0x00],
            &[0x4C, 0x05, 0x00],
            &[0xAB, 0x00],
            &[0xA8, 0x00],
            &[0x34],
        ],
    );
    insta::assert_snapshot!(
        "operands_out_of_place",
        findings(&read_bytes("MAIN.wpg", &operands).unwrap())
    );
    insta::assert_snapshot!(
        "tokens_that_do_not_go_together",
        findings(&read_bytes("MAIN.wpg", &prefix).unwrap())
    );
    let ole = gxw(&[Stream {
        name: "12",
        content: b"no program here",
    }]);
    insta::assert_snapshot!(
        "compound_file_without_a_program",
        findings(&read_bytes("a.gxw", &ole).unwrap())
    );
}

#[test]
fn comments_that_are_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let (body, others) = (
        folder.path().join("resource/POU/Body"),
        folder.path().join("resource/Others"),
    );
    std::fs::create_dir_all(&body).unwrap();
    std::fs::create_dir_all(&others).unwrap();
    std::fs::write(body.join("MAIN.wpg"), wpg(0x0208, &[&[0x34]])).unwrap();
    let whole = wcd(&[(0x9C, 0, "start"), (0xA8, 10, "speed")]);
    std::fs::write(others.join("COMMENT.wcd"), &whole[..whole.len() - 1]).unwrap();
    let read = rungc_frontend::read(folder.path()).unwrap();
    let comments: Vec<_> = read.program.comments.iter().collect();
    insta::assert_snapshot!(format!("{}\n---\n{comments:?}", findings(&read)));
    std::fs::write(others.join("COMMENT.wcd"), b"").unwrap();
    let empty = findings(&rungc_frontend::read(folder.path()).unwrap());
    let message =
        "the table of device comments cannot be read past offset 0x0040, where the data ends";
    assert!(empty.contains(message), "{empty}");
}
