//! Packs the sources of the runtime and of libm into one deflated text, which the library embeds.
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
    let mut text = Vec::new();
    for (name, path) in files {
        // Anything but text in these folders is not part of a crate.
        let Ok(content) = fs::read_to_string(&path) else {
            continue;
        };
        if content.contains('\0') {
            return Err(io::Error::other(format!("{} holds NUL", path.display())));
        }
        for part in [name, content] {
            text.extend_from_slice(part.as_bytes());
            text.push(0);
        }
    }
    fs::write(out, miniz_oxide::deflate::compress_to_vec(&text, LEVEL))
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
