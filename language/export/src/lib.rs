//! Writer of projects of PLCopen XML (TC6 2.01), with the program as a ladder, an instruction list or a sequential
//! function chart.
//!
//! Contacts, coils, timers, comparisons, MOV, ADD and SUB are elements, functions and blocks of the standard; other
//! instructions are blocks whose types begin with `FX_`. What is written reads back to the same list, unless this has
//! blocks or stacks that the drawing does not need.
//!
//! [`to_ladder`] writes a program as a list with drawn networks instead.
//!
//! Start reading at [`to_plcopen`], then `words` (what instructions are called in the standard) and the writers of the
//! three languages: `sheet` (ladders), `lines` (lists), `chart` (charts).

mod chart;
mod drawn;
mod lines;
mod sheet;
mod words;
mod xml;

pub use drawn::to_ladder;

use lines::Lines;
use rungc_analysis::resolve::resolve;
use rungc_catalogue::{Basic, Lower};
use rungc_frontend::{MOST_CONTACTS, Names, Read, read_plcopen};
use rungc_ladder::{InstrIndex, Item, Ladder, Network, NetworkBody, Node, Part, build};
use rungc_models::{Model, ModelId};
use rungc_syntax::codes::{self, Code};
use rungc_syntax::diag::counted;
use rungc_syntax::{
    Device, DeviceClass, Diagnostic, Diagnostics, Instr, Program, Severity, Span, align,
};
use sheet::Sheet;
use std::collections::{BTreeMap, BTreeSet};
use std::mem;
use words::Words;
use xml::Xml;

/// Fixed creation time of projects: the same program always becomes the same file.
const MADE: &str = "2000-01-01T00:00:00";

/// Language of a program in a project.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Body {
    /// Ladder.
    Ladder,
    /// Instruction list of IEC 61131-3.
    List,
    /// Sequential function chart of a step ladder (STL) program.
    Chart,
}

/// Writes the program as a project. What has no structure, and what reads back differently, is added to the
/// diagnostics.
pub fn to_plcopen(
    program: &Program,
    model: &'static Model,
    body: Body,
    diagnostics: &mut Diagnostics,
) -> String {
    let (resolved, _) = resolve(program, model);
    let mut words = Words::new(&resolved);
    let ladder = build::ladder(&resolved);
    let written = check_ways(&ladder).and_then(|()| match body {
        Body::Ladder => as_ladder("main", &ladder, &mut words).map(|pou| vec![pou]),
        Body::List => as_list(&ladder, &mut words).map(|pou| vec![pou]),
        Body::Chart => as_chart(&ladder, &mut words),
    });
    let pous = match written {
        Ok(pous) => pous,
        Err(refused) => {
            // A program without instructions has no place to show.
            let instr = program.instrs.get(refused.at);
            let span = instr.map_or_else(Span::default, |instr| instr.span);
            let diagnostic = refused.code.at(span, refused.what);
            let help = "`--to il` and `--to csv` write it as a list";
            diagnostics.push(diagnostic.help(help));
            return String::new();
        }
    };
    if !words.instructions.is_empty() {
        let names: Vec<_> = words.instructions.iter().map(String::as_str).collect();
        let kind = match body {
            Body::Ladder => "blocks",
            Body::List | Body::Chart => "functions",
        };
        let what = format!(
            "written as {kind} that only rungc knows, `FX_…`: {}",
            names.join(", ")
        );
        diagnostics.push(codes::PLCOPEN_INSTRUCTIONS.at(Default::default(), what));
    }
    drop(ladder);
    let text = document(program, pous, &words);
    let is_same = match body {
        Body::Ladder | Body::List => check_list(program, &text, diagnostics),
        Body::Chart => {
            check_chart(&text, diagnostics);
            true
        }
    };
    if is_same { text } else { String::new() }
}

/// Finds the first network with more contacts on a way than rungc reads back; no PLC holds as many.
fn check_ways(ladder: &Ladder) -> Result<(), Refused> {
    let too_long = |network: &&Network| match &network.body {
        NetworkBody::Rung(node) => longest_way(node) > MOST_CONTACTS,
        NetworkBody::List { .. } => false,
    };
    match ladder.networks.iter().find(too_long) {
        Some(network) => {
            let why = format!("more than {MOST_CONTACTS} contacts lead to an output");
            Err(Refused::network(network.instrs.start, &why))
        }
        None => Ok(()),
    }
}

/// The most contacts on all ways to one output.
fn longest_way(node: &Node) -> usize {
    let items = node.items.iter().map(|item| match item {
        Item::Output(_) => 0,
        Item::Continue(next) => longest_way(next),
        Item::Stack(branches) => branches.iter().map(longest_way).max().unwrap_or(0),
    });
    contacts(&node.series) + items.max().unwrap_or(0)
}

fn contacts(series: &[Part]) -> usize {
    let count = |part: &Part| match part {
        Part::Contact(_) | Part::Result(_) => 1,
        Part::Parallel(branches) => branches.iter().map(|branch| contacts(&branch.series)).sum(),
        Part::Group(parts) => contacts(parts),
    };
    series.iter().map(count).sum()
}

/// Maximum number of differences in the list read back that are shown one by one.
const SHOWN: usize = 5;

/// Says where a project reads back as another list, and as which. Returns false, with an error, if that does something
/// else.
fn check_list(program: &Program, text: &str, diagnostics: &mut Diagnostics) -> bool {
    let back = read_plcopen("plcopen", text, &Names::default());
    if let Some(error) = changed(program, &back) {
        diagnostics.push(error);
        return false;
    }
    let texts = |instrs: &[Instr]| instrs.iter().map(ToString::to_string).collect::<Vec<_>>();
    let (old, new) = (texts(&program.instrs), texts(&back.program.instrs));
    let quoted = |texts: &[String]| {
        let texts: Vec<_> = texts.iter().map(|text| format!("`{text}`")).collect();
        texts.join(" ")
    };
    let mut places = Vec::new();
    let (mut from, mut to) = (0, 0);
    for (old_at, new_at) in align::common(&old, &new)
        .into_iter()
        .chain([(old.len(), new.len())])
    {
        if from < old_at || to < new_at {
            let what = match (&old[from..old_at], &new[to..new_at]) {
                (gone, []) => format!(
                    "{} is not needed in what is written, and does not come back",
                    quoted(gone)
                ),
                ([], more) => format!("{} is added here when this is read back", quoted(more)),
                (gone, more) => format!(
                    "{} reads back as {}, which means the same",
                    quoted(gone),
                    quoted(more)
                ),
            };
            let at = from.min(old.len().saturating_sub(1));
            places.push((at, what));
        }
        (from, to) = (old_at + 1, new_at + 1);
    }
    let span = |at: usize| {
        program
            .instrs
            .get(at)
            .map_or_else(Span::default, |instr| instr.span)
    };
    let more = places.len().saturating_sub(SHOWN);
    for (nth, (at, what)) in places.into_iter().take(SHOWN).enumerate() {
        let mut note = codes::PLCOPEN_FORM.at(span(at), what);
        if nth + 1 == SHOWN && more > 0 {
            note = note.help(format!(
                "{} read back otherwise",
                counted(more, "more place")
            ));
        }
        diagnostics.push(note);
    }
    true
}

/// The first difference between a program and what it reads back as that is more than another list of the same
/// networks: an output, an instruction of words, a label or an operand.
fn changed(program: &Program, back: &Read) -> Option<Diagnostic> {
    let help = "`--to il` and `--to csv` write it as it is";
    let error = |instr: Option<&Instr>, what: String| {
        let span = instr.map_or_else(Span::default, |instr| instr.span);
        codes::PLCOPEN_UNDRAWN.at(span, what).help(help)
    };
    let mut errors = back.diagnostics.iter();
    if let Some(found) = errors.find(|found| found.severity == Severity::Error) {
        let what = format!("the project cannot be read back: {}", found.message);
        return Some(error(None, what));
    }
    let outputs = |program: &'_ Program| -> Vec<(usize, String)> {
        let instrs = program.instrs.iter().enumerate();
        let effects = instrs.filter(|(_, instr)| effect(instr) == Effect::Output);
        effects.map(|(at, instr)| (at, instr.to_string())).collect()
    };
    let (old, new) = (outputs(program), outputs(&back.program));
    let different = (0..old.len().max(new.len()))
        .find(|&at| old.get(at).map(|o| &o.1) != new.get(at).map(|n| &n.1));
    if let Some(at) = different {
        let what = match (old.get(at), new.get(at)) {
            (Some((_, old)), Some((_, new))) => format!("`{old}` would read back as `{new}`"),
            (Some((_, old)), None) => format!("`{old}` would not come back"),
            (None, new) => {
                let new = new.map_or("", |(_, new)| new);
                format!("`{new}` would be added when this is read back")
            }
        };
        let instr = old.get(at).map(|(at, _)| &program.instrs[*at]);
        return Some(error(instr, what));
    }
    let read: BTreeSet<_> = back.program.instrs.iter().filter_map(contact).collect();
    let mut contacts = program.instrs.iter();
    let lost = contacts.find(|instr| contact(instr).is_some_and(|c| !read.contains(&c)))?;
    Some(error(Some(lost), format!("`{lost}` would not come back")))
}

/// Part of an instruction in a network.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effect {
    /// A contact.
    Contact,
    /// What joins contacts and branches, or does nothing.
    Structure,
    /// Everything else.
    Output,
}

fn effect(instr: &Instr) -> Effect {
    let found = rungc_catalogue::find(&instr.mnemonic);
    match found.map(|found| found.inst.lower_on_model(ModelId::Fx3u)) {
        Some(Lower::Compare(..)) => Effect::Contact,
        Some(Lower::Basic(basic)) => match basic {
            Basic::Ld | Basic::Ldi | Basic::Ldp | Basic::Ldf => Effect::Contact,
            Basic::And | Basic::Ani | Basic::Andp | Basic::Andf => Effect::Contact,
            Basic::Or | Basic::Ori | Basic::Orp | Basic::Orf => Effect::Contact,
            Basic::Anb | Basic::Orb | Basic::Mps | Basic::Mrd | Basic::Mpp => Effect::Structure,
            Basic::Inv | Basic::Nop | Basic::End => Effect::Structure,
            _ => Effect::Output,
        },
        _ => Effect::Output,
    }
}

/// Operands of a contact, without the one that is always on, which stands for the power rail.
fn contact(instr: &Instr) -> Option<String> {
    let text = instr.to_string();
    let (_, operands) = text.split_once(' ')?;
    (effect(instr) == Effect::Contact && operands != "M8000").then(|| operands.to_owned())
}

/// Says that a chart does not switch as a step ladder does; what rungc itself cannot read back is an error.
fn check_chart(text: &str, diagnostics: &mut Diagnostics) {
    // Its transitions need relays, whichever they are.
    let names = Names {
        free: vec![(DeviceClass::M, 0, 7679)],
        ..Names::default()
    };
    let what = "the steps switch as IEC 61131-3 says: a step ends before the next one begins, and of several \
                transitions the first one fires";
    diagnostics.push(codes::PLCOPEN_EVOLUTION.at(Default::default(), what));
    let read = read_plcopen("plcopen", text, &names);
    let found = read.diagnostics.iter();
    let errors = found.filter(|found| found.severity == Severity::Error);
    diagnostics.extend(
        errors.map(|found| codes::PLCOPEN_CHART.at(Default::default(), found.message.clone())),
    );
}

/// A program organization unit.
struct Pou {
    name: &'static str,
    /// The element of its body.
    language: &'static str,
    /// Contents of the body.
    content: Xml,
    /// Number of variables that store a result, as MPS does.
    kept: usize,
}

/// Reason why a program cannot be written.
struct Refused {
    code: &'static Code,
    at: InstrIndex,
    what: String,
}

impl Refused {
    /// A network without a structure.
    fn network(at: InstrIndex, why: &str) -> Self {
        Refused {
            code: &codes::PLCOPEN_UNDRAWN,
            at,
            what: format!("this network has no drawing, which PLCopen XML needs: {why}"),
        }
    }

    /// Something that a chart cannot say.
    fn state(at: InstrIndex, what: impl Into<String>) -> Self {
        Refused {
            code: &codes::PLCOPEN_CHART,
            at,
            what: what.into(),
        }
    }
}

fn as_ladder(name: &'static str, ladder: &Ladder, words: &mut Words) -> Result<Pou, Refused> {
    let mut sheet = Sheet::new(words);
    sheet.draw(ladder)?;
    Ok(Pou {
        name,
        language: "LD",
        content: sheet.xml,
        kept: 0,
    })
}

/// The chart as a separate program, between ladders of what stands before and after the states.
fn as_chart(ladder: &Ladder, words: &mut Words) -> Result<Vec<Pou>, Refused> {
    let parts = chart::parts(words, ladder)?;
    let before = as_ladder("before", &parts.before, words)?;
    let chart = Pou {
        name: "main",
        language: "SFC",
        content: parts.chart,
        kept: parts.kept,
    };
    let after = as_ladder("after", &parts.after, words)?;
    let all = [before, chart, after].into_iter();
    Ok(all.filter(|pou| !pou.content.text.is_empty()).collect())
}

fn as_list(ladder: &Ladder, words: &mut Words) -> Result<Pou, Refused> {
    let mut lines = Lines::new(words);
    lines.write(ladder)?;
    let mut content = Xml::default();
    content.text("xhtml:p", &lines.text);
    Ok(Pou {
        name: "main",
        language: "IL",
        content,
        kept: lines.kept,
    })
}

fn document(program: &Program, mut pous: Vec<Pou>, words: &Words) -> String {
    let title = program
        .title
        .as_deref()
        .filter(|title| !title.trim().is_empty());
    let mut xml = Xml::default();
    xml.text
        .push_str("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n");
    let spaces = [
        ("xmlns", "http://www.plcopen.org/xml/tc6_0201"),
        ("xmlns:xhtml", "http://www.w3.org/1999/xhtml"),
    ];
    xml.node("project", &spaces, |xml| {
        let cpu = program
            .cpu
            .as_ref()
            .map(|cpu| format!("{}{cpu}", rungc_frontend::PLCOPEN_CPU));
        let mut product = vec![
            ("companyName", ""),
            ("productName", "rungc"),
            ("productVersion", env!("CARGO_PKG_VERSION")),
            ("creationDateTime", MADE),
        ];
        product.extend(cpu.iter().map(|cpu| ("contentDescription", cpu.as_str())));
        xml.leaf("fileHeader", &product);
        xml.node(
            "contentHeader",
            &[("name", title.unwrap_or_default())],
            |xml| {
                xml.node("coordinateInfo", &[], |xml| {
                    for language in ["fbd", "ld", "sfc"] {
                        xml.node(language, &[], |xml| {
                            xml.leaf("scaling", &[("x", "10"), ("y", "10")])
                        });
                    }
                });
            },
        );
        xml.node("types", &[], |xml| {
            xml.leaf("dataTypes", &[]);
            xml.node("pous", &[], |xml| {
                for at in 0..pous.len() {
                    // Contents may be large: they are there once.
                    let content = mem::take(&mut pous[at].content);
                    let pou = &pous[at];
                    let attributes = [("name", pou.name), ("pouType", "program")];
                    xml.node("pou", &attributes, |xml| {
                        xml.node("interface", &[], |xml| {
                            interface(xml, program, &pous, pou, words)
                        });
                        xml.node("body", &[], |xml| {
                            xml.node(pou.language, &[], |xml| xml.append(content));
                        });
                    });
                }
            });
        });
        instances(xml, program, &pous, words);
    });
    xml.text
}

/// The variables of a program: its own, or those that it shares with others.
fn interface(xml: &mut Xml, program: &Program, pous: &[Pou], pou: &Pou, words: &Words) {
    let kept = |xml: &mut Xml| {
        for nth in 1..=pou.kept {
            variable(xml, &format!("MPS_{nth}"), None, "BOOL", None);
        }
    };
    if pous.len() == 1 {
        return xml.node("localVars", &[], |xml| {
            variables(xml, program, words);
            kept(xml);
        });
    }
    if pou.kept > 0 {
        xml.node("localVars", &[], kept);
    }
    xml.node("externalVars", &[], |xml| {
        for (device, kind) in types(program, words) {
            variable(xml, &device.to_string(), None, kind, None);
        }
    });
}

fn instances(xml: &mut Xml, program: &Program, pous: &[Pou], words: &Words) {
    xml.node("instances", &[], |xml| {
        xml.node("configurations", &[], |xml| {
            xml.node("configuration", &[("name", "config")], |xml| {
                xml.node("resource", &[("name", "plc")], |xml| {
                    let task = [("name", "scan"), ("interval", "T#10ms"), ("priority", "1")];
                    xml.node("task", &task, |xml| {
                        for (nth, pou) in pous.iter().enumerate() {
                            let name = match nth {
                                0 => "instance".to_owned(),
                                _ => format!("instance{nth}"),
                            };
                            let attributes = [("name", name.as_str()), ("typeName", pou.name)];
                            xml.leaf("pouInstance", &attributes);
                        }
                    });
                    if pous.len() > 1 {
                        xml.node("globalVars", &[], |xml| variables(xml, program, words));
                    }
                });
            });
        });
    });
}

/// The devices that elements name and those that have comments, with their types.
fn types(program: &Program, words: &Words) -> BTreeMap<Device, &'static str> {
    use DeviceClass::{C, D, M, R, S, T, X, Y};
    let mut types: BTreeMap<Device, &str> = BTreeMap::new();
    let commented = program.comments.keys();
    for device in commented.filter(|device| !words.steps.contains(device)) {
        match device.class {
            X | Y | M | S | T | C => _ = types.insert(*device, "BOOL"),
            D | R => _ = types.insert(*device, "INT"),
            _ => {}
        }
    }
    types.extend(words.variables.iter().map(|(&device, &ty)| (device, ty)));
    types
}

/// The variables of all devices, with their addresses.
fn variables(xml: &mut Xml, program: &Program, words: &Words) {
    use DeviceClass::{D, M, X, Y};
    for (device, kind) in types(program, words) {
        let number = device.number;
        let address = match device.class {
            X => Some(format!("%IX{}.{}", number / 8, number % 8)),
            Y => Some(format!("%QX{}.{}", number / 8, number % 8)),
            M => Some(format!("%MX{}.{}", number / 8, number % 8)),
            D => Some(format!("%MW{number}")),
            _ => None,
        };
        let comment = program.comments.get(&device).map(String::as_str);
        variable(xml, &device.to_string(), address.as_deref(), kind, comment);
    }
}

fn variable(xml: &mut Xml, name: &str, address: Option<&str>, kind: &str, comment: Option<&str>) {
    let mut attributes = vec![("name", name)];
    attributes.extend(address.map(|address| ("address", address)));
    xml.node("variable", &attributes, |xml| {
        xml.node("type", &[], |xml| match kind {
            "TON" => xml.leaf("derived", &[("name", "TON")]),
            kind => xml.leaf(kind, &[]),
        });
        if let Some(comment) = comment {
            xml.prose("documentation", comment);
        }
    });
}
