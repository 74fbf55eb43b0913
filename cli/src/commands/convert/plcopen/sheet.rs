//! The networks of a program as elements of a ladder, with places and wires.

use super::xml::Xml;
use rungc_analysis::resolve::Resolved;
use rungc_catalogue::Basic;
use rungc_frontend::iec_timer_unit;
use rungc_ladder::{
    Contact, InstrIndex, Item, Ladder, NetworkBody, Node, Output, Part, Series, Shape,
};
use rungc_syntax::{Device, DeviceClass, Instr, OperandKind};
use std::collections::{BTreeMap, BTreeSet};

/// Distance of columns.
const COLUMN: i64 = 150;
/// Size of contacts and coils.
const SIZE: (i64, i64) = (30, 20);
/// Width of a block, and height of one of its pins.
const BLOCK: (i64, i64) = (100, 20);
/// Space between rows.
const GAP: i64 = 30;

/// Where power comes from: an element, its output and the place of that.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Source {
    id: u32,
    output: &'static str,
    x: i64,
    y: i64,
}

/// A ladder while it is drawn.
pub(super) struct Sheet<'a> {
    pub xml: Xml,
    /// Devices that elements name, and the types of their variables.
    pub variables: BTreeMap<Device, &'static str>,
    /// Instructions that no function or block of the standard stands for.
    pub instructions: BTreeSet<String>,
    resolved: &'a Resolved<'a>,
    /// Timers that are drawn as TON, with the milliseconds that they count to.
    timers: BTreeMap<Device, u64>,
    ids: u32,
    /// Where the next row begins.
    bottom: i64,
}

impl<'a> Sheet<'a> {
    pub fn new(resolved: &'a Resolved<'a>) -> Self {
        Sheet {
            xml: Xml::default(),
            variables: BTreeMap::new(),
            instructions: BTreeSet::new(),
            resolved,
            timers: timers(resolved),
            ids: 0,
            bottom: GAP,
        }
    }

    /// Draws all networks; gives the first that cannot be drawn, and why.
    pub fn draw(&mut self, ladder: &Ladder) -> Result<(), (InstrIndex, &'static str)> {
        for network in &ladder.networks {
            let first = network.instrs.start;
            let remarks = network
                .instrs
                .clone()
                .filter_map(|at| self.instr(at).statement());
            let remarks: Vec<_> = remarks.map(str::to_owned).collect();
            if !remarks.is_empty() {
                self.comment(&remarks.join("\n"));
            }
            for at in first..first + network.labels {
                self.label(at);
            }
            match &network.body {
                NetworkBody::List { why } => return Err((first, why)),
                NetworkBody::Rung(node) if node.items.is_empty() => {}
                NetworkBody::Rung(node) if self.is_end(node) => {}
                NetworkBody::Rung(node) => {
                    let rail = self.rail();
                    self.node(node, vec![rail], 1, rail.y - SIZE.1 / 2);
                }
            }
        }
        Ok(())
    }

    fn instr(&self, at: InstrIndex) -> &'a Instr {
        &self.resolved.program.instrs[at]
    }

    /// Whether a network is the END of the program, which a project does not have.
    fn is_end(&self, node: &Node) -> bool {
        let last = self.resolved.program.instrs.len() - 1;
        matches!(&node.items[..], [Item::Output(output)]
            if output.instr == last && self.instr(last).mnemonic == "END")
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
        let name = self.instr(at).mnemonic.clone();
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
                    let mnemonic = self.instr(*at).mnemonic.clone();
                    let pins = [(
                        if mnemonic == "INV" { "IN" } else { "EN" },
                        Pin::Power(from),
                    )];
                    let out = match mnemonic.as_str() {
                        "INV" => self.block("NOT", "", &pins, &["OUT"], column, y),
                        _ => self.special(&mnemonic, &pins, &["ENO"], column, y),
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
        let instr = self.instr(contact.instr);
        let negated = matches!(contact.shape, Shape::Closed).to_string();
        let edge = match contact.shape {
            Shape::Rising => "rising",
            Shape::Falling => "falling",
            Shape::Open | Shape::Closed | Shape::Compare => "none",
        };
        let plain = instr
            .operands
            .first()
            .and_then(|operand| operand.kind.device());
        let variable = plain.and_then(|device| self.bit(device));
        let (Some(variable), false) = (variable, contact.shape == Shape::Compare) else {
            return self.comparison(contact, from, column, y);
        };
        let attributes = [("negated", negated.as_str()), ("edge", edge)];
        let source = self.ladder_element("contact", &attributes, &from, &variable, column, y);
        (vec![source], column + 1)
    }

    /// A comparison, or a contact of something that is not a variable, after what leads to it.
    fn comparison(
        &mut self,
        contact: Contact,
        from: Vec<Source>,
        column: i64,
        y: i64,
    ) -> (Vec<Source>, i64) {
        let instr = self.instr(contact.instr);
        let standard = match sign(instr) {
            Some("=") => "EQ",
            Some("<>") => "NE",
            Some(">") => "GT",
            Some(">=") => "GE",
            Some("<") => "LT",
            Some("<=") => "LE",
            _ => "",
        };
        let words: Option<Vec<_>> = instr.operands.iter().map(|o| self.word(&o.kind)).collect();
        let closed = match (standard, words) {
            ("", _) | (_, None) => {
                let mut pins = Vec::new();
                for (operand, name) in instr.operands.iter().zip(OPERANDS) {
                    pins.push((name, Pin::Text(operand.kind.to_string())));
                }
                let name = match contact.shape {
                    Shape::Open => "LD",
                    Shape::Closed => "LDI",
                    Shape::Rising => "LDP",
                    Shape::Falling => "LDF",
                    Shape::Compare => how(instr),
                };
                self.special(name, &pins, &["OUT"], column, y)
            }
            (name, Some(words)) => {
                let pins = words.into_iter().zip(["IN1", "IN2"]);
                let pins: Vec<_> = pins.map(|(word, pin)| (pin, Pin::Text(word))).collect();
                self.block(name, "", &pins, &["OUT"], column, y)
            }
        };
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
        let instr = self.instr(output.instr);
        let plain = instr
            .operands
            .first()
            .and_then(|operand| operand.kind.device());
        let power = || Pin::Power(from.to_vec());
        let is_relay = |device: &Device| {
            matches!(
                device.class,
                DeviceClass::Y | DeviceClass::M | DeviceClass::S
            )
        };
        let relay = plain.filter(|_| instr.operands.len() == 1).filter(is_relay);
        let coil = match instr.mnemonic.as_str() {
            "OUT" => Some(("none", "none")),
            "SET" => Some(("set", "none")),
            "RST" => Some(("reset", "none")),
            "PLS" => Some(("none", "rising")),
            "PLF" => Some(("none", "falling")),
            _ => None,
        };
        if let (Some((storage, edge)), Some(device)) = (coil, relay)
            && let Some(variable) = self.bit(device)
        {
            let attributes = [("negated", "false"), ("storage", storage), ("edge", edge)];
            self.ladder_element("coil", &attributes, from, &variable, column, y);
            return;
        }
        let timer = plain.filter(|_| instr.mnemonic == "OUT");
        if let Some((timer, preset)) = timer.and_then(|t| Some((t, *self.timers.get(&t)?))) {
            self.variables.insert(timer, "TON");
            let pins = [("IN", power()), ("PT", Pin::Text(format!("T#{preset}ms")))];
            self.block("TON", &timer.to_string(), &pins, &["Q", "ET"], column, y);
            return;
        }
        if let ("CJ", Some(device)) = (instr.mnemonic.as_str(), plain) {
            self.jump(device, from, column, y);
            return;
        }
        let words: Option<Vec<_>> = instr.operands.iter().map(|o| self.word(&o.kind)).collect();
        let names: &[&'static str] = match instr.mnemonic.as_str() {
            "MOV" => &["IN"],
            "ADD" | "SUB" => &["IN1", "IN2"],
            _ => &[],
        };
        let last = instr
            .operands
            .last()
            .and_then(|operand| operand.kind.device());
        if let (Some(words), 1.., Some(to)) = (words, names.len(), last)
            && words.len() == names.len() + 1
        {
            let mut pins = vec![("EN", power())];
            pins.extend(names.iter().copied().zip(words.into_iter().map(Pin::Text)));
            let name = if instr.mnemonic == "MOV" {
                "MOVE"
            } else {
                &instr.mnemonic
            };
            let result = self.block(name, "", &pins, &["ENO", "OUT"], column, y);
            self.out_variable(to, result);
            return;
        }
        let mut pins = vec![("EN", power())];
        for (operand, name) in instr.operands.iter().zip(OPERANDS) {
            pins.push((name, Pin::Text(quoted(&operand.kind))));
        }
        self.special(&instr.mnemonic, &pins, &["ENO"], column, y);
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

    /// The name of the variable that a bit is.
    fn bit(&mut self, device: Device) -> Option<String> {
        use DeviceClass::{C, M, S, T, X, Y};
        if self.timers.contains_key(&device) {
            self.variables.insert(device, "TON");
            return Some(format!("{device}.Q"));
        }
        if !matches!(device.class, X | Y | M | S | T | C) {
            return None;
        }
        self.variables.entry(device).or_insert("BOOL");
        Some(device.to_string())
    }

    /// A number as the standard writes it; `None` if it is neither a register nor a constant of 16 bits.
    fn word(&mut self, operand: &OperandKind) -> Option<String> {
        match *operand {
            OperandKind::Device(device, None) if device.class == DeviceClass::D => {
                self.variables.insert(device, "INT");
                Some(device.to_string())
            }
            OperandKind::Decimal(value, None) if i16::try_from(value).is_ok() => {
                Some(value.to_string())
            }
            OperandKind::Hex(value, None) if value <= 0xffff => Some(format!("16#{value:X}")),
            _ => None,
        }
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
        self.instructions.insert(mnemonic.to_owned());
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

/// What leads to a pin of a block.
enum Pin {
    Power(Vec<Source>),
    Text(String),
}

/// The names of an instruction's operands as pins.
const OPERANDS: [&str; 16] = [
    "p1", "p2", "p3", "p4", "p5", "p6", "p7", "p8", "p9", "p10", "p11", "p12", "p13", "p14", "p15",
    "p16",
];

/// An operand as a list writes it.
fn quoted(operand: &OperandKind) -> String {
    match operand {
        OperandKind::Text(text) => format!("\"{}\"", text.replace('"', "\"\"")),
        other => other.to_string(),
    }
}

/// What a comparison's mnemonic ends with: `=`, `D>=`.
fn how(instr: &Instr) -> &str {
    let mnemonic = instr.mnemonic.as_str();
    let joins = ["LD", "AND", "OR"].into_iter();
    joins
        .filter_map(|join| mnemonic.strip_prefix(join))
        .next()
        .unwrap_or(mnemonic)
}

/// The sign of a comparison of 16 bits.
fn sign(instr: &Instr) -> Option<&str> {
    let how = how(instr);
    how.starts_with(['=', '<', '>']).then_some(how)
}

/// The timers that a TON stands for: driven once, by a constant, and of the same unit on all models.
fn timers(resolved: &Resolved) -> BTreeMap<Device, u64> {
    let mut found: BTreeMap<Device, Option<u64>> = BTreeMap::new();
    let instrs = resolved.program.instrs.iter().zip(&resolved.instrs);
    for (instr, resolution) in instrs {
        let operands = &instr.operands;
        let device = operands.first().and_then(|operand| operand.kind.device());
        let timer = device.filter(|device| device.class == DeviceClass::T);
        let (Some(timer), Some(Basic::Out)) = (timer, resolution.basic()) else {
            continue;
        };
        let count = operands.get(1).and_then(|preset| match preset.kind {
            OperandKind::Decimal(count, None) => u64::try_from(count).ok().filter(|n| *n > 0),
            _ => None,
        });
        let runs = resolved.model.timers.iter();
        let kind = runs.filter(|run| (run.first..=run.last).contains(&timer.number));
        let unit = kind.map(|run| u64::from(run.kind.unit_ms)).next();
        let same = unit.filter(|unit| iec_timer_unit(timer.number) == Some(*unit));
        let preset = same.and_then(|unit| Some(unit * count?));
        let entry = found.entry(timer);
        entry.and_modify(|preset| *preset = None).or_insert(preset);
    }
    found
        .into_iter()
        .filter_map(|(timer, preset)| Some((timer, preset?)))
        .collect()
}

fn position(xml: &mut Xml, x: i64, y: i64) {
    let (x, y) = (x.to_string(), y.to_string());
    xml.leaf("position", &[("x", &x), ("y", &y)]);
}

fn relative(xml: &mut Xml, x: i64, y: i64) {
    let (x, y) = (x.to_string(), y.to_string());
    xml.leaf("relPosition", &[("x", &x), ("y", &y)]);
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
