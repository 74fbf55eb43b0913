//! Function blocks of PLCopen XML behave as IEC 61131-3 describes them (edition 2, tables 34 to 38): drawn,
//! read, compiled and executed with random inputs, and compared with the standard's own bodies.

use rungc_frontend::{Names, ReadOptions, read_bytes_with};
use rungc_golden::rng::Rng;
use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::{Class, NoHal, Plc, Program};

/// Milliseconds of a scan.
const SCAN: u32 = 30;
/// Inputs of the diagram.
const INPUTS: usize = 5;

/// A diagram while it is drawn.
#[derive(Default)]
struct Diagram {
    elements: String,
    variables: String,
    ids: u32,
}

impl Diagram {
    fn id(&mut self) -> u32 {
        self.ids += 1;
        self.ids
    }

    /// Adds the source of a variable or constant.
    fn source(&mut self, expression: &str) -> u32 {
        let id = self.id();
        self.elements += &format!(
            r#"<inVariable localId="{id}"><position x="0" y="{id}"/><connectionPointOut/><expression>{expression}</expression></inVariable>"#
        );
        id
    }

    /// A block with expressions at its inputs and variables at its outputs.
    fn block(&mut self, kind: &str, name: &str, inputs: &[(&str, &str)], outputs: &[(&str, &str)]) {
        let inputs: Vec<_> = inputs
            .iter()
            .map(|(pin, expression)| (*pin, self.source(expression)))
            .collect();
        let inputs: String = inputs
            .iter()
            .map(|(pin, from)| {
                format!(
                    r#"<variable formalParameter="{pin}"><connectionPointIn><connection refLocalId="{from}"/></connectionPointIn></variable>"#
                )
            })
            .collect();
        let pins: String = outputs
            .iter()
            .map(|(pin, _)| {
                format!(r#"<variable formalParameter="{pin}"><connectionPointOut/></variable>"#)
            })
            .collect();
        let id = self.id();
        self.elements += &format!(
            r#"<block localId="{id}" typeName="{kind}" instanceName="{name}"><position x="1" y="{id}"/><inputVariables>{inputs}</inputVariables><inOutVariables/><outputVariables>{pins}</outputVariables></block>"#
        );
        self.variables +=
            &format!(r#"<variable name="{name}"><type><derived name="{kind}"/></type></variable>"#);
        for (pin, variable) in outputs {
            let to = self.id();
            self.elements += &format!(
                r#"<outVariable localId="{to}"><position x="2" y="{to}"/><connectionPointIn><connection refLocalId="{id}" formalParameter="{pin}"/></connectionPointIn><expression>{variable}</expression></outVariable>"#
            );
        }
    }

    fn project(&self) -> String {
        format!(
            r#"<project xmlns="http://www.plcopen.org/xml/tc6_0201"><types><pous><pou name="main" pouType="program"><interface><localVars>{}</localVars></interface><body><FBD>{}</FBD></body></pou></pous></types></project>"#,
            self.variables, self.elements
        )
    }
}

/// Runs a diagram: before each scan `X0` to `X4` take random values, after it the closure sees them and the machine.
fn run(
    diagram: &Diagram,
    scans: u32,
    likely: u32,
    mut after: impl FnMut(u32, [bool; INPUTS], &Machine<'_>),
) {
    let options = ReadOptions {
        names: Names::parse("*,M100-M199\n*,T0-T62\n*,T200-T245\n*,C0-C99\n*,D100-D199\n").unwrap(),
        ..ReadOptions::default()
    };
    let read = read_bytes_with("diagram.xml", diagram.project().as_bytes(), &options).unwrap();
    let found: Vec<_> = read.diagnostics.iter().map(|d| d.message.clone()).collect();
    assert!(found.is_empty(), "{found:?}");
    let options = CompileOptions {
        model: Some(ModelId::Fx3u),
        optimise: true,
        observe_all: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    assert!(
        !compiled.diagnostics.has_errors(),
        "{:?}",
        compiled.diagnostics
    );
    let module = compiled.module.unwrap();
    for seed in 0..8 {
        let mut rng = Rng::new(seed);
        let mut machine = Machine::new(&module);
        let mut inputs = [false; INPUTS];
        for scan in 0..scans {
            for (number, on) in (0..).zip(&mut inputs) {
                if rng.percent(likely) {
                    *on = !*on;
                }
                machine.set_bit(Class::X, number, *on);
            }
            machine.scan(&mut NoHal, scan * SCAN, 10_000);
            after(scan, inputs, &machine);
        }
    }
}

fn bit(machine: &Machine<'_>, number: u32) -> bool {
    machine.bit(Class::M, number).unwrap()
}

fn word(machine: &Machine<'_>, number: u32) -> i16 {
    machine.word(Class::D, number).unwrap()
}

#[test]
fn timers() {
    let mut diagram = Diagram::default();
    let preset = ("PT", "T#300ms");
    for (kind, input, output) in [("TON", "X0", "M0"), ("TOF", "X1", "M1"), ("TP", "X2", "M2")] {
        diagram.block(kind, kind, &[("IN", input), preset], &[("Q", output)]);
    }
    let mut state = (0, [None::<u32>; 3], [false; 3], false);
    run(&diagram, 600, 12, |scan, inputs, machine| {
        if scan == 0 {
            state = Default::default();
        }
        let now = scan * SCAN;
        let (_, since, q, before) = &mut state;
        let elapsed = |since: Option<u32>| since.is_some_and(|since| now - since >= 300);
        // TON
        since[0] = inputs[0].then(|| since[0].unwrap_or(now));
        q[0] = elapsed(since[0]);
        // TOF
        if inputs[1] {
            (since[1], q[1]) = (None, true);
        } else if q[1] {
            since[1] = since[1].or(Some(now));
            q[1] = !elapsed(since[1]);
        }
        // TP
        if since[2].is_none() && inputs[2] && !*before {
            (since[2], q[2]) = (Some(now), true);
        } else if elapsed(since[2]) {
            q[2] = false;
        }
        if !q[2] && !inputs[2] {
            since[2] = None;
        }
        *before = inputs[2];
        for (number, expected) in (0..).zip(*q) {
            assert_eq!(
                bit(machine, number),
                expected,
                "scan {scan}, block {number}"
            );
        }
    });
}

#[test]
fn edges_and_bistables() {
    let mut diagram = Diagram::default();
    diagram.block("R_TRIG", "rise", &[("CLK", "X0")], &[("Q", "M0")]);
    diagram.block("F_TRIG", "fall", &[("CLK", "X0")], &[("Q", "M1")]);
    diagram.block("SR", "set", &[("S1", "X1"), ("R", "X2")], &[("Q1", "M2")]);
    diagram.block("RS", "reset", &[("S", "X1"), ("R1", "X2")], &[("Q1", "M3")]);
    let mut state = ([false; 2], [false; 2]);
    run(&diagram, 300, 30, |scan, [clock, s, r, ..], machine| {
        if scan == 0 {
            state = Default::default();
        }
        let (memory, q) = &mut state;
        let edges = [clock && !memory[0], !clock && !memory[1]];
        *memory = [clock, !clock];
        q[0] = s || !r && q[0];
        q[1] = !r && (s || q[1]);
        let expected = [edges[0], edges[1], q[0], q[1]];
        assert_eq!(
            [0, 1, 2, 3].map(|number| bit(machine, number)),
            expected,
            "scan {scan}"
        );
    });
}

#[test]
fn counters() {
    let mut diagram = Diagram::default();
    let (up, down, reset, load) = (("CU", "X0"), ("CD", "X1"), ("R", "X2"), ("LD", "X3"));
    let preset = ("PV", "4");
    diagram.block("CTU", "plain", &[up, reset, preset], &[("Q", "M0")]);
    diagram.block(
        "CTU",
        "count",
        &[up, reset, preset],
        &[("Q", "M1"), ("CV", "D1")],
    );
    diagram.block(
        "CTD",
        "down",
        &[down, load, preset],
        &[("Q", "M2"), ("CV", "D2")],
    );
    let inputs = [up, down, reset, load, preset];
    diagram.block(
        "CTUD",
        "both",
        &inputs,
        &[("QU", "M3"), ("QD", "M4"), ("CV", "D3")],
    );
    let mut state = ([0_i16; 3], [false; 2]);
    run(&diagram, 500, 35, |scan, [cu, cd, r, ld, _], machine| {
        if scan == 0 {
            state = Default::default();
        }
        let (count, before) = &mut state;
        let [up, down] = [cu && !before[0], cd && !before[1]];
        *before = [cu, cd];
        count[0] = if r { 0 } else { count[0] + i16::from(up) };
        count[1] = if ld { 4 } else { count[1] - i16::from(down) };
        count[2] = match (r, ld) {
            (true, _) => 0,
            (_, true) => 4,
            _ if up && down => count[2],
            _ => count[2] + i16::from(up) - i16::from(down),
        };
        let q = [
            count[0] >= 4,
            count[0] >= 4,
            count[1] <= 0,
            count[2] >= 4,
            count[2] <= 0,
        ];
        assert_eq!(
            [0, 1, 2, 3, 4].map(|number| bit(machine, number)),
            q,
            "scan {scan}"
        );
        assert_eq!(
            [1, 2, 3].map(|number| word(machine, number)),
            *count,
            "scan {scan}"
        );
    });
}

/// Each function on two registers, a word and inputs; then new values for the registers.
fn all_functions() -> Diagram {
    let mut diagram = Diagram::default();
    diagram.block("MOVE", "", &[("IN", "D0")], &[("OUT", "D20")]);
    diagram.block(
        "ADD",
        "",
        &[("IN1", "D0"), ("IN2", "D1"), ("IN3", "7")],
        &[("OUT", "D21")],
    );
    let pair = [("IN1", "D0"), ("IN2", "D1")];
    for (number, name) in (22..).zip(["SUB", "MUL", "DIV", "MOD", "MIN", "MAX"]) {
        diagram.block(name, "", &pair, &[("OUT", &format!("D{number}"))]);
    }
    diagram.block(
        "LIMIT",
        "",
        &[("MN", "-5"), ("IN", "D0"), ("MX", "9")],
        &[("OUT", "D28")],
    );
    diagram.block(
        "SEL",
        "",
        &[("G", "X0"), ("IN0", "D0"), ("IN1", "D1")],
        &[("OUT", "D29")],
    );
    for (number, name) in (0..).zip(["GT", "GE", "EQ", "LE", "LT", "NE"]) {
        diagram.block(name, "", &pair, &[("OUT", &format!("M{number}"))]);
    }
    for (number, name) in (6..).zip(["AND", "OR", "XOR"]) {
        diagram.block(
            name,
            "",
            &[("IN1", "X0"), ("IN2", "X1")],
            &[("OUT", &format!("M{number}"))],
        );
    }
    diagram.block("NOT", "", &[("IN", "X0")], &[("OUT", "M9")]);
    let bits = "<variable name=\"mask\" address=\"%MW30\"><type><WORD/></type></variable>";
    diagram.variables += bits;
    diagram.block(
        "AND",
        "",
        &[("IN1", "mask"), ("IN2", "16#FF")],
        &[("OUT", "D31")],
    );
    diagram.block(
        "SEL",
        "",
        &[("G", "X2"), ("IN0", "-12"), ("IN1", "11")],
        &[("OUT", "D0")],
    );
    diagram.block(
        "SEL",
        "",
        &[("G", "X3"), ("IN0", "-3"), ("IN1", "4")],
        &[("OUT", "D1")],
    );
    diagram.block(
        "SEL",
        "",
        &[("G", "X4"), ("IN0", "16#1234"), ("IN1", "16#77F0")],
        &[("OUT", "mask")],
    );
    diagram
}

#[test]
fn functions() {
    let diagram = all_functions();
    let mut old: Option<(i16, i16, i16)> = None;
    run(&diagram, 100, 50, |scan, [x0, x1, x2, x3, x4], machine| {
        if let (Some((a, b, mask)), 1..) = (old, scan) {
            let sums = [
                a,
                a + b + 7,
                a - b,
                a * b,
                a / b,
                a % b,
                a.min(b),
                a.max(b),
                a.clamp(-5, 9),
            ];
            let chosen = if x0 { b } else { a };
            for (number, expected) in (20..).zip(sums.into_iter().chain([chosen])) {
                assert_eq!(word(machine, number), expected, "scan {scan}, D{number}");
            }
            assert_eq!(word(machine, 31), mask & 0xff, "scan {scan}");
            let compared = [a > b, a >= b, a == b, a <= b, a < b, a != b];
            let combined = [x0 && x1, x0 || x1, x0 != x1, !x0];
            for (number, expected) in (0..).zip(compared.into_iter().chain(combined)) {
                assert_eq!(bit(machine, number), expected, "scan {scan}, M{number}");
            }
        }
        let a = if x2 { 11 } else { -12 };
        let b = if x3 { 4 } else { -3 };
        old = Some((a, b, if x4 { 0x77f0 } else { 0x1234 }));
    });
}
