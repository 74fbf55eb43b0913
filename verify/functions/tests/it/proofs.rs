//! Safety functions: of each, the right program has all properties, the wrong one lacks the one that its page names,
//! and every change of an instruction of the right program is refuted, proved to change nothing, or listed here with a
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
use rungc_verify::prove::{Options, Verdict, decide};
use rungc_verify::same::compare;
use std::path::Path;

/// Changes that no demand refutes although they change outputs, with the reason why each is none of the function's.
const SURVIVORS: &[(&str, &[(&str, &str)])] = &[
    (
        "two-hand",
        &[
            (
                "line 1: LD X000 was bridged",
                "the time since the first button always runs: nothing starts after half a second from power-on",
            ),
            (
                "line 3: OUT T0 K4 instead of OUT T0 K5",
                "the buttons must be pressed within 400 ms, which is stricter",
            ),
            (
                "line 6: OR Y000 was left out",
                "the output does not hold itself: it ends with M0, a scan after it has begun",
            ),
            (
                "line 13: AND Y000 instead of ANI Y000",
                "M0 lasts for a scan after the release: both buttons must be pressed in the next one",
            ),
        ],
    ),
    (
        "emergency-stop",
        &[
            (
                "line 2: OR M0 was left out",
                "the machine is enabled for the scan of the reset only, and the output with it",
            ),
            (
                "line 6: OR Y000 was left out",
                "the output does not hold itself: it is on in the scan of the start only",
            ),
        ],
    ),
    (
        "guard",
        &[
            (
                "line 2: OR Y000 was left out",
                "the output does not hold itself: it is on in the scan of the start only",
            ),
            (
                "line 8: OUT T0 K20 instead of OUT T0 K10",
                "the lock opens 2 s after the movement, and 1 s is demanded at least",
            ),
            (
                "line 8: OUT T0 K11 instead of OUT T0 K10",
                "the lock opens 1.1 s after the movement, and 1 s is demanded at least",
            ),
            (
                "line 5: AND X002 instead of ANI X002",
                "the movement runs only during the request to open; the lock still waits for its end",
            ),
            (
                "line 5: ANI X002 was left out",
                "the request to open does not end the movement; the lock waits until something else does",
            ),
            (
                "line 9: LDI X002 instead of LD X002",
                "the lock opens where no one requests it, but only at rest",
            ),
            (
                "line 9: LD X002 was bridged",
                "the lock opens without a request, but only at rest",
            ),
        ],
    ),
    (
        "mode-selection",
        &[
            (
                "line 1: LDI X000 instead of LD X000",
                "automatic is on where both switches are off, and manual needs X001",
            ),
            (
                "line 1: LD X000 was bridged",
                "automatic is on whenever X001 is off, and manual needs X001",
            ),
            (
                "line 2: AND X001 instead of ANI X001",
                "automatic needs both switches, and manual needs X000 off",
            ),
            (
                "line 2: ANI X001 was left out",
                "X000 has priority: line 5 still excludes both modes at once",
            ),
            (
                "line 4: LDI X001 instead of LD X001",
                "manual is on where both switches are off, and automatic needs X000",
            ),
            (
                "line 4: LD X001 was bridged",
                "manual is on whenever X000 is off, and automatic needs X000",
            ),
            (
                "line 5: AND X000 instead of ANI X000",
                "manual needs both switches, and automatic needs X001 off",
            ),
            (
                "line 5: ANI X000 was left out",
                "X001 has priority: line 2 still excludes both modes at once",
            ),
            (
                "line 11: OR Y000 was left out",
                "the output does not hold itself: it is on in the scan of the start only",
            ),
        ],
    ),
    (
        "muting",
        &[
            (
                "line 1: LD X001 was bridged",
                "the time since the first sensor always runs: no muting begins after the first second",
            ),
            (
                "line 3: OUT T0 K9 instead of OUT T0 K10",
                "the sensors must be covered within 900 ms, which is stricter",
            ),
            (
                "line 10: OUT T1 K19 instead of OUT T1 K20",
                "muting ends after 1.9 s, and 2 s are the most that is allowed",
            ),
            (
                "line 13: SET Y001 instead of OUT Y001",
                "the lamp stays on after the first muting, and is on during each",
            ),
        ],
    ),
    (
        "hold-to-run",
        &[(
            "line 2: OR Y000 was left out",
            "the output does not hold itself: it is on in a scan after the release of the button only",
        )],
    ),
    (
        "reversing",
        &[
            (
                "line 1: LDI X000 instead of LD X000",
                "forward runs without its button; dead time and interlocks are the same",
            ),
            (
                "line 1: LD X000 was bridged",
                "forward starts by itself; dead time and interlocks are the same",
            ),
            (
                "line 2: ORI Y000 instead of OR Y000",
                "forward starts by itself while it is off; dead time and interlocks are the same",
            ),
            (
                "line 2: OR Y000 was left out",
                "forward runs only while its button is pressed",
            ),
            (
                "line 3: AND X001 instead of ANI X001",
                "forward runs only with the button of backward; the dead time keeps both apart",
            ),
            (
                "line 3: ANI X001 was left out",
                "the button of backward does not end forward; the dead time keeps both apart",
            ),
            (
                "line 9: LDI X001 instead of LD X001",
                "backward runs without its button; dead time and interlocks are the same",
            ),
            (
                "line 9: LD X001 was bridged",
                "backward starts by itself; dead time and interlocks are the same",
            ),
            (
                "line 10: ORI Y001 instead of OR Y001",
                "backward starts by itself while it is off; dead time and interlocks are the same",
            ),
            (
                "line 10: OR Y001 was left out",
                "backward runs only while its button is pressed",
            ),
            (
                "line 11: AND X000 instead of ANI X000",
                "backward runs only with the button of forward; the dead time keeps both apart",
            ),
            (
                "line 11: ANI X000 was left out",
                "the button of forward does not end backward; the dead time keeps both apart",
            ),
            (
                "line 8: OUT T0 K10 instead of OUT T0 K5",
                "backward waits for 1 s, and 500 ms are demanded at least",
            ),
            (
                "line 8: OUT T0 K6 instead of OUT T0 K5",
                "backward waits for 600 ms, and 500 ms are demanded at least",
            ),
            (
                "line 16: OUT T1 K10 instead of OUT T1 K5",
                "forward waits for 1 s, and 500 ms are demanded at least",
            ),
            (
                "line 16: OUT T1 K6 instead of OUT T1 K5",
                "forward waits for 600 ms, and 500 ms are demanded at least",
            ),
        ],
    ),
    (
        "movement-time-out",
        &[
            (
                "line 1: LD Y000 was bridged",
                "the time always runs: the fault comes 2 s after power-on, and keeps the movement off",
            ),
            (
                "line 2: OUT T0 K19 instead of OUT T0 K20",
                "the fault comes after 1.9 s, and 2.2 s are the most that is allowed",
            ),
            (
                "line 5: AND M0 was left out",
                "the fault is on except in the scan of a reset, and keeps the movement off",
            ),
            (
                "line 7: SET M0 instead of OUT M0",
                "the fault lasts until power-off, and keeps the movement off",
            ),
            (
                "line 8: LDI X000 instead of LD X000",
                "the movement starts without its command; the limit of its time is the same",
            ),
            (
                "line 8: LD X000 was bridged",
                "the movement starts by itself; the limit of its time is the same",
            ),
        ],
    ),
    (
        "star-delta",
        &[
            (
                "line 1: LDI X000 instead of LD X000",
                "the motor starts without its command; how star changes to delta is the same",
            ),
            (
                "line 1: LD X000 was bridged",
                "the motor starts by itself; how star changes to delta is the same",
            ),
            (
                "line 2: ORI Y000 instead of OR Y000",
                "the motor starts by itself, and runs on only while its button is pressed",
            ),
            (
                "line 2: OR Y000 was left out",
                "the motor runs while its button is pressed",
            ),
            (
                "line 3: AND X001 instead of ANI X001",
                "the stop button acts the other way round; when the motor stops is not part of the function",
            ),
            (
                "line 3: ANI X001 was left out",
                "nothing stops the motor; when it stops is not part of the function",
            ),
            (
                "line 4: SET Y000 instead of OUT Y000",
                "nothing stops the motor; when it stops is not part of the function",
            ),
            (
                "line 7: ANI T2 instead of AND T2",
                "star ends after 200 ms, and delta never comes: it takes more than the effort of this test to prove that",
            ),
            (
                "line 9: OUT T0 K19 instead of OUT T0 K20",
                "star lasts 1.9 s, and 2.2 s are the most that is allowed",
            ),
            (
                "line 15: OUT T1 K4 instead of OUT T1 K2",
                "a pause of 0.4 s, and 0.2 s are the least that is allowed",
            ),
            (
                "line 15: OUT T1 K3 instead of OUT T1 K2",
                "a pause of 0.3 s, and 0.2 s are the least that is allowed",
            ),
            (
                "line 20: OUT T2 K4 instead of OUT T2 K2",
                "a pause of 0.4 s before star, and 0.2 s are the least that is allowed",
            ),
            (
                "line 20: OUT T2 K3 instead of OUT T2 K2",
                "a pause of 0.3 s before star, and 0.2 s are the least that is allowed",
            ),
        ],
    ),
];

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

fn options(effort: u64) -> Options {
    Options {
        effort,
        ..Options::default()
    }
}

/// Returns true if a program lacks a property; else the reason why that is not decided.
fn lacks(module: &Module, property: &Property, effort: u64) -> Result<bool, String> {
    match decide(module, property, &options(effort)).verdict {
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
            let verdict = lacks(&right, property, 60_000);
            if verdict != Ok(false) {
                wrong.push(format!("right: {name}: {verdict:?}"));
            }
        }
        let violated = format!("{}: {}", function.name, function.violates);
        let demand = demands.iter().find(|(name, _)| *name == violated).unwrap();
        let module = module(&program(function.wrong), &demands).unwrap();
        let verdict = lacks(&module, &demand.1, 60_000);
        if verdict != Ok(true) {
            wrong.push(format!("wrong: {violated}: {verdict:?}"));
        }
    }
    assert_eq!(wrong, [""; 0], "\n{}", wrong.join("\n"));
}

/// Changes of the right program that no demand refutes, that change outputs and that are not listed.
fn survivors(function: &Function) -> Vec<String> {
    let known = SURVIVORS.iter().filter(|(name, _)| *name == function.name);
    let known = known.flat_map(|(_, changes)| *changes);
    let mut listed: Vec<&str> = known.map(|(change, _)| *change).collect();
    let mut demands = demands(function);
    let right = program(function.right);
    let old = module(&right, &demands).unwrap();
    let mut survived = Vec::new();
    for mutant in of_program(&right, Model::get(ModelId::Fx3u)) {
        let line = right.source.line(right.instrs[mutant.instr].span.start);
        let change = format!("line {line}: {}", mutant.describe(&right));
        if let Some(at) = listed.iter().position(|known| *known == change) {
            listed.remove(at);
            continue;
        }
        let Some(new) = module(&mutant.applied(&right), &demands) else {
            continue;
        };
        let is_refuted =
            |(_, property): &(String, Property)| lacks(&new, property, 2_000) == Ok(true);
        if let Some(at) = demands.iter().position(is_refuted) {
            // Demands that have refuted a mutant are likely to refute the next.
            demands[..=at].rotate_right(1);
            continue;
        }
        let outputs = compare(&old, &new, &options(4_000)).outputs;
        let mut verdicts = outputs.iter().map(|output| &output.verdict);
        if verdicts.any(|verdict| *verdict != Verdict::Proved) {
            survived.push(format!("{}: {change}", function.name));
        }
    }
    let gone = listed
        .iter()
        .map(|change| format!("{}: {change}: not a change", function.name));
    survived.extend(gone);
    survived
}

/// Functions with timers that end a state: their changes take longer to judge than those of all others.
const LONG: [&str; 3] = ["muting", "movement-time-out", "star-delta"];

fn hold(functions: impl Iterator<Item = &'static Function>) {
    let survived: Vec<String> = functions.flat_map(survivors).collect();
    assert!(survived.is_empty(), "survivors:\n{}", survived.join("\n"));
}

#[test]
fn each_change_of_a_right_program_is_refuted() {
    hold(library::all().filter(|function| !LONG.contains(&function.name)));
}

#[test]
fn each_change_of_muting_is_refuted() {
    hold(library::all().filter(|function| function.name == LONG[0]));
}

#[test]
fn each_change_of_a_time_out_is_refuted() {
    hold(library::all().filter(|function| function.name == LONG[1]));
}

#[test]
fn each_change_of_star_delta_is_refuted() {
    hold(library::all().filter(|function| function.name == LONG[2]));
}
