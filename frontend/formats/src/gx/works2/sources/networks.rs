//! Networks of structured ladder and function block diagrams as statements.
//!
//! Power and data flow from ports that give to ports that take, along wires. A coil, an output label, a function and a
//! block are a statement each; contacts become the condition of the statements after them. `_1`, `_2` … stand for
//! results that have no label.

use super::{Class, Network, Node, NodeKind, PortRole, Pou, PouKind, Sources};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// More records than any network that is drawn has.
const MAX_RECORDS: usize = 2000;
/// More nodes in a row than any network that is drawn has.
const DEEPEST: usize = 200;

/// The statements of a network, a line each.
pub(super) fn statements(network: &Network, sources: &Sources) -> Vec<String> {
    if network.nodes.len() + network.wires.len() > MAX_RECORDS {
        return vec!["(* too large to be followed *)".to_owned()];
    }
    let mut flow = Flow::new(network, sources);
    let mut order: Vec<usize> = (0..network.nodes.len()).collect();
    order.sort_by_key(|&node| (network.nodes[node].top, network.nodes[node].left));
    for node in order {
        flow.statement(node, 0);
    }
    flow.lines
}

/// A condition as text. How tightly its outermost operator binds says where it needs parentheses.
#[derive(Clone, PartialEq, Eq)]
struct Term {
    text: String,
    binding: Binding,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Or,
    And,
    Operand,
}

impl Term {
    fn operand(text: impl Into<String>) -> Self {
        Term {
            text: text.into(),
            binding: Binding::Operand,
        }
    }

    /// Terms joined by an operator.
    fn joined(terms: Vec<Term>, binding: Binding) -> Self {
        if let [one] = &terms[..] {
            return one.clone();
        }
        let operator = match binding {
            Binding::Or => " OR ",
            _ => " AND ",
        };
        let inside = |term: &Term| match term.binding < binding {
            true => format!("({})", term.text),
            false => term.text.clone(),
        };
        let terms: Vec<_> = terms.iter().map(inside).collect();
        Term {
            text: terms.join(operator),
            binding,
        }
    }
}

/// Power, which needs no condition.
const POWER: &str = "TRUE";

struct Flow<'n> {
    network: &'n Network,
    sources: &'n Sources,
    /// For each port of each node, its net.
    nets: Vec<Vec<usize>>,
    /// The net of the power rail.
    rail: Option<usize>,
    /// For each net, the ports that give to it: node and port.
    givers: BTreeMap<usize, Vec<(usize, usize)>>,
    /// For each net, the number of ports that take from it.
    takers: BTreeMap<usize, usize>,
    /// Names of nets that have been given one.
    names: BTreeMap<usize, String>,
    /// Conditions of nets that are known; `None` while one is followed.
    terms: BTreeMap<usize, Option<Term>>,
    /// Nodes whose statement has been begun.
    begun: Vec<bool>,
    lines: Vec<String>,
}

impl<'n> Flow<'n> {
    fn new(network: &'n Network, sources: &'n Sources) -> Self {
        let (nets, rail) = nets(network);
        let mut givers: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        let mut takers = BTreeMap::new();
        for (node, of) in network.nodes.iter().enumerate() {
            for (port, net) in nets[node].iter().enumerate() {
                match of.ports[port].role {
                    PortRole::Out => givers.entry(*net).or_default().push((node, port)),
                    PortRole::In => *takers.entry(*net).or_insert(0) += 1,
                }
            }
        }
        Flow {
            network,
            sources,
            nets,
            rail,
            givers,
            takers,
            names: BTreeMap::new(),
            terms: BTreeMap::new(),
            begun: vec![false; network.nodes.len()],
            lines: Vec::new(),
        }
    }

    /// The nets of a node's ports with a role, from top to bottom.
    fn nets_of(&self, node: usize, role: PortRole) -> Vec<usize> {
        let ports = self.network.nodes[node].ports.iter();
        let ports = ports.zip(&self.nets[node]);
        let mut ports: Vec<_> = ports.filter(|(port, _)| port.role == role).collect();
        ports.sort_by_key(|(port, _)| port.y);
        ports.into_iter().map(|(_, net)| *net).collect()
    }

    /// Writes the statement of a node, unless that has been done.
    fn statement(&mut self, node: usize, depth: usize) {
        if std::mem::replace(&mut self.begun[node], true) {
            return;
        }
        let of = &self.network.nodes[node];
        match of.kind {
            NodeKind::Coil => {
                let condition = self.condition(node, depth);
                self.lines.push(format!("{} := {condition};", of.symbol));
            }
            NodeKind::Output => self.output(node, depth),
            NodeKind::Function | NodeKind::Block => self.call(node, depth),
            NodeKind::Comment => self.lines.push(comment(&of.symbol)),
            NodeKind::Other(kind) => {
                let what = format!(
                    "`{}` is a node of kind {kind}, which is not decoded",
                    of.symbol
                );
                self.lines.push(comment(&what));
            }
            NodeKind::Open | NodeKind::Closed | NodeKind::Rising | NodeKind::Input => {}
        }
    }

    /// Writes an output label, unless the call that gives its value does.
    fn output(&mut self, node: usize, depth: usize) {
        let nets = self.nets_of(node, PortRole::In);
        let net = nets.first().copied();
        let givers = net.and_then(|net| self.givers.get(&net)).cloned();
        let is_call = |&(node, _): &(usize, usize)| {
            let kind = self.network.nodes[node].kind;
            matches!(kind, NodeKind::Function | NodeKind::Block)
        };
        if let Some([giver]) = givers.as_deref()
            && is_call(giver)
        {
            return self.statement(giver.0, depth);
        }
        let condition = self.condition(node, depth);
        let symbol = &self.network.nodes[node].symbol;
        self.lines.push(format!("{symbol} := {condition};"));
    }

    /// The condition at the left side of a node.
    fn condition(&mut self, node: usize, depth: usize) -> String {
        let inputs = self.nets_of(node, PortRole::In);
        inputs
            .first()
            .map_or_else(|| POWER.to_owned(), |net| self.term(*net, depth).text)
    }

    /// The labels that a net is written to.
    fn outputs(&self, net: usize) -> Vec<&'n str> {
        let nodes = self.network.nodes.iter().enumerate();
        let outputs = nodes.filter(|(node, of)| {
            of.kind == NodeKind::Output && self.nets[*node].first() == Some(&net)
        });
        outputs.map(|(_, of)| of.symbol.as_str()).collect()
    }

    /// The name that the result of a call has: its label, or a number; `None` if nothing takes it.
    fn result(&mut self, net: usize) -> Option<String> {
        self.takers.get(&net)?;
        if let Some(name) = self.names.get(&net) {
            return Some(name.clone());
        }
        let name = match self.outputs(net).first() {
            Some(label) => (*label).to_owned(),
            None => format!("_{}", self.names.len() + 1),
        };
        self.names.insert(net, name.clone());
        Some(name)
    }

    /// Writes the call of a function or block, with what it needs before it.
    fn call(&mut self, node: usize, depth: usize) {
        let of = &self.network.nodes[node];
        let inputs = self.nets_of(node, PortRole::In);
        let inputs: Vec<String> = inputs
            .into_iter()
            .map(|net| self.term(net, depth + 1).text)
            .collect();
        let outputs = self.nets_of(node, PortRole::Out);
        let results: Vec<_> = outputs.iter().map(|net| self.result(*net)).collect();
        let line = match of.kind {
            NodeKind::Block => block_call(of, &inputs, &results, self.sources),
            _ => function_call(of, &inputs, &results),
        };
        self.lines.push(line);
        for net in outputs {
            let labels = self.outputs(net);
            for label in labels.iter().skip(1) {
                self.lines.push(format!("{label} := {};", labels[0]));
            }
        }
    }

    /// What a net carries.
    fn term(&mut self, net: usize, depth: usize) -> Term {
        if self.rail == Some(net) {
            return Term::operand(POWER);
        }
        match self.terms.get(&net) {
            Some(Some(term)) => return term.clone(),
            // Power does not flow backwards.
            Some(None) => return Term::operand("FALSE"),
            None if depth > DEEPEST => return Term::operand("(* too deep *)"),
            None => {}
        }
        self.terms.insert(net, None);
        let givers = self.givers.get(&net).cloned().unwrap_or_default();
        let mut terms: Vec<Term> = Vec::new();
        for (node, port) in givers {
            let term = self.given(node, port, depth + 1);
            if !terms.contains(&term) {
                terms.push(term);
            }
        }
        let mut term = match terms.is_empty() {
            true => Term::operand("(* open *)"),
            false => Term::joined(terms, Binding::Or),
        };
        let is_shared = self.takers.get(&net).is_some_and(|&takers| takers > 1);
        if is_shared && term.binding != Binding::Operand {
            let name = format!("_{}", self.names.len() + 1);
            self.lines.push(format!("{name} := {};", term.text));
            self.names.insert(net, name.clone());
            term = Term::operand(name);
        }
        self.terms.insert(net, Some(term.clone()));
        term
    }

    /// What a port gives.
    fn given(&mut self, node: usize, port: usize, depth: usize) -> Term {
        let of = &self.network.nodes[node];
        let contact = match of.kind {
            NodeKind::Input => return Term::operand(&of.symbol),
            NodeKind::Function | NodeKind::Block => {
                self.statement(node, depth);
                let result = self.result(self.nets[node][port]);
                return Term::operand(result.unwrap_or_default());
            }
            NodeKind::Open => Some(of.symbol.clone()),
            NodeKind::Closed => Some(format!("NOT {}", of.symbol)),
            NodeKind::Rising => Some(format!("RISING({})", of.symbol)),
            NodeKind::Coil | NodeKind::Output | NodeKind::Comment | NodeKind::Other(_) => None,
        };
        let inputs = self.nets_of(node, PortRole::In);
        let before = inputs.first().map(|net| self.term(*net, depth));
        let before = before.filter(|term| term.text != POWER || contact.is_none());
        let terms: Vec<_> = before
            .into_iter()
            .chain(contact.map(Term::operand))
            .collect();
        match terms.is_empty() {
            true => Term::operand(POWER),
            false => Term::joined(terms, Binding::And),
        }
    }
}

/// A comment. What would end it early is taken apart.
pub(super) fn comment(text: &str) -> String {
    format!("(* {} *)", text.replace("*)", "* )").replace("(*", "( *"))
}

fn function_call(node: &Node, inputs: &[String], results: &[Option<String>]) -> String {
    // The number of inputs is part of the name.
    let name = node
        .symbol
        .split_once('-')
        .map_or(&*node.symbol, |(name, _)| name);
    let inputs = inputs.join(", ");
    let taken = results.iter().any(Option::is_some);
    match results {
        [Some(result)] => format!("{result} := {name}({inputs});"),
        _ if !taken => format!("{name}({inputs});"),
        _ => {
            let results = results
                .iter()
                .map(|result| result.as_deref().unwrap_or("_"));
            let results: Vec<_> = results.collect();
            format!("{name}({inputs} => {});", results.join(", "))
        }
    }
}

/// The call of an instance. Its pins have names if the project has the block.
fn block_call(
    node: &Node,
    inputs: &[String],
    results: &[Option<String>],
    sources: &Sources,
) -> String {
    let block = sources.pou(&node.block);
    let named = |classes: &[Class], enable: &'static str, count: usize| {
        let pins = block.map(|block| pins(block, classes, enable));
        pins.filter(|pins| pins.len() == count)
    };
    let into = named(&[Class::Input, Class::InOut], "EN", inputs.len());
    let out = named(&[Class::Output], "ENO", results.len());
    let mut pins: Vec<String> = Vec::new();
    for (at, input) in inputs.iter().enumerate() {
        pins.push(match &into {
            Some(names) => format!("{} := {input}", names[at]),
            None => input.clone(),
        });
    }
    for (at, result) in results.iter().enumerate() {
        match (&out, result) {
            (Some(names), Some(result)) => pins.push(format!("{} => {result}", names[at])),
            (None, Some(result)) => pins.push(format!("=> {result}")),
            (_, None) => {}
        }
    }
    let mut line = format!("{}({});", node.symbol, pins.join(", "));
    let _ = write!(line, " {}", comment(&node.block));
    line
}

/// Names of a block's pins on one side.
fn pins<'p>(block: &'p Pou, classes: &[Class], enable: &'static str) -> Vec<&'p str> {
    let has_enable = matches!(
        block.kind,
        PouKind::Block {
            has_enable: true,
            ..
        }
    );
    let first = has_enable.then_some(enable);
    let labels = classes.iter().flat_map(|class| block.labels_of(*class));
    let names = labels.map(|label| label.name.as_str());
    first.into_iter().chain(names).collect()
}

type Point = (i64, i64);

/// Returns true if a point lies on a wire.
fn touches((from, to): (Point, Point), (x, y): Point) -> bool {
    let between = |a: i64, b: i64, at: i64| a.min(b) <= at && at <= a.max(b);
    between(from.0, to.0, x) && between(from.1, to.1, y)
}

/// The nets of all ports, and that of the power rail: the vertical wire that begins at the upper edge.
fn nets(network: &Network) -> (Vec<Vec<usize>>, Option<usize>) {
    let wires: Vec<_> = network
        .wires
        .iter()
        .map(|wire| (wire.from, wire.to))
        .collect();
    // The first wire of each net, a forest.
    let mut parents: Vec<usize> = (0..wires.len()).collect();
    let points = network.nodes.iter().flat_map(|node| &node.ports);
    let mut joints: BTreeMap<Point, Option<usize>> = BTreeMap::new();
    let ends = wires.iter().flat_map(|wire| [wire.0, wire.1]);
    for point in points.map(|port| (port.x, port.y)).chain(ends) {
        joints.entry(point).or_insert(None);
    }
    for (&point, joint) in &mut joints {
        let mut touching = (0..wires.len()).filter(|&at| touches(wires[at], point));
        let Some(first) = touching.next() else {
            continue;
        };
        for other in touching {
            let (a, b) = (root(&mut parents, first), root(&mut parents, other));
            parents[b] = a;
        }
        *joint = Some(first);
    }
    // Ports that touch no wire form a net with those at the same point.
    let alone: Vec<Point> = joints
        .iter()
        .filter(|(_, net)| net.is_none())
        .map(|(p, _)| *p)
        .collect();
    let mut net = |point: Point| match joints[&point] {
        Some(wire) => root(&mut parents, wire),
        None => wires.len() + alone.binary_search(&point).unwrap_or_default(),
    };
    let ports = |node: &Node| {
        node.ports
            .iter()
            .map(|port| (port.x, port.y))
            .collect::<Vec<_>>()
    };
    let of_ports = network.nodes.iter().map(ports);
    let nets = of_ports
        .map(|points| points.into_iter().map(&mut net).collect())
        .collect();
    let is_rail = |(from, to): &&(Point, Point)| from.0 == to.0 && from.1.min(to.1) == 0;
    let rail = wires.iter().find(is_rail).map(|(from, _)| net(*from));
    (nets, rail)
}

fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}
