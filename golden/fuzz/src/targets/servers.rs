//! Servers over TCP: whatever one connection says, another is answered.

use super::Target;
use crate::plc::{Plc, module};
use crate::text::stx;
use rungc_host::servers::Dialogue;
use rungc_models::ModelId;
use rungc_rt::Ports;
use rungc_rt::comm::Served;
use rungc_rt::comm::service::{ServerProtocol, Service};

/// Reads D0 in each protocol, and the answer.
const MODBUS: (&[u8], &[u8]) = (
    &[0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1],
    &[0, 1, 0, 0, 0, 5, 1, 3, 2],
);
const MC: (&[u8], &[u8]) = (&[1, 0xff, 10, 0, 0, 0, 0, 0, 0x20, 0x44, 1, 0], &[0x81, 0]);
const MC_3E: &[u8] = &[
    0x50, 0, 0, 0xff, 0xff, 3, 0, 12, 0, 16, 0, 1, 4, 0, 0, 100, 0, 0, 0xa8, 1, 0,
];
/// The same two in ASCII.
const MC_ASCII: &[u8] = b"01FF000A4420000000640100";
const MC_3E_ASCII: &[u8] = b"500000FF03FF000018001004010000D*0001000001";

fn target(
    name: &'static str,
    protocol: ServerProtocol,
    probe: (&'static [u8], &'static [u8]),
    seeds: &[&[u8]],
) -> Target {
    let service = Service::new(protocol, Ports::Inovance, 24_120);
    let module = module(ModelId::H2u, 0, "LD M8000\nOUT M0\nEND\n");
    Target {
        name,
        run: Box::new(move |input| {
            let mut plc = Plc::new(module, 0);
            let mut map = Served::new(plc.devices(), 24_120);
            let mut dialogue = Dialogue::new(service);
            // The network delivers what it likes.
            for part in input.chunks(1 + usize::from(input.first().copied().unwrap_or(0))) {
                if dialogue.receive(part, &mut map).closes {
                    break;
                }
            }
            let reaction = Dialogue::new(service).receive(probe.0, &mut map);
            assert!(
                reaction.reply.starts_with(probe.1),
                "{:02x?}",
                reaction.reply
            );
        }),
        seeds: seeds.iter().map(|seed| seed.to_vec()).collect(),
    }
}

pub(super) fn targets() -> [Target; 3] {
    let fx = stx("0100002");
    let write: &[u8] = &[0, 1, 0, 0, 0, 11, 1, 16, 0, 0, 0, 2, 4, 0, 1, 0, 2];
    [
        target(
            "modbus-tcp",
            ServerProtocol::ModbusTcp,
            MODBUS,
            &[MODBUS.0, write],
        ),
        target(
            "mc",
            ServerProtocol::Mc,
            MC,
            &[MC.0, MC_3E, MC_ASCII, MC_3E_ASCII],
        ),
        target(
            "fx-over-tcp",
            ServerProtocol::ProgrammingPort,
            (b"\x05", b"\x06"),
            &[&fx, b"\x05"],
        ),
    ]
}
