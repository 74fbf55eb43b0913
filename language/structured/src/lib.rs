//! Structured text of IEC 61131-3, as GX Works2 has it for FX: its grammar, its types, and the instruction list that
//! the editor makes of it.
//!
//! Start reading at [`compile`]. The steps are those that the compiler of GX Works2 takes where they are known; the
//! page on structured text names the others.

mod assign;
mod ast;
mod blocks;
mod calls;
mod conditions;
mod convert;
mod device;
mod emit;
mod fold;
mod functions;
mod labels;
mod layout;
mod library;
mod literal;
mod parse;
mod places;
mod ranges;
mod routines;
mod shape;
mod statements;
mod token;
mod types;
mod values;

use ast::{Text, Unit, UnitKind};
use emit::Compiler;
use labels::{Declaring, Instance, Labels, Stored, Supply};
use layout::Structures;
use rungc_models::Model;
use rungc_syntax::{
    Device, Diagnostics, Instr, OperandKind, Program, Severity, SourceKind, Span, codes,
};
use std::cell::{Cell, RefCell};
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
    let mut tree = parse::parse(&tokens, found);
    shape::endings(&tree, found);
    library::add(&mut tree, &tokens);
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
    let Declared {
        global,
        labels,
        functions,
        supply,
    } = declared(&tree, program, (model, known), found);
    let mut compiler = Compiler {
        labels: Rc::clone(&labels),
        units: &tree.units,
        model,
        functions,
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
        routines: Vec::new(),
        routine: None,
        registers: Cell::new(None),
        indexes: None,
        own_used: RefCell::default(),
    };
    compiler.body(&program.body);
    compiler.span = program.name.span;
    if let Some(end) = compiler.end {
        compiler.label(end);
    }
    compiler.push("FEND", []);
    compiler.routines();
    compiler.span = program.name.span;
    for last in ["NOP", "END"] {
        compiler.push(last, []);
    }
    compiler.uncalled();
    compiler.check_instances();
    compiler.check_registers();
    let (instrs, more) = (compiler.instrs, compiler.found);
    let statements = compiler.statements;
    // A block that is expanded several times reports its mistakes each time.
    for one in more {
        if !found.contains(&one) {
            found.push(one);
        }
    }
    let incomplete = statements.iter().find(|one| !one.is_compiled);
    if let Some(incomplete) = incomplete.filter(|_| !has_errors(found)) {
        found.push(codes::ST_UNSUPPORTED.at(incomplete.span, "this is not compiled yet"));
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

/// Labels of a text.
struct Declared {
    global: Rc<Labels>,
    labels: Rc<Labels>,
    functions: BTreeMap<String, Rc<Instance>>,
    /// Devices that are left.
    supply: Supply,
}

/// Declares the labels of a text and its program: constants first, since bounds of arrays may name them.
fn declared(
    tree: &Text,
    program: &Unit,
    (model, known): (&'static Model, &Known),
    found: &mut Vec<rungc_syntax::Diagnostic>,
) -> Declared {
    let mut supply = Supply::new(ranges::of(model));
    supply.avoid(known);
    let mut constants = Labels::default();
    let none = Structures::default();
    let structures = {
        let mut cx = Declaring::new(&mut supply, known, &tree.units, &none, found);
        for section in tree.globals.iter().filter(|section| section.is_constant) {
            constants.declare(section, &mut cx);
        }
        Structures::new(&tree.structures, &constants, found)
    };
    let mut cx = Declaring::new(&mut supply, known, &tree.units, &structures, found);
    let mut global = constants;
    for section in tree.globals.iter().filter(|section| !section.is_constant) {
        global.declare(section, &mut cx);
    }
    let global = Rc::new(global);
    let mut labels = Labels::below(Rc::clone(&global));
    for section in &program.sections {
        labels.declare(section, &mut cx);
    }
    let functions = functions_of(&global, &mut cx);
    Declared {
        labels: Rc::new(labels),
        global,
        functions,
        supply,
    }
}

/// The program of a text; what else is in it and is not compiled is reported.
fn only_program<'t>(tree: &'t Text, found: &mut Vec<rungc_syntax::Diagnostic>) -> Option<&'t Unit> {
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

/// The functions of a text, by their names in upper case, with devices for their labels.
fn functions_of(global: &Labels, cx: &mut Declaring) -> BTreeMap<String, Rc<Instance>> {
    let mut functions = BTreeMap::new();
    let units = cx.units.iter().enumerate();
    for (at, unit) in units.filter(|(_, unit)| unit.kind == UnitKind::Function) {
        let name = &unit.name;
        if unit.returns.is_none() {
            let what = format!("the function `{}` has no result", name.text);
            let error = codes::ST_SYNTAX.at(name.span, what);
            cx.found
                .push(error.help(format!("write `FUNCTION {} : INT`", name.text)));
            continue;
        }
        if let Some(other) = global.get(&name.text) {
            let what = format!("`{}` is declared twice", name.text);
            let error = codes::ST_DECLARED_TWICE.at(name.span, what);
            cx.found
                .push(error.label("again here").other(other.span, "first here"));
        }
        let mut keywords = unit.sections.iter().map(|section| &section.keyword);
        if let Some(reference) = keywords.find(|keyword| keyword.text == "VAR_IN_OUT") {
            let what = "VAR_IN_OUT of a function is not compiled yet";
            cx.found
                .push(codes::ST_UNSUPPORTED.at(reference.span, what));
        }
        cx.path = format!("{}.", name.text);
        let instance = Instance::declared(at, cx);
        cx.path.clear();
        let before = functions.insert(name.text.to_uppercase(), Rc::new(instance));
        if let Some(before) = before {
            let first = cx.units[before.unit].name.span;
            let what = format!("`{}` is declared twice", name.text);
            let error = codes::ST_DECLARED_TWICE.at(name.span, what);
            cx.found
                .push(error.label("again here").other(first, "first here"));
        }
    }
    functions
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
    for label in labels.all() {
        let name = format!("{path}{}", label.name);
        match &label.stored {
            Stored::Device(OperandKind::Device(device, None)) => {
                comments.entry(*device).or_insert(name);
            }
            Stored::Instance(instance) => {
                add_comments(&instance.own, &format!("{name}."), comments);
            }
            Stored::Area(_) => {
                for (member, device) in places::members(label) {
                    comments.entry(device).or_insert(format!("{name}{member}"));
                }
            }
            _ => {}
        }
    }
}
