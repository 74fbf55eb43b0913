//! Options that need another one to have an effect: alone they are an error, since silence would look like success.
//!
//! Options that depend on rungc.toml, too, are held to it where the command has read it (`commands/build/fitting.rs`,
//! `commands/serve.rs`). Permissions (`--force`, `--allow-folder`), levels of warnings, and what is only about the
//! human format of diagnostics (`--limit`, `--draw`) may go unused.

use super::diff::DiffFormat;
use super::listings::XrefTo;
use super::{Cli, TestFormat};
use crate::output::OutputPath;
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Command, CommandFactory};

/// An option of a command, and when it has an effect.
struct Rule {
    command: &'static str,
    /// Its id.
    option: &'static str,
    applies: fn(&ArgMatches) -> bool,
    /// What it applies to, and what to do.
    otherwise: &'static str,
}

const fn rule(
    command: &'static str,
    option: &'static str,
    applies: fn(&ArgMatches) -> bool,
    otherwise: &'static str,
) -> Rule {
    Rule {
        command,
        option,
        applies,
        otherwise,
    }
}

/// All of them; `tests/it/effects.rs` tries each.
const RULES: [Rule; 16] = [
    rule(
        "run",
        "clients",
        |m| has(m, &SERVERS),
        "only applies to servers: add --modbus-tcp, --mc or --fx",
    ),
    rule(
        "run",
        "trace_frames",
        |m| has(m, &SERVERS) || has(m, &["serial", "can", "io", "real_time"]),
        "no frames pass in a run without connections: add a server or a line, such as --modbus-tcp 5020",
    ),
    rule(
        "run",
        "priority",
        |m| has(m, &SERVERS) || has(m, &["serial", "can", "io", "page", "real_time"]),
        "only applies in real time: add --real-time",
    ),
    rule(
        "fleet",
        "priority",
        |m| !has(m, &["in_virtual_time"]),
        "only applies in real time: leave out --virtual",
    ),
    rule("view", "network", |m| !is_page(m), PICTURES),
    rule("view", "device", |m| !is_page(m), PICTURES),
    rule("view", "around", |m| !is_page(m), PICTURES),
    rule("view", "sfc", |m| !is_page(m), PICTURES),
    rule(
        "view",
        "width",
        |m| !(is_document(m) || has(m, &["output"]) && has(m, &["sfc"])),
        "does not apply to a document, which has the width of its paper, or to a picture of a chart",
    ),
    rule(
        "view",
        "no_comments",
        |m| !has(m, &["output"]),
        "only applies to the drawing in characters: leave out -o",
    ),
    rule(
        "xref",
        "unused",
        |m| {
            let to = m.get_one::<XrefTo>("to");
            !matches!(to, Some(XrefTo::Csv | XrefTo::Io | XrefTo::Tags))
        },
        "a table has no lines for unused devices: use --to text, html or json",
    ),
    rule(
        "diff",
        "width",
        |m| {
            let format = m.get_one::<DiffFormat>("format");
            matches!(format, Some(DiffFormat::Human | DiffFormat::Md))
        },
        "only applies to --format human and --format md",
    ),
    rule(
        "flash",
        "baud",
        |m| has(m, &["port"]),
        "only applies to --port",
    ),
    rule(
        "flash",
        "timeout",
        |m| has(m, &["port", "volume"]),
        "only applies to --port and --volume",
    ),
    rule(
        "test",
        "no_cache",
        |m| !has(m, &["coverage", "mutants"]),
        "--coverage and --mutants always run all cases: leave it out",
    ),
    rule(
        "test",
        "review",
        |m| m.get_one::<TestFormat>("format") == Some(&TestFormat::Human),
        "asks in words: leave out --format",
    ),
];

/// Options that open servers.
const SERVERS: [&str; 3] = ["modbus_tcp", "mc", "fx"];

const PICTURES: &str =
    "does not apply to a page or a document, which shows all of the program: name a picture (.svg)";

/// The first option without an effect, and what it applies to.
pub fn idle(command: &str, matches: &ArgMatches) -> Option<String> {
    let mut rules = RULES.iter().filter(|rule| rule.command == command);
    let idle = rules.find(|rule| has(matches, &[rule.option]) && !(rule.applies)(matches))?;
    let option = long_option(command, idle.option);
    Some(format!("{option}: {}", idle.otherwise))
}

/// An option as its user writes it, `--write-test`, or the name of an argument without one, `DIR`.
pub fn long_option(command: &str, id: &str) -> String {
    let cli = Cli::command();
    let mut all = cli
        .find_subcommand(command)
        .into_iter()
        .flat_map(Command::get_arguments);
    let arg = all.find(|arg| arg.get_id() == id);
    let names = arg.and_then(Arg::get_value_names).unwrap_or_default();
    match (arg.and_then(Arg::get_long), names) {
        (None, [name]) => name.to_string(),
        (long, _) => format!("--{}", long.unwrap_or(id)),
    }
}

/// Returns true if one of these options is on the command line.
fn has(matches: &ArgMatches, options: &[&str]) -> bool {
    let mut options = options.iter();
    options.any(|id| matches.value_source(id) == Some(ValueSource::CommandLine))
}

/// Returns true if `view` writes a page or a document.
fn is_page(matches: &ArgMatches) -> bool {
    is_document(matches) || ending(matches) == Some("html")
}

/// Returns true if `view` writes a document.
fn is_document(matches: &ArgMatches) -> bool {
    ending(matches) == Some("pdf")
}

/// Extension of the file that `view` writes.
fn ending(matches: &ArgMatches) -> Option<&str> {
    let path = matches.get_one::<OutputPath>("output");
    path.and_then(|path| path.extension()?.to_str())
}

#[cfg(test)]
mod tests {
    use super::RULES;
    use crate::args::Cli;
    use clap::CommandFactory;

    #[test]
    fn each_rule_is_about_an_option_of_its_command() {
        let cli = Cli::command();
        for rule in &RULES {
            let command = cli.find_subcommand(rule.command);
            let mut known = command
                .into_iter()
                .flat_map(|command| command.get_arguments());
            let is_known = known.any(|arg| arg.get_id() == rule.option);
            assert!(is_known, "{} --{}", rule.command, rule.option);
        }
    }
}
