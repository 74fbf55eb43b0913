//! Blocks of devices that are copied or filled, as logic.

use super::Encoder;
use crate::aig::Lit;
use crate::bits::{Bits, constant};
use rungc_ir::node::{AccessKind, Action, Block, Place};
use rungc_syntax::DeviceClass;

/// Maximum number of writes that a block is, each to a place that its index may lead to.
const MOST_WRITES: usize = 4096;

/// A place `offset` devices after another.
fn after(place: Place, offset: u32) -> Place {
    let number = place.number.saturating_add(offset);
    Place { number, ..place }
}

impl Encoder<'_> {
    /// Copies or fills a block; one that an index may lead to very many devices changes any of them.
    pub(super) fn block(&mut self, block: &Block, guard: Lit) {
        let (to, count) = block.written();
        let bits = matches!(
            to.class,
            DeviceClass::X | DeviceClass::Y | DeviceClass::M | DeviceClass::S
        );
        let kind = if bits {
            AccessKind::Bit
        } else {
            AccessKind::Word
        };
        let Some(places) = self.first_places(to, count) else {
            return self.write_anywhere(&Action::Block(*block), guard);
        };
        let offsets = self.written_offsets(to, count);
        if places.len() > 1 && places.len().saturating_mul(offsets.len()) > MOST_WRITES {
            return self.write_anywhere(&Action::Block(*block), guard);
        }
        let values: Vec<(u32, Lit, Bits)> = offsets
            .into_iter()
            .map(|offset| {
                let value = match *block {
                    Block::Copy { from, .. } => self.read(kind.at(after(from, offset))),
                    Block::Fill { value, .. } => self.eval(value),
                };
                (offset, self.is_within(block, offset), value)
            })
            .collect();
        for (here, number) in places {
            let here = self.aig.and(guard, here);
            for (offset, within, value) in &values {
                let here = self.aig.and(here, *within);
                self.write_at(kind, (to.class, number + offset), value, here);
            }
        }
    }

    /// Devices that a block may begin with, each under a condition; `None` if there are very many.
    fn first_places(&mut self, to: Place, count: u32) -> Option<Vec<(Lit, u32)>> {
        let Some(index) = to.index else {
            return Some(vec![(Lit::TRUE, to.number)]);
        };
        let index = self.eval(index);
        let candidates = self.candidates(to, &index, count)?;
        Some(candidates.numbers)
    }

    /// Offsets of the devices that are written: without an index, of those alone that may matter.
    fn written_offsets(&self, to: Place, count: u32) -> Vec<u32> {
        match to.index {
            Some(_) => (0..count).collect(),
            None => {
                let last = to.number.saturating_add(count.max(1) - 1);
                let relevant = self.relevant(to.class, (to.number, last), 1);
                relevant
                    .into_iter()
                    .map(|number| number - to.number)
                    .collect()
            }
        }
    }

    /// Condition that a block has a device at an offset.
    fn is_within(&mut self, block: &Block, offset: u32) -> Lit {
        match block.length() {
            None => Lit::TRUE,
            Some(length) => {
                let length = self.eval(length);
                self.aig
                    .less(&constant(offset.into(), length.len()), &length)
            }
        }
    }
}
