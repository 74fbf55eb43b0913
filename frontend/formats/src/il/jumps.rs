//! Jumps as AutoShop writes them: `CJ L1` to the label `L1`, `CJEND` to the end of the program, which are `CJ P1`, `P1`
//! and `CJ P63` elsewhere (h1u-h2u-programming §4.3.1, CJ).

use super::fold::Folded;
use std::ops::Range;

/// A line that has such a jump or label, as other lists write it.
pub(super) fn fold(line: &str) -> Option<Folded> {
    let code = instruction(line);
    let mut words = words(code).peekable();
    // A step number.
    words.next_if(|word| code[word.clone()].bytes().all(|b| b.is_ascii_digit()));
    let first = words.next()?;
    let mnemonic = &code[first.clone()];
    if label(mnemonic) {
        return Some(Folded::replaced(line, first.start..first.start + 1, "P"));
    }
    if mnemonic.eq_ignore_ascii_case("CJEND") {
        return Some(Folded::replaced(line, first.start + 2..first.end, " P63"));
    }
    if !mnemonic.eq_ignore_ascii_case("CJ") && !mnemonic.eq_ignore_ascii_case("CJP") {
        return None;
    }
    let to = words.next()?;
    match &code[to.clone()] {
        word if label(word) => Some(Folded::replaced(line, to.start..to.start + 1, "P")),
        word if word.eq_ignore_ascii_case("END") => Some(Folded::replaced(line, to, "P63")),
        _ => None,
    }
}

/// Returns true if a word is a label that can be a pointer: P63 is the end of the program.
fn label(word: &str) -> bool {
    let digits = word.strip_prefix(['L', 'l']).unwrap_or_default();
    digits.bytes().all(|b| b.is_ascii_digit()) && digits.parse::<u32>().is_ok_and(|n| n != 63)
}

/// First byte of `；`.
const WIDE: u8 = 0xEF;

/// A line up to its comment.
pub(super) fn instruction(line: &str) -> &str {
    let mut bytes = line.bytes().enumerate();
    let end = bytes.find_map(|(at, byte)| match byte {
        b';' => Some(at),
        b'/' if line[at + 1..].starts_with('/') => Some(at),
        WIDE if line[at..].starts_with('；') => Some(at),
        _ => None,
    });
    end.map_or(line, |at| &line[..at])
}

/// The places of words.
pub(super) fn words(code: &str) -> impl Iterator<Item = Range<usize>> {
    let start = code.as_ptr() as usize;
    code.split_whitespace().map(move |word| {
        let at = word.as_ptr() as usize - start;
        at..at + word.len()
    })
}

#[cfg(test)]
mod tests {
    use super::fold;

    #[test]
    fn jumps_of_autoshop_become_those_of_other_lists() {
        let folded = |line: &str| fold(line).map(|folded| folded.text);
        for (line, expected) in [
            ("CJ L1", "CJ P1"),
            ("12 cjp l20 ; L3", "12 cjp P20 ; L3"),
            ("CJ END", "CJ P63"),
            ("CJEND ; done", "CJ P63 ; done"),
            ("L1", "P1"),
            ("  7 L2 LD X0", "  7 P2 LD X0"),
        ] {
            assert_eq!(folded(line).as_deref(), Some(expected), "{line}");
        }
        for line in [
            "CJ P1", "LD X0", "L63", "CJ L63", "L", "LD1", "CALL L1", "; CJ L1", "CJ", "1", "",
        ] {
            assert_eq!(folded(line), None, "{line}");
        }
        let jump = fold("CJEND").unwrap();
        assert_eq!(jump.original(3, 6), (2, 5));
    }
}
