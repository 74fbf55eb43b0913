//! PLCopen XML (TC6 2.01), which editors of IEC 61131-3 exchange programs by: ladders, function block diagrams,
//! instruction lists and sequential function charts.
//!
//! What a program contains becomes instructions where these do the same; all else is an error with the element and its
//! line. `variables` finds the devices of variables, `logic` turns what leads to an output into a list, `drawing`
//! follows the wires of ladders and diagrams, `modifiers` reads the attributes that change a value on them, `blocks`
//! knows the standard's functions and blocks, `list` its instruction lists, `chart` its steps and transitions,
//! `expression` their conditions, `configuration` the programs that run.

mod blocks;
mod chart;
mod configuration;
mod drawing;
mod expression;
mod functions;
mod list;
mod logic;
mod modifiers;
mod variables;

use crate::Read;
use crate::gx::cpu;
use crate::il;
use crate::listing::Listing;
use logic::{Logic, Output, Part};
use roxmltree::{Document, Node, ParsingOptions};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Program, Source, SourceKind, Span, codes};
use smol_str::{SmolStr, ToSmolStr};
use std::collections::{BTreeMap, HashMap, HashSet};
use variables::{Found, Kind, Missing, Variables};

pub use blocks::iec_timer_unit;
pub use variables::Names;

/// Prefix of a project's description (`contentDescription` of its header), before the CPU type of its PLC: TC6 2.01 has
/// no element for it.
pub const PLCOPEN_CPU: &str = "CPU type ";

/// Prefix of a project's namespace.
const NAMESPACE: &str = "http://www.plcopen.org/xml/tc6";
/// Largest distance of the namespace from the start of a text.
const HEAD: usize = 4096;
/// The most contacts that lead to an output in PLCopen XML: drawings that share ways grow when they become a list.
pub const MOST_CONTACTS: usize = 2000;

/// The most contacts on all ways of a project: a program of a PLC has far fewer.
const MOST_IN_ALL: usize = 4_000_000;
/// The most nodes of a document: elements, texts and comments.
const MOST_NODES: u32 = 8_000_000;

/// The most mistakes that are reported: a project of another world has one in each element.
const MOST_FAULTS: usize = 200;

/// Returns true if a text is a project of this form.
pub(crate) fn is_project(text: &str) -> bool {
    let head = text.trim_start_matches('\u{FEFF}').trim_start();
    let mut end = head.len().min(HEAD);
    while !head.is_char_boundary(end) {
        end -= 1;
    }
    head.starts_with('<') && head[..end].contains(NAMESPACE)
}

/// Reads a project of PLCopen XML; `names` are the devices of its variables.
pub fn read(name: &str, text: &str, names: &Names) -> Read {
    let options = ParsingOptions {
        nodes_limit: MOST_NODES,
        ..ParsingOptions::default()
    };
    match Document::parse_with_options(text.trim_start_matches('\u{FEFF}'), options) {
        Ok(document) => {
            let (variables, twice) = Variables::new(names, document.root_element());
            let mut reader = Reader {
                variables,
                ..Reader::default()
            };
            reader.report_twice(twice);
            reader.project(&document);
            reader.finish(name)
        }
        Err(error) => damaged(name, text, &error),
    }
}

/// Result of reading a document that is not well-formed.
fn damaged(name: &str, text: &str, error: &roxmltree::Error) -> Read {
    let place = error.pos();
    let above = text
        .split_inclusive('\n')
        .take(place.row.saturating_sub(1) as usize);
    let start = above.map(str::len).sum::<usize>();
    let line = text[start..].lines().next().unwrap_or_default();
    let mut letters = line
        .char_indices()
        .skip(place.col.saturating_sub(1) as usize);
    let at = start + letters.next().map_or(line.len(), |(at, _)| at);
    let what = format!("the project is not well-formed XML: {error}");
    let found = codes::PLCOPEN_SYNTAX.at(Span::new(at as u32, at as u32), what);
    let mut diagnostics = Diagnostics::new();
    diagnostics.push(
        found
            .label("the XML is damaged here")
            .help("export the project again"),
    );
    Read {
        program: Program {
            source: Source::new(name, text),
            kind: SourceKind::Il,
            unread: vec![0],
            ..Program::default()
        },
        diagnostics,
        ..Read::default()
    }
}

/// Something that has no counterpart: what is wrong, and what helps.
#[derive(Debug)]
struct Fault {
    code: &'static codes::Code,
    what: String,
    help: &'static str,
}

impl Fault {
    /// An element that has no counterpart, and why.
    fn at(node: Node, what: impl AsRef<str>, help: &'static str) -> Self {
        Fault {
            code: &codes::PLCOPEN_ELEMENT,
            what: format!("line {}: {}", line(node), what.as_ref()),
            help,
        }
    }

    /// An element that has no counterpart.
    fn outside(node: Node, help: &'static str) -> Self {
        let what = format!("{} has no counterpart in an FX program", called(node));
        Fault::at(node, what, help)
    }

    /// A variable that is not a device.
    fn variable(node: Node, name: &str, missing: &Missing) -> Self {
        let name = name.trim();
        let (what, help) = match missing {
            Missing::Device if name.is_empty() => (
                "a variable or a constant is missing".to_owned(),
                "write what the operator works on",
            ),
            Missing::Device if !is_name(name) => (
                format!("`{name}` is neither a variable nor a constant of a PLC of the family"),
                "numbers are whole, such as `5` and `16#1F`; draw or list what an expression computes",
            ),
            Missing::Device => (format!("the variable `{name}` is not a device"), ADDRESSES),
            Missing::Address(address) => (
                format!("the address `{address}` of `{name}` is not that of a device"),
                ADDRESSES,
            ),
            Missing::Type(kind) => (
                format!("`{name}` is of the type `{kind}`, which no device holds"),
                "a PLC of the family holds BOOL, INT, DINT, WORD and DWORD",
            ),
        };
        Fault {
            code: &codes::PLCOPEN_VARIABLE,
            what: format!("line {}: {what}", line(node)),
            help,
        }
    }
}

/// Returns true for a name, an address, or the part of a block's instance: not a number or an expression.
fn is_name(written: &str) -> bool {
    let mut letters = written.chars();
    let begins = letters
        .next()
        .is_some_and(|c| c.is_alphabetic() || matches!(c, '_' | '%'));
    begins && letters.all(|c| c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | '[' | ']'))
}

/// An element with its name, if it has one.
fn called(node: Node) -> String {
    let named = ["typeName", "name", "label", "instanceName"];
    let named = named.into_iter().find_map(|key| node.attribute(key));
    let named = named.map_or_else(String::new, |name| format!(" `{name}`"));
    format!("element `{}`{named}", node.tag_name().name())
}

#[derive(Default)]
struct Reader {
    parts: Vec<Part>,
    title: Option<String>,
    cpu: Option<String>,
    variables: Variables,
    /// Pointers by the labels of programs.
    pointers: BTreeMap<String, u32>,
    /// The devices of the blocks of the program that is being read, by the names of their instances.
    instances: BTreeMap<String, blocks::Instance>,
    /// The relays of steps, by name in upper case.
    steps: HashMap<String, Device>,
    /// True if the following code is driven by STL.
    in_state: bool,
    /// Contacts on all ways so far.
    contacts: usize,
    /// Programs that no task runs.
    not_run: Vec<String>,
    faults: Vec<Fault>,
    /// True if reading stopped after many mistakes.
    cut_short: bool,
}

/// The children of a node that are called so.
fn children<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children()
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
        let header = children(root, "fileHeader").next();
        let described = header.and_then(|h| h.attribute("contentDescription"));
        let cpu = described.and_then(|text| text.trim().strip_prefix(PLCOPEN_CPU));
        self.cpu = cpu.map(|cpu| cpu.trim().to_owned());
        if let Some(cpu) = self.cpu.as_deref().filter(|cpu| cpu::is_other_family(cpu)) {
            self.faults.push(Fault {
                code: &codes::OTHER_FAMILY,
                what: cpu::rejection_message("project", cpu),
                help: cpu::ONLY_FX,
            });
        }
        let pous = root
            .descendants()
            .filter(|node| node.tag_name().name() == "pou");
        let programs: Vec<_> = pous
            .filter(|pou| pou.attribute("pouType") == Some("program"))
            .collect();
        if programs.is_empty() {
            self.faults.push(Fault {
                code: &codes::PLCOPEN_ELEMENT,
                what: "the project has no program".to_owned(),
                help: "functions and function blocks alone do not run",
            });
        }
        for pou in self.running(root, programs) {
            let declared = self.variables.enter(pou);
            self.report_twice(declared);
            self.instances.clear();
            self.steps.clear();
            self.in_state = false;
            let bodies = children(pou, "body").flat_map(|body| body.children());
            for body in bodies.filter(Node::is_element) {
                self.body(pou, body);
            }
            if let Some(number) = self.pointers.remove(RETURN) {
                self.parts.push(Part::Line(format!("P{number}")));
            }
            self.pointers.clear();
        }
    }

    fn body(&mut self, pou: Node, body: Node) {
        let result = match body.tag_name().name() {
            "LD" | "FBD" => {
                self.check(body);
                drawing::read(self, body);
                Ok(())
            }
            "IL" => {
                list::prepare(self, body);
                list::read(self, body);
                Ok(())
            }
            "SFC" => {
                self.check(body);
                chart::read(self, pou, body)
            }
            "documentation" | "addData" => Ok(()),
            _ => Err(Fault::outside(
                body,
                "write it as LD, FBD, IL or SFC, or compile it in its editor",
            )),
        };
        if let Err(fault) = result {
            self.report(fault);
        }
    }

    /// Checks what concerns each element of a drawing by itself: its number or name, which wires name, is its own, and
    /// its modifiers have a counterpart.
    fn check(&mut self, body: Node) {
        let mut seen = HashSet::new();
        for node in body.children().filter(Node::is_element) {
            if self.gives_up() {
                return;
            }
            let tag = node.tag_name().name();
            let named = matches!(tag, "connector" | "step");
            for key in ["localId", "name"] {
                let value = node.attribute(key).filter(|_| key == "localId" || named);
                let kind = if key == "localId" { "" } else { tag };
                if let Some(value) = value
                    && !seen.insert((kind, value.trim().to_uppercase()))
                {
                    let what = format!("{} has the {key} `{value}` of another", called(node));
                    self.report(Fault::at(node, what, "export the project again"));
                }
            }
            if let Err(fault) = modifiers::check(node) {
                self.report(fault);
            }
        }
    }

    /// Returns true if more mistakes would not help; the rest is then left unread.
    fn gives_up(&mut self) -> bool {
        self.cut_short |= self.faults.len() >= MOST_FAULTS;
        self.cut_short
    }

    /// Counts the contacts on a way to an element.
    fn count(&mut self, node: Node, logic: &Logic) -> Result<(), Fault> {
        let size = logic.size();
        self.contacts += size;
        if size <= MOST_CONTACTS && self.contacts <= MOST_IN_ALL {
            return Ok(());
        }
        let what = "the ways to this element are more than a network of a PLC holds";
        Err(Fault::at(node, what, "divide it by auxiliary relays"))
    }

    /// Adds an output that contacts drive.
    fn output(&mut self, logic: Logic, line: impl Into<SmolStr>) {
        self.parts.push(Part::Output(Output {
            logic,
            lines: vec![line.into()],
            alone: false,
            bare: self.in_state,
        }));
    }

    /// Reports what has no counterpart: a variable once, an element once.
    fn report(&mut self, fault: Fault) {
        let of_variable = fault.code.id == codes::PLCOPEN_VARIABLE.id;
        let what = |fault: &Fault| match fault.what.split_once(": ") {
            Some((_, rest)) if of_variable => rest.to_owned(),
            _ => fault.what.clone(),
        };
        let said = what(&fault);
        if !self.faults.iter().any(|other| what(other) == said) {
            self.faults.push(fault);
        }
    }

    /// The device of a variable, and what it holds.
    fn find(&mut self, node: Node, name: &str) -> Result<Found, Fault> {
        self.variables
            .find(name)
            .map_err(|missing| Fault::variable(node, name, &missing))
    }

    /// The device of a variable that holds a bit, or the part of a block's instance that does.
    fn bit(&mut self, node: Node, name: &str) -> Result<Device, Fault> {
        if let Some((instance, part)) = name.trim().rsplit_once('.') {
            let known = self.instances.get(&instance.trim().to_uppercase());
            let device = known.and_then(|known| known.bit(&part.to_uppercase()));
            if let Some(device) = device {
                return Ok(device);
            }
            if let Some(Kind::Block(kind)) = self.variables.kind(instance) {
                let what = format!("`{instance}` ({kind}) has no bit `{part}` here");
                let help = "read an output of a block of this program";
                return Err(Fault::at(node, what, help));
            }
        }
        if let Some((step, "X" | "x")) = name.trim().rsplit_once('.')
            && let Some(device) = self.steps.get(&step.to_uppercase())
        {
            return Ok(*device);
        }
        if let Some((timer, "Q" | "q")) = name.trim().rsplit_once('.')
            && let Some(device) = variables::device(timer)
            && matches!(device.class, DeviceClass::T | DeviceClass::C)
        {
            return Ok(device);
        }
        let found = self.find(node, name)?;
        let is_contact = matches!(found.device.class, DeviceClass::T | DeviceClass::C);
        if found.kind != Kind::Bool && !is_contact {
            let what = format!("`{}` is not a bit", name.trim());
            return Err(Fault::at(node, what, "contacts and coils need a bit"));
        }
        Ok(found.device)
    }

    /// The pointer of a label.
    fn pointer(&mut self, label: &str) -> SmolStr {
        if let Some(device) = variables::device(label)
            && device.class == DeviceClass::P
        {
            return device.to_smolstr();
        }
        // Identifiers of the standard do not distinguish case.
        let label = label.trim().to_uppercase();
        let number = match self.pointers.get(&label) {
            Some(number) => *number,
            None => {
                let number = self.variables.pointer();
                self.pointers.insert(label, number);
                number
            }
        };
        smol_str::format_smolstr!("P{number}")
    }

    /// Reports the declarations whose name another one has.
    fn report_twice(&mut self, declared: Vec<Node>) {
        for node in declared {
            let what = format!("{} has the name of another variable", called(node));
            let help = "names do not distinguish upper and lower case: rename one of them";
            self.report(Fault::at(node, what, help));
        }
    }

    fn finish(mut self, name: &str) -> Read {
        self.variables.finish();
        let not_run = self.without_instance();
        let first_scan = self.variables.first_scan.iter().map(|line| {
            Part::Output(Output {
                logic: Logic::contact(u32::MAX, true, "M8002"),
                lines: vec![line.clone()],
                alone: false,
                bare: false,
            })
        });
        let mut lines = logic::lines(first_scan.chain(self.parts).collect());
        lines.push("END".into());
        let mut read = il::read_text(name, &lines.join("\n"));
        read.program.kind = SourceKind::Plcopen;
        read.diagnostics.extend(not_run);
        read.program.title = self.title.filter(|title| !title.trim().is_empty());
        read.program.cpu = self.cpu.filter(|cpu| !cpu.is_empty());
        read.program.comments = self.variables.comments;
        read.program.retained = self.variables.retained;
        if self.faults.is_empty() {
            return read;
        }
        let last = self.cut_short.then(|| Fault {
            code: &codes::PLCOPEN_ELEMENT,
            what: "further problems are not shown".to_owned(),
            help: "correct these first: one cause may have several of them",
        });
        // A list with gaps would mislead: what is quoted is the elements that make them.
        let mut listing = Listing::default();
        let mut diagnostics = Diagnostics::new();
        for Fault { code, what, help } in self.faults.into_iter().chain(last) {
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

/// Advice for freeing devices.
const FREE: &str = "list free devices in `[plcopen.free]` of rungc.toml, or in a row such as `*,D100-D199` of the table for `--names`";

/// Name of the end of the program, the target of returns.
const RETURN: &str = "";

/// Advice on addresses and names of devices.
const ADDRESSES: &str = "name its device in `[plcopen.names]` of rungc.toml or in a table for `--names`, or give it an address: \
                         `%IX0.0` is X000, `%QX0.0` Y000, `%MX0.0` M0, `%MW0` D0";
