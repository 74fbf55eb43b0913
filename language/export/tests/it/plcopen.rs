//! Written projects conform to the schema, and read back to the same list; a chart behaves like the step ladder.

use rungc_export::{Body, to_plcopen};
use rungc_frontend::{MOST_CONTACTS, Names, ReadOptions, read_bytes_with};
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::{Model, ModelId};
use rungc_rt::{Class, NoHal, Plc, Program as _};
use rungc_syntax::{Diagnostics, Program, codes};
use std::collections::BTreeSet;
use std::io::Write as _;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Programs whose transcripts the tests of the command line keep.
const DOORS: &str = include_str!("../lists/doors.il");
const ODD: &str = include_str!("../lists/odd.il");
const STEPS: &str = include_str!("../lists/steps.il");

/// Reads a program without errors; charts may take relays from M500 on.
fn read(name: &str, text: &str) -> Program {
    let options = ReadOptions {
        names: Names::parse("*,M500-M899\n").unwrap(),
        ..ReadOptions::default()
    };
    let read = read_bytes_with(name, text.as_bytes(), &options).unwrap();
    assert!(
        read.diagnostics.is_empty(),
        "{text}\n{:?}",
        read.diagnostics
    );
    read.program
}

/// A program as a project that follows the schema, and the messages about it.
fn written(program: &Program, model: ModelId, body: Body) -> (String, Diagnostics) {
    let mut diagnostics = Diagnostics::new();
    let project = to_plcopen(program, Model::get(model), body, &mut diagnostics);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}");
    follows_schema(&project);
    (project, diagnostics)
}

fn instructions(program: &Program) -> Vec<String> {
    program.instrs.iter().map(ToString::to_string).collect()
}

/// Signs of the standard in texts of instructions mean themselves.
#[test]
fn texts_come_back_whole() {
    let texts = [
        "(*c*)", "a(*b", "c*)d", "a\tb", "(a", "a)", "a(b,c)", "p := q", "L:", "a  b", "; a", "//",
    ];
    let rung = |text: &&str| format!("LD X0\n$MOV \"{text}\" D0\nOUT Y0\n");
    let all: String = texts.iter().map(rung).collect();
    let lists = texts.iter().map(|text| rung(text) + "END\n");
    for list in lists.chain([all + "END\n"]) {
        let program = read("list.il", &list);
        for body in [Body::List, Body::Ladder] {
            let (project, messages) = written(&program, ModelId::Fx3u, body);
            assert!(
                messages.iter().all(|m| m.code != codes::PLCOPEN_FORM.id),
                "{list}\n{messages:?}"
            );
            let back = read("plc.xml", &project);
            assert_eq!(instructions(&back), instructions(&program), "{body:?}");
        }
    }
}

/// What would come back as another operand is an error, and nothing is written.
#[test]
fn a_changed_operand_is_an_error() {
    let program = read("list.il", "LD X0\n$MOV \"a\u{1}b\" D0\nOUT Y0\nEND\n");
    for body in [Body::List, Body::Ladder] {
        let mut diagnostics = Diagnostics::new();
        let model = Model::get(ModelId::Fx3u);
        let project = to_plcopen(&program, model, body, &mut diagnostics);
        assert_eq!(project, "");
        let error = diagnostics
            .iter()
            .find(|d| d.code == codes::PLCOPEN_UNDRAWN.id);
        let message = &error.unwrap().message;
        assert_eq!(
            message,
            "`$MOV \"a\u{1}b\" D0` would read back as `$MOV \"ab\" D0`"
        );
    }
}

/// The programs of the documentation, with the models that they are for.
fn examples() -> Vec<(String, ModelId)> {
    let folder = Path::new(env!("RUNGC_ROOT")).join("examples/programs");
    let found = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let lists = found.filter(|path| path.extension().is_some_and(|e| e == "il"));
    lists
        .map(|path| {
            let model = match path.file_stem().unwrap().to_str() {
                Some("cam" | "shear") => ModelId::Hm,
                _ => ModelId::Fx3u,
            };
            (fs::read_to_string(path).unwrap(), model)
        })
        .collect()
}

#[test]
fn programs_read_back_to_the_same_lists() {
    let mut programs = examples();
    assert!(programs.len() > 5);
    programs.extend([DOORS, ODD].map(|list| (list.to_owned(), ModelId::Fx3u)));
    for (list, model) in programs {
        let program = read("program.il", &list);
        for body in [Body::Ladder, Body::List] {
            let (project, messages) = written(&program, model, body);
            let form = |code: &str| code == codes::PLCOPEN_FORM.id;
            assert!(
                !messages.iter().any(|found| form(found.code)),
                "{list}\n{messages:?}"
            );
            let back = read("plc.xml", &project);
            assert_eq!(
                instructions(&back),
                instructions(&program),
                "{list} as {body:?}"
            );
        }
    }
}

/// What is written can be read back; a network of more contacts than that is named, and nothing is drawn of it.
#[test]
fn a_network_has_as_many_contacts_as_can_be_read_back() {
    let network = |operator: &str, contacts: usize| {
        let more = format!("{operator} M1\n").repeat(contacts - 1);
        format!("LD X000\nOUT Y001\nLD M0\n{more}OUT Y000\nEND\n")
    };
    for (body, operator) in [
        (Body::Ladder, "OR"),
        (Body::List, "AND"),
        (Body::List, "OR"),
    ] {
        let program = read("most", &network(operator, MOST_CONTACTS));
        let (project, found) = written(&program, ModelId::Fx3u, body);
        assert!(found.is_empty(), "{found:?}");
        let back = read("back", &project);
        assert_eq!(instructions(&back), instructions(&program));
        let program = read("more", &network(operator, MOST_CONTACTS + 1));
        let mut found = Diagnostics::new();
        let model = Model::get(ModelId::Fx3u);
        assert!(to_plcopen(&program, model, body, &mut found).is_empty());
        let spans: Vec<_> = found.iter().map(|error| (error.code, error.span)).collect();
        let expected = (codes::PLCOPEN_UNDRAWN.id, program.instrs[2].span);
        assert_eq!(spans, [expected]);
    }
    // Of elements in series, fewer are followed.
    let program = read("long", &network("AND", MOST_CONTACTS));
    let mut found = Diagnostics::new();
    to_plcopen(
        &program,
        Model::get(ModelId::Fx3u),
        Body::Ladder,
        &mut found,
    );
    let found: Vec<_> = found.iter().map(|error| error.code).collect();
    assert_eq!(found, [codes::PLCOPEN_UNDRAWN.id]);
}

#[test]
fn a_chart_with_ladders_around_it_follows_the_schema() {
    as_chart(STEPS);
}

/// Checks a project by the schema of TC6, which may not be distributed with rungc: `RUNGC_TC6_SCHEMA` names its file.
fn follows_schema(project: &str) {
    let Some(schema) = env::var_os("RUNGC_TC6_SCHEMA") else {
        eprintln!("skipped: RUNGC_TC6_SCHEMA does not name tc6_xml_v201.xsd");
        return;
    };
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(project.as_bytes()).unwrap();
    let checked = Command::new("xmllint")
        .args(["--noout", "--schema"])
        .arg(schema)
        .arg(file.path())
        .output()
        .expect("xmllint (libxml2-utils) checks schemas");
    assert!(
        checked.status.success(),
        "{}",
        String::from_utf8_lossy(&checked.stderr)
    );
}

#[test]
fn an_action_does_not_change_the_order_of_execution() {
    for jump in ["CJ P0", "CJP P0", "CALLP P0"] {
        let list = format!("LD M8002\nSET S0\nSTL S0\nLD X000\n{jump}\nRET\nFEND\nP0\nSRET\nEND\n");
        let program = read("steps.il", &list);
        let mut diagnostics = Diagnostics::new();
        let model = Model::get(ModelId::Fx3u);
        to_plcopen(&program, model, Body::Chart, &mut diagnostics);
        let refused = diagnostics.iter().map(|found| &found.message);
        let name = jump.split(' ').next().unwrap();
        let expected = format!("S0 contains {name}, which an action of a step cannot do");
        assert!(refused.eq([&expected]), "{jump}: {diagnostics:?}");
    }
}

/// Balls that are sorted by size (h1u-h2u-programming §4.2.3), but that X03, not Y03, lets a flow begin: while S0 waits
/// for it, no state drives Y03.
const BALLS: &str = "\
LD M8002\nSET S0\nLD X01\nAND X03\nANI Y01\nOUT Y07\nSTL S0\nLD X26\nAND Y07\nSET S21\n\
STL S21\nOUT Y00\nOUT T0 K20\nLD T0\nAND X02\nSET S22\nLD T0\nANI X02\nSET S25\nSTL S22\n\
SET Y01\nOUT T1 K10\nLD T1\nSET S23\nSTL S25\nSET Y01\nOUT T1 K10\nLD T1\nSET S26\n\
STL S23\nOUT Y02\nLD X03\nSET S24\nSTL S26\nOUT Y02\nLD X03\nSET S27\nSTL S24\nLDI X04\n\
OUT Y03\nSTL S27\nLDI X05\nOUT Y03\nSTL S24\nLD X04\nSET S30\nSTL S27\nLD X05\nSET S30\n\
STL S30\nOUT Y00\nLD X02\nSET S31\nSTL S31\nRST Y01\nOUT T2 K10\nLD T2\nSET S32\nSTL S32\n\
OUT Y02\nLD X03\nSET S33\nSTL S33\nLDI X01\nOUT Y04\nLD X01\nOUT S0\nRET\nEND\n";

/// A pedestrians' crossing (h1u-h2u-programming §4.2.3).
const CROSSING: &str = "\
LD M8002\nSET S0\nSTL S0\nOUT Y03\nOUT Y05\nLD X00\nOR X01\nSET S21\nSET S30\nSTL S21\n\
OUT Y03\nOUT T0 K300\nLD T0\nSET S22\nSTL S30\nOUT Y05\nLD T2\nSET S31\nSTL S22\nOUT Y02\n\
OUT T1 K100\nLD T1\nSET S23\nSTL S31\nOUT Y06\nOUT T3 K150\nLD T3\nSET S32\nSTL S23\n\
OUT Y01\nOUT T2 K50\nSTL S32\nOUT T4 K5\nLD T4\nSET S33\nSTL S33\nOUT Y06\nOUT C0 K5\n\
OUT T5 K5\nLD C0\nAND T5\nSET S34\nLDI C0\nAND T5\nOUT S32\nSTL S34\nOUT Y05\nRST C0\n\
OUT T6 K50\nSTL S23\nSTL S34\nLD T6\nOUT S0\nRET\nEND\n";

/// Writes a step ladder as a chart, and gives both as programs.
fn as_chart(list: &str) -> [Program; 2] {
    let steps = read("steps.il", list);
    let (project, _) = written(&steps, ModelId::Fx3u, Body::Chart);
    let chart = read("chart.xml", &project);
    let states = chart.instrs.iter();
    assert!(states.clone().all(|instr| instr.mnemonic != "STL"));
    [steps, chart]
}

/// The active states and outputs of two programs after each group of inputs has been on for `scans` scans of 30 ms;
/// `None` where they have not settled.
fn settled(
    programs: &[Program; 2],
    inputs: &[&[u32]],
    scans: u32,
) -> Vec<[Option<Vec<String>>; 2]> {
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        observe_all: true,
        ..CompileOptions::default()
    };
    let modules = programs.each_ref().map(|program| {
        let compiled = compile(program, &options);
        assert!(!compiled.diagnostics.has_errors());
        compiled.module.unwrap()
    });
    let mut machines = modules.each_ref().map(Machine::new);
    let mut found = Vec::new();
    for (nth, input) in (0..).zip(inputs) {
        found.push(machines.each_mut().map(|machine| {
            let mut last = Vec::new();
            for scan in 0..scans {
                for number in 0..0o50 {
                    machine.set_bit(Class::X, number, input.contains(&number));
                }
                machine.scan(&mut NoHal, (nth * scans + scan) * 30, 10_000);
                if scan + 5 >= scans {
                    let machine = &*machine;
                    let on = |class, name: &str, count: u32| {
                        let on = (0..count).filter(|n| machine.bit(class, *n) == Some(true));
                        on.map(|n| format!("{name}{n}")).collect::<Vec<_>>()
                    };
                    last.push([on(Class::S, "S", 100), on(Class::Y, "Y", 16)].concat());
                }
            }
            last.dedup();
            (last.len() == 1).then(|| last.remove(0))
        }));
    }
    found
}

#[test]
fn the_flows_of_the_manual_behave_alike_as_charts() {
    let balls: &[&[u32]] = &[
        &[1, 3, 22],
        &[5],
        &[2],
        &[3],
        &[1],
        &[1, 2, 3, 22],
        &[4],
        &[2],
        &[3],
        &[1],
    ];
    let crossing: &[&[u32]] = &[&[], &[0], &[], &[], &[1], &[]];
    // Each group stays longer than the slowest timer runs.
    for (list, inputs, least) in [(BALLS, balls, 6), (CROSSING, crossing, 3)] {
        let programs = as_chart(list);
        let mut states = BTreeSet::new();
        for [steps, chart] in settled(&programs, inputs, 1100) {
            assert!(steps.is_some());
            assert_eq!(steps, chart);
            states.extend(steps);
        }
        assert!(states.len() >= least, "{states:?}");
    }
}

/// The first of the inputs that only actions read: one that led on, too, would find another step active in a chart.
const ACTION: u32 = 0o40;

/// A flow of states with choices, and with parallel branches that meet.
fn flow(rng: &mut impl FnMut(u32) -> u32) -> String {
    let mut list = "LD M8002\nSET S0\n".to_owned();
    let states = [0, 20, 21, 22, 23, 24, 25];
    for (nth, state) in states.into_iter().enumerate() {
        list += &format!("STL S{state}\nOUT Y{:o}\n", rng(5));
        list += &format!("LD X{:o}\nINV\nOUT Y{:o}\n", ACTION + rng(4), 5 + rng(2));
        list += &format!(
            "LDI X{:o}\nMPS\nOR X0\nOUT Y7\nMPP\nSET Y{:o}\n",
            ACTION + rng(4),
            8 + rng(2)
        )
        .replace("OR X0\n", "ANI X0\n");
        list += &format!("LD X{:o}\nRST Y{:o}\n", ACTION + rng(4), 8 + rng(2));
        let first = rng(8);
        for (way, input) in [(0, first), (1, 8 + first)]
            .into_iter()
            .take(1 + rng(2) as usize)
        {
            let to = states[(nth + 1 + rng(5) as usize + way) % states.len()];
            if to == state {
                continue;
            }
            list += &format!("LD X{input:o}\nAND X{input:o}\nOR X{:o}\n", first + 16);
            if way == 1 {
                list += &format!("ANI X{:o}\n", first + 16);
            }
            list += &format!("{} S{to}\n", if rng(2) == 0 { "SET" } else { "OUT" });
        }
        if state == 22 {
            list += "LD X30\nSET S30\nSET S31\n";
        }
    }
    list += "STL S30\nOUT Y12\nLD X31\nSET S32\nSTL S31\nOUT Y13\nSTL S32\nOUT Y14\nSTL S31\nSTL S32\nLD X32\nSET S0\nRET\nEND\n";
    list
}

#[test]
fn random_flows_behave_alike_as_charts() {
    let mut seed = 1_u64;
    let mut rng = |below: u32| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as u32 % below
    };
    let mut compared = 0;
    for _ in 0..25 {
        let list = flow(&mut rng);
        let programs = as_chart(&list);
        // Before each input there is none: a state that ends has not seen it before.
        let inputs = (0..80).map(|nth| match (nth % 2, rng(5)) {
            (0, _) => Vec::new(),
            (_, 0) => vec![ACTION + rng(4)],
            _ => vec![rng(27)],
        });
        let inputs: Vec<_> = inputs.collect();
        let inputs: Vec<_> = inputs.iter().map(Vec::as_slice).collect();
        // Flows that an input leads in a circle drift apart.
        let found = settled(&programs, &inputs, 30);
        for [steps, chart] in found
            .into_iter()
            .take_while(|found| found.iter().all(Option::is_some))
        {
            assert_eq!(steps, chart, "{list}");
            compared += 1;
        }
    }
    assert!(compared > 300, "{compared}");
}
