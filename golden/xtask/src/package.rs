//! `cargo xtask package`.

use crate::{Problem, root, tools};
use rungc_golden::workspace;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Publish all crates that are meant for it; without `--publish`, do everything but upload: each crate must build from
/// its package alone.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Upload the packages, in the order of their dependencies.
    #[arg(long)]
    publish: bool,
    /// Only make the packages, without building them.
    #[arg(long, conflicts_with = "publish")]
    no_verify: bool,
}

/// Publishes all crates, or does so but for the upload, except those with `publish = false`.
pub fn run(args: &Args) -> Result<(), Problem> {
    // Cargo would count the sources below, which git ignores, as a change that is not committed.
    let changes = tools::output(
        Command::new("git")
            .args(["status", "--porcelain"])
            .current_dir(root()),
    )?;
    if !changes.is_empty() {
        return Err(format!("commit these changes first:\n{changes}").into());
    }
    // The runtime's sources lie beside the crate that embeds them, and packages have no neighbours.
    let published = root().join("runtime-rt/sources/published");
    for (path, text) in rungc_runtime_sources::EMBEDDED {
        // Cargo takes a folder with a manifest for another package.
        let path = published.join(path.replace("Cargo.toml", "manifest.toml"));
        fs::create_dir_all(path.parent().unwrap_or(&published))?;
        fs::write(path, text)?;
    }
    // So does the book, whose pages the command prints.
    let book = root().join("cli/rungc/published");
    copy_pages(&root().join("docs/src"), &book)?;
    let mut cargo = tools::cargo(&["publish", "--workspace", "--locked", "--allow-dirty"]);
    if !args.publish {
        cargo.arg("--dry-run");
    }
    let crates = workspace::crates(&root())?;
    for (private, _) in crates.iter().filter(|(_, one)| !one.is_published) {
        cargo.args(["--exclude", private]);
    }
    if args.no_verify {
        cargo.arg("--no-verify");
    }
    let done = tools::run(&mut cargo);
    fs::remove_dir_all(published)?;
    fs::remove_dir_all(book)?;
    done
}

/// Copies the pages in a folder and its folders.
fn copy_pages(from: &Path, to: &Path) -> Result<(), Problem> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let path = entry?.path();
        let Some(name) = path.file_name() else {
            continue;
        };
        if path.is_dir() {
            copy_pages(&path, &to.join(name))?;
        } else if path.extension().is_some_and(|ending| ending == "md") {
            fs::copy(&path, to.join(name))?;
        }
    }
    Ok(())
}
