//! `test`: the cases of a test file.

use super::{Answer, Call, OFFSET, Tool, boolean, integer, list, object, paged, string};
use crate::arguments::{Kind, Parameter};
use crate::page::{self, ENTRIES};
use rungc_sim::engines::{EngineKind, prepare};
use rungc_sim::plctest::{self, Suite, TestFile};
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::Path;

const PARAMETERS: &[Parameter] = &[
    Parameter::optional(
        "path",
        Kind::Text,
        "the test file, such as `press.plctest.toml`",
    ),
    Parameter::optional(
        "text",
        Kind::Text,
        "instead of `path`: the text of a test file; programs and machines that it names are searched for \
        from the first folder",
    ),
    Parameter::optional(
        "filter",
        Kind::Text,
        "run only cases whose name contains this text",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "test",
    title: "Run test cases",
    text: "Runs the cases of a PLC test file (rungc://book/test-files describes the format) on the reference \
    interpreter and says which fail, with expected and actual values. `text` runs cases that are not in a \
    file.",
    parameters: &[PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    let case = object(&[
        ("name", string()),
        ("file", string()),
        ("line", integer()),
        ("passed", boolean()),
        ("failure?", string()),
    ]);
    let mut all = vec![
        ("passed", integer()),
        ("failed", integer()),
        ("cases", list(case)),
    ];
    all.extend(paged());
    object(&all)
}

fn load(call: &Call) -> Result<TestFile, String> {
    let loaded = match (call.arguments.text("path"), call.arguments.text("text")) {
        (Some(path), None) => plctest::load(&call.files.find(path)?),
        (None, Some(text)) => {
            let name = call.files.future("text.plctest.toml")?;
            plctest::parse(&name.to_string_lossy(), text)
        }
        _ => return Err("name the cases: `path` of a test file, or `text` of one".to_owned()),
    };
    loaded.map_err(|error| {
        format!("the test file has mistakes (rungc://book/test-files describes it):\n{error}")
    })
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let mut file = load(call)?;
    if let Some(filter) = call.arguments.text("filter") {
        file.cases.retain(|case| case.name.contains(filter));
    }
    if file.cases.is_empty() {
        return Err("no case has such a name".to_owned());
    }
    let suite = Suite::compile(vec![file], &[]);
    let ready = prepare(EngineKind::Interp, suite.modules(), Path::new(""));
    let ready = ready.map_err(|error| error.to_string())?;
    let mut engine = ready.start();
    let report = plctest::run(
        &suite,
        engine.as_mut(),
        &mut |_| match call.is_cancelled() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        },
    );
    let (passed, failed) = (report.passed(), report.failures().count());
    // Failures first: they are what the call is about.
    let mut outcomes: Vec<_> = report.outcomes.iter().collect();
    outcomes.sort_by_key(|outcome| outcome.failure.is_none());
    let (part, total, next) = page::entries(outcomes, call.offset(), ENTRIES);
    let cases = part.iter().map(|outcome| {
        let file = &suite.files()[outcome.id.file];
        let case = &file.cases[outcome.id.case];
        let mut value = json!({
            "name": case.name,
            "file": call.files.shown(Path::new(&file.name)),
            "line": case.line,
            "passed": outcome.failure.is_none(),
        });
        if let Some(failure) = &outcome.failure {
            value["failure"] = json!(failure.to_string().trim_end_matches(';'));
        }
        value
    });
    let mut data = json!({
        "passed": passed,
        "failed": failed,
        "cases": cases.collect::<Vec<_>>(),
        "total": total,
        "offset": call.offset(),
    });
    if let Some(next) = next {
        data["next_offset"] = json!(next);
    }
    let mut text = format!("{passed} passed, {failed} failed\n");
    for outcome in part {
        text.push_str(&outcome.describe(&suite));
        text.push('\n');
    }
    text.push_str(&page::remark(next, total, "cases"));
    Ok(Answer { text, data })
}
