//! `--to plcopen`: a project of PLCopen XML (TC6 2.01) with the program as a ladder or an instruction list.
//!
//! Contacts, coils, timers, comparisons, MOV, ADD and SUB are elements, functions and blocks of the standard; other
//! instructions are blocks whose types begin with `FX_`. What is written reads back to the same list, unless this has
//! blocks or stacks that the drawing does not need.

mod lines;
mod sheet;
mod words;
mod xml;

use crate::args::PlcopenBody;
use lines::Lines;
use rungc_analysis::resolve::resolve;
use rungc_frontend::read_bytes;
use rungc_ladder::{InstrIndex, Ladder, build};
use rungc_lower::compile::{CompileOptions, model};
use rungc_syntax::{Device, DeviceClass, Diagnostics, Instr, Program, codes};
use sheet::Sheet;
use std::collections::BTreeMap;
use words::Words;
use xml::Xml;

/// When projects are said to be made: the same program always becomes the same file.
const MADE: &str = "2000-01-01T00:00:00";

/// The program as a project; what has no structure, and what reads back differently, is added to the diagnostics.
pub fn to_plcopen(
    program: &Program,
    body: PlcopenBody,
    options: &CompileOptions,
    diagnostics: &mut Diagnostics,
) -> String {
    let (resolved, _) = resolve(program, model(program, options));
    let mut words = Words::new(&resolved);
    let written = match body {
        PlcopenBody::Ld => as_ladder(&build::ladder(&resolved), &mut words),
        PlcopenBody::Il => as_list(&build::ladder(&resolved), &mut words),
    };
    let pou = match written {
        Ok(pou) => pou,
        Err((at, why)) => {
            let what = format!("this network has no drawing, which PLCopen XML needs: {why}");
            let help = "`--to il` and `--to csv` write it as a list";
            diagnostics.push(
                codes::PLCOPEN_UNDRAWN
                    .at(program.instrs[at].span, what)
                    .help(help),
            );
            return String::new();
        }
    };
    if !words.instructions.is_empty() {
        let names: Vec<_> = words.instructions.iter().map(String::as_str).collect();
        let kind = match body {
            PlcopenBody::Ld => "blocks",
            PlcopenBody::Il => "functions",
        };
        let what = format!(
            "written as {kind} that only rungc knows, `FX_…`: {}",
            names.join(", ")
        );
        diagnostics.push(codes::PLCOPEN_INSTRUCTIONS.at(Default::default(), what));
    }
    let text = document(program, &pou, &words);
    let back = read_bytes("plcopen", text.as_bytes());
    let back = back.map(|read| read.program.instrs).unwrap_or_default();
    let same = |(a, b): &(&Instr, &Instr)| {
        a.mnemonic == b.mnemonic
            && a.operands
                .iter()
                .map(|operand| &operand.kind)
                .eq(b.operands.iter().map(|o| &o.kind))
    };
    let alike = program.instrs.iter().zip(&back).take_while(same).count();
    if let Some(instr) = program.instrs.get(alike) {
        let what = "what is written means the same, but reads back as another list from here on";
        diagnostics.push(codes::PLCOPEN_FORM.at(instr.span, what));
    }
    text
}

/// A program organization unit.
struct Pou {
    /// The element of its body.
    language: &'static str,
    /// What the body holds.
    content: Xml,
    /// How many variables keep a result, as MPS does.
    kept: usize,
}

/// Why a program cannot be written: the first network without a structure.
type Refused = (InstrIndex, &'static str);

fn as_ladder(ladder: &Ladder, words: &mut Words) -> Result<Pou, Refused> {
    let mut sheet = Sheet::new(words);
    sheet.draw(ladder)?;
    Ok(Pou {
        language: "LD",
        content: sheet.xml,
        kept: 0,
    })
}

fn as_list(ladder: &Ladder, words: &mut Words) -> Result<Pou, Refused> {
    let mut lines = Lines::new(words);
    lines.write(ladder)?;
    let mut content = Xml::default();
    content.text("xhtml:p", &lines.text);
    Ok(Pou {
        language: "IL",
        content,
        kept: lines.kept,
    })
}

fn document(program: &Program, pou: &Pou, words: &Words) -> String {
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
        let product = [
            ("companyName", ""),
            ("productName", "rungc"),
            ("productVersion", env!("CARGO_PKG_VERSION")),
            ("creationDateTime", MADE),
        ];
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
                xml.node("pou", &[("name", "main"), ("pouType", "program")], |xml| {
                    xml.node("interface", &[], |xml| {
                        xml.node("localVars", &[], |xml| {
                            variables(xml, program, words);
                            for nth in 1..=pou.kept {
                                variable(xml, &format!("MPS_{nth}"), None, "BOOL", None);
                            }
                        });
                    });
                    xml.node("body", &[], |xml| {
                        xml.node(pou.language, &[], |xml| xml.append(&pou.content));
                    });
                });
            });
        });
        xml.node("instances", &[], |xml| {
            xml.node("configurations", &[], |xml| {
                xml.node("configuration", &[("name", "config")], |xml| {
                    xml.node("resource", &[("name", "plc")], |xml| {
                        let task = [("name", "scan"), ("interval", "T#10ms"), ("priority", "1")];
                        xml.node("task", &task, |xml| {
                            xml.leaf("pouInstance", &[("name", "instance"), ("typeName", "main")]);
                        });
                    });
                });
            });
        });
    });
    xml.text
}

/// The devices that elements name and those that have comments, with their addresses and types.
fn variables(xml: &mut Xml, program: &Program, words: &Words) {
    use DeviceClass::{C, D, M, S, T, X, Y};
    let mut types: BTreeMap<Device, &str> = BTreeMap::new();
    for device in program.comments.keys() {
        match device.class {
            X | Y | M | S | T | C => _ = types.insert(*device, "BOOL"),
            D => _ = types.insert(*device, "INT"),
            _ => {}
        }
    }
    types.extend(&words.variables);
    for (device, kind) in types {
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
