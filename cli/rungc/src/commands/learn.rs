//! `rungc learn`.

use super::entries::{entry, with_entries};
use super::subject::{self, Subject};
use super::{Context, Failure, Outcome, Result, counted, parent_dir, print_text};
use crate::args::{FileKind, Input, LearnArgs, Reading, Reporting};
use crate::output::rewrite;
use rungc_analysis::fitting::fits;
use rungc_catalogue::Basic;
use rungc_frontend::{Lesson, Read, ReadOptions, Reading as Taken, learn};
use rungc_lower::compile::{self, CompileOptions};
use rungc_models::{Model, Plc};
use rungc_project::FILE;
use rungc_syntax::{SourceKind, text};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Learns the codes of a project from its list, writes them to rungc.toml and prints a text to be sent in.
pub fn run(args: &LearnArgs, cx: Context) -> Result {
    let subject = subject(args, cx)?;
    let because = |error: &dyn std::error::Error| Failure::Because(plain(&error.to_string()));
    let project = subject::source(&subject).map_err(|error| because(&error))?;
    let export = rungc_frontend::read(&args.export).map_err(|error| because(&error))?;
    let lessons = learn(&project, &export, same).map_err(|why| because(&why))?;
    if lessons.is_empty() {
        cx.note("     Learned nothing: the codes of all instructions are known");
        return Ok(Outcome::Success);
    }
    let options = CompileOptions {
        model: subject.model,
        ..CompileOptions::default()
    };
    let model = compile::model(&project.program, &options);
    for lesson in &lessons {
        prove(lesson, model)?;
    }
    let path = match (&args.project, &subject.project) {
        (Some(given), _) => given.clone(),
        (None, Some(found)) => found.path.clone(),
        (None, None) => match home(&args.file, project.program.kind) {
            here if here == Path::new(".") => PathBuf::from(FILE),
            home => home.join(FILE),
        },
    };
    write(&path, &lessons)?;
    let path = subject::near(path);
    let codes = counted(lessons.len(), "code");
    cx.note(&format!(
        "     Learned {codes}: written to {}",
        path.display()
    ));
    print_text(&letter(&lessons, &project))?;
    Ok(Outcome::Success)
}

/// The project with its settings; those that are given need not be there yet.
fn subject(args: &LearnArgs, cx: Context) -> std::result::Result<Subject, Failure> {
    let file = args.file.clone();
    if args.project.as_ref().is_some_and(|given| !given.exists()) {
        return Ok(Subject {
            arguments: Vec::new(),
            file,
            project: None,
            model: args.model,
            variant: None,
            reporting: Reporting::default(),
            options: ReadOptions::default(),
        });
    }
    let kind = FileKind {
        model: args.model.map(Plc::any),
        ..FileKind::default()
    };
    let reading = Reading {
        kind,
        project: args.project.clone(),
        ..Reading::default()
    };
    let file = Some(file);
    subject::one(&Input { file, reading }, cx)
}

/// Text of a file, for messages.
fn plain(text: &str) -> String {
    text::one_line(text).into_owned()
}

/// Returns true if two mnemonics are spellings of one instruction, such as `ECMP` and `DECMP`.
fn same(a: &str, b: &str) -> bool {
    a == b
        || match (rungc_catalogue::find(a), rungc_catalogue::find(b)) {
            (Some(a), Some(b)) => {
                let label = a.inst.basic() == Some(Basic::Label);
                std::ptr::eq(a.inst, b.inst) && a.form == b.form && !label
            }
            _ => false,
        }
}

/// Holds what the list says to the catalogue.
fn prove(lesson: &Lesson, model: &'static Model) -> std::result::Result<(), Failure> {
    let (code, mnemonic) = (lesson.shown(), &lesson.mnemonic);
    if rungc_catalogue::find(mnemonic).is_none() {
        let why = format!(
            "the code {code} is `{mnemonic}` in the export, but no model has this instruction"
        );
        return Err(Failure::Because(plain(&why)));
    }
    let steps = lesson.steps();
    match lesson
        .uses
        .iter()
        .find(|instr| !fits(mnemonic, steps, &instr.operands, model))
    {
        Some(instr) => Err(Failure::Because(plain(&format!(
            "the code {code} states {}, but `{instr}` of the export has another length on {}",
            counted(steps as usize, "step"),
            model.name
        )))),
        None => Ok(()),
    }
}

/// The folder that a project lies in as a whole: for the `MAIN.wpg` of GX Developer the one above `Resource`.
fn home(file: &Path, kind: SourceKind) -> PathBuf {
    if file.is_dir() {
        return file.to_path_buf();
    }
    let mut folder = parent_dir(file);
    if kind == SourceKind::GxDeveloper {
        for inner in ["Body", "POU", "Resource"] {
            if folder
                .file_name()
                .is_some_and(|name| name.eq_ignore_ascii_case(inner))
            {
                folder = parent_dir(folder);
            }
        }
    }
    folder.to_path_buf()
}

/// Adds codes to the table `[tokens]` of a file, which may not be there yet; all else in it stays as it is.
fn write(path: &Path, lessons: &[Lesson]) -> std::result::Result<(), Failure> {
    let because = |why: String| Failure::Because(format!("{}: {why}", path.display()));
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
        Err(error) => return Err(because(error.to_string())),
    };
    let codes = lessons
        .iter()
        .map(|lesson| entry(&lesson.shown(), &lesson.mnemonic));
    let text = with_entries(&text, "tokens", &codes.collect::<String>()).map_err(because)?;
    rewrite(path, text.as_bytes())
}

/// Report by which others can learn the same codes.
fn letter(lessons: &[Lesson], project: &Read) -> String {
    let editor = project.program.kind.title();
    let cpu = project.program.cpu.as_deref().unwrap_or("not named");
    let names: Vec<_> = lessons
        .iter()
        .map(|lesson| format!("{} is {}", lesson.shown(), lesson.mnemonic))
        .collect();
    let mut text = format!(
        "To help others read these codes, please report the following at {}/issues:\n\nToken codes: {}\n\n",
        env!("CARGO_PKG_REPOSITORY"),
        names.join(", ")
    );
    text.push_str("| code | instruction | steps | count | example |\n|---|---|---|---|---|\n");
    for lesson in lessons {
        let example = lesson.uses.first().map(ToString::to_string);
        let example = plain(&example.unwrap_or_default()).replace('|', "\\|");
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | `{example}` |",
            lesson.shown(),
            lesson.mnemonic,
            lesson.steps(),
            lesson.uses.len()
        );
    }
    for lesson in lessons {
        if let Taken::Derived(other) | Taken::Guess(other) = &lesson.reading
            && !same(other, &lesson.mnemonic)
        {
            let _ = writeln!(text, "\n{} was read as {other} before.", lesson.shown());
        }
    }
    let version = env!("CARGO_PKG_VERSION");
    let _ = writeln!(
        text,
        "\nEditor: {editor}. CPU: {cpu}. Learned with rungc {version} from a list that the editor exported."
    );
    text
}
