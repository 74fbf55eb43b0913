//! Safety functions: of each, the right program has all properties, the wrong one lacks the one that its page names, and
//! every change of an instruction of the right program is refuted, proved to change nothing, or listed here with a
//! reason.

use rungc_coverage::mutants::of_program;
use rungc_functions::{Function, library, page, properties};
use rungc_host::duration;
use rungc_ir::Module;
use rungc_ir::passes::simplify;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_project::property::{PropertyKind, Row};
use rungc_project::{Named, Project};
use rungc_sim::property::{Condition, Property, parse};
use rungc_syntax::{DeviceClass, Program};
use rungc_verify::model::World;
use rungc_verify::prove::{Options, Verdict, decide};
use rungc_verify::same::compare;
use std::path::Path;
use std::time::Duration;

/// Mutants that no demand refutes although they change outputs: function, change, reason.
const SURVIVORS: &[(&str, &str, &str)] = &[];

fn read(named: &Named) -> Condition {
    parse(&named.text, &|_| Vec::new()).unwrap_or_else(|why| panic!("{}: {why:?}", named.text))
}

fn property(kind: &PropertyKind) -> Property {
    match kind {
        PropertyKind::Never(only) => Property::Never(read(only)),
        PropertyKind::Always(only) => Property::Always(read(only)),
        PropertyKind::Reachable(only) => Property::Reachable(read(only)),
        PropertyKind::Whenever { when, then, within } => {
            let ms = within
                .as_ref()
                .map_or(Ok(0), |ms| duration::parse(&ms.text));
            Property::Whenever {
                when: read(when),
                then: read(then),
                within_ms: ms.unwrap() as u32,
            }
        }
        PropertyKind::Stays {
            after,
            holds,
            until,
        } => Property::Stays {
            after: after.as_ref().map(read),
            holds: read(holds),
            until: until.as_ref().map_or(Condition::Constant(false), read),
        },
    }
}

/// The properties of a function with the parameters of its page, each with its name.
fn demands(function: &Function) -> Vec<(String, Property)> {
    let project = Project::parse(Path::new("rungc.toml"), &page::row(function)).unwrap();
    let expanded = properties(&project).unwrap().into_iter();
    expanded
        .map(|expanded| {
            let Row { name, kind, .. } = expanded.row;
            (name.unwrap(), property(&kind))
        })
        .collect()
}

fn program(list: &str) -> Program {
    rungc_frontend::read_text("function.il", list).program
}

/// A program with all devices that the demands look at; `None` if it does not compile.
fn module(program: &Program, demands: &[(String, Property)]) -> Option<Module> {
    let conditions = demands
        .iter()
        .flat_map(|(_, property)| property.conditions());
    let mut observed: Vec<(DeviceClass, u32)> = conditions.flat_map(Condition::devices).collect();
    observed.sort();
    observed.dedup();
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        observe: observed,
        optimise: false,
        ..CompileOptions::default()
    };
    let mut module = compile(program, &options).module?;
    simplify(&mut module);
    Some(module)
}

fn options() -> Options {
    Options {
        world: World::default(),
        assumed: Vec::new(),
        time: Duration::from_secs(5),
    }
}

/// Returns true if a program lacks a property; else the reason why that is not decided.
fn lacks(module: &Module, property: &Property) -> Result<bool, String> {
    match decide(module, property, &options()).verdict {
        Verdict::Found(_) => Ok(!property.is_wanted()),
        Verdict::Proved => Ok(property.is_wanted()),
        Verdict::Undecided(why) => Err(format!("{why:?}")),
    }
}

#[test]
fn right_programs_have_all_properties_and_wrong_ones_lack_one() {
    let mut wrong = Vec::new();
    for function in library::all() {
        let demands = demands(function);
        let right = module(&program(function.right), &demands).unwrap();
        for (name, property) in &demands {
            let begin = std::time::Instant::now();
            let verdict = lacks(&right, property);
            eprintln!("{name}: {verdict:?} {:?}", begin.elapsed());
            if verdict != Ok(false) {
                wrong.push(format!("right: {name}: {verdict:?}"));
            }
        }
        let violated = format!("{}: {}", function.name, function.violates);
        let demand = demands.iter().find(|(name, _)| *name == violated).unwrap();
        let module = module(&program(function.wrong), &demands).unwrap();
        let verdict = lacks(&module, &demand.1);
        if verdict != Ok(true) {
            wrong.push(format!("wrong: {violated}: {verdict:?}"));
        }
    }
    assert_eq!(wrong, [""; 0], "\n{}", wrong.join("\n"));
}

/// Changes of the right program that no demand refutes and that change outputs.
fn survivors(function: &Function) -> Vec<String> {
    let mut demands = demands(function);
    let right = program(function.right);
    let old = module(&right, &demands).unwrap();
    let mut survived = Vec::new();
    for mutant in of_program(&right, Model::get(ModelId::Fx3u)) {
        let Some(new) = module(&mutant.applied(&right), &demands) else {
            continue;
        };
        // Demands that have refuted a mutant are likely to refute the next.
        let is_refuted = |(_, property): &(String, Property)| lacks(&new, property) == Ok(true);
        if let Some(at) = demands.iter().position(is_refuted) {
            demands[..=at].rotate_right(1);
            continue;
        }
        let outputs = compare(&old, &new, &options()).outputs;
        if outputs
            .iter()
            .any(|output| output.verdict != Verdict::Proved)
        {
            let line = right.source.line(right.instrs[mutant.instr].span.start);
            survived.push(format!("line {line}: {}", mutant.describe(&right)));
        }
    }
    survived
}

#[test]
fn each_change_of_a_right_program_is_refuted() {
    let mut unlisted = Vec::new();
    let mut listed: Vec<_> = SURVIVORS
        .iter()
        .map(|(name, change, _)| (*name, *change))
        .collect();
    for function in library::all() {
        for change in survivors(function) {
            match listed
                .iter()
                .position(|known| *known == (function.name, &*change))
            {
                Some(at) => drop(listed.remove(at)),
                None => unlisted.push(format!("{}: {change}", function.name)),
            }
        }
    }
    assert!(unlisted.is_empty(), "survivors:\n{}", unlisted.join("\n"));
    assert_eq!(listed, [], "listed, and refuted");
    assert!(SURVIVORS.iter().all(|(.., reason)| reason.len() > 20));
}
