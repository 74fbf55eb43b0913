//! Half-width reading of full-width text, with the way back to the original.

/// One line in the form the grammar reads, and where each of its bytes came from.
#[derive(Default)]
pub(super) struct Folded {
    /// The line with every full-width letter, digit and sign made half-width.
    pub text: String,
    /// For each byte of `text`, the original character's first byte and the byte past it, within the line.
    origin: Vec<(u32, u32)>,
}

impl Folded {
    /// Folds another line into the same buffers.
    pub fn fold(&mut self, line: &str) {
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
        let mut folded = Folded::default();
        folded.fold("ＬＤ≧　Ｄ０");
        assert_eq!(folded.text, "LD>= D0");
        assert_eq!(folded.original(0, 4), (0, 9));
        assert_eq!(folded.original(5, 7), (12, 18));
        assert_eq!(folded.original(7, 7), (18, 18));
    }
}
