//! Half-width reading of full-width text, with the way back to the original.

use super::fault::{Fault, Faults, Kind};

/// One line in the form the grammar reads, and where each of its bytes came from.
#[derive(Default)]
pub(super) struct Folded {
    /// The line with every full-width letter, digit and sign made half-width.
    pub text: String,
    /// For each byte of `text`, the original character's first byte and the byte past it, within the line.
    origin: Vec<(u32, u32)>,
}

impl Folded {
    /// A text, folded.
    pub fn of(text: &str) -> Self {
        let mut folded = Folded::default();
        folded.fold(text);
        folded
    }

    /// A line with a part replaced: all of what replaces it comes from there.
    pub fn replaced(line: &str, part: std::ops::Range<usize>, by: &str) -> Self {
        let mut folded = Folded::of(&line[..part.start]);
        let rest = Folded::of(&line[part.end..]);
        let end = part.end as u32;
        folded.text.push_str(by);
        folded
            .origin
            .resize(folded.text.len(), (part.start as u32, end));
        folded.text.push_str(&rest.text);
        let moved = rest.origin.iter().map(|(from, to)| (from + end, to + end));
        folded.origin.extend(moved);
        folded
    }

    /// Folds another line into the same buffers. Letters of other alphabets that look Latin are read as they look, and
    /// reported; not in texts and comments, and not in words that are whole words of another language.
    pub(crate) fn fold_line(&mut self, line: &str, faults: &mut Faults) {
        self.fold(line);
        if self.text.is_ascii() || self.text.trim_start().starts_with("ASC ") {
            return;
        }
        let mut code = code_length(&self.text);
        let mut begin = 0;
        while begin < code {
            let rest = &self.text[begin..code];
            let word = rest.split([' ', '\t', ',']).next().unwrap_or(rest);
            let mut end = begin + word.len();
            if let Some(first) = foreign_letter(word) {
                let before = self.text.len();
                self.make_latin(begin..end);
                let shorter = before - self.text.len();
                (end, code) = (end - shorter, code - shorter);
                faults.push(Fault::new((begin..end).into(), Kind::LookAlike(first)));
            }
            begin = end + 1;
        }
    }

    /// Replaces the letters in a range by those that they look like.
    fn make_latin(&mut self, range: std::ops::Range<usize>) {
        for at in range.rev() {
            let Some(c) = self.text.get(at..).and_then(|rest| rest.chars().next()) else {
                continue;
            };
            let Some(latin) = look_alike(c) else {
                continue;
            };
            let origin = self.origin[at];
            self.text
                .replace_range(at..at + c.len_utf8(), latin.encode_utf8(&mut [0; 4]));
            self.origin.splice(at..at + c.len_utf8(), [origin]);
        }
    }

    /// Folds another text into the same buffers.
    fn fold(&mut self, line: &str) {
        self.text.clear();
        self.origin.clear();
        for (at, c) in line.char_indices() {
            fold_char(c, &mut self.text);
            let origin = (at as u32, (at + c.len_utf8()) as u32);
            self.origin.resize(self.text.len(), origin);
        }
    }

    /// The original place of a range of the folded text.
    pub fn original(&self, start: u32, end: u32) -> (u32, u32) {
        let past = self.origin.last().map_or(0, |&(_, end)| end);
        let first = self.origin.get(start as usize).map_or(past, |&(s, _)| s);
        let last = match end.checked_sub(1) {
            Some(last) if end > start => self.origin.get(last as usize).map_or(past, |&(_, e)| e),
            _ => first,
        };
        (first, last)
    }
}

/// Length of a line before its first text or comment.
fn code_length(line: &str) -> usize {
    let signs = [line.find('"'), line.find(';'), line.find("//")];
    signs.into_iter().flatten().min().unwrap_or(line.len())
}

/// The first letter of a word that looks Latin and is not, if all of its letters can be read so. A long word without
/// any Latin letter is one of another language.
fn foreign_letter(word: &str) -> Option<char> {
    /// No mnemonic that such letters make up alone is longer.
    const LONGEST: usize = 3;
    let first = word.chars().find(|&c| look_alike(c).is_some())?;
    let readable = word
        .chars()
        .all(|c| c.is_ascii() || look_alike(c).is_some());
    let mixed = word.bytes().any(|b| b.is_ascii_alphanumeric());
    (readable && (mixed || word.chars().count() <= LONGEST)).then_some(first)
}

/// The Latin letter that a Cyrillic or Greek one looks like.
fn look_alike(c: char) -> Option<char> {
    const CYRILLIC: (&str, &str) = ("АВЕЅКМНІЈОРСТУХаеѕіјорсух", "ABESKMHIJOPCTYXaesijopcyx");
    const GREEK: (&str, &str) = ("ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο", "ABEZHIKMNOPTYXo");
    [CYRILLIC, GREEK].into_iter().find_map(|(foreign, latin)| {
        let at = foreign.chars().position(|other| other == c)?;
        latin.chars().nth(at)
    })
}

/// Appends what a typist meant by `c`: word processors and East Asian input methods turn signs into look-alikes.
fn fold_char(c: char, out: &mut String) {
    match c {
        '\u{FF01}'..='\u{FF5E}' => out.extend(char::from_u32(c as u32 - 0xFEE0)),
        '\u{3000}' | '\u{A0}' | '\u{2000}'..='\u{200B}' | '\u{FEFF}' => out.push(' '),
        '、' | '،' => out.push(','),
        '。' => out.push('.'),
        '“' | '”' | '„' => out.push('"'),
        '≥' | '≧' => out.push_str(">="),
        '≤' | '≦' => out.push_str("<="),
        '≠' => out.push_str("<>"),
        '−' | '–' | '—' => out.push('-'),
        '¥' | '￥' => out.push('\\'),
        _ => out.push(c),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_lead_back_to_the_original() {
        let folded = Folded::of("ＬＤ≧　Ｄ０");
        assert_eq!(folded.text, "LD>= D0");
        assert_eq!(folded.original(0, 4), (0, 9));
        assert_eq!(folded.original(5, 7), (12, 18));
        assert_eq!(folded.original(7, 7), (18, 18));
    }

    #[test]
    fn look_alikes_are_read_as_they_look() {
        let read = |line: &str| {
            let mut folded = Folded::default();
            let mut faults = Faults::default();
            folded.fold_line(line, &mut faults);
            let found: Vec<_> = faults
                .iter()
                .map(|fault| (fault.span.start, fault.span.end))
                .collect();
            (folded.text, found, folded.origin.len())
        };
        assert_eq!(read("LD \u{425}0"), ("LD X0".to_owned(), vec![(3, 5)], 5));
        // Words of another language, texts and comments stay.
        for line in [
            "Пуск",
            "мотор LD",
            "$MOV \"Х0\" D0",
            "LD X0 ; Х0",
            "ASC Х0 D0",
        ] {
            assert_eq!(read(line).0, line);
            assert!(read(line).1.is_empty());
        }
    }
}
