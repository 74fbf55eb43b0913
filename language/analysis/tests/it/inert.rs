//! Special devices without an effect: each has its sentence, and whoever depends on one is warned.

use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_models::special::{Missed, Special, Status};
use rungc_models::{Model, ModelId};
use rungc_rt::modules::{KINDS, Kind, Place};
use rungc_syntax::DeviceClass::{D, M};
use rungc_syntax::{FittedModule, codes};
use std::collections::BTreeSet;

/// The help of what `rungc check` says of an inert device in a program for a PLC with these modules.
fn help(model: &'static Model, text: &str, modules: Vec<FittedModule>) -> Option<String> {
    let mut program = rungc_frontend::read_text("p.il", text).program;
    program.parameters.get_or_insert_default().modules = modules;
    let (resolved, _) = resolve(&program, model);
    let found = check(&resolved);
    let found = found.iter().find(|d| d.code == codes::INERT_DEVICE.id)?;
    found.help.as_deref().map(str::to_owned)
}

fn is_warned(model: &'static Model, text: &str, modules: Vec<FittedModule>) -> bool {
    help(model, text, modules).is_some()
}

/// Programs that change a device, and that read it.
fn users(row: &Special) -> [String; 2] {
    let name = row.class.number(row.first);
    match row.class {
        M if row.default == 0 => [
            format!("LD X0\nOUT {name}\nEND\n"),
            format!("LD {name}\nOUT Y0\nEND\n"),
        ],
        M => [
            format!("LD X0\nRST {name}\nEND\n"),
            format!("LD {name}\nOUT Y0\nEND\n"),
        ],
        _ => [
            format!("LD X0\nMOV K{} {name}\nEND\n", row.default ^ 1),
            format!("LD X0\nMOV {name} D10\nEND\n"),
        ],
    }
}

/// The rows of all models that may be inert.
fn rows() -> impl Iterator<Item = (&'static Model, &'static Special)> {
    ModelId::ALL.into_iter().flat_map(|id| {
        let model = Model::get(id);
        let rows = model.specials();
        let may_be = |status| {
            matches!(
                status,
                Status::Inert(_) | Status::Modules(_) | Status::Module(_)
            )
        };
        rows.filter(move |row| may_be(row.status))
            .map(move |row| (model, row))
    })
}

#[test]
fn every_inert_device_has_its_sentence() {
    let mut texts = BTreeSet::new();
    for (model, row) in rows() {
        let reason = row.status.inert(&[]).unwrap();
        let text = reason.text;
        assert!(text.split(' ').count() >= 5, "{} {row:?}", model.name);
        assert!(!text.ends_with('.') && !text.contains("TODO"), "{row:?}");
        texts.insert(text);
    }
    assert!(texts.len() > 20, "{texts:?}");
}

#[test]
fn programs_that_depend_on_an_inert_device_are_warned() {
    for (model, row) in rows() {
        let reason = row.status.inert(&[]).unwrap();
        let [changes, reads] = users(row);
        let [changed, read] = [changes, reads].map(|text| is_warned(model, &text, Vec::new()));
        // Below the special devices, a register that the program writes is its own.
        let (writers, readers) = match (reason.missed, row.first < 8000) {
            (Missed::Never, _) => (false, false),
            (Missed::ByWriters, false) => (true, false),
            (Missed::ByWriters, true) => (false, false),
            (Missed::ByAll, false) => (true, true),
            (Missed::ByAll, true) => (false, true),
        };
        let what = format!("{} {}", model.name, row.class.number(row.first));
        assert_eq!((changed, read), (writers, readers), "{what}");
    }
}

#[test]
fn modules_that_are_listed_work() {
    let mut tried = 0;
    for (model, row) in rows() {
        let (unit, kind) = match row.status {
            Status::Modules(place) => (0, KINDS.iter().find(|kind| kind.place == place)),
            Status::Module(unit) => {
                let fits = |kind: &&Kind| {
                    let place = kind.place;
                    model.module_places.contains(&place) && place.named().contains(&unit)
                };
                (unit, KINDS.iter().find(fits))
            }
            _ => continue,
        };
        let kind = kind.unwrap();
        let [_, reads] = users(row);
        let help = help(model, &reads, Vec::new()).unwrap();
        let named = help.contains(&format!("`{}`", kind.name)) || help.ends_with(" more");
        assert!(named && help.contains("`[[module]]`"), "{help}");
        let fitted = vec![FittedModule {
            unit,
            kind: kind.name,
            delay_ms: 0,
            pins: Vec::new(),
        }];
        for text in users(row) {
            assert!(!is_warned(model, &text, fitted.clone()), "{row:?}");
        }
        // A module of another place does not help.
        let other = KINDS.iter().find(|kind| kind.place == Place::Bus).unwrap();
        let fitted = vec![FittedModule {
            unit: 0,
            kind: other.name,
            delay_ms: 0,
            pins: Vec::new(),
        }];
        let [_, reads] = users(row);
        assert!(is_warned(model, &reads, fitted), "{row:?}");
        assert!(row.class == D || matches!(row.status, Status::Module(_)));
        tried += 1;
    }
    assert!(tried > 30, "{tried}");
}
