//! Help in the language of the user. Its texts are those of `args.rs`, which a translation is found by.

use crate::args::Cli;
use crate::{early_option, language};
use anstream::AutoStream;
use clap::builder::{PossibleValue, PossibleValuesParser, Resettable, StyledStr};
use clap::error::ErrorKind;
use clap::{Arg, ColorChoice, Command, CommandFactory};
use rungc::Language;
use rungc::language::sentence;
use std::io::{self, Write};

/// Marks after which a line may be broken; lines are broken at spaces alone.
const MARKS: [char; 6] = ['，', '。', '；', '：', '、', '）'];

/// Texts of clap around those of the options, each as it begins.
const FIXED: [&str; 7] = [
    "Usage: ",
    "Commands:",
    "Arguments:",
    "Options:",
    "[default: ",
    "[possible values: ",
    "Possible values:",
];

/// Help in place of that in English, which is asked for, if the user reads another language.
pub struct Help {
    text: String,
    /// For arguments that are missing, not for `--help`.
    is_error: bool,
}

impl Help {
    /// The help that a failure to read the arguments stands for.
    pub fn of(failure: &clap::Error, color: ColorChoice) -> Option<Help> {
        use ErrorKind::{DisplayHelp, DisplayHelpOnMissingArgumentOrSubcommand};
        if !matches!(
            failure.kind(),
            DisplayHelp | DisplayHelpOnMissingArgumentOrSubcommand
        ) {
            return None;
        }
        let option = early_option("--lang").and_then(|name| Language::find(&name));
        let language = language::chosen(option).ok()?.language();
        if language == Language::English {
            return None;
        }
        let help = command(language).try_get_matches().err()?;
        let is_error = help.use_stderr();
        let is_coloured = match color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto if is_error => {
                AutoStream::choice(&io::stderr()) != anstream::ColorChoice::Never
            }
            ColorChoice::Auto => AutoStream::choice(&io::stdout()) != anstream::ColorChoice::Never,
        };
        let text = match is_coloured {
            true => help.render().ansi().to_string(),
            false => help.render().to_string(),
        };
        let text = finished(&text, language);
        Some(Help { text, is_error })
    }

    /// Prints it, and ends the process.
    pub fn print(&self) -> ! {
        let text = self.text.as_bytes();
        if self.is_error {
            let _ = io::stderr().write_all(text);
            std::process::exit(2);
        }
        let printed = io::stdout()
            .write_all(text)
            .and_then(|()| io::stdout().flush());
        if let Err(failed) = printed
            && failed.kind() != io::ErrorKind::BrokenPipe
        {
            crate::commands::eprint_line(&format!("rungc: standard output: {failed}"));
            std::process::exit(2);
        }
        std::process::exit(0);
    }
}

/// The command line with its texts in a language.
fn command(language: Language) -> Command {
    let mut command = Cli::command();
    // With the options that clap adds.
    command.build();
    said(command, language)
}

fn said(command: Command, language: Language) -> Command {
    let about = translated(command.get_about(), language);
    let long_about = translated(command.get_long_about(), language);
    command
        .about(about)
        .long_about(long_about)
        .mut_args(|arg| argument(arg, language))
        .mut_subcommands(|command| said(command, language))
}

fn argument(arg: Arg, language: Language) -> Arg {
    let help = translated(arg.get_help(), language);
    let long_help = translated(arg.get_long_help(), language);
    let values = arg.get_possible_values();
    let mut arg = arg.help(help).long_help(long_help);
    if !values.is_empty() {
        let values = values.iter().map(|value| {
            let help = translated(value.get_help(), language);
            let value = PossibleValue::new(value.get_name().to_owned()).hide(value.is_hide_set());
            value.help(help)
        });
        arg = arg.value_parser(PossibleValuesParser::new(values.collect::<Vec<_>>()));
    }
    arg
}

fn translated(text: Option<&StyledStr>, language: Language) -> Resettable<StyledStr> {
    let text = text.map(|text| paragraphs(&text.to_string(), language));
    text.map(StyledStr::from).into()
}

/// A text of several paragraphs, each of which is translated.
fn paragraphs(text: &str, language: Language) -> String {
    let paragraphs = text.split("\n\n").map(|english| {
        let (plain, end) = match english.strip_suffix('.') {
            Some(plain) => (plain, "。"),
            None => (english, ""),
        };
        match sentence(language, plain) {
            Some(said) => breakable(&format!("{said}{end}")),
            None => english.to_owned(),
        }
    });
    paragraphs.collect::<Vec<_>>().join("\n\n")
}

/// A text with spaces where lines may be broken.
fn breakable(text: &str) -> String {
    let mut spaced = String::with_capacity(text.len() + 32);
    for c in text.chars() {
        spaced.push(c);
        if MARKS.contains(&c) {
            spaced.push(' ');
        }
    }
    spaced.trim_end().to_owned()
}

/// The text that clap has laid out, without the spaces after marks, and with the words around it.
fn finished(text: &str, language: Language) -> String {
    let mut text = text.to_owned();
    for mark in MARKS {
        text = text.replace(&format!("{mark} "), &mark.to_string());
    }
    for english in FIXED {
        let word = english.trim_start_matches('[').trim_end_matches([':', ' ']);
        if let Some(said) = sentence(language, word) {
            let open = if english.starts_with('[') { "[" } else { "" };
            text = text.replace(english, &format!("{open}{said}："));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{FIXED, command};
    use crate::args::Cli;
    use clap::{Command, CommandFactory};
    use rungc::Language;
    use rungc::language::identifier;
    use std::collections::{BTreeMap, BTreeSet};

    /// All texts of a command and those below it, by paragraphs.
    fn texts(command: &Command, all: &mut BTreeSet<String>) {
        let mut add = |text: &dyn ToString| {
            for paragraph in text.to_string().split("\n\n") {
                let plain = paragraph.strip_suffix('.').unwrap_or(paragraph);
                all.insert(plain.to_owned());
            }
        };
        let abouts = command.get_about().into_iter();
        for text in abouts.chain(command.get_long_about()) {
            add(text);
        }
        for arg in command.get_arguments() {
            let helps = arg.get_help().into_iter();
            for text in helps.chain(arg.get_long_help()) {
                add(text);
            }
            for value in arg.get_possible_values() {
                if let Some(text) = value.get_help() {
                    add(text);
                }
            }
        }
        for command in command.get_subcommands() {
            texts(command, all);
        }
    }

    #[test]
    fn each_text_is_translated_and_each_translation_is_of_one() {
        let path = "../library/locales/zh-CN/phrases/help.ftl";
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let file = std::fs::read_to_string(path).unwrap();
        let mut known: BTreeMap<&str, &str> = BTreeMap::new();
        for block in file.split("\n\n") {
            let (comment, message) = block.trim().split_once('\n').unwrap();
            let english = comment.strip_prefix("# ").unwrap();
            let (id, _) = message.split_once(" = ").unwrap();
            assert_eq!(id, identifier(english));
            known.insert(english, id);
        }
        let mut cli = Cli::command();
        cli.build();
        let mut all = BTreeSet::new();
        texts(&cli, &mut all);
        let fixed = FIXED.map(|text| text.trim_start_matches('[').trim_end_matches([':', ' ']));
        all.extend(fixed.map(str::to_owned));
        all.retain(|text| !text.is_empty());
        let lacking: Vec<_> = all
            .iter()
            .filter(|text| known.remove(text.as_str()).is_none())
            .map(|text| format!("# {text}\n{} = …\n", identifier(text)))
            .collect();
        assert!(
            lacking.is_empty(),
            "help.ftl lacks:\n{}",
            lacking.join("\n")
        );
        assert!(known.is_empty(), "no text for {known:#?}");
    }

    #[test]
    fn help_is_in_the_language() {
        let mut command = command(Language::Chinese);
        let command = command.find_subcommand_mut("fmt").unwrap();
        let help = command.render_long_help().to_string();
        assert!(help.contains("不作更改"), "{help}");
        assert!(!help.contains("Change nothing"), "{help}");
    }
}
