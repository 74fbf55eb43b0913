//! Each function is run on devices that note what is read and written, and must use exactly what the table says.

use super::Specials;
use crate::double::Double;
use crate::fault::report;
use crate::operand::{Operand, OperandKind};
use crate::special::{self, Relay};
use crate::{Class, Cx, FIRST_SPECIAL, Hal, Plc, RtFn, Site, State, Sys, VirtualHal};
use core::cell::RefCell;
use std::collections::BTreeSet;
use std::string::String;
use std::vec::Vec;

/// Runs of each function.
const TRIES: usize = 200;

type Devices = BTreeSet<(u8, u32)>;

/// A PLC that notes which devices a function asks for.
struct Watched {
    plc: Double,
    read: RefCell<Devices>,
    written: Devices,
}

impl Watched {
    fn new(plc: Double) -> Self {
        Watched {
            plc,
            read: RefCell::default(),
            written: Devices::new(),
        }
    }
}

impl Plc for Watched {
    fn bit(&self, class: Class, number: u32) -> Option<bool> {
        self.read.borrow_mut().insert((class as u8, number));
        self.plc.bit(class, number)
    }

    fn set_bit(&mut self, class: Class, number: u32, value: bool) -> Option<()> {
        self.written.insert((class as u8, number));
        self.plc.set_bit(class, number, value)
    }

    fn word(&self, class: Class, number: u32) -> Option<i16> {
        self.read.borrow_mut().insert((class as u8, number));
        self.plc.word(class, number)
    }

    fn set_word(&mut self, class: Class, number: u32, value: i16) -> Option<()> {
        self.written.insert((class as u8, number));
        self.plc.set_word(class, number, value)
    }

    fn counter32(&self, number: u32) -> Option<i32> {
        self.read.borrow_mut().insert((Class::C as u8, number));
        self.plc.counter32(number)
    }

    fn set_counter32(&mut self, number: u32, value: i32) -> Option<()> {
        self.written.insert((Class::C as u8, number));
        self.plc.set_counter32(number, value)
    }

    fn state(&mut self, slot: u16) -> &mut State {
        self.plc.state(slot)
    }

    fn sys(&self) -> &Sys {
        self.plc.sys()
    }

    fn error_relay(&self) -> u32 {
        self.plc.error_relay()
    }

    fn value_error(&self) -> u16 {
        self.plc.value_error()
    }

    fn note_error(&mut self, code: u16, step: u32) {
        self.plc.note_error(code, step);
    }

    fn text(&self, index: u32) -> &[u8] {
        self.plc.text(index)
    }

    fn reset(&mut self, class: Class, number: u32) -> Option<()> {
        self.written.insert((class as u8, number));
        self.plc.reset(class, number)
    }
}

/// Random numbers, always the same.
struct Random(u64);

impl Random {
    fn below(&mut self, end: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as u32 % end
    }

    /// A number of which small ones are as likely as large ones.
    fn value(&mut self) -> i32 {
        match self.below(6) {
            0 => 0,
            1 => self.below(4) as i32,
            2 => self.below(40) as i32,
            3 => -(self.below(20) as i32),
            4 => [32767, -32768, 24_000, 9999][self.below(4) as usize],
            _ => self.below(65536) as i32 - 32768,
        }
    }

    /// Operand `i`: a register, a relay, a group or a constant; one that counts often a small constant.
    fn operand(&mut self, i: usize, name: &str) -> Operand {
        let first = 1000 * (i as i32 + 1);
        if name.starts_with(['m', 'n']) && self.below(2) == 0 {
            return Operand::constant(1 + self.below(4) as i32);
        }
        match self.below(8) {
            0..=2 => Operand::device(Class::D, first),
            3 => Operand::device(Class::M, first),
            4 => Operand {
                kind: OperandKind::Nibbles,
                class: Class::M,
                digits: 1 + self.below(4) as u8,
                area: 0,
                value: first,
            },
            5 => Operand {
                kind: OperandKind::Text,
                ..Operand::constant(0)
            },
            _ => Operand::constant(self.value()),
        }
    }
}

/// Devices that a function uses in a call with random operands on random devices.
fn used(function: RtFn, random: &mut Random) -> Watched {
    let mut plc = if random.below(3) == 0 {
        Double::wide()
    } else {
        Double::new()
    };
    for operand in 1..=5 {
        for at in 0..12 {
            let value = random.value();
            plc.set_d(1000 * operand + at, &[value]);
            plc.set_m(1000 * operand + at, ["0", "1"][random.below(2) as usize]);
        }
        if random.below(2) == 0 {
            let float = [0.0, 0.5, -2.0, 1.0e30, 1.0e-30, 3.0][random.below(6) as usize];
            plc.set_df(1000 * operand, float);
        }
        if random.below(3) == 0 {
            // A number in characters, or a time of day.
            let words = [
                [0x3120, 0x3332, 0, 0],
                [0x2d30, 0x352e, 0x30, 0],
                [23, 59, 58, 0],
            ];
            plc.set_d(1000 * operand, &words[random.below(3) as usize]);
        }
    }
    for modes in [
        RtFn::Smov,
        RtFn::Bmov,
        RtFn::Rcr,
        RtFn::MeanSum,
        RtFn::Asci,
        RtFn::Binda,
    ] {
        for relay in modes.modes() {
            plc.set_m(relay.number(), ["0", "1"][random.below(2) as usize]);
        }
    }
    // No error was there before.
    plc.set_m(special::M_FIRST_ERROR.number(), "0");
    plc.texts = std::vec![b"AB1".to_vec()];
    let names = function.operands().iter().enumerate();
    let ops: Vec<Operand> = names.map(|(i, name)| random.operand(i, name)).collect();
    let site = Site {
        slot: 0,
        ..plc.site
    };
    let mut plc = Watched::new(plc);
    let mut hal = VirtualHal::new();
    let done = function.call(&mut Cx::new(&mut plc, &mut hal as &mut dyn Hal, &ops, site));
    if let Err(fault) = done {
        // The effects of an error are the same for all functions.
        let before = (plc.read.take(), plc.written.clone());
        report(&mut plc, fault, 0);
        (plc.read, plc.written) = (RefCell::new(before.0), before.1);
    }
    let classes: BTreeSet<u8> = ops.iter().map(|op| op.class as u8).collect();
    let all = plc
        .read
        .borrow()
        .union(&plc.written)
        .copied()
        .collect::<Vec<_>>();
    for (class, number) in all {
        let named = classes.contains(&class) || number >= FIRST_SPECIAL;
        assert!(
            named,
            "{}: device {number} of class {class}, operands {ops:?}",
            function.name()
        );
    }
    plc
}

/// Of some devices, the special ones, as names. A word of relays that begins below M8000 reaches M8007, and a constant
/// that stands where a device should names one beyond those that there are.
fn special_names(devices: &Devices) -> BTreeSet<String> {
    let flags = FIRST_SPECIAL + 8..9000;
    let special = devices.iter().filter(|(_, number)| flags.contains(number));
    special
        .map(|&(class, number)| {
            let letter = if class == Class::M as u8 { 'M' } else { 'D' };
            std::format!("{letter}{number}")
        })
        .collect()
}

fn relays(relays: &[Relay]) -> BTreeSet<String> {
    relays
        .iter()
        .map(|relay| std::format!("M{}", relay.number()))
        .collect()
}

#[test]
fn functions_use_the_special_devices_that_the_table_says() {
    let mut wrong = Vec::new();
    let mut asked = 0;
    for &function in RtFn::ALL {
        let Some(Specials {
            reads,
            writes,
            registers,
        }) = function.specials()
        else {
            continue;
        };
        asked += 1;
        let mut random = Random(7);
        let (mut read, mut written) = (Devices::new(), Devices::new());
        for _ in 0..TRIES {
            let plc = used(function, &mut random);
            read.extend(plc.read.into_inner());
            written.extend(plc.written);
        }
        let (read, written) = (special_names(&read), special_names(&written));
        let both: BTreeSet<String> = registers
            .iter()
            .map(|of| std::format!("D{}", of.number()))
            .collect();
        let expected = (&relays(reads) | &both, &relays(writes) | &both);
        if (&read, &written) != (&expected.0, &expected.1) {
            wrong.push(std::format!(
                "{}: reads {read:?}, writes {written:?}",
                function.name()
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(asked > 100, "{asked}");
}
