//! Every conformance case on every engine. Where the environment names the run ([`rungc_golden::part`]), emitted Rust,
//! which takes longest to build, is tested with a quarter of them.
//!
//! A case that contradicts its manual is listed in `conformance/DISPUTED.toml` with the reason. All others must pass,
//! and a listed case that passes must be removed from the list.

use crate::suite::Conformance;
use rungc_codegen_c::runtime_calls;
use rungc_golden::part::Part;
use rungc_sim::engines::{EngineKind, build, build_c_with_parts};
use std::path::Path;
use std::sync::LazyLock;

static CONFORMANCE: LazyLock<Conformance> = LazyLock::new(Conformance::all);

fn check(kind: EngineKind, conformance: &Conformance) {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    let engine = build(kind, conformance.modules(), &target);
    let mut engine = engine.unwrap_or_else(|error| panic!("{error}"));
    let wrong = conformance.run(&mut *engine);
    assert!(
        wrong.is_empty(),
        "{} cases went otherwise than expected:\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

#[test]
fn interpreter_passes_all_cases() {
    check(EngineKind::Interp, &CONFORMANCE);
}

#[test]
fn emitted_c_passes_all_cases() {
    check(EngineKind::C, &CONFORMANCE);
}

#[test]
fn emitted_rust_passes_all_cases() {
    let part = Part::one_in(4);
    match part.is_all() {
        true => check(EngineKind::Rust, &CONFORMANCE),
        false => Conformance::load(&part, usize::MAX)
            .iter()
            .for_each(|batch| check(EngineKind::Rust, batch)),
    }
}

/// The runtime's parts in C do what those of the library do.
#[test]
fn parts_in_c_pass_their_cases() {
    let conformance = Conformance::of(|module| {
        let mut calls = runtime_calls(module).into_iter();
        calls.any(|call| call.in_c && !call.steps.is_empty())
    });
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("conformance");
    let engine = build_c_with_parts(conformance.modules(), &target);
    let mut engine = engine.unwrap_or_else(|error| panic!("{error}"));
    let wrong = conformance.run(&mut *engine);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_engine_has_its_test() {
    let tested = [EngineKind::Interp, EngineKind::C, EngineKind::Rust];
    assert_eq!(EngineKind::ALL, tested);
}
