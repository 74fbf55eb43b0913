//! Packs the sources of the runtime and of libm, without their tests, into one compressed text, which the library
//! embeds.
//!
//! A published package has no neighbours to
//! pack; it carries the packed text as `sources.bin`, which `cargo xtask package` makes.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The runtime's package.
const RUNTIME: &str = "../rt";

/// The crate that it depends on.
const LIBM: &str = "vendor/libm";

/// The packed text of a published package.
const PUBLISHED: &str = "sources.bin";

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
    let manifest = fs::read_to_string(runtime.join("Cargo.toml"))?;
    let mut files = vec![("Cargo.toml".to_string(), manifest)];
    files.extend(rungc_packed::folder(Path::new(LIBM), "libm/")?);
    files.extend(rungc_packed::folder(&runtime.join("src"), "src/")?);
    let mut tests = Vec::new();
    for (name, text) in &mut files {
        *text = without_tests(text, &children(name), &mut tests);
    }
    files.retain(|(name, _)| {
        let mut rests = tests
            .iter()
            .filter_map(|module| name.strip_prefix(module.as_str()));
        !rests.any(|rest| rest == ".rs" || rest.starts_with('/'))
    });
    fs::write(out, rungc_packed::pack(files)?)
}

/// Folder of the modules that a file declares.
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
