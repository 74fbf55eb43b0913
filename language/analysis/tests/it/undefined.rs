//! Special devices without a meaning: each model has a row for a number, or warns of it.

use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_models::runs::is_special;
use rungc_models::{Model, ModelId};
use rungc_syntax::DeviceClass::{self, D, M};
use rungc_syntax::{Device, codes};
use std::collections::BTreeSet;
use std::fmt::Write;

/// The devices of which `rungc check` says that the model gives them no meaning.
fn warned(model: &'static Model, text: &str) -> BTreeSet<Device> {
    let program = rungc_frontend::read_text("p.il", text).program;
    let (resolved, _) = resolve(&program, model);
    let found = check(&resolved);
    let found = found
        .iter()
        .filter(|d| d.code == codes::UNDEFINED_SPECIAL.id);
    found.flat_map(|d| d.devices.clone()).collect()
}

/// All special numbers of a class, and those without a row.
fn numbers(model: &Model, class: DeviceClass) -> (Vec<Device>, BTreeSet<Device>) {
    let ranges = model.ranges_of(class);
    let all = ranges.flat_map(|range| range.first..=range.last);
    let all = all.filter(|&number| is_special(class, number));
    let all: Vec<_> = all.map(|number| Device { class, number }).collect();
    let without = all
        .iter()
        .filter(|d| model.special(class, d.number).is_none());
    let without = without.copied().collect();
    (all, without)
}

#[test]
fn every_special_device_has_a_row_or_warns() {
    let forms = [
        (M, "LD DEVICE\nOUT Y0\n"),
        (M, "LD X0\nSET DEVICE\n"),
        (D, "LD X0\nMOV DEVICE D10\n"),
        (D, "LD X0\nMOV K7 DEVICE\n"),
    ];
    for model in ModelId::ALL.map(Model::get) {
        for (class, form) in forms {
            let (all, without) = numbers(model, class);
            let mut text = String::new();
            for device in &all {
                let _ = write!(text, "{}", form.replace("DEVICE", &device.to_string()));
            }
            text.push_str("END\n");
            assert_eq!(warned(model, &text), without, "{} {form}", model.name);
            assert!(without.len() > 5, "{} {class:?}", model.name);
        }
    }
}

/// Devices whose meaning on one model is not that of another: no row of the one was copied from the other.
#[test]
fn no_row_belongs_to_another_model() {
    let absent: &[(ModelId, DeviceClass, u32, u32)] = &[
        (ModelId::Fx3u, M, 8062, 8062),
        (ModelId::Fx3u, M, 8145, 8148),
        (ModelId::Fx3u, M, 8164, 8164),
        (ModelId::Fx3u, D, 8145, 8148),
        (ModelId::Fx3u, D, 8164, 8164),
        (ModelId::Fx3g, M, 8145, 8148),
        (ModelId::Fx3g, M, 8164, 8164),
        (ModelId::Fx1n, M, 8164, 8164),
        (ModelId::Fx1s, M, 8178, 8179),
        (ModelId::Fx2n, M, 8178, 8179),
        (ModelId::Fx2n, M, 8112, 8117),
        (ModelId::H2u, M, 8010, 8010),
        (ModelId::L01s, M, 8009, 8009),
        (ModelId::Fx3u, M, 8010, 8010),
        (ModelId::Hm, M, 8013, 8013),
    ];
    for &(id, class, first, last) in absent {
        for number in first..=last {
            let row = Model::get(id).special(class, number);
            assert!(row.is_none(), "{id:?} {}", class.number(number));
        }
    }
}

#[test]
fn long_runs_mean_none_of_their_devices() {
    let fx3u = Model::get(ModelId::Fx3u);
    assert_eq!(
        warned(fx3u, "LD X0\nZRST M8000 M8255\nEND\n"),
        BTreeSet::new()
    );
}

#[test]
fn the_second_word_of_a_value_is_reported_as_such() {
    let found = |text: &str| {
        let program = rungc_frontend::read_text("p.il", text).program;
        let (resolved, _) = resolve(&program, Model::get(ModelId::Fx1n));
        let found = check(&resolved);
        let found = found
            .iter()
            .filter(|d| d.code == codes::UNDEFINED_SPECIAL.id);
        let found = found.map(|d| {
            let others = d.others.iter().map(|label| format!(" / {}", label.text));
            let others: String = others.collect();
            let help = d.help.as_deref().unwrap_or_default();
            format!("{}: {}{others}. {help}", d.message, d.label)
        });
        found.collect::<Vec<_>>().join("\n")
    };
    let single = "`D8148` holds 16 bits: use the 16-bit form of the instruction";
    assert_eq!(
        found("LD X0\nDMOV K100000 D8148\nEND\n"),
        format!(
            "`D8149` has no meaning on Mitsubishi FX1N: written with `D8148` as a 32-bit value. {single}"
        )
    );
    assert_eq!(
        found("LD X0\nDMOV D8148 D0\nEND\n"),
        format!(
            "`D8149` has no meaning on Mitsubishi FX1N: read with `D8148` as a 32-bit value. {single}"
        )
    );
    // Both words of a value are one mistake.
    let both = found("LD X0\nDMOV K1 D8150\nEND\n");
    assert!(
        both.starts_with("`D8150` has no meaning on Mitsubishi FX1N: written here"),
        "{both}"
    );
    assert_eq!(found("LD X0\nDMOV K1 D8146\nMOV K1 D8148\nEND\n"), "");
}

/// What GX Works2 writes before it converts an integer to a REAL.
#[test]
fn clearing_the_mode_of_conversions_is_usual() {
    for model in ModelId::ALL.map(Model::get) {
        let warned = |text| {
            let program = rungc_frontend::read_text("p.il", text).program;
            let found = check(&resolve(&program, model).0);
            found
                .iter()
                .any(|d| d.code == codes::UNDEFINED_SPECIAL.id && d.message.contains("M8023"))
        };
        assert!(!warned("LD M8000\nRST M8023\nEND\n"), "{}", model.name);
        assert!(warned("LD X0\nSET M8023\nEND\n"), "{}", model.name);
        assert!(warned("LD M8023\nOUT Y0\nEND\n"), "{}", model.name);
    }
}
