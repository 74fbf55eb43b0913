//! The server on the wire, as a client sees it: methods, tools, resources, prompts, and input that is not a message.

mod hostile;
mod tools;
mod wire;

use rungc_mcp::{Options, Text, serve};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Two contactors without an interlock.
const REVERSER: &str = ";! X000 = forward button\n;! Y000 = forward contactor\nLD X000\nOR Y000\nANI \
X002\nANI Y001\nOUT Y000\n\
                        LD X001\nOR Y001\nANI X002\nOUT Y001\nEND\n";

/// A folder with files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn options(root: &Path, write: bool) -> Options {
    Options {
        roots: vec![root.to_owned()],
        write: write.then(|| root.to_owned()),
        guide: "# Guide\n",
        pages: vec![Text {
            name: "test-files",
            title: "Test files",
            text: "# Test files\n",
        }],
        examples: vec![Text {
            name: "gate.il",
            title: "Gate",
            text: "LD X000\nOUT Y000\nEND\n",
        }],
    }
}

/// Lines that a server answers to lines.
fn lines(options: &Options, input: &[u8]) -> Vec<Value> {
    let mut output = Vec::new();
    serve(input, &mut output, options).unwrap();
    let output = String::from_utf8(output).unwrap();
    output
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect()
}

/// A request as a line.
fn request(id: u64, method: &str, params: Value) -> String {
    json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }).to_string() + "\n"
}

/// The handshake, as lines.
fn handshake(version: &str) -> String {
    let params = json!({ "protocolVersion": version, "capabilities": {}, "clientInfo": { "name": "t", "version": "1" } });
    request(0, "initialize", params)
        + "{\"jsonrpc\":\"2.0\",\"method\":\"notifications/initialized\"}\n"
}

/// The answers to requests after a handshake.
fn session(options: &Options, requests: &[(&str, Value)]) -> Vec<Value> {
    let mut input = handshake("2025-11-25");
    for (id, (method, params)) in (1..).zip(requests) {
        input += &request(id, method, params.clone());
    }
    let mut answers = lines(options, input.as_bytes());
    // Answers of the reader may come before others.
    answers.sort_by_key(|answer| answer["id"].as_u64());
    assert_eq!(answers.len(), requests.len() + 1);
    answers.split_off(1)
}

/// The answer to a call of a tool: its text, its data, and whether it failed.
fn call(options: &Options, name: &str, arguments: Value) -> (String, Value, bool) {
    let params = json!({ "name": name, "arguments": arguments });
    let answers = session(options, &[("tools/call", params)]);
    let result = &answers[0]["result"];
    let text = result["content"][0]["text"].as_str();
    let text = text.unwrap_or_else(|| panic!("{name}: {}", answers[0]));
    (
        text.to_owned(),
        result["structuredContent"].clone(),
        result["isError"] == json!(true),
    )
}
