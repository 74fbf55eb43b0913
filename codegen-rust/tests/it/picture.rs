//! The design's target picture, as emitted.

use crate::common;
use rungc_codegen_rust::{Options, Runtime, emit};

fn emitted(path: &str) -> String {
    let options = Options {
        main: true,
        runtime: Runtime::At("../runtime-rt".to_string()),
        ..Options::default()
    };
    let files = emit(&common::motor(), &options);
    let file = files.into_iter().find(|file| file.path == path);
    file.map(|file| file.contents).unwrap_or_default()
}

#[test]
fn program() {
    insta::assert_snapshot!(emitted("src/program.rs"));
}

#[test]
fn library() {
    insta::assert_snapshot!(emitted("src/lib.rs"));
}

#[test]
fn devices() {
    insta::assert_snapshot!(emitted("src/devices.rs"));
}

#[test]
fn manifest() {
    insta::assert_snapshot!(emitted("Cargo.toml"));
}
