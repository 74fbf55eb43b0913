//! `why`: why a device is on or off.

use super::run::{INPUTS, until};
use super::{Answer, Call, OFFSET, PROGRAM, Tool, anything, string, text_answer, text_output};
use crate::arguments::{Kind, Parameter};
use serde_json::{Value, json};

/// Most bytes of the answer as an object.
const BYTES: usize = 20_000;

const PARAMETERS: &[Parameter] = &[
    Parameter::required(
        "device",
        Kind::Text,
        "the device or its comment, such as `Y000` or `motor`",
    ),
    INPUTS,
    Parameter::optional(
        "at_ms",
        Kind::Whole(1, 3_600_000),
        "the moment of a run with these inputs, in milliseconds after power-on; without it and `inputs`: of \
        the program as a whole",
    ),
    Parameter::optional(
        "how",
        Kind::Flag,
        "also search for what a person can do so that the device changes",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "why",
    title: "Why a device is on or off",
    text: "Explains what can switch a device; or, at a moment of a run (`inputs`, `at_ms`), why it is on or \
    off: the smallest sets of contacts that keep it so, back to inputs, timers, counters and states. With \
    `how`, what to do so that it changes. Call it when a machine stands still.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    text_output(&[
        ("file", string()),
        ("device", string()),
        ("answer?", anything()),
    ])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    let program = super::compiled(&project)?;
    let name = call.arguments.text("device").unwrap_or_default();
    let inputs = call.arguments.inputs("inputs");
    let at_ms = call.arguments.whole("at_ms");
    let how = call.arguments.flag("how");
    let failed = |error: rungc::Error| format!("`device`: {error}");
    let why = match (at_ms, inputs.last()) {
        (None, None) if !how => program.why(name).map_err(failed)?,
        (at_ms, last) => {
            let settled = last.map_or(0, |last| last.at_ms) + 1_000;
            let mut plc = program.start();
            until(call, &mut plc, &inputs, at_ms.unwrap_or(settled), |_, _| {
                Ok(())
            })?;
            let mut why = plc.why(name).map_err(failed)?;
            if how {
                why.how = Some(plc.how(name).map_err(failed)?);
            }
            why
        }
    };
    let mut data = json!({ "file": call.name(&project), "device": why.device.to_string() });
    let whole = serde_json::to_value(&why).unwrap_or_default();
    if whole.to_string().len() <= BYTES {
        data["answer"] = whole;
    }
    Ok(text_answer(call, &why.text(), data))
}
