//! Names of contacts and coils that stand above them.

use super::{Scan, is_device, kind};

/// Largest distance of a name's beginning or end from its symbol; its middle may be half as far away.
const COLUMNS: usize = 16;

impl Scan<'_> {
    /// A contact whose name is above it.
    pub(super) fn contact(
        &mut self,
        row: usize,
        at: usize,
        end: usize,
        sign: char,
    ) -> Option<usize> {
        let kind = kind(sign)?;
        let above = row
            .checked_sub(1)
            .map(|above| self.name_above(above, at, end));
        match above.flatten() {
            Some(word) => self.add(row, (at, end), kind, vec![word]),
            None => {
                let span = self.block.span(row, at, end);
                self.drawn
                    .odd
                    .push((span, "no device is above this contact"));
                self.add(row, (at, end), kind, Vec::new());
            }
        }
        Some(end)
    }

    /// Gives a coil `( )`, `(S)` or `(R)` the name above it, with the preset of a timer or counter, unless that is the
    /// name of a contact.
    pub(super) fn name_coil(
        &self,
        row: usize,
        (at, end): (usize, usize),
        words: &mut Vec<(String, u32)>,
    ) {
        let mnemonic = match words.as_slice() {
            [] => None,
            [(word, place)] => match word.to_ascii_uppercase().as_str() {
                "S" | "SET" => Some(("SET".to_string(), *place)),
                "R" | "RST" => Some(("RST".to_string(), *place)),
                _ => return,
            },
            _ => return,
        };
        let Some(above) = row.checked_sub(1) else {
            return;
        };
        let Some(name) = self.name_above(above, at, end) else {
            return;
        };
        let mut symbols = self.drawn.symbols.iter();
        if symbols.any(|symbol| symbol.words.contains(&name)) {
            return;
        }
        let all = self.words(above, at.saturating_sub(COLUMNS), end + COLUMNS);
        let mut after = all.into_iter().skip_while(|word| *word != name).skip(1);
        let counts = name.0.starts_with(['T', 't', 'C', 'c']) && mnemonic.is_none();
        let preset = after.next().filter(|(word, _)| {
            let value = word.starts_with(['K', 'k', 'D', 'd', 'R', 'r']);
            counts && value && word[1..].bytes().all(|b| b.is_ascii_digit())
        });
        *words = mnemonic.into_iter().chain([name]).chain(preset).collect();
    }

    /// The word above some columns that is the nearest to their middle.
    fn name_above(&self, row: usize, at: usize, end: usize) -> Option<(String, u32)> {
        let words = self.words(row, at.saturating_sub(COLUMNS), end + COLUMNS);
        let middle = at + end;
        let near = words.into_iter().filter_map(|(word, place)| {
            let cells = &self.block.rows[row];
            let start = cells.iter().position(|cell| cell.1 == place)?;
            let distance = (2 * start + word.chars().count()).abs_diff(middle);
            (distance <= COLUMNS && is_device(&word)).then_some((distance, word, place))
        });
        let nearest = near.min_by_key(|found| found.0);
        nearest.map(|(_, word, place)| (word, place))
    }
}
