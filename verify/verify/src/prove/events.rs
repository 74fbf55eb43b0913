//! Programs whose routines run between two scans: runs that are reported happen, also as tests.

use super::{Decision, Options, Verdict, decide};
use crate::same::compare;
use crate::tests::{module, observing};
use crate::written::{Names, case, outcomes, quoted};
use rungc_sim::property::{Property, parse};

fn never(condition: &str) -> Property {
    Property::Never(parse(condition, &|_| Vec::new()).unwrap())
}

fn decided(list: &str, condition: &str) -> Decision {
    let property = never(condition);
    let options = Options {
        effort: 1500,
        ..Options::default()
    };
    decide(&observing(list, &property), &property, &options)
}

/// Test of the run that was found; `None` if none was.
fn written(list: &str, condition: &str) -> Option<String> {
    let Verdict::Found(trace) = decided(list, condition).verdict else {
        return None;
    };
    let property = never(condition);
    let name = Names::default().name("found");
    Some(case(&name, &observing(list, &property), &property, &trace))
}

/// Returns true if a test passes on a program.
fn passes(list: &str, case: &str) -> bool {
    let list = quoted(list);
    let text = format!("topic = \"t\"\nmodel = \"fx3u\"\nprogram = {list}\n{case}");
    let outcomes = outcomes("t.plctest.toml", &text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    outcomes == [None]
}

/// Programs with a condition that happens in them and never in their repaired forms, though logic allows it.
const FOUND: [(&str, &str, &str); 5] = [
    // An edge of an input.
    (
        "EI\nLD M8000\nOUT Y000\nFEND\nI001\nLD M8000\nMOV K5 D0\nIRET\nEND\n",
        "EI\nLD M8000\nOUT Y000\nFEND\nI001\nLD M8000\nMOV K6 D0\nIRET\nEND\n",
        "D0 = 5",
    ),
    // A third period of a timer interrupt.
    (
        "EI\nLD> D0 K2\nOUT Y000\nFEND\nI610\nLD X000\nINC D0\nIRET\nEND\n",
        "EI\nLD> D0 K2\nOUT Y000\nFEND\nI610\nLD X000\nINC D0\nLD> D0 K2\nMOV K0 D0\nIRET\nEND\n",
        "Y000",
    ),
    // A counter that edges count.
    (
        "LD M8000\nOUT C235 K100\nLDD>= C235 K3\nOUT Y000\nEND\n",
        "LD M8000\nOUT C235 K100\nLDD>= C235 K3\nRST C235\nLDD>= C235 K3\nOUT Y000\nEND\n",
        "Y000",
    ),
    // Its comparison.
    (
        "LD M8000\nOUT C235 K100\nDHSCS K2 C235 Y001\nEND\n",
        "LD M8000\nOUT C235 K100\nDHSCS K2 C235 Y002\nEND\n",
        "Y001",
    ),
    // Its interrupt.
    (
        "EI\nLD M8000\nOUT C235 K100\nDHSCS K2 C235 I010\nFEND\nI010\nLD M8000\nMOV K9 D5\nIRET\nEND\n",
        "EI\nLD M8000\nOUT C235 K100\nDHSCS K2 C235 I010\nFEND\nI010\nLD M8000\nMOV K5 D5\nIRET\nEND\n",
        "D5 = 9",
    ),
];

#[test]
fn runs_of_routines_are_found_and_happen_as_tests() {
    for (list, repaired, condition) in FOUND {
        let case = written(list, condition).unwrap_or_else(|| {
            panic!("{list}: {:?}", decided(list, condition));
        });
        assert!(!passes(list, &case), "{list}{case}");
        assert!(passes(repaired, &case), "{repaired}{case}");
    }
}

#[test]
fn what_only_routines_write_is_not_set_from_outside() {
    let routine = "EI\nLD M8000\nOUT Y000\nFEND\nI001\nLD M8000\nMOV K5 D0\nIRET\nEND\n";
    let decision = decided(routine, "D0 = 7");
    assert!(
        matches!(decision.verdict, Verdict::Undecided(_)),
        "{decision:?}"
    );
    let gaps: Vec<&str> = decision.gaps.iter().map(|gap| gap.what.as_str()).collect();
    let between = "what interrupt routines, edges of inputs and time do between two scans (D0)";
    assert!(gaps.contains(&between), "{gaps:?}");
    for (list, repaired, condition) in FOUND {
        let decision = decided(repaired, condition);
        assert!(
            !matches!(decision.verdict, Verdict::Found(_)),
            "{repaired}: {decision:?}, not {list}"
        );
    }
}

#[test]
fn what_routines_of_two_programs_write_is_not_supposed_to_be_the_same() {
    let pairs = [
        (
            "EI\nLD= D0 K5\nOUT Y000\nFEND\nI001\nLD M8000\nMOV K5 D0\nIRET\nEND\n",
            "EI\nLD= D0 K5\nOUT Y000\nFEND\nI001\nLD M8000\nMOV K6 D0\nIRET\nEND\n",
        ),
        (
            "LD M8000\nOUT C235 K100\nDHSCS K2 C235 Y000\nEND\n",
            "LD M8000\nOUT C235 K100\nDHSCS K3 C235 Y000\nEND\n",
        ),
        (
            "LD M8000\nOUT C235 K100\nDHSCS K2 C235 M0\nLD M0\nOUT Y000\nEND\n",
            "LD M8000\nOUT C235 K100\nDHSCS K3 C235 M0\nLD M0\nOUT Y000\nEND\n",
        ),
        (
            "EI\nLD M0\nOUT Y000\nFEND\nI001\nLD M8000\nSET M0\nIRET\nEND\n",
            "EI\nLD M0\nOUT Y000\nFEND\nI101\nLD M8000\nSET M0\nIRET\nEND\n",
        ),
        (
            "EI\nLD M0\nOUT Y000\nFEND\nI610\nLD M8000\nALT M0\nIRET\nEND\n",
            "EI\nLD M0\nOUT Y000\nFEND\nI620\nLD M8000\nALT M0\nIRET\nEND\n",
        ),
        (
            "LDD> D8340 K15\nOUT Y001\nLD X000\nDPLSY K100 K10 Y000\nEND\n",
            "LDD> D8340 K15\nOUT Y001\nLD X000\nDPLSY K100 K20 Y000\nEND\n",
        ),
        // Scans write other values before the routine that both have.
        (
            "EI\nLD= D0 K1\nOUT Y000\nLD M8000\nMOV K1 D0\nFEND\nI001\nLD M8000\nMOV K5 D0\nIRET\nEND\n",
            "EI\nLD= D0 K1\nOUT Y000\nLD M8000\nMOV K2 D0\nFEND\nI001\nLD M8000\nMOV K5 D0\nIRET\nEND\n",
        ),
    ];
    let options = Options {
        effort: 500,
        ..Options::default()
    };
    let mut wrong = Vec::new();
    for (old, new) in pairs {
        let [of_old, of_new] = [old, new].map(module);
        for output in compare(&of_old, &of_new, &options).outputs {
            if output.verdict == Verdict::Proved {
                wrong.push((old, new));
            }
        }
        assert!(compare(&of_old, &of_old, &options).is_proved(), "{old}");
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}
