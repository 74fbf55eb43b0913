//! The engine of a search.

use super::Searched;
use crate::args::SearchEngine;
use crate::commands::test::BuildFolder;
use crate::commands::{Context, Failure};
use crate::progress;
use rungc_explore::lanes::build;
use rungc_explore::wide::refusal;
use rungc_sim::engines::BuildError;
use std::path::PathBuf;

/// From this many scans on, lanes are worth the time that the C compiler takes.
const WORTH_COMPILING: u64 = 1_000_000;

/// Lanes that have been built.
pub struct Built {
    pub executable: PathBuf,
    /// Folder of the executables, until the search is over.
    _folder: BuildFolder,
}

impl Searched<'_> {
    /// Builds the lanes that the search takes; `None` if the interpreter executes it.
    pub fn lanes(&self, cx: Context) -> Result<Option<Built>, Failure> {
        let wanted = match self.args.engine {
            SearchEngine::Interp => return Ok(None),
            SearchEngine::Auto if self.args.scans < WORTH_COMPILING => return Ok(None),
            SearchEngine::Auto => false,
            SearchEngine::Lanes => true,
        };
        let without = |why: String| match wanted {
            true => Err(Failure::Because(format!("`--engine lanes`: {why}"))),
            false => {
                cx.note(&format!("    Without lanes: {why}"));
                Ok(None)
            }
        };
        if let Some(reason) = refusal(self.task) {
            return without(format!("the program {reason}"));
        }
        let folder = BuildFolder::take()?;
        let lanes = folder.path().join("lanes");
        match progress::spin("building lanes", || build(self.task, &lanes)) {
            Ok(executable) => Ok(Some(Built {
                executable,
                _folder: folder,
            })),
            Err(BuildError::Io { what, error }) if what == "cc" => {
                without(format!("the C compiler `cc` does not start: {error}"))
            }
            Err(error) => Err(Failure::Because(error.to_string())),
        }
    }
}
