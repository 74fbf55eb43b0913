//! Correspondence of atoms, and the atoms whose order matters.

use super::atoms::{Atom, Run, Sequence, Uses};
use rungc_syntax::{DeviceClass, align};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeSet, VecDeque};
use std::ops::Range;

/// An atom that both modules have.
pub(super) struct Pair {
    /// Its places in the old and in the new sequence.
    pub at: [usize; 2],
    /// True if it moved among the others.
    moved: bool,
}

/// The atoms that both modules have, function by function.
pub(super) fn pairs(sequences: &[Sequence; 2]) -> Vec<Pair> {
    let [old, new] = sequences;
    let mut pairs = Vec::new();
    for (kind, range) in &old.functions {
        if let Some((_, other)) = new.functions.iter().find(|(other, _)| other == kind) {
            of_function(sequences, [range, other], &mut pairs);
        }
    }
    pairs
}

fn of_function(sequences: &[Sequence; 2], ranges: [&Range<usize>; 2], pairs: &mut Vec<Pair>) {
    let texts = [0, 1].map(|side| {
        let atoms = &sequences[side].atoms[ranges[side].clone()];
        atoms.iter().map(|atom| atom.text).collect::<Vec<_>>()
    });
    let [first, other] = ranges.map(|range| range.start);
    let in_order = align::common(&texts[0], &texts[1]);
    let mut left = [0, 1].map(|side| BTreeSet::from_iter(ranges[side].clone()));
    // Atoms across which nothing moves, of those that did not move themselves.
    let mut fixed: [Vec<usize>; 2] = Default::default();
    for (a, b) in in_order {
        let at = [first + a, other + b];
        for side in [0, 1] {
            left[side].remove(&at[side]);
            if is_fixed(&sequences[side], at[side]) {
                fixed[side].push(at[side]);
            }
        }
        pairs.push(Pair { at, moved: false });
    }
    let mut by_text: FxHashMap<u32, VecDeque<usize>> = FxHashMap::default();
    for &at in &left[0] {
        let text = sequences[0].atoms[at].text;
        by_text.entry(text).or_default().push_back(at);
    }
    for &new in &left[1] {
        let text = sequences[1].atoms[new].text;
        let Some(old) = by_text.get_mut(&text).and_then(VecDeque::pop_front) else {
            continue;
        };
        let at = [old, new];
        let before = [0, 1].map(|side| fixed[side].partition_point(|fixed| *fixed < at[side]));
        let stays = [0, 1].map(|side| is_fixed(&sequences[side], at[side]));
        if before[0] == before[1] && stays == [false, false] {
            pairs.push(Pair { at, moved: true });
        }
    }
}

/// Returns true if nothing moves across an atom: it, or a function that it calls, reaches everything.
fn is_fixed(sequence: &Sequence, at: usize) -> bool {
    let atom = &sequence.atoms[at];
    let reaches = |atom: &Atom| atom.reads.all || atom.writes.all;
    atom.fixed || called(sequence, atom).any(|range| sequence.atoms[range].iter().any(reaches))
}

/// The atoms of the functions that an atom calls, directly or not.
fn called<'a>(sequence: &'a Sequence, atom: &Atom) -> impl Iterator<Item = Range<usize>> + use<'a> {
    let mut found = FxHashSet::default();
    let mut open: Vec<usize> = atom.calls.into_iter().collect();
    while let Some(function) = open.pop() {
        let known = sequence.functions.get(function);
        let Some((_, range)) = known.filter(|_| found.insert(function)) else {
            continue;
        };
        open.extend(
            sequence.atoms[range.clone()]
                .iter()
                .filter_map(|atom| atom.calls),
        );
    }
    let ranges = found.into_iter();
    ranges.map(|function| sequence.functions[function].1.clone())
}

/// Devices and names that moved atoms read or write in another order than before.
///
/// For each such thing, the atoms that write it must come in the same order, and each that reads it after the same one:
/// then it has the same value wherever it is read.
pub(super) fn disorder(sequences: &[Sequence; 2], pairs: &[Pair]) -> Uses {
    let mut found = Uses::default();
    let Some(places) = Places::of_moved(sequences, pairs) else {
        return found;
    };
    let mut users: FxHashMap<usize, Vec<User>> = FxHashMap::default();
    let mut known: [FxHashMap<usize, Accesses>; 2] = Default::default();
    for pair in pairs {
        let mut reads = BTreeSet::new();
        let mut writes = BTreeSet::new();
        for side in [0, 1] {
            let sequence = &sequences[side];
            let atom = &sequence.atoms[pair.at[side]];
            places.expand(&atom.reads, &mut reads);
            places.expand(&atom.writes, &mut writes);
            if let Some(function) = atom.calls {
                let inside = known[side]
                    .entry(function)
                    .or_insert_with(|| places.inside(sequence, atom));
                reads.extend(&inside.reads);
                writes.extend(&inside.writes);
            }
        }
        for &place in reads.iter().chain(writes.difference(&reads)) {
            users.entry(place).or_default().push(User {
                at: pair.at,
                reads: reads.contains(&place),
                writes: writes.contains(&place),
            });
        }
    }
    for (place, users) in &mut users {
        if in_disorder(users) {
            places.name(*place, &mut found);
        }
    }
    found
}

/// An atom that reads or writes something.
struct User {
    at: [usize; 2],
    reads: bool,
    writes: bool,
}

fn in_disorder(users: &mut [User]) -> bool {
    users.sort_by_key(|user| user.at);
    let writers = users.iter().filter(|user| user.writes);
    let writers: Vec<[usize; 2]> = writers.map(|user| user.at).collect();
    let sorted = writers.is_sorted_by_key(|at| at[1]);
    let before = |side: usize, user: &User| {
        let at = user.at[side];
        writers.partition_point(|writer| writer[side] < at)
    };
    let mut readers = users.iter().filter(|user| user.reads);
    !sorted || readers.any(|user| before(0, user) != before(1, user))
}

/// Uses of a function, by places.
struct Accesses {
    reads: BTreeSet<usize>,
    writes: BTreeSet<usize>,
}

/// Places that moved atoms use: names, and runs of devices that no atom uses in part.
struct Places {
    names: FxHashMap<u32, usize>,
    runs: FxHashMap<DeviceClass, Vec<(u32, u32, usize)>>,
}

impl Places {
    fn of_moved(sequences: &[Sequence; 2], pairs: &[Pair]) -> Option<Self> {
        let mut used = Uses::default();
        for pair in pairs.iter().filter(|pair| pair.moved) {
            for (sequence, at) in sequences.iter().zip(pair.at) {
                let atom = &sequence.atoms[at];
                let inside = called(sequence, atom).flat_map(|range| &sequence.atoms[range]);
                for atom in inside.chain([atom]) {
                    for uses in [&atom.reads, &atom.writes] {
                        used.names.extend(&uses.names);
                        used.runs.extend(&uses.runs);
                    }
                }
            }
        }
        if used.names.is_empty() && used.runs.is_empty() {
            return None;
        }
        let mut count = 0;
        let mut next = || {
            count += 1;
            count
        };
        let mut names = FxHashMap::default();
        for name in used.names {
            names.entry(name).or_insert_with(&mut next);
        }
        let mut cuts: FxHashMap<DeviceClass, BTreeSet<u32>> = FxHashMap::default();
        for atom in sequences.iter().flat_map(|sequence| &sequence.atoms) {
            for &(class, first, last) in atom.reads.runs.iter().chain(&atom.writes.runs) {
                cuts.entry(class).or_default().extend([first, last + 1]);
            }
        }
        let mut firsts: BTreeSet<(DeviceClass, u32)> = BTreeSet::new();
        for (class, first, last) in used.runs {
            let cuts = cuts.get(&class).into_iter();
            let inside = cuts.flat_map(|cuts| cuts.range(first..=last));
            firsts.extend(inside.map(|cut| (class, *cut)));
        }
        let mut runs: FxHashMap<DeviceClass, Vec<(u32, u32, usize)>> = FxHashMap::default();
        for (class, first) in firsts {
            let next_cut = cuts
                .get(&class)
                .and_then(|cuts| cuts.range(first + 1..).next());
            let last = next_cut.map_or(first, |cut| cut - 1);
            runs.entry(class).or_default().push((first, last, next()));
        }
        Some(Places { names, runs })
    }

    /// The places that something uses.
    fn expand(&self, uses: &Uses, places: &mut BTreeSet<usize>) {
        places.extend(uses.names.iter().filter_map(|name| self.names.get(name)));
        for (class, first, last) in &uses.runs {
            let Some(runs) = self.runs.get(class) else {
                continue;
            };
            let start = runs.partition_point(|run| run.0 < *first);
            let used = runs[start..].iter().take_while(|run| run.0 <= *last);
            places.extend(used.map(|run| run.2));
        }
    }

    /// The places that the functions which an atom calls use.
    fn inside(&self, sequence: &Sequence, atom: &Atom) -> Accesses {
        let mut accesses = Accesses {
            reads: BTreeSet::new(),
            writes: BTreeSet::new(),
        };
        for inner in called(sequence, atom).flat_map(|range| &sequence.atoms[range]) {
            self.expand(&inner.reads, &mut accesses.reads);
            self.expand(&inner.writes, &mut accesses.writes);
        }
        accesses
    }

    /// Adds what a place is.
    fn name(&self, place: usize, found: &mut Uses) {
        let name = self.names.iter().find(|(_, number)| **number == place);
        found.names.extend(name.map(|(name, _)| *name));
        for (class, runs) in &self.runs {
            let run = runs.binary_search_by_key(&place, |run| run.2);
            let run: Option<Run> = run.ok().map(|at| (*class, runs[at].0, runs[at].1));
            found.runs.extend(run);
        }
    }
}
