//! Messages that are none, and arguments that are wrong: errors of the protocol, and nothing worse.

use crate::client::Client;
use rungc_dap::Ended;
use serde_json::{Value, json};

#[test]
fn requests_before_their_time_are_errors() {
    let mut client = Client::new();
    for command in ["launch", "threads", "attach", "disassemble", ""] {
        assert_eq!(client.request(command, json!({}))["success"], false);
    }
    let wrong = client.request("initialize", json!({ "pathFormat": "uri" }));
    assert_eq!(wrong["success"], false);
    client.request("initialize", json!({}));
    let folder = client.program().with_file_name("");
    for arguments in [
        json!({}),
        json!({ "program": "" }),
        json!({ "program": 5 }),
        json!({ "program": "nowhere.il" }),
        json!({ "program": client.program(), "model": "fx9" }),
        json!({ "program": client.program(), "scan": 0 }),
        json!({ "program": client.program(), "scan": 1e30 }),
        json!({ "program": client.program(), "stopOnEntry": "yes" }),
        json!({ "program": client.program(), "inputs": ["X0"] }),
        json!({ "program": client.program(), "inputs": { "Q0": 1 } }),
        json!({ "program": client.program(), "inputs": { "X0": "on" } }),
        json!({ "program": client.program(), "inputs": { "D0": 1e300 } }),
    ] {
        let answer = client.request("launch", arguments.clone());
        assert_eq!(answer["success"], false, "{arguments}");
        assert!(!answer["message"].as_str().unwrap().is_empty());
    }
    // A folder with one program.
    assert_eq!(
        client.request("launch", json!({ "program": folder }))["success"],
        true
    );
    assert_eq!(
        client.request("launch", json!({ "program": folder }))["success"],
        false
    );
    assert_eq!(client.end(), Ended::Abandoned);
}

/// Requests with arguments that are wrong, in a program that stands before its first scan.
const WRONG: &str = r#"
configurationDone {}
next {"threadId": 2}
continue {}
stackTrace {"threadId": 9223372036854775807}
stackTrace {"threadId": "1"}
variables {"variablesReference": 9223372036854775807}
variables {"variablesReference": -9223372036854775807}
variables {"variablesReference": 0}
variables {"variablesReference": 1e99}
setVariable {"variablesReference": 1, "name": "X000", "value": "many"}
setVariable {"variablesReference": 99, "name": "X000", "value": "1"}
setVariable {"variablesReference": 1, "name": "", "value": "1"}
setExpression {"expression": "D0", "value": "70000"}
setExpression {"expression": "M8000", "value": "0"}
evaluate {"expression": ""}
evaluate {"expression": "X999"}
evaluate {"expression": "force", "context": "repl"}
evaluate {"expression": "force X0", "context": "repl"}
evaluate {"expression": "release D0", "context": "repl"}
evaluate {"expression": "why Q", "context": "repl"}
evaluate {"expression": "D0 = X", "context": "repl"}
source {}
setBreakpoints {"source": {}}
setBreakpoints {"source": {"path": "a", "sourceReference": 9223372036854775807}}
setBreakpoints {"source": {"path": "a"}, "breakpoints": [{"line": "x"}]}
breakpointLocations {"source": {"path": "a"}, "line": 1}
setDataBreakpoints {}
setExceptionBreakpoints {"filters": ["all"]}
exceptionInfo {}
disassemble {}
gotoTargets {}
"#;

#[test]
fn wrong_arguments_are_errors() {
    let mut client = Client::launched(&json!({ "stopOnEntry": true }));
    assert_eq!(
        client.request("next", json!({ "threadId": 1 }))["success"],
        false
    );
    client.request("configurationDone", json!({}));
    client.event("stopped");
    for line in WRONG.trim().lines() {
        let (command, arguments) = line.split_once(' ').unwrap();
        let answer = client.request(command, serde_json::from_str(arguments).unwrap());
        assert_eq!(answer["success"], false, "{line}: {answer}");
    }
}

/// Lines and counts at the ends of what a number can be.
#[test]
fn huge_numbers_are_only_numbers() {
    let mut client = Client::launched(&json!({ "stopOnEntry": true }));
    client.request("configurationDone", json!({}));
    client.event("stopped");
    let huge = i64::MAX;
    let program = client.program();
    for line in [0, -1, huge, -huge] {
        client.break_at(json!([{ "line": line }]));
        let source = json!({ "path": program });
        client.request(
            "breakpointLocations",
            json!({ "source": source, "line": line, "endLine": huge }),
        );
    }
    let many: Vec<Value> = (0..5_000).map(|line| json!({ "line": line })).collect();
    let source = json!({ "path": program });
    let answer = client.request(
        "setBreakpoints",
        json!({ "source": source, "breakpoints": many }),
    );
    assert_eq!(answer["success"], false);
    client.request(
        "variables",
        json!({ "variablesReference": 1, "start": huge, "count": -5 }),
    );
    assert_eq!(client.go("next").0, "step");
}

#[test]
fn messages_that_are_none_are_reported() {
    let mut client = Client::launched(&json!({ "stopOnEntry": true }));
    client.write(b"Content-Length: 5\r\n\r\n{\"a\":");
    client.write(b"Content-Length: x\r\n\r\n");
    client.send(&json!([]));
    client.send(&json!({ "type": "response", "seq": 1 }));
    client.send(&json!({ "type": "request", "seq": 1, "command": "threads", "arguments": [] }));
    let answer = client.request("threads", json!({}));
    assert_eq!(answer["success"], true);
    assert_eq!(
        client.transcript.matches("event output").count(),
        5,
        "{}",
        client.transcript
    );
    client.write(b"Content-Length: 50\r\n\r\n{");
    assert_eq!(client.end(), Ended::Abandoned);
}

/// Requests by chance, with arguments by chance.
#[test]
fn no_request_ends_the_adapter() {
    const COMMANDS: [&str; 20] = [
        "threads",
        "stackTrace",
        "scopes",
        "variables",
        "setVariable",
        "setExpression",
        "evaluate",
        "next",
        "stepOut",
        "stepBack",
        "reverseContinue",
        "setBreakpoints",
        "setDataBreakpoints",
        "dataBreakpointInfo",
        "exceptionInfo",
        "source",
        "configurationDone",
        "setExceptionBreakpoints",
        "initialize",
        "pause",
    ];
    let mut random = fastrand::Rng::with_seed(7);
    let mut client = Client::launched(&json!({ "stopOnEntry": true }));
    client.request("configurationDone", json!({}));
    let program = client.program();
    for _ in 0..600 {
        let command = COMMANDS[random.usize(..COMMANDS.len())];
        let mut texts = [
            "X0",
            "Y000 = 1",
            "force X2 1",
            "D0.f32",
            "K4M0",
            "{",
            "\"",
            "why Y0",
            "é",
            "X0 & (",
            "1",
        ]
        .into_iter();
        let text = texts.nth(random.usize(..11)).unwrap();
        let number = [0, 1, -1, 2, 5, 8, i64::MAX, i64::MIN][random.usize(..8)];
        let context = ["repl", "watch", "hover"][random.usize(..3)];
        let arguments = json!({
            "threadId": 1, "variablesReference": number, "name": text, "value": text, "expression": text,
            "context": context, "source": { "path": program }, "breakpoints": [
                { "line": number, "dataId": text, "condition": if random.bool() { text } else { "" } },
            ],
            "filters": if random.bool() { json!(["plc-errors"]) } else { json!([number]) },
            "start": number, "count": number,
        });
        let answer = client.request(command, arguments);
        assert!(answer["success"].is_boolean());
    }
    client.request("disconnect", json!({}));
    assert_eq!(client.end(), Ended::Disconnected);
}
