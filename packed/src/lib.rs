//! Texts that an executable carries compressed, as LZMA: build scripts pack them, and [`Packed`] unpacks them when one
//! is first asked for.
//!
//! The crate must not know what the texts are. Start reading at [`Packed`].

use lzma_rust2::{LzmaOptions, LzmaReader, LzmaWriter};
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::path::Path;
use std::sync::OnceLock;
use std::{env, fs, io};

/// Enough memory for the largest dictionary, in KiB.
const MEMORY: u32 = 16 << 10;

/// How hard to compress: a dictionary of 4 MiB, which no texts exceed.
const PRESET: u32 = 5;

/// Packed texts with their names.
pub struct Packed {
    bytes: &'static [u8],
    texts: OnceLock<Vec<(String, String)>>,
}

impl Packed {
    /// Texts that a build script packed with [`pack`].
    pub const fn new(bytes: &'static [u8]) -> Self {
        let texts = OnceLock::new();
        Packed { bytes, texts }
    }

    /// As they are packed.
    pub fn bytes(&self) -> &'static [u8] {
        self.bytes
    }

    /// All texts with their names, in the order in which they were packed.
    pub fn texts(&self) -> &[(String, String)] {
        self.texts.get_or_init(|| {
            let mut text = String::new();
            let unpacked = LzmaReader::new_mem_limit(self.bytes, MEMORY, None)
                .and_then(|mut reader| reader.read_to_string(&mut text));
            unpacked.expect("the build script packs text");
            let parts: Vec<&str> = text.split_terminator('\0').collect();
            let texts = parts.chunks_exact(2);
            texts.map(|text| (text[0].into(), text[1].into())).collect()
        })
    }

    /// The names of all texts.
    pub fn names(&self) -> BTreeSet<String> {
        self.texts().iter().map(|(name, _)| name.clone()).collect()
    }

    /// The text of this name.
    ///
    /// # Panics
    ///
    /// If there is none: names are written in the program, and each of its texts is used by a test.
    pub fn text(&self, name: &str) -> &str {
        let text = self.texts().iter().find(|(packed, _)| packed == name);
        text.map(|(_, text)| text.as_str())
            .unwrap_or_else(|| panic!("`{name}` is not packed"))
    }
}

/// The names that the sources in a folder ask for by calls of `function` with a literal, each once and in order: for
/// tests, which compare them with [`Packed::names`].
pub fn used(sources: &Path, function: &str) -> io::Result<BTreeSet<String>> {
    let call = format!("{function}(");
    let mut names = BTreeSet::new();
    for (_, source) in folder(sources, "")? {
        let arguments = source.split(call.as_str()).skip(1);
        let literals = arguments.filter_map(|rest| rest.trim_start().strip_prefix('"'));
        names.extend(literals.filter_map(|rest| Some(rest.split_once('"')?.0.to_string())));
    }
    Ok(names)
}

/// Packs texts with their names: a compressed sequence of names and texts, each ended by NUL. A text that holds NUL is
/// an error.
pub fn pack(texts: impl IntoIterator<Item = (String, String)>) -> io::Result<Vec<u8>> {
    let mut sequence = String::new();
    for (name, text) in texts {
        if name.contains('\0') || text.contains('\0') {
            return Err(io::Error::other(format!("`{name}` holds NUL")));
        }
        for part in [name, text] {
            sequence += &part;
            sequence.push('\0');
        }
    }
    // Text has no columns of words, and its letters depend on more than those just before them.
    let options = LzmaOptions {
        lc: 4,
        pb: 0,
        ..LzmaOptions::with_preset(PRESET)
    };
    let length = Some(sequence.len() as u64);
    let mut writer = LzmaWriter::new_use_header(Vec::new(), &options, length)?;
    writer.write_all(sequence.as_bytes())?;
    writer.finish()
}

/// Packs texts for the library of a build script: into a file of this name in Cargo's `OUT_DIR`.
pub fn embed(name: &str, texts: impl IntoIterator<Item = (String, String)>) -> io::Result<()> {
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    fs::write(Path::new(&out).join(name), pack(texts)?)
}

/// The texts in a folder and its folders, named by `prefix` and their paths in it, in the order of their names. Files
/// that are not text are left out.
pub fn folder(folder: &Path, prefix: &str) -> io::Result<Vec<(String, String)>> {
    let mut texts = Vec::new();
    list(folder, prefix, &mut texts)?;
    texts.sort();
    Ok(texts)
}

fn list(folder: &Path, prefix: &str, texts: &mut Vec<(String, String)>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), texts)?;
        } else if let Ok(text) = fs::read_to_string(entry.path()) {
            texts.push((name, text));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_packed_with_their_names() {
        let texts = [("a.c", "int a;\n"), ("b/b.h", ""), ("ü", "ö\r\n")];
        let texts = texts.map(|(name, text)| (name.to_string(), text.to_string()));
        let packed = Packed::new(pack(texts.clone()).unwrap().leak());
        assert_eq!(packed.texts(), texts);
        assert_eq!(packed.text("ü"), "ö\r\n");
        assert!(pack([("a".to_string(), "\0".to_string())]).is_err());
    }

    #[test]
    fn names_that_sources_use_are_found() {
        let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let names = used(&own, "packed.text").unwrap();
        assert_eq!(names, BTreeSet::from(["ü".to_string()]));
    }

    #[test]
    fn folders_are_listed_in_order() {
        let texts = folder(Path::new(env!("CARGO_MANIFEST_DIR")), "own/").unwrap();
        let names: Vec<&str> = texts.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["own/Cargo.toml", "own/src/lib.rs"]);
    }
}
