//! The pages of functions, in Markdown as they are in the book, and as text.

use crate::template::placeholders;
use crate::{Demand, Form, Function, Over, Parameter, Presence, find, library};
use std::fmt::Write;

/// The page of a function by its name, or the list of all: `functions`.
pub fn of(topic: &str) -> Option<String> {
    match topic {
        "functions" => Some(list()),
        topic => find(topic).map(text),
    }
}

/// All functions, a line each.
pub fn list() -> String {
    let mut text = "Safety functions; `rungc explain NAME` shows one:\n\n".to_string();
    let width = library::all().map(|function| function.name.len()).max();
    let width = width.unwrap_or(0);
    for function in library::all() {
        let _ = writeln!(text, "  {:width$}  {}", function.name, function.title);
    }
    text + "\nA row of rungc.toml demands one: `[[property]]` with `use = \"NAME\"` (`rungc book safety`).\n"
}

/// Remark on the standards that pages name: their texts are not part of this repository.
const EDITION: &str = "Standards are named from memory: check the edition that you must follow.";

/// The page of a function as Markdown.
pub fn markdown(function: &Function) -> String {
    let mut page = format!(
        "# {}\n\n`use = \"{}\"`\n\n{}\n\nIt follows the idea of: {}. {EDITION}\n\n",
        function.title, function.name, function.text, function.standard
    );
    page += "| parameter | value | default | |\n|---|---|---|---|\n";
    for parameter in function.parameters {
        let (name, kind) = (parameter.name, parameter.kind.describe());
        let default = default(parameter, "`");
        let _ = writeln!(
            page,
            "| `{name}` | {kind} | {default} | {} |",
            parameter.text
        );
    }
    page += "\n| demand | property |\n|---|---|\n";
    for demand in function.demands {
        let (name, property) = (demand.name, property(demand));
        let property = property.replace('|', "\\|");
        let _ = writeln!(page, "| {name} | `{property}`{} |", needs(function, demand));
    }
    let _ = write!(page, "\nNot covered: {}\n", function.limits);
    let (wrong, right) = (function.wrong, function.right);
    let _ = write!(
        page,
        "\n## Wrong\n\nViolates \"{}\":\n\n```text\n{wrong}\n```\n\n## Right\n\n```text\n{right}\n```\n",
        function.violates
    );
    let _ = write!(page, "\nFor both:\n\n```toml\n{}\n```\n", row(function));
    page
}

/// The page of a function as text.
pub fn text(function: &Function) -> String {
    let mut page = format!(
        "{} (use = \"{}\")\n\n{}\n\nIt follows the idea of: {}. {EDITION}\n\nParameters:\n\n",
        function.title, function.name, function.text, function.standard
    );
    let width = function
        .parameters
        .iter()
        .map(|parameter| parameter.name.len())
        .max();
    let width = width.unwrap_or(0);
    for parameter in function.parameters {
        let (name, kind, default) = (
            parameter.name,
            parameter.kind.describe(),
            default(parameter, ""),
        );
        let _ = writeln!(
            page,
            "    {name:width$}  {} ({kind}; {default})",
            parameter.text
        );
    }
    page += "\nDemands and their properties:\n\n";
    for demand in function.demands {
        let (name, property) = (demand.name, property(demand));
        let _ = writeln!(
            page,
            "    {name}{}\n        {property}",
            needs(function, demand)
        );
    }
    let _ = write!(page, "\nNot covered: {}\n", function.limits);
    let parts = [
        (
            format!("Wrong, it violates \"{}\":", function.violates),
            function.wrong.to_string(),
        ),
        ("Right:".to_string(), function.right.to_string()),
        ("For both, in rungc.toml:".to_string(), row(function)),
    ];
    for (title, lines) in parts {
        let lines: String = lines.lines().map(|line| format!("    {line}\n")).collect();
        let _ = write!(page, "\n{title}\n\n{lines}");
    }
    page
}

/// The row of rungc.toml for the programs of a page.
pub fn row(function: &Function) -> String {
    format!(
        "[[property]]\nuse = \"{}\"\n{}",
        function.name, function.example
    )
}

fn default(parameter: &Parameter, quote: &str) -> String {
    match parameter.presence {
        Presence::Required => "required".to_string(),
        Presence::Optional => "optional".to_string(),
        Presence::Default(value) => format!("{quote}{value}{quote}"),
    }
}

/// A demand as a property, with placeholders.
fn property(demand: &Demand) -> String {
    match demand.form {
        Form::Never(only) => format!("never {only}"),
        Form::Reachable(only) => format!("reachable {only}"),
        Form::Whenever { when, then, within } => {
            format!("whenever {when} then {then} within {{{within}}}")
        }
        Form::Stays {
            after: "",
            holds,
            until,
        } => format!("stays {holds} until {until}"),
        Form::Stays {
            after,
            holds,
            until,
        } => format!("stays {holds} after {after} until {until}"),
    }
}

/// Condition under which a demand is made, in words.
fn needs(function: &Function, demand: &Demand) -> String {
    let over = match demand.over {
        Over::Once => String::new(),
        Over::Each(name) => format!(", for each of `{name}`"),
        Over::First(name) => format!(", for the first of `{name}`"),
        Over::Pairs(name) => format!(", for each pair of `{name}`"),
        Over::Next(name) => format!(", for each of `{name}` and its successor"),
    };
    let templates = demand.form.templates();
    let is_needed = |parameter: &&Parameter| {
        let outside = |template: &str| {
            let parts = template.split('[').map(|part| part.rsplit(']').next());
            let mut names = parts.flatten().flat_map(placeholders);
            names.any(|name| name == parameter.name)
        };
        parameter.presence == Presence::Optional
            && templates.iter().any(|template| outside(template))
    };
    let needed = function.parameters.iter().filter(is_needed);
    let needed: Vec<_> = needed
        .map(|parameter| format!("`{}`", parameter.name))
        .collect();
    match &needed[..] {
        [] => over,
        names => format!("{over}, with {}", names.join(" and ")),
    }
}
