//! Conditions as texts in test files.

use crate::engines::Interpreter;
use crate::plctest::{self, Suite};
use std::ops::ControlFlow;

/// Y000 follows X000 a scan later, for as long as X001 is off; D0 counts scans.
const PROGRAM: &str = ";! Y000 = Main pump\\n;! D0 = Scans\\nLD M0\\nANI X001\\nOUT Y000\\nLD X000\\nOUT M0\\nLD M8000\\nINC D0\\nEND\\n";

/// A case that begins with these lines.
fn file(lines: &str) -> String {
    format!(
        "topic = \"t\"\nmodel = \"fx3u\"\nprogram = \"{PROGRAM}\"\n[[case]]\nname = \"a\"\n{lines}\n"
    )
}

/// Why a case with three steps fails: X000 is switched on after 20 ms, and X001 after 200 ms.
fn outcome(rules: &str) -> String {
    let steps = "[[case.step]]\nscans = 2\n[[case.step]]\nset = { X000 = 1 }\nrun_ms = 180\n[[case.step]]\nset = { X001 = 1 }\n";
    run(&format!("{rules}\n{steps}"))
}

fn run(lines: &str) -> String {
    let file = match plctest::parse("t.plctest.toml", &file(lines)) {
        Ok(file) => file,
        Err(mistakes) => return mistakes.to_string(),
    };
    let suite = Suite::compile(vec![file], &[]);
    let mut engine = Interpreter::new(suite.modules());
    let report = plctest::run(&suite, &mut engine, &mut |_| ControlFlow::Continue(()));
    let failure = report.outcomes[0].failure.as_ref();
    failure.map_or("passed".to_string(), ToString::to_string)
}

#[test]
fn conditions_are_texts_in_rules_over_time() {
    insta::assert_snapshot!(outcome("never = \"Y000 & D0 > 5\""), @"step 2 (line 6): never: `Y000 & D0 > 5` at 60 ms: Y000 = 1, D0 = 6");
    insta::assert_snapshot!(outcome("never = [\"Y000 & X001\", { Y000 = 1, X000 = 1 }]"), @"step 2 (line 6): never: X000 = 1, Y000 = 1 at 40 ms");
    insta::assert_snapshot!(outcome("always = '!\"main pump\" | Scans > 3'"), @"passed");
    insta::assert_snapshot!(outcome("always = \"!(Y000 for 100ms)\""), @"step 2 (line 6): always: `!(Y000 for 100ms)` at 140 ms: Y000 = 1");
    insta::assert_snapshot!(outcome("whenever = [{ when = \"rises(X000)\", then = \"Y000\", within = \"10ms\" }]"), @"passed");
    insta::assert_snapshot!(outcome("whenever = [{ when = \"X000\", then = \"Y000\" }]"), @"step 2 (line 6): whenever: `whenever X000 then Y000` at 30 ms: X000 = 1, Y000 = 0");
    insta::assert_snapshot!(outcome("stays = [{ holds = \"Y000\", until = \"D0 > 100\" }]"), @"step 3 (line 6): stays: `stays Y000 until D0 > 100` at 210 ms: Y000 = 0, D0 = 21");
    insta::assert_snapshot!(outcome("stays = [{ holds = \"Y000\", until = \"X001\" }]"), @"passed");
    insta::assert_snapshot!(outcome("reachable = \"Y000 & X001\""), @"step 3 (line 6): reachable: `Y000 & X001` after no scan");
    insta::assert_snapshot!(outcome("reachable = [\"Y000\", \"D0.3 & D0.0\"]"), @"passed");
    insta::assert_snapshot!(outcome("always = \"Y000 before X000\""), @"step 2 (line 6): always: `Y000 before X000` at 30 ms: Y000 = 0, X000 = 1");
    insta::assert_snapshot!(run("[[case.step]]\nset = { X000 = 1 }\nscans = 2\nnever = \"Y000\""), @"step 1 (line 9): never: `Y000` at 20 ms: Y000 = 1");
}

/// A scan that takes long does not count before it has passed.
#[test]
fn times_are_those_between_the_beginnings_of_scans() {
    let steps = "[[case.step]]\nset = { X000 = 1 }\nscan_ms = 10\n[[case.step]]\nscan_ms = 500\n[[case.step]]\n";
    let whenever = "whenever = [{ when = { X000 = 1 }, then = { Y000 = 1 }, within_ms = 10 }]\n";
    assert_eq!(run(&format!("{whenever}{steps}")), "passed");
    assert_eq!(
        run(&format!(
            "never = \"X000 for 510ms\"\n{}",
            &steps[..steps.len() - 14]
        )),
        "passed"
    );
    insta::assert_snapshot!(run(&format!("never = \"X000 for 510ms\"\n{steps}")), @"step 3 (line 6): never: `X000 for 510ms` at 520 ms: X000 = 1");
}

#[test]
fn stop_and_power_off_begin_conditions_anew() {
    let steps = |between: &str| {
        format!(
            "never = \"X000 for 50ms\"\n[[case.step]]\nset = {{ X000 = 1 }}\nscans = 4\n[[case.step]]\n{between}\n[[case.step]]\nmode = \"run\"\nscans = 4\n"
        )
    };
    insta::assert_snapshot!(run(&steps("scans = 1")), @"step 3 (line 6): never: `X000 for 50ms` at 60 ms: X000 = 1");
    assert_eq!(run(&steps("mode = \"stop\"\nscans = 9")), "passed");
    assert_eq!(run(&steps("power_cycle = true")), "passed");
}

#[test]
fn mistakes_in_conditions_have_a_place() {
    insta::assert_snapshot!(outcome("never = \"Y000 &\""), @"t.plctest.toml:6:9: `Y000 &`: expected a device, a name or a number here");
    insta::assert_snapshot!(outcome("never = [3]"), @r#"t.plctest.toml:6:10: invalid type: integer `3`, expected a condition: `"Y000 & Y001"`, or `{ Y000 = 1, Y001 = 1 }`"#);
    insta::assert_snapshot!(outcome("always = { Y000 = 1 }"), @r#"t.plctest.toml:6:10: write a condition in quotes: `always = "Y000 & !Y001"`"#);
    insta::assert_snapshot!(outcome("whenever = [{ when = \"X000\", then = { Y000 = 1 } }]"), @"t.plctest.toml:6:37: write `when` and `then` both as texts, or both as tables");
    insta::assert_snapshot!(outcome("whenever = [{ when = \"X000\", then = \"Y000\", within = \"soon\" }]"), @"t.plctest.toml:6:54: `soon` is not a time: write for example 200ms or 5s");
    insta::assert_snapshot!(outcome("whenever = [{ when = \"X000\", then = \"Y000\", within = \"1s\", within_ms = 5 }]"), @"t.plctest.toml:6:54: use `within` or `within_ms`, not both");
    insta::assert_snapshot!(outcome("stays = [{ holds = \"pump\" }]"), @"t.plctest.toml:6:20: `pump`: `pump` is neither a device nor the comment of one; write a name with blanks in quotes");
    insta::assert_snapshot!(outcome("never = \"X777 & Y000\""), @"step 1: `X777` does not exist on the model");
    insta::assert_snapshot!(run("[[case.step]]\nreachable = \"Y000\""), @"t.plctest.toml:7:1: `reachable` belongs at the top of the file, before the first table");
}
