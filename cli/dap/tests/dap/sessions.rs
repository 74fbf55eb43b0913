//! Sessions of an editor.

use crate::client::{Client, PROGRAM};
use rungc_dap::Ended;
use serde_json::{Value, json};
use std::fs;

/// Line of the program, from 1.
fn line(text: &str) -> u64 {
    1 + PROGRAM.lines().position(|line| line == text).unwrap() as u64
}

fn ids(value: &Value) -> Vec<i64> {
    let all = value.as_array().unwrap().iter();
    all.map(|point| point["id"].as_i64().unwrap()).collect()
}

#[test]
fn a_session_from_its_beginning_to_its_end() {
    let mut client = Client::new();
    client.request(
        "initialize",
        json!({ "adapterID": "rungc", "supportsInvalidatedEvent": true }),
    );
    let program = client.program();
    client.request(
        "launch",
        json!({ "program": program, "stopOnEntry": true, "realTime": false, "speed": 1 }),
    );
    client.event("initialized");
    client.break_at(json!([{ "line": line("OUT Y001") }, { "line": 99 }]));
    client.request(
        "setExceptionBreakpoints",
        json!({ "filters": ["plc-errors"] }),
    );
    client.request("configurationDone", json!({}));
    client.event("stopped");
    client.request("threads", json!({}));
    client.request("stackTrace", json!({ "threadId": 1 }));
    client.request("scopes", json!({ "frameId": 1 }));
    client.request("variables", json!({ "variablesReference": 1 }));
    client.request("variables", json!({ "variablesReference": 5 }));
    client.go("next");
    client.request(
        "setVariable",
        json!({ "variablesReference": 1, "name": "X000 Start", "value": "on" }),
    );
    client.request("stepBack", json!({ "threadId": 1 }));
    client.event("stopped");
    client.evaluate("X000 = on", "repl");
    client.go("next");
    client.go("stepOut");
    client.evaluate("why Y000", "repl");
    client.request("terminate", json!({}));
    client.event("terminated");
    client.request("next", json!({ "threadId": 1 }));
    client.request("disconnect", json!({}));
    insta::assert_snapshot!(client.transcript);
    assert_eq!(client.end(), Ended::Disconnected);
}

#[test]
fn breakpoints_stop_at_instructions() {
    let mut client = Client::launched(&json!({ "inputs": { "Start": true } }));
    let set = client.break_at(json!([
        { "line": line("OUT Y001"), "condition": "Y001 = T0 & T0" },
        { "line": line("OUT Y001"), "condition": "T0 & !Y001" },
        { "line": line("INC D5"), "hitCondition": "= 10" },
        { "line": line("LD T0"), "logMessage": "T0 = {T0}, { D5 } scans" },
        { "line": 1, "condition": "rises(X000)" },
        { "line": 1, "condition": "X000 &" },
        { "line": 1, "hitCondition": "often" },
        { "line": 1, "logMessage": "{Q}" },
    ]));
    let verified: Vec<_> = set
        .as_array()
        .unwrap()
        .iter()
        .map(|point| point["verified"] == true)
        .collect();
    assert_eq!(
        &verified[1..],
        [true, true, true, false, false, false, false]
    );
    client.request("configurationDone", json!({}));
    let stopped = client.event("stopped");
    assert_eq!(stopped["reason"], "breakpoint");
    assert_eq!(
        stopped["hitBreakpointIds"],
        json!([ids(&set)[2]]),
        "{}",
        client.transcript
    );
    // The tenth execution: the instruction is not executed yet.
    assert_eq!(client.frame()["line"], line("INC D5"));
    assert_eq!(client.value("D5"), "9");
    let (reason, frame) = client.go("continue");
    assert_eq!(
        (reason.as_str(), &frame["line"]),
        ("breakpoint", &json!(line("OUT Y001")))
    );
    assert!(
        client.value("T0").starts_with("5, contact on"),
        "{}",
        client.transcript
    );
    let at_hit = client.value("D5");
    assert!(
        client
            .transcript
            .contains(&format!("T0 = 5, {at_hit} scans")),
        "{}",
        client.transcript
    );
    client.request("disconnect", json!({}));
    assert_eq!(client.end(), Ended::Disconnected);
}

#[test]
fn changes_of_devices_stop_and_time_goes_back() {
    let mut client = Client::launched(&json!({ "stopOnEntry": true, "scan": 20 }));
    client.request("configurationDone", json!({}));
    client.event("stopped");
    let info = client.request("dataBreakpointInfo", json!({ "name": "Motor" }));
    assert_eq!(info["body"]["dataId"], "Motor");
    let info = client.request(
        "dataBreakpointInfo",
        json!({ "variablesReference": 2, "name": "Y000 Motor" }),
    );
    assert_eq!(info["body"]["dataId"], "Y000");
    let points = json!([{ "dataId": "Y000", "accessType": "write" }, { "dataId": "Q7" }]);
    let set = client.request("setDataBreakpoints", json!({ "breakpoints": points }));
    assert_eq!(set["body"]["breakpoints"][1]["verified"], false);
    client.evaluate("X0 = 1", "repl");
    // Stops at what follows the instruction that changes it.
    let (reason, frame) = client.go("continue");
    assert_eq!(
        (reason.as_str(), &frame["line"]),
        ("data breakpoint", &json!(line("LD T0")))
    );
    assert!(client.transcript.contains("Y000 has changed from 0 to 1"));
    assert_eq!(
        (client.value("Y000").as_str(), client.value("D5").as_str()),
        ("on", "0")
    );
    client.go("stepBack");
    assert_eq!(client.value("Y000"), "off");
    for _ in 0..3 {
        client.go("stepOut");
    }
    assert_eq!(
        (client.value("Y000").as_str(), client.value("D5").as_str()),
        ("on", "3")
    );
    // Within a scan a change takes effect at once, and stays when the scan is executed again.
    client.go("next");
    client.evaluate("X001 = on", "repl");
    client.go("next");
    client.go("next");
    assert_eq!(client.value("M0"), "off", "{}", client.transcript);
    let (reason, frame) = client.go("continue");
    assert_eq!(
        (reason.as_str(), &frame["line"]),
        ("data breakpoint", &json!(line("LD T0")))
    );
    assert_eq!(
        (client.value("Y000").as_str(), client.value("D5").as_str()),
        ("off", "3")
    );
    let (reason, _) = client.go("reverseContinue");
    assert_eq!(reason, "data breakpoint", "{}", client.transcript);
    assert_eq!(
        (client.value("Y000").as_str(), client.value("D5").as_str()),
        ("on", "0")
    );
    // And forwards again: the change is where it was made.
    client.go("continue");
    assert_eq!(
        (client.value("X001").as_str(), client.value("D5").as_str()),
        ("on", "3")
    );
    client.go("reverseContinue");
    let (reason, _) = client.go("reverseContinue");
    assert_eq!(reason, "entry", "{}", client.transcript);
    assert_eq!(client.value("D5"), "0");
    let (reason, _) = client.go("stepBack");
    assert_eq!(reason, "entry");
}

#[test]
fn errors_of_the_plc_stop() {
    let mut client = Client::launched(&json!({}));
    client.request(
        "setExceptionBreakpoints",
        json!({ "filters": ["plc-errors"] }),
    );
    client.request("configurationDone", json!({}));
    // While it runs.
    assert_eq!(client.evaluate("force X002 on", "repl"), "X002 is forced");
    let stopped = client.event("stopped");
    assert_eq!(stopped["reason"], "exception", "{stopped}");
    let frame = client.frame();
    assert_eq!(frame["line"], line("DIV D0 D1 D2"));
    let info = client.request("exceptionInfo", json!({ "threadId": 1 }));
    assert_eq!(info["body"]["exceptionId"], "6706", "{info}");
    assert!(client.value("X002").contains("forced"));
    assert!(client.evaluate("release X002", "repl").contains("released"));
    client.evaluate("D1 = 5", "repl");
    client.request("continue", json!({ "threadId": 1 }));
    client.request("pause", json!({ "threadId": 1 }));
    assert_eq!(
        client.event("stopped")["reason"],
        "pause",
        "{}",
        client.transcript
    );
    assert!(client.request("exceptionInfo", json!({}))["success"] == false);
}

#[test]
fn a_restart_reads_the_program_again() {
    let mut client = Client::launched(&json!({ "inputs": { "X000": 1 } }));
    client.break_at(json!([{ "line": line("OUT Y000") }]));
    client.request("configurationDone", json!({}));
    client.event("stopped");
    fs::write(client.program(), "LD X000\nOUT\n").unwrap();
    let answer = client.request("restart", json!({}));
    assert_eq!(answer["success"], false, "{answer}");
    fs::write(client.program(), format!(";! Y001 = Lamp\n{PROGRAM}")).unwrap();
    assert_eq!(client.request("restart", json!({}))["success"], true);
    let moved = client.event("breakpoint");
    assert_eq!(moved["breakpoint"]["line"], line("OUT Y000"));
    client.event("stopped");
    // The line is that of the editor; on it is another instruction now.
    assert!(
        client.frame()["name"]
            .as_str()
            .unwrap()
            .starts_with("OUT T0 K5")
    );
}

#[test]
fn lines_are_counted_as_the_editor_counts_them() {
    let mut client = Client::new();
    client.request("initialize", json!({ "linesStartAt1": false }));
    let program = client.program();
    client.request("launch", json!({ "program": program, "stopOnEntry": true }));
    client.event("initialized");
    let set = client.break_at(json!([{ "line": line("OUT M0") - 1 }]));
    assert_eq!(set[0]["line"], line("OUT M0") - 1);
    client.request("configurationDone", json!({}));
    client.event("stopped");
    assert_eq!(client.frame()["line"], line("LD X000") - 1);
    let source = client.request("source", json!({ "sourceReference": 1 }));
    assert_eq!(source["success"], false);
}
