//! Versions, lists, cancellation.

use crate::{REVERSER, folder, handshake, lines, options, request, session};
use serde_json::{Value, json};
use std::collections::BTreeSet;

#[test]
fn the_version_is_agreed_on() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let agreed = |wanted: &str| {
        let answers = lines(&options, handshake(wanted).as_bytes());
        answers[0]["result"]["protocolVersion"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    for version in ["2024-11-05", "2025-03-26", "2025-06-18", "2025-11-25"] {
        assert_eq!(agreed(version), version);
    }
    assert_eq!(agreed("1999-01-01"), "2025-11-25");
    assert_eq!(agreed("2026-07-28"), "2025-11-25");
}

#[test]
fn nothing_but_ping_is_answered_before_the_handshake() {
    let folder = folder(&[]);
    let input = request(1, "tools/list", json!({})) + &request(2, "ping", json!({}));
    let mut answers = lines(&options(folder.path(), false), input.as_bytes());
    answers.sort_by_key(|answer| answer["id"].as_u64());
    assert_eq!(answers[0]["error"]["code"], json!(-32600));
    assert_eq!(answers[1]["result"], json!({}));
}

/// The version in which each request names it.
#[test]
fn requests_without_a_handshake_name_their_version() {
    let folder = folder(&[("a.il", REVERSER)]);
    let options = options(folder.path(), false);
    let meta = |version: &str| {
        json!({
            "io.modelcontextprotocol/protocolVersion": version,
            "io.modelcontextprotocol/clientCapabilities": {},
        })
    };
    let input = [
        request(1, "server/discover", json!({ "_meta": meta("2026-07-28") })),
        request(2, "tools/list", json!({ "_meta": meta("2026-07-28") })),
        request(
            3,
            "tools/call",
            json!({ "_meta": meta("2026-07-28"), "name": "check", "arguments": { "path": "a.il" } }),
        ),
        request(4, "tools/list", json!({ "_meta": meta("2030-01-01") })),
        request(5, "ping", json!({ "_meta": meta("2026-07-28") })),
        request(
            6,
            "resources/read",
            json!({ "_meta": meta("2026-07-28"), "uri": "rungc://x/y" }),
        ),
    ];
    let answers = lines(&options, input.concat().as_bytes());
    let of = |id: u64| {
        answers
            .iter()
            .find(|answer| answer["id"] == json!(id))
            .unwrap()
    };
    assert_eq!(of(1)["result"]["supportedVersions"], json!(["2026-07-28"]));
    assert_eq!(of(2)["result"]["resultType"], json!("complete"));
    assert!(of(2)["result"]["ttlMs"].is_u64());
    assert_eq!(of(3)["result"]["structuredContent"]["errors"], json!(0));
    assert_eq!(of(4)["error"]["code"], json!(-32022));
    assert_eq!(of(4)["error"]["data"]["requested"], json!("2030-01-01"));
    assert_eq!(of(5)["error"]["code"], json!(-32601));
    assert_eq!(of(6)["error"]["code"], json!(-32602));
}

#[test]
fn a_batch_has_one_answer_in_the_version_that_has_batches() {
    let folder = folder(&[]);
    let batch = json!([
        { "jsonrpc": "2.0", "id": 1, "method": "ping" },
        { "jsonrpc": "2.0", "method": "notifications/initialized" },
        { "jsonrpc": "2.0", "id": 2, "method": "nothing" },
        7,
    ]);
    let input = format!("{}{batch}\n", handshake("2025-03-26"));
    let answers = lines(&options(folder.path(), false), input.as_bytes());
    assert_eq!(answers.len(), 2);
    let all = answers[1].as_array().unwrap();
    assert_eq!(all.len(), 3, "{all:?}");
    assert_eq!(all[0], json!({ "jsonrpc": "2.0", "id": 1, "result": {} }));
    assert_eq!(all[1]["error"]["code"], json!(-32601));
    assert_eq!(all[2]["error"]["code"], json!(-32600));
}

#[test]
fn tools_have_schemas_and_say_whether_they_change_anything() {
    let folder = folder(&[]);
    let tools = |write| {
        let answers = session(&options(folder.path(), write), &[("tools/list", json!({}))]);
        answers[0]["result"]["tools"].as_array().unwrap().clone()
    };
    let names = |tools: &[Value]| -> Vec<String> {
        tools
            .iter()
            .map(|tool| tool["name"].as_str().unwrap().to_owned())
            .collect()
    };
    let reading = tools(false);
    assert_eq!(
        names(&reading).join(" "),
        "open check view xref explain run why test verify diff convert"
    );
    for tool in &reading {
        assert_eq!(tool["annotations"]["readOnlyHint"], json!(true), "{tool}");
        for schema in ["inputSchema", "outputSchema"] {
            assert_eq!(tool[schema]["type"], json!("object"), "{tool}");
        }
        assert!(tool["description"].as_str().unwrap().len() > 60, "{tool}");
    }
    let writing = tools(true);
    assert_eq!(names(&writing).last().unwrap(), "write");
    assert_eq!(
        writing.last().unwrap()["annotations"]["readOnlyHint"],
        json!(false)
    );
}

#[test]
fn resources_come_in_parts_and_each_can_be_read() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let mut all = Vec::new();
    let mut params = json!({});
    loop {
        let answer = &session(&options, &[("resources/list", params)])[0]["result"];
        all.extend(answer["resources"].as_array().unwrap().clone());
        match answer.get("nextCursor") {
            Some(cursor) => params = json!({ "cursor": cursor }),
            None => break,
        }
    }
    assert!(all.len() > 300, "{}", all.len());
    let uris: BTreeSet<String> = all
        .iter()
        .map(|one| one["uri"].as_str().unwrap().to_owned())
        .collect();
    assert_eq!(uris.len(), all.len(), "an address is that of one resource");
    let requests: Vec<_> = uris
        .iter()
        .map(|uri| ("resources/read", json!({ "uri": uri })))
        .collect();
    for requests in requests.chunks(100) {
        for (answer, (_, params)) in session(&options, requests).iter().zip(requests) {
            let text = answer["result"]["contents"][0]["text"].as_str();
            assert!(
                text.is_some_and(|text| !text.is_empty()),
                "{params}: {answer}"
            );
        }
    }
    let templates = &session(&options, &[("resources/templates/list", json!({}))])[0]["result"];
    assert_eq!(templates["resourceTemplates"].as_array().unwrap().len(), 7);
    let read =
        |uri: &str| session(&options, &[("resources/read", json!({ "uri": uri }))])[0].to_string();
    assert!(read("rungc://special-device/M8013/fx3u").contains("clock"));
    assert!(read("rungc://plc-error/6706").contains("6706"));
    assert!(read("rungc://instruction/MOVV").contains("did you mean"));
    assert!(read("rungc://instruction/MOV/fx9").contains("error"));
}

#[test]
fn what_is_cancelled_has_no_answer() {
    let folder = folder(&[("a.il", REVERSER)]);
    let run = json!({ "name": "run", "arguments": { "path": "a.il", "for_ms": 3_600_000 } });
    let cancel = |id: u64| {
        let params = json!({ "requestId": id, "reason": "changed my mind" });
        json!({ "jsonrpc": "2.0", "method": "notifications/cancelled", "params": params })
            .to_string()
            + "\n"
    };
    let input = [
        handshake("2025-11-25"),
        request(1, "tools/call", run.clone()),
        request(2, "tools/call", run),
        cancel(2),
        cancel(1),
        cancel(77),
        "{\"jsonrpc\":\"2.0\",\"method\":\"notifications/cancelled\"}\n".to_owned(),
        request(3, "tools/list", json!({})),
    ];
    let answers = lines(&options(folder.path(), false), input.concat().as_bytes());
    let ids: Vec<_> = answers
        .iter()
        .map(|answer| answer["id"].as_u64().unwrap())
        .collect();
    assert_eq!(ids, [0, 3]);
}

#[test]
fn prompts_are_filled_in() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let answers = session(
        &options,
        &[
            ("prompts/list", json!({})),
            (
                "prompts/get",
                json!({ "name": "prove-interlock", "arguments": { "path": "a.il", "interlock": "both contactors" } }),
            ),
            (
                "prompts/get",
                json!({ "name": "prove-interlock", "arguments": { "path": "a.il" } }),
            ),
        ],
    );
    assert_eq!(answers[0]["result"]["prompts"].as_array().unwrap().len(), 5);
    let text = answers[1]["result"]["messages"][0]["content"]["text"]
        .as_str()
        .unwrap();
    assert!(
        text.starts_with("Prove for `a.il`: both contactors"),
        "{text}"
    );
    assert_eq!(answers[2]["error"]["code"], json!(-32602));
}
