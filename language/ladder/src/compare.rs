//! Comparing two programs network by network.

pub mod text;

use crate::network::{Ladder, Network};
use rungc_analysis::latches;
use rungc_analysis::resolve::Resolved;
use rungc_syntax::{Device, Parameters, Program, align};
use std::collections::{BTreeSet, HashMap};

/// A program with its ladder.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// The program, resolved.
    pub resolved: &'a Resolved<'a>,
    /// Its ladder.
    pub ladder: &'a Ladder,
}

impl<'a> Drawn<'a> {
    /// A network by its position, from 0.
    pub fn network(self, at: usize) -> &'a Network {
        &self.ladder.networks[at]
    }

    /// Its instructions as they are compared, without steps, comments and places.
    pub fn instructions(self, at: usize) -> Vec<String> {
        let instrs = &self.resolved.program.instrs[self.network(at).instrs.clone()];
        instrs.iter().map(ToString::to_string).collect()
    }

    /// The statements and notes in a network, each with its instruction's position in it.
    fn remarks(self, at: usize) -> Vec<(usize, Option<&'a str>, Option<&'a str>)> {
        let instrs = &self.resolved.program.instrs[self.network(at).instrs.clone()];
        let remarks = instrs.iter().enumerate();
        remarks
            .map(|(at, instr)| (at, instr.statement(), instr.note()))
            .filter(|(_, statement, note)| statement.is_some() || note.is_some())
            .collect()
    }

    /// Operands that a network writes, as far as its instructions name them: those of the instructions at the right
    /// rail.
    fn outputs(self, at: usize) -> Vec<String> {
        let instrs = &self.resolved.program.instrs;
        let mut outputs = Vec::new();
        for instr in self.network(at).instrs.clone() {
            use crate::build::Class;
            if let Class::Output(_) | Class::Alone | Class::Label =
                crate::build::classify(&self.resolved.instrs[instr])
            {
                let first = instrs[instr].operands.first();
                let device = first.map_or(String::new(), |operand| operand.kind.to_string());
                outputs.push(format!("{} {device}", instrs[instr].mnemonic));
            }
        }
        outputs
    }
}

/// Change of a network. Positions of networks count from 0.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Change {
    /// It is new.
    Added {
        /// In the new program.
        new: usize,
    },
    /// It is gone.
    Removed {
        /// In the old program.
        old: usize,
    },
    /// Its instructions differ.
    Changed {
        /// In the old program.
        old: usize,
        /// In the new program.
        new: usize,
    },
    /// The same instructions are at another place among the other networks.
    Moved {
        /// In the old program.
        old: usize,
        /// In the new program.
        new: usize,
    },
    /// The same instructions have other statements or notes.
    Remarked {
        /// In the old program.
        old: usize,
        /// In the new program.
        new: usize,
    },
}

impl Change {
    /// Its positions in the old and in the new program, where it is there.
    pub fn places(self) -> [Option<usize>; 2] {
        match self {
            Change::Added { new } => [None, Some(new)],
            Change::Removed { old } => [Some(old), None],
            Change::Changed { old, new }
            | Change::Moved { old, new }
            | Change::Remarked { old, new } => [Some(old), Some(new)],
        }
    }

    /// The positions of the pictures that show it: one that only moved is shown once.
    pub(crate) fn shown(self) -> [Option<usize>; 2] {
        match self {
            Change::Moved { new, .. } => [None, Some(new)],
            _ => self.places(),
        }
    }

    /// Heading for the change.
    pub(crate) fn title(self) -> String {
        let verb = match self {
            Change::Remarked { .. } => "has other statements or notes",
            _ => self.verb(),
        };
        match self.places() {
            [Some(old), Some(new)] if old != new => {
                format!("Network {} {verb} (before: {})", new + 1, old + 1)
            }
            [_, Some(at)] | [Some(at), None] => format!("Network {} {verb}", at + 1),
            [None, None] => String::new(),
        }
    }

    /// Verb for the change.
    pub fn verb(self) -> &'static str {
        match self {
            Change::Added { .. } => "added",
            Change::Removed { .. } => "removed",
            Change::Changed { .. } => "changed",
            Change::Moved { .. } => "moved",
            Change::Remarked { .. } => "remarked",
        }
    }
}

/// A value that differs between two programs, if they have it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Differing<K> {
    /// Key of the value.
    pub key: K,
    /// In the old program.
    pub old: Option<String>,
    /// In the new program.
    pub new: Option<String>,
}

/// Differences between two programs.
#[derive(Clone, Default, PartialEq, Eq, Debug)]
pub struct Comparison {
    /// Their networks, in the order of the new program, a removed one where it was.
    pub networks: Vec<Change>,
    /// Comments of devices.
    pub comments: Vec<Differing<Device>>,
    /// Title, CPU type and the PLC's parameters.
    pub parameters: Vec<Differing<&'static str>>,
}

impl Comparison {
    /// Returns true if nothing differs.
    pub fn is_empty(&self) -> bool {
        self.networks.is_empty() && self.comments.is_empty() && self.parameters.is_empty()
    }

    /// Number of networks changed in this way.
    pub fn count(&self, verb: &str) -> usize {
        let changes = self.networks.iter();
        changes.filter(|change| change.verb() == verb).count()
    }
}

/// Compares two programs.
pub fn compare(old: Drawn, new: Drawn) -> Comparison {
    let programs = [old.resolved.program, new.resolved.program];
    Comparison {
        networks: networks(old, new),
        comments: comments(programs),
        parameters: parameters([old, new]),
    }
}

fn networks(old: Drawn, new: Drawn) -> Vec<Change> {
    let texts = |of: Drawn| -> Vec<Vec<String>> {
        let networks = 0..of.ladder.networks.len();
        networks.map(|at| of.instructions(at)).collect()
    };
    let (old_texts, new_texts) = (texts(old), texts(new));
    let same = align::common(&old_texts, &new_texts);
    let mut changes = Vec::new();
    for &(old_at, new_at) in &same {
        if old.remarks(old_at) != new.remarks(new_at) {
            changes.push(Change::Remarked {
                old: old_at,
                new: new_at,
            });
        }
    }
    let moved = moved(&same, &old_texts, &new_texts);
    let mut pairing = Pairing {
        old,
        new,
        old_texts: &old_texts,
        new_texts: &new_texts,
        moved: moved.iter().copied().unzip(),
        changes,
    };
    let (mut from, mut to) = (0, 0);
    let ends = (old_texts.len(), new_texts.len());
    for (old_at, new_at) in same.iter().copied().chain([ends]) {
        pairing.between(from..old_at, to..new_at);
        (from, to) = (old_at + 1, new_at + 1);
    }
    let mut changes = pairing.elsewhere();
    changes.extend(moved.iter().map(|&(old, new)| Change::Moved { old, new }));
    in_order(&mut changes, &same);
    changes
}

/// Networks that are the same but not in order: their positions, each once.
fn moved(
    same: &[(usize, usize)],
    old: &[Vec<String>],
    new: &[Vec<String>],
) -> BTreeSet<(usize, usize)> {
    let in_order: (BTreeSet<usize>, BTreeSet<usize>) = same.iter().copied().unzip();
    let mut waiting: HashMap<&[String], Vec<usize>> = HashMap::new();
    for (at, text) in old.iter().enumerate().rev() {
        if !in_order.0.contains(&at) {
            waiting.entry(text).or_default().push(at);
        }
    }
    let rest = new.iter().enumerate();
    let rest = rest.filter(|(at, _)| !in_order.1.contains(at));
    rest.filter_map(|(at, text)| Some((waiting.get_mut(&**text)?.pop()?, at)))
        .collect()
}

/// Sorts changes as a reader of the new program meets them; what was removed comes after what was before it.
fn in_order(changes: &mut [Change], same: &[(usize, usize)]) {
    changes.sort_by_key(|change| match change.places() {
        [_, Some(new)] => (new + 1, 1, 0),
        [Some(old), None] => {
            let before = same.partition_point(|pair| pair.0 < old);
            let after = before.checked_sub(1).map_or(0, |before| same[before].1 + 1);
            (after, 2, old)
        }
        [None, None] => (0, 0, 0),
    });
}

/// Finds out which networks between two equal ones became which.
struct Pairing<'a> {
    old: Drawn<'a>,
    new: Drawn<'a>,
    old_texts: &'a [Vec<String>],
    new_texts: &'a [Vec<String>],
    /// Networks that moved, in the old and in the new program.
    moved: (BTreeSet<usize>, BTreeSet<usize>),
    changes: Vec<Change>,
}

impl Pairing<'_> {
    /// Pairs networks that write the same; between those, networks in order that have enough in common.
    fn between(&mut self, old: std::ops::Range<usize>, new: std::ops::Range<usize>) {
        let old: Vec<usize> = old.filter(|at| !self.moved.0.contains(at)).collect();
        let new: Vec<usize> = new.filter(|at| !self.moved.1.contains(at)).collect();
        let outputs = |of: Drawn, all: &[usize]| -> Vec<Vec<String>> {
            all.iter().map(|at| of.outputs(*at)).collect()
        };
        let same = align::common(&outputs(self.old, &old), &outputs(self.new, &new));
        let (mut from, mut to) = (0, 0);
        for (old_at, new_at) in same.into_iter().chain([(old.len(), new.len())]) {
            self.alike(&old[from..old_at], &new[to..new_at]);
            if let (Some(&old), Some(&new)) = (old.get(old_at), new.get(new_at)) {
                self.changes.push(Change::Changed { old, new });
            }
            (from, to) = (old_at + 1, new_at + 1);
        }
    }

    /// All changes, where what was removed and what was added elsewhere, but writes the same, is one changed network.
    fn elsewhere(self) -> Vec<Change> {
        let mut removed: HashMap<Vec<String>, Vec<usize>> = HashMap::new();
        for change in self.changes.iter().rev() {
            if let Change::Removed { old } = *change {
                removed.entry(self.old.outputs(old)).or_default().push(old);
            }
        }
        let mut paired = BTreeSet::new();
        let mut changes = self.changes;
        for change in &mut changes {
            if let Change::Added { new } = *change {
                let same = removed.get_mut(&self.new.outputs(new));
                if let Some(old) = same.and_then(Vec::pop) {
                    paired.insert(old);
                    *change = Change::Changed { old, new };
                }
            }
        }
        changes.retain(|change| !matches!(change, Change::Removed { old } if paired.contains(old)));
        changes
    }

    /// Pairs each network with the next one that has half of its instructions.
    fn alike(&mut self, old: &[usize], new: &[usize]) {
        /// Number of networks tried: a changed network that was moved far appears as a new one to its reader.
        const NEAR: usize = 20;
        let mut rest = new;
        for &old in old {
            let near = &rest[..rest.len().min(NEAR)];
            let found = near.iter().position(|new| {
                let (old, new) = (&self.old_texts[old], &self.new_texts[*new]);
                2 * align::common(old, new).len() >= old.len().max(new.len())
            });
            let Some(at) = found else {
                self.changes.push(Change::Removed { old });
                continue;
            };
            let added = rest[..at].iter().map(|&new| Change::Added { new });
            self.changes.extend(added);
            self.changes.push(Change::Changed { old, new: rest[at] });
            rest = &rest[at + 1..];
        }
        let added = rest.iter().map(|&new| Change::Added { new });
        self.changes.extend(added);
    }
}

fn comments(programs: [&Program; 2]) -> Vec<Differing<Device>> {
    let devices = programs
        .iter()
        .flat_map(|program| program.comments.keys().copied());
    let differing = devices.collect::<BTreeSet<_>>().into_iter().map(|key| {
        let [old, new] = programs.map(|program| program.comments.get(&key).cloned());
        Differing { key, old, new }
    });
    differing
        .filter(|differing| differing.old != differing.new)
        .collect()
}

fn parameters(sides: [Drawn; 2]) -> Vec<Differing<&'static str>> {
    let [mut old, mut new] = sides.map(|side| settings(side.resolved.program));
    let has = |side: Drawn| side.resolved.program.parameters.is_some();
    if has(sides[0]) != has(sides[1]) {
        // A list states no parameters; what it leaves open is as usual.
        let latched = |side: Drawn<'_>| {
            let resolved = side.resolved;
            latches::ranges(resolved.program, resolved.model)
        };
        let is_same = latched(sides[0]) == latched(sides[1]);
        for side in [&mut old, &mut new] {
            for (key, value) in side {
                let is_usual = match *key {
                    "latched devices" => is_same,
                    "memory capacity" => true,
                    "comment blocks" | "file register blocks" => value.as_deref() == Some("0"),
                    _ => false,
                };
                if is_usual {
                    *value = None;
                }
            }
        }
    }
    let pairs = old.into_iter().zip(new);
    pairs
        .map(|((key, old), (_, new))| Differing { key, old, new })
        .filter(|differing| differing.old != differing.new)
        .collect()
}

/// Properties of a program and its PLC, in a fixed order.
fn settings(program: &Program) -> [(&'static str, Option<String>); 7] {
    let parameters = program.parameters.as_ref();
    let number = |of: fn(&Parameters) -> Option<u32>| {
        parameters.and_then(of).map(|number| number.to_string())
    };
    let latched = parameters.and_then(|parameters| parameters.latched.as_ref());
    let latched = latched.map(|runs| {
        let runs = runs.iter().filter(|run| run.count > 0);
        runs.map(ToString::to_string).collect::<Vec<_>>().join(", ")
    });
    let programs = parameters.map(|parameters| parameters.programs.join(", "));
    [
        ("title", program.title.clone()),
        ("CPU type", program.cpu.clone()),
        ("latched devices", latched),
        ("memory capacity", number(|of| of.capacity)),
        ("comment blocks", number(|of| Some(of.comment_blocks))),
        (
            "file register blocks",
            number(|of| Some(of.file_register_blocks)),
        ),
        ("program files", programs.filter(|names| !names.is_empty())),
    ]
}
