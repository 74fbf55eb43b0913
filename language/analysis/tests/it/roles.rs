//! Special devices that programs write in some roles of a serial port: `check` warns in the others alone.

use rungc_analysis::check::check;
use rungc_analysis::resolve::resolve;
use rungc_models::special::{Access, PortRole, Special};
use rungc_models::{Model, ModelId};
use rungc_rt::Ports;
use rungc_rt::comm::Protocol;
use rungc_syntax::{Device, DeviceClass, codes};
use std::collections::BTreeSet;

/// A port that a program sets up, and the protocol that it has then; `None` if that is chosen at run time.
type SetUp = (u8, &'static str, Option<Protocol>);

const FX: &[SetUp] = &[
    (1, "MOV H81 D8120\n", Some(Protocol::Free)),
    (1, "MOV H4081 D8120\n", Some(Protocol::ComputerLink)),
    (1, "MOV D5 D8120\n", None),
];

const FX3: &[SetUp] = &[
    (1, "MOV H81 D8400\n", Some(Protocol::Free)),
    (
        1,
        "MOV H10D1 D8400\nMOV H1 D8401\n",
        Some(Protocol::MasterRtu),
    ),
    (
        1,
        "MOV H10D1 D8400\nMOV H101 D8401\n",
        Some(Protocol::MasterAscii),
    ),
    (
        1,
        "MOV H10D1 D8400\nMOV H11 D8401\n",
        Some(Protocol::ModbusRtu),
    ),
    (
        1,
        "MOV H10D1 D8400\nMOV H111 D8401\n",
        Some(Protocol::ModbusAscii),
    ),
    (1, "MOV H10D1 D8400\nMOV D5 D8401\n", None),
    (2, "MOV H81 D8420\n", Some(Protocol::Free)),
    (2, "MOV H4081 D8420\n", Some(Protocol::ComputerLink)),
    (
        2,
        "MOV H10D1 D8420\nMOV H1 D8421\n",
        Some(Protocol::MasterRtu),
    ),
    (
        2,
        "MOV H10D1 D8420\nMOV H11 D8421\n",
        Some(Protocol::ModbusRtu),
    ),
    (
        2,
        "MOV H10D1 D8420\nMOV H111 D8421\n",
        Some(Protocol::ModbusAscii),
    ),
    (2, "MOV H10D1 D8420\nMOV D5 D8421\n", None),
];

const INOVANCE: &[SetUp] = &[
    (1, "MOV H0 D8126\n", Some(Protocol::Free)),
    (1, "MOV H6 D8126\n", Some(Protocol::ComputerLink)),
    (1, "MOV H2 D8126\n", Some(Protocol::ModbusRtu)),
    (1, "MOV D5 D8126\n", None),
];

/// Ways to set up the ports of a model.
fn set_ups(model: &Model) -> Vec<SetUp> {
    match model.ports {
        Ports::Fx => FX.to_vec(),
        Ports::Fx3 | Ports::Fx3g => [FX, FX3].concat(),
        Ports::Board3u => FX3.to_vec(),
        Ports::Inovance => INOVANCE.to_vec(),
        _ => Vec::new(),
    }
}

/// Devices of the model that programs write in a role.
fn rows(model: &'static Model) -> impl Iterator<Item = (&'static Special, &'static PortRole)> {
    model.specials().filter_map(|row| match row.access {
        Access::ReadUnless(role) => Some((row, role)),
        _ => None,
    })
}

/// Devices whose writes a code is about.
fn warned(model: &'static Model, code: &str, set_up: &str, rows: &[&Special]) -> BTreeSet<Device> {
    let mut text = format!("LD M8002\n{set_up}LD X0\n");
    for row in rows {
        let device = device(row);
        text += &match row.class {
            DeviceClass::M => format!("OUT {device}\n"),
            _ => format!("MOV K7 {device}\n"),
        };
    }
    let program = rungc_frontend::read_text("p.il", &(text + "END\n")).program;
    let (resolved, wrong) = resolve(&program, model);
    assert!(!wrong.has_errors(), "{} {set_up}: {wrong:?}", model.name);
    let found = check(&resolved);
    let found = found.iter().filter(|diagnostic| diagnostic.code == code);
    let names: String = found
        .map(|diagnostic| format!("{} ", diagnostic.message))
        .collect();
    let named = |row: &&&Special| names.contains(&format!("`{}`", device(row)));
    rows.iter().filter(named).map(|row| device(row)).collect()
}

fn device(row: &Special) -> Device {
    Device {
        class: row.class,
        number: row.first,
    }
}

#[test]
fn a_device_is_the_systems_where_its_port_has_another_role() {
    let mut tried = 0;
    for model in ModelId::ALL.map(Model::get) {
        for (port, set_up, protocol) in set_ups(model) {
            let of_port: Vec<_> = rows(model).filter(|(_, role)| role.port == port).collect();
            let devices: Vec<_> = of_port.iter().map(|(row, _)| *row).collect();
            let not_in_role = of_port.iter().filter(|(_, role)| {
                protocol.is_some_and(|protocol| !role.protocols.contains(protocol))
            });
            let expected: BTreeSet<_> = not_in_role.map(|(row, _)| device(row)).collect();
            let found = warned(model, codes::WRITES_READ_ONLY.id, set_up, &devices);
            assert_eq!(found, expected, "{} {set_up}", model.name);
            let inert = of_port.iter().filter(|(_, role)| {
                let in_role = protocol.is_some_and(|protocol| role.protocols.contains(protocol));
                in_role && role.inert.is_some()
            });
            let expected: BTreeSet<_> = inert.map(|(row, _)| device(row)).collect();
            let found = warned(model, codes::INERT_DEVICE.id, set_up, &devices);
            assert_eq!(found, expected, "{} {set_up}", model.name);
            tried += devices.len();
        }
    }
    assert!(tried > 100, "{tried}");
}

/// A port that the program leaves alone is none of Modbus; parameters of the PLC may put it on a computer link.
#[test]
fn ports_that_a_program_leaves_alone() {
    for model in ModelId::ALL.map(Model::get) {
        let devices: Vec<_> = rows(model).map(|(row, _)| row).collect();
        let by_program = rows(model).filter(|(_, role)| !role.by_parameters);
        let expected: BTreeSet<_> = by_program.map(|(row, _)| device(row)).collect();
        let found = warned(model, codes::WRITES_READ_ONLY.id, "", &devices);
        assert_eq!(found, expected, "{}", model.name);
    }
}

/// Errors and time-outs that stay until the program resets them, and the carry that RCR and RCL take in, are the
/// program's to write.
#[test]
fn programs_reset_what_only_they_reset() {
    for model in ModelId::ALL.map(Model::get) {
        if matches!(model.ports, Ports::Hm) {
            continue;
        }
        let (m, d) = (DeviceClass::M, DeviceClass::D);
        let mut devices = vec![(m, 8022), (m, 8063), (d, 8063)];
        // That of RD3A and WR3A on L01S resets itself.
        if !matches!(model.ports, Ports::L01s) {
            devices.push((m, 8129));
        }
        let rows: Vec<_> = devices
            .into_iter()
            .filter_map(|(class, number)| model.special(class, number))
            .collect();
        let found = warned(model, codes::WRITES_READ_ONLY.id, "", &rows);
        assert!(found.is_empty(), "{}: {found:?}", model.name);
    }
}
