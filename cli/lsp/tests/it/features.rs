//! Answers about a program with comments in Chinese.

use crate::client::{Client, place, position, range};
use serde_json::{Value, json};

/// A press with a step ladder, a subroutine, a pair and a group of bits.
const PRESS: &str = "\
;! cpu = FX3U/FX3UC
;! X000 = 启动按钮
;! Y000 = 主接触器
;! D10 = 速度
;! S20 = 前进
;! P1 = 计算
; 自锁 😀
LD X000 ; 按下 😀
OR Y000
ANI X001
OUT Y000
; 运行时间
LD Y000
OUT T200 K30
DMOV K100000 D10
DADD D10 K1 D12
LD M8013
MOV K2M0 D20
CALLP P1
LD X002
SET S20
STL S20
OUT Y001
LD T200
OUT S0
RET
LD X003
FROB D1
MOV K5 D30Z1
FEND
P1
LD M3
OUT M100
SRET
END
";

fn opened() -> Client {
    let mut client = Client::new(&[]);
    client.open("压机.il", PRESS);
    client
}

fn at(client: &Client, line: u32, character: u32) -> Value {
    json!({ "textDocument": client.document("压机.il"), "position": position(line, character) })
}

/// Ranges with the words there.
fn words(places: &Value) -> String {
    let lines: Vec<_> = PRESS.lines().collect();
    let of = |found: &Value| {
        let range = match found.get("range") {
            Some(range) => range,
            None => found,
        };
        let line: Vec<u16> = lines[range["start"]["line"].as_u64().unwrap() as usize]
            .encode_utf16()
            .collect();
        let [start, end] =
            ["start", "end"].map(|end| range[end]["character"].as_u64().unwrap() as usize);
        let word = String::from_utf16(&line[start..end]).unwrap();
        let kind = found
            .get("kind")
            .map(|kind| format!(" {kind}"))
            .unwrap_or_default();
        format!("{} {word}{kind}", place(range))
    };
    places
        .as_array()
        .unwrap()
        .iter()
        .map(of)
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn hover_explains_instructions_devices_and_findings() {
    let mut client = opened();
    client.findings("压机.il");
    let mut shown = String::new();
    for (line, column) in [
        (7, 5),
        (13, 5),
        (14, 16),
        (16, 4),
        (30, 0),
        (27, 1),
        (5, 4),
        (17, 1),
        (6, 3),
    ] {
        let params = at(&client, line, column);
        let answer = client.ask("textDocument/hover", params);
        let text = answer["contents"]["value"].as_str().unwrap_or("nothing");
        let range = answer.get("range").map(place).unwrap_or_default();
        shown += &format!("== {line}:{column} {range}\n{text}\n");
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn symbols_and_folds_are_the_parts_of_the_program() {
    let mut client = opened();
    let document = json!({ "textDocument": client.document("压机.il") });
    fn tree(symbols: &Value, depth: usize) -> String {
        let of = |one: &Value| {
            let detail = one["detail"].as_str().unwrap_or("-");
            let (name, at) = (one["name"].as_str().unwrap(), place(&one["range"]));
            let parts = one.get("children").map(|parts| tree(parts, depth + 1));
            format!(
                "{}{name} | {detail} | {} {at}\n{}",
                "  ".repeat(depth),
                one["kind"],
                parts.unwrap_or_default()
            )
        };
        symbols.as_array().unwrap().iter().map(of).collect()
    }
    let symbols = tree(
        &client.ask("textDocument/documentSymbol", document.clone()),
        0,
    );
    let folds = client.ask("textDocument/foldingRange", document);
    let folds = folds
        .as_array()
        .unwrap()
        .iter()
        .map(|fold| format!("{}-{} ", fold["startLine"], fold["endLine"]));
    insta::assert_snapshot!(symbols + &folds.collect::<String>());
}

#[test]
fn places_of_a_device_are_found() {
    let mut client = opened();
    let mut shown = String::new();
    for (name, line, column) in [
        ("Y000", 7 + 1, 4),
        ("D11", 14, 16),
        ("M3", 31, 4),
        ("P1", 18, 7),
        ("S20", 21, 5),
    ] {
        for (method, context) in [
            ("definition", json!(null)),
            ("references", json!({ "includeDeclaration": true })),
            ("documentHighlight", json!(null)),
        ] {
            let mut params = at(&client, line, column);
            params["context"] = context;
            let answer = client.ask(&format!("textDocument/{method}"), params);
            shown += &format!("== {name} {method}\n{}\n", words(&answer));
        }
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn devices_are_renamed_or_it_says_why_not() {
    let mut client = opened();
    let mut shown = String::new();
    for (line, column, new) in [
        (10, 5, "y7"),
        (14, 16, "D100"),
        (14, 16, "D14"),
        (31, 4, "M50"),
        (13, 5, "T201"),
        (13, 5, "T0"),
        (18, 7, "P9"),
        (32, 5, "M600"),
        (32, 5, "M3"),
        (32, 5, "M9000"),
        (32, 5, "M8000"),
        (32, 5, "D5"),
        (32, 5, "Q5"),
        (8, 4, "X001"),
        (20, 5, "M55"),
        (16, 4, "M5"),
        (28, 9, "D40"),
        (15, 12, "D31"),
        (6, 1, "M5"),
    ] {
        let mut params = at(&client, line, column);
        let prepared = client.try_ask("textDocument/prepareRename", params.clone());
        let old = prepared.map_or_else(|(_, why)| why, |one| one["placeholder"].to_string());
        params["newName"] = json!(new);
        let answer = match client.try_ask("textDocument/rename", params) {
            Ok(edit) => {
                let edits = edit["changes"]
                    .as_object()
                    .unwrap()
                    .values()
                    .next()
                    .unwrap();
                let edits = edits.as_array().unwrap().iter();
                let edits =
                    edits.map(|edit| format!("{} {}", place(&edit["range"]), edit["newText"]));
                edits.collect::<Vec<_>>().join(", ")
            }
            Err((code, why)) => format!("{code} {why}"),
        };
        shown += &format!("{old} -> {new}: {answer}\n");
    }
    for note in &client.notes {
        if note.method == "window/showMessage" {
            shown += &format!("{}\n", note.params["message"]);
        }
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn settings_decide_about_renames() {
    let settings =
        "[project]\nprogram = \"a.il\"\n[index]\nD30Z1 = \"D30-D39\"\n[hmi]\nwrites = [\"M7\"]\n";
    let mut client = Client::new(&[("rungc.toml", settings.as_bytes()), ("a.il", b"")]);
    client.open("a.il", "LD X000\nOUT M1\nMOV K1 D50\nMOV K1 D30Z1\nEND\n");
    let mut ask = |line, character, new| {
        let params = json!({
            "textDocument": client.document("a.il"), "position": position(line, character), "newName": new
        });
        client
            .try_ask("textDocument/rename", params)
            .map(|_| ())
            .map_err(|(_, why)| why)
    };
    assert_eq!(ask(2, 8, "D40"), Ok(()));
    assert!(
        ask(2, 8, "D39")
            .unwrap_err()
            .contains("may reach `D39` by its index")
    );
    assert_eq!(ask(1, 5, "M7").unwrap_err(), "`M7` is named by rungc.toml");
}

#[test]
fn proposals_fit_the_place() {
    let mut client = opened();
    let mut shown = String::new();
    for line in [
        "DMO",
        "LD>",
        "7 P2 LDP ",
        "MOV K1 D1",
        "LD 启",
        "CALL ",
        "; MOV",
        "OUT T0 ",
        "RET ",
    ] {
        client.change("压机.il", Some([34, 0, 34, 999]), line);
        let params = at(&client, 34, line.encode_utf16().count() as u32);
        let answer = client.ask("textDocument/completion", params.clone());
        let items = answer["items"].as_array().unwrap();
        shown += &format!("== {line}| {}\n", items.len());
        for item in items.iter().take(6) {
            let text = |name: &str| item[name].as_str().unwrap_or("").to_owned();
            let detail = item["labelDetails"]["detail"].as_str().unwrap_or("");
            let at = place(&item["textEdit"]["range"]);
            shown += &format!("{} {detail} | {} | {at}\n", text("label"), text("detail"));
        }
        let help = client.ask("textDocument/signatureHelp", params);
        if let Some(signature) = help["signatures"].get(0) {
            shown += &format!(
                "{} ({}) {}\n",
                signature["label"], signature["documentation"], help["activeParameter"]
            );
            for one in signature["parameters"].as_array().unwrap() {
                shown += &format!("    {} {}\n", one["label"], one["documentation"]);
            }
        }
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn words_have_kinds_and_instructions_the_comments_of_their_devices() {
    let mut client = opened();
    let document = client.document("压机.il");
    let some = json!({ "textDocument": document, "range": range([5, 3, 21, 0]) });
    let hints = client.ask("textDocument/inlayHint", some.clone());
    let hints = hints.as_array().unwrap().iter();
    let hints: Vec<_> = hints
        .map(|one| {
            format!(
                "{}:{} {}",
                one["position"]["line"], one["position"]["character"], one["label"]
            )
        })
        .collect();
    let tokens = client.ask("textDocument/semanticTokens/range", some);
    let data: Vec<u32> = serde_json::from_value(tokens["data"].clone()).unwrap();
    let lines: Vec<_> = PRESS.lines().collect();
    let (mut line, mut column, mut shown) = (0, 0, String::new());
    for token in data.chunks(5) {
        column = if token[0] == 0 {
            column + token[1]
        } else {
            token[1]
        };
        line += token[0];
        let text: Vec<u16> = lines[line as usize].encode_utf16().collect();
        let text = &text[column as usize..(column + token[2]) as usize];
        let text = String::from_utf16(text).unwrap();
        shown += &format!("{line}:{column} {text} {} {}\n", token[3], token[4]);
    }
    insta::assert_snapshot!(shown + &hints.join("\n"));
    let all = client.ask(
        "textDocument/semanticTokens/full",
        json!({ "textDocument": document }),
    );
    assert!(all["data"].as_array().unwrap().len() > data.len());
}

#[test]
fn lists_are_laid_out_unless_they_cannot_be_read() {
    let mut client = Client::new(&[]);
    client.open(
        "a.il",
        "\u{feff}LD X000\r\n  out   y0 ;电\r\n\r\n\r\nEND\r\n",
    );
    let options = json!({ "tabSize": 4, "insertSpaces": true });
    let params = json!({ "textDocument": client.document("a.il"), "options": options });
    let edits = client.ask("textDocument/formatting", params.clone());
    insta::assert_snapshot!(client.shown(&edits));
    client.change("a.il", None, "LD X000\nOUT YO1O\nEND\n");
    let refused = client
        .try_ask("textDocument/formatting", params)
        .unwrap_err()
        .1;
    assert_eq!(
        refused,
        "line 2 cannot be read, so the list is not laid out"
    );
}

/// A list export.
const EXPORT: &str = "\
\"P\"
\"Step No.\"\t\"Line Statement\"\t\"Instruction\"\t\"I/O(Device)\"\t\"Blank\"\t\"PI Statement\"\t\"Note\"
\"0\"\t\"\"\t\"LD\"\t\"X000\"
\"1\"\t\"\"\t\"MOV\"\t\"K1\"
\"\"\t\"\"\t\"\"\t\"D5\"
\"6\"\t\"\"\t\"OUT\"\t\"T0\"
\"\"\t\"\"\t\"\"\t\"D5\"
\"9\"\t\"\"\t\"END\"\t\"\"
";

#[test]
fn words_of_exports_are_explained_and_found() {
    let mut client = Client::new(&[]);
    client.open("MAIN.csv", EXPORT);
    let document = client.document("MAIN.csv");
    let params = |line, character| json!({ "textDocument": document, "position": position(line, character) });
    let hover = client.ask("textDocument/hover", params(4, 11));
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.starts_with("**D5**"), "{text}");
    let found = client.ask("textDocument/documentHighlight", params(4, 11));
    let found = found.as_array().unwrap().iter();
    let found: Vec<_> = found.map(|one| place(&one["range"])).collect();
    assert_eq!(found, ["4:10-4:12", "6:10-6:12"]);
    let refused = client.try_ask("textDocument/prepareRename", params(4, 11));
    let (_, why) = refused.unwrap_err();
    assert!(why.contains("instruction lists"), "{why}");
}
