//! `cargo xtask sources`: how much of the structured text of real projects is compiled to the instructions that GX
//! Works2 made of it.

use crate::Problem;
use rungc::sources::{Comparison, Other};
use rungc_lower::compile::{CompileOptions, model};
use std::path::{Path, PathBuf};

/// Options of the chore.
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folders with projects of GX Works2.
    #[arg(required = true)]
    folders: Vec<PathBuf>,
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
            let Some(found) = is_project.then(|| compared(&path)).flatten() else {
                continue;
            };
            println!("{}: {}", path.display(), line(&found));
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

fn compared(path: &Path) -> Option<Comparison> {
    let read = rungc_frontend::read(path).ok()?;
    let model = model(&read.program, &CompileOptions::default());
    Comparison::new(&read, model)
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
