//! Packs what characters of other scripts are in ASCII into one deflated text: a third of the size of the tables of
//! `deunicode`, from which it is made.
//!
//! From the character after ASCII on, the text has for each what it is, and a mark after that: U+0001 if it is
//! known, NUL otherwise. Those that the text does not reach are not known.

use deunicode::deunicode_char;
use std::path::PathBuf;
use std::{env, fs, io};

/// How hard to compress: the best ratio.
const LEVEL: u8 = 9;

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let mut text = String::new();
    for number in 0x80..=u32::from(char::MAX) {
        match char::from_u32(number).and_then(deunicode_char) {
            Some(ascii) => {
                text.push_str(ascii);
                text.push('\u{1}');
            }
            None => text.push('\0'),
        }
    }
    let known = text.trim_end_matches('\0').as_bytes();
    let packed = miniz_oxide::deflate::compress_to_vec(known, LEVEL);
    fs::write(PathBuf::from(out).join("ascii.bin"), packed)
}
