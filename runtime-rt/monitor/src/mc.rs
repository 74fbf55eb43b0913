//! A PLC that speaks the MC protocol over TCP, in binary: frame 1E, which the Ethernet modules of FX3 understand, or
//! 3E.

use crate::{Error, Item, Line, Patience, Sample};
use rungc_rt::Class;
use rungc_rt::comm::mc::codes;
use std::time::Instant;

/// Words that a request reads at most: what a PLC of the family sends of bit devices.
const MOST: u32 = 32;

/// Bits that a request reads at most, one by one.
const MOST_BITS: u32 = 255;

/// Words between two values that are read along, since another request takes as long.
const GAP: u32 = 4;

/// Bits of a bit device in a word.
const BITS: u32 = 16;

/// First counter whose value takes two words.
const FIRST_LONG: u32 = rungc_rt::FIRST_COUNTER32;

/// Time that a PLC may take, in units of 250 ms.
const TIMER: [u8; 2] = [4, 0];

/// Form of requests and answers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Frame {
    /// `command PC timer …`.
    E1,
    /// `5000 route length timer command …`.
    E3,
}

/// A PLC at the end of a connection.
pub struct Plc<L> {
    line: L,
    patience: Patience,
    frame: Frame,
}

/// Units of a batch read, by the commands of frame 1E.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Unit {
    Bits = 0,
    Words = 1,
}

/// Words that are read at once.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Block {
    class: Class,
    is_bit: bool,
    /// Number of the first word: of bit devices in words, of others in devices.
    first: u32,
    count: u32,
    items: Vec<Item>,
}

impl Block {
    /// The request for a value alone.
    fn of(item: Item) -> Block {
        let (class, is_bit, first, count) = match item {
            Item::Bit(class, number) => (class, true, number / BITS, 1),
            Item::Word(class, number) if is_long(item) => (class, false, number, 2),
            Item::Word(class, number) => (class, false, number, 1),
        };
        Block {
            class,
            is_bit,
            first,
            count,
            items: vec![item],
        }
    }

    /// Takes the values of a later request over, if that is no more work.
    fn take(&mut self, other: &Block) -> bool {
        let is_long = [&self.items, &other.items]
            .into_iter()
            .any(|items| is_long(items[0]));
        let fits = !is_long
            && (self.class, self.is_bit) == (other.class, other.is_bit)
            && other.first <= self.first + self.count + GAP
            && other.first + other.count - self.first <= MOST;
        if fits {
            self.count = self.count.max(other.first + other.count - self.first);
            self.items.extend(&other.items);
        }
        fits
    }

    fn value(&self, item: Item, words: &[u16]) -> Option<i32> {
        let (at, bit) = match item {
            Item::Bit(_, number) => (number / BITS, Some(number % BITS)),
            Item::Word(_, number) => (number, None),
        };
        let own = words.get((at - self.first) as usize..)?;
        Some(match (bit, own) {
            (Some(bit), [word, ..]) => i32::from(word >> bit & 1),
            (None, [low, high, ..]) if is_long(item) => {
                (u32::from(*high) << 16 | u32::from(*low)).cast_signed()
            }
            (None, [word, ..]) if !is_long(item) => word.cast_signed().into(),
            _ => return None,
        })
    }
}

/// True for the value of a counter that has 32 bits.
fn is_long(item: Item) -> bool {
    matches!(item, Item::Word(Class::C, FIRST_LONG..))
}

/// The requests for these values, each with its words.
fn plan(items: impl IntoIterator<Item = Item>) -> Vec<Block> {
    let mut alone: Vec<Block> = items.into_iter().map(Block::of).collect();
    alone.sort_by_key(|block| (block.class, block.is_bit, block.first));
    let mut blocks: Vec<Block> = Vec::new();
    for block in alone {
        if !blocks.last_mut().is_some_and(|last| last.take(&block)) {
            blocks.push(block);
        }
    }
    blocks
}

impl<L: Line> Plc<L> {
    /// A PLC at the end of an open connection.
    pub fn new(line: L, patience: Patience, frame: Frame) -> Self {
        Plc {
            line,
            patience,
            frame,
        }
    }

    /// Reads values, neighbours in one request. What the PLC rejects, and what the protocol does not have, is hidden.
    ///
    /// # Errors
    /// No answer, or none that is whole.
    pub fn read(&mut self, items: impl IntoIterator<Item = Item>) -> Result<Sample, Error> {
        let mut sample = Sample::default();
        for block in plan(items) {
            match self.words(&block)? {
                Some(words) => {
                    for &item in &block.items {
                        sample.enter(item, block.value(item, &words));
                    }
                }
                None => self.piecewise(&block.items, &mut sample)?,
            }
        }
        Ok(sample)
    }

    /// Reads the values of a block that the PLC rejects, which may begin or end where it has no more devices: bits one
    /// by one, and halves of words.
    fn piecewise(&mut self, items: &[Item], sample: &mut Sample) -> Result<(), Error> {
        let (&[first, ..], &[.., last]) = (items, items) else {
            return Ok(());
        };
        let values: Option<Vec<i32>> = match (first, last) {
            (Item::Bit(_, first), Item::Bit(_, last)) if last - first >= MOST_BITS => None,
            (Item::Bit(class, first), Item::Bit(_, last)) => {
                let bits = self.bits(class, first, last - first + 1)?;
                bits.and_then(|bits| {
                    let numbers = items.iter().map(|item| match *item {
                        Item::Bit(_, number) | Item::Word(_, number) => number,
                    });
                    let own = numbers.map(|number| bits.get((number - first) as usize).copied());
                    own.collect()
                })
            }
            _ => {
                let mut block = Block::of(first);
                let taken = items[1..].iter().all(|&item| block.take(&Block::of(item)));
                let words = if taken { self.words(&block)? } else { None };
                words.and_then(|words| {
                    let values = items.iter().map(|&item| block.value(item, &words));
                    values.collect()
                })
            }
        };
        match (values, items) {
            (Some(values), _) => sample.values.extend(items.iter().copied().zip(values)),
            (None, &[only]) => sample.hidden.push(only),
            (None, _) => {
                let (before, after) = items.split_at(items.len() / 2);
                self.piecewise(before, sample)?;
                self.piecewise(after, sample)?;
            }
        }
        Ok(())
    }

    /// Bits from a number on; `None` if the PLC rejects the request.
    fn bits(&mut self, class: Class, first: u32, count: u32) -> Result<Option<Vec<i32>>, Error> {
        let Some(codes) = codes(class, true) else {
            return Ok(None);
        };
        // Two to a byte, the first in the high digit.
        let answered = self.request(codes, (first, count), Unit::Bits)?;
        let digits = |byte: u8| [byte >> 4, byte & 1].map(|digit| i32::from(digit & 1));
        Ok(answered.map(|bytes| bytes.into_iter().flat_map(digits).collect()))
    }

    /// The words of a block; `None` if the PLC rejects the request.
    fn words(&mut self, block: &Block) -> Result<Option<Vec<u16>>, Error> {
        let Some(codes) = codes(block.class, block.is_bit) else {
            return Ok(None);
        };
        let head = if block.is_bit {
            block.first * BITS
        } else {
            block.first
        };
        let answered = self.request(codes, (head, block.count), Unit::Words)?;
        let words = |bytes: Vec<u8>| {
            let pairs = bytes.chunks_exact(2);
            let words = pairs.map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
            words.collect()
        };
        Ok(answered.map(words))
    }

    /// Sends a batch read, and receives what it reads; `None` if the PLC rejects it.
    fn request(
        &mut self,
        (code_1e, code_3e): (u16, u8),
        (head, count): (u32, u32),
        unit: Unit,
    ) -> Result<Option<Vec<u8>>, Error> {
        let head = head.to_le_bytes();
        let [points, ..] = count.to_le_bytes();
        let length = match unit {
            Unit::Bits => count.div_ceil(2) as usize,
            Unit::Words => 2 * count as usize,
        };
        let request = match self.frame {
            Frame::E1 => {
                let [low, high] = code_1e.to_le_bytes();
                let mut request = vec![unit as u8, 0xff];
                request.extend(TIMER);
                request.extend(head);
                request.extend([low, high, points, 0]);
                request
            }
            Frame::E3 => {
                let subcommand = match unit {
                    Unit::Bits => 1,
                    Unit::Words => 0,
                };
                // Network, PC, module and station: the PLC at the end of the connection.
                let mut request = vec![0x50, 0, 0, 0xff, 0xff, 3, 0, 12, 0];
                request.extend(TIMER);
                request.extend([0x01, 0x04, subcommand, 0]);
                request.extend([head[0], head[1], head[2], code_3e, points, 0]);
                request
            }
        };
        let sent = self.line.send(&request, self.patience.timeout);
        sent.map_err(|error| self.failure(&error.to_string()))?;
        let bytes = match self.frame {
            Frame::E1 => self.answer_1e(unit, length)?,
            Frame::E3 => self.answer_3e()?,
        };
        match bytes {
            Some(bytes) if bytes.len() != length => {
                Err(self.failure("the PLC's answer has another length than was asked for"))
            }
            bytes => Ok(bytes),
        }
    }

    fn answer_1e(&mut self, unit: Unit, length: usize) -> Result<Option<Vec<u8>>, Error> {
        /// What an answer adds to its command.
        const ANSWER: u8 = 0x80;
        /// End code that another one follows.
        const DETAILED: u8 = 0x5b;
        let head = self.receive(2)?;
        match head[..] {
            [answer, code] if answer == unit as u8 | ANSWER => match code {
                0 => self.receive(length).map(Some),
                DETAILED => self.receive(2).map(|_| None),
                _ => Ok(None),
            },
            _ => Err(self.failure("what answers does not speak MC protocol, frame 1E, in binary")),
        }
    }

    fn answer_3e(&mut self) -> Result<Option<Vec<u8>>, Error> {
        let head = self.receive(9)?;
        let [0xd0, 0, .., low, high] = head[..] else {
            return Err(
                self.failure("what answers does not speak MC protocol, frame 3E, in binary")
            );
        };
        let rest = self.receive(u16::from_le_bytes([low, high]).into())?;
        match rest.split_first_chunk::<2>() {
            Some(([0, 0], data)) => Ok(Some(data.to_vec())),
            Some(_) => Ok(None),
            None => Err(self.failure("the PLC's answer has no end code")),
        }
    }

    /// Receives this many bytes.
    fn receive(&mut self, count: usize) -> Result<Vec<u8>, Error> {
        let deadline = Instant::now() + self.patience.timeout;
        let mut received = Vec::new();
        while received.len() < count {
            if Instant::now() >= deadline {
                return Err(self.failure("no answer; check the address and the frame"));
            }
            let mut buffer = [0; 512];
            let rest = (count - received.len()).min(buffer.len());
            let came = self.line.receive(&mut buffer[..rest]);
            let came = came.map_err(|error| self.failure(&error.to_string()))?;
            received.extend(&buffer[..came]);
        }
        Ok(received)
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

    #[test]
    fn neighbours_share_a_request() {
        let items = [
            Item::Bit(Class::X, 0),
            Item::Bit(Class::X, 0o37),
            Item::Bit(Class::M, 8000),
            Item::Word(Class::T, 0),
            Item::Bit(Class::T, 3),
            Item::Word(Class::C, 199),
            Item::Word(Class::C, 200),
            Item::Word(Class::C, 201),
            Item::Word(Class::D, 0),
            Item::Word(Class::D, 31),
        ];
        let blocks = plan(items);
        let requests: Vec<_> = blocks
            .iter()
            .map(|b| (b.class, b.is_bit, b.first, b.count))
            .collect();
        let expected = [
            (Class::X, true, 0, 2),
            (Class::M, true, 500, 1),
            (Class::T, false, 0, 1),
            (Class::T, true, 0, 1),
            (Class::C, false, 199, 1),
            (Class::C, false, 200, 2),
            (Class::C, false, 201, 2),
            (Class::D, false, 0, 1),
            (Class::D, false, 31, 1),
        ];
        assert_eq!(requests, expected);
        assert_eq!(
            blocks[0].value(Item::Bit(Class::X, 0o37), &[0, 0x8000]),
            Some(1)
        );
        assert_eq!(
            blocks[5].value(Item::Word(Class::C, 200), &[0xfffe, 0xffff]),
            Some(-2)
        );
        assert_eq!(blocks[5].value(Item::Word(Class::C, 200), &[1]), None);
    }
}
