//! Structured text of IEC 61131-3, as GX Works2 has it for FX: its grammar, its types, and the instruction list that
//! the editor makes of it.
//!
//! Start reading at [`compile`]. The steps are those that the compiler of GX Works2 takes where they are known; the
//! page on structured text names the others.

mod ast;
mod blocks;
mod calls;
mod conditions;
mod convert;
mod device;
mod emit;
mod fold;
mod labels;
mod literal;
mod parse;
mod ranges;
mod shape;
mod statements;
mod token;
mod types;
mod values;

use ast::{Text, Unit, UnitKind};
use emit::Compiler;
use labels::{Declaring, Labels, Stored, Supply};
use rungc_models::Model;
use rungc_syntax::{
    Device, Diagnostics, Instr, OperandKind, Program, Severity, SourceKind, Span, codes,
};
use std::collections::BTreeMap;
use std::mem;
use std::rc::Rc;

/// Devices that are known for labels without one, by their names in upper case.
pub type Known = BTreeMap<String, Device>;

/// Compiles the text of a program that was read as structured text into its instructions; other programs stay as they
/// are. With errors there are no instructions, and the program is incomplete.
pub fn compile(program: &mut Program, model: &'static Model) -> Diagnostics {
    compile_with(program, model, &Known::new())
}

/// As [`compile`], with devices that are known for labels without one.
pub fn compile_with(program: &mut Program, model: &'static Model, known: &Known) -> Diagnostics {
    let mut out = Diagnostics::new();
    if program.kind != SourceKind::StructuredText || !program.instrs.is_empty() {
        return out;
    }
    let source = mem::take(&mut program.source);
    let mut found = Vec::new();
    let compiled = compiled(&source.text, model, known, &mut found);
    let has_errors = found
        .iter()
        .any(|one| one.severity == rungc_syntax::Severity::Error);
    if let Some(compiled) = compiled.filter(|_| !has_errors) {
        program.instrs = compiled.instrs;
        program.comments = compiled.comments;
        program.pou = Some(compiled.name);
        program.unread.clear();
    } else {
        program.unread = vec![0];
    }
    program.source = source;
    out.extend(found);
    out
}

/// Reads the statements of a text and finds what is wrong with its syntax; for searches of mistakes by chance.
pub fn check_syntax(text: &str) -> Diagnostics {
    let mut found = Vec::new();
    parsed(text, &mut found);
    let mut out = Diagnostics::new();
    out.extend(found);
    out
}

/// Result of a statement of a program that was compiled in spite of errors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Outcome {
    /// Place of the statement, or of the part of it before other statements; its instructions have the same place.
    pub span: Span,
    /// False if it was not compiled.
    pub is_compiled: bool,
}

/// A program that was compiled as far as it can be, to measure how much of it can.
#[derive(Debug, Default)]
pub struct Trial {
    /// Its statements, each before those inside of it.
    pub statements: Vec<Outcome>,
    /// Instructions of those that were compiled.
    pub instrs: Vec<Instr>,
    /// Findings.
    pub diagnostics: Diagnostics,
}

/// Compiles a text as far as it can be, with devices that are known for labels without one.
pub fn trial(text: &str, model: &'static Model, known: &Known) -> Trial {
    let mut found = Vec::new();
    let compiled = compiled(text, model, known, &mut found);
    let mut diagnostics = Diagnostics::new();
    diagnostics.extend(found);
    let (statements, instrs) = compiled.map_or_else(Default::default, |compiled| {
        (compiled.statements, compiled.instrs)
    });
    Trial {
        statements,
        instrs,
        diagnostics,
    }
}

/// A program as a list.
struct Compiled {
    name: String,
    instrs: Vec<Instr>,
    statements: Vec<Outcome>,
    comments: BTreeMap<Device, String>,
}

/// Reads a text.
fn parsed(text: &str, found: &mut Vec<rungc_syntax::Diagnostic>) -> Option<Text> {
    let tokens = token::tokens(text);
    let before = found.len();
    shape::nesting(&tokens, found);
    if found.len() > before {
        return None;
    }
    let tree = parse::parse(&tokens, found);
    shape::endings(&tree, found);
    Some(tree)
}

fn compiled(
    text: &str,
    model: &'static Model,
    known: &Known,
    found: &mut Vec<rungc_syntax::Diagnostic>,
) -> Option<Compiled> {
    let tree = parsed(text, found)?;
    let program = only_program(&tree, found)?;
    let mut supply = Supply::new(ranges::of(model));
    supply.avoid(known);
    let mut cx = Declaring {
        supply: &mut supply,
        known,
        units: &tree.units,
        found,
        path: String::new(),
        left: blocks::MOST,
    };
    let mut global = Labels::default();
    for section in &tree.globals {
        global.declare(section, &mut cx);
    }
    let global = Rc::new(global);
    let mut labels = Labels::below(Rc::clone(&global));
    for section in &program.sections {
        labels.declare(section, &mut cx);
    }
    let labels = Rc::new(labels);
    let mut compiler = Compiler {
        labels: Rc::clone(&labels),
        units: &tree.units,
        supply,
        instrs: Vec::new(),
        found: Vec::new(),
        text,
        span: program.name.span,
        heading: None,
        is_powered: false,
        loops: Vec::new(),
        end: None,
        statements: Vec::new(),
        expansions: 0,
    };
    compiler.body(&program.body);
    compiler.span = program.name.span;
    if let Some(end) = compiler.end {
        compiler.label(end);
    }
    for last in ["FEND", "NOP", "END"] {
        compiler.push(last, []);
    }
    let (instrs, more) = (compiler.instrs, compiler.found);
    let statements = compiler.statements;
    // A block that is expanded several times reports its mistakes each time.
    for one in more {
        if !found.contains(&one) {
            found.push(one);
        }
    }
    if !has_errors(found) {
        unused(&labels, found);
        unused(&global, found);
    }
    Some(Compiled {
        name: program.name.text.to_string(),
        instrs,
        statements,
        comments: comments([&*global, &*labels]),
    })
}

/// The program of a text; what else is in it and is not compiled is reported.
fn only_program<'t>(tree: &'t Text, found: &mut Vec<rungc_syntax::Diagnostic>) -> Option<&'t Unit> {
    for structure in &tree.structures {
        let what = format!(
            "the structure `{}` is not compiled yet",
            structure.name.text
        );
        found.push(codes::ST_UNSUPPORTED.at(structure.name.span, what));
    }
    let functions = tree
        .units
        .iter()
        .filter(|unit| unit.kind == UnitKind::Function);
    for unit in functions {
        let span = unit.head.to(unit.name.span);
        found.push(codes::ST_UNSUPPORTED.at(span, "functions of your own are not compiled yet"));
    }
    let mut programs = tree
        .units
        .iter()
        .filter(|unit| unit.kind == UnitKind::Program);
    let Some(program) = programs.next() else {
        if !has_errors(found) {
            let error = codes::ST_SYNTAX.at(Span::default(), "this text holds no PROGRAM");
            found.push(error.help("write `PROGRAM Main`, the statements, and `END_PROGRAM`"));
        }
        return None;
    };
    for other in programs {
        let span = other.head.to(other.name.span);
        let error =
            codes::ST_UNSUPPORTED.at(span, "a text with several programs is not compiled yet");
        found.push(error.other(program.name.span, "the first program"));
    }
    Some(program)
}

/// Returns true if an error is among some findings.
fn has_errors(found: &[rungc_syntax::Diagnostic]) -> bool {
    found.iter().any(|one| one.severity == Severity::Error)
}

/// Warns of labels without a use.
fn unused(labels: &Labels, found: &mut Vec<rungc_syntax::Diagnostic>) {
    let unused = labels
        .all()
        .filter(|label| label.is_chosen && !label.is_used.get());
    for label in unused {
        let what = format!("nothing uses `{}`", label.name);
        found.push(codes::ST_UNUSED.at(label.span, what));
    }
}

/// Names of labels as the comments of their devices.
fn comments<'l>(all: impl IntoIterator<Item = &'l Labels>) -> BTreeMap<Device, String> {
    let mut comments = BTreeMap::new();
    for labels in all {
        add_comments(labels, "", &mut comments);
    }
    comments
}

/// Adds those of some labels, whose names begin with `path`.
fn add_comments(labels: &Labels, path: &str, comments: &mut BTreeMap<Device, String>) {
    for label in labels.all().filter(|label| label.bounds.is_none()) {
        let name = format!("{path}{}", label.name);
        match &label.stored {
            Stored::Device(OperandKind::Device(device, None)) => {
                comments.entry(*device).or_insert(name);
            }
            Stored::Instance(instance) => {
                add_comments(&instance.own, &format!("{name}."), comments);
            }
            _ => {}
        }
    }
}
