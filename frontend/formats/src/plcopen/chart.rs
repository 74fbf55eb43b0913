//! Sequential function charts: steps as relays, which transitions set and reset as the standard lets a chart evolve.
//!
//! All transitions are evaluated first, then the steps before those that fire are reset, then the steps after them are
//! set, then the actions of the active steps are executed.

use super::drawing::Drawing;
use super::logic::{Logic, Output, Part, Sense};
use super::{FREE, Fault, Reader, called, children, expression, list, modifiers, text, variables};
use roxmltree::Node;
use rungc_syntax::{Device, DeviceClass};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The most divergences and convergences between a step and a transition.
const DEEPEST: usize = 50;

/// A chart while it is read.
struct Chart<'a, 'i> {
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    /// Destinations of an element's outputs.
    uses: HashMap<&'a str, Vec<&'a str>>,
    /// By name in upper case.
    steps: HashMap<String, Device>,
}

/// A transition: the steps around it and the relay of its condition.
struct Transition<'a> {
    before: BTreeSet<&'a str>,
    relay: Device,
    reset: Vec<Device>,
    set: Vec<Device>,
}

/// Reads the chart of a program.
pub(super) fn read(reader: &mut Reader, pou: Node, body: Node) -> Result<(), Fault> {
    let mut chart = Chart {
        by_id: HashMap::new(),
        uses: HashMap::new(),
        steps: HashMap::new(),
    };
    for node in body.children().filter(Node::is_element) {
        let Some(id) = node.attribute("localId") else {
            continue;
        };
        chart.by_id.insert(id, node);
        for from in sources(node) {
            chart.uses.entry(from).or_default().push(id);
        }
    }
    chart.check(body)?;
    chart.find_steps(reader, body)?;
    for block in children(body, "actionBlock") {
        let lists = children(block, "action").filter_map(|action| body_of(pou, action));
        for list in lists.flat_map(|inside| children(inside, "IL")) {
            list::prepare(reader, list);
        }
    }
    let mut transitions = Vec::new();
    for node in in_order(body) {
        let id = node.attribute("localId").unwrap_or_default();
        let relay = reader
            .variables
            .part(&format!("transition..{id}"), DeviceClass::M, 1, |_| true);
        let relay = relay.ok_or_else(|| Fault::at(node, "the transition needs a relay", FREE))?;
        let transition = chart.transition(node, relay)?;
        let condition = condition(reader, pou, body, node)?;
        let active = transition.before.iter().filter_map(|id| chart.step(id));
        let active =
            active.map(|device| Logic::contact(node.id().get(), true, device.to_smolstr()));
        let mut logic = active.fold(Logic::wire(), Logic::then);
        let rivals = transitions
            .iter()
            .filter(|other: &&Transition| !other.before.is_disjoint(&transition.before));
        for rival in rivals {
            let contact = Logic::contact(node.id().get(), false, rival.relay.to_smolstr());
            logic = logic.then(contact);
        }
        network(
            reader,
            logic.then(condition),
            vec![format_smolstr!("OUT {relay}")],
        );
        transitions.push(transition);
    }
    for (mnemonic, resets) in [("RST", true), ("SET", false)] {
        for transition in &transitions {
            let devices = if resets {
                &transition.reset
            } else {
                &transition.set
            };
            let lines = devices
                .iter()
                .map(|device| format_smolstr!("{mnemonic} {device}"));
            let fires = Logic::contact(0, true, transition.relay.to_smolstr());
            network(reader, fires, lines.collect());
        }
    }
    chart.actions(reader, pou, body)
}

fn network(reader: &mut Reader, logic: Logic, lines: Vec<SmolStr>) {
    reader.parts.push(Part::Output(Output {
        logic,
        lines,
        alone: true,
        bare: false,
    }));
}

/// The elements that lead to one.
fn sources<'a, 'i>(node: Node<'a, 'i>) -> Vec<&'a str> {
    let points = children(node, "connectionPointIn");
    let connections = points.flat_map(|point| children(point, "connection"));
    connections
        .filter_map(|c| c.attribute("refLocalId"))
        .collect()
}

/// The transitions by their priorities, then from left to right and from the top down.
fn in_order<'a, 'i>(body: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let mut transitions: Vec<_> = children(body, "transition").collect();
    let number = |node: &Node, key: &str| {
        let position = children(*node, "position").next()?;
        position.attribute(key)?.parse::<f64>().ok()
    };
    let priority = |node: &Node| {
        let priority = node.attribute("priority")?.parse::<u64>().ok()?;
        (priority > 0).then_some(priority)
    };
    transitions.sort_by(|a, b| {
        let by = |key| {
            let of = |node| number(node, key).unwrap_or(0.0);
            of(a).total_cmp(&of(b))
        };
        let rank = |node| priority(node).unwrap_or(u64::MAX);
        rank(a).cmp(&rank(b)).then(by("x")).then(by("y"))
    });
    transitions
}

impl<'a, 'i> Chart<'a, 'i> {
    /// Rejects elements that have no counterpart.
    fn check(&self, body: Node) -> Result<(), Fault> {
        for node in body.children().filter(Node::is_element) {
            match node.tag_name().name() {
                "step"
                | "transition"
                | "selectionDivergence"
                | "selectionConvergence"
                | "simultaneousDivergence"
                | "simultaneousConvergence"
                | "jumpStep"
                | "actionBlock"
                | "contact"
                | "inVariable"
                | "block"
                | "leftPowerRail"
                | "rightPowerRail"
                | "comment"
                | "connector"
                | "continuation" => {}
                _ => {
                    let help = "rungc reads steps, transitions, branches, jumps and actions";
                    return Err(Fault::outside(node, help));
                }
            }
        }
        Ok(())
    }

    /// Finds the relays of all steps; the first scan sets the initial ones.
    fn find_steps(&mut self, reader: &mut Reader, body: Node) -> Result<(), Fault> {
        for node in children(body, "step") {
            let name = node.attribute("name").unwrap_or_default();
            let key = format!("{name}.X");
            let variables = &mut reader.variables;
            // A step that is called like a state is this state, unless the table says otherwise.
            let own = variables::device(name).filter(|device| device.class == DeviceClass::S);
            let own = own.filter(|_| !variables.is_named(&key));
            let state = own.or_else(|| variables.part(&key, DeviceClass::S, 1, |_| true));
            let device = state.or_else(|| variables.part(&key, DeviceClass::M, 1, |_| true));
            let device = device.ok_or_else(|| {
                Fault::at(
                    node,
                    format!("the step `{name}` needs a relay for `{key}`"),
                    FREE,
                )
            })?;
            if modifiers::flag(node, "initialStep")? {
                reader
                    .variables
                    .first_scan
                    .push(format_smolstr!("SET {device}"));
            }
            reader.steps.insert(name.to_uppercase(), device);
            self.steps.insert(name.to_uppercase(), device);
        }
        Ok(())
    }

    /// The relay of a step by its number.
    fn step(&self, id: &str) -> Option<Device> {
        let name = self.by_id.get(id)?.attribute("name")?;
        self.steps.get(&name.to_uppercase()).copied()
    }

    fn transition(&self, node: Node<'a, 'i>, relay: Device) -> Result<Transition<'a>, Fault> {
        let mut before = BTreeSet::new();
        for from in sources(node) {
            self.before(from, node, 0, &mut before)?;
        }
        let mut after = Vec::new();
        let id = node.attribute("localId").unwrap_or_default();
        self.after(id, node, 0, &mut after)?;
        if before.is_empty() || after.is_empty() {
            let what = "the transition lacks a step before or after it";
            return Err(Fault::at(node, what, "connect it to steps"));
        }
        let reset = before.iter().filter_map(|id| self.step(id)).collect();
        Ok(Transition {
            before,
            relay,
            reset,
            set: after,
        })
    }

    /// The steps that lead to a transition through an element.
    fn before(
        &self,
        id: &'a str,
        to: Node,
        depth: usize,
        steps: &mut BTreeSet<&'a str>,
    ) -> Result<(), Fault> {
        let missing = || {
            Fault::at(
                to,
                format!("there is no element {id}"),
                "draw the wire again",
            )
        };
        let node = self.by_id.get(id).ok_or_else(missing)?;
        match node.tag_name().name() {
            "step" => _ = steps.insert(id),
            "selectionDivergence" | "simultaneousDivergence" | "simultaneousConvergence"
                if depth < DEEPEST =>
            {
                for from in sources(*node) {
                    self.before(from, to, depth + 1, steps)?;
                }
            }
            name => {
                let what = format!("`{name}` leads to a transition");
                return Err(Fault::at(to, what, "put a step before it"));
            }
        }
        Ok(())
    }

    /// The steps that a transition leads to.
    fn after(
        &self,
        id: &'a str,
        from: Node,
        depth: usize,
        steps: &mut Vec<Device>,
    ) -> Result<(), Fault> {
        for id in self.uses.get(id).into_iter().flatten() {
            let Some(node) = self.by_id.get(id) else {
                continue;
            };
            match node.tag_name().name() {
                "step" => steps.extend(self.step(id)),
                "jumpStep" => {
                    let name = node.attribute("targetName").unwrap_or_default();
                    let step = self.steps.get(&name.to_uppercase()).ok_or_else(|| {
                        let what = format!("there is no step `{name}`");
                        Fault::at(*node, what, "jump to a step of this chart")
                    })?;
                    steps.push(*step);
                }
                "selectionConvergence" | "simultaneousDivergence" if depth < DEEPEST => {
                    self.after(id, from, depth + 1, steps)?;
                }
                name => {
                    let what = format!("a transition leads to `{name}`");
                    return Err(Fault::at(from, what, "put a step after it"));
                }
            }
        }
        Ok(())
    }

    /// The actions of steps: variables that are on while a step is active, or that it sets and resets, and bodies whose
    /// networks begin with their step.
    fn actions(&self, reader: &mut Reader, pou: Node, body: Node<'a, 'i>) -> Result<(), Fault> {
        let mut uses: BTreeMap<Device, Vec<Use>> = BTreeMap::new();
        let mut bodies = Vec::new();
        for block in children(body, "actionBlock") {
            let steps = sources(block);
            let step = steps.first().and_then(|id| self.step(id));
            let step =
                step.ok_or_else(|| Fault::at(block, "no step has these actions", "connect them"))?;
            for action in children(block, "action") {
                let qualifier = action.attribute("qualifier").unwrap_or("N");
                let reference = children(action, "reference").next();
                let name = reference.and_then(|reference| reference.attribute("name"));
                if let Some(inside) = body_of(pou, action) {
                    bodies.push(networks(reader, inside, qualifier, step)?);
                    continue;
                }
                let Some(name) = name else {
                    let what = "an action that is neither a variable nor a body";
                    return Err(Fault::at(action, what, "name a BOOL variable"));
                };
                let mnemonic = match qualifier {
                    "N" => "OUT",
                    "S" => "SET",
                    "R" => "RST",
                    _ => {
                        let what =
                            format!("the qualifier `{qualifier}` of `{name}` has no counterpart");
                        return Err(Fault::at(action, what, "rungc reads N, S and R"));
                    }
                };
                let device = reader.bit(action, name)?;
                let entry = uses.entry(device).or_default();
                entry.push(Use {
                    mnemonic,
                    line: format_smolstr!("{mnemonic} {device}"),
                    logic: Logic::contact(entry.len() as u32, true, step.to_smolstr()),
                });
            }
        }
        share(&mut bodies, &mut uses);
        reader.parts.extend(bodies.into_iter().flatten());
        for (device, uses) in uses {
            drive(reader, body, device, &uses)?;
        }
        Ok(())
    }
}

/// Effect of an action on a variable.
struct Use {
    /// OUT, SET or RST.
    mnemonic: &'static str,
    /// The instruction.
    line: SmolStr,
    logic: Logic,
}

/// The body of an action: its own, or that of the action of the program that it names.
fn body_of<'a, 'i>(pou: Node<'a, 'i>, action: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
    let inline = children(action, "inline").next();
    inline.or_else(|| {
        let name = children(action, "reference").next()?.attribute("name")?;
        let lists = children(pou, "actions").flat_map(|list| children(list, "action"));
        let mut named = lists.filter(|node| node.attribute("name") == Some(name));
        children(named.next()?, "body").next()
    })
}

/// The networks of an action with a body. Each begins with a contact of its step, so that it is off in the last
/// execution, which the standard adds when the step has ended: so nothing changes if it is executed in each scan.
fn networks(
    reader: &mut Reader,
    body: Node,
    qualifier: &str,
    step: Device,
) -> Result<Vec<Part>, Fault> {
    if qualifier != "N" {
        let what = format!("an action with a body and the qualifier `{qualifier}`");
        return Err(Fault::at(body, what, "use N"));
    }
    let start = reader.parts.len();
    for language in body.children().filter(Node::is_element) {
        match language.tag_name().name() {
            "IL" => list::read(reader, language),
            "LD" | "FBD" => super::drawing::read(reader, language),
            _ => {
                let help = "write the action as LD, FBD or IL";
                return Err(Fault::outside(language, help));
            }
        }
    }
    let parts = reader.parts.split_off(start);
    let step = step.to_smolstr();
    let begins = |logic: &Logic| {
        let contact = matches!(logic.first(), Some(Logic::Contact(contact))
            if contact.sense == Sense::On && contact.operands == step);
        contact && !logic.is_changed()
    };
    let ends = |part: &Part| match part {
        Part::Output(output) => begins(&output.logic),
        Part::Line(line) => line.starts_with(';'),
    };
    if !parts.iter().all(ends) {
        let what = format!("an action of {step} has a network that does not end with its step");
        let help = "begin each network with the step: `LD` of its name and `.X`";
        return Err(Fault::at(body, what, help));
    }
    Ok(parts)
}

/// The device that a coil drives or, with another mnemonic, sets or resets.
fn coil(line: &str, mnemonic: &str) -> Option<Device> {
    let mut words = line.strip_prefix(mnemonic)?.strip_prefix(' ')?.split(' ');
    variables::device(words.next()?)
}

/// Takes the coils that several actions drive out of their bodies: one network drives each.
fn share(bodies: &mut [Vec<Part>], uses: &mut BTreeMap<Device, Vec<Use>>) {
    let mut count: BTreeMap<Device, usize> = BTreeMap::new();
    let mut stored = BTreeSet::new();
    let lines = bodies.iter().flatten().flat_map(|part| match part {
        Part::Output(output) => output.lines.as_slice(),
        Part::Line(_) => &[],
    });
    for line in lines {
        if let Some(device) = coil(line, "OUT") {
            *count.entry(device).or_default() += 1;
        }
        let device = coil(line, "SET").or_else(|| coil(line, "RST"));
        // RST of a timer or counter is not of its coil.
        stored.extend(device.filter(|d| !matches!(d.class, DeviceClass::T | DeviceClass::C)));
    }
    for body in bodies {
        body.retain(|part| {
            let Part::Output(output) = part else {
                return true;
            };
            let line = output.lines.first();
            let driven = line.and_then(|line| coil(line, "OUT"));
            let shared = driven.filter(|device| {
                count[device] > 1 || stored.contains(device) || uses.contains_key(device)
            });
            let (Some(device), Some(line)) = (shared, line) else {
                return true;
            };
            let entry = uses.entry(device).or_default();
            if stored.contains(&device) {
                entry.push(Use {
                    mnemonic: "SET",
                    line: format_smolstr!("SET {device}"),
                    logic: Logic::wire(),
                });
            }
            entry.push(Use {
                mnemonic: "OUT",
                line: line.clone(),
                logic: output.logic.clone(),
            });
            false
        });
    }
}

/// Drives a variable as actions say.
fn drive(reader: &mut Reader, body: Node, device: Device, uses: &[Use]) -> Result<(), Fault> {
    let of = |mnemonic: &str| {
        let uses = uses.iter().filter(|found| found.mnemonic == mnemonic);
        uses.collect::<Vec<_>>()
    };
    let [driven, set, reset] = ["OUT", "SET", "RST"].map(of);
    if !driven.is_empty() && driven.len() < uses.len() {
        let what = format!("{device} is both stored and not stored by actions");
        return Err(Fault::at(body, what, "use two variables"));
    }
    for uses in [driven, set, reset] {
        let Some(first) = uses.first() else { continue };
        if uses.iter().any(|other| other.line != first.line) {
            let what = format!("actions drive {device} with different presets");
            return Err(Fault::at(body, what, "use one preset"));
        }
        let ways = uses.iter().map(|found| found.logic.clone()).collect();
        network(reader, Logic::joined(ways), vec![first.line.clone()]);
    }
    Ok(())
}

/// Condition of a transition, once the steps before it are active.
fn condition(reader: &mut Reader, pou: Node, body: Node, transition: Node) -> Result<Logic, Fault> {
    let Some(condition) = children(transition, "condition").next() else {
        return Err(Fault::at(
            transition,
            "the transition has no condition",
            "write TRUE",
        ));
    };
    let negated = modifiers::flag(condition, "negated")?;
    let Some(kind) = condition.first_element_child() else {
        return Err(Fault::at(
            transition,
            "the transition has no condition",
            "write TRUE",
        ));
    };
    let logic = match kind.tag_name().name() {
        "reference" => {
            let name = kind.attribute("name").unwrap_or_default();
            let lists = children(pou, "transitions").flat_map(|list| children(list, "transition"));
            let mut named = lists.filter(|node| node.attribute("name") == Some(name));
            match named.next().and_then(|node| children(node, "body").next()) {
                Some(body) => written(reader, body)?,
                None => expression::bit(reader, kind, kind.id().get(), true, name)?,
            }
        }
        "inline" => written(reader, kind)?,
        "connectionPointIn" => {
            let mut drawing = Drawing::new(reader, body);
            let power = drawing.flow_into(condition);
            power.map_err(|fault| {
                let unread =
                    || Fault::at(condition, "the condition cannot be read", "draw contacts");
                fault.unwrap_or_else(unread)
            })?
        }
        _ => {
            return Err(Fault::outside(
                kind,
                "write the condition as contacts, IL or ST",
            ));
        }
    };
    Ok(if negated { logic.changed("INV") } else { logic })
}

/// A condition in a separate body.
fn written(reader: &mut Reader, body: Node) -> Result<Logic, Fault> {
    let Some(language) = body.first_element_child() else {
        return Err(Fault::at(body, "the condition is empty", "write TRUE"));
    };
    match language.tag_name().name() {
        "ST" => expression::read(reader, language, &text(language)),
        "IL" => list::condition(reader, language),
        _ => {
            let what = format!("{} as a condition has no counterpart", called(language));
            Err(Fault::at(
                language,
                what,
                "write it as ST or IL, or draw contacts at the transition",
            ))
        }
    }
}
