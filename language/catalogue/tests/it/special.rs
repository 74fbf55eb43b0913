//! Special devices and the instructions that their tables name.

use rungc_catalogue::{all, find};
use rungc_models::special::Status;
use rungc_models::{Model, ModelId, plc_errors};
use rungc_syntax::DeviceClass;
use std::collections::BTreeSet;

/// Names of instructions in a text: its words in capitals that the catalogue has.
fn instructions(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    words.filter(|word| {
        word.len() > 1 && word.chars().all(|c| !c.is_ascii_lowercase()) && find(word).is_some()
    })
}

/// Every instruction that a special device works with, or that its meaning names, exists on the device's model.
#[test]
fn special_devices_name_instructions_of_their_model() {
    let mut wrong = BTreeSet::new();
    for id in ModelId::ALL {
        for row in Model::get(id).specials() {
            let names = match row.status {
                Status::Instructions(names) => names,
                _ => "",
            };
            for name in instructions(names).chain(instructions(row.text)) {
                let inst = find(name).unwrap().inst;
                if !inst.models.has(id) {
                    wrong.insert(format!("{id:?} {:?}{} {name}", row.class, row.first));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Every special device that an instruction uses on a model is one there: a program that uses it gets no warning
/// that nothing depends on it (W0302), and the scan obeys it.
#[test]
fn instructions_have_their_special_devices() {
    let mut wrong = BTreeSet::new();
    for inst in all() {
        for id in ModelId::ALL.into_iter().filter(|&id| inst.models.has(id)) {
            let model = Model::get(id);
            for flag in inst.flags_on(id) {
                let class = DeviceClass::from_prefix(&flag[..1]).unwrap();
                let number = flag[1..].parse().unwrap();
                if model.special(class, number).is_none() {
                    wrong.insert(format!("{} {flag} {}", inst.name, model.name));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Every instruction that an error's text names exists on the error's models.
#[test]
fn errors_name_instructions_of_their_model() {
    let mut wrong = BTreeSet::new();
    for id in ModelId::ALL {
        for code in 0..10000 {
            let Some(error) = plc_errors::find(code, id) else {
                continue;
            };
            for text in [error.title, error.meaning, error.remedy] {
                for name in instructions(text) {
                    let inst = find(name).unwrap().inst;
                    if !inst.models.has(id) {
                        wrong.insert(format!("{id:?} {code} {name}"));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
