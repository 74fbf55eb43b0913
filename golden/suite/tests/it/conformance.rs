//! Every conformance case on every engine.
//!
//! A case that contradicts its manual is listed in `conformance/DISPUTED.toml` with the reason. All others must pass,
//! and a listed case that passes must be removed from the list.

use crate::suite::Conformance;
use rungc_sim::engines::{EngineKind, build};
use std::path::Path;
use std::sync::LazyLock;

static CONFORMANCE: LazyLock<Conformance> =
    LazyLock::new(|| Conformance::load(usize::MAX).remove(0));

fn check(kind: EngineKind) {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    let engine = build(kind, CONFORMANCE.modules(), &target);
    let mut engine = engine.unwrap_or_else(|error| panic!("{error}"));
    let wrong = CONFORMANCE.run(&mut *engine);
    assert!(
        wrong.is_empty(),
        "{} cases went otherwise than expected:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn interpreter_passes_all_cases() {
    check(EngineKind::Interp);
}

#[test]
fn emitted_c_passes_all_cases() {
    check(EngineKind::C);
}

#[test]
fn emitted_rust_passes_all_cases() {
    check(EngineKind::Rust);
}

#[test]
fn every_engine_has_its_test() {
    let tested = [EngineKind::Interp, EngineKind::C, EngineKind::Rust];
    assert_eq!(EngineKind::ALL, tested);
}
