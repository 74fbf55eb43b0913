//! The networks of a program as elements of a ladder, with places and wires.

use super::Refused;
use super::words::{Drive, Gate, Words};
use super::xml::{Xml, position, relative};
use rungc_catalogue::Basic;
use rungc_ladder::{Contact, InstrIndex, Item, Ladder, NetworkBody, Node, Output, Part, Series};
use rungc_syntax::Device;

/// Distance of columns.
const COLUMN: i64 = 150;
/// Size of contacts and coils.
const SIZE: (i64, i64) = (30, 20);
/// Width of a block, and height of one of its pins.
const BLOCK: (i64, i64) = (100, 20);
/// Space between rows.
const GAP: i64 = 30;

/// Source of power: an element, its output and the output's position.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Source {
    id: u32,
    output: &'static str,
    x: i64,
    y: i64,
}

/// A ladder while it is drawn.
pub(super) struct Sheet<'s, 'a> {
    pub xml: Xml,
    words: &'s mut Words<'a>,
    ids: u32,
    /// Top of the next row.
    bottom: i64,
}

impl<'s, 'a> Sheet<'s, 'a> {
    pub fn new(words: &'s mut Words<'a>) -> Self {
        Sheet {
            xml: Xml::default(),
            words,
            ids: 0,
            bottom: GAP,
        }
    }

    /// Draws all networks; gives the first that cannot be drawn.
    pub fn draw(&mut self, ladder: &Ladder) -> Result<(), Refused> {
        for network in &ladder.networks {
            let first = network.instrs.start;
            let remarks = self.words.remarks(network.instrs.clone());
            if !remarks.is_empty() {
                self.comment(&remarks.join("\n"));
            }
            for at in first..first + network.labels {
                self.label(at);
            }
            match &network.body {
                NetworkBody::List { why } => return Err(Refused::network(first, why)),
                NetworkBody::Rung(node) if node.items.is_empty() => {}
                NetworkBody::Rung(node) if self.words.is_end(node) => {}
                NetworkBody::Rung(node) => {
                    let rail = self.rail();
                    self.node(node, vec![rail], 1, rail.y - SIZE.1 / 2);
                }
            }
        }
        let closing = self.words.closing(ladder);
        if !closing.is_empty() {
            self.comment(&closing.join("\n"));
        }
        Ok(())
    }

    fn id(&mut self) -> u32 {
        self.ids += 1;
        self.ids
    }

    /// A row below all others; its place.
    fn row(&mut self) -> i64 {
        let y = self.bottom;
        self.bottom += SIZE.1 + GAP;
        y
    }

    fn comment(&mut self, text: &str) {
        let (id, y) = (self.id().to_string(), self.row());
        let attributes = [("localId", id.as_str()), ("height", "20"), ("width", "400")];
        self.xml.node("comment", &attributes, |xml| {
            position(xml, GAP, y);
            xml.prose("content", text);
        });
    }

    /// A label; one of an interrupt is an instruction.
    fn label(&mut self, at: InstrIndex) {
        let name = self.words.instr(at).mnemonic.clone();
        if !name.starts_with('P') {
            let rail = self.rail();
            self.block(
                &format!("FX_{name}"),
                "",
                &[("EN", Pin::Power(vec![rail]))],
                &["ENO"],
                1,
                rail.y,
            );
            return;
        }
        let (id, y) = (self.id().to_string(), self.row());
        let attributes = [("localId", id.as_str()), ("label", &name)];
        self.xml
            .node("label", &attributes, |xml| position(xml, GAP, y));
    }

    fn rail(&mut self) -> Source {
        let (id, y) = (self.id(), self.row());
        let text = id.to_string();
        let attributes = [
            ("localId", text.as_str()),
            ("height", "20"),
            ("width", "10"),
        ];
        self.xml.node("leftPowerRail", &attributes, |xml| {
            position(xml, GAP, y);
            xml.node("connectionPointOut", &[("formalParameter", "")], |xml| {
                relative(xml, 10, SIZE.1 / 2);
            });
        });
        Source {
            id,
            output: "",
            x: GAP + 10,
            y: y + SIZE.1 / 2,
        }
    }

    /// Contacts and what they feed.
    fn node(&mut self, node: &Node, from: Vec<Source>, column: i64, y: i64) {
        let (from, column) = self.series(&node.series, from, column, y);
        let mut first = Some(y);
        for item in &node.items {
            match item {
                Item::Output(output) => {
                    let y = first.take().unwrap_or_else(|| self.row());
                    self.output(*output, &from, column, y);
                }
                Item::Stack(branches) => {
                    for branch in branches {
                        let y = first.take().unwrap_or_else(|| self.row());
                        self.node(branch, from.clone(), column, y);
                    }
                }
                Item::Continue(node) => {
                    let y = first.take().unwrap_or_else(|| self.row());
                    self.node(node, from.clone(), column, y);
                }
            }
        }
    }

    fn series(
        &mut self,
        series: &Series,
        mut from: Vec<Source>,
        mut column: i64,
        y: i64,
    ) -> (Vec<Source>, i64) {
        for part in series {
            match part {
                Part::Contact(contact) => {
                    (from, column) = self.contact(*contact, from, column, y);
                }
                Part::Result(at) => {
                    let out = if self.words.basic(*at) == Some(Basic::Inv) {
                        let pins = [("IN", Pin::Power(from))];
                        self.block("NOT", "", &pins, &["OUT"], column, y)
                    } else {
                        let pins = [("EN", Pin::Power(from))];
                        let mnemonic = self.words.special(&self.words.instr(*at).mnemonic);
                        self.special(&mnemonic, &pins, &["ENO"], column, y)
                    };
                    (from, column) = (vec![out], column + 1);
                }
                Part::Parallel(branches) => {
                    let mut ends = Vec::new();
                    let mut furthest = column;
                    let mut first = Some(y);
                    for branch in branches {
                        let y = first.take().unwrap_or_else(|| self.row());
                        let (end, column) = self.series(&branch.series, from.clone(), column, y);
                        ends.extend(end);
                        furthest = furthest.max(column);
                    }
                    (from, column) = (ends, furthest);
                }
                Part::Group(parts) => (from, column) = self.series(parts, from, column, y),
            }
        }
        (from, column)
    }

    fn contact(
        &mut self,
        contact: Contact,
        from: Vec<Source>,
        column: i64,
        y: i64,
    ) -> (Vec<Source>, i64) {
        let closed = match self.words.contact(contact) {
            Gate::Contact {
                variable,
                negated,
                edge,
            } => {
                let negated = negated.to_string();
                let attributes = [("negated", negated.as_str()), ("edge", edge)];
                let source =
                    self.ladder_element("contact", &attributes, &from, &variable, column, y);
                return (vec![source], column + 1);
            }
            Gate::Compare { function, words } => {
                let pins = words.into_iter().zip(["IN1", "IN2"]);
                let pins: Vec<_> = pins.map(|(word, pin)| (pin, Pin::Text(word))).collect();
                self.block(function, "", &pins, &["OUT"], column, y)
            }
            Gate::Special { mnemonic, operands } => {
                self.special(&mnemonic, &named(operands), &["OUT"], column, y)
            }
        };
        // The logic before a comparison is an input of AND.
        let is_rail =
            matches!(&from[..], [source] if source.output.is_empty() && source.x < COLUMN);
        if is_rail {
            return (vec![closed], column + 1);
        }
        let pins = [("IN1", Pin::Power(from)), ("IN2", Pin::Power(vec![closed]))];
        let both = self.block("AND", "", &pins, &["OUT"], column + 1, y);
        (vec![both], column + 2)
    }

    /// A coil, or an instruction as a block.
    fn output(&mut self, output: Output, from: &[Source], column: i64, y: i64) {
        let power = || Pin::Power(from.to_vec());
        match self.words.output(output) {
            Drive::Coil {
                variable,
                storage,
                edge,
            } => {
                let attributes = [("negated", "false"), ("storage", storage), ("edge", edge)];
                self.ladder_element("coil", &attributes, from, &variable, column, y);
            }
            Drive::Timer { timer, preset } => {
                let pins = [("IN", power()), ("PT", Pin::Text(format!("T#{preset}ms")))];
                self.block("TON", &timer.to_string(), &pins, &["Q", "ET"], column, y);
            }
            Drive::Jump(to) => self.jump(to, from, column, y),
            Drive::Compute {
                function,
                words,
                to,
            } => {
                let names: &[&str] = match words.len() {
                    1 => &["IN"],
                    _ => &["IN1", "IN2"],
                };
                let mut pins = vec![("EN", power())];
                pins.extend(names.iter().copied().zip(words.into_iter().map(Pin::Text)));
                let result = self.block(function, "", &pins, &["ENO", "OUT"], column, y);
                self.out_variable(to, result);
            }
            Drive::Special { mnemonic, operands } => {
                let mut pins = vec![("EN", power())];
                pins.extend(named(operands));
                self.special(&mnemonic, &pins, &["ENO"], column, y);
            }
        }
    }

    fn jump(&mut self, to: Device, from: &[Source], column: i64, y: i64) {
        let id = self.id().to_string();
        let label = to.to_string();
        let attributes = [("localId", id.as_str()), ("label", &label)];
        let x = column * COLUMN;
        self.xml.node("jump", &attributes, |xml| {
            position(xml, x, y);
            connections(xml, from, x, y + SIZE.1 / 2, (0, SIZE.1 / 2));
        });
    }

    /// A contact or coil; where power leaves it.
    fn ladder_element(
        &mut self,
        kind: &'static str,
        attributes: &[(&'static str, &str)],
        from: &[Source],
        variable: &str,
        column: i64,
        y: i64,
    ) -> Source {
        let id = self.id();
        let text = id.to_string();
        let mut all = vec![
            ("localId", text.as_str()),
            ("height", "20"),
            ("width", "30"),
        ];
        all.extend(attributes);
        let x = column * COLUMN;
        let middle = SIZE.1 / 2;
        self.xml.node(kind, &all, |xml| {
            position(xml, x, y);
            connections(xml, from, x, y + middle, (0, middle));
            xml.node("connectionPointOut", &[], |xml| {
                relative(xml, SIZE.0, middle)
            });
            xml.text("variable", variable);
        });
        Source {
            id,
            output: "",
            x: x + SIZE.0,
            y: y + middle,
        }
    }

    /// A block that is an instruction.
    fn special(
        &mut self,
        mnemonic: &str,
        pins: &[(&'static str, Pin)],
        outputs: &[&'static str],
        column: i64,
        y: i64,
    ) -> Source {
        self.block(&format!("FX_{mnemonic}"), "", pins, outputs, column, y)
    }

    /// A block with what leads to its inputs; where power leaves its last output.
    fn block(
        &mut self,
        kind: &str,
        instance: &str,
        pins: &[(&'static str, Pin)],
        outputs: &[&'static str],
        column: i64,
        y: i64,
    ) -> Source {
        let x = column * COLUMN;
        let height = BLOCK.1 * (pins.len().max(outputs.len()) as i64 + 1);
        self.bottom = self.bottom.max(y + height + GAP);
        let at = |pin: usize| y + BLOCK.1 * (pin as i64 + 1);
        let mut inputs = Vec::new();
        for (nth, (name, pin)) in pins.iter().enumerate() {
            let sources = match pin {
                Pin::Power(sources) => sources.clone(),
                Pin::Text(text) => vec![self.in_variable(text, x, at(nth))],
            };
            inputs.push((*name, sources));
        }
        let id = self.id();
        let (text, height) = (id.to_string(), height.to_string());
        let width = BLOCK.0.to_string();
        let mut all = vec![
            ("localId", text.as_str()),
            ("width", &width),
            ("height", &height),
        ];
        all.push(("typeName", kind));
        if !instance.is_empty() {
            all.push(("instanceName", instance));
        }
        self.xml.node("block", &all, |xml| {
            position(xml, x, y);
            xml.node("inputVariables", &[], |xml| {
                for (nth, (name, sources)) in inputs.iter().enumerate() {
                    xml.node("variable", &[("formalParameter", name)], |xml| {
                        connections(xml, sources, x, at(nth), (0, at(nth) - y));
                    });
                }
            });
            xml.leaf("inOutVariables", &[]);
            xml.node("outputVariables", &[], |xml| {
                for (nth, name) in outputs.iter().enumerate() {
                    xml.node("variable", &[("formalParameter", name)], |xml| {
                        xml.node("connectionPointOut", &[], |xml| {
                            relative(xml, BLOCK.0, at(nth) - y);
                        });
                    });
                }
            });
        });
        let last = outputs.len() - 1;
        Source {
            id,
            output: outputs[last],
            x: x + BLOCK.0,
            y: at(last),
        }
    }

    /// A constant, a register or an operand before a pin.
    fn in_variable(&mut self, written: &str, x: i64, y: i64) -> Source {
        let id = self.id();
        let text = id.to_string();
        let attributes = [
            ("localId", text.as_str()),
            ("height", "20"),
            ("width", "60"),
        ];
        let (x, y) = (x - 80, y - SIZE.1 / 2);
        self.xml.node("inVariable", &attributes, |xml| {
            position(xml, x, y);
            xml.node("connectionPointOut", &[], |xml| {
                relative(xml, 60, SIZE.1 / 2)
            });
            xml.text("expression", written);
        });
        Source {
            id,
            output: "",
            x: x + 60,
            y: y + SIZE.1 / 2,
        }
    }

    fn out_variable(&mut self, to: Device, from: Source) {
        let id = self.id().to_string();
        let attributes = [("localId", id.as_str()), ("height", "20"), ("width", "60")];
        let (x, y) = (from.x + 20, from.y - SIZE.1 / 2);
        self.xml.node("outVariable", &attributes, |xml| {
            position(xml, x, y);
            connections(xml, &[from], x, from.y, (0, SIZE.1 / 2));
            xml.text("expression", &to.to_string());
        });
    }
}

/// Connection of a block's pin.
enum Pin {
    Power(Vec<Source>),
    Text(String),
}

/// The names of an instruction's operands as pins.
const OPERANDS: [&str; 16] = [
    "p1", "p2", "p3", "p4", "p5", "p6", "p7", "p8", "p9", "p10", "p11", "p12", "p13", "p14", "p15",
    "p16",
];

/// Operands at pins that are named after their places.
fn named(operands: Vec<String>) -> Vec<(&'static str, Pin)> {
    let texts = operands.into_iter().map(Pin::Text);
    OPERANDS.into_iter().zip(texts).collect()
}

/// An input with its wires, from the input back to each source.
fn connections(xml: &mut Xml, from: &[Source], x: i64, y: i64, inside: (i64, i64)) {
    xml.node("connectionPointIn", &[], |xml| {
        relative(xml, inside.0, inside.1);
        for source in from {
            let id = source.id.to_string();
            let mut attributes = vec![("refLocalId", id.as_str())];
            if !source.output.is_empty() {
                attributes.push(("formalParameter", source.output));
            }
            xml.node("connection", &attributes, |xml| {
                position(xml, x, y);
                if y != source.y {
                    position(xml, x - 10, y);
                    position(xml, x - 10, source.y);
                }
                position(xml, source.x, source.y);
            });
        }
    });
}
