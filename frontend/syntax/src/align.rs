//! Aligning two sequences: what they have in common, in order.

use similar::{Algorithm, capture_diff_slices};
use std::collections::{BTreeMap, BTreeSet};

/// Positions of elements that two sequences have in common, in order in both: as many as a good alignment finds.
///
/// Elements that only one of them has are left out first, so that long sequences with little in common take no longer
/// than others.
pub fn common<T: Ord>(old: &[T], new: &[T]) -> Vec<(usize, usize)> {
    let in_old: BTreeSet<_> = old.iter().collect();
    let mut numbers: BTreeMap<&T, usize> = BTreeMap::new();
    for (number, element) in new.iter().enumerate() {
        if in_old.contains(element) {
            numbers.entry(element).or_insert(number);
        }
    }
    let shared = |all: &[T]| -> Vec<(usize, usize)> {
        let numbered = all.iter().enumerate();
        numbered
            .filter_map(|(at, element)| Some((at, *numbers.get(element)?)))
            .collect()
    };
    let (old, new) = (shared(old), shared(new));
    let keys = |shared: &[(usize, usize)]| shared.iter().map(|pair| pair.1).collect::<Vec<_>>();
    let runs = capture_diff_slices(Algorithm::Patience, &keys(&old), &keys(&new));
    let mut pairs = Vec::new();
    for run in runs {
        if let similar::DiffOp::Equal {
            old_index,
            new_index,
            len,
        } = run
        {
            pairs.extend((0..len).map(|at| (old[old_index + at].0, new[new_index + at].0)));
        }
    }
    pairs
}

/// A line of a comparison of two texts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Line<'a> {
    /// Both have it.
    Same(&'a str),
    /// Only the old text has it.
    Old(&'a str),
    /// Only the new text has it.
    New(&'a str),
}

/// Two texts line by line: where they differ, the old lines come before the new ones.
pub fn lines<'a>(old: &'a str, new: &'a str) -> Vec<Line<'a>> {
    let old: Vec<&str> = old.lines().collect();
    let new: Vec<&str> = new.lines().collect();
    let mut lines = Vec::with_capacity(old.len().max(new.len()));
    let (mut from, mut to) = (0, 0);
    let end = (old.len(), new.len());
    for (same_old, same_new) in common(&old, &new).into_iter().chain([end]) {
        lines.extend(old[from..same_old].iter().copied().map(Line::Old));
        lines.extend(new[to..same_new].iter().copied().map(Line::New));
        lines.extend(old.get(same_old).copied().map(Line::Same));
        (from, to) = (same_old + 1, same_new + 1);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::{Line, common, lines};

    #[test]
    fn what_two_sequences_share_is_aligned() {
        assert_eq!(
            common(&[1, 2, 3, 5], &[0, 1, 3, 4, 5]),
            [(0, 1), (2, 2), (3, 4)]
        );
        assert_eq!(common::<u8>(&[], &[]), []);
        assert_eq!(common(&[1, 1], &[2, 2]), []);
    }

    #[test]
    fn lines_come_in_the_order_of_both_texts() {
        let expected = [
            Line::Same("a"),
            Line::Old("b"),
            Line::New("c"),
            Line::New("d"),
            Line::Same("e"),
        ];
        assert_eq!(lines("a\nb\ne\n", "a\nc\nd\ne"), expected);
        assert_eq!(lines("", "a"), [Line::New("a")]);
        assert_eq!(lines("a", ""), [Line::Old("a")]);
    }

    #[test]
    fn long_sequences_without_anything_in_common_take_no_time() {
        let (old, new): (Vec<_>, Vec<_>) = (0..100_000).map(|n| (2 * n, 2 * n + 1)).unzip();
        assert_eq!(common(&old, &new), []);
    }
}
