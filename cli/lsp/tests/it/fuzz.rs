//! Random edits and requests: every request has an answer, none of which is an error in the server.

use crate::client::{Client, range};
use serde_json::{Value, json};

/// Pieces of texts.
const PIECES: [&str; 26] = [
    "LD X000\n",
    "OUT Y000\n",
    "MOV K2M0 D0Z1\n",
    "P1\n",
    "STL S20\n",
    "RET\n",
    "END\n",
    ";! X000 = 启动\n",
    "; 😀\n",
    "\r\n",
    "\r",
    "\u{feff}",
    "电",
    "😀",
    "K4",
    "\"",
    " ",
    ",",
    "\0",
    "|--[ X000 ]--( M0 )--|\n",
    "0\tLD\tX000\n",
    "[project]\n",
    "MAIN\nSBR 加料\n",
    "Ｍ８",
    "CALL P1\nSRET\n",
    "",
];

const METHODS: [&str; 16] = [
    "hover",
    "documentSymbol",
    "definition",
    "references",
    "documentHighlight",
    "foldingRange",
    "completion",
    "signatureHelp",
    "inlayHint",
    "semanticTokens/full",
    "semanticTokens/range",
    "prepareRename",
    "rename",
    "formatting",
    "codeAction",
    "unknown",
];

fn some_range(random: &mut fastrand::Rng) -> [u32; 4] {
    let mut number = |most| match random.u8(..) {
        0 => u32::MAX,
        _ => random.u32(..most),
    };
    [number(9), number(12), number(9), number(12)]
}

#[test]
fn random_edits_and_requests_are_answered() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut client = Client::new(&[("rungc.toml", b"[project]\nmodel = \"h2u\"\n")]);
    let names = ["a.il", "b.csv", "t.plctest.toml", "rungc.toml"];
    for name in names {
        client.open(name, "");
    }
    for _ in 0..250 {
        let name = names[if random.bool() {
            0
        } else {
            random.usize(..names.len())
        }];
        let text: String = (0..random.usize(..5))
            .map(|_| PIECES[random.usize(..PIECES.len())])
            .collect();
        match random.u8(..40) {
            0 => client.change(name, None, &text),
            _ => client.change(name, Some(some_range(&mut random)), &text),
        }
        let method = METHODS[random.usize(..METHODS.len())];
        let place = range(some_range(&mut random));
        let mut params = json!({
            "textDocument": client.document(name), "position": place["start"], "range": place, "newName": text,
            "context": { "includeDeclaration": true, "diagnostics": [] },
            "options": { "tabSize": 1, "insertSpaces": true },
        });
        if random.u8(..20) == 0 {
            let keys: Vec<String> = params.as_object().unwrap().keys().cloned().collect();
            params[&keys[random.usize(..keys.len())]] = Value::from(random.i32(..));
        }
        if let Err((code, why)) = client.try_ask(&format!("textDocument/{method}"), params) {
            assert!(
                [-32601, -32602, -32803].contains(&code),
                "{method}: {code} {why}"
            );
        }
    }
    let failed =
        |note: &&lsp_server::Notification| note.params.to_string().contains("the check failed");
    assert!(client.notes.iter().find(failed).is_none());
    client.end();
}
