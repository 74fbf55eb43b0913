//! Packs the sources of the runtime and of libm, without their tests, into one deflated text, which the library embeds.
//!
//! The packed text is a sequence of paths and contents, each ended by NUL. A published package has no neighbours to
//! pack; it carries the packed text as `sources.bin`, which `cargo xtask package` makes.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The runtime's package.
const RUNTIME: &str = "../runtime-rt";

/// The crate that it depends on.
const LIBM: &str = "vendor/libm";

/// The packed text of a published package.
const PUBLISHED: &str = "sources.bin";

/// How hard to compress: the best ratio, in about a second.
const LEVEL: u8 = 9;

fn main() -> io::Result<()> {
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let out = PathBuf::from(out).join(PUBLISHED);
    let runtime = Path::new(RUNTIME);
    if !runtime.exists() {
        println!("cargo::rerun-if-changed={PUBLISHED}");
        return fs::copy(PUBLISHED, out).map(drop);
    }
    println!("cargo::rerun-if-changed={RUNTIME}");
    println!("cargo::rerun-if-changed={LIBM}");
    let mut files = vec![("Cargo.toml".to_string(), runtime.join("Cargo.toml"))];
    list(&runtime.join("src"), "src/", &mut files)?;
    list(Path::new(LIBM), "libm/", &mut files)?;
    files.sort();
    let mut kept = Vec::new();
    let mut tests = Vec::new();
    for (name, path) in files {
        // Anything but text in these folders is not part of a crate.
        let Ok(content) = fs::read_to_string(&path) else {
            continue;
        };
        if content.contains('\0') {
            return Err(io::Error::other(format!("{} holds NUL", path.display())));
        }
        let content = without_tests(&content, &children(&name), &mut tests);
        kept.push((name, content));
    }
    let is_test = |name: &str| {
        let mut rests = tests
            .iter()
            .filter_map(|module| name.strip_prefix(module.as_str()));
        rests.any(|rest| rest == ".rs" || rest.starts_with('/'))
    };
    let mut text = Vec::new();
    for (name, content) in kept.into_iter().filter(|(name, _)| !is_test(name)) {
        for part in [name, content] {
            text.extend_from_slice(part.as_bytes());
            text.push(0);
        }
    }
    fs::write(out, miniz_oxide::deflate::compress_to_vec(&text, LEVEL))
}

/// Where the modules lie that a file declares.
fn children(name: &str) -> String {
    let folder = name.strip_suffix("mod.rs").or(name.strip_suffix("lib.rs"));
    let folder = folder.or(name.strip_suffix(".rs")).unwrap_or(name);
    format!("{}/", folder.trim_end_matches('/'))
}

/// A source as rustfmt lays it out, without the items that only tests have. Modules among them that are files of
/// their own are added to `tests`, by their paths without an ending.
fn without_tests(source: &str, children: &str, tests: &mut Vec<String>) -> String {
    let mut kept = Vec::new();
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        if line != "#[cfg(test)]" {
            kept.push(line);
            continue;
        }
        while kept.pop_if(|line| line.starts_with("///")).is_some() {}
        let is_item = |line: &&str| !line.starts_with("#[") && !line.starts_with("//");
        let item = lines.by_ref().find(is_item).unwrap_or_default();
        let declared = item.trim_start_matches("pub ").strip_prefix("mod ");
        match declared.and_then(|name| name.strip_suffix(';')) {
            Some(module) => tests.push(format!("{children}{module}")),
            None => lines
                .by_ref()
                .take_while(|&line| line != "}")
                .for_each(drop),
        }
    }
    while kept.pop_if(|line| line.is_empty()).is_some() {}
    kept.join("\n") + "\n"
}

/// The files of a folder and its folders, named by what follows `prefix`.
fn list(folder: &Path, prefix: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), files)?;
        } else {
            files.push((name, entry.path()));
        }
    }
    Ok(())
}
