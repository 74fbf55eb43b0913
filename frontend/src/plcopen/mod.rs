//! PLCopen XML (TC6 2.01), which editors of IEC 61131-3 exchange programs by: ladders of contacts and coils, and
//! instruction lists.
//!
//! A variable is a device by its address (`%IX0.3` is X003) or by a name that is itself one. What else a program
//! contains is an error with the element and its line.

mod logic;

use crate::Read;
use crate::il;
use crate::listing::Listing;
use logic::{Logic, Sense};
use roxmltree::{Document, Node};
use rungc_syntax::{Device, DeviceClass, Diagnostics, OperandKind, SourceKind, codes};
use smol_str::{SmolStr, ToSmolStr, format_smolstr};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What the namespace of a project begins with.
const NAMESPACE: &str = "http://www.plcopen.org/xml/tc6";
/// How far into a text its namespace is, at most.
const HEAD: usize = 4096;
/// The most elements on all ways to a coil: drawings that share ways grow when they become a list.
const MOST_ELEMENTS: usize = 2000;
/// The most elements on one way.
const DEEPEST: usize = 200;

/// Whether a text is a project of this form.
pub(crate) fn is_project(text: &str) -> bool {
    let head = text.trim_start_matches('\u{FEFF}').trim_start();
    let mut end = head.len().min(HEAD);
    while !head.is_char_boundary(end) {
        end -= 1;
    }
    head.starts_with('<') && head[..end].contains(NAMESPACE)
}

/// A table of variables and their devices: rows of a name and a device, separated by a comma or a tab.
///
/// # Errors
/// The first row that is not of this form.
pub fn names(table: &str) -> Result<BTreeMap<String, Device>, String> {
    let lines = table.trim_start_matches('\u{FEFF}').lines();
    let rows = lines.filter(|line| !line.trim().is_empty());
    let row = |line: &str| {
        let (name, written) = line.split_once([',', '\t'])?;
        let plain = |field: &str| field.trim().trim_matches('"').trim().to_uppercase();
        Some((plain(name), device(&plain(written))?))
    };
    rows.map(|line| row(line).ok_or_else(|| line.to_owned()))
        .collect()
}

/// Reads a project; `named` are the devices of variables by their names in upper case.
pub(crate) fn read(name: &str, text: &str, named: &BTreeMap<String, Device>) -> Read {
    let mut reader = Reader {
        variables: named.clone(),
        ..Reader::default()
    };
    match Document::parse(text.trim_start_matches('\u{FEFF}')) {
        Ok(document) => reader.project(&document),
        Err(error) => reader.faults.push((
            &codes::PLCOPEN_SYNTAX,
            format!("the project is not well-formed XML: {error}"),
            "export the project again",
        )),
    }
    reader.finish(name)
}

/// Something that has no counterpart: what is wrong, and what helps.
type Fault = (&'static codes::Code, String, &'static str);

#[derive(Default)]
struct Reader {
    list: String,
    title: Option<String>,
    comments: BTreeMap<Device, String>,
    /// The devices of variables, by their names in upper case.
    variables: BTreeMap<String, Device>,
    faults: Vec<Fault>,
}

/// The children of a node that are called so.
fn children<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
        .filter(move |child| child.tag_name().name() == name)
}

/// The descendants of a node that are called so.
fn all<'a, 'i: 'a>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.descendants()
        .filter(move |child| child.tag_name().name() == name)
}

/// The line that a node begins on.
fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// All text in a node.
fn text(node: Node) -> String {
    node.descendants()
        .filter_map(|n| n.text().filter(|_| n.is_text()))
        .collect()
}

impl Reader {
    fn project(&mut self, document: &Document) {
        let root = document.root_element();
        let header = children(root, "contentHeader").next();
        self.title = header.and_then(|h| h.attribute("name")).map(str::to_owned);
        for variable in all(root, "variable").filter(|v| v.attribute("name").is_some()) {
            self.variable(variable);
        }
        let programs = all(root, "pou").filter(|pou| pou.attribute("pouType") == Some("program"));
        let programs: Vec<_> = programs.collect();
        if programs.is_empty() {
            let what = "the project has no program".to_owned();
            self.faults.push((
                &codes::PLCOPEN_ELEMENT,
                what,
                "functions and function blocks alone do not run",
            ));
        }
        for pou in programs {
            for body in children(pou, "body")
                .flat_map(|body| body.children())
                .filter(Node::is_element)
            {
                match body.tag_name().name() {
                    "LD" => self.ladder(body),
                    "IL" => self.instruction_list(body),
                    "documentation" | "addData" => {}
                    _ => self.outside(body, "write it as LD or IL, or compile it in its editor"),
                }
            }
        }
        self.list.push_str("END\n");
    }

    /// Reports an element that has no counterpart.
    fn outside(&mut self, node: Node, help: &'static str) {
        let named = ["typeName", "name", "label", "instanceName"];
        let named = named.into_iter().find_map(|key| node.attribute(key));
        let named = named.map_or_else(String::new, |name| format!(" `{name}`"));
        let what = format!(
            "line {}: element `{}`{named} has no counterpart in an FX program",
            line(node),
            node.tag_name().name()
        );
        self.faults.push((&codes::PLCOPEN_ELEMENT, what, help));
    }

    /// Takes a declaration.
    fn variable(&mut self, node: Node) {
        let name = node.attribute("name").unwrap_or_default();
        let named = self.variables.get(&name.to_uppercase()).copied();
        let device = match node.attribute("address") {
            _ if named.is_some() => named,
            Some(address) => addressed(address),
            None => device(name),
        };
        let Some(device) = device else {
            if let Some(address) = node.attribute("address") {
                let what = format!(
                    "line {}: the address `{address}` of `{name}` is not that of a device",
                    line(node)
                );
                self.faults
                    .push((&codes::PLCOPEN_VARIABLE, what, ADDRESSES));
            }
            return;
        };
        let documentation = children(node, "documentation").next().map(text);
        let documentation = documentation.and_then(|text| crate::text::clean(&text));
        let comment = documentation.unwrap_or_else(|| name.into());
        self.comments
            .entry(device)
            .or_insert_with(|| comment.to_string());
        self.variables.insert(name.to_uppercase(), device);
    }

    /// How an operand is written in a list.
    fn operand(&mut self, node: Node, name: &str) -> SmolStr {
        let name = name.trim();
        let known = self.variables.get(&name.to_uppercase()).copied();
        let found = known.or_else(|| addressed(name)).or_else(|| device(name));
        if let Some(device) = found {
            return device.to_smolstr();
        }
        if let Ok(number) = name.parse::<i32>() {
            return format_smolstr!("K{number}");
        }
        let what = format!("line {}: the variable `{name}` is not a device", line(node));
        let known = self
            .faults
            .iter()
            .any(|(_, fault, _)| fault.ends_with(&format!("`{name}` is not a device")));
        if !known {
            self.faults
                .push((&codes::PLCOPEN_VARIABLE, what, ADDRESSES));
        }
        "M0".into()
    }

    /// Reads a drawing: each coil from the top down, with what leads to it.
    fn ladder(&mut self, body: Node) {
        let elements = body.children().filter(Node::is_element);
        let by_id: BTreeMap<_, _> = elements
            .clone()
            .filter_map(|node| Some((node.attribute("localId")?, node)))
            .collect();
        for node in elements {
            match node.tag_name().name() {
                "leftPowerRail" | "rightPowerRail" | "contact" | "coil" | "comment" => {}
                _ => self.outside(node, "only contacts and coils of a ladder are read"),
            }
        }
        let place = |node: &Node| {
            let position = children(*node, "position").next();
            let number = |key| position.and_then(|p| p.attribute(key)?.parse::<f64>().ok());
            (number("y").unwrap_or(0.0), number("x").unwrap_or(0.0))
        };
        let mut coils: Vec<_> = by_id
            .values()
            .filter(|node| node.tag_name().name() == "coil")
            .collect();
        coils.sort_by(|a, b| {
            place(a)
                .partial_cmp(&place(b))
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        let mut last = None;
        for coil in coils {
            let mut way = Way {
                by_id: &by_id,
                on_it: Vec::new(),
                elements: 0,
            };
            let logic = match way.to(*coil, self) {
                Ok(logic) => logic,
                Err(why) => {
                    let what = format!("line {}: {why}", line(*coil));
                    self.faults.push((
                        &codes::PLCOPEN_ELEMENT,
                        what,
                        "connect the coil to the left power rail",
                    ));
                    continue;
                }
            };
            let inverted = coil.attribute("negated") == Some("true");
            if inverted || last.as_ref() != Some(&logic) {
                for instruction in logic.instructions() {
                    let _ = writeln!(self.list, "{instruction}");
                }
            }
            last = (!inverted).then_some(logic);
            self.coil(*coil, inverted);
        }
    }

    fn coil(&mut self, coil: Node, inverted: bool) {
        let mnemonic = match (coil.attribute("storage"), coil.attribute("edge")) {
            (Some("set"), _) => "SET",
            (Some("reset"), _) => "RST",
            (_, Some("rising")) => "PLS",
            (_, Some("falling")) => "PLF",
            _ => "OUT",
        };
        if inverted {
            self.list.push_str("INV\n");
        }
        let operand = variable_of(coil).map(|name| self.operand(coil, &name));
        match operand {
            Some(device) => _ = writeln!(self.list, "{mnemonic} {device}"),
            None => self.outside(coil, "give the coil a variable"),
        }
    }

    /// Reads a list: the operators of IEC 61131-3 that an FX list has under another name.
    fn instruction_list(&mut self, body: Node) {
        for written in text(body).lines() {
            let code = written.split("(*").next().unwrap_or_default().trim();
            if code.is_empty() {
                continue;
            }
            let (operator, operand) = code.split_once(char::is_whitespace).unwrap_or((code, ""));
            let mnemonic = match operator.to_ascii_uppercase().as_str() {
                "LD" => "LD",
                "LDN" => "LDI",
                "AND" | "&" => "AND",
                "ANDN" | "&N" => "ANI",
                "OR" => "OR",
                "ORN" => "ORI",
                "ST" => "OUT",
                "S" => "SET",
                "R" => "RST",
                "NOT" => "INV",
                _ => {
                    let what = format!(
                        "line {}: `{code}` has no counterpart in an FX list",
                        line(body)
                    );
                    let help = "LD, AND, OR with or without N, NOT, ST, S and R are read";
                    self.faults.push((&codes::PLCOPEN_ELEMENT, what, help));
                    continue;
                }
            };
            let operand = match operand.trim() {
                "" => SmolStr::default(),
                name => self.operand(body, name),
            };
            let _ = writeln!(self.list, "{}", format!("{mnemonic} {operand}").trim_end());
        }
    }

    fn finish(self, name: &str) -> Read {
        let mut read = il::read_text(name, &self.list);
        read.program.kind = SourceKind::Plcopen;
        read.program.title = self.title.filter(|title| !title.trim().is_empty());
        read.program.comments = self.comments;
        if self.faults.is_empty() {
            return read;
        }
        // A list with gaps would mislead: what is quoted is the elements that make them.
        let mut listing = Listing::default();
        let mut diagnostics = Diagnostics::new();
        for (code, what, help) in self.faults {
            listing.next_line();
            let span = listing.word(&format!("?? {what}"));
            diagnostics.push(code.at(span, what).label("in the project").help(help));
        }
        read.program.source = listing.finish(name);
        read.program.instrs.clear();
        read.program.unread = vec![0];
        read.diagnostics = diagnostics;
        read
    }
}

/// Which addresses and names mean devices.
const ADDRESSES: &str = "name its device in a table for `--names`, or give it an address: `%IX0.0` is X000, `%QX0.0` Y000, \
                         `%MX0.0` M0, `%MW0` D0";

/// The device that a name is, such as `X010`.
fn device(name: &str) -> Option<Device> {
    let mut faults = Diagnostics::new();
    match il::field::operand(name, 0, false, &mut faults)?.kind {
        OperandKind::Device(device, None) if faults.is_empty() => Some(device),
        _ => None,
    }
}

/// The device at an IEC address: bits by byte and bit, words by their numbers.
fn addressed(address: &str) -> Option<Device> {
    use DeviceClass::{D, M, X, Y};
    let address = address.trim().strip_prefix('%')?.to_ascii_uppercase();
    let (place, rest) = address.split_at_checked(2)?;
    let class = match place {
        "IX" => X,
        "QX" => Y,
        "MX" => M,
        "MW" => D,
        _ => return None,
    };
    let number = match rest.split_once('.') {
        Some((byte, bit)) if class != D => {
            let bit = bit.parse::<u32>().ok().filter(|bit| *bit < 8)?;
            byte.parse::<u32>().ok()?.checked_mul(8)?.checked_add(bit)?
        }
        Some(_) => return None,
        None => rest.parse().ok()?,
    };
    Some(Device { class, number })
}

/// The variable of a contact or coil.
fn variable_of(node: Node) -> Option<String> {
    let name = children(node, "variable").next().map(text)?;
    (!name.trim().is_empty()).then_some(name)
}

/// The way back from an element to the left power rail.
struct Way<'a, 'i> {
    by_id: &'a BTreeMap<&'a str, Node<'a, 'i>>,
    /// The elements that it has come through.
    on_it: Vec<&'a str>,
    /// How many elements it has come through on all ways.
    elements: usize,
}

impl<'a, 'i> Way<'a, 'i> {
    /// What leads to an element.
    fn to(&mut self, node: Node<'a, 'i>, reader: &mut Reader) -> Result<Logic, String> {
        let connections =
            children(node, "connectionPointIn").flat_map(|point| children(point, "connection"));
        let from: Vec<_> = connections
            .filter_map(|c| c.attribute("refLocalId"))
            .collect();
        if from.is_empty() {
            return Err(format!(
                "nothing leads to element {}",
                node.attribute("localId").unwrap_or("?")
            ));
        }
        let mut ways = Vec::new();
        for id in from {
            ways.push(self.through(id, reader)?);
        }
        Ok(Logic::joined(ways))
    }

    /// What leads to the output of an element.
    fn through(&mut self, id: &'a str, reader: &mut Reader) -> Result<Logic, String> {
        let node = *self
            .by_id
            .get(id)
            .ok_or_else(|| format!("there is no element {id}"))?;
        if self.on_it.contains(&id) {
            return Err(format!("the way through element {id} returns to it"));
        }
        let name = node.tag_name().name();
        match name {
            "leftPowerRail" => return Ok(Logic::wire()),
            "contact" | "coil" => {}
            _ => {
                return Err(format!(
                    "the way comes through `{name}`, which is not a contact"
                ));
            }
        }
        self.elements += 1;
        if self.elements > MOST_ELEMENTS || self.on_it.len() > DEEPEST {
            return Err("the ways to this coil are more than a network of a PLC holds".to_owned());
        }
        self.on_it.push(id);
        let before = self.to(node, reader);
        self.on_it.pop();
        let before = before?;
        if name == "coil" {
            return Ok(before);
        }
        let sense = match (node.attribute("edge"), node.attribute("negated")) {
            (Some("rising"), _) => Sense::Rising,
            (Some("falling"), _) => Sense::Falling,
            (_, Some("true")) => Sense::Off,
            _ => Sense::On,
        };
        let name = variable_of(node)
            .ok_or_else(|| format!("the contact on line {} has no variable", line(node)))?;
        let device = reader.operand(node, &name);
        Ok(before.then(Logic::Contact(sense, device)))
    }
}
