//! Parts shared by the programs of one `rungc build` that are written into one folder.

use super::{Context, Failure, counted};
use crate::output::{spare, write_file};
use rungc_firmware::sources::{self, Recipe};
use rungc_firmware::target::Target;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Location and target of a program's output.
#[derive(Clone, Debug)]
pub struct Place {
    /// The folder of the programs' folders.
    pub folder: PathBuf,
    /// Target.
    pub target: &'static Target,
    /// True if existing files are replaced.
    pub force: bool,
}

/// The programs written by now, by their folder.
#[derive(Default)]
pub struct Together(BTreeMap<PathBuf, (Place, Vec<Recipe>)>);

impl Together {
    /// The recipes of a folder, to which that of one more program is added. Fails where its Makefile cannot be written,
    /// or where another program there has another target.
    pub fn at(&mut self, place: Place) -> Result<&mut Vec<Recipe>, Failure> {
        spare(&place.folder.join("Makefile"), place.force)?;
        let target = place.target;
        let (first, recipes) = self
            .0
            .entry(place.folder.clone())
            .or_insert_with(|| (place, Vec::new()));
        if first.target != target {
            return Err(Failure::Because(format!(
                "{}: one Makefile cannot build for {} and for {}; build these programs separately",
                first.folder.display(),
                first.target.triple,
                target.triple
            )));
        }
        Ok(recipes)
    }

    /// Writes what the programs share: headers, the runtime's sources and the Makefile.
    pub fn write(self, cx: Context) -> Result<(), Failure> {
        for (place, recipes) in self.0.into_values() {
            if recipes.is_empty() {
                continue;
            }
            let files = sources::c_together(&recipes, place.target);
            let paths = files.iter().map(|file| place.folder.join(&file.path));
            let paths: Vec<PathBuf> = paths.collect();
            for path in &paths {
                spare(path, place.force)?;
            }
            for (path, file) in paths.iter().zip(&files) {
                write_file(path, file.contents.as_bytes(), place.force)?;
            }
            let makefile = place.folder.join("Makefile");
            let programs = counted(recipes.len(), "program");
            cx.note(&format!(
                "{:>11} {} for {programs}",
                "Emitted",
                makefile.display()
            ));
        }
        Ok(())
    }
}
