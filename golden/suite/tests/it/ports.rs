//! Serial ports of emitted programs: what a partner on the line may ask for.

use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::comm::{CharFault, Received};
use rungc_sim::engines::cortex_m::{CORTEX_M3, CORTEX_M4, build_for, missing};
use rungc_sim::engines::{Engine, EngineKind, build};
use rungc_sim::protocol::{Answer, Request};
use std::path::Path;

/// A Modbus slave on COM1 that names D100 and D101.
const PROGRAM: &str = "LD M8002\nMOV H2 D8126\nMOV H81 D8120\nLD M8000\nMOV D100 D101\nEND\n";

/// Reads D100 and D200 of station 1.
const READ_D100: [u8; 8] = [0x01, 0x03, 0x00, 0x64, 0x00, 0x01, 0xc5, 0xd5];
const READ_D200: [u8; 8] = [0x01, 0x03, 0x00, 0xc8, 0x00, 0x01, 0x05, 0xf4];

fn module() -> Module {
    let read = rungc_frontend::read_text("slave.il", PROGRAM);
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        optimise: true,
        ..CompileOptions::default()
    };
    let compiled = compile(&read.program, &options);
    compiled.module.expect("the program compiles")
}

/// Answer of the PLC, from this millisecond on.
fn answer(engine: &mut dyn Engine, from_ms: u32, request: &[u8]) -> Vec<u8> {
    let mut at_us = from_ms * 1000;
    for &byte in request {
        at_us += 1042;
        let fault = CharFault::None;
        let character = Received { at_us, byte, fault };
        engine.execute(Request::Receive(1, character)).unwrap();
    }
    for now_ms in (from_ms..from_ms + 100).step_by(5) {
        let scan_us = 5000;
        engine.execute(Request::Scan { now_ms, scan_us }).unwrap();
    }
    let mut sent = Vec::new();
    while let Answer::Value(packed) = engine.execute(Request::Sent(1, u32::MAX / 2)).unwrap() {
        sent.push(packed as u8);
    }
    sent
}

/// Asks for a device that the program names, and for one that it does not.
fn check(engine: &mut dyn Engine, kind: EngineKind) {
    engine.execute(Request::Case(0)).unwrap();
    for now_ms in [0, 5] {
        let scan_us = 5000;
        engine.execute(Request::Scan { now_ms, scan_us }).unwrap();
    }
    let good = answer(engine, 10, &READ_D100);
    let name = engine.name().to_string();
    assert_eq!(good, [0x01, 0x03, 0x02, 0x00, 0x00, 0xb8, 0x44], "{name}");
    let other = answer(engine, 200, &READ_D200);
    let refused = [0x01, 0x83, 0x02, 0xc0, 0xf1];
    match kind {
        // It has all devices of the model.
        EngineKind::Interp => assert_eq!(other, good, "{name}"),
        EngineKind::C | EngineKind::Rust => assert_eq!(other, refused, "{name}"),
    }
}

#[test]
fn an_emitted_program_refuses_what_it_does_not_store() {
    let modules = [module()];
    assert_eq!(modules[0].ports, [1]);
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ports");
    for kind in EngineKind::ALL {
        let mut engine = build(kind, &modules, &target).unwrap_or_else(|error| panic!("{error}"));
        check(engine.as_mut(), kind);
    }
}

/// A microcontroller answers as well; its hardware is virtual.
#[test]
fn a_microcontroller_answers() {
    let modules = [module()];
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("ports");
    for (board, kind) in [(CORTEX_M3, EngineKind::C), (CORTEX_M4, EngineKind::Rust)] {
        let missing = missing(&board);
        if !missing.is_empty() {
            let required = std::env::var_os("RUNGC_REQUIRE_EMBEDDED").is_some();
            assert!(!required, "missing: {}", missing.join(", "));
            eprintln!("not run: there is no {}", missing.join(", "));
            continue;
        }
        let engine = build_for(&board, kind, &modules, &target);
        let mut engine = engine.unwrap_or_else(|error| panic!("{error}"));
        check(engine.as_mut(), kind);
    }
}
