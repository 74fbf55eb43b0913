//! Slave and master checked against rmodbus, an independent implementation.

use super::{
    Area, Buffer, Fill, Framing, Job, LONGEST_ASCII, Limits, Profile, Settings, accept, answer,
    crc16, request, tcp,
};
use crate::comm::{Frame, Served};
use crate::double::Double;
use crate::{Class, Plc};
use proptest::prelude::*;
use rmodbus::client::ModbusRequest;
use rmodbus::server::ModbusFrame;
use rmodbus::server::context::ModbusContext;
use rmodbus::server::storage::ModbusStorage;
use rmodbus::{ModbusProto, generate_ascii_frame, parse_ascii_frame};
use std::vec::Vec;

const COILS: usize = 300;
const INPUTS: usize = 200;
const INPUT_REGISTERS: usize = 90;
const REGISTERS: usize = 150;

type Storage = ModbusStorage<COILS, INPUTS, INPUT_REGISTERS, REGISTERS>;

const fn area(count: usize, class: Class, fill: Fill) -> Area {
    Area {
        address: 0,
        count: count as u16,
        class,
        first: 0,
        fill,
        writable: true,
    }
}

/// A model that has what the storage has.
static PROFILE: Profile = Profile {
    name: "oracle",
    coils: &[area(COILS, Class::M, Fill::Bits)],
    inputs: &[area(INPUTS, Class::X, Fill::Bits)],
    registers: &[area(REGISTERS, Class::D, Fill::Words)],
    input_registers: &[area(INPUT_REGISTERS, Class::R, Fill::Words)],
    limits: Limits::STANDARD,
    any_value_is_on: false,
    shortest: 5,
    counters_by_06: true,
};

/// The same values in both: bit n is on where `seed` has a one, register n is made of both.
fn fill(seed: u64) -> (Double, Storage) {
    let (mut plc, mut storage) = (Double::new(), Storage::new());
    let bit = |n: usize| seed.rotate_left(n as u32).count_ones() % 2 == 1;
    let word = |n: usize| (seed.rotate_right(n as u32) as u16).wrapping_add(n as u16);
    for n in 0..COILS {
        plc.set_bit(Class::M, n as u32, bit(n));
        storage.set_coil(n as u16, bit(n)).unwrap();
    }
    for n in 0..INPUTS {
        plc.set_bit(Class::X, n as u32, bit(n + 1));
        storage.set_discrete(n as u16, bit(n + 1)).unwrap();
    }
    for n in 0..REGISTERS {
        plc.set_word(Class::D, n as u32, word(n) as i16);
        storage.set_holding(n as u16, word(n)).unwrap();
    }
    for n in 0..INPUT_REGISTERS {
        plc.set_word(Class::R, n as u32, word(n + 1) as i16);
        storage.set_input(n as u16, word(n + 1)).unwrap();
    }
    (plc, storage)
}

/// Returns true if both hold the same values.
fn agree(plc: &Double, storage: &Storage) -> bool {
    (0..COILS).all(|n| plc.bit(Class::M, n as u32) == storage.get_coil(n as u16).ok())
        && (0..REGISTERS).all(|n| {
            plc.word(Class::D, n as u32).map(|word| word as u16)
                == storage.get_holding(n as u16).ok()
        })
}

/// rmodbus's answer to a frame of bytes.
fn oracle(storage: &mut Storage, proto: ModbusProto, frame: &[u8]) -> Vec<u8> {
    let mut response: Vec<u8> = Vec::new();
    let mut server = ModbusFrame::new(1, frame, proto, &mut response);
    server.parse().unwrap();
    if server.processing_required {
        match server.readonly {
            true => server.process_read(storage).unwrap(),
            false => server.process_write(storage).unwrap(),
        }
    }
    if server.response_required {
        server.finalize_response().unwrap();
    }
    response
}

/// Requests of a right form, about devices that may not be there.
fn requests() -> impl Strategy<Value = Vec<u8>> {
    let address = prop_oneof![0u16..320, any::<u16>()];
    let read = (1u8..=4, address.clone(), 1u16..130)
        .prop_map(|(function, address, count)| pdu(function, address, count, &[]));
    let coil = (
        address.clone(),
        prop_oneof![Just(0u16), Just(0xff00), any::<u16>()],
    )
        .prop_map(|(address, value)| pdu(5, address, value, &[]));
    let register =
        (address.clone(), any::<u16>()).prop_map(|(address, value)| pdu(6, address, value, &[]));
    let coils =
        (address.clone(), 1u16..200, any::<[u8; 32]>()).prop_map(|(address, count, data)| {
            pdu(15, address, count, &data[..usize::from(count.div_ceil(8))])
        });
    let registers =
        (address, prop::collection::vec(any::<u8>(), 1..60)).prop_map(|(address, mut data)| {
            data.extend_from_within(..);
            pdu(16, address, (data.len() / 2) as u16, &data)
        });
    prop_oneof![read, coil, register, coils, registers]
}

/// Station 1's request.
fn pdu(function: u8, address: u16, count: u16, data: &[u8]) -> Vec<u8> {
    let mut bytes = std::vec![1, function];
    bytes.extend(address.to_be_bytes());
    bytes.extend(count.to_be_bytes());
    if !data.is_empty() {
        bytes.push(data.len() as u8);
        bytes.extend(data);
    }
    bytes
}

fn served(plc: &mut Double, framing: Framing, frame: &[u8]) -> Vec<u8> {
    let settings = Settings {
        framing,
        station: 1,
        profile: &PROFILE,
    };
    let mut bytes = [0; LONGEST_ASCII];
    let mut reply = Frame::new(&mut bytes);
    let _ = answer(&settings, frame, &mut Served::new(plc, 0), &mut reply);
    reply.as_slice().to_vec()
}

/// A frame in digits.
fn ascii(body: &[u8]) -> Vec<u8> {
    let sum = body.iter().fold(0u8, |sum, &byte| sum.wrapping_sub(byte));
    let mut frame = Vec::new();
    generate_ascii_frame(&[body, &[sum]].concat(), &mut frame).unwrap();
    frame
}

proptest! {
    #[test]
    fn rtu_answers(seed: u64, body in requests()) {
        let (mut plc, mut storage) = fill(seed);
        let frame = [&body[..], &crc16(&body).to_le_bytes()].concat();
        let expected = oracle(&mut storage, ModbusProto::Rtu, &frame);
        prop_assert_eq!(served(&mut plc, Framing::Rtu, &frame), expected);
        prop_assert!(agree(&plc, &storage));
    }

    #[test]
    fn ascii_answers(seed: u64, body in requests()) {
        let (mut plc, mut storage) = fill(seed);
        let frame = ascii(&body);
        let mut bytes = [0; 256];
        let length = parse_ascii_frame(&frame, frame.len(), &mut bytes, 0).unwrap();
        let expected = oracle(&mut storage, ModbusProto::Ascii, &bytes[..usize::from(length)]);
        let mut expected_frame = Vec::new();
        generate_ascii_frame(&expected, &mut expected_frame).unwrap();
        prop_assert_eq!(served(&mut plc, Framing::Ascii, &frame), expected_frame);
        prop_assert!(agree(&plc, &storage));
    }

    #[test]
    fn tcp_answers(seed: u64, transaction: u16, body in requests()) {
        let (mut plc, mut storage) = fill(seed);
        let mut frame = transaction.to_be_bytes().to_vec();
        frame.extend([0, 0, 0, body.len() as u8]);
        frame.extend(&body);
        let expected = oracle(&mut storage, ModbusProto::TcpUdp, &frame);
        let mut bytes = [0; tcp::LONGEST];
        let mut reply = Frame::new(&mut bytes);
        let _ = tcp::answer(&PROFILE, &frame, &mut Served::new(&mut plc, 0), &mut reply);
        prop_assert_eq!(reply.as_slice(), &expected);
        prop_assert!(agree(&plc, &storage));
    }

    /// rmodbus serves what our master asks, and our master takes what it answers.
    #[test]
    fn requests_and_answers_of_the_master(
        seed: u64,
        address in 0u16..10,
        count in 1u16..=80,
        function in prop::sample::select(&[1u8, 2, 3, 4, 5, 6, 15, 16][..]),
    ) {
        let (mut plc, mut storage) = fill(seed);
        let job = Job { station: 1, function, address, count, buffer: Buffer::words(Class::D, 1000) };
        let values: Vec<i32> = (0..80).map(|n| seed.rotate_left(n) as i32).collect();
        plc.set_d(1000, &values);
        let mut bytes = [0; 256];
        let mut frame = Frame::new(&mut bytes);
        request(Framing::Rtu, &Limits::STANDARD, &job, &Served::new(&mut plc, 0), &mut frame).unwrap();
        prop_assert_eq!(frame.as_slice(), &of_client(&job, &plc)[..]);
        let reply = oracle(&mut storage, ModbusProto::Rtu, frame.as_slice());
        let taken = accept(Framing::Rtu, &job, &reply, &mut Served::new(&mut plc, 0));
        prop_assert_eq!(taken, Ok(()));
        for n in 0..count {
            let word = |n: u16| plc.word(Class::D, 1000 + u32::from(n)).unwrap() as u16;
            let bit = |n: u16| word(n / 16) >> (n % 16) & 1 == 1;
            let at = address + n;
            match function {
                1 | 15 => prop_assert_eq!(storage.get_coil(at).unwrap(), bit(n)),
                2 => prop_assert_eq!(storage.get_discrete(at).unwrap(), bit(n)),
                3 | 16 => prop_assert_eq!(storage.get_holding(at).unwrap(), word(n)),
                4 => prop_assert_eq!(storage.get_input(at).unwrap(), word(n)),
                5 => prop_assert_eq!(storage.get_coil(address).unwrap(), word(0) != 0),
                _ => prop_assert_eq!(storage.get_holding(address).unwrap(), word(0)),
            }
        }
    }
}

/// The request that rmodbus makes of a job.
fn of_client(job: &Job, plc: &Double) -> Vec<u8> {
    let mut client = ModbusRequest::new(1, ModbusProto::Rtu);
    let word = |n: u16| plc.word(Class::D, 1000 + u32::from(n)).unwrap() as u16;
    let words: Vec<u16> = (0..job.count).map(word).collect();
    let coils: Vec<bool> = (0..job.count)
        .map(|n| word(n / 16) >> (n % 16) & 1 == 1)
        .collect();
    let (address, count) = (job.address, job.count);
    let mut frame = Vec::new();
    match job.function {
        1 => client.generate_get_coils(address, count, &mut frame),
        2 => client.generate_get_discretes(address, count, &mut frame),
        3 => client.generate_get_holdings(address, count, &mut frame),
        4 => client.generate_get_inputs(address, count, &mut frame),
        5 => client.generate_set_coil(address, words[0] != 0, &mut frame),
        6 => client.generate_set_holding(address, words[0], &mut frame),
        15 => client.generate_set_coils_bulk(address, &coils, &mut frame),
        _ => client.generate_set_holdings_bulk(address, &words, &mut frame),
    }
    .unwrap();
    frame
}
