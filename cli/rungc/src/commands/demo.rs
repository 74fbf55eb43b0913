//! `rungc demo`: an example project, and the tour of its commands.

use super::{Context, Outcome, Result, print_text};
use crate::args::DemoArgs;
use crate::output::write_new;
use std::fmt::Write;

/// The project: names and contents of its files.
pub(super) const FILES: [(&str, &str); 4] = [
    ("gate.il", include_str!("demo/gate.il")),
    ("gate.machine.toml", include_str!("demo/gate.machine.toml")),
    ("gate.plctest.toml", include_str!("demo/gate.plctest.toml")),
    ("rungc.toml", include_str!("demo/rungc.toml")),
];

/// The tour: commands for the project's folder, and what each shows. No word needs quotes in any shell, and none has a
/// comma, at which PowerShell would split it.
const TOUR: [(&str, &str); 7] = [
    ("rungc check", "reports errors and warnings, all at once"),
    (
        "rungc run --machine gate.machine.toml --set X000=1@1s --set X000=0@2s --for 13s",
        "presses the button: the simulated gate opens and closes",
    ),
    (
        "rungc why Y001 --machine gate.machine.toml --set X000=1@1s --set X000=0@2s --set X002=1@4s --for 13s",
        "explains why the gate does not close here",
    ),
    (
        "rungc test",
        "runs the cases of gate.plctest.toml, in virtual time",
    ),
    (
        "rungc verify",
        "proves the requirements of rungc.toml for all runs",
    ),
    (
        "rungc build --emit c -o plc",
        "writes C99 for your firmware",
    ),
    (
        "rungc serve --page --machine gate.machine.toml",
        "shows the ladder live in a browser, until Ctrl-C",
    ),
];

/// Writes the project into a folder and prints the tour.
pub fn run(args: &DemoArgs, cx: Context) -> Result {
    let folder = &args.folder;
    let files = FILES.map(|(name, text)| (folder.join(name), text.as_bytes()));
    write_new(&files)?;
    for (path, _) in &files {
        cx.note(&format!("       Wrote {}", path.display()));
    }
    let mut text = format!(
        "A sliding gate with its machine, tests and requirements. Try, in {}:\n",
        folder.display()
    );
    for (command, shows) in TOUR {
        // Writing to a String does not fail.
        let _ = write!(text, "\n  {command}\n      {shows}\n");
    }
    text +=
        "\n`rungc doctor` lists the tools that other commands need; `rungc book` is the manual.\n";
    print_text(&text)?;
    Ok(Outcome::Success)
}
