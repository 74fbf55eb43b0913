//! Logic of an output, as an expression of contacts, and outputs as instructions.

use super::modifiers::Edge;
use smol_str::SmolStr;

/// Arrangement of contacts between the left power rail and an output.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Logic {
    /// A contact or a comparison.
    Contact(Contact),
    /// A change of the result of all that precedes it in its series: INV, MEP, MEF.
    Result(SmolStr),
    /// One after the other; none is a wire.
    Series(Vec<Logic>),
    /// Beside each other.
    Parallel(Vec<Logic>),
}

/// A contact or a comparison.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Contact {
    /// The element that it is: two contacts of one device are different.
    pub element: u32,
    /// Condition under which it is closed.
    pub sense: Sense,
    /// Its device, or what it compares.
    pub operands: SmolStr,
}

/// Condition under which a contact is closed.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Sense {
    /// While its device is on.
    On,
    /// While its device is off.
    Off,
    /// In the scan in which its device turns on.
    Rising,
    /// In the scan in which its device turns off.
    Falling,
    /// While a comparison holds: what follows `LD`, such as `D>=`.
    Compare(SmolStr),
}

impl From<Edge> for Sense {
    fn from(edge: Edge) -> Self {
        match edge {
            Edge::Rising => Sense::Rising,
            Edge::Falling => Sense::Falling,
        }
    }
}

/// Operation by which a contact joins the preceding logic.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Entry {
    Start,
    Series,
    Parallel,
}

impl Contact {
    fn instruction(&self, entry: Entry) -> SmolStr {
        let plain = ["LD", "AND", "OR"][entry as usize];
        let mnemonic = match &self.sense {
            Sense::On => plain.into(),
            Sense::Off => ["LDI", "ANI", "ORI"][entry as usize].into(),
            Sense::Rising => smol_str::format_smolstr!("{plain}P"),
            Sense::Falling => smol_str::format_smolstr!("{plain}F"),
            Sense::Compare(how) => smol_str::format_smolstr!("{plain}{how}"),
        };
        smol_str::format_smolstr!("{mnemonic} {}", self.operands)
    }
}

impl Logic {
    /// A wire.
    pub fn wire() -> Self {
        Logic::Series(Vec::new())
    }

    /// A contact that is closed while a device is on, or off.
    pub fn contact(element: u32, on: bool, device: impl Into<SmolStr>) -> Self {
        Logic::Contact(Contact {
            element,
            sense: if on { Sense::On } else { Sense::Off },
            operands: device.into(),
        })
    }

    /// Returns true if it is nothing but a wire.
    pub(crate) fn is_wire(&self) -> bool {
        matches!(self.only(), Logic::Series(items) if items.is_empty())
    }

    /// This and what follows it.
    pub fn then(self, next: Logic) -> Self {
        let mut items = self.items();
        let next = next.items();
        if next.iter().any(|item| matches!(item, Logic::Result(_))) && !items.is_empty() {
            // It changes the result of what follows alone: a separate block.
            items.push(Logic::Parallel(vec![Logic::Series(next)]));
        } else {
            items.extend(next);
        }
        Logic::Series(items)
    }

    /// Returns true if the result of all of it is changed by INV, MEP or MEF.
    pub fn is_changed(&self) -> bool {
        match self {
            Logic::Series(items) => items.iter().any(|item| matches!(item, Logic::Result(_))),
            Logic::Result(_) => true,
            Logic::Contact(_) | Logic::Parallel(_) => false,
        }
    }

    /// It with its result changed by INV, MEP or MEF.
    pub fn changed(self, by: &str) -> Self {
        if self.is_wire() {
            let always = by == "INV";
            return Logic::contact(0, !always, "M8000");
        }
        let mut items = self.items();
        match (items.as_mut_slice(), by) {
            ([Logic::Contact(contact)], "INV") if contact.sense == Sense::On => {
                contact.sense = Sense::Off;
            }
            ([Logic::Contact(contact)], "INV") if contact.sense == Sense::Off => {
                contact.sense = Sense::On;
            }
            _ => items.push(Logic::Result(by.into())),
        }
        Logic::Series(items)
    }

    /// It as a pulse of one scan at its edge.
    pub fn pulsed(self, edge: Edge) -> Self {
        if self.is_wire() {
            return match edge {
                Edge::Rising => Logic::contact(0, true, "M8002"),
                Edge::Falling => Logic::contact(0, false, "M8000"),
            };
        }
        let mut items = self.items();
        if let [Logic::Contact(contact)] = items.as_mut_slice() {
            match contact.sense {
                Sense::On => {
                    contact.sense = edge.into();
                    return Logic::Series(items);
                }
                Sense::Off => {
                    contact.sense = edge.opposite().into();
                    return Logic::Series(items);
                }
                _ => {}
            }
        }
        Logic::Series(items).changed(match edge {
            Edge::Rising => "MEP",
            Edge::Falling => "MEF",
        })
    }

    /// First element, unless it is a wire.
    pub fn first(&self) -> Option<&Logic> {
        match self {
            Logic::Series(items) => items.first(),
            other => Some(other),
        }
    }

    /// Elements in series.
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
        let changes = |way: &Vec<Logic>| way.iter().any(|item| matches!(item, Logic::Result(_)));
        let same = |at: usize| ways.iter().all(|way| way.get(at) == first.get(at));
        let most = match ways.len() > 1 && ways.iter().any(changes) {
            true => 0,
            false => first.len(),
        };
        let common = (0..most).take_while(|at| same(*at)).count();
        let mut before: Vec<_> = ways[0][..common].to_vec();
        for way in &mut ways {
            way.drain(..common);
        }
        ways.dedup();
        if ways.iter().all(|way| !way.is_empty()) {
            before.push(Logic::Parallel(branches(&ways)));
        }
        Logic::Series(before)
    }

    /// Number of contacts.
    pub fn size(&self) -> usize {
        match self {
            Logic::Contact(_) | Logic::Result(_) => 1,
            Logic::Series(items) | Logic::Parallel(items) => items.iter().map(Logic::size).sum(),
        }
    }

    /// Returns true if a contact or a comparison in it names the device.
    pub fn names(&self, device: &str) -> bool {
        match self {
            Logic::Contact(contact) => contact.operands.split(' ').any(|word| word == device),
            Logic::Result(_) => false,
            Logic::Series(items) | Logic::Parallel(items) => {
                items.iter().any(|item| item.names(device))
            }
        }
    }

    fn write(&self, entry: Entry, out: &mut Vec<SmolStr>) {
        match self.only() {
            Logic::Contact(contact) => out.push(contact.instruction(entry)),
            Logic::Result(change) => out.push(change.clone()),
            Logic::Series(items) => {
                let start = if entry == Entry::Series {
                    entry
                } else {
                    Entry::Start
                };
                series(items, start, out);
                if entry == Entry::Parallel {
                    out.push("ORB".into());
                }
            }
            Logic::Parallel(branches) => {
                for (nth, branch) in branches.iter().enumerate() {
                    let entry = if nth == 0 {
                        Entry::Start
                    } else {
                        Entry::Parallel
                    };
                    branch.write(entry, out);
                }
                match entry {
                    Entry::Start => {}
                    Entry::Series => out.push("ANB".into()),
                    Entry::Parallel => out.push("ORB".into()),
                }
            }
        }
    }

    /// The only element, if there is one.
    fn only(&self) -> &Logic {
        match self {
            Logic::Series(items) => match items.as_slice() {
                [one] => one.only(),
                _ => self,
            },
            // A branch alone is a separate block if its result is changed.
            Logic::Parallel(branches) => match branches.as_slice() {
                [one] if !matches!(one, Logic::Series(items) if items.len() > 1) => one.only(),
                _ => self,
            },
            Logic::Contact(_) | Logic::Result(_) => self,
        }
    }
}

/// Ways beside each other, none of them a wire. Those that begin with the same contact part after it.
fn branches(ways: &[Vec<Logic>]) -> Vec<Logic> {
    let mut branches = Vec::new();
    let alike = ways.chunk_by(|a, b| a.first() == b.first());
    for group in alike {
        let changed = |way: &Vec<Logic>| way.iter().any(|item| matches!(item, Logic::Result(_)));
        let parts = group.len() < ways.len() && !group.iter().any(changed);
        let joined = match group {
            [_, _, ..] if parts => {
                let group = group.iter().cloned().map(Logic::Series);
                vec![Logic::joined(group.collect())]
            }
            _ => group.iter().cloned().map(Logic::Series).collect(),
        };
        for way in joined {
            match <[Logic; 1]>::try_from(way.items()) {
                Ok([Logic::Parallel(inner)]) => branches.extend(inner),
                Ok([other]) => branches.push(other),
                Err(way) => branches.push(Logic::Series(way)),
            }
        }
    }
    branches
}

/// Parts in series.
fn series(items: &[Logic], mut entry: Entry, out: &mut Vec<SmolStr>) {
    for item in items {
        item.write(entry, out);
        entry = Entry::Series;
    }
}

/// Output driven by contacts.
#[derive(Clone, Debug)]
pub(super) struct Output {
    /// Logic of the output.
    pub logic: Logic,
    /// Its instructions.
    pub lines: Vec<SmolStr>,
    /// True if its instructions begin separate networks, which nothing can follow.
    pub alone: bool,
    /// True if it is connected to the rail without a contact, as RET is.
    pub bare: bool,
}

/// A part of a program.
#[derive(Clone, Debug)]
pub(super) enum Part {
    /// A line without an instruction, or a label.
    Line(String),
    /// Something that contacts drive.
    Output(Output),
}

/// The lines of a program.
pub(super) fn lines(parts: Vec<Part>) -> Vec<SmolStr> {
    let mut out = Vec::new();
    let mut network: Vec<(Vec<Logic>, Output)> = Vec::new();
    for part in parts {
        match part {
            Part::Line(line) => {
                flush(&mut network, &mut out);
                out.push(line.into());
            }
            Part::Output(output) => {
                let mut items = output.logic.clone().items();
                if items.is_empty() && !output.bare {
                    // A coil at the rail is always on.
                    items.push(Logic::contact(0, true, "M8000"));
                }
                let apart = output.bare && items.is_empty() || output.alone;
                let follows = network.last().is_some_and(|(last, before)| {
                    last.first() == items.first() && !before.alone && !apart
                });
                if !follows {
                    flush(&mut network, &mut out);
                }
                network.push((items, output));
            }
        }
    }
    flush(&mut network, &mut out);
    out
}

/// Writes the outputs of a network: all begin with the same contact.
fn flush(network: &mut Vec<(Vec<Logic>, Output)>, out: &mut Vec<SmolStr>) {
    let outputs: Vec<_> = network
        .iter()
        .map(|(items, output)| (items.as_slice(), output))
        .collect();
    node(&outputs, Entry::Start, out);
    network.clear();
}

/// Outputs that a node feeds, with what is between it and each.
fn node(outputs: &[(&[Logic], &Output)], mut entry: Entry, out: &mut Vec<SmolStr>) {
    let mut outputs = outputs.to_vec();
    while let Some((first, _)) = outputs.first() {
        let same = |at: usize| {
            let at_first = first.get(at);
            outputs.iter().all(|(items, _)| items.get(at) == at_first)
        };
        let common = (0..first.len()).take_while(|at| same(*at)).count();
        series(&first[..common], entry, out);
        for (items, _) in &mut outputs {
            *items = &items[common..];
        }
        let direct = outputs.iter().take_while(|(items, _)| items.is_empty());
        let direct = direct.count();
        for (_, output) in outputs.drain(..direct) {
            out.extend(output.lines.iter().cloned());
        }
        entry = Entry::Series;
        let groups: Vec<_> = outputs
            .chunk_by(|(a, _), (b, _)| a.first() == b.first())
            .collect();
        if groups.len() > 1 {
            stack(&groups, out);
            return;
        }
    }
}

/// Branches after MPS, MRD and MPP.
fn stack(groups: &[&[(&[Logic], &Output)]], out: &mut Vec<SmolStr>) {
    for (nth, group) in groups.iter().enumerate() {
        out.push(match nth {
            0 => "MPS".into(),
            _ if nth + 1 == groups.len() => "MPP".into(),
            _ => "MRD".into(),
        });
        node(group, Entry::Series, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(element: u32, device: &str) -> Logic {
        Logic::contact(element, true, device)
    }

    fn list(outputs: &[(&Logic, &str)]) -> String {
        let parts = outputs.iter().map(|(logic, line)| {
            Part::Output(Output {
                logic: (*logic).clone(),
                lines: vec![(*line).into()],
                alone: false,
                bare: false,
            })
        });
        lines(parts.collect()).join(", ")
    }

    #[test]
    fn branches_become_blocks() {
        let a = || contact(1, "X000");
        let wide = Logic::joined(vec![
            a().then(contact(2, "X001")),
            a().then(contact(3, "X002")),
        ]);
        let all = wide.then(Logic::contact(4, false, "X003"));
        assert_eq!(
            list(&[(&all, "OUT Y000")]),
            "LD X000, LD X001, OR X002, ANB, ANI X003, OUT Y000"
        );
        let long = |element, n: &str| contact(element, n).then(contact(element + 1, "M1"));
        let ways = Logic::joined(vec![long(1, "X000"), long(3, "X001"), contact(5, "X002")]);
        assert_eq!(
            list(&[(&ways, "OUT Y000")]),
            "LD X000, AND M1, LD X001, AND M1, ORB, OR X002, OUT Y000"
        );
        let fork = || contact(7, "X004");
        let nested = Logic::joined(vec![
            fork().then(contact(8, "X005")),
            fork().then(contact(9, "X006")),
            contact(10, "M2"),
        ]);
        assert_eq!(
            list(&[(&nested, "OUT Y000")]),
            "LD X004, LD X005, OR X006, ANB, OR M2, OUT Y000"
        );
        let bridged = Logic::joined(vec![a(), a().then(contact(6, "X001"))]);
        assert_eq!(list(&[(&bridged, "OUT Y000")]), "LD X000, OUT Y000");
        assert_eq!(list(&[(&Logic::wire(), "OUT Y000")]), "LD M8000, OUT Y000");
    }

    #[test]
    fn outputs_share_what_leads_to_them() {
        let a = contact(1, "X000");
        let b = a.clone().then(contact(2, "X001"));
        let c = a.clone().then(contact(3, "X001"));
        let other = contact(4, "X000");
        assert_eq!(
            list(&[
                (&b, "OUT Y0"),
                (&c, "OUT Y1"),
                (&a, "OUT Y2"),
                (&other, "OUT Y3")
            ]),
            "LD X000, MPS, AND X001, OUT Y0, MRD, AND X001, OUT Y1, MPP, OUT Y2, LD X000, OUT Y3"
        );
        assert_eq!(
            list(&[(&a, "OUT Y0"), (&b, "OUT Y1"), (&b, "OUT Y2")]),
            "LD X000, OUT Y0, AND X001, OUT Y1, OUT Y2"
        );
    }

    #[test]
    fn changed_results_stay_what_they_change() {
        let both = contact(1, "X000").then(contact(2, "X001"));
        let not = both.clone().changed("INV");
        assert_eq!(list(&[(&not, "OUT Y0")]), "LD X000, AND X001, INV, OUT Y0");
        let after = contact(3, "M0").then(not.clone());
        assert_eq!(
            list(&[(&after, "OUT Y0")]),
            "LD M0, LD X000, AND X001, INV, ANB, OUT Y0"
        );
        let beside = Logic::joined(vec![both, not]);
        assert_eq!(
            list(&[(&beside, "OUT Y0")]),
            "LD X000, AND X001, LD X000, AND X001, INV, ORB, OUT Y0"
        );
        assert_eq!(
            Logic::wire().changed("INV"),
            Logic::contact(0, false, "M8000")
        );
    }
}
