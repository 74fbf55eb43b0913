use super::{Extent, Forms, Lower, Spelling, all, explain, find, special_table, support_table};
use crate::Form;
use rungc_models::{Model, ModelId};
use rungc_syntax::{Device, DeviceClass, Operand, OperandKind, Span};
use std::collections::BTreeMap;

#[test]
fn no_spelling_has_two_meanings() {
    let mut seen = BTreeMap::new();
    for inst in all() {
        for (spelling, form) in inst.spellings() {
            let before = seen.insert(spelling.clone(), (inst.name, form));
            assert_eq!(before, None, "{spelling}");
        }
    }
}

#[test]
fn extents_name_operands_that_exist() {
    for inst in all() {
        let lists = inst.variants.iter().filter_map(|variant| variant.params);
        for params in lists.chain([inst.params]) {
            for param in params {
                if let Extent::Operand { i, .. } | Extent::Through(i) = param.extent {
                    assert!(i < params.len(), "{} {}", inst.name, param.name);
                }
                assert!(!param.classes.is_empty(), "{} {}", inst.name, param.name);
            }
            let optional = params.iter().skip_while(|param| !param.optional);
            assert!(
                optional.into_iter().all(|param| param.optional),
                "{}",
                inst.name
            );
        }
    }
}

#[test]
fn sources_are_manuals_of_models_that_have_the_instruction() {
    for inst in all() {
        let is_inovance = [ModelId::H1u, ModelId::H2u].map(|model| inst.models.has(model));
        let cited = inst.source.starts_with("h1u-h2u-programming");
        assert!(!cited || is_inovance.contains(&true), "{}", inst.name);
    }
}

#[test]
fn every_row_has_a_form_and_a_text() {
    for inst in all() {
        assert!(
            inst.forms.has(Forms::W16) || inst.forms.has(Forms::W32),
            "{}",
            inst.name
        );
        assert!(
            !inst.title.is_empty() && !inst.text.is_empty(),
            "{}",
            inst.name
        );
        let unsaid = matches!(inst.lower, Lower::Todo(reason) if reason == super::row::NO_LOWERING);
        assert!(!unsaid, "{}", inst.name);
        if let Spelling::Wide(_) = inst.spelling {
            assert!(inst.forms.has(Forms::W32), "{}", inst.name);
        }
    }
}

#[test]
fn spellings_lead_to_rows_and_forms() {
    let of = |mnemonic: &str| find(mnemonic).map(|found| (found.inst.name, found.form));
    let form = |wide, pulse| Form { wide, pulse };
    assert_eq!(of("DADDP"), Some(("ADD", form(true, true))));
    assert_eq!(of("LDP"), Some(("LDP", form(false, false))));
    assert_eq!(of("LDD>="), Some(("LD>=", form(true, false))));
    assert_eq!(of("DAND"), Some(("WAND", form(true, false))));
    assert_eq!(of("P12"), Some(("P", form(false, false))));
    assert_eq!(of("I001"), Some(("I", form(false, false))));
    assert_eq!(of("PI0"), None);
    assert_eq!(of("DFOR"), None);
    assert_eq!(of("MOVE"), None);
}

/// A text takes two more steps for each two characters more; that of ASC always has room for eight.
#[test]
fn longer_texts_take_more_steps() {
    let span = Span::default();
    let text = |text: &str| OperandKind::Text(text.into());
    let d = || {
        OperandKind::Device(
            Device {
                class: DeviceClass::D,
                number: 0,
            },
            None,
        )
    };
    let steps = |mnemonic: &str, kinds: Vec<OperandKind>| {
        let operands: Vec<_> = kinds
            .into_iter()
            .map(|kind| Operand { span, kind })
            .collect();
        let found = find(mnemonic).unwrap_or_else(|| panic!("{mnemonic}"));
        found
            .inst
            .steps_of(found.form, &operands, Model::get(ModelId::Fx3u))
    };
    for (length, more) in [
        (0, 0),
        (1, 0),
        (2, 0),
        (3, 2),
        (4, 2),
        (5, 4),
        (6, 4),
        (16, 14),
    ] {
        let written = "A".repeat(length);
        assert_eq!(
            steps("$MOV", vec![text(&written), d()]),
            5 + more,
            "{length}"
        );
        assert_eq!(
            steps("$MOVP", vec![text(&written), d()]),
            5 + more,
            "{length}"
        );
        assert_eq!(
            steps("$+", vec![d(), text(&written), d()]),
            7 + more,
            "{length}"
        );
        assert_eq!(
            steps("$+", vec![text(&written), text(&written), d()]),
            7 + 2 * more,
            "{length}"
        );
        assert_eq!(
            steps("INSTR", vec![text(&written), d(), d(), d()]),
            9 + more,
            "{length}"
        );
    }
    assert_eq!(steps("$MOV", vec![text("启动"), d()]), 7);
    assert_eq!(
        steps("ASC", vec![text("A"), d()]),
        steps("ASC", vec![text("ABCDEFGH"), d()])
    );
}

/// Steps as the list export of an FX2N project shows them.
#[test]
fn steps_are_those_of_the_editor() {
    let device = |class, number| OperandKind::Device(Device { class, number }, None);
    let k = OperandKind::Decimal(0, None);
    let [x, m, s] = [DeviceClass::X, DeviceClass::M, DeviceClass::S].map(|class| device(class, 0));
    let d = device(DeviceClass::D, 0);
    let t = device(DeviceClass::T, 0);
    let special = device(DeviceClass::M, 8000);
    let wide_counter = device(DeviceClass::C, 200);
    let p = device(DeviceClass::P, 0);
    let model = Model::get(ModelId::Fx2n);
    let listing = [
        ("LD", vec![x.clone()], 1),
        ("OUT", vec![m.clone()], 1),
        ("ANB", vec![], 1),
        ("PLS", vec![m.clone()], 2),
        ("SET", vec![m.clone()], 1),
        ("RST", vec![m.clone()], 1),
        ("MPS", vec![], 1),
        ("LDP", vec![m.clone()], 2),
        ("ORF", vec![m.clone()], 2),
        ("MOV", vec![k.clone(), d.clone()], 5),
        ("ADD", vec![d.clone(), k.clone(), d.clone()], 7),
        ("DIVP", vec![d.clone(), k.clone(), d.clone()], 7),
        ("DMOV", vec![k.clone(), d.clone()], 9),
        ("DMUL", vec![d.clone(), k.clone(), d.clone()], 13),
        ("LD=", vec![k.clone(), d.clone()], 5),
        ("LDD=", vec![k.clone(), d.clone()], 9),
        ("WOR", vec![d.clone(), k.clone(), d.clone()], 7),
        ("INC", vec![d.clone()], 3),
        ("DDECP", vec![d.clone()], 5),
        ("LD", vec![special.clone()], 1),
        ("CJ", vec![p.clone()], 3),
        ("CALL", vec![p], 3),
        ("FOR", vec![k.clone()], 3),
        ("NEXT", vec![], 1),
        ("P1", vec![], 1),
        ("SRET", vec![], 1),
        ("OUT", vec![special], 2),
        ("OUT", vec![t, k.clone()], 3),
        ("OUT", vec![wide_counter, k], 5),
        ("SET", vec![s], 2),
        ("RST", vec![d], 3),
        ("END", vec![], 1),
    ];
    for (mnemonic, operands, steps) in listing {
        let found = find(mnemonic).unwrap_or_else(|| panic!("{mnemonic}"));
        let span = Span::default();
        let placed = |kind| Operand { span, kind };
        let operands: Vec<Operand> = operands.into_iter().map(placed).collect();
        assert_eq!(
            found.inst.steps_of(found.form, &operands, model),
            steps,
            "{mnemonic}"
        );
    }
}

#[test]
fn pages_and_tables_can_be_made() {
    for inst in all() {
        let page = explain(inst.name).unwrap_or_else(|| panic!("{}", inst.name));
        assert!(page.contains(inst.text), "{}", inst.name);
    }
    insta::assert_snapshot!("explain_add", explain("daddp").unwrap_or_default());
    insta::assert_snapshot!("explain_deco", explain("DECO").unwrap_or_default());
    insta::assert_snapshot!("explain_m8034", explain("m8034").unwrap_or_default());
    assert_eq!(explain("MOVE"), None);
    assert_eq!(explain("M7000"), None);
    assert_eq!(explain("Mé"), None);
    let table = support_table();
    for inst in all() {
        assert!(
            table.contains(&format!("| `{}` |", inst.name)),
            "{}",
            inst.name
        );
    }
    assert!(special_table(ModelId::H2u).contains("| M8002 | read | 0 |"));
}

/// Nothing of the runtime is out of reach, but for what the scan itself calls.
#[test]
fn every_runtime_function_has_a_row() {
    let without_row = [
        rungc_rt::RtFn::AnalogInputs,
        rungc_rt::RtFn::Potentiometers,
        rungc_rt::RtFn::ExchangeModule,
        rungc_rt::RtFn::ExchangeBoard,
        rungc_rt::RtFn::ExchangeAdapter,
        rungc_rt::RtFn::ClockRefresh,
        rungc_rt::RtFn::ClockRefreshShort,
        rungc_rt::RtFn::LogError,
        rungc_rt::RtFn::PowerSupply,
        rungc_rt::RtFn::Oscilloscope,
        rungc_rt::RtFn::StopPulses,
    ];
    for function in rungc_rt::RtFn::ALL {
        let calls = |lower: &Lower| match lower {
            Lower::Call(called) | Lower::Exclusive(called) => called == function,
            _ => false,
        };
        let reached = all()
            .any(|inst| calls(&inst.lower) || inst.lower_on.iter().any(|(_, lower)| calls(lower)));
        assert!(reached || without_row.contains(function), "{function:?}");
    }
}

#[test]
fn basic_instructions_are_the_same_on_all_models() {
    for inst in all() {
        let overrides = inst.lower_on.iter().map(|(_, lower)| lower);
        let basic = overrides.filter(|lower| matches!(lower, Lower::Basic(_)));
        assert_eq!(basic.count(), 0, "{}", inst.name);
        assert!(
            inst.basic().is_none() || inst.lower_on.is_empty(),
            "{}",
            inst.name
        );
    }
}
