//! Decisions that depend on what the model says of instructions and of the PLC.

use super::{Gap, World};
use crate::prove::{Decision, Options, Verdict, decide};
use crate::tests::module;
use rungc_sim::property::{Property, parse};
use rungc_syntax::DeviceClass;

/// Decides whether a condition never holds.
fn never(list: &str, condition: &str, world: World) -> Decision {
    let options = Options {
        world,
        ..Options::default()
    };
    let condition = parse(condition, &|_| Vec::new()).unwrap();
    decide(&module(list), &Property::Never(condition), &options)
}

/// Two outputs that exclude each other, before an instruction.
fn followed_by(instruction: &str) -> String {
    format!("LD X001\nOUT Y010\nLD X002\nANI Y010\nOUT Y011\nLD X000\n{instruction}\nEND\n")
}

#[test]
fn instructions_write_their_own_outputs_and_no_others() {
    const OWN: [&str; 20] = [
        "PLSY K1000 K0 Y000",
        "PLSR K1000 K100 K100 Y000",
        "PWM K10 K50 Y000",
        "DRVI K100 K100 Y000 Y002",
        "DRVA K100 K100 Y000 Y002",
        "DVIT K100 K100 Y000 Y002",
        "PLSV K100 Y000 Y002",
        "SEGL D0 Y000 K0",
        "SEGL D0 Y020 K4",
        "PR D0 Y020",
        "REF Y010 K8",
        "REF X000 K8",
        "MTR X020 Y020 M0 K2",
        "DSW X020 Y020 D0 K1",
        "HKY X020 Y020 D0 M0",
        "ARWS M0 D0 Y020 K0",
        "FMOV K0 D0 K500",
        "ZRN K100 K100 X003 Y000",
        "DSZR X003 X004 Y000 Y002",
        "ZRN K100 K100 X003 Y000\nMOV H20 D8465",
    ];
    for instruction in OWN {
        let found = never(&followed_by(instruction), "Y010 & Y011", World::default());
        assert_eq!(found.verdict, Verdict::Proved, "{instruction}");
    }
    // The direction, a display, a clear signal that the program or a panel leads elsewhere.
    for instruction in [
        "DRVI K100 K100 Y000 Y010",
        "DSZR X003 X004 Y000 Y010",
        "SEGL D0 Y000 K4",
        "ZRN K100 K100 X003 Y000\nMOV H10 D8464",
        "DSZR X003 X004 Y000 Y002\nMOV D0 D8464",
        "ZRN K100 K100 X003 Y000\nMOV K8464 Z0\nMOV H10 D0Z0",
        "ZRN K100 K100 X003 Y000\nAND= D8464 K0\nOUT M0",
    ] {
        let found = never(&followed_by(instruction), "Y010 & Y011", World::default());
        assert_ne!(found.verdict, Verdict::Proved, "{instruction}");
    }
    let panel = World {
        free: [(DeviceClass::D, 8464)].into(),
        ..World::default()
    };
    let found = never(
        &followed_by("ZRN K100 K100 X003 Y000"),
        "Y010 & Y011",
        panel,
    );
    assert_ne!(found.verdict, Verdict::Proved);
    // The usual output of the signal.
    let usual = followed_by("ZRN K100 K100 X003 Y000")
        .replace("Y010", "Y004")
        .replace("Y011", "Y005");
    let found = never(&usual, "Y004 & Y005", World::default());
    assert_ne!(found.verdict, Verdict::Proved);
}

#[test]
fn runs_go_through_stop_where_devices_outlast_it() {
    const LIST: &str =
        "LD M8002\nSET M1\nLD X000\nRST M1\nSET M2\nLD M1\nOUT Y001\nLD M2\nOUT Y002\nEND\n";
    let found = never(LIST, "Y001 & Y002", World::default());
    assert_eq!(found.verdict, Verdict::Proved);
    let keeping = format!("LD M8000\nOUT M8033\n{LIST}");
    let found = never(&keeping, "Y001 & Y002", World::default());
    let Verdict::Found(trace) = found.verdict else {
        panic!("{found:?}");
    };
    let restarts: Vec<bool> = trace.scans.iter().map(|scan| scan.restart).collect();
    assert_eq!(restarts, [false, true]);
    // A latched relay outlasts STOP, too.
    let latched = LIST.replace("M2", "M600");
    let found = never(&latched, "Y001 & Y002", World::default());
    assert!(matches!(found.verdict, Verdict::Found(_)));
    let fresh = World {
        fresh: true,
        ..World::default()
    };
    let found = never(&latched, "Y001 & Y002", fresh);
    assert!(matches!(found.verdict, Verdict::Found(_)));
}

#[test]
fn an_index_is_followed_to_the_devices_that_the_program_names() {
    let list = "LD M8000\nMOV K4X020 Z0\nMOV K4X040 Z1\nLD M8002\nMOV K3 D0\nMOV K7 D5\nLD X000\nMOV D0Z0 D100\nLD= D100 K7\nOUT Y001\nLD X001\n\
                MOV K9 D10Z1\nLD= D5 K9\nOUT Y002\nLD= D0 K4\nOUT Y003\nEND\n";
    for (condition, found) in [("Y001", true), ("Y002", true), ("Y003", false)] {
        let decision = never(list, condition, World::default());
        let is_found = matches!(decision.verdict, Verdict::Found(_));
        assert_eq!((condition, is_found), (condition, found));
        assert_eq!(decision.verdict == Verdict::Proved, !found, "{condition}");
    }
}

#[test]
fn gaps_name_the_instruction_that_causes_them() {
    let gaps = |list: &str| -> Vec<(Option<u32>, bool, String)> {
        let gaps = never(list, "Y010", World::default()).gaps.into_iter();
        let told = gaps.map(
            |Gap {
                 step,
                 is_instruction,
                 what,
             }| (step, is_instruction, what),
        );
        told.collect()
    };
    // The clock is not the first instruction's.
    let clock = "LD X007\nOUT Y000\nLD> D8013 K30\nOUT Y010\nEND\n";
    let registers = (None, false, "registers of the clock".to_string());
    assert_eq!(gaps(clock)[0], registers);
    let call = "LD X007\nOUT Y000\nLD X000\nPID D0 D1 D100 D2\nLD> D2 K30\nOUT Y010\nEND\n";
    assert!(gaps(call).contains(&(Some(3), true, "PID D0 D1 D100 D2".into())));
    let pulses = "LD X007\nOUT Y000\nLD X000\nPLSY K1000 K0 Y010\nEND\n";
    let model = pulses.replace("Y010", "Y000");
    let found = never(&model, "Y000", World::default()).gaps;
    assert!(
        found
            .iter()
            .any(|gap| gap.what == "pulses of PLSY K1000 K0 Y000" && gap.is_instruction)
    );
}

/// Verdicts under load: a thread that keeps a processor busy, and others that decide the same.
#[test]
fn verdicts_depend_on_effort_and_not_on_load() {
    // Y002 needs far more scans than the effort allows.
    let list = "LD X000\nOUT C0 K30000\nLD C0\nOUT Y002\nLD X001\nOUT T0 K3\nLD T0\nANI X002\nOUT Y000\nLD X002\n\
                OUT Y001\nLDP X003\nADD D0 K7 D0\nLD> D0 K20\nMOV K0 D0\nLD= D0 K13\nOUT Y003\nEND\n";
    let decisions = || -> Vec<String> {
        let conditions = ["Y000 & Y001", "Y002 & Y001", "Y003", "Y000 & Y002"];
        let decided = conditions.map(|condition| {
            let condition = parse(condition, &|_| Vec::new()).unwrap();
            let options = Options {
                effort: 60,
                ..Options::default()
            };
            decide(&module(list), &Property::Never(condition), &options)
        });
        let verdicts = decided
            .into_iter()
            .map(|decision| format!("{:?}", decision.verdict));
        verdicts.collect()
    };
    let alone = decisions();
    assert!(
        alone.iter().any(|verdict| verdict.contains("Effort")),
        "{alone:?}"
    );
    let is_over = std::sync::atomic::AtomicBool::new(false);
    std::thread::scope(|scope| {
        for _ in 0..1 {
            scope.spawn(|| {
                while !is_over.load(std::sync::atomic::Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let others: Vec<_> = (0..2).map(|_| scope.spawn(decisions)).collect();
        let others: Vec<_> = others
            .into_iter()
            .map(|other| other.join().unwrap())
            .collect();
        is_over.store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(
            others.iter().all(|other| *other == alone),
            "{alone:?}: {others:?}"
        );
    });
}
