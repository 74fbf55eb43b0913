//! Written tests of random violated programs.

use super::{Names, case, outcomes, quoted};
use crate::model::World;
use crate::property::tests::{any, pick};
use crate::prove::{Options, system};
use crate::random::{Lanes, Random};
use crate::replay::replay;
use crate::search::Trace;
use crate::tests::observing;
use rungc_ir::Module;
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
