//! Output and drawings of the `rungc` command for the book.

use crate::generate::Made;
use crate::{Problem, root, tools};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The example programs, below the root.
const EXAMPLES: [&str; 4] = [
    "examples/programs",
    "examples/oven",
    "examples/kiln",
    "examples/tank",
];

/// The pages whose commands draw.
const PAGES: [&str; 5] = [
    "docs/src/machines.md",
    "docs/src/modules.md",
    "docs/src/ladder.md",
    "docs/src/diff.md",
    "docs/src/prove.md",
];

/// Options before the name of a diagram.
const DRAWING: [&str; 3] = ["--plot", "--scope", "-o"];

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
    let mut page = format!(
        "# Commands\n\nWhat `rungc help` and `rungc help COMMAND` print.\n\n```text\n{all}\n```\n"
    );
    for name in names(&all) {
        let text = help(&[name, "--help"])?;
        page += &format!("\n## {name}\n\n```text\n{text}\n```\n");
    }
    Ok(Made::file("docs/src/commands.md", page))
}

/// Names of the commands, in the output of `rungc --help`.
fn names(help: &str) -> impl Iterator<Item = &str> {
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    listed
        .take_while(|line| !line.is_empty())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
}

/// Names of the commands of an executable.
pub fn command_names(rungc: &Path) -> Result<Vec<String>, Problem> {
    let help = tools::output(Command::new(rungc).arg("--help"))?;
    Ok(names(&help).map(str::to_owned).collect())
}

/// The diagrams of these pages: what their commands draw.
pub fn diagrams() -> Result<Made, Problem> {
    let folder = tempfile::tempdir()?;
    for examples in EXAMPLES {
        let copies = folder.path().join(examples);
        fs::create_dir_all(&copies)?;
        for entry in fs::read_dir(root().join(examples))? {
            let entry = entry?;
            if entry.file_type()?.is_file() {
                fs::copy(entry.path(), copies.join(entry.file_name()))?;
            }
        }
    }
    let rungc = build()?;
    let mut made = Made::default();
    for path in PAGES {
        let before = made.files.len();
        draw(&rungc, folder.path(), path, &mut made)?;
        if made.files.len() == before {
            return Err(format!("{path} has no command that draws").into());
        }
    }
    Ok(made)
}

/// Draws the commands of a page, with the files that the page shows.
fn draw(rungc: &Path, folder: &Path, page: &str, made: &mut Made) -> Result<(), Problem> {
    let page = fs::read_to_string(root().join(page))?;
    for (name, text) in shown(&page) {
        fs::write(folder.join(name), text)?;
    }
    let commands = page
        .lines()
        .filter_map(|line| line.strip_prefix("$ rungc "));
    for command in commands {
        let command = command.split(" || ").next().unwrap_or(command);
        let args: Vec<_> = command.split(' ').collect();
        let draws = |pair: &&[&str]| DRAWING.contains(&pair[0]) && pair[1].ends_with(".svg");
        let Some(&[_, file]) = args.windows(2).find(draws) else {
            continue;
        };
        let ran = Command::new(rungc)
            .args(&args)
            .current_dir(folder)
            .output()?;
        // A comparison that finds a difference ends with 1.
        if ran.status.code() > Some(1) {
            let stderr = String::from_utf8_lossy(&ran.stderr);
            return Err(format!("{command}: {}\n{stderr}", ran.status).into());
        }
        let drawn = fs::read_to_string(folder.join(file))?;
        made.files.push((Path::new("docs/src").join(file), drawn));
    }
    Ok(())
}

/// The files that a page shows, in fences with their names: name and content.
fn shown(page: &str) -> Vec<(&str, &str)> {
    let fences = page.split("\n```").skip(1).step_by(2);
    let files = fences.filter_map(|fence| {
        let (info, text) = fence.split_once('\n')?;
        let (_, name) = info.split_once(' ')?;
        Some((name, text))
    });
    files.collect()
}

/// Names an executable of the command that is built already.
const EXECUTABLE: &str = "RUNGC_EXECUTABLE";

/// Path of the command, which is built unless [`EXECUTABLE`] is set.
pub fn build() -> Result<PathBuf, Problem> {
    if let Some(built) = env::var_os(EXECUTABLE) {
        return Ok(std::path::absolute(built)?);
    }
    built(&mut tools::cargo(&[
        "build",
        "--quiet",
        "--package",
        "rungc",
    ]))
}

/// Path of the executable that a cargo command builds.
pub fn built(cargo: &mut Command) -> Result<PathBuf, Problem> {
    let printed = tools::output(cargo.arg("--message-format=json-render-diagnostics"))?;
    let mut messages = printed.lines().filter_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        Some(PathBuf::from(message["executable"].as_str()?))
    });
    let executable = messages.next_back();
    executable.ok_or_else(|| "cargo has built no executable of rungc".into())
}

/// Output of the command in a folder.
fn run(rungc: &Path, folder: &Path, args: &[&str]) -> Result<String, Problem> {
    tools::output(Command::new(rungc).args(args).current_dir(folder))
}
