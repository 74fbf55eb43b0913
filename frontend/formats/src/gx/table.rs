//! Codes of instructions: `tokens.tsv`, a row for each code with the evidence for it.
//!
//! The second byte of a body is the instruction's number of steps; the first and the third name it. A fourth byte 02
//! makes it a pulse form. Where codes differ in their steps alone (LD M0 takes one, LD M7300 three), each has a row.

use std::sync::LazyLock;

/// The rows of `tokens.tsv`: body (hexadecimal), mnemonic, steps (`5+`: and two more for every two characters of a
/// text), evidence, notes.
fn rows() -> impl Iterator<Item = &'static str> {
    include_str!("tokens.tsv").lines().skip(1)
}

/// Evidence for the meaning of a code.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Evidence {
    /// Real projects hold it, and their lists, sources or comments identify it.
    Seen,
    /// A published table, made with the vendor's own converter, has it.
    Published,
    /// It follows from its neighbours, or from a rule.
    Derived,
    /// It might be.
    Guess,
}

/// One code.
#[derive(Debug)]
pub(super) struct Code {
    /// The body of its tokens.
    pub body: Vec<u8>,
    /// The instruction, as the list export spells it; `P` for a label.
    pub mnemonic: &'static str,
    /// True if its second byte grows with a text among its operands.
    pub grows: bool,
    /// Evidence for its meaning.
    pub evidence: Evidence,
}

/// The code that an instruction's token has, if any is known.
pub(super) fn find(body: &[u8]) -> Option<&'static Code> {
    let exact = |body: &[u8]| {
        let at = TABLE.binary_search_by(|code| code.body.as_slice().cmp(body));
        at.ok().map(|at| &TABLE[at])
    };
    exact(body).or_else(|| {
        let [family, steps, index, pulse @ ..] = body else {
            return None;
        };
        let grown = |code: &&Code| match code.body.as_slice() {
            [first, fewest, third, rest @ ..] => {
                (first, third, rest) == (family, index, pulse)
                    && steps > fewest
                    && (steps - fewest).is_multiple_of(2)
            }
            _ => false,
        };
        TABLE.iter().filter(|code| code.grows).find(grown)
    })
}

/// Certain meaning of a code: not derived, not guessed.
pub(crate) fn proven(body: &[u8]) -> Option<&'static str> {
    let proven = |code: &&Code| matches!(code.evidence, Evidence::Seen | Evidence::Published);
    find(body).filter(proven).map(|code| code.mnemonic)
}

/// Returns true if a code for this instruction is known, not only guessed.
pub fn has_code(mnemonic: &str) -> bool {
    let known = |code: &Code| code.mnemonic == mnemonic && code.evidence != Evidence::Guess;
    TABLE.iter().any(known)
}

/// The rows, ordered by their bodies.
static TABLE: LazyLock<Vec<Code>> = LazyLock::new(|| {
    let mut table: Vec<_> = rows().filter_map(code).collect();
    table.sort_by(|a, b| a.body.cmp(&b.body));
    table
});

/// A row; a test finds that all of them can be read.
fn code(row: &'static str) -> Option<Code> {
    let mut columns = row.split('\t');
    let body = columns.next()?.split_whitespace();
    let body = body.map(|byte| u8::from_str_radix(byte, 16).ok());
    let (body, mnemonic, steps) = (
        body.collect::<Option<_>>()?,
        columns.next()?,
        columns.next()?,
    );
    let evidence = match columns.next()? {
        "seen" => Evidence::Seen,
        "published" => Evidence::Published,
        "derived" => Evidence::Derived,
        "guess" => Evidence::Guess,
        _ => return None,
    };
    Some(Code {
        body,
        mnemonic,
        grows: steps.ends_with('+'),
        evidence,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gx::tokens::steps;

    #[test]
    fn every_row_is_read_and_states_the_steps_of_its_body() {
        assert_eq!(TABLE.len(), rows().count());
        for row in rows() {
            let code = code(row).unwrap();
            let stated = row.split('\t').nth(2).unwrap().trim_end_matches('+');
            assert_eq!(stated, steps(&code.body).to_string(), "{row}");
        }
    }

    #[test]
    fn each_code_has_one_meaning() {
        for codes in TABLE.windows(2) {
            assert_ne!(codes[0].body, codes[1].body, "{}", codes[0].mnemonic);
        }
    }

    #[test]
    fn codes_are_found() {
        let name = |body: &[u8]| find(body).map(|code| code.mnemonic);
        assert_eq!(name(&[]), Some("NOP"));
        assert_eq!(name(&[0x56, 9, 0]), Some("FROM"));
        assert_eq!(name(&[0x56, 9, 2]), Some("TO"));
        assert_eq!(name(&[0x56, 9, 10]), None);
        assert_eq!(name(&[0x40, 9, 7, 0x11]), Some("ANDD<>"));
        assert_eq!(name(&[0x4A, 3, 0, 2]), Some("INCP"));
        assert_eq!(name(&[0x4A, 3, 1]), None);
    }

    #[test]
    fn a_code_grows_with_a_text_only() {
        let name = |body: &[u8]| find(body).map(|code| code.mnemonic);
        assert_eq!(name(&[0x4C, 5, 3]), Some("$MOV"));
        assert_eq!(name(&[0x4C, 0x23, 3, 2]), Some("$MOVP"));
        assert_eq!(name(&[0x4C, 6, 3]), None);
        assert_eq!(name(&[0x4C, 3, 3]), None);
        assert_eq!(name(&[0x4C, 7, 0]), None, "MOV");
    }

    #[test]
    fn a_guess_is_no_code() {
        assert!(has_code("DSZR") && !has_code("IVMC") && !has_code("MOVE"));
    }
}
