//! `check`: what is wrong with a program.

use super::{Answer, Call, OFFSET, PROGRAM, Tool, anything, integer, list, object, paged, string};
use crate::arguments::{Kind, Parameter};
use crate::page::{self, ENTRIES};
use serde_json::{Value, json};

const LEVEL: Parameter = Parameter::optional(
    "level",
    Kind::Choice(&["error", "warning", "note"]),
    "the least severity that is listed; default: note, that is everything",
);

pub(super) const TOOL: Tool = Tool {
    name: "check",
    title: "Check a program",
    text: "Finds all that is wrong with a program: errors, warnings and notes with code, place (line and \
    column, or step), help, and a fix where one is known. Call it after every change. `explain` describes a \
    code. `list` checks a text that is not in a file.",
    parameters: &[PROGRAM, &[LEVEL, OFFSET]],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    let mut all = vec![
        ("file", string()),
        ("model", string()),
        ("steps", integer()),
        ("errors", integer()),
        ("warnings", integer()),
        ("notes", integer()),
        ("diagnostics", list(anything())),
    ];
    all.extend(paged());
    object(&all)
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.project()?;
    let checked = project.check();
    let file = call.name(&project);
    let count = |name: &str| {
        checked
            .diagnostics
            .iter()
            .filter(|found| found.severity.name() == name)
            .count()
    };
    let (errors, warnings, notes) = (count("error"), count("warning"), count("note"));
    let listed: &[&str] = match call.arguments.text("level") {
        Some("error") => &["error"],
        Some("warning") => &["error", "warning"],
        _ => &["error", "warning", "note"],
    };
    let mut found = checked.diagnostics;
    found.retain(|found| listed.contains(&found.severity.name()));
    let (part, total, next) = page::entries(found, call.offset(), ENTRIES);
    let diagnostics = part.iter().map(|found| {
        let mut value = serde_json::to_value(found).unwrap_or_default();
        value["file"] = json!(file);
        value
    });
    let mut data = json!({
        "file": file,
        "model": checked.model.name,
        "steps": checked.steps,
        "errors": errors,
        "warnings": warnings,
        "notes": notes,
        "diagnostics": diagnostics.collect::<Vec<_>>(),
        "total": total,
        "offset": call.offset(),
    });
    if let Some(next) = next {
        data["next_offset"] = json!(next);
    }
    let title = checked.model.title;
    let mut text = format!(
        "{file} ({title}, {} steps): {errors} errors, {warnings} warnings, {notes} notes\n",
        checked.steps
    );
    for found in &part {
        text.push_str(&format!("{found}\n"));
    }
    text.push_str(&page::remark(next, total, "findings"));
    Ok(Answer { text, data })
}
