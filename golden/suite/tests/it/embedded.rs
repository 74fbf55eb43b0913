//! Folders whose files are embedded where they are used: no file is left over.

use std::fs;
use std::path::PathBuf;
use walkdir::WalkDir;

/// Folders, the sources that embed their files, and the macro by which they do.
const FOLDERS: &[(&str, &str, &str)] = &[
    ("codegen-c/include", "codegen-c/src", "template!"),
    ("codegen-rust/templates", "codegen-rust/src", "template!"),
    ("firmware/templates", "firmware/src", "template!"),
    ("firmware/boards", "firmware/src", "known!"),
    ("cli/live/assets", "cli/live/src", "asset!"),
];

/// Source of the machine code in `firmware/src/image/boot2.rs`.
const ASSEMBLED: &str = "boot2.s";

/// The files of a folder and its folders.
fn files(folder: &str) -> Vec<PathBuf> {
    let root = PathBuf::from(env!("RUNGC_ROOT"));
    let entries = WalkDir::new(root.join(folder)).into_iter().flatten();
    let files = entries.filter(|entry| entry.file_type().is_file());
    files.map(walkdir::DirEntry::into_path).collect()
}

#[test]
fn every_file_is_embedded() {
    for (folder, sources, embedding) in FOLDERS {
        let sources = files(sources).into_iter();
        let code: String = sources
            .map(|path| fs::read_to_string(path).unwrap())
            .collect();
        let root = PathBuf::from(env!("RUNGC_ROOT")).join(folder);
        for path in files(folder) {
            let name = path.strip_prefix(&root).unwrap().to_str().unwrap();
            let name = name.strip_suffix(".toml").unwrap_or(name);
            let used = code.contains(&format!("{embedding}(\"{name}\")"));
            assert!(used || name == ASSEMBLED, "{folder}/{name} is not embedded");
        }
    }
}
