//! A step ladder as a sequential function chart: its states are steps, what leads from state to state is a transition
//! with its condition as an expression, and what a state drives is an action.

use super::lines::Lines;
use super::words::{Gate, Words};
use super::xml::{Xml, position, relative};
use super::{Refused, xml};
use rungc_catalogue::{Basic, Lower};
use rungc_ladder::list::Entry;
use rungc_ladder::sfc::{Chart, Transition};
use rungc_ladder::{InstrIndex, Item, Ladder, Network, NetworkBody, Node, Output, Part, Series};
use rungc_rt::RtFn;
use rungc_syntax::{Device, DeviceClass};
use std::collections::{BTreeMap, BTreeSet};

/// Distance of columns and of rows.
const GRID: (i64, i64) = (250, 160);
/// Size of a step.
const STEP: (i64, i64) = (60, 30);

/// Contact by which the first scan begins a flow.
const FIRST_SCAN: &str = "M8002";

/// Instructions that change the order of execution, which actions cannot.
const FLOW: [Basic; 10] = [
    Basic::Call,
    Basic::Cj,
    Basic::For,
    Basic::Next,
    Basic::Mc,
    Basic::Mcr,
    Basic::Sret,
    Basic::Iret,
    Basic::Ei,
    Basic::Di,
];

/// The parts of a program around its step ladder, and the chart of that.
pub(super) struct Parts {
    /// Networks before the first state.
    pub before: Ladder,
    /// The chart.
    pub chart: Xml,
    /// Number of variables that store a result in its actions.
    pub kept: usize,
    /// Networks after the last state.
    pub after: Ladder,
}

/// Divides a program; what a chart cannot say is an error that names the state.
pub(super) fn parts(words: &mut Words, ladder: &Ladder) -> Result<Parts, Refused> {
    let Some(chart) = Chart::of(words.resolved(), ladder) else {
        return Err(Refused::state(0, "the program has no states (STL)"));
    };
    let sections = Sections::of(words, ladder, &chart)?;
    let steps = chart.states.iter().map(|state| state.device);
    words.steps = steps.collect();
    let mut writer = Writer {
        xml: Xml::default(),
        chart: &chart,
        ids: 0,
        initial: sections.initial,
        kept: 0,
        words,
    };
    writer.write(ladder, &sections.actions);
    let (chart, kept) = (writer.xml, writer.kept);
    Ok(Parts {
        before: sections.before,
        chart,
        kept,
        after: sections.after,
    })
}

/// Networks of a program by their place in its chart.
struct Sections {
    before: Ladder,
    after: Ladder,
    /// Positions of the states that the first scan begins.
    initial: BTreeSet<usize>,
    /// By the first state of a section: all its states, and what they drive.
    actions: BTreeMap<usize, Vec<(Vec<usize>, Node)>>,
}

impl Sections {
    fn of(words: &Words, ladder: &Ladder, chart: &Chart) -> Result<Self, Refused> {
        let mut sections = Sections {
            before: Ladder::default(),
            after: Ladder::default(),
            initial: BTreeSet::new(),
            actions: BTreeMap::new(),
        };
        if let Some(other) = chart.others.first() {
            let what = format!("{} switches states from outside of them", other.text);
            return Err(Refused::state(other.instr, what));
        }
        let mut switches = BTreeSet::new();
        for transition in &chart.transitions {
            switches.extend(transition.instrs.iter().copied());
            if transition.from.is_empty() {
                sections.begin(chart, transition)?;
            }
        }
        let position = |device: Device| chart.states.iter().position(|s| s.device == device);
        let mut current: Vec<usize> = Vec::new();
        let (mut in_row, mut seen) = (false, false);
        for network in &ladder.networks {
            let instrs = network.instrs.clone();
            let last = words.basic(instrs.end - 1).filter(|_| instrs.len() == 1);
            if last == Some(Basic::Stl) {
                let operand = words.instr(instrs.start).operands.first();
                let state = operand.and_then(|operand| operand.kind.device());
                if !in_row {
                    current.clear();
                }
                current.extend(state.and_then(position));
                (in_row, seen) = (true, true);
                continue;
            }
            in_row = false;
            if matches!(last, Some(Basic::Ret | Basic::Fend | Basic::End)) {
                current.clear();
                if last == Some(Basic::Ret) {
                    continue;
                }
            }
            match current.first() {
                Some(state) => {
                    check_section(words, chart, &current, network)?;
                    if let NetworkBody::Rung(node) = &network.body
                        && let Some(node) = without(node, &switches)
                    {
                        let actions = sections.actions.entry(*state).or_default();
                        actions.push((current.clone(), node));
                    }
                }
                None => {
                    check_outside(words, chart, network)?;
                    let mut network = network.clone();
                    if let NetworkBody::Rung(node) = &network.body {
                        let Some(node) = without(node, &switches) else {
                            continue;
                        };
                        network.body = NetworkBody::Rung(node);
                    }
                    let part = if seen {
                        &mut sections.after
                    } else {
                        &mut sections.before
                    };
                    part.networks.push(network);
                }
            }
        }
        Ok(sections)
    }

    /// Takes states that are not entered from other states: the first scan may begin them.
    fn begin(&mut self, chart: &Chart, transition: &Transition) -> Result<(), Refused> {
        if transition.condition == FIRST_SCAN {
            self.initial.extend(&transition.to);
            return Ok(());
        }
        let names = transition.to.iter().map(|at| chart.states[*at].device);
        let names: Vec<_> = names.map(|device| device.to_string()).collect();
        let what = format!(
            "{} begins outside of the states, by {}; in a chart, only the first scan ({FIRST_SCAN}) begins a step",
            names.join(", "),
            transition.condition
        );
        Err(Refused::state(transition.instrs[0], what))
    }
}

/// Node without some of its instructions; `None` if nothing is left.
fn without(node: &Node, left_out: &BTreeSet<InstrIndex>) -> Option<Node> {
    let items = node.items.iter().filter_map(|item| match item {
        Item::Output(output) => (!left_out.contains(&output.instr)).then_some(item.clone()),
        Item::Continue(next) => without(next, left_out).map(Item::Continue),
        Item::Stack(branches) => {
            let branches = branches.iter().filter_map(|node| without(node, left_out));
            let branches: Vec<_> = branches.collect();
            (!branches.is_empty()).then_some(Item::Stack(branches))
        }
    });
    let items: Vec<_> = items.collect();
    (!items.is_empty()).then(|| Node {
        series: node.series.clone(),
        items,
    })
}

/// Rejects networks of a section that an action cannot hold.
fn check_section(
    words: &Words,
    chart: &Chart,
    states: &[usize],
    network: &Network,
) -> Result<(), Refused> {
    let state = chart.states[states[0]].device;
    let first = network.instrs.start;
    if let NetworkBody::List { why } = &network.body {
        return Err(Refused::network(first, why));
    }
    for at in network.instrs.clone() {
        let instr = words.instr(at);
        let does = words.lower(at);
        let resets = matches!(
            does,
            Some(Lower::Basic(Basic::Rst) | Lower::Call(RtFn::Zrst))
        ) && instr.operands.iter().any(|operand| {
            let device = operand.kind.device();
            device.is_some_and(|device| device.class == DeviceClass::S)
        });
        let flows = words.basic(at).is_some_and(|basic| FLOW.contains(&basic));
        if resets || flows || at < first + network.labels {
            let name = &instr.mnemonic;
            let what = format!("{state} contains {name}, which an action of a step cannot do");
            return Err(Refused::state(at, what));
        }
    }
    Ok(())
}

/// Rejects networks outside of the sections that read states.
fn check_outside(words: &Words, chart: &Chart, network: &Network) -> Result<(), Refused> {
    for at in network.instrs.clone() {
        let is_contact = !matches!(words.basic(at), Some(Basic::Set | Basic::Out));
        let operands = words.instr(at).operands.iter();
        let devices = operands.filter_map(|operand| operand.kind.device());
        let mut states = devices.filter(|device| chart.states.iter().any(|s| s.device == *device));
        if let (Some(state), true) = (states.next(), is_contact) {
            let what = format!("{state} is read outside of the states");
            return Err(Refused::state(at, what));
        }
    }
    Ok(())
}

/// Outputs, each with the contacts between the left rail and it.
fn outputs<'n>(node: &'n Node, before: &[&'n Series]) -> Vec<(Output, Vec<&'n Series>)> {
    let mut way = before.to_vec();
    way.push(&node.series);
    let all = node.items.iter().flat_map(|item| match item {
        Item::Output(output) => vec![(*output, way.clone())],
        Item::Continue(next) => outputs(next, &way),
        Item::Stack(branches) => branches.iter().flat_map(|b| outputs(b, &way)).collect(),
    });
    all.collect()
}

/// Returns true if INV, MEP or MEF changes the result of a node or of a branch.
fn is_changed(node: &Node) -> bool {
    let here = node
        .series
        .iter()
        .any(|part| matches!(part, Part::Result(_)));
    here || node.items.iter().any(|item| match item {
        Item::Output(_) => false,
        Item::Continue(next) => is_changed(next),
        Item::Stack(branches) => branches.iter().any(is_changed),
    })
}

/// Contacts as a list.
fn condition(lines: &mut Lines, way: &[&Series]) {
    let mut entry = Entry::Ld;
    for series in way.iter().filter(|series| !series.is_empty()) {
        lines.series(series, entry);
        entry = Entry::And;
    }
}

/// Contacts as an expression of structured text; nothing if some have no counterpart in the standard.
fn expression(words: &mut Words, series: &[Part]) -> Option<String> {
    let mut factors: Vec<String> = Vec::new();
    for part in series {
        let factor = match part {
            Part::Contact(contact) => match words.contact(*contact) {
                Gate::Contact {
                    variable,
                    negated,
                    edge: "none",
                } => format!("{}{variable}", if negated { "NOT " } else { "" }),
                Gate::Compare {
                    function,
                    words: [a, b],
                } => {
                    let sign = SIGNS.iter().find(|(name, _)| *name == function)?.1;
                    format!("({a} {sign} {b})")
                }
                Gate::Contact { .. } | Gate::Special { .. } => return None,
            },
            Part::Group(parts) => expression(words, parts)?,
            Part::Parallel(branches) => {
                let ways = branches.iter().map(|b| expression(words, &b.series));
                format!("({})", ways.collect::<Option<Vec<_>>>()?.join(" OR "))
            }
            Part::Result(at) if words.basic(*at) == Some(Basic::Inv) => {
                format!("NOT ({})", std::mem::take(&mut factors).join(" AND "))
            }
            Part::Result(_) => return None,
        };
        factors.push(factor);
    }
    Some(factors.join(" AND "))
}

/// The standard's functions that compare, and their signs.
const SIGNS: [(&str, &str); 6] = [
    ("EQ", "="),
    ("NE", "<>"),
    ("GT", ">"),
    ("GE", ">="),
    ("LT", "<"),
    ("LE", "<="),
];

/// Writes the elements of a chart.
struct Writer<'w, 'a> {
    xml: Xml,
    chart: &'w Chart,
    ids: usize,
    initial: BTreeSet<usize>,
    kept: usize,
    words: &'w mut Words<'a>,
}

impl Writer<'_, '_> {
    fn id(&mut self) -> usize {
        self.ids += 1;
        self.ids
    }

    fn write(&mut self, ladder: &Ladder, actions: &BTreeMap<usize, Vec<(Vec<usize>, Node)>>) {
        let chart = self.chart;
        let steps: Vec<_> = chart.states.iter().map(|_| self.id()).collect();
        let leaving: Vec<_> = chart
            .transitions
            .iter()
            .filter(|t| !t.from.is_empty())
            .collect();
        let transitions: Vec<_> = leaving.iter().map(|_| self.id()).collect();
        // Sources of a transition: its step, the choice after it, or the end of parallel branches.
        let mut choices = BTreeMap::new();
        for (state, step) in steps.iter().enumerate() {
            let ways = leaving.iter().filter(|t| t.from.contains(&state)).count();
            let from = match ways {
                0 | 1 => *step,
                _ => {
                    let place = self.place(state, 1);
                    self.element("selectionDivergence", place, &[vec![*step]], &[])
                }
            };
            choices.insert(state, from);
        }
        let mut arrivals: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for ((nth, transition), id) in (1..).zip(&leaving).zip(&transitions) {
            let sources: Vec<_> = transition.from.iter().map(|state| choices[state]).collect();
            let place = self.place(transition.from[0], 2);
            let from = match &sources[..] {
                [one] => *one,
                many => {
                    let many: Vec<_> = many.iter().map(|id| vec![*id]).collect();
                    self.element("simultaneousConvergence", place, &many, &[])
                }
            };
            self.transition(*id, nth, from, place, transition, ladder);
            let from = match transition.to.len() {
                1 => *id,
                _ => self.element(
                    "simultaneousDivergence",
                    self.place(transition.from[0], 3),
                    &[vec![*id]],
                    &[],
                ),
            };
            for to in &transition.to {
                // A transition back is a jump.
                if transition.from.iter().all(|state| state < to) {
                    arrivals.entry(*to).or_default().push(from);
                } else {
                    let name = chart.states[*to].device.to_string();
                    let place = self.place(transition.from[0], 3);
                    self.element("jumpStep", place, &[vec![from]], &[("targetName", &name)]);
                }
            }
        }
        for (state, step) in steps.iter().enumerate() {
            let from = arrivals.remove(&state).unwrap_or_default();
            let from = match &from[..] {
                [] | [_] => from,
                many => {
                    let many: Vec<_> = many.iter().map(|id| vec![*id]).collect();
                    let place = self.place(state, -1);
                    vec![self.element("selectionConvergence", place, &many, &[])]
                }
            };
            self.step(*step, state, &from);
            if let Some(actions) = actions.get(&state) {
                self.actions(*step, state, actions);
            }
        }
    }

    /// Position of an element: rows after its state, in quarters of the distance to the next.
    fn place(&self, state: usize, quarter: i64) -> (i64, i64) {
        let row = i64::try_from(state).unwrap_or(i64::MAX / GRID.1) + 1;
        (GRID.0, row * GRID.1 + quarter * GRID.1 / 4)
    }

    /// An element with inputs, each of which some others lead to, and with one output; its number.
    fn element(
        &mut self,
        kind: &'static str,
        (x, y): (i64, i64),
        inputs: &[Vec<usize>],
        attributes: xml::Attributes,
    ) -> usize {
        let id = self.id();
        let text = id.to_string();
        let size = [("localId", text.as_str()), ("height", "1"), ("width", "60")];
        self.xml.node(kind, &[&size, attributes].concat(), |xml| {
            position(xml, x, y);
            inputs.iter().for_each(|from| input(xml, from));
            match kind {
                "jumpStep" => {}
                "selectionDivergence" | "simultaneousDivergence" => {
                    output(xml, "connectionPointOut", true)
                }
                _ => output(xml, "connectionPointOut", false),
            }
        });
        id
    }

    fn step(&mut self, id: usize, state: usize, from: &[usize]) {
        let (x, y) = self.place(state, 0);
        let of_chart = &self.chart.states[state];
        let (id, name) = (id.to_string(), of_chart.device.to_string());
        let is_initial = self.initial.contains(&state).to_string();
        let (width, height) = (STEP.0.to_string(), STEP.1.to_string());
        let attributes = [
            ("localId", id.as_str()),
            ("height", &height),
            ("width", &width),
            ("name", &name),
            ("initialStep", &is_initial),
        ];
        self.xml.node("step", &attributes, |xml| {
            position(xml, x, y);
            if !from.is_empty() {
                input(xml, from);
            }
            output(xml, "connectionPointOut", true);
            output(xml, "connectionPointOutAction", true);
            if let Some(name) = &of_chart.name {
                xml.prose("documentation", name);
            }
        });
    }

    fn transition(
        &mut self,
        id: usize,
        priority: usize,
        from: usize,
        (x, y): (i64, i64),
        transition: &Transition,
        ladder: &Ladder,
    ) {
        let network = &ladder.networks[transition.network - 1];
        let ways = match &network.body {
            NetworkBody::Rung(node) => outputs(node, &[]),
            NetworkBody::List { .. } => Vec::new(),
        };
        let way = ways
            .iter()
            .find(|(output, _)| output.instr == transition.instrs[0]);
        let way = way.map_or(&[][..], |(_, way)| way.as_slice());
        let (language, text) = match expression(
            self.words,
            &way.iter().copied().flatten().cloned().collect::<Vec<_>>(),
        ) {
            Some(text) if text.is_empty() => ("ST", "TRUE".to_owned()),
            Some(text) => ("ST", text),
            None => {
                let mut lines = Lines::new(self.words);
                condition(&mut lines, way);
                ("IL", lines.text)
            }
        };
        let (id, priority) = (id.to_string(), priority.to_string());
        let attributes = [
            ("localId", id.as_str()),
            ("height", "2"),
            ("width", "20"),
            ("priority", &priority),
        ];
        self.xml.node("transition", &attributes, |xml| {
            position(xml, x, y);
            input(xml, &[from]);
            output(xml, "connectionPointOut", false);
            xml.node("condition", &[], |xml| {
                xml.node("inline", &[("name", "")], |xml| xml.prose(language, &text));
            });
        });
    }

    /// Writes the actions of a state: lists whose networks begin with its step, so that they end with it.
    fn actions(&mut self, step: usize, state: usize, actions: &[(Vec<usize>, Node)]) {
        let (x, y) = self.place(state, 0);
        let chart = self.chart;
        let mut texts = Vec::new();
        for (states, node) in actions {
            let mut lines = Lines::continued(self.words, self.kept);
            let active = |lines: &mut Lines| {
                for (nth, state) in states.iter().enumerate() {
                    let operator = if nth == 0 { "LD" } else { "AND" };
                    let name = chart.states[*state].device;
                    lines.text.push_str(&format!("{operator} {name}.X\n"));
                }
            };
            if is_changed(node) {
                // INV changes the contacts alone, not that the state is active.
                for (output, way) in outputs(node, &[]) {
                    active(&mut lines);
                    lines.nested(Entry::And, |lines| condition(lines, &way));
                    lines.output(output);
                }
            } else {
                active(&mut lines);
                lines.node(node, Entry::And);
            }
            self.kept = lines.kept;
            texts.push(lines.text);
        }
        let ids: Vec<_> = texts.iter().map(|_| self.id().to_string()).collect();
        let id = self.id().to_string();
        let attributes = [("localId", id.as_str()), ("width", "120"), ("height", "30")];
        self.xml.node("actionBlock", &attributes, |xml| {
            position(xml, x + 2 * STEP.0, y);
            input(xml, &[step]);
            for (text, id) in texts.iter().zip(&ids) {
                let attributes = [("localId", id.as_str()), ("qualifier", "N")];
                xml.node("action", &attributes, |xml| {
                    relative(xml, 0, 0);
                    xml.node("inline", &[], |xml| xml.prose("IL", text));
                });
            }
        });
    }
}

/// An input and what leads to it.
fn input(xml: &mut Xml, from: &[usize]) {
    xml.node("connectionPointIn", &[], |xml| {
        relative(xml, STEP.0 / 2, 0);
        for id in from {
            xml.leaf("connection", &[("refLocalId", &id.to_string())]);
        }
    });
}

/// An output, which some elements name.
fn output(xml: &mut Xml, kind: &'static str, named: bool) {
    let name: xml::Attributes = if named {
        &[("formalParameter", "")]
    } else {
        &[]
    };
    xml.node(kind, name, |xml| relative(xml, STEP.0 / 2, STEP.1));
}
