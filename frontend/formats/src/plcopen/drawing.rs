//! Ladders and function block diagrams: what the wires lead to, from the top down.

use super::logic::{Contact, Logic, Output, Part, Sense};
use super::modifiers::{Accepted, Edge, INTO, Modifiers, ONE_WAY, OUT_OF, Storage};
use super::variables::{Kind, constant};
use super::{Fault, Reader, called, children, text};
use roxmltree::Node;
use rungc_syntax::DeviceClass;
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::collections::{BTreeMap, HashMap, HashSet};

/// The most elements on one way.
const DEEPEST: usize = 200;

/// Value on a wire.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// Power: whether something is on.
    Flow(Logic),
    /// A number.
    Word(Word),
}

impl Value {
    /// The value after the modifiers of an element or a pin, which numbers do not have.
    pub fn modified(self, node: Node, modifiers: Modifiers) -> Result<Self, Fault> {
        match self {
            Value::Flow(logic) => Ok(Value::Flow(modifiers.negate(logic))),
            value if modifiers == Modifiers::default() => Ok(value),
            Value::Word(word) => {
                let what = format!("`{}` is a number, which is not negated here", word.operand);
                Err(Fault::at(node, what, "connect a bit"))
            }
        }
    }

    /// The power, if it is power.
    pub fn flow(&self) -> Option<Logic> {
        match self {
            Value::Flow(logic) => Some(logic.clone()),
            Value::Word(_) => None,
        }
    }
}

/// A number: a constant or a register.
#[derive(Clone, Debug)]
pub(super) struct Word {
    /// Spelling in a list.
    pub operand: SmolStr,
    /// Type; `None`: a constant, which fits all.
    pub kind: Option<Kind>,
}

/// A drawing while it is read.
pub(super) struct Drawing<'a, 'i, 'r> {
    pub reader: &'r mut Reader,
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    /// By name.
    connectors: HashMap<&'a str, Node<'a, 'i>>,
    /// Destinations of an element's outputs: the output as the connection names it, and the element there.
    uses: HashMap<&'a str, Vec<(&'a str, Node<'a, 'i>)>>,
    /// Known logic of an element's outputs.
    known: HashMap<(&'a str, &'a str), Logic>,
    /// Outputs of the blocks that have been read.
    done: HashMap<&'a str, BTreeMap<SmolStr, Value>>,
    /// Blocks that could not be read, and were reported.
    failed: HashSet<&'a str>,
    /// The elements on the way that is being followed.
    on_it: Vec<&'a str>,
}

/// Reads a drawing: each coil and block from the top down, after what leads to it.
pub(super) fn read(reader: &mut Reader, body: Node) {
    let mut drawing = Drawing::new(reader, body);
    let mut ends: Vec<_> = body.children().filter(|node| ends_a_way(*node)).collect();
    let order = |node: &Node| node.attribute("executionOrderId")?.parse::<u64>().ok();
    let ordered = |node: &Node| order(node).is_some_and(|order| order > 0);
    if ends.iter().all(ordered) {
        ends.sort_by_key(order);
    } else {
        ends.sort_by(|a, b| {
            let (a, b) = (place(a), place(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
    }
    super::blocks::prepare(&mut drawing, &ends);
    for node in ends {
        if drawing.reader.gives_up() {
            return;
        }
        match drawing.end(node) {
            Ok(()) | Err(None) => {}
            Err(Some(fault)) => drawing.reader.report(fault),
        }
    }
    let contacts = children(body, "contact");
    for node in contacts {
        if drawing.reader.gives_up() {
            return;
        }
        if !drawing.leads_on(node) {
            drawing.reader.report(without_effect(node));
        }
    }
}

/// An element whose output leads to nothing.
fn without_effect(node: Node) -> Fault {
    let name = match variable_of(node) {
        Some(name) => format!("contact `{}`", name.trim()),
        None => called(node),
    };
    let what = format!("{name} drives nothing");
    Fault::at(
        node,
        what,
        "connect its output to a coil or a block, or delete it",
    )
}

/// Row and column of an element.
fn place(node: &Node) -> (f64, f64) {
    let position = children(*node, "position").next();
    let number = |key| position.and_then(|p| p.attribute(key)?.parse::<f64>().ok());
    (number("y").unwrap_or(0.0), number("x").unwrap_or(0.0))
}

/// Returns true if an element has an effect, and is not only a part of the way to another.
fn ends_a_way(node: Node) -> bool {
    node.is_element()
        && !matches!(
            node.tag_name().name(),
            "leftPowerRail"
                | "rightPowerRail"
                | "contact"
                | "inVariable"
                | "connector"
                | "continuation"
        )
}

/// Reason why a way cannot be followed; `None` if it has been reported.
pub(super) type Failure = Option<Fault>;

impl<'a, 'i, 'r> Drawing<'a, 'i, 'r> {
    pub fn new(reader: &'r mut Reader, body: Node<'a, 'i>) -> Self {
        let mut drawing = Drawing {
            reader,
            by_id: HashMap::new(),
            connectors: HashMap::new(),
            uses: HashMap::new(),
            known: HashMap::new(),
            done: HashMap::new(),
            failed: HashSet::new(),
            on_it: Vec::new(),
        };
        for node in body.children().filter(Node::is_element) {
            if let Some(id) = node.attribute("localId") {
                drawing.by_id.insert(id, node);
            }
            if let ("connector", Some(name)) = (node.tag_name().name(), node.attribute("name")) {
                drawing.connectors.insert(name, node);
            }
            let connections = node.descendants();
            for connection in connections.filter(|n| n.tag_name().name() == "connection") {
                let output = connection.attribute("formalParameter").unwrap_or_default();
                let from = connection.attribute("refLocalId").unwrap_or_default();
                drawing.uses.entry(from).or_default().push((output, node));
            }
        }
        drawing
    }

    fn end(&mut self, node: Node<'a, 'i>) -> Result<(), Failure> {
        match node.tag_name().name() {
            "coil" => {
                let name = variable_of(node)
                    .ok_or_else(|| Fault::outside(node, "give the coil a variable"))?;
                let logic = self.flow_into(node)?;
                let device = self.reader.bit(node, &name)?;
                self.store(node, ONE_WAY, logic, &device.to_smolstr())?;
            }
            "block" => {
                let parts = self.reader.parts.len();
                self.block(node.attribute("localId").unwrap_or_default())?;
                if self.reader.parts.len() == parts && !self.leads_on(node) {
                    return Err(Some(without_effect(node)));
                }
            }
            "outVariable" | "inOutVariable" => self.out_variable(node)?,
            "label" => {
                let label = node.attribute("label").unwrap_or_default();
                let pointer = self.reader.pointer(label);
                self.reader.parts.push(Part::Line(pointer.into()));
            }
            "jump" => {
                let logic = self.flow_into(node)?;
                let label = node.attribute("label").unwrap_or_default();
                let pointer = self.reader.pointer(label);
                self.reader.output(logic, format_smolstr!("CJ {pointer}"));
            }
            "return" => {
                let logic = self.flow_into(node)?;
                let pointer = self.reader.pointer(super::RETURN);
                self.reader.output(logic, format_smolstr!("CJ {pointer}"));
            }
            "comment" => {
                let content = children(node, "content").map(text).collect::<String>();
                let lines = content.lines().map(str::trim).filter(|l| !l.is_empty());
                let lines = lines.map(|line| Part::Line(format!("; {line}")));
                self.reader.parts.extend(lines);
            }
            _ => {
                let help = "rungc reads contacts, coils, variables, blocks, labels and jumps";
                return Err(Some(Fault::outside(node, help)));
            }
        }
        Ok(())
    }

    /// Lets power drive a device as an element says: negated, stored, or by an edge.
    fn store(
        &mut self,
        node: Node,
        names: [&'static str; 3],
        logic: Logic,
        device: &str,
    ) -> Result<(), Fault> {
        let modifiers = Modifiers::of(node, names, Accepted::All)?;
        let logic = modifiers.negate(logic);
        let (mnemonic, logic) = match (modifiers.storage, modifiers.edge) {
            (None, None) => ("OUT", logic),
            (None, Some(Edge::Rising)) => ("PLS", logic),
            (None, Some(Edge::Falling)) => ("PLF", logic),
            (Some(storage), edge) => {
                let mnemonic = match storage {
                    Storage::Set => "SET",
                    Storage::Reset => "RST",
                };
                match edge {
                    Some(edge) => (mnemonic, logic.pulsed(edge)),
                    None => (mnemonic, logic),
                }
            }
        };
        self.reader
            .output(logic, format_smolstr!("{mnemonic} {device}"));
        Ok(())
    }

    /// Stores what leads to an output variable.
    fn out_variable(&mut self, node: Node<'a, 'i>) -> Result<(), Failure> {
        let point = children(node, "connectionPointIn").next();
        let Some((point, source)) = point.and_then(|p| Some((p, self.one_source(p)?))) else {
            return match node.tag_name().name() {
                // It is read only, as an input is.
                "inOutVariable" => Ok(()),
                _ => Err(Some(self.unconnected(node))),
            };
        };
        let name = children(node, "expression").map(text).collect::<String>();
        let names = match node.tag_name().name() {
            "inOutVariable" => INTO,
            _ => ONE_WAY,
        };
        let from = self.by_id.get(source.0);
        let of_block = from.is_some_and(|from| from.tag_name().name() == "block");
        match self.value_into(point, node)? {
            Value::Flow(logic) => {
                let device = self.reader.bit(node, &name)?;
                self.store(node, names, logic, &device.to_smolstr())?;
            }
            Value::Word(word) => {
                Modifiers::of(node, names, Accepted::None)?;
                let found = self.reader.find(node, &name)?;
                let device = found.device.to_smolstr();
                if word.operand == device && of_block {
                    // The block stored it there.
                    return Ok(());
                }
                let to = Word {
                    operand: device,
                    kind: Some(found.kind),
                };
                let wide = super::functions::wide(node, &[&word, &to])?;
                let mnemonic = if wide { "DMOV" } else { "MOV" };
                let line = format_smolstr!("{mnemonic} {} {}", word.operand, to.operand);
                self.reader.output(Logic::wire(), line);
            }
        }
        Ok(())
    }

    /// Returns true if the output of an element leads to another that uses it.
    fn leads_on(&self, node: Node) -> bool {
        let id = node.attribute("localId").unwrap_or_default();
        let continues = |name: Option<&str>| {
            let mut elements = self.by_id.values();
            elements.any(|n| n.tag_name().name() == "continuation" && n.attribute("name") == name)
        };
        let mut uses = self.uses.get(id).into_iter().flatten();
        uses.any(|(_, to)| match to.tag_name().name() {
            "rightPowerRail" => false,
            "connector" => continues(to.attribute("name")),
            _ => true,
        })
    }

    fn unconnected(&self, node: Node) -> Fault {
        let id = node.attribute("localId").unwrap_or("?");
        let what = format!("nothing leads to element {id}");
        Fault::at(node, what, "connect it to the left power rail")
    }

    /// Sources of a point's connections: element and output.
    fn sources(point: Node<'a, 'i>) -> Vec<(&'a str, &'a str)> {
        let connections = children(point, "connection");
        let source = |c: Node<'a, 'i>| {
            let output = c.attribute("formalParameter").unwrap_or_default();
            Some((c.attribute("refLocalId")?, output))
        };
        connections.filter_map(source).collect()
    }

    fn one_source(&self, point: Node<'a, 'i>) -> Option<(&'a str, &'a str)> {
        Self::sources(point).first().copied()
    }

    /// Logic at the input of an element of a ladder.
    pub(crate) fn flow_into(&mut self, node: Node<'a, 'i>) -> Result<Logic, Failure> {
        let points = children(node, "connectionPointIn");
        let from: Vec<_> = points.flat_map(Self::sources).collect();
        if from.is_empty() {
            return Err(Some(self.unconnected(node)));
        }
        let mut ways = Vec::new();
        for (id, output) in from {
            match self.value_of(id, output, node)? {
                Value::Flow(logic) => ways.push(logic),
                Value::Word(word) => {
                    let what = format!("`{}` is a number, not power", word.operand);
                    return Err(Some(Fault::at(node, what, "compare it with another")));
                }
            }
        }
        let joined = Logic::joined(ways);
        self.reader.count(node, &joined)?;
        Ok(joined)
    }

    /// Value at a point of an element.
    pub(crate) fn value_into(
        &mut self,
        point: Node<'a, 'i>,
        node: Node<'a, 'i>,
    ) -> Result<Value, Failure> {
        if let Some(expression) = children(point, "expression").next() {
            return self.expression(node, &text(expression));
        }
        match Self::sources(point).as_slice() {
            [] => Err(Some(self.unconnected(node))),
            [(id, output)] => self.value_of(id, output, node),
            sources => {
                let mut ways = Vec::new();
                for (id, output) in sources {
                    match self.value_of(id, output, node)? {
                        Value::Flow(logic) => ways.push(logic),
                        Value::Word(_) => {
                            let what = "two numbers meet on a wire";
                            return Err(Some(Fault::at(node, what, "connect one of them")));
                        }
                    }
                }
                Ok(Value::Flow(Logic::joined(ways)))
            }
        }
    }

    /// Value of an element's output, on the way to another.
    fn value_of(
        &mut self,
        id: &'a str,
        output: &'a str,
        to: Node<'a, 'i>,
    ) -> Result<Value, Failure> {
        if let Some(logic) = self.known.get(&(id, output)) {
            return Ok(Value::Flow(logic.clone()));
        }
        let missing = || {
            Fault::at(
                to,
                format!("there is no element {id}"),
                "draw the wire again",
            )
        };
        let node = *self.by_id.get(id).ok_or_else(missing)?;
        if self.on_it.contains(&id) {
            let what = format!("the way through element {id} returns to it");
            return Err(Some(Fault::at(to, what, "lead it over a variable")));
        }
        if self.on_it.len() > DEEPEST {
            let what = "the ways to this element are more than a network of a PLC holds";
            return Err(Some(Fault::at(to, what, "divide it by auxiliary relays")));
        }
        self.on_it.push(id);
        let value = self.out_of(node, id, output, to);
        self.on_it.pop();
        let value = value?;
        if let Value::Flow(logic) = &value {
            self.reader.count(to, logic)?;
            self.known.insert((id, output), logic.clone());
        }
        Ok(value)
    }

    fn out_of(
        &mut self,
        node: Node<'a, 'i>,
        id: &'a str,
        output: &'a str,
        to: Node<'a, 'i>,
    ) -> Result<Value, Failure> {
        match node.tag_name().name() {
            "leftPowerRail" => Ok(Value::Flow(Logic::wire())),
            "coil" => self.flow_into(node).map(Value::Flow),
            "contact" => {
                let before = self.flow_into(node)?;
                let contact = self.contact(node)?;
                Ok(Value::Flow(before.then(Logic::Contact(contact))))
            }
            "inVariable" | "inOutVariable" => {
                let written = children(node, "expression").map(text).collect::<String>();
                let modifiers = Modifiers::of(node, read_by(node), Accepted::Read)?;
                let value = self.expression(node, &written)?.modified(node, modifiers)?;
                Ok(match (value, modifiers.edge) {
                    (Value::Flow(logic), Some(edge)) => Value::Flow(logic.pulsed(edge)),
                    (value, _) => value,
                })
            }
            "continuation" => {
                let name = node.attribute("name").unwrap_or_default();
                let connector = self.connectors.get(name).copied();
                let point = connector.and_then(|c| children(c, "connectionPointIn").next());
                match point {
                    Some(point) => self.value_into(point, node),
                    None => Err(Some(Fault::outside(node, "draw its connector"))),
                }
            }
            "block" => {
                let outputs = self.block(id)?;
                let name = match output {
                    "" => first_output(node).to_uppercase(),
                    _ => output.to_uppercase(),
                };
                outputs.get(name.as_str()).cloned().ok_or_else(|| {
                    let what = format!("{} has no output `{output}` here", called(node));
                    Some(Fault::at(to, what, "connect another output"))
                })
            }
            name => {
                let what = format!("the way comes through `{name}`, which is not a contact");
                Err(Some(Fault::at(
                    to,
                    what,
                    "connect it to the left power rail",
                )))
            }
        }
    }

    /// The outputs of a block, which is read once.
    fn block(&mut self, id: &'a str) -> Result<BTreeMap<SmolStr, Value>, Failure> {
        if let Some(outputs) = self.done.get(id) {
            return Ok(outputs.clone());
        }
        if self.failed.contains(id) {
            return Err(None);
        }
        let Some(node) = self.by_id.get(id).copied() else {
            return Err(None);
        };
        let outputs = super::blocks::read(self, node);
        match outputs.and_then(|outputs| super::blocks::passed_on(node, outputs)) {
            Ok(outputs) => {
                self.done.insert(id, outputs.clone());
                Ok(outputs)
            }
            Err(failure) => {
                self.failed.insert(id);
                Err(failure)
            }
        }
    }

    fn contact(&mut self, node: Node<'a, 'i>) -> Result<Contact, Failure> {
        let modifiers = Modifiers::of(node, ONE_WAY, Accepted::Read)?;
        let sense = match (modifiers.edge, modifiers.negated) {
            (Some(edge), false) => Sense::from(edge),
            // The edge of the negated value is the other edge of the value.
            (Some(edge), true) => Sense::from(edge.opposite()),
            (None, true) => Sense::Off,
            (None, false) => Sense::On,
        };
        let name = variable_of(node).ok_or_else(|| {
            let help = "give the contact a variable";
            Fault::at(node, "the contact has no variable", help)
        })?;
        let device = self.reader.bit(node, &name)?;
        Ok(Contact {
            element: node.id().get(),
            sense,
            operands: device.to_smolstr(),
        })
    }

    /// A variable or a constant as a value.
    fn expression(&mut self, node: Node<'a, 'i>, written: &str) -> Result<Value, Failure> {
        let element = node.id().get();
        match written.trim().to_uppercase().as_str() {
            "TRUE" | "BOOL#1" | "BOOL#TRUE" => return Ok(Value::Flow(Logic::wire())),
            "FALSE" | "BOOL#0" | "BOOL#FALSE" => {
                return Ok(Value::Flow(Logic::contact(element, false, "M8000")));
            }
            _ => {}
        }
        if let Some(operand) = constant(written) {
            return Ok(Value::Word(Word {
                operand,
                kind: None,
            }));
        }
        if written.contains('.') && super::variables::addressed(written).is_none() {
            let device = self.reader.bit(node, written)?;
            return Ok(Value::Flow(Logic::contact(
                element,
                true,
                device.to_smolstr(),
            )));
        }
        let found = self.reader.find(node, written)?;
        let operand = found.device.to_smolstr();
        Ok(match found.kind {
            Kind::Bool => Value::Flow(Logic::contact(element, true, operand)),
            kind => Value::Word(Word {
                operand,
                kind: Some(kind),
            }),
        })
    }

    /// The register that a block's result goes to: that of the output variable at its output, or a free one.
    pub fn destination(
        &mut self,
        block: Node<'a, 'i>,
        output: &str,
        like: &Kind,
    ) -> Result<Word, Failure> {
        let uses = self.uses_of(block, output);
        let variable = uses
            .iter()
            .find(|node| node.tag_name().name() == "outVariable");
        if let Some(node) = variable {
            let name = children(*node, "expression").map(text).collect::<String>();
            let found = self.reader.find(*node, &name)?;
            return Ok(Word {
                operand: found.device.to_smolstr(),
                kind: Some(found.kind),
            });
        }
        if uses.is_empty() {
            let what = format!("the result of {} goes nowhere", called(block));
            return Err(Some(Fault::at(block, what, "connect it to a variable")));
        }
        self.register(block, output, like, 1)
    }

    /// Elements that an output of a block leads to.
    pub fn uses_of(&self, block: Node<'a, 'i>, output: &str) -> Vec<Node<'a, 'i>> {
        let id = block.attribute("localId").unwrap_or_default();
        let uses = self.uses.get(id).into_iter().flatten();
        let is_first = first_output(block).eq_ignore_ascii_case(output);
        let same = |name: &str| match name {
            "" => is_first,
            _ => name.eq_ignore_ascii_case(output),
        };
        uses.filter(|(name, _)| same(name))
            .map(|(_, node)| *node)
            .collect()
    }

    /// Free registers for this many results of this kind.
    pub fn register(
        &mut self,
        block: Node<'a, 'i>,
        output: &str,
        like: &Kind,
        results: u32,
    ) -> Result<Word, Failure> {
        let id = block.id().get();
        let count = results * if like.is_wide() { 2 } else { 1 };
        let variables = &mut self.reader.variables;
        let device = variables.part(&format!("{output}..{id}"), DeviceClass::D, count, |_| true);
        let device = device.ok_or_else(|| {
            let what = format!("{} needs a register for its result", called(block));
            Fault::at(block, what, super::FREE)
        })?;
        Ok(Word {
            operand: device.to_smolstr(),
            kind: Some(like.clone()),
        })
    }

    /// Marks a block that could not be read, which was reported.
    pub fn fail(&mut self, block: Node<'a, 'i>) {
        let id = block.attribute("localId").unwrap_or_default();
        self.failed.insert(id);
    }

    /// The constant or variable that is written at a point, or at the element that leads to it.
    pub fn written(&self, point: Node<'a, 'i>) -> Option<String> {
        if let Some(expression) = children(point, "expression").next() {
            return Some(text(expression));
        }
        let (id, _) = self.one_source(point)?;
        let node = self.by_id.get(id)?;
        let expression = children(*node, "expression").next()?;
        Modifiers::of(*node, read_by(*node), Accepted::None).ok()?;
        Some(text(expression))
    }

    /// Adds a network that nothing can follow.
    pub fn network(&mut self, logic: Logic, lines: Vec<SmolStr>) {
        self.reader.parts.push(Part::Output(Output {
            logic,
            lines,
            alone: true,
            bare: false,
        }));
    }
}

/// The output of a block that a connection means which names none: the first that is not ENO.
fn first_output<'a>(block: Node<'a, '_>) -> &'a str {
    let lists = children(block, "outputVariables");
    let pins = lists.flat_map(|list| children(list, "variable"));
    let mut names = pins.filter_map(|pin| pin.attribute("formalParameter"));
    names.find(|name| *name != "ENO").unwrap_or_default()
}

/// The attributes that change the value of a variable where it is read.
fn read_by(node: Node) -> [&'static str; 3] {
    match node.tag_name().name() {
        "inOutVariable" => OUT_OF,
        _ => ONE_WAY,
    }
}

/// The variable of a contact or coil.
fn variable_of(node: Node) -> Option<String> {
    let name = children(node, "variable").next().map(text)?;
    (!name.trim().is_empty()).then_some(name)
}
