//! The sources of `rungc-rt` as data: emitted crates depend on them by path, emitted C links the static library built from them.

use include_dir::{Dir, include_dir};

/// Everything below `src`.
static SRC: Dir = include_dir!("$CARGO_MANIFEST_DIR/../runtime-rt/src");

/// The manifest.
static MANIFEST: &str = include_str!("../../runtime-rt/Cargo.toml");

/// The files of the crate, by their paths relative to its folder, in a fixed order: `Cargo.toml`, then `src/…`.
pub fn files() -> Vec<(String, String)> {
    let mut files = Vec::new();
    collect(&SRC, &mut files);
    files.sort();
    files.insert(0, ("Cargo.toml".to_string(), manifest()));
    files
}

/// The manifest without what only tests need: that is inherited from a workspace which is not there.
fn manifest() -> String {
    let mut kept = String::new();
    let mut is_for_tests = false;
    for line in MANIFEST.lines() {
        if line.starts_with('[') {
            is_for_tests = line.starts_with("[dev-dependencies");
        }
        if !is_for_tests {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

fn collect(dir: &Dir<'static>, files: &mut Vec<(String, String)>) {
    for file in dir.files() {
        // Sources are UTF-8; anything else in the folder is none of the crate's.
        if let Some(text) = file.contents_utf8() {
            files.push((format!("src/{}", file.path().display()), text.to_string()));
        }
    }
    for dir in dir.dirs() {
        collect(dir, files);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crate_is_whole() {
        let files = files();
        let has = |path: &str| files.iter().any(|(p, _)| p == path);
        assert!(has("Cargo.toml") && has("src/lib.rs") && has("src/fnc/data.rs"));
        assert!(!files[0].1.contains("workspace"), "stands alone");
    }
}
