//! Ranges of indexes: the devices that compiled programs store for them.

use rungc_ir::validate::validate;
use rungc_lower::compile::{Bound, CompileOptions, Compiled, compile};
use rungc_models::ModelId;
use rungc_syntax::{Device, DeviceClass, Index};
use std::fmt::Write;

fn compiled(text: &str, options: CompileOptions) -> Compiled {
    let read = rungc_frontend::read_text("test.il", text);
    let compiled = compile(&read.program, &options);
    if let Some(module) = &compiled.module {
        assert_eq!(validate(module), Ok(()), "{text}");
    }
    compiled
}

fn stored_with(text: &str, options: CompileOptions) -> String {
    let compiled = compiled(text, options);
    let module = compiled
        .module
        .unwrap_or_else(|| panic!("{text}: {:?}", compiled.diagnostics));
    let arrays = module.layout.areas.iter().filter(|area| area.array);
    let names = arrays.map(|area| {
        let last = area.first + area.count - 1;
        format!(
            "{}-{}",
            area.class.number(area.first),
            area.class.number(last)
        )
    });
    names.collect::<Vec<_>>().join(" ")
}

/// The arrays of a program for FX3U.
fn stored(text: &str) -> String {
    stored_with(text, CompileOptions::default())
}

#[track_caller]
fn stores(text: &str, arrays: &str) {
    assert_eq!(stored(text), arrays, "{text}");
}

#[test]
fn constants_lead_to_one_device() {
    stores("LD X0\nMOV K5 Z0\nMOV D100Z0 D1\nEND\n", "");
    stores(
        "LD X0\nMOV K5 Z0\nMOV D100Z0 D1\nLD X1\nMOV K7 Z0\nEND\n",
        "",
    );
    stores("LD X1\nMOV D100Z0 D1\nMOV K7 Z0\nEND\n", "D100-D107");
    stores("LD X1\nMOV D100V3 D1\nEND\n", "");
    stores(
        "LD X0\nRST Z0\nLD X1\nMOV K3 Z0\nLD X2\nMOV D10Z0 D0\nEND\n",
        "D10-D13",
    );
}

#[test]
fn masks_groups_and_sums_bound_an_index() {
    stores("LD X0\nWAND D0 K15 Z0\nMOV D100Z0 D1\nEND\n", "D100-D115");
    stores(
        "LD X0\nWAND D0 H3F D5\nMOV D5 Z0\nMOV D100Z0 D1\nEND\n",
        "D100-D163",
    );
    stores(
        "LD X0\nMOV K1X010 Z0\nMOV D100Z0 D1\nEND\n",
        "X010-X013 D100-D115",
    );
    stores(
        "LD X0\nMOV K2X0 D9\nADD D9 K10 Z0\nMOV D100Z0 D1\nEND\n",
        "X000-X007 D110-D199 D200-D365",
    );
    stores(
        "LD X0\nWAND D0 K7 D2\nMUL D2 K4 D4\nMOV D4 Z0\nMOV D100Z0 D1\nEND\n",
        "D100-D128",
    );
    stores(
        "LD X0\nDIV D0 K100 D4\nMOV D5 Z0\nMOV D100Z0 D1\nEND\n",
        "D1-D199",
    );
}

#[test]
fn comparisons_before_the_use_bound_an_index() {
    stores(
        "LD>= D0 K0\nAND< D0 K20\nMOV D0 Z0\nMOV D100Z0 D1\nEND\n",
        "D100-D119",
    );
    stores(
        "LD X0\nMOV D0 Z0\nLD>= Z0 K0\nAND<= Z0 K9\nMOV D100Z0 D1\nEND\n",
        "D100-D109",
    );
    stores(
        "LD X0\nMOV D0 Z0\nLD< Z0 K0\nMOV K0 Z0\nLD> Z0 K9\nMOV K9 Z0\nLD X0\nMOV D100Z0 D1\nEND\n",
        "D100-D109",
    );
    // The comparison is of what Z0 was.
    stores(
        "LD>= Z0 K0\nAND< Z0 K4\nMOV D0 Z0\nWAND Z0 K63 Z0\nMOV D100Z0 D1\nEND\n",
        "D100-D163",
    );
}

#[test]
fn loops_bound_an_index() {
    let text = "LD M8000\nMOV K0 Z0\nFOR K8\nLD M8000\nMOV D100Z0 D1\nINC Z0\nNEXT\nEND\n";
    stores(text, "D100-D107");
    let text = "LD M8000\nMOV K30 Z0\nFOR K1X0\nLD X0\nMOV D100Z0 D1\nDEC Z0\nNEXT\nEND\n";
    stores(text, "X000-X003 D116-D130");
    let nested =
        "LD M8000\nMOV K0 Z0\nFOR K10\nFOR K5\nLD M8000\nMOV D100Z0 D1\nINC Z0\nNEXT\nNEXT\nEND\n";
    stores(nested, "D100-D149");
    // It continues where the last scan left it.
    let text = "FOR K8\nLD M8000\nMOV D100Z0 D1\nINC Z0\nNEXT\nEND\n";
    stores(
        text,
        "D0-D199 D200-D7999 D8000-D8027 D8030-D8181 D8196-D8511",
    );
}

#[test]
fn what_one_scan_leaves_to_the_next_is_known() {
    let ring = "LDP X0\nINC Z0\nLD>= Z0 K10\nMOV K0 Z0\nLD M8000\nMOV D100Z0 D1\nEND\n";
    stores(ring, "D100-D109");
    let down = "LDP X0\nDEC Z0\nLD< Z0 K0\nMOV K24 Z0\nLD M8000\nMOV D100Z0 D1\nEND\n";
    stores(down, "D100-D124");
    let exact = "LDP X0\nINC Z0\nLD= Z0 K10\nMOV K0 Z0\nLD M8000\nMOV D100Z0 D1\nEND\n";
    stores(exact, "D100-D109");
}

#[test]
fn subroutines_and_jumps_are_followed() {
    let call = "LD X0\nMOV K3 Z0\nCALL P1\nLD X1\nMOV K5 Z0\nCALL P1\nFEND\nP1\nLD M8000\nMOV D100Z0 D1\nSRET\nEND\n";
    stores(call, "D103-D105");
    let writes =
        "LD X0\nMOV K3 Z0\nCALL P1\nMOV D100Z0 D1\nFEND\nP1\nLD X2\nMOV K6 Z0\nSRET\nEND\n";
    stores(writes, "D103-D106");
    let jump = "LD X0\nMOV K3 Z0\nCJ P1\nLD M8000\nMOV K8 Z0\nP1\nLD M8000\nMOV D100Z0 D1\nEND\n";
    stores(jump, "D100-D108");
    let back = "LD M8000\nMOV K0 Z0\nP1\nLD M8000\nMOV D100Z0 D1\nINC Z0\nLD< Z0 K6\nCJ P1\nEND\n";
    stores(back, "D100-D105");
    let interrupt = "EI\nLD M8000\nMOV K2 Z0\nMOV D100Z0 D1\nLD M8000\nMOV D200Z0 D2\nFEND\nI001\nLD M8000\nMOV K4 Z0\nIRET\nEND\n";
    stores(interrupt, "D200-D204");
}

#[test]
fn an_index_that_may_be_anything_reaches_the_whole_class() {
    let all = "D0-D199 D200-D7999 D8000-D8027 D8030-D8181 D8196-D8511";
    stores("LD X0\nMOV D0 Z0\nMOV D100Z0 D1\nEND\n", all);
    let observed = CompileOptions {
        observe: vec![(DeviceClass::Z, 0)],
        ..CompileOptions::default()
    };
    let text = "LD X0\nMOV K5 Z0\nLD X1\nMOV D100Z0 D1\nEND\n";
    assert_eq!(stored_with(text, observed), all);
    // By its other name it is the same.
    let observed = CompileOptions {
        observe: vec![(DeviceClass::D, 8028)],
        ..CompileOptions::default()
    };
    assert_eq!(stored_with(text, observed), all);
    // Something else writes it, by a block or by its number.
    stores("LD X0\nFMOV D0 D8027 K2\nMOV D100Z0 D1\nEND\n", all);
    stores("LD X0\nMOV D0 D8028\nMOV D100Z0 D1\nEND\n", all);
    let text = "LD X0\nMOV K28 Z1\nMOV D0 D8000Z1\nMOV D100Z0 D1\nEND\n";
    stores(text, all);
}

#[test]
fn timers_relays_and_inputs_are_bounded_too() {
    let text = "LD X0\nMOV K1X20 Z0\nLD X10Z0\nOUT T0Z0 K5\nLD T0Z0\nSET M20Z0\nOUT C0Z0 K3\nEND\n";
    stores(text, "X010-X027 M20-M35 T0-T15 C0-C15");
}

/// 32-bit instructions take Z with its V.
#[test]
fn pairs_are_indexes_of_32_bit_instructions() {
    stores(
        "LD X0\nDMOV K6 Z1\nLD X1\nDMOV D100Z1 D2\nEND\n",
        "D100-D107",
    );
    let text = "LD X0\nMOV K6 Z1\nMOV D0 V1\nLD X1\nDMOV D100Z1 D2\nEND\n";
    stores(
        text,
        "D0-D199 D200-D7999 D8000-D8027 D8030-D8181 D8196-D8511",
    );
}

#[test]
fn bounds_say_what_is_not_known() {
    let bound = |device, first, last| Bound {
        device: Device {
            class: DeviceClass::D,
            number: device,
        },
        index: Index {
            class: DeviceClass::Z,
            number: 0,
        },
        first,
        last,
    };
    let with = |bounds: &[Bound]| CompileOptions {
        bounds: bounds.to_vec(),
        model: Some(ModelId::Fx3u),
        ..CompileOptions::default()
    };
    let text = "LD X0\nMOV D0 Z0\nMOV D100Z0 D1\nMUL K3 K4 D100Z0\nBMOV D100Z0 D20 K3\nEND\n";
    let arrays = stored_with(text, with(&[bound(100, 90, 119)]));
    assert_eq!(arrays, "D20-D22 D90-D119");
    // A host may write the index; the bound holds.
    let observed = CompileOptions {
        observe: vec![(DeviceClass::Z, 0)],
        ..with(&[bound(100, 90, 119)])
    };
    assert_eq!(stored_with(text, observed), "D20-D22 D90-D119");
    let mut shown = String::new();
    for bounds in [
        vec![],
        vec![bound(100, 100, 119), bound(200, 200, 299)],
        vec![bound(100, 7000, 8100)],
    ] {
        let compiled = compiled(text, with(&bounds));
        for found in compiled.diagnostics.iter() {
            let at = text.get(found.span.range()).expect("a place");
            writeln!(shown, "{} {}", found.code, found.message).expect("a string");
            writeln!(shown, "    `{at}` {}", found.label).expect("a string");
            writeln!(shown, "    {}", found.help.as_deref().unwrap_or("")).expect("a string");
        }
    }
    insta::assert_snapshot!(shown);
}
