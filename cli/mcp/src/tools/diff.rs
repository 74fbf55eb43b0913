//! `diff`: what differs between two programs.

use super::{Answer, Call, OFFSET, Tool, boolean, list, string, text_answer, text_output};
use crate::arguments::{Kind, Parameter};
use rungc::Project;
use rungc_analysis::resolve::resolve;
use rungc_ir::Module;
use rungc_ir::compare::{Behaviour, behaviour};
use rungc_ir::passes::simplify;
use rungc_ladder::build;
use rungc_ladder::compare::{Comparison, Drawn, compare, text};
use rungc_lower::compile::compile;
use serde_json::{Value, json};
use std::fmt::Write;

/// Characters on a line.
const WIDTH: u16 = 100;

const PARAMETERS: &[Parameter] = &[
    Parameter::required("old", Kind::Text, "the program before, as a path"),
    Parameter::required("new", Kind::Text, "the program after, as a path"),
    super::MODEL,
    Parameter::optional(
        "semantic",
        Kind::Flag,
        "also say which devices can behave differently: `No output can differ` is certain, the list may be too long",
    ),
    OFFSET,
];

pub(super) const TOOL: Tool = Tool {
    name: "diff",
    title: "Compare two programs",
    text: "Compares two programs network by network, also of different formats: changed, added, removed and \
    moved networks as ladder, comments of devices, settings. With `semantic`, which devices can behave \
    differently. Long answers come in parts: pass `offset`.",
    parameters: &[PARAMETERS],
    output,
    writes: false,
    call,
};

fn output() -> Value {
    text_output(&[
        ("old", string()),
        ("new", string()),
        ("differs", boolean()),
        ("summary", string()),
        ("behaviour", list(string())),
    ])
}

fn call(call: &mut Call) -> Result<Answer, String> {
    let options = rungc::Options {
        model: call.arguments.text("model").map(str::to_owned),
        ..rungc::Options::default()
    };
    let side = |name: &str| {
        let path = call.arguments.text(name).unwrap_or_default();
        let project = call.open(path, &options)?;
        match project.source().is_complete() {
            true => Ok(project),
            false => Err(format!(
                "`{path}` cannot be read whole, so it is not compared; `check` says why"
            )),
        }
    };
    let sides = [side("old")?, side("new")?];
    let [old, new] = &sides;
    let resolved = [
        resolve(old.source(), old.model()).0,
        resolve(new.source(), new.model()).0,
    ];
    let ladders = [build::ladder(&resolved[0]), build::ladder(&resolved[1])];
    let drawn = [0, 1].map(|side| Drawn {
        resolved: &resolved[side],
        ladder: &ladders[side],
    });
    let comparison = compare(drawn[0], drawn[1]);
    let summary = text::summary(&comparison);
    let behaviour = match call.arguments.flag("semantic") {
        true => of_both(old, new).in_words(None),
        false => Vec::new(),
    };
    let names = [call.name(old), call.name(new)];
    let data = json!({
        "old": names[0],
        "new": names[1],
        "differs": !comparison.is_empty(),
        "summary": summary,
        "behaviour": behaviour,
    });
    let text = described(&names, &summary, &behaviour, drawn, &comparison);
    Ok(text_answer(call, &text, data))
}

fn described(
    [old, new]: &[String; 2],
    summary: &str,
    behaviour: &[String],
    drawn: [Drawn; 2],
    comparison: &Comparison,
) -> String {
    let mut out = format!("--- {old}\n+++ {new}\n{summary}\n");
    for sentence in behaviour {
        let _ = writeln!(out, "{sentence}");
    }
    for &change in &comparison.networks {
        let _ = writeln!(out, "\n{}", text::heading(drawn, change));
        out.push_str(&text::fragment(drawn, change, WIDTH));
    }
    for (title, body) in text::tables(comparison) {
        let _ = write!(out, "\n{title}\n{body}");
    }
    out
}

/// Comparison of the behaviour of both programs.
fn of_both(old: &Project, new: &Project) -> Behaviour {
    match [module(old), module(new)] {
        [Some(old), Some(new)] => behaviour(&old, &new),
        [None, _] => Behaviour::Undecided("the old program does not compile (see `check`)"),
        [_, None] => Behaviour::Undecided("the new program does not compile (see `check`)"),
    }
}

fn module(project: &Project) -> Option<Module> {
    let options =
        rungc::settings::compiling(project.settings(), project.file(), Some(project.plc()), &[]);
    let mut module = compile(project.source(), &options).module?;
    simplify(&mut module);
    Some(module)
}
