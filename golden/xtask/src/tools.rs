//! Calls of other programs, and what they make.

use crate::{Problem, root};
use rungc_benches::figures;
use std::env;
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::Command;

/// Cargo with these arguments, in the repository's root.
pub fn cargo(args: &[&str]) -> Command {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(args).current_dir(root());
    command
}

/// Standard output of a program. If it fails, the error shows what it printed on standard error.
pub fn output(command: &mut Command) -> Result<String, Problem> {
    let output = command.output()?;
    if !output.status.success() {
        let stderr = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{command:?}: {}\n{stderr}", output.status).into());
    }
    Ok(String::from_utf8(output.stdout)?)
}

/// Runs a program that prints for itself.
pub fn run(command: &mut Command) -> Result<(), Problem> {
    let status = command.status()?;
    match status.success() {
        true => Ok(()),
        false => Err(format!("{command:?}: {status}").into()),
    }
}

/// Resources of emitted C on a microcontroller, as recorded in `golden/benches/figures.toml`.
pub fn figures() -> Result<String, Problem> {
    Ok(figures::record(&figures::measure()?)?)
}

/// Measures everything and puts the tables into the page on benchmarks.
pub fn benchmarks() -> Result<(), Problem> {
    let args = ["run", "--release", "--package", "rungc-benches", "--"];
    run(cargo(&args).args(["--update", "docs/src/benchmarks.md"]))
}

/// Runs all tests and takes their snapshots as they come.
pub fn snapshots() -> Result<(), Problem> {
    let args = ["test", "--workspace", "--no-fail-fast"];
    run(cargo(&args).envs([("INSTA_UPDATE", "always"), ("INSTA_FORCE_PASS", "1")]))
}

/// Length of a PNG's head: its signature, and a header with width and height.
const PNG_HEAD: usize = 24;

/// Takes the book's pictures of pages from tests in a browser, and puts them into the book. If they are only checked,
/// those that stand there have to be of the same size: what they show differs from time to time.
pub fn screens(check: bool) -> Result<(), Problem> {
    let taken = root().join("target/screens");
    if taken.exists() {
        fs::remove_dir_all(&taken)?;
    }
    fs::create_dir_all(&taken)?;
    for (filter, picture, page) in [
        (
            "live::a_live_page_works_in_a_browser",
            "live-light.png",
            "live.png",
        ),
        (
            "browser::coverage_is_drawn",
            "coverage-light.png",
            "coverage.png",
        ),
    ] {
        let args = ["test", "-p", "rungc", "--test", "it", filter];
        run(cargo(&args).env("RUNGC_PICTURES", &taken))?;
        let (taken, stored) = (taken.join(picture), root().join("docs/src").join(page));
        let unseen = |error| format!("{}: {error}: is RUNGC_BROWSER set?", taken.display());
        if !check {
            fs::copy(&taken, stored).map_err(unseen)?;
        } else if !fs::read(&taken)
            .map_err(unseen)?
            .starts_with(&head(&stored)?)
        {
            return Err(format!(
                "{page} has another size than the page: cargo xtask generate screens"
            )
            .into());
        }
    }
    Ok(())
}

/// The signature of a PNG with its width and height.
fn head(picture: &Path) -> Result<[u8; PNG_HEAD], Problem> {
    let mut head = [0; PNG_HEAD];
    fs::File::open(picture)?.read_exact(&mut head)?;
    Ok(head)
}
