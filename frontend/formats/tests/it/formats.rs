//! Exports and projects of every kind, made by the tests, read as what they mean.

use crate::fixture::{Stream, gxw, tokens, wcd, wpa, wpg};
use encoding_rs::{Encoding, GBK, SHIFT_JIS, UTF_8};
use rungc_frontend::{ReadError, print, read, read_bytes, read_text};
use rungc_syntax::{Program, SourceKind};

fn texts(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

fn read_clean(name: &str, bytes: &[u8]) -> Program {
    let read = read_bytes(name, bytes).unwrap();
    let findings: Vec<_> = read.diagnostics.iter().collect();
    assert!(findings.is_empty(), "{findings:?}");
    read.program
}

const ENGLISH: &str = "Step No.|Line Statement|Instruction|I/O(Device)|Blank|PI Statement|Note";
const JAPANESE: &str =
    "ステップ番号|行間ステートメント|命令|I/O(デバイス)|空欄|PIステートメント|ノート";
const CHINESE: &str = "步号|行间声明|指令|I/O(软元件)|空白栏|PI声明|注解";

/// An export with these headers and words in its comments, its fields quoted and separated by `delimiter`.
fn export(headers: &str, words: [&str; 3], delimiter: &str) -> String {
    let [statement, pointer, note] = words;
    let rows = [
        "press".to_owned(),
        "PLC:|FXCPU FX3U/FX3UC".to_owned(),
        headers.to_owned(),
        format!("|{statement}|||||"),
        format!("0||LD|X000|||{note}"),
        "1||OUT|T0|||".to_owned(),
        "|||K30|||".to_owned(),
        format!("|||||{pointer}|"),
        "4||P0||||".to_owned(),
        "5||END||||".to_owned(),
    ];
    let row = |row: String| {
        let fields: Vec<_> = row.split('|').map(|field| format!("\"{field}\"")).collect();
        fields.join(delimiter) + "\r\n"
    };
    rows.into_iter().map(row).collect()
}

fn wide(text: &str) -> Vec<u8> {
    text.encode_utf16().flat_map(u16::to_le_bytes).collect()
}

fn encodings(text: &str, code_page: &'static Encoding) -> Vec<Vec<u8>> {
    let marked = format!("\u{FEFF}{text}");
    vec![
        text.into(),
        marked.clone().into(),
        wide(text),
        wide(&marked),
        code_page.encode(text).0.into_owned(),
    ]
}

#[test]
fn exports_are_read_in_every_language_and_encoding() {
    let cases = [
        (ENGLISH, ["motor", "ramp", "start"], UTF_8),
        (JAPANESE, ["モータ制御", "ランプ", "起動ボタン"], SHIFT_JIS),
        (CHINESE, ["电机控制", "子程序", "启动按钮"], GBK),
    ];
    for (headers, words, code_page) in cases {
        for delimiter in ["\t", ",", ";"] {
            for bytes in encodings(&export(headers, words, delimiter), code_page) {
                let program = read_clean("MAIN.csv", &bytes);
                assert_eq!(program.kind, SourceKind::Csv);
                assert_eq!(texts(&program), ["LD X000", "OUT T0 K30", "P0", "END"]);
                assert_eq!(program.title.as_deref(), Some("press"));
                assert_eq!(program.cpu.as_deref(), Some("FX3U/FX3UC"));
                let [load, out, label, end] = &program.instrs[..] else {
                    unreachable!()
                };
                assert_eq!(
                    [load.step, out.step, label.step, end.step],
                    [Some(0), Some(1), Some(4), Some(5)]
                );
                assert_eq!(load.statement(), Some(words[0]));
                assert_eq!(load.note(), Some(words[2]));
                assert_eq!(label.statement(), Some(words[1]));
                assert_eq!((out.statement(), out.note()), (None, None));
            }
        }
    }
}

#[test]
fn places_of_an_export_are_its_rows() {
    let program = read_clean(
        "MAIN.csv",
        export(ENGLISH, ["a", "b", "c"], "\t").as_bytes(),
    );
    let line = |span: rungc_syntax::Span| program.source.line_col(span.start).0;
    let out = &program.instrs[1];
    assert_eq!(line(out.mnemonic_span), 6);
    assert_eq!(line(out.operands[1].span), 7);
    assert_eq!(program.source.slice(out.operands[1].span), "K30");
    assert_eq!(line(program.instrs[3].span), 10);
}

#[test]
fn an_export_without_its_head_is_read() {
    let text = "\"0\"\t\"\"\t\"LD\"\t\"X000\"\r\n\"1\"\t\"\"\t\"OUT\"\t\"Y000\"\r\n\"2\"\t\"\"\t\"END\"\r\n";
    assert_eq!(
        texts(&read_clean("list.txt", text.as_bytes())),
        ["LD X000", "OUT Y000", "END"]
    );
}

/// A statement, contacts and coils of every kind, a timer, an indexed move, a bit of a word, constants of every kind, a
/// label.
const PROGRAM: &[&[u8]] = &[
    b"\x80\x00motor",
    &[0x00],
    &[0x9C, 0x08],
    b"\x82\x00start",
    &[0x0E, 0x02],
    &[0x90, 0x40, 0x1F],
    &[0x40, 5, 3, 0x11],
    &[0xA8, 0x0A],
    &[0xE8, 0xFB, 0xFF],
    &[0x21, 0x03],
    &[0xC2, 0x05],
    &[0xE8, 200],
    &[],
    &[0x4C, 5, 0, 2],
    &[0xF1, 4],
    &[0xF0, 1],
    &[0x90, 0x64],
    &[0xF0, 2],
    &[0xA8, 0x00],
    &[0x4C, 9, 1],
    &[0xE9, 0x40, 0x0D, 3, 0],
    &[0xCC, 0],
    &[0x4C, 5, 0],
    &[0xEA, 0xFF, 0x7F],
    &[0xCD, 7],
    &[0x49, 0x0D, 0x30],
    &[0xEC, 0, 0, 0xC0, 0x3F],
    &[0xEB, 1, 0, 0, 0x80],
    &[0xA8, 4],
    &[0x23, 3],
    &[0xF2, 15],
    &[0xA8, 1],
    &[0x33],
    &[0x3C],
    &[0xD0, 3],
    &[0x3C],
    &[0xD1, 1],
    &[0x6C, 1, 0x23],
    &[0x98, 0x14],
    &[0x34],
];

const MEANING: [&str; 15] = [
    "LD X010",
    "ANDP M8000",
    "AND>= D10 K-5",
    "OUT T5 K200",
    "NOP",
    "MOVP K4M100Z1 D0Z2",
    "DMOV K200000 Z0",
    "MOV H7FFF V7",
    "DEADD E1.5 H80000001 D4",
    "SET D1.F",
    "FEND",
    "P3",
    "I001",
    "STL S20",
    "END",
];

#[test]
fn operands_of_every_kind() {
    let bodies: &[&[u8]] = &[
        &[0x4C, 5, 0],
        &[0xF8, 0],
        &[0xF0, 1],
        &[0xAB, 0x0A],
        &[0xF4, 3],
        &[0xA8, 0x64],
        &[0x4C, 9, 0x0F],
        &[0xED, 0, 0, 0x80, 0x3F],
        &[0xA8, 2],
        &[0x4C, 7, 3],
        b"\xEE\xC6\xF4",
        &[0xA8, 4],
        &[0x4C, 5, 0],
        &[0xEA, 0xFF],
        &[0xA8, 0],
        &[0x4C, 9, 1],
        &[0xE9, 0x00, 0x80],
        &[0xA8, 0],
        &[0x40, 9, 6, 0x10],
        &[0xF0, 0],
        &[0xC5, 0xC8],
        &[0xE9, 0xFF, 0xFF, 0xFF, 0xFF],
        &[0x2C, 3],
        &[0xD2, 0],
        &[0x90, 0x64],
        &[0x30, 2],
        &[0xD2, 0],
        &[0x21],
        &[0xC2, 0],
        b"\x81\x00\xB5\xE7",
        &[0x3C, 2],
        &[0xD0, 0x00, 0x01],
        &[0x69, 1, 3],
        &[0x34],
    ];
    let program = read_clean("MAIN.wpg", &wpg(0x0208, bodies));
    let expected = [
        "MOV U0\\G10Z1 D100V3",
        "DEMOV E1.0 D2",
        "$MOV \"启\" D4",
        "MOV HFF D0",
        "DMOV K32768 D0",
        "LDD= C200Z0 K-1",
        "MC N0 M100",
        "MCR N0",
        "OUT T0",
        "P256",
        "IRET",
        "END",
    ];
    assert_eq!(texts(&program), expected);
    let steps: Vec<_> = program.instrs.iter().filter_map(|i| i.step).collect();
    assert_eq!(steps, [0, 5, 14, 21, 26, 35, 44, 47, 49, 50, 52, 53]);
    assert_eq!(program.instrs[9].statement(), Some("电"));
}

#[test]
fn tokens_are_read_as_what_they_mean() {
    let program = read_clean("MAIN.wpg", &wpg(0x0209, PROGRAM));
    assert_eq!(texts(&program), MEANING);
    assert_eq!(program.kind, SourceKind::GxDeveloper);
    assert_eq!(program.cpu.as_deref(), Some("FX3G"));
    assert_eq!(program.instrs[0].statement(), Some("motor"));
    assert_eq!(program.instrs[0].note(), Some("start"));
    assert_eq!(program.source.text.lines().collect::<Vec<_>>(), MEANING);
    let places: Vec<_> = program
        .instrs
        .iter()
        .map(|instr| program.source.slice(instr.span))
        .collect();
    assert_eq!(places, MEANING);
}

/// A stream as GX Works2 writes it: a header that ends with the length of the program, then the program.
fn works2_stream(bodies: &[&[u8]]) -> Vec<u8> {
    let program = tokens(bodies);
    let mut stream = vec![1, 0, 0, 0, 0, 0, 1, 0, 3, 0, 9, 0];
    stream.extend((program.len() as u32).to_le_bytes());
    stream.extend(program);
    stream.extend([0; 16]);
    stream
}

#[test]
fn the_longest_program_of_a_compound_file_is_taken() {
    let whole = works2_stream(PROGRAM);
    let mut damaged = whole.clone();
    damaged[12 + 4 + 11] ^= 0x40;
    let settings = [&wpg(0x0205, &[])[..0x40], &[0; 8]].concat();
    let names = wcd(&[(0x9C, 8, "start")]);
    let streams = |first, second| {
        gxw(&[
            Stream {
                name: "1",
                content: b"nothing",
            },
            Stream {
                name: "12",
                content: first,
            },
            Stream {
                name: "16",
                content: second,
            },
            Stream {
                name: "17",
                content: &settings,
            },
            Stream {
                name: "18",
                content: &names,
            },
        ])
    };
    for bytes in [streams(&whole, &damaged), streams(&damaged, &whole)] {
        let read = read_bytes("a.gxw", &bytes).unwrap();
        let codes: Vec<_> = read.diagnostics.iter().map(|found| found.code).collect();
        assert_eq!(codes, ["W0522"], "the project has no list of its parts");
        let program = read.program;
        assert_eq!(texts(&program), MEANING);
        assert_eq!(program.kind, SourceKind::GxWorks2);
        assert_eq!(program.cpu.as_deref(), Some("FX2N/FX2NC"));
        assert_eq!(program.comments.values().collect::<Vec<_>>(), ["start"]);
    }
    let read = read_bytes("a.gxw", &streams(&damaged, &damaged)).unwrap();
    assert!(
        read.diagnostics.has_errors(),
        "damage at the beginning of both copies is seen"
    );
    assert_eq!(texts(&read.program).last().map(String::as_str), Some("END"));
}

/// The bytes of `Ход` alone could be Hebrew, or Chinese; beside the other comments they are Russian.
#[test]
fn an_export_and_its_comments_share_their_encoding() {
    let folder = tempfile::tempdir().unwrap();
    let encode = |text: &str| encoding_rs::WINDOWS_1251.encode(text).0.into_owned();
    let main = export(ENGLISH, ["a", "b", "Ход"], "\t");
    let comments = "\"Device\"\t\"Comment\"\r\n\"X000\"\t\"Пуск двигателя насоса\"\r\n";
    std::fs::write(folder.path().join("MAIN.csv"), encode(&main)).unwrap();
    std::fs::write(folder.path().join("COMMENT.csv"), encode(comments)).unwrap();
    let program = read(folder.path()).unwrap().program;
    assert_eq!(program.instrs[0].note(), Some("Ход"));
    assert_eq!(
        program.comments.values().collect::<Vec<_>>(),
        ["Пуск двигателя насоса"]
    );
}

#[test]
fn a_project_folder_is_read_with_its_comments() {
    let folder = tempfile::tempdir().unwrap();
    let (body, others) = (
        folder.path().join("Resource/Pou/Body"),
        folder.path().join("Resource/Others"),
    );
    std::fs::create_dir_all(&body).unwrap();
    std::fs::create_dir_all(&others).unwrap();
    std::fs::write(body.join("MAIN.wpg"), wpg(0x0208, PROGRAM)).unwrap();
    std::fs::write(
        others.join("COMMENT.wcd"),
        wcd(&[(0x9C, 8, "start"), (0xA8, 10, "speed")]),
    )
    .unwrap();
    let parameters = wpa(0x0208, &[(0xFFE0, &[8, 0])]);
    std::fs::write(folder.path().join("Resource/PARAM.WPA"), parameters).unwrap();
    for path in [folder.path().to_owned(), body.join("MAIN.wpg")] {
        let read = read(&path).unwrap();
        assert_eq!(texts(&read.program), MEANING);
        let parameters = read.program.parameters.clone().unwrap();
        assert_eq!(parameters.capacity, Some(8000));
        let name = folder.path().file_name().unwrap().to_string_lossy();
        assert_eq!(read.program.source.name, name, "{}", path.display());
        let comments: Vec<_> = read
            .program
            .comments
            .iter()
            .map(|(d, c)| format!("{d} {c}"))
            .collect();
        assert_eq!(comments, ["X010 start", "D10 speed"]);
        assert_eq!(read.diagnostics.iter().count(), 0);
    }
}

#[test]
fn what_cannot_be_read_at_all_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(
        read(folder.path()),
        Err(ReadError::NoProject { .. })
    ));
    assert!(matches!(
        read(&folder.path().join("none.il")),
        Err(ReadError::Io { .. })
    ));
    let binary: Vec<u8> = (0..=255).collect();
    assert!(matches!(
        read_bytes("a.il", &binary),
        Err(ReadError::Undecodable { .. })
    ));
}

#[test]
fn lists_as_people_paste_them() {
    let text = "\u{FEFF}; press\r\n\r\n0\tLD\tX0\t; start\r\n1 or m0 // latch\n2: LDD >= d0z0,k5\nLD D>= D0 D2\nＬＤ≦　Ｄ０，Ｋ１０ ；全角\n\
        P0:\nP1 LD X1\nI1\nasc abCD d300\nASC \"a b\" D300\nMOV U0￥G5 D0v\nDEMOV E1.5+3 D0\nMOV K4M0Z1 D0.F\nend";
    let read = read_text("a.il", text);
    let findings: Vec<_> = read.diagnostics.iter().collect();
    assert!(findings.is_empty(), "{findings:?}");
    insta::assert_snapshot!(print::to_il(&read.program));
}

#[test]
fn a_protected_project_of_gx_developer_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let body = folder.path().join("Resource/Pou/Body");
    std::fs::create_dir_all(&body).unwrap();
    std::fs::write(body.join("MAIN.wpg"), wpg(0x0208, PROGRAM)).unwrap();
    let parameters = wpa(0x0208, &[(0xFFE4, b"ABCDEF01")]);
    std::fs::write(folder.path().join("Resource/PARAM.WPA"), parameters).unwrap();
    let read = read(folder.path()).unwrap();
    let codes: Vec<_> = read.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["E0650"]);
    assert!(read.program.instrs.is_empty());
}

#[test]
fn jumps_of_autoshop_are_read() {
    let list = "LD X0\nCJ L1\nLD X1\nCJEND\nL1\nOUT Y0\nEND\n";
    let read = rungc_frontend::read_text("plc.il", list);
    assert_eq!(read.diagnostics.iter().count(), 0);
    let instrs = read.program.instrs.iter().map(ToString::to_string);
    let expected = [
        "LD X000", "CJ P1", "LD X001", "CJ P63", "P1", "OUT Y000", "END",
    ];
    assert_eq!(instrs.collect::<Vec<_>>(), expected);
    let end = &read.program.instrs[3].operands[0];
    assert_eq!(&list[end.span.range()], "END");
}

const WINDOWS: &str = "\
; Filling\n\
MAIN\n\
LD X0\n\
CALL 加料 ; twice\n\
CALLP SBR_05\n\
CALL Rinse\n\
CJ L0\n\
LDI X1\n\
OUT Y0\n\
L0\n\
EI\n\
END\n\
\n\
; from the silo\n\
ＳＢＲ　加料：  // slow\n\
LD X1\n\
OUT Y1\n\
SBR_05\n\
LD X2\n\
CALL P3\n\
SRET\n\
sbr Rinse P3\n\
LD X3\n\
INT D0 D10\n\
INT 急停 I001\n\
LD M8000\n\
RST Y1\n";

#[test]
fn windows_of_autoshop_are_read() {
    let read = rungc_frontend::read_text("plc.txt", WINDOWS);
    assert_eq!(read.diagnostics.iter().count(), 0);
    insta::assert_snapshot!(print::to_il(&read.program));
    // Only the names are new; the rest is laid out as it stands.
    let laid_out = print::lay_out(&read.program);
    insta::assert_snapshot!(laid_out.text);
    let again = rungc_frontend::read_text("plc.txt", &laid_out.text).program;
    assert_eq!(texts(&again), texts(&read.program));
    assert_eq!(print::lay_out(&again).changes, []);
}

#[test]
fn windows_of_autoshop_are_written() {
    let program = rungc_frontend::read_text("plc.txt", WINDOWS).program;
    let written = print::to_autoshop(&program).unwrap();
    insta::assert_snapshot!(written);
    let again = rungc_frontend::read_text("plc.txt", &written).program;
    assert_eq!(print::to_il(&again), print::to_il(&program));
    // Without routines there is one window.
    let list = rungc_frontend::read_text("a.il", "LD X0\nOUT Y0\nEND\n").program;
    assert_eq!(
        print::to_autoshop(&list).unwrap(),
        "MAIN\nLD X000\nOUT Y000\n"
    );
}

/// Programs that names cannot express are rejected, at their position.
#[test]
fn programs_that_windows_cannot_hold() {
    let why = |list: &str| {
        let program = rungc_frontend::read_text("a.il", list).program;
        let refused = print::to_autoshop(&program).unwrap_err();
        let place = program.source.line_col(refused.span.start);
        format!(
            "{}:{} {} / {}",
            place.0, place.1, refused.message, refused.label
        )
    };
    let lists = [
        "LD X0\nCALL P0Z0\nFEND\nP0\nSRET\nEND\n",
        "LD X0\nCALL P1\nFEND\nP0\nSRET\nEND\n",
        "LD X0\nCJ P0\nFEND\nP0\nSRET\nEND\n",
        "LD X0\nFEND\nOUT Y0\nFEND\nP0\nSRET\nEND\n",
        "LD X0\nFEND\nP0\nP1\nSRET\nEND\n",
        "LD X0\nFEND\nP0\nOUT Y0\nI001\nIRET\nEND\n",
        "LD X0\nOUT Y0\nEND\nLD X1\n",
    ];
    insta::assert_snapshot!(lists.map(why).join("\n"));
}

#[test]
fn files_without_a_known_format_say_what_they_are() {
    let why = |name: &str, bytes: &[u8]| {
        rungc_frontend::read_bytes(name, bytes)
            .unwrap_err()
            .to_string()
    };
    insta::assert_snapshot!(
        [
            why("MAIN.LD", b"AutoShop\0\x01\xff\xff"),
            why("A.COW", b"\0\x01START")
        ]
        .join("\n")
    );
    assert!(rungc_frontend::read_bytes("list.cow", b"LD X0\nOUT Y0\nEND\n").is_ok());
}
