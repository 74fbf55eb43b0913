//! `cargo xtask size`: how large the executable is, and what each crate takes of it.

use crate::{Problem, root};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Crates that are listed.
const LISTED: usize = 25;

/// Prints the size of an executable, and what each crate takes of its code if it has symbols.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// The executable; without it `target/release/rungc`.
    executable: Option<PathBuf>,
    /// Fail if it is larger than this many bytes or has symbols.
    #[arg(long, value_name = "BYTES")]
    most: Option<u64>,
}

/// Measures the executable.
pub fn run(args: &Args) -> Result<(), Problem> {
    let usual = || root().join("target/release/rungc");
    let executable = args.executable.clone().unwrap_or_else(usual);
    let size = std::fs::metadata(&executable);
    let size = size.map_err(|error| format!("{}: {error}", executable.display()))?;
    let size = size.len();
    println!("{size} bytes: {}", executable.display());
    let symbols = symbols(&executable)?;
    let mut crates: Vec<(String, u64)> = code(&symbols)?.into_iter().collect();
    crates.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    if symbols.is_empty() {
        println!("no symbols: build with CARGO_PROFILE_RELEASE_STRIP=false to see the crates");
    }
    for (name, bytes) in crates.iter().take(LISTED) {
        println!("{bytes:>9} {name}");
    }
    match args.most {
        Some(_) if !symbols.is_empty() => Err("it has symbols: `strip` has no effect".into()),
        Some(most) if size > most => Err(format!("it is larger than {most} bytes").into()),
        _ => Ok(()),
    }
}

/// All symbols of an executable, one a line; of a stripped one there are none.
fn symbols(executable: &Path) -> Result<String, Problem> {
    let output = Command::new("nm")
        .args(["--size-sort", "--print-size", "--demangle"])
        .arg(executable)
        .output()
        .map_err(|error| format!("nm: {error}"))?;
    if !output.status.success() {
        return Err(format!("nm: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Bytes of code by the crate that a function's name begins with. What a generic function of a library takes counts
/// for the library, whoever calls it.
fn code(symbols: &str) -> Result<BTreeMap<String, u64>, Problem> {
    let mut crates = BTreeMap::new();
    for line in symbols.lines() {
        let mut words = line.splitn(4, ' ').skip(1);
        if let (Some(size), Some("t" | "T"), Some(name)) =
            (words.next(), words.next(), words.next())
        {
            let name = name.trim_start_matches(|c: char| !c.is_alphanumeric());
            let end = name.find(|c: char| !c.is_alphanumeric() && c != '_');
            let name = &name[..end.unwrap_or(name.len())];
            *crates.entry(name.to_string()).or_default() += u64::from_str_radix(size, 16)?;
        }
    }
    Ok(crates)
}
