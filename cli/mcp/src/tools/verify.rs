//! `verify`: what a program never does.

use super::{Answer, Call, PROGRAM, Tool, list, object, string};
use crate::arguments::{Kind, Parameter};
use rungc::prove::{Answers, Question};
use serde_json::{Value, json};
use std::time::Duration;

const PARAMETERS: &[Parameter] = &[
    Parameter::optional(
        "never",
        Kind::Texts,
        "conditions that must never hold after a scan, such as [\"Y000 & Y001\", \"Y000 & !X003\", \"D0 > \
        100\"]; comments of devices are written in quotes",
    ),
    Parameter::optional(
        "always",
        Kind::Texts,
        "conditions that must hold after every scan, such as [\"!Y000 | X003\"]",
    ),
    Parameter::optional(
        "reachable",
        Kind::Texts,
        "conditions that some run must reach, such as [\"Y000\"]",
    ),
    Parameter::optional(
        "properties",
        Kind::Texts,
        "properties in words: [\"whenever X000 then Y000 within 2s\", \"stays Y001 after X000 until X001\"]",
    ),
    Parameter::optional(
        "assume",
        Kind::Texts,
        "conditions that hold after every scan, such as [\"!(X001 & X002)\"]",
    ),
    Parameter::optional(
        "free",
        Kind::Texts,
        "devices that something outside writes although the program does, such as a panel: [\"M500\", \
        \"D100..D109\"]",
    ),
    Parameter::optional(
        "scan_ms",
        Kind::Whole(1, 32_767),
        "the longest time from one scan to the next; default: 200",
    ),
    Parameter::optional(
        "cleared",
        Kind::Flag,
        "latched devices start at 0, as on a new PLC, instead of at any value",
    ),
    Parameter::optional(
        "timeout_ms",
        Kind::Whole(1, 600_000),
        "time limit for each property; default: 60000",
    ),
];

pub(super) const TOOL: Tool = Tool {
    name: "verify",
    title: "Prove properties",
    text: "Decides whether a program can ever do something, in any run from power-on with any inputs: proved, \
    violated (with the shortest run found), or not decided. Without properties, those of rungc.toml. A proof \
    is about the program under the listed assumptions: repeat them to the user. rungc://book/prove describes \
    conditions.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    object(&[
        ("file", string()),
        (
            "results",
            list(object(&[
                ("property", string()),
                ("verdict", string()),
                ("details", string()),
            ])),
        ),
        ("assumptions", list(string())),
        ("warnings", list(string())),
    ])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    const USUAL_MS: u64 = 60_000;
    let project = call.whole()?;
    super::compiled(&project)?;
    let arguments = call.arguments;
    let mut properties = Vec::new();
    for name in ["never", "always", "reachable"] {
        let conditions = arguments.texts(name).into_iter();
        properties.extend(conditions.map(|condition| format!("{name} {condition}")));
    }
    properties.extend(arguments.texts("properties"));
    let question = Question {
        properties,
        assume: arguments.texts("assume"),
        free: arguments.texts("free"),
        scan: arguments.whole("scan_ms").map(Duration::from_millis),
        cleared: arguments.flag("cleared"),
        effort: None,
        time: Some(Duration::from_millis(
            arguments.whole("timeout_ms").unwrap_or(USUAL_MS),
        )),
    };
    let goes = &mut || !call.is_cancelled();
    let answers = project.prove_while(&question, goes);
    let answers = answers.map_err(|error| error.to_string())?;
    match call.is_cancelled() {
        true => Err("the call was cancelled".to_owned()),
        false => Ok(answer(&call.name(&project), &answers)),
    }
}

fn answer(file: &str, answers: &Answers) -> Answer {
    let mut text = String::new();
    let mut results = Vec::new();
    for one in &answers.answers {
        let (property, verdict, details) = (&one.property, one.word, &one.grounds);
        text.push_str(&format!("{verdict:<11} {property}\n{details}"));
        results.push(json!({ "property": property, "verdict": verdict, "details": details }));
    }
    for warning in &answers.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text.push_str("Decided for this model under these assumptions:\n");
    for line in &answers.assumptions {
        text.push_str(&format!("  - {line}\n"));
    }
    let (supposed, undriven) = (&answers.assumptions, &answers.warnings);
    let data =
        json!({ "file": file, "results": results, "assumptions": supposed, "warnings": undriven });
    Answer { text, data }
}
