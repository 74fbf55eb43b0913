//! Lifecycle, texts and diagnostics.

use crate::client::{Client, place, range};
use rungc_lsp::Ended;
use serde_json::{Value, json};

/// A list with comments in Chinese, an error and two warnings.
const PRESS: &str = "\
;! X000 = 启动按钮
;! Y000 = 主接触器
; 电机 😀
LD X000 ; 按下 😀
OUT Y000
LD X001
OUT Y000
LD X0O2
MOV K1.5 D0
FROB D1
END
";

#[test]
fn findings_of_unsaved_text_have_their_places() {
    let mut client = Client::new(&[("press.il", b"END\n")]);
    client.open("press.il", PRESS);
    insta::assert_snapshot!(client.findings("press.il"));
    let broken = client.document("press.il");
    client.change("press.il", Some([9, 0, 9, 7]), "MOV K1 D1");
    client.change("press.il", Some([8, 0, 9, 0]), "");
    client.change("press.il", Some([7, 4, 7, 6]), "00");
    client.change("press.il", Some([3, 3, 3, 7]), "M8013");
    insta::assert_snapshot!(client.findings("press.il"));
    client.note("textDocument/didClose", json!({ "textDocument": broken }));
    assert_eq!(client.findings("press.il"), "");
    assert_eq!(client.end(), Ended::Exit);
}

#[test]
fn units_of_columns_are_negotiated() {
    let mut columns = Vec::new();
    for offered in [
        json!(["utf-16", "utf-8"]),
        json!(["utf-32"]),
        json!([]),
        Value::Null,
    ] {
        let mut client = Client::silent(&[]);
        let general = json!({ "general": { "positionEncodings": offered } });
        let answer = client.ask("initialize", json!({ "capabilities": general }));
        let chosen = answer["capabilities"]["positionEncoding"].clone();
        client.open("a.il", "\u{feff}LD X0 ; 😀\r\nLD \"电😀\" X9\r\nEND\r\n");
        let found = client.diagnostics("a.il");
        let ends = found["diagnostics"].as_array().unwrap().iter();
        let ends: Vec<_> = ends.map(|found| place(&found["range"])).collect();
        columns.push(format!("{chosen} {}", ends.join(" ")));
    }
    insta::assert_snapshot!(columns.join("\n"));
}

#[test]
fn settings_of_the_folder_apply_also_unsaved() {
    let settings = "[project]\nmodel = \"fx1s\"\n";
    let list = "LD X000\nOUT M600\nLD M600\nOUT Y000\nEND\n";
    let mut client = Client::new(&[("rungc.toml", settings.as_bytes()), ("a.il", b"")]);
    client.open("a.il", list);
    insta::assert_snapshot!(client.findings("a.il"));
    client.open("rungc.toml", "[project]\nmodel = \"fx3u\"\n");
    assert_eq!(client.findings("a.il"), "");
    client.diagnostics("rungc.toml");
    client.change("rungc.toml", None, "[project]\nmodel = \"fx9\"\nname = 1\n");
    insta::assert_snapshot!([client.findings("rungc.toml"), client.findings("a.il")].join("\n"));
}

#[test]
fn findings_are_placed_in_the_files_of_a_program() {
    let settings = "[project]\nprogram = [\"Main.st\", \"Twice.st\"]\n";
    let main = "PROGRAM Main\nD1 := Twice(D0);\nEND_PROGRAM\n";
    let twice = "FUNCTION Twice : INT\nVAR_INPUT x : INT; END_VAR\nTwice := y * 2;\nEND_FUNCTION\n";
    let mut client = Client::new(&[
        ("rungc.toml", settings.as_bytes()),
        ("Main.st", main.as_bytes()),
        ("Twice.st", twice.as_bytes()),
    ]);
    client.open("Twice.st", twice);
    let own = client.findings("Twice.st");
    assert!(own.starts_with("2:9-2:10 1 E0201: nothing"), "{own}");
    client.open("Main.st", main);
    let other = client.findings("Main.st");
    assert!(
        other.starts_with("0:0-0:0 1 E0201: Twice.st:3: nothing"),
        "{other}"
    );
}

#[test]
fn an_open_file_is_checked_with_those_of_its_folder() {
    let main = "PROGRAM Main\nD1 := Twice(D0);\nEND_PROGRAM\n";
    let twice = "FUNCTION Twice : INT\nVAR_INPUT x : INT; END_VAR\nTwice := x * 2;\nEND_FUNCTION\n";
    let mut client = Client::new(&[("Main.st", main.as_bytes()), ("Twice.st", twice.as_bytes())]);
    client.open("Main.st", main);
    let found = client.findings("Main.st");
    assert!(
        found.starts_with("1:6-1:11 3 N0240: this file is compiled with `Twice.st`"),
        "{found}"
    );
    // What is not saved counts.
    client.open("Twice.st", &twice.replace("x * 2", "y"));
    let part = client.findings("Twice.st");
    assert!(
        part.contains("2:9-2:10 1 E0201: nothing declares `y`"),
        "{part}"
    );
    assert!(
        client
            .findings("Main.st")
            .contains("E0201: Twice.st:3: nothing")
    );
}

#[test]
fn mistakes_in_closed_settings_are_shown_there() {
    let mut client = Client::new(&[("rungc.toml", "[检查]\n".as_bytes()), ("a.il", b"")]);
    client.open("a.il", "LD X000\nOUT Y000\nEND\n");
    assert!(client.findings("a.il").contains("the settings in"));
    let mistakes = client.findings("rungc.toml");
    assert!(mistakes.starts_with("0:1-0:3 1 E0040"), "{mistakes}");
    std::fs::write(client.path("rungc.toml"), "").unwrap();
    client.note("workspace/didChangeWatchedFiles", json!({ "changes": [] }));
    assert_eq!(client.findings("a.il"), "");
    assert_eq!(client.findings("rungc.toml"), "");
}

#[test]
fn test_files_exports_and_projects_are_checked() {
    let mut client = Client::new(&[]);
    client.open(
        "t.plctest.toml",
        "model = \"fx3u\"\ntopic = \"t\"\n[[case]]\nname = \"电\"\n",
    );
    insta::assert_snapshot!(client.findings("t.plctest.toml"));
    client.open("MAIN.csv", "0\tLD\tX000\n1\tMOV\tK1\tX9\n6\tEND\t\n");
    insta::assert_snapshot!(client.findings("MAIN.csv"));
    client.open("drawn.txt", "|--[ X000 ]----( M9999 )--|\n|--[ END ]--|\n");
    insta::assert_snapshot!(client.findings("drawn.txt"));
    client.open("picture.il", "\u{1}\u{2}\u{3}PNG");
    insta::assert_snapshot!(client.findings("picture.il"));
}

#[test]
fn fixes_change_what_is_there_now() {
    let mut client = Client::new(&[]);
    client.open("a.il", "LD X000\r\nMOV 0x1F D0\r\nMOV 0x2F D1\r\n");
    client.change("a.il", Some([0, 0, 0, 0]), "; 启动\r\n");
    let document = client.document("a.il");
    let at = |line| {
        let place = range([line, 5, line, 5]);
        json!({ "textDocument": document, "range": place, "context": { "diagnostics": [] } })
    };
    let actions = client.ask("textDocument/codeAction", at(2));
    insta::assert_snapshot!(client.shown(&actions));
    for (only, count) in [
        ("quickfix", 1),
        ("source", 1),
        ("sources", 0),
        ("refactor", 0),
        ("", 2),
    ] {
        let mut params = at(2);
        params["context"]["only"] = json!([only]);
        let actions = client.ask("textDocument/codeAction", params);
        assert_eq!(actions.as_array().unwrap().len(), count, "{only}");
    }
}

#[test]
fn requests_that_cannot_be_answered_are_errors() {
    let mut client = Client::silent(&[]);
    let code = |answer: Result<Value, (i32, String)>| answer.unwrap_err().0;
    assert_eq!(
        code(client.try_ask("textDocument/hover", json!({}))),
        -32002
    );
    assert_eq!(code(client.try_ask("initialize", json!(5))), -32602);
    client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(
        code(client.try_ask("initialize", json!({ "capabilities": {} }))),
        -32600
    );
    assert_eq!(code(client.try_ask("rungc/unknown", json!({}))), -32601);
    assert_eq!(
        code(client.try_ask("textDocument/codeAction", json!({ "a": 1 }))),
        -32602
    );
    let document = client.document("closed.il");
    let params = json!({ "textDocument": document, "range": range([0, 0, 0, 0]), "context": { "diagnostics": [] } });
    let closed = client.try_ask("textDocument/codeAction", params);
    assert!(closed.unwrap_err().1.ends_with("closed.il` is not open"));
    client.note("textDocument/didChange", json!({ "textDocument": 1 }));
    client.note("rungc/unknown", json!({}));
    client.ask("shutdown", Value::Null);
    assert_eq!(code(client.try_ask("shutdown", Value::Null)), -32600);
    client.note("exit", Value::Null);
    assert_eq!(client.abandon(), Ended::Exit);
    assert_eq!(Client::new(&[]).abandon(), Ended::Abandoned);
}

#[test]
fn a_request_that_was_canceled_is_not_answered() {
    let mut client = Client::new(&[]);
    client.open("a.il", &"LD X000\nMOV 0x1F D0\n".repeat(300));
    let document = client.document("a.il");
    let params = json!({
        "textDocument": document, "range": range([0, 0, 0, 0]), "context": { "diagnostics": [] }
    });
    // The server is busy with the first while the others arrive.
    let ids: Vec<_> = (0..3)
        .map(|_| client.send("textDocument/codeAction", params.clone()))
        .collect();
    client.note("$/cancelRequest", json!({ "id": ids[2] }));
    assert!(client.response(ids[0]).response_result.is_ok());
    assert!(client.response(ids[1]).response_result.is_ok());
    let canceled = client.response(ids[2]).response_result;
    assert_eq!(canceled.unwrap_err().code, -32800);
}

#[test]
fn editors_that_watch_files_are_asked_to() {
    let mut client = Client::silent(&[]);
    let watched = json!({ "didChangeWatchedFiles": { "dynamicRegistration": true } });
    client.ask(
        "initialize",
        json!({ "capabilities": { "workspace": watched } }),
    );
    client.note("initialized", json!({}));
    let request = client.request();
    assert_eq!(request.method, "client/registerCapability");
    insta::assert_snapshot!(request.params);
    assert_eq!(client.end(), Ended::Exit);
}
