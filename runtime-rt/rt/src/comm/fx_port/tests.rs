//! Frames of recordings and of published drivers.

use super::*;
use crate::comm::watched::{Watched, bytes, hex, reply_of};
use proptest::prelude::*;
use std::string::String;
use std::vec::Vec;

const H2U: Settings = Settings {
    space: Space::Fx2n,
    fx_relays: true,
};
const L01S: Settings = Settings {
    space: Space::Fx3,
    fx_relays: true,
};
const HM: Settings = Settings {
    space: Space::Fx2n,
    fx_relays: false,
};

/// A client that speaks to one PLC.
struct Client {
    settings: Settings,
    memory: Memory,
    map: Watched,
}

impl Client {
    fn of(settings: Settings) -> Self {
        Client {
            settings,
            memory: Memory::new(),
            map: Watched::new(),
        }
    }

    fn exchange(&mut self, request: &[u8]) -> (Vec<u8>, Result<(), LineFault>) {
        reply_of(|reply| {
            answer(
                self.settings,
                &mut self.memory,
                request,
                &mut self.map,
                reply,
            )
        })
    }

    /// The reply to a frame in hexadecimal pairs.
    fn raw(&mut self, request: &str) -> String {
        let request = bytes(request);
        assert_eq!(cut(&request), Cut::Whole);
        hex(&self.exchange(&request).0)
    }

    /// The text of the reply to this command, or a control character's name.
    fn ask(&mut self, text: &str) -> String {
        let (reply, outcome) = self.exchange(&frame(text.as_bytes()));
        match reply.as_slice() {
            [ACK] => "ACK".into(),
            [NAK] => std::format!("NAK {outcome:?}"),
            reply => String::from_utf8(text_of(reply).unwrap().to_vec()).unwrap(),
        }
    }
}

/// A command with its frame.
fn frame(text: &[u8]) -> Vec<u8> {
    let mut frame = [&[STX], text, &[ETX]].concat();
    let sum = frame[1..].iter().fold(0u8, |sum, c| sum.wrapping_add(*c));
    frame.extend(std::format!("{sum:02X}").bytes());
    frame
}

#[test]
fn recorded_frames() {
    let mut client = Client::of(L01S);
    client.map.type_code = 26231;
    // GX Works2 asks a real FX3G for its type.
    assert_eq!(
        client.raw("02 30 30 45 30 32 30 32 03 36 43"),
        "02 37 37 36 36 03 44 44"
    );
    assert_eq!(client.ask("00ECA02"), "7766");
    assert_eq!(client.raw("05"), "06");
    client.map.plc.set_d(123, &[0x1234, 0x5678]);
    // The example of published notes, sum 74.
    assert_eq!(
        client.raw("02 30 31 30 46 36 30 34 03 37 34"),
        "02 33 34 31 32 37 38 35 36 03 41 37"
    );
}

#[test]
fn cuts() {
    assert_eq!(cut(b"\x05"), Cut::Whole);
    assert_eq!(cut(b"\x02"), Cut::More);
    assert_eq!(cut(b"A"), Cut::Drop);
    assert_eq!(cut(b"\x020101\x02"), Cut::Restart);
    assert_eq!(cut(b"\x020101\x05"), Cut::Restart);
    assert_eq!(cut(b"\x02B\x034"), Cut::More);
    assert_eq!(cut(b"\x02B\x0345"), Cut::Whole);
    assert_eq!(
        cut(&[b"\x02".as_slice(), &[b'1'; LONGEST]].concat()),
        Cut::Drop
    );
}

#[test]
fn reads_and_writes_bytes() {
    let mut client = Client::of(H2U);
    assert_eq!(client.ask("11000043412CDAB"), "ACK");
    assert_eq!(client.map.plc.d(0, 2), [0x1234, 0xabcd_u16 as i16]);
    assert_eq!(client.ask("0100101"), "12");
    assert_eq!(client.ask("1100101FF"), "ACK");
    assert_eq!(
        client.map.plc.d(0, 2),
        [0xff34_u16 as i16, 0xabcd_u16 as i16]
    );
    assert_eq!(client.ask("10C040470110100"), "ACK");
    assert_eq!(client.map.counter32(201), Some(70000));
    assert_eq!(client.ask("00C0404"), "70110100");
    assert_eq!(client.ask("E1000C00103"), "ACK");
    assert_eq!(client.map.plc.m(1535, 4), "0110");
    assert_eq!(client.ask("E0000C001"), "03");
}

#[test]
fn forces_and_resets() {
    let mut client = Client::of(H2U);
    assert_eq!(client.ask("70A08"), "ACK");
    assert_eq!(client.ask("E70B00"), "ACK");
    assert_eq!(client.map.plc.m(9, 4), "0110");
    assert_eq!(client.ask("80A08"), "ACK");
    assert_eq!(client.map.plc.m(9, 4), "0010");
    client.map.set_bit(Class::T, 3, true);
    client.map.set_word(Class::T, 3, 300);
    // Reset of T3: byte 0700h, bit 3803h.
    assert_eq!(client.ask("E70338"), "ACK");
    assert_eq!(client.map.word(Class::T, 3), Some(0));
    assert_eq!(client.map.bit(Class::T, 3), Some(false));
    // Coils and words cannot be forced.
    assert_eq!(client.ask("E70027"), "NAK Err(Address)");
    assert_eq!(client.ask("E70050"), "NAK Err(Address)");
}

#[test]
fn run_and_stop() {
    let mut client = Client::of(H2U);
    assert_eq!(client.ask("E7250E"), "ACK");
    assert_eq!(client.map.request.take(), Some(false));
    assert_eq!(client.ask("E8250E"), "ACK");
    assert_eq!(client.map.request.take(), Some(true));
    assert_eq!(client.ask("E7240E"), "ACK");
    assert_eq!(client.map.request, None, "M8036 needs M8035");
    client.ask("E7230E");
    client.ask("E7240E");
    assert_eq!(client.map.request.take(), Some(true));
    // On HM these relays request interrupts.
    let mut client = Client::of(HM);
    assert_eq!(client.ask("E7250E"), "ACK");
    assert_eq!(client.map.request, None);
    assert_eq!(client.map.bit(Class::M, 8037), Some(true));
}

#[test]
fn monitor_lists() {
    let mut client = Client::of(H2U);
    client.map.set_word(Class::T, 0, 5);
    client.map.set_word(Class::C, 5, 17);
    client.map.set_bit(Class::X, 0, true);
    client.map.set_bit(Class::Y, 0, true);
    assert_eq!(client.ask("E1014000E0281030000100A0A0012000C0A00"), "ACK");
    assert_eq!(client.ask("E00179005"), "0500110003");
    client.map.set_bit(Class::X, 0, false);
    client.map.set_bit(Class::M, 10, true);
    assert_eq!(client.ask("E00179005"), "0500110006");
    // A list that names its own sample is not a loop.
    assert_eq!(client.ask("E1014000801810100901780BC"), "ACK");
    assert_eq!(client.ask("E00179003"), "000000");
}

#[test]
fn single_devices_of_fx3() {
    let mut client = Client::of(L01S);
    client.map.set_bit(Class::M, 8000, true);
    client.map.set_word(Class::D, 8003, 0x1234);
    assert_eq!(client.ask("F50100060"), "1");
    assert_eq!(client.ask("F501108006"), "3412");
    assert_eq!(Client::of(H2U).ask("F50100060"), "NAK Err(Command)");
}

#[test]
fn refusals() {
    let mut client = Client::of(H2U);
    assert_eq!(client.ask("0100000"), "NAK Err(Data)");
    assert_eq!(client.ask("0100041"), "NAK Err(Data)");
    assert_eq!(client.ask("01G0002"), "NAK Err(Unknown)");
    assert_eq!(client.ask("01000"), "NAK Err(Form)");
    assert_eq!(client.ask("010000200"), "NAK Err(Form)");
    assert_eq!(client.ask("E0200"), "NAK Err(Command)");
    assert_eq!(client.ask("0400001"), "NAK Err(Address)");
    assert_eq!(client.ask(""), "NAK Err(Command)");
    assert_eq!(client.ask("110000434"), "NAK Err(Form)");
    for program_memory in [
        "E01800002",
        "E118000020800",
        "E41805C0F00",
        "E67",
        "EC12345678",
        "B",
    ] {
        assert_eq!(client.ask(program_memory), "NAK Ok(())");
    }
    let (reply, outcome) = client.exchange(b"\x020100002\x0351");
    assert_eq!(
        (reply.as_slice(), outcome),
        (&[NAK][..], Err(LineFault::Sum))
    );
    assert_eq!(client.map.writes, 0);
}

/// Requests of GX Works2 and answers of an FX3G while its program, `LD X000`, `OUT Y000`, `END`, is read; a PLC gives
/// no such answer after a request to write.
#[test]
fn a_program_is_read_and_stays_what_it_is() {
    let mut client = Client::of(L01S);
    let mut program = std::vec![0; 0x5c];
    program[0] = 8;
    program.extend([0x00, 0x24, 0x00, 0xc5, 0x0f, 0x00]);
    client.map.program = Some(program);
    assert_eq!(client.ask("E01800002"), "0800");
    assert_eq!(client.ask("E01805C06"), "002400C50F00");
    assert_eq!(client.ask("E41805C0F00"), "18060");
    assert_eq!(client.ask("F8"), "18060");
    assert_eq!(client.ask("E01806202"), "FFFF");
    assert_eq!(client.ask("0805C06"), "002400C50F00", "as FX1S is asked");
    assert_eq!(
        client.ask("E41805CEFBE"),
        "NAK Ok(())",
        "a word that is not there"
    );
    assert_eq!(client.ask("E01800000"), "NAK Err(Data)");
    assert_eq!(client.ask("E017FFF02"), "NAK Ok(())");
    for change in ["E118000020800", "1805C020000", "E67", "B", "F7180000000000"] {
        assert!(client.ask(change).starts_with("NAK"), "{change}");
    }
    assert_eq!(client.ask("E01805C06"), "002400C50F00");
}

proptest! {
    /// Any bytes: no panic, and what is rejected writes nothing.
    #[test]
    fn any_bytes(request in proptest::collection::vec(any::<u8>(), 0..600)) {
        for settings in [H2U, L01S, HM] {
            let mut client = Client::of(settings);
            cut(&request);
            let (reply, _) = client.exchange(&request);
            prop_assert!(reply == [NAK] || request == [ENQ]);
            prop_assert_eq!((client.map.writes, client.map.strays), (0, 0));
        }
    }

    /// Commands with right sums.
    #[test]
    fn any_command(text in "(0|1|7|8|E00|E10|E7|E8|F501|F5010)[0-9A-F]{4}(0[0-9])?[0-9A-F]{0,20}") {
        for settings in [H2U, L01S, HM] {
            let mut client = Client::of(settings);
            let request = frame(text.as_bytes());
            prop_assert_eq!(cut(&request), Cut::Whole);
            let (reply, _) = client.exchange(&request);
            if reply == [NAK] {
                prop_assert_eq!(client.map.writes, 0);
                prop_assert_eq!(client.map.request, None);
            }
        }
    }
}
