//! `cargo xtask sources`: how much of the structured text of real projects is compiled to the instructions that GX
//! Works2 made of it.

mod behaviour;

use crate::Problem;
use behaviour::Effort;
use rungc::sources::{Comparison, Other};
use rungc_frontend::Read;
use rungc_lower::compile::{CompileOptions, model};
use std::path::{Path, PathBuf};

/// Options of the chore.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folders with projects of GX Works2.
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// Also run the source and its compiled copy with the same random inputs for this many scans, and compile the files
    /// that `convert --to st` writes.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    scans: u32,
    /// Random seed.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// With --scans, also prove that their outputs are the same, with this limit of the effort.
    #[arg(long, value_name = "NUMBER", default_value_t = 0)]
    proofs: u64,
}

/// Compares the programs in structured text of all projects, and prints each statement that is not equal.
///
/// # Errors
///
/// A folder cannot be read, or none of its projects has structured text.
pub fn run(args: &Args) -> Result<(), Problem> {
    let mut total = Comparison::default();
    for folder in &args.folders {
        for path in rungc_frontend::programs(folder, 9)? {
            let is_project = path
                .extension()
                .is_some_and(|ending| ending.eq_ignore_ascii_case("gxw"));
            let Some((read, found)) = is_project.then(|| compared(&path)).flatten() else {
                continue;
            };
            println!("{}: {}", path.display(), line(&found));
            if args.scans > 0 {
                let effort = Effort {
                    scans: args.scans,
                    seed: args.seed,
                    proofs: args.proofs,
                };
                println!("  {}", behaviour::compared(&read, &effort)?);
            }
            for Other {
                file,
                line,
                text,
                is_compiled,
            } in &found.others
            {
                let what = if *is_compiled {
                    "differs"
                } else {
                    "not compiled"
                };
                println!("  {what}: {file} line {line}: {text}");
            }
            total.statements += found.statements;
            total.equal += found.equal;
            total.others.extend(found.others);
        }
    }
    if total.statements == 0 {
        return Err("no project there has a program in structured text".into());
    }
    println!("all: {}", line(&total));
    Ok(())
}

fn compared(path: &Path) -> Option<(Read, Comparison)> {
    let read = rungc_frontend::read(path).ok()?;
    let model = model(&read.program, &CompileOptions::default());
    let found = Comparison::new(&read, model)?;
    Some((read, found))
}

fn line(found: &Comparison) -> String {
    let unknown = found
        .others
        .iter()
        .filter(|other| !other.is_compiled)
        .count();
    let whole = if found.is_whole {
        ", and nothing else"
    } else {
        ""
    };
    format!(
        "{} statements, {} compiled, {} equal{whole}",
        found.statements,
        found.statements - unknown,
        found.equal
    )
}
