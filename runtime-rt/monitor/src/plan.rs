//! Requests for many values: neighbours share one.

use crate::Item;
use rungc_rt::Class;
use rungc_rt::comm::fx_port::Space;

/// Bytes that a request reads at most: what every PLC of the family sends.
const MOST: u32 = 0x40;

/// Bytes between two values that are read along, since another request takes as long.
const GAP: u32 = 12;

/// A request, and the values in its answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Block {
    /// First byte.
    pub address: u32,
    /// Number of bytes.
    pub count: u32,
    /// The values, each with its place.
    pub places: Vec<(Item, Place)>,
}

/// Place of a value in the memory of a PLC.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Place {
    /// First byte.
    address: u32,
    /// Number of bytes.
    count: u32,
    /// Of a bit, its position in the byte.
    bit: Option<u32>,
}

impl Place {
    /// Place of a value; `None` if the commands do not reach it.
    fn of(item: Item, space: Space) -> Option<Place> {
        match item {
            Item::Bit(class, number) => {
                let (address, bit) = space.bit_address(class, number)?;
                Some(Place {
                    address,
                    count: 1,
                    bit: Some(bit),
                })
            }
            Item::Word(class, number) => {
                let has_32_bits = class == Class::C && number >= 200;
                Some(Place {
                    address: space.word_address(class, number)?,
                    count: if has_32_bits { 4 } else { 2 },
                    bit: None,
                })
            }
        }
    }

    fn end(&self) -> u32 {
        self.address + self.count
    }
}

impl Block {
    /// The value at a place in the answer to this request.
    pub fn value(&self, place: Place, bytes: &[u8]) -> Option<i32> {
        let from = (place.address - self.address) as usize;
        let own = bytes.get(from..from + place.count as usize)?;
        Some(match (place.bit, own) {
            (Some(bit), [byte]) => i32::from(*byte >> bit & 1),
            (None, [low, high]) => i16::from_le_bytes([*low, *high]).into(),
            (None, [a, b, c, d]) => i32::from_le_bytes([*a, *b, *c, *d]),
            _ => return None,
        })
    }
}

/// The requests for these values, by address, and the values that the commands do not reach.
pub fn plan(items: impl IntoIterator<Item = Item>, space: Space) -> (Vec<Block>, Vec<Item>) {
    let (mut places, mut hidden) = (Vec::new(), Vec::new());
    for item in items {
        match Place::of(item, space) {
            Some(place) => places.push((item, place)),
            None => hidden.push(item),
        }
    }
    places.sort_by_key(|&(item, place)| (place, item));
    let mut blocks: Vec<Block> = Vec::new();
    for (item, place) in places {
        match blocks.last_mut() {
            Some(block)
                if place.address <= block.address + block.count + GAP
                    && place.end() - block.address <= MOST =>
            {
                block.count = block.count.max(place.end() - block.address);
                block.places.push((item, place));
            }
            _ => blocks.push(Block {
                address: place.address,
                count: place.count,
                places: vec![(item, place)],
            }),
        }
    }
    (blocks, hidden)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_a_request() {
        let items = [
            Item::Bit(Class::X, 0),
            Item::Bit(Class::X, 0o17),
            Item::Word(Class::D, 0),
            Item::Word(Class::D, 31),
            Item::Word(Class::D, 32),
            Item::Word(Class::C, 200),
            Item::Word(Class::D, 8028),
            Item::Word(Class::R, 0),
        ];
        let (blocks, hidden) = plan(items, Space::Fx3);
        assert_eq!(hidden, [Item::Word(Class::R, 0)]);
        let requests: Vec<_> = blocks.iter().map(|b| (b.address, b.count)).collect();
        // C200, D8028 at the place that FX2N has it at, D0, D31 and D32, X000 to X017.
        let expected = [
            (0x0c00, 4),
            (0x0e00 + 2 * 28, 2),
            (0x4000, 2),
            (0x4000 + 62, 4),
            (0x8ca0, 2),
        ];
        assert_eq!(requests, expected);
        let block = &blocks[4];
        let value = |at: usize, bytes: &[u8]| block.value(block.places[at].1, bytes);
        assert_eq!(value(0, &[0x01, 0x00]), Some(1));
        assert_eq!(value(1, &[0x00, 0x80]), Some(1));
        assert_eq!(value(1, &[0x00]), None);
        let block = &blocks[0];
        assert_eq!(
            block.value(block.places[0].1, &[0xfe, 0xff, 0xff, 0xff]),
            Some(-2)
        );
    }

    #[test]
    fn no_request_is_longer_than_an_answer() {
        for space in [Space::Basic, Space::Fx2n, Space::Fx3] {
            let words = (0..500).map(|n| Item::Word(Class::D, n));
            let bits = (0..1000).map(|n| Item::Bit(Class::M, n));
            let (blocks, hidden) = plan(words.chain(bits), space);
            assert!(hidden.is_empty());
            assert!(blocks.iter().all(|block| block.count <= MOST));
            let values: usize = blocks.iter().map(|block| block.places.len()).sum();
            assert_eq!(values, 1500);
            assert_eq!(blocks.len(), 16 + 2);
        }
    }
}
