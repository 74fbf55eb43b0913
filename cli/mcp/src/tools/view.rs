//! `view`: the ladder of a program, drawn in characters.

use super::{Answer, Call, PROGRAM, Tool, integer, object, string};
use crate::arguments::{Kind, Parameter};
use rungc_analysis::resolve::resolve;
use rungc_ladder::text::{Style, draw};
use rungc_ladder::{Network, build};
use serde_json::{Value, json};

/// Most bytes of a drawing, after which no network begins.
const BYTES: usize = 16_000;

const PARAMETERS: &[Parameter] = &[
    Parameter::optional(
        "network",
        Kind::Whole(1, 10_000_000),
        "number of the first network to draw, from 1; default: 1, or `next_network` of the answer before",
    ),
    Parameter::optional(
        "last_network",
        Kind::Whole(1, 10_000_000),
        "number of the last network to draw; the same as `network` for one",
    ),
    Parameter::optional(
        "devices",
        Kind::Texts,
        "draw only networks that name one of these devices, such as [\"Y000\", \"D100..D199\"]",
    ),
    Parameter::optional(
        "width",
        Kind::Whole(60, 250),
        "characters on a line; default: 100",
    ),
];

pub(super) const TOOL: Tool = Tool {
    name: "view",
    title: "Draw the ladder",
    text: "Draws networks (rungs) of a program as ladder in characters, with the comments of devices. The \
    beginning of the program, a range of networks, or those that name a device. Long programs come in parts: \
    pass `network`.",
    parameters: &[PROGRAM, PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    object(&[
        ("file", string()),
        ("text", string()),
        ("networks", integer()),
        ("first", integer()),
        ("last", integer()),
        ("next_network?", integer()),
    ])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let project = call.whole()?;
    let (resolved, _) = resolve(project.source(), project.model());
    let ladder = build::ladder(&resolved);
    let count = ladder.networks.len();
    let first = call.arguments.whole("network").map_or(1, |n| n as usize);
    let last = call
        .arguments
        .whole("last_network")
        .map_or(usize::MAX, |n| n as usize);
    let named = named(call, &project)?;
    let is_chosen = |number: usize| {
        let is_named = named.as_ref().is_none_or(|named| named.contains(&number));
        (first..=last).contains(&number) && is_named
    };
    let chosen = (1..).zip(&ladder.networks);
    let chosen: Vec<(usize, &Network)> = chosen.filter(|(number, _)| is_chosen(*number)).collect();
    let Some(&(begin, _)) = chosen.first() else {
        return Err(format!(
            "none of the {count} networks matches `network`, `last_network` and `devices`"
        ));
    };
    let style = Style {
        width: call
            .arguments
            .whole("width")
            .map_or(100, |width| width as usize),
        comments: true,
    };
    let mut text = String::new();
    let mut end = begin;
    let mut next = None;
    for network in &chosen {
        if text.len() > BYTES {
            next = Some(network.0);
            break;
        }
        text.push_str(&draw(&resolved, &[*network], style));
        end = network.0;
    }
    let mut data = json!({
        "file": call.name(&project),
        "text": text,
        "networks": count,
        "first": begin,
        "last": end,
    });
    if let Some(next) = next {
        data["next_network"] = json!(next);
        text.push_str(&format!(
            "\n[of {count} networks; call again with \"network\": {next} for the rest]\n"
        ));
    }
    Ok(Answer { text, data })
}

/// Numbers of the networks that name the devices of the arguments, if there are some.
fn named(call: &Call, project: &rungc::Project) -> Result<Option<Vec<usize>>, String> {
    let ranges = super::xref::ranges(call, project)?;
    if ranges.is_empty() {
        return Ok(None);
    }
    let table = project.xref(&ranges);
    let uses = table.devices.iter().flat_map(|entry| &entry.uses);
    Ok(Some(uses.map(|line| line.network).collect()))
}
