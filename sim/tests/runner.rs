//! What the runner says about cases that fail.

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

#[test]
fn what_differs_is_told_with_its_step() {
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
