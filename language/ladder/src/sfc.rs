//! The sequential function chart of a program's step ladder: its states, and the transitions between them.
//!
//! [`Chart::of`] reads it from the networks: what a state's section drives is an action of the state, and SET or OUT of
//! a state is a transition, whose condition is the contacts before it. STLs in a row leave several states together;
//! several states that one condition sets begin together. [`Chart::text`] draws the chart in characters,
//! [`Chart::picture`] as a picture. Conditions are written as in IEC 60848: `·` for series, `+` for parallel contacts,
//! `↑` and `↓` for edges, `/` before what is closed while it is off.

use crate::condition::Condition;
use crate::face::Face;
use crate::network::{InstrIndex, Item, Ladder, NetworkBody, Node, Output, Series};
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::{Basic, Lower};
use rungc_syntax::{Device, DeviceClass};
use std::collections::BTreeMap;

mod place;
mod render;
mod text;

/// The states that may begin a flow (h1u-h2u-programming §4.2.2).
const LAST_INITIAL: u32 = 9;

/// The states of a step ladder and what leads from each to others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Chart {
    /// States, in the order in which their sections begin.
    pub states: Vec<State>,
    /// Transitions between states, in order.
    pub transitions: Vec<Transition>,
    /// Instructions outside the sections that switch states.
    pub others: Vec<Other>,
}

/// A state of a step ladder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Its device.
    pub device: Device,
    /// Name, from its comment, or the statement or note on its STL.
    pub name: Option<String>,
    /// Number of the network that begins its first section, counted from 1.
    pub network: usize,
    /// Actions of its sections.
    pub actions: Vec<Action>,
}

impl State {
    /// Returns true if it may begin a flow.
    pub fn is_initial(&self) -> bool {
        self.device.number <= LAST_INITIAL
    }
}

/// Action of a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Action {
    /// A coil or box, and under which condition it is driven: `(Y004) if /T2`.
    pub text: String,
    /// The device that it is about.
    pub device: Option<Device>,
}

/// Transition from states to others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Transition {
    /// Positions of the states that are left, all of which are on; empty if other parts of the program begin a flow.
    pub from: Vec<usize>,
    /// Positions of the states that begin.
    pub to: Vec<usize>,
    /// The contacts in front of it; `1` if there is none.
    pub condition: String,
    /// Number of its network, counted from 1.
    pub network: usize,
    /// The instructions that switch the states that begin.
    pub instrs: Vec<InstrIndex>,
}

/// An instruction outside the sections of states that switches some.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Other {
    /// The instruction.
    pub instr: InstrIndex,
    /// Its step.
    pub step: u32,
    /// The instruction as a box.
    pub text: String,
}

fn basic(resolved: &Resolved, instr: InstrIndex) -> Option<Basic> {
    match resolved.instrs[instr].lower {
        Some(Lower::Basic(basic)) => Some(basic),
        _ => None,
    }
}

/// The S device that an instruction names first.
fn named(resolved: &Resolved, instr: InstrIndex) -> Option<Device> {
    let operand = resolved.program.instrs[instr].operands.first()?;
    let device = operand.kind.device()?;
    (device.class == DeviceClass::S).then_some(device)
}

impl Chart {
    /// The chart of a program; nothing if it has no STL.
    pub fn of(resolved: &Resolved, ladder: &Ladder) -> Option<Chart> {
        let mut reader = Reader {
            face: Face::of(resolved, &[], false),
            chart: Chart::default(),
            position: BTreeMap::new(),
            current: Vec::new(),
            in_row: false,
            network: 0,
        };
        for (number, network) in (1..).zip(&ladder.networks) {
            for instr in network.instrs.clone() {
                if basic(resolved, instr) == Some(Basic::Stl) {
                    reader.state(instr, number);
                }
            }
        }
        if reader.chart.states.is_empty() {
            return None;
        }
        for (number, network) in (1..).zip(&ladder.networks) {
            reader.network = number;
            match &network.body {
                NetworkBody::Rung(node) => reader.node(node, &Condition::default()),
                NetworkBody::List { .. } => {
                    let unknown = Condition::unknown(number);
                    for instr in network.instrs.clone() {
                        let output = Output { instr, coil: false };
                        reader.output(output, &unknown);
                    }
                }
            }
        }
        Some(reader.chart)
    }
}

/// Reads the networks of a step ladder one after another.
struct Reader<'a> {
    face: Face<'a>,
    chart: Chart,
    /// Position of each state in the chart.
    position: BTreeMap<Device, usize>,
    /// The states of the section at hand; none outside.
    current: Vec<usize>,
    /// True if the previous instruction was STL.
    in_row: bool,
    network: usize,
}

impl Reader<'_> {
    /// A section begins here.
    fn state(&mut self, instr: InstrIndex, network: usize) {
        let resolved = self.face.resolved;
        let Some(device) = named(resolved, instr) else {
            return;
        };
        let program = resolved.program;
        let written = &program.instrs[instr];
        let name = program.comments.get(&device).map(String::as_str);
        let name = name
            .or_else(|| written.note())
            .or_else(|| written.statement());
        let next = self.chart.states.len();
        let at = *self.position.entry(device).or_insert(next);
        if at == next {
            self.chart.states.push(State {
                device,
                name: None,
                network,
                actions: Vec::new(),
            });
        }
        let state = &mut self.chart.states[at];
        state.name = state.name.take().or(name.map(str::to_string));
    }

    fn node(&mut self, node: &Node, before: &Condition) {
        let condition = self.condition(&node.series, before);
        for item in &node.items {
            match item {
                Item::Output(output) => self.output(*output, &condition),
                Item::Stack(branches) => branches
                    .iter()
                    .for_each(|branch| self.node(branch, &condition)),
                Item::Continue(next) => self.node(next, &condition),
            }
        }
    }

    fn condition(&self, series: &Series, before: &Condition) -> Condition {
        let mut condition = before.clone();
        condition.pass(&self.face, series);
        condition
    }

    fn output(&mut self, output: Output, condition: &Condition) {
        let resolved = self.face.resolved;
        let basic = basic(resolved, output.instr);
        let was_in_row = std::mem::replace(&mut self.in_row, false);
        let position = named(resolved, output.instr)
            .and_then(|device| self.position.get(&device))
            .copied();
        match (basic, position) {
            (Some(Basic::Stl), position) => {
                if !was_in_row {
                    self.current.clear();
                }
                self.current.extend(position);
                self.in_row = true;
            }
            (Some(Basic::Nop), _) => self.in_row = was_in_row,
            (Some(Basic::Ret | Basic::Fend | Basic::End), _) => self.current.clear(),
            (Some(Basic::Set | Basic::Out), Some(target)) => {
                self.transition(target, condition, output.instr)
            }
            _ if self.current.is_empty() => self.outside(output),
            _ => self.action(output, condition),
        }
    }

    fn transition(&mut self, target: usize, condition: &Condition, instr: InstrIndex) {
        let condition = condition.text();
        let same = |made: &&mut Transition| {
            made.from == self.current && made.condition == condition && !made.from.is_empty()
        };
        // States set by one condition begin together.
        if let Some(made) = self.chart.transitions.iter_mut().find(same) {
            if !made.to.contains(&target) {
                made.to.push(target);
            }
            made.instrs.push(instr);
            return;
        }
        self.chart.transitions.push(Transition {
            from: self.current.clone(),
            to: vec![target],
            condition,
            network: self.network,
            instrs: vec![instr],
        });
    }

    fn action(&mut self, output: Output, condition: &Condition) {
        let (&state, others) = match self.current.split_first() {
            Some(states) => states,
            None => return,
        };
        let others = others.iter().map(|other| self.chart.states[*other].device);
        let condition = condition.after(others.map(|device| device.to_string()));
        let mut text = self.face.output_text(output);
        if !condition.is_always() {
            text.push_str(" if ");
            text.push_str(&condition.text());
        }
        let operands = &self.face.resolved.program.instrs[output.instr].operands;
        let device = operands.first().and_then(|operand| operand.kind.device());
        self.chart.states[state]
            .actions
            .push(Action { text, device });
    }

    /// An instruction outside the sections: listed if it names states.
    fn outside(&mut self, output: Output) {
        let resolved = self.face.resolved;
        let operands = &resolved.program.instrs[output.instr].operands;
        let mut devices = operands.iter().filter_map(|operand| operand.kind.device());
        if devices.any(|device| device.class == DeviceClass::S) {
            self.chart.others.push(Other {
                instr: output.instr,
                step: resolved.instrs[output.instr].step,
                text: self.face.output_text(output),
            });
        }
    }
}
