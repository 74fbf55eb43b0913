//! A PLC that runs: time, inputs, forced devices, power and going back.

use rungc_frontend::read_text;
use rungc_ir::Module;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::ModelId;
use rungc_rt::VirtualHal;
use rungc_sim::record::Reading;
use rungc_sim::{Session, Target};
use rungc_syntax::DeviceClass::{C, D, M, X, Y};

fn module(list: &str) -> Module {
    let options = CompileOptions {
        model: Some(ModelId::H2u),
        observe_all: true,
        ..CompileOptions::default()
    };
    compile(&read_text("a.il", list).program, &options)
        .module
        .unwrap()
}

fn session(module: &Module) -> Session<'_> {
    Session::new(module, VirtualHal::new())
}

fn word(session: &Session, target: Target) -> i64 {
    match session.reading(target) {
        Some(Reading::Integer(value, _)) => value,
        other => panic!("{target}: {other:?}"),
    }
}

fn is_on(session: &Session, target: Target) -> bool {
    session.reading(target) == Some(Reading::Bit(true))
}

/// Executes scans of 10 ms.
fn scans(session: &mut Session, count: u32) {
    for _ in 0..count {
        session.scan(10);
        session.pass(10);
    }
}

#[test]
fn an_input_has_an_edge_when_it_changes_between_scans() {
    let module = module("LD M8000\nOUT C235 K1000\nEND\n");
    let mut session = session(&module);
    let (x0, counter) = (Target::Bit(X, 0), Target::Current(C, 235));
    session.set(x0, 1.0).unwrap();
    scans(&mut session, 1);
    assert_eq!(word(&session, counter), 0, "on at power-on");
    for value in [1.0, 0.0, 1.0, 1.0, 0.0] {
        session.set(x0, value).unwrap();
    }
    scans(&mut session, 1);
    assert_eq!(word(&session, counter), 1);
}

#[test]
fn forced_devices_keep_their_values_until_they_are_released() {
    let module = module("LD M8000\nINC D0\nLD X000\nOUT Y000\nEND\n");
    let mut session = session(&module);
    let (d0, y0) = (Target::Word(D, 0), Target::Bit(Y, 0));
    session.force(d0, 7.0).unwrap();
    session.force(y0, 1.0).unwrap();
    scans(&mut session, 3);
    assert_eq!(word(&session, d0), 7);
    assert!(is_on(&session, y0));
    let other = session.force(Target::Pair(D, 0), 1.0);
    assert_eq!(other, Err("release D0 first, which is forced".to_string()));
    session.release(d0).unwrap();
    assert_eq!(session.release(d0), Err("D0 is not forced".to_string()));
    scans(&mut session, 3);
    assert_eq!(word(&session, d0), 10);
    session.release_all();
    scans(&mut session, 1);
    assert!(!is_on(&session, y0));
}

#[test]
fn power_off_and_on_keeps_latched_devices_and_input_terminals() {
    let module = module("LD X000\nOUT Y000\nLD M8002\nINC D0\nINC D512\nEND\n");
    let mut session = session(&module);
    session.set(Target::Bit(X, 0), 1.0).unwrap();
    scans(&mut session, 2);
    session.power_cycle();
    assert_eq!(session.now_ms(), 0);
    scans(&mut session, 1);
    assert!(is_on(&session, Target::Bit(Y, 0)));
    assert_eq!(word(&session, Target::Word(D, 0)), 1);
    assert_eq!(word(&session, Target::Word(D, 512)), 2);
}

#[test]
fn a_session_comes_back_to_a_moment() {
    let module = module("LD M8000\nOUT T0 K5\nINC D0\nLD T0\nOUT Y000\nTRD D100\nEND\n");
    let mut session = session(&module);
    session.force(Target::Bit(M, 5), 1.0).unwrap();
    scans(&mut session, 3);
    let moment = session.save();
    let state = |session: &Session| {
        let targets = [
            Target::Word(D, 0),
            Target::Word(D, 105),
            Target::Current(rungc_syntax::DeviceClass::T, 0),
        ];
        (
            session.now_ms(),
            targets.map(|target| word(session, target)),
            is_on(session, Target::Bit(Y, 0)),
        )
    };
    scans(&mut session, 100);
    let once = state(&session);
    assert!(once.2);
    session.release_all();
    scans(&mut session, 50);
    session.restore(&moment);
    assert_eq!(session.now_ms(), 30);
    assert_eq!(session.forced().iter().count(), 1);
    scans(&mut session, 100);
    assert_eq!(state(&session), once);
}

#[test]
fn scans_wait_for_the_constant_scan_time() {
    let module = module("LD M8002\nSET M8039\nMOV K25 D8039\nEND\n");
    let mut session = session(&module);
    assert_eq!(session.scan_ms(None), 10);
    session.scan(10);
    assert_eq!(session.scan_ms(None), 25);
    assert_eq!(session.scan_ms(Some(5)), 25);
    assert_eq!(session.scan_ms(Some(40)), 40);
}
