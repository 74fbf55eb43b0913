//! Input that is not a message, or not a sensible one: each line has its answer, and the server continues.

use crate::{REVERSER, folder, handshake, lines, options, request};
use serde_json::{Value, json};

/// Code of the answer to a line, and its identifier.
fn code(line: &str) -> (Value, Value) {
    let folder = folder(&[]);
    let input = format!("{}{line}\n", handshake("2025-11-25"));
    let answers = lines(&options(folder.path(), false), input.as_bytes());
    assert_eq!(answers.len(), 2, "{line}");
    let answer = answers
        .iter()
        .find(|answer| answer["id"] != json!(0))
        .unwrap();
    (answer["error"]["code"].clone(), answer["id"].clone())
}

#[test]
fn what_is_not_a_message_has_an_answer() {
    for (line, wanted) in [
        ("{", -32700),
        ("not json", -32700),
        ("\u{1}", -32700),
        ("7", -32600),
        ("[]", -32600),
        ("{}", -32600),
        (r#"{"jsonrpc":"1.0","id":1,"method":"ping"}"#, -32600),
        (r#"{"jsonrpc":"2.0","id":1,"method":5}"#, -32600),
        (r#"{"jsonrpc":"2.0","id":null,"method":"ping"}"#, -32600),
        (r#"{"jsonrpc":"2.0","id":1.5,"method":"ping"}"#, -32600),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"ping","params":[1]}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"nothing/here"}"#,
            -32601,
        ),
        (r#"{"jsonrpc":"2.0","id":1,"method":"tools/call"}"#, -32602),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":7}}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"chek"}}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"check","arguments":[]}}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"tools/list","params":{"cursor":"x"}}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"resources/read"}"#,
            -32602,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"resources/read","params":{"uri":"file:///etc/passwd"}}"#,
            -32002,
        ),
        (
            r#"{"jsonrpc":"2.0","id":1,"method":"prompts/get","params":{"name":"x"}}"#,
            -32602,
        ),
        (r#"{"jsonrpc":"2.0","id":1,"method":"initialize"}"#, -32602),
        (r#"[{"jsonrpc":"2.0","id":1,"method":"ping"}]"#, -32600),
    ] {
        assert_eq!(code(line).0, json!(wanted), "{line}");
    }
    assert_eq!(
        code(r#"{"jsonrpc":"2.0","id":"é","method":"x"}"#).1,
        json!("é")
    );
    let deep = "[".repeat(100_000);
    assert_eq!(code(&deep).0, json!(-32700));
}

#[test]
fn bytes_that_are_not_text_have_an_answer() {
    let folder = folder(&[]);
    let mut input = b"\xff\xfe\x00\n\n  \r\n".to_vec();
    input.extend(handshake("2025-11-25").bytes());
    let answers = lines(&options(folder.path(), false), &input);
    assert_eq!(answers.len(), 2, "{answers:?}");
}

#[test]
fn a_line_that_is_too_long_is_left_out() {
    let folder = folder(&[]);
    let long = format!(
        "{{\"jsonrpc\":\"2.0\",\"id\":1,\"x\":\"{}\"}}\n",
        "x".repeat(20 << 20)
    );
    let input = format!(
        "{long}{}{}",
        handshake("2025-11-25"),
        request(1, "ping", json!({}))
    );
    let answers = lines(&options(folder.path(), false), input.as_bytes());
    assert_eq!(answers.len(), 3);
    let rejected = answers
        .iter()
        .find(|answer| answer["id"].is_null())
        .unwrap();
    assert!(
        rejected["error"]["message"]
            .as_str()
            .unwrap()
            .contains("8 MiB"),
        "{rejected}"
    );
}

#[test]
fn input_that_ends_within_a_line_is_answered() {
    let folder = folder(&[]);
    let input = handshake("2025-11-25") + request(1, "ping", json!({})).trim_end();
    assert_eq!(
        lines(&options(folder.path(), false), input.as_bytes()).len(),
        2
    );
    let input = handshake("2025-11-25") + "{\"jsonrpc\":";
    assert_eq!(
        lines(&options(folder.path(), false), input.as_bytes()).len(),
        2
    );
}

#[test]
fn more_requests_than_wait_are_turned_away_with_an_answer() {
    let folder = folder(&[("a.il", REVERSER)]);
    let mut input = handshake("2025-11-25");
    let params = json!({ "name": "check", "arguments": { "path": "a.il" } });
    for id in 1..=2_000 {
        input += &request(id, "tools/call", params.clone());
    }
    let answers = lines(&options(folder.path(), false), input.as_bytes());
    assert_eq!(answers.len(), 2_001);
}

/// Messages in which anything may be wrong, made by chance.
#[test]
fn damaged_messages_never_stop_the_server() {
    let folder = folder(&[("a.il", REVERSER)]);
    let good = [
        request(
            1,
            "tools/call",
            json!({ "name": "check", "arguments": { "path": "a.il" } }),
        ),
        request(
            2,
            "tools/call",
            json!({ "name": "view", "arguments": { "list": REVERSER, "width": 80 } }),
        ),
        request(
            3,
            "tools/call",
            json!({ "name": "why", "arguments": { "path": "a.il", "device": "Y000" } }),
        ),
        request(
            4,
            "resources/read",
            json!({ "uri": "rungc://instruction/MOV" }),
        ),
        request(
            5,
            "prompts/get",
            json!({ "name": "write-tests", "arguments": { "path": "a.il" } }),
        ),
    ];
    let mut random = fastrand::Rng::with_seed(7);
    let mut input = handshake("2025-11-25").into_bytes();
    for _ in 0..300 {
        let mut line = random.choice(&good).unwrap().clone().into_bytes();
        line.pop();
        for _ in 0..random.usize(1..4) {
            let at = random.usize(..line.len());
            match random.u8(..3) {
                0 => line[at] = random.u8(32..127),
                1 => drop(line.remove(at)),
                _ => line.insert(at, *random.choice(b"{}[]\",:0-e\\").unwrap()),
            }
        }
        input.extend(line);
        input.push(b'\n');
    }
    input.extend(request(1_000_000, "tools/list", json!({})).bytes());
    let answers = lines(&options(folder.path(), false), &input);
    let last = answers
        .iter()
        .find(|answer| answer["id"] == json!(1_000_000))
        .unwrap();
    assert!(last["result"]["tools"].is_array());
    let failed = answers
        .iter()
        .filter(|answer| answer["error"]["code"] == json!(-32603));
    assert_eq!(failed.count(), 0);
}
