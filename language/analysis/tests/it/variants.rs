//! Variants of models, held to the catalogue.

use rungc_models::{Model, VARIANTS};

#[test]
fn what_a_variant_lacks_its_family_has() {
    for variant in &VARIANTS {
        for name in variant.lacks.concat() {
            let row = rungc_catalogue::all().find(|inst| inst.name == name);
            let row = row.unwrap_or_else(|| panic!("no row is named {name}"));
            let model = Model::get(variant.model);
            assert!(row.models.has(model.id), "{}: {name}", variant.name);
        }
    }
}
