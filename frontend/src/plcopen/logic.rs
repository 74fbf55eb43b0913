//! What leads to a coil, as an expression of contacts, and that expression as instructions.

use smol_str::SmolStr;

/// How contacts stand to each other between the left power rail and a coil.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Logic {
    /// A contact: what is appended to `LD`, `AND` or `OR` (nothing, `I`, `P`, `F`), and its device.
    Contact(Sense, SmolStr),
    /// One after the other; none is a wire.
    Series(Vec<Logic>),
    /// Beside each other.
    Parallel(Vec<Logic>),
}

/// When a contact is closed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sense {
    /// While its device is on.
    On,
    /// While its device is off.
    Off,
    /// In the scan in which its device turns on.
    Rising,
    /// In the scan in which its device turns off.
    Falling,
}

impl Sense {
    /// The mnemonics of a contact that begins, continues and widens a network.
    fn mnemonics(self) -> [&'static str; 3] {
        match self {
            Sense::On => ["LD", "AND", "OR"],
            Sense::Off => ["LDI", "ANI", "ORI"],
            Sense::Rising => ["LDP", "ANDP", "ORP"],
            Sense::Falling => ["LDF", "ANDF", "ORF"],
        }
    }
}

impl Logic {
    /// A wire.
    pub fn wire() -> Self {
        Logic::Series(Vec::new())
    }

    /// This and what follows it.
    pub fn then(self, next: Logic) -> Self {
        let mut items = self.items();
        items.extend(next.items());
        Logic::Series(items)
    }

    /// What is one after the other in it.
    fn items(self) -> Vec<Logic> {
        match self {
            Logic::Series(items) => items,
            other => vec![other],
        }
    }

    /// Ways that meet: what all of them begin with stands before the junction that they part at. A wire among them
    /// makes the others pointless.
    pub fn joined(ways: Vec<Logic>) -> Self {
        let mut ways: Vec<_> = ways.into_iter().map(Logic::items).collect();
        let Some(first) = ways.first() else {
            return Logic::wire();
        };
        let same = |at: usize| ways.iter().all(|way| way.get(at) == first.get(at));
        let common = (0..first.len()).take_while(|at| same(*at)).count();
        let mut before: Vec<_> = ways[0][..common].to_vec();
        for way in &mut ways {
            way.drain(..common);
        }
        ways.dedup();
        if ways.iter().all(|way| !way.is_empty()) {
            let ways = ways.into_iter().map(Logic::Series).collect();
            before.push(Logic::Parallel(ways));
        }
        Logic::Series(before)
    }

    /// The instructions that compute it.
    pub fn instructions(&self) -> Vec<SmolStr> {
        let mut out = Vec::new();
        self.write(&mut out);
        if out.is_empty() {
            // A coil at the rail is always on.
            out.push("LD M8000".into());
        }
        out
    }

    fn write(&self, out: &mut Vec<SmolStr>) {
        let contact = |place: usize, item: &Logic| match item {
            Logic::Contact(sense, device) => Some(smol_str::format_smolstr!(
                "{} {device}",
                sense.mnemonics()[place]
            )),
            _ => None,
        };
        let (items, place, join) = match self {
            Logic::Contact(..) => {
                out.extend(contact(0, self));
                return;
            }
            Logic::Series(items) => (items, 1, "ANB"),
            Logic::Parallel(items) => (items, 2, "ORB"),
        };
        for (nth, item) in items.iter().enumerate() {
            let item = item.only();
            match contact(if nth == 0 { 0 } else { place }, item) {
                Some(instruction) => out.push(instruction),
                None => {
                    item.write(out);
                    if nth > 0 {
                        out.push(join.into());
                    }
                }
            }
        }
    }

    /// What stands alone in it.
    fn only(&self) -> &Logic {
        match self {
            Logic::Series(items) | Logic::Parallel(items) => match items.as_slice() {
                [one] => one.only(),
                _ => self,
            },
            Logic::Contact(..) => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(device: &str) -> Logic {
        Logic::Contact(Sense::On, device.into())
    }

    #[test]
    fn branches_become_blocks() {
        let a = || contact("X000");
        let wide = Logic::joined(vec![a().then(contact("X001")), a().then(contact("X002"))]);
        let all = wide.then(Logic::Contact(Sense::Off, "X003".into()));
        assert_eq!(
            all.instructions(),
            ["LD X000", "LD X001", "OR X002", "ANB", "ANI X003"]
        );
        let long = |n: &str| contact(n).then(contact("M1"));
        let ways = Logic::joined(vec![long("X000"), long("X001"), contact("X002")]);
        assert_eq!(
            ways.instructions(),
            ["LD X000", "AND M1", "LD X001", "AND M1", "ORB", "OR X002"]
        );
        let bridged = Logic::joined(vec![a(), a().then(contact("X001"))]);
        assert_eq!(bridged.instructions(), ["LD X000"]);
        assert_eq!(Logic::wire().instructions(), ["LD M8000"]);
    }
}
