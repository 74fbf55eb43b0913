//! Pages that an assistant can read: the guide, the book, examples, instructions, diagnostics, devices, models.

use crate::{Options, Text};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use rungc::Language;
use rungc_models::{Model, ModelId, Plc};
use rungc_syntax::codes;
use serde_json::{Value, json};

/// Characters of a name that an address holds in another form: `LD>=`.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC
    .remove(b'-')
    .remove(b'_')
    .remove(b'.')
    .remove(b'~');

const GUIDE: &str = "rungc://guide";

/// Kinds of pages by topic: first part of the address, title, description.
const TOPICS: [(&str, &str, &str); 5] = [
    (
        "instruction",
        "Instruction",
        "operands, forms, steps, flags, errors, an example: rungc://instruction/MOV",
    ),
    (
        "diagnostic",
        "Diagnostic",
        "what a code means, with a wrong and a right program: rungc://diagnostic/W0203",
    ),
    (
        "special-device",
        "Special device",
        "meaning of a special relay or register: rungc://special-device/M8013",
    ),
    (
        "model",
        "PLC model",
        "devices and limits of a model: rungc://model/fx3u",
    ),
    (
        "plc-error",
        "Error code of a PLC",
        "what a PLC means by it: rungc://plc-error/6706",
    ),
];

fn entry(uri: String, title: &str, description: &str, mime: &str) -> Value {
    let name = uri.trim_start_matches("rungc://").to_owned();
    json!({ "uri": uri, "name": name, "title": title, "description": description, "mimeType": mime })
}

/// The type of a text by the name of its file.
fn mime(name: &str) -> &'static str {
    match name.ends_with(".toml") {
        true => "application/toml",
        false => "text/plain",
    }
}

/// All resources that have an address.
pub(crate) fn list(options: &Options) -> Vec<Value> {
    let guide = "What an assistant must know of the language and of rungc";
    let mut all = vec![entry(GUIDE.to_owned(), "Guide", guide, "text/markdown")];
    let texts = |kind: &'static str, texts: &[Text]| -> Vec<Value> {
        let texts = texts.iter();
        let entry = |text: &Text| {
            let mime = match kind {
                "book" => "text/markdown",
                _ => mime(text.name),
            };
            entry(
                format!("rungc://{kind}/{}", text.name),
                text.title,
                text.title,
                mime,
            )
        };
        texts.map(entry).collect()
    };
    all.extend(texts("example", &options.examples));
    all.extend(texts("book", &options.pages));
    let models = ModelId::ALL.into_iter().map(Model::get);
    all.extend(models.map(|model| {
        let uri = format!("rungc://model/{}", model.name);
        entry(uri, model.title, "Devices and limits", "text/plain")
    }));
    all.extend(codes::all().into_iter().map(|code| {
        let uri = format!("rungc://diagnostic/{}", code.id);
        entry(uri, code.name, code.title, "text/plain")
    }));
    all.extend(rungc_catalogue::all().map(|instruction| {
        let name = utf8_percent_encode(instruction.name, ESCAPED);
        let uri = format!("rungc://instruction/{name}");
        entry(uri, instruction.name, instruction.title, "text/markdown")
    }));
    all
}

/// Addresses with a part that a client fills in.
pub(crate) fn templates() -> Vec<Value> {
    let template = |uri: String, name: &str, title: &str, text: &str| json!({ "uriTemplate": uri, "name": name, "title": title, "description": text, "mimeType": "text/plain" });
    let topics = TOPICS.iter();
    let mut all: Vec<Value> = topics
        .map(|(kind, title, text)| template(format!("rungc://{kind}/{{name}}"), kind, title, text))
        .collect();
    let on_model = "the same on one model: rungc://instruction/MOV/fx1s";
    all.push(template(
        "rungc://instruction/{name}/{model}".to_owned(),
        "instruction-on-model",
        "Instruction on a model",
        on_model,
    ));
    all.push(template(
        "rungc://special-device/{name}/{model}".to_owned(),
        "special-device-on-model",
        "Special device on a model",
        "the same on one model: rungc://special-device/M8013/fx3u",
    ));
    all
}

/// Contents of a resource.
///
/// # Errors
/// Why there is none.
pub(crate) fn read(options: &Options, uri: &str) -> Result<Value, String> {
    let (mime, text) = contents(options, uri)?;
    Ok(json!({ "contents": [{ "uri": uri, "mimeType": mime, "text": text }] }))
}

fn contents(options: &Options, uri: &str) -> Result<(&'static str, String), String> {
    if uri == GUIDE {
        return Ok(("text/markdown", options.guide.to_owned()));
    }
    let unknown = || {
        format!(
            "there is no `{}`; `resources/list` names all",
            crate::protocol::clipped(uri)
        )
    };
    let rest = uri.strip_prefix("rungc://").ok_or_else(unknown)?;
    let (kind, name) = rest.split_once('/').ok_or_else(unknown)?;
    let name = percent_decode_str(name)
        .decode_utf8()
        .map_err(|_| unknown())?;
    let name = &*name;
    let text = |texts: &[Text]| {
        texts
            .iter()
            .find(|text| text.name == name)
            .map(|text| text.text.to_owned())
    };
    match kind {
        "book" => text(&options.pages)
            .map(|text| ("text/markdown", text))
            .ok_or_else(unknown),
        "example" => text(&options.examples)
            .map(|text| (mime(name), text))
            .ok_or_else(unknown),
        "instruction" | "special-device" => {
            let (name, model) = match name.split_once('/') {
                Some((name, model)) => (name, Some(plc(model)?)),
                None => (name, None),
            };
            page(name, model).map(|page| ("text/markdown", page))
        }
        kind if TOPICS.iter().any(|(topic, ..)| *topic == kind) => {
            page(name, None).map(|page| ("text/plain", page))
        }
        _ => Err(unknown()),
    }
}

/// A PLC by its name.
///
/// # Errors
/// Names of models.
pub(crate) fn plc(name: &str) -> Result<Plc, String> {
    Plc::named(name).map_err(|unknown| format!("{}; {}", unknown.message, unknown.help))
}

/// The page of a topic.
///
/// # Errors
/// Proposals.
pub(crate) fn page(topic: &str, model: Option<Plc>) -> Result<String, String> {
    let of_function = || rungc_functions::page::of(&topic.trim().to_lowercase());
    let page = rungc::explain::page(topic, model, Language::English).or_else(of_function);
    page.ok_or_else(|| {
        let functions: Vec<&str> = rungc_functions::library::all()
            .map(|function| function.name)
            .collect();
        rungc::explain::unknown(topic.trim(), model, &functions)
    })
}
