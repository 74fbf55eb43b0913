//! Causes of a device's state, and of the states that it depends on.

use crate::answer::{Cause, Link, Progress, Reason, Since};
use crate::explain::{Explainer, state};
use crate::graph::{FactKind, Id, Node};
use crate::history::History;
use crate::sets::{Atom, Sets, View};
use crate::trace::Trace;
use crate::words::is;
use rungc_catalogue::Basic;
use rungc_ir::node::EdgeId;
use rungc_models::runs::is_special;
use rungc_sim::record::Reading;
use rungc_sim::{Session, Target};
use rungc_syntax::{Device, DeviceClass, OperandKind, Phrase, phrase};

/// Number of devices whose causes are given at most.
const MOST_CAUSES: usize = 40;

/// A moment that is explained.
pub(crate) struct Now<'a> {
    pub(crate) session: &'a Session<'a>,
    pub(crate) trace: Trace,
    pub(crate) history: Option<&'a History>,
}

/// A search for causes.
pub(crate) struct Search<'a> {
    explainer: &'a Explainer<'a>,
    now: &'a Now<'a>,
    causes: Vec<Cause>,
    known: Vec<Device>,
    because: Vec<Link>,
}

impl<'a> Search<'a> {
    pub(crate) fn new(explainer: &'a Explainer<'a>, now: &'a Now<'a>) -> Self {
        Search {
            explainer,
            now,
            causes: Vec::new(),
            known: Vec::new(),
            because: Vec::new(),
        }
    }

    /// The causes, and what they end at.
    pub(crate) fn found(self) -> (Vec<Cause>, Vec<Link>) {
        (self.causes, self.because)
    }

    /// A device's state, and those that it depends on. `first` holds on the way of first sets from the device that is
    /// asked for.
    pub(crate) fn device(&mut self, device: Device, above: &mut Vec<Device>, first: bool) {
        if self.known.contains(&device) || self.causes.len() == MOST_CAUSES {
            return;
        }
        self.known.push(device);
        let trace = &self.now.trace;
        let node = trace.bits.get(&device).copied();
        let on = match node {
            Some(node) => trace.graph.value(node),
            None => state(self.now.session.machine(), device),
        };
        let view = View {
            graph: &trace.graph,
            own: device,
            deep: false,
        };
        let sets = node.map(|node| view.smallest(node)).unwrap_or_default();
        let (at, reason) = self.reason(device);
        let at_cause = self.causes.len();
        self.causes.push(Cause {
            device: device.to_string(),
            comment: self.explainer.words.comment(device),
            on,
            reason,
            at: at.map(|instr| self.explainer.words.place(instr)),
            holds_itself: node.is_some_and(|node| view.holds_itself(node)),
            progress: self.progress(device),
            sets: Vec::new(),
            more: sets.more,
            since: self.since(device, node),
            notes: Vec::new(),
        });
        let nodes = node.map(|node| view.atoms(node)).unwrap_or_default();
        above.push(device);
        self.links(at_cause, &sets, &nodes, above, first);
        above.pop();
    }

    /// The drive of an instruction that writes a device.
    pub(crate) fn drive(&mut self, device: Device, instr: usize) {
        let trace = &self.now.trace;
        let Some(drive) = trace.drives.get(&instr) else {
            return;
        };
        let view = View {
            graph: &trace.graph,
            own: device,
            deep: false,
        };
        let sets = view.smallest(drive.on);
        let at_cause = self.causes.len();
        self.causes.push(Cause {
            device: device.to_string(),
            comment: self.explainer.words.comment(device),
            on: trace.graph.value(drive.on) && trace.executed.contains(&instr),
            reason: Reason::Drive,
            at: Some(self.explainer.words.place(instr)),
            holds_itself: false,
            progress: None,
            sets: Vec::new(),
            more: sets.more,
            since: None,
            notes: Vec::new(),
        });
        let nodes = view.atoms(drive.on);
        self.links(at_cause, &sets, &nodes, &mut vec![device], true);
    }

    /// Gives a cause its sets, and finds the causes of their members.
    fn links(
        &mut self,
        at: usize,
        sets: &Sets,
        nodes: &[(Atom, Id)],
        above: &mut Vec<Device>,
        first: bool,
    ) {
        let mut next = Vec::new();
        let mut all = Vec::new();
        // Where each member alone would change the state, all of them keep it.
        let each_alone = !sets.more && sets.sets.iter().all(|set| set.len() == 1);
        for (n, set) in sets.sets.iter().enumerate() {
            let first = first && (n == 0 || each_alone);
            let mut links = Vec::new();
            for atom in set {
                let Some((_, id)) = nodes.iter().find(|(other, _)| other == atom) else {
                    continue;
                };
                let mut link = self.link(*id);
                match *atom {
                    Atom::Contact(device, _) | Atom::Start(device) => {
                        next.push((device, *id, first));
                    }
                    Atom::Memory(memory) => match self.before(*id, memory, above) {
                        Some((needed, members)) => {
                            link.needed = phrase!("{needed} in the scan before", needed);
                            link.opaque = false;
                            next.extend(
                                members.into_iter().map(|(device, id)| (device, id, first)),
                            );
                        }
                        None if first => self.because.push(link.clone()),
                        None => {}
                    },
                    Atom::Fact(_) if first => self.because.push(link.clone()),
                    Atom::Fact(_) => {}
                }
                links.push(link);
            }
            all.push(links);
        }
        self.causes[at].sets = all;
        self.unfollowed(at, nodes);
        for (device, id, first) in next {
            self.member(at, (device, id), above, first);
        }
    }

    /// A device in a set of a cause.
    fn member(
        &mut self,
        at: usize,
        (device, id): (Device, Id),
        above: &mut Vec<Device>,
        first: bool,
    ) {
        if above.contains(&device) {
            let name = self.explainer.words.named(device);
            let note = match (self.causes[at].on, self.now.trace.graph.value(id)) {
                (true, true) => phrase!("It and {name} hold each other.", name),
                _ => phrase!("{name} depends on it in turn.", name),
            };
            if !self.causes[at].notes.contains(&note) {
                self.causes[at].notes.push(note);
            }
        }
        let (_, reason) = self.reason(device);
        let ends = matches!(
            reason,
            Reason::Input | Reason::Special | Reason::Unwritten | Reason::Forced
        );
        if first && ends {
            let link = self.link(id);
            self.because.push(link);
        }
        self.device(device, above, first);
    }

    /// Change that the memory of an edge would have needed in the scan before, if that was like this one: in words, and
    /// the devices.
    fn before(
        &self,
        id: Id,
        memory: EdgeId,
        above: &[Device],
    ) -> Option<(Phrase, Vec<(Device, Id)>)> {
        let trace = &self.now.trace;
        let after = *trace.edges.get(&memory)?;
        if after == id || trace.graph.value(after) != trace.graph.value(id) {
            return None;
        }
        let view = View {
            graph: &trace.graph,
            own: *above.last()?,
            deep: false,
        };
        let sets = view.smallest(after).sets;
        let nodes = view.atoms(after);
        let set = sets.first().filter(|set| !set.is_empty())?;
        let mut texts = Vec::new();
        let mut members = Vec::new();
        for atom in set {
            let (_, id) = nodes.iter().find(|(other, _)| other == atom)?;
            texts.push(self.link(*id).needed);
            if let Atom::Contact(device, _) | Atom::Start(device) = *atom {
                members.push((device, *id));
            }
        }
        let needed = texts
            .into_iter()
            .reduce(|a, b| phrase!("{a} and {b}", a, b))?;
        Some((needed, members))
    }

    /// Says of a cause what in its condition cannot be followed.
    fn unfollowed(&mut self, at: usize, nodes: &[(Atom, Id)]) {
        let graph = &self.now.trace.graph;
        for (_, id) in nodes {
            if let Node::Fact(fact) = graph.node(*id)
                && fact.kind == FactKind::Written
            {
                let link = self.link(*id);
                let note = phrase!("{state}.", state = link.now);
                if !self.causes[at].notes.contains(&note) {
                    self.causes[at].notes.push(note);
                }
            }
        }
        if self.now.trace.jumped {
            let note = phrase!(
                "The program jumps backwards or leaves a routine early: what that passes over is not followed."
            );
            if self.causes.len() == 1 {
                self.causes[at].notes.push(note);
            }
        }
    }

    fn link(&self, id: Id) -> Link {
        let values = |instr: usize| self.values(instr);
        let words = &self.explainer.words;
        words.link(&self.now.trace.graph, id, &values)
    }

    /// Values of an instruction's operands: `D0 = 5`; of a timer or counter how far it is.
    fn values(&self, instr: usize) -> Phrase {
        let resolved = &self.explainer.words.resolved;
        let operands = resolved.program.instrs[instr].operands.iter();
        let wide = resolved.instrs[instr].form.wide;
        let mut texts = Vec::new();
        for operand in operands {
            let Some(device) = operand.kind.device() else {
                continue;
            };
            let Device { class, number } = device;
            let is_coil = resolved.instrs[instr].basic() == Some(Basic::Out);
            if let Some(progress) = self.progress(device).filter(|_| is_coil) {
                texts.push(progress.text());
                break;
            }
            let target = match class {
                DeviceClass::T | DeviceClass::C => Target::Current(class, number),
                _ if wide => Target::Pair(class, number),
                _ => Target::Word(class, number),
            };
            let target = match operand.kind {
                OperandKind::Nibbles(digits, ..) => Target::Nibbles(digits, class, number),
                _ => target,
            };
            let is_indexed = self.explainer.words.index(instr).is_some();
            if let Some(reading) = self.now.session.reading(target).filter(|_| !is_indexed) {
                texts.push(is(&operand.kind.to_string(), reading.to_string().into()));
            }
        }
        let texts = texts.into_iter();
        let all = texts.reduce(|before, next| phrase!("{before}, {next}", before, next));
        all.unwrap_or_else(|| phrase!("by other values"))
    }

    /// The instruction that decided on a device's state, and how.
    fn reason(&self, device: Device) -> (Option<usize>, Reason) {
        let trace = &self.now.trace;
        let forced = self.now.session.forced().iter();
        let is_forced = |(target, _): (Target, f64)| {
            let (class, first, count) = target.devices(0);
            class == device.class && (first..first + count).contains(&device.number)
        };
        if forced.into_iter().any(is_forced) {
            return (None, Reason::Forced);
        }
        if let Some(&instr) = trace.wrote.get(&device).and_then(|wrote| wrote.last()) {
            return (Some(instr), Reason::Written);
        }
        match &self.explainer.writes(device)[..] {
            _ if device.class == DeviceClass::X => (None, Reason::Input),
            _ if is_special(device.class, device.number) => (None, Reason::Special),
            [] => (None, Reason::Unwritten),
            [one] if trace.executed.contains(&one.instr) => (Some(one.instr), Reason::NotDriven),
            [one] => (Some(one.instr), Reason::NotExecuted),
            _ => (None, Reason::Kept),
        }
    }

    fn progress(&self, device: Device) -> Option<Progress> {
        let Device { class, number } = device;
        if !matches!(class, DeviceClass::T | DeviceClass::C) {
            return None;
        }
        let session = self.now.session;
        let value = whole(session, Target::Current(class, number))?;
        let resolved = &self.explainer.words.resolved;
        let mut coils = self.explainer.writes(device).into_iter();
        let coil = coils.find(|one| resolved.instrs[one.instr].basic() == Some(Basic::Out));
        let preset = coil.and_then(|coil| resolved.program.instrs[coil.instr].operands.get(1));
        let preset = preset.and_then(|operand| match operand.kind {
            OperandKind::Decimal(value, None) => Some(value),
            OperandKind::Hex(value, None) => i64::try_from(value).ok(),
            OperandKind::Device(Device { class, number }, None) => {
                whole(session, Target::Word(class, number))
            }
            _ => None,
        });
        let is_timer = class == DeviceClass::T;
        let kind = self.explainer.module().model.timer(number);
        let kind = kind.filter(|_| is_timer);
        Some(Progress {
            value,
            preset,
            unit_ms: kind.map(|kind| kind.unit_ms),
        })
    }

    /// The last change of a device, and what it depends on that changed with it.
    fn since(&self, device: Device, node: Option<Id>) -> Option<Since> {
        let history = self.now.history?;
        let (ms, scan) = history.changed(device)?;
        let graph = &self.now.trace.graph;
        let view = View {
            graph,
            own: device,
            deep: false,
        };
        let atoms = node.map(|node| view.atoms(node)).unwrap_or_default();
        let mut with = Vec::new();
        for (atom, _) in atoms {
            let (Atom::Contact(other, _) | Atom::Start(other)) = atom else {
                continue;
            };
            let changed = history.changed(other).map(|(_, scan)| scan);
            // What is written further below shows in the next scan.
            let is_late = other.class != DeviceClass::X && changed.is_some_and(|at| at + 1 == scan);
            if other != device && (changed == Some(scan) || is_late) {
                let on = state(self.now.session.machine(), other);
                let name = self.explainer.words.named(other);
                let text = match on {
                    true => phrase!("{name} came on", name),
                    false => phrase!("{name} went off", name),
                };
                if !with.contains(&text) {
                    with.push(text);
                }
            }
        }
        Some(Since { ms, scan, with })
    }
}

impl Progress {
    /// `1.2 s of 3 s`, `3 of 5`.
    pub fn text(&self) -> Phrase {
        let amount = |units: i64| match self.unit_ms {
            Some(unit) => format!("{} s", (units * i64::from(unit)) as f64 / 1000.0),
            None => units.to_string(),
        };
        match self.preset {
            Some(preset) if self.value < preset => {
                let (value, of, left) = (
                    amount(self.value),
                    amount(preset),
                    amount(preset - self.value),
                );
                phrase!("{value} of {of}, {left} to go", value, of, left)
            }
            Some(preset) => phrase!(
                "{value} of {of}",
                value = amount(self.value),
                of = amount(preset)
            ),
            None => amount(self.value).into(),
        }
    }
}

/// An integer.
pub(crate) fn whole(session: &Session, target: Target) -> Option<i64> {
    match session.reading(target)? {
        Reading::Integer(value, _) => Some(value),
        _ => None,
    }
}
