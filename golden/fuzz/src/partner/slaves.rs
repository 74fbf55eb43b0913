//! Lines on which the PLC answers.

use super::{COUNT, Good, Partner, Registers, register};
use crate::random::Random;
use crate::text::{ACK, Bytes, ascii, data, enq, rtu, stx, words};
use rungc_models::ModelId;
use rungc_rt::comm::canlink::{Head, Kind};
use rungc_rt::comm::{CAN_PORT, CanFrame};

/// A slave whose frames are its own business.
const SLAVE: Partner = Partner {
    name: "",
    model: ModelId::H2u,
    port: 1,
    program: "",
    plc_asks: false,
    seven_bits: true,
    last: |_| 0,
    good: |_, _, _| unreachable!(),
    wrong: |_, _| unreachable!(),
    seal: |_| unreachable!(),
    own: 0..0,
};

pub(super) const SLAVES: &[Partner] = &[
    Partner {
        name: "modbus-rtu",
        program: "LD M8002\nMOV H2 D8126\nMOV HC1 D8120\nMOV K1 D8121\nEND\n",
        seven_bits: false,
        good: |_, random, registers| modbus(random, registers, rtu),
        wrong: |_, random| rtu(&wrong_modbus(random)),
        seal: rtu,
        ..SLAVE
    },
    Partner {
        name: "modbus-ascii",
        port: 2,
        program: "LD M8002\nMOV H3 D8266\nMOV HC6 D8260\nMOV K1 D8261\nEND\n",
        good: |_, random, registers| modbus(random, registers, ascii),
        wrong: |_, random| ascii(&wrong_modbus(random)),
        seal: ascii,
        ..SLAVE
    },
    Partner {
        name: "modbus-l01s",
        model: ModelId::L01s,
        port: 3,
        program: "LD M8002\nSET M8192\nMOV H11 D8401\nMOV HC1 D8400\nMOV K1 D8414\nEND\n",
        seven_bits: false,
        good: |_, random, registers| modbus(random, registers, rtu),
        wrong: |_, random| rtu(&wrong_modbus(random)),
        seal: rtu,
        ..SLAVE
    },
    Partner {
        name: "qlink",
        program: "LD M8002\nMOV H2 D8126\nMOV HC1 D8120\nMOV K1 D8121\nEND\n",
        seven_bits: false,
        good: |_, random, registers| qlink(random, registers),
        wrong: |_, random| {
            let mut body = vec![1, 0x60 + random.below(2) as u8];
            body.extend(random.bytes(2));
            body.extend([random.below(20) as u8, random.below(20) as u8]);
            let length = random.below(40);
            body.extend(random.bytes(length));
            rtu(&body)
        },
        seal: |body| rtu(&[&[1, 0x60 | body.first().unwrap_or(&0) & 1], body].concat()),
        ..SLAVE
    },
    Partner {
        name: "programming-port",
        port: 0,
        program: "LD M8000\nOUT M0\nEND\n",
        good: |_, random, registers| programming_port(random, registers),
        wrong: |_, random| {
            wrong_text(
                random,
                &[
                    "1FFF0021234",
                    "11000041234",
                    "110000",
                    "E10FFF0021234",
                    "9",
                    "E7FFFF",
                ],
            )
        },
        seal: |body| stx(&String::from_utf8_lossy(body)),
        ..SLAVE
    },
    Partner {
        name: "programming-port-fx3",
        model: ModelId::Fx3u,
        port: 0,
        program: "LD M8000\nOUT M0\nEND\n",
        good: |_, random, registers| programming_port_fx3(random, registers),
        wrong: |_, random| {
            wrong_text(
                random,
                &[
                    "1FFF0021234",
                    "E1000000412",
                    "E10FF00021234",
                    "E1140000212340",
                    "E90000",
                    "E7FFFF",
                ],
            )
        },
        seal: |body| stx(&String::from_utf8_lossy(body)),
        ..SLAVE
    },
    Partner {
        name: "computer-link",
        program: "LD M8002\nMOV H6 D8126\nMOV HA0C6 D8120\nMOV K5 D8121\nEND\n",
        good: |_, random, registers| computer_link(random, registers, "05FF", true),
        wrong: |_, random| wrong_link(random, "05FF", true),
        seal: |body| enq(&format!("05FF{}", String::from_utf8_lossy(body)), true),
        ..SLAVE
    },
    Partner {
        name: "computer-link-format-1",
        program: "LD M8002\nMOV H6 D8126\nMOV H20C6 D8120\nMOV K5 D8121\nEND\n",
        good: |_, random, registers| computer_link(random, registers, "05FF", false),
        wrong: |_, random| wrong_link(random, "05FF", false),
        seal: |body| enq(&format!("05FF{}", String::from_utf8_lossy(body)), false),
        ..SLAVE
    },
    Partner {
        name: "computer-link-hm",
        model: ModelId::Hm,
        program: "LD M8002\nUINIT H0305 H0408 K7000 K1\nEND\n",
        seven_bits: false,
        good: |_, random, registers| computer_link(random, registers, "05FF", false),
        wrong: |_, random| wrong_link(random, "05FF", false),
        seal: |body| enq(&format!("05FF{}", String::from_utf8_lossy(body)), false),
        own: 7000..7020,
        ..SLAVE
    },
    Partner {
        name: "bd-protocol",
        model: ModelId::L01s,
        port: 2,
        program: "LD M8002\nSET M8196\nRST M8125\nMOV H60C6 D8120\nMOV K5 D8121\nEND\n",
        good: |_, random, registers| computer_link(random, registers, "05FF", false),
        wrong: |_, random| wrong_link(random, "05FF", false),
        seal: |body| enq(&format!("05FF{}", String::from_utf8_lossy(body)), false),
        ..SLAVE
    },
    Partner {
        name: "parallel-slave",
        program: "LD M8002\nMOV H5 D8126\nMOV HC6 D8120\nEND\n",
        good: |_, random, registers| {
            let area: Vec<u16> = (0..10).map(|_| random.word()).collect();
            registers.set(490, &area);
            let own = words(&registers.0[500..510]);
            Good {
                frame: stx(&format!("A0{}{}", words(&[0; 7]), words(&area))),
                answer: stx(&format!("B0{}{own}", words(&[0; 7]))),
            }
        },
        wrong: |_, random| wrong_text(random, &["A1", "B0", "A0", "A01234", "C0"]),
        seal: |body| stx(&format!("A0{}", String::from_utf8_lossy(body))),
        ..SLAVE
    },
    Partner {
        name: "nn-slave",
        program: "LD M8002\nMOV H4 D8126\nMOV HC6 D8120\nMOV K1 D8176\nEND\n",
        good: |_, random, registers| nn_slave(random, registers, '0', 0, 10, 4),
        wrong: |_, random| wrong_text(random, &["D020", "D01E", "P11", "P1101", "X110", "D010123"]),
        seal: |body| stx(&format!("D010{}", String::from_utf8_lossy(body))),
        ..SLAVE
    },
    Partner {
        name: "enhanced-nn-slave",
        program: "LD M8002\nMOV H14 D8126\nMOV HC6 D8120\nMOV K1 D8176\nEND\n",
        good: |_, random, registers| nn_slave(random, registers, 'E', 200, 240, 32),
        wrong: |_, random| wrong_text(random, &["D020", "D010", "P1E", "P1E01", "X11E", "D01E123"]),
        seal: |body| stx(&format!("D01E{}", String::from_utf8_lossy(body))),
        ..SLAVE
    },
    Partner {
        name: "can",
        port: CAN_PORT,
        program: "LD M8000\nCANRX H0 H200 D100 K8\nEND\n",
        seven_bits: false,
        good: |_, random, registers| {
            let sent = [(); 4].map(|()| random.word());
            registers.set(100, &sent);
            Good {
                frame: format!("t2008{}\r", words(&sent)).into_bytes(),
                answer: Bytes::new(),
            }
        },
        wrong: |_, random| {
            const TEXTS: [&str; 6] = ["t2018", "T000002008", "t2009", "z", "t2008XYZ", "V1013"];
            let digits = words(&[random.word(), random.word(), random.word(), random.word()]);
            format!("{}{digits}\r", TEXTS[random.below(TEXTS.len())]).into_bytes()
        },
        seal: |body| format!("t200{}\r", String::from_utf8_lossy(body)).into_bytes(),
        ..SLAVE
    },
    Partner {
        name: "canlink",
        port: CAN_PORT,
        program: "LD M8000\nCANNET K2 K1 K0\nCANNODE K3 K2\nEND\n",
        seven_bits: false,
        good: |_, random, registers| {
            let sent = [(); 4].map(|()| random.word());
            let first = 100 + random.below(COUNT);
            registers.set(first, &sent);
            // From station 1 to this one, or from station 3 to all.
            let receiver = [(1, 2), (3, 3)][random.below(2)];
            Good {
                frame: canlink(Kind::Words, receiver, first as u16, &sent),
                answer: Bytes::new(),
            }
        },
        wrong: |_, random| {
            let sent = [(); 4].map(|()| random.word());
            match random.below(6) {
                0 => canlink(Kind::Words, (1, 3), 100, &sent),
                1 => canlink(Kind::Words, (1, 1), 100, &sent),
                2 => canlink(Kind::Words, (1, 2), 7800 + sent[0] % 8000, &sent),
                3 => canlink(Kind::Command, (3, 3), 0, &[]),
                4 => canlink(Kind::Heartbeat, (3, 0), 100, &sent),
                _ => b"T08108064312345\r".to_vec(),
            }
        },
        seal: |body| format!("T{}\r", String::from_utf8_lossy(body)).into_bytes(),
        ..SLAVE
    },
];

/// A frame of CANlink from a station to one.
fn canlink(kind: Kind, (sender, receiver): (u8, u8), register: u16, sent: &[u16]) -> Bytes {
    let head = Head {
        kind,
        sender,
        receiver,
        register,
    };
    let id = head.id() & !CanFrame::EXTENDED;
    format!("T{id:08X}{}{}\r", 2 * sent.len(), words(sent)).into_bytes()
}

fn modbus(random: &mut Random, registers: &mut Registers, seal: fn(&[u8]) -> Bytes) -> Good {
    let (number, value, write) = register(random, registers);
    let ([high, low], [a, b]) = (number.to_be_bytes(), value.to_be_bytes());
    if write {
        let frame = seal(&[1, 6, high, low, a, b]);
        return Good {
            answer: frame.clone(),
            frame,
        };
    }
    Good {
        frame: seal(&[1, 3, high, low, 0, 1]),
        answer: seal(&[1, 3, 2, a, b]),
    }
}

/// For another station, without a device, of another length, or with an unknown function.
fn wrong_modbus(random: &mut Random) -> Bytes {
    let [a, b] = random.word().to_be_bytes();
    match random.below(6) {
        0 => vec![2, 6, 0, 100, a, b],
        1 => vec![1, 6, 0xe8, a, a, b],
        2 => vec![1, 6, 0, 100, a, b, 0],
        3 => vec![1, 16, 0, 100, 0, 2, 4, a, b, a],
        4 => vec![1, 16, 0, 100, 0, 0, 0],
        _ => vec![1, 0x40 | a & 15, 0, 100, a, b],
    }
}

fn qlink(random: &mut Random, registers: &mut Registers) -> Good {
    let (number, value, write) = register(random, registers);
    if write {
        let ([high, low], [a, b]) = (number.to_be_bytes(), value.to_be_bytes());
        let frame = rtu(&[1, 6, high, low, a, b]);
        return Good {
            answer: frame.clone(),
            frame,
        };
    }
    let [high, low] = number.to_be_bytes();
    let [a, b] = value.to_be_bytes();
    let id = random.below(16) as u8;
    Good {
        frame: rtu(&[1, 0x60, 0, id, 0, 1, high, low]),
        answer: rtu(&[1, 0x60, 0, id, 0, 1, a, b]),
    }
}

fn programming_port(random: &mut Random, registers: &mut Registers) -> Good {
    let (number, value, write) = register(random, registers);
    let address = 0x1000 + 2 * number;
    let digits = words(&[value.swap_bytes()]);
    if write {
        return Good {
            frame: stx(&format!("1{address:04X}02{digits}")),
            answer: vec![ACK],
        };
    }
    Good {
        frame: stx(&format!("0{address:04X}02")),
        answer: stx(&digits),
    }
}

fn programming_port_fx3(random: &mut Random, registers: &mut Registers) -> Good {
    let (number, value, write) = register(random, registers);
    let address = 0x4000 + 2 * number;
    let digits = words(&[value.swap_bytes()]);
    if write {
        return Good {
            frame: stx(&format!("E10{address:04X}02{digits}")),
            answer: vec![ACK],
        };
    }
    Good {
        frame: stx(&format!("E00{address:04X}02")),
        answer: stx(&digits),
    }
}

/// One of these texts, with a right sum.
fn wrong_text(random: &mut Random, texts: &[&str]) -> Bytes {
    stx(texts[random.below(texts.len())])
}

fn computer_link(random: &mut Random, registers: &mut Registers, head: &str, crlf: bool) -> Good {
    let (number, value, write) = register(random, registers);
    if write {
        let end: &[u8] = if crlf { b"\r\n" } else { b"" };
        return Good {
            frame: enq(&format!("{head}WW0D{number:04}01{value:04X}"), crlf),
            answer: [&[ACK], head.as_bytes(), end].concat(),
        };
    }
    Good {
        frame: enq(&format!("{head}WR0D{number:04}01"), crlf),
        answer: data(&format!("{head}{value:04X}"), crlf),
    }
}

fn wrong_link(random: &mut Random, head: &str, crlf: bool) -> Bytes {
    const TEXTS: [&str; 7] = [
        "06FFWW0D0100011234",
        "0500WW0D0100011234",
        "WW0D9000011234",
        "WW0D010001123G",
        "ZZ0D0100011234",
        "WW0Q0100011234",
        "WW0D010000",
    ];
    let text = TEXTS[random.below(TEXTS.len())];
    let text = if text.starts_with('0') {
        text.to_owned()
    } else {
        format!("{head}{text}")
    };
    enq(&text, crlf)
}

/// A block of the master, which is not answered, or its question, which is; `first` is the master's first register,
/// `own` the PLC's.
fn nn_slave(
    random: &mut Random,
    registers: &mut Registers,
    mode: char,
    first: usize,
    own: usize,
    count: usize,
) -> Good {
    let relays = if mode == 'E' {
        words(&[0; 4])
    } else {
        String::new()
    };
    if random.below(2) == 0 {
        let block: Vec<u16> = (0..count).map(|_| random.word()).collect();
        registers.set(first, &block);
        return Good {
            frame: stx(&format!("D01{mode}{relays}{}", words(&block))),
            answer: Bytes::new(),
        };
    }
    let block = words(&registers.0[own..own + count]);
    Good {
        frame: stx(&format!("P11{mode}0000")),
        answer: stx(&format!("D11{mode}{relays}{block}")),
    }
}
