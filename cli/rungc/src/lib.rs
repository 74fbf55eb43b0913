//! The rungc command line: arguments, reports and exit codes. What a command does is in the crates that it calls;
//! nothing here may decide what a program means. Start reading at `args.rs` and `commands/mod.rs`; a command is a file
//! in `commands/`.
#![deny(missing_docs)]

mod args;
mod commands;
mod crash;
mod help;
mod language;
mod output;
mod progress;
mod report;
mod time;

use anstream::{AutoStream, ColorChoice};
use args::{Cli, ColorWhen, Command, Emit};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches};
use commands::{Context, Failure, Outcome, Verbosity, interruption};
use help::Help;
use output::OutputPath;
use rungc_sim::threads::Threads;
use std::ffi::OsString;
use std::io::{self, Write};
use std::process::ExitCode;

/// Does what the arguments of the process ask for, and returns its exit code.
pub fn main() -> ExitCode {
    crash::report_panics();
    if let Some(broken) = broken_argument() {
        commands::eprint_line(&format!(
            "rungc: the argument `{broken}` contains a line break"
        ));
        return ExitCode::from(2);
    }
    let matches = Cli::command().color(usage_color()).try_get_matches();
    let matches = matches.unwrap_or_else(|error| match Help::of(&error, usage_color()) {
        Some(help) => help.print(),
        None => reject(&advised(error)),
    });
    let cli = Cli::from_arg_matches(&matches)
        .unwrap_or_else(|error| reject(&error.format(&mut Cli::command())));
    let threads = Threads::stated().map(drop).map_err(Failure::from);
    let (cx, language) = match language::chosen(cli.lang) {
        Ok(language) => (context(&cli, language), Ok(())),
        Err(unknown) => (context(&cli, language::Chosen::default()), Err(unknown)),
    };
    let checked = language.map_err(Failure::from).and(threads);
    let checked = checked.and_then(|()| output::check_arguments(&matches));
    let result = checked.and_then(|()| match &cli.command {
        Command::Check(args) => commands::check::run(args, cx),
        Command::Build(args) => commands::build::run(args, cx),
        Command::Run(args) => commands::run::run(args, cx),
        Command::Serve(args) => commands::serve::run(args, cx),
        Command::Fleet(args) => commands::fleet::run(args, cx),
        Command::Test(args) => commands::test::run(args, cx),
        Command::Convert(args) => commands::convert::run(args, cx),
        Command::Read(args) => commands::read::run(args, cx),
        Command::Boards(args) => commands::boards::run(args, cx),
        Command::Flash(args) => commands::flash::run(args, cx),
        Command::Lsp(_) => commands::lsp::run(),
        Command::Dap(_) => commands::dap::run(),
        Command::Mcp(args) => commands::mcp::run(args),
        Command::Guide => commands::mcp::guide(),
        Command::Init(args) => commands::init::run(args, cx),
        Command::Demo(args) => commands::demo::run(args, cx),
        Command::Doctor(args) => commands::doctor::run(args, cx),
        Command::Rename(args) => commands::rename::run(args, cx),
        Command::Learn(args) => commands::learn::run(args, cx),
        Command::Verify(args) => commands::verify::run(args, cx),
        Command::Explore(args) => commands::explore::run(args, cx),
        Command::View(args) => commands::view::run(args, cx),
        Command::Doc(args) => commands::doc::run(args, cx),
        Command::Xref(args) => commands::xref::run(args, cx),
        Command::Why(args) => commands::why::run(args, cx),
        Command::Watch(args) => commands::watch::run(args, cx),
        Command::Stats(args) => commands::stats::run(args, cx),
        Command::Fmt(args) => commands::fmt::run(args, cx),
        Command::Diff(args) => commands::diff::run(args, cx),
        Command::Explain(args) => commands::explain::run(args, cx),
        Command::Book(args) => commands::book::run(args, cx),
        Command::Man(args) => man(args.command.as_deref()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "rungc", &mut script);
            commands::print_text(&String::from_utf8_lossy(&script))
                .map(|()| Outcome::Success)
                .map_err(Failure::from)
        }
    });
    match result {
        // An error caused by an interruption is not reported separately.
        Err(Failure::Because(_)) if interruption::is_requested() => {
            ExitCode::from(interruption::EXIT_CODE)
        }
        Ok(Outcome::Success) => ExitCode::SUCCESS,
        Ok(Outcome::Undecided) => ExitCode::from(3),
        Ok(Outcome::Failed) => ExitCode::from(1),
        Ok(Outcome::Interrupted) => ExitCode::from(interruption::EXIT_CODE),
        Ok(Outcome::Unusable) | Err(Failure::Reported) => ExitCode::from(2),
        Err(failure) => {
            commands::eprint_line(&format!("rungc: {failure}"));
            ExitCode::from(2)
        }
    }
}

/// The context of the command.
fn context(cli: &Cli, language: language::Chosen) -> Context {
    let is_printed = |output: &Option<OutputPath>| output::file(output).is_none();
    Context {
        color: color(cli.color),
        language,
        stdout_in_use: match &cli.command {
            Command::Build(args) => {
                args.plan.emit == Some(Emit::Ir) && is_printed(&args.plan.output)
            }
            Command::Convert(args) => is_printed(&args.output),
            Command::Read(args) => is_printed(&args.output),
            Command::Run(_)
            | Command::Serve(_)
            | Command::Fleet(_)
            | Command::Why(_)
            | Command::Watch(_)
            | Command::Stats(_)
            | Command::Diff(_)
            | Command::Lsp(_)
            | Command::Dap(_)
            | Command::Mcp(_)
            | Command::Verify(_) => true,
            Command::Xref(args) => is_printed(&args.output),
            Command::Fmt(args) => args.check,
            _ => false,
        },
        verbosity: match (cli.quiet, cli.verbose) {
            (true, _) => Verbosity::Quiet,
            (false, false) => Verbosity::Normal,
            (false, true) => Verbosity::Verbose,
        },
    }
}

/// An argument that is more than one line, on one. Messages show arguments, and what begins a line there may be a
/// command to a CI server.
fn broken_argument() -> Option<String> {
    let mut arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    let broken = arguments.find(|argument| report::breaks_lines(argument))?;
    Some(report::visible_line(&broken).into_owned())
}

/// Words of other tools, and the commands that do what they mean.
const OTHER_WORDS: [(&str, &str); 10] = [
    ("compile emit generate make", "build"),
    ("lint validate analyse analyze", "check"),
    ("ladder draw show print svg", "view"),
    ("prove proof", "verify"),
    ("simulate sim start exec interpret", "run"),
    ("export import decompile translate", "convert"),
    ("upload download backup", "read"),
    ("format", "fmt"),
    ("tour example tutorial", "demo"),
    ("tools environment env diagnose", "doctor"),
];

/// Options that limit the time of a run.
const DURATION: &str = "duration time seconds length run-for run-time";

/// Words of options of other tools, and the options that do what they mean, where a command has one of them.
const OTHER_OPTIONS: [(&str, &[&str]); 4] = [
    (DURATION, &["for", "timeout"]),
    ("cpu plc type target", &["model"]),
    ("out out-dir destination", &["output"]),
    ("fmt out-format report-format", &["format"]),
];

/// An error with better advice: for an unknown command or option, the one that does what the word means elsewhere; for
/// an option with a negative value, which no option takes, without that to put it after `--`.
fn advised(mut error: clap::Error) -> clap::Error {
    if let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidSubcommand) {
        let unknown = unknown.to_ascii_lowercase();
        let means = |words: &str| words.split(' ').any(|word| word == unknown);
        if let Some((_, command)) = OTHER_WORDS.iter().find(|(words, _)| means(words)) {
            let known = ContextValue::Strings(vec![(*command).to_string()]);
            error.insert(ContextKind::SuggestedSubcommand, known);
        }
        return error;
    }
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidArg) else {
        return error;
    };
    if let Some(tip) = other_option(unknown) {
        let tips = vec![tip.into()];
        error.remove(ContextKind::SuggestedArg);
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(tips));
        return error;
    }
    let number = unknown.strip_prefix('-').unwrap_or_default();
    let arguments: Vec<_> = std::env::args_os().collect();
    let option = arguments.windows(2).find_map(|pair| {
        let [option, value] = [&pair[0], &pair[1]].map(|word| word.to_string_lossy());
        let is_option = option.starts_with('-') && !option.contains('=') && option != "--";
        (is_option && value.starts_with(unknown)).then(|| option.into_owned())
    });
    if let Some(option) = option
        && error.kind() == ErrorKind::UnknownArgument
        && number.starts_with(|c: char| c.is_ascii_digit())
    {
        let tip = format!("'{option}' takes no negative value").into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip]));
    }
    error
}

/// Advice about an option of other tools, or of another command.
fn other_option(unknown: &str) -> Option<String> {
    let word = unknown.strip_prefix("--")?.to_ascii_lowercase();
    let (words, options) = OTHER_OPTIONS
        .iter()
        .find(|(words, _)| words.split(' ').any(|known| known == word))?;
    let cli = Cli::command();
    let mut arguments = std::env::args_os().skip(1);
    let command = arguments.find_map(|name| cli.find_subcommand(name).cloned())?;
    let has = |option: &&&str| {
        let mut own = command.get_arguments();
        own.any(|argument| argument.get_long() == Some(option))
    };
    match options.iter().find(has) {
        Some(option) => Some(format!("this is '--{option}' here")),
        None if *words == DURATION && command.get_name() == "test" => Some(
            "each step of a case says how long it runs, by `run_ms` or `scans` (rungc book test-files)"
                .to_string(),
        ),
        None => None,
    }
}

/// Reports arguments that cannot be used, or prints what `--help` asks for, and ends the process. Arguments are shown
/// in messages, so what a terminal would act on in them is written out.
fn reject(error: &clap::Error) -> ! {
    let acts = |argument: OsString| {
        argument
            .to_string_lossy()
            .contains(rungc_syntax::text::acts)
    };
    if std::env::args_os().any(acts) {
        commands::eprint_line(error.to_string().trim_end());
        std::process::exit(error.exit_code());
    }
    let printed = error.print().and_then(|()| io::stdout().flush());
    if let Err(failed) = printed
        && failed.kind() != io::ErrorKind::BrokenPipe
        && !error.use_stderr()
    {
        commands::eprint_line(&format!("rungc: standard output: {failed}"));
        std::process::exit(2);
    }
    std::process::exit(error.exit_code());
}

/// Prints the manual page of rungc, or of one of its commands.
fn man(command: Option<&str>) -> commands::Result {
    let mut cli = Cli::command();
    cli.build();
    let shown = match command {
        None => cli,
        Some(name) => {
            let found = cli.find_subcommand(name).cloned();
            found.ok_or_else(|| {
                Failure::Because(format!(
                    "`{name}` is not a command; `rungc help` lists them"
                ))
            })?
        }
    };
    let source = format!("rungc {}", env!("CARGO_PKG_VERSION"));
    let mut page = Vec::new();
    let man = clap_mangen::Man::new(shown).source(source).manual("rungc");
    man.render(&mut page)?;
    commands::print_text(&String::from_utf8_lossy(&page))?;
    Ok(Outcome::Success)
}

/// Returns true if standard error is to be coloured.
fn color(when: ColorWhen) -> bool {
    match when {
        ColorWhen::Always => {
            // Also where the standard output of Windows is not a console.
            yansi::enable();
            true
        }
        ColorWhen::Never => false,
        ColorWhen::Auto => AutoStream::choice(&io::stderr()) != ColorChoice::Never,
    }
}

/// Use of colours in help and in errors of usage, which end the process before its arguments are known.
fn usage_color() -> clap::ColorChoice {
    match early_option("--color").as_deref() {
        Some("always") => clap::ColorChoice::Always,
        Some("never") => clap::ColorChoice::Never,
        _ => clap::ColorChoice::Auto,
    }
}

/// Value of an option before the arguments are known.
fn early_option(name: &str) -> Option<String> {
    let arguments: Vec<OsString> = std::env::args_os()
        .take_while(|argument| argument != "--")
        .collect();
    arguments.iter().enumerate().find_map(|(n, argument)| {
        let argument = argument.to_string_lossy();
        match argument.strip_prefix(name)? {
            "" => Some(arguments.get(n + 1)?.to_string_lossy().into_owned()),
            value => Some(value.strip_prefix('=')?.to_owned()),
        }
    })
}
