//! The runtime in a separate folder, which emitted crates share.

use super::{Built, at, bytes, write_folder};
use crate::output::resolved;
use rungc_codegen_rust::Runtime;
use rungc_emit::OutFile;
use rungc_runtime_sources::library;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Writes the runtime into a folder that does not have it yet; where a crate to be emitted finds it. A relative path
/// stays relative, so that both can be moved together.
pub(super) fn shared(folder: &Path, package: &Path, force: bool) -> Built<Runtime> {
    let files = library::sources(true);
    if !holds(folder, &files) {
        let sources = files.iter().map(|(path, text)| OutFile::new(path, text));
        let written = write_folder(folder, &bytes(sources.collect()), force);
        // Another process has written it in the meantime.
        if !holds(folder, &files) {
            written?;
        }
    }
    let path = match folder.is_absolute() {
        true => folder.to_owned(),
        false => {
            let package = resolved(package).map_err(|error| at(package, error))?;
            let folder = resolved(folder).map_err(|error| at(folder, error))?;
            relative(&package, &folder)
        }
    };
    Ok(Runtime::At(path.to_string_lossy().into_owned()))
}

/// Returns true if a folder has the runtime of this version.
fn holds(folder: &Path, files: &[(String, String)]) -> bool {
    let is_there = |(path, text): &(String, String)| {
        fs::read(folder.join(path)).is_ok_and(|bytes| bytes == text.as_bytes())
    };
    files.iter().all(is_there)
}

/// The way from one folder to another, with slashes as manifests have them.
fn relative(from: &Path, to: &Path) -> PathBuf {
    let same = from.components().zip(to.components());
    let same = same.take_while(|(from, to)| from == to).count();
    let up = from.components().skip(same).map(|_| Component::ParentDir);
    let words = up.chain(to.components().skip(same));
    let words: Vec<_> = words
        .map(|word| word.as_os_str().to_string_lossy())
        .collect();
    PathBuf::from(words.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_up_and_down() {
        for (from, to, way) in [
            ("/a/b", "/a/rt", "../rt"),
            ("/a/b", "/a/b/rt", "rt"),
            ("/a/b/c", "/rt/d", "../../../rt/d"),
        ] {
            assert_eq!(relative(Path::new(from), Path::new(to)), Path::new(way));
        }
    }
}
