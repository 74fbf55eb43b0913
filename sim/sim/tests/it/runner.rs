//! Reports of the runner on failing cases.

use rungc_sim::engines::Interpreter;
use rungc_sim::plctest::{self, Suite};
use std::ops::ControlFlow;

/// The descriptions of all outcomes, one a line.
fn outcomes(text: &str) -> String {
    let file = plctest::parse("t.plctest.toml", text).unwrap();
    let suite = Suite::compile(vec![file], &[]);
    let mut engine = Interpreter::new(suite.modules());
    let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
    let lines: Vec<_> = report.outcomes.iter().map(|o| o.describe(&suite)).collect();
    lines.join("\n")
}

const HEAD: &str = "model = \"h2u\"\ntopic = \"t\"\n";

/// Microseconds in 32 bits begin anew while a request is on the line: none of its bytes is lost.
#[test]
fn a_request_arrives_across_71_minutes() {
    let text = format!(
        "{HEAD}{}",
        r#"
[[case]]
name = "slave"
program = """
LD M8002
MOV H2 D8126
MOV H81 D8120
MOV K1 D8121
END
"""
[[case.step]]
scan_ms = 32767
scans = 131
[[case.step]]
set = { D100 = 7 }
scan_ms = 2483
[[case.step]]
rx = { COM1 = "01 03 00 64 00 01 C5 D5" }
run_ms = 200
expect_tx = { COM1 = "01 03 02 00 07 F9 86" }
"#
    );
    insta::assert_snapshot!(outcomes(&text), @"t.plctest.toml:5: slave [interp]: passed");
}

#[test]
fn what_differs_is_reported_with_its_step() {
    let text = format!(
        "{HEAD}{}",
        r#"
[[case]]
name = "adds"
source = "manual, page 1"
program = """
LD X000
ADDP D0 K1 D0
OUT Y000
END
"""
init = { D0 = 5 }
[[case.step]]
set = { X000 = 1 }
expect = { D0 = 6, Y000 = 1 }
[[case.step]]
run_ms = 50
expect = { D0 = 7, Y000 = 0, "D10.str" = "AB", "D20.f32" = 1.5 }
[[case]]
name = "passes"
program = """
LD X000
OUT T0 K2
MOV HFFFF K4M0
DEMOV E2.5 D20
END
"""
[[case.step]]
set = { X000 = 1, K4M16 = -2, "D30.str" = "xyz" }
scans = 30
expect = { T0 = 1, "T0.value" = 2, K4M0 = "0xFFFF", M17 = 1, M16 = 0, "D20.f32" = 2.5, "D30.str" = "xyz" }
"#
    );
    insta::assert_snapshot!(outcomes(&text), @r#"
    t.plctest.toml:5: adds [interp]: step 2 (line 17): D0 is 6, expected 7; D10.str is "\0\0", expected "AB"; D20.f32 is 0, expected 1.5; Y000 is 1, expected 0
        source: manual, page 1
    t.plctest.toml:21: passes [interp]: passed
    "#);
}

#[test]
fn programs_that_do_not_compile_are_failures() {
    let text = format!(
        "{HEAD}{}",
        r#"
[[case]]
name = "rejected"
program = """
LD X000
OUT D0
END
"""
[[case.step]]
[[case]]
name = "rejected_as_it_should"
program = """
LD X000
OUT D0
END
"""
rejects = { code = 0, line = 2 }
[[case]]
name = "rejected_elsewhere"
program = """
LD X000
OUT D0
END
"""
rejects = { code = 6610, line = 1 }
[[case]]
name = "accepted"
program = """
LD X000
OUT Y000
END
"""
rejects = { code = 0 }
[[case]]
name = "no_such_device"
program = """
LD X000
OUT Y000
END
"""
[[case.step]]
set = { D9999 = 1 }
"#
    );
    insta::assert_snapshot!(outcomes(&text), @"
    t.plctest.toml:5: rejected [interp]: the program does not compile: line 2: `D0` cannot be operand D of `OUT`
    t.plctest.toml:13: rejected_as_it_should [interp]: passed
    t.plctest.toml:21: rejected_elsewhere [interp]: expected error 6610 on line 1, found error 6503 on line 2: `D0` cannot be operand D of `OUT`
    t.plctest.toml:29: accepted [interp]: expected an error, but the program compiles
    t.plctest.toml:37: no_such_device [interp]: step 1: `D9999` does not exist on the model
    ");
}

/// A lamp that goes off 500 ms after its switch, with cases about time.
fn lamp(cases: &str) -> String {
    format!(
        "{HEAD}program = \"\"\"\nLD X000\nOR M0\nANI T0\nOUT M0\nLD M0\nANI X000\nOUT T0 K5\nLD M0\nOUT Y000\nMOV K1000 D0\nEND\n\"\"\"\n{cases}"
    )
}

#[test]
fn what_must_hold_over_time_is_reported_when_it_does_not() {
    let text = lamp(
        r#"
whenever = [{ when = { X000 = 1 }, then = { Y000 = 1 } }]
[[scenario]]
name = "press"
[[scenario.step]]
set = { X000 = 1 }
[[scenario.step]]
set = { X000 = 0 }
[[case]]
name = "waits"
[[case.step]]
do = "press"
[[case.step]]
until = { Y000 = 0, T0 = 0 }
at_most_ms = 600
within = [{ ms = 400, expect = { "T0.value" = { value = 2, tolerance = 1 } } }]
expect = { Y000 = 0, D0 = { value = 1003, tolerance = 3 } }
[[case]]
name = "waits_too_short"
[[case.step]]
do = "press"
[[case.step]]
until = { Y000 = 0 }
at_most_ms = 300
[[case]]
name = "never"
never = [{ Y000 = 1, X000 = 0 }]
[[case.step]]
do = "press"
expect = { Y000 = 1 }
[[case]]
name = "whenever_late"
whenever = [{ when = { M0 = 1 }, then = { M0 = 0 }, within_ms = 200 }]
[[case.step]]
do = "press"
run_ms = 1000
[[case]]
name = "whenever_at_once"
whenever = [{ when = { X000 = 1 }, then = { Y001 = 1 } }]
[[case.step]]
do = "press"
[[case]]
name = "within"
[[case.step]]
set = { X000 = 1 }
within = [{ ms = 50, expect = { T0 = 1, Y000 = 0 } }]
run_ms = 100
[[case]]
name = "far_off"
[[case.step]]
set = { X000 = 1 }
expect = { D0 = { value = 995, tolerance = 4.5 } }
[[case]]
name = "times"
rows = [{ ms = 400, lamp = 1 }, { name = "late", ms = 700, lamp = 0 }, { ms = 300, lamp = 0 }]
[[case.step]]
do = "press"
run_ms = "$ms"
expect = { Y000 = "$lamp" }
"#,
    );
    insta::assert_snapshot!(outcomes(&text), @r"
    t.plctest.toml:25: waits [interp]: passed
    t.plctest.toml:34: waits_too_short [interp]: step 4 (line 37): until: not Y000 = 0 after 300 ms: Y000 is 1
    t.plctest.toml:41: never [interp]: step 2 (line 42): never: X000 = 0, Y000 = 1 at 20 ms
    t.plctest.toml:47: whenever_late [interp]: step 3 (line 48): whenever: M0 = 1 at 10 ms, but not M0 = 0 within 200 ms: M0 is 1
    t.plctest.toml:53: whenever_at_once [interp]: step 1 (line 54): whenever: X000 = 1 at 10 ms, but not Y001 = 1 after the same scan: Y001 is 0
    t.plctest.toml:58: within [interp]: step 1 (line 61): within: not T0 = 1, Y000 = 0 within 50 ms: T0 is 0, Y000 is 1
    t.plctest.toml:64: far_off [interp]: step 1 (line 65): D0 is 1000, expected 995
    t.plctest.toml:69: times[1] [interp]: passed
    t.plctest.toml:69: times[late] [interp]: passed
    t.plctest.toml:69: times[3] [interp]: step 3 (line 71): Y000 is 1, expected 0
    ");
}

#[test]
fn a_trace_is_compared_with_the_accepted_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lamp.plctest.toml");
    let text = lamp(
        r#"
[[case]]
name = "goes off"
trace = ["X000", "Y000", "T0.value"]
[[case.step]]
set = { X000 = 1 }
scan_ms = 100
[[case.step]]
set = { X000 = 0 }
scan_ms = 100
run_ms = 700
"#,
    );
    std::fs::write(&path, text).unwrap();
    let failure = || {
        let suite = Suite::compile(vec![plctest::load(&path).unwrap()], &[]);
        let mut engine = Interpreter::new(suite.modules());
        let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
        let case = &suite.files()[0].cases[0];
        let trace = case.trace.clone().unwrap();
        (trace, report.outcomes[0].failure.clone())
    };
    let (trace, first) = failure();
    // A space is not a character of its name, so a hash follows.
    assert!(trace.path.ends_with("traces/lamp.goes_off-a1b47186.trace"));
    let Some(plctest::Failure::Trace { message, actual }) = first else {
        panic!("there is no accepted trace");
    };
    insta::assert_snapshot!(message, @"this run has no accepted trace; review it with `rungc test --review`");
    insta::assert_snapshot!(actual, @r"
    step 1
         100 ms  X000 1  Y000 1  T0.value 0
    step 2
         200 ms  X000 0
         300 ms  T0.value 1
         400 ms  T0.value 2
         500 ms  T0.value 3
         600 ms  T0.value 4
         700 ms  T0.value 5
         800 ms  Y000 0  T0.value 0
    ");
    std::fs::create_dir(trace.path.parent().unwrap()).unwrap();
    std::fs::write(&trace.path, actual.replace('\n', "\r\n")).unwrap();
    assert_eq!(failure().1, None);
    std::fs::write(&trace.path, actual.replace("T0.value 3", "T0.value 4")).unwrap();
    let Some(failure) = failure().1 else {
        panic!("the trace differs");
    };
    insta::assert_snapshot!(failure, @r"
    the trace differs from the accepted one
               200 ms  X000 0
               300 ms  T0.value 1
               400 ms  T0.value 2
        -      500 ms  T0.value 4
        -      600 ms  T0.value 4
        -      700 ms  T0.value 5
        +      500 ms  T0.value 3
        +      600 ms  T0.value 4
        +      700 ms  T0.value 5
    ");
}

#[test]
fn cases_that_share_a_program_share_its_module() {
    let text = lamp(
        "\n[[case]]\nname = \"a\"\nrows = [{ d = 1 }, { d = 2 }, { d = 3 }]\n[[case.step]]\nset = { X000 = 1, D9 = \"$d\" }\nexpect = { D9 = \"$d\", D0 = 1000 }\n",
    );
    let suite = Suite::compile(vec![plctest::parse("t.plctest.toml", &text).unwrap()], &[]);
    assert_eq!((suite.len(), suite.modules().len()), (3, 1));
    assert!(!outcomes(&text).contains("expected"), "{}", outcomes(&text));
}

#[test]
fn what_must_hold_over_time_is_judged_before_interrupts_of_the_time_after_a_scan() {
    // The routine runs each ten milliseconds, between two scans; each scan begins D0 anew.
    let text = r#"
model = "fx3u"
topic = "t"
program = """
EI
LD M8000
MOV K1 D0
FEND
I610
LD M8000
MOV K2 D0
IRET
END
"""
[[case]]
name = "after a scan"
always = "D0 = 1"
never = ["D0 = 2", { D0 = 2 }]
whenever = [{ when = { X000 = 1 }, then = { D0 = 1 } }]
[[case.step]]
set = { X000 = 1 }
scans = 3
expect = { D0 = 2 }
[[case]]
name = "after its time"
[[case.step]]
until = { D0 = 2 }
at_most_ms = 10
[[case.step]]
within = [{ ms = 10, expect = { D0 = 2 } }]
"#;
    insta::assert_snapshot!(outcomes(text), @r"
    t.plctest.toml:16: after a scan [interp]: passed
    t.plctest.toml:25: after its time [interp]: passed
    ");
}
