//! Sorting and sets for lists that are short or sorted once.
//!
//! The methods of the standard library are compiled anew for each type of element, 6 KB each: these have one copy of
//! the algorithm.

use crate::{SortedMap, SortedSet};
use std::cmp::Ordering;

/// Sorts; elements that are equal keep their order.
pub fn sort<T: Ord>(items: &mut [T]) {
    by(items, T::cmp);
}

/// Sorts by a key; elements with equal keys keep their order.
pub fn by_key<T, K: Ord>(items: &mut [T], mut key: impl FnMut(&T) -> K) {
    by(items, |a, b| key(a).cmp(&key(b)));
}

/// Sorts by a comparison; elements that are equal keep their order.
pub fn by<T>(items: &mut [T], mut compare: impl FnMut(&T, &T) -> Ordering) {
    let swaps = swaps(items.len(), &mut |a, b| compare(&items[a], &items[b]));
    for (a, b) in swaps {
        items.swap(a, b);
    }
}

/// The swaps, in order, that sort elements which `compare` compares by their places.
fn swaps(len: usize, compare: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<(usize, usize)> {
    if (1..len).all(|i| compare(i - 1, i).is_le()) {
        return Vec::new();
    }
    let mut sources: Vec<usize> = (0..len).collect();
    sources.sort_by(|&a, &b| compare(a, b));
    let mut swaps = Vec::new();
    for start in 0..len {
        // Each cycle of the permutation; its places are done then.
        let mut at = start;
        while sources[at] != start {
            let source = std::mem::replace(&mut sources[at], at);
            swaps.push((at, source));
            at = source;
        }
        sources[at] = at;
    }
    swaps
}

/// The set of these elements.
pub fn set<T: Ord>(items: impl IntoIterator<Item = T>) -> SortedSet<T> {
    items.into_iter().collect()
}

/// The map of these pairs; of pairs with equal keys the last one counts.
pub fn map<K: Ord, V>(pairs: impl IntoIterator<Item = (K, V)>) -> SortedMap<K, V> {
    pairs.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn lists_are_sorted_as_the_standard_library_does(
            items in prop::collection::vec((0..20u8, any::<u16>()), 0..60),
        ) {
            let (mut sorted, mut expected) = (items.clone(), items.clone());
            by_key(&mut sorted, |item| item.0);
            expected.sort_by_key(|item| item.0);
            prop_assert_eq!(sorted, expected);
            let (mut sorted, mut expected) = (items.clone(), items.clone());
            sort(&mut sorted);
            expected.sort();
            prop_assert_eq!(sorted, expected);
            let (mut sorted, mut expected) = (items.clone(), items);
            by(&mut sorted, |a, b| b.cmp(a));
            expected.sort_by(|a, b| b.cmp(a));
            prop_assert_eq!(sorted, expected);
        }
    }
}
