//! Maps and sets in the order of their keys, kept as sorted lists.
//!
//! They do what the standard library's `BTreeMap` and `BTreeSet` do, whose trees are compiled anew for each type of key
//! and value, 4 KB each. A key that is not the largest is inserted by moving those above it: filling a map with many
//! thousand keys that come in no order is for `BTreeMap`.

use crate::order;
use serde_core::de::{Deserialize, Deserializer, MapAccess, Visitor};
use std::borrow::Borrow;
use std::marker::PhantomData;
use std::ops::{Bound, Index, Range, RangeBounds};
use std::{iter, slice, vec};

/// A map in the order of its keys.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SortedMap<K, V> {
    /// Each key once, in ascending order.
    pairs: Vec<(K, V)>,
}

/// A key and its value, borrowed.
type Pair<'a, K, V> = iter::Map<slice::Iter<'a, (K, V)>, fn(&'a (K, V)) -> (&'a K, &'a V)>;
/// A key and its value, which can be changed.
type PairMut<'a, K, V> =
    iter::Map<slice::IterMut<'a, (K, V)>, fn(&'a mut (K, V)) -> (&'a K, &'a mut V)>;

impl<K, V> SortedMap<K, V> {
    /// An empty map.
    pub const fn new() -> Self {
        SortedMap { pairs: Vec::new() }
    }

    /// Whether it has no keys.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// How many keys it has.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Removes all keys.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// All pairs.
    pub fn iter(&self) -> Pair<'_, K, V> {
        self.pairs.iter().map(|(key, value)| (key, value))
    }

    /// All pairs; the values can be changed.
    pub fn iter_mut(&mut self) -> PairMut<'_, K, V> {
        self.pairs.iter_mut().map(|(key, value)| (&*key, value))
    }

    /// All keys.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = &K> + ExactSizeIterator + Clone {
        self.pairs.iter().map(|(key, _)| key)
    }

    /// All values, in the order of their keys.
    pub fn values(&self) -> impl DoubleEndedIterator<Item = &V> + ExactSizeIterator + Clone {
        self.pairs.iter().map(|(_, value)| value)
    }

    /// All values, which can be changed, in the order of their keys.
    pub fn values_mut(&mut self) -> impl DoubleEndedIterator<Item = &mut V> + ExactSizeIterator {
        self.pairs.iter_mut().map(|(_, value)| value)
    }

    /// The keys without the values.
    pub fn into_keys(self) -> impl DoubleEndedIterator<Item = K> + ExactSizeIterator {
        self.pairs.into_iter().map(|(key, _)| key)
    }

    /// The values without the keys, in their order.
    pub fn into_values(self) -> impl DoubleEndedIterator<Item = V> + ExactSizeIterator {
        self.pairs.into_iter().map(|(_, value)| value)
    }

    /// The pair with the smallest key.
    pub fn first_key_value(&self) -> Option<(&K, &V)> {
        self.pairs.first().map(|(key, value)| (key, value))
    }

    /// Keeps the pairs that are to stay.
    pub fn retain(&mut self, mut stays: impl FnMut(&K, &mut V) -> bool) {
        self.pairs.retain_mut(|(key, value)| stays(key, value));
    }
}

impl<K: Ord, V> SortedMap<K, V> {
    /// Where a key is, or would be inserted.
    fn place<Q: Ord + ?Sized>(&self, key: &Q) -> Result<usize, usize>
    where
        K: Borrow<Q>,
    {
        place(self.pairs.len(), |i| self.pairs[i].0.borrow().cmp(key))
    }

    /// The value of a key.
    pub fn get<Q: Ord + ?Sized>(&self, key: &Q) -> Option<&V>
    where
        K: Borrow<Q>,
    {
        self.place(key).ok().map(|i| &self.pairs[i].1)
    }

    /// The value of a key, which can be changed.
    pub fn get_mut<Q: Ord + ?Sized>(&mut self, key: &Q) -> Option<&mut V>
    where
        K: Borrow<Q>,
    {
        self.place(key).ok().map(|i| &mut self.pairs[i].1)
    }

    /// Whether it has a key.
    pub fn contains_key<Q: Ord + ?Sized>(&self, key: &Q) -> bool
    where
        K: Borrow<Q>,
    {
        self.place(key).is_ok()
    }

    /// Gives a key this value, and returns the one it had.
    pub fn insert(&mut self, key: K, value: V) -> Option<V> {
        match self.place(&key) {
            Ok(i) => Some(std::mem::replace(&mut self.pairs[i].1, value)),
            Err(i) => {
                self.pairs.insert(i, (key, value));
                None
            }
        }
    }

    /// Removes a key, and returns its value.
    pub fn remove<Q: Ord + ?Sized>(&mut self, key: &Q) -> Option<V>
    where
        K: Borrow<Q>,
    {
        self.place(key).ok().map(|i| self.pairs.remove(i).1)
    }

    /// The place of a key, which may have a value or be given one.
    pub fn entry(&mut self, key: K) -> Entry<'_, K, V> {
        let place = self.place(&key);
        Entry {
            map: self,
            key,
            place,
        }
    }

    /// The pairs whose keys are in a range.
    pub fn range<Q: Ord + ?Sized>(&self, range: impl RangeBounds<Q>) -> Pair<'_, K, V>
    where
        K: Borrow<Q>,
    {
        let places = span(self.len(), &range, |key| self.place(key));
        self.pairs[places].iter().map(|(key, value)| (key, value))
    }
}

/// A key of a map, which may have a value.
pub struct Entry<'a, K, V> {
    map: &'a mut SortedMap<K, V>,
    key: K,
    place: Result<usize, usize>,
}

impl<'a, K, V> Entry<'a, K, V> {
    /// Its value, or this one if it has none.
    pub fn or_insert(self, value: V) -> &'a mut V {
        let i = match self.place {
            Ok(i) => i,
            Err(i) => {
                self.map.pairs.insert(i, (self.key, value));
                i
            }
        };
        &mut self.map.pairs[i].1
    }

    /// Its value, or the one that `make` makes if it has none.
    pub fn or_insert_with(self, make: impl FnOnce() -> V) -> &'a mut V {
        match self.place {
            Ok(i) => &mut self.map.pairs[i].1,
            Err(_) => self.or_insert(make()),
        }
    }

    /// Its value, or the default one if it has none.
    pub fn or_default(self) -> &'a mut V
    where
        V: Default,
    {
        self.or_insert_with(V::default)
    }

    /// Changes its value, if it has one.
    #[must_use]
    pub fn and_modify(self, change: impl FnOnce(&mut V)) -> Self {
        if let Ok(i) = self.place {
            change(&mut self.map.pairs[i].1);
        }
        self
    }
}

/// Binary search among `len` elements, of which `compare` compares the one at a place with what is sought.
fn place(len: usize, mut compare: impl FnMut(usize) -> std::cmp::Ordering) -> Result<usize, usize> {
    let (mut from, mut to) = (0, len);
    // Most lists are filled in ascending order.
    let mut middle = len.saturating_sub(1);
    while from < to {
        match compare(middle) {
            std::cmp::Ordering::Equal => return Ok(middle),
            std::cmp::Ordering::Less => from = middle + 1,
            std::cmp::Ordering::Greater => to = middle,
        }
        middle = from.midpoint(to);
    }
    Err(from)
}

/// The places of a range among `len` elements; `place` says where an element is, or would be inserted.
fn span<Q: ?Sized>(
    len: usize,
    range: &impl RangeBounds<Q>,
    place: impl Fn(&Q) -> Result<usize, usize>,
) -> Range<usize> {
    let before = |item, counts| match place(item) {
        Ok(i) => i + usize::from(counts),
        Err(i) => i,
    };
    let start = match range.start_bound() {
        Bound::Unbounded => 0,
        Bound::Included(first) => before(first, false),
        Bound::Excluded(first) => before(first, true),
    };
    let end = match range.end_bound() {
        Bound::Unbounded => len,
        Bound::Included(last) => before(last, true),
        Bound::Excluded(last) => before(last, false),
    };
    start..end.max(start)
}

/// The elements in a list. `collect` asks for their number first, for which each adapter brings code.
fn list<T>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut list = Vec::new();
    for item in items {
        list.push(item);
    }
    list
}

impl<K, V> Default for SortedMap<K, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: std::fmt::Debug, V: std::fmt::Debug> std::fmt::Debug for SortedMap<K, V> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_map().entries(self.iter()).finish()
    }
}

impl<K: Borrow<Q> + Ord, Q: Ord + ?Sized, V> Index<&Q> for SortedMap<K, V> {
    type Output = V;

    fn index(&self, key: &Q) -> &V {
        self.get(key).expect("the key is in the map")
    }
}

impl<K: Ord, V> Extend<(K, V)> for SortedMap<K, V> {
    fn extend<I: IntoIterator<Item = (K, V)>>(&mut self, pairs: I) {
        for (key, value) in pairs {
            self.insert(key, value);
        }
    }
}

impl<K: Ord, V> FromIterator<(K, V)> for SortedMap<K, V> {
    fn from_iter<I: IntoIterator<Item = (K, V)>>(pairs: I) -> Self {
        let mut pairs = list(pairs);
        order::by(&mut pairs, |a, b| a.0.cmp(&b.0));
        // Of pairs with equal keys the last one counts.
        pairs.dedup_by(|later, earlier| {
            let same = later.0 == earlier.0;
            if same {
                std::mem::swap(&mut later.1, &mut earlier.1);
            }
            same
        });
        SortedMap { pairs }
    }
}

impl<K: Ord, V, const N: usize> From<[(K, V); N]> for SortedMap<K, V> {
    fn from(pairs: [(K, V); N]) -> Self {
        pairs.into_iter().collect()
    }
}

impl<K, V> IntoIterator for SortedMap<K, V> {
    type Item = (K, V);
    type IntoIter = vec::IntoIter<(K, V)>;

    fn into_iter(self) -> Self::IntoIter {
        self.pairs.into_iter()
    }
}

impl<'a, K, V> IntoIterator for &'a SortedMap<K, V> {
    type Item = (&'a K, &'a V);
    type IntoIter = Pair<'a, K, V>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl<'a, K, V> IntoIterator for &'a mut SortedMap<K, V> {
    type Item = (&'a K, &'a mut V);
    type IntoIter = PairMut<'a, K, V>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter_mut()
    }
}

impl<'de, K, V> Deserialize<'de> for SortedMap<K, V>
where
    K: Deserialize<'de> + Ord,
    V: Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(Table(PhantomData))
    }
}

/// Reads a map from a table.
struct Table<K, V>(PhantomData<(K, V)>);

impl<'de, K, V> Visitor<'de> for Table<K, V>
where
    K: Deserialize<'de> + Ord,
    V: Deserialize<'de>,
{
    type Value = SortedMap<K, V>;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a map")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<Self::Value, A::Error> {
        let mut map = SortedMap::new();
        while let Some((key, value)) = table.next_entry()? {
            map.insert(key, value);
        }
        Ok(map)
    }
}

/// A set in the order of its elements.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SortedSet<T> {
    /// Each element once, in ascending order.
    items: Vec<T>,
}

impl<T> SortedSet<T> {
    /// An empty set.
    pub const fn new() -> Self {
        SortedSet { items: Vec::new() }
    }

    /// Whether it has no elements.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// How many elements it has.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Removes all elements.
    pub fn clear(&mut self) {
        self.items.clear();
    }

    /// All elements.
    pub fn iter(&self) -> slice::Iter<'_, T> {
        self.items.iter()
    }

    /// The smallest element.
    pub fn first(&self) -> Option<&T> {
        self.items.first()
    }

    /// The largest element.
    pub fn last(&self) -> Option<&T> {
        self.items.last()
    }

    /// Keeps the elements that are to stay.
    pub fn retain(&mut self, stays: impl FnMut(&T) -> bool) {
        self.items.retain(stays);
    }
}

impl<T: Ord> SortedSet<T> {
    /// Where an element is, or would be inserted.
    fn place<Q: Ord + ?Sized>(&self, item: &Q) -> Result<usize, usize>
    where
        T: Borrow<Q>,
    {
        place(self.items.len(), |i| self.items[i].borrow().cmp(item))
    }

    /// Whether it has an element.
    pub fn contains<Q: Ord + ?Sized>(&self, item: &Q) -> bool
    where
        T: Borrow<Q>,
    {
        self.place(item).is_ok()
    }

    /// Adds an element, and returns whether it is new.
    pub fn insert(&mut self, item: T) -> bool {
        let place = self.place(&item);
        if let Err(i) = place {
            self.items.insert(i, item);
        }
        place.is_err()
    }

    /// Removes an element, and returns whether it was there.
    pub fn remove<Q: Ord + ?Sized>(&mut self, item: &Q) -> bool
    where
        T: Borrow<Q>,
    {
        let place = self.place(item);
        if let Ok(i) = place {
            self.items.remove(i);
        }
        place.is_ok()
    }

    /// The elements in a range.
    pub fn range<Q: Ord + ?Sized>(&self, range: impl RangeBounds<Q>) -> slice::Iter<'_, T>
    where
        T: Borrow<Q>,
    {
        let places = span(self.len(), &range, |item| self.place(item));
        self.items[places].iter()
    }

    /// The elements that are in this set and not in the other.
    pub fn difference<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl DoubleEndedIterator<Item = &'a T> + Clone {
        self.items.iter().filter(|item| !other.contains(*item))
    }

    /// The elements that are in both sets.
    pub fn intersection<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl DoubleEndedIterator<Item = &'a T> + Clone {
        self.items.iter().filter(|item| other.contains(*item))
    }

    /// Whether no element is in both sets.
    pub fn is_disjoint(&self, other: &Self) -> bool {
        self.intersection(other).next().is_none()
    }
}

impl<T> Default for SortedSet<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: std::fmt::Debug> std::fmt::Debug for SortedSet<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

impl<T: Ord> Extend<T> for SortedSet<T> {
    fn extend<I: IntoIterator<Item = T>>(&mut self, items: I) {
        for item in items {
            self.insert(item);
        }
    }
}

impl<'a, T: Ord + Copy> Extend<&'a T> for SortedSet<T> {
    fn extend<I: IntoIterator<Item = &'a T>>(&mut self, items: I) {
        for &item in items {
            self.insert(item);
        }
    }
}

impl<T: Ord> FromIterator<T> for SortedSet<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        let mut items = list(items);
        order::sort(&mut items);
        items.dedup();
        SortedSet { items }
    }
}

impl<T: Ord, const N: usize> From<[T; N]> for SortedSet<T> {
    fn from(items: [T; N]) -> Self {
        items.into_iter().collect()
    }
}

impl<T> IntoIterator for SortedSet<T> {
    type Item = T;
    type IntoIter = vec::IntoIter<T>;

    fn into_iter(self) -> Self::IntoIter {
        self.items.into_iter()
    }
}

impl<'a, T> IntoIterator for &'a SortedSet<T> {
    type Item = &'a T;
    type IntoIter = slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::{BTreeMap, BTreeSet};

    /// What is done to a map: a key, and the value that it is given, or none if it is removed.
    type Steps = Vec<(u8, Option<u16>)>;

    fn steps() -> impl Strategy<Value = Steps> {
        prop::collection::vec((0..30u8, any::<Option<u16>>()), 0..80)
    }

    proptest! {
        #[test]
        fn maps_are_those_of_the_standard_library(steps in steps(), from in 0..30u8, to in 0..30u8) {
            let (mut map, mut expected) = (SortedMap::new(), BTreeMap::new());
            for &(key, value) in &steps {
                match value {
                    Some(value) => prop_assert_eq!(map.insert(key, value), expected.insert(key, value)),
                    None => prop_assert_eq!(map.remove(&key), expected.remove(&key)),
                }
                prop_assert_eq!(map.get(&from), expected.get(&from));
            }
            for (key, value) in steps.into_iter().take(9) {
                *map.entry(key).and_modify(|value| *value /= 2).or_default() |= value.unwrap_or(1);
                *expected.entry(key).and_modify(|value| *value /= 2).or_default() |= value.unwrap_or(1);
            }
            prop_assert!(map.iter().eq(&expected) && map.iter().rev().eq(expected.iter().rev()));
            prop_assert_eq!(map.first_key_value(), expected.first_key_value());
            prop_assert_eq!(format!("{map:?}"), format!("{expected:?}"));
            let to = to.max(from);
            prop_assert!(map.range(from..to).eq(expected.range(from..to)));
            prop_assert!(map.range(from..=to).eq(expected.range(from..=to)));
            prop_assert!(map.range(..to).eq(expected.range(..to)));
            let after = (Bound::Excluded(from), Bound::Unbounded);
            prop_assert!(map.range(after).eq(expected.range(after)));
            map.retain(|key, value| *value > 9 && *key != from);
            expected.retain(|key, value| *value > 9 && *key != from);
            prop_assert!(map.into_iter().eq(expected));
        }

        #[test]
        fn sets_are_those_of_the_standard_library(steps in steps(), from in 0..30u8) {
            let (mut set, mut expected) = (SortedSet::new(), BTreeSet::new());
            for &(item, stays) in &steps {
                match stays {
                    Some(_) => prop_assert_eq!(set.insert(item), expected.insert(item)),
                    None => prop_assert_eq!(set.remove(&item), expected.remove(&item)),
                }
            }
            prop_assert!(set.iter().eq(&expected) && set.range(from..).eq(expected.range(from..)));
            let (other, others): (SortedSet<u8>, BTreeSet<u8>) =
                (steps.iter().map(|step| step.0 / 2).collect(), steps.iter().map(|step| step.0 / 2).collect());
            prop_assert!(set.difference(&other).eq(expected.difference(&others)));
            prop_assert!(set.intersection(&other).eq(expected.intersection(&others)));
            prop_assert_eq!(set.is_disjoint(&other), expected.is_disjoint(&others));
            set.extend(&other);
            expected.extend(&others);
            prop_assert!(set.into_iter().eq(expected));
        }

        #[test]
        fn of_equal_keys_the_last_counts(pairs in prop::collection::vec((0..20u8, any::<u16>()), 0..60)) {
            let map: SortedMap<u8, u16> = pairs.iter().copied().collect();
            let expected: BTreeMap<u8, u16> = pairs.into_iter().collect();
            prop_assert!(map.iter().eq(&expected));
        }
    }
}
