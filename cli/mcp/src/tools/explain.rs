//! `explain`: pages about instructions, codes, devices and models.

use super::{Answer, Call, OFFSET, Tool, string, text_answer, text_output};
use crate::arguments::{Kind, Parameter};
use crate::resources;
use serde_json::{Value, json};

const PARAMETERS: &[Parameter] = &[
    Parameter::required(
        "topic",
        Kind::Text,
        "an instruction (MOV, LD>=), a code of a finding (W0203), a special device (M8013), an error code of \
        a PLC (6706), a model (fx3u), a safety function (`functions` lists them), or a page of the book \
        (test-files)",
    ),
    Parameter::optional(
        "model",
        Kind::Text,
        "the PLC that it is explained for, such as `fx3u`; default: all",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "explain",
    title: "Explain an instruction, a code, a device",
    text: "Explains an instruction with its operands, forms and errors, a code of a finding, a special \
    device, a model or a page of the book. Call it before you use an instruction or a special device that you \
    are not certain of.",
    parameters: &[PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    text_output(&[("topic", string())])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let topic = call.arguments.text("topic").unwrap_or_default().trim();
    let model = call
        .arguments
        .text("model")
        .map(resources::plc)
        .transpose()?;
    let of_book = |why: String| {
        let mut pages = call.options.pages.iter();
        let page = pages.find(|page| page.name.eq_ignore_ascii_case(topic));
        page.map(|page| page.text.to_owned()).ok_or(why)
    };
    let text = match topic {
        "guide" => call.options.guide.to_owned(),
        topic => resources::page(topic, model).or_else(of_book)?,
    };
    Ok(text_answer(call, &text, json!({ "topic": topic })))
}
