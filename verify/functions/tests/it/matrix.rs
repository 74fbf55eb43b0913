//! Rows with `matrix`.

use super::{lines, mistakes, read};
use std::fs;

const ROW: &str = "[[property]]\nmatrix = 'ce.csv'\n";

/// Bytes of a text in UTF-16 with a mark.
fn wide(text: &str) -> Vec<u8> {
    format!("\u{feff}{text}")
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect()
}

fn expanded(table: &[u8]) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ce.csv"), table).unwrap();
    match read(folder.path(), ROW) {
        Ok(properties) => lines(&properties),
        Err(_) => mistakes(folder.path(), ROW),
    }
}

fn wrong(table: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ce.csv"), table).unwrap();
    mistakes(folder.path(), ROW)
}

#[test]
fn each_cell_becomes_properties() {
    let table = "Cause,Condition,Description,Pump,Alarm lamp\nEffect,,,!Y000,Y001\nTime,,,,200ms\n\
                 Emergency stop,!X000,red,X,S\nOverflow,D0 > 900 | X003,,S 2s,X (1 s)\n\n\
                 Reset button,X004,,R,R\nTest,X005,,-,\n";
    insta::assert_snapshot!(expanded(table.as_bytes()));
}

#[test]
fn german_and_chinese_tables_are_read() {
    let german =
        "Ursache;Beschreibung;!Y000;Stör-Lampe\r\nQuittierung;;;X004\r\nNot-Halt;;X 0,5s;S\r\n";
    let of_excel = expanded(&wide(german));
    assert_eq!(expanded(german.as_bytes()), of_excel);
    let latin: Vec<u8> = german.chars().map(|c| c as u8).collect();
    assert_eq!(expanded(&latin), of_excel);
    assert_eq!(expanded(&wide(&german.replace(';', "\t"))), of_excel);
    insta::assert_snapshot!(of_excel);
    let chinese = "原因,说明,电机\r\n输出,,!Y000\r\n急停按钮,,X\r\n";
    insta::assert_snapshot!(expanded(chinese.as_bytes()), @r#"ce.csv C3 (急停按钮, 电机): effect missing: never "急停按钮" & Y000"#);
    // A cause of the name `Reset`, with a condition.
    let table = "Cause,Condition,Y000\nStop,X000,S\nReset,X001,R\n";
    insta::assert_snapshot!(expanded(table.as_bytes()));
}

#[test]
fn mistakes_have_a_row_and_a_column() {
    let tables = [
        "",
        "Y000,Y001\nX000,X\n",
        "Cause\nX000\n",
        "Cause,Y000\nX000,T\nX001,R 2s\nX002,X soon\n",
        "Cause,Y000\nX000,S\n",
        "Cause,Y000\nX000,X\nX001,R\n",
        "Cause,Y000,\nX000,X,X\n,X\n",
        "Cause,Y000,,Y001\nX000,X,X,X\n",
        "Cause,Condition,Y000,Condition\na,X000,X,X1\n",
        "Cause,Condition,Y000\nstop,,X\n",
        "Cause,Y000\nX000,-\n",
        "Cause,Y000\nX000,\"X\nX001,X\n",
    ];
    insta::assert_snapshot!(tables.map(wrong).join("\n"));
    let folder = tempfile::tempdir().unwrap();
    assert!(
        mistakes(folder.path(), ROW).starts_with("'ce.csv': cannot read the matrix `ce.csv`: ")
    );
}
