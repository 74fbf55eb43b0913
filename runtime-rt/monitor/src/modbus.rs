//! A PLC that is a Modbus slave: by Modbus TCP, or by RTU on a serial line. Its devices have the addresses of its
//! model.

use crate::{Error, Item, Line, Patience, Sample};
use rungc_rt::comm::modbus::{Area, Fill, Profile, crc16};
use rungc_rt::{Class, FIRST_COUNTER32};
use std::thread;
use std::time::{Duration, Instant};

/// Bits between two values that are read along, since another request takes as long.
const BIT_GAP: u16 = 128;

/// Registers between two values that are read along.
const WORD_GAP: u16 = 8;

/// Marks an answer as a rejection.
const REJECTED: u8 = 0x80;

/// Bytes of an answer before its values: unit, function, number of bytes.
const HEAD: usize = 3;

/// Functions that read. There are no others here.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Function {
    Coils = 1,
    Inputs = 2,
    Registers = 3,
    InputRegisters = 4,
}

impl Function {
    fn reads_bits(self) -> bool {
        matches!(self, Function::Coils | Function::Inputs)
    }
}

/// Form of requests and answers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Framing {
    /// Modbus TCP.
    Tcp,
    /// RTU, with this pause before each request.
    Rtu(Duration),
}

/// A Modbus slave at the end of a line.
pub struct Plc<L> {
    line: L,
    patience: Patience,
    framing: Framing,
    unit: u8,
    profile: &'static Profile,
    transaction: u16,
}

/// Addresses that are read at once, within one area.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Block {
    function: Function,
    /// Start of the area.
    area: u16,
    first: u16,
    count: u16,
    items: Vec<(Item, u16)>,
}

/// True for the value of a counter that has 32 bits.
fn is_long(item: Item) -> bool {
    matches!(item, Item::Word(Class::C, FIRST_COUNTER32..))
}

/// Address of a value in an area.
fn address(area: &Area, item: Item) -> Option<u16> {
    let (class, number, step) = match (item, area.fill) {
        (Item::Bit(class, number), Fill::Bits) | (Item::Word(class, number), Fill::Words) => {
            (class, number, 1)
        }
        (Item::Word(class, number), Fill::Counters) => (class, number, 2),
        _ => return None,
    };
    let offset = step * number.checked_sub(area.first)?;
    let fits = class == area.class && offset < area.count.into();
    fits.then(|| area.address.checked_add(offset as u16))?
}

impl Block {
    /// The request for a value alone; `None` if it has no address.
    fn of(item: Item, profile: &Profile) -> Option<Block> {
        let tables = [
            (Function::Coils, profile.coils),
            (Function::Inputs, profile.inputs),
            (Function::Registers, profile.registers),
            (Function::InputRegisters, profile.input_registers),
        ];
        let mut areas = tables
            .into_iter()
            .flat_map(|(function, areas)| areas.iter().map(move |area| (function, area)));
        areas.find_map(|(function, area)| {
            let first = address(area, item)?;
            Some(Block {
                function,
                area: area.address,
                first,
                count: if is_long(item) { 2 } else { 1 },
                items: vec![(item, first)],
            })
        })
    }

    fn end(&self) -> u32 {
        u32::from(self.first) + u32::from(self.count)
    }

    /// Takes the values of a later request over, if that is no more work.
    fn take(&mut self, other: &Block, profile: &Profile) -> bool {
        let (gap, most) = match self.function.reads_bits() {
            true => (BIT_GAP, profile.limits.read_bits),
            false => (WORD_GAP, profile.limits.read_words),
        };
        let count = other.end().max(self.end()) - u32::from(self.first);
        let fits = (self.function, self.area) == (other.function, other.area)
            && u32::from(other.first) <= self.end() + u32::from(gap)
            && count <= most.into();
        if fits {
            self.count = count as u16;
            self.items.extend(&other.items);
        }
        fits
    }

    /// The value at an address, of the bytes of an answer.
    fn value(&self, item: Item, address: u16, bytes: &[u8]) -> Option<i32> {
        let at = usize::from(address - self.first);
        if self.function.reads_bits() {
            return Some(i32::from(bytes.get(at / 8)? >> (at % 8) & 1));
        }
        match (is_long(item), bytes.get(2 * at..)?) {
            // The low word first.
            (true, &[b, a, d, c, ..]) => Some(i32::from_le_bytes([a, b, c, d])),
            (false, &[high, low, ..]) => Some(i16::from_be_bytes([high, low]).into()),
            _ => None,
        }
    }

    /// The two halves of a block that the PLC rejects; `None` of a single value.
    fn halves(&self, profile: &Profile) -> Option<[Vec<Block>; 2]> {
        let (before, after) = self.items.split_at(self.items.len() / 2);
        let half = |items: &[(Item, u16)]| plan(items.iter().map(|(item, _)| *item), profile).0;
        (!before.is_empty()).then(|| [half(before), half(after)])
    }
}

/// The requests for these values, and the values that have no address.
fn plan(items: impl IntoIterator<Item = Item>, profile: &Profile) -> (Vec<Block>, Vec<Item>) {
    let (mut alone, mut hidden) = (Vec::new(), Vec::new());
    for item in items {
        match Block::of(item, profile) {
            Some(block) => alone.push(block),
            None => hidden.push(item),
        }
    }
    alone.sort_by_key(|block| (block.function, block.first));
    let mut blocks: Vec<Block> = Vec::new();
    for block in alone {
        let taken = blocks
            .last_mut()
            .is_some_and(|last| last.take(&block, profile));
        if !taken {
            blocks.push(block);
        }
    }
    (blocks, hidden)
}

impl<L: Line> Plc<L> {
    /// The slave with this number at the end of an open line, with the addresses of a model.
    pub fn new(
        line: L,
        patience: Patience,
        (framing, unit): (Framing, u8),
        profile: &'static Profile,
    ) -> Self {
        Plc {
            line,
            patience,
            framing,
            unit,
            profile,
            transaction: 0,
        }
    }

    /// Reads values, neighbours in one request. What the PLC rejects, and what has no address, is hidden.
    ///
    /// # Errors
    /// No answer, or none that is whole.
    pub fn read(&mut self, items: impl IntoIterator<Item = Item>) -> Result<Sample, Error> {
        let (blocks, hidden) = plan(items, self.profile);
        let mut sample = Sample {
            hidden,
            ..Sample::default()
        };
        let mut pending = blocks;
        pending.reverse();
        while let Some(block) = pending.pop() {
            match (self.request(&block)?, block.halves(self.profile)) {
                (Some(bytes), _) => {
                    for &(item, address) in &block.items {
                        sample.enter(item, block.value(item, address, &bytes));
                    }
                }
                (None, Some(halves)) => pending.extend(halves.into_iter().rev().flatten()),
                (None, None) => sample
                    .hidden
                    .extend(block.items.iter().map(|(item, _)| item)),
            }
        }
        Ok(sample)
    }

    /// The bytes of the values that a block covers; `None` if the PLC rejects the request.
    fn request(&mut self, block: &Block) -> Result<Option<Vec<u8>>, Error> {
        let function = block.function as u8;
        let mut request = vec![self.unit, function];
        request.extend(block.first.to_be_bytes());
        request.extend(block.count.to_be_bytes());
        let length = match block.function.reads_bits() {
            true => usize::from(block.count).div_ceil(8),
            false => 2 * usize::from(block.count),
        };
        let mut why = "";
        for _ in 0..=self.patience.retries {
            let answer = match self.framing {
                Framing::Tcp => self.over_tcp(&request)?,
                Framing::Rtu(silence) => self.over_rtu(&request, silence)?,
            };
            match answer {
                Err(fault) => why = fault,
                Ok(answer) => {
                    return match answer.as_slice() {
                        [unit, code, ..] if *unit != self.unit || code & !REJECTED != function => {
                            Err(self.failure("what answers is not this slave"))
                        }
                        [_, code, ..] if *code != function => Ok(None),
                        [_, _, count, values @ ..]
                            if usize::from(*count) == length && values.len() == length =>
                        {
                            Ok(Some(values.to_vec()))
                        }
                        _ => {
                            Err(self
                                .failure("the PLC's answer has another length than was asked for"))
                        }
                    };
                }
            }
        }
        let attempts = self.patience.retries + 1;
        Err(self.failure(&format!("{why} (asked {attempts} times)")))
    }

    /// Sends a request in a frame of Modbus TCP. Returns the answer from its unit on, or what is wrong with it.
    fn over_tcp(&mut self, request: &[u8]) -> Result<Result<Vec<u8>, &'static str>, Error> {
        self.transaction = self.transaction.wrapping_add(1);
        let own = self.transaction.to_be_bytes();
        let mut frame = own.to_vec();
        frame.extend([0, 0, 0, request.len() as u8]);
        frame.extend(request);
        self.send(&frame)?;
        let deadline = Instant::now() + self.patience.timeout;
        loop {
            let Some(head) = self.receive(6, deadline)? else {
                return Ok(Err("no answer; check the address and the unit"));
            };
            let [high, low, 0, 0, 0, length] = head[..] else {
                return Err(self.failure("what answers does not speak Modbus TCP"));
            };
            let Some(answer) = self.receive(length.into(), deadline)? else {
                return Ok(Err("the PLC's answer is not complete"));
            };
            // A late answer to an earlier request is passed over.
            if [high, low] == own {
                return Ok(Ok(answer));
            }
        }
    }

    /// Sends a request in a frame of RTU. Returns the answer from its unit on, or what is wrong with it.
    fn over_rtu(
        &mut self,
        request: &[u8],
        silence: Duration,
    ) -> Result<Result<Vec<u8>, &'static str>, Error> {
        self.read_away(silence)?;
        let mut frame = request.to_vec();
        frame.extend(crc16(request).to_le_bytes());
        self.send(&frame)?;
        let deadline = Instant::now() + self.patience.timeout;
        let Some(mut answer) = self.receive(HEAD, deadline)? else {
            return Ok(Err(
                "no answer; check the cable, the unit, --baud and --line-format",
            ));
        };
        // A rejection has its code in place of the number of bytes, and nothing after it but the check.
        let rest = match answer[..] {
            [_, function, count] if function & REJECTED == 0 => usize::from(count) + 2,
            _ => 2,
        };
        let Some(rest) = self.receive(rest, deadline)? else {
            return Ok(Err("the PLC's answer is not complete"));
        };
        answer.extend(rest);
        Ok(match crc16(&answer) {
            0 => {
                answer.truncate(answer.len() - 2);
                Ok(answer)
            }
            _ => Err("the PLC's answer is damaged"),
        })
    }

    fn send(&mut self, frame: &[u8]) -> Result<(), Error> {
        let sent = self.line.send(frame, self.patience.timeout);
        sent.map_err(|error| self.failure(&error.to_string()))
    }

    /// Receives this many bytes; `None` if they do not come in time.
    fn receive(&mut self, count: usize, deadline: Instant) -> Result<Option<Vec<u8>>, Error> {
        let mut received = vec![0; count];
        let mut filled = 0;
        while filled < count {
            if Instant::now() >= deadline {
                return Ok(None);
            }
            let came = self.line.receive(&mut received[filled..]);
            filled += came.map_err(|error| self.failure(&error.to_string()))?;
        }
        Ok(Some(received))
    }

    /// Waits until the line has been silent for a while, and forgets what has come.
    fn read_away(&mut self, silence: Duration) -> Result<(), Error> {
        thread::sleep(silence);
        let mut buffer = [0; 256];
        let deadline = Instant::now() + self.patience.timeout;
        while Instant::now() < deadline {
            let came = self.line.receive(&mut buffer);
            if came.map_err(|error| self.failure(&error.to_string()))? == 0 {
                break;
            }
        }
        Ok(())
    }

    fn failure(&self, why: &str) -> Error {
        Error {
            line: self.line.name(),
            why: why.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rungc_rt::comm::modbus::{ALL, FX3U, H2U};

    #[test]
    fn neighbours_share_a_request() {
        let items = [
            Item::Bit(Class::X, 0),
            Item::Bit(Class::Y, 3),
            Item::Bit(Class::M, 0),
            Item::Bit(Class::M, 128),
            Item::Bit(Class::M, 8000),
            Item::Word(Class::D, 0),
            Item::Word(Class::D, 9),
            Item::Word(Class::T, 0),
            Item::Word(Class::C, 200),
            Item::Word(Class::C, 199),
            Item::Word(Class::V, 0),
        ];
        let (blocks, hidden) = plan(items, &H2U);
        assert_eq!(hidden, [Item::Word(Class::V, 0)]);
        let requests: Vec<_> = blocks
            .iter()
            .map(|block| (block.function as u8, block.first, block.count))
            .collect();
        let expected = [
            (1, 0x0000, 129),
            (1, 0x1f40, 1),
            (1, 0xf800, 1),
            (1, 0xfc03, 1),
            (3, 0x0000, 10),
            (3, 0xf000, 1),
            (3, 0xf4c7, 1),
            (3, 0xf700, 2),
        ];
        assert_eq!(requests, expected);
        let (blocks, _) = plan([Item::Bit(Class::X, 0)], &FX3U);
        assert_eq!(
            (blocks[0].function, blocks[0].first),
            (Function::Inputs, 0x3400)
        );
    }

    #[test]
    fn values_lie_as_the_standard_says() {
        let value = |item, bytes: &[u8]| {
            let block = Block::of(item, &H2U).unwrap();
            block.value(item, block.first, bytes)
        };
        assert_eq!(value(Item::Bit(Class::M, 0), &[1]), Some(1));
        assert_eq!(value(Item::Word(Class::D, 0), &[0xff, 0xfe]), Some(-2));
        let long = Item::Word(Class::C, 200);
        assert_eq!(value(long, &[0xff, 0xfe, 0xff, 0xff]), Some(-2));
        assert_eq!(value(long, &[0x00, 0x01]), None);
    }

    #[test]
    fn no_request_is_longer_than_the_slave_accepts() {
        for profile in ALL {
            let words = (0..500).map(|n| Item::Word(Class::D, n));
            let bits = (0..3000).map(|n| Item::Bit(Class::M, n));
            let (blocks, hidden) = plan(words.chain(bits), profile);
            assert!(hidden.is_empty(), "{}", profile.name);
            for block in &blocks {
                let most = match block.function.reads_bits() {
                    true => profile.limits.read_bits,
                    false => profile.limits.read_words,
                };
                assert!(block.count <= most, "{}: {block:?}", profile.name);
            }
            let values: usize = blocks.iter().map(|block| block.items.len()).sum();
            assert_eq!(values, 3500);
        }
    }
}
