//! `open`: what a file is.

use super::{Answer, Call, OFFSET, PROGRAM, Tool, integer, list, object, paged, string};
use crate::page::{self, ENTRIES};
use rungc_analysis::resolve::resolve;
use rungc_analysis::xref::CrossReference;
use rungc_ladder::build;
use rungc_syntax::DeviceClass;
use rungc_syntax::text::one_line;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

pub(super) const TOOL: Tool = Tool {
    name: "open",
    title: "What a program is",
    text: "Says what a program file is: format, PLC model, size, which devices it uses, and the names \
    (comments) of its devices. Call it first. Lists of names are in parts: pass `offset`.",
    parameters: &[PROGRAM, &[OFFSET]],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    let mut all = vec![
        ("file", string()),
        ("format", string()),
        ("model", string()),
        ("model_title", string()),
        ("cpu?", string()),
        ("title?", string()),
        ("settings?", string()),
        ("instructions", integer()),
        ("steps", integer()),
        ("networks", integer()),
        ("errors", integer()),
        ("warnings", integer()),
        (
            "devices",
            json!({ "type": "object", "additionalProperties": { "type": "integer" } }),
        ),
        (
            "names",
            list(object(&[("device", string()), ("name", string())])),
        ),
    ];
    all.extend(paged());
    object(&all)
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.project()?;
    let program = project.source();
    let checked = project.check();
    let count = |name: &str| {
        let all = checked.diagnostics.iter();
        all.filter(|found| found.severity.name() == name).count()
    };
    let names = program.comments.iter();
    let names: Vec<Value> = names
        .map(|(device, name)| json!({ "device": device.to_string(), "name": one_line(name) }))
        .collect();
    let (part, total, next) = page::entries(names, call.offset(), 4 * ENTRIES);
    let (resolved, _) = resolve(program, project.model());
    let mut data = json!({
        "file": call.name(&project),
        "format": program.kind.title(),
        "model": checked.model.name,
        "model_title": checked.model.title,
        "instructions": program.instrs.len(),
        "steps": checked.steps,
        "networks": build::ladder(&resolved).networks.len(),
        "errors": count("error"),
        "warnings": count("warning"),
        "devices": used(&CrossReference::new(&resolved)),
        "names": part,
        "total": total,
        "offset": call.offset(),
    });
    let mut add = |name: &str, value: Option<String>| {
        if let Some(value) = value {
            data[name] = json!(value);
        }
    };
    add("cpu", program.cpu.as_ref().map(ToString::to_string));
    add("title", program.title.as_ref().map(ToString::to_string));
    add(
        "settings",
        project
            .settings()
            .map(|settings| call.files.shown(&settings.path)),
    );
    if let Some(next) = next {
        data["next_offset"] = json!(next);
    }
    Ok(Answer {
        text: text(&data, next, total),
        data,
    })
}

/// Number of devices of each class that the program names.
fn used(xref: &CrossReference) -> Value {
    let mut used: BTreeMap<DeviceClass, u32> = BTreeMap::new();
    for row in &xref.rows {
        *used.entry(row.first.class).or_default() += row.last.number - row.first.number + 1;
    }
    let used = used.into_iter();
    Value::Object(
        used.map(|(class, count)| (class.prefix().to_owned(), json!(count)))
            .collect(),
    )
}

fn text(data: &Value, next: Option<usize>, total: usize) -> String {
    let mut out = String::new();
    let plain = |value: &Value| {
        value
            .as_str()
            .map_or_else(|| value.to_string(), str::to_owned)
    };
    for name in [
        "file",
        "format",
        "title",
        "cpu",
        "model_title",
        "settings",
        "instructions",
        "steps",
        "networks",
    ] {
        if let Some(value) = data.get(name) {
            let _ = writeln!(out, "{}: {}", name.replace('_', " "), plain(value));
        }
    }
    let _ = writeln!(
        out,
        "findings: {} errors, {} warnings (`check` lists them)",
        data["errors"], data["warnings"]
    );
    let devices = data["devices"].as_object().into_iter().flatten();
    let devices: Vec<String> = devices
        .map(|(class, count)| format!("{class} {count}"))
        .collect();
    let _ = writeln!(out, "devices: {}", devices.join(", "));
    let _ = writeln!(out, "names: {total}");
    for name in data["names"].as_array().into_iter().flatten() {
        let _ = writeln!(
            out,
            "  {} = {}",
            plain(&name["device"]),
            plain(&name["name"])
        );
    }
    out + &page::remark(next, total, "names")
}
