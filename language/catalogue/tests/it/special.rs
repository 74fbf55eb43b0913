//! Special devices and the instructions that their tables name.

use rungc_catalogue::find;
use rungc_models::special::Status;
use rungc_models::{Model, ModelId};
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
            for name in instructions(names).chain(instructions(row.meaning)) {
                let inst = find(name).unwrap().inst;
                if !inst.models.has(id) {
                    wrong.insert(format!("{id:?} {:?}{} {name}", row.class, row.first));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
