//! Packs what characters of other scripts are in ASCII into one deflated text, which names of modules are made by: a
//! third of the size of the tables of `deunicode`, from which it is made.
//!
//! From the character after ASCII on, each has its letters and digits in lower case, and a mark: `~` if it stands for a
//! syllable or a word, `-` if it stands for nothing, and `.` otherwise. Those that the text does not reach stand for
//! nothing.

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
        let ascii = char::from_u32(number).and_then(deunicode_char);
        let ascii = ascii.unwrap_or_default();
        let letters = ascii.chars().filter(char::is_ascii_alphanumeric);
        text.extend(letters.map(|c| c.to_ascii_lowercase()));
        text.push(match ascii {
            "" => '-',
            _ if ascii.ends_with(' ') => '~',
            _ => '.',
        });
    }
    let packed =
        miniz_oxide::deflate::compress_to_vec(text.trim_end_matches('-').as_bytes(), LEVEL);
    fs::write(PathBuf::from(out).join("ascii.bin"), packed)
}
