//! Every conformance case on every engine.
//!
//! A case that does not pass must be listed in `conformance/EXPECTED_FAILURES.toml` with the reason, and a listed case that
//! passes must be taken from the list.

mod suite;

use rungc_sim::engines::{EngineKind, build};
use std::path::Path;
use suite::Conformance;

#[test]
fn all_engines_pass_all_cases() {
    let conformance = Conformance::load();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    let mut wrong = Vec::new();
    for kind in EngineKind::ALL {
        let engine = build(kind, conformance.modules(), &target);
        let mut engine = engine.unwrap_or_else(|error| panic!("{error}"));
        wrong.extend(conformance.run(&mut *engine));
    }
    assert!(
        wrong.is_empty(),
        "{} cases went otherwise than expected:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
