//! Coils in branches of a step ladder that run at the same time.

use super::coils::{Coil, Place, Reads};
use super::drives::{Drives, Lasts};
use super::structure::{NONE, Nesting};
use super::{Code, Part};
use rungc_catalogue::Basic;
use rungc_syntax::{Device, DeviceClass};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::{BTreeMap, BTreeSet};

/// States looked at for all branches together; ordinary programs have far fewer.
const MAX_WORK: usize = 100_000;

/// Step ladders of a program: the states, and what follows each.
#[derive(Default)]
pub(super) struct Ladders {
    /// States to which each leads.
    leads: BTreeMap<Device, BTreeSet<Device>>,
    /// For each place at which branches begin together: the states before it, and the first state of each branch.
    forks: BTreeMap<(u32, u64), (BTreeSet<Device>, BTreeSet<Device>)>,
    /// Instructions under contacts: what they write may be off.
    conditional: FxHashSet<usize>,
    /// States in which each instruction of a section is: several, if STL follow each other.
    sections: FxHashMap<u32, BTreeSet<Device>>,
}

impl Ladders {
    pub(super) fn new(code: &Code, nesting: &Nesting) -> Self {
        let mut ladders = Ladders::default();
        let mut drives = Drives::default();
        let mut row = BTreeSet::new();
        for i in 0..code.len {
            let drive = drives.next(code, i);
            let stl = nesting.of(i).state;
            if stl == NONE {
                continue;
            }
            if code.basic(i) == Some(Basic::Stl) {
                let follows = i.checked_sub(1).and_then(|before| code.basic(before));
                if follows != Some(Basic::Stl) {
                    row.clear();
                }
                row.extend(code.device(i, 0));
                ladders.sections.insert(stl, row.clone());
                continue;
            }
            let state = code
                .device(i, 0)
                .filter(|device| device.class == DeviceClass::S);
            if let (Part::Start | Part::Continue, Some(state)) = (code.part(i), state) {
                // Branches are joined by contacts of states, too.
                ladders.sections.entry(stl).or_default().insert(state);
                continue;
            }
            let Some(drive) = drive else {
                continue;
            };
            if drive.lasts != Lasts::Always {
                ladders.conditional.insert(i);
            }
            if let (Some(Basic::Set | Basic::Out), Some(to)) = (code.basic(i), state) {
                let from = ladders.sections.entry(stl).or_default().clone();
                for &from in &from {
                    ladders.leads.entry(from).or_default().insert(to);
                }
                if code.basic(i) == Some(Basic::Set) {
                    let fork = ladders.forks.entry((stl, drive.signature)).or_default();
                    fork.0.extend(from);
                    fork.1.insert(to);
                }
            }
        }
        ladders.forks.retain(|_, (_, branches)| branches.len() > 1);
        ladders
    }

    /// The two places that drive a coil in branches that run at the same time, the later one last: the first pair by
    /// coil.
    pub(super) fn pairs(
        &self,
        driven: &BTreeMap<Coil, Vec<Place>>,
        reads: &Reads,
    ) -> BTreeMap<Coil, [usize; 2]> {
        let mut pairs = BTreeMap::new();
        let mut work = 0;
        for (before, first) in self.forks.values() {
            let branch_of = self.branches(before, first, &mut work);
            for (&coil, places) in driven {
                work += places.len();
                if work > MAX_WORK {
                    return pairs;
                }
                if let Some(pair) = self.pair(&branch_of, coil, places, reads) {
                    pairs.entry(coil).or_insert(pair);
                }
            }
        }
        pairs
    }

    /// The branch of each state that belongs to one branch alone.
    fn branches(
        &self,
        before: &BTreeSet<Device>,
        first: &BTreeSet<Device>,
        work: &mut usize,
    ) -> BTreeMap<Device, usize> {
        let mut branch_of: BTreeMap<Device, Option<usize>> = BTreeMap::new();
        for (branch, &state) in first.iter().enumerate() {
            let mut seen = BTreeSet::from([state]);
            let mut open = vec![state];
            while let Some(state) = open.pop().filter(|_| *work <= MAX_WORK) {
                *work += 1;
                let known = branch_of.entry(state).or_insert(Some(branch));
                if *known != Some(branch) {
                    *known = None;
                }
                let next = self.leads.get(&state).into_iter().flatten();
                let next = next.filter(|state| !before.contains(state));
                open.extend(next.filter(|state| seen.insert(**state)));
            }
        }
        let alone = branch_of.into_iter();
        alone
            .filter_map(|(state, branch)| Some((state, branch?)))
            .collect()
    }

    fn pair(
        &self,
        branch_of: &BTreeMap<Device, usize>,
        (device, bit): Coil,
        places: &[Place],
        reads: &Reads,
    ) -> Option<[usize; 2]> {
        let timer = matches!(device.class, DeviceClass::T | DeviceClass::C);
        let in_branch = places.iter().filter_map(|place| {
            let branch = branch_of.get(&place.condition.1?)?;
            (!place.is_word && bit.is_none()).then_some((branch, place))
        });
        let mut before: Option<(&usize, &Place)> = None;
        for (branch, place) in in_branch {
            if let Some((other, earlier)) = before
                && other != branch
                && (timer || self.conditional.contains(&place.at))
                && !reads.any(device, earlier, place)
            {
                return Some([earlier.at, place.at]);
            }
            before = Some((branch, place));
        }
        None
    }
}
