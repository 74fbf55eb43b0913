//! Packs what characters of other scripts are in ASCII: a third of the size of the tables of `deunicode`, from which it
//! is made.
//!
//! Beyond the Basic Multilingual Plane only letters of mathematics and pictographs are kept: no editor of PLC programs
//! writes the others, such as cuneiform.
//!
//! From the character after ASCII on, the text has for each what it is, and a mark after that: U+0001 if it is known,
//! U+0002 otherwise. Those that the text does not reach are not known. Syllables of Hangul have U+0002 too: the library
//! composes them.

use deunicode::deunicode_char;
use std::io;
use std::ops::RangeInclusive;

/// The syllables of Hangul.
const HANGUL: RangeInclusive<char> = '가'..='힣';

/// Characters that are kept.
const KEPT: [RangeInclusive<char>; 3] = [
    '\u{80}'..='\u{ffff}',
    '\u{1d400}'..='\u{1d7ff}',
    '\u{1f000}'..='\u{1ffff}',
];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let mut text = String::new();
    for number in 0x80..=u32::from(char::MAX) {
        let is_kept = |character: &char| {
            !HANGUL.contains(character) && KEPT.iter().any(|range| range.contains(character))
        };
        let character = char::from_u32(number).filter(is_kept);
        match character.and_then(deunicode_char) {
            Some(ascii) => {
                text.push_str(ascii);
                text.push('\u{1}');
            }
            None => text.push('\u{2}'),
        }
    }
    let known = text.trim_end_matches('\u{2}');
    rungc_packed::embed("ascii.bin", [("ascii".to_string(), known.to_string())])
}
