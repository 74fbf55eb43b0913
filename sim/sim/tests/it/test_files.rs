//! Mistakes in test files, in the words of people who write them.

use rungc_sim::LoadError;
use rungc_sim::plctest::{self, Check, TestFile};
use std::fmt::Write;

/// A test file with this case.
fn file(case: &str) -> Result<TestFile, String> {
    let text = format!("model = \"fx3u\"\ntopic = \"t\"\n[[case]]\nname = \"a\"\n{case}");
    plctest::parse("t.plctest.toml", &text).map_err(|error| marked(&error))
}

/// Mistakes, each with what a report marks below it.
fn marked(error: &LoadError) -> String {
    let LoadError::Format { file, problems, .. } = error else {
        return error.to_string();
    };
    let name = &file.name;
    let lines = problems.iter().map(|p| {
        let token = &file.text[p.span.start as usize..p.span.end as usize];
        format!("{name}:{}:{}: {p}\n    {token}", p.line, p.column)
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn step(step: &str) -> Result<TestFile, String> {
    file(&format!("program = \"END\"\n[[case.step]]\n{step}\n"))
}

/// The keys of a step.
const KEYS: [&str; 25] = [
    "set",
    "do",
    "scans",
    "run_ms",
    "until",
    "at_most_ms",
    "scan_ms",
    "within",
    "never",
    "whenever",
    "expect",
    "pulses",
    "encoder",
    "rx",
    "expect_tx",
    "cut",
    "clock",
    "mode",
    "power_fails",
    "power_cycle",
    "bfm",
    "expect_bfm",
    "answers_after",
    "expect_position",
    "analog",
];

/// Values that few keys take.
const VALUES: [&str; 10] = [
    "true",
    "1.5",
    "\"text\"",
    "[1]",
    "[[1]]",
    "{ a = true }",
    "{ a = [1] }",
    "{ D0.f32 = 1 }",
    "{ M0 = { b = 1 } }",
    "2026-01-02T03:04:05",
];

/// Words of Rust, which those who write test files need not know.
const WORDS: [&str; 9] = [
    "untagged",
    "variant of",
    "struct",
    "enum",
    " map",
    "f64",
    "i64",
    "u32",
    "$",
];

/// Values of a wrong kind are explained in the words of TOML, whatever the key.
#[test]
fn values_of_a_wrong_kind_are_explained() {
    let mut wrong = Vec::new();
    for key in KEYS {
        for value in VALUES {
            if let Err(report) = step(&format!("{key} = {value}"))
                && WORDS.iter().any(|word| report.contains(word))
            {
                wrong.push(report);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let mut shown = String::new();
    for wrong in [
        "expect = { Y0 = true }",
        "set = { D0.f32 = 1 }",
        "set = { T0.value = 5 }",
        "expect = { D0 = [1] }",
        "set = \"M0\"",
        "set = { D0 = 2026-01-02 }",
        "set = { D0 = { value = 5, tolerence = 1 } }",
        "encoder = 5",
        "set = { X000 = 1, X0 = 0 }",
        "expect = { D0 = 1, \"D000\" = 2 }",
        "rx = { COM9 = \"05\" }",
        "expect_tx = { CAN = \"200#12\" }",
    ] {
        writeln!(shown, "{}\n", step(wrong).unwrap_err()).unwrap();
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn devices_are_named_by_their_comments() {
    let case = |name: &str| {
        format!(
            "program = \"\"\"\n;! X003 = Start  button\n;! D10 = Speed\n;! M1 = Ready\n;! M2 = Ready\nLD X3\nEND\n\"\"\"\n\
             [[case.plc]]\nname = \"B\"\nprogram = \";! M7 = Lamp\\nEND\\n\"\ninit = {{ Lamp = 1 }}\n\
             [[case.step]]\nset = {{ \"{name}\" = 1 }}\n"
        )
    };
    for (name, plc, device) in [
        ("Start button", 0, "X003"),
        ("start BUTTON", 0, "X003"),
        ("Speed", 0, "D10"),
        ("Speed.f32", 0, "D10.f32"),
        ("B:lamp", 1, "M7"),
    ] {
        let file = file(&case(name)).unwrap();
        let Check::Steps { steps, .. } = &file.cases[0].check else {
            panic!("the case has steps");
        };
        let set = &steps[0].set[0];
        assert_eq!(
            (set.plc, set.target.to_string()),
            (plc, device.to_string()),
            "{name}"
        );
    }
    let mut shown = String::new();
    for wrong in ["Start buton", "Ready", "B:Speed", "Speed.hz", "Horn"] {
        writeln!(shown, "{}\n", file(&case(wrong)).unwrap_err()).unwrap();
    }
    insta::assert_snapshot!(shown);
}
