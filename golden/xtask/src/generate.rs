//! `cargo xtask generate`.

use crate::{Problem, book, crates, header, root, rungc, tools};
use clap::ValueEnum;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Write the generated files, or check that they are up to date.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// What to make [default: everything that comes out the same on every machine]
    what: Vec<What>,
    /// Write nothing; fail if a file is not up to date.
    #[arg(long)]
    check: bool,
}

/// A group of generated files.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum What {
    /// codegen-c/include/rungc_rt.h, from the runtime's C ABI.
    Header,
    /// The pages of the book on checks, instructions, special devices and special modules.
    Book,
    /// docs/src/commands.md, from --help.
    Commands,
    /// The table of crates in ARCHITECTURE.md.
    Crates,
    /// The diagrams of the book, drawn by the commands on its pages.
    Diagram,
    /// golden/benches/figures.toml, measured with the Arm compiler and QEMU; `cargo test -p rungc-benches` compares.
    Figures,
    /// The tables of docs/src/benchmarks.md, measured on this machine in a release build.
    Benchmarks,
    /// The snapshots of all tests; review what changed.
    Snapshots,
    /// The picture of the live page in the book, taken in Chromium (`RUNGC_BROWSER`).
    Screens,
}

impl What {
    /// Outputs that are the same on every machine.
    const SAME_EVERYWHERE: [What; 5] = [
        What::Header,
        What::Book,
        What::Commands,
        What::Crates,
        What::Diagram,
    ];
}

/// Generated files, by their paths below the root.
#[derive(Default)]
pub struct Made {
    /// Paths and contents.
    pub files: Vec<(PathBuf, String)>,
    /// Folders that hold nothing else.
    pub folders: Vec<PathBuf>,
}

impl Made {
    /// A single file.
    pub fn file(path: &str, text: String) -> Self {
        Made {
            files: vec![(path.into(), text)],
            folders: Vec::new(),
        }
    }
}

/// Writes or checks what the command line names.
pub fn run(args: &Args) -> Result<(), Problem> {
    let what = match &args.what[..] {
        [] => &What::SAME_EVERYWHERE,
        named => named,
    };
    let mut stale = Vec::new();
    for &what in what {
        let made = match what {
            What::Header => header::make()?,
            What::Book => book::make()?,
            What::Commands => rungc::commands()?,
            What::Crates => crates::make()?,
            What::Diagram => rungc::diagrams()?,
            What::Figures | What::Benchmarks | What::Snapshots if args.check => {
                return Err(format!(
                    "{} cannot be checked here: cargo test does that where it can be done",
                    what.to_possible_value()
                        .map_or_else(String::new, |v| v.get_name().into())
                )
                .into());
            }
            What::Figures => Made::file("golden/benches/figures.toml", tools::figures()?),
            What::Benchmarks => {
                tools::benchmarks()?;
                continue;
            }
            What::Snapshots => {
                tools::snapshots()?;
                continue;
            }
            What::Screens => {
                tools::screens(args.check)?;
                continue;
            }
        };
        stale.extend(apply(&root(), &made, args.check)?);
    }
    for path in &stale {
        let verb = if args.check { "stale" } else { "written" };
        println!("{verb}: {}", path.display());
    }
    if args.check && !stale.is_empty() {
        return Err("generated files are not up to date: run `cargo xtask generate`".into());
    }
    Ok(())
}

/// Writes the files that differ and removes those that are no longer generated, unless they are only checked; gives
/// their paths.
fn apply(root: &Path, made: &Made, check: bool) -> Result<Vec<PathBuf>, Problem> {
    let mut stale = Vec::new();
    for (path, text) in &made.files {
        let place = root.join(path);
        if fs::read_to_string(&place).is_ok_and(|there| there == *text) {
            continue;
        }
        if !check {
            fs::create_dir_all(place.parent().unwrap_or(root))?;
            fs::write(&place, text)?;
        }
        stale.push(path.clone());
    }
    let current: BTreeSet<&Path> = made.files.iter().map(|(path, _)| path.as_path()).collect();
    for folder in &made.folders {
        for entry in fs::read_dir(root.join(folder))? {
            let path = folder.join(entry?.file_name());
            if current.contains(&*path) {
                continue;
            }
            if !check {
                fs::remove_file(root.join(&path))?;
            }
            stale.push(path);
        }
    }
    Ok(stale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stale_files_are_found_and_made_anew() {
        let root = tempfile::tempdir().unwrap();
        let made = Made {
            files: vec![("a/new".into(), "1".into()), ("a/same".into(), "2".into())],
            folders: vec!["a".into()],
        };
        fs::create_dir(root.path().join("a")).unwrap();
        fs::write(root.path().join("a/same"), "2").unwrap();
        fs::write(root.path().join("a/gone"), "3").unwrap();
        let stale = apply(root.path(), &made, true).unwrap();
        assert_eq!(stale, [PathBuf::from("a/new"), PathBuf::from("a/gone")]);
        assert!(
            root.path().join("a/gone").exists(),
            "checking writes nothing"
        );
        assert_eq!(apply(root.path(), &made, false).unwrap(), stale);
        assert!(apply(root.path(), &made, true).unwrap().is_empty());
    }
}
