//! Comparisons of programs.

use super::compare;
use crate::prove::{Options, Verdict};
use crate::tests::module;
use rungc_ir::Module;
use rungc_syntax::DeviceClass;

/// The program with D0 latched, as the parameters of a project may have it.
fn with_latched(list: &str) -> Module {
    let mut module = module(list);
    for range in module.ranges.to_mut() {
        range.latched |= range.class == DeviceClass::D && range.first == 0;
    }
    module
}

#[test]
fn both_programs_go_through_stop_together() {
    // D600 is latched: after STOP it shows what the pulse of power-on has hidden.
    let old = "LD M8002\nMOV D600 D0\nLD X000\nMOV K1 D600\nLD= D0 K1\nOUT Y000\nEND\n";
    let new = old.replace("MOV K1 D600", "MOV K2 D600");
    let compared = compare(&module(old), &module(&new), &Options::default());
    let Verdict::Found(trace) = &compared.outputs[0].verdict else {
        panic!("{compared:?}");
    };
    assert!(trace.scans.iter().any(|scan| scan.restart));
    assert!(compare(&module(old), &module(old), &Options::default()).is_proved());
}

#[test]
fn other_latched_devices_are_compared_and_named() {
    const LIST: &str = "LD X000\nMOV K5 D0\nLD= D0 K5\nOUT Y000\nLD X001\nOUT Y001\nEND\n";
    let compared = compare(&module(LIST), &with_latched(LIST), &Options::default());
    assert_eq!(compared.latched_apart, [(DeviceClass::D, 0)]);
    let [y0, y1] = &compared.outputs[..] else {
        panic!("{compared:?}");
    };
    // After power-off, D0 is still 5 in one of them.
    let Verdict::Found(trace) = &y0.verdict else {
        panic!("{y0:?}");
    };
    assert!(trace.start.values().any(|value| *value == 5));
    assert_eq!(y1.verdict, Verdict::Proved);
    // Where every scan writes it first, that does not matter.
    let first = LIST.replace("LD X000\nMOV K5 D0", "LD M8000\nMOV K4X000 D0");
    let compared = compare(&module(&first), &with_latched(&first), &Options::default());
    assert!(compared.is_proved(), "{compared:?}");
    assert_eq!(compared.latched_apart, [(DeviceClass::D, 0)]);
}

#[test]
fn what_an_equal_program_remembers_is_the_same() {
    for call in ["TTMR D220 K0", "PID D0 D10 D20 D220", "HOUR K1 D220 M10"] {
        let list = format!("LD X000\n{call}\nLD> D220 K100\nOUT Y001\nEND\n");
        let compared = compare(&module(&list), &module(&list), &Options::default());
        assert!(compared.is_proved(), "{call}: {compared:?}");
    }
    // A fresh timer is not the one that has run.
    let old = "LD X000\nTTMR D220 K0\nLD X001\nTTMR D230 K0\nLD> D220 K100\nOUT Y001\nEND\n";
    let new = old
        .replace("LD X000\nTTMR D220 K0\n", "")
        .replace("D230", "D220");
    assert!(!compare(&module(old), &module(&new), &Options::default()).is_proved());
}
