//! Memories and what speaks of them: files for flash, a boot loader's answers, latched devices in flash, frames that
//! were overheard.

use super::Target;
use crate::plc::{Plc, module};
use rungc_firmware::flash::loader::{Line, Loader};
use rungc_firmware::flash::{Payload, uf2};
use rungc_models::ModelId;
use rungc_rt::Ports;
use rungc_rt::comm::Protocol;
use rungc_rt::comm::service::ServerProtocol;
use rungc_rt::retain::{Flash, FlashFailed, Slots};
use rungc_sim::serve::{Decoder, Direction, LinkProtocol};
use std::io;
use std::time::Duration;

/// A file that is to be written to flash.
fn payload(input: &[u8]) {
    if let Ok(payload) = Payload::read(input, 0x0800_0000) {
        assert!(payload.end() <= 1 << 32);
    }
    if let Ok(payload) = uf2::read(input) {
        assert!(payload.end() <= 1 << 32);
    }
}

/// A line on which something else answers than a boot loader, until it is pulled out.
struct Anyone<'i>(&'i [u8]);

impl Line for Anyone<'_> {
    fn may_continue(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn send(&mut self, _: &[u8]) -> io::Result<()> {
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.0.is_empty() {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        let (now, later) = self.0.split_at(self.0.len().min(buffer.len()));
        buffer[..now.len()].copy_from_slice(now);
        self.0 = later;
        Ok(now.len())
    }
}

fn boot_loader(input: &[u8]) {
    let Ok(mut loader) = Loader::connect(Anyone(input), Duration::from_secs(1)) else {
        return;
    };
    let _ = loader.id();
    let _ = loader.is_readable();
    let _ = loader.erase(3);
    let _ = loader.write(0x0800_0000, &[1, 2, 3, 4]);
}

/// Two slots of flash that hold anything.
struct Slot([Vec<u8>; 2]);

impl Flash for Slot {
    fn slot_len(&self) -> u32 {
        self.0[0].len() as u32
    }

    fn read(&mut self, slot: usize, offset: u32, bytes: &mut [u8]) -> Result<(), FlashFailed> {
        let held = self
            .0
            .get(slot)
            .and_then(|held| held.get(offset as usize..));
        let held = held.and_then(|held| held.get(..bytes.len()));
        bytes.copy_from_slice(held.ok_or(FlashFailed)?);
        Ok(())
    }

    fn erase(&mut self, slot: usize) -> Result<(), FlashFailed> {
        self.0.get_mut(slot).ok_or(FlashFailed)?.fill(0xff);
        Ok(())
    }

    fn program(&mut self, slot: usize, offset: u32, bytes: &[u8]) -> Result<(), FlashFailed> {
        let held = self
            .0
            .get_mut(slot)
            .and_then(|held| held.get_mut(offset as usize..));
        let held = held.and_then(|held| held.get_mut(..bytes.len()));
        held.ok_or(FlashFailed)?.copy_from_slice(bytes);
        Ok(())
    }
}

/// Bytes of a slot: several records of the program that is tested.
const SLOT: usize = 16 * 1024;

/// Slots that begin with the halves of an input.
fn slots(input: &[u8]) -> Slot {
    let (one, other) = input.split_at(input.len() / 2);
    Slot([one, other].map(|part| {
        let mut slot = part[..part.len().min(SLOT)].to_vec();
        slot.resize(SLOT, 0xff);
        slot
    }))
}

/// Latched devices are loaded from what flash holds, and can be saved and loaded again whatever that was.
fn latched() -> Target {
    let module = module(ModelId::Fx1s, 0, "LD M8000\nOUT M0\nEND\n");
    let mut plc = Plc::new(module, 0);
    let mut fresh = Slots::open(slots(&[])).expect("flash can be read");
    fresh.save(plc.devices()).expect("a record fits");
    let Slot([one, _]) = fresh.flash;
    let length = one
        .iter()
        .rposition(|byte| *byte != 0xff)
        .map_or(0, |last| last + 1);
    // One record in the first slot, and one in each.
    let alone = [&one[..length], &vec![0xff; length]].concat();
    let both = [&one[..length], &one[..length]].concat();
    Target {
        name: "latched-devices",
        run: Box::new(move |input| {
            let mut plc = Plc::new(module, 0);
            let mut slots = Slots::open(slots(input)).expect("flash can be read");
            slots.load(plc.devices()).expect("flash can be read");
            slots.save(plc.devices()).expect("flash can be written");
            let mut again = Slots::open(slots.flash).expect("flash can be read");
            let mut other = Plc::new(module, 0);
            again.load(other.devices()).expect("flash can be read");
            assert_eq!(plc.bits(), other.bits());
        }),
        seeds: vec![alone, both],
    }
}

/// A frame that was overheard, after another in the other direction: the first byte chooses what is spoken and the
/// direction, the second says where the other frame ends.
fn overheard(input: &[u8]) {
    let [variant, split, frames @ ..] = input else {
        return;
    };
    let (before, bytes) = frames.split_at(frames.len().min((*split).into()));
    let links = [
        LinkProtocol::Client,
        LinkProtocol::Tcp(ServerProtocol::ModbusTcp),
        LinkProtocol::Tcp(ServerProtocol::Mc),
        LinkProtocol::Tcp(ServerProtocol::ProgrammingPort),
        LinkProtocol::Serial(Protocol::Free),
        LinkProtocol::Serial(Protocol::ProgrammingPort),
        LinkProtocol::Serial(Protocol::ModbusRtu),
        LinkProtocol::Serial(Protocol::ModbusAscii),
        LinkProtocol::Serial(Protocol::MasterRtu),
        LinkProtocol::Serial(Protocol::MasterAscii),
        LinkProtocol::Serial(Protocol::MasterTable),
        LinkProtocol::Serial(Protocol::ComputerLink),
        LinkProtocol::Serial(Protocol::ComputerLinkMaster),
        LinkProtocol::Serial(Protocol::ParallelMaster),
        LinkProtocol::Serial(Protocol::ParallelSlave),
        LinkProtocol::Serial(Protocol::NnMaster),
        LinkProtocol::Serial(Protocol::NnSlave),
        LinkProtocol::Serial(Protocol::EnhancedMaster),
        LinkProtocol::Serial(Protocol::EnhancedSlave),
        LinkProtocol::Serial(Protocol::Can),
    ];
    let link = links[usize::from(variant >> 1) % links.len()];
    let direction = [Direction::In, Direction::Out][usize::from(variant & 1)];
    for family in [Ports::Inovance, Ports::L01s, Ports::Hm, Ports::Fx3] {
        let decoder = Decoder::new(family, 24_120);
        let before = Some(before).filter(|before| !before.is_empty());
        let _ = decoder.decode(link, direction, bytes, before);
    }
}

/// An ELF file for Arm with one part that is loaded.
fn elf() -> Vec<u8> {
    let word = |value: u32| value.to_le_bytes();
    let half = |value: u16| value.to_le_bytes();
    let head = [
        &b"\x7fELF\x01\x01\x01"[..],
        &[0; 9],
        &half(2),
        &half(40),
        &word(1),
        &word(0x0800_0001),
        &word(52),
        &word(0),
        &word(0),
        &half(52),
        &half(32),
        &half(1),
        &half(40),
        &half(0),
        &half(0),
    ];
    let part = [1, 84, 0x0800_0000, 0x0800_0000, 8, 8, 5, 4].map(word);
    [
        &head.concat()[..],
        &part.concat(),
        &[1, 2, 3, 4, 5, 6, 7, 8],
    ]
    .concat()
}

/// A block of UF2 for RP2040.
fn block() -> Vec<u8> {
    let words = [
        0x0A32_4655_u32,
        0x9E5D_5157,
        0x2000,
        0x1000_0000,
        256,
        0,
        1,
        0xE48B_FF56,
    ];
    let mut block: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    block.resize(508, 0);
    block.extend(0x0AB1_6F30_u32.to_le_bytes());
    block
}

pub(super) fn targets() -> [Target; 4] {
    let target = |name, run: fn(&[u8]), seeds| Target {
        name,
        run: Box::new(run),
        seeds,
    };
    // The answers of a boot loader to the commands above: acknowledgements, its commands, its product number.
    let answers = b"\x79\x79\x06\x22\x00\x01\x02\x11\x31\x43\x79\x79\x01\x04\x10\x79\
        \x79\x79\x79\x01\x02\x03\x04\x79\x79\x79\x79\x79";
    [
        target("flash-file", payload, vec![elf(), block()]),
        target("boot-loader", boot_loader, vec![answers.to_vec()]),
        latched(),
        target(
            "overheard",
            overheard,
            vec![
                b"\x02\x0c\0\x01\0\0\0\x06\x01\x03\0\0\0\x01\0\x01\0\0\0\x05\x01\x03\x02\0\x07"
                    .to_vec(),
                b"\x0c\0\x01\x03\0\0\0\x01\x84\x0a".to_vec(),
                b"\x0a\0\x02E00010F602\x0317".to_vec(),
            ],
        ),
    ]
}
