//! `convert`: a program in another form.

use super::{Answer, Call, OFFSET, PROGRAM, Tool, string, text_answer, text_output};
use crate::arguments::{Kind, Parameter};
use rungc_export::{Body, to_ladder, to_plcopen};
use rungc_frontend::print;
use rungc_syntax::{Diagnostics, Severity};
use serde_json::{Value, json};

const TO: Parameter = Parameter::required(
    "to",
    Kind::Choice(&["il", "ladder", "plcopen"]),
    "il: instruction list; ladder: a list with drawn networks, which can be edited; plcopen: PLCopen XML",
);

pub(super) const TOOL: Tool = Tool {
    name: "convert",
    title: "Convert a program",
    text: "Rewrites a program of any format as an instruction list, drawn ladder or PLCopen XML, as text. \
    Long texts come in parts: pass `offset`. Nothing is written to disk.",
    parameters: &[PROGRAM, &[TO, OFFSET]],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    text_output(&[("file", string()), ("form", string())])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    let program = project.source();
    let errors: Vec<_> = project.check().diagnostics;
    let unread = errors
        .iter()
        .find(|found| found.severity == Severity::Error && !program.is_complete());
    if let Some(unread) = unread {
        return Err(format!(
            "not all of the program can be read, so it is not converted:\n{unread}"
        ));
    }
    let form = call.arguments.text("to").unwrap_or_default();
    let text = match form {
        "plcopen" => {
            let mut found = Diagnostics::new();
            let text = to_plcopen(program, project.model(), Body::Ladder, &mut found);
            if let Some(error) = found.iter().find(|found| found.severity == Severity::Error) {
                return Err(format!(
                    "this program cannot be PLCopen XML: {}",
                    error.message
                ));
            }
            text
        }
        form => {
            if print::broken_text(program).is_some() {
                return Err(
                    "a text in this program has a line break, which a list cannot have".to_owned(),
                );
            }
            match form {
                "ladder" => to_ladder(program, project.model()),
                _ => print::to_il(program),
            }
        }
    };
    let data = json!({ "file": call.name(&project), "form": form });
    Ok(text_answer(call, &text, data))
}
