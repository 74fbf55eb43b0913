//! Written tests of random violated programs: each parses, fails on its program, and passes on a program that is
//! proved to have the property.

use super::{Names, case, outcomes, quoted};
use crate::model::World;
use crate::property::tests::{any, pick};
use crate::prove::{Options, Verdict, decide, system};
use crate::random::{Lanes, Random};
use crate::replay::replay;
use crate::search::Trace;
use crate::tests::observing;
use rungc_sim::property::{Condition, Property, parse};
use rungc_syntax::DeviceClass::{self, C, D, M, S, T, Y};
use std::collections::BTreeSet;
use std::time::Duration;

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

/// A program and a question about it.
struct Tried<'a> {
    rungs: &'a [String],
    property: &'a Property,
    options: &'a Options,
}

impl Tried<'_> {
    /// The program without one of its rungs, or with all.
    fn list(&self, without: Option<usize>) -> String {
        let rungs = self.rungs.iter().enumerate();
        let rungs = rungs.filter(|(n, _)| Some(*n) != without);
        rungs
            .map(|(_, rung)| rung.as_str())
            .chain(["END\n"])
            .collect()
    }

    /// A run by chance that the interpreter confirms.
    fn run(&self, without: Option<usize>, random: &mut Random) -> Option<Trace> {
        let module = observing(&self.list(without), self.property);
        let (_, system) = system(&module, self.property, self.options);
        let mut lanes = Lanes::new(&system, random);
        for scan in 0..20 {
            let ms = if scan == 0 {
                0
            } else {
                pick(&[1, 10, 10, 60], random)
            };
            lanes.scan(ms, random.below(3) > 0, random);
            let found = lanes.value(system.bad);
            if found != 0 {
                let trace = lanes.trace(found.trailing_zeros());
                return replay(&module, self.property, &[], &trace).map(|scans| Trace {
                    scans: trace.scans[..scans].to_vec(),
                    ..trace
                });
            }
        }
        None
    }

    fn is_proved(&self, without: usize) -> bool {
        let module = observing(&self.list(Some(without)), self.property);
        decide(&module, self.property, self.options).verdict == Verdict::Proved
    }

    /// Why a test fails on such a program, if it does.
    fn outcome(&self, case: &str, without: Option<usize>) -> Option<String> {
        let list = quoted(&self.list(without));
        let text = format!("topic = \"t\"\nmodel = \"fx3u\"\nprogram = {list}\n{case}");
        let outcomes = outcomes("t.plctest.toml", &text);
        let outcomes = outcomes.unwrap_or_else(|why| panic!("{why}\n{text}"));
        assert_eq!(outcomes.len(), 1);
        outcomes.into_iter().next().flatten()
    }
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

#[test]
fn a_written_test_fails_on_its_program_and_passes_on_a_repaired_one() {
    let mut random = Random::new();
    let (mut violated, mut repaired) = (0, 0);
    for _ in 0..500 {
        let rungs: Vec<String> = (0..4).map(|_| rung(&mut random)).collect();
        let property = property(&mut random);
        let options = Options {
            world: World {
                free: free(&mut random),
                ..World::default()
            },
            assumed: Vec::new(),
            time: Duration::from_millis(200),
        };
        let tried = Tried {
            rungs: &rungs,
            property: &property,
            options: &options,
        };
        let Some(trace) = tried.run(None, &mut random) else {
            continue;
        };
        let name = Names::default().name("a run\n that \u{202E}was found");
        let module = observing(&tried.list(None), &property);
        let case = case(&name, &module, &property, &trace);
        let outcome = tried.outcome(&case, None);
        let context = || format!("{}\n{case}\n{outcome:?}\n{options:?}", tried.list(None));
        assert_eq!(outcome.is_none(), property.is_wanted(), "{}", context());
        violated += 1;
        for without in 0..rungs.len() {
            let is_searched = repaired < 10 && !property.is_wanted();
            if is_searched
                && tried.run(Some(without), &mut random).is_none()
                && tried.is_proved(without)
            {
                let outcome = tried.outcome(&case, Some(without));
                assert_eq!(outcome, None, "without {without}: {}", context());
                repaired += 1;
            }
        }
    }
    let found = format!("{violated} violated, {repaired} repaired");
    assert!(violated > 200 && repaired > 5, "{found}");
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
            holds: read("Y0"),
            until: off,
        },
    ]
    .iter()
    .map(super::rule)
    .collect::<Vec<_>>();
    insta::assert_snapshot!(lines.join("\n"));
}
