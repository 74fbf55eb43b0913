//! What the `rungc` command prints and draws for the book.

use crate::generate::Made;
use crate::{Problem, root, tools};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The example programs, below the root.
const EXAMPLES: &str = "examples/programs";

/// Options before the name of a diagram.
const DRAWING: [&str; 2] = ["--plot", "--scope"];

/// The page on commands: what `rungc help` prints.
pub fn commands() -> Result<Made, Problem> {
    let rungc = build()?;
    let folder = tempfile::tempdir()?;
    let help = |args: &[&str]| -> Result<String, Problem> {
        let printed = run(&rungc, folder.path(), args)?;
        let lines: Vec<_> = printed.lines().map(str::trim_end).collect();
        Ok(lines.join("\n").trim_end().to_owned())
    };
    let all = help(&["--help"])?;
    let listed = all.lines().skip_while(|line| *line != "Commands:").skip(1);
    let names = listed
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help");
    let mut page = format!(
        "# Commands\n\nWhat `rungc help` and `rungc help COMMAND` print.\n\n```text\n{all}\n```\n"
    );
    for name in names {
        let text = help(&[name, "--help"])?;
        page += &format!("\n## {name}\n\n```text\n{text}\n```\n");
    }
    Ok(Made::file("docs/src/commands.md", page))
}

/// The diagrams of the page on machines: what its commands draw.
pub fn diagrams() -> Result<Made, Problem> {
    let page = fs::read_to_string(root().join("docs/src/machines.md"))?;
    let commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("$ rungc "));
    let folder = tempfile::tempdir()?;
    let examples = folder.path().join(EXAMPLES);
    fs::create_dir_all(&examples)?;
    for entry in fs::read_dir(root().join(EXAMPLES))? {
        let entry = entry?;
        if entry.file_type()?.is_file() {
            fs::copy(entry.path(), examples.join(entry.file_name()))?;
        }
    }
    let rungc = build()?;
    let mut made = Made::default();
    for command in commands {
        let args: Vec<_> = command.split(' ').collect();
        let draws = |pair: &&[&str]| DRAWING.contains(&pair[0]);
        let Some(&[_, file]) = args.windows(2).find(draws) else {
            continue;
        };
        run(&rungc, folder.path(), &args)?;
        let drawn = fs::read_to_string(folder.path().join(file))?;
        made.files.push((Path::new("docs/src").join(file), drawn));
    }
    match made.files.is_empty() {
        true => Err("docs/src/machines.md has no command that draws".into()),
        false => Ok(made),
    }
}

/// Builds the command; gives its place.
fn build() -> Result<PathBuf, Problem> {
    let mut cargo = tools::cargo(&["build", "--quiet", "--package", "rungc"]);
    let printed = tools::output(cargo.arg("--message-format=json-render-diagnostics"))?;
    let mut messages = printed.lines().filter_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        Some(PathBuf::from(message["executable"].as_str()?))
    });
    let executable = messages.next_back();
    executable.ok_or_else(|| "cargo has built no executable of rungc".into())
}

/// What the command prints in a folder.
fn run(rungc: &Path, folder: &Path, args: &[&str]) -> Result<String, Problem> {
    tools::output(Command::new(rungc).args(args).current_dir(folder))
}
