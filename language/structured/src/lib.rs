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
mod runs;
mod shape;
mod stated;
mod statements;
mod texts;
mod token;
mod types;
mod values;

use ast::{Text, UnitKind};
use emit::Compiler;
use labels::{Declaring, Instance, Label, Labels, Stored, Supply};
use layout::Structures;
use rungc_models::Model;
use rungc_syntax::{
    Device, Diagnostics, Instr, OperandKind, Program, Severity, Source, SourceKind, Span, codes,
    phrase,
};
use runs::Run;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::mem;
use std::rc::Rc;

/// Devices that are known for labels without one, by their names in upper case; that of the program may stand before
/// them, as in `MAIN.START`.
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
    let compiled = compiled(&source, model, known, &mut found);
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
    parsed(&Source::new("", text), &mut found);
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
    let compiled = compiled(&Source::new("", text), model, known, &mut found);
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

/// Reads the files of a text, each by itself: what is not closed in one does not reach into the next.
fn parsed(source: &Source, found: &mut Vec<rungc_syntax::Diagnostic>) -> Option<Text> {
    let mut tree = Text::default();
    let mut all = Vec::new();
    for file in source.spans() {
        let mut tokens = token::tokens(source.slice(file));
        for lexeme in &mut tokens {
            let Span { start, end } = lexeme.span;
            lexeme.span = Span::new(start + file.start, end + file.start);
        }
        let before = found.len();
        shape::nesting(&tokens, found);
        shape::names(&tokens, found);
        if found.len() > before {
            return None;
        }
        tree.extend(parse::parse(&tokens, found));
        all.extend(tokens);
    }
    shape::endings(&tree, found);
    library::add(&mut tree, &all);
    Some(tree)
}

fn compiled(
    source: &Source,
    model: &'static Model,
    known: &Known,
    found: &mut Vec<rungc_syntax::Diagnostic>,
) -> Option<Compiled> {
    let tree = parsed(source, found)?;
    runs::declared_twice(&tree, found);
    let runs = runs::of(&tree, found);
    let first = &tree.units[runs.first()?.unit].name;
    let Declared {
        global,
        programs,
        functions,
        supply,
    } = declared(&tree, &runs, (model, known), found);
    let mut compiler = Compiler {
        labels: Rc::clone(&global),
        units: &tree.units,
        model,
        functions,
        supply,
        instrs: Vec::new(),
        found: Vec::new(),
        text: &source.text,
        span: first.span,
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
    for (run, labels) in runs.iter().zip(&programs) {
        compiler.labels = Rc::clone(labels);
        compiler.program(run);
    }
    compiler.push("FEND", []);
    compiler.routines();
    compiler.span = first.span;
    for last in ["NOP", "END"] {
        compiler.push(last, []);
    }
    compiler.uncalled(found);
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
        for labels in programs.iter().chain([&global]) {
            unused(labels, found);
        }
    }
    let names = runs
        .iter()
        .map(|run| tree.units[run.unit].name.text.as_str());
    Some(Compiled {
        name: first.text.to_string(),
        comments: comments(&global, names.zip(&programs)),
        instrs,
        statements,
    })
}

/// Labels of a text.
struct Declared {
    global: Rc<Labels>,
    /// Those of each program that runs.
    programs: Vec<Rc<Labels>>,
    functions: BTreeMap<String, Rc<Instance>>,
    /// Devices that are left.
    supply: Supply,
}

/// Declares the labels of a text and its programs: constants first, since bounds of arrays may name them.
fn declared(
    tree: &Text,
    runs: &[Run],
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
    let mut programs = Vec::new();
    for run in runs {
        let mut labels = Labels::below(Rc::clone(&global));
        let unit = &tree.units[run.unit];
        cx.program = format!("{}.", unit.name.text);
        for section in &unit.sections {
            labels.declare(section, &mut cx);
        }
        cx.program.clear();
        programs.push(Rc::new(labels));
    }
    let functions = functions_of(&mut cx);
    Declared {
        global,
        programs,
        functions,
        supply,
    }
}

/// The functions of a text, by their names in upper case, with devices for their labels.
fn functions_of(cx: &mut Declaring) -> BTreeMap<String, Rc<Instance>> {
    let mut functions = BTreeMap::new();
    let units = cx.units.iter().enumerate();
    for (at, unit) in units.filter(|(_, unit)| unit.kind == UnitKind::Function) {
        let name = &unit.name;
        if unit.returns.is_none() {
            let what = phrase!("the function `{name}` has no result", name = name.text);
            let error = codes::ST_SYNTAX.at(name.span, what);
            cx.found
                .push(error.help(phrase!("write `FUNCTION {name} : INT`", name = name.text)));
            continue;
        }
        cx.path = format!("{}.", name.text);
        let instance = Instance::declared(at, cx);
        cx.path.clear();
        // Another one of this name is reported.
        let key = name.text.to_uppercase();
        functions.entry(key).or_insert_with(|| Rc::new(instance));
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
        let what = phrase!("nothing uses `{name}`", name = label.name);
        found.push(codes::ST_UNUSED.at(label.span, what));
    }
}

/// Names of labels as the comments of their devices. Where several programs have a label of one name, that of the
/// program stands before it.
fn comments<'l>(
    global: &Labels,
    programs: impl Iterator<Item = (&'l str, &'l Rc<Labels>)>,
) -> BTreeMap<Device, String> {
    let programs: Vec<_> = programs.collect();
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    let locals = programs.iter().flat_map(|(_, labels)| labels.all());
    for label in locals.chain(global.all()) {
        *count.entry(label.name.to_uppercase()).or_default() += 1;
    }
    let mut comments = BTreeMap::new();
    add_comments(global, "", &|_| true, &mut comments);
    for (program, labels) in programs {
        let is_clear = |label: &Label| count.get(&label.name.to_uppercase()) == Some(&1);
        add_comments(labels, "", &is_clear, &mut comments);
        let path = format!("{program}.");
        add_comments(labels, &path, &|label| !is_clear(label), &mut comments);
    }
    comments
}

/// Adds those of some labels, whose names begin with `path`.
fn add_comments(
    labels: &Labels,
    path: &str,
    is_meant: &dyn Fn(&Label) -> bool,
    comments: &mut BTreeMap<Device, String>,
) {
    for label in labels.all().filter(|label| is_meant(label)) {
        let name = format!("{path}{}", label.name);
        match &label.stored {
            Stored::Device(OperandKind::Device(device, None)) => {
                comments.entry(*device).or_insert(name);
            }
            Stored::Instance(instance) => {
                add_comments(&instance.own, &format!("{name}."), &|_| true, comments);
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
