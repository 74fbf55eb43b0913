//! Devices that can be set from outside.

use rungc_interp::Machine;
use rungc_lower::compile::{CompileOptions, compile};
use rungc_models::special::Status;
use rungc_models::{Model, ModelId};
use rungc_rt::special::M_CLOCK_STOP;
use rungc_rt::{Class, Plc, Program as _, VirtualHal};
use rungc_sim::{Target, check_lasts};
use rungc_syntax::DeviceClass::{self, D, M};

/// A model of each family.
const FAMILIES: [ModelId; 5] = [
    ModelId::H2u,
    ModelId::L01s,
    ModelId::Hm,
    ModelId::Fx2n,
    ModelId::Fx3u,
];

/// Relays that act as soon as they are on.
const ACTIVE: [u32; 3] = [8031, 8032, 8037];

/// A device that the scan sets, and only such a device, loses a value that it is given before the program reads it.
#[test]
fn values_last_until_the_program_reads_them_or_are_rejected() {
    for id in FAMILIES {
        let model = Model::get(id);
        let rows = model.specials().filter(|row| row.status == Status::Scan);
        let devices = rows.flat_map(|row| (row.first..=row.last).map(|n| (row.class, n)));
        for (class, number) in devices {
            let target = match class {
                M if ACTIVE.contains(&number) => continue,
                // It shows RUN unless it decides on it.
                M if id == ModelId::Hm && number == 8004 => continue,
                M => Target::Bit(M, number),
                _ => Target::Word(D, number),
            };
            let checked = check_lasts(model, target, |_| false);
            assert_eq!(
                lasts(model, (class, number)),
                checked.is_ok(),
                "{id:?} {target}"
            );
        }
    }
    let clock = |relay| check_lasts(Model::get(ModelId::H2u), Target::Word(D, 8013), relay);
    assert!(clock(|relay| relay == M_CLOCK_STOP).is_ok());
    let group = Target::Nibbles(1, M, 7998);
    assert_eq!(
        check_lasts(Model::get(ModelId::Fx3u), group, |_| true),
        Err("`M8000` cannot be set: each scan sets it (on while the program runs)".to_string())
    );
}

/// Returns true if the program reads a value that a device has been given.
fn lasts(model: &Model, (class, number): (DeviceClass, u32)) -> bool {
    let device = class.number(number);
    let list = match class {
        M => format!("LD {device}\nOUT M1\nEND\n"),
        _ => format!("LDI M0\nMOV {device} D1\nEND\n"),
    };
    let program = rungc_frontend::read_text("a.il", &list).program;
    let options = CompileOptions {
        model: Some(model.id),
        ..CompileOptions::default()
    };
    let module = compile(&program, &options).module.unwrap();
    let mut machine = Machine::new(&module);
    let mut hal = VirtualHal::new();
    for now_ms in [10, 20, 30] {
        hal.advance_to(now_ms);
        machine.scan(&mut hal, now_ms, 10_000);
    }
    if class == M {
        let value = !machine.bit(Class::M, 1).unwrap();
        machine.set_bit(Class::M, number, value).unwrap();
        machine.scan(&mut hal, 30, 10_000);
        return machine.bit(Class::M, 1) == Some(value);
    }
    // The shortest and the longest time of a scan last if they are shorter and longer.
    [99, 7777].into_iter().any(|value| {
        machine.set_word(Class::D, number, value).unwrap();
        machine.scan(&mut hal, 30, 10_000);
        machine.word(Class::D, 1) == Some(value)
    })
}
