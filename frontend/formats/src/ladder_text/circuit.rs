//! Conversion of wires to a list: contacts in series and parallel, and the outputs that they feed.

use super::grid::{Drawn, Kind, Symbol};
use rungc_syntax::Span;
use rungc_syntax::codes::{self, Code};
use std::collections::{BTreeMap, BTreeSet};

/// A step on the way from a drawing to a list.
pub(super) enum Step {
    /// An instruction without operands that the wires mean: ANB, ORB, MPS, MRD, MPP; the place of what comes next.
    Plain(&'static str, Span),
    /// A contact: how it joins, and which symbol.
    Contact(&'static str, usize),
    /// Another symbol.
    Symbol(usize),
    /// A label, by its position.
    Label(usize),
}

/// An error: the place, the code, the message.
pub(super) type Fault = (Span, &'static Code, &'static str);

/// Maximum nesting of branches.
const DEEPEST: usize = 100;

/// The list of a drawing. A network with a mistake is left out.
pub(super) fn steps(drawn: &Drawn, faults: &mut Vec<Fault>) -> Vec<Step> {
    for &(span, why) in &drawn.odd {
        faults.push((span, &codes::LADDER_SYMBOL, why));
    }
    let mut steps = Vec::new();
    let mut labels = 0;
    for network in networks(drawn) {
        let first = network
            .iter()
            .map(|at| drawn.symbols[*at].row)
            .min()
            .unwrap_or(0);
        while labels < drawn.labels.len() && drawn.label_rows[labels] <= first {
            steps.push(Step::Label(labels));
            labels += 1;
        }
        let is_odd =
            |symbol: &Symbol| symbol.words.is_empty() && !matches!(symbol.kind, Kind::Result(_));
        if network.iter().any(|at| is_odd(&drawn.symbols[*at])) {
            continue;
        }
        let mut circuit = Circuit::of(drawn, &network);
        let mut list = Vec::new();
        match circuit.list(&mut list) {
            Ok(()) => steps.extend(list),
            Err(fault) => faults.push(fault),
        }
    }
    steps.extend((labels..drawn.labels.len()).map(Step::Label));
    steps
}

/// The symbols of each network, from top to bottom: those that wires connect, without the rails.
fn networks(drawn: &Drawn) -> Vec<Vec<usize>> {
    let mut parents: Vec<usize> = (0..drawn.symbols.len()).collect();
    fn root(parents: &mut [usize], mut at: usize) -> usize {
        while parents[at] != at {
            parents[at] = parents[parents[at]];
            at = parents[at];
        }
        at
    }
    let mut by_wire: BTreeMap<usize, usize> = BTreeMap::new();
    for (at, symbol) in drawn.symbols.iter().enumerate() {
        for wire in [symbol.left, symbol.right] {
            if wire == drawn.rail || Some(wire) == drawn.right {
                continue;
            }
            let other = *by_wire.entry(wire).or_insert(at);
            let (a, b) = (root(&mut parents, at), root(&mut parents, other));
            parents[a.max(b)] = a.min(b);
        }
    }
    let mut networks: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for at in 0..drawn.symbols.len() {
        networks.entry(root(&mut parents, at)).or_default().push(at);
    }
    networks.into_values().collect()
}

/// A part of a series.
#[derive(Clone, Debug)]
enum Part {
    Symbol(usize),
    Parallel(Vec<Vec<Part>>),
}

/// Contacts between two wires.
#[derive(Clone, Debug)]
struct Edge {
    from: usize,
    to: usize,
    series: Vec<Part>,
    /// The first symbol.
    first: usize,
}

/// A network in work.
struct Circuit<'a> {
    drawn: &'a Drawn,
    edges: Vec<Edge>,
    /// Outputs by the wire that feeds them.
    outputs: BTreeMap<usize, Vec<usize>>,
}

/// Destination of a wire.
enum Child {
    Output(usize),
    Branch(usize),
}

impl<'a> Circuit<'a> {
    fn of(drawn: &'a Drawn, network: &[usize]) -> Self {
        let mut circuit = Circuit {
            drawn,
            edges: Vec::new(),
            outputs: BTreeMap::new(),
        };
        for &at in network {
            let symbol = &drawn.symbols[at];
            match symbol.kind {
                Kind::Output | Kind::Coil => {
                    circuit.outputs.entry(symbol.left).or_default().push(at)
                }
                Kind::Open
                | Kind::Closed
                | Kind::Rising
                | Kind::Falling
                | Kind::Compare(_)
                | Kind::Result(_) => {
                    circuit.edges.push(Edge {
                        from: symbol.left,
                        to: symbol.right,
                        series: vec![Part::Symbol(at)],
                        first: at,
                    });
                }
            }
        }
        circuit
    }

    fn symbol(&self, at: usize) -> &'a Symbol {
        &self.drawn.symbols[at]
    }

    fn fault(&self, at: usize, why: &'static str) -> Fault {
        (self.symbol(at).span, &codes::LADDER_SHAPE, why)
    }

    /// The list of the network.
    fn list(&mut self, list: &mut Vec<Step>) -> Result<(), Fault> {
        self.check_ends()?;
        if let Some(edge) = self.edges.iter().find(|edge| edge.from == edge.to) {
            return Err(self.fault(edge.first, "a wire bridges this contact"));
        }
        self.reduce();
        let mut fed = BTreeSet::new();
        for edge in &self.edges {
            if !fed.insert(edge.to) || edge.to == self.drawn.rail {
                let why = "this network is more than contacts in series and parallel, which a list cannot express";
                return Err(self.fault(edge.first, why));
            }
        }
        let children = self.children(self.drawn.rail);
        for child in children {
            match child {
                Child::Output(at) => list.push(Step::Symbol(at)),
                Child::Branch(edge) => self.node(edge, "LD", 0, list)?,
            }
        }
        Ok(())
    }

    /// Every wire comes from the left rail and leads somewhere.
    fn check_ends(&self) -> Result<(), Fault> {
        let fed = self.edges.iter().map(|edge| edge.to);
        let feeds: BTreeSet<_> = fed.chain([self.drawn.rail]).collect();
        let taken = self.edges.iter().map(|edge| edge.from);
        let takes: BTreeSet<_> = taken.chain(self.outputs.keys().copied()).collect();
        let wire = |span, why| Err((span, &codes::LADDER_WIRE, why));
        for edge in &self.edges {
            if !feeds.contains(&edge.from) {
                return wire(
                    self.symbol(edge.first).span,
                    "nothing is connected to the left of this contact",
                );
            }
            if Some(edge.to) == self.drawn.right {
                return Err(self.fault(
                    edge.first,
                    "no output is between this contact and the right rail",
                ));
            }
            let end = self.drawn.ends.iter().find(|end| end.0 == edge.to);
            if let Some((_, span)) = end {
                return wire(*span, "this wire ends in nothing");
            }
            if !takes.contains(&edge.to) {
                return wire(
                    self.symbol(edge.first).span,
                    "nothing is connected to the right of this contact",
                );
            }
        }
        for (from, outputs) in &self.outputs {
            if !feeds.contains(from) {
                return wire(
                    self.symbol(outputs[0]).span,
                    "nothing is connected to the left of this",
                );
            }
        }
        Ok(())
    }

    /// Joins contacts in series and parallel until none is left to be joined.
    fn reduce(&mut self) {
        loop {
            let before = self.edges.len();
            self.join_parallel();
            self.join_series();
            if self.edges.len() == before {
                return;
            }
        }
    }

    fn join_parallel(&mut self) {
        let mut groups: BTreeMap<(usize, usize), Vec<Edge>> = BTreeMap::new();
        for edge in self.edges.drain(..) {
            groups.entry((edge.from, edge.to)).or_default().push(edge);
        }
        for ((from, to), mut group) in groups {
            if group.len() == 1 {
                self.edges.append(&mut group);
                continue;
            }
            let mut branches = Vec::with_capacity(group.len());
            for edge in group {
                match <[Part; 1]>::try_from(edge.series) {
                    Ok([Part::Parallel(inner)]) => branches.extend(inner),
                    Ok([part]) => branches.push(vec![part]),
                    Err(series) => branches.push(series),
                }
            }
            // Contacts are joined before those that had to be joined in series first.
            branches.sort_by_key(|branch| self.drawn.symbols[first(branch)].row);
            let first = first(&branches[0]);
            let series = vec![Part::Parallel(branches)];
            self.edges.push(Edge {
                from,
                to,
                series,
                first,
            });
        }
    }

    fn join_series(&mut self) {
        let mut degrees: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
        for edge in &self.edges {
            degrees.entry(edge.from).or_default().1 += 1;
            degrees.entry(edge.to).or_default().0 += 1;
        }
        let passes = |wire: usize| {
            degrees.get(&wire) == Some(&(1, 1))
                && !self.outputs.contains_key(&wire)
                && wire != self.drawn.rail
        };
        let mut next: BTreeMap<usize, Edge> = BTreeMap::new();
        let mut starts = Vec::new();
        for edge in self.edges.drain(..) {
            match passes(edge.from) {
                true => _ = next.insert(edge.from, edge),
                false => starts.push(edge),
            }
        }
        for start in &mut starts {
            while let Some(edge) = next.remove(&start.to) {
                start.series.extend(edge.series);
                start.to = edge.to;
            }
        }
        // Contacts in a ring, which nothing feeds.
        starts.extend(next.into_values());
        self.edges = starts;
    }

    /// Destinations of a wire, from top to bottom.
    fn children(&self, wire: usize) -> Vec<Child> {
        let outputs = self
            .outputs
            .get(&wire)
            .into_iter()
            .flatten()
            .map(|at| (*at, Child::Output(*at)));
        let edges = self
            .edges
            .iter()
            .enumerate()
            .filter(|(_, edge)| edge.from == wire);
        let branches = edges.map(|(i, edge)| (edge.first, Child::Branch(i)));
        let mut children: Vec<(usize, Child)> = outputs.chain(branches).collect();
        children.sort_by_key(|(at, _)| (self.symbol(*at).row, self.symbol(*at).column));
        children.into_iter().map(|(_, child)| child).collect()
    }

    /// Contacts and what they feed.
    fn node(
        &self,
        edge: usize,
        entry: &'static str,
        depth: usize,
        list: &mut Vec<Step>,
    ) -> Result<(), Fault> {
        let edge = &self.edges[edge];
        if depth == DEEPEST {
            return Err(self.fault(edge.first, "branches are nested more than 100 deep"));
        }
        self.series(&edge.series, entry, depth, list)?;
        let mut children = self.children(edge.to).into_iter().peekable();
        while let Some(Child::Output(at)) =
            children.next_if(|child| matches!(child, Child::Output(_)))
        {
            list.push(Step::Symbol(at));
        }
        // Each branch, and outputs that follow each other, is after a separate MPS, MRD or MPP.
        let mut groups: Vec<Vec<Child>> = Vec::new();
        for child in children {
            match (&child, groups.last_mut()) {
                (Child::Output(_), Some(group)) if matches!(group[0], Child::Output(_)) => {
                    group.push(child)
                }
                _ => groups.push(vec![child]),
            }
        }
        let count = groups.len();
        for (i, group) in groups.into_iter().enumerate() {
            let at = match group[0] {
                Child::Output(at) => at,
                Child::Branch(edge) => self.edges[edge].first,
            };
            let span = self.symbol(at).span;
            match i {
                _ if count == 1 => {}
                0 => list.push(Step::Plain("MPS", span)),
                _ if i + 1 == count => list.push(Step::Plain("MPP", span)),
                _ => list.push(Step::Plain("MRD", span)),
            }
            for child in group {
                match child {
                    Child::Output(at) => list.push(Step::Symbol(at)),
                    Child::Branch(edge) => self.node(edge, "AND", depth + 1, list)?,
                }
            }
        }
        Ok(())
    }

    fn series(
        &self,
        series: &[Part],
        mut entry: &'static str,
        depth: usize,
        list: &mut Vec<Step>,
    ) -> Result<(), Fault> {
        for part in series {
            match part {
                Part::Symbol(at) if matches!(self.symbol(*at).kind, Kind::Result(_)) => {
                    if entry != "AND" {
                        return Err(self.fault(*at, "no contact is before this"));
                    }
                    list.push(Step::Symbol(*at));
                }
                Part::Symbol(at) => list.push(Step::Contact(entry, *at)),
                Part::Parallel(branches) => {
                    let mut last = Span::default();
                    for (i, branch) in branches.iter().enumerate() {
                        last = self.symbol(first(branch)).span;
                        if depth == DEEPEST {
                            return Err(
                                self.fault(first(branch), "branches are nested more than 100 deep")
                            );
                        }
                        let or = i > 0 && matches!(branch[..], [Part::Symbol(_)]);
                        self.series(branch, if or { "OR" } else { "LD" }, depth + 1, list)?;
                        if i > 0 && !or {
                            list.push(Step::Plain("ORB", last));
                        }
                    }
                    if entry == "AND" {
                        list.push(Step::Plain("ANB", last));
                    }
                }
            }
            entry = "AND";
        }
        Ok(())
    }
}

/// The first symbol of a series.
fn first(series: &[Part]) -> usize {
    match &series[0] {
        Part::Symbol(at) => *at,
        Part::Parallel(branches) => first(&branches[0]),
    }
}
