//! Hashes of files.

use crate::File;
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// SHA-256 in hexadecimal.
pub fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// SHA-256 of the only file, or of the list of several as `sha256sum` prints it.
pub fn of_list(files: &[File]) -> String {
    if let [only] = files {
        return only.sha256.clone();
    }
    let lines = files.iter();
    let lines = lines.map(|file| format!("{}  {}\n", file.sha256, file.file));
    sha256(lines.collect::<String>().as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_those_of_sha256sum() {
        let file = |name: &str, text: &[u8]| File {
            role: "program",
            file: name.into(),
            sha256: sha256(text),
        };
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        let only = file("a", b"abc");
        assert_eq!(of_list(std::slice::from_ref(&only)), only.sha256);
        // By `printf abc >a; printf '' >b; sha256sum a b | sha256sum`.
        let several = of_list(&[only, file("b", b"")]);
        assert_eq!(
            several,
            "09c7e0b8a02d027d95ec0375a600ed4ad4d6b26a1c93f16d9150cab5fec761a6"
        );
    }
}
