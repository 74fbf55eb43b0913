//! `write`: a program or a test file, where the user allows it.

use super::{Answer, Call, Tool, anything, boolean, integer, list, object, string};
use crate::arguments::{Kind, Parameter};
use rungc::Project;
use rungc::mistakes::{in_settings, in_test_file};
use serde_json::{Value, json};

const PARAMETERS: &[Parameter] = &[
    Parameter::required(
        "path",
        Kind::Text,
        "the file, in the folder that the user allows: `press.il`, `press.plctest.toml`, \
        `press.machine.toml`, `rungc.toml`",
    ),
    Parameter::required("text", Kind::Text, "all of its text"),
    Parameter::optional(
        "overwrite",
        Kind::Flag,
        "replace a file that you have written in this session",
    ),
];

pub(super) const TOOL: Tool = Tool {
    name: "write",
    title: "Write a program or a test file",
    text: "Writes an instruction list, a test file, a machine description or rungc.toml into the folder that \
    the user allows, and checks it. A file that was there before is never replaced.",
    parameters: &[PARAMETERS],
    output,
    writes: true,
    call,
};

fn output() -> Value {
    object(&[
        ("file", string()),
        ("bytes", integer()),
        ("overwrote", boolean()),
        ("diagnostics", list(anything())),
    ])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    /// Findings that an answer shows.
    const MOST: usize = 20;
    let name = call.arguments.text("path").unwrap_or_default().to_owned();
    let text = call.arguments.text("text").unwrap_or_default().to_owned();
    let overwrite = call.arguments.flag("overwrite");
    let path = call.files.write(&name, &text, overwrite)?;
    let file = call.files.shown(&path);
    let found = match () {
        () if name.ends_with(".il") => {
            let project = Project::open(&path)
                .map_err(|error| format!("`{file}` is written, but: {error}"))?;
            project.check().diagnostics
        }
        () if name.ends_with(".plctest.toml") => in_test_file(&path, &text),
        () if name.ends_with("rungc.toml") => in_settings(&path, &text),
        () => Vec::new(),
    };
    let diagnostics = found
        .iter()
        .take(MOST)
        .map(|found| serde_json::to_value(found).unwrap_or_default());
    let data = json!({
        "file": file,
        "bytes": text.len(),
        "overwrote": overwrite,
        "diagnostics": diagnostics.collect::<Vec<_>>(),
    });
    let mut said = format!(
        "wrote {file}: {} bytes, {} findings\n",
        text.len(),
        found.len()
    );
    for found in found.iter().take(MOST) {
        said.push_str(&format!("{found}\n"));
    }
    Ok(Answer { text: said, data })
}
