//! List exports: heads, headings, rows and cells.

use crate::files::texts;
use encoding_rs::Encoding;
use rungc_frontend::{print, read_bytes};
use rungc_syntax::Program;

/// A table with this head above one instruction, as the editors write it.
pub fn export(cpu: &str) -> Vec<u8> {
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

/// A text that begins with a quote takes in no rows, whether another quote follows or none. Texts may hold line ends.
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

/// Tables as spreadsheets and people write them: a blank after each separator, or the line of Excel that states it.
#[test]
fn separators_may_be_followed_by_blanks_or_stated() {
    let rows = [
        "'Step No.'|'Line Statement'|'Instruction'|'I/O(Device)'|'Blank'|'PI Statement'|'Note'",
        "'0'|''|'LD'|'X000'|''|''|'a ''b'', c; d'",
        "'1'|'two; parts'|''|''|''|''|''",
        "'1'|''|'$MOV'|'''a b'''|''|''|''",
        "''|''|''|'D0'|''|''|'at\nthe end'",
        "'6'|''|'END'|''|''|''|''",
    ];
    let quoted = rows.map(|row| row.replace('\'', "\""));
    for (head, separator) in [
        ("", ", "),
        ("", ",  "),
        ("", "; "),
        ("", " ; "),
        ("", "\t "),
        ("sep=;\r\n", ";"),
        ("sep=;\n", "; "),
        ("SEP=,\r\n", ", "),
        ("\"sep=;\"\n", ";"),
        ("sep=|\r\n", "|"),
    ] {
        for rows in [&quoted[..], &quoted[1..]] {
            let text = rows.join("\n").replace('|', separator);
            let text = format!("{head}{text}");
            let read = read_bytes("MAIN.csv", text.as_bytes()).unwrap();
            assert_eq!(read.diagnostics.iter().count(), 0, "{text}");
            let program = &read.program;
            let expected = ["LD X000", "$MOV \"a b\" D0", "END"];
            assert_eq!(texts(program), expected, "{text}");
            assert_eq!(program.instrs[1].statement(), Some("two; parts"), "{text}");
            assert_eq!(program.instrs[0].note(), Some("a \"b\", c; d"), "{text}");
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

/// Names that the editor gives are not comments, and a comment that the text states stays.
#[test]
fn autoshop_keeps_the_comments_of_pointers() {
    let list = ";! P2 = two words\n;! P3 = same\n;! P4 = same\n;! I001 = P1\nLD X0\nCALL P2\nCALL P3\nCALL P4\nFEND\n\
                P2\nSRET\nP3\nSRET\nP4\nSRET\nI001\nIRET\nEND\n";
    for list in [list, "LD X0\nCALL P1\nFEND\nP1\nSRET\nI001\nIRET\nEND\n"] {
        let program = rungc_frontend::read_text("a.il", list).program;
        let written = print::to_autoshop(&program).unwrap();
        let back = rungc_frontend::read_text("a.txt", &written).program;
        assert_eq!(back.comments, program.comments, "{written}");
        assert_eq!(texts(&back), texts(&program), "{written}");
    }
    // A window alone is a subroutine, not the main program.
    let alone = rungc_frontend::read_text("a.txt", "SBR valve\nLD X0\nOUT Y0\n").program;
    assert_eq!(texts(&alone).join(" "), "FEND P0 LD X000 OUT Y000 SRET END");
}

/// Spaces at the ends of texts stay; those of ASC are characters.
#[test]
fn spaces_belong_to_the_texts_of_an_export() {
    let rows = [
        ["", "  indented", "", "", "", "", ""],
        ["0", "", "LD", "X000", "", "", " note "],
        ["1", "", "ASC", " abc ", "", "", ""],
        ["", "", "", "D0", "", "", ""],
        ["12", "", "END", "", "", "", ""],
    ];
    check_comes_out(&rows);
    let read = read_bytes("MAIN.csv", &export_of(&rows)).unwrap();
    assert_eq!(texts(&read.program)[1], "ASC \" abc \" D0");
    let padded = b"0 , LD , M8000 , \r\n1 , ASC , abc , \r\n , , D0 , \r\n12 , END , , \r\n";
    let read = read_bytes("MAIN.csv", padded).unwrap();
    assert_eq!(texts(&read.program)[1], "ASC \"abc\" D0");
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

/// A row whose cells are not separated as in the others would be an instruction less.
#[test]
fn no_row_is_passed_over() {
    let rows = |stray: &str| {
        let head = "Step No.\tLine Statement\tInstruction\tI/O(Device)";
        format!("{head}\n0\t\tLD\tX000\n1\t\tOUT\tY000\n{stray}\n2\t\tEND\n")
    };
    for stray in ["2,,INC,D0", "LD X001", "foo\t\t\t\t", "-"] {
        let read = read_bytes("MAIN.csv", rows(stray).as_bytes()).unwrap();
        let messages: Vec<_> = read.diagnostics.iter().map(|d| &*d.message).collect();
        assert_eq!(
            messages,
            ["this row has neither an instruction nor a statement"],
            "{stray}"
        );
    }
    for blank in ["", "\t\t\t", "2", "\tA statement"] {
        let read = read_bytes("MAIN.csv", rows(blank).as_bytes()).unwrap();
        assert!(read.diagnostics.is_empty(), "{blank}");
        assert_eq!(texts(&read.program).len(), 3, "{blank}");
    }
}
