//! Functional mock-up units, as FMPy validates and runs them.

use crate::common::clients::{python, succeeds};
use crate::common::{folder, rungc, text};
use crate::tools::tools;
use rungc::{Plc, Project, Value as State};
use rungc_sim::Target;
use rungc_sim::record::Reading;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Numbers of all types, a timer, a counter and its value, and words that a panel writes.
const NUMBERS: &[u8] = b"\
;! X000 = Run
;! D20 = Level
;! D10 = Set point
LD X000
OUT T0 K5
LD T0
OUT Y000
LDP X000
INC D0
DINC D2
LD X000
OUT C0 K3
DADD D30 K100000 D32
DEADD D20 E0.5 D22
MOV D10 D11
END
";

const PANEL: &[u8] = b"[project]\nprogram = \"numbers.il\"\n[hmi]\nwrites = [\"D10\", \"D20\", \"D30\"]\nreads = [\"D22\", \"D32\"]\n";

/// Counts edges of an input by interrupts, and time by a timer interrupt.
const INTERRUPTS: &[u8] = b"\
EI
LD X001
OUT Y000
FEND
I001
LD M8000
INC D0
IRET
I610
LD M8000
INC D1
IRET
END
";

/// A run of the interpreter and of FMPy: an input or number from a scan on, and the devices that are compared.
struct Run<'a> {
    file: &'a str,
    scans: usize,
    scan_ms: Option<u32>,
    /// Scan, name of the variable, its device, value.
    set: &'a [(usize, &'a str, &'a str, Value)],
    /// Names of variables, and of their devices.
    read: &'a [(&'a str, &'a str)],
    /// A variable of an output.
    output: &'a str,
}

fn build(at: &Path, args: &[&str]) {
    let built = rungc(at, &[&["build", "--emit", "fmu"], args].concat());
    assert!(built.status.success(), "{}", text(&built.stderr));
}

impl Run<'_> {
    /// Runs the unit, each step a scan; compares it with the interpreter, and returns FMPy's report.
    fn check(&self, at: &Path) -> Option<Value> {
        let h = f64::from(self.scan_ms.unwrap_or(10)) / 1000.0;
        let steps = (0..self.scans).map(|scan| json!({"h": h, "set": self.set_at(scan)}));
        let report = self.report(at, steps.collect())?;
        assert_eq!(report["rows"], self.interpreted(at, true));
        assert_eq!(report["quiet"], self.interpreted(at, false));
        Some(report)
    }

    /// What is set before a scan.
    fn set_at(&self, scan: usize) -> Value {
        let due = self.set.iter().filter(|(at, ..)| *at == scan);
        due.map(|(_, name, _, value)| (name.to_string(), value.clone()))
            .collect()
    }

    /// FMPy's report about these steps.
    fn report(&self, at: &Path, steps: Vec<Value>) -> Option<Value> {
        let mut run = python("fmpy", "fmu.py")?;
        build(at, &[self.file, "-o", "unit.fmu"]);
        let read: Vec<_> = self.read.iter().map(|(name, _)| name).collect();
        let plan = json!({
            "scan_ms": self.scan_ms, "start": 2.0, "steps": steps, "read": read, "output": self.output
        });
        run.arg(at.join("unit.fmu")).arg(plan.to_string());
        let report: Value = serde_json::from_str(&succeeds(run)).unwrap();
        assert_eq!(report["problems"], json!([]));
        for same in ["again", "other", "reset"] {
            assert_eq!(report[same], true, "{same}: {report}");
        }
        for (what, refused) in report["refusals"].as_object().unwrap() {
            assert_eq!(refused, true, "{what}");
        }
        assert!(report["end"].as_f64().unwrap().abs() < 1e-6);
        Some(report)
    }

    /// The values after each scan of the interpreter.
    fn interpreted(&self, at: &Path, inputs: bool) -> Value {
        let project = Project::open(at.join(self.file)).unwrap();
        let program = project.check().compile().unwrap();
        let mut plc = program.start();
        let ms = u64::from(self.scan_ms.unwrap_or(10));
        let mut rows = Vec::new();
        for scan in 0..self.scans {
            for (_, _, device, value) in self.set.iter().filter(|set| inputs && set.0 == scan) {
                match value {
                    Value::Bool(on) => plc.set(device, *on),
                    _ if value.is_f64() => plc.set(device, value.as_f64().unwrap()),
                    _ => plc.set(device, value.as_i64().unwrap()),
                }
                .unwrap();
            }
            plc.session().scan(ms);
            plc.session().pass(ms);
            let values = self.read.iter().map(|(_, device)| value(&mut plc, device));
            rows.push(values.collect::<Vec<_>>());
        }
        json!(rows)
    }
}

/// Value of a device; of a timer or counter without a view, its contact.
fn value(plc: &mut Plc, device: &str) -> Value {
    let target = Target::parse(device).unwrap();
    if let Some(Reading::Bit(on)) = plc.session().reading(target) {
        return json!(on);
    }
    match plc.get(device).unwrap() {
        State::Bit(on) => json!(on),
        State::Int(value) => json!(value),
        State::Float(value) => json!(value),
        State::Text(text) => json!(text),
    }
}

fn example(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/programs");
    fs::read(path.join(name)).unwrap()
}

#[test]
fn traffic_lights_run_in_fmpy_as_in_the_interpreter() {
    let light = example("traffic_light.il");
    let folder = folder(&[("light.il", &light)]);
    let run = Run {
        file: "light.il",
        scans: 400,
        scan_ms: Some(100),
        set: &[
            (20, "X000", "X000", json!(true)),
            (25, "X000", "X000", json!(false)),
        ],
        read: &[
            ("Y000", "Y000"),
            ("Y001", "Y001"),
            ("Y002", "Y002"),
            ("Y003", "Y003"),
            ("Y004", "Y004"),
            ("T0_value", "T0.value"),
            ("S20", "S20"),
        ],
        output: "Y000",
    };
    let Some(report) = run.check(folder.path()) else {
        return;
    };
    let x = &report["variables"]["X000"];
    assert_eq!((&x[0], &x[1]), (&json!("Boolean"), &json!("input")));
}

#[test]
fn motors_run_in_fmpy_as_in_the_interpreter() {
    let motor = example("motor.il");
    let folder = folder(&[("motor.il", &motor)]);
    let mut set = vec![(1, "X000", "X000", json!(true))];
    for part in 0..12 {
        set.push((350 + 4 * part, "X002", "X002", json!(true)));
        set.push((352 + 4 * part, "X002", "X002", json!(false)));
    }
    set.push((410, "X003", "X003", json!(true)));
    let run = Run {
        file: "motor.il",
        scans: 420,
        scan_ms: None,
        set: &set,
        read: &[
            ("Y000", "Y000"),
            ("Y001", "Y001"),
            ("D0", "D0"),
            ("T0", "T0"),
        ],
        output: "Y000",
    };
    run.check(folder.path());
}

#[test]
fn variables_have_the_types_of_their_devices() {
    let folder = folder(&[("numbers.il", NUMBERS), ("rungc.toml", PANEL)]);
    let run = Run {
        file: "numbers.il",
        scans: 120,
        scan_ms: None,
        set: &[
            (0, "Set_point", "D10", json!(-7)),
            (2, "D30", "D30.i32", json!(70_000)),
            (3, "Level", "D20.f32", json!(1.25)),
            (4, "Run", "X000", json!(true)),
            (50, "Run", "X000", json!(false)),
            (52, "Run", "X000", json!(true)),
            (90, "Set_point", "D10", json!(1234)),
        ],
        read: &[
            ("Y000", "Y000"),
            ("D0", "D0"),
            ("D2", "D2.i32"),
            ("C0_value", "C0.value"),
            ("C0", "C0"),
            ("D32", "D32.i32"),
            ("D22", "D22.f32"),
            ("D11", "D11"),
        ],
        output: "D22",
    };
    let Some(report) = run.check(folder.path()) else {
        return;
    };
    let kinds = [
        ("Run", "Boolean", "input"),
        ("Set_point", "Int16", "input"),
        ("Level", "Float32", "input"),
        ("D30", "Int32", "input"),
        ("D32", "Int32", "output"),
        ("D22", "Float32", "output"),
        ("D11", "Int16", "local"),
        ("T0", "Boolean", "local"),
        ("T0_value", "Int16", "local"),
        ("scan_time_ms", "Int32", "parameter"),
    ];
    for (name, kind, causality) in kinds {
        let found = &report["variables"][name];
        assert_eq!(
            (&found[0], &found[1]),
            (&json!(kind), &json!(causality)),
            "{name}"
        );
    }
}

#[test]
fn interrupts_come_at_edges_and_with_the_time() {
    let folder = folder(&[("interrupts.il", INTERRUPTS)]);
    let run = Run {
        file: "interrupts.il",
        scans: 40,
        scan_ms: Some(25),
        set: &[
            (3, "X001", "X001", json!(true)),
            (4, "X001", "X001", json!(false)),
            (9, "X001", "X001", json!(true)),
        ],
        read: &[("Y000", "Y000"), ("D0", "D0"), ("D1", "D1")],
        output: "Y000",
    };
    run.check(folder.path());
}

/// A step that is not a multiple of the scan time: the scans that begin in it run.
#[test]
fn the_rest_of_a_step_is_carried_over() {
    let counter = b"LD M8000\nINC D0\nOUT Y000\nEND\n";
    let folder = folder(&[("counter.il", counter)]);
    let run = Run {
        file: "counter.il",
        scans: 0,
        scan_ms: Some(10),
        set: &[],
        read: &[("D0", "D0")],
        output: "Y000",
    };
    let lengths = [0.004, 0.004, 0.004, 0.025, 0.003, 0.1, 0.0101, 0.01];
    let steps = lengths.map(|h| json!({"h": h, "set": {}}));
    let Some(report) = run.report(folder.path(), steps.to_vec()) else {
        return;
    };
    let expected = [1, 1, 2, 4, 4, 14, 16, 17].map(|scans| json!([scans]));
    assert_eq!(report["rows"], json!(expected));
}

#[test]
fn operation_errors_are_logged() {
    let program = b"LD X000\nDIV D0 K0 D2\nOUT Y000\nEND\n";
    let folder = folder(&[("divide.il", program)]);
    let run = Run {
        file: "divide.il",
        scans: 4,
        scan_ms: None,
        set: &[(1, "X000", "X000", json!(true))],
        read: &[("Y000", "Y000")],
        output: "Y000",
    };
    let Some(report) = run.check(folder.path()) else {
        return;
    };
    let messages = report["messages"].as_array().unwrap();
    let is_it = |message: &Value| {
        message[1] == "logEvents" && message[2] == "operation error 6706 at step 1"
    };
    assert!(messages.iter().any(is_it), "{report}");
}

#[test]
fn the_same_program_gives_the_same_unit() {
    let light = example("traffic_light.il");
    let folder = folder(&[("light.il", &light)]);
    let at = folder.path();
    build(at, &["light.il", "--sources-only"]);
    build(at, &["light.il", "--sources-only", "-o", "again.fmu"]);
    let unit = fs::read(at.join("light.fmu")).unwrap();
    assert_eq!(unit, fs::read(at.join("again.fmu")).unwrap());
    // The earlier one is replaced.
    build(at, &["light.il", "--sources-only"]);
}

#[test]
fn sources_compile_without_a_warning() {
    if !tools(&["gcc", "clang", "unzip"]) {
        return;
    }
    let light = example("traffic_light.il");
    let folder = folder(&[
        ("light.il", &light),
        ("numbers.il", NUMBERS),
        ("rungc.toml", PANEL),
        ("interrupts.il", INTERRUPTS),
        ("nothing.il", b"END\n"),
    ]);
    let at = folder.path();
    for name in ["light", "numbers", "interrupts", "nothing"] {
        build(
            at,
            &[
                &format!("{name}.il"),
                "--sources-only",
                "-o",
                &format!("{name}.fmu"),
            ],
        );
        let shell = format!(
            "unzip -q {name}.fmu -d {name} && cd {name}/sources && for cc in gcc clang; do \
             $cc -std=c99 -pedantic -Wall -Wextra -Wconversion -Werror -c *.c || exit 1; done"
        );
        let done = Command::new("sh")
            .args(["-c", &shell])
            .current_dir(at)
            .output()
            .unwrap();
        assert!(done.status.success(), "{name}: {}", text(&done.stderr));
    }
}

#[test]
fn hardware_is_refused_with_the_instruction_that_asks_it() {
    let folder = folder(&[
        ("clock.il", b"LD X000\nTRD D0\nEND\n"),
        ("pulses.il", b"LD X000\nPLSY K100 K10 Y000\nEND\n"),
        ("texts.il", b"LD X001\nASC ABCDEFGH D10\nOUT Y001\nEND\n"),
    ]);
    for (args, said) in [
        (&["clock.il"][..], "asks hardware: TRD D0 (step 1)"),
        (&["pulses.il"], "sends pulses"),
        (
            &["texts.il", "--sources-only"],
            "because of ASC ABCDEFGH D10 (step 1)",
        ),
    ] {
        let built = rungc(folder.path(), &[&["build", "--emit", "fmu"], args].concat());
        let errors = text(&built.stderr);
        assert_eq!(built.status.code(), Some(2), "{errors}");
        assert!(errors.contains(said), "{errors}");
    }
}
