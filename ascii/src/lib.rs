//! What characters of other scripts are in ASCII: for names of modules, and for letters that a font lacks.
//!
//! It must not know what the characters are part of. Start reading at [`of`].

use rungc_packed::Packed;
use std::sync::OnceLock;

/// The table as the build script packs it.
static PACKED: Packed = Packed::new(include_bytes!(concat!(env!("OUT_DIR"), "/ascii.bin")));

/// What a character after ASCII is in it, as `deunicode` has it: `e` for `é`, `Wang ` for `往`, nothing for a mark that
/// has no width. Those that stand for a word end with a space.
///
/// `None` if the character is not known, or is in ASCII. Beyond the Basic Multilingual Plane only letters of
/// mathematics (U+1D400 to U+1D7FF) and pictographs (U+1F000 to U+1FFFF) are known.
pub fn of(character: char) -> Option<&'static str> {
    static ENTRIES: OnceLock<Vec<&'static str>> = OnceLock::new();
    static SYLLABLES: OnceLock<Vec<String>> = OnceLock::new();
    if let Some(number) = (character as usize).checked_sub(FIRST_SYLLABLE) {
        let syllables = SYLLABLES.get_or_init(syllables);
        if let Some(syllable) = syllables.get(number) {
            return Some(syllable);
        }
    }
    let entries = ENTRIES.get_or_init(|| {
        let marks = ['\u{1}', '\u{2}'];
        PACKED.text("ascii").split_inclusive(marks).collect()
    });
    let place = (character as usize).checked_sub(0x80)?;
    entries.get(place)?.strip_suffix('\u{1}')
}

/// The first syllable of Hangul.
const FIRST_SYLLABLE: usize = '가' as usize;

/// What syllables of Hangul begin with, in the order of Unicode (The Unicode Standard §3.12).
const INITIALS: [&str; 19] = [
    "g", "gg", "n", "d", "dd", "r", "m", "b", "bb", "s", "ss", "", "j", "jj", "c", "k", "t", "p",
    "h",
];

/// Their vowels.
const VOWELS: [&str; 21] = [
    "a", "ae", "ya", "yae", "eo", "e", "yeo", "ye", "o", "wa", "wae", "oe", "yo", "u", "weo", "we",
    "wi", "yu", "eu", "yi", "i",
];

/// What they end with.
const FINALS: [&str; 28] = [
    "", "g", "gg", "gs", "n", "nj", "nh", "d", "l", "lg", "lm", "lb", "ls", "lt", "lp", "lh", "m",
    "b", "bs", "s", "ss", "ng", "j", "c", "k", "t", "p", "h",
];

/// All syllables of Hangul, in the order of Unicode.
fn syllables() -> Vec<String> {
    let mut syllables = Vec::new();
    for initial in INITIALS {
        for vowel in VOWELS {
            syllables.extend(FINALS.map(|end| format!("{initial}{vowel}{end}")));
        }
    }
    syllables
}

#[cfg(test)]
mod tests {
    use deunicode::deunicode_char;

    #[test]
    fn every_character_is_what_deunicode_makes_of_it() {
        for character in '\u{80}'..=char::MAX {
            let is_kept =
                matches!(u32::from(character), 0..=0xffff | 0x1d400..=0x1d7ff | 0x1f000..=0x1ffff);
            let expected = deunicode_char(character).filter(|_| is_kept);
            assert_eq!(super::of(character), expected, "{character:?}");
        }
        assert_eq!(super::of('往'), Some("Wang "));
        assert_eq!(super::of('Ł'), Some("L"));
        assert_eq!(super::of('\u{7f}'), None);
    }
}
