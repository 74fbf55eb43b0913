//! Lines on which the PLC asks.

use super::{Good, Partner, Registers};
use crate::random::Random;
use crate::text::{Bytes, ENQ, STX, ascii, data, rtu, stx, words};
use rungc_models::ModelId;

const MASTER: Partner = Partner {
    name: "",
    model: ModelId::H2u,
    port: 1,
    program: "",
    plc_asks: true,
    seven_bits: true,
    last: |sent| sent.iter().rposition(|&byte| byte == STX).unwrap_or(0),
    good: |_, _, _| unreachable!(),
    wrong: |_, _| unreachable!(),
    seal: |_| unreachable!(),
    own: 0..0,
};

/// Masters of Modbus read four registers of station 2 to D10.
const MODBUS: Partner = Partner {
    seven_bits: false,
    last: |sent| sent.len().saturating_sub(8),
    good: |_, random, registers| modbus(random, registers, rtu),
    wrong: |_, random| rtu(&wrong_modbus(random)),
    seal: |body| rtu(&[&[2, 3], body].concat()),
    ..MASTER
};

pub(super) const MASTERS: &[Partner] = &[
    Partner {
        name: "modbus-rtu-master",
        program: "LD M8002\nMOV H20 D8126\nMOV HC1 D8120\nMOV K3 D8129\nLD M8000\nMODBUS H0203 K100 K4 D10\nEND\n",
        ..MODBUS
    },
    Partner {
        name: "modbus-ascii-master",
        program: "LD M8002\nMOV H30 D8126\nMOV HC6 D8120\nMOV K3 D8129\nLD M8000\nMODBUS H0203 K100 K4 D10\nEND\n",
        seven_bits: true,
        last: |sent| sent.iter().rposition(|&byte| byte == b':').unwrap_or(0),
        good: |_, random, registers| modbus(random, registers, ascii),
        wrong: |_, random| ascii(&wrong_modbus(random)),
        seal: |body| ascii(&[&[2, 3], body].concat()),
        ..MASTER
    },
    Partner {
        name: "modbus-l01s-master",
        model: ModelId::L01s,
        port: 2,
        program: "LD M8002\nSET M8196\nSET M8125\nMOV HC1 D8120\nMOV K255 D8121\nMOV K0 D8126\nMOV K30 D8129\nLD M8000\nADPRW H2 H3 K100 K4 D10\nEND\n",
        ..MODBUS
    },
    Partner {
        name: "modbus-hm-master",
        model: ModelId::Hm,
        program: "LD M8002\nUINIT H0400 H0408 K7000 K1\nLD M8000\nMRDD K2 K100 K4 D10 K1\nEND\n",
        own: 7000..7020,
        ..MODBUS
    },
    Partner {
        name: "computer-link-master",
        model: ModelId::Hm,
        program: "LD M8002\nMOV K7100 D1000\nMOV K1 D1001\nMOV K8 D1002\nMOV K1 D7100\nUINIT H0200 H0408 K1000 K1\nEND\n",
        seven_bits: false,
        last: |sent| sent.iter().rposition(|&byte| byte == ENQ).unwrap_or(0),
        good: |_, random, registers| {
            let values = [(); 4].map(|()| random.word());
            registers.set(7101, &values);
            Good {
                frame: data(&format!("01FF{}", words(&values)), false),
                answer: Bytes::new(),
            }
        },
        wrong: |_, random| {
            const TEXTS: [&str; 5] = [
                "02FF0001000200030004",
                "01FF000100020003",
                "01FF",
                "01FF000100020003000G",
                "0000000100020003000400",
            ];
            data(TEXTS[random.below(TEXTS.len())], false)
        },
        seal: |body| data(&format!("01FF{}", String::from_utf8_lossy(body)), false),
        own: 1000..1020,
        ..MASTER
    },
    Partner {
        name: "parallel-master",
        program: "LD M8002\nMOV H50 D8126\nMOV HC6 D8120\nEND\n",
        good: |_, random, registers| {
            let area: Vec<u16> = (0..10).map(|_| random.word()).collect();
            registers.set(500, &area);
            Good {
                frame: stx(&format!("B0{}{}", words(&[0; 7]), words(&area))),
                answer: Bytes::new(),
            }
        },
        wrong: |_, random| stx(["B1", "A0", "B0", "B01234", "C0"][random.below(5)]),
        seal: |body| stx(&format!("B0{}", String::from_utf8_lossy(body))),
        ..MASTER
    },
    Partner {
        name: "nn-master",
        program: "LD M8002\nMOV H40 D8126\nMOV HC6 D8120\nMOV K1 D8177\nMOV K0 D8178\nMOV K0 D8179\nMOV K3 D8180\nEND\n",
        good: |_, random, registers| {
            let block: Vec<u16> = (0..4).map(|_| random.word()).collect();
            registers.set(10, &block);
            Good {
                frame: stx(&format!("D110{}", words(&block))),
                answer: Bytes::new(),
            }
        },
        wrong: |_, random| {
            stx(["D210", "D11E", "P110", "D110", "D1101234", "X110"][random.below(6)])
        },
        seal: |body| stx(&format!("D110{}", String::from_utf8_lossy(body))),
        ..MASTER
    },
];

fn modbus(random: &mut Random, registers: &mut Registers, seal: fn(&[u8]) -> Bytes) -> Good {
    let values = [(); 4].map(|()| random.word());
    registers.set(10, &values);
    let body = [2, 3, 8]
        .into_iter()
        .chain(values.into_iter().flat_map(u16::to_be_bytes));
    Good {
        frame: seal(&body.collect::<Vec<_>>()),
        answer: Bytes::new(),
    }
}

/// Of another station or function, of another length, or a refusal.
fn wrong_modbus(random: &mut Random) -> Bytes {
    let [a, b] = random.word().to_be_bytes();
    match random.below(6) {
        0 => vec![1, 3, 8, a, b, a, b, a, b, a, b],
        1 => vec![2, 4, 8, a, b, a, b, a, b, a, b],
        2 => vec![2, 3, 6, a, b, a, b, a, b],
        3 => vec![2, 3, 8, a, b, a, b, a, b, a],
        4 => vec![2, 0x83, a & 15],
        _ => vec![2, 3, 8, a, b, a, b, a, b, a, b, 0],
    }
}
