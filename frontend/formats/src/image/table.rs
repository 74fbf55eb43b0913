//! Words of instructions.

use std::sync::LazyLock;

/// The rows of `applied.tsv`, applied instructions: FNC, mnemonic in 16 bits, in 32 bits, whether there is a pulse
/// form, number of operands, evidence (`seen`: a published image or download holds it; `derived`: by the rule that all
/// of those follow).
fn rows() -> impl Iterator<Item = &'static str> {
    include_str!("applied.tsv").lines().skip(1)
}

/// Contacts: the upper nibble of one word from 2 on, or 01C2h and up before a wide point.
pub(super) const CONTACTS: [&str; 6] = ["LD", "LDI", "AND", "ANI", "OR", "ORI"];
/// Edge contacts, from 01CAh on.
pub(super) const EDGES: [&str; 6] = ["LDP", "LDF", "ANDP", "ANDF", "ORP", "ORF"];
/// Coils: the upper nibble of one word from Ch on; 0002h and up before a wide point, 0005h and up before S.
pub(super) const COILS: [&str; 3] = ["OUT", "SET", "RST"];
/// Pulses, from 0008h on.
pub(super) const PULSES: [&str; 2] = ["PLS", "PLF"];
/// The word of `END`.
pub(super) const END: u16 = 0x000F;
/// Instructions of one word without operands.
pub(super) const BARE: [(u16, &str); 9] = [
    (0x0000, "NOP"),
    (END, "END"),
    (0xF7FF, "RET"),
    (0xFFF8, "ANB"),
    (0xFFF9, "ORB"),
    (0xFFFA, "MPS"),
    (0xFFFB, "MRD"),
    (0xFFFC, "MPP"),
    (0xFFFD, "INV"),
];

/// The word of FNC 0; each further number adds two, 32 bits add one.
const FIRST: u16 = 0x0010;
/// Bit added by the pulse form.
const PULSE: u16 = 0x1000;

/// An applied instruction in one of its forms.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Applied {
    /// Its word.
    pub word: u16,
    /// Its mnemonic, without the `P` of the pulse form.
    pub mnemonic: &'static str,
    /// True for the pulse form.
    pub pulse: bool,
    /// True for 32 bits.
    pub wide: bool,
    /// Number of operands.
    pub operands: usize,
    /// True if a published image shows the number.
    pub seen: bool,
}

/// The applied instruction with this word.
pub(super) fn applied(word: u16) -> Option<&'static Applied> {
    let at = TABLE.binary_search_by_key(&word, |row| row.word).ok()?;
    Some(&TABLE[at])
}

/// The applied instruction with this mnemonic; floating-point instructions are also written without their `D`.
pub(super) fn named(mnemonic: &str) -> Option<&'static Applied> {
    let is = |row: &&Applied, name: &str| match row.pulse {
        true => name.strip_suffix('P') == Some(row.mnemonic),
        false => name == row.mnemonic,
    };
    let find = |name: &str| TABLE.iter().find(|row| is(row, name));
    find(mnemonic).or_else(|| find(&format!("D{mnemonic}")))
}

/// The rows in all their forms, ordered by their words.
static TABLE: LazyLock<Vec<Applied>> = LazyLock::new(|| {
    let mut table: Vec<_> = rows().filter_map(forms).flatten().collect();
    table.sort_by_key(|row| row.word);
    table
});

/// The forms of a row; a test finds that all rows can be read.
fn forms(row: &'static str) -> Option<impl Iterator<Item = Applied>> {
    let columns: Vec<_> = row.split('\t').collect();
    let [fnc, narrow, wide, pulse, operands, evidence] = columns[..] else {
        return None;
    };
    let (fnc, operands) = (fnc.parse::<u16>().ok()?, operands.parse().ok()?);
    let seen = match evidence {
        "seen" => true,
        "derived" => false,
        _ => return None,
    };
    let pulses = [false, true]
        .into_iter()
        .filter(move |p| !p || pulse == "P");
    let widths = [(narrow, false), (wide, true)];
    let widths = widths.into_iter().filter(|(name, _)| !name.is_empty());
    Some(widths.flat_map(move |(mnemonic, wide)| {
        pulses.clone().map(move |pulse| Applied {
            word: FIRST + 2 * fnc + u16::from(wide) + if pulse { PULSE } else { 0 },
            mnemonic,
            pulse,
            wide,
            operands,
            seen,
        })
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_read_and_each_word_means_one_thing() {
        let unread = rows().find(|row| forms(row).is_none());
        assert_eq!(unread, None);
        for pair in TABLE.windows(2) {
            assert_ne!(pair[0].word, pair[1].word, "{:?}", pair);
        }
    }

    #[test]
    fn words_of_images_are_found() {
        let name = |word| applied(word).map(|row| (row.mnemonic, row.pulse));
        assert_eq!(name(0x0028), Some(("MOV", false)));
        assert_eq!(name(0x1029), Some(("DMOV", true)));
        assert_eq!(name(0x0060), Some(("ZRST", false)));
        assert_eq!(name(0x01D1), Some(("LDD=", false)));
        assert_eq!(name(0x01C2), None, "a contact");
        assert_eq!(name(0x0013), None, "CALL has no 32-bit form");
    }

    #[test]
    fn mnemonics_are_found() {
        let word = |name| named(name).map(|row| row.word);
        assert_eq!(word("ADDP"), Some(0x1038));
        assert_eq!(word("DAND"), Some(0x0045));
        assert_eq!(word("ANDD<>"), Some(0x01E9));
        assert_eq!(word("EADD"), word("DEADD"));
        assert_eq!(word("MOVE"), None);
    }
}
