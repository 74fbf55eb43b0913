//! Written tests of random violated programs.

use super::{Names, case, outcomes, quoted};
use crate::effort::Limit;
use crate::model::World;
use crate::property::tests::{any, pick};
use crate::prove::{Options, system};
use crate::random::{Lanes, Random};
use crate::replay::replay;
use crate::search::Trace;
use crate::steered::{Plant, Steered, Surroundings};
use crate::tests::{compiled_for, observing};
use rungc_ir::Module;
use rungc_models::ModelId;
use rungc_sim::property::{Condition, Property, parse};
use rungc_syntax::DeviceClass::{self, C, D, M, S, T, Y};
use std::collections::BTreeSet;

/// A rung: contacts and an instruction.
fn rung(random: &mut Random) -> String {
    let contact = |random: &mut Random| {
        let bits = [
            "X0", "X1", "X2", "M0", "M1", "M2", "M5", "Y0", "Y1", "T0", "C0", "S20", "M8002",
            "M8013",
        ];
        pick(&bits, random)
    };
    let first = match random.below(4) {
        0 => format!(
            "LD{} D{} K{}",
            pick(&[">", "<", "="], random),
            random.below(3),
            random.below(4)
        ),
        _ => format!(
            "{} {}",
            pick(&["LD", "LDI", "LDP", "LDF"], random),
            contact(random)
        ),
    };
    let more = match random.below(2) {
        0 => format!(
            "\n{} {}",
            pick(&["AND", "ANI", "OR", "ORI"], random),
            contact(random)
        ),
        _ => String::new(),
    };
    let output = pick(
        &[
            "OUT Y0",
            "OUT Y1",
            "OUT M0",
            "OUT M1",
            "SET Y2",
            "RST Y2",
            "SET M2",
            "RST M2",
            "OUT T0 K2",
            "OUT C0 K2",
            "RST C0",
            "OUT C200 K2",
            "MOV K3 D0",
            "INCP D0",
            "ADD D0 K1X000 D1",
            "MOV D1 K2M0",
            "PLS M5",
            "ALTP Y1",
            "MOV K4X000 D2",
            "SET S20",
            "RST S20",
            "OUT M8034",
            "MOV K1X0 K1Y4",
            "DECP D2",
            "OUT T200 K5",
            "MUL D0 D1 D4",
            "OUT M8200",
        ],
        random,
    );
    format!("{first}{more}\n{output}\n")
}

fn property(random: &mut Random) -> Property {
    let condition = |random: &mut Random| {
        let text = any(2, random).text;
        parse(&text, &|_| Vec::new()).unwrap_or_else(|mistake| panic!("{text}: {mistake:?}"))
    };
    match random.below(5) {
        0 => Property::Never(condition(random)),
        1 => Property::Always(condition(random)),
        2 => Property::Reachable(condition(random)),
        3 => Property::Stays {
            after: (random.below(2) == 0).then(|| condition(random)),
            holds: condition(random),
            until: condition(random),
        },
        _ => Property::Whenever {
            when: condition(random),
            then: condition(random),
            within_ms: pick(&[0, 10, 50, 200], random),
        },
    }
}

/// A run by chance that the interpreter confirms.
fn found(
    module: &Module,
    property: &Property,
    options: &Options,
    random: &mut Random,
) -> Option<Trace> {
    let (_, system) = system(module, property, options);
    let mut lanes = Lanes::new(&system, random);
    for scan in 0..20 {
        let ms = match scan {
            0 => 0,
            _ => pick(&[1, 10, 10, 60], random),
        };
        lanes.scan(ms, random.below(3) > 0, random);
        let found = lanes.value(system.bad);
        if found != 0 {
            let trace = lanes.trace(found.trailing_zeros());
            return replay(module, property, &[], &trace).map(|scans| Trace {
                scans: trace.scans[..scans].to_vec(),
                ..trace
            });
        }
    }
    None
}

/// Devices that something else writes, even if the program does.
fn free(random: &mut Random) -> BTreeSet<(DeviceClass, u32)> {
    let all = [
        (M, 0),
        (M, 2),
        (Y, 1),
        (D, 0),
        (S, 20),
        (T, 0),
        (C, 0),
        (C, 200),
        (D, 2),
    ];
    let free = all.into_iter().filter(|_| random.below(5) == 0);
    free.collect()
}

/// `golden` holds written tests to repaired programs, too.
#[test]
fn a_written_test_is_read_and_fails_on_its_program() {
    let mut random = Random::new();
    let mut violated = 0;
    for _ in 0..300 {
        let rungs: String = (0..4).map(|_| rung(&mut random)).collect();
        let list = format!("{rungs}END\n");
        let property = property(&mut random);
        let options = Options {
            world: World {
                free: free(&mut random),
                ..World::default()
            },
            ..Options::default()
        };
        let module = observing(&list, &property);
        let Some(trace) = found(&module, &property, &options, &mut random) else {
            continue;
        };
        let name = Names::default().name("a run\n that \u{202E}was found");
        let case = case(&name, &module, &property, &trace);
        let list = quoted(&list);
        let text = format!("topic = \"t\"\nmodel = \"fx3u\"\nprogram = {list}\n{case}");
        let outcomes = outcomes("t.plctest.toml", &text);
        let [outcome] = &outcomes.unwrap_or_else(|why| panic!("{why}\n{text}"))[..] else {
            panic!("one case: {text}");
        };
        let context = format!("{text}\n{outcome:?}\n{options:?}");
        assert_eq!(outcome.is_none(), property.is_wanted(), "{context}");
        violated += 1;
    }
    assert!(violated > 200, "{violated} violated");
}

/// A program with routines that run between scans: on edges, periods of time and counts.
fn with_routines(model: ModelId, random: &mut Random) -> String {
    let mut list = "EI\n".to_string();
    let count = 1 + random.below(3);
    list.extend((0..count).map(|_| rung(random)));
    if random.below(3) > 0 {
        let compares = [
            "DHSCS K2 C235 Y003",
            "DHSCR K3 C235 Y003",
            "DHSCS D10 C235 M6",
            "DHSCS K2 C235 I010",
            "DHSZ K1 K3 C235 Y004",
        ];
        let known = if model == ModelId::Fx1n { 3 } else { 5 };
        let compare = pick(&compares[..known], random);
        list.push_str(&format!("LD M8000\nOUT C235 K3\n{compare}\n"));
        list.push_str("LDD> C235 K1\nOUT Y005\nLD C235\nRST C235\n");
    }
    if random.below(3) == 0 {
        list.push_str("LD M8173\nOUT Y006\nLD X007\nRST M8173\n");
    }
    list.push_str("FEND\n");
    let pointers: &[&[&str]] = match model {
        ModelId::Fx1n => &[&["I101", "I100"], &["I201", "I200"]],
        ModelId::Hm => &[&["I000"], &["I100", "I101"], &["I610", "I615"], &["I010"]],
        _ => &[
            &["I101", "I100"],
            &["I201", "I200"],
            &["I610", "I615"],
            &["I010"],
        ],
    };
    for pointers in pointers {
        if random.below(2) == 0 || list.contains(" I010") && pointers.contains(&"I010") {
            let pointer = pick(pointers, random);
            list.push_str(&format!("{pointer}\n{}IRET\n", rung(random)));
        }
    }
    list + "END\n"
}

/// A run by chance on the interpreter.
fn found_there(module: &Module, property: &Property, options: &Options) -> Option<Trace> {
    let (encoder, system) = system(module, property, options);
    let surroundings = Surroundings::new(&encoder, &system, options.world.scan_ms);
    let plant = Plant::new(module, property, &[], &Limit::none());
    let (outside, watched) = (surroundings.outside, surroundings.watched);
    let mut search = Steered::new(plant, outside, watched, (1, 64));
    let trace = search.search(&|scans| scans > 200)?.trace();
    assert!(replay(module, property, &[], &trace).is_some(), "{trace:?}");
    Some(trace)
}

#[test]
fn a_run_with_routines_between_scans_happens_as_a_test() {
    let mut random = Random::new();
    for model in [ModelId::Fx1n, ModelId::Fx3u, ModelId::H2u, ModelId::Hm] {
        let (mut violated, mut wrong) = (0, Vec::new());
        for _ in 0..100 {
            let list = with_routines(model, &mut random);
            let property = property(&mut random);
            let options = Options {
                world: World {
                    free: free(&mut random),
                    scan_ms: 30,
                    ..World::default()
                },
                ..Options::default()
            };
            let conditions = property.conditions().into_iter();
            let devices = conditions.flat_map(Condition::devices).collect();
            let Ok(module) = compiled_for(Some(model), &list, devices) else {
                continue;
            };
            let Some(trace) = found_there(&module, &property, &options) else {
                continue;
            };
            let case = case("a run", &module, &property, &trace);
            let (name, program) = (module.model.name, quoted(&list));
            let text = format!("topic = \"t\"\nmodel = \"{name}\"\nprogram = {program}\n{case}");
            let outcomes = outcomes("t.plctest.toml", &text);
            let outcomes = outcomes.unwrap_or_else(|why| panic!("{why}\n{text}"));
            violated += 1;
            if (outcomes == [None]) != property.is_wanted() {
                wrong.push(format!("{list}\n{case}\n{outcomes:?}\n{options:?}"));
            }
        }
        assert!(wrong.is_empty(), "{}", wrong[0]);
        assert!(violated > 10, "{model:?}: {violated} violated");
    }
}

#[test]
fn names_are_there_once_and_in_one_line() {
    let mut names = Names::default();
    let all = [
        "never X000",
        "never  X000",
        "never\nX000",
        "",
        "never X000 (2)",
    ]
    .map(|name| names.name(name));
    assert_eq!(
        all,
        [
            "never X000",
            "never X000 (2)",
            "never X000 (3)",
            "",
            "never X000 (2) (2)"
        ]
    );
}

#[test]
fn properties_are_lines_of_a_case() {
    let read = |text: &str| parse(text, &|_| Vec::<rungc_sim::Target>::new()).unwrap();
    let off = Condition::Constant(false);
    let lines = [
        Property::Never(read("Y0 & Y1")),
        Property::Always(read("D0 - was(D0) < 5")),
        Property::Reachable(read("X0 for 2s")),
        Property::Whenever {
            when: read("X0"),
            then: read("!Y0"),
            within_ms: 50,
        },
        Property::Stays {
            after: None,
            holds: read("Y0"),
            until: off,
        },
    ]
    .iter()
    .map(super::rule)
    .collect::<Vec<_>>();
    insta::assert_snapshot!(lines.join("\n"));
}
