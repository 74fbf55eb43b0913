//! The tools: each has a description for the assistant, parameters, and a function that answers.

mod check;
mod convert;
mod diff;
mod explain;
mod open;
mod run;
mod test;
mod verify;
mod view;
mod why;
mod write;
mod xref;

use crate::arguments::{Arguments, Kind, Parameter};
use crate::files::Files;
use crate::{Options, page};
use rungc::Project;
use serde_json::{Map, Value, json};
use std::sync::atomic::{AtomicBool, Ordering};

/// All tools, in the order in which an assistant needs them.
pub(crate) const ALL: &[&Tool] = &[
    &open::TOOL,
    &check::TOOL,
    &view::TOOL,
    &xref::TOOL,
    &explain::TOOL,
    &run::TOOL,
    &why::TOOL,
    &test::TOOL,
    &verify::TOOL,
    &diff::TOOL,
    &convert::TOOL,
    &write::TOOL,
];

/// A tool.
#[derive(Debug)]
pub(crate) struct Tool {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// What it does, and when to call it.
    pub(crate) text: &'static str,
    pub(crate) parameters: &'static [&'static [Parameter]],
    /// Schema of the answer as data.
    pub(crate) output: fn() -> Value,
    /// True if it changes files.
    pub(crate) writes: bool,
    pub(crate) call: fn(&mut Call) -> Result<Answer, String>,
}

/// A call of a tool.
pub(crate) struct Call<'a> {
    pub(crate) arguments: &'a Arguments,
    pub(crate) files: &'a mut Files,
    pub(crate) options: &'a Options,
    /// True if the client wants no answer any more.
    pub(crate) stop: &'a AtomicBool,
}

/// The answer to a call.
#[derive(Debug)]
pub(crate) struct Answer {
    /// For the assistant to read.
    pub(crate) text: String,
    /// The same as an object.
    pub(crate) data: Value,
}

/// Parameters of tools that work on one program.
const PROGRAM: &[Parameter] = &[
    Parameter::optional(
        "path",
        Kind::Text,
        "the program: a file of any format that rungc reads, or a folder with a project, such as `press.il`",
    ),
    Parameter::optional(
        "list",
        Kind::Text,
        "instead of `path`: the text of an instruction list or of drawn ladder, such as `LD X000\\nOUT Y000\\nEND`",
    ),
    MODEL,
];

const MODEL: Parameter = Parameter::optional(
    "model",
    Kind::Text,
    "the PLC, such as `fx3u` or `h2u`; else the one that the program or rungc.toml names, or FX3U",
);

const OFFSET: Parameter = Parameter::optional(
    "offset",
    Kind::Whole(0, 100_000_000),
    "where to begin: `next_offset` of the answer before",
);

impl Call<'_> {
    /// Returns true if the client has cancelled the call.
    fn is_cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn offset(&self) -> usize {
        self.arguments
            .whole("offset")
            .map_or(0, |offset| offset as usize)
    }

    /// The program that the arguments name.
    fn project(&self) -> Result<Project, String> {
        let options = rungc::Options {
            model: self.arguments.text("model").map(str::to_owned),
            ..rungc::Options::default()
        };
        match (self.arguments.text("path"), self.arguments.text("list")) {
            (Some(path), None) => self.open(path, &options),
            (None, Some(list)) => Project::from_bytes("list", list.as_bytes(), &options)
                .map_err(|error| error.to_string()),
            (None, None) => {
                Err("name the program: `path` of a file, or `list` with the text of one".to_owned())
            }
            (Some(_), Some(_)) => Err("name one program: `path` or `list`, not both".to_owned()),
        }
    }

    /// The program of a file or folder.
    fn open(&self, path: &str, options: &rungc::Options) -> Result<Project, String> {
        let file = self.files.find(path)?;
        Project::open_with(file, options).map_err(|error| error.to_string())
    }

    /// The program, if it can be read whole.
    fn whole(&self) -> Result<Project, String> {
        let project = self.project()?;
        readable(&project)?;
        Ok(project)
    }

    /// Name of a program's file.
    fn name(&self, project: &Project) -> String {
        self.files.shown(project.file())
    }
}

/// Rejects a program of which a part could not be read.
fn readable(project: &Project) -> Result<(), String> {
    match project.source().instrs.is_empty() {
        true => {
            let first = project.check().diagnostics.into_iter().next();
            let why = first.map_or_else(|| "it is empty".to_owned(), |first| first.to_string());
            Err(format!("nothing of this program can be read: {why}"))
        }
        false => Ok(()),
    }
}

/// Compiles a program; else its errors.
fn compiled(project: &Project) -> Result<rungc::Program, String> {
    /// Errors that a message shows.
    const MOST: usize = 5;
    let checked = project.check();
    checked.compile().map_err(|error| match error {
        rungc::Error::Rejected(errors) => {
            let shown: Vec<String> = errors.iter().take(MOST).map(ToString::to_string).collect();
            let count = errors.len();
            let shown = shown.join("\n");
            format!(
                "the program has {count} errors, so it does not run; `check` lists all:\n{shown}"
            )
        }
        error => error.to_string(),
    })
}

/// Schema of an object. Names that end with `?` may be missing.
fn object(properties: &[(&str, Value)]) -> Value {
    let plain = |name: &str| name.trim_end_matches('?').to_owned();
    let required: Vec<String> = properties
        .iter()
        .filter(|(name, _)| !name.ends_with('?'))
        .map(|(name, _)| plain(name))
        .collect();
    let all: Map<String, Value> = properties
        .iter()
        .map(|(name, schema)| (plain(name), schema.clone()))
        .collect();
    json!({ "type": "object", "properties": all, "required": required })
}

fn string() -> Value {
    json!({ "type": "string" })
}

fn integer() -> Value {
    json!({ "type": "integer" })
}

fn boolean() -> Value {
    json!({ "type": "boolean" })
}

fn list(items: Value) -> Value {
    json!({ "type": "array", "items": items })
}

fn anything() -> Value {
    json!({ "type": "object" })
}

/// Properties of an answer in parts.
fn paged() -> [(&'static str, Value); 3] {
    [
        ("total", integer()),
        ("offset", integer()),
        ("next_offset?", integer()),
    ]
}

/// Schema of an answer with a text in parts.
fn text_output(more: &[(&str, Value)]) -> Value {
    let mut all = vec![("text", string())];
    all.extend(paged());
    all.extend(more.iter().cloned());
    object(&all)
}

/// An answer that is a text, in parts.
fn text_answer(call: &Call, text: &str, mut data: Value) -> Answer {
    let page = page::Page::of(text, call.offset());
    data["text"] = json!(page.text);
    page.mark(&mut data);
    Answer {
        text: page.with_remark(),
        data,
    }
}
