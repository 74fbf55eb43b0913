//! A program that fills the memory of a PLC: every answer comes, and is printed with its time.

use crate::client::{Client, position, range};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Instant;

/// Networks of 16 steps: in a release build they fill the memory of a PLC.
const NETWORKS: usize = if cfg!(debug_assertions) { 60 } else { 1000 };

/// A list of 16 000 steps, with comments and a few findings.
fn list() -> String {
    let mut list = String::new();
    for n in 0..2 * NETWORKS {
        let _ = writeln!(list, ";! M{n} = 阀门 {n}");
    }
    for n in 0..NETWORKS {
        let (m, d) = (n, n % 900);
        let _ = write!(
            list,
            "; 网络 {n}\nLD M{m}\nOR M{}\nANI X{:o}\nOUT M{m}\nLD M8013\nMOV K{n} D{d}\nAND> D{d} K5\nSET M{}\n",
            m + 1000,
            n % 128,
            m + 1000,
        );
    }
    list + "END\n"
}

#[test]
fn a_long_program_is_answered() {
    let mut client = Client::new(&[]);
    let list = list();
    let start = Instant::now();
    client.open("long.il", &list);
    assert!(client.diagnostics("long.il")["diagnostics"].is_array());
    let mut times = format!("open to diagnostics {:?}\n", start.elapsed());
    let document = client.document("long.il");
    let comments = 2 * NETWORKS as u32;
    let line = comments + 9 * (NETWORKS as u32 / 2) + 1;
    let at = |character| json!({ "textDocument": document, "position": position(line, character) });
    let with = |mut params: Value, key: &str, value: Value| {
        params[key] = value;
        params
    };
    let window = range([line, 0, line + 60, 0]);
    let requests = [
        ("hover", at(4)),
        ("hover", at(1)),
        ("definition", at(4)),
        (
            "references",
            with(at(4), "context", json!({ "includeDeclaration": true })),
        ),
        ("documentHighlight", at(4)),
        ("documentSymbol", at(0)),
        ("foldingRange", at(0)),
        ("completion", at(3)),
        ("completion", at(0)),
        ("signatureHelp", at(3)),
        ("inlayHint", with(at(0), "range", window.clone())),
        ("semanticTokens/full", at(0)),
        ("semanticTokens/range", with(at(0), "range", window.clone())),
        ("rename", with(at(4), "newName", json!("M3000"))),
        (
            "formatting",
            with(
                at(0),
                "options",
                json!({ "tabSize": 4, "insertSpaces": true }),
            ),
        ),
        (
            "codeAction",
            with(
                with(at(0), "range", window),
                "context",
                json!({ "diagnostics": [] }),
            ),
        ),
    ];
    for (method, params) in requests {
        let mut ask = |after: &str| {
            if after == "after an edit" {
                client.change("long.il", Some([comments, 1, comments, 1]), " ");
            }
            let start = Instant::now();
            let answer = client.ask(&format!("textDocument/{method}"), params.clone());
            let _ = write!(times, "{method} {after} {:?}; ", start.elapsed());
            assert!(!answer.is_null(), "{method}");
        };
        ask("after an edit");
        ask("warm");
        times.push('\n');
    }
    client.change("long.il", Some([comments, 1, comments, 2]), "");
    let start = Instant::now();
    client.notes.clear();
    client.diagnostics("long.il");
    let _ = writeln!(times, "edit to diagnostics {:?}", start.elapsed());
    println!("{times}");
    client.end();
}
