//! Being called by Git, as the diff driver of a path: `path old-file old-hex old-mode new-file new-hex new-mode`, and
//! for a path that was renamed the new path and the messages about it (gitattributes(5), gitdiffcore(7)).

use super::{Side, eprint_line, print_text, report};
use crate::args::DiffArgs;
use crate::commands::{Context, Failure, Outcome, Result};
use std::path::{Path, PathBuf};

/// Path by which Git denotes a missing file.
const ABSENT: &str = "/dev/null";

/// Comparison requested by Git.
pub struct Call<'a> {
    /// The path in the repository, before and now.
    paths: [&'a Path; 2],
    /// Paths of the contents.
    files: [&'a Path; 2],
}

/// The arguments of a diff driver.
pub fn call(files: &[PathBuf]) -> Option<Call<'_>> {
    let (path, old, new, renamed) = match files {
        [path, old, _, _, new, _, _] => (path, old, new, path),
        [path, old, _, _, new, _, _, renamed, _] => (path, old, new, renamed),
        _ => return None,
    };
    Some(Call {
        paths: [path, renamed],
        files: [old, new],
    })
}

/// Compares what Git names. Git takes any other exit code than 0 for a driver that has crashed, and shows no more.
pub fn run(call: &Call, args: &DiffArgs, cx: Context) -> Result {
    let side = |at: usize| match call.files[at] == Path::new(ABSENT) {
        true => Ok(Side::absent(call.paths[at])),
        false => Side::read(call.files[at], call.paths[at].to_owned(), args, cx),
    };
    match (side(0), side(1)) {
        (Ok(old), Ok(new)) => _ = report(&old, &new, args)?,
        (Err(failure), _) | (_, Err(failure)) => match failure {
            Failure::BrokenPipe => return Err(failure),
            Failure::Because(why) => print_text(&format!("{}: {why}\n", call.paths[1].display()))?,
            Failure::Reported => eprint_line(&format!(
                "rungc: {} is not compared",
                call.paths[1].display()
            )),
        },
    }
    Ok(Outcome::Success)
}
