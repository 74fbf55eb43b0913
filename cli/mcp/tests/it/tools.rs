//! Each tool, on small programs.

use crate::{REVERSER, call, folder, options, session};
use serde_json::json;
use std::fs;

const TESTS: &str = "\
model = \"fx3u\"
topic = \"reverser\"
program = \"a.il\"

[[case]]
name = \"forward\"
[[case.step]]
set = { X000 = 1 }
expect = { Y000 = 1 }

[[case]]
name = \"wrong\"
[[case.step]]
set = { X001 = 1 }
expect = { Y000 = 1 }
";

#[test]
fn open_says_what_a_program_is() {
    let folder = folder(&[("a.il", REVERSER)]);
    let (text, data, failed) = call(
        &options(folder.path(), false),
        "open",
        json!({ "path": "a.il" }),
    );
    assert!(!failed);
    insta::assert_snapshot!(format!("{text}\n{data:#}"));
}

#[test]
fn check_gives_places_and_fixes_also_of_texts() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let list = "LD X0\nOUTT Y0\nLD X9\nMOV D0\nEND\n";
    let (text, data, failed) = call(&options, "check", json!({ "list": list }));
    assert!(!failed);
    insta::assert_snapshot!(text);
    assert_eq!(data["diagnostics"][0]["line"], json!(2));
    assert_eq!(data["errors"], json!(3));
}

/// A line of another language hides no mistakes.
#[test]
fn five_mistakes_are_found_beside_an_if() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let mistakes = "LD X0\nOUTT Y0\nOUT Y9\nMOV D0\nOUT M99999\nSETT M0\n";
    for list in [
        format!("{mistakes}IF X0 THEN\nEND\n"),
        format!("IF X0 THEN\n{mistakes}END\n"),
        format!("LD X0\nIF X0 THEN\n{mistakes}TON T1, 5\nEND_IF;\nEND\n"),
    ] {
        let (text, ..) = call(&options, "check", json!({ "list": list }));
        for part in ["OUTT", "Y9", "MOV", "M99999", "SETT", "IF"] {
            assert!(text.contains(part), "{part}: {list}\n{text}");
        }
    }
}

#[test]
fn long_answers_come_in_parts() {
    let folder = folder(&[]);
    let options = options(folder.path(), false);
    let list: String = (0..120)
        .map(|n| format!("LD X0\nOUTT Y{n:o}\n"))
        .collect::<String>()
        + "END\n";
    let (text, data, _) = call(&options, "check", json!({ "list": list }));
    assert_eq!(
        (&data["total"], &data["next_offset"]),
        (&json!(120), &json!(50))
    );
    assert!(text.contains("call again with \"offset\": 50"), "{text}");
    let (_, data, _) = call(&options, "check", json!({ "list": list, "offset": 100 }));
    assert_eq!(data["diagnostics"].as_array().unwrap().len(), 20);
    assert!(data.get("next_offset").is_none());
    let right = list
        .replace("OUTT", "OUT")
        .replace("LD X0", "LD X0\nAND M1");
    let (_, data, _) = call(&options, "view", json!({ "list": right }));
    let next = data["next_network"].as_u64().unwrap();
    let (_, data, _) = call(&options, "view", json!({ "list": right, "network": next }));
    assert_eq!(data["first"], json!(next));
}

#[test]
fn ladder_is_drawn_whole_or_in_part() {
    let folder = folder(&[("a.il", REVERSER)]);
    let options = options(folder.path(), false);
    let (text, ..) = call(
        &options,
        "view",
        json!({ "path": "a.il", "devices": ["Y001"], "last_network": 1 }),
    );
    insta::assert_snapshot!(text);
    let (why, _, failed) = call(&options, "view", json!({ "path": "a.il", "network": 9 }));
    assert!(failed && why.contains("none of the 3 networks"), "{why}");
}

#[test]
fn xref_and_explain_answer() {
    let folder = folder(&[("a.il", REVERSER)]);
    let options = options(folder.path(), false);
    let (text, data, _) = call(
        &options,
        "xref",
        json!({ "path": "a.il", "devices": ["forward contactor"] }),
    );
    insta::assert_snapshot!(text);
    assert_eq!(data["devices"].as_array().unwrap().len(), 1);
    let (text, ..) = call(
        &options,
        "xref",
        json!({ "path": "a.il", "unused": true, "offset": 0 }),
    );
    assert!(text.contains("Unused"), "{text}");
    for (topic, part) in [
        ("MOV", "MOV"),
        ("W0203", "double-coil"),
        ("M8013", "M8013"),
        ("test-files", "Test files"),
        ("two-hand", "two-hand"),
    ] {
        let (text, _, failed) = call(&options, "explain", json!({ "topic": topic }));
        assert!(!failed && text.contains(part), "{topic}: {text}");
    }
    let (why, _, failed) = call(&options, "explain", json!({ "topic": "MOVV" }));
    assert!(failed && why.contains("did you mean `MOV`"), "{why}");
}

#[test]
fn a_run_is_a_trace() {
    let folder = folder(&[]);
    let list =
        ";! X000 = start\nLD X000\nOUT T0 K3\nLD T0\nOUT Y000\nLD M8000\nDIV D0 D1 D2\nEND\n";
    let arguments = json!({
        "list": list,
        "inputs": [{ "at_ms": 500, "set": { "X000": false } }, { "at_ms": 100, "set": { "start": true } }],
        "watch": ["X000", "T0", "Y000"],
        "for_ms": 700,
    });
    let options = options(folder.path(), false);
    let (text, data, failed) = call(&options, "run", arguments.clone());
    assert!(!failed, "{text}");
    insta::assert_snapshot!(text);
    assert_eq!(
        call(&options, "run", arguments).1,
        data,
        "the same call gives the same run"
    );
    let (text, ..) = call(
        &options,
        "run",
        json!({ "list": list, "inputs": [{ "set": { "X000": true } }] }),
    );
    assert!(text.lines().next().unwrap().contains("Y000"), "{text}");
    for wrong in [
        json!({ "list": list, "inputs": [{ "set": { "Q0": true } }] }),
        json!({ "list": list, "watch": ["X999"] }),
        json!({ "list": list, "inputs": [{ "at_ms": 9000, "set": { "X0": true } }] }),
        json!({ "list": "LD X0\nOUTT Y0\nEND\n" }),
        json!({}),
    ] {
        let (why, _, failed) = call(&options, "run", wrong.clone());
        assert!(failed && !why.is_empty(), "{wrong}");
    }
}

#[test]
fn why_explains_a_program_and_a_moment() {
    let folder = folder(&[("a.il", REVERSER)]);
    let options = options(folder.path(), false);
    let (text, data, _) = call(
        &options,
        "why",
        json!({ "path": "a.il", "device": "forward contactor" }),
    );
    assert!(text.contains("is written by one instruction"), "{text}");
    assert_eq!(data["device"], json!("Y000"));
    let inputs = json!([{ "set": { "X000": true, "X002": true } }]);
    let (text, ..) = call(
        &options,
        "why",
        json!({ "path": "a.il", "device": "Y000", "inputs": inputs, "how": true }),
    );
    insta::assert_snapshot!(text);
}

#[test]
fn test_cases_run_from_files_and_texts() {
    let folder = folder(&[("a.il", REVERSER), ("a.plctest.toml", TESTS)]);
    let options = options(folder.path(), false);
    let (text, data, _) = call(&options, "test", json!({ "path": "a.plctest.toml" }));
    assert_eq!(
        (&data["passed"], &data["failed"]),
        (&json!(1), &json!(1)),
        "{text}"
    );
    assert_eq!(
        data["cases"][0]["name"],
        json!("wrong"),
        "failures are first"
    );
    assert!(text.contains("Y000 is 0, expected 1"), "{text}");
    let (_, data, _) = call(
        &options,
        "test",
        json!({ "text": TESTS, "filter": "forward" }),
    );
    assert_eq!((&data["passed"], &data["failed"]), (&json!(1), &json!(0)));
    let (why, _, failed) = call(&options, "test", json!({ "text": "model = 5" }));
    assert!(failed && why.contains("mistakes"), "{why}");
}

#[test]
fn verdicts_come_with_assumptions() {
    let right = REVERSER.replace("ANI X002\nOUT Y001", "ANI X002\nANI Y000\nOUT Y001");
    let settings = "[project]\nprogram = \"b.il\"\n[[property]]\nname = \"interlock\"\nnever = \"Y000 & Y001\"\n";
    let folder = folder(&[
        ("a.il", REVERSER),
        ("b.il", &right),
        ("rungc.toml", settings),
    ]);
    let options = options(folder.path(), false);
    let (text, data, _) = call(
        &options,
        "verify",
        json!({ "path": "a.il", "never": ["Y000 & Y001"] }),
    );
    assert_eq!(data["results"][0]["verdict"], json!("violated"));
    insta::assert_snapshot!(text);
    let (text, data, _) = call(&options, "verify", json!({ "path": "b.il" }));
    assert_eq!(data["results"][0]["verdict"], json!("proved"), "{text}");
    assert!(data["assumptions"].as_array().unwrap().len() > 3);
    let (why, _, failed) = call(
        &options,
        "verify",
        json!({ "path": "a.il", "never": ["Y000 & "] }),
    );
    assert!(failed && why.contains('^'), "{why}");
    let (why, _, failed) = call(&options, "verify", json!({ "path": "a.il" }));
    assert!(failed && why.contains("no property"), "{why}");
    let assumed = json!({ "path": "a.il", "never": ["Y000 & Y001"], "assume": ["!(X000 & X001)"] });
    let (_, data, _) = call(&options, "verify", assumed);
    assert_ne!(data["results"][0]["verdict"], json!("vacuous"));
}

#[test]
fn programs_are_compared_and_converted() {
    let right = REVERSER.replace("ANI X002\nOUT Y001", "ANI X002\nANI Y000\nOUT Y001");
    let folder = folder(&[("a.il", REVERSER), ("b.il", &right)]);
    let options = options(folder.path(), false);
    let (text, data, _) = call(
        &options,
        "diff",
        json!({ "old": "a.il", "new": "b.il", "semantic": true }),
    );
    insta::assert_snapshot!(text);
    assert_eq!(data["differs"], json!(true));
    let (_, data, _) = call(&options, "diff", json!({ "old": "a.il", "new": "a.il" }));
    assert_eq!(data["differs"], json!(false));
    for (form, part) in [("il", "LD X000"), ("ladder", "──"), ("plcopen", "<?xml")] {
        let (text, _, failed) = call(&options, "convert", json!({ "path": "a.il", "to": form }));
        assert!(!failed && text.contains(part), "{form}: {text}");
        if form != "plcopen" {
            let (text, data, _) = call(&options, "check", json!({ "list": text }));
            assert_eq!(
                (&data["errors"], &data["steps"]),
                (&json!(0), &json!(10)),
                "{text}"
            );
        }
    }
}

#[test]
fn files_are_written_only_where_that_is_allowed() {
    let folder = folder(&[("old.il", REVERSER)]);
    let writing = options(folder.path(), true);
    let write = |path: &str| {
        call(
            &writing,
            "write",
            json!({ "path": path, "text": "LD X000\nOUTT Y000\nEND\n" }),
        )
    };
    let (text, data, failed) = write("new.il");
    assert!(!failed && text.contains("OUTT"), "{text}");
    assert_eq!(data["diagnostics"].as_array().unwrap().len(), 1);
    let (why, _, failed) = write("old.il");
    assert!(failed && why.contains("was there before"), "{why}");
    assert_eq!(
        fs::read_to_string(folder.path().join("old.il")).unwrap(),
        REVERSER
    );
    assert!(write("../evil.il").2 && write("a.sh").2);
    let (why, _, failed) = call(&writing, "check", json!({ "path": "../../etc/passwd" }));
    assert!(failed && why.contains("outside"), "{why}");
}

/// What a description shows as an example is taken as it stands there.
#[test]
fn examples_of_questions_are_questions() {
    let folder = folder(&[("a.il", REVERSER)]);
    let options = options(folder.path(), false);
    let answers = session(&options, &[("tools/list", json!({}))]);
    let tools = answers[0]["result"]["tools"].as_array().unwrap();
    let tool = tools.iter().find(|tool| tool["name"] == "verify").unwrap();
    let parameters = tool["inputSchema"]["properties"].as_object().unwrap();
    let mut tried = 0;
    for (name, parameter) in parameters {
        let text = parameter["description"].as_str().unwrap();
        let Some((from, to)) = text.find('[').zip(text.find(']')) else {
            continue;
        };
        let example: serde_json::Value = serde_json::from_str(&text[from..=to]).unwrap();
        let mut arguments = json!({ "path": "a.il" });
        if matches!(name.as_str(), "assume" | "free") {
            arguments["never"] = json!(["Y000 & Y001"]);
        }
        arguments[name] = example;
        let (why, data, failed) = call(&options, "verify", arguments);
        assert!(
            !failed && data["results"][0]["verdict"].is_string(),
            "{name}: {why}"
        );
        tried += 1;
    }
    assert_eq!(tried, 6);
}
